use super::internal_forces::internal_forces;
use super::{
    Adaptive, Aid, Archive, ArchiveError, Assembly, Choices, ContactAudit, Dof, Elimination,
    FieldId, Frame, FreeMotion, Layout, NodalValues, Samples, State, Term, TermError, Wanted,
};
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// Everything that is solved together.
pub struct System {
    /// Which unknown is which.
    pub layout: Layout,
    /// Positions of the nodes at the start.
    pub reference: Arc<[Vec3]>,
    /// Which unknowns follow others.
    pub elimination: Arc<Elimination>,
    /// What exerts forces. A program may add terms of its own before it makes a stepper.
    pub terms: Vec<Box<dyn Term>>,
    /// The same positions, as solvers take them.
    pub coordinates: Vec<[f64; 3]>,
    /// The body each node belongs to.
    pub body: Vec<u32>,
    /// The corners that each node of quadratic elements is halfway between, as solvers take them.
    pub between: Vec<[u32; 2]>,
    /// Cells of each block of the mesh, for frames.
    pub ncell: Vec<usize>,
    /// What frames have besides.
    pub wanted: Wanted,
}

impl System {
    /// The undeformed state.
    #[must_use]
    pub fn initial_state(&self) -> State {
        State::initial(&self.layout, &self.reference, &self.elimination)
    }

    /// The terms that change for the sake of an iteration.
    pub fn adaptive(&mut self) -> impl Iterator<Item = &mut dyn Adaptive> {
        let terms = self.terms.iter_mut();
        terms.filter_map(|term| term.adaptive())
    }

    /// The terms that make discrete choices.
    pub fn choices(&self) -> impl Iterator<Item = &dyn Choices> {
        let terms = self.terms.iter();
        terms.filter_map(|term| term.capabilities().choices)
    }

    /// The same, to be changed.
    pub fn choices_mut(&mut self) -> impl Iterator<Item = &mut dyn Choices> {
        let terms = self.terms.iter_mut();
        terms.filter_map(|term| term.adaptive()?.choices())
    }

    /// Changes how all terms help an iteration on; returns whether one changed.
    pub fn aid(&mut self, aid: Aid) -> bool {
        self.adaptive().fold(false, |any, term| any | term.aid(aid))
    }

    /// Takes all terms back to their last accepted choices and history.
    pub fn reject(&mut self) {
        self.choices_mut().for_each(Choices::reject);
    }

    /// An increment is done: the histories of all terms move on.
    ///
    /// # Errors
    /// What a term finds wrong with the state.
    pub fn accept(&mut self, state: &State) -> Result<(), TermError> {
        let terms = self.terms.iter_mut();
        let mut stored = terms.filter_map(|term| term.stored());
        stored.try_for_each(|term| term.accept(state))
    }

    /// Stores the histories of all terms.
    pub fn save(&self, out: &mut Archive) {
        let terms = self.terms.iter();
        let stored = terms.filter_map(|term| term.capabilities().stored);
        stored.for_each(|term| term.save(out));
    }

    /// Takes the histories of all terms back.
    ///
    /// # Errors
    /// The archive belongs to another model.
    pub fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let terms = self.terms.iter_mut();
        let mut stored = terms.filter_map(|term| term.stored());
        stored.try_for_each(|term| term.load(from))
    }

    /// Makes `trial` the state `base` advanced by `alpha · du`.
    pub fn advance(&self, trial: &mut State, base: &State, du: &[f64], alpha: f64) {
        let (layout, reference) = (&self.layout, &self.reference);
        trial.advance_from(base, du, alpha, layout, reference, &self.elimination);
    }

    /// The results at an accepted state: motions, what every term reports, and the reactions at the prescribed dofs,
    /// from the assembly at that state.
    ///
    /// # Errors
    /// A term that cannot evaluate the state.
    pub fn report(
        &self,
        state: &State,
        prescribed: &[bool],
        assembly: &Assembly,
    ) -> Result<Frame, TermError> {
        let mut frame = Frame::new(self.layout.nnode(), &self.ncell);
        frame.time = state.time;
        for (node, u) in frame.displacement.iter_mut().enumerate() {
            *u = self.displacement(state, node as u32);
        }
        let layout = &self.layout;
        frame.rigid.resize_with(layout.nrigid(), Default::default);
        let at_dofs = prescribed.iter().zip(&assembly.residual).enumerate();
        for (dof, (_, r)) in at_dofs.filter(|(_, (prescribed, _))| **prescribed) {
            let Some(name) = layout.name(dof as Dof) else {
                continue;
            };
            let body = frame.rigid.get_mut(name.entity as usize);
            let to = match name.field {
                FieldId::DISPLACEMENT => frame.reaction_force.get_mut(name.entity as usize),
                FieldId::TRANSLATION => body.map(|body| &mut body.reaction_force),
                FieldId::ROTATION => body.map(|body| &mut body.reaction_moment),
                _ => None,
            };
            if let Some(to) = to {
                to[name.component] = *r;
            }
        }
        frame.fields = self.nodal_values(state, prescribed, &assembly.residual);
        let value = |dof: Dof| state.u.get(dof as usize).copied().unwrap_or(0.0);
        for (body, rigid) in frame.rigid.iter_mut().enumerate() {
            let body = body as u32;
            for axis in 0..3 {
                rigid.displacement[axis] = value(layout.translation(body, axis));
                rigid.rotation[axis] = value(layout.rotation(body, axis));
            }
        }
        for term in &self.terms {
            term.report(state, &mut frame)?;
        }
        frame.audits = self.audit(state, &frame);
        frame.free_motions = self.free_motions(state, &frame);
        frame.samples = samples_of(&self.terms, state, &self.wanted.cells)?;
        if self.wanted.forces {
            frame.internal_force = internal_forces(&self.terms, &self.layout, state)?;
        }
        Ok(frame)
    }

    /// The fields of the nodes besides the displacement.
    fn nodal_values(
        &self,
        state: &State,
        prescribed: &[bool],
        residual: &[f64],
    ) -> Vec<NodalValues> {
        let layout = &self.layout;
        let values = |id, value: &dyn Fn(usize) -> Option<f64>| {
            let dofs = layout.dofs(id);
            dofs.map(|dof| value(dof as usize).unwrap_or_default())
                .collect()
        };
        let is_prescribed = |dof: usize| prescribed.get(dof) == Some(&true);
        let others = layout.other_nodal().map(|(id, field)| NodalValues {
            name: field.name,
            ncomponent: field.ncomponent,
            values: values(id, &|dof| state.u.get(dof).copied()),
            reaction: values(id, &|dof| {
                residual.get(dof).copied().filter(|_| is_prescribed(dof))
            }),
        });
        others.collect()
    }

    /// What the audits of all contacts find at an accepted state with these results.
    #[must_use]
    pub fn audit(&self, state: &State, frame: &Frame) -> Vec<ContactAudit> {
        let terms = self.terms.iter();
        let audited = terms.filter_map(|term| term.capabilities().audited);
        audited
            .filter_map(|term| term.audit(state, frame))
            .collect()
    }

    /// How bodies that only contact holds moved in the increment that led to an accepted state with these results.
    fn free_motions(&self, state: &State, frame: &Frame) -> Vec<FreeMotion> {
        let viscous = self.terms.iter().filter_map(|t| t.capabilities().viscous);
        viscous
            .flat_map(|term| term.courses())
            .filter_map(|course| course.motion(state, &self.layout, frame))
            .collect()
    }

    /// The displacement of a node, a vector of space in every dimension.
    #[must_use]
    pub fn displacement(&self, state: &State, node: u32) -> Vec3 {
        let mut u = Vec3::ZERO;
        for axis in 0..self.layout.ndim() {
            let dof = self.layout.node(node, axis) as usize;
            u[axis] = state.u.get(dof).copied().unwrap_or_default();
        }
        u
    }
}

/// The samples of these cells, which are sorted, at an accepted state.
///
/// # Errors
/// A term that cannot evaluate the state.
fn samples_of(
    terms: &[Box<dyn Term>],
    state: &State,
    cells: &[CellId],
) -> Result<Samples, TermError> {
    let mut samples = Samples::default();
    if !cells.is_empty() {
        let sampled = terms.iter().filter_map(|term| term.capabilities().sampled);
        for term in sampled {
            term.sample(state, cells, &mut samples)?;
        }
        samples.sort();
    }
    Ok(samples)
}
