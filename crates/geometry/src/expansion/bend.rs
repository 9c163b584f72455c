//! The middles of straight edges, on the surface that the normals at their ends describe.

use super::join::Joined;
use super::sheet::Sheet;
use crate::mesh::NodeId;
use crate::tensor::Vec3;
use std::ops::Range;

/// The part of a chord along the surface below which the normals describe no arc, and the edge stays straight.
const STEEPEST: f64 = 0.5;

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

/// An edge from its end of lower number to the other.
#[derive(Clone, Copy, Default)]
struct Edge {
    nodes: [NodeId; 2],
    ends: [End; 2],
}

/// Places the new nodes in the middles of edges, (E3). `angle` is that within which normals join.
pub(super) fn bend(sheet: &mut Sheet<'_>, middles: Range<usize>, joined: &Joined, angle: f64) {
    let fold = angle.sin();
    let mut edges = vec![Edge::default(); middles.len()];
    let mut order: Vec<u32> = (0..sheet.pieces.len() as u32).collect();
    order.sort_by_key(|&p| sheet.pieces[p as usize].shell.label);
    for p in order {
        let piece = &sheet.pieces[p as usize];
        let element = piece.shell.element;
        for (i, &at) in piece.pattern.nodes.iter().enumerate() {
            let middle = sheet.stations[piece.first + i].node as usize;
            let Some(&ends) = element.edges().get(at.wrapping_sub(element.ncorner())) else {
                continue;
            };
            if !middles.contains(&middle) {
                continue;
            }
            // corners are the first stations
            let mut ends = ends.map(|corner| piece.first + corner);
            ends.sort_by_key(|&s| sheet.stations[s].node);
            let edge = &mut edges[middle - middles.start];
            for (k, s) in ends.into_iter().enumerate() {
                edge.nodes[k] = sheet.stations[s].node;
                if let Some(group) = joined.groups.get(joined.of[s] as usize) {
                    edge.ends[k].add(group.normal, fold);
                }
            }
        }
    }
    for (edge, middle) in edges.iter().zip(middles) {
        let [a, b] = edge.nodes.map(|node| sheet.points[node as usize]);
        let [t_a, t_b] = edge.ends.map(|end| end.tangent(b - a));
        sheet.points[middle] = (a + b) * 0.5 + (t_a - t_b) * 0.125;
    }
}
