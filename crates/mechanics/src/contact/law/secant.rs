//! The pressure that does exactly the work of a potential from one gap to another.
//!
//! ```text
//! p̄ = −(W(γ₁) − W(γ₀))/(γ₁ − γ₀)        ∂p̄/∂γ₁ = (p(γ₁) − p̄)/(γ₁ − γ₀)                         (L1)
//! ```
//!
//! Where the gaps are so close that the quotient is lost in rounding, it is the mean of the pressure between them, by Simpson's rule.
//!
//! Source: Armero and Petőcz, CMAME 158, 1998.

use super::{ContactLaw, Eval, Scale};

/// The difference of two gaps over the larger one below which Simpson's rule has no larger an error than the quotient.
const CLOSE: f64 = 1e-5;

/// (L1) from γ₀ to γ₁, with the derivative against γ₁; nothing for a law without a potential.
pub fn secant(law: &dyn ContactLaw, [from, to]: [f64; 2], scale: &Scale) -> Option<Eval> {
    let pressure = |gap: f64| law.pressure(gap, 0.0, scale);
    let (change, last) = (to - from, pressure(to));
    if change.abs() <= CLOSE * from.abs().max(to.abs()) {
        let (first, middle) = (pressure(from), pressure(0.5 * (from + to)));
        return Some(Eval {
            value: (first.value + 4.0 * middle.value + last.value) / 6.0,
            dgap: (2.0 * middle.dgap + last.dgap) / 6.0,
            dlambda: 0.0,
        });
    }
    let energy = |gap: f64| law.energy(gap, 0.0, scale);
    let value = (energy(from)? - energy(to)?) / change;
    Some(Eval {
        value,
        dgap: (last.value - value) / change,
        dlambda: 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Arctangent, Exponential, Penalty, Table};
    use super::*;

    const SCALE: Scale = Scale {
        penalty: 3e3,
        shear: 1e3,
        length: 0.5,
    };

    fn laws() -> [Box<dyn ContactLaw>; 4] {
        [
            Box::new(Penalty),
            Box::new(Table::new(vec![[-0.3, 40.0], [-0.1, 10.0], [0.0, 0.0]]).unwrap()),
            Box::new(Exponential {
                p0: 5.0,
                c0: 0.1,
                within: f64::INFINITY,
            }),
            Box::new(Arctangent {
                stiffness: 1e3,
                tension: 1.0,
                within: f64::INFINITY,
            }),
        ]
    }

    #[test]
    fn secants_do_the_work_of_the_potential() {
        for law in laws() {
            for (from, to) in [(-0.05, -0.02), (0.03, -0.04), (-0.04, 0.02), (-0.02, -0.07)] {
                let at = secant(law.as_ref(), [from, to], &SCALE).unwrap();
                let energy = |gap| law.energy(gap, 0.0, &SCALE).unwrap();
                let work = -at.value * (to - from);
                let gained = energy(to) - energy(from);
                let size = energy(to).abs().max(energy(from).abs()).max(1e-9);
                assert!((work - gained).abs() < 1e-13 * size, "{law:?} {from} {to}");
                let h = 1e-6;
                let [up, down] = [to + h, to - h].map(|to| {
                    let at = secant(law.as_ref(), [from, to], &SCALE);
                    at.map_or(f64::NAN, |at| at.value)
                });
                let slope = (up - down) / (2.0 * h);
                let off = (at.dgap - slope).abs();
                assert!(
                    off < 1e-4 * slope.abs().max(1.0),
                    "{law:?} {from} {to}: {off:e}"
                );
            }
        }
    }

    /// The rule for close gaps goes over into the quotient.
    #[test]
    fn close_gaps_have_the_mean_pressure() {
        for law in laws() {
            for part in [0.0, 1e-9, 0.9e-5, 1.1e-5] {
                let (from, to) = (-0.06, -0.06 * (1.0 + part));
                let at = secant(law.as_ref(), [from, to], &SCALE).unwrap();
                let middle = law.pressure(0.5 * (from + to), 0.0, &SCALE);
                let off = (at.value - middle.value).abs();
                assert!(off < 2e-10 * middle.value.abs(), "{law:?} {part}: {off:e}");
                let off = (at.dgap - 0.5 * middle.dgap).abs();
                assert!(off < 1e-4 * middle.dgap.abs(), "{law:?} {part}: {off:e}");
            }
        }
    }

    #[test]
    fn what_stays_apart_has_no_pressure() {
        let at = secant(&Penalty, [0.2, 0.1], &SCALE).unwrap();
        assert_eq!(at, Eval::default());
        let opens = secant(&Penalty, [-0.1, 0.1], &SCALE).unwrap();
        assert!(opens.value > 0.0);
    }
}
