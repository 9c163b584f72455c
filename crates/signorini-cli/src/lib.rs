//! The command `signorini` as a library, for programs that carry it: the binary of this crate, and the Python package.

mod command;

pub use command::{LargePages, main};
