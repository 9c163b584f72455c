//! Results for other viewers, and the comparison of results.

use crate::support::{BRICK, change, folder_with, read, result, run};
use signorini_io::readers::frd;
use signorini_io::writers::vtu;
use tempfile::TempDir;

const BOTH: &str = "vtu,frd";

fn solved(arguments: &[&str]) -> TempDir {
    let folder = folder_with(BRICK);
    run(
        folder.path(),
        &[&["run", "case.toml", "-q"], arguments].concat(),
    )
    .says(0, &[]);
    folder
}

#[test]
fn the_file_of_all_frames_holds_what_the_frames_hold() {
    let folder = solved(&["--format", BOTH]);
    let frd = frd::parse(&std::fs::read(result(&folder, "case.frd")).unwrap()).unwrap();
    assert_eq!(frd.title, "a brick");
    let moved: Vec<_> = frd.datasets.iter().filter(|d| d.name == "DISP").collect();
    assert_eq!(moved.len(), 4, "the undeformed state has no frame");
    for (number, disp) in (1..).zip(moved) {
        let bytes =
            std::fs::read(result(&folder, &format!("frames/volume_{number:04}.vtu"))).unwrap();
        let frame = vtu::read(&bytes).unwrap();
        assert_eq!(
            (disp.step, disp.increment, Some(disp.time)),
            (1, number, frame.time())
        );
        for (name, field, order) in [
            ("DISP", "displacement", &[0, 1, 2][..]),
            ("FORC", "reaction_force", &[0, 1, 2]),
            ("STRESS", "stress", &[0, 1, 2, 3, 4, 5]),
        ] {
            let one = frd
                .datasets
                .iter()
                .find(|d| d.name == name && d.increment == number)
                .unwrap();
            let wanted = frame.point_field(field).unwrap().numbers.to_f64();
            // forces of the file are internal ones: at supports they are reactions, up to the tolerance of equilibrium
            let largest = wanted.iter().fold(0.0f64, |most, n| most.max(n.abs()));
            let left = if name == "FORC" {
                1e-5 * largest
            } else {
                1e-99
            };
            let rows = wanted.chunks(order.len()).enumerate();
            let held = |row: &[f64]| name != "FORC" || row.iter().any(|n| *n != 0.0);
            for (k, row) in rows.filter(|(_, row)| held(row)) {
                for (&i, found) in order.iter().zip(one.row(k)) {
                    assert!(
                        (found - row[i]).abs() <= 5.01e-6 * row[i].abs() + left,
                        "{name}"
                    );
                }
            }
        }
    }
    let contact = frd.last("CONTACT").unwrap();
    assert_eq!(contact.nodes, [11]);
    assert!(contact.row(0)[0] < 0.0 && contact.row(0)[3] > 0.0);
    run(folder.path(), &["info", "case.out/case.frd"])
        .says(0, &["1 hex8", "STRESS (12 nodes", "step 1, increment 4"]);
}

#[test]
fn formats_are_those_asked_for_and_an_old_file_does_not_stay() {
    let folder = solved(&["--format", "frd"]);
    assert!(result(&folder, "case.frd").exists());
    assert!(
        !result(&folder, "results.pvd").exists()
            && !result(&folder, "frames/volume_0001.vtu").exists()
    );
    run(folder.path(), &["info", "case.out"]).says(0, &["solved"]);
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    assert!(!result(&folder, "case.frd").exists());
    assert!(result(&folder, "frames/volume_0004.vtu").exists());
    let text = format!("{BRICK}\n[output]\nformat = [\"vtu\", \"frd\"]\n");
    let folder = folder_with(&text);
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    assert!(result(&folder, "case.frd").exists() && result(&folder, "results.pvd").exists());
    run(folder.path(), &["run", "case.toml", "--format", "xdmf"]).says(2, &["xdmf"]);
}

#[test]
fn results_agree_with_themselves_and_differ_from_those_of_another_load() {
    let folder = folder_with(BRICK);
    std::fs::write(
        folder.path().join("more.toml"),
        change(BRICK, "uz = -0.02", "uz = -0.0202"),
    )
    .unwrap();
    for case in ["case.toml", "more.toml"] {
        run(folder.path(), &["run", case, "-q", "--format", BOTH]).says(0, &[]);
    }
    let diff = |arguments: &[&str]| run(folder.path(), &[&["diff"], arguments].concat());
    diff(&["case.out", "case.out", "--rel", "0"])
        .says(0, &["history.csv", "case.frd", "the same within 0"]);
    for name in [
        "case.out/history.csv",
        "case.out/case.frd",
        "case.out/frames/volume_0004.vtu",
    ] {
        diff(&[name, name, "-q"]).says(0, &["the same within 0.001"]);
    }
    let ended = diff(&["more.out", "case.out"]);
    ended.says(1, &["different: ", "STRESS, time 1: ", "at 11 "]);
    // frames with another amplitude differ by a part of it
    diff(&["more.out", "case.out", "--rel", "0.1"]).says(0, &["the same within 0.1"]);
    // the names of the runs differ, and that is all
    assert!(
        ended.out.lines().any(|line| line == "more.frd"),
        "{}",
        ended.out
    );
}

#[test]
fn what_only_one_file_has_is_named_and_counts_unless_told_otherwise() {
    let folder = solved(&["--format", BOTH]);
    let path = result(&folder, "case.frd");
    let text = read(&path);
    let less = text.replace("FORC ", "FORCE");
    std::fs::write(folder.path().join("less.frd"), less).unwrap();
    let diff = |arguments: &[&str]| {
        run(
            folder.path(),
            &[&["diff", "less.frd", "case.out/case.frd"], arguments].concat(),
        )
    };
    diff(&[]).says(
        1,
        &[
            "FORC, time 1: only in the reference",
            "FORCE, time 1: not in the reference",
            "8 only in one of both",
        ],
    );
    diff(&["--common"]).says(0, &["only in the reference", "the same"]);
}

#[test]
fn comparisons_are_told_to_machines() {
    let folder = solved(&[]);
    let ended = run(folder.path(), &["diff", "case.out", "case.out", "--json"]);
    ended.says(0, &[]);
    let lines: Vec<serde_json::Value> = ended
        .out
        .lines()
        .map(|l| serde_json::from_str(l).unwrap())
        .collect();
    let (end, blocks) = lines.split_last().unwrap();
    assert_eq!(
        (&end["ev"], &end["status"], &end["exit_code"]),
        (&"end".into(), &"same".into(), &0.into())
    );
    assert_eq!(end["blocks"], blocks.len());
    assert!(
        blocks
            .iter()
            .all(|b| b["ev"] == "block" && b["same"] == true && b["v"] == 1)
    );
    let moved = blocks
        .iter()
        .find(|b| b["name"] == "displacement at nodes" && b["file"] == "frames/volume_0004.vtu")
        .unwrap();
    assert_eq!(
        (&moved["numbers"]["ratio"], &moved["numbers"]["rows"]),
        (&0.0.into(), &12.into())
    );
}

#[test]
fn what_cannot_be_compared_ends_with_2() {
    let folder = solved(&[]);
    std::fs::write(folder.path().join("a.dat"), "1 2 3").unwrap();
    std::fs::write(folder.path().join("empty.dat"), "").unwrap();
    for (arguments, word) in [
        (&["nowhere.frd", "nowhere.frd"][..], "nowhere.frd"),
        (&["case.toml", "case.toml"], "only .dat, .frd, .csv, .vtu"),
        (&["case.out", "case.toml"], "one is a folder"),
        (&["a.dat", "a.dat"], "line 1: numbers without a header"),
        (&["empty.dat", "empty.dat"], "nothing"),
        (&["case.out", "case.out", "--rel=-1"], "not negative"),
        (&["case.out"], "REFERENCE"),
    ] {
        run(folder.path(), &[&["diff"], arguments].concat()).says(2, &[word]);
    }
    let ended = run(folder.path(), &["diff", "a.dat", "a.dat", "--json"]);
    ended.says(2, &["\"status\":\"not compared\""]);
}
