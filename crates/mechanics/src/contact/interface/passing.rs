//! Whether a point has gone through a surface on the way of an increment, wherever it came from.
//!
//! | symbol | name in code |
//! |---|---|
//! | x⁰, x | the point when the increment began, and now |
//! | v, v_f | how it and the nodes of a facet, in the mean, have moved meanwhile: `motion` |
//!
//! In the frame that goes with a facet, the point has come along
//!
//! ```text
//! x − (v − v_f) + s (v − v_f),   0 ≤ s ≤ 1                                                    (E1)
//! ```
//!
//! Where that crosses the facet from its front, and the point is not behind a facet that faces the same way, contact would
//! be lost without ever having been noticed, or push to the wrong side. A point that was closed starts in front by what
//! it was behind. Only points are looked at that have moved as far as they were away, and do not meet the facet that they
//! met before, or one of its neighbours; of facets those that are met on the way ([`Sweep`]). What goes along with the
//! surface, as far as it may be, meets none.
//!
//! Neglected: that a facet turns within the increment.

use super::{Carrier, Interface};
use crate::contact::discretization::{NOWHERE, OwnPoint, REACH};
use signorini_geometry::proximity::{Aabb, Sweep};
use signorini_geometry::surface::{Anchor, Placement, SurfaceJet};
use signorini_geometry::tensor::Vec3;

impl Interface {
    /// The row of a point, and what to say of it, that has gone through the surface within the increment and is not held back.
    pub(super) fn went_through(&self, at: &Placement) -> Option<(usize, String)> {
        let pair = &self.parts.pair;
        let discretization = self.parts.discretization.as_ref();
        let of = discretization.capabilities();
        let knows = !pair.sizes.primary.is_empty() && pair.start.len() == at.x.len();
        if !knows || !self.is_active() || self.parts.bond.is_some() || of.averaged.is_some() {
            return None;
        }
        let surface = pair.primary.as_ref();
        let nfacet = surface.nfacet() as u32;
        let fastest = (0..nfacet)
            .map(|f| self.motion_of(f, at).norm())
            .fold(0.0, f64::max);
        let smallest = pair.sizes.primary.iter().copied();
        let of_facets = [fastest, smallest.fold(f64::INFINITY, f64::min)];
        let rows =
            (0..self.now.pairs.len()).filter(|&row| self.may_have_passed(row, of_facets, at));
        let rows: Vec<usize> = rows.collect();
        if rows.is_empty() {
            return None;
        }
        let before = Placement {
            x: &pair.start,
            poses: at.poses,
        };
        let boxes =
            |at: &Placement| -> Vec<Aabb> { (0..nfacet).map(|f| surface.aabb(at, f)).collect() };
        let sweep = Sweep::new(&boxes(&before), &boxes(at));
        let own = pair.own.as_ref().map(|own| own.at(surface, at));
        let mut near = Vec::new();
        for row in rows {
            let nodes = discretization.point(row).nodes;
            let inside = of.inside.and_then(|points| points.get(row));
            let own = own
                .as_ref()
                .and_then(|now| pair.own_point(nodes, inside, now));
            let to = discretization.point(row).position(at);
            let from = discretization.point(row).position(&before) + self.set_back(row);
            sweep.met([from, to], 0.0, &mut near);
            let crossed = near
                .iter()
                .any(|&f| self.crosses(row, f, [from, to], own, at));
            if crossed {
                let way = (to - from).norm();
                return Some((
                    row,
                    format!("a point went {way:.3} through the surface in one increment"),
                ));
            }
        }
        None
    }

    /// How a facet has moved since the increment began.
    fn motion_of(&self, facet: u32, at: &Placement) -> Vec3 {
        let pair = &self.parts.pair;
        match pair.primary.carrier(facet) {
            Carrier::Nodes(nodes) => pair.mean_motion(nodes, at),
            Carrier::Rigid(_) | Carrier::Fixed => Vec3::ZERO,
        }
    }

    /// Whether a row may have gone through, where no facet has moved further than `fastest` or is smaller than
    /// `smallest`.
    fn may_have_passed(&self, row: usize, [fastest, smallest]: [f64; 2], at: &Placement) -> bool {
        let pair = &self.parts.pair;
        let (before, now) = (&self.accepted.pairs[row], &self.now.pairs[row]);
        if now.is_some_and(|p| p.held.is_some() || p.anchor == NOWHERE) {
            return false;
        }
        if let (Some(before), Some(now)) = (before, now) {
            let (a, b) = (before.anchor.facet, now.anchor.facet);
            if a == b || pair.primary.neighbours(a).contains(&b) {
                return false;
            }
        }
        let of = self.parts.discretization.as_ref();
        let away = match before {
            Some(before) => before.gap.max(0.0),
            None => REACH * pair.size_of_row(of, row).max(smallest),
        };
        pair.motion_of_row(of, row, at).norm() + fastest > away
    }

    /// By how much a point that was behind its facet starts in front of it.
    fn set_back(&self, row: usize) -> Vec3 {
        let pair = &self.parts.pair;
        let before = self.accepted.pairs[row].filter(|p| p.gap <= 0.0);
        let normal = before.and_then(|p| {
            let at = Placement {
                x: &pair.start,
                poses: &[],
            };
            let mut jet = SurfaceJet::default();
            let found = pair.primary.jet(&at, &p.anchor, &mut jet);
            found.ok().map(|()| jet.normal * (-2.0 * p.gap))
        });
        normal.unwrap_or_default()
    }

    /// (E1).
    fn crosses(
        &self,
        row: usize,
        facet: u32,
        [from, to]: [Vec3; 2],
        own: Option<OwnPoint<'_>>,
        at: &Placement,
    ) -> bool {
        let pair = &self.parts.pair;
        let surface = pair.primary.as_ref();
        let way = to - from - self.motion_of(facet, at);
        let Some(local) = surface.domain(facet).map(|e| e.centre()) else {
            return false;
        };
        let mut jet = SurfaceJet::default();
        let anchor = Anchor { facet, local };
        if surface.jet(at, &anchor, &mut jet).is_err() || jet.normal.dot(way) >= 0.0 {
            return false;
        }
        let nodes = self.parts.discretization.point(row).nodes;
        if own.is_some_and(|own| !own.faces(jet.normal))
            || pair.same && pair.is_next_to(nodes, facet)
        {
            return false;
        }
        let crossed = surface.crossing(at, facet, to - way, way);
        crossed.is_some_and(|s| s <= 1.0) && !self.is_held_back(row, jet.normal, at)
    }

    /// Whether a row is behind the facet it meets, and that facet faces the same way as a normal.
    fn is_held_back(&self, row: usize, normal: Vec3, at: &Placement) -> bool {
        let mut jet = SurfaceJet::default();
        self.now.pairs[row].is_some_and(|found| {
            let surface = self.parts.pair.primary.as_ref();
            let known = surface.jet(at, &found.anchor, &mut jet).is_ok();
            known && found.gap <= 0.0 && jet.normal.dot(normal) > 0.0
        })
    }
}
