//! What the rows of a contact remember.

use super::{Contact, Lambda};
use crate::contact::discretization::Anchored;
use crate::contact::kernel::Past;
use crate::system::Dof;
use signorini_geometry::tensor::Vec3;

/// What rows remember: the accepted values, and those that the present increment works with. These stay until the next
/// begins, so that the report of an accepted state is of the forces that acted in it.
pub(super) struct History {
    pub accepted: Vec<Memory>,
    pub anchors: Vec<Option<Anchored>>,
    /// Multipliers that are frozen.
    pub lambdas: Vec<Lambda>,
    /// Limits of friction, where they are held for the sake of convergence.
    pub limits: Option<Vec<f64>>,
    /// Lengths of slip at the start of the increment.
    pub paths: Vec<f64>,
    /// Work spent in friction.
    pub work: f64,
    /// Work spent in damping, and in the present increment.
    pub damped: [f64; 2],
}

/// The memory of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Memory {
    pub anchor: Option<Anchored>,
    pub lambda: Lambda,
    /// All slip since the start, as a vector.
    pub slip: Vec3,
    /// Its length since contact was made.
    pub path: f64,
    /// Its dynamic gap, where energy was conserved.
    pub gap: Option<f64>,
}

/// The dynamic gaps of all rows in an increment, without what is added to them.
#[derive(Debug, Default)]
pub(super) struct DynamicGaps {
    /// γ₀; nothing for a row without a pair, or where energy is not conserved.
    pub start: Vec<Option<f64>>,
    /// γ₁ of the iterate that was found.
    pub reached: Vec<Option<f64>>,
    /// When the increment begins.
    pub time: f64,
}

/// Forces at the ends of increments, sorted by unknowns.
#[derive(Default)]
pub(super) struct Ends {
    /// f₀; none where an increment before was not weighted.
    pub before: Option<Vec<(Dof, f64)>>,
    /// f₁ of an iterate that was found.
    pub reached: Option<Vec<(Dof, f64)>>,
}

impl Ends {
    /// The increment has ended.
    pub fn keep(&mut self) {
        self.before = self.reached.take();
    }

    /// f₀ as unknowns and forces in turn.
    pub fn to_numbers(&self) -> Option<Vec<f64>> {
        let before = self.before.as_ref()?;
        let numbers = before.iter().flat_map(|(dof, f)| [f64::from(*dof), *f]);
        Some(numbers.collect())
    }

    /// What [`Self::to_numbers`] gave.
    pub fn from_numbers(numbers: &[f64]) -> Self {
        let (pairs, _) = numbers.as_chunks();
        let before = pairs.iter().map(|[dof, force]| (*dof as Dof, *force));
        let before = before.collect();
        Self {
            before: Some(before),
            reached: None,
        }
    }
}

impl History {
    pub fn new(nrow: usize, bond: Option<&[Option<Anchored>]>) -> Self {
        let anchor = |row: usize| bond.and_then(|b| b.get(row).copied().flatten());
        let accepted: Vec<Memory> = (0..nrow)
            .map(|row| Memory {
                anchor: anchor(row),
                ..Memory::default()
            })
            .collect();
        let mut history = Self {
            anchors: Vec::new(),
            lambdas: Vec::new(),
            paths: Vec::new(),
            accepted,
            limits: None,
            work: 0.0,
            damped: [0.0; 2],
        };
        history.begin();
        history
    }

    /// The present increment begins where the last one ended.
    pub fn begin(&mut self) {
        self.anchors.clear();
        self.anchors.extend(self.accepted.iter().map(|m| m.anchor));
        self.lambdas.clear();
        self.lambdas.extend(self.accepted.iter().map(|m| m.lambda));
        self.paths.clear();
        self.paths.extend(self.accepted.iter().map(|m| m.path));
    }

    pub fn reject(&mut self) {
        self.begin();
    }

    pub fn anchors(&self) -> &[Option<Anchored>] {
        &self.anchors
    }

    pub fn anchors_mut(&mut self) -> &mut [Option<Anchored>] {
        &mut self.anchors
    }

    pub fn lambda(&self, row: usize) -> Lambda {
        self.lambdas.get(row).copied().unwrap_or_default()
    }

    pub fn past(&self, row: usize) -> Past {
        Past {
            path: self.paths.get(row).copied().unwrap_or_default(),
            limit: self.limits.as_ref().and_then(|l| l.get(row).copied()),
            state: Contact::Open,
            ..Past::default()
        }
    }

    /// Limits of friction are not held any more; returns whether they were.
    pub fn forget_limits(&mut self) -> bool {
        self.limits.take().is_some()
    }

    /// Whether limits of friction are held.
    pub fn holds_limits(&self) -> bool {
        self.limits.is_some()
    }

    pub fn slip(&self, row: usize) -> Vec3 {
        self.accepted.get(row).map_or(Vec3::ZERO, |m| m.slip)
    }
}
