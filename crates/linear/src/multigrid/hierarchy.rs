//! A hierarchy of levels, from all nodes of a structure to a few motions.

use super::aggregation::MODES;
use super::blocks::Blocks;
use super::fine::Corners;
use super::level::Level;
use super::springs::{self, Rows};
use std::ops::Range;

/// Unknowns of the coarsest level, at most, unless it stops becoming coarser.
const COARSEST: usize = 600;
/// Levels, at most.
const LEVELS: usize = 12;
/// Unknowns of the last level above which there is no hierarchy.
const TOO_MANY: usize = 3000;
/// A level has at most this part of the rows of the finer one, or there is none.
const COARSER: f64 = 0.7;

/// Levels with the solution on the coarsest one, of `N` unknowns at each node.
pub(super) struct Hierarchy<const N: usize> {
    quadratic: Option<Quadratic<N>>,
    fine: Level<N>,
    coarse: Vec<Level<MODES>>,
    last: Dense,
    /// The matrix of the coarsest level without springs.
    elastic: Blocks<MODES, MODES>,
    /// Right sides and solutions of all levels but the finest.
    vectors: Vec<[Vec<[f32; MODES]>; 2]>,
}

/// The level of all nodes of quadratic elements, above that of their corners, with the right side and the solution of that.
struct Quadratic<const N: usize> {
    level: Level<N, N>,
    b: Vec<[f32; N]>,
    x: Vec<[f32; N]>,
}

impl<const N: usize> Hierarchy<N> {
    /// The hierarchy of a matrix; `None` where it is not positive definite.
    ///
    /// # Shapes
    /// `modes`: motions of a rigid body at each row. `parts`: see [`super::incomplete::Incomplete`]. `corners`: where rows are
    /// those of quadratic elements.
    pub fn new(
        matrix: &Blocks<N, N>,
        modes: &[[[f64; MODES]; N]],
        parts: &[Range<usize>],
        corners: Option<&Corners<N>>,
    ) -> Option<Self> {
        let (quadratic, (fine, (mut matrix, mut modes))) = match corners {
            None => (None, Level::new(matrix, modes, parts)?),
            Some(corners) => {
                let (level, linear) = Level::above(matrix, &corners.prolong, parts)?;
                let modes: Vec<_> = corners.row.iter().map(|&r| modes[r as usize]).collect();
                let quadratic = Quadratic {
                    level,
                    b: vec![[0.0; N]; modes.len()],
                    x: vec![[0.0; N]; modes.len()],
                };
                let next = Level::new(&linear, &modes, &corners.parts)?;
                (Some(quadratic), next)
            }
        };
        let (mut coarse, mut last): (Vec<Level<MODES>>, _) = (Vec::new(), Dense::default());
        let mut vectors = Vec::new();
        loop {
            let nrow = matrix.nrow();
            vectors.push([vec![[0.0; MODES]; nrow], vec![[0.0; MODES]; nrow]]);
            if nrow * MODES <= COARSEST || coarse.len() == LEVELS {
                break;
            }
            let (level, (next, next_modes)) = Level::new(&matrix, &modes, &[])?;
            if next.nrow() as f64 > COARSER * nrow as f64 {
                break;
            }
            coarse.push(level);
            (matrix, modes) = (next, next_modes);
        }
        if matrix.nrow() * MODES > TOO_MANY {
            return None;
        }
        last.factorize(&matrix);
        Some(Self {
            quadratic,
            fine,
            coarse,
            last,
            elastic: matrix,
            vectors,
        })
    }

    /// The number of levels, with the last one.
    pub fn nlevel(&self) -> usize {
        self.coarse.len() + 2 + usize::from(self.quadratic.is_some())
    }

    /// Takes springs with these rows in place of those it has.
    pub fn hold(&mut self, rows: Option<Rows<N>>) {
        if rows.is_none() && !self.fine.is_held() {
            return;
        }
        let rows = match &mut self.quadratic {
            Some(quadratic) => quadratic.level.hold(rows),
            None => rows,
        };
        let mut rows = self.fine.hold(rows);
        for level in &mut self.coarse {
            rows = level.hold(rows);
        }
        match rows {
            Some(rows) => {
                let held = self.elastic.plus(&springs::stiffness(&rows));
                self.last.factorize(&held);
            }
            None => self.last.factorize(&self.elastic),
        }
    }

    /// One V-cycle from zero.
    pub fn cycle(&mut self, b: &[[f32; N]], x: &mut [[f32; N]]) {
        let Self {
            quadratic,
            fine,
            coarse,
            last,
            vectors,
            ..
        } = self;
        let mut linear = |b: &[[f32; N]], x: &mut [[f32; N]]| {
            if let [[coarse_b, coarse_x], rest @ ..] = vectors.as_mut_slice() {
                fine.cycle(b, x, coarse_b, coarse_x, |b, x| {
                    descend(coarse, last, rest, b, x);
                });
            }
        };
        match quadratic {
            Some(of) => of.level.cycle(b, x, &mut of.b, &mut of.x, linear),
            None => linear(b, x),
        }
    }
}

fn descend(
    levels: &mut [Level<MODES>],
    last: &mut Dense,
    vectors: &mut [[Vec<[f32; MODES]>; 2]],
    b: &[[f32; MODES]],
    x: &mut [[f32; MODES]],
) {
    match (levels, vectors) {
        ([level, levels @ ..], [[coarse_b, coarse_x], vectors @ ..]) => {
            level.cycle(b, x, coarse_b, coarse_x, |b, x| {
                descend(levels, last, vectors, b, x);
            });
        }
        _ => last.solve(b, x),
    }
}

/// A small matrix with its factor; motions that cost nothing stay zero.
#[derive(Default)]
struct Dense {
    y: Vec<f64>,
    /// L D Lᵀ, row-major, the unit diagonal of L not stored.
    factor: Vec<f64>,
    n: usize,
}

/// Sums of a product that do not wait for one another.
const SUMS: usize = 16;

/// The product of two vectors of the same length.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<SUMS>();
    let (b, b_rest) = b.as_chunks::<SUMS>();
    let mut sums = [0.0; SUMS];
    for (a, b) in a.iter().zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest = a_rest.iter().zip(b_rest).map(|(a, b)| a * b);
    sums.into_iter().chain(rest).sum()
}

/// A pivot that is nothing compared with the largest.
const FREE: f64 = 1e-12;

impl Dense {
    fn factorize(&mut self, matrix: &Blocks<MODES, MODES>) {
        let n = matrix.nrow() * MODES;
        self.n = n;
        let factor = &mut self.factor;
        factor.clear();
        factor.resize(n * n, 0.0);
        for row in 0..matrix.nrow() {
            for (column, block) in matrix.row(row) {
                for (i, line) in block.iter().enumerate() {
                    let at = (row * MODES + i) * n + column * MODES;
                    factor[at..at + MODES].copy_from_slice(line);
                }
            }
        }
        let most = (0..n).fold(0.0f64, |m, i| m.max(factor[i * n + i]));
        let mut scaled = vec![0.0; n];
        for i in 0..n {
            let (above, rest) = factor.split_at_mut(i * n);
            let own = &mut rest[..n];
            let mut pivot = own[i];
            for j in 0..i {
                let known = dot(&above[j * n..j * n + j], &scaled[..j]);
                // L_ij D_j, then L_ij
                scaled[j] = own[j] - known;
                let d = above[j * n + j];
                own[j] = if d == 0.0 { 0.0 } else { scaled[j] / d };
                if d == 0.0 {
                    scaled[j] = 0.0;
                }
                pivot -= own[j] * scaled[j];
            }
            own[i] = if pivot > FREE * most { pivot } else { 0.0 };
        }
    }

    fn solve(&mut self, b: &[[f32; MODES]], x: &mut [[f32; MODES]]) {
        let (n, y) = (self.n, &mut self.y);
        y.clear();
        y.extend(b.iter().flatten().map(|&b| f64::from(b)));
        for i in 0..n {
            y[i] -= dot(&self.factor[i * n..i * n + i], &y[..i]);
        }
        for (y, d) in y.iter_mut().zip(self.factor.iter().step_by(n + 1)) {
            *y = if *d == 0.0 { 0.0 } else { *y / d };
        }
        for i in (0..n).rev() {
            let own = y[i];
            let row = &self.factor[i * n..i * n + i];
            for (y, l) in y.iter_mut().zip(row) {
                *y -= l * own;
            }
        }
        for (x, y) in x.iter_mut().flatten().zip(y) {
            *x = *y as f32;
        }
    }
}
