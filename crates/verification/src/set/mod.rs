//! The problems, by topic.

mod bodies;
mod contact;
mod hertz;
mod paper;
mod patch;
mod walls;

use crate::problem::Problem;
use std::sync::LazyLock;

/// All problems, in the order of tables.
#[must_use]
pub fn problems() -> &'static [Problem] {
    static ALL: LazyLock<Vec<Problem>> = LazyLock::new(|| {
        [
            patch::PROBLEMS.as_slice(),
            &hertz::PROBLEMS,
            &walls::PROBLEMS,
            &bodies::PROBLEMS,
            &contact::PROBLEMS,
            &paper::PROBLEMS,
        ]
        .concat()
    });
    &ALL
}
