//! Plane bodies whose thickness is given at nodes.
//!
//! SOURCE      Written for the purpose.
//! GOAL        stiffness, pressures, weights, and areas of contact count the thickness of each place
//! MESH        two blocks, one on the other, of quad4, quad8 and tri3, whose thickness grows along x
//! CONDITIONS  pressed by a pressure and by weight, without a Poisson effect: a column at every x
//! EXPECTED    the stress of a column; forces by integrals of the thickness
//! TOLERANCE   1e-9; 2e-4 where points hold by a penalty, and of triangles at finite strain, which spread a little
//!             (found 8e-6)
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::{Run, model, run};
use signorini::{Reading, build, load};
use std::fmt::Write;

/// What blocks are made of, and how they touch.
#[derive(Clone, Copy, Debug)]
struct Way {
    element: &'static str,
    /// Cells along x of the lower and the upper block.
    cells: [usize; 2],
    method: &'static str,
    enforcement: &'static str,
    upper_is_secondary: bool,
    space: &'static str,
    geometry: &'static str,
}

const WIDTH: f64 = 2.0;
const PRESSURE: f64 = 3.0;
const WEIGHT: f64 = 0.5;
const MODULUS: f64 = 1000.0;

/// The thickness at a place.
fn thickness(x: f64) -> f64 {
    0.4 + 0.3 * x
}

/// The mesh of both blocks.
#[derive(Default)]
struct Blocks {
    /// Numbers and places of nodes.
    nodes: Vec<(usize, [f64; 2])>,
    /// Numbers, groups and nodes of elements.
    elements: Vec<(usize, &'static str, Vec<usize>)>,
    /// Faces at the lower and at the upper end of each block.
    ends: [[Vec<String>; 2]; 2],
    nnumber: usize,
}

impl Blocks {
    fn new(way: &Way) -> Self {
        let mut blocks = Self::default();
        blocks.add(way, 0);
        blocks.add(way, 1);
        blocks
    }

    /// Adds the lower or the upper block, of height 1.
    fn add(&mut self, way: &Way, of: usize) {
        let per = if way.element == "quad8" { 2 } else { 1 };
        let (nx, ny) = (way.cells[of] * per, 2 * per);
        let first = self.nnumber;
        self.nnumber += (nx + 1) * (ny + 1);
        let node = |i: usize, j: usize| first + j * (nx + 1) + i + 1;
        for j in 0..=ny {
            for i in 0..=nx {
                if per == 1 || i % 2 == 0 || j % 2 == 0 {
                    let x = WIDTH * i as f64 / nx as f64;
                    let y = of as f64 + j as f64 / ny as f64;
                    self.nodes.push((node(i, j), [x, y]));
                }
            }
        }
        for j in (0..ny).step_by(per) {
            for i in (0..nx).step_by(per) {
                let (a, b) = (i + per, j + per);
                let corners = [node(i, j), node(a, j), node(a, b), node(i, b)];
                let [p, q, r, s] = corners;
                let all: Vec<Vec<usize>> = match way.element {
                    "quad8" => {
                        let below = [node(i + 1, j), node(a, j + 1)];
                        let above = [node(i + 1, b), node(i, j + 1)];
                        vec![[&corners[..], &below, &above].concat()]
                    }
                    "tri3" => vec![vec![p, q, r], vec![p, r, s]],
                    _ => vec![corners.to_vec()],
                };
                let lowest = self.elements.len() + 1;
                for nodes in all {
                    let id = self.elements.len() + 1;
                    self.elements.push((id, ["lower", "upper"][of], nodes));
                }
                let highest = self.elements.len();
                if j == 0 {
                    self.ends[of][0].push(format!("[{lowest}, \"-y\"]"));
                }
                if b == ny {
                    self.ends[of][1].push(format!("[{highest}, \"+y\"]"));
                }
            }
        }
    }
}

/// The case of two blocks.
fn blocks(way: &Way) -> String {
    let Blocks {
        nodes,
        elements,
        ends,
        ..
    } = Blocks::new(way);
    let (mut mesh, mut field) = (String::from("nodes = [\n"), String::new());
    for (id, [x, y]) in &nodes {
        writeln!(mesh, "[{id}, {x}, {y}],").unwrap();
        writeln!(
            field,
            "[[thickness]]\non = \"n{id}\"\nvalue = {}",
            thickness(*x)
        )
        .unwrap();
        writeln!(field, "[sets.n{id}]\nnodes = [{id}]").unwrap();
    }
    mesh.push_str("]\nelements = [\n");
    for (id, group, nodes) in &elements {
        let kind = way.element;
        writeln!(
            mesh,
            "{{ id = {id}, type = \"{kind}\", group = \"{group}\", nodes = {nodes:?} }},"
        )
        .unwrap();
    }
    let [[_, seat], [foot, top]] = ends.map(|of| of.map(|faces| faces.join(", ")));
    let sides = match way.upper_is_secondary {
        true => "secondary = \"foot\"\nprimary = \"seat\"",
        false => "secondary = \"seat\"\nprimary = \"foot\"",
    };
    let Way {
        method,
        enforcement,
        space,
        geometry,
        ..
    } = way;
    format!(
        "format = 1\n[mesh]\n{mesh}]\n[model]\nspace = \"{space}\"\n\
         [sets]\nseat = {{ faces = [{seat}] }}\nfoot = {{ faces = [{foot}] }}\ntop = {{ faces = [{top}] }}\n\
         bottom = {{ box = [[-1.0, -1e-6], [9.0, 1e-6]] }}\nleft = {{ box = [[-1e-6, -1.0], [1e-6, 9.0]] }}\n\
         {field}[material.m]\nmodel = \"linear-elastic\"\nE = {MODULUS}\nnu = 0.0\ndensity = 1.0\n\
         [[body]]\ngroup = \"lower\"\nmaterial = \"m\"\nthickness = \"field\"\n\
         [[body]]\ngroup = \"upper\"\nmaterial = \"m\"\nthickness = \"field\"\n\
         [[contact]]\nname = \"joint\"\n{sides}\nmethod = \"{method}\"\nenforcement = {enforcement}\n\
         [[step]]\nname = \"press\"\ngeometry = \"{geometry}\"\n[[step.fix]]\non = \"bottom\"\nu = [\"y\"]\n\
         [[step.fix]]\non = \"left\"\nu = [\"x\"]\n\
         [[step.load]]\non = \"top\"\npressure = {PRESSURE}\n\
         [[step.load]]\non = \"all\"\ngravity = [0.0, -{WEIGHT}]\n"
    )
}

fn pressed(way: &Way) -> Run {
    let mut model = model("thickness.toml", &blocks(way), &[]);
    let run = run(&mut model);
    assert!(run.error.is_none(), "{way:?}: {:?}", run.error);
    run
}

/// The integral of the thickness along x.
fn area() -> f64 {
    thickness(0.5 * WIDTH) * WIDTH
}

#[test]
fn a_column_of_two_blocks_is_pressed_as_its_thickness_says() {
    let elements = ["quad4", "quad8", "tri3"];
    let planes = ["plane-stress", "plane-strain"];
    let methods = [
        ("node-to-segment", "{ lagrange = {} }", [3, 3], 1e-9),
        ("node-to-segment", "{ penalty = \"auto\" }", [3, 3], 2e-4),
        ("gauss-point", "{ penalty = \"auto\" }", [3, 3], 2e-4),
        ("mortar", "{ lagrange = {} }", [3, 3], 1e-9),
    ];
    for element in elements {
        for (method, enforcement, cells, tolerance) in methods {
            for (k, space) in planes.into_iter().enumerate() {
                for upper_is_secondary in [true, false] {
                    let geometry = ["linear", "nonlinear"][k];
                    let way = Way {
                        element,
                        cells,
                        method,
                        enforcement,
                        upper_is_secondary,
                        space,
                        geometry,
                    };
                    // triangles spread a little under their weight, and the pressure acts on the present width
                    let spreads = element == "tri3" && geometry == "nonlinear";
                    judge(&way, if spreads { 2e-4 } else { tolerance });
                }
            }
        }
    }
}

fn judge(way: &Way, tolerance: f64) {
    let run = pressed(way);
    let frame = run.frames.last().unwrap();
    let contact = &frame.contacts[0];
    let weight = WEIGHT * area();
    let force = PRESSURE * area() + weight;
    let sign = if way.upper_is_secondary { 1.0 } else { -1.0 };
    let found = sign * contact.secondary.force.y;
    let close = |found: f64, expected: f64, what: &str| {
        let error = (found - expected).abs() / expected.abs();
        assert!(error < tolerance, "{way:?}: {what} {found}, not {expected}");
    };
    close(found, force, "force of contact");
    let nodes = Blocks::new(way).nodes;
    let below = nodes.iter().zip(&frame.reaction_force);
    let below = below.filter(|((_, [_, y]), _)| *y == 0.0);
    let held: f64 = below.map(|(_, r)| r.y).sum();
    close(held, force + weight, "reaction");
    if way.element != "tri3" && tolerance < 1e-6 && way.geometry == "linear" {
        close(lowest(&run), TOP, "displacement");
    }
}

/// Displacement of the top of a column whose stress is -p - g (2 - y), at every x.
const TOP: f64 = -2.0 * (PRESSURE + WEIGHT) / MODULUS;

fn lowest(run: &Run) -> f64 {
    let displacement = run.frames.last().unwrap().displacement.iter();
    displacement.map(|u| u.y).fold(0.0, f64::min)
}

/// Rows of mortar contact count the thickness of their nodes, not that of each place: where meshes do not match, what is
/// handed on is right to second order.
#[test]
fn mortar_contact_of_different_meshes_converges_with_second_order() {
    for element in ["quad4", "quad8"] {
        for upper_is_secondary in [true, false] {
            let error = |refinement: usize| {
                let way = Way {
                    element,
                    cells: [3, 2].map(|n| n * refinement),
                    method: "mortar",
                    enforcement: "{ lagrange = {} }",
                    upper_is_secondary,
                    space: "plane-stress",
                    geometry: "linear",
                };
                judge(&way, 2e-2);
                (lowest(&pressed(&way)) - TOP).abs()
            };
            let [coarse, fine] = [1, 4].map(error);
            println!("{element} {upper_is_secondary}: {coarse:e} {fine:e}");
            assert!(fine < coarse / 8.0 || coarse < 1e-12, "{coarse} {fine}");
        }
    }
}

#[test]
fn a_node_without_a_thickness_and_a_thickness_for_nobody_are_reported() {
    let way = Way {
        element: "quad4",
        cells: [1, 1],
        method: "gauss-point",
        enforcement: "{ penalty = \"auto\" }",
        upper_is_secondary: true,
        space: "plane-stress",
        geometry: "linear",
    };
    let whole = blocks(&way);
    let folder = tempfile::tempdir().unwrap();
    let found = |text: &str| {
        let file = folder.path().join("case.toml");
        std::fs::write(&file, text).unwrap();
        let loaded = load(&file, &Reading::default());
        let loaded = loaded.unwrap_or_else(|found| panic!("{}", found.plain()));
        match build(loaded.case, loaded.mesh) {
            Ok(model) => (true, model.warnings.plain()),
            Err(found) => (false, found.plain()),
        }
    };
    let one = "[[thickness]]\non = \"n3\"\nvalue = 0.4\n";
    assert!(whole.contains(one));
    let (is_built, text) = found(&whole.replace(one, ""));
    assert!(!is_built && text.contains("node 3 has none"), "{text}");
    let mut none = whole.clone();
    while let Some(at) = none.find("[[thickness]]") {
        let end = at + none[at..].find("[sets").unwrap();
        none.replace_range(at..end, "");
    }
    let (is_built, text) = found(&none);
    assert!(!is_built && text.contains("the case gives none"), "{text}");
    let (is_built, text) = found(&whole.replace("thickness = \"field\"", "thickness = 1.0"));
    assert!(is_built && text.contains("that change nothing"), "{text}");
}
