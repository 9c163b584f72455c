//! What holds a body that nothing but contact stops, until contact does; and what slows a jump.

use crate::system::{
    Activity, Adaptive, Aid, Archive, ArchiveError, Capabilities, Choices, Course, Dof, DofName,
    Frame, Layout, Order, Part, PatternSink, Phase, Properties, Role, Sink, State, Stored,
    Symmetry, Term, TermError, Verdict, Viscous, Work,
};
use std::ops::Range;
use std::sync::Arc;

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
    /// The size up to which a force is negligible.
    negligible: f64,
    /// The sum of all forces where `start` was renewed last in this increment; infinite before that.
    renewed_at: f64,
    /// How often `start` was renewed in this increment.
    renewals: u8,
    /// The factor on the forces since then.
    weakened: f64,
    /// The bodies that they hold: their ranges of `dofs`, and their course.
    courses: Vec<(Range<usize>, Course)>,
    work: f64,
    /// Nodes that have no unknowns in some steps, as no element of theirs takes part there; `None` where all always have.
    idle: Option<(Layout, Arc<Activity>)>,
    /// The number of the step.
    step: usize,
    /// Whether inertia resists instead.
    rests: bool,
}

/// A load drives a motion that nothing resists so far where the forces have not fallen to this part since the last renewal.
const RENEWED: f64 = 0.3;
/// What they are multiplied with then, so that the next solution goes farther.
const WEAKER: f64 = 0.1;
/// The number of renewals before that: after them, motions that contact resists carry almost no viscous force.
const ALWAYS: u8 = 2;
/// The factor on viscous forces in a second attempt, after an iteration with them has failed.
const BOOST: f64 = 30.0;

/// How s comes about.
#[derive(Clone, Copy, Debug)]
enum Strength {
    /// Once contact has settled they are removed, and restored where the bodies then move away. Where contact holds the bodies,
    /// they do not act any more; where they have to stay, they are renewed until their forces are negligible.
    UntilHeld {
        /// Whether they act, and whether they have to in this increment.
        acts: bool,
        needed: bool,
        /// The factor on them: above one after an iteration with them has failed.
        boost: f64,
    },
    /// As [`Viscous::damp`] says.
    Asked(f64),
}

/// Unknowns evaluated together.
const CHUNK: usize = 1024;

impl Damper {
    /// Viscous forces on these bodies, until contact holds them.
    #[must_use]
    pub fn until_held(name: impl Into<String>, bodies: Vec<Course>) -> Self {
        let strength = Strength::UntilHeld {
            acts: true,
            needed: false,
            boost: 1.0,
        };
        let mut dofs = Vec::new();
        let mut courses = Vec::with_capacity(bodies.len());
        for body in bodies {
            let first = dofs.len();
            dofs.extend(body.damped());
            courses.push((first..dofs.len(), body));
        }
        Self::new(name, dofs, courses, strength)
    }

    /// Viscous forces on these unknowns, with the stiffness of each at strength 1, when they are asked for.
    #[must_use]
    pub fn when_asked(name: impl Into<String>, dofs: Vec<(Dof, f64)>) -> Self {
        let all = (0..dofs.len(), Course::new("", 0.0, Vec::new()));
        Self::new(name, dofs, vec![all], Strength::Asked(0.0))
    }

    fn new(
        name: impl Into<String>,
        dofs: Vec<(Dof, f64)>,
        courses: Vec<(Range<usize>, Course)>,
        strength: Strength,
    ) -> Self {
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
            weakened: 1.0,
            courses,
            work: 0.0,
            idle: None,
            step: 0,
            rests: false,
        }
    }

    /// The same without forces at nodes of which no element takes part in a step.
    #[must_use]
    pub fn without_idle(mut self, layout: Layout, activity: Arc<Activity>) -> Self {
        self.idle = (!activity.is_empty()).then_some((layout, activity));
        self
    }

    /// Whether an unknown is there in the present step.
    fn is_there(&self, dof: Dof) -> bool {
        self.idle.as_ref().is_none_or(|(layout, activity)| {
            let node = layout.name(dof).and_then(DofName::displacement);
            node.is_none_or(|(node, _)| !activity.is_idle(node, self.step))
        })
    }

    /// s.
    const fn strength(&self) -> f64 {
        match self.strength {
            _ if self.rests => 0.0,
            Strength::UntilHeld {
                acts: true, boost, ..
            } => boost * self.weakened,
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
            .filter(|((dof, _), _)| self.is_there(*dof))
            .map(move |(&(dof, stiffness), &start)| (dof, strength * stiffness, start))
    }

    /// Moves the rest position to the state that was found, so that the next solution starts from there: the proximal point
    /// method, whose limit has no viscous forces where contact holds the bodies. Returns the sum of the forces, if it does: as
    /// long as that is not negligible. Where a load drives a motion that nothing resists, the forces become weaker, up to where
    /// something does; where nothing ever does, the iteration fails.
    fn renew(&mut self, state: &State) -> Option<f64> {
        if self.rests || !matches!(self.strength, Strength::UntilHeld { acts: true, .. }) {
            return None;
        }
        let forces = (0..self.nchunk()).flat_map(|c| self.chunk(c));
        let forces = forces.map(|(dof, k, start)| (k * (value(state, dof) - start)).abs());
        let force: f64 = forces.sum();
        if force <= self.negligible {
            return None;
        }
        let is_driven = self.renewals >= ALWAYS && force > RENEWED * self.renewed_at;
        self.spend(state);
        if is_driven {
            self.weakened *= WEAKER;
        }
        self.renewed_at = force;
        self.renewals = self.renewals.saturating_add(1);
        for (start, &(dof, _)) in self.start.iter_mut().zip(&self.dofs) {
            *start = value(state, dof);
        }
        Some(force)
    }

    /// Adds the work since the last renewal to that of the increment, body by body.
    fn spend(&mut self, state: &State) {
        let strength = self.strength();
        if strength == 0.0 {
            return;
        }
        for (range, course) in &mut self.courses {
            let dofs = self.dofs.get(range.clone()).unwrap_or_default();
            let starts = self.start.get(range.clone()).unwrap_or_default();
            let of_dof = |(&(dof, stiffness), &start): (&(Dof, f64), &f64)| {
                let moved = value(state, dof) - start;
                stiffness * moved * moved
            };
            let work: f64 = dofs.iter().zip(starts).map(of_dof).sum();
            course.spend(strength * work);
        }
    }
}

fn value(state: &State, dof: Dof) -> f64 {
    state.u.get(dof as usize).copied().unwrap_or_default()
}

impl Term for Damper {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        Properties::new(Symmetry::Definite, Part::Interface).with_role(Role::Support)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        if self.rests || matches!(self.strength, Strength::Asked(0.0)) {
            return;
        }
        for &(dof, _) in self.dofs.iter().filter(|(dof, _)| self.is_there(*dof)) {
            out.interface(&[dof]);
        }
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        self.step = phase.step.number;
        self.rests = phase.step.scheme.is_some();
        if phase.increment.is_none() {
            return Ok(());
        }
        (self.renewed_at, self.renewals) = (f64::INFINITY, 0);
        self.weakened = 1.0;
        for (_, course) in &mut self.courses {
            course.begin(from);
        }
        for (start, &(dof, _)) in self.start.iter_mut().zip(&self.dofs) {
            let drift = self.drift.get(dof as usize).copied();
            *start = value(from, dof) + drift.unwrap_or_default();
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

    fn report(&self, _: &State, frame: &mut Frame) -> Result<(), TermError> {
        frame.work_stabilization += self.work;
        if matches!(self.strength, Strength::Asked(_)) {
            frame.work_jumps += self.work;
        }
        Ok(())
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            stored: Some(self),
            viscous: Some(self),
            ..Capabilities::default()
        }
    }

    fn adaptive(&mut self) -> Option<&mut dyn Adaptive> {
        Some(self)
    }

    fn stored(&mut self) -> Option<&mut dyn Stored> {
        Some(self)
    }
}

impl Adaptive for Damper {
    fn prepare(&mut self, _: &State, _: Order) -> Result<bool, TermError> {
        Ok(std::mem::take(&mut self.changed))
    }

    fn converged(&mut self, trial: &State) -> Result<Verdict, TermError> {
        Ok(match self.renew(trial) {
            None => Verdict::Settled,
            Some(force) => Verdict::Renewed {
                why: format!("viscous forces on {} bear {force:.2e}", self.name),
            },
        })
    }

    fn aid(&mut self, aid: Aid) -> bool {
        let Strength::UntilHeld {
            acts,
            needed,
            boost,
            ..
        } = &mut self.strength
        else {
            return false;
        };
        if self.rests {
            return false;
        }
        match aid {
            Aid::Remove => !*needed && std::mem::take(acts),
            Aid::Restore | Aid::Safer => {
                let back = !std::mem::replace(acts, true);
                *needed |= back;
                let stronger = aid == Aid::Safer && *needed && !back && *boost == 1.0;
                if stronger {
                    *boost = BOOST;
                }
                back || stronger
            }
            Aid::Usual => {
                let changes = *needed || *boost != 1.0;
                (*needed, *boost) = (false, 1.0);
                changes
            }
        }
    }

    fn set_negligible(&mut self, force: f64) {
        self.negligible = force;
    }

    fn choices(&mut self) -> Option<&mut dyn Choices> {
        None
    }

    fn viscous(&mut self) -> Option<&mut dyn Viscous> {
        Some(self)
    }
}

impl Viscous for Damper {
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

    fn work(&self) -> f64 {
        self.work
    }

    fn courses(&self) -> Box<dyn Iterator<Item = &Course> + '_> {
        Box::new(self.courses.iter().map(|(_, course)| course))
    }
}

impl Stored for Damper {
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        self.spend(state);
        let works = self.courses.iter().map(|(_, course)| course.work());
        self.work += works.sum::<f64>();
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
}
