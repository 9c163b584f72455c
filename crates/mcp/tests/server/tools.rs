//! What the tools do with what the command says.

use crate::support::{Yard, text, until};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The stand-in prints an object.
fn prints(value: &Value) -> String {
    format!("cat <<'END'\n{value}\nEND\n")
}

#[tokio::test]
async fn the_page_of_the_documentation_lists_the_tools_that_clients_get() {
    let yard = Yard::new("");
    let session = yard.session().await;
    let tools = session.client.list_all_tools().await.unwrap();
    let page = include_str!("../../../../docs/mcp.md");
    let rows: BTreeMap<&str, &str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split_once("` | "))
        .collect();
    let names: Vec<&str> = tools.iter().map(|tool| tool.name.as_ref()).collect();
    let documented: Vec<&str> = rows.keys().copied().collect();
    assert_eq!(documented, {
        let mut names = names.clone();
        names.sort_unstable();
        names
    });
    for tool in &tools {
        let row = rows[tool.name.as_ref()];
        assert!(
            tool.description
                .as_ref()
                .is_some_and(|text| text.len() > 60),
            "{}",
            tool.name
        );
        let keys = tool.input_schema["properties"].as_object().unwrap();
        for (key, schema) in keys {
            assert!(
                row.contains(&format!("`{key}`")),
                "{}: `{key}` is not in {row}",
                tool.name
            );
            let described = schema["description"].as_str().unwrap_or_default();
            assert!(described.len() > 20, "{}.{key}", tool.name);
        }
        assert_eq!(
            tool.input_schema["additionalProperties"],
            json!(false),
            "{}",
            tool.name
        );
    }
    session.close().await;
}

#[tokio::test]
async fn a_check_returns_messages_with_place_and_help() {
    let finding = json!({
        "severity": "error", "code": "S0102", "message": "unknown key `foo`", "file": "./a.toml", "line": 2, "column": 1,
        "label": "did you mean `format`?", "help": ["write format = 1"], "notes": ["keys: format, mesh"],
    });
    let answer = json!({ "v": 1, "command": "check", "ok": false, "exit_code": 3, "diagnostics": [finding] });
    let yard = Yard::new(&prints(&answer));
    let session = yard.session().await;
    let arguments = json!({ "path": "a.toml", "text": "foo = 1\n", "set": ["mesh.file=b.msh"] });
    let result = session.call("check", arguments).await;
    assert_ne!(result.is_error, Some(true));
    let said = text(&result);
    for words in [
        "a.toml cannot be run: 1 error",
        "error[S0102] ./a.toml:2:1: unknown key `foo` (did you mean `format`?)",
        "help: write format = 1",
        "note: keys: format, mesh",
    ] {
        assert!(said.contains(words), "{words} is missing in\n{said}");
    }
    assert_eq!(
        result.structured_content.unwrap()["diagnostics"][0],
        finding
    );
    assert_eq!(
        std::fs::read_to_string(yard.root().join("a.toml")).unwrap(),
        "foo = 1\n"
    );
    assert_eq!(
        yard.calls(),
        ["check ./a.toml --json --set=mesh.file=b.msh"]
    );
    session.close().await;
}

#[tokio::test]
async fn many_messages_are_cut_and_counted() {
    let finding = json!({ "severity": "error", "code": "S0102", "message": "m" });
    let answer = json!({ "ok": false, "exit_code": 3, "diagnostics": vec![finding; 70] });
    let yard = Yard::new(&prints(&answer));
    yard.write("a.toml", "");
    let session = yard.session().await;
    let value = session.done("check", json!({ "path": "a.toml" })).await;
    assert_eq!(value["diagnostics"].as_array().unwrap().len(), 50);
    assert_eq!(value["diagnostics_left_out"], 20);
    session.close().await;
}

/// A run that solves.
const SOLVES: &str = r#"
mkdir -p block.out
echo '{"status":"solved","exit_code":0,"contacts":{"foot":{"force":[0,0,1.5]}}}' > block.out/summary.json
cat <<'END'
{"v":1,"ev":"start","case":"block.toml","nodes":8}
{"v":1,"ev":"increment","step":"press","inc":1,"time":0.5,"iters":2,"contact":{}}
END
sleep 0.4
cat <<'END'
{"v":1,"ev":"increment","step":"press","inc":2,"time":1.0,"iters":2,"contact":{"foot":{"pressure_max":2.5}}}
{"v":1,"ev":"expect","what":"foot.force_z","value":1.5,"got":1.5,"ok":true}
{"v":1,"ev":"end","status":"solved","exit_code":0,"seconds":0.1}
END
"#;

#[tokio::test]
async fn a_run_reports_progress_and_returns_its_summary() {
    let yard = Yard::new(SOLVES);
    yard.write("block.toml", "");
    let session = yard.session().await;
    let arguments = json!({ "path": "block.toml", "threads": 1, "max_wall": 90, "set": ["a=1"] });
    let result = session.call("run", arguments).await;
    assert_ne!(result.is_error, Some(true), "{result:#?}");
    let said = text(&result);
    assert!(
        said.starts_with("solved (exit code 0): 2 increments"),
        "{said}"
    );
    assert!(
        said.contains("expect foot.force_z: 1.5 for 1.5, met"),
        "{said}"
    );
    assert!(
        said.contains("contact foot: {\"pressure_max\":2.5}"),
        "{said}"
    );
    let value = result.structured_content.unwrap();
    assert_eq!(value["summary"]["contacts"]["foot"]["force"][2], 1.5);
    assert_eq!(
        (&value["ok"], &value["output"]),
        (&json!(true), &json!("block.out"))
    );
    assert_eq!(value["last_increment"]["time"], 1.0);
    assert_eq!(
        (&value["increments"], &value["iterations"]),
        (&json!(2), &json!(4))
    );
    let expected =
        "run ./block.toml --output=./block.out --set=a=1 --json --max-wall=90s --threads=1";
    assert_eq!(yard.calls(), [expected]);
    // the library asks for progress of every call
    until("progress", || {
        session.ear.progress.lock().unwrap().len() >= 2
    })
    .await;
    let reports = session.ear.progress.lock().unwrap().clone();
    let first = reports.first().unwrap();
    assert_eq!(
        first.message.as_deref(),
        Some("step press, increment 1, time 0.5, converged")
    );
    assert!(
        reports
            .windows(2)
            .all(|pair| pair[0].progress < pair[1].progress)
    );
    session.close().await;
}

#[tokio::test]
async fn a_run_goes_on_from_its_folder() {
    let yard = Yard::new(
        "echo '{\"v\":1,\"ev\":\"end\",\"status\":\"not started\",\"exit_code\":7}'; exit 7",
    );
    yard.write("a/b.out/history.csv", "time\n");
    let session = yard.session().await;
    let value = session
        .done("run", json!({ "path": "a/b.out", "resume": true }))
        .await;
    assert_eq!(
        (&value["exit_code"], &value["output"]),
        (&json!(7), &Value::Null)
    );
    assert_eq!(yard.calls(), ["resume ./a/b.out --json --max-wall=600s"]);
    let said = session
        .refused(
            "run",
            json!({ "path": "a/b.out", "resume": true, "set": ["a=1"] }),
        )
        .await;
    assert!(said.contains("leave out set"), "{said}");
    session.close().await;
}

#[tokio::test]
async fn a_command_that_breaks_down_is_reported_and_the_server_goes_on() {
    let yard = Yard::new("echo 'panicked at x' >&2; kill -SEGV $$");
    yard.write("a.toml", "");
    let session = yard.session().await;
    for tool in ["run", "check"] {
        let said = session.refused(tool, json!({ "path": "a.toml" })).await;
        assert!(
            said.contains("panicked at x") && said.contains("signal"),
            "{said}"
        );
    }
    yard.act("echo no object");
    session.refused("check", json!({ "path": "a.toml" })).await;
    yard.act("yes | head -c 20000000");
    let said = session.refused("check", json!({ "path": "a.toml" })).await;
    assert!(said.contains("printed more than"), "{said}");
    yard.act("exit 70");
    session.refused("run", json!({ "path": "a.toml" })).await;
    yard.act("echo '{\"ok\":true,\"diagnostics\":[]}'");
    session.done("check", json!({ "path": "a.toml" })).await;
    session.close().await;
}

#[tokio::test]
async fn help_after_a_failure_is_what_can_be_done_about_it() {
    let yard = Yard::new("");
    yard.write("a.toml", "");
    yard.write("a.out/history.csv", "time\n");
    let session = yard.session().await;
    let init = ("init", json!({ "template": "slope" }));
    let run = ("run", json!({ "path": "a.toml" }));
    let report = ("report", json!({ "path": "a.out" }));
    let start = "echo '{\"v\":1,\"ev\":\"start\",\"nodes\":8}'";
    for (act, (tool, arguments), help) in [
        ("exit 3".to_owned(), &init, "change the arguments"),
        ("exit 2".to_owned(), &run, "change the arguments"),
        ("exit 6".to_owned(), &report, "the free space"),
        ("kill -KILL $$".to_owned(), &run, "call again"),
        (format!("{start}; kill -KILL $$"), &run, "resume = true"),
    ] {
        yard.act(&act);
        let said = session.refused(tool, arguments.clone()).await;
        let (_, given) = said.rsplit_once("help: ").unwrap();
        assert!(given.contains(help), "{act}: {said}");
        assert_eq!(said.contains("a.out"), help.starts_with("resume"), "{said}");
    }
    session.close().await;
}

#[tokio::test]
async fn results_are_a_summary_a_part_of_a_table_and_fields() {
    let fields = json!([{ "name": "stress", "on": "node", "components": [
        { "name": "XX", "range": [-1.0, 2.0] }, { "name": "YY", "range": null }] }]);
    let yard = Yard::new(&prints(
        &json!({ "ok": true, "fields": fields, "times": [0.0, 1.0] }),
    ));
    let session = yard.session().await;
    let rows: String = (0..200).map(|i| format!("{i},press,{}\n", i * 2)).collect();
    yard.write(
        "a.out/history.csv",
        &format!("time,step,foot.force_z\n{rows}"),
    );
    let value = session.done("results", json!({ "path": "a.out" })).await;
    assert_eq!(value["summary"], Value::Null);
    assert_eq!(value["table"]["rows"].as_array().unwrap().len(), 50);
    assert_eq!(
        (&value["table"]["truncated"], &value["table"]["first_row"]),
        (&json!(true), &json!(150))
    );
    yard.write(
        "a.out/summary.json",
        "{\"status\":\"solved\",\"exit_code\":0,\"contacts\":{\"foot\":{\"area\":2}},\
         \"expectations\":[{\"what\":\"foot.force_z\",\"value\":1,\"got\":1,\"ok\":true}]}",
    );
    let arguments =
        json!({ "path": "a.out", "columns": ["foot.force_z"], "rows": 2, "first_row": 3 });
    let result = session.call("results", arguments).await;
    let said = text(&result);
    for words in [
        "solved (exit code 0)",
        "contact foot: {\"area\":2}",
        "expect foot.force_z: 1 for 1, met",
        "rows 3 to 4 of 200",
        "foot.force_z\n6\n8",
        "stress (node) XX[-1.0, 2.0] YY[no numbers]",
    ] {
        assert!(said.contains(words), "{words} is missing in\n{said}");
    }
    let value = result.structured_content.unwrap();
    assert_eq!(value["table"]["rows"], json!([[6], [8]]));
    assert_eq!(value["fields"], fields);
    let said = session
        .refused("results", json!({ "path": "a.out", "columns": ["force"] }))
        .await;
    assert!(
        said.contains("there is no column \"force\"; the columns are: time, step, foot.force_z"),
        "{said}"
    );
    std::fs::write(yard.root().join("a.out/convergence.csv"), b"a,b\n1,\xff\n").unwrap();
    let said = session
        .refused(
            "results",
            json!({ "path": "a.out", "table": "convergence" }),
        )
        .await;
    assert!(
        said.starts_with("a.out/convergence.csv: the table cannot be read"),
        "{said}"
    );
    yard.write("a.out/summary.json", "{\"torn");
    session.refused("results", json!({ "path": "a.out" })).await;
    session.close().await;
}

#[tokio::test]
async fn a_report_is_a_path_once_it_is_there() {
    let yard = Yard::new("echo page > a.out/report.html");
    yard.write("a.out/history.csv", "time\n");
    let session = yard.session().await;
    let value = session.done("report", json!({ "path": "a.out" })).await;
    assert_eq!(value["path"], "a.out/report.html");
    assert!(std::path::Path::new(value["absolute_path"].as_str().unwrap()).exists());
    assert_eq!(yard.calls(), ["report ./a.out -o ./a.out/report.html"]);
    std::fs::remove_file(yard.root().join("a.out/report.html")).unwrap();
    yard.act("echo no frames >&2; exit 3");
    let said = session.refused("report", json!({ "path": "a.out" })).await;
    assert!(said.contains("no frames"), "{said}");
    session.close().await;
}

#[tokio::test]
async fn the_schema_is_read_once_and_described_by_key() {
    let schema = json!({ "properties": { "mesh": { "type": "object", "properties": { "file": { "type": "string" } } } } });
    let yard = Yard::new(&prints(&schema));
    let session = yard.session().await;
    let top = session.done("schema", json!({})).await;
    assert_eq!(top["keys"][0]["key"], "mesh");
    let file = session.done("schema", json!({ "key": "mesh.file" })).await;
    assert_eq!(file["schema"]["type"], "string");
    let said = session.refused("schema", json!({ "key": "mehs" })).await;
    assert!(said.contains("did you mean mesh?"), "{said}");
    assert_eq!(yard.calls(), ["schema"]);
    session.close().await;
}

#[tokio::test]
async fn codes_templates_and_files_are_listed() {
    let yard = Yard::new(&prints(
        &json!({ "ok": true, "code": "S0501", "title": "t", "remedies": ["mend it"] }),
    ));
    let session = yard.session().await;
    let result = session.call("explain", json!({ "what": "S0501" })).await;
    assert!(
        text(&result).contains("remedies: \n  mend it"),
        "{}",
        text(&result)
    );
    yard.act("printf 'hertz  a ball\\nslope  a block\\n'");
    let list = session.done("init", json!({})).await;
    assert_eq!(
        list["templates"][1],
        json!({ "template": "slope", "about": "a block" })
    );
    yard.act("mkdir -p sub; echo x > sub/slope.toml");
    let made = session
        .done("init", json!({ "template": "slope", "folder": "sub" }))
        .await;
    assert_eq!(made["written"], json!(["sub/slope.toml"]));
    let files = session.done("list_files", json!({})).await;
    assert_eq!(
        files["files"][1],
        json!({ "path": "sub/slope.toml", "kind": "file", "size": 2 })
    );
    let read = session
        .done("read_case", json!({ "path": "sub/slope.toml" }))
        .await;
    assert_eq!(
        (&read["text"], &read["truncated"]),
        (&json!("x\n"), &json!(false))
    );
    yard.write("sub/slope.toml", "1\n2\n3\n4\n");
    let read = session
        .done(
            "read_case",
            json!({ "path": "sub/slope.toml", "first_line": 2, "lines": 2 }),
        )
        .await;
    assert_eq!(
        (&read["text"], &read["total_lines"]),
        (&json!("2\n3\n"), &json!(4))
    );
    assert_eq!(
        yard.calls(),
        ["explain S0501 --json", "init --list", "init slope ./sub"]
    );
    session.close().await;
}
