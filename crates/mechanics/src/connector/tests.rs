//! Connectors between loose nodes, nodes of rigid bodies, nodes that follow along one axis, and nodes in equations.

use super::*;
use crate::system::{
    Assembler, Assembly, Elimination, Idealisation, Layout, Order, Phase, Relation, RigidBody,
    StepContext, Term,
};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use signorini_linear::apply;
use std::sync::Arc;

fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898 + 4.1414).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

struct Scene {
    layout: Layout,
    reference: Arc<[Vec3]>,
    elimination: Elimination,
    terms: Vec<Box<dyn Term>>,
    state: State,
}

/// Nodes of the scene: 0 to 7 in a plane, 8 to 15 anywhere.
const NNODE: usize = 16;

impl Scene {
    /// Nodes of [`places`] that follow as [`followers`] says, joined by the term of this name.
    fn new(ndim: usize, nonlinear: bool, which: &str) -> Self {
        let layout = Layout::new(ndim, NNODE, 2).with_multipliers(8 + 6);
        let reference = places(ndim, which);
        let elimination = followers(&layout, &reference);
        let mut term = joint(which, &layout, &reference, &elimination);
        let state = State::initial(&layout, &reference, &elimination);
        let step = StepContext {
            nonlinear,
            ..StepContext::default()
        };
        term.begin(&Phase::of_step(step), &state).unwrap();
        let mut scene = Self {
            layout,
            reference,
            elimination,
            terms: vec![term],
            state,
        };
        for round in 0..2 {
            let du: Vec<f64> = (0..layout.ndof())
                .map(|k| 0.4 * noise(5000 + 89 * round + k))
                .collect();
            scene.state = scene.moved(&du, 1.0);
        }
        scene
    }

    fn moved(&self, du: &[f64], by: f64) -> State {
        let mut state = self.state.clone();
        let (layout, x, e) = (&self.layout, &self.reference, &self.elimination);
        state.advance_from(&self.state, du, by, layout, x, e);
        state
    }

    fn assemble(&self, state: &State, order: Order) -> (Assembler, Assembly) {
        let mut assembler = Assembler::new(&self.layout, &self.elimination, &self.terms);
        let mut out = Assembly::default();
        let (layout, e, terms) = (&self.layout, &self.elimination, &self.terms);
        assembler
            .assemble(layout, e, terms, state, order, &mut out)
            .unwrap();
        (assembler, out)
    }
}

/// Places of the nodes: 0 to 7 on a line or in a plane, 8 to 15 anywhere.
fn places(ndim: usize, which: &str) -> Arc<[Vec3]> {
    (0..NNODE)
        .map(|k| {
            if which == "line" && k < 8 && ndim == 3 {
                return Vec3::new(0.2, 0.1, 0.3) + Vec3::new(0.9, -0.4, 0.3) * noise(3 * k);
            }
            let mut x = Vec3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2));
            if k < 8 {
                x.z = 0.2 + 0.3 * x.x - 0.1 * x.y;
            }
            if ndim == 2 {
                x.z = 0.0;
                if k < 8 {
                    x.y = 0.1 + 0.3 * x.x;
                }
            }
            x
        })
        .collect()
}

/// Nodes 3 and 9 belong to the rigid body 0; node 10 follows it along y only; node 11 has a displacement in an equation with
/// node 9 and others; the first rotation of carrier 1 depends on a node.
fn followers(layout: &Layout, reference: &[Vec3]) -> Elimination {
    let ndim = layout.ndim();
    let body = |at: usize, nodes: &[NodeId]| RigidBody {
        reference: Vec3::new(
            noise(at),
            noise(at + 1),
            if ndim == 3 { noise(at + 2) } else { 0.0 },
        ),
        nodes: nodes.to_vec(),
    };
    let mut elimination = Elimination::new(vec![body(500, &[3, 9]), body(600, &[])], NNODE);
    elimination.couple(layout, reference, &[10], [false, true, false], 0);
    let turn = elimination.leader(layout.node(9, 0), layout).unwrap();
    let single = elimination.leader(layout.node(10, 1), layout).unwrap();
    let relations = vec![
        Relation {
            dof: layout.node(11, 0),
            terms: vec![
                (layout.translation(0, 0), 0.7),
                (layout.node(5, 1), -0.4),
                (layout.multiplier(13), 0.3),
            ],
            turns: vec![(turn, 0.7), (single, 0.2)],
        },
        Relation {
            dof: layout.translation(0, 1),
            terms: vec![(layout.node(6, 0), 0.5), (layout.node(12, 1), 0.25)],
            turns: Vec::new(),
        },
        Relation {
            dof: layout.rotation(0, 2),
            terms: vec![(layout.node(7, 0), 0.6), (layout.rotation(1, 2), -0.3)],
            turns: Vec::new(),
        },
    ];
    elimination.relate(layout, relations, None);
    elimination
}

/// The term of this name between nodes of the scene.
fn joint(
    which: &str,
    layout: &Layout,
    reference: &Arc<[Vec3]>,
    elimination: &Elimination,
) -> Box<dyn Term> {
    let layout = *layout;
    let nodes: Vec<NodeId> = (0..8).collect();
    match which {
        "plane" => Box::new(Plane::new(which, &nodes, reference.clone(), layout, 0).unwrap()),
        "line" => Box::new(Line::new(which, &nodes, reference.clone(), layout, 0).unwrap()),
        "rod" | "rope" => {
            let parts = DistanceParts {
                name: which,
                nodes: [3, 11],
                most: (which == "rope").then_some(0.1),
                stiffness: 100.0,
                reference,
                layout,
                first: 2,
            };
            Box::new(Distance::new(&parts).unwrap())
        }
        "twist" => {
            let parts = TwistParts {
                name: which,
                nodes: &[0, 3, 8, 9, 10, 11, 12],
                axis: match layout.ndim() {
                    2 => Vec3::unit(2),
                    _ => Vec3::new(0.3, -0.5, 0.8),
                },
                angle: layout.translation(1, 0),
                reference,
                layout,
                first: 4,
            };
            Box::new(Twist::new(&parts).unwrap())
        }
        "distributing" => Box::new(distributing(layout, reference, elimination)),
        _ => Box::new(springs(which, layout, reference)),
    }
}

fn distributing(
    layout: Layout,
    reference: &Arc<[Vec3]>,
    elimination: &Elimination,
) -> Distributing {
    let all: Vec<(NodeId, f64)> = [0, 3, 8, 9, 10, 11, 12]
        .iter()
        .map(|&n| (n, 1.0 + 0.5 * noise(900 + n as usize)))
        .collect();
    let parts = DistributingParts {
        name: "mean",
        nodes: &all,
        carrier: 1,
        at: elimination.bodies()[1].reference,
        reference,
        layout,
        space: match layout.ndim() {
            2 => Idealisation::PlaneStrain { thickness: 1.0 },
            _ => Idealisation::Space,
        },
        first: 7,
    };
    Distributing::new(parts).unwrap()
}

fn springs(which: &str, layout: Layout, reference: &Arc<[Vec3]>) -> Springs {
    let table = || SpringLaw::Table(vec![[-2.0, -0.3], [0.0, -0.1], [1.0, 0.2], [4.0, 0.5]]);
    let parts = SpringsParts {
        name: "springs",
        ends: &[
            (3, Some(12)),
            (9, Some(11)),
            (10, Some(5)),
            (13, Some(14)),
            (3, Some(6)),
        ],
        law: &match which {
            "buffers" => table(),
            _ => SpringLaw::Linear(3.0),
        },
        direction: None,
        reference,
        layout,
    };
    Springs::new(parts).unwrap()
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, v| m.max(v.abs()))
}

const STENCIL: [(f64, f64); 4] = [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)];

#[test]
fn tangents_match_differences_whatever_the_nodes_follow() {
    for ndim in [2, 3] {
        for nonlinear in [true, false] {
            for which in [
                "springs",
                "buffers",
                "plane",
                "line",
                "rod",
                "rope",
                "twist",
                "distributing",
            ] {
                let scene = Scene::new(ndim, nonlinear, which);
                let n = scene.layout.ndof();
                let (assembler, out) = scene.assemble(&scene.state, Order::Tangent);
                let h = 1e-3;
                let (mut error, mut size) = (0.0f64, 0.0f64);
                for dof in 0..n as Dof {
                    if scene.elimination.depends(dof, &scene.layout) {
                        assert_eq!(out.residual[dof as usize], 0.0);
                        continue;
                    }
                    let mut e = vec![0.0; n];
                    e[dof as usize] = 1.0;
                    let mut column = vec![0.0; n];
                    let (bulk, interface) = (assembler.bulk(), assembler.interface());
                    apply(bulk, interface, &out.values(), &e, &mut column);
                    for (step, weight) in STENCIL {
                        let there = scene.moved(&e, step * h);
                        let (_, out) = scene.assemble(&there, Order::Residual);
                        for (c, r) in column.iter_mut().zip(&out.residual) {
                            *c -= weight * r / (12.0 * h);
                        }
                    }
                    error = error.max(largest(column.iter().copied()));
                    size = size.max(largest(out.residual.iter().copied()));
                }
                assert!(size > 1e-3 && error < 1e-7, "{which} {ndim}: {error:e}");
            }
        }
    }
}

#[test]
fn the_force_of_springs_is_the_gradient_of_their_energy() {
    for (ndim, nonlinear, which) in [
        (2, true, "springs"),
        (3, true, "springs"),
        (3, false, "springs"),
        (3, true, "buffers"),
        (2, false, "buffers"),
    ] {
        let scene = Scene::new(ndim, nonlinear, which);
        let (mut assembler, out) = scene.assemble(&scene.state, Order::Residual);
        let h = 1e-3;
        for dof in 0..scene.layout.ndof() {
            if scene.elimination.depends(dof as Dof, &scene.layout) {
                continue;
            }
            let mut e = vec![0.0; scene.layout.ndof()];
            e[dof] = 1.0;
            let mut slope = 0.0;
            for (step, weight) in STENCIL {
                let energy = assembler.energy(&scene.terms, &scene.moved(&e, step * h));
                slope += weight * energy.unwrap().unwrap() / (12.0 * h);
            }
            assert!((slope - out.residual[dof]).abs() < 1e-8, "{dof}");
        }
    }
}

/// Forces of a term on nodes and carriers, without anything that follows: their sum and moment vanish.
#[test]
fn a_distributing_coupling_is_in_balance_and_follows_a_rigid_motion() {
    let mut scene = Scene::new(3, true, "distributing");
    scene.elimination = Elimination::new(
        scene
            .elimination
            .bodies()
            .iter()
            .map(|b| RigidBody {
                reference: b.reference,
                nodes: Vec::new(),
            })
            .collect(),
        NNODE,
    );
    let n = scene.layout.ndof();
    scene.state = State::initial(&scene.layout, &scene.reference, &scene.elimination);
    let zero = scene.state.clone();
    // all nodes turn with the carrier
    let theta = Vec3::new(0.9, -1.7, 1.1);
    let rotation = signorini_geometry::tensor::Mat3::rotation(theta);
    let origin = zero.poses[1].origin;
    let shift = Vec3::new(0.3, 4.0, -2.0);
    let mut du = vec![0.0; n];
    for node in 0..NNODE as NodeId {
        let arm = scene.reference[node as usize] - origin;
        for c in 0..3 {
            du[scene.layout.node(node, c) as usize] = (rotation * arm - arm + shift)[c];
        }
    }
    for c in 0..3 {
        du[scene.layout.translation(1, c) as usize] = shift[c];
        du[scene.layout.rotation(1, c) as usize] = theta[c];
    }
    for k in 7..13 {
        du[scene.layout.multiplier(k) as usize] = noise(k);
    }
    let moved = scene.moved(&du, 1.0);
    let (_, out) = scene.assemble(&moved, Order::Residual);
    let gaps = (7..13).map(|k| out.residual[scene.layout.multiplier(k) as usize]);
    assert!(largest(gaps) < 1e-14);
    let read = |dof: &dyn Fn(usize) -> Dof| {
        Vec3::new(
            out.residual[dof(0) as usize],
            out.residual[dof(1) as usize],
            out.residual[dof(2) as usize],
        )
    };
    let mut force = read(&|c| scene.layout.translation(1, c));
    let mut moment = read(&|c| scene.layout.rotation(1, c)) + moved.poses[1].origin.cross(force);
    assert!(force.norm() > 0.1);
    for node in 0..NNODE as NodeId {
        let f = read(&|c| scene.layout.node(node, c));
        force += f;
        moment += moved.x[node as usize].cross(f);
    }
    assert!(
        force.max_abs() < 1e-14 && moment.max_abs() < 1e-13,
        "{force:?} {moment:?}"
    );
}

/// Nodes that turn as a whole about an axis turn by that angle, also beyond half a turn.
#[test]
fn a_twist_is_the_angle_of_a_turn_and_a_rope_is_slack_below_its_length() {
    let layout = Layout::new(3, NNODE, 1).with_multipliers(2);
    let reference: Arc<[Vec3]> = (0..NNODE)
        .map(|k| Vec3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2)))
        .collect();
    let elimination = Elimination::new(Vec::new(), NNODE);
    let axis = Vec3::new(0.3, -0.5, 0.8).normalized().unwrap();
    let nodes = [0, 2, 5, 9, 13];
    let twist = Twist::new(&TwistParts {
        name: "twist",
        nodes: &nodes,
        axis,
        angle: layout.translation(0, 0),
        reference: &reference,
        layout,
        first: 0,
    });
    let rope = Distance::new(&DistanceParts {
        name: "rope",
        nodes: [1, 2],
        most: Some(50.0),
        stiffness: 7.0,
        reference: &reference,
        layout,
        first: 1,
    });
    let terms: Vec<Box<dyn Term>> = vec![Box::new(twist.unwrap()), Box::new(rope.unwrap())];
    for angle in [0.4, 2.5, 4.0, -5.5] {
        let rotation = signorini_geometry::tensor::Mat3::rotation(axis * angle);
        let mut du = vec![0.0; layout.ndof()];
        for &node in &nodes {
            let x = reference[node as usize];
            let moved = rotation * x - x + Vec3::new(3.0, -1.0, 2.0);
            for c in 0..3 {
                du[layout.node(node, c) as usize] = moved[c];
            }
        }
        du[layout.translation(0, 0) as usize] = angle;
        du[layout.multiplier(1) as usize] = 0.7;
        let zero = State::initial(&layout, &reference, &elimination);
        let mut state = zero.clone();
        state.advance_from(&zero, &du, 1.0, &layout, &reference, &elimination);
        let mut out = Assembly::default();
        Assembler::new(&layout, &elimination, &terms)
            .assemble(
                &layout,
                &elimination,
                &terms,
                &state,
                Order::Residual,
                &mut out,
            )
            .unwrap();
        let gap = out.residual[layout.multiplier(0) as usize];
        assert!(gap.abs() < 1e-14, "{angle}: {gap:e}");
        // λ goes back to zero and pulls at nothing
        assert!((out.residual[layout.multiplier(1) as usize] + 0.1).abs() < 1e-15);
        assert_eq!(out.residual[layout.node(1, 0) as usize], 0.0);
    }
}

#[test]
fn springs_without_length_direction_or_curve_are_refused() {
    let scene = Scene::new(3, true, "springs");
    let springs = |ends: &[(NodeId, Option<NodeId>)], direction| {
        let parts = SpringsParts {
            name: "s",
            ends,
            law: &SpringLaw::Linear(1.0),
            direction,
            reference: &scene.reference,
            layout: scene.layout,
        };
        Springs::new(parts).err()
    };
    let by = |rows: &[[f64; 2]]| {
        let parts = SpringsParts {
            name: "s",
            ends: &[(0, Some(1))],
            law: &SpringLaw::Table(rows.to_vec()),
            direction: None,
            reference: &scene.reference,
            layout: scene.layout,
        };
        Springs::new(parts).is_ok()
    };
    assert!(by(&[[0.0, 0.0], [0.0, 1.0], [2.0, 3.0]]));
    assert!(!by(&[]) && !by(&[[0.0, 0.0], [1.0, 0.0]]) && !by(&[[1.0, 0.0], [0.0, 1.0]]));
    let none = ConnectorError::NoLength { number: 1 };
    assert_eq!(springs(&[(4, Some(4))], None), Some(none));
    assert_eq!(
        springs(&[(4, None)], None),
        Some(ConnectorError::NoDirection { number: 1 })
    );
    assert_eq!(springs(&[(4, Some(4))], Some(Vec3::unit(0))), None);
}

/// Five nodes on a line, and numbers for what may join them.
fn nodes_on_a_line() -> (Arc<[Vec3]>, Layout) {
    let along = Vec3::new(0.3, 0.5, 0.1);
    let line = (0..5).map(|k| along * f64::from(k)).collect();
    (line, Layout::new(3, 5, 2).with_multipliers(8 + 6))
}

#[test]
fn couplings_of_nodes_that_do_not_define_them_are_refused() {
    let scene = Scene::new(3, true, "springs");
    let (line, layout) = nodes_on_a_line();
    let nodes = [0, 1, 2, 3, 4];
    let plane = Plane::new("p", &nodes, line.clone(), layout, 0)
        .err()
        .unwrap();
    assert!(matches!(plane, ConnectorError::Narrow { point: false, .. }));
    let distributing = |nodes: &[(NodeId, f64)]| {
        let parts = DistributingParts {
            name: "d",
            nodes,
            carrier: 0,
            at: Vec3::ZERO,
            reference: &line,
            layout,
            space: Idealisation::Space,
            first: 0,
        };
        Distributing::new(parts).err().unwrap()
    };
    let error = distributing(&[(0, 1.0), (1, 2.0), (3, 1.0)]);
    assert!(
        matches!(error, ConnectorError::Narrow { point: false, .. }),
        "{error}"
    );
    let error = distributing(&[(2, 1.0)]);
    assert!(
        matches!(error, ConnectorError::Narrow { point: true, .. }),
        "{error}"
    );
    assert!(matches!(
        distributing(&[(0, -1.0)]),
        ConnectorError::Number { .. }
    ));
    let mut bent = scene.reference.to_vec();
    bent[6].z += 0.01;
    let nodes: Vec<NodeId> = (0..8).collect();
    let plane = Plane::new("p", &nodes, bent.into(), scene.layout, 0)
        .err()
        .unwrap();
    assert!(matches!(plane, ConnectorError::Uneven { .. }), "{plane}");
    let bend = Line::new("l", &nodes, scene.reference.clone(), scene.layout, 0);
    assert!(matches!(bend, Err(ConnectorError::Uneven { .. })));
}

#[test]
fn twists_along_a_line_and_rods_without_length_are_refused() {
    let (line, layout) = nodes_on_a_line();
    let twist = |nodes: &[NodeId], axis: Vec3| {
        let parts = TwistParts {
            name: "t",
            nodes,
            axis,
            angle: layout.translation(0, 0),
            reference: &line,
            layout,
            first: 0,
        };
        Twist::new(&parts).err()
    };
    let along = Vec3::new(0.3, 0.5, 0.1);
    assert!(matches!(
        twist(&[0, 1, 2], along),
        Some(ConnectorError::Narrow { point: false, .. })
    ));
    assert!(twist(&[0, 1, 2], Vec3::unit(2)).is_none());
    assert!(twist(&[0, 1], Vec3::ZERO).is_some());
    let rod = |nodes: [NodeId; 2], most| {
        let parts = DistanceParts {
            name: "r",
            nodes,
            most,
            stiffness: 1.0,
            reference: &line,
            layout,
            first: 0,
        };
        Distance::new(&parts).err()
    };
    assert!(rod([1, 1], None).is_some() && rod([0, 1], Some(-1.0)).is_some());
    assert!(rod([0, 1], None).is_none());
}
