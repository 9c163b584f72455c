//! How states follow one another in time: the generalized-α method, and states between two.
//!
//! With displacements `d`, velocities `v` and accelerations `a` at the times n and n+1, `Δd = d₁ − d₀`:
//!
//! ```text
//! αm = (2ρ − 1)/(ρ + 1)   αf = ρ/(ρ + 1)   γ = ½ − αm + αf   β = ¼ (1 − αm + αf)²                (E4)
//! a₁ = (Δd − h v₀ − h² (½ − β) a₀)/(β h²)   v₁ = v₀ + h ((1 − γ) a₀ + γ a₁)                       (E5)
//! x_α = (1 − αf) x₁ + αf x₀                                                                       (E6)
//! M ((1 − αm) a₁ + αm a₀) + f(x_α) = 0                                                            (E7)
//! ```
//!
//! with the spectral radius ρ of the highest frequencies. The method of Hilber, Hughes and Taylor has `αm = 0`, `αf = −α`,
//! `γ = ½ − α`, `β = ¼ (1 − α)²`. The acceleration is an auxiliary quantity, which belongs to the time `t − (αf − αm) h`.
//!
//! Every term is evaluated at `x_α`, and its stiffness is against `x_α`, so that `1 − αf` times that is the one against
//! `d₁`. What a term needs of the end of the increment comes with the state, [`State::between`](super::State::between).
//!
//! With `ρ = 1` a method that conserves energy, [`Scheme::energy_momentum`], is the same scheme, in which forces with a potential are
//! the secants of that between the ends: (E21) of `solid::kernel::secant`, (E9) of `contact::interface::dynamic_gap`, (E10) of
//! `rigid_motion`.
//!
//! [`Scheme::explicit`] needs no equations solved, with masses at nodes alone and accelerations `a = M⁻¹ f(x)`:
//!
//! ```text
//! v_½ = v₀ + ½ h a₀        x₁ = x₀ + h v_½        v₁ = v_½ + ½ h a₁                               (E11)
//! ```
//!
//! It is stable while `h < 2/ω` with the highest natural frequency ω.
//!
//! Sources: Chung and Hulbert, J. Appl. Mech. 60, 1993; Hilber, Hughes and Taylor, EESD 5, 1977; Brüls, Cardona and Arnold,
//! Mech. Mach. Theory 48, 2012 (the time of the acceleration); Hughes, The Finite Element Method, 1987, section 9.1 (E11).

use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};

/// The numbers of a method of the family (E4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// The share of the start of an increment in its inertial forces.
    pub alpha_m: f64,
    /// The share of the start of an increment in all other forces.
    pub alpha_f: f64,
    /// β of (E5).
    pub beta: f64,
    /// γ of (E5).
    pub gamma: f64,
    /// Whether nodes of bodies that contact may act on have no mass; that is with the nodes next to them.
    pub redistributed: bool,
    /// Whether forces of contacts without multipliers are weighted with those before, as other forces are.
    pub weighted: bool,
    /// Whether forces that have a potential do the work of that, so that energy and momenta are conserved.
    pub conserves: bool,
    /// How increments are cut where forces at each cut follow from the state alone (E11); else equations are solved.
    pub explicit: Option<Leapfrog>,
}

/// How long the short increments of an explicit step are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leapfrog {
    /// The part that is taken of the longest that is stable.
    pub safety: f64,
    /// Mass that is added, where any is.
    pub scaling: Option<MassScaling>,
}

/// Mass that is added to elements whose waves are fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassScaling {
    /// How long increments are to be at least, after safety.
    pub step: f64,
    /// The mass that may be added, over that of all bodies.
    pub limit: f64,
}

impl Scheme {
    /// The generalized-α method with this spectral radius of the highest frequencies, from 0 to 1.
    #[must_use]
    pub fn generalized_alpha(radius: f64) -> Self {
        Self::with(
            (2.0 * radius - 1.0) / (radius + 1.0),
            radius / (radius + 1.0),
        )
    }

    /// The method that conserves energy and momenta: that with the spectral radius 1, and secants of potentials.
    #[must_use]
    pub fn energy_momentum() -> Self {
        Self {
            conserves: true,
            ..Self::generalized_alpha(1.0)
        }
    }

    /// The method of Hilber, Hughes and Taylor, `α` from −1/3 to 0; Newmark's trapezoidal rule where it is 0.
    #[must_use]
    pub fn hilber_hughes_taylor(alpha: f64) -> Self {
        Self::with(0.0, -alpha)
    }

    /// Central differences (E11).
    #[must_use]
    pub fn explicit(leapfrog: Leapfrog) -> Self {
        Self {
            beta: 0.0,
            gamma: 0.5,
            explicit: Some(leapfrog),
            ..Self::with(0.0, 0.0)
        }
    }

    fn with(alpha_m: f64, alpha_f: f64) -> Self {
        let sum = 1.0 - alpha_m + alpha_f;
        Self {
            alpha_m,
            alpha_f,
            beta: 0.25 * sum * sum,
            gamma: sum - 0.5,
            redistributed: false,
            weighted: false,
            conserves: false,
            explicit: None,
        }
    }

    /// a₁ after the way `Δd` in the time `h` (E5).
    #[must_use]
    pub fn acceleration(&self, way: Vec3, h: f64, velocity: Vec3, acceleration: Vec3) -> Vec3 {
        let left = way - velocity * h - acceleration * (h * h * (0.5 - self.beta));
        left / (self.beta * h * h)
    }

    /// v₁ (E5), with the accelerations at both ends.
    #[must_use]
    pub fn velocity(&self, h: f64, velocity: Vec3, [first, last]: [Vec3; 2]) -> Vec3 {
        velocity + (first * (1.0 - self.gamma) + last * self.gamma) * h
    }
}

/// Velocities and accelerations of all nodes, and of rigid bodies with a mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// Velocities.
    pub velocity: Vec<Vec3>,
    /// Accelerations, at the time of (E7).
    pub acceleration: Vec<Vec3>,
    /// Those of rigid bodies with a mass, in their order.
    pub bodies: Vec<BodyRates>,
}

impl Rates {
    /// Those of so many nodes at rest, and rigid bodies with a mass.
    #[must_use]
    pub fn at_rest(nnode: usize, nbody: usize) -> Self {
        Self::new(vec![Vec3::ZERO; nnode], vec![BodyRates::default(); nbody])
    }

    /// Those of nodes at these velocities, and of rigid bodies.
    #[must_use]
    pub fn new(velocity: Vec<Vec3>, bodies: Vec<BodyRates>) -> Self {
        Self {
            acceleration: vec![Vec3::ZERO; velocity.len()],
            velocity,
            bodies,
        }
    }

    /// Those at the end of an increment of length `h`, which led the nodes from `from` to `to`. Nodes without mass follow
    /// the others: they have the mean velocity, and no acceleration.
    pub fn advance(
        &mut self,
        scheme: &Scheme,
        h: f64,
        [from, to]: [&[Vec3]; 2],
        massless: &[NodeId],
    ) {
        let ways = to.iter().zip(from).map(|(to, from)| *to - *from);
        let rates = self.velocity.iter_mut().zip(&mut self.acceleration);
        for ((v, a), way) in rates.zip(ways) {
            let last = scheme.acceleration(way, h, *v, *a);
            *v = scheme.velocity(h, *v, [*a, last]);
            *a = last;
        }
        for &node in massless {
            let node = node as usize;
            let ends = to.get(node).zip(from.get(node));
            if let (Some((to, from)), Some(v)) = (ends, self.velocity.get_mut(node)) {
                *v = (*to - *from) / h;
            }
            if let Some(a) = self.acceleration.get_mut(node) {
                *a = Vec3::ZERO;
            }
        }
    }
}

/// How a rigid body with a mass moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyRates {
    /// Of its centroid.
    pub velocity: Vec3,
    /// Of its centroid, at the time of (E7) of `motion`.
    pub acceleration: Vec3,
    /// Angular velocity Ω, along axes that turn with the body (radian per time).
    pub spin: Vec3,
    /// Angular acceleration A, likewise.
    pub spin_rate: Vec3,
}

/// The way of a rigid body in an increment (E8) of `rigid_motion`.
#[derive(Clone, Copy, Debug)]
pub struct BodyWay {
    /// Δs.
    pub centroid: Vec3,
    /// Ψ, or Θ.
    pub turn: Vec3,
    /// R₀ᵀ R₁; 1 where motions are small.
    pub rotation: Mat3,
    /// R s₀ at both ends.
    pub arms: [Vec3; 2],
    /// R₀; 1 where motions are small.
    pub start: Mat3,
}

impl BodyRates {
    /// Those at the end of an increment of length `h` (E9) of `rigid_motion`.
    #[must_use]
    pub fn advanced(&self, scheme: &Scheme, h: f64, way: &BodyWay) -> Self {
        let acceleration = scheme.acceleration(way.centroid, h, self.velocity, self.acceleration);
        let spin_rate = scheme.acceleration(way.turn, h, self.spin, self.spin_rate);
        Self {
            velocity: scheme.velocity(h, self.velocity, [self.acceleration, acceleration]),
            acceleration,
            spin: scheme.velocity(h, self.spin, [self.spin_rate, spin_rate]),
            spin_rate,
        }
    }

    /// As numbers, for archives.
    #[must_use]
    pub fn to_vectors(&self) -> [Vec3; 4] {
        [self.velocity, self.acceleration, self.spin, self.spin_rate]
    }

    /// The inverse of [`BodyRates::to_vectors`].
    #[must_use]
    pub const fn from_vectors([velocity, acceleration, spin, spin_rate]: [Vec3; 4]) -> Self {
        Self {
            velocity,
            acceleration,
            spin,
            spin_rate,
        }
    }
}

/// What a state between the ends of an increment brings with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Between {
    /// αf: the share of the start.
    pub alpha_f: f64,
    /// Δd of every node, from the start of the increment to its end.
    pub way: Vec<Vec3>,
    /// The same of every carrier: a translation, and a rotation vector.
    pub turn: Vec<[Vec3; 2]>,
}

#[cfg(test)]
mod tests {
    use super::{Rates, Scheme};
    use signorini_geometry::tensor::Vec3;

    #[test]
    fn parameters_are_those_of_the_papers() {
        let of = |scheme: Scheme| [scheme.alpha_m, scheme.alpha_f, scheme.beta, scheme.gamma];
        let close = |scheme, wanted: [f64; 4]| {
            let parts = of(scheme).into_iter().zip(wanted);
            parts.for_each(|(got, wanted)| assert!((got - wanted).abs() < 1e-15));
        };
        // trapezoidal rule, midpoint rule, and the largest damping there is
        close(Scheme::hilber_hughes_taylor(0.0), [0.0, 0.0, 0.25, 0.5]);
        close(Scheme::generalized_alpha(1.0), [0.5, 0.5, 0.25, 0.5]);
        close(Scheme::generalized_alpha(0.0), [-1.0, 0.0, 1.0, 1.5]);
        close(
            Scheme::hilber_hughes_taylor(-0.05),
            [0.0, 0.05, 0.275_625, 0.55],
        );
    }

    #[test]
    fn motions_at_constant_acceleration_are_exact() {
        for scheme in [
            Scheme::generalized_alpha(0.8),
            Scheme::generalized_alpha(0.0),
            Scheme::hilber_hughes_taylor(-0.1),
        ] {
            let (v, a, h) = (Vec3::new(1.0, -2.0, 0.5), Vec3::new(0.3, 4.0, 1.0), 0.37);
            let mut rates = Rates {
                velocity: vec![v],
                acceleration: vec![a],
                bodies: Vec::new(),
            };
            let to = v * h + a * (0.5 * h * h);
            rates.advance(&scheme, h, [&[Vec3::ZERO], &[to]], &[]);
            assert!((rates.acceleration[0] - a).norm() < 1e-13);
            assert!((rates.velocity[0] - v - a * h).norm() < 1e-13);
        }
    }
}
