//! What an iteration costs, before anything is solved.

use super::equations::Equations;
use super::step::Step;
use crate::system::{Assembler, Assembly, Order, State, System, TermError};
use signorini_linear::{
    Forecast, Iterative, LinearError, LinearKind, LinearSolver, Problem, SolveReport, Values,
};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Looks at a problem and solves nothing.
struct Scout {
    kind: LinearKind,
    seen: Arc<Mutex<Option<Forecast>>>,
}

impl LinearSolver for Scout {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        let forecast = Forecast::new(problem, self.kind)?;
        *self.seen.lock().unwrap_or_else(PoisonError::into_inner) = Some(forecast);
        Ok(())
    }

    fn factorize(&mut self, _: &Values) -> Result<(), LinearError> {
        Err(LinearError::Order { before: "analyze" })
    }

    fn solve(
        &mut self,
        _: &Values,
        _: &[f64],
        _: &mut [f64],
        _: f64,
    ) -> Result<SolveReport, LinearError> {
        Err(LinearError::Order { before: "analyze" })
    }

    fn iterative(&self) -> Option<&dyn Iterative> {
        None
    }

    fn iterative_mut(&mut self) -> Option<&mut dyn Iterative> {
        None
    }
}

/// What an iteration costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Of the linear system; none where it cannot be analyzed.
    pub linear: Option<Forecast>,
    /// Seconds that assembling force and tangent took.
    pub assembly: f64,
}

/// What an iteration of a step costs by this solver at a state that the terms have looked at.
///
/// # Errors
/// A term that cannot be evaluated.
pub fn forecast(
    system: &System,
    step: &Step,
    state: &State,
    kind: LinearKind,
) -> Result<Cost, TermError> {
    let System {
        layout,
        elimination,
        terms,
        ..
    } = system;
    let mut prescribed = vec![false; layout.ndof()];
    for p in &step.prescriptions {
        if let Some(prescribed) = prescribed.get_mut(p.dof as usize) {
            *prescribed = true;
        }
    }
    let mut assembler = Assembler::new(layout, elimination, terms);
    assembler.update_interface(layout, elimination, terms);
    let scout = Scout {
        kind,
        seen: Arc::default(),
    };
    let seen = scout.seen.clone();
    let mut equations = Equations::new(Box::new(scout));
    // what cannot be analyzed has no forecast; a run says why
    let _ = equations.analyze(system, &assembler, &prescribed);
    let linear = *seen.lock().unwrap_or_else(PoisonError::into_inner);
    let clock = Instant::now();
    let mut assembly = Assembly::default();
    let order = Order::Tangent;
    assembler.assemble(layout, elimination, terms, state, order, &mut assembly)?;
    Ok(Cost {
        linear,
        assembly: clock.elapsed().as_secs_f64(),
    })
}
