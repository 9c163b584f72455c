//! What both versions fill: nodes and cells as they come, then the sets.

use super::cursor::Cursor;
use super::kind::{Kind, supported};
use crate::readers::MeshError;
use crate::readers::error::{Place, excerpt};
use crate::readers::labels::Lookup;
use signorini_geometry::element::MAX_NODES;
use signorini_geometry::mesh::{CellId, Mesh, NodeId, Set};
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet, HashSet};

type Result<T> = std::result::Result<T, MeshError>;

/// What a cell belongs to: dimension, and the tag of an entity (4.1) or of a physical group (2.2).
pub(super) type Owner = (u8, i64);

/// `"1 node"`, `"2 nodes"`.
fn plural(count: u64, word: &str) -> String {
    format!("{count} {word}{}", if count == 1 { "" } else { "s" })
}

/// Numbers that must each come once.
#[derive(Default)]
struct Labels {
    list: Vec<u64>,
    set: Option<HashSet<u64>>, // only once the list is not ascending
}

impl Labels {
    /// Whether the label is new.
    fn insert(&mut self, label: u64) -> bool {
        if self.set.is_none() && self.list.last().is_some_and(|&last| last >= label) {
            self.set = Some(self.list.iter().copied().collect());
        }
        self.list.push(label);
        self.set.as_mut().is_none_or(|set| set.insert(label))
    }
}

/// Cells that follow each other in one block and have one owner.
struct Run {
    owner: Owner,
    block: u32,
    first: u32,
    end: u32,
}

/// Cells of a type that is not supported.
struct Skipped {
    kind: Kind,
    count: u64,
    first: Place,
    owners: BTreeSet<Owner>,
}

/// A mesh in the making.
pub(super) struct Builder {
    mesh: Mesh,
    node_labels: Labels,
    element_labels: Labels,
    lookup: Option<Lookup>,
    runs: Vec<Run>,
    points: Vec<(Owner, NodeId)>,
    skipped: BTreeMap<u32, Skipped>,
    names: BTreeMap<Owner, String>,
    /// The physical groups of each owner.
    pub groups: BTreeMap<Owner, Vec<i64>>,
    /// What is worth telling.
    pub notes: Vec<String>,
}

impl Builder {
    pub fn new() -> Self {
        Self {
            mesh: Mesh::default(),
            node_labels: Labels::default(),
            element_labels: Labels::default(),
            lookup: None,
            runs: Vec::new(),
            points: Vec::new(),
            skipped: BTreeMap::new(),
            names: BTreeMap::new(),
            groups: BTreeMap::new(),
            notes: Vec::new(),
        }
    }

    /// Names a physical group; the first name stays.
    pub fn name(&mut self, dim: u8, tag: i64, name: String) {
        if name.is_empty() {
            return;
        }
        let known = self.names.entry((dim, tag)).or_insert_with(|| name.clone());
        if *known != name {
            self.notes.push(format!(
                "the physical group of dimension {dim} and tag {tag} has two names; the first, `{}`, is used",
                excerpt(known.as_bytes())
            ));
        }
    }

    pub fn has_nodes(&self) -> bool {
        self.lookup.is_some()
    }

    pub fn reserve_nodes(&mut self, nnode: usize) {
        self.mesh.points.reserve(nnode);
        self.node_labels.list.reserve(nnode);
    }

    /// Adds a node number; its position follows, in the same order, with [`Builder::push_point`].
    pub fn push_node(&mut self, cursor: &Cursor<'_>, label: u64) -> Result<()> {
        if !self.node_labels.insert(label) {
            return Err(MeshError::DuplicateNode {
                place: cursor.place(),
                node: label,
            });
        }
        if self.node_labels.list.len() >= NodeId::MAX as usize {
            return Err(cursor.out_of_range(
                "the number of nodes",
                self.node_labels.list.len(),
                "below 2^32 - 1",
            ));
        }
        Ok(())
    }

    /// The number of the node whose position comes next.
    pub fn next_node(&self) -> u64 {
        let next = self.node_labels.list.get(self.mesh.points.len());
        next.copied().unwrap_or(0)
    }

    pub fn push_point(&mut self, x: [f64; 3]) {
        self.mesh.points.push(Vec3::from(x));
    }

    /// Ends the nodes.
    pub fn index_nodes(&mut self) {
        self.lookup = Some(Lookup::new(&self.node_labels.list));
        self.node_labels.set = None;
    }

    /// The type of this number.
    pub fn kind(&self, cursor: &Cursor<'_>, number: i64) -> Result<Kind> {
        Kind::find(number).ok_or_else(|| MeshError::UnknownElement {
            place: cursor.place(),
            found: number.to_string(),
            known: supported(),
        })
    }

    /// Reads the nodes of a cell and adds it to the mesh.
    ///
    /// `twin` says that the cell may be the last one again, written once more because it has another owner.
    pub fn read_cell(
        &mut self,
        cursor: &mut Cursor<'_>,
        kind: &Kind,
        owner: Owner,
        label: u64,
        twin: bool,
        node: impl Fn(&mut Cursor<'_>) -> Result<u64>,
    ) -> Result<()> {
        if !kind.is_point() && kind.element.is_none() {
            let skipped = self.skipped.entry(kind.number).or_insert_with(|| Skipped {
                kind: *kind,
                count: 0,
                first: cursor.place(),
                owners: BTreeSet::new(),
            });
            skipped.count += 1;
            skipped.owners.insert(owner);
            return (0..kind.nnode).try_for_each(|_| node(cursor).map(drop));
        }
        let mut found = [0; MAX_NODES];
        let found = found.get_mut(..kind.nnode).unwrap_or_default();
        for i in 0..found.len() {
            let number = node(cursor)?;
            let id = self.lookup.as_ref().and_then(|l| l.find(number));
            let id = id.ok_or_else(|| MeshError::MissingNode {
                place: cursor.place(),
                element: label,
                node: number,
            })?;
            let (before, rest) = found.split_at_mut(i);
            if before.contains(&id) {
                return Err(MeshError::RepeatedNode {
                    place: cursor.place(),
                    element: label,
                    node: number,
                });
            }
            if let Some(entry) = rest.first_mut() {
                *entry = id;
            }
        }
        let Some(element) = kind.element else {
            self.label(cursor, label)?;
            self.points.extend(found.iter().map(|&id| (owner, id)));
            return Ok(());
        };
        let mut ours = [0; MAX_NODES];
        let ours = ours.get_mut(..kind.nnode).unwrap_or_default();
        ours.copy_from_slice(found);
        for (to, &from) in ours.iter_mut().zip(kind.permutation) {
            *to = found.get(from).copied().unwrap_or(0);
        }
        let (block, cells) = self.mesh.block_mut(element);
        let last = (cells.ncell() as u32).wrapping_sub(1);
        if twin && cells.cell(last as usize) == ours {
            self.own(owner, block, last);
            return Ok(());
        }
        cells.nodes.extend_from_slice(ours);
        cells.labels.push(label);
        self.label(cursor, label)?;
        self.own(owner, block, last.wrapping_add(1));
        Ok(())
    }

    fn label(&mut self, cursor: &Cursor<'_>, label: u64) -> Result<()> {
        if self.element_labels.insert(label) {
            return Ok(());
        }
        Err(MeshError::DuplicateElement {
            place: cursor.place(),
            element: label,
        })
    }

    fn own(&mut self, owner: Owner, block: u32, index: u32) {
        match self.runs.last_mut() {
            Some(run) if run.owner == owner && run.block == block && run.end == index => {
                run.end += 1;
            }
            _ => self.runs.push(Run {
                owner,
                block,
                first: index,
                end: index + 1,
            }),
        }
    }

    /// The name of a physical group: as declared, else by dimension and tag.
    fn group(&self, dim: u8, tag: i64) -> String {
        let kind = ["point", "curve", "surface", "volume"];
        let unnamed = || format!("{}_{tag}", kind.get(dim as usize).unwrap_or(&"group"));
        self.names.get(&(dim, tag)).cloned().unwrap_or_else(unnamed)
    }

    /// The mesh and the notes.
    pub fn finish(mut self, cursor: &Cursor<'_>) -> Result<(Mesh, Vec<String>)> {
        if self.mesh.ncell() == 0 && self.skipped.is_empty() {
            return Err(MeshError::NoElements {
                place: cursor.file(),
                nnode: self.mesh.nnode(),
            });
        }
        self.judge_skipped()?;
        self.note_unusual();
        self.name_sets(cursor)?;
        self.mesh.node_labels = self.node_labels.list;
        Ok((self.mesh, self.notes))
    }

    /// Refuses unsupported cells of the highest dimension; notes those of lower dimension.
    fn judge_skipped(&mut self) -> Result<()> {
        let skipped = || self.skipped.values();
        let highest = skipped().map(|s| s.kind.dim).max().unwrap_or(0);
        let in_words =
            |s: &Skipped| format!("{} of {}", plural(s.count, "element"), s.kind.in_words());
        if usize::from(highest) >= self.mesh.dim() {
            let solids = skipped().filter(|s| s.kind.dim == highest);
            let words: Vec<String> = solids.clone().map(in_words).collect();
            if let Some(first) = solids.clone().next() {
                return Err(MeshError::Unsupported {
                    place: first.first.clone(),
                    found: words.join(" and "),
                    hint: if solids.clone().any(|s| s.kind.order > 1) {
                        "mesh with first-order elements: Mesh.ElementOrder = 1"
                    } else {
                        "mesh with tetrahedra, wedges or hexahedra only"
                    },
                });
            }
        }
        for s in self.skipped.values() {
            let names: BTreeSet<String> = (s.owners.iter())
                .flat_map(|owner| {
                    self.groups
                        .get(owner)
                        .into_iter()
                        .flatten()
                        .map(|&tag| (owner.0, tag))
                })
                .map(|(dim, tag)| format!("`{}`", self.group(dim, tag)))
                .collect();
            let more = if names.len() > 5 { ", …" } else { "" };
            let names: Vec<String> = names.into_iter().take(5).collect();
            let mut note = format!("{} left out: not supported yet", in_words(s));
            if !names.is_empty() {
                note += &format!("; missing from {}", names.join(", "));
                note += more;
            }
            self.notes.push(note);
        }
        Ok(())
    }

    fn note_unusual(&mut self) {
        let mut used = vec![false; self.mesh.nnode()];
        let of_cells = self.mesh.blocks.iter().flat_map(|b| &b.nodes);
        for &node in of_cells.chain(self.points.iter().map(|(_, node)| node)) {
            if let Some(used) = used.get_mut(node as usize) {
                *used = true;
            }
        }
        let unused = used.iter().filter(|used| !**used).count();
        if unused > 0 {
            let nodes = plural(unused as u64, "node");
            self.notes
                .push(format!("{nodes} without elements, ignored"));
        }
        if self.mesh.dim() < 3 && self.mesh.points.iter().any(|x| x.z != 0.0) {
            self.notes.push(
                "there are no volume elements, yet z is not 0 everywhere; was only the surface saved?"
                    .into(),
            );
        }
    }

    /// Turns owners into named sets.
    fn name_sets(&mut self, cursor: &Cursor<'_>) -> Result<()> {
        let ngroup = |owner: &Owner| self.groups.get(owner).map_or(0, Vec::len) as u64;
        let of_runs = self
            .runs
            .iter()
            .map(|r| u64::from(r.end - r.first) * ngroup(&r.owner));
        let of_points = self.points.iter().map(|(owner, _)| ngroup(owner));
        let found = of_runs.chain(of_points).fold(0, u64::saturating_add);
        if found > 2 * cursor.nbyte() as u64 + 1024 {
            return Err(MeshError::TooManyMemberships {
                place: cursor.file(),
                found,
            });
        }
        let mut sets: BTreeMap<Owner, Set> = self
            .names
            .keys()
            .map(|&group| (group, Set::default()))
            .collect();
        for run in &self.runs {
            for &tag in self.groups.get(&run.owner).into_iter().flatten() {
                let cells = (run.first..run.end).map(|index| CellId {
                    block: run.block,
                    index,
                });
                sets.entry((run.owner.0, tag))
                    .or_default()
                    .cells
                    .extend(cells);
            }
        }
        for (owner, node) in &self.points {
            for &tag in self.groups.get(owner).into_iter().flatten() {
                sets.entry((owner.0, tag)).or_default().nodes.push(*node);
            }
        }
        if sets.is_empty() {
            self.notes.push(
                "the mesh has no physical groups; sets must be given by geometry or number".into(),
            );
        }
        for ((dim, tag), set) in sets {
            let name = self.group(dim, tag);
            if set.is_empty() {
                self.notes
                    .push(format!("the physical group `{name}` is empty"));
            }
            if self.mesh.sets.contains_key(&name) {
                self.notes.push(format!(
                    "several physical groups are called `{name}`; they are one set"
                ));
            }
            let named = self.mesh.sets.entry(name).or_default();
            named.cells.extend(set.cells);
            named.nodes.extend(set.nodes);
        }
        for set in self.mesh.sets.values_mut() {
            set.cells.sort_unstable();
            set.cells.dedup();
            set.nodes.sort_unstable();
            set.nodes.dedup();
        }
        Ok(())
    }
}
