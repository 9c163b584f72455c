//! What moves at the start, and masses at nodes.

use super::names::Names;
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::Case;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::model::{BodyKind, BodyPart};
use std::collections::HashSet;

/// The velocity of every node at the start; nothing where the case names none.
pub(super) fn velocities(
    case: &Case,
    names: &Names<'_>,
    (mesh, bodies): (&Mesh, &[BodyPart]),
    found: &mut Diagnostics,
) -> Vec<Vec3> {
    let Some(first) = case.initial_velocities.first() else {
        return Vec::new();
    };
    if case.steps.first().is_some_and(|s| s.dynamics.is_none()) {
        let message = "velocities at the start of a static step mean nothing";
        found.push(
            Diagnostic::error(&codes::CONTRADICTION, message)
                .at(&first.place, "the first step is static")
                .help("delete them, or write  kind = \"dynamic\"  in the first [[step]]"),
        );
    }
    let rigid = bodies
        .iter()
        .filter(|body| matches!(body.kind, BodyKind::Rigid(_)));
    let cells = rigid.flat_map(|body| &body.cells);
    let rigid: HashSet<NodeId> = cells.flat_map(|&cell| mesh.cell(cell)).copied().collect();
    let mut velocities = vec![Vec3::ZERO; mesh.nnode()];
    for one in &case.initial_velocities {
        let [velocity, spin, about] = [one.velocity, one.spin, one.about].map(Vec3::from);
        let nodes = names.nodes(&one.on, found).unwrap_or_default();
        if nodes.iter().any(|node| rigid.contains(node)) {
            let message = "a rigid body has no mass, and so no velocity at the start";
            found.push(
                Diagnostic::error(&codes::NOT_BUILT, message)
                    .at(&one.on.place, "names nodes of one")
                    .help("prescribe its motion by [[step.move]]"),
            );
        }
        for node in nodes {
            let place = mesh.points.get(node as usize);
            if let (Some(to), Some(place)) = (velocities.get_mut(node as usize), place) {
                *to = velocity + spin.cross(*place - about);
            }
        }
    }
    velocities
}

/// Masses at nodes.
pub(super) fn masses(
    case: &Case,
    names: &Names<'_>,
    found: &mut Diagnostics,
) -> Vec<(NodeId, f64)> {
    let mut masses = Vec::new();
    for one in &case.masses {
        let nodes = names.nodes(&one.on, found).unwrap_or_default();
        masses.extend(nodes.into_iter().map(|node| (node, one.value)));
    }
    masses
}
