//! From what a deck says to a mesh: numbers become nodes and cells, names become sets.

mod instance;
mod names;
mod sets;
mod shells;
mod space;

use super::card::key;
use super::deck::{Deck, Scope};
use super::definition::Family;
use super::directory::{Directory, Special};
use super::kind::{Kind, Role};
use super::lines::{Files, Spot};
use super::part::Part;
use super::statement::Statement;
use crate::readers::MeshError;
use crate::readers::labels::Lookup;
use instance::{append, copy};
use signorini_geometry::element::MAX_NODES;
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use space::{Names, Space};
use std::collections::BTreeMap;
use std::mem::take;

type Result<T> = std::result::Result<T, MeshError>;

/// Elements of a type, in a note.
fn in_words(count: u64, name: &str) -> String {
    let s = if count == 1 { "" } else { "s" };
    format!("{count} element{s} of type {name}")
}

/// Sets, or copies of parts, may hold this many entries more than the deck has bytes, and twice as many.
const ENTRIES: u64 = 1 << 20;

/// A deck as a mesh, and what its names are called there.
pub(super) struct Assembled {
    pub mesh: Mesh,
    pub directory: Directory,
    /// What is unusual.
    pub notes: Vec<String>,
}

/// Makes the mesh; of a `whole` deck, its cards say what springs and bars are.
pub(super) fn assemble(
    files: &Files<'_>,
    deck: Deck,
    statements: &[Statement],
    part: Part,
) -> Result<Assembled> {
    let whole = part == Part::Whole;
    let nbyte = files.nbyte() as u64;
    let mut assembly = Assembly {
        files,
        mesh: Mesh::default(),
        blocks: vec![None; deck.kinds.len()],
        counts: vec![0; deck.kinds.len()],
        spaces: Vec::new(),
        instances: BTreeMap::new(),
        free: None,
        left: ENTRIES + 2 * nbyte,
        missing: BTreeMap::new(),
        highest: [0; 2],
        directory: Directory::default(),
        notes: Vec::new(),
        deck,
    };
    assembly.notes = take(&mut assembly.deck.notes);
    assembly.place_all()?;
    if assembly.mesh.ncell() == 0 && assembly.counts.iter().all(|&count| count == 0) {
        return Err(MeshError::NoElements {
            place: files.whole(),
            nnode: assembly.mesh.nnode(),
        });
    }
    assembly.judge_kinds(whole)?;
    assembly.define_all(Family::Cells)?;
    assembly.find_shells(statements, part);
    for family in [Family::Nodes, Family::Faces, Family::Points] {
        assembly.define_all(family)?;
    }
    assembly.note_missing();
    assembly.name_sets(whole);
    assembly.directory.instances = assembly.instances;
    assembly.directory.element_cards = assembly.deck.element_cards;
    assembly.directory.type_names = assembly.deck.kinds.into_iter().map(|k| k.name).collect();
    Ok(Assembled {
        mesh: assembly.mesh,
        directory: assembly.directory,
        notes: assembly.notes,
    })
}

struct Assembly<'f> {
    files: &'f Files<'f>,
    deck: Deck,
    mesh: Mesh,
    /// The block of each kind of element.
    blocks: Vec<Option<u32>>,
    /// Elements of each kind.
    counts: Vec<u64>,
    /// The deck itself comes first, its instances follow.
    spaces: Vec<Space>,
    /// The space of each instance.
    instances: BTreeMap<String, usize>,
    /// The sides that one cell alone has, once somebody asks.
    free: Option<Vec<Face>>,
    /// Entries that may still be made.
    left: u64,
    /// Numbers in sets that nothing has: how many, and the first, by set.
    missing: BTreeMap<(String, &'static str), (u64, u64)>,
    /// The highest numbers of nodes and elements so far.
    highest: [u64; 2],
    directory: Directory,
    notes: Vec<String>,
}

impl Assembly<'_> {
    fn spend(&mut self, entries: usize, spot: Spot, what: &'static str) -> Result<()> {
        let left = self.left.checked_sub(entries as u64);
        self.left = left.ok_or_else(|| MeshError::Excess {
            place: self.files.place(spot),
            what,
        })?;
        Ok(())
    }

    /// Places instances first, so that a single one keeps its numbers; what the assembly itself has comes last.
    fn place_all(&mut self) -> Result<()> {
        let mut scopes: Vec<Scope> = take(&mut self.deck.scopes);
        let mut instances = take(&mut self.deck.instances);
        let mut spaces = Vec::new();
        self.directory.scopes = vec![Vec::new(); scopes.len()];
        if let Some(whole) = self.directory.scopes.first_mut() {
            whole.push(0);
        }
        for (number, instance) in instances.iter().enumerate() {
            let own = scopes.get_mut(instance.own).map(take).unwrap_or_default();
            let part = scopes.get(instance.part);
            let part = part.ok_or_else(|| self.excess(instance.spot))?;
            let entries = part.points.len() + part.connectivity.len() + part.element_labels.len();
            self.spend(entries, instance.spot, "the copies of parts")?;
            let mut scope = copy(part, instance);
            append(&mut scope, own);
            let space = self.place(&scope, Some(&instance.name))?;
            spaces.push((space, scope.definitions));
            self.instances.insert(key(&instance.name), number + 1);
            if instance.rotation.is_some() {
                self.directory.turned.push(number + 1);
            }
            for scope in [instance.part, instance.own] {
                if let Some(spaces) = self.directory.scopes.get_mut(scope) {
                    spaces.push(number + 1);
                }
            }
        }
        let mut whole = scopes.first_mut().map(take).unwrap_or_default();
        let space = self.place(&whole, None)?;
        self.spaces.push(space);
        let mut definitions = vec![take(&mut whole.definitions)];
        for (space, of_space) in spaces {
            self.spaces.push(space);
            definitions.push(of_space);
        }
        self.deck.scopes = definitions
            .into_iter()
            .map(|definitions| Scope {
                definitions,
                ..Scope::default()
            })
            .collect();
        self.deck.instances.append(&mut instances);
        Ok(())
    }

    fn excess(&self, spot: Spot) -> MeshError {
        MeshError::Excess {
            place: self.files.place(spot),
            what: "the copies of parts",
        }
    }

    /// Puts nodes and elements of a scope into the mesh. Numbers go on from those that are there already.
    fn place(&mut self, scope: &Scope, name: Option<&str>) -> Result<Space> {
        let [node_shift, element_shift] = self.highest;
        for (highest, labels) in
            (self.highest.iter_mut()).zip([&scope.node_labels, &scope.element_labels])
        {
            let own = labels.iter().copied().max().unwrap_or(0);
            *highest = highest.saturating_add(own);
        }
        let nodes = Lookup::new(&scope.node_labels);
        let node_ids = self.place_nodes(scope, &nodes, node_shift)?;
        let elements = Lookup::new(&scope.element_labels);
        let mut space = Space {
            nodes,
            node_ids,
            elements,
            cells: Vec::new(),
            node_sets: Names::new(),
            cell_sets: Names::new(),
            surfaces: Names::new(),
            surfaces_of_nodes: Names::new(),
            shift: [node_shift, element_shift],
            special: BTreeMap::new(),
            special_sets: BTreeMap::new(),
        };
        self.place_elements(scope, &mut space, element_shift)?;
        let of = name.map_or("the assembly".to_owned(), |name| {
            format!("instance `{name}`")
        });
        if node_shift > 0 && !scope.points.is_empty() {
            let note = format!("the nodes of {of} have their own numbers plus {node_shift}");
            self.notes.push(note);
        }
        if element_shift > 0 && !scope.element_labels.is_empty() {
            let note = format!("the elements of {of} have their own numbers plus {element_shift}");
            self.notes.push(note);
        }
        Ok(space)
    }

    fn place_nodes(&mut self, scope: &Scope, lookup: &Lookup, shift: u64) -> Result<Vec<NodeId>> {
        let mut ids: Vec<NodeId> = Vec::with_capacity(scope.points.len());
        for (place, (&label, &x)) in scope.node_labels.iter().zip(&scope.points).enumerate() {
            let first = lookup.find(label).unwrap_or(0) as usize;
            if first == place {
                ids.push(self.mesh.points.len() as NodeId);
                self.mesh.points.push(x);
                self.mesh.node_labels.push(label.saturating_add(shift));
                continue;
            }
            // written twice, word by word, it does no harm
            match ids.get(first) {
                Some(&id) if scope.points.get(first) == Some(&x) => ids.push(id),
                _ => {
                    let spot = scope.node_spots.get(place).copied().unwrap_or_default();
                    return Err(MeshError::DuplicateNode {
                        place: self.files.place(spot),
                        node: label,
                    });
                }
            }
        }
        Ok(ids)
    }

    fn place_elements(&mut self, scope: &Scope, space: &mut Space, shift: u64) -> Result<()> {
        let mut connectivity = scope.connectivity.as_slice();
        let mut nodes = [0; MAX_NODES];
        space.cells.reserve(scope.element_labels.len());
        for (place, (&label, &kind)) in
            (scope.element_labels.iter().zip(&scope.element_kinds)).enumerate()
        {
            let spot = || scope.element_spots.get(place).copied().unwrap_or_default();
            if space.elements.find(label) != Some(place as u32) {
                return Err(MeshError::DuplicateElement {
                    place: self.files.place(spot()),
                    element: label,
                });
            }
            let Some(of_kind) = self.deck.kinds.get(kind as usize) else {
                continue;
            };
            let labels;
            (labels, connectivity) = connectivity
                .split_at_checked(of_kind.nnode)
                .unwrap_or_default();
            if let Some(count) = self.counts.get_mut(kind as usize) {
                *count += 1;
            }
            let Some(element) = of_kind.element else {
                let label = label.saturating_add(shift);
                space.cells.push(None);
                space.special.insert(place as u32, label);
                self.directory.special.push(Special {
                    kind: of_kind.name.clone(),
                    label,
                    nodes: (labels.iter())
                        .map(|node| node.saturating_add(space.shift[0]))
                        .collect(),
                    card: scope.element_cards.get(place).copied(),
                });
                continue;
            };
            let ids = nodes.get_mut(..labels.len()).unwrap_or_default();
            for (i, &node) in labels.iter().enumerate() {
                let at = space.nodes.find(node);
                let id = at.and_then(|at| space.node_ids.get(at as usize));
                let Some(&id) = id else {
                    return Err(MeshError::MissingNode {
                        place: self.files.place(spot()),
                        element: label,
                        node,
                    });
                };
                let (before, rest) = ids.split_at_mut(i);
                if before.contains(&id) {
                    return Err(MeshError::RepeatedNode {
                        place: self.files.place(spot()),
                        element: label,
                        node,
                    });
                }
                if let Some(entry) = rest.first_mut() {
                    *entry = id;
                }
            }
            let known = self.blocks.get(kind as usize).copied().flatten();
            let number = known.unwrap_or_else(|| self.mesh.block_mut(element).0);
            if let Some(entry) = self.blocks.get_mut(kind as usize) {
                *entry = Some(number);
            }
            let Some(block) = self.mesh.blocks.get_mut(number as usize) else {
                continue;
            };
            block.nodes.extend_from_slice(ids);
            block.labels.push(label.saturating_add(shift));
            let types = &mut self.directory.types;
            types.resize_with(types.len().max(number as usize + 1), Vec::new);
            if let Some(types) = types.get_mut(number as usize) {
                types.push(kind);
            }
            if let Some(&card) = scope.element_cards.get(place) {
                let cards = &mut self.directory.cards;
                cards.resize_with(cards.len().max(number as usize + 1), Vec::new);
                if let Some(cards) = cards.get_mut(number as usize) {
                    cards.push(card);
                }
            }
            space.cells.push(Some(CellId {
                block: number,
                index: (block.labels.len() - 1) as u32,
            }));
        }
        Ok(())
    }

    /// Refuses solids that have no element here; notes what it leaves out and what types mean.
    fn judge_kinds(&mut self, whole: bool) -> Result<()> {
        let dim = self.mesh.dim();
        let kinds = || self.deck.kinds.iter().zip(self.counts.iter().copied());
        let left_out = || kinds().filter(|(kind, count)| kind.element.is_none() && *count > 0);
        let highest = left_out().map(|(kind, _)| kind.dim()).max().unwrap_or(0);
        let is_alone = |kind: &Kind| kind.is_spring() || whole && kind.is_mass();
        let moves = || kinds().any(|(kind, count)| count > 0 && is_alone(kind));
        if highest >= dim.max(1) || dim == 0 && !moves() {
            let solids = left_out().filter(|(kind, _)| kind.dim() == highest);
            let words: Vec<String> = solids.map(|(k, n)| in_words(n, &k.name)).collect();
            return Err(MeshError::Unsupported {
                place: self.files.whole(),
                found: words.join(" and "),
                hint: "export the deck with elements that are read",
            });
        }
        for (kind, count) in kinds().filter(|(_, count)| *count > 0) {
            let words = in_words(count, &kind.name);
            let role = kind.role.word();
            self.notes.push(match (kind.element, kind.role) {
                (None, _) if whole && (kind.is_spring() || kind.is_mass()) => continue,
                (None, _) => format!("{words} left out: {role}"),
                (_, Role::Truss) if whole => continue,
                (_, Role::Solid) | (_, Role::Surface) => continue,
                _ if kind.dim() < dim => {
                    format!("{words} ({role}): faces or edges of the solids, without stiffness")
                }
                (_, Role::PlaneStrain | Role::PlaneStress | Role::Axisymmetric) => {
                    format!("{words}: {role}, as the space of the model should say")
                }
                _ => format!("{words} ({role}): only the mesh is read"),
            });
        }
        Ok(())
    }
}
