//! Sessions: what is no message, what is too long, what is cancelled, what comes at once, and what comes last.

use crate::support::{Session, Yard, call, until};
use rmcp::model::{ClientRequest, Request};
use rmcp::service::PeerRequestOptions;
use serde_json::{Value, json};
use signorini_mcp::{Limits, serve_over};
use std::time::Duration;
use tokio::io::{
    AsyncBufReadExt, AsyncWriteExt, BufReader, DuplexStream, ReadHalf, WriteHalf, split,
};

/// A client that writes what it likes.
struct Raw {
    from: BufReader<ReadHalf<DuplexStream>>,
    to: WriteHalf<DuplexStream>,
    server: tokio::task::JoinHandle<()>,
}

impl Raw {
    fn new(yard: &Yard, limits: Limits) -> Self {
        let server = yard.server(limits);
        let (near, far) = tokio::io::duplex(1 << 16);
        let (from, to) = split(far);
        let server = tokio::spawn(async move { serve_over(server, from, to).await.unwrap() });
        let (from, to) = split(near);
        Self {
            from: BufReader::new(from),
            to,
            server,
        }
    }

    async fn send(&mut self, text: &str) {
        self.to.write_all(text.as_bytes()).await.unwrap();
    }

    /// The next answer with an id.
    async fn answer(&mut self) -> Value {
        loop {
            let mut line = String::new();
            let read =
                tokio::time::timeout(Duration::from_secs(60), self.from.read_line(&mut line));
            assert_ne!(
                read.await.expect("an answer").unwrap(),
                0,
                "the server is gone"
            );
            let value: Value = serde_json::from_str(&line).unwrap();
            if value.get("id").is_some_and(|id| !id.is_null()) {
                return value;
            }
        }
    }

    async fn greet(&mut self) {
        let params = json!({ "protocolVersion": "2025-06-18", "capabilities": {},
            "clientInfo": { "name": "raw", "version": "1" } });
        let hello = json!({ "jsonrpc": "2.0", "id": 0, "method": "initialize", "params": params });
        self.send(&format!("{hello}\n")).await;
        let answer = self.answer().await;
        assert_eq!(answer["result"]["serverInfo"]["name"], "signorini");
        assert!(
            answer["result"]["instructions"]
                .as_str()
                .unwrap()
                .contains("`check`")
        );
        self.send("{\"jsonrpc\":\"2.0\",\"method\":\"notifications/initialized\"}\n")
            .await;
    }

    /// Asserts that the server still answers.
    async fn is_alive(&mut self, id: u64) {
        self.send(&format!(
            "{{\"jsonrpc\":\"2.0\",\"id\":{id},\"method\":\"tools/list\"}}\n"
        ))
        .await;
        let answer = self.answer().await;
        assert_eq!(answer["id"], id, "{answer}");
        assert!(answer["result"]["tools"].as_array().unwrap().len() > 8);
    }
}

#[tokio::test]
async fn what_is_no_message_ends_nothing() {
    let yard = Yard::new("");
    let mut raw = Raw::new(&yard, Limits::default());
    raw.send("hello\n{\"jsonrpc\":\"2.0\",\"method\":\"notifications/x\"}\n\n[]\n")
        .await;
    raw.greet().await;
    let deep = "[".repeat(100_000);
    for (id, bad) in [
        "not json",
        "{",
        "{\"jsonrpc\":\"2.0\"",
        "[]",
        "[1,2,3]",
        "null",
        "{}",
        "{\"jsonrpc\":\"1.0\",\"id\":77,\"method\":7}",
        "{\"jsonrpc\":\"2.0\",\"id\":{},\"method\":\"tools/list\"}",
        "{\"jsonrpc\":\"2.0\",\"method\":\"notifications/nonsense\",\"params\":{\"a\":[]}}",
        "{\"jsonrpc\":\"2.0\",\"id\":99,\"result\":{}}",
        &deep,
        &format!("{{\"jsonrpc\":\"2.0\",\"id\":\"d\",\"method\":\"ping\",\"params\":{deep}}}"),
        "\u{0}\u{1}",
    ]
    .into_iter()
    .enumerate()
    {
        raw.send(&format!("{bad}\n")).await;
        raw.is_alive(1000 + id as u64).await;
    }
    raw.to.write_all(b"\xff\xfe\x00\n").await.unwrap();
    raw.is_alive(2000).await;
    for (id, method) in [(3000, "no/such/method"), (3001, "signorini/too_long")] {
        raw.send(&format!(
            "{{\"jsonrpc\":\"2.0\",\"id\":{id},\"method\":\"{method}\"}}\n"
        ))
        .await;
        let answer = raw.answer().await;
        assert_eq!(answer["id"], id);
        assert!(answer["error"]["message"].is_string(), "{answer}");
    }
}

#[tokio::test]
async fn a_request_that_is_too_long_is_answered_with_an_error_of_its_id() {
    let yard = Yard::new("");
    let mut limits = Limits::default();
    limits.request = 10_000;
    let mut raw = Raw::new(&yard, limits);
    raw.greet().await;
    let text = "x".repeat(20_000);
    let params = json!({ "name": "write_case", "arguments": { "path": "a.toml", "text": text } });
    for id in [json!(5), json!("five")] {
        let request =
            json!({ "jsonrpc": "2.0", "id": id, "method": "tools/call", "params": params });
        raw.send(&format!("{request}\n")).await;
        let answer = raw.answer().await;
        assert_eq!(answer["id"], id);
        let message = answer["error"]["message"].as_str().unwrap();
        assert!(message.contains("longer than 10000 bytes"), "{message}");
        raw.is_alive(6).await;
    }
    assert!(!yard.root().join("a.toml").exists());
}

#[cfg(target_os = "linux")]
#[tokio::test]
async fn an_endless_request_is_not_kept_in_memory() {
    let peak = || -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        let line = status
            .lines()
            .find(|line| line.starts_with("VmHWM"))
            .unwrap();
        line.split_whitespace().nth(1).unwrap().parse().unwrap()
    };
    let yard = Yard::new("");
    let mut raw = Raw::new(&yard, Limits::default());
    raw.greet().await;
    let before = peak();
    raw.send("{\"jsonrpc\":\"2.0\",\"id\":5,\"method\":\"tools/call\",\"params\":\"")
        .await;
    let part = "x".repeat(1 << 20);
    for _ in 0..80 {
        raw.send(&part).await;
    }
    raw.send("\"}\n").await;
    assert_eq!(raw.answer().await["id"], 5);
    let grown = peak() - before;
    // other tests of this process share the figure, with texts of a megabyte
    assert!(grown < 50_000, "{grown} kB for 80 MB");
}

/// A run that goes on until it is interrupted, and then says so.
const ENDLESS: &str = r#"
echo '{"v":1,"ev":"start","case":"a.toml"}'
trap 'echo "{\"v\":1,\"ev\":\"end\",\"status\":\"interrupted\",\"exit_code\":130}"; echo yes >> "$here/interrupted"; exit 130' INT
echo started >> "$here/started"
while true; do sleep 0.05; done
"#;

/// A folder with a case whose run is endless.
fn endless() -> Yard {
    let yard = Yard::new(ENDLESS);
    yard.write("a.toml", "");
    yard
}

/// How many lines a file has.
fn lines(path: std::path::PathBuf) -> usize {
    std::fs::read_to_string(path).map_or(0, |text| text.lines().count())
}

/// Starts a run and returns its request.
async fn start(session: &Session, path: &str) -> rmcp::service::RequestHandle<rmcp::RoleClient> {
    let request =
        ClientRequest::CallToolRequest(Request::new(call("run", json!({ "path": path }))));
    session
        .client
        .send_cancellable_request(request, PeerRequestOptions::no_options())
        .await
        .unwrap()
}

#[tokio::test]
async fn a_cancelled_run_is_interrupted_and_makes_room() {
    let yard = endless();
    let mut limits = Limits::default();
    limits.runs = 1;
    let session = yard.session_with(limits).await;
    let handle = start(&session, "a.toml").await;
    until("the run", || lines(yard.outside("started")) == 1).await;
    let said = session.refused("run", json!({ "path": "a.toml" })).await;
    assert!(said.contains("1 runs are going on"), "{said}");
    handle.cancel(Some("enough".into())).await.unwrap();
    until("the signal", || lines(yard.outside("interrupted")) == 1).await;
    yard.act("echo '{\"v\":1,\"ev\":\"end\",\"status\":\"solved\",\"exit_code\":0}'");
    // its permit comes back with its end
    for _ in 0..500 {
        let result = session.call("run", json!({ "path": "a.toml" })).await;
        if result.is_error != Some(true) {
            return session.close().await;
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    panic!("no room was made");
}

#[tokio::test]
async fn a_run_that_takes_too_long_is_interrupted_and_said_to_be_resumable() {
    let yard = endless();
    let mut limits = Limits::default();
    limits.default_wall = Duration::from_millis(200);
    limits.grace = Duration::from_secs(1);
    let session = yard.session_with(limits).await;
    let value = session.done("run", json!({ "path": "a.toml" })).await;
    assert_eq!(
        (&value["exit_code"], &value["resumable"]),
        (&json!(130), &json!(true))
    );
    assert_eq!(value["stopped"], "the time was over");
    session.close().await;
}

#[tokio::test]
async fn a_run_that_heeds_no_signal_is_killed() {
    let yard = Yard::new(
        "trap '' INT; echo '{\"v\":1,\"ev\":\"start\"}'; while true; do sleep 0.05; done",
    );
    yard.write("a.toml", "");
    let mut limits = Limits::default();
    limits.default_wall = Duration::from_millis(100);
    limits.grace = Duration::from_millis(200);
    let session = yard.session_with(limits).await;
    let value = session.done("run", json!({ "path": "a.toml" })).await;
    assert_eq!(
        (&value["status"], &value["resumable"]),
        (&json!("interrupted"), &json!(true))
    );
    session.close().await;
}

#[tokio::test]
async fn calls_at_once_do_not_wait_for_a_run() {
    let yard = endless();
    let session = yard.session().await;
    let first = start(&session, "a.toml").await;
    let second = start(&session, "a.toml").await;
    until("both runs", || lines(yard.outside("started")) == 2).await;
    session.refused("run", json!({ "path": "a.toml" })).await;
    yard.act("echo '{\"ok\":true,\"diagnostics\":[]}'");
    let checks = (0..20).map(|_| call("check", json!({ "path": "a.toml" })));
    let checks: Vec<_> = checks
        .map(|check| {
            let peer = session.client.peer().clone();
            tokio::spawn(async move { peer.call_tool(check).await })
        })
        .collect();
    for check in checks {
        let result = check.await.unwrap().unwrap();
        assert_ne!(result.is_error, Some(true), "{result:#?}");
    }
    for handle in [first, second] {
        handle.cancel(None).await.unwrap();
    }
    until("both signals", || lines(yard.outside("interrupted")) == 2).await;
    session.close().await;
}

#[tokio::test]
async fn a_client_that_leaves_interrupts_its_runs() {
    let yard = endless();
    let session = yard.session().await;
    let _handle = start(&session, "a.toml").await;
    until("the run", || lines(yard.outside("started")) == 1).await;
    session.close().await;
    assert_eq!(
        lines(yard.outside("interrupted")),
        1,
        "asked before the server ended"
    );
}

#[tokio::test]
async fn a_client_that_leaves_before_it_greets_is_no_error() {
    let yard = Yard::new("");
    let Raw { from, to, server } = Raw::new(&yard, Limits::default());
    drop((from, to));
    tokio::time::timeout(Duration::from_secs(30), server)
        .await
        .unwrap()
        .unwrap();
}
