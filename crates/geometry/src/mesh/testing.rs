//! Meshes for tests.

use super::{Mesh, NodeId};
use crate::element::by_name;
use crate::tensor::Vec3;

/// Bricks with edges of length `size`, as many along each axis as `n` says; nodes run along x first.
pub(super) fn bricks(n: [u32; 3], size: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for k in 0..=n[2] {
        for j in 0..=n[1] {
            for i in 0..=n[0] {
                let x = Vec3::new(f64::from(i), f64::from(j), f64::from(k));
                mesh.points.push(x * size);
                mesh.node_labels.push(mesh.points.len() as u64);
            }
        }
    }
    let node = |i, j, k| -> NodeId { i + (n[0] + 1) * (j + (n[1] + 1) * k) };
    let hex8 = by_name("hex8").unwrap();
    for k in 0..n[2] {
        for j in 0..n[1] {
            for i in 0..n[0] {
                let [a, b] = [k, k + 1].map(|k| {
                    [
                        node(i, j, k),
                        node(i + 1, j, k),
                        node(i + 1, j + 1, k),
                        node(i, j + 1, k),
                    ]
                });
                let label = mesh.ncell() as u64 + 1;
                mesh.push_cell(hex8, &[a, b].concat(), label);
            }
        }
    }
    mesh
}
