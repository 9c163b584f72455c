//! The facets that a point of a surface may meet on the same surface: see the equations of [`OwnBody`](super::OwnBody).

use super::own::{ENTERED, OwnNow, OwnPoint};
use super::{OnFacet, SurfacePair};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Carrier, Placement};
use signorini_geometry::tensor::Vec3;

impl SurfacePair {
    /// Whether a facet of a surface that may touch itself is next to the point of a row, and never meets it: it shares a
    /// node with the point, or with the facets that the point is in the middle of.
    #[must_use]
    pub fn is_next_to(&self, nodes: &[NodeId], facet: u32) -> bool {
        let of = |facet: u32| match self.primary.carrier(facet) {
            Carrier::Nodes(nodes) => nodes,
            Carrier::Rigid(_) | Carrier::Fixed => &[],
        };
        let others = of(facet);
        let meets = |nodes: &[NodeId]| nodes.iter().any(|n| others.contains(n));
        let around = || {
            let (own, [node]) = (self.own.as_ref()?, nodes) else {
                return None;
            };
            let place = self.points.binary_search(node).ok()?;
            let middle = own.middle.get(place).copied()?;
            middle.then(|| own.facets_of(Some(place), None))
        };
        meets(nodes) || around().unwrap_or(&[]).iter().any(|&f| meets(of(f)))
    }

    /// The point of a row of a surface that may touch itself, among the normals and thickness that facets have `now`.
    #[must_use]
    pub fn own_point<'a>(
        &'a self,
        nodes: &[NodeId],
        inside: Option<&'a OnFacet>,
        now: &'a OwnNow,
    ) -> Option<OwnPoint<'a>> {
        let own = self.own.as_ref()?;
        let place = nodes
            .first()
            .and_then(|n| self.points.binary_search(n).ok());
        let around = own.facets_of(place, inside);
        let mut point = OwnPoint {
            normal: Vec3::ZERO,
            thickness: f64::INFINITY,
            around,
            body: own,
            of: now,
        };
        for &facet in around {
            point.normal += now.normal(facet);
            point.thickness = point.thickness.min(now.thickness(facet));
        }
        point.normal = point.normal.normalized().unwrap_or_default();
        Some(point)
    }

    /// How deep the point of a row may enter the facet that it meets (E2); infinite where a surface meets another.
    #[must_use]
    pub fn deepest(
        &self,
        nodes: &[NodeId],
        inside: Option<&OnFacet>,
        facet: u32,
        at: &Placement,
    ) -> f64 {
        let Some(own) = &self.own else {
            return f64::INFINITY;
        };
        let place = nodes
            .first()
            .and_then(|n| self.points.binary_search(n).ok());
        let around = own.facets_of(place, inside).iter().copied();
        let thickness = around.chain([facet]).map(|f| {
            let behind = own.behind.get(f as usize).copied().flatten();
            own.of_facet(self.primary.as_ref(), at, f, behind).0
        });
        ENTERED * thickness.fold(f64::INFINITY, f64::min)
    }
}
