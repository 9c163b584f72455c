//! The server: what its tools share, and what clients read about it.

use crate::error::ServeError;
use crate::limits::Limits;
use crate::options::Options;
use crate::program::{Ended, Program, Watch, object};
use crate::reply::Refusal;
use crate::root::Root;
use crate::wire::TOO_LONG;
use rmcp::handler::server::router::tool::ToolRouter;
use rmcp::model::{CustomRequest, CustomResult, Implementation, ServerCapabilities, ServerConfig};
use rmcp::service::RequestContext;
use rmcp::{ErrorData, RoleServer, ServerHandler, tool_handler};
use serde_json::Value;
use std::sync::Arc;
use tokio::sync::{OnceCell, Semaphore, SemaphorePermit, watch};

/// What clients read first.
const INSTRUCTIONS: &str = "\
Signorini solves contact problems by finite elements: deformable bodies and rigid tools that are pressed together, slide and \
separate. A case is a text file in TOML with a mesh, materials, bodies, contacts and steps.\n\
Work in this order: `init` writes a case to start from, `schema` describes the keys of a part of a case, `check` finds what is \
wrong without solving (write the text of a case with it), `run` solves, `results` gives numbers, `report` writes a page with \
pictures. Mend a case by its messages: each has a code, file, line, column, and `help` with what to do; `explain` says more about a \
code or a key. All paths are relative to the folder of this server; nothing outside of it can be used.";

/// A server of the Model Context Protocol for one folder.
#[derive(Clone)]
pub struct Server {
    shared: Arc<Shared>,
    router: ToolRouter<Self>,
}

/// What the tools share.
struct Shared {
    root: Root,
    program: Program,
    limits: Limits,
    runs: Semaphore,
    commands: Semaphore,
    schema: OnceCell<Value>,
    /// Whether the client has left.
    left: watch::Sender<bool>,
}

impl Server {
    /// A server for a folder.
    ///
    /// # Errors
    /// A folder that cannot be used.
    pub fn new(options: Options) -> Result<Self, ServeError> {
        let root = Root::open(&options.root).map_err(|source| ServeError::Root {
            path: options.root,
            source,
        })?;
        let program = Program {
            words: options.command,
            folder: root.path().to_path_buf(),
        };
        let limits = options.limits;
        Ok(Self {
            router: Self::case_tools()
                + Self::run_tools()
                + Self::result_tools()
                + Self::file_tools(),
            shared: Arc::new(Shared {
                root,
                program,
                runs: Semaphore::new(limits.runs),
                commands: Semaphore::new(limits.commands),
                limits,
                schema: OnceCell::new(),
                left: watch::Sender::new(false),
            }),
        })
    }

    /// How much a client may ask for.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.shared.limits
    }

    pub(crate) fn root(&self) -> &Root {
        &self.shared.root
    }

    pub(crate) fn program(&self) -> &Program {
        &self.shared.program
    }

    /// The JSON schema of cases, once it is known.
    pub(crate) fn known_schema(&self) -> &OnceCell<Value> {
        &self.shared.schema
    }

    /// A permit for a run.
    ///
    /// # Errors
    /// As many runs as there may be.
    pub(crate) fn run_permit(&self) -> Result<SemaphorePermit<'_>, Refusal> {
        self.shared.runs.try_acquire().map_err(|_| Refusal::Busy {
            running: self.limits().runs,
        })
    }

    /// Runs a command that is no run to its end.
    ///
    /// # Errors
    /// A command that cannot be started.
    async fn output(
        &self,
        arguments: &[String],
        context: &RequestContext<RoleServer>,
    ) -> Result<(Ended, Vec<u8>), Refusal> {
        // never closed
        let _permit = self.shared.commands.acquire().await;
        let watch = Watch {
            limits: self.limits(),
            time: self.limits().command,
            cancelled: self.cancelled(context),
        };
        self.program().output(arguments, watch).await
    }

    /// Runs a command that must end with exit code 0, and returns what it prints.
    ///
    /// # Errors
    /// A command that cannot be started, is stopped, or ends otherwise.
    pub(crate) async fn succeed(
        &self,
        arguments: &[String],
        context: &RequestContext<RoleServer>,
    ) -> Result<Vec<u8>, Refusal> {
        let (ended, printed) = self.output(arguments, context).await?;
        if ended.code == Some(0) {
            Ok(printed)
        } else {
            Err(ended.fault(name(arguments)))
        }
    }

    /// Runs a command with `--json`, and returns the object that it prints.
    ///
    /// # Errors
    /// A command that cannot be started, is stopped, breaks down, or prints no object.
    pub(crate) async fn ask(
        &self,
        arguments: &[String],
        context: &RequestContext<RoleServer>,
    ) -> Result<Value, Refusal> {
        let (ended, printed) = self.output(arguments, context).await?;
        match object(&printed) {
            Some(value) if ended.stopped.is_none() => Ok(value),
            _ => Err(ended.fault(name(arguments))),
        }
    }

    /// The client is gone: everything that goes on is asked to stop.
    pub(crate) fn leave(&self) {
        self.shared.left.send_replace(true);
    }

    /// Resolves when a request is cancelled, or its client has left.
    pub(crate) async fn cancelled(&self, context: &RequestContext<RoleServer>) {
        let mut left = self.shared.left.subscribe();
        tokio::select! {
            () = context.ct.cancelled() => {}
            // an error: there is nobody left to say so, which is the same
            _ = left.wait_for(|left| *left) => {}
        }
    }

    /// Waits for runs that were asked to stop, a little longer than they have for it.
    pub(crate) async fn finish(&self) {
        let all = u32::try_from(self.limits().runs).unwrap_or(u32::MAX);
        let time = self.limits().grace.saturating_mul(2);
        let _ = tokio::time::timeout(time, self.shared.runs.acquire_many(all)).await;
    }
}

/// The subcommand.
fn name(arguments: &[String]) -> &str {
    arguments.first().map_or("", String::as_str)
}

#[tool_handler(router = self.router)]
impl ServerHandler for Server {
    fn get_info(&self) -> ServerConfig {
        ServerConfig::new(ServerCapabilities::builder().enable_tools().build())
            .with_server_info(
                Implementation::new("signorini", env!("CARGO_PKG_VERSION"))
                    .with_title("Signorini: contact mechanics by finite elements"),
            )
            .with_instructions(INSTRUCTIONS)
    }

    async fn on_custom_request(
        &self,
        request: CustomRequest,
        _: RequestContext<RoleServer>,
    ) -> Result<CustomResult, ErrorData> {
        if request.method == TOO_LONG {
            let most = self.limits().request;
            let message =
                format!("the request is longer than {most} bytes, the most that this server reads");
            return Err(ErrorData::invalid_request(message, None));
        }
        let message = format!("there is no method {}", request.method);
        Err(ErrorData::new(
            rmcp::model::ErrorCode::METHOD_NOT_FOUND,
            message,
            None,
        ))
    }
}
