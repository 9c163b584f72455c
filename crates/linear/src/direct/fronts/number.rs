//! The numbers of a factor, in double or single precision.

use faer::traits::ComplexField;
use std::ops::{AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Numbers that factors are made of.
pub(super) trait Number:
    ComplexField
    + Copy
    + Default
    + AddAssign
    + SubAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + PartialOrd
{
    /// What is smaller counts as nothing in a front.
    const SMALLEST: Self;
    /// A pivot below it, in units of the largest entry of its row, is round-off.
    const VANISHING: f64;
    /// It is replaced by this one: the root of the round-off, where errors by the change and by growth are alike.
    const REPLACEMENT: f64;

    fn narrow(value: f64) -> Self;

    fn wide(self) -> f64;

    /// The number, unless it counts as nothing.
    #[inline(always)]
    fn flushed(self) -> Self {
        if self < Self::SMALLEST && -self < Self::SMALLEST {
            Self::default()
        } else {
            self
        }
    }
}

impl Number for f64 {
    const SMALLEST: Self = 1e-150;
    const VANISHING: f64 = 1e-14;
    const REPLACEMENT: f64 = 1.5e-8;

    fn narrow(value: f64) -> Self {
        value
    }

    fn wide(self) -> f64 {
        self
    }
}

impl Number for f32 {
    const SMALLEST: Self = 1e-18;
    const VANISHING: f64 = 1e-6;
    const REPLACEMENT: f64 = 3.5e-4;

    fn narrow(value: f64) -> Self {
        value as Self
    }

    fn wide(self) -> f64 {
        f64::from(self)
    }
}
