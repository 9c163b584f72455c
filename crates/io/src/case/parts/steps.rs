//! Amplitudes and steps.

use super::{Axis, ContactChange, Name};
use crate::diagnostic::{Place, Spanned};
use signorini_geometry::mesh::NodeId;
use signorini_vocabulary::Chosen;
use std::path::PathBuf;

/// A function of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Amplitude {
    /// Its name.
    pub name: Name,
    /// Its value at a time.
    pub factor: Factor,
    /// Which time it depends on.
    pub time: TimeBase,
}

/// The value of a function of time.
#[derive(Clone, Debug, PartialEq)]
pub enum Factor {
    /// Rows of time and value, whose times increase: linear between them, constant outside.
    Table(Vec<[f64; 2]>),
    /// A function of the program that runs the case, by its name there.
    Own(Name),
}

/// Which time a function depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeBase {
    /// Time since the beginning of the step.
    #[default]
    Step,
    /// Time since the beginning of the run.
    Total,
}

/// A stretch of time with its supports and loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Its name.
    pub name: Name,
    /// Whether displacements are small.
    pub geometry: Geometry,
    /// What it does with temperatures, where they are unknown.
    pub thermal: Option<Thermal>,
    /// How it goes through time, where inertia counts.
    pub dynamics: Option<Dynamics>,
    /// Which natural frequencies it finds; it then changes nothing but supports.
    pub frequency: Option<Frequency>,
    /// How long it takes (time of the user's choice).
    pub duration: f64,
    /// How it is cut into increments.
    pub increments: Increments,
    /// Supports at the present position.
    pub fixes: Vec<Fix>,
    /// Prescribed motions.
    pub moves: Vec<Move>,
    /// Supports and motions of earlier steps that end.
    pub frees: Vec<Free>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Changes of contacts.
    pub contacts: Vec<ContactChange>,
    /// Bodies that are made of another material from now on.
    pub materials: Vec<MaterialChange>,
    /// Elements that take part again.
    pub activations: Vec<Activation>,
    /// Elements that take no part any longer.
    pub deactivations: Vec<Deactivation>,
    /// Temperatures.
    pub temperatures: Vec<Temperature>,
    /// Printed tables; none: those of the step before.
    pub prints: Option<Vec<Print>>,
    /// Where it was written.
    pub place: Place,
}

/// What a step does with unknown temperatures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Thermal {
    /// Whether bodies deform, too.
    pub coupled: bool,
    /// Whether they store heat.
    pub transient: bool,
}

/// Constants of nature, in the units of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constants {
    /// Heat per time and area of a black surface over its absolute temperature to the fourth power.
    pub stefan_boltzmann: f64,
    /// Absolute zero, on the scale of temperatures.
    pub absolute_zero: f64,
}

/// How a step with inertia goes through time.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamics {
    /// The numbers of the method.
    pub method: DynamicMethod,
    /// Whether elements that touch a side of a contact give their mass to nodes off it.
    pub redistributed: Spanned<bool>,
    /// Whether the forces of contacts without multipliers are weighted with those before.
    pub weighted: bool,
    /// The local error that increments which adapt may have, over the largest displacement so far; 0: any.
    pub error_tol: f64,
    /// The longest of these in which contact closes or opens, over the time that a wave takes through an element; 0: any.
    pub impact_step: f64,
}

/// The local error that increments have unless a case says otherwise.
pub const ERROR_TOL: f64 = 1e-3;
/// How long they are at most in an impact, likewise.
pub const IMPACT_STEP: f64 = 1.5;

/// Which natural frequencies a step finds.
#[derive(Clone, Debug, PartialEq)]
pub struct Frequency {
    /// How many, at most.
    pub modes: u64,
    /// The frequency above which they begin (cycles per time).
    pub lower: Option<f64>,
    /// The frequency at which they end (cycles per time).
    pub upper: Option<f64>,
}

/// A method to go through time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DynamicMethod {
    /// The generalized-α method, with the spectral radius of the highest frequencies.
    GeneralizedAlpha(f64),
    /// The method of Hilber, Hughes and Taylor, with its α.
    HilberHughesTaylor(f64),
    /// The method that conserves energy and momenta.
    EnergyMomentum,
    /// Central differences: the part of the longest stable increment that is taken, and the mass that is added.
    Explicit {
        /// The part that is taken.
        safety: f64,
        /// The mass that is added.
        scaling: Option<MassScaling>,
    },
}

/// Mass that is added to elements that would need short increments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassScaling {
    /// The shortest increment that is wanted.
    pub step: f64,
    /// The mass that may be added, over that of all bodies.
    pub limit: f64,
}

/// The part of the longest stable increment that explicit steps take unless a case says otherwise.
pub const SAFETY: f64 = 0.9;
/// The mass that may be added in these, likewise.
pub const SCALING_LIMIT: f64 = 0.05;

impl Step {
    /// A step in which nothing changes: one increment of the duration 1.
    #[must_use]
    pub fn of_nothing(name: Name, place: Place) -> Self {
        Self {
            name,
            geometry: Geometry::Auto,
            thermal: None,
            dynamics: None,
            frequency: None,
            duration: 1.0,
            increments: Increments::Count(1),
            fixes: Vec::new(),
            moves: Vec::new(),
            frees: Vec::new(),
            loads: Vec::new(),
            contacts: Vec::new(),
            materials: Vec::new(),
            activations: Vec::new(),
            deactivations: Vec::new(),
            temperatures: Vec::new(),
            prints: None,
            place,
        }
    }
}

/// A body that is made of another material from a step on.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialChange {
    /// Its group.
    pub group: Name,
    /// The material.
    pub material: Name,
    /// Where it was written.
    pub place: Place,
}

/// Elements that take part again from a step on.
#[derive(Clone, Debug, PartialEq)]
pub struct Activation {
    /// Their group or set.
    pub group: Name,
    /// What becomes of their strain.
    pub strain: StrainAt,
    /// Where it was written.
    pub place: Place,
}

/// The strain of elements that take part again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StrainAt {
    /// They have none where they are, and no history.
    #[default]
    Free,
    /// That which they have.
    Keep,
}

/// Elements that take no part from a step on.
#[derive(Clone, Debug, PartialEq)]
pub struct Deactivation {
    /// Their group or set.
    pub group: Name,
    /// Whether what they exert falls to zero over the step.
    pub ramp: bool,
    /// Where it was written.
    pub place: Place,
}

/// Whether displacements are small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Geometry {
    /// As in the step before; nonlinear in the first one.
    #[default]
    Auto,
    /// Small displacements and rotations.
    Linear,
    /// Displacements and rotations of any size.
    Nonlinear,
}

/// How a step is cut into increments.
#[derive(Clone, Debug, PartialEq)]
pub enum Increments {
    /// As many equal ones, which may be cut where they do not converge.
    Count(u64),
    /// Exactly as many equal ones.
    Fixed(u64),
    /// Adapted to the course of the solution; all in the time of the step.
    Adaptive {
        /// The first increment.
        initial: f64,
        /// The smallest one.
        min: f64,
        /// The largest one.
        max: f64,
        /// How many there may be.
        count_max: u64,
    },
}

/// Directions in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Directions {
    /// Along or about x, y, z.
    pub xyz: [bool; 3],
}

impl Directions {
    /// All three.
    pub const ALL: Self = Self { xyz: [true; 3] };

    /// Whether there is none.
    pub fn is_empty(self) -> bool {
        self.xyz == [false; 3]
    }
}

/// A support that keeps the present position.
#[derive(Clone, Debug, PartialEq)]
pub struct Fix {
    /// A set, group, reference or rigid body.
    pub on: Name,
    /// Displacements held.
    pub u: Directions,
    /// Rotations held.
    pub rot: Directions,
    /// Where it was written.
    pub place: Place,
}

/// A prescribed motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// A set, group, reference or rigid body.
    pub on: Name,
    /// Displacement along x, y, z (length) where prescribed.
    pub u: [Option<Motion>; 3],
    /// Rotation about x, y, z (radian) where prescribed.
    pub rot: [Option<Motion>; 3],
    /// The results of another model that the displacements are taken from; then nothing else is prescribed.
    pub from: Option<GlobalModel>,
    /// Where it was written.
    pub place: Place,
}

/// Displacements of another model: at each node those at its place there.
#[derive(Clone, Debug, PartialEq)]
pub struct GlobalModel {
    /// Its results, relative to the case: a `.frd`, `.vtu` or `.pvd` file, or a folder of results.
    pub file: Spanned<PathBuf>,
    /// Of which time.
    pub at: GlobalTime,
    /// Numbers of the elements of it that count; empty: all.
    pub elements: Vec<u64>,
    /// Displacements prescribed.
    pub u: Directions,
    /// Whether they are reached linearly over the step.
    pub ramp: bool,
    /// The displacement of each node, once the results have been read.
    pub values: Option<Vec<(NodeId, [f64; 3])>>,
}

/// A time of another model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GlobalTime {
    /// The end of the step of this number.
    Step(u64),
    /// That of this displacement field, counted from 1 in the order of the results.
    Set(u64),
}

/// The course of one prescribed component.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Reaches this value linearly over the step.
    Ramp(f64),
    /// Rows of time of the step and value.
    Table(Vec<[f64; 2]>),
    /// A value times a named function of time.
    Amplitude {
        /// The name of the amplitude.
        name: Name,
        /// The factor.
        value: f64,
    },
}

/// Takes back supports and motions of earlier steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// A set, group, reference or rigid body.
    pub on: Name,
    /// Displacements set free.
    pub u: Directions,
    /// Rotations set free.
    pub rot: Directions,
    /// Whether temperatures that earlier steps gave are set free, too.
    pub temperature: bool,
    /// Where it was written.
    pub place: Place,
}

/// A load.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Its name: a later load of this name replaces it.
    pub name: Option<Name>,
    /// A set, group, reference or rigid body.
    pub on: Name,
    /// What acts, by its name in the vocabulary.
    pub kind: Chosen,
    /// Where what acts was written.
    pub what: Place,
    /// Whether it turns with the surface; none: as its kind has it.
    pub follows: Option<Spanned<bool>>,
    /// The direction in which what it acts on keeps one common displacement.
    pub coupling: Option<Spanned<Axis>>,
    /// How it goes over time.
    pub course: Course,
    /// Where it was written.
    pub place: Place,
}

/// How a load goes over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Course {
    /// Linearly over the step, from what it was before to its full size.
    #[default]
    Ramp,
    /// Its full size times the second number of rows of time of the step and factor.
    Table(Vec<[f64; 2]>),
    /// Its full size times a named function of time.
    Amplitude(Name),
}

/// Prescribed temperatures.
#[derive(Clone, Debug, PartialEq)]
pub struct Temperature {
    /// A set or group; `all` is everything.
    pub on: Name,
    /// Their course over the step.
    pub value: Motion,
    /// Of shells: change of temperature per length along their normal, with the same course; none: 0.
    pub gradient: Option<Spanned<f64>>,
    /// Where it was written.
    pub place: Place,
}

/// Tables of results that are printed during a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Print {
    /// A set or group of nodes or elements, or a contact; none: every contact.
    pub on: Option<Name>,
    /// What the quantities belong to.
    pub of: PrintOf,
    /// The quantities, a table each, by the words of the vocabulary.
    pub quantities: Vec<Spanned<String>>,
    /// Whether sums follow.
    pub totals: Totals,
    /// Whether vectors at nodes are printed along the local axes that these have, and tensors at integration points along
    /// the axes of the material.
    pub local: bool,
    /// After how many increments; the end of the step is always printed.
    pub every: u64,
    /// Where it was written.
    pub place: Place,
}

/// What printed quantities belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrintOf {
    /// Nodes: `displacement`, `reaction`, `temperature`.
    Nodes,
    /// Elements: `stress`, `strain`, `mechanical-strain`, `plastic-strain` and `energy-density` at integration points;
    /// `energy` and `volume` of each.
    Elements,
    /// Contact: `gap`, `traction` and `energy` at the points of the secondary side, the `count` of closed ones;
    /// `force`, `normal-force`, `shear-force` of a whole contact.
    Contact,
    /// Faces, inside a body or around it: the `force` of stresses on all of them.
    Faces,
}

impl PrintOf {
    /// Its key in a case.
    pub fn key(self) -> &'static str {
        match self {
            Self::Nodes => "nodes",
            Self::Elements => "elements",
            Self::Contact => "contact",
            Self::Faces => "faces",
        }
    }
}

/// Whether sums over a set are printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Totals {
    /// Only the table.
    #[default]
    No,
    /// The table, then the sums.
    Yes,
    /// Only the sums.
    Only,
}

/// Steps that come again and again.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    /// Their names.
    pub steps: Vec<Name>,
    /// How many cycles there are.
    pub count: u64,
    /// What lets one stand for many; none: each is solved.
    pub jump: Option<Jump>,
    /// Where it was written.
    pub place: Place,
}

/// For how many cycles one stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// What may go wrong in one of them, over the depth.
    pub tol: f64,
    /// For how many the first stands.
    pub first: u64,
    /// The largest depth that one may take off (length); none: any.
    pub max_wear: Option<f64>,
}
