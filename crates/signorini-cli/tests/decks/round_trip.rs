//! `signorini convert`: the case that it writes has the results of the deck.

use crate::common::{Run, relative, run};
use crate::{decks_in, of_others, own, suite};
use signorini::{Compat, Loaded, Model, Reading, build, load};
use std::path::Path;
use std::process::Command;

/// The largest difference, relative to the largest value of a field.
const SAME: f64 = 1e-12;

/// Runs a deck and the case that it is converted to; nothing where it is refused. Both have to do the same in every
/// increment.
fn same_after_conversion(deck: &Path, compat: Compat, max_nnode: usize) -> Option<()> {
    let reading = Reading {
        compat: Some(compat),
        ..Reading::default()
    };
    let loaded = load(deck, &reading).ok()?;
    if loaded.mesh.nnode() > max_nnode {
        return Some(());
    }
    let scratch = tempfile::tempdir().unwrap();
    let case = scratch.path().join("case.toml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_signorini"));
    command.arg("convert").arg(deck).arg(&case);
    if compat == Compat::Ccx {
        command.args(["--compat", "ccx"]);
    }
    let told = command.output().unwrap();
    let told = String::from_utf8_lossy(&told.stderr).into_owned();
    let again = load(&case, &Reading::default())
        .unwrap_or_else(|found| panic!("{}: {told}{}", deck.display(), found.plain()));
    assert_eq!(again.mesh, loaded.mesh, "{}", deck.display());
    let model = |loaded: Loaded| build(loaded.case, loaded.mesh);
    let mut model_of_deck = model(loaded).ok()?;
    let mut model_of_case = model(again).unwrap_or_else(|found| panic!("{}", found.plain()));
    same(deck, &mut model_of_deck, &mut model_of_case);
    Some(())
}

fn same(deck: &Path, of_deck: &mut Model, of_case: &mut Model) {
    let (of_deck, of_case) = (run(of_deck), run(of_case));
    let deck = deck.display();
    assert_eq!(of_deck.frames.len(), of_case.frames.len(), "{deck}");
    let counts = |run: &Run| -> Vec<usize> { run.iterations.iter().map(|i| i.iteration).collect() };
    assert_eq!(counts(&of_deck), counts(&of_case), "{deck}");
    let ends = [&of_deck, &of_case].map(|run| run.error.as_ref().map(ToString::to_string));
    assert_eq!(ends[0], ends[1], "{deck}");
    for (k, (a, b)) in of_deck.frames.iter().zip(&of_case.frames).enumerate() {
        for (field, a, b) in [
            ("displacement", &a.displacement, &b.displacement),
            ("reaction", &a.reaction_force, &b.reaction_force),
        ] {
            let numbers = |all: &[signorini_geometry::tensor::Vec3]| -> Vec<f64> {
                all.iter().flat_map(|v| v.to_array()).collect()
            };
            let (a, b) = (numbers(a), numbers(b));
            let difference = relative(&b, &a);
            let is_same = difference < SAME || a == b;
            assert!(is_same, "{deck}, frame {k}, {field}: {difference:e}");
        }
        let forces = |frame: &signorini_mechanics::system::Frame| -> Vec<f64> {
            let of = frame.contacts.iter();
            of.flat_map(|one| one.secondary.force.to_array()).collect()
        };
        let (a, b) = (forces(a), forces(b));
        assert!(a == b || relative(&b, &a) < SAME, "{deck}, frame {k}");
    }
}

#[test]
fn own_decks_have_the_same_results_as_cases() {
    let folders = [own("."), of_others(".")];
    for deck in folders.iter().flat_map(|folder| decks_in(folder)) {
        if deck.ends_with("gmsh_mesh.inp") {
            continue;
        }
        for compat in [Compat::None, Compat::Ccx] {
            let ran = same_after_conversion(&deck, compat, usize::MAX);
            assert!(ran.is_some(), "{}", deck.display());
        }
    }
}

fn of_suite(max_nnode: usize) {
    let Some(folder) = suite() else { return };
    for deck in decks_in(&folder) {
        for compat in [Compat::None, Compat::Ccx] {
            if same_after_conversion(&deck, compat, max_nnode).is_none() {
                println!("refused: {} {compat:?}", deck.display());
            }
        }
    }
}

#[test]
fn small_decks_of_the_suite_have_the_same_results_as_cases() {
    of_suite(300);
}

#[test]
#[ignore = "takes minutes: run by .ci/run"]
fn all_decks_of_the_suite_have_the_same_results_as_cases() {
    of_suite(usize::MAX);
}
