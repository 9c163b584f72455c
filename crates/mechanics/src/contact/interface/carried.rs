//! Rows between the ends of an increment of a motion with inertia, carried on to its end.
//!
//! ```text
//! γ₁ = g + αf b·Δd        e₁ = e + αf P B Δd                                                     (E7)
//! q  = (1 − αf) G + αf b + αf (1 − αf) (∂b/∂d)ᵀ Δd                                               (E8)
//! ```
//!
//! The laws see γ₁ and e₁: the gap and the slip that the row has at the end, along what does the work. With q in the place of the
//! gradient, and `1 − αf` times the derivatives of weights, the stiffness of the kernel is that against the end of the increment. A
//! contact force that is whole and sees γ₁ does no positive work in closing and opening, whatever the law: what is stored is given
//! back at most.
//!
//! Where energy is conserved, the law sees a gap of its own instead, (E9) of `dynamic_gap`, which has the gradient
//!
//! ```text
//! q  = b + (1 − αf) (∂b/∂d)ᵀ Δd                                                                  (E10)
//! ```
//!
//! and bonds by a stiffness are stretched as they are between the ends: that is the mean of both.
//!
//! The derivative of e₁ leaves out that of `P B`, which is none where sides are flat.

use crate::contact::row::{Participant, Row, Rows};
use crate::system::Between;
use signorini_geometry::tensor::Vec3;

/// Scratch of one thread: Δd of each column.
#[derive(Default)]
pub(super) struct Ways(Vec<f64>);

/// How rows go on.
pub(super) struct Carried {
    /// Whether they have a tangential part.
    pub slips: bool,
    /// Whether that is the whole way.
    pub bond: bool,
    /// Whether slip is damped.
    pub drags: bool,
    /// Whether forces are secants of a potential.
    pub conserves: bool,
    /// The gap at the start of the increment, where they go on from that.
    pub start: Option<f64>,
}

/// Carries the rows of a group on to the end of the increment. `b·Δd` of the first comes back: what its gap changes by in it.
pub(super) fn carry_on(
    rows: &mut Rows,
    between: &Between,
    how: &Carried,
    Ways(ways): &mut Ways,
) -> f64 {
    ways.clear();
    for participant in rows.participants() {
        match *participant {
            Participant::Node(node) => {
                let way = between.way.get(node as usize).copied();
                ways.extend(way.unwrap_or_default().to_array());
            }
            Participant::Rigid(body) => {
                let turn = between.turn.get(body as usize).copied();
                let [way, turn] = turn.unwrap_or_default();
                ways.extend(way.to_array());
                ways.extend(turn.to_array());
            }
        }
    }
    let mut first = None;
    for row in rows.rows_mut() {
        let closes = carry(row, between.alpha_f, how, ways);
        first.get_or_insert(closes);
    }
    first.unwrap_or_default()
}

fn carry(row: &mut Row, alpha: f64, how: &Carried, ways: &[f64]) -> f64 {
    let left = 1.0 - alpha;
    let closes: f64 = row.weights.iter().zip(ways).map(|(b, d)| b * d).sum();
    let (own, share);
    (row.gap, own, share) = match how.start {
        Some(start) => (start + closes, 0.0, 1.0),
        None => (row.gap + alpha * closes, left, alpha),
    };
    let n = ways.len();
    let has_gradient = row.gradient.len() == n && row.weights.len() == n;
    if has_gradient {
        for (g, b) in row.gradient.iter_mut().zip(&row.weights) {
            *g = own * *g + share * b;
        }
    }
    if has_gradient && row.dweights.len() == n * n {
        for (line, way) in row.dweights.chunks_exact_mut(n).zip(ways) {
            for (q, d) in row.gradient.iter_mut().zip(line) {
                *q += share * left * *d * way;
                *d *= left;
            }
        }
    }
    if how.slips {
        let share = match how.bond && how.conserves {
            true => 0.0,
            false => alpha,
        };
        carry_slip(row, [left, share], how.bond, ways);
        if how.drags {
            turn_way(row, ways);
        }
    }
    closes
}

/// `Bᵀ Δd`.
fn whole_way(operator: &[Vec3], ways: &[f64]) -> Vec3 {
    operator.iter().zip(ways).map(|(b, d)| *b * *d).sum()
}

fn carry_slip(row: &mut Row, [left, share]: [f64; 2], bond: bool, ways: &[f64]) {
    let normal = row.normal;
    let within = |v: Vec3| if bond { v } else { v - normal * normal.dot(v) };
    let sliding = &mut row.sliding;
    let way = whole_way(&sliding.operator, ways);
    sliding.way = within(way);
    sliding.slip += sliding.way * share;
    for (slope, b) in sliding.dslip.iter_mut().zip(&sliding.operator) {
        *slope = *slope * left + within(*b) * share;
    }
    sliding.scale_derivatives(left);
}

/// The derivative of `P Bᵀ Δd` against the end of the increment, with derivatives of B and of the normal that are those already.
fn turn_way(row: &mut Row, ways: &[f64]) {
    let (normal, sliding) = (row.normal, &mut row.sliding);
    let mut slopes = std::mem::take(&mut sliding.dway);
    slopes.clear();
    slopes.extend_from_slice(&sliding.operator);
    for (column, way) in ways.iter().enumerate() {
        if let Some((axis, line)) = sliding.scaled(column) {
            for (slope, d) in slopes.iter_mut().zip(line) {
                slope[axis] += way * d;
            }
        }
    }
    for turn in sliding.turns() {
        let across = whole_way(&turn.across, ways);
        for (slope, along) in slopes.iter_mut().zip(&turn.along) {
            *slope += across * *along;
        }
    }
    let whole = whole_way(&sliding.operator, ways);
    for (slope, dnormal) in slopes.iter_mut().zip(&sliding.dnormal) {
        let turned = *dnormal * normal.dot(whole) + normal * dnormal.dot(whole);
        *slope -= normal * normal.dot(*slope) + turned;
    }
    sliding.dway = slopes;
}
