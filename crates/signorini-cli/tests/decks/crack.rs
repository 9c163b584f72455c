//! The faces of a crack share the nodes of its front: pressed together they bear what the sound plate does.

use crate::{read, solved};
use signorini::Compat;
use std::fmt::Write;

/// Cells along each edge.
const N: usize = 6;

/// A plate, or a slab of one layer, with a crack from its left edge to its middle; its head is moved along y.
fn deck(element: &str, pair: &str, kind: &str, head: f64) -> String {
    let layers = if element.starts_with("C3D") { 2 } else { 1 };
    let middle = N / 2;
    let sheet = (N + 1) * (N + 2);
    // nodes of the upper face of the crack are in a row of their own; it ends at a node of both
    let node = |i: usize, j: usize, k: usize, upper: bool| {
        let row = if upper && j == middle && i < middle {
            N + 1
        } else {
            j
        };
        1 + i + (N + 1) * row + k * sheet
    };
    let mut text = String::from("*NODE\n");
    for k in 0..layers {
        for j in 0..=N + 1 {
            let (at, count) = if j > N { (middle, middle) } else { (j, N + 1) };
            for i in 0..count {
                let label = 1 + i + (N + 1) * j + k * sheet;
                let [x, y] = [i, at].map(|i| i as f64 / N as f64);
                writeln!(text, "{label}, {x}, {y}, {}", k as f64 / N as f64).unwrap();
            }
        }
    }
    writeln!(text, "*ELEMENT, TYPE={element}, ELSET=PLATE").unwrap();
    for j in 0..N {
        for i in 0..N {
            let upper = j >= middle;
            let of = |k: usize| {
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| node(i, j, k, upper))
            };
            let nodes = (0..layers).flat_map(of).map(|n| n.to_string());
            let nodes: Vec<String> = nodes.collect();
            writeln!(text, "{}, {}", 1 + i + N * j, nodes.join(", ")).unwrap();
        }
    }
    let sides = if layers == 2 {
        ["S5", "S3"]
    } else {
        ["S3", "S1"]
    };
    for (name, j, side) in [("LOW", middle - 1, sides[0]), ("HIGH", middle, sides[1])] {
        writeln!(text, "*SURFACE, NAME={name}").unwrap();
        (0..middle).for_each(|i| writeln!(text, "{}, {side}", 1 + i + N * j).unwrap());
    }
    for (name, j) in [("BASE", 0), ("HEAD", N)] {
        writeln!(text, "*NSET, NSET={name}").unwrap();
        let nodes = (0..layers).flat_map(|k| (0..=N).map(move |i| (i, k)));
        nodes.for_each(|(i, k)| writeln!(text, "{}", node(i, j, k, false)).unwrap());
    }
    let held = if layers == 2 {
        format!("1, 1, 1\n1, 3, 3\n{}, 1, 1\n{}, 3, 3\n", 1 + sheet, N + 1)
    } else {
        "1, 1, 1\n".to_owned()
    };
    text + &format!(
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n\
         *SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.e7\n\
         *CONTACT PAIR, INTERACTION=I, TYPE={kind}\n{pair}\n*BOUNDARY\nBASE, 2, 2\n{held}\
         *STEP\n*STATIC\n1., 1.\n*BOUNDARY\nHEAD, 2, 2, {head}\n*END STEP\n"
    )
}

/// The least and the largest stress along y of all elements.
fn stresses(deck: &str, compat: Compat) -> [f64; 2] {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("crack.inp");
    std::fs::write(&path, deck).unwrap();
    let done = solved(read(&path, compat));
    let all = done.frames.last().unwrap().cell_stress.iter().flatten();
    let all: Vec<f64> = all.map(|stress| stress.yy()).collect();
    [
        all.iter().copied().fold(f64::INFINITY, f64::min),
        all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ]
}

#[test]
fn a_closed_crack_bears_what_the_sound_plate_does_and_an_open_one_does_not() {
    for (element, modulus) in [
        ("CPS4", 1000.0),
        ("CPE4", 1000.0 / (1.0 - 0.09)),
        ("C3D8", 1000.0),
    ] {
        for pair in ["LOW, HIGH", "HIGH, LOW"] {
            for kind in ["NODE TO SURFACE", "SURFACE TO SURFACE"] {
                for compat in [Compat::None, Compat::Ccx] {
                    let name = format!("{element}, {pair}, {kind}, {compat:?}");
                    let closed = stresses(&deck(element, pair, kind, -0.01), compat);
                    let wanted = -0.01 * modulus;
                    for stress in closed {
                        // the penalty gives way by some percent
                        assert!((stress / wanted - 1.0).abs() < 0.03, "{name}: {closed:?}");
                    }
                    let [least, largest] = stresses(&deck(element, pair, kind, 0.01), compat);
                    let is_open = least < -0.5 * wanted && largest > -1.1 * wanted;
                    assert!(
                        is_open,
                        "{name}: {least} at the faces, {largest} at the front"
                    );
                }
            }
        }
    }
}
