//! From a case to a model: names become nodes, cells and faces; every fault becomes a message with its place.
//!
//! ```text
//! Case ──mesh──▶ Mesh ──names──▶ Parts ──mechanics::model──▶ Model
//! ```

mod mesh;
mod names;

pub use mesh::read_mesh_of;

use names::Names;
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::surface::{Facets, RigidId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{
    self, Amplitude, Case, Enforcement, Geometry, LoadKind, Method, Name, Per, Remedy, TimeBase,
};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Spanned, codes};
use signorini_mechanics::contact::Measure;
use signorini_mechanics::load::Course;
use signorini_mechanics::material::{self, Constants};
use signorini_mechanics::model::{
    BodyKind, BodyPart, CarrierPart, Change, ContactPart, Load, LoadPart, ModelError, Parts,
    SidePart, StepPart, Target,
};
use signorini_mechanics::solid::{Integration, Locking};
use signorini_mechanics::solve::{
    Increments, LineSearch, Motion, NewtonSettings, Step, StepperSettings,
};
use signorini_mechanics::system::linear::LinearKind;
use signorini_mechanics::system::{Idealisation, System};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A case, built: everything a run needs.
pub struct Model {
    /// What the run is called: the stem of its files.
    pub name: String,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// What is solved.
    pub system: System,
    /// The steps.
    pub steps: Vec<Step>,
    /// The numbers of the solution.
    pub settings: StepperSettings,
    /// The contacts, with what was chosen for them.
    pub contacts: Vec<ContactInfo>,
    /// Rigid bodies, by the names they have in histories.
    pub references: Vec<ReferenceInfo>,
    /// The case, every automatic choice replaced by what was chosen.
    pub case: Case,
    /// What is unusual.
    pub warnings: Diagnostics,
    sets: BTreeMap<String, Vec<NodeId>>,
    by_label: BTreeMap<u64, NodeId>,
}

/// What a contact became.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactInfo {
    /// Its name.
    pub name: String,
    /// The method in use.
    pub method: &'static str,
    /// The penalty in use.
    pub penalty: f64,
    /// What it refers to: `"node"` or `"area"`.
    pub per: &'static str,
    /// Points of the secondary side.
    pub npoint: usize,
    /// Facets of the primary side.
    pub nfacet: usize,
    /// Size of its facets.
    pub facet_size: f64,
}

/// A rigid body, as histories name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReferenceInfo {
    /// Name of its group.
    pub name: String,
    /// Its number.
    pub rigid: RigidId,
}

impl Model {
    /// The nodes of a set or group.
    #[must_use]
    pub fn nodes_of(&self, set: &str) -> Option<Vec<NodeId>> {
        self.sets.get(set).cloned()
    }

    /// The node of this number in the input.
    #[must_use]
    pub fn node(&self, label: u64) -> Option<NodeId> {
        self.by_label.get(&label).copied()
    }
}

/// Builds the model of a case with its mesh.
///
/// # Errors
/// Names that the mesh does not have, sets of the wrong kind, and what makes no well-posed model: all messages at once
/// as far as they do not follow from each other.
pub fn build(mut case: Case, mesh: Mesh) -> Result<Model, Diagnostics> {
    let mut found = Diagnostics::new();
    let names = Names::new(&case, &mesh, &mut found);
    let ndim = match case.model.space.value {
        case::Space::ThreeD => 3,
        case::Space::PlaneStrain => 2,
    };
    if mesh.dim() != ndim {
        found.push(wrong_dimension(&case, &mesh, ndim));
        return Err(found);
    }

    let mut rigid: BTreeMap<String, RigidId> = BTreeMap::new();
    let mut references = Vec::new();
    let mut bodies = Vec::new();
    for body in &case.bodies {
        let mut cells = Vec::new();
        for group in &body.groups {
            cells.extend(names.solids(group, &mut found));
        }
        let name = body.groups.iter().map(|g| g.value.as_str());
        let name = name.collect::<Vec<_>>().join("+");
        if body.rigid {
            let id = references.len() as RigidId;
            for group in &body.groups {
                rigid.insert(group.value.clone(), id);
            }
            references.push(ReferenceInfo {
                name: body
                    .groups
                    .first()
                    .map_or_else(String::new, |g| g.value.clone()),
                rigid: id,
            });
        }
        let kind = if body.rigid {
            Some(BodyKind::Rigid(references.len() as RigidId - 1))
        } else {
            let material = body.material.as_ref();
            let material = material.and_then(|m| make_material(&case, m, &mut found));
            material.map(|material| BodyKind::Solid {
                material,
                density: None,
                integration: Integration::Full,
                locking: Locking::Auto,
            })
        };
        bodies.extend(kind.map(|kind| BodyPart { name, cells, kind }));
    }

    let contacts: Vec<ContactPart> = case
        .contacts
        .iter()
        .filter(|c| c.active)
        .filter_map(|c| contact(c, &names, &mut found))
        .collect();
    let steps: Vec<StepPart> = StepBuilder {
        case: &case,
        mesh: &mesh,
        names: &names,
        rigid: &rigid,
    }
    .steps(&mut found);
    if found.has_errors() {
        return Err(found);
    }

    let space = match case.model.space.value {
        case::Space::ThreeD => Idealisation::Space,
        case::Space::PlaneStrain => Idealisation::PlaneStrain {
            thickness: case.model.thickness,
        },
    };
    let carriers = references.iter().map(|r: &ReferenceInfo| CarrierPart {
        name: r.name.clone(),
        at: None,
    });
    let carriers = carriers.collect();
    let parts = Parts {
        mesh: &mesh,
        space,
        bodies,
        carriers,
        springs: Vec::new(),
        constraints: Vec::new(),
        contacts,
        temperature: Vec::new(),
        steps,
    };
    let model = match signorini_mechanics::model::Model::assemble(parts) {
        Ok(model) => model,
        Err(error) => {
            found.push(refused(&case, &error));
            return Err(found);
        }
    };
    for unheld in &model.held_by_contact {
        found.push(
            Diagnostic::warning(
                &codes::HELD_BY_CONTACT,
                format!("{unheld} is held only by contact"),
            )
            .note(format!("without contact it is free to {}", unheld.motion))
            .help("hold it by a support, or prescribe its motion with `move` instead of `load`"),
        );
    }

    found.append(stiff_elements(&case, &names, &mesh));
    let allowed: Vec<&str> = case.allow.iter().map(String::as_str).collect();
    found.silence(&allowed);

    let contacts: Vec<ContactInfo> = model
        .contacts
        .iter()
        .map(|c| ContactInfo {
            name: c.name.clone(),
            method: "node-to-segment",
            penalty: c.penalty,
            per: match c.measure {
                Measure::Area => "area",
                Measure::Node => "node",
            },
            npoint: c.npoint,
            nfacet: c.nfacet,
            facet_size: c.facet_size,
        })
        .collect();
    for (part, summary) in case
        .contacts
        .iter_mut()
        .filter(|c| c.active)
        .zip(&model.contacts)
    {
        part.method.value = Method::NodeToSegment;
        part.enforcement = Enforcement::Penalty {
            penalty: Some(summary.penalty.into()),
            per: Some(match summary.measure {
                Measure::Area => Per::Area,
                Measure::Node => Per::Node,
            }),
        };
        part.reach = Some(summary.reach);
    }
    let newton = &case.solver.newton;
    let settings = StepperSettings {
        newton: NewtonSettings {
            max_iterations: newton.max_iterations as usize,
            force_tol: newton.force_tol,
            line_search: match newton.line_search {
                case::LineSearch::Off => LineSearch::Off,
                case::LineSearch::Auto | case::LineSearch::On => LineSearch::Auto,
            },
        },
        linear: match case.solver.linear {
            case::LinearChoice::Auto => LinearKind::Auto,
            case::LinearChoice::Direct => LinearKind::Direct,
        },
    };
    let sets = names.node_sets();
    let labels = mesh.node_labels.iter().enumerate();
    let by_label = labels
        .map(|(node, &label)| (label, node as NodeId))
        .collect();
    drop(names);
    Ok(Model {
        name: String::from("case"),
        system: model.system,
        steps: model.steps,
        settings,
        contacts,
        references,
        case,
        warnings: found,
        sets,
        by_label,
        mesh: Arc::new(mesh),
    })
}

/// Elements that are too stiff in bending.
const STIFF: [&str; 3] = ["tri3", "tet4", "wedge6"];

/// A warning for each deformable body of linear triangles, tetrahedra or wedges.
fn stiff_elements(case: &Case, names: &Names<'_>, mesh: &Mesh) -> Diagnostics {
    let mut found = Diagnostics::new();
    for body in case.bodies.iter().filter(|b| !b.rigid) {
        let groups = body.groups.iter();
        let cells = groups.flat_map(|g| names.solids(g, &mut Diagnostics::new()));
        let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
        for element in cells.filter_map(|cell| mesh.element(cell)) {
            if STIFF.contains(&element.name()) {
                *kinds.entry(element.name()).or_default() += 1;
            }
        }
        if kinds.is_empty() {
            continue;
        }
        let counts: Vec<String> = kinds.iter().map(|(k, n)| format!("{n} {k}")).collect();
        let group = body.groups.first().map_or("", |g| g.value.as_str());
        found.push(
            Diagnostic::warning(
                &codes::STIFF_ELEMENTS,
                format!("body \"{group}\" has {}: too stiff in bending", counts.join(", ")),
            )
            .at(&body.place, "")
            .help("use quad4 or hex8, elements of second order, or several over the thickness; allow = [\"S0404\"] silences"),
        );
    }
    found
}

fn wrong_dimension(case: &Case, mesh: &Mesh, ndim: usize) -> Diagnostic {
    let space = &case.model.space;
    let message = match (mesh.dim(), ndim) {
        (2, 3) => "the mesh has no volume elements; did you save only the surface?".to_string(),
        (3, 2) => "the mesh has volume elements, the model is in the plane".to_string(),
        _ => "the mesh has no solid elements".to_string(),
    };
    Diagnostic::error(&codes::BAD_MESH, message)
        .at(&space.place, format!("{ndim} dimensions here"))
        .help(if ndim == 3 {
            "export the volume elements, or choose  [model] space = \"plane-strain\""
        } else {
            "choose  [model] space = \"3d\""
        })
}

fn make_material(
    case: &Case,
    name: &Name,
    found: &mut Diagnostics,
) -> Option<Box<dyn material::Material>> {
    let part = case.materials.iter().find(|m| m.name.value == name.value)?;
    let law = material::by_name(&part.model.value)?;
    let constants = Constants::elastic(part.young.value, part.poisson.value);
    match (law.make)(&constants) {
        Ok(material) => Some(material),
        Err(error) => {
            found.push(
                Diagnostic::error(&codes::OUT_OF_RANGE, error.to_string())
                    .at(&part.model.place, "in this material"),
            );
            None
        }
    }
}

fn contact(
    part: &case::Contact,
    names: &Names<'_>,
    found: &mut Diagnostics,
) -> Option<ContactPart> {
    let primary = names.faces(&part.primary, found);
    let secondary = names.side(&part.secondary, found);
    if part.primary.value == part.secondary.value {
        found.push(
            Diagnostic::error(
                &codes::BAD_SIDES,
                format!(
                    "both sides of contact \"{}\" are \"{}\"",
                    part.name.value, part.primary.value
                ),
            )
            .at(&part.secondary.place, "the same as `primary`")
            .help("name two different surfaces"),
        );
        return None;
    }
    let (penalty, measure) = match &part.enforcement {
        Enforcement::Auto => (None, None),
        Enforcement::Penalty { penalty, per } => (
            penalty.as_ref().map(|p| p.value),
            per.map(|p| match p {
                Per::Node => Measure::Node,
                Per::Area => Measure::Area,
            }),
        ),
    };
    let secondary = secondary?;
    if measure == Some(Measure::Area) && matches!(secondary, SidePart::Nodes(_)) {
        found.push(
            Diagnostic::error(
                &codes::WRONG_KIND,
                format!(
                    "contact \"{}\": \"{}\" is bare nodes, a penalty per area needs faces",
                    part.name.value, part.secondary.value
                ),
            )
            .at(&part.secondary.place, "no whole face of a solid")
            .help("write  per = \"node\"  in `enforcement`, or name a surface"),
        );
        return None;
    }
    Some(ContactPart {
        name: part.name.value.clone(),
        secondary,
        primary: primary?,
        penalty,
        measure,
        reach: part.reach,
    })
}

/// Steps, with what earlier ones leave behind.
struct StepBuilder<'a> {
    case: &'a Case,
    mesh: &'a Mesh,
    names: &'a Names<'a>,
    rigid: &'a BTreeMap<String, RigidId>,
}

impl StepBuilder<'_> {
    fn steps(&self, found: &mut Diagnostics) -> Vec<StepPart> {
        let mut nonlinear = true;
        let mut steps = Vec::new();
        for step in &self.case.steps {
            match step.geometry {
                Geometry::Auto => {}
                Geometry::Linear => nonlinear = false,
                Geometry::Nonlinear => nonlinear = true,
            }
            let mut changes = Vec::new();
            for free in &step.frees {
                if let Some(target) = self.target(&free.on, found) {
                    let components = picked(&free.u, &free.rot);
                    changes.push(Change::Release(target, components));
                }
            }
            for fix in &step.fixes {
                if let Some(target) = self.target(&fix.on, found) {
                    let hold = |c| (c, Motion::Hold);
                    let components = picked(&fix.u, &fix.rot).into_iter().map(hold);
                    changes.push(Change::Prescribe(target, components.collect()));
                }
            }
            for part in &step.moves {
                if let Some(target) = self.target(&part.on, found) {
                    let courses = part.u.iter().chain(&part.rot).enumerate();
                    let motions = courses.filter_map(|(c, m)| Some((c, self.motion(m.as_ref()?))));
                    changes.push(Change::Prescribe(target, motions.collect()));
                }
            }
            let mut loads = Vec::new();
            for (number, load) in step.loads.iter().enumerate() {
                let given = load.name.as_ref().map(|n| n.value.clone());
                let name = given.unwrap_or_else(|| format!("{}#{number}", step.name.value));
                if let Some(load) = self.load(load, found) {
                    let course = Course::Ramp;
                    loads.push(LoadPart { name, load, course });
                }
            }
            steps.push(StepPart {
                name: step.name.value.clone(),
                duration: step.duration,
                increments: increments(&step.increments, step.duration, self.may_cut()),
                nonlinear,
                changes,
                loads,
                temperatures: Vec::new(),
            });
        }
        steps
    }

    /// Whether an increment that fails may be tried again in smaller pieces.
    fn may_cut(&self) -> bool {
        self.case.solver.on_trouble.contains(&Remedy::Cut)
    }

    fn target(&self, on: &Name, found: &mut Diagnostics) -> Option<Target> {
        if let Some(&body) = self.rigid.get(&on.value) {
            return Some(Target::Rigid(body));
        }
        self.names.nodes(on, found).map(Target::Nodes)
    }

    fn motion(&self, course: &case::Motion) -> Motion {
        match course {
            case::Motion::Ramp(to) => Motion::Ramp(*to),
            case::Motion::Table(table) => Motion::Table(table.clone()),
            case::Motion::Amplitude { name, value } => {
                let amplitude = self
                    .case
                    .amplitudes
                    .iter()
                    .find(|a| a.name.value == name.value);
                amplitude.map_or(Motion::Hold, |a| scaled(a, *value))
            }
        }
    }

    fn load(&self, load: &case::Load, found: &mut Diagnostics) -> Option<Load> {
        let target = self.target(&load.on, found)?;
        match (target, &load.kind) {
            (Target::Rigid(body), LoadKind::Force(f) | LoadKind::PerNode(f)) => {
                Some(Load::Carrier {
                    carrier: body,
                    force: Vec3::from(*f),
                    moment: Vec3::ZERO,
                })
            }
            (Target::Nodes(nodes), LoadKind::PerNode(f)) => {
                let force = Vec3::from(*f);
                Some(Load::Nodes(nodes.into_iter().map(|n| (n, force)).collect()))
            }
            (Target::Nodes(nodes), LoadKind::Force(f)) => {
                let total = Vec3::from(*f);
                let shares = self.shares(&load.on, &nodes);
                let shared = shares.into_iter().map(|(n, share)| (n, total * share));
                Some(Load::Nodes(shared.collect()))
            }
        }
    }

    /// How a total force is shared: by area over a surface, evenly over bare nodes.
    fn shares(&self, on: &Name, nodes: &[NodeId]) -> Vec<(NodeId, f64)> {
        let even = 1.0 / nodes.len().max(1) as f64;
        let of_faces = self.names.faces_quietly(on).and_then(|faces| {
            let areas = Facets::new(self.mesh, &faces).ok()?;
            areas.nodal_areas(&self.mesh.points, &|_| 1.0).ok()
        });
        match of_faces {
            Some(areas) => {
                let total: f64 = areas.iter().map(|a| a.1).sum();
                areas.into_iter().map(|(n, a)| (n, a / total)).collect()
            }
            None => nodes.iter().map(|&n| (n, even)).collect(),
        }
    }
}

fn picked(u: &case::Directions, rot: &case::Directions) -> Vec<usize> {
    let all = u.xyz.iter().chain(&rot.xyz).enumerate();
    all.filter_map(|(c, &on)| on.then_some(c)).collect()
}

fn scaled(amplitude: &Amplitude, factor: f64) -> Motion {
    let rows = amplitude.table.iter().map(|[t, v]| [*t, v * factor]);
    match amplitude.time {
        TimeBase::Step => Motion::Table(rows.collect()),
        TimeBase::Total => Motion::TotalTable(rows.collect()),
    }
}

fn increments(part: &case::Increments, duration: f64, may_cut: bool) -> Increments {
    let (initial, min, max, count_max) = match *part {
        case::Increments::Fixed(n) => return Increments::Fixed(n as usize),
        case::Increments::Count(n) => {
            let size = duration / n as f64;
            (size, 1e-5 * size, size, n.saturating_mul(100).max(1000))
        }
        case::Increments::Adaptive {
            initial,
            min,
            max,
            count_max,
        } => (initial, min, max, count_max),
    };
    Increments::Adaptive {
        initial,
        min: if may_cut { min } else { f64::INFINITY },
        max,
        count_max: count_max as usize,
    }
}

/// The message for what makes no model.
fn refused(case: &Case, error: &ModelError) -> Diagnostic {
    let of_contact = |name: &str| case.contacts.iter().find(|c| c.name.value == name);
    let of_body = |name: &str| {
        case.bodies.iter().find(|b| {
            b.groups
                .iter()
                .any(|g| name.split('+').any(|n| n == g.value))
        })
    };
    let of_step = |name: &str| case.steps.iter().find(|s| s.name.value == name);
    let of_load = |name: &str| {
        let mut loads = case.steps.iter().flat_map(|s| &s.loads);
        loads.find(|l| l.name.as_ref().is_some_and(|n| n.value == name))
    };
    let (code, place, help) = match error {
        ModelError::NothingDeforms => (
            &codes::NOTHING_TO_SOLVE,
            case.bodies.first().map(|b| &b.place),
            "give at least one [[body]] a `material`",
        ),
        ModelError::TwoBodies { second, .. } | ModelError::RigidBodiesShare { second, .. } => (
            &codes::BOTH_BODIES,
            of_body(second).map(|b| &b.place),
            "name groups that do not overlap",
        ),
        ModelError::EmptyBody { body } => (
            &codes::WRONG_KIND,
            of_body(body).map(|b| &b.place),
            "name a group of solid elements",
        ),
        ModelError::Solid(signorini_mechanics::solid::SolidError::NotSolid { body, .. }) => (
            &codes::WRONG_KIND,
            of_body(body).map(|b| &b.place),
            "name a group of solid elements of the model's dimension",
        ),
        ModelError::Facets { contact, .. } | ModelError::EmptySide { contact } => (
            &codes::WRONG_KIND,
            of_contact(contact).map(|c| &c.place),
            "name surfaces with faces",
        ),
        ModelError::Surface { contact, .. } => (
            &codes::BAD_ELEMENTS,
            of_contact(contact).map(|c| &c.place),
            "look at the mesh: signorini check",
        ),
        ModelError::Glued { contact, .. } => (
            &codes::BAD_SIDES,
            of_contact(contact).map(|c| &c.place),
            "mesh the two bodies apart, without common nodes",
        ),
        ModelError::BothRigid { contact } => (
            &codes::BAD_SIDES,
            of_contact(contact).map(|c| &c.place),
            "give one of the bodies a `material`, or a `penalty` to the contact",
        ),
        ModelError::FreeBody(free) => (
            &codes::FREE_BODY,
            free.bodies
                .first()
                .and_then(|b| of_body(b))
                .map(|b| &b.place),
            "add a [[step.fix]] or [[step.move]] on it in the first step",
        ),
        ModelError::Clash { step, .. } => (
            &codes::CLASH,
            of_step(step).map(|s| &s.place),
            "take the node out of one of the two sets",
        ),
        ModelError::Constraint(_) => (
            &codes::CLASH,
            None,
            "take out what is said twice, or what cannot be followed",
        ),
        ModelError::Load { load, .. } => (
            &codes::WRONG_KIND,
            of_load(load).map(|l| &l.place),
            "name something that this load can act on",
        ),
        ModelError::OnRigidNode { body, .. } => (
            &codes::CLASH,
            of_body(body).map(|b| &b.place),
            "name the rigid body itself in `on`",
        ),
    };
    let message = Diagnostic::error(code, error.to_string()).help(help);
    match place {
        Some(place) => message.at(place, ""),
        None => message,
    }
}

/// A name as written, for messages.
pub(crate) fn quoted(name: &Spanned<String>) -> String {
    format!("\"{}\"", name.value)
}
