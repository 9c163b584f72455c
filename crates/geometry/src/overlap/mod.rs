//! What two facets have in common, seen along the normal of one of them: cells, and points to integrate over them.
//!
//! ```text
//!          n0 ▲                             ╭─────────╮  primary, projected and turned round
//!     ╭───────┼──────╮  secondary       ╭───┼──────╮ cells: triangles from the first corner
//!    ╱   e2 ↖ │      ╱                  │   │╲╲    │  │  of the polygon that both share
//!   ╱        ╲o──▶ e1                   │   │ ╲ ╲  │  │
//!  ╰──────────────╯                     │   ╰──┴─┴─┼──╯
//!       auxiliary plane                 ╰──────────╯  secondary, projected
//! ```
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | o, e_1, e_2, n0 | `origin`, `axes`, `normal` of a [`Plane`] | vectors |
//! | X_i | `x` of a [`Flat`] facet: its nodes on the plane | pairs |
//! | p | `at` of a [`Point`] of a cell | pair |
//! | ξ, ξ^m | `secondary`, `primary` of a [`Point`]: parameters on either facet | pairs |
//! | w | `weight`: area of the plane, length of the line | number |
//! | c, s_c | corner of a cell, and `shares`: how far a point goes with those of its [`Simplex`] | |
//! | A, ∂A/∂c | `size`, `dsize` of a simplex | |
//! | δ | `bend` of a flat facet | number |
//!
//! The plane goes through the mean of the secondary facet's nodes and has its normal at the centre,
//!
//! ```text
//! n0 = t1 × t2/|t1 × t2|,  e1 = t1/|t1|,  e2 = n0 × e1,  X_ia = e_a·(x_i − o)      (E1)
//! Σ_i N_i(ξ) X_i = p = Σ_l N_l(ξ^m) X^m_l                                          (E2)
//! ```
//!
//! and a line of the plane is a strip, with `t2 = e_z`. Boundaries of both facets become polygons of the plane, intersected
//! by cutting one along the sides of the other (Sutherland and Hodgman); the intersection is integrated triangle by triangle,
//! or as an interval of the line.
//!
//! *Derivatives.* A polygon knows of each corner what makes it, a node or two lines that cross, and how it moves with the
//! nodes ([`Cell::moves`]). Points say how they follow: with `p = Σ_c s_c c` and the places of nodes,
//!
//! ```text
//! dN_j(ξ) = ∂N_j/∂p·(Σ_c s_c dc − Σ_i N_i dX_i),     dw = w/A Σ_c ∂A/∂c·dc        (E4)
//! ```
//!
//! *Quadratic facets* have polygons through all nodes of their boundary. Where edges are straight nothing is lost, and
//! patch tests stay exact. A bent edge deviates from its polygon by a fourth of its sagitta at most; facets that share it
//! share the polygon, so that nothing is covered twice or never, and what lies between is of second order in the size of
//! the facet, relative to it. A polygon with dents is a convex one from which triangles are taken away; where the facet
//! is much bent, δ > 0.3, so that the places in dents need not have parameters, or the polygon is not convex at a corner,
//! it is cut into triangles around its centre instead. Areas are those of the plane: on a curved facet they are the
//! component of its vector area along n0, which is what a constant pressure needs.
//!
//! *Degree.* Of a facet with shape functions of degree q the inverse map is a series in
//! `δ = max |X_,0⁻¹ X_,ab|`, half the facet being 1, and adds q − 1 degrees with each power of it: the term of `δ^k` in
//! `N_j(ξ(p))` is a polynomial of degree `q + k (q − 1)` of the place. A rule of degree d misses what comes from the
//! power
//!
//! ```text
//! k = ⌊(d − q)/(q − 1)⌋ + 1,     error of ∫N_j / area ≤ c δ^k 4^(k − 1 − (d − q))          (E3)
//! ```
//!
//! on. `c = 1/50`, of lines 1/10, and the 4 bound the errors measured over distorted facets of every kind up to δ = 0.5, as
//! cells of their own (`errors_of_rules_fall_as_stated`); above order 2, three times δ stands for it. A cell that is a part s of its facet sees
//! `δ s/(1 − δ (1 − s))`: it is smaller, and at worst at the corner where the facet is narrowest. The degree is the
//! least, up to [`MAX_DEGREE`], for which
//!
//! - products of two shape functions of facets with affine maps are exact: `d ≥ q + max(q, q^m)`, and
//! - (E3) is 1e-12 on either facet, for each triangle of a cell; where its edges are bent and the polygon is not exact, a
//!   hundredth of their sagitta, at most 1e-9: stiff laws see it where a degree changes. A patch test needs integrals of
//!   single shape functions. Of products it needs that they are taken at the same points; their errors are (E3) with 2q
//!   for the q in addition to d, some 1e-11.
//!
//! Patch tests stay exact to 1e-12 on distorted facets up to `δ = 0.32`, of lines 0.3, and beyond it if cells are smaller
//! than facets. Points of a triangle of a cell that is a whole facet, paired with its like, and in brackets of one half as
//! wide:
//!
//! | facets | δ = 0 | 0.003 | 0.03 | 0.1 | 0.3 |
//! |---|---|---|---|---|---|
//! | line2 | 2 (2) | 2 (2) | 2 (2) | 2 (2) | 2 (2) |
//! | line3 | 3 (3) | 4 (3) | 5 (5) | 7 (6) | 12 (9) |
//! | tri3 | 3 (3) | 3 (3) | 3 (3) | 3 (3) | 3 (3) |
//! | quad4, tri6 | 6 (6) | 12 (12) | 16 (16) | 33 (33) | 144 (81) |
//! | quad8 | 12 (12) | 33 (33) | 33 (33) | 81 (64) | 144 (100) |
//! | quad9 | 16 (16) | 33 (33) | 64 (64) | 100 (81) | 144 (121) |
//!
//! *Tolerances.* A corner within 1e-12 of the smaller facet's size from a side lies on that side, and is not moved. So no
//! point of intersection is computed from differences that are all rounding, and an overlap thinner than that is none.
//! Facets that turn the same side to the viewer, or are folded in the projection, overlap nowhere.
//!
//! Sources: Puso and Laursen, CMAME 193, 2004, 601–629; Popp, Gitterle, Gee and Wall, IJNME 83, 2010, 1428–1465 (cells);
//! Sutherland and Hodgman, CACM 17, 1974, 32–42.

mod flat;
mod locate;
mod pair;
mod plane;
mod polygon;
#[cfg(test)]
mod tests;

pub use flat::Flat;
pub use pair::{Facing, Pair, Parameters};
use pair::{ROUNDING, TOUCH};
pub use plane::Plane;
pub use polygon::MAX_CORNERS;

use crate::element::quadrature::{MAX_DEGREE, of_degree};
use crate::scalar::minus;
use polygon::{Corner, Origin, Polygon, Spot, cross2};
use thiserror::Error;

/// A point of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct Point {
    /// w, negative in a cell that is taken away.
    pub weight: f64,
    /// p.
    pub at: Pair<f64>,
    /// s_c: how it goes with the corners of its simplex.
    pub shares: [f64; 3],
    /// ξ, with shape functions and derivatives.
    pub secondary: Parameters,
    /// ξ^m.
    pub primary: Parameters,
}

/// What prevents integration over an overlap.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum OverlapError {
    /// A point of the overlap has no parameters on one of the facets.
    #[error("a facet is folded: a point of it has no parameters")]
    Folded,
}

/// Gives `each` the cells of the part that two facets have in common.
///
/// # Limits
/// Both facets have the same dimension, else there is none. The secondary one faces the [same](Facing::Same) way as the
/// plane, the primary one the [opposite](Facing::Opposite).
///
/// # Errors
/// Those of `each`.
pub fn integrate(
    secondary: &Flat,
    primary: &Flat,
    mut each: impl FnMut(&Cell) -> Result<(), OverlapError>,
) -> Result<(), OverlapError> {
    if secondary.dim() != primary.dim() || !secondary.near(primary) {
        return Ok(());
    }
    let over = Both { secondary, primary };
    if secondary.dim() == 1 {
        return over.interval(&mut each);
    }
    let tolerance = over.tolerance();
    for a in secondary.pieces() {
        for b in primary.pieces() {
            if a.polygon.near(&b.polygon) {
                let shared = a.polygon.intersection(&b.polygon, tolerance);
                over.polygon(&shared, a.sign * b.sign, &mut each)?;
            }
        }
    }
    Ok(())
}

/// A convex part of what two facets have in common: a polygon, counter-clockwise, or an interval. Where the outline of a
/// facet is dented, there are cells that are taken away: their points have negative weights.
pub struct Cell<'a> {
    facets: Both<'a>,
    corners: &'a [Corner],
    sign: f64,
}

/// A triangle of a cell, or the interval that it is.
pub struct Simplex<'a> {
    facets: Both<'a>,
    /// The numbers of its corners; of an interval the third stands still.
    pub corners: [usize; 3],
    places: [Pair<f64>; 3],
    /// Its size: negative where it is taken away.
    pub size: f64,
    /// The derivatives of the size by the corners.
    pub dsize: [Pair<f64>; 3],
}

/// Two facets of the same plane.
#[derive(Clone, Copy)]
struct Both<'a> {
    secondary: &'a Flat,
    primary: &'a Flat,
}

impl Both<'_> {
    fn of(&self, facing: Facing) -> &Flat {
        match facing {
            Facing::Same => self.secondary,
            Facing::Opposite => self.primary,
        }
    }

    fn tolerance(&self) -> f64 {
        let (a, b) = (self.secondary, self.primary);
        TOUCH * a.size().min(b.size()) + ROUNDING * a.reach().max(b.reach())
    }

    /// The degree that the rule needs over a part with these corners.
    fn degree(&self, corners: &[Pair<f64>]) -> usize {
        let (a, b) = (self.secondary, self.primary);
        let product = a.degree() + a.degree().max(b.degree());
        let needed =
            [a, b].map(|f| degree_for(f.dim(), f.degree(), f.bend_within(corners), f.accuracy()));
        product.max(needed[0]).max(needed[1]).min(MAX_DEGREE)
    }

    fn interval(
        &self,
        each: &mut impl FnMut(&Cell) -> Result<(), OverlapError>,
    ) -> Result<(), OverlapError> {
        let ends = |facing| {
            let nodes = self.of(facing).ends();
            let corner = |node: u8, other: u8| {
                let spots = [node, other].map(Spot::Node);
                let at = self.of(facing).at(spots[0]);
                Corner::new(facing, spots, [at[0], 0.0])
            };
            [corner(nodes[0], nodes[1]), corner(nodes[1], nodes[0])]
        };
        let ([a, b], [c, d]) = (ends(Facing::Same), ends(Facing::Opposite));
        let start = if c.at[0] > a.at[0] { c } else { a };
        let end = if d.at[0] < b.at[0] { d } else { b };
        if 0.5 * (end.at[0] - start.at[0]) <= self.tolerance() {
            return Ok(());
        }
        each(&Cell {
            facets: *self,
            corners: &[start, end],
            sign: 1.0,
        })
    }

    fn polygon(
        &self,
        polygon: &Polygon,
        sign: f64,
        each: &mut impl FnMut(&Cell) -> Result<(), OverlapError>,
    ) -> Result<(), OverlapError> {
        let corners = polygon.corners();
        if corners.len() < 3 || polygon.area() <= self.tolerance() * polygon.size() {
            return Ok(());
        }
        each(&Cell {
            facets: *self,
            corners,
            sign,
        })
    }

    /// Places a point.
    fn locate(&self, at: Pair<f64>, point: &mut Point) -> Result<(), OverlapError> {
        point.at = at;
        let found = locate::parameters(self.secondary, at, &mut point.secondary)
            .and_then(|()| locate::parameters(self.primary, at, &mut point.primary));
        found.ok_or(OverlapError::Folded)
    }
}

impl Cell<'_> {
    /// The places of its corners: of an interval its ends, from left to right.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = Pair<f64>> {
        self.corners.iter().map(|corner| corner.at)
    }

    /// Gives `each` the nodes that a corner moves with: which facet's, which one, and the derivatives `∂c_a/∂X_b`.
    ///
    /// A node moves with itself. Where two lines with the directions `d, d'` cross, and `δ` is how the place on the first
    /// that is at the corner moves with the ends of the line,
    ///
    /// ```text
    /// dc = (d' (d × δ) − d (d' × δ'))/(d × d'),   δ = (1 − s) dp + s dq                  (E5)
    /// ```
    pub fn moves(&self, corner: usize, mut each: impl FnMut(Facing, usize, [Pair<f64>; 2])) {
        let Some(corner) = self.corners.get(corner) else {
            return;
        };
        let lines = match corner.origin {
            Origin::Spot(facing, spot) => {
                let with = |node, n| each(facing, node, [[n, 0.0], [0.0, n]]);
                return self.facets.of(facing).nodes_of(spot, with);
            }
            Origin::Crossing(lines) => lines,
        };
        let ends = lines.map(|line| line.ends.map(|spot| self.facets.of(line.facet).at(spot)));
        let [d, e] = ends.map(|[p, q]| minus(q, p));
        let across = cross2(d, e);
        let of_lines = [(d, e, 1.0 / across), (e, d, -1.0 / across)];
        for ((line, [p, _]), (own, other, over)) in lines.iter().zip(ends).zip(of_lines) {
            let away = minus(corner.at, p);
            let s = (away[0] * own[0] + away[1] * own[1]) / (own[0] * own[0] + own[1] * own[1]);
            let normal = [-own[1] * over, own[0] * over];
            for (spot, share) in line.ends.into_iter().zip([1.0 - s, s]) {
                self.facets.of(line.facet).nodes_of(spot, |node, n| {
                    let slope = |a: usize| normal.map(|normal| share * n * other[a] * normal);
                    each(line.facet, node, [slope(0), slope(1)]);
                });
            }
        }
    }

    /// Gives `each` the triangles from its first corner, or itself.
    ///
    /// # Errors
    /// Those of `each`.
    pub fn simplices(
        &self,
        mut each: impl FnMut(&Simplex) -> Result<(), OverlapError>,
    ) -> Result<(), OverlapError> {
        let place = |k: usize| self.corners[k].at;
        if self.facets.secondary.dim() == 1 {
            return each(&Simplex {
                facets: self.facets,
                corners: [0, 1, 1],
                places: [place(0), place(1), place(1)],
                size: self.sign * (place(1)[0] - place(0)[0]),
                dsize: [[-self.sign, 0.0], [self.sign, 0.0], [0.0; 2]],
            });
        }
        let first = place(0);
        let sides = |k: usize| [minus(place(k), first), minus(place(k + 1), first)];
        let twice = |k: usize| {
            let [u, v] = sides(k);
            cross2(u, v)
        };
        let last = self.corners.len() - 1;
        let all: f64 = (1..last).map(twice).sum();
        for k in (1..last).filter(|&k| twice(k) > f64::EPSILON * all) {
            let [u, v] = sides(k);
            let half = 0.5 * self.sign;
            let [b, c] = [[v[1], -v[0]], [-u[1], u[0]]].map(|d| d.map(|d| half * d));
            each(&Simplex {
                facets: self.facets,
                corners: [0, k, k + 1],
                places: [first, place(k), place(k + 1)],
                size: half * twice(k),
                dsize: [[-b[0] - c[0], -b[1] - c[1]], b, c],
            })?;
        }
        Ok(())
    }

    /// Gives `each` the places of points in the parameters of the secondary facet, and their weights, without
    /// derivatives: over triangles around the centre of the corners, as symmetric as the cell is. `factor` as in
    /// [`Simplex::points`].
    ///
    /// # Errors
    /// A map has no inverse at a point. Then some points have been given already.
    pub fn points_around_centre(
        &self,
        factor: usize,
        mut each: impl FnMut(Pair<f64>, f64),
    ) -> Result<(), OverlapError> {
        let n = self.corners.len();
        if n <= 3 {
            let mut each = |point: &Point| each(point.secondary.xi, point.weight);
            return self.simplices(|simplex| simplex.points(factor, &mut each));
        }
        let place = |k: usize| self.corners[k % n].at;
        let sum = |c: usize| (0..n).map(|k| place(k)[c]).sum::<f64>() / n as f64;
        let centre = [sum(0), sum(1)];
        let mut there = Parameters::default();
        for k in 0..n {
            let corners = [centre, place(k), place(k + 1)];
            let [u, v] = [minus(corners[1], centre), minus(corners[2], centre)];
            let degree = self.facets.degree(&corners) + factor;
            for &(s, w) in of_degree(2, degree) {
                let at = [0, 1].map(|c| centre[c] + u[c] * s.x + v[c] * s.y);
                let found = locate::parameters(self.facets.secondary, at, &mut there);
                found.ok_or(OverlapError::Folded)?;
                each(there.xi, w * self.sign * cross2(u, v));
            }
        }
        Ok(())
    }
}

impl Simplex<'_> {
    /// Gives `each` all points, for integrals of shape functions times a polynomial of degree `factor` of the place.
    ///
    /// # Errors
    /// A map has no inverse at a point. Then some points have been given already.
    pub fn points(&self, factor: usize, mut each: impl FnMut(&Point)) -> Result<(), OverlapError> {
        let [first, second, third] = self.places;
        let mut point = Point::default();
        if self.facets.secondary.dim() == 1 {
            let degree = self.facets.degree(&[first, second]) + factor;
            for &(s, w) in of_degree(1, degree) {
                let share = 0.5 * (1.0 + s.x);
                point.weight = 0.5 * w * self.size;
                point.shares = [1.0 - share, share, 0.0];
                let at = [first[0] + share * (second[0] - first[0]), 0.0];
                self.facets.locate(at, &mut point)?;
                each(&point);
            }
            return Ok(());
        }
        let [u, v] = [minus(second, first), minus(third, first)];
        let degree = self.facets.degree(&self.places) + factor;
        for &(s, w) in of_degree(2, degree) {
            point.weight = 2.0 * w * self.size;
            point.shares = [1.0 - s.x - s.y, s.x, s.y];
            let at = [0, 1].map(|c| first[c] + u[c] * s.x + v[c] * s.y);
            self.facets.locate(at, &mut point)?;
            each(&point);
        }
        Ok(())
    }
}

/// The least degree for which (E3) is this accurate, from `q` and δ; more than [`MAX_DEGREE`] where there is none.
fn degree_for(dim: usize, q: usize, bend: f64, accuracy: f64) -> usize {
    let exact = |d: &usize| error_bound(dim, q, bend, *d) <= accuracy;
    (q..=MAX_DEGREE).find(exact).unwrap_or(MAX_DEGREE + 1)
}

/// (E3).
fn error_bound(dim: usize, q: usize, bend: f64, degree: usize) -> f64 {
    if q == 1 {
        return 0.0; // an affine map
    }
    let beyond = (degree - q) as i32;
    let missed = beyond / (q as i32 - 1) + 1;
    let c = if dim == 1 { 0.1 } else { 0.02 };
    c * bend.powi(missed) * 4f64.powi(missed - 1 - beyond)
}
