//! What a run is made of: a mesh, bodies, contacts, steps, put together into one system.
//!
//! ```text
//! Parts (plain data, names already resolved) ──assemble──▶ Model: System + Steps
//! ```
//!
//! Readers of every format end here, and so does a program that uses the library without any file. What is left open
//! (`None`) is chosen here and can be read back from the [`Model`]:
//!
//! * the penalty, `ε = 10 · min(M/h)` per area, with the modulus `M = λ + 2μ` and the size `h` of the facets of each
//!   deformable side: a pressure `p` then penetrates `p h/(10 M)` (E1). Per node it is multiplied by the mean tributary
//!   area, or by `h²` (`h · thickness` in the plane) where the secondary side is bare nodes;
//! * the reach of the search, twice the largest facet;
//! * motions of rigid bodies that no step names: held.

use crate::contact::discretization::{NodeToSegment, SurfacePair};
use crate::contact::friction::Frictionless;
use crate::contact::law::{Penalty, Scale};
use crate::contact::{Interface, InterfaceParts, Measure};
use crate::load::NodalForces;
use crate::material::Material;
use crate::solid::{Solid, SolidError};
use crate::solve::{Increments, Motion, Prescription, Step};
use crate::system::{Dof, Elimination, Layout, NO_DOF, RigidBody, System, Term};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use signorini_geometry::surface::{
    ContactSurface, Facets, FacetsError, Placement, RigidId, SurfaceError,
};
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;
use thiserror::Error;

/// Space or plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Space {
    /// Three dimensions.
    ThreeD,
    /// The plane, without strain across it.
    PlaneStrain {
        /// Length across the plane.
        thickness: f64,
    },
}

/// A body.
pub struct BodyPart {
    /// Its name.
    pub name: String,
    /// Its cells.
    pub cells: Vec<CellId>,
    /// What it is made of; `None`: rigid.
    pub material: Option<Box<dyn Material>>,
}

/// One side of a contact.
#[derive(Clone, Debug, PartialEq)]
pub enum SidePart {
    /// Faces of solids.
    Faces(Vec<Face>),
    /// Bare nodes.
    Nodes(Vec<NodeId>),
}

/// A contact.
#[derive(Clone, Debug)]
pub struct ContactPart {
    /// Its name.
    pub name: String,
    /// The side that carries points.
    pub secondary: SidePart,
    /// The side that is projected onto.
    pub primary: Vec<Face>,
    /// Penalty; `None`: from the stiffness behind the surfaces (E1).
    pub penalty: Option<f64>,
    /// What it refers to; `None`: area where the secondary side has one.
    pub measure: Option<Measure>,
    /// Distance up to which a closest point counts; `None`: chosen.
    pub reach: Option<f64>,
}

/// What a support, a motion or a load is applied to.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Nodes of deformable bodies.
    Nodes(Vec<NodeId>),
    /// A rigid body.
    Rigid(RigidId),
}

/// A change of what is prescribed.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Components 0 to 2 (displacements) and 3 to 5 (rotations) get a motion.
    Prescribe(Target, Vec<(usize, Motion)>),
    /// Components become free.
    Release(Target, Vec<usize>),
}

/// A dead force.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadPart {
    /// Its name: a later load of this name replaces it.
    pub name: String,
    /// The force on each node; on a rigid body the force at its reference point.
    pub forces: LoadForces,
}

/// Where a dead force acts.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadForces {
    /// On nodes.
    Nodes(Vec<(NodeId, Vec3)>),
    /// On a rigid body.
    Rigid(RigidId, Vec3),
}

/// A step: what it changes.
#[derive(Clone, Debug)]
pub struct StepPart {
    /// Its name.
    pub name: String,
    /// Its duration.
    pub duration: f64,
    /// How it is cut into increments.
    pub increments: Increments,
    /// Whether displacements may be large.
    pub nonlinear: bool,
    /// Changes of supports and motions; everything else stays.
    pub changes: Vec<Change>,
    /// Loads that begin or change here.
    pub loads: Vec<LoadPart>,
}

/// Everything a model is made of.
pub struct Parts<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Space or plane.
    pub space: Space,
    /// The bodies. Rigid bodies are numbered in their order here.
    pub bodies: Vec<BodyPart>,
    /// The contacts.
    pub contacts: Vec<ContactPart>,
    /// The steps.
    pub steps: Vec<StepPart>,
}

/// What a contact became.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSummary {
    /// Its name.
    pub name: String,
    /// The penalty in use.
    pub penalty: f64,
    /// What it refers to.
    pub measure: Measure,
    /// The reach in use.
    pub reach: f64,
    /// Points of the secondary side.
    pub npoint: usize,
    /// Facets of the primary side.
    pub nfacet: usize,
    /// Size of the facets.
    pub facet_size: f64,
}

/// A system with the steps it is to go through.
pub struct Model {
    /// What is solved.
    pub system: System,
    /// The steps.
    pub steps: Vec<Step>,
    /// The contacts, with what was chosen for them.
    pub contacts: Vec<ContactSummary>,
    /// Nodes that no body uses: they take no part.
    pub unused: Vec<NodeId>,
    /// Bodies that nothing but contact holds.
    pub held_by_contact: Vec<String>,
}

/// Why no model can be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModelError {
    /// Nothing can deform.
    #[error("no body has a material: there is nothing to solve for")]
    NothingDeforms,
    /// An element in two bodies.
    #[error("element {label} belongs to body \"{first}\" and to body \"{second}\"")]
    TwoBodies {
        /// Its number in the input.
        label: u64,
        /// One body.
        first: String,
        /// The other.
        second: String,
    },
    /// A body without cells.
    #[error("body \"{body}\" has no elements")]
    EmptyBody {
        /// Its name.
        body: String,
    },
    /// An element that is no solid.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// Two rigid bodies that share a node.
    #[error("the rigid bodies \"{first}\" and \"{second}\" share node {node}")]
    RigidBodiesShare {
        /// One body.
        first: String,
        /// The other.
        second: String,
        /// The node, as numbered in the input.
        node: u64,
    },
    /// A surface that cannot be made.
    #[error("contact \"{contact}\": {source}")]
    Facets {
        /// Name of the contact.
        contact: String,
        /// Why.
        source: FacetsError,
    },
    /// A surface with a folded facet.
    #[error("contact \"{contact}\": {source}")]
    Surface {
        /// Name of the contact.
        contact: String,
        /// Why.
        source: SurfaceError,
    },
    /// A side without nodes.
    #[error("contact \"{contact}\": the secondary side is empty")]
    EmptySide {
        /// Name of the contact.
        contact: String,
    },
    /// Two sides that share nodes.
    #[error(
        "contact \"{contact}\": the two surfaces are glued at {count} nodes, one of them node {node}"
    )]
    Glued {
        /// Name of the contact.
        contact: String,
        /// How many nodes they share.
        count: usize,
        /// One of them, as numbered in the input.
        node: u64,
    },
    /// Two rigid sides.
    #[error("contact \"{contact}\": both sides are rigid, nothing can yield")]
    BothRigid {
        /// Name of the contact.
        contact: String,
    },
    /// A body that nothing can hold.
    #[error("body \"{body}\" is held by nothing: no support, no motion, no contact")]
    FreeBody {
        /// Its name.
        body: String,
    },
    /// One dof with two motions in one step.
    #[error(
        "step \"{step}\" prescribes the {component} displacement of node {node} twice, differently"
    )]
    Clash {
        /// Name of the step.
        step: String,
        /// The node, as numbered in the input.
        node: u64,
        /// The direction.
        component: char,
    },
    /// A support, motion or load on a node of a rigid body.
    #[error(
        "node {node} belongs to the rigid body \"{body}\": support, move or load the body instead"
    )]
    OnRigidNode {
        /// The node, as numbered in the input.
        node: u64,
        /// Name of the body.
        body: String,
    },
}

/// Factor of the automatic penalty (E1).
const PENALTY: f64 = 10.0;
/// The automatic reach over the largest facet.
const REACH: f64 = 2.0;

impl Model {
    /// Puts the parts together.
    ///
    /// # Errors
    /// What makes no model, each case named with the user's own numbers and names.
    pub fn assemble(parts: Parts<'_>) -> Result<Self, ModelError> {
        let Parts {
            mesh,
            space,
            bodies,
            contacts,
            steps,
        } = parts;
        let reference: Arc<[Vec3]> = mesh.points.clone().into();
        let owner = owners(mesh, &bodies)?;
        let elimination = Arc::new(rigid_bodies(mesh, &bodies)?);
        let (ndim, thickness) = match space {
            Space::ThreeD => (3, 1.0),
            Space::PlaneStrain { thickness } => (2, thickness),
        };
        let layout = Layout {
            ndim,
            nnode: mesh.nnode(),
            nrigid: elimination.bodies().len(),
            nmultiplier: 0,
        };
        let names: Vec<String> = bodies.iter().map(|b| b.name.clone()).collect();
        let rigid_names: Vec<String> = bodies
            .iter()
            .filter(|b| b.material.is_none())
            .map(|b| b.name.clone())
            .collect();
        let modulus: Vec<Option<f64>> = bodies
            .iter()
            .map(|b| b.material.as_ref().map(|m| m.modulus()))
            .collect();
        if modulus.iter().all(Option::is_none) {
            return Err(ModelError::NothingDeforms);
        }
        let body_of_node = nodes_by_body(mesh, &bodies);
        let held = Held::new(mesh, &bodies);

        let mut terms: Vec<Box<dyn Term>> = Vec::new();
        for body in bodies {
            let Some(material) = body.material else {
                continue;
            };
            let (name, reference) = (&body.name, reference.clone());
            let solid = Solid::new(
                name,
                mesh,
                reference,
                &body.cells,
                layout,
                material,
                thickness,
            )?;
            terms.push(Box::new(solid));
        }
        let context = Context {
            mesh,
            reference: &reference,
            owner: &owner,
            modulus: &modulus,
            elimination: &elimination,
            rigid_names: &rigid_names,
            thickness,
            layout,
        };
        let mut summaries = Vec::new();
        let mut touching = BTreeSet::new();
        for contact in contacts {
            let (parts, summary) = context.contact(contact)?;
            touching.extend(parts.pair.points.iter().copied());
            touching.extend((0..parts.pair.primary.nfacet() as u32).flat_map(|f| {
                match parts.pair.primary.carrier(f) {
                    signorini_geometry::surface::Carrier::Nodes(nodes) => nodes.to_vec(),
                    _ => Vec::new(),
                }
            }));
            terms.push(Box::new(Interface::new(parts, layout, elimination.clone())));
            summaries.push(summary);
        }
        let (steps, loads) = context.steps(steps)?;
        terms.extend(loads.map(|l| Box::new(l) as Box<dyn Term>));
        let held_by_contact = held.judge(&names, &layout, &steps, &elimination, &touching)?;

        let unused = (0..mesh.nnode() as NodeId)
            .filter(|n| body_of_node.get(*n as usize).is_none_or(|b| *b == u32::MAX))
            .collect();
        Ok(Self {
            system: System {
                layout,
                coordinates: reference.iter().map(|x| x.to_array()).collect(),
                reference,
                elimination,
                terms,
                body: body_of_node,
                ncell: mesh.blocks.iter().map(|b| b.ncell()).collect(),
            },
            steps,
            contacts: summaries,
            unused,
            held_by_contact,
        })
    }
}

/// The body of each cell.
fn owners(mesh: &Mesh, bodies: &[BodyPart]) -> Result<HashMap<CellId, usize>, ModelError> {
    let mut owner: HashMap<CellId, usize> = HashMap::new();
    for (number, body) in bodies.iter().enumerate() {
        if body.cells.is_empty() {
            return Err(ModelError::EmptyBody {
                body: body.name.clone(),
            });
        }
        for &cell in &body.cells {
            if let Some(before) = owner.insert(cell, number) {
                return Err(ModelError::TwoBodies {
                    label: mesh.cell_label(cell).unwrap_or(0),
                    first: bodies[before].name.clone(),
                    second: body.name.clone(),
                });
            }
        }
    }
    Ok(owner)
}

fn nodes_by_body(mesh: &Mesh, bodies: &[BodyPart]) -> Vec<u32> {
    let mut of = vec![u32::MAX; mesh.nnode()];
    for (number, body) in bodies.iter().enumerate() {
        for &cell in &body.cells {
            for &node in mesh.cell(cell) {
                of[node as usize] = number as u32;
            }
        }
    }
    of
}

/// The rigid bodies, each about the mean of its nodes.
fn rigid_bodies(mesh: &Mesh, bodies: &[BodyPart]) -> Result<Elimination, ModelError> {
    let mut rigid = Vec::new();
    let mut taken: HashMap<NodeId, &str> = HashMap::new();
    for body in bodies.iter().filter(|b| b.material.is_none()) {
        let cells = body.cells.iter();
        let nodes: BTreeSet<NodeId> = cells.flat_map(|&c| mesh.cell(c)).copied().collect();
        for &node in &nodes {
            if let Some(first) = taken.insert(node, &body.name) {
                return Err(ModelError::RigidBodiesShare {
                    first: first.to_string(),
                    second: body.name.clone(),
                    node: label(mesh, node),
                });
            }
        }
        let points = nodes.iter().filter_map(|&n| mesh.points.get(n as usize));
        let sum: Vec3 = points.copied().sum();
        rigid.push(RigidBody {
            reference: sum / nodes.len() as f64,
            nodes: nodes.into_iter().collect(),
        });
    }
    Ok(Elimination::new(rigid, mesh.nnode()))
}

fn label(mesh: &Mesh, node: NodeId) -> u64 {
    mesh.node_labels.get(node as usize).copied().unwrap_or(0)
}

/// What the parts of a model are made from.
struct Context<'a> {
    mesh: &'a Mesh,
    reference: &'a [Vec3],
    owner: &'a HashMap<CellId, usize>,
    modulus: &'a [Option<f64>],
    elimination: &'a Elimination,
    rigid_names: &'a [String],
    thickness: f64,
    layout: Layout,
}

impl Context<'_> {
    fn contact(&self, part: ContactPart) -> Result<(InterfaceParts, ContactSummary), ModelError> {
        let facets = |faces: &[Face]| {
            Facets::new(self.mesh, faces).map_err(|source| ModelError::Facets {
                contact: part.name.clone(),
                source,
            })
        };
        let surface_error = |source| ModelError::Surface {
            contact: part.name.clone(),
            source,
        };
        let primary = facets(&part.primary)?;
        let (points, secondary) = match &part.secondary {
            SidePart::Faces(faces) => {
                let surface = facets(faces)?;
                (surface.all_nodes(), Some(surface))
            }
            SidePart::Nodes(nodes) => {
                let unique: BTreeSet<NodeId> = nodes.iter().copied().collect();
                (unique.into_iter().collect(), None)
            }
        };
        if points.is_empty() {
            return Err(ModelError::EmptySide { contact: part.name });
        }
        let of_primary = primary.all_nodes();
        let shared = points
            .iter()
            .filter(|n| of_primary.binary_search(n).is_ok());
        let shared: Vec<NodeId> = shared.copied().collect();
        if let Some(&node) = shared.first() {
            return Err(ModelError::Glued {
                contact: part.name,
                count: shared.len(),
                node: label(self.mesh, node),
            });
        }
        let area: Vec<f64> = match &secondary {
            Some(surface) => surface
                .nodal_areas(self.reference)
                .map_err(surface_error)?
                .into_iter()
                .map(|(_, a)| a * self.thickness)
                .collect(),
            None => Vec::new(),
        };

        let sides = [Some(&primary), secondary.as_ref()];
        let sizes = sides.map(|s| s.map(|s| self.sizes(s)));
        let largest = sizes
            .iter()
            .flatten()
            .map(|s| s.largest)
            .fold(0.0, f64::max);
        let length = sizes[0].as_ref().map_or(largest, |s| s.mean);
        let softest = sizes
            .iter()
            .flatten()
            .filter_map(|s| s.stiffness)
            .chain(self.bare(&points, length, secondary.is_none()))
            .fold(f64::INFINITY, f64::min);
        let measure = part.measure.unwrap_or(if area.is_empty() {
            Measure::Node
        } else {
            Measure::Area
        });
        let penalty = match part.penalty {
            Some(penalty) => penalty,
            None if softest.is_finite() => {
                let per_area = PENALTY * softest;
                match measure {
                    Measure::Area => per_area,
                    Measure::Node if area.is_empty() => per_area * self.patch(length),
                    Measure::Node => per_area * area.iter().sum::<f64>() / area.len() as f64,
                }
            }
            None => return Err(ModelError::BothRigid { contact: part.name }),
        };
        let reach = part.reach.unwrap_or(REACH * largest);
        let summary = ContactSummary {
            name: part.name.clone(),
            penalty,
            measure,
            reach,
            npoint: points.len(),
            nfacet: primary.nfacet(),
            facet_size: length,
        };
        let parts = InterfaceParts {
            name: part.name,
            discretization: Box::new(NodeToSegment::new(points.len())),
            pair: SurfacePair {
                points,
                secondary,
                primary: Box::new(primary),
                reach,
            },
            law: Box::new(Penalty),
            friction: Box::new(Frictionless),
            measure,
            area,
            scale: Scale {
                penalty,
                complementarity: penalty,
                length,
            },
        };
        Ok((parts, summary))
    }

    /// The area that a bare node stands for.
    fn patch(&self, length: f64) -> f64 {
        if self.layout.ndim == 3 {
            length * length
        } else {
            length * self.thickness
        }
    }

    /// Sizes of the facets of a surface, and the stiffness M/h behind it.
    fn sizes(&self, surface: &Facets) -> Sizes {
        let at = Placement {
            x: self.reference,
            poses: &[],
        };
        let mut sizes = Sizes::default();
        let mut stiffness = 0.0;
        let mut deformable = 0;
        let n = surface.nfacet();
        for facet in 0..n as u32 {
            let size = surface.size(&at, facet);
            sizes.largest = sizes.largest.max(size);
            sizes.mean += size / n as f64;
            let face = surface.face(facet);
            let body = face.and_then(|f| self.owner.get(&f.cell));
            if let Some(modulus) = body.and_then(|&b| self.modulus[b]) {
                stiffness += modulus / size;
                deformable += 1;
            }
        }
        if deformable > 0 {
            sizes.stiffness = Some(stiffness / f64::from(deformable));
        }
        sizes
    }

    /// The stiffness behind bare nodes of deformable bodies.
    fn bare(&self, points: &[NodeId], length: f64, wanted: bool) -> Option<f64> {
        if !wanted
            || !points
                .iter()
                .any(|&n| self.elimination.body_of(n).is_none())
        {
            return None;
        }
        let softest = self.modulus.iter().flatten().copied();
        softest.reduce(f64::min).map(|m| m / length)
    }

    fn on_rigid(&self, node: NodeId) -> Result<(), ModelError> {
        match self.elimination.body_of(node) {
            None => Ok(()),
            Some(body) => Err(ModelError::OnRigidNode {
                node: label(self.mesh, node),
                body: self
                    .rigid_names
                    .get(body as usize)
                    .cloned()
                    .unwrap_or_default(),
            }),
        }
    }

    /// The raw dofs of a component of a target.
    fn dofs(&self, target: &Target, component: usize) -> Result<Vec<Dof>, ModelError> {
        let layout = &self.layout;
        let dofs = match target {
            Target::Rigid(body) if component < 3 => vec![layout.translation(*body, component)],
            Target::Rigid(body) => vec![layout.rotation(*body, component - 3)],
            Target::Nodes(_) if component >= 3 => Vec::new(),
            Target::Nodes(nodes) => {
                for &node in nodes {
                    self.on_rigid(node)?;
                }
                nodes.iter().map(|&n| layout.node(n, component)).collect()
            }
        };
        Ok(dofs.into_iter().filter(|&d| d != NO_DOF).collect())
    }

    /// What is prescribed in each step, and the loads of all steps.
    fn steps(&self, parts: Vec<StepPart>) -> Result<(Vec<Step>, Option<NodalForces>), ModelError> {
        let mut prescribed: BTreeMap<Dof, Motion> = BTreeMap::new();
        for body in 0..self.layout.nrigid as RigidId {
            for component in 0..6 {
                for dof in self.dofs(&Target::Rigid(body), component)? {
                    prescribed.insert(dof, Motion::Hold);
                }
            }
        }
        // what the user has prescribed, as against what is held because nobody says otherwise
        let mut named: BTreeSet<Dof> = BTreeSet::new();
        let mut loads: BTreeMap<String, Vec<(Dof, f64)>> = BTreeMap::new();
        let mut ends: Vec<BTreeMap<Dof, f64>> = Vec::new();
        let mut steps = Vec::new();
        for part in parts {
            for motion in prescribed.values_mut() {
                if !matches!(motion, Motion::TotalTable(_)) {
                    *motion = Motion::Hold;
                }
            }
            let mut here: HashMap<Dof, Motion> = HashMap::new();
            for change in &part.changes {
                match change {
                    Change::Prescribe(target, components) => {
                        for (component, motion) in components {
                            for dof in self.dofs(target, *component)? {
                                let before = here.insert(dof, motion.clone());
                                if before.is_some_and(|b| b != *motion) {
                                    return Err(self.clash(&part.name, dof));
                                }
                                prescribed.insert(dof, motion.clone());
                                named.insert(dof);
                            }
                        }
                    }
                    Change::Release(target, components) => {
                        for &component in components {
                            for dof in self.dofs(target, component)? {
                                prescribed.remove(&dof);
                                named.remove(&dof);
                            }
                        }
                    }
                }
            }
            for load in part.loads {
                let forces = self.load(&load.forces)?;
                if let LoadForces::Rigid(..) = load.forces {
                    // a rigid body that is loaded along an axis may move along it
                    for (dof, _) in forces.iter().filter(|(d, _)| !named.contains(d)) {
                        prescribed.remove(dof);
                    }
                }
                loads.insert(load.name, forces);
            }
            let mut end = BTreeMap::new();
            for (dof, force) in loads.values().flatten() {
                *end.entry(*dof).or_insert(0.0) += force;
            }
            ends.push(end);
            let prescriptions = prescribed.iter().map(|(&dof, motion)| Prescription {
                dof,
                motion: motion.clone(),
            });
            steps.push(Step {
                name: part.name,
                duration: part.duration,
                increments: part.increments,
                nonlinear: part.nonlinear,
                prescriptions: prescriptions.collect(),
            });
        }
        let dofs: BTreeSet<Dof> = ends.iter().flat_map(|e| e.keys().copied()).collect();
        if dofs.is_empty() {
            return Ok((steps, None));
        }
        let row = |end: &BTreeMap<Dof, f64>| {
            let value = |dof| end.get(dof).copied().unwrap_or(0.0);
            dofs.iter().map(value).collect()
        };
        let rows = ends.iter().map(row).collect();
        let dofs = dofs.iter().copied().collect();
        Ok((steps, Some(NodalForces::new(dofs, rows))))
    }

    fn clash(&self, step: &str, dof: Dof) -> ModelError {
        let (node, axis) = match self.layout.name(dof) {
            Some(crate::system::DofName::Node(node, axis)) => (label(self.mesh, node), axis),
            _ => (0, 0),
        };
        ModelError::Clash {
            step: step.to_string(),
            node,
            component: ['x', 'y', 'z'][axis.min(2)],
        }
    }

    fn load(&self, forces: &LoadForces) -> Result<Vec<(Dof, f64)>, ModelError> {
        let mut out = Vec::new();
        match forces {
            LoadForces::Rigid(body, force) => {
                out.extend((0..3).map(|c| (self.layout.translation(*body, c), force[c])));
            }
            LoadForces::Nodes(nodes) => {
                for &(node, force) in nodes {
                    self.on_rigid(node)?;
                    out.extend((0..3).map(|c| (self.layout.node(node, c), force[c])));
                }
            }
        }
        out.retain(|(dof, force)| *dof != NO_DOF && *force != 0.0);
        Ok(out)
    }
}

#[derive(Default)]
struct Sizes {
    mean: f64,
    largest: f64,
    stiffness: Option<f64>,
}

/// Which deformable bodies hang together, and what holds them.
struct Held {
    /// Representative node of each node's part; nodes of no deformable cell stand alone.
    root: Vec<NodeId>,
    /// One node of each body.
    sample: Vec<Option<NodeId>>,
}

impl Held {
    fn new(mesh: &Mesh, bodies: &[BodyPart]) -> Self {
        let mut root: Vec<NodeId> = (0..mesh.nnode() as NodeId).collect();
        fn find(root: &mut [NodeId], mut n: NodeId) -> NodeId {
            while root[n as usize] != n {
                root[n as usize] = root[root[n as usize] as usize];
                n = root[n as usize];
            }
            n
        }
        let mut sample = Vec::new();
        for body in bodies {
            for &cell in &body.cells {
                let nodes = mesh.cell(cell);
                for pair in nodes.windows(2) {
                    let (a, b) = (find(&mut root, pair[0]), find(&mut root, pair[1]));
                    root[a.max(b) as usize] = a.min(b);
                }
            }
            let first = body.cells.first().map(|&c| mesh.cell(c));
            let deformable = body.material.is_some();
            sample.push(
                first
                    .and_then(|n| n.first().copied())
                    .filter(|_| deformable),
            );
        }
        for n in 0..root.len() as NodeId {
            root[n as usize] = find(&mut root, n);
        }
        Self { root, sample }
    }

    /// Bodies held by contact alone; an error for one that nothing holds.
    fn judge(
        &self,
        names: &[String],
        layout: &Layout,
        steps: &[Step],
        elimination: &Elimination,
        touching: &BTreeSet<NodeId>,
    ) -> Result<Vec<String>, ModelError> {
        let root = |node: NodeId| self.root.get(node as usize).copied();
        let mut supported: BTreeSet<NodeId> = BTreeSet::new();
        let first = steps.first().map_or(&[][..], |s| &s.prescriptions);
        for p in first {
            if let Some(crate::system::DofName::Node(node, _)) = layout.name(p.dof) {
                supported.extend(root(node));
            }
        }
        for body in elimination.bodies() {
            supported.extend(body.nodes.iter().filter_map(|&n| root(n)));
        }
        let touched: BTreeSet<NodeId> = touching.iter().filter_map(|&n| root(n)).collect();
        let mut by_contact = Vec::new();
        for (name, sample) in names.iter().zip(&self.sample) {
            let Some(part) = sample.and_then(root) else {
                continue;
            };
            if supported.contains(&part) {
                continue;
            }
            if !touched.contains(&part) {
                return Err(ModelError::FreeBody { body: name.clone() });
            }
            by_contact.push(name.clone());
        }
        Ok(by_contact)
    }
}
