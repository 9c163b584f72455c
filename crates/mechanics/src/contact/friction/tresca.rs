use super::{FrictionLaw, Limit, Sliding};

/// A constant wherever it touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tresca(
    /// The limit.
    pub f64,
);

impl FrictionLaw for Tresca {
    fn limit(&self, _: &Sliding) -> Limit {
        Limit {
            value: self.0,
            dpressure: 0.0,
        }
    }
}
