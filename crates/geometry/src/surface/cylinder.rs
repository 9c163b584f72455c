use super::SurfaceError;
use super::analytical::{Patch, Shape, Side, dyad, polar};
use super::error::AnalyticalError;
use super::error::NO_NORMAL;
use super::keys;
use super::mount::{direction, finite, positive};
use crate::tensor::{Sym3, Vec3};
use signorini_vocabulary::{Description, Entry, VECTOR, key};

/// The entry of [`Cylinder`].
pub(super) const ENTRY: Entry<Box<dyn Shape>, AnalyticalError> = Entry {
    description: Description::new(
        "cylinder",
        "a cylinder without ends",
        &[
            key("point", VECTOR, "a point of its axis")
                .required()
                .hints(&["center"])
                .within_plane(),
            keys::AXIS,
            keys::RADIUS,
            keys::SIDE,
        ],
    )
    .in_space("write `circle`, its section"),
    make: |values| {
        let point = values.vector("point")?.into();
        let axis = values.vector("axis")?.into();
        let radius = values.number("radius")?;
        Ok(Box::new(Cylinder::new(
            point,
            axis,
            radius,
            keys::side(values),
        )?))
    },
};

/// A round rod or bore without ends. In the plane, a circle where its axis is along z, a strip where it lies in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    point: Vec3,
    axis: Vec3,
    radius: f64,
    side: Side,
}

impl Cylinder {
    /// Around the axis through a point, in a direction of any length.
    ///
    /// # Errors
    /// Components that are not finite, an axis that is zero, a radius that is not positive.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::surface::{Cylinder, Shape, Side};
    /// use signorini_geometry::tensor::Vec3;
    ///
    /// let hole = Cylinder::new(Vec3::ZERO, Vec3::unit(2), 2.0, Side::Inside)?;
    /// let on = hole.closest(Vec3::new(1.0, 0.0, 7.0))?.ok_or("on the axis")?;
    /// assert_eq!(on, Vec3::new(2.0, 0.0, 7.0));
    /// // a point inside the hole sees a normal that points to the axis
    /// assert_eq!(hole.patch(on)?.normal, -Vec3::unit(0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(point: Vec3, axis: Vec3, radius: f64, side: Side) -> Result<Self, AnalyticalError> {
        Ok(Self {
            point: finite("the point of the cylinder", point)?,
            axis: direction("the axis of the cylinder", axis)?,
            radius: positive("the radius of the cylinder", radius)?,
            side,
        })
    }
}

impl Shape for Cylinder {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let (along, away) = polar(point - self.point, self.axis);
        Ok(away.map(|(_, e)| self.point + self.axis * along + e * self.radius))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let (_, away) = polar(on - self.point, self.axis);
        let (_, normal) = away.ok_or(NO_NORMAL)?;
        let around = Sym3::IDENTITY - dyad(normal) - dyad(self.axis);
        let patch = Patch::smooth(normal, around * self.radius.recip());
        Ok(self.side.of(patch))
    }

    fn out_of_plane(&self) -> Option<&'static str> {
        let across = self.axis.x == 0.0 && self.axis.y == 0.0;
        let within = self.axis.z == 0.0 && self.point.z == 0.0;
        let wanted = "the axis must lie in z = 0 or be along z";
        (!across && !within).then_some(wanted)
    }
}
