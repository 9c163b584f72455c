//! Why cells cannot be removed or added.

use thiserror::Error;

/// Why cells cannot be removed or added.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ActivityError {
    /// A cell that is in no body.
    #[error("step \"{step}\" removes or adds element {element}, which belongs to no body")]
    Outside {
        /// Name of the step.
        step: String,
        /// The element, as numbered in the input.
        element: u64,
    },
    /// A cell of a rigid body.
    #[error(
        "step \"{step}\" removes or adds element {element} of the rigid body \"{body}\", which has no stress"
    )]
    Rigid {
        /// Name of the step.
        step: String,
        /// The element, as numbered in the input.
        element: u64,
        /// Name of the body.
        body: String,
    },
    /// A cell that takes part already, or has been removed already.
    #[error("step \"{step}\" {adds} element {element}, which is {active} already")]
    Already {
        /// Name of the step.
        step: String,
        /// The element, as numbered in the input.
        element: u64,
        /// `adds` or `removes`.
        adds: &'static str,
        /// `active` or `inactive`.
        active: &'static str,
    },
    /// A cell that one step both removes and adds, or names twice.
    #[error("step \"{step}\" removes or adds element {element} twice")]
    Twice {
        /// Name of the step.
        step: String,
        /// The element, as numbered in the input.
        element: u64,
    },
    /// No deformable cell is left.
    #[error("in step \"{step}\" no element is active: there is nothing to solve for")]
    NothingLeft {
        /// Name of the step.
        step: String,
    },
    /// A load on several faces, some of which are removed, that is spread over all of them.
    #[error(
        "load \"{load}\" is one total over its faces, of which some belong to elements that steps remove or add"
    )]
    TotalOverParts {
        /// Name of the load.
        load: String,
    },
}
