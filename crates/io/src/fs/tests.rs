use std::io::ErrorKind;
use std::sync::Arc;

use super::*;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

#[test]
fn write_atomic_leaves_the_old_or_the_new_content_whichever_step_fails() {
    let old = vec![1u8; 1000];
    let new = vec![2u8; 3000];
    let mut kept_old = 0;
    for kind in [
        ErrorKind::StorageFull,
        ErrorKind::PermissionDenied,
        ErrorKind::Other,
    ] {
        for n in 1..=3 {
            let dir = folder();
            let path = dir.path().join("frame.vtu");
            RealFs.write_atomic(&path, &old).unwrap();
            let fs = FailingFs::nth(RealFs, n, kind);
            let error = fs.write_atomic(&path, &new).unwrap_err();
            assert_eq!(
                error.path(),
                path,
                "the user's file is named, not its draft"
            );
            let content = RealFs.read(&path).unwrap();
            assert!(
                content == old || content == new,
                "step {n} left a torn file"
            );
            kept_old += usize::from(content == old);
            assert_eq!(
                RealFs.list(dir.path()).unwrap(),
                [path],
                "no draft is left behind"
            );
        }
    }
    assert_eq!(
        kept_old, 6,
        "writing and renaming come before the new content is visible"
    );
}

#[test]
fn write_atomic_survives_a_power_cut_at_every_length() {
    for keep in 0..=64 {
        let dir = folder();
        let path = dir.path().join("results.pvd");
        RealFs.write_atomic(&path, &[1; 64]).unwrap();
        TornFs::nth(RealFs, 1, keep)
            .write_atomic(&path, &[2; 64])
            .unwrap_err();
        assert_eq!(RealFs.read(&path).unwrap(), [1; 64]);
        // The torn draft of the dead run is in nobody's way.
        RealFs.write_atomic(&path, &[3; 10]).unwrap();
        assert_eq!(RealFs.read(&path).unwrap(), [3; 10]);
    }
}

#[test]
fn a_lying_disk_leaves_a_torn_file_under_its_final_name() {
    let dir = folder();
    let path = dir.path().join("a.sgc");
    TornFs::lying(RealFs, 1, 5, 1)
        .write_atomic(&path, &[7; 20])
        .unwrap_err();
    assert_eq!(RealFs.read(&path).unwrap(), [7; 5]);
}

#[test]
fn a_full_disk_is_reported_with_its_size_and_what_to_do() {
    let dir = folder();
    let path = dir.path().join("volume_0031.vtu");
    let error = FailingFs::nth(RealFs, 1, ErrorKind::StorageFull)
        .write_atomic(&path, &vec![0; 1_200_000])
        .unwrap_err();
    let text = error.to_string();
    assert!(
        text.starts_with("disk full while writing ")
            && text.ends_with("volume_0031.vtu (needs 1.2 MB)"),
        "{text}"
    );
    assert!(error.help().contains("free space"), "{}", error.help());
    assert_eq!(FsError::EXIT_CODE, 6);
}

#[test]
fn faults_of_the_real_disk_are_distinguished() {
    let dir = folder();
    let file = dir.path().join("file");
    RealFs.write_atomic(&file, b"x").unwrap();
    assert!(matches!(
        RealFs.read(&dir.path().join("none")),
        Err(FsError::NotFound { .. })
    ));
    assert!(matches!(
        RealFs.read(dir.path()),
        Err(FsError::WrongKind { .. })
    ));
    assert!(matches!(
        RealFs.write_atomic(&file.join("below"), b""),
        Err(FsError::WrongKind { .. })
    ));
    assert!(matches!(
        RealFs.create_dir_all(&file),
        Err(FsError::WrongKind { .. })
    ));
    assert!(matches!(
        RealFs.write_atomic(&dir.path().join("gone/f"), b""),
        Err(FsError::NotFound { .. })
    ));
    assert!(!RealFs.exists(&dir.path().join("none")).unwrap());
    assert!(RealFs.exists(&file).unwrap());
}

#[test]
fn folders_are_created_with_their_parents_and_again_without_harm() {
    let dir = folder();
    let deep = dir.path().join("a b/ü/c");
    RealFs.create_dir_all(&deep).unwrap();
    RealFs.create_dir_all(&deep).unwrap();
    RealFs.write_atomic(&deep.join("f"), b"x").unwrap();
    assert_eq!(RealFs.list(&deep).unwrap(), [deep.join("f")]);
    RealFs.remove(&deep.join("f")).unwrap();
    assert!(RealFs.list(&deep).unwrap().is_empty());
}

#[test]
fn a_log_grows_by_rows_and_is_cut_back_when_opened_again() {
    let dir = folder();
    let path = dir.path().join("history.csv");
    let mut log = RealFs.open_log(&path, 0).unwrap();
    log.append(b"one\n").unwrap();
    log.append(b"two\n").unwrap();
    assert_eq!(
        RealFs.read(&path).unwrap(),
        b"one\ntwo\n",
        "a row is on the disk as soon as it is appended"
    );
    log.sync().unwrap();
    drop(log);
    let mut log = RealFs.open_log(&path, 4).unwrap();
    log.append(b"2\n").unwrap();
    assert_eq!(RealFs.read(&path).unwrap(), b"one\n2\n");
    assert!(matches!(
        RealFs.open_log(&path, 7),
        Err(FsError::TooShort {
            have: 6,
            keep: 7,
            ..
        })
    ));
    assert_eq!(
        RealFs.read(&path).unwrap(),
        b"one\n2\n",
        "a failed opening changes nothing"
    );
}

#[test]
fn a_lock_is_held_once_and_let_go_when_dropped() {
    let dir = folder();
    let path = dir.path().join(".lock");
    let held = RealFs.lock(&path).unwrap();
    let error = RealFs.lock(&path).unwrap_err();
    assert!(matches!(error, FsError::Locked { .. }), "{error}");
    drop(held);
    RealFs.lock(&path).unwrap();
}

#[test]
fn whether_a_lock_is_held_is_seen_without_taking_it() {
    let dir = folder();
    let path = dir.path().join(".lock");
    assert!(!RealFs.is_locked(&path).unwrap());
    assert!(!path.exists());
    let held = RealFs.lock(&path).unwrap();
    assert!(RealFs.is_locked(&path).unwrap());
    drop(held);
    assert!(!RealFs.is_locked(&path).unwrap());
    RealFs.lock(&path).unwrap();
}

#[test]
fn the_failing_disk_fails_at_exactly_the_given_operation() {
    let dir = folder();
    let write = |fs: &dyn Fs, n: usize| {
        (0..n)
            .map(|i| fs.write(&dir.path().join("f"), &[i as u8]).is_ok())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        write(&FailingFs::nth(RealFs, 2, ErrorKind::Other), 4),
        [true, false, true, true]
    );
    assert_eq!(
        write(&FailingFs::from_nth(RealFs, 3, ErrorKind::Other), 4),
        [true, true, false, false]
    );
    assert_eq!(
        write(&TornFs::nth(RealFs, 2, 0), 4),
        [true, false, false, false]
    );
    assert_eq!(
        write(&TornFs::lying(RealFs, 2, 0, 1), 4),
        [true, true, true, false]
    );
    let counting = FailingFs::counting(RealFs);
    assert_eq!(write(&counting, 4), [true; 4]);
    assert_eq!(counting.count(), 4);
    let mut log = counting.open_log(&dir.path().join("log"), 0).unwrap();
    log.append(b"x").unwrap();
    log.sync().unwrap();
    assert_eq!(counting.count(), 7);
}

#[test]
fn files_written_behind_are_those_that_were_asked_for_in_their_order() {
    let dir = folder();
    let path = |n: usize| dir.path().join(format!("{n}.vtu"));
    let fs = BehindFs::new(Arc::new(RealFs));
    let mut log = fs.open_log(&dir.path().join("rows.csv"), 0).unwrap();
    for n in 0..100 {
        fs.write_atomic(&path(n), &[n as u8; 1000]).unwrap();
        assert!(fs.exists(&path(n)).unwrap(), "{n} is on its way");
        log.append(format!("{n}\n").as_bytes()).unwrap();
    }
    assert!(!fs.exists(&path(100)).unwrap());
    assert_eq!(fs.read(&path(99)).unwrap(), [99; 1000], "a reader waits");
    fs.settle().unwrap();
    let rows: String = (0..100).map(|n| format!("{n}\n")).collect();
    let have = RealFs.read(&dir.path().join("rows.csv")).unwrap();
    assert_eq!(have, rows.as_bytes());
    log.cut(2).unwrap();
    log.append(b"again\n").unwrap();
    fs.write_atomic(&path(0), b"last").unwrap();
    drop((fs, log));
    assert_eq!(
        RealFs.read(&path(0)).unwrap(),
        b"last",
        "the last is waited for"
    );
    let have = RealFs.read(&dir.path().join("rows.csv")).unwrap();
    assert_eq!(have, b"0\nagain\n");
}

#[test]
fn nothing_that_was_asked_for_after_a_fault_reaches_the_disk_before_the_fault_is_reported() {
    // three operations make a file
    for n in 1..=12 {
        let dir = folder();
        let path = |n: usize| dir.path().join(format!("{n}.vtu"));
        let inner = FailingFs::nth(RealFs, n, ErrorKind::StorageFull);
        let fs = BehindFs::new(Arc::new(inner));
        let faults = (0..4).filter_map(|k| fs.write_atomic(&path(k), b"frame").err());
        let mut faults: Vec<FsError> = faults.collect();
        let was_told = !faults.is_empty();
        faults.extend(fs.settle().err());
        let [fault] = &faults[..] else {
            panic!("operation {n}: told {} times", faults.len());
        };
        let failed = (n as usize - 1) / 3;
        assert_eq!(fault.path(), path(failed));
        let whole = |k: &usize| RealFs.exists(&path(*k)).unwrap();
        assert_eq!((0..failed).filter(whole).count(), failed, "operation {n}");
        if !was_told {
            assert_eq!((failed + 1..4).find(whole), None, "operation {n}");
        }
        // a fault is reported once
        fs.write_atomic(&path(9), b"frame").unwrap();
        fs.settle().unwrap();
        assert!(whole(&9));
    }
}

#[test]
fn what_does_not_exist_because_of_a_fault_reports_the_fault() {
    let dir = folder();
    let path = dir.path().join("frame.vtu");
    let fs = BehindFs::new(Arc::new(FailingFs::nth(RealFs, 1, ErrorKind::StorageFull)));
    fs.write_atomic(&path, b"frame").unwrap();
    let fault = loop {
        // as long as it is on its way, it is said to exist
        match fs.exists(&path) {
            Ok(exists) => assert!(exists),
            Err(fault) => break fault,
        }
    };
    assert_eq!(fault.path(), path);
    assert!(!fs.exists(&path).unwrap());
}

/// Panics where it is to write a file.
struct Panicking;

impl Fs for Panicking {
    fn read(&self, path: &Path) -> Result<Vec<u8>, FsError> {
        RealFs.read(path)
    }

    fn exists(&self, path: &Path) -> Result<bool, FsError> {
        RealFs.exists(path)
    }

    fn list(&self, folder: &Path) -> Result<Vec<PathBuf>, FsError> {
        RealFs.list(folder)
    }

    fn create_dir_all(&self, folder: &Path) -> Result<(), FsError> {
        RealFs.create_dir_all(folder)
    }

    fn write(&self, _: &Path, _: &[u8]) -> Result<(), FsError> {
        panic!("a fault of the program");
    }

    fn rename(&self, from: &Path, to: &Path) -> Result<(), FsError> {
        RealFs.rename(from, to)
    }

    fn sync_dir(&self, folder: &Path) -> Result<(), FsError> {
        RealFs.sync_dir(folder)
    }

    fn remove(&self, path: &Path) -> Result<(), FsError> {
        RealFs.remove(path)
    }

    fn open_log(&self, path: &Path, keep: u64) -> Result<Box<dyn Log>, FsError> {
        RealFs.open_log(path, keep)
    }

    fn lock(&self, path: &Path) -> Result<Lock, FsError> {
        RealFs.lock(path)
    }

    fn is_locked(&self, path: &Path) -> Result<bool, FsError> {
        RealFs.is_locked(path)
    }

    fn modified(&self, path: &Path) -> Result<Option<SystemTime>, FsError> {
        RealFs.modified(path)
    }

    fn write_atomic(&self, path: &Path, bytes: &[u8]) -> Result<(), FsError> {
        replace(self, path, bytes)
    }

    fn settle(&self) -> Result<(), FsError> {
        Ok(())
    }
}

#[test]
fn a_panic_behind_comes_to_who_asked_and_nobody_waits_for_ever() {
    let dir = folder();
    let path = dir.path().join("frame.vtu");
    let fs = BehindFs::new(Arc::new(Panicking));
    let mut log = fs.open_log(&dir.path().join("rows.csv"), 0).unwrap();
    fs.write_atomic(&path, b"frame").unwrap();
    let settled = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| fs.settle()));
    assert!(settled.is_err());
    // a log may outlive what opened it
    drop(fs);
    log.append(b"row\n").unwrap();
    log.cut(0).unwrap();
    log.append(b"last\n").unwrap();
    drop(log);
    let have = RealFs.read(&dir.path().join("rows.csv")).unwrap();
    assert_eq!(have, b"last\n");
}

#[test]
fn files_in_memory_behave_as_those_on_the_disk() {
    let dir = folder();
    let memory = MemoryFs::default();
    let disks: [&dyn Fs; 2] = [&RealFs, &memory];
    for fs in disks {
        let at = |name: &str| dir.path().join(name);
        fs.create_dir_all(&at("frames")).unwrap();
        fs.write_atomic(&at("frames/a.vtu"), b"old").unwrap();
        fs.write_atomic(&at("frames/a.vtu"), b"new").unwrap();
        fs.write(&at("list"), b"1").unwrap();
        assert_eq!(fs.read(&at("frames/a.vtu")).unwrap(), b"new");
        assert_eq!(fs.list(dir.path()).unwrap(), [at("frames"), at("list")]);
        let mut log = fs.open_log(&at("rows"), 0).unwrap();
        log.append(b"one\n").unwrap();
        log.append_owned(b"two\n".to_vec()).unwrap();
        log.cut(4).unwrap();
        let short = log.cut(5).unwrap_err();
        assert!(matches!(
            short,
            FsError::TooShort {
                have: 4,
                keep: 5,
                ..
            }
        ));
        drop(log);
        drop(fs.open_log(&at("rows"), 4).unwrap());
        assert_eq!(fs.read(&at("rows")).unwrap(), b"one\n");
        let lock = fs.lock(&at("lock")).unwrap();
        assert!(fs.is_locked(&at("lock")).unwrap());
        let locked = fs.lock(&at("lock")).unwrap_err();
        assert!(matches!(locked, FsError::Locked { .. }));
        drop(lock);
        assert!(!fs.is_locked(&at("lock")).unwrap());
        let written = fs.modified(&at("rows")).unwrap();
        assert!(written.is_none_or(|at| at <= SystemTime::now()));
        assert!(fs.modified(&at("missing")).is_err());
        fs.rename(&at("rows"), &at("moved")).unwrap();
        assert!(!fs.exists(&at("rows")).unwrap());
        fs.remove(&at("moved")).unwrap();
        for fault in [
            fs.remove(&at("moved")),
            fs.rename(&at("moved"), &at("rows")),
        ] {
            assert!(matches!(fault, Err(FsError::NotFound { .. })));
        }
        assert!(matches!(
            fs.read(&at("moved")),
            Err(FsError::NotFound { .. })
        ));
        fs.settle().unwrap();
    }
}
