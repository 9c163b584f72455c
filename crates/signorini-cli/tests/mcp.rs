//! `signorini mcp` with a client of the protocol's library: a broken case is mended by its messages, run and read.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use rmcp::ServiceExt;
use rmcp::model::{CallToolRequestParams, CallToolResult, ClientRequest, Request};
use rmcp::service::{PeerRequestOptions, RunningService};
use rmcp::transport::TokioChildProcess;
use serde_json::{Value, json};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// A block that is pressed; the count of increments is put in.
const CASE: &str = r#"
title = "a brick"
units = "m-MN-MPa"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
  [11, 0.3, 0.2, 1], [12, 0, 0, 1.8], [13, 0.6, 0, 1.8], [14, 0.3, 0.6, 1.8],
]
elements = [
  { id = 1, type = "hex8", group = "brick", nodes = [1, 2, 3, 4, 5, 6, 7, 8] },
  { id = 2, type = "tet4", group = "tool", nodes = [11, 12, 13, 14] },
]
[sets]
base = { nodes = [1, 2, 3, 4] }
tip_node = { nodes = [11] }
top = { faces = [[1, "+z"]] }
[material.soft]
model = "saint-venant-kirchhoff"
E = 500.0
nu = 0.0
[[body]]
group = "brick"
material = "soft"
[[body]]
group = "tool"
rigid = true
[[contact]]
name = "tip"
secondary = "tip_node"
primary = "top"
enforcement = { penalty = 1e5, per = "node" }
[[step]]
name = "press"
increments = { fixed = 4 }
[[step.fix]]
on = "base"
u = "all"
[[step.move]]
on = "tool"
uz = -0.02
[checkpoint]
every = { increments = 1 }
"#;

type Client = RunningService<rmcp::RoleClient, ()>;

/// A client with a server of its own for a folder.
async fn client(root: &Path) -> Client {
    client_and_process(root).await.0
}

/// The same, and the number of the server's process.
async fn client_and_process(root: &Path) -> (Client, u32) {
    let mut command = tokio::process::Command::new(env!("CARGO_BIN_EXE_signorini"));
    command.arg("mcp").arg("--root").arg(root);
    let transport = TokioChildProcess::new(command).unwrap();
    let process = transport.id().unwrap();
    (().serve(transport).await.unwrap(), process)
}

fn params(tool: &str, arguments: Value) -> CallToolRequestParams {
    let arguments = arguments.as_object().unwrap().clone();
    CallToolRequestParams::new(tool.to_owned()).with_arguments(arguments)
}

async fn call(client: &Client, tool: &str, arguments: Value) -> CallToolResult {
    client.call_tool(params(tool, arguments)).await.unwrap()
}

async fn done(client: &Client, tool: &str, arguments: Value) -> Value {
    let result = call(client, tool, arguments).await;
    assert_ne!(result.is_error, Some(true), "{tool}: {result:#?}");
    result.structured_content.unwrap()
}

/// What a message proposes in place of what stands at its place: the first name in quotes after "did you mean".
fn proposed(finding: &Value) -> Option<String> {
    let remarks = [&finding["label"], &finding["help"], &finding["notes"]];
    let all: String = remarks.iter().map(|value| value.to_string()).collect();
    let (_, rest) = all
        .replace("\\\"", "`")
        .split_once("did you mean ")
        .map(|(a, b)| (a.to_owned(), b.to_owned()))?;
    let name = rest.trim_start_matches('`');
    let end = name.find(|c: char| !(c.is_alphanumeric() || "_-.".contains(c)))?;
    Some(name[..end].to_owned())
}

/// The text with the word at the place of a message replaced.
fn mended(text: &str, finding: &Value) -> Option<String> {
    let word = proposed(finding)?;
    let line = finding["line"].as_u64()? as usize - 1;
    let column = finding["column"].as_u64()? as usize - 1;
    let start: usize = text
        .split_inclusive('\n')
        .take(line)
        .map(str::len)
        .sum::<usize>()
        + column;
    let is_name = |c: char| c.is_alphanumeric() || "_-".contains(c);
    let start = start + text[start..].find(is_name)?;
    let length = text[start..].find(|c| !is_name(c))?;
    Some(format!(
        "{}{word}{}",
        &text[..start],
        &text[start + length..]
    ))
}

#[tokio::test]
async fn an_agent_mends_a_case_by_its_messages_runs_it_and_reads_the_results() {
    let folder = tempfile::tempdir().unwrap();
    let client = client(folder.path()).await;
    let tools = client.list_all_tools().await.unwrap();
    assert!(tools.iter().any(|tool| tool.name == "check"));
    let mut text = CASE
        .replace("penalty = 1e5", "penaltty = 1e5")
        .replace("secondary = \"tip_node\"", "secondary = \"tip_nod\"")
        .replace("material = \"soft\"", "material = \"sofft\"")
        .replace("[checkpoint]", "[chekpoint]");
    let mut rounds = 0;
    loop {
        let checked = done(
            &client,
            "check",
            json!({ "path": "brick/case.toml", "text": text }),
        )
        .await;
        if checked["ok"] == true {
            break;
        }
        assert_eq!(checked["exit_code"], 3, "{checked:#}");
        let found = checked["diagnostics"].as_array().unwrap();
        let finding = found
            .iter()
            .find(|one| proposed(one).is_some())
            .unwrap_or_else(|| panic!("nothing is proposed in {checked:#}"));
        assert!(finding["code"].as_str().unwrap().starts_with('S'));
        assert!(finding["file"].as_str().unwrap().ends_with("case.toml"));
        text = mended(&text, finding).unwrap();
        rounds += 1;
        assert!(rounds < 9, "{text}");
    }
    assert_eq!((rounds, text.as_str()), (4, CASE));

    let explained = call(&client, "explain", json!({ "what": "S0102" })).await;
    assert_ne!(explained.is_error, Some(true), "{explained:#?}");
    let explained = call(&client, "explain", json!({ "what": "contact.enforcement" })).await;
    assert_ne!(explained.is_error, Some(true), "{explained:#?}");
    let keys = done(&client, "schema", json!({ "key": "contact.friction" })).await;
    assert!(
        keys["keys"]
            .as_array()
            .unwrap()
            .iter()
            .any(|key| key["key"] == "mu"),
        "{keys:#}"
    );

    let ran = done(
        &client,
        "run",
        json!({ "path": "brick/case.toml", "threads": 1 }),
    )
    .await;
    assert_eq!(
        (&ran["ok"], &ran["status"]),
        (&json!(true), &json!("solved")),
        "{ran:#}"
    );
    assert_eq!(
        (&ran["output"], &ran["increments"]),
        (&json!("brick/case.out"), &json!(4))
    );
    let force = &ran["summary"]["contacts"]["tip"]["force"][2];
    let status = done(&client, "status", json!({ "path": "brick/case.out" })).await;
    assert_eq!(status["state"], "finished");
    let arguments =
        json!({ "path": "brick/case.out", "columns": ["time", "tip.force_z"], "rows": 2 });
    let results = done(&client, "results", arguments).await;
    assert_eq!(
        results["table"]["rows"][1],
        json!([1.0, force]),
        "{results:#}"
    );
    assert_eq!(results["table"]["total_rows"], 4);
    let names = results["fields"]
        .as_array()
        .unwrap()
        .iter()
        .map(|field| &field["name"]);
    assert!(
        names.clone().any(|name| name == "displacement"),
        "{results:#}"
    );
    client.cancel().await.unwrap();
}

#[tokio::test]
async fn templates_are_written_checked_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    let client = client(folder.path()).await;
    let list = done(&client, "init", json!({})).await;
    let names: Vec<&str> = list["templates"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["template"].as_str().unwrap())
        .collect();
    assert!(names.contains(&"paper-brick"), "{names:?}");
    let made = done(
        &client,
        "init",
        json!({ "template": "paper-brick", "folder": "new" }),
    )
    .await;
    let case = made["written"][0].as_str().unwrap();
    assert_eq!(
        done(&client, "check", json!({ "path": case })).await["ok"],
        true
    );
    let again = call(
        &client,
        "init",
        json!({ "template": "paper-brick", "folder": "new" }),
    )
    .await;
    assert_eq!(again.is_error, Some(true));
    client.cancel().await.unwrap();
}

#[tokio::test]
async fn files_outside_that_a_case_names_are_refused_with_their_place() {
    let top = tempfile::tempdir().unwrap();
    let root = top.path().join("root");
    std::fs::create_dir(&root).unwrap();
    std::fs::write(top.path().join("secret.msh"), "$MeshFormat\n").unwrap();
    let client = client(&root).await;
    let text = "[mesh]\nfile = \"../secret.msh\"\n[material.a]\nmodel = \"linear-elastic\"\nE = 1.0\nnu = 0.3\n\
        [[body]]\ngroup = \"b\"\nmaterial = \"a\"\n[[step]]\nname = \"s\"\n";
    let checked = done(
        &client,
        "check",
        json!({ "path": "case.toml", "text": text }),
    )
    .await;
    let finding = &checked["diagnostics"][0];
    assert!(
        finding["message"]
            .as_str()
            .unwrap()
            .contains("is outside of"),
        "{checked:#}"
    );
    assert_eq!(finding["line"], 2);
    let set = json!(["mesh.file=../secret.msh"]);
    let text = text.replace("../secret.msh", "none.msh");
    let ran = done(
        &client,
        "check",
        json!({ "path": "case.toml", "text": text, "set": set }),
    )
    .await;
    assert!(
        ran["diagnostics"][0]["message"]
            .as_str()
            .unwrap()
            .contains("is outside of"),
        "{ran:#}"
    );
    client.cancel().await.unwrap();
}

/// A run of many increments that has begun; its request.
async fn begun(client: &Client, folder: &Path) -> rmcp::service::RequestHandle<rmcp::RoleClient> {
    let long = CASE.replace("fixed = 4", "fixed = 20000");
    std::fs::write(folder.join("case.toml"), long).unwrap();
    let run = params("run", json!({ "path": "case.toml" }));
    let request = ClientRequest::CallToolRequest(Request::new(run));
    let options = PeerRequestOptions::no_options();
    let handle = client
        .send_cancellable_request(request, options)
        .await
        .unwrap();
    let checkpoint = folder.join("case.out/checkpoint/a.sgc");
    for _ in 0..600 {
        tokio::time::sleep(Duration::from_millis(100)).await;
        if checkpoint.exists() {
            return handle;
        }
    }
    panic!("no checkpoint was written");
}

/// What the run in a folder has reached once it goes on no longer.
async fn stopped(client: &Client) -> Value {
    for _ in 0..600 {
        let status = done(client, "status", json!({ "path": "case.out" })).await;
        if status["state"] != "running" {
            return status;
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    panic!("the run goes on");
}

#[tokio::test]
async fn a_cancelled_run_is_interrupted_and_goes_on_from_its_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let client = client(folder.path()).await;
    let handle = begun(&client, folder.path()).await;
    let status = done(&client, "status", json!({ "path": "case.out" })).await;
    assert_eq!(status["state"], "running", "{status:#}");
    handle.cancel(None).await.unwrap();
    let status = stopped(&client).await;
    assert_eq!(status["state"], "interrupted", "{status:#}");
    let arguments = json!({ "path": "case.out", "resume": true, "max_wall": 1.0 });
    let resumed = done(&client, "run", arguments).await;
    let ended = (&resumed["exit_code"], &resumed["resumable"]);
    assert_eq!(ended, (&json!(8), &json!(true)), "{resumed:#}");
    client.cancel().await.unwrap();
}

#[cfg(unix)]
#[tokio::test]
async fn a_server_that_is_terminated_interrupts_its_runs() {
    let folder = tempfile::tempdir().unwrap();
    let (first, process) = client_and_process(folder.path()).await;
    let _handle = begun(&first, folder.path()).await;
    let killed = Command::new("kill").arg(process.to_string()).status();
    assert!(killed.unwrap().success());
    let second = client(folder.path()).await;
    let status = stopped(&second).await;
    assert_eq!(status["state"], "interrupted", "{status:#}");
    drop(first);
    second.cancel().await.unwrap();
}

#[test]
fn a_folder_that_does_not_exist_is_an_error_of_the_command_line() {
    let output = Command::new(env!("CARGO_BIN_EXE_signorini"))
        .args(["mcp", "--root", "/no/such/folder"])
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("/no/such/folder"), "{said}");
    assert!(output.stdout.is_empty());
}
