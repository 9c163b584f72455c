//! Which files of two folders of results belong together.

use crate::fs::{Fs, FsError};
use std::path::{Path, PathBuf};

/// A file of results in two folders, under the name it has there; nothing where a folder lacks it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The name within the folder.
    pub name: String,
    /// In the folder that is compared.
    pub found: Option<PathBuf>,
    /// In the reference.
    pub reference: Option<PathBuf>,
}

/// Pairs the files of results of two folders: `history.csv`, `.dat`, `.frd`, and the frames of `frames`. Files of the same
/// name belong together, and the only `.dat` or `.frd` of each, which have the names of their runs.
///
/// # Errors
/// Folders that cannot be listed.
pub fn pairs(fs: &dyn Fs, found: &Path, reference: &Path) -> Result<Vec<Pair>, FsError> {
    let (ours, theirs) = (results(fs, found)?, results(fs, reference)?);
    let mut all: Vec<Pair> = Vec::new();
    for (name, path) in ours {
        all.push(Pair {
            name,
            found: Some(path),
            reference: None,
        });
    }
    for (name, path) in theirs {
        let alone =
            |one: &Pair, ending: &str| one.reference.is_none() && one.name.ends_with(ending);
        let same = all.iter().position(|one| one.name == name);
        let partner = same.or_else(|| {
            let ending = [".dat", ".frd"]
                .into_iter()
                .find(|ending| name.ends_with(ending))?;
            let mut candidates =
                (0..all.len()).filter(|&k| all.get(k).is_some_and(|one| alone(one, ending)));
            let first = candidates.next()?;
            candidates.next().is_none().then_some(first)
        });
        match partner.and_then(|place| all.get_mut(place)) {
            Some(pair) => pair.reference = Some(path),
            None => all.push(Pair {
                name,
                found: None,
                reference: Some(path),
            }),
        }
    }
    all.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(all)
}

/// The files of results in a folder with their names.
fn results(fs: &dyn Fs, folder: &Path) -> Result<Vec<(String, PathBuf)>, FsError> {
    let mut all = Vec::new();
    let frames = folder.join("frames");
    let mut places = vec![(folder, String::new())];
    if fs.exists(&frames)? {
        places.push((&frames, "frames/".to_owned()));
    }
    for (place, before) in places {
        for path in fs.list(place)? {
            let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
            let Some(name) = name else { continue };
            let is_result = match before.as_str() {
                "" => name == "history.csv" || name.ends_with(".dat") || name.ends_with(".frd"),
                _ => name.ends_with(".vtu") && name != "failed.vtu",
            };
            if is_result {
                all.push((format!("{before}{name}"), path));
            }
        }
    }
    Ok(all)
}
