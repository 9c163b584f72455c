//! Where a line crosses a facet.
//!
//! A facet is the fan of triangles from its middle to its nodes in their order round the boundary (in the plane: the
//! segments between its nodes), which is the facet itself where that is flat:
//!
//! ```text
//!     c ───── f ───── b          with o + s d = a + β (b − a) + γ (c − a):
//!     │ ╲     │     ╱ │          p = d × (c − a),  q = (o − a) × (b − a),  D = p·(b − a)
//!     │   ╲   │   ╱   │          β = p·(o − a)/D,  γ = q·d/D,  s = q·(c − a)/D              (E1)
//!     g ───── m ───── e
//! ```
//!
//! Of bent facets the error is a quarter of their height above the chord of their nodes. Boundaries belong to all facets that
//! meet there: no line passes between two neighbours.
//!
//! Source: Möller and Trumbore, *Fast, minimum storage ray-triangle intersection*, J. Graphics Tools 2, 1997 (E1).

use super::{Facets, Placement};
use crate::element::MAX_FACET_NODES;
use crate::proximity::Bvh;
use crate::tensor::Vec3;

/// How far outside a triangle, in its own coordinates, a line still crosses it.
const BOUNDARY: f64 = 1e-9;

impl Facets {
    /// The first of the facets that `counts` accepts which the line `from + s along`, `0 ≤ s ≤ 1`, crosses, with s; of several
    /// the lowest. The tree is that of the boxes of all facets, and `near` a buffer.
    pub fn first_crossed(
        &self,
        at: &Placement<'_>,
        tree: &Bvh,
        (from, along): (Vec3, Vec3),
        near: &mut Vec<u32>,
        counts: impl Fn(u32) -> bool,
    ) -> Option<(f64, u32)> {
        tree.crossed(from, along, near);
        let mut first: Option<(f64, u32)> = None;
        for &facet in near.iter() {
            if counts(facet)
                && let Some(s) = self.crossed_at(at.x, facet, from, along)
                && s <= 1.0
                && first.is_none_or(|(before, _)| s < before)
            {
                first = Some((s, facet));
            }
        }
        first
    }

    /// The smallest `s ≥ 0` at which the line `origin + s direction` crosses a facet; `None` where it does not.
    pub(super) fn crossed_at(
        &self,
        x: &[Vec3],
        facet: u32,
        origin: Vec3,
        direction: Vec3,
    ) -> Option<f64> {
        let (element, nodes) = (self.element(facet)?, self.nodes(facet));
        let at = |k: usize| {
            let node = nodes.get(k).copied()?;
            x.get(node as usize).copied()
        };
        let earliest = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        if element.dim() == 1 {
            let mut from = at(0)?;
            let mut found = None;
            for place in element.inside_edge(0).chain([1]) {
                let to = at(place)?;
                found = earliest(found, on_segment(origin, direction, from, to));
                from = to;
            }
            return found;
        }
        let mut around = [Vec3::ZERO; MAX_FACET_NODES];
        let mut n = 0;
        for place in element.ring() {
            *around.get_mut(n)? = at(place)?;
            n += 1;
        }
        let mut shape = [0.0; MAX_FACET_NODES];
        element.shape(&element.centre(), shape.get_mut(..nodes.len())?);
        let weighted = shape.iter().zip(0..nodes.len());
        let middle: Vec3 = weighted.filter_map(|(n, k)| Some(at(k)? * *n)).sum();
        let around = around.get(..n)?;
        let next = around.iter().cycle().skip(1);
        around.iter().zip(next).fold(None, |found, (&b, &c)| {
            earliest(found, on_triangle(origin, direction, [middle, b, c]))
        })
    }
}

/// (E1) in the plane.
fn on_segment(origin: Vec3, direction: Vec3, a: Vec3, b: Vec3) -> Option<f64> {
    let (edge, from) = (b - a, a - origin);
    let across = |u: Vec3, v: Vec3| u.x * v.y - u.y * v.x;
    let det = across(direction, edge);
    if det == 0.0 {
        return None;
    }
    let (s, t) = (across(from, edge) / det, across(from, direction) / det);
    (s >= 0.0 && (-BOUNDARY..=1.0 + BOUNDARY).contains(&t)).then_some(s)
}

/// (E1).
fn on_triangle(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f64> {
    let (ab, ac, from) = (b - a, c - a, origin - a);
    let p = direction.cross(ac);
    let det = p.dot(ab);
    if det == 0.0 {
        return None;
    }
    let q = from.cross(ab);
    let (beta, gamma, s) = (p.dot(from) / det, q.dot(direction) / det, q.dot(ac) / det);
    let inside = beta >= -BOUNDARY && gamma >= -BOUNDARY && beta + gamma <= 1.0 + BOUNDARY;
    (s >= 0.0 && inside).then_some(s)
}
