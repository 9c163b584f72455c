//! Loads by name in whole models: what is refused, and tubes under pressure.

use super::*;
use crate::load::TABLE;
use crate::material::NeoHookean;
use crate::model::{
    BodyKind, BodyPart, CarrierPart, Change, LoadError, LoadPart, Model, ModelError, Parts,
    StepPart, Target,
};
use crate::solve::{Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings};
use signorini_vocabulary::{Chosen, Entry, Value, Values};
use std::f64::consts::PI;

fn solid(name: &str, cells: Vec<CellId>, density: Option<f64>) -> BodyPart {
    let mut kind = BodyKind::solid(Box::new(NeoHookean::new(E, NU)));
    if let BodyKind::Solid { density: to, .. } = &mut kind {
        *to = density;
    }
    BodyPart {
        name: name.into(),
        cells,
        kind,
    }
}

fn hold(nodes: Vec<NodeId>, axes: &[usize]) -> Change {
    let motions = axes.iter().map(|&axis| (axis, Motion::Hold)).collect();
    Change::Prescribe(Target::Nodes(nodes), motions)
}

fn step_with(changes: Vec<Change>, loads: Vec<Acting>, nonlinear: bool) -> StepPart {
    let part = |(number, load): (usize, Acting)| LoadPart {
        name: format!("load {number}"),
        load,
        course: Course::Ramp,
    };
    StepPart {
        name: "step".into(),
        duration: 1.0,
        increments: Increments::Fixed(4),
        nonlinear,
        scheme: None,
        control: None,
        vibration: None,
        physics: crate::system::Physics::default(),
        changes,
        loads: loads.into_iter().enumerate().map(part).collect(),
        contacts: Vec::new(),
        temperatures: Vec::new(),
        freed_temperatures: Vec::new(),
        activity: Vec::new(),
    }
}

const E: f64 = 1000.0;
const NU: f64 = 0.3;

#[test]
fn loads_that_cannot_act_are_refused_by_name() {
    let quad = element::by_name("quad4").unwrap();
    let refused = |space: Idealisation, load: Acting| {
        let single = Single::new(quad, space, 0.0);
        let mut mesh = single.mesh.clone();
        let stray = mesh.push_cell(quad, &[0, 1, 2, 3], 9);
        assert_eq!(stray.index, 1);
        let held = hold(vec![0, 1], &[0, 1]);
        let parts = Parts {
            bodies: vec![solid("square", vec![single.cell], None)],
            steps: vec![step_with(vec![held], vec![load], true)],
            ..Parts::new(&mesh, space)
        };
        match Model::assemble(parts).map(|_| ()) {
            Err(ModelError::Load { load, source }) => {
                assert_eq!(load, "load 0");
                Some(source)
            }
            Ok(()) => None,
            Err(other) => panic!("{other}"),
        }
    };
    let plane = Idealisation::PlaneStress { thickness: 1.0 };
    let cell = |index| CellId { block: 0, index };
    let face = |index, side| Face {
        cell: cell(index),
        side,
    };
    let traction = |faces| Traction(Vec3::unit(0)).on(Place::Faces(faces));
    assert_eq!(refused(plane, traction(vec![face(0, 1)])), None);
    assert_eq!(refused(plane, traction(vec![])), Some(LoadError::Nowhere));
    let no_face = LoadError::NoFace {
        element: 7,
        side: 9,
    };
    assert_eq!(refused(plane, traction(vec![face(0, 8)])), Some(no_face));
    let outside = LoadError::Outside { element: 9 };
    assert_eq!(refused(plane, traction(vec![face(1, 0)])), Some(outside));
    let gravity = Gravity(Vec3::unit(1)).on(Place::Cells(vec![cell(0)]));
    let no_density = LoadError::NoDensity {
        body: "square".into(),
    };
    assert_eq!(refused(plane, gravity), Some(no_density));
    let moment = Moment(Vec3::unit(2)).on(Place::Nodes(vec![2]));
    assert_eq!(refused(plane, moment), Some(LoadError::NoArm));
}

#[test]
fn a_name_given_twice_in_a_step_is_refused() {
    let single = Single::new(
        element::by_name("quad4").unwrap(),
        Idealisation::Axisymmetric,
        0.0,
    );
    let held = hold(vec![0, 1], &[0, 1]);
    let pull = Acting::forces(vec![(2, Vec3::unit(0))]);
    let mut step = step_with(vec![held], vec![pull.clone(), pull], true);
    step.loads[1].name = "load 0".into();
    let parts = Parts {
        bodies: vec![solid("square", vec![single.cell], None)],
        steps: vec![step],
        ..Parts::new(&single.mesh, Idealisation::PlaneStrain { thickness: 1.0 })
    };
    let error = Model::assemble(parts).map(|_| ()).unwrap_err();
    let twice = LoadError::Twice {
        step: "step".into(),
    };
    assert!(matches!(error, ModelError::Load { source, .. } if source == twice));
}

#[test]
fn gravity_and_centrifugal_forces_take_the_density_of_each_body() {
    // two unit squares, apart
    let mut mesh = Mesh::default();
    let quad = element::by_name("quad4").unwrap();
    let mut cells = Vec::new();
    for (k, from) in [0.0, 3.0].into_iter().enumerate() {
        let first = mesh.nnode() as NodeId;
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            mesh.points.push(Vec3::new(from + x, y, 0.0));
            mesh.node_labels.push(mesh.points.len() as u64);
        }
        cells.push(mesh.push_cell(
            quad,
            &[first, first + 1, first + 2, first + 3],
            k as u64 + 1,
        ));
    }
    let gravity = Gravity(Vec3::new(0.0, -10.0, 0.0)).on(Place::Cells(cells.clone()));
    let spin = Spin {
        speed: 2.0,
        point: Vec3::ZERO,
        axis: Vec3::new(0.0, 0.0, 5.0),
    }
    .on(Place::Cells(cells.clone()));
    let parts = Parts {
        bodies: vec![
            solid("light", vec![cells[0]], Some(2.0)),
            solid("heavy", vec![cells[1]], Some(7.0)),
        ],
        steps: vec![step_with(
            vec![hold((0..8).collect(), &[0, 1])],
            vec![gravity, spin],
            false,
        )],
        ..Parts::new(&mesh, Idealisation::PlaneStrain { thickness: 0.5 })
    };
    let mut model = Model::assemble(parts).unwrap();
    let frames = run(&mut model);
    let reaction: Vec3 = frames.last().unwrap().1.iter().copied().sum();
    // Σ m g and Σ m ω² r
    let exact = Vec3::new(-(1.0 * 0.5 + 3.5 * 3.5) * 4.0, 4.5 * 10.0, 0.0);
    let y = Vec3::new(0.0, -(1.0 + 3.5) * 0.5 * 4.0, 0.0);
    assert_near(reaction, exact + y, 1e-12 * 100.0, "reaction");
}

/// Displacements, reactions and iterations of every increment.
fn run(model: &mut Model) -> Vec<(Vec<Vec3>, Vec<Vec3>, usize)> {
    let mut stepper = Stepper::new(&model.system, StepperSettings::default());
    let mut frames = Vec::new();
    let outcome = stepper.run(&mut model.system, &model.steps, &mut |event: &Event<'_>| {
        if let Event::Increment { frame, record } = event {
            let (u, r) = (frame.displacement.clone(), frame.reaction_force.clone());
            frames.push((u, r, record.iterations));
        }
        Flow::Continue
    });
    assert_eq!(outcome.unwrap(), Outcome::Finished);
    frames
}

/// A tube from r = 1 to 2 under internal pressure, `n` quadrilaterals across: a quarter of it in the plane, or a piece
/// of its length.
fn tube(n: usize, space: Idealisation, pressure: f64, nonlinear: bool) -> Model {
    let mut mesh = Mesh::default();
    let around = 2 * n;
    let revolves = space == Idealisation::Axisymmetric;
    for j in 0..=around {
        let part = j as f64 / around as f64;
        let (sin, cos) = (0.5 * PI * part).sin_cos();
        for i in 0..=n {
            let r = 1.0 + i as f64 / n as f64;
            let at = if revolves {
                [r, part]
            } else {
                [r * cos, r * sin]
            };
            mesh.points.push(Vec3::new(at[0], at[1], 0.0));
            mesh.node_labels.push(mesh.points.len() as u64);
        }
    }
    let node = |i: usize, j: usize| (j * (n + 1) + i) as NodeId;
    let (mut cells, mut faces) = (Vec::new(), Vec::new());
    for j in 0..around {
        for i in 0..n {
            let nodes = [
                node(i, j),
                node(i + 1, j),
                node(i + 1, j + 1),
                node(i, j + 1),
            ];
            let label = cells.len() as u64 + 1;
            let cell = mesh.push_cell(element::by_name("quad4").unwrap(), &nodes, label);
            cells.push(cell);
            if i == 0 {
                faces.push(Face { cell, side: 3 });
            }
        }
    }
    let load = Pressure {
        pressure,
        follows: true,
    }
    .on(Place::Faces(faces));
    let changes = vec![
        hold((0..=n).map(|i| node(i, 0)).collect(), &[1]),
        hold(
            (0..=n).map(|i| node(i, around)).collect(),
            if revolves { &[1] } else { &[0] },
        ),
    ];
    let parts = Parts {
        bodies: vec![solid("tube", cells, None)],
        steps: vec![step_with(changes, vec![load], nonlinear)],
        ..Parts::new(&mesh, space)
    };
    Model::assemble(parts).unwrap()
}

/// SOURCE: Lamé's solution, Timoshenko and Goodier, *Theory of Elasticity*, section 28, in plane strain.
fn lame(a: f64, b: f64, r: f64, pressure: f64) -> f64 {
    let factor = pressure * a * a / (b * b - a * a) * (1.0 + NU) / E;
    factor * ((1.0 - 2.0 * NU) * r + b * b / r)
}

#[test]
fn a_thick_tube_under_internal_pressure_is_that_of_lame() {
    for space in TUBES {
        let errors = [8, 16].map(|n| {
            let mut model = tube(n, space, 10.0, false);
            let frames = run(&mut model);
            let u = &frames.last().unwrap().0;
            let error = |node: usize, r: f64| (u[node].x / lame(1.0, 2.0, r, 10.0) - 1.0).abs();
            error(0, 1.0).max(error(n, 2.0))
        });
        println!("relative errors of the radial displacement, {space:?}: {errors:?}");
        assert!(
            errors[1] < 0.01 && errors[1] < 0.3 * errors[0],
            "{errors:?}"
        );
    }
}

const TUBES: [Idealisation; 2] = [
    Idealisation::PlaneStrain { thickness: 1.0 },
    Idealisation::Axisymmetric,
];

#[test]
fn a_tube_inflated_by_a_large_following_pressure_is_the_same_in_the_plane_and_axisymmetric() {
    let inner = TUBES.map(|space| {
        let mut model = tube(12, space, 180.0, true);
        let frames = run(&mut model);
        let iterations: Vec<usize> = frames.iter().map(|f| f.2).collect();
        assert!(iterations.iter().all(|&i| i <= 6), "{iterations:?}");
        frames.last().unwrap().0[0].x
    });
    println!("inner displacement {inner:?}");
    assert!(inner[0] > 0.5, "{inner:?}");
    assert!((inner[0] / inner[1] - 1.0).abs() < 0.01, "{inner:?}");
}

#[test]
fn a_moment_on_a_carrier_swivels_where_more_than_one_rotation_is_free() {
    let (mesh, [soft, hard]) = stack();
    let twist = |moment: Vec3| {
        let load = Wrench {
            force: Vec3::ZERO,
            moment,
        }
        .on(Place::Carrier(0));
        let held = hold(vec![0, 1, 2, 3], &[0, 1, 2]);
        let mut model = lid(&mesh, soft, hard, step_with(vec![held], vec![load], true));
        run(&mut model);
        let symmetry = model.system.terms.last().unwrap().properties().symmetry;
        symmetry == Symmetry::Unsymmetric
    };
    // carriers are free along what loads them, and held otherwise
    assert!(!twist(Vec3::new(0.0, 0.0, 5.0)));
    assert!(twist(Vec3::new(0.0, 4.0, 5.0)));
}

/// A unit cube of one element under one load, every node held: the sum of its reactions and their moment about the origin.
fn supports(load: Acting) -> [Vec3; 2] {
    let hex = element::by_name("hex8").unwrap();
    let single = Single::new(hex, Idealisation::Space, 0.0);
    let held = hold((0..8).collect(), &[0, 1, 2]);
    let parts = Parts {
        bodies: vec![solid("cube", vec![single.cell], Some(3.0))],
        steps: vec![step_with(vec![held], vec![load], true)],
        ..Parts::new(&single.mesh, Idealisation::Space)
    };
    let mut model = Model::assemble(parts).unwrap();
    let (_, reactions, _) = run(&mut model).pop().unwrap();
    let moments = reactions.iter().zip(single.reference.iter());
    let moment = moments.map(|(r, x)| x.cross(*r)).sum();
    [reactions.iter().copied().sum(), moment]
}

#[test]
fn what_every_kind_of_load_exerts_arrives_at_the_supports() {
    // a cube from (1, -1, -1) to (3, 1, 1); side S4 is that of x = 3
    let cell = CellId { block: 0, index: 0 };
    let faces = vec![Face { cell, side: 3 }; 2];
    let (cells, v) = (vec![cell; 2], Vec3::new(2.0, -3.0, 0.5));
    let (face, centre) = (Vec3::unit(0) * 3.0, Vec3::unit(0) * 2.0);
    let pressure = |follows| {
        Pressure {
            pressure: 2.5,
            follows,
        }
        .on(Place::Faces(faces.clone()))
    };
    let push = Vec3::unit(0) * -10.0;
    let total = Force(v).on(Place::Faces(faces.clone()));
    let traction = Traction(v).on(Place::Faces(faces.clone()));
    let body = BodyForce(v).on(Place::Cells(cells.clone()));
    let gravity = Gravity(v).on(Place::Cells(cells.clone()));
    let spin = Spin {
        speed: 2.0,
        point: Vec3::new(0.0, 0.0, 9.0),
        axis: Vec3::unit(2) * -3.0,
    }
    .on(Place::Cells(cells));
    let moment = Moment(v).on(Place::Nodes(vec![0, 1, 2, 5]));
    for (load, force, moment) in [
        (total, v, face.cross(v)),
        (traction, v * 4.0, face.cross(v) * 4.0),
        (pressure(false), push, Vec3::ZERO),
        (pressure(true), push, Vec3::ZERO),
        (body, v * 8.0, centre.cross(v) * 8.0),
        (gravity, v * 24.0, centre.cross(v) * 24.0),
        (spin, centre * (24.0 * 4.0), Vec3::ZERO),
        (moment, Vec3::ZERO, v),
    ] {
        let what = format!("{load:?}");
        let [r, m] = supports(load);
        assert_near(r, -force, 1e-11, &what);
        assert_near(m, -moment, 1e-11, &what);
    }
}

#[test]
fn bars_weigh_their_cross_section_times_their_length() {
    let quad = element::by_name("quad4").unwrap();
    let single = Single::new(quad, Idealisation::PlaneStrain { thickness: 9.0 }, 0.0);
    let mut mesh = single.mesh.clone();
    let bar = mesh.push_cell(element::by_name("line2").unwrap(), &[0, 2], 8);
    let gravity = Gravity(Vec3::new(0.0, -10.0, 0.0)).on(Place::Cells(vec![bar]));
    let truss = BodyPart {
        name: "bar".into(),
        cells: vec![bar],
        kind: BodyKind::Truss {
            material: Box::new(NeoHookean::new(E, NU)),
            density: Some(3.0),
            mass: Default::default(),
            area: 0.2,
            small: false,
        },
    };
    let parts = Parts {
        bodies: vec![solid("square", vec![single.cell], None), truss],
        steps: vec![step_with(
            vec![hold(vec![0, 1], &[0, 1])],
            vec![gravity],
            true,
        )],
        ..Parts::new(&mesh, single.space)
    };
    let model = Model::assemble(parts).unwrap();
    let weight = model.system.terms.last().unwrap();
    let [force, _] = single.resultant(weight.as_ref(), &single.state(&[]));
    let exact = Vec3::unit(1) * (-3.0 * 0.2 * 8.0f64.sqrt() * 10.0);
    assert_near(force, exact, 1e-13, "weight");
}

#[test]
fn loads_on_faces_and_cells_of_a_rigid_body_are_forces_on_the_body() {
    let (mesh, [soft, hard]) = stack();
    let shift = |load: Acting| {
        let changes = vec![
            hold(vec![0, 1, 2, 3], &[0, 1, 2]),
            Change::Release(Target::Rigid(0), vec![0, 1, 2]),
        ];
        let mut model = lid(&mesh, soft, hard, step_with(changes, vec![load], true));
        run(&mut model).pop().unwrap().0
    };
    let force = Vec3::new(4.0, -2.0, -30.0);
    let expected = shift(
        Wrench {
            force,
            moment: Vec3::ZERO,
        }
        .on(Place::Carrier(0)),
    );
    assert!(expected[10].z < -0.01, "{:?}", expected[10]);
    let top = Face {
        cell: hard,
        side: 1,
    };
    let on_face = Force(force).on(Place::Faces(vec![top]));
    let on_cell = BodyForce(force).on(Place::Cells(vec![hard]));
    for load in [on_face, on_cell] {
        for (a, b) in shift(load).iter().zip(&expected) {
            assert_near(*a, *b, 1e-7, "displacement");
        }
    }
}

/// A cube with another on top.
fn stack() -> (Mesh, [CellId; 2]) {
    let mut mesh = Mesh::default();
    for z in 0..3 {
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            mesh.points.push(Vec3::new(x, y, f64::from(z)));
            mesh.node_labels.push(mesh.points.len() as u64);
        }
    }
    let hex = element::by_name("hex8").unwrap();
    let soft = mesh.push_cell(hex, &[0, 1, 2, 3, 4, 5, 6, 7], 1);
    let hard = mesh.push_cell(hex, &[4, 5, 6, 7, 8, 9, 10, 11], 2);
    (mesh, [soft, hard])
}

/// The lower cube deforms, the upper one is rigid.
fn lid(mesh: &Mesh, soft: CellId, hard: CellId, step: StepPart) -> Model {
    let rigid = BodyPart {
        name: "lid".into(),
        cells: vec![hard],
        kind: BodyKind::Rigid {
            carrier: 0,
            density: None,
        },
    };
    let parts = Parts {
        bodies: vec![solid("cube", vec![soft], None), rigid],
        carriers: vec![CarrierPart {
            name: "lid".into(),
            at: None,
        }],
        steps: vec![step],
        ..Parts::new(mesh, Idealisation::Space)
    };
    Model::assemble(parts).unwrap()
}

#[test]
fn a_centrifugal_load_without_the_direction_of_its_axis_is_refused() {
    let spin = |axis: [f64; 3]| {
        let values = Values::numbers([("speed", 3.0)])
            .with("point", Value::Numbers(vec![0.0; 3]))
            .with("axis", Value::Numbers(axis.to_vec()));
        let name = "centrifugal";
        Entry::make(&TABLE, &Chosen { name, values })
    };
    assert!(spin([0.0, 0.0, 2.0]).is_ok());
    let fault = spin([0.0; 3]).err().unwrap();
    assert_eq!(fault.to_string(), "its axis has no direction");
}
