use super::kernel::Remedy;
use crate::material::{Kinematics, Material, undeformed_tangent};
use crate::system::Idealisation;
use signorini_geometry::element::quadrature::{Rule, through};
use signorini_geometry::element::{LockingClass, ReferenceElement};
use std::fmt;

/// How many quadrature points an element has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integration {
    /// As many as integrate the stiffness of the undistorted element exactly.
    #[default]
    Full,
    /// One order less, for quad8 and hex20, of masses too; elements of lower order keep the full rule.
    Reduced,
    /// One order more along the axis of wedge6: nine points; other elements keep the full rule.
    Raised,
    /// So many points through the thickness of a solid-shell, 2 to 9, at 2 × 2 places of its middle; other elements keep the
    /// full rule.
    Through(usize),
}

/// What is done against locking in bending and of nearly incompressible materials.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Locking {
    /// What suits the element, the idealisation and the size of strains.
    #[default]
    Auto,
    /// Nothing.
    None,
    /// The volumetric strain is projected onto a coarser field; small strain.
    BBar,
    /// The volume ratio is projected onto a coarser field, in variational form; finite strain.
    FBar,
    /// Incompatible modes, condensed; small strain only, for they are unstable in compression at finite strain.
    Incompatible,
    /// The shear strain of the centre at all points of quad4; small strain.
    Shear,
    /// The solid-shell, of directors.
    Shell,
}

impl fmt::Display for Locking {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Auto => "auto",
            Self::None => "none",
            Self::BBar => "b-bar",
            Self::FBar => "f-bar",
            Self::Incompatible => "incompatible",
            Self::Shear => "selective-shear",
            Self::Shell => "solid-shell",
        })
    }
}

impl Locking {
    pub(super) const fn remedy(self) -> Remedy {
        match self {
            Self::Auto | Self::None => Remedy::None,
            Self::BBar | Self::FBar => Remedy::Dilatation,
            Self::Incompatible => Remedy::Modes,
            Self::Shear => Remedy::Shear,
            Self::Shell => Remedy::Shell,
        }
    }
}

/// Poisson's ratio from which on a material counts as nearly incompressible.
const NEARLY_INCOMPRESSIBLE: f64 = 0.45;
/// What rounding may take from that ratio in the tangent that it is read from, relative.
const ROUNDING: f64 = 1e-12;

/// Whether a material resists a change of volume far more than a change of shape: nearly incompressible, or plastic,
/// as the plastic flow of metals keeps the volume.
pub(super) fn keeps_volume(material: &dyn Material, kinematics: Kinematics) -> bool {
    let mut start = vec![0.0; material.nhistory()];
    material.start(&mut start);
    if material.plastic_strain(&start).is_some() {
        return true;
    }
    let Some(c) = undeformed_tangent(material, kinematics) else {
        return false;
    };
    let bulk = (0..3).flat_map(|i| &c[i][..3]).sum::<f64>() / 9.0;
    let shear = (3..6).map(|i| c[i][i]).sum::<f64>() / 3.0;
    // ν = (3K − 2μ)/(2(3K + μ))
    let limit = NEARLY_INCOMPRESSIBLE * (1.0 - ROUNDING);
    3.0 * bulk - 2.0 * shear >= limit * 2.0 * (3.0 * bulk + shear)
}

/// What is chosen among.
#[derive(Clone, Copy)]
pub(super) struct Situation {
    pub element: &'static dyn ReferenceElement,
    pub space: Idealisation,
    pub integration: Integration,
    pub kinematics: Kinematics,
    /// See [`keeps_volume`].
    pub keeps_volume: bool,
}

impl Situation {
    fn is_simplest(&self) -> bool {
        self.element.locking_class() == LockingClass::ConstantStrain
    }

    fn takes_modes(&self) -> bool {
        self.element.locking_class() == LockingClass::Multilinear
    }

    fn takes_shear(&self) -> bool {
        self.takes_modes() && self.element.dim() == 2
    }

    fn takes_directors(&self) -> bool {
        self.takes_modes() && self.element.dim() == 3
    }

    fn is_sheet(&self) -> bool {
        matches!(self.space, Idealisation::PlaneStress { .. })
    }

    /// Whether fewer points already free the dilatation.
    fn is_reduced(&self) -> bool {
        let full = std::ptr::eq(self.element.full_rule(), self.element.reduced_rule());
        self.integration == Integration::Reduced && !full
    }

    /// What a wish becomes here.
    ///
    /// # Errors
    /// Why it cannot be had.
    pub fn choose(&self, wish: Locking) -> Result<Locking, &'static str> {
        let finite = self.kinematics == Kinematics::Finite;
        let reason = match wish {
            Locking::Auto => return Ok(self.suits()),
            Locking::None => return Ok(wish),
            Locking::BBar | Locking::FBar if self.is_sheet() => {
                "in plane stress the thickness yields: there is no volumetric locking"
            }
            Locking::BBar | Locking::FBar if self.is_simplest() => {
                "the volumetric strain of this element is constant already, or nearly so"
            }
            Locking::BBar | Locking::FBar if self.is_reduced() => {
                "reduced integration already frees the volumetric strain"
            }
            Locking::BBar if finite => "b-bar is for small strain; f-bar is its counterpart",
            Locking::FBar if !finite => "f-bar is for finite strain; b-bar is its counterpart",
            Locking::Incompatible if finite => {
                "incompatible modes become unstable in compression at finite strain"
            }
            Locking::Incompatible if !self.takes_modes() => {
                "incompatible modes exist for quad4 and hex8"
            }
            Locking::Shell if !self.takes_directors() => "the solid-shell exists for hex8 in space",
            Locking::Shear if finite => "the shear strain of the centre is for small strain",
            Locking::Shear if !self.takes_shear() => {
                "the shear strain of the centre exists for quad4"
            }
            _ => return Ok(wish),
        };
        Err(reason)
    }

    /// The table at the head of the room.
    fn suits(&self) -> Locking {
        let small = self.kinematics == Kinematics::Small;
        let frees = self.keeps_volume && !self.is_sheet();
        if self.is_simplest() || self.is_reduced() {
            Locking::None
        } else if frees && small {
            Locking::BBar
        } else if frees {
            Locking::FBar
        } else if self.takes_modes() && small {
            Locking::Incompatible
        } else {
            Locking::None
        }
    }

    /// The quadrature rule; more points than usual where fewer would leave motions free: at the axis of revolution,
    /// where the hoop is a strain of its own, and in tetrahedra whose dilatation counts only once.
    pub fn rule(&self, projected: bool) -> &'static Rule {
        let usual = if self.space == Idealisation::Axisymmetric {
            self.element.rules().revolved
        } else if projected {
            self.element.rules().dilatation
        } else {
            self.element.full_rule()
        };
        match self.integration {
            Integration::Reduced if self.is_reduced() => self.element.reduced_rule(),
            Integration::Raised => self.element.rules().raised.unwrap_or(usual),
            Integration::Through(npoint) if self.takes_directors() => through(npoint),
            Integration::Full | Integration::Reduced | Integration::Through(_) => usual,
        }
    }

    /// Terms of the polynomial onto which the dilatation is projected.
    pub fn ndilatation(&self) -> usize {
        match self.element.locking_class() {
            LockingClass::ConstantStrain | LockingClass::Multilinear => 1,
            LockingClass::HigherOrder { ndilatation } => ndilatation,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::SaintVenantKirchhoff;

    #[test]
    fn the_modulus_does_not_decide_whether_a_material_keeps_its_volume() {
        for k in 1..400 {
            let modulus = 0.0137 * f64::from(k * k);
            let keeps = |ratio| {
                let material = SaintVenantKirchhoff::new(modulus, ratio);
                keeps_volume(&material, Kinematics::Small)
            };
            assert!(keeps(NEARLY_INCOMPRESSIBLE), "{modulus}");
            assert!(!keeps(NEARLY_INCOMPRESSIBLE - 1e-9), "{modulus}");
        }
    }
}
