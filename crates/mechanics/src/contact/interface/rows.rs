//! Rows, and the forces on them.

use super::carried::{Carried, Ways, carry_on};
use super::{
    Answer, Asked, Contact, Interface, Judged, Lambda, Laws, Order, Participant, RowOrder, Rows,
    Scratch, Sink, State, TermError, Wanted,
};
use crate::contact::discretization::Links;
use crate::contact::kernel::{Target, Traction};
use crate::contact::law::Eval;
use crate::contact::row::Row;
use signorini_geometry::surface::Feature;
use signorini_geometry::tensor::Vec3;
use std::ops::Range;

/// Rounding error of a gap over the coordinates it comes from.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The most rows evaluated together.
const CHUNK: usize = 64;

/// Chunks come in multiples of this, so that a few threads get as many each.
const EVEN: usize = 4;

/// How many times the work of another row one is on which something acts.
const ACTING: usize = 16;

/// Into how many chunks rows are split.
pub(super) fn nchunk(nrow: usize) -> usize {
    match nrow {
        0..=CHUNK => nrow.min(1),
        _ => nrow.div_ceil(CHUNK).next_multiple_of(EVEN),
    }
}

/// Rows of a chunk: all chunks have as many, or one more.
pub(super) fn chunk(chunk: usize, nrow: usize) -> Range<usize> {
    let nchunk = nchunk(nrow).max(1);
    let first = |chunk: usize| (chunk * nrow / nchunk).min(nrow);
    first(chunk)..first(chunk + 1)
}

/// Where each of as many chunks ends if each has as much work, or one row more.
fn even_work(nrow: usize, work: impl Fn(usize) -> usize, ends: &mut Vec<usize>) {
    let nchunk = nchunk(nrow);
    let all: usize = (0..nrow).map(&work).sum();
    ends.clear();
    let mut done = 0;
    for row in 0..nrow {
        done += work(row);
        while ends.len() + 1 < nchunk && done * nchunk >= all * (ends.len() + 1) {
            ends.push(row + 1);
        }
    }
    ends.resize(nchunk, nrow);
}

/// How far rows are wanted for a response.
pub(super) fn row_order(order: Order) -> RowOrder {
    match order {
        Order::Residual => RowOrder::Gradient,
        Order::Tangent => RowOrder::Tangent,
    }
}

impl Interface {
    /// Shares the rows out among chunks so that each has about as many on which something acts: what a chunk has to do
    /// depends on that, and what comes of it does not.
    pub(super) fn share_out(&mut self, trial: &State) {
        let mut ends = std::mem::take(&mut self.shares);
        let work = |row: usize| {
            let is_near = self.now.pairs[row].is_some_and(|pair| pair.gap < 0.0);
            let lambda = self.lambda(row, trial);
            let acts = is_near || lambda.scalar != 0.0 || lambda.vector != Vec3::ZERO;
            if acts { ACTING } else { 1 }
        };
        even_work(self.parts.discretization.nrow(), work, &mut ends);
        self.shares = ends;
    }

    /// The rows of a chunk.
    pub(super) fn share(&self, chunk: usize) -> Range<usize> {
        let end = |chunk: usize| self.shares.get(chunk).copied();
        match end(chunk) {
            Some(last) => chunk.checked_sub(1).and_then(end).unwrap_or(0)..last,
            // before anything was looked for
            None => self::chunk(chunk, self.parts.discretization.nrow()),
        }
    }

    /// Fills a row with what is measured where the sides are; says what it holds.
    pub(super) fn relate(
        &self,
        row: usize,
        trial: &State,
        order: RowOrder,
        rows: &mut Rows,
    ) -> Result<Wanted, TermError> {
        let parts = &self.parts;
        let laws = self.laws();
        // a gap at the end of the increment takes weights, and wear how far rows slide
        let order = match trial.between.is_some() || laws.walks {
            true => order.max(RowOrder::Gradient),
            false => order,
        };
        let wanted = Wanted {
            order,
            slip: (laws.slips() || self.drags() || self.heat().is_some()) && order != RowOrder::Gap,
        };
        let links = Links {
            pairing: &self.now,
            before: &self.before,
            anchors: self.history.anchors(),
            bond: laws.bond,
        };
        parts
            .discretization
            .row(row, &parts.pair, &trial.placement(), &links, wanted, rows)
            .map_err(|e| self.failed(&e))?;
        Ok(wanted)
    }

    /// Fills a row; its gap is what the law sees.
    pub(super) fn fill(
        &self,
        row: usize,
        trial: &State,
        order: RowOrder,
        rows: &mut Rows,
    ) -> Result<(), TermError> {
        let wanted = self.relate(row, trial, order, rows)?;
        let laws = self.laws();
        let start = self.gap_at_start(row);
        if let Some(between) = &trial.between {
            let mut ways = std::mem::take(rows.scratch.of::<Ways>());
            let carried = Carried {
                slips: wanted.slip,
                bond: laws.bond,
                drags: wanted.slip && wanted.order == RowOrder::Tangent && self.drags(),
                conserves: self.conserves(),
                start: start.map(|[start, _]| start),
            };
            let change = carry_on(rows, between, &carried, &mut ways);
            *rows.scratch.of::<Ways>() = ways;
            let viscous = self.viscous(change);
            rows.rows_mut()
                .iter_mut()
                .for_each(|row| row.viscous = viscous);
        }
        let is_between = trial.between.is_some();
        let shift = self.shift(row, trial.time);
        let held = if wanted.slip && self.nmultiplier() > 1 && !laws.bond {
            self.held_directions(row, rows)
        } else {
            [false; 3]
        };
        let lends = self.lents.of(row).is_some();
        if let Some(row) = rows.rows_mut().first_mut() {
            if !is_between {
                row.gap = self.carried_gap(row.number, row.gap, trial.time);
            }
            row.gap += shift;
            row.from = start.filter(|_| is_between).map(|[_, from]| from);
            row.sliding.held = held;
            if self.step.vibrates {
                // a normal that turns has no symmetric part
                row.sliding.dnormal.fill(Vec3::ZERO);
            }
            if laws.bond {
                row.sliding.slip += row.normal * shift;
                row.sliding.free = lends;
            }
            if laws.cohesion.is_some() {
                self.turn_bond(row);
            }
        }
        self.wear_row(row, trial, wanted.order, rows);
        Ok(())
    }

    /// Fills a row where something acts on it; says whether there is one.
    pub(super) fn acting_row(
        &self,
        row: usize,
        trial: &State,
        order: RowOrder,
        rows: &mut Rows,
    ) -> Result<bool, TermError> {
        let laws = self.laws();
        if !self.is_active() || laws.bond && self.now.pairs[row].is_none() {
            rows.start([]);
            return Ok(false);
        }
        if !laws.bond {
            // gaps first: most rows are open and need nothing else
            self.fill(row, trial, RowOrder::Gap, rows)?;
            let lambda = self.lambda(row, trial);
            let acts = |r: &Row| laws.acts(r.seen(), r.normal, &lambda);
            if !rows.rows().iter().any(acts) {
                return Ok(false);
            }
        }
        self.fill(row, trial, order, rows)?;
        Ok(!rows.rows().is_empty())
    }

    /// Asks the laws about these rows. Most rows are open: their gaps are all that is needed of them.
    pub(super) fn ask(
        &self,
        share: Range<usize>,
        trial: &State,
        rows: &mut Rows,
        asked: &mut Asked,
    ) -> Result<(), TermError> {
        let laws = self.laws();
        asked.clear();
        if !self.is_active() || laws.bond {
            share.for_each(|_| asked.push(None));
            return Ok(());
        }
        for row in share.clone() {
            self.fill(row, trial, RowOrder::Gap, rows)?;
            let lambda = self.lambda(row, trial);
            let filled = rows.rows().first();
            asked.push(filled.map(|r| (r.seen(), laws.scalar(r.normal, &lambda))));
        }
        asked.ask(&laws, share.map(|row| self.history.past(row)));
        Ok(())
    }

    /// Fills a row that the laws were asked about where something acts on it; says whether there is one.
    fn answered_row(
        &self,
        (row, answer): (usize, Option<&Answer>),
        trial: &State,
        order: RowOrder,
        rows: &mut Rows,
    ) -> Result<bool, TermError> {
        let of_bond = self.is_active() && self.laws().bond && self.now.pairs[row].is_some();
        let acts = answer.is_some_and(|answer| answer.pressure != Eval::default());
        if !acts && !of_bond {
            rows.start([]);
            return Ok(false);
        }
        self.fill(row, trial, order, rows)?;
        Ok(!rows.rows().is_empty())
    }

    /// What acts on a filled row.
    pub(super) fn traction(&self, row: &Row, lambda: &Lambda) -> Traction {
        self.answered(row, lambda, None)
    }

    /// The same where the laws were asked about it.
    fn answered(&self, row: &Row, lambda: &Lambda, answer: Option<&Answer>) -> Traction {
        let laws = Laws {
            answer,
            ..self.laws_of(row.number)
        };
        laws.traction(row, lambda, self.past(row.number))
    }

    /// Adds forces and stiffness of a row.
    pub(super) fn act(
        &self,
        (row, answer): (usize, Option<&Answer>),
        trial: &State,
        order: Order,
        scratch: &mut Scratch,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let nlambda = self.ncolumn_of_multiplier();
        let acts = self.answered_row((row, answer), trial, row_order(order), &mut scratch.rows)?;
        let is_idle =
            acts && nlambda > 0 && !self.laws().bond && self.acts_on_nothing(&scratch.rows);
        if !acts || is_idle {
            if nlambda > 0 {
                self.release(row, trial, order, scratch, out);
            }
            return Ok(());
        }
        let ncolumn = scratch.rows.ncolumn();
        self.add_forces((row, answer), trial, order, scratch);
        if let Some(share) = self.share_of_end(trial) {
            let all = scratch.force.iter_mut().chain(&mut scratch.stiffness);
            all.for_each(|value| *value *= share);
        }
        scratch.rows.dofs(&self.layout, &mut scratch.dofs);
        self.multiplier_dofs(row, &mut scratch.dofs);
        if let Some(lent) = self.lents.of(row) {
            self.spread(row, lent, self.own_multiplier(row, trial), scratch);
            for &(borrower, _) in &lent.borrowers {
                self.multiplier_dofs(borrower, &mut scratch.dofs);
            }
        }
        out.add(&scratch.dofs, &scratch.force, &scratch.stiffness);
        let rounding = self.rounding(&scratch.rows, trial, answer);
        out.uncertain(&scratch.dofs[..ncolumn], rounding);
        self.allow(row, trial, &scratch.dofs[ncolumn..], out);
        Ok(())
    }

    /// Forces, and stiffness where it is wanted, of the row that the scratch holds.
    pub(super) fn add_forces(
        &self,
        (number, answer): (usize, Option<&Answer>),
        trial: &State,
        order: Order,
        scratch: &mut Scratch,
    ) {
        let width = scratch.rows.ncolumn() + self.ncolumn_of_multiplier();
        scratch.force.clear();
        scratch.force.resize(width, 0.0);
        scratch.stiffness.clear();
        if order == Order::Tangent {
            scratch.stiffness.resize(width * width, 0.0);
        }
        let mut target = Target {
            force: &mut scratch.force,
            stiffness: &mut scratch.stiffness,
        };
        let lambda = self.lambda(number, trial);
        // the tangent is that of the branch that the trial is on, to the last bit
        let (measure, past) = (
            self.measure(number),
            match self.step.vibrates {
                // what slips is at its limit, and goes on slipping
                true => self.past(number),
                false => self.past_of_increment(number),
            },
        );
        let laws = Laws {
            answer,
            ..self.laws_of(number)
        };
        for row in scratch.rows.rows() {
            laws.act(
                row,
                measure,
                &lambda,
                past,
                &mut scratch.derivatives,
                &mut target,
            );
        }
    }

    /// The multiplier of a row on which nothing acts goes to zero.
    fn release(
        &self,
        row: usize,
        trial: &State,
        order: Order,
        scratch: &mut Scratch,
        out: &mut dyn Sink,
    ) {
        let n = self.ncolumn_of_multiplier();
        let slope = -self.measure(row) / self.parts.scale.penalty;
        let lambda = self.own_multiplier(row, trial);
        scratch.force.clear();
        scratch.force.extend((0..n).map(|c| slope * lambda[c]));
        scratch.stiffness.clear();
        if order == Order::Tangent {
            scratch.stiffness.resize(n * n, 0.0);
            (0..n).for_each(|c| scratch.stiffness[c * n + c] = slope);
        }
        scratch.dofs.clear();
        self.multiplier_dofs(row, &mut scratch.dofs);
        out.add(&scratch.dofs, &scratch.force, &scratch.stiffness);
        self.allow(row, trial, &scratch.dofs, out);
    }

    /// Gaps up to the tolerance count as closed, and the residual of a multiplier likewise.
    fn allow(
        &self,
        row: usize,
        trial: &State,
        multipliers: &[crate::system::Dof],
        out: &mut dyn Sink,
    ) {
        let tolerance = self.tolerance(row, &self.lambda(row, trial), trial);
        out.uncertain(multipliers, tolerance * self.measure(row));
    }

    /// What may be left of the equations of a multiplier, as a gap. A traction that is limited by friction is known to a
    /// part of itself, too, but not beyond the rounding of positions, nor where it is no force of account.
    pub(super) fn tolerance(&self, row: usize, lambda: &Lambda, trial: &State) -> f64 {
        if self.parts.bond.is_some() || !self.parts.has_vectors() {
            return self.parts.gap_tolerance;
        }
        let point = self.parts.discretization.point(row);
        let place = point.position(&trial.placement()).max_abs();
        let shear = self.laws_of(row).shear;
        let part = self.parts.traction_tolerance * lambda.vector.norm() / shear;
        let stiffness = shear * self.measure(row);
        let negligible = if stiffness > 0.0 {
            self.negligible / stiffness
        } else {
            0.0
        };
        let left = negligible.max(part + ROUNDING * place);
        self.parts.gap_tolerance.min(left)
    }

    /// The rounding error of the forces of a row: that of the positions times the stiffness of the law.
    pub(super) fn rounding(&self, rows: &Rows, trial: &State, answer: Option<&Answer>) -> f64 {
        let size = |p: &Participant| match *p {
            Participant::Node(node) => trial.x.get(node as usize).map_or(0.0, |x| x.max_abs()),
            Participant::Rigid(body) => {
                let pose = trial.poses.get(body as usize);
                pose.map_or(0.0, |p| p.origin.max_abs())
            }
        };
        let size = rows.participants().iter().map(size).fold(0.0, f64::max);
        let laws = Laws {
            answer,
            ..self.laws()
        };
        let stiffness = |row: &Row| {
            let lambda = self.lambda(row.number, trial);
            let normal = laws.pressure(row.seen(), row.normal, &lambda).dgap.abs();
            let tangential = laws.stick_stiffness(&self.answered(row, &lambda, answer));
            normal.max(tangential) * self.measure(row.number)
        };
        ROUNDING * size * rows.rows().iter().map(stiffness).sum::<f64>()
    }

    /// The potential of a row.
    pub(super) fn energy_of(
        &self,
        row: usize,
        trial: &State,
        rows: &mut Rows,
    ) -> Result<Option<f64>, TermError> {
        if !self.is_active() || self.now.pairs[row].is_none() {
            return Ok(None);
        }
        let laws = self.laws();
        let lambda = self.lambda(row, trial);
        if laws.bond {
            self.fill(row, trial, RowOrder::Gradient, rows)?;
            let filled = rows.rows().first();
            let stretch = filled.map_or(Vec3::ZERO, |r| r.sliding.slip);
            let past = self.past_of_increment(row);
            let stored = filled.map_or(0.0, |r| laws.bond_energy(r, &past));
            return Ok(Some(stored + lambda.vector.dot(stretch)));
        }
        let held = self.history.past(row).limit;
        let order = match held {
            Some(_) => RowOrder::Gradient,
            None => RowOrder::Gap,
        };
        self.fill(row, trial, order, rows)?;
        let Some(row) = rows.rows().first() else {
            return Ok(None);
        };
        let scalar = laws.scalar(row.normal, &lambda);
        let normal = laws.energy_at(row.seen(), scalar);
        let along = match held.filter(|_| laws.acts(row.seen(), row.normal, &lambda)) {
            Some(limit) => laws.friction_energy(row, &lambda, limit),
            None => 0.0,
        };
        Ok(normal.map(|e| e + along))
    }

    /// What a verdict compares, at the present iterate.
    pub(super) fn judge(&self, trial: &State) -> Result<Vec<Judged>, TermError> {
        let mut rows = Rows::default();
        let mut judged = vec![Judged::default(); self.judged.len()];
        let mut asked = Asked::default();
        self.ask(0..judged.len(), trial, &mut rows, &mut asked)?;
        for ((row, judged), answer) in judged.iter_mut().enumerate().zip(asked.answers()) {
            let Some(pair) = &self.now.pairs[row] else {
                continue;
            };
            if !self.answered_row((row, answer), trial, RowOrder::Gradient, &mut rows)? {
                continue;
            }
            let lambda = self.lambda(row, trial);
            let acting = rows.rows().first().map(|r| {
                let traction = self.answered(r, &lambda, answer);
                // what just touches, without pressure, is open to a verdict
                let nothing = r.gap >= 0.0 && traction.pressure <= 0.0 && !self.laws().bond;
                if nothing {
                    (Contact::Open, Vec3::ZERO)
                } else {
                    (traction.state, traction.direction)
                }
            });
            let (state, direction) = acting.unwrap_or_default();
            let feature = match pair.feature {
                Feature::Face => 0,
                Feature::Edge { .. } => 1,
                Feature::Vertex => 2,
            };
            *judged = Judged {
                state,
                facet: Some((pair.anchor.facet, feature)),
                direction,
            };
        }
        Ok(judged)
    }
}

#[cfg(test)]
mod tests {
    use super::{ACTING, CHUNK, EVEN, chunk, even_work, nchunk};

    #[test]
    fn chunks_share_all_rows_evenly() {
        for nrow in [0, 1, 63, 64, 65, 180, 256, 257, 432, 10_007] {
            let chunks: Vec<_> = (0..nchunk(nrow)).map(|k| chunk(k, nrow)).collect();
            let all: Vec<usize> = chunks.iter().cloned().flatten().collect();
            assert_eq!(all, (0..nrow).collect::<Vec<_>>());
            let sizes = chunks.iter().map(ExactSizeIterator::len);
            let (least, most) = (sizes.clone().min(), sizes.max().unwrap_or(0));
            assert!(most <= CHUNK && least.is_none_or(|least| most - least <= 1));
            assert!(chunks.len() <= 1 || chunks.len() % EVEN == 0);
        }
        assert!(chunk(7, 10).is_empty());
    }

    #[test]
    fn chunks_have_as_many_rows_on_which_something_acts() {
        let mut ends = vec![7];
        for (nrow, acting) in [(0, 0..0), (1, 0..1), (40, 3..9), (221, 10..58), (221, 0..0)] {
            let work = |row| if acting.contains(&row) { ACTING } else { 1 };
            even_work(nrow, work, &mut ends);
            assert_eq!(ends.len(), nchunk(nrow));
            assert!(ends.is_sorted() && ends.last().is_none_or(|&last| last == nrow));
            let begins = [0].into_iter().chain(ends.iter().copied());
            let all: usize = (0..nrow).map(work).sum();
            for (begin, &end) in begins.zip(&ends) {
                let share: usize = (begin..end).map(work).sum();
                assert!(share * ends.len() <= all + ACTING * ends.len());
            }
        }
    }
}
