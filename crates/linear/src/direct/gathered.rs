//! The gathered matrix, and what a factor of it is used for, whichever it is: to look for free motions, and to solve
//! and refine until the residual is small.
//!
//! A free motion is looked for by two steps of inverse iteration and one correction with the matrix itself. A vector x
//! with |A x| < 4·10⁻¹⁵ |A| |x| is one: round-off leaves some 10⁻¹⁶ of a free motion, growing with the root of the size,
//! and 10⁻¹³ of the softest motion of a stiffness matrix whose entries still resolve it.
//!
//! A factor comes as a function that solves with it, in place and in equilibrated unknowns.

use crate::error::LinearError;
use crate::matrix::Matrix;
use crate::norm::largest;
use crate::problem::{Kept, Problem, Values};
use crate::residual::Residual;
use crate::solver::SolveReport;

/// Refinements of one solution.
const REFINEMENTS: usize = 3;
/// A displacement does not take part in a free motion where it is below this part of what moves most, equilibrated.
const STILL: f64 = 1e-6;
/// The residual of a free motion after multiplication, relative to the sum of absolute values: at most this, or
const FREE: f64 = 4e-15;
/// this times the root of the number of equations (measured: a third of it at 30,000).
const FREE_PER_ROOT: f64 = 0.5 * f64::EPSILON;
/// What is added to the diagonal to find the free motion of a matrix whose factor broke down.
pub(crate) const NAMING_SHIFT: f64 = 1e-10;

/// A factor that gives no numbers.
#[derive(Debug)]
pub(crate) struct Breakdown;

/// A problem with the matrix of its last values.
pub(crate) struct Gathered {
    pub kept: Kept,
    pub matrix: Matrix,
    work: Work,
}

struct Work {
    residual: Residual,
    change: Vec<f64>,
    best: Vec<f64>,
}

impl Gathered {
    pub fn new(problem: &Problem) -> Result<Self, LinearError> {
        let n = problem.nequation;
        Ok(Self {
            kept: Kept::new(problem),
            matrix: Matrix::new(problem)?,
            work: Work {
                residual: Residual::new(problem.ndof, n),
                change: vec![0.0; n],
                best: vec![0.0; n],
            },
        })
    }

    /// Whether the problem is the one that this was made for.
    pub fn is(&self, problem: &Problem) -> bool {
        self.work.residual.ndof() == problem.ndof && self.kept.is(problem)
    }

    /// Takes the values of a tangent into the matrix.
    ///
    /// # Errors
    /// `Shape`, `NotFinite`, and `Singular` with the equation where a row is zero.
    pub fn gather(&mut self, values: &Values) -> Result<(), LinearError> {
        self.kept.check(values)?;
        self.matrix.gather(&self.kept, values)
    }

    /// Whether the matrix has these values already.
    ///
    /// # Errors
    /// Those of [`Gathered::gather`].
    pub fn has(&mut self, values: &Values) -> Result<bool, LinearError> {
        let matrix = &mut self.matrix;
        let value = matrix.value.clone();
        let scales = (matrix.row_scale.clone(), matrix.column_scale.clone());
        matrix.gather(&self.kept, values)?;
        // other scales may have become better ones
        let is_same = (0..matrix.nequation()).all(|e| {
            let own = matrix.range(e);
            let pairs = matrix.value[own.clone()].iter().zip(&value[own.clone()]);
            let rows = matrix.row[own].iter().map(|&row| row as usize);
            pairs.zip(rows).all(|((new, old), f)| {
                let by_new = matrix.row_scale[e] * matrix.column_scale[f];
                let by_old = scales.0[e] * scales.1[f];
                new / by_new == old / by_old
            })
        });
        matrix.value = value;
        (matrix.row_scale, matrix.column_scale) = scales;
        Ok(is_same)
    }

    /// The equation that moves most in a free motion, if there is one; found by inverse iteration from a scattered start.
    pub fn free_motion(
        &self,
        mut back_substitute: impl FnMut(&mut [f64]),
    ) -> Result<Option<usize>, Breakdown> {
        let n = self.matrix.nequation();
        let free = FREE.max(FREE_PER_ROOT * (n as f64).sqrt());
        let mut x = scattered(n);
        let mut product = vec![0.0; n];
        for _ in 0..2 {
            back_substitute(&mut x);
            let size = largest(&x);
            if !size.is_finite() || size == 0.0 {
                return Err(Breakdown);
            }
            x.iter_mut().for_each(|x| *x /= size);
        }
        for correction in 0..2 {
            self.matrix.multiply(&x, &mut product, f64::abs);
            let sum = largest(&product);
            self.matrix.multiply(&x, &mut product, |a| a);
            if largest(&product) < free * sum {
                return Ok(self.moves_most(&x));
            }
            // a factor of A + shift gives a motion that is off by the shift: correct it with A itself
            if correction == 0 {
                back_substitute(&mut product);
                x.iter_mut().zip(&product).for_each(|(x, y)| *x -= y);
            }
        }
        Ok(None)
    }

    /// The equation that moves most in a free motion, in equilibrated unknowns: a multiplier where no displacement moves, for
    /// multipliers are of other units.
    fn moves_most(&self, motion: &[f64]) -> Option<usize> {
        let moves = |e: usize| (motion[e] * self.matrix.column_scale[e]).abs();
        let least = STILL * largest(motion);
        let displaced = |&e: &usize| self.kept.sign[e] > 0 && motion[e].abs() > least;
        let all = || 0..motion.len();
        let displacement = all()
            .filter(displaced)
            .max_by(|&a, &b| moves(a).total_cmp(&moves(b)));
        displacement.or_else(|| all().max_by(|&a, &b| moves(a).total_cmp(&moves(b))))
    }

    /// Solves and refines, at least `at_least` times, until the residual of the operator is at most `rtol` or round-off.
    ///
    /// # Errors
    /// `Inaccurate`, `NotFinite`.
    pub fn refine(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
        at_least: usize,
        mut back_substitute: impl FnMut(&mut [f64]),
    ) -> Result<SolveReport, LinearError> {
        let wanted = largest(rhs);
        if !wanted.is_finite() {
            return Err(LinearError::NotFinite);
        }
        let mut report = SolveReport::default();
        x.fill(0.0);
        if wanted == 0.0 {
            return Ok(report);
        }
        report.residual = 1.0;
        self.work.residual.value.copy_from_slice(rhs);
        self.work.best.fill(0.0);
        for refinement in 0..=REFINEMENTS {
            let change = &mut self.work.change;
            for ((c, r), scale) in change
                .iter_mut()
                .zip(&self.work.residual.value)
                .zip(&self.matrix.row_scale)
            {
                *c = r * scale;
            }
            back_substitute(change);
            for ((x, c), scale) in x.iter_mut().zip(change).zip(&self.matrix.column_scale) {
                *x += *c * scale;
            }
            report.iterations += 1;
            report.refinements = refinement;
            self.work.residual.measure(&self.kept, values, rhs, x);
            let residual = largest(&self.work.residual.value) / wanted;
            if !residual.is_finite() {
                return Err(LinearError::NotFinite);
            }
            let gain = residual / report.residual;
            if gain < 1.0 {
                report.residual = residual;
                self.work.best.copy_from_slice(x);
            }
            if (report.residual <= rtol && refinement >= at_least) || (refinement > 0 && gain > 0.5)
            {
                break;
            }
        }
        x.copy_from_slice(&self.work.best);
        let round_off = |r: &mut Residual| r.round_off(&self.kept, values, x) / wanted;
        if report.residual <= rtol || report.residual <= round_off(&mut self.work.residual) {
            Ok(report)
        } else {
            Err(LinearError::Inaccurate {
                residual: report.residual,
                wanted: rtol,
            })
        }
    }
}

/// Numbers of both signs with sizes from 0.5 to 1.5, in no order that a matrix might have: multiples of the golden ratio.
pub(crate) fn scattered(n: usize) -> Vec<f64> {
    let size = |e: usize| 0.5 + ((e as f64 + 1.0) * 0.618_033_988_749_894_9).fract();
    let signed = |e: usize| {
        if e.is_multiple_of(2) {
            size(e)
        } else {
            -size(e)
        }
    };
    (0..n).map(signed).collect()
}
