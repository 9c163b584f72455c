//! Memory and time that a solution takes.

use crate::setup::Model;
use crate::text::{count, plural, short};
use signorini_linear::Path;
use signorini_mechanics::solve::{Cost, forecast};

/// Bytes of the program, of a node and of a cell with their results, besides the linear system: measured.
const PROGRAM: f64 = 2e7;
const PER_NODE: f64 = 1_000.0;
const PER_CELL: f64 = 2_500.0;

/// What a solution is expected to take on this machine.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// Bytes of memory.
    pub memory_bytes: f64,
    /// Seconds for each iteration.
    pub seconds_per_iteration: f64,
    /// The same in words, and what it is where multigrid does not serve.
    #[serde(skip)]
    pub(super) lines: Vec<String>,
}

/// Memory and time; none where they are not known.
pub fn estimate(model: &Model) -> Option<Estimate> {
    let first = model.steps.first()?;
    let state = model.system.initial_state();
    let Cost { linear, assembly } =
        forecast(&model.system, first, &state, model.settings.linear).ok()?;
    let linear = linear?;
    let mesh = PER_NODE * model.mesh.nnode() as f64 + PER_CELL * model.mesh.ncell() as f64;
    let other = PROGRAM + mesh;
    let path = match linear.path {
        Path::Direct(_) => "a direct solution".to_owned(),
        Path::Multigrid { block, .. } => format!(
            "multigrid, and a direct solution of {} equations around the interface",
            count(block.nequation)
        ),
        Path::Ranks { nrank, block, .. } => format!(
            "PETSc on {}, and a direct solution of {} equations around the interface",
            plural(nrank, "rank"),
            count(block.nequation)
        ),
    };
    let each = match linear.path {
        Path::Ranks { .. } => " on each rank",
        _ => "",
    };
    let assembly = assembly / linear.nrank() as f64;
    let mut lines = vec![format!(
        "cost: about {} of memory{each}, {} for each iteration on this machine, by {path}",
        bytes(other + linear.bytes()),
        duration(linear.seconds() + assembly)
    )];
    if let (Some(memory), Some(seconds)) =
        (linear.bytes_of_fallback(), linear.seconds_of_fallback())
    {
        lines.push(format!(
            "should multigrid not serve, as with thin bodies: about {} of memory, {} for each iteration, by a factor of the bodies",
            bytes(other + memory),
            duration(seconds + assembly)
        ));
    }
    Some(Estimate {
        memory_bytes: other + linear.bytes(),
        seconds_per_iteration: linear.seconds() + assembly,
        lines,
    })
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
