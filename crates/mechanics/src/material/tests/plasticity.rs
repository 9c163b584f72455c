//! Plasticity against curves, loops and rate equations.

use super::*;

const E: f64 = 500.0;
const NU: f64 = 0.3;
const MU: f64 = E / (2.0 * (1.0 + NU));
const BULK: f64 = E / (3.0 * (1.0 - 2.0 * NU));

/// The yield stress by [`TABLE_OF_YIELD`].
fn table(plastic: f64) -> f64 {
    if plastic < 0.1 {
        8.0 + 60.0 * plastic
    } else {
        14.0 + (plastic.min(2.0) - 0.1) * 3.0 / 1.9
    }
}

fn linear(kind: HardeningKind, slope: f64) -> Box<dyn Material> {
    let rows = vec![[8.0, 0.0], [8.0 + slope * 100.0, 100.0]];
    Box::new(Plasticity::new(E, NU, Hardening::new(kind, rows).unwrap()).unwrap())
}

fn largest(tensor: Sym3) -> f64 {
    tensor
        .to_pairs()
        .iter()
        .fold(0.0, |m: f64, v| m.max(v.abs()))
}

#[test]
fn uniaxial_stress_follows_the_table_at_small_and_at_large_strain() {
    for kind in kinds() {
        let modulus = match kind {
            HardeningKind::Combined { modulus } => modulus,
            _ => 0.0,
        };
        for kinematics in KINEMATICS {
            for sign in [1.0, -1.0] {
                let bar = Reduced::uniaxial(plastic(kind));
                let mut history = vec![0.0; bar.nhistory()];
                // kinks lie inside of increments; constant from 2 on; a centre that moves bounds the increment
                let curve = match (kind, kinematics) {
                    (HardeningKind::Isotropic, _) | (_, Kinematics::Small) => {
                        vec![1e-6, 0.02, 0.07, 0.1, 0.3, 1.2, 2.5]
                    }
                    _ => (0..=50).map(|i| 0.007 + 0.05 * f64::from(i)).collect(),
                };
                for plastic in curve {
                    let stress = sign * (table(plastic) + modulus * plastic);
                    let log = stress / E + sign * plastic;
                    let (strain, expected) = match kinematics {
                        Kinematics::Small => (log, stress),
                        // Kirchhoff stress τ over logarithmic strain: S = τ/C
                        Kinematics::Finite => {
                            (0.5 * (2.0 * log).exp_m1(), stress * (-2.0 * log).exp())
                        }
                    };
                    let strain = Strain::new(kinematics, Sym3::diagonal(strain, 0.0, 0.0));
                    let out = advance(&bar, &strain, &mut history);
                    let error = (out.stress.xx() / expected - 1.0).abs();
                    assert!(
                        error < 1e-9,
                        "{kind:?} {kinematics:?} {sign} {plastic} {error}"
                    );
                    let found = bar.plastic_strain(&history).unwrap();
                    assert!(
                        (found - plastic).abs() < 1e-9 * plastic.max(1e-2),
                        "{found}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_cycle_shows_what_kind_of_hardening_it_is() {
    // elastic range at the reversal: twice the first yield stress if the centre moves, twice the last if the radius grows
    let (slope, plastic) = (60.0, 0.05);
    let top = 8.0 + slope * plastic;
    for (kind, range) in [
        (HardeningKind::Kinematic, 16.0),
        (HardeningKind::Isotropic, 2.0 * top),
    ] {
        let bar = Reduced::uniaxial(linear(kind, slope));
        let mut history = vec![0.0; bar.nhistory()];
        let mut at = |strain: f64| {
            let strain = Strain::new(Kinematics::Small, Sym3::diagonal(strain, 0.0, 0.0));
            advance(&bar, &strain, &mut history).stress.xx()
        };
        let turn = top / E + plastic;
        assert!((at(turn) - top).abs() < 1e-11);
        // the reversal goes elastically by `range`, then flows with E h/(E + h)
        let flowing = E * slope / (E + slope);
        for beyond in [-0.001, 0.0, 0.002, 0.01] {
            let strain = turn - range / E - beyond;
            let expected = top
                - range
                - if beyond > 0.0 {
                    flowing * beyond
                } else {
                    E * beyond
                };
            let stress = at(strain);
            assert!(
                (stress - expected).abs() < 1e-10,
                "{kind:?} {beyond}: {stress} {expected}"
            );
        }
    }
    // with a moving centre the loop closes
    let bar = Reduced::uniaxial(linear(HardeningKind::Kinematic, slope));
    let mut history = vec![0.0; bar.nhistory()];
    let mut seen = Vec::new();
    for strain in [0.06, -0.06, 0.06, -0.06, 0.06] {
        let strain = Strain::new(Kinematics::Small, Sym3::diagonal(strain, 0.0, 0.0));
        seen.push(advance(&bar, &strain, &mut history).stress.xx());
    }
    assert!((seen[0] - seen[2]).abs() < 1e-11 && (seen[2] - seen[4]).abs() < 1e-11);
    assert!((seen[1] + seen[0]).abs() < 1e-11 && (seen[1] - seen[3]).abs() < 1e-11);
}

#[test]
fn the_energy_is_the_work_of_the_stress() {
    // a path there, aside and back, small enough steps that the trapezoidal rule resolves it
    for kind in kinds() {
        let law = plastic(kind);
        let work = |n: usize| {
            let mut history = vec![0.0; law.nhistory()];
            let mut last = Response::default();
            let mut value = Sym3::ZERO;
            let mut work = 0.0;
            for target in [random(1, 0.05), random(2, 0.05), Sym3::ZERO] {
                let step = (target - value) * (n as f64).recip();
                for _ in 0..n {
                    value = value + step;
                    let out = advance(
                        law.as_ref(),
                        &Strain::new(Kinematics::Small, value),
                        &mut history,
                    );
                    work += 0.5 * (out.stress + last.stress).double_dot(step);
                    last = out;
                }
            }
            (work, last.energy)
        };
        let (coarse, fine) = (work(400), work(800));
        let errors = [coarse, fine].map(|(work, energy)| (energy / work - 1.0).abs());
        assert!(
            errors[1] < 1e-3 && errors[1] < 0.7 * errors[0],
            "{kind:?} {errors:?}"
        );
    }
}

#[test]
fn elastic_steps_leave_the_history_bit_by_bit() {
    for kind in kinds() {
        for kinematics in KINEMATICS {
            let law = plastic(kind);
            let mut history = vec![0.0; law.nhistory()];
            let there = random(3, 0.1);
            let top = advance(law.as_ref(), &Strain::new(kinematics, there), &mut history);
            assert!(law.plastic_strain(&history).unwrap() > 0.01);
            // back by less than the elastic range
            let direction = deviator(top.stress);
            let back = direction * (-6.0 / (2.0 * MU * direction.von_mises()));
            let before = history.clone();
            let strain = Strain::new(kinematics, there + back);
            advance(law.as_ref(), &strain, &mut history);
            assert_eq!(before, history);
        }
    }
}

#[test]
fn large_strain_with_turning_axes_is_small_strain_in_logarithms() {
    // S : dE = T : dH along any path; here by the stretches of a coaxial one, in turned axes
    for kind in kinds() {
        let law = plastic(kind);
        let mut finite_history = vec![0.0; law.nhistory()];
        let mut small_history = finite_history.clone();
        let r = rotation(5);
        for log in [[0.1, -0.02, 0.03], [0.4, -0.3, 0.03], [-0.2, 0.3, 0.3]] {
            let [a, b, c] = log.map(|h: f64| 0.5 * (2.0 * h).exp_m1());
            let e = Sym3::diagonal(a, b, c).congruence(r);
            let h = Sym3::diagonal(log[0], log[1], log[2]).congruence(r);
            let s = advance(law.as_ref(), &finite(e), &mut finite_history);
            let t = advance(
                law.as_ref(),
                &Strain::new(Kinematics::Small, h),
                &mut small_history,
            );
            let back =
                Sym3::diagonal((-log[0]).exp(), (-log[1]).exp(), (-log[2]).exp()).congruence(r);
            // coaxial: S = U⁻¹ T U⁻¹
            assert!(largest(s.stress - t.stress.congruence(back.to_mat3())) < 1e-12 * BULK);
            assert!((s.energy - t.energy).abs() < 1e-13 * BULK);
        }
        for (a, b) in finite_history.iter().zip(&small_history) {
            assert!((a - b).abs() < 1e-13 * a.abs().max(1.0));
        }
    }
}

fn deviator(stress: Sym3) -> Sym3 {
    stress - Sym3::IDENTITY * (stress.trace() / 3.0)
}

/// The rate equations of flow under a strain rate, for a radius and a centre with these slopes: no law of ours.
///
/// State: deviator of stress, centre, equivalent plastic strain.
#[derive(Clone, Copy)]
struct Rates {
    radius: f64,
    centre: f64,
}

type Yielding = (Sym3, Sym3, f64);

impl Rates {
    fn at(&self, (stress, centre, _): Yielding, rate: Sym3) -> Yielding {
        let relative = stress - centre;
        let direction = relative * (1.5 / relative.von_mises());
        let rate = deviator(rate);
        let flow = (2.0 * MU * direction.double_dot(rate) / (3.0 * MU + self.radius + self.centre))
            .max(0.0);
        (
            (rate - direction * flow) * (2.0 * MU),
            direction * (2.0 / 3.0 * self.centre * flow),
            flow,
        )
    }

    /// The classical method of Runge and Kutta, of fourth order, from `t = 0` to 1 in `n` steps.
    fn integrate(&self, start: Yielding, rate: impl Fn(f64) -> Sym3, n: usize) -> Yielding {
        let along =
            |y: Yielding, k: Yielding, h: f64| (y.0 + k.0 * h, y.1 + k.1 * h, y.2 + k.2 * h);
        let h = (n as f64).recip();
        let mut y = start;
        for i in 0..n {
            let t = i as f64 * h;
            let a = self.at(y, rate(t));
            let b = self.at(along(y, a, 0.5 * h), rate(t + 0.5 * h));
            let c = self.at(along(y, b, 0.5 * h), rate(t + 0.5 * h));
            let d = self.at(along(y, c, h), rate(t + h));
            for (k, weight) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
                y = along(y, k, weight * h / 6.0);
            }
        }
        y
    }
}

/// Kinds of hardening with constant slopes, and their rate equations.
fn reference() -> Vec<(Box<dyn Material>, Rates)> {
    let combined = HardeningKind::Combined { modulus: 40.0 };
    [
        (HardeningKind::Isotropic, 0.0, (0.0, 0.0)),
        (HardeningKind::Isotropic, 60.0, (60.0, 0.0)),
        (HardeningKind::Kinematic, 60.0, (0.0, 60.0)),
        (combined, 25.0, (25.0, 40.0)),
    ]
    .into_iter()
    .map(|(kind, slope, (radius, centre))| (linear(kind, slope), Rates { radius, centre }))
    .collect()
}

/// First yield in shear: the strain, and the deviator of stress there.
fn first_yield() -> (Sym3, Sym3) {
    let stress = Sym3::new(0.0, 0.0, 0.0, 8.0 / 3f64.sqrt(), 0.0, 0.0);
    (stress * (2.0 * MU).recip(), stress)
}

/// The deviator of stress after `n` equal parts of a path from first yield.
fn returned(law: &dyn Material, path: &impl Fn(f64) -> Sym3, n: usize) -> (Sym3, f64) {
    let (start, _) = first_yield();
    let mut history = vec![0.0; law.nhistory()];
    advance(law, &Strain::new(Kinematics::Small, start), &mut history);
    let mut stress = Sym3::ZERO;
    for i in 1..=n {
        let value = start + path(i as f64 / n as f64);
        stress = advance(law, &Strain::new(Kinematics::Small, value), &mut history).stress;
    }
    (deviator(stress), law.plastic_strain(&history).unwrap())
}

#[test]
fn proportional_loading_equals_the_rate_equations_in_one_step() {
    let (start, stress) = first_yield();
    for (law, rates) in reference() {
        let end = start * 9.0 + Sym3::IDENTITY * 0.01;
        let exact = rates.integrate((stress, Sym3::ZERO, 0.0), |_| end, 10);
        let (found, plastic) = returned(law.as_ref(), &|t| end * t, 1);
        assert!(
            largest(found - exact.0) < 1e-12,
            "{}",
            largest(found - exact.0)
        );
        assert!((plastic - exact.2).abs() < 1e-14);
    }
}

#[test]
fn the_reference_is_the_exact_solution_of_krieg_and_krieg() {
    // perfect plasticity, constant strain rate e: tan(ψ/2) = tan(ψ₀/2) exp(−2μ|e|t/R) of the angle between s and e
    let (_, stress) = first_yield();
    let rate = Sym3::new(0.03, -0.01, -0.02, 0.01, 0.02, 0.0);
    let perfect = Rates {
        radius: 0.0,
        centre: 0.0,
    };
    let (found, _, _) = perfect.integrate((stress, Sym3::ZERO, 0.0), |_| rate, 1000);
    let norm = |t: Sym3| t.double_dot(t).sqrt();
    let angle = |s: Sym3| (s.double_dot(rate) / (norm(s) * norm(rate))).acos();
    let decay = (-2.0 * MU * norm(rate) / norm(stress)).exp();
    let expected = 2.0 * ((0.5 * angle(stress)).tan() * decay).atan();
    assert!((angle(found) - expected).abs() < 1e-10);
    assert!((norm(found) / norm(stress) - 1.0).abs() < 1e-10);
}

#[test]
fn turning_paths_converge_to_the_rate_equations_with_first_order_and_extrapolate_to_1e_8() {
    let (_, stress) = first_yield();
    // starts along the shear of first yield, then turns to other components
    let path = |t: f64| {
        let turn = 1.2 * t;
        Sym3::new(
            0.03 * (1.0 - turn.cos()),
            -0.02 * (1.0 - turn.cos()),
            0.01 * t,
            0.04 * turn.sin(),
            0.03 * t * t,
            -0.02 * t * t * t,
        )
    };
    let rate = |t: f64| {
        let turn = 1.2 * t;
        Sym3::new(
            0.036 * turn.sin(),
            -0.024 * turn.sin(),
            0.01,
            0.048 * turn.cos(),
            0.06 * t,
            -0.06 * t * t,
        )
    };
    for (law, rates) in reference() {
        let exact = rates.integrate((stress, Sym3::ZERO, 0.0), rate, 4000);
        let check = rates.integrate((stress, Sym3::ZERO, 0.0), rate, 2000);
        assert!(
            largest(exact.0 - check.0) < 1e-10,
            "the reference is resolved"
        );
        let counts = [50, 100, 200, 400, 800, 1600];
        // Richardson: column after column takes away one power of the increment
        let mut column: Vec<(Sym3, f64)> = counts
            .iter()
            .map(|n| returned(law.as_ref(), &path, *n))
            .collect();
        let errors: Vec<f64> = column.iter().map(|(s, _)| largest(*s - exact.0)).collect();
        let order = (errors[4] / errors[5]).log2();
        assert!((order - 1.0).abs() < 0.02, "order {order}");
        for power in 1..counts.len() {
            let factor = f64::from(1 << power) - 1.0;
            column = column
                .windows(2)
                .map(|w| {
                    (
                        w[1].0 + (w[1].0 - w[0].0) * factor.recip(),
                        w[1].1 + (w[1].1 - w[0].1) / factor,
                    )
                })
                .collect();
        }
        let left = largest(column[0].0 - exact.0) / largest(exact.0);
        let left_plastic = (column[0].1 / exact.2 - 1.0).abs();
        println!(
            "last {:.1e}, order {order:.3}, extrapolated {left:.1e} {left_plastic:.1e}",
            errors[5]
        );
        assert!(left < 1e-8 && left_plastic < 1e-8, "{left} {left_plastic}");
    }
}

#[test]
fn a_table_that_falls_faster_than_elastic_unloading_is_refused() {
    let rows = vec![[200.0, 0.0], [1.0, 0.1]];
    let hardening = Hardening::new(HardeningKind::Isotropic, rows).unwrap();
    let outcome = Plasticity::new(E, NU, hardening.clone());
    assert!(matches!(
        outcome,
        Err(HardeningError::Falling { row: 2, .. })
    ));
    assert!(Plasticity::new(10.0 * E, NU, hardening).is_ok());
}

/// `Σ f_n xⁿ`: functions of a tensor by their power series, which no spectral decomposition enters.
fn series(x: Mat3, terms: usize, coefficient: impl Fn(usize) -> f64) -> Mat3 {
    let mut power = Mat3::IDENTITY;
    let mut sum = Mat3::ZERO;
    for n in 0..terms {
        sum = sum + power * coefficient(n);
        power = power * x;
    }
    sum
}

fn exponential(x: Mat3) -> Mat3 {
    series(x, 20, |n| {
        (1..=n).map(|k| k as f64).product::<f64>().recip()
    })
}

/// The logarithm of `I + x`.
fn logarithm(x: Mat3) -> Mat3 {
    series(x, 40, |n| match n {
        0 => 0.0,
        n => (if n % 2 == 0 { -1.0 } else { 1.0 }) / n as f64,
    })
}

/// Perfect plasticity with the whole of `F = F_e F_p`, by the exponential map, step after step; the Kirchhoff stress.
fn multiplicative(path: impl Fn(f64) -> Mat3, n: usize) -> Sym3 {
    let mut inverse = Mat3::IDENTITY; // F_p⁻¹
    let mut tau = Sym3::ZERO;
    for i in 1..=n {
        let trial = path(i as f64 / n as f64) * inverse;
        let x = trial.transpose() * trial - Mat3::IDENTITY;
        let log = Sym3::symmetric_part(logarithm(x)) * 0.5;
        let q = 2.0 * MU * deviator(log).von_mises();
        let flow = deviator(log) * (1.0 - 8.0 / q).max(0.0);
        let shrink = exponential(flow.to_mat3() * -1.0);
        inverse = inverse * shrink;
        let elastic = trial * shrink;
        let mandel = Sym3::IDENTITY * (BULK * log.trace()) + deviator(log - flow) * (2.0 * MU);
        let (back, _) = elastic.inverse().unwrap();
        tau = Sym3::symmetric_part(back.transpose() * mandel.to_mat3() * elastic.transpose());
    }
    tau
}

/// The Kirchhoff stress of a law along a path of deformation gradients.
fn kirchhoff(
    law: &dyn Material,
    path: impl Fn(f64) -> Mat3,
    n: usize,
    mut seen: impl FnMut(f64, Sym3),
) -> (Sym3, Vec<f64>) {
    let mut history = vec![0.0; law.nhistory()];
    let mut tau = Sym3::ZERO;
    for i in 1..=n {
        let f = path(i as f64 / n as f64);
        let e = (Sym3::gram(f) - Sym3::IDENTITY) * 0.5;
        tau = advance(law, &finite(e), &mut history).stress.congruence(f);
        seen(i as f64 / n as f64, tau);
    }
    (tau, history)
}

fn shear(gamma: f64) -> Mat3 {
    let mut f = Mat3::IDENTITY;
    f.rows[0].y = gamma;
    f
}

#[test]
fn shear_far_into_flow_keeps_the_yield_stress_of_the_multiplicative_theory() {
    // steady flow: b_e has the axis θ with tan θ = exp(−2e), e = k/(2√3 μ) its logarithmic strain, so that
    // τ_xy = k/√3 / cosh(2e), τ_xx = −τ_yy = k/√3 tanh(2e)
    let law = linear(HardeningKind::Isotropic, 0.0);
    let k = 8.0 / 3f64.sqrt();
    let (xy, xx) = (k / (k / MU).cosh(), k * (k / MU).tanh());
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    let path = |t: f64| shear(5.0 * t);
    let (tau, history) = kirchhoff(law.as_ref(), path, 4000, |t, tau| {
        if t > 0.05 {
            least = least.min(tau.xy());
            most = most.max(tau.xy());
        }
    });
    println!("{tau:?} {xy} {xx}, {least} to {most}");
    assert!(
        least > 0.999 * k && most < k * (1.0 + 1e-12),
        "{least} {most}"
    );
    assert!((tau.xy() / xy - 1.0).abs() < 1e-4);
    assert!((tau.xx() / xx - 1.0).abs() < 0.05 && (tau.yy() + tau.xx()).abs() < 1e-9);
    // the whole of F gives the same, step for step
    let reference = multiplicative(path, 4000);
    assert!(largest(tau - reference) < 1e-9, "{reference:?}");
    let trace: f64 = history[..3].iter().sum();
    assert!(trace.abs() < 1e-14, "flow keeps the volume: {trace:e}");
}

#[test]
fn a_path_of_turning_axes_equals_the_integration_with_the_whole_of_f() {
    let path = |t: f64| {
        let turn = Mat3::rotation(Vec3::new(2.0, -1.0, 3.0) * t);
        let stretch = Sym3::diagonal((0.8 * t).exp(), (-0.5 * t).exp(), (-0.28 * t).exp());
        turn * shear(1.5 * t * t) * stretch.to_mat3() * shear(-2.0 * t)
    };
    let law = linear(HardeningKind::Isotropic, 0.0);
    for n in [100, 1000] {
        let (tau, _) = kirchhoff(law.as_ref(), path, n, |_, _| {});
        let reference = multiplicative(path, n);
        let error = largest(tau - reference);
        println!("{n}: {error:e}");
        assert!(error < 1e-9, "{tau:?} {reference:?}");
    }
}

#[test]
fn proportional_stretching_takes_any_number_of_steps() {
    let r = rotation(3);
    for kind in kinds() {
        let law = linear(kind, 60.0);
        let path = |t: f64| {
            let log = [1.0, -0.7, -0.29].map(|h: f64| (h * t).exp());
            Sym3::diagonal(log[0], log[1], log[2])
                .congruence(r)
                .to_mat3()
        };
        let (few, a) = kirchhoff(law.as_ref(), path, 10, |_, _| {});
        let (many, b) = kirchhoff(law.as_ref(), path, 1000, |_, _| {});
        let error = largest(few - many) / largest(few);
        println!("{kind:?} {error:e}");
        assert!(error < 1e-10);
        let plastic = [a, b].map(|h| law.plastic_strain(&h).unwrap());
        assert!((plastic[0] / plastic[1] - 1.0).abs() < 1e-11, "{plastic:?}");
    }
}

#[test]
fn stress_does_not_oscillate_in_shear_when_the_centre_moves() {
    let law = linear(HardeningKind::Kinematic, 20.0);
    let mut last = 0.0;
    kirchhoff(
        law.as_ref(),
        |t| shear(5.0 * t),
        1000,
        |_, tau| {
            assert!(tau.xy() > last, "{} after {last}", tau.xy());
            last = tau.xy();
        },
    );
}

/// Where a step begins, stress lies on the yield surface but for rounding: the tangent there is that of unloading.
#[test]
fn on_the_yield_surface_the_tangent_is_the_elastic_one() {
    for kind in kinds() {
        for kinematics in KINEMATICS {
            let law = plastic(kind);
            let mut history = vec![0.0; law.nhistory()];
            law.start(&mut history);
            let value = Sym3::new(0.07, -0.02, 0.01, 0.05, -0.03, 0.02);
            let strain = Strain::new(kinematics, value);
            advance(law.as_ref(), &strain, &mut history);
            assert!(law.plastic_strain(&history).unwrap() > 0.01);
            let tangent = |by: f64| {
                let strain = Strain::new(kinematics, value * by);
                let (mut new, mut out) = (history.clone(), Response::default());
                law.respond(&strain, &history, &mut new, Order::Tangent, &mut out)
                    .unwrap();
                out.tangent
            };
            let [at, unloaded, loaded] = [1.0, 1.0 - 1e-7, 1.0 + 1e-7].map(tangent);
            let apart = |other: [[f64; 6]; 6]| {
                let pairs = at.as_flattened().iter().zip(other.as_flattened());
                pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
            };
            assert!(apart(unloaded) < 1e-3, "{kind:?} {kinematics:?}");
            assert!(apart(loaded) > 0.1 * MU, "{kind:?} {kinematics:?}");
        }
    }
}
