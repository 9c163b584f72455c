//! What a run says of fluids that have come through a contact.

use crate::setup::Model;
use crate::text::short;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::system::Frame;
use std::collections::BTreeMap;

/// The first leak of each contact: when, at what pressure, and the node.
#[derive(Debug, Default)]
pub(super) struct Leaks(BTreeMap<String, (f64, f64, u32)>);

impl Leaks {
    /// Looks at an accepted state.
    pub fn look(&mut self, frame: &Frame) {
        for contact in &frame.contacts {
            let fluid = contact.fluid.as_ref();
            let leak = fluid.and_then(|of| Some((frame.time, of.pressure, of.leak?)));
            if let Some(leak) = leak {
                self.0.entry(contact.name.clone()).or_insert(leak);
            }
        }
    }

    /// A warning for each contact that leaks.
    pub fn warnings(&self, model: &Model) -> Diagnostics {
        let mut found = Diagnostics::new();
        for (name, (time, pressure, node)) in &self.0 {
            let label = model.mesh.node_labels.get(*node as usize);
            let text = format!(
                "contact \"{name}\" leaks: its fluid has reached the rim at node {} at time {}, with a pressure of {}",
                label.copied().unwrap_or_default(),
                short(*time),
                short(*pressure)
            );
            found.push(
                Diagnostic::warning(&codes::LEAKS, text)
                    .note("what is beyond the rim is not part of the model")
                    .help("silence with  allow = [\"S0436\"]  where it is meant to leak"),
            );
        }
        found
    }
}
