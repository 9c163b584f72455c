//! Nodes, elements and sets as a mesh.

use super::deck::Parts;
use super::fault::{Fault, RecordError, shown};
use super::kind::{ELEMENTS, Family, Kind};
use super::record::Record;
use crate::diagnostic::closest;
use crate::readers::labels::Lookup;
use signorini_geometry::element::{Element, by_name};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId, Set};
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Kinds of nodes.
pub const NODES: [&str; 5] = [
    "node",
    "slavenode",
    "rigidarmnode",
    "hangingnode",
    "generalslavenode",
];

/// Entries of sets for each byte of a deck at most: ranges mean more than they take to write.
const ENTRIES: usize = 64;

/// Elements of one type with one section, material and kinematics.
#[derive(Clone, Debug)]
pub struct Group {
    /// The name of its set in the mesh.
    pub name: String,
    /// Their type.
    pub kind: Kind,
    /// Number of their cross-section.
    pub section: u64,
    /// Number of their material.
    pub material: u64,
    /// Their kinematics: 0 of small strain, 1 total Lagrangian, 2 updated.
    pub nlgeo: u64,
    /// Their integration points, where the records say so.
    pub points: Option<u64>,
    /// Which coordinates a bar of the plane lies in.
    pub plane: u64,
}

/// What sets of a deck are called in the mesh. A set of several things is several sets there.
#[derive(Clone, Debug, Default)]
pub struct SetNames {
    /// Its nodes.
    pub nodes: Option<String>,
    /// Its elements.
    pub elements: Option<String>,
    /// Sides of elements.
    pub sides: Option<String>,
}

impl SetNames {
    /// All of them.
    pub fn all(&self) -> impl Iterator<Item = &String> {
        [&self.nodes, &self.elements, &self.sides]
            .into_iter()
            .flatten()
    }
}

/// The mesh of a deck, and what its numbers are called there.
#[derive(Clone, Debug)]
pub struct Meshed {
    /// The mesh.
    pub mesh: Mesh,
    /// Its elements by what they are made of.
    pub groups: Vec<Group>,
    /// Sets by their numbers.
    pub sets: BTreeMap<u64, SetNames>,
    /// The type of each element, in the order of the records.
    pub kinds: Vec<Kind>,
    /// The cell of each element, likewise.
    pub cells: Vec<CellId>,
    /// Places of elements in the order of the records, by their numbers.
    pub elements: HashMap<u64, usize>,
}

/// Makes the mesh.
pub(super) fn mesh(parts: &mut Parts, nbyte: usize) -> Result<Meshed, Fault> {
    let mut mesh = Mesh::default();
    nodes(parts, &mut mesh)?;
    let lookup = Lookup::new(&mesh.node_labels);
    let mut this = Meshed {
        mesh,
        groups: Vec::new(),
        sets: BTreeMap::new(),
        kinds: Vec::new(),
        cells: Vec::new(),
        elements: HashMap::new(),
    };
    this.elements(parts, &lookup)?;
    let labels: Vec<u64> = this.cells.iter().map(|cell| this.label(*cell)).collect();
    let names = Names {
        nodes: lookup,
        elements: Lookup::new(&labels),
        left: nbyte.saturating_mul(ENTRIES),
    };
    this.sets(parts, names)?;
    this.groups(parts)?;
    Ok(this)
}

fn nodes(parts: &mut Parts, mesh: &mut Mesh) -> Result<(), Fault> {
    let mut seen = HashSet::new();
    for record in &mut parts.nodes {
        let kind = record.kind();
        if !NODES.contains(&kind.as_str()) {
            return Err(unknown(record, "kind of node", &kind, &NODES));
        }
        let number = record.number()?;
        if !seen.insert(number) {
            return Err(record.wrong(RecordError::Twice {
                what: "node",
                number,
            }));
        }
        let x = match record.need_reals("coords")?[..] {
            [x] => Vec3::new(x, 0.0, 0.0),
            [x, y] => Vec3::new(x, y, 0.0),
            [x, y, z] => Vec3::new(x, y, z),
            ref other => {
                let error = RecordError::OutOfRange {
                    keyword: "coords".into(),
                    found: format!("a list of {}", other.len()),
                    wanted: "one to three coordinates",
                };
                return Err(record.wrong_field("coords", error));
            }
        };
        mesh.points.push(x);
        mesh.node_labels.push(number);
    }
    Ok(())
}

/// A first word that means nothing.
pub(super) fn unknown(
    record: &Record,
    what: &'static str,
    found: &str,
    known: &[&'static str],
) -> Fault {
    let meant = closest(found, known.iter().copied());
    record.wrong(RecordError::Unknown {
        what,
        found: shown(found),
        meant: meant.map_or(String::new(), |meant| format!("; did you mean `{meant}`?")),
    })
}

/// Finds what sets name.
struct Names {
    nodes: Lookup,
    elements: Lookup,
    left: usize,
}

impl Meshed {
    fn label(&self, cell: CellId) -> u64 {
        self.mesh.cell_label(cell).unwrap_or(0)
    }

    fn elements(&mut self, parts: &mut Parts, lookup: &Lookup) -> Result<(), Fault> {
        for record in &mut parts.elements {
            let name = record.kind();
            let known = Kind::of(&name).and_then(|kind| Some((kind, by_name(kind.element)?)));
            let Some((kind, element)) = known else {
                let known = ELEMENTS.map(|one| one.name);
                return Err(unknown(record, "element type", &name, &known));
            };
            let number = record.number()?;
            let place = self.kinds.len();
            if self.elements.insert(number, place).is_some() {
                return Err(record.wrong(RecordError::Twice {
                    what: "element",
                    number,
                }));
            }
            let nodes = element_nodes(record, kind, element, number, lookup)?;
            let cell = self.mesh.push_cell(element, &nodes, number);
            self.kinds.push(kind);
            self.cells.push(cell);
        }
        Ok(())
    }

    fn sets(&mut self, parts: &mut Parts, mut names: Names) -> Result<(), Fault> {
        for record in &mut parts.sets {
            if record.kind() != "set" {
                let error = RecordError::Unexpected {
                    found: shown(&record.kind()),
                    wanted: "a set".into(),
                };
                return Err(record.wrong(error));
            }
            let number = record.number()?;
            let nodes = self.nodes_of_set(record, &mut names)?;
            let cells = self.cells_of_set(record, &mut names)?;
            let faces = self.sides_of_set(record)?;
            names.spend(record, nodes.len() + cells.len() + faces.len())?;
            let content = [
                (
                    "",
                    Set {
                        nodes,
                        ..Set::default()
                    },
                ),
                (
                    "-elements",
                    Set {
                        cells,
                        ..Set::default()
                    },
                ),
                (
                    "-sides",
                    Set {
                        faces,
                        ..Set::default()
                    },
                ),
            ];
            let content: [(&str, Set); 3] = content;
            let alone = content.iter().filter(|(_, set)| !set.is_empty()).count() < 2;
            let mut name = |(ending, set): (&str, Set)| {
                let ending = if alone { "" } else { ending };
                let name = format!("set-{number}{ending}");
                (!set.is_empty()).then(|| {
                    self.mesh.sets.insert(name.clone(), set);
                    name
                })
            };
            let [nodes, elements, sides] = content.map(&mut name);
            let of_set = SetNames {
                nodes,
                elements,
                sides,
            };
            if self.sets.insert(number, of_set).is_some() {
                return Err(record.wrong(RecordError::Twice {
                    what: "set",
                    number,
                }));
            }
        }
        Ok(())
    }

    fn nodes_of_set(&self, record: &mut Record, names: &mut Names) -> Result<Vec<NodeId>, Fault> {
        let mut nodes = Vec::new();
        for number in record.wholes("nodes")?.unwrap_or_default() {
            let found = names.nodes.find(number);
            let error = RecordError::Undefined {
                what: "node",
                number,
            };
            nodes.push(found.ok_or_else(|| record.wrong_field("nodes", error))?);
        }
        let ranges = record.ranges("noderanges")?.unwrap_or_default();
        names.range(record, "noderanges", &ranges, &mut nodes)?;
        if record.flag("allnodes") {
            nodes.extend(0..self.mesh.nnode() as NodeId);
        }
        // their order counts only where the record says so
        if !record.flag("ordered_nodes") {
            let label = |node: &NodeId| self.mesh.node_labels.get(*node as usize).copied();
            nodes.sort_unstable_by_key(label);
            nodes.dedup();
        }
        Ok(nodes)
    }

    fn cells_of_set(&self, record: &mut Record, names: &mut Names) -> Result<Vec<CellId>, Fault> {
        let mut places = Vec::new();
        for number in record.wholes("elements")?.unwrap_or_default() {
            let found = names.elements.find(number);
            let error = RecordError::Undefined {
                what: "element",
                number,
            };
            places.push(found.ok_or_else(|| record.wrong_field("elements", error))?);
        }
        let ranges = record.ranges("elementranges")?.unwrap_or_default();
        names.range(record, "elementranges", &ranges, &mut places)?;
        if record.flag("allelements") {
            places.extend(0..self.cells.len() as u32);
        }
        places.sort_unstable();
        places.dedup();
        let cell = |place: u32| self.cells.get(place as usize).copied();
        Ok(places.into_iter().filter_map(cell).collect())
    }

    fn sides_of_set(&self, record: &mut Record) -> Result<Vec<Face>, Fault> {
        let mut faces = Vec::new();
        for (keyword, dims) in [
            ("elementboundaries", 2..=3),
            ("elementedges", 2..=2),
            ("elementsurfaces", 3..=3),
        ] {
            for pair in record.wholes(keyword)?.unwrap_or_default().chunks(2) {
                let &[number, side] = pair else {
                    let error = RecordError::OutOfRange {
                        keyword: keyword.into(),
                        found: "a list of odd length".into(),
                        wanted: "pairs of an element and a side",
                    };
                    return Err(record.wrong_field(keyword, error));
                };
                let place = self.elements.get(&number).copied();
                let place = place.and_then(|at| Some((*self.cells.get(at)?, self.kinds.get(at)?)));
                let Some((cell, kind)) = place else {
                    let error = RecordError::Undefined {
                        what: "element",
                        number,
                    };
                    return Err(record.wrong_field(keyword, error));
                };
                let element = self.mesh.element(cell);
                let nside = element.map_or(0, |element| element.sides().len());
                let dim = element.map_or(0, |element| element.dim());
                if !dims.contains(&dim) || kind.family == Family::Contact {
                    let error = RecordError::NotBuilt {
                        what: format!("`{keyword}` of a {}", kind.name),
                        why: "sets hold edges of elements in the plane and faces of solids".into(),
                    };
                    return Err(record.wrong_field(keyword, error));
                }
                if side < 1 || side > nside as u64 {
                    let error = RecordError::NoSide {
                        element: number,
                        kind: kind.name,
                        side,
                        nside,
                    };
                    return Err(record.wrong_field(keyword, error));
                }
                // sides are numbered as ours are
                faces.push(Face {
                    cell,
                    side: (side - 1) as u8,
                });
            }
        }
        faces.sort_unstable();
        faces.dedup();
        Ok(faces)
    }

    /// What each element is made of.
    fn groups(&mut self, parts: &mut Parts) -> Result<(), Fault> {
        let mut of_cell: HashMap<CellId, u64> = HashMap::new();
        let mut material_of: HashMap<u64, u64> = HashMap::new();
        for section in &mut parts.sections {
            let number = section.number()?;
            let material = section.whole("material")?;
            let material = material.map_or_else(|| section.whole("mat"), |m| Ok(Some(m)))?;
            let twice = material.and_then(|m| material_of.insert(number, m));
            if twice.is_some() {
                return Err(section.wrong(RecordError::Twice {
                    what: "cross-section",
                    number,
                }));
            }
            let Some(set) = section.whole("set")?.filter(|set| *set > 0) else {
                continue;
            };
            let Some(names) = self.sets.get(&set) else {
                let error = RecordError::Undefined {
                    what: "set",
                    number: set,
                };
                return Err(section.wrong_field("set", error));
            };
            let set = names.elements.as_ref().and_then(|n| self.mesh.sets.get(n));
            of_cell.extend(set.iter().flat_map(|set| &set.cells).map(|c| (*c, number)));
        }
        type Key = (&'static str, u64, u64, u64, u64, u64);
        let mut groups: BTreeMap<Key, (Group, Vec<CellId>)> = BTreeMap::new();
        let of_elements = self.kinds.iter().zip(&self.cells);
        for (record, (kind, cell)) in parts.elements.iter_mut().zip(of_elements) {
            let section = record.whole("crosssect")?.filter(|number| *number > 0);
            let own = record.whole("mat")?;
            let nlgeo = record.whole("nlgeo")?.unwrap_or(0);
            let points = record.whole("nip")?;
            if kind.family == Family::Contact {
                continue;
            }
            let plane = match kind.family {
                Family::Bar => record.whole("cs")?.unwrap_or(0),
                _ => 0,
            };
            let section = section.or_else(|| of_cell.get(cell).copied());
            let keyword = "crosssect";
            let section = section.ok_or_else(|| record.wrong(RecordError::Missing { keyword }))?;
            let material = own.filter(|number| *number > 0);
            let material = material.or_else(|| material_of.get(&section).copied());
            let keyword = "mat";
            let material =
                material.ok_or_else(|| record.wrong(RecordError::Missing { keyword }))?;
            let n = groups.len() + 1;
            let (_, cells) = groups
                .entry((
                    kind.name,
                    section,
                    material,
                    nlgeo,
                    points.unwrap_or(0),
                    plane,
                ))
                .or_insert_with(|| {
                    let group = Group {
                        name: format!("{}-{n}", kind.name),
                        kind: *kind,
                        section,
                        material,
                        nlgeo,
                        points,
                        plane,
                    };
                    (group, Vec::new())
                });
            cells.push(*cell);
        }
        for (group, mut cells) in groups.into_values() {
            cells.sort_unstable();
            let set = Set {
                cells,
                ..Set::default()
            };
            self.mesh.sets.insert(group.name.clone(), set);
            self.groups.push(group);
        }
        Ok(())
    }
}

fn element_nodes(
    record: &mut Record,
    kind: Kind,
    element: Element,
    number: u64,
    lookup: &Lookup,
) -> Result<Vec<NodeId>, Fault> {
    let labels = record.need_wholes("nodes")?;
    if labels.len() != element.nnode() {
        let error = RecordError::NodeCount {
            element: number,
            kind: kind.name,
            found: labels.len(),
            wanted: element.nnode(),
        };
        return Err(record.wrong_field("nodes", error));
    }
    let mut nodes: Vec<NodeId> = Vec::with_capacity(labels.len());
    for &node in &labels {
        let Some(found) = lookup.find(node) else {
            let error = RecordError::Undefined {
                what: "node",
                number: node,
            };
            return Err(record.wrong_field("nodes", error));
        };
        if nodes.contains(&found) {
            let error = RecordError::Repeated {
                element: number,
                node,
            };
            return Err(record.wrong_field("nodes", error));
        }
        nodes.push(found);
    }
    Ok(nodes)
}

impl Names {
    fn spend(&mut self, record: &Record, count: usize) -> Result<(), Fault> {
        self.left = self.left.checked_sub(count).ok_or_else(|| {
            record.wrong(RecordError::Excess {
                what: "the ranges of sets",
            })
        })?;
        Ok(())
    }

    /// What exists of some ranges; of a single number, it has to.
    fn range(
        &mut self,
        record: &Record,
        keyword: &'static str,
        ranges: &[[u64; 2]],
        out: &mut Vec<u32>,
    ) -> Result<(), Fault> {
        let (lookup, what) = match keyword {
            "noderanges" => (&self.nodes, "node"),
            _ => (&self.elements, "element"),
        };
        let mut left = self.left;
        for &[first, last] in ranges {
            let before = out.len();
            lookup.range(first, last, 1, out);
            if out.len() == before {
                let number = first;
                return Err(record.wrong_field(keyword, RecordError::Undefined { what, number }));
            }
            let spent = left.checked_sub(out.len() - before);
            left = spent.ok_or_else(|| {
                record.wrong(RecordError::Excess {
                    what: "the ranges of sets",
                })
            })?;
        }
        Ok(())
    }
}
