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
//! * motions of rigid bodies that no step, load or equation names: held. References of kinematic and distributing
//!   couplings are free: along what moves their nodes, and altogether, respectively. In an axisymmetric model carriers
//!   move along the axis and in no other way.
//!
//! Translations and rotations of a carrier are prescribed by components. The rotation that results is composed of the
//! increments of the rotation vector: what `rx, ry, rz` prescribe is the integral of its rate, so that components
//! ramped together turn about a fixed axis, by as many turns as one likes.

mod activity;
mod activity_error;
mod bodies;
mod constraint_error;
mod constraints;
mod contact;
mod context;
mod error;
mod heat;
mod held;
mod impact;
mod inertia;
mod label;
mod loads;
mod parts;
mod reduction;
mod rigid_masses;
mod satisfied;
mod spaces;
mod steps;
mod substance;
mod summary;

pub use crate::load::LoadError;
pub use activity_error::ActivityError;
pub use constraint_error::ConstraintError;
pub use error::ModelError;
pub use held::Unheld;
pub use impact::ControlPart;
pub use parts::{
    ActivityPart, AreaPart, BodyKind, BodyPart, CarrierMass, CarrierPart, CarrierVelocity, Change,
    CohesionPart, ConstraintKind, ConstraintPart, ContactChange, ContactPart, Enforcement,
    FeaturesPart, FluidPart, FrictionPart, HeatPart, Interference, LoadPart, MassMatrix, MassPart,
    Method, Normals, PairOrder, Parts, PointKind, PointRule, PrimaryPart, SidePart, SofteningPart,
    SpringPart, StartPart, StepPart, StickPart, Target, TieOffset, TiePart, Unknown, WearPart,
};
pub use summary::{
    BentSummary, CohesionSummary, ContactSummary, LockingSummary, OpenEdges, StartPlace,
    StartSummary, Treatment,
};

use crate::contact::Interface;
use crate::material::Material;
use crate::solve::Step;
use crate::system::{Elimination, Layout, System, Term};
use bodies::{between, nodes_by_body, owners};
use constraints::Followers;
use contact::{Sides, Source};
use context::{Context, Singles};
use held::Held;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::surface::Bodies;
use signorini_geometry::tensor::Vec3;
use spaces::Spaces;
use std::sync::Arc;
use substance::Substance;

/// A system with the steps it is to go through.
///
/// # Example
/// ```
/// use signorini_geometry::element::by_name;
/// use signorini_geometry::mesh::Mesh;
/// use signorini_geometry::tensor::Vec3;
/// use signorini_mechanics::material::SaintVenantKirchhoff;
/// use signorini_mechanics::model::{BodyKind, BodyPart, Change, Model, Parts, StepPart, Target};
/// use signorini_mechanics::solve::{Event, Flow, Increments, Motion, Stepper, StepperSettings};
/// use signorini_mechanics::system::Idealisation;
///
/// // a cube of side 1 and E = 1000, ν = 0, pulled by 0.01
/// let mut mesh = Mesh::default();
/// for z in [0.0, 1.0] {
///     for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
///         mesh.points.push(Vec3::new(x, y, z));
///         mesh.node_labels.push(mesh.points.len() as u64);
///     }
/// }
/// let hex8 = by_name("hex8").ok_or("not in the table")?;
/// let cell = mesh.push_cell(hex8, &[0, 1, 2, 3, 4, 5, 6, 7], 1);
/// let moved = |nodes: [u32; 4], motion| {
///     let motions = vec![(0, Motion::Hold), (1, Motion::Hold), (2, motion)];
///     Change::Prescribe(Target::Nodes(nodes.to_vec()), motions)
/// };
/// let mut pull = StepPart::new("pull", Increments::Fixed(1));
/// pull.nonlinear = false;
/// pull.changes = vec![moved([0, 1, 2, 3], Motion::Hold), moved([4, 5, 6, 7], Motion::Ramp(0.01))];
/// let mut model = Model::assemble(Parts {
///     bodies: vec![BodyPart {
///         name: "cube".into(),
///         cells: vec![cell],
///         kind: BodyKind::solid(Box::new(SaintVenantKirchhoff::new(1000.0, 0.0))),
///     }],
///     steps: vec![pull],
///     ..Parts::new(&mesh, Idealisation::Space)
/// })?;
///
/// let mut stepper = Stepper::new(&model.system, StepperSettings::default());
/// let mut forces = Vec::new();
/// let mut watch = |event: &Event<'_>| {
///     if let Event::Increment { frame, .. } = event {
///         forces.push(frame.reaction_force[4..].iter().map(|f| f.z).sum::<f64>());
///     }
///     Flow::Continue
/// };
/// stepper.run(&mut model.system, &model.steps, &mut watch)?;
/// // E A u/L
/// assert!((forces[0] - 10.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Model {
    /// What is solved.
    pub system: System,
    /// The steps.
    pub steps: Vec<Step>,
    /// The contacts, with what was chosen for them.
    pub contacts: Vec<ContactSummary>,
    /// What was chosen against locking, by body, size of strains and element.
    pub locking: Vec<LockingSummary>,
    /// Nodes that no body uses: they take no part.
    pub unused: Vec<NodeId>,
    /// Motions of bodies that nothing but contact stops.
    pub held_by_contact: Vec<Unheld>,
}

impl Model {
    /// Puts the parts together.
    ///
    /// # Errors
    /// What makes no model, each case named with the user's own numbers and names.
    pub fn assemble(parts: Parts<'_>) -> Result<Self, ModelError> {
        let (mesh, space) = (parts.mesh, parts.space);
        let (bodies, contacts) = (&parts.bodies, &parts.contacts);
        let owner = owners(mesh, bodies)?;
        let activity = Arc::new(activity::activity(mesh, bodies, &owner, &parts.steps)?);
        let (body_of_node, directors) = nodes_by_body(&parts);
        let between = between(mesh, bodies);
        let spaces = Spaces::new(space, &owner, &body_of_node, bodies);
        let followers = Followers {
            mesh,
            space,
            bodies,
            carriers: &parts.carriers,
            constraints: &parts.constraints,
            springs: &parts.springs,
            contacts,
        };
        let mut layout = heat::with_temperatures(followers.layout(), &parts.steps);
        let (elimination, ties) = followers.elimination(&layout, directors)?;
        let poses = elimination.initial_poses();
        let joint = contact::Steps::new(contacts, &parts.steps, &activity, parts.tolerances());
        let rubs = joint.rubbing();
        let motions = steps::prescribed(mesh.nnode(), &parts.steps);
        let source = Source {
            mesh,
            bodies: &connected(mesh, contacts),
            reference: &mesh.points,
            space,
            spaces: &spaces,
            elimination: &elimination,
            prescribed: &steps::in_whole(&motions, space.ndim()),
            motions: &motions,
            rubs: &rubs,
        };
        let reference: Arc<[Vec3]> = contact::closed(&source, contacts, &poses)?.into();
        let source = source.with_reference(&reference);
        let sides = all_sides(&source, &joint, &mut layout)?;
        let connectors = followers.connectors(&layout, &ties, &elimination, &reference)?;
        let (modulus, shear_modulus) = moduli(bodies, &parts)?;
        let substances: Vec<_> = bodies.iter().map(|b| Substance::new(b, space)).collect();
        let singles = Singles::new(&body_of_node, &followers, &parts.masses);
        let at_start = heat::at_start(&layout, &parts.temperature);
        let temperature = heat::given(parts.temperature, &parts.steps);
        let mut context = Context {
            mesh,
            singles: &singles,
            reference: &reference,
            owner: &owner,
            modulus: &modulus,
            shear_modulus: &shear_modulus,
            substances: &substances,
            elimination: Arc::new(elimination),
            carriers: &parts.carriers,
            heavy: Arc::new([]),
            space,
            spaces: &spaces,
            layout,
            radiation: parts.radiation,
            ties: &ties,
            poses,
            activity,
        };
        context.weigh(&parts.masses, &parts.carrier_masses);
        let (mut steps, loads) = context.steps(parts.steps, contacts)?;
        let elimination = Arc::make_mut(&mut context.elimination);
        followers.relate(&layout, &ties, elimination, &mut steps)?;
        // forces on unknowns that follow by an equation have a stiffness, too: equations come before loads
        let loads = loads::terms(&context, &steps, loads)?;
        let held_by_contact =
            followers.held_by_contact(&context, &joint, &steps, parts.hold_free)?;
        let held = parts.stabilize.then_some(&held_by_contact[..]);
        let dampers = context.dampers(bodies, held, contacts.is_empty());
        let (mut terms, locking) = context.bodies(parts.bodies, temperature, &steps)?;
        terms.extend(connectors);
        let summaries = context.interfaces(sides, &joint, &mut terms)?;
        let rates = context.rates_at_start(parts.velocity, &parts.carrier_velocities);
        let inertia = context.inertia(&steps, contacts, &parts.masses, rates.as_ref())?;
        terms.extend(loads.into_iter().chain(dampers).chain(inertia));
        Ok(Self {
            unused: unused(&body_of_node),
            system: System {
                layout,
                elimination: context.elimination.clone(),
                heavy: context.heavy.clone(),
                coordinates: coordinates(&context.elimination, &reference),
                reference,
                terms,
                body: body_of_node,
                between,
                ncell: mesh.blocks.iter().map(|b| b.ncell()).collect(),
                rates,
                at_start,
                wanted: crate::system::Wanted::default(),
            },
            steps,
            contacts: summaries,
            locking,
            held_by_contact,
        })
    }
}

/// Where the nodes are, for solvers by multigrid. Without places there is none: no hierarchy takes over the bending of thin bodies, and
/// the graph of their equations is that of a surface, which a direct solver factorizes fast.
fn coordinates(elimination: &Elimination, reference: &[Vec3]) -> Vec<[f64; 3]> {
    match elimination.directors().all() {
        [] => reference.iter().map(|x| x.to_array()).collect(),
        _ => Vec::new(),
    }
}

/// Where nothing deforms, only inertia gives equations.
fn something_deforms(modulus: &[Option<f64>], parts: &Parts<'_>) -> Result<(), ModelError> {
    let moves = parts.steps.iter().any(|step| step.scheme.is_some());
    let stands_still = parts.steps.iter().all(|step| !step.physics.moves);
    let is_rigid = modulus.iter().all(Option::is_none) && parts.springs.is_empty();
    match is_rigid && !moves && !stands_still {
        true => Err(ModelError::NothingDeforms),
        false => Ok(()),
    }
}

/// Young's and shear moduli of bodies, as far as they have any; some body must where nothing else gives equations.
fn moduli(bodies: &[BodyPart], parts: &Parts<'_>) -> Result<Moduli, ModelError> {
    let materials = bodies.iter().map(|b| b.kind.material());
    let of = |material: Option<&dyn Material>| {
        material.map_or((None, None), |m| (Some(m.modulus()), m.shear_modulus()))
    };
    let (modulus, shear_modulus): Moduli = materials.map(of).unzip();
    something_deforms(&modulus, parts)?;
    Ok((modulus, shear_modulus))
}

/// Young's and shear moduli of bodies.
type Moduli = (Vec<Option<f64>>, Vec<Option<f64>>);

impl Followers<'_> {
    /// Motions of bodies that nothing but contact stops: in the first step, and whenever elements are removed or added.
    fn held_by_contact(
        &self,
        context: &Context<'_>,
        contacts: &contact::Steps<'_>,
        steps: &[Step],
        hold_free: bool,
    ) -> Result<Vec<Unheld>, ModelError> {
        let mut all: Vec<Unheld> = Vec::new();
        let changed = (1..steps.len()).filter(|&step| context.activity.changes_at(step));
        let is_static = |number: &usize| {
            let step = steps.get(*number);
            step.is_none_or(|step| step.is_static() && step.physics.moves)
        };
        // vibrations need no supports, nor does heat
        let needs = |step: &Step| step.vibration.is_none() && step.physics.moves;
        let first = steps.iter().position(needs).unwrap_or_default();
        for number in std::iter::once(first).chain(changed).filter(is_static) {
            let held = self.held_in(context, contacts, steps, number);
            match held.judge() {
                Err(ModelError::FreeBodies(_)) if hold_free => {}
                Err(ModelError::FreeBodies(free)) if number > 0 => {
                    let step = steps.get(number).map(|step| step.name.clone());
                    let step = step.unwrap_or_default();
                    return Err(ModelError::FreeLater { step, free });
                }
                judged => {
                    for one in judged? {
                        if all.iter().all(|known| known.bodies != one.bodies) {
                            all.push(one);
                        }
                    }
                }
            }
        }
        Ok(all)
    }

    /// What holds the elements that take part in a step.
    fn held_in<'h>(
        &'h self,
        context: &'h Context<'_>,
        contacts: &contact::Steps<'_>,
        steps: &[Step],
        number: usize,
    ) -> Held<'h> {
        let activity = &context.activity;
        let mut held = Held::new(
            self.mesh,
            self.space,
            self.bodies,
            self.carriers,
            &context.elimination,
            &|cell| activity.is_active(cell, number),
        );
        held.springs(self.springs);
        held.constraints(self.constraints);
        for (at, contact) in self.contacts.iter().enumerate() {
            held.contact(contact, contacts.rubs(at), &context.poses);
        }
        if let Some(step) = steps.get(number) {
            held.supports(&context.layout, &step.prescriptions);
        }
        if number > 0 {
            held.judge_bodies_alone();
        }
        held
    }
}

/// Nodes of no body, given the body of each.
fn unused(body_of_node: &[u32]) -> Vec<NodeId> {
    let nodes = (0..).zip(body_of_node);
    let unused = nodes.filter(|(_, body)| **body == u32::MAX);
    unused.map(|(node, _)| node).collect()
}

/// The sides of all contacts, each with its first multiplier; the layout receives their multipliers.
fn all_sides(
    source: &Source<'_>,
    contacts: &contact::Steps<'_>,
    layout: &mut Layout,
) -> Result<Vec<(Sides, usize)>, ModelError> {
    let mut sides = Vec::new();
    for (number, variants) in contacts.variants.iter().enumerate() {
        for (variant, one) in variants.iter().enumerate() {
            for mut pass in source.sides(number, &one.part)? {
                pass.variant = variant;
                let first = layout.nmultiplier();
                let own = pass.nmultiplier(&one.part, contacts.rubs(number), layout.ndim());
                *layout = layout.with_multipliers(first + own);
                sides.push((pass, first));
            }
        }
    }
    let all: Vec<&Sides> = sides.iter().map(|(one, _)| one).collect();
    let holds = |one: &Sides| {
        let is_free = |part: &ContactPart| part.tie.is_none();
        contacts.rubs(one.contact) && contacts.parts.get(one.contact).is_some_and(is_free)
    };
    for (number, nodes) in contact::yields(source.bodies, source.reference, &all, &holds) {
        if let Some((one, _)) = sides.get_mut(number) {
            one.yield_at(nodes);
        }
    }
    Ok(sides)
}

/// What the solid cells are connected to; nothing where no contact asks.
fn connected(mesh: &Mesh, contacts: &[ContactPart]) -> Bodies {
    let cells: Vec<CellId> = match contacts {
        [] => Vec::new(),
        _ => mesh.cells(mesh.dim()).collect(),
    };
    Bodies::new(mesh, &cells)
}

impl Context<'_> {
    /// What damps motions: those that nothing but contact stops, where they are to be held, and all where there is contact.
    fn dampers(
        &self,
        bodies: &[BodyPart],
        held: Option<&[Unheld]>,
        is_without_contact: bool,
    ) -> impl Iterator<Item = Box<dyn Term>> + use<> {
        let holds = held.and_then(|held| self.holds(bodies, held));
        let brake = (!is_without_contact).then(|| self.brake(bodies));
        let dampers = [holds, brake].into_iter().flatten();
        let (layout, activity) = (self.layout, self.activity.clone());
        dampers.map(move |damper| {
            let damper = damper.without_idle(layout, activity.clone());
            Box::new(damper) as Box<dyn Term>
        })
    }

    /// Adds the interfaces of all contacts to the terms; returns what was chosen for each.
    fn interfaces(
        &self,
        sides: Vec<(Sides, usize)>,
        contacts: &contact::Steps<'_>,
        terms: &mut Vec<Box<dyn Term>>,
    ) -> Result<Vec<ContactSummary>, ModelError> {
        let mut summaries = Vec::new();
        for (pass, first) in sides {
            let Some(variant) = contacts.variant(pass.contact, pass.variant) else {
                continue;
            };
            let is_other = pass.swapped || pass.variant > 0;
            let (parts, summary) = self.contact(pass, variant, contacts, first)?;
            let interface = Interface::new(parts, self.layout, self.elimination.clone());
            terms.push(Box::new(interface));
            if !is_other {
                summaries.push(summary);
            }
        }
        Ok(summaries)
    }
}
