//! Linear systems: from the operator in two parts to the change of every unknown, with a residual that was measured.
//!
//! ```text
//!   Problem (patterns, equations, signs) ──analyze──▶ order, symbolic factor        once per pattern
//!   Values  (bulk, interface)            ──factorize──▶ numeric factor              once per tangent
//!   right-hand side                      ──solve──▶ x, SolveReport                  residual = |b − A x| / |b|
//! ```
//!
//! A solver never hands back an answer that it has not checked: each solution is put into the operator as it was
//! assembled, in both its parts, and refined or refused. A matrix that is singular to round-off (a body that nothing
//! holds) is an error that names the equation which moves most in the free motion.
//!
//! Multipliers are condensed where they can be ([`Condensed`]): the factor is then one of displacements alone, and L Lᵀ
//! where the whole system is symmetric. What is left is solved as a saddle-point problem, as all of it is by
//! [`LinearKind::Saddle`].
//!
//! One more solver: a file with a struct that implements [`LinearSolver`], and a line in [`SOLVERS`].

mod cholesky;
mod condensation;
mod condensed;
mod direct;
mod forecast;
mod fronts;
mod gathered;
mod hosts;
mod lu;
mod matrix;
mod metis;
mod multigrid;
#[cfg(feature = "mumps")]
mod mumps;
mod operator;
mod ordering;
mod registers;
mod residual;
#[cfg(test)]
mod tests;

pub use condensed::Condensed;
pub use direct::Direct;
pub use forecast::{Factor, Forecast, Path};
pub use multigrid::Multigrid;
#[cfg(feature = "mumps")]
pub use mumps::Mumps;
pub use operator::{apply, apply_absolute};

use super::sparsity::{BlockPattern, NONE, Pattern};

/// What is known of the matrix; the more general comes later, so that `max` combines terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Symmetry {
    /// Symmetric, and positive definite in a stable state.
    Definite,
    /// Symmetric, with multipliers or otherwise indefinite.
    Symmetric,
    /// Values are not symmetric.
    Unsymmetric,
}

/// What a solver knows before it sees values.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The number of raw degrees of freedom.
    pub ndof: usize,
    /// The pattern of the bulk; it covers the first `nrow * block` raw degrees of freedom.
    pub bulk: &'a BlockPattern,
    /// The pattern of the interface.
    pub interface: &'a Pattern,
    /// The equation of each raw degree of freedom, [`NONE`] where it has none (prescribed, dependent, unused).
    pub equation: &'a [u32],
    /// The number of equations.
    pub nequation: usize,
    /// The most general symmetry of any term.
    pub symmetry: Symmetry,
    /// Per equation: +1 for a displacement, −1 for a multiplier.
    pub sign: &'a [i8],
    /// Where each node is.
    pub coordinates: &'a [[f64; 3]],
    /// The corners that a node of quadratic elements is halfway between, [`NONE`] where it is a corner itself; may be empty.
    pub between: &'a [[u32; 2]],
}

impl Problem<'_> {
    /// Checks that all parts fit together.
    ///
    /// # Errors
    /// `Shape` names the part that does not.
    pub fn check(&self) -> Result<(), LinearError> {
        let shape = |what, got: usize, wanted: usize| {
            if got == wanted {
                Ok(())
            } else {
                Err(LinearError::Shape { what, got, wanted })
            }
        };
        let below = |what, numbers: &[u32], end: usize, exempt: Option<u32>| {
            let outside = |number: &&u32| **number as usize >= end && Some(**number) != exempt;
            match numbers.iter().find(outside) {
                Some(&number) => Err(LinearError::Range {
                    what,
                    number: number as usize,
                    end,
                }),
                None => Ok(()),
            }
        };
        let rows = |what, row_start: &[usize], ncolumn: usize| {
            let rising = row_start.windows(2).all(|pair| pair[0] <= pair[1]);
            shape(what, row_start.last().copied().unwrap_or(0), ncolumn)?;
            shape(what, row_start.first().copied().unwrap_or(0), 0)?;
            if rising {
                Ok(())
            } else {
                Err(LinearError::Range {
                    what,
                    number: 0,
                    end: ncolumn,
                })
            }
        };
        let nbulk = self.bulk.nrow() * self.bulk.block;
        if !(1..=3).contains(&self.bulk.block) {
            return Err(LinearError::Range {
                what: "width of a block",
                number: self.bulk.block,
                end: 4,
            });
        }
        if nbulk > self.ndof {
            return Err(LinearError::Range {
                what: "bulk degrees of freedom",
                number: nbulk,
                end: self.ndof + 1,
            });
        }
        if self.interface.nrow > self.ndof {
            return Err(LinearError::Range {
                what: "interface rows",
                number: self.interface.nrow,
                end: self.ndof + 1,
            });
        }
        shape(
            "equations of degrees of freedom",
            self.equation.len(),
            self.ndof,
        )?;
        shape("signs", self.sign.len(), self.nequation)?;
        shape(
            "interface rows",
            self.interface.row_start.len(),
            self.interface.nrow + 1,
        )?;
        rows("bulk rows", &self.bulk.row_start, self.bulk.nblock())?;
        rows(
            "interface rows",
            &self.interface.row_start,
            self.interface.nentry(),
        )?;
        below("equation", self.equation, self.nequation, Some(NONE))?;
        below("bulk column", &self.bulk.column, self.bulk.nrow(), None)?;
        below("interface column", &self.interface.column, self.ndof, None)
    }
}

/// The values of the operator, in the order of the two patterns.
#[derive(Clone, Copy, Debug)]
pub struct Values<'a> {
    /// Block after block, each row-major.
    pub bulk: &'a [f64],
    /// Entry after entry.
    pub interface: &'a [f64],
}

/// The parts of a [`Problem`] that outlive the call, kept to measure residuals and to recognize the same problem.
#[derive(Clone, Debug)]
struct Kept {
    bulk: BlockPattern,
    interface: Pattern,
    equation: Vec<u32>,
    symmetry: Symmetry,
    sign: Vec<i8>,
    coordinates: Vec<[f64; 3]>,
    between: Vec<[u32; 2]>,
}

impl Kept {
    fn new(problem: &Problem) -> Self {
        Self {
            bulk: problem.bulk.clone(),
            interface: problem.interface.clone(),
            equation: problem.equation.to_vec(),
            symmetry: problem.symmetry,
            sign: problem.sign.to_vec(),
            coordinates: problem.coordinates.to_vec(),
            between: problem.between.to_vec(),
        }
    }

    fn is(&self, problem: &Problem) -> bool {
        self.symmetry == problem.symmetry
            && self.equation == problem.equation
            && self.sign == problem.sign
            && self.interface == *problem.interface
            && self.bulk == *problem.bulk
    }
}

/// What a solution is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// The true relative residual |b − A x| / |b| in the largest entry; 0 for b = 0.
    pub residual: f64,
    /// Applications of the factor or preconditioner.
    pub iterations: usize,
    /// How many of them were refinements.
    pub refinements: usize,
    /// Negative pivots of the factor, one per multiplier in a stable state; 0 where pivots have no sign (LU).
    pub negative_pivots: usize,
}

impl SolveReport {
    /// The same after iterations that led nowhere.
    const fn after(mut self, lost: usize) -> Self {
        self.iterations += lost;
        self
    }
}

/// The stiffness of the bodies at the start of a run.
#[derive(Clone, Debug)]
pub enum StartStiffness {
    /// It is that of all states.
    Always,
    /// It is that of the next values.
    Next,
    /// These values of the bulk.
    Values(Vec<f64>),
}

/// What a solver leaves to the one that goes on in its place.
pub struct Heritage(Box<multigrid::Grid>);

/// A way to solve linear systems; see the room's page for the order of calls.
pub trait LinearSolver: Send {
    /// Takes note of the pattern. Cheap where the problem is the same as in the last call.
    ///
    /// # Errors
    /// `Shape` and `Range` for parts that do not fit together, `TooLarge`.
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError>;

    /// Takes the values of a tangent.
    ///
    /// # Errors
    /// `Singular`, `NotFinite`, `TooLarge`, `Shape`, and `Order` before `analyze`.
    fn factorize(&mut self, values: &Values) -> Result<(), LinearError>;

    /// Forgets what it has learned from other patterns and values, but for a factor and its
    /// [experience](LinearSolver::experience): from now on it does what it would do had it just been given the pattern. A run
    /// that is resumed here repeats every bit.
    fn forget(&mut self) {}

    /// Whether it asks for the stiffness of the bodies at the start of the run before the next values: for `which` one,
    /// where there are several.
    fn wants_start(&self, _which: u64) -> bool {
        false
    }

    /// Receives that stiffness: of the bodies undeformed and without history.
    fn start_from(&mut self, _which: u64, _bulk: StartStiffness) {}

    /// What it has that depends on the problem and its values alone, not on what was solved before: for a solver that goes
    /// on in its place as if it were new. Nothing unless said.
    fn bequeath(&mut self) -> Option<Heritage> {
        None
    }

    /// Takes over what another one has left, where it can be of use.
    fn inherit(&mut self, _heritage: Heritage) {}

    /// Solves `A x = rhs` until the true relative residual is at most `rtol`, or at the round-off of the operator.
    ///
    /// The values may be newer than those of the factor, which then serves as a preconditioner for a few refinements.
    ///
    /// # Shapes
    /// `rhs` and `x` have one entry per equation.
    ///
    /// # Errors
    /// `Inaccurate` where the residual stays above, `NotFinite`, `Shape`, and `Order` before `factorize`. `x` then
    /// holds nothing of use.
    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError>;

    /// What it has learned that stays when it forgets; a number to give to [`LinearSolver::recall`].
    fn experience(&self) -> u8 {
        0
    }

    /// Takes over what a solver had learned in the run that is resumed.
    fn recall(&mut self, _experience: u8) {}

    /// What the solver has decided since it was asked last.
    fn notes(&mut self) -> Vec<Note> {
        Vec::new()
    }

    /// Whether less accuracy is less work.
    fn is_iterative(&self) -> bool {
        false
    }

    /// Solves until about this part of the error is left, in a norm of the solver's own: enough for a step of Newton's
    /// method that will not be the last. It need not go on where no entry of the residual is larger than `enough`, but for
    /// equations of multipliers. What is not iterative solves as exactly as it can.
    ///
    /// # Errors
    /// Those of [`LinearSolver::solve`].
    fn solve_roughly(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        part: f64,
        enough: f64,
    ) -> Result<SolveReport, LinearError> {
        let _ = (part, enough);
        self.solve(values, rhs, x, EXACT)
    }
}

/// What a solver has decided for itself.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Note {
    /// Multigrid has made a hierarchy.
    #[error("multigrid: {levels} levels over {unknowns} unknowns{}",
        .worn.map(|[now, before]| format!(
            ", made anew: {now:.1} iterations to a power of ten were {before:.1} when the last one was new"
        )).unwrap_or_default())]
    Hierarchy {
        /// Unknowns of the finest level.
        unknowns: usize,
        /// Levels, the last of which is solved directly.
        levels: usize,
        /// Iterations to a power of ten with the one before, at last and at first, where it was worn.
        worn: Option<[f64; 2]>,
    },
    /// A factor of the stiffness of the bodies takes the place of their hierarchy until the run ends.
    #[error(
        "the stiffness of the bodies is factorized in place of multigrid, {numbers} numbers: {why}"
    )]
    Factor {
        /// Numbers in the factor.
        numbers: usize,
        /// Why.
        why: Why,
    },
    /// The direct solver takes over until the increment ends.
    #[error("multigrid gives way to the direct solver: {why}")]
    Direct {
        /// Why.
        why: Why,
    },
}

/// Why multigrid does not serve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Why {
    /// The stiffness of the bodies has no incomplete factor, even with more on its diagonal: it is not positive definite, or that
    /// of nearly incompressible bodies.
    #[error(
        "the stiffness of the bodies has no incomplete factor, as of nearly incompressible ones"
    )]
    NotPositive,
    /// The equations of the interface have no solution of their own.
    #[error("the equations around the interface are singular by themselves")]
    Interface,
    /// Too many iterations.
    #[error("{iterations} iterations did not suffice")]
    Slow {
        /// How many were made.
        iterations: usize,
    },
    /// Conjugate gradients met a direction without stiffness.
    #[error("the tangent is not positive definite")]
    Indefinite,
}

/// A relative residual far below what Newton's tail needs.
pub const EXACT: f64 = 1e-10;

/// Why a linear system was not solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// A motion costs no force: the matrix is singular to round-off.
    #[error("the linear system is singular{}: something can move freely; hold every body, or close its contact",
        .equation.map(|e| format!(", most of all in equation {e}")).unwrap_or_default())]
    Singular {
        /// The equation that moves most, or whose row is zero; `None` where it cannot be determined.
        equation: Option<usize>,
    },
    /// A number in the matrix, the right-hand side or the solution is infinite or not a number.
    #[error(
        "the linear system holds a number that is not finite: look for inverted elements or overflowing laws"
    )]
    NotFinite,
    /// The solution does not satisfy the system.
    #[error(
        "the residual of the linear system stays at {residual:e} where {wanted:e} was asked: \
        look for stiffnesses that differ by many powers of ten, or ask for less"
    )]
    Inaccurate {
        /// The relative residual that was reached.
        residual: f64,
        /// The one that was asked for.
        wanted: f64,
    },
    /// The factor does not fit into memory or into its index.
    #[error(
        "the system of {nequation} equations ({nentry} entries) is too large for a direct solver: use fewer"
    )]
    TooLarge {
        /// The number of equations.
        nequation: usize,
        /// The entries of the matrix or of the factor where known, else those seen so far.
        nentry: usize,
    },
    /// A list has the wrong length.
    #[error("linear system: {got} {what} where {wanted} belong")]
    Shape {
        /// What the list holds.
        what: &'static str,
        /// Its length.
        got: usize,
        /// The length it should have.
        wanted: usize,
    },
    /// A number points outside what it numbers.
    #[error("linear system: {what} {number} is not below {end}")]
    Range {
        /// What is numbered.
        what: &'static str,
        /// The number.
        number: usize,
        /// The first number outside.
        end: usize,
    },
    /// A foreign library gives up for a reason of its own.
    #[error(
        "{name} gives up with code {code}, {detail}: its manual tells what they mean; \
        the solver \"direct\" does without it"
    )]
    Library {
        /// The library.
        name: &'static str,
        /// Its code.
        code: i32,
        /// What it says about the code.
        detail: i32,
    },
    /// A call came before the one that it depends on.
    #[error("linear solver: call {before} first")]
    Order {
        /// The call that is missing.
        before: &'static str,
    },
}

/// Which solver to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearKind {
    /// The one that suits the problem: multigrid in space, from 8,000 equations on, or 1,500 where the matrix is not
    /// definite; the direct one else.
    #[default]
    Auto,
    /// A sparse factorization, with multipliers condensed where they can be.
    Direct,
    /// A sparse factorization with all multipliers.
    Saddle,
    /// Multigrid over the bodies, with a sparse factorization at the interface.
    Multigrid,
    /// That of the library MUMPS.
    #[cfg(feature = "mumps")]
    Mumps,
}

/// A line of the table of solvers.
#[derive(Clone, Copy, Debug)]
pub struct SolverEntry {
    /// Which kind it answers to.
    pub kind: LinearKind,
    /// Its name in a case.
    pub name: &'static str,
    /// Makes one.
    pub build: fn() -> Box<dyn LinearSolver>,
}

/// Equations from which on multigrid is no slower than a direct solution in space: by Cholesky's factor where the matrix is
/// definite, by L D Lᵀ or LU where it is not. Of the latter, the ten families of `scripts/speed_decks.py` with seeds 3 and 4
/// take 1.30, 1.30 and 1.37 times the processor seconds with `solver.linear = "direct"`, in geometric mean, at 1,500, 2,200 and
/// 3,000 unknowns; slabs take 0.44 to 1.1 times, plates 0.7 to 1.6, and gears, plasticity and quadratic elements 1.5 to 2.5.
const MULTIGRID_FROM: [usize; 2] = [8_000, 1_500];

/// The table of solvers.
pub const SOLVERS: &[SolverEntry] = &[
    SolverEntry {
        kind: LinearKind::Auto,
        name: "auto",
        build: || Box::new(Multigrid::from_sizes(MULTIGRID_FROM)),
    },
    SolverEntry {
        kind: LinearKind::Direct,
        name: "direct",
        build: || Box::new(Condensed::new(Direct::reproducible)),
    },
    SolverEntry {
        kind: LinearKind::Saddle,
        name: "saddle",
        build: || Box::new(Direct::reproducible()),
    },
    SolverEntry {
        kind: LinearKind::Multigrid,
        name: "multigrid",
        build: || Box::new(Multigrid::new()),
    },
    #[cfg(feature = "mumps")]
    SolverEntry {
        kind: LinearKind::Mumps,
        name: "mumps",
        build: || Box::new(Mumps::new()),
    },
];

/// Makes a solver of the given kind.
pub fn choose(kind: LinearKind) -> Box<dyn LinearSolver> {
    let entry = SOLVERS.iter().find(|entry| entry.kind == kind);
    entry.map_or_else(
        || Box::new(Condensed::new(Direct::reproducible)) as Box<dyn LinearSolver>,
        |entry| (entry.build)(),
    )
}

/// The largest absolute value; NaN where there is one.
fn largest(values: &[f64]) -> f64 {
    // several at a time, which do not wait for one another
    let (chunks, rest) = values.as_chunks::<8>();
    let (mut most, mut strange) = ([0.0f64; 8], [false; 8]);
    for chunk in chunks {
        for ((most, strange), v) in most.iter_mut().zip(&mut strange).zip(chunk) {
            *most = most.max(v.abs());
            *strange |= v.is_nan();
        }
    }
    let is_strange = strange.contains(&true) || rest.iter().any(|v| v.is_nan());
    let all = most.iter().chain(rest);
    let most = all.fold(0.0, |most: f64, v| most.max(v.abs()));
    if is_strange { f64::NAN } else { most }
}
