//! The rooms of the house and who may import whom.
//!
//! ```text
//! vocabulary ◀── geometry ◀── io;   geometry, linear ◀── mechanics;   mechanics, io ◀── signorini ◀── signorini-cli, python;   io ◀── report ◀── signorini-cli;   signorini ◀── verification ◀── signorini-cli
//! ```
//!
//! A room is a module with all its files. It may import itself, the rooms inside it and what its line lists; with a
//! room come the rooms inside it. It may not import the room around it. A file of a crate that has rooms is in one of
//! them, or is its root.
//!
//! Limits: a module reached through a name that some macro builds is not seen, nor is one behind `#[path]`; a path
//! that goes through a re-export counts for the room that re-exports.
//!
//! Files of a crate should use each other in no circle ([`mod@circles`]); the chore that reports them is not part of the
//! check, for there are some.
//!
//! To add a room: one line in [`ROOMS`].

mod circles;
mod imports;
mod tokens;

use crate::{ChoreError, Outcome};
use imports::{Found, ModulePath, imports};
use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};

/// A room and what it may import.
struct Room {
    name: &'static str,
    may_import: &'static [&'static str],
}

const fn room(name: &'static str, may_import: &'static [&'static str]) -> Room {
    Room { name, may_import }
}

/// Every room there is.
const ROOMS: [Room; 49] = [
    room("vocabulary", &[]),
    room("geometry", &[]),
    room("geometry::tensor", &[]),
    room("geometry::element", &["geometry::tensor"]),
    room("geometry::mesh", &["geometry::tensor", "geometry::element"]),
    room(
        "geometry::expansion",
        &["geometry::tensor", "geometry::element", "geometry::mesh"],
    ),
    room("geometry::proximity", &["geometry::tensor"]),
    room("geometry::scalar", &[]),
    room(
        "geometry::overlap",
        &["geometry::tensor", "geometry::element", "geometry::scalar"],
    ),
    room(
        "geometry::location",
        &[
            "geometry::tensor",
            "geometry::element",
            "geometry::mesh",
            "geometry::proximity",
            "geometry::surface",
        ],
    ),
    room(
        "geometry::surface",
        &[
            "vocabulary",
            "geometry::tensor",
            "geometry::element",
            "geometry::mesh",
            "geometry::proximity",
        ],
    ),
    room("ranks", &[]),
    room("linear", &["ranks"]),
    room("mechanics", &[]),
    room("mechanics::system", &["linear", "ranks", "geometry"]),
    room("mechanics::material", &["vocabulary", "geometry::tensor"]),
    room(
        "mechanics::solid",
        &["mechanics::system", "mechanics::material", "geometry"],
    ),
    room(
        "mechanics::load",
        &["vocabulary", "mechanics::system", "geometry"],
    ),
    room("mechanics::connector", &["mechanics::system", "geometry"]),
    room("mechanics::audit", &["mechanics::system", "geometry"]),
    room("mechanics::facing", &["geometry"]),
    room("mechanics::inertia", &["mechanics::system", "geometry"]),
    room(
        "mechanics::contact",
        &["mechanics::system", "mechanics::audit", "geometry"],
    ),
    room("mechanics::contact::law", &["vocabulary"]),
    room("mechanics::contact::friction", &["vocabulary"]),
    room("mechanics::contact::cohesion", &["geometry::tensor"]),
    room(
        "mechanics::contact::row",
        &["mechanics::system", "geometry"],
    ),
    room("mechanics::contact::mortar", &["geometry"]),
    room(
        "mechanics::contact::discretization",
        &[
            "mechanics::contact::row",
            "mechanics::contact::mortar",
            "geometry",
        ],
    ),
    room(
        "mechanics::explicit",
        &["mechanics::system", "geometry::tensor"],
    ),
    room(
        "mechanics::solve",
        &[
            "mechanics::system",
            "mechanics::explicit",
            "linear",
            "ranks",
        ],
    ),
    room("mechanics::model", &["mechanics", "linear", "geometry"]),
    room("io", &[]),
    room("io::fs", &[]),
    room("io::diagnostic", &[]),
    room("io::case", &["vocabulary", "io::diagnostic", "geometry"]),
    room(
        "io::readers",
        &[
            "io::case",
            "io::diagnostic",
            "io::fs",
            "io::frd",
            "io::vtk",
            "geometry",
        ],
    ),
    room(
        "io::deck",
        &[
            "io::case",
            "io::diagnostic",
            "io::fs",
            "io::readers",
            "vocabulary",
            "geometry",
        ],
    ),
    room("io::frd", &["geometry::element"]),
    room("io::vtk", &["io::fs", "geometry::element"]),
    room("io::writers", &["io::fs", "io::frd", "io::vtk", "geometry"]),
    room("io::compare", &["io::fs", "io::readers", "io::vtk"]),
    room("io::checkpoint", &["io::fs", "geometry"]),
    room("report", &["io", "geometry"]),
    room(
        "signorini",
        &[
            "io",
            "mechanics",
            "linear",
            "ranks",
            "geometry",
            "vocabulary",
        ],
    ),
    room("verification", &["signorini", "io", "geometry"]),
    room("mcp", &[]),
    room(
        "signorini-cli",
        &[
            "signorini",
            "verification",
            "report",
            "mcp",
            "io",
            "mechanics",
            "linear",
            "ranks",
            "geometry",
            "vocabulary",
        ],
    ),
    room(
        "python",
        &[
            "signorini",
            "signorini-cli",
            "report",
            "io",
            "mechanics",
            "geometry",
        ],
    ),
];

/// The names of all rooms, in the order of the table.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    ROOMS.iter().map(|room| room.name)
}

/// What a room may import, in the order of its line.
pub(crate) fn may_import(name: &str) -> Option<&'static [&'static str]> {
    let room = ROOMS.iter().find(|room| room.name == name);
    room.map(|room| room.may_import)
}

/// Whether the module `path` is `room` or lies inside it.
fn is_inside(path: &str, room: &str) -> bool {
    path.strip_prefix(room)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// The innermost room that a module path leads into.
fn room_of(path: &[String]) -> Option<&'static Room> {
    let path = path.join("::");
    let around = ROOMS.iter().filter(|room| is_inside(&path, room.name));
    around.max_by_key(|room| room.name.len())
}

impl Room {
    fn allows(&self, other: &Self) -> bool {
        is_inside(other.name, self.name) || self.may_import.iter().any(|r| is_inside(other.name, r))
    }

    /// Whether files may lie in it: it is no crate with rooms inside.
    fn holds_files(&self) -> bool {
        let parts = ROOMS
            .iter()
            .any(|r| r.name != self.name && is_inside(r.name, self.name));
        self.name.contains("::") || !parts
    }
}

/// A source file.
struct File {
    /// From the root of the repository.
    path: PathBuf,
    module: ModulePath,
    source: String,
}

#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Problem {
    /// A room imports one that its line does not list.
    Forbidden { from: String, to: String },
    /// A path into a crate that has no line.
    Unknown { from: String, to: String },
    /// A file outside every room.
    Homeless,
}

/// Something against the table.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Violation {
    path: PathBuf,
    line: usize,
    problem: Problem,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: ", self.path.display(), self.line)?;
        match &self.problem {
            Problem::Forbidden { from, to } => write!(f, "room {from} may not import room {to}"),
            Problem::Unknown { from, to } => write!(
                f,
                "room {from} imports {to}, which has no line in the table of rooms"
            ),
            Problem::Homeless => {
                f.write_str("this file is in no room: add a line to the table of rooms")
            }
        }
    }
}

/// What a check found.
#[derive(Debug, Default)]
struct Report {
    nfile: usize,
    /// Imports of another room that the table allows.
    nallowed: usize,
    violations: BTreeSet<Violation>,
}

/// Reads every source file and prints violations of the table.
pub(crate) fn check(root: &Path) -> Outcome {
    let files = source_files(root)?;
    let report = judge(&files);
    for violation in &report.violations {
        println!("{violation}");
    }
    let Report {
        nfile,
        nallowed,
        violations,
    } = report;
    let nroom = ROOMS.len();
    let nviolation = violations.len();
    println!(
        "rooms: {nfile} files, {nroom} rooms, {nallowed} imports between rooms, {nviolation} against the table"
    );
    Ok(violations.is_empty())
}

/// Prints the circles of files; there should be none.
pub(crate) fn circles(root: &Path) -> Outcome {
    let circles = circles::circles(&source_files(root)?);
    for circle in &circles {
        println!("{circle}");
    }
    println!("circles: {} of files", circles.len());
    Ok(circles.is_empty())
}

/// Prints the table.
pub(crate) fn graph(_: &Path) -> Outcome {
    print!("{}", table());
    Ok(true)
}

fn table() -> String {
    let width = ROOMS.iter().map(|r| r.name.len()).max().unwrap_or(0);
    let line = |room: &Room| {
        let list = match room.may_import {
            [] => "nothing".to_string(),
            some => some.join(", "),
        };
        format!("{:<width$}  imports {list}\n", room.name)
    };
    let head =
        "Every room also imports the rooms inside it; with a room come the rooms inside it.\n\n";
    head.to_string() + &ROOMS.iter().map(line).collect::<String>()
}

fn judge(files: &[File]) -> Report {
    let found: Vec<Found> = files
        .iter()
        .map(|f| imports(&f.source, &f.module))
        .collect();
    let tests: Vec<&ModulePath> = found.iter().flat_map(|f| &f.tests).collect();
    let is_test = |file: &File| tests.iter().any(|t| file.module.starts_with(t));
    let mut report = Report::default();
    for (file, found) in files.iter().zip(&found).filter(|(file, _)| !is_test(file)) {
        report.nfile += 1;
        let mut add = |line, problem| {
            let path = file.path.clone();
            report.violations.insert(Violation {
                path,
                line,
                problem,
            });
        };
        let is_root = file.module.len() == 1;
        let Some(from) = room_of(&file.module).filter(|r| is_root || r.holds_files()) else {
            add(1, Problem::Homeless);
            continue;
        };
        for import in &found.imports {
            let name = || from.name.to_string();
            match room_of(&import.path) {
                None => {
                    let to = import.path.first().cloned().unwrap_or_default();
                    add(import.line, Problem::Unknown { from: name(), to });
                }
                Some(to) if !from.allows(to) => {
                    let to = to.name.to_string();
                    add(import.line, Problem::Forbidden { from: name(), to });
                }
                Some(to) => report.nallowed += usize::from(to.name != from.name),
            }
        }
    }
    report
}

/// The sources of all crates, sorted; tests, benches and examples next to `src` see everything and are left out.
fn source_files(root: &Path) -> Result<Vec<File>, ChoreError> {
    let mut files = Vec::new();
    for folder in entries(&root.join("crates"))? {
        let (Some(name), src) = (
            folder.file_name().and_then(|n| n.to_str()),
            folder.join("src"),
        ) else {
            continue;
        };
        if src.is_dir() {
            collect(root, &src, &[name.to_string()], &mut files)?;
        }
    }
    Ok(files)
}

/// Adds the files of a folder, which is the module `module`.
fn collect(
    root: &Path,
    folder: &Path,
    module: &[String],
    out: &mut Vec<File>,
) -> Result<(), ChoreError> {
    for path in entries(folder)? {
        let Some(stem) = path.file_stem().and_then(|s| s.to_str()) else {
            continue;
        };
        let below = [module, &[stem.to_string()]].concat();
        if path.is_dir() {
            collect(root, &path, &below, out)?;
        } else if path.extension().is_some_and(|e| e == "rs") {
            let is_itself =
                stem == "mod" || (module.len() == 1 && (stem == "lib" || stem == "main"));
            let source = std::fs::read_to_string(&path);
            let source = source.map_err(|source| unreadable(&path, source))?;
            out.push(File {
                path: path.strip_prefix(root).unwrap_or(&path).to_path_buf(),
                module: if is_itself { module.to_vec() } else { below },
                source,
            });
        }
    }
    Ok(())
}

/// What lies in a folder, sorted.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, ChoreError> {
    let list = std::fs::read_dir(folder).map_err(|source| unreadable(folder, source))?;
    let paths: Result<Vec<PathBuf>, _> = list.map(|entry| entry.map(|e| e.path())).collect();
    let mut paths = paths.map_err(|source| unreadable(folder, source))?;
    paths.sort();
    Ok(paths)
}

fn unreadable(path: &Path, source: std::io::Error) -> ChoreError {
    let path = path.to_path_buf();
    ChoreError::Read { path, source }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(module: &str, source: &str) -> File {
        File {
            path: PathBuf::from(module.replace("::", "/") + ".rs"),
            module: module.split("::").map(ToString::to_string).collect(),
            source: source.to_string(),
        }
    }

    fn complaints(module: &str, source: &str) -> Vec<String> {
        let report = judge(&[file(module, source)]);
        report.violations.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn every_line_of_the_table_names_rooms_and_none_twice() {
        let names: BTreeSet<&str> = ROOMS.iter().map(|r| r.name).collect();
        assert_eq!(names.len(), ROOMS.len());
        for room in &ROOMS {
            for other in room.may_import {
                assert!(names.contains(other), "{} lists {other}", room.name);
            }
        }
    }

    #[test]
    fn rooms_do_not_import_each_other_in_a_circle() {
        // rooms that only import rooms already cleared are cleared; a circle is what never gets cleared
        let uses =
            |a: &Room, b: &Room| a.name != b.name && a.allows(b) && !is_inside(a.name, b.name);
        let mut left: Vec<&Room> = ROOMS.iter().collect();
        loop {
            let before = left.len();
            let blocked = left.clone();
            left.retain(|a| blocked.iter().any(|b| uses(a, b)));
            if left.len() == before {
                break;
            }
        }
        let names: Vec<&str> = left.iter().map(|r| r.name).collect();
        assert_eq!(names, [""; 0]);
    }

    #[test]
    fn what_the_design_forbids_is_reported_with_file_and_line() {
        assert_eq!(
            complaints(
                "mechanics::solve::newton",
                "use crate::system::Term;\nuse crate::contact::Interface;"
            ),
            [
                "mechanics/solve/newton.rs:2: room mechanics::solve may not import room mechanics::contact"
            ]
        );
        for (module, source) in [
            ("geometry::tensor::vec3", "use crate::mesh::Mesh;"),
            ("geometry::element::hex8", "fn f() { crate::surface::g() }"),
            ("mechanics::solve", "use signorini_geometry::tensor::Vec3;"),
            ("mechanics::solve", "use crate::solid;"),
            (
                "mechanics::material::neo_hookean",
                "use crate::system::Dof;",
            ),
            ("mechanics::material", "use signorini_geometry::mesh::Mesh;"),
            ("mechanics::material", "use signorini_geometry as g;"),
            (
                "mechanics::contact::law::penalty",
                "use super::super::interface::X;",
            ),
            ("mechanics::contact::law", "use crate::system::Dof;"),
            ("mechanics::contact::friction", "use super::law::Eval;"),
            (
                "mechanics::contact::discretization",
                "use crate::system::Layout;",
            ),
            (
                "mechanics::contact::discretization",
                "use crate::contact::law::Eval;",
            ),
            ("mechanics::system::term", "use crate::*;"),
            ("io::case", "use crate::readers::read;"),
            ("io::case", "use signorini_mechanics::material::TABLE;"),
            ("io::writers::vtu", "use crate::case::Case;"),
            ("io::fs", "use super::writers;"),
        ] {
            assert_eq!(complaints(module, source).len(), 1, "{module}: {source}");
        }
    }

    #[test]
    fn what_the_design_allows_passes() {
        for (module, source) in [
            (
                "geometry::surface::facets",
                "use crate::proximity::Aabb; use super::pair;",
            ),
            (
                "geometry",
                "pub use tensor::Vec3; pub use crate::mesh::Mesh;",
            ),
            (
                "mechanics::material",
                "use signorini_geometry::tensor::{Sym3, Mat3};",
            ),
            (
                "mechanics::contact::interface",
                "use super::law::Eval; use crate::system::{Dof, Term};",
            ),
            (
                "mechanics::contact::discretization::mortar",
                "use super::super::row::Rows;",
            ),
            (
                "mechanics::model",
                "use crate::contact::law::Penalty; use crate::{solve, solid};",
            ),
            (
                "io::readers::inp",
                "use crate::case::Case; use signorini_geometry::mesh::Mesh;",
            ),
            (
                "signorini::run",
                "use signorini_io::writers::vtu; use signorini_mechanics::solve;",
            ),
            (
                "geometry::tensor",
                "use std::fmt; #[cfg(test)] use crate::mesh::Mesh;",
            ),
        ] {
            assert_eq!(complaints(module, source), [""; 0], "{module}: {source}");
        }
    }

    #[test]
    fn files_of_tests_are_free() {
        let files = [
            file("geometry::tensor", "#[cfg(test)] mod tests;"),
            file("geometry::tensor::tests", "use crate::mesh::Mesh;"),
            file("geometry::tensor::tests::more", "use crate::mesh::Mesh;"),
        ];
        let report = judge(&files);
        assert_eq!((report.nfile, report.violations.len()), (1, 0));
    }

    #[test]
    fn a_file_or_crate_without_a_line_is_reported() {
        assert!(complaints("geometry::attic::old", "")[0].contains("in no room"));
        assert!(complaints("geometry::attic", "")[0].contains("in no room"));
        assert!(complaints("attic", "")[0].contains("in no room"));
        assert!(complaints("io::case", "use signorini_attic::X;")[0].contains("imports attic"));
        assert_eq!(complaints("signorini::run::progress", ""), [""; 0]);
    }

    #[test]
    fn the_sources_of_this_repository_are_found_as_modules() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let files = source_files(&root).unwrap();
        let has = |module: &str| files.iter().any(|f| f.module.join("::") == module);
        assert!(has("geometry"));
        assert!(has("geometry::tensor::vec3"));
        assert!(has("mechanics::contact::law"));
        assert!(has("signorini"));
    }

    #[test]
    fn the_printed_table_has_a_line_for_every_room() {
        let text = table();
        assert_eq!(text.lines().count(), ROOMS.len() + 2);
        assert!(
            text.contains(
                "mechanics::audit                    imports mechanics::system, geometry\n"
            )
        );
    }
}
