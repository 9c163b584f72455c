//! Rows at tips, rolling edges and rims: normals that follow the tilt, and nodes that are compared with their closest points.
//!
//! Where a body rolls over an edge, facets are tilted against the surface they rest on. A pressure along the normal of a
//! tilted facet is not one along that of the surface, and friction along the facet not friction along the surface. The tilt of row j
//! is the angle between the mean normals of the facets around its node and of those they meet, beyond the turn between facets
//! of both sides at the start,
//!
//! ```text
//! N = Σ_e ν_e D_j^e,  M = Σ_e μ_e D_j^e,  θ_j = max(0, ∠(N, M) − τ_j/2)                      (E1)
//! ```
//!
//! with the mean normal `μ_e` of the primary facets that cover e, and the largest angle `τ_j` between neighbours, of the
//! facets around j plus of those that they meet. Facets of a circle are thus not tilted against a plane, and results of
//! smooth surfaces stay.
//!
//! *Normals that turn.* From a tilt of [`UPRIGHT`] on, row j acts along
//!
//! ```text
//! ν_ej = q/|q|,  q = (1 − s_j) ν_e + s_j μ_e,  s_j = x² (3 − 2x) θ_j/∠(N, M),
//!                                              x = (θ_j − θ0)/(θ1 − θ0) within [0, 1]        (E2)
//! ```
//!
//! by its tilt, which between flat sides is all of the angle, and between curved ones what facets do not turn anyway.
//! on each facet e. D and M stay, and with them linear momentum; the moment of a pressure is off by the tilt times the
//! gap.
//!
//! *Points.* At an edge or the rim of the secondary side, a row compares its node with its closest point where the facets
//! around it meet nothing, or are tilted by more than [`STEEP`], until the tilt falls below [`FLUSH`]. So does any row that is
//! closed though its facets are apart everywhere (`clearance`), as means of curved and kinked gaps may be, until its mean
//! says no less than its points. The function ψ_j of a row that compares its
//! node goes to the other nodes of each facet, so that uniform pressures and linear gaps are still exact.
//!
//! Both are chosen where an iterate has converged, and hold while an iteration goes on: derivatives of `s_j` are none. As
//! the tilt depends on the normals in turn, `s_j` follows it closely at the start of an increment only, and within it where
//! a normal is off by more than a degree.

use super::clearance::{Flat, least_gap};
use super::facets::nodes_of;
use super::{Mortar, NOWHERE, Normals};
use crate::contact::discretization::{Anchored, Pair, Pairing, SlidingRange, SurfacePair};
use crate::contact::mortar::{Guests, OfFacet, Weights};
use signorini_geometry::element::Element;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets, Feature, Placement, SurfaceJet};
use signorini_geometry::tensor::Vec3;

/// θ0 of (E2): a quarter of a degree. Up to here a row keeps its normals.
const UPRIGHT: f64 = 0.0044;

/// θ1 of (E2): 1 degree. From here on a row acts along the normals of the primary side.
const TURNED: f64 = 0.0175;

/// The mean gap, relative to the distance between nodes, below which a row counts as closed.
const CLOSED: f64 = 1e-4;

/// How far, relative to the distance between nodes, the gap must exceed the mean everywhere for this to be false.
const APART: f64 = 1e-2;

/// The mean gap, relative to the distance between nodes, below which a row that compares points is tested for its mean.
const NEAR: f64 = 0.5;

/// The angles, 0.05 and 1 degree, from which on a turn of a normal by (E2) is applied: at the start of an increment, and
/// within it. The tilt depends on the normals in turn, so that an iteration for both converges slowly.
const CLOSELY: f64 = 0.00087;
const FAR_BEHIND: f64 = 0.0175;

/// The tilt above which rows at edges and rims compare points: 30 degrees.
const STEEP: f64 = 0.52;

/// The tilt below which rows at edges and rims compare facets again: 1.5 degrees.
const FLUSH: f64 = 0.026;

/// The gap of a point to a facet; `None` where its closest point is not inside the facet.
fn gap_inside(
    surface: &dyn ContactSurface,
    facet: u32,
    point: Vec3,
    at: &Placement,
) -> Option<f64> {
    let mut jet = SurfaceJet::default();
    let found = surface.project(at, facet, point, None, &mut jet).ok()??;
    let inside = found.feature == Feature::Face;
    inside.then(|| (point - jet.position).dot(jet.normal))
}

/// The smallest gap at nodes of a secondary and a primary facet that have a closest point inside the other, and, in space,
/// where edges of their planes cross.
fn least_gap_of(
    (facets, facet): (&Facets, u32),
    (pair, other): (&SurfacePair, u32),
    nu: Vec3,
    at: &Placement,
) -> Option<f64> {
    let x = |n: &NodeId| at.x.get(*n as usize).copied().unwrap_or_default();
    let (own, others) = (facets.nodes(facet), nodes_of(pair, other));
    let primary = pair.primary.as_ref();
    let of_own = own
        .iter()
        .filter_map(|n| gap_inside(primary, other, x(n), at));
    let least = of_own.fold(f64::INFINITY, f64::min);
    let of_others = others
        .iter()
        .filter_map(|n| gap_inside(facets, facet, x(n), at));
    let least = of_others.fold(least, f64::min);
    let flat = || {
        let corners = |element: Option<Element>, nodes: &[NodeId]| -> Vec<Vec3> {
            let n = element.map_or(0, |e| e.ncorner());
            nodes.iter().take(n).map(x).collect()
        };
        let own = corners(facets.element(facet), own);
        let others = corners(primary.domain(other), others);
        let normal = normal_of(&others)?;
        let [own, others] =
            [(&own, -nu), (&others, normal)].map(|(corners, normal)| Flat { corners, normal });
        least_gap(own, others, nu)
    };
    let crossing = if facets.ntan() == 1 { None } else { flat() };
    let least = least.min(crossing.unwrap_or(f64::INFINITY));
    least.is_finite().then_some(least)
}

/// The normal of a facet with these corners.
fn normal_of(corners: &[Vec3]) -> Option<Vec3> {
    let normal = match *corners {
        [a, b, c] => (b - a).cross(c - a),
        [a, b, c, d] => (c - a).cross(d - b),
        _ => return None,
    };
    normal.normalized()
}

impl Mortar {
    /// The tilt (E1) of a row, and the angle between both normals; `None` where its facets meet nothing.
    fn tilt(&self, row: usize, weights: &Weights) -> Option<(f64, f64)> {
        let (mut own, mut opposite) = (Vec3::ZERO, Vec3::ZERO);
        let mut turning: f64 = 0.0;
        for &(facet, place) in &self.around[row] {
            let of: &OfFacet = weights.facets.get(facet as usize)?;
            if of.met.is_empty() {
                continue;
            }
            own += of.normal * of.d[place];
            let largest = of.met.iter().map(|&f| self.sight.turning(f));
            turning = largest.fold(turning, f64::max);
            opposite += of.opposite.normalized().unwrap_or_default() * of.d[place];
        }
        let (own, opposite) = (own.normalized()?, opposite.normalized()?);
        let angle = own.cross(opposite).norm().atan2(own.dot(opposite));
        let tilt = angle - 0.5 * (turning + self.turning[row]);
        Some((tilt.max(0.0), angle))
    }

    /// Chooses the rows that compare points, among those in use: they leave their functions to others.
    pub(super) fn choose_points(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        weights: &Weights,
        found: &mut Guests,
        aside: &mut Vec<usize>,
    ) {
        if self.form.joined || self.form.normals != Normals::Turning {
            return;
        }
        for row in 0..self.nodes.len() {
            if found.left[row] {
                continue;
            }
            let was = weights.guests.is_pointwise(row);
            let is = match self.tilt(row, weights) {
                None => self.structural[row],
                Some((tilt, _))
                    if self.structural[row] && (tilt > STEEP || was && tilt > FLUSH) =>
                {
                    true
                }
                Some(_) => self.is_false((row, was), pair, at, weights),
            };
            if is {
                found.pointwise[row] = true;
                found.left[row] = true;
                aside.push(row);
            }
        }
    }

    /// Whether the mean gap of a closed row is less than the gap anywhere. Of a row that compares points, it is the mean with
    /// its own functions.
    fn is_false(
        &self,
        (row, was): (usize, bool),
        pair: &SurfacePair,
        at: &Placement,
        weights: &Weights,
    ) -> bool {
        let Some(facets) = &pair.secondary else {
            return false;
        };
        let of_facet = |facet: u32| weights.facets.get(facet as usize);
        let own = &self.around[row];
        let taken = weights.guests.taken.get(row).into_iter().flatten();
        let taken = taken.map(|&(facet, ..)| facet);
        let x = |n: NodeId| at.x.get(n as usize).copied().unwrap_or_default();
        // between nodes
        let between = |facet: u32| match facets.element(facet) {
            Some(element) => 1.0 / element.order() as f64,
            None => 1.0,
        };
        let sizes = own
            .iter()
            .map(|&(facet, _)| facets.size(at, facet) * between(facet));
        let size = sizes.fold(0.0, f64::max);
        let mean = match was {
            true => self.mean_gap(row, facets, weights, &x),
            false => weights
                .row(row)
                .map(|of| of.gap(x(self.nodes[row]), &x) / of.d),
        };
        // where the geometry is held, means stay below points by as much as at the start
        let keeps = self.points.sliding != SlidingRange::Finite;
        let near = match (keeps, was) {
            (true, _) => f64::INFINITY,
            (false, true) => NEAR,
            (false, false) => CLOSED,
        };
        let Some(mean) = mean.filter(|g| *g < near * size) else {
            return false;
        };
        let apart = |gap: f64| mean < gap - APART * size;
        // in most cases the node itself shows that it is not
        let met = || {
            own.iter()
                .filter_map(|&(f, _)| of_facet(f))
                .flat_map(|of| &of.met)
        };
        let primary = pair.primary.as_ref();
        let gap_of_node = |&other: &u32| gap_inside(primary, other, x(self.nodes[row]), at);
        if met().filter_map(gap_of_node).any(|gap| !apart(gap)) {
            return false;
        }
        let mut least = f64::INFINITY;
        for facet in own.iter().map(|&(facet, _)| facet).chain(taken) {
            let Some(of) = of_facet(facet) else {
                continue;
            };
            for &other in &of.met {
                let gap = least_gap_of((facets, facet), (pair, other), of.normal, at);
                least = least.min(gap.unwrap_or(f64::INFINITY));
            }
        }
        least.is_finite() && apart(least)
    }

    /// Whether a node whose facets meet nothing may touch its closest facet: not where these are flush with it, past
    /// the rim of the primary side.
    pub(super) fn may_touch(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        weights: &Weights,
        met: &Pair,
    ) -> bool {
        let of_facet = |facet: u32| weights.facets.get(facet as usize);
        let around = self.around[row].iter();
        let mut acts = around
            .clone()
            .filter_map(|&(facet, place)| Some(of_facet(facet)?.d[place]));
        if acts.any(|d| d > 0.0) {
            return true;
        }
        let of = around.filter_map(|&(facet, _)| of_facet(facet));
        let mut jet = SurfaceJet::default();
        let own: Vec3 = of.map(|of| of.normal).sum();
        let known = pair.primary.jet(at, &met.anchor, &mut jet).is_ok();
        let cosine = own.normalized().map_or(0.0, |own| own.dot(jet.normal));
        !known || cosine < STEEP.cos()
    }

    /// The mean gap of a row with its own functions.
    fn mean_gap(
        &self,
        row: usize,
        facets: &Facets,
        weights: &Weights,
        x: &dyn Fn(NodeId) -> Vec3,
    ) -> Option<f64> {
        let origin = x(self.nodes[row]);
        let (mut sum, mut area) = (0.0, 0.0);
        for &(facet, place) in &self.around[row] {
            let of = weights.facets.get(facet as usize)?;
            let d = of.d[place];
            let along = |n: &NodeId| of.normal.dot(x(*n) - origin);
            let inverse = &self.inverse(facet)[place];
            let own = facets.nodes(facet).iter().zip(inverse);
            sum += own.map(|(n, t)| t * d * along(n)).sum::<f64>();
            let m = of.m.get(place * of.nodes.len()..).unwrap_or_default();
            sum -= of
                .nodes
                .iter()
                .zip(m)
                .map(|(n, m)| m * along(n))
                .sum::<f64>();
            area += d;
        }
        (area > 0.0).then(|| sum / area)
    }

    /// Chooses how far the normals of rows turn to those of the primary side, by their tilt.
    pub(super) fn turn(&self, weights: &Weights, from_rest: bool, found: &mut Guests) {
        if self.form.joined
            || self.form.normals != Normals::Turning
            || self.points.sliding != SlidingRange::Finite
        {
            return;
        }
        for row in 0..self.nodes.len() {
            if found.left[row] {
                continue;
            }
            let (tilt, angle) = self.tilt(row, weights).unwrap_or_default();
            let x = ((tilt - UPRIGHT) / (TURNED - UPRIGHT)).clamp(0.0, 1.0);
            let turn = if x > 0.0 {
                x * x * (3.0 - 2.0 * x) * tilt / angle
            } else {
                0.0
            };
            let before = weights.guests.turn(row);
            let step = if from_rest { CLOSELY } else { FAR_BEHIND };
            let turn = match (turn - before).abs() * angle < step {
                true => before,
                false => turn,
            };
            if turn == 0.0 {
                continue;
            }
            if found.turned.is_empty() {
                found.turned = vec![0.0; self.nodes.len()];
                found.turning = vec![false; self.rows.len()];
            }
            found.turned[row] = turn;
            let facets: Vec<u32> = found.of(row, &self.around[row]).map(|f| f.0).collect();
            for facet in facets {
                found.turning[facet as usize] = true;
            }
        }
    }

    /// The primary facets that facets around a node meet, and those around them.
    pub(super) fn met_around(
        &self,
        row: usize,
        pair: &SurfacePair,
        weights: &Weights,
        out: &mut Vec<u32>,
    ) {
        out.clear();
        for &(facet, _) in &self.around[row] {
            let met = weights
                .facets
                .get(facet as usize)
                .map_or(&[][..], |of| &of.met);
            for &other in met {
                out.push(other);
                out.extend_from_slice(pair.primary.neighbours(other));
            }
        }
        out.sort_unstable();
        out.dedup();
    }

    /// How far mortar rows have slipped since the increment began, within their tangent planes; empty without anchors.
    pub(super) fn slips(
        &self,
        at: &Placement,
        now: &Pairing,
        before: &Pairing,
        anchors: &[Option<Anchored>],
    ) -> Vec<Vec3> {
        if anchors.iter().all(Option::is_none) {
            return Vec::new();
        }
        let x = |n: NodeId| at.x.get(n as usize).copied().unwrap_or_default();
        let slip = |(row, anchor): (usize, &Option<Anchored>)| {
            let (Some(anchor), Some(now), Some(past)) =
                (anchor, now.weights.row(row), before.weights.row(row))
            else {
                return Vec3::ZERO;
            };
            if anchor.anchor != NOWHERE {
                return Vec3::ZERO;
            }
            let o = x(self.nodes[row]);
            let slip = (past.way(o, &x) - now.way(o, &x)) / now.d - anchor.offset;
            let nu = now.normal.normalized().unwrap_or_default();
            slip - nu * nu.dot(slip)
        };
        anchors.iter().enumerate().map(slip).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::discretization::mortar::Form;
    use crate::contact::discretization::{Discretization, Links};
    use crate::contact::mortar::Measure;
    use crate::contact::row::{Participant, RowOrder, Rows, Wanted};
    use crate::contact::tests::{Random, facets, with_mid_nodes};
    use signorini_geometry::proximity::{Aabb, Search};
    use std::sync::Arc;

    struct Sides {
        mortar: Mortar,
        pair: SurfacePair,
        x: Vec<Vec3>,
    }

    /// A strip of facets with two, three, four or more nodes, turned about an axis by an angle, over a plane of one facet.
    fn tilted(nnode: usize, angle: f64) -> Sides {
        let mut random = Random::new(nnode as u64);
        let (s, c) = angle.sin_cos();
        let plane = nnode < 4 && nnode != 6;
        let mut x: Vec<Vec3> = Vec::new();
        let rows = if plane { 1 } else { 3 };
        for j in 0..rows {
            for i in 0..4 {
                let (u, v) = (f64::from(i), f64::from(j));
                let noise = random.vector() * 0.001;
                let at = Vec3::new(u * c, u * s + 0.01, v);
                x.push(
                    at + if plane {
                        Vec3::new(noise.x, noise.y, 0.0)
                    } else {
                        noise
                    },
                );
            }
        }
        let mut sides: Vec<Vec<NodeId>> = Vec::new();
        for i in 0..3 {
            for j in 0..rows - 1 {
                let at = |i: u32, j: u32| 4 * j + i;
                let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                match nnode {
                    6 => {
                        sides.push(vec![quad[0], quad[1], quad[2]]);
                        sides.push(vec![quad[0], quad[2], quad[3]]);
                    }
                    _ => sides.push(quad.to_vec()),
                }
            }
            if plane {
                sides.push(vec![i, i + 1]);
            }
        }
        if nnode > 4 {
            let ncorner = x.len();
            with_mid_nodes(&mut x, &mut sides, nnode == 9);
            // derivatives are those of bent edges
            x[ncorner..]
                .iter_mut()
                .for_each(|x| *x += random.vector() * 0.001);
        }
        let secondary = facets(&mut x, &sides);
        let first = x.len() as NodeId;
        let (low, high) = (-1.3, 4.6);
        let corners = match plane {
            true => vec![(high, 0.0), (low, 0.0)],
            false => vec![(low, low), (low, high), (high, high), (high, low)],
        };
        x.extend(corners.iter().map(|&(a, b)| Vec3::new(a, 0.0, b)));
        let primary = facets(&mut x, &[(first..first + corners.len() as u32).collect()]);
        let form = Form::default();
        let mortar = Mortar::new(&secondary, &primary, form, Measure::Flat, &x).unwrap();
        let pair = SurfacePair {
            secondary: Some(secondary),
            ..SurfacePair::new(mortar.nodes().to_vec(), Arc::new(primary), 2.0)
        };
        Sides { mortar, pair, x }
    }

    impl Sides {
        fn pair_up(&self, x: &[Vec3], last: &Pairing) -> Pairing {
            let at = Placement { x, poses: &[] };
            let rows = 0..self.mortar.nrow();
            let points: Vec<Vec3> = rows.map(|r| self.mortar.point(r).position(&at)).collect();
            let boxes =
                (0..self.pair.primary.nfacet() as u32).map(|f| self.pair.primary.aabb(&at, f));
            let boxes: Vec<Aabb> = boxes.collect();
            let mut search = Search::default();
            search.update(&points, &boxes, 2.0, 1.0, &|_, _| true);
            let mut found = Pairing::default();
            let order = RowOrder::Gap;
            let done = self
                .mortar
                .pair_up(&self.pair, &at, &search, last, order, &mut found);
            done.unwrap();
            found
        }

        fn fill(&self, row: usize, x: &[Vec3], pairing: &Pairing, rows: &mut Rows) {
            let at = Placement { x, poses: &[] };
            let links = Links {
                pairing,
                before: pairing,
                anchors: &[],
                bond: false,
            };
            let wanted = Wanted {
                order: RowOrder::Tangent,
                slip: false,
            };
            self.mortar
                .row(row, &self.pair, &at, &links, wanted, rows)
                .unwrap();
        }
    }

    const FACETS: [usize; 5] = [2, 4, 6, 8, 9];

    #[test]
    fn rows_whose_normals_turn_have_the_derivatives_of_their_gap_and_weights() {
        for nnode in FACETS {
            let sides = tilted(nnode, 0.03);
            let settled = sides.pair_up(&sides.x, &Pairing::default());
            let turned = settled.weights.guests.turned.iter();
            assert!(turned.clone().any(|s| *s > 0.9), "{nnode}: {turned:?}");
            let (mut rows, mut moved) = (Rows::default(), Rows::default());
            let h = 1e-6;
            for row in 0..sides.mortar.nrow() {
                sides.fill(row, &sides.x, &settled, &mut rows);
                let n = rows.ncolumn();
                let Some(filled) = rows.rows().first() else {
                    continue;
                };
                for (k, participant) in rows.participants().iter().enumerate() {
                    let Participant::Node(node) = *participant else {
                        continue;
                    };
                    for axis in 0..if nnode == 2 { 2 } else { 3 } {
                        let mut at = |by: f64| {
                            let mut x = sides.x.clone();
                            x[node as usize][axis] += by;
                            let pairing = sides.pair_up(&x, &settled);
                            sides.fill(row, &x, &pairing, &mut moved);
                            let row = &moved.rows()[0];
                            (row.gap, row.weights.clone())
                        };
                        let ((g1, b1), (g0, b0)) = (at(h), at(-h));
                        let column = 3 * k + axis;
                        let error = (filled.gradient[column] - (g1 - g0) / (2.0 * h)).abs();
                        assert!(error < 1e-7, "{nnode}, row {row}, column {column}: {error}");
                        for i in 0..n {
                            let slope = (b1[i] - b0[i]) / (2.0 * h);
                            let error = (filled.dweights[i * n + column] - slope).abs();
                            assert!(error < 1e-7, "{nnode}, row {row}, {i}, {column}: {error}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn rows_that_have_turned_push_along_the_normal_of_the_plane_they_rest_on() {
        for nnode in FACETS {
            let sides = tilted(nnode, 0.04);
            let settled = sides.pair_up(&sides.x, &Pairing::default());
            let mut rows = Rows::default();
            for row in 0..sides.mortar.nrow() {
                sides.fill(row, &sides.x, &settled, &mut rows);
                let Some(filled) = rows.rows().first() else {
                    continue;
                };
                let turn = settled.weights.guests.turn(row);
                let away = (filled.normal - Vec3::unit(1)).norm();
                assert!(
                    away < (1.0 - turn) * 0.05 + 1e-14,
                    "{nnode}, row {row}: {turn} {away}"
                );
            }
        }
    }

    #[test]
    fn facets_that_lie_flush_or_turn_as_at_the_start_keep_their_normals() {
        for nnode in FACETS {
            let sides = tilted(nnode, 0.0);
            let settled = sides.pair_up(&sides.x, &Pairing::default());
            let pointwise = settled.weights.guests.pointwise.iter();
            assert_eq!(pointwise.filter(|p| **p).count(), 0, "{nnode}");
            assert!(settled.weights.guests.turned.is_empty(), "{nnode}");
        }
    }

    #[test]
    fn the_rim_of_a_steep_side_compares_points() {
        for nnode in FACETS {
            let sides = tilted(nnode, 0.8);
            let settled = sides.pair_up(&sides.x, &Pairing::default());
            let at = Placement {
                x: &sides.x,
                poses: &[],
            };
            for (row, &node) in sides.mortar.nodes().iter().enumerate() {
                let guests = &settled.weights.guests;
                assert_eq!(guests.is_pointwise(row), sides.mortar.structural[row]);
                let Some(pair) = settled.pairs[row].filter(|_| guests.is_pointwise(row)) else {
                    continue;
                };
                let height = at.x[node as usize].y;
                assert!((pair.gap - height).abs() < 1e-12, "{nnode}, {node}");
            }
        }
    }

    #[test]
    fn choices_survive_a_checkpoint() {
        let sides = tilted(4, 0.03);
        let settled = sides.pair_up(&sides.x, &Pairing::default());
        let nrow = sides.mortar.nrow();
        let mut restored = Pairing::nothing(nrow);
        assert!(
            restored
                .weights
                .restore_choices(&settled.weights.choices(), nrow)
        );
        assert_eq!(restored.weights.guests, settled.weights.guests);
        assert_eq!(restored.weights.choices(), settled.weights.choices());
        assert!(!restored.weights.restore_choices(&[0.0], nrow));
        assert!(restored.weights.restore_choices(&[], nrow));
    }
}
