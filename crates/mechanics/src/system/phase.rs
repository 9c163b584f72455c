//! Where a run is, as terms see it.

use super::Scheme;

/// What a step does with temperatures, in a model in which they are unknowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heat {
    /// They are prescribed everywhere.
    #[default]
    Given,
    /// They are in equilibrium: as much heat flows in as out.
    Steady,
    /// Bodies store heat.
    Transient,
}

/// What is unknown in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Physics {
    /// Whether displacements are; else everything stays where it is.
    pub moves: bool,
    /// Whether temperatures are.
    pub heat: Heat,
}

impl Physics {
    /// Temperatures alone.
    #[must_use]
    pub const fn heat(heat: Heat) -> Self {
        Self { moves: false, heat }
    }

    /// Displacements and temperatures.
    #[must_use]
    pub const fn coupled(heat: Heat) -> Self {
        Self { moves: true, heat }
    }

    /// A number for each: what is coupled differs between those that differ.
    #[must_use]
    pub const fn id(&self) -> u64 {
        2 * self.heat as u64 + self.moves as u64
    }

    /// Whether temperatures are unknown.
    #[must_use]
    pub fn has_heat(&self) -> bool {
        self.heat != Heat::Given
    }
}

/// Displacements alone.
impl Default for Physics {
    fn default() -> Self {
        Self::coupled(Heat::Given)
    }
}

/// Which stress the geometric stiffness of bodies takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GeometricStress {
    /// The predicted one in shells, and in other thin bodies where no contact has friction; else the current one.
    #[default]
    Auto,
    /// The stress that the last correction predicted from the linearized strains.
    Mixed,
    /// The stress of the iterate.
    Current,
}

/// The step a run is in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepContext {
    /// Number of the step, from 0.
    pub number: usize,
    /// Total time at its start.
    pub start: f64,
    /// Its duration.
    pub duration: f64,
    /// Whether displacements may be large.
    pub nonlinear: bool,
    /// How it goes through time, where inertia counts.
    pub scheme: Option<Scheme>,
    /// Whether nothing moves in it but small vibrations about the accepted state, which it leaves as it is: closed contact is
    /// joined as it was accepted, sticking in all directions and sliding across alone.
    pub vibrates: bool,
    /// What is unknown in it.
    pub physics: Physics,
    /// For how many cycles of wear it stands.
    pub cycles: f64,
    /// Which stress the geometric stiffness of bodies takes.
    pub geometric: GeometricStress,
}

impl StepContext {
    /// Whether a geometric stiffness may take a stress that a correction predicted: in static steps at finite strain.
    #[must_use]
    pub fn may_predict(&self) -> bool {
        let is_wanted = self.geometric != GeometricStress::Current;
        is_wanted && self.nonlinear && self.scheme.is_none() && !self.vibrates
    }

    /// Whether forces that have a potential do exactly the work of that.
    #[must_use]
    pub fn conserves(&self) -> bool {
        self.scheme.is_some_and(|scheme| scheme.conserves)
    }

    /// Whether forces at its short increments follow from the state alone.
    #[must_use]
    pub fn is_explicit(&self) -> bool {
        self.scheme.is_some_and(|scheme| scheme.explicit.is_some())
    }
}

/// The step before any begins.
impl Default for StepContext {
    fn default() -> Self {
        Self {
            number: 0,
            start: 0.0,
            duration: 1.0,
            nonlinear: true,
            scheme: None,
            vibrates: false,
            physics: Physics::default(),
            cycles: 1.0,
            geometric: GeometricStress::default(),
        }
    }
}

/// An increment of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increment {
    /// Its number within the step, from 1. Parts of an increment, and stages of slow motion, have the number of the whole.
    pub number: usize,
    /// Total time at its start.
    pub from: f64,
    /// Total time at its end.
    pub to: f64,
}

/// What begins: a step, or an increment of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Phase {
    /// The step.
    pub step: StepContext,
    /// The increment; `None` where the step begins, and no increment of it has.
    pub increment: Option<Increment>,
}

impl Phase {
    /// The begin of a step.
    #[must_use]
    pub const fn of_step(step: StepContext) -> Self {
        Self {
            step,
            increment: None,
        }
    }

    /// The begin of an increment of a step.
    #[must_use]
    pub const fn of_increment(step: StepContext, increment: Increment) -> Self {
        Self {
            step,
            increment: Some(increment),
        }
    }

    /// Δt, the time that the increment takes; 0 where a step begins, and in stages of slow motion after the first, in which no
    /// time passes.
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.increment.map_or(0.0, |of| of.to - of.from)
    }
}

#[cfg(test)]
mod tests {
    use super::{Increment, Phase, StepContext};

    #[test]
    fn time_passes_in_increments_alone() {
        let step = StepContext::default();
        assert_eq!(Phase::of_step(step).dt(), 0.0);
        let increment = Increment {
            number: 2,
            from: 0.25,
            to: 1.0,
        };
        assert_eq!(Phase::of_increment(step, increment).dt(), 0.75);
    }
}
