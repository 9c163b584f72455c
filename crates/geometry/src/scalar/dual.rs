use super::Real;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number and its first derivatives with respect to `N` variables.
///
/// # Example
/// ```
/// use signorini_geometry::scalar::{Dual, Real};
///
/// // √(x y) at (4, 9), with its derivatives y/(2√(x y)) and x/(2√(x y))
/// let (x, y) = (Dual::<2>::variable(4.0, 0), Dual::<2>::variable(9.0, 1));
/// let root = (x * y).sqrt();
/// assert_eq!(root.value, 6.0);
/// assert_eq!(root.slope, [0.75, 1.0 / 3.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub value: f64,
    /// The derivatives.
    pub slope: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The variable of this number, with this value; one that does not exist is a constant.
    #[inline]
    #[must_use]
    pub fn variable(value: f64, number: usize) -> Self {
        let mut slope = [0.0; N];
        if let Some(s) = slope.get_mut(number) {
            *s = 1.0;
        }
        Self { value, slope }
    }

    /// `f(a)`, from its value and its slope there.
    #[inline]
    fn of(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            slope: self.slope.map(|s| slope * s),
        }
    }

    /// `f(a, b)`, from its value and its slopes there.
    #[inline]
    fn join(mut self, other: &Self, value: f64, [a, b]: [f64; 2]) -> Self {
        self.value = value;
        for (s, t) in self.slope.iter_mut().zip(&other.slope) {
            *s = a * *s + b * t;
        }
        self
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    #[inline]
    fn from(value: f64) -> Self {
        Self {
            value,
            slope: [0.0; N],
        }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        self.of(-self.value, -1.0)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;

    #[inline]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        for (s, t) in self.slope.iter_mut().zip(&other.slope) {
            *s += t;
        }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;

    #[inline]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        self.value -= other.value;
        for (s, t) in self.slope.iter_mut().zip(&other.slope) {
            *s -= t;
        }
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        self.join(&other, a * b, [b, a])
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        self.of(self.value * factor, factor)
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;

    #[inline]
    fn div(self, other: Self) -> Self {
        let (over, ratio) = (1.0 / other.value, self.value / other.value);
        self.join(&other, ratio, [over, -ratio * over])
    }
}

impl<const N: usize> Real for Dual<N> {
    #[inline]
    fn value(&self) -> f64 {
        self.value
    }

    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.of(root, 0.5 / root)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use num_dual::{Dual64, DualNum as _};

    /// A function that uses every operation; of any kind of number that has them.
    macro_rules! tangled {
        ($a:expr, $b:expr, $c:expr) => {{
            let (a, b, c) = ($a, $b, $c);
            let root = (a * a + b * b).sqrt();
            let mut sum = -a * c / (root + b) * 1.5;
            sum += (c - a) * root;
            sum -= b / c;
            sum
        }};
    }

    #[test]
    fn derivatives_are_those_of_another_library() {
        let mut random = Random(1);
        for _ in 0..100 {
            let v = [0, 1, 2].map(|_| 1.0 + random.unit());
            let ours: Dual<3> = {
                let [a, b, c] = [0, 1, 2].map(|k| Dual::variable(v[k], k));
                tangled!(a, b, c)
            };
            assert_eq!(ours.value, tangled!(v[0], v[1], v[2]));
            for k in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|i| Dual64::new(v[i], f64::from(u8::from(i == k))));
                let theirs = tangled!(a, b, c);
                assert!((ours.value - theirs.re).abs() < 1e-14);
                assert!((ours.slope[k] - theirs.eps).abs() < 1e-13, "{k}");
            }
        }
    }
}
