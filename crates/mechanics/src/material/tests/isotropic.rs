//! Closed forms of laws in principal axes, and values of CalculiX 2.20.

use super::*;

/// The constants of a law, in the order of its keys.
fn law(name: &str, values: &[f64]) -> Box<dyn Material> {
    let law = by_name(name).unwrap();
    let mut constants = Constants::default();
    assert_eq!(law.constants.len(), values.len());
    for (key, value) in law.constants.iter().zip(values) {
        constants.set(key.name, vec![*value]);
    }
    (law.make)(&constants).unwrap()
}

/// Cauchy's stress at a deformation gradient.
fn cauchy(material: &dyn Material, f: Mat3) -> Sym3 {
    let h = f - Mat3::IDENTITY;
    let e = Sym3::symmetric_part(h) + Sym3::gram(h) * 0.5;
    fresh(material, &finite(e)).stress.congruence(f) * f.determinant().recip()
}

/// Simple shear in the plane of x and z.
fn shear(gamma: f64) -> Mat3 {
    let mut f = Mat3::IDENTITY;
    f.rows[0].z = gamma;
    f
}

fn assert_close(found: Sym3, expected: Sym3, tolerance: f64) {
    let error = (found - expected).to_pairs();
    assert!(
        error.iter().all(|e| e.abs() < tolerance),
        "{found:?} {expected:?}"
    );
}

#[test]
fn rotated_linear_answers_a_turned_stretch_with_hooke_of_the_stretch() {
    let material = law("rotated-linear", &[1000.0, 0.3]);
    // ccx, UNDO_NLGEOM_LIN_ISO_EL
    let expected = Sym3::new(76.33963, 12.90856, 38.63048, 0.0, 0.0, 125.6972);
    assert_close(cauchy(material.as_ref(), shear(0.3)), expected, 1e-4);
    let hooke = Lame::new(1000.0, 0.3);
    for k in 0..5 {
        let (r, stretch) = (rotation(k), random(k + 7, 0.2));
        let f = r * (Mat3::IDENTITY + stretch.to_mat3());
        let mut of_stretch = Response::default();
        hooke.respond(&stretch, Order::Stress, &mut of_stretch);
        let expected = of_stretch.stress.congruence(f) * f.determinant().recip();
        assert_close(cauchy(material.as_ref(), f), expected, 1e-10);
    }
    // no contraction: a potential
    assert!(law("rotated-linear", &[1000.0, 0.0]).is_symmetric());
    assert!(!material.is_symmetric());
}

#[test]
fn a_rotated_linear_bar_has_the_nominal_stress_of_its_length() {
    // P = l S, and U − I across is −ν (l − 1)
    let bar = Reduced::uniaxial(law("rotated-linear", &[1000.0, 0.3]));
    for l in [0.5f64, 0.9, 1.2, 3.0] {
        let out = fresh(&bar, &finite(Sym3::diagonal(0.5 * (l * l - 1.0), 0.0, 0.0)));
        assert!((out.stress.xx() - 1000.0 * (l - 1.0)).abs() < 1e-9);
        let across = (1.0 + 2.0 * out.across).sqrt() - 1.0;
        assert!((across + 0.3 * (l - 1.0)).abs() < 1e-12);
    }
}

#[test]
fn ciarlet_has_its_shear_and_its_pressure() {
    let Lame { lambda, mu } = Lame::new(1000.0, 0.3);
    let material = law("ciarlet", &[1000.0, 0.3]);
    // σ = μ (b − I) where the volume stays
    let expected = Sym3::new(mu * 0.09, 0.0, 0.0, 0.0, 0.0, mu * 0.3);
    assert_close(cauchy(material.as_ref(), shear(0.3)), expected, 1e-10);
    for l in [0.3f64, 0.8, 1.7] {
        let found = cauchy(material.as_ref(), Mat3::IDENTITY * l);
        let mean = 0.5 * lambda * (l.powi(6) - 1.0) + mu * (l * l - 1.0);
        assert!((found.xx() * l.powi(3) - mean).abs() < 1e-10 * mean.abs());
    }
    // at small strain as ccx has it: C = I + 2ε
    let strain = Sym3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.15);
    let found = fresh(material.as_ref(), &Strain::new(Kinematics::Small, strain)).stress;
    let expected = Sym3::new(-66.56805, -25.96154, -66.56805, 0.0, 0.0, 135.3550);
    assert_close(found, expected, 1e-4);
}

#[test]
fn no_tension_tends_to_its_residual_and_to_hooke_and_no_compression_mirrors_it() {
    let [down, up] = ["no-tension", "no-compression"].map(|name| law(name, &[1000.0, 5.0]));
    let small = |law: &dyn Material, value| fresh(law, &Strain::new(Kinematics::Small, value));
    let c = std::f64::consts::PI * 5.0 / 1000.0;
    for e in [-0.3, -0.01, 1e-5, 0.02, 0.4f64] {
        let value = Sym3::diagonal(e, 0.0, 0.0);
        let out = small(down.as_ref(), value);
        let closed = 1000.0 * e * (0.5 - (e / c).atan() / std::f64::consts::PI);
        assert!((out.stress.xx() - closed).abs() < 1e-12 * closed.abs());
        assert_eq!(out.stress.yy(), 0.0);
        // the energy by Simpson's rule
        let n = 400;
        let at = |k: usize| {
            small(down.as_ref(), value * (k as f64 / n as f64))
                .stress
                .xx()
        };
        let inner: f64 = (1..n)
            .map(|k| if k % 2 == 1 { 4.0 } else { 2.0 } * at(k))
            .sum();
        let work = (at(0) + inner + at(n)) * e / (3.0 * n as f64);
        assert!(
            (out.energy - work).abs() < 1e-6 * work,
            "{e} {} {work}",
            out.energy
        );
    }
    assert!(
        (small(down.as_ref(), Sym3::diagonal(1e6, 0.0, 0.0))
            .stress
            .xx()
            - 5.0)
            .abs()
            < 1e-6
    );
    // ccx, small and finite strain
    let strain = Sym3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.15);
    let expected = Sym3::new(-70.01816, 0.0, -70.01816, 0.0, 0.0, 75.0);
    assert_close(small(down.as_ref(), strain).stress, expected, 1e-4);
    let expected = Sym3::new(-35.36441, 0.0, -50.02603, 0.0, 0.0, 48.87206);
    assert_close(cauchy(down.as_ref(), shear(0.3)), expected, 1e-4);
    for k in 0..4 {
        let value = random(k, 0.1);
        let (a, b) = (
            small(down.as_ref(), value),
            small(up.as_ref(), value * -1.0),
        );
        assert_close(a.stress, b.stress * -1.0, 1e-11);
        assert!((a.energy - b.energy).abs() < 1e-12 * a.energy);
    }
}

#[test]
fn constants_of_unilateral_laws_and_of_ramberg_osgood_are_judged() {
    let make = |name: &str, pairs: &[(&str, f64)]| {
        let mut constants = Constants::elastic(1000.0, 0.3);
        for (name, value) in pairs {
            constants.set(*name, vec![*value]);
        }
        (by_name(name).unwrap().make)(&constants).map(|_| ())
    };
    for residual in [0.0, -1.0, f64::NAN] {
        for name in ["no-tension", "no-compression"] {
            assert!(make(name, &[("residual", residual)]).is_err());
        }
    }
    let curve = |s, n, alpha| [("reference_stress", s), ("exponent", n), ("offset", alpha)];
    assert!(make("ramberg-osgood", &curve(10.0, 1.0, 0.0)).is_ok());
    for wrong in [
        curve(0.0, 5.0, 0.5),
        curve(10.0, 0.9, 0.5),
        curve(10.0, 5.0, -0.1),
    ] {
        for name in ["ramberg-osgood", "ramberg-osgood-eulerian"] {
            assert!(make(name, &wrong).is_err());
        }
    }
}

/// The strain under uniaxial stress by the curve.
fn curve(s: f64, [e, _, s0, n, alpha]: [f64; 5]) -> f64 {
    (s + alpha * (s.abs() / s0).powf(n - 1.0) * s) / e
}

const CURVES: [[f64; 5]; 5] = [
    [1000.0, 0.3, 10.0, 5.0, 0.5],
    [1000.0, 0.3, 10.0, 50.0, 0.5],
    [1000.0, 0.0, 10.0, 1.0, 0.5],
    [1000.0, 0.49, 10.0, 3.0, 3.0 / 7.0],
    [1000.0, 0.3, 10.0, 7.0, 0.0],
];

#[test]
fn uniaxial_stress_follows_the_curve_of_ramberg_and_osgood_at_every_size() {
    for constants in CURVES {
        for s in [-14.0, -9.0, 1e-6, 5.0, 10.0, 12.0] {
            let e = curve(s, constants);
            for name in ["ramberg-osgood", "ramberg-osgood-eulerian"] {
                let bar = Reduced::uniaxial(law(name, &constants));
                let strain = Strain::new(Kinematics::Small, Sym3::diagonal(e, 0.0, 0.0));
                let out = fresh(&bar, &strain);
                assert!(
                    (out.stress.xx() / s - 1.0).abs() < 1e-9,
                    "{name} {constants:?} {s}"
                );
                // E/(1 + n α (s/s₀)ⁿ⁻¹)
                let [young, _, s0, n, alpha] = constants;
                let slope = young / (1.0 + n * alpha * (s.abs() / s0).powf(n - 1.0));
                assert!((out.tangent[0][0] / slope - 1.0).abs() < 1e-7, "{name} {s}");
            }
            // (Kirchhoff, logarithm): S = τ/l²; (Cauchy, Almansi): S = J σ/l², l² = 1/(1 − 2e)
            if e.abs() > 0.3 {
                continue;
            }
            let bar = Reduced::uniaxial(law("ramberg-osgood", &constants));
            let green = 0.5 * (2.0 * e).exp_m1();
            let out = fresh(&bar, &finite(Sym3::diagonal(green, 0.0, 0.0)));
            assert!((out.stress.xx() * (1.0 + 2.0 * green) / s - 1.0).abs() < 1e-8);
            let bar = Reduced::uniaxial(law("ramberg-osgood-eulerian", &constants));
            let green = e / (1.0 - 2.0 * e);
            let out = fresh(&bar, &finite(Sym3::diagonal(green, 0.0, 0.0)));
            let (square, across) = (1.0 + 2.0 * green, 1.0 + 2.0 * out.across);
            let ratio = square.sqrt() * across;
            assert!(
                (out.stress.xx() * square / ratio / s - 1.0).abs() < 1e-8,
                "{s}"
            );
        }
    }
}

#[test]
fn far_up_a_steep_curve_the_volume_stays_and_the_stress_hardly_grows() {
    let constants = [1000.0, 0.3, 10.0, 50.0, 0.5];
    let e = 0.2;
    let strain = Strain::new(Kinematics::Small, Sym3::diagonal(e, 0.0, 0.0));
    let bar = Reduced::uniaxial(law("ramberg-osgood", &constants));
    let out = fresh(&bar, &strain);
    assert!(out.stress.xx() > 10.0 && out.stress.xx() < 11.0);
    // tr ε = (1 − 2ν) s/E
    let trace = 0.4 * out.stress.xx() / 1000.0;
    assert!((e + 2.0 * out.across - trace).abs() < 1e-12);
    assert!(
        (out.stress.xx() + 0.5 * (out.stress.xx() / 10.0).powi(49) * out.stress.xx() - 1000.0 * e)
            .abs()
            < 1e-6
    );
}

#[test]
fn ramberg_osgood_between_cauchy_and_almansi_has_the_values_of_calculix() {
    let material = law("ramberg-osgood-eulerian", &[1000.0, 0.3, 10.0, 5.0, 0.5]);
    let mut f = Mat3::IDENTITY;
    f.rows[2].z = 1.2;
    let expected = Sym3::diagonal(121.4194, 121.4194, 139.1057);
    // CalculiX stops its own iteration at about 1e-6
    assert_close(cauchy(material.as_ref(), f), expected, 2e-4);
}

#[test]
fn ramberg_osgood_is_hooke_without_offset_and_both_pairs_turn_with_the_body() {
    let hooke = Lame::new(1000.0, 0.3);
    for name in ["ramberg-osgood", "ramberg-osgood-eulerian"] {
        let material = law(name, &[1000.0, 0.3, 10.0, 5.0, 0.0]);
        let strain = Strain::new(Kinematics::Small, random(3, 0.1));
        let mut expected = Response::default();
        hooke.respond(&strain.value, Order::Tangent, &mut expected);
        let found = fresh(material.as_ref(), &strain);
        assert_close(found.stress, expected.stress, 1e-10);
        assert!((found.energy - expected.energy).abs() < 1e-10);
        let bent = law(name, &[1000.0, 0.3, 10.0, 5.0, 0.5]);
        let f = Mat3::IDENTITY + random(5, 0.2).to_mat3();
        let turned = cauchy(bent.as_ref(), rotation(2) * f);
        assert_close(
            turned,
            cauchy(bent.as_ref(), f).congruence(rotation(2)),
            1e-9,
        );
    }
}
