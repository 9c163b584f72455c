//! Points that alternate between facets.
//!
//! ```text
//!    valley: the surface rises beyond the edge          ridge: it falls beyond the edge
//!
//!      \         /                                           ____ ____
//!       \_______/    ____                                        V
//!          x    <- the edge is the closest                     x   <- either facet, or the other
//! ```
//!
//! The distance of a point inside a body from its surface is smooth across a valley: between the facets lies the edge,
//! over a window as wide as the point is deep times the angle of the edge, and an iteration that steps over the window
//! alternates between the facets for ever. There the point is held to the closest point of the facet it is on, its edge
//! included: that is the closest point once it is in the window, and a spring to a line on the way there. A state that is
//! found with it is one of closest points, or the point goes on ([`Interface::let_restless_go`]).
//!
//! Across a ridge the closest point jumps, and there may be equilibria on both sides or none: the point stays on the
//! continuation of its facet until the increment has ended. So it does where the law presses from a distance: outside
//! the body the closest point jumps across a valley.

use super::judged::NAMED;
use super::{Interface, Multiplier, NodeId, Verdict};
use crate::contact::discretization::Pair;
use crate::contact::discretization::projected::{BEYOND, on_continuation};
use crate::contact::kernel::Laws;
use signorini_geometry::surface::{ContactSurface, Feature, Placement, SurfaceError, SurfaceJet};
use signorini_geometry::tensor::Vec3;

/// Changes within one increment after which a choice is kept.
pub(super) const RESTLESS: u8 = 4;

/// Relative difference below which two distances from the same edge are equal.
const SAME: f64 = 1e-9;

/// The place of a restless point: on the facet that it was on `before`, while `closest` is the closest of all. `on_edges`
/// is whether an edge has a normal.
pub(super) fn place(
    surface: &dyn ContactSurface,
    at: &Placement,
    point: Vec3,
    [before, closest]: [Option<Pair>; 2],
    on_edges: bool,
) -> Result<Option<Pair>, SurfaceError> {
    let Some(before) = before.filter(|p| surface.domain(p.anchor.facet).is_some()) else {
        return Ok(None);
    };
    let Some(continued) = on_continuation(surface, at, before.anchor, point, BEYOND)? else {
        return Ok(None);
    };
    // beyond its own facet, in a valley, the continuation is closer than the surface
    let is_valley = |c: &Pair| c.gap < 0.0 && continued.gap > c.gap * (1.0 - SAME);
    if !(on_edges && closest.as_ref().is_some_and(is_valley)) {
        return Ok(Some(continued));
    }
    let mut jet = SurfaceJet::default();
    let hint = Some(before.anchor);
    let found = surface.project(at, before.anchor.facet, point, hint, &mut jet)?;
    let Some(found) = found.filter(|f| f.feature != Feature::Face) else {
        return Ok(Some(continued));
    };
    if surface.outward(at, &found)?.rim {
        return Ok(Some(continued));
    }
    Ok(Some(Pair {
        anchor: found.anchor,
        feature: found.feature,
        gap: -found.distance,
        held: None,
    }))
}

/// Whether a point that is held to an edge or a vertex would be there by itself.
fn is_closest(kept: &Pair, closest: &Pair) -> bool {
    kept.feature == Feature::Face
        || closest.feature != Feature::Face
            && (kept.gap - closest.gap).abs() <= SAME * closest.gap.abs()
}

impl Interface {
    /// Whether points may rest on edges and vertices, which have no normal where the gap is zero: only where the law has
    /// no force there.
    fn rests_on_edges(&self) -> bool {
        let Laws { law, scale, .. } = self.laws();
        let needs_no_normal =
            law.multiplier() == Multiplier::None && law.pressure(0.0, 0.0, scale).value <= 0.0;
        needs_no_normal && self.parts.discretization.capabilities().rests_on_edges
    }

    /// Puts restless points where they are held.
    pub(super) fn hold_restless(&mut self, at: &Placement) -> Result<(), SurfaceError> {
        let surface = self.parts.pair.primary.as_ref();
        let on_edges = self.rests_on_edges();
        self.astray.clear();
        for (row, changes) in self.changes.iter().enumerate() {
            if *changes < RESTLESS {
                continue;
            }
            let (before, closest) = (self.now.pairs[row], self.next.pairs[row]);
            let point = self.near.points[row];
            let Some(kept) = place(surface, at, point, [before, closest], on_edges)? else {
                continue;
            };
            let elsewhere = closest.filter(|c| !is_closest(&kept, c));
            self.astray.extend(elsewhere.map(|c| (row, c)));
            self.next.pairs[row] = Some(kept);
        }
        Ok(())
    }

    /// Points that are held to an edge while another place is closest go there; returns whether there are any.
    pub(super) fn let_restless_go(&mut self) -> Option<Verdict> {
        let rows = std::mem::take(&mut self.astray);
        let discretization = self.parts.discretization.as_ref();
        let first = |&(row, _): &(usize, Pair)| discretization.point(row).nodes.first().copied();
        let nodes: Vec<NodeId> = rows.iter().filter_map(first).take(NAMED).collect();
        for &(row, closest) in &rows {
            let places = self.now.pairs.get_mut(row).zip(self.changes.get_mut(row));
            if let Some((place, changes)) = places {
                (*place, *changes) = (Some(closest), 0);
            }
        }
        (!rows.is_empty()).then(|| Verdict::Repeat {
            changes: rows.len(),
            closing: false,
            continuous: false,
            why: format!(
                "contact \"{}\": {} at an edge go on to the facet they are closest to",
                self.parts.name,
                rows.len()
            ),
            nodes,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::place;
    use crate::contact::discretization::Pair;
    use crate::contact::discretization::projected::{Closest, Sight, closest};
    use crate::contact::tests::facets;
    use signorini_geometry::surface::{Feature, Placement};
    use signorini_geometry::tensor::Vec3;

    /// Where points behind a roof are held that were on its left half: two facets that meet on the y axis and rise from
    /// there, or fall. Offset across the edge, closest, held.
    fn held(rise: f64, on_edges: bool) -> Vec<(f64, Pair, Option<Pair>)> {
        let at = |x: f64, y: f64| Vec3::new(x, y, rise * x.abs());
        let corners = [
            (-1.0, -1.0),
            (0.0, -1.0),
            (0.0, 1.0),
            (-1.0, 1.0),
            (1.0, -1.0),
            (1.0, 1.0),
        ];
        let mut x: Vec<Vec3> = corners.iter().map(|&(x, y)| at(x, y)).collect();
        let surface = facets(&mut x, &[vec![0, 1, 2, 3], vec![1, 4, 5, 2]]);
        let placement = Placement { x: &x, poses: &[] };
        let find = |point: Vec3, near: &[u32]| {
            let sight = Sight {
                hint: None,
                on: Closest::Anywhere,
                reach: &|_| 1.0,
                deepest: None,
                own: None,
            };
            closest(&surface, &placement, point, near, &sight)
                .unwrap()
                .unwrap()
        };
        let before = find(Vec3::new(-0.3, 0.1, 0.3 * rise), &[0, 1]);
        let offsets = [-0.2, -0.02, -1e-4, 0.0, 1e-4, 0.02, 0.2];
        let one = |off: f64| {
            let point = Vec3::new(off, 0.1, -0.01 + rise * off.abs().min(0.01));
            let closest = find(point, &[0, 1]);
            let pairs = [Some(before), Some(closest)];
            let kept = place(&surface, &placement, point, pairs, on_edges).unwrap();
            let from_edge = (off * off + point.z * point.z).sqrt();
            (from_edge, closest, kept)
        };
        offsets.map(one).to_vec()
    }

    #[test]
    fn a_restless_point_in_a_valley_is_on_its_facet_or_on_the_edge() {
        for rise in [0.02, 0.3] {
            let mut on_edge = 0;
            for (from_edge, closest, kept) in held(rise, true) {
                let kept = kept.unwrap();
                assert!(
                    kept.gap <= closest.gap * (1.0 - 1e-12),
                    "{kept:?} {closest:?}"
                );
                if kept.feature == Feature::Face {
                    assert_eq!((kept.anchor.facet, closest.anchor.facet), (0, 0));
                } else {
                    on_edge += 1;
                    assert!((kept.gap + from_edge).abs() < 1e-12);
                }
            }
            assert!(on_edge >= 4, "{on_edge}");
        }
    }

    #[test]
    fn a_restless_point_under_a_ridge_or_without_normals_of_edges_stays_on_the_continuation() {
        for (rise, on_edges) in [(-0.02, true), (-0.3, true), (0.02, false), (-0.3, false)] {
            for (_, _, kept) in held(rise, on_edges) {
                let kept = kept.unwrap();
                assert_eq!((kept.feature, kept.anchor.facet), (Feature::Face, 0));
            }
        }
    }
}
