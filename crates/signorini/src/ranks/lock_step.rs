//! Meetings.

use super::parted::{PATIENCE, Parted};
use crate::run::Stop;
use signorini_io::diagnostic::Diagnostics;
use signorini_mechanics::solve::IncrementRecord;
use signorini_mechanics::system::Frame;
use signorini_ranks::{Alone, Ranks, RanksError};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::OnceLock;

/// Nothing to say, at a meeting where the least number counts.
pub(super) const NOTHING: u64 = u64::MAX;

/// Bytes that are sent at once.
const PIECE: usize = 1 << 30;

/// The ranks of a run as one of them sees them.
///
/// # Example
/// ```
/// use signorini::ranks::LockStep;
///
/// let alone = LockStep::default();
/// assert!(alone.is_alone() && alone.speaks());
/// assert_eq!(alone.end(3), Ok(3));
/// ```
#[derive(Debug)]
pub struct LockStep {
    ranks: &'static dyn Ranks,
    /// Why they meet no more.
    parted: OnceLock<Parted>,
}

/// A process that runs by itself.
impl Default for LockStep {
    fn default() -> Self {
        Self::new(&Alone)
    }
}

impl LockStep {
    /// These ranks, all at the start of the program.
    #[must_use]
    pub const fn new(ranks: &'static dyn Ranks) -> Self {
        Self {
            ranks,
            parted: OnceLock::new(),
        }
    }

    /// The number of this rank.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.ranks.rank()
    }

    /// How many ranks there are.
    #[must_use]
    pub fn size(&self) -> usize {
        self.ranks.size()
    }

    /// Whether there is one process.
    #[must_use]
    pub fn is_alone(&self) -> bool {
        self.size() <= 1
    }

    /// Whether this rank reports what happens: rank 0, and whichever has met a fault that others do not know.
    #[must_use]
    pub fn speaks(&self) -> bool {
        self.rank() == 0 || self.failed_alone()
    }

    /// Whether this rank has met a fault that others do not know.
    #[must_use]
    pub fn failed_alone(&self) -> bool {
        let own = self.rank();
        matches!(self.parted.get(), Some(Parted::Fault { rank, .. }) if *rank == own)
    }

    /// Why the ranks meet no more.
    #[must_use]
    pub fn parted(&self) -> Option<&Parted> {
        self.parted.get()
    }

    /// What has come of a phase that all ranks go through by themselves, as reading is: an error on all of them where one has
    /// an error.
    ///
    /// # Errors
    /// Its own; those of others.
    pub fn agreed<T>(&self, own: Result<T, Diagnostics>) -> Result<T, Diagnostics> {
        match own {
            Ok(done) => match self.meet("phase", [NOTHING; 2], None) {
                Ok(_) => Ok(done),
                Err(parted) => Err(parted.diagnostic().into()),
            },
            Err(found) => {
                // whether all have failed or this one alone: it says what it has found
                let _ = self.fails(found.exit_code().unwrap_or(3));
                Err(found)
            }
        }
    }

    /// Says that this rank comes to an end with this exit code.
    ///
    /// # Errors
    /// Others go on: the ranks have parted.
    pub(crate) fn fails(&self, exit_code: u8) -> Result<(), Parted> {
        self.meet("fault", [NOTHING; 2], Some(exit_code)).map(drop)
    }

    /// Notes that this rank comes to an end in the middle of something, where nobody can be met.
    pub fn fails_alone(&self, exit_code: u8) {
        if !self.is_alone() {
            let rank = self.rank();
            let _ = self.part(Parted::Fault { rank, exit_code });
        }
    }

    /// The exit code of all ranks at their end, the largest.
    ///
    /// # Errors
    /// The ranks have parted, now or before: each has said what there is to say, and may [`LockStep::leave`].
    pub fn end(&self, exit_code: u8) -> Result<u8, Parted> {
        let most = self.most(u64::from(exit_code))?;
        Ok(u8::try_from(most).unwrap_or(exit_code))
    }

    /// Ends all ranks, where they have parted: some may wait for others for ever. Rank 0 is given time to write its ending.
    pub fn leave(&self) {
        let Some(parted) = self.parted.get() else {
            return;
        };
        if self.rank() != 0 {
            std::thread::sleep(PATIENCE);
        }
        self.ranks.abort(parted.exit_code());
    }

    /// Ends all ranks at once.
    pub fn abort(&self, exit_code: u8) {
        self.ranks.abort(exit_code);
    }

    /// Whether any rank says so.
    ///
    /// # Errors
    /// The ranks have parted.
    pub(crate) fn any(&self, own: bool) -> Result<bool, Parted> {
        let [least, _] = self.meet("any", [u64::from(!own), NOTHING], None)?;
        Ok(least == 0)
    }

    /// The largest number of all ranks.
    ///
    /// # Errors
    /// The ranks have parted.
    pub(crate) fn most(&self, own: u64) -> Result<u64, Parted> {
        let [least, _] = self.meet("most", [!own, NOTHING], None)?;
        Ok(!least)
    }

    /// Why to stop, where any rank has a reason.
    ///
    /// # Errors
    /// The ranks have parted.
    pub(crate) fn stop(&self, own: Option<Stop>) -> Result<Option<Stop>, Parted> {
        if self.is_alone() {
            return Ok(own);
        }
        let own = own.map_or(NOTHING, Stop::to_number);
        let [least, _] = self.meet("stop", [own, NOTHING], None)?;
        Ok(Stop::from_number(least))
    }

    /// Checks that all ranks have read the same.
    ///
    /// # Errors
    /// The ranks have parted.
    pub(crate) fn same_input(&self, hash: &[u8; 32]) -> Result<(), Parted> {
        self.same("the case and the mesh", || digest(hash))
    }

    /// Checks that all ranks have accepted the same state.
    ///
    /// # Errors
    /// The ranks have parted.
    pub(crate) fn same_state(&self, record: &IncrementRecord, frame: &Frame) -> Result<(), Parted> {
        self.same("the state", || {
            let mut sum = Sum::default();
            sum.add(&[record.step, record.increment, record.iterations].map(|n| n as f64));
            sum.add(&[record.time, record.dt, frame.work_external]);
            let vectors = [
                &frame.displacement,
                &frame.velocity,
                &frame.acceleration,
                &frame.reaction_force,
                &frame.contact_force,
            ];
            for v in vectors.into_iter().flatten() {
                sum.add(&[v.x, v.y, v.z]);
            }
            sum.add(&frame.temperature);
            sum.add(&frame.plastic_strain);
            sum.0
        })
    }

    fn same(&self, what: &'static str, number: impl FnOnce() -> u64) -> Result<(), Parted> {
        if self.is_alone() {
            return Ok(());
        }
        let number = number();
        let [least, of_complement] = self.meet("same", [number, !number], None)?;
        // the largest number is the one whose complement is the least
        if least == !of_complement {
            return Ok(());
        }
        let parted = match self.others_than(number) {
            Ok(ranks) => Parted::Differ { what, ranks },
            Err(error) => error.into(),
        };
        Err(self.part(parted))
    }

    /// The least of what all ranks say in a matter, and whether they are about the same.
    ///
    /// # Errors
    /// The ranks have parted.
    pub(super) fn meet(
        &self,
        matter: impl Hash,
        own: [u64; 2],
        fault: Option<u8>,
    ) -> Result<[u64; 2], Parted> {
        if let Some(parted) = self.parted.get() {
            return Err(parted.clone());
        }
        if self.is_alone() {
            return Ok(own);
        }
        let matter = digest(matter);
        let of_rank = |code: u8| (self.rank() as u64) << 8 | u64::from(code);
        let [a, b] = own;
        let mut all = [matter, !matter, fault.map_or(NOTHING, of_rank), a, b];
        let heard = self.ranks.least(&mut all);
        let [least, of_complement, fault, a, b] = all;
        let parted = match heard {
            Err(error) => error.into(),
            Ok(()) if least == !of_complement => return Ok([a, b]),
            Ok(()) if fault != NOTHING => Parted::Fault {
                rank: (fault >> 8) as usize,
                exit_code: (fault & 0xff) as u8,
            },
            Ok(()) => match self.others_than(matter) {
                Ok(ranks) => {
                    let what = "the place in the program";
                    Parted::Differ { what, ranks }
                }
                Err(error) => error.into(),
            },
        };
        Err(self.part(parted))
    }

    /// The ranks whose number is not that of rank 0.
    fn others_than(&self, number: u64) -> Result<Vec<usize>, RanksError> {
        let halves = [number >> 32, number & u64::from(u32::MAX)];
        let counts = vec![2; self.size()];
        let mut all = vec![0.0; 2 * self.size()];
        // numbers of 32 bits pass through messages unchanged
        self.ranks
            .all_gather(&halves.map(|half| half as f64), &counts, &mut all)?;
        let (all, _) = all.as_chunks::<2>();
        let differs = |rank: &usize| all.get(*rank) != all.first();
        Ok((0..self.size()).filter(differs).collect())
    }

    /// Sends all ranks what rank 0 has.
    ///
    /// # Errors
    /// The ranks have parted.
    pub(super) fn send(&self, bytes: &mut [u8]) -> Result<(), Parted> {
        for piece in bytes.chunks_mut(PIECE) {
            let heard = self.ranks.broadcast(piece);
            heard.map_err(|error| self.part(error.into()))?;
        }
        Ok(())
    }

    fn part(&self, why: Parted) -> Parted {
        self.parted.get_or_init(|| why).clone()
    }
}

/// A number for something, the same on all ranks.
fn digest(of: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

/// A check sum of many numbers, in their order (Fowler, Noll, Vo: FNV-1a, word by word).
struct Sum(u64);

impl Default for Sum {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Sum {
    fn add(&mut self, numbers: &[f64]) {
        for number in numbers {
            let product = (self.0 ^ number.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
            // the high bits of a product come down, else those of the numbers would be lost
            self.0 = product ^ (product >> 32);
        }
    }
}
