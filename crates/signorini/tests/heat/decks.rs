//! Decks of heat: every load, every element of the field, by closed forms.

use super::common;
use signorini::{Reading, build, load};
use signorini_io::deck::Compat;

/// A bar of two elements along x, of length 2 and cross-section 1, or of revolution from r = 1 to r = 3.
fn bar(kind: &str) -> String {
    let solid = kind.contains("3D");
    let first = if kind.contains("AX") { 1.0 } else { 0.0 };
    let mut text = "*NODE, NSET=ALL\n".to_owned();
    let layers = if solid { 2 } else { 1 };
    for layer in 0..layers {
        for row in 0..2 {
            for column in 0..3 {
                let node = 1 + column + 3 * row + 6 * layer;
                text += &format!("{node}, {}, {row}, {layer}\n", first + f64::from(column));
            }
        }
    }
    text += &format!("*ELEMENT, TYPE={kind}, ELSET=BAR\n");
    text += match solid {
        true => {
            "1, 1,2,5,4, 7,8,11,10\n2, 2,3,6,5, 8,9,12,11\n*NSET, NSET=LEFT\n1,4,7,10\n*NSET, NSET=RIGHT\n3,6,9,12\n"
        }
        false => "1, 1,2,5,4\n2, 2,3,6,5\n*NSET, NSET=LEFT\n1,4\n*NSET, NSET=RIGHT\n3,6\n",
    };
    // the side at the end of the second element
    text += &format!("*SURFACE, NAME=END\n2, S{}\n", if solid { 4 } else { 2 });
    text
}

/// Temperatures of nodes 1 and 3 at the end of a deck.
fn ends(text: &str, compat: Compat) -> [f64; 2] {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bar.inp");
    std::fs::write(&path, text).unwrap();
    let reading = Reading {
        compat: Some(compat),
        ..Reading::default()
    };
    let loaded = load(&path, &reading).unwrap_or_else(|found| panic!("{}\n{text}", found.plain()));
    let mut model = build(loaded.case, loaded.mesh).unwrap_or_else(|e| panic!("{}", e.plain()));
    let run = common::run(&mut model);
    assert!(run.error.is_none(), "{:?}\n{text}", run.error);
    let last = run.frames.last().unwrap();
    [1, 3].map(|node| last.temperature[model.node(node).unwrap() as usize])
}

const MATERIAL: &str = "*MATERIAL, NAME=M\n*CONDUCTIVITY\n4.\n*SOLID SECTION, ELSET=BAR, MATERIAL=M\n1.\n\
     *PHYSICAL CONSTANTS, ABSOLUTE ZERO=-273., STEFAN BOLTZMANN=5.67E-8\n\
     *INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n";

const KINDS: [&str; 9] = [
    "C3D8", "C3D8I", "C3D8R", "DC3D8", "CPS4", "CPE4", "DC2D4", "CAX4", "DCAX4",
];

/// Heat that goes through the end of a bar held at 20 on its left raises the end by it, times the resistance.
fn resistance(kind: &str) -> (f64, f64) {
    match kind.contains("AX") {
        // ln(r₂/r₁)/k per radian and height, through the area at r = 3; of linear elements, by their own closed form
        true => {
            let of_element = |a: f64, b: f64| 2.0 / (a + b);
            ((of_element(1.0, 2.0) + of_element(2.0, 3.0)) / 4.0, 3.0)
        }
        false => (2.0 / 4.0, 1.0),
    }
}

#[test]
fn bars_of_decks_have_the_temperatures_of_closed_forms_in_every_element() {
    for kind in KINDS {
        let (r, area) = resistance(kind);
        let side = if kind.contains("3D") { 4 } else { 2 };
        let held = "*BOUNDARY\nLEFT, 11, 11, 20.\n";
        let steady = |cards: &str| {
            format!(
                "{}{MATERIAL}*STEP\n*HEAT TRANSFER, STEADY STATE\n{held}{cards}*END STEP\n",
                bar(kind)
            )
        };
        let flux = 20.0 + 8.0 * area * r;
        // θ = 20 + r A h (80 − θ)
        let film = (20.0 + r * area * 2.0 * 80.0) / (1.0 + r * area * 2.0);
        for (cards, expected) in [
            (format!("*DFLUX\n2, S{side}, 8.\n"), flux),
            ("*DSFLUX\nEND, S, 8.\n".to_owned(), flux),
            (format!("*FILM\n2, F{side}, 80., 2.\n"), film),
            ("*SFILM\nEND, F, 80., 2.\n".to_owned(), film),
        ] {
            for compat in [Compat::None, Compat::Ccx] {
                let [left, right] = ends(&steady(&cards), compat);
                assert!((left - 20.0).abs() < 1e-12, "{kind} {cards}: {left}");
                assert!(
                    (right / expected - 1.0).abs() < 1e-10,
                    "{kind} {cards}: {right} for {expected}"
                );
            }
        }
        // θ − 20 = r A ε σ (1173⁴ − (θ + 273)⁴)
        for cards in [
            format!("*RADIATE\n2, R{side}, 900., 0.5\n"),
            "*SRADIATE\nEND, R, 900., 0.5\n".to_owned(),
        ] {
            let [_, right] = ends(&steady(&cards), Compat::None);
            // by halving, from the temperatures of both ends
            let factor = 0.5 * 5.67e-8 * area * r;
            let excess = |t: f64| t - 20.0 - factor * (1173.0_f64.powi(4) - (t + 273.0).powi(4));
            let [mut low, mut high] = [20.0, 900.0];
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                *(if excess(middle) > 0.0 {
                    &mut high
                } else {
                    &mut low
                }) = middle;
            }
            assert!(
                (right - low).abs() < 1e-7,
                "{kind} {cards}: {right} for {low}"
            );
            assert!(right > 400.0, "{kind}: {right}");
        }
    }
}

#[test]
fn heat_at_nodes_and_within_bodies_is_that_of_the_card() {
    for kind in ["C3D8", "DC3D8", "CPS4"] {
        let nodes = if kind.contains("3D") { 4.0 } else { 2.0 };
        let steady = |cards: &str| {
            format!(
                "{}{MATERIAL}*STEP\n*HEAT TRANSFER, STEADY STATE\n*BOUNDARY\nLEFT, 0, 0, 20.\n{cards}*END STEP\n",
                bar(kind)
            )
        };
        let [_, right] = ends(
            &steady("*CFLUX\nRIGHT, 11, 1.\nRIGHT, 0, 2.\n"),
            Compat::None,
        );
        assert!(
            (right - (20.0 + 3.0 * nodes * 0.5)).abs() < 1e-9,
            "{kind}: {right}"
        );
        // q L²/2k
        let [_, right] = ends(&steady("*DFLUX\nBAR, BF, 6.\n"), Compat::None);
        assert!(
            (right - (20.0 + 6.0 * 4.0 / 8.0)).abs() < 1e-9,
            "{kind}: {right}"
        );
    }
}

#[test]
fn films_change_from_step_to_step_in_a_straight_line_and_end() {
    let step = |cards: &str| format!("*STEP\n*HEAT TRANSFER, STEADY STATE\n{cards}*END STEP\n");
    let first = step("*BOUNDARY\nLEFT, 11, 11, 20.\n*FILM\n2, F4, 80., 2.\n");
    let second = step("*FILM\n2, F4, 140., 2.\n");
    let third = step("*FILM, OP=NEW\n");
    let whole = format!("{}{MATERIAL}{first}", bar("C3D8"));
    let at = |text: &str| ends(text, Compat::None)[1];
    assert!((at(&whole) - 50.0).abs() < 1e-10);
    let more = format!("{whole}{second}");
    assert!((at(&more) - 80.0).abs() < 1e-10);
    assert!((at(&format!("{more}{third}")) - 20.0).abs() < 1e-10);
}

#[test]
fn held_temperatures_follow_amplitudes_and_stay() {
    let amplitude = "*AMPLITUDE, NAME=A\n0., 1., 1., 0.5, 2., 0.5\n";
    let store = MATERIAL.replace("4.\n", "4.\n*DENSITY\n1.\n*SPECIFIC HEAT\n1e-9\n");
    let first = "*STEP\n*HEAT TRANSFER, DIRECT\n0.5, 1.\n*BOUNDARY, AMPLITUDE=A\nLEFT, 11, 11, 100.\n*END STEP\n";
    let text = format!("{}{store}{amplitude}{first}", bar("C3D8"));
    let [left, right] = ends(&text, Compat::None);
    assert!(
        (left - 50.0).abs() < 1e-12 && (right - 50.0).abs() < 1e-5,
        "{left} {right}"
    );
    // it stays in the next step, unless it is free there
    let next = "*STEP\n*HEAT TRANSFER, STEADY STATE\n*DSFLUX\nEND, S, 8.\n*END STEP\n";
    let [left, right] = ends(&format!("{text}{next}"), Compat::None);
    assert!(
        (left - 50.0).abs() < 1e-12 && (right - 54.0).abs() < 1e-9,
        "{left} {right}"
    );
    let free =
        "*STEP\n*HEAT TRANSFER, STEADY STATE\n*BOUNDARY, OP=NEW\nRIGHT, 11, 11, 70.\n*END STEP\n";
    let [left, right] = ends(&format!("{text}{free}"), Compat::None);
    assert!(
        (left - 70.0).abs() < 1e-9 && (right - 70.0).abs() < 1e-12,
        "{left} {right}"
    );
}

#[test]
fn a_bar_that_warms_between_walls_is_pressed_and_one_in_a_gap_conducts() {
    // two cubes in line with a conductance of 2 between them: the middle drops by q/h
    let text = "*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
        11,1,0,0\n12,2,0,0\n13,2,1,0\n14,1,1,0\n15,1,0,1\n16,2,0,1\n17,2,1,1\n18,1,1,1\n\
        *ELEMENT, TYPE=C3D8, ELSET=BAR\n1,1,2,3,4,5,6,7,8\n2,11,12,13,14,15,16,17,18\n\
        *NSET, NSET=LEFT\n1,4,5,8\n*NSET, NSET=RIGHT\n12,13,16,17\n\
        *SURFACE, NAME=A\n1, S4\n*SURFACE, NAME=B\n2, S6\n\
        *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*EXPANSION\n1e-3\n*CONDUCTIVITY\n4.\n*SOLID SECTION, ELSET=BAR, MATERIAL=M\n\
        *SURFACE INTERACTION, NAME=I\n*GAP CONDUCTANCE, PRESSURE\n0., 0.\n2e3, 1e5\n\
        *CONTACT PAIR, INTERACTION=I, TYPE=KIND\nA, B\n\
        *STEP\n*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n*BOUNDARY\nLEFT, 1, 1\nRIGHT, 1, 1\nALL, 2, 3\n\
        LEFT, 11, 11, 100.\nRIGHT, 11, 11, 0.\n*NODE PRINT, NSET=LEFT\nNT, RFL\n*EL PRINT, ELSET=BAR\nHFL\n*END STEP\n";
    for kind in ["NODE TO SURFACE", "SURFACE TO SURFACE", "MORTAR"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gap.inp");
        std::fs::write(&path, text.replace("KIND", kind)).unwrap();
        let loaded = load(&path, &Reading::default()).unwrap_or_else(|e| panic!("{}", e.plain()));
        let mut model = build(loaded.case, loaded.mesh).unwrap();
        let run = common::run(&mut model);
        assert!(run.error.is_none(), "{kind}: {:?}", run.error);
        let frame = run.frames.last().unwrap();
        let at = |node| frame.temperature[model.node(node).unwrap() as usize];
        let (a, b) = (at(2), at(11));
        // by symmetry the mean is 50: both expand by 1e-3 × 50, and p = E α 50 = 50; h = 2e3/1e5 p = 1
        let p = frame.contacts[0].pressure_max;
        assert!((p - 50.0).abs() < 0.2, "{kind}: {p}");
        let h = 0.02 * p;
        let q = h * (a - b);
        assert!(
            (4.0 * (100.0 - a) / q - 1.0).abs() < 1e-6,
            "{kind}: {a} {b}"
        );
        assert!((4.0 * b / q - 1.0).abs() < 1e-6, "{kind}: {a} {b}");
        assert!(
            (a - b - 100.0 / (1.0 + h / 2.0)).abs() < 1e-6,
            "{kind}: {a} {b}"
        );
    }
}
