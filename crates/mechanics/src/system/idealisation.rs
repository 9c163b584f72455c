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

/// What a thickness is multiplied by where nodes with this profile have these shape functions; 1 without a profile.
///
/// # Example
/// ```
/// use signorini_mechanics::system::profile_at;
/// assert_eq!(profile_at(&[0.5, 1.5], &[0.25, 0.75]), 1.25);
/// assert_eq!(profile_at(&[], &[0.25, 0.75]), 1.0);
/// ```
#[inline]
#[must_use]
pub fn profile_at(profile: &[f64], shape: &[f64]) -> f64 {
    if profile.is_empty() {
        return 1.0;
    }
    profile.iter().zip(shape).map(|(p, n)| p * n).sum()
}
