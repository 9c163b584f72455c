//! Wear: tangents of every method with every law, and what is taken off.

use super::Random;
use super::scene::{Choice, Kind, Method, Scene, Wears};
use super::table::{Friction, frictions, has_kink, laws, methods, tangent_error};
use crate::system::{Order, Stored, Term, Work};

/// Ways that rows find, and one that is given: about as compliant as the law.
const WEAR: [Wears; 2] = [
    Wears {
        coefficient: 0.3,
        slip: None,
    },
    Wears {
        coefficient: 0.3,
        slip: Some(1.2),
    },
];

fn scene(
    kind: Kind,
    method: Method,
    law: usize,
    friction: &Friction,
    wear: Wears,
    seed: u64,
) -> Scene {
    let choice = Choice {
        friction: friction.clone(),
        wear: Some(wear),
        ..Choice::of(laws().swap_remove(law))
    };
    let mut scene = Scene::with_past(kind, method, choice, seed);
    // where a pressure is zero and the gap is, wear has a corner
    let mut random = Random::new(seed + 50);
    let first = scene.layout.ndof() - scene.layout.nmultiplier();
    let corners = scene.state.u.iter_mut().skip(first).filter(|u| **u == 0.0);
    corners.for_each(|u| *u = 0.02 * random.signed());
    // and where a row has just met the other side, so that its way is zero
    let mut v = vec![0.0; scene.layout.ndof()];
    v[..first].fill_with(|| random.signed());
    scene.state = scene.moved(&v, 1e-3);
    // rows that slip the other way there do so before tangents are compared
    let there = scene.state.clone();
    for _ in 0..5 {
        scene.respond(&there, Order::Tangent);
        if scene.is_settled(&there) {
            break;
        }
    }
    scene
}

/// All methods with these laws and all frictions.
fn walk(kind: Kind, of_laws: &[usize], every: usize) {
    for method in methods(kind) {
        let every = if method.is_mortar() { 3 * every } else { every };
        for law in of_laws {
            for friction in frictions().iter().step_by(every) {
                for wear in WEAR {
                    let (mut tried, mut kinks) = (0, 0);
                    for seed in 1..=6 {
                        let mut scene = scene(kind, method, *law, friction, wear, seed);
                        let found = tangent_error(&mut scene, seed);
                        let (u, lambda) = (found.displacement, found.multiplier);
                        let how = friction
                            .as_ref()
                            .map(|(law, stick)| (law.limit(&Default::default()), *stick));
                        let name = format!("{kind:?} {method:?} {law} {how:?} {wear:?} {seed}");
                        if u.max(lambda) > 1e-7 && has_kink(&mut scene, seed) {
                            kinks += 1;
                            assert!(kinks < 3, "{name}: kinks at {kinks} seeds");
                            continue;
                        }
                        assert!(u < 1e-7 && lambda < 1e-7, "{name}: {u:e} {lambda:e}");
                        tried += found.tried;
                        if tried > 0 {
                            break;
                        }
                    }
                    assert!(
                        tried > 0,
                        "{kind:?} {method:?} {law} {wear:?}: nothing was tried"
                    );
                }
            }
        }
    }
}

#[test]
fn tangents_with_wear_match_differences_on_line2() {
    walk(Kind::Elements("line2"), &[0, 1, 2, 4, 5, 6], 1);
}

#[test]
fn tangents_with_wear_match_differences_on_circles() {
    walk(Kind::Circle, &[0, 2, 4, 5, 6], 1);
}

#[test]
fn tangents_with_wear_match_differences_on_tri3() {
    walk(Kind::Elements("tri3"), &[0, 4, 6], 4);
}

#[test]
#[ignore = "long"]
fn tangents_with_wear_match_differences_on_other_facets() {
    for kind in ["line3", "tri6", "quad4", "quad8", "quad9"] {
        walk(Kind::Elements(kind), &[0, 2, 4, 5, 6], 2);
    }
}

/// What is taken off is `K p s`, and with a given way and no friction, force has a potential.
#[test]
fn forces_of_a_given_way_have_a_potential() {
    for kind in [
        Kind::Elements("line2"),
        Kind::Elements("quad4"),
        Kind::Circle,
    ] {
        for law in [0, 1, 2, 4] {
            let method = Method::NodeToSegment;
            let mut scene = scene(kind, method, law, &None, WEAR[1], 3);
            let mut random = Random::new(7);
            let base = scene.state.clone();
            let n = scene.layout.ndof();
            let v: Vec<f64> = (0..n).map(|_| random.signed()).collect();
            let h = 1e-5;
            let force = scene.respond(&base, Order::Residual).force;
            let along: f64 = force.iter().zip(&v).map(|(f, v)| f * v).sum();
            let [plus, minus] = [h, -h].map(|h| {
                let there = scene.moved(&v, h);
                scene.respond(&there, Order::Residual);
                let mut work = Work::default();
                let mut of = |chunk| scene.interface.energy(chunk, &there, &mut work);
                let chunks = (0..scene.interface.nchunk()).map(|k| of(k).unwrap().unwrap());
                chunks.sum::<f64>()
            });
            let slope = (plus - minus) / (2.0 * h);
            let size = super::largest(&force);
            assert!(
                (slope - along).abs() < 1e-6 * size,
                "{kind:?} {law}: {slope} {along}"
            );
        }
    }
}

/// An accepted increment takes `K p s` off the row, K of the side that it is: the volume is that of the areas.
#[test]
fn what_is_worn_is_counted() {
    for method in [Method::NodeToSegment, Method::Gauss, Method::Mortar] {
        for law in [0, 4] {
            if law == 4 && method.is_inside() {
                continue;
            }
            let mut scene = scene(Kind::Elements("quad4"), method, law, &None, WEAR[1], 2);
            let before = scene.report().wear.unwrap();
            let report = scene.report();
            let pressed: f64 = report
                .pressure
                .iter()
                .zip(&report.area)
                .map(|(p, a)| p * a)
                .sum();
            let state = scene.state.clone();
            scene.interface.accept(&state).unwrap();
            let after = scene.report().wear.unwrap();
            let all: f64 = after
                .volume
                .iter()
                .zip(before.volume)
                .map(|(a, b)| a - b)
                .sum();
            // one of as many increments as the step has
            let expected = 0.3 * 1.2 * pressed * super::next_increment().dt();
            assert!(
                pressed > 0.0 && (all / expected - 1.0).abs() < 1e-9,
                "{method:?} {law}: {all} {expected}"
            );
            assert!((after.volume[1] / after.volume[0] - 0.3 / 0.7).abs() < 1e-12);
        }
    }
}
