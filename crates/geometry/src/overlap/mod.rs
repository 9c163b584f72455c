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
//! | c, s_c | `corner`, `share` of a [`Follow`]: a corner of the cell, and how far the point goes with it | |
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
//! by cutting one along the sides of the other (Sutherland and Hodgman); what is left is integrated triangle by triangle,
//! or as an interval of the line.
//!
//! *Derivatives.* Polygons are cut in any [`Real`] numbers, so that corners of cells carry their derivatives. Points, of
//! which there are many, are plain numbers, and say how they follow: with `p = Σ_c s_c c` and the places of nodes,
//!
//! ```text
//! dN_j(ξ) = ∂N_j/∂p·(Σ_c s_c dc − Σ_i N_i dX_i),     dw = Σ_c ∂w/∂c·dc             (E4)
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
//! on. `c = 1/50`, of lines 1/10, and the 4 bound what is measured over distorted facets of every kind up to δ = 0.5, as
//! cells of their own (`errors_of_rules_fall_as_stated`). A cell that is a part s of its facet sees
//! `δ s/(1 − δ (1 − s))`: it is smaller, and at worst at the corner where the facet is narrowest. The degree is the
//! least, up to [`MAX_DEGREE`], for which
//!
//! - products of two shape functions of facets with affine maps are exact: `d ≥ q + max(q, q^m)`, and
//! - (E3) is 1e-12 on either facet, for each triangle of a cell; where its edges are bent and the polygon is not exact, a
//!   hundredth of their sagitta, at most 1e-9: stiff laws see it where a degree changes. A patch test needs integrals of
//!   single shape functions. Of products it needs that they are taken at the same points; their errors are (E3) with 2q
//!   for the q beside d, some 1e-11.
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
mod plane;
mod polygon;
#[cfg(test)]
mod tests;

pub use flat::{Facing, Flat};
pub use plane::Plane;

use crate::element::MAX_FACET_NODES;
use crate::element::quadrature::{MAX_DEGREE, of_degree};
use crate::scalar::{Real, minus};
use polygon::{Polygon, cross2};
use thiserror::Error;

/// A pair of numbers on the auxiliary plane, or of parameters; the second is zero on a line.
pub type Pair<T> = [T; 2];

/// How far a corner may be from a side and still lie on it, relative to the size of the smaller facet.
const TOUCH: f64 = 1e-12;

/// What rounding leaves of a coordinate, relative to the largest.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What rules on facets with maps that are not affine may miss of an integral of a shape function, relative to the area.
const EXACT: f64 = 1e-12;

/// The same where edges are bent: a hundredth of the sagitta, relative to the size of the facet, and no more than this.
const BENT: f64 = 1e-9;

/// A point of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct Point {
    /// w, negative in a cell that is taken away.
    pub weight: f64,
    /// p.
    pub at: Pair<f64>,
    /// ξ, and what is there.
    pub secondary: Parameters,
    /// ξ^m.
    pub primary: Parameters,
    /// How it follows corners of its cell; on a line the third stands still.
    pub follows: [Follow; 3],
}

/// Parameters of a place on a facet.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parameters {
    /// ξ.
    pub xi: Pair<f64>,
    /// N_j.
    pub shape: [f64; MAX_FACET_NODES],
    /// ∂N_j/∂p: by the place on the plane.
    pub gradient: [Pair<f64>; MAX_FACET_NODES],
}

/// How a point follows a corner of its cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct Follow {
    /// The number of the corner.
    pub corner: usize,
    /// ∂p/∂c.
    pub share: f64,
    /// ∂w/∂c.
    pub dweight: Pair<f64>,
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
/// Both facets have the same dimension, else there is none.
///
/// # Errors
/// Those of `each`.
pub fn integrate<T: Real>(
    secondary: &Flat<T>,
    primary: &Flat<T>,
    mut each: impl FnMut(&Cell<T>) -> Result<(), OverlapError>,
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
pub struct Cell<'a, T> {
    facets: Both<'a, T>,
    corners: &'a [Pair<T>],
    sign: f64,
}

/// Two facets of the same plane.
#[derive(Clone, Copy)]
struct Both<'a, T> {
    secondary: &'a Flat<T>,
    primary: &'a Flat<T>,
}

impl<T: Real> Both<'_, T> {
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
        each: &mut impl FnMut(&Cell<T>) -> Result<(), OverlapError>,
    ) -> Result<(), OverlapError> {
        let ([a, b], [c, d]) = (self.secondary.ends(), self.primary.ends());
        let start = if c.value() > a.value() { c } else { a };
        let end = if d.value() < b.value() { d } else { b };
        if 0.5 * (end.value() - start.value()) <= self.tolerance() {
            return Ok(());
        }
        let corners = &[start, end].map(|x| [x, T::from(0.0)]);
        each(&Cell {
            facets: *self,
            corners,
            sign: 1.0,
        })
    }

    fn polygon(
        &self,
        polygon: &Polygon<T>,
        sign: f64,
        each: &mut impl FnMut(&Cell<T>) -> Result<(), OverlapError>,
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
}

impl<T: Real> Cell<'_, T> {
    /// Its corners: of an interval its ends, from left to right.
    #[must_use]
    pub fn corners(&self) -> &[Pair<T>] {
        self.corners
    }

    /// Gives `each` all points, for integrals of shape functions times a polynomial of degree `factor` of the place.
    ///
    /// # Errors
    /// A map has no inverse at a point. Then some points have been given already.
    pub fn points(&self, factor: usize, mut each: impl FnMut(&Point)) -> Result<(), OverlapError> {
        let place = |k: usize| self.corners[k].map(|c| c.value());
        let mut point = Point::default();
        if self.facets.secondary.dim() == 1 {
            let (start, end) = (place(0)[0], place(1)[0]);
            let length = end - start;
            let degree = self.facets.degree(&[place(0), place(1)]) + factor;
            for &(s, w) in of_degree(1, degree) {
                let share = 0.5 * (1.0 + s.x);
                let at = [start + share * length, 0.0];
                let half = 0.5 * w;
                point.weight = half * length;
                point.follows = [
                    follow(0, 1.0 - share, [-half, 0.0]),
                    follow(1, share, [half, 0.0]),
                    follow(1, 0.0, [0.0; 2]),
                ];
                self.locate(at, &mut point)?;
                each(&point);
            }
            return Ok(());
        }
        // triangles from the first corner
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
            let of_u = [v[1], -v[0]];
            let of_v = [-u[1], u[0]];
            let corners = [first, place(k), place(k + 1)];
            let degree = self.facets.degree(&corners) + factor;
            for &(s, w) in of_degree(2, degree) {
                let w = w * self.sign;
                let at = [0, 1].map(|c| first[c] + u[c] * s.x + v[c] * s.y);
                let [b, c] = [of_u, of_v].map(|d| d.map(|d| w * d));
                point.weight = w * twice(k);
                point.follows = [
                    follow(0, 1.0 - s.x - s.y, [-b[0] - c[0], -b[1] - c[1]]),
                    follow(k, s.x, b),
                    follow(k + 1, s.y, c),
                ];
                self.locate(at, &mut point)?;
                each(&point);
            }
        }
        Ok(())
    }

    /// Gives `each` the places of points in the parameters of the secondary facet, and their weights, without
    /// derivatives: over triangles around the centre of the corners, as symmetric as the cell is. `factor` as in
    /// [`Cell::points`].
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
            return self.points(factor, |point| each(point.secondary.xi, point.weight));
        }
        let place = |k: usize| self.corners[k % n].map(|c| c.value());
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

    /// Places a point.
    fn locate(&self, at: Pair<f64>, point: &mut Point) -> Result<(), OverlapError> {
        let Both { secondary, primary } = self.facets;
        point.at = at;
        let found = locate::parameters(secondary, at, &mut point.secondary)
            .and_then(|()| locate::parameters(primary, at, &mut point.primary));
        found.ok_or(OverlapError::Folded)
    }
}

fn follow(corner: usize, share: f64, dweight: Pair<f64>) -> Follow {
    Follow {
        corner,
        share,
        dweight,
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
