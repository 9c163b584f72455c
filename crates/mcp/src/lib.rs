//! A server of the Model Context Protocol: agents check cases, run them and read their results.
//!
//! ```text
//!  client ──stdin──▶ wire ──▶ rmcp ──▶ Server ──▶ a tool ──▶ Root     files in the folder
//!         ◀─stdout───────────  │                        └──▶ Program  signorini … --json, a child confined to the folder
//!                              └── progress, cancellation
//! ```
//!
//! The server solves nothing itself: it runs the command, so that no fault of a case ends it. What a client may do is
//! limited by a folder ([`Options::root`]) and by sizes, counts and times ([`Limits`]).
//!
//! One more tool: a method in a file of `tools/`, with a description and a struct for its parameters, and a row of the table in
//! `docs/mcp.md`, which a test compares with the list that clients get.
//!
//! Limits: hard links are files of the folder. Clients that speak over HTTP are not served.
//!
//! Source: the Model Context Protocol, <https://modelcontextprotocol.io/specification>.
#![forbid(unsafe_code)]

mod account;
mod error;
mod limits;
mod options;
mod program;
mod reply;
mod root;
mod server;
mod table;
mod tools;
mod wire;

pub use error::ServeError;
pub use limits::Limits;
pub use options::Options;
pub use server::Server;

use rmcp::ServiceExt;
use tokio::io::{AsyncRead, AsyncWrite};

/// Serves a client on standard input and output until it leaves. Blocks; nothing else may read or write these streams.
///
/// # Errors
/// A folder that cannot be used; a client that starts no session.
pub fn serve(options: Options) -> Result<(), ServeError> {
    let server = Server::new(options)?;
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(ServeError::Runtime)?;
    let served = runtime.block_on(async {
        let session = serve_over(server.clone(), tokio::io::stdin(), tokio::io::stdout());
        tokio::select! {
            served = session => served,
            () = terminated() => {
                server.leave();
                server.finish().await;
                Ok(())
            }
        }
    });
    // a read of standard input that still waits must not keep the process
    runtime.shutdown_background();
    served
}

/// Serves a client on any pair of streams until it leaves; then asks runs that are going on to stop, and waits for them a while.
///
/// # Errors
/// A client that starts no session. A client that leaves before is none.
pub async fn serve_over(
    server: Server,
    from: impl AsyncRead + Send + Unpin + 'static,
    to: impl AsyncWrite + Send + Unpin + 'static,
) -> Result<(), ServeError> {
    use rmcp::service::ServerInitializeError as Failed;
    let (near, far) = tokio::io::duplex(64 << 10);
    let most = server.limits().request;
    let left = server.clone();
    let relay = tokio::spawn(async move {
        wire::relay(from, near, most).await;
        // at once: clients give a server a few seconds to end before they kill it
        left.leave();
    });
    let running = server.clone().serve((far, to)).await;
    let served = match running {
        Ok(running) => {
            // how it ended is no matter: the client is gone
            let _ = running.waiting().await;
            Ok(())
        }
        Err(Failed::ConnectionClosed(_)) => Ok(()),
        Err(error) => Err(ServeError::Session(Box::new(error))),
    };
    relay.abort();
    server.leave();
    server.finish().await;
    served
}

/// Resolves when the process is asked to end.
#[cfg(unix)]
async fn terminated() {
    use tokio::signal::unix::{SignalKind, signal};
    match signal(SignalKind::terminate()) {
        Ok(mut asked) => {
            asked.recv().await;
        }
        // then the signal ends the process as it always does
        Err(_) => std::future::pending().await,
    }
}

#[cfg(not(unix))]
async fn terminated() {
    std::future::pending().await
}
