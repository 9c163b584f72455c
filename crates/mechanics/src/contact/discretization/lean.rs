//! Normals between those of both sides, for points that keep the tangent plane that they meet first ((E9) of
//! [`crate::contact::mortar`]).

use super::on_facet::OnFacet;
use super::point::Point;
use crate::contact::mortar::{SMOOTH, between};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Anchor, ContactSurface, Facets, Placement, SurfaceJet};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;

/// Where each point is on the facets around it.
pub struct Lean {
    /// The part of the normals of the secondary side.
    share: f64,
    // those of point k: at[first[k]..first[k + 1]]
    first: Vec<u32>,
    at: Vec<Anchor>,
}

impl Lean {
    /// That of points inside facets; `share` is the part of the normals of the secondary side.
    #[must_use]
    pub fn inside(points: &[OnFacet], share: f64) -> Self {
        let at = |point: &OnFacet| Anchor {
            facet: point.facet,
            local: point.xi,
        };
        Self {
            share,
            first: (0..=points.len() as u32).collect(),
            at: points.iter().map(at).collect(),
        }
    }

    /// That of nodes; `share` is the part of the normals of the secondary side.
    #[must_use]
    pub fn at_nodes<'a>(
        facets: &Facets,
        points: impl Iterator<Item = Point<'a>>,
        share: f64,
    ) -> Self {
        let mut around: HashMap<NodeId, Vec<Anchor>> = HashMap::new();
        for facet in 0..facets.nfacet() as u32 {
            let places = facets.element(facet).map_or(&[][..], |e| e.nodes());
            for (&node, &local) in facets.nodes(facet).iter().zip(places) {
                around
                    .entry(node)
                    .or_default()
                    .push(Anchor { facet, local });
            }
        }
        let mut lean = Self {
            share,
            first: vec![0],
            at: Vec::new(),
        };
        for point in points {
            let of_point = point.nodes.iter().filter_map(|node| around.get(node));
            lean.at.extend(of_point.flatten());
            lean.first.push(lean.at.len() as u32);
        }
        lean
    }

    /// The normal that a point keeps which meets a facet with this one. Facets around it that turn away by more than
    /// 30 degrees, as those of the other side of an edge do, do not count.
    pub(super) fn normal(
        &self,
        row: usize,
        facets: &Facets,
        at: &Placement,
        primary: Vec3,
    ) -> Vec3 {
        let of_point = match self.first.get(row..) {
            Some([a, b, ..]) => self.at.get(*a as usize..*b as usize),
            _ => None,
        };
        let mut jet = SurfaceJet::default();
        let mut sum = Vec3::ZERO;
        for anchor in of_point.unwrap_or_default() {
            if facets.jet(at, anchor, &mut jet).is_ok() && -jet.normal.dot(primary) >= SMOOTH {
                sum -= jet.normal;
            }
        }
        match sum.normalized() {
            Some(own) if own.dot(primary) >= SMOOTH => between(own, primary, self.share),
            _ => primary,
        }
    }
}
