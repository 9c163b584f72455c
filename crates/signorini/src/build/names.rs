//! What the names of a case stand for in its mesh.

use super::quoted;
use signorini_geometry::mesh::{CellId, Face, FaceIndex, Mesh, NodeId, Set, boundary};
use signorini_io::case::{Axis, Case, Name, Sense, SetContent, Side};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, closest, codes, listed};
use signorini_io::readers::side_by_normal;
use signorini_mechanics::model::SidePart;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Groups of the mesh and sets of the case, by name.
pub(super) struct Names<'a> {
    mesh: &'a Mesh,
    sets: BTreeMap<String, Set>,
    index: FaceIndex,
}

impl<'a> Names<'a> {
    /// Resolves all sets of the case.
    pub fn new(case: &Case, mesh: &'a Mesh, found: &mut Diagnostics) -> Self {
        let mut names = Self {
            mesh,
            sets: mesh.sets.clone(),
            index: FaceIndex::new(mesh, mesh.cells(mesh.dim())),
        };
        let nodes: HashMap<u64, NodeId> = mesh
            .node_labels
            .iter()
            .enumerate()
            .map(|(node, &label)| (label, node as NodeId))
            .collect();
        let mut cells: HashMap<u64, CellId> = HashMap::new();
        for cell in mesh.cells(mesh.dim()) {
            if let Some(label) = mesh.cell_label(cell) {
                cells.insert(label, cell);
            }
        }
        for part in &case.sets {
            let mut set = Set::default();
            match &part.content {
                SetContent::Nodes(labels) => {
                    set.nodes = labels
                        .iter()
                        .filter_map(|l| nodes.get(l))
                        .copied()
                        .collect();
                    let unknown = labels.iter().filter(|l| !nodes.contains_key(l));
                    let unknown: Vec<&u64> = unknown.collect();
                    names.missing(part, "node", &unknown, found);
                }
                SetContent::Faces(faces) => {
                    let mut unknown = Vec::new();
                    for (label, side) in faces {
                        match cells.get(label) {
                            Some(&cell) => set.faces.extend(names.face(part, cell, side, found)),
                            None => unknown.push(label),
                        }
                    }
                    names.missing(part, "element", &unknown, found);
                }
                SetContent::Union(others) => {
                    for other in others {
                        if let Some(of) = names.get(other, found).cloned() {
                            set.nodes.extend(of.nodes);
                            set.cells.extend(of.cells);
                            set.faces.extend(of.faces);
                        }
                    }
                }
            }
            names.sets.insert(part.name.value.clone(), set);
        }
        names
    }

    fn missing(
        &self,
        part: &signorini_io::case::Set,
        what: &str,
        unknown: &[&u64],
        found: &mut Diagnostics,
    ) {
        let Some(first) = unknown.first() else {
            return;
        };
        let more = match unknown.len() {
            1 => String::new(),
            n => format!(" (and {} more)", n - 1),
        };
        found.push(
            Diagnostic::error(
                &codes::NOT_IN_MESH,
                format!("the mesh has no {what} {first}{more}"),
            )
            .at(&part.place, format!("in set \"{}\"", part.name.value)),
        );
    }

    fn face(
        &self,
        part: &signorini_io::case::Set,
        cell: CellId,
        side: &Side,
        found: &mut Diagnostics,
    ) -> Option<Face> {
        let text = match side {
            Side::Numbered(number) => format!("S{number}"),
            Side::Axis(axis, sense) => {
                let sign = match sense {
                    Sense::Plus => '+',
                    Sense::Minus => '-',
                };
                let axis = match axis {
                    Axis::X => 'x',
                    Axis::Y => 'y',
                    Axis::Z => 'z',
                };
                format!("{sign}{axis}")
            }
        };
        match side_by_normal(self.mesh, cell, &text) {
            Ok(side) => Some(Face { cell, side }),
            Err(error) => {
                found.push(
                    Diagnostic::error(&codes::WRONG_KIND, error.to_string())
                        .at(&part.place, format!("in set \"{}\"", part.name.value)),
                );
                None
            }
        }
    }

    fn get(&self, name: &Name, found: &mut Diagnostics) -> Option<&Set> {
        let set = self.sets.get(&name.value);
        if set.is_none() {
            let known = self.sets.keys().map(String::as_str);
            let mut message = Diagnostic::error(
                &codes::NOT_IN_MESH,
                format!("the mesh has no set or group called {}", quoted(name)),
            )
            .at(&name.place, "not found");
            message = match self.sets.len() {
                0 => message.note("there are no sets and no named groups"),
                _ => message.note(format!("there are: {}", listed(known.clone()))),
            };
            if let Some(near) = closest(&name.value, known) {
                message = message.help(format!("did you mean \"{near}\"?"));
            }
            found.push(message);
        }
        set
    }

    /// The solid cells of a set.
    pub fn solids(&self, name: &Name, found: &mut Diagnostics) -> Vec<CellId> {
        let Some(set) = self.get(name, found) else {
            return Vec::new();
        };
        let dim = self.mesh.dim();
        let is_solid = |c: &&CellId| self.mesh.element(**c).is_some_and(|e| e.dim() == dim);
        let cells: Vec<CellId> = set.cells.iter().filter(is_solid).copied().collect();
        if cells.is_empty() {
            found.push(
                Diagnostic::error(
                    &codes::WRONG_KIND,
                    format!("{} has no solid elements", quoted(name)),
                )
                .at(&name.place, "a body is made of solid elements"),
            );
        }
        cells
    }

    /// The nodes of a set.
    pub fn nodes(&self, name: &Name, found: &mut Diagnostics) -> Option<Vec<NodeId>> {
        let nodes = self.mesh.nodes_of(self.get(name, found)?);
        if nodes.is_empty() {
            found.push(
                Diagnostic::error(&codes::WRONG_KIND, format!("{} is empty", quoted(name)))
                    .at(&name.place, "no nodes in it"),
            );
            return None;
        }
        Some(nodes)
    }

    /// The faces of a set: its own, those under its surface elements, the outside of its solids, or those between its
    /// nodes.
    pub fn faces(&self, name: &Name, found: &mut Diagnostics) -> Option<Vec<Face>> {
        let set = self.get(name, found)?;
        match self.resolve(set) {
            Ok(faces) if !faces.is_empty() => Some(faces),
            Ok(_) => {
                found.push(
                    Diagnostic::error(
                        &codes::WRONG_KIND,
                        format!("{} has no faces: the primary side needs some", quoted(name)),
                    )
                    .at(&name.place, "no whole face of a solid in it")
                    .help("name a surface, or faces as  { faces = [[element, \"S1\"], ..] }"),
                );
                None
            }
            Err(error) => {
                found.push(
                    Diagnostic::error(&codes::WRONG_KIND, error).at(&name.place, "in this surface"),
                );
                None
            }
        }
    }

    /// The same without a message.
    pub fn faces_quietly(&self, name: &Name) -> Option<Vec<Face>> {
        let set = self.sets.get(&name.value)?;
        self.resolve(set).ok().filter(|f| !f.is_empty())
    }

    fn resolve(&self, set: &Set) -> Result<Vec<Face>, String> {
        let mesh = self.mesh;
        let mut faces = mesh.faces(set, &self.index).map_err(|e| e.to_string())?;
        let dim = mesh.dim();
        let is_solid = |c: &&CellId| mesh.element(**c).is_some_and(|e| e.dim() == dim);
        let solids: Vec<CellId> = set.cells.iter().filter(is_solid).copied().collect();
        if !solids.is_empty() {
            faces.extend(boundary(mesh, solids));
        }
        if faces.is_empty() && !set.nodes.is_empty() {
            let nodes: BTreeSet<NodeId> = set.nodes.iter().copied().collect();
            let inside = |f: &Face| {
                let of_face = mesh.face(*f).map(|(_, n)| n).unwrap_or_default();
                !of_face.is_empty() && of_face.iter().all(|n| nodes.contains(n))
            };
            faces.extend(self.index.boundary().into_iter().filter(inside));
        }
        faces.sort_unstable();
        faces.dedup();
        Ok(faces)
    }

    /// The secondary side of a contact: faces where they make up the whole set, bare nodes otherwise.
    pub fn side(&self, name: &Name, found: &mut Diagnostics) -> Option<SidePart> {
        let set = self.get(name, found)?;
        let only_nodes = set.cells.is_empty() && set.faces.is_empty();
        if !only_nodes {
            return self.faces(name, found).map(SidePart::Faces);
        }
        let nodes = self.nodes(name, found)?;
        let faces = self.faces_quietly(name).unwrap_or_default();
        let covered: BTreeSet<NodeId> = faces
            .iter()
            .filter_map(|f| self.mesh.face(*f))
            .flat_map(|(_, n)| n)
            .collect();
        Some(if nodes.iter().all(|n| covered.contains(n)) {
            SidePart::Faces(faces)
        } else {
            SidePart::Nodes(nodes)
        })
    }

    /// The nodes of every set.
    pub fn node_sets(&self) -> BTreeMap<String, Vec<NodeId>> {
        let sets = self.sets.iter();
        sets.map(|(name, set)| (name.clone(), self.mesh.nodes_of(set)))
            .collect()
    }
}
