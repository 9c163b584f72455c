//! What a solid can do beyond forces: initial stiffness, elements, storage, samples.

use super::at::At;
use super::cells::{CHUNK, Cells};
use super::kernel::Sample;
use super::kernel::at_point;
use super::scratch::{Scratch, Wanted};
use super::term::Solid;
use crate::material::Strain;
use crate::system::{
    Archive, ArchiveError, Elementwise, InitialStiffness, PointSample, Sampled, Samples, Sink,
    State, Stored, TermError, Work,
};
use rayon::prelude::*;
use signorini_geometry::mesh::{CellId, NodeId};

impl InitialStiffness for Solid {
    fn id(&self) -> u64 {
        let of_step = 2 * self.nchanged() as u64 + self.kinematics as u64;
        (self.elements_id() << 16) + of_step
    }

    fn add_initial(
        &self,
        chunk: usize,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let scratch = work.of::<Scratch>();
        let (at, wanted) = (At::Start, Wanted::Stiffness);
        self.each(chunk, at, wanted, scratch, |_, _, _, s| {
            self.hand(at, s, out);
        })
    }

    fn is_initial(&self, trial: &State) -> bool {
        let at = |&node: &NodeId| (0..self.layout.ndim()).map(move |i| self.layout.node(node, i));
        let is_undeformed = |block: &Cells| {
            let mut displacements = block
                .nodes
                .iter()
                .flat_map(at)
                .map(|dof| trial.u[dof as usize]);
            let is_plain = block.nhistory == 0 && block.part.is_natural();
            is_plain && displacements.all(|u| u == 0.0)
        };
        let is_bare = self.temperature.is_none() && self.damping.stiff().is_none();
        is_bare && self.blocks.iter().all(is_undeformed)
    }
}

impl Elementwise for Solid {
    fn elements(&self, chunk: usize, take: &mut dyn FnMut(&[NodeId])) {
        if let Some(&(number, first, last)) = self.chunks.get(chunk) {
            let block = &self.blocks[number];
            let active = (first..last).filter(|cell| block.part.is_active(*cell));
            active.for_each(|cell| take(block.nodes_of(cell)));
        }
    }
}

impl Stored for Solid {
    /// Evaluates once more, from the last accepted history: trial history is kept nowhere, so that evaluation is pure.
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        self.damping.spent += self.dissipation(state)?;
        let next = |block: &Cells| -> Result<Vec<f64>, TermError> {
            let n = block.nhistory;
            let mut next = vec![0.0; block.history.len()];
            if n == 0 {
                return Ok(next);
            }
            let chunks = next.par_chunks_mut(CHUNK * n).enumerate();
            chunks.try_for_each_init(Scratch::default, |scratch, (chunk, next)| {
                scratch.size(block, self.layout.ndim(), Wanted::Forces);
                for (k, to) in next.chunks_exact_mut(n).enumerate() {
                    let cell = chunk * CHUNK + k;
                    // what a kernel does not write stays as it was
                    scratch
                        .new
                        .copy_from_slice(&block.history[cell * n..(cell + 1) * n]);
                    if block.part.is_active(cell) {
                        self.cell(block, cell, At::Trial(state), Wanted::Forces, scratch)?;
                    }
                    to.copy_from_slice(&scratch.new);
                }
                Ok(())
            })?;
            Ok(next)
        };
        let histories: Result<Vec<_>, _> = self.blocks.iter().map(next).collect();
        for (block, history) in self.blocks.iter_mut().zip(histories?) {
            block.history = history;
        }
        Ok(())
    }

    fn save(&self, out: &mut Archive) {
        for (number, block) in self.blocks.iter().enumerate() {
            if block.nhistory > 0 {
                out.put(self.archived(number), &block.history);
            }
        }
        self.damping.save(&self.name, out);
        self.save_plan(out);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        for number in 0..self.blocks.len() {
            let name = self.archived(number);
            let block = &mut self.blocks[number];
            if block.nhistory > 0 {
                from.get(&name, &mut block.history)?;
            }
        }
        self.damping.load(&self.name, from)?;
        self.load_plan(from)
    }
}

impl Sampled for Solid {
    fn sample(&self, state: &State, cells: &[CellId], out: &mut Samples) -> Result<(), TermError> {
        let mut scratch = Scratch::default();
        for block in &self.blocks {
            scratch.size(block, self.layout.ndim(), Wanted::Samples);
            for (cell, id) in block.ids.iter().enumerate() {
                if cells.binary_search(id).is_err() || !block.part.is_active(cell) {
                    continue;
                }
                self.cell(block, cell, At::Trial(state), Wanted::Samples, &mut scratch)?;
                let frames = block.frames.of(cell);
                let of_point = |(point, s): (usize, &Sample)| PointSample {
                    stress: s.stress,
                    strain: s.seen,
                    mechanical_strain: self.material().mechanical_strain(&Strain {
                        kinematics: self.kinematics,
                        value: s.seen,
                        temperature: s.temperature,
                        temperature_at_start: s.temperature_at_start,
                        axes: at_point(frames, point),
                    }),
                    plastic_strain: s.plastic_strain.unwrap_or(0.0),
                    energy: s.energy,
                    volume: s.volume_at_start,
                    axes: at_point(frames, point).copied(),
                };
                let points = scratch.samples.iter().enumerate();
                out.push(*id, block.points.rule, points.map(of_point));
            }
        }
        Ok(())
    }
}
