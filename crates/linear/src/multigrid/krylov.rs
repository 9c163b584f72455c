//! Iterations with a preconditioner: conjugate gradients, and generalized minimal residuals.

use crate::error::LinearError;
use crate::norm::largest;
use rayon::prelude::*;

/// Vectors of the flexible iteration before it starts again.
const RESTART: usize = 50;

/// The largest entry of a residual is examined once the estimate from the norm is below this multiple of the tolerance.
const NEARLY: f64 = 2.0;

/// After so many iterations it is foreseen how many it will be in all.
const PATIENCE: usize = 60;

/// Whether so many iterations will not be enough, if the residual falls on as it has: after [`PATIENCE`] of them it has this
/// size, over that at the start, and has to have that of `goal`.
fn is_hopeless(size: f64, goal: f64, most: usize) -> bool {
    let [now, wanted] = [size, goal].map(|v| -v.max(f64::MIN_POSITIVE).ln());
    PATIENCE as f64 * wanted > most as f64 * now.max(0.0)
}

/// What the iterations do with vectors.
pub(super) trait Operators {
    /// `y = A x`
    fn apply(&mut self, x: &[f64], y: &mut [f64]);

    /// `z = M⁻¹ r`
    ///
    /// # Errors
    /// Those of solvers in it.
    fn precondition(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), LinearError>;

    /// What all ranks have, combined in their order, where vectors are shared out among them; else one's own.
    fn together(&mut self, own: f64, combine: fn(f64, f64) -> f64) -> f64;
}

/// The larger number; NaN where one of them is.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// The residual is small, by the iteration's own account.
    Small,
    /// Too many iterations, or too slow.
    Slow,
    /// The matrix or the preconditioner is not positive definite.
    Indefinite,
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stop {
    /// At a residual whose largest entry is not above this.
    Largest(f64),
    /// At this part of the error, in the norm of the energy, or of the residual where there is none; or at a residual
    /// whose largest entry is not above `enough`.
    Part { part: f64, enough: f64 },
}

impl Stop {
    /// The largest entry of a residual that may stay.
    const fn largest(self) -> f64 {
        match self {
            Self::Largest(goal) => goal,
            Self::Part { enough, .. } => enough,
        }
    }

    /// The part of the error that may stay.
    const fn part(self) -> Option<f64> {
        match self {
            Self::Largest(_) => None,
            Self::Part { part, .. } => Some(part),
        }
    }
}

/// Entries handled by one task; sums of tasks are added up in their order.
const CHUNK: usize = 16_384;

/// The inner product of two vectors.
fn dot(of: &mut impl Operators, a: &[f64], b: &[f64]) -> f64 {
    let parts: Vec<f64> = a
        .par_chunks(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a * b).sum())
        .collect();
    of.together(parts.iter().sum(), |a, b| a + b)
}

/// The largest entry of a vector, without its sign.
fn largest_of(of: &mut impl Operators, vector: &[f64]) -> f64 {
    of.together(largest(vector), larger)
}

/// `to += factor x`
fn add(factor: f64, x: &[f64], to: &mut [f64]) {
    let chunks = to.par_chunks_mut(CHUNK).zip(x.par_chunks(CHUNK));
    chunks.for_each(|(to, x)| {
        for (to, x) in to.iter_mut().zip(x) {
            *to += factor * x;
        }
    });
}

/// The residual of minimal residuals, from the last entry of the right side turned back.
fn residual_of(basis: &[Vec<f64>], turns: &[(f64, f64)], last: f64, r: &mut [f64]) {
    r.fill(0.0);
    let mut entry = last;
    for (k, &(c, s)) in turns.iter().enumerate().rev() {
        if let Some(v) = basis.get(k + 1) {
            add(c * entry, v, r);
        }
        entry *= -s;
    }
    if let Some(v) = basis.first() {
        add(entry, v, r);
    }
}

/// `x` such that `stop` is reached, from the residual `r` of the `x` at hand, which is used up.
/// Returns the number of applications of the preconditioner.
///
/// Source: Hestenes, Stiefel, *J. Res. Nat. Bur. Standards* 49 (1952) 409–436.
///
/// # Errors
/// Those of the preconditioner.
pub(super) fn conjugate_gradients(
    of: &mut impl Operators,
    r: &mut [f64],
    x: &mut [f64],
    stop: Stop,
    most: usize,
) -> Result<(End, usize), LinearError> {
    let n = r.len();
    let (mut z, mut p, mut q) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let (mut before, mut first) = (0.0, None);
    let largest_first = largest_of(of, r);
    for iteration in 0..most {
        if largest_of(of, r) <= stop.largest() {
            return Ok((End::Small, iteration));
        }
        of.precondition(r, &mut z)?;
        let product = dot(of, r, &z);
        if product.is_nan() || product <= 0.0 {
            return Ok((End::Indefinite, iteration + 1));
        }
        // r·M⁻¹r is the square of the energy of the error, about
        let start: f64 = *first.get_or_insert(product);
        if let Stop::Part { part, .. } = stop
            && product <= part * part * start
        {
            return Ok((End::Small, iteration + 1));
        }
        if iteration == PATIENCE {
            let of_largest = (
                largest_of(of, r) / largest_first,
                stop.largest() / largest_first,
            );
            let of_energy = stop.part().map(|part| ((product / start).sqrt(), part));
            let ways = [Some(of_largest), of_energy];
            let is_hopeless = |(size, goal)| is_hopeless(size, goal, most);
            if ways.into_iter().flatten().all(is_hopeless) {
                return Ok((End::Slow, iteration));
            }
        }
        let beta = if iteration == 0 {
            0.0
        } else {
            product / before
        };
        before = product;
        for (p, z) in p.iter_mut().zip(&z) {
            *p = z + beta * *p;
        }
        of.apply(&p, &mut q);
        let curvature = dot(of, &p, &q);
        if curvature.is_nan() || curvature <= 0.0 {
            return Ok((End::Indefinite, iteration + 1));
        }
        let alpha = product / curvature;
        add(alpha, &p, x);
        add(-alpha, &q, r);
    }
    Ok((End::Slow, most))
}

/// Turns the last column of a Hessenberg matrix by the rotations before it and by one of its own, which makes it a column
/// of a triangle and turns the right side, too.
fn rotate(column: &mut [f64], turns: &mut Vec<(f64, f64)>, right: &mut Vec<f64>) {
    let k = turns.len();
    for (i, &(c, s)) in turns.iter().enumerate() {
        let (a, b) = (column[i], column[i + 1]);
        column[i] = c * a + s * b;
        column[i + 1] = c * b - s * a;
    }
    let radius = column[k].hypot(column[k + 1]);
    let (c, s) = if radius > 0.0 {
        (column[k] / radius, column[k + 1] / radius)
    } else {
        (1.0, 0.0)
    };
    column[k] = radius;
    turns.push((c, s));
    let last = right[k];
    right[k] = c * last;
    right.push(-s * last);
}

/// The solution of an upper triangle, given by its columns; zero at a pivot of zero.
fn back_substituted(triangle: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let m = triangle.len();
    let mut y = vec![0.0; m];
    for i in (0..m).rev() {
        let known: f64 = (i + 1..m).map(|j| triangle[j][i] * y[j]).sum();
        let pivot = triangle[i][i];
        y[i] = if pivot == 0.0 {
            0.0
        } else {
            (right[i] - known) / pivot
        };
    }
    y
}

/// The same for matrices that are not symmetric.
///
/// Source: Saad, *SIAM J. Sci. Comput.* 14 (1993) 461–469.
///
/// # Errors
/// Those of the preconditioner.
pub(super) fn minimal_residuals(
    of: &mut impl Operators,
    r: &mut [f64],
    x: &mut [f64],
    stop: Stop,
    most: usize,
) -> Result<(End, usize), LinearError> {
    let n = r.len();
    let mut total = 0;
    let start = dot(of, r, r).sqrt();
    let (mut sum, mut change) = (vec![0.0; n], vec![0.0; n]);
    while total < most {
        let size = dot(of, r, r).sqrt();
        let goal = stop.part().map_or(0.0, |part| part * start);
        if size <= goal || largest_of(of, r) <= stop.largest() {
            return Ok((End::Small, total));
        }
        // the largest entry over the norm, where it was looked at last
        let mut spread = largest_of(of, r) / size;
        let mut basis = vec![r.iter().map(|r| r / size).collect::<Vec<f64>>()];
        let mut directions: Vec<Vec<f64>> = Vec::new();
        // columns of the triangle, rotations, and the right side
        let mut triangle: Vec<Vec<f64>> = Vec::new();
        let mut turns: Vec<(f64, f64)> = Vec::new();
        let mut right = vec![size];
        let mut is_reached = false;
        while directions.len() < RESTART && total < most {
            let k = directions.len();
            let mut z = vec![0.0; n];
            of.precondition(&basis[k], &mut z)?;
            let mut w = vec![0.0; n];
            of.apply(&z, &mut w);
            directions.push(z);
            total += 1;
            let mut column = vec![0.0; k + 2];
            for (h, v) in column.iter_mut().zip(&basis) {
                *h = dot(of, &w, v);
                add(-*h, v, &mut w);
            }
            let left = dot(of, &w, &w).sqrt();
            column[k + 1] = left;
            rotate(&mut column, &mut turns, &mut right);
            triangle.push(column);
            if left == 0.0 {
                break;
            }
            w.iter_mut().for_each(|w| *w /= left);
            basis.push(w);
            let size = right[k + 1].abs();
            is_reached = size <= goal;
            // the largest entry is looked at where the norm says that it may be small enough
            if !is_reached && size * spread <= NEARLY * stop.largest() {
                residual_of(&basis, &turns, right[k + 1], &mut change);
                let left = largest_of(of, &change);
                is_reached = left <= stop.largest();
                spread = left / size;
            }
            if is_reached {
                break;
            }
            let enough = goal.max(stop.largest() / spread);
            if total == PATIENCE && is_hopeless(size / start, enough / start, most) {
                return Ok((End::Slow, total));
            }
        }
        sum.fill(0.0);
        for (y, direction) in back_substituted(&triangle, &right).iter().zip(&directions) {
            add(*y, direction, &mut sum);
        }
        add(1.0, &sum, x);
        if is_reached {
            return Ok((End::Small, total));
        }
        of.apply(&sum, &mut change);
        add(-1.0, &change, r);
    }
    Ok((End::Slow, total))
}
