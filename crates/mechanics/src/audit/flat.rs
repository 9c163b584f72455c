//! Facets as flat pieces: how far they are from a point, at little cost.

use signorini_geometry::element::{Element, MAX_FACET_NODES};
use signorini_geometry::tensor::Vec3;

/// The distance of a point from a facet of flat pieces between its nodes, and the normal of the closest piece, as long as
/// that is large. Bent facets are off by a quarter of the height of their arcs.
pub fn distance(element: Element, x: &[Vec3], point: Vec3) -> Option<(f64, Vec3)> {
    let ncorner = element.ncorner();
    let (corners, mids) = x.split_at_checked(ncorner)?;
    let mut best: Option<(f64, Vec3)> = None;
    let mut take = |away: Vec3, normal: Vec3| {
        let distance = away.norm_squared();
        if best.is_none_or(|b| distance < b.0) {
            best = Some((distance, normal));
        }
    };
    if element.dim() == 1 {
        let (&[a, b], middle) = (corners.first_chunk::<2>()?, mids.first());
        let mut piece = |a: Vec3, b: Vec3| {
            take(
                point - on_segment(point, a, b),
                (b - a).cross(Vec3::unit(2)),
            );
        };
        match middle {
            Some(&m) => {
                piece(a, m);
                piece(m, b);
            }
            None => piece(a, b),
        }
    } else {
        let mut ring = [Vec3::ZERO; MAX_FACET_NODES];
        let mut n = 0;
        for (k, &corner) in corners.iter().enumerate() {
            for x in [Some(corner), mids.get(k).copied()].into_iter().flatten() {
                if let Some(to) = ring.get_mut(n) {
                    *to = x;
                    n += 1;
                }
            }
        }
        let ring = ring.get(..n)?;
        if let &[a, b, c] = ring {
            take(point - on_triangle(point, [a, b, c]), (b - a).cross(c - a));
        } else {
            let centre = centre(corners, mids);
            for (k, &a) in ring.iter().enumerate() {
                let b = ring.get(k + 1).or(ring.first()).copied()?;
                take(
                    point - on_triangle(point, [centre, a, b]),
                    (a - centre).cross(b - centre),
                );
            }
        }
    }
    best.map(|(square, normal)| (square.sqrt(), normal))
}

/// The middle of a facet with these corners and mid nodes of edges.
fn centre(corners: &[Vec3], mids: &[Vec3]) -> Vec3 {
    let sum = |x: &[Vec3]| x.iter().copied().sum::<Vec3>();
    let n = corners.len();
    match mids.get(..n) {
        None => sum(corners) / n as f64,
        Some(mids) if n == 3 => (sum(mids) * 4.0 - sum(corners)) / 9.0,
        Some(mids) => sum(mids) * 0.5 - sum(corners) * 0.25,
    }
}

fn on_segment(p: Vec3, a: Vec3, b: Vec3) -> Vec3 {
    let along = b - a;
    let square = along.norm_squared();
    let part = if square > 0.0 {
        ((p - a).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    a + along * part
}

/// The closest point of a triangle: inside, or the best of its edges.
fn on_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let normal = (b - a).cross(c - a);
    let square = normal.norm_squared();
    if square > 0.0 {
        let inside = |a: Vec3, b: Vec3| (b - a).cross(p - a).dot(normal) >= 0.0;
        if inside(a, b) && inside(b, c) && inside(c, a) {
            return p - normal * ((p - a).dot(normal) / square);
        }
    }
    let edges = [(a, b), (b, c), (c, a)].map(|(a, b)| on_segment(p, a, b));
    let away = |x: &Vec3| (p - *x).norm_squared();
    let best = edges.into_iter().min_by(|x, y| away(x).total_cmp(&away(y)));
    best.unwrap_or(a)
}
