//! Small dense systems and the logarithm of a tensor.

use signorini_geometry::tensor::{Sym3, Vec3};

/// A strain below it has its logarithm from a series of no more than ten terms.
const SMALL: f64 = 0.1;

/// Solves `a x = b` by elimination with pivoting, `b` of `nright` columns becoming `x`. Both are row-major; `a` is lost.
/// `None` where a pivot is no longer a number of the matrix's own size.
pub(crate) fn solve(a: &mut [f64], n: usize, b: &mut [f64], nright: usize) -> Option<()> {
    let size = a.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i * n + k].abs().total_cmp(&a[j * n + k].abs()))?;
        let value = a[pivot * n + k];
        if !(value.abs() > f64::EPSILON * size && value.is_finite()) {
            return None;
        }
        if pivot != k {
            (0..n).for_each(|c| a.swap(k * n + c, pivot * n + c));
            (0..nright).for_each(|c| b.swap(k * nright + c, pivot * nright + c));
        }
        let (above, below) = a.split_at_mut((k + 1) * n);
        let (known, unknown) = b.split_at_mut((k + 1) * nright);
        let (above, known) = (&above[k * n..], &known[k * nright..]);
        let rows = below.chunks_exact_mut(n);
        for (row, right) in rows.zip(unknown.chunks_exact_mut(nright)) {
            let factor = row[k] / value;
            if factor != 0.0 {
                subtract(&mut row[k..], factor, &above[k..]);
                subtract(right, factor, known);
            }
        }
    }
    for k in (0..n).rev() {
        let (unknown, known) = b.split_at_mut((k + 1) * nright);
        let (row, right) = (&a[k * n..(k + 1) * n], &mut unknown[k * nright..]);
        for (factor, known) in row[k + 1..].iter().zip(known.chunks_exact(nright)) {
            subtract(right, *factor, known);
        }
        right.iter_mut().for_each(|x| *x /= row[k]);
    }
    Some(())
}

/// Subtracts a multiple of one row from another.
pub(crate) fn subtract(from: &mut [f64], factor: f64, row: &[f64]) {
    for (from, value) in from.iter_mut().zip(row) {
        *from -= factor * value;
    }
}

/// `½ ln(I + 2e)`, exact to round-off for small `e`, too.
pub(crate) fn half_logarithm(e: Sym3) -> Sym3 {
    let is_small = e.double_dot(e) < SMALL * SMALL;
    let by_series = is_small.then(|| half_logarithm_by_series(e)).flatten();
    by_series.unwrap_or_else(|| half_logarithm_by_rotations(e))
}

/// With `z = e (I + e)⁻¹`, `½ ln(I + 2e) = artanh z = z (I + z²/3 + z⁴/5 + …)`, which needs few terms.
fn half_logarithm_by_series(e: Sym3) -> Option<Sym3> {
    let (inverse, _) = (Sym3::IDENTITY + e).inverse()?;
    let z = commuting(e, inverse);
    let square = commuting(z, z);
    let size = square.double_dot(square).sqrt();
    let (mut left, mut terms) = (size, 1);
    while left > 0.1 * f64::EPSILON {
        left *= size;
        terms += 1;
    }
    let mut sum = Sym3::ZERO;
    for k in (0..=terms).rev() {
        sum = Sym3::IDENTITY * f64::from(2 * k + 1).recip() + commuting(sum, square);
    }
    Some(commuting(z, sum))
}

/// The product of two tensors that commute, which is symmetric.
fn commuting(a: Sym3, b: Sym3) -> Sym3 {
    let ([axx, ayy, azz, axy, ayz, axz], [bxx, byy, bzz, bxy, byz, bxz]) =
        (a.to_pairs(), b.to_pairs());
    Sym3::new(
        axx * bxx + axy * bxy + axz * bxz,
        axy * bxy + ayy * byy + ayz * byz,
        axz * bxz + ayz * byz + azz * bzz,
        axx * bxy + axy * byy + axz * byz,
        axy * bxz + ayy * byz + ayz * bzz,
        axx * bxz + axy * byz + axz * bzz,
    )
}

/// By Jacobi's rotations, for any size.
fn half_logarithm_by_rotations(e: Sym3) -> Sym3 {
    let mut a = e.to_mat3().rows;
    let mut axes = [Vec3::unit(0), Vec3::unit(1), Vec3::unit(2)];
    // negligible compared with the whole
    let nothing = 1e-18
        * a.iter()
            .flat_map(|row| row.to_array())
            .fold(0.0, |m: f64, v| m.max(v.abs()));
    // three sweeps leave round-off of a cubic process
    for _ in 0..8 {
        let mut is_done = true;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() <= nothing {
                continue;
            }
            is_done = false;
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (1.0 + theta * theta).sqrt());
            let c = 1.0 / (1.0 + t * t).sqrt();
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            (a[p], a[q]) = (a[p] * c - a[q] * s, a[p] * s + a[q] * c);
            (axes[p], axes[q]) = (axes[p] * c - axes[q] * s, axes[p] * s + axes[q] * c);
            a[p][q] = 0.0;
            a[q][p] = 0.0;
        }
        if is_done {
            break;
        }
    }
    let principal = axes.into_iter().enumerate().map(|(k, n)| {
        let value = 0.5 * (2.0 * a[k][k]).ln_1p();
        Sym3::new(
            n.x * n.x,
            n.y * n.y,
            n.z * n.z,
            n.x * n.y,
            n.y * n.z,
            n.x * n.z,
        ) * value
    });
    principal.fold(Sym3::ZERO, |sum, t| sum + t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::tensor::Mat3;

    #[test]
    fn a_solved_system_is_solved_and_a_singular_one_is_told() {
        let a = [0.0, 2.0, 1.0, 1.0, -1.0, 3.0, 4.0, 0.5, -2.0];
        let (mut lost, mut x) = (a, [3.0, 1.0, 5.0]);
        solve(&mut lost, 3, &mut x, 1).unwrap();
        for (row, b) in a.chunks_exact(3).zip([3.0, 1.0, 5.0]) {
            let product: f64 = row.iter().zip(x).map(|(a, x)| a * x).sum();
            assert!((product - b).abs() < 1e-14);
        }
        let mut singular = [1.0, 2.0, 2.0, 4.0];
        assert!(solve(&mut singular, 2, &mut [1.0, 1.0], 1).is_none());
    }

    #[test]
    fn the_logarithm_of_a_turned_stretch_is_the_turned_logarithm() {
        let turn = Mat3::rotation(Vec3::new(0.3, -1.1, 0.7));
        for scale in [1.0, 0.12, 1e-2, 1e-5, 1e-9] {
            let stretch = [0.7 * scale, -0.3 * scale, 0.1 * scale];
            let [a, b, c] = stretch;
            let e = Sym3::diagonal(a, b, c).congruence(turn);
            let [a, b, c] = stretch.map(|v| 0.5 * (2.0 * v).ln_1p());
            let exact = Sym3::diagonal(a, b, c).congruence(turn);
            let off = (half_logarithm(e) - exact).to_pairs();
            assert!(off.iter().all(|d| d.abs() < 1e-15 * scale), "{off:?}");
        }
    }
}
