//! Decks on the command line.

use super::support::{read, run};
use std::path::Path;
use tempfile::TempDir;

/// A folder with the decks of the tests.
fn decks() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for name in ["block.inp", "pair.inp", "pair_nodes.inc"] {
        std::fs::copy(data.join(name), folder.path().join(name)).unwrap();
    }
    folder
}

#[test]
fn a_deck_is_run_checked_and_printed() {
    let folder = decks();
    run(folder.path(), &["check", "pair.inp"]).says(0, &["nothing wrong was found"]);
    run(folder.path(), &["run", "pair.inp"]).says(0, &["solved"]);
    let printed = read(&folder.path().join("pair.out/pair.dat"));
    assert!(
        printed.contains(" total force (fx,fy,fz) for set HEAD and time"),
        "{printed}"
    );
    let resolved = read(&folder.path().join("pair.out/case.resolved.toml"));
    assert!(resolved.contains("method = \"mortar\""), "{resolved}");
    run(
        folder.path(),
        &["run", "pair.inp", "--compat", "ccx", "--fresh"],
    )
    .says(0, &["solved"]);
    let resolved = read(&folder.path().join("pair.out/case.resolved.toml"));
    assert!(
        resolved.contains("method = \"gauss-point\"") && resolved.contains("penalty = 1000000")
    );
}

#[test]
fn a_deck_can_be_changed_and_converted() {
    let folder = decks();
    run(folder.path(), &["convert", "block.inp", "block.toml"]).says(0, &["→ block.toml"]);
    run(folder.path(), &["run", "block.toml", "-o", "toml.out"]).says(0, &["solved"]);
    run(folder.path(), &["run", "block.inp", "-o", "inp.out"]).says(0, &["solved"]);
    run(
        folder.path(),
        &[
            "diff",
            "toml.out/block.dat",
            "inp.out/block.dat",
            "--rel",
            "1e-12",
        ],
    )
    .says(0, &["the same"]);
    run(
        folder.path(),
        &[
            "run",
            "block.inp",
            "--set",
            "material.SOFT.nu=0.3",
            "-o",
            "other.out",
        ],
    )
    .says(0, &["solved"]);
    run(folder.path(), &["convert", "block.toml", "block.inp"]).says(2, &["takes a deck"]);
}

#[test]
fn a_stand_in_leaves_the_files_that_programs_look_for() {
    let folder = decks();
    run(folder.path(), &["ccx-compat", "-v"]).says(0, &["This is Signorini"]);
    run(folder.path(), &["ccx-compat", "-i", "pair"]).says(0, &["solved"]);
    for (name, word) in [
        ("pair.dat", "total force"),
        ("pair.frd", "DISP"),
        ("pair.sta", "STEP"),
    ] {
        assert!(read(&folder.path().join(name)).contains(word), "{name}");
    }
    let text = read(&folder.path().join("pair.inp")).replace("*Static", "*Statik");
    std::fs::write(folder.path().join("pair.inp"), text).unwrap();
    run(folder.path(), &["ccx-compat", "-i", "pair"]).says(201, &["pair.inp:"]);
    assert!(!folder.path().join("pair.dat").exists());
}

#[test]
fn keywords_are_listed_and_faults_shown_where_they_are() {
    let folder = decks();
    run(folder.path(), &["keywords"])
        .says(0, &["*CONTACT PAIR", "refused, with their line:", "*MPC"]);
    let text = read(&folder.path().join("block.inp")).replace("6, 3, 100.", "66, 3, 100.");
    std::fs::write(folder.path().join("bad.inp"), text).unwrap();
    run(folder.path(), &["run", "bad.inp"])
        .says(3, &["there is no node 66", "bad.inp:31:1", "66, 3, 100."]);
}
