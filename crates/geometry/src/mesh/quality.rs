//! How good the cells of a mesh are, and how they hang together.
//!
//! | measure | of a cell | range |
//! |---|---|---|
//! | Jacobian | least and greatest determinant of `∂x/∂ξ` in the quadrature points and the nodes, over `size^dim` | > 0 |
//! | scaled Jacobian | least determinant of the unit vectors along the edges of a corner, over that of the ideal cell | -1 to 1 |
//! | edge ratio | shortest over longest edge, straight from corner to corner | 0 to 1 |
//!
//! Ideal cells have edges of one length: the cube, the square, the equilateral triangle and tetrahedron, and the wedge
//! on that triangle; both ratios are 1 for them. For hexahedra the middle counts as a corner, with its axes as edges.
//! The sign is that of the volume; in the plane of the area seen from +z; a face in space has none but where it folds.
//!
//! Source: C. J. Stimpson et al., *The Verdict Geometric Quality Library*, SAND2007-1751, scaled Jacobian of sections
//! 4.18, 5.17, 6.13, 7.14, 8.8; the edge ratio there is the inverse of this one.

use super::{CellId, Mesh, NodeId};
use crate::element::{Element, Family};
use crate::tensor::Vec3;
use std::collections::HashMap;

/// How many of the worst cells are named.
const WORST: usize = 10;

/// How many classes a histogram has, between 0 and 1.
pub const NCLASS: usize = 10;

/// The measures of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellQuality {
    /// The cell.
    pub cell: CellId,
    /// The least Jacobian, relative to the size of the cell.
    pub jacobian_min: f64,
    /// The scaled Jacobian.
    pub scaled_jacobian: f64,
    /// The shortest edge over the longest.
    pub edge_ratio: f64,
}

/// How a measure is distributed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    /// The least value.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The greatest value.
    pub max: f64,
    /// How many cells there are in each tenth from 0 to 1; negative values count in the first.
    pub classes: [usize; NCLASS],
}

impl Distribution {
    fn of(values: impl ExactSizeIterator<Item = f64>) -> Self {
        let count = values.len().max(1) as f64;
        let mut this = Self {
            min: f64::INFINITY,
            mean: 0.0,
            max: f64::NEG_INFINITY,
            classes: [0; NCLASS],
        };
        for value in values {
            this.min = this.min.min(value);
            this.max = this.max.max(value);
            this.mean += value / count;
            let class = (value * NCLASS as f64).clamp(0.0, NCLASS as f64 - 1.0) as usize;
            this.classes[class] += 1;
        }
        this
    }
}

/// The measures of many cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// All cells, in the order given.
    pub cells: Vec<CellQuality>,
    /// How many have a Jacobian that is zero or negative somewhere.
    pub nbad: usize,
    /// The scaled Jacobian.
    pub scaled_jacobian: Distribution,
    /// The edge ratio.
    pub edge_ratio: Distribution,
    /// The ten cells of least scaled Jacobian, worst first.
    pub worst: Vec<CellQuality>,
}

/// The quality of these cells; nothing for no cells.
///
/// # Example
/// ```
/// use signorini_geometry::element::by_name;
/// use signorini_geometry::mesh::Mesh;
/// use signorini_geometry::mesh::quality::quality;
/// use signorini_geometry::tensor::Vec3;
///
/// let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mut mesh = Mesh {
///     points: square.map(Vec3::from).to_vec(),
///     node_labels: vec![1, 2, 3, 4],
///     ..Mesh::default()
/// };
/// mesh.push_cell(by_name("quad4").ok_or("not in the table")?, &[0, 3, 2, 1], 1);
/// // it runs clockwise: its area is negative
/// let found = quality(&mesh, mesh.cells(2)).ok_or("no cells")?;
/// assert_eq!(found.nbad, 1);
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn quality(mesh: &Mesh, cells: impl IntoIterator<Item = CellId>) -> Option<Quality> {
    let mut measures = Measures::of(mesh);
    let all: Vec<CellQuality> = (cells.into_iter())
        .filter_map(|cell| measures.measure(mesh, cell))
        .collect();
    if all.is_empty() {
        return None;
    }
    let scaled_jacobian = Distribution::of(all.iter().map(|q| q.scaled_jacobian));
    let edge_ratio = Distribution::of(all.iter().map(|q| q.edge_ratio));
    let nbad = all.iter().filter(|q| q.jacobian_min <= 0.0).count();
    let worse = |a: &CellQuality, b: &CellQuality| {
        let first = a.scaled_jacobian.total_cmp(&b.scaled_jacobian);
        first.then(a.cell.cmp(&b.cell))
    };
    let mut worst = all.clone();
    if worst.len() > WORST {
        worst.select_nth_unstable_by(WORST, worse);
        worst.truncate(WORST);
    }
    worst.sort_unstable_by(worse);
    Some(Quality {
        cells: all,
        nbad,
        scaled_jacobian,
        edge_ratio,
        worst,
    })
}

/// Samples the Jacobian of cells of one element.
pub struct Jacobian {
    dshapes: Vec<Vec<Vec3>>,
    dim: usize,
    is_plane: bool,
}

impl Jacobian {
    /// Prepares the quadrature points and the nodes of an element. In a plane mesh, of one z, areas have a sign.
    #[must_use]
    pub fn new(element: Element, is_plane: bool) -> Self {
        let points = element.nodes().iter().chain(element.full_rule().points);
        let dshapes = points.map(|xi| {
            let mut dshape = vec![Vec3::ZERO; element.nnode()];
            element.dshape(xi, &mut dshape);
            dshape
        });
        Self {
            dshapes: dshapes.collect(),
            dim: element.dim(),
            is_plane,
        }
    }

    /// The least and the greatest Jacobian of the cell with its nodes at `x`, whose size is about 1.
    #[must_use]
    pub fn range(&self, x: &[Vec3]) -> (f64, f64) {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for dshape in &self.dshapes {
            let [t1, t2, t3] = tangents(dshape, x);
            let j = match self.dim {
                3 => t1.dot(t2.cross(t3)),
                2 if self.is_plane => t1.cross(t2).z,
                2 => t1.cross(t2).norm(),
                _ => t1.norm(),
            };
            least = least.min(j);
            most = most.max(j);
        }
        (least, most)
    }
}

fn tangents(dshape: &[Vec3], x: &[Vec3]) -> [Vec3; 3] {
    let mut t = [Vec3::ZERO; 3];
    for (dn, &x) in dshape.iter().zip(x) {
        t[0] += x * dn.x;
        t[1] += x * dn.y;
        t[2] += x * dn.z;
    }
    t
}

/// Whether all nodes have one z, so that areas have a sign.
#[must_use]
pub fn is_plane(mesh: &Mesh) -> bool {
    let z = mesh.points.first().map_or(0.0, |x| x.z);
    mesh.points.iter().all(|x| x.z == z)
}

/// Moves the nodes of a cell to the first of them and divides by the largest distance along an axis from it, which is
/// returned; where that is 0 nothing is divided.
pub fn normalize(x: &mut [Vec3]) -> f64 {
    let origin = x.first().copied().unwrap_or(Vec3::ZERO);
    let size = (x.iter()).fold(0.0_f64, |h, &x| h.max((x - origin).max_abs()));
    let over = if size > 0.0 { size } else { 1.0 };
    x.iter_mut().for_each(|x| *x = (*x - origin) / over);
    size
}

/// The corners of an element as the scaled Jacobian sees them.
struct Corners {
    jacobian: Jacobian,
    /// Each corner with its two or three neighbours, in an order that makes the ideal determinant positive.
    corners: Vec<(usize, [usize; 3])>,
    edges: Vec<[usize; 2]>,
    /// Derivatives of the shape functions in the middle.
    middle: Vec<Vec3>,
    /// One over the determinant of the ideal corner.
    factor: f64,
    /// Whether the axes in the middle count as a corner.
    has_axes: bool,
    /// Whether all corners have one volume: then the corner of the longest edges counts, whatever the sign.
    is_simplex: bool,
    dim: usize,
}

impl Corners {
    fn new(element: Element, is_plane: bool) -> Self {
        let dim = element.dim();
        let nodes = element.nodes();
        let edges = element.edges().to_vec();
        let corner = |c: usize| {
            let mut near = edges.iter().filter_map(|&[a, b]| match c {
                _ if a == c => Some(b),
                _ if b == c => Some(a),
                _ => None,
            });
            let mut near = [near.next()?, near.next()?, near.next().unwrap_or(c)];
            let edge = |i: usize| nodes[near[i]] - nodes[c];
            let ideal = match dim {
                3 => edge(0).dot(edge(1).cross(edge(2))),
                _ => edge(0).cross(edge(1)).z,
            };
            if ideal < 0.0 {
                near.swap(0, 1);
            }
            Some((c, near))
        };
        let mut middle = vec![Vec3::ZERO; element.nnode()];
        element.dshape(&element.centre(), &mut middle);
        let factor = match element.family() {
            Family::Tetrahedron => 2.0_f64.sqrt(),
            Family::Wedge | Family::Triangle => 2.0 / 3.0_f64.sqrt(),
            Family::Line | Family::Quadrilateral | Family::Hexahedron => 1.0,
        };
        let ncorner = element.ncorner();
        let corners = if dim > 1 {
            (0..ncorner).filter_map(corner).collect()
        } else {
            Vec::new()
        };
        Self {
            jacobian: Jacobian::new(element, is_plane),
            corners,
            edges,
            middle,
            factor,
            has_axes: element.family() == Family::Hexahedron,
            is_simplex: ncorner == dim + 1,
            dim,
        }
    }

    /// The scaled Jacobian and the edge ratio of the cell with its nodes at `x`.
    fn measure(&self, x: &[Vec3], is_plane: bool) -> (f64, f64) {
        let at = |i: usize| x.get(i).copied().unwrap_or(Vec3::ZERO);
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
        for &[a, b] in &self.edges {
            let length = (at(b) - at(a)).norm();
            shortest = shortest.min(length);
            longest = longest.max(length);
        }
        let edge_ratio = if longest > 0.0 {
            shortest / longest
        } else {
            0.0
        };
        if self.dim < 2 {
            let scaled = if longest > 0.0 { 1.0 } else { 0.0 };
            return (scaled, edge_ratio);
        }
        let [t1, t2, t3] = tangents(&self.middle, x);
        let up = match is_plane {
            true => Vec3::unit(2),
            false => t1.cross(t2).normalized().unwrap_or(Vec3::ZERO),
        };
        let unit = |v: Vec3| v.normalized().unwrap_or(Vec3::ZERO);
        let determinant = |a: Vec3, b: Vec3, c: Vec3| match self.dim {
            3 => unit(a).dot(unit(b).cross(unit(c))),
            _ => unit(a).cross(unit(b)).dot(up),
        };
        let mut least = f64::INFINITY;
        for &(c, [i, j, k]) in &self.corners {
            let at_corner = determinant(at(i) - at(c), at(j) - at(c), at(k) - at(c));
            let is_less = match self.is_simplex {
                true => at_corner.abs() < least.abs(),
                false => at_corner < least,
            };
            if is_less {
                least = at_corner;
            }
        }
        if self.has_axes {
            least = least.min(determinant(t1, t2, t3));
        }
        ((least * self.factor).clamp(-1.0, 1.0), edge_ratio)
    }
}

/// What is prepared for every block of a mesh.
struct Measures {
    of_blocks: Vec<Corners>,
    is_plane: bool,
    x: Vec<Vec3>,
}

impl Measures {
    fn of(mesh: &Mesh) -> Self {
        let is_plane = is_plane(mesh);
        let of_blocks = mesh
            .blocks
            .iter()
            .map(|b| Corners::new(b.element, is_plane));
        Self {
            of_blocks: of_blocks.collect(),
            is_plane,
            x: Vec::new(),
        }
    }

    fn measure(&mut self, mesh: &Mesh, cell: CellId) -> Option<CellQuality> {
        let corners = self.of_blocks.get(cell.block as usize)?;
        let nodes = mesh.cell(cell);
        if nodes.is_empty() {
            return None;
        }
        self.x.clear();
        self.x
            .extend(nodes.iter().filter_map(|&n| mesh.points.get(n as usize)));
        normalize(&mut self.x);
        let (scaled_jacobian, edge_ratio) = corners.measure(&self.x, self.is_plane);
        Some(CellQuality {
            cell,
            jacobian_min: corners.jacobian.range(&self.x).0,
            scaled_jacobian,
            edge_ratio,
        })
    }
}

/// Nodes at the place of an earlier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coincident {
    /// How many.
    pub count: usize,
    /// The first of them: the earlier node, and it.
    pub pair: [NodeId; 2],
}

/// Counts nodes within `tolerance` of an earlier one, of those that are `used`; nothing where there are none.
///
/// Only nodes without an earlier neighbour stay in the grid, of cells four tolerances wide; so few fit into a cell that
/// the work grows with the number of nodes, however they lie.
#[must_use]
pub fn coincident(mesh: &Mesh, used: &[bool], tolerance: f64) -> Option<Coincident> {
    compared(mesh, used, tolerance).0
}

/// [`coincident`], and the number of distances that were taken.
fn compared(mesh: &Mesh, used: &[bool], tolerance: f64) -> (Option<Coincident>, usize) {
    const NONE: u32 = u32::MAX;
    let bounds = mesh.bounds();
    let Some((min, _)) = bounds.filter(|_| tolerance > 0.0 && tolerance.is_finite()) else {
        return (None, 0);
    };
    let mut compared = 0;
    let width = 4.0 * tolerance;
    let mut grid: HashMap<[i64; 3], u32> = HashMap::new();
    let mut next = vec![NONE; mesh.nnode()];
    let (mut count, mut pair) = (0, None);
    for (node, &x) in mesh.points.iter().enumerate() {
        if !used.get(node).copied().unwrap_or(false) {
            continue;
        }
        let from = (x - min) / width;
        let home = [from.x, from.y, from.z].map(|f| f.floor() as i64);
        let low = [from.x, from.y, from.z].map(|f| (f - 0.25).floor() as i64);
        let high = [from.x, from.y, from.z].map(|f| (f + 0.25).floor() as i64);
        let near = (low[0]..=high[0]).flat_map(|i| {
            (low[1]..=high[1]).flat_map(move |j| (low[2]..=high[2]).map(move |k| [i, j, k]))
        });
        let earlier = near.into_iter().find_map(|cell| {
            let mut at = grid.get(&cell).copied().unwrap_or(NONE);
            while let Some(&y) = mesh.points.get(at as usize) {
                compared += 1;
                if ((x - y) / tolerance).norm() <= 1.0 {
                    return Some(at);
                }
                at = next.get(at as usize).copied().unwrap_or(NONE);
            }
            None
        });
        match earlier {
            Some(earlier) => {
                count += 1;
                pair = pair.or(Some([earlier, node as NodeId]));
            }
            None => {
                let head = grid.insert(home, node as u32).unwrap_or(NONE);
                if let Some(next) = next.get_mut(node) {
                    *next = head;
                }
            }
        }
    }
    (pair.map(|pair| Coincident { count, pair }), compared)
}

/// The cells in groups that share no node, each sorted, the groups by their first cell.
#[must_use]
pub fn parts(mesh: &Mesh, cells: &[CellId]) -> Vec<Vec<CellId>> {
    let mut parent: Vec<NodeId> = (0..mesh.nnode() as NodeId).collect();
    let root = |parent: &mut [NodeId], mut node: NodeId| {
        // every step halves the path
        while let Some(&up) = parent.get(node as usize) {
            if up == node {
                break;
            }
            let next = parent.get(up as usize).copied().unwrap_or(up);
            if let Some(entry) = parent.get_mut(node as usize) {
                *entry = next;
            }
            node = next;
        }
        node
    };
    for &cell in cells {
        if let [first, others @ ..] = mesh.cell(cell) {
            for &other in others {
                let (a, b) = (root(&mut parent, *first), root(&mut parent, other));
                if let Some(entry) = parent.get_mut(a.max(b) as usize) {
                    *entry = a.min(b);
                }
            }
        }
    }
    let mut sorted = cells.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    let mut number: HashMap<NodeId, usize> = HashMap::new();
    let mut parts: Vec<Vec<CellId>> = Vec::new();
    for cell in sorted {
        let Some(&first) = mesh.cell(cell).first() else {
            continue;
        };
        let next = parts.len();
        let part = *number.entry(root(&mut parent, first)).or_insert(next);
        match parts.get_mut(part) {
            Some(part) => part.push(cell),
            None => parts.push(vec![cell]),
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::by_name;
    use crate::mesh::testing::bricks;

    fn single(name: &str, x: &[[f64; 3]]) -> CellQuality {
        let mut mesh = Mesh {
            points: x.iter().map(|&x| Vec3::from(x)).collect(),
            node_labels: (1..=x.len() as u64).collect(),
            ..Mesh::default()
        };
        let nodes: Vec<NodeId> = (0..x.len() as NodeId).collect();
        mesh.push_cell(by_name(name).unwrap(), &nodes, 1);
        let dim = mesh.dim();
        quality(&mesh, mesh.cells(dim)).unwrap().worst[0]
    }

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-14
    }

    #[test]
    fn ideal_cells_of_any_size_and_place_have_ratios_of_one() {
        let h = 3.0_f64.sqrt() / 2.0;
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, h, 0.0]];
        let square = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        let up = |x: &[[f64; 3]]| x.iter().map(|x| [x[0], x[1], 1.0]).collect::<Vec<_>>();
        let apex = [[0.5, h / 3.0, (2.0_f64 / 3.0).sqrt()]];
        for (name, x) in [
            ("tri3", triangle.to_vec()),
            ("quad4", square.to_vec()),
            ("tet4", [&triangle[..], &apex].concat()),
            ("wedge6", [&triangle[..], &up(&triangle)].concat()),
            ("hex8", [&square[..], &up(&square)].concat()),
        ] {
            for (size, shift) in [(1.0, 0.0), (1e-9, 1e-9), (1e6, -1e6)] {
                let x: Vec<[f64; 3]> = x.iter().map(|x| x.map(|x| size * x + shift)).collect();
                let found = single(name, &x);
                assert!(
                    (found.scaled_jacobian - 1.0).abs() < 1e-12,
                    "{name} {found:?}"
                );
                assert!((found.edge_ratio - 1.0).abs() < 1e-12, "{name} {found:?}");
                assert!(found.jacobian_min > 0.0);
            }
        }
    }

    #[test]
    fn known_distortions_have_their_known_measures() {
        // right-angled corner: det of unit vectors 1/2 at the two far corners of the slope, times √2
        let corner = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let found = single("tet4", &corner);
        assert!(
            near(found.scaled_jacobian, 2.0_f64.sqrt() / 2.0),
            "{found:?}"
        );
        assert!(near(found.edge_ratio, 1.0 / 2.0_f64.sqrt()));
        // a rhombus with an angle of 30 degrees, and a rectangle 1 : 4
        let (c, s) = (3.0_f64.sqrt() / 2.0, 0.5);
        let rhombus = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0 + c, s, 0.0],
            [c, s, 0.0],
        ];
        assert!(near(single("quad4", &rhombus).scaled_jacobian, 0.5));
        let rectangle = [[0.0; 3], [4.0, 0.0, 0.0], [4.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let found = single("quad4", &rectangle);
        assert!(near(found.scaled_jacobian, 1.0) && near(found.edge_ratio, 0.25));
        // turned over, and turned over in space, where it has no sign
        let over = [rectangle[0], rectangle[3], rectangle[2], rectangle[1]];
        assert!(near(single("quad4", &over).scaled_jacobian, -1.0));
        assert!(single("quad4", &over).jacobian_min < 0.0);
        let upright = over.map(|[x, y, _]| [x, 0.0, y]);
        assert!(near(single("quad4", &upright).scaled_jacobian, 1.0));
        // an arrow: one corner is folded
        let arrow = [[0.0; 3], [1.0, 0.0, 0.0], [0.2, 0.2, 0.0], [0.0, 1.0, 0.0]];
        let found = single("quad4", &arrow);
        assert!(
            found.scaled_jacobian < 0.0 && found.jacobian_min < 0.0,
            "{found:?}"
        );
        let mirrored = corner.map(|[x, y, z]| [x, y, -z]);
        assert!(near(
            single("tet4", &mirrored).scaled_jacobian,
            -(2.0_f64.sqrt()) / 2.0
        ));
        assert_eq!(single("tet4", &[[1.0; 3]; 4]).edge_ratio, 0.0);
    }

    #[test]
    fn a_summary_names_the_worst_and_counts_all() {
        let mut mesh = bricks([10, 10, 10], 1.0);
        mesh.points[0] += Vec3::new(0.4, 0.3, 0.2);
        let all = quality(&mesh, mesh.cells(3)).unwrap();
        assert_eq!(
            (all.cells.len(), all.nbad, all.worst.len()),
            (1000, 0, WORST)
        );
        assert_eq!(all.worst[0].cell, CellId { block: 0, index: 0 });
        assert!(all.worst.is_sorted_by_key(|q| q.scaled_jacobian));
        assert_eq!(all.scaled_jacobian.min, all.worst[0].scaled_jacobian);
        assert_eq!(all.scaled_jacobian.classes.iter().sum::<usize>(), 1000);
        assert_eq!(all.edge_ratio.classes[9], 999);
        assert!(near(all.scaled_jacobian.max, 1.0));
        mesh.points[0] = Vec3::new(2.0, 2.0, 2.0);
        assert_eq!(quality(&mesh, mesh.cells(3)).unwrap().nbad, 1);
        assert_eq!(quality(&mesh, []), None);
    }

    #[test]
    fn no_cell_takes_memory_of_its_own() {
        let judged = |size: [u32; 3]| {
            let mesh = bricks(size, 1.0);
            let mut all = None;
            let taken = allocation_counter::measure(|| all = quality(&mesh, mesh.cells(3)));
            let all = all.unwrap();
            let ncell: u32 = size.iter().product();
            assert_eq!((all.cells.len(), all.nbad), (ncell as usize, 0));
            taken
        };
        let [few, many] = [[10, 10, 10], [50, 50, 40]].map(judged);
        // a list that doubles when it is full: log2(100) more allocations, twice its length in bytes
        assert!(many.count_total <= few.count_total + 8, "{few:?}, {many:?}");
        assert!(
            many.bytes_total <= 130 * few.bytes_total,
            "{few:?}, {many:?}"
        );
    }

    #[test]
    fn nodes_are_compared_with_their_neighbours_only_even_where_one_is_far_away() {
        // the tolerance of a mesh of this size, within which most nodes have an earlier neighbour
        let tolerance = 1e5;
        let line = |n: u32| {
            let points = (0..n).map(|i| Vec3::new(f64::from(i), 0.5, 0.5));
            let points: Vec<Vec3> = points.chain([Vec3::new(1e14, 0.0, 0.0)]).collect();
            let mesh = Mesh {
                node_labels: (1..=points.len() as u64).collect(),
                points,
                ..Mesh::default()
            };
            compared(&mesh, &vec![true; mesh.nnode()], tolerance)
        };
        for n in [20_000, 200_000] {
            let (found, compared) = line(n);
            assert!(found.is_some());
            assert!(compared <= 8 * n as usize, "{compared} for {n}");
        }
    }

    #[test]
    fn nodes_in_one_place_are_counted() {
        let mut mesh = bricks([2, 2, 2], 1.0);
        let used = vec![true; mesh.nnode() + 2];
        assert_eq!(coincident(&mesh, &used, 1e-9), None);
        for i in [5, 7] {
            mesh.points
                .push(mesh.points[i] + Vec3::new(0.0, 1e-10, 0.0));
        }
        let found = coincident(&mesh, &used, 1e-9).unwrap();
        assert_eq!((found.count, found.pair), (2, [5, 27]));
        assert_eq!(coincident(&mesh, &used[..27], 1e-9), None);
    }
}
