//! Interfaces between the ends of an increment of a motion with inertia: their stiffness is that against the end.

use super::super::law::{AugmentedNewton, ContactLaw, Damping, Lagrange, Penalty};
use super::scene::{Choice, Kind, Method, Scene};
use super::{Random, largest, next_increment};
use crate::system::{Choices, Order, Phase, Scheme, State, StepContext, Term};

/// The state seen where the increment ends with `to`.
fn seen(scheme: &Scheme, scene: &Scene, from: &State, to: &State) -> State {
    let mut state = to.clone();
    state.set_between(scheme, &scene.layout, [from, to]);
    state
}

/// The increment of a motion with inertia.
fn increment(scheme: Scheme) -> Phase {
    let step = StepContext {
        scheme: Some(scheme),
        ..StepContext::default()
    };
    Phase {
        step,
        ..next_increment()
    }
}

/// The largest error of the tangent over its largest entry, and how large the multipliers' part is.
fn error(
    (scheme, damping): (Scheme, Damping),
    kind: Kind,
    method: Method,
    law: Box<dyn ContactLaw>,
    seed: u64,
) -> Option<f64> {
    let choice = Choice {
        damping,
        ..Choice::of(law)
    };
    let mut scene = Scene::new(kind, method, choice, seed);
    let mut random = Random::new(seed + 77);
    let from = scene.state.clone();
    scene.interface.begin(&increment(scheme), &from).unwrap();
    scene.state = scene.further(&mut random);
    let to = scene.state.clone();
    let here = seen(&scheme, &scene, &from, &to);
    let whole = scene.respond(&here, Order::Tangent);
    scene.interface.verdict(&here);
    let n = scene.layout.ndof();
    let v: Vec<f64> = (0..n).map(|_| random.signed()).collect();
    let h = 2e-6;
    let mut change = vec![0.0; n];
    for (step, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
        let there = scene.moved(&v, step * h);
        let there = seen(&scheme, &scene, &from, &there);
        let force = scene.respond(&there, Order::Residual).force;
        if !scene.is_settled(&there) {
            return None;
        }
        for (c, f) in change.iter_mut().zip(&force) {
            *c += weight * f / (12.0 * h);
        }
    }
    let along = whole.along(&v);
    assert!(largest(&along) > 0.0, "{kind:?} {method:?}: nothing acts");
    let wrong = along.iter().zip(&change).map(|(a, b)| (a - b).abs());
    Some(wrong.fold(0.0, f64::max) / largest(&along))
}

#[test]
fn the_stiffness_between_is_the_derivative_against_the_end() {
    let laws: [fn() -> Box<dyn ContactLaw>; 3] = [
        || Box::new(Penalty),
        || Box::new(Lagrange),
        || Box::new(AugmentedNewton),
    ];
    let none = Damping::default();
    let along = Damping {
        normal: 3.0,
        ..none
    };
    let across = Damping {
        tangential: 2.0,
        ..none
    };
    let all = Damping {
        normal: 3.0,
        pulls: true,
        ..across
    };
    // the tangent of what damps is exact where energy is conserved
    let schemes = [
        (Scheme::generalized_alpha(2.0 / 3.0), none),
        (Scheme::energy_momentum(), none),
        (Scheme::energy_momentum(), along),
        (Scheme::energy_momentum(), all),
        (Scheme::generalized_alpha(2.0 / 3.0), across),
    ];
    let methods = [
        Method::NodeToSegment,
        Method::SmallSliding,
        Method::Gauss,
        Method::SecondaryNormals,
        Method::Mortar,
        Method::HeldMortar,
    ];
    for name in ["line2", "line3", "tri3", "quad4"] {
        for method in methods {
            let mut tried = 0;
            for (number, law) in laws.iter().enumerate() {
                for seed in 0..4 {
                    let seed = 10 * number as u64 + seed;
                    for scheme in schemes {
                        let kind = Kind::Elements(name);
                        let Some(error) = error(scheme, kind, method, law(), seed) else {
                            continue;
                        };
                        tried += 1;
                        assert!(error < 2e-7, "{name} {method:?} {number} {seed}: {error:e}");
                    }
                }
            }
            assert!(tried >= 18, "{name} {method:?}: choices changed");
        }
    }
}
