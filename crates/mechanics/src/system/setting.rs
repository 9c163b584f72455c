//! One assembly: what its threads share.

use super::assembly::{Assembly, Shared, Task};
use super::buffer::{Buffer, Contribution, Slot};
use super::elimination::Expanded;
use super::shares::{Share, divide};
use super::sink::{fill_up, square};
use super::strip::{Strip, find_blocks, find_places};
use super::{Dof, Elimination, Layout, NO_DOF, Part, State, TermError, Work};
use rayon::prelude::*;
use signorini_geometry::mesh::NodeId;
use signorini_linear::sparsity::{BlockPattern, Pattern};

/// What contributions are added to.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub layout: &'a Layout,
    pub elimination: &'a Elimination,
    pub trial: &'a State,
    pub bulk: &'a BlockPattern,
    pub interface: &'a Pattern,
    /// Whether what follows has the stiffness of forces that turn with it.
    pub turning: bool,
    pub shared: Option<&'a Shared>,
}

impl Setting<'_> {
    /// Evaluates chunks and adds them; false where stiffness of the bulk went into the interface. What is shared out is
    /// left to the threads that have it; all else is evaluated wave by wave, each of chunks of the same part.
    pub fn run(
        self,
        evaluate: impl Fn(&Task, &mut Work, &mut Buffer) -> Result<(), TermError> + Sync,
        size: impl Fn(Part) -> usize,
        tasks: &mut [Task],
        slots: &mut [Slot],
        expanded: &mut Expanded,
        out: &mut Assembly,
    ) -> Result<bool, TermError> {
        let one = |(slot, task): (&mut Slot, &mut Task)| {
            let Slot {
                buffer,
                work,
                failure,
                ..
            } = slot;
            buffer.clear();
            *failure = evaluate(task, work, buffer).err();
            let mut dofs = buffer.dofs.iter().chain(&buffer.coupled);
            buffer.has_dependent = dofs.any(|&dof| self.elimination.depends(dof, self.layout));
            if task.part == Part::Bulk && task.positions.is_empty() {
                self.find(buffer, &mut task.positions);
            }
        };
        let mut is_apart = true;
        let mut rest = tasks;
        if let Some(shared) = self.shared.filter(|shared| !shared.shares.is_empty()) {
            let (tasks, others) = rest.split_at_mut(shared.ntask);
            let outcome = self.run_shared(&evaluate, &shared.shares, tasks, slots, out);
            self.agree_on(outcome, &evaluate, tasks, slots)?;
            rest = others;
        }
        while let Some(first) = rest.first() {
            let part = first.part;
            let same = rest.iter().position(|task| task.part != part);
            let size = size(part).min(slots.len()).min(same.unwrap_or(rest.len()));
            let (tasks, others) = rest.split_at_mut(size);
            rest = others;
            let slots = &mut slots[..size];
            match tasks {
                [task] => slots.iter_mut().for_each(|slot| one((slot, task))),
                _ => slots.par_iter_mut().zip(&mut *tasks).for_each(one),
            }
            if let Some(failure) = slots.iter_mut().find_map(|slot| slot.failure.take()) {
                return Err(failure);
            }
            is_apart &= self.add(slots, tasks, expanded, out);
        }
        Ok(is_apart)
    }

    /// The first failure of all ranks, which each evaluates for itself.
    fn agree_on(
        self,
        outcome: Result<(), (usize, TermError)>,
        evaluate: &impl Fn(&Task, &mut Work, &mut Buffer) -> Result<(), TermError>,
        tasks: &[Task],
        slots: &mut [Slot],
    ) -> Result<(), TermError> {
        let Some(partition) = &self.bulk.partition else {
            return outcome.map_err(|(_, failure)| failure);
        };
        let own = outcome
            .as_ref()
            .err()
            .map_or(u64::MAX, |(at, _)| *at as u64);
        let first = partition.least(own).map_err(TermError::Ranks)?;
        match (outcome, tasks.get(first as usize), slots.first_mut()) {
            (Err((at, failure)), ..) if at as u64 == first => Err(failure),
            (_, Some(task), Some(Slot { buffer, work, .. })) => {
                buffer.clear();
                evaluate(task, work, buffer)
            }
            _ => Ok(()),
        }
    }

    /// Evaluates and adds the chunks that are shared out; fails with the first that fails.
    pub fn run_shared(
        self,
        evaluate: &(impl Fn(&Task, &mut Work, &mut Buffer) -> Result<(), TermError> + Sync),
        shares: &[Share],
        tasks: &[Task],
        slots: &mut [Slot],
        out: &mut Assembly,
    ) -> Result<(), (usize, TermError)> {
        let ends: Vec<usize> = shares.iter().map(|share| share.end).collect();
        let strips = self.strips_to(&ends[..ends.len().saturating_sub(1)], out);
        let all = strips.into_par_iter().zip(shares).zip(slots);
        let first = all.filter_map(|((mut strip, share), slot)| {
            let Slot { buffer, work, .. } = slot;
            share.chunks.iter().find_map(|&chunk| {
                let task = &tasks[chunk];
                buffer.clear();
                if let Err(failure) = evaluate(task, work, buffer) {
                    return Some((chunk, failure));
                }
                self.add_chunk(&mut strip, buffer, task);
                None
            })
        });
        match first.min_by_key(|(chunk, _)| *chunk) {
            Some(failure) => Err(failure),
            None => Ok(()),
        }
    }

    /// Adds chunks, one after the other at every entry; false where stiffness of the bulk went into the interface.
    ///
    /// Where no unknown follows others, threads share the rows among themselves, each with about as many nodes of what
    /// is added: an entry is the same sum whoever adds it up.
    pub fn add(
        self,
        slots: &[Slot],
        tasks: &[Task],
        expanded: &mut Expanded,
        out: &mut Assembly,
    ) -> bool {
        let buffers: Vec<&Buffer> = slots.iter().map(|slot| &slot.buffer).collect();
        let has_stiffness = buffers.iter().any(|buffer| !buffer.stiffness.is_empty());
        let has_dependent = buffers.iter().any(|buffer| buffer.has_dependent);
        let nstrip = rayon::current_num_threads();
        if nstrip == 1 || buffers.len() == 1 || has_dependent || !has_stiffness {
            let mut whole = Strip::whole(out);
            let chunks = buffers.into_iter().zip(tasks);
            return chunks.fold(true, |all, (buffer, task)| {
                self.add_expanded(&mut whole, buffer, task, expanded) & all
            });
        }
        let strips = self.strips(nstrip, &buffers, out);
        strips.into_par_iter().for_each(|mut strip| {
            for (buffer, task) in buffers.iter().zip(tasks) {
                self.add_chunk(&mut strip, buffer, task);
            }
        });
        true
    }

    /// The rows in strips.
    pub fn strips<'o>(
        self,
        nstrip: usize,
        buffers: &[&Buffer],
        out: &'o mut Assembly,
    ) -> Vec<Strip<'o>> {
        let (ndim, nnode) = (self.bulk.block.max(1), self.bulk.nrow());
        let dofs = buffers.iter().flat_map(|buffer| &buffer.dofs);
        let of_nodes = dofs.step_by(ndim).map(|&dof| dof / ndim as NodeId);
        let mut nodes: Vec<NodeId> = of_nodes.filter(|&node| (node as usize) < nnode).collect();
        let ends = divide(nstrip, nnode, &mut nodes);
        self.strips_to(&ends, out)
    }

    /// The rows in strips that end before these nodes, and the rest.
    pub fn strips_to<'o>(self, ends: &[usize], out: &'o mut Assembly) -> Vec<Strip<'o>> {
        let ndim = self.bulk.block.max(1);
        let mut strips = Vec::with_capacity(ends.len() + 1);
        let mut rest = Strip::whole(out);
        for &end in ends {
            let dof = end * ndim;
            let entries = [
                self.bulk.row_start.get(end).map(|at| at * ndim * ndim),
                self.interface.row_start.get(dof).copied(),
            ];
            let (strip, others) = rest.split_at(dof, entries.map(Option::unwrap_or_default));
            strips.push(strip);
            rest = others;
        }
        strips.push(rest);
        strips
    }

    /// Adds a chunk in which unknowns may follow others; false where stiffness of the bulk went into the interface.
    pub fn add_expanded(
        self,
        whole: &mut Strip<'_>,
        buffer: &Buffer,
        task: &Task,
        expanded: &mut Expanded,
    ) -> bool {
        if !buffer.has_dependent {
            self.add_chunk(whole, buffer, task);
            return true;
        }
        let depends = |dof: Dof| self.elimination.depends(dof, self.layout);
        let add_error = |strip: &mut Strip<'_>, dof: Dof, error: f64| {
            if depends(dof) {
                let (elimination, layout) = (self.elimination, self.layout);
                elimination.spread(dof, error, self.trial, layout, strip.uncertainty);
            } else {
                strip.add_error(dof, error);
            }
        };
        for &(dof, error) in &buffer.errors {
            add_error(whole, dof, error);
        }
        let mut positions = task.positions.as_slice();
        let mut full = Vec::new();
        let mut is_apart = true;
        for (own, dofs, force, stiffness) in buffer.iter() {
            for &dof in dofs {
                add_error(whole, dof, own.error);
            }
            let at_blocks = own.positions(self.layout.ndim(), &mut positions);
            if !dofs.iter().any(|&dof| depends(dof)) {
                whole.add_force(dofs, force);
                self.add_stiffness(whole, own, dofs, stiffness, at_blocks, task.part);
                continue;
            }
            let mut stiffness = stiffness;
            if own.is_symmetric {
                fill_up(stiffness, dofs.len(), self.layout.ndim(), &mut full);
                stiffness = &full;
            }
            self.elimination.expand(
                dofs,
                force,
                stiffness,
                self.turning,
                self.trial,
                self.layout,
                expanded,
            );
            whole.add_force(&expanded.dofs, &expanded.force);
            self.add_entries(whole, &expanded.dofs, &expanded.stiffness);
            is_apart &= task.part == Part::Interface;
        }
        for (rows, columns, stiffness) in buffer.couplings() {
            if !rows.iter().chain(columns).any(|&dof| depends(dof)) {
                self.add_entries_of(whole, rows, columns, stiffness);
                continue;
            }
            square(rows, columns, stiffness, &mut full);
            let (dofs, force) = (
                [rows, columns].concat(),
                vec![0.0; rows.len() + columns.len()],
            );
            let (elimination, layout) = (self.elimination, self.layout);
            elimination.expand(&dofs, &force, &full, false, self.trial, layout, expanded);
            self.add_entries(whole, &expanded.dofs, &expanded.stiffness);
        }
        is_apart
    }

    /// Adds what of a chunk belongs to a strip.
    pub fn add_chunk(self, strip: &mut Strip<'_>, buffer: &Buffer, task: &Task) {
        for &(dof, error) in &buffer.errors {
            strip.add_error(dof, error);
        }
        let mut positions = task.positions.as_slice();
        for (own, dofs, force, stiffness) in buffer.iter() {
            if own.error > 0.0 {
                dofs.iter().for_each(|&dof| strip.add_error(dof, own.error));
            }
            strip.add_force(dofs, force);
            let at_blocks = own.positions(self.layout.ndim(), &mut positions);
            self.add_stiffness(strip, own, dofs, stiffness, at_blocks, task.part);
        }
        for (rows, columns, stiffness) in buffer.couplings() {
            self.add_entries_of(strip, rows, columns, stiffness);
        }
    }

    pub fn add_stiffness(
        self,
        strip: &mut Strip<'_>,
        own: &Contribution,
        dofs: &[Dof],
        stiffness: &[f64],
        positions: &[u32],
        part: Part,
    ) {
        if stiffness.is_empty() {
            return;
        }
        match (part, self.layout.ndim()) {
            (Part::Interface, _) => self.add_entries(strip, dofs, stiffness),
            (Part::Bulk, 2) => strip.add_blocks::<2, 4>(stiffness, positions, own.is_symmetric),
            (Part::Bulk, _) => strip.add_blocks::<3, 9>(stiffness, positions, own.is_symmetric),
        }
    }

    /// Where the blocks of each contribution of a chunk are in the bulk.
    pub fn find(self, buffer: &Buffer, positions: &mut Vec<u32>) {
        let ndim = self.layout.ndim();
        let mut nodes: Vec<NodeId> = Vec::new();
        for (_, dofs, ..) in buffer.iter().filter(|(own, ..)| own.nstiffness > 0) {
            nodes.clear();
            nodes.extend(dofs.chunks_exact(ndim).map(|dofs| dofs[0] / ndim as u32));
            find_blocks(self.bulk, &nodes, positions);
        }
    }

    pub fn add_entries(self, strip: &mut Strip<'_>, dofs: &[Dof], stiffness: &[f64]) {
        self.add_entries_of(strip, dofs, dofs, stiffness);
    }

    /// Adds a stiffness of some rows against some columns to the interface.
    fn add_entries_of(self, strip: &mut Strip<'_>, rows: &[Dof], of: &[Dof], stiffness: &[f64]) {
        let mut places = std::mem::take(&mut strip.places);
        places.clear();
        let mut known: &[u32] = &[];
        for (row, values) in rows.iter().zip(stiffness.chunks_exact(of.len().max(1))) {
            if *row == NO_DOF || !strip.has(*row) {
                continue;
            }
            let (first, columns) = self.interface.row(*row);
            // those of one node have the same columns
            if columns != known {
                find_places(of, columns, &mut places);
                known = columns;
            }
            let to = strip.entries(first, columns.len());
            for (value, place) in values.iter().zip(&places) {
                if let Some(to) = to.get_mut(*place as usize) {
                    *to += value;
                }
            }
        }
        strip.places = places;
    }
}
