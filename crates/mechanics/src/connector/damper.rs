//! What holds a body that nothing but contact stops, until contact does; and what slows a jump.

use crate::system::{
    Archive, ArchiveError, Dof, Frame, Order, Part, PatternSink, Sink, State, Symmetry, Term,
    TermError, Verdict, Work,
};

/// Viscous forces on some unknowns, `f = k s (u − u_n)` with the displacement `u_n` at the start of the increment (E4).
/// Their work is reported.
pub struct Damper {
    name: String,
    /// Unknowns, and k of each.
    dofs: Vec<(Dof, f64)>,
    /// u_n, and how far from there the unknowns move freely.
    start: Vec<f64>,
    drift: Vec<f64>,
    strength: Strength,
    /// Whether it has begun or ceased to act since it was looked at.
    changed: bool,
    /// Forces that are of no account.
    negligible: f64,
    /// The sum of all forces where `start` was renewed last in this increment; infinite before that.
    renewed_at: f64,
    /// How often it was.
    renewals: u8,
    /// The work until then.
    work_before: f64,
    work: f64,
}

/// What is left of the largest force where renewing is worth it: a motion that nothing resists but a load drives is as fast each
/// time.
const RENEWED: f64 = 0.8;
/// Renewals that are made in any case: motions that contact resists bear next to nothing after them, whatever others do.
const ALWAYS: u8 = 3;
/// Renewals, at most.
const AT_MOST: u8 = 8;
/// By how much viscous forces are stronger where the iteration failed with them.
const BOOST: f64 = 30.0;
/// What all viscous forces together may bear in the end, over a force that is of no account: what is left falls by orders of
/// magnitude each time.
const BORNE: f64 = 1e-4;

/// How s comes about.
#[derive(Clone, Copy, Debug)]
enum Strength {
    /// When contact has settled, the solution is looked for without them, and they come back only where something flees: where
    /// contact holds the bodies they act no more. Where they stay, they are renewed until they bear nothing.
    UntilHeld {
        /// Whether they act, and whether they have to in this increment.
        acts: bool,
        needed: bool,
        /// By how much they are stronger, where the iteration failed with them.
        boost: f64,
    },
    /// As [`Term::damp`] says.
    Asked(f64),
}

/// Unknowns evaluated together.
const CHUNK: usize = 1024;

impl Damper {
    /// Viscous forces on these unknowns, with the stiffness of each, until contact holds them.
    #[must_use]
    pub fn until_held(name: impl Into<String>, dofs: Vec<(Dof, f64)>) -> Self {
        let strength = Strength::UntilHeld {
            acts: true,
            needed: false,
            boost: 1.0,
        };
        Self::new(name, dofs, strength)
    }

    /// Viscous forces on these unknowns, with the stiffness of each at strength 1, when they are asked for.
    #[must_use]
    pub fn when_asked(name: impl Into<String>, dofs: Vec<(Dof, f64)>) -> Self {
        Self::new(name, dofs, Strength::Asked(0.0))
    }

    fn new(name: impl Into<String>, dofs: Vec<(Dof, f64)>, strength: Strength) -> Self {
        Self {
            name: name.into(),
            start: vec![0.0; dofs.len()],
            drift: Vec::new(),
            dofs,
            strength,
            changed: false,
            negligible: 0.0,
            renewed_at: f64::INFINITY,
            renewals: 0,
            work_before: 0.0,
            work: 0.0,
        }
    }

    /// s.
    const fn strength(&self) -> f64 {
        match self.strength {
            Strength::UntilHeld {
                acts: true, boost, ..
            } => boost,
            Strength::UntilHeld { acts: false, .. } => 0.0,
            Strength::Asked(strength) => strength,
        }
    }

    fn chunk(&self, chunk: usize) -> impl Iterator<Item = (Dof, f64, f64)> {
        let strength = self.strength();
        let dofs = self.dofs.iter().zip(&self.start);
        let acting = if strength > 0.0 { CHUNK } else { 0 };
        dofs.skip(chunk * CHUNK)
            .take(acting)
            .map(move |(&(dof, stiffness), &start)| (dof, strength * stiffness, start))
    }

    /// Viscous forces bear nothing where contact holds the bodies: the rest position is moved to the state that was found with
    /// them, and the next is sought from there, which is the proximal point method. Says how large the force was, if so.
    fn renew(&mut self, state: &State) -> Option<f64> {
        if !matches!(self.strength, Strength::UntilHeld { acts: true, .. }) {
            return None;
        }
        let forces = (0..self.nchunk()).flat_map(|c| self.chunk(c));
        let forces = forces.map(|(dof, k, start)| (k * (value(state, dof) - start)).abs());
        let force: f64 = forces.sum();
        let is_stuck = self.renewals >= ALWAYS && force > RENEWED * self.renewed_at;
        if force <= BORNE * self.negligible || is_stuck || self.renewals >= AT_MOST {
            return None;
        }
        self.work_before += self.spent(state);
        self.renewed_at = force;
        self.renewals = self.renewals.saturating_add(1);
        for (start, &(dof, _)) in self.start.iter_mut().zip(&self.dofs) {
            *start = value(state, dof);
        }
        Some(force)
    }

    /// The work of the present increment, since it was renewed last.
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
        if matches!(self.strength, Strength::Asked(0.0)) {
            return;
        }
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

    fn begin_increment(&mut self, from: &State) -> Result<(), TermError> {
        (self.renewed_at, self.renewals, self.work_before) = (f64::INFINITY, 0, 0.0);
        for (start, &(dof, _)) in self.start.iter_mut().zip(&self.dofs) {
            let drift = self.drift.get(dof as usize).copied();
            *start = value(from, dof) + drift.unwrap_or_default();
        }
        Ok(())
    }

    fn prepare(&mut self, _: &State, _: Order) -> Result<bool, TermError> {
        Ok(std::mem::take(&mut self.changed))
    }

    fn is_outside(&self) -> bool {
        true
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

    fn let_pass(&mut self, force: f64) {
        self.negligible = force;
    }

    fn converged(&mut self, trial: &State) -> Result<Verdict, TermError> {
        Ok(match self.renew(trial) {
            None => Verdict::Settled,
            Some(force) => Verdict::Renewed {
                why: format!("viscous forces on {} bear {force:.2e}", self.name),
            },
        })
    }

    fn let_go(&mut self) -> bool {
        let Strength::UntilHeld {
            acts,
            needed: false,
            ..
        } = &mut self.strength
        else {
            return false;
        };
        std::mem::take(acts)
    }

    fn hold_again(&mut self) -> bool {
        let Strength::UntilHeld { acts, needed, .. } = &mut self.strength else {
            return false;
        };
        let back = !*acts;
        *acts = true;
        *needed |= back;
        back
    }

    fn rescue(&mut self) -> bool {
        let again = self.hold_again();
        let Strength::UntilHeld { needed, boost, .. } = &mut self.strength else {
            return false;
        };
        let stronger = *needed && !again && *boost == 1.0;
        if stronger {
            *boost = BOOST;
        }
        again || stronger
    }

    fn relent(&mut self) {
        if let Strength::UntilHeld { needed, boost, .. } = &mut self.strength {
            (*needed, *boost) = (false, 1.0);
        }
    }

    fn damp(&mut self, asked: f64, drift: &[f64]) -> bool {
        let Strength::Asked(strength) = &mut self.strength else {
            return false;
        };
        self.changed |= (*strength > 0.0) != (asked > 0.0);
        *strength = asked;
        self.drift.clear();
        self.drift.extend_from_slice(drift);
        true
    }

    fn work_stabilization(&self) -> f64 {
        self.work
    }

    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        self.work += self.work_before + self.spent(state);
        if let Strength::UntilHeld { needed, boost, .. } = &mut self.strength {
            (*needed, *boost) = (false, 1.0);
        }
        Ok(())
    }

    fn save(&self, out: &mut Archive) {
        let acts = matches!(self.strength, Strength::UntilHeld { acts: true, .. });
        let acts = f64::from(u8::from(acts));
        out.put(format!("damper.{}", self.name), &[self.work, acts]);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let mut stored = [0.0; 2];
        from.get(&format!("damper.{}", self.name), &mut stored)?;
        self.work = stored[0];
        if let Strength::UntilHeld { acts, needed, .. } = &mut self.strength {
            *acts = stored[1] != 0.0;
            *needed = false;
        }
        Ok(())
    }

    fn report(&self, _: &State, frame: &mut Frame) -> Result<(), TermError> {
        frame.work_stabilization += self.work;
        if matches!(self.strength, Strength::Asked(_)) {
            frame.work_jumps += self.work;
        }
        Ok(())
    }
}
