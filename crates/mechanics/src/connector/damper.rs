//! What holds a body that nothing but contact stops, until contact does.

use crate::system::{
    Archive, ArchiveError, Dof, Frame, Order, Part, PatternSink, Sink, State, StepContext,
    Symmetry, Term, TermError, Verdict, Work,
};

/// Viscous forces on some unknowns, `f = k s (u − u_n)` with the displacement `u_n` at the start of the increment (E4).
/// They fade over each step, `s = 1 − τ` with the part `τ` of the step that is over when the increment begins. A solution
/// that was found with them is looked for without them next, and they come back only where that fails: where contact
/// holds the bodies they act no more. Their work is reported.
pub struct Damper {
    name: String,
    /// Unknowns, and k of each.
    dofs: Vec<(Dof, f64)>,
    /// u_n.
    start: Vec<f64>,
    fading: f64,
    /// Whether they act, and whether they have to in this increment.
    acts: bool,
    needed: bool,
    step: StepContext,
    work: f64,
}

/// Unknowns evaluated together.
const CHUNK: usize = 1024;

impl Damper {
    /// Viscous forces on these unknowns, with the stiffness of each.
    #[must_use]
    pub fn new(name: impl Into<String>, dofs: Vec<(Dof, f64)>) -> Self {
        Self {
            name: name.into(),
            start: vec![0.0; dofs.len()],
            dofs,
            fading: 1.0,
            acts: true,
            needed: false,
            step: StepContext::default(),
            work: 0.0,
        }
    }

    fn chunk(&self, chunk: usize) -> impl Iterator<Item = (Dof, f64, f64)> {
        let dofs = self.dofs.iter().zip(&self.start).skip(chunk * CHUNK);
        let fading = if self.acts { self.fading } else { 0.0 };
        dofs.take(CHUNK)
            .map(move |(&(dof, stiffness), &start)| (dof, fading * stiffness, start))
    }

    /// The work of the present increment.
    fn spent(&self, state: &State) -> f64 {
        let energy = |(dof, stiffness, start): (Dof, f64, f64)| {
            let moved = value(state, dof) - start;
            stiffness * moved * moved
        };
        (0..self.nchunk())
            .flat_map(|c| self.chunk(c))
            .map(energy)
            .sum()
    }
}

fn value(state: &State, dof: Dof) -> f64 {
    state.u.get(dof as usize).copied().unwrap_or_default()
}

impl Term for Damper {
    fn name(&self) -> &str {
        &self.name
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for &(dof, _) in &self.dofs {
            out.interface(&[dof]);
        }
    }

    fn symmetry(&self) -> Symmetry {
        Symmetry::Definite
    }

    fn part(&self) -> Part {
        Part::Interface
    }

    fn begin_step(&mut self, step: &StepContext, _: &State) -> Result<(), TermError> {
        self.step = *step;
        Ok(())
    }

    fn begin_increment(&mut self, from: &State) -> Result<(), TermError> {
        let over = (from.time - self.step.start) / self.step.duration;
        self.fading = (1.0 - over).clamp(0.0, 1.0);
        for (start, &(dof, _)) in self.start.iter_mut().zip(&self.dofs) {
            *start = value(from, dof);
        }
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.dofs.len().div_ceil(CHUNK)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        for (dof, stiffness, start) in self.chunk(chunk) {
            let force = [stiffness * (value(trial, dof) - start)];
            match order {
                Order::Residual => out.add(&[dof], &force, &[]),
                Order::Tangent => out.add(&[dof], &force, &[stiffness]),
            }
        }
        Ok(())
    }

    fn energy(&self, chunk: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        let energy = |(dof, stiffness, start): (Dof, f64, f64)| {
            let moved = value(trial, dof) - start;
            0.5 * stiffness * moved * moved
        };
        Ok(Some(self.chunk(chunk).map(energy).sum()))
    }

    fn converged(&mut self, _: &State) -> Result<Verdict, TermError> {
        if !self.acts || self.needed {
            return Ok(Verdict::Settled);
        }
        self.acts = false;
        Ok(Verdict::Repeat {
            changes: 1,
            why: String::from("bodies that only contact holds were let go"),
            nodes: Vec::new(),
        })
    }

    fn rescue(&mut self) -> bool {
        let back = !self.acts;
        self.acts = true;
        self.needed |= back;
        back
    }

    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        self.work += self.spent(state);
        self.needed = false;
        Ok(())
    }

    fn save(&self, out: &mut Archive) {
        let acts = f64::from(u8::from(self.acts));
        out.put(format!("damper.{}", self.name), &[self.work, acts]);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let mut stored = [0.0; 2];
        from.get(&format!("damper.{}", self.name), &mut stored)?;
        self.work = stored[0];
        self.acts = stored[1] != 0.0;
        self.needed = false;
        Ok(())
    }

    fn report(&self, _: &State, frame: &mut Frame) -> Result<(), TermError> {
        frame.work_stabilization += self.work;
        Ok(())
    }
}
