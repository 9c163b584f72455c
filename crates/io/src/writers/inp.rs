//! Meshes as decks of Abaqus and CalculiX: nodes, elements, sets and surfaces, without materials and steps.
//!
//! Solids keep their numbers where these are distinct. A set of faces, or of cells of a lower dimension that lie on solids,
//! becomes a surface; a set of solids an element set; any other a node set. Plane solids are written as plane strain.
//!
//! Limits: no hex27 and quad9, which Abaqus does not have. Names longer than 80 letters or with quotes are cut and cleaned.

use signorini_geometry::mesh::{CellId, FaceIndex, Mesh, NodeId, Set};
use std::collections::HashSet;
use std::fmt::Write;

/// The types of elements.
const TYPES: [(&str, &str); 12] = [
    ("tet4", "C3D4"),
    ("tet10", "C3D10"),
    ("hex8", "C3D8"),
    ("hex20", "C3D20"),
    ("wedge6", "C3D6"),
    ("wedge15", "C3D15"),
    ("tri3", "CPE3"),
    ("tri6", "CPE6"),
    ("quad4", "CPE4"),
    ("quad8", "CPE8"),
    ("line2", "T3D2"),
    ("line3", "T3D3"),
];

/// Numbers in a line of a set.
const IN_LINE: usize = 12;
/// Numbers in a line of an element.
const NODES_IN_LINE: usize = 15;
/// Letters of a name.
const LONGEST: usize = 80;

/// Why a mesh has no such form.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum InpError {
    /// An element that Abaqus does not have.
    #[error("elements of type {element} have no type in a deck of Abaqus; write .vtu instead")]
    NoType {
        /// Its name.
        element: &'static str,
    },
    /// There is nothing to write.
    #[error("the mesh has no elements")]
    Empty,
}

/// A mesh as the text of a deck.
///
/// # Errors
/// [`InpError`].
pub fn encode(mesh: &Mesh) -> Result<String, InpError> {
    let dim = mesh.dim();
    if dim == 0 {
        return Err(InpError::Empty);
    }
    let all: Vec<u64> = mesh.blocks.iter().flat_map(|b| b.labels.clone()).collect();
    let deck = Deck {
        mesh,
        dim,
        nodes: labels(&mesh.node_labels),
        elements: labels(&all),
    };
    let mut out = String::from("** written by signorini convert\n*NODE, NSET=NALL\n");
    for (label, x) in deck.nodes.iter().zip(&mesh.points) {
        // writing to a string cannot fail
        let _ = writeln!(out, "{label}, {:?}, {:?}, {:?}", x.x, x.y, x.z);
    }
    deck.solids(&mut out)?;
    let index = FaceIndex::new(mesh, mesh.cells(dim));
    for (name, set) in &mesh.sets {
        deck.set(&mut out, &cleaned(name), set, &index);
    }
    Ok(out)
}

/// A mesh with the numbers that its nodes and elements have in the deck.
struct Deck<'a> {
    mesh: &'a Mesh,
    dim: usize,
    nodes: Vec<u64>,
    /// Of the cells of all blocks.
    elements: Vec<u64>,
}

impl Deck<'_> {
    fn node(&self, node: NodeId) -> Option<u64> {
        self.nodes.get(node as usize).copied()
    }

    fn element(&self, cell: CellId) -> Option<u64> {
        let before = self.mesh.blocks.iter().take(cell.block as usize);
        let start: usize = before.map(|block| block.ncell()).sum();
        self.elements.get(start + cell.index as usize).copied()
    }

    fn solids(&self, out: &mut String) -> Result<(), InpError> {
        let mut card = "";
        for cell in self.mesh.cells(self.dim) {
            let Some(element) = self.mesh.element(cell).map(|e| e.name()) else {
                continue;
            };
            let known = TYPES.iter().find(|(known, _)| *known == element);
            let (_, wanted) = known.ok_or(InpError::NoType { element })?;
            if card != *wanted {
                card = wanted;
                let _ = writeln!(out, "*ELEMENT, TYPE={card}, ELSET=EALL");
            }
            let nodes = self.mesh.cell(cell).iter();
            let nodes = nodes.filter_map(|node| self.node(*node));
            let row: Vec<u64> = self.element(cell).into_iter().chain(nodes).collect();
            rows(out, &row, NODES_IN_LINE, true);
        }
        Ok(())
    }

    fn set(&self, out: &mut String, name: &str, set: &Set, index: &FaceIndex) {
        let dim = |cell: &CellId| self.mesh.element(*cell).map_or(0, |e| e.dim());
        let (solids, lower): (Vec<CellId>, Vec<CellId>) =
            set.cells.iter().partition(|cell| dim(cell) == self.dim);
        let lower = Set {
            cells: lower,
            faces: set.faces.clone(),
            nodes: Vec::new(),
        };
        let faces = self.mesh.faces(&lower, index).unwrap_or_default();
        if !solids.is_empty() {
            let _ = writeln!(out, "*ELSET, ELSET={name}");
            let numbers = solids.iter().filter_map(|cell| self.element(*cell));
            rows(out, &numbers.collect::<Vec<_>>(), IN_LINE, false);
        }
        if !faces.is_empty() {
            let _ = writeln!(out, "*SURFACE, NAME={name}, TYPE=ELEMENT");
            for face in &faces {
                if let Some(number) = self.element(face.cell) {
                    let _ = writeln!(out, "{number}, S{}", face.side + 1);
                }
            }
        }
        if !(faces.is_empty() && solids.is_empty()) {
            return;
        }
        let of_cells = lower.cells.iter().flat_map(|cell| self.mesh.cell(*cell));
        let mut nodes: Vec<NodeId> = set.nodes.iter().chain(of_cells).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        if !nodes.is_empty() {
            let _ = writeln!(out, "*NSET, NSET={name}");
            let numbers = nodes.iter().filter_map(|node| self.node(*node));
            rows(out, &numbers.collect::<Vec<_>>(), IN_LINE, false);
        }
    }
}

/// Numbers as they are where they are distinct and above 0, else from 1 on.
fn labels(given: &[u64]) -> Vec<u64> {
    let distinct: HashSet<&u64> = given.iter().collect();
    if distinct.len() == given.len() && !distinct.contains(&0) {
        given.to_vec()
    } else {
        (1..=given.len() as u64).collect()
    }
}

/// Numbers in lines; one row goes on behind a comma where `goes_on`.
fn rows(out: &mut String, numbers: &[u64], in_line: usize, goes_on: bool) {
    let lines = numbers.chunks(in_line).map(|line| {
        let words: Vec<String> = line.iter().map(ToString::to_string).collect();
        words.join(", ")
    });
    let end = if goes_on { ",\n" } else { "\n" };
    *out += &lines.collect::<Vec<_>>().join(end);
    out.push('\n');
}

/// A name that a deck may have.
fn cleaned(name: &str) -> String {
    let letters = name.chars().filter(|c| *c != '"' && !c.is_control());
    let name: String = letters.take(LONGEST).collect();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-' || c == '.';
    if name.chars().all(is_plain) {
        name
    } else {
        format!("\"{name}\"")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::readers::read_mesh;
    use signorini_geometry::element::by_name;
    use signorini_geometry::tensor::Vec3;

    /// Two bricks, one on the other, with sets of all kinds.
    fn bricks() -> Mesh {
        let mut mesh = Mesh::default();
        for z in 0..3 {
            for [x, y] in [[0, 0], [1, 0], [1, 1], [0, 1]] {
                mesh.points.push(Vec3::from([x, y, z].map(f64::from)));
                mesh.node_labels.push(10 + mesh.points.len() as u64);
            }
        }
        let hex = by_name("hex8").unwrap();
        let lower = mesh.push_cell(hex, &[0, 1, 2, 3, 4, 5, 6, 7], 7);
        let upper = mesh.push_cell(hex, &[4, 5, 6, 7, 8, 9, 10, 11], 9);
        let quad = by_name("quad4").unwrap();
        let lid = mesh.push_cell(quad, &[8, 9, 10, 11], 1);
        let mut put = |name: &str, set: Set| mesh.sets.insert(name.to_owned(), set);
        put(
            "BODY",
            Set {
                cells: vec![lower, upper],
                ..Set::default()
            },
        );
        put(
            "LID",
            Set {
                cells: vec![lid],
                ..Set::default()
            },
        );
        put(
            "BASE",
            Set {
                nodes: vec![0, 1, 2, 3],
                ..Set::default()
            },
        );
        mesh
    }

    #[test]
    fn what_is_written_is_read_again() {
        let text = encode(&bricks()).unwrap();
        let (read, _) = read_mesh("bricks.inp", text.as_bytes()).unwrap();
        assert_eq!(read.points, bricks().points);
        assert_eq!(read.node_labels, bricks().node_labels);
        assert_eq!(read.blocks[0].labels, [7, 9]);
        assert_eq!(read.blocks[0].nodes, bricks().blocks[0].nodes);
        assert_eq!(read.sets["BODY"].cells.len(), 2);
        assert_eq!(read.sets["BASE"].nodes, [0, 1, 2, 3]);
        let lid = &read.sets["LID"].faces;
        assert_eq!(lid.len(), 1);
        assert_eq!(read.face(lid[0]).unwrap().1.iter().min(), Some(&8));
    }

    #[test]
    fn elements_that_abaqus_does_not_have_are_refused() {
        let mut mesh = bricks();
        let hex27 = by_name("hex27").unwrap();
        let nodes: Vec<u32> = (0..27).map(|n| n % 12).collect();
        mesh.push_cell(hex27, &nodes, 20);
        assert_eq!(encode(&mesh), Err(InpError::NoType { element: "hex27" }));
        assert_eq!(encode(&Mesh::default()), Err(InpError::Empty));
    }

    #[test]
    fn long_elements_go_on_in_a_second_line_and_odd_names_are_quoted() {
        let mut out = String::new();
        rows(&mut out, &(1..=21).collect::<Vec<_>>(), NODES_IN_LINE, true);
        assert_eq!(out.lines().count(), 2);
        assert!(out.lines().next().unwrap().ends_with(','));
        assert_eq!(cleaned("a b"), "\"a b\"");
        assert_eq!(cleaned("a\"b"), "ab");
    }
}
