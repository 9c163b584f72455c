//! How states move: displacements add, rotations compose, dependent nodes follow.

use super::{Elimination, Layout, State};
use signorini_geometry::tensor::{Mat3, Vec3};

impl State {
    /// The undeformed state.
    #[must_use]
    pub fn initial(layout: &Layout, reference: &[Vec3], elimination: &Elimination) -> Self {
        Self {
            time: 0.0,
            u: vec![0.0; layout.ndof()],
            is_small: false,
            poses: elimination.initial_poses(),
            x: reference.to_vec(),
        }
    }

    /// Becomes `base` advanced by `alpha · du`. Rotations compose, dependent nodes follow. Allocates nothing when both
    /// states belong to the same system.
    pub fn advance_from(
        &mut self,
        base: &State,
        du: &[f64],
        alpha: f64,
        layout: &Layout,
        reference: &[Vec3],
        elimination: &Elimination,
    ) {
        self.u.clone_from(&base.u);
        self.is_small = base.is_small;
        self.poses.clone_from(&base.poses);
        for (u, d) in self.u.iter_mut().zip(du) {
            *u += alpha * d;
        }
        for (body, pose) in self.poses.iter_mut().enumerate() {
            let increment = |axis| elimination.increment(layout.rotation(body as u32, axis), du);
            let turn = Vec3::new(increment(0), increment(1), increment(2)) * alpha;
            if turn != Vec3::ZERO {
                pose.rotation = orthonormalized(Mat3::rotation(turn) * pose.rotation);
            }
        }
        elimination.follow(self, layout, reference);
        for (node, (x, at)) in self.x.iter_mut().zip(reference).enumerate() {
            let first = node * layout.ndim();
            let mut moved = *at;
            for (axis, u) in self.u[first..first + layout.ndim()].iter().enumerate() {
                moved[axis] += u;
            }
            *x = moved;
        }
    }
}

/// One step towards the nearest rotation, `R ← R (3 − Rᵀ R)/2`: the rounding errors of many turns do not add up.
fn orthonormalized(r: Mat3) -> Mat3 {
    r * (Mat3::IDENTITY * 1.5 - r.transpose() * r * 0.5)
}
