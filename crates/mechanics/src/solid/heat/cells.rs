//! Cells of one element: nodes, and points to integrate over.

use crate::solid::AtNodes;
use crate::solid::error::SolidError;
use crate::solid::kernel::Points;
use crate::solid::report::extrapolation;
use crate::system::{Frame, Idealisation, profile_at};
use signorini_geometry::element::quadrature::Rule;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::{Mat3, Vec3};

/// Cells evaluated together: enough to be worth a task, few enough to stay in cache.
const CHUNK: usize = 64;

/// Cells of one element.
pub(super) struct Block {
    /// Of conduction.
    points: Points,
    /// Of what is stored.
    mass: Points,
    nnode: usize,
    nodes: Vec<NodeId>,
    ids: Vec<CellId>,
    labels: Vec<u64>,
    /// From points to nodes: `nnode` rows of `npoint`.
    extrapolation: Vec<f64>,
}

/// A point of a cell at the start.
pub(super) struct Place {
    point: usize,
    /// Volume that belongs to it.
    pub weight: f64,
    /// Its distance from the axis of a body of revolution.
    pub radius: Option<f64>,
}

impl Place {
    /// Shape functions there.
    pub fn shape<'b>(&self, block: &'b Block) -> &'b [f64] {
        block.points.shape(self.point)
    }
}

/// What the plane of cells stands for, and what the thickness is multiplied by at the nodes of one.
type Across<'a> = (Idealisation, &'a [f64]);

/// The cells of a body by their elements.
pub(super) fn blocks(
    name: &str,
    mesh: &Mesh,
    cells: &[CellId],
    ndim: usize,
    reduced: bool,
) -> Result<Vec<Block>, SolidError> {
    let mut blocks: Vec<(u32, Block)> = Vec::new();
    for &id in cells {
        let (Some(element), Some(label)) = (mesh.element(id), mesh.cell_label(id)) else {
            continue;
        };
        if element.dim() != ndim {
            return Err(SolidError::NotSolid {
                body: name.to_owned(),
                label,
                element: element.name(),
                ndim,
            });
        }
        let at = blocks.iter().position(|(number, _)| *number == id.block);
        let at = at.unwrap_or_else(|| {
            let rule = match reduced {
                true => element.reduced_rule(),
                false => element.full_rule(),
            };
            blocks.push((
                id.block,
                Block {
                    points: Points::new(element, rule),
                    mass: Points::new(element, element.rules().mass),
                    nnode: element.nnode(),
                    nodes: Vec::new(),
                    ids: Vec::new(),
                    labels: Vec::new(),
                    extrapolation: extrapolation(element, rule, AtNodes::Linear),
                },
            ));
            blocks.len() - 1
        });
        if let Some((_, block)) = blocks.get_mut(at) {
            block.nodes.extend_from_slice(mesh.cell(id));
            block.ids.push(id);
            block.labels.push(label);
        }
    }
    Ok(blocks.into_iter().map(|(_, block)| block).collect())
}

/// Block, first and last cell of each chunk.
pub(super) fn chunks(blocks: &[Block]) -> Vec<(usize, usize, usize)> {
    let of_block = |(number, block): (usize, &Block)| {
        let n = block.ids.len();
        let firsts = (0..n).step_by(CHUNK);
        firsts.map(move |first| (number, first, n.min(first + CHUNK)))
    };
    blocks.iter().enumerate().flat_map(of_block).collect()
}

/// The rows `∂x/∂ξ_a` of the map from the reference element, and where the point is.
fn map(points: &Points, point: usize, x: &[Vec3], space: Idealisation) -> (Mat3, Vec3) {
    let (mut jacobian, mut at) = (Mat3::ZERO, Vec3::ZERO);
    let of_nodes = points.shape(point).iter().zip(points.dshape(point));
    for (x, (n, d)) in x.iter().zip(of_nodes) {
        at += *x * *n;
        for (row, slope) in jacobian.rows.iter_mut().zip(d.to_array()) {
            *row += *x * slope;
        }
    }
    if space.ndim() == 2 {
        jacobian.rows[2] = Vec3::unit(2);
    }
    (jacobian, at)
}

/// The volume of a point with this weight.
fn volume(points: &Points, point: usize, det: f64, at: Vec3, (space, profile): Across<'_>) -> f64 {
    let weight = points.rule.weights.get(point).copied().unwrap_or_default();
    weight * det * space.extent(at) * profile_at(profile, points.shape(point))
}

impl Block {
    pub const fn npoint(&self) -> usize {
        self.points.rule.npoint()
    }

    /// The rule of conduction.
    pub const fn rule(&self) -> &'static Rule {
        self.points.rule
    }

    pub const fn nmass(&self) -> usize {
        self.mass.rule.npoint()
    }

    pub fn nodes(&self) -> impl Iterator<Item = &NodeId> {
        self.nodes.iter()
    }

    pub fn nodes_of(&self, cell: usize) -> &[NodeId] {
        let of_cell = cell * self.nnode..(cell + 1) * self.nnode;
        self.nodes.get(of_cell).unwrap_or_default()
    }

    pub fn id(&self, cell: usize) -> Option<CellId> {
        self.ids.get(cell).copied()
    }

    pub fn cells(&self) -> impl Iterator<Item = (CellId, &[NodeId])> {
        let nodes = self.nodes.chunks_exact(self.nnode.max(1));
        self.ids.iter().copied().zip(nodes)
    }

    /// The number of a cell in the input.
    pub fn label(&self, cell: usize) -> u64 {
        self.labels.get(cell).copied().unwrap_or_default()
    }

    /// A point of a cell whose nodes are at `x`, with the gradients of the shape functions there; the determinant of its map
    /// where that has no positive one.
    pub fn place(
        &self,
        point: usize,
        x: &[Vec3],
        across: Across<'_>,
        gradient: &mut Vec<Vec3>,
    ) -> Result<Place, f64> {
        let (jacobian, at) = map(&self.points, point, x, across.0);
        let (inverse, det) = positive(jacobian)?;
        gradient.clear();
        let dshape = self.points.dshape(point).iter();
        gradient.extend(dshape.map(|d| inverse * *d));
        Ok(Place {
            point,
            weight: volume(&self.points, point, det, at, across),
            radius: (across.0 == Idealisation::Axisymmetric).then_some(at.x),
        })
    }

    /// Volume and shape functions of a point of the rule of the mass.
    pub fn mass_point(
        &self,
        point: usize,
        x: &[Vec3],
        across: Across<'_>,
    ) -> Result<(f64, &[f64]), f64> {
        let (jacobian, at) = map(&self.mass, point, x, across.0);
        let (_, det) = positive(jacobian)?;
        let weight = volume(&self.mass, point, det, at, across);
        Ok((weight, self.mass.shape(point)))
    }

    /// `∫ max_k |∇N_k|² dV` over a cell: the largest entry of its conduction over the conductivity, about.
    pub fn rigidity(&self, x: &[Vec3], (space, _): Across<'_>) -> f64 {
        self.points.stretch(x, space)
    }

    /// Takes vectors at the points of a cell into the means of its nodes.
    pub fn carry_to_nodes(&self, cell: usize, values: &[Vec3], frame: &mut Frame) {
        let rows = self.extrapolation.chunks_exact(values.len().max(1));
        for (&node, weights) in self.nodes_of(cell).iter().zip(rows) {
            let node = node as usize;
            let to = frame.heat_flux.get_mut(node);
            let Some((to, count)) = to.zip(frame.heat_weight.get_mut(node)) else {
                continue;
            };
            *count += 1.0;
            let value: Vec3 = values.iter().zip(weights).map(|(v, w)| *v * *w).sum();
            *to += (value - *to) * count.recip();
        }
    }
}

fn positive(jacobian: Mat3) -> Result<(Mat3, f64), f64> {
    let inverse = jacobian.inverse().filter(|(_, det)| *det > 0.0);
    inverse.ok_or_else(|| jacobian.determinant())
}
