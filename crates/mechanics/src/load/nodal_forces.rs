use crate::system::{
    Dof, Order, Part, PatternSink, Sink, State, StepContext, Symmetry, Term, TermError, Work,
};

/// Forces on unknowns that keep their direction: on nodes, or on rigid bodies (forces and moments).
#[derive(Clone, Debug)]
pub struct NodalForces {
    dofs: Vec<Dof>,
    /// Values at the end of each step, one row for each step.
    ends: Vec<Vec<f64>>,
    from: Vec<f64>,
    to: Vec<f64>,
    start: f64,
    duration: f64,
}

impl NodalForces {
    /// Forces on these unknowns; `ends[s][i]` is what acts on `dofs[i]` at the end of step `s`.
    #[must_use]
    pub fn new(dofs: Vec<Dof>, ends: Vec<Vec<f64>>) -> Self {
        let zero = vec![0.0; dofs.len()];
        Self {
            dofs,
            ends,
            from: zero.clone(),
            to: zero,
            start: 0.0,
            duration: 1.0,
        }
    }

    /// (E1)
    fn at(&self, time: f64) -> impl Iterator<Item = f64> + '_ {
        let fraction = ((time - self.start) / self.duration).clamp(0.0, 1.0);
        let ends = self.from.iter().zip(&self.to);
        ends.map(move |(a, b)| a + (b - a) * fraction)
    }
}

impl Term for NodalForces {
    fn name(&self) -> &str {
        "loads"
    }

    fn pattern(&self, _: &mut dyn PatternSink) {}

    fn symmetry(&self) -> Symmetry {
        Symmetry::Definite
    }

    fn part(&self) -> Part {
        Part::Interface
    }

    fn begin_step(&mut self, step: &StepContext, _: &State) -> Result<(), TermError> {
        let before = step.number.checked_sub(1).and_then(|s| self.ends.get(s));
        match before {
            Some(values) => self.from.clone_from(values),
            None => self.from.fill(0.0),
        }
        if let Some(values) = self.ends.get(step.number) {
            self.to.clone_from(values);
        }
        self.start = step.start;
        self.duration = step.duration;
        Ok(())
    }

    fn nchunk(&self) -> usize {
        1
    }

    fn evaluate(
        &self,
        _: usize,
        trial: &State,
        _: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        for (dof, force) in self.dofs.iter().zip(self.at(trial.time)) {
            out.add(&[*dof], &[-force], &[]);
        }
        Ok(())
    }

    fn energy(&self, _: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        let value = |dof: Dof| trial.u.get(dof as usize).copied().unwrap_or(0.0);
        let forces = self.dofs.iter().zip(self.at(trial.time));
        Ok(Some(forces.map(|(d, f)| -f * value(*d)).sum()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Elimination, Layout};
    use signorini_geometry::tensor::Vec3;

    #[derive(Default)]
    struct Sum(Vec<(Dof, f64)>);

    impl Sink for Sum {
        fn add(&mut self, dofs: &[Dof], force: &[f64], _: &[f64]) {
            self.0.push((dofs[0], force[0]));
        }
    }

    #[test]
    fn a_load_ramps_from_step_to_step_and_its_force_is_the_gradient_of_its_energy() {
        let mut load = NodalForces::new(vec![1], vec![vec![10.0], vec![4.0]]);
        let layout = Layout {
            ndim: 2,
            nnode: 1,
            nrigid: 0,
            nmultiplier: 0,
        };
        let mut state = State::initial(&layout, &[Vec3::ZERO], &Elimination::default());
        for (number, start, time, expected) in
            [(0, 0.0, 0.25, 5.0), (1, 0.5, 0.75, 7.0), (1, 0.5, 1.0, 4.0)]
        {
            let step = StepContext {
                number,
                start,
                duration: 0.5,
                nonlinear: true,
            };
            load.begin_step(&step, &state).unwrap();
            state.time = time;
            let mut sum = Sum::default();
            load.evaluate(0, &state, Order::Residual, &mut Work::default(), &mut sum)
                .unwrap();
            assert_eq!(sum.0, [(1, -expected)]);
            state.u[1] = 2.0;
            let energy = load.energy(0, &state, &mut Work::default()).unwrap();
            assert_eq!(energy, Some(-2.0 * expected));
        }
    }
}
