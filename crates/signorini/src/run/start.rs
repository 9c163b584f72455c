//! The undeformed state: the first look at contact, and what is known before anything is solved.

use super::news::Facts;
use super::{RunOptions, failure};
use crate::build::Model;
use signorini_io::diagnostic::Diagnostics;
use signorini_mechanics::system::{Assembly, Frame, StepContext, TermError};
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
    let context = StepContext {
        number: 0,
        start: 0.0,
        duration: first.map_or(1.0, |s| s.duration),
        nonlinear: first.is_none_or(|s| s.nonlinear),
    };
    for term in &mut model.system.terms {
        term.begin_step(&context, &state)?;
        term.begin_increment(&state)?;
        term.prepare(&state)?;
    }
    let mut frame = model.system.report(&state, &[], &Assembly::default())?;
    frame.step = first.map_or_else(String::new, |s| s.name.clone());
    Ok(frame)
}

/// Unknowns of the first step: of nodes with a solid and of rigid bodies, less what is prescribed.
fn nunknown(model: &Model) -> usize {
    let (mesh, layout) = (&model.mesh, &model.system.layout);
    let solid = mesh.cells(mesh.dim()).flat_map(|cell| mesh.cell(cell));
    let nodes: BTreeSet<u32> = solid.copied().collect();
    let mut dofs: BTreeSet<u32> = BTreeSet::new();
    for node in nodes {
        if model.system.elimination.body_of(node).is_none() {
            dofs.extend((0..layout.ndim).map(|axis| layout.node(node, axis)));
        }
    }
    for body in 0..layout.nrigid as u32 {
        let all = (0..3).flat_map(|c| [layout.translation(body, c), layout.rotation(body, c)]);
        dofs.extend(all.filter(|&dof| (dof as usize) < layout.ndof()));
    }
    for prescription in model.steps.iter().take(1).flat_map(|s| &s.prescriptions) {
        dofs.remove(&prescription.dof);
    }
    dofs.len()
}

/// What a run starts from.
#[must_use]
pub fn facts(model: &Model, start: &Start, options: &RunOptions) -> Facts {
    let mesh = &model.mesh;
    let solids = mesh
        .blocks
        .iter()
        .filter(|b| b.element.dim() == mesh.dim() && b.ncell() > 0);
    let gaps = start.frame.contacts.iter().flat_map(|c| &c.gap);
    let gaps = gaps.copied().filter(|gap| gap.is_finite());
    let units = &model.case.units.value;
    Facts {
        name: model.name.clone(),
        nnode: mesh.nnode(),
        cells: solids.map(|b| (b.element.name(), b.ncell())).collect(),
        ncontact: model.contacts.len(),
        npoint: model.contacts.iter().map(|c| c.npoint).sum(),
        gap_min: gaps.reduce(f64::min),
        nunknown: start.nunknown,
        threads: options.threads,
        seconds: options.seconds,
        length: units.split('-').next().unwrap_or_default().to_owned(),
        steps: model.steps.iter().map(|s| s.name.clone()).collect(),
        duration: model.steps.iter().map(|s| s.duration).sum(),
    }
}
