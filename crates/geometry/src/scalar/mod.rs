//! Numbers that carry their derivatives: code written once for any [`Real`] is differentiated by [`Dual`] numbers.
//!
//! ```text
//! a = (a, a')      a + b = (a + b, a' + b')        a b = (a b, a b' + b a')        (E1)
//! a / b = (a/b, (a' − (a/b) b')/b)                 √a = (√a, a'/(2√a))             (E2)
//! ```
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | a | `value` | number |
//! | a' = ∂a/∂v | `slope` | one number for each of the `N` variables v |
//!
//! Comparisons and choices look at values alone, so that the branch that was taken is differentiated. The
//! number of variables is fixed at compile time; where it varies, the next larger one of a few serves, and the slopes
//! beyond stay zero.
//!
//! Source: Griewank and Walther, *Evaluating Derivatives*, 2nd ed. 2008, chapter 3 (forward mode).

mod dual;
mod vector;

pub use dual::Dual;
pub use vector::{combine, cross, dot, minus, unit};

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number that geometry can be computed with: `f64`, or one that carries derivatives.
pub trait Real:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// The value, without derivatives.
    fn value(&self) -> f64;

    /// The square root.
    #[must_use]
    fn sqrt(self) -> Self;
}

impl Real for f64 {
    #[inline]
    fn value(&self) -> f64 {
        *self
    }

    #[inline]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
}
