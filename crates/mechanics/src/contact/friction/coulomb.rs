use super::{FrictionLaw, Limit, Sliding};
use signorini_vocabulary::{Description, Entry, NOT_NEGATIVE, POSITIVE, key};
use std::sync::Arc;

/// The entry of the law.
pub(super) const ENTRY: Entry<Arc<dyn FrictionLaw>> = Entry {
    description: Description::new(
        "coulomb",
        "a share of the pressure, at most a cap",
        &[
            key("mu", NOT_NEGATIVE, "coefficient of friction").required(),
            key("cap", POSITIVE, "largest shear traction, with `mu`").hints(&["tau_max", "taumax"]),
        ],
    ),
    make: |values| {
        Ok(Arc::new(Coulomb {
            mu: values.number("mu")?,
            cap: values.number_if("cap").unwrap_or(f64::INFINITY),
        }))
    },
};

/// `μ p`, at most a cap.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::friction::{Coulomb, FrictionLaw, Sliding};
///
/// let law = Coulomb { mu: 0.3, cap: 5.0 };
/// let limit = |pressure| law.limit(&Sliding { pressure, path: 0.0 }).value;
/// assert_eq!((limit(10.0), limit(100.0)), (3.0, 5.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// μ.
    pub mu: f64,
    /// The cap; infinite where there is none.
    pub cap: f64,
}

impl FrictionLaw for Coulomb {
    fn limits(&self, at: &[Sliding], out: &mut [Limit]) {
        for (out, at) in out.iter_mut().zip(at) {
            let value = self.mu * at.pressure;
            *out = if value < self.cap {
                Limit {
                    value,
                    dpressure: self.mu,
                }
            } else {
                Limit {
                    value: self.cap,
                    dpressure: 0.0,
                }
            };
        }
    }
}
