use super::SurfaceError;
use super::analytical::{Patch, Shape, Side, dyad};
use super::error::AnalyticalError;
use super::error::NO_NORMAL;
use super::keys;
use super::mount::{finite, positive};
use crate::tensor::{Sym3, Vec3};
use signorini_vocabulary::{Description, Entry, Key, Values};

/// The entry of [`Sphere`].
pub(super) const ENTRY: Entry<Box<dyn Shape>, AnalyticalError> = Entry {
    description: Description::new("sphere", "a sphere; in the plane, write `circle`", KEYS)
        .hints(&["ball"])
        .in_space("write `circle`"),
    make,
};

/// The entry of [`Sphere`] in the plane.
pub(super) const CIRCLE: Entry<Box<dyn Shape>, AnalyticalError> = Entry {
    description: Description::new("circle", "of a model in the plane", KEYS)
        .in_the_plane("write `sphere` or `cylinder`"),
    make,
};

const KEYS: &[Key] = &[keys::CENTER, keys::RADIUS, keys::SIDE];

fn make(values: &Values) -> Result<Box<dyn Shape>, AnalyticalError> {
    let center = values.vector("center")?.into();
    let radius = values.number("radius")?;
    Ok(Box::new(Sphere::new(center, radius, keys::side(values))?))
}

/// A ball or a round hole; in the plane, a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    centre: Vec3,
    radius: f64,
    side: Side,
}

impl Sphere {
    /// Around a centre.
    ///
    /// # Errors
    /// A centre that is not finite, a radius that is not positive.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::surface::{Shape, Side, Sphere};
    /// use signorini_geometry::tensor::Vec3;
    ///
    /// let ball = Sphere::new(Vec3::ZERO, 2.0, Side::Outside)?;
    /// assert_eq!(ball.closest(Vec3::new(0.0, 0.0, 5.0))?, Some(Vec3::new(0.0, 0.0, 2.0)));
    /// // both curvatures are 1/R
    /// let patch = ball.patch(Vec3::new(0.0, 0.0, 2.0))?;
    /// assert_eq!((patch.gradient.xx(), patch.gradient.yy()), (0.5, 0.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(centre: Vec3, radius: f64, side: Side) -> Result<Self, AnalyticalError> {
        Ok(Self {
            centre: finite("the centre of the sphere", centre)?,
            radius: positive("the radius of the sphere", radius)?,
            side,
        })
    }
}

impl Shape for Sphere {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let direction = (point - self.centre).normalized();
        Ok(direction.map(|e| self.centre + e * self.radius))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let normal = (on - self.centre).normalized().ok_or(NO_NORMAL)?;
        let gradient = (Sym3::IDENTITY - dyad(normal)) * self.radius.recip();
        Ok(self.side.of(Patch::smooth(normal, gradient)))
    }

    fn ball(&self) -> Option<(Vec3, f64)> {
        Some((self.centre, self.radius))
    }

    fn out_of_plane(&self) -> Option<&'static str> {
        (self.centre.z != 0.0).then_some("the centre must have z = 0")
    }
}
