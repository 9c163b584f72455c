//! From space to the picture: an orthographic view.

use signorini_geometry::proximity::Aabb;
use signorini_geometry::tensor::Vec3;

/// A view of a model.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    right: Vec3,
    up: Vec3,
    towards: Vec3,
    middle: Vec3,
    /// Pixels per length.
    scale: f64,
    /// Where the middle is in the picture.
    centre: [f64; 2],
}

/// The vector of length 1; the third axis where there is no direction.
pub fn unit(a: Vec3) -> Vec3 {
    a.normalized().unwrap_or(Vec3::unit(2))
}

/// The unit normal of a triangle.
pub fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    unit((b - a).cross(c - a))
}

impl Camera {
    /// Looks at all points from the direction `towards`, z up (y up where z is the direction itself), so that they fill the
    /// rectangle from `x[0]`, `y[0]` to `x[1]`, `y[1]`.
    #[must_use]
    pub fn fit(points: &[Vec3], towards: Vec3, x: [f64; 2], y: [f64; 2]) -> Self {
        let towards = unit(towards);
        let up = match towards.z.abs() > 0.999 {
            true => Vec3::unit(1),
            false => Vec3::unit(2),
        };
        let right = unit(up.cross(towards));
        let up = towards.cross(right);
        let finite = points.iter().filter(|point| point.is_finite());
        let bounds =
            Aabb::around(finite.map(|p| Vec3::new(right.dot(*p), up.dot(*p), towards.dot(*p))));
        let (along, size) = match bounds.is_empty() {
            true => (Vec3::ZERO, Vec3::ZERO),
            false => (bounds.centre(), bounds.extent()),
        };
        let middle = right * along.x + up * along.y + towards * along.z;
        let per = |side: [f64; 2], size: f64| (side[1] - side[0]) / size.max(f64::MIN_POSITIVE);
        let scale = per(x, size.x).min(per(y, size.y));
        Self {
            right,
            up,
            towards,
            middle,
            scale: if scale.is_finite() { scale } else { 1.0 },
            centre: [0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])],
        }
    }

    /// Pixels from the left and from the top, and the depth towards the eye, also in pixels.
    #[must_use]
    pub fn project(&self, point: Vec3) -> [f64; 3] {
        let from = point - self.middle;
        [
            self.centre[0] + self.scale * self.right.dot(from),
            self.centre[1] - self.scale * self.up.dot(from),
            self.scale * self.towards.dot(from),
        ]
    }

    /// How much light comes back from a surface of this normal, from 0 to 1; both sides are lit.
    #[must_use]
    pub fn light(&self, normal: Vec3) -> f64 {
        let facing = match self.towards.dot(normal) < 0.0 {
            true => -normal,
            false => normal,
        };
        let lamp = self.towards + self.up * 0.5 - self.right * 0.35;
        0.7 + 0.3 * unit(lamp).dot(facing).max(0.0)
    }

    /// Where the three axes point in the picture, to the right and down, as parts of their length.
    #[must_use]
    pub fn axes(&self) -> [[f64; 2]; 3] {
        std::array::from_fn(|k| [self.right[k], -self.up[k]])
    }
}
