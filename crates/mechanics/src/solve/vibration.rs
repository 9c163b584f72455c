//! Natural frequencies and modes about an accepted state: `K φ = ω² M φ`.
//!
//! `K` is the stiffness of all terms there, with that of stresses and loads, and with contact as it was accepted; `M` that of
//! [`Role::Inertia`](crate::system::Role). Viscous forces count for nothing. Of a stiffness that is not symmetric the symmetric part is
//! taken, `½ (K + Kᵀ)`, and [`Vibrations::asymmetry`] says how large the rest is.
//!
//! ```text
//! Γ_a = φ·M e_a    m_a = Γ_a²,  Σ m_a ≤ e_a·M e_a                                                  (E5)
//! ```
//!
//! with the motion `e_a` of everything by 1 along axis a.

use super::event::{Event, Flow, Observer};
use super::natural::{NaturalMode, Vibrations};
use super::newton::{Failure, Newton};
use super::step::{Step, Vibration};
use super::stepping::{Outcome, RunError, Stepper};
use crate::system::{Assembly, Dof, DofName, FieldId, Increment, Phase, Role, State, System, Term};
use signorini_linear::{LinearError, Mode, Modes, Wanted, lowest_modes};
use std::f64::consts::TAU;

impl Stepper {
    /// Finds natural modes, and hands them to the observer. The state stays as it is.
    pub(super) fn vibrate(
        &mut self,
        system: &mut System,
        step: &Step,
        wanted: &Vibration,
        observer: &mut dyn Observer,
    ) -> Result<Outcome, RunError> {
        let found = self.newton.vibrations(system, &self.state, wanted);
        let found = found.map_err(|cause| self.not_begun(step, cause))?;
        let event = Event::Vibrations {
            step: self.progress.step,
            time: self.state.time,
            found: &found,
        };
        let flow = observer.notice(&event);
        if !found.have_converged() {
            let converged = found.modes.iter().filter(|mode| mode.has_converged);
            return Err(RunError::Modes {
                step: step.name.clone(),
                found: converged.count(),
                wanted: wanted.count,
            });
        }
        Ok(match flow {
            Flow::Stop => Outcome::Stopped,
            Flow::Continue => Outcome::Finished,
        })
    }
}

impl Newton {
    /// The natural modes at an accepted state.
    ///
    /// # Errors
    /// Terms that cannot be evaluated there, equations without a solution.
    fn vibrations(
        &mut self,
        system: &mut System,
        state: &State,
        wanted: &Vibration,
    ) -> Result<Vibrations, Failure> {
        let increment = Increment {
            number: 1,
            from: state.time,
            to: state.time,
        };
        let phase = Phase::of_increment(self.step, increment);
        for term in &mut system.terms {
            term.begin(&phase, state)?;
        }
        self.look_at(system, state)?;
        let found = self.modes(system, wanted);
        system.reject();
        self.let_go();
        let (found, mass, asymmetry) = found?;
        let to = wanted.to.map_or(f64::INFINITY, eigenvalue);
        let kept = found.modes.iter().filter(|mode| mode.eigenvalue <= to);
        let modes = kept.map(|mode| self.natural(system, state, mode, &mass));
        Ok(Vibrations {
            modes: modes.collect(),
            is_counted: found.is_counted,
            mass: [0, 1, 2].map(|axis| {
                let moved = direction(system, axis);
                let of_axis = mass.get(axis).map_or(&[][..], |m| m);
                moved.iter().zip(of_axis).map(|(e, m)| e * m).sum()
            }),
            asymmetry,
            effort: [found.solves, found.factors],
        })
    }

    /// The modes, what M makes of a motion along each axis, and the asymmetry of the stiffness.
    fn modes(
        &mut self,
        system: &System,
        wanted: &Vibration,
    ) -> Result<(Modes, [Vec<f64>; 3], f64), Failure> {
        let System {
            layout,
            elimination,
            terms,
            ..
        } = system;
        let mut mass = Assembly::default();
        if self.assembler.take_all_rows(layout, elimination, terms) {
            self.analyzed = false;
        }
        let (assembler, stiffness) = (&mut self.assembler, &mut self.assembly);
        let trial = &self.trial;
        let has_mass = |term: &dyn Term| term.properties().role == Role::Inertia;
        let is_viscous = |term: &dyn Term| term.capabilities().viscous.is_some();
        let is_elastic = |term: &dyn Term| !has_mass(term) && !is_viscous(term);
        assembler.assemble_of(layout, elimination, terms, trial, is_elastic, stiffness)?;
        assembler.assemble_of(layout, elimination, terms, trial, has_mass, &mut mass)?;
        let asymmetry = assembler.symmetrize(stiffness);
        let of_axis = |axis: usize| {
            let moved = direction(system, axis);
            let mut product = vec![0.0; layout.ndof()];
            let (bulk, interface) = (assembler.bulk(), assembler.interface());
            signorini_linear::apply(bulk, interface, &mass.values(), &moved, &mut product);
            product
        };
        let along = [0, 1, 2].map(of_axis);
        let fields = self.equations.number(system, assembler, &self.prescribed);
        let wanted = Wanted {
            count: wanted.count,
            from: wanted.from.filter(|from| *from > 0.0).map(eigenvalue),
        };
        let solve = |stiffness: &Assembly| {
            let problem = self.equations.symmetric(system, assembler, &fields);
            lowest_modes(&problem, [stiffness.values(), mass.values()], wanted)
        };
        let mut outcome = solve(stiffness);
        if matches!(outcome, Err(LinearError::Singular { .. }))
            && assembler.relax(layout, stiffness) > 0
        {
            outcome = solve(stiffness);
        }
        let found = outcome.map_err(|source| self.linear_failure(source))?;
        Ok((found, along, asymmetry))
    }

    /// A mode with the motions of all nodes.
    fn natural(
        &self,
        system: &System,
        state: &State,
        mode: &Mode,
        mass: &[Vec<f64>; 3],
    ) -> NaturalMode {
        let mut rates = vec![0.0; system.layout.ndof()];
        for (&dof, value) in self.equations.dofs().iter().zip(&mode.shape) {
            if let Some(rate) = rates.get_mut(dof as usize) {
                *rate = *value;
            }
        }
        let product = |of_axis: &Vec<f64>| rates.iter().zip(of_axis).map(|(x, m)| x * m).sum();
        let shape = system.nodal_rates(state, &rates);
        NaturalMode {
            eigenvalue: mode.eigenvalue,
            residual: mode.residual,
            has_converged: mode.has_converged(),
            participation: mass.each_ref().map(product),
            shape: shape.iter().map(|u| u.to_array()).collect(),
        }
    }
}

/// λ of a frequency in cycles per time.
fn eigenvalue(frequency: f64) -> f64 {
    (TAU * frequency).powi(2)
}

/// The motion of everything by 1 along an axis.
fn direction(system: &System, axis: usize) -> Vec<f64> {
    let layout = &system.layout;
    let mut moved = vec![0.0; layout.ndof()];
    for (dof, value) in moved.iter_mut().enumerate() {
        let name = layout.name(dof as Dof);
        let moves = name.is_some_and(|name: DofName| {
            let is_motion = matches!(name.field, FieldId::DISPLACEMENT | FieldId::TRANSLATION);
            is_motion && name.component == axis
        });
        *value = f64::from(u8::from(moves));
    }
    moved
}
