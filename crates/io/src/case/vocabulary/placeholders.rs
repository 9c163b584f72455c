//! What stands in a rule for names that other rooms describe.

/// Stands for the names of all contact laws in a rule.
pub(super) const LAWS: &str = "<laws>";

/// Stands for the names of all shapes in a rule.
pub(super) const SHAPES: &str = "<shapes>";

/// Stands for the names of all loads in a rule.
pub(super) const LOADS: &str = "<loads>";
