//! Steps: their increments, and the values that they prescribe.

use super::TimeControl;
use crate::system::{Dof, GeometricStress, Physics, Scheme, StepContext, TimeFunction};

/// How a step is cut into increments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Increments {
    /// Exactly this many of equal size; a failure ends the run.
    Fixed(usize),
    /// Sizes that adapt to the difficulty.
    Adaptive {
        /// The first.
        initial: f64,
        /// The smallest that is tried; infinite: none is cut.
        min: f64,
        /// The largest.
        max: f64,
        /// How many there may be.
        count_max: usize,
    },
}

/// The course of a prescribed dof over a step.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Stays where it is when the step begins.
    Hold,
    /// Goes evenly from there to this value at the end of the step.
    Ramp(f64),
    /// Follows a table of (step time, value), linear between its rows, constant outside.
    Table(Vec<[f64; 2]>),
    /// The same over total time.
    TotalTable(Vec<[f64; 2]>),
    /// Follows a function of step time.
    Function(TimeFunction),
    /// The same over total time.
    TotalFunction(TimeFunction),
}

impl Motion {
    /// Whether it goes on through later steps.
    #[must_use]
    pub const fn goes_on(&self) -> bool {
        matches!(self, Self::TotalTable(_) | Self::TotalFunction(_))
    }
}

/// A prescribed dof.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescription {
    /// Which.
    pub dof: Dof,
    /// Its course.
    pub motion: Motion,
}

/// A step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Its name.
    pub name: String,
    /// Its duration.
    pub duration: f64,
    /// How it is cut.
    pub increments: Increments,
    /// Whether displacements may be large.
    pub nonlinear: bool,
    /// How it goes through time, where inertia counts.
    pub scheme: Option<Scheme>,
    /// What limits its increments there, where they adapt.
    pub control: Option<TimeControl>,
    /// Which natural modes are found in it, at the state where it begins; it then takes no time, and changes nothing.
    pub vibration: Option<Vibration>,
    /// What is unknown in it.
    pub physics: Physics,
    /// What is prescribed during it; everything else is free.
    pub prescriptions: Vec<Prescription>,
}

/// Which natural modes are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vibration {
    /// How many, at most.
    pub count: usize,
    /// The frequency (cycles per time) where they begin; none: with the lowest, rigid motions among them.
    pub from: Option<f64>,
    /// The frequency (cycles per time) where they end; none: nowhere.
    pub to: Option<f64>,
}

/// Steps that come again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// The first of them and the last, which follow one another.
    pub steps: [usize; 2],
    /// How many cycles there are.
    pub count: usize,
    /// What lets one stand for many; `None`: each is solved.
    pub jump: Option<Jump>,
}

/// How many cycles one stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// What may go wrong over the depth.
    pub tol: f64,
    /// For how many the first stands.
    pub first: usize,
    /// The largest depth that one may take off; `None`: any.
    pub max_wear: Option<f64>,
}

/// Where a run is in its cycles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Turns {
    /// Cycles that are behind.
    pub done: f64,
    /// For how many the present one stands; 0 outside of cycles.
    pub stands_for: f64,
    /// Depths that each of those behind has taken off, as the last one found.
    pub last: Vec<f64>,
}

impl Step {
    /// Whether it leads from equilibrium to equilibrium.
    #[must_use]
    pub const fn is_static(&self) -> bool {
        self.scheme.is_none() && self.vibration.is_none()
    }

    /// The step as terms see it, with its number and the total time at its start.
    #[must_use]
    pub fn context(&self, number: usize, start: f64) -> StepContext {
        let vibrates = self.vibration.is_some();
        StepContext {
            number,
            start,
            // none passes in vibrations, and courses are functions of a part of it
            duration: if vibrates { 1.0 } else { self.duration },
            nonlinear: self.nonlinear,
            // whoever has mass shows it
            scheme: match vibrates {
                true => Some(Scheme::hilber_hughes_taylor(0.0)),
                false => self.scheme,
            },
            vibrates,
            physics: self.physics,
            cycles: 1.0,
            geometric: GeometricStress::default(),
        }
    }
}

/// Sizes and number of the increments of a step.
pub(super) struct Sizes {
    pub count: usize,
    pub first: f64,
    /// None where an increment that fails is not made smaller.
    pub min: Option<f64>,
    pub max: f64,
}

impl Sizes {
    pub fn of(step: &Step) -> Self {
        match step.increments {
            Increments::Fixed(n) => Self {
                count: n,
                first: step.duration / n as f64,
                min: None,
                max: step.duration / n as f64,
            },
            Increments::Adaptive {
                initial,
                min,
                max,
                count_max,
            } => Self {
                count: count_max,
                first: initial,
                min: Some(min).filter(|m| m.is_finite()),
                max,
            },
        }
    }
}
