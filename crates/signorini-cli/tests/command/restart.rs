use crate::support::{brick_in, change, command, folder_with, read, result, run};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const INCREMENTS: usize = 60;

/// How often a run is started again that was over before anyone saw that it could be killed, as on a busy machine.
const TRIES: usize = 100;

/// The files that a run leaves but for times and logs.
fn results(folder: &TempDir) -> Vec<(String, Vec<u8>)> {
    let mut names: Vec<String> = [
        "history.csv",
        "convergence.csv",
        "case.sta",
        "results.pvd",
        "contact.pvd",
        "case.frd",
    ]
    .map(String::from)
    .into();
    for number in 0..=INCREMENTS {
        names.push(format!("frames/volume_{number:04}.vtu"));
        names.push(format!("frames/contact_{number:04}.vtu"));
    }
    let read = |name: &String| std::fs::read(result(folder, name)).unwrap();
    names
        .iter()
        .map(|name| (name.clone(), read(name)))
        .collect()
}

/// A case whose tip changes its facet and lifts off again, so that contact has a history.
fn case() -> String {
    let text = change(
        &brick_in(INCREMENTS),
        "every = { increments = 1 }",
        "every = { increments = 7 }\n[output]\nformat = [\"vtu\", \"frd\"]",
    );
    change(
        &text,
        "uz = -0.02",
        "uz = { table = [[0, 0], [0.5, -0.2], [0.8, 0.05], [1, -0.1]] }\nux = 0.1",
    )
}

fn start(folder: &TempDir) -> Child {
    command(folder.path())
        .args(["run", "case.toml"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Waits until a frame is there, or the run is over.
fn wait_for(folder: &TempDir, number: usize, run: &mut Child) {
    let frame = result(folder, &format!("frames/volume_{number:04}.vtu"));
    while !frame.exists() && run.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// A run that ended as `end` says after each of these frames, when it was resumed after the one before.
fn ended(case: &str, frames: &[usize], end: &dyn Fn(&mut Child) -> bool) -> TempDir {
    let once = || {
        let folder = folder_with(case);
        for (number, &frame) in frames.iter().enumerate() {
            let mut run = match number {
                0 => start(&folder),
                _ => resumed(&folder),
            };
            wait_for(&folder, frame, &mut run);
            if !end(&mut run) {
                return None;
            }
        }
        Some(folder)
    };
    let mut tries = (0..TRIES).filter_map(|_| once());
    tries.next().expect("every run was over too early")
}

/// Kills a run; returns whether it was still running.
fn kill(run: &mut Child) -> bool {
    run.kill().unwrap();
    !run.wait().unwrap().success()
}

fn assert_same(reference: &[(String, Vec<u8>)], folder: &TempDir, why: &str) {
    for ((name, wanted), (_, got)) in reference.iter().zip(results(folder)) {
        assert!(*wanted == got, "{why}: {name} differs");
    }
}

/// A block that slides over another with friction, its facets cut in every increment.
fn sliding() -> String {
    let mut nodes = String::new();
    for (first, [x, y, z], l) in [(1, [0.0, 0.0, 0.0], 2.0), (28, [0.3, 0.2, 2.0], 1.0)] {
        for k in 0..27 {
            let at = |from: f64, i: i32| from + 0.5 * l * f64::from(i);
            let (x, y, z) = (at(x, k % 3), at(y, k / 3 % 3), at(z, k / 9));
            nodes += &format!("[{}, {x:?}, {y:?}, {z:?}], ", first + k);
        }
    }
    let mut elements = String::new();
    for (first, group) in [(1, "lower"), (28, "upper")] {
        for k in 0..8 {
            let corner = first + k % 2 + 3 * (k / 2 % 2) + 9 * (k / 4);
            let around = [0, 1, 4, 3, 9, 10, 13, 12].map(|n: i32| corner + n);
            elements += &format!(
                "{{ id = {}, type = \"hex8\", group = \"{group}\", nodes = {around:?} }}, ",
                (first / 28) * 8 + k + 1
            );
        }
    }
    let faces =
        |cells: [i32; 4], side: &str| cells.map(|c| format!("[{c}, \"{side}\"]")).join(", ");
    let (foot, top) = (faces([9, 10, 11, 12], "-z"), faces([5, 6, 7, 8], "+z"));
    format!(
        "format = 1\nunits = \"m-MN-MPa\"\n[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n\
         [sets]\nbase = {{ nodes = [1, 2, 3, 4, 5, 6, 7, 8, 9] }}\n\
         head = {{ nodes = [46, 47, 48, 49, 50, 51, 52, 53, 54] }}\n\
         foot = {{ faces = [{foot}] }}\ntop = {{ faces = [{top}] }}\n\
         [material.soft]\nmodel = \"saint-venant-kirchhoff\"\nE = 500.0\nnu = 0.3\n\
         [[body]]\ngroup = \"lower\"\nmaterial = \"soft\"\n\
         [[body]]\ngroup = \"upper\"\nmaterial = \"soft\"\n\
         [[contact]]\nname = \"foot\"\nsecondary = \"foot\"\nprimary = \"top\"\n\
         method = \"gauss-point\"\nrule = {{ cut = true }}\nsliding = \"increment\"\n\
         enforcement = {{ penalty = 1e4, per = \"area\" }}\nfriction = 0.2\n\
         [output]\nformat = [\"vtu\", \"frd\"]\n[checkpoint]\nevery = {{ increments = 7 }}\n\
         [[step]]\nname = \"slide\"\ngeometry = \"nonlinear\"\nincrements = {{ fixed = {INCREMENTS} }}\n\
         [[step.fix]]\non = \"base\"\nu = \"all\"\n\
         [[step.move]]\non = \"head\"\nuz = {{ table = [[0, 0], [0.2, -0.02], [1, -0.02]] }}\n\
         ux = {{ table = [[0, 0], [0.2, 0], [1, 0.7]] }}\nuy = 0.0\n"
    )
}

#[test]
fn a_run_killed_at_any_moment_and_resumed_is_the_same_run_bit_by_bit() {
    is_the_same(&case(), &[vec![2], vec![9], vec![30], vec![45, 52]]);
    is_the_same(&sliding(), &[vec![9], vec![30, 45]]);
    let multigrid = change(
        &sliding(),
        "[output]",
        "[solver]\nlinear = \"multigrid\"\n[output]",
    );
    is_the_same(&multigrid, &[vec![16, 40]]);
}

/// Kills of the long test.
const KILLS: usize = 60;

/// Numbers in [0, 1) from a seed. Source: Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *seed;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// What kills met.
#[derive(Debug, Default)]
struct Kills {
    count: usize,
    /// Before the first checkpoint was there.
    early: usize,
    /// While some file was being written.
    in_file: usize,
    /// While a checkpoint was being written.
    in_checkpoint: usize,
}

impl Kills {
    /// Starts or resumes the run of a folder and kills it some time after a frame is there; returns whether it was still
    /// running.
    fn kill(&mut self, folder: &TempDir, frame: usize, after: Duration) -> bool {
        let mut run = match has_checkpoint(folder) {
            true => resumed(folder),
            false => start(folder),
        };
        wait_for(folder, frame, &mut run);
        std::thread::sleep(after);
        let killed = kill(&mut run);
        if killed {
            let drafts = |name: &str| {
                let list = std::fs::read_dir(result(folder, name));
                let names = list
                    .into_iter()
                    .flatten()
                    .map(|one| one.unwrap().file_name());
                names
                    .filter(|n| n.to_string_lossy().ends_with(".tmp"))
                    .count()
            };
            let of_checkpoint = drafts("checkpoint");
            self.count += 1;
            self.early += usize::from(!has_checkpoint(folder));
            self.in_file += usize::from(drafts("frames") + drafts(".") + of_checkpoint > 0);
            self.in_checkpoint += usize::from(of_checkpoint > 0);
        }
        killed
    }
}

fn has_checkpoint(folder: &TempDir) -> bool {
    ["a", "b"]
        .iter()
        .any(|name| result(folder, &format!("checkpoint/{name}.sgc")).exists())
}

/// The number of the last frame of a run, zero before it has one.
fn frames(folder: &TempDir) -> usize {
    let is_there =
        |number: &usize| result(folder, &format!("frames/volume_{number:04}.vtu")).exists();
    (1..=INCREMENTS).take_while(is_there).count()
}

fn resumed(folder: &TempDir) -> Child {
    command(folder.path())
        .args(["resume", "case.out"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

#[test]
#[ignore = "takes minutes: run by .ci/run"]
fn a_run_killed_at_random_moments_and_resumed_is_the_same_run_bit_by_bit() {
    for (number, case) in [case(), sliding()].iter().enumerate() {
        // a checkpoint after every increment, so that many kills meet one half written
        let case = change(
            case,
            "every = { increments = 7 }",
            "every = { increments = 1 }",
        );
        let whole = folder_with(&case);
        let clock = Instant::now();
        run(whole.path(), &["run", "case.toml", "-q"]).says(0, &[]);
        let increment = clock.elapsed() / INCREMENTS as u32;
        let reference = results(&whole);
        let mut seed = 20_271_127 + number as u64;
        let mut kills = Kills::default();
        let mut whole_runs = 0;
        while kills.count < KILLS / 2 {
            let folder = folder_with(&case);
            let mut moments = Vec::new();
            loop {
                // frames, not seconds, say how far a run is: it may be faster than the one that was timed
                let last = frames(&folder);
                let frame = last + (random(&mut seed) * (INCREMENTS - last) as f64) as usize;
                let after = increment.mul_f64(random(&mut seed));
                whole_runs += usize::from(!kills.kill(&folder, frame, after));
                moments.push((frame, after));
                if random(&mut seed) < 0.6 {
                    break;
                }
            }
            let last = match has_checkpoint(&folder) {
                true => ["resume", "case.out"],
                false => ["run", "case.toml"],
            };
            run(folder.path(), &last).says(0, &[]);
            assert_same(&reference, &folder, &format!("{moments:?}"));
            assert!(whole_runs < KILLS, "runs are over before they are killed");
        }
        println!("{kills:?}, {whole_runs} over before");
        assert!(kills.early < kills.count / 2, "{kills:?}");
    }
}

/// Runs a case whole, and killed at each of these moments.
fn is_the_same(case: &str, all_moments: &[Vec<usize>]) {
    let whole = folder_with(case);
    run(whole.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let reference = results(&whole);
    for moments in all_moments {
        let folder = ended(case, moments, &kill);
        run(folder.path(), &["resume", "case.out"]).says(0, &["✓ solved: 60 increments"]);
        assert_same(&reference, &folder, &format!("{moments:?}"));
    }
}

#[cfg(unix)]
#[test]
fn signals_end_with_130_and_143_and_the_run_can_go_on() {
    let whole = folder_with(&case());
    run(whole.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let reference = results(&whole);
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let folder = ended(&case(), &[10], &|run| {
            let sent = std::process::Command::new("kill")
                .args([signal, &run.id().to_string()])
                .status()
                .unwrap();
            let end = run.wait().unwrap().code();
            assert!(end == Some(code) || end == Some(0), "{end:?}");
            sent.success() && end == Some(code)
        });
        let summary = read(&result(&folder, "summary.json"));
        assert!(summary.contains("\"interrupted\""), "{summary}");
        run(folder.path(), &["resume", "case.out"]).says(0, &[]);
        assert_same(&reference, &folder, signal);
    }
}

#[test]
fn a_time_limit_ends_with_8_and_the_run_can_go_on() {
    let folder = folder_with(&case());
    // it is over whatever else the machine does
    run(
        folder.path(),
        &["run", "case.toml", "--max-wall", "0.000001s"],
    )
    .says(8, &["S0801", "signorini resume case.out"]);
    run(folder.path(), &["resume", "case.out"]).says(0, &["✓ solved"]);
    run(folder.path(), &["resume", "case.out"]).says(0, &["nothing is left to do"]);
}

/// A run stopped after frame 20.
fn stopped() -> TempDir {
    ended(&case(), &[20], &kill)
}

#[test]
fn of_two_checkpoints_a_damaged_one_is_passed_over_and_two_are_refused() {
    let whole = folder_with(&case());
    run(whole.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let reference = results(&whole);
    let flip = |folder: &TempDir, name: &str| {
        let path = result(folder, name);
        let mut bytes = std::fs::read(&path).unwrap();
        let at = bytes.len() / 2;
        bytes[at] ^= 0x10;
        std::fs::write(path, bytes).unwrap();
    };
    for name in ["checkpoint/a.sgc", "checkpoint/b.sgc"] {
        let folder = stopped();
        flip(&folder, name);
        run(folder.path(), &["resume", "case.out"])
            .says(0, &["one of the two checkpoints is of no use"]);
        assert_same(&reference, &folder, name);
    }
    let folder = stopped();
    flip(&folder, "checkpoint/a.sgc");
    std::fs::write(result(&folder, "checkpoint/b.sgc"), b"SGNC").unwrap();
    run(folder.path(), &["resume", "case.out"]).says(7, &["S0701", "--fresh"]);
}

#[test]
fn nothing_to_resume_from_is_told() {
    let folder = folder_with(&case());
    run(folder.path(), &["resume", "case.out"]).says(7, &["holds no results"]);
    run(folder.path(), &["resume", "."]).says(7, &["holds no results"]);
}

#[test]
fn tables_that_were_changed_are_refused() {
    let folder = stopped();
    let path = result(&folder, "history.csv");
    let table = read(&path);
    let short: String = table.lines().take(3).map(|l| format!("{l}\n")).collect();
    std::fs::write(&path, short).unwrap();
    run(folder.path(), &["resume", "case.out"]).says(7, &["history.csv", "rows"]);
}

#[test]
fn a_file_of_frames_that_was_cut_is_refused() {
    let folder = stopped();
    let path = result(&folder, "case.frd");
    let frames = std::fs::read(&path).unwrap();
    std::fs::write(&path, &frames[..1000]).unwrap();
    run(folder.path(), &["resume", "case.out"]).says(7, &["case.frd", "--fresh"]);
}

#[test]
fn a_resumed_run_takes_the_case_as_it_was() {
    let folder = stopped();
    std::fs::write(folder.path().join("case.toml"), "no case any more").unwrap();
    run(folder.path(), &["resume", "case.out"]).says(0, &["60 increments"]);
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[test]
fn memory_that_is_not_to_be_had_ends_with_8_and_a_message() {
    // a grid of nodes that needs more than the process may take: from a little to a lot, until it is enough
    let mut nodes = String::new();
    let mut elements = String::new();
    let n = 40;
    for j in 0..=n {
        for i in 0..=n {
            nodes += &format!("[{}, {i}.0, {j}.0], ", j * (n + 1) + i + 1);
        }
    }
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i + 1;
            let (id, b) = (j * n + i + 1, a + n + 1);
            elements += &format!(
                "{{ id = {id}, type = \"quad4\", group = \"plate\", nodes = [{a}, {}, {}, {b}] }}, ",
                a + 1,
                b + 1
            );
        }
    }
    let case = format!(
        "format = 1\n[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"plane-strain\"\n\
         [sets]\nbase = {{ plane = \"y\", at = 0.0 }}\nhead = {{ plane = \"y\", at = {n}.0 }}\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 1.0\nnu = 0.3\n[[body]]\ngroup = \"plate\"\nmaterial = \"m\"\n\
         [[step]]\nname = \"s\"\n[[step.fix]]\non = \"base\"\nu = \"all\"\n[[step.move]]\non = \"head\"\nuy = 1.0\n"
    );
    let folder = folder_with(&case);
    let mut codes = Vec::new();
    let mut estimates = 0;
    for megabytes in (20..400).step_by(10) {
        let limited = format!(
            "ulimit -v {}; exec \"$0\" run case.toml -q --fresh -j 1",
            megabytes * 1024
        );
        let ended = std::process::Command::new("sh")
            .args(["-c", &limited, env!("CARGO_BIN_EXE_signorini")])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        let code = ended.status.code();
        if code == Some(8) {
            assert!(said.contains("S0802") && said.contains("resume"), "{said}");
            let estimate = said.contains("so that at least") && said.contains("MB are needed");
            // for the stack of a thread the system names no size
            assert!(
                estimate || said.contains("thread could not be started"),
                "{said}"
            );
            estimates += usize::from(estimate);
        }
        codes.push((megabytes, code, said));
        if code == Some(0) {
            break;
        }
    }
    let of = |wanted| {
        codes
            .iter()
            .filter(|(_, code, _)| *code == Some(wanted))
            .count()
    };
    assert!(of(0) == 1 && estimates > 0, "{codes:?}");
    // a limit too small to start at all is reported by the system
    let started = codes.iter().skip_while(|(_, code, _)| *code != Some(8));
    let odd: Vec<_> = started
        .filter(|(_, code, _)| !matches!(code, Some(0 | 8)))
        .collect();
    assert!(odd.is_empty(), "{odd:?}");
}

#[test]
fn the_first_steps_are_solved_and_the_rest_is_resumed() {
    let second = "\n[[step]]\nname = \"lift\"\nincrements = { fixed = 3 }\n[[step.move]]\non = \"tool\"\nuz = 0.01\n[checkpoint]";
    let folder = folder_with(&change(&brick_in(4), "[checkpoint]", second));
    let wrong = run(folder.path(), &["run", "case.toml", "--steps", "lift"]);
    wrong.says(2, &["not the first steps", "press, lift"]);
    assert!(!folder.path().join("case.out").exists());
    let first = run(folder.path(), &["run", "case.toml", "--steps", "press"]);
    first.says(0, &["first steps solved: 4 increments", "signorini resume"]);
    run(folder.path(), &["status", "case.out"])
        .says(0, &["first steps solved", "signorini resume"]);
    let rest = run(folder.path(), &["run", "case.toml", "--resume"]);
    rest.says(0, &["solved: 7 increments"]);
    assert!(!rest.err.contains(" press "), "{}", rest.err);
    let all = run(
        folder.path(),
        &["run", "case.toml", "--steps", "press,lift"],
    );
    all.says(0, &["✓ solved: 7 increments"]);
}

#[test]
fn a_run_that_is_to_be_resumed_starts_where_there_is_nothing_to_go_on_from() {
    let folder = folder_with(&brick_in(4));
    let resumed = || run(folder.path(), &["run", "case.toml", "--resume"]);
    resumed().says(
        0,
        &["no checkpoint of this case in", "✓ solved: 4 increments"],
    );
    resumed().says(0, &["nothing is left to do"]);
    let case = folder.path().join("case.toml");
    std::fs::write(&case, brick_in(5)).unwrap();
    resumed().says(7, &["the case has changed since", "--fresh"]);
    run(folder.path(), &["run", "case.toml", "--resume", "--fresh"]).says(2, &[]);
}
