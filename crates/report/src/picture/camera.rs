//! From space to the picture: an orthographic view.

/// A view of a model.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    right: [f64; 3],
    up: [f64; 3],
    towards: [f64; 3],
    middle: [f64; 3],
    /// Pixels per length.
    scale: f64,
    /// Where the middle is in the picture.
    centre: [f64; 2],
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The inner product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// The vector of length 1; the third axis where there is no direction.
pub fn unit(a: [f64; 3]) -> [f64; 3] {
    let norm = dot(a, a).sqrt();
    match norm.is_finite() && norm > 0.0 {
        true => a.map(|x| x / norm),
        false => [0.0, 0.0, 1.0],
    }
}

/// The unit normal of a triangle.
pub fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    unit(cross(minus(b, a), minus(c, a)))
}

impl Camera {
    /// Looks at all points from the direction `towards`, z up (y up where z is the direction itself), so that they fill the
    /// rectangle from `x[0]`, `y[0]` to `x[1]`, `y[1]`.
    #[must_use]
    pub fn fit(points: &[[f64; 3]], towards: [f64; 3], x: [f64; 2], y: [f64; 2]) -> Self {
        let towards = unit(towards);
        let up = match towards[2].abs() > 0.999 {
            true => [0.0, 1.0, 0.0],
            false => [0.0, 0.0, 1.0],
        };
        let right = unit(cross(up, towards));
        let up = cross(towards, right);
        let axes = [right, up, towards];
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for point in points
            .iter()
            .filter(|point| point.iter().all(|x| x.is_finite()))
        {
            for (k, axis) in axes.iter().enumerate() {
                let along = dot(*axis, *point);
                low[k] = low[k].min(along);
                high[k] = high[k].max(along);
            }
        }
        let size = |k: usize| (high[k] - low[k]).max(f64::MIN_POSITIVE);
        let along: [f64; 3] = std::array::from_fn(|k| match low[k] <= high[k] {
            true => 0.5 * (low[k] + high[k]),
            false => 0.0,
        });
        let middle =
            std::array::from_fn(|k| right[k] * along[0] + up[k] * along[1] + towards[k] * along[2]);
        let scale = ((x[1] - x[0]) / size(0)).min((y[1] - y[0]) / size(1));
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
    pub fn project(&self, point: [f64; 3]) -> [f64; 3] {
        let from = minus(point, self.middle);
        [
            self.centre[0] + self.scale * dot(self.right, from),
            self.centre[1] - self.scale * dot(self.up, from),
            self.scale * dot(self.towards, from),
        ]
    }

    /// How much light comes back from a surface of this normal, from 0 to 1; both sides are lit.
    #[must_use]
    pub fn light(&self, normal: [f64; 3]) -> f64 {
        let facing = dot(self.towards, normal);
        let facing = if facing < 0.0 {
            normal.map(|x| -x)
        } else {
            normal
        };
        let lamp: [f64; 3] =
            std::array::from_fn(|k| self.towards[k] + 0.5 * self.up[k] - 0.35 * self.right[k]);
        0.7 + 0.3 * dot(unit(lamp), facing).max(0.0)
    }

    /// Where the three axes point in the picture, to the right and down, as parts of their length.
    #[must_use]
    pub fn axes(&self) -> [[f64; 2]; 3] {
        std::array::from_fn(|k| [self.right[k], -self.up[k]])
    }
}
