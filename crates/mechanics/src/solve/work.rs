//! The work of external forces: of supports and loads.

use crate::system::{
    Archive, ArchiveError, Dof, Order, Role, Sink, State, System, Term, TermError, Work,
};

/// Work that supports and loads have done since the start of a run.
///
/// From one accepted state to the next, it is the motion times the mean of the forces at both: exact where forces are
/// linear in the motion, of second order elsewhere. Where inertia counts, it is the motion times the forces between both, of loads with
/// a potential the difference of that. Supports count where dofs are prescribed in the present step: the force of a support that is
/// removed does no work.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ExternalWork {
    /// Force times length; of a moment and a rotation, likewise.
    pub total: f64,
    /// The sum of the absolute values of the work of each increment, to which fractions refer: loads may return work.
    pub turnover: f64,
    /// What supports and loads exert at the last accepted state, at every raw dof; empty before the first.
    supports: Vec<f64>,
    loads: Vec<f64>,
    /// Memory for what loads exert next.
    next: Loads,
}

/// The names under which forces are stored.
const STORED: [&str; 2] = ["progress.supports", "progress.loads"];

impl ExternalWork {
    /// Adds the work on the way from the accepted state `from` to the one `to`, at which `residual` was assembled, or at the one
    /// between them.
    ///
    /// # Errors
    /// A load that cannot be evaluated.
    pub fn advance(
        &mut self,
        system: &System,
        prescribed: &[bool],
        residual: &[f64],
        [from, to]: [&State; 2],
        between: Option<&State>,
    ) -> Result<(), TermError> {
        let ndof = system.layout.ndof();
        let mut loads = Loads(vec![0.0; ndof]);
        let mut counted = Loads(vec![0.0; ndof]);
        let mut work = Work::default();
        let loading = || {
            let terms = system.terms.iter();
            terms.filter(|term| term.properties().role == Role::Load)
        };
        // what has a potential does the work of that, under the loads in force between the ends
        let is_loaded = loading().next().is_some();
        let ends = between.filter(|_| is_loaded).map(|middle| {
            [from, to].map(|end| State {
                time: middle.time,
                rates: None,
                ..end.clone()
            })
        });
        let mut done = 0.0;
        for term in loading() {
            let potentials = match &ends {
                Some([from, to]) => potential(term.as_ref(), from, &mut work)?.zip(potential(
                    term.as_ref(),
                    to,
                    &mut work,
                )?),
                None => None,
            };
            let forces = match potentials {
                Some((before, after)) => {
                    done += before - after;
                    &mut counted
                }
                None => &mut loads,
            };
            for chunk in 0..term.nchunk() {
                let at = between.unwrap_or(to);
                term.evaluate(chunk, at, Order::Residual, &mut work, forces)?;
            }
        }
        let reaction = |(&prescribed, &r): (&bool, &f64)| if prescribed { r } else { 0.0 };
        let supports: Vec<f64> = prescribed.iter().zip(residual).map(reaction).collect();
        if between.is_some() {
            (self.supports, self.loads) = (supports.clone(), loads.0.clone());
        }
        self.supports.resize(supports.len(), 0.0);
        self.loads.resize(ndof, 0.0);
        let mut work = done;
        let motions = to.u.iter().zip(&from.u).take(system.layout.nmotion());
        for (dof, (now, before)) in motions.enumerate() {
            let at = |forces: &[f64]| forces.get(dof).copied().unwrap_or_default();
            let mut force = at(&loads.0) + at(&self.loads);
            if prescribed.get(dof).copied().unwrap_or_default() {
                force += at(&supports) + at(&self.supports);
            }
            work += 0.5 * force * (now - before);
        }
        self.total += work;
        self.turnover += work.abs();
        for (all, one) in loads.0.iter_mut().zip(counted.0) {
            *all += one;
        }
        (self.supports, self.loads) = (supports, loads.0);
        Ok(())
    }

    /// What loads and supports exert on an unknown at the last accepted state.
    pub fn exerted(&self, dof: Dof) -> [f64; 2] {
        let at = |forces: &[f64]| forces.get(dof as usize).copied().unwrap_or_default();
        [at(&self.loads), at(&self.supports)]
    }

    /// Takes note of the forces at a state where an explicit step begins.
    ///
    /// # Errors
    /// A load that cannot be evaluated.
    pub fn leave(
        &mut self,
        system: &System,
        prescribed: &[bool],
        residual: &[f64],
        state: &State,
    ) -> Result<(), TermError> {
        let still = vec![0.0; system.layout.nmotion()];
        let turnover = self.turnover;
        self.leap(system, prescribed, residual, state, &still)?;
        self.turnover = turnover;
        Ok(())
    }

    /// Adds the work in a short increment of an explicit step, in which the unknowns move by `du`, up to a state at which
    /// `residual` was assembled. Allocates nothing after the first.
    ///
    /// # Errors
    /// A load that cannot be evaluated.
    pub fn leap(
        &mut self,
        system: &System,
        prescribed: &[bool],
        residual: &[f64],
        to: &State,
        du: &[f64],
    ) -> Result<(), TermError> {
        let nmotion = system.layout.nmotion();
        self.supports.resize(system.layout.ndof(), 0.0);
        self.loads.resize(system.layout.ndof(), 0.0);
        let mut done = 0.0;
        let terms = system.terms.iter();
        let loading = || {
            terms
                .clone()
                .filter(|term| term.properties().role == Role::Load)
        };
        if loading().next().is_some() {
            self.next.0.clear();
            self.next.0.resize(system.layout.ndof(), 0.0);
            let mut work = Work::default();
            for term in loading() {
                for chunk in 0..term.nchunk() {
                    term.evaluate(chunk, to, Order::Residual, &mut work, &mut self.next)?;
                }
            }
            let forces = self.loads.iter().zip(&self.next.0).zip(du).take(nmotion);
            done += forces
                .map(|((old, new), du)| 0.5 * (old + new) * du)
                .sum::<f64>();
            std::mem::swap(&mut self.loads, &mut self.next.0);
        }
        let reactions = self
            .supports
            .iter_mut()
            .zip(residual)
            .zip(du)
            .zip(prescribed);
        for (((old, new), du), _) in reactions.take(nmotion).filter(|(_, held)| **held) {
            done += 0.5 * (*old + new) * du;
            *old = *new;
        }
        self.total += done;
        self.turnover += done.abs();
        Ok(())
    }

    /// Stores it: of forces those that are not zero, dof and value.
    pub fn save(&self, out: &mut Archive) {
        out.put("progress.work", &[self.total, self.turnover]);
        for (name, forces) in STORED.iter().zip([&self.supports, &self.loads]) {
            let acting = forces.iter().enumerate().filter(|(_, f)| **f != 0.0);
            let pairs: Vec<f64> = acting.flat_map(|(dof, f)| [dof as f64, *f]).collect();
            out.put(*name, &pairs);
        }
    }

    /// Takes it back; nothing has been done where the archive is of a version that does not know of it.
    ///
    /// # Errors
    /// An array that is not there.
    pub fn load(&mut self, ndof: usize, from: &Archive) -> Result<(), ArchiveError> {
        *self = Self::default();
        let mut sums = [0.0; 2];
        if from.length("progress.work").is_err() {
            return Ok(());
        }
        from.get("progress.work", &mut sums)?;
        [self.total, self.turnover] = sums;
        for (name, forces) in STORED.iter().zip([&mut self.supports, &mut self.loads]) {
            let mut pairs = vec![0.0; from.length(name)?];
            from.get(name, &mut pairs)?;
            forces.resize(ndof, 0.0);
            for &[dof, force] in pairs.as_chunks().0 {
                if let Some(to) = forces.get_mut(dof as usize) {
                    *to = force;
                }
            }
        }
        Ok(())
    }
}

/// The potential of a load at a state; none where it has none.
fn potential(term: &dyn Term, state: &State, work: &mut Work) -> Result<Option<f64>, TermError> {
    let mut total = 0.0;
    for chunk in 0..term.nchunk() {
        match term.energy(chunk, state, work)? {
            Some(energy) => total += energy,
            None => return Ok(None),
        }
    }
    Ok(Some(total))
}

/// Takes what loads exert: the residual has it with the other sign.
#[derive(Clone, Debug, Default, PartialEq)]
struct Loads(Vec<f64>);

impl Sink for Loads {
    fn add(&mut self, dofs: &[Dof], force: &[f64], _: &[f64]) {
        for (&dof, f) in dofs.iter().zip(force) {
            if let Some(to) = self.0.get_mut(dof as usize) {
                *to -= f;
            }
        }
    }

    fn add_symmetric(&mut self, dofs: &[Dof], force: &[f64], _: &[f64], _: usize) {
        self.add(dofs, force, &[]);
    }

    fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}
