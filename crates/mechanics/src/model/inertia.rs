//! The masses of bodies, as a term.

use super::substance::Substance;
use super::{ContactPart, Context, MassMatrix, ModelError, PrimaryPart, SidePart};
use crate::inertia::{Inertia, Masses, RigidInertia};
use crate::load::{Region, mass};
use crate::solve::Step;
use crate::system::{Rates, Term};
use signorini_geometry::mesh::{CellId, Face, NodeId};
use std::collections::BTreeSet;

impl Context<'_> {
    /// The inertia of all bodies, and of masses at nodes; none where all steps are static.
    pub(super) fn inertia(
        &self,
        steps: &[Step],
        contacts: &[ContactPart],
        at_nodes: &[(NodeId, f64)],
        rates: Option<&Rates>,
    ) -> Result<Vec<Box<dyn Term>>, ModelError> {
        let mut schemes = steps.iter().filter_map(|step| step.scheme.as_ref());
        let vibrates = steps.iter().any(|step| step.vibration.is_some());
        if schemes.clone().next().is_none() && !vibrates {
            return Ok(Vec::new());
        }
        let nowhere = BTreeSet::new();
        let usual = self.masses(at_nodes, &nowhere, false)?;
        let redistributed = match schemes.clone().any(|scheme| scheme.redistributed) {
            true => Some(self.masses(at_nodes, &self.on_sides(contacts), false)?),
            false => None,
        };
        let lumped = match schemes.clone().any(|scheme| scheme.explicit.is_some()) {
            true => Some(self.masses(at_nodes, &nowhere, true)?),
            false => None,
        };
        let mut inertia = Inertia::new(self.layout, usual, redistributed, lumped);
        let mut rigid = Vec::new();
        if let Some(rates) = rates {
            inertia.start(schemes.next().copied(), &rates.velocity);
            rigid.clone_from(&rates.bodies);
        }
        let mut terms: Vec<Box<dyn Term>> = vec![Box::new(inertia)];
        if !self.heavy.is_empty() {
            let heavy = self.heavy.clone();
            terms.push(Box::new(RigidInertia::new(self.layout, heavy, &rigid)));
        }
        Ok(terms)
    }

    /// The masses of all bodies that deform, and those at nodes. An element with nodes on the `sides` gives its mass to its
    /// other nodes, in equal shares (E4), where it has any. `lumped`: all are at nodes, whatever the bodies say.
    fn masses(
        &self,
        at_nodes: &[(NodeId, f64)],
        sides: &BTreeSet<NodeId>,
        lumped: bool,
    ) -> Result<Masses, ModelError> {
        let mut masses = Masses::default();
        let mut shares = Vec::new();
        let mut heavy: BTreeSet<NodeId> = BTreeSet::new();
        let bodies = self.substances.iter().zip(self.cells_of_bodies());
        for (body, cells) in bodies.filter(|(body, _)| body.deforms) {
            let density = body.density.ok_or_else(|| ModelError::NoDensity {
                body: body.name.clone(),
            })?;
            if !self.is_thick(&cells, sides) {
                let body = body.name.clone();
                return Err(ModelError::Thin { body });
            }
            let region = self.massive(body, &cells, density);
            let damping = body.mass.damping;
            mass::matrices(&region, self.reference, |nodes, matrix| {
                let off = |node: &&NodeId| !sides.contains(node);
                let others = nodes.iter().filter(off).count();
                let touches = others < nodes.len();
                let is_consistent = body.mass.matrix == MassMatrix::Consistent && !lumped;
                if !touches && is_consistent {
                    masses.push(nodes, matrix, damping);
                    return;
                }
                mass::lump(matrix, &mut shares);
                if touches && others > 0 {
                    let share = shares.iter().sum::<f64>() / others as f64;
                    let shares = nodes.iter().zip(&mut shares);
                    shares.for_each(|(node, m)| *m = if off(&node) { share } else { 0.0 });
                }
                for (node, m) in nodes.iter().zip(&shares).filter(|(_, m)| **m > 0.0) {
                    heavy.insert(*node);
                    masses.push(&[*node], &[*m], damping);
                }
            });
        }
        let own = at_nodes.iter();
        for &(node, m) in own.filter(|(node, _)| self.elimination.body_of(*node).is_none()) {
            heavy.insert(node);
            masses.push(&[node], &[m], 0.0);
        }
        let massless = sides.difference(&heavy).copied().collect();
        Ok(masses.complete(massless))
    }

    /// The nodes of bodies that deform on the sides of contacts that are not joined.
    fn on_sides(&self, contacts: &[ContactPart]) -> BTreeSet<NodeId> {
        let mut nodes = BTreeSet::new();
        let mut take = |faces: &[Face]| {
            for face in faces {
                let owner = self.owner.get(&face.cell);
                let body = owner.and_then(|&body| self.substances.get(body));
                if body.is_some_and(|body| body.deforms)
                    && let Some((_, of_face)) = self.mesh.face(*face)
                {
                    nodes.extend(of_face);
                }
            }
        };
        let mut bare: Vec<NodeId> = Vec::new();
        for contact in contacts.iter().filter(|contact| contact.tie.is_none()) {
            match &contact.secondary {
                SidePart::Faces(faces) => take(faces),
                SidePart::Nodes(nodes) => bare.extend(nodes),
            }
            match &contact.primary {
                PrimaryPart::Faces(faces) => take(faces),
                PrimaryPart::Nodes(nodes) => bare.extend(nodes),
                PrimaryPart::Surface(_) | PrimaryPart::Itself => {}
            }
        }
        nodes.extend(bare);
        nodes
    }

    /// Whether a body is at least three elements thick where it has nodes on the sides.
    fn is_thick(&self, cells: &[CellId], sides: &BTreeSet<NodeId>) -> bool {
        let mut reached = sides.clone();
        for _ in 0..2 {
            let touched = |cell: &&CellId| {
                let nodes = self.mesh.cell(**cell);
                nodes.iter().any(|node| reached.contains(node))
            };
            let touched: Vec<CellId> = cells.iter().filter(touched).copied().collect();
            if touched.is_empty() {
                return true;
            }
            if touched.len() == cells.len() {
                return false;
            }
            for cell in touched {
                reached.extend(self.mesh.cell(cell));
            }
        }
        true
    }

    /// The cells of each body, in the order of the mesh.
    pub(super) fn cells_of_bodies(&self) -> Vec<Vec<CellId>> {
        let mut cells = vec![Vec::new(); self.substances.len()];
        for (&cell, &body) in self.owner {
            if let Some(cells) = cells.get_mut(body) {
                cells.push(cell);
            }
        }
        cells.iter_mut().for_each(|cells| cells.sort_unstable());
        cells
    }

    /// Cells of a body with their mass.
    pub(super) fn massive(&self, body: &Substance, cells: &[CellId], density: f64) -> Region {
        let factor = density * body.section.unwrap_or(1.0);
        let mut region = Region::default();
        for &cell in cells {
            if let Some(element) = self.mesh.element(cell) {
                // by fewer points, some motions would have no mass
                let rule = element.rules().mass;
                let across = (body.space, body.profile.as_deref());
                region.push_by((element, rule), across, self.mesh.cell(cell), factor);
            }
        }
        region
    }
}
