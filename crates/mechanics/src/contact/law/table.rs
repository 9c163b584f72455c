use super::{ContactLaw, Eval, Scale, each};
use std::cmp::Ordering;
use thiserror::Error;

/// A pressure that is linear between rows of gap and pressure; below the first row it goes on with the slope there,
/// beyond the last it stays what it is there.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{ContactLaw, Scale, Table};
///
/// let law = Table::new(vec![[-0.1, 40.0], [0.0, 0.0]])?;
/// let scale = Scale { penalty: 1.0, shear: 1.0, length: 1.0 };
/// // linear between the rows, and below the first
/// assert!((law.pressure(-0.05, 0.0, &scale).value - 20.0).abs() < 1e-12);
/// assert!((law.pressure(-0.2, 0.0, &scale).value - 80.0).abs() < 1e-12);
/// assert!(Table::new(vec![[0.0, 0.0], [0.1, 40.0]]).is_err());
/// # Ok::<(), signorini_mechanics::contact::law::TableError>(())
/// ```
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
    fn name(&self) -> &str {
        "table"
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], _: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, _| {
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
        });
    }

    fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
        let (end, slope) = self.piece(gap);
        let [at, p] = self.rows.get(end).copied().unwrap_or_default();
        let far = gap - at;
        let energy = self.energies.get(end).copied().unwrap_or_default();
        Some(energy - p * far - 0.5 * slope * far * far)
    }
}
