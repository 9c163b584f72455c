//! What contact promises, measured: rows against dual numbers, tangents against differences, whole interfaces against
//! balance, energy and renumbering.

mod dual;
mod interface;
mod paper;
pub(crate) mod printed;
mod rigid;

use super::discretization::{Discretization, Pairing, RowOrder, SurfacePair};
use super::row::Rows;
use signorini_geometry::element::by_name;
use signorini_geometry::mesh::{Face, Mesh, NodeId};
use signorini_geometry::proximity::{Aabb, Search};
use signorini_geometry::surface::{Facets, Placement};
use signorini_geometry::tensor::Vec3;

/// A small reproducible generator (xorshift64*).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// Uniform on [-1, 1].
    pub(crate) fn signed(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        bits as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }
}

/// A surface of lines, triangles or quadrilaterals, told apart by how many nodes they have. Solids need nodes behind
/// their faces: these are appended to `x`, and play no part.
pub(crate) fn facets(x: &mut Vec<Vec3>, nodes: &[Vec<NodeId>]) -> Facets {
    let b = x.len() as NodeId;
    x.extend([Vec3::ZERO; 4]);
    let mut mesh = Mesh {
        points: x.clone(),
        node_labels: (1..=x.len() as u64).collect(),
        ..Mesh::default()
    };
    let mut faces = Vec::new();
    for (k, n) in nodes.iter().enumerate() {
        let (parent, cell, side) = match **n {
            [p, q] => ("quad4", vec![p, q, b, b + 1], 0),
            [p, q, r] => ("wedge6", vec![b, b + 1, b + 2, p, q, r], 1),
            [p, q, r, s] => ("hex8", vec![b, b + 1, b + 2, b + 3, p, q, r, s], 1),
            _ => panic!("no facet has {} nodes", n.len()),
        };
        let cell = mesh.push_cell(by_name(parent).unwrap(), &cell, k as u64 + 1);
        faces.push(Face { cell, side });
    }
    let surface = Facets::new(&mesh, &faces).unwrap();
    for (k, n) in (0u32..).zip(nodes) {
        assert_eq!(surface.nodes(k), n);
    }
    surface
}

/// The choices made at a configuration without memory, with candidates up to `range`.
pub(crate) fn pair_up(
    method: &dyn Discretization,
    pair: &SurfacePair,
    at: &Placement,
    range: f64,
) -> Pairing {
    let points: Vec<Vec3> = (0..method.nrow())
        .map(|row| method.point(row, pair, at))
        .collect();
    let facets = 0..pair.primary.nfacet() as u32;
    let boxes: Vec<Aabb> = facets.map(|f| pair.primary.aabb(at, f)).collect();
    let mut search = Search::default();
    search.update(&points, &boxes, range, 0.5 * range, &|_, _| true);
    let mut found = Pairing::default();
    let (near, nothing) = (search.candidates(), Pairing::default());
    method
        .pair_up(pair, at, near, &nothing, &mut found)
        .unwrap();
    found
}

/// The rows of the first group, with everything in them.
pub(crate) fn first_rows(
    method: &dyn Discretization,
    pair: &SurfacePair,
    at: &Placement,
    pairing: &Pairing,
) -> Rows {
    let mut rows = Rows::default();
    method
        .rows(0, pair, at, pairing, RowOrder::Tangent, &mut rows)
        .unwrap();
    rows
}

/// The largest absolute value.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}
