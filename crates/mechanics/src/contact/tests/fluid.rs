//! A fluid between the sides: every method with multipliers and without, on curves and surfaces.

use super::super::friction::{Coulomb, Stick};
use super::super::law::{AugmentedNewton, ContactLaw, Lagrange, Penalty, Uzawa};
use super::super::{Critical, Fluid};
use super::scene::{Choice, Kind, Method, Scene};
use super::table::{Worst, methods, tangent_error};
use super::{Random, largest, next_increment};
use crate::system::{Adaptive, Archive, Choices, Order, Stored, Term, Verdict, Work};
use std::sync::Arc;

const KINDS: [&str; 7] = ["line2", "line3", "tri3", "tri6", "quad4", "quad8", "quad9"];

fn laws() -> [Box<dyn ContactLaw>; 4] {
    [
        Box::new(Penalty),
        Box::new(Uzawa),
        Box::new(AugmentedNewton),
        Box::new(Lagrange),
    ]
}

/// Nodes from one that a fluid comes from to the next: so that it reaches most rows, and so that facets stay dry.
const DENSE: usize = 7;
const SPARSE: usize = 29;

/// A fluid that comes from some of the first nodes of both sides.
fn fluid(critical: Critical, every: usize) -> Option<Fluid> {
    Some(Fluid {
        seeds: (0..40).step_by(every).collect(),
        pressures: vec![[0.4, 0.4]],
        critical,
        ramp: 0.0,
        recedes: true,
    })
}

fn choice(law: Box<dyn ContactLaw>, rubs: bool, critical: Critical, every: usize) -> Choice {
    let coulomb = Coulomb {
        mu: 0.4,
        cap: f64::INFINITY,
    };
    Choice {
        friction: rubs.then(|| (Arc::new(coulomb) as _, Stick::Stiffness(3.0))),
        fluid: fluid(critical, every),
        ..Choice::of(law)
    }
}

/// Rows that are wet, over all that meet something.
fn wet(scene: &Scene) -> [usize; 2] {
    let report = scene.report();
    let wet = report.wet.iter().filter(|part| **part > 0.0).count();
    [wet, report.wet.len()]
}

/// Tangent and balance of one choice, where the fluid comes from so many nodes; what was tried, and whether some rows are wet
/// and others dry.
fn check(
    kind: Kind,
    method: Method,
    law: usize,
    rubs: bool,
    every: usize,
    seed: u64,
) -> (Worst, bool) {
    let law = laws().into_iter().nth(law).unwrap();
    let name = format!("{kind:?} {method:?} {:?} {rubs}", law.multiplier());
    let choice = choice(law, rubs, Critical::Pressure(0.05), every);
    let mut scene = Scene::with_past(kind, method, choice, seed);
    let [is_wet, all] = wet(&scene);
    assert!(is_wet > 0 || every == SPARSE, "{name}");
    let found = tangent_error(&mut scene, seed);
    assert!(
        found.displacement < 1e-7 && found.multiplier < 1e-7,
        "{name}: {:e} {:e}",
        found.displacement,
        found.multiplier
    );
    let state = scene.state.clone();
    let whole = scene.respond(&state, Order::Residual);
    let (force, _, size) = scene.resultant(&whole.force);
    assert!(force.norm() < 1e-12 * size, "{name}: {force:?} of {size}");
    (found, is_wet > 0 && is_wet < all)
}

/// All methods and laws; somewhere, rows stay dry.
fn walk(kind: Kind) {
    const SEED: u64 = 3;
    let (mut some, mut tried) = (false, 0);
    for method in methods(kind) {
        for law in 0..laws().len() {
            for rubs in [false, true] {
                let (found, has_dry) = check(kind, method, law, rubs, DENSE, SEED);
                some |= has_dry;
                tried += found.tried;
            }
        }
    }
    // a facet of many nodes has one of those that the fluid comes from
    let mut others = SEED + 1..SEED + 6;
    let method = Method::NodeToSegment;
    let some = some || others.any(|seed| check(kind, method, 0, false, SPARSE, seed).1);
    assert!(some && tried > 0, "{kind:?}: {tried}");
}

#[test]
fn tangents_match_differences_and_loads_balance_on_curves() {
    for kind in &KINDS[..2] {
        walk(Kind::Elements(kind));
    }
}

#[test]
#[ignore = "takes its time without optimization"]
fn tangents_match_differences_and_loads_balance_on_surfaces() {
    for kind in &KINDS[2..] {
        walk(Kind::Elements(kind));
    }
}

#[test]
fn its_force_is_that_of_its_energy() {
    for kind in ["line2", "line3", "quad4"] {
        for method in [Method::NodeToSegment, Method::Gauss, Method::SmallSliding] {
            let choice = choice(Box::new(Penalty), false, Critical::Pressure(9.0), DENSE);
            let mut scene = Scene::with_past(Kind::Elements(kind), method, choice, 2);
            let mut random = Random::new(5);
            let base = scene.state.clone();
            let force = scene.respond(&base, Order::Residual).force;
            let n = force.len();
            let v: Vec<f64> = (0..n).map(|_| random.signed()).collect();
            let mut work = Work::default();
            let h = 1e-5;
            let mut energy = |by: f64| -> f64 {
                let there = scene.moved(&v, by);
                scene.interface.prepare(&there, Order::Residual).unwrap();
                let chunks = 0..scene.interface.nchunk();
                let of = |chunk| scene.interface.energy(chunk, &there, &mut work).unwrap();
                chunks.map(of).map(Option::unwrap).sum()
            };
            let slope = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h)))
                / (12.0 * h);
            let along: f64 = force.iter().zip(&v).map(|(f, v)| f * v).sum();
            let error = (slope - along).abs();
            assert!(
                error < 1e-7 * largest(&force),
                "{kind} {method:?}: {error:e}"
            );
        }
    }
}

#[test]
fn a_front_stays_within_an_increment_and_is_the_same_after_it_was_loaded() {
    for method in [Method::NodeToSegment, Method::Gauss, Method::Mortar] {
        let make = || {
            let mut choice = choice(Box::new(Penalty), true, Critical::Fluid, DENSE);
            // a corner of the secondary side
            choice.fluid.as_mut().unwrap().seeds = vec![16];
            Scene::new(Kind::Elements("quad4"), method, choice, 4)
        };
        let mut scene = make();
        let start = scene.state.clone();
        scene.interface.begin(&next_increment(), &start).unwrap();
        scene.settle();
        let seeds = wet(&scene)[0];
        let verdict = scene.interface.converged(&start).unwrap();
        assert!(matches!(verdict, Verdict::Repeat { .. }), "{verdict:?}");
        let [reached, all] = wet(&scene);
        assert!(seeds > 0 && reached > seeds, "{seeds} {reached} {all}");
        // an increment that is cut begins again where it began
        scene.interface.reject();
        assert_eq!(wet(&scene)[0], seeds);
        scene.interface.begin(&next_increment(), &start).unwrap();
        scene.settle();
        scene.interface.converged(&start).unwrap();
        scene.interface.accept(&start).unwrap();
        let mut archive = Archive::default();
        scene.interface.save(&mut archive);
        let mut resumed = make();
        resumed.interface.load(&archive).unwrap();
        for scene in [&mut scene, &mut resumed] {
            scene.interface.begin(&next_increment(), &start).unwrap();
            scene.settle();
        }
        let forces = [&mut scene, &mut resumed].map(|scene| {
            let state = scene.state.clone();
            scene.respond(&state, Order::Tangent)
        });
        assert_eq!(forces[0].force, forces[1].force, "{method:?}");
        assert_eq!(forces[0].stiffness, forces[1].stiffness, "{method:?}");
    }
}

#[test]
fn a_fluid_from_nowhere_is_refused() {
    let mut choice = choice(Box::new(Penalty), false, Critical::Fluid, DENSE);
    choice.fluid.as_mut().unwrap().seeds = vec![10_000];
    let kind = Kind::Elements("line2");
    let mut scene = Scene::new(kind, Method::NodeToSegment, choice, 1);
    let start = scene.state.clone();
    let refused = scene.interface.begin(&next_increment(), &start);
    let message = refused.unwrap_err().to_string();
    assert!(
        message.contains("no point of it is at the nodes"),
        "{message}"
    );
}
