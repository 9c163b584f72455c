//! Cholesky factors of a symmetric matrix: L Lᵀ while it is positive definite, L D Lᵀ where it is not.
//!
//! L D Lᵀ does not pivot. What makes it safe: the order (a multiplier after a node that it couples with), a static shift
//! on diagonals that are zero, a replacement for pivots that vanish, and the refinement and residual check of every
//! solution, which undo the first two or refuse. With the matrix equilibrated, K + shift is
//!
//! ```text
//!   ⎡ K    Bᵀ ⎤        ⎡ K    Bᵀ  ⎤
//!   ⎣ B    0  ⎦   ⟶    ⎣ B   −ε I ⎦ ,   ε = SHIFT
//! ```
//!
//! quasidefinite where K is definite, so that every order has a factor (R. J. Vanderbei, Symmetric quasidefinite
//! matrices, SIAM J. Optim. 5 (1995) 100–113).

use crate::direct::registers::clear_upper_halves_everywhere;
use crate::error::LinearError;
use crate::matrix::Matrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::simplicial::SimplicialLdltRef;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, LltRef, SymbolicCholesky, SymbolicCholeskyRaw,
    SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// What a diagonal entry below it is replaced with before factorization, in units of the row's largest entry.
const SHIFT: f64 = 1e-10;
/// A pivot below it, in units of the row's largest entry, is replaced with `REPLACEMENT`.
const VANISHING: f64 = 1e-15;
const REPLACEMENT: f64 = 1e-9;
/// A pivot that elimination left below this part of its diagonal gives reason to look for free motions.
const SUSPICIOUS: f64 = 1e-8;

pub(super) struct Cholesky {
    symbolic: SymbolicCholesky<u32>,
    sign: Vec<i8>,
    par: Par,
    factor: Vec<f64>,
    memory: MemBuffer,
    kind: Kind,
    shifted: Vec<(usize, f64)>,
    /// Negative pivots of the last factorization.
    pub negative_pivots: usize,
    /// The smallest pivot over its diagonal before elimination.
    pub smallest_pivot: f64,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Llt,
    Ldlt,
}

/// The pattern of the factor for this order of elimination.
fn symbolic(matrix: &Matrix, order: &[u32]) -> Result<SymbolicCholesky<u32>, LinearError> {
    let n = matrix.nequation();
    let mut place = vec![0u32; n];
    for (new, &old) in order.iter().enumerate() {
        place[old as usize] = new as u32;
    }
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &matrix.start, None, &matrix.row);
    let ordering = SymmetricOrdering::Custom(PermRef::new_checked(order, &place, n));
    factorize_symbolic_cholesky(
        pattern,
        Side::Lower,
        ordering,
        CholeskySymbolicParams::default(),
    )
    .map_err(|_| LinearError::TooLarge {
        nequation: n,
        nentry: matrix.row.len(),
    })
}

/// The numbers that a factor stores, and the multiplications and additions that it takes: `Σ c²` over the columns, with
/// `c` the length of each.
pub(crate) fn size(matrix: &Matrix, order: &[u32]) -> Result<(usize, f64), LinearError> {
    Ok(size_of(&symbolic(matrix, order)?))
}

fn size_of(symbolic: &SymbolicCholesky<u32>) -> (usize, f64) {
    let squared = |c: usize| (c as f64) * (c as f64);
    let work = match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(raw) => {
            let columns = raw.col_ptr().windows(2);
            columns.map(|c| squared((c[1] - c[0]) as usize)).sum()
        }
        SymbolicCholeskyRaw::Supernodal(raw) => (0..raw.n_supernodes())
            .map(|s| {
                let width = (raw.supernode_end()[s] - raw.supernode_begin()[s]) as usize;
                let rows = raw.col_ptr_for_row_idx();
                let below = (rows[s + 1] - rows[s]) as usize;
                (1..=width).map(|k| squared(k + below)).sum::<f64>()
            })
            .sum(),
    };
    (symbolic.len_val(), work)
}

impl Cholesky {
    pub fn new(matrix: &Matrix, order: &[u32], sign: &[i8], par: Par) -> Result<Self, LinearError> {
        let n = matrix.nequation();
        let too_large = |nentry| LinearError::TooLarge {
            nequation: n,
            nentry,
        };
        let symbolic = symbolic(matrix, order)?;
        let mut factor = Vec::new();
        factor
            .try_reserve_exact(symbolic.len_val())
            .map_err(|_| too_large(symbolic.len_val()))?;
        factor.resize(symbolic.len_val(), 0.0);
        let scratch = symbolic
            .factorize_numeric_llt_scratch::<f64>(par, Default::default())
            .or(symbolic.factorize_numeric_ldlt_scratch::<f64>(par, Default::default()))
            .or(symbolic.solve_in_place_scratch::<f64>(1, par));
        let memory = MemBuffer::try_new(scratch).map_err(|_| too_large(symbolic.len_val()))?;
        Ok(Self {
            symbolic,
            sign: sign.to_vec(),
            par,
            factor,
            memory,
            kind: Kind::Llt,
            shifted: Vec::new(),
            negative_pivots: 0,
            smallest_pivot: 0.0,
        })
    }

    /// The numbers that the factor stores, and the multiplications and additions that it takes.
    pub fn size(&self) -> (usize, f64) {
        size_of(&self.symbolic)
    }

    /// Whether pivots were trusted to be positive and were.
    pub fn is_definite(&self) -> bool {
        self.kind == Kind::Llt
    }

    /// Whether diagonals were changed, so that a solution wants at least one refinement.
    pub fn is_shifted(&self) -> bool {
        !self.shifted.is_empty()
    }

    /// Whether some pivot was all but cancelled, so that the matrix may be singular.
    pub fn is_suspicious(&self) -> bool {
        self.smallest_pivot.is_nan() || self.smallest_pivot < SUSPICIOUS
    }

    /// Factorizes as L Lᵀ; false where a pivot is not positive.
    pub fn factorize_definite(&mut self, matrix: &Matrix) -> bool {
        self.kind = Kind::Llt;
        self.shifted.clear();
        let result = self.symbolic.factorize_numeric_llt(
            &mut self.factor,
            view(matrix),
            Side::Lower,
            Default::default(),
            self.par,
            MemStack::new(&mut self.memory),
            Default::default(),
        );
        clear_upper_halves_everywhere();
        let definite = result.is_ok();
        if definite {
            self.judge(matrix);
        }
        definite
    }

    /// Factorizes as L D Lᵀ, whatever the signs of the pivots. Leaves the matrix as it was.
    pub fn factorize_indefinite(&mut self, matrix: &mut Matrix) -> Result<(), LinearError> {
        self.kind = Kind::Ldlt;
        self.shifted.clear();
        for e in 0..matrix.nequation() {
            let at = matrix.diagonal(e);
            if matrix.value[at].abs() < SHIFT {
                self.shifted.push((at, matrix.value[at]));
                matrix.value[at] = SHIFT * f64::from(self.sign[e].signum());
            }
        }
        let regularization = LdltRegularization {
            dynamic_regularization_signs: None,
            dynamic_regularization_delta: REPLACEMENT,
            dynamic_regularization_epsilon: VANISHING,
        };
        let result = self.symbolic.factorize_numeric_ldlt(
            &mut self.factor,
            view(matrix),
            Side::Lower,
            regularization,
            self.par,
            MemStack::new(&mut self.memory),
            Default::default(),
        );
        clear_upper_halves_everywhere();
        let result = result.map(|_| ());
        for &(at, value) in &self.shifted {
            matrix.value[at] = value;
        }
        // with vanishing pivots replaced, only an overflow stops it
        result.map_err(|_| LinearError::Singular { equation: None })?;
        self.judge(matrix);
        Ok(())
    }

    /// Solves with the factor, in equilibrated unknowns.
    pub fn solve(&mut self, x: &mut [f64]) {
        let n = x.len();
        let x = MatMut::from_column_major_slice_mut(x, n, 1);
        let stack = MemStack::new(&mut self.memory);
        match self.kind {
            Kind::Llt => {
                LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
                    Conj::No,
                    x,
                    self.par,
                    stack,
                );
            }
            Kind::Ldlt => {
                LdltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
                    Conj::No,
                    x,
                    self.par,
                    stack,
                );
            }
        }
    }

    /// Counts negative pivots and finds the one that elimination left smallest.
    fn judge(&mut self, matrix: &Matrix) {
        let (mut negative, mut smallest) = (0, f64::INFINITY);
        let fwd = self.symbolic.perm().map(|perm| perm.arrays().0);
        let kind = self.kind;
        let mut look = |new: usize, diagonal: f64| {
            let old = fwd.map_or(new, |fwd| fwd[new] as usize);
            let before = matrix.value[matrix.diagonal(old)].abs();
            let pivot = if kind == Kind::Llt {
                diagonal * diagonal
            } else {
                diagonal
            };
            negative += usize::from(pivot < 0.0);
            // a diagonal that was zero is judged against its row, whose largest entry is 1
            let before = if before < SHIFT { 1.0 } else { before };
            smallest = f64::min(smallest, pivot.abs() / before);
        };
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(symbolic) => {
                let values = SimplicialLdltRef::new(symbolic, &self.factor).values();
                for (new, &at) in symbolic.col_ptr().iter().take(symbolic.ncols()).enumerate() {
                    look(new, values[at as usize]);
                }
            }
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                let factor = SupernodalLdltRef::new(symbolic, &self.factor);
                for s in 0..symbolic.n_supernodes() {
                    let node = factor.supernode(s);
                    for j in 0..node.val().ncols() {
                        look(node.start() + j, node.val()[(j, j)]);
                    }
                }
            }
        }
        self.negative_pivots = negative;
        self.smallest_pivot = smallest;
    }
}

fn view(matrix: &Matrix) -> SparseColMatRef<'_, u32, f64> {
    let n = matrix.nequation();
    SparseColMatRef::new(
        SymbolicSparseColMatRef::new_checked(n, n, &matrix.start, None, &matrix.row),
        &matrix.value,
    )
}
