//! What a point adds to forces and stiffness.

use super::element::Output;
use super::gradient::row;
use signorini_geometry::tensor::{Mat3, Sym3};

/// The place of component `(i, j)` of a symmetric tensor in [`Sym3::PAIRS`].
pub(super) const PAIR: [[usize; 3]; 3] = {
    let mut place = [[0; 3]; 3];
    let mut k = 0;
    while k < 6 {
        let (i, j) = Sym3::PAIRS[k];
        place[i][j] = k;
        place[j][i] = k;
        k += 1;
    }
    place
};

/// What a symmetric tensor does at each node: `F s N_I,X`, the transpose of (E3).
#[inline]
pub(super) fn contract<const NN: usize, const ND: usize, const NG: usize>(
    gradient: &[[f64; NG]; NN],
    f: &Mat3,
    s: &Sym3,
) -> [[f64; ND]; NN] {
    let p = *f * s.to_mat3();
    let mut out = [[0.0; ND]; NN];
    for (out, g) in out.iter_mut().zip(gradient) {
        for i in 0..ND {
            for a in 0..NG {
                if let Some(row) = row::<ND, NG>(i, a) {
                    out[i] += p.rows[row][a] * g[a];
                }
            }
        }
    }
    out
}

/// Adds node by node.
#[inline]
pub(super) fn add_force<const NN: usize, const ND: usize>(
    force: &mut [f64],
    weight: f64,
    of_nodes: &[[f64; ND]; NN],
) {
    for (to, value) in force.iter_mut().zip(of_nodes.as_flattened()) {
        *to += weight * value;
    }
}

/// Adds a change of forces with temperature, node by node, against the temperatures of the nodes, which have these shape functions;
/// of the rows, as many as there is room for.
#[inline]
pub(super) fn add_thermal(thermal: &mut [f64], weight: f64, forces: &[f64], shape: &[f64]) {
    let rows = thermal.chunks_exact_mut(shape.len().max(1));
    for (row, force) in rows.zip(forces) {
        let force = weight * force;
        row.iter_mut()
            .zip(shape)
            .for_each(|(to, n)| *to += force * n);
    }
}

/// Adds `w N_I,a A_iakb N_J,b` with `A_iakb = F_ir C_rasb F_ks + δ_ik S_ab` (E2), the second part only at finite strain. The left and
/// the right `F` need not be the same.
/// Where it is `symmetric`, only blocks on and above the diagonal. Of the rows, as many as there is room for.
#[inline]
pub(super) fn add_stiffness<const NN: usize, const ND: usize, const NG: usize>(
    gradient: &[[f64; NG]; NN],
    f: Option<[&Mat3; 2]>,
    weight: f64,
    stress: &Sym3,
    tangent: &[[f64; 6]; 6],
    symmetric: bool,
    out: &mut Output<'_>,
) {
    let moduli = moduli::<ND, NG>(f, weight, stress, tangent);
    // A_iakb N_J,b, a row over the columns of the stiffness for each i and a
    let mut columns = [[[[0.0; ND]; NN]; NG]; ND];
    for i in 0..ND {
        for a in 0..NG {
            for (to, g) in columns[i][a].iter_mut().zip(gradient) {
                for k in 0..ND {
                    let mut sum = 0.0;
                    for b in 0..NG {
                        sum += moduli[i][a][k][b] * g[b];
                    }
                    to[k] = sum;
                }
            }
        }
    }
    // two nodes at a time share the columns that are read
    let n = NN * ND;
    let pairs = out.stiffness.chunks_mut(2 * n * ND).enumerate();
    for (pair, rows) in pairs {
        let node = 2 * pair;
        let first = if symmetric { node * ND } else { 0 };
        let (upper, lower) = rows.split_at_mut(n * ND);
        for i in 0..ND {
            let columns = columns[i].each_ref().map(|c| &c.as_flattened()[first..]);
            let upper = &mut upper[i * n + first..(i + 1) * n];
            let g = &gradient[node];
            match gradient.get(node + 1).filter(|_| !lower.is_empty()) {
                Some(h) => add_two(upper, &mut lower[i * n + first..(i + 1) * n], g, h, columns),
                None => add_one(upper, g, columns),
            }
        }
    }
}

/// Adds `g_a columns_a` to a row.
#[inline]
fn add_one<const NG: usize>(to: &mut [f64], g: &[f64; NG], columns: [&[f64]; NG]) {
    let columns = columns.map(|c| &c[..to.len()]);
    for c in 0..to.len() {
        let mut sum = 0.0;
        for a in 0..NG {
            sum += g[a] * columns[a][c];
        }
        to[c] += sum;
    }
}

/// Adds `g_a columns_a` to one row and `h_a columns_a` to another.
#[inline]
fn add_two<const NG: usize>(
    to: &mut [f64],
    other: &mut [f64],
    g: &[f64; NG],
    h: &[f64; NG],
    columns: [&[f64]; NG],
) {
    let columns = columns.map(|c| &c[..to.len()]);
    let other = &mut other[..to.len()];
    for c in 0..to.len() {
        let (mut one, mut two) = (0.0, 0.0);
        for a in 0..NG {
            one += g[a] * columns[a][c];
            two += h[a] * columns[a][c];
        }
        to[c] += one;
        other[c] += two;
    }
}

type Moduli<const ND: usize, const NG: usize> = [[[[f64; NG]; ND]; NG]; ND];

/// `w A_iakb`: the derivative of the first Piola–Kirchhoff stress with respect to the displacement gradient.
#[inline]
fn moduli<const ND: usize, const NG: usize>(
    f: Option<[&Mat3; 2]>,
    weight: f64,
    stress: &Sym3,
    tangent: &[[f64; 6]; 6],
) -> Moduli<ND, NG> {
    let mut out = [[[[0.0; NG]; ND]; NG]; ND];
    let s = stress.to_mat3();
    for i in 0..ND {
        for a in 0..NG {
            let Some(row_i) = row::<ND, NG>(i, a) else {
                continue;
            };
            // F_ir C_ra··
            let mut half = [0.0; 6];
            match f {
                Some([f, _]) => {
                    for r in 0..3 {
                        let factor = weight * f.rows[row_i][r];
                        for q in 0..6 {
                            half[q] += factor * tangent[PAIR[r][a]][q];
                        }
                    }
                }
                None => half = tangent[PAIR[row_i][a]].map(|c| weight * c),
            }
            for k in 0..ND {
                for b in 0..NG {
                    let Some(row_k) = row::<ND, NG>(k, b) else {
                        continue;
                    };
                    out[i][a][k][b] = match f {
                        Some([_, f]) => {
                            let mut sum = 0.0;
                            for r in 0..3 {
                                sum += half[PAIR[r][b]] * f.rows[row_k][r];
                            }
                            if row_i == row_k {
                                sum += weight * s.rows[a][b];
                            }
                            sum
                        }
                        None => half[PAIR[row_k][b]],
                    };
                }
            }
        }
    }
    out
}

/// Copies the blocks above the diagonal to those below.
pub(in crate::solid) fn mirror(stiffness: &mut [f64], n: usize, ndim: usize) {
    for row in 0..n {
        for column in 0..row / ndim * ndim {
            stiffness[row * n + column] = stiffness[column * n + row];
        }
    }
}
