//! Vector registers for blocks of a few rows, in single precision, as the processor has them.

use pulp::{Scalar128b, Scalar256b, Simd, f32x4, f32x8};

/// Numbers that are worked on together: as many as the rows of a block, or a few more, whose results are dropped.
pub(super) const LANES: usize = 8;
/// As many where blocks have few rows.
pub(super) const FEW: usize = 4;

/// The sums of the rows of a block, in their lanes.
pub(super) type Sums = [f32; LANES];

/// A number as it is stored: itself, or so many parts of a unit that it shares with others.
pub(super) trait Number: Copy + Default + Send + Sync {
    /// The unit of numbers with these sizes, which are looked at only where it depends on them.
    fn unit(sizes: impl Iterator<Item = f32>) -> f32;
    fn new(value: f32, unit: f32) -> Self;
    fn value(self, unit: f32) -> f32;

    /// Numbers in a register, as multiples of their unit.
    fn four<V: Vectors>(vectors: V, values: &[Self; FEW]) -> V::Four;
    fn eight<V: Vectors>(vectors: V, values: &[Self; LANES]) -> V::Eight;
}

impl Number for f32 {
    fn unit(_: impl Iterator<Item = f32>) -> f32 {
        1.0
    }

    fn new(value: f32, _: f32) -> Self {
        value
    }

    fn value(self, _: f32) -> f32 {
        self
    }

    #[inline(always)]
    fn four<V: Vectors>(vectors: V, values: &[f32; FEW]) -> V::Four {
        vectors.four(values)
    }

    #[inline(always)]
    fn eight<V: Vectors>(vectors: V, values: &[f32; LANES]) -> V::Eight {
        vectors.eight(values)
    }
}

impl Number for i16 {
    fn unit(sizes: impl Iterator<Item = f32>) -> f32 {
        let largest = sizes.fold(0.0, f32::max);
        // a row of zeros has any unit
        if largest > 0.0 {
            largest / f32::from(i16::MAX)
        } else {
            1.0
        }
    }

    fn new(value: f32, unit: f32) -> Self {
        let number = value / unit;
        // to the nearest one, without a call
        (number + 0.5f32.copysign(number)) as i16
    }

    fn value(self, unit: f32) -> f32 {
        f32::from(self) * unit
    }

    #[inline(always)]
    fn four<V: Vectors>(vectors: V, values: &[i16; FEW]) -> V::Four {
        vectors.four_short(values)
    }

    #[inline(always)]
    fn eight<V: Vectors>(vectors: V, values: &[i16; LANES]) -> V::Eight {
        vectors.eight_short(values)
    }
}

/// Registers of four and of eight numbers.
pub(super) trait Vectors: Copy {
    type Four: Copy;
    type Eight: Copy;

    fn four(self, values: &[f32; FEW]) -> Self::Four;
    fn eight(self, values: &[f32; LANES]) -> Self::Eight;
    fn four_short(self, values: &[i16; FEW]) -> Self::Four;
    fn eight_short(self, values: &[i16; LANES]) -> Self::Eight;

    /// `sum + factor values`
    fn add_four(self, values: Self::Four, factor: f32, sum: Self::Four) -> Self::Four;
    fn add_eight(self, values: Self::Eight, factor: f32, sum: Self::Eight) -> Self::Eight;

    /// What several registers add up to.
    fn sum_of_four(self, all: &[Self::Four]) -> Sums;
    fn sum_of_eight(self, all: &[Self::Eight]) -> Sums;
}

/// Work on such registers.
pub(super) trait Task {
    fn run<V: Vectors>(self, vectors: V);
}

/// Instructions that make numbers of a register from short ones.
trait Short<const N: usize>: Simd {
    fn short(self, values: &[i16; N]) -> Self::f32s;
}

impl Short<FEW> for Scalar128b {
    #[inline(always)]
    fn short(self, values: &[i16; FEW]) -> f32x4 {
        pulp::cast(values.map(f32::from))
    }
}

impl Short<LANES> for Scalar256b {
    #[inline(always)]
    fn short(self, values: &[i16; LANES]) -> f32x8 {
        pulp::cast(values.map(f32::from))
    }
}

/// Two sets of instructions of the same processor: one for four numbers, one for eight.
#[derive(Clone, Copy)]
struct Pair<F, E> {
    four: F,
    eight: E,
}

impl<F: Short<FEW>, E: Short<LANES>> Vectors for Pair<F, E> {
    type Four = F::f32s;
    type Eight = E::f32s;

    #[inline(always)]
    fn four(self, values: &[f32; FEW]) -> F::f32s {
        load(self.four, values)
    }

    #[inline(always)]
    fn eight(self, values: &[f32; LANES]) -> E::f32s {
        load(self.eight, values)
    }

    #[inline(always)]
    fn four_short(self, values: &[i16; FEW]) -> F::f32s {
        self.four.short(values)
    }

    #[inline(always)]
    fn eight_short(self, values: &[i16; LANES]) -> E::f32s {
        self.eight.short(values)
    }

    #[inline(always)]
    fn add_four(self, values: F::f32s, factor: f32, sum: F::f32s) -> F::f32s {
        let factor = self.four.splat_f32s(factor);
        self.four.mul_add_e_f32s(values, factor, sum)
    }

    #[inline(always)]
    fn add_eight(self, values: E::f32s, factor: f32, sum: E::f32s) -> E::f32s {
        let factor = self.eight.splat_f32s(factor);
        self.eight.mul_add_e_f32s(values, factor, sum)
    }

    #[inline(always)]
    fn sum_of_four(self, all: &[F::f32s]) -> Sums {
        sum(self.four, all)
    }

    #[inline(always)]
    fn sum_of_eight(self, all: &[E::f32s]) -> Sums {
        sum(self.eight, all)
    }
}

/// The first numbers, as many as fit; zero where there are too few.
#[inline(always)]
fn load<S: Simd>(simd: S, values: &[f32]) -> S::f32s {
    let all = S::as_simd_f32s(values).0.first();
    all.copied().unwrap_or_else(|| simd.splat_f32s(0.0))
}

#[inline(always)]
fn sum<S: Simd>(simd: S, all: &[S::f32s]) -> Sums {
    let total = all.iter().copied();
    let total = total.reduce(|total, one| simd.add_f32s(total, one));
    let mut sums = Sums::default();
    if let (Some(to), Some(total)) = (S::as_mut_simd_f32s(&mut sums).0.first_mut(), total) {
        *to = total;
    }
    sums
}

/// Works with the registers of this processor.
pub(super) fn dispatch(task: impl Task) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        wide::run(simd, task);
        return;
    }
    task.run(Pair {
        four: Scalar128b,
        eight: Scalar256b,
    });
}

#[cfg(target_arch = "x86_64")]
mod wide {
    use super::{FEW, LANES, Pair, Short, Task};
    use pulp::x86::{V3, V3_128b, V3_256b};
    use pulp::{Simd, WithSimd, cast, f32x4, f32x8};

    impl Short<FEW> for V3_128b {
        #[inline(always)]
        fn short(self, values: &[i16; FEW]) -> f32x4 {
            let Self(simd) = self;
            let [a, b, c, d] = *values;
            let numbers = simd
                .sse4_1
                ._mm_cvtepi16_epi32(cast([a, b, c, d, 0, 0, 0, 0]));
            cast(simd.sse2._mm_cvtepi32_ps(numbers))
        }
    }

    impl Short<LANES> for V3_256b {
        #[inline(always)]
        fn short(self, values: &[i16; LANES]) -> f32x8 {
            let Self(simd) = self;
            let numbers = simd.avx2._mm256_cvtepi16_epi32(cast(*values));
            cast(simd.avx._mm256_cvtepi32_ps(numbers))
        }
    }

    /// A task with the proof that the processor has AVX2 and FMA.
    struct Proven<T> {
        task: T,
        simd: V3,
    }

    impl<T: Task> WithSimd for Proven<T> {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, _: S) {
            self.task.run(Pair {
                four: V3_128b(self.simd),
                eight: V3_256b(self.simd),
            });
        }
    }

    pub(super) fn run(simd: V3, task: impl Task) {
        Simd::vectorize(simd, Proven { task, simd });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums over columns of four and of eight numbers.
    struct Columns<'a> {
        columns: &'a [[f32; LANES]],
        factors: &'a [f32],
        sums: &'a mut [Sums; 2],
    }

    impl Task for Columns<'_> {
        fn run<V: Vectors>(self, vectors: V) {
            let mut four = [vectors.four(&[1.0; FEW]), vectors.four(&[0.0; FEW])];
            let mut eight = [vectors.eight(&[1.0; LANES]), vectors.eight(&[0.0; LANES])];
            for (k, (column, factor)) in self.columns.iter().zip(self.factors).enumerate() {
                let first = column.first_chunk().unwrap();
                let first = vectors.four(first);
                four[k % 2] = vectors.add_four(first, *factor, four[k % 2]);
                let column = vectors.eight(column);
                eight[k % 2] = vectors.add_eight(column, *factor, eight[k % 2]);
            }
            *self.sums = [vectors.sum_of_four(&four), vectors.sum_of_eight(&eight)];
        }
    }

    /// Short numbers, as they come into registers and out of them.
    #[derive(Clone, Copy)]
    struct Shorts([i16; LANES], [Sums; 2]);

    impl Task for &mut Shorts {
        fn run<V: Vectors>(self, vectors: V) {
            let Shorts(numbers, [few, all]) = self;
            *few = vectors.sum_of_four(&[vectors.four_short(numbers.first_chunk().unwrap())]);
            *all = vectors.sum_of_eight(&[vectors.eight_short(numbers)]);
        }
    }

    #[test]
    fn short_numbers_are_multiples_of_their_unit() {
        let values = [1.0, -1.0, 0.0, 0.3, -0.7, 1e-5, 2e-5, -0.999_99f32];
        let unit = i16::unit(values.iter().map(|value| value.abs()));
        let numbers = values.map(|value| i16::new(value, unit));
        for (value, number) in values.iter().zip(numbers) {
            assert!((f32::from(number) * unit - value).abs() <= 0.501 * unit);
        }
        assert_eq!(i16::new(0.0, i16::unit([0.0].into_iter())), 0);
        let [mut here, mut plain] = [Shorts(numbers, Default::default()); 2];
        dispatch(&mut here);
        (&mut plain).run(Pair {
            four: Scalar128b,
            eight: Scalar256b,
        });
        for Shorts(_, [few, all]) in [here, plain] {
            assert_eq!(all, numbers.map(f32::from));
            assert_eq!(few[..FEW], all[..FEW]);
        }
    }

    #[test]
    fn sums_are_those_of_their_lanes_on_every_processor() {
        // numbers whose products and sums have no rounding
        let columns: Vec<[f32; LANES]> = (0..9)
            .map(|k| std::array::from_fn(|lane| (3 * k + lane) as f32 - 10.0))
            .collect();
        let factors: Vec<f32> = (0..9).map(|k| 4.0 - k as f32).collect();
        let right: Sums = std::array::from_fn(|lane| {
            let pairs = columns.iter().zip(&factors);
            1.0 + pairs.map(|(c, f)| c[lane] * f).sum::<f32>()
        });
        let task = |sums| Columns {
            columns: &columns,
            factors: &factors,
            sums,
        };
        let [mut here, mut plain] = [[Sums::default(); 2]; 2];
        dispatch(task(&mut here));
        task(&mut plain).run(Pair {
            four: Scalar128b,
            eight: Scalar256b,
        });
        for sums in [here, plain] {
            assert_eq!(sums[0][..FEW], right[..FEW]);
            assert_eq!(sums[1], right);
        }
    }
}
