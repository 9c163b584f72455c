use super::SurfaceError;
use super::analytical::{Patch, Shape};
use super::error::AnalyticalError;
use super::mount::{direction, finite};
use crate::tensor::{Sym3, Vec3};
use signorini_vocabulary::{Description, Entry, LINE, VECTOR, key};

/// The entry of [`Plane`].
pub(super) const ENTRY: Entry<Box<dyn Shape>, AnalyticalError> = Entry {
    description: Description::new(
        "plane",
        "a plane without end; in the plane, a line",
        &[
            key("point", VECTOR, "a point of it")
                .required()
                .within_plane(),
            key(
                "normal",
                LINE,
                "\"x\", \"y\", \"z\" or a vector, towards the bodies",
            )
            .required()
            .within_plane(),
        ],
    )
    .hints(&["line", "plain"]),
    make: |values| {
        let point = values.vector("point")?.into();
        Ok(Box::new(Plane::new(
            point,
            values.vector("normal")?.into(),
        )?))
    },
};

/// A half space, bounded by a plane; in the plane, by a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: Vec3,
    normal: Vec3,
}

impl Plane {
    /// Through a point, with the normal out of the body, of any length.
    ///
    /// # Errors
    /// Components that are not finite, a normal that is zero.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::surface::{Plane, Shape};
    /// use signorini_geometry::tensor::Vec3;
    ///
    /// let floor = Plane::new(Vec3::ZERO, Vec3::unit(2))?;
    /// let below = floor.closest(Vec3::new(1.0, 2.0, 3.0))?;
    /// assert_eq!(below, Some(Vec3::new(1.0, 2.0, 0.0)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(point: Vec3, normal: Vec3) -> Result<Self, AnalyticalError> {
        Ok(Self {
            point: finite("the point of the plane", point)?,
            normal: direction("the normal of the plane", normal)?,
        })
    }
}

impl Shape for Plane {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let gap = (point - self.point).dot(self.normal);
        Ok(Some(point - self.normal * gap))
    }

    fn patch(&self, _: Vec3) -> Result<Patch, SurfaceError> {
        Ok(Patch::smooth(self.normal, Sym3::ZERO))
    }

    fn out_of_plane(&self) -> Option<&'static str> {
        (self.normal.z != 0.0).then_some("the normal must have no component along z")
    }
}
