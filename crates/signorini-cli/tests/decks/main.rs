//! Decks of Abaqus and CalculiX, run as they are.

#![allow(clippy::unwrap_used, clippy::panic)]

mod axes;
mod cards;
#[path = "../../../signorini/tests/common/mod.rs"]
mod common;
mod crack;
mod damaged;
mod doors;
mod large;
mod laws;
mod left_out;
#[path = "../../../signorini/tests/common/mutants.rs"]
mod mutants;
mod others;
mod round_trip;
mod ties;

use common::{Run, relative, repository, run};
use signorini::{Compat, Diagnostics, Loaded, Reading, build, load};
use signorini_io::compare::{Finding, Outcome, Tolerance, compare, tables};
use std::path::{Path, PathBuf};

fn own(name: &str) -> PathBuf {
    repository().join("crates/signorini/tests/data").join(name)
}

/// A deck in the manner of another program.
fn of_others(name: &str) -> PathBuf {
    repository()
        .join("crates/signorini-cli/tests/decks")
        .join(name)
}

fn read(path: &Path, compat: Compat) -> Loaded {
    let reading = Reading {
        compat: Some(compat),
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

/// ν = 0, between walls: the force F overlaps the sides of the cut by F l/(E A); a cut locked there that cools by 2 is
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

/// The folder of CalculiX's own decks next to the repository.
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

/// All decks of a folder, in order.
fn decks_in(folder: &Path) -> Vec<PathBuf> {
    let mut decks: Vec<PathBuf> = (std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "inp"))
        .collect();
    decks.sort();
    decks
}

/// Decks that docs/decks.md calls the same as their references still are; the page is written from what this prints.
#[test]
fn decks_of_the_suite_print_what_the_page_says() {
    let Some(folder) = suite() else { return };
    let names = decks_in(&folder);
    let page = std::fs::read_to_string(repository().join("docs/decks.md")).unwrap();
    println!(
        "| deck | iterations | of CalculiX | tables | largest difference | |\n|---|---|---|---|---|---|"
    );
    let mut lost = Vec::new();
    for path in &names {
        let deck = path.file_stem().unwrap().to_string_lossy();
        let start = format!("| {deck} | ");
        let theirs = iterations_of_calculix(&deck);
        let row = format!("{start}{} |", verdict(path, &theirs));
        println!("{row}");
        let told = page.lines().find(|line| line.starts_with(&start));
        let told = told.unwrap_or_else(|| panic!("docs/decks.md lacks {start}"));
        assert_eq!(told.split(" | ").nth(2), Some(&*theirs), "{told}");
        let was_same = told.ends_with("| same |");
        if was_same && !row.ends_with("| same |") {
            lost.push(row);
        }
    }
    assert!(lost.is_empty(), "{lost:#?}");
}

/// How many iterations CalculiX takes, as scripts/ccx_iterations.py found.
fn iterations_of_calculix(deck: &str) -> String {
    let lines = include_str!("ccx_iterations.txt").lines();
    let mut counts = lines.filter_map(|line| line.split_once(' '));
    let count = counts.find(|(name, _)| *name == deck);
    let count = count.unwrap_or_else(|| panic!("ccx_iterations.txt lacks {deck}"));
    count.1.to_owned()
}

/// Runs a deck, and compares what it prints with the reference next to it: iterations, and all tables of either. Where
/// nothing is printed, displacements and stresses of `.frd` files.
fn printed(path: &Path, compat: Compat) -> Result<(u64, Vec<Finding>), Diagnostics> {
    let reading = Reading {
        compat: Some(compat),
        ..Reading::default()
    };
    let mut loaded = load(path, &reading)?;
    let source = loaded.source.clone();
    let prints = |path: &Path| std::fs::metadata(path).is_ok_and(|file| file.len() > 0);
    let reference = path.with_extension("dat.ref");
    let in_frd = !prints(&reference) && prints(&path.with_extension("frd.ref"));
    if in_frd {
        loaded.case.output.format = vec!["frd".into()];
    }
    let mut model = build(loaded.case, loaded.mesh)?;
    model.name.clone_from(&source.name);
    let scratch = tempfile::tempdir().unwrap();
    let mut options = signorini::RunOptions::new(source.clone());
    options.folder = scratch.path().join("out");
    let finished = signorini::run(&mut model, &options, &mut ());
    assert_eq!(finished.exit_code, 0, "{}", path.display());
    let iterations = finished.summary.steps.iter().map(|step| step.iterations);
    let kind = if in_frd { "frd" } else { "dat" };
    let ours = options.folder.join(format!("{}.{kind}", source.name));
    let reference = path.with_extension(format!("{kind}.ref"));
    let read = |path: &Path| {
        let bytes = std::fs::read(path).unwrap_or_default();
        tables(&format!("a.{kind}"), &bytes).unwrap_or_default()
    };
    let mut found = compare(&read(&ours), &read(&reference));
    let in_both = |one: &Finding| ["DISP", "STRESS"].contains(&&*one.name);
    found.retain(|one| !in_frd || in_both(one));
    Ok((iterations.sum(), found))
}

/// The tables of a deck whose names start so are those of its reference; what vanishes there by symmetry is rounding here too.
fn agrees(path: &Path, tables: &str, compat: Compat, rel: f64) {
    let deck = path.file_name().unwrap().display();
    let (_, mut findings) = printed(path, compat).unwrap_or_else(|e| panic!("{}", e.plain()));
    findings.retain(|one| one.name.starts_with(tables));
    assert!(!findings.is_empty(), "{deck} prints nothing");
    for one in &findings {
        let is_zero = match &one.outcome {
            Outcome::Both(both) => {
                println!("{deck} {compat:?}: {:.1e} {}", both.ratio(), one.name);
                both.norm < 1e-5 && both.difference < 1e-4
            }
            _ => false,
        };
        let agrees = is_zero || one.agrees(Tolerance { rel, abs: 0.0 });
        assert!(agrees, "{deck}: {one:?}");
    }
}

/// What the page says of a deck.
fn verdict(path: &Path, theirs: &str) -> String {
    let (iterations, findings) = match printed(path, Compat::Ccx) {
        Ok(compared) => compared,
        Err(found) => return refused(&found, theirs),
    };
    let tolerance = Tolerance {
        rel: 1e-3,
        abs: 0.0,
    };
    let good = findings.iter().filter(|one| one.agrees(tolerance)).count();
    let ratio = |one: &Finding| match &one.outcome {
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
        "{iterations} | {theirs} | {good} of {} | {largest:.1e} | {word}",
        findings.len()
    )
}

fn refused(found: &signorini::Diagnostics, theirs: &str) -> String {
    let first = found.plain();
    let first = first.lines().next().unwrap_or_default();
    format!("| {theirs} | | | refused: {first}")
}
