//! The nodes of directors and the solids between them.

use super::error::ExpansionError;
use super::join::Joined;
use super::result::{Director, Knot};
use super::sheet::{Piece, Sheet};
use crate::mesh::{Mesh, NodeId};
use crate::tensor::Vec3;

/// The directors of all groups, whose nodes are added to the mesh, and the knots among them.
pub(super) fn directors(
    mesh: &mut Mesh,
    sheet: &Sheet<'_>,
    joined: &Joined,
) -> (Vec<Director>, Vec<Knot>) {
    let first = mesh
        .node_labels
        .iter()
        .max()
        .map_or(1, |&last| last.saturating_add(1));
    let ngiven = mesh.points.len();
    mesh.points.clone_from(&sheet.points);
    mesh.points.reserve(3 * joined.groups.len());
    let mut all = Vec::with_capacity(joined.groups.len());
    let mut knots = Vec::new();
    let mut add = |point: Vec3| -> NodeId {
        mesh.points.push(point);
        (mesh.points.len() - 1) as NodeId
    };
    for groups in joined.groups.chunk_by(|a, b| a.node == b.node) {
        let from = all.len();
        for group in groups {
            let point = sheet.points[group.node as usize];
            let is_knot = groups.len() > 1;
            // (E1)
            let at = |part: f64| point + group.normal * (part * group.thickness);
            all.push(Director {
                node: group.node,
                middle: if is_knot { add(point) } else { group.node },
                half: add(point),
                negative: add(at(-0.5 - group.offset)),
                positive: add(at(0.5 - group.offset)),
                normal: group.normal,
                thickness: group.thickness,
            });
        }
        if let [group, _, ..] = groups {
            knots.push(Knot {
                node: group.node,
                directors: from..all.len(),
            });
        }
    }
    let nnew = (mesh.points.len() - ngiven) as u64;
    mesh.node_labels
        .extend((0..nnew).map(|k| first.saturating_add(k)));
    (all, knots)
}

/// The corners of a solid: stations of a shell, and where they lie on both faces.
struct Corners {
    stations: [usize; 4],
    surface: [Vec3; 4],
    negative: [Vec3; 4],
    positive: [Vec3; 4],
    normals: [Vec3; 4],
}

/// Whether each corner of a solid is the right way round.
///
/// # Errors
/// The reason why it is not.
pub(super) fn check(
    mesh: &Mesh,
    sheet: &Sheet<'_>,
    piece: &Piece<'_>,
    quad: [usize; 4],
    directors: [&Director; 4],
) -> Result<(), ExpansionError> {
    let at = |node: NodeId| mesh.points[node as usize];
    let corners = Corners {
        stations: quad.map(|k| piece.first + k),
        surface: directors.map(|d| at(d.node)),
        negative: directors.map(|d| at(d.negative)),
        positive: directors.map(|d| at(d.positive)),
        normals: directors.map(|d| d.normal),
    };
    let [a, b, c, d] = corners.surface;
    let across = (c - a).cross(d - b);
    for i in 0..4 {
        let label = piece.shell.label;
        let station = &sheet.stations[corners.stations[i]];
        let node = || sheet.node_label(piece, corners.stations[i]);
        let is_ahead = station.prescribed || station.normal.dot(across) > 0.0;
        if !is_ahead || corners.area(&corners.surface, i).dot(across) <= 0.0 {
            let node = node();
            return Err(ExpansionError::Folded { label, node });
        }
        if corners.area(&corners.surface, i).dot(corners.normals[i]) <= 0.0 {
            let node = node();
            return Err(ExpansionError::Reversed { label, node });
        }
        for (face, places) in [
            ("negative", &corners.negative),
            ("positive", &corners.positive),
        ] {
            // the Jacobian there, but for a factor
            if corners.area(places, i).dot(corners.normals[i]) > 0.0 {
                continue;
            }
            return Err(ExpansionError::InsideOut {
                label,
                node: node(),
                radius: corners.radius(i),
                depth: (places[i] - corners.surface[i]).norm(),
                face,
            });
        }
    }
    Ok(())
}

impl Corners {
    /// The vector product of the edges that start in a corner of a face.
    fn area(&self, places: &[Vec3; 4], corner: usize) -> Vec3 {
        let [next, last] = [1, 3].map(|k| places[(corner + k) % 4] - places[corner]);
        next.cross(last)
    }

    /// The lesser radius of curvature at a corner, (E4).
    fn radius(&self, corner: usize) -> f64 {
        let curvature = [1, 3].map(|k| {
            let other = (corner + k) % 4;
            let chord = self.surface[other] - self.surface[corner];
            let turn = self.normals[other] - self.normals[corner];
            (turn.dot(chord) / chord.norm_squared()).abs()
        });
        curvature[0].max(curvature[1]).recip()
    }
}
