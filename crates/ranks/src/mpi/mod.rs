//! The ranks of MPI behind a safe door: the only calls into that library.
#![allow(unsafe_code)]

use crate::error::{RanksError, fits};
use crate::{Alone, Ranks};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

unsafe extern "C" {
    fn signorini_ranks_enter(rank: *mut i32, size: *mut i32) -> i32;
    fn signorini_ranks_all_gather(
        own: *const f64,
        count: i32,
        all: *mut f64,
        counts: *const i32,
        first: *const i32,
    ) -> i32;
    fn signorini_ranks_broadcast(bytes: *mut u8, count: i32) -> i32;
    fn signorini_ranks_least(numbers: *mut u64, count: i32) -> i32;
    fn signorini_ranks_abort(code: i32);
}

/// MPI is entered for one thread at a time.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The processes of `MPI_COMM_WORLD`.
#[derive(Debug)]
struct World {
    rank: usize,
    size: usize,
}

/// The processes, once they have been entered; `None` where MPI cannot be.
static WORLD: OnceLock<Option<World>> = OnceLock::new();

/// The processes that this one was started with: those of `mpirun`, or it alone where MPI cannot be entered.
///
/// The first call enters MPI, which is left when the process ends in order.
///
/// # Example
/// ```
/// // a test is started by itself
/// assert_eq!((signorini_ranks::world().rank(), signorini_ranks::world().size()), (0, 1));
/// ```
pub fn world() -> &'static dyn Ranks {
    let entered = WORLD.get_or_init(|| {
        let _alone = alone();
        let (mut rank, mut size) = (0, 1);
        // SAFETY: both numbers are live and written during the call alone.
        let code = unsafe { signorini_ranks_enter(&raw mut rank, &raw mut size) };
        let world = World {
            rank: usize::try_from(rank).ok()?,
            size: usize::try_from(size).ok()?,
        };
        (code == 0).then_some(world)
    });
    match entered {
        Some(world) => world,
        None => &Alone,
    }
}

/// The processes that compute together: those of [`world`] once it has been called, before that this one alone.
///
/// # Example
/// ```
/// assert_eq!(signorini_ranks::together().size(), 1);
/// ```
pub fn together() -> &'static dyn Ranks {
    match WORLD.get() {
        Some(Some(world)) => world,
        _ => &Alone,
    }
}

fn outcome(call: &'static str, code: i32) -> Result<(), RanksError> {
    if code == 0 {
        Ok(())
    } else {
        Err(RanksError::Library { call, code })
    }
}

/// A length as MPI counts.
fn count(what: &'static str, length: usize) -> Result<i32, RanksError> {
    i32::try_from(length).map_err(|_| RanksError::Shape {
        what,
        got: length,
        wanted: i32::MAX as usize,
    })
}

impl Ranks for World {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn all_gather(&self, own: &[f64], counts: &[usize], all: &mut [f64]) -> Result<(), RanksError> {
        fits("counts", counts.len(), self.size)?;
        let mine = counts.get(self.rank).copied().unwrap_or(0);
        fits("numbers of a rank", own.len(), mine)?;
        fits("numbers of all ranks", all.len(), counts.iter().sum())?;
        count("numbers of all ranks", all.len())?;
        let mut first = Vec::with_capacity(counts.len());
        let mut end = 0;
        let mut narrow = Vec::with_capacity(counts.len());
        for &n in counts {
            first.push(count("numbers before a rank", end)?);
            narrow.push(count("numbers of a rank", n)?);
            end += n;
        }
        let own_count = count("numbers of a rank", own.len())?;
        let _alone = alone();
        // SAFETY: `own` has `own_count` numbers, `all` as many as `counts` add up to, and both lists of numbers one for
        // each rank; all of them are live and borrowed for the call alone.
        let code = unsafe {
            signorini_ranks_all_gather(
                own.as_ptr(),
                own_count,
                all.as_mut_ptr(),
                narrow.as_ptr(),
                first.as_ptr(),
            )
        };
        outcome("MPI_Allgatherv", code)
    }

    fn broadcast(&self, bytes: &mut [u8]) -> Result<(), RanksError> {
        let length = count("bytes", bytes.len())?;
        let _alone = alone();
        // SAFETY: `bytes` has `length` bytes, live and borrowed for the call alone.
        outcome("MPI_Bcast", unsafe {
            signorini_ranks_broadcast(bytes.as_mut_ptr(), length)
        })
    }

    fn least(&self, numbers: &mut [u64]) -> Result<(), RanksError> {
        let length = count("numbers", numbers.len())?;
        let _alone = alone();
        // SAFETY: `numbers` has `length` numbers, live and borrowed for the call alone.
        outcome("MPI_Allreduce", unsafe {
            signorini_ranks_least(numbers.as_mut_ptr(), length)
        })
    }

    fn abort(&self, code: u8) {
        if self.size > 1 {
            // without the lock: another thread may wait for a rank that is gone
            // SAFETY: takes a number, and ends the processes.
            unsafe { signorini_ranks_abort(i32::from(code)) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::agree;

    #[test]
    fn a_process_started_by_itself_is_a_world_of_one() {
        let world = world();
        assert_eq!((world.rank(), world.size()), (0, 1));
        let mut all = [0.0; 2];
        world.all_gather(&[3.0, 5.0], &[2], &mut all).unwrap();
        assert_eq!(all, [3.0, 5.0]);
        let mut bytes = *b"abc";
        world.broadcast(&mut bytes).unwrap();
        assert_eq!(&bytes, b"abc");
        assert!(agree(world, 12).unwrap());
        assert!(world.all_gather(&[3.0], &[2], &mut all).is_err());
    }
}
