//! Bodies whose geometric stiffness takes predicted stresses: (E36) of `kernel::predicted`, (E40) of `kernel::shell`.

use super::Solid;
use super::at::At;
use super::cells::Cells;
use crate::system::GeometricStress;

impl Solid {
    /// Whether the tangent takes predicted stresses in the present step: not those of laws with a history, nor where a
    /// remedy against locking other than the solid-shell changes the strain.
    pub(super) fn may_predict(&self) -> bool {
        let predicts = |block: &Cells| block.treatment(self.kinematics).predicts();
        self.step.may_predict()
            && (self.is_thin || self.step.geometric == GeometricStress::Mixed)
            && self.material().is_elastic()
            && self.blocks.iter().all(predicts)
    }

    /// The correction from which cells predict their stress; empty where they do not.
    pub(super) fn correction<'a>(&self, at: At<'a>) -> &'a [f64] {
        if self.predicts { at.correction() } else { &[] }
    }
}
