//! Cells whose unknowns are those of directors: the nodes of the mesh, and what rounding does to their forces.

use super::cells::Cells;
use super::error::SolidError;
use super::scratch::Scratch;
use crate::system::{Directors, Sink};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// Makes places of the ends of directors their middles and halves.
pub(super) fn to_directors(places: &mut [Vec3]) {
    let (negative, positive) = places.split_at_mut(places.len() / 2);
    for (negative, positive) in negative.iter_mut().zip(positive) {
        let (low, high) = (*negative, *positive);
        (*negative, *positive) = ((low + high) * 0.5, (high - low) * 0.5);
    }
}

impl Cells {
    /// Adds the nodes of a cell; with directors its unknowns are theirs.
    pub fn push(
        &mut self,
        body: &str,
        (nodes, label): (&[NodeId], u64),
        directors: Option<&Directors>,
    ) -> Result<(), SolidError> {
        let Some(directors) = directors else {
            self.nodes.extend_from_slice(nodes);
            return Ok(());
        };
        let carriers = directors.carriers(nodes);
        self.nodes
            .extend(carriers.ok_or_else(|| SolidError::NoDirector {
                body: body.to_string(),
                label,
            })?);
        self.ends.extend_from_slice(nodes);
        Ok(())
    }

    /// The nodes of a cell in the mesh: where it is, what temperatures it has, and what results are carried to.
    pub fn ends_of(&self, cell: usize) -> &[NodeId] {
        let of_cell = cell * self.nnode..(cell + 1) * self.nnode;
        let ends = self.ends.get(of_cell);
        ends.unwrap_or_else(|| self.nodes_of(cell))
    }

    /// The nodes of all cells in the mesh.
    pub fn all_ends(&self) -> &[NodeId] {
        if self.ends.is_empty() {
            &self.nodes
        } else {
            &self.ends
        }
    }

    /// `M ∫ max_k |N_k,X|² dV` of the middle of every cell whose nodes are ends of directors.
    pub fn rigidities_of_middles(&self, reference: &[Vec3], modulus: f64) -> Vec<f64> {
        let at = |node: &NodeId| reference.get(*node as usize).copied().unwrap_or_default();
        let of_cell = |nodes: &[NodeId]| {
            let x: Vec<Vec3> = nodes.iter().map(at).collect();
            modulus * self.points.stretch_of_middle(&x)
        };
        self.ends.chunks_exact(self.nnode).map(of_cell).collect()
    }

    /// Bounds what rounding of displacements does to the forces of a cell: strains are sums of as many products as there are
    /// nodes.
    pub fn doubt(&self, cell: usize, stiffer: f64, of: &Scratch, out: &mut dyn Sink) {
        let largest = |u: &[f64]| u.iter().fold(0.0f64, |far, u| far.max(u.abs()));
        let factor = f64::EPSILON * self.nnode as f64 * stiffer;
        let rigidity = self.rigidity.get(cell).copied().unwrap_or_default();
        let Some(&of_middle) = self.of_middle.get(cell) else {
            out.uncertain(&of.dofs, factor * rigidity * largest(&of.u));
            return;
        };
        let (middle, half) = of.u.split_at(of.u.len() / 2);
        let (middle, half) = (largest(middle), largest(half));
        let mixed = (of_middle * rigidity).sqrt();
        let (to_middle, to_half) = of.dofs.split_at(of.dofs.len() / 2);
        out.uncertain(to_middle, factor * (of_middle * middle + mixed * half));
        out.uncertain(to_half, factor * (mixed * middle + rigidity * half));
    }
}
