//! The queries of [`Bvh`](super::Bvh), answered by looking at every box: the oracle of its tests.

use super::Aabb;
use crate::tensor::Vec3;

/// [`Bvh::query`](super::Bvh::query) by brute force.
pub fn query(boxes: &[Aabb], point: Vec3, distance: f64, out: &mut Vec<u32>) {
    let asks_something = point.is_finite() && distance >= 0.0;
    select(boxes, |b| asks_something && b.within(point, distance), out);
}

/// [`Bvh::overlaps`](super::Bvh::overlaps) by brute force.
pub fn overlaps(boxes: &[Aabb], region: &Aabb, out: &mut Vec<u32>) {
    select(boxes, |b| b.overlaps(region), out);
}

/// [`Bvh::crossed`](super::Bvh::crossed) by brute force.
pub fn crossed(boxes: &[Aabb], origin: Vec3, direction: Vec3, out: &mut Vec<u32>) {
    let asks_something = origin.is_finite() && direction.is_finite();
    select(
        boxes,
        |b| asks_something && b.is_crossed(origin, direction),
        out,
    );
}

/// [`Bvh::visit_near`](super::Bvh::visit_near) by brute force: visits every box that contains something.
pub fn visit_near(boxes: &[Aabb], point: Vec3, mut visit: impl FnMut(u32) -> f64) {
    if point.is_finite() {
        for (id, b) in (0..u32::MAX).zip(boxes) {
            if !b.is_empty() {
                visit(id);
            }
        }
    }
}

fn select(boxes: &[Aabb], wanted: impl Fn(&Aabb) -> bool, out: &mut Vec<u32>) {
    out.clear();
    let numbered = (0..u32::MAX).zip(boxes);
    out.extend(numbered.filter(|(_, b)| wanted(b)).map(|(id, _)| id));
}
