//! Cases of one sheet: a grid of shells with sets at its edges.

use crate::common::{Run, model, run};
use signorini::setup::Model;
use std::f64::consts::PI;
use std::fmt::Write;

/// Elements of a grid.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Quad4,
    Tri3,
}

/// A case that is being written.
pub struct Sheet {
    mesh: String,
    sets: String,
    pub thickness: f64,
    /// Of steel of this modulus and Poisson's ratio, and density.
    pub material: [f64; 3],
    pub nonlinear: Option<usize>,
    pub rest: String,
    /// More about the shell.
    pub shell: String,
    columns: usize,
}

/// A sheet of `nx` by `ny` cells over the unit square, mapped into space. Edges are `x0`, `x1`, `y0`, `y1`.
pub fn grid(nx: usize, ny: usize, kind: Kind, map: impl Fn(f64, f64) -> [f64; 3]) -> Sheet {
    let label = |i: usize, j: usize| j * (nx + 1) + i + 1;
    let mut mesh = String::from("[mesh]\nnodes = [\n");
    for j in 0..=ny {
        for i in 0..=nx {
            let [x, y, z] = map(i as f64 / nx as f64, j as f64 / ny as f64);
            writeln!(mesh, "[{}, {x:?}, {y:?}, {z:?}],", label(i, j)).unwrap();
        }
    }
    mesh += "]\nelements = [\n";
    let mut number = 0;
    for j in 0..ny {
        for i in 0..nx {
            let [a, b, c, d] = [
                label(i, j),
                label(i + 1, j),
                label(i + 1, j + 1),
                label(i, j + 1),
            ];
            let cells = match kind {
                Kind::Quad4 => vec![("quad4", vec![a, b, c, d])],
                Kind::Tri3 => vec![("tri3", vec![a, b, c]), ("tri3", vec![a, c, d])],
            };
            for (kind, nodes) in cells {
                number += 1;
                writeln!(
                    mesh,
                    "{{ id = {number}, type = \"{kind}\", group = \"sheet\", nodes = {nodes:?} }},"
                )
                .unwrap();
            }
        }
    }
    mesh += "]\n";
    let along_x = |j: usize| (0..=nx).map(|i| label(i, j)).collect::<Vec<_>>();
    let along_y = |i: usize| (0..=ny).map(|j| label(i, j)).collect::<Vec<_>>();
    let edges = [
        ("y0", along_x(0)),
        ("y1", along_x(ny)),
        ("x0", along_y(0)),
        ("x1", along_y(nx)),
    ];
    let mut sheet = Sheet {
        mesh,
        sets: String::new(),
        thickness: 1.0,
        material: [1.0, 0.3, 1.0],
        nonlinear: None,
        rest: String::new(),
        shell: String::new(),
        columns: nx + 1,
    };
    for (name, nodes) in edges {
        sheet.set(name, &nodes);
    }
    sheet
}

impl Sheet {
    /// The number of the node at a place of the grid.
    pub fn label(&self, i: usize, j: usize) -> usize {
        j * self.columns + i + 1
    }

    /// Names nodes.
    pub fn set(&mut self, name: &str, nodes: &[usize]) {
        writeln!(self.sets, "[sets.{name}]\nnodes = {nodes:?}").unwrap();
    }

    /// Holds displacements and rotations of a set: `"xz"`, `""`.
    pub fn fix(&mut self, on: &str, u: &str, rot: &str) {
        writeln!(self.rest, "[[step.fix]]\non = \"{on}\"").unwrap();
        for (key, axes) in [("u", u), ("rot", rot)] {
            let axes: Vec<String> = axes.chars().map(String::from).collect();
            if !axes.is_empty() {
                writeln!(self.rest, "{key} = {axes:?}").unwrap();
            }
        }
    }

    /// A load.
    pub fn load(&mut self, on: &str, what: &str) {
        writeln!(self.rest, "[[step.load]]\non = \"{on}\"\n{what}").unwrap();
    }

    /// The text of the case, with more in front of the step.
    pub fn text(&self, before: &str) -> String {
        let [modulus, ratio, density] = self.material;
        let (geometry, increments) = match self.nonlinear {
            Some(count) => ("nonlinear", count),
            None => ("linear", 1),
        };
        format!(
            "{}{}[model]\nspace = \"3d\"\n[material.m]\nmodel = \"linear-elastic\"\nE = {modulus:?}\nnu = {ratio:?}\n\
             density = {density:?}\n[[body]]\ngroup = \"sheet\"\nmaterial = \"m\"\n\
             shell = {{ thickness = {:?}{} }}\n{before}[[step]]\nname = \"s\"\ngeometry = \"{geometry}\"\n\
             increments = {increments}\n{}",
            self.sets, self.mesh, self.thickness, self.shell, self.rest
        )
    }

    /// Runs it.
    pub fn solve(&self) -> Solved {
        self.solve_with("")
    }

    pub fn solve_with(&self, before: &str) -> Solved {
        let mut model = model("sheet.toml", &self.text(before), &[]);
        let run = run(&mut model);
        assert!(run.error.is_none(), "{:?}", run.error);
        Solved { model, run }
    }
}

/// What came of it.
pub struct Solved {
    pub model: Model,
    pub run: Run,
}

impl Solved {
    /// The displacement of a node at the end.
    pub fn at(&self, label: usize) -> [f64; 3] {
        let node = self.model.node(label as u64).unwrap();
        self.run.frames.last().unwrap().displacement[node as usize].to_array()
    }

    /// Iterations of the whole run.
    pub fn iterations(&self) -> usize {
        self.run.increments.iter().map(|i| i.iterations).sum()
    }
}

/// Whether a ratio is 1 within a part.
#[track_caller]
pub fn close(got: f64, wanted: f64, part: f64) {
    assert!((got / wanted - 1.0).abs() < part, "{got} is not {wanted}");
}

/// Cosine and sine of a part of a right angle.
pub fn quarter(part: f64) -> [f64; 2] {
    let angle = 0.5 * PI * part;
    [angle.cos(), angle.sin()]
}
