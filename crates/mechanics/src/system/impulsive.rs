//! Contacts as explicit steps see them: rows that may act soon.

use super::{Dof, State, TermError};
use signorini_geometry::tensor::Vec3;

/// A contact, as explicit steps see it.
pub trait Impulsive {
    /// Whether impulses act on its rows.
    fn is_hard(&self) -> bool;

    /// Whether its rows have their velocities by impulses after an increment in which they have met: where no side yields.
    fn bounces(&self) -> bool;

    /// The rows that are no farther apart than `reach` at a state.
    ///
    /// # Errors
    /// As [`Term::evaluate`](super::Term::evaluate).
    fn near_rows(
        &self,
        state: &State,
        reach: f64,
        take: &mut dyn FnMut(&NearRow<'_>),
    ) -> Result<(), TermError>;

    /// The largest shear of a row at a pressure; 0 where nothing rubs.
    fn limit(&self, row: usize, pressure: f64) -> f64;
}

/// A row of a contact that may act soon. Vectors have one entry for each column.
pub struct NearRow<'a> {
    /// Its number.
    pub number: usize,
    /// The unknown of each column; [`NO_DOF`](super::NO_DOF) where it has none.
    pub dofs: &'a [Dof],
    /// Gap, negative in penetration.
    pub gap: f64,
    /// b: the force of a pressure at the columns, over what that refers to; `b·v` is the velocity of the gap that does its work.
    pub weights: &'a [f64],
    /// What pressures refer to: an area, or 1.
    pub measure: f64,
    /// The unit normal out of the primary side.
    pub normal: Vec3,
    /// How it acts.
    pub acts: Acts<'a>,
}

/// How a row acts where it is closed.
#[derive(Clone, Copy)]
pub enum Acts<'a> {
    /// By pressure and shear that follow from where the sides are: the largest stiffness per gap and slip.
    Stiff(f64),
    /// By a multiplier: the first of its unknowns, and their number.
    Hard {
        /// The first of its unknowns.
        multiplier: Dof,
        /// One: a pressure. As many as axes: a traction on the primary side.
        count: usize,
        /// The velocity after an impact over that before it.
        restitution: f64,
        /// Friction, where there is any.
        friction: Option<Rubbing<'a>>,
    },
}

/// Friction of a row. Vectors have one entry for each column.
#[derive(Clone, Copy)]
pub struct Rubbing<'a> {
    /// B: the force at a column is `B·t`; the part of `Bᵀ v` within the tangent plane is the velocity of the slip.
    pub operator: &'a [Vec3],
}
