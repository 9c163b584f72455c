//! What a constitutive law is: strain in; stress, tangent and energy out.

use signorini_geometry::tensor::{Mat3, Sym3};
use std::sync::Arc;
use thiserror::Error;

/// How far a response is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// Energy and stress.
    Stress,
    /// Energy, stress and tangent.
    Tangent,
}

/// How large strains may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// Linearized strain, Cauchy stress.
    Small,
    /// Green–Lagrange strain, second Piola–Kirchhoff stress.
    Finite,
}

/// The strain at a point.
#[derive(Clone, Copy, Debug)]
pub struct Strain<'a> {
    /// Which measure it is.
    pub kinematics: Kinematics,
    /// Its value, tensor components.
    pub value: Sym3,
    /// The temperature; laws without thermal expansion ignore it.
    pub temperature: f64,
    /// The temperature there at the start of the run.
    pub temperature_at_start: f64,
    /// The axes of the material at the point, row by row, orthonormal; none: those of the frame. Laws without directions
    /// ignore them.
    pub axes: Option<&'a Mat3>,
}

impl Strain<'_> {
    /// A strain at temperature zero.
    #[must_use]
    pub const fn new(kinematics: Kinematics, value: Sym3) -> Self {
        Self {
            kinematics,
            value,
            temperature: 0.0,
            temperature_at_start: 0.0,
            axes: None,
        }
    }
}

/// What a material answers.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// Conjugate to the strain measure.
    pub stress: Sym3,
    /// Derivative of the stress; valid for [`Order::Tangent`].
    pub tangent: [[f64; 6]; 6],
    /// The potential of the stress over the increment, per volume of the reference: its derivative with respect to
    /// the strain, at fixed old history, is the stress. For elastic laws the stored energy; with plasticity the stored
    /// and the dissipated energy.
    pub energy: f64,
    /// The strain zz that a law with stress-free directions found; the others leave it alone.
    pub across: f64,
    /// Derivative of the stress with respect to temperature at constant strain; valid for [`Order::Tangent`]. Laws that do not
    /// depend on temperature leave it alone.
    pub thermal: Sym3,
}

impl Default for Response {
    fn default() -> Self {
        Self {
            stress: Sym3::ZERO,
            tangent: [[0.0; 6]; 6],
            energy: 0.0,
            across: 0.0,
            thermal: Sym3::ZERO,
        }
    }
}

/// Why a material has no answer.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MaterialError {
    /// The volume ratio is not positive.
    #[error("the material is turned inside out (volume ratio {ratio:.3e})")]
    Inverted {
        /// Determinant of the deformation gradient.
        ratio: f64,
    },
    /// A temperature at which nothing is left of a length.
    #[error("its temperature would shrink the material to {stretch:.3e} of its length")]
    Shrunk {
        /// The thermal stretch.
        stretch: f64,
    },
    /// A strain of what conducts heat alone.
    #[error("the material conducts heat alone: it has no law for what deforms")]
    Undeformable,
    /// An iteration at a point did not converge.
    #[error("the material finds no {what} at this strain")]
    NotConverged {
        /// What was looked for.
        what: &'static str,
    },
}

/// Whether a law is linear, and how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Linearity {
    /// The tangent depends on the strain.
    None,
    /// Small strains have the same tangent everywhere: their stress is linear, but for a constant.
    SmallStrain,
    /// The law is `λ tr(ε) I + 2μ ε` at every strain and temperature, and nothing else.
    Isotropic(Lame),
}

impl Linearity {
    /// Whether small strains have the same tangent everywhere.
    #[must_use]
    pub fn is_linear(self) -> bool {
        self != Self::None
    }

    /// Lamé's constants of a law that is nothing else.
    #[must_use]
    pub const fn lame(self) -> Option<Lame> {
        match self {
            Self::Isotropic(lame) => Some(lame),
            Self::None | Self::SmallStrain => None,
        }
    }

    /// That of a law around this one, which does more to strains.
    #[must_use]
    pub const fn within(self) -> Self {
        match self {
            Self::None => Self::None,
            Self::SmallStrain | Self::Isotropic(_) => Self::SmallStrain,
        }
    }
}

/// A constitutive law with its constants.
///
/// # Example
/// ```
/// use signorini_geometry::tensor::{Mat3, Sym3};
/// use signorini_mechanics::material::{Kinematics, Material, Order, Response, SaintVenantKirchhoff, Strain};
///
/// // uniaxial strain: σ = (λ + 2μ) ε, which is the modulus
/// let steel = SaintVenantKirchhoff::new(210e3, 0.3);
/// let strain = Strain::new(Kinematics::Small, Sym3::diagonal(1e-3, 0.0, 0.0));
/// let mut response = Response::default();
/// steel.respond(&strain, &[], &mut [], Order::Tangent, &mut response)?;
/// assert!((response.stress.xx() - steel.modulus() * 1e-3).abs() < 1e-9);
/// assert!((response.tangent[0][0] - steel.modulus()).abs() < 1e-9);
/// # Ok::<(), signorini_mechanics::material::MaterialError>(())
/// ```
pub trait Material: Send + Sync {
    /// Numbers of history at a point.
    fn nhistory(&self) -> usize {
        0
    }

    /// The history of the undeformed material, into `nhistory` numbers that are zero.
    fn start(&self, _history: &mut [f64]) {}

    /// Stress, energy and, if wanted, the tangent at a strain. `old` and `new` are the history, `nhistory` each.
    ///
    /// # Errors
    /// A strain at which the law is not defined.
    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError>;

    /// The stiffness against uniaxial strain of the undeformed material, λ + 2μ: what automatic penalties scale with.
    fn modulus(&self) -> f64;

    /// The smallest stiffness against shear of the undeformed material: μ where it is isotropic. `None` where it has none,
    /// or no answer there.
    fn shear_modulus(&self) -> Option<f64> {
        let c = undeformed_tangent(self, Kinematics::Small)?;
        let shear = (3..6).map(|i| c[i][i]).filter(|&g| g > 0.0);
        shear.reduce(f64::min)
    }

    /// Whether the tangent is symmetric.
    fn is_symmetric(&self) -> bool {
        true
    }

    /// Whether stress and energy depend on the strain alone, whatever the history: its numbers are then for results, or where an
    /// iteration starts.
    fn is_elastic(&self) -> bool {
        self.nhistory() == 0
    }

    /// Whether it is linear, and how far.
    fn linearity(&self) -> Linearity {
        Linearity::None
    }

    /// The part of a strain that the law answers with stress: all of it, but for thermal expansion.
    fn mechanical_strain(&self, strain: &Strain) -> Sym3 {
        strain.value
    }

    /// The equivalent plastic strain in a history, where the law has one.
    fn plastic_strain(&self, _history: &[f64]) -> Option<f64> {
        None
    }
}

/// A law that others share.
impl Material for Arc<dyn Material> {
    fn nhistory(&self) -> usize {
        (**self).nhistory()
    }

    fn start(&self, history: &mut [f64]) {
        (**self).start(history);
    }

    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        (**self).respond(strain, old, new, order, out)
    }

    fn modulus(&self) -> f64 {
        (**self).modulus()
    }

    fn is_symmetric(&self) -> bool {
        (**self).is_symmetric()
    }

    fn is_elastic(&self) -> bool {
        (**self).is_elastic()
    }

    fn linearity(&self) -> Linearity {
        (**self).linearity()
    }

    fn mechanical_strain(&self, strain: &Strain) -> Sym3 {
        (**self).mechanical_strain(strain)
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        (**self).plastic_strain(history)
    }
}

/// The tangent of the undeformed material at temperature zero; `None` where it has no answer there.
pub(crate) fn undeformed_tangent<M: Material + ?Sized>(
    material: &M,
    kinematics: Kinematics,
) -> Option<[[f64; 6]; 6]> {
    let mut start = vec![0.0; material.nhistory()];
    material.start(&mut start);
    let mut new = start.clone();
    let mut response = Response::default();
    let strain = Strain::new(kinematics, Sym3::ZERO);
    let outcome = material.respond(&strain, &start, &mut new, Order::Tangent, &mut response);
    outcome.ok().map(|()| response.tangent)
}

/// Lamé's constants.
///
/// # Example
/// ```
/// use signorini_mechanics::material::Lame;
///
/// let lame = Lame::new(2.5, 0.25);
/// assert_eq!((lame.lambda, lame.mu), (1.0, 1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lame {
    /// First constant.
    pub lambda: f64,
    /// Shear modulus.
    pub mu: f64,
}

impl Lame {
    /// From Young's modulus `e > 0` and Poisson's ratio `−1 < nu < ½` (E1).
    #[must_use]
    pub fn new(e: f64, nu: f64) -> Self {
        Self {
            lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            mu: e / (2.0 * (1.0 + nu)),
        }
    }

    /// The isotropic linear law `λ tr(ε) I + 2μ ε`.
    pub(super) fn respond(&self, strain: &Sym3, order: Order, out: &mut Response) {
        let trace = strain.trace();
        let mean = self.lambda * trace;
        out.stress = Sym3::diagonal(mean, mean, mean) + *strain * (2.0 * self.mu);
        out.energy = 0.5 * out.stress.double_dot(*strain);
        if order == Order::Tangent {
            out.tangent = self.tangent();
        }
    }

    pub(super) fn tangent(&self) -> [[f64; 6]; 6] {
        let mut c = [[0.0; 6]; 6];
        for i in 0..3 {
            c[i][..3].fill(self.lambda);
            c[i][i] += 2.0 * self.mu;
            c[i + 3][i + 3] = self.mu;
        }
        c
    }
}
