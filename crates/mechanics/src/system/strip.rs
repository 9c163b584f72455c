//! Strips of the matrices, which threads add up apart.

use super::assembly::Assembly;
use super::{Dof, Part, Term};
use signorini_geometry::mesh::NodeId;
use signorini_linear::sparsity::{BlockPattern, NONE};

/// The places of unknowns among the columns of a row; none for unknowns left out, nor for a dead force that turns with
/// nothing but itself, which needs none.
pub(super) fn find_places(dofs: &[Dof], columns: &[u32], places: &mut Vec<u32>) {
    let mut next = 0;
    places.clear();
    places.extend(dofs.iter().map(|dof| {
        // most often right of the one before
        let is_next = columns.get(next) == Some(dof);
        let found = match is_next {
            true => Ok(next),
            false => columns.binary_search(dof),
        };
        found.map_or(NONE, |place| {
            next = place + 1;
            place as u32
        })
    }));
}

/// Some rows of the assembly.
pub(super) struct Strip<'a> {
    pub first: usize,
    pub first_bulk: usize,
    pub first_interface: usize,
    pub residual: &'a mut [f64],
    pub magnitude: &'a mut [f64],
    pub uncertainty: &'a mut [f64],
    pub bulk: &'a mut [f64],
    pub interface: &'a mut [f64],
    /// Scratch: the places of unknowns in a row of the interface.
    pub places: Vec<u32>,
}

impl<'a> Strip<'a> {
    pub fn whole(out: &'a mut Assembly) -> Self {
        Self {
            first: 0,
            first_bulk: 0,
            first_interface: 0,
            residual: &mut out.residual,
            magnitude: &mut out.magnitude,
            uncertainty: &mut out.uncertainty,
            bulk: &mut out.bulk,
            interface: &mut out.interface,
            places: Vec::new(),
        }
    }

    /// The rows before `dof`, and those from it on, whose values in bulk and interface begin at `entries`.
    pub fn split_at(self, dof: usize, entries: [usize; 2]) -> (Self, Self) {
        let split = |values: &'a mut [f64], first: usize, at: usize| {
            let at = at.saturating_sub(first).min(values.len());
            values.split_at_mut(at)
        };
        let (residual, residuals) = split(self.residual, self.first, dof);
        let (magnitude, magnitudes) = split(self.magnitude, self.first, dof);
        let (uncertainty, uncertainties) = split(self.uncertainty, self.first, dof);
        let (bulk, bulks) = split(self.bulk, self.first_bulk, entries[0]);
        let (interface, interfaces) = split(self.interface, self.first_interface, entries[1]);
        let others = Self {
            first: self.first + residual.len(),
            first_bulk: self.first_bulk + bulk.len(),
            first_interface: self.first_interface + interface.len(),
            residual: residuals,
            magnitude: magnitudes,
            uncertainty: uncertainties,
            bulk: bulks,
            interface: interfaces,
            places: Vec::new(),
        };
        let strip = Self {
            residual,
            magnitude,
            uncertainty,
            bulk,
            interface,
            ..self
        };
        (strip, others)
    }

    pub fn has(&self, dof: Dof) -> bool {
        (dof as usize).wrapping_sub(self.first) < self.residual.len()
    }

    /// The values of a row of the interface: so many from this one on.
    pub fn entries(&mut self, first: usize, count: usize) -> &mut [f64] {
        let first = first.wrapping_sub(self.first_interface);
        let own = first..first.saturating_add(count);
        self.interface.get_mut(own).unwrap_or_default()
    }

    pub fn add_error(&mut self, dof: Dof, error: f64) {
        let at = (dof as usize).wrapping_sub(self.first);
        if let Some(to) = self.uncertainty.get_mut(at) {
            *to += error;
        }
    }

    pub fn add_force(&mut self, dofs: &[Dof], force: &[f64]) {
        for (&dof, f) in dofs.iter().zip(force) {
            // no dof lies beyond all
            let at = (dof as usize).wrapping_sub(self.first);
            if let (Some(sum), Some(sizes)) =
                (self.residual.get_mut(at), self.magnitude.get_mut(at))
            {
                *sum += f;
                *sizes += f.abs();
            }
        }
    }

    /// Adds the blocks of an element, of `NN = ND ND` values, where they belong in the bulk.
    pub fn add_blocks<const ND: usize, const NN: usize>(
        &mut self,
        stiffness: &[f64],
        positions: &[u32],
        is_symmetric: bool,
    ) {
        let nblock = positions.len().isqrt();
        let (bulk, first) = (self.bulk.as_chunks_mut::<NN>().0, self.first_bulk / NN);
        // a strip may not have it
        let place = |i: usize, j: usize| {
            let position = positions.get(i * nblock + j).copied().unwrap_or(NONE);
            (position as usize).wrapping_sub(first)
        };
        if is_symmetric {
            let pairs = (0..nblock).flat_map(|j| (0..=j).map(move |i| (i, j)));
            for ((i, j), from) in pairs.zip(stiffness.as_chunks::<NN>().0) {
                if let Some(to) = bulk.get_mut(place(i, j)) {
                    to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
                }
                if i == j {
                    continue;
                }
                if let Some(to) = bulk.get_mut(place(j, i)) {
                    for k in 0..NN {
                        to[k] += from[k % ND * ND + k / ND];
                    }
                }
            }
            return;
        }
        for (i, rows) in stiffness.chunks_exact((nblock * NN).max(1)).enumerate() {
            let rows = rows.as_chunks::<ND>().0;
            for j in 0..nblock {
                if let Some(to) = bulk.get_mut(place(i, j)) {
                    let rows = rows.iter().skip(j).step_by(nblock);
                    for (to, from) in to.as_chunks_mut::<ND>().0.iter_mut().zip(rows) {
                        to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
                    }
                }
            }
        }
    }
}

/// The terms of the bulk.
pub(super) fn bulk(terms: &[Box<dyn Term>]) -> impl Iterator<Item = &dyn Term> {
    let all = terms.iter().map(AsRef::as_ref);
    all.filter(|term| term.properties().part == Part::Bulk)
}

/// Where the blocks between nodes are in the bulk, row by row.
pub(super) fn find_blocks(bulk: &BlockPattern, nodes: &[NodeId], positions: &mut Vec<u32>) {
    for &row in nodes {
        let found = nodes.iter().map(|&column| bulk.position(row, column));
        positions.extend(found.map(|at| at.map_or(NONE, |at| at as u32)));
    }
}

/// Sets `n` values to zero.
/// The place and the size of the largest value; one that is not finite is the largest.
pub(super) fn largest(values: &[f64]) -> Option<(usize, f64)> {
    let sizes = values.iter().map(|value| value.abs()).enumerate();
    sizes.max_by(|a, b| a.1.total_cmp(&b.1))
}
