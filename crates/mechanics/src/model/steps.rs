use super::constraint_error::ConstraintError;
use super::constraints::components;
use super::label::label;
use super::{Change, ContactPart, Context, LoadPart, ModelError, StepPart, Target};
use crate::load::Place;
use crate::solve::{Motion, Prescription, Step};
use crate::system::{Dof, DofName, FieldId, Idealisation, NO_DOF, RigidMass};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Component of a carrier along the axis of an axisymmetric model.
const AXIAL: usize = 1;

/// What the steps prescribe of the motion of a node along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Prescribed {
    /// Whether some step prescribes it.
    pub is_given: bool,
    /// Whether some step prescribes a motion, not only that it stays.
    pub moves: bool,
}

/// Of each node and axis, what some step prescribes.
pub(super) fn prescribed(nnode: usize, steps: &[StepPart]) -> Vec<[Prescribed; 3]> {
    let mut axes = vec![[Prescribed::default(); 3]; nnode];
    for change in steps.iter().flat_map(|step| &step.changes) {
        let Change::Prescribe(Target::Nodes(nodes), motions) = change else {
            continue;
        };
        for (axis, motion) in motions {
            for &node in nodes {
                let of_node = axes.get_mut(node as usize);
                if let Some(of) = of_node.and_then(|of| of.get_mut(*axis)) {
                    of.is_given = true;
                    of.moves |= !matches!(motion, Motion::Hold);
                }
            }
        }
    }
    axes
}

/// Of each node, whether its motion is prescribed along all axes.
pub(super) fn in_whole(motions: &[[Prescribed; 3]], ndim: usize) -> Vec<bool> {
    let whole = |axes: &[Prescribed; 3]| axes.iter().take(ndim).all(|a| a.is_given);
    motions.iter().map(whole).collect()
}

impl Context<'_> {
    fn on_rigid(&self, node: NodeId) -> Result<(), ModelError> {
        let body = self.elimination.body_of(node);
        match body.filter(|_| self.ties.rigid.contains(&node)) {
            None => Ok(()),
            Some(body) => Err(ModelError::OnRigidNode {
                node: label(self.mesh, node),
                body: self.carrier_name(body),
            }),
        }
    }

    /// Whether a node belongs to no body, no constraint and no spring names it, and it has no mass.
    pub(super) fn is_loose(&self, node: NodeId) -> bool {
        self.singles.loose.get(node as usize) == Some(&true)
    }

    pub(super) fn carrier_name(&self, carrier: RigidId) -> String {
        let part = self.carriers.get(carrier as usize);
        part.map(|c| c.name.clone()).unwrap_or_default()
    }

    /// Supports and motions are not for displacements that follow a carrier.
    fn leads(&self, node: NodeId, component: usize) -> Result<(), ModelError> {
        self.on_rigid(node)?;
        let dof = self.layout.node(node, component);
        match self.elimination.leader(dof, &self.layout) {
            None => Ok(()),
            Some(turn) => Err(ConstraintError::OnFollower {
                node: label(self.mesh, node),
                carrier: self.carrier_name(turn.carrier),
            }
            .into()),
        }
    }

    /// A carrier that is moved or loaded has followers, and stays on the axis of an axisymmetric model.
    fn may_move(&self, step: &str, carrier: RigidId, component: usize) -> Result<(), ModelError> {
        let (step, reference) = (step.to_string(), self.carrier_name(carrier));
        if !self.ties.followed.get(carrier as usize).is_some_and(|f| *f) {
            return Err(ConstraintError::Idle { step, reference }.into());
        }
        if self.is_off_axis(carrier, component) {
            return Err(ConstraintError::OffAxis { step, reference }.into());
        }
        Ok(())
    }

    /// Whether a carrier would leave the axis of a body of revolution; what only equations speak of has no place there.
    fn is_off_axis(&self, carrier: RigidId, component: usize) -> bool {
        let placed = self.ties.placed.get(carrier as usize) == Some(&true);
        self.space == Idealisation::Axisymmetric && component != AXIAL && (placed || component >= 3)
    }

    /// The raw dofs of a component of a target.
    fn dofs(&self, target: &Target, component: usize) -> Result<Vec<Dof>, ModelError> {
        let layout = &self.layout;
        let dofs = match target {
            Target::Rigid(body) => vec![layout.carrier_motion(*body, component)],
            Target::Nodes(_) if component >= 3 => Vec::new(),
            Target::Nodes(nodes) => {
                for &node in nodes {
                    self.leads(node, component)?;
                }
                nodes.iter().map(|&n| layout.node(n, component)).collect()
            }
        };
        Ok(dofs.into_iter().filter(|&d| d != NO_DOF).collect())
    }

    /// What is prescribed in each step, and the loads given there.
    pub(super) fn steps(
        &self,
        parts: Vec<StepPart>,
        contacts: &[ContactPart],
    ) -> Result<(Vec<Step>, Vec<Vec<LoadPart>>), ModelError> {
        let mut prescribed = self.held_carriers();
        // prescribed by the user, as opposed to held by default
        let mut named: BTreeSet<Dof> = BTreeSet::new();
        let mut loads: Vec<Vec<LoadPart>> = Vec::new();
        let mut steps = Vec::new();
        let mut temperatures = self.temperatures();
        for part in parts {
            for motion in prescribed.values_mut() {
                if !motion.goes_on() {
                    *motion = Motion::Hold;
                }
            }
            let mut here: HashMap<Dof, Motion> = HashMap::new();
            for change in &part.changes {
                match change {
                    Change::Prescribe(target, components) => {
                        for (component, motion) in components {
                            if let (Target::Rigid(carrier), true) =
                                (target, *motion != Motion::Hold)
                            {
                                self.may_move(&part.name, *carrier, *component)?;
                            }
                            if let Target::Nodes(nodes) = target
                                && *motion != Motion::Hold
                                && let Some(&first) = nodes.first()
                                && nodes.iter().all(|&node| self.is_loose(node))
                            {
                                let step = part.name.clone();
                                let node = label(self.mesh, first);
                                return Err(ConstraintError::Loose { step, node }.into());
                            }
                            // everything starts at zero: to go there is to stay
                            let stays = steps.is_empty() && *motion == Motion::Ramp(0.0);
                            let motion = if stays { &Motion::Hold } else { motion };
                            for dof in self.dofs(target, *component)? {
                                let before = here.insert(dof, motion.clone());
                                if before.is_some_and(|b| b != *motion) {
                                    return Err(self.clash(&part.name, dof));
                                }
                                prescribed.insert(dof, motion.clone());
                                named.insert(dof);
                            }
                        }
                    }
                    Change::Release(target, components) => {
                        for &component in components {
                            if let Target::Rigid(carrier) = target
                                && self.is_off_axis(*carrier, component)
                            {
                                continue;
                            }
                            for dof in self.dofs(target, component)? {
                                prescribed.remove(&dof);
                                named.remove(&dof);
                            }
                        }
                    }
                }
            }
            // a carrier that is loaded along an axis may move along it
            for dof in self.loaded(&part.loads, &part.name)? {
                if !named.contains(&dof) {
                    prescribed.remove(&dof);
                }
            }
            let by_mass = self.released(&part, &named);
            if part.scheme.is_some() {
                prescribed.retain(|dof, _| !by_mass.contains(dof));
            }
            let of_heat = temperatures.of(&part, &self.layout);
            loads.push(part.loads);
            let here = prescribed.iter().filter(|(dof, _)| !by_mass.contains(dof));
            let prescriptions = here.map(|(&dof, motion)| Prescription {
                dof,
                motion: motion.clone(),
            });
            steps.push(Step {
                name: part.name,
                duration: match part.vibration {
                    Some(_) => 0.0,
                    None => part.duration,
                },
                increments: part.increments,
                nonlinear: part.nonlinear,
                scheme: part.scheme,
                control: part.control.map(|control| self.control(&control, contacts)),
                vibration: part.vibration,
                physics: part.physics,
                prescriptions: prescriptions.chain(of_heat).collect(),
            });
        }
        Ok((steps, loads))
    }

    /// What carriers are held along unless steps say otherwise.
    fn held_carriers(&self) -> BTreeMap<Dof, Motion> {
        let carriers = 0..self.layout.nrigid() as RigidId;
        let all = carriers.flat_map(|carrier| components(&self.layout, carrier));
        let held = all.filter(|dof| !self.ties.free.contains(dof));
        held.map(|dof| (dof, Motion::Hold)).collect()
    }

    /// The unknowns along which mass moves in a step unless something holds it.
    fn released(&self, part: &StepPart, named: &BTreeSet<Dof>) -> BTreeSet<Dof> {
        let moves = part.scheme.is_some() || part.vibration.is_some();
        let by_mass = self.moved_by_mass();
        by_mass
            .filter(|dof| moves && !named.contains(dof))
            .collect()
    }

    /// The unknowns of rigid bodies with a mass that inertia acts along: translations, and rotations that have some.
    fn moved_by_mass(&self) -> impl Iterator<Item = Dof> {
        let of_body = move |body: &RigidMass| {
            let inertia = body.about_reference();
            let about = [inertia.xx(), inertia.yy(), inertia.zz()];
            let carrier = body.carrier;
            (0..6).filter_map(move |component: usize| {
                if self.is_off_axis(carrier, component) {
                    return None;
                }
                let axis = component.checked_sub(3);
                let has_inertia = axis.is_none_or(|axis| about[axis] > 0.0);
                let dof = self.layout.carrier_motion(carrier, component);
                (has_inertia && dof != NO_DOF).then_some(dof)
            })
        };
        self.heavy.iter().flat_map(of_body)
    }

    /// The unknowns of carriers along which loads act.
    fn loaded(&self, loads: &[LoadPart], step: &str) -> Result<Vec<Dof>, ModelError> {
        let layout = &self.layout;
        let mut dofs = Vec::new();
        for part in loads {
            let carriers: Vec<RigidId> = match part.load.place {
                Place::Carrier(carrier) => vec![carrier],
                Place::Points => self.heavy.iter().map(|body| body.carrier).collect(),
                _ => continue,
            };
            // the direction of a weight is enough
            let [force, moment] = part.load.load.resultant(1.0).unwrap_or_default();
            let values = force.to_array().into_iter().chain(moment.to_array());
            for (component, _) in values.enumerate().filter(|(_, value)| *value != 0.0) {
                for &carrier in &carriers {
                    self.may_move(step, carrier, component)?;
                    dofs.push(layout.carrier_motion(carrier, component));
                }
            }
        }
        dofs.retain(|&dof| dof != NO_DOF);
        Ok(dofs)
    }

    fn clash(&self, step: &str, dof: Dof) -> ModelError {
        let step = step.to_string();
        let name = self.layout.name(dof).map(DofName::parts);
        let (field, entity, component) = name.unwrap_or((FieldId::DISPLACEMENT, 0, 0));
        let axis = ['x', 'y', 'z'][component.min(2)];
        let motion = match field {
            FieldId::TRANSLATION => format!("{axis} displacement"),
            FieldId::ROTATION => format!("rotation about {axis}"),
            _ => {
                return ModelError::Clash {
                    step,
                    node: label(self.mesh, entity),
                    component: axis,
                };
            }
        };
        ModelError::CarrierClash {
            step,
            carrier: self.carrier_name(entity),
            motion,
        }
    }
}
