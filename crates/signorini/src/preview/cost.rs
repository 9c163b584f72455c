//! Memory and time that a solution takes.

use crate::build::Model;
use crate::text::short;
use signorini_mechanics::solve::{Cost, forecast};

/// Bytes of the program, of a node and of a cell with their results, besides the linear system: measured.
const PROGRAM: f64 = 2e7;
const PER_NODE: f64 = 1_000.0;
const PER_CELL: f64 = 2_500.0;

/// A line on memory and time; none where they cannot be told.
pub fn line(model: &Model) -> Option<String> {
    let first = model.steps.first()?;
    let state = model.system.initial_state();
    let Cost { linear, assembly } =
        forecast(&model.system, first, &state, model.settings.linear).ok()?;
    let linear = linear?;
    let mesh = PER_NODE * model.mesh.nnode() as f64 + PER_CELL * model.mesh.ncell() as f64;
    let memory = PROGRAM + mesh + linear.bytes();
    Some(format!(
        "cost: about {} of memory, {} for each iteration on this machine",
        bytes(memory),
        duration(linear.seconds() + assembly)
    ))
}

fn duration(seconds: f64) -> String {
    if seconds < 0.01 {
        "less than 0.01 s".to_owned()
    } else if seconds < 90.0 {
        format!("{} s", short(seconds))
    } else {
        format!("{} min", short(seconds / 60.0))
    }
}

fn bytes(bytes: f64) -> String {
    if bytes < 1e9 {
        format!("{:.0} MB", (bytes / 1e6).max(1.0))
    } else {
        format!("{:.1} GB", bytes / 1e9)
    }
}
