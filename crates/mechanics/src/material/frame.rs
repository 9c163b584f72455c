use super::{Order, Response};
use signorini_geometry::tensor::{Mat3, Sym3};

/// Axes other than the global ones, row by row, orthonormal.
///
/// With `R` the matrix of the axes: `E' = R E Rᵀ`, `S = Rᵀ S' R`, and over doubled shears `γ' = B γ`, `C = Bᵀ C' B` with
/// `B_pq = w_p ½ (R_ia R_jb + R_ib R_ja)`, where `p = (i, j)`, `q = (a, b)`, `w` is 1 for normal strains and 2 for shears.
/// The way back, [`Self::turn_back`], holds for any matrix in the place of `R`: a congruence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub axes: Mat3,
}

impl Frame {
    /// A tensor in these axes.
    pub fn enter(&self, global: Sym3) -> Sym3 {
        global.congruence(self.axes)
    }

    /// A tensor given in these axes in the global ones.
    pub fn leave(&self, local: Sym3) -> Sym3 {
        local.congruence(self.axes.transpose())
    }

    /// Turns a response in these axes to the global ones.
    pub fn turn_back(&self, order: Order, out: &mut Response) {
        out.stress = self.leave(out.stress);
        if order == Order::Stress {
            return;
        }
        out.thermal = self.leave(out.thermal);
        let r = &self.axes.rows;
        let mut bond = [[0.0; 6]; 6];
        for (row, (i, j)) in bond.iter_mut().zip(Sym3::PAIRS) {
            let weight = if i == j { 0.5 } else { 1.0 };
            for (value, (a, b)) in row.iter_mut().zip(Sym3::PAIRS) {
                *value = weight * (r[i][a] * r[j][b] + r[i][b] * r[j][a]);
            }
        }
        let mut half = [[0.0; 6]; 6]; // C' B
        for (h, c) in half.iter_mut().zip(&out.tangent) {
            for (c, b) in c.iter().zip(&bond) {
                for (h, b) in h.iter_mut().zip(b) {
                    *h += c * b;
                }
            }
        }
        out.tangent = [[0.0; 6]; 6];
        for (b, h) in bond.iter().zip(&half) {
            for (row, b) in out.tangent.iter_mut().zip(b) {
                for (value, h) in row.iter_mut().zip(h) {
                    *value += b * h;
                }
            }
        }
    }
}
