//! Who follows whom: rigid bodies, couplings, equations.

use super::{BodyKind, BodyPart, CarrierPart, ModelError, label};
use crate::system::{Elimination, RigidBody};
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeSet, HashMap};

/// The carriers with the nodes of the rigid bodies that move with them.
pub(super) fn elimination(
    mesh: &Mesh,
    bodies: &[BodyPart],
    carriers: &[CarrierPart],
) -> Result<Elimination, ModelError> {
    let mut nodes: Vec<BTreeSet<NodeId>> = vec![BTreeSet::new(); carriers.len()];
    let mut taken: HashMap<NodeId, (usize, &str)> = HashMap::new();
    for body in bodies {
        let BodyKind::Rigid(carrier) = body.kind else {
            continue;
        };
        let carrier = carrier as usize;
        for &node in body.cells.iter().flat_map(|&c| mesh.cell(c)) {
            let (first, name) = *taken.entry(node).or_insert((carrier, &body.name));
            if first != carrier {
                return Err(ModelError::RigidBodiesShare {
                    first: name.to_string(),
                    second: body.name.clone(),
                    node: label(mesh, node),
                });
            }
            if let Some(of) = nodes.get_mut(carrier) {
                of.insert(node);
            }
        }
    }
    let rigid = carriers.iter().zip(nodes).map(|(carrier, nodes)| {
        let points = nodes.iter().filter_map(|&n| mesh.points.get(n as usize));
        let sum: Vec3 = points.copied().sum();
        let mean = sum / nodes.len().max(1) as f64;
        RigidBody {
            reference: carrier.at.unwrap_or(mean),
            nodes: nodes.into_iter().collect(),
        }
    });
    Ok(Elimination::new(rigid.collect(), mesh.nnode()))
}
