//! Decks of Abaqus and CalculiX, run as they are.

#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::{Run, relative, repository, run};
use signorini::{Compat, Loaded, Reading, build, load};
use signorini_io::case::mutate::{Generator, mutate};
use signorini_io::case::{MeshSource, read_case, resolved};
use signorini_io::compare::{Outcome, Tolerance, compare, tables};
use signorini_io::deck;
use signorini_io::fs::RealFs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn own(name: &str) -> PathBuf {
    repository().join("crates/signorini/tests/data").join(name)
}

fn read(path: &Path, compat: Compat) -> Loaded {
    let reading = Reading {
        compat,
        ..Reading::default()
    };
    load(path, &reading).unwrap_or_else(|found| panic!("{}", found.plain()))
}

fn solved(loaded: Loaded) -> Run {
    let mut model = build(loaded.case, loaded.mesh).unwrap_or_else(|e| panic!("{}", e.plain()));
    let done = run(&mut model);
    assert!(done.error.is_none(), "{:?}", done.error);
    done
}

/// The sum of reactions along z at the end of each step.
fn reactions(done: &Run) -> Vec<f64> {
    let last_of_step = |k: &usize| {
        let next = done.frames.get(k + 1);
        next.is_none_or(|next| next.step_number != done.frames[*k].step_number)
    };
    (0..done.frames.len())
        .filter(last_of_step)
        .map(|k| done.frames[k].reaction_force.iter().map(|f| f.z).sum())
        .collect()
}

/// 4 + 10 + 200 upwards and a pressure of 3 down; 49 more on one node; that node and the pressure alone.
#[test]
fn loads_add_up_within_a_step_and_replace_those_of_earlier_ones() {
    let sums = reactions(&solved(read(&own("block.inp"), Compat::None)));
    assert!(
        relative(&sums, &[-211.0, -260.0, -47.0]) < 1e-12,
        "{sums:?}"
    );
}

/// ν = 0: a rod of area 1/4 on a block whose top yields locally; with the law of the deck, the gap yields by p/K.
#[test]
fn a_deck_of_two_blocks_is_pressed_by_either_law() {
    let hard = solved(read(&own("pair.inp"), Compat::None));
    let soft = solved(read(&own("pair.inp"), Compat::Ccx));
    let force = |done: &Run| reactions(done)[0];
    // two rods in a row bear F = u/(l/(E A) + l/(E A')), with A = 1/4 and 1/4 < A' < 1
    for done in [&hard, &soft] {
        let force = done.frames.last().unwrap().contacts[0].secondary.force;
        assert!(2.5 < force.z && force.z < 4.0, "{force:?}");
    }
    assert!(
        force(&hard).abs() < 1e-9 && force(&soft).abs() < 1e-9,
        "what holds both is in balance"
    );
    let of = |done: &Run| done.frames.last().unwrap().contacts[0].secondary.force.z;
    let softer = 1.0 - of(&soft) / of(&hard);
    assert!(softer > 0.0 && softer < 1e-2, "{softer}");
    assert!(soft.frames.last().unwrap().contacts[0].gap_min < 0.0);
}

/// ν = 0, between walls: the force F overlaps the sides of the cut by F l/(E A); what is locked there and cools by 2 is
/// under F/A + E α · 2.
#[test]
fn a_bolt_is_tightened_by_a_force_and_locked() {
    let done = solved(read(&own("bolt.inp"), Compat::None));
    let stress = |k: usize| -> Vec<f64> {
        let cells = &done.frames[k].cell_stress;
        cells.iter().flatten().map(|s| s.zz()).collect()
    };
    let ends = [8.0, 10.0].map(|s| [s, s]);
    for (step, wanted) in ends.iter().enumerate() {
        let last = done.frames.iter().rposition(|f| f.step_number == step);
        assert!(relative(&stress(last.unwrap()), wanted) < 1e-12, "{step}");
        let overlap = done.frames[last.unwrap()].rigid[0].displacement.x;
        assert!((overlap - 8.0 * 4.0 / 1000.0).abs() < 1e-15, "{overlap}");
    }
}

/// What `convert` writes has the result of the deck.
#[test]
fn a_converted_deck_has_the_same_result() {
    for (name, compat) in [
        ("block.inp", Compat::None),
        ("bolt.inp", Compat::None),
        ("pair.inp", Compat::None),
        ("pair.inp", Compat::Ccx),
    ] {
        same_after_conversion(&own(name), compat);
    }
}

/// Runs a deck, and the case that it is; both have to end alike.
fn same_after_conversion(path: &Path, compat: Compat) {
    let loaded = read(path, compat);
    let mut case = loaded.case.clone();
    case.mesh = MeshSource::File {
        path: path.display().to_string().into(),
    };
    let text = resolved(&case);
    let (again, _) = read_case("case.toml", text.as_bytes(), &[])
        .unwrap_or_else(|found| panic!("{}\n{text}", found.plain()));
    assert_eq!(again, case, "{}", path.display());
    let converted = Loaded {
        case: again,
        ..loaded.clone()
    };
    let (direct, converted) = (solved(loaded), solved(converted));
    assert_eq!(direct.frames.len(), converted.frames.len());
    let of = |done: &Run| -> Vec<f64> {
        let last = done.frames.last().unwrap();
        last.displacement
            .iter()
            .flat_map(|u| u.to_array())
            .collect()
    };
    assert!(relative(&of(&converted), &of(&direct)) < 1e-12);
}

/// The folder of CalculiX's own decks beside the repository.
fn suite() -> Option<PathBuf> {
    let near = [
        repository().join("../shared"),
        repository().join("../../shared"),
    ];
    let found = near
        .map(|near| near.join("decks/calculix"))
        .into_iter()
        .find(|f| f.is_dir());
    if found.is_none() {
        println!("SKIPPED: no shared/decks/calculix beside the repository");
    }
    found
}

/// Decks that docs/decks.md calls the same as their references still are; the page is written from what this prints.
#[test]
fn decks_of_the_suite_print_what_the_page_says() {
    let Some(folder) = suite() else { return };
    let mut names: Vec<PathBuf> = (std::fs::read_dir(&folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "inp"))
        .collect();
    names.sort();
    let page = std::fs::read_to_string(repository().join("docs/decks.md")).unwrap();
    println!("| deck | iterations | tables | largest difference | |\n|---|---|---|---|---|");
    let mut lost = Vec::new();
    for path in &names {
        let start = format!("| {} | ", path.file_stem().unwrap().to_string_lossy());
        let row = format!("{start}{} |", verdict(path));
        println!("{row}");
        let told = page.lines().find(|line| line.starts_with(&start));
        let was_same = told
            .unwrap_or_else(|| panic!("docs/decks.md lacks {start}"))
            .ends_with("| same |");
        if was_same && !row.ends_with("| same |") {
            lost.push(row);
        }
    }
    assert!(lost.is_empty(), "{lost:#?}");
}

/// Runs a deck and compares what it prints.
fn verdict(path: &Path) -> String {
    let reading = Reading {
        compat: Compat::Ccx,
        ..Reading::default()
    };
    let loaded = match load(path, &reading) {
        Ok(loaded) => loaded,
        Err(found) => return refused(&found),
    };
    let source = loaded.source.clone();
    let mut model = match build(loaded.case, loaded.mesh) {
        Ok(model) => model,
        Err(found) => return refused(&found),
    };
    model.name.clone_from(&source.name);
    let scratch = tempfile::tempdir().unwrap();
    let mut options = signorini::RunOptions::new(source.clone());
    options.folder = scratch.path().join("out");
    let finished = signorini::run(&mut model, &options, &mut ());
    assert_eq!(finished.exit_code, 0, "{}", path.display());
    let iterations: u64 = finished
        .summary
        .steps
        .iter()
        .map(|step| step.iterations)
        .sum();
    let printed = options.folder.join(format!("{}.dat", source.name));
    let reference = path.with_extension("dat.ref");
    let read = |path: &Path| {
        let bytes = std::fs::read(path).unwrap_or_default();
        tables("a.dat", &bytes).unwrap_or_default()
    };
    let findings = compare(&read(&printed), &read(&reference));
    let tolerance = Tolerance {
        rel: 1e-3,
        abs: 0.0,
    };
    let good = findings.iter().filter(|one| one.agrees(tolerance)).count();
    let ratio = |one: &signorini_io::compare::Finding| match &one.outcome {
        Outcome::Both(both) => Some(both.ratio()),
        _ => None,
    };
    let largest = findings.iter().filter_map(ratio).fold(0.0, f64::max);
    let word = match findings.len() {
        0 => "nothing printed",
        n if n == good => "same",
        _ => "differs",
    };
    format!(
        "{iterations} | {good} of {} | {largest:.1e} | {word}",
        findings.len()
    )
}

fn refused(found: &signorini::Diagnostics) -> String {
    let first = found.plain();
    let first = first.lines().next().unwrap_or_default();
    format!("| | | refused: {first}")
}

/// Damaged decks: read and built, never a panic and never a hang.
fn mutants(count: usize, seed: u64) {
    let originals = ["block.inp", "pair.inp"].map(|name| std::fs::read(own(name)).unwrap());
    let mut generator = Generator::new(seed);
    let mut reached = [0usize; 3];
    for number in 0..count {
        let mutant = mutate(&originals[number % originals.len()], &mut generator);
        let name = own("mutant.inp").display().to_string();
        let start = Instant::now();
        let compat = [Compat::None, Compat::Ccx][number / 2 % 2];
        reached[match deck::read(&RealFs, &name, &mutant, compat) {
            Err(_) => 0,
            Ok(read) => match build(read.case, read.mesh) {
                Err(_) => 1,
                Ok(_) => 2,
            },
        }] += 1;
        assert!(
            start.elapsed() < Duration::from_secs(10),
            "mutant {number} of seed {seed}"
        );
    }
    println!("refused as deck, as model; accepted: {reached:?}");
    assert!(reached.iter().all(|n| *n > 0), "{reached:?}");
}

#[test]
fn two_thousand_damaged_decks_are_refused_or_built_without_panic() {
    mutants(2_000, 20261122);
}

#[test]
#[ignore = "takes a minute: run by .ci/run"]
fn a_hundred_thousand_damaged_decks_are_refused_or_built_without_panic() {
    mutants(100_000, 6);
}
