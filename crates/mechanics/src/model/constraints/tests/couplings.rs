//! Couplings, faces that stay plane, twists, rods and ropes.

use super::*;
use crate::load::{Acting, Load, Place, Wrench};
use crate::model::Parts;
use crate::model::{LoadPart, StepPart, Target};
use crate::solve::Increments;
use crate::system::{Frame, State};
use std::f64::consts::{PI, TAU};

#[test]
fn a_kinematic_coupling_twists_a_cube_by_a_right_angle_and_hands_on_force_and_moment() {
    let (mesh, cells) = cube(2);
    let base = Target::Nodes(nodes_at(&mesh, 2, 0.0));
    let top = nodes_at(&mesh, 2, 1.0);
    let kind = ConstraintKind::Kinematic {
        nodes: top.clone(),
        carrier: 0,
        axes: [true; 3],
    };
    let turn = [
        (0, 0.0),
        (1, 0.0),
        (2, 0.0),
        (3, 0.0),
        (4, 0.0),
        (5, PI / 2.0),
    ];
    let ran = run(Parts {
        bodies: vec![solid("cube", cells)],
        carriers: vec![carrier("head", [0.3, 0.6, 1.2])],
        constraints: vec![constraint("grip", kind)],
        steps: vec![step(
            10,
            true,
            vec![prescribe(base, &ALL), prescribe(Target::Rigid(0), &turn)],
        )],
        ..Parts::new(&mesh, Idealisation::Space)
    });
    for &node in &top {
        let arm = mesh.points[node as usize] - Vec3::new(0.3, 0.6, 1.2);
        let expected = Vec3::new(0.3 - arm.y, 0.6 + arm.x, 1.2 + arm.z);
        assert!((ran.state.x[node as usize] - expected).max_abs() < 1e-13);
    }
    let (force, moment) = ran.reactions();
    let (held, twist) = ran.held(0);
    let balance = moment + twist + ran.state.poses[0].origin.cross(held);
    assert!(twist.z > 50.0);
    assert!((force + held).max_abs() < 1e-8 && balance.max_abs() < 1e-8);
    assert!(
        ran.iterations.iter().all(|&i| i <= 8),
        "{:?}",
        ran.iterations
    );
}

/// Nodes that follow along z only shrink across as they like; the reference that nobody names floats.
#[test]
fn a_coupling_along_one_axis_leaves_the_others_free() {
    let (mesh, cells) = cube(2);
    let fix = |axis: usize| prescribe(Target::Nodes(nodes_at(&mesh, axis, 0.0)), &[(axis, 0.0)]);
    let top = nodes_at(&mesh, 2, 1.0);
    let kind = ConstraintKind::Kinematic {
        nodes: top.clone(),
        carrier: 0,
        axes: [false, false, true],
    };
    let mut pull = step(3, true, vec![fix(0), fix(1), fix(2)]);
    pull.loads.push(LoadPart {
        name: "pull".into(),
        load: Wrench {
            force: Vec3::unit(2) * 120.0,
            moment: Vec3::ZERO,
        }
        .on(Place::Carrier(0)),
        course: crate::load::Course::default(),
    });
    let ran = run(Parts {
        bodies: vec![solid("cube", cells)],
        carriers: vec![carrier("head", [0.5, 0.5, 1.0])],
        constraints: vec![constraint("grip", kind)],
        steps: vec![pull],
        ..Parts::new(&mesh, Idealisation::Space)
    });
    let first = ran.last().displacement[top[0] as usize].z;
    assert!(first > 0.1);
    for &node in &top {
        let u = ran.last().displacement[node as usize];
        assert!(
            (u.z - first).abs() < 1e-10,
            "a homogeneous stretch keeps the top level"
        );
        let x = mesh.points[node as usize];
        assert!(x.x == 0.0 || u.x < -0.01 * x.x);
    }
    let (force, _) = ran.reactions();
    assert!(
        (force + Vec3::unit(2) * 120.0).max_abs() < 1e-7,
        "{force:?}"
    );
}

/// Force and moment on the mean of nodes are statically equivalent forces on the nodes.
#[test]
fn a_distributing_coupling_acts_as_equivalent_forces_and_follows_the_mean() {
    let (mesh, cells) = cube(2);
    let base = Target::Nodes(nodes_at(&mesh, 2, 0.0));
    let top = nodes_at(&mesh, 2, 1.0);
    let at = Vec3::new(0.5, 0.5, 1.0);
    let (force, moment) = (Vec3::new(1.0, -2.0, 3.0), Vec3::unit(2) * 4.0);
    let mut loaded = step(1, false, vec![prescribe(base.clone(), &ALL)]);
    loaded.loads.push(LoadPart {
        name: "wrench".into(),
        load: Wrench { force, moment }.on(Place::Carrier(0)),
        course: crate::load::Course::default(),
    });
    let coupled = |steps: StepPart| {
        let kind = ConstraintKind::Distributing {
            nodes: top.iter().map(|&n| (n, 2.0)).collect(),
            carrier: 0,
        };
        run(Parts {
            bodies: vec![solid("cube", cells.clone())],
            carriers: vec![carrier("mean", at.to_array())],
            constraints: vec![constraint("spread", kind)],
            steps: vec![steps],
            ..Parts::new(&mesh, Idealisation::Space)
        })
    };
    let ran = coupled(loaded.clone());
    let arms: f64 = top
        .iter()
        .map(|&n| (mesh.points[n as usize] - at).norm_squared())
        .sum();
    let forces = top.iter().map(|&n| {
        let arm = mesh.points[n as usize] - at;
        (
            n,
            force * (1.0 / top.len() as f64) + moment.cross(arm) * arms.recip(),
        )
    });
    let mut direct = step(1, false, vec![prescribe(base, &ALL)]);
    direct.loads.push(LoadPart {
        name: "forces".into(),
        load: Acting::forces(forces.collect()),
        course: crate::load::Course::default(),
    });
    let expected = run(Parts {
        bodies: vec![solid("cube", cells.clone())],
        steps: vec![direct],
        ..Parts::new(&mesh, Idealisation::Space)
    });
    let largest = expected
        .last()
        .displacement
        .iter()
        .fold(0.0f64, |m, u| m.max(u.max_abs()));
    for (a, b) in ran
        .last()
        .displacement
        .iter()
        .zip(&expected.last().displacement)
    {
        assert!((*a - *b).max_abs() < 1e-9 * largest, "{a:?} {b:?}");
    }
    let mean: Vec3 = top
        .iter()
        .map(|&n| ran.last().displacement[n as usize] * (1.0 / top.len() as f64))
        .sum();
    assert!((ran.last().rigid[0].displacement - mean).max_abs() < 1e-12 * largest);
    // large: force and moment at the supports balance the load
    let mut large = loaded;
    (large.nonlinear, large.increments) = (true, Increments::Fixed(4));
    large.loads[0].load = Wrench {
        force: force * 20.0,
        moment: moment * 10.0,
    }
    .on(Place::Carrier(0));
    let ran = coupled(large);
    let (f, m) = ran.reactions();
    let arm = ran.state.poses[0].origin;
    let balance = m + moment * 10.0 + arm.cross(force * 20.0);
    assert!((f + force * 20.0).max_abs() < 1e-8 && balance.max_abs() < 1e-8);
    assert!(
        ran.last().rigid[0].rotation.z > 0.05,
        "{:?}",
        ran.last().rigid[0]
    );
}

/// A face pushed at a corner tilts and stays plane, in space and along a line in the plane.
#[test]
fn a_face_that_stays_plane_tilts() {
    let (mesh, cells) = cube(3);
    let base = Target::Nodes(nodes_at(&mesh, 2, 0.0));
    let top = nodes_at(&mesh, 2, 1.0);
    for nonlinear in [false, true] {
        let corner = prescribe(Target::Nodes(vec![top[0]]), &[(2, -0.2)]);
        let ran = run(Parts {
            bodies: vec![solid("cube", cells.clone())],
            constraints: vec![constraint(
                "plane",
                ConstraintKind::Plane { nodes: top.clone() },
            )],
            steps: vec![step(
                3,
                nonlinear,
                vec![prescribe(base.clone(), &ALL), corner],
            )],
            ..Parts::new(&mesh, Idealisation::Space)
        });
        let x = |k: usize| {
            let (start, u) = (
                mesh.points[top[k] as usize],
                ran.last().displacement[top[k] as usize],
            );
            if nonlinear {
                start + u
            } else {
                Vec3::new(start.x, start.y, 1.0 + u.z)
            }
        };
        let normal = (x(3) - x(0)).cross(x(12) - x(0)).normalized().unwrap();
        for k in 0..16 {
            assert!((x(k) - x(0)).dot(normal).abs() < 1e-11, "{k}");
        }
        assert!(normal.z < 0.999 && ran.reactions().0.max_abs() < 1e-8);
    }
}

/// The angles of the nodes of a face, in the mean, are the prescribed one; the moment that this takes is that at the base.
#[test]
fn a_twisted_face_turns_by_its_angle_in_the_mean() {
    let (mesh, cells) = cube(3);
    let base = Target::Nodes(nodes_at(&mesh, 2, 0.0));
    let top = nodes_at(&mesh, 2, 1.0);
    for (nonlinear, angle) in [(false, 1e-3), (true, 1.2)] {
        let kind = ConstraintKind::Twist {
            nodes: top.clone(),
            axis: Vec3::new(0.0, 0.0, 2.0),
            carrier: 0,
        };
        let turn = prescribe(Target::Rigid(0), &[(0, angle)]);
        let ran = run(Parts {
            bodies: vec![solid("cube", cells.clone())],
            carriers: vec![carrier("angle", [0.0; 3])],
            constraints: vec![constraint("twist", kind)],
            steps: vec![step(
                4,
                nonlinear,
                vec![prescribe(base.clone(), &ALL), turn],
            )],
            ..Parts::new(&mesh, Idealisation::Space)
        });
        let mean =
            |x: &dyn Fn(NodeId) -> Vec3| top.iter().map(|&n| x(n)).sum::<Vec3>() / top.len() as f64;
        let (start, now) = (
            |n: NodeId| mesh.points[n as usize],
            |n: NodeId| ran.state.x[n as usize],
        );
        let (from, to) = (mean(&start), mean(&now));
        let angles = top.iter().map(|&n| {
            let (p, q) = (start(n) - from, now(n) - to);
            (p.x * q.y - p.y * q.x).atan2(p.x * q.x + p.y * q.y)
        });
        let turned = angles.sum::<f64>() / top.len() as f64;
        // at small strain up to the square of the angle
        let allowed = if nonlinear { 1e-11 } else { angle * angle };
        assert!((turned - angle).abs() < allowed, "{turned} {angle}");
        let torque = ran.held(0).0.x;
        let (force, moment) = ran.reactions();
        assert!(torque > 0.0 && force.max_abs() < 1e-8);
        let off = if nonlinear {
            1e-8
        } else {
            2.0 * angle * torque
        };
        assert!((moment.z + torque).abs() < off, "{moment:?} {torque}");
    }
}

/// An edge stays straight while its end is pulled; a rod keeps it as long as it was.
#[test]
fn an_edge_stays_straight_and_a_rod_keeps_its_length() {
    let (mesh, cells) = cube(3);
    let base = Target::Nodes(nodes_at(&mesh, 2, 0.0));
    let top = nodes_at(&mesh, 2, 1.0);
    let edge: Vec<NodeId> = top
        .iter()
        .copied()
        .filter(|&n| mesh.points[n as usize].y == 0.0)
        .collect();
    let ends = [edge[0], edge[3]];
    for nonlinear in [false, true] {
        let corner = prescribe(Target::Nodes(vec![ends[0]]), &[(1, 0.1), (2, 0.3)]);
        let ran = run(Parts {
            bodies: vec![solid("cube", cells.clone())],
            constraints: vec![
                constraint(
                    "line",
                    ConstraintKind::Line {
                        nodes: edge.clone(),
                    },
                ),
                constraint(
                    "rod",
                    ConstraintKind::Distance {
                        nodes: ends,
                        most: None,
                    },
                ),
            ],
            steps: vec![step(
                3,
                nonlinear,
                vec![prescribe(base.clone(), &ALL), corner],
            )],
            ..Parts::new(&mesh, Idealisation::Space)
        });
        let u = |n: NodeId| ran.last().displacement[n as usize];
        let x = |n: NodeId| mesh.points[n as usize] + u(n);
        let along = x(ends[1]) - x(ends[0]);
        let length = if nonlinear {
            along.norm()
        } else {
            1.0 + u(ends[1]).x - u(ends[0]).x
        };
        assert!((length - 1.0).abs() < 1e-11, "{length}");
        for (k, &node) in edge.iter().enumerate() {
            let off = if nonlinear {
                (x(node) - x(ends[0])).cross(along)
            } else {
                let s = k as f64 / 3.0;
                let off = u(node) - u(ends[0]) * (1.0 - s) - u(ends[1]) * s;
                Vec3::new(0.0, off.y, off.z)
            };
            assert!(off.max_abs() < 1e-11, "{k} {off:?}");
        }
        assert!(ran.reactions().0.max_abs() < 1e-8);
    }
}

/// A cube is pulled up through a rope: nothing happens until it is taut.
#[test]
fn a_rope_pulls_and_never_pushes() {
    let (mut mesh, cells) = cube(1);
    let (second, nodes) = (Vec3::new(0.0, 0.0, 3.0), nodes_at(&mesh, 2, 0.0));
    let more = block(&mut mesh, [1; 3], second, Vec3::new(1.0, 1.0, 1.0));
    let hook = nodes_at(&mesh, 2, 1.0)[0];
    let held = nodes_at(&mesh, 2, 3.0);
    let all: Vec<NodeId> = nodes_at(&mesh, 2, 4.0)
        .into_iter()
        .chain(held.clone())
        .collect();
    let rope = ConstraintKind::Distance {
        nodes: [hook, held[0]],
        most: Some(2.5),
    };
    let up = |to: f64| prescribe(Target::Nodes(all.clone()), &[(0, 0.0), (1, 0.0), (2, to)]);
    let ran = run(Parts {
        bodies: vec![solid("cube", cells), solid("hook", more)],
        constraints: vec![constraint("rope", rope)],
        steps: vec![
            step(
                1,
                true,
                vec![prescribe(Target::Nodes(nodes), &ALL), up(0.4)],
            ),
            step(2, true, vec![up(0.8)]),
            step(2, true, vec![up(0.2)]),
        ],
        ..Parts::new(&mesh, Idealisation::Space)
    });
    let lift = |frame: &Frame| frame.displacement[hook as usize].z;
    let ends = [0, 2, 4].map(|k| lift(&ran.frames[k]));
    assert_eq!(ends[0], 0.0);
    assert!((ends[1] - 0.3).abs() < 0.05 && ends[1] > 0.2, "{ends:?}");
    assert!(ends[2].abs() < 1e-9, "{ends:?}");
    let frame = &ran.frames[2];
    let distance = (mesh.points[held[0] as usize] + frame.displacement[held[0] as usize])
        - (mesh.points[hook as usize] + frame.displacement[hook as usize]);
    assert!((distance.norm() - 2.5).abs() < 1e-10);
}

/// A rigid block next to a held solid, turned by three full turns.
#[test]
fn three_prescribed_turns_bring_a_rigid_body_back() {
    let mut mesh = Mesh::default();
    let cells = block(&mut mesh, [1; 3], Vec3::ZERO, Vec3::new(1.0, 1.0, 1.0));
    let rigid = block(
        &mut mesh,
        [2, 1, 1],
        Vec3::new(3.0, 0.0, 0.0),
        Vec3::new(2.0, 1.0, 0.5),
    );
    let base = Target::Nodes(nodes_at(&mesh, 0, 0.0));
    for axis in [Vec3::unit(2), Vec3::new(0.48, 0.6, 0.64)] {
        let turn: Vec<_> = (0..3).map(|c| (c + 3, axis[c] * 3.0 * TAU)).collect();
        let body = BodyPart {
            name: "tool".into(),
            cells: rigid.clone(),
            kind: BodyKind::Rigid {
                carrier: 0,
                density: None,
            },
        };
        let ran = run(Parts {
            bodies: vec![solid("cube", cells.clone()), body],
            carriers: vec![carrier("tool", [3.0, 0.2, -0.3])],
            steps: vec![step(
                120,
                true,
                vec![
                    prescribe(base.clone(), &ALL),
                    prescribe(Target::Rigid(0), &turn),
                ],
            )],
            ..Parts::new(&mesh, Idealisation::Space)
        });
        for (x, start) in ran.state.x.iter().zip(&mesh.points) {
            assert!((*x - *start).max_abs() < 1e-10);
        }
        let turned = ran.state.poses[0].rotation - Mat3::IDENTITY;
        assert!(turned.rows.iter().all(|r| r.max_abs() < 1e-10));
        assert!(ran.frames[10].displacement[8 + 5].norm() > 0.5);
    }
}

#[test]
fn rotations_stay_rotations_over_thousands_of_increments() {
    let layout = Layout::new(3, 1, 1);
    let body = RigidBody {
        reference: Vec3::ZERO,
        nodes: vec![0],
    };
    let (elimination, reference) = (Elimination::new(vec![body], 1), [Vec3::new(1.0, 2.0, 3.0)]);
    let mut state = State::initial(&layout, &reference, &elimination);
    for k in 0..20_000 {
        let base = state.clone();
        let k = f64::from(k);
        let du = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, (0.1 * k).sin(), k.cos(), 0.3];
        state.advance_from(&base, &du, 1.0, &layout, &reference, &elimination);
    }
    let r = state.poses[0].rotation;
    let off = r * r.transpose() - Mat3::IDENTITY;
    assert!(
        off.rows.iter().all(|r| r.max_abs() < 1e-15 * 4.0),
        "{off:?}"
    );
}
