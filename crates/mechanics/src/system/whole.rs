use super::internal_forces::internal_forces;
use super::{
    Adaptive, Aid, Archive, ArchiveError, Assembly, Choices, ContactAudit, Dof, Elimination,
    FieldId, Frame, FreeMotion, Impulsive, Layout, NodalValues, Rates, RigidMass, Role, Samples,
    State, Term, TermError, Wanted, Work,
};
use rayon::prelude::*;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::tensor::{Mat3, Vec3};
use std::f64::consts::TAU;
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
    /// Rigid bodies with a mass.
    pub heavy: Arc<[RigidMass]>,
    /// How everything moves at the start; none where nothing does.
    pub rates: Option<Rates>,
    /// Unknowns that are not zero at the start, with their values.
    pub at_start: Arc<[(Dof, f64)]>,
    /// What frames have besides.
    pub wanted: Wanted,
}

impl System {
    /// The undeformed state.
    #[must_use]
    pub fn initial_state(&self) -> State {
        let mut state = State {
            rates: self.rates.clone(),
            ..State::initial(&self.layout, &self.reference, &self.elimination)
        };
        for &(dof, value) in self.at_start.iter() {
            if let Some(to) = state.u.get_mut(dof as usize) {
                *to = value;
            }
        }
        state
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

    /// The contacts as steps with inertia see them, with their places among the terms.
    pub fn impulsive(&self) -> impl Iterator<Item = (usize, &dyn Impulsive)> {
        let terms = self.terms.iter().enumerate();
        terms.filter_map(|(place, term)| Some((place, term.capabilities().impulsive?)))
    }

    /// The largest shear of a row of one of these at a pressure; 0 where nothing rubs.
    #[must_use]
    pub fn friction_limit(&self, (place, row): (usize, usize), pressure: f64) -> f64 {
        let term = self.terms.get(place);
        let contact = term.and_then(|term| term.capabilities().impulsive);
        contact.map_or(0.0, |contact| contact.limit(row, pressure))
    }

    /// The terms that make discrete choices, to be changed.
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

    /// The nodes that have no mass in the present step though their bodies have one.
    #[must_use]
    pub fn massless(&self) -> &[NodeId] {
        let mut terms = self.terms.iter();
        let inertial = terms.find_map(|term| term.capabilities().inertial);
        inertial.map_or(&[], |of| of.massless())
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
        if let Some(rates) = &state.rates {
            [frame.velocity, frame.acceleration] = self.nodal_motions(state, rates);
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
            if let Some(pose) = state.poses.get(body as usize)
                && !state.is_small
            {
                rigid.rotation = turned(rigid.rotation, pose.rotation);
            }
        }
        for term in &self.terms {
            term.report(state, &mut frame)?;
        }
        if !frame.heat_flux.is_empty() {
            frame.fields.extend(of_heat(&frame));
        }
        if let Some(energies) = &mut frame.energies {
            let of_contacts = frame.contacts.iter();
            energies.contact = of_contacts.clone().flat_map(|c| &c.energy).sum();
            energies.friction = of_contacts.map(|c| c.work_friction).sum();
            energies.internal = self.energy_within(state)?;
        }
        frame.audits = self.audit(state, &frame);
        frame.free_motions = self.free_motions(state, &frame);
        let cells = &self.wanted.cells;
        let all = || self.terms.iter().map(|term| term.capabilities());
        let solids = all().filter_map(|can| can.sampled);
        frame.samples = sampled(cells, solids, |of, out| of.sample(state, cells, out))?;
        let warm = all().filter_map(|can| can.sampled_heat);
        frame.heat_samples = sampled(cells, warm, |of, out| of.sample_heat(state, cells, out))?;
        if self.wanted.forces {
            let internal = internal_forces(
                &self.terms,
                (&self.layout, self.elimination.directors()),
                state,
            )?;
            (frame.internal_force, frame.internal_heat) = (internal.forces, internal.heat);
        }
        Ok(frame)
    }

    /// The energy in bodies and springs at an accepted state, as far as they have one.
    fn energy_within(&self, state: &State) -> Result<f64, TermError> {
        let mut total = 0.0;
        for term in &self.terms {
            let is_contact = term.capabilities().audited.is_some();
            if term.properties().role != Role::Internal || is_contact {
                continue;
            }
            let chunks = 0..term.nchunk();
            let of_chunk = |work: &mut Work, chunk| term.energy(chunk, state, work);
            let energies = chunks.into_par_iter().map_init(Work::default, of_chunk);
            let energies: Result<Vec<Option<f64>>, TermError> = energies.collect();
            total += energies?.into_iter().flatten().sum::<f64>();
        }
        Ok(total)
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

/// What follows from temperatures that are unknowns: the flux of heat, and what it takes to hold them.
fn of_heat(frame: &Frame) -> [NodalValues; 2] {
    let flux = frame.heat_flux.iter().flat_map(|flux| flux.to_array());
    let mut fields = frame.fields.iter();
    let temperature = fields.find(|field| field.name == Layout::TEMPERATURE.name);
    let reaction = temperature.map(|field| field.reaction.clone());
    let field = |name, ncomponent, values| NodalValues {
        name,
        ncomponent,
        values,
        reaction: Vec::new(),
    };
    [
        field("heat_flux", 3, flux.collect()),
        field("reaction_heat", 1, reaction.unwrap_or_default()),
    ]
}

/// Samples of some cells, by all terms that have some; nothing where none are wanted.
///
/// # Errors
/// A term that cannot evaluate the state.
fn sampled<T, S>(
    cells: &[CellId],
    terms: impl Iterator<Item = T>,
    sample: impl Fn(T, &mut Samples<S>) -> Result<(), TermError>,
) -> Result<Samples<S>, TermError>
where
    Samples<S>: Default,
{
    let mut samples = Samples::default();
    if !cells.is_empty() {
        for term in terms {
            sample(term, &mut samples)?;
        }
        samples.sort();
    }
    Ok(samples)
}

/// The rotation vector of a rotation, with as many whole turns as are next to the sum of its increments: that itself where it is
/// one, about a fixed axis.
fn turned(sum: Vec3, rotation: Mat3) -> Vec3 {
    /// Larger than the rounding errors of a rotation after many increments.
    const SAME: f64 = 1e-10;
    let off = (Mat3::rotation(sum) - rotation).rows;
    if off.iter().all(|row| row.max_abs() < SAME) {
        return sum;
    }
    let vector = rotation.rotation_vector();
    let size = vector.norm();
    let axis = if size > SAME {
        vector / size
    } else {
        sum / sum.norm().max(SAME)
    };
    let turns = ((sum - vector).dot(axis) / TAU).round();
    vector + axis * (turns * TAU)
}

#[cfg(test)]
mod tests {
    use super::turned;
    use signorini_geometry::tensor::{Mat3, Vec3};

    #[test]
    fn rotations_are_reported_as_axis_and_angle_with_their_turns() {
        let about = |axis: Vec3, angle: f64| Mat3::rotation(axis * angle);
        let [x, z] = [Vec3::unit(0), Vec3::unit(2)];
        // about one axis: the sum of increments, to the bit
        let sum = z * 9.3;
        assert_eq!(turned(sum, about(z, 9.3)), sum);
        // about two: no sum
        let both = about(z, 1.2) * about(x, 0.9);
        let got = turned(Vec3::new(0.9, 0.0, 1.2), both);
        let off = (Mat3::rotation(got) - both).rows;
        assert!(off.iter().all(|row| row.norm() < 1e-14));
        // with a turn more
        let more = turned(got + got / got.norm() * 6.0, both);
        assert!((more.norm() - got.norm() - std::f64::consts::TAU).abs() < 1e-12);
    }
}
