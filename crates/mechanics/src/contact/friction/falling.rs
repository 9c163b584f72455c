use super::{FrictionLaw, Limit, Sliding};

/// `μ p` with `μ = kinetic + (static − kinetic) exp(−s/transition)`, `s` the length of slip before the increment.
///
/// # Limits
/// Within an increment μ is constant: the fall lags by up to one increment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Falling {
    /// μ before any slip.
    pub stationary: f64,
    /// μ after much slip.
    pub kinetic: f64,
    /// The length over which it falls.
    pub transition: f64,
}

impl FrictionLaw for Falling {
    fn limit(&self, at: &Sliding) -> Limit {
        let more = self.stationary - self.kinetic;
        let mu = self.kinetic + more * (-at.path / self.transition).exp();
        Limit {
            value: mu * at.pressure,
            dpressure: mu,
        }
    }
}
