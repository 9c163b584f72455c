//! What is given of heat across an interface.

use crate::contact::law::Conductance;

/// How an interface conducts, and what becomes of the heat of friction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactHeat {
    /// The ways that heat takes.
    pub paths: Vec<Conductance>,
    /// The heat of friction; none: it is lost.
    pub friction: Option<FrictionHeat>,
    /// The temperature of a primary side that has no nodes; none: it neither gives nor takes heat.
    pub primary: Option<f64>,
    /// The part of the conductance that counts: a half in each of two passes.
    pub share: f64,
}

/// What becomes of the heat of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionHeat {
    /// η: the part of its work that becomes heat.
    pub fraction: f64,
    /// f: the part of that which the secondary side takes.
    pub to_secondary: f64,
}

impl ContactHeat {
    /// The same in each of several passes, which share the conductance; each has the friction of its own.
    #[must_use]
    pub fn in_passes(self, count: u32) -> Self {
        Self {
            share: self.share / f64::from(count),
            ..self
        }
    }
}

impl FrictionHeat {
    /// a/β: what a participant of a side takes of the heat.
    pub(super) fn taken(&self, side: f64) -> f64 {
        match side > 0.0 {
            true => self.to_secondary,
            false => self.to_secondary - 1.0,
        }
    }
}
