//! What general contact is made from: names, supports and cuts of a case, facet by facet.

use crate::setup::bodies;
use crate::setup::names::{Names, face_normal};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId, Set};
use signorini_geometry::surface::{ContactSurface, Facets, FacetsError};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{self, ANY, Case, Name};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, closest, codes, listed};
use signorini_mechanics::facing::Skin;
use signorini_mechanics::model::{BodyKind, BodyPart, Change, StepPart, Target};
use signorini_mechanics::solve::Motion;
use std::collections::{BTreeMap, BTreeSet};

/// The cosine of the angle to an axis up to which a facet that is prescribed along it is led.
const ALONG: f64 = 0.5;

/// The same up to which a facet that is held along it lies in a plane of symmetry.
const WITHIN: f64 = 0.999;

/// What a region is of.
#[derive(Clone, Debug)]
pub(super) struct Side {
    /// The place of its name in the list.
    pub label: u32,
    /// Whether it cannot follow: its body is rigid, or its motion is prescribed.
    pub is_led: bool,
    /// The stiffness of what is behind it.
    pub modulus: f64,
}

/// A body and a rigid surface without a mesh.
#[derive(Clone, Debug)]
pub(super) struct Wall {
    pub body: String,
    pub surface: String,
    pub facets: Vec<u32>,
}

/// What is prescribed at nodes, along each axis.
struct Motions {
    given: Vec<[bool; 3]>,
    /// Held in all steps.
    held: Vec<[bool; 3]>,
    ndim: usize,
}

impl Motions {
    fn new(nnode: usize, ndim: usize, steps: &[StepPart]) -> Self {
        let mut all = Self {
            given: vec![[false; 3]; nnode],
            held: vec![[false; 3]; nnode],
            ndim,
        };
        let mut moved = vec![[false; 3]; nnode];
        let set = |of: &mut Vec<[bool; 3]>, node: NodeId, axis: usize| {
            if let Some(flag) = of.get_mut(node as usize).and_then(|n| n.get_mut(axis)) {
                *flag = true;
            }
        };
        for change in steps.iter().flat_map(|step| &step.changes) {
            match change {
                Change::Prescribe(Target::Nodes(nodes), motions) => {
                    for (&node, (axis, motion)) in pairs_of(nodes, motions) {
                        set(&mut all.given, node, *axis);
                        match motion {
                            Motion::Hold => set(&mut all.held, node, *axis),
                            _ => set(&mut moved, node, *axis),
                        }
                    }
                }
                Change::Release(Target::Nodes(nodes), axes) => {
                    for (&node, &axis) in pairs_of(nodes, axes) {
                        set(&mut moved, node, axis);
                    }
                }
                Change::Prescribe(Target::Rigid(_), _) | Change::Release(Target::Rigid(_), _) => {}
            }
        }
        for (held, moved) in all.held.iter_mut().flatten().zip(moved.iter().flatten()) {
            *held &= !moved;
        }
        all
    }

    /// Whether all these nodes are prescribed along one axis that is near a normal.
    fn lead(&self, nodes: &[NodeId], normal: Vec3) -> bool {
        all_along(&self.given, nodes, normal, ALONG)
    }

    /// Whether a face lies in a plane of symmetry: it is held along its normal, and free within its plane.
    fn are_of_symmetry(&self, nodes: &[NodeId], normal: Vec3) -> bool {
        let given = |node: &NodeId| self.given.get(*node as usize).copied().unwrap_or_default();
        let is_free = |node: &NodeId| !given(node).iter().take(self.ndim).all(|given| *given);
        all_along(&self.held, nodes, normal, WITHIN) && nodes.iter().any(is_free)
    }
}

/// Every one of some things with every one of others.
pub(super) fn pairs_of<'a, A, B>(a: &'a [A], b: &'a [B]) -> impl Iterator<Item = (&'a A, &'a B)> {
    a.iter().flat_map(move |a| b.iter().map(move |b| (a, b)))
}

fn all_along(of: &[[bool; 3]], nodes: &[NodeId], normal: Vec3, least: f64) -> bool {
    let normal = normal.normalized().unwrap_or_default();
    let mut axes = (0..3).filter(|&axis| normal[axis].abs() >= least);
    let has = |node: &NodeId, axis: usize| {
        let of_node = of.get(*node as usize).and_then(|of| of.get(axis));
        of_node == Some(&true)
    };
    axes.any(|axis| nodes.iter().all(|node| has(node, axis)))
}

/// What a general contact is made from.
pub(in crate::setup) struct Source<'a> {
    pub case: &'a Case,
    pub mesh: &'a Mesh,
    pub names: &'a Names<'a>,
    pub bodies: &'a [BodyPart],
    pub steps: &'a [StepPart],
    /// Nodes of cuts through bodies, with their copies.
    pub cut: &'a [(NodeId, NodeId)],
}

impl Source<'_> {
    /// The cells that may touch, each with its label and its body.
    fn cells(&self) -> (BTreeMap<CellId, (u32, usize)>, Vec<String>) {
        let ndim = self.case.model.space.ndim();
        let mut of_cell = BTreeMap::new();
        let mut labels = Vec::new();
        let is_solid = |cell: &&CellId| self.mesh.element(**cell).is_some_and(|e| e.dim() == ndim);
        let own = |name: String| self.bodies.iter().position(|part| part.name == name);
        for body in &self.case.bodies {
            let Some(number) = own(bodies::name(body)) else {
                continue;
            };
            for group in &body.groups {
                let label = labels.len() as u32;
                labels.push(group.value.clone());
                let set = self.names.set(&group.value);
                let cells = set.into_iter().flat_map(|set| &set.cells);
                for cell in cells.filter(is_solid) {
                    of_cell.entry(*cell).or_insert((label, number));
                }
            }
        }
        (of_cell, labels)
    }

    /// The facets that a name means: of a body, a group, a set or a material; nothing where there is no such thing.
    fn meant(&self, name: &Name, facets: &Facets) -> Option<Vec<bool>> {
        let mut cells: BTreeSet<CellId> = BTreeSet::new();
        let mut faces: BTreeSet<Face> = BTreeSet::new();
        let mut take = |set: &Set| {
            cells.extend(&set.cells);
            faces.extend(&set.faces);
        };
        let is_of = |body: &&case::Body| {
            let of = body
                .material
                .as_ref()
                .is_some_and(|one| one.value == name.value);
            of || bodies::name(body) == name.value
        };
        let of_name = self.case.bodies.iter().filter(is_of);
        let groups = of_name
            .flat_map(|body| &body.groups)
            .map(|group| group.value.as_str());
        let groups: Vec<&str> = groups.collect();
        let own = self.names.set(&name.value);
        if own.is_none() && groups.is_empty() {
            return None;
        }
        let sets = groups.iter().filter_map(|group| self.names.set(group));
        own.into_iter().chain(sets).for_each(&mut take);
        // a set of faces may be one of surface elements, or of nodes
        if let Some(more) = self.names.faces(name, "contact", &mut Diagnostics::new()) {
            faces.extend(more);
        }
        let is_meant = |facet: u32| {
            let face = facets.face(facet);
            face.is_some_and(|face| cells.contains(&face.cell) || faces.contains(&face))
        };
        Some((0..facets.nfacet() as u32).map(is_meant).collect())
    }

    /// Of each name in the settings, the facets that it means; rigid surfaces have none.
    pub fn meant_by(
        &self,
        settings: &case::General,
        facets: &Facets,
        found: &mut Diagnostics,
    ) -> BTreeMap<String, Vec<bool>> {
        let mut meant = BTreeMap::new();
        let surfaces = || self.case.surfaces.iter();
        let is_surface = |name: &Name| surfaces().any(|one| one.name.value == name.value);
        for name in names_in(settings).filter(|name| !is_surface(name)) {
            match self.meant(name, facets) {
                Some(flags) => drop(meant.insert(name.value.clone(), flags)),
                None => found.push(unknown(name, self)),
            }
        }
        meant
    }

    /// The facets of both sides of the contacts that the case names.
    pub fn sides_of_contacts(&self, facets: &Facets) -> Vec<[Vec<bool>; 2]> {
        let side = |name: &Name| self.meant(name, facets).unwrap_or_default();
        let contacts = self.case.contacts.iter();
        contacts
            .map(|one| [side(&one.secondary), side(&one.primary)])
            .collect()
    }
}

/// What is known of cells and nodes.
pub(super) struct Known {
    motions: Motions,
    /// Of each cell, its group and its body.
    of_cell: BTreeMap<CellId, (u32, usize)>,
    groups: Vec<String>,
    /// Of each group and connected body, the place of its name.
    places: BTreeMap<(u32, u32), u32>,
    /// What bodies are called.
    pub names: Vec<String>,
}

impl Known {
    pub fn new(source: &Source<'_>) -> Self {
        let ndim = source.case.model.space.ndim();
        let (of_cell, groups) = source.cells();
        Self {
            motions: Motions::new(source.mesh.nnode(), ndim, source.steps),
            of_cell,
            groups,
            places: BTreeMap::new(),
            names: Vec::new(),
        }
    }

    /// The outer faces; those in planes of symmetry and of cuts face nothing.
    pub fn skin(&self, source: &Source<'_>) -> Result<Skin, FacetsError> {
        let mesh = source.mesh;
        let cells: Vec<CellId> = self.of_cell.keys().copied().collect();
        let cut: BTreeSet<NodeId> = source.cut.iter().flat_map(|&(a, b)| [a, b]).collect();
        let leaves_out = |face: Face| {
            let Some((_, nodes)) = mesh.face(face) else {
                return true;
            };
            let normal = face_normal(mesh, face);
            self.motions.are_of_symmetry(&nodes, normal)
                || nodes.iter().all(|node| cut.contains(node))
        };
        Skin::new(mesh, &cells, leaves_out)
    }

    /// The body of each facet. Groups that are several bodies are numbered.
    pub fn number(&mut self, source: &Source<'_>, skin: &Skin) -> Vec<u32> {
        let bodies = joined_by(source.cut, skin);
        let mut parts: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        for (facet, body) in (0..).zip(&bodies) {
            if let Some((group, _)) = self.of_facet(skin, facet) {
                parts.entry(group).or_default().insert(*body);
            }
        }
        for (group, bodies) in parts {
            let name = self.groups.get(group as usize).cloned().unwrap_or_default();
            let is_one = bodies.len() == 1;
            for (number, body) in bodies.into_iter().enumerate() {
                self.places.insert((group, body), self.names.len() as u32);
                self.names.push(match is_one {
                    true => name.clone(),
                    false => format!("{name}.{}", number + 1),
                });
            }
        }
        bodies
    }

    fn of_facet(&self, skin: &Skin, facet: u32) -> Option<(u32, usize)> {
        let face = skin.facets().face(facet)?;
        self.of_cell.get(&face.cell).copied()
    }

    /// What a facet is of.
    pub fn side(&self, source: &Source<'_>, skin: &Skin, bodies: &[u32], facet: u32) -> Side {
        let of = self.of_facet(skin, facet);
        let part = of.and_then(|(_, body)| source.bodies.get(body));
        let body = bodies.get(facet as usize).copied().unwrap_or(u32::MAX);
        let label = of.and_then(|(group, _)| self.places.get(&(group, body)).copied());
        let is_rigid = part.is_some_and(|part| matches!(part.kind, BodyKind::Rigid { .. }));
        let normal = skin.middle(&source.mesh.points, facet).1;
        let material = part.and_then(|part| part.kind.material());
        Side {
            label: label.unwrap_or(u32::MAX),
            is_led: is_rigid || self.motions.lead(skin.facets().nodes(facet), normal),
            modulus: material.map_or(0.0, |material| material.modulus()),
        }
    }
}

pub(super) fn has(flags: &[bool], facet: u32) -> bool {
    flags.get(facet as usize) == Some(&true)
}

/// The body of each facet where bodies that are cut are one: the lowest of their numbers.
fn joined_by(cut: &[(NodeId, NodeId)], skin: &Skin) -> Vec<u32> {
    let mut body = skin.body().to_vec();
    let mut of_node: BTreeMap<NodeId, u32> = BTreeMap::new();
    for (facet, body) in (0..).zip(&body) {
        of_node.extend(skin.facets().nodes(facet).iter().map(|node| (*node, *body)));
    }
    let both = |(a, b): &(NodeId, NodeId)| Some((*of_node.get(a)?, *of_node.get(b)?));
    let joins: BTreeSet<(u32, u32)> = cut.iter().filter_map(both).collect();
    for (a, b) in joins {
        let now = |of: u32| {
            let facet = skin.body().iter().position(|body| *body == of);
            facet
                .and_then(|facet| body.get(facet).copied())
                .unwrap_or(of)
        };
        let (a, b) = (now(a), now(b));
        body.iter_mut()
            .filter(|one| **one == a.max(b))
            .for_each(|one| *one = a.min(b));
    }
    body
}

/// All names in the settings that stand for something.
fn names_in(settings: &case::General) -> impl Iterator<Item = &Name> {
    let excluded = settings.exclude.iter();
    let excluded = excluded.flat_map(|(one, other)| std::iter::once(one).chain(other));
    let between = settings.pairs.iter().flat_map(|pair| &pair.between);
    let all = settings.of.iter().chain(excluded).chain(between);
    all.filter(|name| name.value != ANY)
}

fn unknown(name: &Name, source: &Source<'_>) -> Diagnostic {
    let bodies = source.case.bodies.iter();
    let bodies = bodies.flat_map(|body| body.groups.iter().chain(&body.material));
    let mut known: Vec<&str> = bodies.map(|name| name.value.as_str()).collect();
    known.extend(source.case.sets.iter().map(|set| set.name.value.as_str()));
    known.sort_unstable();
    known.dedup();
    let message = format!(
        "there is no body, set or material called \"{}\"",
        name.value
    );
    let remark = match closest(&name.value, known.iter().copied()) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => "not found".to_owned(),
    };
    let one = Diagnostic::error(&codes::UNDEFINED, message).at(&name.place, remark);
    one.note(format!("there are: {}", listed(known.into_iter())))
}
