use super::{Change, Context, Load, LoadPart, ModelError, StepPart, Target, label, loads};
use crate::solve::{Motion, Prescription, Step};
use crate::system::{Dof, DofName, NO_DOF, Term};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;
use std::collections::{BTreeMap, BTreeSet, HashMap};

impl Context<'_> {
    pub(super) fn on_rigid(&self, node: NodeId) -> Result<(), ModelError> {
        match self.elimination.body_of(node) {
            None => Ok(()),
            Some(body) => Err(ModelError::OnRigidNode {
                node: label(self.mesh, node),
                body: self
                    .carriers
                    .get(body as usize)
                    .map(|c| c.name.clone())
                    .unwrap_or_default(),
            }),
        }
    }

    /// The raw dofs of a component of a target.
    fn dofs(&self, target: &Target, component: usize) -> Result<Vec<Dof>, ModelError> {
        let layout = &self.layout;
        let dofs = match target {
            Target::Rigid(body) if component < 3 => vec![layout.translation(*body, component)],
            Target::Rigid(body) => vec![layout.rotation(*body, component - 3)],
            Target::Nodes(_) if component >= 3 => Vec::new(),
            Target::Nodes(nodes) => {
                for &node in nodes {
                    self.on_rigid(node)?;
                }
                nodes.iter().map(|&n| layout.node(n, component)).collect()
            }
        };
        Ok(dofs.into_iter().filter(|&d| d != NO_DOF).collect())
    }

    /// What is prescribed in each step, and the loads of all steps as terms.
    pub(super) fn steps(
        &self,
        parts: Vec<StepPart>,
    ) -> Result<(Vec<Step>, Vec<Box<dyn Term>>), ModelError> {
        let mut prescribed: BTreeMap<Dof, Motion> = BTreeMap::new();
        for body in 0..self.layout.nrigid as RigidId {
            for component in 0..6 {
                for dof in self.dofs(&Target::Rigid(body), component)? {
                    prescribed.insert(dof, Motion::Hold);
                }
            }
        }
        // what the user has prescribed, as against what is held because nobody says otherwise
        let mut named: BTreeSet<Dof> = BTreeSet::new();
        let mut loads: Vec<Vec<LoadPart>> = Vec::new();
        let mut steps = Vec::new();
        for part in parts {
            for motion in prescribed.values_mut() {
                if !matches!(motion, Motion::TotalTable(_)) {
                    *motion = Motion::Hold;
                }
            }
            let mut here: HashMap<Dof, Motion> = HashMap::new();
            for change in &part.changes {
                match change {
                    Change::Prescribe(target, components) => {
                        for (component, motion) in components {
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
                            for dof in self.dofs(target, component)? {
                                prescribed.remove(&dof);
                                named.remove(&dof);
                            }
                        }
                    }
                }
            }
            for load in &part.loads {
                // a carrier that is loaded along an axis may move along it
                for dof in self.loaded(&load.load) {
                    if !named.contains(&dof) {
                        prescribed.remove(&dof);
                    }
                }
            }
            loads.push(part.loads);
            let prescriptions = prescribed.iter().map(|(&dof, motion)| Prescription {
                dof,
                motion: motion.clone(),
            });
            steps.push(Step {
                name: part.name,
                duration: part.duration,
                increments: part.increments,
                nonlinear: part.nonlinear,
                prescriptions: prescriptions.collect(),
            });
        }
        let terms = loads::terms(self, &steps, loads)?;
        Ok((steps, terms))
    }

    /// The unknowns of a carrier along which a load acts.
    fn loaded(&self, load: &Load) -> Vec<Dof> {
        let Load::Carrier {
            carrier,
            force,
            moment,
        } = load
        else {
            return Vec::new();
        };
        let layout = &self.layout;
        let along = (0..3).filter(|&c| force[c] != 0.0);
        let about = (0..3).filter(|&c| moment[c] != 0.0);
        along
            .map(|c| layout.translation(*carrier, c))
            .chain(about.map(|c| layout.rotation(*carrier, c)))
            .filter(|&dof| dof != NO_DOF)
            .collect()
    }

    fn clash(&self, step: &str, dof: Dof) -> ModelError {
        let (node, axis) = match self.layout.name(dof) {
            Some(DofName::Node(node, axis)) => (label(self.mesh, node), axis),
            _ => (0, 0),
        };
        ModelError::Clash {
            step: step.to_string(),
            node,
            component: ['x', 'y', 'z'][axis.min(2)],
        }
    }
}
