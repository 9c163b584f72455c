//! Increments of explicit steps, as runs go through them.

use super::event::{Event, Flow, Observer};
use super::newton::Failure;
use super::step::{Sizes, Step};
use super::stepping::{Accepted, Stepper};
use crate::explicit::{Explicit, Past, ROUNDING};
use crate::system::{Increment, Leapfrog, Phase, Rates, System, TermError};

/// Short increments after which observers are asked whether to stop.
const ASK: usize = 64;

impl Stepper {
    /// Begins an explicit step, or goes on with it.
    pub(super) fn begin_explicit(
        &mut self,
        system: &mut System,
        step: &Step,
        leapfrog: Leapfrog,
    ) -> Result<(), Failure> {
        let begins = self.progress.increment == 0;
        let before = self.explicit.take().map(|explicit| explicit.kept());
        let kept = before.or(self.kept.take()).filter(|_| !begins);
        let rest = || Rates::at_rest(system.layout.nnode(), system.heavy.len());
        self.state.rates.get_or_insert_with(rest);
        if begins {
            // rows are those that are near there
            self.newton.trial.clone_from(&self.state);
            self.newton.assembler.begin_increment(&system.terms);
            self.newton.evaluate(system)?;
        }
        let prescribed = &self.newton.prescribed;
        let mut explicit = Explicit::new(leapfrog, system, &self.state, prescribed)?;
        match kept {
            Some(kept) => explicit.go_on(system, &self.state, prescribed, kept)?,
            None => {
                explicit.scale_masses(system, &self.state, prescribed)?;
                explicit.look(system, &self.state, prescribed, step.duration)?;
            }
        }
        if begins {
            self.take_off(&mut explicit, system, step)?;
        }
        self.explicit = Some(Box::new(explicit));
        Ok(())
    }

    /// Finds accelerations at the state where a step begins, where forces are known, with impulses of what is closed.
    fn take_off(
        &mut self,
        explicit: &mut Explicit,
        system: &System,
        step: &Step,
    ) -> Result<(), TermError> {
        let end = self.end_of_increment(step, Sizes::of(step).first);
        let h = explicit.length(0.0, end);
        self.targets(step, h, &mut explicit.targets);
        explicit.stay(&self.state);
        let past = Past {
            half: 0.0,
            next: 0.5 * h,
        };
        let newton = &mut self.newton;
        let residual = &mut newton.assembly.residual;
        explicit.land(system, &mut newton.trial, residual, past)?;
        let work = &mut self.progress.work;
        work.leave(system, &newton.prescribed, residual, &newton.trial)?;
        explicit.report(system, &mut newton.trial);
        self.state.clone_from(&newton.trial);
        Ok(())
    }

    /// Says how an explicit step goes, where it has begun.
    pub(super) fn notice_explicit(&self, observer: &mut dyn Observer) {
        let Some(explicit) = self
            .explicit
            .as_ref()
            .filter(|_| self.progress.increment == 0)
        else {
            return;
        };
        let [longest, added] = explicit.sizes();
        observer.notice(&Event::Explicit {
            step: self.progress.step,
            longest,
            added,
        });
    }

    /// Goes to the end of the next increment by short ones, no farther than where an observer stops it; returns the step time there.
    pub(super) fn leap(
        &mut self,
        system: &mut System,
        step: &Step,
        end: f64,
        observer: &mut dyn Observer,
    ) -> Result<(Accepted, f64), Failure> {
        let Some(mut explicit) = self.explicit.take() else {
            return Ok((Accepted::default(), end));
        };
        explicit.take_up(system, &self.state);
        let start = self.progress.time;
        let mut time = start;
        let mut count = 0;
        while end - time > ROUNDING * step.duration {
            let to = time + explicit.length(time, end);
            let is_last = end - to <= ROUNDING * step.duration;
            let to = if is_last { end } else { to };
            self.leap_once(&mut explicit, system, step, [time, to, end])?;
            time = to;
            count += 1;
            if count % ASK == 0 {
                let event = Event::Leap {
                    step: self.progress.step,
                    increment: self.progress.increment + 1,
                    count,
                    part: (time - start) / (end - start),
                };
                self.newton.stopping |= observer.notice(&event) == Flow::Stop;
                if self.newton.stopping {
                    break;
                }
            }
        }
        if !explicit.is_finite() {
            return Err(Failure::NotFinite {
                iterations: count,
                dof: None,
            });
        }
        explicit.report(system, &mut self.state);
        self.explicit = Some(explicit);
        let accepted = Accepted {
            iterations: count,
            residual: 0.0,
        };
        Ok((accepted, time))
    }

    /// One short increment, between two times of the step, of one that goes on until a third.
    fn leap_once(
        &mut self,
        explicit: &mut Explicit,
        system: &mut System,
        step: &Step,
        [from, to, end]: [f64; 3],
    ) -> Result<(), Failure> {
        let h = to - from;
        let start = self.progress.step_start;
        let increment = Increment {
            number: self.progress.increment + 1,
            from: start + from,
            to: start + to,
        };
        let phase = Phase::of_increment(self.newton.step, increment);
        for term in &mut system.terms {
            term.begin(&phase, &self.state)?;
        }
        self.targets(step, to, &mut explicit.targets);
        explicit.leave(&self.state, h);
        let newton = &mut self.newton;
        system.advance(&mut newton.trial, &self.state, explicit.moves(), 1.0);
        newton.trial.time = start + to;
        newton.assembler.begin_increment(&system.terms);
        newton.evaluate(system)?;
        let prescribed = &newton.prescribed;
        if step.nonlinear && explicit.counts(system, &newton.trial, prescribed)? {
            explicit.look(system, &newton.trial, &newton.prescribed, step.duration)?;
        }
        // impulses close rows at the end of the next one
        let next = match end > to {
            true => explicit.length(to, end),
            false => explicit.length(self.progress.time, end),
        };
        self.targets(step, to + next, &mut explicit.targets);
        let past = Past {
            half: 0.5 * h,
            next: 0.5 * next,
        };
        let newton = &mut self.newton;
        explicit.land(
            system,
            &mut newton.trial,
            &mut newton.assembly.residual,
            past,
        )?;
        let work = &mut self.progress.work;
        let residual = &newton.assembly.residual;
        let moves = explicit.moves();
        work.leap(system, &newton.prescribed, residual, &newton.trial, moves)?;
        newton.trial.rates = self.state.rates.take();
        std::mem::swap(&mut self.state, &mut newton.trial);
        system.accept(&self.state)?;
        Ok(())
    }
}
