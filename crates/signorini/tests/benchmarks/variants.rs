//! Bodies that only contact holds, in a hundred ways.
//!
//! SOURCE      Written for the purpose.
//! GOAL        default settings find the contact and follow it, whatever the friction, the gap, the way of loading, the number of
//!             increments, the element and its size
//! MESH        *Block*: 1 × 1 (× 1) on a base of 3 × 1 (3 × 3 × 1), which do not match, of quad4, quad8, tri6, hex8, hex20 or
//!             tet10, in one of two sizes. *Pin*: rings of quad4, 32 or 64 around
//! CONDITIONS  small strain, E = 210,000, nu = 0.3; friction 0 to 0.6; from an overlap of half an element to a gap of two. The load
//!             is a force on a face, or one for each node, in one or ten increments. The block then is pushed sideways by half of
//!             what friction bears, or moved sideways until it slides
//! EXPECTED    contact bears the load; the block that is moved bears mu times it, or half of it, where it tips over an edge
//! TOLERANCE   95 of 100 solved, with at most two cut-backs; 1e-4 of the load, 1e-3 of the drag
use crate::common::{Run, run};
use crate::pin::Pin;
use crate::random::Random;
use crate::scene::{Case, Scene};
use signorini_geometry::tensor::Vec3;

const LOAD: f64 = 100.0;

/// What is left to choose of a model.
#[derive(Clone, Copy, Debug)]
struct Variant {
    mu: f64,
    /// Over the size of an element.
    gap: f64,
    on_nodes: bool,
    increments: usize,
    is_fine: bool,
}

fn variant(random: &mut Random) -> Variant {
    Variant {
        mu: random.of(&[0.0, 0.1, 0.2, 0.4, 0.6]),
        gap: random.of(&[-0.5, -0.1, 0.0, 0.01, 0.5, 2.0]),
        on_nodes: random.next() < 0.5,
        increments: random.of(&[1, 10]),
        is_fine: random.next() < 0.5,
    }
}

/// A block on a base, pressed and then pushed or moved sideways.
fn block(element: &'static str, variant: Variant, moved: bool) -> Case {
    let Variant {
        mu,
        gap,
        on_nodes,
        increments,
        is_fine,
    } = variant;
    let flat = matches!(element, "quad4" | "quad8" | "tri6");
    let n = match (flat, element) {
        (true, "quad4") => 4,
        (true, _) | (false, "hex8") => 3,
        (false, _) => 1,
    };
    let n = if is_fine { 2 * n } else { n };
    let up = if flat { 1 } else { 2 };
    let foot = gap / n as f64;
    let mut scene = Scene::default();
    let cells = |n: usize, height: usize| if flat { [n, height, 0] } else { [n, n, height] };
    let place = |at: [usize; 3], n: [usize; 2], from: [f64; 2], size: [f64; 2]| {
        let across = |k: usize| from[0] + size[0] * k as f64 / n[0] as f64;
        let level = from[1] + size[1] * at[up] as f64 / n[1] as f64;
        match flat {
            true => Vec3::new(across(at[0]), level, 0.0),
            false => Vec3::new(across(at[0]), across(at[1]), level),
        }
    };
    // three elements of the base for two of the block, about
    let wide = (2 * n).max(3) + 1;
    scene.straight("base", element, cells(wide, n), |at| {
        place(at, [wide, n], [-1.0, -1.0], [3.0, 1.0])
    });
    scene.straight("block", element, cells(n, n), |at| {
        place(at, [n, n], [0.0, foot], [1.0, 1.0])
    });
    for (name, group, level) in [("under", "base", 0.0), ("over", "block", foot)] {
        let facets = scene.facets(group, up, level);
        let faces: Vec<(usize, String)> = facets
            .iter()
            .map(|((cell, side), ..)| (*cell, format!("S{side}")))
            .collect();
        let faces: Vec<(usize, &str)> = faces.iter().map(|(c, s)| (*c, s.as_str())).collect();
        scene.faces(name, &faces);
    }
    let axes = if flat { "xy" } else { "xyz" };
    let axis = &axes[up..];
    scene.place("top", &format!("plane = \"{axis}\", at = {:?}", foot + 1.0));
    scene.place("bottom", &format!("plane = \"{axis}\", at = -1.0"));
    let top = scene.facets("block", up, foot + 1.0);
    let mut nodes: Vec<usize> = top.iter().flat_map(|(.., nodes)| nodes.clone()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let load = |x: f64, z: f64| {
        let (key, parts) = match on_nodes {
            true => ("per_node", nodes.len() as f64),
            false => ("force", 1.0),
        };
        let (x, z) = (x / parts, z / parts);
        match flat {
            true => format!("{key} = [{x:?}, {z:?}]"),
            false => format!("{key} = [{x:?}, 0.0, {z:?}]"),
        }
    };
    let friction = if mu > 0.0 {
        format!("friction = {mu:?}")
    } else {
        String::new()
    };
    let case = scene
        .elastic(if flat { "plane-strain" } else { "3d" }, 210e3, 0.3)
        .body(&["base", "block"], "")
        .contact("over", "under", &friction)
        .step("press", increments)
        .fix("bottom", axes)
        .load("top", &load(0.0, -LOAD));
    // nothing else holds sideways what slides without friction
    let case = if mu > 0.0 {
        case
    } else {
        case.fix("top", &axes[..up])
    };
    let case = case.step("push", increments);
    match moved {
        true => case.displace("top", "ux = 0.1"),
        false => case.load("top", &load(0.5 * mu * LOAD, 0.0)),
    }
}

/// What is wrong with the forces of a block.
fn wrong(run: &Run, variant: Variant, moved: bool, flat: bool) -> Option<String> {
    let force = run.contact_force(run.frames.len());
    let normal = force[if flat { 1 } else { 2 }].abs();
    // as high as wide, it tips over its edge at half its load
    let (drag, within) = match moved {
        true => (variant.mu.min(0.5), 1e-3),
        false => (0.5 * variant.mu, 1e-4),
    };
    let off = (force[0].abs() - drag * LOAD).abs();
    ((normal - LOAD).abs() > 1e-4 * LOAD || off > within * LOAD).then(|| format!("force {force:?}"))
}

/// Variant number `seed`: its description, and its fault.
fn tried(seed: u64) -> (String, Option<String>) {
    let mut random = Random(seed);
    let variant = variant(&mut random);
    let is_pin = random.next() < 0.3;
    let (what, run, wrong) = if is_pin {
        let around = if variant.is_fine { 64 } else { 32 };
        let pin = Pin {
            around,
            clearance: variant.gap * 60.0 / around as f64,
            mu: variant.mu,
            on_nodes: variant.on_nodes,
            increments: variant.increments,
        };
        let run = run(&mut pin.case().model(&[]));
        let wrong = (!run.frames.is_empty()).then(|| pin.wrong(&run)).flatten();
        (format!("pin {variant:?}"), run, wrong)
    } else {
        let element = random.of(&["quad4", "quad8", "tri6", "hex8", "hex20", "tet10"]);
        let flat = matches!(element, "quad4" | "quad8" | "tri6");
        let moved = random.next() < 0.5;
        let run = run(&mut block(element, variant, moved).model(&[]));
        let wrong = (!run.frames.is_empty())
            .then(|| wrong(&run, variant, moved, flat))
            .flatten();
        let course = if moved { "moved" } else { "pushed" };
        (format!("{element} {course} {variant:?}"), run, wrong)
    };
    let cuts = run.cutbacks.len();
    let wrong = match &run.error {
        Some(error) => Some(error.to_string()),
        None if cuts > 2 => Some(format!("{cuts} cuts")),
        None => wrong,
    };
    let solves = run.iterations.len();
    (
        format!("{seed}: {what}, {solves} solves, {cuts} cuts"),
        wrong,
    )
}

/// Those of these variants that are not solved.
fn unsolved(seeds: std::ops::Range<u64>) -> Vec<String> {
    let all = seeds.map(|seed| {
        let (what, wrong) = tried(seed);
        if std::env::var_os("SHOW_VARIANTS").is_some() {
            println!("{what}: {wrong:?}");
        }
        wrong.map(|wrong| format!("{what}: {wrong}"))
    });
    all.flatten().collect()
}

#[test]
fn of_twenty_bodies_that_only_contact_holds_at_most_one_is_not_solved() {
    let unsolved = unsolved(1..21);
    assert!(unsolved.len() <= 1, "{}", unsolved.join("\n"));
}

/// 40 more, or as many as `BODIES_HELD=100` asks for.
#[test]
#[ignore = "takes a minute: run by .ci/run"]
fn of_many_more_bodies_that_only_contact_holds_at_least_95_in_100_are_solved() {
    let asked = std::env::var("BODIES_HELD").unwrap_or_else(|_| "40".into());
    let count: u64 = asked.parse().unwrap();
    let unsolved = unsolved(21..21 + count);
    println!("{}", unsolved.join("\n"));
    assert!(
        20 * unsolved.len() as u64 <= count,
        "{}",
        unsolved.join("\n")
    );
}
