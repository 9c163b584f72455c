//! What a solution costs, estimated from the pattern alone.

use crate::condensation::Condensation;
use crate::direct::{Factor, NUMBER, PATTERN};
use crate::error::LinearError;
use crate::multigrid;
use crate::multigrid::MULTIGRID_FROM;
use crate::problem::{Kept, Problem};
use crate::table::LinearKind;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use std::time::Instant;

/// The size of a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Equations.
    pub nequation: usize,
    /// Numbers in the operator as it is assembled, and in the interface where multipliers are condensed.
    pub noperator: usize,
    /// The way that is tried first.
    pub path: Path,
    /// What takes over where multigrid does not serve; nothing where that is not tried, or from `LARGEST` equations on.
    pub fallback: Option<Factor>,
}

/// How a system is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path {
    /// By a factor.
    Direct(Factor),
    /// By multigrid over so many numbers of the stiffness of the bodies, and a factor around the interface.
    Multigrid {
        /// Numbers.
        nbulk: usize,
        /// The factor of the equations at which the interface has a place.
        block: Factor,
    },
    /// By PETSc's multigrid over ranks that divide so many numbers of the stiffness of the bodies; each has the factor around
    /// the interface.
    Ranks {
        /// How many ranks.
        nrank: usize,
        /// Numbers.
        nbulk: usize,
        /// The factor of the equations at which the interface has a place.
        block: Factor,
    },
}

/// Equations from which on a fallback is not foreseen: its order would take longer than a check may.
pub const LARGEST: usize = 300_000;

impl Forecast {
    /// Orders and analyzes a problem, as its solution by a solver of this kind would.
    ///
    /// # Errors
    /// Those of [`crate::LinearSolver::analyze`].
    ///
    /// # Limits
    /// Whether multigrid serves is seen only when it is tried. The block at the interface is taken with all equations where
    /// something may touch.
    pub fn new(problem: &Problem, kind: LinearKind) -> Result<Self, LinearError> {
        problem.check()?;
        let least = match kind {
            LinearKind::Auto => Some(MULTIGRID_FROM),
            LinearKind::Multigrid => Some([0; 2]),
            _ => None,
        };
        let kept = Kept::new(problem);
        let mut noperator = problem.bulk.nvalue() + problem.interface.nentry();
        let nequation = problem.nequation;
        let divides = problem.fields.is_empty() && multigrid::suits(problem, [0; 2]);
        if let Some(nrank) = ranks(kind).filter(|_| divides) {
            let path = Path::Ranks {
                nrank,
                nbulk: problem.bulk.nvalue(),
                block: multigrid::size_of_block(&kept)?,
            };
            return Ok(Self {
                nequation,
                noperator,
                path,
                fallback: None,
            });
        }
        if least.is_some_and(|least| multigrid::suits(problem, least)) {
            let path = Path::Multigrid {
                nbulk: problem.bulk.nvalue(),
                block: multigrid::size_of_block(&kept)?,
            };
            let fallback = (nequation < LARGEST).then(|| Factor::of_bodies(&kept));
            return Ok(Self {
                nequation,
                noperator,
                path,
                fallback: fallback.transpose()?,
            });
        }
        let factor = match &Condensation::by_pattern(&kept) {
            Some(condensation) => {
                let condensed = condensation.problem(&kept);
                noperator += condensed.interface.nentry();
                Factor::of(&condensed)?
            }
            None => Factor::of(problem)?,
        };
        Ok(Self {
            nequation,
            noperator,
            path: Path::Direct(factor),
            fallback: None,
        })
    }

    /// Seconds of a factorization on this machine, measured on a small dense product; with multigrid, of its cycles in an
    /// iteration of Newton's method, about, where each rank has a core.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        match self.path {
            Path::Direct(factor) => factor.work / (rate() * EFFICIENCY),
            Path::Multigrid { nbulk, block } => {
                SECONDS_PER_NUMBER * nbulk as f64 + block.work / (rate() * EFFICIENCY)
            }
            Path::Ranks {
                nrank,
                nbulk,
                block,
            } => {
                let own = nbulk as f64 / nrank.max(1) as f64;
                SECONDS_OF_PETSC * own + block.work / (rate() * EFFICIENCY)
            }
        }
    }

    /// The same where multigrid does not serve.
    #[must_use]
    pub fn seconds_of_fallback(&self) -> Option<f64> {
        let Path::Multigrid { block, .. } = self.path else {
            return None;
        };
        let work = |fallback: Factor| fallback.work + block.work;
        self.fallback.map(|f| work(f) / (rate() * EFFICIENCY))
    }

    /// The ranks that each have their part of the work and of the memory; 1 where each has all.
    #[must_use]
    pub const fn nrank(&self) -> usize {
        match self.path {
            Path::Ranks { nrank, .. } => nrank,
            _ => 1,
        }
    }

    /// Bytes of the operator, its patterns, the matrices and the factors at the time when all of them are there.
    #[must_use]
    pub fn bytes(&self) -> f64 {
        match self.path {
            Path::Direct(factor) => self.bytes_of_operator() + factor.bytes(NUMBER),
            Path::Multigrid { nbulk, block } => {
                BYTES_PER_NUMBER * nbulk as f64 + bytes_of_block(block)
            }
            Path::Ranks {
                nrank,
                nbulk,
                block,
            } => BYTES_OF_PETSC * nbulk as f64 / nrank.max(1) as f64 + bytes_of_block(block),
        }
    }

    /// The same where multigrid does not serve.
    #[must_use]
    pub fn bytes_of_fallback(&self) -> Option<f64> {
        let Path::Multigrid { block, .. } = self.path else {
            return None;
        };
        let fallback = self.fallback?;
        let factor =
            BYTES_PER_COEFFICIENT * fallback.nmatrix as f64 + NUMBER * fallback.nfactor as f64;
        Some(self.bytes_of_operator() + bytes_of_block(block) + factor)
    }

    fn bytes_of_operator(&self) -> f64 {
        // patterns are kept twice
        (NUMBER + PATTERN) * self.noperator as f64
    }
}

/// The ranks among which a solver of this kind divides the bodies; none where it does not.
fn ranks(kind: LinearKind) -> Option<usize> {
    let size = signorini_ranks::together().size();
    match kind {
        #[cfg(feature = "mpi")]
        LinearKind::Petsc => Some(size),
        LinearKind::Auto => Some(size).filter(|&size| size > 1),
        _ => None,
    }
}

/// Bytes of the block at the interface: its matrix with everything that is made of it, and its factor in single precision.
fn bytes_of_block(block: Factor) -> f64 {
    BYTES_PER_ENTRY * block.nmatrix as f64 + 0.5 * NUMBER * block.nfactor as f64
}

/// What a number of the stiffness of bodies costs multigrid, with everything that is made of it: measured on hex8 from
/// 40,000 to 300,000 unknowns, `docs/speed.md`.
const BYTES_PER_NUMBER: f64 = 40.0;
const SECONDS_PER_NUMBER: f64 = 2e-8;
/// What it costs PETSc, hierarchies and factors included, and the seconds of a solution: measured on hex8 with 17,000 to
/// 140,000 unknowns.
const BYTES_OF_PETSC: f64 = 200.0;
const SECONDS_OF_PETSC: f64 = 6e-7;
/// What a number of one triangle of the matrix of a factor of the bodies costs: blocks, the pattern of both triangles, twice, and
/// the equilibrated matrix.
const BYTES_PER_COEFFICIENT: f64 = 64.0;
/// What a number of the block costs, its factor apart: measured, 60 to 86 with 3 to 16 million of them.
const BYTES_PER_ENTRY: f64 = 75.0;

/// What a sparse factorization reaches of the speed of a dense product.
const EFFICIENCY: f64 = 0.6;

/// Multiplications and additions per second of a dense product on one thread.
fn rate() -> f64 {
    const SIZE: usize = 256;
    let a = Mat::from_fn(SIZE, SIZE, |i, j| 1.0 / (1 + i + j) as f64);
    let mut product = Mat::zeros(SIZE, SIZE);
    let best = (0..4).map(|_| {
        let clock = Instant::now();
        matmul(&mut product, Accum::Replace, &a, &a, 1.0, Par::Seq);
        clock.elapsed().as_secs_f64()
    });
    let best = best.fold(f64::INFINITY, f64::min);
    (SIZE * SIZE * SIZE) as f64 / best.max(1e-9)
}
