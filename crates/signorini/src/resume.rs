//! Reading what a stopped run started from, out of its output folder.

use crate::load::{Loaded, Source, load_again, sha256};
use crate::run::{OutputError, Owner, Stop, cannot_resume, case_copy, hold, process_in};
use signorini_io::checkpoint::has_checkpoint;
use signorini_io::diagnostic::Diagnostics;
use signorini_io::fs::{Fs, FsError, Lock};
use signorini_io::writers::json::{Input, Summary};
use std::path::Path;

/// What a folder of results can be gone on with.
pub enum Stopped {
    /// The run was done; this is how it ended.
    Done(Box<Summary>),
    /// The run was stopped: its case as it was then, and its mesh.
    Open(Box<Loaded>),
}

/// Reads what a stopped run started from. The case is the copy in the folder; the mesh must not have changed.
///
/// # Errors
/// A folder without results, a mesh that has changed: exit code 7; a run that still goes on there: exit code 6.
pub fn stopped(fs: &dyn Fs, folder: &Path) -> Result<Stopped, Diagnostics> {
    stopped_and_held(fs, folder).map(|(stopped, _)| stopped)
}

/// As [`stopped`], and holds the folder from before the mesh is read: to be let go right before the run begins, which takes it
/// by itself.
///
/// # Errors
/// As there.
pub fn stopped_and_held(
    fs: &dyn Fs,
    folder: &Path,
) -> Result<(Stopped, Option<Lock>), Diagnostics> {
    let shown = folder.display();
    // asked before a large mesh is read; the lock itself is taken later
    if let Ok(Some(_)) = process_in(fs, folder) {
        let path = folder.to_path_buf();
        return Err(OutputError::Fs(FsError::Locked { path })
            .diagnostic()
            .into());
    }
    let owner = Owner::read(fs, folder).ok_or_else(|| {
        cannot_resume(format!(
            "{shown} holds no results of a run; start one: signorini run CASE -o {shown}"
        ))
    })?;
    if let Ok(summary) = Summary::read(fs, &folder.join("summary.json"))
        && summary.exit_code <= 1
        && !Stop::STATUSES.contains(&summary.status.as_str())
    {
        return Ok((Stopped::Done(Box::new(summary)), None));
    }
    let lock = hold(fs, folder);
    let text = case_copy(fs, folder).map_err(cannot_resume)?;
    if sha256(&text) != owner.sha256 {
        return Err(cannot_resume(format!(
            "the copy of the case in {shown} was changed; start again with --fresh"
        ))
        .into());
    }
    let name = owner.case.display().to_string();
    let loaded = load_again(Source {
        name: owner.name.clone(),
        folder: owner.case.parent().unwrap_or(Path::new(".")).to_path_buf(),
        inputs: vec![Input {
            path: name,
            sha256: sha256(&text),
        }],
        path: owner.case,
        text,
        overrides: owner.overrides,
        mesh: None,
    })?;
    let hash = loaded.source.inputs.get(1).map(|input| &input.sha256);
    if hash != owner.mesh_sha256.as_ref() {
        return Err(cannot_resume(
            "the mesh has changed since the run was stopped; undo the change, or start again with --fresh",
        )
        .into());
    }
    Ok((Stopped::Open(Box::new(loaded)), lock))
}

/// As [`stopped_and_held`], for the folder of a case: none where it holds no run of this case with a checkpoint.
///
/// # Errors
/// As [`stopped`]; a case that has changed since, or that other values were set in: exit code 7.
pub fn stopped_case(
    fs: &dyn Fs,
    folder: &Path,
    source: &Source,
) -> Result<Option<(Stopped, Option<Lock>)>, Diagnostics> {
    let now = Owner::of(source);
    let owner = Owner::read(fs, folder).filter(|owner| owner.is_case_of(&now));
    let Some(owner) = owner else {
        return Ok(None);
    };
    if !has_checkpoint(fs, &folder.join("checkpoint")) {
        return Ok(None);
    }
    if (&owner.sha256, &owner.overrides) != (&now.sha256, &now.overrides) {
        return Err(cannot_resume(format!(
            "the case has changed since the run in {}; start again with --fresh, or go on with the case as it was: \
             signorini resume {}",
            folder.display(),
            folder.display()
        ))
        .into());
    }
    stopped_and_held(fs, folder).map(Some)
}
