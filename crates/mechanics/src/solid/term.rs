use super::at::At;
use super::axes::MaterialAxes;
use super::cells::{AtStart, CHUNK, Cells, SAMPLED};
use super::choice::{Situation, keeps_volume};
use super::damping::Damping;
use super::directors::to_directors;
use super::error::SolidError;
use super::kernel::{Batch, BatchKernel, Element, Failure, Output, Results, Sample, width};
use super::plan::{Plan, is_linear};
use super::scratch::{Scratch, Wanted};
use super::{AtNodes, Integration, Locking, report};
use crate::material::{Kinematics, Material, Reduced};
use crate::system::{
    Capabilities, Directors, Dof, Frame, Idealisation, Layout, Lifetime, NodalField, Order, Part,
    PatternSink, Phase, Properties, Sink, State, StepContext, Stored, Symmetry, Term, TermError,
    Work,
};
use rayon::prelude::*;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use std::ops::Range;
use std::sync::Arc;

/// The cells of one material.
pub struct Solid {
    pub(super) name: String,
    pub(super) layout: Layout,
    pub(super) reference: Arc<[Vec3]>,
    pub(super) material: Box<dyn Material>,
    // materials that take its place, each with the step from which on it does, in their order
    pub(super) later: Vec<(usize, Box<dyn Material>)>,
    // whether each of these laws is linear in the strain of Green and Lagrange, before directions are free of stress
    pub(super) linear: Vec<bool>,
    pub(super) kinematics: Kinematics,
    pub(super) space: Idealisation,
    // what the thickness is multiplied by at every node of the mesh; none: 1
    profile: Option<Arc<[f64]>>,
    pub(super) temperature: Option<Arc<NodalField>>,
    pub(super) step: StepContext,
    pub(super) blocks: Vec<Cells>,
    // (block, first cell, last cell)
    pub(super) chunks: Vec<(usize, usize, usize)>,
    // which cells take part; none where all always do
    pub(super) plan: Option<Plan>,
    // whether the strain at which cells were added is taken off in the present step
    pub(super) subtracts: bool,
    pub(super) damping: Damping,
    // whether the body is thin, and whether the tangent takes predicted stresses in the present step (E36)
    pub(super) is_thin: bool,
    pub(super) predicts: bool,
}

/// What a body is made from.
pub struct SolidParts<'a> {
    /// Its name.
    pub name: &'a str,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Positions of the nodes at the start.
    pub reference: Arc<[Vec3]>,
    /// Its cells.
    pub cells: &'a [CellId],
    /// Which unknown is which.
    pub layout: Layout,
    /// Space, plane or axisymmetry.
    pub space: Idealisation,
    /// What the thickness is multiplied by at every node of the mesh; none: 1.
    pub profile: Option<Arc<[f64]>>,
    /// What it is made of: the law for three dimensions, in every space.
    pub material: Box<dyn Material>,
    /// Full or reduced integration.
    pub integration: Integration,
    /// What is done against locking.
    pub locking: Locking,
    /// Temperatures, where there are any.
    pub temperature: Option<Arc<NodalField>>,
    /// Whether temperatures are linear in quad8 and hex20 with full integration, as strains are: those at the points of
    /// reduced integration, continued.
    pub linear_temperatures: bool,
    /// How values at points are carried to nodes.
    pub at_nodes: AtNodes,
    /// Stress and strain at the start; zero at points that are not named.
    pub initial: &'a [AtStart],
    /// Axes of a material that takes those of points; none: those of the frame.
    pub axes: Option<MaterialAxes>,
    /// The directors of its cells, where it is a solid-shell.
    pub directors: &'a Directors,
}

/// A material as it answers in a space.
pub(super) fn in_space(material: Box<dyn Material>, space: Idealisation) -> Box<dyn Material> {
    match space {
        Idealisation::PlaneStress { .. } => Box::new(Reduced::plane_stress(material)),
        _ => material,
    }
}

impl Solid {
    /// The body made of these parts.
    ///
    /// # Errors
    /// A cell that is no solid of this space; one beyond the axis of a body of revolution; a remedy that its element has
    /// at no size of strains.
    pub fn new(parts: SolidParts<'_>) -> Result<Self, SolidError> {
        let SolidParts {
            name,
            mesh,
            reference,
            cells,
            layout,
            space,
            profile,
            material,
            integration,
            locking,
            temperature,
            linear_temperatures,
            at_nodes,
            initial,
            axes,
            directors,
        } = parts;
        let linear = vec![is_linear(material.as_ref())];
        let material = in_space(material, space);
        let keeps_volume = |kinematics| keeps_volume(material.as_ref(), kinematics);
        let keeps_volume = [Kinematics::Small, Kinematics::Finite].map(keeps_volume);
        let mut blocks: Vec<(u32, Cells)> = Vec::new();
        // where the cells of each block are in the body
        let mut places: Vec<Vec<usize>> = Vec::new();
        for (place, &id) in cells.iter().enumerate() {
            let (Some(element), Some(label)) = (mesh.element(id), mesh.cell_label(id)) else {
                continue;
            };
            let at = match blocks.iter().position(|(b, _)| *b == id.block) {
                Some(at) => at,
                None => {
                    let situation = |kinematics: Kinematics| Situation {
                        element,
                        space,
                        integration,
                        kinematics,
                        keeps_volume: keeps_volume[kinematics as usize],
                    };
                    let cells = Cells::new(situation, locking, material.nhistory(), at_nodes);
                    let cells = cells.filter(|_| element.dim() == layout.ndim());
                    let mut cells = cells.ok_or_else(|| SolidError::NotSolid {
                        body: name.to_string(),
                        label,
                        element: element.name(),
                        ndim: layout.ndim(),
                    })?;
                    if let (Err(reason), Err(_)) = (cells.finite.locking, cells.small.locking) {
                        return Err(cells.refusal(name, locking, reason));
                    }
                    if linear_temperatures {
                        cells.points.linear_temperatures(element);
                    }
                    blocks.push((id.block, cells));
                    places.push(Vec::new());
                    blocks.len() - 1
                }
            };
            places[at].push(place);
            let of_block = &mut blocks[at].1;
            let directors = (locking == Locking::Shell).then_some(directors);
            of_block.push(name, (mesh.cell(id), label), directors)?;
            of_block.labels.push(label);
            of_block.ids.push(id);
        }
        let mut blocks: Vec<Cells> = blocks.into_iter().map(|(_, c)| c).collect();
        let (mut chunks, mut is_thin) = (Vec::new(), false);
        for (number, block) in blocks.iter_mut().enumerate() {
            let situated = (space, &reference[..]);
            block.complete(name, material.as_ref(), initial, situated)?;
            block.orient(name, axes.as_ref(), &places[number], &reference)?;
            is_thin |= locking == Locking::Shell || block.is_thin(&reference);
            let ncell = block.labels.len();
            let begins = (0..ncell).step_by(CHUNK);
            chunks.extend(begins.map(|first| (number, first, (first + CHUNK).min(ncell))));
        }
        Ok(Self {
            name: name.to_string(),
            layout,
            reference,
            material,
            later: Vec::new(),
            linear,
            kinematics: Kinematics::Finite,
            space,
            profile,
            temperature,
            step: StepContext::default(),
            blocks,
            chunks,
            plan: None,
            subtracts: false,
            damping: Damping::default(),
            is_thin,
            predicts: false,
        })
    }

    /// Lets the tangent take the stress of the iterate unless predicted ones are asked for: thin solids that rub stick and slip by
    /// turns otherwise.
    pub fn keep_stress(&mut self) {
        let is_shell = |block: &Cells| !block.ends.is_empty();
        self.is_thin &= self.blocks.iter().all(is_shell);
    }

    /// Identifies the cells that take part.
    pub(super) fn elements_id(&self) -> u64 {
        self.plan.as_ref().map_or(0, Plan::epoch)
    }

    /// Which strains it uses; steps change it.
    pub fn set_kinematics(&mut self, kinematics: Kinematics) {
        self.kinematics = kinematics;
        self.subtracts = kinematics == Kinematics::Finite && self.is_linear();
    }

    /// What is done against locking at this size of strains: each type of element with what was chosen for it.
    ///
    /// # Errors
    /// What was asked for does not exist there.
    pub fn locking(
        &self,
        kinematics: Kinematics,
    ) -> Result<Vec<(&'static str, Locking)>, SolidError> {
        let chosen = self.blocks.iter().map(|block| {
            let treatment = block.treatment(kinematics);
            match treatment.locking {
                Ok(locking) => Ok((block.element, locking)),
                Err(reason) => {
                    // only a wish can be refused, and a wish for something granted at the other size of strains
                    let other = [&block.small, &block.finite];
                    let asked = other.iter().find_map(|t| t.locking.ok());
                    let asked = asked.unwrap_or_default();
                    Err(block.refusal(&self.name, asked, reason))
                }
            }
        });
        chosen.collect()
    }

    /// Runs the kernel over the cells of a chunk and hands each result to `take`.
    pub(super) fn each(
        &self,
        chunk: usize,
        at: At<'_>,
        wanted: Wanted,
        scratch: &mut Scratch,
        mut take: impl FnMut(&Cells, usize, f64, &mut Scratch),
    ) -> Result<(), TermError> {
        let Some(&(number, first, last)) = self.chunks.get(chunk) else {
            return Ok(());
        };
        let block = &self.blocks[number];
        scratch.size(block, self.layout.ndim(), wanted);
        let is_symmetric = self.is_symmetric(at);
        let batch = block.treatment(self.kinematics).batch;
        let flow = self.flow(at, wanted);
        let swells = self.make_room_for_heat(block, wanted, scratch);
        let is_plain = is_symmetric && flow.is_none() && !swells;
        let batch = batch.filter(|_| wanted != Wanted::Samples && is_plain);
        let width = if batch.is_some() { width() } else { 1 };
        for begin in (first..last).step_by(width) {
            let cells = begin..last.min(begin + width);
            let are_active = cells.clone().all(|cell| block.part.is_active(cell));
            let is_done = are_active
                && batch.is_some_and(|b| self.batch(block, b, cells.clone(), at, wanted, scratch));
            for (lane, cell) in cells.enumerate() {
                if !block.part.is_active(cell) {
                    continue;
                }
                let energy = if is_done {
                    self.pick(block, cell, at, (lane, width), scratch)
                } else {
                    let energy = self.cell(block, cell, at, wanted, scratch)?;
                    if let Some(flow) = flow {
                        self.damp(block, cell, (at, flow), wanted, scratch)?;
                    }
                    if is_symmetric {
                        scratch.pack(block.nnode, self.layout.ndim());
                    }
                    energy
                };
                take(block, cell, energy, scratch);
            }
        }
        Ok(())
    }

    /// Hands over the forces and the stiffness of a cell.
    pub(super) fn hand(&self, at: At<'_>, of: &Scratch, out: &mut dyn Sink) {
        if self.is_symmetric(at) {
            out.add_symmetric(&of.dofs, &of.force, &of.blocks, self.layout.ndim());
        } else {
            out.add(&of.dofs, &of.force, &of.stiffness);
        }
    }

    /// Runs the kernel over several cells at once; false where that is not possible for all of them.
    fn batch(
        &self,
        block: &Cells,
        kernel: BatchKernel,
        cells: Range<usize>,
        at: At<'_>,
        wanted: Wanted,
        scratch: &mut Scratch,
    ) -> bool {
        let width = width();
        let n = block.nnode * self.layout.ndim();
        let nblocks = scratch.blocks.len();
        let Scratch {
            lanes,
            new,
            temperature,
            temperature_at_start,
            ..
        } = scratch;
        lanes.x.resize(n * width, 0.0);
        lanes.u.resize(n * width, 0.0);
        let correction = self.correction(at);
        let ncorrected = if correction.is_empty() { 0 } else { n * width };
        lanes.correction.resize(ncorrected, 0.0);
        lanes.force.resize(n * width, 0.0);
        lanes.blocks.resize(nblocks * width, 0.0);
        lanes.energy.resize(width, 0.0);
        // lanes without a cell repeat the last one
        let cell_of = |lane: usize| cells.end.min(cells.start + lane + 1) - 1;
        temperature.clear();
        temperature_at_start.clear();
        for lane in 0..width {
            let cell = cell_of(lane);
            for (k, &node) in block.nodes_of(cell).iter().enumerate() {
                let x = self.reference[node as usize].to_array();
                for (axis, x) in x.into_iter().enumerate().take(self.layout.ndim()) {
                    let place = (k * self.layout.ndim() + axis) * width + lane;
                    lanes.x[place] = x;
                    let dof = self.layout.node(node, axis);
                    lanes.u[place] = at.displacement(dof);
                    if let Some(to) = lanes.correction.get_mut(place) {
                        *to = correction.get(dof as usize).copied().unwrap_or_default();
                    }
                }
            }
            let origin = self.origin(block, cell);
            if !origin.is_empty() {
                let (u, x) = (lanes.u.iter_mut(), lanes.x.iter_mut());
                self.count_from(origin, at, u.skip(lane).step_by(width));
                self.begin_at(origin, x.skip(lane).step_by(width));
            }
            self.heat(block, cell, at, temperature, temperature_at_start);
        }
        let of_lane = |values: &'_ [f64], lane: usize| -> Range<usize> {
            let range = lane * block.nnode..(lane + 1) * block.nnode;
            if values.is_empty() { 0..0 } else { range }
        };
        let (temperature, temperature_at_start) = (&temperature[..], &temperature_at_start[..]);
        let cell = |lane: usize| Element {
            temperature: &temperature[of_lane(temperature, lane)],
            temperature_at_start: &temperature_at_start[of_lane(temperature_at_start, lane)],
            ..self.element(block, cell_of(lane), at)
        };
        let lame = self.material().linearity().lame();
        let batch = Batch {
            reference: &block.points,
            is_finite: self.kinematics == Kinematics::Finite,
            x: &lanes.x,
            u: &lanes.u,
            correction: &lanes.correction,
            lame: lame.filter(|_| block.initial.is_empty()),
            cell: &cell,
        };
        let mut out = Results {
            energy: &mut lanes.energy,
            force: &mut lanes.force,
            blocks: &mut lanes.blocks,
            new,
        };
        kernel(&batch, wanted.order(), &mut out)
            && lanes.energy.iter().all(|e| e.is_finite())
            && lanes.force.iter().all(|f| f.is_finite())
    }

    /// Takes the results of one lane into the scratch; the energy comes back.
    fn pick(
        &self,
        block: &Cells,
        cell: usize,
        at: At<'_>,
        (lane, width): (usize, usize),
        scratch: &mut Scratch,
    ) -> f64 {
        self.locate(block, cell, at, scratch);
        let of_lane = |to: &mut [f64], from: &[f64]| {
            for (to, from) in to.iter_mut().zip(from.iter().skip(lane).step_by(width)) {
                *to = *from;
            }
        };
        of_lane(&mut scratch.force, &scratch.lanes.force);
        of_lane(&mut scratch.blocks, &scratch.lanes.blocks);
        scratch.lanes.energy[lane]
    }

    /// Where a cell is, and where its nodes go.
    pub(super) fn locate(&self, block: &Cells, cell: usize, at: At<'_>, scratch: &mut Scratch) {
        scratch.u.clear();
        scratch.dofs.clear();
        for &node in block.nodes_of(cell) {
            for axis in 0..self.layout.ndim() {
                let dof = self.layout.node(node, axis);
                scratch.dofs.push(dof);
                scratch.u.push(at.displacement(dof));
            }
        }
        self.count_from(self.origin(block, cell), at, scratch.u.iter_mut());
    }

    /// u_0 at the unknowns of a cell; nothing where it is zero.
    fn origin<'b>(&self, block: &'b Cells, cell: usize) -> &'b [f64] {
        block.part.origin(cell, block.nnode * self.layout.ndim())
    }

    /// Makes displacements those that kernels see: those since u_0, (E18) and (E20), or the whole ones where a strain is
    /// taken off, (E19).
    fn count_from<'u>(&self, origin: &[f64], at: At<'_>, u: impl Iterator<Item = &'u mut f64>) {
        for (u, origin) in u.zip(origin) {
            match (at, self.subtracts) {
                (At::Trial(_), false) => *u -= origin,
                (At::Start, true) => *u = *origin,
                (At::Trial(_), true) | (At::Start, false) => {}
            }
        }
    }

    /// Makes coordinates X those at which kernels see the start: X + u_0 in (E20).
    fn begin_at<'x>(&self, origin: &[f64], x: impl Iterator<Item = &'x mut f64>) {
        if self.kinematics == Kinematics::Finite && !self.subtracts {
            x.zip(origin).for_each(|(x, origin)| *x += origin);
        }
    }

    /// Adds the temperatures of the nodes of a cell, where there are any: those at present, and those that expansion counts
    /// from.
    fn heat(
        &self,
        block: &Cells,
        cell: usize,
        at: At<'_>,
        now: &mut Vec<f64>,
        at_start: &mut Vec<f64>,
    ) {
        let Some(field) = &self.temperature else {
            return;
        };
        let since = block.part.since(cell);
        let nodes = block.ends_of(cell).iter();
        let start = |node: NodeId| field.at_begin(since.unwrap_or(0), node);
        now.extend(nodes.clone().map(|&node| match at {
            At::Trial(_) => at.temperature(&self.layout, field, &self.step, node),
            At::Start => start(node),
        }));
        at_start.extend(nodes.map(|&node| start(node)));
    }

    /// A cell without places and temperatures.
    pub(super) fn element<'a>(&'a self, block: &'a Cells, cell: usize, at: At<'_>) -> Element<'a> {
        Element {
            reference: &block.points,
            x: &[],
            u: &[],
            correction: &[],
            way: &[],
            rate: &[],
            slope: 0.0,
            material: self.material(),
            kinematics: self.kinematics,
            space: self.space,
            profile: &[],
            temperature: &[],
            temperature_at_start: &[],
            ndilatation: block.ndilatation,
            old: match at {
                At::Trial(_) => &block.history[cell * block.nhistory..(cell + 1) * block.nhistory],
                At::Start => &block.undeformed,
            },
            initial: block.initial_of(cell),
            axes: block.frames.of(cell),
        }
    }

    /// Where a cell is, where its nodes go, and all else that they have.
    pub(super) fn place(&self, block: &Cells, cell: usize, at: At<'_>, scratch: &mut Scratch) {
        self.locate(block, cell, at, scratch);
        scratch.x.clear();
        let nodes = block.ends_of(cell).iter();
        let places = nodes.map(|&node| self.reference[node as usize]);
        scratch.x.extend(places);
        if !block.ends.is_empty() {
            to_directors(&mut scratch.x);
        }
        let origin = self.origin(block, cell);
        if !origin.is_empty() {
            let ndim = self.layout.ndim();
            let axes = scratch.x.iter_mut().flat_map(|at| {
                let Vec3 { x, y, z } = at;
                [x, y, z].into_iter().take(ndim)
            });
            self.begin_at(origin, axes);
        }
        scratch.profile.clear();
        if let Some(profile) = &self.profile {
            let at = |&node: &NodeId| profile.get(node as usize).copied().unwrap_or(1.0);
            scratch.profile.extend(block.nodes_of(cell).iter().map(at));
        }
        scratch.temperature.clear();
        scratch.temperature_at_start.clear();
        let (now, at_start) = (&mut scratch.temperature, &mut scratch.temperature_at_start);
        self.heat(block, cell, at, now, at_start);
    }

    /// Runs the kernel over one cell: results are in the scratch, the energy comes back.
    pub(super) fn cell(
        &self,
        block: &Cells,
        cell: usize,
        at: At<'_>,
        wanted: Wanted,
        scratch: &mut Scratch,
    ) -> Result<f64, TermError> {
        self.place(block, cell, at, scratch);
        scratch.correction.clear();
        let correction = self.correction(at);
        if !correction.is_empty() {
            let of_dof = |dof: &Dof| correction.get(*dof as usize).copied().unwrap_or_default();
            scratch.correction.extend(scratch.dofs.iter().map(of_dof));
        }
        scratch.way.clear();
        let way = self.secant_way(at);
        if let Some(way) = way {
            let ndim = self.layout.ndim();
            let of_node = |&node: &NodeId| way.get(node as usize).copied().unwrap_or_default();
            let ways = block.nodes_of(cell).iter().map(of_node);
            scratch
                .way
                .extend(ways.flat_map(|way| way.to_array().into_iter().take(ndim)));
        }
        let element = Element {
            x: &scratch.x,
            u: &scratch.u,
            correction: &scratch.correction,
            way: &scratch.way,
            profile: &scratch.profile,
            temperature: &scratch.temperature,
            temperature_at_start: &scratch.temperature_at_start,
            ..self.element(block, cell, at)
        };
        let mut out = Output {
            force: &mut scratch.force,
            stiffness: &mut scratch.stiffness,
            energy: 0.0,
            thermal: &mut scratch.thermal,
            new: &mut scratch.new,
            samples: &mut scratch.samples,
            scratch: &mut scratch.inner,
        };
        let treatment = block.treatment(self.kinematics);
        let secant = treatment.secant.filter(|_| way.is_some());
        let kernel = secant.unwrap_or(treatment.kernel);
        let outcome = kernel(&element, wanted.order(), &mut out);
        let energy = out.energy;
        let label = block.labels[cell];
        outcome.map_err(|failure| self.failure(label, failure))?;
        if !energy.is_finite() || !scratch.force.iter().all(|f| f.is_finite()) {
            return Err(TermError::NotFinite {
                what: format!("the force of element {label} of body \"{}\"", self.name),
            });
        }
        Ok(energy)
    }

    pub(super) fn failure(&self, element: u64, failure: Failure) -> TermError {
        let body = self.name.clone();
        match failure {
            Failure::Inverted { ratio } => TermError::Inverted {
                body,
                element,
                ratio,
            },
            Failure::Material(error) => TermError::Material {
                body,
                element,
                message: error.to_string(),
            },
        }
    }

    pub(super) fn archived(&self, block: usize) -> String {
        format!("solid.{}.{block}.history", self.name)
    }
}

impl Term for Solid {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        let later = self.later.iter().map(|(_, material)| material);
        let mut all = std::iter::once(&self.material).chain(later);
        let is_secant = self.takes_secants();
        let is_viscous = self.damping.stiff().is_some() && self.kinematics == Kinematics::Finite;
        let is_plain = !is_secant && !is_viscous && !self.swells();
        let symmetry = if is_plain && all.all(|material| material.is_symmetric()) {
            Symmetry::Definite
        } else {
            Symmetry::Unsymmetric
        };
        let lifetime = match (self.kinematics, &self.temperature) {
            _ if self.swells() => Lifetime::State,
            (Kinematics::Small, _) if !self.material().linearity().is_linear() => Lifetime::State,
            (Kinematics::Small, Some(_)) => Lifetime::Increment,
            (Kinematics::Small, None) => Lifetime::Step,
            (Kinematics::Finite, _) => Lifetime::State,
        };
        Properties {
            lifetime: self.damping.lifetime(lifetime),
            retardation: self.damping.retardation,
            elements: self.elements_id(),
            to_end: is_secant,
            predicts: self.predicts,
            ..Properties::new(symmetry, Part::Bulk)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for block in &self.blocks {
            let cells = block.nodes.chunks_exact(block.nnode).enumerate();
            for (cell, nodes) in cells.filter(|(cell, _)| block.part.is_active(*cell)) {
                out.bulk(nodes);
                self.couple_heat(nodes, block.ends_of(cell), out);
            }
        }
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        let kinematics = if phase.step.nonlinear {
            Kinematics::Finite
        } else {
            Kinematics::Small
        };
        self.locking(kinematics).map_err(|e| TermError::Refused {
            message: e.to_string(),
        })?;
        let begins = phase.increment.is_none();
        if begins {
            // forces of what is removed are those of the step before
            self.change_cells(phase.step.number, from)?;
        }
        self.step = phase.step;
        self.set_kinematics(kinematics);
        self.predicts = self.may_predict();
        self.begin_damping(phase, from);
        if self.step.conserves() {
            self.conserves_energy(kinematics)
                .map_err(|e| TermError::Refused {
                    message: e.to_string(),
                })?;
        }
        match begins {
            true => self.take_part(from),
            false => Ok(()),
        }
    }

    fn nchunk(&self) -> usize {
        if !self.step.physics.moves {
            return 0;
        }
        self.chunks.len() + self.plan.as_ref().map_or(0, Plan::nchunk)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let wanted = match order {
            Order::Residual => Wanted::Forces,
            Order::Tangent => Wanted::Stiffness,
        };
        if let Some(plan) = self.plan.as_ref().filter(|_| chunk >= self.chunks.len()) {
            plan.exert(&self.layout, &self.step, trial.time, out);
            return Ok(());
        }
        let scratch = work.of::<Scratch>();
        let at = At::Trial(trial);
        let slope = self.damping.flow().map_or(0.0, |flow| flow.slope);
        let stiffer = 1.0 + self.damping.retardation * slope;
        self.each(chunk, at, wanted, scratch, |block, cell, _, s| {
            self.hand(at, s, out);
            self.hand_thermal(block.ends_of(cell), s, out);
            block.doubt(cell, stiffer, s, out);
        })
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
        if let Some(plan) = self.plan.as_ref().filter(|_| chunk >= self.chunks.len()) {
            return Ok(Some(plan.energy(&self.step, trial)));
        }
        // without a potential there is none
        if !self.material().is_symmetric() {
            return Ok(None);
        }
        let (at, mut total) = (At::Trial(trial), 0.0);
        let scratch = work.of::<Scratch>();
        self.each(chunk, at, Wanted::Forces, scratch, |_, _, energy, _| {
            total += energy;
        })?;
        Ok(Some(total))
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        // points in parallel, nodes in the order of cells
        let chunks: Vec<usize> = (0..self.chunks.len()).collect();
        for wave in chunks.chunks(SAMPLED) {
            let sample = |scratch: &mut Scratch, &chunk: &usize| {
                let (at, mut samples) = (At::Trial(state), Vec::new());
                self.each(chunk, at, Wanted::Samples, scratch, |_, _, _, s| {
                    samples.extend_from_slice(&s.samples);
                })?;
                Ok(samples)
            };
            let sampled = wave.par_iter().map_init(Scratch::default, sample);
            let sampled: Vec<Result<Vec<Sample>, TermError>> = sampled.collect();
            for (&chunk, samples) in wave.iter().zip(sampled) {
                let (number, first, last) = self.chunks[chunk];
                let (block, samples) = (&self.blocks[number], samples?);
                let npoint = block.points.rule.npoint();
                let active = (first..last).filter(|cell| block.part.is_active(*cell));
                for (cell, samples) in active.zip(samples.chunks_exact(npoint)) {
                    let (id, nodes) = (block.ids[cell], block.ends_of(cell));
                    report::add(frame, id, nodes, &block.extrapolation, samples);
                }
            }
        }
        if self.plan.is_some() {
            let cells = self.blocks.iter().flat_map(|block| {
                let ids = block.ids.iter().enumerate();
                ids.map(|(cell, &id)| (id, block.part.is_active(cell)))
            });
            cells.for_each(|(id, is_active)| frame.set_active(id, is_active));
        }
        if state.rates.is_some() && self.damping.retardation > 0.0 {
            frame.energies.get_or_insert_default().damping += self.damping.spent;
        }
        if let Some(field) = &self.temperature {
            frame.temperature.resize(frame.stress.len(), 0.0);
            for &node in self.blocks.iter().flat_map(|b| b.all_ends()) {
                if let Some(to) = frame.temperature.get_mut(node as usize) {
                    *to = At::Trial(state).temperature(&self.layout, field, &self.step, node);
                }
            }
        }
        Ok(())
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            initial_stiffness: Some(self),
            elementwise: Some(self),
            stored: Some(self),
            sampled: Some(self),
            ..Capabilities::default()
        }
    }

    fn stored(&mut self) -> Option<&mut dyn Stored> {
        Some(self)
    }
}
