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
mod element;
mod gradient;
mod lanes;
mod modes;
mod plain;
mod predicted;
mod secant;
mod shear;
mod shell;
mod stiffness;
mod viscous;

pub(super) use batch::{Batch, BatchKernel, Results};
pub(super) use element::{Element, Failure, Initial, Output, Points, Sample};
pub(super) use lanes::width;
pub(super) use shell::NMODE;
pub(super) use stiffness::mirror;

use crate::material::dense;
use crate::material::{Kinematics, MaterialError, Order, Response, Strain};
use crate::system::Idealisation;
use signorini_geometry::element::ReferenceElement;
use signorini_geometry::tensor::{Mat3, Sym3};

/// What the kernel of one element type computes.
pub(super) type Kernel = fn(&Element<'_>, Order, &mut Output<'_>) -> Result<(), Failure>;

/// What is done against locking, as the kernels know it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Remedy {
    None,
    Dilatation,
    Modes,
    Shear,
    Shell,
}

/// The kernels of elements with so many nodes: without remedy, with a projected dilatation, with incompatible modes, with the shear strain
/// of the centre.
struct Kernels {
    nnode: usize,
    plain: Kernel,
    /// The same between the ends of an increment where energy is conserved.
    secant: Kernel,
    /// What a stress over the rate of strain does at finite strain, without a remedy and with a projected dilatation.
    viscous: [Kernel; 2],
    /// The plain one for several cells at once.
    batch: Option<BatchKernel>,
    dilatation: Option<Kernel>,
    modes: Option<Kernel>,
    shear: Option<Kernel>,
}

const fn kernels<const NN: usize, const ND: usize, const NG: usize>() -> Kernels {
    Kernels {
        nnode: NN,
        plain: plain::respond::<NN, ND, NG>,
        secant: secant::respond::<NN, ND, NG>,
        viscous: [
            viscous::plain::<NN, ND, NG>,
            viscous::dilatation::<NN, ND, NG>,
        ],
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
        secant: secant::respond::<NN, ND, NG>,
        viscous: [viscous::plain::<NN, ND, NG>; 2],
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

/// The kernel of an element without remedy between the ends of an increment where energy is conserved.
pub(super) fn secant_kernel(
    element: &dyn ReferenceElement,
    space: Idealisation,
    remedy: Remedy,
) -> Option<Kernel> {
    let found = kernels_of(element, space).filter(|_| remedy == Remedy::None)?;
    Some(found.secant)
}

/// The kernel of a stress over the rate of strain at finite strain; `None` where there is none.
pub(super) fn viscous_kernel(
    element: &dyn ReferenceElement,
    space: Idealisation,
    remedy: Remedy,
) -> Option<Kernel> {
    let [plain, dilatation] = kernels_of(element, space)?.viscous;
    match remedy {
        Remedy::None => Some(plain),
        Remedy::Dilatation => Some(dilatation),
        Remedy::Modes | Remedy::Shear | Remedy::Shell => None,
    }
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
        Remedy::Shell => {
            (found.nnode == 8 && space == Idealisation::Space).then_some(shell::respond)
        }
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
            axes: at_point(self.axes, point),
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

/// The axes at a point among those of its cell.
pub(super) fn at_point(of_cell: &[Mat3], point: usize) -> Option<&Mat3> {
    of_cell.get(point).or_else(|| of_cell.first())
}
