//! Steps that come again and again, of which some stand for many.
//!
//! ```text
//! err = ½ N max|Δh_m − Δh_{m−1}| / max h        N ← N min(3, 0.9 √(tol/err))                     (E1)
//! ```
//!
//! A cycle that is solved stands for N: terms that wear take N times as much off. With Δh_m the depths that one cycle takes off, err is
//! what goes wrong where these change from one to the next. A cycle that errs by more than the tolerance is solved again for fewer, from
//! where it began; observers see the increments of one that is taken. Loads go on from where the step before the first has left them:
//! the last of a cycle has to leave them as that.

use super::event::{Event, Flow, IncrementRecord, Observer};
use super::step::{Cycle, Jump, Step, Turns};
use super::stepping::{Outcome, RunError, Stepper};
use crate::system::{Archive, Frame, System};

/// The largest factor by which N grows from one jump to the next.
const GROWTH: f64 = 3.0;
/// The factor on the N that would just meet the tolerance.
const SAFETY: f64 = 0.9;

/// Increments that wait until the cycle is taken.
struct Waiting<'a> {
    observer: &'a mut dyn Observer,
    increments: Vec<(IncrementRecord, Frame)>,
}

impl Observer for Waiting<'_> {
    fn notice(&mut self, event: &Event<'_>) -> Flow {
        match event {
            Event::Increment { record, frame } => {
                self.increments.push(((*record).clone(), (*frame).clone()));
                Flow::Continue
            }
            event => self.observer.notice(event),
        }
    }
}

impl Waiting<'_> {
    fn deliver(self) -> Flow {
        let mut flow = Flow::Continue;
        for (record, frame) in &self.increments {
            let after = self.observer.notice(&Event::Increment { record, frame });
            if after == Flow::Stop {
                flow = after;
            }
        }
        flow
    }
}

/// Depths of all that wears.
fn depths(system: &System) -> Vec<f64> {
    let mut all = Vec::new();
    for term in &system.terms {
        if let Some(worn) = term.capabilities().wearing {
            worn.depths(&mut all);
        }
    }
    all
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, value| most.max(value.abs()))
}

impl Stepper {
    /// Has steps come again.
    #[must_use]
    pub fn with_cycles(mut self, cycles: Vec<Cycle>) -> Self {
        self.cycles = cycles;
        self
    }

    /// The cycle that is due where a step begins, and may stand for many.
    pub(super) fn due_cycle(&mut self) -> Option<Cycle> {
        let begins = |cycle: &&Cycle| cycle.steps[0] == self.progress.step;
        let cycle = self.cycles.iter().find(begins).copied();
        let cycle = cycle.filter(|_| self.progress.increment == 0)?;
        let first = cycle.jump.map_or(1, |jump| jump.first);
        let turns = &mut self.progress.turns;
        if turns.stands_for == 0.0 {
            turns.stands_for = first.min(cycle.count) as f64;
        }
        cycle.jump.map(|_| cycle)
    }

    /// Goes back to the first step of a cycle whose last one is done, or on from all of them.
    pub(super) fn turn_round(&mut self, done: usize) {
        let ends = |cycle: &&Cycle| cycle.steps[1] == done;
        let Some(cycle) = self.cycles.iter().find(ends) else {
            return;
        };
        let turns = &mut self.progress.turns;
        turns.done += turns.stands_for;
        match turns.done < cycle.count as f64 {
            true => self.progress.step = cycle.steps[0],
            false => *turns = Turns::default(),
        }
    }

    /// Solves a cycle, as often as its error asks for, and goes on to the next or to what follows.
    pub(super) fn turn(
        &mut self,
        system: &mut System,
        steps: &[Step],
        cycle: &Cycle,
        observer: &mut dyn Observer,
    ) -> Result<Outcome, RunError> {
        let before = depths(system);
        let Some(jump) = cycle.jump else {
            return Ok(Outcome::Finished);
        };
        let mut start = Archive::default();
        self.save(system, &mut start);
        loop {
            let mut waiting = Waiting {
                observer: &mut *observer,
                increments: Vec::new(),
            };
            match self.once(system, steps, cycle, &mut waiting) {
                Ok(Outcome::Finished) => {}
                Ok(Outcome::Stopped) => {
                    self.return_to(system, &start)?;
                    return Ok(Outcome::Stopped);
                }
                Err(error) => {
                    waiting.deliver();
                    return Err(error);
                }
            }
            let n = self.progress.turns.stands_for;
            let after = depths(system);
            let worn: Vec<f64> = after
                .iter()
                .zip(&before)
                .map(|(h, start)| (h - start) / n)
                .collect();
            let next = self.next_jump(&jump, &worn, largest(after.iter().copied()));
            if next < 0.0 {
                self.return_to(system, &start)?;
                self.progress.turns.stands_for = -next;
                continue;
            }
            let stops = waiting.deliver() == Flow::Stop;
            self.turn_round(cycle.steps[1]);
            let turns = &mut self.progress.turns;
            if turns.stands_for > 0.0 {
                turns.last = worn;
                turns.stands_for = next.min(cycle.count as f64 - turns.done);
            }
            return Ok(match stops {
                true => Outcome::Stopped,
                false => Outcome::Finished,
            });
        }
    }

    /// (E1): for how many the next cycle stands; below 0: the present one has to be solved again, for as many.
    fn next_jump(&self, jump: &Jump, worn: &[f64], deepest: f64) -> f64 {
        let turns = &self.progress.turns;
        let n = turns.stands_for;
        let most = largest(worn.iter().copied());
        let cap = match jump.max_wear {
            Some(depth) if most > 0.0 => (depth / most).floor().max(1.0),
            _ => f64::INFINITY,
        };
        if turns.last.len() != worn.len() || deepest == 0.0 {
            return n.min(cap);
        }
        let change = worn
            .iter()
            .zip(&turns.last)
            .map(|(now, before)| now - before);
        let error = 0.5 * n * largest(change) / deepest;
        let factor = match error > 0.0 {
            true => (SAFETY * (jump.tol / error).sqrt()).min(GROWTH),
            false => GROWTH,
        };
        let next = (n * factor).floor().max(1.0).min(cap);
        match error > jump.tol && next < n {
            true => -next,
            false => next,
        }
    }

    /// Solves the steps of a cycle once.
    fn once(
        &mut self,
        system: &mut System,
        steps: &[Step],
        cycle: &Cycle,
        observer: &mut dyn Observer,
    ) -> Result<Outcome, RunError> {
        let [first, last] = cycle.steps;
        for step in steps.get(first..=last).unwrap_or_default() {
            let outcome = self.one_step(system, steps, step, observer)?;
            if outcome == Outcome::Stopped {
                return Ok(outcome);
            }
        }
        Ok(Outcome::Finished)
    }

    /// Goes back to a state that was stored.
    fn return_to(&mut self, system: &mut System, start: &Archive) -> Result<(), RunError> {
        self.load(system, start).map_err(|error| {
            crate::system::TermError::Refused {
                message: error.to_string(),
            }
            .into()
        })
    }
}
