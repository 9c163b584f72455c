//! Sparse direct solution: Cholesky where the matrix is symmetric, LU where it is not.
//!
//! ```text
//!   Definite   ──▶ L Lᵀ ──pivot ≤ 0──▶ L D Lᵀ ──residual stays──▶ LU
//!   Symmetric  ──────────────────────▶ L D Lᵀ ──residual stays──▶ LU
//!   Unsymmetric ──▶ LU by fronts ──────────────residual stays────▶ LU
//! ```
//!
//! The order and the symbolic factor serve both L Lᵀ and L D Lᵀ: a tangent that turns indefinite under compression
//! costs no new analysis. After a factor with negative pivots, L D Lᵀ is tried first until they are gone.
//!
//! A matrix with a nearly cancelled pivot, and every LU, is examined for free motions. Where fronts replaced pivots, a
//! solution with a scattered right-hand side shows whether refinement makes up for them.

mod cholesky;
mod fronts;
pub(crate) mod gathered;
mod lu;
mod registers;
mod size;

pub use size::Factor;
pub(crate) use size::{NUMBER, PATTERN};

use crate::error::LinearError;
use crate::ordering::{self, Ordering};
use crate::problem::{Problem, Symmetry, Values};
use crate::solver::{Iterative, LinearSolver, SolveReport};
use cholesky::Cholesky;
use faer::Par;
use fronts::{Fronts, Precision};
use gathered::{Breakdown, Gathered, NAMING_SHIFT, scattered};
use lu::Lu;

/// From so many equations on, the kernels share their work among threads.
const THREADS_FROM: usize = 30_000;
/// The largest symmetric system for which LU is tried when L D Lᵀ fails: its memory grows fast.
const LU_UP_TO: usize = 60_000;

/// The residual of a scattered right-hand side that a factor with replaced pivots has to reach.
const WITHOUT_PIVOTS: f64 = 1e-10;

/// The direct solver.
///
/// # Limits
/// From 30,000 equations on the dense kernels share their work among the threads of the current pool, and the last bits
/// of a solution depend on their number (the same number gives the same bits). [`Direct::reproducible`] gives the same
/// bits everywhere and takes up to half as long again on two threads.
pub struct Direct {
    ordering: Ordering,
    threads: bool,
    /// The precision of factors by fronts, as long as that suffices.
    precision: Precision,
    analysis: Option<Analysis>,
    /// Whether what earlier values taught is to be forgotten with the next ones.
    forgotten: bool,
}

struct Analysis {
    gathered: Gathered,
    factors: Factors,
    ordering: Ordering,
    precision: Precision,
    par: Par,
    /// The last factor had negative pivots.
    indefinite: bool,
    /// Factors without free choice of pivots failed on this pattern.
    prefer_lu: bool,
}

struct Factors {
    cholesky: Option<Cholesky>,
    fronts: Option<Fronts>,
    /// The groups of equations whose order the fronts have, and whether the values that gave them are forgotten.
    groups: Vec<u32>,
    is_order_old: bool,
    /// Whether values like those at hand lack pivots in the order that was found for them: another search would not help.
    is_order_poor: bool,
    lu: Option<Lu>,
    active: Active,
}

/// Which factor is current.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Active {
    None,
    Cholesky,
    Fronts,
    Lu,
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
            precision: Precision::Double,
            analysis: None,
            forgotten: false,
        }
    }

    /// The same, on one thread whatever the size: its bits do not depend on the number of threads.
    pub fn reproducible() -> Self {
        Self {
            threads: false,
            ..Self::new()
        }
    }

    /// The same, with factors in single precision where the matrix is unsymmetric: for preconditioners, which judge each
    /// factor by [`Self::leaves`] and may ask for double precision by [`Self::widen`].
    pub(crate) fn rough() -> Self {
        Self {
            precision: Precision::Single,
            ..Self::reproducible()
        }
    }

    /// Whether the current factor is in single precision.
    pub(crate) fn is_rough(&self) -> bool {
        let precision = |a: &Analysis| {
            let fronts = a.factors.fronts.as_ref();
            let current = fronts.filter(|_| a.factors.active == Active::Fronts);
            current.map(Fronts::precision)
        };
        self.analysis.as_ref().and_then(precision) == Some(Precision::Single)
    }

    /// What is left of a right-hand side by a solution with the factor at hand, in equilibrated equations: the largest entry.
    pub(crate) fn leaves(&mut self, right: &[f64]) -> f64 {
        let Some(Analysis {
            gathered, factors, ..
        }) = &mut self.analysis
        else {
            return f64::INFINITY;
        };
        let matrix = &gathered.matrix;
        let (mut x, mut product) = (right.to_vec(), vec![0.0; right.len()]);
        factors.solve(&mut x);
        matrix.multiply(&x, &mut product, |a| a);
        let left = right.iter().zip(&product).map(|(b, y)| (b - y).abs());
        left.fold(0.0, |most, r| {
            if r.is_finite() {
                most.max(r)
            } else {
                f64::INFINITY
            }
        })
    }

    /// Has factors in double precision until what values taught is forgotten.
    pub(crate) fn widen(&mut self) {
        if let Some(analysis) = &mut self.analysis {
            analysis.precision = Precision::Double;
        }
    }

    #[cfg(test)]
    pub(crate) fn with_ordering(ordering: Ordering) -> Self {
        Self {
            ordering,
            ..Self::new()
        }
    }

    /// Solves with the factor at hand, and does not look at the residual.
    ///
    /// # Errors
    /// `Order`.
    pub(crate) fn solve_unchecked(
        &mut self,
        rhs: &[f64],
        x: &mut [f64],
    ) -> Result<(), LinearError> {
        let known = self.analysis.as_mut();
        let known = known.filter(|a| rhs.is_empty() || a.factors.active != Active::None);
        let Analysis {
            gathered, factors, ..
        } = known.ok_or(LinearError::Order {
            before: "factorize",
        })?;
        let matrix = &gathered.matrix;
        for ((x, b), scale) in x.iter_mut().zip(rhs).zip(&matrix.row_scale) {
            *x = b * scale;
        }
        factors.solve(x);
        for (x, scale) in x.iter_mut().zip(&matrix.column_scale) {
            *x *= scale;
        }
        Ok(())
    }

    /// The negative pivots of the current factor; none where pivots have no sign.
    pub(crate) fn negative_pivots(&self) -> Option<usize> {
        let factors = self.analysis.as_ref().map(|a| &a.factors)?;
        factors.active_cholesky().map(|c| c.negative_pivots)
    }

    /// How many entries of the factor by fronts are beyond the range of normal numbers.
    #[cfg(test)]
    pub(crate) fn nsubnormal(&self) -> usize {
        let fronts = |a: &Analysis| a.factors.fronts.as_ref().map(Fronts::nsubnormal);
        self.analysis.as_ref().and_then(fronts).unwrap_or_default()
    }

    /// Whether the current factor is an LU.
    #[cfg(test)]
    pub(crate) fn uses_lu(&self) -> bool {
        self.analysis
            .as_ref()
            .is_some_and(|a| a.factors.active == Active::Lu)
    }

    /// Whether the current factor is L Lᵀ.
    #[cfg(test)]
    pub(crate) fn is_definite(&self) -> bool {
        let factor = |a: &Analysis| {
            a.factors
                .active_cholesky()
                .is_some_and(Cholesky::is_definite)
        };
        self.analysis.as_ref().is_some_and(factor)
    }

    /// Where the gathered matrix lies: the same address means that an analysis was kept.
    #[cfg(test)]
    pub(crate) fn address(&self) -> Option<*const u32> {
        self.analysis
            .as_ref()
            .map(|a| a.gathered.matrix.row.as_ptr())
    }

    /// The numbers that a Cholesky factor stores, and the multiplications and additions that it takes.
    pub(crate) fn size(&self) -> (usize, f64) {
        let analysis = self.analysis.as_ref();
        let cholesky = analysis.and_then(|a| a.factors.cholesky.as_ref());
        cholesky.map_or((0, 0.0), Cholesky::size)
    }
}

impl LinearSolver for Direct {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        if self
            .analysis
            .as_ref()
            .is_some_and(|a| a.gathered.is(problem))
        {
            return Ok(());
        }
        self.analysis = None;
        problem.check()?;
        let analysis = Analysis::new(problem, self.ordering, self.threads)?;
        self.analysis = Some(Analysis {
            precision: self.precision,
            ..analysis
        });
        Ok(())
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        let analysis = self
            .analysis
            .as_mut()
            .ok_or(LinearError::Order { before: "analyze" })?;
        if std::mem::take(&mut self.forgotten) {
            analysis.forget();
            analysis.precision = self.precision;
        }
        analysis.factorize(values)
    }

    fn forget(&mut self) {
        self.forgotten = true;
    }

    fn iterative(&self) -> Option<&dyn Iterative> {
        None
    }

    fn iterative_mut(&mut self) -> Option<&mut dyn Iterative> {
        None
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
        let gathered = Gathered::new(problem)?;
        let matrix = &gathered.matrix;
        let mut cholesky = None;
        if n > 0 && matrix.symmetric {
            let order = ordering::order(problem, matrix, ordering)?;
            cholesky = Some(Cholesky::new(matrix, &order, problem.sign, par)?);
        }
        Ok(Self {
            gathered,
            factors: Factors {
                cholesky,
                fronts: None,
                groups: Vec::new(),
                is_order_old: false,
                is_order_poor: false,
                lu: None,
                active: Active::None,
            },
            ordering,
            precision: Precision::Double,
            par,
            indefinite: false,
            prefer_lu: false,
        })
    }

    /// Forgets what values taught: which factor serves, the scales, and the order of multipliers.
    fn forget(&mut self) {
        self.gathered.matrix.forget_scales();
        (self.indefinite, self.prefer_lu) = (false, false);
        if self.gathered.kept.sign.iter().any(|&sign| sign < 0) {
            self.factors.is_order_old = true;
        }
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        self.factors.active = Active::None;
        self.gathered.gather(values)?;
        if self.gathered.matrix.nequation() == 0 {
            return Ok(());
        }
        if self.prefer_lu {
            return self.factorize_lu();
        }
        let matrix = &mut self.gathered.matrix;
        let Factors {
            cholesky, active, ..
        } = &mut self.factors;
        let is_suspicious = if let Some(cholesky) = cholesky {
            let hopeful = self.gathered.kept.symmetry == Symmetry::Definite && !self.indefinite;
            if !(hopeful && cholesky.factorize_definite(matrix)) {
                cholesky.factorize_indefinite(matrix)?;
            }
            self.indefinite = cholesky.negative_pivots > 0;
            *active = Active::Cholesky;
            cholesky.is_suspicious()
        } else if let Some(is_suspicious) = self.factorize_fronts()? {
            self.factors.active = Active::Fronts;
            if self.factors.lacks_pivots() && !self.solves(values)? {
                return self.factorize_lu();
            }
            is_suspicious
        } else {
            return self.factorize_lu();
        };
        if is_suspicious {
            self.examine()
        } else {
            Ok(())
        }
    }

    /// Factorizes by fronts, if need be in an order that suits the values at hand better. Answers whether some pivot was
    /// all but cancelled; nothing where numbers are not finite, or there is no memory.
    fn factorize_fronts(&mut self) -> Result<Option<bool>, LinearError> {
        let Gathered { kept, matrix, .. } = &self.gathered;
        for _ in 0..2 {
            let known = self.factors.fronts.take();
            let is_old = std::mem::take(&mut self.factors.is_order_old);
            let is_new = known.is_none() || is_old;
            let mut fronts = match known {
                Some(fronts) if !is_new => fronts,
                known => {
                    let problem = kept.problem();
                    let groups = || ordering::groups(&problem, matrix);
                    let (known, of_known) = known.map(|fronts| (fronts, groups())).unzip();
                    match known.filter(|_| of_known.as_ref() == Some(&self.factors.groups)) {
                        Some(fronts) => fronts,
                        None => {
                            let (ordering, found) = (self.ordering, &mut self.factors.groups);
                            Fronts::new(matrix, self.precision, || {
                                *found = of_known.unwrap_or_else(groups);
                                ordering::order_groups(&problem, matrix, found, ordering)
                            })?
                        }
                    }
                }
            };
            if !(fronts.change(self.precision) && fronts.factorize(matrix)) {
                if is_new {
                    break;
                }
                continue;
            }
            let lacks_pivots = fronts.lacks_pivots();
            if is_new {
                self.factors.is_order_poor = lacks_pivots;
            }
            if !lacks_pivots || self.factors.is_order_poor {
                let is_suspicious = fronts.is_suspicious();
                self.factors.fronts = Some(fronts);
                return Ok(Some(is_suspicious));
            }
        }
        Ok(None)
    }

    /// Whether refinement makes up for pivots that were replaced: of a singular matrix, it does not.
    fn solves(&mut self, values: &Values) -> Result<bool, LinearError> {
        let right = scattered(self.gathered.matrix.nequation());
        let mut left = vec![0.0; right.len()];
        match self.refine(values, &right, &mut left, WITHOUT_PIVOTS) {
            Ok(report) => Ok(report.residual <= WITHOUT_PIVOTS),
            Err(LinearError::Inaccurate { .. } | LinearError::NotFinite) => Ok(false),
            Err(other) => Err(other),
        }
    }

    fn factorize_lu(&mut self) -> Result<(), LinearError> {
        let matrix = &mut self.gathered.matrix;
        let lu = match &mut self.factors.lu {
            Some(lu) => lu,
            none => none.insert(Lu::new(matrix, self.par)?),
        };
        lu.factorize(matrix, 0.0)?;
        self.factors.active = Active::Lu;
        self.examine()
    }

    /// Looks for a motion that costs no force.
    fn examine(&mut self) -> Result<(), LinearError> {
        let Self {
            gathered, factors, ..
        } = self;
        let equation = match gathered.free_motion(|x| factors.solve(x)) {
            Ok(None) => return Ok(()),
            Ok(equation) => equation,
            Err(Breakdown) if factors.active == Active::Fronts => return self.factorize_lu(),
            Err(Breakdown) => {
                // the factor broke down at a zero pivot: a nearby matrix shows the motion
                let lu = factors.lu.as_mut().filter(|_| factors.active == Active::Lu);
                let near =
                    lu.is_some_and(|lu| lu.factorize(&mut gathered.matrix, NAMING_SHIFT).is_ok());
                if near {
                    gathered.free_motion(|x| factors.solve(x)).unwrap_or(None)
                } else {
                    None
                }
            }
        };
        factors.active = Active::None;
        Err(LinearError::Singular { equation })
    }

    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        self.gathered.kept.check_solution(values, rhs, x)?;
        if rhs.is_empty() {
            return Ok(SolveReport::default());
        }
        if self.factors.active == Active::None {
            return Err(LinearError::Order {
                before: "factorize",
            });
        }
        match self.refine(values, rhs, x, rtol) {
            Err(error @ LinearError::Inaccurate { .. }) if self.may_escalate() => {
                // an old factor may just be too far off
                if !self.gathered.has(values)? {
                    return Err(error);
                }
                self.prefer_lu = true;
                self.factorize_lu()?;
                self.refine(values, rhs, x, rtol)
            }
            result => result,
        }
    }

    /// Whether pivoting might do better than the factor at hand.
    fn may_escalate(&self) -> bool {
        let cholesky = self.factors.active_cholesky();
        let is_indefinite = cholesky.is_some_and(|c| !c.is_definite());
        self.factors.active == Active::Fronts
            || is_indefinite && self.gathered.matrix.nequation() <= LU_UP_TO
    }

    fn refine(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        let Self {
            gathered, factors, ..
        } = self;
        let cholesky = factors.active_cholesky();
        let at_least = usize::from(cholesky.is_some_and(Cholesky::is_shifted));
        let negative_pivots = cholesky.map_or(0, |c| c.negative_pivots);
        let report = gathered.refine(values, rhs, x, rtol, at_least, |x| factors.solve(x))?;
        Ok(SolveReport {
            negative_pivots,
            ..report
        })
    }
}

impl Factors {
    /// Whether pivots of the current factor were replaced, in double precision. In single precision, the caller judges the
    /// factor by [`Direct::leaves`].
    fn lacks_pivots(&self) -> bool {
        let is_double = |f: &&Fronts| f.precision() == Precision::Double;
        let fronts = self.fronts.as_ref().filter(is_double);
        self.active == Active::Fronts && fronts.is_some_and(Fronts::lacks_pivots)
    }

    /// The Cholesky factor, where it is current.
    fn active_cholesky(&self) -> Option<&Cholesky> {
        self.cholesky
            .as_ref()
            .filter(|_| self.active == Active::Cholesky)
    }

    /// Solves with the current factor.
    fn solve(&mut self, x: &mut [f64]) {
        match self.active {
            Active::Cholesky => self.cholesky.iter_mut().for_each(|c| c.solve(x)),
            Active::Fronts => self.fronts.iter_mut().for_each(|f| f.solve(x)),
            Active::Lu => self.lu.iter_mut().for_each(|lu| lu.solve(x)),
            Active::None => {}
        }
    }
}
