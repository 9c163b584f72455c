//! What solves one problem by multigrid: the fine level, a hierarchy or a factor below it, and the block at the interface.

use super::alone::{self, touched};
use super::block::InterfaceBlock;
use super::blocks::Blocks;
use super::factor::BodyFactor;
use super::fine::{Fine, hold};
use super::hierarchy::Hierarchy;
use super::krylov::{self, End, Operators, Stop};
use super::nodal::{Component, Units, components};
use super::springs;
use super::values::{Means, fill, fingerprint};
use crate::error::LinearError;
use crate::norm::largest;
use crate::operator::apply;
use crate::problem::{Kept, Values};
use crate::residual::Residual;
use crate::solver::{Note, SolveReport, StartStiffness, Why};
use crate::sparsity::{NONE, Pattern};

/// Iterations of one solution, at most.
pub(super) const ITERATIONS: usize = 200;

/// The norm of the residual says less of the error than that of the energy: a residual that is this much smaller is asked
/// for, and again as long as the preconditioner sees a larger error in it than wanted. Where stiff bodies move soft ones, or
/// where bodies bend, residuals hide large displacements.
pub(super) const STRICTER: f64 = 0.1;

/// Times that iterations begin for one solution, at most.
pub(super) const ATTEMPTS: usize = 4;

/// Rebuild the hierarchy when its iterations have grown by this factor since it was new, twice running.
pub(super) const WORN: f64 = 1.6;

/// Rebuild it when the number of contact nodes that support floating bodies has changed by this factor.
pub(super) const GROWN: usize = 2;

/// Rebuild it when viscous forces have changed by this factor, if nothing else holds bodies.
pub(super) const CHANGED: f64 = 10.0;

/// A hierarchy of the bodies at the start serves as long as their stiffness has changed by no more than this part, in
/// about the norm of Frobenius. Iterations where one of two bodies has turned by 0.1 and 0.2, which changes 0.08 and
/// 0.16: 22 and 25, in place of 19 with a hierarchy of their own.
pub(super) const DRIFTED: f64 = 0.2;

/// Iterations to a power of ten that are never too many.
pub(super) const LEAST: f64 = 4.0;

/// Iterations to a power of ten that are too many with a hierarchy of the start, whatever it took before.
pub(super) const MOST: f64 = 8.0;

/// What serves one problem.
pub(crate) struct Grid {
    pub(super) fine: Fine,
    pub(super) hierarchy: Option<Hierarchy<3>>,
    /// What stands for the hierarchy once that has not served.
    pub(super) factor: BodyFactor,
    pub(super) has_factor: bool,
    /// The fingerprint of the stiffness that the hierarchy was made of, and whether it is that of this increment.
    pub(super) source: u64,
    pub(super) is_proven: bool,
    /// Rows of bodies that float which are held by springs in the hierarchy.
    pub(super) springs: Vec<u32>,
    /// The mean of what holds single unknowns of these bodies there, over their stiffness.
    pub(super) damping: f64,
    pub(super) start: Start,
    /// Whether iterations did not come to an end in this increment: the next ones would not, either.
    pub(super) has_failed: bool,
    pub(super) block: InterfaceBlock,
    /// The components of other fields of the nodes.
    pub(super) components: Vec<Component>,
    pub(super) units: Units,
    pub(super) numbers: Numbers,
    pub(super) work: Work,
    /// Iterations to a power of ten of the first solution with the hierarchy, and how often it took too many since.
    pub(super) base: Option<f64>,
    /// That of the last solution.
    pub(super) rate: f64,
    pub(super) worn: usize,
}

/// The initial stiffness, as far as known: a hierarchy of it is the same in every run, resumed or not.
#[derive(Default)]
pub(super) struct Start {
    /// Which one was given.
    pub(super) which: Option<u64>,
    /// What was given, until the next values come.
    pub(super) told: Option<StartStiffness>,
    /// It times a vector of signs: the change of this is about that of the stiffness.
    pub(super) response: Vec<f64>,
    /// Whether the present hierarchy is made of it.
    pub(super) is_in_use: bool,
}

/// Vectors.
#[derive(Default)]
pub(super) struct Work {
    pub(super) raw_x: Vec<f64>,
    pub(super) raw_y: Vec<f64>,
    pub(super) right: Vec<f64>,
    /// Changes of other fields, and what they leave.
    pub(super) of_fields: [Vec<f64>; 2],
    pub(super) b: Vec<[f32; 3]>,
    pub(super) x: Vec<[f32; 3]>,
}

/// Where equations are elsewhere.
#[derive(Default)]
pub(super) struct Numbers {
    /// The raw dof of each equation.
    pub(super) raw: Vec<u32>,
    /// The unknown of the finest level that is each equation, or `NONE`.
    pub(super) fine: Vec<u32>,
    /// The equations of each row of the finest level, or `NONE`.
    pub(super) of_row: Vec<[u32; 3]>,
}

impl Numbers {
    pub(super) fn new(kept: &Kept, fine: &Fine) -> Self {
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

/// When a solution is good enough.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted {
    /// The true relative residual.
    Residual(f64),
    /// The part of the error that may stay, in the norm of the energy or, where there is none, of the residual; and the
    /// largest entry of a residual that may stay in any case.
    Part { part: f64, enough: f64 },
}

impl Wanted {
    /// The part of a residual or an error that is asked for, by conjugate gradients or by minimal residuals.
    pub(super) fn part(self, symmetric: bool) -> f64 {
        match self {
            Self::Residual(rtol) => rtol,
            Self::Part { part, .. } if symmetric => part,
            Self::Part { part, .. } => STRICTER * part,
        }
    }

    /// When iterations stop in an attempt, if this part is asked for and residuals are compared with this size.
    pub(super) fn stop(self, part: f64, size: f64, attempt: usize) -> Stop {
        match self {
            Self::Residual(_) => Stop::Largest(0.5 * part * size),
            Self::Part { enough, .. } => Stop::Part {
                part: if attempt == 0 { part } else { STRICTER },
                enough,
            },
        }
    }
}

/// Rows of bodies that float where contact holds what nothing else does.
pub(super) fn supports(fine: &Fine, touched: &[bool]) -> Vec<u32> {
    let is_touched = |&row: &u32| touched[fine.node[row as usize] as usize];
    fine.floating.iter().copied().filter(is_touched).collect()
}

impl Grid {
    pub(super) fn new(kept: &Kept) -> Self {
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
            components: Vec::new(),
            units: Units::default(),
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

    /// Whether there is anything that a hierarchy serves: bodies that deform, or another field of theirs.
    pub(super) fn has_rows(&self) -> bool {
        self.deforms() || !self.components.is_empty()
    }

    /// Whether bodies deform.
    fn deforms(&self) -> bool {
        !self.fine.node.is_empty()
    }

    /// Takes note of another interface, with other equations.
    pub(super) fn follow(&mut self, kept: &Kept) {
        self.block = InterfaceBlock::new();
        self.components = components(kept);
        self.numbers = Numbers::new(kept, &self.fine);
        self.work.raw_x = vec![0.0; kept.equation.len()];
        self.work.raw_y = vec![0.0; kept.equation.len()];
        self.work.right = vec![0.0; kept.sign.len()];
    }

    /// Forgets how it served.
    pub(super) fn forget(&mut self) {
        (self.is_proven, self.has_failed) = (false, false);
        (self.base, self.worn) = (None, 0);
        self.factor.expire();
        self.block.forget();
    }

    /// The stiffness of the bodies times a vector of signs.
    pub(super) fn signed(&mut self, kept: &Kept, bulk: &[f64]) -> Vec<f64> {
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
    pub(super) fn go_from_start(&mut self, kept: &Kept, values: &Values) -> Option<Note> {
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
    pub(super) fn build(
        &self,
        matrix: &Blocks<3, 3>,
        worn: Option<[f64; 2]>,
    ) -> Option<(Hierarchy<3>, Note)> {
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
    pub(super) fn renew(&mut self, kept: &Kept, values: &Values) -> Option<Note> {
        if !self.is_proven {
            let note = self.go_from_start(kept, values);
            if self.start.is_in_use {
                (self.is_proven, self.source) = (true, 0);
                (self.base, self.worn) = (None, 0);
                return note;
            }
        }
        let is_worn = self.worn > 1;
        let springs = match self.fine.floating.is_empty() {
            true => Vec::new(),
            false => supports(
                &self.fine,
                &touched(kept, values, Means::Here(kept, values)),
            ),
        };
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
    pub(super) fn make_anew(&mut self, kept: &Kept, values: &Values) -> Option<Note> {
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
    pub(super) fn improve(
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
    pub(super) fn factorize(
        &mut self,
        kept: &Kept,
        values: &Values,
        why: Why,
        notes: &mut Vec<Note>,
    ) -> Result<bool, LinearError> {
        if kept.is_definite() || !self.deforms() {
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
    pub(super) fn update(
        &mut self,
        kept: &Kept,
        values: &Values,
        notes: &mut Vec<Note>,
    ) -> Result<bool, LinearError> {
        if !self.components.is_empty() {
            self.units.update(kept, values);
            let mut components = self.components.iter_mut();
            if !components.all(|component| component.update(kept, values)) {
                let why = Why::NotPositive;
                self.has_failed = true;
                notes.push(Note::Direct { why });
                return Ok(false);
            }
        }
        if !self.has_factor && self.deforms() {
            notes.extend(self.renew(kept, values));
        }
        if self.hierarchy.is_none() {
            self.factorize(kept, values, Why::NotPositive, notes)?;
        }
        let needs_none = !self.deforms() || self.factor.is_there();
        let why = match &mut self.hierarchy {
            None if needs_none => match self.block.update(kept, values) {
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
    pub(super) fn hold(&mut self, kept: &Kept, values: &Values) {
        if let Some(hierarchy) = &mut self.hierarchy {
            hierarchy.hold(springs::rows(kept, values, &self.fine));
        }
    }

    /// Solves, or says why iterations are not the way.
    pub(super) fn solve(
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
        let size = self.start(kept, values, rhs, x, residual)?;
        // errors of several fields have no norm in common
        let wanted = match wanted {
            Wanted::Part { part, .. } if !self.units.is_empty() => {
                Wanted::Residual(STRICTER * part)
            }
            other => other,
        };
        let part = wanted.part(symmetric);
        for attempt in 0..ATTEMPTS {
            let most = ITERATIONS.saturating_sub(report.iterations);
            let stop = wanted.stop(part, size, attempt);
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
            operators.grid.units.reduce(&mut residual.value);
            operators.grid.units.restore(x);
            let (end, count) = iterate(&mut operators, &mut residual.value, x, stop, most)?;
            operators.grid.units.reduce(x);
            report.iterations += count;
            let iterations = report.iterations;
            match end {
                End::Small => {}
                End::Slow => return Ok(Err(Why::Slow { iterations })),
                End::Indefinite => return Ok(Err(Why::Indefinite)),
            }
            residual.measure(kept, values, rhs, x);
            operators.grid.units.reduce(&mut residual.value);
            let left = largest(&residual.value);
            operators.grid.units.restore(&mut residual.value);
            report.residual = if left > 0.0 { left / size } else { 0.0 };
            report.refinements = attempt;
            let done = match wanted {
                Wanted::Residual(_) => {
                    report.residual <= part
                        || left <= {
                            let units = &operators.grid.units;
                            residual.round_off_in(kept, values, x, |e| units.of(e))
                        }
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

    /// Begins with the solution of the block of the interface, and measures units and residual; returns the size to which
    /// residuals are compared.
    fn start(
        &mut self,
        kept: &Kept,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        residual: &mut Residual,
    ) -> Result<f64, LinearError> {
        let mut size = kept.largest_at_displacements(rhs);
        if kept.is_definite() || self.block.whole.is_empty() {
            residual.value.copy_from_slice(rhs);
        } else {
            self.block.after(rhs, x)?;
            residual.measure(kept, values, rhs, x);
            size = size.max(kept.largest_at_displacements(&residual.value));
        }
        self.units
            .measure(&self.components, kept, [rhs, &residual.value]);
        Ok(if self.units.is_empty() { size } else { 1.0 })
    }

    /// Keeps count of how well the hierarchy serves, by its iterations to this part of a residual or an error.
    pub(super) fn judge(&mut self, part: f64, iterations: usize) {
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

/// The operators of one solution.
pub(super) struct OneGrid<'a> {
    pub(super) grid: &'a mut Grid,
    pub(super) kept: &'a Kept,
    pub(super) values: &'a Values<'a>,
    pub(super) symmetric: bool,
}

impl OneGrid<'_> {
    fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
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

    /// Changes of other fields, and what they leave of the residuals of the bodies: fields first, as temperatures move bodies more
    /// than bodies change temperatures.
    fn fields(&mut self, r: &[f64]) -> Option<[Vec<f64>; 2]> {
        if self.symmetric || self.grid.components.is_empty() || !self.grid.deforms() {
            return None;
        }
        let [mut z, mut left] = std::mem::take(&mut self.grid.work.of_fields);
        z.clear();
        z.resize(r.len(), 0.0);
        left.resize(r.len(), 0.0);
        for component in &mut self.grid.components {
            component.apply(r, &mut z);
        }
        self.multiply(&z, &mut left);
        left.iter_mut()
            .zip(r)
            .for_each(|(left, r)| *left = r - *left);
        Some([z, left])
    }

    fn cycle(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), LinearError> {
        let fields = self.fields(r);
        let Grid {
            hierarchy,
            factor,
            block,
            components,
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
        let right = match &fields {
            Some([_, left]) => left,
            None if two_sided => work.right.as_slice(),
            None => r,
        };
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
            None if numbers.of_row.is_empty() => z.fill(0.0),
            None => factor.apply(right, &numbers.of_row, &numbers.fine, z)?,
        }
        match fields {
            Some(fields) => {
                components.iter().for_each(|of| of.copy(&fields[0], z));
                work.of_fields = fields;
            }
            None => components.iter_mut().for_each(|of| of.apply(right, z)),
        }
        if has_block {
            block.after(r, z)?;
        }
        Ok(())
    }
}

impl Operators for OneGrid<'_> {
    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        if self.grid.units.is_empty() {
            return self.multiply(x, y);
        }
        let restored = self.grid.units.divided(x);
        self.multiply(&restored, y);
        self.grid.units.keep(restored);
        self.grid.units.reduce(y);
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), LinearError> {
        if self.grid.units.is_empty() {
            return self.cycle(r, z);
        }
        let restored = self.grid.units.multiplied(r);
        let outcome = self.cycle(&restored, z);
        self.grid.units.keep(restored);
        self.grid.units.restore(z);
        outcome
    }

    fn together(&mut self, own: f64, _: fn(f64, f64) -> f64) -> f64 {
        own
    }
}
