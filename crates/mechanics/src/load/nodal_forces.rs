use super::Schedule;
use super::course::Clock;
use crate::system::{
    Dof, Elimination, Layout, Order, Part, PatternSink, Phase, Properties, Role, Sink, State,
    Symmetry, Term, TermError, Work,
};

/// Forces on unknowns that keep their direction: on nodes, or on carriers (forces and moments).
#[derive(Clone, Debug)]
pub struct NodalForces {
    name: String,
    forces: Vec<Force>,
    clock: Clock,
    /// Steps in which a moment in space acts on a carrier that may turn about more than one axis.
    swivels: Vec<bool>,
}

#[derive(Clone, Copy, Debug)]
struct Force {
    dof: Dof,
    value: f64,
    /// Whether the unknown follows others: the force then has a stiffness, since its arm turns.
    follows: bool,
}

impl NodalForces {
    /// Forces on these unknowns, at full size, and their factor over time.
    #[must_use]
    pub fn new(name: impl Into<String>, forces: &[(Dof, f64)], schedule: Schedule) -> Self {
        let force = |&(dof, value): &(Dof, f64)| Force {
            dof,
            value,
            follows: false,
        };
        Self {
            name: name.into(),
            forces: forces.iter().map(force).collect(),
            clock: Clock::new(schedule),
            swivels: Vec::new(),
        }
    }

    /// The same where some unknowns follow others.
    #[must_use]
    pub fn following(mut self, elimination: &Elimination, layout: &Layout) -> Self {
        for force in &mut self.forces {
            force.follows = elimination.depends(force.dof, layout);
        }
        self
    }

    /// The same, with a moment on a carrier that may turn about more than one axis in the steps marked here. It then has
    /// no energy: what it spends depends on the way.
    #[must_use]
    pub fn swivelling(mut self, steps: Vec<bool>) -> Self {
        self.swivels = steps;
        self
    }

    fn swivels(&self) -> bool {
        let here = self.swivels.get(self.clock.number());
        self.clock.acts() && here.copied().unwrap_or(false)
    }
}

impl Term for NodalForces {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        // where a carrier stands still, the forces on it balance a moment, and their stiffness is not symmetric
        let symmetry = if self.swivels() {
            Symmetry::Unsymmetric
        } else {
            Symmetry::Definite
        };
        Properties::new(symmetry, Part::Interface).with_role(Role::Load)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        if self.clock.is_away() {
            return;
        }
        for force in self.forces.iter().filter(|f| f.follows) {
            out.interface(&[force.dof]);
        }
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        self.clock.begin_step(&phase.step);
        Ok(())
    }

    fn nchunk(&self) -> usize {
        1
    }

    fn evaluate(
        &self,
        _: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let factor = self.clock.factor(trial.time);
        if factor == 0.0 {
            return Ok(());
        }
        for force in &self.forces {
            // no stiffness of its own, but asked for: that of the turning arm comes with it
            let stiffness: &[f64] = match order {
                Order::Tangent if force.follows => &[0.0],
                _ => &[],
            };
            out.add(&[force.dof], &[-factor * force.value], stiffness);
        }
        Ok(())
    }

    fn energy(&self, _: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        if self.swivels() {
            return Ok(None);
        }
        let factor = self.clock.factor(trial.time);
        let value = |dof: Dof| trial.u.get(dof as usize).copied().unwrap_or(0.0);
        let work = self.forces.iter().map(|f| f.value * value(f.dof));
        Ok(Some(-factor * work.sum::<f64>()))
    }
}
