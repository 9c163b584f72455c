//! Stresses that are secants: work against energy, balance of momenta, stiffness against differences.

use super::*;
use crate::system::Scheme;

/// A body halfway from one state to another, in a step that conserves energy.
fn between(body: &mut Body, [from, to]: [&[f64]; 2]) -> State {
    let scheme = Scheme::energy_momentum();
    body.solid.step.scheme = Some(scheme);
    let [from, to] = [from, to].map(|u| body.state(u));
    let mut middle = to.clone();
    middle.set_between(&scheme, &body.layout, [&from, &to]);
    middle
}

fn evaluate(body: &Body, at: &State, order: Order, work: &mut Work) -> Dense {
    let n = body.layout.ndof();
    let mut dense = Dense {
        force: vec![0.0; n],
        stiffness: vec![0.0; if order == Order::Tangent { n * n } else { 0 }],
    };
    for chunk in 0..body.solid.nchunk() {
        let outcome = body.solid.evaluate(chunk, at, order, work, &mut dense);
        outcome.unwrap();
    }
    dense
}

/// Each element in each space, with a law at a size of strains where secants are taken.
fn bodies() -> Vec<(String, Body)> {
    let laws = [
        ("neo-hookean", Kinematics::Finite),
        ("saint-venant-kirchhoff", Kinematics::Finite),
        ("no-tension", Kinematics::Small),
        ("ramberg-osgood", Kinematics::Small),
    ];
    let mut bodies = Vec::new();
    for (element, space) in elements() {
        let mesh = one(element, space);
        for (law, kinematics) in laws {
            let make = TABLE.iter().find(|l| l.name == law).unwrap().make;
            let material = make(&Constants::sample()).unwrap();
            let Ok(body) = body(&mesh, material, &Wish::plain(space, kinematics)) else {
                continue;
            };
            bodies.push((format!("{} {space:?} {law}", element.name()), body));
        }
    }
    bodies
}

/// Displacements at both ends: an element that is strained and turns.
fn ends(body: &Body) -> [Vec<f64>; 2] {
    let n = body.layout.ndof();
    let strained = |seed: usize, size: f64| (0..n).map(move |k| size * noise(seed + k));
    let from: Vec<f64> = strained(5, 0.03).collect();
    let to = strained(5, 0.05).zip(strained(61, 0.04));
    let to = to.map(|(one, other)| one + other).collect();
    [from, to]
}

#[test]
fn forces_do_the_work_of_the_energy_and_balance() {
    let mut work = Work::default();
    for (name, mut body) in bodies() {
        let [from, to] = ends(&body);
        let middle = between(&mut body, [&from, &to]);
        assert!(body.solid.takes_secants(), "{name}");
        let force = evaluate(&body, &middle, Order::Residual, &mut work).force;
        let ways = to.iter().zip(&from).map(|(to, from)| to - from);
        let done: f64 = force.iter().zip(ways).map(|(f, d)| f * d).sum();
        let [before, after] = [&from, &to].map(|u| body.energy(u, &mut work));
        let off = (done - (after - before)).abs();
        assert!(off < 1e-12 * after, "{name}: {done} {}", after - before);
        if body.solid.space == Idealisation::Axisymmetric {
            continue;
        }
        let ndim = body.layout.ndim();
        let (mut total, mut moment) = (Vec3::ZERO, Vec3::ZERO);
        for (f, x) in force.chunks_exact(ndim).zip(&middle.x) {
            let mut at = Vec3::ZERO;
            (0..ndim).for_each(|axis| at[axis] = f[axis]);
            total += at;
            // at small strain forces act where the nodes were
            moment += match body.solid.kinematics {
                Kinematics::Finite => x.cross(at),
                Kinematics::Small => Vec3::ZERO,
            };
        }
        let size = force.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        assert!(total.max_abs() < 1e-12 * size, "{name}");
        assert!(moment.max_abs() < 1e-12 * size, "{name}");
    }
}

#[test]
fn stiffness_is_that_against_the_end() {
    let mut work = Work::default();
    for (name, mut body) in bodies() {
        let [from, to] = ends(&body);
        let n = body.layout.ndof();
        let middle = between(&mut body, [&from, &to]);
        let here = evaluate(&body, &middle, Order::Tangent, &mut work);
        for column in 0..n {
            let mut moved = |by: f64| {
                let mut to = to.clone();
                to[column] += by;
                let middle = between(&mut body, [&from, &to]);
                evaluate(&body, &middle, Order::Residual, &mut work).force
            };
            let h = 1e-6;
            let (up, down) = (moved(h), moved(-h));
            for row in 0..n {
                let slope = (up[row] - down[row]) / (2.0 * h);
                let off = (here.stiffness[row * n + column] - slope).abs();
                assert!(off < 2e-7 * here.scale(), "{name} {row} {column}: {off:e}");
            }
        }
    }
}

/// The stiffness at the start of a run is that of any other step: whole, not that of a secant.
#[test]
fn the_initial_stiffness_is_that_of_other_steps() {
    let mut work = Work::default();
    for (name, mut body) in bodies() {
        let n = body.layout.ndof();
        let mut initial = |body: &Body| {
            let mut dense = Dense {
                force: vec![0.0; n],
                stiffness: vec![0.0; n * n],
            };
            for chunk in 0..body.solid.nchunk() {
                let outcome = body.solid.add_initial(chunk, &mut work, &mut dense);
                outcome.unwrap();
            }
            dense.stiffness
        };
        let usual = initial(&body);
        body.solid.step.scheme = Some(Scheme::energy_momentum());
        assert_eq!(initial(&body), usual, "{name}");
    }
}

/// Where nothing moves, or a body turns as it is, stresses are those of the mean place: nothing is divided by nothing.
#[test]
fn strains_that_do_not_change_have_their_own_stress() {
    let mut work = Work::default();
    for (name, mut body) in bodies() {
        let [from, _] = ends(&body);
        let middle = between(&mut body, [&from, &from]);
        let here = evaluate(&body, &middle, Order::Residual, &mut work).force;
        let alone = body.assemble(&from, Order::Residual, &mut work).force;
        let size = alone.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        let pairs = here.iter().zip(&alone);
        let off = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(off < 1e-12 * size, "{name}: {off:e}");
    }
}

#[test]
fn a_remedy_without_such_a_form_is_refused_by_name() {
    let mesh = one(element::by_name("hex8").unwrap(), Idealisation::Space);
    let wish = Wish {
        locking: Locking::FBar,
        ..Wish::plain(Idealisation::Space, Kinematics::Finite)
    };
    let mut body = body(&mesh, elastic("neo-hookean", 0.3), &wish).unwrap();
    let step = StepContext {
        nonlinear: true,
        scheme: Some(Scheme::energy_momentum()),
        ..StepContext::default()
    };
    let from = body.state(&vec![0.0; body.layout.ndof()]);
    let refused = body.solid.begin(&Phase::of_step(step), &from).unwrap_err();
    let message = refused.to_string();
    assert!(
        message.contains("hex8") && message.contains("f-bar"),
        "{message}"
    );
}
