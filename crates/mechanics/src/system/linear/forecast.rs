//! What a solution costs, told from the pattern alone.

use super::condensation::Condensation;
use super::matrix::Matrix;
use super::ordering::{self, Ordering};
use super::{
    Kept, LinearError, LinearKind, MULTIGRID_FROM, Problem, Symmetry, cholesky, multigrid,
};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use std::time::Instant;

/// The size of a solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forecast {
    /// Equations.
    pub nequation: usize,
    /// Numbers in the operator as it is assembled, and in the interface where multipliers are condensed.
    pub noperator: usize,
    /// Numbers in the matrix that is factorized: one triangle of it where it is symmetric.
    pub nmatrix: usize,
    /// Numbers in its factor.
    pub nfactor: usize,
    /// Multiplications and additions of a factorization.
    pub work: f64,
    /// Whether there is no factor, but multigrid.
    pub is_multigrid: bool,
}

impl Forecast {
    /// Orders and analyzes a problem, as its solution by a solver of this kind would.
    ///
    /// # Errors
    /// Those of [`super::LinearSolver::analyze`].
    ///
    /// # Limits
    /// `None` for the factor of a matrix that is not symmetric: its order depends on its values. That multigrid will serve
    /// is taken for granted.
    pub fn new(problem: &Problem, kind: LinearKind) -> Result<Option<Self>, LinearError> {
        problem.check()?;
        let least = match kind {
            LinearKind::Auto => Some(MULTIGRID_FROM),
            LinearKind::Multigrid => Some([0; 2]),
            _ => None,
        };
        if least.is_some_and(|least| multigrid::suits(problem, least)) {
            return Ok(Some(Self {
                nequation: problem.nequation,
                noperator: problem.bulk.nvalue() + problem.interface.nentry(),
                nmatrix: problem.bulk.nvalue(),
                is_multigrid: true,
                ..Self::default()
            }));
        }
        if problem.symmetry == Symmetry::Unsymmetric {
            return Ok(None);
        }
        let kept = Kept::new(problem);
        let condensation = Condensation::by_pattern(&kept);
        let mut noperator = problem.bulk.nvalue() + problem.interface.nentry();
        let condensed;
        let problem = match &condensation {
            Some(condensation) => {
                condensed = condensation.problem(&kept);
                noperator += condensed.interface.nentry();
                &condensed
            }
            None => problem,
        };
        let matrix = Matrix::new(problem)?;
        let mut forecast = Self {
            nequation: kept.sign.len(),
            noperator,
            nmatrix: matrix.row.len(),
            ..Self::default()
        };
        if problem.nequation > 0 {
            let order = ordering::order(problem, &matrix, Ordering::Auto)?;
            (forecast.nfactor, forecast.work) = cholesky::size(&matrix, &order)?;
        }
        Ok(Some(forecast))
    }

    /// Seconds of a factorization on this machine, measured on a small dense product; or of the cycles of multigrid in an
    /// iteration of Newton's method, about.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        if self.is_multigrid {
            return SECONDS_PER_NUMBER * self.nmatrix as f64;
        }
        self.work / (rate() * EFFICIENCY)
    }

    /// Bytes of the operator, its patterns, the matrix and the factor at the time when all of them are there.
    #[must_use]
    pub fn bytes(&self) -> f64 {
        // patterns and permutations have a small number for each large one, and are kept twice
        let (number, pattern) = (8.0, 4.0);
        if self.is_multigrid {
            return BYTES_PER_NUMBER * self.nmatrix as f64;
        }
        let operator = (number + pattern) * self.noperator as f64;
        let matrix = (number + 2.0 * pattern) * self.nmatrix as f64;
        operator + matrix + number * self.nfactor as f64
    }
}

/// What a number of the stiffness of bodies costs multigrid, with everything that is made of it: measured on hex8 from
/// 40,000 to 300,000 unknowns, `docs/speed.md`.
const BYTES_PER_NUMBER: f64 = 40.0;
const SECONDS_PER_NUMBER: f64 = 2e-8;

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
