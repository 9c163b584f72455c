//! The solution in a checkpoint, next to what the files of a run need.

use signorini_io::checkpoint::{self, ArchiveError};
use signorini_mechanics::system::Archive;

/// What the names of its arrays begin with.
const PREFIX: &str = "solve/";

/// Adds the solution to a checkpoint.
///
/// # Errors
/// An array that no checkpoint can have.
pub fn put(solution: &Archive, into: &mut checkpoint::Archive) -> Result<(), ArchiveError> {
    for (name, values) in &solution.arrays {
        into.put_f64(&format!("{PREFIX}{name}"), values)?;
    }
    Ok(())
}

/// The part of a checkpoint that belongs to the solution.
pub fn of(archive: &checkpoint::Archive) -> Archive {
    let mut solution = Archive::default();
    for name in archive.names() {
        if let (Some(own), Ok(values)) = (name.strip_prefix(PREFIX), archive.get_f64(name)) {
            solution.put(own, values);
        }
    }
    solution
}
