use crate::support::{BRICK, brick_in, change, command, folder_with, read, result, run};
use signorini_io::writers::vtu;
use std::process::Stdio;

#[test]
fn the_folder_holds_what_is_promised() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["run", "case.toml"]).says(0, &["case.out/results.pvd"]);
    for name in [
        "results.pvd",
        "contact.pvd",
        "history.csv",
        "convergence.csv",
        "case.sta",
        "run.log",
        "events.jsonl",
        "summary.json",
        "case.resolved.toml",
        "checkpoint/a.sgc",
        "checkpoint/b.sgc",
        "frames/volume_0000.vtu",
        "frames/contact_0004.vtu",
    ] {
        assert!(result(&folder, name).is_file(), "{name}");
    }
    assert!(!result(&folder, "frames/failed.vtu").exists());
    let resolved = result(&folder, "case.resolved.toml");
    let again = folder.path().join("again.toml");
    std::fs::copy(resolved, &again).unwrap();
    run(folder.path(), &["run", "again.toml"]).says(0, &[]);
    let histories =
        ["case.out", "again.out"].map(|out| read(&folder.path().join(out).join("history.csv")));
    assert_eq!(
        histories[0], histories[1],
        "the resolved case is what was really run"
    );
}

#[test]
fn frames_have_the_documented_fields() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let open = |name: &str| vtu::read(&std::fs::read(result(&folder, name)).unwrap()).unwrap();
    let (first, last) = (
        open("frames/volume_0000.vtu"),
        open("frames/volume_0004.vtu"),
    );
    assert_eq!(
        first.points, last.points,
        "points stay where they were; displacement moves them"
    );
    assert_eq!((first.time(), last.time()), (Some(0.0), Some(1.0)));
    assert_eq!(last.types, [12, 10]);
    assert_eq!(last.point_data[0].name, "displacement");
    for (name, n) in [
        ("displacement", 3),
        ("reaction_force", 3),
        ("stress", 6),
        ("von_mises", 1),
        ("principal_stress", 3),
        ("contact_pressure", 1),
        ("contact_force", 3),
    ] {
        assert_eq!(last.point_field(name).unwrap().ncomponent, n, "{name}");
    }
    assert_eq!(last.cell_field("stress").unwrap().ncomponent, 6);
    assert!(last.cell_field("von_mises").is_some());
    for (fact, value) in [("step", 1.0), ("increment", 4.0)] {
        assert_eq!(last.fact(fact).unwrap().numbers.to_f64(), [value]);
    }
    let contact = open("frames/contact_0004.vtu");
    assert_eq!(contact.types, [1], "bare nodes are vertices");
    for name in [
        "contact_gap",
        "contact_pressure",
        "contact_pressure_max",
        "contact_multiplier",
        "contact_multiplier_traction",
        "contact_status",
        "contact_force",
        "contact_traction",
        "contact_shear",
        "contact_slip",
        "contact_area",
        "displacement",
    ] {
        assert!(contact.point_field(name).is_some(), "{name}");
    }
    assert_eq!(
        contact
            .point_field("contact_status")
            .unwrap()
            .numbers
            .to_f64(),
        [2.0]
    );
    assert!(contact.point_field("contact_gap").unwrap().numbers.to_f64()[0] < 0.0);
}

#[test]
fn supports_and_contact_balance_in_the_frame() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let bytes = std::fs::read(result(&folder, "frames/volume_0004.vtu")).unwrap();
    let frame = vtu::read(&bytes).unwrap();
    let reaction = frame
        .point_field("reaction_force")
        .unwrap()
        .numbers
        .to_f64();
    let up: f64 = reaction.iter().skip(2).step_by(3).sum();
    let table = read(&result(&folder, "history.csv"));
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    let column = rows[0].iter().position(|c| *c == "tip.force_z").unwrap();
    let force: f64 = rows[4][column].parse().unwrap();
    assert!(
        force > 1.0 && (up - force).abs() < 1e-6 * force,
        "{up} {force}"
    );
}

#[test]
fn the_output_is_a_file() {
    let folder = folder_with(BRICK);
    std::fs::write(folder.path().join("case.out"), "mine").unwrap();
    run(folder.path(), &["run", "case.toml"]).says(6, &["S0601", "case.out", "-o DIR"]);
    assert_eq!(read(&folder.path().join("case.out")), "mine");
}

#[cfg(target_os = "linux")]
#[test]
fn the_output_cannot_be_written() {
    let folder = folder_with(BRICK);
    run(
        folder.path(),
        &["run", "case.toml", "-o", "/proc/signorini"],
    )
    .says(6, &["S0601"]);
}

#[test]
fn the_output_of_another_case_is_refused_until_fresh() {
    let folder = folder_with(BRICK);
    std::fs::write(folder.path().join("other.toml"), brick_in(2)).unwrap();
    run(folder.path(), &["run", "other.toml", "-o", "out"]).says(0, &[]);
    let before = read(&folder.path().join("out/history.csv"));
    run(folder.path(), &["run", "case.toml", "-o", "out"])
        .says(3, &["S0602", "other.toml", "--fresh"]);
    assert_eq!(read(&folder.path().join("out/history.csv")), before);
    run(folder.path(), &["run", "case.toml", "-o", "out", "--fresh"]).says(0, &[]);
}

#[test]
fn a_second_run_replaces_what_the_first_one_wrote_and_nothing_else() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["run", "case.toml"]).says(0, &[]);
    std::fs::write(result(&folder, "notes.txt"), "mine").unwrap();
    std::fs::write(folder.path().join("case.toml"), brick_in(2)).unwrap();
    run(folder.path(), &["run", "case.toml"]).says(0, &["2 increments"]);
    assert_eq!(read(&result(&folder, "history.csv")).lines().count(), 3);
    assert!(!result(&folder, "frames/volume_0003.vtu").exists());
    assert_eq!(read(&result(&folder, "notes.txt")), "mine");
}

/// A run that has written its first frame and goes on no further.
#[cfg(unix)]
fn halted() -> (tempfile::TempDir, std::process::Child) {
    // a run may be over before it is halted, on a busy machine
    for _ in 0..100 {
        let folder = folder_with(&brick_in(200));
        let mut run = command(folder.path())
            .args(["run", "case.toml"])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let frame = result(&folder, "frames/volume_0001.vtu");
        while !frame.exists() && run.try_wait().unwrap().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let halt = ["-STOP", &run.id().to_string()];
        std::process::Command::new("kill")
            .args(halt)
            .status()
            .unwrap();
        if run.try_wait().unwrap().is_none() {
            return (folder, run);
        }
    }
    panic!("every run was over too early");
}

#[cfg(unix)]
#[test]
fn two_runs_at_once_do_not_share_a_folder() {
    let (folder, mut first) = halted();
    run(folder.path(), &["run", "case.toml"]).says(6, &["held by another run"]);
    run(folder.path(), &["resume", "case.out"]).says(6, &["held by another run"]);
    first.kill().unwrap();
    first.wait().unwrap();
}

#[test]
fn frames_are_written_as_often_as_asked_and_at_the_end() {
    let text = change(BRICK, "[checkpoint]", "[output]\nevery = 3\n[checkpoint]");
    let folder = folder_with(&text);
    run(folder.path(), &["run", "case.toml"]).says(0, &[]);
    let list = read(&result(&folder, "results.pvd"));
    let times: Vec<&str> = list
        .split("timestep=\"")
        .skip(1)
        .map(|t| &t[..t.find('"').unwrap()])
        .collect();
    assert_eq!(times, ["0.0", "0.75", "1.0"]);
    let text = change(
        BRICK,
        "[checkpoint]",
        "[output]\nevery = { time = 0.5 }\n[checkpoint]",
    );
    let folder = folder_with(&text);
    run(folder.path(), &["run", "case.toml"]).says(0, &[]);
    assert_eq!(
        read(&result(&folder, "results.pvd"))
            .matches("volume_")
            .count(),
        3
    );
}
