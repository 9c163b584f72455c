//! Cells of one element: nodes, treatment and initial state.

use super::axes::{Frames, MaterialAxes, on_axis};
use super::choice::Situation;
use super::damping::Since;
use super::error::SolidError;
use super::kernel::{
    BatchKernel, Initial, Kernel, NMODE, Points, Remedy, batch_kernel, kernel, secant_kernel,
    viscous_kernel,
};
use super::plan::Part;
use super::{AtNodes, Locking, report};
use crate::material::{Kinematics, Material};
use crate::system::Idealisation;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use std::collections::HashMap;

/// Cells evaluated together: enough to be worth a task, few enough to stay in cache.
pub(super) const CHUNK: usize = 16;

/// Chunks whose points are sampled before their nodes take them: bounds the memory.
pub(super) const SAMPLED: usize = 256;

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
pub(super) struct Treatment {
    /// What became of the wish; why it cannot be had.
    pub locking: Result<Locking, &'static str>,
    pub kernel: Kernel,
    /// For several cells at once.
    pub batch: Option<BatchKernel>,
    /// Where energy is conserved.
    pub secant: Option<Kernel>,
    /// Of stresses over the rate of strain at finite strain.
    pub viscous: Option<Kernel>,
}

impl Treatment {
    /// Whether the geometric stiffness of its kernel can take predicted stresses.
    pub fn predicts(&self) -> bool {
        let remedy = self.locking.map(Locking::remedy);
        matches!(remedy, Ok(Remedy::None | Remedy::Shell))
    }
}

/// The largest extent of a cell over its smallest one above which it is thin.
const THIN: f64 = 5.0;

/// Cells of one element.
pub(super) struct Cells {
    pub element: &'static str,
    pub points: Points,
    pub small: Treatment,
    pub finite: Treatment,
    pub ndilatation: usize,
    pub nnode: usize,
    // that carry its unknowns
    pub nodes: Vec<NodeId>,
    // those of its cells, where they are others
    pub ends: Vec<NodeId>,
    pub labels: Vec<u64>,
    // where they are in the mesh
    pub ids: Vec<CellId>,
    // from quadrature points to nodes: `nnode` rows of `npoint`
    pub extrapolation: Vec<f64>,
    // numbers of history of a cell: those of its points, then its incompatible modes
    pub nhistory: usize,
    // history of a cell of the undeformed material
    pub undeformed: Vec<f64>,
    // accepted history of all cells
    pub history: Vec<f64>,
    // at the points of all cells, as given; empty where there is nothing at the start
    pub given: Vec<Initial>,
    // the same in the present step, with the strain at which cells were added
    pub initial: Vec<Initial>,
    // which cells take part
    pub part: Part,
    // axes of the material, where it has some
    pub frames: Frames,
    // a force that a displacement of one would need at a node of each cell: what rounding is amplified by
    pub rigidity: Vec<f64>,
    // the same of a displacement of a middle, where `rigidity` is that of half a difference
    pub of_middle: Vec<f64>,
    // of every unknown of every cell where the increment began, where velocities damp
    pub since: Vec<Since>,
}

impl Cells {
    /// No cells yet; `None` where there is no kernel for the element.
    pub fn new(
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
                secant: secant_kernel(element, space, remedy),
                viscous: viscous_kernel(element, space, remedy),
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
            Ok(Locking::Shell) => NMODE,
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
            ends: Vec::new(),
            labels: Vec::new(),
            ids: Vec::new(),
            rigidity: Vec::new(),
            of_middle: Vec::new(),
            since: Vec::new(),
            nhistory: rule.npoint() * nhistory + modes,
            undeformed: Vec::new(),
            history: Vec::new(),
            given: Vec::new(),
            initial: Vec::new(),
            part: Part::default(),
            frames: Frames::default(),
        })
    }

    pub const fn treatment(&self, kinematics: Kinematics) -> &Treatment {
        match kinematics {
            Kinematics::Small => &self.small,
            Kinematics::Finite => &self.finite,
        }
    }

    pub fn refusal(&self, body: &str, locking: Locking, reason: &'static str) -> SolidError {
        SolidError::Locking {
            body: body.to_string(),
            element: self.element,
            locking,
            reason,
        }
    }

    pub fn nodes_of(&self, cell: usize) -> &[NodeId] {
        &self.nodes[cell * self.nnode..(cell + 1) * self.nnode]
    }

    /// Gives every cell the history of the undeformed material.
    pub fn start(&mut self, material: &dyn Material) {
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
    pub fn begin(&mut self, body: &str, given: &[AtStart]) -> Result<(), SolidError> {
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
            self.given
                .resize(self.ids.len() * npoint, Initial::default());
            let to = &mut self.given[cell * npoint + at.point];
            to.stress = to.stress + at.stress;
            to.strain = to.strain + at.strain;
        }
        self.initial.clone_from(&self.given);
        Ok(())
    }

    /// Gives its points the axes of the material; `places` are those of its cells in the body.
    pub fn orient(
        &mut self,
        body: &str,
        axes: Option<&MaterialAxes>,
        places: &[usize],
        reference: &[Vec3],
    ) -> Result<(), SolidError> {
        self.frames = match axes {
            None => Frames::default(),
            Some(MaterialAxes::Uniform(axes)) => Frames::uniform(*axes),
            Some(MaterialAxes::OfCells(all)) => {
                let of_cell = |&place: &usize| all.get(place).copied().unwrap_or(Mat3::IDENTITY);
                Frames::of_cells(places.iter().map(of_cell).collect())
            }
            Some(MaterialAxes::Cylindrical(around)) => {
                let (low, high) = reference.iter().fold(
                    (Vec3::from([f64::MAX; 3]), Vec3::from([f64::MIN; 3])),
                    |(low, high), x| (low.min(*x), high.max(*x)),
                );
                let size = (high - low).norm();
                let npoint = self.points.rule.npoint();
                let mut all = Vec::with_capacity(npoint * self.labels.len());
                for (nodes, &label) in self.all_ends().chunks_exact(self.nnode).zip(&self.labels) {
                    for point in 0..npoint {
                        let mut place = Vec3::ZERO;
                        for (n, &node) in self.points.shape(point).iter().zip(nodes) {
                            let x = reference.get(node as usize).copied().unwrap_or_default();
                            place += x * *n;
                        }
                        let axes = around.at(place, size).ok_or_else(|| on_axis(body, label))?;
                        all.push(axes);
                    }
                }
                Frames::of_points(all, npoint)
            }
        };
        Ok(())
    }

    pub fn initial_of(&self, cell: usize) -> &[Initial] {
        let npoint = self.points.rule.npoint();
        let of_cell = self.initial.get(cell * npoint..(cell + 1) * npoint);
        of_cell.unwrap_or_default()
    }

    /// `M ∫ max_i |N_i,X|² dV` of every cell, with the modulus `M`: the largest entry of its stiffness, about.
    pub fn rigidities(&self, reference: &[Vec3], space: Idealisation, modulus: f64) -> Vec<f64> {
        let at = |node: &NodeId| reference.get(*node as usize).copied().unwrap_or_default();
        let mut x: Vec<Vec3> = Vec::new();
        let of_cell = |nodes: &[NodeId]| {
            x.clear();
            x.extend(nodes.iter().map(at));
            modulus * self.points.stretch(&x, space)
        };
        self.all_ends()
            .chunks_exact(self.nnode)
            .map(of_cell)
            .collect()
    }

    /// Whether most cells are thin, by the map from their reference element at the centre: a few flat ones are no thin body.
    pub fn is_thin(&self, reference: &[Vec3]) -> bool {
        let at = |node: &NodeId| reference.get(*node as usize).copied().unwrap_or_default();
        let mut x: Vec<Vec3> = Vec::new();
        let is_thin = |nodes: &&[NodeId]| {
            x.clear();
            x.extend(nodes.iter().map(at));
            self.points.slenderness(&x) > THIN
        };
        let thin = self.all_ends().chunks_exact(self.nnode).filter(is_thin);
        2 * thin.count() > self.labels.len()
    }

    /// Gives cells that are there their history, what they have at the start, and their bounds of rounding.
    pub fn complete(
        &mut self,
        body: &str,
        material: &dyn Material,
        initial: &[AtStart],
        (space, reference): (Idealisation, &[Vec3]),
    ) -> Result<(), SolidError> {
        if space == Idealisation::Axisymmetric {
            self.radii(body, reference)?;
        }
        self.start(material);
        self.begin(body, initial)?;
        self.rigidity = self.rigidities(reference, space, material.modulus());
        self.of_middle = self.rigidities_of_middles(reference, material.modulus());
        Ok(())
    }

    /// Checks that no node lies beyond the axis, and no quadrature point on it.
    pub fn radii(&self, body: &str, reference: &[Vec3]) -> Result<(), SolidError> {
        for (nodes, &label) in self.all_ends().chunks_exact(self.nnode).zip(&self.labels) {
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
