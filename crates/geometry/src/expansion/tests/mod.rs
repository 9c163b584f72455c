//! Meshes of shells, and what is measured on their expansions.

mod division;
mod errors;
mod normals;
mod sides;
mod surfaces;

use super::{Expansion, ExpansionError, Joining, Section, ShellCell, expand};
use crate::element::{Family, MAX_NODES, by_name};
use crate::mesh::{CellId, Mesh, NodeId, boundary};
use crate::tensor::{Mat3, Vec3};
use std::collections::{BTreeMap, HashMap};

/// Every element that shells can be of, and how many solids it becomes.
const ELEMENTS: [(&str, usize); 5] = [
    ("tri3", 3),
    ("tri6", 3),
    ("quad4", 1),
    ("quad8", 4),
    ("quad9", 4),
];

/// The label of a node in these tests, which is not its number.
fn label(node: usize) -> u64 {
    7 + 3 * node as u64
}

fn add_node(mesh: &mut Mesh, x: Vec3) -> NodeId {
    let node = mesh.nnode();
    mesh.points.push(x);
    mesh.node_labels.push(label(node));
    node as NodeId
}

/// Cells over the unit square, `n` along each axis, mapped by `x`. Squares are halved for triangles.
fn grid(element: &str, n: [u32; 2], x: impl Fn(f64, f64) -> Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    add_grid(&mut mesh, element, n, x);
    mesh
}

/// Adds such cells; nodes at the same position are shared.
fn add_grid(mesh: &mut Mesh, element: &str, n: [u32; 2], x: impl Fn(f64, f64) -> Vec3) {
    let element = by_name(element).unwrap();
    let key = |x: Vec3| x.to_array().map(|x| (x * 1e6).round() as i64);
    let mut known: HashMap<[i64; 3], NodeId> = HashMap::new();
    for (node, &x) in mesh.points.iter().enumerate() {
        known.insert(key(x), node as NodeId);
    }
    for j in 0..n[1] {
        for i in 0..n[0] {
            let corner = |a: u32, b: u32| Vec3::new(f64::from(i + a), f64::from(j + b), 0.0);
            let square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let [a, b, c, d] = square;
            let cells = match element.family() {
                Family::Triangle => vec![[a, b, c, c], [a, c, d, d]],
                _ => vec![square],
            };
            for corners in cells {
                let nodes: Vec<NodeId> = (element.nodes().iter())
                    .map(|xi| {
                        let at = match element.family() {
                            Family::Triangle => {
                                let [a, b, c, _] = corners;
                                a + (b - a) * xi.x + (c - a) * xi.y
                            }
                            _ => a + Vec3::new(1.0 + xi.x, 1.0 + xi.y, 0.0) * 0.5,
                        };
                        let x = x(at.x / f64::from(n[0]), at.y / f64::from(n[1]));
                        let node = known.get(&key(x)).copied();
                        node.unwrap_or_else(|| {
                            let node = add_node(mesh, x);
                            known.insert(key(x), node);
                            node
                        })
                    })
                    .collect();
                let label = mesh.ncell() as u64 + 1;
                mesh.push_cell(element, &nodes, label);
            }
        }
    }
}

/// All faces of a mesh, with section 0.
fn all(mesh: &Mesh) -> Vec<ShellCell> {
    let section = 0;
    mesh.cells(2)
        .map(|cell| ShellCell { cell, section })
        .collect()
}

fn section(thickness: f64, offset: f64) -> Section<'static> {
    Section {
        thickness,
        at_nodes: None,
        offset,
    }
}

fn try_with(mesh: &Mesh, section: Section<'_>) -> Result<Expansion, ExpansionError> {
    let given = BTreeMap::new();
    let angle = Joining::ANGLE;
    let joining = Joining {
        angle,
        given: &given,
    };
    expand(mesh, &all(mesh), &[section], &joining)
}

/// The expansion of all faces.
fn with(mesh: &Mesh, section: Section<'_>) -> Expansion {
    let expansion = try_with(mesh, section).unwrap();
    assert_is_consistent(mesh, &expansion);
    expansion
}

/// What holds for every expansion.
fn assert_is_consistent(given: &Mesh, expansion: &Expansion) {
    let mesh = &expansion.mesh;
    assert_eq!(mesh.points[..given.nnode()], given.points[..]);
    assert_eq!(mesh.node_labels[..given.nnode()], given.node_labels[..]);
    assert_eq!(mesh.points.len(), mesh.node_labels.len());
    assert!(mesh.node_labels[given.nnode()..].is_sorted_by(|a, b| a < b));
    let last = given.node_labels.iter().max();
    assert!(mesh.node_labels.get(given.nnode()) > last);
    let at = |node: NodeId| mesh.points[node as usize];
    for d in &expansion.directors {
        let across = at(d.positive) - at(d.negative);
        assert!((across - d.normal * d.thickness).norm() < 1e-12);
        assert!((d.normal.norm() - 1.0).abs() < 1e-14);
        assert_eq!((at(d.middle), at(d.half)), (at(d.node), at(d.node)));
        let is_knot = expansion.directors_at(d.node).len() > 1;
        assert_eq!(d.middle == d.node, !is_knot);
    }
    assert!(expansion.directors.is_sorted_by_key(|d| d.node));
    for knot in &expansion.knots {
        let here = expansion.directors_at(knot.node);
        assert_eq!(here, &expansion.directors[knot.directors.clone()]);
    }
    let solids = expansion.solids.iter().flatten();
    for (&cell, corners) in solids.clone().zip(&expansion.corners) {
        let pairs = corners.map(|d| &expansion.directors[d as usize]);
        let nodes = [pairs.map(|d| d.negative), pairs.map(|d| d.positive)];
        assert_eq!(mesh.cell(cell), nodes.concat());
        assert!(volume(mesh, cell) > 0.0);
    }
    if expansion.knots.is_empty() {
        // divisions match: all other sides are shared
        let solids: Vec<CellId> = solids.copied().collect();
        let free: usize = (0..expansion.solids.len())
            .map(|s| expansion.free_edges(s).len())
            .sum();
        assert_eq!(
            boundary(mesh, solids.iter().copied()).len(),
            2 * solids.len() + free
        );
    }
}

/// The volume of a solid.
fn volume(mesh: &Mesh, cell: CellId) -> f64 {
    let element = mesh.element(cell).unwrap();
    let mut slopes = [Vec3::ZERO; MAX_NODES];
    let rule = element.full_rule();
    rule.iter()
        .map(|(xi, weight)| {
            element.dshape(xi, &mut slopes[..element.nnode()]);
            let mut jacobian = Mat3::ZERO;
            for (&node, slope) in mesh.cell(cell).iter().zip(slopes) {
                let x = mesh.points[node as usize];
                for a in 0..3 {
                    jacobian.rows[a] += x * slope[a];
                }
            }
            jacobian.determinant() * weight
        })
        .sum()
}

/// The volume of all solids.
fn total(expansion: &Expansion) -> f64 {
    let solids = expansion.solids.iter().flatten();
    solids.map(|&cell| volume(&expansion.mesh, cell)).sum()
}

fn is_close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}
