//! Wear in whole runs.
//!
//! SOURCE      closed forms: Archard's law, a layer at a fixed approach, a spherical pin
//! GOAL        what is worn off is K F s whatever the mesh and the method; increments are those of backward Euler
//! MESH        blocks of quad4 and hex8 that do not match; a rigid pin of quad4 rings
//! CONDITIONS  a way that steps impose, and one that bodies go
//! EXPECTED    see each test
//! TOLERANCE   see each test
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

mod common;

use common::{Run, model, run};
use signorini::{News, Reading, RunOptions, build, open_text};
use signorini_io::fs::{Fs, MemoryFs};
use signorini_mechanics::solve::Flow;
use signorini_mechanics::system::{Check, Frame, Wear};
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Arc;

/// Two blocks of one cross-section, one on the other, without a Poisson effect.
struct Blocks<'a> {
    ndim: usize,
    /// Cells along each axis across the contact.
    cells: [usize; 2],
    contact: &'a str,
    /// Whether the upper block has the secondary side.
    upper: bool,
    steps: &'a str,
    /// How far the lower block goes beyond the upper one, to both sides along x.
    beyond: f64,
}

impl Blocks<'_> {
    fn text(&self) -> String {
        let (mut nodes, mut elements) = (String::new(), String::new());
        let mut sides = [String::new(), String::new()];
        let mut ends = [String::new(), String::new()];
        let (mut first, mut count) = (1, 0);
        let z = self.ndim == 3;
        for block in 0..2 {
            let n = self.cells[block];
            let deep = if z { n + 1 } else { 1 };
            let number = |[i, j, k]: [usize; 3]| first + i + (n + 1) * (j + 3 * k);
            for k in 0..deep {
                for j in 0..3 {
                    for i in 0..=n {
                        let at = [
                            (1.0 - block as f64) * self.beyond * (2.0 * i as f64 / n as f64 - 1.0)
                                + i as f64 / n as f64,
                            0.5 * j as f64 + block as f64,
                            k as f64 / n as f64,
                        ];
                        write!(nodes, "[{}, {:?}, {:?}", number([i, j, k]), at[0], at[1]).unwrap();
                        nodes += &if z {
                            format!(", {:?}], ", at[2])
                        } else {
                            "], ".into()
                        };
                    }
                }
            }
            for k in 0..if z { n } else { 1 } {
                for j in 0..2 {
                    for i in 0..n {
                        count += 1;
                        let layer =
                            |k| [[i, j, k], [i + 1, j, k], [i + 1, j + 1, k], [i, j + 1, k]];
                        let mut of = layer(k).to_vec();
                        if z {
                            of.extend(layer(k + 1));
                        }
                        let of: Vec<usize> = of.into_iter().map(number).collect();
                        let (kind, name) =
                            (["quad4", "hex8"][self.ndim - 2], ["lower", "upper"][block]);
                        write!(elements, "{{ id = {count}, type = \"{kind}\", group = \"{name}\", nodes = {of:?} }}, ").unwrap();
                        if j == 1 - block {
                            write!(sides[block], "[{count}, \"{}\"], ", ["+y", "-y"][block])
                                .unwrap();
                        } else {
                            write!(ends[block], "[{count}, \"{}\"], ", ["-y", "+y"][block])
                                .unwrap();
                        }
                    }
                }
            }
            first += (n + 1) * 3 * deep;
        }
        let [a, b] = if self.upper {
            ["over", "under"]
        } else {
            ["under", "over"]
        };
        format!(
            "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"{}\"\n\
             [material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.0\n\
             [[body]]\ngroup = [\"lower\", \"upper\"]\nmaterial = \"m\"\n\
             [sets]\nunder = {{ faces = [{}] }}\nover = {{ faces = [{}] }}\nbase = {{ faces = [{}] }}\ntop = {{ faces = [{}] }}\n\
             [[contact]]\nname = \"c\"\nsecondary = \"{a}\"\nprimary = \"{b}\"\n{}\n\
             [solver]\nnewton = {{ force_tol = 1e-12 }}\n{}",
            ["plane-strain", "3d"][self.ndim - 2],
            sides[0],
            sides[1],
            ends[0],
            ends[1],
            self.contact,
            self.steps
        )
    }
}

fn solved(text: &str, place: &str) -> Run {
    let done = run(&mut model("wear", text, &[]));
    assert!(done.error.is_none(), "{place}: {:?}", done.error);
    done
}

fn wear(frame: &Frame) -> &Wear {
    frame.contacts[0].wear.as_ref().unwrap()
}

const WAYS: [(&str, &str); 6] = [
    ("mortar", "{ lagrange = {} }"),
    ("mortar", "{ penalty = 1e5 }"),
    ("node-to-segment", "{ lagrange = {} }"),
    ("node-to-segment", "{ penalty = 1e5, per = \"area\" }"),
    ("node-to-segment", "{ penalty = 1e4, per = \"node\" }"),
    ("gauss-point", "{ penalty = 1e5 }"),
];

/// Under a force, both sides together lose K F s, to rounding, on any mesh; where pressures are even, the depth is K p s everywhere.
#[test]
fn what_is_worn_under_a_force_is_that_times_the_way() {
    let Some(reference) = common::reference("thermal/wear_uniform.json") else {
        return;
    };
    let of = |key: &str| reference[key].as_f64().unwrap();
    let (k, p, s) = (of("K"), of("p"), of("s"));
    for ndim in [2, 3] {
        for cells in [[2, 2], [2, 3], [3, 2]] {
            for (method, enforcement) in WAYS {
                for upper in [true, false] {
                    if ndim == 3 && cells[0] == 3 {
                        continue;
                    }
                    let contact = format!(
                        "method = \"{method}\"\nenforcement = {enforcement}\nwear = {{ coefficient = {k:e}, primary = {:e} }}",
                        2.0 * k
                    );
                    let axes = if ndim == 3 { "\"x\", \"z\"" } else { "\"x\"" };
                    let steps = format!(
                        "[[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = 1\n\
                         fix = [{{ on = \"base\", u = \"all\" }}, {{ on = \"top\", u = [{axes}] }}]\n\
                         load = [{{ on = \"top\", pressure = {p:?} }}]\ncontact = [{{ name = \"c\", slip = 0.0 }}]\n\
                         [[step]]\nname = \"wear\"\ngeometry = \"linear\"\nincrements = {{ fixed = 3 }}\n\
                         contact = [{{ name = \"c\", slip = {s:?} }}]\n"
                    );
                    let place = format!("{ndim} {cells:?} {contact} {upper}");
                    let blocks = Blocks {
                        ndim,
                        cells,
                        contact: &contact,
                        upper,
                        steps: &steps,
                        beyond: 0.0,
                    };
                    let done = solved(&blocks.text(), &place);
                    let pressed = wear(&done.frames[0]);
                    assert_eq!(pressed.volume, [0.0; 2], "{place}");
                    let last = done.frames.last().unwrap();
                    let worn = wear(last);
                    for (volume, k) in worn.volume.iter().zip([k, 2.0 * k]) {
                        let exact = k * p * s;
                        assert!(
                            (volume / exact - 1.0).abs() < 1e-10,
                            "{place}: {volume} {exact}"
                        );
                    }
                    let even = !enforcement.contains("node");
                    if even && cells[0] == cells[1] || method == "mortar" {
                        for depth in &worn.depth {
                            assert!(
                                (depth / of("depth") - 1.0).abs() < 1e-9,
                                "{place}: {:?}",
                                worn.depth
                            );
                        }
                        for (_, depth) in &worn.opposite {
                            assert!(
                                (depth / (2.0 * of("depth")) - 1.0).abs() < 1e-9,
                                "{place}: {:?}",
                                worn.opposite
                            );
                        }
                    }
                }
            }
        }
    }
}

/// A layer at a fixed approach loses its pressure as backward Euler says: (1 + K M s/(t n))^−n of it is left after n increments.
#[test]
fn a_layer_at_a_fixed_approach_loses_its_pressure() {
    let Some(reference) = common::reference("thermal/wear_layer.json") else {
        return;
    };
    let exact = &reference["backward_euler"];
    for (method, enforcement) in WAYS {
        for n in [1, 2, 5, 10] {
            for of in ["secondary", "primary"] {
                // two layers with a thickness of 1 of modulus 1000; what a penalty yields is in series with them
                let penalty = match enforcement.contains("lagrange") {
                    true => f64::INFINITY,
                    // of 1/3 of the width around inner nodes, and of half of that around outer ones, where it is per node
                    false if enforcement.contains("node") => continue,
                    false => 1e5,
                };
                let stiffness = 1.0 / (2.0 / 1000.0 + 1.0 / penalty);
                let contact = format!(
                    "method = \"{method}\"\nenforcement = {enforcement}\nwear = {{ k = {:e}, hardness = 10.0, of = \"{of}\" }}",
                    10.0 / stiffness / 100.0
                );
                let steps = format!(
                    "[[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = 1\n\
                     fix = [{{ on = \"base\", u = \"all\" }}, {{ on = \"top\", u = [\"x\"] }}]\n\
                     move = [{{ on = \"top\", uy = -0.01 }}]\ncontact = [{{ name = \"c\", slip = 0.0 }}]\n\
                     [[step]]\nname = \"wear\"\ngeometry = \"linear\"\nincrements = {{ fixed = {n} }}\n\
                     contact = [{{ name = \"c\", slip = 100.0 }}]\n"
                );
                let place = format!("{contact} {n}");
                let blocks = Blocks {
                    ndim: 2,
                    cells: [3, 3],
                    contact: &contact,
                    upper: true,
                    steps: &steps,
                    beyond: 0.0,
                };
                let done = solved(&blocks.text(), &place);
                let force = |frame: &Frame| frame.contacts[0].force_normal.norm();
                let left = force(done.frames.last().unwrap()) / force(&done.frames[0]);
                let exact = exact[n.to_string()].as_f64().unwrap();
                assert!((left / exact - 1.0).abs() < 1e-9, "{place}: {left} {exact}");
            }
        }
    }
}

/// A block that is dragged wears by the way it goes, with friction and without, there and back.
#[test]
fn what_slides_wears_by_its_way() {
    for (method, enforcement) in WAYS {
        for friction in ["", "friction = 0.3"] {
            let contact = format!(
                "method = \"{method}\"\nenforcement = {enforcement}\n{friction}\nsliding = \"finite\"\n\
                 wear = {{ coefficient = 1e-5 }}"
            );
            let steps = "[[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = 1\n\
                 fix = [{ on = \"base\", u = \"all\" }, { on = \"top\", u = [\"x\"] }]\nload = [{ on = \"top\", pressure = 10.0 }]\n\
                 [[step]]\nname = \"right\"\ngeometry = \"linear\"\nincrements = { fixed = 4 }\nmove = [{ on = \"top\", ux = 0.2 }]\n\
                 [[step]]\nname = \"left\"\ngeometry = \"linear\"\nincrements = { fixed = 4 }\nmove = [{ on = \"top\", ux = 0.0 }]\n";
            // a secondary side that stays opposite the other
            let blocks = Blocks {
                ndim: 2,
                cells: [3, 2],
                contact: &contact,
                upper: true,
                steps,
                beyond: 0.3,
            };
            let done = solved(&blocks.text(), &contact);
            let volumes: Vec<f64> = done
                .frames
                .iter()
                .map(|frame| wear(frame).volume[0])
                .collect();
            // what is pressed rocks a little as it is dragged, and with friction its shear turns round first
            let exact = 1e-5 * 10.0 * 0.4;
            let least = if friction.is_empty() { 0.96 } else { 0.6 };
            let part = volumes.last().unwrap() / exact;
            assert!(least < part && part < 1.0, "{contact}: {volumes:?}");
            assert!(volumes.windows(2).all(|two| two[1] >= two[0]), "{contact}");
        }
    }
}

/// A rigid ball that is pressed and turns loses a cap of the volume K F s.
#[test]
fn a_rigid_pin_loses_a_cap() {
    let Some(reference) = common::reference("thermal/wear_pin.json") else {
        return;
    };
    let of = |key: &str| reference[key].as_f64().unwrap();
    let (n, width, radius) = (40, 1.6, 10.0_f64);
    let (mut nodes, mut elements) = (String::new(), String::new());
    let [mut faces, mut top] = [const { String::new() }; 2];
    for k in 0..=n {
        let r = width * k as f64 / n as f64;
        let z = radius - (radius * radius - r * r).sqrt();
        write!(
            nodes,
            "[{}, {r:?}, {z:?}], [{}, {r:?}, 1.0], ",
            2 * k + 1,
            2 * k + 2
        )
        .unwrap();
    }
    for k in 0..n {
        let a = 2 * k + 1;
        write!(
            elements,
            "{{ id = {}, type = \"quad4\", group = \"pin\", nodes = [{a}, {}, {}, {}] }}, ",
            k + 1,
            a + 2,
            a + 3,
            a + 1
        )
        .unwrap();
        write!(faces, "[{}, \"S1\"], ", k + 1).unwrap();
        write!(top, "[{}, \"S3\"], ", k + 1).unwrap();
    }
    let text = format!(
        "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"axisymmetric\"\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 1e7\nnu = 0.0\n[[body]]\ngroup = \"pin\"\nmaterial = \"m\"\n[sets]\nfoot = {{ faces = [{faces}] }}\ntop = {{ faces = [{top}] }}\naxis = {{ nodes = [1, 2] }}\n\
         [[surface]]\nname = \"floor\"\nshape = {{ plane = {{ point = [0, 0], normal = [0, 1] }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"foot\"\nprimary = \"floor\"\nmethod = \"node-to-segment\"\n\
         enforcement = {{ penalty = 1e6, per = \"area\" }}\nwear = {{ coefficient = 1e-7 }}\n\
         [[step]]\nname = \"press\"\nincrements = 1\ncontact = [{{ name = \"c\", slip = 0.0 }}]\n\
         fix = [{{ on = \"axis\", u = [\"x\"] }}]\nload = [{{ on = \"top\", pressure = {:?} }}]\n\
         [[step]]\nname = \"wear\"\nincrements = {{ fixed = 20 }}\ncontact = [{{ name = \"c\", slip = 1e5 }}]\n",
        20.0 / (std::f64::consts::PI * width * width)
    );
    let done = solved(&text, "pin");
    let last = done.frames.last().unwrap();
    let worn = wear(last);
    // what is worn off is no penetration: twice the size of a facet would be one
    assert!(worn.deepest > 1.9 * width / n as f64, "{}", worn.deepest);
    for frame in &done.frames {
        let failures = frame.audits.iter().flat_map(|audit| audit.failures());
        let failures: Vec<_> = failures
            .filter(|(check, _)| *check == Check::Through)
            .collect();
        assert!(failures.is_empty(), "{} {failures:?}", frame.time);
        let contact = &frame.contacts[0];
        let yields = contact.pressure_max / 1e6;
        let [deep, most] = [-contact.gap_min, yields * (1.0 + 1e-9)];
        assert!(deep <= most, "{deep} {most}");
    }
    assert!(!last.audits.is_empty());
    assert!(
        (worn.volume[0] / of("V") - 1.0).abs() < 1e-6,
        "{}",
        worn.volume[0]
    );
    assert!(
        (worn.deepest / of("h") - 1.0).abs() < 0.02,
        "{}",
        worn.deepest
    );
}

/// A cylinder on half of an elastic half-plane: worn depths at nodes by their place along it, and the volume, after so many
/// increments. Radius 1000 and force 0.2 in the place of 10 and 20: a hundredth of the depth and the pressure at the same width,
/// so that slopes are as small as the half-plane takes them.
fn scar(increments: usize) -> (Vec<[f64; 2]>, f64) {
    // even where it touches, then ever coarser up to 50 times the width of contact
    let graded = |even: f64, size: f64| {
        let mut lines = vec![0.0];
        let mut step = size;
        while lines[lines.len() - 1] < 40.0 {
            let last = lines[lines.len() - 1];
            if last > even - 1e-9 {
                step *= 1.35;
            }
            lines.push(last + step);
        }
        lines
    };
    let (across, down) = (graded(1.0, 0.025), graded(0.1, 0.025));
    let (nx, ny) = (across.len(), down.len());
    let [mut nodes, mut elements, mut faces, mut axis, mut base] = [const { String::new() }; 5];
    for (j, y) in down.iter().enumerate() {
        for (i, x) in across.iter().enumerate() {
            let node = i + nx * j + 1;
            write!(nodes, "[{node}, {x:?}, {:?}], ", -y).unwrap();
            if i == 0 {
                write!(axis, "{node}, ").unwrap();
            }
            if j == ny - 1 {
                write!(base, "{node}, ").unwrap();
            }
        }
    }
    for j in 0..ny - 1 {
        for (i, &x) in across.iter().enumerate().take(nx - 1) {
            let (element, a) = (i + (nx - 1) * j + 1, i + nx * j + 1);
            write!(
                elements,
                "{{ id = {element}, type = \"quad4\", group = \"plane\", nodes = [{}, {}, {}, {a}] }}, ",
                a + nx,
                a + nx + 1,
                a + 1
            )
            .unwrap();
            if j == 0 && x < 1.0 {
                write!(faces, "[{element}, \"S3\"], ").unwrap();
            }
        }
    }
    let text = format!(
        "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"plane-strain\"\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 910.0\nnu = 0.3\n[[body]]\ngroup = \"plane\"\nmaterial = \"m\"\n\
         [sets]\nface = {{ faces = [{faces}] }}\naxis = {{ nodes = [{axis}] }}\nbase = {{ nodes = [{base}] }}\n\
         [reference.tool]\nat = [0, 0]\n\
         [[surface]]\nname = \"cylinder\"\nreference = \"tool\"\nshape = {{ circle = {{ center = [0, 1000], radius = 1000.0 }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"face\"\nprimary = \"cylinder\"\nmethod = \"node-to-segment\"\n\
         enforcement = {{ penalty = 1e7, per = \"area\" }}\nwear = {{ coefficient = 1e-7, limit = 1.0 }}\n\
         [[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = 2\ncontact = [{{ name = \"c\", slip = 0.0 }}]\n\
         fix = [{{ on = \"axis\", u = [\"x\"] }}, {{ on = \"base\", u = [\"y\"] }}, {{ on = \"tool\", u = [\"x\"], rot = \"all\" }}]\n\
         load = [{{ on = \"tool\", force = [0.0, -0.1, 0.0] }}]\n\
         [[step]]\nname = \"wear\"\ngeometry = \"linear\"\nincrements = {{ fixed = {increments} }}\ncontact = [{{ name = \"c\", slip = 8000.0 }}]\n"
    );
    let done = solved(&text, "scar");
    let last = &done.frames.last().unwrap().contacts[0];
    let worn = wear(done.frames.last().unwrap());
    let places = last.points.iter().zip(&last.displacement);
    let depths = places
        .zip(&worn.depth)
        .map(|((x, u), depth)| [x.x - u.x, *depth]);
    (depths.collect(), worn.volume[0])
}

/// `wear_cylinder.json`: the depth to 0.2 % as increments shrink, no further off before than there, the width to an element, the volume to
/// rounding and the cosines of slopes.
#[test]
#[cfg_attr(debug_assertions, ignore = "takes its time without optimization")]
fn a_cylinder_wears_its_scar_into_a_half_plane() {
    let Some(reference) = common::reference("thermal/wear_cylinder.json") else {
        return;
    };
    let of = |key: &str| reference[key].as_f64().unwrap();
    let off = [10, 20].map(|increments| {
        let (depths, volume) = scar(increments);
        let what = format!("{increments}");
        let exact = 0.01 * of("volume");
        assert!(
            (2.0 * volume / exact - 1.0).abs() < 1e-6,
            "{what}: {volume}"
        );
        let worn = depths.iter().filter(|[_, depth]| *depth > 0.0);
        let width = worn.map(|[x, _]| *x).fold(0.0, f64::max);
        assert!((width - of("half_width")).abs() < 0.026, "{what}: {width}");
        let center = depths.iter().find(|[x, _]| x.abs() < 1e-9).unwrap();
        100.0 * center[1] / of("depth") - 1.0
    });
    // backward Euler is 1.2 and 0.63 % off there
    assert!(off[0].abs() < 0.012 && off[1].abs() < 0.0063, "{off:?}");
    let limit = 2.0 * off[1] - off[0];
    assert!(limit.abs() < 2e-3, "{limit}");
}

/// A block at a fixed approach that slides to and fro on another one, and loses its pressure as it wears.
fn reciprocating(count: usize, cycle: &str) -> String {
    let contact = "method = \"node-to-segment\"\nenforcement = { penalty = 1e4, per = \"area\" }\n\
         wear = { coefficient = 2e-5, limit = 1.0 }\nstart = { interference = \"now\" }";
    let steps = format!(
        "[[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = 1\n\
         fix = [{{ on = \"base\", u = \"all\" }}, {{ on = \"top\", u = [\"x\"] }}]\n\
         move = [{{ on = \"top\", uy = -0.01 }}]\n\
         [[step]]\nname = \"right\"\ngeometry = \"linear\"\nincrements = 1\nmove = [{{ on = \"top\", ux = 0.1 }}]\n\
         [[step]]\nname = \"left\"\ngeometry = \"linear\"\nincrements = 1\nmove = [{{ on = \"top\", ux = 0.0 }}]\n\
         [[cycle]]\nsteps = [\"right\", \"left\"]\ncount = {count}\n{cycle}\n[checkpoint]\nevery = {{ increments = 1 }}\n"
    );
    let blocks = Blocks {
        ndim: 2,
        cells: [3, 2],
        contact,
        upper: true,
        steps: &steps,
        beyond: 0.3,
    };
    blocks.text()
}

/// One cycle that stands for many gives the depths of all of them, at a tenth of the solutions.
#[test]
#[ignore = "long"]
fn a_cycle_stands_for_many() {
    let count = 400;
    let each = solved(&reciprocating(count, ""), "each");
    let jumps = solved(
        &reciprocating(count, "jump = { tol = 0.005, first = 3 }"),
        "jumps",
    );
    let (exact, found) = (each.frames.last().unwrap(), jumps.frames.last().unwrap());
    assert_eq!(each.increments.len(), 1 + 2 * count);
    let solutions = [&each, &jumps].map(|run| run.iterations.len());
    assert!(solutions[1] < solutions[0] / 10, "{solutions:?}");
    assert_eq!([exact.cycles, found.cycles], [count as f64; 2]);
    // pressure falls to a part of what it was
    let force = |frame: &Frame| frame.contacts[0].force_normal.norm();
    assert!(force(exact) < 0.8 * force(&each.frames[0]));
    for (one, other) in wear(exact).depth.iter().zip(&wear(found).depth) {
        assert!((other / one - 1.0).abs() < 0.01, "{one} {other}");
    }
    // as deep at most in each as is said
    let capped = solved(
        &reciprocating(count, "jump = { tol = 1.0, first = 1, max_wear = 2e-4 }"),
        "capped",
    );
    let deepest: Vec<f64> = capped
        .frames
        .iter()
        .map(|frame| wear(frame).deepest)
        .collect();
    assert!(
        deepest.windows(3).all(|w| w[2] - w[0] < 3e-4),
        "{deepest:?}"
    );
}

/// What a resumed run wears is what it would have, to the last bit, in cycles that jump, too.
#[test]
fn a_resumed_run_wears_the_same() {
    for cycle in ["", "jump = { tol = 0.01, first = 1 }"] {
        let text = reciprocating(12, cycle);
        let whole = stopped_after(&text, &[]);
        for stops in [&[3][..], &[6, 9]] {
            assert_eq!(whole, stopped_after(&text, stops), "{cycle} {stops:?}");
        }
    }
}

/// Cycles that make no sense are refused by name, as is what does not wear.
#[test]
fn what_does_not_wear_is_said() {
    let text = reciprocating(3, "jump = {}");
    for (from, to, says) in [
        (
            "wear = { coefficient = 2e-5, limit = 1.0 }",
            "",
            "nothing wears",
        ),
        (
            "[\"right\", \"left\"]",
            "[\"left\", \"right\"]",
            "do not follow one another",
        ),
        (
            "[\"right\", \"left\"]",
            "[\"right\", \"up\"]",
            "there is no step \"up\"",
        ),
        (
            "limit = 1.0",
            "of = \"primary\", primary = 1e-7",
            "two coefficients of one side",
        ),
        ("limit = 1.0", "k = 1e-4", "coefficient"),
        (
            "start = { interference = \"now\" }",
            "passes = 2",
            "would wear twice",
        ),
        (
            "start = { interference = \"now\" }",
            "tied = true",
            "joined",
        ),
    ] {
        assert!(text.contains(from), "{from}");
        let said = refusal(&text.replace(from, to));
        assert!(said.contains(says), "{says}: {said}");
    }
}

/// Why a case is refused.
fn refusal(text: &str) -> String {
    let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default());
    let built = opened
        .and_then(|opened| opened.with_mesh())
        .and_then(|loaded| build(loaded.case, loaded.mesh).map(drop));
    built.err().map_or_else(String::new, |found| found.plain())
}

/// The history of a run that was stopped after so many pieces of news, again and again, and resumed.
fn stopped_after(text: &str, stops: &[usize]) -> String {
    let fs: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let mut folder = PathBuf::new();
    for (part, stop) in stops.iter().map(Some).chain([None]).enumerate() {
        let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default()).unwrap();
        let loaded = opened.with_mesh().unwrap();
        let mut options = RunOptions::new(loaded.source);
        (options.fs, options.resume) = (Arc::clone(&fs), part > 0);
        folder = options.folder.clone();
        let mut model = build(loaded.case, loaded.mesh).unwrap();
        let mut count = 0;
        let finished = signorini::run(&mut model, &options, &mut |_: &News<'_>| {
            count += 1;
            match stop {
                Some(&stop) if count >= stop => Flow::Stop,
                _ => Flow::Continue,
            }
        });
        let wanted = if stop.is_some() { 130 } else { 0 };
        assert_eq!(
            finished.exit_code,
            wanted,
            "{}",
            finished.diagnostics.plain()
        );
    }
    String::from_utf8(fs.read(&folder.join("history.csv")).unwrap()).unwrap()
}
