//! Decks of single cards with right answers, next to the repository: `cases/cards`, written by those who measured them with
//! CalculiX.

use crate::{read, solved, suite};
use serde_json::Value;
use signorini::{Compat, Loaded, Reading, load};
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_mechanics::system::Frame;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What an answer is about, at the end of a step.
#[derive(Clone, Copy, Debug)]
enum Quantity {
    /// The displacement of a node along an axis.
    U(u64, usize),
    /// The stress of an element, as `xx` (0) or `zz` (2).
    S(u64, usize),
    /// The rotation of the one reference about an axis.
    Turn(usize),
}
use Quantity::{S, Turn, U};

/// Tolerance of the answers, relative to the largest of a deck's displacements, stresses or rotations.
const TOLERANCE: f64 = 1e-3;

type Wanted = &'static [(usize, Quantity)];

const OF_ADDED: Wanted = &[(1, U(5, 2)), (2, U(5, 2)), (3, U(5, 2)), (4, U(5, 2))];
const OF_STRAIN_FREE: Wanted = &[
    (1, U(5, 2)),
    (2, U(5, 2)),
    (3, U(5, 2)),
    (4, U(5, 2)),
    (3, S(2, 2)),
    (4, S(2, 2)),
];
const OF_RIGID: Wanted = &[
    (1, U(5, 0)),
    (1, U(5, 1)),
    (1, U(5, 2)),
    (1, U(6, 0)),
    (1, U(6, 1)),
    (1, U(6, 2)),
    (1, U(7, 0)),
    (1, U(7, 1)),
    (1, U(7, 2)),
];
const OF_BAR: Wanted = &[(1, U(5, 2)), (1, S(1, 2))];
const OF_TOP: Wanted = &[(1, U(5, 2))];

/// The quantities of each deck, in the order of its answers.
const WANTED: [(&str, Wanted); 29] = [
    ("amplitude_in_step", OF_TOP),
    ("amplitude_after_static", OF_TOP),
    ("orientation_cylindrical", &[(1, U(2, 0)), (1, U(13, 1))]),
    (
        "orientation_cylindrical_near_axis",
        &[(1, U(2, 0)), (1, U(2, 1))],
    ),
    (
        "model_change_remove",
        &[(1, U(5, 2)), (2, U(5, 2)), (1, S(1, 2)), (2, S(1, 2))],
    ),
    ("model_change_first_step", OF_TOP),
    ("model_change_add_with_strain", OF_ADDED),
    ("model_change_add_with_strain_nlgeom", OF_ADDED),
    ("model_change_add_strain_free", OF_STRAIN_FREE),
    ("model_change_add_nlgeom", OF_STRAIN_FREE),
    ("model_change_add", OF_ADDED),
    ("rigid_nset_no_ref", OF_RIGID),
    ("rigid_elset_no_ref", OF_RIGID),
    (
        "rigid_rot_node_only",
        &[(1, U(5, 0)), (1, U(5, 1)), (1, U(5, 2)), (1, Turn(2))],
    ),
    (
        "rigid_rot_node_prescribed",
        &[(1, U(5, 0)), (1, U(5, 1)), (1, U(5, 2))],
    ),
    ("nodal_thickness_noparam", &[(1, U(2, 0))]),
    ("nodal_thickness_param", &[(1, U(2, 0))]),
    ("submodel_global", &[(1, U(5, 0))]),
    ("submodel_sub", &[(1, U(1, 0)), (1, S(1, 0))]),
    ("refine_mesh_none", OF_TOP),
    ("user_lin_iso_el", OF_TOP),
    ("user_lin_iso_el_nl", OF_TOP),
    ("user_compression_only_t", OF_BAR),
    ("user_compression_only_c", OF_BAR),
    ("user_tension_only_t", OF_BAR),
    ("user_tension_only_c", OF_BAR),
    ("user_ciarlet", OF_TOP),
    ("user_undo_nlgeom", OF_BAR),
    ("deformation_plasticity", OF_BAR),
];

/// The folder of the decks, and their answers.
fn cards() -> Option<(PathBuf, Vec<Value>)> {
    let folder = suite()?.join("../../cases/cards");
    let Ok(text) = std::fs::read_to_string(folder.join("answers.json")) else {
        println!("SKIPPED: no {}", folder.display());
        return None;
    };
    let answers: Value = serde_json::from_str(&text).unwrap();
    Some((folder, answers.as_array().unwrap().clone()))
}

fn numbers(value: &Value, all: &mut Vec<f64>) {
    match value {
        Value::Array(values) => values.iter().for_each(|value| numbers(value, all)),
        value => all.extend(value.as_f64()),
    }
}

/// What a frame says.
fn found(quantity: Quantity, mesh: &Mesh, frame: &Frame) -> f64 {
    match quantity {
        U(node, axis) => {
            let at = mesh.node_labels.iter().position(|label| *label == node);
            frame.displacement[at.unwrap()][axis]
        }
        S(element, axis) => {
            let is_it = |cell: &CellId| mesh.cell_label(*cell) == Some(element);
            let cell = mesh.cells(mesh.dim()).find(is_it).unwrap();
            let stress = frame.cell_stress[cell.block as usize][cell.index as usize];
            [stress.xx(), stress.yy(), stress.zz()][axis]
        }
        Turn(axis) => frame.rigid[0].rotation[axis],
    }
}

const fn is_alike(a: Quantity, b: Quantity) -> bool {
    matches!((a, b), (U(..), U(..)) | (S(..), S(..)) | (Turn(_), Turn(_)))
}

/// Whether a deck gives its answers.
fn gives(deck: &str, loaded: Loaded, wanted: Wanted, right: &[f64]) {
    let mesh = loaded.mesh.clone();
    let done = solved(loaded);
    let right = |k: usize| right.get(k).or(right.first()).copied().unwrap();
    for (k, &(step, quantity)) in wanted.iter().enumerate() {
        let last = done
            .frames
            .iter()
            .rfind(|frame| frame.step_number + 1 == step);
        let value = found(quantity, &mesh, last.unwrap());
        let alike = (0..wanted.len()).filter(|&j| is_alike(wanted[j].1, quantity));
        let largest = alike.map(|j| right(j).abs()).fold(0.0, f64::max);
        let difference = (value - right(k)).abs();
        let says = format!(
            "{deck}, step {step}, {quantity:?}: {value} for {}",
            right(k)
        );
        assert!(difference <= TOLERANCE * largest, "{says}");
    }
}

/// A deck that takes displacements of another model lies next to the results of that.
fn with_global_model(folder: &Path, deck: &str, scratch: &Path) -> PathBuf {
    for name in ["submodel_global", deck] {
        let from = folder.join(format!("{name}.inp"));
        std::fs::copy(from, scratch.join(format!("{name}.inp"))).unwrap();
    }
    let ran = Command::new(env!("CARGO_BIN_EXE_signorini"))
        .current_dir(scratch)
        .args(["run", "submodel_global.inp", "--format", "frd", "-o", "out"])
        .output()
        .unwrap();
    assert!(ran.status.success(), "{ran:?}");
    let results = scratch.join("out/submodel_global.frd");
    std::fs::copy(results, scratch.join("submodel_global.frd")).unwrap();
    scratch.join(format!("{deck}.inp"))
}

#[test]
fn decks_of_single_cards_give_their_right_answers() {
    let Some((folder, answers)) = cards() else {
        return;
    };
    for (deck, wanted) in WANTED {
        let name = format!("{deck}.inp");
        let answer = answers.iter().find(|one| one["deck"] == *name).unwrap();
        let mut right = Vec::new();
        numbers(&answer["right"], &mut right);
        assert!(!right.is_empty(), "{deck}");
        let scratch = tempfile::tempdir().unwrap();
        let path = match deck {
            "submodel_sub" => with_global_model(&folder, deck, scratch.path()),
            _ => folder.join(name),
        };
        for compat in [Compat::None, Compat::Ccx] {
            gives(deck, read(&path, compat), wanted, &right);
        }
    }
}

/// Of the mesh that is given, as that of the same deck without the card.
#[test]
fn a_deck_with_a_mesh_to_be_refined_gives_the_results_of_the_mesh_given() {
    let Some((folder, _)) = cards() else {
        return;
    };
    let of = |deck: &str| {
        let loaded = read(&folder.join(deck), Compat::None);
        solved(loaded).frames.last().unwrap().displacement.clone()
    };
    assert_eq!(of("refine_mesh.inp"), of("refine_mesh_none.inp"));
}

#[test]
fn decks_whose_prints_name_no_set_print_no_table() {
    let Some((folder, _)) = cards() else {
        return;
    };
    for deck in ["print_no_set", "print_no_set_frequency", "print_empty"] {
        for compat in [Compat::None, Compat::Ccx] {
            let loaded = read(&folder.join(format!("{deck}.inp")), compat);
            let prints = loaded.case.steps.iter().flat_map(|step| &step.prints);
            assert_eq!(prints.flatten().count(), 0, "{deck}");
        }
    }
}

#[test]
fn cards_that_are_not_built_are_refused_by_name() {
    let Some((folder, answers)) = cards() else {
        return;
    };
    let refused = [
        ("amplitude_redefined", "amplitude `A` is defined twice"),
        ("model_change_residual", "MECHSTRAINTORESIDUAL"),
        ("shell_composite_axial", "COMPOSITE of *SHELL SECTION"),
        ("user_unknown", "MYMAT"),
    ];
    for (deck, words) in refused {
        is_refused(&folder.join(format!("{deck}.inp")), words);
    }
    let decks = answers.iter().filter_map(|one| one["deck"].as_str());
    for deck in decks.filter(|deck| deck.starts_with("beam")) {
        is_refused(&folder.join(deck), "not built yet");
    }
}

fn is_refused(deck: &Path, words: &str) {
    for compat in [Compat::None, Compat::Ccx] {
        let reading = Reading {
            compat: Some(compat),
            ..Reading::default()
        };
        let refused = load(deck, &reading).map(|_| ()).unwrap_err();
        let shown = refused.plain();
        assert_eq!(refused.exit_code(), Some(3), "{shown}");
        assert!(shown.contains(words), "{}: {shown}", deck.display());
    }
}
