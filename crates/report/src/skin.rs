//! The surface of the solids of a frame, in triangles.
//!
//! ```text
//! cells of dimension 3 ──sides that occur once──▶ faces ┐
//! cells of dimension 2 ─────────────────────────▶ faces ┴─▶ triangles, edges        cells of dimension 1 ─▶ lines
//! ```
//!
//! A quadratic face is divided at its nodes inside of edges, so that curved faces are drawn curved.

use signorini_geometry::element::Element;
use signorini_geometry::mesh::{CellId, Mesh, NodeId, boundary, quality};
use signorini_geometry::tensor::Vec3;
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

/// A face of a cell, or a whole cell of fewer than three dimensions.
struct Face {
    element: Element,
    /// Nodes of the grid, in the order of the element.
    nodes: Vec<NodeId>,
    /// The place of the cell in the grid.
    cell: usize,
}

impl Skin {
    /// The surface of a grid. Cells of kinds that are not read are left out.
    #[must_use]
    pub fn of(grid: &Vtu) -> Self {
        let mesh = mesh_of(grid);
        let mut faces = whole(&mesh, 2);
        let mut outer = Vec::new();
        for face in boundary(&mesh, mesh.cells(3)) {
            if let Some((element, nodes)) = mesh.face(face) {
                let cell = place(&mesh, face.cell);
                outer.push(Face {
                    element,
                    nodes,
                    cell,
                });
            }
        }
        // the order of the grid, whatever block a cell is in
        outer.sort_by_key(|face| face.cell);
        faces.append(&mut outer);
        Self::of_faces(grid, &faces, &whole(&mesh, 1), &groups(&mesh))
    }

    /// `groups` holds for every cell of the grid the group that it hangs together with.
    fn of_faces(grid: &Vtu, faces: &[Face], lines: &[Face], groups: &[usize]) -> Self {
        let mut skin = Self {
            nface: faces.len(),
            ..Self::default()
        };
        let mut numbers: HashMap<NodeId, u32> = HashMap::new();
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
                        let at = node as usize;
                        skin.nodes.push(node);
                        skin.points
                            .push(grid.points.get(at).copied().unwrap_or_default());
                        skin.labels.push(labels.get(at).copied().unwrap_or(-1));
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
            let group = groups.get(face.cell).copied().unwrap_or_default();
            let part = *parts.entry(group).or_insert(nparts);
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

/// The cells of a grid whose kind is known; the label of each is its place in the grid.
pub(crate) fn mesh_of(grid: &Vtu) -> Mesh {
    let mut mesh = Mesh {
        points: grid.points.iter().map(|&x| Vec3::from(x)).collect(),
        ..Mesh::default()
    };
    let types = CellType::by_number();
    for (label, (&kind, ends)) in (0..).zip(grid.types.iter().zip(grid.offsets.windows(2))) {
        let cell_type = types.get(kind as usize).copied().flatten();
        let (Some(cell_type), &[start, end]) = (cell_type, ends) else {
            continue;
        };
        let given = grid.connectivity.get(start..end).unwrap_or_default();
        if given.len() != cell_type.element.nnode() {
            continue;
        }
        let mut nodes = vec![0; given.len()];
        for (&node, place) in given.iter().zip(cell_type.places()) {
            if let Some(entry) = nodes.get_mut(place) {
                *entry = node as NodeId;
            }
        }
        mesh.push_cell(cell_type.element, &nodes, label);
    }
    mesh
}

/// The place in the grid of a cell of [`mesh_of`].
fn place(mesh: &Mesh, cell: CellId) -> usize {
    mesh.cell_label(cell).unwrap_or_default() as usize
}

/// All cells of a dimension, in the order of the grid.
fn whole(mesh: &Mesh, dim: usize) -> Vec<Face> {
    let of_cell = |cell: CellId| {
        Some(Face {
            element: mesh.element(cell)?,
            nodes: mesh.cell(cell).to_vec(),
            cell: place(mesh, cell),
        })
    };
    let mut all: Vec<Face> = mesh.cells(dim).filter_map(of_cell).collect();
    all.sort_by_key(|face| face.cell);
    all
}

/// For every cell of the grid the group of cells that it hangs together with by nodes.
fn groups(mesh: &Mesh) -> Vec<usize> {
    let all: Vec<CellId> = (1..=3).flat_map(|dim| mesh.cells(dim)).collect();
    let mut groups = Vec::new();
    for (group, cells) in quality::parts(mesh, &all).into_iter().enumerate() {
        for cell in cells {
            let at = place(mesh, cell);
            groups.resize(groups.len().max(at + 1), 0);
            groups[at] = group;
        }
    }
    groups
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
    let inner = (0..element.nnode()).find(|node| !ring.contains(node));
    match (element.order(), inner) {
        // a fan round the node in the middle
        (_, Some(middle)) => (0..n).map(|k| [at(k), at(k + 1), middle]).collect(),
        // corners cut off, and the polygon that is left
        (2, None) => {
            let corners = (0..n).step_by(2).map(|k| [at(k + n - 1), at(k), at(k + 1)]);
            let rest: Vec<usize> = (1..n).step_by(2).map(at).collect();
            corners.chain(fan(&rest)).collect()
        }
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
