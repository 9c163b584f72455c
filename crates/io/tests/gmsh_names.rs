//! Names of physical groups in meshes written by Gmsh itself (4.15.2, see `data/make_names.py`).

#![allow(clippy::unwrap_used)]

use signorini_geometry::mesh::{CellId, FaceIndex, Mesh};
use signorini_geometry::tensor::Vec3;
use signorini_io::readers::read_mesh;
use std::path::Path;

const FILES: [&str; 6] = [
    "names_22_text.msh",
    "names_22_binary.msh",
    "names_22_partitioned.msh",
    "names_41_text.msh",
    "names_41_binary.msh",
    "names_41_partitioned.msh",
];

fn read(name: &str) -> Mesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name);
    read_mesh(name, &std::fs::read(path).unwrap()).unwrap().0
}

/// Length, area or volume of the cells of one dimension in a set.
fn measure(mesh: &Mesh, set: &str, dim: usize) -> f64 {
    let cells = mesh.sets[set].cells.iter();
    let of_dim = cells.filter(|&&cell| mesh.element(cell).unwrap().dim() == dim);
    let measure = |&cell: &CellId| {
        let x: Vec<Vec3> = (mesh.cell(cell).iter())
            .map(|&n| mesh.points[n as usize])
            .collect();
        match dim {
            1 => (x[1] - x[0]).norm(),
            2 => (x[1] - x[0]).cross(x[2] - x[0]).norm() / 2.0,
            _ => (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0,
        }
    };
    of_dim.map(measure).sum()
}

#[test]
fn groups_on_every_kind_of_entity_keep_names_and_members() {
    for file in FILES {
        let mesh = read(file);
        let long = "x".repeat(100);
        let mut names: Vec<&str> = mesh.sets.keys().map(String::as_str).collect();
        names.sort_unstable();
        let mut expected = vec![
            "left body",
            "Körper rechts",
            "全部",
            "foot / z=0",
            "left foot",
            "inside",
            "corner [0,0,0]",
            &long,
        ];
        expected.sort_unstable();
        assert_eq!(names, expected, "{file}");
        for (set, dim, size) in [
            ("left body", 3, 1.0),
            ("Körper rechts", 3, 1.0),
            ("全部", 3, 2.0),
            ("foot / z=0", 2, 2.0),
            ("left foot", 2, 1.0),
            ("inside", 2, 1.0),
            ("left body", 1, 1.0),
        ] {
            let found = measure(&mesh, set, dim);
            assert!((found - size).abs() < 1e-12, "{file}: {set} has {found}");
        }
        assert_eq!(mesh.sets["corner [0,0,0]"].nodes.len(), 1, "{file}");
        assert_eq!(mesh.sets[&long].nodes.len(), 2, "{file}");
        let corner = mesh.sets["corner [0,0,0]"].nodes[0];
        assert_eq!(mesh.points[corner as usize].to_array(), [0.0; 3], "{file}");
        assert!(mesh.sets[&long].nodes.contains(&corner), "{file}");
    }
}

#[test]
fn a_group_inside_the_body_is_told_from_one_on_its_surface() {
    for file in FILES {
        let mesh = read(file);
        let index = FaceIndex::new(&mesh, mesh.cells(3));
        assert!(
            mesh.faces(&mesh.sets["left foot"], &index).is_ok(),
            "{file}"
        );
        let error = mesh
            .faces(&mesh.sets["inside"], &index)
            .unwrap_err()
            .to_string();
        assert!(error.contains("lies inside the body"), "{file}: {error}");
    }
}
