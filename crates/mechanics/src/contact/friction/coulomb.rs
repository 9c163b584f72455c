use super::{FrictionLaw, Limit, Sliding};

/// `μ p`, at most a cap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// μ.
    pub mu: f64,
    /// The cap; infinite where there is none.
    pub cap: f64,
}

impl FrictionLaw for Coulomb {
    fn limit(&self, at: &Sliding) -> Limit {
        let value = self.mu * at.pressure;
        if value < self.cap {
            Limit {
                value,
                dpressure: self.mu,
            }
        } else {
            Limit {
                value: self.cap,
                dpressure: 0.0,
            }
        }
    }
}
