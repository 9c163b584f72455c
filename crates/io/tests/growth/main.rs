//! Reading a deck costs what its size says: of four times as many cards at most a little more than four times as many
//! allocations, whatever the cards are.

#![allow(clippy::unwrap_used, clippy::panic, unsafe_code)]

mod counting;

use counting::{Counting, allocations};
use signorini_io::deck::{Compat, read};
use signorini_io::fs::RealFs;
use std::fmt::Write;

#[global_allocator]
static COUNTING: Counting = Counting;

/// Cubes in a row, each held below, with cards that differ from cube to cube.
fn deck(count: usize, model: fn(usize) -> String, step: fn(usize) -> String, sets: bool) -> String {
    let mut text = String::from("*NODE\n");
    for k in 0..count {
        for (n, [x, y, z]) in CORNERS.iter().enumerate() {
            writeln!(text, "{},{},{y},{z}", 8 * k + n + 1, 2 * k + x).unwrap();
        }
    }
    text.push_str("*ELEMENT, TYPE=C3D8, ELSET=ALL\n");
    for k in 0..count {
        if sets {
            writeln!(text, "*ELEMENT, TYPE=C3D8, ELSET=E{k}").unwrap();
        }
        let nodes: Vec<String> = (1..=8).map(|n| (8 * k + n).to_string()).collect();
        writeln!(text, "{},{}", k + 1, nodes.join(",")).unwrap();
    }
    text.push_str("*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n");
    if !sets {
        text.push_str("*SOLID SECTION, ELSET=ALL, MATERIAL=M\n");
    }
    (0..count).for_each(|k| text.push_str(&model(k)));
    text.push_str("*BOUNDARY\n");
    for k in 0..count {
        (1..=4).for_each(|n| writeln!(text, "{},1,3", 8 * k + n).unwrap());
    }
    text.push_str("*STEP\n*STATIC\n");
    (0..count).for_each(|k| text.push_str(&step(k)));
    text.push_str("*END STEP\n");
    text
}

const CORNERS: [[usize; 3]; 8] = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [1, 1, 1],
    [0, 1, 1],
];

fn load(k: usize) -> String {
    format!("*CLOAD\n{},3,{}\n", 8 * k + 5, 1.0 + k as f64 * 1e-4)
}

fn nothing(_: usize) -> String {
    String::new()
}

/// Its cards of each cube: in the model, and in the step.
type Kind = (&'static str, fn(usize) -> String, fn(usize) -> String, bool);

const KINDS: [Kind; 9] = [
    ("loads", nothing, load, false),
    (
        "pressures",
        nothing,
        |k| format!("*DLOAD\n{},P2,{}\n", k + 1, 1.0 + k as f64 * 1e-4),
        false,
    ),
    (
        "motions",
        nothing,
        |k| format!("*BOUNDARY\n{},3,3,{}\n", 8 * k + 5, 1e-3 + k as f64 * 1e-7),
        false,
    ),
    (
        "equations",
        |k| {
            format!(
                "*EQUATION\n2\n{},3,1.,{},3,-{}\n",
                8 * k + 5,
                8 * k + 6,
                1 + k
            )
        },
        load,
        false,
    ),
    (
        "element sets and sections",
        |k| format!("*SOLID SECTION, ELSET=E{k}, MATERIAL=M\n"),
        load,
        true,
    ),
    (
        "rigid bodies",
        |k| {
            let n = 8 * k;
            format!(
                "*NSET, NSET=T{k}\n{},{},{}\n*RIGID BODY, NSET=T{k}\n",
                n + 5,
                n + 6,
                n + 7
            )
        },
        load,
        false,
    ),
    (
        "amplitudes",
        |k| format!("*AMPLITUDE, NAME=A{k}\n0., 0., 1., {}\n", 1 + k),
        |k| format!("*CLOAD, AMPLITUDE=A{k}\n{},3,1.\n", 8 * k + 5),
        false,
    ),
    (
        "materials",
        |k| format!("*MATERIAL, NAME=M{k}\n*ELASTIC\n{}., 0.3\n", 1000 + k),
        load,
        false,
    ),
    (
        "prints",
        |k| format!("*NSET, NSET=N{k}\n{}\n", 8 * k + 5),
        |k| format!("*NODE PRINT, NSET=N{k}\nU\n"),
        false,
    ),
];

#[test]
fn four_times_as_many_cards_take_four_times_as_many_allocations() {
    for (kind, model, step, sets) in KINDS {
        let counts = [5_000, 20_000].map(|count| {
            let text = deck(count, model, step, sets);
            let read = || read(&RealFs, "job.inp", text.as_bytes(), Compat::None);
            let (found, allocations) = allocations(read);
            found.unwrap_or_else(|found| panic!("{kind}: {}", found.plain()));
            allocations
        });
        let ratio = counts[1] as f64 / counts[0] as f64;
        println!("{kind}: {counts:?} {ratio:.2}");
        assert!(ratio < 4.6, "{kind}: {counts:?}");
    }
}
