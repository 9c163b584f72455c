//! Jumps: a spring that gives way and hardens again.

use super::super::StepperSettings;
use super::*;
use crate::connector::Damper;

/// Force up to 1 at u = 1, down to 0.5 at u = 1.5, and up again: `f = 1.2` at u = 2.2 only.
fn sawtooth(e: f64) -> [f64; 3] {
    match e {
        e if e < 1.0 => [0.0, e, 1.0],
        e if e < 1.5 => [0.0, 2.0 - e, -1.0],
        e => [0.0, e - 1.0, 1.0],
    }
}

/// The same without the way up again.
fn giving_way(e: f64) -> [f64; 3] {
    if e < 1.5 {
        sawtooth(e)
    } else {
        [0.0, 0.5, 0.0]
    }
}

/// A node on the spring, under a load of 0.9 in the first step and 1.2 in the second.
fn jumping(law: Law, damped: bool) -> System {
    let spring = Spring {
        from: None,
        to: 0,
        law,
        potential: false,
        max_step: 1.0,
    };
    let mut terms: Vec<Box<dyn Term>> = vec![Box::new(spring), load(0, &[0.9, 1.2])];
    if damped {
        terms.push(Box::new(Damper::when_asked("brake", vec![(x(0), 1.0)])));
    }
    system(1, terms)
}

fn steps() -> [Step; 2] {
    let one = step(Increments::Fixed(1), &[]);
    [one.clone(), one]
}

fn stabilized(after: Option<usize>) -> StepperSettings {
    StepperSettings {
        stabilize_after: after,
        ..settings(1e-10, LineSearch::Auto)
    }
}

/// Runs both steps: how it ended, the number of stages of each increment that jumped, the last frame and state.
fn jump(
    mut system: System,
    after: Option<usize>,
) -> (Result<Outcome, RunError>, Vec<usize>, Frame, State) {
    let mut stepper = Stepper::new(&system, stabilized(after));
    let mut jumps = Vec::new();
    let outcome = stepper.run(&mut system, &steps(), &mut |event: &Event<'_>| {
        if let Event::Stabilized { stages, .. } = event {
            jumps.push(*stages);
        }
        Flow::Continue
    });
    let frame = stepper.report(&system).unwrap();
    (outcome, jumps, frame, stepper.state().clone())
}

#[test]
fn a_jump_ends_in_the_equilibrium_on_the_other_side_and_its_work_is_told() {
    // where no smaller size is allowed, after the first in any case
    for after in [0, 1, 4] {
        let (outcome, jumps, _, state) = jump(jumping(sawtooth, true), Some(after));
        assert!(outcome.is_ok(), "{outcome:?}");
        assert_eq!(jumps.len(), 1);
        assert!((state.u[0] - 2.2).abs() < 1e-12);
    }
    let (_, _, frame, state) = jump(jumping(sawtooth, true), Some(0));
    assert!((state.u[0] - 2.2).abs() < 1e-12, "{}", state.u[0]);
    // the load 1.2 does more work from 0.9 to 2.2 than the spring takes up: (0.9 + 1)/2 · 0.1 + 3/8 + (0.5 + 1.2)/2 · 0.7
    let surplus = 1.2 * 1.3 - 0.095 - 0.375 - 0.595;
    // implicit Euler takes the forces at the end of each stage for those of all of it: up to a tenth here
    let work = frame.work_stabilization;
    assert!(
        work > 0.0 && (work / surplus - 1.0).abs() < 0.5,
        "{work} of {surplus}"
    );
}

#[test]
fn without_viscous_forces_a_jump_is_an_error() {
    for (damped, after) in [(false, Some(0)), (true, None)] {
        let (outcome, jumps, frame, state) = jump(jumping(sawtooth, damped), after);
        assert!(matches!(outcome, Err(RunError::NotConverged { .. })));
        assert!(jumps.is_empty());
        assert_eq!(frame.work_stabilization, 0.0);
        assert!((state.u[0] - 0.9).abs() < 1e-14);
    }
}

#[test]
fn a_jump_that_never_comes_to_rest_fails_and_leaves_the_last_equilibrium() {
    let (outcome, jumps, frame, state) = jump(jumping(giving_way, true), Some(0));
    assert!(matches!(outcome, Err(RunError::NotConverged { .. })));
    assert!(jumps.is_empty());
    assert_eq!(frame.work_stabilization, 0.0);
    assert!((state.u[0] - 0.9).abs() < 1e-14);
}

#[test]
fn what_converges_is_not_touched() {
    let quiet = |damped| run_with(jumping(hardening, damped), &steps(), stabilized(Some(0)));
    let (with, without) = (quiet(true), quiet(false));
    with.assert_finished();
    assert_eq!(with.u, without.u);
    assert_eq!(with.iterations.len(), without.iterations.len());
}
