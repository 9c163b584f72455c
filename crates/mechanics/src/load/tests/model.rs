//! Loads by name in whole models: what is refused, and tubes under pressure.

use super::*;
use crate::material::NeoHookean;
use crate::model::{
    BodyKind, BodyPart, CarrierPart, Change, Load, LoadError, LoadPart, Model, ModelError, Parts,
    StepPart, Target,
};
use crate::solve::{Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings};
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

fn step_with(changes: Vec<Change>, loads: Vec<Load>, nonlinear: bool) -> StepPart {
    let part = |(number, load): (usize, Load)| LoadPart {
        name: format!("load {number}"),
        load,
        course: Course::Ramp,
    };
    StepPart {
        name: "step".into(),
        duration: 1.0,
        increments: Increments::Fixed(4),
        nonlinear,
        changes,
        loads: loads.into_iter().enumerate().map(part).collect(),
        temperatures: Vec::new(),
    }
}

const E: f64 = 1000.0;
const NU: f64 = 0.3;

#[test]
fn loads_that_cannot_act_are_refused_by_name() {
    let quad = element::by_name("quad4").unwrap();
    let refused = |space: Idealisation, load: Load| {
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
    let traction = |faces| Load::Traction {
        faces,
        traction: Vec3::unit(0),
    };
    assert_eq!(refused(plane, traction(vec![face(0, 1)])), None);
    assert_eq!(refused(plane, traction(vec![])), Some(LoadError::Nowhere));
    let no_face = LoadError::NoFace {
        element: 7,
        side: 9,
    };
    assert_eq!(refused(plane, traction(vec![face(0, 8)])), Some(no_face));
    let outside = LoadError::Outside { element: 9 };
    assert_eq!(refused(plane, traction(vec![face(1, 0)])), Some(outside));
    let gravity = Load::Gravity {
        cells: vec![cell(0)],
        acceleration: Vec3::unit(1),
    };
    let no_density = LoadError::NoDensity {
        body: "square".into(),
    };
    assert_eq!(refused(plane, gravity), Some(no_density));
    let moment = Load::Moment {
        nodes: vec![2],
        moment: Vec3::unit(2),
    };
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
    let pull = Load::Nodes(vec![(2, Vec3::unit(0))]);
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
    let gravity = Load::Gravity {
        cells: cells.clone(),
        acceleration: Vec3::new(0.0, -10.0, 0.0),
    };
    let spin = Load::Centrifugal {
        cells: cells.clone(),
        speed: 2.0,
        point: Vec3::ZERO,
        axis: Vec3::new(0.0, 0.0, 5.0),
    };
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

/// A quarter of a tube from r = 1 to 2 under internal pressure, `n` quadrilaterals across.
fn tube(n: usize, pressure: f64, nonlinear: bool) -> (Model, usize) {
    let mut mesh = Mesh::default();
    let around = 2 * n;
    for j in 0..=around {
        let angle = 0.5 * PI * j as f64 / around as f64;
        for i in 0..=n {
            let r = 1.0 + i as f64 / n as f64;
            mesh.points
                .push(Vec3::new(r * angle.cos(), r * angle.sin(), 0.0));
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
    let load = Load::Pressure {
        faces,
        pressure,
        follows: true,
    };
    let changes = vec![
        hold((0..=n).map(|i| node(i, 0)).collect(), &[1]),
        hold((0..=n).map(|i| node(i, around)).collect(), &[0]),
    ];
    let parts = Parts {
        bodies: vec![solid("tube", cells, None)],
        steps: vec![step_with(changes, vec![load], nonlinear)],
        ..Parts::new(&mesh, Idealisation::PlaneStrain { thickness: 1.0 })
    };
    (Model::assemble(parts).unwrap(), n)
}

/// SOURCE: Lamé's solution, Timoshenko and Goodier, *Theory of Elasticity*, section 28, in plane strain.
fn lame(a: f64, b: f64, r: f64, pressure: f64) -> f64 {
    let factor = pressure * a * a / (b * b - a * a) * (1.0 + NU) / E;
    factor * ((1.0 - 2.0 * NU) * r + b * b / r)
}

#[test]
fn a_thick_tube_under_internal_pressure_is_that_of_lame() {
    let mut errors = Vec::new();
    for n in [8, 16] {
        let (mut model, outer) = tube(n, 10.0, false);
        let frames = run(&mut model);
        let u = &frames.last().unwrap().0;
        let error = |node: usize, r: f64| (u[node].x / lame(1.0, 2.0, r, 10.0) - 1.0).abs();
        errors.push(error(0, 1.0).max(error(outer, 2.0)));
    }
    println!("relative errors of the radial displacement: {errors:?}");
    assert!(
        errors[1] < 0.01 && errors[1] < 0.3 * errors[0],
        "{errors:?}"
    );
}

#[test]
fn newton_converges_quadratically_under_a_large_following_pressure() {
    let (mut model, _) = tube(4, 180.0, true);
    let frames = run(&mut model);
    let iterations: Vec<usize> = frames.iter().map(|f| f.2).collect();
    let inner = frames.last().unwrap().0[0].x;
    println!("inner displacement {inner}, iterations {iterations:?}");
    assert!(inner > 0.3, "{inner}");
    assert!(iterations.iter().all(|&i| i <= 6), "{iterations:?}");
}

#[test]
fn a_moment_on_a_carrier_swivels_where_more_than_one_rotation_is_free() {
    // a rigid cube on top of a deformable one
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
    let twist = |moment: Vec3| {
        let load = Load::Carrier {
            carrier: 0,
            force: Vec3::ZERO,
            moment,
        };
        let rigid = BodyPart {
            name: "lid".into(),
            cells: vec![hard],
            kind: BodyKind::Rigid(0),
        };
        let parts = Parts {
            bodies: vec![solid("cube", vec![soft], None), rigid],
            carriers: vec![CarrierPart {
                name: "lid".into(),
                at: None,
            }],
            steps: vec![step_with(
                vec![hold(vec![0, 1, 2, 3], &[0, 1, 2])],
                vec![load],
                true,
            )],
            ..Parts::new(&mesh, Idealisation::Space)
        };
        let mut model = Model::assemble(parts).unwrap();
        run(&mut model);
        let symmetry = model.system.terms.last().unwrap().symmetry();
        symmetry == Symmetry::Unsymmetric
    };
    // carriers are free along what loads them, and held otherwise
    assert!(!twist(Vec3::new(0.0, 0.0, 5.0)));
    assert!(twist(Vec3::new(0.0, 4.0, 5.0)));
}
