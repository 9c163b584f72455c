//! Contact laws: a pressure as a scalar function of gap, multiplier and scale.
//!
//! ```text
//!   p ▲
//!     │╲            penalty        p = ε⟨−g⟩
//!     │ ╲
//!     │  ╲
//!   ──┼───●─────▶ g     negative: penetration
//! ```
//!
//! Laws hold no state and have never heard of a degree of freedom. Laws with a multiplier λ ≥ 0 give its row as
//! [`ContactLaw::complementarity`], with the sign that makes ∂c/∂u the transpose of ∂r/∂λ.
//!
//! To add one: a file that implements [`ContactLaw`], and one line where cases are built.

mod penalty;

pub use penalty::Penalty;

/// What a law does with a multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multiplier {
    /// Has none.
    None,
    /// Keeps it frozen during an increment's iterations and updates it after.
    Frozen,
    /// Solves for it.
    Unknown,
}

/// The numbers a law scales with, from the model behind the row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// ε: pressure (or force) per penetration.
    pub penalty: f64,
    /// c: pressure (or force) per gap in a complementarity function.
    pub complementarity: f64,
    /// Size of the facets.
    pub length: f64,
}

/// A value with its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Eval {
    /// The value.
    pub value: f64,
    /// Derivative with respect to the gap.
    pub dgap: f64,
    /// Derivative with respect to the multiplier.
    pub dlambda: f64,
}

/// A contact law.
pub trait ContactLaw: Send + Sync {
    /// What it does with a multiplier.
    fn multiplier(&self) -> Multiplier {
        Multiplier::None
    }

    /// Whether it also pulls: tied.
    fn bilateral(&self) -> bool {
        false
    }

    /// The pressure, ≥ 0 in compression.
    fn pressure(&self, gap: f64, lambda: f64, scale: &Scale) -> Eval;

    /// The function whose root is contact; zero for laws without an unknown multiplier.
    fn complementarity(&self, _gap: f64, _lambda: f64, _scale: &Scale) -> Eval {
        Eval::default()
    }

    /// The multiplier after an increment's iterations.
    fn augment(&self, _gap: f64, lambda: f64, _scale: &Scale) -> f64 {
        lambda
    }

    /// The potential of the pressure, `p = −∂W/∂g`, where there is one.
    fn energy(&self, gap: f64, lambda: f64, scale: &Scale) -> Option<f64>;

    /// The largest multiple of a change of the gap that the law allows.
    fn max_step(&self, _gap: f64, _change: f64) -> f64 {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_is_minus_the_slope_of_energy_and_its_slope_is_dgap() {
        let laws: [&dyn ContactLaw; 1] = [&Penalty];
        let scale = Scale {
            penalty: 7.0,
            complementarity: 3.0,
            length: 1.0,
        };
        for law in laws {
            for gap in [-0.3, -0.01, 0.02, 1.0] {
                let h = 1e-6;
                let energy = |g| law.energy(g, 0.0, &scale).unwrap();
                let slope = (energy(gap + h) - energy(gap - h)) / (2.0 * h);
                let at = law.pressure(gap, 0.0, &scale);
                assert!((at.value + slope).abs() < 1e-8);
                let change = law.pressure(gap + h, 0.0, &scale).value
                    - law.pressure(gap - h, 0.0, &scale).value;
                assert!((at.dgap - change / (2.0 * h)).abs() < 1e-7);
                assert!(at.value >= 0.0);
                assert_eq!(law.max_step(gap, 1.0), 1.0);
            }
        }
    }
}
