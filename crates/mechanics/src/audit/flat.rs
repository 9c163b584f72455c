//! Facets as flat pieces: how far they are from a point, at little cost.

use signorini_geometry::element::{Element, Family, MAX_FACET_NODES};
use signorini_geometry::tensor::Vec3;

/// The distance of a point from a facet of flat pieces between its nodes, and the normal of the closest piece, as long as
/// that is large. Bent facets are off by a quarter of the height of their arcs.
pub fn distance(element: Element, x: &[Vec3], point: Vec3) -> Option<(f64, Vec3)> {
    let ncorner = element.ncorner();
    let (corners, others) = x.split_at_checked(ncorner)?;
    let mut best: Option<(f64, Vec3)> = None;
    let mut take = |away: Vec3, normal: Vec3| {
        let distance = away.norm_squared();
        if best.is_none_or(|b| distance < b.0) {
            best = Some((distance, normal));
        }
    };
    if element.dim() == 1 {
        let mut piece = |a: Vec3, b: Vec3| {
            take(
                point - on_segment(point, a, b),
                (b - a).cross(Vec3::unit(2)),
            );
        };
        let mut from = *x.first()?;
        for node in element.inside_edge(0).chain([1]) {
            let to = *x.get(node)?;
            piece(from, to);
            from = to;
        }
    } else {
        let mut ring = [Vec3::ZERO; MAX_FACET_NODES];
        let mut n = 0;
        for (to, node) in ring.iter_mut().zip(element.ring()) {
            *to = *x.get(node)?;
            n += 1;
        }
        let ring = ring.get(..n)?;
        if let &[a, b, c] = ring {
            take(point - on_triangle(point, [a, b, c]), (b - a).cross(c - a));
        } else {
            let centre = centre(element, corners, others)?;
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

/// The middle of a facet with its corners and other nodes here; of a quadratic one, that of the serendipity functions.
fn centre(element: Element, corners: &[Vec3], others: &[Vec3]) -> Option<Vec3> {
    let sum = |x: &[Vec3]| x.iter().copied().sum::<Vec3>();
    let n = corners.len();
    match (element.order(), element.family()) {
        (1, _) => Some(sum(corners) / n as f64),
        (2, Family::Triangle) => Some((sum(others.get(..n)?) * 4.0 - sum(corners)) / 9.0),
        (2, _) => Some(sum(others.get(..n)?) * 0.5 - sum(corners) * 0.25),
        _ => {
            let mut shape = [0.0; MAX_FACET_NODES];
            element.shape(&element.centre(), shape.get_mut(..element.nnode())?);
            let nodes = corners.iter().chain(others);
            Some(nodes.zip(shape).map(|(&x, n)| x * n).sum())
        }
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
