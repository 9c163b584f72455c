//! Solver, output, checkpoints, expectations.

use super::Name;
use crate::diagnostic::{Place, Spanned};

/// How equations are solved.
#[derive(Clone, Debug, PartialEq)]
pub struct Solver {
    /// The nonlinear equations of an increment.
    pub newton: Newton,
    /// The linear equations of an iteration.
    pub linear: Spanned<LinearChoice>,
    /// Whether a vanishing viscous force holds bodies that nothing else holds.
    pub stabilize: Stabilize,
    /// What becomes of motions that nothing resists.
    pub free_motions: FreeMotions,
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
    /// Largest residual force relative to the mean force.
    pub force_tol: f64,
    /// Largest penetration relative to the size of a facet.
    pub gap_tol: f64,
    /// Whether corrections are shortened.
    pub line_search: LineSearch,
    /// Which stress the geometric stiffness takes.
    pub stress: GeometricStress,
}

/// Which stress the geometric stiffness of bodies takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GeometricStress {
    /// The predicted one in shells, and in other thin bodies where no contact has friction; else the current one.
    #[default]
    Auto,
    /// The stress that the last correction predicted.
    Mixed,
    /// The stress of the iterate.
    Current,
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
    /// Multigrid over the bodies, where that suits.
    Multigrid,
    /// By that of the library MUMPS, which not every build has.
    Mumps,
    /// By multigrid of the library PETSc over the ranks of MPI, which not every build has.
    Petsc,
}

impl LinearChoice {
    /// Its word in a case, which is the solver's name.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Direct => "direct",
            Self::Multigrid => "multigrid",
            Self::Mumps => "mumps",
            Self::Petsc => "petsc",
        }
    }
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

/// What becomes of motions that neither supports nor stiffness resist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FreeMotions {
    /// They are an error.
    #[default]
    Refuse,
    /// Where no load acts on them, they are held, with a note; else they are an error.
    Hold,
}

/// What is tried when an increment does not converge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// A smaller increment.
    Cut,
    /// Damping.
    Stabilize,
    /// The whole case again, with Gauss points in contacts for which the program chose mortar.
    Points,
}

/// What is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Formats of results, as in `vtu`.
    pub format: Vec<Spanned<String>>,
    /// Fields, as in `displacement`.
    pub fields: Vec<Spanned<String>>,
    /// Whether contact pressures of quadratic triangles are smoothed.
    pub smooth_pressures: bool,
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
