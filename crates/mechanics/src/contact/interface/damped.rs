//! Contacts that damp the motion of their sides.
//!
//! ```text
//! p = p(γ) − c ġ ≥ 0        ġ = b·Δd/h        t = c_t P Bᵀ Δd/h                                  (E11)
//! ```
//!
//! where the law acts; what pulls is cut off unless [`Damping::pulls`]. The tangent takes ∂ġ/∂d = q/h, with the gradient q of the
//! gap: exact where sides are flat, or energy is conserved. The shear t resists slip, with friction and without; its tangent is exact.
//! Dampers act as a whole where other forces count with those before.

use super::{Interface, Rows, State, TermError};
use crate::contact::law::{Damping, Eval, Multiplier};
use crate::contact::row::{RowOrder, Viscous};

impl Interface {
    /// What damps over a length of time; nothing where nothing does, or multipliers or bonds hold the rows.
    fn damping(&self) -> Option<Damping> {
        let has_pressure = self.parts.law.multiplier() == Multiplier::None;
        let damps = has_pressure && self.parts.bond.is_none() && self.duration > 0.0;
        Some(self.parts.damping).filter(|damping| damps && damping.acts())
    }

    /// Whether slip is damped.
    pub(super) fn drags(&self) -> bool {
        self.damping()
            .is_some_and(|damping| damping.tangential > 0.0)
    }

    /// What damps a row whose gap changes by this in the increment.
    pub(super) fn viscous(&self, change: f64) -> Viscous {
        let share = self.share_of_elastic();
        let of = |damping: Damping| {
            let slope = damping.normal / (self.duration * share);
            Viscous {
                pressure: -slope * change,
                slope,
                pulls: damping.pulls,
                drag: damping.tangential / (self.duration * share),
            }
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
            if seen.viscous.slope > 0.0 {
                let change = -seen.viscous.pressure / seen.viscous.slope;
                // where nothing presses any more, what the law has left is lost, too
                work -= self.measure(row) * (whole.value - elastic.value) * change;
            }
            if whole != Eval::default() {
                let slipped = filled.sliding.way.norm_squared();
                work += self.measure(row) * seen.viscous.drag * slipped;
            }
        }
        Ok(work * self.share_of_elastic())
    }
}
