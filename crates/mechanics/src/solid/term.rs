use super::kernel::{Element, Failure, Kernel, Output, Points, kernel};
use super::{Integration, Locking};
use crate::material::{Kinematics, Material, Order as MaterialOrder};
use crate::system::{
    Dof, Frame, Idealisation, Layout, NodalField, Order, Part, PatternSink, Sink, State,
    StepContext, Symmetry, Term, TermError, Work,
};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::{Sym3, Vec3};
use std::sync::Arc;
use thiserror::Error;

/// Cells evaluated together: enough to be worth a task, few enough to stay in cache.
const CHUNK: usize = 64;

/// The cells of one material.
pub struct Solid {
    name: String,
    layout: Layout,
    reference: Arc<[Vec3]>,
    material: Box<dyn Material>,
    kinematics: Kinematics,
    space: Idealisation,
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
}

/// Cells of one element.
struct Cells {
    points: Points,
    kernel: Kernel,
    nnode: usize,
    nodes: Vec<NodeId>,
    labels: Vec<u64>,
    // where they are in the mesh
    ids: Vec<CellId>,
    // from quadrature points to nodes: `nnode` rows of `npoint`
    extrapolation: Vec<f64>,
}

/// Why a body cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
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
}

/// Scratch of one thread.
#[derive(Default)]
struct Scratch {
    x: Vec<Vec3>,
    u: Vec<f64>,
    dofs: Vec<Dof>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
    stress: Vec<Sym3>,
    volume: Vec<f64>,
}

impl Solid {
    /// The body made of these parts.
    ///
    /// # Errors
    /// A cell that is no solid of the problem's dimension.
    pub fn new(parts: SolidParts<'_>) -> Result<Self, SolidError> {
        let SolidParts {
            name,
            mesh,
            reference,
            cells,
            layout,
            space,
            material,
            ..
        } = parts;
        let mut blocks: Vec<(u32, Cells)> = Vec::new();
        for &id in cells {
            let (Some(element), Some(label)) = (mesh.element(id), mesh.cell_label(id)) else {
                continue;
            };
            let refused = || SolidError::NotSolid {
                body: name.to_string(),
                label,
                element: element.name(),
                ndim: layout.ndim,
            };
            let found = blocks.iter().position(|(b, _)| *b == id.block);
            let at = match found {
                Some(at) => at,
                None => {
                    let of_space = kernel(element.name()).filter(|_| element.dim() == layout.ndim);
                    let points = Points::new(element, element.full_rule());
                    let cells = Cells {
                        extrapolation: extrapolation(element, points.rule),
                        points,
                        kernel: of_space.ok_or_else(refused)?,
                        nnode: element.nnode(),
                        nodes: Vec::new(),
                        labels: Vec::new(),
                        ids: Vec::new(),
                    };
                    blocks.push((id.block, cells));
                    blocks.len() - 1
                }
            };
            let of_block = &mut blocks[at].1;
            of_block.nodes.extend_from_slice(mesh.cell(id));
            of_block.labels.push(label);
            of_block.ids.push(id);
        }
        let blocks: Vec<Cells> = blocks.into_iter().map(|(_, c)| c).collect();
        let mut chunks = Vec::new();
        for (number, block) in blocks.iter().enumerate() {
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
            kinematics: Kinematics::Finite,
            space,
            blocks,
            chunks,
        })
    }

    /// Which strains it uses; steps change it.
    pub fn set_kinematics(&mut self, kinematics: Kinematics) {
        self.kinematics = kinematics;
    }

    /// Runs the kernel over the cells of a chunk and hands each result to `take`.
    fn each(
        &self,
        chunk: usize,
        trial: &State,
        order: MaterialOrder,
        with_stress: bool,
        scratch: &mut Scratch,
        mut take: impl FnMut(&Cells, usize, f64, &Scratch),
    ) -> Result<(), TermError> {
        let Some(&(block, first, last)) = self.chunks.get(chunk) else {
            return Ok(());
        };
        let block = &self.blocks[block];
        let ndim = self.layout.ndim;
        let n = block.nnode * ndim;
        let npoint = block.points.rule.npoint();
        scratch.force.resize(n, 0.0);
        let wanted = order == MaterialOrder::Tangent && !with_stress;
        scratch
            .stiffness
            .resize(if wanted { n * n } else { 0 }, 0.0);
        scratch.stress.resize(npoint, Sym3::ZERO);
        scratch.volume.resize(npoint, 0.0);
        for cell in first..last {
            let nodes = &block.nodes[cell * block.nnode..(cell + 1) * block.nnode];
            scratch.x.clear();
            scratch.u.clear();
            scratch.dofs.clear();
            for &node in nodes {
                scratch.x.push(self.reference[node as usize]);
                for axis in 0..ndim {
                    let dof = self.layout.node(node, axis);
                    scratch.dofs.push(dof);
                    scratch.u.push(trial.u[dof as usize]);
                }
            }
            let element = Element {
                reference: &block.points,
                x: &scratch.x,
                u: &scratch.u,
                material: self.material.as_ref(),
                kinematics: self.kinematics,
                thickness: self.space.extent(Vec3::ZERO),
            };
            let mut out = Output {
                force: &mut scratch.force,
                stiffness: &mut scratch.stiffness,
                energy: 0.0,
                stress: with_stress.then_some(&mut scratch.stress[..]),
                volume: &mut scratch.volume,
            };
            let outcome = (block.kernel)(&element, order, &mut out);
            let energy = out.energy;
            match outcome {
                Ok(()) => {}
                Err(Failure::Inverted { ratio }) => {
                    return Err(TermError::Inverted {
                        body: self.name.clone(),
                        element: block.labels[cell],
                        ratio,
                    });
                }
                Err(Failure::Material(error)) => {
                    return Err(TermError::Material {
                        body: self.name.clone(),
                        element: block.labels[cell],
                        message: error.to_string(),
                    });
                }
            }
            if !energy.is_finite() || !scratch.force.iter().all(|f| f.is_finite()) {
                return Err(TermError::NotFinite {
                    what: format!(
                        "the force of element {} of body \"{}\"",
                        block.labels[cell], self.name
                    ),
                });
            }
            take(block, cell, energy, scratch);
        }
        Ok(())
    }
}

/// The matrix that carries values at quadrature points to the nodes: exact for fields the element can represent where
/// there are enough points, the mean elsewhere.
fn extrapolation(
    element: &dyn signorini_geometry::element::ReferenceElement,
    rule: &signorini_geometry::element::quadrature::Rule,
) -> Vec<f64> {
    let (n, m) = (element.nnode(), rule.npoint());
    let mean = vec![1.0 / m as f64; n * m];
    if n != m {
        return mean;
    }
    // invert N_i(ξ_p), row p, by Gauss–Jordan with pivoting
    let mut a = vec![0.0; n * 2 * n];
    let mut shape = vec![0.0; n];
    for (p, xi) in rule.points.iter().enumerate() {
        element.shape(xi, &mut shape);
        a[p * 2 * n..p * 2 * n + n].copy_from_slice(&shape);
        a[p * 2 * n + n + p] = 1.0;
    }
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| {
            let size = |r: usize| a[r * 2 * n + k].abs();
            size(i).total_cmp(&size(j))
        });
        let Some(pivot) = pivot.filter(|&p| a[p * 2 * n + k].abs() > 1e-10) else {
            return mean;
        };
        for c in 0..2 * n {
            a.swap(k * 2 * n + c, pivot * 2 * n + c);
        }
        let scale = a[k * 2 * n + k].recip();
        a[k * 2 * n..(k + 1) * 2 * n]
            .iter_mut()
            .for_each(|v| *v *= scale);
        for row in (0..n).filter(|&r| r != k) {
            let factor = a[row * 2 * n + k];
            for c in 0..2 * n {
                a[row * 2 * n + c] -= factor * a[k * 2 * n + c];
            }
        }
    }
    (0..n)
        .flat_map(|i| a[i * 2 * n + n..(i + 1) * 2 * n].to_vec())
        .collect()
}

impl Term for Solid {
    fn name(&self) -> &str {
        &self.name
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for block in &self.blocks {
            for cell in block.nodes.chunks_exact(block.nnode) {
                out.bulk(cell);
            }
        }
    }

    fn symmetry(&self) -> Symmetry {
        Symmetry::Definite
    }

    fn part(&self) -> Part {
        Part::Bulk
    }

    fn begin_step(&mut self, step: &StepContext, _: &State) -> Result<(), TermError> {
        self.kinematics = if step.nonlinear {
            Kinematics::Finite
        } else {
            Kinematics::Small
        };
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
        let scratch = work.of::<Scratch>();
        let order = match order {
            Order::Residual => MaterialOrder::Stress,
            Order::Tangent => MaterialOrder::Tangent,
        };
        self.each(chunk, trial, order, false, scratch, |_, _, _, s| {
            out.add(&s.dofs, &s.force, &s.stiffness);
        })
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
        let mut total = 0.0;
        let scratch = work.of::<Scratch>();
        self.each(
            chunk,
            trial,
            MaterialOrder::Stress,
            false,
            scratch,
            |_, _, e, _| {
                total += e;
            },
        )?;
        Ok(Some(total))
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        let mut scratch = Scratch::default();
        for chunk in 0..self.chunks.len() {
            let order = MaterialOrder::Stress;
            self.each(
                chunk,
                state,
                order,
                true,
                &mut scratch,
                |block, cell, _, s| {
                    let volume: f64 = s.volume.iter().sum();
                    let mean = s
                        .stress
                        .iter()
                        .zip(&s.volume)
                        .fold(Sym3::ZERO, |sum, (t, v)| sum + *t * (v / volume));
                    let id = block.ids[cell];
                    let cells = frame.cell_stress.get_mut(id.block as usize);
                    if let Some(to) = cells.and_then(|c| c.get_mut(id.index as usize)) {
                        *to = mean;
                    }
                    let npoint = s.stress.len();
                    let nodes = &block.nodes[cell * block.nnode..(cell + 1) * block.nnode];
                    for (&node, weights) in
                        nodes.iter().zip(block.extrapolation.chunks_exact(npoint))
                    {
                        let value = weights
                            .iter()
                            .zip(&s.stress)
                            .fold(Sym3::ZERO, |sum, (w, t)| sum + *t * *w);
                        let node = node as usize;
                        if let (Some(to), Some(weight)) = (
                            frame.stress.get_mut(node),
                            frame.stress_weight.get_mut(node),
                        ) {
                            // running mean
                            *weight += 1.0;
                            *to = *to + (value - *to) * weight.recip();
                        }
                    }
                },
            )?;
        }
        Ok(())
    }
}
