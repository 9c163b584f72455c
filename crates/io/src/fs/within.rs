//! Confinement: a process that may only use the files in one folder.
//!
//! ```text
//! confine(root) ──▶ ROOT, once per process
//! RealFs, read: ──▶ permit(path) ──▶ resolve: links followed, `..` gone ──▶ starts with ROOT, or FsError::Outside
//! ```
//!
//! Limits: between [`permit`] and the use of a path, another process could replace a folder on it by a link; the command
//! closes that gap on Linux, where the kernel refuses, too. Hard links are files of the folder.

use super::{Action, FsError};
use std::ffi::OsString;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;

/// The folder that [`super::RealFs`] is confined to; every folder where unset.
static ROOT: OnceLock<PathBuf> = OnceLock::new();

/// From now on [`super::RealFs`] refuses every path outside of `root`, whoever names it: the command line, a case, a deck
/// that includes another, or the record of an earlier run. Returns the folder with all links resolved.
///
/// For processes that work for somebody else; it holds until the process ends.
///
/// # Errors
/// A folder that does not exist; a second call with another folder.
pub fn confine(root: &Path) -> Result<PathBuf, FsError> {
    let real = root
        .canonicalize()
        .map_err(|e| FsError::new(Action::List, root, e))?;
    let known = ROOT.get_or_init(|| real.clone());
    if *known == real {
        return Ok(real);
    }
    Err(FsError::Outside {
        action: Action::List,
        path: real,
        root: known.clone(),
    })
}

/// Whether `action` may use `path`: always, unless [`confine`] was called.
///
/// # Errors
/// [`FsError::Outside`] for a path that leads out of the folder that the process is confined to.
pub fn permit(action: Action, path: &Path) -> Result<(), FsError> {
    match ROOT.get() {
        None => Ok(()),
        Some(root) => inside(root, action, path),
    }
}

/// Reads a whole file, as [`std::fs::read`] does, unless the process is confined to another folder.
///
/// For callers that report the system's own words; others read through [`super::Fs`].
///
/// # Errors
/// Those of the system; [`io::ErrorKind::PermissionDenied`] for a path outside of the folder.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    permit(Action::Read, path)
        .map_err(|error| io::Error::new(io::ErrorKind::PermissionDenied, error))?;
    std::fs::read(path)
}

fn inside(root: &Path, action: Action, path: &Path) -> Result<(), FsError> {
    let real = resolve(path).map_err(|source| FsError::new(action, path, source))?;
    if real.is_some_and(|real| real.starts_with(root)) {
        return Ok(());
    }
    Err(FsError::Outside {
        action,
        path: path.to_path_buf(),
        root: root.to_path_buf(),
    })
}

/// The place that a path leads to, whether or not there is something: the longest part of it that exists with its links
/// resolved, and the names behind it. None where a link leads to nothing: what is created through it could be anywhere.
fn resolve(path: &Path) -> io::Result<Option<PathBuf>> {
    let path = std::path::absolute(path)?;
    let mut missing: Vec<OsString> = Vec::new();
    let mut known = path.as_path();
    loop {
        match known.symlink_metadata() {
            Ok(_) => break,
            Err(e) if e.kind() == io::ErrorKind::NotFound => {}
            Err(e) => return Err(e),
        }
        // a name that is missing has no folder above it, so that `..` behind it leads nowhere
        let Some(Component::Normal(name)) = known.components().next_back() else {
            return Err(io::ErrorKind::NotFound.into());
        };
        missing.push(name.to_owned());
        known = known.parent().ok_or(io::ErrorKind::NotFound)?;
    }
    let mut real = match known.canonicalize() {
        Ok(real) => real,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(e),
    };
    real.extend(missing.iter().rev());
    Ok(Some(real))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_inside(root: &Path, path: &Path) -> bool {
        inside(root, Action::Read, path).is_ok()
    }

    #[test]
    fn paths_in_the_folder_are_permitted_whether_they_exist_or_not() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().canonicalize().unwrap();
        std::fs::create_dir(root.join("a")).unwrap();
        for name in ["a", "a/new.csv", "new/folder/new.csv", "a/../b.csv", ""] {
            assert!(is_inside(&root, &root.join(name)), "{name}");
        }
    }

    #[test]
    fn paths_that_lead_out_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().canonicalize().unwrap().join("root");
        std::fs::create_dir(&root).unwrap();
        let twin = root.with_file_name("root-twin");
        std::fs::create_dir(&twin).unwrap();
        for path in [
            root.join(".."),
            root.join("../other.csv"),
            root.join("../root-twin/a.csv"),
            root.join("missing/../../other.csv"),
            twin,
            PathBuf::from("/etc/hostname"),
            PathBuf::from("relative.csv"),
        ] {
            assert!(!is_inside(&root, &path), "{}", path.display());
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_also_those_that_lead_to_nothing() {
        use std::os::unix::fs::symlink;
        let dir = tempfile::tempdir().unwrap();
        let base = dir.path().canonicalize().unwrap();
        let root = base.join("root");
        std::fs::create_dir_all(root.join("data")).unwrap();
        std::fs::write(base.join("secret"), "s").unwrap();
        symlink(base.join("secret"), root.join("file")).unwrap();
        symlink(&base, root.join("up")).unwrap();
        symlink(base.join("not yet"), root.join("dangling")).unwrap();
        symlink(root.join("data"), root.join("fine")).unwrap();
        symlink("loop", root.join("loop")).unwrap();
        for name in ["file", "up", "up/secret", "up/new", "dangling", "loop"] {
            assert!(!is_inside(&root, &root.join(name)), "{name}");
        }
        assert!(is_inside(&root, &root.join("fine/new.csv")));
        assert!(is_inside(&root, &root.join("up/root/data")));
    }
}
