//! Straight facets, bent as their neighbours turn: the smooth surface that they were cut from, to a higher order.
//!
//! ```text
//!        ╭───δ───╮            true surface
//!       ╱    ▲    ╲
//!   a ●──────┴──────● b       straight facet, chord of the surface
//!    ╱               ╲
//! ```
//!
//! | symbol | name in code | shape | unit |
//! |---|---|---|---|
//! | δ(ξ) | `rise`: how far the surface lies outside the facet, along its normal | number | length |
//! | s_ab | `slopes`: change of δ along the edge from corner a to corner b, over the whole edge, at a | number | length |
//! | ν_a, ν_f | normal of the surface at corner a; of the facet at its centre | vectors | |
//! | h, κ_a | length of a line, curvature at its end | numbers | length, 1/length |
//!
//! In the plane, with the angle θ by which two lines of lengths h_1 and h_2 turn at their common node,
//!
//! ```text
//! κ_a = 2θ/(h_1 + h_2),   s_ab = κ_a h²/2                                              (E1)
//! δ(t) = s_ab t (1 − t)² + s_ba t² (1 − t)                                             (E2)
//! ```
//!
//! A node where a surface ends, or turns by more than an edge needs, takes the curvature of the other end. (E2) is exact
//! where δ is a polynomial of degree 3, and of a circle with turns θ it misses θ²/48 of itself.
//!
//! In space, with the normals ν_a of a surface fitted through the corners around (E4),
//!
//! ```text
//! s_ab = −ν_a·(x_b − x_a)/(ν_a·ν_f)                                                    (E3)
//! ```
//!
//! Edges are bent by (E2); between them, quadrilaterals are Coons patches of their four edges, and triangles have the
//! cubic polynomial with these edges whose middle coefficient makes it exact for paraboloids. The fit is
//!
//! ```text
//! z = a x + b y + ½ (c x² + 2 d x y + e y²) (x² + y² + z²)/(x² + y²)                   (E4)
//! ```
//!
//! for the neighbours (x, y, z) of a corner in a frame whose z axis is the mean normal of the facets there, least squares
//! with the weight 1/r⁴; the last factor makes it exact for spheres and for circles, whatever the frame. Where neighbours
//! do not determine it, their neighbours are added, a few times; coefficients that stay undetermined are zero.
//!
//! *Edges.* Facets that turn by more than some 30 degrees are sides of a structural edge, at which neither bends: each
//! side has normals of its own. Facets of quadratic elements are bent already, and never rise.
//!
//! Sources: Farin, *Curves and Surfaces for CAGD*, 5th ed. 2002, sections 17 and 22 (Coons patches, cubic triangles);
//! Vlachos, Peters, Boyd and Mitchell, I3D 2001 (triangles from normals).

use super::{Anchor, ContactSurface, Facets, Placement, SurfaceJet};
use crate::element::{Family, MAX_FACET_NODES};
use crate::mesh::NodeId;
use crate::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// The cosine of the largest angle by which a smooth surface turns from facet to facet: a little over 30 degrees, so that
/// a circle of twelve facets is smooth.
const SMOOTH: f64 = 0.86;

/// Corners of a straight facet, at most.
const CORNERS: usize = 4;

/// How often the neighbours of neighbours are taken in: at the corner of a surface, from a single triangle on.
const RINGS: usize = 4;

/// Unknowns of (E4).
const UNKNOWNS: usize = 5;

/// An eigenvalue of the fit, relative to the largest, below which it does not determine what belongs to it.
const UNDETERMINED: f64 = 1e-3;

/// Passes over all pairs of axes: each squares the residual.
const SWEEPS: usize = 6;

/// One less the cosine of an angle between facets that is nothing but rounding.
const ROUNDING: f64 = 1e-14;

/// The rise of a surface above its straight facets.
#[derive(Clone, Debug)]
pub struct Bent {
    facets: Facets,
    /// Of each facet, s_ab at both ends of its edges, in their order.
    slopes: Vec<[[f64; 2]; CORNERS]>,
}

impl Bent {
    /// Bends the facets of a surface with its nodes at `x`.
    #[must_use]
    pub fn new(facets: &Facets, x: &[Vec3]) -> Self {
        let shape = Shape::new(facets, x);
        let nfacet = 0..facets.nfacet() as u32;
        let slopes = match facets.ntan() {
            1 => nfacet.map(|facet| shape.of_line(facet)).collect(),
            _ => shape.of_faces(),
        };
        Self {
            facets: facets.clone(),
            slopes,
        }
    }

    /// The facets.
    #[must_use]
    pub fn facets(&self) -> &Facets {
        &self.facets
    }

    /// Whether no facet rises by more than rounding.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        let x = self.slopes.as_flattened().as_flattened();
        x.iter().all(|s| *s == 0.0)
    }

    /// δ at a point of a facet, along the outward normal.
    #[must_use]
    pub fn rise(&self, facet: u32, local: Vec3) -> f64 {
        let (Some(slopes), Some(element)) =
            (self.slopes.get(facet as usize), self.facets.element(facet))
        else {
            return 0.0;
        };
        let n = element.nnode();
        if !element.is_linear() || *slopes == [[0.0; 2]; CORNERS] {
            return 0.0;
        }
        let mut shape = [0.0; MAX_FACET_NODES];
        element.shape(&local, &mut shape[..n]);
        match element.family() {
            Family::Line => along(slopes[0], shape[1]),
            Family::Triangle => {
                of_triangle(slopes, element.edges(), [shape[0], shape[1], shape[2]])
            }
            _ => {
                let edge = |(&[a, b], slopes): (&[usize; 2], &[f64; 2])| {
                    let next = element.edges().iter().find(|e| e[0] == b);
                    let opposite = next.map_or(b, |e| e[1]);
                    (shape[a] + shape[b]) * along(*slopes, shape[b] + shape[opposite])
                };
                element.edges().iter().zip(slopes).map(edge).sum()
            }
        }
    }

    /// The largest |δ| of a facet, as far as its centre and the middles of its edges show it.
    #[must_use]
    pub fn sagitta(&self, facet: u32) -> f64 {
        let Some(element) = self.facets.element(facet) else {
            return 0.0;
        };
        let nodes = element.nodes();
        let middles = element
            .edges()
            .iter()
            .map(|&[a, b]| (nodes[a] + nodes[b]) * 0.5);
        let points = middles.chain([element.centre()]);
        let rises = points.map(|local| self.rise(facet, local).abs());
        rises.fold(0.0, f64::max)
    }
}

/// (E2).
fn along([from, to]: [f64; 2], t: f64) -> f64 {
    t * (1.0 - t) * (from * (1.0 - t) + to * t)
}

/// The cubic polynomial of a triangle in its area coordinates.
fn of_triangle(slopes: &[[f64; 2]], edges: &[[usize; 2]], l: [f64; 3]) -> f64 {
    let mut rise = 0.0;
    let mut middle = 0.0;
    for (&[a, b], [from, to]) in edges.iter().zip(slopes) {
        rise += l[a] * l[b] * (from * l[a] + to * l[b]);
        middle += from + to;
    }
    // 6 times the mean of the six coefficients s/3, and half as much again
    rise + 0.5 * middle * l[0] * l[1] * l[2]
}

/// What bending asks of a surface.
struct Shape<'a> {
    facets: &'a Facets,
    x: &'a [Vec3],
    normals: Vec<Option<Vec3>>,
    around: BTreeMap<NodeId, Vec<u32>>,
}

impl<'a> Shape<'a> {
    fn new(facets: &'a Facets, x: &'a [Vec3]) -> Self {
        let at = Placement { x, poses: &[] };
        let mut jet = SurfaceJet::default();
        let mut normal = |facet: u32| {
            let local = facets.element(facet)?.centre();
            facets.jet(&at, &Anchor { facet, local }, &mut jet).ok()?;
            Some(jet.normal)
        };
        let all = 0..facets.nfacet() as u32;
        let normals = all.clone().map(&mut normal).collect();
        let mut around: BTreeMap<NodeId, Vec<u32>> = BTreeMap::new();
        for facet in all {
            for &node in corners(facets, facet) {
                around.entry(node).or_default().push(facet);
            }
        }
        Self {
            facets,
            x,
            normals,
            around,
        }
    }

    fn at(&self, node: NodeId) -> Vec3 {
        self.x.get(node as usize).copied().unwrap_or_default()
    }

    fn normal(&self, facet: u32) -> Option<Vec3> {
        self.normals.get(facet as usize).copied().flatten()
    }

    fn is_straight(&self, facet: u32) -> bool {
        let element = self.facets.element(facet);
        element.is_some_and(|e| e.is_linear())
    }

    /// Whether a smooth surface continues from one facet to another that shares an edge with it, in the plane a node.
    fn continues(&self, one: u32, other: u32) -> bool {
        let (a, b) = (corners(self.facets, one), corners(self.facets, other));
        let shared = a.iter().filter(|n| b.contains(n)).count();
        let turn = self.normal(one).zip(self.normal(other));
        shared >= self.facets.ntan() && turn.is_some_and(|(a, b)| a.dot(b) >= SMOOTH)
    }

    /// The slopes of a line, (E1).
    fn of_line(&self, facet: u32) -> [[f64; 2]; CORNERS] {
        let mut slopes = [[0.0; 2]; CORNERS];
        let &[a, b] = corners(self.facets, facet) else {
            return slopes;
        };
        if !self.is_straight(facet) {
            return slopes;
        }
        let h = (self.at(b) - self.at(a)).norm();
        let (at_a, at_b) = (self.curvature(facet, a), self.curvature(facet, b));
        let half = 0.5 * h * h;
        slopes[0] = [at_a.or(at_b), at_b.or(at_a)].map(|k| half * k.unwrap_or(0.0));
        slopes
    }

    /// The curvature at an end of a line, positive where it bulges outward; `None` where the smooth surface ends.
    fn curvature(&self, facet: u32, node: NodeId) -> Option<f64> {
        let others = self.around.get(&node)?.iter().copied();
        let mut others = others.filter(|&f| f != facet && self.continues(facet, f));
        let (other, None) = (others.next()?, others.next()) else {
            return None;
        };
        let chord = |f: u32| match corners(self.facets, f) {
            &[a, b] => Some((b, self.at(b) - self.at(a))),
            _ => None,
        };
        let (end, own) = chord(facet)?;
        let (_, next) = chord(other)?;
        let (before, after) = if end == node {
            (own, next)
        } else {
            (next, own)
        };
        let turn = before.cross(after).z.atan2(before.dot(after));
        Some(2.0 * turn / (before.norm() + after.norm()))
    }

    /// Whether a smooth surface turns where it continues from a facet.
    fn turns(&self, facet: u32) -> bool {
        let neighbours = self.facets.neighbours(facet).iter();
        let mut smooth = neighbours.filter(|&&other| self.continues(facet, other));
        smooth.any(|&other| {
            let both = self.normal(facet).zip(self.normal(other));
            both.is_some_and(|(a, b)| a.dot(b) < 1.0 - ROUNDING)
        })
    }

    /// The normals at the corners of faces around which a smooth surface turns.
    fn corner_normals(&self) -> BTreeMap<(u32, NodeId), Vec3> {
        let all = 0..self.normals.len() as u32;
        let turns: Vec<bool> = all.map(|facet| self.turns(facet)).collect();
        let turns = |f: &u32| turns.get(*f as usize) == Some(&true);
        let mut normals = BTreeMap::new();
        for (&node, around) in &self.around {
            let mut left = around.clone();
            while let Some(first) = left.first().copied() {
                let fan = self.connected(first, &left);
                left.retain(|f| !fan.contains(f));
                if !fan.iter().any(turns) {
                    continue;
                }
                if let Some(normal) = self.fitted(node, &fan) {
                    normals.extend(fan.iter().map(|&f| ((f, node), normal)));
                }
            }
        }
        normals
    }

    /// The slopes of all faces, (E3).
    fn of_faces(&self) -> Vec<[[f64; 2]; CORNERS]> {
        let mut found = vec![[[0.0; 2]; CORNERS]; self.normals.len()];
        let normals = self.corner_normals();
        if normals.is_empty() {
            return found;
        }
        for (facet, slopes) in found.iter_mut().enumerate() {
            let facet = facet as u32;
            let (Some(element), Some(own)) = (self.facets.element(facet), self.normal(facet))
            else {
                continue;
            };
            if !self.is_straight(facet) {
                continue;
            }
            let nodes = corners(self.facets, facet);
            for (&[a, b], slopes) in element.edges().iter().zip(slopes) {
                let slope = |from: usize, to: usize| {
                    let normal = normals.get(&(facet, nodes[from]))?;
                    let way = self.at(nodes[to]) - self.at(nodes[from]);
                    Some(-normal.dot(way) / normal.dot(own).max(0.5))
                };
                *slopes = [slope(a, b), slope(b, a)].map(|s| s.unwrap_or(0.0));
            }
        }
        found
    }

    /// Those of some facets that a smooth surface connects with the first.
    fn connected(&self, first: u32, of: &[u32]) -> Vec<u32> {
        let mut found = vec![first];
        let mut next = 0;
        while let Some(&facet) = found.get(next) {
            next += 1;
            let more = of.iter().filter(|&&f| self.continues(facet, f));
            let more: Vec<u32> = more.copied().filter(|f| !found.contains(f)).collect();
            found.extend(more);
        }
        found
    }

    /// The normal at a node on one side of edges; `None` where the facets there have none.
    fn fitted(&self, node: NodeId, fan: &[u32]) -> Option<Vec3> {
        let mean: Vec3 = fan.iter().filter_map(|&f| self.normal(f)).sum();
        let mean = mean.normalized()?;
        let mut facets = fan.to_vec();
        let mut normal = mean;
        for ring in 0..=RINGS {
            let nodes = facets.iter().flat_map(|&f| corners(self.facets, f));
            let nodes: BTreeSet<NodeId> = nodes.copied().filter(|n| *n != node).collect();
            let ways: Vec<Vec3> = nodes.iter().map(|&n| self.at(n) - self.at(node)).collect();
            let Some((found, determined)) = fit(&ways, mean) else {
                break;
            };
            normal = found;
            if determined || ring == RINGS {
                break;
            }
            let before = facets.len();
            for k in 0..before {
                for &other in self.facets.neighbours(facets[k]) {
                    if self.continues(facets[k], other) && !facets.contains(&other) {
                        facets.push(other);
                    }
                }
            }
            if facets.len() == before {
                break;
            }
        }
        Some(normal)
    }
}

/// The nodes in which the edges of a facet end.
fn corners(facets: &Facets, facet: u32) -> &[NodeId] {
    let ncorner = facets.element(facet).map_or(0, |e| e.ncorner());
    facets.nodes(facet).get(..ncorner).unwrap_or(&[])
}

/// The normal of the surface (E4) that goes through the origin and passes these points, and whether they determine it.
fn fit(points: &[Vec3], mean: Vec3) -> Option<(Vec3, bool)> {
    let any = if mean.x.abs() < 0.6 {
        Vec3::unit(0)
    } else {
        Vec3::unit(1)
    };
    let first = (any - mean * any.dot(mean)).normalized()?;
    let second = mean.cross(first);
    let sizes = points.iter().map(|p| p.norm());
    let size = sizes.sum::<f64>() / points.len().max(1) as f64;
    let mut a = [[0.0; UNKNOWNS]; UNKNOWNS];
    let mut rhs = [0.0; UNKNOWNS];
    for point in points {
        let p = *point / size;
        let (x, y, z) = (p.dot(first), p.dot(second), p.dot(mean));
        let (flat, all) = (x * x + y * y, p.norm_squared());
        if flat < 1e-4 * all || all <= 0.0 {
            continue;
        }
        let factor = all / flat;
        let row = [
            x,
            y,
            0.5 * x * x * factor,
            x * y * factor,
            0.5 * y * y * factor,
        ];
        let weight = 1.0 / (all * all);
        for i in 0..UNKNOWNS {
            rhs[i] += weight * row[i] * z;
            for k in 0..UNKNOWNS {
                a[i][k] += weight * row[i] * row[k];
            }
        }
    }
    let (solution, determined) = solve(&mut a, rhs)?;
    let normal = mean - first * solution[0] - second * solution[1];
    Some((normal.normalized()?, determined))
}

/// The least squares solution of a symmetric system, zero along undetermined directions, and whether there are none: by
/// its eigenvectors, which rotations of pairs of axes find (Jacobi).
fn solve(
    a: &mut [[f64; UNKNOWNS]; UNKNOWNS],
    b: [f64; UNKNOWNS],
) -> Option<([f64; UNKNOWNS], bool)> {
    let mut vectors = [[0.0; UNKNOWNS]; UNKNOWNS];
    for (k, row) in vectors.iter_mut().enumerate() {
        row[k] = 1.0;
    }
    for _ in 0..SWEEPS {
        for p in 0..UNKNOWNS {
            for q in p + 1..UNKNOWNS {
                rotate(a, &mut vectors, p, q);
            }
        }
    }
    let largest = (0..UNKNOWNS).map(|k| a[k][k]).fold(0.0, f64::max);
    if largest <= 0.0 || !largest.is_finite() {
        return None;
    }
    let mut solution = [0.0; UNKNOWNS];
    let mut determined = true;
    for (k, of) in vectors.iter().enumerate() {
        if a[k][k] < UNDETERMINED * largest {
            determined = false;
            continue;
        }
        let along: f64 = of.iter().zip(&b).map(|(v, b)| v * b).sum();
        for (x, v) in solution.iter_mut().zip(of) {
            *x += v * along / a[k][k];
        }
    }
    Some((solution, determined))
}

/// Turns two axes so that a symmetric matrix does not couple them; the rows of `vectors` are the axes.
fn rotate(
    a: &mut [[f64; UNKNOWNS]; UNKNOWNS],
    vectors: &mut [[f64; UNKNOWNS]; UNKNOWNS],
    p: usize,
    q: usize,
) {
    if a[p][q] == 0.0 {
        return;
    }
    let half = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
    let tangent = half.signum() / (half.abs() + (half * half + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    for row in a.iter_mut() {
        (row[p], row[q]) = (
            cosine * row[p] - sine * row[q],
            sine * row[p] + cosine * row[q],
        );
    }
    for matrix in [a, vectors] {
        let (first, second) = (matrix[p], matrix[q]);
        for (to, (x, y)) in matrix[p].iter_mut().zip(first.iter().zip(&second)) {
            *to = cosine * x - sine * y;
        }
        for (to, (x, y)) in matrix[q].iter_mut().zip(first.iter().zip(&second)) {
            *to = sine * x + cosine * y;
        }
    }
}

#[cfg(test)]
mod tests;
