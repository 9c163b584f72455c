//! An interface as a term of the equations.

use super::judged::{Changes, NAMED};
use super::restless::RESTLESS;
use super::{Interface, Scratch, rows};
use crate::contact::kernel::Contact;
use crate::contact::law::Multiplier;
use crate::system::{
    Adaptive, Aid, Archive, ArchiveError, Audited, Capabilities, Choices, ContactAudit,
    ContactNumbering, Frame, Order, Part, PatternSink, Phase, Properties, Sink, State, Stored,
    Symmetry, Term, TermError, Verdict, Viscous, Wearing, Work,
};
use signorini_geometry::mesh::NodeId;

impl Term for Interface {
    fn name(&self) -> &str {
        &self.parts.name
    }

    fn properties(&self) -> Properties {
        let rubs = self.phase().is_some_and(|p| p.friction.is_some());
        // multipliers that are tractions keep their form where there is no friction for a while
        let tractions = self.nmultiplier() > 1 && self.parts.bond.is_none();
        let capabilities = self.parts.discretization.capabilities();
        // with inertia, weights that turn are those of one state, and gaps those of another
        let turns = self.step.scheme.is_some() && !capabilities.keeps();
        let is_symmetric = capabilities.is_symmetric && !turns;
        let tears = self.parts.cohesion.is_some();
        let couples = tears || self.couples_heat() || self.walks();
        let symmetry = if rubs || tractions || couples || !is_symmetric {
            Symmetry::Unsymmetric
        } else if self.nmultiplier() > 0 || self.parts.law.softens() {
            Symmetry::Symmetric
        } else {
            Symmetry::Definite
        };
        Properties {
            to_end: true,
            has_saddle: self.parts.bond.is_none() && self.nmultiplier() > 0,
            ..Properties::new(symmetry, Part::Interface)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        self.cliques(out);
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        (self.step, self.duration) = (phase.step, phase.dt());
        if self.is_active() && !phase.step.vibrates && self.first_step.is_none() {
            self.first_step = Some(phase.step);
        }
        if phase.increment.is_some() {
            self.begin_increment(from)?;
            self.begin_ends(from)?;
        }
        let refused = match phase.step.scheme {
            Some(_) if self.parts.wear.is_some() => self.wears_in_motion(),
            Some(_) if phase.step.is_explicit() => self.not_explicit(),
            Some(_) => self.not_implicit(),
            None => None,
        };
        match refused {
            Some(message) => Err(TermError::Refused { message }),
            None => Ok(()),
        }
    }

    fn nchunk(&self) -> usize {
        rows::nchunk(self.parts.discretization.nrow())
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let scratch = work.of::<Scratch>();
        let share = self.share(chunk);
        let mut asked = std::mem::take(&mut scratch.asked);
        self.ask(share.clone(), trial, &mut scratch.rows, &mut asked)?;
        for (row, answer) in share.zip(asked.answers()) {
            self.act((row, answer), trial, order, scratch, out)?;
            self.conduct((row, answer), trial, order, scratch, out)?;
            self.add_fluid(row, trial, order, scratch, out)?;
        }
        scratch.asked = asked;
        if chunk == 0 {
            self.add_before(trial, order, out);
        }
        Ok(())
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
        let laws = self.laws();
        let rubs = laws.friction.is_some() && !self.history.holds_limits();
        let no_potential = laws.cohesion.is_some() || laws.walks || self.nmultiplier() > 0;
        if rubs || no_potential {
            return Ok(None);
        }
        let rows = &mut work.of::<Scratch>().rows;
        let mut total = 0.0;
        for k in rows::chunk(chunk, self.parts.discretization.nrow()) {
            total += self.measure(k) * self.energy_of(k, trial, rows)?.unwrap_or(0.0);
            total += self.fluid_energy(k, trial, rows)?;
        }
        Ok(Some(total))
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        self.describe(state, frame)
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            choices: Some(self),
            stored: Some(self),
            audited: Some(self),
            impulsive: self.parts.bond.is_none().then_some(self),
            wearing: self.parts.wear.is_some().then_some(self),
            conducting: self.parts.heat.is_some().then_some(self),
            ..Capabilities::default()
        }
    }

    fn adaptive(&mut self) -> Option<&mut dyn Adaptive> {
        Some(self)
    }

    fn stored(&mut self) -> Option<&mut dyn Stored> {
        Some(self)
    }
}

impl Adaptive for Interface {
    fn prepare(&mut self, trial: &State, next: Order) -> Result<bool, TermError> {
        let at = trial.placement();
        self.search_for(&at, rows::row_order(next))
            .map_err(|e| self.failed(&e))?;
        self.bend_again(&at).map_err(|e| self.failed(&e))?;
        let through = self.passed_through(&at).or_else(|| self.went_through(&at));
        if let Some((row, message)) = through {
            let nodes = self.parts.discretization.point(row).nodes;
            return Err(TermError::Surface {
                interface: self.parts.name.clone(),
                message,
                node: nodes.first().copied(),
            });
        }
        self.stick(&at).map_err(|e| self.failed(&e))?;
        self.see_opposite(trial)?;
        self.share_out(trial);
        Ok(self.couple(trial))
    }

    fn converged(&mut self, trial: &State) -> Result<Verdict, TermError> {
        if self.settled < RESTLESS && self.settle(&trial.placement(), false)? {
            return Ok(Verdict::Repeat {
                changes: 1,
                closing: false,
                continuous: false,
                why: format!("contact \"{}\": other nodes are covered", self.parts.name),
                nodes: Vec::new(),
            });
        }
        if let Some(goes_on) = self.let_restless_go() {
            return Ok(goes_on);
        }
        self.reach_gaps(trial)?;
        self.history.damped[1] = self.damped(trial)?;
        self.reach_ends(trial)?;
        let limits = self.renew_limits(trial)?;
        let frozen = match self.parts.law.multiplier() {
            Multiplier::Frozen => self.augment(trial)?,
            _ => Verdict::Settled,
        };
        match (frozen, limits) {
            // pressures are those that were found
            (Verdict::Settled, Verdict::Settled) => self.renew_front(trial),
            (Verdict::Settled, limits) => Ok(limits),
            (changed, _) => Ok(changed),
        }
    }

    fn aid(&mut self, aid: Aid) -> bool {
        match aid {
            Aid::Safer => self.hold_limits(),
            Aid::Usual => self.history.forget_limits(),
            Aid::Remove | Aid::Restore => false,
        }
    }

    fn set_negligible(&mut self, force: f64) {
        self.negligible = force;
    }

    fn choices(&mut self) -> Option<&mut dyn Choices> {
        Some(self)
    }

    fn viscous(&mut self) -> Option<&mut dyn Viscous> {
        None
    }
}

impl Choices for Interface {
    fn prescribe(&mut self, prescribed: &[bool]) {
        self.lents.prescribe(prescribed);
    }

    fn max_step(&self, trial: &State, du: &[f64]) -> f64 {
        self.longest_step(trial, du)
    }

    fn verdict(&mut self, trial: &State) -> Verdict {
        let Ok(now) = self.judge(trial) else {
            // what cannot be evaluated fails where it is evaluated
            return Verdict::Settled;
        };
        let before = std::mem::replace(&mut self.judged, now);
        if self.judged.iter().all(|j| j.state == Contact::Open) {
            self.flights = self.flights.saturating_add(1);
        }
        let mut counts = Changes::default();
        if self.nmultiplier() > 1 {
            let directions = self.judged.iter().map(|judged| judged.direction);
            counts.turned = self.reversals.look(directions);
        }
        let mut nodes = Vec::new();
        for (row, (now, before)) in self.judged.iter().zip(&before).enumerate() {
            if !counts.compare(now, before) {
                continue;
            }
            if let Some(changes) = self.changes.get_mut(row)
                && before.facet.is_some()
                && now.facet != before.facet
            {
                *changes = changes.saturating_add(1);
            }
            if nodes.len() < NAMED {
                nodes.extend(self.parts.discretization.point(row).nodes.first());
            }
        }
        counts.verdict(&self.parts.name, nodes, !self.parts.has_vectors())
    }

    fn nactive(&self) -> usize {
        let closed = self.judged.iter().filter(|j| j.state != Contact::Open);
        closed.count()
    }

    fn reject(&mut self) {
        self.now.clone_from(&self.accepted);
        self.judged.clone_from(&self.accepted_judged);
        self.history.reject();
        self.wetting.reject();
        self.flights = 0;
        self.changes.fill(0);
        self.reversals.reset(self.parts.discretization.nrow());
    }
}

impl Stored for Interface {
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        self.keep_heat(state)?;
        self.keep_fluid(state)?;
        self.keep_gaps();
        self.ends.keep();
        self.history.damped[0] += std::mem::take(&mut self.history.damped[1]);
        self.accepted.clone_from(&self.now);
        self.accepted_judged.clone_from(&self.judged);
        self.started = true;
        self.changes.fill(0);
        if let Some(farthest) = self.farthest(state) {
            self.drift = self.drift.filter(|d| d.0 >= farthest.0).or(Some(farthest));
        }
        self.tear(state)?;
        self.wear_away(state)?;
        self.remember(state)
    }

    fn save(&self, out: &mut Archive) {
        self.store(out);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        self.restore(from)
    }
}

impl Wearing for Interface {
    fn depths(&self, out: &mut Vec<f64>) {
        self.worn.depths(out);
    }
}

impl Audited for Interface {
    fn node_of(&self, multiplier: usize) -> Option<NodeId> {
        let own = multiplier.checked_sub(self.parts.first_multiplier)?;
        let row = own.checked_div(self.nmultiplier())?;
        let known = row < self.now.pairs.len();
        known.then(|| self.parts.discretization.point(row).nodes.first().copied())?
    }

    fn numbering(&self) -> ContactNumbering {
        self.numbered()
    }

    fn audit(&self, state: &State, frame: &Frame) -> Option<ContactAudit> {
        self.audited(state, frame)
    }
}
