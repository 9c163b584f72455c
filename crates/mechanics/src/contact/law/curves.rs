use super::{ContactLaw, Eval, Scale};
use std::cmp::Ordering;
use std::f64::consts::PI;
use thiserror::Error;

/// A pressure that falls exponentially with the gap: `p0` at `g = 0`, 1 % of it at `g = c0`; without end inside, and
/// outside up to a gap.
///
/// `p = p0 exp(ln(0.01) g/c0)`; below `g = −2 c0` it goes on along its tangent, so that a bad start does not overflow.
/// Beyond `within` there is nothing: the pressure jumps there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    /// Pressure at zero gap.
    pub p0: f64,
    /// The gap at which it has fallen to 1 %.
    pub c0: f64,
    /// The gap beyond which nothing acts; infinite where it acts at any distance.
    pub within: f64,
}

impl Exponential {
    /// The gap below which the curve is its tangent, over c0.
    const STRAIGHT: f64 = -2.0;

    fn rate(&self) -> f64 {
        0.01_f64.ln() / self.c0
    }

    /// Pressure and slope of the curve itself.
    fn at(&self, gap: f64) -> (f64, f64) {
        let p = self.p0 * (self.rate() * gap).exp();
        (p, self.rate() * p)
    }

    /// The potential, zero far outside.
    fn potential(&self, gap: f64) -> f64 {
        let bend = gap.max(Self::STRAIGHT * self.c0);
        let (value, slope) = self.at(bend);
        let further = gap - bend;
        -value / self.rate() - value * further - 0.5 * slope * further * further
    }
}

impl ContactLaw for Exponential {
    fn pressure(&self, gap: f64, _: f64, _: &Scale) -> Eval {
        if gap > self.within {
            return Eval::default();
        }
        let bend = gap.max(Self::STRAIGHT * self.c0);
        let (value, slope) = self.at(bend);
        Eval {
            value: value + slope * (gap - bend),
            dgap: slope,
            dlambda: 0.0,
        }
    }

    fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
        let beyond = match self.within.is_finite() {
            true => self.potential(self.within),
            false => 0.0,
        };
        Some(self.potential(gap.min(self.within)) - beyond)
    }
}

/// A penalty whose corner is rounded by an arctangent, with a tension that remains at a distance.
///
/// `p = K d (1/2 + atan(d/ε)/π)` at the penetration `d = −g`, with `ε = π t/K`: far inside it is `K d − t`, far outside the
/// tension `t`. Beyond `within` facets there is nothing; the pressure jumps there by less than `t`.
///
/// # Source
/// CalculiX CrunchiX User's Manual, node-to-face penalty contact, linear pressure-overclosure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arctangent {
    /// K: pressure per penetration, far inside.
    pub stiffness: f64,
    /// t: the tension at a distance, positive.
    pub tension: f64,
    /// The gap beyond which nothing acts, over the size of the facets; infinite where it acts at any distance.
    pub within: f64,
}

impl Arctangent {
    fn width(&self) -> f64 {
        PI * self.tension / self.stiffness
    }

    /// The potential, zero at d = 0.
    fn potential(&self, d: f64) -> f64 {
        let width = self.width();
        let rounded = (d * d + width * width) * (d / width).atan() - width * d;
        self.stiffness * (0.25 * d * d + rounded / (2.0 * PI))
    }
}

impl ContactLaw for Arctangent {
    fn pressure(&self, gap: f64, _: f64, scale: &Scale) -> Eval {
        if gap > self.within * scale.length {
            return Eval::default();
        }
        let (d, width) = (-gap, self.width());
        let share = 0.5 + (d / width).atan() / PI;
        let bend = d * width / (PI * (d * d + width * width));
        Eval {
            value: self.stiffness * d * share,
            dgap: -self.stiffness * (share + bend),
            dlambda: 0.0,
        }
    }

    fn energy(&self, gap: f64, _: f64, scale: &Scale) -> Option<f64> {
        let end = self.within * scale.length;
        let beyond = if end.is_finite() {
            self.potential(-end)
        } else {
            0.0
        };
        Some(self.potential(-gap.min(end)) - beyond)
    }
}

/// A pressure that is linear between rows of gap and pressure; below the first row it goes on with the slope there,
/// beyond the last it stays what it is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    rows: Vec<[f64; 2]>,
    // energy at each row
    energies: Vec<f64>,
}

/// Why a table is no contact law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TableError {
    /// One row says nothing about a slope.
    #[error("a table of gap and pressure needs two rows at least")]
    TooShort,
    /// Gaps that do not increase.
    #[error("row {row}: gaps increase from row to row")]
    Gap {
        /// The row, from 1.
        row: usize,
    },
    /// A pressure that is negative or grows with the gap.
    #[error("row {row}: pressures are not negative and do not grow with the gap")]
    Pressure {
        /// The row, from 1.
        row: usize,
    },
}

impl Table {
    /// The law with these rows of gap and pressure.
    ///
    /// # Errors
    /// Fewer than two rows; gaps that do not increase; pressures that are negative or grow with the gap.
    pub fn new(rows: Vec<[f64; 2]>) -> Result<Self, TableError> {
        if rows.len() < 2 {
            return Err(TableError::TooShort);
        }
        for (row, pair) in rows.windows(2).enumerate() {
            let row = row + 2;
            if pair[1][0].partial_cmp(&pair[0][0]) != Some(Ordering::Greater) {
                return Err(TableError::Gap { row });
            }
            let falls = pair[1][1] <= pair[0][1] && pair[1][1] >= 0.0;
            if !falls {
                return Err(TableError::Pressure { row });
            }
        }
        let mut energies = vec![0.0; rows.len()];
        for k in (1..rows.len()).rev() {
            let [[a, p], [b, q]] = [rows[k - 1], rows[k]];
            energies[k - 1] = energies[k] + 0.5 * (p + q) * (b - a);
        }
        Ok(Self { rows, energies })
    }

    /// The row at the end of the piece a gap is in, and the slope of the piece.
    fn piece(&self, gap: f64) -> (usize, f64) {
        let after = self.rows.partition_point(|row| row[0] <= gap).max(1);
        match (self.rows.get(after - 1), self.rows.get(after)) {
            (Some(a), Some(b)) => (after, (b[1] - a[1]) / (b[0] - a[0])),
            _ => (self.rows.len() - 1, 0.0),
        }
    }
}

impl ContactLaw for Table {
    fn pressure(&self, gap: f64, _: f64, _: &Scale) -> Eval {
        let (end, slope) = self.piece(gap);
        let [at, p] = self.rows.get(end).copied().unwrap_or_default();
        let value = p + slope * (gap - at);
        if value == 0.0 && slope == 0.0 {
            return Eval::default();
        }
        Eval {
            value,
            dgap: slope,
            dlambda: 0.0,
        }
    }

    fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
        let (end, slope) = self.piece(gap);
        let [at, p] = self.rows.get(end).copied().unwrap_or_default();
        let far = gap - at;
        let energy = self.energies.get(end).copied().unwrap_or_default();
        Some(energy - p * far - 0.5 * slope * far * far)
    }
}
