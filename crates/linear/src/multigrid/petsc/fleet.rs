//! One problem over all ranks: rows, hierarchy, the block of the interface, iterations.

use super::super::alone;
use super::super::block::{InterfaceBlock, choose};
use super::super::blocks::Blocks;
use super::super::fine::{Fine, hold};
use super::super::grid::{ATTEMPTS, ITERATIONS, LEAST, Numbers, WORN, Wanted, supports};
use super::super::krylov::{self, End, Operators};
use super::super::springs;
use super::super::values::{Means, fingerprint};
use super::fetched::Neighbourhood;
use super::layout::Layout;
use super::library::Share;
use super::rows::{Operator, of_bodies};
use crate::error::LinearError;
use crate::norm::largest;
use crate::partition::{Partition, failed};
use crate::problem::{Kept, Values};
use crate::residual::Residual;
use crate::solver::{Note, SolveReport, Why};
use signorini_ranks::{Ranks, agree};
use std::sync::Arc;

/// The part of the springs of multipliers that may be other ones before there is a new hierarchy.
const TOLERATED: f64 = 0.5;
/// The change of a spring's stiffness from which on it is another one.
const CHANGED: f64 = 0.1;

/// What serves one problem.
pub(super) struct Fleet {
    ranks: &'static dyn Ranks,
    partition: Arc<Partition>,
    fine: Fine,
    numbers: Numbers,
    layout: Layout,
    operator: Operator,
    share: Share,
    /// Whether the library has the pattern of the operator.
    is_placed: bool,
    block: InterfaceBlock,
    /// The rows of the block.
    neighbourhood: Neighbourhood,
    near: Near,
    hierarchy: Source,
    /// Whether iterations did not come to an end in this increment: the next ones would not, either.
    pub has_failed: bool,
}

/// The equations of the block and those that it is coupled with, as every rank knows them.
#[derive(Default)]
struct Near {
    equation: Vec<u32>,
    /// Their values as they come from the ranks.
    value: Vec<f64>,
    /// The entries of this rank that are among them, each with its equation.
    own: Vec<(usize, usize)>,
    /// Residuals and changes with one entry per equation, of which only these are of use.
    residual: Vec<f64>,
    change: Vec<f64>,
    right: Vec<f64>,
}

/// What the hierarchy was made of, and how it serves.
#[derive(Default)]
struct Source {
    /// The fingerprint of its matrix; none where there is no hierarchy.
    fingerprint: Option<u64>,
    /// The multipliers that act, and the stiffness of their springs.
    springs: Vec<(usize, f64)>,
    is_stale: bool,
    /// Iterations to a power of ten of the first solution with it, and how often it took too many since.
    base: Option<f64>,
    worn: usize,
}

impl Source {
    /// Whether almost all multipliers have about the springs that the hierarchy was made with.
    fn is_held_like(&self, springs: &[(usize, f64)]) -> bool {
        let changes = springs::changes(&self.springs, springs, CHANGED);
        changes as f64 <= TOLERATED * self.springs.len() as f64
    }

    /// Keeps count of how well the hierarchy serves, by its iterations to this part of a residual or an error.
    fn judge(&mut self, part: f64, iterations: usize) {
        let rate = iterations as f64 / (-part.log10()).max(1.0);
        let base = *self.base.get_or_insert(rate.max(LEAST));
        self.worn = if rate > WORN * base { self.worn + 1 } else { 0 };
    }
}

impl Fleet {
    /// One for a problem whose rows are divided like this.
    ///
    /// # Errors
    /// `Library` where PETSc does not start.
    pub fn new(kept: &Kept, partition: &Arc<Partition>) -> Result<Self, LinearError> {
        let fine = Fine::new(kept);
        let numbers = Numbers::new(kept, &fine);
        let layout = Layout::new(kept, &fine, &numbers, partition);
        Ok(Self {
            ranks: partition.ranks(),
            partition: partition.clone(),
            operator: Operator::new(kept, &numbers, &layout),
            share: Share::new()?,
            is_placed: false,
            block: InterfaceBlock::new(),
            neighbourhood: Neighbourhood::default(),
            near: Near::default(),
            hierarchy: Source::default(),
            has_failed: false,
            fine,
            numbers,
            layout,
        })
    }

    /// Whether bodies deform.
    pub fn has_rows(&self) -> bool {
        !self.fine.node.is_empty()
    }

    /// Whether it is that of a problem, whatever its interface.
    pub fn is_of(&self, kept: &Kept) -> bool {
        self.fine.is_of(kept)
    }

    /// Takes note of another interface, with other equations.
    pub fn follow(&mut self, kept: &Kept) {
        self.numbers = Numbers::new(kept, &self.fine);
        self.layout = Layout::new(kept, &self.fine, &self.numbers, &self.partition);
        self.operator = Operator::new(kept, &self.numbers, &self.layout);
        self.is_placed = false;
        self.block = InterfaceBlock::new();
        self.near = Near::default();
    }

    /// Forgets how it served.
    pub fn forget(&mut self) {
        self.has_failed = false;
        self.hierarchy.is_stale = true;
        (self.hierarchy.base, self.hierarchy.worn) = (None, 0);
        self.block.forget();
    }

    /// Takes the values of a tangent; false where they do not suit.
    ///
    /// # Errors
    /// Those of the direct solver but `Singular`, `Library`.
    pub fn update(
        &mut self,
        kept: &Kept,
        values: &Values,
        notes: &mut Vec<Note>,
    ) -> Result<bool, LinearError> {
        self.operator.update(kept, values);
        if self.is_placed {
            self.share.set_values(&self.operator.rows)?;
        } else {
            self.share.set_operator(&self.operator.rows)?;
            self.is_placed = true;
        }
        let means = self.means(kept, values)?;
        let touched = alone::touched(kept, values, Means::Known(&means));
        let supports = supports(&self.fine, &touched);
        let outcome = self.update_block(kept, values, touched)?;
        self.agree_on(&outcome)?;
        match outcome {
            Ok(()) => {}
            Err(LinearError::Singular { .. }) => {
                let why = Why::Interface;
                self.has_failed = true;
                notes.push(Note::Alone { why });
                return Ok(false);
            }
            Err(other) => return Err(other),
        }
        self.ask(kept)?;
        notes.extend(self.renew(kept, values, &means, &supports)?);
        Ok(true)
    }

    /// How stiff each node is, on whatever rank its row is.
    fn means(&self, kept: &Kept, values: &Values) -> Result<Vec<f64>, LinearError> {
        let mut means = vec![0.0; kept.bulk.nrow()];
        for &node in self.partition.own() {
            means[node as usize] = Means::Here(kept, values).of(node as usize);
        }
        self.partition.complete(1, [&mut means])?;
        Ok(means)
    }

    /// Chooses the equations of the block, fetches their rows and factorizes: what that comes to on this rank.
    ///
    /// # Errors
    /// `Library` where messages fail.
    fn update_block(
        &mut self,
        kept: &Kept,
        values: &Values,
        touched: Vec<bool>,
    ) -> Result<Result<(), LinearError>, LinearError> {
        let (partition, neighbourhood) = (&self.partition, &mut self.neighbourhood);
        neighbourhood.restart();
        let chosen = choose(kept, touched, |nodes| {
            let rows = neighbourhood.rows(&kept.bulk, partition, nodes)?;
            Ok(rows.pattern.column.to_vec())
        })?;
        let rows = neighbourhood.rows(&kept.bulk, partition, &chosen.0)?;
        rows.update(partition, values.bulk)?;
        let near = Values {
            bulk: &rows.values,
            interface: values.interface,
        };
        Ok(self.block.update_at(kept, &rows.pattern, &near, chosen))
    }

    /// Checks that all ranks have come to the same end of what each does by itself: memory may have ended on one.
    fn agree_on(&self, outcome: &Result<(), LinearError>) -> Result<(), LinearError> {
        let kind = match outcome {
            Ok(()) => 0,
            Err(LinearError::Singular { .. }) => 1,
            Err(_) => 2,
        };
        match agree(self.ranks, kind) {
            Ok(true) => Ok(()),
            Ok(false) if kind == 2 => outcome.clone(),
            Ok(false) => Err(LinearError::Library {
                name: "a solver on another rank",
                code: kind as i32,
                detail: 0,
            }),
            Err(error) => Err(failed(&error)),
        }
    }

    /// Lets the library know which entries the block needs.
    fn ask(&mut self, kept: &Kept) -> Result<(), LinearError> {
        let mut equation = [self.block.whole.as_slice(), self.block.coupled()].concat();
        equation.sort_unstable();
        equation.dedup();
        if equation == self.near.equation && !self.near.residual.is_empty() {
            return Ok(());
        }
        let numbers: Vec<i32> = equation
            .iter()
            .map(|&e| self.layout.number[e as usize] as i32)
            .collect();
        self.share.ask(&numbers)?;
        let nequation = kept.sign.len();
        let own = self.layout.own.iter().enumerate();
        let own = own.filter(|(_, e)| equation.binary_search(e).is_ok());
        self.near = Near {
            value: vec![0.0; equation.len()],
            own: own.map(|(k, &e)| (k, e as usize)).collect(),
            residual: vec![0.0; nequation],
            change: vec![0.0; nequation],
            right: vec![0.0; nequation],
            equation,
        };
        Ok(())
    }

    /// Makes a hierarchy where there is none, where it is worn, and where that of another increment is not what this one
    /// would have made.
    fn renew(
        &mut self,
        kept: &Kept,
        values: &Values,
        means: &[f64],
        supports: &[u32],
    ) -> Result<Option<Note>, LinearError> {
        let means = Means::Known(means);
        let (rows, springs) = springs::rows_and_strengths(kept, values, means, &self.fine);
        let source = &mut self.hierarchy;
        let serves = source.fingerprint.is_some() && !source.is_stale && source.worn < 2;
        if serves && source.is_held_like(&springs) {
            return Ok(None);
        }
        source.springs = springs;
        source.is_stale = false;
        let mut matrix = self.fine.matrix(kept, values);
        hold(&mut matrix, supports);
        alone::add(kept, values, &self.fine, &mut matrix);
        if let Some(rows) = rows {
            matrix = matrix.plus(&springs::stiffness(&rows));
        }
        let fingerprint = fingerprint(matrix.value.as_flattened().as_flattened());
        (source.base, source.worn) = (None, 0);
        let is_same = source.fingerprint.replace(fingerprint) == Some(fingerprint);
        if self.partition.is_on_all(is_same)? {
            return Ok(None);
        }
        self.set_bodies(&matrix)?;
        Ok(Some(Note::Hierarchy {
            unknowns: 3 * self.fine.node.len(),
            levels: self.share.levels()?,
            worn: None,
        }))
    }

    fn set_bodies(&mut self, matrix: &Blocks<3, 3>) -> Result<(), LinearError> {
        let rows = of_bodies(matrix, &self.layout);
        let own = || {
            self.layout
                .rows
                .iter()
                .map(|&row| self.fine.modes[row as usize])
        };
        let motion = |k: usize| own().flat_map(move |motions| motions.map(|axis| axis[k]));
        let modes: Vec<f64> = (0..6).flat_map(motion).collect();
        self.share.set_bodies(&rows, &modes)
    }

    /// Solves, or says why iterations are not the way.
    ///
    /// # Errors
    /// `NotFinite`, those of the direct solver, `Library`.
    pub fn solve(
        &mut self,
        kept: &Kept,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        wanted: Wanted,
    ) -> Result<Result<SolveReport, Why>, LinearError> {
        if !largest(rhs).is_finite() {
            return Err(LinearError::NotFinite);
        }
        x.fill(0.0);
        let mut report = SolveReport::default();
        if largest(rhs) == 0.0 {
            return Ok(Ok(report));
        }
        let symmetric = kept.is_definite();
        let part = wanted.part(symmetric);
        let n = self.layout.own.len();
        let (mut right, mut own, mut r) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        self.layout.take(rhs, &mut right);
        let mut size = kept.largest_at_displacements(rhs);
        if !symmetric && !self.block.whole.is_empty() {
            self.block.after(rhs, x)?;
            self.layout.take(x, &mut own);
        }
        let nrank = self.ranks.size();
        let mut at = AtRanks {
            fleet: self,
            symmetric,
            right: vec![0.0; n],
            numbers: vec![0.0; nrank],
            counts: vec![1; nrank],
            fault: None,
        };
        at.residual(&right, &own, &mut r)?;
        size = size.max(at.largest_at_displacements(kept, &r));
        for attempt in 0..ATTEMPTS {
            let most = ITERATIONS.saturating_sub(report.iterations);
            let stop = wanted.stop(part, size, attempt);
            let iterate = if symmetric {
                krylov::conjugate_gradients
            } else {
                krylov::minimal_residuals
            };
            let (end, count) = iterate(&mut at, &mut r, &mut own, stop, most)?;
            at.fault.take().map_or(Ok(()), Err)?;
            report.iterations += count;
            let iterations = report.iterations;
            match end {
                End::Small => {}
                End::Slow => return Ok(Err(Why::Slow { iterations })),
                End::Indefinite => return Ok(Err(Why::Indefinite)),
            }
            at.residual(&right, &own, &mut r)?;
            let left = at.of_ranks(largest(&r), krylov::larger);
            report.residual = if left > 0.0 { left / size } else { 0.0 };
            report.refinements = attempt;
            let done = match wanted {
                Wanted::Residual(_) if report.residual <= part => true,
                Wanted::Residual(_) => {
                    at.gather(&own, x)?;
                    let mut of_rows = Residual::new(kept.equation.len(), x.len());
                    let round_off = of_rows.round_off(kept, values, x);
                    left <= at.of_ranks(round_off, krylov::larger)
                }
                Wanted::Part { .. } if symmetric || count == 0 => true,
                Wanted::Part { part, .. } => {
                    let mut error = vec![0.0; n];
                    at.precondition(&r, &mut error)?;
                    report.iterations += 1;
                    at.largest_at_displacements(kept, &error)
                        <= part * at.largest_at_displacements(kept, &own)
                }
            };
            at.fault.take().map_or(Ok(()), Err)?;
            if done {
                at.gather(&own, x)?;
                let part = match wanted {
                    Wanted::Residual(_) => part,
                    Wanted::Part { enough, .. } => part.max(enough / size),
                };
                self.hierarchy.judge(part, report.iterations);
                return Ok(Ok(report));
            }
        }
        let iterations = report.iterations;
        Ok(Err(Why::Slow { iterations }))
    }
}

/// The operators of one solution: vectors are the entries of this rank.
struct AtRanks<'a> {
    fleet: &'a mut Fleet,
    symmetric: bool,
    /// What hierarchies are applied to.
    right: Vec<f64>,
    /// One number of each rank, and how many each sends.
    numbers: Vec<f64>,
    counts: Vec<usize>,
    /// The first error of a call that cannot return one.
    fault: Option<LinearError>,
}

impl AtRanks<'_> {
    /// `r = b − A x`
    fn residual(&mut self, b: &[f64], x: &[f64], r: &mut [f64]) -> Result<(), LinearError> {
        self.fleet.share.multiply(x, r)?;
        r.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
        Ok(())
    }

    fn largest_at_displacements(&mut self, kept: &Kept, v: &[f64]) -> f64 {
        let own = self.fleet.layout.own.iter().zip(v);
        let sign = |e: u32| kept.sign.get(e as usize).copied().unwrap_or(0);
        let at = own.filter(|(e, _)| sign(**e) > 0);
        let own = at.fold(0.0, |most: f64, (_, v)| most.max(v.abs()));
        self.of_ranks(own, krylov::larger)
    }

    /// One number of each rank, combined in their order.
    fn of_ranks(&mut self, own: f64, combine: fn(f64, f64) -> f64) -> f64 {
        let ranks = self.fleet.ranks;
        if ranks.size() == 1 {
            return own;
        }
        match ranks.all_gather(&[own], &self.counts, &mut self.numbers) {
            Ok(()) => self.numbers.iter().copied().reduce(combine).unwrap_or(own),
            Err(error) => {
                self.fault.get_or_insert(failed(&error));
                f64::NAN
            }
        }
    }

    /// The entries of all ranks, by equations.
    fn gather(&mut self, own: &[f64], x: &mut [f64]) -> Result<(), LinearError> {
        let Layout { counts, number, .. } = &self.fleet.layout;
        let mut all = vec![0.0; self.fleet.layout.total()];
        let gathered = self.fleet.ranks.all_gather(own, counts, &mut all);
        gathered.map_err(|error| failed(&error))?;
        for (x, &n) in x.iter_mut().zip(number) {
            *x = all.get(n as usize).copied().unwrap_or(0.0);
        }
        Ok(())
    }
}

impl Operators for AtRanks<'_> {
    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        if let Err(error) = self.fleet.share.multiply(x, y) {
            self.fault.get_or_insert(error);
            y.fill(f64::NAN);
        }
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), LinearError> {
        let Fleet {
            layout,
            share,
            block,
            near,
            ..
        } = &mut *self.fleet;
        let has_block = !block.whole.is_empty();
        let nbody = layout.nbody();
        let right = &mut self.right;
        right.copy_from_slice(r);
        if has_block {
            share.answer(r, &mut near.value)?;
            spread(&near.equation, &near.value, &mut near.residual);
        }
        if has_block && self.symmetric {
            near.right.copy_from_slice(&near.residual);
            block.before(&mut near.right)?;
            for &(k, e) in &near.own {
                right[k] = near.right[e];
            }
        }
        z.fill(0.0);
        if !share.cycle(&right[..nbody], &mut z[..nbody])? {
            // the other ranks, whose cycles may have gone well, learn of it by what is no number
            z.fill(f64::NAN);
        }
        if has_block {
            share.answer(z, &mut near.value)?;
            spread(&near.equation, &near.value, &mut near.change);
            block.after(&near.residual, &mut near.change)?;
            for &(k, e) in &near.own {
                z[k] = near.change[e];
            }
        }
        Ok(())
    }

    fn together(&mut self, own: f64, combine: fn(f64, f64) -> f64) -> f64 {
        self.of_ranks(own, combine)
    }
}

/// Puts what came from the ranks where the block looks for it, in a list with one entry per equation.
fn spread(equation: &[u32], value: &[f64], to: &mut [f64]) {
    for (&e, v) in equation.iter().zip(value) {
        to[e as usize] = *v;
    }
}
