//! How long an increment may be in which contact closes or opens.

use super::{ContactPart, Context, SidePart};
use crate::solve::TimeControl;
use signorini_geometry::mesh::{Face, NodeId};
use signorini_geometry::tensor::Vec3;

/// Poisson's ratio beyond which waves of an almost incompressible material count no faster.
const LARGEST_RATIO: f64 = 0.45;

/// What limits increments of a dynamic step, as a case says it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlPart {
    /// The local error of displacements over the largest displacement so far; 0: it is not looked at.
    pub error_tol: f64,
    /// The longest increment in which contact closes or opens, over the time that a wave takes through an element of the secondary side;
    /// 0: there is no limit.
    pub impact_step: f64,
}

impl Context<'_> {
    /// What that is for these contacts.
    pub(super) fn control(&self, part: &ControlPart, contacts: &[ContactPart]) -> TimeControl {
        let limited = part.impact_step > 0.0;
        let crossing = limited.then(|| self.crossing(contacts)).flatten();
        TimeControl {
            tolerance: (part.error_tol > 0.0).then_some(part.error_tol),
            impact: crossing.map(|time| time * part.impact_step),
        }
    }

    /// The shortest time that a wave takes through an element of a secondary side, of contacts that open and close.
    fn crossing(&self, contacts: &[ContactPart]) -> Option<f64> {
        let open = contacts.iter().filter(|contact| contact.tie.is_none());
        let faces = open.filter_map(|contact| match &contact.secondary {
            SidePart::Faces(faces) => Some(faces),
            SidePart::Nodes(_) => None,
        });
        let times = faces.flatten().filter_map(|face| self.crossing_at(*face));
        times.min_by(f64::total_cmp)
    }

    /// Twice the way from a face to the middle of its element, half of it where there are nodes between, over the speed of longitudinal
    /// waves `√((λ + 2μ)/ρ)`.
    fn crossing_at(&self, face: Face) -> Option<f64> {
        let body = *self.owner.get(&face.cell)?;
        let density = self.substances.get(body)?.density?;
        let (young, shear) = ((*self.modulus.get(body)?)?, *self.shear_modulus.get(body)?);
        let ratio = shear.map_or(0.0, |shear| 0.5 * young / shear - 1.0);
        let ratio = ratio.clamp(0.0, LARGEST_RATIO);
        let stiffness = young * (1.0 - ratio) / ((1.0 + ratio) * (1.0 - 2.0 * ratio));
        let middle = |nodes: &[NodeId]| {
            let places = nodes
                .iter()
                .filter_map(|&node| self.reference.get(node as usize));
            places.copied().sum::<Vec3>() / nodes.len().max(1) as f64
        };
        let (_, of_face) = self.mesh.face(face)?;
        let of_face: Vec<NodeId> = of_face.into_iter().collect();
        let across = (middle(self.mesh.cell(face.cell)) - middle(&of_face)).norm();
        let has_mid_nodes = self.mesh.element(face.cell)?.mid_nodes().next().is_some();
        let length = if has_mid_nodes { across } else { 2.0 * across };
        let time = length * (density / stiffness).sqrt();
        (time > 0.0).then_some(time)
    }
}
