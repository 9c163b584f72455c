use super::*;
use crate::run::hold;
use signorini_io::fs::{MemoryFs, RealFs};

const EVENTS: &str = concat!(
    r#"{"v":1,"ev":"start","case":"a","duration":2.0}"#,
    "\n",
    r#"{"v":1,"ev":"checkpoint","step":"press","inc":0,"time":0.0,"file":"checkpoint/a.sgc"}"#,
    "\n",
    r#"{"v":1,"ev":"iteration","step":"press","inc":1,"att":1,"iter":1,"residual":1.0,"x":0}"#,
    "\n",
    r#"{"v":1,"ev":"iteration","step":"press","inc":1,"att":1,"iter":2,"residual":null}"#,
    "\n",
    r#"{"v":1,"ev":"increment","step":"press","inc":1,"time":0.5,"iters":1,"contact":{"tip":{"force":[0,0,2.5],"area":1,"pressure_max":null,"closed":1}}}"#,
    "\n",
    r#"{"v":1,"ev":"frame","frame":0,"time":0.5,"files":[]}"#,
    "\n",
    r#"{"v":1,"ev":"iteration","step":"press","inc":2,"att":3,"iter":1,"residual":1e-3}"#,
    "\n",
    r#"{"v":1,"ev":"iteration","step":"pre"#,
);

fn folder(files: &[(&str, &str)]) -> MemoryFs {
    let fs = MemoryFs::default();
    for (name, text) in files {
        let path = Path::new("a.out").join(name);
        fs.write(&path, text.as_bytes()).unwrap();
    }
    fs
}

fn owner() -> (&'static str, String) {
    let text = serde_json::to_string(&Owner::default()).unwrap();
    ("checkpoint/run.json", text)
}

fn seen(fs: &MemoryFs) -> Status {
    status(fs, Path::new("a.out")).unwrap()
}

#[test]
fn progress_is_that_of_the_last_whole_lines() {
    let progress = Progress::of(EVENTS.as_bytes());
    assert_eq!(progress.step.as_deref(), Some("press"));
    assert_eq!((progress.increment, progress.time), (1, 0.5));
    assert_eq!((progress.increments, progress.iterations), (1, 1));
    assert_eq!(progress.duration, Some(2.0));
    assert_eq!(progress.frames, 1);
    let attempt = progress.attempt.unwrap();
    assert_eq!(
        (attempt.increment, attempt.attempt, attempt.iteration),
        (2, 3, 1)
    );
    let tip = &progress.contacts["tip"];
    assert_eq!(tip.force[2], 2.5);
    assert!(tip.pressure_max.is_nan());
    assert_eq!(progress.checkpoint.unwrap().file, "checkpoint/a.sgc");
    assert!(!progress.resumed);
}

#[test]
fn a_folder_without_an_ending_is_running_or_killed() {
    let (name, text) = owner();
    let fs = folder(&[(name, &text), ("events.jsonl", EVENTS)]);
    let killed = seen(&fs);
    assert_eq!(killed.state, State::Killed);
    assert_eq!(killed.resume.as_deref(), Some("signorini resume a.out"));
    let lock = fs.lock(Path::new("a.out/checkpoint/lock")).unwrap();
    let running = seen(&fs);
    assert_eq!(
        (running.state, running.resume.as_deref()),
        (State::Running, None)
    );
    drop(lock);
    assert_eq!(seen(&fs).state, State::Killed);
}

#[test]
fn an_ending_decides_what_a_run_without_a_process_is() {
    for (code, status, state) in [
        (0, "solved", State::Finished),
        (1, "expectation failed", State::Finished),
        (130, "interrupted", State::Interrupted),
        (8, "time limit reached", State::Interrupted),
        (0, "first steps solved", State::Interrupted),
        (8, "out of memory", State::Failed),
        (5, "not converged", State::Failed),
    ] {
        let (name, text) = owner();
        let summary = Summary {
            status: status.into(),
            exit_code: code,
            ..Summary::default()
        };
        let error = r#"{"v":1,"ev":"diagnostic","severity":"error","code":"S0501","message":"m"}"#;
        let fs = folder(&[
            (name, &text),
            ("events.jsonl", &format!("{EVENTS}\n{error}\n")),
            ("summary.json", &summary.text()),
        ]);
        let seen = seen(&fs);
        assert_eq!(seen.state, state, "{status}");
        let is_failed = state == State::Failed;
        assert_eq!(seen.reason.is_some(), is_failed);
        if is_failed {
            assert_eq!(seen.reason.as_deref(), Some("S0501: m"));
        }
        assert!(seen.lines()[0].contains(status));
    }
}

#[test]
fn a_second_start_is_a_resumed_run() {
    let twice = format!("{EVENTS}\n{EVENTS}");
    let (name, text) = owner();
    let fs = folder(&[(name, &text), ("events.jsonl", &twice)]);
    let seen = seen(&fs);
    assert!(seen.progress.resumed);
    assert!(
        seen.lines()[0].starts_with("killed, resumed"),
        "{:?}",
        seen.lines()
    );
}

#[test]
fn folders_with_blanks_are_quoted() {
    assert_eq!(quoted(Path::new("a b.out")), "\"a b.out\"");
    assert_eq!(quoted(Path::new("a.out")), "a.out");
}

#[test]
fn who_is_killed_after_an_ending_is_not_called_by_it() {
    let dir = tempfile::tempdir().unwrap();
    let fs = RealFs;
    let (name, text) = owner();
    let at = |name: &str| dir.path().join(name);
    fs.create_dir_all(&at("checkpoint")).unwrap();
    fs.write(&at(name), text.as_bytes()).unwrap();
    let summary = Summary {
        status: "interrupted".into(),
        exit_code: 130,
        ..Summary::default()
    };
    fs.write(&at("summary.json"), summary.text().as_bytes())
        .unwrap();
    let state = || status(&fs, dir.path()).unwrap().state;
    assert_eq!(state(), State::Interrupted);
    let lock = hold(&fs, dir.path()).unwrap();
    assert_eq!(state(), State::Running);
    drop(lock);
    assert_eq!(state(), State::Interrupted, "it ended by itself");
    // disks count time in steps
    std::thread::sleep(std::time::Duration::from_millis(20));
    fs.write(&at("checkpoint/lock"), b"4711\n").unwrap();
    assert_eq!(state(), State::Killed);
}
