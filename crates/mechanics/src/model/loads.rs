//! Loads of all steps, as terms.

use super::{Context, Load, LoadPart, ModelError};
use crate::load::NodalForces;
use crate::system::{Dof, NO_DOF, Term};
use std::collections::{BTreeMap, BTreeSet};

/// The terms of these loads, step by step.
pub(super) fn terms(
    context: &Context<'_>,
    steps: Vec<Vec<LoadPart>>,
) -> Result<Vec<Box<dyn Term>>, ModelError> {
    let mut loads: BTreeMap<String, Vec<(Dof, f64)>> = BTreeMap::new();
    let mut ends: Vec<BTreeMap<Dof, f64>> = Vec::new();
    for step in steps {
        for part in step {
            let forces = forces(context, &part.load)?;
            loads.insert(part.name, forces);
        }
        let mut end = BTreeMap::new();
        for (dof, force) in loads.values().flatten() {
            *end.entry(*dof).or_insert(0.0) += force;
        }
        ends.push(end);
    }
    let dofs: BTreeSet<Dof> = ends.iter().flat_map(|e| e.keys().copied()).collect();
    if dofs.is_empty() {
        return Ok(Vec::new());
    }
    let row = |end: &BTreeMap<Dof, f64>| {
        let value = |dof| end.get(dof).copied().unwrap_or(0.0);
        dofs.iter().map(value).collect()
    };
    let rows = ends.iter().map(row).collect();
    let dofs = dofs.iter().copied().collect();
    Ok(vec![Box::new(NodalForces::new(dofs, rows))])
}

fn forces(context: &Context<'_>, load: &Load) -> Result<Vec<(Dof, f64)>, ModelError> {
    let layout = &context.layout;
    let mut out = Vec::new();
    match load {
        Load::Carrier {
            carrier,
            force,
            moment,
        } => {
            out.extend((0..3).map(|c| (layout.translation(*carrier, c), force[c])));
            out.extend((0..3).map(|c| (layout.rotation(*carrier, c), moment[c])));
        }
        Load::Nodes(nodes) => {
            for &(node, force) in nodes {
                context.on_rigid(node)?;
                out.extend((0..3).map(|c| (layout.node(node, c), force[c])));
            }
        }
        _ => {}
    }
    out.retain(|(dof, force)| *dof != NO_DOF && *force != 0.0);
    Ok(out)
}
