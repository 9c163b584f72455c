//! The surface of the solids of a frame, in triangles.
//!
//! ```text
//! cells of dimension 3 ──sides that occur once──▶ faces ┐
//! cells of dimension 2 ─────────────────────────▶ faces ┴─▶ triangles, edges        cells of dimension 1 ─▶ lines
//! ```
//!
//! A quadratic face is divided at its nodes inside of edges, so that curved faces are drawn curved.

use signorini_geometry::element::{Element, Family, MAX_NODES};
use signorini_io::vtk::Vtu;
use signorini_io::vtk::cells::CellType;
use std::collections::{HashMap, HashSet};

/// The surface of a grid. Numbers of nodes are those of the surface, unless they are said to be those of the grid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// For every node its number in the grid.
    pub nodes: Vec<u32>,
    /// Where the nodes are before anything moves.
    pub points: Vec<[f64; 3]>,
    /// The numbers of the nodes in the mesh of the case.
    pub labels: Vec<i64>,
    /// Triangles, seen counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// For every triangle the part of the model it belongs to, from 0: cells that share nodes are one part.
    pub parts: Vec<u32>,
    /// For every triangle the cell of the grid that it bounds.
    pub cells: Vec<u32>,
    /// The number of parts.
    pub npart: usize,
    /// Edges of faces in straight pieces, each once.
    pub edges: Vec<[u32; 2]>,
    /// Cells of one dimension, such as bars, in straight pieces.
    pub lines: Vec<[u32; 2]>,
    /// The number of faces that the triangles are parts of.
    pub nface: usize,
    /// Whether all nodes lie in a plane z = const.
    pub is_plane: bool,
}

/// A face of a cell.
struct Face {
    element: Element,
    /// Nodes of the grid, in the order of the element.
    nodes: Vec<usize>,
    cell: usize,
}

impl Skin {
    /// The surface of a grid. Cells of kinds that are not read are left out.
    #[must_use]
    pub fn of(grid: &Vtu) -> Self {
        let mut faces = Vec::new();
        let mut lines: Vec<Face> = Vec::new();
        let mut open: HashMap<[usize; 4], Option<Face>> = HashMap::new();
        let mut order: Vec<[usize; 4]> = Vec::new();
        let mut groups = Groups::new(grid.points.len());
        for (cell, element, nodes) in cells(grid) {
            groups.join(&nodes);
            match element.dim() {
                1 => lines.push(Face {
                    element,
                    nodes,
                    cell,
                }),
                2 => faces.push(Face {
                    element,
                    nodes,
                    cell,
                }),
                _ => {
                    for face in sides(cell, element, &nodes) {
                        let key = corners(&face);
                        open.entry(key)
                            .and_modify(|place| *place = None)
                            .or_insert_with(|| {
                                order.push(key);
                                Some(face)
                            });
                    }
                }
            }
        }
        faces.extend(order.iter().filter_map(|key| open.remove(key).flatten()));
        Self::of_faces(grid, &faces, &lines, &mut groups)
    }

    fn of_faces(grid: &Vtu, faces: &[Face], lines: &[Face], groups: &mut Groups) -> Self {
        let mut skin = Self {
            nface: faces.len(),
            ..Self::default()
        };
        let mut numbers: HashMap<usize, u32> = HashMap::new();
        let mut parts: HashMap<usize, u32> = HashMap::new();
        let mut seen: HashSet<[u32; 2]> = HashSet::new();
        let labels = grid
            .point_field("node_id")
            .and_then(|ids| ids.numbers.to_i64());
        let labels = labels.unwrap_or_else(|| (1..=grid.points.len() as i64).collect());
        for face in faces.iter().chain(lines) {
            let nodes: Vec<u32> = (face.nodes.iter())
                .map(|&node| {
                    *numbers.entry(node).or_insert_with(|| {
                        skin.nodes.push(node as u32);
                        skin.points
                            .push(grid.points.get(node).copied().unwrap_or_default());
                        skin.labels.push(labels.get(node).copied().unwrap_or(-1));
                        (skin.nodes.len() - 1) as u32
                    })
                })
                .collect();
            let node = |place: usize| nodes.get(place).copied().unwrap_or_default();
            if face.element.dim() == 1 {
                let chain = chain(face.element, 0).collect::<Vec<usize>>();
                let pieces = chain
                    .windows(2)
                    .filter_map(|pair| Some([node(*pair.first()?), node(*pair.last()?)]));
                skin.lines.extend(pieces);
                continue;
            }
            let nparts = parts.len() as u32;
            let root = groups.root(face.nodes.first().copied().unwrap_or_default());
            let part = *parts.entry(root).or_insert(nparts);
            for triangle in triangles(face.element) {
                skin.triangles.push(triangle.map(node));
                skin.parts.push(part);
                skin.cells.push(face.cell as u32);
            }
            for edge in 0..face.element.edges().len() {
                let chain = chain(face.element, edge).map(node).collect::<Vec<u32>>();
                for pair in chain.windows(2) {
                    if let [a, b] = *pair
                        && seen.insert([a.min(b), a.max(b)])
                    {
                        skin.edges.push([a, b]);
                    }
                }
            }
        }
        skin.npart = parts.len();
        let flat = |point: &[f64; 3]| {
            skin.points
                .first()
                .is_some_and(|first| first[2] == point[2])
        };
        skin.is_plane = skin.points.iter().all(flat);
        skin
    }

    /// Whether there is nothing to draw.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty() && self.lines.is_empty()
    }
}

/// All cells whose kind is known, with their nodes in the order of the element.
fn cells(grid: &Vtu) -> impl Iterator<Item = (usize, Element, Vec<usize>)> {
    let types = CellType::by_number();
    let of_cell = move |(cell, (&kind, ends)): (usize, (&u8, &[usize]))| {
        let cell_type = types.get(kind as usize).copied().flatten()?;
        let given = match *ends {
            [start, end] => grid.connectivity.get(start..end)?,
            _ => return None,
        };
        let element = cell_type.element;
        if given.len() != element.nnode() {
            return None;
        }
        let mut nodes = vec![0; given.len()];
        for (&node, place) in given.iter().zip(cell_type.places()) {
            *nodes.get_mut(place)? = node;
        }
        Some((cell, element, nodes))
    };
    grid.types
        .iter()
        .zip(grid.offsets.windows(2))
        .enumerate()
        .filter_map(of_cell)
}

/// The sides of a cell.
fn sides(cell: usize, element: Element, nodes: &[usize]) -> impl Iterator<Item = Face> {
    element.sides().iter().map(move |side| Face {
        element: side.element,
        nodes: side
            .nodes
            .iter()
            .filter_map(|&k| nodes.get(k).copied())
            .collect(),
        cell,
    })
}

/// The corners of a face in the order of their numbers; faces have at most four.
fn corners(face: &Face) -> [usize; 4] {
    let mut key = [usize::MAX; 4];
    let corners = face.nodes.iter().take(face.element.ncorner());
    key.iter_mut()
        .zip(corners)
        .for_each(|(place, node)| *place = *node);
    key.sort_unstable();
    key
}

/// The nodes along an edge, both ends included.
fn chain(element: Element, edge: usize) -> impl Iterator<Item = usize> {
    let [start, end] = element.edges().get(edge).copied().unwrap_or_default();
    let inside = element.inside_edge(edge);
    std::iter::once(start)
        .chain(inside)
        .chain(std::iter::once(end))
}

/// The triangles that a face is divided into, as places of its nodes.
fn triangles(element: Element) -> Vec<[usize; 3]> {
    let ring: Vec<usize> = element.ring().collect();
    let n = ring.len();
    let at = |k: usize| ring.get(k % n.max(1)).copied().unwrap_or_default();
    let inner =
        (0..element.nnode()).find(|node| !ring.contains(node) && element.nnode() <= MAX_NODES);
    match (element.family(), element.order(), inner) {
        // a fan round the node in the middle
        (_, _, Some(middle)) => (0..n).map(|k| [at(k), at(k + 1), middle]).collect(),
        // corners cut off, and the polygon that is left
        (_, 2, None) => {
            let corners = (0..n).step_by(2).map(|k| [at(k + n - 1), at(k), at(k + 1)]);
            let rest: Vec<usize> = (1..n).step_by(2).map(at).collect();
            corners.chain(fan(&rest)).collect()
        }
        (Family::Triangle | Family::Quadrilateral, _, None) => fan(&ring),
        _ => fan(&ring),
    }
}

/// A convex polygon as triangles.
fn fan(polygon: &[usize]) -> Vec<[usize; 3]> {
    let Some((&first, rest)) = polygon.split_first() else {
        return Vec::new();
    };
    let pairs = rest.windows(2);
    pairs
        .filter_map(|pair| Some([first, *pair.first()?, *pair.last()?]))
        .collect()
}

/// Nodes that hang together.
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut node: usize) -> usize {
        while let Some(&up) = self.0.get(node).filter(|up| **up != node) {
            let above = self.0.get(up).copied().unwrap_or(up);
            if let Some(place) = self.0.get_mut(node) {
                *place = above;
            }
            node = above;
        }
        node
    }

    fn join(&mut self, nodes: &[usize]) {
        let Some(&first) = nodes.first() else { return };
        let first = self.root(first);
        for &node in nodes {
            let root = self.root(node);
            if let Some(place) = self.0.get_mut(root) {
                *place = first;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element::TABLE;

    /// Two cubes on top of each other that share a face, and one apart.
    fn cubes() -> Vtu {
        let layer = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
        let points = [0.0, 1.0, 2.0, 5.0, 6.0].map(layer).concat();
        let cell = |start: usize| (start..start + 8).collect::<Vec<usize>>();
        Vtu {
            points,
            types: vec![12; 3],
            offsets: vec![0, 8, 16, 24],
            connectivity: [cell(0), cell(4), cell(12)].concat(),
            ..Vtu::default()
        }
    }

    #[test]
    fn faces_between_cells_are_not_part_of_the_surface() {
        let skin = Skin::of(&cubes());
        assert_eq!((skin.nface, skin.triangles.len(), skin.npart), (16, 32, 2));
        assert_eq!((skin.points.len(), skin.edges.len()), (20, 20 + 12));
        assert!(!skin.is_plane);
    }

    #[test]
    fn triangles_of_the_surface_look_outwards_and_enclose_the_volume() {
        let skin = Skin::of(&cubes());
        let volume: f64 = (skin.triangles.iter())
            .map(|triangle| {
                let [a, b, c] = triangle.map(|node| skin.points[node as usize]);
                let cross = [
                    b[1] * c[2] - b[2] * c[1],
                    b[2] * c[0] - b[0] * c[2],
                    b[0] * c[1] - b[1] * c[0],
                ];
                (a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2]) / 6.0
            })
            .sum();
        assert!((volume - 3.0).abs() < 1e-12, "{volume}");
    }

    #[test]
    fn the_triangles_of_every_face_cover_its_reference_domain() {
        for element in TABLE.iter().filter(|element| element.dim() == 2) {
            let area: f64 = (triangles(*element).into_iter())
                .map(|triangle| {
                    let [a, b, c] = triangle.map(|place| element.nodes()[place]);
                    (b - a).cross(c - a).z / 2.0
                })
                .sum();
            let whole: f64 = element.full_rule().iter().map(|(_, weight)| weight).sum();
            assert!((area - whole).abs() < 1e-12, "{}: {area}", element.name());
        }
    }

    #[test]
    fn a_cell_with_too_few_nodes_is_left_out() {
        let mut grid = cubes();
        grid.types[2] = 25;
        assert_eq!(Skin::of(&grid).npart, 1);
    }
}
