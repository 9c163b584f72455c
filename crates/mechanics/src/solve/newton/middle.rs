//! What terms see of an iterate where inertia counts: a state between the ends of the increment.

use crate::system::{Layout, Scheme, State};

/// The state between an accepted one and that of the iterate.
pub(super) struct Middle {
    scheme: Scheme,
    layout: Layout,
    from: State,
    pub state: State,
}

impl Middle {
    /// That of an increment from this accepted state; none where inertia does not count.
    pub fn new(scheme: Option<&Scheme>, layout: &Layout, from: &State) -> Option<Self> {
        scheme.map(|scheme| {
            let state = State {
                rates: None,
                ..from.clone()
            };
            Self {
                scheme: *scheme,
                layout: *layout,
                from: state.clone(),
                state,
            }
        })
    }

    /// The iterate has moved.
    pub fn follow(&mut self, trial: &State) {
        self.state
            .set_between(&self.scheme, &self.layout, [&self.from, trial]);
    }
}

/// The state where terms are evaluated.
pub(super) fn seen<'a>(middle: &'a Option<Middle>, trial: &'a State) -> &'a State {
    middle.as_ref().map_or(trial, |of| &of.state)
}
