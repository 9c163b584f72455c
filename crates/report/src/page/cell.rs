//! Numbers in tables: short for readers, exact for machines.

use crate::text::short;
use maud::{Markup, html};

/// The exact decimal of a number, as in `summary.json`; `null` where it is not finite.
pub fn exact(value: f64) -> String {
    serde_json::to_string(&value).unwrap_or_default()
}

/// A cell with a number. `key` is its path in `summary.json`, a JSON pointer without its first slash, as in
/// `contacts/foot/force/0`, or `history.csv:ROW:COLUMN`.
pub fn number(value: f64, key: &str) -> Markup {
    html! { td.number data-key=(key) data-value=(exact(value)) { (short(value, 5)) } }
}

/// A cell with a whole number.
pub fn count(value: u64, key: &str) -> Markup {
    html! { td.number data-key=(key) data-value=(value) { (value) } }
}

/// A cell with a number that no file of the run holds.
pub fn derived(value: f64) -> Markup {
    html! { td.number data-value=(exact(value)) { (short(value, 5)) } }
}

/// A link that shows a node in the view.
pub fn node(label: i64) -> Markup {
    html! { a.node href="#view" data-node=(label) title="show this node in the view" { (label) } }
}
