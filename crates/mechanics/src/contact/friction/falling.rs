use super::{FrictionLaw, Limit, Sliding};
use signorini_vocabulary::{Description, Entry, NOT_NEGATIVE, POSITIVE, Rule, key};
use std::sync::Arc;

/// The entry of the law.
pub(super) const ENTRY: Entry<Arc<dyn FrictionLaw>> = Entry {
    description: Description::new(
        "falling",
        "a share of the pressure that falls with the length of slip",
        &[
            key("static", POSITIVE, "coefficient before any slip")
                .required()
                .hints(&["mu_s", "mu_static"]),
            key("kinetic", NOT_NEGATIVE, "coefficient after much slip")
                .required()
                .hints(&["mu_k", "mu_kinetic", "dynamic"]),
            key(
                "transition",
                POSITIVE,
                "length of slip over which the one becomes the other",
            )
            .required()
            .hints(&["decay"]),
        ],
    )
    .rules(&[Rule::NotAbove("kinetic", "static")]),
    make: |values| {
        Ok(Arc::new(Falling {
            stationary: values.number("static")?,
            kinetic: values.number("kinetic")?,
            transition: values.number("transition")?,
        }))
    },
};

/// `μ p` with `μ = kinetic + (static − kinetic) exp(−s/transition)`, `s` the length of slip before the increment.
///
/// # Limits
/// Within an increment μ is constant: the fall lags by up to one increment.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::friction::{Falling, FrictionLaw, Sliding};
///
/// let law = Falling { stationary: 0.4, kinetic: 0.2, transition: 0.1 };
/// let mu = |path| law.limit(&Sliding { pressure: 1.0, path }).value;
/// assert_eq!(mu(0.0), 0.4);
/// // after the length of transition, 1/e of the difference is left
/// assert!((mu(0.1) - (0.2 + 0.2 / std::f64::consts::E)).abs() < 1e-15);
/// ```
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
    fn limits(&self, at: &[Sliding], out: &mut [Limit]) {
        let more = self.stationary - self.kinetic;
        for (out, at) in out.iter_mut().zip(at) {
            let mu = self.kinetic + more * (-at.path / self.transition).exp();
            *out = Limit {
                value: mu * at.pressure,
                dpressure: mu,
            };
        }
    }
}
