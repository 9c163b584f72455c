//! Contacts that damp the motion of their sides along the normal.
//!
//! ```text
//! p = p(γ) − c ġ ≥ 0        ġ = b·Δd/h                                                           (E11)
//! ```
//!
//! where the law acts. The tangent takes ∂ġ/∂d = q/h, with the gradient q of the gap: exact where sides are flat, or energy is conserved.

use super::{Interface, Rows, State, TermError};
use crate::contact::law::Multiplier;
use crate::contact::row::{RowOrder, Viscous};

impl Interface {
    /// c/h; nothing where nothing damps, or multipliers or bonds hold the rows.
    fn damping(&self) -> Option<f64> {
        let has_pressure = self.parts.law.multiplier() == Multiplier::None;
        let damps = has_pressure && self.parts.bond.is_none() && self.duration > 0.0;
        let damping = self.parts.damping / self.duration;
        Some(damping).filter(|damping| damps && *damping > 0.0)
    }

    /// What damps a row whose gap changes by this in the increment.
    pub(super) fn viscous(&self, change: f64) -> Viscous {
        let of = |slope: f64| Viscous {
            pressure: -slope * change,
            slope,
        };
        self.damping().map(of).unwrap_or_default()
    }

    /// The work of damping in an increment that ends with this iterate.
    pub(super) fn damped(&self, trial: &State) -> Result<f64, TermError> {
        if self.damping().is_none() || !self.is_active() || trial.between.is_none() {
            return Ok(0.0);
        }
        let (mut rows, mut work) = (Rows::default(), 0.0);
        for row in 0..self.parts.discretization.nrow() {
            self.fill(row, trial, RowOrder::Gradient, &mut rows)?;
            let Some(filled) = rows.rows().first() else {
                continue;
            };
            let (laws, seen) = (self.laws_of(row), filled.seen());
            let at_end = laws.law.pressure(seen.now, 0.0, laws.scale);
            let elastic = laws.elastic_pressure(seen, at_end);
            let whole = laws.in_motion(seen, at_end);
            let change = -seen.viscous.pressure / seen.viscous.slope;
            // where nothing presses any more, what the law has left is lost, too
            work -= self.measure(row) * (whole.value - elastic.value) * change;
        }
        Ok(work)
    }
}
