//! Which cells take part in which step, from what steps say.

use super::activity_error::ActivityError;
use super::error::ModelError;
use super::label::cell_label;
use super::parts::{BodyKind, BodyPart, StepPart};
use crate::system::{Activity, CellChange};
use signorini_geometry::mesh::{CellId, Mesh};
use std::collections::{BTreeMap, HashMap};

/// Which cells take part in which step.
pub(super) fn activity(
    mesh: &Mesh,
    bodies: &[BodyPart],
    owner: &HashMap<CellId, usize>,
    steps: &[StepPart],
) -> Result<Activity, ModelError> {
    let mut changes = Vec::new();
    // of cells that have changed, whether they take part
    let mut active: BTreeMap<CellId, bool> = BTreeMap::new();
    let deformable = bodies.iter().filter(|b| b.kind.material().is_some());
    let ncell: usize = deformable.map(|b| b.cells.len()).sum();
    for (number, step) in steps.iter().enumerate() {
        let mut here: BTreeMap<CellId, CellChange> = BTreeMap::new();
        for part in &step.activity {
            let adds = matches!(part.change, CellChange::Added { .. });
            for &cell in &part.cells {
                let (step, element) = (step.name.clone(), cell_label(mesh, cell));
                let body = owner.get(&cell).and_then(|&body| bodies.get(body));
                match body {
                    None => return Err(ActivityError::Outside { step, element }.into()),
                    Some(body) if matches!(body.kind, BodyKind::Rigid { .. }) => {
                        let body = body.name.clone();
                        return Err(ActivityError::Rigid {
                            step,
                            element,
                            body,
                        }
                        .into());
                    }
                    Some(_) => {}
                }
                match here.insert(cell, part.change) {
                    Some(before) if before != part.change => {
                        return Err(ActivityError::Twice { step, element }.into());
                    }
                    // named by two sets
                    Some(_) => continue,
                    None => {}
                }
                if active.insert(cell, adds).unwrap_or(true) == adds {
                    let [adds, active] = match adds {
                        true => ["adds", "active"],
                        false => ["removes", "inactive"],
                    };
                    let already = ActivityError::Already {
                        step,
                        element,
                        adds,
                        active,
                    };
                    return Err(already.into());
                }
                changes.push((cell, number, part.change));
            }
        }
        let removed = active.values().filter(|active| !**active).count();
        if removed == ncell && !step.activity.is_empty() && ncell > 0 {
            let step = step.name.clone();
            return Err(ActivityError::NothingLeft { step }.into());
        }
    }
    let activity = Activity::new(steps.len(), changes);
    if activity.is_empty() {
        return Ok(activity);
    }
    let cells: Vec<CellId> = bodies.iter().flat_map(|b| &b.cells).copied().collect();
    Ok(activity.with_nodes(mesh, &cells))
}
