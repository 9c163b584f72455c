//! What a run is asked to do, as plain structs that any reader fills.
//!
//! Numbers are in the units of the case; nothing is converted. Names refer to groups of the mesh or to sets of the
//! case. Values that later messages may point at remember where they were written ([`Spanned`]).

use crate::diagnostic::{Place, Spanned};

/// A name and where it was written.
pub type Name = Spanned<String>;

/// A whole case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Version of the case format.
    pub format: u32,
    /// What the run is about, for reports.
    pub title: String,
    /// The label of units, as in `mm-N-MPa`; empty where none is given.
    pub units: Spanned<String>,
    /// Codes of warnings that are silenced.
    pub allow: Vec<String>,
    /// Where nodes and elements come from.
    pub mesh: MeshSource,
    /// Dimension of the model.
    pub model: Model,
    /// Named sets of nodes and faces.
    pub sets: Vec<Set>,
    /// Named functions of time.
    pub amplitudes: Vec<Amplitude>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Which groups are solids or rigid tools.
    pub bodies: Vec<Body>,
    /// Pairs of surfaces that may touch.
    pub contacts: Vec<Contact>,
    /// What happens, in order.
    pub steps: Vec<Step>,
    /// How equations are solved.
    pub solver: Solver,
    /// What is written.
    pub output: Output,
    /// When a run can be resumed from.
    pub checkpoint: Checkpoint,
    /// Values that are checked at the end.
    pub expectations: Vec<Expectation>,
}

impl Case {
    /// The names a case with its mesh in place knows of itself: groups of elements, sets. A mesh file adds its own.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.sets.iter().map(|set| set.name.as_str()).collect();
        if let MeshSource::Inline { elements, .. } = &self.mesh {
            names.extend(
                elements
                    .iter()
                    .filter_map(|one| one.group.as_deref())
                    .map(String::as_str),
            );
        }
        names.sort_unstable();
        names.dedup();
        names
    }
}

/// Where nodes and elements come from.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshSource {
    /// A file, relative to the case.
    File {
        /// Its path.
        path: Spanned<String>,
    },
    /// The case itself.
    Inline {
        /// Number and position of each node; in the plane the third coordinate is zero.
        nodes: Vec<(u64, [f64; 3])>,
        /// The elements.
        elements: Vec<InlineElement>,
        /// Where the nodes were written.
        place: Place,
    },
}

/// An element written in the case.
#[derive(Clone, Debug, PartialEq)]
pub struct InlineElement {
    /// Its number.
    pub id: u64,
    /// The name of its type, as in `hex8`.
    pub element_type: Spanned<String>,
    /// The group it belongs to.
    pub group: Option<Spanned<String>>,
    /// The numbers of its nodes.
    pub nodes: Vec<u64>,
    /// Where it was written.
    pub place: Place,
}

/// Dimension of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Space or plane.
    pub space: Spanned<Space>,
    /// Thickness of a plane model (length); 1 in space.
    pub thickness: f64,
}

/// Space or plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Space {
    /// Three dimensions.
    #[default]
    ThreeD,
    /// Two dimensions without strain along the third.
    PlaneStrain,
}

/// A named set.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// Its name.
    pub name: Name,
    /// What is in it.
    pub content: SetContent,
    /// Where the content was written.
    pub place: Place,
}

/// What is in a set.
#[derive(Clone, Debug, PartialEq)]
pub enum SetContent {
    /// Nodes, by their numbers.
    Nodes(Vec<u64>),
    /// Faces, by the number of their element and a side of it.
    Faces(Vec<(u64, Side)>),
    /// Everything in other sets or groups.
    Union(Vec<Name>),
}

/// A side of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Side `S1`, `S2`, … in the numbering of Abaqus.
    Numbered(u8),
    /// The side whose outward normal lies along an axis.
    Axis(Axis, Sense),
}

/// An axis of the global frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// Along an axis or against it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// Along it.
    Plus,
    /// Against it.
    Minus,
}

/// A function of time: linear between its rows, constant outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Amplitude {
    /// Its name.
    pub name: Name,
    /// Rows of time and value; times increase.
    pub table: Vec<[f64; 2]>,
    /// Which time it depends on.
    pub time: TimeBase,
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

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: Name,
    /// Its law, as in `neo-hookean`.
    pub model: Spanned<String>,
    /// Young's modulus E > 0 (stress).
    pub young: Spanned<f64>,
    /// Poisson's ratio, −1 < nu < 0.5.
    pub poisson: Spanned<f64>,
    /// Density (mass per volume).
    pub density: Option<Spanned<f64>>,
}

/// Groups of elements that make one or more solids or rigid tools.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The groups.
    pub groups: Vec<Name>,
    /// The material; none for a rigid body.
    pub material: Option<Name>,
    /// Whether it moves as a whole.
    pub rigid: bool,
    /// Where it was written.
    pub place: Place,
}

/// A pair of surfaces that may touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Its name.
    pub name: Name,
    /// The side that carries the points.
    pub secondary: Name,
    /// The side that is projected onto.
    pub primary: Name,
    /// How the two sides are discretized.
    pub method: Spanned<Method>,
    /// How penetration is prevented.
    pub enforcement: Enforcement,
    /// Coulomb's coefficient of friction.
    pub friction: Spanned<f64>,
    /// How far from each other the sides are searched (length); none: found by the program.
    pub reach: Option<f64>,
    /// Whether it acts from the first step on.
    pub active: bool,
    /// Where it was written.
    pub place: Place,
}

/// How the two sides of a contact are discretized.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The program chooses.
    #[default]
    Auto,
    /// Nodes of the secondary side against segments of the primary side.
    NodeToSegment,
}

/// How penetration is prevented.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Enforcement {
    /// The program chooses.
    #[default]
    Auto,
    /// A pressure or force proportional to the penetration.
    Penalty {
        /// The factor; none: from the stiffness behind the surface.
        penalty: Option<Spanned<f64>>,
        /// Per node (force per length) or per area (stress per length); none: by what the secondary side is.
        per: Option<Per>,
    },
}

/// What a penalty refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// A node of the secondary side.
    Node,
    /// Its area.
    Area,
}

/// A stretch of time with its supports and loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Its name.
    pub name: Name,
    /// Whether displacements are small.
    pub geometry: Geometry,
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
    /// A set, group or rigid body.
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
    /// A set, group or rigid body.
    pub on: Name,
    /// Displacement along x, y, z (length) where prescribed.
    pub u: [Option<Motion>; 3],
    /// Rotation about x, y, z (radian) where prescribed.
    pub rot: [Option<Motion>; 3],
    /// Where it was written.
    pub place: Place,
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
    /// A set, group or rigid body.
    pub on: Name,
    /// Displacements set free.
    pub u: Directions,
    /// Rotations set free.
    pub rot: Directions,
    /// Where it was written.
    pub place: Place,
}

/// A load.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Its name: a later load of this name replaces it.
    pub name: Option<Name>,
    /// A set, group or rigid body.
    pub on: Name,
    /// What acts.
    pub kind: LoadKind,
    /// Where it was written.
    pub place: Place,
}

/// What acts.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadKind {
    /// A total force, spread over what it acts on.
    Force([f64; 3]),
    /// The same force at every node.
    PerNode([f64; 3]),
}

/// How equations are solved.
#[derive(Clone, Debug, PartialEq)]
pub struct Solver {
    /// The nonlinear equations of an increment.
    pub newton: Newton,
    /// The linear equations of an iteration.
    pub linear: LinearChoice,
    /// Whether a vanishing viscous force holds bodies that nothing else holds.
    pub stabilize: Stabilize,
    /// What is tried, in order, when an increment does not converge.
    pub on_trouble: Vec<Remedy>,
    /// The number of threads; none: as many as the machine has.
    pub threads: Option<u64>,
}

/// Newton's method.
#[derive(Clone, Debug, PartialEq)]
pub struct Newton {
    /// Iterations of an increment at most.
    pub max_iterations: u64,
    /// Largest residual force in parts of the mean force.
    pub force_tol: f64,
    /// Largest penetration in parts of the size of a facet.
    pub gap_tol: f64,
    /// Whether corrections are shortened.
    pub line_search: LineSearch,
}

/// Whether corrections are shortened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineSearch {
    /// Where it helps.
    #[default]
    Auto,
    /// Always tried.
    On,
    /// Never.
    Off,
}

/// How linear equations are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearChoice {
    /// The program chooses.
    #[default]
    Auto,
    /// By factorization.
    Direct,
}

/// Whether a vanishing viscous force holds bodies that nothing else holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stabilize {
    /// Where a body is held only by contact that is open.
    #[default]
    Auto,
    /// Never.
    Off,
}

/// What is tried when an increment does not converge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// A smaller increment.
    Cut,
    /// Damping.
    Stabilize,
}

/// What is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Formats of results, as in `vtu`.
    pub format: Vec<Spanned<String>>,
    /// Fields, as in `displacement`.
    pub fields: Vec<Spanned<String>>,
    /// How often.
    pub every: Every,
    /// Values over time.
    pub history: Vec<History>,
}

/// How often results are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// After so many increments.
    Increments(u64),
    /// After so much time.
    Time(f64),
}

/// Columns of `history.csv`.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// The first part of the column's name.
    pub name: Name,
    /// The quantities: the second part.
    pub quantities: Vec<Spanned<String>>,
    /// What they are taken from.
    pub source: HistorySource,
    /// Where it was written.
    pub place: Place,
}

/// What a history is taken from.
#[derive(Clone, Debug, PartialEq)]
pub enum HistorySource {
    /// A contact.
    Contact(Name),
    /// A reference point or rigid body.
    Reference(Name),
    /// A node, by its number.
    Node(Spanned<u64>),
    /// A set: the sum of forces, the mean of other quantities.
    Set(Name),
}

/// When checkpoints are written.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// After so many increments.
    pub increments: Option<u64>,
    /// After so many seconds on the clock.
    pub wall: Option<f64>,
    /// How many are kept.
    pub keep: u64,
}

/// A value that is checked at the end.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// A column of `history.csv`, or a field at a node or on a set.
    pub what: Spanned<String>,
    /// When.
    pub at: Moment,
    /// What it should be.
    pub value: f64,
    /// How far off it may be.
    pub tolerance: Tolerance,
    /// Where it was written.
    pub place: Place,
}

/// When a value is checked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Moment {
    /// At the end.
    #[default]
    End,
    /// In this data row of `history.csv`, counted from 1.
    Row(u64),
    /// At this total time.
    Time(f64),
}

/// How far off a value may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// In parts of the expected value.
    Relative(f64),
    /// In the unit of the value.
    Absolute(f64),
}
