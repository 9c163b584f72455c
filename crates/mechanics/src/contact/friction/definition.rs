//! What a friction law is.

use std::fmt::Debug;

/// What a limit may depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sliding {
    /// Contact pressure, ≥ 0.
    pub pressure: f64,
    /// Length of all slip before this increment, since contact was made.
    pub path: f64,
}

/// The largest tangential traction, with its derivative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limit {
    /// The limit, ≥ 0.
    pub value: f64,
    /// Derivative with respect to the pressure.
    pub dpressure: f64,
}

/// A friction law.
pub trait FrictionLaw: Debug + Send + Sync {
    /// The limits of many rows that touch.
    ///
    /// # Shapes
    /// One answer for each row, which does not depend on the others.
    fn limits(&self, at: &[Sliding], out: &mut [Limit]);

    /// The limit of one row that touches.
    fn limit(&self, at: &Sliding) -> Limit {
        let mut out = [Limit::default()];
        self.limits(std::slice::from_ref(at), &mut out);
        let [limit] = out;
        limit
    }
}

/// What a contact that sticks yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stick {
    /// Traction per elastic slip.
    Stiffness(f64),
    /// The elastic slip at which the limit is reached.
    Slip(f64),
}
