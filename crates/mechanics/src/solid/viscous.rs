//! Viscous forces of cells and bars, (E29) to (E31) of `damping`.

use super::at::At;
use super::cells::Cells;
use super::damping::{Flow, Viscous, since};
use super::kernel::{Element, Output, mirror};
use super::scratch::{Scratch, Wanted};
use super::term::Solid;
use super::truss::{Bar, Local, MOST, Point, Truss};
use crate::material::{Kinematics, Material, Order, Response, Strain};
use crate::system::{NodeId, Phase, State, TermError};
use rayon::prelude::*;
use signorini_geometry::tensor::{Sym3, Vec3};

impl Solid {
    /// Its stiffness damps: stress over the initial stiffness and the rate of strain (time), in steps with inertia.
    pub fn set_retardation(&mut self, retardation: f64) {
        self.damping.retardation = retardation;
    }

    /// An increment begins, or a step.
    pub(super) fn begin_damping(&mut self, phase: &Phase, from: &State) {
        let flow = self.damping.begin(phase);
        for block in &mut self.blocks {
            block.since.clear();
            if let Some(flow) = &flow {
                let all = since(flow, from, &self.layout, &block.nodes);
                block.since.extend(all);
            }
        }
    }

    /// What stiffness damps by at a place, where anything of this kind is wanted.
    pub(super) fn flow(&self, at: At<'_>, wanted: Wanted) -> Option<Flow> {
        let is_sampled = wanted == Wanted::Samples;
        let flow = self.damping.at(at, wanted == Wanted::Stiffness);
        flow.filter(|_| !is_sampled)
    }

    /// Whether the stiffness at a place has an unsymmetric part that damps.
    pub(super) fn skews(&self, at: At<'_>) -> bool {
        let is_finite = self.kinematics == Kinematics::Finite;
        is_finite && self.flow(at, Wanted::Stiffness).is_some()
    }

    /// Makes the viscous forces of a cell, which lies in the scratch, and their stiffness.
    fn viscous(
        &self,
        block: &Cells,
        cell: usize,
        (at, flow): (At<'_>, Flow),
        wanted: Wanted,
        scratch: &mut Scratch,
    ) -> Result<(), TermError> {
        let is_finite = self.kinematics == Kinematics::Finite;
        let n = scratch.dofs.len();
        let since = block.since.get(cell * n..(cell + 1) * n);
        let unknowns = scratch.dofs.iter().zip(since.unwrap_or_default());
        let velocity = |(&dof, since)| flow.velocity(at.displacement(dof), since);
        scratch.rate.clear();
        scratch.rate.extend(unknowns.map(velocity));
        let law = Viscous {
            material: self.material(),
            retardation: self.damping.retardation,
        };
        let element = Element {
            x: &scratch.x,
            // small strains are linear
            u: if is_finite { &scratch.u } else { &scratch.rate },
            rate: &scratch.rate,
            slope: flow.slope,
            material: &law,
            profile: &scratch.profile,
            temperature: &scratch.temperature_at_start,
            temperature_at_start: &scratch.temperature_at_start,
            old: &block.undeformed,
            initial: &[],
            ..self.element(block, cell, at)
        };
        let viscous = &mut scratch.viscous;
        viscous.force.resize(n, 0.0);
        let nstiffness = if wanted == Wanted::Stiffness {
            n * n
        } else {
            0
        };
        viscous.stiffness.resize(nstiffness, 0.0);
        viscous.new.resize(block.nhistory, 0.0);
        let mut out = Output {
            thermal: &mut [],
            force: &mut viscous.force,
            stiffness: &mut viscous.stiffness,
            energy: 0.0,
            new: &mut viscous.new,
            samples: &mut [],
            scratch: &mut scratch.inner,
        };
        let treatment = block.treatment(self.kinematics);
        let kernel = treatment.viscous.filter(|_| is_finite);
        let kernel = kernel.unwrap_or(treatment.kernel);
        let outcome = kernel(&element, wanted.order(), &mut out);
        outcome.map_err(|failure| self.failure(block.labels[cell], failure))
    }

    /// Adds the viscous forces of a cell to those in the scratch, and their stiffness.
    pub(super) fn damp(
        &self,
        block: &Cells,
        cell: usize,
        (at, flow): (At<'_>, Flow),
        wanted: Wanted,
        scratch: &mut Scratch,
    ) -> Result<(), TermError> {
        self.viscous(block, cell, (at, flow), wanted, scratch)?;
        let (ndim, n) = (self.layout.ndim(), scratch.dofs.len());
        let is_finite = self.kinematics == Kinematics::Finite;
        let is_secant = self.secant_way(at).is_some();
        let Scratch {
            force,
            stiffness,
            viscous,
            ..
        } = scratch;
        let forces = force.iter_mut().zip(&viscous.force);
        forces.for_each(|(to, f)| *to += f);
        if wanted != Wanted::Stiffness {
            return Ok(());
        }
        // of a law that is symmetric, kernels without secants and rates make blocks above the diagonal
        if self.material().is_symmetric() && is_finite != is_secant {
            let half = match is_finite {
                true => &mut *stiffness,
                false => &mut viscous.stiffness,
            };
            mirror(half, n, ndim);
        }
        let slope = if is_finite { 1.0 } else { flow.slope };
        let share = if is_secant { flow.share } else { 1.0 };
        let factor = slope * share;
        let entries = stiffness.iter_mut().zip(&viscous.stiffness);
        entries.for_each(|(to, k)| *to += factor * k);
        Ok(())
    }

    /// (E31) in the increment that leads to an accepted state.
    pub(super) fn dissipation(&self, state: &State) -> Result<f64, TermError> {
        let Some(flow) = self.damping.flow().filter(|flow| flow.slope > 0.0) else {
            return Ok(0.0);
        };
        let layout = self.layout;
        let middle = self.blocks.iter().flat_map(|block| {
            let dofs = |&node: &NodeId| (0..layout.ndim()).map(move |i| layout.node(node, i));
            let dofs = block.nodes.iter().flat_map(dofs);
            dofs.map(|dof| dof as usize).zip(&block.since)
        });
        let middle = self.damping.middle(state, middle);
        let at = At::Trial(middle.as_ref().unwrap_or(state));
        let of_chunk = |scratch: &mut Scratch, &(number, first, last): &(usize, usize, usize)| {
            let block = &self.blocks[number];
            let mut spent = 0.0;
            for cell in (first..last).filter(|cell| block.part.is_active(*cell)) {
                self.place(block, cell, at, scratch);
                self.viscous(block, cell, (at, flow), Wanted::Forces, scratch)?;
                let n = scratch.dofs.len();
                let since = block.since.get(cell * n..(cell + 1) * n);
                let unknowns = scratch.dofs.iter().zip(since.unwrap_or_default());
                let ways = unknowns.map(|(&dof, since)| flow.way(at.displacement(dof), since));
                let forces = scratch.viscous.force.iter().zip(ways);
                spent += forces.map(|(f, way)| f * way).sum::<f64>();
            }
            Ok(spent)
        };
        let chunks = self.chunks.par_iter().map_init(Scratch::default, of_chunk);
        let chunks: Vec<Result<f64, TermError>> = chunks.collect();
        chunks.into_iter().sum()
    }
}

impl Truss {
    /// Its stiffness damps: stress over the initial stiffness and the rate of strain (time), in steps with inertia.
    pub fn set_retardation(&mut self, retardation: f64) {
        self.damping.retardation = retardation;
    }

    /// An increment begins, or a step.
    pub(super) fn begin_damping(&mut self, phase: &Phase, from: &State) {
        let flow = self.damping.begin(phase);
        for bar in &mut self.bars {
            bar.since.clear();
            if let Some(flow) = &flow {
                bar.since
                    .extend(since(flow, from, &self.layout, &bar.nodes));
            }
        }
    }

    /// The dofs of a bar.
    fn dofs<'a>(&self, bar: &'a Bar) -> impl Iterator<Item = u32> + 'a {
        let layout = self.layout;
        let of_node = move |&node: &NodeId| (0..layout.ndim()).map(move |i| layout.node(node, i));
        bar.nodes.iter().flat_map(of_node)
    }

    /// Hands every point of a bar to `take`, with the answer of a law of the undeformed material to the rate of its strain where the
    /// nodes have these velocities, and the part of their gradient in that of strains: `h` of the velocities at finite strain.
    fn rates(
        &self,
        (number, at): (usize, At<'_>),
        law: &dyn Material,
        velocities: &[f64; MOST],
        new: &mut Vec<f64>,
        mut take: impl FnMut(&Point, &Response, Vec3),
    ) -> Result<(), TermError> {
        let Some(bar) = self.bars.get(number) else {
            return Ok(());
        };
        let ndim = self.layout.ndim();
        let failure = |message: String| TermError::Material {
            body: self.name.clone(),
            element: bar.label,
            message,
        };
        new.clear();
        new.extend_from_slice(&self.undeformed);
        let mut response = Response::default();
        for p in 0..bar.element.full_rule().npoint() {
            let Some((point, _)) = self.point(number, p, at) else {
                return Err(failure("the bar has no length".to_owned()));
            };
            let mut flowing = Vec3::ZERO;
            let of_nodes = velocities.chunks_exact(ndim).zip(point.slope);
            for (velocity, slope) in of_nodes.take(bar.nodes.len()) {
                for (axis, v) in velocity.iter().enumerate() {
                    flowing[axis] += slope * v;
                }
            }
            let [_, temperature] = self.temperature(number, p, at);
            let rate = Strain {
                kinematics: self.kinematics,
                value: Sym3::diagonal(point.along.dot(flowing), 0.0, 0.0),
                temperature,
                temperature_at_start: temperature,
                axes: None,
            };
            let old = &self.undeformed;
            let answer = law.respond(&rate, old, new, Order::Tangent, &mut response);
            answer.map_err(|error| failure(error.to_string()))?;
            let finite = self.kinematics == Kinematics::Finite;
            take(&point, &response, if finite { flowing } else { Vec3::ZERO });
        }
        Ok(())
    }

    /// Adds the viscous forces of a bar, and their stiffness.
    pub(super) fn damp(
        &self,
        number: usize,
        (at, flow): (At<'_>, Flow),
        order: Order,
        new: &mut Vec<f64>,
        out: &mut Local,
    ) -> Result<(), TermError> {
        let Some(bar) = self.bars.get(number) else {
            return Ok(());
        };
        let ndim = self.layout.ndim();
        let finite = self.kinematics == Kinematics::Finite;
        let mut velocities = [0.0; MOST];
        let unknowns = self.dofs(bar).zip(&bar.since);
        for (v, (dof, since)) in velocities.iter_mut().zip(unknowns) {
            *v = flow.velocity(at.displacement(dof), since);
        }
        let law = Viscous {
            material: self.material.as_ref(),
            retardation: self.damping.retardation,
        };
        let n = bar.nodes.len() * ndim;
        let of_bar = (number, at);
        self.rates(
            of_bar,
            &law,
            &velocities,
            new,
            |point, response, flowing| {
                let volume = point.weight * self.area;
                let (stress, modulus) = (response.stress.xx(), response.tangent[0][0]);
                for i in 0..n {
                    let (node, axis) = (i / ndim, i % ndim);
                    let slope = volume * point.slope[node];
                    out.force[i] += slope * stress * point.along[axis];
                    if order == Order::Stress {
                        continue;
                    }
                    for j in 0..n {
                        let change = point.along[j % ndim] * flow.slope + flowing[j % ndim];
                        let mut value = modulus * point.along[axis] * change;
                        if finite && axis == j % ndim {
                            value += stress;
                        }
                        out.stiffness[i * n + j] += slope * point.slope[j / ndim] * value;
                    }
                }
            },
        )
    }

    /// (E31) in the increment that leads to an accepted state.
    pub(super) fn dissipation(&self, state: &State) -> Result<f64, TermError> {
        let Some(flow) = self.damping.flow().filter(|flow| flow.slope > 0.0) else {
            return Ok(0.0);
        };
        let unknowns = self.bars.iter().flat_map(|bar| {
            let dofs = self.dofs(bar).map(|dof| dof as usize);
            dofs.zip(&bar.since)
        });
        let middle = self.damping.middle(state, unknowns);
        let at = At::Trial(middle.as_ref().unwrap_or(state));
        let (mut spent, mut new) = (0.0, Vec::new());
        for (number, bar) in self.bars.iter().enumerate() {
            if !self.part.is_active(number) {
                continue;
            }
            let mut local = Local::default();
            self.damp(number, (at, flow), Order::Stress, &mut new, &mut local)?;
            let unknowns = self.dofs(bar).zip(&bar.since);
            let ways = unknowns.map(|(dof, since)| flow.way(at.displacement(dof), since));
            spent += local
                .force
                .iter()
                .zip(ways)
                .map(|(f, w)| f * w)
                .sum::<f64>();
        }
        Ok(spent)
    }
}
