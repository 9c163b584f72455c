//! A step begins: terms, unknowns that are prescribed, accelerations.

use super::newton::Failure;
use super::step::{Prescription, Step};
use super::stepping::{RunError, Stepper};
use crate::system::{Choices, Dof, Layout, Phase, StepContext, System};

impl Stepper {
    /// How a run ends whose step cannot begin.
    pub(super) fn not_begun(&self, step: &Step, cause: Failure) -> RunError {
        match cause {
            Failure::Term(error) => RunError::Term(error),
            cause => RunError::NotConverged {
                step: step.name.clone(),
                increment: self.progress.increment + 1,
                time: self.progress.time,
                duration: step.duration,
                tried: Vec::new(),
                min: None,
                cause: Box::new(cause),
            },
        }
    }

    /// Begins a step, or goes on with it.
    ///
    /// # Errors
    /// What a term finds wrong; accelerations that cannot be found.
    pub(super) fn begin_step(&mut self, system: &mut System, step: &Step) -> Result<(), Failure> {
        let progress = &mut self.progress;
        let value = |p: &Prescription| self.state.u.get(p.dof as usize).copied().unwrap_or(0.0);
        if progress.increment == 0 {
            progress.origin = step.prescriptions.iter().map(value).collect();
        }
        let context = StepContext {
            cycles: progress.turns.stands_for.max(1.0),
            geometric: self.newton.settings.geometric,
            ..step.context(progress.step, progress.step_start)
        };
        self.state.is_small = !step.nonlinear;
        let phase = Phase::of_step(context);
        for term in &mut system.terms {
            term.begin(&phase, &self.state)?;
        }
        self.newton.step = context;
        let (layout, elimination) = (&system.layout, &system.elimination);
        let assembler = &mut self.newton.assembler;
        self.newton.coupled_more |= assembler.begin_step(layout, elimination, &system.terms);
        let prescribed = &mut self.newton.prescribed;
        prescribed.clear();
        prescribed.resize(system.layout.ndof(), false);
        for p in &step.prescriptions {
            if let Some(prescribed) = prescribed.get_mut(p.dof as usize) {
                *prescribed = true;
            }
        }
        if !step.physics.moves {
            let is_of_heat = |dof: usize| {
                let name = layout.name(dof as Dof);
                name.is_some_and(|name| layout.field(name.field) == Some(&Layout::TEMPERATURE))
            };
            let motions = prescribed.iter_mut().enumerate();
            motions.for_each(|(dof, stays)| *stays |= !is_of_heat(dof));
        }
        for term in system.choices_mut() {
            term.prescribe(prescribed);
        }
        self.newton.analyzed = false;
        if self.progress.increment == 0 {
            self.progress.record.closed = system.choices().map(Choices::nactive).sum();
        }
        if let Some(leapfrog) = step.scheme.and_then(|scheme| scheme.explicit) {
            return self.begin_explicit(system, step, leapfrog);
        }
        self.explicit = None;
        if step.scheme.is_some() && self.progress.increment == 0 {
            self.newton.accelerate(system, &mut self.state)?;
        }
        Ok(())
    }
}
