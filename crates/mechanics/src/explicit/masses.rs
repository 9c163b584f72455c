//! Masses of unknowns, one for each: what makes accelerations of forces.

use super::bodies::Bodies;
use crate::system::{Dof, NodeId, State, System, TermError};
use signorini_geometry::tensor::Vec3;

/// The masses of an explicit step.
#[derive(Default)]
pub struct Masses {
    /// Of each node, whatever follows what.
    pub of_nodes: Vec<f64>,
    /// Damping over mass of each node; empty where nothing is damped.
    pub damping: Vec<f64>,
    /// 1/m of each unknown that moves by itself, those of carriers excepted; 0 where it does not.
    pub inverse: Vec<f64>,
}

impl Masses {
    /// The masses at nodes of the present step.
    pub fn of(system: &System) -> Self {
        let mut of_nodes = vec![0.0; system.layout.nnode()];
        let mut damping = vec![0.0; of_nodes.len()];
        let mut is_damped = false;
        let terms = system.terms.iter();
        for inertial in terms.filter_map(|term| term.capabilities().inertial) {
            inertial.at_nodes(&mut |node: NodeId, mass, damped| {
                let node = node as usize;
                if let Some((m, d)) = of_nodes.get_mut(node).zip(damping.get_mut(node)) {
                    *m += mass;
                    *d += mass * damped;
                    is_damped |= damped > 0.0;
                }
            });
        }
        for (damping, mass) in damping.iter_mut().zip(&of_nodes) {
            *damping = if *mass > 0.0 { *damping / mass } else { 0.0 };
        }
        if !is_damped {
            damping.clear();
        }
        Self {
            of_nodes,
            damping,
            inverse: Vec::new(),
        }
    }

    /// The mass of all nodes.
    pub fn total(&self) -> f64 {
        self.of_nodes.iter().sum()
    }

    /// Gives the mass of nodes to the unknowns that they move with. A node that follows several unknowns gives each its part,
    /// so that the mass of all is the same.
    ///
    /// # Errors
    /// A node follows what moves in some directions only; an unknown has a negative mass.
    pub fn share_out(
        &mut self,
        system: &System,
        state: &State,
        prescribed: &[bool],
        bodies: &Bodies,
    ) -> Result<(), TermError> {
        let (layout, elimination) = (&system.layout, &system.elimination);
        let mut masses = vec![0.0; layout.nmotion()];
        let mut terms: Vec<(Dof, f64)> = Vec::new();
        for (node, &mass) in (0..).zip(&self.of_nodes) {
            for axis in 0..layout.ndim() {
                let dof = layout.node(node, axis);
                if !elimination.depends(dof, layout) {
                    add(&mut masses, dof, mass);
                    continue;
                }
                if mass == 0.0 || bodies.takes(node) {
                    continue;
                }
                terms.clear();
                elimination.terms(dof, state, layout, &mut |dof, c| terms.push((dof, c)));
                let turns = |(dof, c): &(Dof, f64)| {
                    *c != 0.0
                        && layout.carrier(*dof).is_some()
                        && prescribed.get(*dof as usize) != Some(&true)
                };
                if terms.iter().any(turns) {
                    return Err(refused(system, node, FOLLOWS));
                }
                let sum: f64 = terms.iter().map(|(_, c)| c).sum();
                terms
                    .iter()
                    .for_each(|(dof, c)| add(&mut masses, *dof, mass * c * sum));
            }
        }
        self.inverse.clear();
        self.inverse.resize(layout.nmotion(), 0.0);
        for node in 0..layout.nnode() as NodeId {
            for axis in 0..layout.ndim() {
                let dof = layout.node(node, axis);
                let at = dof as usize;
                let moves = !elimination.depends(dof, layout) && prescribed.get(at) != Some(&true);
                let mass = masses.get(at).copied().unwrap_or_default();
                if !moves || mass == 0.0 {
                    // what belongs to no element is moved by nothing
                    continue;
                }
                if mass < 0.0 {
                    return Err(refused(system, node, NEGATIVE));
                }
                if let Some(inverse) = self.inverse.get_mut(at) {
                    *inverse = mass.recip();
                }
            }
        }
        Ok(())
    }
}

const FOLLOWS: &str = "has a mass and follows a reference that moves in some directions only";
const NEGATIVE: &str = "takes a negative mass from nodes that follow it";

fn refused(system: &System, node: NodeId, what: &str) -> TermError {
    let at = system.reference.get(node as usize).copied();
    let [x, y, z] = at.unwrap_or(Vec3::ZERO).to_array();
    TermError::Refused {
        message: format!(
            "an explicit step has masses at nodes alone: the node at ({x:.4}, {y:.4}, {z:.4}) {what}; join by contact, or take \
             an implicit method"
        ),
    }
}

fn add(to: &mut [f64], dof: Dof, value: f64) {
    if let Some(to) = to.get_mut(dof as usize) {
        *to += value;
    }
}
