//! Which steps are geometrically nonlinear.

use signorini_io::case::{Geometry, Step};

/// Whether the geometry of each step is nonlinear: as it says, else as in the step before; it is in the first.
pub(super) fn nonlinear(steps: &[Step]) -> impl Iterator<Item = bool> {
    steps.iter().scan(true, |nonlinear, step| {
        *nonlinear = match step.geometry {
            Geometry::Auto => *nonlinear,
            Geometry::Linear => false,
            Geometry::Nonlinear => true,
        };
        Some(*nonlinear)
    })
}
