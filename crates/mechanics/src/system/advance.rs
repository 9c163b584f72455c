//! How states move: displacements add, rotations compose, dependent nodes follow.

use super::{Elimination, Layout, Scheme, State, moved};
use signorini_geometry::surface::Pose;
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
            rates: None,
            between: None,
            correction: Vec::new(),
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
        self.correction.clear();
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

    /// Keeps the correction from another state to this one.
    pub fn correct_from(&mut self, before: &State) {
        let changes = self
            .u
            .iter()
            .zip(&before.u)
            .map(|(now, before)| now - before);
        self.correction.clear();
        self.correction.extend(changes);
    }

    /// Becomes the state between an accepted one and the trial at the end of its increment, (E6). Multipliers, and fields
    /// besides displacements, are those of the trial. Allocates nothing when all states belong to the same system.
    pub fn set_between(&mut self, scheme: &Scheme, layout: &Layout, [from, to]: [&Self; 2]) {
        let alpha_f = scheme.alpha_f;
        let mut between = self.between.take().unwrap_or_default();
        between.alpha_f = alpha_f;
        let ways = to.x.iter().zip(&from.x);
        between.way.clear();
        between.way.extend(ways.map(|(to, from)| *to - *from));
        between.turn.clear();
        let carriers = 0..to.poses.len() as u32;
        let ways = carriers.map(|carrier| moved(scheme, layout, [from, to], carrier));
        between.turn.extend(ways);
        self.time = (1.0 - alpha_f) * to.time + alpha_f * from.time;
        self.is_small = to.is_small;
        self.u.clone_from(&to.u);
        let motions = self.u.iter_mut().zip(&from.u).take(layout.nmotion());
        motions.for_each(|(u, from)| *u += alpha_f * (from - *u));
        self.x.clone_from(&to.x);
        let places = self.x.iter_mut().zip(&between.way);
        places.for_each(|(x, way)| *x -= *way * alpha_f);
        let blend = |from: Mat3, to: Mat3| to * (1.0 - alpha_f) + from * alpha_f;
        self.poses.clear();
        let poses = from.poses.iter().zip(&to.poses);
        // the mean of both arms: what nodes of a body do between is the mean of what they do at both ends
        self.poses.extend(poses.map(|(from, to)| Pose {
            origin: to.origin * (1.0 - alpha_f) + from.origin * alpha_f,
            rotation: blend(from.rotation, to.rotation),
        }));
        self.between = Some(between);
    }
}

/// One step towards the nearest rotation, `R ← R (3 − Rᵀ R)/2`: the rounding errors of many turns do not add up.
fn orthonormalized(r: Mat3) -> Mat3 {
    r * (Mat3::IDENTITY * 1.5 - r.transpose() * r * 0.5)
}
