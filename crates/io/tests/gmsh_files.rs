//! Meshes written by Gmsh itself (4.15.2, see `data/make.py`).
//!
//! Expected counts and groups are those that Gmsh reports for the model.

#![allow(clippy::unwrap_used)]

use signorini_geometry::mesh::{FaceIndex, Mesh};
use signorini_io::readers::{parts, read_mesh, validate};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

fn read(name: &str) -> (Mesh, Vec<String>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name);
    read_mesh(name, &fs::read(path).unwrap()).unwrap()
}

fn count(mesh: &Mesh) -> BTreeMap<&'static str, usize> {
    mesh.blocks
        .iter()
        .map(|b| (b.element.name(), b.ncell()))
        .collect()
}

/// The sum of the volumes of the tetrahedra, or of the bricks by their diagonal, which are boxes.
fn volume(mesh: &Mesh) -> f64 {
    let volume = |cell| {
        let nodes = mesh.cell(cell);
        let x = |i: usize| mesh.points[nodes[i] as usize];
        if nodes.len() == 4 {
            (x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)) / 6.0
        } else {
            let d = x(6) - x(0);
            d.x * d.y * d.z
        }
    };
    mesh.cells(3).map(volume).sum()
}

const BOX: [&str; 9] = [
    "box_22_text.msh",
    "box_22_binary.msh",
    "box_22_parametric_text.msh",
    "box_22_parametric_binary.msh",
    "box_22_partitioned.msh",
    "box_41_text.msh",
    "box_41_binary.msh",
    "box_41_parametric_binary.msh",
    "box_41_partitioned.msh",
];

#[test]
fn every_way_to_save_the_box_gives_its_cells_and_groups() {
    for name in BOX {
        let (mesh, notes) = read(name);
        assert_eq!(mesh.nnode(), 14, "{name}");
        let expected = BTreeMap::from([("line2", 1), ("tri3", 8), ("tet4", 24)]);
        // the mesh in 2.2 holds elements of physical groups only, once per group
        assert_eq!(count(&mesh), expected, "{name}");
        let names: Vec<&String> = mesh.sets.keys().collect();
        assert_eq!(
            names,
            ["bottom", "edge", "ends", "volume_7", "whole box é"],
            "{name}"
        );
        let of = |set: &str| {
            let set = &mesh.sets[set];
            (set.cells.len(), set.nodes.len(), mesh.nodes_of(set).len())
        };
        assert_eq!(of("bottom"), (4, 0, 5), "{name}");
        assert_eq!(of("edge"), (1, 0, 2), "{name}");
        assert_eq!(of("ends"), (8, 2, 10), "{name}");
        assert_eq!(of("volume_7"), (24, 0, 14), "{name}");
        assert_eq!(mesh.sets["volume_7"], mesh.sets["whole box é"], "{name}");
        assert!((volume(&mesh) - 1.0).abs() < 1e-12, "{name}");
        assert_eq!(validate(&mesh), [], "{name}");
        let all: Vec<_> = mesh.cells(3).collect();
        assert_eq!(parts(&mesh, &all).len(), 1, "{name}");
        let index = FaceIndex::new(&mesh, mesh.cells(3));
        assert_eq!(mesh.faces(&mesh.sets["bottom"], &index).unwrap().len(), 4);
        for node in mesh.nodes_of(&mesh.sets["bottom"]) {
            assert_eq!(mesh.points[node as usize].z, 0.0, "{name}");
        }
        let one_set = "several physical groups are called `ends`; they are one set";
        assert!(notes.iter().any(|n| n == one_set), "{name}: {notes:?}");
    }
}

#[test]
fn text_and_binary_files_hold_the_same_mesh() {
    for [text, binary] in [
        ["box_22_text.msh", "box_22_binary.msh"],
        ["box_22_text.msh", "box_22_parametric_binary.msh"],
        ["box_41_text.msh", "box_41_binary.msh"],
        ["box_41_text.msh", "box_41_parametric_binary.msh"],
        ["plane_22_text.msh", "plane_22_binary.msh"],
        ["plane_41_text.msh", "plane_41_binary.msh"],
        ["brick_22_text.msh", "brick_22_binary.msh"],
        ["brick_41_text.msh", "brick_41_binary.msh"],
    ] {
        let (text, binary) = (read(text).0, read(binary).0);
        assert_eq!(text.node_labels, binary.node_labels);
        assert_eq!(text.blocks, binary.blocks);
        assert_eq!(text.sets, binary.sets);
        for (a, b) in text.points.iter().zip(&binary.points) {
            // text has 16 digits
            assert!((*a - *b).max_abs() <= 4e-16 * a.max_abs().max(1.0));
        }
    }
}

#[test]
fn the_plane_is_six_quadrilaterals_turned_the_right_way() {
    for name in ["plane_22_text.msh", "plane_41_binary.msh"] {
        let (mesh, notes) = read(name);
        assert_eq!(mesh.nnode(), 12);
        assert_eq!(count(&mesh), BTreeMap::from([("line2", 2), ("quad4", 6)]));
        assert_eq!(mesh.nodes_of(&mesh.sets["left"]).len(), 3);
        assert_eq!(mesh.sets["sheet"].cells.len(), 6);
        assert_eq!((validate(&mesh).len(), notes.len()), (0, 0), "{notes:?}");
        assert!(mesh.points.iter().all(|x| x.z == 0.0));
    }
}

#[test]
fn the_brick_is_twelve_hexahedra_under_six_quadrilaterals() {
    for name in [
        "brick_22_text.msh",
        "brick_22_binary.msh",
        "brick_41_text.msh",
        "brick_41_binary.msh",
    ] {
        let (mesh, _) = read(name);
        assert_eq!(mesh.nnode(), 36);
        assert_eq!(count(&mesh), BTreeMap::from([("quad4", 6), ("hex8", 12)]));
        assert!((volume(&mesh) - 6.0).abs() < 1e-9);
        let index = FaceIndex::new(&mesh, mesh.cells(3));
        let top = mesh.faces(&mesh.sets["top"], &index).unwrap();
        assert_eq!(top.len(), 6);
        assert!(top.iter().all(|f| f.side == 1), "{top:?}");
        for node in mesh.nodes_of(&mesh.sets["top"]) {
            assert!((mesh.points[node as usize].z - 1.0).abs() < 1e-12);
        }
        assert_eq!(validate(&mesh), [], "{name}");
    }
}
