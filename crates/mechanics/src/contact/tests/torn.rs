//! Bonds that break: tangents against differences, and forces that balance, in rows of every method.

use super::super::cohesion::{Bilinear, Cohesion, CohesiveLaw, Exponential, Initiation, Mixity};
use super::super::friction::{Coulomb, Stick};
use super::super::law::Penalty;
use super::scene::{Choice, Kind, Method, PENALTY, Scene};
use super::table::{Worst, balance, methods, tangent_error};
use crate::system::Order;
use std::sync::Arc;

const STRENGTH: [f64; 2] = [0.1, 0.16];

/// Laws of which scenes have rows that are whole, that break, and that are broken.
pub(super) fn cohesions() -> Vec<Cohesion> {
    let bilinear = |mixity, initiation| -> Arc<dyn CohesiveLaw> {
        let stiffness = [PENALTY, 0.8 * PENALTY];
        let toughness = [0.01, 0.03];
        Arc::new(Bilinear::new(stiffness, STRENGTH, toughness, mixity, initiation).unwrap())
    };
    let bk = Mixity::Interpolated(2.0);
    let laws = [
        (bilinear(bk, Initiation::Interpolated(2.0)), 0.0),
        (bilinear(Mixity::Power(1.3), Initiation::Quadratic), 0.0),
        (bilinear(bk, Initiation::Quadratic), 0.7),
        (
            Arc::new(Exponential::new(STRENGTH, [0.02; 2]).unwrap()),
            0.0,
        ),
    ];
    let cohesion = |(law, viscosity)| Cohesion { law, viscosity };
    laws.into_iter().map(cohesion).collect()
}

/// A joint that breaks, with friction where it is broken or without.
pub(super) fn torn(cohesion: Cohesion, rubs: bool) -> Choice {
    let friction = Coulomb {
        mu: 0.4,
        cap: f64::INFINITY,
    };
    Choice {
        friction: rubs.then(|| (Arc::new(friction) as _, Stick::Stiffness(PENALTY))),
        bond: true,
        cohesion: Some(cohesion),
        ..Choice::of(Box::new(Penalty))
    }
}

fn walk(kind: Kind) {
    for method in methods(kind) {
        let every = if method.is_mortar() { 2 } else { 1 };
        for (k, cohesion) in cohesions().into_iter().enumerate().step_by(every) {
            for rubs in [false, true] {
                let (mut worst, mut damage, mut kinks) = (Worst::default(), Vec::new(), 0);
                for seed in 1..=4 {
                    let choice = torn(cohesion.clone(), rubs);
                    let mut scene = Scene::with_past(kind, method, choice, seed);
                    let name = format!("{kind:?} {method:?} law {k} rubs {rubs} {seed}");
                    let found = tangent_error(&mut scene, seed);
                    // bonds that just begin to break, or to close, have two tangents
                    kinks += usize::from(found.displacement > 1e-7);
                    assert!(kinks < 2, "{name}: {:e}", found.displacement);
                    worst.tried += found.tried;
                    let state = scene.state.clone();
                    scene.respond(&state, Order::Tangent);
                    balance(&mut scene, method, true, true, &name);
                    damage.extend(scene.report().damage);
                }
                let some = damage.iter().any(|d| *d > 0.01 && *d < 0.99);
                assert!(worst.tried > 0 && some, "{kind:?} {method:?}: {damage:?}");
            }
        }
    }
}

#[test]
fn tangents_of_bonds_that_break_match_differences_on_line2() {
    walk(Kind::Elements("line2"));
}

#[test]
fn tangents_of_bonds_that_break_match_differences_on_line3() {
    walk(Kind::Elements("line3"));
}

#[test]
fn tangents_of_bonds_that_break_match_differences_on_quad4() {
    walk(Kind::Elements("quad4"));
}

#[test]
fn tangents_of_bonds_that_break_match_differences_on_rigid_surfaces() {
    for kind in [Kind::Circle, Kind::Sphere, Kind::Torus] {
        walk(kind);
    }
}

/// A joint with no damage has the forces of one that does not break, and of the same stiffness.
#[test]
fn a_strong_joint_that_breaks_is_one_that_does_not() {
    for method in [Method::NodeToSegment, Method::Gauss, Method::Mortar] {
        let kind = Kind::Elements("line3");
        let law = Bilinear::new(
            [PENALTY; 2],
            [1e3; 2],
            [1e9; 2],
            Mixity::Interpolated(1.0),
            Initiation::Quadratic,
        );
        let strong = Cohesion {
            law: Arc::new(law.unwrap()),
            viscosity: 0.0,
        };
        let choices = [None, Some(strong)].map(|cohesion| Choice {
            cohesion,
            ..torn(cohesions().swap_remove(0), false)
        });
        let [tied, breaks] = choices.map(|choice| {
            let mut scene = Scene::with_past(kind, method, choice, 3);
            let state = scene.state.clone();
            scene.respond(&state, Order::Residual).force
        });
        let size = super::largest(&tied);
        let apart = tied.iter().zip(&breaks).map(|(a, b)| (a - b).abs());
        assert!(
            size > 0.0 && apart.fold(0.0, f64::max) < 1e-12 * size,
            "{method:?}"
        );
    }
}
