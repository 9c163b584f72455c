//! Which faces there are: the faces behind lower-dimensional cells, the nodes of a set, the boundary of a body.

use super::{CellId, Face, Mesh, NodeId, Set};
use crate::element::Element;
use thiserror::Error;

/// Why a set cannot be used as asked.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SetError {
    /// A lower-dimensional cell that lies on no solid.
    #[error("element {label} ({element}) of this set coincides with no side of a solid")]
    NoSolidBehind {
        /// Its number in the input.
        label: u64,
        /// Its type.
        element: &'static str,
    },
    /// A face between two solids.
    #[error(
        "the face of element {label} in this set lies inside the body: element {other} is on its other side"
    )]
    Interior {
        /// The element whose face was named.
        label: u64,
        /// The element behind it.
        other: u64,
    },
}

/// Finds solids by the nodes of their sides.
pub struct FaceIndex {
    /// Where the sides begin whose lowest corner is each node.
    start: Vec<u32>,
    sides: Vec<Side>,
}

/// A side by its corners.
#[derive(Clone, Copy)]
struct Side {
    /// Its other corners, sorted and padded.
    others: [NodeId; 3],
    face: Face,
}

/// At most four corners identify a side, sorted and padded: the lowest one and the others. Mid nodes do not matter.
fn key(corners: impl Iterator<Item = NodeId>) -> (NodeId, [NodeId; 3]) {
    let mut key = [NodeId::MAX; 4];
    for (k, n) in key.iter_mut().zip(corners) {
        *k = n;
    }
    key.sort_unstable();
    let [lowest, others @ ..] = key;
    (lowest, others)
}

/// The sides of a cell.
fn sides_of(mesh: &Mesh, cell: CellId) -> impl Iterator<Item = (NodeId, Side)> {
    let nodes = mesh.cell(cell);
    let sides = mesh.element(cell).map_or(&[][..], |e| e.sides());
    sides.iter().enumerate().map(move |(number, side)| {
        let corners = side.nodes.iter().take(side.element.ncorner());
        let (lowest, others) = key(corners.filter_map(|&i| nodes.get(i).copied()));
        let face = Face {
            cell,
            side: number as u8,
        };
        (lowest, Side { others, face })
    })
}

impl FaceIndex {
    /// Indexes all sides of these cells.
    #[must_use]
    pub fn new(mesh: &Mesh, cells: impl IntoIterator<Item = CellId>) -> Self {
        let cells: Vec<CellId> = cells.into_iter().collect();
        let all = || cells.iter().flat_map(|&cell| sides_of(mesh, cell));
        // of nodes that are in no cell there is one more, which stands for corners that are missing
        let nnode = mesh.points.len();
        let place = |lowest: NodeId| nnode.min(lowest as usize);
        let mut start = vec![0u32; nnode + 2];
        all().for_each(|(lowest, _)| start[place(lowest) + 1] += 1);
        for node in 0..=nnode {
            start[node + 1] += start[node];
        }
        let mut next = start.clone();
        let cell = CellId { block: 0, index: 0 };
        let nothing = Side {
            others: [NodeId::MAX; 3],
            face: Face { cell, side: 0 },
        };
        let mut sides = vec![nothing; start[nnode + 1] as usize];
        all().for_each(|(lowest, side)| {
            let next = &mut next[place(lowest)];
            sides[*next as usize] = side;
            *next += 1;
        });
        Self { start, sides }
    }

    /// The sides with this lowest corner, in the order of their cells.
    fn with_lowest(&self, node: NodeId) -> &[Side] {
        let ends = self
            .start
            .get(node as usize..)
            .and_then(<[u32]>::first_chunk);
        let range = ends.map(|&[from, to]| from as usize..to as usize);
        range.and_then(|r| self.sides.get(r)).unwrap_or(&[])
    }

    /// The one or two faces with the corners of this element with these nodes, whatever corner comes first.
    #[must_use]
    pub fn find(&self, element: Element, nodes: &[NodeId]) -> Option<(Face, Option<Face>)> {
        let (lowest, others) = key(nodes.iter().copied().take(element.ncorner()));
        let sides = self.with_lowest(lowest).iter();
        let mut same = sides.filter(|side| side.others == others).map(|s| s.face);
        Some((same.next()?, same.next()))
    }

    /// The sides that only one cell has, sorted.
    #[must_use]
    pub fn boundary(&self) -> Vec<Face> {
        let mut faces = Vec::new();
        for node in 0..self.start.len().saturating_sub(1) {
            let sides = self.with_lowest(node as NodeId);
            let is_alone = |side: &&Side| {
                let same = sides.iter().filter(|other| other.others == side.others);
                same.count() == 1
            };
            faces.extend(sides.iter().filter(is_alone).map(|side| side.face));
        }
        faces.sort_unstable();
        faces
    }
}

/// The outer faces of a body made of these cells, sorted.
#[must_use]
pub fn boundary(mesh: &Mesh, cells: impl IntoIterator<Item = CellId>) -> Vec<Face> {
    FaceIndex::new(mesh, cells).boundary()
}

impl Mesh {
    /// The faces that a set stands for: those named, and those that its lower-dimensional cells lie on. Sorted,
    /// each once. `index` must hold the sides of all solids.
    ///
    /// # Errors
    /// A cell without a solid behind it; a face inside a body.
    pub fn faces(&self, set: &Set, index: &FaceIndex) -> Result<Vec<Face>, SetError> {
        let mut faces = Vec::with_capacity(set.faces.len());
        let label = |cell| self.cell_label(cell).unwrap_or(0);
        for &face in &set.faces {
            let Some((element, nodes)) = self.face(face) else {
                continue;
            };
            if let Some((first, Some(second))) = index.find(element, &nodes) {
                let other = if first == face { second } else { first };
                return Err(SetError::Interior {
                    label: label(face.cell),
                    other: label(other.cell),
                });
            }
            faces.push(face);
        }
        let solid = self.dim();
        for &cell in &set.cells {
            let Some(element) = self.element(cell) else {
                continue;
            };
            if element.dim() + 1 != solid {
                continue;
            }
            match index.find(element, self.cell(cell)) {
                None => {
                    return Err(SetError::NoSolidBehind {
                        label: label(cell),
                        element: element.name(),
                    });
                }
                Some((first, Some(second))) => {
                    return Err(SetError::Interior {
                        label: label(first.cell),
                        other: label(second.cell),
                    });
                }
                Some((face, None)) => faces.push(face),
            }
        }
        faces.sort_unstable();
        faces.dedup();
        Ok(faces)
    }

    /// Every node of a set: those named, those of its cells, those of its faces. Sorted, each once.
    #[must_use]
    pub fn nodes_of(&self, set: &Set) -> Vec<NodeId> {
        let mut nodes = set.nodes.clone();
        for &cell in &set.cells {
            nodes.extend_from_slice(self.cell(cell));
        }
        for &face in &set.faces {
            if let Some((_, of_face)) = self.face(face) {
                nodes.extend(of_face);
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{TABLE, by_name};
    use crate::tensor::Vec3;

    /// Two unit cubes side by side along x, and a quadrilateral on the top of the second.
    fn two_cubes() -> Mesh {
        let mut mesh = Mesh::default();
        for z in 0..2 {
            for y in 0..2 {
                for x in 0..3 {
                    mesh.points
                        .push(Vec3::new(f64::from(x), f64::from(y), f64::from(z)));
                    mesh.node_labels.push(mesh.points.len() as u64);
                }
            }
        }
        let hex = by_name("hex8").unwrap();
        mesh.push_cell(hex, &[0, 1, 4, 3, 6, 7, 10, 9], 1);
        mesh.push_cell(hex, &[1, 2, 5, 4, 7, 8, 11, 10], 2);
        mesh.push_cell(by_name("quad4").unwrap(), &[8, 11, 10, 7], 3);
        mesh
    }

    #[test]
    fn boundary_of_two_cubes_has_ten_faces() {
        let mesh = two_cubes();
        let faces = boundary(&mesh, mesh.cells(3));
        assert_eq!(faces.len(), 10);
        assert!(faces.windows(2).all(|w| w[0] < w[1]));
    }

    #[test]
    fn a_surface_cell_stands_for_the_side_of_the_solid_under_it() {
        let mesh = two_cubes();
        let index = FaceIndex::new(&mesh, mesh.cells(3));
        let set = Set {
            cells: mesh.cells(2).collect(),
            ..Set::default()
        };
        let faces = mesh.faces(&set, &index).unwrap();
        assert_eq!(faces.len(), 1);
        assert_eq!((faces[0].cell.index, faces[0].side), (1, 1));
        assert_eq!(mesh.face(faces[0]).unwrap().1, [7, 8, 11, 10]);
    }

    #[test]
    fn interior_faces_and_loose_cells_are_refused_by_label() {
        let mut mesh = two_cubes();
        let loose = mesh.push_cell(by_name("quad4").unwrap(), &[0, 1, 11, 9], 77);
        let index = FaceIndex::new(&mesh, mesh.cells(3));
        let cells = Set {
            cells: vec![loose],
            ..Set::default()
        };
        assert_eq!(
            mesh.faces(&cells, &index),
            Err(SetError::NoSolidBehind {
                label: 77,
                element: "quad4"
            })
        );
        let quad = by_name("quad4").unwrap();
        let inner = index.find(quad, &[1, 4, 10, 7]).unwrap();
        let faces = Set {
            faces: vec![inner.0],
            ..Set::default()
        };
        assert_eq!(
            mesh.faces(&faces, &index),
            Err(SetError::Interior { label: 1, other: 2 })
        );
    }

    /// Two solids of one element that share their side 0, the second the mirror image of the first, and cells of lower
    /// dimension on their sides, each begun at another corner.
    #[test]
    fn sides_are_found_by_their_corners_whatever_the_element_and_the_first_corner() {
        for element in TABLE.into_iter().filter(|e| e.dim() > 1) {
            let mut mesh = Mesh::default();
            let n = element.nnode() as NodeId;
            let shared = element.sides()[0].nodes;
            let first: Vec<NodeId> = (0..n).collect();
            let second: Vec<NodeId> = (0..n)
                .map(|i| {
                    if shared.contains(&(i as usize)) {
                        i
                    } else {
                        n + i
                    }
                })
                .collect();
            mesh.points = vec![Vec3::ZERO; 2 * n as usize];
            let solid = mesh.push_cell(element, &first, 1);
            mesh.push_cell(element, &second, 2);
            let index = FaceIndex::new(&mesh, mesh.cells(element.dim()));
            let nside = element.sides().len();
            assert_eq!(index.boundary().len(), 2 * (nside - 1), "{element:?}");
            for (number, side) in element.sides().iter().enumerate() {
                let face = Face {
                    cell: solid,
                    side: number as u8,
                };
                assert_eq!(mesh.face(face).unwrap().1.len(), side.nodes.len());
                let ncorner = side.element.ncorner();
                for turn in 0..ncorner {
                    let mut nodes: Vec<NodeId> = side.nodes.iter().map(|&i| i as NodeId).collect();
                    nodes[..ncorner].rotate_left(turn);
                    let nmid = nodes.len().min(2 * ncorner) - ncorner;
                    let mids = &mut nodes[ncorner..][..nmid];
                    mids.rotate_left(turn.min(nmid));
                    let (found, other) = index.find(side.element, &nodes).unwrap();
                    assert_eq!((found, other.is_some()), (face, number == 0), "{element:?}");
                    let mut mesh = mesh.clone();
                    let cell = mesh.push_cell(side.element, &nodes, 3);
                    let set = Set {
                        cells: vec![cell],
                        ..Set::default()
                    };
                    let faces = mesh.faces(&set, &index);
                    assert_eq!(faces.is_err(), number == 0, "{element:?}");
                    assert!(faces.is_err() || faces == Ok(vec![face]));
                    let mut all = mesh.nodes_of(&set);
                    all.sort_unstable();
                    nodes.sort_unstable();
                    assert_eq!(all, nodes, "{element:?}");
                }
            }
        }
    }
}
