//! Bodies that are cut apart, so that a bolt can be tightened: nodes of the cut are doubled.
//!
//! The cut is a set of faces. The side of the elements that own them gets copies of its nodes; the other side keeps the
//! nodes that names stand for. With the normal n that points away from the side of the copies, and the overlap δ,
//! equations say
//!
//! ```text
//!   u_copy − u_node = n δ                                          (E1)
//! ```
//!
//! so that a force on δ pulls the sides together and a positive δ stretches both. A side is what hangs together by faces
//! around the nodes of the cut, without going through it.

use super::names::{Names, face_normal};
use super::quoted;
use super::shells::Shells;
use signorini_geometry::mesh::{CellId, Face, FaceIndex, Mesh, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{Case, ConstraintKind, Name};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::model::Unknown;
use signorini_mechanics::solve::Motion;
use std::collections::{BTreeMap, BTreeSet};

/// A cut through a body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cut {
    /// Nodes with their copies.
    pub pairs: Vec<(NodeId, NodeId)>,
    /// n
    pub normal: Vec3,
}

/// The cuts of a case, by the numbers of their constraints.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Cuts(BTreeMap<usize, Cut>);

impl Cuts {
    /// Cuts the mesh where the case says so.
    pub fn new(case: &Case, mesh: &mut Mesh, found: &mut Diagnostics) -> Self {
        let mut cuts = Self::default();
        let mut all = Vec::new();
        let wanted = |kind: &ConstraintKind| matches!(kind, ConstraintKind::Pretension { .. });
        if case.constraints.iter().any(|one| wanted(&one.kind)) {
            // its own messages come again with the names of the mesh that is cut
            let shells = Shells::default();
            let names = Names::new(case, mesh, &shells, &mut Diagnostics::new());
            for (number, one) in case.constraints.iter().enumerate() {
                let ConstraintKind::Pretension { on, normal, .. } = &one.kind else {
                    continue;
                };
                let normal = normal.map(Vec3::from);
                if let Some(faces) = names.cut(on, normal, found) {
                    all.push((number, on, faces, normal));
                }
            }
        }
        let mut doubled = BTreeSet::new();
        for (number, on, faces, normal) in all {
            match cut(mesh, &faces, normal, &mut doubled) {
                Ok(cut) => drop(cuts.0.insert(number, cut)),
                Err(reason) => found.push(refused(on, reason)),
            }
        }
        cuts
    }

    /// Nodes with their copies.
    pub fn pairs(&self) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        self.0.values().flat_map(|cut| cut.pairs.iter().copied())
    }

    /// Copies of nodes are as warm as the nodes.
    pub fn warm(&self, temperatures: &mut Vec<(NodeId, Motion)>) {
        if self.0.is_empty() {
            return;
        }
        let given: BTreeMap<NodeId, Motion> = temperatures.iter().cloned().collect();
        let copied = self.pairs();
        let copied = copied.filter_map(|(node, copy)| Some((copy, given.get(&node)?.clone())));
        temperatures.extend(copied);
    }

    /// Copies of nodes move as the nodes do.
    pub fn moves(&self, velocities: &mut [Vec3]) {
        for (node, copy) in self.pairs() {
            let velocity = velocities.get(node as usize).copied();
            if let (Some(from), Some(to)) = (velocity, velocities.get_mut(copy as usize)) {
                *to = from;
            }
        }
    }

    /// The equations of a constraint (E1), with what carries its overlap.
    pub fn equations(
        &self,
        number: usize,
        carrier: RigidId,
        ndim: usize,
    ) -> Vec<Vec<(Unknown, f64)>> {
        let Some(cut) = self.0.get(&number) else {
            return Vec::new();
        };
        let of_pair = |&(node, copy): &(NodeId, NodeId)| {
            (0..ndim).map(move |axis| {
                let mut terms = vec![
                    (Unknown::Node(copy, axis), 1.0),
                    (Unknown::Node(node, axis), -1.0),
                ];
                let along = cut.normal[axis];
                if along != 0.0 {
                    terms.push((Unknown::Carrier(carrier, 0), -along));
                }
                terms
            })
        };
        cut.pairs.iter().flat_map(of_pair).collect()
    }
}

/// Why a body cannot be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reason {
    /// The two sides hang together around an end of the cut.
    Partial,
    /// There is nothing on the other side.
    Outside,
    /// Another cut goes through the same nodes.
    Twice,
    /// The faces have no mean normal.
    NoNormal,
}

fn refused(on: &Name, reason: Reason) -> Diagnostic {
    let (text, help) = match reason {
        Reason::Partial => (
            "does not cut the body in two: its sides hang together beside it",
            "take in all faces of a cross-section, all on one side of it",
        ),
        Reason::Outside => (
            "lies on the outside: there is nothing to pull together",
            "name the faces of a cross-section inside the body",
        ),
        Reason::Twice => (
            "goes through nodes of another pretension",
            "put the cuts at least an element apart",
        ),
        Reason::NoNormal => ("has no normal of its own", "write  normal ="),
    };
    Diagnostic::error(&codes::BAD_CONSTRAINT, format!("{} {text}", quoted(on)))
        .at(&on.place, "cut here")
        .help(help)
}

/// Gives the side of these faces nodes of its own.
fn cut(
    mesh: &mut Mesh,
    faces: &[Face],
    normal: Option<Vec3>,
    doubled: &mut BTreeSet<NodeId>,
) -> Result<Cut, Reason> {
    let of_faces = faces.iter().filter_map(|&face| mesh.face(face));
    let mut nodes: Vec<NodeId> = Vec::new();
    let mut seen = BTreeSet::new();
    for node in of_faces.flat_map(|(_, nodes)| nodes) {
        if seen.insert(node) {
            nodes.push(node);
        }
    }
    if !doubled.is_disjoint(&seen) {
        return Err(Reason::Twice);
    }
    let mean = || faces.iter().map(|&face| face_normal(mesh, face)).sum();
    let normal: Vec3 = normal.unwrap_or_else(mean);
    let normal = normal.normalized().ok_or(Reason::NoNormal)?;
    let side = side(mesh, faces, &seen)?;
    let mut label = mesh.node_labels.iter().copied().max().unwrap_or(0);
    let mut copies: BTreeMap<NodeId, NodeId> = BTreeMap::new();
    for &node in &nodes {
        let Some(&point) = mesh.points.get(node as usize) else {
            continue;
        };
        label += 1;
        copies.insert(node, mesh.nnode() as NodeId);
        mesh.points.push(point);
        mesh.node_labels.push(label);
    }
    for cell in side {
        let Some(block) = mesh.blocks.get_mut(cell.block as usize) else {
            continue;
        };
        let n = block.element.nnode();
        let own = block.nodes.iter_mut().skip(cell.index as usize * n).take(n);
        for node in own {
            if let Some(&copy) = copies.get(node) {
                *node = copy;
            }
        }
    }
    doubled.extend(copies.iter().flat_map(|(&node, &copy)| [node, copy]));
    let pair = |node: NodeId| Some((node, *copies.get(&node)?));
    Ok(Cut {
        pairs: nodes.into_iter().filter_map(pair).collect(),
        normal,
    })
}

/// The elements around the nodes of a cut that hang together with those that own its faces.
fn side(mesh: &Mesh, faces: &[Face], nodes: &BTreeSet<NodeId>) -> Result<BTreeSet<CellId>, Reason> {
    let touches = |cell: &CellId| mesh.cell(*cell).iter().any(|node| nodes.contains(node));
    let around: Vec<CellId> = mesh.cells(mesh.dim()).filter(touches).collect();
    let index = FaceIndex::new(mesh, around.iter().copied());
    let other = |face: Face| {
        let (element, nodes) = mesh.face(face)?;
        let (one, two) = index.find(element, &nodes)?;
        if one.cell == face.cell {
            two
        } else {
            Some(one)
        }
    };
    let across: BTreeSet<Face> = faces.iter().filter_map(|&face| other(face)).collect();
    let cut: BTreeSet<Face> = faces.iter().chain(&across).copied().collect();
    if across.is_empty() {
        return Err(Reason::Outside);
    }
    let mut side: BTreeSet<CellId> = faces.iter().map(|face| face.cell).collect();
    let mut open: Vec<CellId> = side.iter().copied().collect();
    while let Some(cell) = open.pop() {
        let nside = mesh
            .element(cell)
            .map_or(0, |element| element.sides().len());
        for number in 0..nside {
            let face = Face {
                cell,
                side: number as u8,
            };
            if cut.contains(&face) {
                continue;
            }
            if let Some(next) = other(face)
                && side.insert(next.cell)
            {
                open.push(next.cell);
            }
        }
    }
    if across.iter().any(|face| side.contains(&face.cell)) {
        return Err(Reason::Partial);
    }
    Ok(side)
}
