//! Jumps: a spring that gives way and hardens again.

use super::super::StepperSettings;
use super::*;
use crate::connector::Damper;
use crate::system::Course;

/// A spring of unit stiffness.
fn unit(e: f64) -> [f64; 3] {
    [0.0, e, 1.0]
}

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

#[test]
fn an_equilibrium_nearby_is_reached_in_parts_without_a_jump() {
    // what moves by more than 0.2 in one increment never settles: Newton's method fails where nothing jumps
    let mut system = jumping(unit, true);
    system
        .terms
        .push(Fault::unsettle(|from, now, _| now.u[0] - from.u[0] > 0.2));
    let mut stepper = Stepper::new(&system, stabilized(Some(0)));
    let (mut followed, mut jumps) = (Vec::new(), 0);
    let mut works = Vec::new();
    let outcome = stepper.run(&mut system, &steps(), &mut |event: &Event<'_>| {
        match event {
            Event::Followed { parts, .. } => followed.push(*parts),
            Event::Stabilized { .. } => jumps += 1,
            Event::Increment { record, .. } => {
                works.push([record.work_stabilization, record.work_external]);
            }
            _ => {}
        }
        Flow::Continue
    });
    assert!(matches!(outcome, Ok(Outcome::Finished)), "{outcome:?}");
    // quarters of 0.225 are too large, sixteenths are not; quarters of 0.075 are not, either
    assert_eq!((followed, jumps), (vec![16, 4], 0));
    assert!((stepper.state().u[0] - 1.2).abs() < 1e-12);
    // the spring holds what the load has done
    let expected = [[0.0, 0.5 * 0.81], [0.0, 0.5 * (1.44 - 0.81)]];
    for (found, expected) in works.iter().zip(expected) {
        assert_eq!(found[0], expected[0]);
        assert!((found[1] - expected[1]).abs() < 1e-12, "{works:?}");
    }
}

#[test]
fn a_jump_is_taken_where_no_part_of_the_increment_passes_it() {
    let mut system = jumping(sawtooth, true);
    let mut stepper = Stepper::new(&system, stabilized(Some(0)));
    let mut told = Vec::new();
    let outcome = stepper.run(&mut system, &steps(), &mut |event: &Event<'_>| {
        match event {
            Event::Followed { .. } => told.push([f64::NAN; 2]),
            Event::Stabilized { work, external, .. } => told.push([*work, *external]),
            _ => {}
        }
        Flow::Continue
    });
    assert!(matches!(outcome, Ok(Outcome::Finished)), "{outcome:?}");
    let frame = stepper.report(&system).unwrap();
    let [[work, external]] = told[..] else {
        panic!("one jump, and nothing in parts: {told:?}");
    };
    assert_eq!(
        [work, external],
        [frame.work_stabilization, frame.work_external]
    );
    // 0.405 up to the first load, and something between 0.9 and 1.2 over the way of 1.3 from there
    assert!(external > 0.405 + 0.9 * 1.3 && external < 0.405 + 1.2 * 1.3);
}

#[test]
fn the_work_of_supports_and_loads_is_what_springs_store() {
    // a support pulls one spring, a load another
    let pair = |to: NodeId| Spring {
        from: None,
        to,
        law: linear,
        potential: false,
        max_step: 1.0,
    };
    let terms: Vec<Box<dyn Term>> =
        vec![Box::new(pair(0)), Box::new(pair(1)), load(1, &[5.0, 2.0])];
    let mut system = system(2, terms);
    let steps = [0.3, 0.7].map(|to| step(Increments::Fixed(3), &[(0, Motion::Ramp(to))]));
    let mut stepper = Stepper::new(&system, settings(1e-10, LineSearch::Auto));
    let outcome = stepper.run(&mut system, &steps, &mut |_: &Event<'_>| Flow::Continue);
    assert!(matches!(outcome, Ok(Outcome::Finished)), "{outcome:?}");
    let u = &stepper.state().u;
    let stored: f64 = [u[0], u[2]]
        .iter()
        .map(|u| 0.5 * linear(*u)[2] * u * u)
        .sum();
    let frame = stepper.report(&system).unwrap();
    assert!((frame.work_external - stored).abs() < 1e-12 * stored);
}

/// A body that these forces hold until contact does.
fn loose(damped: Vec<(Dof, f64)>) -> Course {
    Course::new("body", 1.0, damped)
}

#[test]
fn what_holds_a_body_that_nothing_else_does_bears_nothing_of_a_load() {
    // the first node is on a spring of stiffness 10, nothing but the viscous forces holds the second
    let dofs = vec![(x(0), 1e-3), (x(1), 1e-3)];
    let damper = Damper::until_held("free bodies", vec![loose(dofs)]);
    let terms: Vec<Box<dyn Term>> = vec![
        Spring::between(None, 0, linear),
        load(0, &[6.0]),
        Box::new(damper),
    ];
    let told = run(system(2, terms), &[step(Increments::Fixed(2), &[])]);
    told.assert_finished();
    assert!(told.cuts.is_empty());
    assert!((told.state.u[0] - 0.6).abs() < 1e-9, "{}", told.state.u[0]);
    assert_eq!(told.state.u[2], 0.0);
    // the viscous forces are renewed until what they bear is negligible
    for increment in &told.increments {
        assert!(increment.iterations <= 6, "{increment:?}");
        assert!(increment.attempts == 1);
    }
}

#[test]
fn contact_forces_oppose_a_motion_by_their_work_in_it() {
    let system = system(2, Vec::new());
    // the third follows from others
    let dofs = [(x(0), 2.0), (x(0) + 1, 2.0), (x(1), 0.0), (x(1) + 1, 2.0)];
    let mut course = Course::new("body", 1.0, dofs.to_vec());
    assert_eq!(course.damped().count(), 3);
    let mut state = system.initial_state();
    course.begin(&state);
    state.u[..4].copy_from_slice(&[0.5, -0.25, 0.125, 0.0]);
    let mut frame = Frame::new(2, &[]);
    frame.contact_force[0] = Vec3::new(2.0, 4.0, 0.0);
    frame.contact_force[1] = Vec3::new(-16.0, 7.0, 0.0);
    course.spend(3.0);
    let found = course.motion(&state, &system.layout, &frame).unwrap();
    // 2 x 0.5 + 4 x 0.25 + 16 x 0.125
    assert_eq!((found.opposed, found.distance), (4.0, 0.5));
    // 2 x 0.5² + 2 x 0.25²
    assert_eq!((found.work, found.work_throughout), (3.0, 0.625));
    course.begin(&state);
    assert_eq!(course.motion(&state, &system.layout, &frame), None);
}

/// A node that viscous forces of stiffness 10 hold, and a load of 1 drives.
fn driven(stop: Box<dyn Term>) -> Told {
    let damper = Damper::until_held("free bodies", vec![loose(vec![(x(0), 10.0)])]);
    let terms: Vec<Box<dyn Term>> = vec![stop, load(0, &[1.0]), Box::new(damper)];
    run(system(1, terms), &[step(Increments::Fixed(1), &[])])
}

#[test]
fn a_load_drives_a_body_up_to_what_stops_it() {
    // nothing up to 3, thirty times as far as the load and the viscous forces go at once
    fn stop(e: f64) -> [f64; 3] {
        let inside = (e - 3.0).max(0.0);
        let stiffness = if e > 3.0 { 100.0 } else { 0.0 };
        [50.0 * inside * inside, 100.0 * inside, stiffness]
    }
    let told = driven(Spring::between(None, 0, stop));
    told.assert_finished();
    assert!(told.cuts.is_empty());
    assert!((told.state.u[0] - 3.01).abs() < 1e-7, "{}", told.state.u[0]);
}

#[test]
fn a_body_that_a_load_drives_away_is_no_solution() {
    let told = driven(Spring::between(None, 0, |_| [0.0; 3]));
    assert!(
        matches!(told.outcome, Err(RunError::NotConverged { .. })),
        "{:?}",
        told.outcome
    );
}
