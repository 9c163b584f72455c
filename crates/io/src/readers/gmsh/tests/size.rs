//! Files of some size.

use super::*;
use crate::readers::validate;
use std::fmt::Write as _;

/// A box of `n³` nodes, cut into hexahedra.
fn grid(n: usize, version_2: bool) -> String {
    let mut text = String::new();
    let (nnode, ncell) = (n.pow(3), (n - 1).pow(3));
    let (mut labels, mut points) = (String::new(), String::new());
    for i in 0..nnode {
        let x = [i % n, i / n % n, i / n / n].map(|k| k as f64 / (n as f64 - 1.0) + 0.1);
        let point = format!("{} {} {}", x[0], x[1], x[2]);
        if version_2 {
            writeln!(points, "{} {point}", i + 1).unwrap();
        } else {
            writeln!(labels, "{}", i + 1).unwrap();
            writeln!(points, "{point}").unwrap();
        }
    }
    if version_2 {
        write!(text, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nnode}\n{points}$EndNodes\n$Elements\n{ncell}\n").unwrap();
    } else {
        write!(text, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 1 0\n$EndEntities\n").unwrap();
        write!(text, "$Nodes\n1 {nnode} 1 {nnode}\n3 1 0 {nnode}\n{labels}{points}$EndNodes\n$Elements\n1 {ncell} 1 {ncell}\n3 1 5 {ncell}\n").unwrap();
    }
    for c in 0..ncell {
        let m = n - 1;
        let base = c % m + c / m % m * n + c / m / m * n * n + 1;
        let tags = if version_2 { " 5 2 1 1" } else { "" };
        write!(text, "{}{tags}", c + 1).unwrap();
        for k in [0, 1, n + 1, n, n * n, n * n + 1, n * n + n + 1, n * n + n] {
            write!(text, " {}", base + k).unwrap();
        }
        text.push('\n');
    }
    text + "$EndElements\n"
}

#[test]
fn a_grid_of_a_thousand_nodes_is_whole() {
    for version_2 in [true, false] {
        let (mesh, notes) = read("grid.msh", grid(10, version_2).as_bytes()).unwrap();
        assert_eq!((mesh.nnode(), mesh.ncell(), notes.len()), (1000, 729, 0));
        assert_eq!(mesh.sets["volume_1"].cells.len(), 729);
        assert_eq!(validate(&mesh), []);
    }
}

/// Allocations and bytes of reading and validating grow with the file.
#[test]
fn memory_grows_in_proportion_to_the_file() {
    for version_2 in [true, false] {
        let [small, large] = [10, 30].map(|n| {
            let text = grid(n, version_2);
            let taken = allocation_counter::measure(|| {
                let (mesh, _) = read("grid.msh", text.as_bytes()).unwrap();
                assert_eq!(mesh.nnode(), n.pow(3));
                assert_eq!(validate(&mesh), []);
            });
            taken.bytes_total as f64 / text.len() as f64
        });
        // lists double when they are full
        assert!(
            large < 2.0 * small,
            "{small}, {large} bytes per byte of the file"
        );
    }
}
