//! The closest facet that faces a point.

use super::flat;
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::proximity::{Aabb, Bvh};
use signorini_geometry::surface::{
    Anchor, Carrier, ContactSurface, Feature, Placement, Projection, SurfaceJet,
};
use signorini_geometry::tensor::Vec3;

/// The largest cosine between the normals of two facets that may touch.
const FACING: f64 = 0.3;
/// The same of a surface that touches itself.
const FACING_ITSELF: f64 = -0.2;
/// The same past the end of a surface, where the side of a body may be next to its face.
const SQUARELY: f64 = -0.5;
/// How far past the end of a surface a point still meets it, over its size.
const RIM: f64 = 0.1;
/// Distances below this part of a size are none: on the surface there is no direction to the closest point.
const ON: f64 = 1e-9;

/// How many facets are compared by their closest points.
const NEAR: usize = 4;
/// How much further away than the closest facet, over the size of the smallest.
const SLACK: f64 = 0.01;

/// A surface among whose facets the closest is looked for.
pub struct Finder<'a> {
    surface: &'a dyn ContactSurface,
    tree: Bvh,
    at: Placement<'a>,
    /// Where all is now, if `at` is the start.
    now: Option<Placement<'a>>,
    same: bool,
    /// How much further away than the closest facet one may be as a flat one and be looked at.
    slack: f64,
}

/// A point that looks for a facet.
#[derive(Clone, Copy)]
pub struct Seeker<'a> {
    pub point: Vec3,
    /// How far it has moved since the start.
    pub moved: Vec3,
    /// The normal of its own side, not of unit length; zero where it has none.
    pub normal: Vec3,
    /// How far it looks.
    pub within: f64,
    /// Facets of its own.
    pub own: &'a [u32],
}

/// The points found.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    pub facet: u32,
    /// Signed distance: negative where the point is inside.
    pub gap: f64,
    /// The normal of the surface there.
    pub normal: Vec3,
    /// Whether it is on an edge or a vertex, and not flush with it.
    pub sharp: bool,
    /// The larger curvature.
    pub curvature: f64,
    /// Where the geometry of the start is held: the way along the other side times the sine of the angle between the normals
    /// of both sides. The normal that is held may be either, or between.
    pub lean: f64,
}

impl<'a> Finder<'a> {
    pub fn new(
        surface: &'a dyn ContactSurface,
        at: Placement<'a>,
        now: Option<Placement<'a>>,
        same: bool,
    ) -> Self {
        let aabb = |facet| surface.aabb(&at, facet);
        let boxes: Vec<Aabb> = (0..surface.nfacet() as u32).map(aabb).collect();
        let bounded = boxes.iter().filter(|b| b.is_bounded());
        let size = bounded
            .map(|b| b.extent().max_abs())
            .fold(f64::INFINITY, f64::min);
        Self {
            surface,
            slack: if size.is_finite() { SLACK * size } else { 0.0 },
            tree: Bvh::build(&boxes),
            at,
            now,
            same,
        }
    }

    /// The closest facet that faces a point, within the distance that it looks; what has no normal is not looked at. Facets
    /// are compared as flat pieces; those that are as close as the closest, but for a little, by their closest points.
    pub fn find(&self, seeker: &Seeker<'_>) -> Option<Met> {
        let mut jet = SurfaceJet::default();
        let mut near = [(f64::INFINITY, u32::MAX); NEAR];
        self.tree.visit_near(seeker.point, |facet| {
            let looked = (!seeker.own.contains(&facet))
                .then(|| self.look(facet, seeker, &mut jet))
                .flatten();
            if let Some(distance) = looked.filter(|d| *d <= seeker.within) {
                let place = near.partition_point(|n| *n < (distance, facet));
                // the furthest gives way
                if place < NEAR {
                    near[place..].rotate_right(1);
                    near[place] = (distance, facet);
                }
            }
            near[0].0.min(seeker.within) + self.slack
        });
        let limit = near[0].0 + self.slack;
        let mut best: Option<Projection> = None;
        for &(_, facet) in near.iter().filter(|n| n.0.is_finite() && n.0 <= limit) {
            let found = self.project(facet, seeker.point, &mut jet);
            let rank = |f: &Projection| u8::from(f.feature != Feature::Face);
            if let Some(found) = found
                && best.is_none_or(|b| {
                    let ties = found.distance <= b.distance * (1.0 + 1e-12);
                    let closer = found.distance < b.distance * (1.0 - 1e-12);
                    closer || ties && rank(&found) < rank(&b)
                })
            {
                best = Some(found);
            }
        }
        self.met(best?, seeker, &mut jet)
    }

    /// The closest point of a facet.
    fn project(&self, facet: u32, point: Vec3, jet: &mut SurfaceJet) -> Option<Projection> {
        let hint = self.surface.domain(facet).map(|e| Anchor {
            facet,
            local: e.centre(),
        });
        let found = self.surface.project(&self.at, facet, point, hint, jet);
        found.ok().flatten()
    }

    /// About how far a facet is that faces the point.
    fn look(&self, facet: u32, seeker: &Seeker<'_>, jet: &mut SurfaceJet) -> Option<f64> {
        let facing = if self.same { FACING_ITSELF } else { FACING };
        let faces = |normal: Vec3| {
            let sizes = (seeker.normal.norm_squared() * normal.norm_squared()).sqrt();
            sizes == 0.0 || seeker.normal.dot(normal) <= facing * sizes
        };
        let (Carrier::Nodes(nodes), Some(element)) =
            (self.surface.carrier(facet), self.surface.domain(facet))
        else {
            let found = self.project(facet, seeker.point, jet)?;
            return faces(jet.normal).then_some(found.distance);
        };
        let mut x = [Vec3::ZERO; MAX_FACET_NODES];
        for (x, &node) in x.iter_mut().zip(nodes) {
            *x = *self.at.x.get(node as usize)?;
        }
        let (distance, normal) = flat::distance(element, x.get(..nodes.len())?, seeker.point)?;
        faces(normal).then_some(distance)
    }

    /// A closest point with its gap and normal; none past the end of the surface.
    fn met(&self, found: Projection, seeker: &Seeker<'_>, jet: &mut SurfaceJet) -> Option<Met> {
        let anchor = found.anchor;
        self.surface.jet(&self.at, &anchor, jet).ok()?;
        let away = seeker.point - jet.position;
        let size = self.surface.size(&self.at, anchor.facet);
        let mut met = Met {
            facet: anchor.facet,
            gap: away.dot(jet.normal),
            normal: jet.normal,
            sharp: false,
            curvature: curvature(jet),
            lean: 0.0,
        };
        if found.feature != Feature::Face && found.distance > ON * size {
            let outward = self.surface.outward(&self.at, &found).ok()?;
            let beside = (away - jet.normal * met.gap).norm();
            if outward.rim {
                let normal = seeker.normal.normalized();
                let past = normal.is_some_and(|n| n.dot(jet.normal) > SQUARELY);
                if past || beside > RIM * size {
                    return None;
                }
            } else {
                met.sharp = beside > ON.sqrt() * size;
                met.gap = found.distance.copysign(away.dot(outward.direction));
                if let Some(direction) = away.normalized() {
                    met.normal = direction * met.gap.signum();
                }
            }
        }
        if let Some(now) = &self.now {
            let before = jet.position;
            self.surface.jet(now, &anchor, jet).ok()?;
            let way = seeker.moved - (jet.position - before);
            let along = met.normal.dot(way);
            met.gap += along;
            let own = seeker.normal.normalized().unwrap_or(-met.normal);
            met.lean = (way - met.normal * along).norm() * own.cross(met.normal).norm();
        }
        Some(met)
    }
}

/// The larger curvature along the parameters.
fn curvature(jet: &SurfaceJet) -> f64 {
    let along = |a: usize| {
        let length = jet.metric[a];
        if length > 0.0 {
            (jet.normal.dot(jet.curvature[a]) / length).abs()
        } else {
            0.0
        }
    };
    along(0).max(along(1))
}
