use super::*;

const SCALE: Scale = Scale {
    penalty: 7.0,
    shear: 2.0,
    length: 1.0,
};

fn endless() -> Exponential {
    Exponential {
        p0: 2.0,
        c0: 0.1,
        within: f64::INFINITY,
    }
}

fn all() -> Vec<Box<dyn ContactLaw>> {
    let rows = vec![[-0.2, 5.0], [-0.05, 2.0], [0.1, 0.5], [0.3, 0.0]];
    vec![
        Box::new(Penalty),
        Box::new(Lagrange),
        Box::new(Uzawa),
        Box::new(AugmentedNewton),
        Box::new(endless()),
        Box::new(Exponential {
            within: 0.15,
            ..endless()
        }),
        Box::new(Arctangent {
            stiffness: 4.0,
            tension: 0.05,
            within: 0.5,
        }),
        Box::new(Table::new(rows).unwrap()),
        Box::new(gasket()),
        Box::new(Dugdale {
            work: 0.02,
            range: 0.2,
        }),
        Box::new(LennardJones {
            work: 0.02,
            range: 0.2,
        }),
    ]
}

fn gasket() -> Gasket {
    let loading = vec![[0.0, 0.0], [0.1, 4.0], [0.5, 8.0]];
    let opening = vec![[0.2, 0.0], [0.3, 1.0], [0.5, 8.0]];
    Gasket::new(loading, vec![(0.5, opening)], None, 0.01).unwrap()
}

const GAPS: [f64; 6] = [-0.5, -0.1501, -0.01, 0.02, 0.25, 1.0];
const LAMBDAS: [f64; 3] = [0.0, 0.6, 3.0];

#[test]
fn pressure_is_minus_the_slope_of_energy() {
    for law in all() {
        for gap in GAPS {
            for lambda in LAMBDAS {
                let h = 1e-6;
                let energy = |g| law.energy(g, lambda, &SCALE);
                let Some((plus, minus)) = energy(gap + h).zip(energy(gap - h)) else {
                    continue;
                };
                let slope = (plus - minus) / (2.0 * h);
                let at = law.pressure(gap, lambda, &SCALE);
                assert!((at.value + slope).abs() < 1e-7 * (1.0 + at.value), "{gap}");
            }
        }
    }
}

#[test]
fn what_pulls_takes_its_work_of_adhesion() {
    let (work, range) = (0.05, 0.3);
    let dugdale = Dugdale { work, range };
    let atoms = LennardJones { work, range };
    let laws: [(&dyn ContactLaw, f64); 2] = [(&dugdale, 1.2), (&atoms, 3000.0)];
    for (law, end) in laws {
        // with steps that grow as the gap does
        let (mut sum, steps) = (0.0, 400_000);
        let gap = |k: i32| range * ((1.0 + end).powf(f64::from(k) / f64::from(steps)) - 1.0);
        let p = |g: f64| law.pressure(g.max(1e-300), 0.0, &SCALE).value;
        for k in 0..steps {
            let (a, b) = (gap(k), gap(k + 1));
            sum -= (b - a) * (p(a) + 4.0 * p(0.5 * (a + b)) + p(b)) / 6.0;
        }
        assert!((sum - work).abs() < 1e-6 * work, "{law:?}: {sum}");
        assert!(law.softens());
    }
    // INTERFACES: the largest pull 1.0264 w/z0 at 0.2009 z0, and the slope at contact 16 w/z0²
    let at = atoms.pressure(0.200_937 * range, 0.0, &SCALE);
    assert!((at.value + 1.026_400 * work / range).abs() < 1e-6 * work / range);
    let touch = atoms.pressure(0.0, 0.0, &SCALE);
    assert!((touch.dgap + 16.0 * work / (range * range)).abs() < 1e-12);
    assert!(touch.value.abs() < 1e-15);
    let tension = dugdale.pressure(0.5 * range, 0.0, &SCALE).value;
    assert!((tension + work / range).abs() < 1e-15);
}

#[test]
fn derivatives_match_differences() {
    for law in all() {
        for gap in GAPS {
            for lambda in LAMBDAS {
                let h = 1e-6;
                type Function<'a> = &'a dyn Fn(f64, f64) -> Eval;
                let pressure: Function<'_> = &|g, l| law.pressure(g, l, &SCALE);
                let complementarity: Function<'_> = &|g, l| law.complementarity(g, l, &SCALE);
                for f in [pressure, complementarity] {
                    let at = f(gap, lambda);
                    let dgap = (f(gap + h, lambda).value - f(gap - h, lambda).value) / (2.0 * h);
                    let dlambda = (f(gap, lambda + h).value - f(gap, lambda).value) / h;
                    assert!(
                        (at.dgap - dgap).abs() < 1e-6 * (1.0 + at.dgap.abs()),
                        "{gap}"
                    );
                    if law.multiplier() != Multiplier::None {
                        assert!((at.dlambda - dlambda).abs() < 1e-6, "{gap} {lambda}");
                    }
                }
            }
        }
    }
}

#[test]
fn multipliers_solve_contact_where_complementarity_vanishes() {
    for law in all().into_iter().filter(|l| l.multiplier().is_unknown()) {
        let c = |gap, lambda| law.complementarity(gap, lambda, &SCALE).value;
        assert_eq!(c(0.0, 2.0), 0.0, "closed with pressure");
        assert_eq!(c(0.3, 0.0), 0.0, "open without");
        assert!(c(-0.1, 0.0) != 0.0 && c(0.1, 2.0) != 0.0 && c(0.0, -1.0) != 0.0);
        for (gap, lambda) in [(-0.1, 1.0), (0.05, 2.0), (0.4, 1.0)] {
            let at = law.complementarity(gap, lambda, &SCALE);
            let force = law.pressure(gap, lambda, &SCALE);
            assert_eq!(at.dgap, -force.dlambda, "symmetric");
        }
    }
}

#[test]
fn augmentation_ends_where_the_gap_closes() {
    // a spring of stiffness 3 pressed by 0.5 beyond a wall: λ = 1.5
    let mut lambda = 0.0;
    for _ in 0..60 {
        // 3 (0.5 + g) = p
        let gap = (lambda - 1.5) / (3.0 + SCALE.penalty);
        lambda = Uzawa.pressure(gap, lambda, &SCALE).value;
    }
    assert!((lambda - 1.5).abs() < 1e-9, "{lambda}");
}

#[test]
fn tables_that_are_no_laws_are_refused() {
    let refused = |rows: &[[f64; 2]]| Table::new(rows.to_vec()).unwrap_err();
    assert_eq!(refused(&[[0.0, 1.0]]), TableError::TooShort);
    assert_eq!(
        refused(&[[0.0, 1.0], [0.0, 0.0]]),
        TableError::Gap { row: 2 }
    );
    assert_eq!(
        refused(&[[0.0, 1.0], [0.5, 2.0]]),
        TableError::Pressure { row: 2 }
    );
    assert_eq!(
        refused(&[[0.0, 1.0], [0.5, -1.0]]),
        TableError::Pressure { row: 2 }
    );
}

#[test]
fn curves_pass_through_what_they_are_given() {
    let p = |law: &dyn ContactLaw, gap| law.pressure(gap, 0.0, &SCALE).value;
    let exponential = endless();
    assert_eq!(p(&exponential, 0.0), 2.0);
    assert!((p(&exponential, 0.1) - 0.02).abs() < 1e-15);
    // a tangent below −2 c0
    let (a, b) = (p(&exponential, -0.3), p(&exponential, -0.4));
    assert!((b - a - (a - p(&exponential, -0.2))).abs() < 1e-9 * b);

    let rows = [[-0.2, 5.0], [-0.05, 2.0], [0.1, 0.5], [0.3, 0.25]];
    let table = Table::new(rows.to_vec()).unwrap();
    for [gap, pressure] in rows {
        assert!((p(&table, gap) - pressure).abs() < 1e-14, "{gap}");
    }
    assert!(
        (p(&table, -0.35) - 8.0).abs() < 1e-13,
        "with the first slope"
    );
    assert_eq!(p(&table, 7.0), 0.25, "the last pressure");
}
