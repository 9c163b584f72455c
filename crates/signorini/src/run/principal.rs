//! Principal values of a symmetric tensor.

use signorini_geometry::tensor::Sym3;

/// The principal values, smallest first, by Jacobi's rotations.
///
/// Values that are not finite give values that are not.
pub fn principal(tensor: &Sym3) -> [f64; 3] {
    let mut a = [
        [tensor.xx(), tensor.xy(), tensor.xz()],
        [tensor.xy(), tensor.yy(), tensor.yz()],
        [tensor.xz(), tensor.yz(), tensor.zz()],
    ];
    // four sweeps reach round-off from any start, the further ones cost nothing
    for _ in 0..8 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, p, q);
        }
    }
    let mut values = [a[0][0], a[1][1], a[2][2]];
    values.sort_by(f64::total_cmp);
    values
}

/// The rotation in the plane `p, q` that makes the entry there vanish.
fn rotate(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
    let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    let r = 3 - p - q;
    a[p][p] -= t * a[p][q];
    a[q][q] += t * a[p][q];
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    let (x, y) = (a[r][p], a[r][q]);
    a[r][p] = c * x - s * y;
    a[r][q] = s * x + c * y;
    a[p][r] = a[r][p];
    a[q][r] = a[r][q];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagonal_tensors_are_sorted() {
        assert_eq!(principal(&Sym3::diagonal(3.0, -1.0, 2.0)), [-1.0, 2.0, 3.0]);
        assert_eq!(principal(&Sym3::ZERO), [0.0; 3]);
    }

    #[test]
    fn the_invariants_are_those_of_the_tensor() {
        let mut seed = 7u64;
        let mut next = || {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / f64::from(1u32 << 31) - 0.5
        };
        for _ in 0..1000 {
            let s = Sym3::new(next(), next(), next(), next(), next(), next());
            let [a, b, c] = principal(&s);
            assert!(a <= b && b <= c);
            assert!((a + b + c - s.trace()).abs() < 1e-14);
            assert!((a * b * c - s.determinant()).abs() < 1e-14);
            assert!((a * a + b * b + c * c - s.double_dot(s)).abs() < 1e-14);
        }
    }

    #[test]
    fn pure_shear_has_opposite_values() {
        let s = Sym3::new(0.0, 0.0, 0.0, 0.0, 0.0, 2.0);
        for (got, wanted) in principal(&s).iter().zip([-2.0, 0.0, 2.0]) {
            assert!((got - wanted).abs() < 1e-15);
        }
    }
}
