//! Whole runs on ranks that are threads, and each kind of meeting.

use super::lock_step::NOTHING;
use super::{LockStep, files};
use crate::load::Source;
use crate::run::{Finished, Limits, RunOptions, Stop, run};
use crate::setup::{Model, build, read_mesh_of};
use signorini_io::case::read_case;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::fs::{Action, FailingFs, Fs, FsError, MemoryFs};
use signorini_io::writers::json::Summary;
use signorini_ranks::on_threads;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// What every rank comes to, and the exit code with which all were ended.
fn on<T: Send>(size: usize, act: impl Fn(&Arc<LockStep>) -> T + Sync) -> (Vec<T>, u8) {
    on_threads(size, |ranks| act(&Arc::new(LockStep::new(ranks))))
}

const CASE: &str = r#"
[mesh]
nodes = [
  [1, 0.0, 0.0], [2, 1.0, 0.0], [3, 1.0, 1.0], [4, 0.0, 1.0],
]
elements = [{ id = 1, type = "quad4", group = "plate", nodes = [1, 2, 3, 4] }]
[model]
space = "plane-stress"
[sets]
base = { nodes = [1, 2] }
head = { nodes = [3, 4] }
[material.soft]
model = "saint-venant-kirchhoff"
E = 1000.0
nu = 0.2
[[body]]
group = "plate"
material = "soft"
[checkpoint]
every = { increments = 2 }
[[step]]
name = "pull"
increments = { fixed = 4 }
fix = [{ on = "base", u = "all" }]
move = [{ on = "head", ux = 0.1, uy = 0.2 }]
"#;

fn model_of(text: &str) -> Model {
    let (case, _) = read_case("case.toml", text.as_bytes(), &[], crate::vocabulary()).unwrap();
    let (mesh, _) = read_mesh_of(&case, Path::new(".")).unwrap();
    let mut model = build(case, mesh).unwrap();
    model.name = "case".into();
    model
}

fn options(text: &str, ranks: &Arc<LockStep>, fs: Arc<dyn Fs>) -> RunOptions {
    let source = Source {
        name: "case".into(),
        path: "/nowhere/case.toml".into(),
        text: text.into(),
        inputs: vec![signorini_io::writers::json::Input {
            path: "case.toml".into(),
            sha256: crate::load::sha256(text.as_bytes()),
        }],
        ..Source::default()
    };
    RunOptions {
        folder: "out".into(),
        ranks: Arc::clone(ranks),
        fs,
        ..RunOptions::new(source)
    }
}

fn run_on(ranks: &Arc<LockStep>, fs: Arc<dyn Fs>) -> Finished {
    run(&mut model_of(CASE), &options(CASE, ranks, fs), &mut ())
}

fn history(fs: &dyn Fs) -> Vec<u8> {
    fs.read(Path::new("out/history.csv")).unwrap()
}

#[test]
fn ranks_write_what_one_process_writes_and_only_the_first_of_them() {
    let alone = MemoryFs::default();
    let finished = run_on(&Arc::default(), Arc::new(alone.clone()));
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics);
    assert!(finished.summary.ranks.is_none());
    for size in [1, 2, 4] {
        let disks: Vec<_> = (0..size).map(|_| MemoryFs::default()).collect();
        let (done, aborted) = on(size, |ranks| {
            run_on(ranks, Arc::new(disks[ranks.rank()].clone()))
        });
        assert!(done.iter().all(|one| one.exit_code == 0) && aborted == 0);
        assert_eq!(history(&disks[0]), history(&alone));
        let folder = Path::new("out");
        assert_eq!(disks[0].list(folder).unwrap(), alone.list(folder).unwrap());
        for other in &disks[1..] {
            assert!(other.list(folder).unwrap_or_default().is_empty());
        }
        let counts = done
            .iter()
            .map(|one| one.summary.ranks.map_or(1, |r| r.count));
        assert!(counts.eq(vec![size as u64; size]));
    }
}

#[test]
fn other_ranks_go_on_from_a_checkpoint() {
    let whole = MemoryFs::default();
    run_on(&Arc::default(), Arc::new(whole.clone()));
    let part = MemoryFs::default();
    let stopped = |ranks: &Arc<LockStep>| {
        let mut options = options(CASE, ranks, Arc::new(part.clone()));
        // a listener of rank 0 alone that has seen enough
        let seen = AtomicUsize::new(0);
        let mut ear = |_: &crate::News<'_>| match seen.fetch_add(1, Ordering::SeqCst) {
            10 if ranks.rank() == 0 => signorini_mechanics::solve::Flow::Stop,
            _ => signorini_mechanics::solve::Flow::Continue,
        };
        options.limits = Limits::default();
        run(&mut model_of(CASE), &options, &mut ear)
    };
    let (done, _) = on(3, stopped);
    for one in &done {
        assert_eq!(one.exit_code, 130, "{}", one.diagnostics);
    }
    assert_ne!(history(&part), history(&whole));
    let (done, _) = on(2, |ranks| {
        let mut options = options(CASE, ranks, Arc::new(part.clone()));
        options.resume = true;
        run(&mut model_of(CASE), &options, &mut ())
    });
    for one in &done {
        assert_eq!(one.exit_code, 0, "{}", one.diagnostics);
    }
    assert_eq!(history(&part), history(&whole));
}

#[test]
fn a_fault_of_the_disk_is_the_same_on_all_ranks() {
    let counting = Arc::new(FailingFs::counting(MemoryFs::default()));
    run_on(&Arc::default(), counting.clone());
    for n in (1..=counting.count()).step_by(7) {
        let disk = || {
            Arc::new(FailingFs::nth(
                MemoryFs::default(),
                n,
                ErrorKind::StorageFull,
            ))
        };
        let alone = run_on(&Arc::default(), disk());
        assert_eq!(alone.exit_code, 6, "operation {n}");
        let (done, aborted) = on(2, |ranks| run_on(ranks, disk()));
        for one in &done {
            let text = one.diagnostics.plain();
            assert_eq!(one.exit_code, 6, "operation {n}: {text}");
            assert!(text.contains("disk full"), "operation {n}: {text}");
        }
        assert_eq!(aborted, 0, "operation {n}");
    }
}

#[test]
fn every_fault_of_a_file_arrives_as_it_is() {
    let path = Path::new("out/history.csv");
    let kinds = [
        ErrorKind::StorageFull,
        ErrorKind::PermissionDenied,
        ErrorKind::NotFound,
        ErrorKind::NotADirectory,
        ErrorKind::TimedOut,
    ];
    let faults = || {
        let of_kind = |kind: ErrorKind| FsError::new(Action::Rename, path, kind.into());
        let path = || path.to_path_buf();
        let others = [
            FsError::Locked { path: path() },
            FsError::Outside {
                action: Action::Read,
                path: path(),
                root: "root".into(),
            },
            FsError::TooShort {
                path: path(),
                have: 3,
                keep: 7,
            },
            FsError::new(
                Action::Write,
                &path(),
                std::io::Error::from_raw_os_error(28),
            ),
        ];
        kinds.into_iter().map(of_kind).chain(others)
    };
    for n in 0..faults().count() {
        let (faults, _) = on(2, |ranks| {
            let fault = faults().nth(n).unwrap();
            let own = (ranks.rank() == 0).then_some(Err(fault));
            files::answered::<()>(ranks, Action::Write, path, own).unwrap_err()
        });
        assert_eq!(faults[0].to_string(), faults[1].to_string());
        assert_eq!(faults[0].help(), faults[1].help());
        let kind = std::mem::discriminant::<FsError>;
        assert_eq!(kind(&faults[0]), kind(&faults[1]));
    }
}

#[test]
fn a_request_to_any_rank_stops_all_of_them() {
    for asked in 0..3 {
        for (exit_code, is_late) in [(143, false), (8, true)] {
            let disk = MemoryFs::default();
            let (done, _) = on(3, |ranks| {
                let mut options = options(CASE, ranks, Arc::new(disk.clone()));
                if ranks.rank() == asked && is_late {
                    options.limits.deadline = Some(Instant::now());
                } else if ranks.rank() == asked {
                    options.limits.signal.store(15, Ordering::SeqCst);
                }
                run(&mut model_of(CASE), &options, &mut ())
            });
            for one in &done {
                assert_eq!(one.exit_code, exit_code, "{}", one.diagnostics);
            }
            let summary = Summary::read(&disk, Path::new("out/summary.json")).unwrap();
            assert_eq!(summary.exit_code, exit_code);
        }
    }
}

#[test]
fn ranks_in_other_states_end_with_exit_code_70_and_are_named() {
    let disk = MemoryFs::default();
    let (done, aborted) = on(3, |ranks| {
        let text = match ranks.rank() {
            2 => CASE.replace("nu = 0.2", "nu = 0.21"),
            _ => CASE.to_owned(),
        };
        let options = options(CASE, ranks, Arc::new(disk.clone()));
        let finished = run(&mut model_of(&text), &options, &mut ());
        if ranks.rank() == 0 {
            ranks.leave();
        }
        finished
    });
    for one in &done {
        assert_eq!(one.exit_code, 70, "{}", one.diagnostics);
        let text = one.diagnostics.plain();
        assert!(
            text.contains("the state of rank 2 is not that of rank 0"),
            "{text}"
        );
    }
    assert_eq!(aborted, 70);
    let summary = Summary::read(&disk, Path::new("out/summary.json")).unwrap();
    assert_eq!(
        (summary.exit_code, summary.status.as_str()),
        (70, "a rank failed")
    );
    // nothing of the state that is in doubt is on the disk
    let rows = history(&disk);
    assert_eq!(rows.iter().filter(|byte| **byte == b'\n').count(), 1);
}

#[test]
fn ranks_that_have_read_other_cases_do_not_begin() {
    let (done, _) = on(2, |ranks| {
        let text = CASE.replace("E = 1000.0", &format!("E = {}.0", 1000 + ranks.rank()));
        let fs = Arc::new(MemoryFs::default());
        run(&mut model_of(&text), &options(&text, ranks, fs), &mut ())
    });
    for one in &done {
        let text = one.diagnostics.plain();
        assert_eq!(one.exit_code, 70, "{text}");
        assert!(text.contains("the case and the mesh of rank 1"), "{text}");
    }
}

fn fault() -> Diagnostics {
    Diagnostic::error(&codes::UNREADABLE, "the mesh is gone").into()
}

#[test]
fn a_fault_that_one_rank_has_in_reading_ends_all_with_its_exit_code() {
    let (done, aborted) = on(4, |ranks| {
        let bad = ranks.rank() == 2;
        let agreed = ranks.agreed(if bad { Err(fault()) } else { Ok(()) });
        let end = ranks.end(agreed.is_err().into());
        assert_eq!(ranks.speaks(), bad || ranks.rank() == 0);
        if ranks.rank() == 0 {
            ranks.leave();
        }
        (agreed.unwrap_err().plain(), end.unwrap_err().exit_code())
    });
    assert_eq!(aborted, 3);
    for (rank, (text, code)) in done.iter().enumerate() {
        assert_eq!(*code, 3, "{text}");
        let says = ["rank 2 has failed", "the mesh is gone"][usize::from(rank == 2)];
        assert!(text.contains(says), "{rank}: {text}");
    }
}

#[test]
fn a_fault_that_all_ranks_have_is_one_of_the_input() {
    let (done, aborted) = on(3, |ranks| {
        assert!(ranks.agreed::<()>(Err(fault())).is_err());
        assert_eq!(ranks.speaks(), ranks.rank() == 0);
        ranks.end(3)
    });
    assert_eq!((done, aborted), (vec![Ok(3); 3], 0));
}

#[test]
fn ranks_at_other_places_of_the_program_part() {
    let (done, _) = on(3, |ranks| match ranks.rank() {
        1 => ranks.any(true).unwrap_err(),
        _ => ranks.most(17).unwrap_err(),
    });
    for parted in done {
        assert_eq!(parted.exit_code(), 70);
        let text = parted.to_string();
        assert!(text.contains("place in the program of rank 1"), "{text}");
    }
}

#[test]
fn meetings_give_what_all_have() {
    let (done, _) = on(3, |ranks| {
        let rank = ranks.rank();
        let any = [ranks.any(rank == 1), ranks.any(false)].map(Result::unwrap);
        let most = ranks.most(10 + rank as u64).unwrap();
        let own = [None, Some(Stop::Time), Some(Stop::Signal(2))][rank];
        let stops = [ranks.stop(own), ranks.stop(None)].map(Result::unwrap);
        (any, most, stops, ranks.end([0, 6, 1][rank]))
    });
    let wanted = ([true, false], 12, [Some(Stop::Signal(2)), None], Ok(6));
    assert_eq!(done, vec![wanted; 3]);
}

#[test]
fn reasons_to_stop_are_numbers_in_messages() {
    for stop in [
        Stop::Signal(2),
        Stop::Signal(15),
        Stop::Time,
        Stop::Listener,
        Stop::Steps,
    ] {
        assert_eq!(Stop::from_number(stop.to_number()), Some(stop));
    }
    assert_eq!(Stop::from_number(NOTHING), None);
}
