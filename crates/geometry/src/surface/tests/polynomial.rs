//! Polynomials and the closest of their branches.

use crate::random::Random;
use crate::surface::*;
use crate::tensor::Vec3;
use std::f64::consts::TAU;

/// The cubic `2 a² t³ + (1 − 2 a Y) t − X = 0` of the closest points of `y = a x²`, by Cardano's formula.
#[test]
fn parabola_agrees_with_the_roots_of_its_cubic() {
    let mut random = Random(27);
    let mut three = 0;
    for _ in 0..2000 {
        let a = 0.2 + random.unit();
        let (x, y) = (2.0 * random.signed(), 4.0 * random.signed());
        let (p, q) = ((1.0 - 2.0 * a * y) / (2.0 * a * a), -x / (2.0 * a * a));
        let disc = (q / 2.0).powi(2) + (p / 3.0).powi(3);
        let roots = if disc >= 0.0 {
            let s = disc.sqrt();
            vec![(-q / 2.0 + s).cbrt() + (-q / 2.0 - s).cbrt()]
        } else {
            three += 1;
            let r = 2.0 * (-p / 3.0).sqrt();
            let angle = (3.0 * q / (p * r)).clamp(-1.0, 1.0).acos() / 3.0;
            (0..3)
                .map(|k| r * (angle - TAU * f64::from(k) / 3.0).cos())
                .collect()
        };
        let distance = |t: f64| (x - t).hypot(y - a * t * t);
        let expected = roots
            .into_iter()
            .map(distance)
            .fold(f64::INFINITY, f64::min);
        let shape = Polynomial::new(&[a, 0.0, 0.0], Facing::Above).unwrap();
        let foot = shape.closest(Vec3::new(x, y, 0.0)).unwrap().unwrap();
        let found = distance(foot.x);
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    assert!(three > 200, "{three}");
}

/// Every degree, near and far, with branches that compete: against a fine grid whose best cells are bisected.
#[test]
fn polynomials_of_any_degree_find_the_closest_of_their_branches() {
    let mut random = Random(28);
    for degree in 0..=MAX_DEGREE {
        for round in 0..300 {
            let wild = 10f64.powf(2.0 * random.unit());
            let coefficients: Vec<f64> = (0..=degree).map(|_| wild * random.signed()).collect();
            let shape = Polynomial::new(&coefficients, Facing::Above).unwrap();
            let f = |x: f64| coefficients.iter().fold(0.0, |f, c| f * x + c);
            let spread = [0.01, 1.0, 30.0][round % 3];
            let point = Vec3::new(1.5 * random.signed(), spread * random.signed(), 0.0);
            let foot = shape.closest(point).unwrap().unwrap();
            let distance = |x: f64| (x - point.x).hypot(f(x) - point.y);
            let found = distance(foot.x);
            let h = (f(point.x) - point.y).abs();
            const N: usize = 4000;
            let x = |k: f64| point.x - h + 2.0 * h * k / N as f64;
            let mut best = f64::INFINITY;
            for k in 0..=N {
                let k = k as f64;
                if distance(x(k)) <= distance(x(k - 1.0)).min(distance(x(k + 1.0))) {
                    let (mut a, mut b) = (x(k - 1.0), x(k + 1.0));
                    for _ in 0..200 {
                        let (p, q) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                        if distance(p) < distance(q) {
                            b = q;
                        } else {
                            a = p;
                        }
                    }
                    best = best.min(distance(0.5 * (a + b)));
                }
            }
            let tolerance = 1e-10 * (1.0 + h);
            assert!(found < best + tolerance, "degree {degree}: {found} {best}");
        }
    }
}

#[test]
fn feet_of_a_polynomial_stand_upright_to_round_off() {
    let mut random = Random(29);
    let mut worst = 0.0f64;
    for _ in 0..2000 {
        let coefficients: Vec<f64> = (0..9).map(|_| random.signed()).collect();
        let shape = Polynomial::new(&coefficients, Facing::Above).unwrap();
        let point = random.vector();
        let foot = shape.closest(point).unwrap().unwrap();
        let normal = shape.patch(foot).unwrap().normal;
        let away = point - foot;
        let off = (away - normal * away.dot(normal)).norm();
        // rounding of f goes along a steep tangent
        worst = worst.max(off * normal.y.abs());
    }
    assert!(worst < 2e-15, "{worst:e}");
}

#[test]
fn a_polynomial_is_the_plane_or_parabola_that_it_is() {
    let p = |c: &[f64]| Polynomial::new(c, Facing::Above).unwrap();
    let foot = |c: &[f64], x, y| p(c).closest(Vec3::new(x, y, 0.0)).unwrap().unwrap();
    assert!((foot(&[2.0], 3.0, 7.0) - Vec3::new(3.0, 2.0, 0.0)).norm() < 1e-15);
    assert!((foot(&[0.0, 0.0, 0.0], 3.0, 7.0) - Vec3::new(3.0, 0.0, 0.0)).norm() < 1e-15);
    assert!((foot(&[1.0, 0.0], 0.0, 2.0) - Vec3::new(1.0, 1.0, 0.0)).norm() < 1e-15);
    assert_eq!(foot(&[1.0, 0.0, 0.0], 2.0, 4.0), Vec3::new(2.0, 4.0, 0.0));
    // all but below the vertex: distances do not distinguish the foot from the point straight above
    let x = foot(&[1.0, 0.0, 0.0], 1e-9, -1.0).x;
    assert!((x - 1e-9 / 3.0).abs() < 1e-22, "{x:e}");
    // two branches of equal distance: the left one
    assert!((foot(&[1.0, 0.0, 0.0], 0.0, 2.5).x + 2f64.sqrt()).abs() < 1e-14);
    let top = p(&[1.0, 0.0, 0.0]).patch(Vec3::ZERO).unwrap();
    assert_eq!(top.normal, Vec3::unit(1));
    assert_eq!(top.gradient.xx(), -2.0);
    assert_eq!(p(&[0.0, 0.0, 1.0, 2.0]), p(&[1.0, 2.0]));
}
