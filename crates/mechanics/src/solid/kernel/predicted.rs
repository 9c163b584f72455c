//! The stress that the last Newton correction predicted, for the geometric stiffness of thin bodies.
//!
//! With the strain `E` at the iterate, the correction `δu` that led there and `δH = ∂δu/∂X`, the strain that was solved for
//! was linear in `δu`: `E_lin = E − Q`. The geometric stiffness of (E2) takes
//!
//! ```text
//! S_lin = S(E) − C(E):Q        Q = ½ δHᵀ δH                                                      (E36)
//! ```
//!
//! in place of `S`; the forces stay. Where bodies are thin, `Q` strains their middle surface, which is far stiffer than
//! their bending: `S` is then wrong by orders of magnitude until the iteration has converged, and `S_lin` is not. For a
//! law that is linear in `E`, (E36) is the stress of the linearized strains exactly. At a solution `δu = 0`, and the
//! stiffness is the usual one.
//!
//! Source: Magisano, Leonetti and Garcea, IJNME 112, 2017 (the mixed integration point method for displacement elements).

use super::gradient::displacement_gradient;
use crate::material::Response;
use signorini_geometry::tensor::Sym3;

/// `S_lin` (E36); `S` where there is no correction.
#[inline]
pub(super) fn predicted<const NN: usize, const ND: usize, const NG: usize>(
    correction: &[f64],
    gradient: &[[f64; NG]; NN],
    response: &Response,
) -> Sym3 {
    if correction.is_empty() {
        return response.stress;
    }
    let change = displacement_gradient::<NN, ND, NG>(gradient, correction);
    let mut doubled = (Sym3::gram(change) * 0.5).to_pairs();
    doubled[3..].iter_mut().for_each(|q| *q *= 2.0);
    let along = response.tangent.map(|row| {
        let products = row.iter().zip(&doubled).map(|(c, q)| c * q);
        products.sum::<f64>()
    });
    response.stress - Sym3::from_pairs(along)
}
