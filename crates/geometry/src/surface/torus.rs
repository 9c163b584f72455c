use super::SurfaceError;
use super::analytical::{Patch, Shape, Side, dyad, polar};
use super::error::AnalyticalError;
use super::error::NO_NORMAL;
use super::keys;
use super::mount::{direction, finite, positive};
use crate::tensor::{Sym3, Vec3};
use signorini_vocabulary::{Description, Entry, POSITIVE, Rule, key};

/// The entry of [`Torus`].
pub(super) const ENTRY: Entry<Box<dyn Shape>, AnalyticalError> = Entry {
    description: Description::new(
        "torus",
        "a ring with a round section",
        &[
            keys::CENTER,
            keys::AXIS,
            key(
                "radius",
                POSITIVE,
                "from the axis to the middle of the tube",
            )
            .required(),
            key("tube", POSITIVE, "radius of the tube")
                .required()
                .hints(&["minor_radius"]),
            keys::SIDE,
        ],
    )
    .hints(&["ring"])
    .rules(&[Rule::Below("tube", "radius")])
    .in_space("write `circle`, its section"),
    make: |values| {
        let center = values.vector("center")?.into();
        let axis = values.vector("axis")?.into();
        let (radius, tube) = (values.number("radius")?, values.number("tube")?);
        Ok(Box::new(Torus::new(
            center,
            axis,
            radius,
            tube,
            keys::side(values),
        )?))
    },
};

/// A ring of round section, or a channel of that shape. In the plane, two circles: side by side where the axis lies in
/// it, one in the other where it is along z.
///
/// With `e` away from the axis and `cos ψ = ν·e`, the curvatures of the outside are `1/tube` along the section and
/// `cos ψ / (radius + tube cos ψ)` around the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    centre: Vec3,
    axis: Vec3,
    radius: f64,
    tube: f64,
    side: Side,
}

impl Torus {
    /// Around an axis of any length: the radius of the circle in the middle of the tube, and that of the tube.
    ///
    /// # Errors
    /// Components that are not finite, an axis that is zero, a radius that is not positive, a tube that is not thinner
    /// than the ring.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::surface::{Shape, Side, Torus};
    /// use signorini_geometry::tensor::Vec3;
    ///
    /// let ring = Torus::new(Vec3::ZERO, Vec3::unit(2), 3.0, 1.0, Side::Outside)?;
    /// let on = ring.closest(Vec3::new(0.0, 7.0, 0.0))?.ok_or("on the axis")?;
    /// assert!((on - Vec3::new(0.0, 4.0, 0.0)).norm() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        centre: Vec3,
        axis: Vec3,
        radius: f64,
        tube: f64,
        side: Side,
    ) -> Result<Self, AnalyticalError> {
        let radius = positive("the radius of the torus", radius)?;
        let tube = positive("the tube's radius", tube)?;
        if tube >= radius {
            return Err(AnalyticalError::Tube { radius, tube });
        }
        Ok(Self {
            centre: finite("the centre of the torus", centre)?,
            axis: direction("the axis of the torus", axis)?,
            radius,
            tube,
            side,
        })
    }

    /// The point in the middle of the tube that is closest, the direction from there, and that away from the axis.
    fn section(&self, point: Vec3) -> Option<(Vec3, Vec3, Vec3)> {
        let (_, away) = polar(point - self.centre, self.axis);
        let (_, e) = away?;
        let middle = self.centre + e * self.radius;
        Some((middle, (point - middle).normalized()?, e))
    }
}

impl Shape for Torus {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let section = self.section(point);
        Ok(section.map(|(middle, normal, _)| middle + normal * self.tube))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let (_, normal, e) = self.section(on).ok_or(NO_NORMAL)?;
        let cos = normal.dot(e);
        let around = dyad(self.axis.cross(e));
        let along = Sym3::IDENTITY - dyad(normal) - around;
        let gradient = along * self.tube.recip() + around * (cos / (self.radius + self.tube * cos));
        Ok(self.side.of(Patch::smooth(normal, gradient)))
    }

    fn ball(&self) -> Option<(Vec3, f64)> {
        Some((self.centre, self.radius + self.tube))
    }

    fn out_of_plane(&self) -> Option<&'static str> {
        let across = self.axis.x == 0.0 && self.axis.y == 0.0;
        (self.centre.z != 0.0 || !(across || self.axis.z == 0.0))
            .then_some("the centre must have z = 0, and the axis must lie in z = 0 or be along z")
    }
}
