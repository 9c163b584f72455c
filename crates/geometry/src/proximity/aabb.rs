use crate::tensor::Vec3;

/// A box with sides along the axes. May be empty (`min > max`) or unbounded.
///
/// # Example
/// ```
/// use signorini_geometry::proximity::Aabb;
/// use signorini_geometry::tensor::Vec3;
///
/// let unit = Aabb::around([Vec3::ZERO, Vec3::new(1.0, 1.0, 1.0)]);
/// assert!(unit.contains(Vec3::new(0.5, 0.5, 1.0)));
/// // the closest point is an edge at the distance 5
/// assert_eq!(unit.distance_squared(Vec3::new(4.0, 5.0, 0.5)), 25.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The smallest coordinates.
    pub min: Vec3,
    /// The largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that contains nothing.
    pub const EMPTY: Self = Self {
        min: Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        max: Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The box that contains everything.
    pub const ALL: Self = Self {
        min: Self::EMPTY.max,
        max: Self::EMPTY.min,
    };

    /// The smallest box around these points.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self {
            min: b.min.min(p),
            max: b.max.max(p),
        })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The box with every side moved outwards by `distance`.
    #[must_use]
    pub fn inflated(self, distance: f64) -> Self {
        let d = Vec3::new(distance, distance, distance);
        Self {
            min: self.min - d,
            max: self.max + d,
        }
    }

    /// Whether the point is inside or on the boundary.
    #[must_use]
    pub fn contains(&self, p: Vec3) -> bool {
        (0..3).all(|i| self.min[i] <= p[i] && p[i] <= self.max[i])
    }

    /// Whether the boxes share a point.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
            && !self.is_empty()
            && !other.is_empty()
    }

    /// Whether the box has a point within `distance ≥ 0` of `p`.
    #[must_use]
    pub fn within(&self, p: Vec3, distance: f64) -> bool {
        self.distance_squared(p) <= distance * distance && !self.is_empty()
    }

    /// Whether the line `origin + s direction`, `0 ≤ s ≤ 1`, has a point in the box.
    #[must_use]
    pub fn is_crossed(&self, origin: Vec3, direction: Vec3) -> bool {
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for i in 0..3 {
            let (from, along) = (origin[i], direction[i]);
            if along == 0.0 {
                if !(self.min[i] <= from && from <= self.max[i]) {
                    return false;
                }
                continue;
            }
            let (a, b) = ((self.min[i] - from) / along, (self.max[i] - from) / along);
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        }
        first <= last && !self.is_empty()
    }

    /// Whether the box contains nothing: `min > max` along some axis, or a bound that is not a number.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Whether the box contains something and all its bounds are finite.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        !self.is_empty() && self.min.is_finite() && self.max.is_finite()
    }

    /// The middle.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// The lengths of the sides.
    #[must_use]
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// The sum of the lengths of the sides, 0 where the box contains nothing: proportional to its mean width, the
    /// chance that a plane hits it. Unlike the surface area it does not vanish for boxes around straight lines.
    #[must_use]
    pub fn width(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let extent = self.extent();
        extent.x + extent.y + extent.z
    }

    /// The largest `direction · x` of its points; of no meaning where the box contains nothing.
    #[must_use]
    pub fn furthest(&self, direction: Vec3) -> f64 {
        let along = |i: usize| match direction[i] {
            d if d > 0.0 => d * self.max[i],
            d if d < 0.0 => d * self.min[i],
            // whatever the bound
            _ => 0.0,
        };
        along(0) + along(1) + along(2)
    }

    /// The square of the distance from a point to the box, 0 inside; of no meaning where the box contains nothing.
    #[must_use]
    pub fn distance_squared(&self, p: Vec3) -> f64 {
        let outside = (self.min - p).max(p - self.max).max(Vec3::ZERO);
        outside.norm_squared()
    }
}
