//! A fluid between the sides, which presses them apart where it has come to.
//!
//! ```text
//! f = −w P b        K = −w P ∂b/∂d        energy −P w g                                          (E13)
//! ```
//!
//! in addition to (E1) and (E2), with the same weights: both sides carry equal and opposite loads whatever the meshes. The pressure
//! P is that of the time, which grows from nothing on a point that the fluid has just reached.
//!
//! The fluid is where points are *wet*. From the nodes that are given it goes on from point to point of the secondary side
//! that are open, or whose contact pressure is at most the critical one. That is found where an increment has converged, which
//! then goes on, until the front stays. A point that is wet stays wet for the rest of the increment; it dries at its end where the contact
//! pressure is well above the critical one.
//!
//! Limits: P acts where a point meets the other side. A face that is apart from it, further than the reach, takes a load of its own.

use super::front::Passages;
use super::means::mean;
use super::wet::{Critical, Fluid, Wet, Wetting};
use super::{Interface, Order, Rows, Scratch, Sink, State, TermError, Verdict};
use crate::contact::row::RowOrder;
use crate::system::{Archive, ArchiveError, ContactFrame, FluidFrame};
use signorini_geometry::surface::Carrier;

/// What presses a point dry, over the critical pressure.
const DRY: f64 = 1.05;

impl Interface {
    /// Where the fluid is when an increment begins.
    pub(super) fn begin_fluid(&mut self, from: &State) -> Result<(), TermError> {
        let Some(fluid) = &self.parts.fluid else {
            return Ok(());
        };
        let mut wetting = std::mem::take(&mut self.wetting);
        if wetting.passages.is_none() {
            let rows = self.parts.discretization.as_ref();
            wetting.passages = Some(Passages::new(rows, &self.parts.pair, from.placement().x));
        }
        if wetting.accepted.is_empty() && self.is_active() {
            let seeds = self.seeds(fluid, wetting.passages.as_ref());
            wetting.accepted = vec![Wet::default(); self.parts.discretization.nrow()];
            for row in seeds {
                if let Some(wet) = wetting.accepted.get_mut(row as usize) {
                    *wet = Wet {
                        since: Some([from.time; 2]),
                        is_seed: true,
                    };
                }
            }
            if !wetting.accepted.iter().any(|wet| wet.is_seed) {
                let name = &self.parts.name;
                return Err(TermError::Refused {
                    message: format!(
                        "contact \"{name}\": no point of it is at the nodes that its fluid comes from, or opposite to facets \
                         that have them"
                    ),
                });
            }
        }
        wetting.reject();
        self.wetting = wetting;
        Ok(())
    }

    /// The rows where the fluid is from the start.
    fn seeds(&self, fluid: &Fluid, passages: Option<&Passages>) -> Vec<u32> {
        let of_secondary = fluid
            .seeds
            .iter()
            .filter_map(|node| Some(passages?.at_node(*node)));
        let mut seeds: Vec<u32> = of_secondary.flatten().copied().collect();
        let surface = self.parts.pair.primary.as_ref();
        let averaged = self.parts.discretization.capabilities().averaged;
        let has_seed = |facet: &u32| match surface.carrier(*facet) {
            Carrier::Nodes(nodes) => nodes.iter().any(|n| fluid.seeds.binary_search(n).is_ok()),
            _ => false,
        };
        let mut facets = Vec::new();
        for row in 0..self.now.pairs.len() {
            self.facets_of(row, averaged, &mut facets);
            if facets.iter().any(has_seed) {
                seeds.push(row as u32);
            }
            facets.clear();
        }
        seeds
    }

    /// The pressure of the fluid at a time.
    fn pressure_of_fluid(&self, time: f64) -> f64 {
        let Some(fluid) = &self.parts.fluid else {
            return 0.0;
        };
        let step = &self.step;
        match (fluid.pressures.get(step.number), fluid.pressures.last()) {
            (Some([from, to]), _) => {
                let part = ((time - step.start) / step.duration).clamp(0.0, 1.0);
                from + (to - from) * part
            }
            (None, last) => last.map_or(0.0, |[_, end]| *end),
        }
    }

    /// The pressure of the fluid on a row.
    fn fluid_on(&self, row: usize, time: f64) -> f64 {
        let wet = self.wetting.trial.get(row);
        let share = wet.map_or(0.0, |wet| wet.share(time));
        if share == 0.0 || !self.is_active() || self.now.pairs[row].is_none() {
            return 0.0;
        }
        share * self.pressure_of_fluid(time)
    }

    /// Adds (E13) of a row.
    pub(super) fn add_fluid(
        &self,
        row: usize,
        trial: &State,
        order: Order,
        scratch: &mut Scratch,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let pressure = self.fluid_on(row, trial.time);
        if pressure == 0.0 {
            return Ok(());
        }
        self.fill(row, trial, super::rows::row_order(order), &mut scratch.rows)?;
        let Some(filled) = scratch.rows.rows().first() else {
            return Ok(());
        };
        let scaled = -pressure * self.area(row);
        let times = |values: &[f64], to: &mut Vec<f64>| {
            to.clear();
            to.extend(values.iter().map(|value| scaled * value));
        };
        times(&filled.weights, &mut scratch.force);
        scratch.stiffness.clear();
        if order == Order::Tangent {
            times(&filled.dweights, &mut scratch.stiffness);
        }
        scratch.rows.dofs(&self.layout, &mut scratch.dofs);
        out.add(&scratch.dofs, &scratch.force, &scratch.stiffness);
        Ok(())
    }

    /// The energy of (E13) of a row.
    pub(super) fn fluid_energy(
        &self,
        row: usize,
        trial: &State,
        rows: &mut Rows,
    ) -> Result<f64, TermError> {
        let pressure = self.fluid_on(row, trial.time);
        if pressure == 0.0 {
            return Ok(0.0);
        }
        self.fill(row, trial, RowOrder::Gap, rows)?;
        let gap = rows.rows().first().map_or(0.0, |filled| filled.gap);
        Ok(-pressure * self.area(row) * gap)
    }

    /// The contact pressure of a row: 0 where it is open.
    fn contact_pressure(
        &self,
        row: usize,
        state: &State,
        rows: &mut Rows,
    ) -> Result<f64, TermError> {
        if !self.acting_row(row, state, RowOrder::Gradient, rows)? {
            return Ok(0.0);
        }
        let lambda = self.lambda(row, state);
        let filled = rows.rows().first();
        let pressure = filled.map_or(0.0, |r| self.traction(r, &lambda).pressure);
        Ok(pressure * self.measure(row) / self.area(row))
    }

    /// The pressure up to which points let the fluid in, at a time.
    fn critical_pressure(&self, time: f64) -> f64 {
        match self.parts.fluid.as_ref().map(|fluid| fluid.critical) {
            Some(Critical::Pressure(critical)) => critical,
            Some(Critical::Fluid) => self.pressure_of_fluid(time),
            None => 0.0,
        }
    }

    /// The fluid goes on to where it may be in a state that was found; whether that is anywhere new.
    pub(super) fn renew_front(&mut self, trial: &State) -> Result<Verdict, TermError> {
        let (Some(fluid), true) = (&self.parts.fluid, self.is_active()) else {
            return Ok(Verdict::Settled);
        };
        let Some(passages) = &self.wetting.passages else {
            return Ok(Verdict::Settled);
        };
        let critical = self.critical_pressure(trial.time);
        let mut rows = Rows::default();
        let nrow = self.parts.discretization.nrow();
        let mut lets_in = Vec::with_capacity(nrow);
        for row in 0..nrow {
            lets_in.push(self.contact_pressure(row, trial, &mut rows)? <= critical);
        }
        let before: Vec<bool> = (0..nrow).map(|row| self.wetting.is_wet(row)).collect();
        let mut wet = before.clone();
        let new = passages.flood(&mut wet, |row| lets_in[row]);
        if new == 0 {
            return Ok(Verdict::Settled);
        }
        let begins = self.increment_start;
        let since = [begins, begins + fluid.ramp * self.step.duration];
        let reached = |row: &usize| wet[*row] && !before[*row];
        let nodes = (0..nrow).filter(reached).take(super::judged::NAMED);
        let node = |row| self.parts.discretization.point(row).nodes.first().copied();
        let nodes = nodes.filter_map(node).collect();
        for row in (0..nrow).filter(reached) {
            self.wetting.trial[row].since = Some(since);
        }
        let all = wet.iter().all(|wet| *wet);
        let floats = match all {
            true => {
                ": it is everywhere, and where it holds the sides apart, something else has to hold the bodies"
            }
            false => "",
        };
        Ok(Verdict::Repeat {
            changes: new,
            closing: false,
            continuous: false,
            why: format!(
                "contact \"{}\": its fluid reached {new} more points{floats}",
                self.parts.name
            ),
            nodes,
        })
    }

    /// The increment has ended in this state: points dry that are pressed enough.
    pub(super) fn keep_fluid(&mut self, state: &State) -> Result<(), TermError> {
        let Some(fluid) = &self.parts.fluid else {
            return Ok(());
        };
        let mut accepted = self.wetting.trial.clone();
        if fluid.recedes && self.is_active() {
            let dry = DRY * self.critical_pressure(state.time);
            let mut rows = Rows::default();
            for (row, wet) in accepted.iter_mut().enumerate() {
                if wet.since.is_some()
                    && !wet.is_seed
                    && self.contact_pressure(row, state, &mut rows)? > dry
                {
                    wet.since = None;
                }
            }
        }
        self.wetting.accepted = accepted;
        Ok(())
    }

    /// What the fluid does in an accepted state.
    pub(super) fn describe_fluid(
        &self,
        state: &State,
        report: &mut ContactFrame,
    ) -> Result<(), TermError> {
        if self.parts.fluid.is_none() {
            return Ok(());
        }
        let n = report.nodes.len();
        let (mut wet, mut shares) = (vec![0.0; n], vec![0.0; n]);
        let mut rows = Rows::default();
        let mut of = FluidFrame {
            pressure: self.pressure_of_fluid(state.time),
            ..FluidFrame::default()
        };
        for row in 0..self.parts.discretization.nrow() {
            let is_wet = self.wetting.is_wet(row) && self.is_active();
            for (k, share) in self.nodes_of(row) {
                shares[k] += share;
                wet[k] += if is_wet { share } else { 0.0 };
            }
            let pressure = self.fluid_on(row, state.time);
            if !is_wet || self.now.pairs[row].is_none() {
                continue;
            }
            self.fill(row, state, RowOrder::Gradient, &mut rows)?;
            if let Some(filled) = rows.rows().first() {
                of.area += self.area(row) * filled.coverage;
                let push = self.pushed(&rows, filled, state);
                of.on_secondary.force += push.force * (pressure * self.area(row));
                of.on_secondary.moment += push.moment * (pressure * self.area(row));
            }
        }
        report.wet = wet.into_iter().zip(shares).map(mean).collect();
        let leak = self.wetting.leak().filter(|_| self.is_active());
        of.leak = leak.and_then(|row| {
            let point = self.parts.discretization.point(row as usize);
            point.nodes.first().copied()
        });
        report.fluid = Some(of);
        Ok(())
    }

    pub(super) fn store_fluid(&self, out: &mut Archive) {
        if self.parts.fluid.is_some() {
            let rows = self.wetting.accepted.iter();
            let numbers: Vec<f64> = rows.flat_map(|wet| wet.to_numbers()).collect();
            out.put(format!("contact.{}.wet", self.stored_name()), &numbers);
        }
    }

    pub(super) fn restore_fluid(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        self.wetting = Wetting::default();
        if self.parts.fluid.is_none() {
            return Ok(());
        }
        let name = format!("contact.{}.wet", self.stored_name());
        let mut numbers = vec![0.0; from.length(&name)?];
        from.get(&name, &mut numbers)?;
        let (rows, _) = numbers.as_chunks();
        self.wetting.accepted = rows.iter().map(Wet::from_numbers).collect();
        self.wetting.reject();
        Ok(())
    }
}
