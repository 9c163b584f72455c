use super::at::At;
use super::choice::{Situation, keeps_volume};
use super::kernel::{
    Batch, BatchKernel, Element, Failure, Initial, Kernel, Output, Points, Remedy, Results, Sample,
    batch_kernel, kernel, width,
};
use super::report;
use super::{AtNodes, Integration, Locking};
use crate::material::{Kinematics, Material, Order as MaterialOrder, Reduced, Strain};
use crate::system::{
    Archive, ArchiveError, Capabilities, Dof, Elementwise, Frame, Idealisation, InitialStiffness,
    Layout, Lifetime, NodalField, Order, Part, PatternSink, Phase, PointSample, Properties,
    Sampled, Samples, Sink, State, StepContext, Stored, Symmetry, Term, TermError, Work,
};
use rayon::prelude::*;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::{Sym3, Vec3};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use thiserror::Error;

/// Cells evaluated together: enough to be worth a task, few enough to stay in cache.
const CHUNK: usize = 16;
/// Chunks whose points are sampled before their nodes take them: bounds the memory.
const SAMPLED: usize = 256;

/// The cells of one material.
pub struct Solid {
    name: String,
    layout: Layout,
    reference: Arc<[Vec3]>,
    material: Box<dyn Material>,
    // materials that take its place, each with the step from which on it does, in their order
    later: Vec<(usize, Box<dyn Material>)>,
    kinematics: Kinematics,
    space: Idealisation,
    temperature: Option<Arc<NodalField>>,
    step: StepContext,
    blocks: Vec<Cells>,
    // (block, first cell, last cell)
    chunks: Vec<(usize, usize, usize)>,
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
}

/// Stress and strain that a quadrature point has at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtStart {
    /// The cell.
    pub cell: CellId,
    /// The point, from 0, in the order of the rule of its element.
    pub point: usize,
    /// Stress without strain: Cauchy, or second Piola–Kirchhoff at finite strain.
    pub stress: Sym3,
    /// Strain without stress: linearized, or of Green and Lagrange.
    pub strain: Sym3,
}

/// What is done against locking at one size of strains.
struct Treatment {
    /// What became of the wish; why it cannot be had.
    locking: Result<Locking, &'static str>,
    kernel: Kernel,
    /// For several cells at once.
    batch: Option<BatchKernel>,
}

/// Cells of one element.
struct Cells {
    element: &'static str,
    points: Points,
    small: Treatment,
    finite: Treatment,
    ndilatation: usize,
    nnode: usize,
    nodes: Vec<NodeId>,
    labels: Vec<u64>,
    // where they are in the mesh
    ids: Vec<CellId>,
    // from quadrature points to nodes: `nnode` rows of `npoint`
    extrapolation: Vec<f64>,
    // numbers of history of a cell: those of its points, then its incompatible modes
    nhistory: usize,
    // history of a cell of the undeformed material
    undeformed: Vec<f64>,
    // accepted history of all cells
    history: Vec<f64>,
    // at the points of all cells; empty where there is nothing at the start
    initial: Vec<Initial>,
    // a force that a displacement of one would need at a node of each cell: what rounding is amplified by
    rigidity: Vec<f64>,
}

/// Why a body cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolidError {
    /// An element that is no solid in this space.
    #[error("element {label} of body \"{body}\" is a {element}: no solid in {ndim} dimensions")]
    NotSolid {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// Its type.
        element: &'static str,
        /// Dimension of the problem.
        ndim: usize,
    },
    /// An element that is no bar.
    #[error("element {label} of truss \"{body}\" is a {element}: bars are line2 or line3")]
    NotBar {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// Its type.
        element: &'static str,
    },
    /// A bar without length or a body without cross-section.
    #[error("element {label} of truss \"{body}\" has no {what}")]
    NoSize {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// Length, or cross-section.
        what: &'static str,
    },
    /// A bar in an axisymmetric model.
    #[error("truss \"{body}\" is in an axisymmetric model: bars exist in space and in the plane")]
    BarOfRevolution {
        /// Name of the body.
        body: String,
    },
    /// A stress at the start at a point that is not there.
    #[error(
        "element {label} of body \"{body}\", a {element}, has {npoint} points: there is no point {point}"
    )]
    NoPoint {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// Its type.
        element: &'static str,
        /// How many there are.
        npoint: usize,
        /// The one that was named, from 1.
        point: usize,
    },
    /// A material that takes the place of one with another history.
    #[error(
        "body \"{body}\" changes to a material that remembers other things than the one before"
    )]
    OtherHistory {
        /// Name of the body.
        body: String,
    },
    /// A remedy that an element does not have.
    #[error(
        "locking = \"{locking}\" is not possible for the {element} of body \"{body}\": {reason}"
    )]
    Locking {
        /// Name of the body.
        body: String,
        /// Type of the elements.
        element: &'static str,
        /// What was asked for.
        locking: Locking,
        /// Why it cannot be had.
        reason: &'static str,
    },
    /// An axisymmetric element that reaches beyond the axis.
    #[error(
        "element {label} of body \"{body}\" reaches to the radius {radius:.6e}: in an axisymmetric model x is the radius, 0 or more"
    )]
    Radius {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        label: u64,
        /// The radius.
        radius: f64,
    },
}

/// Scratch of one thread.
#[derive(Default)]
struct Scratch {
    x: Vec<Vec3>,
    u: Vec<f64>,
    temperature: Vec<f64>,
    temperature_at_start: Vec<f64>,
    dofs: Vec<Dof>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
    samples: Vec<Sample>,
    new: Vec<f64>,
    inner: Vec<f64>,
    /// Where the stiffness is symmetric: see [`Sink::add_symmetric`].
    blocks: Vec<f64>,
    lanes: InLanes,
}

/// The same of several cells, lane by lane.
#[derive(Default)]
struct InLanes {
    x: Vec<f64>,
    u: Vec<f64>,
    force: Vec<f64>,
    blocks: Vec<f64>,
    energy: Vec<f64>,
}

/// What is wanted of the cells.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Forces,
    Stiffness,
    Samples,
}

impl Wanted {
    const fn order(self) -> MaterialOrder {
        match self {
            Self::Stiffness => MaterialOrder::Tangent,
            Self::Forces | Self::Samples => MaterialOrder::Stress,
        }
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
            material,
            integration,
            locking,
            temperature,
            linear_temperatures,
            at_nodes,
            initial,
        } = parts;
        let material: Box<dyn Material> = match space {
            Idealisation::PlaneStress { .. } => Box::new(Reduced::plane_stress(material)),
            _ => material,
        };
        let keeps_volume = |kinematics| keeps_volume(material.as_ref(), kinematics);
        let keeps_volume = [Kinematics::Small, Kinematics::Finite].map(keeps_volume);
        let mut blocks: Vec<(u32, Cells)> = Vec::new();
        for &id in cells {
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
                    blocks.len() - 1
                }
            };
            let of_block = &mut blocks[at].1;
            of_block.nodes.extend_from_slice(mesh.cell(id));
            of_block.labels.push(label);
            of_block.ids.push(id);
        }
        let mut blocks: Vec<Cells> = blocks.into_iter().map(|(_, c)| c).collect();
        let mut chunks = Vec::new();
        for (number, block) in blocks.iter_mut().enumerate() {
            if space == Idealisation::Axisymmetric {
                block.radii(name, &reference)?;
            }
            block.start(material.as_ref());
            block.begin(name, initial)?;
            block.rigidity = block.rigidities(&reference, space, material.modulus());
            let ncell = block.labels.len();
            chunks.extend(
                (0..ncell)
                    .step_by(CHUNK)
                    .map(|first| (number, first, (first + CHUNK).min(ncell))),
            );
        }
        Ok(Self {
            name: name.to_string(),
            layout,
            reference,
            material,
            later: Vec::new(),
            kinematics: Kinematics::Finite,
            space,
            temperature,
            step: StepContext::default(),
            blocks,
            chunks,
        })
    }

    /// Another material takes the place of the present one when a step begins; steps come in their order.
    ///
    /// # Errors
    /// Its history at a point is another one's.
    pub fn change(&mut self, step: usize, material: Box<dyn Material>) -> Result<(), SolidError> {
        let material: Box<dyn Material> = match self.space {
            Idealisation::PlaneStress { .. } => Box::new(Reduced::plane_stress(material)),
            _ => material,
        };
        if material.nhistory() != self.material.nhistory() {
            return Err(SolidError::OtherHistory {
                body: self.name.clone(),
            });
        }
        self.later.push((step, material));
        Ok(())
    }

    /// How many materials have taken the place of one before.
    fn nchanged(&self) -> usize {
        let is_begun = |(step, _): &&(usize, _)| *step <= self.step.number;
        self.later.iter().take_while(is_begun).count()
    }

    /// The material of the present step.
    fn material(&self) -> &dyn Material {
        let last = self.nchanged().checked_sub(1);
        let later = last.and_then(|last| self.later.get(last));
        later.map_or(self.material.as_ref(), |(_, material)| material.as_ref())
    }

    /// Which strains it uses; steps change it.
    pub fn set_kinematics(&mut self, kinematics: Kinematics) {
        self.kinematics = kinematics;
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
    fn each(
        &self,
        chunk: usize,
        at: At<'_>,
        wanted: Wanted,
        scratch: &mut Scratch,
        mut take: impl FnMut(&Cells, usize, f64, &Scratch),
    ) -> Result<(), TermError> {
        let Some(&(number, first, last)) = self.chunks.get(chunk) else {
            return Ok(());
        };
        let block = &self.blocks[number];
        scratch.size(block, self.layout.ndim(), wanted);
        let is_symmetric = self.material().is_symmetric();
        let batch = block.treatment(self.kinematics).batch;
        let batch = batch.filter(|_| wanted != Wanted::Samples && is_symmetric);
        let width = if batch.is_some() { width() } else { 1 };
        for begin in (first..last).step_by(width) {
            let cells = begin..last.min(begin + width);
            let is_done =
                batch.is_some_and(|b| self.batch(block, b, cells.clone(), at, wanted, scratch));
            for (lane, cell) in cells.enumerate() {
                let energy = if is_done {
                    self.pick(block, cell, at, (lane, width), scratch)
                } else {
                    let energy = self.cell(block, cell, at, wanted, scratch)?;
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
    fn hand(&self, of: &Scratch, out: &mut dyn Sink) {
        if self.material().is_symmetric() {
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
        lanes.force.resize(n * width, 0.0);
        lanes.blocks.resize(nblocks * width, 0.0);
        lanes.energy.resize(width, 0.0);
        // lanes without a cell repeat the last one
        let cell_of = |lane: usize| cells.end.min(cells.start + lane + 1) - 1;
        temperature.clear();
        temperature_at_start.clear();
        for lane in 0..width {
            let nodes = block.nodes_of(cell_of(lane));
            for (k, &node) in nodes.iter().enumerate() {
                let x = self.reference[node as usize].to_array();
                for (axis, x) in x.into_iter().enumerate().take(self.layout.ndim()) {
                    let place = (k * self.layout.ndim() + axis) * width + lane;
                    lanes.x[place] = x;
                    lanes.u[place] = at.displacement(self.layout.node(node, axis));
                }
            }
            self.heat(nodes, at, temperature, temperature_at_start);
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
    fn locate(&self, block: &Cells, cell: usize, at: At<'_>, scratch: &mut Scratch) {
        scratch.u.clear();
        scratch.dofs.clear();
        for &node in block.nodes_of(cell) {
            for axis in 0..self.layout.ndim() {
                let dof = self.layout.node(node, axis);
                scratch.dofs.push(dof);
                scratch.u.push(at.displacement(dof));
            }
        }
    }

    /// Adds the temperatures of nodes, where there are any.
    fn heat(&self, nodes: &[NodeId], at: At<'_>, now: &mut Vec<f64>, at_start: &mut Vec<f64>) {
        if let Some(field) = &self.temperature {
            let present = nodes.iter();
            now.extend(present.map(|&node| at.temperature(field, &self.step, node)));
            at_start.extend(nodes.iter().map(|&node| field.at_start(node)));
        }
    }

    /// A cell without places and temperatures.
    fn element<'a>(&'a self, block: &'a Cells, cell: usize, at: At<'_>) -> Element<'a> {
        Element {
            reference: &block.points,
            x: &[],
            u: &[],
            material: self.material(),
            kinematics: self.kinematics,
            space: self.space,
            temperature: &[],
            temperature_at_start: &[],
            ndilatation: block.ndilatation,
            old: match at {
                At::Trial(_) => &block.history[cell * block.nhistory..(cell + 1) * block.nhistory],
                At::Start => &block.undeformed,
            },
            initial: block.initial_of(cell),
        }
    }

    /// Runs the kernel over one cell: results are in the scratch, the energy comes back.
    fn cell(
        &self,
        block: &Cells,
        cell: usize,
        at: At<'_>,
        wanted: Wanted,
        scratch: &mut Scratch,
    ) -> Result<f64, TermError> {
        let nodes = block.nodes_of(cell);
        self.locate(block, cell, at, scratch);
        scratch.x.clear();
        let places = nodes.iter().map(|&node| self.reference[node as usize]);
        scratch.x.extend(places);
        scratch.temperature.clear();
        scratch.temperature_at_start.clear();
        let (now, at_start) = (&mut scratch.temperature, &mut scratch.temperature_at_start);
        self.heat(nodes, at, now, at_start);
        let element = Element {
            x: &scratch.x,
            u: &scratch.u,
            temperature: &scratch.temperature,
            temperature_at_start: &scratch.temperature_at_start,
            ..self.element(block, cell, at)
        };
        let mut out = Output {
            force: &mut scratch.force,
            stiffness: &mut scratch.stiffness,
            energy: 0.0,
            new: &mut scratch.new,
            samples: &mut scratch.samples,
            scratch: &mut scratch.inner,
        };
        let kernel = block.treatment(self.kinematics).kernel;
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

    fn failure(&self, element: u64, failure: Failure) -> TermError {
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

    fn archived(&self, block: usize) -> String {
        format!("solid.{}.{block}.history", self.name)
    }
}

impl Cells {
    /// No cells yet; `None` where there is no kernel for the element.
    fn new(
        situation: impl Fn(Kinematics) -> Situation,
        wish: Locking,
        nhistory: usize,
        at_nodes: AtNodes,
    ) -> Option<Self> {
        let treatment = |kinematics| {
            let situation = situation(kinematics);
            let locking = situation.choose(wish);
            let remedy = locking.map_or(Remedy::None, Locking::remedy);
            let (element, space) = (situation.element, situation.space);
            Some(Treatment {
                locking,
                kernel: kernel(element, space, remedy)?,
                batch: batch_kernel(element, space, remedy),
            })
        };
        let (small, finite) = (
            treatment(Kinematics::Small)?,
            treatment(Kinematics::Finite)?,
        );
        let element = situation(Kinematics::Small).element;
        let projected = [&small, &finite].map(|t| t.locking.map(Locking::remedy));
        let rule = situation(Kinematics::Small).rule(projected.contains(&Ok(Remedy::Dilatation)));
        let modes = match small.locking {
            Ok(Locking::Incompatible) => element.dim() * element.dim(),
            _ => 0,
        };
        Some(Self {
            element: element.name(),
            extrapolation: report::extrapolation(element, rule, at_nodes),
            points: Points::new(element, rule),
            small,
            finite,
            ndilatation: situation(Kinematics::Small).ndilatation(),
            nnode: element.nnode(),
            nodes: Vec::new(),
            labels: Vec::new(),
            ids: Vec::new(),
            rigidity: Vec::new(),
            nhistory: rule.npoint() * nhistory + modes,
            undeformed: Vec::new(),
            history: Vec::new(),
            initial: Vec::new(),
        })
    }

    const fn treatment(&self, kinematics: Kinematics) -> &Treatment {
        match kinematics {
            Kinematics::Small => &self.small,
            Kinematics::Finite => &self.finite,
        }
    }

    fn refusal(&self, body: &str, locking: Locking, reason: &'static str) -> SolidError {
        SolidError::Locking {
            body: body.to_string(),
            element: self.element,
            locking,
            reason,
        }
    }

    fn nodes_of(&self, cell: usize) -> &[NodeId] {
        &self.nodes[cell * self.nnode..(cell + 1) * self.nnode]
    }

    /// Gives every cell the history of the undeformed material.
    fn start(&mut self, material: &dyn Material) {
        let n = material.nhistory();
        self.undeformed = vec![0.0; self.nhistory];
        if n > 0 {
            let of_points = self.points.rule.npoint() * n;
            let points = self.undeformed[..of_points].chunks_exact_mut(n);
            points.for_each(|point| material.start(point));
        }
        self.history = self.undeformed.repeat(self.labels.len());
    }

    /// Gives its points what they have at the start.
    fn begin(&mut self, body: &str, given: &[AtStart]) -> Result<(), SolidError> {
        if given.is_empty() {
            return Ok(());
        }
        let npoint = self.points.rule.npoint();
        let places: HashMap<CellId, usize> = self.ids.iter().copied().zip(0..).collect();
        for at in given {
            let Some(&cell) = places.get(&at.cell) else {
                continue;
            };
            if at.point >= npoint {
                return Err(SolidError::NoPoint {
                    body: body.to_string(),
                    label: self.labels[cell],
                    element: self.element,
                    npoint,
                    point: at.point + 1,
                });
            }
            self.initial
                .resize(self.ids.len() * npoint, Initial::default());
            let to = &mut self.initial[cell * npoint + at.point];
            to.stress = to.stress + at.stress;
            to.strain = to.strain + at.strain;
        }
        Ok(())
    }

    fn initial_of(&self, cell: usize) -> &[Initial] {
        let npoint = self.points.rule.npoint();
        let of_cell = self.initial.get(cell * npoint..(cell + 1) * npoint);
        of_cell.unwrap_or_default()
    }

    /// `M ∫ max_i |N_i,X|² dV` of every cell, with the modulus `M`: the largest entry of its stiffness, about.
    fn rigidities(&self, reference: &[Vec3], space: Idealisation, modulus: f64) -> Vec<f64> {
        let at = |node: &NodeId| reference.get(*node as usize).copied().unwrap_or_default();
        let mut x: Vec<Vec3> = Vec::new();
        let of_cell = |nodes: &[NodeId]| {
            x.clear();
            x.extend(nodes.iter().map(at));
            modulus * self.points.stretch(&x, space)
        };
        self.nodes.chunks_exact(self.nnode).map(of_cell).collect()
    }

    /// Checks that no node lies beyond the axis, and no quadrature point on it.
    fn radii(&self, body: &str, reference: &[Vec3]) -> Result<(), SolidError> {
        for (nodes, &label) in self.nodes.chunks_exact(self.nnode).zip(&self.labels) {
            let radius = |node: NodeId| reference.get(node as usize).map_or(0.0, |x| x.x);
            let at_point = |point| {
                let shape = self.points.shape(point).iter();
                let radius: f64 = shape.zip(nodes).map(|(n, &node)| n * radius(node)).sum();
                radius
            };
            let nearest = nodes.iter().map(|&n| radius(n)).fold(f64::MAX, f64::min);
            let inside = (0..self.points.rule.npoint()).map(at_point);
            let inside = inside.fold(f64::MAX, f64::min);
            if nearest < 0.0 || inside <= 0.0 {
                return Err(SolidError::Radius {
                    body: body.to_string(),
                    label,
                    radius: nearest.min(inside),
                });
            }
        }
        Ok(())
    }
}

impl Scratch {
    fn size(&mut self, block: &Cells, ndim: usize, wanted: Wanted) {
        let n = block.nnode * ndim;
        let stiff = wanted == Wanted::Stiffness;
        let npoint = block.points.rule.npoint();
        self.force.resize(n, 0.0);
        self.stiffness.resize(if stiff { n * n } else { 0 }, 0.0);
        let npair = block.nnode * (block.nnode + 1) / 2;
        let nblocks = if stiff { npair * ndim * ndim } else { 0 };
        self.blocks.resize(nblocks, 0.0);
        self.new.resize(block.nhistory, 0.0);
        let sampled = wanted == Wanted::Samples;
        self.samples
            .resize(if sampled { npoint } else { 0 }, Sample::default());
    }

    /// Takes the blocks of a stiffness that is symmetric.
    fn pack(&mut self, nnode: usize, ndim: usize) {
        let n = nnode * ndim;
        let pairs = (0..nnode).flat_map(|j| (0..=j).map(move |i| (i, j)));
        for ((i, j), block) in pairs.zip(self.blocks.chunks_exact_mut(ndim * ndim)) {
            for (k, row) in block.chunks_exact_mut(ndim).enumerate() {
                let at = (i * ndim + k) * n + j * ndim;
                row.copy_from_slice(&self.stiffness[at..at + ndim]);
            }
        }
    }
}

impl Term for Solid {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        let later = self.later.iter().map(|(_, material)| material);
        let mut all = std::iter::once(&self.material).chain(later);
        let symmetry = if all.all(|material| material.is_symmetric()) {
            Symmetry::Definite
        } else {
            Symmetry::Unsymmetric
        };
        let lifetime = match (self.kinematics, &self.temperature) {
            (Kinematics::Small, _) if !self.material().linearity().is_linear() => Lifetime::State,
            (Kinematics::Small, Some(_)) => Lifetime::Increment,
            (Kinematics::Small, None) => Lifetime::Step,
            (Kinematics::Finite, _) => Lifetime::State,
        };
        Properties {
            lifetime,
            ..Properties::new(symmetry, Part::Bulk)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for block in &self.blocks {
            for cell in block.nodes.chunks_exact(block.nnode) {
                out.bulk(cell);
            }
        }
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        let kinematics = if phase.step.nonlinear {
            Kinematics::Finite
        } else {
            Kinematics::Small
        };
        self.locking(kinematics).map_err(|e| TermError::Refused {
            message: e.to_string(),
        })?;
        self.kinematics = kinematics;
        self.step = phase.step;
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.chunks.len()
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
        let scratch = work.of::<Scratch>();
        let at = At::Trial(trial);
        self.each(chunk, at, wanted, scratch, |block, cell, _, s| {
            self.hand(s, out);
            // strains are sums of as many products as there are nodes
            let far = s.u.iter().fold(0.0f64, |far, u| far.max(u.abs()));
            let sum = block.rigidity[cell] * block.nnode as f64;
            out.uncertain(&s.dofs, f64::EPSILON * sum * far);
        })
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
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
                for (cell, samples) in (first..last).zip(samples.chunks_exact(npoint)) {
                    let (id, nodes) = (block.ids[cell], block.nodes_of(cell));
                    report::add(frame, id, nodes, &block.extrapolation, samples);
                }
            }
        }
        if let Some(field) = &self.temperature {
            frame.temperature.resize(frame.stress.len(), 0.0);
            for &node in self.blocks.iter().flat_map(|b| &b.nodes) {
                if let Some(to) = frame.temperature.get_mut(node as usize) {
                    *to = field.at(&self.step, state.time, node);
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

impl InitialStiffness for Solid {
    fn id(&self) -> u64 {
        2 * self.nchanged() as u64 + self.kinematics as u64
    }

    fn add_initial(
        &self,
        chunk: usize,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let scratch = work.of::<Scratch>();
        let wanted = Wanted::Stiffness;
        self.each(chunk, At::Start, wanted, scratch, |_, _, _, s| {
            self.hand(s, out);
        })
    }

    fn is_initial(&self, trial: &State) -> bool {
        let at = |&node: &NodeId| (0..self.layout.ndim()).map(move |i| self.layout.node(node, i));
        let is_undeformed = |block: &Cells| {
            let mut displacements = block
                .nodes
                .iter()
                .flat_map(at)
                .map(|dof| trial.u[dof as usize]);
            block.nhistory == 0 && displacements.all(|u| u == 0.0)
        };
        self.temperature.is_none() && self.blocks.iter().all(is_undeformed)
    }
}

impl Elementwise for Solid {
    fn elements(&self, chunk: usize, take: &mut dyn FnMut(&[NodeId])) {
        if let Some(&(number, first, last)) = self.chunks.get(chunk) {
            let block = &self.blocks[number];
            (first..last).for_each(|cell| take(block.nodes_of(cell)));
        }
    }
}

impl Stored for Solid {
    /// Evaluates once more, from the last accepted history: trial history is kept nowhere, so that evaluation is pure.
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        let next = |block: &Cells| -> Result<Vec<f64>, TermError> {
            let n = block.nhistory;
            let mut next = vec![0.0; block.history.len()];
            if n == 0 {
                return Ok(next);
            }
            let chunks = next.par_chunks_mut(CHUNK * n).enumerate();
            chunks.try_for_each_init(Scratch::default, |scratch, (chunk, next)| {
                scratch.size(block, self.layout.ndim(), Wanted::Forces);
                for (k, to) in next.chunks_exact_mut(n).enumerate() {
                    let cell = chunk * CHUNK + k;
                    // what a kernel does not write stays as it was
                    scratch
                        .new
                        .copy_from_slice(&block.history[cell * n..(cell + 1) * n]);
                    self.cell(block, cell, At::Trial(state), Wanted::Forces, scratch)?;
                    to.copy_from_slice(&scratch.new);
                }
                Ok(())
            })?;
            Ok(next)
        };
        let histories: Result<Vec<_>, _> = self.blocks.iter().map(next).collect();
        for (block, history) in self.blocks.iter_mut().zip(histories?) {
            block.history = history;
        }
        Ok(())
    }

    fn save(&self, out: &mut Archive) {
        for (number, block) in self.blocks.iter().enumerate() {
            if block.nhistory > 0 {
                out.put(self.archived(number), &block.history);
            }
        }
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        for number in 0..self.blocks.len() {
            let name = self.archived(number);
            let block = &mut self.blocks[number];
            if block.nhistory > 0 {
                from.get(&name, &mut block.history)?;
            }
        }
        Ok(())
    }
}

impl Sampled for Solid {
    fn sample(&self, state: &State, cells: &[CellId], out: &mut Samples) -> Result<(), TermError> {
        let mut scratch = Scratch::default();
        for block in &self.blocks {
            scratch.size(block, self.layout.ndim(), Wanted::Samples);
            for (cell, id) in block.ids.iter().enumerate() {
                if cells.binary_search(id).is_err() {
                    continue;
                }
                self.cell(block, cell, At::Trial(state), Wanted::Samples, &mut scratch)?;
                let of_point = |s: &Sample| PointSample {
                    stress: s.stress,
                    strain: s.seen,
                    mechanical_strain: self.material().mechanical_strain(&Strain {
                        kinematics: self.kinematics,
                        value: s.seen,
                        temperature: s.temperature,
                        temperature_at_start: s.temperature_at_start,
                    }),
                    plastic_strain: s.plastic_strain.unwrap_or(0.0),
                    energy: s.energy,
                    volume: s.volume_at_start,
                };
                out.push(*id, block.points.rule, scratch.samples.iter().map(of_point));
            }
        }
        Ok(())
    }
}
