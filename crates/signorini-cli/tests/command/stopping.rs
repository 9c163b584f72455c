//! Requests to stop, and what the command knows of a run that was stopped.

#![cfg(unix)]

use crate::support::{brick_in, command, folder_with, read, result, run};
use std::fmt::Write as _;
use std::fs::File;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// After this time a run hangs. No claim is made about speed.
const HANGS: Duration = Duration::from_secs(600);

/// How often a run is started again that was over before it could be stopped.
const TRIES: usize = 20;

fn send(run: &Child, signal: &str) {
    let sent = Command::new("kill")
        .args([signal, &run.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

/// A file that the command writes to, next to the case.
fn log(folder: &TempDir, name: &str) -> File {
    File::create(folder.path().join(name)).unwrap()
}

/// How many iterations `--json` has reported.
fn iterations(folder: &TempDir) -> usize {
    let events = read(&folder.path().join("events"));
    events.matches("\"ev\":\"iteration\"").count()
}

/// Waits until a condition holds or the run is over; returns whether the run goes on.
fn goes_on_until(run: &mut Child, holds: impl Fn() -> bool) -> bool {
    let clock = Instant::now();
    loop {
        if run.try_wait().unwrap().is_some() {
            return false;
        }
        if holds() {
            return true;
        }
        assert!(clock.elapsed() < HANGS, "the run does not get on");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Halts a run without its knowledge, so that everything it has reported can be counted.
fn halt(run: &Child) {
    send(run, "-STOP");
    let state = format!("/proc/{}/stat", run.id());
    let is_halted = || match std::fs::read_to_string(&state) {
        Ok(stat) => stat
            .rsplit(") ")
            .next()
            .is_some_and(|rest| rest.starts_with('T')),
        // other systems are given time
        Err(_) => {
            std::thread::sleep(Duration::from_millis(200));
            true
        }
    };
    while !is_halted() {
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// What a run did after a signal that came when it had reported so many iterations.
struct Asked {
    code: Option<i32>,
    more: usize,
    said: String,
    seconds: f64,
}

/// Starts `arguments`, asks the run to stop by a signal, and returns what it did then; none where it was over before.
fn asked(folder: &TempDir, arguments: &[&str], after: usize, signal: &str) -> Option<Asked> {
    let mut run = command(folder.path())
        .args(arguments)
        .arg("--json")
        .stdout(log(folder, "events"))
        .stderr(log(folder, "said"))
        .spawn()
        .unwrap();
    if !goes_on_until(&mut run, || iterations(folder) >= after) {
        return None;
    }
    halt(&run);
    let before = iterations(folder);
    send(&run, signal);
    let clock = Instant::now();
    send(&run, "-CONT");
    goes_on_until(&mut run, || false);
    let seconds = clock.elapsed().as_secs_f64();
    let code = run.wait().unwrap().code();
    (code != Some(0)).then(|| Asked {
        code,
        more: iterations(folder) - before,
        said: read(&folder.path().join("said")),
        seconds,
    })
}

/// Asserts what holds for every run that was asked to stop.
#[track_caller]
fn assert_stopped(folder: &TempDir, asked: &Asked, code: i32) {
    assert_eq!(asked.code, Some(code), "{}", asked.said);
    assert!(asked.more <= 1, "{} iterations more", asked.more);
    let count = asked.said.matches("stopping").count();
    assert_eq!(count, 1, "{}", asked.said);
    let exit_code = format!("interrupted (exit code {code})");
    run(folder.path(), &["info", "case.out"]).says(0, &[&exit_code, "signorini resume case.out"]);
}

#[test]
fn a_signal_stops_a_run_within_an_iteration_and_the_terminal_says_so() {
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let folder = folder_with(&brick_in(200));
        let mut tries = (0..TRIES).filter_map(|_| asked(&folder, &["run", "case.toml"], 9, signal));
        let asked = tries.next().expect("every run was over too early");
        assert_stopped(&folder, &asked, code);
        run(folder.path(), &["resume", "case.out"]).says(0, &["✓ solved: 200 increments"]);
    }
}

#[test]
fn a_time_limit_is_reported_as_stopping() {
    let folder = folder_with(&brick_in(4));
    let arguments = ["run", "case.toml", "--max-wall", "0.000001s"];
    run(folder.path(), &arguments).says(8, &["stopping", "time limit", "S0801"]);
    run(folder.path(), &["info", "case.out"]).says(0, &["time limit reached", "signorini resume"]);
}

#[test]
fn a_signal_while_a_case_is_read_ends_the_command_at_once() {
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let folder = tempfile::tempdir().unwrap();
        let case = folder.path().join("case.toml");
        assert!(
            Command::new("mkfifo")
                .arg(&case)
                .status()
                .unwrap()
                .success()
        );
        let mut run = command(folder.path())
            .args(["run", "case.toml"])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // opens when the command reads, and keeps it reading
        let writer = File::options().write(true).open(&case).unwrap();
        send(&run, signal);
        goes_on_until(&mut run, || false);
        assert_eq!(run.wait().unwrap().code(), Some(code));
        drop(writer);
    }
}

#[test]
fn info_tells_live_killed_and_finished_runs_apart() {
    let folder = folder_with(&brick_in(200));
    let start = |arguments: &[&str], frame: &str| {
        let mut run = command(folder.path())
            .args(arguments)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let frame = result(&folder, frame);
        goes_on_until(&mut run, || frame.exists()).then_some(run)
    };
    let info = || run(folder.path(), &["info", "case.out"]);
    let mut tries =
        (0..TRIES).filter_map(|_| start(&["run", "case.toml"], "frames/volume_0001.vtu"));
    let mut live = tries.next().expect("every run was over too early");
    halt(&live);
    info().says(0, &[&format!("running: process {}", live.id())]);
    // before it reads anything
    std::fs::write(result(&folder, "checkpoint/case.toml"), "no case").unwrap();
    run(folder.path(), &["resume", "case.out"]).says(6, &["held by another run"]);
    std::fs::copy(
        folder.path().join("case.toml"),
        result(&folder, "checkpoint/case.toml"),
    )
    .unwrap();
    live.kill().unwrap();
    live.wait().unwrap();
    info().says(0, &["killed", "signorini resume case.out"]);
    run(
        folder.path(),
        &["resume", "case.out", "--max-wall", "0.000001s"],
    )
    .says(8, &[]);
    info().says(0, &["time limit reached (exit code 8)"]);
    // a summary of the run before says nothing about one that was killed after it
    let mut again = start(&["resume", "case.out"], "frames/volume_0150.vtu").unwrap();
    halt(&again);
    info().says(0, &[&format!("running: process {}", again.id())]);
    again.kill().unwrap();
    again.wait().unwrap();
    info().says(0, &["killed"]);
    run(folder.path(), &["resume", "case.out"]).says(0, &[]);
    info().says(0, &["solved (exit code 0)"]);
}

/// Nodes along an edge of each block of [`two_blocks`].
const NODES: usize = 37;

/// Two blocks of hexahedra with `n` nodes along each edge, the upper one pressed down and drawn sideways: about `6 n³`
/// unknowns.
fn two_blocks(folder: &Path, n: usize) {
    let mut mesh = String::from("*NODE\n");
    let step = 1.0 / (n - 1) as f64;
    for block in 0..2 {
        for k in 0..n * n * n {
            let id = block * n * n * n + k + 1;
            let [x, y, z] = [k % n, k / n % n, k / (n * n)].map(|i| step * i as f64);
            // the surfaces do not match
            let shift = 0.3 * step * block as f64;
            writeln!(
                mesh,
                "{id}, {}, {}, {}",
                x + shift,
                y + shift,
                z + block as f64
            )
            .unwrap();
        }
    }
    for (block, name) in ["lower", "upper"].iter().enumerate() {
        writeln!(mesh, "*ELEMENT, TYPE=C3D8, ELSET={name}").unwrap();
        let m = n - 1;
        for k in 0..m * m * m {
            let id = block * m * m * m + k + 1;
            let corner = block * n * n * n + k % m + n * (k / m % m) + n * n * (k / (m * m)) + 1;
            let [a, b, c, d] = [0, 1, n + 1, n].map(|next| corner + next);
            let [e, f, g, h] = [a, b, c, d].map(|node| node + n * n);
            writeln!(mesh, "{id}, {a}, {b}, {c}, {d}, {e}, {f}, {g}, {h}").unwrap();
        }
    }
    std::fs::write(folder.join("blocks.inp"), mesh).unwrap();
}

const TWO_BLOCKS: &str = r#"
format = 1
units = "m-MN-MPa"
[mesh]
file = "blocks.inp"
[sets]
base = { plane = "z", at = 0.0 }
top = { plane = "z", at = 1.0, of = "lower" }
foot = { plane = "z", at = 1.0, of = "upper" }
head = { plane = "z", at = 2.0 }
[material.soft]
model = "linear-elastic"
E = 500.0
nu = 0.3
[[body]]
group = ["lower", "upper"]
material = "soft"
[[contact]]
name = "joint"
secondary = "foot"
primary = "top"
friction = 0.3
[[step]]
name = "slide"
increments = { fixed = 4 }
[[step.fix]]
on = "base"
u = "all"
[[step.move]]
on = "head"
ux = 0.02
uy = 0.0
uz = -0.01
"#;

#[test]
#[ignore = "takes minutes: run by .ci/run"]
fn a_signal_stops_a_model_of_300_000_unknowns_within_one_linear_solve() {
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let folder = folder_with(TWO_BLOCKS);
        two_blocks(folder.path(), NODES);
        let asked = asked(&folder, &["run", "case.toml"], 1, signal).expect("a run over too early");
        println!(
            "{signal}: {:.1} s from the signal to the end",
            asked.seconds
        );
        assert_stopped(&folder, &asked, code);
        let events = read(&folder.path().join("events"));
        let start: serde_json::Value =
            serde_json::from_str(events.lines().next().unwrap()).unwrap();
        let unknowns = start["unknowns"].as_u64().unwrap();
        assert!((290_000..320_000).contains(&unknowns), "{unknowns}");
        let more = ["resume", "case.out", "--max-wall", "1s"];
        run(folder.path(), &more).says(8, &["stopping", "S0801"]);
    }
}
