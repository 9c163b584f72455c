//! Contact forces that count with those before, as CalculiX has it.

use super::bar::{Bar, LENGTH};
use super::{solved, stopped_after};

/// Places of the foot and forces of a bar of linear elements by the method of Hilber, Hughes and Taylor, with a spring of stiffness
/// `k` behind the wall that counts as other forces do.
fn recursion(bar: &Bar, alpha: f64, k: f64) -> Vec<[f64; 2]> {
    let n = bar.elements + 1;
    let (l, h, share) = (LENGTH / bar.elements as f64, bar.h(), 1.0 + alpha);
    let (beta, gamma) = (0.25 * (1.0 - alpha) * (1.0 - alpha), 0.5 - alpha);
    // consistent mass and stiffness of neighbours: the entries on the diagonal, and off it
    let [mass, stiffness] = [[l / 3.0, l / 6.0], [900.0 / l, -900.0 / l]];
    let times = |of: [f64; 2], v: &[f64]| -> Vec<f64> {
        let row = |i: usize| {
            let left = if i > 0 {
                of[0] * v[i] + of[1] * v[i - 1]
            } else {
                0.0
            };
            let right = if i + 1 < n {
                of[0] * v[i] + of[1] * v[i + 1]
            } else {
                0.0
            };
            left + right
        };
        (0..n).map(row).collect()
    };
    let (mut d, mut v, mut a) = (vec![0.0; n], vec![-bar.velocity; n], vec![0.0; n]);
    let (mut before, mut out) = (0.0, Vec::new());
    for _ in 0..bar.increments {
        let free = |i: usize| d[i] + h * v[i] + h * h * (0.5 - beta) * a[i];
        let free: Vec<f64> = (0..n).map(free).collect();
        let fixed = times(stiffness, &d);
        let inert = times(mass, &free);
        let mut closed = false;
        let next = loop {
            let both = [0, 1].map(|c| mass[c] / (beta * h * h) + share * stiffness[c]);
            let mut diagonal = vec![2.0 * both[0]; n];
            (diagonal[0], diagonal[n - 1]) = (both[0], both[0]);
            let mut right: Vec<f64> = (0..n)
                .map(|i| inert[i] / (beta * h * h) + alpha * fixed[i])
                .collect();
            right[0] -= alpha * before;
            if closed {
                diagonal[0] += share * k;
                right[0] -= share * k * bar.gap;
            }
            for i in 1..n {
                let factor = both[1] / diagonal[i - 1];
                diagonal[i] -= factor * both[1];
                right[i] -= factor * right[i - 1];
            }
            let mut next = vec![0.0; n];
            for i in (0..n).rev() {
                let beyond = if i + 1 < n {
                    both[1] * next[i + 1]
                } else {
                    0.0
                };
                next[i] = (right[i] - beyond) / diagonal[i];
            }
            if (next[0] + bar.gap < 0.0) == closed {
                break next;
            }
            closed = !closed;
        };
        let last: Vec<f64> = (0..n)
            .map(|i| (next[i] - free[i]) / (beta * h * h))
            .collect();
        for i in 0..n {
            v[i] += h * ((1.0 - gamma) * a[i] + gamma * last[i]);
        }
        before = if closed {
            -k * (next[0] + bar.gap)
        } else {
            0.0
        };
        (d, a) = (next, last);
        out.push([d[0], before]);
    }
    out
}

/// A bar of few elements that meets a wall by a penalty.
fn short(alpha: &'static str, courant: f64, phase: f64) -> Bar {
    let bar = Bar {
        elements: 8,
        courant,
        dynamics: alpha,
        increments: 30,
        ..Bar::default()
    };
    let gap = bar.velocity * bar.h() * (1.0 + phase);
    Bar { gap, ..bar }.penalty(10.0)
}

#[test]
fn a_bar_meets_a_wall_as_the_recursion_says() {
    for (alpha, dynamics) in [
        (-0.05, "alpha = -0.05, contact_force = \"weighted\""),
        (-0.3, "alpha = -0.3, contact_force = \"weighted\""),
        (0.0, "alpha = 0.0, contact_force = \"weighted\""),
    ] {
        for courant in [0.4, 1.1] {
            for phase in [0.1, 0.6] {
                let bar = short(dynamics, courant, phase);
                let exact = "[solver]\nnewton = { force_tol = 1e-11 }\n";
                let got = solved(&(bar.text() + exact));
                let wanted = recursion(&bar, alpha, 10.0 * 900.0 / bar.size());
                for (row, [d, force]) in wanted.into_iter().enumerate() {
                    let place = format!("{dynamics} {courant} {phase}: increment {row}");
                    let own = got["low.displacement.x"][row];
                    assert!((own - d).abs() < 1e-9, "{place}: {own} for {d}");
                    let own = got["c.force_x"][row];
                    assert!(
                        (own - force).abs() < 1e-6 * 300.0,
                        "{place}: {own} for {force}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_run_goes_on_with_the_same_bits() {
    let bar = short("alpha = -0.05, contact_force = \"weighted\"", 0.4, 0.3);
    let text = bar.text() + "[checkpoint]\nevery = { increments = 1 }\n";
    let whole = stopped_after(&text, &[]);
    for stops in [&[2][..], &[9], &[12, 19]] {
        assert_eq!(whole, stopped_after(&text, stops), "{stops:?}");
    }
}

/// Where inertia counts, overlaps that an increment begins with are not allowed for.
#[test]
fn overlaps_are_not_allowed_for_where_inertia_counts() {
    let bar = short("rho_inf = 0.8", 0.4, 0.3);
    let [now, allowed] = ["now", "increments"].map(|word| {
        let start = format!("start = {{ interference = \"{word}\" }}\n[initial]");
        solved(&bar.text().replacen("[initial]", &start, 1))["c.force_x"].clone()
    });
    assert!(now.iter().any(|force| *force > 100.0));
    assert_eq!(now, allowed);
}
