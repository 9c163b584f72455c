//! The smallest distance of two facets over their common part, along a normal.
//!
//! A row that is a weighted mean may close where no point of its facets does: where the covering facet ends inside it and is
//! tilted, the mean is an extrapolation. The smallest gap between the planes of two facets is at a corner of the polygon, or
//! at an end of the interval, that they share in the projection along the normal.

use signorini_geometry::tensor::Vec3;

/// Corners of a polygon shared by two facets of four corners each, at most.
const CORNERS: usize = 8;

/// A facet by its corners, as seen along a normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flat<'a> {
    /// Its corners in their order.
    pub corners: &'a [Vec3],
    /// Its normal.
    pub normal: Vec3,
}

impl Flat<'_> {
    fn centre(&self) -> Vec3 {
        let n = self.corners.len().max(1) as f64;
        self.corners.iter().copied().sum::<Vec3>() / n
    }

    /// How far along `nu` from a point its plane is; `None` where that is seen edge-on.
    fn distance(&self, from: Vec3, nu: Vec3) -> Option<f64> {
        let slope = self.normal.dot(nu);
        let distance = self.normal.dot(self.centre() - from) / slope;
        distance.is_finite().then_some(distance)
    }
}

/// The smallest gap between a secondary and a primary facet over their common part along `nu`, out of the primary side; `None`
/// where they share nothing.
pub(super) fn least_gap(secondary: Flat, primary: Flat, nu: Vec3) -> Option<f64> {
    let [first, second, ..] = *secondary.corners else {
        return None;
    };
    let u = (second - first) - nu * nu.dot(second - first);
    let u = u.normalized()?;
    let v = nu.cross(u);
    let origin = secondary.centre();
    let on_plane = |x: &Vec3| [u.dot(*x - origin), v.dot(*x - origin)];
    let gap = |[a, b]: [f64; 2]| {
        let at = origin + u * a + v * b;
        Some(secondary.distance(at, nu)? - primary.distance(at, nu)?)
    };
    let mut shared = Shared::default();
    secondary
        .corners
        .iter()
        .for_each(|x| shared.push(on_plane(x)));
    if secondary.corners.len() == 2 {
        let [low, high] = [f64::min, f64::max].map(|of| {
            let ends = primary.corners.iter().map(|x| on_plane(x)[0]);
            ends.reduce(of).unwrap_or(0.0)
        });
        shared.cut(|p| p[0] - low);
        shared.cut(|p| high - p[0]);
    } else {
        let n = primary.corners.len();
        let corner = |k: usize| primary.corners.get(k % n.max(1)).map(on_plane);
        let area: f64 = (0..n)
            .filter_map(|k| Some((corner(k)?, corner(k + 1)?)))
            .map(|(p, q)| p[0] * q[1] - q[0] * p[1])
            .sum();
        for k in 0..n {
            let (Some(p), Some(q)) = (corner(k), corner(k + 1)) else {
                continue;
            };
            let side = |x: [f64; 2]| {
                area.signum() * ((q[0] - p[0]) * (x[1] - p[1]) - (q[1] - p[1]) * (x[0] - p[0]))
            };
            shared.cut(side);
        }
    }
    shared
        .corners()
        .iter()
        .filter_map(|&p| gap(p))
        .reduce(f64::min)
}

/// A convex polygon, or an interval of two ends.
#[derive(Clone, Copy, Default)]
struct Shared {
    at: [[f64; 2]; CORNERS],
    n: usize,
}

impl Shared {
    fn push(&mut self, p: [f64; 2]) {
        if let Some(to) = self.at.get_mut(self.n) {
            *to = p;
            self.n += 1;
        }
    }

    fn corners(&self) -> &[[f64; 2]] {
        self.at.get(..self.n).unwrap_or_default()
    }

    /// Leaves the part where a linear function is not negative.
    fn cut(&mut self, side: impl Fn([f64; 2]) -> f64) {
        let whole = *self;
        self.n = 0;
        let corners = whole.corners();
        for (k, &p) in corners.iter().enumerate() {
            let Some(&q) = corners.get((k + 1) % corners.len()) else {
                continue;
            };
            let (a, b) = (side(p), side(q));
            if a >= 0.0 {
                self.push(p);
            }
            if (a < 0.0) != (b < 0.0) {
                let s = a / (a - b);
                self.push([p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_gap(
        secondary: &[[f64; 3]],
        primary: &[[f64; 3]],
        normals: [[f64; 3]; 2],
        right: f64,
    ) {
        let [secondary, primary] =
            [secondary, primary].map(|of| of.iter().map(|x| Vec3::from(*x)).collect::<Vec<_>>());
        let [own, other] = normals.map(|n| Vec3::from(n).normalized().unwrap());
        let gap = least_gap(
            Flat {
                corners: &secondary,
                normal: own,
            },
            Flat {
                corners: &primary,
                normal: other,
            },
            -own,
        );
        assert!((gap.unwrap() - right).abs() < 1e-14, "{gap:?} {right}");
    }

    #[test]
    fn lines_are_closest_where_a_tilted_one_ends_over_the_other() {
        // the primary line ends at x = 0.6, 0.1 below, and falls by 1 in 2 from there
        let primary = [[0.6, -0.1, 0.0], [-1.4, -1.1, 0.0]];
        let secondary = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let normals = [[0.0, -1.0, 0.0], [-1.0, 2.0, 0.0]];
        assert_gap(&secondary, &primary, normals, 0.1);
        // where it covers the whole line, the closest point is an end of this
        let primary = [[2.6, 0.9, 0.0], [-1.4, -1.1, 0.0]];
        assert_gap(&secondary, &primary, normals, -0.1);
    }

    #[test]
    fn facets_are_closest_at_a_corner_of_what_they_share() {
        // z = -0.2 + 0.1 x + 0.05 y, over a triangle that cuts the corner of the square at x + y = 1.5
        let z = |x: f64, y: f64| [x, y, -0.2 + 0.1 * x + 0.05 * y];
        let secondary = [
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
        ];
        let primary = [z(2.0, -0.5), z(-0.5, 2.0), z(-0.5, -0.5)];
        let normals = [[0.0, 0.0, -1.0], [-0.1, -0.05, 1.0]];
        assert_gap(&secondary, &primary, normals, 0.2 - 0.1 - 0.025);
    }

    #[test]
    fn facets_that_share_nothing_have_no_gap() {
        let z = Vec3::unit(2);
        let square = |x: f64| {
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[a, b]| Vec3::new(a + x, b, 0.0))
        };
        let (one, other) = (square(0.0), square(1.5));
        let flat = |corners, normal| Flat { corners, normal };
        assert_eq!(least_gap(flat(&one, -z), flat(&other, z), z), None);
    }
}
