//! The size of a factorization, from the pattern alone.

use crate::direct::cholesky;
use crate::error::LinearError;
use crate::matrix::Matrix;
use crate::ordering::{self, Ordering};
use crate::problem::{Kept, Problem, Symmetry};
use crate::sparsity::NONE;

/// Bytes of a number.
pub(crate) const NUMBER: f64 = 8.0;
/// Bytes of what a pattern has for a number.
pub(crate) const PATTERN: f64 = 4.0;
/// The size of a factorization.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Factor {
    /// Equations.
    pub nequation: usize,
    /// Numbers in the matrix: one triangle of it where it is symmetric.
    pub nmatrix: usize,
    /// Numbers in the factor.
    pub nfactor: usize,
    /// Multiplications and additions.
    pub work: f64,
}

impl Factor {
    /// Orders and analyzes a problem as if it were symmetric: a factor that is not has twice as many numbers, and its order,
    /// which depends on values, hardly changes that.
    pub(crate) fn of(problem: &Problem) -> Result<Self, LinearError> {
        let halved = Problem {
            symmetry: problem.symmetry.min(Symmetry::Symmetric),
            ..*problem
        };
        let matrix = Matrix::new(&halved)?;
        let mut size = Self {
            nequation: problem.nequation,
            nmatrix: matrix.row.len(),
            ..Self::default()
        };
        if problem.nequation > 0 {
            let order = ordering::order(&halved, &matrix, Ordering::Auto)?;
            (size.nfactor, size.work) = cholesky::size(&matrix, &order)?;
        }
        if problem.symmetry == Symmetry::Unsymmetric {
            size.nmatrix *= 2;
            size.nfactor *= 2;
            size.work *= 2.0;
        }
        Ok(size)
    }

    /// That of a problem without its multipliers: the bodies with what holds them together.
    pub(crate) fn of_bodies(kept: &Kept) -> Result<Self, LinearError> {
        let mut equation = vec![NONE; kept.equation.len()];
        let mut nequation = 0;
        let own = kept.equation.iter().enumerate().zip(&mut equation);
        for (_, to) in own.filter(|((dof, e), _)| **e != NONE && !kept.is_multiplier(*dof)) {
            *to = nequation;
            nequation += 1;
        }
        Self::of(&Problem {
            equation: &equation,
            nequation: nequation as usize,
            symmetry: Symmetry::Definite,
            sign: &vec![1; nequation as usize],
            ..kept.problem()
        })
    }

    /// Bytes of matrix and factor, with numbers of the factor of this size.
    pub(crate) fn bytes(&self, of_number: f64) -> f64 {
        (NUMBER + 2.0 * PATTERN) * self.nmatrix as f64 + of_number * self.nfactor as f64
    }
}
