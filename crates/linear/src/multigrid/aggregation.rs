//! Aggregates of nodes, and what they move by.

use super::blocks::Blocks;
use crate::lists::Lists;
use crate::sparsity::NONE;

/// Modes of a rigid body in space.
pub(super) const MODES: usize = 6;
/// Part of a mode that must remain after those before it.
const INDEPENDENT: f64 = 1e-6;

/// Which aggregate each row belongs to.
pub(super) struct Aggregates {
    pub of: Vec<u32>,
    pub count: usize,
}

impl Aggregates {
    /// Neighbourhoods that do not touch; nodes between them join the one with the strongest coupling.
    ///
    /// Source: Vaněk, Mandel, Brezina, *Computing* 56 (1996) 179–196, algorithm 5.1 without a threshold.
    pub fn new<const N: usize>(matrix: &Blocks<N, N>) -> Self {
        let nrow = matrix.nrow();
        let mut of = vec![NONE; nrow];
        let mut count = 0;
        let columns = |row: usize| &matrix.column[matrix.range(row)];
        for row in 0..nrow {
            let near = columns(row);
            if near.iter().all(|&c| of[c as usize] == NONE) {
                for &c in near {
                    of[c as usize] = count;
                }
                of[row] = count;
                count += 1;
            }
        }
        let first = of.clone();
        for (row, of) in of.iter_mut().enumerate().filter(|(_, of)| **of == NONE) {
            let strength = |at: usize| -> f64 {
                let squares = matrix.value[at].iter().flatten().map(|v| v * v);
                squares.sum()
            };
            let mut best = (0.0, NONE);
            for at in matrix.range(row) {
                let to = first[matrix.column[at] as usize];
                let strength = strength(at);
                if to != NONE && strength > best.0 {
                    best = (strength, to);
                }
            }
            *of = best.1;
        }
        for row in 0..nrow {
            if of[row] == NONE {
                for &c in columns(row) {
                    let other = &mut of[c as usize];
                    if *other == NONE {
                        *other = count;
                    }
                }
                of[row] = count;
                count += 1;
            }
        }
        Self {
            of,
            count: count as usize,
        }
    }

    /// The motions of the aggregates: orthonormal on each, together with the modes by them. A mode that is none on an
    /// aggregate, since its nodes are held, are few, or lie on a line, is a zero column.
    pub fn motions<const N: usize>(
        &self,
        modes: &[[[f64; MODES]; N]],
    ) -> (Blocks<N, MODES>, Vec<[[f64; MODES]; MODES]>) {
        let members = Lists::new(self.count, || {
            (0..).zip(&self.of).map(|(row, &k)| (k as usize, row))
        });
        let mut value = modes.to_vec();
        let mut coarse = Vec::with_capacity(self.count);
        for k in 0..self.count {
            coarse.push(orthonormalize(members.of(k), &mut value));
        }
        let motions = Blocks {
            ncolumn: self.count,
            start: (0..=self.of.len()).collect(),
            column: self.of.clone(),
            value,
        };
        (motions, coarse)
    }
}

/// `B = Q R` over some rows, by Gram and Schmidt twice; `Q` takes the place of `B`.
fn orthonormalize<const N: usize>(
    members: &[u32],
    b: &mut [[[f64; MODES]; N]],
) -> [[f64; MODES]; MODES] {
    let mut r = [[0.0; MODES]; MODES];
    let dot = |b: &[[[f64; MODES]; N]], i: usize, j: usize| -> f64 {
        let rows = members.iter().flat_map(|&m| &b[m as usize]);
        rows.map(|row| row[i] * row[j]).sum()
    };
    for j in 0..MODES {
        let whole = dot(b, j, j).sqrt();
        for _ in 0..2 {
            for i in 0..j {
                let part = dot(b, i, j);
                r[i][j] += part;
                for &m in members {
                    for row in &mut b[m as usize] {
                        row[j] -= part * row[i];
                    }
                }
            }
        }
        let left = dot(b, j, j).sqrt();
        let scale = if left > INDEPENDENT * whole && left > 0.0 {
            r[j][j] = left;
            left.recip()
        } else {
            0.0
        };
        for &m in members {
            for row in &mut b[m as usize] {
                row[j] *= scale;
            }
        }
    }
    r
}
