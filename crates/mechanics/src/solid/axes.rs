//! Axes of materials in undeformed bodies.

use super::error::SolidError;
use signorini_geometry::tensor::{Mat3, Vec3};

/// How the axes of a material lie in an undeformed body, evaluated at its quadrature points. Rows of a matrix are axes.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialAxes {
    /// The same everywhere.
    Uniform(Mat3),
    /// Radial, circumferential and along an axis.
    Cylindrical(Cylindrical),
    /// Those of each cell of the body, in its order.
    OfCells(Vec<Mat3>),
}

/// Axes around a line: the first points away from it, the third along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylindrical {
    origin: Vec3,
    along: Vec3,
    turn: Mat3,
}

/// The distance from the line, over the size of the body, that gives no radial direction.
const ON_AXIS: f64 = 1e-10;

impl Cylindrical {
    /// Around the line through `origin` along `axis`, of any length; `None` where that is zero or no number.
    #[must_use]
    pub fn new(origin: Vec3, axis: Vec3) -> Option<Self> {
        let along = axis.normalized()?;
        let turn = Mat3::IDENTITY;
        origin
            .to_array()
            .iter()
            .all(|x| x.is_finite())
            .then_some(Self {
                origin,
                along,
                turn,
            })
    }

    /// Turned at every point by [`turn_about`](signorini_geometry::tensor::turn_about).
    #[must_use]
    pub fn turned(self, turn: Mat3) -> Self {
        Self { turn, ..self }
    }

    /// The axes at a point; `None` on the line, in a body of this size.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::tensor::Vec3;
    /// use signorini_mechanics::solid::Cylindrical;
    ///
    /// let around_z = Cylindrical::new(Vec3::ZERO, Vec3::new(0.0, 0.0, 2.0)).ok_or("no axis")?;
    /// let axes = around_z.at(Vec3::new(0.0, 3.0, 7.0), 10.0).ok_or("on the axis")?;
    /// // radial is y, circumferential −x
    /// assert_eq!(axes.rows, [Vec3::unit(1), -Vec3::unit(0), Vec3::unit(2)]);
    /// assert!(around_z.at(Vec3::new(0.0, 1e-10, 7.0), 10.0).is_none());
    /// # Ok::<(), &'static str>(())
    /// ```
    #[must_use]
    pub fn at(&self, point: Vec3, size: f64) -> Option<Mat3> {
        let out = point - self.origin;
        let radial = out - self.along * out.dot(self.along);
        if radial.norm().total_cmp(&(ON_AXIS * size)).is_le() {
            return None;
        }
        let radial = radial.normalized()?;
        let plain = Mat3::from_rows([radial, self.along.cross(radial), self.along]);
        Some(self.turn * plain)
    }
}

/// The axes in the cells of one element.
#[derive(Clone, Debug, Default)]
pub(super) struct Frames {
    /// Cell by cell; one for all where `of_cell` is zero.
    all: Vec<Mat3>,
    /// How many a cell has: one, or one of each point.
    of_cell: usize,
}

impl Frames {
    /// One for all cells.
    pub fn uniform(axes: Mat3) -> Self {
        Self {
            all: vec![axes],
            of_cell: 0,
        }
    }

    /// One of each cell.
    pub fn of_cells(all: Vec<Mat3>) -> Self {
        Self { all, of_cell: 1 }
    }

    /// One of each point, `npoint` of a cell.
    pub fn of_points(all: Vec<Mat3>, npoint: usize) -> Self {
        Self {
            all,
            of_cell: npoint,
        }
    }

    /// Those of a cell: none, one, or one of each point.
    pub fn of(&self, cell: usize) -> &[Mat3] {
        match self.of_cell {
            0 => &self.all,
            n => self.all.get(cell * n..(cell + 1) * n).unwrap_or_default(),
        }
    }
}

/// An element with a point on the axis around which its material lies.
pub(super) fn on_axis(body: &str, label: u64) -> SolidError {
    SolidError::OnAxis {
        body: body.to_string(),
        label,
    }
}
