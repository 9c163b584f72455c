//! Which steps are geometrically nonlinear.

use signorini_io::case::{Geometry, Step};

/// Whether the geometry of each step is nonlinear: as it says, else as in the step before; it is in the first. Vibrations feel the
/// stresses about which they are, and say nothing of other steps.
pub(super) fn nonlinear(steps: &[Step]) -> impl Iterator<Item = bool> {
    steps.iter().scan(true, |nonlinear, step| {
        if step.frequency.is_some() {
            return Some(step.geometry != Geometry::Linear);
        }
        *nonlinear = match step.geometry {
            Geometry::Auto => *nonlinear,
            Geometry::Linear => false,
            Geometry::Nonlinear => true,
        };
        Some(*nonlinear)
    })
}
