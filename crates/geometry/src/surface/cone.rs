use super::analytical::{Patch, Shape, Side, dyad, polar};
use super::error::AnalyticalError;
use super::mount::{direction, finite};
use super::{Feature, SurfaceError};
use crate::tensor::{Sym3, Vec3};
use signorini_vocabulary::{Bounds, Description, Entry, FREE, LINE, Shape as Form, VECTOR, key};

/// The entry of [`Cone`].
pub(super) const ENTRY: Entry<Box<dyn Shape>, AnalyticalError> = Entry {
    description: Description::new(
        "cone",
        "a cone without end; bodies are outside",
        &[
            key("apex", VECTOR, "its tip")
                .required()
                .hints(&["tip", "point"])
                .within_plane(),
            key(
                "axis",
                LINE,
                "\"x\", \"y\", \"z\" or a vector, from the tip into the cone",
            )
            .required()
            .within_plane(),
            key(
                "half_angle",
                ACUTE,
                "between the axis and the surface (degrees)",
            )
            .required()
            .hints(&["angle"]),
        ],
    )
    .in_space("write `plane`, its section"),
    make: |values| {
        let apex = values.vector("apex")?.into();
        let axis = values.vector("axis")?.into();
        let half_angle = values.number("half_angle")?.to_radians();
        Ok(Box::new(Cone::new(apex, axis, half_angle, Side::Outside)?))
    },
};

/// An angle in degrees.
const ACUTE: Form = Form::Number(Bounds {
    above: Some(0.0),
    below: Some(90.0),
    ..FREE
});

/// How close to the apex, over its coordinates, a point cannot be distinguished from it.
const TIP: f64 = 16.0 * f64::EPSILON;

/// A round cone that opens from its apex along its axis without end, or a hole of that shape. In the plane, a wedge.
///
/// ```text
///              e ▲   ╱               s, r   along the axis, away from it
///                │  ╱ generator      α      half angle
///          apex  │ ╱  l              l      along the generator, s cos α + r sin α
///              • ┼─α────▶ axis       ν      outside, e cos α − axis sin α
/// ```
///
/// Where `l ≤ 0` the apex is closest. The circle through a point of the surface has the radius `l sin α`, and its plane
/// meets the normal at the angle α, so that the curvature around is `cos α / (l sin α)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    apex: Vec3,
    axis: Vec3,
    sin: f64,
    cos: f64,
    side: Side,
}

impl Cone {
    /// From the apex along an axis of any length, with the angle between axis and surface in radians.
    ///
    /// # Errors
    /// Components that are not finite, an axis that is zero, an angle that is not between 0 and a right angle.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::surface::{Cone, Shape, Side};
    /// use signorini_geometry::tensor::Vec3;
    ///
    /// // 45° about z: the closest point of (2, 0, 0) is (1, 0, 1)
    /// let cone = Cone::new(Vec3::ZERO, Vec3::unit(2), std::f64::consts::FRAC_PI_4, Side::Outside)?;
    /// let on = cone.closest(Vec3::new(2.0, 0.0, 0.0))?.ok_or("no closest point")?;
    /// assert!((on - Vec3::new(1.0, 0.0, 1.0)).norm() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        apex: Vec3,
        axis: Vec3,
        half_angle: f64,
        side: Side,
    ) -> Result<Self, AnalyticalError> {
        let (sin, cos) = half_angle.sin_cos();
        if !(half_angle > 0.0 && half_angle < std::f64::consts::FRAC_PI_2) {
            let degrees = half_angle.to_degrees();
            return Err(AnalyticalError::HalfAngle { degrees });
        }
        Ok(Self {
            apex: finite("the apex of the cone", apex)?,
            axis: direction("the axis of the cone", axis)?,
            sin,
            cos,
            side,
        })
    }
}

impl Shape for Cone {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let (s, away) = polar(point - self.apex, self.axis);
        let (r, e) = match away {
            Some(away) => away,
            None if s > 0.0 => return Ok(None),
            None => return Ok(Some(self.apex)),
        };
        let l = s * self.cos + r * self.sin;
        if l <= TIP * self.apex.norm() {
            return Ok(Some(self.apex));
        }
        Ok(Some(self.apex + (self.axis * self.cos + e * self.sin) * l))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let (s, away) = polar(on - self.apex, self.axis);
        let patch = match away {
            Some((r, e)) => {
                let l = s * self.cos + r * self.sin;
                let normal = e * self.cos - self.axis * self.sin;
                let around = dyad(self.axis.cross(e)) * (self.cos / (l * self.sin));
                Patch::smooth(normal, around)
            }
            None => Patch {
                normal: -self.axis,
                gradient: Sym3::ZERO,
                feature: Feature::Vertex,
            },
        };
        Ok(self.side.of(patch))
    }

    fn out_of_plane(&self) -> Option<&'static str> {
        (self.axis.z != 0.0 || self.apex.z != 0.0).then_some("apex and axis must lie in z = 0")
    }
}
