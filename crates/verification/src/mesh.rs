//! Structured meshes, as the text of `[mesh]` and `[sets]` of a case.
//!
//! ```text
//!          NAME_top                      every block of cells has a group NAME and, of its
//!        ┌───┬───┬───┐                   sides, the sets of faces NAME_left, _right, _bottom,
//!  _left │   │   │   │ _right            _top; in space _back and _front (z), too
//!        └───┴───┴───┘
//!          NAME_bottom
//! ```
//!
//! A block is a grid of lines along x, y and z, whose points a function moves; nodes inside of edges lie on the moved curves.

use signorini_geometry::element::{Element, by_name};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A point.
pub(crate) type Point = [f64; 3];

/// The names of the sides of a block: lower and upper end along x, y, z.
const SIDES: [[&str; 2]; 3] = [["left", "right"], ["bottom", "top"], ["back", "front"]];

/// Corners of a hexahedron in a grid, in the order of its nodes.
const HEX: [[usize; 3]; 8] = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [1, 1, 1],
    [0, 1, 1],
];

/// A hexahedron in six tetrahedra around its diagonal; of neighbours they match.
const TETS: [[usize; 4]; 6] = [
    [0, 1, 2, 6],
    [0, 2, 3, 6],
    [0, 3, 7, 6],
    [0, 7, 4, 6],
    [0, 4, 5, 6],
    [0, 5, 1, 6],
];

/// A mesh that is being made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    nodes: Vec<Point>,
    cells: Vec<Cell>,
    /// Lines of `[sets]`.
    sets: Vec<(String, String)>,
    is_plane: bool,
}

#[derive(Clone, Debug, PartialEq)]
struct Cell {
    kind: &'static str,
    group: String,
    /// Numbers from 1.
    nodes: Vec<usize>,
}

/// A block of cells.
pub(crate) struct Lines<'a> {
    /// Its group, and the first part of the names of its sides.
    pub(crate) name: &'a str,
    /// The type of its cells.
    pub(crate) kind: &'static str,
    /// Places of the grid lines; of two axes in the plane.
    pub(crate) axes: &'a [Vec<f64>],
    /// Where a point of the grid lies.
    pub(crate) map: &'a dyn Fn(Point) -> Point,
}

impl Grid {
    /// An empty mesh in the plane.
    pub(crate) fn plane() -> Self {
        Self {
            is_plane: true,
            ..Self::default()
        }
    }

    /// An empty mesh in space.
    pub(crate) fn space() -> Self {
        Self::default()
    }

    /// The number of nodes.
    #[must_use]
    pub fn nnode(&self) -> usize {
        self.nodes.len()
    }

    /// The number of cells.
    #[must_use]
    pub fn ncell(&self) -> usize {
        self.cells.len()
    }

    /// Adds a node; returns its number.
    pub(crate) fn node(&mut self, point: Point) -> usize {
        self.nodes.push(point);
        self.nodes.len()
    }

    /// Adds a cell of nodes by number; returns its number.
    pub(crate) fn cell(&mut self, kind: &'static str, group: &str, nodes: &[usize]) -> usize {
        self.cells.push(Cell {
            kind,
            group: group.to_owned(),
            nodes: nodes.to_vec(),
        });
        self.cells.len()
    }

    /// Adds a set, as a case writes it.
    pub(crate) fn set(&mut self, name: &str, text: impl Into<String>) {
        self.sets.push((name.to_owned(), text.into()));
    }

    /// The node nearest to a point: its number and its place.
    pub(crate) fn nearest(&self, point: Point) -> (usize, Point) {
        let far = |p: &Point| (0..3).map(|k| (p[k] - point[k]).powi(2)).sum::<f64>();
        let mut best = (0, [f64::INFINITY; 3]);
        for (i, p) in self.nodes.iter().enumerate() {
            if best.0 == 0 || far(p) < far(&best.1) {
                best = (i + 1, *p);
            }
        }
        best
    }

    /// Adds a block of cells without a map.
    pub(crate) fn block(&mut self, name: &str, kind: &'static str, axes: &[Vec<f64>]) {
        self.mapped(&Lines {
            name,
            kind,
            axes,
            map: &|p| p,
        });
    }

    /// Adds a block of cells; unknown types add nothing.
    pub(crate) fn mapped(&mut self, lines: &Lines<'_>) {
        let Some(element) = by_name(lines.kind) else {
            return;
        };
        let counts = [0, 1, 2].map(|k| lines.axes.get(k).map_or(1, |axis| axis.len().max(2) - 1));
        let ndim = lines.axes.len();
        let mut nodes: BTreeMap<[usize; 3], usize> = BTreeMap::new();
        let mut faces: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    for part in parts(element, ndim) {
                        let corners: Vec<[usize; 3]> =
                            part.iter().map(|c| at_corner([i, j, k], *c)).collect();
                        let all = with_mid_nodes(element, &corners);
                        let numbers: Vec<usize> = all
                            .iter()
                            .map(|key| self.number(&mut nodes, *key, lines))
                            .collect();
                        let cell = self.cell(lines.kind, lines.name, &numbers);
                        for (side, name) in outer_sides(element, &corners, counts, ndim) {
                            let row = format!("[{cell}, \"S{side}\"]");
                            faces.entry(name).or_default().push(row);
                        }
                    }
                }
            }
        }
        for (side, rows) in faces {
            let name = format!("{}_{side}", lines.name);
            self.set(&name, format!("{{ faces = [{}] }}", rows.join(", ")));
        }
    }

    /// The node at a place of the grid, in halves of its cells.
    fn number(
        &mut self,
        known: &mut BTreeMap<[usize; 3], usize>,
        key: [usize; 3],
        lines: &Lines<'_>,
    ) -> usize {
        if let Some(number) = known.get(&key) {
            return *number;
        }
        let mut point = [0.0; 3];
        for ((x, axis), at) in point.iter_mut().zip(lines.axes).zip(key) {
            let of = |i: usize| axis.get(i).copied().unwrap_or(0.0);
            *x = 0.5 * (of(at / 2) + of(at.div_ceil(2)));
        }
        let number = self.node((lines.map)(point));
        known.insert(key, number);
        number
    }

    /// The text of `[mesh]` and `[sets]`.
    #[must_use]
    pub fn text(&self) -> String {
        let mut out = String::from("[mesh]\nnodes = [\n");
        for (i, [x, y, z]) in self.nodes.iter().enumerate() {
            // writing to a string does not fail
            let _ = match self.is_plane {
                true => writeln!(out, "  [{}, {x:?}, {y:?}],", i + 1),
                false => writeln!(out, "  [{}, {x:?}, {y:?}, {z:?}],", i + 1),
            };
        }
        out.push_str("]\nelements = [\n");
        for (i, cell) in self.cells.iter().enumerate() {
            let _ = writeln!(
                out,
                "  {{ id = {}, type = \"{}\", group = \"{}\", nodes = {:?} }},",
                i + 1,
                cell.kind,
                cell.group,
                cell.nodes
            );
        }
        out.push_str("]\n\n[sets]\n");
        for (name, text) in &self.sets {
            let _ = writeln!(out, "{name} = {text}");
        }
        out
    }

    /// The mesh in words: `128 quad4; 153 nodes`.
    #[must_use]
    pub fn words(&self) -> String {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for cell in &self.cells {
            *counts.entry(cell.kind).or_default() += 1;
        }
        let cells = counts.iter().map(|(kind, n)| format!("{n} {kind}"));
        let cells: Vec<String> = cells.collect();
        format!("{}; {} nodes", cells.join(", "), self.nnode())
    }
}

/// The cells that a quadrilateral or hexahedron of the grid becomes, as corners of it.
fn parts(element: Element, ndim: usize) -> Vec<Vec<[usize; 3]>> {
    let pick = |places: &[usize]| places.iter().filter_map(|p| HEX.get(*p).copied()).collect();
    match (ndim, element.ncorner()) {
        (2, 3) => vec![pick(&[0, 1, 2]), pick(&[0, 2, 3])],
        (2, _) => vec![pick(&[0, 1, 2, 3])],
        (_, 4) => TETS.iter().map(|t| pick(t)).collect(),
        (_, 6) => vec![pick(&[0, 1, 2, 4, 5, 6]), pick(&[0, 2, 3, 4, 6, 7])],
        _ => vec![HEX.to_vec()],
    }
}

/// A corner of a cell of the grid, in halves of cells.
fn at_corner(cell: [usize; 3], corner: [usize; 3]) -> [usize; 3] {
    [0, 1, 2].map(|k| 2 * (cell[k] + corner[k]))
}

/// All nodes of an element: corners, then those in the middle of edges.
fn with_mid_nodes(element: Element, corners: &[[usize; 3]]) -> Vec<[usize; 3]> {
    let mut all = corners.to_vec();
    if element.order() > 1 {
        for [a, b] in element.edges() {
            if let (Some(a), Some(b)) = (corners.get(*a), corners.get(*b)) {
                all.push([0, 1, 2].map(|k| a[k].midpoint(b[k])));
            }
        }
    }
    all
}

/// The sides of an element that lie on the outside of its block: their numbers from 1, and the names of the sides there.
fn outer_sides(
    element: Element,
    corners: &[[usize; 3]],
    counts: [usize; 3],
    ndim: usize,
) -> Vec<(usize, &'static str)> {
    let mut found = Vec::new();
    for (number, side) in element.sides().iter().enumerate() {
        let ends = side.nodes.iter().filter_map(|n| corners.get(*n));
        let ends: Vec<&[usize; 3]> = ends.collect();
        for (k, names) in SIDES.iter().enumerate().take(ndim) {
            for (name, level) in names.iter().zip([0, 2 * counts[k]]) {
                if ends.iter().all(|corner| corner[k] == level) {
                    found.push((number + 1, *name));
                }
            }
        }
    }
    found
}

/// Equal spaces from `a` to `b`.
pub(crate) fn even(a: f64, b: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|i| a + (b - a) * i as f64 / n as f64).collect()
}

/// From 0 on: `n` spaces of size `h`, then spaces that grow by `ratio` up to `end`.
pub(crate) fn graded(h: f64, n: usize, ratio: f64, end: f64) -> Vec<f64> {
    let mut at: Vec<f64> = (0..=n).map(|i| h * i as f64).collect();
    let (mut x, mut step) = (h * n as f64, h);
    let mut grown = Vec::new();
    while x < end {
        step *= ratio;
        x += step;
        grown.push(x);
    }
    // the last one ends where it is asked to: all are stretched alike
    let (from, last) = (h * n as f64, x);
    let stretched = grown
        .iter()
        .map(|x| from + (x - from) * (end - from) / (last - from));
    at.extend(stretched);
    at
}

/// The same in the other direction, mirrored at 0.
pub(crate) fn mirrored(axis: &[f64]) -> Vec<f64> {
    axis.iter().rev().map(|x| -x).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_every_kind_share_their_nodes() {
        let two = [even(0.0, 1.0, 2), even(0.0, 1.0, 2), even(0.0, 1.0, 2)];
        let cases = [
            ("quad4", 2, 9, 4),
            ("quad8", 2, 21, 4),
            ("tri3", 2, 9, 8),
            ("tri6", 2, 25, 8),
            ("hex8", 3, 27, 8),
            ("hex20", 3, 81, 8),
            ("tet4", 3, 27, 48),
            ("tet10", 3, 125, 48),
            ("wedge6", 3, 27, 16),
        ];
        for (kind, ndim, nnode, ncell) in cases {
            let mut grid = Grid::space();
            grid.block("b", kind, &two[..ndim]);
            assert_eq!((grid.nnode(), grid.ncell()), (nnode, ncell), "{kind}");
            assert_eq!(grid.sets.len(), 2 * ndim, "{kind}");
            let per_side = if kind.starts_with("t") && ndim == 3 {
                8
            } else {
                0
            };
            let top = &grid
                .sets
                .iter()
                .find(|(name, _)| name == "b_top")
                .unwrap()
                .1;
            let nface = top.matches("\"S").count();
            assert!(
                nface == per_side || per_side == 0 && nface >= 2,
                "{kind}: {top}"
            );
        }
    }

    #[test]
    fn graded_lines_end_where_they_are_asked_to() {
        let lines = graded(0.1, 5, 1.3, 10.0);
        assert!((lines[5] - 0.5).abs() < 1e-12);
        assert!((lines[lines.len() - 1] - 10.0).abs() < 1e-12);
        assert!(lines.windows(2).all(|w| w[1] > w[0]));
        assert_eq!(mirrored(&[0.0, 1.0]), [-1.0, -0.0]);
    }
}
