//! Closed forms of elastic laws and of what wraps them.

use super::*;

#[test]
fn uniaxial_saint_venant_kirchhoff_has_its_nominal_stress() {
    // nu = 0: P = l S = ½ E l (l² − 1)
    let law = SaintVenantKirchhoff::new(500.0, 0.0);
    for l in [0.6, 0.8, 1.3] {
        let e = 0.5 * (l * l - 1.0);
        let out = fresh(&law, &finite(Sym3::diagonal(e, 0.0, 0.0)));
        assert!((l * out.stress.xx() - 0.5 * 500.0 * l * (l * l - 1.0)).abs() < 1e-11);
    }
}

#[test]
fn neo_hookean_dilation_has_its_closed_form_and_keeps_digits_at_small_strain() {
    let (lambda, mu) = (1000.0, 400.0);
    let nu = lambda / (2.0 * (lambda + mu));
    let law = NeoHookean::new(2.0 * mu * (1.0 + nu), nu);
    for l in [0.7f64, 1.2] {
        let e = 0.5 * (l * l - 1.0);
        let out = fresh(&law, &finite(Sym3::diagonal(e, e, e)));
        // S = (μ (l² − 1) + 3 λ ln l)/l²
        let expected = (mu * (l * l - 1.0) + 3.0 * lambda * l.ln()) / (l * l);
        assert!((out.stress.xx() - expected).abs() < 1e-10);
    }
    let tiny = 1e-9;
    let out = fresh(&law, &finite(Sym3::diagonal(tiny, 0.0, 0.0)));
    assert!((out.stress.yy() / (lambda * tiny) - 1.0).abs() < 1e-6);
}

#[test]
fn an_inverted_state_is_an_error() {
    let law = NeoHookean::new(1.0, 0.3);
    let strain = Strain::new(Kinematics::Finite, Sym3::diagonal(-0.6, 0.0, 0.0));
    let outcome = law.respond(
        &strain,
        &[],
        &mut [],
        Order::Stress,
        &mut Response::default(),
    );
    assert!(matches!(outcome, Err(MaterialError::Inverted { .. })));
}

#[test]
fn plane_and_uniaxial_stress_of_hooke_have_their_closed_forms() {
    let (e, nu) = (500.0, 0.3);
    let strain = Strain::new(
        Kinematics::Small,
        Sym3::new(1e-3, -2e-3, 7.0, 5e-4, 7.0, 7.0),
    );
    let plane = Reduced::plane_stress(Box::new(SaintVenantKirchhoff::new(e, nu)));
    let out = fresh(&plane, &strain);
    let c = e / (1.0 - nu * nu);
    assert!((out.stress.xx() - c * (1e-3 - nu * 2e-3)).abs() < 1e-13);
    assert!((out.stress.xy() - e / (1.0 + nu) * 5e-4).abs() < 1e-13);
    assert!((out.tangent[0][0] - c).abs() < 1e-10 && (out.tangent[0][1] - nu * c).abs() < 1e-10);
    assert!((out.across - nu / (1.0 - nu) * 1e-3).abs() < 1e-16);
    let bar = Reduced::uniaxial(Box::new(SaintVenantKirchhoff::new(e, nu)));
    let out = fresh(&bar, &strain);
    assert!((out.stress.xx() - e * 1e-3).abs() < 1e-13);
    assert!((out.tangent[0][0] - e).abs() < 1e-10);
    assert!((out.across + nu * 1e-3).abs() < 1e-16);
}

#[test]
fn a_stretch_of_rubber_to_any_length_finds_its_thickness_in_one_step() {
    for nu in [0.0, 0.3, 0.499, 0.49999] {
        for stretch in [0.02f64, 0.2, 0.7, 1.5, 4.0, 20.0] {
            let law = Reduced::uniaxial(Box::new(NeoHookean::new(3.0, nu)));
            let out = fresh(
                &law,
                &finite(Sym3::diagonal(0.5 * (stretch * stretch - 1.0), 0.0, 0.0)),
            );
            // μ (c − 1) + λ ln(stretch c) = 0 in c = C_zz
            let Lame { lambda, mu } = Lame::new(3.0, nu);
            let c = 1.0 + 2.0 * out.across;
            let size = mu * c.max(1.0) + lambda * (stretch * c).ln().abs();
            let left = mu * (c - 1.0) + lambda * (stretch * c).ln();
            // round-off of E, where c is small against 1
            let floor = 1e-14 * (mu + lambda) / c;
            assert!(left.abs() < 1e-10 * size + floor, "{nu} {stretch}: {left}");
        }
    }
}

#[test]
fn sheets_and_bars_of_every_rubber_and_of_metal_stretch_to_any_length_in_one_step() {
    for k in 0..7 {
        let make = || {
            let ogden = |bulk: f64| rubbers(bulk).into_iter().nth(1).map(|(law, _)| law);
            let mooney = |bulk: f64| rubbers(bulk).into_iter().next().map(|(law, _)| law);
            let law = match k {
                0 => ogden(5.0),
                1 => ogden(5e2),
                2 => ogden(5e4),
                3 => mooney(5.0),
                4 => mooney(5e2),
                5 => mooney(5e4),
                _ => Some(super::plastic(HardeningKind::Isotropic)),
            };
            law.unwrap()
        };
        for sheet in [false, true] {
            for stretch in [0.02f64, 0.1, 0.5, 0.9, 1.3, 3.0, 20.0] {
                let law = if sheet {
                    Reduced::plane_stress(make())
                } else {
                    Reduced::uniaxial(make())
                };
                let e = 0.5 * (stretch * stretch - 1.0);
                let given = Sym3::new(e, if sheet { 0.3 * e } else { 0.0 }, 0.0, 0.0, 0.0, 0.0);
                let mut history = vec![0.0; law.nhistory()];
                let out = advance(&law, &finite(given), &mut history);
                let free = history.split_off(make().nhistory());
                let (yy, zz) = if sheet {
                    (given.yy(), free[0])
                } else {
                    (free[0], free[1])
                };
                assert_eq!(zz, out.across);
                let inside = fresh(make().as_ref(), &finite(Sym3::diagonal(e, yy, zz)));
                let left = inside.stress.zz() * (1.0 + 2.0 * zz) / make().modulus();
                // what one unit in the last place of E is to the stretch
                let floor = 1e-15 / (1.0 + 2.0 * zz);
                assert!(
                    left.abs() < 1e-10 + floor,
                    "{k} {sheet} {stretch}: {left:.1e}"
                );
            }
        }
    }
}

#[test]
fn saint_venant_kirchhoff_without_thickness_left_is_an_error() {
    let law = Reduced::plane_stress(Box::new(SaintVenantKirchhoff::new(500.0, 0.45)));
    let strain = finite(Sym3::diagonal(1.0, 1.0, 0.0));
    let outcome = law.respond(
        &strain,
        &[0.0; 3],
        &mut [0.0; 3],
        Order::Stress,
        &mut Response::default(),
    );
    assert!(matches!(outcome, Err(MaterialError::NotConverged { .. })));
}

fn constants(values: &[(&str, &[f64])]) -> Constants {
    let mut constants = Constants::default();
    for (name, value) in values {
        constants.set(*name, value.to_vec());
    }
    constants
}

#[test]
fn mooney_rivlin_is_its_energy_by_invariants() {
    let law = of_table("mooney-rivlin");
    for k in 0..5 {
        let value = random(k, 0.3);
        let c = value * 2.0 + Sym3::IDENTITY;
        let (first, det) = (c.trace(), c.determinant());
        let second = 0.5 * (first * first - c.double_dot(c));
        let (i1, i2) = (first * det.cbrt().recip(), second * det.cbrt().powi(-2));
        let expected = 80.0 * (i1 - 3.0) + 30.0 * (i2 - 3.0) + 350.0 * (det.sqrt() - 1.0).powi(2);
        let energy = fresh(law.as_ref(), &finite(value)).energy;
        assert!(
            (energy / expected - 1.0).abs() < 1e-12,
            "{energy} {expected}"
        );
    }
}

/// The law with (ln J)² has the shear of the other one, and K (ln J)²/2 besides.
#[test]
fn mooney_rivlin_logarithmic_differs_in_its_volume_alone() {
    let [quadratic, logarithmic] = ["mooney-rivlin", "mooney-rivlin-logarithmic"].map(of_table);
    for k in 0..5 {
        let value = random(k, 0.3);
        let ratio = (Sym3::IDENTITY + value * 2.0)
            .to_mat3()
            .determinant()
            .sqrt();
        let energies =
            [&quadratic, &logarithmic].map(|law| fresh(law.as_ref(), &finite(value)).energy);
        let expected = 350.0 * (ratio.ln().powi(2) - (ratio - 1.0).powi(2));
        let found = energies[1] - energies[0];
        assert!(
            (found - expected).abs() < 1e-11 * energies[0],
            "{found} {expected}"
        );
    }
}

type Rubber = (Box<dyn Material>, Vec<(f64, f64)>);

/// The laws of Mooney and Rivlin and of Ogden, and their terms `(μ, α)`.
fn rubbers(bulk: f64) -> [Rubber; 2] {
    let mooney = constants(&[("c10", &[0.4]), ("c01", &[0.1]), ("bulk", &[bulk])]);
    // Treloar's rubber, Ogden 1972, in the form with 2μ/α²: μ_p α_p/2
    let (alpha, mu) = ([1.3, 5.0, -2.0], [0.4095, 0.003, 0.01]);
    let ogden = constants(&[("mu", &mu), ("alpha", &alpha), ("bulk", &[bulk])]);
    [
        (
            Box::new(Ogden::mooney_rivlin(&mooney).unwrap()),
            vec![(0.8, 2.0), (0.2, -2.0)],
        ),
        (
            Box::new(Ogden::new(&ogden).unwrap()),
            mu.into_iter().zip(alpha).collect(),
        ),
    ]
}

#[test]
fn incompressible_rubber_has_its_uniaxial_and_equibiaxial_stress() {
    for stretch in [0.3f64, 0.7, 1.2, 2.0, 5.0] {
        let e = 0.5 * (stretch * stretch - 1.0);
        for (law, terms) in rubbers(1e7) {
            let bar = Reduced::uniaxial(law);
            let sum = |f: &dyn Fn(f64) -> f64| -> f64 {
                terms
                    .iter()
                    .map(|(mu, alpha)| 2.0 * mu / alpha * f(*alpha))
                    .sum()
            };
            // true stress σ = l² S
            let stress = fresh(&bar, &finite(Sym3::diagonal(e, 0.0, 0.0)))
                .stress
                .xx();
            let expected = sum(&|a| stretch.powf(a) - stretch.powf(-0.5 * a));
            let error = (stretch * stretch * stress / expected - 1.0).abs();
            assert!(error < 2e-5 * (1.0 + expected.abs()), "{stretch} {error}");
        }
        for (law, terms) in rubbers(1e7) {
            let sheet = Reduced::plane_stress(law);
            let out = fresh(&sheet, &finite(Sym3::diagonal(e, e, 0.0)));
            let expected: f64 = terms
                .iter()
                .map(|(mu, a)| 2.0 * mu / a * (stretch.powf(*a) - stretch.powf(-2.0 * a)))
                .sum();
            let error = (stretch * stretch * out.stress.xx() / expected - 1.0).abs();
            assert!(error < 2e-5 * (1.0 + expected.abs()), "{stretch} {error}");
            assert!((out.stress.xx() - out.stress.yy()).abs() < 1e-9 * expected.abs());
        }
    }
}

#[test]
fn rubber_in_simple_shear_has_its_shear_stress_whatever_its_bulk_modulus() {
    for gamma in [0.01f64, 0.5, 2.0] {
        let mut f = Mat3::IDENTITY;
        f.rows[0].y = gamma;
        let e = (Sym3::gram(f) - Sym3::IDENTITY) * 0.5;
        for (law, terms) in rubbers(3.0) {
            let cauchy = fresh(law.as_ref(), &finite(e)).stress.congruence(f);
            let l = 0.5 * (gamma + gamma.hypot(2.0));
            let expected: f64 = terms
                .iter()
                .map(|(mu, a)| 2.0 * mu / a * (l.powf(*a) - l.powf(-a)) / (l + l.recip()))
                .sum();
            assert!((cauchy.xy() / expected - 1.0).abs() < 1e-12, "{gamma}");
        }
    }
}

#[test]
fn constants_that_make_no_rubber_are_refused() {
    let bulk: (&str, &[f64]) = ("bulk", &[1.0]);
    let ogden = |mu: &[f64], alpha: &[f64]| {
        Ogden::new(&constants(&[("mu", mu), ("alpha", alpha), bulk])).is_ok()
    };
    assert!(ogden(&[1.0], &[2.0]));
    assert!(!ogden(&[1.0], &[2.0, 3.0]));
    assert!(!ogden(&[1.0], &[0.0]));
    assert!(!ogden(&[-1.0], &[2.0]));
    assert!(!ogden(&[f64::NAN], &[2.0]));
    let mooney = |c10: f64, c01: f64| {
        Ogden::mooney_rivlin(&constants(&[("c10", &[c10]), ("c01", &[c01]), bulk])).is_ok()
    };
    assert!(mooney(1.0, -0.5) && !mooney(1.0, -1.0) && !mooney(f64::NAN, 0.0));
}

#[test]
fn orthotropic_contraction_and_stiffness_are_those_of_the_constants() {
    let bar = Reduced::uniaxial(of_table("orthotropic"));
    let strain = Strain::new(Kinematics::Small, Sym3::diagonal(1e-3, 0.0, 0.0));
    let out = fresh(&bar, &strain);
    assert!((out.stress.xx() - 0.9).abs() < 1e-13);
    assert!((out.across + 0.25e-3).abs() < 1e-16);
    let full = fresh(of_table("orthotropic").as_ref(), &strain).tangent;
    assert_eq!([full[3][3], full[4][4], full[5][5]], [170.0, 90.0, 140.0]);
}

#[test]
fn an_orthotropic_bar_off_its_axes_has_the_modulus_of_the_angle() {
    for degrees in [0.0f64, 20.0, 45.0, 90.0, 130.0] {
        let (s, c) = degrees.to_radians().sin_cos();
        // the first axis of the material is at this angle from the bar, x
        let (x, y) = (
            Vec3::new(c, s, 0.0),
            Vec3::new(-s, c, 0.0) + Vec3::new(c, s, 0.0) * 0.3,
        );
        let law = Oriented::new(of_table("orthotropic"), x * 7.0, y).unwrap();
        let bar = Reduced::uniaxial(Box::new(law));
        let out = fresh(
            &bar,
            &Strain::new(Kinematics::Small, Sym3::diagonal(1e-3, 0.0, 0.0)),
        );
        let compliance = c.powi(4) / 900.0
            + s.powi(4) / 400.0
            + (1.0 / 170.0 - 2.0 * 0.3 / 900.0) * (s * c).powi(2);
        assert!(
            (out.stress.xx() * compliance / 1e-3 - 1.0).abs() < 1e-12,
            "{degrees}"
        );
    }
}

#[test]
fn an_orthotropic_stiffness_that_is_not_positive_definite_is_refused() {
    let with = |name: &'static str, value: f64| {
        let mut constants = Constants::sample();
        constants.set(name, vec![value]);
        Orthotropic::new(&constants)
    };
    assert!(with("E1", 900.0).is_ok());
    let outcome = with("nu12", 1.5); // sqrt(900/400)
    assert!(matches!(
        outcome,
        Err(ConstantsError::Range { name: "nu12", .. })
    ));
    assert!(matches!(
        with("G23", 0.0),
        Err(ConstantsError::Range { name: "G23", .. })
    ));
    assert!(matches!(
        with("nu13", f64::NAN),
        Err(ConstantsError::Range { name: "nu13", .. })
    ));
    // each is in its range, together they are not
    let mut constants = Constants::sample();
    for name in ["nu12", "nu13", "nu23"] {
        constants.set(name, vec![0.9]);
    }
    let outcome = Orthotropic::new(&constants);
    assert!(
        matches!(outcome, Err(ConstantsError::Unfit { .. })),
        "{outcome:?}"
    );
}

#[test]
fn vectors_that_span_no_plane_are_refused() {
    let x = Vec3::new(1.0, 2.0, 3.0);
    for y in [
        x * -2.0,
        Vec3::ZERO,
        Vec3::new(f64::NAN, 0.0, 0.0),
        x + Vec3::unit(0) * 1e-9,
    ] {
        assert!(Oriented::new(of_table("orthotropic"), x, y).is_err());
        assert!(Oriented::new(of_table("orthotropic"), y, x).is_err());
    }
}

#[test]
fn what_expands_freely_has_no_stress() {
    for (name, law) in laws() {
        let law = Expanding::new(law, 1.2e-5, 20.0);
        for temperature in [-200.0, 20.0, 900.0] {
            let x = 1.2e-5 * (temperature - 20.0);
            for (kinematics, e) in [
                (Kinematics::Small, x),
                (Kinematics::Finite, x + 0.5 * x * x),
            ] {
                let strain = Strain {
                    temperature,
                    ..Strain::new(kinematics, Sym3::IDENTITY * e)
                };
                let out = fresh(&law, &strain);
                let largest = out
                    .stress
                    .to_pairs()
                    .iter()
                    .fold(0.0, |m: f64, s| m.max(s.abs()));
                assert!(largest < 1e-14, "{name} {largest:.1e}");
                assert!(out.energy.abs() < 1e-24, "{name}");
            }
        }
    }
}

#[test]
fn what_is_held_while_it_warms_has_its_thermal_stress() {
    let (e, nu, x) = (500.0, 0.3, 1e-3);
    let law = || Box::new(Expanding::new(of_table("linear-elastic"), 1e-5, 20.0));
    let strain = Strain {
        temperature: 120.0,
        ..Strain::new(Kinematics::Small, Sym3::ZERO)
    };
    let space = fresh(law().as_ref(), &strain).stress;
    assert!((space.xx() + e / (1.0 - 2.0 * nu) * x).abs() < 1e-13);
    let plane = fresh(&Reduced::plane_stress(law()), &strain);
    assert!((plane.stress.xx() + e / (1.0 - nu) * x).abs() < 1e-13);
    assert!((plane.across - (1.0 + nu) / (1.0 - nu) * x).abs() < 1e-16);
    let bar = fresh(&Reduced::uniaxial(law()), &strain);
    assert!((bar.stress.xx() + e * x).abs() < 1e-13);
    // frozen below the absolute: no length is left
    let law = Expanding::new(of_table("neo-hookean"), 1e-2, 0.0);
    let cold = Strain {
        temperature: -101.0,
        ..finite(Sym3::ZERO)
    };
    let outcome = law.respond(&cold, &[], &mut [], Order::Stress, &mut Response::default());
    assert!(
        matches!(outcome, Err(MaterialError::Shrunk { stretch }) if (stretch + 0.01).abs() < 1e-12)
    );
}

fn size(tensor: Sym3) -> f64 {
    tensor.double_dot(tensor).sqrt()
}

/// Constants of this name, alone.
fn only(name: &str, values: &[f64]) -> Constants {
    let mut constants = Constants::default();
    constants.set(name, values.to_vec());
    constants
}

#[test]
fn an_anisotropic_law_takes_its_columns_in_their_order() {
    // every column alone: D of the pair (row, column) is ten times the row plus the column, on a large diagonal
    let mut values = Vec::new();
    for column in 0..6u32 {
        for row in 0..=column {
            let large = if row == column { 1000.0 } else { 0.0 };
            values.push(large + f64::from(10 * row + column));
        }
    }
    let law = Anisotropic::new(&only("D", &values)).unwrap();
    let axes = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    for (column, &(i, j)) in axes.iter().enumerate() {
        let mut pairs = [0.0; 6];
        let place = Sym3::PAIRS.iter().position(|p| *p == (i, j)).unwrap();
        // a doubled shear of 1e-3
        pairs[place] = if i == j { 1e-3 } else { 0.5e-3 };
        let strain = Strain::new(Kinematics::Small, Sym3::from_pairs(pairs));
        let stress = fresh(&law, &strain).stress.to_pairs();
        for (row, &(k, l)) in axes.iter().enumerate() {
            let (low, high) = (row.min(column), row.max(column));
            let large = if row == column { 1000.0 } else { 0.0 };
            let expected = 1e-3 * (large + (10 * low + high) as f64);
            let place = Sym3::PAIRS.iter().position(|p| *p == (k, l)).unwrap();
            assert!((stress[place] - expected).abs() < 1e-12, "{row} {column}");
        }
    }
}

#[test]
fn an_anisotropic_law_that_is_not_positive_is_an_error() {
    let mut values = vec![0.0; 21];
    assert!(Anisotropic::new(&only("D", &values)).is_err());
    for at in [0, 2, 5, 9, 14, 20] {
        values[at] = 1.0;
    }
    assert!(Anisotropic::new(&only("D", &values)).is_ok());
    values[1] = 1.0;
    assert!(Anisotropic::new(&only("D", &values)).is_err());
    assert!(Anisotropic::new(&only("D", &values[..20])).is_err());
}

fn by_temperature(t: &[f64], e: &[f64], nu: &[f64]) -> Result<ByTemperature, ConstantsError> {
    let mut constants = Constants::default();
    for (name, values) in [("T", t), ("E", e), ("nu", nu)] {
        constants.set(name, values.to_vec());
    }
    ByTemperature::new(&constants)
}

#[test]
fn constants_by_temperature_are_linear_between_and_constant_outside() {
    let (t, e, nu) = (
        [-100.0, 100.0, 500.0],
        [200.0, 180.0, 90.0],
        [0.3, 0.3, 0.4],
    );
    let law = by_temperature(&t, &e, &nu).unwrap();
    let value = random(3, 1e-2);
    for (temperature, e, nu) in [
        (-300.0, 200.0, 0.3),
        (-100.0, 200.0, 0.3),
        (0.0, 190.0, 0.3),
        (200.0, 157.5, 0.325),
        (500.0, 90.0, 0.4),
        (900.0, 90.0, 0.4),
    ] {
        for kinematics in KINEMATICS {
            let strain = Strain {
                temperature,
                ..Strain::new(kinematics, value)
            };
            let [a, b] = [
                fresh(&law, &strain),
                fresh(&SaintVenantKirchhoff::new(e, nu), &strain),
            ];
            assert!(size(a.stress - b.stress) < 1e-12 * size(b.stress));
            assert!((a.energy - b.energy).abs() < 1e-12 * b.energy);
        }
    }
    assert!(by_temperature(&[0.0, 0.0], &[1.0, 1.0], &[0.3, 0.3]).is_err());
    assert!(by_temperature(&[0.0, 1.0], &[1.0], &[0.3, 0.3]).is_err());
    assert!(by_temperature(&[0.0, 1.0], &[1.0, -1.0], &[0.3, 0.3]).is_err());
}

#[test]
fn a_list_is_no_number() {
    let mut constants = Constants::elastic(1.0, 0.3);
    constants.set("E", vec![1.0, 2.0]);
    let error = ConstantsError::Several { name: "E" };
    assert_eq!(constants.isotropic(), Err(error));
}

#[test]
fn secant_expansion_by_temperature_is_counted_from_its_start() {
    let make = || Box::new(SaintVenantKirchhoff::new(500.0, 0.3));
    let table = vec![[0.0, 1e-5], [1000.0, 3e-5]];
    let given = Expanding::by_temperature(make(), table.clone(), 20.0, Some(100.0));
    let by_place = Expanding::by_temperature(make(), table, 20.0, None);
    let x = |t: f64| (1e-5 + 2e-8 * t) * (t - 20.0);
    for temperature in [100.0, 400.0, 900.0] {
        let grown = x(temperature) - x(100.0);
        for (kinematics, free) in [
            (Kinematics::Small, grown),
            (Kinematics::Finite, grown + 0.5 * grown * grown),
        ] {
            let strain = Strain {
                temperature,
                ..Strain::new(kinematics, Sym3::IDENTITY * free)
            };
            assert!(size(fresh(&given, &strain).stress) < 1e-12);
            let started = Strain {
                temperature_at_start: 100.0,
                ..strain
            };
            assert!(size(fresh(&by_place, &started).stress) < 1e-12);
            assert!(size(fresh(&by_place, &strain).stress) > 1e-3);
        }
    }
}

#[test]
fn foam_without_lateral_contraction_is_a_sum_of_springs() {
    // nu = 0: the principal directions do not see each other, τ_i = Σ 2μ/α (l_i^α − 1)
    let mut constants = Constants::default();
    for (name, values) in [
        ("mu", [3.0, -0.2]),
        ("alpha", [4.0, -2.0]),
        ("nu", [0.0, 0.0]),
    ] {
        constants.set(name, values.to_vec());
    }
    let law = Hyperfoam::new(&constants).unwrap();
    for l in [0.4f64, 0.9, 1.7] {
        let out = fresh(&law, &finite(Sym3::diagonal(0.5 * (l * l - 1.0), 0.0, 0.0)));
        let tau = 1.5 * (l.powi(4) - 1.0) + 0.2 * (l.powi(-2) - 1.0);
        assert!((out.stress.xx() * l * l - tau).abs() < 1e-12);
        assert!(out.stress.yy().abs() < 1e-12);
        let energy =
            6.0 / 16.0 * (l.powi(4) - 1.0 - 4.0 * l.ln()) - 0.1 * (l.powi(-2) - 1.0 + 2.0 * l.ln());
        assert!((out.energy - energy).abs() < 1e-12);
    }
}

#[test]
fn foam_under_pressure_has_its_closed_form() {
    let mut constants = Constants::default();
    for (name, value) in [("mu", 3.0), ("alpha", 4.0), ("nu", 0.3)] {
        constants.set(name, vec![value]);
    }
    let law = Hyperfoam::new(&constants).unwrap();
    let beta = 0.3 / 0.4;
    for l in [0.5f64, 1.4] {
        let e = 0.5 * (l * l - 1.0);
        let out = fresh(&law, &finite(Sym3::diagonal(e, e, e)));
        let tau = 1.5 * (l.powi(4) - l.powf(-12.0 * beta));
        assert!((out.stress.xx() * l * l - tau).abs() < 1e-11);
    }
    constants.set("nu", vec![0.5]);
    assert!(Hyperfoam::new(&constants).is_err());
}
