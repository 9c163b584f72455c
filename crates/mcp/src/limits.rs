//! Limits: how much a client may ask for, and how much it gets back.

use std::time::Duration;

/// Sizes in bytes, counts and times that the server keeps to, whatever a client asks for.
///
/// A client that sends more is refused with the limit in the message; an answer that would be larger is cut, and says so.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// Bytes of one message of the client. What comes after them is skipped, not kept.
    pub request: usize,
    /// Bytes of a text that is written.
    pub text: usize,
    /// Bytes of a text that is returned: a file, or a part of the schema.
    pub reply: usize,
    /// Bytes that a command other than a run may print, and that a file to read may have.
    pub printed: usize,
    /// Bytes of one event of a run.
    pub event: usize,
    /// Runs at once. A further one is refused.
    pub runs: usize,
    /// Other commands at once. Further ones wait.
    pub commands: usize,
    /// Time that a run has where the client names none.
    pub default_wall: Duration,
    /// The longest time that a client can give a run.
    pub wall: Duration,
    /// Time that any other command has.
    pub command: Duration,
    /// Time that a command has to end after it was asked to, before it is killed.
    pub grace: Duration,
    /// Rows of a table.
    pub rows: usize,
    /// Numbers of a table: its rows times its columns.
    pub cells: usize,
    /// Files of a list.
    pub files: usize,
    /// Messages of a case or a run.
    pub diagnostics: usize,
    /// Changes of a case by `set`.
    pub changes: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            request: 4 << 20,
            text: 1 << 20,
            reply: 256 << 10,
            printed: 8 << 20,
            event: 1 << 20,
            runs: 2,
            commands: 4,
            default_wall: Duration::from_secs(600),
            wall: Duration::from_secs(24 * 3600),
            command: Duration::from_secs(300),
            grace: Duration::from_secs(20),
            rows: 1000,
            cells: 20_000,
            files: 500,
            diagnostics: 50,
            changes: 64,
        }
    }
}
