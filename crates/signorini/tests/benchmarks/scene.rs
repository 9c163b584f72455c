//! Meshes made in a test, written as the text of a case.

use crate::common::{Run, model, run};
use signorini::setup::Model;
use signorini_geometry::element::{Element, by_name};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;
use std::fmt::Write;

/// The material "m" of bodies at finite strain, as a table of a case.
pub const RUBBER: &str = "[material.m]\nmodel = \"neo-hookean\"\nE = 1000.0\nnu = 0.3";

/// Nodes, cells and sets.
#[derive(Default)]
pub struct Scene {
    nodes: Vec<Vec<f64>>,
    cells: Vec<(&'static str, String, Vec<usize>)>,
    sets: String,
}

/// A structured grid of quadrilaterals: labels of corner nodes row by row, and of cells.
pub struct Grid {
    pub nodes: Vec<Vec<usize>>,
    cells: Vec<Vec<usize>>,
}

/// A side of a grid.
#[derive(Clone, Copy)]
pub enum Side {
    Bottom,
    Right,
    Top,
    Left,
}

impl Grid {
    /// The faces of a side: cell, and Abaqus's name of its side.
    pub fn faces(&self, side: Side) -> Vec<(usize, &'static str)> {
        let rows = &self.cells;
        let column = |j: usize| rows.iter().map(move |row| row[j]);
        let last = rows[0].len() - 1;
        match side {
            Side::Bottom => rows[0].iter().map(|c| (*c, "S1")).collect(),
            Side::Right => column(last).map(|c| (c, "S2")).collect(),
            Side::Top => rows[rows.len() - 1].iter().map(|c| (*c, "S3")).collect(),
            Side::Left => column(0).map(|c| (c, "S4")).collect(),
        }
    }

    /// Labels of the corner nodes along a side.
    pub fn along(&self, side: Side) -> Vec<usize> {
        let rows = &self.nodes;
        let last = rows[0].len() - 1;
        match side {
            Side::Bottom => rows[0].clone(),
            Side::Top => rows[rows.len() - 1].clone(),
            Side::Left => rows.iter().map(|row| row[0]).collect(),
            Side::Right => rows.iter().map(|row| row[last]).collect(),
        }
    }
}

impl Scene {
    /// A node; its label.
    pub fn node(&mut self, x: &[f64]) -> usize {
        self.nodes.push(x.to_vec());
        self.nodes.len()
    }

    /// Where a node is.
    pub fn at(&self, label: usize) -> &[f64] {
        &self.nodes[label - 1]
    }

    /// How many cells there are.
    pub fn ncell(&self) -> usize {
        self.cells.len()
    }

    /// A cell; its label.
    pub fn cell(&mut self, element: &'static str, group: &str, nodes: Vec<usize>) -> usize {
        self.cells.push((element, group.into(), nodes));
        self.cells.len()
    }

    /// Quad4 over the products of two lists of coordinates, mapped into the plane.
    pub fn grid(
        &mut self,
        group: &str,
        [us, vs]: [&[f64]; 2],
        map: impl Fn(f64, f64) -> [f64; 2],
    ) -> Grid {
        let mut nodes = Vec::new();
        for v in vs {
            nodes.push(
                us.iter()
                    .map(|u| self.node(&map(*u, *v)))
                    .collect::<Vec<_>>(),
            );
        }
        let mut cells = Vec::new();
        for pair in nodes.windows(2) {
            let (low, high) = (&pair[0], &pair[1]);
            let row = (1..us.len()).map(|j| {
                let corners = vec![low[j - 1], low[j], high[j], high[j - 1]];
                self.cell("quad4", group, corners)
            });
            cells.push(row.collect());
        }
        Grid { nodes, cells }
    }

    /// A ring of quad8 about the origin: `n` around, turned by an angle, rows between the radii. Its cells, row by row.
    pub fn ring(&mut self, group: &str, n: usize, radii: &[f64], turn: f64) -> Vec<Vec<usize>> {
        let step = std::f64::consts::PI / n as f64;
        let mut circle = |r: f64, every: usize| {
            let places = (0..2 * n).step_by(every).map(|i| turn + i as f64 * step);
            let nodes = places.map(|t| self.node(&[r * t.cos(), r * t.sin()]));
            nodes.collect::<Vec<_>>()
        };
        let circles: Vec<Vec<usize>> = radii.iter().map(|r| circle(*r, 1)).collect();
        let between = radii.windows(2).map(|r| circle(0.5 * (r[0] + r[1]), 2));
        let between: Vec<Vec<usize>> = between.collect();
        let mut rows = Vec::new();
        for (row, pair) in circles.windows(2).enumerate() {
            let (low, high, sides) = (&pair[0], &pair[1], &between[row]);
            let cells = (0..n).map(|i| {
                let (a, b, c) = (2 * i, 2 * i + 1, (2 * i + 2) % (2 * n));
                let corners = [low[a], high[a], high[c], low[c]];
                let middles = [sides[i], high[b], sides[(i + 1) % n], low[b]];
                self.cell("quad8", group, [corners, middles].concat())
            });
            rows.push(cells.collect());
        }
        rows
    }

    /// Cells of a solid element over the products of three lists of coordinates, mapped into space; tetrahedra are six to
    /// a box.
    pub fn solid(
        &mut self,
        group: &str,
        element: &'static str,
        axes: [&[f64]; 3],
        map: impl Fn([f64; 3]) -> [f64; 3],
    ) {
        let cells = cells_of_box(by_name(element).unwrap());
        let mut known = HashMap::new();
        let coordinate = |axis: usize, half: usize| {
            let ends = axes[axis];
            0.5 * (ends[half / 2] + ends[half.div_ceil(2)])
        };
        let size = [0, 1, 2].map(|axis| axes[axis].len() - 1);
        for place in 0..size[0] * size[1] * size[2] {
            let at = [
                place % size[0],
                place / size[0] % size[1],
                place / (size[0] * size[1]),
            ];
            for cell in &cells {
                let node = |offset: &[usize; 3]| {
                    let halves = [0, 1, 2].map(|axis| 2 * at[axis] + offset[axis]);
                    let x = [0, 1, 2].map(|axis| coordinate(axis, halves[axis]));
                    *known.entry(halves).or_insert_with(|| self.node(&map(x)))
                };
                let nodes = cell.iter().map(node).collect();
                self.cell(element, group, nodes);
            }
        }
    }

    /// Cells with straight edges over a grid of so many boxes, whose corners are where `corner` says; in the plane there
    /// are none along the third axis. Tetrahedra are six to a box, wedges and triangles two.
    pub fn straight(
        &mut self,
        group: &str,
        element: &'static str,
        size: [usize; 3],
        corner: impl Fn([usize; 3]) -> Vec3,
    ) {
        let solid = by_name(element).unwrap();
        let ndim = solid.dim();
        let linear = ["tri3", "quad4", "tet4", "wedge6", "hex8"]
            .map(|name| by_name(name).unwrap())
            .into_iter()
            .find(|e| e.dim() == ndim && e.ncorner() == solid.ncorner())
            .unwrap();
        let mut known = HashMap::new();
        let mut weights = vec![0.0; linear.nnode()];
        let layers = size[2].max(1);
        for place in 0..size[0] * size[1] * layers {
            let (row, layer) = (size[0], size[0] * size[1]);
            let at = [place % row, place / row % size[1], place / layer];
            for cell in cells_of_box(solid) {
                let halves = |offset: &[usize; 3]| [0, 1, 2].map(|a| 2 * at[a] + offset[a]);
                let corners: Vec<Vec3> = cell[..linear.nnode()]
                    .iter()
                    .map(|offset| corner(halves(offset).map(|h| h / 2)))
                    .collect();
                let mut nodes = Vec::new();
                for (xi, offset) in solid.nodes().iter().zip(&cell) {
                    linear.shape(xi, &mut weights);
                    let x: Vec3 = corners.iter().zip(&weights).map(|(x, w)| *x * *w).sum();
                    let new = || self.node(&x.to_array()[..ndim]);
                    nodes.push(*known.entry(halves(offset)).or_insert_with(new));
                }
                self.cell(element, group, nodes);
            }
        }
    }

    /// The facets of a group on a plane across an axis: the cell and the number of its side, and their nodes.
    pub fn facets(
        &self,
        group: &str,
        axis: usize,
        at: f64,
    ) -> Vec<((usize, usize), Element, Vec<usize>)> {
        let mut facets = Vec::new();
        let cells = self.cells.iter().enumerate();
        for (cell, (element, _, nodes)) in cells.filter(|(_, c)| c.1 == group) {
            for (number, side) in by_name(element).unwrap().sides().iter().enumerate() {
                let nodes: Vec<usize> = side.nodes.iter().map(|k| nodes[*k]).collect();
                if nodes.iter().all(|n| (self.at(*n)[axis] - at).abs() < 1e-9) {
                    facets.push(((cell + 1, number + 1), side.element, nodes));
                }
            }
        }
        facets
    }

    /// The faces of a group whose nodes are all at such places: the cell, and the name of its side.
    pub fn facets_where(
        &self,
        group: &str,
        is_there: impl Fn(&[f64]) -> bool,
    ) -> Vec<(usize, String)> {
        let mut faces = Vec::new();
        let cells = self.cells.iter().enumerate();
        for (cell, (element, _, nodes)) in cells.filter(|(_, c)| c.1 == group) {
            for (number, side) in by_name(element).unwrap().sides().iter().enumerate() {
                if side.nodes.iter().all(|k| is_there(self.at(nodes[*k]))) {
                    faces.push((cell + 1, format!("S{}", number + 1)));
                }
            }
        }
        faces
    }

    /// Hex8 over the products of three lists of coordinates.
    pub fn bricks(&mut self, group: &str, axes: [&[f64]; 3]) {
        self.solid(group, "hex8", axes, |x| x);
    }

    /// The first node at a place.
    pub fn label(&self, x: &[f64]) -> usize {
        self.nodes.iter().position(|at| at == x).unwrap() + 1
    }

    /// A set of nodes.
    pub fn set(&mut self, name: &str, nodes: &[usize]) {
        writeln!(self.sets, "{name} = {{ nodes = {nodes:?} }}").unwrap();
    }

    /// A set of faces.
    pub fn faces(&mut self, name: &str, faces: &[(usize, &str)]) {
        let listed: Vec<String> = faces
            .iter()
            .map(|(c, s)| format!("[{c}, \"{s}\"]"))
            .collect();
        writeln!(self.sets, "{name} = {{ faces = [{}] }}", listed.join(", ")).unwrap();
    }

    /// A set by geometry.
    pub fn place(&mut self, name: &str, place: &str) {
        writeln!(self.sets, "{name} = {{ {place} }}").unwrap();
    }

    /// A case of linear elastic bodies at small strain.
    pub fn elastic(&self, space: &str, young: f64, nu: f64) -> Case {
        Case(self.case(&format!(
            "[model]\nspace = {space:?}\n[material.m]\nmodel = \"linear-elastic\"\nE = {young:?}\nnu = {nu:?}\n"
        )))
    }

    /// A case of which nothing but this is said yet.
    pub fn case_of(&self, rest: &str) -> Case {
        Case(self.case(rest) + "\n")
    }

    /// The case: the mesh, and what else is said.
    pub fn case(&self, rest: &str) -> String {
        let mut text = String::from("format = 1\n[mesh]\nnodes = [\n");
        for (n, x) in self.nodes.iter().enumerate() {
            let x: Vec<String> = x.iter().map(|x| format!("{x:?}")).collect();
            writeln!(text, "[{}, {}],", n + 1, x.join(", ")).unwrap();
        }
        text.push_str("]\nelements = [\n");
        for (n, (element, group, nodes)) in self.cells.iter().enumerate() {
            let id = n + 1;
            writeln!(
                text,
                "{{ id = {id}, type = \"{element}\", group = \"{group}\", nodes = {nodes:?} }},"
            )
            .unwrap();
        }
        format!("{text}]\n[sets]\n{}\n{rest}", self.sets)
    }
}

/// The cells of an element that fill a box, as places of their nodes in halves of its edges.
fn cells_of_box(element: Element) -> Vec<Vec<[usize; 3]>> {
    let halves = |x: Vec3| x.to_array().map(|x| (2.0 * x).round() as usize);
    let ones = Vec3::new(1.0, 1.0, 1.0);
    let places = |map: &dyn Fn(Vec3) -> Vec3| -> Vec<[usize; 3]> {
        element.nodes().iter().map(|xi| halves(map(*xi))).collect()
    };
    match (element.dim(), element.ncorner()) {
        (3, 8) => return vec![places(&|xi| (xi + ones) * 0.5)],
        (2, 4) => {
            let map = |xi: Vec3| Vec3::new(0.5 * (xi.x + 1.0), 0.5 * (xi.y + 1.0), 0.0);
            return vec![places(&map)];
        }
        // a triangle and the opposite one
        (2, 3) => {
            let other = |xi: Vec3| Vec3::new(1.0 - xi.x, 1.0 - xi.y, 0.0);
            return vec![places(&|xi| xi), places(&other)];
        }
        (3, 6) => {
            let up = |xi: Vec3| 0.5 * (xi.z + 1.0);
            let other = |xi: Vec3| Vec3::new(1.0 - xi.x, 1.0 - xi.y, up(xi));
            let one = |xi: Vec3| Vec3::new(xi.x, xi.y, up(xi));
            return vec![places(&one), places(&other)];
        }
        _ => {}
    }
    // from the origin along one axis, along another, to the opposite corner
    let paths = [(0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2)];
    let cell = |(n, (first, second)): (usize, (usize, usize))| {
        let way = [Vec3::unit(first), Vec3::unit(first) + Vec3::unit(second)];
        // the last three turn the other way round
        let [a, b] = if n < 3 { way } else { [way[1], way[0]] };
        places(&|xi| a * xi.x + b * xi.y + ones * xi.z)
    };
    paths.into_iter().enumerate().map(cell).collect()
}

/// The text of a case, to which tables are added one by one.
pub struct Case(String);

impl Case {
    /// More keys of the last table, or more tables.
    pub fn also(mut self, text: &str) -> Self {
        self.0 += text;
        self.0.push('\n');
        self
    }

    /// What was said so far.
    pub fn text(&self) -> &str {
        &self.0
    }

    fn table(self, heading: &str, on: &str, keys: &str) -> Self {
        self.also(&format!("[[{heading}]]\non = {on:?}\n{keys}"))
    }

    /// Groups of cells; bars have an area among their keys.
    pub fn body(self, groups: &[&str], keys: &str) -> Self {
        self.also(&format!(
            "[[body]]\ngroup = {groups:?}\nmaterial = \"m\"\n{keys}"
        ))
    }

    /// The contact of that name.
    pub fn contact(self, secondary: &str, primary: &str, keys: &str) -> Self {
        self.also(&format!(
            "[[contact]]\nname = \"contact\"\nsecondary = {secondary:?}\nprimary = {primary:?}\n{keys}"
        ))
    }

    /// A rigid plane.
    pub fn plane(self, name: &str, point: [f64; 2], normal: [f64; 2]) -> Self {
        self.also(&format!(
            "[[surface]]\nname = {name:?}\nshape = {{ plane = {{ point = {point:?}, normal = {normal:?} }} }}"
        ))
    }

    /// A spring between a set and the ground.
    pub fn spring(self, name: &str, on: &str, stiffness: f64, direction: [f64; 2]) -> Self {
        let keys = format!("name = {name:?}\nstiffness = {stiffness:?}\ndirection = {direction:?}");
        self.table("spring", on, &keys)
    }

    pub fn step(self, name: &str, increments: usize) -> Self {
        self.also(&format!(
            "[[step]]\nname = {name:?}\ngeometry = \"linear\"\nincrements = {increments}"
        ))
    }

    /// Supports along axes, as in "xy".
    pub fn fix(self, on: &str, axes: &str) -> Self {
        self.table("step.fix", on, &listed(axes))
    }

    /// Axes along which nothing holds a set any more.
    pub fn free(self, on: &str, axes: &str) -> Self {
        self.table("step.free", on, &listed(axes))
    }

    /// Prescribed displacements, as keys.
    pub fn displace(self, on: &str, keys: &str) -> Self {
        self.table("step.move", on, keys)
    }

    /// A load, as keys.
    pub fn load(self, on: &str, keys: &str) -> Self {
        self.table("step.load", on, keys)
    }

    /// Numbers of Newton's method.
    pub fn newton(self, keys: &str) -> Self {
        self.also(&format!("[solver]\nnewton = {{ {keys} }}"))
    }

    pub fn model(&self, set: &[(&str, &str)]) -> Model {
        model("benchmark", &self.0, set)
    }

    /// Runs to the end.
    pub fn run(&self) -> Run {
        finished(&mut self.model(&[]))
    }
}

/// Runs a model to the end.
pub fn finished(model: &mut Model) -> Run {
    let run = run(model);
    assert!(run.error.is_none(), "{:?}", run.error);
    run
}

fn listed(axes: &str) -> String {
    let axes: Vec<String> = axes.chars().map(String::from).collect();
    format!("u = {axes:?}")
}

/// So many equal parts of an interval: their ends.
pub fn equal(from: f64, to: f64, parts: usize) -> Vec<f64> {
    let part = |i: usize| from + (to - from) * i as f64 / parts as f64;
    (0..=parts).map(part).collect()
}

/// Equal parts of size `h` up to `fine`, then parts that grow by `ratio` up to `to`.
pub fn graded(fine: f64, h: f64, ratio: f64, to: f64) -> Vec<f64> {
    let mut ends = equal(0.0, fine, (fine / h).round() as usize);
    let mut size = h;
    let mut rest = Vec::new();
    let mut reached = fine;
    while reached + 0.5 * size * ratio < to {
        size *= ratio;
        reached += size;
        rest.push(reached - fine);
    }
    let stretch = (to - fine) / (reached - fine);
    ends.extend(rest.iter().map(|x| fine + x * stretch));
    ends
}
