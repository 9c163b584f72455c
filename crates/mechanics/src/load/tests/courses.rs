//! Courses of loads through the steps of a run.

use super::*;
use crate::material::NeoHookean;
use crate::model::{BodyKind, BodyPart, Change, LoadPart, Model, Parts, StepPart, Target};
use crate::solve::{Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings};
use crate::system::Archive;

/// What a test says of a load: name, load, course.
type Said = (&'static str, Acting, Course);

/// A square of 1 × 1 held at its left side, under loads given step by step; steps last 1, 2, 1, 1.
fn model(loads: [Vec<Said>; 4], nonlinear: bool) -> Model {
    let mut mesh = Mesh::default();
    for (k, (x, y)) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
        .into_iter()
        .enumerate()
    {
        mesh.points.push(Vec3::new(x, y, 0.0));
        mesh.node_labels.push(k as u64 + 1);
    }
    let cell = mesh.push_cell(element::by_name("quad4").unwrap(), &[0, 1, 2, 3], 1);
    let durations = [1.0, 2.0, 1.0, 1.0];
    let steps = loads
        .into_iter()
        .zip(durations)
        .enumerate()
        .map(|(number, (loads, duration))| {
            let held = vec![(0, Motion::Hold), (1, Motion::Hold)];
            let support = Change::Prescribe(Target::Nodes(vec![0, 3]), held);
            let load = |(name, load, course): Said| LoadPart {
                name: name.into(),
                load,
                course,
            };
            StepPart {
                name: format!("step {number}"),
                duration,
                increments: Increments::Fixed(4),
                nonlinear,
                scheme: None,
                control: None,
                vibration: None,
                physics: crate::system::Physics::default(),
                changes: if number == 0 {
                    vec![support]
                } else {
                    Vec::new()
                },
                loads: loads.into_iter().map(load).collect(),
                contacts: Vec::new(),
                temperatures: Vec::new(),
                freed_temperatures: Vec::new(),
                activity: Vec::new(),
            }
        });
    let parts = Parts {
        bodies: vec![BodyPart {
            name: "square".into(),
            cells: vec![cell],
            kind: BodyKind::solid(Box::new(NeoHookean::new(1000.0, 0.3))),
        }],
        steps: steps.collect(),
        ..Parts::new(&mesh, Idealisation::PlaneStrain { thickness: 1.0 })
    };
    Model::assemble(parts).unwrap()
}

const FREE: Face = Face {
    cell: CellId { block: 0, index: 0 },
    side: 1,
};

fn traction(x: f64, y: f64) -> Acting {
    Traction(Vec3::new(x, y, 0.0)).on(Place::Faces(vec![FREE]))
}

fn nodes(y: f64) -> Acting {
    Acting::forces(vec![(2, Vec3::new(0.0, y, 0.0))])
}

/// Runs a model and gives the sum of all loads at the end of every increment, from the reactions.
fn sums(mut model: Model) -> Vec<[f64; 2]> {
    let mut stepper = Stepper::new(&model.system, StepperSettings::default());
    let mut sums = Vec::new();
    let outcome = stepper.run(&mut model.system, &model.steps, &mut |event: &Event<'_>| {
        if let Event::Increment { frame, .. } = event {
            let sum: Vec3 = frame.reaction_force.iter().copied().sum();
            sums.push([-sum.x, -sum.y]);
        }
        Flow::Continue
    });
    assert_eq!(outcome.unwrap(), Outcome::Finished);
    sums
}

fn assert_sums(got: &[[f64; 2]], expected: &[[f64; 2]]) {
    assert_eq!(got.len(), expected.len());
    for (number, (a, b)) in got.iter().zip(expected).enumerate() {
        let error = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
        assert!(error < 1e-4, "increment {number}: {a:?} {b:?}");
    }
}

#[test]
fn a_ramp_replaces_a_ramp_in_a_straight_line_and_stays() {
    let loads = [
        vec![("a", traction(8.0, 0.0), Course::Ramp)],
        vec![],
        vec![
            ("a", traction(4.0, 4.0), Course::Ramp),
            ("b", nodes(1.0), Course::Ramp),
        ],
        vec![("a", traction(0.0, 0.0), Course::Ramp)],
    ];
    let expected = [
        [2.0, 0.0],
        [4.0, 0.0],
        [6.0, 0.0],
        [8.0, 0.0],
        [8.0, 0.0],
        [8.0, 0.0],
        [8.0, 0.0],
        [8.0, 0.0],
        [7.0, 1.25],
        [6.0, 2.5],
        [5.0, 3.75],
        [4.0, 5.0],
        [3.0, 4.0],
        [2.0, 3.0],
        [1.0, 2.0],
        [0.0, 1.0],
    ];
    assert_sums(&sums(model(loads, false)), &expected);
}

#[test]
fn a_table_jumps_where_it_does_not_start_at_the_value_the_load_had() {
    let saw = Course::Table(vec![[0.0, 1.0], [1.0, 0.0], [2.0, 2.0]]);
    let loads = [
        vec![("a", traction(8.0, 0.0), Course::Ramp)],
        vec![("a", traction(2.0, 0.0), saw)],
        vec![],
        vec![("a", nodes(4.0), Course::Ramp)],
    ];
    let expected = [
        [2.0, 0.0],
        [4.0, 0.0],
        [6.0, 0.0],
        [8.0, 0.0],
        // the table speaks for the load from its first moment on
        [1.0, 0.0],
        [0.0, 0.0],
        [2.0, 0.0],
        [4.0, 0.0],
        [4.0, 0.0],
        [4.0, 0.0],
        [4.0, 0.0],
        [4.0, 0.0],
        // another kind: the old one fades
        [3.0, 1.0],
        [2.0, 2.0],
        [1.0, 3.0],
        [0.0, 4.0],
    ];
    assert_sums(&sums(model(loads, false)), &expected);
}

#[test]
fn a_table_elsewhere_takes_its_course_while_the_old_load_fades() {
    let table = Course::Table(vec![[0.0, 1.0], [1.0, 1.0]]);
    let loads = [
        vec![("a", traction(8.0, 0.0), Course::Ramp)],
        vec![("a", nodes(2.0), table)],
        vec![],
        vec![],
    ];
    let got = sums(model(loads, false));
    assert_sums(
        &got[4..9],
        &[[6.0, 2.0], [4.0, 2.0], [2.0, 2.0], [0.0, 2.0], [0.0, 2.0]],
    );
}

#[test]
fn a_table_of_total_time_goes_on_until_a_ramp_takes_over_from_its_value() {
    let total = Course::TotalTable(vec![[0.0, 0.0], [2.0, 2.0], [4.0, 0.0], [5.0, 9.0]]);
    let loads = [
        vec![("a", traction(3.0, 0.0), total)],
        vec![],
        vec![("a", traction(0.0, 0.0), Course::Ramp)],
        vec![("a", traction(1.0, 0.0), Course::Ramp)],
    ];
    let expected = [
        0.75, 1.5, 2.25, 3.0, 4.5, 6.0, 4.5, 3.0, 2.25, 1.5, 0.75, 0.0, 0.25, 0.5, 0.75, 1.0,
    ];
    assert_sums(&sums(model(loads, false)), &expected.map(|x| [x, 0.0]));
}

/// Loads of every kind of course, a following pressure among them.
fn mixed() -> Model {
    let pressure = |p: f64| {
        Pressure {
            pressure: p,
            follows: true,
        }
        .on(Place::Faces(vec![FREE]))
    };
    let total = Course::TotalTable(vec![[0.0, 0.0], [1.7, 1.0], [4.2, -1.0]]);
    let table = Course::Table(vec![[0.0, 0.2], [0.7, 1.1], [1.5, 0.6]]);
    let loads = [
        vec![
            ("p", pressure(70.0), Course::Ramp),
            ("n", nodes(20.0), total),
        ],
        vec![("p", pressure(50.0), table)],
        vec![("n", traction(5.0, -9.0), Course::Ramp)],
        vec![("p", traction(10.0, 0.0), Course::Ramp)],
    ];
    model(loads, true)
}

/// Goes on by one increment; `None` at the end.
fn advance(model: &mut Model, stepper: &mut Stepper) -> Option<State> {
    let outcome = stepper.run(&mut model.system, &model.steps, &mut |event: &Event<'_>| {
        if matches!(event, Event::Increment { .. }) {
            Flow::Stop
        } else {
            Flow::Continue
        }
    });
    (outcome.unwrap() == Outcome::Stopped).then(|| stepper.state().clone())
}

#[test]
fn a_run_resumed_at_any_increment_finds_the_same_loads_bit_by_bit() {
    let start = |model: &Model| Stepper::new(&model.system, StepperSettings::default());
    let mut whole = mixed();
    let mut stepper = start(&whole);
    let (mut states, mut archives) = (Vec::new(), Vec::new());
    loop {
        let mut archive = Archive::default();
        stepper.save(&whole.system, &mut archive);
        archives.push(archive);
        match advance(&mut whole, &mut stepper) {
            Some(state) => states.push(state),
            None => break,
        }
    }
    assert_eq!(states.len(), 16);
    for (at, archive) in archives.iter().enumerate() {
        let mut model = mixed();
        let mut stepper = start(&model);
        stepper.load(&mut model.system, archive).unwrap();
        for (number, state) in states.iter().enumerate().skip(at) {
            let again = advance(&mut model, &mut stepper).unwrap();
            assert!(again == *state, "resumed at {at}, increment {number}");
        }
        assert_eq!(advance(&mut model, &mut stepper), None);
    }
}
