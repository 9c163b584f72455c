//! The output folder: what lies where, and whose it is.
//!
//! ```text
//! hertz.out/
//!   results.pvd  contact.pvd  frames/  hertz.frd  history.csv  convergence.csv  hertz.sta  hertz.dat
//!   modes.pvd  frequencies.csv   where steps find natural frequencies
//!   run.log  events.jsonl  summary.json  case.resolved.toml  view.py
//!   checkpoint/   a.sgc b.sgc   the state, in turns
//!                 case.toml     the case as it was read
//!                 run.json      where it came from: whose folder this is
//!                 lock          held while a run writes here
//! ```
//!
//! A folder that holds anything but the results of this case is refused, and nothing is removed that no run wrote.

use super::error::OutputError;
use crate::load::{Source, sha256};
use serde::{Deserialize, Serialize};
use signorini_io::checkpoint::Checkpoints;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_io::fs::{Fs, FsError, Lock};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Whose results a folder holds: `checkpoint/run.json`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Owner {
    /// The name of the run.
    pub name: String,
    /// The case file.
    pub case: PathBuf,
    /// The hash of its text.
    pub sha256: String,
    /// What `--set` changed.
    pub overrides: Vec<(String, String)>,
    /// The mesh file, where there is one.
    pub mesh: Option<PathBuf>,
    /// The hash of the mesh.
    pub mesh_sha256: Option<String>,
    /// The version of the program.
    pub version: String,
}

impl Owner {
    /// The owner that a source makes.
    #[must_use]
    pub fn of(source: &Source) -> Self {
        let absolute = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        Self {
            name: source.name.clone(),
            case: absolute(&source.path),
            sha256: sha256(&source.text),
            overrides: source.overrides.clone(),
            mesh: source.mesh.as_deref().map(absolute),
            mesh_sha256: source.inputs.get(1).map(|input| input.sha256.clone()),
            version: crate::VERSION.into(),
        }
    }

    /// Whether both are of one case: the same file, whatever is in it now, or the same text elsewhere.
    #[must_use]
    pub fn is_case_of(&self, other: &Self) -> bool {
        self.case == other.case || self.sha256 == other.sha256
    }

    /// Reads the owner of a folder, where there is one that can be read.
    #[must_use]
    pub fn read(fs: &dyn Fs, folder: &Path) -> Option<Self> {
        let bytes = fs.read(&folder.join(OWNER)).ok()?;
        serde_json::from_slice(&bytes).ok()
    }
}

const OWNER: &str = "checkpoint/run.json";
const CASE_COPY: &str = "checkpoint/case.toml";
const LOCK: &str = "checkpoint/lock";

/// Files at the top that a new run removes before it starts; those that grow are emptied when they are opened.
const TOP: [&str; 6] = [
    "results.pvd",
    "contact.pvd",
    "modes.pvd",
    "frequencies.csv",
    "summary.json",
    "case.resolved.toml",
];

/// An output folder that belongs to this run.
#[derive(Debug)]
pub struct Tree {
    folder: PathBuf,
    _lock: Lock,
}

/// What a run wants of its folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// Start; a folder of another case is refused.
    Start,
    /// Start, whoever's the folder was.
    Fresh,
    /// Go on with the results that are there.
    Resume,
}

impl Tree {
    /// Makes the folder this run's own, and empties it of earlier results unless it goes on with them.
    ///
    /// # Errors
    /// A folder of another case; a disk that cannot be written; a run that holds the folder.
    pub fn claim(
        fs: &Arc<dyn Fs>,
        folder: &Path,
        source: &Source,
        claim: Claim,
    ) -> Result<Self, Diagnostics> {
        let fs = fs.as_ref();
        let owner = Owner::of(source);
        if claim == Claim::Start {
            refuse_others(fs, folder, &owner)?;
        }
        let tree = open(fs, folder).map_err(|e| Diagnostics::from(e.diagnostic()))?;
        if claim != Claim::Resume {
            tree.prepare(fs, source, &owner)
                .map_err(|e| Diagnostics::from(e.diagnostic()))?;
        }
        Ok(tree)
    }

    /// A file or folder in it.
    #[must_use]
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn prepare(&self, fs: &dyn Fs, source: &Source, owner: &Owner) -> Result<(), OutputError> {
        Checkpoints::new(&self.path("checkpoint"), source.hash()).clear(fs)?;
        let frd = format!("{}.frd", owner.name);
        for name in TOP.into_iter().chain([frd.as_str()]) {
            let path = self.path(name);
            if fs.exists(&path)? {
                fs.remove(&path)?;
            }
        }
        for path in fs.list(&self.path("frames"))? {
            let name = path.file_name().map(|n| n.to_string_lossy());
            if name.is_some_and(|n| is_frame(&n)) {
                fs.remove(&path)?;
            }
        }
        let json = serde_json::to_string_pretty(owner).unwrap_or_default();
        fs.write_atomic(&self.path(CASE_COPY), &source.text)?;
        fs.write_atomic(&self.path(OWNER), json.as_bytes())?;
        Ok(())
    }
}

fn open(fs: &dyn Fs, folder: &Path) -> Result<Tree, OutputError> {
    fs.create_dir_all(&folder.join("checkpoint"))?;
    let lock = fs.lock(&folder.join(LOCK))?;
    fs.create_dir_all(&folder.join("frames"))?;
    Ok(Tree {
        folder: folder.to_path_buf(),
        _lock: lock,
    })
}

/// The process that runs in a folder now, as it names itself; none where no process does.
///
/// # Errors
/// A lock file that cannot be read.
pub fn process_in(fs: &dyn Fs, folder: &Path) -> Result<Option<String>, FsError> {
    let path = folder.join(LOCK);
    if !fs.is_locked(&path)? {
        return Ok(None);
    }
    let bytes = fs.read(&path).unwrap_or_default();
    Ok(Some(String::from_utf8_lossy(&bytes).trim().to_owned()))
}

/// Whether the last process in a folder was killed, and took the folder after a file in it was written.
#[must_use]
pub fn killed_after(fs: &dyn Fs, folder: &Path, file: &str) -> bool {
    let lock = folder.join(LOCK);
    let when = |path: &Path| fs.modified(path).ok().flatten();
    let is_left = fs.read(&lock).is_ok_and(|bytes| !bytes.is_empty());
    is_left && when(&lock) > when(&folder.join(file))
}

/// Takes a folder before its run begins, so that others see that something goes on there; none where that fails, as the run
/// will say.
#[must_use]
pub fn hold(fs: &dyn Fs, folder: &Path) -> Option<Lock> {
    fs.lock(&folder.join(LOCK)).ok()
}

/// The bytes of the case that a folder holds results of.
///
/// # Errors
/// No such copy.
pub fn case_copy(fs: &dyn Fs, folder: &Path) -> Result<Vec<u8>, FsError> {
    fs.read(&folder.join(CASE_COPY))
}

/// Refuses a folder that holds something other than results of this case.
fn refuse_others(fs: &dyn Fs, folder: &Path, owner: &Owner) -> Result<(), Diagnostics> {
    let shown = folder.display();
    let refused = |message: String| {
        Diagnostic::error(&codes::OTHER_RESULTS, message)
            .help("name another folder with -o DIR, or write there all the same with --fresh")
    };
    match Owner::read(fs, folder) {
        Some(found) if found.is_case_of(owner) => Ok(()),
        Some(found) => Err(
            refused(format!("{shown} holds the results of another case"))
                .note(format!(
                    "it was written by a run of {}",
                    found.case.display()
                ))
                .into(),
        ),
        // what cannot be listed is not there yet, or fails with a better message when it is written to
        None if fs
            .list(folder)
            .is_ok_and(|list| list.iter().any(|p| !is_leftover(p))) =>
        {
            Err(refused(format!(
                "{shown} is not empty and holds no results of this case"
            ))
            .into())
        }
        None => Ok(()),
    }
}

/// What a run leaves that was stopped before it could say whose the folder is.
fn is_leftover(path: &Path) -> bool {
    path.file_name()
        .is_some_and(|n| n == "checkpoint" || n == "frames")
}

/// Whether a file in `frames` is one that runs write.
fn is_frame(name: &str) -> bool {
    let name = name.strip_suffix(".tmp").unwrap_or(name);
    let Some(stem) = name.strip_suffix(".vtu") else {
        return false;
    };
    let number = stem
        .strip_prefix("volume_")
        .or_else(|| stem.strip_prefix("contact_"))
        .or_else(|| stem.strip_prefix("mode_"));
    stem == "failed"
        || number.is_some_and(|n| n.len() >= 4 && n.bytes().all(|b| b.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_io::fs::RealFs;

    fn source(name: &str, text: &str) -> Source {
        Source {
            name: name.into(),
            path: PathBuf::from(format!("/nowhere/{name}.toml")),
            text: text.as_bytes().to_vec(),
            ..Source::default()
        }
    }

    fn disk() -> Arc<dyn Fs> {
        Arc::new(RealFs)
    }

    #[test]
    fn only_what_runs_write_counts_as_a_frame() {
        for name in [
            "volume_0000.vtu",
            "contact_12345.vtu",
            "failed.vtu",
            "volume_0001.vtu.tmp",
        ] {
            assert!(is_frame(name), "{name}");
        }
        for name in [
            "volume_1.vtu",
            "mine.vtu",
            "volume_000a.vtu",
            "volume_0001.vtk",
            "failed",
        ] {
            assert!(!is_frame(name), "{name}");
        }
    }

    #[test]
    fn a_folder_of_another_case_is_refused_and_left_alone() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("a.out");
        drop(Tree::claim(&disk(), &folder, &source("a", "one"), Claim::Start).unwrap());
        let error = Tree::claim(&disk(), &folder, &source("b", "two"), Claim::Start).unwrap_err();
        assert_eq!(error.exit_code(), Some(3));
        assert!(error.plain().contains("--fresh"), "{error}");
        assert_eq!(Owner::read(&RealFs, &folder).unwrap().name, "a");
        Tree::claim(&disk(), &folder, &source("b", "two"), Claim::Fresh).unwrap();
        assert_eq!(Owner::read(&RealFs, &folder).unwrap().name, "b");
    }

    #[test]
    fn a_folder_with_other_things_is_refused_and_a_fresh_run_keeps_them() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path();
        std::fs::write(folder.join("letter.txt"), "dear").unwrap();
        let refused = Tree::claim(&disk(), folder, &source("a", "one"), Claim::Start);
        assert_eq!(refused.unwrap_err().exit_code(), Some(3));
        drop(Tree::claim(&disk(), folder, &source("a", "one"), Claim::Fresh).unwrap());
        std::fs::write(folder.join("frames/mine.vtu"), "x").unwrap();
        std::fs::write(folder.join("frames/volume_0007.vtu"), "x").unwrap();
        drop(Tree::claim(&disk(), folder, &source("a", "one"), Claim::Start).unwrap());
        assert!(folder.join("letter.txt").exists());
        assert!(folder.join("frames/mine.vtu").exists());
        assert!(!folder.join("frames/volume_0007.vtu").exists());
    }

    #[test]
    fn the_same_case_may_change_its_text_or_its_place() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("a.out");
        drop(Tree::claim(&disk(), &folder, &source("a", "one"), Claim::Start).unwrap());
        drop(Tree::claim(&disk(), &folder, &source("a", "changed"), Claim::Start).unwrap());
        drop(Tree::claim(&disk(), &folder, &source("moved", "changed"), Claim::Start).unwrap());
    }

    #[test]
    fn a_folder_that_another_run_holds_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let first = Tree::claim(&disk(), dir.path(), &source("a", "one"), Claim::Start).unwrap();
        let second = Tree::claim(&disk(), dir.path(), &source("a", "one"), Claim::Start);
        let error = second.unwrap_err();
        assert_eq!(error.exit_code(), Some(6));
        assert!(error.plain().contains("held by another run"), "{error}");
        drop(first);
        Tree::claim(&disk(), dir.path(), &source("a", "one"), Claim::Start).unwrap();
    }
}
