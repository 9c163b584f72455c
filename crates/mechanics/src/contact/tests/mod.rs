//! What contact promises, measured: rows against dual numbers, tangents against differences, whole interfaces against
//! balance, energy and renumbering.

mod capabilities;
mod carried;
mod dual;
mod fluid;
mod held;
mod interface;
mod own;
mod paper;
mod passing;
pub(crate) mod printed;
pub(crate) mod reference;
mod rigid;
pub(crate) mod scene;
mod sliding;
mod table;
mod torn;
mod wear;

use super::discretization::{Discretization, Links, Pairing, SurfacePair};
use super::row::Rows;
use super::row::{RowOrder, Wanted};
use crate::system::{Increment, Phase, StepContext};
use signorini_geometry::element::{Side, TABLE};
use signorini_geometry::mesh::{Face, Mesh, NodeId};
use signorini_geometry::proximity::{Aabb, Search};
use signorini_geometry::surface::{Facets, Placement};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeMap;

/// The begin of an increment of the first step.
pub(crate) fn next_increment() -> Phase {
    let increment = Increment {
        number: 1,
        from: 0.0,
        to: 1.0,
    };
    Phase::of_increment(StepContext::default(), increment)
}

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

/// A surface of facets distinguished by how many nodes they have; three are a triangle.
pub(crate) fn facets(x: &mut Vec<Vec3>, nodes: &[Vec<NodeId>]) -> Facets {
    let named = nodes.iter().map(|n| {
        let name = match n.len() {
            2 => "line2",
            3 => "tri3",
            4 => "quad4",
            6 => "tri6",
            8 => "quad8",
            9 => "quad9",
            n => panic!("no facet has {n} nodes"),
        };
        (name, n.clone())
    });
    facets_of(x, &named.collect::<Vec<_>>())
}

/// A surface of these elements. Solids need nodes behind their faces: one is appended to `x`, and plays no part.
pub(crate) fn facets_of(x: &mut Vec<Vec3>, facets: &[(&str, Vec<NodeId>)]) -> Facets {
    let behind = x.len() as NodeId;
    x.push(Vec3::ZERO);
    let mut mesh = Mesh {
        points: x.clone(),
        node_labels: (1..=x.len() as u64).collect(),
        ..Mesh::default()
    };
    let mut faces = Vec::new();
    for (name, nodes) in facets {
        let is_facet = |side: &Side| side.element.name() == *name;
        let mut solids = TABLE.into_iter();
        let solid = solids.find(|e| e.sides().iter().any(is_facet)).unwrap();
        let side = solid.sides().iter().position(is_facet).unwrap();
        let mut cell = vec![behind; solid.nnode()];
        for (&place, &node) in solid.sides()[side].nodes.iter().zip(nodes) {
            cell[place] = node;
        }
        let cell = mesh.push_cell(solid, &cell, faces.len() as u64 + 1);
        let side = side as u8;
        faces.push(Face { cell, side });
    }
    let surface = Facets::new(&mesh, &faces).unwrap();
    for (k, (_, nodes)) in (0u32..).zip(facets) {
        assert_eq!(surface.nodes(k), nodes);
    }
    surface
}

/// The same facets with a mid node on every edge, and with one in the middle where `centre`.
pub(crate) fn with_mid_nodes(x: &mut Vec<Vec3>, facets: &mut [Vec<NodeId>], centre: bool) {
    let mut mids: BTreeMap<[NodeId; 2], NodeId> = BTreeMap::new();
    for nodes in facets {
        let corners = nodes.clone();
        let n = corners.len();
        for k in 0..if n == 2 { 1 } else { n } {
            let (a, b) = (corners[k], corners[(k + 1) % n]);
            let mid = *mids.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                x.push((x[a as usize] + x[b as usize]) * 0.5);
                x.len() as NodeId - 1
            });
            nodes.push(mid);
        }
        if centre && n == 4 {
            let middle = corners.iter().map(|&k| x[k as usize]).sum::<Vec3>() * 0.25;
            nodes.push(x.len() as NodeId);
            x.push(middle);
        }
    }
}

/// The choices made at a configuration without memory, with candidates up to `range`.
pub(crate) fn pair_up(
    method: &dyn Discretization,
    pair: &SurfacePair,
    at: &Placement,
    range: f64,
) -> Pairing {
    let points: Vec<Vec3> = (0..method.nrow())
        .map(|row| method.point(row).position(at))
        .collect();
    let facets = 0..pair.primary.nfacet() as u32;
    let boxes: Vec<Aabb> = facets.map(|f| pair.primary.aabb(at, f)).collect();
    let mut search = Search::default();
    search.update(&points, &boxes, range, 0.5 * range, &|_, _| true);
    let mut found = Pairing::default();
    method
        .pair_up(
            pair,
            at,
            &search,
            &Pairing::default(),
            RowOrder::Gap,
            &mut found,
        )
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
    let links = Links {
        pairing,
        before: pairing,
        anchors: &[],
        bond: false,
    };
    let wanted = Wanted {
        order: RowOrder::Tangent,
        slip: false,
    };
    method.row(0, pair, at, &links, wanted, &mut rows).unwrap();
    rows
}

/// The largest absolute value.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}
