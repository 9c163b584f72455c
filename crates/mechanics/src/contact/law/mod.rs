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
//! | law | multiplier | p(g, λ) | c(g, λ) |
//! |---|---|---|---|
//! | [`Penalty`] | none | ε⟨−g⟩ | |
//! | [`Table`], [`Exponential`], [`Arctangent`] | none | a curve that falls with the gap | |
//! | [`Uzawa`] | frozen | ⟨λ − εg⟩ | then λ ← p |
//! | [`AugmentedNewton`] | unknown | ⟨λ − εg⟩ | (p − λ)/ε |
//! | [`Lagrange`] | unknown | λ where λ > cg, else 0 | (⟨λ − cg⟩ − λ)/c |
//!
//! Laws hold no state and have never heard of a degree of freedom. The sign of c makes ∂c/∂u the transpose of ∂r/∂λ.
//! [`Lagrange`] is the primal-dual active set; its c > 0 changes the way to the solution and not the solution.
//!
//! To add one: a file that implements [`ContactLaw`] and describes its keys, and one line in [`TABLE`]. Sources: Hüeber and
//! Wohlmuth, CMAME 194, 2005 (active set); Alart and Curnier, CMAME 92, 1991; Simo and Laursen, Comput. Struct. 42,
//! 1992 (Uzawa).

mod arctangent;
mod augmented;
mod exponential;
mod lagrange;
mod penalty;
mod table;
#[cfg(test)]
mod tests;

pub use arctangent::Arctangent;
pub use augmented::{AugmentedNewton, Uzawa};
pub use exponential::Exponential;
pub use lagrange::Lagrange;
pub use penalty::Penalty;
pub use table::{Table, TableError};

use signorini_vocabulary::{Description, Entry};
use std::fmt::Debug;
use std::sync::Arc;

/// The laws that a case may choose by name, apart from a penalty and multipliers.
pub static TABLE: [Entry<Arc<dyn ContactLaw>>; 2] = [exponential::ENTRY, arctangent::ENTRY];

/// The names and keys of all laws of [`TABLE`].
#[must_use]
pub fn descriptions() -> Vec<Description> {
    TABLE.iter().map(|entry| entry.description).collect()
}

/// What a law does with a multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multiplier {
    /// Has none.
    None,
    /// Keeps it frozen during an increment's iterations and updates it after.
    Frozen,
    /// Solves for it; the pressure is that of the augmented Lagrangian.
    Augmented,
    /// Solves for it; it is the pressure.
    Direct,
}

impl Multiplier {
    /// Whether it is an unknown of the system.
    #[must_use]
    pub const fn is_unknown(self) -> bool {
        matches!(self, Self::Augmented | Self::Direct)
    }
}

/// The numbers a law scales with, from the model behind the row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// ε, or c: pressure (or force) per gap.
    pub penalty: f64,
    /// c_t: shear traction (or force) per slip, of unknown multipliers under friction.
    pub shear: f64,
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
pub trait ContactLaw: Debug + Send + Sync {
    /// Its name in messages, as in a case.
    fn name(&self) -> &str;

    /// What it does with a multiplier.
    fn multiplier(&self) -> Multiplier {
        Multiplier::None
    }

    /// The pressure, ≥ 0 in compression; all zero where it is open. A law may pull a little ([`Arctangent`]).
    fn pressure(&self, gap: f64, lambda: f64, scale: &Scale) -> Eval;

    /// The function whose root is contact; zero for laws without an unknown multiplier.
    fn complementarity(&self, _gap: f64, _lambda: f64, _scale: &Scale) -> Eval {
        Eval::default()
    }

    /// The pressure that a multiplier is compared with, `λ + ε c(g, λ)`: what friction is limited by. Without a multiplier
    /// that is solved for, the pressure itself.
    fn trial(&self, gap: f64, lambda: f64, scale: &Scale) -> Eval {
        let at = self.pressure(gap, lambda, scale);
        if !self.multiplier().is_unknown() || at == Eval::default() {
            return at;
        }
        let c = self.complementarity(gap, lambda, scale);
        Eval {
            // not even by rounding: a limit of friction has no sign
            value: (lambda + scale.penalty * c.value).max(0.0),
            dgap: scale.penalty * c.dgap,
            dlambda: 1.0 + scale.penalty * c.dlambda,
        }
    }

    /// The potential of the pressure, `p = −∂W/∂g`, where there is one.
    fn energy(&self, gap: f64, lambda: f64, scale: &Scale) -> Option<f64>;
}

/// Gap over the size of the facets up to which a surface touches.
const TOUCH: f64 = 1e-12;
