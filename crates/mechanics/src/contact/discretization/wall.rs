//! The body behind two sides that are both of it, such as the strips of a wire that touch where it is wound.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | t_e, t_f | thickness of the body behind a facet of either side | lengths |
//!
//! Seen from one face of a wall, the other faces it, at the depth t. Facets of one body may therefore be inside one another by
//!
//! ```text
//! min(t_e, t_f)/2                                                                             (E1)
//! ```
//!
//! as they may where a [surface touches itself](super::OwnBody). The line from the middle of a facet into the body goes out
//! of outer faces and into others until it has left the body for good. Where it leaves more often than it enters by k, the
//! place is in k parts of the body at once: one part touches or overlaps another. The facet itself is of the deepest, for
//! overlaps of more than half a thickness are refused at the start: that ends where the line has left k times more often than
//! it has entered. It is found once, in the reference configuration; the thickness is the present distance of these two
//! places.
//!
//! Limits: an overlap deeper than half the thickness is none.

use super::own::middle;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::{Aabb, Bvh};
use signorini_geometry::surface::{Anchor, ContactSurface, Facets, Placement, SurfaceJet};
use signorini_geometry::tensor::Vec3;

/// Places along a line that differ by this part of the size of a facet are one: it crosses an edge, or parts touch there.
const ROUNDING: f64 = 1e-9;

/// Where the body behind each facet of two sides ends.
#[derive(Clone, Debug)]
pub struct Wall {
    /// The outer faces of these bodies.
    skin: Facets,
    /// From each facet of the secondary side and of the primary side, a place on the skin.
    ends: [Vec<Option<Anchor>>; 2],
    pub(super) around: [Around; 2],
}

/// The facets around the nodes of a side.
#[derive(Clone, Debug)]
pub(super) struct Around {
    /// Nodes, sorted, once for each facet around them; and these.
    nodes: Vec<NodeId>,
    facets: Vec<u32>,
}

impl Around {
    fn new(side: &Facets) -> Self {
        let all = 0..side.nfacet() as u32;
        let of_facet = |facet: u32| side.nodes(facet).iter().map(move |&node| (node, facet));
        let mut around: Vec<(NodeId, u32)> = all.flat_map(of_facet).collect();
        around.sort_unstable();
        let (nodes, facets) = around.into_iter().unzip();
        Self { nodes, facets }
    }

    pub fn of(&self, node: NodeId) -> &[u32] {
        let first = self.nodes.partition_point(|n| *n < node);
        let last = self.nodes.partition_point(|n| *n <= node);
        self.facets.get(first..last).unwrap_or(&[])
    }
}

impl Wall {
    /// That behind a secondary and a primary side in their reference configuration; the skin is that of their bodies, and each of
    /// the three has the number of the body behind each facet.
    #[must_use]
    pub fn behind(sides: [(&Facets, &[u32]); 2], skin: (Facets, &[u32]), at: &Placement) -> Self {
        let (facets, of_facet) = &skin;
        let lines = Lines::new(facets, of_facet, at);
        let ends = sides.map(|side| lines.ends(side));
        Self {
            skin: skin.0,
            ends,
            around: sides.map(|(side, _)| Around::new(side)),
        }
    }

    /// The same where the sides change places.
    #[must_use]
    pub fn swapped(&self) -> Self {
        let mut swapped = self.clone();
        swapped.ends.reverse();
        swapped.around.reverse();
        swapped
    }

    /// The present distances of the middles of a facet of the secondary side and of one of the primary side from the ends of
    /// the body behind them.
    pub(super) fn thicknesses(
        &self,
        surfaces: [&dyn ContactSurface; 2],
        facets: [u32; 2],
        at: &Placement,
    ) -> [f64; 2] {
        let ([a, b], [of_a, of_b], [ends_a, ends_b]) = (surfaces, facets, &self.ends);
        [
            self.thickness(a, of_a, ends_a, at),
            self.thickness(b, of_b, ends_b, at),
        ]
    }

    fn thickness(
        &self,
        surface: &dyn ContactSurface,
        facet: u32,
        ends: &[Option<Anchor>],
        at: &Placement,
    ) -> f64 {
        let Some(end) = ends.get(facet as usize).copied().flatten() else {
            return f64::INFINITY;
        };
        let mut jet = SurfaceJet::default();
        let place = self.skin.jet(at, &end, &mut jet).map(|()| jet.position);
        place.map_or(f64::INFINITY, |place| {
            (place - middle(surface, at, facet).0).norm()
        })
    }
}

/// Lines into bodies, and the skin that they go through.
struct Lines<'a> {
    skin: &'a Facets,
    body: &'a [u32],
    at: &'a Placement<'a>,
    tree: Bvh,
    normals: Vec<Vec3>,
    /// How long a line is.
    length: f64,
}

impl<'a> Lines<'a> {
    fn new(skin: &'a Facets, body: &'a [u32], at: &'a Placement<'a>) -> Self {
        let all = 0..skin.nfacet() as u32;
        let boxes: Vec<Aabb> = all.clone().map(|facet| skin.aabb(at, facet)).collect();
        let whole = boxes.iter().fold(Aabb::EMPTY, |all, &one| all.union(one));
        Self {
            tree: Bvh::build(&boxes),
            normals: all.map(|facet| middle(skin, at, facet).1).collect(),
            length: whole.extent().norm(),
            skin,
            body,
            at,
        }
    }

    /// Where the body behind each facet of a side ends.
    fn ends(&self, (side, body): (&Facets, &[u32])) -> Vec<Option<Anchor>> {
        let (mut near, mut crossed) = (Vec::new(), Vec::new());
        let of_facet = (0..side.nfacet() as u32).zip(body);
        of_facet
            .map(|(facet, &body)| self.end((side, facet, body), &mut near, &mut crossed))
            .collect()
    }

    /// `crossed` has the places on the line with what is crossed there, and whether that is a way out.
    fn end(
        &self,
        (side, facet, body): (&Facets, u32, u32),
        near: &mut Vec<u32>,
        crossed: &mut Vec<(f64, u32, bool)>,
    ) -> Option<Anchor> {
        let (start, outward) = middle(side, self.at, facet);
        let along = -outward * self.length;
        let own = side.face(facet);
        self.tree.crossed(start, along, near);
        crossed.clear();
        for &other in near.iter() {
            let is_own = own.is_some() && self.skin.face(other) == own;
            if is_own || self.body.get(other as usize) != Some(&body) {
                continue;
            }
            if let Some(s) = self.skin.crossing(self.at, other, start, along) {
                let normal = self.normals.get(other as usize).copied();
                crossed.push((s, other, normal.unwrap_or_default().dot(outward) < 0.0));
            }
        }
        let rounding = ROUNDING * side.size(self.at, facet) / self.length;
        // where a part touches the far end, the line leaves the own part before it enters that one
        let place = |one: &(f64, u32, bool)| if one.2 { one.0 } else { one.0 + rounding };
        crossed.sort_by(|a, b| place(a).total_cmp(&place(b)).then(a.1.cmp(&b.1)));
        crossed.dedup_by(|b, a| b.2 == a.2 && b.0 - a.0 <= rounding);
        let change = |is_out: bool| if is_out { 1 } else { -1 };
        let parts: i32 = crossed.iter().map(|one| change(one.2)).sum();
        let mut left = 0;
        let last = crossed.iter().find(|one| {
            left += change(one.2);
            left == parts.max(1)
        });
        let &(s, other, _) = last?;
        let mut jet = SurfaceJet::default();
        let found = self
            .skin
            .project(self.at, other, start + along * s, None, &mut jet);
        found.ok().flatten().map(|found| found.anchor)
    }
}
