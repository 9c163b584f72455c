use super::RigidInertia;
use super::tests::{Sum, begin, noise};
use crate::system::{
    BodyRates, Elimination, Layout, Order, Phase, Rates, RigidBody, RigidMass, Scheme, State,
    StepContext, Term, Work,
};
use signorini_geometry::tensor::{Sym3, Vec3};
use std::sync::Arc;

fn vector(seed: usize) -> Vec3 {
    Vec3::new(noise(seed), noise(seed + 1), noise(seed + 2))
}

/// A carrier with a mass off its reference point, which moves and turns, in a state in which it has turned.
fn scene(is_small: bool) -> (Layout, Elimination, RigidInertia, State) {
    let layout = Layout::new(3, 1, 1);
    let body = RigidBody {
        reference: Vec3::new(1.0, 2.0, -1.0),
        nodes: Vec::new(),
    };
    let elimination = Elimination::new(vec![body], 1);
    let mass = RigidMass {
        carrier: 0,
        mass: 2.5,
        arm: Vec3::new(0.3, -0.2, 0.5),
        inertia: Sym3::new(1.2, 2.0, 2.9, 0.1, -0.2, 0.15),
    };
    let rates = BodyRates {
        velocity: vector(1),
        acceleration: vector(4),
        spin: vector(7) * 2.0,
        spin_rate: vector(10),
    };
    let mut state = State::initial(&layout, &[Vec3::ZERO], &elimination);
    let turned: Vec<f64> = (0..layout.ndof()).map(|k| noise(90 + k)).collect();
    let start = state.clone();
    state.advance_from(&start, &turned, 1.0, &layout, &[Vec3::ZERO], &elimination);
    state.is_small = is_small;
    state.rates = Some(Rates::new(vec![Vec3::ZERO], vec![rates]));
    let inertia = RigidInertia::new(layout, Arc::new([mass]), &[rates]);
    (layout, elimination, inertia, state)
}

fn evaluate(inertia: &RigidInertia, layout: &Layout, trial: &State) -> Sum {
    let mut sum = Sum::new(layout.ndof());
    let mut work = Work::default();
    inertia
        .evaluate(0, trial, Order::Tangent, &mut work, &mut sum)
        .unwrap();
    sum
}

#[test]
fn stiffness_is_the_derivative_against_the_end() {
    let schemes = [
        Scheme::generalized_alpha(0.8),
        Scheme::generalized_alpha(0.0),
        Scheme::hilber_hughes_taylor(-0.2),
        Scheme::energy_momentum(),
    ];
    for (scheme, is_small) in schemes.into_iter().flat_map(|s| [(s, false), (s, true)]) {
        let (layout, elimination, mut inertia, from) = scene(is_small);
        begin(&mut inertia, scheme, 0.3, &from);
        let reference = [Vec3::ZERO];
        // an increment by most of a right angle, and a small one on top of it
        let end = |more: Option<(usize, f64)>| {
            let du: Vec<f64> = (0..layout.ndof()).map(|k| 0.8 * noise(40 + k)).collect();
            let mut to = from.clone();
            to.advance_from(&from, &du, 1.0, &layout, &reference, &elimination);
            if let Some((column, by)) = more {
                let mut du = vec![0.0; layout.ndof()];
                du[column] = by;
                let base = to.clone();
                to.advance_from(&base, &du, 1.0, &layout, &reference, &elimination);
            }
            let mut trial = from.clone();
            trial.set_between(&scheme, &layout, [&from, &to]);
            trial
        };
        let here = evaluate(&inertia, &layout, &end(None));
        for column in 0..layout.ndof() {
            let moved = |by: f64| evaluate(&inertia, &layout, &end(Some((column, by)))).force;
            let (up, down) = (moved(1e-5), moved(-1e-5));
            for row in 0..layout.ndof() {
                let slope = (up[row] - down[row]) / 2e-5;
                let got = here.stiffness[row * layout.ndof() + column];
                let off = (got - slope).abs();
                assert!(off < 1e-6, "{is_small} {row} {column}: {got} {slope}");
            }
        }
    }
}

/// Force and moment are what momentum and angular momentum about the present reference point change by, as increments get short.
#[test]
fn forces_are_the_rates_of_momentum() {
    let (layout, elimination, mut inertia, from) = scene(false);
    let body = inertia.bodies[0];
    let reference = [Vec3::ZERO];
    let scheme = Scheme::generalized_alpha(0.8);
    let mut before = f64::INFINITY;
    for h in [0.02, 0.01, 0.005] {
        begin(&mut inertia, scheme, h, &from);
        let rates = from.rates.as_ref().unwrap().bodies[0];
        // where constant rates of the start lead, to second order
        let rotation = body.rotation(&from);
        let (spin, spin_rate) = (rotation * rates.spin, rotation * rates.spin_rate);
        let arm = rotation * body.arm;
        let [velocity, acceleration] = body.at(&from, &rates, Vec3::ZERO);
        let turn = spin * h + spin_rate * (0.5 * h * h);
        let along = velocity * h + acceleration * (0.5 * h * h);
        let mut du = vec![0.0; layout.ndof()];
        for axis in 0..3 {
            du[layout.translation(0, axis) as usize] = along[axis];
            du[layout.rotation(0, axis) as usize] = turn[axis];
        }
        let mut to = from.clone();
        to.advance_from(&from, &du, 1.0, &layout, &reference, &elimination);
        let mut trial = from.clone();
        trial.set_between(&scheme, &layout, [&from, &to]);
        let got = evaluate(&inertia, &layout, &trial).force;
        let force = rates.acceleration * body.mass;
        let j = body.inertia.to_mat3();
        let torque = rotation * (j * rates.spin_rate + rates.spin.cross(j * rates.spin));
        let moment = arm.cross(force) + torque;
        let at = |dof: u32| got[dof as usize];
        let off = |axis: usize| {
            (at(layout.translation(0, axis)) - force[axis]).abs()
                + (at(layout.rotation(0, axis)) - moment[axis]).abs()
        };
        let error: f64 = (0..3).map(off).sum();
        assert!(error < 0.6 * before, "{h}: {error} after {before}");
        before = error;
    }
}

/// Where a step begins, mass times acceleration with the forces of turning gives the acceleration of a free body: none of its
/// centroid, and Euler's about it.
#[test]
fn a_free_body_begins_as_eulers_equations_say() {
    let (layout, _, mut inertia, from) = scene(false);
    let step = StepContext {
        scheme: Some(Scheme::generalized_alpha(0.8)),
        ..StepContext::default()
    };
    inertia.begin(&Phase::of_step(step), &from).unwrap();
    let body = inertia.bodies[0];
    let rates = from.rates.as_ref().unwrap().bodies[0];
    let j = body.inertia.to_mat3();
    let gyroscopic = rates.spin.cross(j * rates.spin);
    let spin_rate = body.inertia.inverse().unwrap().0.to_mat3() * gyroscopic * -1.0;
    let free = BodyRates {
        acceleration: Vec3::ZERO,
        spin_rate,
        ..rates
    };
    let [_, along] = body.at(&from, &free, Vec3::ZERO);
    let about = body.rotation(&from) * spin_rate;
    let sum = evaluate(&inertia, &layout, &from);
    let n = layout.ndof();
    for row in n - 6..n {
        let mut total = sum.force[row];
        for axis in 0..3 {
            total += sum.stiffness[row * n + layout.translation(0, axis) as usize] * along[axis];
            total += sum.stiffness[row * n + layout.rotation(0, axis) as usize] * about[axis];
        }
        assert!(total.abs() < 1e-12, "{row}: {total}");
    }
}

#[test]
fn the_way_of_a_body_is_what_its_poses_say() {
    let (layout, elimination, inertia, from) = scene(false);
    let body = inertia.bodies[0];
    let du: Vec<f64> = (0..layout.ndof()).map(|k| noise(60 + k)).collect();
    let mut to = from.clone();
    to.advance_from(&from, &du, 1.0, &layout, &[Vec3::ZERO], &elimination);
    let centroid = |state: &State| state.poses[0].origin + state.poses[0].rotation * body.arm;
    for scheme in [Scheme::generalized_alpha(0.8), Scheme::energy_momentum()] {
        let way = body.way_between(&scheme, &layout, [&from, &to]);
        assert!((way.centroid - (centroid(&to) - centroid(&from))).norm() < 1e-13);
        let off = (way.start * way.rotation - to.poses[0].rotation).rows;
        assert!(off.iter().all(|row| row.norm() < 1e-13));
    }
}

/// The moment of a method that conserves energy does the work that kinetic energy grows by, and is the change of angular
/// momentum over the time.
#[test]
fn conserving_moments_do_the_work_of_kinetic_energy() {
    let (layout, elimination, mut inertia, from) = scene(false);
    let (body, scheme, h) = (inertia.bodies[0], Scheme::energy_momentum(), 0.4);
    begin(&mut inertia, scheme, h, &from);
    let du: Vec<f64> = (0..layout.ndof()).map(|k| noise(60 + k)).collect();
    let mut to = from.clone();
    to.advance_from(&from, &du, 1.0, &layout, &[Vec3::ZERO], &elimination);
    let mut trial = from.clone();
    trial.set_between(&scheme, &layout, [&from, &to]);
    let force = evaluate(&inertia, &layout, &trial).force;
    let [along, about] = trial.between.as_ref().unwrap().turn[0];
    let axes = 0..3;
    let work = axes.map(|axis| {
        force[layout.translation(0, axis) as usize] * along[axis]
            + force[layout.rotation(0, axis) as usize] * about[axis]
    });
    let work: f64 = work.sum();
    let before = from.rates.as_ref().unwrap().bodies[0];
    let way = body.way_between(&scheme, &layout, [&from, &to]);
    let after = before.advanced(&scheme, h, &way);
    let gain = body.kinetic(&after) - body.kinetic(&before);
    assert!(gain.abs() > 1.0 && (work - gain).abs() < 1e-12 * gain.abs());
}
