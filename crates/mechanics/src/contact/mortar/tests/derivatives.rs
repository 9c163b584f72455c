//! Derivatives of mortar integrals, and how surfaces turn.

use super::scenes::*;
use crate::contact::mortar::pair::facing;
use crate::contact::mortar::*;
use crate::contact::tests::Random;
use signorini_geometry::tensor::Mat3;

#[test]
fn derivatives_match_differences() {
    let mut random = Random::new(3);
    let mut worst = 0.0f64;
    let flat = pairings().into_iter().map(|e| (e, Measure::Flat));
    let revolved = pairings_of_lines().map(|e| (e, Measure::Revolved));
    for (elements, measure) in flat.chain(revolved) {
        let mut x = random_scene(elements, 0.08, &mut random);
        if measure == Measure::Revolved {
            x.iter_mut()
                .flatten()
                .for_each(|x| *x += Vec3::new(3.0, 0.0, 0.0));
            let turn = Mat3::rotation(Vec3::new(0.0, 0.0, 0.4));
            x.iter_mut().flatten().for_each(|x| *x = turn * *x);
        }
        let exact = measured(measure, elements, &x, true);
        assert_eq!(exact.met().len(), 2);
        let columns: Vec<(usize, usize)> = (0..3)
            .flat_map(|k| (0..x[k].len()).map(move |i| (k, i)))
            .collect();
        assert_eq!(exact.ncolumn(), 3 * columns.len());
        let components = if elements[0].dim() == 1 { 2 } else { 3 };
        for (number, &(k, i)) in columns.iter().enumerate().filter(|(n, _)| n % 3 != 1) {
            for c in 0..components {
                let h = 1e-4;
                let moved = |h: f64| {
                    let mut x = x.clone();
                    x[k][i][c] += h;
                    measured(measure, elements, &x, false)
                };
                let at = [-2.0, -1.0, 1.0, 2.0].map(|s| moved(s * h));
                let slope = |of: &dyn Fn(&Covered) -> f64| {
                    let [a, b, c, d] = [0, 1, 2, 3].map(|s| of(&at[s]));
                    (a - 8.0 * b + 8.0 * c - d) / (12.0 * h)
                };
                let v = 3 * number + c;
                let mut compare = |of: &dyn Fn(&Covered) -> f64, ours: f64| {
                    let slope = slope(of);
                    let error = (slope - ours).abs() / (1.0 + slope.abs());
                    worst = worst.max(error);
                    assert!(error < 1e-7, "{elements:?} {v}: {slope} {ours}");
                };
                for j in 0..exact.nnode() {
                    compare(&|c| c.d()[j], exact.dd(j)[v]);
                    for l in 0..exact.nprimary() {
                        compare(&|c| c.m(j)[l], exact.dm(j, l)[v]);
                    }
                }
                for a in 0..3 {
                    let ours = exact.dnormal(a).get(v).copied().unwrap_or(0.0);
                    compare(&|c| c.normal()[a], ours);
                }
            }
        }
    }
    println!("largest error of derivatives: {worst:.1e}");
}

#[test]
fn facets_seen_almost_edge_on_fade_out_and_their_derivatives_match_differences() {
    let cosine = |degrees: f64| degrees.to_radians().cos();
    assert_eq!(facing(cosine(59.9)).0, 1.0);
    assert_eq!(facing(cosine(80.1)).0, 0.0);
    for limit in [60.0, 80.0] {
        let [inside, outside] = [-1e-4, 1e-4].map(|d| facing(cosine(limit + d)));
        assert!((inside.0 - outside.0).abs() < 1e-9 && (inside.1 - outside.1).abs() < 1e-3);
    }
    let mut random = Random::new(5);
    let (mut worst, mut compared) = (0.0f64, 0);
    for elements in pairings() {
        for degrees in [62.0, 70.0, 77.0] {
            let axis = Vec3::unit(if elements[0].dim() == 1 { 2 } else { 1 });
            let turn = Mat3::rotation(axis * f64::to_radians(degrees));
            let [over, _] = primaries(elements[1], 0.02, &mut random);
            let flank: Vec<Vec3> = over.iter().map(|x| turn * *x).collect();
            let mut x = vec![facet(elements[0], 0.02, &mut random), flank];
            let exact = evaluate(elements, &x, true);
            if exact.met().is_empty() {
                continue; // curved beyond what can be seen of it
            }
            compared += 1;
            balanced(&exact, "almost edge-on");
            assert!((exact.facing() - cosine(degrees)).abs() < 0.1);
            for (k, element) in elements.into_iter().enumerate() {
                for v in 0..3 * element.nnode() {
                    if element.dim() == 1 && v % 3 == 2 {
                        continue;
                    }
                    let h = 1e-5;
                    let mut moved = |h: f64| {
                        let before = x[k][v / 3][v % 3];
                        x[k][v / 3][v % 3] += h;
                        let found = evaluate(elements, &x, false);
                        x[k][v / 3][v % 3] = before;
                        found
                    };
                    let [low, high] = [-h, h].map(&mut moved);
                    let column = 3 * elements[0].nnode() * k + v;
                    let mut compare = |of: &dyn Fn(&Covered) -> f64, ours: f64| {
                        let slope = (of(&high) - of(&low)) / (2.0 * h);
                        let error = (slope - ours).abs() / (1.0 + slope.abs());
                        worst = worst.max(error);
                        assert!(
                            error < 1e-5,
                            "{elements:?} {degrees} {column}: {slope} {ours}"
                        );
                    };
                    for j in 0..exact.nnode() {
                        compare(&|c| c.d()[j], exact.dd(j)[column]);
                        for l in 0..exact.nprimary() {
                            compare(&|c| c.m(j)[l], exact.dm(j, l)[column]);
                        }
                    }
                }
            }
        }
    }
    println!("{compared} pairs, largest error of derivatives: {worst:.1e}");
    assert!(compared > 40, "{compared}");
}

#[test]
fn integrals_do_not_notice_a_rigid_motion_and_the_normal_turns_with_it() {
    let mut random = Random::new(4);
    for elements in pairings() {
        let x = random_scene(elements, 0.1, &mut random);
        let mut turn = random.vector() * 2.0;
        let mut shift = random.vector() * 3.0;
        if elements[0].dim() == 1 {
            (turn, shift) = (
                Vec3::new(0.0, 0.0, turn.z),
                Vec3::new(shift.x, shift.y, 0.0),
            );
        }
        let turn = Mat3::rotation(turn);
        let moved: Vec<Vec<Vec3>> = x
            .iter()
            .map(|x| x.iter().map(|&x| turn * x + shift).collect())
            .collect();
        let (before, after) = (
            evaluate(elements, &x, false),
            evaluate(elements, &moved, false),
        );
        assert!((turn * before.normal() - after.normal()).max_abs() < 1e-14);
        for j in 0..before.nnode() {
            assert!((before.d()[j] - after.d()[j]).abs() < 1e-13, "{elements:?}");
            for (a, b) in before.m(j).iter().zip(after.m(j)) {
                assert!((a - b).abs() < 1e-11, "{elements:?} {a} {b}");
            }
        }
    }
}

#[test]
fn a_uniform_pressure_on_surfaces_of_revolution_has_the_exact_resultant() {
    let mut random = Random::new(8);
    let tau = std::f64::consts::TAU;
    for elements in pairings_of_lines() {
        for _ in 0..20 {
            let turn = Mat3::rotation(Vec3::new(0.0, 0.0, random.signed()));
            let place = |x: Vec3| turn * x + Vec3::new(2.5, 0.3, 0.0);
            let bend = 0.3 * random.signed();
            // the secondary side, bent, under one that covers it
            let own: Vec<Vec3> = elements[0].nodes().to_vec();
            let own: Vec<Vec3> = own
                .into_iter()
                .map(|x| place(Vec3::new(x.x, bend * (1.0 - x.x * x.x), 0.0)))
                .collect();
            let other: Vec<Vec3> = elements[1]
                .nodes()
                .iter()
                .map(|x| place(*x * -2.0))
                .collect();
            let covered = measured(Measure::Revolved, elements, &[own.clone(), other], false);
            balanced(&covered, "a ring");
            // along the axis, whatever the bend: 2 pi r dr
            let force = covered.d().iter().sum::<f64>() * covered.normal().y;
            let exact = 0.5 * tau * (own[1].x.powi(2) - own[0].x.powi(2));
            assert!(
                (force - exact).abs() < 1e-13 * tau,
                "{elements:?}: {force} {exact}"
            );
            for (d, full) in covered.d().iter().zip(covered.full()) {
                assert!((d - full).abs() < 1e-13, "{elements:?}: {d} {full}");
            }
        }
    }
}

#[test]
fn rings_that_coincide_pass_on_the_forces_of_a_uniform_pressure() {
    // straight lines: what a uniform pressure does to a node is the integral of 2 pi r N, on either side
    for elements in pairings_of_lines() {
        let line = |from: f64, to: f64| -> Vec<Vec3> {
            let place = |xi: &Vec3| {
                let s = 0.5 * (from + to) + 0.5 * (to - from) * xi.x;
                Vec3::new(1.0 + s, 0.5 * s, 0.0)
            };
            elements[usize::from(from > to)]
                .nodes()
                .iter()
                .map(place)
                .collect()
        };
        let exact = |element: Element, x: &[Vec3]| -> Vec<f64> {
            let mut sum = vec![0.0; x.len()];
            let mut n = sum.clone();
            let length = (x[1] - x[0]).norm();
            for (xi, w) in signorini_geometry::element::quadrature::gauss(4) {
                element.shape(&Vec3::new(xi, 0.0, 0.0), &mut n);
                let r: f64 = n.iter().zip(x).map(|(n, x)| n * x.x).sum();
                let w = w * 0.5 * length * std::f64::consts::TAU * r;
                sum.iter_mut().zip(&n).for_each(|(s, n)| *s += w * n);
            }
            sum
        };
        let (own, other) = (line(0.0, 1.0), line(0.8, 0.3));
        let one = measured(
            Measure::Revolved,
            elements,
            &[own.clone(), other.clone()],
            false,
        );
        let of_primary = exact(elements[1], &other);
        for (l, e) in of_primary.iter().enumerate() {
            let sum: f64 = (0..one.nnode()).map(|j| one.m(j)[l]).sum();
            assert!((sum - e).abs() < 1e-13, "{elements:?} M {l}: {sum} {e}");
        }
        let rest = [line(0.3, -0.2), line(1.1, 0.8)];
        let all = [own.clone(), other, rest[0].clone(), rest[1].clone()];
        let all = measured(Measure::Revolved, elements, &all, false);
        let t = Transformation::of(elements[0], Basis::Part).unwrap();
        let of_own = exact(elements[0], &own);
        for (j, d) in all.d().iter().enumerate() {
            let e: f64 = (0..own.len()).map(|k| t.get(j, k) * of_own[k]).sum();
            assert!((d - e).abs() < 1e-13, "{elements:?} D {j}: {d} {e}");
        }
    }
}
