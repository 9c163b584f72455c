//! The command `signorini` as a library, for programs that carry it: the binary of this crate, and the Python package.

mod command;

// as the binary has it, for the tests of what it notes
#[cfg(test)]
#[global_allocator]
static MEMORY: LargePages = LargePages;

pub use command::{LargePages, main};
