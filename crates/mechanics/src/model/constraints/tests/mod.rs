//! Blocks whose nodes follow others: closed forms, balance, refusals, restarts.

mod couplings;

use super::*;
use crate::connector::SpringLaw;
use crate::material::{NeoHookean, SaintVenantKirchhoff};
use crate::model::Parts;
use crate::model::{Change, ContactPart, Model, PrimaryPart, SidePart, StepPart, Target};
use crate::solve::{Event, Flow, Increments, NewtonSettings, Outcome, Stepper, StepperSettings};
use crate::system::{Archive, Assembler, Assembly, Frame, Order, State};
use signorini_geometry::element::by_name;
use signorini_geometry::mesh::{CellId, Face};

/// A box of hexahedra from `from` on: its cells.
fn block(mesh: &mut Mesh, [nx, ny, nz]: [u32; 3], from: Vec3, size: Vec3) -> Vec<CellId> {
    let first = mesh.nnode() as NodeId;
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let part = |n: u32, of: u32| f64::from(n) / f64::from(of);
                let at = [
                    part(i, nx) * size.x,
                    part(j, ny) * size.y,
                    part(k, nz) * size.z,
                ];
                mesh.points.push(from + Vec3::from(at));
                mesh.node_labels.push(mesh.points.len() as u64);
            }
        }
    }
    let node = |i: u32, j: u32, k: u32| first + i + (nx + 1) * (j + (ny + 1) * k);
    let mut cells = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let face = |k| {
                    [
                        node(i, j, k),
                        node(i + 1, j, k),
                        node(i + 1, j + 1, k),
                        node(i, j + 1, k),
                    ]
                };
                let nodes = [face(k), face(k + 1)].concat();
                cells.push(mesh.push_cell(
                    by_name("hex8").unwrap(),
                    &nodes,
                    cells.len() as u64 + 1,
                ));
            }
        }
    }
    cells
}

fn nodes_at(mesh: &Mesh, axis: usize, at: f64) -> Vec<NodeId> {
    let on = |n: &NodeId| (mesh.points[*n as usize][axis] - at).abs() < 1e-9;
    (0..mesh.nnode() as NodeId).filter(on).collect()
}

fn solid(name: &str, cells: Vec<CellId>) -> BodyPart {
    BodyPart {
        name: name.into(),
        cells,
        kind: BodyKind::solid(Box::new(NeoHookean::new(1000.0, 0.3))),
    }
}

fn constraint(name: &str, kind: ConstraintKind) -> ConstraintPart {
    ConstraintPart {
        name: name.into(),
        kind,
    }
}

fn prescribe(target: Target, motions: &[(usize, f64)]) -> Change {
    let motion = |&(c, to): &(usize, f64)| {
        (
            c,
            if to == 0.0 {
                Motion::Hold
            } else {
                Motion::Ramp(to)
            },
        )
    };
    Change::Prescribe(target, motions.iter().map(motion).collect())
}

fn step(increments: usize, nonlinear: bool, changes: Vec<Change>) -> StepPart {
    StepPart {
        name: "step".into(),
        duration: 1.0,
        increments: Increments::Fixed(increments),
        nonlinear,
        scheme: None,
        control: None,
        vibration: None,
        physics: crate::system::Physics::default(),
        changes,
        loads: Vec::new(),
        contacts: Vec::new(),
        temperatures: Vec::new(),
        freed_temperatures: Vec::new(),
        activity: Vec::new(),
    }
}

fn settings() -> StepperSettings {
    StepperSettings {
        newton: NewtonSettings {
            force_tol: 1e-10,
            ..NewtonSettings::default()
        },
        ..StepperSettings::default()
    }
}

struct Ran {
    model: Model,
    state: State,
    frames: Vec<Frame>,
    iterations: Vec<usize>,
}

fn run(parts: Parts<'_>) -> Ran {
    let mut model = Model::assemble(parts).unwrap();
    let mut stepper = Stepper::new(&model.system, settings());
    let (mut frames, mut iterations) = (Vec::new(), Vec::new());
    let outcome = stepper.run(&mut model.system, &model.steps, &mut |event: &Event<'_>| {
        if let Event::Increment { frame, record } = event {
            frames.push((*frame).clone());
            iterations.push(record.iterations);
        }
        Flow::Continue
    });
    assert_eq!(outcome.unwrap(), Outcome::Finished);
    Ran {
        state: stepper.state().clone(),
        model,
        frames,
        iterations,
    }
}

impl Ran {
    fn last(&self) -> &Frame {
        self.frames.last().unwrap()
    }

    /// What acts on raw dofs at the end.
    fn residual(&self) -> Vec<f64> {
        let system = &self.model.system;
        let (layout, e, terms) = (&system.layout, &system.elimination, &system.terms);
        let mut out = Assembly::default();
        Assembler::new(layout, e, terms)
            .assemble(layout, e, terms, &self.state, Order::Residual, &mut out)
            .unwrap();
        out.residual
    }

    /// Force and moment about the origin of the reactions at nodes.
    fn reactions(&self) -> (Vec3, Vec3) {
        let (mut force, mut moment) = (Vec3::ZERO, Vec3::ZERO);
        for (f, x) in self.last().reaction_force.iter().zip(&self.state.x) {
            force += *f;
            moment += x.cross(*f);
        }
        (force, moment)
    }

    /// Force and moment that hold a carrier.
    fn held(&self, carrier: RigidId) -> (Vec3, Vec3) {
        let (r, layout) = (self.residual(), &self.model.system.layout);
        let read = |dof: &dyn Fn(usize) -> Dof| {
            Vec3::new(r[dof(0) as usize], r[dof(1) as usize], r[dof(2) as usize])
        };
        (
            read(&|c| layout.translation(carrier, c)),
            read(&|c| layout.rotation(carrier, c)),
        )
    }
}

fn cube(n: u32) -> (Mesh, Vec<CellId>) {
    let mut mesh = Mesh::default();
    let cells = block(&mut mesh, [n; 3], Vec3::ZERO, Vec3::new(1.0, 1.0, 1.0));
    (mesh, cells)
}

const ALL: [(usize, f64); 3] = [(0, 0.0), (1, 0.0), (2, 0.0)];

#[test]
fn equal_displacements_share_what_one_node_is_moved_by() {
    let (mesh, cells) = cube(2);
    let top = nodes_at(&mesh, 2, 1.0);
    let base = Target::Nodes(nodes_at(&mesh, 2, 0.0));
    for nonlinear in [false, true] {
        let head = Target::Nodes(vec![top[4]]);
        let kind = ConstraintKind::Equal {
            nodes: top.clone(),
            axes: [false, false, true],
        };
        let ran = run(Parts {
            bodies: vec![solid("cube", cells.clone())],
            constraints: vec![constraint("flat", kind)],
            steps: vec![step(
                2,
                nonlinear,
                vec![prescribe(base.clone(), &ALL), prescribe(head, &[(2, -0.1)])],
            )],
            ..Parts::new(&mesh, Idealisation::Space)
        });
        for &node in &top {
            assert_eq!(ran.last().displacement[node as usize].z, -0.1);
        }
        let (force, _) = ran.reactions();
        let head = ran.last().reaction_force[top[4] as usize];
        assert!(head.z < -50.0, "{head:?}");
        assert!(force.max_abs() < 1e-9 * head.norm(), "{force:?}");
        // the others carry none by themselves
        assert_eq!(ran.last().reaction_force[top[0] as usize], Vec3::ZERO);
    }
}

/// Right minus left is a stretch that grows over the first step, in a chain of equations with a node that nothing uses.
#[test]
fn periodic_equations_stretch_a_bar_by_their_right_hand_side_evenly() {
    let mut mesh = Mesh::default();
    let cells = block(&mut mesh, [3, 2, 2], Vec3::ZERO, Vec3::new(3.0, 1.0, 1.0));
    mesh.points.push(Vec3::new(9.0, 9.0, 9.0));
    mesh.node_labels.push(999);
    let dummy = mesh.nnode() as NodeId - 1;
    let (left, right) = (nodes_at(&mesh, 0, 0.0), nodes_at(&mesh, 0, 3.0));
    let node = |n| Unknown::Node(n, 0);
    let mut constraints: Vec<_> = left
        .iter()
        .zip(&right)
        .map(|(&l, &r)| {
            let terms = vec![(node(r), 2.0), (node(l), -2.0), (node(dummy), -2.0)];
            constraint("periodic", ConstraintKind::Equation { terms, rhs: 0.0 })
        })
        .collect();
    constraints.push(constraint(
        "strain",
        ConstraintKind::Equation {
            terms: vec![(node(dummy), 4.0)],
            rhs: 0.12,
        },
    ));
    let fix = |axis: usize| prescribe(Target::Nodes(nodes_at(&mesh, axis, 0.0)), &[(axis, 0.0)]);
    let one = prescribe(Target::Nodes(vec![left[0]]), &[(0, 0.0)]);
    let material = Box::new(SaintVenantKirchhoff::new(1000.0, 0.3));
    let body = BodyPart {
        name: "bar".into(),
        cells,
        kind: BodyKind::solid(material),
    };
    let mut second = step(1, false, Vec::new());
    second.name = "wait".into();
    let ran = run(Parts {
        bodies: vec![body],
        constraints,
        steps: vec![step(4, false, vec![fix(1), fix(2), one]), second],
        ..Parts::new(&mesh, Idealisation::Space)
    });
    for (frame, stretch) in ran.frames.iter().zip([0.0075, 0.015, 0.0225, 0.03, 0.03]) {
        for (&l, &r) in left.iter().zip(&right) {
            let u = |n: NodeId| frame.displacement[n as usize].x;
            assert!((u(r) - u(l) - stretch).abs() < 1e-14);
        }
        for cell in &frame.cell_stress[0] {
            assert!(
                (cell.xx() - 1000.0 * stretch / 3.0).abs() < 1e-9,
                "{cell:?}"
            );
        }
        let (force, _) = (frame.reaction_force[left[0] as usize], ());
        assert!(
            force.x.abs() < 1e-9,
            "stretching a cell against itself takes no support"
        );
    }
}

#[test]
fn to_stay_and_to_go_to_zero_are_one_motion_in_the_first_step_and_two_afterwards() {
    let (mesh, cells) = cube(1);
    let base = || Target::Nodes(nodes_at(&mesh, 2, 0.0));
    let both = |to: f64| {
        let ramp = Change::Prescribe(base(), vec![(2, Motion::Ramp(to))]);
        step(1, true, vec![prescribe(base(), &ALL), ramp])
    };
    let assemble = |steps: Vec<StepPart>| {
        Model::assemble(Parts {
            bodies: vec![solid("cube", cells.clone())],
            steps,
            ..Parts::new(&mesh, Idealisation::Space)
        })
    };
    let model = assemble(vec![both(0.0)]).unwrap();
    let motions = model.steps[0].prescriptions.iter();
    assert!(motions.map(|p| &p.motion).all(|m| *m == Motion::Hold));
    assert!(matches!(
        assemble(vec![both(0.1)]).err(),
        Some(ModelError::Clash { .. })
    ));
    let later = vec![step(1, true, vec![prescribe(base(), &ALL)]), both(0.0)];
    assert!(matches!(
        assemble(later).err(),
        Some(ModelError::Clash { .. })
    ));
}

fn refusal(constraints: Vec<ConstraintPart>, changes: Vec<Change>) -> Result<(), ModelError> {
    let (mesh, cells) = cube(1);
    // springs to the ground hold the cube without prescribing anything
    let to_ground = |axis: usize| SpringPart {
        name: format!("ground {axis}"),
        ends: (0..8).map(|node| (node, None)).collect(),
        law: SpringLaw::Linear(1.0),
        direction: Some(Vec3::unit(axis)),
    };
    Model::assemble(Parts {
        bodies: vec![solid("cube", cells)],
        carriers: vec![carrier("a", [0.0; 3]), carrier("b", [0.0; 3])],
        springs: (0..3).map(to_ground).collect(),
        constraints,
        steps: vec![step(1, true, changes)],
        ..Parts::new(&mesh, Idealisation::Space)
    })
    .map(drop)
}

#[test]
fn contradictions_and_too_many_constraints_are_refused_by_name() {
    let equation = |name: &str, terms: &[(NodeId, f64)], rhs: f64| {
        let terms = terms
            .iter()
            .map(|&(n, c)| (Unknown::Node(n, 0), c))
            .collect();
        constraint(name, ConstraintKind::Equation { terms, rhs })
    };
    let said = |constraints, changes| refusal(constraints, changes).err().map(|e| e.to_string());
    let chain = [
        ("one", [(0, 1.0), (1, -1.0)], 0.1),
        ("two", [(1, 1.0), (2, -1.0)], 0.2),
    ];
    let with = |rhs: f64| {
        let mut all: Vec<_> = chain
            .iter()
            .map(|(n, t, rhs)| equation(n, t, *rhs))
            .collect();
        all.push(equation("three", &[(0, 3.0), (2, -3.0)], rhs));
        all
    };
    // 0.1 + 0.2 is 0.3 but for rounding
    assert_eq!(said(with(0.9), Vec::new()), None);
    let error = said(with(0.6), Vec::new()).unwrap();
    assert!(error.contains("\"three\" contradicts"), "{error}");
    let equal = |nodes: &[NodeId]| {
        let kind = ConstraintKind::Equal {
            nodes: nodes.to_vec(),
            axes: [true, false, false],
        };
        vec![constraint("tie", kind)]
    };
    let fix = |nodes: &[NodeId], to: f64| prescribe(Target::Nodes(nodes.to_vec()), &[(0, to)]);
    assert_eq!(said(equal(&[0, 1, 2, 3]), vec![fix(&[2], 0.1)]), None);
    assert_eq!(said(equal(&[0, 1, 2, 3]), vec![fix(&[1, 2], 0.1)]), None);
    let error = said(equal(&[0, 1, 2, 3]), vec![fix(&[1], 0.0), fix(&[2], 0.1)]).unwrap();
    assert!(error.contains("\"tie\" leaves nothing free"), "{error}");
    let kinematic = |name: &str, carrier, axes| {
        constraint(
            name,
            ConstraintKind::Kinematic {
                nodes: vec![4, 5, 6, 7],
                carrier,
                axes,
            },
        )
    };
    let error = said(
        vec![
            kinematic("grip", 0, [true; 3]),
            kinematic("second", 1, [true, false, false]),
        ],
        Vec::new(),
    );
    assert!(
        error
            .as_deref()
            .unwrap_or("")
            .contains("follows \"a\" already"),
        "{error:?}"
    );
    let error = said(
        vec![kinematic("grip", 0, [true, false, false])],
        vec![fix(&[4], 0.0)],
    )
    .unwrap();
    assert!(error.contains("follows \"a\""), "{error}");
    assert_eq!(
        said(
            vec![kinematic("grip", 0, [false, true, true])],
            vec![fix(&[4], 0.0)]
        ),
        None
    );
    let error = said(Vec::new(), vec![prescribe(Target::Rigid(1), &[(0, 1.0)])]).unwrap();
    assert!(error.contains("\"b\", which nothing follows"), "{error}");
}

/// Two blocks pressed together: the upper is gripped by a carrier, its lower face stays level by equations, so that
/// contact rows act on dependent unknowns.
fn pressed() -> Model {
    let mut mesh = Mesh::default();
    let size = Vec3::new(2.0, 2.0, 1.0);
    let lower = block(&mut mesh, [3, 3, 2], Vec3::ZERO, size);
    let upper = block(
        &mut mesh,
        [2, 2, 2],
        Vec3::new(0.3, 0.35, 1.0),
        Vec3::new(1.0, 1.0, 1.0),
    );
    let nlower = 16 * 3;
    let of_upper = |nodes: Vec<NodeId>| {
        nodes
            .into_iter()
            .filter(|&n| n >= nlower)
            .collect::<Vec<_>>()
    };
    let sole = of_upper(nodes_at(&mesh, 2, 1.0));
    let head = nodes_at(&mesh, 2, 2.0);
    let faces = |cells: &[CellId], side| -> Vec<Face> {
        cells.iter().map(|&cell| Face { cell, side }).collect()
    };
    let secondary = SidePart::Faces(faces(&upper[..4], 0));
    let primary = PrimaryPart::Faces(faces(&lower[9..], 1));
    let contact = ContactPart::new("sole", secondary, primary);
    let level = ConstraintKind::Equal {
        nodes: sole,
        axes: [false, false, true],
    };
    let grip = ConstraintKind::Kinematic {
        nodes: head,
        carrier: 0,
        axes: [true; 3],
    };
    let base = Target::Nodes(nodes_at(&mesh, 2, 0.0));
    let motions = [(0, 0.1), (1, 0.0), (2, -0.1), (3, 0.02), (4, 0.0), (5, 0.3)];
    let steps = vec![step(
        5,
        true,
        vec![prescribe(base, &ALL), prescribe(Target::Rigid(0), &motions)],
    )];
    Model::assemble(Parts {
        bodies: vec![solid("lower", lower), solid("upper", upper)],
        carriers: vec![carrier("head", [0.8, 0.85, 2.0])],
        constraints: vec![constraint("level", level), constraint("grip", grip)],
        contacts: vec![contact],
        steps,
        ..Parts::new(&mesh, Idealisation::Space)
    })
    .unwrap()
}

#[test]
fn contact_acts_on_unknowns_that_follow_and_restarts_and_threads_change_no_bit() {
    let leg = |model: &mut Model, stepper: &mut Stepper| {
        let mut frame = None;
        let outcome = stepper.run(&mut model.system, &model.steps, &mut |event: &Event<'_>| {
            if let Event::Increment { frame: f, .. } = event {
                frame = Some((*f).clone());
                return Flow::Stop;
            }
            Flow::Continue
        });
        (outcome.unwrap() == Outcome::Stopped)
            .then_some(frame)
            .flatten()
    };
    let whole = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut model = pressed();
            let mut stepper = Stepper::new(&model.system, settings());
            let (mut last, mut archive) = (None, Archive::default());
            let mut k = 0;
            while let Some(frame) = leg(&mut model, &mut stepper) {
                last = Some(frame);
                k += 1;
                if k == 2 {
                    stepper.save(&model.system, &mut archive);
                }
            }
            (stepper.state().clone(), last.unwrap(), archive)
        })
    };
    let (state, frame, archive) = whole(1);
    assert!(whole(2).0 == state);
    let mut model = pressed();
    let mut stepper = Stepper::new(&model.system, settings());
    stepper.load(&mut model.system, &archive).unwrap();
    while leg(&mut model, &mut stepper).is_some() {}
    assert!(*stepper.state() == state);
    // the base feels what contact hands down
    let force = frame.contacts[0].primary.force;
    let base: Vec3 = frame.reaction_force.iter().copied().sum();
    assert!(
        force.z < -10.0 && (force + base).max_abs() < 1e-7,
        "{force:?} {base:?}"
    );
    let level: Vec<f64> = frame.contacts[0]
        .nodes
        .iter()
        .map(|&n| state.x[n as usize].z)
        .collect();
    assert!(level.iter().all(|z| (z - level[0]).abs() < 1e-12));
}

fn carrier(name: &str, at: [f64; 3]) -> CarrierPart {
    CarrierPart {
        name: name.into(),
        at: Some(Vec3::from(at)),
    }
}
