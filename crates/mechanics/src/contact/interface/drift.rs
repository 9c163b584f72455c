//! How far sides move along one another where contact keeps the geometry of the start.

use super::{Carrier, Contact, Interface, State};
use crate::system::NO_DOF;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::SurfaceJet;
use signorini_geometry::tensor::{Mat3, Vec3};

impl Interface {
    /// The largest motion since the start, along the other side, of what touches in an accepted state, over the size of the
    /// facets, and its node; `None` where contact follows what moves.
    pub(super) fn farthest(&self, state: &State) -> Option<(f64, NodeId)> {
        let keeps = self.parts.bond.is_none() && self.parts.discretization.capabilities().keeps();
        if !keeps || !self.is_active() {
            return None;
        }
        let touching = self.accepted_judged.iter().enumerate();
        let touching = touching.filter(|(_, judged)| judged.state != Contact::Open);
        let moved = touching.filter_map(|(row, _)| {
            let (way, normal) = self.way(row, state)?;
            let along = way - normal * way.dot(normal);
            let node = self.parts.discretization.point(row).nodes.first()?;
            Some((along.norm() / self.parts.scale.length, *node))
        });
        moved.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The motion of a row since the start relative to the surface it meets, and its normal.
    fn way(&self, row: usize, state: &State) -> Option<(Vec3, Vec3)> {
        let discretization = self.parts.discretization.as_ref();
        let moves = |node: NodeId| self.displacement(node, state);
        let averaged = discretization.capabilities().averaged;
        if let Some(found) = averaged.and_then(|of| of.way(row, &self.now, &moves)) {
            return Some(found);
        }
        let pair = self.now.pairs.get(row).copied().flatten()?;
        let surface = self.parts.pair.primary.as_ref();
        let mut jet = SurfaceJet::default();
        surface
            .jet(&state.placement(), &pair.anchor, &mut jet)
            .ok()?;
        let point = discretization.point(row);
        let of_point = point.nodes.iter().zip(point.weights);
        let own: Vec3 = of_point.map(|(&n, w)| moves(n) * *w).sum();
        let other = match surface.carrier(pair.anchor.facet) {
            Carrier::Nodes(nodes) => nodes
                .iter()
                .zip(jet.shape)
                .map(|(&n, w)| moves(n) * w)
                .sum(),
            Carrier::Rigid(body) => {
                let mut way = Vec3::ZERO;
                for axis in 0..3 {
                    let dof = self.layout.translation(body, axis);
                    let value = state.u.get(dof as usize).filter(|_| dof != NO_DOF);
                    way[axis] = value.copied().unwrap_or_default();
                }
                let turned = state.poses.get(body as usize).map_or(Vec3::ZERO, |pose| {
                    let back = Mat3::IDENTITY - pose.rotation.transpose();
                    back * (jet.position - pose.origin)
                });
                way + turned
            }
            Carrier::Fixed => Vec3::ZERO,
        };
        Some((own - other, pair.held?))
    }
}
