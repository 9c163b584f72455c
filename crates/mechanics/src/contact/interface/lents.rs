//! Rows that lend their functions to others: the matrices F, H and X of `lent.rs`, which has the equations.

use crate::system::Dof;
use signorini_geometry::tensor::{Mat3, Vec3};

/// Of a row that does not keep all of its multiplier.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lent {
    /// F.
    pub free: Mat3,
    /// H.
    pub held: Mat3,
    /// Rows that take over, each with X.
    pub borrowers: Vec<(usize, Mat3)>,
}

/// Of all rows.
#[derive(Debug, Default)]
pub(super) struct Lents {
    pub of: Vec<Option<Lent>>,
    /// Unknowns that are prescribed in the present step.
    pub prescribed: Vec<bool>,
    /// Whether they may be others than those these are for.
    pub stale: bool,
}

impl Lents {
    /// Takes the prescribed dofs of the step that begins.
    pub fn prescribe(&mut self, prescribed: &[bool]) {
        self.prescribed.clear();
        self.prescribed.extend_from_slice(prescribed);
        self.stale = true;
    }

    /// Whether prescribed unknowns may be others since they were looked at.
    pub const fn is_stale(&self) -> bool {
        self.stale
    }

    /// Whether an unknown is prescribed in the present step.
    pub fn is_prescribed(&self, dof: Dof) -> bool {
        self.prescribed.get(dof as usize) == Some(&true)
    }

    /// What becomes of a row; `None` where it keeps its multiplier.
    pub fn of(&self, row: usize) -> Option<&Lent> {
        self.of.get(row)?.as_ref()
    }

    /// Whether no row lends anything.
    pub fn is_empty(&self) -> bool {
        self.of.iter().all(Option::is_none)
    }

    /// (E2).
    pub fn effective(&self, row: usize, lambda: &dyn Fn(usize) -> Vec3) -> Vec3 {
        let own = lambda(row);
        let Some(lent) = self.of(row) else {
            return own;
        };
        let borrowers = lent.borrowers.iter();
        let from_borrowers = borrowers.map(|(borrower, x)| x.transpose() * lambda(*borrower));
        lent.free * own + from_borrowers.sum::<Vec3>()
    }
}
