//! How rigid bodies with a mass move in time: their centroids as nodes do, and rotations about these.
//!
//! With the rotations `R₀` and `R₁` at the ends of an increment, `R₁ = R₀ exp(Ψ)`, the vector `Ψ` and angular velocities `Ω` and
//! accelerations `A` in axes that turn with the body follow one another as `Δd`, `v` and `a` do in (E5) of `motion`:
//!
//! ```text
//! s = x + R s₀        Δs = Δx + (R₁ − R₀) s₀        Ψ = log(R₀ᵀ R₁)                               (E8)
//! A₁ = (Ψ − h Ω₀ − h² (½ − β) A₀)/(β h²)        Ω₁ = Ω₀ + h ((1 − γ) A₀ + γ A₁)                   (E9)
//! ```
//!
//! with the centroid `s`, its arm `s₀` from the reference point `x` at the start. Where motions are small, `R = 1` and `Ψ = Δθ`.
//!
//! A method that conserves energy has Cayley's vector in the place of `Ψ`, with `Ω₁ + Ω₀ = 2 Θ/h`:
//!
//! ```text
//! R₁ = R₀ cay(Θ)        cay(Θ) = 1 + ([Θ]× + ½ [Θ]×²)/(1 + ¼ Θ·Θ)        Θ = 2 tan(ψ/2) Ψ/ψ       (E10)
//! (R₁ − R₀) s = R₀ Θ × ½ (R₀ + R₁) s
//! ```
//!
//! so that the way of a point of the body is that of a rotation about its mean place, and moments do exactly the work of forces.
//!
//! Sources: Brüls and Cardona, J. Comput. Nonlinear Dyn. 5, 2010; Simo and Wong, Int. J. Numer. Meth. Eng. 31, 1991 (E10).

use super::motion::{BodyRates, BodyWay, Scheme};
use super::{Layout, State};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// The mass of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMass {
    /// What it moves with.
    pub carrier: RigidId,
    /// Its mass.
    pub mass: f64,
    /// From the reference point of the carrier to its centroid, at the start.
    pub arm: Vec3,
    /// Its moments of inertia about the centroid, along the axes of the frame at the start: those that turn with it.
    pub inertia: Sym3,
}

/// How a carrier gets from one state to another: its translation, and the vector of the rotation between, by the scheme (Cayley's
/// where it conserves).
pub fn moved(
    scheme: &Scheme,
    layout: &Layout,
    [from, to]: [&State; 2],
    carrier: RigidId,
) -> [Vec3; 2] {
    let (Some(start), Some(end)) = (
        from.poses.get(carrier as usize),
        to.poses.get(carrier as usize),
    ) else {
        return [Vec3::ZERO; 2];
    };
    let turn = if to.is_small {
        let angle = |axis: usize| {
            let dof = layout.rotation(carrier, axis) as usize;
            let ends = to.u.get(dof).zip(from.u.get(dof));
            ends.map_or(0.0, |(to, from)| to - from)
        };
        Vec3::new(angle(0), angle(1), angle(2))
    } else {
        scheme.turn((end.rotation * start.rotation.transpose()).rotation_vector())
    };
    [end.origin - start.origin, turn]
}

impl Scheme {
    /// The vector of a rotation by Ψ, a rotation vector: that, or Cayley's (E10).
    pub(crate) fn turn(&self, rotation: Vec3) -> Vec3 {
        let angle = rotation.norm();
        if !self.conserves || angle == 0.0 {
            return rotation;
        }
        rotation * (2.0 * (0.5 * angle).tan() / angle)
    }

    /// The inverse of [`Scheme::turn`]: the rotation with this vector.
    pub(crate) fn rotation(&self, turn: Vec3) -> Mat3 {
        if !self.conserves {
            return Mat3::rotation(turn);
        }
        let k = Mat3::skew(turn);
        Mat3::IDENTITY + (k + k * k * 0.5) * (1.0 + 0.25 * turn.norm_squared()).recip()
    }
}

impl RigidMass {
    /// Its moments of inertia about the reference point, at the start.
    #[must_use]
    pub fn about_reference(&self) -> Sym3 {
        let square = self.mass * self.arm.norm_squared();
        let along = Sym3::symmetric_part(Mat3::outer(self.arm, self.arm)) * self.mass;
        self.inertia + Sym3::diagonal(square, square, square) - along
    }

    /// Its mass between translations of the reference point and rotations, by blocks, where it has turned by `rotation`.
    #[must_use]
    pub fn matrix(&self, rotation: Mat3) -> [[Mat3; 2]; 2] {
        let lever = Mat3::skew(rotation * self.arm);
        let inertia = rotation * self.inertia.to_mat3() * rotation.transpose();
        [
            [Mat3::IDENTITY * self.mass, lever * -self.mass],
            [lever * self.mass, inertia - lever * lever * self.mass],
        ]
    }

    /// Its way from where it has turned by `start`, [`RigidMass::rotation`], with this translation and rotation of its carrier, see
    /// [`moved`].
    #[must_use]
    pub fn way(
        &self,
        scheme: &Scheme,
        start: Mat3,
        is_small: bool,
        [translation, turn]: [Vec3; 2],
    ) -> BodyWay {
        if is_small {
            return BodyWay {
                centroid: translation + turn.cross(self.arm),
                turn,
                rotation: Mat3::IDENTITY,
                arms: [self.arm; 2],
                start,
            };
        }
        let turn = start.transpose() * turn;
        let rotation = scheme.rotation(turn);
        let arms = [start * self.arm, start * (rotation * self.arm)];
        BodyWay {
            centroid: translation + arms[1] - arms[0],
            turn,
            rotation,
            arms,
            start,
        }
    }

    /// The same from one state to another.
    #[must_use]
    pub fn way_between(
        &self,
        scheme: &Scheme,
        layout: &Layout,
        [from, to]: [&State; 2],
    ) -> BodyWay {
        let moved = moved(scheme, layout, [from, to], self.carrier);
        self.way(scheme, self.rotation(from), from.is_small, moved)
    }

    /// R at a state; 1 where motions are small.
    #[must_use]
    pub fn rotation(&self, state: &State) -> Mat3 {
        let pose = state.poses.get(self.carrier as usize);
        let turned = pose.filter(|_| !state.is_small);
        turned.map_or(Mat3::IDENTITY, |pose| pose.rotation)
    }

    /// What it has of a motion of its reference point and about it: rates of the centroid. Angular velocity and acceleration
    /// are those in space.
    #[must_use]
    pub fn rates(
        &self,
        state: &State,
        [velocity, spin]: [Vec3; 2],
        [acceleration, spin_rate]: [Vec3; 2],
    ) -> BodyRates {
        let rotation = self.rotation(state);
        let (arm, back) = (rotation * self.arm, rotation.transpose());
        let inward = if state.is_small {
            Vec3::ZERO
        } else {
            spin.cross(spin.cross(arm))
        };
        BodyRates {
            velocity: velocity + spin.cross(arm),
            acceleration: acceleration + spin_rate.cross(arm) + inward,
            spin: back * spin,
            spin_rate: back * spin_rate,
        }
    }

    /// The velocity and acceleration of a point that is fixed to it at `arm` from the reference point, at a state.
    #[must_use]
    pub fn at(&self, state: &State, rates: &BodyRates, arm: Vec3) -> [Vec3; 2] {
        let rotation = self.rotation(state);
        let away = arm - rotation * self.arm;
        let (spin, spin_rate) = (rotation * rates.spin, rotation * rates.spin_rate);
        let inward = if state.is_small {
            Vec3::ZERO
        } else {
            spin.cross(spin.cross(away))
        };
        let velocity = rates.velocity + spin.cross(away);
        [
            velocity,
            rates.acceleration + spin_rate.cross(away) + inward,
        ]
    }

    /// ½ m v·v + ½ Ω·J Ω.
    #[must_use]
    pub fn kinetic(&self, rates: &BodyRates) -> f64 {
        let turning = rates.spin.dot(self.inertia.to_mat3() * rates.spin);
        0.5 * (self.mass * rates.velocity.norm_squared() + turning)
    }
}
