//! What acts on shells: moments at nodes, forces along edges.

use super::solids::Shells;
use crate::setup::quoted;
use signorini_geometry::mesh::{Face, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::Load;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::load::{Acting, Line, Place};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The part of a moment along the normal that counts as none.
const NORMAL: f64 = 1e-3;

/// A moment at each of some nodes, as forces on half their directors: `m·θ = f·d` with `d = θ × n t/2`. Nothing where a node has no
/// director, or the moment turns about its normal.
pub(in crate::setup) fn moments(
    shells: &Shells,
    (load, moment): (&Load, Vec3),
    nodes: &[NodeId],
    label: impl Fn(NodeId) -> u64,
    found: &mut Diagnostics,
) -> Option<Acting> {
    let mut forces = Vec::new();
    for &node in nodes {
        let [director] = shells.directors_at(node) else {
            let text = format!(
                "node {} of {} has no rotation",
                label(node),
                quoted(&load.on)
            );
            let one = Diagnostic::error(&codes::WRONG_KIND, text).at(&load.what, "");
            let help = "tie nodes to a [reference] by a kinematic [[constraint]], and load that";
            found.push(one.help(help));
            return None;
        };
        if moment.dot(director.normal).abs() > NORMAL * moment.norm() {
            found.push(drills(load, label(node)));
            return None;
        }
        let force = moment.cross(director.normal) * (2.0 / director.thickness);
        forces.push((director.half, force));
    }
    Some(Acting::forces(forces))
}

fn drills(load: &Load, node: u64) -> Diagnostic {
    let text = format!(
        "the moment on {} turns about the normal of the shell at node {node}",
        quoted(&load.on)
    );
    let one = Diagnostic::error(&codes::CONTRADICTION, text);
    one.at(
        &load.what,
        "a shell takes no moment about its normal at a point",
    )
    .help("tie two rows of nodes to a [reference] by a kinematic [[constraint]], and load that")
}

/// A force per length of edges as pressures on their faces, one for each thickness.
pub(in crate::setup) fn line_load(line: &Line, faces: Vec<Face>, mesh: &Mesh) -> Vec<Acting> {
    let mut by_thickness: BTreeMap<u64, Vec<Face>> = BTreeMap::new();
    for face in faces {
        if let Some(thickness) = thickness(face, mesh) {
            by_thickness
                .entry(thickness.to_bits())
                .or_default()
                .push(face);
        }
    }
    let acting = |(bits, faces)| Acting {
        load: Arc::new(line.over(f64::from_bits(bits))),
        place: Place::Faces(faces),
    };
    by_thickness.into_iter().map(acting).collect()
}

/// The mean length of the edges of a face across the shell: those that join the faces of its solid.
fn thickness(face: Face, mesh: &Mesh) -> Option<f64> {
    let cell = mesh.cell(face.cell);
    let (negative, positive) = cell.split_at(cell.len() / 2);
    let (_, nodes) = mesh.face(face)?;
    let point = |node: NodeId| mesh.points.get(node as usize).copied();
    let across = negative
        .iter()
        .zip(positive)
        .filter(|(node, _)| nodes.contains(node));
    let lengths = across.filter_map(|(&a, &b)| Some((point(b)? - point(a)?).norm()));
    let lengths: Vec<f64> = lengths.collect();
    (!lengths.is_empty()).then(|| lengths.iter().sum::<f64>() / lengths.len() as f64)
}
