use super::{FrictionLaw, Limit, Sliding};

/// No friction at all.
#[derive(Clone, Copy, Debug)]
pub struct Frictionless;

impl FrictionLaw for Frictionless {
    fn limit(&self, _: &Sliding) -> Limit {
        Limit::default()
    }

    fn is_frictionless(&self) -> bool {
        true
    }
}
