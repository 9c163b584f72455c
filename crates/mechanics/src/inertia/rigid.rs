//! The inertia of rigid bodies.

use crate::system::{
    BodyRates, BodyWay, Dof, Frame, Layout, Lifetime, Order, Part, PatternSink, Phase, Properties,
    RigidMass, Role, Scheme, Sink, State, Symmetry, Term, TermError, Work,
};
use signorini_geometry::tensor::{Mat3, Vec3};
use std::sync::Arc;

/// Bodies evaluated together.
const CHUNK: usize = 64;

/// The inertia of rigid bodies with a mass: (E5), (E6).
pub struct RigidInertia {
    layout: Layout,
    pub(super) bodies: Arc<[RigidMass]>,
    step: Option<Scheme>,
    /// The length of the increment; 0 where none has begun.
    h: f64,
    /// Whether motions are small.
    is_small: bool,
    /// At the start of the increment, of each body: where its carrier is, and how it has turned.
    starts: Vec<(Vec3, Mat3)>,
    /// Rates there.
    rates: Vec<BodyRates>,
    /// Kinetic energy at the start of the run.
    at_start: f64,
}

/// Force and moment about the reference point, and their derivatives with respect to translation and rotation, by blocks.
struct Wrench {
    parts: [Vec3; 2],
    slopes: [[Mat3; 2]; 2],
}

impl RigidInertia {
    /// That of these bodies, which have these rates at the start of the run.
    #[must_use]
    pub fn new(layout: Layout, bodies: Arc<[RigidMass]>, rates: &[BodyRates]) -> Self {
        let energies = bodies.iter().zip(rates);
        Self {
            layout,
            step: None,
            h: 0.0,
            is_small: true,
            starts: Vec::new(),
            rates: vec![BodyRates::default(); bodies.len()],
            at_start: energies.map(|(body, rates)| body.kinetic(rates)).sum(),
            bodies,
        }
    }

    /// Whether accelerations follow from forces, so that there are no forces of inertia.
    fn is_explicit(&self) -> bool {
        self.step.is_some_and(|step| step.explicit.is_some())
    }

    fn dofs(&self, body: &RigidMass) -> [Dof; 6] {
        self.layout.of_carrier(body.carrier)
    }

    /// Whether all stiffness is symmetric: where motions are small, and in the plane about the centroid.
    fn is_symmetric(&self) -> bool {
        let is_central = || self.bodies.iter().all(|body| body.arm == Vec3::ZERO);
        self.is_small || self.layout.ndim() < 3 && is_central()
    }

    /// The rounding errors of force and moment: those of positions and angles, times what a way makes of them.
    fn rounding(
        &self,
        body: &RigidMass,
        rates: &BodyRates,
        scheme: &Scheme,
        place: Vec3,
    ) -> [f64; 2] {
        let h = self.h;
        let slope = (1.0 - scheme.alpha_m) / (scheme.beta * h * h);
        let far = place.max_abs() + body.arm.norm() + h * rates.velocity.norm();
        let force = f64::EPSILON * body.mass * slope * far;
        let inertia = body.inertia.trace().abs();
        let angle = 1.0 + h * rates.spin.norm();
        let about = inertia * (slope * angle + rates.spin.norm_squared());
        [force, f64::EPSILON * about + force * body.arm.norm()]
    }

    /// Mass, and what turning with the present angular velocity needs: where a step begins.
    fn at_rest(&self, body: &RigidMass, rates: &BodyRates, state: &State) -> Wrench {
        let rotation = body.rotation(state);
        let arm = rotation * body.arm;
        let (inertia, spin) = (body.inertia.to_mat3(), rates.spin);
        let (mut inward, mut gyroscopic) = (Vec3::ZERO, Vec3::ZERO);
        if !state.is_small {
            let turning = rotation * spin;
            inward = turning.cross(turning.cross(arm)) * body.mass;
            gyroscopic = rotation * spin.cross(inertia * spin);
        }
        Wrench {
            parts: [inward, arm.cross(inward) + gyroscopic],
            slopes: body.matrix(rotation),
        }
    }

    /// (E5) at a state between the ends of the increment, with the derivative (E6) against its end.
    fn between(
        &self,
        body: &RigidMass,
        rates: &BodyRates,
        scheme: &Scheme,
        start: Mat3,
        trial: &State,
    ) -> Wrench {
        let h = self.h;
        let turns = trial.between.as_ref().map(|between| &between.turn);
        let moved = turns.and_then(|turns| turns.get(body.carrier as usize).copied());
        let way = body.way(scheme, start, self.is_small, moved.unwrap_or_default());
        let (left, right) = (1.0 - scheme.alpha_f, scheme.alpha_f);
        let [first, last] = way.arms;
        let arm = last * left + first * right;
        let end = rates.advanced(scheme, h, &way);
        let mean = |last: Vec3, first: Vec3| last * (1.0 - scheme.alpha_m) + first * scheme.alpha_m;
        let slope = (1.0 - scheme.alpha_m) / (scheme.beta * h * h);

        let force = mean(end.acceleration, rates.acceleration) * body.mass;
        let weight = body.mass * slope;
        let (lever, lever_end) = (Mat3::skew(arm), Mat3::skew(last));

        let (torque, stiffness) = if self.is_small {
            let inertia = body.inertia.to_mat3();
            let torque = inertia * mean(end.spin_rate, rates.spin_rate);
            (torque, inertia * slope)
        } else if scheme.conserves {
            self.conserving_torque(body, [rates, &end], &way)
        } else {
            self.torque(body, [rates, &end], scheme, &way)
        };
        let turning = if self.is_small {
            Mat3::ZERO
        } else {
            Mat3::skew(force) * lever_end * left
        };
        Wrench {
            parts: [force, arm.cross(force) + torque],
            slopes: [
                [Mat3::IDENTITY * weight, lever_end * -weight],
                [
                    lever * weight,
                    stiffness + turning - lever * lever_end * weight,
                ],
            ],
        }
    }

    /// What turns a body about its centroid (E5), with the derivative (E6) against the end of the increment.
    fn torque(
        &self,
        body: &RigidMass,
        [rates, end]: [&BodyRates; 2],
        scheme: &Scheme,
        way: &BodyWay,
    ) -> (Vec3, Mat3) {
        let Scheme {
            alpha_m,
            alpha_f,
            beta,
            gamma,
            ..
        } = *scheme;
        let (h, left) = (self.h, 1.0 - alpha_f);
        let inertia = body.inertia.to_mat3();
        let gyroscopic = |spin: Vec3| spin.cross(inertia * spin);
        let mean = end.spin_rate * (1.0 - alpha_m) + rates.spin_rate * alpha_m;
        let turning = gyroscopic(end.spin) * left + gyroscopic(rates.spin) * alpha_f;
        let torque = inertia * mean + turning;
        let spin = Mat3::skew(end.spin) * inertia - Mat3::skew(inertia * end.spin);
        let slope = (1.0 - alpha_m) / (beta * h * h);
        let stiffness = inertia * slope + spin * (left * gamma / (beta * h));
        // dΨ for a rotation of the end in its own axes, and what that does to the rotation between
        let tangent = inverse_tangent(way.turn);
        let share = self::tangent(way.turn * left) * tangent * left;
        let rotation = way.start * Mat3::rotation(way.turn * left);
        let back = (way.start * way.rotation).transpose();
        let stiffness = rotation * (stiffness * tangent - Mat3::skew(torque) * share) * back;
        (rotation * torque, stiffness)
    }

    /// The same of a method that conserves energy (E7), with its derivative.
    fn conserving_torque(
        &self,
        body: &RigidMass,
        [rates, end]: [&BodyRates; 2],
        way: &BodyWay,
    ) -> (Vec3, Mat3) {
        let inertia = body.inertia.to_mat3();
        let rotation = way.start * way.rotation;
        let [before, after] = [
            way.start * (inertia * rates.spin),
            rotation * (inertia * end.spin),
        ];
        let tangent = inverse_cayley(way.turn) * rotation.transpose();
        let stiffness = rotation * inertia * tangent * (2.0 / self.h) - Mat3::skew(after);
        let each = self.h.recip();
        ((after - before) * each, stiffness * each)
    }
}

/// dΘ/dδ of Cayley's vector: `cay(Θ + dΘ) = cay(Θ) exp(dδ)`.
fn inverse_cayley(turn: Vec3) -> Mat3 {
    let k = Mat3::skew(turn);
    Mat3::IDENTITY + k * 0.5 + Mat3::outer(turn, turn) * 0.25
}

/// T(Ψ): `exp(Ψ + dΨ) = exp(Ψ) exp(T dΨ)`.
fn tangent(turn: Vec3) -> Mat3 {
    let (squared, k) = (turn.norm_squared(), Mat3::skew(turn));
    let angle = squared.sqrt();
    let (a, b) = if angle < 1e-3 {
        (0.5 - squared / 24.0, 1.0 / 6.0 - squared / 120.0)
    } else {
        let half = (0.5 * angle).sin() / angle;
        (2.0 * half * half, (angle - angle.sin()) / (squared * angle))
    };
    Mat3::IDENTITY - k * a + k * k * b
}

/// T⁻¹(Ψ), for less than a whole turn.
fn inverse_tangent(turn: Vec3) -> Mat3 {
    let (squared, k) = (turn.norm_squared(), Mat3::skew(turn));
    let angle = squared.sqrt();
    let c = if angle < 1e-3 {
        1.0 / 12.0 + squared / 720.0
    } else {
        1.0 / squared - 0.5 / (angle * (0.5 * angle).tan())
    };
    Mat3::IDENTITY + k * 0.5 + k * k * c
}

impl Term for RigidInertia {
    fn name(&self) -> &str {
        "inertia of rigid bodies"
    }

    fn properties(&self) -> Properties {
        let (symmetry, lifetime) = match self.is_symmetric() {
            true => (Symmetry::Definite, Lifetime::Increment),
            false => (Symmetry::Unsymmetric, Lifetime::State),
        };
        Properties {
            lifetime,
            to_end: true,
            elements: u64::from(self.step.is_some()),
            ..Properties::new(symmetry, Part::Interface).with_role(Role::Inertia)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for body in self.bodies.iter().filter(|_| self.step.is_some()) {
            out.interface(&self.dofs(body));
        }
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        self.step = phase.step.scheme;
        self.h = phase.dt();
        self.is_small = from.is_small;
        if self.is_explicit() {
            return Ok(());
        }
        self.starts.clear();
        self.starts.extend(self.bodies.iter().map(|body| {
            let pose = from.poses.get(body.carrier as usize);
            let place = pose.map_or(Vec3::ZERO, |pose| pose.origin);
            (place, body.rotation(from))
        }));
        match from.rates.as_ref().filter(|_| self.step.is_some()) {
            Some(rates) => self.rates.clone_from(&rates.bodies),
            None => self.rates.fill(BodyRates::default()),
        }
        Ok(())
    }

    fn nchunk(&self) -> usize {
        match self.step {
            Some(_) => self.bodies.len().div_ceil(CHUNK),
            None => 0,
        }
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        if self.is_explicit() {
            return Ok(());
        }
        let begun = self.step.as_ref().filter(|_| self.h > 0.0);
        let all = self.bodies.iter().zip(&self.rates).zip(&self.starts);
        for ((body, rates), &(place, start)) in all.skip(chunk * CHUNK).take(CHUNK) {
            let wrench = match begun {
                Some(scheme) => self.between(body, rates, scheme, start, trial),
                None => self.at_rest(body, rates, trial),
            };
            let force: [f64; 6] = std::array::from_fn(|k| wrench.parts[k / 3][k % 3]);
            let mut stiffness = [0.0; 36];
            if order == Order::Tangent {
                for (k, value) in stiffness.iter_mut().enumerate() {
                    let (i, j) = (k / 6, k % 6);
                    *value = wrench.slopes[i / 3][j / 3].rows[i % 3][j % 3];
                }
            }
            let dofs = self.dofs(body);
            if let Some(scheme) = begun {
                let [along, about] = self.rounding(body, rates, scheme, place);
                out.uncertain(&dofs[..3], along);
                out.uncertain(&dofs[3..], about);
            }
            match order {
                Order::Tangent => out.add(&dofs, &force, &stiffness),
                Order::Residual => out.add(&dofs, &force, &[]),
            }
        }
        Ok(())
    }

    fn energy(&self, _: usize, _: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        // a motion in time has no potential
        Ok(None)
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        let Some(rates) = &state.rates else {
            return Ok(());
        };
        let energies = frame.energies.get_or_insert_default();
        energies.kinetic_at_start += self.at_start;
        for (body, rates) in self.bodies.iter().zip(&rates.bodies) {
            energies.kinetic += body.kinetic(rates);
            if let Some(rigid) = frame.rigid.get_mut(body.carrier as usize) {
                [rigid.velocity, _] = body.at(state, rates, Vec3::ZERO);
                rigid.angular_velocity = body.rotation(state) * rates.spin;
            }
        }
        Ok(())
    }
}
