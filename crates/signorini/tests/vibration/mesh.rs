//! Blocks of quadrilaterals and hexahedra, as text of a case.

use signorini_geometry::element::by_name;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A block of so many cells.
pub struct Block {
    pub group: &'static str,
    pub element: &'static str,
    pub cells: [usize; 3],
    pub origin: [f64; 3],
    pub size: [f64; 3],
}

/// Blocks next to one another, with nodes of their own.
#[derive(Default)]
pub struct Mesh {
    pub nodes: Vec<[f64; 3]>,
    elements: String,
    nelement: usize,
    /// Element and side of the faces at the ends of each block: `bar -x`.
    faces: BTreeMap<String, Vec<String>>,
    is_plane: bool,
}

impl Mesh {
    pub fn of(blocks: &[Block]) -> Self {
        let mut mesh = Self::default();
        blocks.iter().for_each(|block| mesh.add(block));
        mesh
    }

    fn add(&mut self, block: &Block) {
        let element = by_name(block.element).unwrap();
        self.is_plane = element.dim() == 2;
        let last = if self.is_plane { 1 } else { block.cells[2] };
        let mut known: BTreeMap<[usize; 3], usize> = BTreeMap::new();
        for cell in 0..block.cells[0] * block.cells[1] * last {
            let at = [
                cell % block.cells[0],
                cell / block.cells[0] % block.cells[1],
                cell / (block.cells[0] * block.cells[1]),
            ];
            let mut numbers = Vec::new();
            for xi in element.nodes() {
                // on a lattice of half cells
                let place = [0, 1, 2].map(|a| 2 * at[a] + (xi[a] + 1.0).round() as usize);
                let number = *known.entry(place).or_insert_with(|| {
                    let x = [0, 1, 2].map(|a| {
                        let part = place[a] as f64 / (2 * block.cells[a].max(1)) as f64;
                        block.origin[a]
                            + if a == 2 && self.is_plane {
                                0.0
                            } else {
                                part * block.size[a]
                            }
                    });
                    self.nodes.push(x);
                    self.nodes.len()
                });
                numbers.push(number.to_string());
            }
            self.nelement += 1;
            writeln!(
                self.elements,
                "{{ id = {}, type = \"{}\", group = \"{}\", nodes = [{}] }},",
                self.nelement,
                block.element,
                block.group,
                numbers.join(", ")
            )
            .unwrap();
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(element.dim()) {
                for (sign, end) in [("-", 0), ("+", block.cells[axis] - 1)] {
                    if at[axis] == end {
                        let face = format!("[{}, \"{sign}{name}\"]", self.nelement);
                        let key = format!("{} {sign}{name}", block.group);
                        self.faces.entry(key).or_default().push(face);
                    }
                }
            }
        }
    }

    /// The table `[mesh]`.
    pub fn text(&self) -> String {
        let mut nodes = String::new();
        for (number, [x, y, z]) in self.nodes.iter().enumerate() {
            let z = if self.is_plane {
                String::new()
            } else {
                format!(", {z:?}")
            };
            writeln!(nodes, "[{}, {x:?}, {y:?}{z}],", number + 1).unwrap();
        }
        format!(
            "[mesh]\nnodes = [\n{nodes}]\nelements = [\n{}]\n",
            self.elements
        )
    }

    /// A set of faces at the end of a block.
    pub fn faces(&self, name: &str, of: &str) -> String {
        format!("{name} = {{ faces = [{}] }}\n", self.faces[of].join(", "))
    }

    /// A set of nodes.
    pub fn set(&self, name: &str, holds: impl Fn([f64; 3]) -> bool) -> String {
        let numbers = self.nodes.iter().enumerate();
        let numbers = numbers
            .filter(|(_, x)| holds(**x))
            .map(|(k, _)| (k + 1).to_string());
        format!(
            "{name} = {{ nodes = [{}] }}\n",
            numbers.collect::<Vec<_>>().join(", ")
        )
    }
}
