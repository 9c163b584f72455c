//! Stiffness and mass, and a factor of a combination of both.

use crate::direct::Direct;
use crate::error::LinearError;
use crate::operator::{apply, apply_absolute};
use crate::problem::{Problem, Values};
use crate::solver::LinearSolver;
use crate::sparsity::NONE;

/// The residual of a solution with a factor, over its right-hand side.
const RESIDUAL: f64 = 1e-11;
/// By how much a shift moves where the matrix there is singular, over itself.
const ASIDE: f64 = 1e-4;
/// How often.
const MOVES: usize = 6;
/// The first shift of free bodies over the Rayleigh quotient of uniform strains: bending is slower than stretching.
const SLOWER: f64 = 1e-3;

pub(super) struct Pencil<'a> {
    problem: Problem<'a>,
    stiffness: Values<'a>,
    mass: Values<'a>,
    solver: Direct,
    /// The values of the matrix that is factorized.
    bulk: Vec<f64>,
    interface: Vec<f64>,
    pub shift: f64,
    /// The eigenvalues below the shift, as the factor counts them.
    pub below: Option<usize>,
    nmultiplier: usize,
    /// Over all raw degrees of freedom.
    from: Vec<f64>,
    to: Vec<f64>,
    /// Over all equations.
    right: Vec<f64>,
    pub solves: usize,
    pub factors: usize,
}

impl<'a> Pencil<'a> {
    pub fn new(
        problem: &Problem<'a>,
        [stiffness, mass]: [Values<'a>; 2],
    ) -> Result<Self, LinearError> {
        let mut solver = Direct::reproducible();
        solver.analyze(problem)?;
        let shape = |what, got: &[f64], wanted: usize| match got.len() == wanted {
            true => Ok(()),
            false => Err(LinearError::Shape {
                what,
                got: got.len(),
                wanted,
            }),
        };
        for values in [&stiffness, &mass] {
            shape("values of the bulk", values.bulk, problem.bulk.nvalue())?;
            let nentry = problem.interface.nentry();
            shape("values of the interface", values.interface, nentry)?;
        }
        Ok(Self {
            problem: *problem,
            stiffness,
            mass,
            solver,
            bulk: Vec::new(),
            interface: Vec::new(),
            shift: 0.0,
            below: None,
            nmultiplier: problem.sign.iter().filter(|&&sign| sign < 0).count(),
            from: vec![0.0; problem.ndof],
            to: vec![0.0; problem.ndof],
            right: vec![0.0; problem.nequation],
            solves: 0,
            factors: 0,
        })
    }

    pub fn nequation(&self) -> usize {
        self.problem.nequation
    }

    /// Factorizes `K − shift M`, and counts the eigenvalues below.
    ///
    /// # Errors
    /// Those of a direct solver.
    pub fn shift_to(&mut self, shift: f64) -> Result<(), LinearError> {
        let combined = |out: &mut Vec<f64>, k: &[f64], m: &[f64]| {
            out.clear();
            out.extend(k.iter().zip(m).map(|(k, m)| k - shift * m));
        };
        combined(&mut self.bulk, self.stiffness.bulk, self.mass.bulk);
        let [k, m] = [self.stiffness.interface, self.mass.interface];
        combined(&mut self.interface, k, m);
        self.shift = shift;
        self.below = None;
        self.factors += 1;
        let values = Values {
            bulk: &self.bulk,
            interface: &self.interface,
        };
        self.solver.factorize(&values)?;
        let negative = self.solver.negative_pivots();
        self.below = negative.and_then(|n| n.checked_sub(self.nmultiplier));
        Ok(())
    }

    /// The same, next to it where the matrix there is singular.
    ///
    /// # Errors
    /// Those of a direct solver.
    pub fn shift_near(&mut self, shift: f64) -> Result<(), LinearError> {
        let mut outcome = self.shift_to(shift);
        let mut aside = ASIDE;
        for _ in 0..MOVES {
            if !matches!(outcome, Err(LinearError::Singular { .. })) {
                break;
            }
            outcome = self.shift_to(shift * (1.0 + aside));
            aside *= 10.0;
        }
        outcome
    }

    /// M x, over all equations.
    pub fn times_mass(&mut self, x: &[f64], out: &mut [f64]) {
        self.times(self.mass, x, out);
    }

    /// K x, over all equations.
    pub fn times_stiffness(&mut self, x: &[f64], out: &mut [f64]) {
        self.times(self.stiffness, x, out);
    }

    fn times(&mut self, values: Values<'_>, x: &[f64], out: &mut [f64]) {
        self.spread(x);
        let Problem {
            bulk, interface, ..
        } = self.problem;
        apply(bulk, interface, &values, &self.from, &mut self.to);
        self.gather(out);
    }

    /// Adds the sizes of what `K x` and `factor M x` add up to `out`.
    pub fn sizes(&mut self, x: &[f64], factor: f64, out: &mut [f64]) {
        self.spread(x);
        let Problem {
            bulk, interface, ..
        } = self.problem;
        for (values, factor) in [(self.stiffness, 1.0), (self.mass, factor.abs())] {
            apply_absolute(bulk, interface, &values, &self.from, &mut self.to);
            let equations = self.problem.equation.iter().zip(&self.to);
            for (&equation, size) in equations.filter(|(equation, _)| **equation != NONE) {
                if let Some(out) = out.get_mut(equation as usize) {
                    *out += factor * size;
                }
            }
        }
    }

    fn spread(&mut self, x: &[f64]) {
        for (from, &equation) in self.from.iter_mut().zip(self.problem.equation) {
            *from = match equation {
                NONE => 0.0,
                equation => x.get(equation as usize).copied().unwrap_or_default(),
            };
        }
    }

    fn gather(&self, out: &mut [f64]) {
        for (to, &equation) in self.to.iter().zip(self.problem.equation) {
            if let Some(out) = out.get_mut(equation as usize) {
                *out = *to;
            }
        }
    }

    /// `(K − shift M)⁻¹ M x`; `x` is left as it is.
    ///
    /// # Errors
    /// Those of a direct solver.
    pub fn inverse(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), LinearError> {
        let mut right = std::mem::take(&mut self.right);
        self.times_mass(x, &mut right);
        let values = Values {
            bulk: &self.bulk,
            interface: &self.interface,
        };
        self.solves += 1;
        let outcome = self.solver.solve(&values, &right, out, RESIDUAL);
        self.right = right;
        outcome.map(|_| ())
    }

    /// A first guess of the lowest eigenvalue that is not zero: a part of the least Rayleigh quotient of uniform strains.
    pub fn first_guess(&mut self) -> f64 {
        let n = self.nequation();
        let block = self.problem.bulk.block;
        let [mut x, mut of_k, mut of_m] = [0; 3].map(|_| vec![0.0; n]);
        let mut least = f64::INFINITY;
        for (along, component) in (0..block).flat_map(|a| (0..block).map(move |c| (a, c))) {
            x.fill(0.0);
            let places = self.problem.coordinates.iter();
            let along = |place: &[f64; 3]| place.get(along).copied().unwrap_or_default();
            let mean = places.clone().map(along).sum::<f64>() / places.len().max(1) as f64;
            for (node, place) in places.enumerate() {
                let equation = self.problem.equation.get(node * block + component);
                if let Some(x) = equation.and_then(|&e| x.get_mut(e as usize)) {
                    *x = along(place) - mean;
                }
            }
            self.times_stiffness(&x, &mut of_k);
            self.times_mass(&x, &mut of_m);
            let [k, m] = [&of_k, &of_m].map(|y| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>());
            // a motion of a body as a whole has a stiffness of rounding errors
            if m > 0.0 && k > 0.0 {
                least = least.min(k / m);
            }
        }
        if least.is_finite() {
            return SLOWER * least;
        }
        // nothing but rigid motions: any scale of the stiffness
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let [k, m] = [self.stiffness.bulk, self.mass.bulk].map(largest);
        if k > 0.0 && m > 0.0 {
            1e-6 * k / m
        } else {
            1.0
        }
    }
}
