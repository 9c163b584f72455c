//! What clients cannot do.

use crate::support::Yard;
use rmcp::model::CallToolResult;
use serde_json::json;
use signorini_mcp::{Limits, Options, ServeError, Server};
use std::os::unix::fs::symlink;
use std::path::PathBuf;

/// A folder with links that lead out of it, and files next to it.
fn yard() -> Yard {
    let yard = Yard::new("echo '{\"ok\":true,\"diagnostics\":[]}'");
    std::fs::write(yard.outside("secret.toml"), "secret").unwrap();
    std::fs::create_dir_all(yard.outside("secret.out")).unwrap();
    std::fs::write(yard.outside("secret.out/history.csv"), "secret\n1\n").unwrap();
    yard.write("case.toml", "x");
    yard.write("case.out/history.csv", "time\n");
    yard.write(".hidden/case.toml", "x");
    symlink(yard.top(), yard.root().join("up")).unwrap();
    symlink(yard.outside("secret.toml"), yard.root().join("link.toml")).unwrap();
    symlink(yard.outside("new.toml"), yard.root().join("dangling.toml")).unwrap();
    symlink(yard.outside("secret.out"), yard.root().join("link.out")).unwrap();
    yard
}

/// Paths that lead out of the folder, or are none.
fn bad_paths(yard: &Yard) -> Vec<String> {
    let secret = yard.outside("secret.toml").to_str().unwrap().to_owned();
    let long = format!("{}.toml", "x/".repeat(600));
    let mut paths = vec![secret, long];
    for path in [
        "../secret.toml",
        "a/../../secret.toml",
        "case.out/../../secret.toml",
        "up/secret.toml",
        "up/new.toml",
        "link.toml",
        "dangling.toml",
        ".hidden/case.toml",
        "a/.git/hooks.txt",
        "/etc/passwd",
        "",
        "a\0b.toml",
        "a\nb.toml",
        "..",
        "/",
    ] {
        paths.push(path.to_owned());
    }
    paths
}

/// All names under a folder, links not followed.
fn tree(folder: PathBuf) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.is_symlink() {
            all.extend(tree(path.clone()));
        }
        all.push(path);
    }
    all.sort();
    all
}

#[tokio::test]
async fn no_path_leads_out_of_the_folder_in_any_tool() {
    let yard = yard();
    let session = yard.session().await;
    let before = tree(yard.top().to_path_buf());
    for path in bad_paths(&yard) {
        let calls = [
            ("check", json!({ "path": path })),
            ("check", json!({ "path": path, "text": "t" })),
            ("write_case", json!({ "path": path, "text": "t" })),
            ("read_case", json!({ "path": path })),
            ("run", json!({ "path": path })),
            ("run", json!({ "path": "case.toml", "output": path })),
            ("run", json!({ "path": path, "resume": true })),
            ("status", json!({ "path": path })),
            ("results", json!({ "path": path })),
            ("report", json!({ "path": path })),
            ("list_files", json!({ "folder": path })),
            ("init", json!({ "template": "hertz", "folder": path })),
        ];
        for (tool, arguments) in calls {
            let said = session.refused(tool, arguments).await;
            assert!(!said.contains("secret\n"), "{said}");
        }
    }
    for folder in ["link.out", "up", "up/secret.out"] {
        for tool in ["status", "results", "report"] {
            session.refused(tool, json!({ "path": folder })).await;
        }
        session
            .refused("run", json!({ "path": "case.toml", "output": folder }))
            .await;
        session
            .refused("list_files", json!({ "folder": folder }))
            .await;
    }
    assert_eq!(yard.calls(), [""; 0], "the command was never started");
    assert_eq!(
        tree(yard.top().to_path_buf()),
        before,
        "nothing was written"
    );
    session.close().await;
}

#[tokio::test]
async fn the_folder_of_results_next_to_a_case_may_be_no_link() {
    let yard = yard();
    yard.write("link.inp", "*HEADING\n");
    let session = yard.session().await;
    // link.out is a link that leads out
    let said = session.refused("run", json!({ "path": "link.inp" })).await;
    assert!(said.contains("link.out"), "{said}");
    // and so may be its tables and its report
    symlink(
        yard.outside("secret.out/history.csv"),
        yard.root().join("case.out/convergence.csv"),
    )
    .unwrap();
    session
        .refused(
            "results",
            json!({ "path": "case.out", "table": "convergence" }),
        )
        .await;
    symlink(
        yard.outside("new.html"),
        yard.root().join("case.out/report.html"),
    )
    .unwrap();
    session
        .refused("report", json!({ "path": "case.out" }))
        .await;
    session.close().await;
}

#[tokio::test]
async fn links_are_listed_and_not_followed_and_hidden_files_are_left_out() {
    let yard = yard();
    let session = yard.session().await;
    let listed = session.done("list_files", json!({ "depth": 8 })).await;
    let names: Vec<&str> = listed["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|file| file["path"].as_str().unwrap())
        .collect();
    let expected = [
        "case.out",
        "case.out/history.csv",
        "case.toml",
        "dangling.toml",
        "link.out",
        "link.toml",
        "up",
    ];
    assert_eq!(names, expected);
    assert_eq!(listed["files"][6]["kind"], "other");
    session.close().await;
}

#[tokio::test]
async fn an_absolute_path_in_the_folder_is_as_good_as_a_relative_one() {
    let yard = yard();
    let session = yard.session().await;
    let path = yard.root().canonicalize().unwrap().join("case.toml");
    session.done("check", json!({ "path": path })).await;
    assert_eq!(yard.calls(), ["check ./case.toml --json"]);
    session.close().await;
}

#[tokio::test]
async fn nothing_that_a_client_sends_is_taken_for_an_option() {
    let yard = yard();
    yard.write("-o.toml", "x");
    yard.write("--output=x/case.toml", "x");
    let session = yard.session().await;
    session
        .done(
            "check",
            json!({ "path": "-o.toml", "set": ["--output=../x=1", "-o=/tmp"] }),
        )
        .await;
    session
        .done("check", json!({ "path": "--output=x/case.toml" }))
        .await;
    assert_eq!(
        yard.calls(),
        [
            "check ./-o.toml --json --set=--output=../x=1 --set=-o=/tmp",
            "check ./--output=x/case.toml --json",
        ]
    );
    for what in ["--json", "-h", "a b", "a;b", "$(x)", "", "S0501 --help"] {
        session.refused("explain", json!({ "what": what })).await;
    }
    for template in ["--list", "../x", "a/b", "-x", ""] {
        session
            .refused("init", json!({ "template": template }))
            .await;
    }
    for set in ["--fresh", "novalue", "=1"] {
        session
            .refused("check", json!({ "path": "case.toml", "set": [set] }))
            .await;
    }
    for (key, value) in [
        ("threads", json!(0)),
        ("threads", json!(60000)),
        ("max_wall", json!(0)),
        ("max_wall", json!(-1)),
        ("max_wall", json!(1e300)),
        ("max_wall", json!(86401)),
    ] {
        let said = session
            .refused("run", json!({ "path": "case.toml", key: value }))
            .await;
        assert!(said.contains(key), "{said}");
    }
    session.close().await;
}

#[tokio::test]
async fn only_texts_of_known_kinds_are_written_and_read() {
    let yard = yard();
    let session = yard.session().await;
    for path in [
        "run.sh",
        "a.py",
        "toml",
        "Makefile",
        "x.toml.exe",
        "case.out",
    ] {
        session
            .refused("write_case", json!({ "path": path, "text": "t" }))
            .await;
    }
    yard.write("key.pem", "secret");
    session
        .refused("read_case", json!({ "path": "key.pem" }))
        .await;
    session
        .done(
            "write_case",
            json!({ "path": "new/folder/a.toml", "text": "t" }),
        )
        .await;
    session
        .done(
            "write_case",
            json!({ "path": "new/folder/a.toml", "text": "other" }),
        )
        .await;
    let text = std::fs::read_to_string(yard.root().join("new/folder/a.toml")).unwrap();
    assert_eq!(text, "other");
    assert_eq!(
        std::fs::read_dir(yard.root().join("new/folder"))
            .unwrap()
            .count(),
        1,
        "no draft is left"
    );
    session.close().await;
}

#[tokio::test]
async fn unknown_parameters_and_wrong_types_are_errors_of_the_request() {
    let yard = yard();
    let session = yard.session().await;
    for (tool, arguments) in [
        ("check", json!({ "path": "case.toml", "sett": [] })),
        ("check", json!({})),
        ("check", json!({ "path": 1 })),
        ("run", json!({ "path": "case.toml", "threads": "two" })),
        ("run", json!({ "path": "case.toml", "threads": -1 })),
        ("results", json!({ "path": "case.out", "rows": -5 })),
        (
            "results",
            json!({ "path": "case.out", "table": "none of these" }),
        ),
        ("no_such_tool", json!({})),
    ] {
        let request = crate::support::call(tool, arguments);
        let answer: Result<CallToolResult, _> = session.client.call_tool(request).await;
        let is_refused = answer.map_or(true, |result| result.is_error == Some(true));
        assert!(is_refused, "{tool}");
    }
    session.close().await;
}

#[tokio::test]
async fn large_texts_tables_and_lists_are_refused_or_cut() {
    let yard = yard();
    let session = yard.session().await;
    let text = "x".repeat((1 << 20) + 1);
    for tool in ["write_case", "check"] {
        let said = session
            .refused(tool, json!({ "path": "big.toml", "text": text }))
            .await;
        assert!(said.contains("1048576 are written"), "{said}");
    }
    assert!(!yard.root().join("big.toml").exists());
    let name = "c".repeat(20);
    let header = (0..100)
        .map(|i| format!("{name}{i}"))
        .collect::<Vec<_>>()
        .join(",");
    let row = vec!["1.5"; 100].join(",");
    yard.write(
        "case.out/history.csv",
        &format!("{header}\n{}", format!("{row}\n").repeat(5000)),
    );
    let value = session
        .done("results", json!({ "path": "case.out", "rows": 1_000_000 }))
        .await;
    assert_eq!(
        value["table"]["rows"].as_array().unwrap().len(),
        200,
        "20,000 numbers"
    );
    assert_eq!(value["table"]["truncated"], true);
    for i in 0..600 {
        yard.write(&format!("many/{i:03}.txt"), "");
    }
    let listed = session
        .done("list_files", json!({ "folder": "many" }))
        .await;
    assert_eq!(listed["files"].as_array().unwrap().len(), 500);
    assert_eq!(listed["truncated"], true);
    yard.write("long.txt", &"ü\n".repeat(200_000));
    let read = session
        .done("read_case", json!({ "path": "long.txt" }))
        .await;
    assert!(read["text"].as_str().unwrap().len() <= 256 << 10);
    assert_eq!(read["truncated"], true);
    yard.write("longer.txt", &"x".repeat((8 << 20) + 1));
    session
        .refused("read_case", json!({ "path": "longer.txt" }))
        .await;
    session.close().await;
}

#[tokio::test]
async fn the_command_is_confined_to_the_folder() {
    let yard = yard();
    let session = yard.session().await;
    session.done("check", json!({ "path": "case.toml" })).await;
    let noted = std::fs::read_to_string(yard.outside("calls")).unwrap();
    let root = yard.root().canonicalize().unwrap();
    let root = root.to_str().unwrap();
    assert!(
        noted.starts_with(&format!("{root}|{root}|check")),
        "{noted}"
    );
    session.close().await;
}

#[test]
fn a_folder_that_does_not_exist_is_no_root() {
    let options = Options {
        root: PathBuf::from("/no/such/folder"),
        command: vec!["signorini".into()],
        limits: Limits::default(),
    };
    let refused = Server::new(options).err();
    assert!(matches!(refused, Some(ServeError::Root { .. })));
}
