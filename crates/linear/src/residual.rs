//! The true residual, through the operator as it was assembled.

use crate::operator::{apply, apply_absolute};
use crate::problem::{Kept, Values};
use crate::sparsity::NONE;

/// A residual of so many units of round-off of what is added up cannot be improved.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// A residual with the buffers to measure it.
pub(crate) struct Residual {
    raw_x: Vec<f64>,
    raw_y: Vec<f64>,
    /// `b − A x`, one entry per equation.
    pub value: Vec<f64>,
}

impl Residual {
    pub fn new(ndof: usize, nequation: usize) -> Self {
        Self {
            raw_x: vec![0.0; ndof],
            raw_y: vec![0.0; ndof],
            value: vec![0.0; nequation],
        }
    }

    /// The number of raw dofs.
    pub fn ndof(&self) -> usize {
        self.raw_x.len()
    }

    /// Measures the residual.
    pub fn measure(&mut self, kept: &Kept, values: &Values, rhs: &[f64], x: &[f64]) {
        let Self {
            raw_x,
            raw_y,
            value,
        } = self;
        spread(&kept.equation, x, raw_x);
        apply(&kept.bulk, &kept.interface, values, raw_x, raw_y);
        value.copy_from_slice(rhs);
        let equations = kept.equation.iter().zip(raw_y);
        for (&e, y) in equations.filter(|&(&e, _)| e != NONE) {
            value[e as usize] -= *y;
        }
    }

    /// How large a residual round-off alone may leave.
    pub fn round_off(&mut self, kept: &Kept, values: &Values, x: &[f64]) -> f64 {
        self.round_off_in(kept, values, x, |_| 1.0)
    }

    /// The same in units that each equation has.
    pub fn round_off_in(
        &mut self,
        kept: &Kept,
        values: &Values,
        x: &[f64],
        unit: impl Fn(usize) -> f64,
    ) -> f64 {
        let Self { raw_x, raw_y, .. } = self;
        spread(&kept.equation, x, raw_x);
        apply_absolute(&kept.bulk, &kept.interface, values, raw_x, raw_y);
        let equations = kept.equation.iter().zip(raw_y);
        let used = equations.filter(|&(&e, _)| e != NONE);
        ROUND_OFF * used.fold(0.0, |max: f64, (&e, y)| max.max(*y / unit(e as usize)))
    }
}

/// Unknowns from equations to raw degrees of freedom, zero where there is no equation.
fn spread(equation: &[u32], x: &[f64], raw: &mut [f64]) {
    for (&e, raw) in equation.iter().zip(raw) {
        *raw = x.get(e as usize).copied().unwrap_or(0.0);
    }
}
