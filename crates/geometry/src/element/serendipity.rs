//! Elements with mid nodes on their edges, made from the linear element with the same corners.
//!
//! ```text
//! N_c = L_c − ½ Σ M_e   over the edges e that meet in the corner c     (E1)
//! M_e = 4 L_a L_b       on the edge from a to b of a simplex           (E2)
//! ```
//!
//! `L` are the shape functions of the linear element and `M` those of the mid nodes, which follow the corners in the
//! order of the edges. (E1) holds for simplices, quadrilaterals, hexahedra and wedges alike, and for derivatives.

use super::Element;
use crate::tensor::{Sym3, Vec3};
use std::ops::{Mul, Sub};

/// (E1): `n` holds `L_c`, then `M_e`, and then `N_c`, `M_e`.
pub(super) fn correct_corners<T>(edges: &[[usize; 2]], n: &mut [T])
where
    T: Copy + Sub<Output = T> + Mul<f64, Output = T>,
{
    let (corners, mids) = n.split_at_mut(n.len() - edges.len());
    for (&[a, b], &m) in edges.iter().zip(mids.iter()) {
        corners[a] = corners[a] - m * 0.5;
        corners[b] = corners[b] - m * 0.5;
    }
}

/// A simplex with mid nodes, from the linear one.
pub(super) struct Simplex(pub(super) Element);

impl Simplex {
    pub(super) fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        let (l, m) = n.split_at_mut(self.0.nnode());
        self.0.shape(xi, l);
        for (m, &[a, b]) in m.iter_mut().zip(self.0.edges()) {
            *m = 4.0 * l[a] * l[b]; // (E2)
        }
        correct_corners(self.0.edges(), n);
    }

    pub(super) fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        let mut l = [0.0; 4];
        let (dl, dm) = dn.split_at_mut(self.0.nnode());
        self.0.shape(xi, &mut l[..dl.len()]);
        self.0.dshape(xi, dl);
        for (dm, &[a, b]) in dm.iter_mut().zip(self.0.edges()) {
            *dm = (dl[a] * l[b] + dl[b] * l[a]) * 4.0;
        }
        correct_corners(self.0.edges(), dn);
    }

    pub(super) fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        let mut dl = [Vec3::ZERO; 4];
        let (ddl, ddm) = ddn.split_at_mut(self.0.nnode());
        self.0.dshape(xi, &mut dl[..ddl.len()]);
        ddl.fill(Sym3::ZERO);
        for (ddm, &[a, b]) in ddm.iter_mut().zip(self.0.edges()) {
            *ddm = dyad(dl[a], dl[b]) * 4.0;
        }
        correct_corners(self.0.edges(), ddn);
    }
}

/// `a bᵀ + b aᵀ`.
pub(super) fn dyad(a: Vec3, b: Vec3) -> Sym3 {
    let pair = |i: usize, j: usize| a[i] * b[j] + b[i] * a[j];
    Sym3::from_pairs(Sym3::PAIRS.map(|(i, j)| pair(i, j)))
}
