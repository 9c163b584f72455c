//! Points of the secondary side, its nodes or points inside its facets, against segments of the primary side. They
//! differ in nothing but the points.

use super::cut::FacetPoints;
use super::projected::{Closest, Place, Point, closest};
use super::{Anchored, Discretization, Links, Pair, Pairing, SurfacePair};
use crate::contact::row::{Rows, Wanted};
use rayon::prelude::*;
use signorini_geometry::element::Element;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{
    Anchor, ContactSurface, Facets, Feature, Placement, SurfaceError, SurfaceJet, extended_face,
};
use signorini_geometry::tensor::Vec3;

/// How far points slide, and so how long they keep the tangent plane that they meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SlidingRange {
    /// As far as it goes: the closest point moves with them.
    #[default]
    Finite,
    /// Little within an increment: they keep the tangent plane that they meet at its start.
    Increment,
    /// Little: they keep the tangent plane that they meet first.
    Small,
}

/// Every point of the secondary side against the closest facet.
#[derive(Clone, Debug, Default)]
pub struct PointToSegment {
    // nodes of point k: nodes[first[k]..first[k + 1]]
    first: Vec<u32>,
    nodes: Vec<NodeId>,
    weights: Vec<f64>,
    /// The facet that each point is inside of; `None` where points are nodes.
    facets: Option<Vec<u32>>,
    /// On what closest points may lie.
    pub closest: Closest,
    /// How long points keep the tangent plane that they meet.
    pub sliding: SlidingRange,
    /// A facet that each point is on, where the surface may touch itself; empty elsewhere.
    own: Vec<u32>,
}

/// How far a point that slips may leave the facet it is on, in parameters of the facet, within one increment.
const FAR: f64 = 10.0;

impl PointToSegment {
    /// Every node is a point.
    #[must_use]
    pub fn at_nodes(nodes: &[NodeId]) -> Self {
        Self {
            first: (0..=nodes.len() as u32).collect(),
            nodes: nodes.to_vec(),
            weights: vec![1.0; nodes.len()],
            ..Self::default()
        }
    }

    /// Points inside the facets, `rule` gives those of a facet with their weights; and the area of each point at the
    /// positions `x`, times the `extent` across its facet.
    ///
    /// # Errors
    /// A facet that has no normal.
    pub fn inside(
        facets: &Facets,
        rule: impl Fn(u32, Element) -> FacetPoints,
        x: &[Vec3],
        extent: &dyn Fn(u32, Vec3) -> f64,
    ) -> Result<(Self, Vec<f64>), SurfaceError> {
        let mut points = Self {
            first: vec![0],
            ..Self::default()
        };
        let mut areas = Vec::new();
        let mut of_facet = Vec::new();
        for facet in 0..facets.nfacet() as u32 {
            let element = facets.element(facet);
            let rule = element.map_or_else(Vec::new, |element| rule(facet, element));
            for (xi, weight) in rule {
                let (shape, area) = facets.sample(x, facet, xi)?;
                let nodes = facets.nodes(facet);
                let at: Vec3 = nodes
                    .iter()
                    .zip(shape)
                    .map(|(&n, w)| x.get(n as usize).copied().unwrap_or_default() * w)
                    .sum();
                points.nodes.extend_from_slice(nodes);
                points.weights.extend_from_slice(&shape[..nodes.len()]);
                points.first.push(points.nodes.len() as u32);
                areas.push(weight * area * extent(facet, at));
                of_facet.push(facet);
            }
        }
        points.facets = Some(of_facet);
        Ok((points, areas))
    }
}

impl PointToSegment {
    /// Tells each point a facet it is on: a surface may touch itself only where its normals oppose each other.
    pub fn on(&mut self, facets: &Facets) {
        let holds = |facet: u32, nodes: &[NodeId]| {
            let of_facet = facets.nodes(facet);
            nodes.iter().all(|n| of_facet.contains(n))
        };
        let facet = |row: usize| {
            let nodes = self.point(row).nodes;
            (0..facets.nfacet() as u32).find(|&f| holds(f, nodes))
        };
        self.own = (0..self.nrow())
            .map(|row| facet(row).unwrap_or(0))
            .collect();
    }

    /// The facets near a point that face it.
    fn facing(
        &self,
        row: usize,
        surface: &dyn ContactSurface,
        at: &Placement,
        near: &[u32],
    ) -> Vec<u32> {
        let normal = |facet: u32| {
            let local = surface.domain(facet)?.centre();
            let mut jet = SurfaceJet::default();
            surface.jet(at, &Anchor { facet, local }, &mut jet).ok()?;
            Some(jet.normal)
        };
        let own = self.own.get(row).copied().and_then(normal);
        let faces = |f: &u32| {
            let both = own.zip(normal(*f));
            both.is_some_and(|(own, other)| own.dot(other) < 0.0)
        };
        near.iter().copied().filter(faces).collect()
    }
}

impl Discretization for PointToSegment {
    fn nrow(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    fn point(&self, row: usize) -> Point<'_> {
        let range = match self.first.get(row..) {
            Some([a, b, ..]) => *a as usize..*b as usize,
            _ => 0..0,
        };
        Point {
            nodes: self.nodes.get(range.clone()).unwrap_or(&[]),
            weights: self.weights.get(range).unwrap_or(&[]),
        }
    }

    fn inside(&self) -> Option<&[u32]> {
        self.facets.as_deref()
    }

    fn renews(&self) -> bool {
        self.sliding == SlidingRange::Increment
    }

    fn pair_up(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        near: &Search,
        last: &Pairing,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError> {
        out.pairs.resize(self.nrow(), None);
        let surface = pair.primary.as_ref();
        let choose = |row: usize, found: &mut Option<Pair>| {
            let before = last.pairs.get(row).copied().flatten();
            let point = self.point(row).position(at);
            let mut jet = SurfaceJet::default();
            if let Some(kept) = before.filter(|p| p.held.is_some()) {
                surface.jet(at, &kept.anchor, &mut jet)?;
                let normal = kept.held.unwrap_or_default();
                *found = Some(Pair {
                    gap: (point - jet.position).dot(normal),
                    ..kept
                });
                return Ok(());
            }
            let how = (before.map(|p| p.anchor), pair.reach, self.closest);
            *found = if self.own.is_empty() {
                closest(surface, at, point, near.candidates().near(row), how)?
            } else {
                let facing = self.facing(row, surface, at, near.candidates().near(row));
                closest(surface, at, point, &facing, how)?
            };
            if let Some(found) = found
                .as_mut()
                .filter(|_| self.sliding != SlidingRange::Finite)
            {
                surface.jet(at, &found.anchor, &mut jet)?;
                let away = point - jet.position;
                let normal = match found.feature {
                    Feature::Face => jet.normal,
                    _ => away
                        .normalized()
                        .map_or(jet.normal, |n| n * found.gap.signum()),
                };
                found.held = Some(normal);
            }
            Ok(())
        };
        out.pairs
            .par_iter_mut()
            .enumerate()
            .with_min_len(64)
            .map(|(row, found)| choose(row, found))
            .collect()
    }

    fn row(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        links: &Links<'_>,
        wanted: Wanted,
        out: &mut Rows,
    ) -> Result<(), SurfaceError> {
        let Some(Some(found)) = links.pairing.pairs.get(row) else {
            out.start([]);
            return Ok(());
        };
        let place = Place {
            surface: pair.primary.as_ref(),
            at,
            point: self.point(row),
            found,
            anchor: links.anchors.get(row).and_then(Option::as_ref),
            bond: links.bond,
        };
        place.fill(row, wanted, out)
    }

    /// The closest point of `ρ − slip`, on the continuation of the facet. Where the tangent plane is held, the point has
    /// moved along it since: by what of its distance to `ρ` is not along the normal.
    fn anchor(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        found: &Pair,
        slip: Vec3,
    ) -> Result<Anchored, SurfaceError> {
        let surface = pair.primary.as_ref();
        let mut jet = SurfaceJet::default();
        surface.jet(at, &found.anchor, &mut jet)?;
        let stays = Anchored {
            anchor: found.anchor,
            offset: Vec3::ZERO,
        };
        let moved = found.held.map_or(Vec3::ZERO, |normal| {
            let away = self.point(row).position(at) - jet.position;
            away - normal * away.dot(normal)
        });
        let yielded = slip - moved;
        if yielded == Vec3::ZERO {
            return Ok(stays);
        }
        let back = jet.position - yielded;
        let facet = found.anchor.facet;
        let anchor = if surface.domain(facet).is_some() {
            extended_face(surface, at, found.anchor, back, FAR, &mut jet)?
        } else {
            surface.project(at, facet, back, Some(found.anchor), &mut jet)?
        };
        Ok(anchor.map_or(stays, |p| Anchored {
            anchor: p.anchor,
            offset: Vec3::ZERO,
        }))
    }
}
