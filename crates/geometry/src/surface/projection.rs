//! The closest point of a facet.
//!
//! Minimizes `F(ξ) = ½|r − ρ(ξ)|²` over the domain of the facet:
//!
//! ```text
//! F_a  = −t_a·(r − ρ)                    (E1)
//! F_ab = m_ab − ρ_,ab·(r − ρ)            (E2)
//! ```
//!
//! by Newton's method with (E2) where it is positive definite and with the metric `m_ab` where it is not, an Armijo
//! rule on `F` and a bounded step. A face alone is not enough: on a warped facet the closest point often lies on an
//! edge, so the face, every edge and every vertex compete, and the smallest distance wins; ties go to the face, then the
//! edge. The first start is that on the way from the centre to the closest node. Where (E2) exceeds half the metric at the
//! stationary point found, no other one nearby competes: inside the face and no farther than any node, it settles the
//! matter. Where the facet bends little over the distance,
//!
//! ```text
//! 8 s d < L²/4                           (E3)
//! ```
//!
//! with the largest distance s of a mid node from the line between its ends, or of corners from a plane, the distance d of
//! the closest node and the shortest edge L, there is one stationary point only, and further starts are left out: the
//! centre and one for each node of a face that has mid nodes, and a second one of an edge. Neglected: nothing; limits: a
//! facet folded over itself within its own size.
//!
//! Source: Konyukhov and Schweizerhof 2013, chapter 3 (existence and uniqueness of the projection).

use super::error::SurfaceError;
use super::point::{Anchor, Feature, Projection, SurfaceJet, pair};
use crate::element::{Element, Family, MAX_FACET_NODES};
use crate::tensor::Vec3;

/// Iterations after which a start is given up.
const MAX_ITERATIONS: usize = 50;
/// Change of a parameter at which an iteration has converged.
const CONVERGED: f64 = 1e-13;
/// How far outside the domain a point still counts as inside.
const INSIDE: f64 = 1e-12;
/// Relative difference below which two distances are equal.
const TIE: f64 = 1e-12;
/// The longest step in parameters.
const MAX_STEP: f64 = 0.5;
/// A search that runs this far out of the domain is given up.
pub(super) const ABANDON: f64 = 0.5;

/// The closest point of a facet that is parametrised by the domain of this element.
pub(super) fn closest<J: Jet>(
    domain: Option<Element>,
    mut search: Search<J>,
    hint: Option<Anchor>,
    out: &mut SurfaceJet,
) -> Result<Option<Projection>, SurfaceError> {
    let facet = search.facet;
    let Some(element) = domain else {
        return Err(SurfaceError::NoSuchFacet { facet });
    };
    if !search.point.is_finite() {
        return Ok(None);
    }

    // A hint that leads to a well-curved minimum inside the face settles the matter.
    if let Some(hint) = hint.filter(|h| h.facet == facet) {
        let bounds = |xi: &Vec3| element.contains(xi, ABANDON);
        if let Some((xi, unique)) = search.face(hint.local, bounds, out)?
            && unique
            && element.contains(&xi, INSIDE)
        {
            return Ok(Some(search.found(xi, Feature::Face, out)));
        }
    }

    let best = search.everywhere(element, out)?;
    let Some((xi, feature, _)) = best else {
        return Ok(None);
    };
    search.jet(xi, out)?;
    Ok(Some(search.found(xi, feature, out)))
}

/// A surface to second order at a point of it.
pub(super) trait Jet: Fn(&Anchor, &mut SurfaceJet) -> Result<(), SurfaceError> {}

impl<J: Fn(&Anchor, &mut SurfaceJet) -> Result<(), SurfaceError>> Jet for J {}

/// The search for the point of a facet that is closest to another.
pub(super) struct Search<J> {
    pub jet: J,
    pub facet: u32,
    pub point: Vec3,
    pub ntan: usize,
}

type Candidate = (Vec3, Feature, f64);

impl<J: Jet> Search<J> {
    pub fn jet(&self, local: Vec3, out: &mut SurfaceJet) -> Result<(), SurfaceError> {
        let anchor = Anchor {
            facet: self.facet,
            local,
        };
        (self.jet)(&anchor, out)
    }

    pub fn found(&self, local: Vec3, feature: Feature, jet: &SurfaceJet) -> Projection {
        Projection {
            anchor: Anchor {
                facet: self.facet,
                local,
            },
            feature,
            distance: (self.point - jet.position).norm(),
        }
    }

    /// Face, edges and vertices; the jet is left anywhere.
    fn everywhere(
        &mut self,
        element: Element,
        jet: &mut SurfaceJet,
    ) -> Result<Option<Candidate>, SurfaceError> {
        let mut best: Option<Candidate> = None;
        let nodes = element.nodes();
        let mut size: f64 = 0.0;
        let mut nearest = [nodes[0]];
        let mut smallest = f64::INFINITY;
        let mut distances = [f64::INFINITY; MAX_FACET_NODES];
        let mut places = [Vec3::ZERO; MAX_FACET_NODES];
        for ((xi, distance), place) in nodes.iter().zip(&mut distances).zip(&mut places) {
            self.jet(*xi, jet)?;
            *place = jet.position;
            size = size.max(jet.tangent[0].norm()).max(jet.tangent[1].norm());
            *distance = (self.point - jet.position).norm();
            if *distance < smallest {
                (smallest, nearest) = (*distance, [*xi]);
            }
        }
        let tie = TIE * size;
        let mut offer = |xi: Vec3, feature: Feature, distance: f64| {
            if best.as_ref().is_none_or(|b| distance < b.2 - tie) {
                best = Some((xi, feature, distance));
            }
        };

        let bounds = |xi: &Vec3| element.contains(xi, ABANDON);
        let centre = element.centre();
        // a facet of higher order may bend towards the point in several places
        let bent = !element.is_linear();
        let is_single = bends_little(element, &places, smallest);
        let towards = if bent { nodes } else { &[] };
        let starts = nearest
            .iter()
            .chain(towards)
            .map(|&node| (centre + node) * 0.5);
        for start in starts.chain(std::iter::once(centre)) {
            let Some((xi, unique)) = self.face(start, bounds, jet)? else {
                if is_single {
                    break;
                }
                continue;
            };
            if element.contains(&xi, INSIDE) {
                let distance = (self.point - jet.position).norm();
                if unique && distance <= smallest {
                    return Ok(Some((xi, Feature::Face, distance)).filter(|b| b.2.is_finite()));
                }
                offer(xi, Feature::Face, distance);
            }
            if unique && is_single {
                break;
            }
        }
        if self.ntan == 2 {
            for &[a, b] in element.edges() {
                let (xa, xb) = (nodes[a], nodes[b]);
                let along = xb - xa;
                let direction = [along.x, along.y];
                for start in [0.25, 0.75] {
                    let Some((s, is_only)) = self.edge(xa, along, start, is_single, jet)? else {
                        continue;
                    };
                    if (0.0..=1.0).contains(&s) {
                        let xi = xa + along * s;
                        self.jet(xi, jet)?;
                        let distance = (self.point - jet.position).norm();
                        offer(xi, Feature::Edge { direction }, distance);
                    }
                    if is_only {
                        break;
                    }
                }
            }
        }
        for (xi, distance) in nodes.iter().zip(distances).take(element.ncorner()) {
            offer(*xi, Feature::Vertex, distance);
        }
        Ok(best.filter(|b| b.2.is_finite()))
    }

    /// Newton from one start; the parameters of the stationary point, and whether (E2) there exceeds half the metric,
    /// in which case no other point nearby competes. `None` where the search leaves its bounds or stalls.
    pub fn face(
        &mut self,
        start: Vec3,
        bounds: impl Fn(&Vec3) -> bool,
        jet: &mut SurfaceJet,
    ) -> Result<Option<(Vec3, bool)>, SurfaceError> {
        let mut xi = start;
        self.jet(xi, jet)?;
        for _ in 0..MAX_ITERATIONS {
            let away = self.point - jet.position;
            let gradient = jet.tangent.map(|t| -t.dot(away)); // (E1)
            let m = jet.metric;
            let mut hessian: [f64; 3] = std::array::from_fn(|k| m[k] - jet.curvature[k].dot(away)); // (E2)
            if !positive(&hessian, self.ntan) {
                hessian = m;
            }
            let Some(step) = newton_step(&hessian, &gradient, self.ntan) else {
                return Ok(None);
            };
            let length = step[0].hypot(step[1]);
            let scale = if length > MAX_STEP {
                MAX_STEP / length
            } else {
                1.0
            };
            let step = Vec3::new(step[0] * scale, step[1] * scale, 0.0);
            let slope = step.x * gradient[0] + step.y * gradient[1];
            let value = 0.5 * away.norm_squared();
            let mut alpha = 1.0;
            loop {
                let trial = xi + step * alpha;
                self.jet(trial, jet)?;
                let reached = 0.5 * (self.point - jet.position).norm_squared();
                if length < 1e-8 || reached <= value + 1e-4 * alpha * slope || alpha < 1e-4 {
                    xi = trial;
                    break;
                }
                alpha *= 0.5;
            }
            if !bounds(&xi) || !xi.is_finite() {
                return Ok(None);
            }
            if alpha * length < CONVERGED {
                let away = self.point - jet.position;
                let half: [f64; 3] =
                    std::array::from_fn(|k| 0.5 * jet.metric[k] - jet.curvature[k].dot(away));
                return Ok(Some((xi, positive(&half, self.ntan))));
            }
        }
        Ok(None)
    }

    /// The same along an edge, `ξ = from + s·along`; the second value says that there is no other stationary point, as on a
    /// straight edge, or where there `is_single` one at most if it is well curved.
    pub fn edge(
        &mut self,
        from: Vec3,
        along: Vec3,
        start: f64,
        is_single: bool,
        jet: &mut SurfaceJet,
    ) -> Result<Option<(f64, bool)>, SurfaceError> {
        let d = [along.x, along.y];
        let mut s = 0.5;
        self.jet(from + along * s, jet)?;
        let (t, h) = along_edge(jet, &d);
        if h.norm() <= 1e-14 * t.norm() {
            let m = t.norm_squared();
            let exact = s + t.dot(self.point - jet.position) / m;
            return Ok(exact.is_finite().then_some((exact, true)));
        }
        s = start;
        self.jet(from + along * s, jet)?;
        for _ in 0..MAX_ITERATIONS {
            let away = self.point - jet.position;
            let (t, h) = along_edge(jet, &d);
            let m = t.norm_squared();
            let full = m - h.dot(away);
            let hessian = if full > 1e-6 * m { full } else { m };
            let gradient = -t.dot(away);
            let step = (-gradient / hessian).clamp(-MAX_STEP, MAX_STEP);
            let value = 0.5 * away.norm_squared();
            let mut alpha = 1.0;
            loop {
                let trial = s + alpha * step;
                self.jet(from + along * trial, jet)?;
                let reached = 0.5 * (self.point - jet.position).norm_squared();
                let enough = value + 1e-4 * alpha * step * gradient;
                if step.abs() < 1e-8 || reached <= enough || alpha < 1e-4 {
                    s = trial;
                    break;
                }
                alpha *= 0.5;
            }
            if !(-ABANDON..=1.0 + ABANDON).contains(&s) {
                return Ok(None);
            }
            if (alpha * step).abs() < CONVERGED {
                let (t, h) = along_edge(jet, &d);
                let m = t.norm_squared();
                let unique = m - h.dot(self.point - jet.position) > 0.5 * m;
                return Ok(Some((s, unique && is_single)));
            }
        }
        Ok(None)
    }
}

/// (E3), for a facet with its nodes at these places; never above degree 2, for which it does not hold.
fn bends_little(element: Element, places: &[Vec3], distance: f64) -> bool {
    if element.order() > 2 {
        return false;
    }
    let (mut shortest, mut sagitta) = (f64::INFINITY, 0.0f64);
    let at = |k: usize| places.get(k).copied().unwrap_or_default();
    for ends in element.edges() {
        let [a, b] = ends.map(at);
        shortest = shortest.min((b - a).norm());
    }
    for (mid, ends) in element.mid_nodes() {
        let [a, b] = ends.map(at);
        sagitta = sagitta.max((at(mid) - (a + b) * 0.5).norm());
    }
    if let (Family::Quadrilateral, [a, b, c, d, ..]) = (element.family(), places) {
        sagitta = sagitta.max((*a - *b + *c - *d).norm() * 0.25);
    }
    8.0 * sagitta * distance < 0.25 * shortest * shortest
}

/// Tangent and curvature vector along a direction of the parameters.
fn along_edge(jet: &SurfaceJet, d: &[f64; 2]) -> (Vec3, Vec3) {
    let t = jet.tangent[0] * d[0] + jet.tangent[1] * d[1];
    let c = &jet.curvature;
    let h = c[pair(0, 0)] * (d[0] * d[0])
        + c[pair(1, 1)] * (d[1] * d[1])
        + c[pair(0, 1)] * (2.0 * d[0] * d[1]);
    (t, h)
}

/// Whether the matrix `(11, 22, 12)` is safely positive definite.
fn positive(h: &[f64; 3], ntan: usize) -> bool {
    if ntan == 1 {
        return h[0] > 0.0;
    }
    let trace = h[0] + h[1];
    let det = h[0] * h[1] - h[2] * h[2];
    // λ_min > 1e-6 λ_max
    trace > 0.0 && det > 1e-6 * trace * trace
}

fn newton_step(h: &[f64; 3], g: &[f64; 2], ntan: usize) -> Option<[f64; 2]> {
    let step = if ntan == 1 {
        [-g[0] / h[0], 0.0]
    } else {
        let det = h[0] * h[1] - h[2] * h[2];
        [
            (h[2] * g[1] - h[1] * g[0]) / det,
            (h[2] * g[0] - h[0] * g[1]) / det,
        ]
    };
    step.iter().all(|s| s.is_finite()).then_some(step)
}
