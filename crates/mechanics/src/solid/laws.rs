//! The materials of a body: which one is in force in the present step.

use super::plan::is_linear;
use super::term::in_space;
use super::{Solid, SolidError};
use crate::material::Material;

impl Solid {
    /// Another material takes the place of the present one when a step begins; steps come in their order.
    ///
    /// # Errors
    /// Its history at a point is another one's.
    pub fn change(&mut self, step: usize, material: Box<dyn Material>) -> Result<(), SolidError> {
        let linear = is_linear(material.as_ref());
        let material = in_space(material, self.space);
        if material.nhistory() != self.material.nhistory() {
            return Err(SolidError::OtherHistory {
                body: self.name.clone(),
            });
        }
        self.later.push((step, material));
        self.linear.push(linear);
        Ok(())
    }

    /// How many materials have taken the place of one before.
    pub(super) fn nchanged(&self) -> usize {
        let is_begun = |(step, _): &&(usize, _)| *step <= self.step.number;
        self.later.iter().take_while(is_begun).count()
    }

    /// The material of the present step.
    pub(super) fn material(&self) -> &dyn Material {
        let last = self.nchanged().checked_sub(1);
        let later = last.and_then(|last| self.later.get(last));
        later.map_or(self.material.as_ref(), |(_, material)| material.as_ref())
    }

    /// Whether the law of the present step is linear in the strain of Green and Lagrange.
    pub(super) fn is_linear(&self) -> bool {
        self.linear
            .get(self.nchanged())
            .copied()
            .unwrap_or_default()
    }
}
