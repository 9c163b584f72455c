//! What a gasket answers to being closed: another curve in closing than in opening.
//!
//! ```text
//!   p ▲            ╱ loading, p_L(c)
//!     │         ╱●
//!     │      ╱  ╱│   opening from c_m: π(s) p_L(c_m)
//!     │   ╱   ╱  │
//!     │ ╱  __╱   │   s = (c − c_p)/(c_m − c_p)
//!   ──┼───●──────┼────▶ closure c = −g
//!         c_p    c_m
//! ```

use super::{ContactLaw, Eval, Scale, each};
use thiserror::Error;

/// What a slope of the loading curve is of its steepest, at most, beyond the onset of permanent closure, unless that is given.
const DROP: f64 = 0.9;
/// By how much the end of a curve of opening may be off the loading curve, over the pressure there.
const OFF: f64 = 0.01;

/// A gasket: pressure against closure, that of loading as long as it closes further than ever, and less where it opens.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{ContactLaw, Gasket, Scale};
///
/// let loading = vec![[0.0, 0.0], [0.1, 10.0], [0.3, 20.0]];
/// let opening = (0.3, vec![[0.2, 0.0], [0.3, 20.0]]);
/// let gasket = Gasket::new(loading, vec![opening], None, 0.0)?;
/// let scale = Scale { penalty: 1.0, shear: 1.0, length: 1.0 };
/// let pressure = |closure: f64, largest: f64| gasket.pressure(-closure, largest, &scale).value;
/// // it closes, opens half of what it gives back, and all of it
/// assert!((pressure(0.3, 0.0) - 20.0).abs() < 1e-12);
/// assert!((pressure(0.25, 0.3) - 10.0).abs() < 1e-12);
/// assert_eq!(pressure(0.2, 0.3), 0.0);
/// assert_eq!(gasket.remember(-0.4, 0.3), 0.4);
/// # Ok::<(), signorini_mechanics::contact::law::GasketError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Gasket {
    loading: Curve,
    /// Of opening, by the closure that they begin at; the first is that of loading up to the onset.
    openings: Vec<Opening>,
    tension: f64,
}

/// How a gasket opens from a closure.
#[derive(Clone, Debug, PartialEq)]
struct Opening {
    from: f64,
    /// The closure at which nothing presses any more.
    permanent: f64,
    /// Part of the pressure at `from` over part of the closure from `permanent` to there.
    shape: Curve,
}

/// What is linear between rows, which increase.
#[derive(Clone, Debug, PartialEq)]
struct Curve {
    rows: Vec<[f64; 2]>,
    /// What lies below it up to each row.
    below: Vec<f64>,
}

/// Why curves are none of a gasket.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum GasketError {
    /// One row says nothing about a slope.
    #[error("a curve of closure and pressure needs two rows at least")]
    TooShort,
    /// Rows that do not increase.
    #[error("row {row}: closures increase from row to row, and pressures do not fall")]
    Falls {
        /// The row, from 1.
        row: usize,
    },
    /// A curve that begins with a pressure.
    #[error("the first pressure is 0, not {found}")]
    Begins {
        /// The pressure.
        found: f64,
    },
    /// A curve of opening that does not end on that of loading.
    #[error("a curve of opening ends on that of loading, at [{from}, {expected}]")]
    Ends {
        /// The closure.
        from: f64,
        /// The pressure there.
        expected: f64,
    },
    /// Curves of opening that do not come one after the other.
    #[error(
        "curves of opening begin at closures that increase, beyond the onset of permanent closure at {after}"
    )]
    Order {
        /// The closure of the one before, or the onset.
        after: f64,
    },
}

impl Curve {
    fn new(rows: Vec<[f64; 2]>) -> Result<Self, GasketError> {
        let &[[_, first], _, ..] = rows.as_slice() else {
            return Err(GasketError::TooShort);
        };
        if first != 0.0 {
            return Err(GasketError::Begins { found: first });
        }
        let rises = |w: &[[f64; 2]]| w[1][0] > w[0][0] && w[1][1] >= w[0][1];
        if let Some(before) = rows.windows(2).position(|w| !rises(w)) {
            return Err(GasketError::Falls { row: before + 2 });
        }
        let mut below = vec![0.0];
        let mut sum = 0.0;
        for w in rows.windows(2) {
            sum += 0.5 * (w[0][1] + w[1][1]) * (w[1][0] - w[0][0]);
            below.push(sum);
        }
        Ok(Self { rows, below })
    }

    /// The first place.
    fn start(&self) -> f64 {
        self.rows.first().map_or(0.0, |row| row[0])
    }

    /// Value, slope and what lies below up to a place; beyond the last row the slope stays.
    fn at(&self, place: f64) -> [f64; 3] {
        let after = self.rows.partition_point(|row| row[0] <= place);
        if after == 0 {
            return [0.0; 3];
        }
        let k = after.min(self.rows.len() - 1) - 1;
        let ([a, p], [b, q]) = (self.rows[k], self.rows[k + 1]);
        let (slope, far) = ((q - p) / (b - a), place - a);
        let below = self.below[k] + (p + 0.5 * slope * far) * far;
        [p + slope * far, slope, below]
    }

    fn slopes(&self) -> impl Iterator<Item = f64> {
        let rows = self.rows.windows(2);
        rows.map(|w| (w[1][1] - w[0][1]) / (w[1][0] - w[0][0]))
    }

    /// Where the slope first falls by a tenth of the steepest; else the last place.
    fn bend(&self) -> f64 {
        let steepest = self.slopes().fold(0.0, f64::max);
        let is_steep = |slope: f64| slope >= DROP * steepest;
        let pieces = self.slopes().zip(&self.rows);
        let mut after = pieces.skip_while(|(slope, _)| !is_steep(*slope));
        let bend = after.find(|(slope, _)| !is_steep(*slope));
        let place = bend.map(|(_, row)| row).or(self.rows.last());
        place.map_or(0.0, |row| row[0])
    }

    /// The rows up to a place, as parts of what it is there.
    fn up_to(&self, place: f64) -> Result<Self, GasketError> {
        let start = self.start();
        let [whole, ..] = self.at(place);
        let rows = self.rows.iter().copied().filter(|row| row[0] < place);
        let part = |[c, p]: [f64; 2]| [(c - start) / (place - start), p / whole];
        let rows = rows.map(part).chain([[1.0, 1.0]]);
        Self::new(rows.collect())
    }
}

impl Gasket {
    /// A gasket with these rows of closure and pressure in loading, and in opening from closures. Up to the `onset` it opens as
    /// it closes; unless that is given, it is where the slope of loading falls by a tenth of its steepest. `tension` is what
    /// it resists being opened further by, over its first stiffness.
    ///
    /// Between two curves of opening, both count by how far the largest closure is from theirs, and permanent closures lie
    /// in between; beyond the last, it is the same part of the largest closure.
    ///
    /// # Errors
    /// Curves that fall, or do not begin at pressure 0; curves of opening that do not end on that of loading.
    pub fn new(
        loading: Vec<[f64; 2]>,
        unloading: Vec<(f64, Vec<[f64; 2]>)>,
        onset: Option<f64>,
        tension: f64,
    ) -> Result<Self, GasketError> {
        let loading = Curve::new(loading)?;
        let onset = onset.unwrap_or_else(|| loading.bend());
        let mut openings = Vec::new();
        if !unloading.is_empty() {
            let [expected, ..] = loading.at(onset);
            if expected <= 0.0 {
                return Err(GasketError::Order {
                    after: loading.start(),
                });
            }
            openings.push(Opening {
                from: onset,
                permanent: loading.start(),
                shape: loading.up_to(onset)?,
            });
        }
        for (from, rows) in unloading {
            let after = openings.last().map_or(onset, |o| o.from);
            if from <= after {
                return Err(GasketError::Order { after });
            }
            let [expected, ..] = loading.at(from);
            let curve = Curve::new(rows)?;
            let permanent = curve.start();
            let last = curve.rows.last().copied().unwrap_or_default();
            let ends = last[0] == from && (last[1] - expected).abs() <= OFF * expected;
            if !ends {
                return Err(GasketError::Ends { from, expected });
            }
            openings.push(Opening {
                from,
                permanent,
                shape: curve.up_to(from)?,
            });
        }
        Ok(Self {
            loading,
            openings,
            tension,
        })
    }

    /// The permanent closure of what has been closed by this much at most, with the two curves between which it opens and the
    /// share of the second; no curves where it opens as it closes.
    fn opening(&self, largest: f64) -> (f64, Option<([&Opening; 2], f64)>) {
        let after = self.openings.partition_point(|o| o.from < largest);
        let start = self.loading.start();
        match (after.checked_sub(1), self.openings.get(after)) {
            (None, _) => (start, None),
            (Some(k), Some(second)) => {
                let first = &self.openings[k];
                let share = (largest - first.from) / (second.from - first.from);
                let permanent = first.permanent + share * (second.permanent - first.permanent);
                (permanent, Some(([first, second], share)))
            }
            (Some(k), None) => {
                let last = &self.openings[k];
                let part = (last.permanent - start) / (last.from - start);
                (start + part * (largest - start), Some(([last, last], 0.0)))
            }
        }
    }

    /// Pressure, slope and energy at a closure of what has been closed by this much at most.
    fn at(&self, closure: f64, largest: f64) -> [f64; 3] {
        let (permanent, between) = self.opening(largest);
        if closure < permanent {
            let stiffness = self.tension * self.loading.slopes().next().unwrap_or_default();
            let far = closure - permanent;
            return [stiffness * far, stiffness, 0.5 * stiffness * far * far];
        }
        let Some(([first, second], share)) = between else {
            return self.loading.at(closure);
        };
        let [top, _, below] = self.loading.at(largest);
        let span = largest - permanent;
        let opened = |s: f64| {
            let (a, b) = (first.shape.at(s), second.shape.at(s));
            let [pi, slope, below] = std::array::from_fn(|k| a[k] + share * (b[k] - a[k]));
            [top * pi, top * slope / span, top * span * below]
        };
        if closure < largest {
            return opened((closure - permanent) / span);
        }
        let [pressure, slope, all] = self.loading.at(closure);
        let [_, _, given_back] = opened(1.0);
        [pressure, slope, given_back + (all - below)]
    }

    /// The largest closure after an increment that ends at this gap: what the law is asked with in the place of a multiplier
    /// from then on, at first with 0.
    #[must_use]
    pub fn remember(&self, gap: f64, largest: f64) -> f64 {
        largest.max(-gap)
    }

    /// What is spent where the largest closure grows, per area.
    #[must_use]
    pub fn spent(&self, from: f64, to: f64) -> f64 {
        let [_, _, before] = self.at(to, from);
        let [_, _, after] = self.at(to, to);
        before - after
    }
}

impl ContactLaw for Gasket {
    fn name(&self) -> &str {
        "gasket"
    }

    fn pressures(&self, gaps: &[f64], largest: &[f64], _: &Scale, out: &mut [Eval]) {
        each(gaps, largest, out, |gap, largest| {
            let [value, slope, _] = self.at(-gap, largest);
            if value == 0.0 && slope == 0.0 {
                return Eval::default();
            }
            Eval {
                value,
                dgap: -slope,
                dlambda: 0.0,
            }
        });
    }

    fn energy(&self, gap: f64, largest: f64, _: &Scale) -> Option<f64> {
        let [_, _, energy] = self.at(-gap, largest);
        Some(energy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: Scale = Scale {
        penalty: 1.0,
        shear: 1.0,
        length: 1.0,
    };

    fn loading() -> Vec<[f64; 2]> {
        vec![
            [0.0, 0.0],
            [4e-5, 1515.0],
            [1.2e-4, 3720.0],
            [5.05e-4, 8955.0],
        ]
    }

    /// A curve of opening by a template in parts.
    fn opening(from: f64, part: f64, top: f64) -> (f64, Vec<[f64; 2]>) {
        let template = [[0.0, 0.0], [0.5, 0.1], [1.0, 1.0]];
        let place = |[s, p]: [f64; 2]| match s {
            1.0 => [from, top],
            _ => [part * from + s * (1.0 - part) * from, p * top],
        };
        (from, template.map(place).to_vec())
    }

    fn gasket() -> Gasket {
        let one = opening(2.86e-4, 0.4, 5977.168831168832);
        let other = opening(4.5e-4, 0.5, 8207.142857142857);
        Gasket::new(loading(), vec![one, other], None, 1e-3).unwrap()
    }

    fn pressure(of: &Gasket, closure: f64, largest: f64) -> f64 {
        of.pressure(-closure, largest, &SCALE).value
    }

    #[test]
    fn the_reference_is_replayed() {
        // computed apart from this, from the curves of `gasket`
        let gasket = gasket();
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-13 * b.abs(), "{a} {b}");
        close(pressure(&gasket, 8e-5, 0.0), 2617.5);
        close(pressure(&gasket, 2.86e-4, 0.0), 5977.168831168832);
        let (largest, permanent) = (2.86e-4, 1.144e-4);
        close(gasket.opening(largest).0, permanent);
        let middle = 0.5 * (permanent + largest);
        close(pressure(&gasket, middle, largest), 597.7168831168832);
        close(
            pressure(&gasket, largest, largest),
            pressure(&gasket, largest, 0.0),
        );
    }

    #[test]
    fn slopes_and_energies_match_differences() {
        let gasket = gasket();
        for largest in [0.0, 3e-5, 4e-5, 9e-5, 2.86e-4, 3.3e-4, 4.5e-4, 6e-4] {
            for k in -20..80 {
                let closure = 1.01e-5 * (f64::from(k) + 0.37);
                let h = 1e-9;
                let at = |c: f64| gasket.pressure(-c, largest, &SCALE).value;
                let energy = |c: f64| gasket.energy(-c, largest, &SCALE).unwrap();
                let eval = gasket.pressure(-closure, largest, &SCALE);
                let slope = (at(closure + h) - at(closure - h)) / (2.0 * h);
                assert!(
                    (slope + eval.dgap).abs() < 1e-4 * 4e7,
                    "{largest} {closure}"
                );
                let work = (energy(closure + h) - energy(closure - h)) / (2.0 * h);
                assert!(
                    (work - eval.value).abs() < 1e-5 * 9e3,
                    "{largest} {closure}"
                );
            }
        }
    }

    #[test]
    fn pressures_are_continuous_in_the_largest_closure() {
        let gasket = gasket();
        for largest in [4e-5, 2.86e-4, 4.5e-4] {
            for part in [0.3, 0.6, 0.9, 1.0] {
                let [below, above] = [-1e-10, 1e-10].map(|by| {
                    let largest = largest + by;
                    pressure(&gasket, part * largest, largest)
                });
                assert!((below - above).abs() < 0.1, "{largest} {part}");
            }
        }
    }

    #[test]
    fn what_a_cycle_spends_is_the_area_of_its_loop() {
        let gasket = gasket();
        let n = 20_000;
        for largest in [3e-5, 2e-4, 2.86e-4, 5e-4] {
            let mut area = 0.0;
            let mut remembered = 0.0;
            let way = (0..=n).chain((0..n).rev());
            let mut last = [0.0, 0.0];
            for k in way {
                let closure = largest * f64::from(k) / f64::from(n);
                let p = pressure(&gasket, closure, remembered);
                area += 0.5 * (p + last[1]) * (closure - last[0]);
                last = [closure, p];
                remembered = gasket.remember(-closure, remembered);
            }
            let mut free = gasket.clone();
            free.tension = 0.0;
            // what tension holds at closure 0 comes back
            let held = gasket.energy(0.0, largest, &SCALE).unwrap();
            let spent = free.spent(0.0, largest);
            assert!(
                (area - held - spent).abs() < 1e-6 * area.max(1e-3),
                "{largest}: {area} {spent}"
            );
            assert!(largest < 4e-5 || spent > 0.1 * area);
        }
    }

    #[test]
    fn curves_that_are_none_are_refused() {
        let flat = [[0.0, 0.0], [0.1, 5.0]];
        let refused = |loading: &[[f64; 2]], unloading: &[(f64, Vec<[f64; 2]>)]| {
            Gasket::new(loading.to_vec(), unloading.to_vec(), None, 0.0).unwrap_err()
        };
        assert_eq!(refused(&flat[..1], &[]), GasketError::TooShort);
        let begins = refused(&[[0.0, 1.0], [1.0, 2.0]], &[]);
        assert_eq!(begins, GasketError::Begins { found: 1.0 });
        let falls = refused(&[[0.0, 0.0], [1.0, 2.0], [2.0, 1.0]], &[]);
        assert_eq!(falls, GasketError::Falls { row: 3 });
        let short = (0.3, vec![[0.1, 0.0], [0.3, 1.0]]);
        let ends = refused(&[[0.0, 0.0], [0.1, 5.0], [0.4, 8.0]], &[short]);
        assert!(matches!(ends, GasketError::Ends { from: 0.3, .. }));
        let early = (0.05, vec![[0.0, 0.0], [0.05, 2.5]]);
        let order = refused(&[[0.0, 0.0], [0.1, 5.0], [0.4, 8.0]], &[early]);
        assert_eq!(order, GasketError::Order { after: 0.1 });
    }
}
