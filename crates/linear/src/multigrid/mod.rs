//! Multigrid on the stiffness of the bodies, and a small direct solution at the interface.
//!
//! ```text
//!   K     stiffness of the bodies     ──aggregate, smooth──▶ hierarchy        kept while it serves
//!   A = K + contact, couplings        ──rows at the interface──▶ block A_II   again with every tangent
//!
//!   M⁻¹ r:   y = A_II⁻¹ r_I    x = V (r − A y)    x_I = A_II⁻¹ (r_I − A_IO x_O)    O: all other equations
//! ```
//!
//! Corners of quadratic elements are a level of their own: there stand the linear elements on the same places, which are
//! aggregated.
//!
//! What holds single unknowns, and is little compared with the bodies, is in the hierarchy and not in the block
//! ([`alone`]): viscous forces on bodies that float would make the block the whole model.
//!
//! Contact never enters the hierarchy, so that no change of contact costs a new one, and no stiffness of contact makes
//! iterations more. The levels represent multipliers by fictitious springs ([`springs`]), updated with every tangent. The
//! smoother is an incomplete factor by blocks of nodes. The hierarchy outlives patterns: it is rebuilt only where the
//! stiffness of the bodies, or their constraints, change. All of it is in single precision, and what only smooths, or leads from level to level, in whole numbers of 16 bits with a unit for each row: iterations stay the same.
//!
//! Multipliers are in the block with all they act on. Where operator and block are positive definite, iterations are by
//! conjugate gradients; elsewhere by minimal residuals, from a start that leaves nothing at the equations of the block,
//! nor does what follows: gaps close exactly, and what is measured are forces away from the interface.
//!
//! Where the hierarchy does not serve (thin bodies, iterations that stay slow), a factor of the stiffness of the bodies
//! stands for it ([`factor`]) for the rest of the run. Where that does not serve either, or in the plane, the direct solver
//! takes over, and says of singular systems what it knows.
//!
//! Sources: Vaněk, Mandel, Brezina, *Computing* 56 (1996) 179–196 (smoothed aggregation); Kothari, Krause, *Comput.
//! Methods Appl. Mech. Engrg.* 2022 (multigrid and contact); the interface apart: Nataf and others, AMG with filtering.

mod aggregation;
mod alone;
mod block;
mod blocks;
mod factor;
mod fine;
mod hierarchy;
mod incomplete;
mod krylov;
mod level;
mod packed;
mod springs;
#[cfg(test)]
mod tests;
mod vectors;

use crate::condensation::Condensed;
use crate::direct::Direct;
use crate::direct::Factor;
use crate::error::LinearError;
use crate::norm::largest;
use crate::operator::apply;
use crate::problem::{Kept, Problem, Symmetry, Values};
use crate::residual::Residual;
use crate::solver::{EXACT, Iterative, LinearSolver, Note, SolveReport, StartStiffness, Why};
use crate::sparsity::{NONE, Pattern};
use alone::touched;
use block::InterfaceBlock;
use blocks::Blocks;
use factor::BodyFactor;
use fine::{Fine, hold};
use hierarchy::Hierarchy;
use krylov::{End, Operators, Stop};
use rayon::prelude::*;
use std::any::Any;

/// Equations from which on multigrid is no slower than a direct solution in space: by Cholesky's factor where the matrix is
/// definite, by L D Lᵀ or LU where it is not. Of the latter, the ten families of `scripts/speed_decks.py` with seeds 3 and 4
/// take 1.30, 1.30 and 1.37 times the processor seconds with `solver.linear = "direct"`, in geometric mean, at 1,500, 2,200 and
/// 3,000 unknowns; slabs take 0.44 to 1.1 times, plates 0.7 to 1.6, and gears, plasticity and quadratic elements 1.5 to 2.5.
pub(crate) const MULTIGRID_FROM: [usize; 2] = [8_000, 1_500];
/// Iterations of one solution, at most.
const ITERATIONS: usize = 200;
/// The norm of the residual says less of the error than that of the energy: a residual that is this much smaller is asked
/// for, and again as long as the preconditioner sees a larger error in it than wanted. Where stiff bodies move soft ones, or
/// where bodies bend, residuals hide large displacements.
const STRICTER: f64 = 0.1;
/// Times that iterations begin for one solution, at most.
const ATTEMPTS: usize = 4;
/// Rebuild the hierarchy when its iterations have grown by this factor since it was new, twice running.
const WORN: f64 = 1.6;
/// Rebuild it when the number of contact nodes that support floating bodies has changed by this factor.
const GROWN: usize = 2;
/// Rebuild it when viscous forces have changed by this factor, if nothing else holds bodies.
const CHANGED: f64 = 10.0;
/// A hierarchy of the bodies at the start serves as long as their stiffness has changed by no more than this part, in
/// about the norm of Frobenius. Iterations where one of two bodies has turned by 0.1 and 0.2, which changes 0.08 and
/// 0.16: 22 and 25, in place of 19 with a hierarchy of their own.
const DRIFTED: f64 = 0.2;
/// Iterations to a power of ten that are never too many.
const LEAST: f64 = 4.0;
/// Iterations to a power of ten that are too many with a hierarchy of the start, whatever it took before.
const MOST: f64 = 8.0;

/// Multigrid over direct solution.
pub struct Multigrid {
    /// Equations below which the direct solver is used, where the matrix is symmetric and where it is not.
    least: [usize; 2],
    direct: Condensed<Direct>,
    kept: Option<Kept>,
    grid: Option<Grid>,
    /// Whether a factor of the bodies stands for their hierarchy.
    wants_factor: bool,
    /// What has the present values.
    way: Option<Way>,
    residual: Residual,
    notes: Vec<Note>,
}

/// What solves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Grid,
    Direct,
}

/// What serves one problem.
pub(crate) struct Grid {
    fine: Fine,
    hierarchy: Option<Hierarchy>,
    /// What stands for the hierarchy once that has not served.
    factor: BodyFactor,
    has_factor: bool,
    /// The fingerprint of the stiffness that the hierarchy was made of, and whether it is that of this increment.
    source: u64,
    is_proven: bool,
    /// Rows of bodies that float which are held by springs in the hierarchy.
    springs: Vec<u32>,
    /// The mean of what holds single unknowns of these bodies there, over their stiffness.
    damping: f64,
    start: Start,
    /// Whether iterations did not come to an end in this increment: the next ones would not, either.
    has_failed: bool,
    block: InterfaceBlock,
    numbers: Numbers,
    work: Work,
    /// Iterations to a power of ten of the first solution with the hierarchy, and how often it took too many since.
    base: Option<f64>,
    /// That of the last solution.
    rate: f64,
    worn: usize,
}

/// What is known of the stiffness at the start of the run: a hierarchy of it is the same in every run, resumed or not.
#[derive(Default)]
struct Start {
    /// Which one was given.
    which: Option<u64>,
    /// What was given, until the next values come.
    told: Option<StartStiffness>,
    /// It times a vector of signs: the change of this is about that of the stiffness.
    response: Vec<f64>,
    /// Whether the present hierarchy is made of it.
    is_in_use: bool,
}

/// Vectors.
#[derive(Default)]
struct Work {
    raw_x: Vec<f64>,
    raw_y: Vec<f64>,
    right: Vec<f64>,
    b: Vec<[f32; 3]>,
    x: Vec<[f32; 3]>,
}

/// Where equations are elsewhere.
#[derive(Default)]
struct Numbers {
    /// The raw dof of each equation.
    raw: Vec<u32>,
    /// The unknown of the finest level that is each equation, or `NONE`.
    fine: Vec<u32>,
    /// The equations of each row of the finest level, or `NONE`.
    of_row: Vec<[u32; 3]>,
}

impl Numbers {
    fn new(kept: &Kept, fine: &Fine) -> Self {
        let nequation = kept.sign.len();
        let (mut raw, mut unknown) = (vec![NONE; nequation], vec![NONE; nequation]);
        for (dof, &e) in kept
            .equation
            .iter()
            .enumerate()
            .filter(|(_, e)| **e != NONE)
        {
            raw[e as usize] = dof as u32;
        }
        let of_node = |node: &u32| [0, 1, 2].map(|axis| kept.equation[3 * *node as usize + axis]);
        let of_row: Vec<[u32; 3]> = fine.node.iter().map(of_node).collect();
        for (k, &e) in of_row.as_flattened().iter().enumerate() {
            if e != NONE {
                unknown[e as usize] = k as u32;
            }
        }
        Self {
            raw,
            fine: unknown,
            of_row,
        }
    }
}

/// Entries handled by one task.
const CHUNK: usize = 8192;

/// Sets all entries of a vector, in parallel.
fn fill<T: Send, U: Sync>(to: &mut [T], from: &[U], value: impl Fn(&U) -> T + Sync) {
    let chunks = to.par_chunks_mut(CHUNK).zip(from.par_chunks(CHUNK));
    chunks.for_each(|(to, from)| {
        for (to, from) in to.iter_mut().zip(from) {
            *to = value(from);
        }
    });
}

impl Default for Multigrid {
    fn default() -> Self {
        Self::new()
    }
}

impl Multigrid {
    /// A solver that has not seen a problem yet.
    #[must_use]
    pub fn new() -> Self {
        Self::from_sizes([0; 2])
    }

    /// The same, which leaves problems with fewer equations to the direct solver: definite ones, and those that are not.
    #[must_use]
    pub fn from_sizes(least: [usize; 2]) -> Self {
        Self {
            least,
            direct: Condensed::new(Direct::reproducible),
            kept: None,
            grid: None,
            wants_factor: false,
            way: None,
            residual: Residual::new(0, 0),
            notes: Vec::new(),
        }
    }

    /// Whether the hierarchy is in use.
    #[cfg(test)]
    pub(crate) fn is_multigrid(&self) -> bool {
        self.way == Some(Way::Grid)
    }

    /// How many equations are solved directly, at the interface.
    #[cfg(test)]
    pub(crate) fn nblock(&self) -> usize {
        let grid = self.grid.as_ref();
        grid.map_or(0, |grid| grid.block.whole.len())
    }

    /// Whether the hierarchy is that of the stiffness at the start.
    #[cfg(test)]
    pub(crate) fn is_of_start(&self) -> bool {
        self.grid.as_ref().is_some_and(|grid| grid.start.is_in_use)
    }

    fn go_direct(&mut self, values: &Values) -> Result<(), LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        self.way = None;
        self.direct.analyze(&kept.problem())?;
        self.direct.factorize(values)?;
        self.way = Some(Way::Direct);
        Ok(())
    }
}

impl LinearSolver for Multigrid {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        if self.kept.as_ref().is_some_and(|kept| kept.is(problem)) {
            return Ok(());
        }
        (self.way, self.kept) = (None, None);
        problem.check()?;
        let kept = Kept::new(problem);
        let suits = suits(problem, self.least);
        self.wants_factor = self.experience() > 0;
        let grid = self.grid.take().filter(|_| suits);
        self.grid = match grid {
            Some(mut grid) if grid.fine.is_of(&kept) => {
                grid.follow(&kept);
                Some(grid)
            }
            _ if suits => Some(Grid::new(&kept)).filter(|grid| !grid.fine.node.is_empty()),
            _ => None,
        };
        if let Some(grid) = &mut self.grid {
            grid.has_factor = self.wants_factor;
        }
        self.residual = Residual::new(problem.ndof, problem.nequation);
        self.kept = Some(kept);
        Ok(())
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        self.way = None;
        kept.check(values)?;
        // without a branch for each value
        let is_finite = |some: &[f64]| some.iter().fold(true, |all, v| all & v.is_finite());
        let chunks = |all| <[f64]>::par_chunks(all, CHUNK);
        if !chunks(values.bulk)
            .chain(chunks(values.interface))
            .all(is_finite)
        {
            return Err(LinearError::NotFinite);
        }
        let serves = match &mut self.grid {
            Some(grid) if !grid.has_failed => grid.update(kept, values, &mut self.notes)?,
            _ => false,
        };
        if !serves {
            return self.go_direct(values);
        }
        self.way = Some(Way::Grid);
        Ok(())
    }

    fn forget(&mut self) {
        self.direct.forget();
        if let Some(grid) = &mut self.grid {
            grid.forget();
        }
    }

    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        self.solve_by(values, rhs, x, Wanted::Residual(rtol))
    }

    fn iterative(&self) -> Option<&dyn Iterative> {
        Some(self)
    }

    fn iterative_mut(&mut self) -> Option<&mut dyn Iterative> {
        Some(self)
    }
}

impl Iterative for Multigrid {
    fn iterates(&self) -> bool {
        self.grid.as_ref().is_some_and(|grid| !grid.has_failed)
    }

    fn solve_to(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        part: f64,
        enough: f64,
    ) -> Result<SolveReport, LinearError> {
        self.solve_by(values, rhs, x, Wanted::Part { part, enough })
    }

    fn wants_start(&self, id: u64) -> bool {
        self.grid.as_ref().is_some_and(|grid| {
            let start = &grid.start;
            let is_at_hand = start.is_in_use || start.told.is_some();
            let is_known = start.which == Some(id) && is_at_hand;
            let suits = grid.fine.floating.is_empty() && !grid.has_failed && !grid.has_factor;
            suits && !grid.is_proven && !is_known
        })
    }

    fn start_from(&mut self, id: u64, bulk: StartStiffness) {
        let (Some(grid), Some(kept)) = (&mut self.grid, &self.kept) else {
            return;
        };
        let suits = match &bulk {
            StartStiffness::Always => false,
            StartStiffness::Next => true,
            StartStiffness::Values(values) => values.len() == kept.bulk.nvalue(),
        };
        if suits {
            (grid.start.which, grid.start.told) = (Some(id), Some(bulk));
        } else {
            grid.start = Start::default();
        }
    }

    fn experience(&self) -> u8 {
        let has_factor = self.grid.as_ref().is_some_and(|grid| grid.has_factor);
        u8::from(self.wants_factor || has_factor)
    }

    fn recall(&mut self, experience: u8) {
        self.wants_factor = experience > 0;
        if let Some(grid) = &mut self.grid {
            grid.has_factor = self.wants_factor;
        }
    }

    fn bequeath(&mut self) -> Option<Box<dyn Any + Send>> {
        (self.kept, self.way) = (None, None);
        let mut grid = self.grid.take()?;
        grid.forget();
        // a hierarchy is known by the fingerprint of its stiffness, or is that of the start
        if !grid.start.is_in_use {
            grid.start = Start::default();
        }
        grid.has_factor = false;
        Some(Box::new(grid))
    }

    fn inherit(&mut self, heritage: Box<dyn Any + Send>) {
        let Ok(grid) = heritage.downcast::<Grid>() else {
            return;
        };
        // nothing is known of the present problem: the grid serves if it suits that
        (self.kept, self.way) = (None, None);
        self.grid = Some(*grid);
    }

    fn notes(&mut self) -> Vec<Note> {
        std::mem::take(&mut self.notes)
    }
}

/// When a solution is good enough.
#[derive(Clone, Copy, Debug)]
enum Wanted {
    /// The true relative residual.
    Residual(f64),
    /// The part of the error that may stay, in the norm of the energy or, where there is none, of the residual; and the
    /// largest entry of a residual that may stay in any case.
    Part { part: f64, enough: f64 },
}

impl Multigrid {
    fn solve_by(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        wanted: Wanted,
    ) -> Result<SolveReport, LinearError> {
        let kept = self.kept.as_ref();
        let kept = kept.ok_or(LinearError::Order { before: "analyze" })?;
        kept.check_solution(values, rhs, x)?;
        let rtol = match wanted {
            Wanted::Residual(rtol) => rtol,
            Wanted::Part { .. } => EXACT,
        };
        match (&mut self.grid, self.way) {
            (_, None) => Err(LinearError::Order {
                before: "factorize",
            }),
            (Some(grid), Some(Way::Grid)) => {
                let residual = &mut self.residual;
                let mut lost = 0;
                let why = loop {
                    let why = match grid.solve(kept, values, rhs, x, wanted, residual)? {
                        Ok(report) => return Ok(report.after(lost)),
                        Err(why) => why,
                    };
                    let Why::Slow { iterations } = why else {
                        break why;
                    };
                    lost += iterations;
                    if !grid.improve(kept, values, why, &mut self.notes)? {
                        break why;
                    }
                };
                self.notes.push(Note::Direct { why });
                grid.has_failed = true;
                self.go_direct(values)?;
                let report = self.direct.solve(values, rhs, x, rtol)?;
                Ok(report.after(lost))
            }
            _ => self.direct.solve(values, rhs, x, rtol),
        }
    }
}

/// A number that two lists of values share where they are the same, bit by bit, and hardly otherwise.
fn fingerprint(values: &[f64]) -> u64 {
    const CHUNK: usize = 1 << 16;
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |sum: u64, bits: u64| (sum.rotate_left(23) ^ bits).wrapping_mul(FACTOR);
    let chunks = values.par_chunks(CHUNK);
    let of_chunk = |chunk: &[f64]| chunk.iter().fold(FACTOR, |sum, v| mix(sum, v.to_bits()));
    let sums: Vec<u64> = chunks.map(of_chunk).collect();
    sums.into_iter().fold(values.len() as u64, mix)
}

impl Grid {
    fn new(kept: &Kept) -> Self {
        let fine = Fine::new(kept);
        let nrow = fine.node.len();
        let mut grid = Self {
            fine,
            hierarchy: None,
            factor: BodyFactor::new(),
            has_factor: false,
            source: 0,
            is_proven: false,
            springs: Vec::new(),
            damping: 0.0,
            start: Start::default(),
            has_failed: false,
            block: InterfaceBlock::new(),
            numbers: Numbers::default(),
            work: Work {
                b: vec![[0.0; 3]; nrow],
                x: vec![[0.0; 3]; nrow],
                ..Work::default()
            },
            base: None,
            rate: 0.0,
            worn: 0,
        };
        grid.follow(kept);
        grid
    }

    /// Takes note of another interface, with other equations.
    fn follow(&mut self, kept: &Kept) {
        self.block = InterfaceBlock::new();
        self.numbers = Numbers::new(kept, &self.fine);
        self.work.raw_x = vec![0.0; kept.equation.len()];
        self.work.raw_y = vec![0.0; kept.equation.len()];
        self.work.right = vec![0.0; kept.sign.len()];
    }

    /// Forgets how it served.
    fn forget(&mut self) {
        (self.is_proven, self.has_failed) = (false, false);
        (self.base, self.worn) = (None, 0);
        self.factor.expire();
        self.block.forget();
    }

    /// Where contact holds what nothing else does.
    fn springs(&self, kept: &Kept, values: &Values) -> Vec<u32> {
        if self.fine.floating.is_empty() {
            return Vec::new();
        }
        let touched = touched(kept, values);
        let is_touched = |&row: &u32| touched[self.fine.node[row as usize] as usize];
        self.fine
            .floating
            .iter()
            .copied()
            .filter(is_touched)
            .collect()
    }

    /// The stiffness of the bodies times a vector of signs.
    fn signed(&mut self, kept: &Kept, bulk: &[f64]) -> Vec<f64> {
        const FACTOR: u32 = 0x9e37_79b9;
        let sign = |dof: u32| {
            let bits = (dof ^ dof >> 15).wrapping_mul(FACTOR);
            if bits >> 31 == 0 { 1.0 } else { -1.0 }
        };
        let signs = self.work.raw_x.iter_mut().zip(0..);
        signs.for_each(|(x, dof)| *x = sign(dof));
        let interface = Pattern::empty(kept.interface.nrow);
        let values = Values {
            bulk,
            interface: &[],
        };
        let mut response = vec![0.0; self.work.raw_x.len()];
        apply(
            &kept.bulk,
            &interface,
            &values,
            &self.work.raw_x,
            &mut response,
        );
        response
    }

    /// Lets the hierarchy of the start serve where the stiffness is not far from that, and makes it where there is none.
    fn go_from_start(&mut self, kept: &Kept, values: &Values) -> Option<Note> {
        let start = self.start.told.take();
        if !self.start.is_in_use && start.is_none() {
            return None;
        }
        let now = self.signed(kept, values.bulk);
        let told = match &start {
            Some(StartStiffness::Values(bulk)) => Some((bulk.as_slice(), self.signed(kept, bulk))),
            Some(StartStiffness::Next) => Some((values.bulk, now.clone())),
            Some(StartStiffness::Always) | None => None,
        };
        let bulk = told.map(|(bulk, response)| {
            self.start.is_in_use &= response == self.start.response;
            self.start.response = response;
            bulk
        });
        let pairs = now.iter().zip(&self.start.response);
        let change: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
        let size: f64 = self.start.response.iter().map(|b| b * b).sum();
        let is_near = change <= DRIFTED * DRIFTED * size;
        self.start.is_in_use &= is_near;
        let bulk = bulk.filter(|_| is_near && !self.start.is_in_use)?;
        let values = Values {
            bulk,
            interface: values.interface,
        };
        let matrix = self.fine.matrix(kept, &values);
        // their memory serves the levels
        drop(start);
        let (new, note) = self.build(&matrix, None)?;
        self.hierarchy = Some(new);
        self.start.is_in_use = true;
        Some(note)
    }

    /// The hierarchy of a matrix, and what to say of it.
    fn build(&self, matrix: &Blocks<3, 3>, worn: Option<[f64; 2]>) -> Option<(Hierarchy, Note)> {
        let Fine {
            modes,
            parts,
            corners,
            ..
        } = &self.fine;
        let new = Hierarchy::new(matrix, modes, parts, corners.as_ref())?;
        let note = Note::Hierarchy {
            unknowns: 3 * self.fine.node.len(),
            levels: new.nlevel(),
            worn,
        };
        Some((new, note))
    }

    /// Makes a hierarchy where there is none, where it is worn, and where that of another increment is not what this
    /// one would have made.
    fn renew(&mut self, kept: &Kept, values: &Values) -> Option<Note> {
        if !self.is_proven {
            let note = self.go_from_start(kept, values);
            if self.start.is_in_use {
                (self.is_proven, self.source) = (true, 0);
                (self.base, self.worn) = (None, 0);
                return note;
            }
        }
        let is_worn = self.worn > 1;
        let springs = self.springs(kept, values);
        let [few, many] = [&springs, &self.springs].map(Vec::len);
        let (few, many) = (few.min(many), few.max(many));
        let damping = alone::strength(kept, values, &self.fine);
        // where springs hold bodies, it does not matter
        let (weak, strong) = (damping.min(self.damping), damping.max(self.damping));
        let is_like = !springs.is_empty() || strong <= CHANGED * weak;
        if self.hierarchy.is_some() && self.is_proven && !is_worn && many <= GROWN * few && is_like
        {
            return None;
        }
        let source = fingerprint(values.bulk);
        let is_same = self.source == source && self.springs == springs && self.damping == damping;
        let worn = self.base.filter(|_| is_worn).map(|base| [self.rate, base]);
        // that of an increment before is not known to a run that is resumed here
        let of_increment = std::mem::replace(&mut self.is_proven, true);
        (self.source, self.springs, self.damping) = (source, springs, damping);
        (self.base, self.worn) = (None, 0);
        if is_same && self.hierarchy.is_some() {
            return None;
        }
        let mut matrix = self.fine.matrix(kept, values);
        hold(&mut matrix, &self.springs);
        alone::add(kept, values, &self.fine, &mut matrix);
        let (new, note) = self.build(&matrix, worn).unzip();
        let before = self.hierarchy.take().filter(|_| of_increment);
        self.start.is_in_use &= new.is_none() && before.is_some();
        self.hierarchy = new.or(before);
        note
    }

    /// Makes a hierarchy of these values in place of that of the start.
    fn make_anew(&mut self, kept: &Kept, values: &Values) -> Option<Note> {
        self.start.is_in_use = false;
        self.hierarchy = None;
        let note = self.renew(kept, values);
        self.hold(kept, values);
        note
    }

    /// Takes a better preconditioner for the bodies, where there is one: a hierarchy, or a factor, of the present values.
    ///
    /// # Errors
    /// Those of the direct solver.
    fn improve(
        &mut self,
        kept: &Kept,
        values: &Values,
        why: Why,
        notes: &mut Vec<Note>,
    ) -> Result<bool, LinearError> {
        if self.start.is_in_use {
            // where the stiffness has changed here and there, that of the start may not serve
            notes.extend(self.make_anew(kept, values));
            return Ok(true);
        }
        self.factor.expire();
        self.factorize(kept, values, why, notes)
    }

    /// Makes a factor of the bodies where that at hand does not serve, and lets it stand for the hierarchy. Answers whether
    /// there is a new one.
    ///
    /// # Errors
    /// Those of the direct solver but `Singular`.
    fn factorize(
        &mut self,
        kept: &Kept,
        values: &Values,
        why: Why,
        notes: &mut Vec<Note>,
    ) -> Result<bool, LinearError> {
        if kept.is_definite() {
            // that of everything is no larger
            return Ok(false);
        }
        // its memory serves the factor
        (self.hierarchy, self.start) = (None, Start::default());
        match self.factor.update(kept, values, &self.fine) {
            Ok(is_new) => {
                if !std::mem::replace(&mut self.has_factor, true) {
                    let numbers = self.factor.numbers();
                    notes.push(Note::Factor { numbers, why });
                }
                Ok(is_new)
            }
            Err(LinearError::Singular { .. }) => Ok(false),
            Err(other) => Err(other),
        }
    }

    /// Takes the values of a tangent; false where they do not suit.
    fn update(
        &mut self,
        kept: &Kept,
        values: &Values,
        notes: &mut Vec<Note>,
    ) -> Result<bool, LinearError> {
        if !self.has_factor {
            notes.extend(self.renew(kept, values));
        }
        if self.hierarchy.is_none() {
            self.factorize(kept, values, Why::NotPositive, notes)?;
        }
        let why = match &mut self.hierarchy {
            None if self.factor.is_there() => match self.block.update(kept, values) {
                Ok(()) => return Ok(true),
                Err(LinearError::Singular { .. }) => Why::Interface,
                Err(other) => return Err(other),
            },
            None => Why::NotPositive,
            Some(hierarchy) => {
                let (block, fine) = (&mut self.block, &self.fine);
                // either has much that one thread does alone
                let (updated, ()) = rayon::join(
                    || block.update(kept, values),
                    || hierarchy.hold(springs::rows(kept, values, fine)),
                );
                match updated {
                    Ok(()) => return Ok(true),
                    Err(LinearError::Singular { .. }) => Why::Interface,
                    Err(other) => return Err(other),
                }
            }
        };
        self.has_failed = true;
        notes.push(Note::Direct { why });
        Ok(false)
    }

    /// Lets the hierarchy know of what multipliers hold together.
    fn hold(&mut self, kept: &Kept, values: &Values) {
        if let Some(hierarchy) = &mut self.hierarchy {
            hierarchy.hold(springs::rows(kept, values, &self.fine));
        }
    }

    /// Solves, or says why iterations are not the way.
    fn solve(
        &mut self,
        kept: &Kept,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        wanted: Wanted,
        residual: &mut Residual,
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
        let mut size = kept.largest_at_displacements(rhs);
        if symmetric {
            residual.value.copy_from_slice(rhs);
        } else {
            self.block.after(rhs, x)?;
            residual.measure(kept, values, rhs, x);
            size = size.max(kept.largest_at_displacements(&residual.value));
        }
        let part = match wanted {
            Wanted::Residual(rtol) => rtol,
            Wanted::Part { part, .. } if symmetric => part,
            Wanted::Part { part, .. } => STRICTER * part,
        };
        for attempt in 0..ATTEMPTS {
            let most = ITERATIONS.saturating_sub(report.iterations);
            let stop = match wanted {
                Wanted::Residual(_) => Stop::Largest(0.5 * part * size),
                Wanted::Part { enough, .. } => Stop::Part {
                    part: if attempt == 0 { part } else { STRICTER },
                    enough,
                },
            };
            let mut operators = OneGrid {
                grid: self,
                kept,
                values,
                symmetric,
            };
            let iterate = if symmetric {
                krylov::conjugate_gradients
            } else {
                krylov::minimal_residuals
            };
            let (end, count) = iterate(&mut operators, &mut residual.value, x, stop, most)?;
            report.iterations += count;
            let iterations = report.iterations;
            match end {
                End::Small => {}
                End::Slow => return Ok(Err(Why::Slow { iterations })),
                End::Indefinite => return Ok(Err(Why::Indefinite)),
            }
            residual.measure(kept, values, rhs, x);
            let left = largest(&residual.value);
            report.residual = if left > 0.0 { left / size } else { 0.0 };
            report.refinements = attempt;
            let done = match wanted {
                Wanted::Residual(_) => {
                    report.residual <= part || left <= residual.round_off(kept, values, x)
                }
                Wanted::Part { .. } if symmetric || count == 0 => true,
                Wanted::Part { part, .. } => {
                    let mut error = vec![0.0; x.len()];
                    operators.precondition(&residual.value, &mut error)?;
                    report.iterations += 1;
                    kept.largest_at_displacements(&error) <= part * kept.largest_at_displacements(x)
                }
            };
            if done {
                let part = match wanted {
                    Wanted::Residual(_) => part,
                    Wanted::Part { enough, .. } => part.max(enough / size),
                };
                self.judge(part, report.iterations);
                return Ok(Ok(report));
            }
        }
        let iterations = report.iterations;
        Ok(Err(Why::Slow { iterations }))
    }

    /// Keeps count of how well the hierarchy serves, by its iterations to this part of a residual or an error.
    fn judge(&mut self, part: f64, iterations: usize) {
        if self.has_factor {
            self.factor.judge(iterations);
            return;
        }
        let rate = iterations as f64 / (-part.log10()).max(1.0);
        self.rate = rate;
        let base = *self.base.get_or_insert(rate.max(LEAST));
        if self.start.is_in_use && rate > MOST {
            self.worn = 2;
        } else if rate > WORN * base {
            self.worn += 1;
        } else {
            self.worn = 0;
        }
    }
}

/// Whether multigrid is tried on a problem, where it is for no fewer equations: definite ones, and those that are not.
pub(crate) fn suits(problem: &Problem, least: [usize; 2]) -> bool {
    let [definite, others] = least;
    let least = match problem.symmetry {
        Symmetry::Definite => definite,
        Symmetry::Symmetric | Symmetry::Unsymmetric => others,
    };
    problem.bulk.block == 3
        && problem.nequation >= least
        && problem.coordinates.len() == problem.bulk.nrow()
        && !has_shared(problem)
}

/// The size of the factor at the interface of a problem.
///
/// # Errors
/// `TooLarge`.
pub(crate) fn size_of_block(kept: &Kept) -> Result<Factor, LinearError> {
    InterfaceBlock::size(kept)
}

/// Whether dofs share an equation.
fn has_shared(problem: &Problem) -> bool {
    let used = problem.equation.iter().filter(|&&e| e != NONE);
    used.count() > problem.nequation
}

/// The operators of one solution.
struct OneGrid<'a> {
    grid: &'a mut Grid,
    kept: &'a Kept,
    values: &'a Values<'a>,
    symmetric: bool,
}

impl Operators for OneGrid<'_> {
    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        let Grid { work, numbers, .. } = &mut *self.grid;
        let Work { raw_x, raw_y, .. } = work;
        fill(raw_x, &self.kept.equation, |&e| {
            x.get(e as usize).copied().unwrap_or(0.0)
        });
        apply(
            &self.kept.bulk,
            &self.kept.interface,
            self.values,
            raw_x,
            raw_y,
        );
        fill(y, &numbers.raw, |&dof| raw_y[dof as usize]);
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), LinearError> {
        let Grid {
            hierarchy,
            factor,
            block,
            numbers,
            work,
            ..
        } = &mut *self.grid;
        let has_block = !block.whole.is_empty();
        let two_sided = has_block && self.symmetric;
        if two_sided {
            work.right.copy_from_slice(r);
            block.before(&mut work.right)?;
        }
        let right = if two_sided { &work.right } else { r };
        match hierarchy {
            Some(hierarchy) => {
                // single precision has few powers of ten
                let size = largest(right);
                let scale = if size > 0.0 { size } else { 1.0 };
                fill(&mut work.b, &numbers.of_row, |row| {
                    row.map(|e| (right.get(e as usize).copied().unwrap_or(0.0) / scale) as f32)
                });
                hierarchy.cycle(&work.b, &mut work.x);
                let x = work.x.as_flattened();
                fill(z, &numbers.fine, |&unknown| {
                    f64::from(x.get(unknown as usize).copied().unwrap_or(0.0)) * scale
                });
            }
            None => factor.apply(right, &numbers.of_row, &numbers.fine, z)?,
        }
        if has_block {
            block.after(r, z)?;
        }
        Ok(())
    }
}
