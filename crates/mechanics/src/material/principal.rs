//! Isotropic functions of the strain, from its principal axes.

use super::logarithmic::Principal;
use super::{MaterialError, Order, Response};
use signorini_geometry::tensor::Sym3;

/// What an isotropic law answers in the principal axes of the strain `E`.
///
/// ```text
/// S = Σ S_i n_i nᵢᵀ,    C_iijj = ∂S_i/∂E_j,    C_ijij = ½ (S_i − S_j)/(E_i − E_j)
/// ```
///
/// The quotient is the law's to give: it knows the one without cancellation, and its limit where values coincide.
///
/// Source: Bhatia, *Matrix Analysis* 1997, theorem V.3.3.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct InAxes {
    /// `S_i`
    pub stress: [f64; 3],
    /// `∂S_i/∂E_j`
    pub normal: [[f64; 3]; 3],
    /// `(S_i − S_j)/(E_i − E_j)` of the pairs 12, 23, 13.
    pub shear: [f64; 3],
}

/// The pairs of axes, in the order of the shears of [`Sym3::PAIRS`].
pub(super) const PAIRS: [(usize, usize); 3] = [(0, 1), (1, 2), (0, 2)];

impl InAxes {
    /// Writes stress and tangent, in the global axes.
    pub fn put(&self, of: &Principal, order: Order, out: &mut Response) {
        let half = self.shear.map(|quotient| 0.5 * quotient);
        put_in_axes(self.stress, &self.normal, half, order, out);
        of.turn_back(order, out);
    }
}

/// Writes stress and tangent in the principal axes: `S_i`, `∂S_i/∂E_j`, `C_ijij`.
pub(super) fn put_in_axes(
    [a, b, c]: [f64; 3],
    normal: &[[f64; 3]; 3],
    shear: [f64; 3],
    order: Order,
    out: &mut Response,
) {
    out.stress = Sym3::diagonal(a, b, c);
    if order == Order::Tangent {
        out.tangent = [[0.0; 6]; 6];
        for (i, (normal, shear)) in normal.iter().zip(shear).enumerate() {
            out.tangent[i][..3].copy_from_slice(normal);
            out.tangent[i + 3][i + 3] = shear;
        }
    }
}

/// `C_i = 1 + 2 E_i`.
///
/// # Errors
/// One is not positive.
pub(super) fn squares(values: &[f64; 3]) -> Result<[f64; 3], MaterialError> {
    let c = values.map(|e| 1.0 + 2.0 * e);
    if c.iter().all(|c| *c > 0.0 && c.is_finite()) {
        return Ok(c);
    }
    let ratio = c[0] * c[1] * c[2];
    Err(MaterialError::Inverted { ratio })
}
