//! Work of what acts from outside, over the accepted increments.

use crate::system::{Archive, ArchiveError, Dof, Order, Sink, State, System, TermError, Work};

/// Work of loads and supports, by the trapezoidal rule.
///
/// ```text
/// W = Σ ½ (F_n + F_n+1)·(u_n+1 − u_n)
/// ```
#[derive(Clone, Debug, Default)]
pub(super) struct Works {
    /// F_n: of loads on all unknowns, of supports on those that are prescribed.
    forces: Vec<f64>,
    next: Vec<f64>,
    /// W.
    pub external: f64,
    /// Σ |ΔW|: what percentages refer to, whatever loads give back.
    pub turnover: f64,
}

impl Works {
    /// Takes an increment from `before` to `now`, with the residual there.
    ///
    /// # Errors
    /// A load that cannot be evaluated.
    pub fn accept(
        &mut self,
        system: &System,
        (before, now): (&State, &State),
        (prescribed, residual): (&[bool], &[f64]),
    ) -> Result<(), TermError> {
        let n = now.u.len();
        self.forces.resize(n, 0.0);
        self.next.clear();
        self.next.resize(n, 0.0);
        let mut loads = Loads(&mut self.next);
        let mut work = Work::default();
        for term in system.terms.iter().filter(|term| term.is_load()) {
            for chunk in 0..term.nchunk() {
                term.evaluate(chunk, now, Order::Residual, &mut work, &mut loads)?;
            }
        }
        let of_supports = prescribed.iter().zip(residual);
        for (force, (prescribed, r)) in self.next.iter_mut().zip(of_supports) {
            if *prescribed {
                *force += r;
            }
        }
        let forces = self.forces.iter().zip(&self.next);
        let moved = before.u.iter().zip(&now.u);
        let work: f64 = forces
            .zip(moved)
            .map(|((a, b), (from, to))| 0.5 * (a + b) * (to - from))
            .sum();
        self.external += work;
        self.turnover += work.abs();
        std::mem::swap(&mut self.forces, &mut self.next);
        Ok(())
    }

    pub fn save(&self, out: &mut Archive) {
        out.put("works", &[self.external, self.turnover]);
        out.put("works.forces", &self.forces);
    }

    /// Takes what was stored; an older run does not know of it.
    ///
    /// # Errors
    /// The archive belongs to another model.
    pub fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        *self = Self::default();
        let Ok(n) = from.length("works.forces") else {
            return Ok(());
        };
        self.forces.resize(n, 0.0);
        from.get("works.forces", &mut self.forces)?;
        let mut sums = [0.0; 2];
        from.get("works", &mut sums)?;
        [self.external, self.turnover] = sums;
        Ok(())
    }
}

/// Takes forces, with the sign in which they act.
struct Loads<'a>(&'a mut [f64]);

impl Sink for Loads<'_> {
    fn add(&mut self, dofs: &[Dof], force: &[f64], _: &[f64]) {
        for (&dof, f) in dofs.iter().zip(force) {
            if let Some(to) = self.0.get_mut(dof as usize) {
                *to -= f;
            }
        }
    }
}
