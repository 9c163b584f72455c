//! Friction with its limit held: a potential, and the way it is used.

use super::super::friction::{Coulomb, Stick};
use super::super::kernel::{Contact, Lambda, Laws, Past};
use super::super::law::{ContactLaw, Penalty, Scale, Uzawa};
use super::super::row::Row;
use signorini_geometry::tensor::Vec3;

const FRICTION: Coulomb = Coulomb {
    mu: 0.3,
    cap: f64::INFINITY,
};

const LIMIT: f64 = 0.7;

/// A row in penetration that has come this way from its anchor.
fn row(slip: Vec3) -> Row {
    let mut row = Row {
        gap: -0.1,
        normal: Vec3::unit(2),
        ..Row::default()
    };
    row.sliding.slip = slip;
    row
}

#[test]
fn traction_is_the_slope_of_the_potential() {
    let scale = Scale {
        penalty: 20.0,
        shear: 20.0,
        length: 1.0,
    };
    let held = Past {
        limit: Some(LIMIT),
        ..Past::default()
    };
    let laws: [(&dyn ContactLaw, Stick, Vec3); 3] = [
        (&Penalty, Stick::Stiffness(5.0), Vec3::ZERO),
        (&Penalty, Stick::Slip(0.2), Vec3::ZERO),
        (&Uzawa, Stick::Stiffness(20.0), Vec3::new(0.1, -0.2, -2.0)),
    ];
    for (law, stick, vector) in laws {
        let laws = Laws {
            has_past: false,
            law,
            friction: Some(&FRICTION),
            stick,
            scale: &scale,
            bond: false,
            bond_tangential: None,
            cohesion: None,
            duration: 0.0,
            vectors: vector != Vec3::ZERO,
            shear: 20.0,
            vibrates: false,
            walks: false,
            answer: None,
        };
        let lambda = Lambda {
            scalar: 0.0,
            vector,
        };
        let mut states = Vec::new();
        for slip in [
            Vec3::new(0.005, 0.01, 0.0),
            Vec3::new(0.3, -0.2, 0.0),
            Vec3::new(-1.0, 0.4, 0.0),
        ] {
            let energy = |slip| laws.friction_energy(&row(slip), &lambda, LIMIT);
            let at = laws.traction(&row(slip), &lambda, held);
            for axis in 0..2 {
                let h = 1e-6;
                let step = Vec3::unit(axis) * h;
                let slope = (energy(slip + step) - energy(slip - step)) / (2.0 * h);
                let error = (slope - at.tangential[axis]).abs();
                assert!(error < 1e-8, "{slip:?}: {slope} {:?}", at.tangential);
            }
            states.push(at.state);
        }
        assert_eq!(states, [Contact::Stick, Contact::Slip, Contact::Slip]);
    }
}

#[test]
fn an_infinite_limit_is_sticking() {
    let scale = Scale {
        penalty: 20.0,
        shear: 20.0,
        length: 1.0,
    };
    let laws = Laws {
        has_past: false,
        law: &Penalty,
        friction: Some(&FRICTION),
        stick: Stick::Stiffness(5.0),
        scale: &scale,
        bond: false,
        bond_tangential: None,
        cohesion: None,
        duration: 0.0,
        vectors: false,
        shear: 20.0,
        vibrates: false,
        walks: false,
        answer: None,
    };
    let slip = Vec3::new(3.0, 4.0, 0.0);
    let past = Past {
        limit: Some(f64::INFINITY),
        ..Past::default()
    };
    let at = laws.traction(&row(slip), &Lambda::default(), past);
    assert_eq!((at.tangential, at.state), (slip * 5.0, Contact::Stick));
    let energy = laws.friction_energy(&row(slip), &Lambda::default(), f64::INFINITY);
    assert_eq!(energy, 0.5 * 5.0 * 25.0);
}

#[test]
fn a_row_on_its_limit_does_what_it_did_before() {
    let scale = Scale {
        penalty: 20.0,
        shear: 20.0,
        length: 1.0,
    };
    let limit = FRICTION.mu * 20.0 * 0.1;
    let exact = limit / 5.0;
    for stick in [Stick::Stiffness(5.0), Stick::Slip(exact)] {
        let laws = Laws {
            has_past: false,
            law: &Penalty,
            friction: Some(&FRICTION),
            stick,
            scale: &scale,
            bond: false,
            bond_tangential: None,
            cohesion: None,
            duration: 0.0,
            vectors: false,
            shear: 20.0,
            vibrates: false,
            walks: false,
            answer: None,
        };
        for off in [-1e-6, -1e-8, -1e-10, -1e-16, 0.0, 1e-16, 1e-10, 1e-8, 1e-6] {
            let slip = Vec3::unit(1) * (exact * (1.0 + off));
            let act = |state| {
                let past = Past {
                    state,
                    ..Past::default()
                };
                laws.traction(&row(slip), &Lambda::default(), past)
            };
            let [open, stuck, slipped] = [Contact::Open, Contact::Stick, Contact::Slip].map(act);
            // whatever it is called, the traction is the same
            assert_eq!(open.tangential, stuck.tangential);
            assert_eq!(open.tangential, slipped.tangential);
            assert!((open.tangential.norm() / limit - 1.0).abs() <= off.abs() + 1e-15);
            let states = (stuck.state, slipped.state);
            if off.abs() < 1e-9 {
                assert_eq!(states, (Contact::Stick, Contact::Slip));
            } else {
                assert_eq!(states, (open.state, open.state));
            }
        }
    }
    // no limit, no tie
    let past = Past {
        limit: Some(f64::INFINITY),
        state: Contact::Slip,
        ..Past::default()
    };
    let laws = Laws {
        has_past: false,
        law: &Penalty,
        friction: Some(&FRICTION),
        stick: Stick::Stiffness(5.0),
        scale: &scale,
        bond: false,
        bond_tangential: None,
        cohesion: None,
        duration: 0.0,
        vectors: false,
        shear: 20.0,
        vibrates: false,
        walks: false,
        answer: None,
    };
    let held = laws.traction(&row(Vec3::unit(0)), &Lambda::default(), past);
    assert_eq!(held.state, Contact::Stick);
    assert_eq!(
        laws.traction(&row(Vec3::ZERO), &Lambda::default(), past)
            .state,
        Contact::Stick
    );
}
