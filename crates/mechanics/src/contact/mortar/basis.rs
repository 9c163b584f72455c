use signorini_geometry::element::MAX_FACET_NODES;

/// A small matrix, of which the first `n` rows and columns are used.
pub(super) type Small = [[f64; MAX_FACET_NODES]; MAX_FACET_NODES];

/// The condition of the scaled mass matrix above which the basis would extrapolate.
const MAX_CONDITION: f64 = 1e6;

/// `S⁻¹` of a mass matrix, computed in the scale of its diagonal; `None` where its condition there exceeds
/// [`MAX_CONDITION`], in the norm of the largest row sum, or where it is not positive definite.
pub(super) fn inverse(s: &Small, n: usize) -> Option<Small> {
    let mut scale = [0.0; MAX_FACET_NODES];
    for (k, scale) in scale[..n].iter_mut().enumerate() {
        *scale = 1.0 / s[k][k].sqrt();
        if !scale.is_finite() || *scale <= 0.0 {
            return None;
        }
    }
    let mut c = *s;
    for (i, row) in c[..n].iter_mut().enumerate() {
        for (v, b) in row[..n].iter_mut().zip(&scale) {
            *v *= scale[i] * b;
        }
    }
    let mut inverse = invert(&c, n)?;
    if largest_row(&c, n) * largest_row(&inverse, n) > MAX_CONDITION {
        return None;
    }
    for (i, row) in inverse[..n].iter_mut().enumerate() {
        for (v, b) in row[..n].iter_mut().zip(&scale) {
            *v *= scale[i] * b;
        }
    }
    Some(inverse)
}

fn largest_row(a: &Small, n: usize) -> f64 {
    let sums = a[..n]
        .iter()
        .map(|row| row[..n].iter().map(|v| v.abs()).sum());
    sums.fold(0.0, f64::max)
}

/// The inverse of a symmetric positive definite matrix, by Cholesky: `L Lᵀ x = e_k`.
fn invert(a: &Small, n: usize) -> Option<Small> {
    let mut l = *a;
    for j in 0..n {
        for i in j..n {
            let before: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            let rest = a[i][j] - before;
            if i > j {
                l[i][j] = rest / l[j][j];
            } else if rest > 0.0 {
                l[j][j] = rest.sqrt();
            } else {
                return None;
            }
        }
    }
    let mut inverse = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
    for (k, x) in inverse[..n].iter_mut().enumerate() {
        x[k] = 1.0;
        for i in 0..n {
            let before: f64 = (0..i).map(|m| l[i][m] * x[m]).sum();
            x[i] = (x[i] - before) / l[i][i];
        }
        for i in (0..n).rev() {
            let after: f64 = (i + 1..n).map(|m| l[m][i] * x[m]).sum();
            x[i] = (x[i] - after) / l[i][i];
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_does_not_notice_the_scale_of_rows() {
        let mut s = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        let size = [1.0, 1e-6, 1e-12, 1e5];
        for i in 0..4 {
            for k in 0..4 {
                let c = if i == k { 1.0 } else { 0.3 };
                s[i][k] = c * size[i] * size[k];
            }
        }
        let inverse = inverse(&s, 4).unwrap();
        for i in 0..4 {
            for k in 0..4 {
                let product: f64 = (0..4).map(|m| s[i][m] * inverse[m][k]).sum();
                let unit = f64::from(u8::from(i == k));
                assert!(
                    (product * size[k] / size[i] - unit).abs() < 1e-14,
                    "{i} {k}"
                );
            }
        }
    }

    #[test]
    fn what_is_nearly_singular_or_indefinite_has_no_inverse() {
        let mut s = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        for (off, exists) in [
            (0.9, true),
            (1.0 - 1e-5, true),
            (1.0 - 1e-7, false),
            (1.1, false),
        ] {
            [s[0][0], s[1][1], s[0][1], s[1][0]] = [1.0, 1.0, off, off];
            assert_eq!(inverse(&s, 2).is_some(), exists, "{off}");
        }
        s[0][0] = 0.0;
        assert_eq!(inverse(&s, 2), None);
    }
}
