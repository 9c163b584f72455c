//! LU factors with partial pivoting, for matrices that are not symmetric and for symmetric ones that resist L D Lᵀ.
//!
//! The matrix holds the operator's rows as columns, so it is the transpose that is factorized and solved with.

use crate::direct::registers::clear_upper_halves_everywhere;
use crate::error::LinearError;
use crate::matrix::Matrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::LuError;
use faer::sparse::linalg::lu::{
    LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};

pub(super) struct Lu {
    symbolic: SymbolicLu<u32>,
    numeric: NumericLu<u32, f64>,
    memory: MemBuffer,
    par: Par,
    /// Both halves of a matrix of which only one is kept.
    whole: Option<Whole>,
}

/// A symmetric matrix unfolded; `from` is the place of each value in the half.
struct Whole {
    start: Vec<u32>,
    row: Vec<u32>,
    from: Vec<u32>,
    value: Vec<f64>,
}

impl Whole {
    fn new(half: &Matrix) -> Result<Self, LinearError> {
        let n = half.nequation();
        if half.row.len() >= u32::MAX as usize / 4 {
            return Err(LinearError::TooLarge {
                nequation: n,
                nentry: 2 * half.row.len(),
            });
        }
        let mut start = vec![0u32; n + 1];
        for e in 0..n {
            for &f in half.column(e) {
                start[e + 1] += 1;
                start[f as usize + 1] += u32::from(f as usize != e);
            }
        }
        for e in 0..n {
            start[e + 1] += start[e];
        }
        let mut next = start.clone();
        let mut row = vec![0u32; start[n] as usize];
        let mut from = row.clone();
        let mut put = |column: usize, e: usize, at: u32| {
            row[next[column] as usize] = e as u32;
            from[next[column] as usize] = at;
            next[column] += 1;
        };
        // columns before e have put their entries of row e already, in order
        for e in 0..n {
            for (at, &f) in (half.start[e]..).zip(half.column(e)) {
                put(e, f as usize, at);
                if f as usize != e {
                    put(f as usize, e, at);
                }
            }
        }
        Ok(Self {
            value: vec![0.0; from.len()],
            start,
            row,
            from,
        })
    }
}

impl Lu {
    pub fn new(matrix: &Matrix, par: Par) -> Result<Self, LinearError> {
        let n = matrix.nequation();
        let too_large = |nentry| LinearError::TooLarge {
            nequation: n,
            nentry,
        };
        let whole = if matrix.symmetric {
            Some(Whole::new(matrix)?)
        } else {
            None
        };
        let (start, row) = match &whole {
            Some(whole) => (&whole.start, &whole.row),
            None => (&matrix.start, &matrix.row),
        };
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, start, None, row);
        let symbolic = factorize_symbolic_lu(pattern, LuSymbolicParams::default())
            .map_err(|_| too_large(row.len()))?;
        let scratch = symbolic
            .factorize_numeric_lu_scratch::<f64>(par, Default::default())
            .or(symbolic.solve_transpose_in_place_scratch::<f64>(1, par));
        let memory = MemBuffer::try_new(scratch).map_err(|_| too_large(row.len()))?;
        Ok(Self {
            symbolic,
            numeric: NumericLu::new(),
            memory,
            par,
            whole,
        })
    }

    /// Factorizes the matrix with `shift` added to its diagonal.
    pub fn factorize(&mut self, matrix: &mut Matrix, shift: f64) -> Result<(), LinearError> {
        let n = matrix.nequation();
        matrix.shift(shift);
        let (start, row, value) = match &mut self.whole {
            Some(whole) => {
                for (value, &at) in whole.value.iter_mut().zip(&whole.from) {
                    *value = matrix.value[at as usize];
                }
                (&whole.start, &whole.row, &whole.value)
            }
            None => (&matrix.start, &matrix.row, &matrix.value),
        };
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, start, None, row);
        let result = self.symbolic.factorize_numeric_lu(
            &mut self.numeric,
            SparseColMatRef::new(pattern, value),
            self.par,
            MemStack::new(&mut self.memory),
            Default::default(),
        );
        clear_upper_halves_everywhere();
        let result = result.map(|_| ()).map_err(|error| match error {
            LuError::SymbolicSingular { index } => {
                let column = self
                    .symbolic
                    .col_perm()
                    .arrays()
                    .0
                    .get(index)
                    .map(|&e| e as usize);
                LinearError::Singular { equation: column }
            }
            LuError::Generic(_) => LinearError::TooLarge {
                nequation: n,
                nentry: row.len(),
            },
        });
        matrix.shift(-shift);
        result
    }

    /// Solves with the factor, in equilibrated unknowns.
    pub fn solve(&mut self, x: &mut [f64]) {
        let n = x.len();
        let x = MatMut::from_column_major_slice_mut(x, n, 1);
        LuRef::new_unchecked(&self.symbolic, &self.numeric).solve_transpose_in_place_with_conj(
            Conj::No,
            x,
            self.par,
            MemStack::new(&mut self.memory),
        );
    }
}
