//! From what a deck says to a mesh: numbers become nodes and cells, names become sets.

use super::card::key;
use super::deck::{Deck, Definition, Family, Instance, Region, Scope, Side};
use super::directory::{Directory, Names as Known, Special, of_instance};
use super::kind::Role;
use super::lines::{Files, Spot};
use crate::readers::MeshError;
use crate::readers::labels::Lookup;
use signorini_geometry::element::MAX_NODES;
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId, Set, boundary};
use signorini_geometry::tensor::{Mat3, Vec3};
use std::collections::{BTreeMap, HashSet};
use std::mem::take;

type Result<T> = std::result::Result<T, MeshError>;

/// Sets, or copies of parts, may hold this many entries more than the deck has bytes, and twice as many.
const ENTRIES: u64 = 1 << 20;

/// A named set.
#[derive(Default)]
struct Named {
    /// As it was written first.
    name: String,
    set: Set,
}

type Names = BTreeMap<String, Named>;

/// A scope whose nodes and cells are in the mesh.
struct Space {
    nodes: Lookup,
    node_ids: Vec<NodeId>,
    elements: Lookup,
    /// Nothing for elements that are no cells here.
    cells: Vec<Option<CellId>>,
    node_sets: Names,
    cell_sets: Names,
    surfaces: Names,
    surfaces_of_nodes: Names,
    /// What numbers of nodes and elements are more than in the deck.
    shift: [u64; 2],
    /// Numbers in the mesh of elements that are no cells, by their places.
    special: BTreeMap<u32, u64>,
    /// The same, by the element sets that hold them.
    special_sets: BTreeMap<String, Vec<u64>>,
}

impl Space {
    fn names(&mut self, family: Family) -> &mut Names {
        match family {
            Family::Nodes => &mut self.node_sets,
            Family::Cells => &mut self.cell_sets,
            Family::Faces => &mut self.surfaces,
            Family::Points => &mut self.surfaces_of_nodes,
        }
    }

    fn get(&self, family: Family, key: &str) -> Option<&Set> {
        let names = match family {
            Family::Nodes => &self.node_sets,
            Family::Cells => &self.cell_sets,
            Family::Faces => &self.surfaces,
            Family::Points => &self.surfaces_of_nodes,
        };
        names.get(key).map(|named| &named.set)
    }
}

/// A deck as a mesh, and what its names are called there.
pub(super) struct Assembled {
    pub mesh: Mesh,
    pub directory: Directory,
    /// What is unusual.
    pub notes: Vec<String>,
}

/// Makes the mesh; of a `whole` deck, its cards say what springs and bars are.
pub(super) fn assemble(files: &Files<'_>, deck: Deck, whole: bool) -> Result<Assembled> {
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
    for family in [Family::Cells, Family::Nodes, Family::Faces, Family::Points] {
        assembly.define_all(family)?;
    }
    assembly.note_missing();
    assembly.name_sets();
    assembly.directory.instances = assembly.instances;
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
        let in_words = |count: u64, name: &str| {
            let s = if count == 1 { "" } else { "s" };
            format!("{count} element{s} of type {name}")
        };
        let kinds = || self.deck.kinds.iter().zip(self.counts.iter().copied());
        let left_out = || kinds().filter(|(kind, count)| kind.element.is_none() && *count > 0);
        let highest = left_out().map(|(kind, _)| kind.dim()).max().unwrap_or(0);
        let springs = || kinds().any(|(kind, count)| count > 0 && kind.is_spring());
        if highest >= dim.max(1) || dim == 0 && !springs() {
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
                (None, _) if whole && kind.is_spring() => continue,
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

    /// Makes the sets of a family: those of instances first, for the assembly names them; and in each what *NODE and
    /// *ELEMENT name first, as CalculiX sorts its cards.
    fn define_all(&mut self, family: Family) -> Result<()> {
        let nspace = self.spaces.len();
        let scopes = take(&mut self.deck.scopes);
        for number in (1..nspace).chain([0]) {
            let definitions = scopes.get(number).map_or(&[][..], |s| &s.definitions);
            let of_family = || definitions.iter().filter(|d| d.family == family);
            for definition in of_family().filter(|d| !d.added.is_empty()) {
                self.define(number, definition)?;
            }
            for definition in of_family().filter(|d| d.added.is_empty()) {
                self.define(number, definition)?;
            }
        }
        self.deck.scopes = scopes;
        Ok(())
    }

    fn define(&mut self, number: usize, definition: &Definition) -> Result<()> {
        let target = match &definition.instance {
            None => number,
            Some(name) => match self.instances.get(&key(name)) {
                Some(space) => *space,
                None => return Err(self.undefined(definition, "instance", name)),
            },
        };
        let mut found = Set::default();
        match definition.family {
            Family::Cells => self.cells(target, definition, &mut found)?,
            Family::Nodes | Family::Points => self.nodes(target, definition, &mut found)?,
            Family::Faces => {
                for (region, side) in &definition.sides {
                    self.side(target, definition, region, *side, &mut found)?;
                }
            }
        }
        let Some(space) = self.spaces.get_mut(number) else {
            return Ok(());
        };
        let named = (space.names(definition.family))
            .entry(key(&definition.name))
            .or_insert_with(|| Named {
                name: definition.name.clone(),
                set: Set::default(),
            });
        named.set.nodes.append(&mut found.nodes);
        named.set.cells.append(&mut found.cells);
        named.set.faces.append(&mut found.faces);
        Ok(())
    }

    /// A set by its name, as seen from a space.
    fn find(&self, number: usize, family: Family, name: &str) -> Option<&Set> {
        let found = self.spaces.get(number)?.get(family, &key(name));
        found.or_else(|| {
            let (space, rest) = of_instance(&self.instances, name).filter(|_| number == 0)?;
            self.spaces.get(space)?.get(family, &key(rest))
        })
    }

    fn undefined(&self, definition: &Definition, what: &'static str, name: &str) -> MeshError {
        let names = |family| {
            let named = self.spaces.iter().flat_map(move |space| match family {
                Family::Nodes => space.node_sets.values(),
                Family::Cells => space.cell_sets.values(),
                Family::Faces => space.surfaces.values(),
                Family::Points => space.surfaces_of_nodes.values(),
            });
            named.map(|named| named.name.as_str()).take(11)
        };
        let mut known: Vec<&str> = match what {
            "node set" => names(Family::Nodes).collect(),
            "element set" => names(Family::Cells).collect(),
            "instance" => (self.deck.instances.iter().map(|i| i.name.as_str()).take(11)).collect(),
            _ => Vec::new(),
        };
        if known.len() > 10 {
            known.truncate(10);
            known.push("…");
        }
        let known = match known.is_empty() {
            true => String::new(),
            false => format!(" before this line; there are {}", known.join(", ")),
        };
        MeshError::Undefined {
            place: self.files.place(definition.spot),
            what,
            name: name.chars().take(80).collect(),
            known,
        }
    }

    fn miss(&mut self, definition: &Definition, label: u64) {
        let of = (definition.name.clone(), definition.family.word());
        let entry = self.missing.entry(of).or_insert((0, label));
        entry.0 += 1;
    }

    /// Places of the numbers and ranges of a definition.
    fn places(&mut self, number: usize, definition: &Definition) -> Result<Vec<u32>> {
        let mut places: Vec<u32> = Vec::with_capacity(definition.labels.len());
        places.extend(definition.added.clone().map(|place| place as u32));
        for &label in &definition.labels {
            let lookup = self
                .spaces
                .get(number)
                .map(|space| match definition.family {
                    Family::Cells => &space.elements,
                    _ => &space.nodes,
                });
            match lookup.and_then(|lookup| lookup.find(label)) {
                Some(place) => places.push(place),
                None => self.miss(definition, label),
            }
        }
        self.spend(places.len(), definition.spot, "the sets")?;
        for &[first, last, step] in &definition.ranges {
            let before = places.len();
            if let Some(space) = self.spaces.get(number) {
                match definition.family {
                    Family::Cells => space.elements.range(first, last, step, &mut places),
                    _ => space.nodes.range(first, last, step, &mut places),
                }
            }
            self.spend(places.len() - before, definition.spot, "the sets")?;
        }
        Ok(places)
    }

    fn cells(&mut self, number: usize, definition: &Definition, out: &mut Set) -> Result<()> {
        let places = self.places(number, definition)?;
        let cells = self.spaces.get(number).map(|space| &space.cells);
        let cell = |place: &u32| cells?.get(*place as usize).copied().flatten();
        out.cells.extend(places.iter().filter_map(cell));
        self.note_special(number, &places, definition);
        for name in &definition.names {
            let found = match self.find(number, Family::Cells, name) {
                Some(set) => set.cells.clone(),
                None => match self.single(number, name, |space| &space.elements) {
                    Some((space, at)) => {
                        let cells = self.spaces.get(space).map(|space| &space.cells);
                        let cell = cells.and_then(|cells| cells.get(at as usize));
                        cell.copied().flatten().into_iter().collect()
                    }
                    None => return Err(self.undefined(definition, "element set", name)),
                },
            };
            self.spend(found.len(), definition.spot, "the sets")?;
            out.cells.extend(found);
        }
        Ok(())
    }

    /// Remembers the elements of a set that are no cells.
    fn note_special(&mut self, number: usize, places: &[u32], definition: &Definition) {
        let Some(space) = self.spaces.get_mut(number) else {
            return;
        };
        if !space.special.is_empty() {
            let labels = places.iter().filter_map(|place| space.special.get(place));
            let of_set = space.special_sets.entry(key(&definition.name)).or_default();
            of_set.extend(labels);
        }
    }

    fn nodes(&mut self, number: usize, definition: &Definition, out: &mut Set) -> Result<()> {
        let places = self.places(number, definition)?;
        let ids = self.spaces.get(number).map(|space| &space.node_ids);
        let id = |place: &u32| ids?.get(*place as usize).copied();
        out.nodes.extend(places.iter().filter_map(id));
        for name in &definition.names {
            let found = match self.find(number, Family::Nodes, name) {
                Some(set) => set.nodes.clone(),
                None => match self.single(number, name, |space| &space.nodes) {
                    Some((space, at)) => {
                        let ids = self.spaces.get(space).map(|space| &space.node_ids);
                        let id = ids.and_then(|ids| ids.get(at as usize));
                        id.copied().into_iter().collect()
                    }
                    None => return Err(self.undefined(definition, "node set", name)),
                },
            };
            self.spend(found.len(), definition.spot, "the sets")?;
            out.nodes.extend(found);
        }
        for name in &definition.elsets {
            let Some(set) = self.find(number, Family::Cells, name) else {
                return Err(self.undefined(definition, "element set", name));
            };
            let found = self.mesh.nodes_of(set);
            let work = set.cells.len().saturating_mul(8) + found.len();
            self.spend(work, definition.spot, "the sets")?;
            out.nodes.extend(found);
        }
        Ok(())
    }

    /// A single number of an instance: `part-1.12`.
    fn single(
        &self,
        number: usize,
        name: &str,
        lookup: impl Fn(&Space) -> &Lookup,
    ) -> Option<(usize, u32)> {
        let (space, label) = of_instance(&self.instances, name).filter(|_| number == 0)?;
        let place = lookup(self.spaces.get(space)?).find(label.parse().ok()?)?;
        Some((space, place))
    }

    /// One line of a surface.
    fn side(
        &mut self,
        number: usize,
        definition: &Definition,
        region: &Region,
        side: Side,
        out: &mut Set,
    ) -> Result<()> {
        let one;
        let cells = match region {
            Region::Label(label) => {
                let space = self.spaces.get(number);
                let place = space.and_then(|space| space.elements.find(*label));
                let cell = space
                    .zip(place)
                    .and_then(|(s, at)| s.cells.get(at as usize));
                let Some(cell) = cell else {
                    return Err(self.undefined(definition, "element", &label.to_string()));
                };
                one = cell.map_or(Vec::new(), |cell| vec![cell]);
                one
            }
            Region::Name(name) => match self.find(number, Family::Cells, name) {
                Some(set) => set.cells.clone(),
                None => return Err(self.undefined(definition, "element set", name)),
            },
        };
        self.spend(cells.len() + 1, definition.spot, "the sets")?;
        let dim = self.mesh.dim();
        if side == Side::Free {
            return self.free_sides(definition, cells, out);
        }
        for cell in cells {
            let Some(element) = self.mesh.element(cell) else {
                continue;
            };
            let nside = element.sides().len();
            match side {
                Side::Number(n) if element.dim() == dim && usize::from(n) <= nside => {
                    out.faces.push(Face { cell, side: n - 1 });
                }
                Side::Number(1 | 2) | Side::Face if element.dim() + 1 == dim => {
                    out.cells.push(cell);
                }
                _ => {
                    let hint = match element.dim() == dim {
                        true => format!("; its sides are S1 to S{nside}"),
                        false => "; name a side of the solid".to_owned(),
                    };
                    return Err(MeshError::NoSuchSide {
                        place: self.files.place(definition.spot),
                        surface: definition.name.as_str().into(),
                        element: self.mesh.cell_label(cell).unwrap_or(0),
                        kind: element.name(),
                        side: match side {
                            Side::Number(n) => format!("S{n}").into(),
                            _ => "SPOS or SNEG".into(),
                        },
                        hint: hint.into(),
                    });
                }
            }
        }
        Ok(())
    }

    /// The sides of these cells that no other cell has.
    fn free_sides(
        &mut self,
        definition: &Definition,
        mut cells: Vec<CellId>,
        out: &mut Set,
    ) -> Result<()> {
        cells.sort_unstable();
        cells.dedup();
        let mesh = &self.mesh;
        let free = (self.free).get_or_insert_with(|| boundary(mesh, mesh.cells(mesh.dim())));
        let before = out.faces.len();
        for cell in cells {
            let start = free.partition_point(|face| face.cell < cell);
            let of_cell = free.iter().skip(start).take_while(|face| face.cell == cell);
            out.faces.extend(of_cell);
        }
        self.spend(out.faces.len() - before, definition.spot, "the sets")
    }

    fn note_missing(&mut self) {
        for ((name, word), (count, first)) in take(&mut self.missing) {
            let what = match (word, count) {
                ("element set", 1) => "element",
                ("element set", _) => "elements",
                (_, 1) => "node",
                _ => "nodes",
            };
            let note = format!("{word} `{name}`: {count} {what} not in the mesh, such as {first}");
            self.notes.push(note);
        }
    }

    /// Gives every set its name in the mesh.
    ///
    /// Where several kinds have one name, the first of element set, surface, surface of nodes and node set has it alone;
    /// the others are `name.faces`, `name.points` and `name.nodes`, unless they mean the same nodes.
    fn name_sets(&mut self) {
        let prefixes: Vec<String> = std::iter::once(String::new())
            .chain(self.deck.instances.iter().map(|i| format!("{}.", i.name)))
            .collect();
        for (mut space, prefix) in take(&mut self.spaces).into_iter().zip(&prefixes) {
            let mut known = Known {
                shift: space.shift,
                special: take(&mut space.special_sets),
                ..Known::default()
            };
            for family in [Family::Cells, Family::Faces, Family::Points, Family::Nodes] {
                for (compared, named) in take(space.names(family)) {
                    let name = format!("{prefix}{}", named.name);
                    let name = self.name_set(family, name, named.set);
                    known.sets[family as usize].insert(compared, name);
                }
            }
            self.directory.spaces.push(known);
            let all: Vec<CellId> = space.cells.into_iter().flatten().collect();
            let instance = prefix.trim_end_matches('.');
            if !instance.is_empty() && !self.is_taken(instance) {
                let set = Set {
                    cells: all,
                    ..Set::default()
                };
                self.mesh.sets.insert(instance.to_owned(), set);
            }
        }
    }

    /// Whether a set has this name, in whatever letters.
    fn is_taken(&self, name: &str) -> bool {
        self.mesh.sets.contains_key(name)
    }

    /// Puts a set into the mesh, and answers what it is called there.
    fn name_set(&mut self, family: Family, name: String, mut set: Set) -> String {
        set.nodes.sort_unstable();
        set.nodes.dedup();
        set.cells.sort_unstable();
        set.cells.dedup();
        // in the order of their lines: whatever is made from them is numbered by it
        let mut seen = HashSet::new();
        set.faces.retain(|face| seen.insert(*face));
        if set.is_empty() {
            self.notes
                .push(format!("{} `{name}` is empty", family.word()));
        }
        let Some(taken) = self.mesh.sets.get(&name) else {
            self.mesh.sets.insert(name.clone(), set);
            return name;
        };
        if self.mesh.nodes_of(taken) == self.mesh.nodes_of(&set) && family == Family::Nodes {
            return name;
        }
        let suffix = match family {
            Family::Nodes => "nodes",
            Family::Cells => "elements",
            Family::Faces => "faces",
            Family::Points => "points",
        };
        let other = format!("{name}.{suffix}");
        self.notes.push(format!(
            "{} `{name}` is called `{other}`: another set has its name",
            family.word()
        ));
        self.mesh.sets.insert(other.clone(), set);
        other
    }
}

/// A part as an instance has it: moved, then turned.
fn copy(part: &Scope, instance: &Instance) -> Scope {
    let shift = instance.translation;
    let turn = instance.rotation.and_then(|(a, b, angle)| {
        let axis = (b - a).normalized()?;
        Some((a, Mat3::rotation(axis * angle.to_radians())))
    });
    let place = |&x: &Vec3| match turn {
        Some((a, rotation)) => a + rotation * (x + shift - a),
        None => x + shift,
    };
    Scope {
        node_labels: part.node_labels.clone(),
        points: part.points.iter().map(place).collect(),
        node_spots: part.node_spots.clone(),
        element_labels: part.element_labels.clone(),
        element_kinds: part.element_kinds.clone(),
        element_spots: part.element_spots.clone(),
        connectivity: part.connectivity.clone(),
        definitions: part.definitions.clone(),
    }
}

/// Adds what an instance has of its own.
fn append(scope: &mut Scope, own: Scope) {
    let (nnode, nelement) = (scope.points.len(), scope.element_labels.len());
    scope.node_labels.extend(own.node_labels);
    scope.points.extend(own.points);
    scope.node_spots.extend(own.node_spots);
    scope.element_labels.extend(own.element_labels);
    scope.element_kinds.extend(own.element_kinds);
    scope.element_spots.extend(own.element_spots);
    scope.connectivity.extend(own.connectivity);
    scope
        .definitions
        .extend(own.definitions.into_iter().map(|mut definition| {
            let shift = match definition.family {
                Family::Cells => nelement,
                _ => nnode,
            };
            let added = definition.added;
            definition.added = added.start + shift..added.end + shift;
            definition
        }));
}
