//! What a server works on, and with.

use crate::limits::Limits;
use std::ffi::OsString;
use std::path::PathBuf;

/// What a server works on, and with.
#[derive(Clone, Debug)]
pub struct Options {
    /// The folder: nothing outside of it is read or written.
    pub root: PathBuf,
    /// The command signorini: the file to run, and the arguments that come before all others.
    pub command: Vec<OsString>,
    /// How much a client may ask for.
    pub limits: Limits,
}
