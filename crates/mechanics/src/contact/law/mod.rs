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
//! | [`Gasket`] | its place has the largest closure so far | a curve in closing, others in opening | |
//! | [`Dugdale`], [`LennardJones`] | none | a curve that pulls before the sides touch |
//! | [`Uzawa`] | frozen | ⟨λ − εg⟩ | then λ ← p |
//! | [`AugmentedNewton`] | unknown | ⟨λ − εg⟩ | (p − λ)/ε |
//! | [`Lagrange`] | unknown | λ where λ > cg, else 0 | (⟨λ − cg⟩ − λ)/c |
//! | `Impulse`, of explicit steps | given | ⟨λ⟩ | |
//!
//! What heat flows between the sides is a law of its own, [`Conductance`].
//!
//! Laws hold no state (what [`Gasket::remember`] gives is kept by the row, and frozen in an increment) and have never heard of a degree of freedom. The sign of c makes ∂c/∂u the transpose of ∂r/∂λ.
//! [`Lagrange`] is the primal-dual active set; its c > 0 changes the way to the solution and not the solution.
//!
//! To add one: a file that implements [`ContactLaw`] and describes its keys, and one line in [`TABLE`]. Sources: Hüeber and
//! Wohlmuth, CMAME 194, 2005 (active set); Alart and Curnier, CMAME 92, 1991; Simo and Laursen, Comput. Struct. 42,
//! 1992 (Uzawa).

mod arctangent;
mod augmented;
mod conductance;
mod damping;
mod definition;
mod dugdale;
mod exponential;
mod gasket;
mod impulse;
mod lagrange;
mod lennard_jones;
mod penalty;
mod secant;
mod table;
#[cfg(test)]
mod tests;

pub use arctangent::Arctangent;
pub use augmented::{AugmentedNewton, Uzawa};
pub use conductance::{Between, Conductance, Conducted};
pub use damping::Damping;
use definition::TOUCH;
pub use definition::{ContactLaw, Eval, Multiplier, Scale, each};
pub use dugdale::Dugdale;
pub use exponential::Exponential;
pub use gasket::{Gasket, GasketError};
pub(super) use impulse::Impulse;
pub use lagrange::Lagrange;
pub use lennard_jones::LennardJones;
pub use penalty::Penalty;
pub(super) use secant::secant;
use signorini_vocabulary::{Description, Entry};
use std::sync::Arc;
pub use table::{Table, TableError};

/// The laws that a case may choose by name, apart from a penalty and multipliers.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::law::{Scale, TABLE};
/// use signorini_vocabulary::{Chosen, Entry};
///
/// // as a case makes it: `enforcement = { exponential = { p0 = 5.0, c0 = 0.1 } }`
/// let law = Entry::make(&TABLE, &Chosen::new("exponential", [("p0", 5.0), ("c0", 0.1)]))?;
/// let scale = Scale { penalty: 1.0, shear: 1.0, length: 1.0 };
/// assert!((law.pressure(0.0, 0.0, &scale).value - 5.0).abs() < 1e-14);
/// # Ok::<(), signorini_vocabulary::Fault>(())
/// ```
pub static TABLE: [Entry<Arc<dyn ContactLaw>>; 4] = [
    exponential::ENTRY,
    arctangent::ENTRY,
    dugdale::ENTRY,
    lennard_jones::ENTRY,
];

/// The names and keys of all laws of [`TABLE`].
#[must_use]
pub fn descriptions() -> Vec<Description> {
    TABLE.iter().map(|entry| entry.description).collect()
}
