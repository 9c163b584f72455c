//! Temperatures as unknowns: what steps prescribe of them, and the terms of bodies that conduct.

use super::{Context, HeatPart, ModelError, StepPart};
use crate::solid::{HeatInBody, HeatParts, Integration};
use crate::solve::{Motion, Prescription};
use crate::system::{Dof, Idealisation, Layout, NO_DOF, NodalField, Term};
use signorini_geometry::mesh::{CellId, NodeId};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The same layout with temperatures, where some step solves for them.
pub(super) fn with_temperatures(layout: Layout, steps: &[StepPart]) -> Layout {
    let solves = steps.iter().any(|step| step.physics.has_heat());
    let field = solves.then_some(Layout::TEMPERATURE);
    field
        .and_then(|field| layout.with_field(field))
        .unwrap_or(layout)
}

/// Temperatures that are given to the nodes, at the start and at the end of every step.
pub(super) fn given(start: Vec<f64>, steps: &[StepPart]) -> Option<Arc<NodalField>> {
    if start.is_empty() {
        return None;
    }
    let mut ends = vec![start];
    for step in steps {
        let mut end = ends.last().cloned().unwrap_or_default();
        for (node, course) in &step.temperatures {
            if let (Some(to), Motion::Ramp(value)) = (end.get_mut(*node as usize), course) {
                *to = *value;
            }
        }
        ends.push(end);
    }
    Some(Arc::new(NodalField { ends }))
}

/// Temperatures at the start, as unknowns.
pub(super) fn at_start(layout: &Layout, temperature: &[f64]) -> Arc<[(Dof, f64)]> {
    let of_nodes = (0..).zip(temperature);
    let of_nodes = of_nodes.map(|(node, value)| (layout.temperature(node), *value));
    of_nodes.filter(|(dof, _)| *dof != NO_DOF).collect()
}

/// What steps prescribe of temperatures, one after the other.
pub(super) struct Temperatures {
    /// Nodes whose temperature a step has given, and its course from then on.
    given: BTreeMap<NodeId, Motion>,
    /// Nodes of no body that conducts: they keep their temperature unless a step gives them another.
    idle: BTreeSet<NodeId>,
}

impl Temperatures {
    /// What is prescribed in the next step: what it gives, what earlier ones gave, and all of it where temperatures are not solved
    /// for.
    pub fn of(&mut self, step: &StepPart, layout: &Layout) -> Vec<Prescription> {
        if !layout.has_temperatures() {
            return Vec::new();
        }
        for node in &step.freed_temperatures {
            self.given.remove(node);
        }
        for course in self.given.values_mut().filter(|course| !course.goes_on()) {
            *course = Motion::Hold;
        }
        self.given.extend(step.temperatures.iter().cloned());
        let prescribe = |node: NodeId| Prescription {
            dof: layout.temperature(node),
            motion: self.given.get(&node).cloned().unwrap_or(Motion::Hold),
        };
        match step.physics.has_heat() {
            true => {
                let idle = self.idle.iter();
                let others = idle.filter(|node| !self.given.contains_key(node));
                let held = self.given.keys().chain(others);
                held.map(|&node| prescribe(node)).collect()
            }
            false => (0..layout.nnode() as NodeId).map(prescribe).collect(),
        }
    }
}

/// Where a body is that conducts.
pub(super) struct Site<'a> {
    pub name: &'a str,
    pub cells: &'a [CellId],
    pub space: Idealisation,
    pub profile: Option<Arc<[f64]>>,
    pub integration: Integration,
}

impl<'a> Site<'a> {
    /// A body with what its thickness is multiplied by at nodes.
    pub const fn new(
        name: &'a str,
        cells: &'a [CellId],
        space: Idealisation,
        profile: Option<Arc<[f64]>>,
        integration: Integration,
    ) -> Self {
        Self {
            name,
            cells,
            space,
            profile,
            integration,
        }
    }
}

impl Context<'_> {
    /// What steps prescribe of temperatures, before the first.
    pub(super) fn temperatures(&self) -> Temperatures {
        let mut idle = BTreeSet::new();
        if self.layout.has_temperatures() {
            idle.extend(0..self.layout.nnode() as NodeId);
            let bodies = self.substances.iter().zip(self.cells_of_bodies());
            for (_, cells) in bodies.filter(|(body, _)| body.conducts) {
                for node in cells.iter().flat_map(|&cell| self.mesh.cell(cell)) {
                    idle.remove(node);
                }
            }
        }
        Temperatures {
            given: BTreeMap::new(),
            idle,
        }
    }

    /// The heat of a body; none where it does not conduct, or no temperature is unknown.
    pub(super) fn heat(
        &self,
        site: Site<'_>,
        heat: Option<&HeatPart>,
    ) -> Result<Option<Box<dyn Term>>, ModelError> {
        let Some(heat) = heat.filter(|_| self.layout.has_temperatures()) else {
            return Ok(None);
        };
        let mut term = HeatInBody::new(HeatParts {
            name: site.name,
            mesh: self.mesh,
            reference: self.reference.clone(),
            cells: site.cells,
            layout: self.layout,
            space: site.space,
            profile: site.profile,
            conductor: heat.conductor.clone(),
            axes: heat.axes,
            reduced: site.integration == Integration::Reduced,
            storage: heat.storage,
        })?;
        term.set_activity(self.activity.clone());
        Ok(Some(Box::new(term)))
    }
}
