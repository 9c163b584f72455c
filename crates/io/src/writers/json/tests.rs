use super::*;
use crate::fs::RealFs;

fn summary() -> Summary {
    Summary {
        status: "solved".into(),
        steps: vec![StepSummary {
            name: "press \"1\"".into(),
            increments: 6,
            iterations: 31,
            cutbacks: 0,
            linear_iterations: 97,
            fallbacks: 1,
        }],
        contacts: [(
            "ball-block".into(),
            ContactSummary {
                force: [0.0, 0.1, 17.5],
                gap_min: -1e-300,
                ..Default::default()
            },
        )]
        .into(),
        expectations: vec![Expectation {
            what: "ball-block.force_z".into(),
            value: 25.0,
            got: 24.9,
            ok: false,
        }],
        time: [("solve".into(), 3.4)].into(),
        memory_peak_bytes: 1 << 33,
        unknowns: 1731,
        version: "0.1.0".into(),
        inputs: vec![Input {
            path: "a b/ü.toml".into(),
            sha256: "00ff".into(),
        }],
        diagnostics: vec![DiagnosticSummary {
            code: "S0402".into(),
            message: "two\nlines".into(),
        }],
        ..Default::default()
    }
}

#[test]
fn an_increment_is_the_line_that_is_documented() {
    let state = ContactState {
        force: [0.0, 0.0, 17.5],
        area: 3.2,
        pressure_max: 33.9,
        closed: 37,
    };
    let contact = [("ball-block".to_string(), state)].into();
    let event = Event::Increment {
        step: "press".into(),
        inc: 4,
        time: 0.7,
        iters: 4,
        contact,
    };
    let expected = r#"{"v":1,"ev":"increment","step":"press","inc":4,"time":0.7,"iters":4,"contact":{"ball-block":{"force":[0.0,0.0,17.5],"area":3.2,"pressure_max":33.9,"closed":37}}}"#;
    assert_eq!(event.line(), format!("{expected}\n"));
}

/// A text that has to be escaped.
const AWKWARD: &str = "a\n\"b\"";

/// Every event on the way to an increment, with its kind.
fn events_of_an_increment() -> Vec<(Event, &'static str)> {
    let text = || AWKWARD.to_string();
    let given_up = || GivenUp {
        step: text(),
        inc: 1,
        att: 1,
        time: 0.0,
        size: 0.1,
        why: text(),
    };
    vec![
        (
            Event::Iteration {
                step: text(),
                inc: 1,
                att: 1,
                iter: 1,
                residual: f64::NAN,
                correction: 0.0,
                closed: 0,
                flips: 0,
                linear: 0,
            },
            "iteration",
        ),
        (
            Event::Increment {
                step: text(),
                inc: 1,
                time: 0.0,
                iters: 1,
                contact: BTreeMap::new(),
            },
            "increment",
        ),
        (Event::Cutback(given_up()), "cutback"),
        (Event::Retry(given_up()), "retry"),
        (
            Event::Followed {
                step: text(),
                inc: 1,
                att: 2,
                time: 0.0,
                parts: 4,
            },
            "followed",
        ),
        (
            Event::Stabilized {
                step: text(),
                inc: 1,
                att: 2,
                time: 0.0,
                stages: 9,
                work: 0.5,
                work_external: 2.0,
            },
            "stabilized",
        ),
        (
            Event::Solver {
                step: text(),
                inc: 1,
                note: text(),
            },
            "solver",
        ),
    ]
}

/// Every other event, with its kind.
fn events_of_a_run() -> Vec<(Event, &'static str)> {
    let text = || AWKWARD.to_string();
    vec![
        (
            Event::Start {
                case: text(),
                title: text(),
                version: text(),
                ranks: None,
                threads: 2,
                nodes: 8,
                elements: 1,
                unknowns: 24,
                duration: 2.0,
            },
            "start",
        ),
        (
            Event::Diagnostic {
                severity: text(),
                code: text(),
                message: text(),
                file: None,
                line: Some(3),
                column: None,
                label: Some(text()),
                notes: vec![text()],
                help: Vec::new(),
            },
            "diagnostic",
        ),
        (
            Event::Explicit {
                step: text(),
                size: 1e-6,
                mass_added: 0.01,
            },
            "explicit",
        ),
        (
            Event::Held {
                step: text(),
                at: vec![text()],
            },
            "held",
        ),
        (
            Event::Frame {
                frame: 0,
                time: 0.0,
                files: vec![text()],
            },
            "frame",
        ),
        (
            Event::Checkpoint {
                step: text(),
                inc: 1,
                time: 0.0,
                file: text(),
            },
            "checkpoint",
        ),
        (
            Event::Expect {
                what: text(),
                value: 1.0,
                got: f64::INFINITY,
                ok: false,
            },
            "expect",
        ),
        (
            Event::End {
                status: text(),
                exit_code: 5,
                seconds: 0.1,
            },
            "end",
        ),
    ]
}

#[test]
fn every_event_is_one_line_with_version_and_kind() {
    let events = events_of_a_run()
        .into_iter()
        .chain(events_of_an_increment());
    for (event, kind) in events {
        let line = event.line();
        assert_eq!(line.matches('\n').count(), 1);
        assert!(
            line.starts_with(&format!("{{\"v\":1,\"ev\":\"{kind}\"")),
            "{line}"
        );
        let value: serde_json::Value = serde_json::from_str(&line).unwrap();
        assert!(kind != "iteration" || value["residual"].is_null());
        assert!(kind != "expect" || value["got"].is_null());
        assert!(kind != "diagnostic" || (value["line"] == 3 && value.get("file").is_none()));
    }
}

#[test]
fn a_summary_has_the_documented_keys_and_reads_back() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("summary.json");
    let summary = summary();
    summary.write(&RealFs, &path).unwrap();
    assert_eq!(Summary::read(&RealFs, &path).unwrap(), summary);
    let value: serde_json::Value = serde_json::from_str(&summary.text()).unwrap();
    let keys = |v: &serde_json::Value| {
        v.as_object()
            .unwrap()
            .keys()
            .cloned()
            .collect::<Vec<_>>()
            .join(" ")
    };
    assert_eq!(
        keys(&value),
        "audit contacts diagnostics exit_code expectations inputs memory_peak_bytes status steps time unknowns version work_external work_stabilization"
    );
    assert_eq!(
        keys(&value["steps"][0]),
        "cutbacks fallbacks increments iterations linear_iterations name"
    );
    assert_eq!(
        keys(&value["contacts"]["ball-block"]),
        "area_open area_slip area_stick force gap_min imbalance_force imbalance_moment moment pressure_max"
    );
    assert_eq!(keys(&value["expectations"][0]), "got ok value what");
    assert_eq!(keys(&value["inputs"][0]), "path sha256");
    assert_eq!(keys(&value["diagnostics"][0]), "code message");
}

#[test]
fn numbers_that_are_not_finite_become_null_and_read_back_as_nan() {
    let mut summary = summary();
    summary.expectations[0].got = f64::INFINITY;
    summary.time.insert("read".into(), f64::NAN);
    summary.contacts.get_mut("ball-block").unwrap().force[1] = f64::NAN;
    let text = summary.text();
    assert_eq!(text.matches("null").count(), 3, "{text}");
    let back: Summary = serde_json::from_str(&text).unwrap();
    assert!(back.expectations[0].got.is_nan() && back.time["read"].is_nan());
    assert!(
        back.contacts["ball-block"].force[1].is_nan()
            && back.contacts["ball-block"].force[2] == 17.5
    );
}

#[test]
fn an_event_file_is_cut_back_to_the_lines_kept() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("events.jsonl");
    let frame = |frame| Event::Frame {
        frame,
        time: 0.0,
        files: vec![],
    };
    let mut log = EventLog::create(&RealFs, &path).unwrap();
    for i in 0..5 {
        log.append(&frame(i)).unwrap();
    }
    log.sync().unwrap();
    drop(log);
    let mut log = EventLog::resume(&RealFs, &path, 2).unwrap();
    log.append(&frame(7)).unwrap();
    assert_eq!(log.nrow(), 3);
    let text = String::from_utf8(RealFs.read(&path).unwrap()).unwrap();
    assert_eq!(text, [0, 1, 7].map(|i| frame(i).line()).concat());
}
