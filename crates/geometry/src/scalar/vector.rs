//! Vectors of any kind of number.

use super::Real;

/// `a − b`.
#[inline]
#[must_use]
pub fn minus<T: Real, const D: usize>(a: [T; D], b: [T; D]) -> [T; D] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// The scalar product.
#[inline]
#[must_use]
pub fn dot<T: Real, const D: usize>(a: [T; D], b: [T; D]) -> T {
    let products = a.into_iter().zip(b).map(|(a, b)| a * b);
    products.fold(T::from(0.0), |sum, ab| sum + ab)
}

/// The vector product.
#[inline]
#[must_use]
pub fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The vector of length one in this direction; `None` where the length is zero or not finite.
#[inline]
#[must_use]
pub fn unit<T: Real, const D: usize>(a: [T; D]) -> Option<[T; D]> {
    let length = dot(a, a).sqrt();
    let exists = length.value() > 0.0 && length.value().is_finite();
    exists.then(|| a.map(|c| c / length))
}

/// `Σ w_i x_i`, over as many as there are of both.
#[inline]
#[must_use]
pub fn combine<T: Real, const D: usize>(
    weights: impl IntoIterator<Item = f64>,
    x: &[[T; D]],
) -> [T; D] {
    let mut sum = [T::from(0.0); D];
    for (w, x) in weights.into_iter().zip(x) {
        for (s, &c) in sum.iter_mut().zip(x) {
            *s += c * w;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::tensor::Vec3;

    #[test]
    fn vectors_of_plain_numbers_are_those_of_the_tensors() {
        let mut random = Random(2);
        for _ in 0..20 {
            let (a, b) = (random.vector(), random.vector());
            let (p, q) = (a.to_array(), b.to_array());
            assert_eq!(minus(p, q), (a - b).to_array());
            assert_eq!(cross(p, q), a.cross(b).to_array());
            assert!((dot(p, q) - a.dot(b)).abs() < 1e-15);
            let error = Vec3::from(unit(p).unwrap()) - a.normalized().unwrap();
            assert!(error.max_abs() < 1e-15);
            let sum = Vec3::from(combine([0.5, -2.0], &[p, q]));
            assert!((sum - (a * 0.5 - b * 2.0)).max_abs() < 1e-15);
        }
        assert_eq!(unit([0.0; 3]), None);
    }
}
