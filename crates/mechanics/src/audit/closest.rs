//! The closest facet that faces a point.

use signorini_geometry::proximity::{Aabb, Bvh};
use signorini_geometry::surface::{
    Anchor, ContactSurface, Feature, Placement, Projection, SurfaceJet,
};
use signorini_geometry::tensor::Vec3;

/// The largest cosine between the normals of two facets that may touch.
const FACING: f64 = 0.3;
/// The same of a surface that touches itself.
const FACING_ITSELF: f64 = -0.2;
/// The same past the end of a surface, where the side of a body may be beside its face.
const SQUARELY: f64 = -0.5;
/// How far past the end of a surface a point still meets it, over its size.
const RIM: f64 = 0.1;
/// Distances below this part of a size are none: on the surface there is no direction to the closest point.
const ON: f64 = 1e-9;

/// A surface among whose facets the closest is looked for.
pub struct Finder<'a> {
    surface: &'a dyn ContactSurface,
    tree: Bvh,
    /// The facets in the tree; all of them where there are none here.
    only: Option<Vec<u32>>,
    at: Placement<'a>,
    /// Where all is now, if `at` is the start.
    now: Option<Placement<'a>>,
    same: bool,
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

/// What it has found.
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
}

impl<'a> Finder<'a> {
    pub fn new(
        surface: &'a dyn ContactSurface,
        only: Option<Vec<u32>>,
        at: Placement<'a>,
        now: Option<Placement<'a>>,
        same: bool,
    ) -> Self {
        let aabb = |facet| surface.aabb(&at, facet);
        let boxes: Vec<Aabb> = match &only {
            Some(facets) => facets.iter().map(|&f| aabb(f)).collect(),
            None => (0..surface.nfacet() as u32).map(aabb).collect(),
        };
        Self {
            surface,
            tree: Bvh::build(&boxes),
            only,
            at,
            now,
            same,
        }
    }

    /// The closest facet that faces a point, within the distance that it looks; what has no normal is not looked at.
    pub fn find(&self, seeker: &Seeker<'_>) -> Option<Met> {
        let mut jet = SurfaceJet::default();
        let mut best: Option<Projection> = None;
        let facing = if self.same { FACING_ITSELF } else { FACING };
        let own = seeker.normal.normalized();
        self.tree.visit_near(seeker.point, |k| {
            let within = best.map_or(seeker.within, |b| b.distance);
            let facet = match &self.only {
                Some(facets) => facets.get(k as usize).copied().unwrap_or(k),
                None => k,
            };
            let excluded = seeker.own.contains(&facet);
            let hint = self.surface.domain(facet).map(|e| Anchor {
                facet,
                local: e.centre(),
            });
            if excluded {
                return within;
            }
            let found = self
                .surface
                .project(&self.at, facet, seeker.point, hint, &mut jet);
            let Ok(Some(found)) = found else {
                return within;
            };
            if own.is_some_and(|n| n.dot(jet.normal) > facing) {
                return within;
            }
            let closer = found.distance < within
                || best.is_some_and(|b| {
                    let ties = found.distance <= b.distance * (1.0 + 1e-12);
                    let rank = |f: &Projection| u8::from(f.feature != Feature::Face);
                    ties && (rank(&found), facet) < (rank(&b), b.anchor.facet)
                });
            if closer {
                best = Some(found);
                return found.distance.min(within);
            }
            within
        });
        self.met(best?, seeker, &mut jet)
    }

    /// What is known of a closest point; none past the end of the surface.
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
            met.gap += met.normal.dot(seeker.moved - (jet.position - before));
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
