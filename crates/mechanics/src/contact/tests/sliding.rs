//! What a contact remembers: a point that is led over a flat surface against a return written down by hand, frames that
//! turn, and checkpoints.

use super::super::discretization::{PointToSegment, SlidingRange, SurfacePair};
use super::super::friction::{Coulomb, Falling, FrictionLaw, Sliding, Stick, Tresca};
use super::super::law::{
    AugmentedNewton, ContactLaw, Gasket, Lagrange, Multiplier, Penalty, Uzawa,
};
use super::super::{Allowance, ContactPhase, Interface, InterfaceParts};
use super::scene::{Choice, Kind, Method, Scene};
use super::{Random, facets, largest, next_increment};
use crate::system::{
    Adaptive, Archive, Choices, ContactFrame, Dof, Elimination, Frame, Layout, NO_DOF, Order,
    Phase, Sink, State, Status, StepContext, Stored, Term, Work,
};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::sync::Arc;

const PENALTY: f64 = 100.0;
const STIFFNESS: f64 = 40.0;
const MU: f64 = 0.3;

fn coulomb() -> Arc<dyn FrictionLaw> {
    Arc::new(Coulomb {
        mu: MU,
        cap: f64::INFINITY,
    })
}

/// A point over a flat surface of six facets, its normal along the last axis; facets are not parallelograms.
struct Slider {
    interface: Interface,
    layout: Layout,
    reference: Vec<Vec3>,
    state: State,
    node: NodeId,
    /// The time of the next states.
    time: f64,
    step: StepContext,
}

/// Forces of a whole system.
struct Forces(Vec<f64>);

impl Sink for Forces {
    fn add(&mut self, dofs: &[Dof], force: &[f64], _: &[f64]) {
        for (&dof, f) in dofs.iter().zip(force).filter(|d| *d.0 != NO_DOF) {
            self.0[dof as usize] += f;
        }
    }

    fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

impl Slider {
    fn new(
        ndim: usize,
        at: Vec3,
        law: Box<dyn ContactLaw>,
        friction: Option<(Arc<dyn FrictionLaw>, Stick)>,
    ) -> Self {
        Self::held_for(SlidingRange::Finite, ndim, at, law, friction)
    }

    /// Whose point keeps its tangent plane for as long.
    fn held_for(
        sliding: SlidingRange,
        ndim: usize,
        at: Vec3,
        law: Box<dyn ContactLaw>,
        friction: Option<(Arc<dyn FrictionLaw>, Stick)>,
    ) -> Self {
        let mut random = Random::new(11);
        let (mut x, nodes): (Vec<Vec3>, Vec<Vec<NodeId>>) = if ndim == 2 {
            let x = (0..7).map(|k| Vec3::new(6.0 - f64::from(k), 0.0, 0.0));
            (x.collect(), (0..6).map(|k| vec![k, k + 1]).collect())
        } else {
            let node = |k: u32| {
                let shift = Vec3::new(random.signed(), random.signed(), 0.0) * 0.2;
                Vec3::new(f64::from(k % 4) * 2.0, f64::from(k / 4) * 2.0, 0.0) + shift
            };
            let quad = |k: u32| {
                let a = k / 3 * 4 + k % 3;
                vec![a, a + 1, a + 5, a + 4]
            };
            ((0..12).map(node).collect(), (0..6).map(quad).collect())
        };
        let primary = Arc::new(facets(&mut x, &nodes));
        let node = x.len() as NodeId;
        x.push(at);
        let vectors = usize::from(law.multiplier().is_unknown());
        let layout = Layout::new(ndim, x.len(), 0).with_multipliers(vectors * ndim);
        let pair = SurfacePair::new(vec![node], primary, 1.0);
        let mut method = Box::new(PointToSegment::at_nodes(&[node]));
        method.sliding = sliding;
        let parts = InterfaceParts {
            law: law.into(),
            phases: vec![ContactPhase {
                active: true,
                stands: true,
                present: true,
                friction,
                slip: None,
            }],
            ..InterfaceParts::new("led", pair, method, PENALTY)
        };
        let elimination = Arc::new(Elimination::default());
        let state = State::initial(&layout, &x, &elimination);
        Self {
            interface: Interface::new(parts, layout, elimination),
            layout,
            reference: x,
            state,
            node,
            time: 0.0,
            step: StepContext::default(),
        }
    }

    /// All forces with the point at a place.
    fn force_at(&mut self, place: Vec3) -> (State, Vec<f64>) {
        let mut du = vec![0.0; self.layout.ndof()];
        let way = place - self.state.x[self.node as usize];
        for c in 0..self.layout.ndim() {
            du[self.layout.node(self.node, c) as usize] = way[c];
        }
        let (base, nothing) = (self.state.clone(), Elimination::default());
        let mut state = base.clone();
        state.advance_from(&base, &du, 1.0, &self.layout, &self.reference, &nothing);
        state.time = self.time;
        self.interface.prepare(&state, Order::Tangent).unwrap();
        let mut forces = Forces(vec![0.0; self.layout.ndof()]);
        self.interface
            .evaluate(
                0,
                &state,
                Order::Residual,
                &mut Work::default(),
                &mut forces,
            )
            .unwrap();
        (state, forces.0)
    }

    fn begin(&mut self) {
        let increment = next_increment().increment;
        let phase = Phase {
            step: self.step,
            increment,
        };
        self.interface.begin(&phase, &self.state).unwrap();
    }

    /// An increment that leads the point to a place; the force on it, and its report.
    fn go(&mut self, place: Vec3) -> (Vec3, ContactFrame) {
        self.begin();
        let (state, forces) = self.force_at(place);
        self.interface.verdict(&state);
        self.interface.accept(&state).unwrap();
        self.state = state;
        let mut frame = Frame::new(self.layout.nnode(), &[]);
        self.interface.report(&self.state, &mut frame).unwrap();
        let first = self.layout.node(self.node, 0) as usize;
        let mut force = Vec3::ZERO;
        for c in 0..self.layout.ndim() {
            force[c] = forces[first + c];
        }
        (force, frame.contacts.remove(0))
    }
}

/// The return of one point on a flat surface.
#[derive(Default)]
struct Return {
    elastic: Vec3,
    slip: Vec3,
    path: f64,
    work: f64,
}

impl Return {
    /// The tangential force, and whether it slips.
    fn go(
        &mut self,
        way: Vec3,
        pressure: f64,
        law: &dyn FrictionLaw,
        stick: Stick,
    ) -> (Vec3, bool) {
        let path = self.path;
        let limit = law.limit(&Sliding { pressure, path }).value;
        let stiffness = match stick {
            Stick::Stiffness(stiffness) => stiffness,
            Stick::Slip(length) => limit / length,
        };
        let trial = self.elastic + way;
        let size = trial.norm();
        if stiffness * size <= limit {
            self.elastic = trial;
            return (trial * stiffness, false);
        }
        self.elastic = trial * (limit / stiffness / size);
        let slipped = trial - self.elastic;
        let traction = self.elastic * stiffness;
        self.slip += slipped;
        self.path += slipped.norm();
        self.work += traction.dot(slipped);
        (traction, true)
    }
}

/// To and fro over all facets, deeper and less deep.
fn course(ndim: usize) -> Vec<Vec3> {
    let place = |k: u32| {
        let s = f64::from(k) * 0.1;
        let depth = -0.02 * (1.5 + (0.7 * s).sin());
        let x = 3.0 - 2.6 * (0.6 * s).cos();
        if ndim == 2 {
            Vec3::new(x, depth, 0.0)
        } else {
            Vec3::new(x, 2.0 + 1.7 * (0.9 * s).sin(), depth)
        }
    };
    (0..160).map(place).collect()
}

#[test]
fn a_point_that_is_led_follows_the_return() {
    let falling = Falling {
        stationary: 0.5,
        kinetic: 0.2,
        transition: 1.0,
    };
    let laws: [Arc<dyn FrictionLaw>; 3] = [coulomb(), Arc::new(Tresca(0.7)), Arc::new(falling)];
    // the surface is flat: a tangent plane that is held is everybody's
    let ranges = [
        SlidingRange::Finite,
        SlidingRange::Increment,
        SlidingRange::Small,
    ];
    for ndim in [2, 3] {
        for law in &laws {
            for stick in [Stick::Stiffness(STIFFNESS), Stick::Slip(0.02)] {
                for sliding in ranges {
                    follow(sliding, ndim, law, stick);
                }
            }
        }
    }
}

fn follow(sliding: SlidingRange, ndim: usize, law: &Arc<dyn FrictionLaw>, stick: Stick) {
    let course = course(ndim);
    let normal = ndim - 1;
    let penalty = Box::new(Penalty);
    let friction = Some((law.clone(), stick));
    let mut slider = Slider::held_for(sliding, ndim, course[0], penalty, friction);
    let mut by_hand = Return::default();
    let (mut sticks, mut reversals) = (0, 0);
    let mut slipped = false;
    for step in course.windows(2) {
        let (force, report) = slider.go(step[1]);
        let pressure = -PENALTY * step[1][normal];
        let mut way = step[1] - step[0];
        way[normal] = 0.0;
        let (traction, slips) = by_hand.go(way, pressure, law.as_ref(), stick);
        let mut expected = traction;
        expected[normal] = -pressure;
        assert!(
            (force - expected).max_abs() < 1e-11,
            "{sliding:?}: {force:?} {expected:?}"
        );
        assert_eq!(
            report.status[0],
            if slips { Status::Slip } else { Status::Stick }
        );
        assert!((report.slip[0] - by_hand.slip).max_abs() < 1e-11);
        assert!((report.work_friction - by_hand.work).abs() < 1e-11);
        sticks += usize::from(!slips);
        reversals += usize::from(slipped && !slips);
        slipped = slips;
    }
    // in the plane it turns back, in space it goes round
    assert!(
        ndim == 3 || (sticks > 2 && reversals > 2),
        "{sticks} {reversals}"
    );
    assert!(by_hand.path > 10.0 && by_hand.work > 1.0);
}

#[test]
fn increments_allow_for_what_overlaps_at_their_start() {
    // the times at the ends of increments, and the depths there
    let course = [(0.25, 0.05), (0.5, 0.06), (0.8, 0.02), (1.0, 0.07)];
    let deep = |depth: f64| Vec3::new(2.5, -depth, 0.0);
    let left = |from: f64, to: f64| (1.0 - to) / (1.0 - from);
    let cases = [
        (Allowance::Never, [0.0; 4]),
        (Allowance::First, [0.04 * left(0.0, 0.25), 0.0, 0.0, 0.0]),
        (
            Allowance::Every,
            [
                0.04 * left(0.0, 0.25),
                0.05 * left(0.25, 0.5),
                0.06 * left(0.5, 0.8),
                0.02 * left(0.8, 1.0),
            ],
        ),
    ];
    for (allowance, allowed) in cases {
        for sliding in [SlidingRange::Finite, SlidingRange::Increment] {
            let mut slider = Slider::held_for(sliding, 2, deep(0.04), Box::new(Penalty), None);
            slider.interface = {
                let (primary, node) = (slider.interface.parts().pair.primary.clone(), slider.node);
                let mut method = Box::new(PointToSegment::at_nodes(&[node]));
                method.sliding = sliding;
                let pair = SurfacePair::new(vec![node], primary, 1.0);
                let parts = InterfaceParts {
                    allowance,
                    ..InterfaceParts::new("led", pair, method, PENALTY)
                };
                Interface::new(parts, slider.layout, Arc::new(Elimination::default()))
            };
            // nothing is left to allow for in the second step
            for number in [0, 1] {
                let step = StepContext {
                    number,
                    start: number as f64,
                    duration: 1.0,
                    ..Default::default()
                };
                slider.step = step;
                slider
                    .interface
                    .begin(&Phase::of_step(step), &slider.state)
                    .unwrap();
                for ((time, depth), allowed) in course.into_iter().zip(allowed) {
                    slider.time = step.start + time;
                    let (force, _) = slider.go(deep(depth));
                    let allowed = if number == 0 { allowed } else { 0.0 };
                    let expected = -PENALTY * (depth - allowed).max(0.0);
                    assert!(
                        (force.y - expected).abs() < 1e-12,
                        "{allowance:?} {time}: {force:?} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn what_opens_forgets() {
    let stick = Stick::Stiffness(STIFFNESS);
    let friction = Some((coulomb(), stick));
    let start = Vec3::new(0.4, -0.02, 0.0);
    let mut slider = Slider::new(2, start, Box::new(Penalty), friction);
    let (slid, _) = slider.go(Vec3::new(1.4, -0.02, 0.0));
    assert!((slid.x - MU * 2.0).abs() < 1e-13);
    let (force, report) = slider.go(Vec3::new(1.5, 0.1, 0.0));
    assert_eq!((force, report.status[0]), (Vec3::ZERO, Status::Open));
    // it touches again where the increment began
    slider.go(Vec3::new(1.9, 0.01, 0.0));
    let (force, report) = slider.go(Vec3::new(1.905, -0.02, 0.0));
    assert_eq!(report.status[0], Status::Stick);
    assert!((force.x - STIFFNESS * 0.005).abs() < 1e-12, "{force:?}");
    let slip = 1.0 - MU * 2.0 / STIFFNESS;
    assert!((report.slip[0].x - slip).abs() < 1e-13);
}

#[test]
fn a_step_without_friction_forgets() {
    let stick = Stick::Stiffness(STIFFNESS);
    let start = Vec3::new(0.4, -0.02, 0.0);
    let mut slider = Slider::new(2, start, Box::new(Penalty), Some((coulomb(), stick)));
    slider.interface = {
        let parts = InterfaceParts {
            phases: [true, false, true]
                .map(|rubs| ContactPhase {
                    stands: true,
                    present: true,
                    active: true,
                    friction: rubs.then(|| (coulomb(), stick)),
                    slip: None,
                })
                .into(),
            ..InterfaceParts::new(
                "led",
                SurfacePair::new(
                    vec![slider.node],
                    slider.interface.parts().pair.primary.clone(),
                    1.0,
                ),
                Box::new(PointToSegment::at_nodes(&[slider.node])),
                PENALTY,
            )
        };
        Interface::new(parts, slider.layout, Arc::new(Elimination::default()))
    };
    let places = [0.7, 2.7, 2.701].map(|x| Vec3::new(x, -0.02, 0.0));
    let mut forces = Vec::new();
    for (number, place) in places.into_iter().enumerate() {
        let step = StepContext {
            number,
            ..Default::default()
        };
        slider.step = step;
        slider
            .interface
            .begin(&Phase::of_step(step), &slider.state)
            .unwrap();
        forces.push(slider.go(place).0.x);
    }
    let expected = [MU * 2.0, 0.0, STIFFNESS * 0.001];
    for (f, e) in forces.iter().zip(expected) {
        assert!((f - e).abs() < 1e-12, "{forces:?}");
    }
}

#[test]
fn multipliers_obey_the_return_of_alart_and_curnier() {
    let c = PENALTY;
    let laws = || -> [Box<dyn ContactLaw>; 3] {
        [
            Box::new(Lagrange),
            Box::new(AugmentedNewton),
            Box::new(Uzawa),
        ]
    };
    for ndim in [2, 3] {
        let normal = Vec3::unit(ndim - 1);
        let mut states = [0; 3];
        let mut random = Random::new(3);
        for _ in 0..60 {
            for law in laws() {
                let multiplier = law.multiplier();
                let flat = |v: Vec3| Vec3::new(v.x, v.y, if ndim == 2 { 0.0 } else { v.z });
                let start = if ndim == 2 {
                    Vec3::new(2.3, 0.0, 0.0)
                } else {
                    Vec3::new(2.3, 2.4, 0.0)
                };
                let stick = Stick::Stiffness(STIFFNESS);
                let mut slider = Slider::new(ndim, start, law, Some((coulomb(), stick)));
                slider.begin();
                let way = flat(random.vector()) * 0.01;
                let mut lambda = flat(random.vector()) * 0.5 - normal * 0.8;
                if multiplier == Multiplier::Frozen {
                    // frozen multipliers are the tractions of a moment ago
                    let (state, forces) = slider.force_at(start - normal * 0.01);
                    slider.interface.converged(&state).unwrap();
                    let first = slider.layout.node(slider.node, 0) as usize;
                    (0..ndim).for_each(|k| lambda[k] = forces[first + k]);
                } else {
                    for k in 0..ndim {
                        let dof = slider.layout.multiplier(k) as usize;
                        slider.state.u[dof] = lambda[k];
                    }
                }
                let (_, forces) = slider.force_at(start + way);

                let gap = way.dot(normal);
                let p = (-lambda.dot(normal) - c * gap).max(0.0);
                let along = |v: Vec3| v - normal * v.dot(normal);
                let z = along(lambda) + along(way) * c;
                let which = match p {
                    _ if p == 0.0 => 0,
                    _ if z.norm() <= MU * p => 1,
                    _ => 2,
                };
                states[which] += 1;
                let tangential = match which {
                    0 => Vec3::ZERO,
                    1 => z,
                    _ => z * (MU * p / z.norm()),
                };
                let that = tangential - normal * p;
                let force = match (multiplier, which) {
                    (Multiplier::Direct, 0) => Vec3::ZERO,
                    (Multiplier::Direct, _) => lambda,
                    _ => that,
                };
                let missing = (lambda - that) * (-1.0 / c);
                let node = slider.layout.node(slider.node, 0) as usize;
                for k in 0..ndim {
                    assert!((forces[node + k] - force[k]).abs() < 1e-13);
                    if multiplier.is_unknown() {
                        let dof = slider.layout.multiplier(k) as usize;
                        assert!((forces[dof] - missing[k]).abs() < 1e-13, "{multiplier:?}");
                    }
                }
            }
        }
        assert!(states.iter().all(|n| *n > 5), "{states:?}");
    }
}

fn rub(law: Box<dyn ContactLaw>) -> Choice {
    Choice {
        friction: Some((coulomb(), Stick::Stiffness(3.0))),
        ..Choice::of(law)
    }
}

/// Everything turned about the origin.
fn turned(scene: &Scene, turn: Mat3) -> State {
    let mut du = vec![0.0; scene.layout.ndof()];
    for (node, &x) in scene.state.x.iter().enumerate() {
        let way = turn * x - x;
        for c in 0..scene.layout.ndim() {
            du[scene.layout.node(node as NodeId, c) as usize] = way[c];
        }
    }
    scene.moved(&du, 1.0)
}

/// The largest difference between forces after a turn and turned forces, over the largest force.
fn turned_error(scene: &Scene, before: &[f64], after: &[f64], turn: Mat3) -> f64 {
    let error = |node: usize| {
        let node = node as NodeId;
        let expected = turn * scene.on_node(before, node);
        (scene.on_node(after, node) - expected).max_abs()
    };
    let errors: Vec<f64> = (0..scene.layout.nnode()).map(error).collect();
    largest(&errors) / largest(before)
}

#[test]
fn tractions_turn_with_what_they_act_on() {
    let turn = Mat3::rotation(Vec3::new(0.7, -1.1, 0.4));
    let in_plane = Mat3::rotation(Vec3::unit(2) * 1.3);
    // anchors that have slipped are put back onto facets: exactly where these are flat
    for (kind, again) in [
        ("line2", true),
        ("line3", false),
        ("tri3", true),
        ("quad9", false),
    ] {
        for method in [Method::NodeToSegment, Method::Gauss] {
            let kind = Kind::Elements(kind);
            let turn = if kind.ndim() == 2 { in_plane } else { turn };
            let mut scene = Scene::with_past(kind, method, rub(Box::new(Penalty)), 2);
            let state = scene.state.clone();
            let before = scene.respond(&state, Order::Residual).force;
            assert!(scene.report().area_stick > 0.0 && scene.report().area_slip > 0.0);
            let away = turned(&scene, turn);
            let after = scene.respond(&away, Order::Residual).force;
            let error = turned_error(&scene, &before, &after, turn);
            println!("{kind:?} {method:?}: {error:e}");
            assert!(error < 1e-12, "{kind:?} {method:?}: {error:e}");
            if !again {
                continue;
            }
            scene.respond(&state, Order::Residual);
            scene.interface.accept(&state).unwrap();
            scene.interface.begin(&next_increment(), &state).unwrap();
            let after = scene.respond(&away, Order::Residual).force;
            let error = turned_error(&scene, &before, &after, turn);
            println!("{kind:?} {method:?}, in the next increment: {error:e}");
            assert!(error < 1e-11, "{kind:?} {method:?}: {error:e}");
        }
    }
}

#[test]
fn a_loaded_memory_goes_on_bit_by_bit() {
    let tie = |law: Box<dyn ContactLaw>| Choice {
        bond: true,
        ..Choice::of(law)
    };
    let gasket = || {
        let loading = vec![[0.0, 0.0], [0.01, 0.2], [0.06, 0.5], [0.2, 2.0]];
        let opening = (0.2, vec![[0.05, 0.0], [0.2, 2.0]]);
        rub(Box::new(
            Gasket::new(loading, vec![opening], None, 0.0).unwrap(),
        ))
    };
    let choices: [&dyn Fn() -> Choice; 8] = [
        &gasket,
        &|| rub(Box::new(Penalty)),
        &|| rub(Box::new(Uzawa)),
        &|| rub(Box::new(Lagrange)),
        &|| tie(Box::new(Penalty)),
        &|| super::torn::torn(super::torn::cohesions().swap_remove(2), true),
        &|| tie(Box::new(Uzawa)),
        &|| Choice {
            friction: None,
            ..rub(Box::new(Uzawa))
        },
    ];
    let methods = [
        Method::NodeToSegment,
        Method::SmallSliding,
        Method::OfIncrement,
        Method::Gauss,
        Method::PrimaryNormals,
    ];
    for choice in choices {
        for method in methods {
            for kind in ["line3", "quad4"] {
                let kind = Kind::Elements(kind);
                let mut scene = Scene::with_past(kind, method, choice(), 5);
                let state = scene.state.clone();
                scene.interface.converged(&state).unwrap();
                scene.interface.accept(&state).unwrap();
                let mut archive = Archive::default();
                scene.interface.save(&mut archive);
                let mut other = Scene::new(kind, method, choice(), 5);
                other.interface.load(&archive).unwrap();
                other.state = state.clone();
                let mut random = Random::new(6);
                for _ in 0..3 {
                    let from = scene.state.clone();
                    let next = scene.further(&mut random);
                    let after = [&mut scene, &mut other].map(|s| {
                        s.interface.begin(&next_increment(), &from).unwrap();
                        let before = bits(s);
                        let whole = s.respond(&next, Order::Tangent);
                        let verdict = s.interface.verdict(&next);
                        let more = s.interface.converged(&next).unwrap();
                        s.interface.accept(&next).unwrap();
                        s.state = next.clone();
                        (before, whole.force, whole.stiffness, verdict, more, bits(s))
                    });
                    let [a, b] = after;
                    assert!(a == b, "{kind:?} {method:?}");
                }
            }
        }
    }
}

/// The report and the stored data, in full.
fn bits(scene: &Scene) -> String {
    let mut archive = Archive::default();
    scene.interface.save(&mut archive);
    format!("{:?} {archive:?}", scene.report())
}

#[test]
fn planes_of_an_increment_are_those_at_its_start() {
    let gaps = |method: Method| -> [Vec<f64>; 2] {
        let choice = Choice::of(Box::new(Penalty));
        let mut scene = Scene::new(Kind::Elements("quad8"), method, choice, 5);
        let mut random = Random::new(8);
        let start = scene.state.clone();
        scene.interface.begin(&next_increment(), &start).unwrap();
        scene.state = scene.further(&mut random);
        scene.settle();
        let state = scene.state.clone();
        scene.interface.accept(&state).unwrap();
        scene.interface.begin(&next_increment(), &state).unwrap();
        let at_start = scene.report().gap;
        scene.state = scene.further(&mut random);
        scene.settle();
        [at_start, scene.report().gap]
    };
    let ways = [
        Method::NodeToSegment,
        Method::OfIncrement,
        Method::SmallSliding,
    ];
    let [finite, increment, small] = ways.map(gaps);
    let apart = |a: &[f64], b: &[f64]| {
        let pairs = a
            .iter()
            .zip(b)
            .filter(|(a, b)| a.is_finite() && b.is_finite());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    // met again at the start, and kept from there
    assert!(apart(&increment[0], &finite[0]) < 1e-12);
    assert!(apart(&small[0], &finite[0]) > 1e-4);
    assert!(apart(&increment[1], &finite[1]) > 1e-4);
}
