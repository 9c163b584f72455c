//! Cells that take no part for a while, and where those that come back are free of strain.
//!
//! A cell that is removed has neither stiffness nor forces; what it exerted last falls to zero over the step, or is gone
//! at once. One that is added takes part with the strain and the history that it has, or free of strain where its nodes
//! are then, at displacements `u_0`, of virgin material:
//!
//! ```text
//! ε(u) − ε(u_0) = ε(u − u_0)                    at small strain                                  (E18)
//! S = ℂ : (E(u) − E(u_0))                       laws linear in the strain of Green and Lagrange     (E19)
//! F F_0⁻¹ = I + ∂(u − u_0)/∂(X + u_0)           all other laws, per volume of the place X + u_0     (E20)
//! ```
//!
//! (E19) is what CalculiX does, and an initial strain does ([`AtStart`](super::AtStart)). Its moduli are per length of the
//! undeformed mesh: where elements are added that nodes in rest have stretched much, another law serves better.
//! Temperatures count from those at that moment.

use super::at::At;
use super::cells::Cells;
use super::kernel::Initial;
use super::plan::{Forces, Plan, gather, inverted};
use super::scratch::{Scratch, Wanted};
use super::term::Solid;
use super::truss::{Bar, Truss};
use crate::material::Order;
use crate::system::{Activity, Archive, ArchiveError, CellChange, Idealisation, State, TermError};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Sym3;
use std::sync::Arc;

impl Solid {
    /// Cells take part as this says.
    pub fn set_activity(&mut self, activity: Arc<Activity>) {
        let mut own = self.blocks.iter().flat_map(|block| &block.ids);
        if own.any(|&id| activity.names(id)) {
            self.plan = Some(Plan::new(activity));
            self.set_active();
        }
    }

    /// Makes the changes of a step that begins, from the state and with the strains of the step before.
    pub(super) fn change_cells(&mut self, step: usize, from: &State) -> Result<(), TermError> {
        let Some(plan) = &mut self.plan else {
            return Ok(());
        };
        if !plan.begins(step) {
            return Ok(());
        }
        let activity = plan.activity.clone();
        if !activity.changes_at(step) {
            return Ok(());
        }
        let forces = self.forces_of_removed(step, &activity, from)?;
        if let Some(plan) = &mut self.plan {
            plan.fade(&self.layout, &forces);
        }
        let layout = self.layout;
        for block in &mut self.blocks {
            for cell in 0..block.ids.len() {
                let change = activity.change(block.ids[cell], step);
                if change == Some(CellChange::Added { strain_free: true }) {
                    let at = |&node: &NodeId| {
                        (0..layout.ndim()).map(move |axis| layout.node(node, axis))
                    };
                    let dofs = block.nodes_of(cell).iter().flat_map(at);
                    let u: Vec<f64> = dofs.map(|dof| from.u[dof as usize]).collect();
                    block.part.add(cell, block.ids.len(), step, &u);
                    let n = block.nhistory;
                    block.history[cell * n..(cell + 1) * n].copy_from_slice(&block.undeformed);
                }
            }
        }
        Ok(())
    }

    /// What cells that are removed exert on their nodes, where that falls to zero over the step. At the beginning of a run
    /// they have exerted nothing yet.
    fn forces_of_removed(
        &self,
        step: usize,
        activity: &Activity,
        from: &State,
    ) -> Result<Forces, TermError> {
        let mut forces = Forces::new();
        if step == 0 {
            return Ok(forces);
        }
        let mut scratch = Scratch::default();
        for block in &self.blocks {
            scratch.size(block, self.layout.ndim(), Wanted::Forces);
            for (cell, &id) in block.ids.iter().enumerate() {
                if activity.change(id, step) != Some(CellChange::Removed { ramp: true }) {
                    continue;
                }
                self.cell(block, cell, At::Trial(from), Wanted::Forces, &mut scratch)?;
                let nodes = block.nodes_of(cell);
                gather(&mut forces, nodes, &scratch.force, self.layout.ndim());
            }
        }
        Ok(forces)
    }

    /// Says which cells take part in the present step.
    pub(super) fn set_active(&mut self) {
        let Some(plan) = &self.plan else { return };
        let step = plan.step();
        for block in &mut self.blocks {
            let (ids, activity) = (&block.ids, &plan.activity);
            let is_active =
                |cell: usize| ids.get(cell).is_none_or(|&id| activity.is_active(id, step));
            block.part.set_active(ids.len(), is_active);
        }
    }

    /// Cells take part as the present step says, with its strains: what has no strain at u_0, and whether cells that are
    /// added there are turned inside out.
    pub(super) fn take_part(&mut self, from: &State) -> Result<(), TermError> {
        self.set_active();
        let Some(plan) = &self.plan else {
            return Ok(());
        };
        let mut inside_out = Vec::new();
        let mut initial = Vec::new();
        let mut scratch = Scratch::default();
        let step = plan.step();
        for block in &self.blocks {
            scratch.size(block, self.layout.ndim(), Wanted::Samples);
            let mut of_block = block.given.clone();
            for (cell, &id) in block.ids.iter().enumerate() {
                let is_new = plan.activity.adds(id, step);
                let subtracts = self.subtracts && block.part.since(cell).is_some();
                if !block.part.is_active(cell) || !(is_new || subtracts) {
                    continue;
                }
                let at = if subtracts {
                    At::Start
                } else {
                    At::Trial(from)
                };
                match self.cell(block, cell, at, Wanted::Samples, &mut scratch) {
                    Err(TermError::Inverted { element, .. }) => {
                        inside_out.push(element);
                        continue;
                    }
                    other => other?,
                };
                if subtracts {
                    self.take_off(block, cell, &scratch, &mut of_block);
                }
            }
            initial.push(of_block);
        }
        if !inside_out.is_empty() {
            return Err(inverted(&self.name, &inside_out));
        }
        for (block, initial) in self.blocks.iter_mut().zip(initial) {
            block.initial = initial;
        }
        Ok(())
    }

    /// The strain of a cell at u_0, which leaves no stress (E19).
    fn take_off(
        &self,
        block: &Cells,
        cell: usize,
        at_origin: &Scratch,
        initial: &mut Vec<Initial>,
    ) {
        let npoint = block.points.rule.npoint();
        initial.resize(block.ids.len() * npoint, Initial::default());
        let of_cell = initial.iter_mut().skip(cell * npoint);
        for (to, sample) in of_cell.zip(&at_origin.samples) {
            let seen = match self.space {
                // the law finds the strain across by itself
                Idealisation::PlaneStress { .. } => Sym3::new(
                    sample.seen.xx(),
                    sample.seen.yy(),
                    0.0,
                    sample.seen.xy(),
                    0.0,
                    0.0,
                ),
                _ => sample.seen,
            };
            to.strain = to.strain + seen;
        }
    }

    fn stored_plan(&self) -> String {
        format!("solid.{}.activity", self.name)
    }

    pub(super) fn save_plan(&self, out: &mut Archive) {
        if let Some(plan) = &self.plan {
            let name = self.stored_plan();
            plan.save(&name, out);
            for (number, block) in self.blocks.iter().enumerate() {
                block.part.save(&format!("{name}.{number}"), out);
            }
        }
    }

    pub(super) fn load_plan(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let name = self.stored_plan();
        let Some(plan) = &mut self.plan else {
            return Ok(());
        };
        plan.load(&name, from)?;
        let ndim = self.layout.ndim();
        for (number, block) in self.blocks.iter_mut().enumerate() {
            let (ncell, n) = (block.ids.len(), block.nodes.len() * ndim);
            block
                .part
                .load(&format!("{name}.{number}"), from, ncell, n)?;
        }
        self.set_active();
        Ok(())
    }
}

impl Truss {
    /// Bars take part as this says.
    pub fn set_activity(&mut self, activity: Arc<Activity>) {
        if self.bars.iter().any(|bar| activity.names(bar.id)) {
            self.plan = Some(Plan::new(activity));
            self.set_active();
        }
    }

    pub(super) fn set_active(&mut self) {
        if let Some(plan) = &self.plan {
            let (bars, step) = (&self.bars, plan.step());
            let is_active = |k: usize| {
                bars.get(k)
                    .is_none_or(|bar| plan.activity.is_active(bar.id, step))
            };
            self.part.set_active(bars.len(), is_active);
        }
    }

    /// Makes the changes of a step that begins.
    pub(super) fn change_bars(&mut self, step: usize, from: &State) -> Result<(), TermError> {
        let Some(plan) = &mut self.plan else {
            return Ok(());
        };
        if !plan.begins(step) {
            return Ok(());
        }
        let activity = plan.activity.clone();
        let mut forces = Forces::new();
        let ndim = self.layout.ndim();
        for number in 0..self.bars.len() {
            let id = self.bars[number].id;
            match activity.change(id, step) {
                Some(CellChange::Removed { ramp: true }) if step > 0 => {
                    let order = Order::Stress;
                    let local = self.local(number, At::Trial(from), order, &mut Vec::new())?;
                    gather(&mut forces, &self.bars[number].nodes, &local.force, ndim);
                }
                Some(CellChange::Added { strain_free: true }) => {
                    let mut u = vec![0.0; self.width()];
                    let bar = &self.bars[number];
                    for (k, &node) in bar.nodes.iter().enumerate() {
                        for axis in 0..ndim {
                            u[k * ndim + axis] = from.u[self.layout.node(node, axis) as usize];
                        }
                    }
                    self.part.add(number, self.bars.len(), step, &u);
                    let n = bar.element.full_rule().npoint() * self.undeformed.len();
                    if n > 0 {
                        let history = &mut self.history[bar.history..bar.history + n];
                        let points = history.chunks_exact_mut(self.undeformed.len());
                        points.for_each(|to| to.copy_from_slice(&self.undeformed));
                    }
                }
                _ => {}
            }
        }
        if let Some(plan) = &mut self.plan {
            plan.fade(&self.layout, &forces);
        }
        Ok(())
    }

    /// Refuses bars that are added where they have no length.
    pub(super) fn judge_added(&self, step: usize) -> Result<(), TermError> {
        let Some(plan) = &self.plan else {
            return Ok(());
        };
        let has_length = |number: usize, bar: &Bar| {
            let npoint = bar.element.full_rule().npoint();
            (0..npoint).all(|p| self.tangent(bar, Some(number), p).is_some())
        };
        let bars = self.bars.iter().enumerate();
        let lost = bars
            .filter(|(number, bar)| plan.activity.adds(bar.id, step) && !has_length(*number, bar));
        let labels: Vec<u64> = lost.map(|(_, bar)| bar.label).collect();
        match labels.is_empty() {
            true => Ok(()),
            false => Err(inverted(&self.name, &labels)),
        }
    }
}
