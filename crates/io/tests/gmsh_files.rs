//! Meshes written by Gmsh itself (4.15.2, see `data/make.py`).
//!
//! Expected counts and groups are those that Gmsh reports for the model.

#![allow(clippy::unwrap_used)]

use signorini_geometry::element::Element;
use signorini_geometry::mesh::{CellId, FaceIndex, Mesh};
use signorini_geometry::tensor::Vec3;
use signorini_io::readers::{parts, read_mesh, validate};
use std::collections::{BTreeMap, BTreeSet};
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

/// Position and tangents of a cell at a point of its reference domain.
fn place(element: Element, x: &[Vec3], xi: &Vec3) -> [Vec3; 4] {
    let mut n = vec![0.0; element.nnode()];
    let mut dn = vec![Vec3::ZERO; element.nnode()];
    element.shape(xi, &mut n);
    element.dshape(xi, &mut dn);
    let sum = |w: &dyn Fn(usize) -> f64| x.iter().enumerate().map(|(i, &x)| x * w(i)).sum();
    [
        sum(&|i| n[i]),
        sum(&|i| dn[i].x),
        sum(&|i| dn[i].y),
        sum(&|i| dn[i].z),
    ]
}

/// The area or volume of a cell, by Gauss's theorem over its sides: an exact integral for quadratic sides. `None` where
/// the Jacobian is not positive, or where a node that is no corner is not near the middle of the corners around it.
fn judge(element: Element, x: &[Vec3]) -> Option<f64> {
    let dim = element.dim();
    for xi in element.nodes().iter().chain(element.full_rule().points) {
        let [_, t1, t2, t3] = place(element, x, xi);
        let t3 = if dim == 2 { Vec3::unit(2) } else { t3 };
        if t1.cross(t2).dot(t3) <= 0.0 {
            return None;
        }
    }
    let corners = &element.nodes()[..element.ncorner()];
    for (xi, &found) in element.nodes().iter().zip(x).skip(corners.len()) {
        // the corners around the node: nearest to it in the reference domain
        let distance = |c: &Vec3| (*c - *xi).norm();
        let least = corners.iter().map(distance).fold(f64::INFINITY, f64::min);
        let around = |k: &usize| distance(&corners[*k]) < 1.001 * least;
        let around: Vec<Vec3> = (0..corners.len()).filter(around).map(|k| x[k]).collect();
        let middle = around.iter().copied().sum::<Vec3>() / around.len() as f64;
        let size = (around[0] - middle).norm();
        if (found - middle).norm() > 0.45 * size {
            return None;
        }
    }
    let mut flux = 0.0;
    for side in element.sides() {
        let x: Vec<Vec3> = side.nodes.iter().map(|&i| x[i]).collect();
        for (xi, weight) in side.element.surface_rule().iter() {
            let [y, t1, t2, _] = place(side.element, &x, xi);
            let t2 = if dim == 2 { Vec3::unit(2) } else { t2 };
            flux += weight * y.dot(t1.cross(t2));
        }
    }
    Some(flux / dim as f64)
}

fn nodes(mesh: &Mesh, cell: CellId) -> Vec<Vec3> {
    let nodes = mesh.cell(cell).iter();
    nodes.map(|&n| mesh.points[n as usize]).collect()
}

/// Cells, side cells and measures are those that Gmsh reports when `data/make.py` runs.
#[test]
fn a_ring_of_curved_cells_has_the_volume_that_gmsh_finds() {
    let quarter = 2.354_360_677_734_17;
    for (name, ncell, nside, measure) in [
        ("tri6", 4, 2, quarter),
        ("quad8", 2, 2, quarter),
        ("quad9", 2, 2, quarter),
        ("tet10", 46, 14, 2.356_000_667_388_256),
        ("hex20", 2, 2, quarter),
        ("hex27", 2, 2, quarter),
        ("wedge15", 4, 2, quarter),
    ] {
        for file in ["41_text", "22_binary"] {
            let file = format!("ring_{name}_{file}.msh");
            let (mesh, notes) = read(&file);
            assert_eq!(notes, [""; 0], "{file}");
            assert_eq!(validate(&mesh), [], "{file}");
            let cells: Vec<CellId> = mesh.cells(mesh.dim()).collect();
            assert_eq!(cells.len(), ncell, "{file}");
            let element = mesh.element(cells[0]).unwrap();
            assert_eq!(element.name(), name);
            let volumes = cells.iter().map(|&c| judge(element, &nodes(&mesh, c)));
            let volume: f64 = volumes.map(|v| v.unwrap()).sum();
            assert!((volume - measure).abs() < 1e-12, "{file}: {volume}");

            let index = FaceIndex::new(&mesh, cells.iter().copied());
            let faces = mesh.faces(&mesh.sets["outer"], &index).unwrap();
            assert_eq!(faces.len(), nside, "{file}");
            let of_faces: BTreeSet<u32> = faces
                .iter()
                .flat_map(|&f| mesh.face(f).unwrap().1)
                .collect();
            let of_set = mesh.nodes_of(&mesh.sets["outer"]);
            assert!(of_faces.into_iter().eq(of_set.iter().copied()), "{file}");
            for node in of_set {
                let x = mesh.points[node as usize];
                assert!((x.x.hypot(x.y) - 2.0).abs() < 1e-9, "{file}: {x:?}");
            }
        }
    }
}

/// The claim above would see any two nodes in each other's place.
#[test]
fn any_two_nodes_exchanged_spoil_a_cell() {
    for name in [
        "tri6", "quad8", "quad9", "tet10", "hex20", "hex27", "wedge15",
    ] {
        let (mesh, _) = read(&format!("ring_{name}_41_text.msh"));
        let cell = mesh.cells(mesh.dim()).next().unwrap();
        let (element, x) = (mesh.element(cell).unwrap(), nodes(&mesh, cell));
        assert!(judge(element, &x).is_some());
        for i in 0..x.len() {
            for j in 0..i {
                let mut x = x.clone();
                x.swap(i, j);
                assert_eq!(judge(element, &x), None, "{name} {i} {j}");
            }
        }
    }
}
