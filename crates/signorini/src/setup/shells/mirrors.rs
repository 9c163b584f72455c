//! Nodes on planes of symmetry: there the normal lies in the plane.

use crate::setup::names::Names;
use signorini_geometry::expansion::{Expansion, ShellCell};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{Case, Directions};
use signorini_io::diagnostic::Diagnostics;
use std::collections::BTreeMap;

/// The part of a normal in the plane below which it is left as it is: the shell lies in the plane then.
const ACROSS: f64 = 0.5;

/// The axis of the plane of symmetry that a support stands for: along it displacements are held, and no others, and rotations about
/// others, but not about it.
fn plane(u: &Directions, rot: &Directions) -> Option<usize> {
    let mut held = (0..3).filter(|&axis| u.xyz[axis]);
    let axis = held.next().filter(|_| held.next().is_none())?;
    (!rot.xyz[axis] && !rot.is_empty()).then_some(axis)
}

/// The normals of nodes on planes of symmetry that supports of the first step stand for, by cell and node: the mean of the normal of the
/// elements and that of their mirror images.
pub(super) fn normals(
    case: &Case,
    names: &Names<'_>,
    mesh: &Mesh,
    cells: &[ShellCell],
    expansion: &Expansion,
) -> BTreeMap<(CellId, NodeId), Vec3> {
    let mut mirrored: BTreeMap<NodeId, Vec3> = BTreeMap::new();
    let fixes = case.steps.first().map_or(&[][..], |step| &step.fixes);
    for fix in fixes {
        let Some(axis) = plane(&fix.u, &fix.rot) else {
            continue;
        };
        // names that are not there are reported with the supports
        let nodes = names.nodes(&fix.on, &mut Diagnostics::new());
        for node in nodes.unwrap_or_default() {
            let [director] = expansion.directors_at(node) else {
                continue;
            };
            let normal = mirrored.get(&node).copied().unwrap_or(director.normal);
            let inside = normal - Vec3::unit(axis) * normal[axis];
            if let Some(normal) = inside.normalized().filter(|_| inside.norm() > ACROSS) {
                mirrored.insert(node, normal);
            }
        }
    }
    let of_cell = |shell: &ShellCell| {
        let nodes = mesh.cell(shell.cell).iter();
        let known = nodes.filter_map(|node| Some((*node, *mirrored.get(node)?)));
        let given: Vec<_> = known
            .map(|(node, normal)| ((shell.cell, node), normal))
            .collect();
        given
    };
    cells.iter().flat_map(of_cell).collect()
}
