//! One element: forces, stiffness, energy, samples. Loop bounds are constants here and nowhere else.
//!
//! | constant | meaning |
//! |---|---|
//! | `NN` | nodes |
//! | `ND` | displacements of a node |
//! | `NG` | rows of the gradient: `ND`, and one more for the hoop `N_I/R` of axisymmetry |

#![allow(clippy::needless_range_loop)] // indices are those of tensors, and several arrays share them

mod batch;
mod dilatation;
mod gradient;
mod lanes;
mod modes;
mod plain;
mod shear;
mod stiffness;

pub(super) use batch::{Batch, BatchKernel, Results};
pub(super) use lanes::width;

use super::dense;
use crate::material::{Kinematics, Material, MaterialError, Order, Response, Strain};
use crate::system::Idealisation;
use signorini_geometry::element::ReferenceElement;
use signorini_geometry::element::quadrature::{self, Rule};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// What the kernel of one element type computes.
pub(super) type Kernel = fn(&Element<'_>, Order, &mut Output<'_>) -> Result<(), Failure>;

/// An element with its nodes.
pub(super) struct Element<'a> {
    pub reference: &'a Points,
    pub x: &'a [Vec3],
    pub u: &'a [f64],
    pub material: &'a dyn Material,
    pub kinematics: Kinematics,
    pub space: Idealisation,
    /// Temperatures of the nodes; empty where there are none.
    pub temperature: &'a [f64],
    /// What they were at the start of the run.
    pub temperature_at_start: &'a [f64],
    /// Terms of the polynomial onto which the dilatation is projected.
    pub ndilatation: usize,
    /// History at the start of the increment: of each point, then the incompatible modes.
    pub old: &'a [f64],
    /// What each point has at the start; empty where no point has anything.
    pub initial: &'a [Initial],
}

/// What a point has at the start.
#[derive(Clone, Copy, Default)]
pub(super) struct Initial {
    /// Stress without strain.
    pub stress: Sym3,
    /// Strain without stress.
    pub strain: Sym3,
}

/// Results of one element. Forces and stiffness are those of displacements, node by node.
pub(super) struct Output<'a> {
    pub force: &'a mut [f64],
    /// Row-major; empty where it is not wanted. Of a law that is symmetric the blocks `(I, J)` of nodes with `I ≤ J`.
    pub stiffness: &'a mut [f64],
    pub energy: f64,
    /// History at the end of the increment.
    pub new: &'a mut [f64],
    /// What is known at the quadrature points; empty where it is not wanted.
    pub samples: &'a mut [Sample],
    pub scratch: &'a mut Vec<f64>,
}

/// What is known at a quadrature point.
#[derive(Clone, Copy, Default)]
pub(super) struct Sample {
    /// Cauchy stress.
    pub stress: Sym3,
    /// Linearized, or logarithmic at finite strain.
    pub strain: Sym3,
    /// Where the material has one.
    pub plastic_strain: Option<f64>,
    /// Present volume that belongs to the point.
    pub volume: f64,
    /// The strain that the material sees: linearized, or of Green and Lagrange; with what it found across.
    pub seen: Sym3,
    /// What it was at.
    pub temperature: f64,
    /// What it was at at the start of the run.
    pub temperature_at_start: f64,
    /// Energy per volume at the start.
    pub energy: f64,
    /// That volume.
    pub volume_at_start: f64,
}

/// Why an element has no response.
pub(super) enum Failure {
    Inverted { ratio: f64 },
    Material(MaterialError),
}

impl From<MaterialError> for Failure {
    fn from(error: MaterialError) -> Self {
        match error {
            MaterialError::Inverted { ratio } => Self::Inverted { ratio },
            other => Self::Material(other),
        }
    }
}

/// Shape functions at the quadrature points of a reference element: the same for all its cells.
pub(super) struct Points {
    pub rule: &'static Rule,
    shape: Vec<f64>,
    dshape: Vec<Vec3>,
    /// What temperatures of nodes are multiplied with; empty where it is the shape functions.
    thermal: Vec<f64>,
    shape_at_centre: Vec<f64>,
    dshape_at_centre: Vec<Vec3>,
    nnode: usize,
}

impl Points {
    pub fn new(element: &dyn ReferenceElement, rule: &'static Rule) -> Self {
        let (nnode, npoint) = (element.nnode(), rule.npoint());
        let mut points = Self {
            rule,
            shape: vec![0.0; nnode * npoint],
            dshape: vec![Vec3::ZERO; nnode * npoint],
            thermal: Vec::new(),
            shape_at_centre: vec![0.0; nnode],
            dshape_at_centre: vec![Vec3::ZERO; nnode],
            nnode,
        };
        for (point, xi) in rule.points.iter().enumerate() {
            let at = point * nnode..(point + 1) * nnode;
            element.shape(xi, &mut points.shape[at.clone()]);
            element.dshape(xi, &mut points.dshape[at]);
        }
        let centre = element.centre();
        element.shape(&centre, &mut points.shape_at_centre);
        element.dshape(&centre, &mut points.dshape_at_centre);
        points
    }

    /// Makes temperatures linear where the rule has more points than a reduced one of two along each axis: with those points
    /// `q`, at `±1/√3`, the temperature at a point is `Σ_q Π_a ½ (1 + 3 ξ_a q_a) T(q)`.
    pub fn linear_temperatures(&mut self, element: &dyn ReferenceElement) {
        let reduced = element.reduced_rule();
        let two_along_axes = [&quadrature::QUAD_4, &quadrature::HEX_8];
        let is_known = two_along_axes
            .iter()
            .any(|rule| std::ptr::eq(*rule, reduced));
        if !is_known || reduced.npoint() >= self.rule.npoint() {
            return;
        }
        let mut shape = vec![0.0; self.nnode];
        self.thermal = vec![0.0; self.nnode * self.rule.npoint()];
        for q in reduced.points {
            element.shape(q, &mut shape);
            let rows = self.thermal.chunks_exact_mut(self.nnode);
            for (xi, row) in self.rule.points.iter().zip(rows) {
                let axes = 0..element.dim();
                let weight: f64 = axes.map(|a| 0.5 * (1.0 + 3.0 * xi[a] * q[a])).product();
                for (to, n) in row.iter_mut().zip(&shape) {
                    *to += weight * n;
                }
            }
        }
    }

    /// What temperatures of nodes are multiplied with at a point.
    fn thermal(&self, point: usize) -> &[f64] {
        let own = self
            .thermal
            .get(point * self.nnode..(point + 1) * self.nnode);
        own.unwrap_or_else(|| self.shape(point))
    }

    /// Shape functions at a point.
    pub fn shape(&self, point: usize) -> &[f64] {
        &self.shape[point * self.nnode..(point + 1) * self.nnode]
    }

    fn dshape(&self, point: usize) -> &[Vec3] {
        &self.dshape[point * self.nnode..(point + 1) * self.nnode]
    }

    /// `∫ max_i |N_i,X|² dV` over a cell whose nodes are at `x`; 0 where its map has no inverse.
    pub fn stretch(&self, x: &[Vec3], space: Idealisation) -> f64 {
        let weights = self.rule.weights.iter().enumerate();
        let at_point = weights.map(|(point, weight)| {
            let (mut jacobian, mut at) = (Mat3::ZERO, Vec3::ZERO);
            for ((x, n), d) in x.iter().zip(self.shape(point)).zip(self.dshape(point)) {
                at += *x * *n;
                for (row, slope) in jacobian.rows.iter_mut().zip(d.to_array()) {
                    *row += *x * slope;
                }
            }
            if space.ndim() == 2 {
                jacobian.rows[2] = Vec3::unit(2);
            }
            let Some((inverse, det)) = jacobian.inverse() else {
                return 0.0;
            };
            let slopes = self.dshape(point).iter().map(|d| (inverse * *d).norm());
            let steepest = slopes.fold(0.0, f64::max);
            steepest * steepest * weight * det.abs() * space.extent(at)
        });
        at_point.sum()
    }
}

/// What is done against locking, as the kernels know it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Remedy {
    None,
    Dilatation,
    Modes,
    Shear,
}

/// The kernels of elements with so many nodes: without remedy, with a projected dilatation, with incompatible modes, with the shear strain
/// of the centre.
struct Kernels {
    nnode: usize,
    plain: Kernel,
    /// The same for several cells at once.
    batch: Option<BatchKernel>,
    dilatation: Option<Kernel>,
    modes: Option<Kernel>,
    shear: Option<Kernel>,
}

const fn kernels<const NN: usize, const ND: usize, const NG: usize>() -> Kernels {
    Kernels {
        nnode: NN,
        plain: plain::respond::<NN, ND, NG>,
        batch: None,
        dilatation: Some(dilatation::respond::<NN, ND, NG>),
        modes: None,
        shear: None,
    }
}

/// A linear element that has no remedy: its dilatation is constant, or nearly so.
const fn bare<const NN: usize, const ND: usize, const NG: usize>() -> Kernels {
    Kernels {
        nnode: NN,
        plain: plain::respond::<NN, ND, NG>,
        batch: None,
        dilatation: None,
        modes: None,
        shear: None,
    }
}

/// An element with incompatible modes, `NT` functions in all.
const fn with_modes<const NN: usize, const NT: usize, const ND: usize, const NG: usize>() -> Kernels
{
    Kernels {
        modes: Some(modes::respond::<NN, NT, ND, NG>),
        ..kernels::<NN, ND, NG>()
    }
}

/// An element in space.
const fn in_space<const NN: usize>(kernels: Kernels) -> Kernels {
    Kernels {
        batch: Some(batch::respond::<NN>),
        ..kernels
    }
}

/// The quadrilateral of four nodes, which has all remedies.
const fn quad4<const NG: usize>() -> Kernels {
    Kernels {
        shear: Some(shear::respond::<4, 2, NG>),
        ..with_modes::<4, 6, 2, NG>()
    }
}

static PLANE: [Kernels; 5] = [
    bare::<3, 2, 2>(),
    quad4::<2>(),
    kernels::<6, 2, 2>(),
    kernels::<8, 2, 2>(),
    kernels::<9, 2, 2>(),
];

static AXISYMMETRIC: [Kernels; 5] = [
    bare::<3, 2, 3>(),
    quad4::<3>(),
    kernels::<6, 2, 3>(),
    kernels::<8, 2, 3>(),
    kernels::<9, 2, 3>(),
];

static SPACE: [Kernels; 7] = [
    in_space::<4>(bare::<4, 3, 3>()),
    in_space::<6>(bare::<6, 3, 3>()),
    in_space::<8>(with_modes::<8, 11, 3, 3>()),
    in_space::<10>(kernels::<10, 3, 3>()),
    in_space::<15>(kernels::<15, 3, 3>()),
    in_space::<20>(kernels::<20, 3, 3>()),
    in_space::<27>(kernels::<27, 3, 3>()),
];

fn kernels_of(element: &dyn ReferenceElement, space: Idealisation) -> Option<&'static Kernels> {
    let table: &[Kernels] = match space {
        Idealisation::Space => &SPACE,
        Idealisation::PlaneStrain { .. } | Idealisation::PlaneStress { .. } => &PLANE,
        Idealisation::Axisymmetric => &AXISYMMETRIC,
    };
    let suits = |k: &&Kernels| k.nnode == element.nnode() && space.ndim() == element.dim();
    table.iter().find(suits)
}

/// The kernel of an element for several cells at once, where there is one.
pub(super) fn batch_kernel(
    element: &dyn ReferenceElement,
    space: Idealisation,
    remedy: Remedy,
) -> Option<BatchKernel> {
    let found = kernels_of(element, space).filter(|_| remedy == Remedy::None)?;
    found.batch
}

/// The kernel of an element; `None` where there is none.
pub(super) fn kernel(
    element: &dyn ReferenceElement,
    space: Idealisation,
    remedy: Remedy,
) -> Option<Kernel> {
    let found = kernels_of(element, space)?;
    match remedy {
        Remedy::None => Some(found.plain),
        Remedy::Dilatation => found.dilatation,
        Remedy::Modes => found.modes,
        Remedy::Shear => found.shear,
    }
}

impl Element<'_> {
    fn is_finite(&self) -> bool {
        self.kinematics == Kinematics::Finite
    }

    fn npoint(&self) -> usize {
        self.reference.rule.npoint()
    }

    /// The temperature at a point, from those of the nodes.
    fn temperature(&self, point: usize, of_nodes: &[f64]) -> f64 {
        let shape = self.reference.thermal(point).iter();
        shape.zip(of_nodes).map(|(n, t)| n * t).sum()
    }

    /// The material's answer at a point to a strain.
    #[inline]
    fn respond(
        &self,
        point: usize,
        value: Sym3,
        order: Order,
        new: &mut [f64],
        response: &mut Response,
    ) -> Result<(), MaterialError> {
        let initial = self.initial.get(point);
        let strain = Strain {
            kinematics: self.kinematics,
            value: initial.map_or(value, |at| value - at.strain),
            temperature: self.temperature(point, self.temperature),
            temperature_at_start: self.temperature(point, self.temperature_at_start),
        };
        let nhistory = self.material.nhistory();
        let at = point * nhistory..(point + 1) * nhistory;
        let (old, new) = (&self.old[at.clone()], &mut new[at]);
        self.material.respond(&strain, old, new, order, response)?;
        if let Some(at) = initial {
            response.stress = response.stress + at.stress;
            response.energy += at.stress.double_dot(value);
        }
        Ok(())
    }

    /// What is known at a point where the deformation gradient that the material sees is `f = I + h`, and `weight`
    /// belongs to it at the start, `ratio` times that at present.
    fn sample(
        &self,
        point: usize,
        h: Mat3,
        [weight, ratio]: [f64; 2],
        new: &[f64],
        response: &Response,
    ) -> Sample {
        let nhistory = self.material.nhistory();
        let history = &new[point * nhistory..(point + 1) * nhistory];
        let sheet = matches!(self.space, Idealisation::PlaneStress { .. });
        let mut h = h;
        let mut volume = weight * ratio;
        if sheet {
            // the thickness follows from what was found across
            let strain = response.across;
            h.rows[2].z = if self.is_finite() {
                2.0 * strain / (1.0 + (1.0 + 2.0 * strain).max(0.0).sqrt())
            } else {
                strain
            };
            if self.is_finite() {
                volume *= 1.0 + h.rows[2].z;
            }
        }
        let (mut stress, mut strain) = (response.stress, Sym3::symmetric_part(h));
        let mut seen = strain;
        if self.is_finite() {
            seen = strain + Sym3::gram(h) * 0.5;
            let f = Mat3::IDENTITY + h;
            stress = stress.congruence(f) * f.determinant().recip(); // (E4)
            strain = dense::half_logarithm(strain + Sym3::gram(h.transpose()) * 0.5);
        }
        Sample {
            stress,
            strain,
            plastic_strain: self.material.plastic_strain(history),
            volume,
            seen,
            temperature: self.temperature(point, self.temperature),
            temperature_at_start: self.temperature(point, self.temperature_at_start),
            energy: response.energy,
            volume_at_start: weight,
        }
    }
}
