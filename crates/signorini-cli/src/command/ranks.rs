//! The processes of `mpirun`: which of them speaks and writes, and how all of them end.
//!
//! ```text
//!  signals taken ─▶ enter ─▶ the command, on every rank ─▶ end
//!                              Console: rank 0 speaks       one exit code
//!                              disk: rank 0 writes
//! ```
//!
//! Commands that do not enter are alone, whatever started them; so are processes that nothing like `mpirun` has started.

use super::console::Console;
use signorini::Diagnostics;
use signorini::ranks::{LockStep, disk_of_first};
use signorini_io::fs::{Fs, RealFs};
use std::sync::{Arc, OnceLock};

static RANKS: OnceLock<Arc<LockStep>> = OnceLock::new();

/// What programs that start several processes set for each of them: OpenMPI, MPICH and others by PMI, Slurm.
const STARTED: [&str; 6] = [
    "OMPI_COMM_WORLD_SIZE",
    "PMIX_RANK",
    "PMI_RANK",
    "PMI_SIZE",
    "MPI_LOCALNRANKS",
    "SLURM_PROCID",
];

/// Joins the processes that this one was started with. To be called when signals are taken: MPI has threads of its own.
pub fn enter() {
    // MPI would start a daemon for a process by itself, and needs files outside of a folder that it is confined to
    if STARTED.iter().any(|name| std::env::var_os(name).is_some()) {
        RANKS.get_or_init(|| Arc::new(LockStep::new(signorini_ranks::world())));
    }
}

/// The ranks of this process.
pub fn all() -> Arc<LockStep> {
    RANKS.get().cloned().unwrap_or_default()
}

/// Whether this process says what happens.
pub fn speaks() -> bool {
    RANKS.get().is_none_or(|ranks| ranks.speaks())
}

/// The disk, that of rank 0; all ranks make the same calls.
pub fn disk() -> Arc<dyn Fs> {
    disk_of_first(&all(), || Arc::new(RealFs))
}

/// How many ranks share the cores of this machine: as the program that has started them says, else all.
pub fn on_this_machine() -> usize {
    let ranks = all().size();
    if ranks == 1 {
        return 1;
    }
    let said = ["OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"];
    let said = said.iter().find_map(|name| std::env::var(name).ok());
    let said = said.and_then(|text| text.trim().parse().ok());
    said.filter(|n| (1..=ranks).contains(n)).unwrap_or(ranks)
}

/// ` on rank 2 of 4`, where there are several.
pub fn here() -> String {
    let ranks = all();
    match ranks.is_alone() {
        true => String::new(),
        false => format!(" on rank {} of {}", ranks.rank(), ranks.size()),
    }
}

/// Says why there is nothing more to do: rank 0, and whichever rank alone knows of it.
pub fn say(found: &Diagnostics) {
    let console = Console::stderr();
    if all().rank() != 0 {
        console.line(&format!("stopped{}:", here()));
    }
    console.findings(found);
}

/// Says what this rank alone has found in a run, which rank 0 cannot.
pub fn say_own(found: &Diagnostics) {
    if all().rank() != 0 {
        say(found);
    }
}

/// The exit code of all ranks at the end of this one's command.
pub fn end(exit_code: u8) -> u8 {
    let ranks = all();
    let had_parted = ranks.parted().is_some();
    match ranks.end(exit_code) {
        Ok(code) => code,
        Err(parted) => {
            if !had_parted {
                Console::stderr().findings(&parted.diagnostic().into());
            }
            ranks.leave();
            parted.exit_code()
        }
    }
}
