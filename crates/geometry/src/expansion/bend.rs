//! The middles of straight edges, on the surface that the normals at their ends describe.

use super::join::Joined;
use super::sheet::Sheet;
use crate::mesh::NodeId;
use crate::tensor::Vec3;

/// The part of a chord along the surface below which the normals describe no arc, and the edge stays straight.
const STEEPEST: f64 = 0.5;
/// The sine of the least angle between the normals of a fold, whatever the angle within which they join.
const LEAST_FOLD: f64 = 1e-3;

/// The normals at one end of an edge: one of a smooth surface, two on a fold.
#[derive(Clone, Copy, Default)]
struct End {
    first: Vec3,
    /// Perpendicular to the first; zero where the surface is smooth.
    second: Vec3,
}

impl End {
    /// Adds the normal of one more cell; it is a fold from the sine of an angle on.
    fn add(&mut self, normal: Vec3, fold: f64) {
        if self.first == Vec3::ZERO {
            self.first = normal;
        } else if self.second == Vec3::ZERO {
            let across = normal - self.first * self.first.dot(normal);
            if across.norm() > fold {
                self.second = across.normalized().unwrap_or_default();
            }
        }
    }

    /// The tangent of the edge here, as long as the chord.
    fn tangent(&self, chord: Vec3) -> Vec3 {
        let along = chord - self.first * self.first.dot(chord);
        let along = along - self.second * self.second.dot(along);
        let length = chord.norm();
        let part = along.norm();
        if part > STEEPEST * length {
            along * (length / part)
        } else {
            chord
        }
    }
}

/// Places the new nodes in the middles of edges, which start with node `first`, (E3). The edges have these ends; `angle`
/// is that within which normals join.
pub(super) fn bend(
    sheet: &mut Sheet<'_>,
    first: usize,
    edges: &[[NodeId; 2]],
    joined: &Joined,
    angle: f64,
) {
    let fold = angle.sin().max(LEAST_FOLD);
    let mut normals = vec![[End::default(); 2]; edges.len()];
    let mut order: Vec<u32> = (0..sheet.pieces.len() as u32).collect();
    order.sort_by_key(|&p| sheet.pieces[p as usize].shell.label);
    for p in order {
        let piece = &sheet.pieces[p as usize];
        let element = piece.shell.element;
        for (i, &at) in piece.pattern.nodes.iter().enumerate() {
            let middle = sheet.stations[piece.first + i].node as usize;
            let corners = element.edges().get(at.wrapping_sub(element.ncorner()));
            let normals = normals.get_mut(middle.wrapping_sub(first));
            let (Some(&ends), Some(normals)) = (corners, normals) else {
                continue;
            };
            // corners are the first stations
            let mut ends = ends.map(|corner| piece.first + corner);
            ends.sort_by_key(|&s| sheet.stations[s].node);
            for (end, s) in normals.iter_mut().zip(ends) {
                if let Some(group) = joined.groups.get(joined.of[s] as usize) {
                    end.add(group.normal, fold);
                }
            }
        }
    }
    for (k, (edge, ends)) in edges.iter().zip(normals).enumerate() {
        let [a, b] = edge.map(|node| sheet.points[node as usize]);
        let [t_a, t_b] = ends.map(|end| end.tangent(b - a));
        sheet.points[first + k] = (a + b) * 0.5 + (t_a - t_b) * 0.125;
    }
}
