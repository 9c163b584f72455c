//! MUMPS, a multifrontal solver with pivoting: a second opinion that shares no factor with [`super::Direct`].
//!
//! ```text
//!   Definite    ──▶ L D Lᵀ ──a pivot ≤ 0──▶ L D Lᵀ with pivots of one and two rows
//!   Symmetric   ──────────────────────────▶ L D Lᵀ with pivots of one and two rows
//!   Unsymmetric ──────────────────────────▶ L U with pivots
//! ```
//!
//! The order of elimination is ours, from the pattern alone, and one thread is used: the same input gives the same bits
//! with the same library on the same kind of processor. Every factor is examined for free motions.
//!
//! Needs the feature `mumps` and the library, version 5.5 or later, without MPI.
//!
//! P. R. Amestoy, I. S. Duff, J. Koster and J.-Y. L'Excellent, A fully asynchronous multifrontal solver using
//! distributed dynamic scheduling, SIAM J. Matrix Anal. Appl. 23 (2001) 15–41; MUMPS 5.5.1 Users' guide, section 8.

mod library;

use crate::direct::gathered::{Breakdown, Gathered, NAMING_SHIFT};
use crate::error::LinearError;
use crate::ordering::{self, Ordering};
use crate::problem::{Problem, Symmetry, Values};
use crate::solver::{Iterative, LinearSolver, SolveReport};
use library::{Instance, Kind, Pattern, Status};

/// Working space beyond the estimate at first and at most, in per cent: pivots that are put off need more.
const SPARE: i32 = 30;
const MOST_SPARE: i32 = 4000;

/// A pivot is zero.
const ZERO_PIVOT: i32 = -10;
/// Working space ended, of integers or of numbers.
const SPACE_ENDED: [i32; 2] = [-8, -9];
/// Memory or the range of an index ended.
const TOO_LARGE: [i32; 8] = [-5, -7, -11, -13, -14, -15, -51, -52];

/// The solver MUMPS.
#[derive(Default)]
pub struct Mumps {
    analysis: Option<Analysis>,
}

struct Analysis {
    gathered: Gathered,
    order: Vec<u32>,
    factor: Option<Instance>,
    /// The factor is that of the last values.
    current: bool,
    /// The last factor had negative pivots.
    indefinite: bool,
    spare: i32,
}

impl Mumps {
    /// A solver that has not seen a problem yet.
    pub fn new() -> Self {
        Self::default()
    }

    fn analyzed(&mut self) -> Result<&mut Analysis, LinearError> {
        self.analysis
            .as_mut()
            .ok_or(LinearError::Order { before: "analyze" })
    }
}

impl LinearSolver for Mumps {
    fn analyze(&mut self, problem: &Problem) -> Result<(), LinearError> {
        let known = |a: &Analysis| a.gathered.is(problem);
        if self.analysis.as_ref().is_some_and(known) {
            return Ok(());
        }
        self.analysis = None;
        problem.check()?;
        self.analysis = Some(Analysis::new(problem)?);
        Ok(())
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        self.analyzed()?.factorize(values)
    }

    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        self.analyzed()?.solve(values, rhs, x, rtol)
    }

    fn iterative(&self) -> Option<&dyn Iterative> {
        None
    }

    fn iterative_mut(&mut self) -> Option<&mut dyn Iterative> {
        None
    }
}

impl Analysis {
    fn new(problem: &Problem) -> Result<Self, LinearError> {
        let gathered = Gathered::new(problem)?;
        let order = if problem.nequation == 0 {
            Vec::new()
        } else {
            ordering::order(problem, &gathered.matrix, Ordering::Auto)?
        };
        Ok(Self {
            gathered,
            order,
            factor: None,
            current: false,
            indefinite: false,
            spare: SPARE,
        })
    }

    fn factorize(&mut self, values: &Values) -> Result<(), LinearError> {
        self.current = false;
        self.gathered.matrix.forget_scales();
        self.gathered.gather(values)?;
        if self.order.is_empty() {
            return Ok(());
        }
        let with_pivots = if self.gathered.matrix.symmetric {
            Kind::Symmetric
        } else {
            Kind::Unsymmetric
        };
        let hopeful = self.gathered.kept.symmetry == Symmetry::Definite && !self.indefinite;
        let definite =
            hopeful && self.eliminate(Kind::Definite, 0.0)? && self.negative_pivots() == 0;
        let eliminated = definite || self.eliminate(with_pivots, 0.0)?;
        self.indefinite = self.negative_pivots() > 0;
        let motion = if eliminated {
            self.free_motion()
        } else {
            Err(Breakdown)
        };
        let equation = match motion {
            Ok(None) => {
                self.current = true;
                return Ok(());
            }
            Ok(equation) => equation,
            // a nearby matrix shows the motion
            Err(Breakdown) if self.eliminate(with_pivots, NAMING_SHIFT)? => {
                self.free_motion().unwrap_or(None)
            }
            Err(Breakdown) => None,
        };
        Err(LinearError::Singular { equation })
    }

    /// Factorizes the matrix with `shift` added to its diagonal; false where a pivot is zero.
    fn eliminate(&mut self, kind: Kind, shift: f64) -> Result<bool, LinearError> {
        let mut factor = match self.factor.take() {
            Some(factor) if factor.kind() == kind => factor,
            _ => self.instance(kind)?,
        };
        let matrix = &mut self.gathered.matrix;
        matrix.shift(shift);
        let mut status = factor.factorize(&mut matrix.value, self.spare);
        while matches!(status, Ok(s) if SPACE_ENDED.contains(&s.code)) && self.spare < MOST_SPARE {
            self.spare *= 2;
            status = factor.factorize(&mut matrix.value, self.spare);
        }
        matrix.shift(-shift);
        self.factor = Some(factor);
        match status? {
            status if status.code >= 0 => Ok(true),
            status if status.code == ZERO_PIVOT => Ok(false),
            status => Err(self.error(status)),
        }
    }

    /// The analyzed pattern.
    fn instance(&self, kind: Kind) -> Result<Instance, LinearError> {
        let matrix = &self.gathered.matrix;
        let entries = (0..self.order.len() as u32).flat_map(|row| {
            let columns = matrix.column(row as usize).iter();
            columns.map(move |&column| (row, column))
        });
        let pattern = Pattern::new(entries, &self.order).ok_or_else(|| self.too_large())?;
        Instance::new(kind, pattern)
            .map_err(|status| status.map_or_else(|| self.too_large(), |s| self.error(s)))
    }

    fn negative_pivots(&self) -> usize {
        self.factor.as_ref().map_or(0, Instance::negative_pivots)
    }

    fn free_motion(&mut self) -> Result<Option<usize>, Breakdown> {
        let factor = self.factor.as_mut().ok_or(Breakdown)?;
        self.gathered.free_motion(|x| {
            if !matches!(factor.solve(x), Ok(status) if status.code >= 0) {
                x.fill(f64::NAN);
            }
        })
    }

    fn solve(
        &mut self,
        values: &Values,
        rhs: &[f64],
        x: &mut [f64],
        rtol: f64,
    ) -> Result<SolveReport, LinearError> {
        self.gathered.kept.check_solution(values, rhs, x)?;
        if rhs.is_empty() {
            return Ok(SolveReport::default());
        }
        let before = "factorize";
        let factor = self.factor.as_mut().filter(|_| self.current);
        let factor = factor.ok_or(LinearError::Order { before })?;
        let mut fault = None;
        let result = self.gathered.refine(values, rhs, x, rtol, 0, |x| {
            match factor.solve(x) {
                Ok(status) if status.code >= 0 => return,
                Ok(status) => fault = Some(status),
                Err(_) => {}
            }
            x.fill(f64::NAN);
        });
        let negative_pivots = factor.negative_pivots();
        match fault {
            Some(status) => Err(self.error(status)),
            None => result.map(|report| SolveReport {
                negative_pivots,
                ..report
            }),
        }
    }

    fn too_large(&self) -> LinearError {
        LinearError::TooLarge {
            nequation: self.order.len(),
            nentry: self.gathered.matrix.row.len(),
        }
    }

    fn error(&self, Status { code, detail }: Status) -> LinearError {
        if SPACE_ENDED.contains(&code) || TOO_LARGE.contains(&code) {
            self.too_large()
        } else {
            LinearError::Library {
                name: "MUMPS",
                code,
                detail,
            }
        }
    }
}
