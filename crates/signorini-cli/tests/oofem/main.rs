//! Decks of OOFEM, run as they are.

#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "../../../signorini/tests/common/mod.rs"]
mod common;
mod damaged;
#[path = "../../../signorini/tests/common/mutants.rs"]
mod mutants;

use common::{Run, example, relative, repository, run};
use signorini::{Loaded, Reading, RunOptions, build, load};
use signorini_mechanics::system::Frame;
use std::path::{Path, PathBuf};
use std::process::Command;

fn own(name: &str) -> PathBuf {
    repository()
        .join("crates/signorini-cli/tests/oofem")
        .join(name)
}

/// All decks of a folder, in order.
fn decks_in(folder: &Path) -> Vec<PathBuf> {
    let mut decks: Vec<PathBuf> = (std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "in"))
        .collect();
    decks.sort();
    decks
}

fn read(path: &Path) -> Loaded {
    load(path, &Reading::default()).unwrap_or_else(|found| panic!("{}", found.plain()))
}

fn solved(loaded: Loaded) -> Run {
    let mut model = build(loaded.case, loaded.mesh).unwrap_or_else(|e| panic!("{}", e.plain()));
    let done = run(&mut model);
    assert!(done.error.is_none(), "{:?}", done.error);
    done
}

fn displacements(frame: &Frame) -> Vec<f64> {
    let u = frame.displacement.iter();
    u.flat_map(|u| u.to_array()).collect()
}

/// The three examples of the paper: the deck does in every step what the case does in every increment.
#[test]
fn the_papers_examples_have_the_results_of_our_cases() {
    for (deck, case) in [
        ("wedge.in", "paper_wedge_3d"),
        ("brick_symmetric.in", "paper_brick_symmetric_3d"),
        ("brick_arbitrary.in", "paper_brick_arbitrary_3d"),
    ] {
        let of_deck = solved(read(&own(deck)));
        let of_case = run(&mut example(case, &[]));
        assert_eq!(
            (of_deck.frames.len(), of_case.frames.len()),
            (60, 60),
            "{deck}"
        );
        let mut worst = [0.0f64; 2];
        for (a, b) in of_deck.frames.iter().zip(&of_case.frames) {
            let force = |frame: &Frame| frame.contacts[0].secondary.force.to_array();
            worst[0] = worst[0].max(relative(&displacements(a), &displacements(b)));
            worst[1] = worst[1].max(relative(&force(a), &force(b)));
        }
        println!("{deck}: {worst:.1?}");
        assert!(
            worst.iter().all(|worst| *worst < 1e-10),
            "{deck}: {worst:?}"
        );
    }
}

/// A cube of the deck `contact3d_generalized_edge_direct` under two forces on nodes 5 and 8 alone, the edge opposite to the
/// one that is touched: the displacements of node 8 are those of its check block, in all digits.
#[test]
fn the_block_of_the_edge_deck_is_of_forces_on_the_opposite_edge() {
    let case = r#"
        title = "forces on an edge of a cube"
        [mesh]
        nodes = [
          [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
          [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
        ]
        elements = [{ id = 1, type = "hex8", group = "cube", nodes = [1, 2, 3, 4, 5, 6, 7, 8] }]
        [sets]
        base = { nodes = [1, 2, 3, 4] }
        edge = { nodes = [5, 8] }
        [material.rubber]
        model = "mooney-rivlin-logarithmic"
        c10 = 1e4
        c01 = 0
        bulk = 1e6
        [[body]]
        group = "cube"
        material = "rubber"
        locking = "none"
        [[step]]
        name = "pull"
        increments = 4
        [[step.fix]]
        on = "base"
        u = "all"
        [[step.load]]
        on = "edge"
        per_node = [46.46390609, 0.0, -97.86067313]
        [solver]
        newton = { force_tol = 1e-10 }
    "#;
    let done = run(&mut common::model("edge.toml", case, &[]));
    let last = done.frames.last().unwrap();
    let block = [4.36392507e-3, 1.56931087e-3, -1.40421711e-3];
    assert!(relative(&last.displacement[7].to_array(), &block) < 2e-9);
    // pn times area times the distance of the point (1.0055, 0.5, 0.9954465), by the block, from the edge 6-7
    let edge = (last.displacement[5] + last.displacement[6]) * 0.5;
    let away = [
        1.0055 - (1.0 + edge.x),
        0.9995 - 4.05353021e-3 - (1.0 + edge.z),
    ];
    let forces = away.map(|away| 1e6 * 0.04 * away / 2.0);
    assert!(
        relative(&forces, &[46.46390609, -97.86067313]) < 1e-6,
        "{forces:?}"
    );
}

/// A tip goes down one per cent off the end of a block: it rests on the continuation of its top, on nothing where
/// only faces count, and on the corner where edges do, which then pushes it aside, too.
#[test]
fn points_beside_a_surface_rest_on_what_counts() {
    let force = |features: &str| {
        let case = format!(
            r#"
            [mesh]
            nodes = [
              [1, 0, 0], [2, 1, 0], [3, 1, 1], [4, 0, 1],
              [5, 1.01, 1.0], [6, 1.2, 1.4], [7, 0.9, 1.4],
            ]
            elements = [
              {{ id = 1, type = "quad4", group = "block", nodes = [1, 2, 3, 4] }},
              {{ id = 2, type = "tri3", group = "tool", nodes = [5, 6, 7] }},
            ]
            [model]
            space = "plane-strain"
            [sets]
            base = {{ nodes = [1, 2] }}
            tip = {{ nodes = [5] }}
            top = {{ faces = [[1, "S3"]] }}
            [material.soft]
            model = "linear-elastic"
            E = 100.0
            nu = 0.0
            [[body]]
            group = "block"
            material = "soft"
            [[body]]
            group = "tool"
            rigid = true
            [[contact]]
            name = "tip"
            secondary = "tip"
            primary = "top"
            method = "node-to-segment"
            features = "{features}"
            enforcement = {{ penalty = 1e3, per = "node" }}
            [[step]]
            name = "press"
            increments = 2
            [[step.fix]]
            on = "base"
            u = "all"
            [[step.move]]
            on = "tool"
            uy = -0.01
            "#
        );
        let done = run(&mut common::model("tip.toml", &case, &[]));
        done.frames.last().unwrap().contacts[0].secondary.force
    };
    let (auto, faces, edges) = (force("auto"), force("faces"), force("edges"));
    assert!(auto.y > 0.1, "{auto:?}");
    assert_eq!(faces.norm(), 0.0);
    assert!(edges.y > 0.1 && edges.x < -0.1, "{edges:?}");
}

/// Runs a deck by the command; its exit code and what it printed.
fn by_command(arguments: &[&str], folder: &Path) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_signorini"));
    let output = command
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let told = [output.stdout, output.stderr].concat();
    let told = String::from_utf8_lossy(&told).into_owned();
    (output.status.code().unwrap_or(-1), told)
}

#[test]
fn own_decks_pass_their_checks_and_a_wrong_one_gives_exit_code_1() {
    let scratch = tempfile::tempdir().unwrap();
    for deck in decks_in(&own(".")) {
        let name = deck.file_name().unwrap().to_str().unwrap();
        std::fs::copy(&deck, scratch.path().join(name)).unwrap();
        let (code, told) = by_command(&["run", name], scratch.path());
        assert_eq!(code, 0, "{name}: {told}");
        assert!(told.contains("expect ") && !told.contains('✗'), "{told}");
    }
    let text = std::fs::read_to_string(own("wedge.in")).unwrap();
    let wrong = text.replace("-44.5987460131", "-44.5987");
    assert_ne!(wrong, text);
    std::fs::write(scratch.path().join("wrong.in"), wrong).unwrap();
    let (code, told) = by_command(&["run", "wrong.in"], scratch.path());
    assert_eq!(code, 1, "{told}");
    assert!(told.contains("reaction_force.z @ node 11"), "{told}");
}

#[test]
fn decks_are_checked_and_refused_with_their_lines() {
    let scratch = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(own("wedge.in")).unwrap();
    std::fs::write(scratch.path().join("good.in"), &text).unwrap();
    let (code, told) = by_command(&["check", "good.in"], scratch.path());
    assert!(
        code == 0 && told.contains("nothing wrong was found"),
        "{told}"
    );
    let (code, told) = by_command(&["info", "good.in"], scratch.path());
    assert!(code == 0 && told.contains("set-4"), "{told}");
    for (from, to, wanted) in [
        ("controlmode 1", "controlmode 0", "arc length"),
        (
            "IsoLE 1",
            "Concrete2 1",
            "the material `concrete2` is not supported",
        ),
        ("nodes 6 1 2 3", "nodes 6 1 2 33", "there is no node 33"),
        ("n 0. talpha", "n 0.7 talpha", "nu"),
        ("penalty 1.e5", "penalty -1", "the penalty is -1"),
    ] {
        let bad = text.replace(from, to);
        assert_ne!(bad, text, "{from}");
        std::fs::write(scratch.path().join("bad.in"), bad).unwrap();
        let (code, told) = by_command(&["run", "bad.in"], scratch.path());
        assert_eq!(code, 3, "{told}");
        assert!(told.contains(wanted) && told.contains("bad.in"), "{told}");
    }
}

/// The case that `convert` writes has the results of the deck, bit by bit.
#[test]
fn converted_decks_have_the_same_results() {
    let scratch = tempfile::tempdir().unwrap();
    let case = scratch.path().join("case.toml");
    for deck in decks_in(&own(".")) {
        let name = deck.display().to_string();
        let (code, told) = by_command(&["convert", &name, case.to_str().unwrap()], scratch.path());
        assert_eq!(code, 0, "{told}");
        let (of_deck, of_case) = (solved(read(&deck)), solved(read(&case)));
        assert_eq!(of_deck.frames.len(), of_case.frames.len(), "{name}");
        for (a, b) in of_deck.frames.iter().zip(&of_case.frames) {
            assert!(
                relative(&displacements(b), &displacements(a)) < 1e-12,
                "{name}"
            );
        }
    }
}

/// A point of OOFEM that closes is without friction until its step has ended.
#[test]
fn friction_begins_one_step_after_closing() {
    let loaded = read(&own("blocks.in"));
    let shear = |loaded: Loaded| -> Vec<f64> {
        let done = solved(loaded);
        let shear = |frame: &Frame| frame.contacts[0].force_shear.norm();
        done.frames.iter().map(shear).collect()
    };
    let mut at_once = loaded.clone();
    at_once.case.contacts[0].remembers_traction = false;
    let (waits, at_once) = (shear(loaded), shear(at_once));
    assert!(waits[0] == 0.0 && at_once[0] > 0.0, "{waits:?} {at_once:?}");
    assert!(waits[1] > 0.0, "{waits:?}");
}

/// The folder of OOFEM's decks next to the repository.
fn suite() -> Option<PathBuf> {
    let near = [
        repository().join("../shared"),
        repository().join("../../shared"),
    ];
    let found = near
        .map(|near| near.join("decks/oofem"))
        .into_iter()
        .find(|f| f.is_dir());
    if found.is_none() {
        println!("SKIPPED: no shared/decks/oofem beside the repository");
    }
    found
}

/// Decks that docs/oofem.md calls passed still are; the page's table is what this prints.
#[test]
fn decks_of_the_suite_pass_as_the_page_says() {
    let Some(folder) = suite() else { return };
    let page = std::fs::read_to_string(repository().join("docs/oofem.md")).unwrap();
    println!(
        "| deck | increments | checks | largest difference over tolerance | |\n|---|---|---|---|---|"
    );
    let mut lost = Vec::new();
    for path in ["authors", "2026-08"]
        .iter()
        .flat_map(|f| decks_in(&folder.join(f)))
    {
        let start = format!("| {} | ", path.file_stem().unwrap().to_string_lossy());
        let row = format!("{start}{} |", verdict(&path));
        println!("{row}");
        let told = page.lines().find(|line| line.starts_with(&start));
        let told = told.unwrap_or_else(|| panic!("docs/oofem.md lacks {start}"));
        if told.contains("| passed |") && !row.contains("| passed |") {
            lost.push(row);
        }
    }
    assert!(lost.is_empty(), "{lost:#?}");
}

/// What the page says of a deck.
fn verdict(path: &Path) -> String {
    let loaded = read(path);
    let expected = loaded.case.expectations.clone();
    let source = loaded.source.clone();
    let mut model = build(loaded.case, loaded.mesh).unwrap_or_else(|e| panic!("{}", e.plain()));
    let scratch = tempfile::tempdir().unwrap();
    let mut options = RunOptions::new(source);
    options.folder = scratch.path().join("out");
    let finished = signorini::run(&mut model, &options, &mut ());
    assert!(finished.exit_code <= 1, "{}", path.display());
    let summary = &finished.summary;
    let increments: u64 = summary.steps.iter().map(|step| step.increments).sum();
    let checks = &summary.expectations;
    let good = checks.iter().filter(|one| one.ok).count();
    let excess = checks.iter().zip(&expected).map(|(one, part)| {
        let allowed = match part.tolerance {
            signorini_io::case::Tolerance::Absolute(allowed) => allowed,
            signorini_io::case::Tolerance::Relative(part) => part * one.value.abs(),
        };
        (one.got - one.value).abs() / allowed
    });
    let worst = excess.fold(0.0, f64::max);
    let word = if good == checks.len() {
        "passed"
    } else {
        "differs"
    };
    format!(
        "{increments} | {good} of {} | {worst:.1e} | {word}",
        checks.len()
    )
}
