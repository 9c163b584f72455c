//! Constitutive laws: strain in, stress, tangent and energy out.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | ε, E | `strain` | [`Sym3`](signorini_geometry::tensor::Sym3): linearized, or Green–Lagrange `½(FᵀF − I)` |
//! | σ, S | `stress` | [`Sym3`](signorini_geometry::tensor::Sym3): Cauchy at small strain, second Piola–Kirchhoff at finite strain |
//! | C_ijkl = ∂S_ij/∂E_kl | `tangent` | 6 × 6 over [`Sym3::PAIRS`](signorini_geometry::tensor::Sym3::PAIRS); multiplies strains with doubled shears |
//! | W | `energy` | per volume of the reference |
//! | λ, μ | [`Lame`] | λ = Eν/((1+ν)(1−2ν)), μ = E/(2(1+ν)) (E1) |
//!
//! A law is made of constants ([`TABLE`]), of a hardening ([`Plasticity`]), or of a law inside:
//!
//! ```text
//! Reduced( Expanding( Oriented( law ) ) )
//! ```
//!
//! from the outside in: stress-free directions, thermal expansion, turned axes.
//!
//! How a material conducts and stores heat stands next to its law: [`Conductor`].
//!
//! A law knows no degree of freedom. To add one: one file that implements [`Material`], one line in [`TABLE`] and the
//! constants it needs in `Constants::sample`; the property tests of this room run over the table.

mod anisotropic;
mod by_temperature;
mod ciarlet;
mod conductor;
mod constants;
mod definition;
pub(crate) mod dense;
mod expanding;
mod frame;
mod hardening;
mod hyperfoam;
mod keys;
mod logarithmic;
mod neo_hookean;
mod ogden;
mod oriented;
mod orthotropic;
mod plasticity;
mod principal;
mod ramberg_osgood;
mod reduced;
mod rotated_linear;
mod saint_venant_kirchhoff;
mod stretches;
#[cfg(test)]
mod tests;
mod undeformed;
mod unilateral;

pub use anisotropic::Anisotropic;
pub use by_temperature::ByTemperature;
pub use ciarlet::Ciarlet;
pub(crate) use conductor::pulled_back;
pub use conductor::{Conductor, ConductorError};
pub use constants::{Constants, ConstantsError};
pub(crate) use definition::undeformed_tangent;
pub use definition::{
    Kinematics, Lame, Linearity, Material, MaterialError, Order, Response, Strain,
};
pub use expanding::Expanding;
pub use hardening::{Hardening, HardeningError, HardeningKind};
pub use hyperfoam::Hyperfoam;
pub use neo_hookean::NeoHookean;
pub use ogden::Ogden;
pub use oriented::Oriented;
pub use orthotropic::Orthotropic;
pub use plasticity::Plasticity;
pub use ramberg_osgood::RambergOsgood;
pub use reduced::Reduced;
pub use rotated_linear::RotatedLinear;
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;
pub use undeformed::Undeformed;
pub use unilateral::Unilateral;

use signorini_vocabulary::{Description, Key};

/// A law of the table.
pub struct Law {
    /// Its name in a case.
    pub name: &'static str,
    /// What it is, in one line.
    pub doc: &'static str,
    /// The keys of the constants it needs.
    pub constants: &'static [Key],
    /// Makes it.
    pub make: fn(&Constants) -> Result<Box<dyn Material>, ConstantsError>,
}

/// Every law, by its name in a case. At finite strain `linear-elastic`, at one temperature or several, is the law of
/// Saint Venant and Kirchhoff: rotations are exact, strains should stay small.
pub static TABLE: [Law; 16] = [
    Law {
        name: "linear-elastic",
        doc: "isotropic and linear; of Saint Venant and Kirchhoff at finite strain",
        constants: &[keys::YOUNG, keys::POISSONS_RATIO],
        make: |c| {
            let (e, nu) = c.isotropic()?;
            Ok(Box::new(SaintVenantKirchhoff::new(e, nu)))
        },
    },
    Law {
        name: "saint-venant-kirchhoff",
        doc: "isotropic and linear between Green's strain and the second stress of Piola and Kirchhoff",
        constants: &[keys::YOUNG, keys::POISSONS_RATIO],
        make: |c| {
            let (e, nu) = c.isotropic()?;
            Ok(Box::new(SaintVenantKirchhoff::new(e, nu)))
        },
    },
    Law {
        name: "neo-hookean",
        doc: "isotropic rubber with one shear modulus, compressible",
        constants: &[keys::YOUNG, keys::POISSONS_RATIO],
        make: |c| {
            let (e, nu) = c.isotropic()?;
            Ok(Box::new(NeoHookean::new(e, nu)))
        },
    },
    Law {
        name: "mooney-rivlin",
        doc: "rubber by two invariants",
        constants: &[keys::C10, keys::C01, keys::BULK],
        make: |c| Ok(Box::new(Ogden::mooney_rivlin(c)?)),
    },
    Law {
        name: "mooney-rivlin-logarithmic",
        doc: "rubber by two invariants, its volume by a logarithm",
        constants: &[keys::C10, keys::C01, keys::BULK],
        make: |c| Ok(Box::new(Ogden::mooney_rivlin_logarithmic(c)?)),
    },
    Law {
        name: "ogden",
        doc: "rubber by powers of principal stretches",
        constants: &[keys::SHEAR_MODULI, keys::EXPONENTS, keys::BULK],
        make: |c| Ok(Box::new(Ogden::new(c)?)),
    },
    Law {
        name: "orthotropic",
        doc: "linear, with three axes of symmetry",
        constants: &[
            keys::E1,
            keys::E2,
            keys::E3,
            keys::NU12,
            keys::NU13,
            keys::NU23,
            keys::G12,
            keys::G13,
            keys::G23,
        ],
        make: |c| Ok(Box::new(Orthotropic::new(c)?)),
    },
    Law {
        name: "hyperfoam",
        doc: "foam by powers of principal stretches",
        constants: &[keys::SHEAR_MODULI, keys::EXPONENTS, keys::POISSONS_RATIO],
        make: |c| Ok(Box::new(Hyperfoam::new(c)?)),
    },
    Law {
        name: "anisotropic",
        doc: "linear, without symmetry",
        constants: &[keys::STIFFNESS],
        make: |c| Ok(Box::new(Anisotropic::new(c)?)),
    },
    Law {
        name: "linear-elastic-by-temperature",
        doc: "isotropic and linear, with constants that depend on the temperature",
        constants: &[keys::TEMPERATURES, keys::YOUNG, keys::POISSONS_RATIO],
        make: |c| Ok(Box::new(ByTemperature::new(c)?)),
    },
    Law {
        name: "rotated-linear",
        doc: "isotropic and linear between the stretch and the second stress of Piola and Kirchhoff",
        constants: &[keys::YOUNG, keys::POISSONS_RATIO],
        make: |c| {
            let (e, nu) = c.isotropic()?;
            Ok(Box::new(RotatedLinear::new(e, nu)))
        },
    },
    Law {
        name: "ciarlet",
        doc: "isotropic, for metals under large compression",
        constants: &[keys::YOUNG, keys::POISSONS_RATIO],
        make: |c| {
            let (e, nu) = c.isotropic()?;
            Ok(Box::new(Ciarlet::new(e, nu)))
        },
    },
    Law {
        name: "no-tension",
        doc: "compression alone along each principal axis, without contraction across",
        constants: &[keys::YOUNG, keys::RESIDUAL],
        make: |c| Ok(Box::new(Unilateral::no_tension(c)?)),
    },
    Law {
        name: "no-compression",
        doc: "tension alone along each principal axis, without contraction across",
        constants: &[keys::YOUNG, keys::RESIDUAL],
        make: |c| Ok(Box::new(Unilateral::no_compression(c)?)),
    },
    Law {
        name: "ramberg-osgood",
        doc: "plasticity by deformation theory, with a power of the stress; Kirchhoff's stress and logarithmic strain",
        constants: &[
            keys::YOUNG,
            keys::POISSONS_RATIO,
            keys::REFERENCE_STRESS,
            keys::EXPONENT,
            keys::OFFSET,
        ],
        make: |c| Ok(Box::new(RambergOsgood::logarithmic(c)?)),
    },
    Law {
        name: "ramberg-osgood-eulerian",
        doc: "the same with Cauchy's stress and the strain of Almansi, as in CalculiX",
        constants: &[
            keys::YOUNG,
            keys::POISSONS_RATIO,
            keys::REFERENCE_STRESS,
            keys::EXPONENT,
            keys::OFFSET,
        ],
        make: |c| Ok(Box::new(RambergOsgood::eulerian(c)?)),
    },
];

/// The law of this name.
///
/// # Example
/// ```
/// use signorini_mechanics::material::{Constants, by_name};
///
/// let law = by_name("linear-elastic").ok_or("not in the table")?;
/// let steel = (law.make)(&Constants::elastic(210e3, 0.3))?;
/// // λ + 2μ = E (1 − ν)/((1 + ν)(1 − 2ν))
/// let modulus = 210e3 * 0.7 / (1.3 * 0.4);
/// assert!((steel.modulus() / modulus - 1.0).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Law> {
    TABLE.iter().find(|law| law.name == name)
}

/// The names and constants of all laws.
#[must_use]
pub fn descriptions() -> Vec<Description> {
    let described = TABLE.iter();
    let described = described.map(|law| Description::new(law.name, law.doc, law.constants));
    described.collect()
}
