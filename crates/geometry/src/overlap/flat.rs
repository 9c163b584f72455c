use super::pair::{BENT, EXACT, Facing, Pair, TOUCH};
use super::polygon::{Polygon, Spot, cross2};
use crate::element::{Element, Family, MAX_FACET_NODES};
use crate::scalar::{combine, minus};
use crate::tensor::{Sym3, Vec3};

/// A facet projected onto a plane, or a line; each point of it has one place there.
#[derive(Clone, Debug)]
pub struct Flat {
    element: Element,
    dim: usize,
    nnode: usize,
    /// The degree of its shape functions as polynomials of the parameters.
    degree: usize,
    facing: Facing,
    x: [Pair<f64>; MAX_FACET_NODES],
    /// Nodes on the boundary, counter-clockwise on the plane; on a line, the ends from left to right.
    boundary: [u8; MAX_FACET_NODES],
    nboundary: usize,
    outline: Outline,
    /// Least and largest coordinates.
    bounds: [Pair<f64>; 2],
    bend: f64,
    /// The largest distance of a node from the line between the ends of its edge.
    sagitta: f64,
    /// The parameters of the centre, its place, and X_,1 and X_,2 there.
    centre: Pair<f64>,
    middle: Pair<f64>,
    tangents: [Pair<f64>; 2],
    /// Of a quadrilateral with four nodes, X_,12: its map has nothing else beyond the affine one.
    twist: Option<Pair<f64>>,
}

/// What the polygon through all nodes of the boundary is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outline {
    /// It is convex.
    Convex,
    /// It would be, without the nodes inside of these edges: a flag for each place in the boundary.
    Dented(u16),
    /// It is not convex at a corner.
    Star,
}

/// A convex part of a facet, counter-clockwise, and what it counts: less than nothing where an outline is dented.
pub(super) struct Piece {
    pub polygon: Polygon,
    pub sign: f64,
}

/// The largest δ with which points in dents, outside of a facet, have parameters for sure.
const EXTENSIBLE: f64 = 0.3;

/// What δ is multiplied by above order 2, so that (E3) holds: second derivatives at nodes say less of a cubic map.
const BEYOND_QUADRATIC: f64 = 3.0;

/// The Jacobian of the map at the parameters of a node must be this large compared with that at the centre.
const FOLDED: f64 = 1e-6;

impl Flat {
    /// A facet with its nodes at `x`. `None` where it turns the wrong side to the viewer, or is folded: where the map
    /// from its parameters turns round at a node or at the centre.
    ///
    /// # Limits
    /// Facets only, with one place for each node.
    #[must_use]
    pub fn new(element: Element, places: &[Pair<f64>], facing: Facing) -> Option<Self> {
        let mut x = [[0.0; 2]; MAX_FACET_NODES];
        let n = element.nnode();
        x.get_mut(..n)?.copy_from_slice(places.get(..n)?);
        let mut bounds = [x[0]; 2];
        for (p, a) in x[..n].iter().flat_map(|p| [(p, 0), (p, 1)]) {
            bounds[0][a] = bounds[0][a].min(p[a]);
            bounds[1][a] = bounds[1][a].max(p[a]);
        }
        let (boundary, nboundary) = boundary(element, facing);
        let dim = element.dim();
        let centre = element.centre();
        let mut flat = Self {
            element,
            dim,
            nnode: n,
            degree: element.degree(),
            facing,
            x,
            boundary,
            nboundary,
            outline: Outline::Convex,
            bounds,
            bend: bend(element, &x, facing)?,
            sagitta: sagitta(element, &x),
            centre: [centre.x, centre.y],
            middle: place(element, &x, &centre),
            tangents: jacobian(element, &x, &centre),
            twist: twist(element, &x),
        };
        if dim == 2 {
            flat.outline = flat.look();
        }
        let star = flat.outline == Outline::Star;
        let whole = !star || (0..flat.nboundary).all(|k| flat.triangle(k).area() > 0.0);
        whole.then_some(flat)
    }

    /// Its element.
    #[must_use]
    pub fn element(&self) -> Element {
        self.element
    }

    /// The places of its nodes.
    #[must_use]
    pub fn x(&self) -> &[Pair<f64>] {
        &self.x[..self.nnode]
    }

    /// The parameters of a place by the map at the centre, continued as an affine one.
    pub(super) fn affine(&self, p: Pair<f64>) -> Pair<f64> {
        let [a, b] = solve(self.dim, self.tangents, minus(p, self.middle));
        [self.centre[0] + a, self.centre[1] + b]
    }

    /// The place of parameters and the tangents there, of a quadrilateral with four nodes; `None` of all others.
    pub(super) fn bilinear(&self, xi: Pair<f64>) -> Option<(Pair<f64>, [Pair<f64>; 2])> {
        let twist = self.twist?;
        let [x, y] = [xi[0] - self.centre[0], xi[1] - self.centre[1]];
        let [t1, t2] = self.tangents;
        let along = |a: usize| t1[a] + twist[a] * y;
        let across = |a: usize| t2[a] + twist[a] * x;
        let place = |a: usize| self.middle[a] + along(a) * x + t2[a] * y;
        Some(([0, 1].map(place), [[0, 1].map(along), [0, 1].map(across)]))
    }

    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    /// δ.
    pub(super) fn bend(&self) -> f64 {
        self.bend
    }

    /// δ of the part of it that has these corners: how far the map is from an affine one.
    pub(super) fn bend_within(&self, corners: &[Pair<f64>]) -> f64 {
        if self.bend == 0.0 {
            return 0.0;
        }
        let mut extent = [[f64::MAX, f64::MIN]; 2];
        for p in corners {
            let xi = solve(self.dim, self.tangents, *p);
            for ([least, most], xi) in extent.iter_mut().zip(xi) {
                *least = least.min(xi);
                *most = most.max(xi);
            }
        }
        let widest = extent.iter().map(|e| e[1] - e[0]).fold(0.0, f64::max);
        let part = (widest / self.width()).min(1.0);
        let narrowest = 1.0 - self.bend * (1.0 - part);
        if narrowest <= 0.0 {
            return self.bend;
        }
        (self.bend * part / narrowest).min(self.bend)
    }

    /// The width of its reference domain.
    fn width(&self) -> f64 {
        match self.element.family() {
            Family::Triangle => 1.0,
            _ => 2.0,
        }
    }

    /// What rules may miss of the integral of one of its shape functions.
    pub(super) fn accuracy(&self) -> f64 {
        (0.01 * self.sagitta / self.size()).clamp(EXACT, BENT)
    }

    /// The degree of its shape functions as polynomials of the parameters.
    pub(super) fn degree(&self) -> usize {
        self.degree
    }

    /// The largest extent.
    pub(super) fn size(&self) -> f64 {
        let [least, largest] = self.bounds;
        (largest[0] - least[0]).max(largest[1] - least[1])
    }

    /// The largest absolute coordinate.
    pub(super) fn reach(&self) -> f64 {
        let all = self.bounds.iter().flatten();
        all.fold(0.0, |most, c| most.max(c.abs()))
    }

    /// Whether the boxes around two facets meet.
    pub(super) fn near(&self, other: &Self) -> bool {
        (0..self.dim()).all(|a| {
            self.bounds[0][a] <= other.bounds[1][a] && other.bounds[0][a] <= self.bounds[1][a]
        })
    }

    /// The nodes at the ends of a line, from left to right.
    pub(super) fn ends(&self) -> [u8; 2] {
        [self.boundary[0], self.boundary[1]]
    }

    /// The place of a spot.
    pub(super) fn at(&self, spot: Spot) -> Pair<f64> {
        match spot {
            Spot::Node(node) => self.x[usize::from(node)],
            Spot::Centre => self.middle,
        }
    }

    /// Gives `each` the nodes that a spot moves with, and their shares in it.
    pub(super) fn nodes_of(&self, spot: Spot, mut each: impl FnMut(usize, f64)) {
        match spot {
            Spot::Node(node) => each(usize::from(node), 1.0),
            Spot::Centre => {
                let mut n = [0.0; MAX_FACET_NODES];
                self.element
                    .shape(&self.element.centre(), &mut n[..self.nnode]);
                (0..self.nnode).for_each(|i| each(i, n[i]));
            }
        }
    }

    /// Its convex parts: itself, or its convex outline and, to be taken away, dents; or triangles around its centre.
    pub(super) fn pieces(&self) -> impl Iterator<Item = Piece> {
        let (dents, triangles) = match self.outline {
            Outline::Convex => (0, 0),
            Outline::Dented(dents) => (dents, 0),
            Outline::Star => (0, self.nboundary),
        };
        let piece = |polygon, sign| Piece { polygon, sign };
        let whole = (triangles == 0).then(|| piece(self.polygon(dents), 1.0));
        let dents = (0..self.nboundary).filter(move |k| dents >> k & 1 == 1);
        let dents = dents.map(move |k| piece(self.dent(k), -1.0));
        let around = (0..triangles).map(move |k| piece(self.triangle(k), 1.0));
        whole.into_iter().chain(dents).chain(around)
    }

    /// What its outline is like.
    fn look(&self) -> Outline {
        let tolerance = TOUCH * self.size();
        let outline = |dents| self.polygon(dents);
        let whole = outline(0);
        let on_edge = |k: &usize| usize::from(self.boundary[*k]) >= self.element.ncorner();
        let inward = |k: &usize| on_edge(k) && whole.is_dented(*k, tolerance);
        let dents = (0..self.nboundary).filter(inward);
        let dents = dents.fold(0, |flags, k| flags | 1 << k);
        if dents == 0 {
            let convex = whole.is_convex(tolerance);
            return if convex {
                Outline::Convex
            } else {
                Outline::Star
            };
        }
        // the triangles of dents next to each other would overlap
        let apart = (1..self.nboundary).all(|k| (dents >> (k - 1)) & 0b11 != 0b11);
        match outline(dents).is_convex(tolerance) {
            true if apart && self.bend <= EXTENSIBLE => Outline::Dented(dents),
            _ => Outline::Star,
        }
    }

    /// A place in the boundary.
    fn node(&self, k: usize) -> Spot {
        Spot::Node(self.boundary[k % self.nboundary])
    }

    /// The polygon through its boundary without the places that have a flag.
    fn polygon(&self, without: u16) -> Polygon {
        let kept = (0..self.nboundary).filter(|k| without >> k & 1 == 0);
        self.through(kept.map(|k| self.node(k)))
    }

    /// The triangle that is missing at a place where the boundary turns inward.
    fn dent(&self, k: usize) -> Polygon {
        let around = [k + 1, k, k + self.nboundary - 1];
        self.through(around.into_iter().map(|k| self.node(k)))
    }

    /// A triangle from the centre to a side of the boundary.
    fn triangle(&self, k: usize) -> Polygon {
        self.through([Spot::Centre, self.node(k), self.node(k + 1)].into_iter())
    }

    fn through(&self, spots: impl Iterator<Item = Spot>) -> Polygon {
        Polygon::of(self.facing, spots.map(|spot| (spot, self.at(spot))))
    }
}

/// The nodes on the boundary in their order on the plane.
fn boundary(element: Element, facing: Facing) -> ([u8; MAX_FACET_NODES], usize) {
    let mut nodes = [0; MAX_FACET_NODES];
    if element.dim() == 1 {
        nodes[1] = 1;
        if facing == Facing::Opposite {
            nodes.swap(0, 1);
        }
        return (nodes, 2);
    }
    let mut n = 0;
    for (to, node) in nodes.iter_mut().zip(element.ring()) {
        *to = node as u8;
        n += 1;
    }
    if facing == Facing::Opposite {
        nodes[..n].reverse();
    }
    (nodes, n)
}

/// δ, or `None` for a folded facet.
fn bend(element: Element, x: &[Pair<f64>; MAX_FACET_NODES], facing: Facing) -> Option<f64> {
    let n = element.nnode();
    let sign = if facing == Facing::Same { 1.0 } else { -1.0 };
    let centre = element.centre();
    let at_centre = jacobian(element, x, &centre);
    let least = determinant(element.dim(), at_centre) * sign * FOLDED;
    let turned = |det: f64| det.is_nan() || det <= least;
    if turned(least / FOLDED) || least <= 0.0 {
        return None;
    }
    let mut ddn = [Sym3::ZERO; MAX_FACET_NODES];
    let mut bend = 0.0f64;
    for xi in element.nodes() {
        if turned(determinant(element.dim(), jacobian(element, x, xi)) * sign) {
            return None;
        }
        element.ddshape(xi, &mut ddn[..n]);
        let mut here = 0.0;
        for of in [Sym3::xx, Sym3::yy, Sym3::xy] {
            let second = combine(ddn.iter().map(of), &x[..n]);
            here += solve(element.dim(), at_centre, second)
                .iter()
                .map(|c| c.abs())
                .sum::<f64>();
        }
        bend = bend.max(here);
    }
    // half the facet is 1 in the parameters of lines and quadrilaterals, and 1/2 in those of triangles
    let bend = match element.family() {
        Family::Triangle => 0.5 * bend,
        _ => bend,
    };
    Some(if element.order() > 2 {
        BEYOND_QUADRATIC * bend
    } else {
        bend
    })
}

/// How far nodes of edges are from the lines between their ends; on a line there is no such distance.
fn sagitta(element: Element, x: &[Pair<f64>; MAX_FACET_NODES]) -> f64 {
    if element.dim() == 1 {
        return 0.0;
    }
    let heights = element.edge_nodes().map(|of| {
        let [a, b] = of.ends;
        let along = minus(x[b], x[a]);
        cross2(along, minus(x[of.node], x[a])).abs() / along[0].hypot(along[1])
    });
    heights.fold(0.0, f64::max)
}

/// The tangents `X_,1` and `X_,2`; the second is zero on a line.
fn jacobian(element: Element, x: &[Pair<f64>; MAX_FACET_NODES], xi: &Vec3) -> [Pair<f64>; 2] {
    let mut dn = [Vec3::ZERO; MAX_FACET_NODES];
    element.dshape(xi, &mut dn[..element.nnode()]);
    let along = |a: usize| combine(dn.iter().map(|d| d[a]), x);
    if element.dim() == 1 {
        return [along(0), [0.0; 2]];
    }
    [along(0), along(1)]
}

/// X_,12 of a quadrilateral with four nodes, where it is the same everywhere.
fn twist(element: Element, x: &[Pair<f64>; MAX_FACET_NODES]) -> Option<Pair<f64>> {
    if element.family() != Family::Quadrilateral || !element.is_linear() {
        return None;
    }
    let mut ddn = [Sym3::ZERO; MAX_FACET_NODES];
    element.ddshape(&element.centre(), &mut ddn[..4]);
    Some(combine(ddn.iter().map(Sym3::xy), &x[..4]))
}

/// The determinant of tangents; on a line the tangent itself.
fn determinant(dim: usize, [t1, t2]: [Pair<f64>; 2]) -> f64 {
    if dim == 1 {
        return t1[0];
    }
    cross2(t1, t2)
}

/// The change of parameters that makes a change of place.
fn solve(dim: usize, t: [Pair<f64>; 2], place: Pair<f64>) -> Pair<f64> {
    let over = 1.0 / determinant(dim, t);
    if dim == 1 {
        return [place[0] * over, 0.0];
    }
    [cross2(place, t[1]) * over, cross2(t[0], place) * over]
}

/// The place of parameters.
fn place(element: Element, x: &[Pair<f64>], xi: &Vec3) -> Pair<f64> {
    let mut n = [0.0; MAX_FACET_NODES];
    element.shape(xi, &mut n[..element.nnode()]);
    combine(n, x)
}
