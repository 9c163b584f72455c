//! Factors along one axis and their products: the shape functions of lines, quadrilaterals and hexahedra.
//!
//! ```text
//! linear       (1 + a s)/2     a = ±1            (E1)
//! bubble       1 − s²          a = 0             (E2)
//! quadratic    s (s + a)/2     a = ±1; (E2)      (E3)
//! serendipity  (E1)            a = ±1; (E2)      (E4)
//! ```
//!
//! A factor belongs to the coordinate `a` of a node along the axis. Products of (E3) are the Lagrange elements. Products
//! of (E4) are the functions of the mid nodes of a serendipity element; its corners follow in [`super::serendipity`].

use crate::tensor::{Sym3, Vec3};

/// A function of one coordinate: its value, slope and second derivative.
type Factor = [f64; 3];

/// (E1).
pub(super) fn linear(a: f64, s: f64) -> Factor {
    [0.5 * (1.0 + a * s), 0.5 * a, 0.0]
}

/// (E2).
pub(super) fn bubble(s: f64) -> Factor {
    [1.0 - s * s, -2.0 * s, -2.0]
}

/// (E3).
pub(super) fn quadratic(a: f64, s: f64) -> Factor {
    if a == 0.0 {
        bubble(s)
    } else {
        [0.5 * s * (s + a), s + 0.5 * a, 1.0]
    }
}

/// (E4).
pub(super) fn serendipity(a: f64, s: f64) -> Factor {
    if a == 0.0 { bubble(s) } else { linear(a, s) }
}

/// The products of factors over the first `DIM` axes, one for each node.
pub(super) struct Product<const DIM: usize> {
    /// The factor that belongs to a node's coordinate.
    pub(super) factor: fn(f64, f64) -> Factor,
    /// The nodes.
    pub(super) nodes: &'static [Vec3],
}

impl<const DIM: usize> Product<DIM> {
    fn factors(&self, node: &Vec3, xi: &Vec3) -> [Factor; 3] {
        let mut factors = [[1.0, 0.0, 0.0]; 3];
        for (axis, f) in factors.iter_mut().take(DIM).enumerate() {
            *f = (self.factor)(node[axis], xi[axis]);
        }
        factors
    }

    pub(super) fn shape(&self, xi: &Vec3, n: &mut [f64]) {
        for (n, a) in n.iter_mut().zip(self.nodes) {
            let [x, y, z] = self.factors(a, xi);
            *n = x[0] * y[0] * z[0];
        }
    }

    pub(super) fn dshape(&self, xi: &Vec3, dn: &mut [Vec3]) {
        for (dn, a) in dn.iter_mut().zip(self.nodes) {
            let [x, y, z] = self.factors(a, xi);
            *dn = Vec3::new(x[1] * y[0] * z[0], x[0] * y[1] * z[0], x[0] * y[0] * z[1]);
        }
    }

    pub(super) fn ddshape(&self, xi: &Vec3, ddn: &mut [Sym3]) {
        for (ddn, a) in ddn.iter_mut().zip(self.nodes) {
            let [x, y, z] = self.factors(a, xi);
            *ddn = Sym3::new(
                x[2] * y[0] * z[0],
                x[0] * y[2] * z[0],
                x[0] * y[0] * z[2],
                x[1] * y[1] * z[0],
                x[0] * y[1] * z[1],
                x[1] * y[0] * z[1],
            );
        }
    }
}
