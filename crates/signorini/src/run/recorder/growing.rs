//! The files that a run appends to.

use signorini_io::fs::Log;
use signorini_io::writers::csv::Table;
use signorini_io::writers::dat;
use signorini_io::writers::frd::FrdFile;
use signorini_io::writers::json::EventLog;
use signorini_io::writers::sta::StatusTable;

/// The growing files.
pub(super) struct Files {
    pub(super) history: Table,
    pub(super) convergence: Table,
    pub(super) sta: StatusTable,
    pub(super) events: EventLog,
    /// Where some step prints tables.
    pub(super) tables: Option<dat::Tables>,
    pub(super) log: Box<dyn Log>,
    pub(super) frd: Option<FrdFile>,
}
