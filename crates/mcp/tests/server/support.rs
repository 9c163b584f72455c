//! A folder, a stand-in for the command, and a client.

use rmcp::model::{CallToolRequestParams, CallToolResult, ProgressNotificationParam};
use rmcp::service::{NotificationContext, RunningService};
use rmcp::{ClientHandler, RoleClient, ServiceExt};
use serde_json::{Value, json};
use signorini_mcp::{Limits, Options, Server, serve_over};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tempfile::TempDir;
use tokio::task::JoinHandle;

/// The stand-in. It notes its arguments in `calls`, a line each time; then it does what the file `act` next to it says.
const SCRIPT: &str = r#"#!/bin/sh
here=$(dirname "$0")
echo "$SIGNORINI_WITHIN|$PWD|$*" >> "$here/calls"
. "$here/act"
"#;

/// A folder to work in, with the stand-in outside of it.
pub struct Yard {
    top: TempDir,
}

/// What a client hears.
#[derive(Clone, Default)]
pub struct Ear {
    pub progress: Arc<Mutex<Vec<ProgressNotificationParam>>>,
}

impl ClientHandler for Ear {
    async fn on_progress(
        &self,
        report: ProgressNotificationParam,
        _: NotificationContext<RoleClient>,
    ) {
        self.progress.lock().unwrap().push(report);
    }
}

/// A client with its server.
pub struct Session {
    pub client: RunningService<RoleClient, Ear>,
    pub ear: Ear,
    pub server: JoinHandle<()>,
}

impl Yard {
    /// With a stand-in that does this.
    pub fn new(act: &str) -> Self {
        let yard = Self {
            top: tempfile::tempdir().unwrap(),
        };
        fs::create_dir(yard.root()).unwrap();
        let script = yard.outside("fake");
        fs::write(&script, SCRIPT).unwrap();
        fs::set_permissions(&script, fs::Permissions::from_mode(0o755)).unwrap();
        yard.act(act);
        yard
    }

    /// From now on the stand-in does this.
    pub fn act(&self, act: &str) {
        fs::write(self.outside("act"), act).unwrap();
    }

    pub fn top(&self) -> &Path {
        self.top.path()
    }

    pub fn root(&self) -> PathBuf {
        self.top.path().join("root")
    }

    pub fn outside(&self, name: &str) -> PathBuf {
        self.top.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        let path = self.root().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// The arguments of every call of the command so far.
    pub fn calls(&self) -> Vec<String> {
        let calls = fs::read_to_string(self.outside("calls")).unwrap_or_default();
        calls
            .lines()
            .map(|line| line.rsplit('|').next().unwrap().to_owned())
            .collect()
    }

    pub fn server(&self, limits: Limits) -> Server {
        Server::new(Options {
            root: self.root(),
            command: vec![self.outside("fake").into()],
            limits,
        })
        .unwrap()
    }

    pub async fn session(&self) -> Session {
        self.session_with(Limits::default()).await
    }

    pub async fn session_with(&self, limits: Limits) -> Session {
        let server = self.server(limits);
        let (near, far) = tokio::io::duplex(1 << 16);
        let (from, to) = tokio::io::split(far);
        let server = tokio::spawn(async move { serve_over(server, from, to).await.unwrap() });
        let ear = Ear::default();
        let client = ear.clone().serve(near).await.unwrap();
        Session {
            client,
            ear,
            server,
        }
    }
}

/// The parameters of a call.
pub fn call(tool: &str, arguments: Value) -> CallToolRequestParams {
    let arguments = arguments.as_object().unwrap().clone();
    CallToolRequestParams::new(tool.to_owned()).with_arguments(arguments)
}

impl Session {
    /// Calls a tool.
    pub async fn call(&self, tool: &str, arguments: Value) -> CallToolResult {
        self.client.call_tool(call(tool, arguments)).await.unwrap()
    }

    /// Calls a tool that must do its work; its structured content.
    pub async fn done(&self, tool: &str, arguments: Value) -> Value {
        let result = self.call(tool, arguments).await;
        assert_ne!(result.is_error, Some(true), "{result:#?}");
        result.structured_content.unwrap()
    }

    /// Calls a tool that must be refused; what it says.
    pub async fn refused(&self, tool: &str, arguments: Value) -> String {
        let result = self.call(tool, arguments.clone()).await;
        assert_eq!(
            result.is_error,
            Some(true),
            "{tool} {arguments} {result:#?}"
        );
        let value = result.structured_content.clone().unwrap();
        assert_eq!(value["ok"], json!(false));
        text(&result)
    }

    /// Ends the session and waits for the server.
    pub async fn close(self) {
        self.client.cancel().await.unwrap();
        tokio::time::timeout(Duration::from_secs(60), self.server)
            .await
            .expect("the server ends with its client")
            .unwrap();
    }
}

/// The text of a result.
pub fn text(result: &CallToolResult) -> String {
    let text = result.content.first().and_then(|one| one.as_text());
    text.unwrap().text.clone()
}

/// Waits until something holds.
pub async fn until(what: &str, holds: impl Fn() -> bool) {
    for _ in 0..3000 {
        if holds() {
            return;
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    panic!("{what} never came");
}
