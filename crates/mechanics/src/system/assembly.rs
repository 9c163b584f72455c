//! From terms to one residual and one operator.

use super::elimination::Expanded;
use super::linear::Values;
use super::sparsity::{BlockPattern, NONE, Pattern};
use super::{
    Dof, Elimination, Layout, NO_DOF, Order, Part, PatternSink, Sink, State, Term, TermError, Work,
};
use rayon::prelude::*;
use signorini_geometry::mesh::NodeId;

/// Chunks of a wave for each thread: the fewer, the more of what is added is still in cache.
const PER_THREAD: usize = 4;
/// Chunks of a wave, at most: bounds the memory, and nothing else.
const WAVE: usize = 64;

/// Chunks that are evaluated before they are added. A single thread adds every chunk while it is in cache.
fn wave() -> usize {
    match rayon::current_num_threads() {
        1 => 1,
        threads => (PER_THREAD * threads).min(WAVE),
    }
}

/// The values that one assembly gives.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    /// r = f_int − f_ext at every raw dof; zero at dependent ones.
    pub residual: Vec<f64>,
    /// Sum of the absolute values of everything that was added to the residual.
    pub magnitude: Vec<f64>,
    /// Sum of the rounding errors that terms know of, beyond that of the magnitude.
    pub uncertainty: Vec<f64>,
    bulk: Vec<f64>,
    interface: Vec<f64>,
    /// The increment of which the bulk is, where it holds for all states in it.
    bulk_of: Option<u64>,
}

impl Assembly {
    /// The values of the operator.
    #[must_use]
    pub fn values(&self) -> Values<'_> {
        Values {
            bulk: &self.bulk,
            interface: &self.interface,
        }
    }
}

/// Evaluates terms by chunks, in parallel, and adds the results in a fixed order.
pub struct Assembler {
    tasks: Vec<Task>,
    bulk: BlockPattern,
    interface: Pattern,
    slots: Vec<Slot>,
    expanded: Expanded,
    /// Counts increments.
    increment: u64,
    /// Whether the stiffness of the bulk is the same at all states of the increment.
    is_constant: bool,
}

struct Task {
    term: usize,
    chunk: usize,
    part: Part,
    // where the blocks of each element of the chunk go, in order; found once
    positions: Vec<u32>,
}

#[derive(Default)]
struct Slot {
    work: Work,
    buffer: Buffer,
    failure: Option<TermError>,
    energy: Option<f64>,
}

/// What a chunk added, one contribution after the other.
#[derive(Default)]
struct Buffer {
    dofs: Vec<Dof>,
    sizes: Vec<usize>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
    stiffness_sizes: Vec<usize>,
    errors: Vec<(Dof, f64)>,
}

impl Sink for Buffer {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        debug_assert_eq!(dofs.len(), force.len());
        debug_assert!(stiffness.is_empty() || stiffness.len() == dofs.len() * dofs.len());
        self.sizes.push(dofs.len());
        self.stiffness_sizes.push(stiffness.len());
        self.dofs.extend_from_slice(dofs);
        self.force.extend_from_slice(force);
        self.stiffness.extend_from_slice(stiffness);
    }

    fn uncertain(&mut self, dofs: &[Dof], error: f64) {
        self.errors.extend(dofs.iter().map(|&d| (d, error)));
    }
}

impl Buffer {
    fn clear(&mut self) {
        self.dofs.clear();
        self.sizes.clear();
        self.force.clear();
        self.stiffness.clear();
        self.stiffness_sizes.clear();
        self.errors.clear();
    }
}

/// Cliques of a pattern, as they come.
struct Cliques<'a> {
    layout: &'a Layout,
    elimination: &'a Elimination,
    bulk: Vec<u32>,
    bulk_offsets: Vec<usize>,
    interface: Vec<u32>,
    interface_offsets: Vec<usize>,
    dofs: Vec<Dof>,
}

impl PatternSink for Cliques<'_> {
    fn bulk(&mut self, nodes: &[NodeId]) {
        let layout = *self.layout;
        let of_node = |&n: &NodeId| (0..layout.ndim).map(move |c| layout.node(n, c));
        let mut dofs = nodes.iter().flat_map(of_node);
        if dofs.any(|d| self.elimination.depends(d, &layout)) {
            let dofs: Vec<Dof> = nodes.iter().flat_map(of_node).collect();
            self.interface(&dofs);
            return;
        }
        self.bulk.extend_from_slice(nodes);
        self.bulk_offsets.push(self.bulk.len());
    }

    fn interface(&mut self, dofs: &[Dof]) {
        self.dofs.clear();
        self.elimination
            .independent(dofs, self.layout, &mut self.dofs);
        self.interface.extend_from_slice(&self.dofs);
        self.interface_offsets.push(self.interface.len());
    }
}

impl Assembler {
    /// Prepares the assembly of these terms.
    #[must_use]
    pub fn new(layout: &Layout, elimination: &Elimination, terms: &[Box<dyn Term>]) -> Self {
        let mut assembler = Self {
            tasks: Vec::new(),
            bulk: BlockPattern::empty(layout.nnode, layout.ndim),
            interface: Pattern::empty(layout.ndof()),
            slots: Vec::new(),
            expanded: Expanded::default(),
            increment: 0,
            is_constant: false,
        };
        assembler.begin_increment(terms);
        let cliques = collect(layout, elimination, terms);
        assembler.bulk = BlockPattern::from_cliques(
            layout.nnode,
            layout.ndim,
            &cliques.bulk,
            &cliques.bulk_offsets,
        );
        assembler.interface = Pattern::from_cliques(
            layout.ndof(),
            &cliques.interface,
            &cliques.interface_offsets,
        );
        assembler
    }

    /// Takes up the chunks of the terms, whose numbers may be others in each increment.
    pub fn begin_increment(&mut self, terms: &[Box<dyn Term>]) {
        let mut before = std::mem::take(&mut self.tasks).into_iter().peekable();
        for (number, term) in terms.iter().enumerate() {
            let mut chunks = 0..term.nchunk();
            while let Some(task) = before.next_if(|task| task.term == number) {
                // what is left over is dropped
                self.tasks.extend(chunks.next().map(|_| task));
            }
            self.tasks.extend(chunks.map(|chunk| Task {
                term: number,
                chunk,
                part: term.part(),
                positions: Vec::new(),
            }));
        }
        let mut bulk = terms.iter().filter(|term| term.part() == Part::Bulk);
        self.is_constant = bulk.all(|term| term.has_constant_stiffness());
        self.increment += 1;
        // one wave is evaluated while another one is added
        let two = 2 * wave().min(self.tasks.len());
        if self.slots.len() < two {
            self.slots.resize_with(two, Slot::default);
        }
    }

    /// The pattern of the bulk.
    #[must_use]
    pub const fn bulk(&self) -> &BlockPattern {
        &self.bulk
    }

    /// The pattern of the interface.
    #[must_use]
    pub const fn interface(&self) -> &Pattern {
        &self.interface
    }

    /// Makes room for what the terms of the interface couple now, and for nothing else: the pattern, and with it the
    /// order of elimination and every bit of the solution, must not depend on what was coupled long ago. Says whether it
    /// changed.
    pub fn update_interface(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
    ) -> bool {
        // solids with unknowns that follow others have entries here, too
        let cliques = collect(layout, elimination, terms);
        let (dofs, offsets) = (&cliques.interface, &cliques.interface_offsets);
        let now = Pattern::from_cliques(layout.ndof(), dofs, offsets);
        let changed = now != self.interface;
        self.interface = now;
        changed
    }

    /// Adds the largest stiffness there is to the diagonal at a dof, and returns it; `None` where it has no place.
    pub fn stiffen(&self, dof: Dof, out: &mut Assembly) -> Option<f64> {
        let all = out.bulk.iter().chain(&out.interface);
        let stiffness = all.fold(0.0, |most: f64, k| most.max(k.abs()));
        let (ndim, node) = (self.bulk.block, dof / self.bulk.block.max(1) as u32);
        let of_block = (node as usize) < self.bulk.nrow();
        let block = of_block.then(|| self.bulk.position(node, node)).flatten();
        let to = match block {
            Some(block) => {
                let axis = dof as usize % ndim;
                out.bulk.get_mut(block * ndim * ndim + axis * (ndim + 1))
            }
            None => {
                let position = self.interface.position(dof, dof)?;
                out.interface.get_mut(position)
            }
        };
        *to? += stiffness;
        out.bulk_of = None;
        Some(stiffness)
    }

    /// Evaluates all terms at a trial state into `out`.
    ///
    /// # Errors
    /// The first failure in the order of terms and chunks.
    pub fn assemble(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
        trial: &State,
        order: Order,
        out: &mut Assembly,
    ) -> Result<(), TermError> {
        reset(&mut out.residual, layout.ndof());
        reset(&mut out.magnitude, layout.ndof());
        reset(&mut out.uncertainty, layout.ndof());
        let is_kept = out.bulk_of == Some(self.increment);
        if order == Order::Tangent {
            if !is_kept {
                out.bulk_of = None;
                reset(&mut out.bulk, self.bulk.nvalue());
            }
            reset(&mut out.interface, self.interface.nentry());
        }
        // unknowns that follow others put stiffness of the bulk into the interface
        let mut stays = self.is_constant && order == Order::Tangent;
        let order_of = |task: &Task| {
            if is_kept && task.part == Part::Bulk {
                Order::Residual
            } else {
                order
            }
        };
        let Self {
            tasks,
            bulk,
            interface,
            slots,
            expanded,
            increment,
            ..
        } = self;
        let evaluate = |wave: &[Task], slots: &mut [Slot]| {
            let one = |(slot, task): (&mut Slot, &Task)| {
                slot.buffer.clear();
                let outcome = terms[task.term].evaluate(
                    task.chunk,
                    trial,
                    order_of(task),
                    &mut slot.work,
                    &mut slot.buffer,
                );
                slot.failure = outcome.err();
            };
            match wave {
                [_] => slots.iter_mut().zip(wave).for_each(one),
                _ => slots.par_iter_mut().zip(wave).for_each(one),
            }
        };
        let mut add = |wave: &mut [Task], slots: &mut [Slot]| {
            for (slot, task) in slots.iter_mut().zip(wave) {
                if let Some(failure) = slot.failure.take() {
                    return Err(failure);
                }
                let mut scatter = Scatter {
                    layout,
                    elimination,
                    trial,
                    bulk,
                    interface,
                    order,
                    expanded: &mut *expanded,
                    out: &mut *out,
                };
                stays &= scatter.add(&slot.buffer, task);
            }
            Ok(())
        };
        let half = slots.len() / 2;
        let (mut now, mut next) = slots.split_at_mut(half);
        let size = wave().min(half).max(1);
        let mut waves = tasks.chunks_mut(size);
        let mut wave = waves.next();
        if let Some(first) = &wave {
            evaluate(first, now);
        }
        while let Some(tasks) = wave {
            wave = waves.next();
            match &wave {
                // a single thread has no use for two at once
                Some(after) if size > 1 => {
                    rayon::join(|| add(tasks, now), || evaluate(after, next)).0?;
                    std::mem::swap(&mut now, &mut next);
                }
                Some(after) => {
                    add(tasks, now)?;
                    evaluate(after, now);
                }
                None => add(tasks, now)?,
            }
        }
        if stays {
            out.bulk_of = Some(*increment);
        }
        if let Some(magnitude) = elimination
            .course()
            .and_then(|c| out.magnitude.get_mut(c as usize))
        {
            *magnitude = 0.0;
        }
        Ok(())
    }

    /// The potential energy at a trial state, where every term has one.
    ///
    /// # Errors
    /// The first failure in the order of terms and chunks.
    pub fn energy(
        &mut self,
        terms: &[Box<dyn Term>],
        trial: &State,
    ) -> Result<Option<f64>, TermError> {
        let mut total = 0.0;
        let size = wave().min(self.slots.len()).max(1);
        for wave in self.tasks.chunks(size) {
            let evaluate = |(slot, task): (&mut Slot, &Task)| match terms[task.term].energy(
                task.chunk,
                trial,
                &mut slot.work,
            ) {
                Ok(energy) => slot.energy = energy,
                Err(failure) => slot.failure = Some(failure),
            };
            if wave.len() == 1 {
                self.slots.iter_mut().zip(wave).for_each(evaluate);
            } else {
                self.slots.par_iter_mut().zip(wave).for_each(evaluate);
            }
            for (slot, _) in self.slots.iter_mut().zip(wave) {
                if let Some(failure) = slot.failure.take() {
                    return Err(failure);
                }
                match slot.energy {
                    Some(energy) => total += energy,
                    None => return Ok(None),
                }
            }
        }
        Ok(Some(total))
    }
}

/// Adds one chunk after the other.
struct Scatter<'a> {
    layout: &'a Layout,
    elimination: &'a Elimination,
    trial: &'a State,
    bulk: &'a BlockPattern,
    interface: &'a Pattern,
    order: Order,
    expanded: &'a mut Expanded,
    out: &'a mut Assembly,
}

impl Scatter<'_> {
    /// Adds a chunk; false where stiffness of the bulk went into the interface.
    fn add(&mut self, buffer: &Buffer, task: &mut Task) -> bool {
        for &(dof, error) in &buffer.errors {
            if self.elimination.depends(dof, self.layout) {
                let out = &mut self.out.uncertainty;
                self.elimination
                    .spread(dof, error, self.trial, self.layout, out);
            } else if let Some(to) = self.out.uncertainty.get_mut(dof as usize) {
                *to += error;
            }
        }
        let (mut at, mut at_stiffness, mut at_position) = (0, 0, 0);
        let mut is_apart = true;
        let first_time = task.positions.is_empty();
        for (&n, &nk) in buffer.sizes.iter().zip(&buffer.stiffness_sizes) {
            let dofs = &buffer.dofs[at..at + n];
            let force = &buffer.force[at..at + n];
            let stiffness = &buffer.stiffness[at_stiffness..at_stiffness + nk];
            at += n;
            at_stiffness += nk;
            if dofs
                .iter()
                .any(|&d| self.elimination.depends(d, self.layout))
            {
                let mut expanded = std::mem::take(self.expanded);
                self.elimination.expand(
                    dofs,
                    force,
                    stiffness,
                    self.order == Order::Tangent,
                    self.trial,
                    self.layout,
                    &mut expanded,
                );
                self.force(&expanded.dofs, &expanded.force);
                self.scalar(&expanded.dofs, &expanded.stiffness);
                *self.expanded = expanded;
                is_apart &= task.part == Part::Interface;
                continue;
            }
            self.force(dofs, force);
            if stiffness.is_empty() {
                continue;
            }
            if task.part == Part::Interface {
                self.scalar(dofs, stiffness);
                continue;
            }
            let nblock = n / self.layout.ndim;
            if first_time {
                self.find(dofs, &mut task.positions);
            }
            let end = at_position + nblock * nblock;
            let positions = &task.positions[at_position..end];
            match self.layout.ndim {
                2 => add_blocks::<2>(&mut self.out.bulk, stiffness, positions, nblock),
                _ => add_blocks::<3>(&mut self.out.bulk, stiffness, positions, nblock),
            }
            at_position = end;
        }
        is_apart
    }

    fn force(&mut self, dofs: &[Dof], force: &[f64]) {
        for (&dof, f) in dofs.iter().zip(force) {
            if dof != NO_DOF {
                self.out.residual[dof as usize] += f;
                self.out.magnitude[dof as usize] += f.abs();
            }
        }
    }

    /// Where the blocks of an element are in the bulk.
    fn find(&self, dofs: &[Dof], positions: &mut Vec<u32>) {
        let ndim = self.layout.ndim;
        let node = |d: &[Dof]| d[0] / ndim as u32;
        for row in dofs.chunks_exact(ndim) {
            for column in dofs.chunks_exact(ndim) {
                let found = self.bulk.position(node(row), node(column));
                positions.push(found.map_or(NONE, |p| p as u32));
            }
        }
    }

    fn scalar(&mut self, dofs: &[Dof], stiffness: &[f64]) {
        for (row, values) in dofs.iter().zip(stiffness.chunks_exact(dofs.len().max(1))) {
            if *row == NO_DOF {
                continue;
            }
            for (column, value) in dofs.iter().zip(values) {
                if *column == NO_DOF || *value == 0.0 {
                    continue;
                }
                // a dead force that turns with nothing but itself finds no place, and needs none
                if let Some(position) = self.interface.position(*row, *column) {
                    self.out.interface[position] += value;
                }
            }
        }
    }
}

/// Adds the `nblock × nblock` blocks of an element where they belong in the bulk.
fn add_blocks<const ND: usize>(
    bulk: &mut [f64],
    stiffness: &[f64],
    positions: &[u32],
    nblock: usize,
) {
    let rows = stiffness.chunks_exact(nblock * ND * ND);
    for (rows, positions) in rows.zip(positions.chunks_exact(nblock)) {
        for (column, &position) in positions.iter().enumerate() {
            debug_assert_ne!(position, NONE, "an element outside its own pattern");
            let at = position as usize * ND * ND;
            let block = &mut bulk[at..at + ND * ND];
            for i in 0..ND {
                let from = (i * nblock + column) * ND;
                let from = &rows[from..from + ND];
                for j in 0..ND {
                    block[i * ND + j] += from[j];
                }
            }
        }
    }
}

fn reset(values: &mut Vec<f64>, n: usize) {
    values.clear();
    values.resize(n, 0.0);
}

fn collect<'a>(
    layout: &'a Layout,
    elimination: &'a Elimination,
    terms: &[Box<dyn Term>],
) -> Cliques<'a> {
    let mut cliques = Cliques {
        layout,
        elimination,
        bulk: Vec::new(),
        bulk_offsets: vec![0],
        interface: Vec::new(),
        interface_offsets: vec![0],
        dofs: Vec::new(),
    };
    for term in terms {
        term.pattern(&mut cliques);
    }
    cliques
}
