use super::{Aabb, Bvh};
use crate::tensor::Vec3;

/// Boxes that move along straight lines, all in the same time.
///
/// A point that moves likewise meets a box where, at some `λ` between 0 and 1, it is within a distance `r` of it along
/// every axis:
///
/// ```text
/// min⁰ + λ (min¹ − min⁰) − r  ≤  p⁰ + λ (p¹ − p⁰)  ≤  max⁰ + λ (max¹ − max⁰) + r             (E5)
/// ```
///
/// Each of the six is linear in `λ`. A box around boxes that moves likewise stays around them. What moves with the point
/// stays at its distance: however far all go together, nothing more is met.
#[derive(Clone, Debug, Default)]
pub struct Sweep {
    /// Two trees of the same shape.
    from: Bvh,
    to: Bvh,
}

impl Sweep {
    /// Boxes that move from one place to another; there are as many of both.
    #[must_use]
    pub fn new(from: &[Aabb], to: &[Aabb]) -> Self {
        let n = from.len().min(to.len());
        let tree = Bvh::build(&to[..n]);
        let mut before = tree.clone();
        before.refit(&from[..n]);
        Self {
            from: before,
            to: tree,
        }
    }

    /// Replaces `out` by the sorted numbers of the boxes that come within `distance` of a point that moves meanwhile (E5).
    ///
    /// Places that are not finite find nothing.
    pub fn met(&self, [from, to]: [Vec3; 2], distance: f64, out: &mut Vec<u32>) {
        out.clear();
        if from.is_finite() && to.is_finite() {
            self.to.select_both(
                &self.from,
                |a, b| comes_near([a, b], [from, to], distance),
                out,
            );
        }
    }
}

/// (E5).
pub(super) fn comes_near(bounds: [&Aabb; 2], point: [Vec3; 2], distance: f64) -> bool {
    let [b0, b1] = bounds;
    let [p0, p1] = point;
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for i in 0..3 {
        let sides = [
            (b0.min[i] - p0[i] - distance, b1.min[i] - p1[i] - distance),
            (p0[i] - b0.max[i] - distance, p1[i] - b1.max[i] - distance),
        ];
        // a + λ (b − a) ≤ 0
        for (a, b) in sides {
            if a > 0.0 && b > 0.0 {
                return false;
            }
            if a > 0.0 {
                first = first.max(a / (a - b));
            } else if b > 0.0 {
                last = last.min(a / (a - b));
            }
        }
    }
    first <= last * ROUNDING && !b0.is_empty() && !b1.is_empty()
}

/// Covers the rounding of a part of the way.
const ROUNDING: f64 = 1.0 + 4.0 * f64::EPSILON;
