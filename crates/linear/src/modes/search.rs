//! Lanczos' method by blocks, with thick restarts.

use super::basis::{Basis, dot, eigen};
use super::mode::{Mode, Modes, Wanted};
use super::pencil::Pencil;
use crate::error::LinearError;

/// Vectors of a block: eigenvalues that occur as often come at once.
const BLOCK: usize = 3;
/// Modes that are followed besides those that are wanted.
const MORE: usize = 6;
/// Vectors that a restart leaves room for.
const ROOM: usize = 24;
/// The error (E4) of a mode, over its θ.
const ERROR: f64 = 1e-10;
/// The same of the first one behind those that are wanted: it says where to count.
const ERROR_BEHIND: f64 = 1e-3;
/// What orthogonalization leaves of a vector that depends on the others, over itself.
const DEPENDENT: f64 = 1e-12;
/// A gap between eigenvalues in which they may be counted, over themselves.
const GAP: f64 = 1e-4;
/// How often the basis may be filled.
const FILLINGS: usize = 60;
/// How often new directions are added where some mode is missing.
const RENEWALS: usize = 8;
/// A shift is too far off where it is this times the first eigenvalue.
const TOO_FAR: f64 = 30.0;
/// Eigenvalues below this part of the shift are those of rigid motions.
const RIGID: f64 = 1e-7;

pub(super) struct Search<'p, 'a> {
    pencil: &'p mut Pencil<'a>,
    wanted: Wanted,
    basis: Basis,
    /// T of (E3): the lower half, row by row.
    matrix: Vec<Vec<f64>>,
    /// How many vectors (E2) was applied to.
    done: usize,
    /// Whether there are no more directions.
    is_exhausted: bool,
    seed: u64,
    mass_times: Vec<f64>,
    /// How many eigenvalues a factor has counted below one.
    counted: Option<(usize, f64)>,
    /// How many vectors are to be solved for at least.
    least: usize,
}

/// A pair of (E3).
struct Ritz {
    theta: f64,
    vector: Vec<f64>,
    /// (E4) over θ.
    error: f64,
}

/// What a look at all pairs says.
enum Look {
    /// Not all are found.
    More,
    /// All that are wanted, and those that come before a gap: the numbers of their pairs, lowest eigenvalue first, and the
    /// eigenvalue in the gap; none where there is nothing behind them.
    Found(Vec<usize>, Option<f64>),
}

/// What [`Look::Found`] was found in.
struct Filled {
    pairs: Vec<Ritz>,
    found: Vec<usize>,
    gap: Option<f64>,
}

impl<'p, 'a> Search<'p, 'a> {
    /// Begins with vectors of no special direction.
    ///
    /// # Errors
    /// Those of solutions.
    pub fn new(pencil: &'p mut Pencil<'a>, wanted: Wanted) -> Result<Self, LinearError> {
        let n = pencil.nequation();
        let mut search = Self {
            pencil,
            wanted,
            basis: Basis::new(n),
            matrix: Vec::new(),
            done: 0,
            is_exhausted: false,
            seed: 0,
            mass_times: vec![0.0; n],
            counted: None,
            least: 0,
        };
        search.renew()?;
        Ok(search)
    }

    /// How many pairs matter: those wanted, and those below a shift that is not the lower end.
    fn count(&self) -> usize {
        match self.wanted.from {
            Some(_) => self.wanted.count,
            None => self.wanted.count.max(self.pencil.below.unwrap_or_default()),
        }
    }

    /// Adds vectors of no special direction.
    fn renew(&mut self) -> Result<(), LinearError> {
        let mut added = 0;
        // a vector may depend on the others by chance, not several
        for _ in 0..2 * BLOCK {
            let mut start = self.basis.blank();
            for x in &mut start {
                self.seed = self.seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
                *x = uniform(self.seed);
            }
            let mut vector = self.basis.blank();
            self.pencil.inverse(&start, &mut vector)?;
            self.basis.give_back(start);
            if self.append(vector, None)? {
                added += 1;
            }
            if added == BLOCK {
                return Ok(());
            }
        }
        self.is_exhausted = added == 0;
        Ok(())
    }

    /// Orthogonalizes a vector, and adds it unless it depends on the others. `of` is the vector that (E2) made it of.
    fn append(&mut self, mut vector: Vec<f64>, of: Option<usize>) -> Result<bool, LinearError> {
        let mut mass_times = std::mem::take(&mut self.mass_times);
        self.pencil.times_mass(&vector, &mut mass_times);
        let before = dot(&vector, &mass_times).max(0.0).sqrt();
        for _ in 0..2 {
            let products = self.basis.products(&mass_times);
            if let Some(of) = of {
                for (i, h) in products.iter().enumerate() {
                    // (E3) is symmetric: what was found before stays
                    if i >= of
                        && let Some(entry) = self.matrix.get_mut(i).and_then(|r| r.get_mut(of))
                    {
                        *entry += h;
                    }
                }
            }
            self.basis.subtract(&mut vector);
            self.pencil.times_mass(&vector, &mut mass_times);
        }
        let after = dot(&vector, &mass_times).max(0.0).sqrt();
        self.mass_times = mass_times;
        if !(before.is_finite() && after.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        if after <= DEPENDENT * before || after == 0.0 {
            self.basis.give_back(vector);
            return Ok(false);
        }
        vector.iter_mut().for_each(|x| *x /= after);
        let number = self.basis.len();
        self.basis.vectors.push(vector);
        let mut row = vec![0.0; number + 1];
        if let Some(entry) = of.and_then(|of| row.get_mut(of)) {
            *entry = after;
        }
        self.matrix.push(row);
        Ok(true)
    }

    /// Applies (E2) to the vectors that are new.
    fn extend(&mut self) -> Result<(), LinearError> {
        let end = self.basis.len();
        if self.done == end {
            self.renew()?;
        }
        for number in self.done..end {
            let mut image = self.basis.blank();
            if let Some(vector) = self.basis.vectors.get(number) {
                self.pencil.inverse(vector, &mut image)?;
            }
            self.append(image, Some(number))?;
            self.done = number + 1;
        }
        Ok(())
    }

    /// The pairs of (E3), by θ.
    fn pairs(&self) -> Result<Vec<Ritz>, LinearError> {
        let rest = self.matrix.get(self.done..).unwrap_or_default();
        let pairs = eigen(&self.matrix, self.done)?.into_iter();
        let ritz = pairs.map(|(theta, vector)| {
            let next = rest.iter().map(|row| dot(row, &vector));
            let error = next.map(|e| e * e).sum::<f64>().sqrt();
            Ritz {
                error: error / theta.abs(),
                theta,
                vector,
            }
        });
        Ok(ritz.collect())
    }

    fn eigenvalue(&self, theta: f64) -> f64 {
        self.pencil.shift + 1.0 / theta
    }

    /// The numbers of pairs whose eigenvalue counts, lowest eigenvalue first: with the shift as the lower end those above it,
    /// else as many below as there are, too.
    fn ranked(&self, pairs: &[Ritz]) -> Vec<usize> {
        let below = match (self.wanted.from, self.pencil.below) {
            (Some(_), _) => 0,
            (None, Some(below)) => below,
            (None, None) => pairs
                .iter()
                .filter(|p| p.theta < 0.0 && p.error < ERROR)
                .count(),
        };
        let negative = pairs.iter().take(below).filter(|p| p.theta < 0.0).count();
        // below the shift, the smallest θ in size is the lowest eigenvalue; above it, the largest
        let above = (0..pairs.len())
            .rev()
            .filter(|&k| pairs.get(k).is_some_and(|p| p.theta > 0.0));
        (0..negative).rev().chain(above).collect()
    }

    fn look(&self, pairs: &[Ritz]) -> Look {
        let ranked = self.ranked(pairs);
        let pair = |rank: usize| ranked.get(rank).and_then(|&k| pairs.get(k));
        let count = self.count();
        if self.misses_some(&ranked, pairs) {
            return Look::More;
        }
        let mut end = None;
        for rank in 0..ranked.len() {
            let Some(here) = pair(rank) else { break };
            if here.error > ERROR {
                break;
            }
            if rank + 1 < count {
                continue;
            }
            let value = self.eigenvalue(here.theta);
            let Some(next) = pair(rank + 1).filter(|next| next.error <= ERROR_BEHIND) else {
                break;
            };
            let behind = self.eigenvalue(next.theta);
            if behind - value > GAP * (value.abs() + self.pencil.shift.abs()) {
                end = Some((rank + 1, Some(0.5 * (value + behind))));
                break;
            }
        }
        if end.is_none() && self.is_exhausted && self.done == self.basis.len() {
            end = Some((ranked.len(), None));
        }
        match end {
            None => Look::More,
            Some((n, gap)) => Look::Found(ranked.into_iter().take(n).collect(), gap),
        }
    }

    /// Whether some of the eigenvalues that were counted are still to be found, or new directions to be tried.
    fn misses_some(&self, ranked: &[usize], pairs: &[Ritz]) -> bool {
        if self.is_at_end() {
            return false;
        }
        let Some((number, limit)) = self.counted else {
            return self.pencil.solves < self.least;
        };
        let pairs = ranked.iter().filter_map(|&k| pairs.get(k));
        let found = pairs.filter(|p| p.error <= ERROR && self.eigenvalue(p.theta) < limit);
        found.count() < number
    }

    /// How many vectors the basis may have.
    fn size(&self) -> usize {
        let kept = self.count() + MORE;
        (kept + ROOM.max(self.count())).next_multiple_of(BLOCK)
    }

    /// Goes on until the pairs that matter are found, or something says that they will not be.
    fn fill(&mut self) -> Result<Option<Filled>, LinearError> {
        for _ in 0..FILLINGS {
            while self.basis.len() + BLOCK <= self.size() && !self.is_at_end() {
                self.extend()?;
                let pairs = self.pairs()?;
                if let Look::Found(found, gap) = self.look(&pairs) {
                    return Ok(Some(Filled { pairs, found, gap }));
                }
            }
            let pairs = self.pairs()?;
            if let Look::Found(found, gap) = self.look(&pairs) {
                return Ok(Some(Filled { pairs, found, gap }));
            }
            if self.is_at_end() {
                return Ok(None);
            }
            self.restart(&pairs);
        }
        Ok(None)
    }

    fn is_at_end(&self) -> bool {
        self.is_exhausted && self.done == self.basis.len()
    }

    /// Keeps the best pairs, and the vectors that (E2) was not applied to.
    fn restart(&mut self, pairs: &[Ritz]) {
        let mut ranked = self.ranked(pairs);
        ranked.truncate(self.count() + MORE);
        let mut vectors = Vec::with_capacity(self.size());
        let mut matrix: Vec<Vec<f64>> = Vec::with_capacity(self.size());
        for (k, pair) in ranked.iter().filter_map(|&k| pairs.get(k)).enumerate() {
            let mut vector = self.basis.blank();
            self.basis.combine(&pair.vector, &mut vector);
            vectors.push(vector);
            let mut row = vec![0.0; k + 1];
            if let Some(last) = row.last_mut() {
                *last = pair.theta;
            }
            matrix.push(row);
        }
        let kept = vectors.len();
        let new = self.matrix.split_off(self.done);
        for (row, number) in new.iter().zip(kept..) {
            let coupled = ranked.iter().filter_map(|&k| pairs.get(k));
            let mut row: Vec<f64> = coupled.map(|pair| dot(row, &pair.vector)).collect();
            row.resize(number + 1, 0.0);
            matrix.push(row);
        }
        let rest = self.basis.vectors.split_off(self.done);
        for old in std::mem::take(&mut self.basis.vectors) {
            self.basis.give_back(old);
        }
        vectors.extend(rest);
        (self.basis.vectors, self.matrix, self.done) = (vectors, matrix, kept);
    }

    /// A shift that suits free bodies better, where the present one is far off; found by filling the basis once.
    ///
    /// # Errors
    /// Those of solutions.
    pub fn better_shift(&mut self) -> Result<Option<f64>, LinearError> {
        while self.basis.len() + BLOCK <= self.size() && !self.is_at_end() {
            self.extend()?;
        }
        let shift = self.pencil.shift.abs();
        let values = self.pairs()?;
        let values = values.iter().filter(|p| p.theta > 0.0);
        let elastic = values
            .map(|p| self.eigenvalue(p.theta))
            .filter(|value| *value > RIGID * shift);
        let first = elastic.fold(f64::INFINITY, f64::min);
        let is_far = first.is_finite() && shift > TOO_FAR * first;
        Ok(is_far.then_some(-first))
    }

    /// Finds the modes, and counts them.
    ///
    /// # Errors
    /// Those of solutions.
    pub fn run(mut self) -> Result<Modes, LinearError> {
        let (shift, below) = (self.pencil.shift, self.pencil.below);
        for renewal in 0..RENEWALS {
            let Some(Filled { pairs, found, gap }) = self.fill()? else {
                break;
            };
            let modes = self.modes(&pairs, &found)?;
            let Some(gap) = gap else {
                return Ok(self.finish(modes, shift, true));
            };
            self.pencil.shift_near(gap)?;
            let number = match (self.pencil.below, self.wanted.from, below) {
                (Some(all), None, _) => Some(all),
                (Some(all), Some(_), Some(below)) => Some(all.saturating_sub(below)),
                _ => None,
            };
            let is_counted = number == Some(found.len());
            if is_counted || number.is_none() && renewal > 0 {
                return Ok(self.finish(modes, shift, is_counted));
            }
            // one is missing, or nobody knows: new directions
            self.pencil.shift_near(shift)?;
            self.counted = number.map(|number| (number, gap));
            self.least = self.pencil.solves + ROOM;
            self.renew()?;
        }
        let pairs = self.pairs()?;
        let mut ranked = self.ranked(&pairs);
        ranked.truncate(self.wanted.count);
        let modes = self.modes(&pairs, &ranked)?;
        Ok(self.finish(modes, shift, false))
    }

    fn finish(self, mut modes: Vec<Mode>, shift: f64, is_counted: bool) -> Modes {
        modes.truncate(self.wanted.count);
        Modes {
            modes,
            shift,
            is_counted,
            solves: self.pencil.solves,
            factors: self.pencil.factors,
        }
    }

    /// The modes of these pairs: (E2) applied once more, orthonormalized, with their residuals.
    fn modes(&mut self, pairs: &[Ritz], which: &[usize]) -> Result<Vec<Mode>, LinearError> {
        let n = self.pencil.nequation();
        let shift = self.pencil.shift;
        let mut own = Basis::new(n);
        let [mut vector, mut of_k, mut of_m, mut sizes] = [0; 4].map(|_| vec![0.0; n]);
        let mut numbers = Vec::new();
        for pair in which.iter().filter_map(|&k| pairs.get(k)) {
            self.basis.combine(&pair.vector, &mut vector);
            let mut shape = own.blank();
            self.pencil.inverse(&vector, &mut shape)?;
            for _ in 0..2 {
                self.pencil.times_mass(&shape, &mut of_m);
                own.products(&of_m);
                own.subtract(&mut shape);
            }
            self.pencil.times_mass(&shape, &mut of_m);
            let size = dot(&shape, &of_m).max(0.0).sqrt();
            for values in [&mut shape, &mut of_m] {
                values.iter_mut().for_each(|x| *x /= size);
            }
            let eigenvalue = self.eigenvalue(pair.theta);
            self.pencil.times_stiffness(&shape, &mut of_k);
            let left = of_k.iter().zip(&of_m).map(|(k, m)| k - eigenvalue * m);
            let left = left.map(|r| r * r).sum::<f64>().sqrt();
            sizes.fill(0.0);
            self.pencil.sizes(&shape, eigenvalue, &mut sizes);
            let scale = (eigenvalue.abs() + shift.abs()) * dot(&of_m, &of_m).sqrt();
            let rounding = ROUNDING * f64::EPSILON * dot(&sizes, &sizes).sqrt();
            numbers.push((eigenvalue, left / scale, rounding / scale));
            own.vectors.push(shape);
        }
        let modes = numbers.into_iter().zip(own.vectors);
        let mode = |((eigenvalue, residual, rounding), shape)| Mode {
            eigenvalue,
            shape,
            residual,
            rounding,
        };
        Ok(modes.map(mode).collect())
    }
}

/// How many times the machine precision of what is added up a residual may be.
const ROUNDING: f64 = 16.0;

/// A number between −1 and 1 (splitmix64).
fn uniform(seed: u64) -> f64 {
    let mut z = seed;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 * 2.0_f64.powi(-52) - 1.0
}
