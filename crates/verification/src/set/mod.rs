//! The problems, by topic.

mod beams;
mod friction;
mod hertz;
mod joints;
mod paper;
mod patch;
mod punches;
mod solids;
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
            &punches::PROBLEMS,
            &walls::PROBLEMS,
            &friction::PROBLEMS,
            &joints::PROBLEMS,
            &solids::PROBLEMS,
            &beams::PROBLEMS,
            &paper::PROBLEMS,
        ]
        .concat()
    });
    &ALL
}
