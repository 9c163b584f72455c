//! A disk that fails at every single operation of a whole run.

use super::failure::{Saved, message};
use super::{Finished, Listener, News, RunOptions, run};
use crate::load::Source;
use crate::setup::{Model, build};
use signorini_io::case::read_case;
use signorini_io::checkpoint::Checkpoints;
use signorini_io::diagnostic::Diagnostics;
use signorini_io::fs::{FailingFs, Fs, RealFs};
use signorini_io::writers::json::Event;
use signorini_io::writers::pvd::Pvd;
use signorini_io::writers::vtu;
use signorini_linear::LinearError;
use signorini_mechanics::solve::{Failure, Flow, RunError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

const CASE: &str = r#"
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
[[step]]
name = "press"
increments = { fixed = 3 }
[[step.fix]]
on = "base"
u = "all"
[[step.move]]
on = "tool"
uz = -0.02
[[step.print]]
on = "base"
nodes = ["displacement", "reaction"]
totals = "yes"
[[step.print]]
on = "brick"
elements = ["stress", "energy"]
[[step.print]]
contact = ["gap", "force"]
[checkpoint]
every = { increments = 1 }
[output]
format = ["vtu", "frd"]
[[expect]]
what = "time"
value = 1.0
tol = { abs = 0.0 }
"#;

fn model_of(text: &str) -> Model {
    let (case, _) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary()).unwrap();
    let (mesh, _) = crate::setup::read_mesh_of(&case, Path::new(".")).unwrap();
    build(case, mesh).unwrap()
}

/// Hears how a run ends, and looks for the files that it hears of.
struct Ears {
    endings: Vec<String>,
    folder: PathBuf,
    opens_files: bool,
}

impl Listener for Ears {
    fn hear(&mut self, news: &News<'_>) -> Flow {
        let is_there = |file: &String| self.folder.join(file).exists();
        match news.event {
            Event::End { status, .. } => self.endings.push(status.clone()),
            Event::Frame { files, .. } if self.opens_files => assert!(files.iter().all(is_there)),
            Event::Checkpoint { file, .. } if self.opens_files => assert!(is_there(file)),
            _ => {}
        }
        Flow::Continue
    }

    fn opens_files(&self) -> bool {
        self.opens_files
    }
}

/// Runs the case into a folder through a disk, and records the news.
fn run_on(
    fs: Arc<dyn Fs>,
    folder: &Path,
    resume: bool,
    opens_files: bool,
) -> (Finished, Vec<String>) {
    let mut model = model_of(CASE);
    model.name = "case".into();
    let source = Source {
        name: "case".into(),
        path: "/nowhere/case.toml".into(),
        text: CASE.into(),
        ..Source::default()
    };
    let mut options = RunOptions::new(source);
    options.folder = folder.to_path_buf();
    options.fs = fs;
    options.resume = resume;
    let mut ears = Ears {
        endings: Vec::new(),
        folder: folder.to_path_buf(),
        opens_files,
    };
    (run(&mut model, &options, &mut ears), ears.endings)
}

/// A folder in memory where there is one: on a disk, every operation waits for it.
fn scratch() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm")
        .or_else(|_| tempfile::tempdir())
        .unwrap()
}

/// The tables and frames that grow.
fn grown(folder: &Path) -> [String; 3] {
    ["history.csv", "case.dat", "case.frd"]
        .map(|name| std::fs::read_to_string(folder.join(name)).unwrap())
}

#[test]
fn a_disk_that_fails_at_any_moment_harms_nothing_that_was_written() {
    let whole = scratch();
    let counting = Arc::new(FailingFs::counting(RealFs));
    let (finished, endings) = run_on(counting.clone(), whole.path(), false, true);
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics);
    assert_eq!(endings, ["solved"]);
    let operations = counting.count();
    assert!(operations > 60, "{operations}");
    for n in 1..=operations {
        // one fault, and now and then one before a listener that waits for files, and a disk that stays full
        let kinds = [(1, false, false), (3, false, true), (5, true, false)];
        for (each, stays, opens_files) in kinds {
            if n % each != 0 {
                continue;
            }
            let folder = scratch();
            let folder = folder.path();
            let disk: Arc<dyn Fs> = if stays {
                Arc::new(FailingFs::from_nth(RealFs, n, ErrorKind::StorageFull))
            } else {
                Arc::new(FailingFs::nth(RealFs, n, ErrorKind::StorageFull))
            };
            let (finished, endings) = run_on(disk, folder, false, opens_files);
            assert_eq!(
                finished.exit_code, 6,
                "operation {n}: {}",
                finished.diagnostics
            );
            assert!(
                endings.len() <= 1 && endings.iter().all(|e| e != "solved"),
                "{n}: {endings:?}"
            );
            assert!(finished.diagnostics.plain().contains("disk full"), "{n}");
            let listed = check_frames(folder, n);
            go_on(folder, n, listed, &grown(whole.path()));
        }
    }
}

/// Every listed frame can be read; returns how many there are.
fn check_frames(folder: &Path, n: u64) -> usize {
    let mut listed = 0;
    for list in ["results.pvd", "contact.pvd"] {
        let path = folder.join(list);
        if !path.exists() {
            continue;
        }
        let list = Pvd::read(&RealFs, &path).unwrap();
        for entry in list.entries() {
            let bytes = std::fs::read(folder.join(&entry.file)).unwrap();
            let frame = vtu::read(&bytes).unwrap_or_else(|e| panic!("operation {n}: {e}"));
            assert_eq!(frame.time(), Some(entry.time));
        }
        listed = list.entries().len();
    }
    listed
}

/// Once there is room again the run goes on and ends like one that never failed.
fn go_on(folder: &Path, n: u64, listed: usize, whole: &[String; 3]) {
    let source = Source {
        text: CASE.into(),
        ..Source::default()
    };
    let checkpoints = Checkpoints::new(&folder.join("checkpoint"), source.hash());
    if checkpoints.latest_good(&RealFs).is_err() {
        assert!(
            listed <= 1,
            "operation {n}: frames, but nothing to go on from"
        );
        return;
    }
    let (finished, _) = run_on(Arc::new(RealFs), folder, true, false);
    assert_eq!(
        finished.exit_code, 0,
        "operation {n}: {}",
        finished.diagnostics
    );
    assert_eq!(grown(folder), *whole, "operation {n}");
    assert_eq!(check_frames(folder, n), 4, "operation {n}");
}

#[test]
fn a_listener_that_wants_no_more_stops_the_run() {
    let folder = scratch();
    let mut model = model_of(CASE);
    let mut options = RunOptions::new(Source::default());
    options.folder = folder.path().join("out");
    let mut stop = |news: &News<'_>| match news.event {
        Event::Increment { inc: 2, .. } => Flow::Stop,
        _ => Flow::Continue,
    };
    let finished = run(&mut model, &options, &mut stop);
    assert_eq!(finished.summary.status, "interrupted");
    assert_eq!(finished.summary.steps[0].increments, 2);
}

#[test]
fn a_state_that_is_judged_again_is_no_further_iteration() {
    let folder = scratch();
    let by = "primary = \"top\"\nenforcement = { augmented = \"uzawa\" }";
    let text = CASE.replace("primary = \"top\"", by);
    let mut model = model_of(&text);
    let mut options = RunOptions::new(Source::default());
    options.folder = folder.path().join("out");
    let (mut taken, mut judged) = (0, 0);
    let mut count = |news: &News<'_>| {
        match news.event {
            Event::Increment { iters, .. } => taken += iters,
            // each increment is judged once before its first iteration
            Event::Iteration { iter, .. } => judged += u64::from(*iter > 1),
            _ => {}
        }
        Flow::Continue
    };
    let finished = run(&mut model, &options, &mut count);
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics);
    let counted: u64 = finished.summary.steps.iter().map(|s| s.iterations).sum();
    assert_eq!(counted, taken);
    assert!(
        judged > taken,
        "{judged} of {taken}: multipliers are renewed"
    );
}

#[test]
fn a_factor_that_finds_no_memory_is_a_limit_and_no_matter_of_convergence() {
    let failure = Failure::Linear {
        source: LinearError::TooLarge {
            nequation: 45_600,
            nentry: 3_669_318,
        },
        dof: None,
    };
    let error = RunError::NotConverged {
        step: "press".into(),
        increment: 1,
        time: 0.0,
        duration: 1.0,
        tried: vec![1.0],
        min: None,
        cause: Box::new(failure),
    };
    let saved = Saved {
        increments: 0,
        folder: "case.out".into(),
    };
    let one = message(&error, &model_of(CASE), &saved);
    assert_eq!((one.code.id, one.code.class.exit_code()), ("S0802", 8));
    let text = Diagnostics::from(one).plain();
    assert!(
        text.contains("at least 30 MB") && text.contains("multigrid"),
        "{text}"
    );
}
