//! Forces on nodes that stand for a dead load: consistent with the shape functions, or statically equivalent.

use super::Region;
use super::local::gather;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// Forces on nodes.
pub type NodalVectors = BTreeMap<NodeId, Vec3>;

/// Relative distance from a line below which nodes lie on it.
const STRAIGHT: f64 = 1e-9;

/// The area of faces at the start; axisymmetric: of the full circumference.
#[must_use]
pub fn area(faces: &Region, reference: &[Vec3]) -> f64 {
    let mut total = 0.0;
    each_area(faces, reference, |_, _, directed| {
        total += directed.norm();
    });
    total
}

/// `∫ N_I t(n dA)` over faces at the start (E2): `traction` makes a force of a directed area, which points out.
#[must_use]
pub fn over_faces(
    faces: &Region,
    reference: &[Vec3],
    traction: impl Fn(Vec3) -> Vec3,
) -> NodalVectors {
    let mut out = NodalVectors::new();
    each_area(faces, reference, |nodes, shape, directed| {
        add(&mut out, nodes, shape, traction(directed));
    });
    out
}

/// `∫ N_I b dV` over cells at the start (E2); the density is in the factors of the region.
#[must_use]
pub fn over_cells(cells: &Region, reference: &[Vec3], force: Vec3) -> NodalVectors {
    let mut out = NodalVectors::new();
    let mut x = Vec::new();
    for (patch, piece) in cells.pieces() {
        gather(reference, piece.nodes, &mut x);
        for sample in patch.samples() {
            let measure = patch.volume(&piece, &sample, &x);
            add(&mut out, piece.nodes, sample.shape, force * measure);
        }
    }
    out
}

/// `f_i = (J⁻¹ M) × r_i` with the arms `r_i` from the centre of the nodes and `J = Σ (r²I − r rᵀ)` (E6): no net force,
/// and the moment `M`. `None` where the nodes lie on a line and the moment turns about it, or in a point.
#[must_use]
pub fn moment(nodes: &[NodeId], reference: &[Vec3], moment: Vec3) -> Option<NodalVectors> {
    let unique: BTreeSet<NodeId> = nodes.iter().copied().collect();
    let place = |n: NodeId| reference.get(n as usize).copied().unwrap_or_default();
    let centre = unique.iter().map(|&n| place(n)).sum::<Vec3>() / unique.len().max(1) as f64;
    let arms: Vec<(NodeId, Vec3)> = unique.iter().map(|&n| (n, place(n) - centre)).collect();
    let farthest = arms
        .iter()
        .map(|(_, r)| *r)
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
    let size: f64 = arms.iter().map(|(_, r)| r.norm_squared()).sum();
    let along = farthest.normalized()?;
    let away = arms.iter().map(|(_, r)| r.cross(along).norm());
    let turn = if away.fold(0.0, f64::max) <= STRAIGHT * farthest.norm() {
        // on a line J = Σr² (I − d dᵀ)
        let carried = moment.dot(along).abs() <= STRAIGHT * moment.norm();
        carried.then(|| moment * size.recip())?
    } else {
        let dyads = arms.iter().map(|(_, r)| Mat3::outer(*r, *r));
        let inertia = dyads.fold(Mat3::IDENTITY * size, |j, d| j - d);
        inertia.inverse()?.0 * moment
    };
    Some(arms.into_iter().map(|(n, r)| (n, turn.cross(r))).collect())
}

/// Hands the nodes, the shape functions and the directed area of every quadrature point of faces to `take`.
pub(super) fn each_area(
    faces: &Region,
    places: &[Vec3],
    mut take: impl FnMut(&[NodeId], &[f64], Vec3),
) {
    let mut x = Vec::new();
    for (patch, piece) in faces.pieces() {
        gather(places, piece.nodes, &mut x);
        for sample in patch.samples() {
            let (t1, t2) = sample.tangents(patch.space(), &x);
            let directed = t1.cross(t2) * sample.weight_in(&piece);
            take(piece.nodes, sample.shape, directed);
        }
    }
}

fn add(out: &mut NodalVectors, nodes: &[NodeId], shape: &[f64], force: Vec3) {
    for (node, n) in nodes.iter().zip(shape) {
        *out.entry(*node).or_insert(Vec3::ZERO) += force * *n;
    }
}
