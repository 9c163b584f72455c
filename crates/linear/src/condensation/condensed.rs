//! Solution with multipliers condensed: only unknowns of the size of the displacements reach the solver.
//!
//! ```text
//!   no multipliers, or none that has a partner  ──▶  the whole problem
//!   else  eliminate ──▶ condensed problem ──▶ factor ──▶ x ──residual of the whole problem──▶ refine
//!                                                        └──stays──▶  the whole problem
//! ```
//!
//! Partners are chosen by the pattern, and again by values where a choice does not serve, which is forgotten when an increment
//! begins: the data saved then suffice to continue alike. Each choice is analyzed once. A contact that opens or closes changes
//! numbers only.

use super::partners::Multipliers;
use crate::condensation::{Condensation, Numbers, Refusal};
use crate::direct::Direct;
use crate::error::LinearError;
use crate::norm::largest;
use crate::problem::{Kept, Problem, Values};
use crate::residual::Residual;
use crate::solver::{Iterative, LinearSolver, SolveReport};
use crate::sparsity::NONE;

/// Choices of partners for one set of values before the whole problem is solved instead.
const CHOICES: usize = 8;
/// Refinements of one solution.
const REFINEMENTS: usize = 3;
/// What is asked of a correction.
const CORRECTION: f64 = 1e-6;

/// A solver of the condensed system, the direct one unless said.
///
/// # Limits
/// A multiplier that acts on very many dofs, on none that is free, or in a circle with others on each other's partners stays
/// an unknown.
///
/// # Example
/// ```
/// use signorini_linear::sparsity::{BlockPattern, Pattern};
/// use signorini_linear::{Condensed, Direct, LinearSolver, Problem, Symmetry, Values};
///
/// // a spring k = 2 to the ground, whose end a multiplier moves to u = 0.5: k u + λ = 0
/// let bulk = BlockPattern::from_cliques(1, 1, &[0], &[0, 1]);
/// let interface = Pattern::from_cliques(2, &[0, 1], &[0, 2]);
/// let values = Values { bulk: &[2.0], interface: &[0.0, 1.0, 1.0, 0.0] };
/// let mut solver = Condensed::new(Direct::reproducible);
/// solver.analyze(&Problem {
///     ndof: 2,
///     bulk: &bulk,
///     interface: &interface,
///     fields: &[],
///     equation: &[0, 1],
///     nequation: 2,
///     symmetry: Symmetry::Symmetric,
///     sign: &[1, -1],
///     coordinates: &[[0.0; 3]],
///     between: &[],
/// })?;
/// solver.factorize(&values)?;
/// let mut x = [0.0; 2];
/// solver.solve(&values, &[0.0, 0.5], &mut x, 1e-12)?;
/// assert!((x[0] - 0.5).abs() < 1e-12 && (x[1] + 1.0).abs() < 1e-12);
/// # Ok::<(), signorini_linear::LinearError>(())
/// ```
pub struct Condensed<S = Direct> {
    build: fn() -> S,
    inner: S,
    whole: S,
    kept: Option<Kept>,
    multipliers: Multipliers,
    condensation: Option<Condensation>,
    numbers: Numbers,
    /// The values that the numbers belong to.
    seen: Vec<f64>,
    /// Whether the factor is that of the numbers.
    is_new: bool,
    /// Whether the whole problem was factorized last.
    is_whole: bool,
    /// Per raw dof of a multiplier, its partner so far.
    partners: Vec<u32>,
    /// Per raw dof, whether its multiplier stays an unknown.
    stays: Vec<bool>,
    /// Whether the pattern at hand alone has chosen partners.
    by_pattern: bool,
    /// Whether earlier choices are to count no more.
    forgotten: bool,
    residual: Residual,
    r: Vec<f64>,
    x: Vec<f64>,
    b: Vec<f64>,
    y: Vec<f64>,
}

impl<S: LinearSolver> Condensed<S> {
    /// A solver that has not seen a problem yet, over solvers that `build` makes.
    pub fn new(build: fn() -> S) -> Self {
        Self {
            build,
            inner: build(),
            whole: build(),
            kept: None,
            multipliers: Multipliers::default(),
            condensation: None,
            numbers: Numbers::default(),
            seen: Vec::new(),
            is_new: false,
            is_whole: false,
            partners: Vec::new(),
            stays: Vec::new(),
            by_pattern: true,
            forgotten: true,
            residual: Residual::new(0, 0),
            r: Vec::new(),
            x: Vec::new(),
            b: Vec::new(),
            y: Vec::new(),
        }
    }

    /// Multipliers that do not reach the factor: known or eliminated.
    #[must_use]
    pub fn neliminated(&self) -> usize {
        let condensation = self.condensation.as_ref().filter(|_| !self.is_whole);
        condensation.map_or(0, Condensation::neliminated)
    }

    #[cfg(test)]
    pub(crate) fn inner(&self) -> &S {
        &self.inner
    }

    /// Chooses partners; without values, by the pattern.
    fn choose(&mut self, values: Option<&Values>) {
        self.condensation = None;
        if let Some(kept) = &self.kept {
            let (stays, partners) = (&self.stays, &mut self.partners);
            let groups = self.multipliers.groups(kept, values, stays, partners);
            for group in &groups {
                for (&m, &d) in group.multiplier.iter().zip(group.partner.iter().cycle()) {
                    partners[m as usize] = kept.node_of(d);
                }
            }
            if !groups.is_empty() {
                self.condensation = Some(Condensation::new(kept, &self.multipliers, groups));
            }
        }
    }

    /// Chooses partners by the pattern and analyzes the condensed system.
    fn begin(&mut self) -> Result<(), LinearError> {
        self.by_pattern = self.forgotten;
        if std::mem::take(&mut self.forgotten) {
            self.partners.fill(NONE);
            self.stays.fill(false);
        }
        self.seen.clear();
        self.choose(None);
        self.is_whole = self.condensation.is_none();
        if self.is_whole {
            self.analyze_whole()
        } else {
            self.analyze_inner()
        }
    }

    fn analyze_inner(&mut self) -> Result<(), LinearError> {
        match (&self.condensation, &self.kept) {
            (Some(condensation), Some(kept)) => self.inner.analyze(&condensation.problem(kept)),
            _ => Ok(()),
        }
    }

    fn analyze_whole(&mut self) -> Result<(), LinearError> {
        match &self.kept {
            Some(kept) => self.whole.analyze(&kept.problem()),
            None => Err(LinearError::Order { before: "analyze" }),
        }
    }

    /// Eliminates; false where no choice of partners serves.
    fn eliminate(&mut self, values: &Values) -> Result<bool, LinearError> {
        let mut changed = false;
        for _ in 0..CHOICES {
            let (Some(kept), Some(condensation)) = (&self.kept, &mut self.condensation) else {
                return Ok(false);
            };
            let numbers = &mut self.numbers;
            self.by_pattern &= !changed;
            let outcome = condensation
                .eliminate(kept, &self.multipliers, values, numbers)
                .and_then(|()| condensation.fill(kept, values, numbers));
            match outcome {
                Ok(()) => {
                    self.seen.clear();
                    self.seen.extend_from_slice(values.interface);
                    if changed {
                        self.analyze_inner()?;
                    }
                    return Ok(true);
                }
                Err(Refusal::Pattern) => condensation.grow(kept, numbers),
                Err(Refusal::Partner) => self.choose(Some(values)),
                Err(Refusal::Stay(multipliers)) => {
                    multipliers
                        .iter()
                        .for_each(|&m| self.stays[m as usize] = true);
                    self.choose(Some(values));
                }
            }
            changed = true;
        }
        self.condensation = None;
        Ok(false)
    }

    fn factorize_whole(&mut self, values: &Values) -> Result<(), LinearError> {
        self.is_whole = true;
        self.analyze_whole()?;
        self.whole.factorize(values)
    }

    /// Makes the numbers those of the values at hand; false where the present partners do not serve them.
    fn follow(&mut self, values: &Values) -> bool {
        let (Some(kept), Some(condensation)) = (&self.kept, &self.condensation) else {
            return false;
        };
        let numbers = &mut self.numbers;
        if self.seen == values.interface && condensation.is_of(values, numbers) {
            return true;
        }
        self.is_new = false;
        self.seen.clear();
        let outcome = condensation
            .eliminate(kept, &self.multipliers, values, numbers)
            .and_then(|()| condensation.fill(kept, values, numbers));
        if outcome.is_ok() {
            self.seen.extend_from_slice(values.interface);
        }
        outcome.is_ok()
    }

    /// One solution of the condensed system, added to `x`.
    fn correct(
        &mut self,
        values: &Values,
        right: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        let (Some(kept), Some(condensation)) = (&self.kept, &self.condensation) else {
            return Err(LinearError::Order { before: "analyze" });
        };
        let inner_values = Values {
            bulk: values.bulk,
            interface: &self.numbers.interface,
        };
        let dofs = kept.equation.iter().enumerate();
        let equations = || dofs.clone().filter(|(_, e)| **e != NONE);
        self.r.fill(0.0);
        equations().for_each(|(d, &e)| self.r[d] = right[e as usize]);
        let numbers = &self.numbers;
        let (r, raw) = (&mut self.r, &mut self.x);
        condensation.reduce(kept, &self.multipliers, values, numbers, r, raw);
        self.b.clear();
        let inside = condensation.equation.iter().zip(r.iter());
        self.b
            .extend(inside.filter(|(e, _)| **e != NONE).map(|(_, r)| *r));
        self.y.clear();
        self.y.resize(self.b.len(), 0.0);
        let report = self
            .inner
            .solve(&inner_values, &self.b, &mut self.y, rtol)?;
        equations().for_each(|(d, &e)| r[d] = right[e as usize]);
        condensation.expand(numbers, &self.y, r, raw);
        equations().for_each(|(d, &e)| x[e as usize] += raw[d]);
        Ok(report)
    }

    fn refine(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        let wanted = largest(rhs);
        if !wanted.is_finite() {
            return Err(LinearError::NotFinite);
        }
        x.fill(0.0);
        let mut report = SolveReport::default();
        if wanted == 0.0 {
            return Ok(report);
        }
        report.residual = 1.0;
        let mut right = rhs.to_vec();
        let mut best = x.to_vec();
        for refinement in 0..=REFINEMENTS {
            let asked = if refinement == 0 { rtol } else { CORRECTION };
            let inner = self.correct(values, &right, x, asked)?;
            report.iterations += inner.iterations;
            report.refinements += inner.refinements + usize::from(refinement > 0);
            report.negative_pivots = inner.negative_pivots;
            let Some(kept) = &self.kept else { break };
            self.residual.measure(kept, values, rhs, x);
            let residual = largest(&self.residual.value) / wanted;
            if !residual.is_finite() {
                return Err(LinearError::NotFinite);
            }
            let gain = residual / report.residual;
            if gain < 1.0 {
                report.residual = residual;
                best.copy_from_slice(x);
            }
            if report.residual <= rtol || (refinement > 0 && gain > 0.5) {
                break;
            }
            right.copy_from_slice(&self.residual.value);
        }
        x.copy_from_slice(&best);
        let symmetric = self.condensation.as_ref().filter(|c| c.is_symmetric());
        report.negative_pivots += symmetric.map_or(0, Condensation::neliminated);
        let Some(kept) = &self.kept else {
            return Err(LinearError::Order { before: "analyze" });
        };
        if report.residual <= rtol
            || report.residual <= self.residual.round_off(kept, values, x) / wanted
        {
            Ok(report)
        } else {
            Err(LinearError::Inaccurate {
                residual: report.residual,
                wanted: rtol,
            })
        }
    }
}

impl<S: LinearSolver> LinearSolver for Condensed<S> {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        let same = |kept: &Kept| kept.is(problem) && kept.equation.len() == problem.ndof;
        if self.kept.as_ref().is_some_and(same) {
            return Ok(());
        }
        problem.check()?;
        let (build, ndof) = (self.build, problem.ndof);
        if self.partners.len() != ndof {
            self.partners = vec![NONE; ndof];
            self.stays = vec![false; ndof];
            self.forgotten = true;
        }
        (self.inner, self.whole) = (build(), build());
        self.residual = Residual::new(ndof, problem.nequation);
        self.r = vec![0.0; ndof];
        self.x = vec![0.0; ndof];
        let kept = Kept::new(problem);
        self.multipliers = Multipliers::new(&kept);
        self.kept = Some(kept);
        let outcome = self.begin();
        if outcome.is_err() {
            self.kept = None;
        }
        outcome
    }

    fn forget(&mut self) {
        self.forgotten = true;
        self.inner.forget();
        self.whole.forget();
    }

    fn iterative(&self) -> Option<&dyn Iterative> {
        None
    }

    fn iterative_mut(&mut self) -> Option<&mut dyn Iterative> {
        None
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        let Some(kept) = &self.kept else {
            return Err(LinearError::Order { before: "analyze" });
        };
        kept.check(values)?;
        if self.forgotten && !self.by_pattern {
            self.begin()?;
        }
        self.forgotten = false;
        if !self.eliminate(values)? {
            return self.factorize_whole(values);
        }
        (self.is_whole, self.is_new) = (false, true);
        let inner_values = Values {
            bulk: values.bulk,
            interface: &self.numbers.interface,
        };
        let outcome = self.inner.factorize(&inner_values);
        match outcome {
            // what holds a body but little may be lost where multipliers are eliminated
            Err(LinearError::Singular { .. }) => self.factorize_whole(values),
            outcome => outcome,
        }
    }

    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        let Some(kept) = &self.kept else {
            return Err(LinearError::Order { before: "analyze" });
        };
        if self.is_whole {
            return self.whole.solve(values, rhs, x, rtol);
        }
        kept.check_solution(values, rhs, x)?;
        if !self.follow(values) {
            return Err(LinearError::Inaccurate {
                residual: 1.0,
                wanted: rtol,
            });
        }
        match self.refine(values, rhs, x, rtol) {
            Err(LinearError::Inaccurate { .. }) if self.is_new => {
                // here, and for as long as the pattern stays
                self.condensation = None;
                self.factorize_whole(values)?;
                self.whole.solve(values, rhs, x, rtol)
            }
            outcome => outcome,
        }
    }
}
