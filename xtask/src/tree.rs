//! The files and folders of the repository, and which texts name one.

use crate::ChoreError;
use ignore::WalkBuilder;
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

/// Files and folders, from the root; ignored ones are left out.
#[derive(Debug, Default)]
pub struct Tree {
    files: BTreeSet<PathBuf>,
    folders: BTreeSet<PathBuf>,
}

/// Endings of names of files.
const ENDINGS: [&str; 26] = [
    "c", "cff", "csv", "dat", "frd", "geo", "gz", "in", "inc", "inp", "json", "jsonl", "log", "md",
    "msh", "png", "pvd", "py", "rs", "sh", "sta", "stl", "tmp", "toml", "vtu", "yml",
];

/// Folders at the root: what starts with one of them is a path even without an ending.
const TOP: [&str; 8] = [
    ".cargo", ".ci", ".github", "changes", "crates", "docs", "examples", "scripts",
];

impl Tree {
    /// Walks the repository.
    pub fn read(root: &Path) -> Result<Self, ChoreError> {
        let mut tree = Self::default();
        let walk = WalkBuilder::new(root)
            .hidden(false)
            .require_git(false)
            .filter_entry(|entry| entry.file_name() != ".git")
            .build();
        for entry in walk {
            let entry = entry.map_err(|error| ChoreError::Failed {
                what: format!("the walk through {}", root.display()),
                reason: error.to_string(),
            })?;
            let path = entry.path().strip_prefix(root).unwrap_or(entry.path());
            let is_folder = entry.file_type().is_some_and(|kind| kind.is_dir());
            if is_folder {
                tree.folders.insert(path.to_path_buf());
            } else {
                tree.files.insert(path.to_path_buf());
            }
        }
        Ok(tree)
    }

    /// A tree of these files and the folders around them.
    #[cfg(test)]
    pub fn of(files: &[&str]) -> Self {
        let files: BTreeSet<PathBuf> = files.iter().map(PathBuf::from).collect();
        let around = files.iter().flat_map(|file| file.ancestors().skip(1));
        let folders = around.map(Path::to_path_buf).collect();
        Self { files, folders }
    }

    /// All files.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(PathBuf::as_path)
    }

    /// Whether there is such a file or folder; the path counts from the root and may lead up again.
    pub fn has(&self, path: &Path) -> bool {
        let Some(path) = normal(path) else {
            return false;
        };
        self.files.contains(&path) || self.folders.contains(&path)
    }

    /// Whether a path leads somewhere from the folder of a page.
    pub fn has_from(&self, page: &Path, path: &str) -> bool {
        let folder = page.parent().unwrap_or(Path::new(""));
        self.has(&folder.join(path))
    }

    /// Whether a page may call something by this path: from its folder, or the last components of the path of a file
    /// or folder. Words in capitals stand for any name.
    pub fn knows(&self, page: &Path, path: &str) -> bool {
        if self.has_from(page, path) {
            return true;
        }
        let wanted: Vec<&str> = path.split('/').filter(|part| !part.is_empty()).collect();
        let ends_so = |other: &PathBuf| {
            let parts: Vec<&str> = other.iter().filter_map(|part| part.to_str()).collect();
            let behind = parts.len().checked_sub(wanted.len()).map(|at| &parts[at..]);
            behind.is_some_and(|behind| {
                behind
                    .iter()
                    .zip(&wanted)
                    .all(|(part, text)| matches(part, text))
            })
        };
        self.folders.iter().any(ends_so) || (!path.ends_with('/') && self.files.iter().any(ends_so))
    }
}

/// The text of a file.
pub fn read(path: &Path) -> Result<String, ChoreError> {
    std::fs::read_to_string(path).map_err(|source| ChoreError::Read {
        path: path.to_path_buf(),
        source,
    })
}

/// Whether a component is what the text asks for; `NAME.rs` asks for any file with the ending `rs`.
fn matches(part: &str, text: &str) -> bool {
    let (stem, ending) = text.split_once('.').unwrap_or((text, ""));
    if is_placeholder(stem) {
        return part.split_once('.').map_or("", |(_, ending)| ending) == ending;
    }
    part == text
}

/// Whether a word stands for a name that the reader chooses.
pub fn is_placeholder(word: &str) -> bool {
    word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase())
}

/// A path without `.` and `..`; none where it leads out of the repository.
pub fn normal(path: &Path) -> Option<PathBuf> {
    let mut out = PathBuf::new();
    for component in path.components() {
        match component {
            Component::Normal(part) => out.push(part),
            Component::ParentDir => out.pop().then_some(())?,
            Component::CurDir => {}
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(out)
}

/// Whether a text is the name of a file or folder.
pub fn is_path(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    if text.len() < 3 || !text.chars().all(plain) || text.chars().all(|c| "./".contains(c)) {
        return false;
    }
    let last = text.rsplit('/').next().unwrap_or_default();
    let ending = last.rsplit_once('.').filter(|(stem, _)| !stem.is_empty());
    let top = text.split_once('/').map(|(top, _)| top);
    ending.is_some_and(|(_, ending)| ENDINGS.contains(&ending))
        || text.ends_with('/')
        || top.is_some_and(|top| TOP.contains(&top))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree() -> Tree {
        Tree::of(&[
            "README.md",
            "crates/geometry/src/element/hex8.rs",
            "docs/limits.md",
            ".ci/run",
        ])
    }

    #[test]
    fn paths_count_from_the_page_or_by_their_end() {
        let (tree, page) = (tree(), Path::new("docs/limits.md"));
        for path in [
            "../README.md",
            "limits.md",
            "crates/geometry/src",
            "hex8.rs",
            "element/hex8.rs",
            "element/",
            ".ci/run",
        ] {
            assert!(tree.knows(page, path), "{path}");
        }
        for path in [
            "../../README.md",
            "crates/geometry/tests",
            "quad4.rs",
            "surface/hex8.rs",
            "hex8.rs/",
            "ex8.rs",
        ] {
            assert!(!tree.knows(page, path), "{path}");
        }
    }

    #[test]
    fn words_in_capitals_stand_for_any_name() {
        let (tree, page) = (tree(), Path::new("README.md"));
        assert!(tree.knows(page, "crates/geometry/src/element/NAME.rs"));
        assert!(!tree.knows(page, "crates/geometry/src/surface/NAME.rs"));
        assert!(!tree.knows(page, "crates/geometry/src/element/NAME.py"));
    }

    #[test]
    fn a_deleted_file_is_missed() {
        let page = Path::new("README.md");
        assert!(tree().has_from(page, "docs/limits.md"));
        assert!(!Tree::of(&["README.md"]).has_from(page, "docs/limits.md"));
    }

    #[test]
    fn names_of_files_differ_from_formulas() {
        for path in [
            "docs/a.md",
            "case.toml",
            "tests/",
            "crates/io",
            ".ci/run",
            "case.out/results.pvd",
        ] {
            assert!(is_path(path), "{path}");
        }
        for text in [
            "a/R",
            "M/h",
            "shear/normal",
            ".frd",
            "Term",
            "foot.force_x",
            "../",
            "a b.md",
            "signorini::run",
        ] {
            assert!(!is_path(text), "{text}");
        }
    }
}
