//! What the names of a case stand for in its mesh.

use super::shells::Shells;
use super::{OwnPlane, idealisation};
use signorini_geometry::mesh::{CellId, Face, FaceIndex, Mesh, NodeId, Set, boundary, select};
use signorini_geometry::surface::Facets;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{Case, Name, Region, SetContent, Side};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Spanned, closest, codes, listed};
use signorini_io::readers::side_by_normal;
use signorini_mechanics::model::SidePart;
use signorini_mechanics::system::Idealisation;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// The name of everything, unless the mesh or the case has something of that name.
pub(super) const ALL: &str = "all";

/// A name as written, for messages.
pub(crate) fn quoted(name: &Spanned<String>) -> String {
    format!("\"{}\"", name.value)
}

/// Groups of the mesh and sets of the case, by name.
pub(super) struct Names<'a> {
    mesh: &'a Mesh,
    space: Idealisation,
    /// What planes stand for in bodies that differ from the model.
    planes: HashMap<CellId, Arc<OwnPlane>>,
    sets: BTreeMap<String, Set>,
    /// Surfaces, which have neither nodes nor faces.
    surfaces: BTreeSet<String>,
    nodes: HashMap<u64, NodeId>,
    index: FaceIndex,
    shells: &'a Shells,
}

/// Cells that bodies are made of.
#[derive(Debug, Default)]
pub(super) struct Cells {
    /// Of the dimension of the model.
    pub solids: Vec<CellId>,
    /// Lines, which are bars where a body is made of nothing else.
    pub bars: Vec<CellId>,
}

impl Cells {
    pub fn append(&mut self, mut other: Self) {
        self.solids.append(&mut other.solids);
        self.bars.append(&mut other.bars);
    }

    pub fn all(mut self) -> Vec<CellId> {
        if self.solids.is_empty() {
            self.solids.append(&mut self.bars);
        }
        self.solids
    }
}

impl<'a> Names<'a> {
    /// Resolves all sets of the case.
    pub fn new(case: &Case, mesh: &'a Mesh, shells: &'a Shells, found: &mut Diagnostics) -> Self {
        let ndim = case.model.space.ndim();
        Self::of_dimensions(case, mesh, shells, &[ndim], found)
    }

    /// The same of a mesh whose shells are still surfaces: sets may list these.
    pub fn of_surfaces(
        case: &Case,
        mesh: &'a Mesh,
        shells: &'a Shells,
        found: &mut Diagnostics,
    ) -> Self {
        Self::of_dimensions(case, mesh, shells, &[2, 3], found)
    }

    /// Elements that sets list are of these dimensions.
    fn of_dimensions(
        case: &Case,
        mesh: &'a Mesh,
        shells: &'a Shells,
        listed: &[usize],
        found: &mut Diagnostics,
    ) -> Self {
        let ndim = case.model.space.ndim();
        let labels = mesh.node_labels.iter().enumerate();
        let mut names = Self {
            mesh,
            space: idealisation(&case.model),
            planes: HashMap::new(),
            sets: mesh.sets.clone(),
            surfaces: case
                .surfaces
                .iter()
                .map(|one| one.name.value.clone())
                .collect(),
            nodes: labels
                .map(|(node, &label)| (label, node as NodeId))
                .collect(),
            index: FaceIndex::new(mesh, mesh.cells(ndim)),
            shells,
        };
        let all = || Set {
            cells: (1..=ndim).flat_map(|dim| mesh.cells(dim)).collect(),
            ..Set::default()
        };
        names.sets.entry(ALL.to_owned()).or_insert_with(all);
        let mut cells: HashMap<u64, CellId> = HashMap::new();
        for cell in listed.iter().flat_map(|&dim| mesh.cells(dim)) {
            if let Some(label) = mesh.cell_label(cell) {
                cells.insert(label, cell);
            }
        }
        for part in in_order(&case.sets) {
            let set = names.content(part, &cells, found);
            names.sets.insert(part.name.value.clone(), set);
        }
        names.planes = names.own_planes(case, found);
        names
    }

    /// What planes stand for in the cells of bodies that say so themselves.
    fn own_planes(&self, case: &Case, found: &mut Diagnostics) -> HashMap<CellId, Arc<OwnPlane>> {
        let thicknesses = self.thicknesses(case, found);
        let mut planes = HashMap::new();
        for body in &case.bodies {
            let cells = || {
                let groups = body.groups.iter();
                let sets = groups.filter_map(|name| self.sets.get(&name.value));
                sets.flat_map(|set| &set.cells).copied()
            };
            let nodes = || self.nodes_around(cells());
            if let Some(own) = OwnPlane::new(&case.model, body, nodes, &thicknesses) {
                let own = Arc::new(own);
                planes.extend(cells().map(|cell| (cell, Arc::clone(&own))));
            }
        }
        planes
    }

    /// The thickness of every node, 0 where the case says nothing; nothing where it says nothing of any.
    pub fn thicknesses(&self, case: &Case, found: &mut Diagnostics) -> Vec<f64> {
        if case.thicknesses.is_empty() {
            return Vec::new();
        }
        let mut thicknesses = vec![0.0; self.mesh.nnode()];
        for one in &case.thicknesses {
            for node in self.nodes(&one.on, found).unwrap_or_default() {
                if let Some(at) = thicknesses.get_mut(node as usize) {
                    *at = one.value;
                }
            }
        }
        thicknesses
    }

    fn content(
        &self,
        part: &signorini_io::case::Set,
        cells: &HashMap<u64, CellId>,
        found: &mut Diagnostics,
    ) -> Set {
        let mut set = Set::default();
        match &part.content {
            SetContent::Nodes(labels) => {
                let known = labels.iter().filter_map(|label| self.nodes.get(label));
                set.nodes = known.copied().collect();
                let unknown = labels.iter().filter(|l| !self.nodes.contains_key(l));
                let unknown: Vec<&u64> = unknown.collect();
                self.missing(part, "node", &unknown, found);
            }
            SetContent::Elements(labels) => {
                for label in labels {
                    match self.shells.solids(*label) {
                        Some(solids) => set.cells.extend(solids),
                        None => set.cells.extend(cells.get(label)),
                    }
                }
                let unknown: Vec<&u64> = labels.iter().filter(|l| !cells.contains_key(l)).collect();
                self.missing(part, "element", &unknown, found);
            }
            SetContent::Faces(faces) => {
                let mut unknown = Vec::new();
                for (label, side) in faces {
                    if let Side::Numbered(number) = side
                        && let Some(faces) = self.shells.side(*label, *number)
                    {
                        set.faces.extend(faces);
                        continue;
                    }
                    match cells.get(label) {
                        Some(&cell) => set.faces.extend(self.face(part, cell, side, found)),
                        None => unknown.push(label),
                    }
                }
                self.missing(part, "element", &unknown, found);
            }
            SetContent::Union(others) => {
                for other in others {
                    if let Some(of) = self.get(other, found).cloned() {
                        set.nodes.extend(of.nodes);
                        set.cells.extend(of.cells);
                        set.faces.extend(of.faces);
                    }
                }
            }
            SetContent::Region { region, of } => {
                set.nodes = self.region(part, region, of.as_ref(), found);
            }
        }
        set
    }

    /// The nodes of a part of space.
    fn region(
        &self,
        part: &signorini_io::case::Set,
        region: &Region,
        of: Option<&Name>,
        found: &mut Diagnostics,
    ) -> Vec<NodeId> {
        let among = match of {
            Some(of) => self.nodes(of, found),
            None => self.sets.get(ALL).map(|all| self.nodes_of(all)),
        };
        let Some(among) = among else {
            return Vec::new();
        };
        let nodes = nodes_in(self.mesh, region, &among);
        if nodes.is_empty() {
            found.push(
                Diagnostic::error(
                    &codes::WRONG_KIND,
                    format!("set {} is empty", quoted(&part.name)),
                )
                .at(&part.place, "no node lies there")
                .help("list the nodes near it: signorini info MESH; or widen it"),
            );
        }
        nodes
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
        match side_by_normal(self.mesh, cell, &side.to_string()) {
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
        if set.is_none() && self.surfaces.contains(&name.value) {
            found.push(
                Diagnostic::error(
                    &codes::WRONG_KIND,
                    format!("surface {} has no nodes and no faces", quoted(name)),
                )
                .at(&name.place, "it can only be the primary side of a contact")
                .help("to move it, name its `reference`"),
            );
        } else if set.is_none() {
            let known = self.sets.keys().chain(&self.surfaces).map(String::as_str);
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

    /// The shells of the model.
    pub const fn shells(&self) -> &'a Shells {
        self.shells
    }

    /// The mesh.
    pub const fn mesh(&self) -> &'a Mesh {
        self.mesh
    }

    /// What a name stands for, without a message.
    pub fn set(&self, name: &str) -> Option<&Set> {
        self.sets.get(name)
    }

    /// Adds a set of faces that the program found.
    pub fn add_faces(&mut self, (name, faces): (String, Vec<Face>)) {
        let set = Set {
            faces,
            ..Set::default()
        };
        self.sets.insert(name, set);
    }

    /// The cells of a set that a body can be made of.
    pub fn cells(&self, name: &Name, found: &mut Diagnostics) -> Cells {
        let Some(set) = self.get(name, found) else {
            return Cells::default();
        };
        let of = |dim| {
            let has = |c: &&CellId| self.mesh.element(**c).is_some_and(|e| e.dim() == dim);
            set.cells.iter().filter(has).copied().collect()
        };
        let cells = Cells {
            solids: of(self.space.ndim()),
            bars: of(1),
        };
        if cells.solids.is_empty() && cells.bars.is_empty() {
            found.push(
                Diagnostic::error(
                    &codes::WRONG_KIND,
                    format!("{} has no solid elements", quoted(name)),
                )
                .at(&name.place, "a body is made of solid elements, or of lines"),
            );
        }
        cells
    }

    /// Whether a set has elements.
    pub fn has_cells(&self, name: &Name) -> bool {
        let set = self.sets.get(&name.value);
        set.is_some_and(|set| !set.cells.is_empty())
    }

    /// The groups and sets that list an element.
    pub fn groups_of(&self, cell: CellId) -> impl Iterator<Item = &str> {
        let lists = move |(name, set): &(&String, &Set)| *name != ALL && set.cells.contains(&cell);
        self.sets
            .iter()
            .filter(lists)
            .map(|(name, _)| name.as_str())
    }

    /// The number of an element in the input.
    pub fn element(&self, cell: CellId) -> Option<u64> {
        self.mesh.cell_label(cell)
    }

    /// The elements of a set as they are listed, each once.
    pub fn cells_of(&self, name: &Name, found: &mut Diagnostics) -> Option<Vec<CellId>> {
        let mut seen = BTreeSet::new();
        let listed = self.get(name, found)?.cells.iter().copied();
        Some(listed.filter(|cell| seen.insert(*cell)).collect())
    }

    /// The nodes of a set; of shells those of their surface. Sorted, each once.
    fn nodes_of(&self, set: &Set) -> Vec<NodeId> {
        let mut nodes = self.mesh.nodes_of(set);
        self.shells.to_surface(&mut nodes);
        nodes
    }

    /// The nodes of a set.
    pub fn nodes(&self, name: &Name, found: &mut Diagnostics) -> Option<Vec<NodeId>> {
        let nodes = self.nodes_of(self.get(name, found)?);
        if nodes.is_empty() {
            found.push(
                Diagnostic::error(&codes::WRONG_KIND, format!("{} is empty", quoted(name)))
                    .at(&name.place, "no nodes in it"),
            );
            return None;
        }
        Some(nodes)
    }

    /// The nodes of a set of nodes as they are listed, each once; those of other sets sorted.
    pub fn nodes_in_order(&self, name: &Name, found: &mut Diagnostics) -> Option<Vec<NodeId>> {
        let sorted = self.nodes(name, found)?;
        let set = self.sets.get(&name.value)?;
        if !set.cells.is_empty() || !set.faces.is_empty() {
            return Some(sorted);
        }
        let mut seen = BTreeSet::new();
        let listed = set.nodes.iter().copied();
        Some(listed.filter(|node| seen.insert(*node)).collect())
    }

    /// The nodes of a set with their shares: by area over a surface, even for bare nodes.
    pub fn weighted(&self, name: &Name, found: &mut Diagnostics) -> Option<Vec<(NodeId, f64)>> {
        let nodes = self.nodes(name, found)?;
        let even = 1.0 / nodes.len() as f64;
        let areas = self.covering(name, &nodes).and_then(|faces| {
            let facets = Facets::new(self.mesh, &faces).ok()?;
            let extent = |facet, shape: &[f64], at| {
                let plane = facets.face(facet).map(|face| self.own_plane(face.cell));
                match plane.flatten() {
                    Some(own) => own.extent(facets.nodes(facet), shape, at),
                    None => self.space.extent(at),
                }
            };
            facets.nodal_areas(&self.mesh.points, &extent).ok()
        });
        let areas = areas.filter(|areas| areas.iter().any(|(_, area)| *area > 0.0));
        Some(match areas {
            Some(areas) => areas.into_iter().filter(|(_, area)| *area > 0.0).collect(),
            None => nodes.into_iter().map(|node| (node, even)).collect(),
        })
    }

    /// Where the node of a number is.
    pub fn point(&self, label: u64) -> Option<Vec3> {
        let node = self.nodes.get(&label)?;
        self.mesh.points.get(*node as usize).copied()
    }

    /// Where a node is.
    pub fn place(&self, node: NodeId) -> Option<Vec3> {
        self.mesh.points.get(node as usize).copied()
    }

    /// The number of a node in the input.
    pub fn label(&self, node: NodeId) -> u64 {
        let label = self.mesh.node_labels.get(node as usize);
        label.copied().unwrap_or_default()
    }

    /// The distance of two nodes.
    pub fn distance(&self, a: NodeId, b: NodeId) -> f64 {
        let at = |node: NodeId| self.mesh.points.get(node as usize).copied();
        let between = at(a).zip(at(b)).map(|(a, b)| (a - b).norm());
        between.unwrap_or_default()
    }

    /// The faces of a set: its own, those under its surface elements, the outside of its solids, or those between its
    /// nodes. `what` needs them.
    pub fn faces(&self, name: &Name, what: &str, found: &mut Diagnostics) -> Option<Vec<Face>> {
        let set = self.get(name, found)?;
        match self.resolve(set) {
            Ok(faces) if !faces.is_empty() => Some(faces),
            Ok(_) => {
                found.push(
                    Diagnostic::error(
                        &codes::WRONG_KIND,
                        format!("{} has no faces: {what} needs some", quoted(name)),
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

    /// The faces of a section: those that the set names, which may lie inside a body; else as of [`Names::faces`].
    pub fn section(&self, name: &Name, found: &mut Diagnostics) -> Option<Vec<Face>> {
        let set = self.get(name, found)?;
        if set.faces.is_empty() || !set.cells.is_empty() {
            return self.faces(name, "a section", found);
        }
        let mut seen = BTreeSet::new();
        let faces = set.faces.iter().copied();
        Some(faces.filter(|face| seen.insert(*face)).collect())
    }

    /// The faces of a cut through a body, which lie inside it: those of the set as it names them, and those under its
    /// surface elements on the side that a normal points away from.
    pub fn cut(
        &self,
        name: &Name,
        normal: Option<Vec3>,
        found: &mut Diagnostics,
    ) -> Option<Vec<Face>> {
        let set = self.get(name, found)?;
        let mut faces = set.faces.clone();
        let below = |cell: &CellId| {
            let element = self.mesh.element(*cell)?;
            let flat = element.dim() + 1 == self.space.ndim();
            flat.then(|| self.index.find(element, self.mesh.cell(*cell)))?
        };
        let mut sided = true;
        for (one, other) in set.cells.iter().filter_map(below) {
            let away = |face: &Face| {
                let out = face_normal(self.mesh, *face);
                normal.is_some_and(|normal| out.dot(normal) > 0.0)
            };
            let side = [Some(one), other].into_iter().flatten().find(away);
            sided &= side.is_some();
            faces.extend(side);
        }
        let mut seen = BTreeSet::new();
        faces.retain(|face| seen.insert(*face));
        if faces.is_empty() || !sided {
            let (what, help) = if normal.is_none() && !sided {
                (
                    "has two sides",
                    "write  normal =  away from the side to cut",
                )
            } else {
                (
                    "has no faces",
                    "name faces as  { faces = [[element, \"S1\"], ..] }",
                )
            };
            let message = format!(
                "{} {what}: pretension cuts at one side of faces",
                quoted(name)
            );
            let message = Diagnostic::error(&codes::WRONG_KIND, message);
            found.push(message.at(&name.place, "cut here").help(help));
            return None;
        }
        Some(faces)
    }

    fn resolve(&self, set: &Set) -> Result<Vec<Face>, String> {
        let mesh = self.mesh;
        let mut faces = mesh.faces(set, &self.index).map_err(|e| e.to_string())?;
        let dim = self.space.ndim();
        let is_solid = |c: &&CellId| mesh.element(**c).is_some_and(|e| e.dim() == dim);
        let solids: Vec<CellId> = set.cells.iter().filter(is_solid).copied().collect();
        if !solids.is_empty() {
            faces.extend(boundary(mesh, solids));
        }
        if faces.is_empty() && !set.nodes.is_empty() {
            faces = mesh.faces_among(&self.index.boundary(), &set.nodes);
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
            return self
                .faces(name, "the secondary side", found)
                .map(SidePart::Faces);
        }
        let nodes = self.nodes(name, found)?;
        Some(match self.covering(name, &nodes) {
            Some(faces) => SidePart::Faces(faces),
            None => SidePart::Nodes(nodes),
        })
    }

    /// The faces of a set, where they hold all its nodes.
    pub fn covering(&self, name: &Name, nodes: &[NodeId]) -> Option<Vec<Face>> {
        let faces = self.resolve(self.sets.get(&name.value)?).ok()?;
        let of_faces = faces.iter().filter_map(|face| self.mesh.face(*face));
        let covered: BTreeSet<NodeId> = of_faces.flat_map(|(_, nodes)| nodes).collect();
        nodes
            .iter()
            .all(|node| covered.contains(node))
            .then_some(faces)
    }

    /// The nodes of cells, sorted.
    pub fn nodes_around(&self, cells: impl Iterator<Item = CellId>) -> Vec<NodeId> {
        let nodes = cells.flat_map(|cell| self.mesh.cell(cell));
        let nodes: BTreeSet<NodeId> = nodes.copied().collect();
        nodes.into_iter().collect()
    }

    /// What the plane of a cell stands for.
    pub fn plane(&self, cell: CellId) -> Idealisation {
        self.own_plane(cell).map_or(self.space, |own| own.space)
    }

    /// The same, where its body says something of its own.
    pub fn own_plane(&self, cell: CellId) -> Option<&Arc<OwnPlane>> {
        self.planes.get(&cell)
    }

    /// The nodes of every set.
    pub fn node_sets(&self) -> BTreeMap<String, Vec<NodeId>> {
        let sets = self.sets.iter();
        sets.map(|(name, set)| (name.clone(), self.nodes_of(set)))
            .collect()
    }
}

/// The normal of a face out of its element, as long as twice the face is large; in the plane as it is long.
pub(super) fn face_normal(mesh: &Mesh, face: Face) -> Vec3 {
    let Some((element, nodes)) = mesh.face(face) else {
        return Vec3::ZERO;
    };
    let corners = nodes.iter().take(element.ncorner());
    let points: Vec<Vec3> = corners
        .filter_map(|&node| mesh.points.get(node as usize).copied())
        .collect();
    match points.as_slice() {
        [a, b] => (*b - *a).cross(Vec3::unit(2)),
        [first, ..] => {
            let arms = points.iter().map(|x| *x - *first);
            let next = arms.clone().cycle().skip(1);
            arms.zip(next).map(|(a, b)| a.cross(b)).sum()
        }
        [] => Vec3::ZERO,
    }
}

/// Those of some nodes that lie in a part of space, boundary included; the nearest of them to a point.
fn nodes_in(mesh: &Mesh, region: &Region, among: &[NodeId]) -> Vec<NodeId> {
    let (part, tolerance) = match *region {
        Region::Plane { normal, at, tol } => {
            let normal = Vec3::from(normal).normalized().unwrap_or_default();
            let point = normal * at;
            (select::Region::Plane { normal, point }, tol)
        }
        Region::Box { low, high } => {
            let (min, max) = (low.into(), high.into());
            (select::Region::Box { min, max }, None)
        }
        Region::Sphere { center, radius } => {
            let centre = center.into();
            (select::Region::Ball { centre, radius }, None)
        }
        Region::Near { point } => {
            let nearest = mesh.nearest_node(point.into(), Some(among));
            return nearest.into_iter().map(|(node, _)| node).collect();
        }
    };
    mesh.nodes_in(&part, Some(among), tolerance)
}

/// Sets in an order in which every one comes behind those it is made from. Circles have been refused before.
fn in_order(sets: &[signorini_io::case::Set]) -> Vec<&signorini_io::case::Set> {
    let numbers = sets.iter().enumerate();
    let numbers: HashMap<&str, usize> = numbers
        .map(|(number, set)| (set.name.as_str(), number))
        .collect();
    let members = |set: &signorini_io::case::Set| -> Vec<usize> {
        let names = match &set.content {
            SetContent::Union(names) => names.as_slice(),
            SetContent::Region { of, .. } => of.as_slice(),
            SetContent::Nodes(_) | SetContent::Elements(_) | SetContent::Faces(_) => &[],
        };
        let number = |name: &Name| numbers.get(name.as_str()).copied();
        names.iter().filter_map(number).collect()
    };
    let mut ordered = Vec::with_capacity(sets.len());
    let mut begun = vec![false; sets.len()];
    // a set waits on the stack, marked, until its members are done
    let mut stack: Vec<(usize, bool)> = (0..sets.len()).rev().map(|n| (n, false)).collect();
    while let Some((number, ready)) = stack.pop() {
        let Some(set) = sets.get(number) else {
            continue;
        };
        if ready {
            ordered.push(set);
        } else if let Some(begun) = begun.get_mut(number).filter(|begun| !**begun) {
            *begun = true;
            stack.push((number, true));
            stack.extend(members(set).into_iter().map(|member| (member, false)));
        }
    }
    ordered
}
