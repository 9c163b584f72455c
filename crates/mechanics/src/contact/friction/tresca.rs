use super::{FrictionLaw, Limit, Sliding};
use signorini_vocabulary::{Description, Entry, POSITIVE, key};
use std::sync::Arc;

/// The entry of the law.
pub(super) const ENTRY: Entry<Arc<dyn FrictionLaw>> = Entry {
    description: Description::new(
        "tresca",
        "a constant wherever it touches",
        &[
            key("tresca", POSITIVE, "shear traction wherever it touches")
                .required()
                .hints(&["shear"]),
        ],
    ),
    make: |values| Ok(Arc::new(Tresca(values.number("tresca")?))),
};

/// A constant wherever it touches.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::friction::{FrictionLaw, Sliding, Tresca};
///
/// let limit = |pressure| Tresca(0.7).limit(&Sliding { pressure, path: 0.0 });
/// assert_eq!((limit(1.0).value, limit(9.0).value, limit(9.0).dpressure), (0.7, 0.7, 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tresca(
    /// The limit.
    pub f64,
);

impl FrictionLaw for Tresca {
    fn limits(&self, _: &[Sliding], out: &mut [Limit]) {
        out.fill(Limit {
            value: self.0,
            dpressure: 0.0,
        });
    }
}
