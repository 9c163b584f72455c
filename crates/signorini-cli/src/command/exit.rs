//! Exit codes that no finding decides.

/// The exit code for a command line that is not understood.
pub const WRONG_COMMAND: u8 = 2;
