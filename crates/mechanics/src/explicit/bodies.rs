//! What moves as a whole in explicit steps: rigid bodies with a mass, and references that nodes with a mass follow.
//!
//! Where all motions are free, the centroid moves as a node does, and the angular momentum about it as its momentum; the angular
//! velocity of a short increment is that of the mean orientation,
//!
//! ```text
//! L_½ = L₀ + ½ h m₀        ω = R_½ J⁻¹ R_½ᵀ L_½        R_½ = exp(½ h ω) R₀        R₁ = exp(h ω) R₀   (E1)
//! ```
//!
//! so that it stays as it is where no moment acts, and motions run backwards as they came. Where some motions are prescribed, the
//! others follow from the equations about the reference point, (E6) of `inertia` at the end of the increment, with what turning
//! needs at the velocity that is foreseen there.

use crate::system::{BodyRates, Dof, Layout, NO_DOF, NodeId, Rates, RigidMass, State, System};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// Iterations of (E1): each gains a factor of `h ω`.
const TURNS: usize = 8;

/// Where a short increment ends.
#[derive(Clone, Copy, Debug)]
pub struct Past {
    /// Half its length; 0 where a step begins.
    pub half: f64,
    /// Half the length of the next one.
    pub next: f64,
}

/// All of them.
#[derive(Default)]
pub struct Bodies {
    pub of: Vec<Body>,
    /// Nodes that follow one of them in all directions, sorted.
    nodes: Vec<NodeId>,
}

/// A node of a deformable body that follows.
struct Follower {
    node: NodeId,
    mass: f64,
    /// From the reference point, at the start.
    arm: Vec3,
}

/// One of them.
pub struct Body {
    /// With that of nodes that follow.
    mass: RigidMass,
    /// Its place among rigid bodies with a mass.
    heavy: Option<usize>,
    nodes: Vec<Follower>,
    pub dofs: [Dof; 6],
    /// Which of its motions are neither prescribed nor without a place.
    free: [bool; 6],
    is_whole: bool,
    /// About the centroid, along axes that turn with the body; 1 about those that it does not turn about.
    inertia: Mat3,
    inverse: Mat3,
    /// At the last end of a short increment.
    rates: BodyRates,
    /// In the middle of the present one: the velocity of the centroid and the angular momentum about it, or velocities of the
    /// reference point and about it.
    middle: [Vec3; 2],
}

impl Bodies {
    /// Those of a step, in which these unknowns are prescribed.
    pub fn of(system: &System, of_nodes: &[f64], prescribed: &[bool]) -> Self {
        let layout = &system.layout;
        let mut bodies = Self::default();
        let carriers = (0..).zip(system.elimination.bodies());
        for (carrier, rigid) in carriers {
            let heavy = system.heavy.iter().position(|body| body.carrier == carrier);
            let follower = |&node: &NodeId| {
                let mass = of_nodes.get(node as usize).copied().filter(|m| *m > 0.0)?;
                let arm = system.reference.get(node as usize).copied()? - rigid.reference;
                Some(Follower { node, mass, arm })
            };
            let nodes: Vec<Follower> = rigid.nodes.iter().filter_map(follower).collect();
            if heavy.is_none() && nodes.is_empty() {
                continue;
            }
            bodies
                .nodes
                .extend(nodes.iter().map(|follower| follower.node));
            let own = heavy.and_then(|at| system.heavy.get(at)).copied();
            let own = own.unwrap_or(RigidMass {
                carrier,
                mass: 0.0,
                arm: Vec3::ZERO,
                inertia: Sym3::default(),
            });
            let mass = gathered(own, &nodes);
            bodies
                .of
                .push(Body::new(mass, heavy, nodes, layout, prescribed));
        }
        bodies.nodes.sort_unstable();
        bodies
    }

    /// Whether the mass of a node is part of one of them.
    pub fn takes(&self, node: NodeId) -> bool {
        self.nodes.binary_search(&node).is_ok()
    }

    /// Takes up how they move at an accepted state.
    pub fn take_up(&mut self, state: &State, heavy: &[RigidMass]) {
        for body in &mut self.of {
            body.take_up(state, heavy);
        }
    }
}

/// The mass of a body with that of nodes that follow it.
fn gathered(own: RigidMass, nodes: &[Follower]) -> RigidMass {
    if nodes.is_empty() {
        return own;
    }
    let mass = own.mass + nodes.iter().map(|of| of.mass).sum::<f64>();
    let arms: Vec3 = nodes.iter().map(|of| of.arm * of.mass).sum();
    let arm = (own.arm * own.mass + arms) / mass;
    let point = |at: Vec3, mass: f64| {
        let square = at.norm_squared();
        let across = Sym3::symmetric_part(Mat3::outer(at, at));
        (Sym3::diagonal(square, square, square) - across) * mass
    };
    let mut inertia = own.inertia + point(own.arm - arm, own.mass);
    for of in nodes {
        inertia = inertia + point(of.arm - arm, of.mass);
    }
    RigidMass {
        carrier: own.carrier,
        mass,
        arm,
        inertia,
    }
}

impl Body {
    fn new(
        mass: RigidMass,
        heavy: Option<usize>,
        nodes: Vec<Follower>,
        layout: &Layout,
        prescribed: &[bool],
    ) -> Self {
        let dofs = layout.of_carrier(mass.carrier);
        let exists = dofs.map(|dof| dof != NO_DOF);
        let about_reference = mass.about_reference();
        let about = [
            about_reference.xx(),
            about_reference.yy(),
            about_reference.zz(),
        ];
        let moves = |k: usize| {
            let has_mass = k < 3 || about[k % 3] > 0.0;
            exists[k] && has_mass && prescribed.get(dofs[k] as usize) != Some(&true)
        };
        let free: [bool; 6] = std::array::from_fn(moves);
        let mut inertia = mass.inertia.to_mat3();
        for axis in 0..3 {
            let is_turned = exists[axis + 3] && inertia.rows[axis][axis] > 0.0;
            if !is_turned {
                for other in 0..3 {
                    inertia.rows[axis][other] = 0.0;
                    inertia.rows[other][axis] = 0.0;
                }
                inertia.rows[axis][axis] = 1.0;
            }
        }
        let inverse = inertia.inverse().map(|(inverse, _)| inverse);
        let is_whole = free == exists && inverse.is_some();
        Self {
            mass,
            heavy,
            nodes,
            dofs,
            free,
            is_whole,
            inertia,
            inverse: inverse.unwrap_or(Mat3::IDENTITY),
            rates: BodyRates::default(),
            middle: [Vec3::ZERO; 2],
        }
    }

    /// Takes up how it moves at an accepted state: the momenta of all that moves with it.
    fn take_up(&mut self, state: &State, heavy: &[RigidMass]) {
        let Some(rates) = &state.rates else {
            self.rates = BodyRates::default();
            return;
        };
        let own = self.heavy.and_then(|at| {
            let of = rates.bodies.get(at).copied().unwrap_or_default();
            Some((heavy.get(at)?, of))
        });
        if self.nodes.is_empty() {
            self.rates = own.map(|(_, rates)| rates).unwrap_or_default();
            return;
        }
        let rotation = self.mass.rotation(state);
        let back = rotation.transpose();
        let centre = rotation * self.mass.arm;
        let (mut momenta, mut forces) = ([Vec3::ZERO; 2], [Vec3::ZERO; 2]);
        let mut add = |at: Vec3, mass: f64, [velocity, acceleration]: [Vec3; 2]| {
            let away = at - centre;
            for (of, rate) in [(&mut momenta, velocity), (&mut forces, acceleration)] {
                of[0] += rate * mass;
                of[1] += away.cross(rate * mass);
            }
        };
        let get = |values: &[Vec3], node: NodeId| values.get(node as usize).copied();
        for of in &self.nodes {
            let moving = [&rates.velocity, &rates.acceleration];
            let moving = moving.map(|rates| get(rates, of.node).unwrap_or_default());
            add(rotation * of.arm, of.mass, moving);
        }
        if let Some((body, of)) = own {
            add(
                rotation * body.arm,
                body.mass,
                [of.velocity, of.acceleration],
            );
            let inertia = body.inertia.to_mat3();
            momenta[1] += rotation * (inertia * of.spin);
            forces[1] += rotation * (inertia * of.spin_rate + of.spin.cross(inertia * of.spin));
        }
        let spin = self.inverse * (back * momenta[1]);
        self.rates = BodyRates {
            velocity: momenta[0] / self.mass.mass,
            acceleration: forces[0] / self.mass.mass,
            spin,
            spin_rate: self.inverse * (back * forces[1] - self.gyroscopic(spin, state.is_small)),
        };
    }

    /// Ω × J Ω; nothing where motions are small.
    fn gyroscopic(&self, spin: Vec3, is_small: bool) -> Vec3 {
        match is_small {
            true => Vec3::ZERO,
            false => spin.cross(self.inertia * spin),
        }
    }

    /// Begins a short increment at a state: what its unknowns do in it, those that are prescribed excepted.
    pub fn leave(&mut self, state: &State, h: f64, du: &mut [f64]) {
        let mut way = [Vec3::ZERO; 2];
        if self.is_whole {
            let rates = &self.rates;
            let rotation = self.mass.rotation(state);
            let velocity = rates.velocity + rates.acceleration * (0.5 * h);
            let arm = rotation * self.mass.arm;
            let moment =
                self.inertia * rates.spin_rate + self.gyroscopic(rates.spin, state.is_small);
            let momentum = rotation * (self.inertia * rates.spin + moment * (0.5 * h));
            self.middle = [velocity, momentum];
            let spin = self.spin_between(rotation, momentum, h, state.is_small);
            let turned = match state.is_small {
                true => (spin * h).cross(arm),
                false => Mat3::rotation(spin * h) * arm - arm,
            };
            way = [velocity * h - turned, spin * h];
        } else {
            let rotation = self.mass.rotation(state);
            let [velocity, acceleration] = self.mass.at(state, &self.rates, Vec3::ZERO);
            let (spin, turning) = (rotation * self.rates.spin, rotation * self.rates.spin_rate);
            self.middle = [
                velocity + acceleration * (0.5 * h),
                spin + turning * (0.5 * h),
            ];
            for (way, middle) in way.iter_mut().zip(self.middle) {
                *way = middle * h;
            }
        }
        for (k, &dof) in self.dofs.iter().enumerate().filter(|(k, _)| self.free[*k]) {
            if let Some(to) = du.get_mut(dof as usize) {
                *to = way[k / 3][k % 3];
            }
        }
    }

    /// ω of (E1).
    fn spin_between(&self, start: Mat3, momentum: Vec3, h: f64, is_small: bool) -> Vec3 {
        if is_small {
            return self.inverse * momentum;
        }
        let at = |rotation: Mat3| rotation * (self.inverse * (rotation.transpose() * momentum));
        let mut spin = at(start);
        for _ in 0..TURNS {
            let next = at(Mat3::rotation(spin * (0.5 * h)) * start);
            let change = (next - spin).norm();
            spin = next;
            if change <= f64::EPSILON * spin.norm() {
                break;
            }
        }
        spin
    }

    /// M⁻¹ of its unknowns at a state, between those that are free: [`Body::respond`] takes it.
    pub fn compliance(&self, state: &State) -> [[f64; 6]; 6] {
        let blocks = self.mass.matrix(self.mass.rotation(state));
        let entry = |i: usize, j: usize| blocks[i / 3][j / 3].rows[i % 3][j % 3];
        inverted(
            std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))),
            self.free,
        )
    }

    /// Sets the rates of its unknowns in the middle of the next short increment, where forces about the reference point act at
    /// its start; those of prescribed unknowns are there.
    pub fn foresee(&self, state: &State, forces: [Vec3; 2], past: Past, rates: &mut [f64]) {
        let h = past.half + past.next;
        let rotation = self.mass.rotation(state);
        let mut foreseen = self.middle;
        if self.is_whole {
            let arm = rotation * self.mass.arm;
            let velocity = self.middle[0] + forces[0] * (h / self.mass.mass);
            let momentum = self.middle[1] + (forces[1] - arm.cross(forces[0])) * h;
            let spin = rotation * (self.inverse * (rotation.transpose() * momentum));
            foreseen = [velocity - spin.cross(arm), spin];
        } else {
            let [acceleration, turning] = self.driven(state, forces, past, rates);
            foreseen[0] += acceleration * h;
            foreseen[1] += turning * h;
        }
        for (k, &dof) in self.dofs.iter().enumerate().filter(|(k, _)| self.free[*k]) {
            if let Some(to) = rates.get_mut(dof as usize) {
                *to = foreseen[k / 3][k % 3];
            }
        }
    }

    /// Accelerations of the reference point and about it where some are prescribed: those that lead to the velocities `next` in
    /// the middle of the next short increment.
    fn driven(&self, state: &State, forces: [Vec3; 2], past: Past, next: &[f64]) -> [Vec3; 2] {
        let rotation = self.mass.rotation(state);
        let arm = rotation * self.mass.arm;
        let old = rotation * self.rates.spin_rate;
        let spin = self.middle[1] + old * past.half;
        let mut left = forces;
        if !state.is_small {
            let inward = spin.cross(spin.cross(arm)) * self.mass.mass;
            let own = rotation.transpose() * spin;
            left[0] -= inward;
            left[1] -= arm.cross(inward) + rotation * own.cross(self.mass.inertia.to_mat3() * own);
        }
        let mut given = [Vec3::ZERO; 2];
        let lead = past.half + past.next;
        for (k, &dof) in self.dofs.iter().enumerate().filter(|(k, _)| !self.free[*k]) {
            let next = next.get(dof as usize).copied();
            given[k / 3][k % 3] = next.map_or(0.0, |v| (v - self.middle[k / 3][k % 3]) / lead);
        }
        for (left, row) in left.iter_mut().zip(self.mass.matrix(rotation)) {
            *left -= row[0] * given[0] + row[1] * given[1];
        }
        let compliance = self.compliance(state);
        let mut rates = given;
        for i in (0..6).filter(|&i| self.free[i]) {
            let row = compliance[i].iter().enumerate();
            rates[i / 3][i % 3] = row.map(|(j, c)| c * left[j / 3][j % 3]).sum();
        }
        rates
    }

    /// Stays at a state where a step begins.
    pub fn stay(&mut self, state: &State) {
        let rotation = self.mass.rotation(state);
        let [velocity, _] = self.mass.at(state, &self.rates, Vec3::ZERO);
        self.middle = match self.is_whole {
            true => [
                self.rates.velocity,
                rotation * (self.inertia * self.rates.spin),
            ],
            false => [velocity, rotation * self.rates.spin],
        };
        self.rates.spin_rate = Vec3::ZERO;
    }

    /// Ends a short increment at the state it leads to, where forces about the reference point act; `next` has the rates of
    /// prescribed unknowns in the middle of the next one.
    pub fn land(&mut self, state: &State, forces: [Vec3; 2], past: Past, next: &[f64]) {
        let rotation = self.mass.rotation(state);
        let back = rotation.transpose();
        if self.is_whole {
            let moment = back * (forces[1] - (rotation * self.mass.arm).cross(forces[0]));
            let momentum = back * self.middle[1] + moment * past.half;
            let spin = self.inverse * momentum;
            let acceleration = forces[0] / self.mass.mass;
            self.rates = BodyRates {
                velocity: self.middle[0] + acceleration * past.half,
                acceleration,
                spin,
                spin_rate: self.inverse * (moment - self.gyroscopic(spin, state.is_small)),
            };
            return;
        }
        let [acceleration, turning] = self.driven(state, forces, past, next);
        let velocities = [
            self.middle[0] + acceleration * past.half,
            self.middle[1] + turning * past.half,
        ];
        self.rates = self.mass.rates(state, velocities, [acceleration, turning]);
    }

    /// Writes its rates at a state to those of rigid bodies and nodes.
    pub fn report(&self, state: &State, heavy: &[RigidMass], to: &mut Rates) {
        let rotation = self.mass.rotation(state);
        let place = self
            .heavy
            .and_then(|at| Some((heavy.get(at)?, to.bodies.get_mut(at)?)));
        if let Some((body, rates)) = place {
            let centre = rotation * body.arm;
            let [velocity, acceleration] = self.mass.at(state, &self.rates, centre);
            *rates = BodyRates {
                velocity,
                acceleration,
                ..self.rates
            };
        }
        for of in &self.nodes {
            let node = of.node as usize;
            let moving = self.mass.at(state, &self.rates, rotation * of.arm);
            for (values, value) in [&mut to.velocity, &mut to.acceleration]
                .into_iter()
                .zip(moving)
            {
                if let Some(to) = values.get_mut(node) {
                    *to = value;
                }
            }
        }
    }

    /// Forces about the reference point, of a residual.
    pub fn forces(&self, residual: &[f64]) -> [Vec3; 2] {
        let mut forces = [Vec3::ZERO; 2];
        for (k, &dof) in self.dofs.iter().enumerate() {
            forces[k / 3][k % 3] = -residual.get(dof as usize).copied().unwrap_or_default();
        }
        forces
    }

    /// What it answers to forces at its unknowns: velocities of them all.
    pub fn respond(&self, compliance: &[[f64; 6]; 6], forces: &[f64; 6]) -> [f64; 6] {
        std::array::from_fn(|i| compliance[i].iter().zip(forces).map(|(c, f)| c * f).sum())
    }

    /// Its mass, with that of nodes that follow.
    pub const fn mass(&self) -> &RigidMass {
        &self.mass
    }
}

/// The inverse of a symmetric positive definite matrix between some of its unknowns; zero elsewhere.
fn inverted(mut a: [[f64; 6]; 6], free: [bool; 6]) -> [[f64; 6]; 6] {
    let mut inverse = [[0.0; 6]; 6];
    let own = || (0..6).filter(|&k| free[k]);
    own().for_each(|k| inverse[k][k] = 1.0);
    for k in own() {
        let pivot = a[k][k].recip();
        for j in own() {
            a[k][j] *= pivot;
            inverse[k][j] *= pivot;
        }
        for i in own().filter(|&i| i != k) {
            let factor = a[i][k];
            for j in own() {
                a[i][j] -= factor * a[k][j];
                inverse[i][j] -= factor * inverse[k][j];
            }
        }
    }
    inverse
}
