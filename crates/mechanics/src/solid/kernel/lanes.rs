//! Numbers of several cells at once: one in each lane of a vector register, as wide as the processor's.

use pulp::{Arch, Simd, WithSimd};
use std::ops::{Add, Mul, Neg};

/// Lanes that any processor has, at most.
pub(super) const MOST: usize = 8;

/// A number in each lane.
#[derive(Clone, Copy)]
pub(super) struct Lanes<S: Simd> {
    simd: S,
    value: S::f64s,
}

impl<S: Simd> Lanes<S> {
    /// The same number in all lanes.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        let value = simd.splat_f64s(value);
        Self { simd, value }
    }

    /// The numbers of a register.
    #[inline(always)]
    pub fn new(simd: S, value: S::f64s) -> Self {
        Self { simd, value }
    }

    /// The register.
    #[inline(always)]
    pub fn value(self) -> S::f64s {
        self.value
    }

    /// `self · factor + term`, rounded once where the processor can.
    #[inline(always)]
    pub fn mul_add(self, factor: Self, term: Self) -> Self {
        let value = self
            .simd
            .mul_add_e_f64s(self.value, factor.value, term.value);
        Self { value, ..self }
    }

    /// `1 / self`
    #[inline(always)]
    pub fn recip(self) -> Self {
        let value = self.simd.div_f64s(self.simd.splat_f64s(1.0), self.value);
        Self { value, ..self }
    }

    /// Whether the numbers in all lanes are positive; none that is no number is.
    #[inline(always)]
    pub fn are_positive(self) -> bool {
        let values = [self.value];
        let numbers: &[f64] = pulp::bytemuck::cast_slice(&values);
        numbers.iter().fold(true, |all, v| all & (*v > 0.0))
    }
}

impl<S: Simd> Add for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let value = self.simd.add_f64s(self.value, other.value);
        Self { value, ..self }
    }
}

impl<S: Simd> Mul for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.simd.mul_f64s(self.value, other.value);
        Self { value, ..self }
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let value = self.simd.neg_f64s(self.value);
        Self { value, ..self }
    }
}

/// How many lanes there are on this processor.
pub(in crate::solid) fn width() -> usize {
    struct Width;
    impl WithSimd for Width {
        type Output = usize;

        fn with_simd<S: Simd>(self, _: S) -> usize {
            S::F64_LANES
        }
    }
    Arch::new().dispatch(Width)
}
