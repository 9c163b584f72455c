//! Where a fluid may go between the sides: from point to point of the secondary side.
//!
//! Two points of a facet are neighbours unless a third lies between them, so that nothing jumps over a row of points that is
//! closed. Facets meet at their nodes, where the points of each that are nearest are neighbours. Places are those in the parameters
//! of facets: they do not change as bodies deform.

use crate::contact::discretization::{Discretization, SurfacePair};
use signorini_geometry::element::{Element, Family};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeMap;

/// A third point lies between two others if the way by it is at most this much longer.
const BETWEEN: f64 = 1.2;

/// The cosine of the angle by which the rim turns where another side of it begins: 60 degrees.
const CORNER: f64 = 0.5;

/// The rows of a contact as a graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Passages {
    /// Neighbours, row after row, and where those of each end.
    others: Vec<u32>,
    ends: Vec<usize>,
    /// The rows at each side of the rim: from corner to corner, or all round.
    pub rims: Vec<Vec<u32>>,
    /// The rows at each node of the secondary side.
    at_nodes: BTreeMap<NodeId, Vec<u32>>,
}

impl Passages {
    /// The graph of these rows; `x` are positions at the start.
    pub fn new(rows: &dyn Discretization, pair: &SurfacePair, x: &[Vec3]) -> Self {
        let Some(facets) = &pair.secondary else {
            return Self::default();
        };
        let on_facets = on_facets(rows, facets);
        let mut links: Vec<[u32; 2]> = Vec::new();
        let mut at_nodes: BTreeMap<NodeId, Vec<u32>> = BTreeMap::new();
        for (facet, points) in on_facets.iter().enumerate() {
            link_inside(points, &mut links);
            let Some(element) = facets.element(facet as u32) else {
                continue;
            };
            let nodes = facets.nodes(facet as u32).iter().zip(element.nodes());
            for (&node, place) in nodes {
                let away = |(_, at): &&(u32, Vec3)| (*at - flat(element, *place)).norm_squared();
                let nearest = points.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
                if let Some(&(row, _)) = nearest {
                    at_nodes.entry(node).or_default().push(row);
                }
            }
        }
        let is_inside = rows.capabilities().inside.is_some();
        for (&node, meeting) in &mut at_nodes {
            if !is_inside {
                // rows are nodes: each stands for itself
                meeting.retain(|&row| rows.point(row as usize).nodes.contains(&node));
            }
            meeting.sort_unstable();
            meeting.dedup();
            for (k, &a) in meeting.iter().enumerate() {
                links.extend(meeting[..k].iter().map(|&b| [a, b]));
            }
        }
        let rims = rims(facets, x).into_iter().map(|nodes| {
            let rows = nodes.iter().filter_map(|node| at_nodes.get(node)).flatten();
            rows.copied().collect()
        });
        let rims = rims.collect();
        let (others, ends) = compressed(links, rows.nrow());
        Self {
            others,
            ends,
            rims,
            at_nodes,
        }
    }

    /// The rows at a node of the secondary side.
    pub fn at_node(&self, node: NodeId) -> &[u32] {
        self.at_nodes.get(&node).map_or(&[], Vec::as_slice)
    }

    /// The neighbours of a row.
    pub fn around(&self, row: usize) -> &[u32] {
        let first = match row {
            0 => Some(0),
            _ => self.ends.get(row - 1).copied(),
        };
        let range = first.zip(self.ends.get(row).copied());
        range.map_or(&[], |(a, b)| self.others.get(a..b).unwrap_or_default())
    }

    /// Goes on from all rows that are wet to those that let it in, as far as it goes; how many are new.
    pub fn flood(&self, wet: &mut [bool], lets_in: impl Fn(usize) -> bool) -> usize {
        let mut front: Vec<usize> = (0..wet.len()).filter(|row| wet[*row]).collect();
        let mut new = 0;
        while let Some(row) = front.pop() {
            for &other in self.around(row) {
                let other = other as usize;
                if wet.get(other) == Some(&false) && lets_in(other) {
                    wet[other] = true;
                    new += 1;
                    front.push(other);
                }
            }
        }
        new
    }
}

/// The rows on each facet, with their places in it.
fn on_facets(rows: &dyn Discretization, facets: &Facets) -> Vec<Vec<(u32, Vec3)>> {
    let mut found = vec![Vec::new(); facets.nfacet()];
    if let Some(inside) = rows.capabilities().inside {
        for (row, point) in inside.iter().enumerate() {
            let element = facets.element(point.facet);
            if let (Some(on), Some(element)) = (found.get_mut(point.facet as usize), element) {
                on.push((row as u32, flat(element, point.xi)));
            }
        }
        return found;
    }
    let own = |row: usize| {
        rows.point(row)
            .nodes
            .first()
            .map(|node| (*node, row as u32))
    };
    let row_of: BTreeMap<NodeId, u32> = (0..rows.nrow()).filter_map(own).collect();
    for (facet, on) in found.iter_mut().enumerate() {
        let Some(element) = facets.element(facet as u32) else {
            continue;
        };
        let nodes = facets.nodes(facet as u32).iter().zip(element.nodes());
        let rows = nodes.filter_map(|(node, at)| Some((*row_of.get(node)?, flat(element, *at))));
        on.extend(rows);
    }
    found
}

/// A place in an element whose sides are equally long.
fn flat(element: Element, xi: Vec3) -> Vec3 {
    match element.family() {
        Family::Triangle => Vec3::new(xi.x + 0.5 * xi.y, 0.75_f64.sqrt() * xi.y, 0.0),
        _ => xi,
    }
}

/// Links the points of a facet that are neighbours.
fn link_inside(points: &[(u32, Vec3)], links: &mut Vec<[u32; 2]>) {
    for (k, &(row, at)) in points.iter().enumerate() {
        for &(other, to) in &points[..k] {
            let far = BETWEEN * (to - at).norm();
            let is_between = |&&(third, by): &&(u32, Vec3)| {
                third != row && third != other && (by - at).norm() + (to - by).norm() <= far
            };
            if !points.iter().any(|point| is_between(&point)) {
                links.push([row, other]);
            }
        }
    }
}

/// Links in both directions, row after row.
fn compressed(links: Vec<[u32; 2]>, nrow: usize) -> (Vec<u32>, Vec<usize>) {
    let mut both: Vec<[u32; 2]> = links.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
    both.sort_unstable();
    both.dedup();
    let end = |row: usize| both.partition_point(|link| (link[0] as usize) <= row);
    let ends = (0..nrow).map(end).collect();
    (both.iter().map(|link| link[1]).collect(), ends)
}

/// The corner nodes at each side of the rim of a surface.
fn rims(facets: &Facets, x: &[Vec3]) -> Vec<Vec<NodeId>> {
    let is_curve = facets.ntan() == 1;
    let mut count: BTreeMap<[NodeId; 2], u32> = BTreeMap::new();
    for facet in 0..facets.nfacet() as u32 {
        let nodes = facets.nodes(facet);
        let node = |k: usize| nodes.get(k).copied().unwrap_or_default();
        let Some(element) = facets.element(facet) else {
            continue;
        };
        if is_curve {
            let ends = nodes.iter().take(element.ncorner());
            ends.for_each(|&n| *count.entry([n, n]).or_default() += 1);
            continue;
        }
        for &[a, b] in element.edges() {
            let (a, b) = (node(a), node(b));
            *count.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let edges = count.into_iter().filter(|(_, n)| *n == 1);
    let edges: Vec<[NodeId; 2]> = edges.map(|(edge, _)| edge).collect();
    if is_curve {
        return edges.iter().map(|&[node, _]| vec![node]).collect();
    }
    sides(&edges, x)
}

/// Edges of a rim that go on from one another without a corner, as their nodes.
fn sides(edges: &[[NodeId; 2]], x: &[Vec3]) -> Vec<Vec<NodeId>> {
    let mut at: BTreeMap<NodeId, Vec<usize>> = BTreeMap::new();
    for (k, edge) in edges.iter().enumerate() {
        edge.iter().for_each(|&n| at.entry(n).or_default().push(k));
    }
    let place = |n: NodeId| x.get(n as usize).copied().unwrap_or_default();
    // the number of the side of each edge: the smallest of its edges
    let mut side: Vec<usize> = (0..edges.len()).collect();
    for (&node, meeting) in &at {
        let &[a, b] = meeting.as_slice() else {
            continue;
        };
        let away = |k: usize| {
            let [p, q] = edges[k];
            let far = if p == node { q } else { p };
            (place(far) - place(node)).normalized().unwrap_or_default()
        };
        if -away(a).dot(away(b)) >= CORNER {
            let (from, to) = (side[a].max(side[b]), side[a].min(side[b]));
            side.iter_mut()
                .filter(|s| **s == from)
                .for_each(|s| *s = to);
        }
    }
    let mut found: BTreeMap<usize, Vec<NodeId>> = BTreeMap::new();
    for (edge, side) in edges.iter().zip(side) {
        found.entry(side).or_default().extend(edge);
    }
    let mut found: Vec<Vec<NodeId>> = found.into_values().collect();
    for nodes in &mut found {
        nodes.sort_unstable();
        nodes.dedup();
    }
    found
}
