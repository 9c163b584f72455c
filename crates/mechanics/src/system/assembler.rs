//! From terms to one residual and one operator.

use super::assembly::{Assembly, Shared, Task, reset};
use super::buffer::{Buffer, Slot};
use super::elimination::Expanded;
use super::setting::Setting;
use super::shares::{Share, share_out};
use super::strip::{bulk, find_blocks};
use super::{
    Dof, Elimination, InitialStiffness, Layout, Lifetime, Order, Part, PatternSink, Role, State,
    Term, TermError, Work,
};
use rayon::prelude::*;
use signorini_geometry::mesh::NodeId;
use signorini_linear::Partition;
use signorini_linear::sparsity::{BlockPattern, Pattern};
use signorini_ranks::Ranks;

/// Chunks of a wave for each thread, of which stiffness is wanted: the fewer, the more of the sums is in cache.
const PER_THREAD: usize = 4;
/// Chunks of a wave, at most: bounds the memory, and nothing else.
const WAVE: usize = 64;
/// Mixes numbers of terms into one.
const MIX: u64 = 0x9e37_79b9_7f4a_7c15;

/// Chunks that are evaluated before they are added. A single thread adds every chunk while it is in cache.
pub(super) fn wave(order: Order) -> usize {
    match (rayon::current_num_threads(), order) {
        (1, _) => 1,
        (threads, Order::Tangent) => (PER_THREAD * threads).min(WAVE),
        (_, Order::Residual) => WAVE,
    }
}

/// Evaluates terms by chunks, in parallel, and adds the results in a fixed order.
pub struct Assembler {
    /// Those of the bulk first, and of these first the ones whose elements are known, as far as that has been found out.
    pub(super) tasks: Vec<Task>,
    /// The tasks whose elements are known, and who adds them up; `None` where that is to be found out.
    pub(super) shared: Option<Shared>,
    pub(super) bulk: BlockPattern,
    pub(super) interface: Pattern,
    pub(super) slots: Vec<Slot>,
    pub(super) expanded: Expanded,
    /// How long the stiffness of the bulk is the same.
    pub(super) lasts: Lifetime,
    /// Counts what it is the same in at most: steps, or increments.
    pub(super) period: u64,
    /// The elements that the bulk has places for, by [`Properties::elements`](super::Properties::elements).
    pub(super) built_for: u64,
    /// The ranks that the rows of the bulk are divided among in steps; none: each has all.
    pub(super) ranks: Option<&'static dyn Ranks>,
}

/// Cliques of a pattern, as they come.
pub(super) struct Cliques<'a> {
    pub(super) layout: &'a Layout,
    pub(super) elimination: &'a Elimination,
    pub(super) bulk: Vec<u32>,
    pub(super) bulk_offsets: Vec<usize>,
    pub(super) interface: Vec<u32>,
    pub(super) interface_offsets: Vec<usize>,
    /// Of each clique of the interface, how many members couple with the others alone; 0: all couple.
    pub(super) interface_splits: Vec<usize>,
    pub(super) dofs: Vec<Dof>,
}

impl Cliques<'_> {
    /// The pattern of the bulk: all rows, or those of this rank.
    fn of_bulk(&self, ranks: Option<&'static dyn Ranks>) -> BlockPattern {
        let (nodes, offsets) = (&self.bulk, &self.bulk_offsets);
        let (nnode, ndim) = (self.layout.nnode(), self.layout.ndim());
        let whole = BlockPattern::from_cliques(nnode, ndim, nodes, offsets);
        match ranks {
            Some(ranks) => whole.divided(ranks),
            None => whole,
        }
    }

    /// The pattern of the interface.
    fn of_interface(&self) -> Pattern {
        let (dofs, offsets) = (&self.interface, &self.interface_offsets);
        let splits = &self.interface_splits;
        Pattern::from_split_cliques(self.layout.ndof(), dofs, offsets, splits)
    }

    /// Adds a clique of what takes the place of these dofs: all couple, or the first with the others alone, if there are any.
    fn clique(&mut self, first: &[Dof], others: &[Dof]) {
        self.dofs.clear();
        let (elimination, layout) = (self.elimination, self.layout);
        elimination.independent(first, layout, &mut self.dofs);
        let split = self.dofs.len();
        elimination.independent(others, layout, &mut self.dofs);
        self.interface.extend_from_slice(&self.dofs);
        self.interface_offsets.push(self.interface.len());
        self.interface_splits
            .push(if others.is_empty() { 0 } else { split });
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
        self.clique(dofs, &[]);
    }

    fn coupling(&mut self, ones: &[Dof], others: &[Dof]) {
        self.clique(ones, others);
    }
}

impl Assembler {
    /// Prepares the assembly of these terms.
    #[must_use]
    pub fn new(layout: &Layout, elimination: &Elimination, terms: &[Box<dyn Term>]) -> Self {
        let cliques = collect(layout, elimination, terms);
        Self::with(cliques.of_bulk(None), &cliques, terms, None)
    }

    /// The same with the rows of the bulk divided among these ranks: each evaluates the elements that touch its rows. Forces
    /// are those of all elements on every rank. An entry has the same bits however many ranks there are.
    #[must_use]
    pub fn divided(
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
        ranks: &'static dyn Ranks,
    ) -> Self {
        let cliques = collect(layout, elimination, terms);
        Self::with(cliques.of_bulk(Some(ranks)), &cliques, terms, Some(ranks))
    }

    /// Prepares the assembly of the same terms as if for the first time: their bulk is the same.
    #[must_use]
    pub fn renewed(
        self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
    ) -> Self {
        let cliques = collect(layout, elimination, terms);
        Self::with(self.bulk, &cliques, terms, self.ranks)
    }

    fn with(
        bulk: BlockPattern,
        cliques: &Cliques<'_>,
        terms: &[Box<dyn Term>],
        ranks: Option<&'static dyn Ranks>,
    ) -> Self {
        let mut assembler = Self {
            tasks: Vec::new(),
            shared: None,
            bulk,
            interface: cliques.of_interface(),
            slots: Vec::new(),
            expanded: Expanded::default(),
            lasts: Lifetime::State,
            period: 0,
            built_for: 0,
            ranks,
        };
        assembler.built_for = elements_of(terms);
        assembler.begin_increment(terms);
        assembler
    }

    /// A step begins: what terms are may change, and which elements there are. Says whether the pattern was made again.
    pub fn begin_step(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
    ) -> bool {
        self.period += 1;
        let now = elements_of(terms);
        let is_same = std::mem::replace(&mut self.built_for, now) == now;
        if is_same && self.bulk.partition.is_some() == self.ranks.is_some() {
            return false;
        }
        self.place(layout, elimination, terms, self.ranks);
        true
    }

    /// Gives each rank all rows until the next step begins: for what solves by itself. Says whether the pattern was made
    /// again.
    pub fn take_all_rows(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
    ) -> bool {
        let is_divided = self.bulk.partition.is_some();
        if is_divided {
            self.place(layout, elimination, terms, None);
            self.take_up(terms);
        }
        is_divided
    }

    /// Makes the pattern of the bulk again, all of it or divided among ranks.
    fn place(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
        ranks: Option<&'static dyn Ranks>,
    ) {
        self.bulk = collect(layout, elimination, terms).of_bulk(ranks);
        self.tasks.clear();
        self.shared = None;
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
                first_rank: 0,
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
            let mut has_elements = false;
            let (mut is_here, mut first_rank) = (bulk.partition.is_none(), usize::MAX);
            elementwise.elements(task.chunk, &mut |nodes| {
                let mut dofs = nodes.iter().flat_map(|&node| {
                    let axes = 0..layout.ndim();
                    axes.map(move |axis| layout.node(node, axis))
                });
                depends |= dofs.any(|dof| elimination.depends(dof, layout));
                has_elements |= !nodes.is_empty();
                if let Some(partition) = &bulk.partition {
                    is_here |= nodes.iter().any(|&node| partition.is_own(node));
                    let ranks = nodes.iter().filter_map(|&node| partition.owner(node));
                    first_rank = first_rank.min(ranks.min().unwrap_or(0));
                }
            });
            task.is_known = has_elements && !depends;
            if !task.is_known {
                return;
            }
            task.first_rank = first_rank;
            if is_here {
                elementwise.elements(task.chunk, &mut |nodes| {
                    find_blocks(bulk, nodes, &mut task.positions);
                });
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
        let is_here = |&at: &usize| !tasks[at].positions.is_empty();
        let here: Vec<usize> = (0..ntask).filter(is_here).collect();
        let mut shares = share_out(nthread, layout.nnode(), &here, elements);
        if shares.is_empty() && self.bulk.partition.is_some() {
            shares.push(Share {
                end: layout.nnode(),
                chunks: here,
            });
        }
        self.shared = Some(Shared {
            ntask,
            nthread,
            shares,
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
            turning: order == Order::Tangent,
            shared: shared.as_ref(),
        };
        // between the ends of an increment
        let share = trial.between.as_ref().map(|of| 1.0 - of.alpha_f);
        let evaluate = |task: &Task, work: &mut Work, buffer: &mut Buffer| {
            let term = &terms[task.term];
            term.evaluate(task.chunk, trial, order_of(task), work, buffer)?;
            if let Some(share) = share.filter(|_| !term.properties().to_end) {
                buffer.scale_motions(share, layout);
            }
            Ok(())
        };
        let of_bulk = if is_kept { Order::Residual } else { order };
        let (of_bulk, of_interface) = (wave(of_bulk), wave(order));
        let size = |part: Part| match part {
            Part::Bulk => of_bulk,
            Part::Interface => of_interface,
        };
        stays &= setting.run(evaluate, size, tasks, slots, expanded, out)?;
        out.complete(bulk, order)?;
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

    /// The forces of all terms at a state where a step begins, with the mass and what couples multipliers in the place of the
    /// stiffness: solved for, they give accelerations and multipliers.
    ///
    /// # Errors
    /// As [`Assembler::assemble`].
    pub fn assemble_mass(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
        state: &State,
        out: &mut Assembly,
    ) -> Result<(), TermError> {
        let evaluate = |task: &Task, work: &mut Work, buffer: &mut Buffer| {
            let term = &terms[task.term];
            let is_mass = term.properties().role == Role::Inertia;
            let order = match task.part {
                Part::Bulk if !is_mass => Order::Residual,
                _ => Order::Tangent,
            };
            term.evaluate(task.chunk, state, order, work, buffer)?;
            if !is_mass {
                buffer.keep_constraints(layout);
            }
            Ok(())
        };
        self.assemble_by(layout, elimination, terms, state, (evaluate, false), out)
    }

    /// The stiffness at a state of those terms that `takes` answers yes to; of inertia where no increment has begun, that is the mass.
    ///
    /// # Errors
    /// As [`Assembler::assemble`].
    pub fn assemble_of(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
        state: &State,
        takes: impl Fn(&dyn Term) -> bool + Sync,
        out: &mut Assembly,
    ) -> Result<(), TermError> {
        let evaluate = |task: &Task, work: &mut Work, buffer: &mut Buffer| {
            let term = terms[task.term].as_ref();
            if !takes(term) {
                return Ok(());
            }
            term.evaluate(task.chunk, state, Order::Tangent, work, buffer)
        };
        self.assemble_by(layout, elimination, terms, state, (evaluate, true), out)
    }

    /// Adds up what `evaluate` makes of every chunk, forces and stiffness, with that of forces that are `turning` with what they act on.
    fn assemble_by(
        &mut self,
        layout: &Layout,
        elimination: &Elimination,
        terms: &[Box<dyn Term>],
        state: &State,
        (evaluate, turning): (
            impl Fn(&Task, &mut Work, &mut Buffer) -> Result<(), TermError> + Sync,
            bool,
        ),
        out: &mut Assembly,
    ) -> Result<(), TermError> {
        self.share_out(layout, elimination, terms);
        out.reset_forces(layout.ndof());
        reset(&mut out.bulk, self.bulk.nvalue());
        reset(&mut out.interface, self.interface.nentry());
        out.bulk_of = None;
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
            turning,
            shared: shared.as_ref(),
        };
        let size = wave(Order::Tangent);
        setting.run(evaluate, |_| size, tasks, slots, expanded, out)?;
        out.complete(bulk, Order::Tangent)
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
        let evaluate = |task: &Task, work: &mut Work, buffer: &mut Buffer| {
            let of_bulk = task.part == Part::Bulk;
            let initial = terms[task.term].capabilities().initial_stiffness;
            match initial.filter(|_| of_bulk) {
                Some(initial) => initial.add_initial(task.chunk, work, buffer),
                None => Ok(()),
            }
        };
        self.assemble_by(
            layout,
            elimination,
            terms,
            state,
            (evaluate, true),
            &mut out,
        )?;
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
        let (mut energies, end) = self.energies_here(terms, trial);
        if let Some(partition) = self.bulk.partition.clone() {
            let own = end.as_ref().map_or(u64::MAX, |_| energies.len() as u64);
            let first = partition.least(own).map_err(TermError::Ranks)?;
            match self.tasks.get(first as usize) {
                Some(task) if own != first => {
                    // on another rank: why, each finds for itself
                    terms[task.term].energy(task.chunk, trial, &mut Work::default())?;
                    return Ok(None);
                }
                Some(_) => {}
                None => self.fetch_energies(&partition, &mut energies)?,
            }
        }
        match end {
            Some(failure) => failure.map_or(Ok(None), Err),
            None => Ok(Some(
                energies.into_iter().fold(0.0, |sum, energy| sum + energy),
            )),
        }
    }

    /// The energies of tasks in their order, 0 where another rank evaluates one, up to the first that has none or fails; and
    /// why there are no more.
    fn energies_here(
        &mut self,
        terms: &[Box<dyn Term>],
        trial: &State,
    ) -> (Vec<f64>, Option<Option<TermError>>) {
        let partition = self.bulk.partition.as_deref();
        let is_elsewhere = |task: &Task| {
            let rank = partition.map(|of| of.ranks().rank());
            task.is_known && rank.is_some_and(|rank| rank != task.first_rank)
        };
        let size = wave(Order::Residual).min(self.slots.len()).max(1);
        let mut energies = Vec::with_capacity(self.tasks.len());
        for wave in self.tasks.chunks(size) {
            let evaluate = |(slot, task): (&mut Slot, &Task)| {
                // nothing stays of a wave before it
                (slot.energy, slot.failure) = (Some(0.0), None);
                if is_elsewhere(task) {
                    return;
                }
                match terms[task.term].energy(task.chunk, trial, &mut slot.work) {
                    Ok(energy) => slot.energy = energy,
                    Err(failure) => slot.failure = Some(failure),
                }
            };
            if wave.len() == 1 {
                self.slots.iter_mut().zip(wave).for_each(evaluate);
            } else {
                self.slots.par_iter_mut().zip(wave).for_each(evaluate);
            }
            for (slot, _) in self.slots.iter_mut().zip(wave) {
                match (slot.failure.take(), slot.energy) {
                    (None, Some(energy)) => energies.push(energy),
                    (failure, _) => return (energies, Some(failure)),
                }
            }
        }
        (energies, None)
    }

    /// Fetches the energies of the tasks that other ranks evaluate.
    fn fetch_energies(&self, partition: &Partition, energies: &mut [f64]) -> Result<(), TermError> {
        let (rank, size) = (partition.ranks().rank(), partition.ranks().size());
        let known = self.tasks.iter().enumerate().filter(|(_, t)| t.is_known);
        let mut of_ranks: Vec<Vec<usize>> = vec![Vec::new(); size];
        known.for_each(|(at, task)| of_ranks[task.first_rank].push(at));
        let own: Vec<f64> = of_ranks[rank].iter().map(|&at| energies[at]).collect();
        let counts: Vec<usize> = of_ranks.iter().map(Vec::len).collect();
        let mut all = vec![0.0; counts.iter().sum()];
        let gathered = partition.all_gather(&own, &counts, &mut all);
        gathered.map_err(TermError::Ranks)?;
        for (at, energy) in of_ranks.into_iter().flatten().zip(all) {
            energies[at] = energy;
        }
        Ok(())
    }
}

/// Identifies the elements that take part. Equal numbers mean equal elements.
fn elements_of(terms: &[Box<dyn Term>]) -> u64 {
    terms.iter().fold(0, |all, term| {
        all.wrapping_mul(MIX)
            .wrapping_add(term.properties().elements)
    })
}

pub(super) fn collect<'a>(
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
        interface_splits: Vec::new(),
        dofs: Vec::new(),
    };
    for term in terms {
        term.pattern(&mut cliques);
    }
    cliques
}
