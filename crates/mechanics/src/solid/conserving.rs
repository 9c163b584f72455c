//! Bodies in motions that conserve energy.

use super::at::At;
use super::{Solid, SolidError, Truss};
use crate::material::Kinematics;
use signorini_geometry::tensor::Vec3;

impl Solid {
    /// Whether each of its elements has a form that conserves energy at this size of strains. Laws with a history have none, and
    /// need none: what they lose is not known.
    ///
    /// # Errors
    /// An element with a remedy against locking that has none.
    pub fn conserves_energy(&self, kinematics: Kinematics) -> Result<(), SolidError> {
        if !self.needs_secants(kinematics) {
            return Ok(());
        }
        let blocks = self.blocks.iter();
        let mut treated = blocks.map(|block| (block, block.treatment(kinematics)));
        match treated.find(|(_, treatment)| treatment.secant.is_none()) {
            Some((block, treatment)) => Err(SolidError::NotConserving {
                body: self.name.clone(),
                element: block.element,
                what: format!(
                    "with locking = \"{}\"",
                    treatment.locking.unwrap_or_default()
                ),
            }),
            None => Ok(()),
        }
    }

    /// Whether the stress at the mean place would not do the work of the energy: that of elastic laws, but for linear ones at small
    /// strain.
    fn needs_secants(&self, kinematics: Kinematics) -> bool {
        let material = self.material();
        let is_linear = kinematics == Kinematics::Small && material.linearity().is_linear();
        material.is_symmetric() && material.is_elastic() && !is_linear
    }

    /// Whether stresses between the ends of an increment are secants of the energy in the present step.
    pub(super) fn takes_secants(&self) -> bool {
        self.step.conserves() && self.needs_secants(self.kinematics)
    }

    /// The way of the nodes in the increment, where the stress is the secant of the energy over it.
    pub(super) fn secant_way<'a>(&self, at: At<'a>) -> Option<&'a [Vec3]> {
        at.way().filter(|_| self.takes_secants())
    }

    /// Whether the stiffness there is symmetric.
    pub(super) fn is_symmetric(&self, at: At<'_>) -> bool {
        self.material().is_symmetric() && self.secant_way(at).is_none() && !self.skews(at)
    }
}

impl Truss {
    /// Whether bars have a form that conserves energy in nonlinear steps: those whose strains are small.
    ///
    /// # Errors
    /// They have none.
    pub fn conserves_energy(&self, kinematics: Kinematics) -> Result<(), SolidError> {
        if kinematics == Kinematics::Small || self.small {
            return Ok(());
        }
        Err(SolidError::NotConserving {
            body: self.name.clone(),
            element: "bars",
            what: "at finite strain".to_owned(),
        })
    }
}
