//! Inertia: what mass does in a motion in time.
//!
//! | symbol | name in code | |
//! |---|---|---|
//! | M | [`Inertia`] | mass, the same for all components: of each cell between its nodes, or at nodes |
//! | a_R | `damping` | viscous forces `a_R M v`, over the mass |
//! | αm, αf, β, γ | [`Scheme`] | the method, (E4) of `system` |
//!
//! ```text
//! f = M ((1 − αm) a₁ + αm a₀) + a_R M ((1 − αf) v₁ + αf v₀)                                     (E1)
//! K = ((1 − αm)/(β h²) + a_R (1 − αf) γ/(β h)) M    against d₁                                   (E2)
//! T = ½ v·M v                                                                                    (E3)
//! m = Σ_cells m_cell / n    at the n nodes of a cell that are not on a side of a contact         (E4)
//! ```
//!
//! and of a rigid body with the mass `m`, the arm `a` of its centroid, moments of inertia `J`, and `R_α = R₀ exp((1 − αf) Ψ)`, about
//! its reference point:
//!
//! ```text
//! f = m ((1 − αm) a₁ + αm a₀)    M = a_α × f + R_α [J ((1 − αm) A₁ + αm A₀) + (1 − αf) Ω₁×J Ω₁ + αf Ω₀×J Ω₀]   (E5)
//! dΨ = T⁻¹(Ψ) R₁ᵀ dθ    T⁻¹(Ψ) = 1 + ½ [Ψ]× + (1/ψ² − cot(ψ/2)/(2ψ)) [Ψ]×²                          (E6)
//! ```
//!
//! or, of a method that conserves energy, with the rotations `R₀`, `R₁` at the ends and Cayley's vector, (E10) of `rigid_motion`,
//!
//! ```text
//! M = a_α × f + (R₁ J Ω₁ − R₀ J Ω₀)/h        dΘ = (1 + ½ [Θ]× + ¼ Θ Θᵀ) R₁ᵀ dθ                   (E7)
//! ```
//!
//! with `v₁`, `a₁` as functions of `Δd`, (E5) of `system`. Where a step begins, the term has no force and the stiffness `M`: the
//! accelerations there follow from it ([`Role::Inertia`]). In static steps it takes no part.
//!
//! Where nodes on the sides of contacts have a mass, contact gives it a jump of velocity in each impact, and what high frequencies
//! hold flickers. Masses that are redistributed, (E4), leave these nodes to follow the others as in statics: the total mass is the
//! same, and its centre moves by a part of the size of an element.
//!
//! `a_R` brakes motions of bodies as a whole, too. Sources: `system::motion`; Hughes, The Finite Element Method, 1987, section
//! 7.3.2 (lumped masses); Khenous, Laborde and Renard, Eur. J. Mech. A 27, 2008 (nodes without mass).

mod masses;
mod rigid;
#[cfg(test)]
mod rigid_tests;
#[cfg(test)]
mod tests;

pub use masses::Masses;
pub use rigid::RigidInertia;

use crate::system::{
    Archive, ArchiveError, Capabilities, Dof, Elementwise, Frame, Inertial, Layout, Lifetime,
    Order, Part, PatternSink, Phase, Properties, Rates, Role, Scheme, Sink, State, Stored,
    Symmetry, Term, TermError, Work,
};
use masses::Group;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// The inertia of all bodies.
pub struct Inertia {
    layout: Layout,
    masses: Masses,
    /// Those of steps in which nodes that contact may act on have none.
    redistributed: Option<Masses>,
    /// Those of explicit steps.
    lumped: Option<Masses>,
    step: Option<Scheme>,
    /// The length of the increment; 0 where none has begun.
    h: f64,
    /// The length of the one before, after which the stiffness is the same.
    before: f64,
    /// Velocities and accelerations at the start of the increment.
    rates: Rates,
    /// Where the nodes are there, where anything is damped.
    from: Vec<Vec3>,
    /// Kinetic energy at the start of the run.
    at_start: f64,
    /// Work of damping since then.
    spent: f64,
}

/// The name under which energies are stored.
const STORED: &str = "inertia.energies";

/// Scratch of one thread.
#[derive(Default)]
struct Scratch {
    dofs: Vec<Dof>,
    /// What mass is multiplied by at each node.
    motion: Vec<Vec3>,
    force: Vec<f64>,
    blocks: Vec<f64>,
}

/// What mass is multiplied by, as a function of the motion.
struct Factors {
    scheme: Scheme,
    h: f64,
}

impl Factors {
    /// At a node that goes this way in the increment; damping over mass.
    fn motion(&self, way: Vec3, [v, a]: [Vec3; 2], damping: f64) -> Vec3 {
        let alpha_m = self.scheme.alpha_m;
        let last = self.scheme.acceleration(way, self.h, v, a);
        last * (1.0 - alpha_m) + a * alpha_m + self.damped(way, [v, a]) * damping
    }

    /// The velocity that damping acts against.
    fn damped(&self, way: Vec3, [v, a]: [Vec3; 2]) -> Vec3 {
        if self.scheme.explicit.is_some() {
            return way / self.h;
        }
        let alpha_f = self.scheme.alpha_f;
        let last = self.scheme.acceleration(way, self.h, v, a);
        let velocity = self.scheme.velocity(self.h, v, [a, last]);
        velocity * (1.0 - alpha_f) + v * alpha_f
    }

    /// Its derivative with respect to the way.
    fn slope(&self, damping: f64) -> f64 {
        let Scheme {
            alpha_m,
            alpha_f,
            beta,
            gamma,
            ..
        } = self.scheme;
        let of_damping = damping * (1.0 - alpha_f) * gamma / (beta * self.h);
        (1.0 - alpha_m) / (beta * self.h * self.h) + of_damping
    }
}

impl Inertia {
    /// That of these masses; and of those in steps in which nodes that contact may act on have none, and in explicit steps,
    /// where there are any.
    #[must_use]
    pub fn new(
        layout: Layout,
        masses: Masses,
        redistributed: Option<Masses>,
        lumped: Option<Masses>,
    ) -> Self {
        Self {
            layout,
            masses,
            redistributed,
            lumped,
            step: None,
            h: 0.0,
            before: 0.0,
            rates: Rates::at_rest(layout.nnode(), 0),
            from: Vec::new(),
            at_start: 0.0,
            spent: 0.0,
        }
    }

    /// The masses of the present step.
    fn present(&self) -> &Masses {
        let own = match self.step {
            Some(step) if step.explicit.is_some() => &self.lumped,
            Some(step) if step.redistributed => &self.redistributed,
            _ => &None,
        };
        own.as_ref().unwrap_or(&self.masses)
    }

    /// Whether accelerations follow from forces, so that there are no forces of inertia.
    fn is_explicit(&self) -> bool {
        self.step.is_some_and(|step| step.explicit.is_some())
    }

    /// ½ v·M v (E3).
    #[must_use]
    pub fn kinetic(&self, velocity: &[Vec3]) -> f64 {
        let of_cell = |(nodes, masses): (&[NodeId], &[f64])| {
            let v = |node: NodeId| velocity.get(node as usize).copied().unwrap_or_default();
            let rows = nodes.iter().zip(masses.chunks_exact(nodes.len().max(1)));
            let of_row = |(&node, row): (&NodeId, &[f64])| {
                let momentum: Vec3 = row.iter().zip(nodes).map(|(m, &to)| v(to) * *m).sum();
                v(node).dot(momentum)
            };
            rows.map(of_row).sum::<f64>()
        };
        let cells = self.present().groups.iter().flat_map(Group::cells);
        0.5 * cells.map(of_cell).sum::<f64>()
    }

    /// `Σ M x` over the nodes with a value each: momentum of velocities.
    #[must_use]
    pub fn total(&self, values: &[Vec3]) -> Vec3 {
        let at = |node: NodeId| values.get(node as usize).copied().unwrap_or_default();
        let cells = self.present().groups.iter().flat_map(Group::cells);
        let of_cell = |(nodes, masses): (&[NodeId], &[f64])| -> Vec3 {
            let rows = masses.chunks_exact(nodes.len().max(1));
            let of_row = |row: &[f64]| row.iter().zip(nodes).map(|(m, &to)| at(to) * *m).sum();
            rows.map(of_row)
                .fold(Vec3::ZERO, |all, one: Vec3| all + one)
        };
        cells.map(of_cell).sum()
    }

    /// Sets the velocities of all nodes at the start of the run, and how its first step with inertia goes through time.
    pub fn start(&mut self, scheme: Option<Scheme>, velocity: &[Vec3]) {
        self.step = scheme;
        self.at_start = self.kinetic(velocity);
    }

    /// The rounding error of the forces of a cell: that of positions, times what a way makes of it.
    fn rounding(&self, nodes: &[NodeId], masses: &[f64], slope: f64, trial: &State) -> f64 {
        let far = nodes.iter().filter_map(|&node| trial.x.get(node as usize));
        let far = far.fold(0.0, |most: f64, x| most.max(x.max_abs()));
        let row = masses.iter().sum::<f64>() / nodes.len().max(1) as f64;
        f64::EPSILON * far * slope * row
    }

    fn is_damped(&self) -> bool {
        let mut groups = self.present().groups.iter();
        groups.any(|group| group.damping.iter().any(|damping| *damping > 0.0))
    }

    fn factors(&self) -> Option<Factors> {
        let scheme = self.step.filter(|_| self.h > 0.0)?;
        Some(Factors { scheme, h: self.h })
    }
}

impl Scratch {
    /// Begins a cell.
    fn begin(&mut self, layout: &Layout, nodes: &[NodeId]) {
        self.dofs.clear();
        let of_node = |&n: &NodeId| (0..layout.ndim()).map(move |axis| layout.node(n, axis));
        self.dofs.extend(nodes.iter().flat_map(of_node));
        self.force.clear();
        self.force.resize(self.dofs.len(), 0.0);
        self.motion.clear();
        self.blocks.clear();
    }

    /// M times the motion.
    fn forces(&mut self, masses: &[f64], ndim: usize) {
        let rows = masses.chunks_exact(self.motion.len().max(1));
        for (force, row) in self.force.chunks_exact_mut(ndim.max(1)).zip(rows) {
            let sum: Vec3 = row.iter().zip(&self.motion).map(|(m, q)| *q * *m).sum();
            force
                .iter_mut()
                .zip(sum.to_array())
                .for_each(|(f, s)| *f = s);
        }
    }

    /// The blocks (I, J) of `factor M` with I ≤ J.
    fn stiffness(&mut self, masses: &[f64], ndim: usize, factor: f64) {
        let n = masses.len().isqrt();
        for j in 0..n {
            for i in 0..=j {
                let mass = factor * masses.get(i * n + j).copied().unwrap_or_default();
                let entries =
                    (0..ndim * ndim).map(|k| if k % (ndim + 1) == 0 { mass } else { 0.0 });
                self.blocks.extend(entries);
            }
        }
    }
}

impl Term for Inertia {
    fn name(&self) -> &str {
        "inertia"
    }

    fn properties(&self) -> Properties {
        // the same as in the increment before it, as a rule
        let lifetime = if self.h == self.before {
            Lifetime::Step
        } else {
            Lifetime::Increment
        };
        Properties {
            lifetime,
            to_end: true,
            elements: self.step.map_or(0, |step| {
                u64::from(step.redistributed) + 2 * u64::from(step.explicit.is_some())
            }),
            ..Properties::new(Symmetry::Definite, Part::Bulk).with_role(Role::Inertia)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        let cells = self.present().groups.iter().flat_map(Group::cells);
        cells.for_each(|(nodes, _)| out.bulk(nodes));
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        self.step = phase.step.scheme;
        (self.before, self.h) = (self.h, phase.dt());
        if self.h > 0.0 && self.is_damped() {
            self.from.clone_from(&from.x);
        }
        if self.is_explicit() {
            return Ok(());
        }
        match from.rates.as_ref().filter(|_| self.step.is_some()) {
            Some(rates) => self.rates.clone_from(rates),
            None => {
                self.rates.velocity.fill(Vec3::ZERO);
                self.rates.acceleration.fill(Vec3::ZERO);
            }
        }
        Ok(())
    }

    fn nchunk(&self) -> usize {
        match self.step {
            Some(_) => self.present().nchunk(),
            None => 0,
        }
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        if self.is_explicit() {
            return Ok(());
        }
        let (ndim, factors) = (self.layout.ndim(), self.factors());
        let present = self.present();
        let Some((group, cells)) = present.chunk(chunk) else {
            let left = if factors.is_some() { 0.0 } else { present.mean };
            for node in present.massless_of(chunk) {
                let s = work.of::<Scratch>();
                s.begin(&self.layout, &[*node]);
                if order == Order::Tangent {
                    s.stiffness(&[left], ndim, 1.0);
                }
                out.add_symmetric(&s.dofs, &s.force, &s.blocks, ndim);
            }
            return Ok(());
        };
        let way = trial.between.as_ref().map_or(&[][..], |of| &of.way);
        let at = |values: &[Vec3], node: NodeId| values.get(node as usize).copied();
        let s = work.of::<Scratch>();
        let all = group.cells().zip(&group.damping);
        for ((nodes, masses), &damping) in all.skip(cells.start).take(cells.len()) {
            s.begin(&self.layout, nodes);
            let mut slope = 1.0;
            if let Some(factors) = &factors {
                s.motion.extend(nodes.iter().map(|&node| {
                    let rates = [&self.rates.velocity, &self.rates.acceleration];
                    let rates = rates.map(|of| at(of, node).unwrap_or_default());
                    factors.motion(at(way, node).unwrap_or_default(), rates, damping)
                }));
                s.forces(masses, ndim);
                slope = factors.slope(damping);
            }
            if order == Order::Tangent {
                s.stiffness(masses, ndim, slope);
            }
            out.add_symmetric(&s.dofs, &s.force, &s.blocks, ndim);
            if factors.is_some() {
                out.uncertain(&s.dofs, self.rounding(nodes, masses, slope, trial));
            }
        }
        Ok(())
    }

    fn energy(&self, _: usize, _: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        // a motion in time has no potential
        Ok(None)
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        if let Some(rates) = &state.rates {
            let energies = frame.energies.get_or_insert_default();
            energies.kinetic += self.kinetic(&rates.velocity);
            energies.kinetic_at_start += self.at_start;
            energies.damping += self.spent;
        }
        Ok(())
    }

    fn stored(&mut self) -> Option<&mut dyn Stored> {
        Some(self)
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            elementwise: Some(self),
            inertial: Some(self),
            stored: Some(self),
            ..Capabilities::default()
        }
    }
}

impl Stored for Inertia {
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        let Some(factors) = self.factors().filter(|_| self.is_damped()) else {
            return Ok(());
        };
        let at = |values: &[Vec3], node: NodeId| {
            let value = values.get(node as usize).copied();
            value.unwrap_or_default()
        };
        let way = |node: NodeId| at(&state.x, node) - at(&self.from, node);
        let damped = |node: NodeId| {
            let [v, a] = [&self.rates.velocity, &self.rates.acceleration].map(|r| at(r, node));
            factors.damped(way(node), [v, a])
        };
        let mut spent = 0.0;
        for group in &self.present().groups {
            let cells = group.cells().zip(&group.damping);
            for ((nodes, masses), damping) in cells.filter(|(_, damping)| **damping > 0.0) {
                let rows = nodes.iter().zip(masses.chunks_exact(nodes.len().max(1)));
                for (&node, row) in rows {
                    let momentum = row.iter().zip(nodes).map(|(m, &to)| damped(to) * *m);
                    spent += damping * way(node).dot(momentum.sum());
                }
            }
        }
        self.spent += spent;
        Ok(())
    }

    fn save(&self, out: &mut Archive) {
        out.put(STORED, &[self.at_start, self.spent]);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let mut numbers = [0.0; 2];
        from.get(STORED, &mut numbers)?;
        [self.at_start, self.spent] = numbers;
        Ok(())
    }
}

impl Inertial for Inertia {
    fn massless(&self) -> &[NodeId] {
        &self.present().massless
    }

    fn at_nodes(&self, take: &mut dyn FnMut(NodeId, f64, f64)) {
        for group in &self.present().groups {
            for ((nodes, masses), &damping) in group.cells().zip(&group.damping) {
                let rows = masses.chunks_exact(nodes.len().max(1));
                for (&node, row) in nodes.iter().zip(rows) {
                    take(node, row.iter().sum(), damping);
                }
            }
        }
    }
}

impl Elementwise for Inertia {
    fn elements(&self, chunk: usize, take: &mut dyn FnMut(&[NodeId])) {
        match self.present().chunk(chunk) {
            Some((group, cells)) => {
                let all = group.cells().map(|(nodes, _)| nodes);
                all.skip(cells.start).take(cells.len()).for_each(take);
            }
            None => {
                let nodes = self.present().massless_of(chunk).iter();
                nodes.for_each(|node| take(std::slice::from_ref(node)));
            }
        }
    }
}
