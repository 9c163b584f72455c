//! Structured meshes of every solid element.

#![allow(dead_code, clippy::unwrap_used)]

use signorini_geometry::element::{Element, by_name};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId, boundary};
use signorini_geometry::tensor::{Mat3, Vec3};
use signorini_mechanics::material::Material;
use signorini_mechanics::model::{BodyKind, BodyPart};
use signorini_mechanics::solid::{Integration, Locking};
use signorini_mechanics::system::Idealisation;
use std::collections::HashMap;

/// Gauss–Legendre with five points on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// The cell that an element fills.
#[derive(Clone, Copy, PartialEq)]
pub enum Shape {
    Triangle,
    Quadrilateral,
    Tetrahedron,
    Wedge,
    Hexahedron,
}

pub fn shape(name: &str) -> Shape {
    match name.trim_end_matches(char::is_numeric) {
        "tri" => Shape::Triangle,
        "quad" => Shape::Quadrilateral,
        "tet" => Shape::Tetrahedron,
        "wedge" => Shape::Wedge,
        _ => Shape::Hexahedron,
    }
}

pub fn degree(name: &str) -> f64 {
    match name {
        "tri3" | "quad4" | "tet4" | "wedge6" | "hex8" => 1.0,
        _ => 2.0,
    }
}

impl Shape {
    /// The element whose map places the nodes of all elements of the shape.
    pub fn linear(self) -> Element {
        by_name(match self {
            Self::Triangle => "tri3",
            Self::Quadrilateral => "quad4",
            Self::Tetrahedron => "tet4",
            Self::Wedge => "wedge6",
            Self::Hexahedron => "hex8",
        })
        .unwrap()
    }

    /// Corners of a cube (in the plane: of its bottom) that make up the cells it is cut into.
    pub fn cells(self) -> Vec<Vec<usize>> {
        match self {
            Self::Triangle => vec![vec![0, 1, 2], vec![0, 2, 3]],
            Self::Quadrilateral => vec![vec![0, 1, 2, 3]],
            Self::Hexahedron => vec![(0..8).collect()],
            Self::Wedge => vec![vec![0, 1, 2, 4, 5, 6], vec![0, 2, 3, 4, 6, 7]],
            Self::Tetrahedron => [
                [0, 1, 2, 6],
                [0, 2, 3, 6],
                [0, 3, 7, 6],
                [0, 7, 4, 6],
                [0, 4, 5, 6],
                [0, 5, 1, 6],
            ]
            .map(Vec::from)
            .into(),
        }
    }

    /// Points and weights that integrate far beyond the element's own rule.
    pub fn rule(self) -> Vec<(Vec3, f64)> {
        let mut rule = Vec::new();
        for (x, wx) in GAUSS {
            for (y, wy) in GAUSS {
                if self == Self::Quadrilateral {
                    rule.push((Vec3::new(x, y, 0.0), wx * wy));
                    continue;
                }
                // a square, one side of which shrinks to a point
                let (s, t) = (0.5 * (1.0 + x), 0.5 * (1.0 + y));
                let flat = Vec3::new(s, t * (1.0 - s), 0.0);
                let weight = 0.25 * wx * wy * (1.0 - s);
                if self == Self::Triangle {
                    rule.push((flat, weight));
                    continue;
                }
                for (z, wz) in GAUSS {
                    let r = 0.5 * (1.0 + z);
                    rule.push(match self {
                        Self::Wedge => (flat + Vec3::unit(2) * z, weight * wz),
                        Self::Tetrahedron => (
                            flat * (1.0 - r) + Vec3::unit(2) * r,
                            weight * 0.5 * wz * (1.0 - r).powi(2),
                        ),
                        _ => (Vec3::new(x, y, z), wx * wy * wz),
                    });
                }
            }
        }
        rule
    }
}

const CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];

/// A mesh, its cells, and where its nodes are in the unit square or cube that it was made from.
pub struct Grid {
    pub mesh: Mesh,
    pub cells: Vec<CellId>,
    pub places: Vec<Vec3>,
}

impl Grid {
    /// `n` cells along x and y, `layers` along z (in space), of this element; the unit square or cube is deformed by
    /// `map`.
    pub fn new(name: &str, n: usize, layers: usize, map: impl Fn(Vec3) -> Vec3) -> Self {
        Self::of(name, [n, n, layers], map)
    }

    /// As many boxes along each axis (in the plane: the first two), each cut into cells of this element, row by row.
    pub fn of(name: &str, count: [usize; 3], map: impl Fn(Vec3) -> Vec3) -> Self {
        let (element, shape) = (by_name(name).unwrap(), shape(name));
        let linear = shape.linear();
        let [nx, ny, nz] = count;
        let nz = if element.dim() == 3 { nz } else { 1 };
        let size = [nx, ny, nz].map(|n| n as f64);
        let mut grid = Self {
            mesh: Mesh::default(),
            cells: Vec::new(),
            places: Vec::new(),
        };
        let mut known: HashMap<[i64; 3], NodeId> = HashMap::new();
        let mut weights = vec![0.0; linear.nnode()];
        for place in 0..nx * ny * nz {
            let at = [place % nx, place / nx % ny, place / (nx * ny)].map(|c| c as f64);
            for corners in shape.cells() {
                let mut nodes = Vec::new();
                for xi in element.nodes() {
                    linear.shape(xi, &mut weights);
                    let mut x = Vec3::ZERO;
                    for (&c, w) in corners.iter().zip(&weights) {
                        x += (Vec3::from(at) + Vec3::from(CORNERS[c])) * *w;
                    }
                    let x = Vec3::new(x.x / size[0], x.y / size[1], x.z / size[2]);
                    let key = x.to_array().map(|c| (c * 1e6).round() as i64);
                    let node = *known.entry(key).or_insert_with(|| {
                        grid.places.push(x);
                        grid.mesh.points.push(map(x));
                        let node = grid.places.len() as NodeId - 1;
                        grid.mesh.node_labels.push(u64::from(node) + 1);
                        node
                    });
                    nodes.push(node);
                }
                let label = grid.cells.len() as u64 + 1;
                grid.cells.push(grid.mesh.push_cell(element, &nodes, label));
            }
        }
        grid
    }

    /// The nodes whose places satisfy a condition.
    pub fn nodes(&self, wanted: impl Fn(Vec3) -> bool) -> Vec<NodeId> {
        let places = self.places.iter().enumerate();
        places
            .filter(|(_, x)| wanted(**x))
            .map(|(n, _)| n as NodeId)
            .collect()
    }

    /// The faces on the boundary all of whose nodes satisfy a condition.
    pub fn faces(&self, wanted: impl Fn(Vec3) -> bool) -> Vec<Face> {
        let inside = |face: &Face| {
            let (_, nodes) = self.mesh.face(*face).unwrap();
            nodes.iter().all(|&n| wanted(self.places[n as usize]))
        };
        let faces = boundary(&self.mesh, self.cells.iter().copied());
        faces.into_iter().filter(inside).collect()
    }

    /// Puts it into a mesh with others; the part has the faces all of whose nodes satisfy a condition.
    pub fn join(self, mesh: &mut Mesh, wanted: impl Fn(Vec3) -> bool) -> Part {
        let first = mesh.points.len() as NodeId;
        mesh.points.extend_from_slice(&self.mesh.points);
        mesh.node_labels = (1..=mesh.points.len() as u64).collect();
        let faces = self.faces(wanted);
        let mut cells = Vec::new();
        for &cell in &self.cells {
            let nodes: Vec<NodeId> = self.mesh.cell(cell).iter().map(|n| n + first).collect();
            let element = self.mesh.element(cell).unwrap();
            cells.push(mesh.push_cell(element, &nodes, mesh.ncell() as u64 + 1));
        }
        let place = |cell: CellId| self.cells.iter().position(|&c| c == cell).unwrap();
        let faces = faces.iter().map(|f| Face {
            cell: cells[place(f.cell)],
            side: f.side,
        });
        Part {
            faces: faces.collect(),
            cells,
            places: self.places,
            first,
        }
    }
}

/// A grid in a mesh with others.
pub struct Part {
    pub cells: Vec<CellId>,
    pub places: Vec<Vec3>,
    pub first: NodeId,
    pub faces: Vec<Face>,
}

impl Part {
    /// The nodes whose places satisfy a condition.
    pub fn nodes(&self, wanted: impl Fn(Vec3) -> bool) -> Vec<NodeId> {
        let places = self.places.iter().enumerate();
        let found = places.filter(|(_, x)| wanted(**x));
        found.map(|(n, _)| self.first + n as NodeId).collect()
    }
}

/// A solid with nothing but defaults.
pub fn solid(name: &str, cells: &[CellId], material: impl Material + 'static) -> BodyPart {
    BodyPart {
        name: name.into(),
        cells: cells.to_vec(),
        kind: BodyKind::Solid {
            material: Box::new(material),
            later: Vec::new(),
            density: None,
            mass: Default::default(),
            integration: Integration::Full,
            locking: Locking::Auto,
            space: None,
            profile: None,
            linear_temperatures: false,
            at_nodes: Default::default(),
            initial: Vec::new(),
            axes: None,
            heat: None,
        },
    }
}

/// What is known of a point of a cell.
pub struct Point {
    pub weights: Vec<f64>,
    pub gradients: Vec<Vec3>,
    pub x: Vec3,
    pub volume: f64,
}

pub fn sample(mesh: &Mesh, space: Idealisation, cell: CellId, xi: &Vec3, w: f64) -> Point {
    let element = mesh.element(cell).unwrap();
    let n = element.nnode();
    let (mut weights, mut slopes) = (vec![0.0; n], vec![Vec3::ZERO; n]);
    element.shape(xi, &mut weights);
    element.dshape(xi, &mut slopes);
    let (mut x, mut jacobian) = (Vec3::ZERO, Mat3::ZERO);
    for ((&node, n), d) in mesh.cell(cell).iter().zip(&weights).zip(&slopes) {
        let at = mesh.points[node as usize];
        x += at * *n;
        for a in 0..element.dim() {
            jacobian.rows[a] += at * d[a];
        }
    }
    if element.dim() == 2 {
        jacobian.rows[2] = Vec3::unit(2);
    }
    let (inverse, det) = jacobian.inverse().unwrap();
    Point {
        weights,
        gradients: slopes.iter().map(|d| inverse * *d).collect(),
        x,
        volume: w * det * space.extent(x),
    }
}
