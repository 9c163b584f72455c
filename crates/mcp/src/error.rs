//! Why a server does not start, or ends.

use std::path::PathBuf;

/// Why a server does not start, or ends.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServeError {
    /// The folder cannot be used.
    #[error("the folder {} cannot be used: {source}", path.display())]
    Root {
        /// The folder.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The system has no threads or timers for the server.
    #[error("the server cannot start: {0}")]
    Runtime(std::io::Error),
    /// The client and the server do not understand each other.
    #[error("the client did not start a session: {0}")]
    Session(Box<rmcp::service::ServerInitializeError>),
}
