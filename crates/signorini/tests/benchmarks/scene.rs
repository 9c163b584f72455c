//! Meshes made in a test, written as the text of a case.

use std::fmt::Write;

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

    /// Hex8 over the products of three lists of coordinates; labels of nodes by z, y, x.
    pub fn bricks(&mut self, group: &str, axes: [&[f64]; 3]) -> Vec<Vec<Vec<usize>>> {
        let [xs, ys, zs] = axes;
        let mut nodes = Vec::new();
        for z in zs {
            let layer = ys.iter().map(|y| {
                let row = xs.iter().map(|x| self.node(&[*x, *y, *z]));
                row.collect::<Vec<_>>()
            });
            nodes.push(layer.collect::<Vec<_>>());
        }
        for k in 1..zs.len() {
            for j in 1..ys.len() {
                for i in 1..xs.len() {
                    let corners = |k: usize| {
                        let layer: &Vec<Vec<usize>> = &nodes[k];
                        [
                            layer[j - 1][i - 1],
                            layer[j - 1][i],
                            layer[j][i],
                            layer[j][i - 1],
                        ]
                    };
                    let cell = [corners(k - 1), corners(k)].concat();
                    self.cell("hex8", group, cell);
                }
            }
        }
        nodes
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
