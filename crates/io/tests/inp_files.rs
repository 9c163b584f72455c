//! Decks of CalculiX's own suite, where they lie next to the repository (`../shared/decks/calculix`).
//!
//! Expected counts are those of the numbers in the decks, counted by hand or by another program.

#![allow(clippy::unwrap_used)]

use signorini_geometry::element::by_name;
use signorini_geometry::mesh::{FaceIndex, Mesh};
use signorini_io::readers::{MeshIssue, Severity, read_mesh, validate};
use std::path::{Path, PathBuf};

fn folder() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let near = [root.join("../shared"), root.join("../../shared")];
    let found = near
        .into_iter()
        .map(|s| s.join("decks/calculix"))
        .find(|f| f.is_dir());
    if found.is_none() {
        println!("skipped: ../shared/decks/calculix is not there");
    }
    found
}

fn read(folder: &Path, name: &str) -> (Mesh, Vec<String>) {
    let path = folder.join(format!("{name}.inp"));
    read_mesh(path.to_str().unwrap(), &std::fs::read(&path).unwrap()).unwrap()
}

fn labels(mesh: &Mesh, nodes: &[u32]) -> Vec<u64> {
    nodes
        .iter()
        .map(|&n| mesh.node_labels[n as usize])
        .collect()
}

#[test]
fn two_cubes_have_their_sets_and_surfaces() {
    let Some(folder) = folder() else { return };
    let (mesh, _) = read(&folder, "contact1");
    assert_eq!((mesh.nnode(), mesh.ncell()), (16, 2));
    let index = FaceIndex::new(&mesh, mesh.cells(3));
    let primary = mesh.faces(&mesh.sets["Smast"], &index).unwrap();
    assert_eq!(primary.iter().map(|f| f.side).collect::<Vec<_>>(), [4]);
    assert_eq!(labels(&mesh, &mesh.sets["Sslav"].nodes), [10]);
    assert_eq!(mesh.sets["Nall"].nodes.len(), 16);
    assert_eq!(mesh.sets["Eall"].cells.len(), 2);
}

#[test]
fn every_deck_is_read_and_no_cell_is_inverted() {
    let Some(folder) = folder() else { return };
    let mut decks: Vec<PathBuf> = (std::fs::read_dir(&folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "inp"))
        .collect();
    decks.sort();
    assert!(decks.len() > 30);
    for path in decks {
        let name = path.display().to_string();
        let (mesh, notes) = match read_mesh(&name, &std::fs::read(&path).unwrap()) {
            Ok(read) => read,
            Err(error) => {
                // quadratic elements may be missing, nothing else
                assert!(by_name("hex20").is_none(), "{error}");
                assert!(error.to_string().contains("not supported yet"), "{error}");
                continue;
            }
        };
        let counts: Vec<String> = mesh
            .blocks
            .iter()
            .map(|b| format!("{} {}", b.ncell(), b.element.name()))
            .collect();
        println!(
            "{name}: {} nodes, {}; {notes:?}",
            mesh.nnode(),
            counts.join(", ")
        );
        for issue in validate(&mesh) {
            let bad = issue.severity() == Severity::Error;
            assert!(
                !bad || matches!(issue, MeshIssue::Duplicate { .. }),
                "{name}: {issue}"
            );
        }
    }
}
