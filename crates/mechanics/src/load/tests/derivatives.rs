//! Stiffness against differences of force, force against differences of energy.

use super::*;

/// What differences have to confirm of a term at a state.
fn check(single: &Single, term: &mut dyn Term, nonlinear: bool, what: &str) {
    term.begin(&Phase::of_step(step(nonlinear)), &single.state(&[]))
        .unwrap();
    let n = single.layout.ndof();
    let u: Vec<f64> = (0..n).map(|k| 0.06 * noise(100 + k)).collect();
    let at = |u: &[f64]| response(term, &single.layout, &single.state(u));
    let here = at(&u);
    let largest = |values: &[f64]| values.iter().fold(0.0f64, |m, k| m.max(k.abs()));
    let scale = largest(&here.residual);
    assert!(scale > 1e-3, "{what}: nothing acts");
    let h = 1e-3;
    for j in 0..n {
        let mut shifted = u.clone();
        let mut value = |d: f64| {
            shifted[j] = u[j] + d;
            at(&shifted)
        };
        // of fourth order: exact but for rounding, since loads are polynomials of low degree
        let (p1, m1, p2, m2) = (value(h), value(-h), value(2.0 * h), value(-2.0 * h));
        let slope = |a: f64, b: f64, c: f64, d: f64| (8.0 * (a - b) - (c - d)) / (12.0 * h);
        for i in 0..n {
            let [a, b, c, d] = [&p1, &m1, &p2, &m2].map(|r| r.residual[i]);
            let error = (slope(a, b, c, d) - here.stiffness[i * n + j]).abs();
            assert!(error < 1e-10 * scale, "{what} {i} {j}: {error:e}");
        }
        let energies = [&p1, &m1, &p2, &m2].map(|r| r.energy);
        if let [Some(a), Some(b), Some(c), Some(d)] = energies {
            let error = (slope(a, b, c, d) - here.residual[j]).abs();
            assert!(error < 1e-9 * scale, "{what} {j}: {error:e}");
        }
    }
    let transposed = |k: usize| here.stiffness[k % n * n + k / n];
    let skew = (0..n * n).map(|k| (here.stiffness[k] - transposed(k)).abs());
    let symmetric = skew.fold(0.0, f64::max) < 1e-14 * scale;
    assert!(
        symmetric || term.properties().symmetry == Symmetry::Unsymmetric,
        "{what}"
    );
    assert!(here.energy.is_none() || symmetric, "{what}");
}

#[test]
fn stiffness_and_force_of_every_load_are_derivatives() {
    let spin = Spin {
        speed: 1.7,
        point: Vec3::new(0.2, -0.3, 0.1),
        axis: Vec3::new(0.48, -0.6, 0.64),
    };
    let revolution = Spin {
        point: Vec3::ZERO,
        axis: Vec3::unit(1),
        ..spin
    };
    for (element, space) in cases() {
        let single = Single::new(element, space, 0.1);
        for nonlinear in [false, true] {
            let what = format!("{} {space:?} {nonlinear}", element.name());
            for side in 0..element.sides().len() {
                let mut pressure = single.pressure(single.face(side), 2.3);
                check(
                    &single,
                    &mut pressure,
                    nonlinear,
                    &format!("{what} pressure {side}"),
                );
                let energy = response(&pressure, &single.layout, &single.state(&[])).energy;
                assert_eq!(energy.is_none(), nonlinear);
            }
            let spin = if space == Idealisation::Axisymmetric {
                revolution
            } else {
                spin
            };
            let mut centrifugal = single.centrifugal(1.9, spin);
            check(
                &single,
                &mut centrifugal,
                nonlinear,
                &format!("{what} centrifugal"),
            );
            let x = &single.reference;
            let body = spread::over_cells(&single.volume(1.0), x, Vec3::new(0.3, -2.0, 1.0));
            check(
                &single,
                &mut single.dead(body),
                nonlinear,
                &format!("{what} body"),
            );
            let faces = spread::over_faces(&single.surface(), x, |n| Vec3::unit(0) * n.norm());
            check(
                &single,
                &mut single.dead(faces),
                nonlinear,
                &format!("{what} traction"),
            );
        }
    }
}

#[test]
fn a_pressure_that_does_not_act_in_a_step_leaves_the_system_symmetric_and_with_an_energy() {
    let quad = element::by_name("quad4").unwrap();
    let single = Single::new(quad, Idealisation::PlaneStrain { thickness: 1.0 }, 0.0);
    let mut pressure = FollowingPressure::new(
        "p",
        (single.surface(), 2.0),
        Schedule::ramps(&[1.0, 0.0, 0.0]),
        single.layout,
        single.reference.clone(),
    );
    let state = single.state(&[]);
    for (number, acts) in [(0, true), (1, true), (2, false), (3, false)] {
        let here = StepContext {
            number,
            ..step(true)
        };
        pressure.begin(&Phase::of_step(here), &state).unwrap();
        assert_eq!(
            pressure.properties().symmetry == Symmetry::Unsymmetric,
            acts
        );
        let energy = response(&pressure, &single.layout, &state).energy;
        assert_eq!(energy.is_none(), acts);
    }
    // small displacements: the pressure is dead
    pressure
        .begin(&Phase::of_step(step(false)), &state)
        .unwrap();
    assert_eq!(pressure.properties().symmetry, Symmetry::Definite);
}

#[test]
fn a_moment_in_space_has_an_energy_only_in_steps_in_which_it_swivels_about_one_axis() {
    let mut load = NodalForces::new("m", &[(0, 1.0)], Schedule::ramps(&[1.0, 1.0, 0.0, 0.0]))
        .swivelling(vec![false, true, true, true]);
    let layout = Layout::new(3, 1, 0);
    let state = State::initial(&layout, &[Vec3::ZERO], &Elimination::default());
    for (number, swivels) in [(0, false), (1, true), (2, true), (3, false)] {
        let here = StepContext {
            number,
            ..step(true)
        };
        load.begin(&Phase::of_step(here), &state).unwrap();
        let energy = response(&load, &layout, &state).energy;
        assert_eq!(energy.is_none(), swivels, "step {number}");
        assert_eq!(load.properties().symmetry == Symmetry::Unsymmetric, swivels);
    }
}
