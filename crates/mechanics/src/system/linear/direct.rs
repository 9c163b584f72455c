//! Sparse direct solution: Cholesky where the matrix is symmetric, LU where it is not.
//!
//! ```text
//!   Definite   ──▶ L Lᵀ ──pivot ≤ 0──▶ L D Lᵀ ──residual stays──▶ LU
//!   Symmetric  ──────────────────────▶ L D Lᵀ ──residual stays──▶ LU
//!   Unsymmetric ─────────────────────────────────────────────────▶ LU
//! ```
//!
//! The order and the symbolic factor serve both L Lᵀ and L D Lᵀ: a tangent that turns indefinite under compression
//! costs no new analysis. After a factor with negative pivots, L D Lᵀ is tried first until they are gone.
//!
//! A matrix with a nearly cancelled pivot, and every LU, is examined for free motions by two steps of inverse iteration
//! and one correction with the matrix itself. A vector x with |A x| < 4·10⁻¹⁵ |A| |x| is one: round-off leaves some
//! 10⁻¹⁶ of a free motion, growing with the root of the size, and 10⁻¹³ of the softest motion of a stiffness matrix
//! whose entries still resolve it.

use super::cholesky::Cholesky;
use super::lu::Lu;
use super::matrix::Matrix;
use super::ordering::{self, Ordering};
use super::{
    Kept, LinearError, LinearSolver, Problem, SolveReport, Symmetry, Values, apply, apply_absolute,
    largest,
};
use crate::system::sparsity::NONE;
use faer::Par;

/// From so many equations on, the kernels share their work among threads.
const THREADS_FROM: usize = 30_000;
/// Refinements of one solution.
const REFINEMENTS: usize = 3;
/// What is left of a free motion after multiplication, relative to what is added up: at most this, or
const FREE: f64 = 4e-15;
/// this times the root of the number of equations (measured: a third of it at 30,000).
const FREE_PER_ROOT: f64 = 0.5 * f64::EPSILON;
/// A residual of so many units of round-off of what is added up cannot be improved.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;
/// What is added to the diagonal to find the free motion of a matrix whose LU broke down.
const NAMING_SHIFT: f64 = 1e-10;
/// The largest symmetric system for which LU is tried when L D Lᵀ fails: its memory grows fast.
const LU_UP_TO: usize = 60_000;

/// The direct solver.
///
/// # Limits
/// From 30,000 equations on the dense kernels share their work among the threads of the current pool, and the last bits
/// of a solution depend on their number (the same number gives the same bits). [`Direct::reproducible`] gives the same
/// bits everywhere and takes up to half as long again on two threads.
pub struct Direct {
    ordering: Ordering,
    threads: bool,
    analysis: Option<Analysis>,
}

struct Analysis {
    kept: Kept,
    ndof: usize,
    par: Par,
    matrix: Matrix,
    cholesky: Option<Cholesky>,
    lu: Option<Lu>,
    active: Active,
    /// The last factor had negative pivots.
    indefinite: bool,
    /// L D Lᵀ failed on this pattern.
    prefer_lu: bool,
    work: Work,
}

/// Which factor is current.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Active {
    None,
    Cholesky,
    Lu,
}

struct Work {
    raw_x: Vec<f64>,
    raw_y: Vec<f64>,
    residual: Vec<f64>,
    change: Vec<f64>,
    best: Vec<f64>,
}

impl Default for Direct {
    fn default() -> Self {
        Self::new()
    }
}

impl Direct {
    /// A solver that has not seen a problem yet.
    pub fn new() -> Self {
        Self {
            ordering: Ordering::Auto,
            threads: true,
            analysis: None,
        }
    }

    /// The same, on one thread whatever the size: its bits do not depend on the number of threads.
    pub fn reproducible() -> Self {
        Self {
            threads: false,
            ..Self::new()
        }
    }

    #[cfg(test)]
    pub(super) fn with_ordering(ordering: Ordering) -> Self {
        Self {
            ordering,
            ..Self::new()
        }
    }

    /// Whether the current factor is an LU.
    #[cfg(test)]
    pub(super) fn uses_lu(&self) -> bool {
        self.analysis
            .as_ref()
            .is_some_and(|a| a.active == Active::Lu)
    }

    /// Where the gathered matrix lies: the same address means that an analysis was kept.
    #[cfg(test)]
    pub(super) fn address(&self) -> Option<*const u32> {
        self.analysis.as_ref().map(|a| a.matrix.row.as_ptr())
    }

    /// The numbers that the Cholesky factor stores.
    #[cfg(test)]
    pub(super) fn nfactor(&self) -> usize {
        self.analysis
            .as_ref()
            .and_then(|a| a.cholesky.as_ref())
            .map_or(0, Cholesky::nentry)
    }
}

impl LinearSolver for Direct {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        if self
            .analysis
            .as_ref()
            .is_some_and(|a| a.ndof == problem.ndof && a.kept.is(problem))
        {
            return Ok(());
        }
        self.analysis = None;
        problem.check()?;
        self.analysis = Some(Analysis::new(problem, self.ordering, self.threads)?);
        Ok(())
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        let analysis = self
            .analysis
            .as_mut()
            .ok_or(LinearError::Order { before: "analyze" })?;
        analysis.kept.check(values)?;
        analysis.factorize(values)
    }

    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        let analysis = self
            .analysis
            .as_mut()
            .ok_or(LinearError::Order { before: "analyze" })?;
        analysis.kept.check(values)?;
        analysis.solve(values, rhs, x, rtol)
    }
}

impl Analysis {
    fn new(problem: &Problem, ordering: Ordering, threads: bool) -> Result<Self, LinearError> {
        let n = problem.nequation;
        let par = if threads && n >= THREADS_FROM {
            Par::rayon(0)
        } else {
            Par::Seq
        };
        let matrix = Matrix::new(problem)?;
        let (mut cholesky, mut lu) = (None, None);
        if n > 0 && matrix.symmetric {
            let order = ordering::order(&matrix, &node_of(problem), problem.sign, ordering)?;
            cholesky = Some(Cholesky::new(&matrix, &order, problem.sign, par)?);
        } else if n > 0 {
            lu = Some(Lu::new(&matrix, par)?);
        }
        let work = Work {
            raw_x: vec![0.0; problem.ndof],
            raw_y: vec![0.0; problem.ndof],
            residual: vec![0.0; n],
            change: vec![0.0; n],
            best: vec![0.0; n],
        };
        let kept = Kept::new(problem);
        let active = Active::None;
        Ok(Self {
            kept,
            ndof: problem.ndof,
            par,
            matrix,
            cholesky,
            lu,
            active,
            indefinite: false,
            prefer_lu: false,
            work,
        })
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        self.active = Active::None;
        if self.matrix.nequation() == 0 {
            return Ok(());
        }
        self.matrix.gather(&self.kept, values)?;
        match &mut self.cholesky {
            Some(cholesky) if !self.prefer_lu => {
                let hopeful = self.kept.symmetry == Symmetry::Definite && !self.indefinite;
                if !(hopeful && cholesky.factorize_definite(&self.matrix)) {
                    cholesky.factorize_indefinite(&mut self.matrix)?;
                }
                self.indefinite = cholesky.negative_pivots > 0;
                self.active = Active::Cholesky;
                if cholesky.is_suspicious() {
                    self.examine()
                } else {
                    Ok(())
                }
            }
            _ => self.factorize_lu(),
        }
    }

    fn factorize_lu(&mut self) -> Result<(), LinearError> {
        let lu = match &mut self.lu {
            Some(lu) => lu,
            none => none.insert(Lu::new(&self.matrix, self.par)?),
        };
        lu.factorize(&mut self.matrix, 0.0)?;
        self.active = Active::Lu;
        self.examine()
    }

    /// Looks for a motion that costs no force, by inverse iteration from a scattered start.
    fn examine(&mut self) -> Result<(), LinearError> {
        let equation = match self.free_motion() {
            Ok(None) => return Ok(()),
            Ok(equation) => equation,
            Err(()) => {
                // the factor broke down at a zero pivot: a nearby matrix shows the motion
                let lu = self.lu.as_mut().filter(|_| self.active == Active::Lu);
                let near =
                    lu.is_some_and(|lu| lu.factorize(&mut self.matrix, NAMING_SHIFT).is_ok());
                if near {
                    self.free_motion().unwrap_or(None)
                } else {
                    None
                }
            }
        };
        self.active = Active::None;
        Err(LinearError::Singular { equation })
    }

    /// The equation that moves most in a free motion, if there is one; an error where the factor gives no numbers.
    fn free_motion(&mut self) -> Result<Option<usize>, ()> {
        let n = self.matrix.nequation();
        let free = FREE.max(FREE_PER_ROOT * (n as f64).sqrt());
        let scattered = |e: usize| 0.5 + ((e as f64 + 1.0) * 0.618_033_988_749_894_9).fract();
        let mut x: Vec<f64> = (0..n)
            .map(|e| {
                if e % 2 == 0 {
                    scattered(e)
                } else {
                    -scattered(e)
                }
            })
            .collect();
        let mut product = vec![0.0; n];
        for _ in 0..2 {
            self.back_substitute(&mut x);
            let size = largest(&x);
            if !size.is_finite() || size == 0.0 {
                return Err(());
            }
            x.iter_mut().for_each(|x| *x /= size);
        }
        for correction in 0..2 {
            self.matrix.multiply(&x, &mut product, f64::abs);
            let sum = largest(&product);
            self.matrix.multiply(&x, &mut product, |a| a);
            if largest(&product) < free * sum {
                let moved = x
                    .iter()
                    .zip(&self.matrix.column_scale)
                    .map(|(x, scale)| (x * scale).abs());
                return Ok(moved
                    .enumerate()
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .map(|(e, _)| e));
            }
            // a factor of A + shift gives a motion that is off by the shift: correct it with A itself
            if correction == 0 {
                self.back_substitute(&mut product);
                x.iter_mut().zip(&product).for_each(|(x, y)| *x -= y);
            }
        }
        Ok(None)
    }

    fn back_substitute(&mut self, x: &mut [f64]) {
        match (self.active, &mut self.cholesky, &mut self.lu) {
            (Active::Cholesky, Some(cholesky), _) => cholesky.solve(x),
            (Active::Lu, _, Some(lu)) => lu.solve(x),
            _ => {}
        }
    }

    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        let n = self.matrix.nequation();
        for (what, got) in [("right-hand sides", rhs.len()), ("unknowns", x.len())] {
            if got != n {
                return Err(LinearError::Shape {
                    what,
                    got,
                    wanted: n,
                });
            }
        }
        if n == 0 {
            return Ok(SolveReport::default());
        }
        if self.active == Active::None {
            return Err(LinearError::Order {
                before: "factorize",
            });
        }
        if !largest(rhs).is_finite() {
            return Err(LinearError::NotFinite);
        }
        match self.refine(values, rhs, x, rtol) {
            Err(LinearError::Inaccurate { .. }) if self.may_escalate() => {
                self.prefer_lu = true;
                self.matrix.gather(&self.kept, values)?;
                self.factorize_lu()?;
                self.refine(values, rhs, x, rtol)
            }
            result => result,
        }
    }

    /// Whether pivoting might do better than the factor at hand.
    fn may_escalate(&self) -> bool {
        self.active == Active::Cholesky
            && self
                .cholesky
                .as_ref()
                .is_some_and(|cholesky| !cholesky.is_definite())
            && self.matrix.nequation() <= LU_UP_TO
    }

    fn refine(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        let cholesky = self
            .cholesky
            .as_ref()
            .filter(|_| self.active == Active::Cholesky);
        let at_least = usize::from(cholesky.is_some_and(Cholesky::is_shifted));
        let mut report = SolveReport {
            negative_pivots: cholesky.map_or(0, |c| c.negative_pivots),
            ..SolveReport::default()
        };
        x.fill(0.0);
        let wanted = largest(rhs);
        if wanted == 0.0 {
            return Ok(report);
        }
        report.residual = 1.0;
        self.work.residual.copy_from_slice(rhs);
        self.work.best.fill(0.0);
        for refinement in 0..=REFINEMENTS {
            let mut change = std::mem::take(&mut self.work.change);
            for ((c, r), scale) in change
                .iter_mut()
                .zip(&self.work.residual)
                .zip(&self.matrix.row_scale)
            {
                *c = r * scale;
            }
            self.back_substitute(&mut change);
            for ((x, c), scale) in x.iter_mut().zip(&change).zip(&self.matrix.column_scale) {
                *x += c * scale;
            }
            self.work.change = change;
            report.iterations += 1;
            report.refinements = refinement;
            self.measure(values, rhs, x);
            let residual = largest(&self.work.residual) / wanted;
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
        if report.residual <= rtol || report.residual <= self.round_off(values, x) / wanted {
            Ok(report)
        } else {
            Err(LinearError::Inaccurate {
                residual: report.residual,
                wanted: rtol,
            })
        }
    }

    /// The true residual, through the operator as it was assembled.
    fn measure(&mut self, values: &Values, rhs: &[f64], x: &[f64]) {
        let Work {
            raw_x,
            raw_y,
            residual,
            ..
        } = &mut self.work;
        spread(&self.kept.equation, x, raw_x);
        apply(&self.kept.bulk, &self.kept.interface, values, raw_x, raw_y);
        residual.copy_from_slice(rhs);
        for (&e, y) in self
            .kept
            .equation
            .iter()
            .zip(raw_y)
            .filter(|&(&e, _)| e != NONE)
        {
            residual[e as usize] -= *y;
        }
    }

    /// How large a residual round-off alone may leave.
    fn round_off(&mut self, values: &Values, x: &[f64]) -> f64 {
        let Work { raw_x, raw_y, .. } = &mut self.work;
        spread(&self.kept.equation, x, raw_x);
        apply_absolute(&self.kept.bulk, &self.kept.interface, values, raw_x, raw_y);
        let equations = self
            .kept
            .equation
            .iter()
            .zip(raw_y)
            .filter(|&(&e, _)| e != NONE);
        ROUND_OFF * equations.fold(0.0, |max: f64, (_, y)| max.max(*y))
    }
}

impl Kept {
    /// Checks that values belong to the patterns.
    fn check(&self, values: &Values) -> Result<(), LinearError> {
        for (what, got, wanted) in [
            ("bulk values", values.bulk.len(), self.bulk.nvalue()),
            (
                "interface values",
                values.interface.len(),
                self.interface.nentry(),
            ),
        ] {
            if got != wanted {
                return Err(LinearError::Shape { what, got, wanted });
            }
        }
        Ok(())
    }
}

/// Unknowns from equations to raw degrees of freedom, zero where there is no equation.
fn spread(equation: &[u32], x: &[f64], raw: &mut [f64]) {
    for (&e, raw) in equation.iter().zip(raw) {
        *raw = x.get(e as usize).copied().unwrap_or(0.0);
    }
}

/// The node of each equation; none for those outside the bulk.
pub(super) fn node_of(problem: &Problem) -> Vec<u32> {
    let mut node = vec![NONE; problem.nequation];
    let nbulk = problem.bulk.nrow() * problem.bulk.block;
    for (d, &e) in problem
        .equation
        .iter()
        .enumerate()
        .take(nbulk)
        .filter(|&(_, &e)| e != NONE)
    {
        node[e as usize] = (d / problem.bulk.block) as u32;
    }
    node
}
