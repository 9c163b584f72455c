//! The undeformed state: the first look at contact, and the facts known before the solution.

use super::news::Facts;
use super::{RunOptions, failure};
use crate::setup::Model;
use signorini_io::diagnostic::Diagnostics;
use signorini_mechanics::model::Treatment;
use signorini_mechanics::system::{
    Assembly, Dof, DofName, Frame, Increment, Order, Phase, StepContext, TermError,
};
use std::collections::BTreeSet;

/// The undeformed state of a model.
#[derive(Clone, Debug)]
pub struct Start {
    /// Its results: gaps and overlaps of all contacts.
    pub frame: Frame,
    /// The number of unknowns of the first step.
    pub nunknown: usize,
}

/// Looks at the undeformed state.
///
/// # Errors
/// Elements turned inside out, surfaces without normals: nothing can be solved.
pub fn begin(model: &mut Model) -> Result<Start, Diagnostics> {
    let frame = look(model).map_err(|error| failure::at_start(&error))?;
    Ok(Start {
        frame,
        nunknown: nunknown(model),
    })
}

fn look(model: &mut Model) -> Result<Frame, TermError> {
    let state = model.system.initial_state();
    let first = model.steps.first();
    let context = first.map_or_else(StepContext::default, |step| step.context(0, 0.0));
    let increment = Increment {
        number: 1,
        from: state.time,
        to: state.time,
    };
    for term in &mut model.system.terms {
        term.begin(&Phase::of_step(context), &state)?;
        term.begin(&Phase::of_increment(context, increment), &state)?;
        if let Some(adaptive) = term.adaptive() {
            adaptive.prepare(&state, Order::Residual)?;
        }
    }
    let mut frame = model.system.report(&state, &[], &Assembly::default())?;
    frame.step = first.map_or_else(String::new, |s| s.name.clone());
    Ok(frame)
}

/// Unknowns of the first step: of nodes of bodies, of carriers and of constraints, less those prescribed and those that
/// follow others.
fn nunknown(model: &Model) -> usize {
    let system = &model.system;
    let layout = &system.layout;
    let first = model.steps.iter().take(1).flat_map(|s| &s.prescriptions);
    let prescribed: BTreeSet<Dof> = first.map(|p| p.dof).collect();
    let body_of = |node: u32| system.body.get(node as usize);
    let takes_part = |dof: Dof| match layout.name(dof).and_then(DofName::displacement) {
        Some((node, _)) => body_of(node).is_some_and(|b| *b != u32::MAX),
        None => true,
    };
    let follows = |dof: Dof| system.elimination.depends(dof, layout);
    (0..layout.ndof() as Dof)
        .filter(|dof| takes_part(*dof) && !follows(*dof) && !prescribed.contains(dof))
        .count()
}

/// What a run starts from.
#[must_use]
pub fn facts(model: &Model, start: &Start, options: &RunOptions) -> Facts {
    let mesh = &model.mesh;
    let solids = mesh
        .blocks
        .iter()
        .filter(|b| b.element.dim() == mesh.dim() && b.ncell() > 0);
    let gaps = model
        .contacts
        .iter()
        .filter_map(|c| match c.start.treatment {
            Treatment::Joined => c.start.gap.map(|_| 0.0),
            _ => c.start.gap,
        });
    let units = &model.case.units.value;
    Facts {
        name: model.name.clone(),
        nnode: mesh.nnode(),
        cells: solids.map(|b| (b.element.name(), b.ncell())).collect(),
        ncontact: model.contacts.len(),
        npoint: model.contacts.iter().map(|c| c.npoint).sum(),
        gap_min: gaps.reduce(f64::min),
        nunknown: start.nunknown,
        remedies: model.remedies(),
        ranks: options.ranks.size(),
        threads: options.threads,
        seconds: options.seconds,
        length: units.split('-').next().unwrap_or_default().to_owned(),
        steps: model.steps.iter().map(|s| s.name.clone()).collect(),
        duration: model.steps.iter().map(|s| s.duration).sum(),
    }
}
