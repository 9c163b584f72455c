use super::error::AnalyticalError;
use super::{Carrier, Placement, RigidId};
use crate::tensor::{Mat3, Vec3};

/// What a rigid surface is fastened to. Its geometry is given in the initial configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    /// The number of tangents: 2 in space, 1 in the plane.
    pub ntan: usize,
    /// The rigid body that carries the surface; `None` where it is fixed in space.
    pub body: Option<RigidId>,
    /// Initial position of the body's reference point.
    pub reference: Vec3,
}

impl Mount {
    /// Fixed in space, with this number of tangents.
    #[must_use]
    pub const fn fixed(ntan: usize) -> Self {
        Self {
            ntan,
            body: None,
            reference: Vec3::ZERO,
        }
    }

    /// Carried by a rigid body whose reference point is here at the start.
    #[must_use]
    pub const fn on(ntan: usize, body: RigidId, reference: Vec3) -> Self {
        Self {
            ntan,
            body: Some(body),
            reference,
        }
    }

    pub(super) fn validated(self) -> Result<Self, AnalyticalError> {
        if !(1..=2).contains(&self.ntan) {
            return Err(AnalyticalError::Tangents { ntan: self.ntan });
        }
        finite("the reference point", self.reference)?;
        Ok(self)
    }

    pub(super) fn carrier(&self) -> Carrier<'static> {
        self.body.map_or(Carrier::Fixed, Carrier::Rigid)
    }

    /// How the surface has moved. A body without a pose is where it was at the start.
    pub(super) fn motion(&self, at: &Placement) -> Motion {
        let pose = self.body.and_then(|b| at.poses.get(b as usize));
        Motion {
            reference: self.reference,
            origin: pose.map_or(self.reference, |p| p.origin),
            rotation: pose.map_or(Mat3::IDENTITY, |p| p.rotation),
        }
    }
}

/// A rigid motion from the initial configuration, `x = origin + rotation (X − reference)`.
pub(super) struct Motion {
    reference: Vec3,
    origin: Vec3,
    rotation: Mat3,
}

impl Motion {
    /// From an initial to the present position.
    pub(super) fn point(&self, initial: Vec3) -> Vec3 {
        self.origin + self.rotation * (initial - self.reference)
    }

    /// From an initial to the present direction.
    pub(super) fn vector(&self, initial: Vec3) -> Vec3 {
        self.rotation * initial
    }

    /// From a present to the initial position.
    pub(super) fn undone(&self, present: Vec3) -> Vec3 {
        self.reference + self.rotation.transpose() * (present - self.origin)
    }
}

/// This vector, if its components are finite.
pub(super) fn finite(what: &'static str, value: Vec3) -> Result<Vec3, AnalyticalError> {
    let error = AnalyticalError::NotFinite { what };
    value.is_finite().then_some(value).ok_or(error)
}

/// This length, if it is positive and finite.
pub(super) fn positive(what: &'static str, value: f64) -> Result<f64, AnalyticalError> {
    let error = AnalyticalError::NotPositive { what, value };
    (value > 0.0 && value.is_finite())
        .then_some(value)
        .ok_or(error)
}

/// The unit vector in this direction.
pub(super) fn direction(what: &'static str, value: Vec3) -> Result<Vec3, AnalyticalError> {
    finite(what, value)?;
    // the largest component first: squares of huge or tiny ones leave the range of numbers
    let scaled = value / value.max_abs();
    scaled
        .normalized()
        .ok_or(AnalyticalError::NoDirection { what })
}
