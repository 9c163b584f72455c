//! Many increments: sizes, ends, motions, observers.

use super::super::Failure;
use super::*;
use crate::material::{self, Constants};
use crate::model::{BodyKind, BodyPart, Change, Model, Parts, StepPart, Target};
use crate::system::Idealisation;
use signorini_geometry::element::by_name;
use signorini_geometry::mesh::Mesh;

/// A node on a spring under a load.
fn pulled(fault: Option<Box<dyn Term>>) -> System {
    let mut terms = vec![Spring::between(None, 0, hardening), load(0, &[1.0, 2.0])];
    terms.extend(fault);
    system(1, terms)
}

#[test]
fn increments_grow_after_two_easy_ones_and_end_with_the_step() {
    let told = run(pulled(None), &[step(adaptive(0.1, 0.01, 0.3), &[])]);
    told.assert_finished();
    // the limit at the end of the step does not count as a size
    assert_close(&told.sizes(), &[0.1, 0.1, 0.15, 0.225, 0.3, 0.125], 1e-14);
    assert_eq!(told.state.time, 1.0);
}

#[test]
fn no_short_rest_of_a_step_is_left_after_easy_increments() {
    let told = run(pulled(None), &[step(adaptive(0.1, 0.01, 1.0), &[])]);
    told.assert_finished();
    assert_close(&told.sizes(), &[0.1, 0.1, 0.15, 0.225, 0.425], 1e-14);
    // the first increments are those that were asked for
    let told = run(pulled(None), &[step(adaptive(0.4, 0.01, 1.0), &[])]);
    assert_close(&told.sizes(), &[0.4, 0.4, 0.2], 1e-14);
    // where a step fails with all that is left, it is cut as any other
    let long = Fault::refuse(|from, at| at.time - from.time > 0.4);
    let told = run(pulled(Some(long)), &[step(adaptive(0.1, 0.01, 1.0), &[])]);
    told.assert_finished();
    assert_close(&told.sizes()[..5], &[0.1, 0.1, 0.15, 0.225, 0.10625], 1e-14);
    assert_eq!(told.state.time, 1.0);
}

#[test]
fn a_refused_state_quarters_the_increment_and_growth_starts_anew() {
    let long = Fault::refuse(|from, at| at.time - from.time > 0.16);
    let told = run(pulled(Some(long)), &[step(adaptive(0.4, 1e-3, 1.0), &[])]);
    told.assert_finished();
    assert_close(
        &told.sizes(),
        &[
            0.1,
            0.1,
            0.1,
            0.15,
            0.05625,
            0.05625,
            0.05625,
            0.084375,
            0.1265625,
            0.042578125,
            0.042578125,
            0.042578125,
            0.042578125,
        ],
        1e-14,
    );
    // an extrapolation that cannot be evaluated is no start of its own
    assert_close(
        told.cuts.as_flattened(),
        &[0.4, 0.1, 0.225, 0.05625, 0.1703125, 0.042578125],
        1e-14,
    );
    let attempts: Vec<usize> = told.increments.iter().map(|i| i.attempts).collect();
    assert_eq!(attempts, [2, 1, 1, 1, 2, 1, 1, 1, 1, 2, 1, 1, 1]);
    assert_eq!(told.state.time, 1.0);
}

#[test]
fn an_increment_with_too_many_iterations_is_halved() {
    let long = Fault::unsettle(|from, at, _| at.time - from.time > 0.3);
    let told = run(pulled(Some(long)), &[step(adaptive(1.0, 1e-3, 0.25), &[])]);
    told.assert_finished();
    assert!(told.cuts.is_empty());
    let long = Fault::unsettle(|from, at, _| at.time - from.time > 0.3);
    let told = run(pulled(Some(long)), &[step(adaptive(1.0, 1e-3, 1.0), &[])]);
    told.assert_finished();
    assert_eq!(told.cuts[..2], [[1.0, 0.5], [0.5, 0.25]]);
}

#[test]
fn the_last_increment_takes_a_tiny_rest_with_it() {
    let told = run(pulled(None), &[step(adaptive(0.33333, 0.01, 0.33333), &[])]);
    told.assert_finished();
    assert_eq!(told.increments.len(), 3);
    assert_eq!(told.increments[2].step_time, (1.0, 1.0));
}

#[test]
fn fixed_increments_lie_on_the_grid_of_every_step() {
    let mut steps = [7, 3].map(|n| step(Increments::Fixed(n), &[]));
    steps[0].duration = 0.7;
    steps[1].duration = 0.9;
    let told = run(pulled(None), &steps);
    told.assert_finished();
    let ends: Vec<f64> = told.increments.iter().map(|i| i.step_time.0).collect();
    let grid = |n: usize, duration: f64| (1..=n).map(move |k| duration * (k as f64 / n as f64));
    let expected: Vec<f64> = grid(7, 0.7).chain(grid(3, 0.9)).collect();
    assert_eq!(ends, expected);
    let total: Vec<f64> = told.increments.iter().map(|i| i.time).collect();
    let expected: Vec<f64> = grid(7, 0.7).chain(grid(3, 0.9).map(|t| 0.7 + t)).collect();
    assert_eq!(total, expected);
    let numbers: Vec<_> = told
        .increments
        .iter()
        .map(|i| (i.step, i.increment))
        .collect();
    assert_eq!(numbers[6..8], [(0, 7), (1, 1)]);
}

#[test]
fn a_step_with_too_many_increments_ends_the_run() {
    let increments = Increments::Adaptive {
        initial: 0.1,
        min: 0.01,
        max: 0.1,
        count_max: 3,
    };
    let told = run(pulled(None), &[step(increments, &[])]);
    assert_eq!(told.increments.len(), 3);
    match told.outcome {
        Err(RunError::TooManyIncrements { count, time, .. }) => {
            assert_eq!(count, 3);
            assert!((time - 0.3).abs() < 1e-15);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_run_that_gives_up_lists_the_sizes_it_tried_and_the_last_cause() {
    let late = || Fault::refuse(|_, at| at.time > 0.5);
    let told = run(pulled(Some(late())), &[step(adaptive(0.5, 0.02, 1.0), &[])]);
    assert_eq!(told.increments.len(), 1);
    match told.outcome {
        Err(RunError::NotConverged {
            increment,
            time,
            tried,
            min,
            cause,
            ..
        }) => {
            assert_eq!((increment, time, min), (2, 0.5, Some(0.02)));
            assert_eq!(tried, [0.5, 0.125, 0.03125]);
            let text = "the fault is not a finite number";
            assert!(matches!(&*cause, Failure::Term(e) if e.to_string() == text));
        }
        other => panic!("{other:?}"),
    }
    // fixed increments are never cut, and an extrapolation that cannot be evaluated is no start of its own
    let told = run(pulled(Some(late())), &[step(Increments::Fixed(2), &[])]);
    match told.outcome {
        Err(RunError::NotConverged { tried, min, .. }) => {
            assert_eq!((tried, min), (vec![0.5], None));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn motions_follow_their_course() {
    let nodes = || (0..4).map(|n| Spring::between(Some(n), 4, linear));
    let table = |offset: f64| vec![[offset, 0.0], [offset + 0.5, 0.8], [offset + 1.0, 0.2]];
    let first = [
        (0, Motion::Hold),
        (1, Motion::Ramp(0.4)),
        (2, Motion::Table(table(0.0))),
        (3, Motion::TotalTable(table(0.5))),
    ];
    let second = [
        (0, Motion::Ramp(-1.0)),
        (1, Motion::Hold),
        (2, Motion::Table(vec![[0.25, 1.0]])),
        (3, Motion::TotalTable(table(0.5))),
    ];
    let steps = [first, second].map(|p| step(Increments::Fixed(4), &p));
    let told = run(system(5, nodes().collect()), &steps);
    told.assert_finished();
    let expected = [
        [0.0, 0.1, 0.4, 0.0],
        [0.0, 0.2, 0.8, 0.0],
        [0.0, 0.3, 0.5, 0.4],
        [0.0, 0.4, 0.2, 0.8],
        [-0.25, 0.4, 1.0, 0.5],
        [-0.5, 0.4, 1.0, 0.2],
        [-0.75, 0.4, 1.0, 0.2],
        [-1.0, 0.4, 1.0, 0.2],
    ];
    for (u, expected) in told.u.iter().zip(expected) {
        assert_close(&u[..4], &expected, 1e-15);
        // the free node is pulled evenly by all
        assert_close(&u[4..], &[expected.iter().sum::<f64>() / 4.0], 1e-15);
    }
}

/// A run that is stopped at the first event that `stops`; how it went on after.
fn stopped_at(stops: fn(&Event<'_>) -> bool) -> (usize, State) {
    let long = Fault::refuse(|from, at| at.time - from.time > 0.3);
    let mut system = pulled(Some(long));
    let steps = [(); 2].map(|()| step(adaptive(0.25, 1e-3, 0.5), &[]));
    let mut stepper = Stepper::new(&system, settings(1e-10, LineSearch::Auto));
    let mut accepted = 0;
    let mut stop = |event: &Event<'_>| {
        accepted += usize::from(matches!(event, Event::Increment { .. }));
        if stops(event) {
            Flow::Stop
        } else {
            Flow::Continue
        }
    };
    let outcome = stepper.run(&mut system, &steps, &mut stop);
    assert_eq!(outcome.unwrap(), Outcome::Stopped);
    let outcome = stepper.run(&mut system, &steps, &mut |_: &Event<'_>| Flow::Continue);
    assert_eq!(outcome.unwrap(), Outcome::Finished);
    (accepted, stepper.state().clone())
}

#[test]
fn observers_stop_a_run_at_every_event_and_it_goes_on() {
    let second = |e: &Event<'_>| matches!(e, Event::Step { step: 1, .. });
    let at_iteration = |e: &Event<'_>| matches!(e, Event::Iteration(i) if i.increment == 2);
    let at_increment =
        |e: &Event<'_>| matches!(e, Event::Increment { record, .. } if record.increment == 3);
    let at_cut = |e: &Event<'_>| matches!(e, Event::Cutback { .. });
    assert_eq!(stopped_at(|e| matches!(e, Event::Step { .. })).0, 0);
    assert_eq!(stopped_at(at_increment).0, 3);
    // what has begun is given up, and begins again
    assert_eq!(stopped_at(at_iteration).0, 1);
    assert_eq!(stopped_at(at_cut).0, 2);
    for (_, state) in [
        stopped_at(second),
        stopped_at(at_iteration),
        stopped_at(at_increment),
        stopped_at(at_cut),
    ] {
        assert_eq!(state.time, 2.0);
        // f(1) = 2
        assert!((state.u[0] - 1.0).abs() < 1e-9);
    }
}

/// A unit cube, its base held, its top moved along z.
fn cube(law: &str, nonlinear: bool, increments: Increments, down: f64) -> Model {
    let element = by_name("hex8").unwrap();
    let mut mesh = Mesh {
        points: element.nodes().iter().map(|xi| *xi * 0.5).collect(),
        node_labels: (1..=8).collect(),
        ..Mesh::default()
    };
    let cell = mesh.push_cell(element, &[0, 1, 2, 3, 4, 5, 6, 7], 17);
    let make = material::by_name(law).unwrap().make;
    let material = make(&Constants::elastic(100.0, 0.0)).unwrap();
    let body = BodyPart {
        name: "cube".into(),
        cells: vec![cell],
        kind: BodyKind::solid(material),
    };
    let held = |axis| (axis, Motion::Hold);
    let parts = Parts {
        bodies: vec![body],
        steps: vec![StepPart {
            name: "crush".into(),
            duration: 1.0,
            increments,
            nonlinear,
            scheme: None,
            control: None,
            vibration: None,
            physics: crate::system::Physics::default(),
            changes: vec![
                Change::Prescribe(Target::Nodes((0..4).collect()), vec![held(2)]),
                Change::Prescribe(Target::Nodes(vec![0, 3]), vec![held(0)]),
                Change::Prescribe(Target::Nodes(vec![0, 1]), vec![held(1)]),
                Change::Prescribe(
                    Target::Nodes((4..8).collect()),
                    vec![(2, Motion::Ramp(down))],
                ),
            ],
            loads: Vec::new(),
            contacts: Vec::new(),
            temperatures: Vec::new(),
            freed_temperatures: Vec::new(),
            activity: Vec::new(),
        }],
        ..Parts::new(&mesh, Idealisation::Space)
    };
    Model::assemble(parts).unwrap()
}

#[test]
fn prescribed_motion_of_a_linear_solid_takes_one_solve() {
    let model = cube("linear-elastic", false, Increments::Fixed(1), -0.1);
    let told = run(model.system, &model.steps);
    told.assert_finished();
    assert_eq!(told.increments[0].iterations, 1);
    let z = |n: usize| told.state.u[3 * n + 2];
    for n in 4..8 {
        assert_eq!(z(n), -0.1);
    }
    // without lateral strain nothing else moves
    let sideways = (0..8).flat_map(|n| [told.state.u[3 * n], told.state.u[3 * n + 1]]);
    assert!(sideways.into_iter().all(|u| u.abs() < 1e-15));
}

#[test]
fn an_inverted_element_shortens_the_increment_and_is_named_in_the_end() {
    // at first the whole way in one go: the top would pass the base
    let model = cube("neo-hookean", true, adaptive(1.0, 0.01, 1.0), -1.2);
    let told = run(model.system, &model.steps);
    assert_eq!(told.cuts[0], [1.0, 0.25]);
    assert!(!told.increments.is_empty());
    match told.outcome {
        Err(RunError::NotConverged {
            cause, time, tried, ..
        }) => {
            // the top meets the base at 1/1.2
            assert!((0.8..1.0 / 1.2).contains(&time), "{time}");
            // a quarter of the last one is below the smallest allowed
            let last = tried.last().copied().unwrap();
            assert!((0.01..0.04).contains(&last), "{tried:?}");
            match *cause {
                Failure::Term(TermError::Inverted {
                    element,
                    body,
                    ratio,
                }) => {
                    assert_eq!((element, &body[..]), (17, "cube"));
                    assert!(ratio <= 0.0);
                }
                other => panic!("{other:?}"),
            }
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_body_in_free_flight_is_in_equilibrium() {
    // nothing but rounding is left of the forces: it must not count as a residual
    for nonlinear in [false, true] {
        let mut model = cube("neo-hookean", nonlinear, Increments::Fixed(20), -0.1);
        for step in &mut model.steps {
            step.prescriptions = (0..3)
                .flat_map(|axis| (0..8).map(move |node| (node, axis)))
                .filter(|&(node, axis)| node < 4 || axis < 2)
                .map(|(node, axis)| Prescription {
                    dof: model.system.layout.node(node, axis),
                    motion: Motion::Ramp([0.7, -1.3, 900.0][axis]),
                })
                .collect();
        }
        let mut settings = StepperSettings::default();
        settings.newton.force_tol = 1e-12;
        let mut stepper = Stepper::new(&model.system, settings);
        let mut quiet = |_: &Event<'_>| Flow::Continue;
        let outcome = stepper.run(&mut model.system, &model.steps, &mut quiet);
        assert_eq!(outcome.unwrap(), Outcome::Finished);
        for node in 4..8 {
            let z = stepper.state().u[3 * node + 2];
            assert!((z - 900.0).abs() < 1e-9, "{z}");
        }
    }
}

/// Times at the ends of the increments of a run that pauses at some times.
fn with_pauses(increments: Increments, pauses: &[f64]) -> (Vec<f64>, State) {
    let mut system = pulled(None);
    let steps = [step(increments, &[])];
    let mut stepper = Stepper::new(&system, settings(1e-10, LineSearch::Auto));
    let mut times = Vec::new();
    for (at, &pause) in pauses.iter().enumerate() {
        let mut observer = |event: &Event<'_>| {
            if let Event::Increment { record, .. } = event {
                times.push(record.time);
            }
            Flow::Continue
        };
        let outcome = stepper.run_until(&mut system, &steps, pause, &mut observer);
        let last = at + 1 == pauses.len();
        let expected = if last {
            Outcome::Finished
        } else {
            Outcome::Stopped
        };
        assert_eq!(outcome.unwrap(), expected, "{pause}");
        assert!((stepper.state().time - pause).abs() < 1e-12, "{pause}");
    }
    (times, stepper.state().clone())
}

#[test]
fn a_run_pauses_at_a_time_with_the_increments_it_would_have_had_around_it() {
    let fixed = Increments::Fixed(4);
    let (times, whole) = with_pauses(fixed, &[1.0]);
    assert_eq!(times, [0.25, 0.5, 0.75, 1.0]);
    // on the grid a pause changes nothing
    let (times, paused) = with_pauses(fixed, &[0.5, 0.75, 1.0]);
    assert_eq!(times, [0.25, 0.5, 0.75, 1.0]);
    assert!(paused == whole);
    let (times, _) = with_pauses(fixed, &[0.1, 0.3, 1.0]);
    assert_close(&times, &[0.1, 0.25, 0.3, 0.5, 0.75, 1.0], 1e-14);
    let (times, _) = with_pauses(adaptive(0.4, 0.01, 0.4), &[0.1, 0.2, 1.0]);
    assert_eq!(times[..2], [0.1, 0.2]);
    assert!(times.windows(2).all(|pair| pair[1] > pair[0]), "{times:?}");
}
