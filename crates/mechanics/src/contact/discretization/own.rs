//! What a surface that may touch itself sees of itself.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | n, n_f | `normal`: of a point (the mean of the facets around it), of a facet | unit vectors |
//! | t, t_f | `thickness` of the body behind a point (the least of the facets around it), behind a facet | lengths |
//! | x, ρ | the point, and its closest point on a facet | vectors |
//!
//! A facet that shares no node with a point (or with the facet that it is inside, or a mid node, of) is one that the
//! point may meet where
//!
//! ```text
//! n·n_f < −cos 80°                                                                            (E1)
//! |ρ − x| ≤ min(t, t_f)/2      where x is behind the facet                                    (E2)
//! n·(ρ − x) ≥ −min(t, t_f)/2,  and ≥ |ρ − x| cos 80°  where x is in front of the facet        (E3)
//! ```
//!
//! and of those the closest counts. (E1) leaves out the neighbours on smooth and convex parts, (E3) those next to a tip, (E2) and (E3) the far side
//! of the own body: seen from one side of a slab, the other is at the depth t, and what enters from outside at δ < t/2
//! is nearer to where it came in than to the other side.
//!
//! The line from the middle of a facet into the body leaves it at the first facet of the same body that faces
//! the other way. It is found once, in the reference configuration; the thickness is the present
//! distance of these two places. Behind a facet whose line crosses no such facet the thickness is infinite.
//!
//! Limits: an overlap deeper than half the thickness is none. Sharp tips are thin, and rest on others no deeper than that.

use super::on_facet::OnFacet;
use signorini_geometry::element::Family;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::{Aabb, Bvh};
use signorini_geometry::surface::{
    Anchor, ContactSurface, Facets, Placement, Projection, SurfaceJet,
};
use signorini_geometry::tensor::Vec3;

/// cos 80°, of the angle up to which facets face one another (E1): mortar weights end there, too.
const FACES: f64 = 0.173_648_177_666_930_33;

/// The cosine of the angle up to which facets around a node carry its force.
const BEARS: f64 = 0.5;

/// The distance, over the size of a facet, below which a direction is rounding.
const ROUNDING: f64 = 1e-9;

/// The part of the thickness up to which a point may have entered (E2).
pub(super) const ENTERED: f64 = 0.5;

/// Where lines through the body leave a surface, and which facets are around its points.
#[derive(Clone, Debug, Default)]
pub struct OwnBody {
    /// Where the line into the body from the middle of each facet leaves it.
    pub(super) behind: Vec<Option<Anchor>>,
    /// The area of each facet at the start, its length in the plane.
    area: Vec<f64>,
    // facets around point k: around[first[k]..first[k + 1]]
    first: Vec<u32>,
    around: Vec<u32>,
    /// Whether each point is in the middle of an edge or a facet, and a corner of none.
    pub(super) middle: Vec<bool>,
}

/// Normals and thickness of all facets in a configuration.
#[derive(Clone, Debug, Default)]
pub struct OwnNow {
    normal: Vec<Vec3>,
    /// How far the normals of each facet differ from that at its middle, at most.
    turn: Vec<f64>,
    thickness: Vec<f64>,
}

/// A point of a surface that may touch itself.
#[derive(Clone, Copy, Debug)]
pub struct OwnPoint<'a> {
    /// n.
    pub normal: Vec3,
    /// t.
    pub thickness: f64,
    pub(super) around: &'a [u32],
    pub(super) body: &'a OwnBody,
    pub(super) of: &'a OwnNow,
}

impl OwnBody {
    /// That of a surface with these sorted nodes, in its reference configuration; `body` has a number for the body of each
    /// facet.
    #[must_use]
    pub fn new(points: &[NodeId], facets: &Facets, body: &[u32], at: &Placement) -> Self {
        let n = facets.nfacet() as u32;
        let boxes: Vec<Aabb> = (0..n).map(|f| facets.aabb(at, f)).collect();
        let tree = Bvh::build(&boxes);
        let extent = boxes
            .iter()
            .fold(Aabb::EMPTY, |all, &b| all.union(b))
            .extent();
        let normal: Vec<Vec3> = (0..n).map(|f| middle(facets, at, f).1).collect();
        let mut near = Vec::new();
        let mut leaves = |facet: u32| {
            let (from, out) = middle(facets, at, facet);
            let along = -out * extent.norm();
            let is_behind = |other: u32| {
                let faces_away = normal.get(other as usize).is_some_and(|n| n.dot(out) < 0.0);
                let is_own = body.get(other as usize) == body.get(facet as usize);
                other != facet && is_own && faces_away
            };
            let (s, other) =
                facets.first_crossed(at, &tree, (from, along), &mut near, is_behind)?;
            let mut jet = SurfaceJet::default();
            let found = facets.project(at, other, from + along * s, None, &mut jet);
            found.ok().flatten().map(|found| found.anchor)
        };
        let behind = (0..n).map(&mut leaves).collect();
        let area = (0..n).map(|f| facets.size(at, f).powi(facets.ntan() as i32));
        let area = area.collect();
        let mut of_points = vec![Vec::new(); points.len()];
        let mut is_middle = vec![true; points.len()];
        for facet in 0..n {
            let ncorner = facets.element(facet).map_or(0, |e| e.ncorner());
            for (place, node) in facets.nodes(facet).iter().enumerate() {
                if let Ok(k) = points.binary_search(node) {
                    of_points[k].push(facet);
                    is_middle[k] &= place >= ncorner;
                }
            }
        }
        let mut first = vec![0];
        let mut around = Vec::new();
        for of_point in of_points {
            around.extend(of_point);
            first.push(around.len() as u32);
        }
        Self {
            behind,
            area,
            first,
            around,
            middle: is_middle,
        }
    }

    /// Normals and thickness in a configuration.
    #[must_use]
    pub fn at(&self, surface: &dyn ContactSurface, at: &Placement) -> OwnNow {
        let mut now = OwnNow::default();
        for (facet, behind) in (0..).zip(&self.behind) {
            let (thickness, normal) = self.of_facet(surface, at, facet, *behind);
            now.normal.push(normal);
            now.turn.push(turn(surface, at, facet, normal));
            now.thickness.push(thickness);
        }
        now
    }

    pub(super) fn of_facet(
        &self,
        surface: &dyn ContactSurface,
        at: &Placement,
        facet: u32,
        behind: Option<Anchor>,
    ) -> (f64, Vec3) {
        let (from, normal) = middle(surface, at, facet);
        let mut jet = SurfaceJet::default();
        let to = behind.and_then(|anchor| {
            surface.jet(at, &anchor, &mut jet).ok()?;
            Some(jet.position)
        });
        (to.map_or(f64::INFINITY, |to| (to - from).norm()), normal)
    }

    /// The facets around a point: that of a point inside one, those that meet in a node.
    pub(super) fn facets_of<'a>(
        &'a self,
        point: Option<usize>,
        inside: Option<&'a OnFacet>,
    ) -> &'a [u32] {
        if let Some(inside) = inside {
            return std::slice::from_ref(&inside.facet);
        }
        match point.and_then(|k| self.first.get(k..)) {
            Some([a, b, ..]) => self.around.get(*a as usize..*b as usize).unwrap_or(&[]),
            _ => &[],
        }
    }
}

impl OwnPoint<'_> {
    /// The part of the area around a node that faces a facet with this normal, which the node meets: at an edge of the body,
    /// facets that face elsewhere carry nothing. All of it where none faces that.
    #[must_use]
    pub fn bearing(&self, normal: Vec3) -> f64 {
        let (mut bears, mut all) = (0.0, 0.0);
        for &facet in self.around {
            let area = self.body.area.get(facet as usize).copied();
            let area = area.unwrap_or_default();
            all += area;
            if self.of.normal(facet).dot(normal) < -BEARS {
                bears += area;
            }
        }
        if bears > 0.0 { bears / all } else { 1.0 }
    }
}

impl OwnNow {
    pub(super) fn normal(&self, facet: u32) -> Vec3 {
        self.normal.get(facet as usize).copied().unwrap_or_default()
    }

    fn turn(&self, facet: u32) -> f64 {
        let of_facet = self.turn.get(facet as usize).copied();
        of_facet.unwrap_or(f64::INFINITY)
    }

    pub(super) fn thickness(&self, facet: u32) -> f64 {
        let of_facet = self.thickness.get(facet as usize).copied();
        of_facet.unwrap_or(f64::INFINITY)
    }
}

impl OwnPoint<'_> {
    /// Whether it faces a facet with this normal (E1).
    #[must_use]
    pub fn faces(&self, normal: Vec3) -> bool {
        self.normal.dot(normal) < -FACES
    }

    /// Whether a facet within `bounds` may have a point that this one, at `point`, meets. Most neighbours and the far side of
    /// the own body have none, and need no projection.
    #[must_use]
    pub fn may_meet(&self, facet: u32, bounds: &Aabb, point: Vec3) -> bool {
        if self.normal.dot(self.of.normal(facet)) - self.of.turn(facet) >= -FACES {
            return false; // (E1)
        }
        let deepest = self.deepest(facet);
        let distance = bounds.distance_squared(point).sqrt();
        // what is further away than that is in front, if anything of the facet is
        let least = match distance <= deepest {
            true => -deepest, // (E2)
            false => FACES * distance,
        };
        let slack = ROUNDING * (distance + bounds.extent().norm());
        bounds.furthest(self.normal) - self.normal.dot(point) >= least - slack // (E3)
    }

    /// How deep it may be behind a facet, or that behind it.
    fn deepest(&self, facet: u32) -> f64 {
        ENTERED * self.thickness.min(self.of.thickness(facet))
    }

    /// Whether it meets this closest point: (E1) to (E3).
    #[must_use]
    pub fn meets(&self, point: Vec3, found: &Projection, jet: &SurfaceJet) -> bool {
        let deepest = self.deepest(found.anchor.facet);
        let to = jet.position - point;
        let ahead = self.normal.dot(to);
        let is_behind = to.dot(jet.normal) > 0.0;
        let is_reached = if is_behind {
            found.distance <= deepest
        } else {
            ahead >= FACES * found.distance - ROUNDING * jet.metric[0].sqrt()
        };
        self.faces(jet.normal) && is_reached && ahead >= -deepest
    }
}

/// How far the normals of a facet differ from that at its middle, at most. Those of a face with four nodes are between those
/// at its corners; those of a face that bends may differ by more than at its nodes.
fn turn(surface: &dyn ContactSurface, at: &Placement, facet: u32, middle: Vec3) -> f64 {
    let Some(element) = surface.domain(facet) else {
        return f64::INFINITY;
    };
    if element.is_linear() && element.family() != Family::Quadrilateral {
        return 0.0;
    }
    let mut jet = SurfaceJet::default();
    let mut most: f64 = 0.0;
    for &local in element.nodes() {
        most = match surface.jet(at, &Anchor { facet, local }, &mut jet) {
            Ok(()) => most.max((jet.normal - middle).norm()),
            Err(_) => f64::INFINITY,
        };
    }
    if element.is_linear() {
        most
    } else {
        2.0 * most
    }
}

/// Place and normal of the middle of a facet; no normal where it has none.
pub(super) fn middle(surface: &dyn ContactSurface, at: &Placement, facet: u32) -> (Vec3, Vec3) {
    let mut jet = SurfaceJet::default();
    let local = surface.domain(facet).map(|e| e.centre());
    let found = local.map(|local| surface.jet(at, &Anchor { facet, local }, &mut jet));
    match found {
        Some(Ok(())) => (jet.position, jet.normal),
        _ => (jet.position, Vec3::ZERO),
    }
}
