//! From terms to one residual and one operator.

use super::elimination::Expanded;
use super::shares::{Share, divide, share_out};
use super::{
    Dof, Elimination, InitialStiffness, Layout, Lifetime, NO_DOF, Order, Part, PatternSink, Sink,
    State, Term, TermError, Work,
};
use rayon::prelude::*;
use signorini_geometry::mesh::NodeId;
use signorini_linear::Values;
use signorini_linear::sparsity::{BlockPattern, NONE, Pattern};

/// Compliance of redundant multipliers over that of what they act on: far below all that is of interest, far above rounding.
const YIELDING: f64 = 1e-6;

/// How many times the largest stiffness of bodies another may be before rounding errors hide theirs.
const HIDING: f64 = 1e13;

/// Chunks of a wave for each thread, of which stiffness is wanted: the fewer, the more of what is added is in cache.
const PER_THREAD: usize = 4;
/// Chunks of a wave, at most: bounds the memory, and nothing else.
const WAVE: usize = 64;
/// Mixes numbers of terms into one.
const MIX: u64 = 0x9e37_79b9_7f4a_7c15;
/// Entries that are set to zero by one task.
const ENTRIES: usize = 1 << 16;

/// Chunks that are evaluated before they are added. A single thread adds every chunk while it is in cache.
fn wave(order: Order) -> usize {
    match (rayon::current_num_threads(), order) {
        (1, _) => 1,
        (threads, Order::Tangent) => (PER_THREAD * threads).min(WAVE),
        (_, Order::Residual) => WAVE,
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
    /// The period of which the bulk is, where it holds for all states in it.
    bulk_of: Option<u64>,
}

impl Assembly {
    /// Sets forces, and what is known of their rounding, to zero.
    fn reset_forces(&mut self, ndof: usize) {
        for values in [
            &mut self.residual,
            &mut self.magnitude,
            &mut self.uncertainty,
        ] {
            reset(values, ndof);
        }
    }

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
    /// Those of the bulk first, and of these first the ones whose elements are known, as far as that has been found out.
    tasks: Vec<Task>,
    /// The tasks whose elements are known, and who adds them up; `None` where that is to be found out.
    pub(super) shared: Option<Shared>,
    bulk: BlockPattern,
    interface: Pattern,
    slots: Vec<Slot>,
    expanded: Expanded,
    /// How long the stiffness of the bulk is the same.
    lasts: Lifetime,
    /// Counts what it is the same in at most: steps, or increments.
    period: u64,
}

/// What is known of the first tasks.
pub(super) struct Shared {
    /// How many they are.
    ntask: usize,
    /// The number of threads that they are shared out for.
    nthread: usize,
    pub shares: Vec<Share>,
}

struct Task {
    term: usize,
    chunk: usize,
    part: Part,
    /// Whether its elements are known, and none has unknowns that follow others.
    is_known: bool,
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
    contributions: Vec<Contribution>,
    dofs: Vec<Dof>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
    /// Errors at other dofs than those of a contribution.
    errors: Vec<(Dof, f64)>,
    /// Whether unknowns in it follow others.
    has_dependent: bool,
}

/// One contribution: how much of the lists is its own.
struct Contribution {
    ndof: usize,
    nstiffness: usize,
    /// Whether the stiffness is in blocks as [`Sink::add_symmetric`] has them.
    is_symmetric: bool,
    /// The uncertainty of its forces.
    error: f64,
}

impl Contribution {
    /// Takes the places of its blocks in the bulk off a list.
    fn positions<'p>(&self, ndim: usize, all: &mut &'p [u32]) -> &'p [u32] {
        let nblock = if self.nstiffness > 0 {
            self.ndof / ndim.max(1)
        } else {
            0
        };
        all.split_off(..nblock * nblock).unwrap_or_default()
    }
}

impl Buffer {
    fn push(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64], is_symmetric: bool) {
        debug_assert_eq!(dofs.len(), force.len());
        self.contributions.push(Contribution {
            ndof: dofs.len(),
            nstiffness: stiffness.len(),
            is_symmetric,
            error: 0.0,
        });
        self.dofs.extend_from_slice(dofs);
        self.force.extend_from_slice(force);
        self.stiffness.extend_from_slice(stiffness);
    }

    fn clear(&mut self) {
        self.contributions.clear();
        self.dofs.clear();
        self.force.clear();
        self.stiffness.clear();
        self.errors.clear();
    }

    /// Each contribution with its dofs, forces and stiffness.
    fn iter(&self) -> impl Iterator<Item = (&Contribution, &[Dof], &[f64], &[f64])> {
        let (mut at, mut at_stiffness) = (0, 0);
        self.contributions.iter().map(move |own| {
            let (of_dofs, of_stiffness) = (
                at..at + own.ndof,
                at_stiffness..at_stiffness + own.nstiffness,
            );
            (at, at_stiffness) = (of_dofs.end, of_stiffness.end);
            (
                own,
                &self.dofs[of_dofs.clone()],
                &self.force[of_dofs],
                &self.stiffness[of_stiffness],
            )
        })
    }
}

impl Sink for Buffer {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        debug_assert!(stiffness.is_empty() || stiffness.len() == dofs.len() * dofs.len());
        self.push(dofs, force, stiffness, false);
    }

    fn add_symmetric(&mut self, dofs: &[Dof], force: &[f64], blocks: &[f64], _: usize) {
        self.push(dofs, force, blocks, true);
    }

    fn uncertain(&mut self, dofs: &[Dof], error: f64) {
        match self.contributions.last_mut() {
            Some(last) if self.dofs.ends_with(dofs) && last.ndof == dofs.len() => {
                last.error += error;
            }
            _ => self.errors.extend(dofs.iter().map(|&d| (d, error))),
        }
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

impl Cliques<'_> {
    /// The pattern of the interface.
    fn of_interface(&self) -> Pattern {
        let (dofs, offsets) = (&self.interface, &self.interface_offsets);
        Pattern::from_cliques(self.layout.ndof(), dofs, offsets)
    }
}

impl PatternSink for Cliques<'_> {
    fn bulk(&mut self, nodes: &[NodeId]) {
        let layout = self.layout;
        let of_node = |&n: &NodeId| (0..layout.ndim()).map(move |c| layout.node(n, c));
        let mut dofs = nodes.iter().flat_map(of_node);
        if dofs.any(|d| self.elimination.depends(d, layout)) {
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
        let cliques = collect(layout, elimination, terms);
        let bulk = BlockPattern::from_cliques(
            layout.nnode(),
            layout.ndim(),
            &cliques.bulk,
            &cliques.bulk_offsets,
        );
        Self::with(bulk, &cliques, terms)
    }

    /// Prepares the assembly of the same terms as if for the first time: their bulk never changes.
    #[must_use]
    pub fn renewed(
        self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
    ) -> Self {
        Self::with(self.bulk, &collect(layout, elimination, terms), terms)
    }

    fn with(bulk: BlockPattern, cliques: &Cliques<'_>, terms: &[Box<dyn Term>]) -> Self {
        let mut assembler = Self {
            tasks: Vec::new(),
            shared: None,
            bulk,
            interface: cliques.of_interface(),
            slots: Vec::new(),
            expanded: Expanded::default(),
            lasts: Lifetime::State,
            period: 0,
        };
        assembler.begin_increment(terms);
        assembler
    }

    /// A step begins: what terms are may change.
    pub fn begin_step(&mut self) {
        self.period += 1;
    }

    /// Takes up the chunks of the terms, whose numbers may be others in each increment.
    pub fn begin_increment(&mut self, terms: &[Box<dyn Term>]) {
        self.take_up(terms);
        let all = terms.iter().map(|term| term.properties());
        let bulk = all.filter(|of| of.part == Part::Bulk);
        let lasts = bulk.map(|of| of.lifetime).min();
        let before = std::mem::replace(&mut self.lasts, lasts.unwrap_or(Lifetime::Step));
        if self.lasts.min(before) < Lifetime::Step {
            self.period += 1;
        }
        let most = wave(Order::Residual).min(self.tasks.len());
        if self.slots.len() < most {
            self.slots.resize_with(most, Slot::default);
        }
    }

    fn take_up(&mut self, terms: &[Box<dyn Term>]) {
        let mut count = vec![0; terms.len()];
        self.tasks.iter().for_each(|task| count[task.term] += 1);
        for (number, (term, count)) in terms.iter().zip(count).enumerate() {
            let (nchunk, part) = (term.nchunk(), term.properties().part);
            if nchunk == count {
                continue;
            }
            self.tasks
                .retain(|task| task.term != number || task.chunk < nchunk);
            self.tasks.extend((count..nchunk).map(|chunk| Task {
                term: number,
                chunk,
                part,
                is_known: false,
                positions: Vec::new(),
            }));
            if part == Part::Bulk {
                self.shared = None;
            }
        }
        self.sort();
    }

    /// Puts tasks into their order, which depends on nothing but what the terms are.
    fn sort(&mut self) {
        let order = |task: &Task| {
            (
                task.part != Part::Bulk,
                !task.is_known,
                task.term,
                task.chunk,
            )
        };
        self.tasks.sort_by_key(order);
    }

    /// Finds out which tasks have known elements, where these go, and who adds them up.
    fn share_out(&mut self, layout: &Layout, elimination: &Elimination, terms: &[Box<dyn Term>]) {
        let nthread = rayon::current_num_threads();
        let known = self.shared.as_ref().map(|shared| shared.nthread);
        if known == Some(nthread) {
            return;
        }
        let bulk = &self.bulk;
        let find = |task: &mut Task| {
            if task.part != Part::Bulk || !task.positions.is_empty() {
                return;
            }
            let Some(elementwise) = terms[task.term].capabilities().elementwise else {
                return;
            };
            let mut depends = false;
            elementwise.elements(task.chunk, &mut |nodes| {
                let mut dofs = nodes.iter().flat_map(|&node| {
                    let axes = 0..layout.ndim();
                    axes.map(move |axis| layout.node(node, axis))
                });
                depends |= dofs.any(|dof| elimination.depends(dof, layout));
                find_blocks(bulk, nodes, &mut task.positions);
            });
            task.is_known = !depends && !task.positions.is_empty();
            if depends {
                task.positions.clear();
            }
        };
        if known.is_none() {
            self.tasks.par_iter_mut().for_each(find);
            self.sort();
        }
        let ntask = self.tasks.partition_point(|task| task.is_known);
        let tasks = &self.tasks[..ntask];
        let elements = |at: usize, take: &mut dyn FnMut(&[NodeId])| {
            if let Some(term) = terms[tasks[at].term].capabilities().elementwise {
                term.elements(tasks[at].chunk, take);
            }
        };
        self.shared = Some(Shared {
            ntask,
            nthread,
            shares: share_out(nthread, layout.nnode(), ntask, elements),
        });
        if self.slots.len() < nthread {
            self.slots.resize_with(nthread, Slot::default);
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
        let now = collect(layout, elimination, terms).of_interface();
        let changed = now != self.interface;
        if changed {
            self.interface = now;
        }
        changed
    }

    /// The dof in whose row of the operator the largest number is; one that is not finite is the largest.
    pub fn largest_entry(&self, out: &Assembly) -> Option<Dof> {
        let row = |starts: &[usize], at: usize| {
            let begun = starts.partition_point(|&start| start <= at);
            begun.checked_sub(1)
        };
        let (bulk, interface) = (largest(&out.bulk), largest(&out.interface));
        let of_interface = match (bulk, interface) {
            (Some((_, k)), Some((_, i))) => i.total_cmp(&k).is_gt(),
            (_, other) => other.is_some(),
        };
        let ndim = self.bulk.block;
        let dof = if of_interface {
            row(&self.interface.row_start, interface?.0)?
        } else {
            let (node, within) = (bulk?.0 / (ndim * ndim), bulk?.0 % (ndim * ndim));
            row(&self.bulk.row_start, node)? * ndim + within / ndim
        };
        Some(dof as Dof)
    }

    /// Whether the stiffness of bodies is lost in the rounding errors of that of what acts between them.
    pub fn hides_bodies(&self, out: &Assembly) -> bool {
        let [bulk, interface] = [&out.bulk, &out.interface].map(|values| largest(values));
        bulk.zip(interface).is_some_and(|(k, i)| i.1 > HIDING * k.1)
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

    /// Adds a compliance to multipliers that act on unknowns with a stiffness, in the tangent `out` alone: `YIELDING` times
    ///
    /// ```text
    /// Σ_j B_j² / K_jj                                                                          (E4)
    /// ```
    ///
    /// with the coefficients `B_j` of the multiplier and the stiffness `K_jj` of what they act on, which is about the compliance
    /// of its equation once displacements are eliminated. Returns the number of these multipliers.
    ///
    /// Where several are redundant, the tangent is singular though the problem is not: with this each takes the share that a
    /// very stiff joint would give it. Residuals stay as they are, so that the state that is found is not changed.
    pub fn relax(&self, layout: &Layout, out: &mut Assembly) -> usize {
        let pattern = &self.interface;
        let multipliers =
            layout.multiplier(0) as usize..layout.multiplier(layout.nmultiplier()) as usize;
        let mut added: Vec<(usize, f64)> = Vec::new();
        for row in multipliers.clone() {
            let Some(&[begin, end]) = pattern.row_start.get(row..row + 2) else {
                continue;
            };
            let columns = pattern.column.get(begin..end).unwrap_or_default();
            let coefficients = out.interface.get(begin..end).unwrap_or_default();
            let mut compliance = 0.0;
            for (&column, b) in columns.iter().zip(coefficients) {
                if *b != 0.0 && !multipliers.contains(&(column as usize)) {
                    let stiffness = self.stiffness_of(column, out);
                    compliance += if stiffness > 0.0 {
                        b * b / stiffness
                    } else {
                        0.0
                    };
                }
            }
            let diagonal = pattern.position(row as Dof, row as Dof);
            if let Some(at) = diagonal.filter(|_| compliance > 0.0) {
                added.push((at, YIELDING * compliance));
            }
        }
        for &(at, compliance) in &added {
            if let Some(entry) = out.interface.get_mut(at) {
                *entry -= compliance;
            }
        }
        added.len()
    }

    /// The largest entry of the stiffness of the bodies.
    pub fn stiffest(of: &Assembly) -> f64 {
        of.bulk.iter().fold(0.0, |most: f64, k| most.max(k.abs()))
    }

    /// The entry of an unknown on the diagonal of a tangent.
    fn stiffness_of(&self, dof: Dof, of: &Assembly) -> f64 {
        let (ndim, node) = (self.bulk.block, dof / self.bulk.block.max(1) as u32);
        let in_bulk = (node as usize) < self.bulk.nrow();
        let block = in_bulk.then(|| self.bulk.position(node, node)).flatten();
        let place = block.map(|block| block * ndim * ndim + dof as usize % ndim * (ndim + 1));
        let of_bulk = place.and_then(|at| of.bulk.get(at));
        let position = self.interface.position(dof, dof);
        let of_interface = position.and_then(|at| of.interface.get(at));
        of_bulk.copied().unwrap_or_default() + of_interface.copied().unwrap_or_default()
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
        self.share_out(layout, elimination, terms);
        out.reset_forces(layout.ndof());
        let is_kept = out.bulk_of == Some(self.period);
        if order == Order::Tangent {
            if !is_kept {
                out.bulk_of = None;
                reset(&mut out.bulk, self.bulk.nvalue());
            }
            reset(&mut out.interface, self.interface.nentry());
        }
        // unknowns that follow others put stiffness of the bulk into the interface
        let mut stays = self.is_constant() && order == Order::Tangent;
        let order_of = |task: &Task| {
            if is_kept && task.part == Part::Bulk {
                Order::Residual
            } else {
                order
            }
        };
        let Self {
            tasks,
            shared,
            bulk,
            interface,
            slots,
            expanded,
            period,
            ..
        } = self;
        let setting = Setting {
            layout,
            elimination,
            trial,
            bulk,
            interface,
            order,
            shared: shared.as_ref(),
        };
        let evaluate = |task: &Task, work: &mut Work, buffer: &mut Buffer| {
            let term = &terms[task.term];
            term.evaluate(task.chunk, trial, order_of(task), work, buffer)
        };
        let of_bulk = if is_kept { Order::Residual } else { order };
        let (of_bulk, of_interface) = (wave(of_bulk), wave(order));
        let size = |part: Part| match part {
            Part::Bulk => of_bulk,
            Part::Interface => of_interface,
        };
        stays &= setting.run(evaluate, size, tasks, slots, expanded, out)?;
        if stays {
            out.bulk_of = Some(*period);
        }
        if let Some(magnitude) = elimination
            .course()
            .and_then(|c| out.magnitude.get_mut(c as usize))
        {
            *magnitude = 0.0;
        }
        Ok(())
    }

    /// Whether the stiffness of the bulk is the same at all states of the increment.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.lasts > Lifetime::State
    }

    /// Identifies the initial stiffness of the bulk in the present step. Equal ids mean equal stiffness.
    #[must_use]
    pub fn start(&self, terms: &[Box<dyn Term>]) -> u64 {
        bulk(terms).fold(0, |all, term| {
            let initial = term.capabilities().initial_stiffness;
            let id = initial.map_or(0, InitialStiffness::id);
            all.wrapping_mul(MIX).wrapping_add(id)
        })
    }

    /// Whether the stiffness of the bulk at a state is that at the start of a run.
    #[must_use]
    pub fn is_at_start(&self, terms: &[Box<dyn Term>], trial: &State) -> bool {
        bulk(terms).all(|term| {
            let initial = term.capabilities().initial_stiffness;
            initial.is_some_and(|of| of.is_initial(trial))
        })
    }

    /// The values of the bulk at the start of a run: undeformed, without history.
    ///
    /// # Errors
    /// The first failure in the order of terms and chunks.
    pub fn bulk_at_start(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
        state: &State,
    ) -> Result<Vec<f64>, TermError> {
        let mut out = Assembly::default();
        out.reset_forces(layout.ndof());
        reset(&mut out.bulk, self.bulk.nvalue());
        reset(&mut out.interface, self.interface.nentry());
        let Self {
            tasks,
            shared,
            bulk,
            interface,
            slots,
            expanded,
            ..
        } = self;
        let setting = Setting {
            layout,
            elimination,
            trial: state,
            bulk,
            interface,
            order: Order::Tangent,
            shared: shared.as_ref(),
        };
        let evaluate = |task: &Task, work: &mut Work, buffer: &mut Buffer| {
            let of_bulk = task.part == Part::Bulk;
            let initial = terms[task.term].capabilities().initial_stiffness;
            match initial.filter(|_| of_bulk) {
                Some(initial) => initial.add_initial(task.chunk, work, buffer),
                None => Ok(()),
            }
        };
        let size = wave(Order::Tangent);
        setting.run(evaluate, |_| size, tasks, slots, expanded, &mut out)?;
        Ok(out.bulk)
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
        let size = wave(Order::Residual).min(self.slots.len()).max(1);
        for wave in self.tasks.chunks(size) {
            let evaluate = |(slot, task): (&mut Slot, &Task)| {
                let energy = terms[task.term].energy(task.chunk, trial, &mut slot.work);
                // nothing stays of a wave before it
                (slot.energy, slot.failure) = match energy {
                    Ok(energy) => (energy, None),
                    Err(failure) => (None, Some(failure)),
                };
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

/// What contributions are added to.
#[derive(Clone, Copy)]
struct Setting<'a> {
    layout: &'a Layout,
    elimination: &'a Elimination,
    trial: &'a State,
    bulk: &'a BlockPattern,
    interface: &'a Pattern,
    order: Order,
    shared: Option<&'a Shared>,
}

impl Setting<'_> {
    /// Evaluates chunks and adds them; false where stiffness of the bulk went into the interface. What is shared out is
    /// left to the threads that have it; all else is evaluated wave by wave, each of chunks of the same part.
    fn run(
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
            let mut dofs = buffer.dofs.iter();
            buffer.has_dependent = dofs.any(|&dof| self.elimination.depends(dof, self.layout));
            if task.part == Part::Bulk && task.positions.is_empty() {
                self.find(buffer, &mut task.positions);
            }
        };
        let mut is_apart = true;
        let mut rest = tasks;
        if let Some(shared) = self.shared.filter(|shared| !shared.shares.is_empty()) {
            let (tasks, others) = rest.split_at_mut(shared.ntask);
            self.run_shared(&evaluate, &shared.shares, tasks, slots, out)?;
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

    /// Evaluates and adds the chunks that are shared out.
    fn run_shared(
        self,
        evaluate: &(impl Fn(&Task, &mut Work, &mut Buffer) -> Result<(), TermError> + Sync),
        shares: &[Share],
        tasks: &[Task],
        slots: &mut [Slot],
        out: &mut Assembly,
    ) -> Result<(), TermError> {
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
            Some((_, failure)) => Err(failure),
            None => Ok(()),
        }
    }

    /// Adds chunks, one after the other at every entry; false where stiffness of the bulk went into the interface.
    ///
    /// Where no unknown follows others, threads share the rows among themselves, each with about as many nodes of what
    /// is added: an entry is the same sum whoever adds it up.
    fn add(
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
    fn strips<'o>(
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

    /// The rows in strips that end before these nodes, and what is left.
    fn strips_to<'o>(self, ends: &[usize], out: &'o mut Assembly) -> Vec<Strip<'o>> {
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
    fn add_expanded(
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
                self.order == Order::Tangent,
                self.trial,
                self.layout,
                expanded,
            );
            whole.add_force(&expanded.dofs, &expanded.force);
            self.add_entries(whole, &expanded.dofs, &expanded.stiffness);
            is_apart &= task.part == Part::Interface;
        }
        is_apart
    }

    /// Adds what of a chunk belongs to a strip.
    fn add_chunk(self, strip: &mut Strip<'_>, buffer: &Buffer, task: &Task) {
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
    }

    fn add_stiffness(
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
    fn find(self, buffer: &Buffer, positions: &mut Vec<u32>) {
        let ndim = self.layout.ndim();
        let mut nodes: Vec<NodeId> = Vec::new();
        for (_, dofs, ..) in buffer.iter().filter(|(own, ..)| own.nstiffness > 0) {
            nodes.clear();
            nodes.extend(dofs.chunks_exact(ndim).map(|dofs| dofs[0] / ndim as u32));
            find_blocks(self.bulk, &nodes, positions);
        }
    }

    fn add_entries(self, strip: &mut Strip<'_>, dofs: &[Dof], stiffness: &[f64]) {
        let mut places = std::mem::take(&mut strip.places);
        places.clear();
        let mut known: &[u32] = &[];
        for (row, values) in dofs.iter().zip(stiffness.chunks_exact(dofs.len().max(1))) {
            if *row == NO_DOF || !strip.has(*row) {
                continue;
            }
            let (first, columns) = self.interface.row(*row);
            // those of one node have the same columns
            if columns != known {
                find_places(dofs, columns, &mut places);
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

/// The places of unknowns among the columns of a row; none for what is left out, nor for a dead force that turns with
/// nothing but itself, which needs none.
fn find_places(dofs: &[Dof], columns: &[u32], places: &mut Vec<u32>) {
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

/// Some rows of what is assembled.
struct Strip<'a> {
    first: usize,
    first_bulk: usize,
    first_interface: usize,
    residual: &'a mut [f64],
    magnitude: &'a mut [f64],
    uncertainty: &'a mut [f64],
    bulk: &'a mut [f64],
    interface: &'a mut [f64],
    /// Scratch: the places of unknowns in a row of the interface.
    places: Vec<u32>,
}

impl<'a> Strip<'a> {
    fn whole(out: &'a mut Assembly) -> Self {
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
    fn split_at(self, dof: usize, entries: [usize; 2]) -> (Self, Self) {
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

    fn has(&self, dof: Dof) -> bool {
        (dof as usize).wrapping_sub(self.first) < self.residual.len()
    }

    /// The values of a row of the interface: so many from this one on.
    fn entries(&mut self, first: usize, count: usize) -> &mut [f64] {
        let first = first.wrapping_sub(self.first_interface);
        let own = first..first.saturating_add(count);
        self.interface.get_mut(own).unwrap_or_default()
    }

    fn add_error(&mut self, dof: Dof, error: f64) {
        let at = (dof as usize).wrapping_sub(self.first);
        if let Some(to) = self.uncertainty.get_mut(at) {
            *to += error;
        }
    }

    fn add_force(&mut self, dofs: &[Dof], force: &[f64]) {
        for (&dof, f) in dofs.iter().zip(force) {
            // what is no dof is beyond all
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
    fn add_blocks<const ND: usize, const NN: usize>(
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
fn bulk(terms: &[Box<dyn Term>]) -> impl Iterator<Item = &dyn Term> {
    let all = terms.iter().map(AsRef::as_ref);
    all.filter(|term| term.properties().part == Part::Bulk)
}

/// Where the blocks between nodes are in the bulk, row by row.
fn find_blocks(bulk: &BlockPattern, nodes: &[NodeId], positions: &mut Vec<u32>) {
    for &row in nodes {
        let found = nodes.iter().map(|&column| bulk.position(row, column));
        positions.extend(found.map(|at| at.map_or(NONE, |at| at as u32)));
    }
}

/// The whole of a stiffness of which [`Sink::add_symmetric`] has blocks, row-major.
pub(super) fn fill_up(blocks: &[f64], n: usize, ndim: usize, full: &mut Vec<f64>) {
    full.clear();
    if blocks.is_empty() {
        return;
    }
    full.resize(n * n, 0.0);
    let pairs = (0..n / ndim.max(1)).flat_map(|j| (0..=j).map(move |i| (i, j)));
    for ((i, j), block) in pairs.zip(blocks.chunks_exact((ndim * ndim).max(1))) {
        for (k, value) in block.iter().enumerate() {
            let (row, column) = (i * ndim + k / ndim, j * ndim + k % ndim);
            full[row * n + column] = *value;
            full[column * n + row] = *value;
        }
    }
}

/// Sets `n` values to zero.
/// The place and the size of the largest value; one that is not finite is the largest.
fn largest(values: &[f64]) -> Option<(usize, f64)> {
    let sizes = values.iter().map(|value| value.abs()).enumerate();
    sizes.max_by(|a, b| a.1.total_cmp(&b.1))
}

fn reset(values: &mut Vec<f64>, n: usize) {
    if values.capacity() < n {
        // not touched: threads find the pages of what they add to
        *values = vec![0.0; n];
        return;
    }
    values.resize(n, 0.0);
    values
        .par_chunks_mut(ENTRIES)
        .for_each(|some| some.fill(0.0));
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
