//! Friction laws: the largest tangential traction as a function of pressure and sliding.
//!
//! A law is its limit surface; sticking, slipping and the return to the limit are written once for all of them, in the
//! kernel. To add one: a file that implements [`FrictionLaw`], and one line where cases are built.

mod frictionless;

pub use frictionless::Frictionless;

/// What a limit may depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sliding {
    /// Contact pressure, ≥ 0.
    pub pressure: f64,
    /// Length of the slip of this increment.
    pub increment: f64,
    /// Length of all slip since the start.
    pub total: f64,
    /// Duration of the increment.
    pub dt: f64,
}

/// The largest tangential traction, with its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limit {
    /// The limit, ≥ 0.
    pub value: f64,
    /// Derivative with respect to the pressure.
    pub dpressure: f64,
    /// Derivative with respect to the slip of this increment.
    pub dincrement: f64,
}

/// A friction law.
pub trait FrictionLaw: Send + Sync {
    /// The limit.
    fn limit(&self, at: &Sliding) -> Limit;

    /// Whether the limit is zero whatever happens, so that no tangential traction need be looked at.
    fn is_frictionless(&self) -> bool {
        false
    }
}
