use signorini_geometry::tensor::Vec3;
use std::f64::consts::TAU;

/// Space, or what a plane model stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Idealisation {
    /// Three dimensions.
    Space,
    /// A slice without strain across it.
    PlaneStrain {
        /// Length across the plane.
        thickness: f64,
    },
    /// A thin sheet without stress across it.
    PlaneStress {
        /// Length across the plane at the start.
        thickness: f64,
    },
    /// A body of revolution: x is the radius, y the axis. Forces and volumes are those of the full circumference.
    Axisymmetric,
}

impl Idealisation {
    /// Unknown displacements of a node.
    #[must_use]
    pub const fn ndim(&self) -> usize {
        match self {
            Self::Space => 3,
            _ => 2,
        }
    }

    /// What an area of the model's plane (in space: a volume) at a reference position is multiplied by: the
    /// thickness, or the circumference 2πr.
    #[inline]
    #[must_use]
    pub fn extent(&self, at: Vec3) -> f64 {
        match *self {
            Self::Space => 1.0,
            Self::PlaneStrain { thickness } | Self::PlaneStress { thickness } => thickness,
            Self::Axisymmetric => TAU * at.x,
        }
    }
}
