//! Points of the secondary side against their closest points of the primary side.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | r = Σ N_i x_i, ρ, w = r − ρ | `point`, `position`, `away` | vectors |
//! | t_a, m_ab, κ_ab = ν·ρ_,ab | `tangent`, `metric`, `kappa` | over the free directions |
//! | N* = ∂w/∂d at fixed ξ | `n_star` | a vector for each column |
//! | B*_a = ∂N*/∂ξ^a | `b_star` | a vector for each column |
//! | T_a = N*ᵀt_a, B_a = B*_aᵀν | `t`, `b` | a number for each column |
//! | ξ_a, o, e | `anchor`, `offset`, `slip` | where the point sticks, and how far it is from there |
//!
//! A closest point is free to move along both tangents of a face, along an edge, or not at all on a vertex; with the
//! sums running over the free directions only, all three are one formula. The projection condition `w·t_a = 0` gives
//!
//! ```text
//! A_ab = m_ab − g κ_ab,   δξ^a = D_a·δd,   D_a = A⁻¹_ab (T_b − g B_b)                          (E1)
//! ∂g/∂d = N*ᵀν                                                                                (E2)
//! ∂²g/∂d² = B_a D_aᵀ + D_a B_aᵀ − κ_ab D_a D_bᵀ + g m^ab B̄_a B̄_bᵀ,   B̄_a = B_a − κ_ab D_b     (E3)
//!         + (1/g) N*ᵀ (I − ννᵀ − m^ab t_a t_bᵀ) N*     on edges and vertices, where ν = w/g      (E4)
//! ∂ν/∂d = m^ab t_a B̄_bᵀ, and (1/g)(I − ννᵀ − m^ab t_a t_bᵀ) N* more on edges and vertices       (E6)
//! ```
//!
//! For a rigid carrier with arm `a`, `N* = [−I, [a]×, I]`, `B*_a = [0, [t_a]×, 0]`, and the rotation itself adds
//! `−[ν]×[a]×` to (E3) (E5). The one sign of κ in (E1) fixes both signs in (E3): printed tangents in the literature
//! that combine `m − gκ` with `+κ D D` are wrong on curved facets, and a test of this room shows it.
//!
//! Where a point sticks, its anchor is a material point of the primary side, and
//!
//! ```text
//! e = P (r − ρ(ξ_a) − o),   P = I − ννᵀ,   N_a = ∂(r − ρ(ξ_a))/∂d                                (E7)
//! ∂e/∂d = P N_a − (ν·e₀) ∂ν/∂d − ν (e₀ᵀ ∂ν/∂d)                                                  (E8)
//! ∂(N*ᵀt)/∂d = (B*_aᵀ t) D_aᵀ, and −[t]×[a]× more for the rotation of a rigid carrier            (E9)
//! ```
//!
//! so that nothing but a place is remembered, whatever turns, and whatever facet the point has come to since. A bond is
//! the same without projection: `e = r − ρ(ξ_a) − o` acts on `N_a` (E10).
//!
//! Where sliding is small, ν and ξ are those of the first look, and (E3) and (E6) vanish.
//!
//! Where the primary surface ends, a point that is just past the rim (by [`RIM`]) still rests on the continuation of
//! the facet, or of the valley that ends there; further out it is free. Facets are compared over their whole
//! neighbourhood: the smallest distance wins, then the face over the edge over the vertex, then the lower number.
//!
//! Multipliers make `g = 0`, where an edge and a vertex have no normal (E4): for them a point on an edge or a vertex
//! rests on the continuation of a facet that meets there, the one it had before where there is one ([`Closest::Faces`]).
//!
//! Limits: `w = 0` on an edge or vertex has no normal and counts as open; a node that lies deeper in the body than
//! half its thickness is pushed out at the wrong side, unless it is of the same body, where it meets nothing there. Sources: Wriggers 2006, section 6.3; Konyukhov and
//! Schweizerhof 2013, chapter 5; Wriggers and Krstulović-Opara 2000 (E7).

pub use super::point::Point;
use super::{Anchored, OwnPoint, Pair};
use crate::contact::row::{Participant, Row, RowOrder, Rows, Wanted};
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Aabb;
use signorini_geometry::surface::{
    Anchor, Carrier, ContactSurface, Feature, Placement, Projection, SurfaceError, SurfaceJet,
    extended_edge, extended_face, pair,
};
use signorini_geometry::tensor::{Mat3, Vec3};

/// How far past the rim of a surface, in parameters of the facet, a point still rests on it: nodes at the common
/// boundary of two stacked bodies must not lose contact by a lateral strain of some per cent.
pub const RIM: f64 = 0.05;

/// How far past its facet a point on an edge or a vertex may rest on its continuation, where only faces count.
pub const BEYOND: f64 = 0.5;

/// Relative difference below which two distances are equal.
const TIE: f64 = 1e-12;

/// Columns of the facet, the facet of the anchor and the point, at most.
const MAX_COLUMNS: usize = 3 * 3 * MAX_FACET_NODES;

/// On what a closest point may lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Closest {
    /// On faces, edges and vertices.
    #[default]
    Anywhere,
    /// On faces and their continuations only.
    Faces,
    /// Within faces only: elsewhere nothing is near.
    Within,
    /// Anywhere; edges and vertices where the surface ends count as all others do.
    Rims,
}

/// What a point sees of the primary side.
#[derive(Clone, Copy)]
pub struct Sight<'a> {
    /// Its previous closest point.
    pub hint: Option<Anchor>,
    /// On what its closest point may lie.
    pub on: Closest,
    /// The distance up to which a closest point of this facet counts.
    pub reach: &'a dyn Fn(u32) -> f64,
    /// How deep it may be behind a facet, where both sides are faces of one body.
    pub deepest: Option<&'a dyn Fn(u32) -> f64>,
    /// The point among its own body, where the surface may touch itself.
    pub own: Option<OwnPoint<'a>>,
}

impl Sight<'_> {
    /// Whether a facet within these bounds may have a point that counts.
    fn may_meet(&self, facet: u32, bounds: &Aabb, point: Vec3) -> bool {
        self.own
            .is_none_or(|own| own.may_meet(facet, bounds, point))
    }

    /// Whether it meets this closest point, and does not see it through the body that it is of.
    fn meets(&self, point: Vec3, found: &Projection, jet: &SurfaceJet) -> bool {
        let is_behind = (point - jet.position).dot(jet.normal) < 0.0;
        let is_through = |deepest: &dyn Fn(u32) -> f64| {
            is_behind && found.distance > deepest(found.anchor.facet)
        };
        !self.deepest.is_some_and(is_through)
            && self.own.is_none_or(|own| own.meets(point, found, jet))
    }
}

/// Who moves a facet.
fn carried_by(carrier: Carrier<'_>) -> impl Iterator<Item = Participant> + '_ {
    let (nodes, body) = match carrier {
        Carrier::Nodes(nodes) => (nodes, None),
        Carrier::Rigid(body) => (&[][..], Some(body)),
        Carrier::Fixed => (&[][..], None),
    };
    let nodes = nodes.iter().map(|&n| Participant::Node(n));
    nodes.chain(body.map(Participant::Rigid))
}

/// The closest point of the continuation of the facet that `from` is on, up to `beyond` past it, in its parameters.
///
/// # Errors
/// A facet that has no normal.
pub fn on_continuation(
    surface: &dyn ContactSurface,
    at: &Placement,
    from: Anchor,
    point: Vec3,
    beyond: f64,
) -> Result<Option<Pair>, SurfaceError> {
    let mut jet = SurfaceJet::default();
    let found = extended_face(surface, at, from, point, beyond, &mut jet)?;
    Ok(found.map(|f| Pair {
        anchor: f.anchor,
        feature: Feature::Face,
        gap: (point - jet.position).dot(jet.normal),
        held: None,
    }))
}

/// Facets that are looked at first, at most.
const LIKELY: usize = 8;

/// The facets to look at first: that of the hint, then those with the closest boxes, the closest first.
fn likely(
    surface: &dyn ContactSurface,
    at: &Placement,
    point: Vec3,
    near: &[u32],
    sight: &Sight<'_>,
) -> ([u32; LIKELY], usize) {
    let hinted = sight.hint.map(|hint| hint.facet);
    let distance = |&facet: &u32| {
        let bounds = surface.aabb(at, facet);
        match (sight.may_meet(facet, &bounds, point), hinted) {
            (false, _) => None,
            (true, Some(hinted)) if hinted == facet => Some((facet, -1.0)),
            _ => Some((facet, bounds.distance_squared(point))),
        }
    };
    let (mut facets, mut distances) = ([0; LIKELY], [f64::INFINITY; LIKELY]);
    let mut count = 0;
    for (facet, own) in near.iter().filter_map(distance) {
        let place = distances[..count].partition_point(|d| *d <= own);
        if place == LIKELY {
            continue;
        }
        count = (count + 1).min(LIKELY);
        distances[place..count].rotate_right(1);
        facets[place..count].rotate_right(1);
        (distances[place], facets[place]) = (own, facet);
    }
    (facets, count)
}

/// The closest of the near facets, if it is within the reach of that facet.
///
/// # Errors
/// A facet that has no normal.
pub fn closest(
    surface: &dyn ContactSurface,
    at: &Placement,
    point: Vec3,
    near: &[u32],
    sight: &Sight<'_>,
) -> Result<Option<Pair>, SurfaceError> {
    let Sight {
        hint, on, reach, ..
    } = *sight;
    let rank = |f: &Feature| match f {
        Feature::Face => 0,
        Feature::Edge { .. } => 1,
        Feature::Vertex => 2,
    };
    let mut jet = SurfaceJet::default();
    let mut best: Option<(Projection, f64)> = None;
    // a small distance found first passes over most of the others
    let (first, count) = likely(surface, at, point, near, sight);
    let first = &first[..count];
    let others = near.iter().filter(|facet| !first.contains(facet));
    for &facet in first.iter().chain(others) {
        let bounds = surface.aabb(at, facet);
        if let Some((b, tie)) = &best {
            let reach = b.distance + tie;
            if bounds.distance_squared(point) > reach * reach {
                continue;
            }
        }
        if !sight.may_meet(facet, &bounds, point) {
            continue;
        }
        let Some(found) = surface.project(at, facet, point, hint, &mut jet)? else {
            continue;
        };
        if on == Closest::Within && found.feature != Feature::Face {
            continue;
        }
        if !sight.meets(point, &found, &jet) {
            continue;
        }
        let tie = TIE * (jet.metric[0].max(jet.metric[1])).sqrt();
        let better = best.as_ref().is_none_or(|(b, tie)| {
            let closer = b.distance - found.distance;
            // of facets that are as close, the first of those near, whichever was looked at first
            let place = |p: &Projection| near.iter().position(|f| *f == p.anchor.facet);
            let of = |p: &Projection| (rank(&p.feature), place(p));
            closer > *tie || (closer >= -tie && of(&found) < of(b))
        });
        if better {
            best = Some((found, tie));
        }
    }
    // candidates further away than the reach may be there or not; results must not depend on them
    let within = |(b, _): &(Projection, f64)| b.distance <= reach(b.anchor.facet);
    let Some((mut found, _)) = best.filter(within) else {
        return Ok(None);
    };
    let mut outward = surface.outward(at, &found)?;
    outward.rim &= on != Closest::Rims;
    if outward.rim
        && found.feature == Feature::Vertex
        && let Some(edge) = extended_edge(surface, at, found.anchor, point, RIM, &mut jet)?
    {
        found = edge;
        outward = surface.outward(at, &found)?;
    }
    if outward.rim {
        return on_continuation(surface, at, found.anchor, point, RIM);
    }
    if on == Closest::Faces && found.feature != Feature::Face {
        let kept = hint.filter(|h| surface.neighbours(found.anchor.facet).contains(&h.facet));
        let from = kept.unwrap_or(found.anchor);
        return on_continuation(surface, at, from, point, BEYOND);
    }
    surface.jet(at, &found.anchor, &mut jet)?;
    let away = point - jet.position;
    let gap = if found.feature == Feature::Face {
        away.dot(jet.normal)
    } else if away.dot(outward.direction) < 0.0 {
        -found.distance
    } else {
        found.distance
    };
    Ok(Some(Pair {
        anchor: found.anchor,
        feature: found.feature,
        gap,
        held: None,
    }))
}

/// A point and its closest point, ready to be linearized.
pub struct Place<'a> {
    /// The primary side.
    pub surface: &'a dyn ContactSurface,
    /// The configuration.
    pub at: &'a Placement<'a>,
    /// The point.
    pub point: Point<'a>,
    /// Its closest point.
    pub found: &'a Pair,
    /// Where it sticks; on the surface, too.
    pub anchor: Option<&'a Anchored>,
    /// Whether it is joined to its anchor.
    pub bond: bool,
}

/// A direction along which the closest point may move.
#[derive(Clone, Copy, Default)]
struct Free {
    tangent: Vec3,
    // direction in the parameters
    local: [f64; 2],
}

/// A vector for each column.
type Columns = [Vec3; MAX_COLUMNS];
/// A number for each column.
type Numbers = [f64; MAX_COLUMNS];

/// Where the columns of each participant begin.
struct Ranges {
    anchor: usize,
    point: usize,
    ncolumn: usize,
}

impl<'a> Place<'a> {
    /// The facet that a carrier has columns for, unless it is that of the closest point.
    fn other_facet(&self) -> Option<u32> {
        let facet = self.anchor?.anchor.facet;
        if facet == self.found.anchor.facet {
            return None;
        }
        match self.surface.carrier(facet) {
            Carrier::Nodes(_) => Some(facet),
            Carrier::Rigid(_) | Carrier::Fixed => None,
        }
    }

    /// Adds the row of the point.
    ///
    /// # Errors
    /// A facet that has no normal.
    pub fn fill(&self, number: usize, wanted: Wanted, out: &mut Rows) -> Result<(), SurfaceError> {
        let facet = self.found.anchor.facet;
        let carrier = self.surface.carrier(facet);
        let other = self.other_facet().filter(|_| wanted.slip);
        let of_other = other.map_or(Carrier::Fixed, |f| self.surface.carrier(f));
        let nodes = self.point.nodes.iter().map(|&n| Participant::Node(n));
        out.start(carried_by(carrier).chain(carried_by(of_other)).chain(nodes));
        let ncolumn = out.ncolumn();
        let of_point = 3 * self.point.nodes.len();
        let ranges = Ranges {
            anchor: match other {
                Some(f) => ncolumn - of_point - 3 * nodes_of(self.surface, f).len(),
                None => 0,
            },
            point: ncolumn - of_point,
            ncolumn,
        };
        let mut jet = SurfaceJet::default();
        self.surface.jet(self.at, &self.found.anchor, &mut jet)?;
        let linearized = Linearized {
            place: self,
            jet: &jet,
            carrier,
            ranges,
        };
        linearized.fill(number, wanted, out)
    }
}

fn nodes_of(surface: &dyn ContactSurface, facet: u32) -> &[NodeId] {
    match surface.carrier(facet) {
        Carrier::Nodes(nodes) => nodes,
        Carrier::Rigid(_) | Carrier::Fixed => &[],
    }
}

struct Linearized<'a> {
    place: &'a Place<'a>,
    jet: &'a SurfaceJet,
    carrier: Carrier<'a>,
    ranges: Ranges,
}

impl Linearized<'_> {
    fn free(&self) -> ([Free; 2], usize) {
        let along = |local: [f64; 2]| Free {
            tangent: self.jet.tangent[0] * local[0] + self.jet.tangent[1] * local[1],
            local,
        };
        if self.place.found.held.is_some() {
            return ([Free::default(); 2], 0);
        }
        match self.place.found.feature {
            Feature::Face => (
                [along([1.0, 0.0]), along([0.0, 1.0])],
                self.place.surface.ntan(),
            ),
            Feature::Edge { direction } => ([along(direction), Free::default()], 1),
            Feature::Vertex => ([Free::default(); 2], 0),
        }
    }

    /// ρ_,ab along two free directions.
    fn curvature(&self, p: &Free, q: &Free) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for a in 0..2 {
            for b in 0..2 {
                sum += self.jet.curvature[pair(a, b)] * (p.local[a] * q.local[b]);
            }
        }
        sum
    }

    /// The arm of a point of a rigid carrier.
    fn arm(&self, position: Vec3) -> Vec3 {
        match self.carrier {
            Carrier::Rigid(body) => {
                let pose = self.place.at.poses.get(body as usize);
                pose.map_or(Vec3::ZERO, |p| position - p.origin)
            }
            _ => Vec3::ZERO,
        }
    }

    /// ∂(r − ρ)/∂d at a fixed point of the surface: its facet has its columns from `first` on.
    fn operator(&self, first: usize, jet: &SurfaceJet, out: &mut Columns) {
        match self.carrier {
            Carrier::Nodes(_) => {
                for (i, n) in jet.shape.iter().take(jet.nnode).enumerate() {
                    for c in 0..3 {
                        out[first + 3 * i + c] = Vec3::unit(c) * -n;
                    }
                }
            }
            Carrier::Rigid(_) => {
                let arm = self.arm(jet.position);
                for c in 0..3 {
                    out[c] = -Vec3::unit(c);
                    // column c of [a]×
                    out[3 + c] = arm.cross(Vec3::unit(c));
                }
            }
            Carrier::Fixed => {}
        }
        for (i, n) in self.place.point.weights.iter().enumerate() {
            for c in 0..3 {
                out[self.ranges.point + 3 * i + c] = Vec3::unit(c) * *n;
            }
        }
    }

    /// B* along a free direction.
    fn change_of_operator(&self, free: &Free, out: &mut Columns) {
        match self.carrier {
            Carrier::Nodes(_) => {
                for i in 0..self.jet.nnode {
                    let d = self.jet.dshape[i];
                    for c in 0..3 {
                        let along = d[0] * free.local[0] + d[1] * free.local[1];
                        out[3 * i + c] = Vec3::unit(c) * -along;
                    }
                }
            }
            Carrier::Rigid(_) => {
                for c in 0..3 {
                    out[3 + c] = free.tangent.cross(Vec3::unit(c));
                }
            }
            Carrier::Fixed => {}
        }
    }

    fn fill(&self, number: usize, wanted: Wanted, out: &mut Rows) -> Result<(), SurfaceError> {
        let n = self.ranges.ncolumn;
        let found = self.place.found;
        let away = self.place.point.position(self.place.at) - self.jet.position;
        let on_face = found.feature == Feature::Face || found.held.is_some();
        let (gap, normal) = if on_face {
            let normal = found.held.unwrap_or(self.jet.normal);
            (away.dot(normal), normal)
        } else {
            let distance = away.norm();
            let gap = distance.copysign(found.gap);
            match away.normalized() {
                Some(direction) => (gap, direction * gap.signum()),
                None => return Ok(()),
            }
        };
        let row = out.push(number, wanted);
        row.gap = gap;
        row.normal = normal;
        if wanted.order == RowOrder::Gap || n > MAX_COLUMNS {
            return Ok(());
        }
        let mut n_star = [Vec3::ZERO; MAX_COLUMNS];
        self.operator(0, self.jet, &mut n_star);
        for (j, v) in n_star[..n].iter().enumerate() {
            row.gradient[j] = v.dot(normal); // (E2)
        }
        row.weights.copy_from_slice(&row.gradient);
        if wanted.slip {
            row.sliding.operator.copy_from_slice(&n_star[..n]);
        }
        if wanted.slip && self.place.bond {
            return self.bond(row, wanted.order);
        }
        if wanted.order == RowOrder::Tangent {
            self.tangent(&n_star, on_face, wanted.slip, row);
        }
        if wanted.slip {
            self.slip(row)?;
        }
        Ok(())
    }

    /// (E3) to (E6), and the turns of (E9).
    fn tangent(&self, n_star: &Columns, on_face: bool, slip: bool, row: &mut Row) {
        let n = self.ranges.ncolumn;
        let (gap, normal) = (row.gap, row.normal);
        let (free, nfree) = self.free();
        let free = &free[..nfree];
        let mut b_star = [[Vec3::ZERO; MAX_COLUMNS]; 2];
        for (b, f) in b_star.iter_mut().zip(free) {
            self.change_of_operator(f, b);
        }
        let mut metric = [0.0; 3];
        let mut kappa = [0.0; 3];
        for a in 0..nfree {
            for b in a..nfree {
                metric[pair(a, b)] = free[a].tangent.dot(free[b].tangent);
                kappa[pair(a, b)] = normal.dot(self.curvature(&free[a], &free[b]));
            }
        }
        let a: [f64; 3] = std::array::from_fn(|k| metric[k] - gap * kappa[k]);
        let (a_inverse, m_inverse) = (inverse(&a, nfree), inverse(&metric, nfree));
        let mut b: [Numbers; 2] = [[0.0; MAX_COLUMNS]; 2];
        let mut right = b;
        for (k, f) in free.iter().enumerate() {
            for j in 0..n {
                b[k][j] = b_star[k][j].dot(normal);
                right[k][j] = n_star[j].dot(f.tangent) - gap * b[k][j];
            }
        }
        let mut d: [Numbers; 2] = [[0.0; MAX_COLUMNS]; 2];
        let mut bar = d;
        for k in 0..nfree {
            for j in 0..n {
                d[k][j] = (0..nfree)
                    .map(|l| a_inverse[pair(k, l)] * right[l][j])
                    .sum(); // (E1)
            }
        }
        for k in 0..nfree {
            for j in 0..n {
                let bent: f64 = (0..nfree).map(|l| kappa[pair(k, l)] * d[l][j]).sum();
                bar[k][j] = b[k][j] - bent;
            }
        }
        for (i, line) in row.dweights.chunks_exact_mut(n).enumerate() {
            for k in 0..nfree {
                for (j, h) in line.iter_mut().enumerate() {
                    *h += b[k][i] * d[k][j] + d[k][i] * b[k][j]; // (E3)
                }
                for l in 0..nfree {
                    let (bend, metric) = (kappa[pair(k, l)], gap * m_inverse[pair(k, l)]);
                    for (j, h) in line.iter_mut().enumerate() {
                        *h += metric * bar[k][i] * bar[l][j] - bend * d[k][i] * d[l][j];
                    }
                }
            }
        }
        // I − ννᵀ − m^ab t_a t_bᵀ
        let mut across = Mat3::IDENTITY - Mat3::outer(normal, normal);
        if let [f] = free {
            across = across - Mat3::outer(f.tangent, f.tangent) * m_inverse[0];
        }
        if !on_face {
            for (i, line) in row.dweights.chunks_exact_mut(n).enumerate() {
                let left = across * n_star[i] / gap;
                for (h, v) in line.iter_mut().zip(n_star) {
                    *h += left.dot(*v); // (E4)
                }
            }
        }
        if let Carrier::Rigid(_) = self.carrier {
            let turn = Mat3::skew(normal) * Mat3::skew(self.arm(self.jet.position)); // (E5)
            for i in 0..3 {
                for j in 0..3 {
                    row.dweights[(3 + i) * n + 3 + j] -= turn.rows[i][j];
                }
            }
        }
        if !slip {
            return;
        }
        for j in 0..n {
            let mut turned = Vec3::ZERO;
            for k in 0..nfree {
                for l in 0..nfree {
                    turned += free[k].tangent * (m_inverse[pair(k, l)] * bar[l][j]); // (E6)
                }
            }
            if !on_face {
                turned += across * n_star[j] / gap;
            }
            row.sliding.dnormal[j] = turned;
        }
        for k in 0..nfree {
            let turn = row.sliding.push_turn(); // (E9)
            turn.across.copy_from_slice(&b_star[k][..n]);
            turn.along.copy_from_slice(&d[k][..n]);
        }
        self.turn_carrier(self.arm(self.jet.position), row);
    }

    /// −[t]×[a]× of (E9), linear in t.
    fn turn_carrier(&self, arm: Vec3, row: &mut Row) {
        if !matches!(self.carrier, Carrier::Rigid(_)) {
            return;
        }
        let arm = Mat3::skew(arm);
        for k in 0..3 {
            let turn = row.sliding.push_turn();
            for i in 0..3 {
                turn.across[3 + i] = Vec3::unit(i).cross(Vec3::unit(k));
                turn.along[3 + i] = arm.rows[k][i];
            }
        }
    }

    /// (E7) and (E8).
    fn slip(&self, row: &mut Row) -> Result<(), SurfaceError> {
        let Some(anchor) = self.place.anchor else {
            return Ok(());
        };
        let mut operator = [Vec3::ZERO; MAX_COLUMNS];
        let e0 = self.stretch(anchor, &mut operator)?.0;
        let normal = row.normal;
        let deep = normal.dot(e0);
        row.sliding.slip = e0 - normal * deep;
        let sliding = &mut row.sliding;
        let columns = operator.iter().zip(&sliding.dnormal);
        for ((&v, &turned), to) in columns.zip(&mut sliding.dslip) {
            *to = v - normal * normal.dot(v) - turned * deep - normal * e0.dot(turned);
        }
        Ok(())
    }

    /// (E10).
    fn bond(&self, row: &mut Row, order: RowOrder) -> Result<(), SurfaceError> {
        let Some(anchor) = self.place.anchor else {
            return Ok(());
        };
        let mut operator = [Vec3::ZERO; MAX_COLUMNS];
        let (e0, position) = self.stretch(anchor, &mut operator)?;
        row.sliding.slip = e0;
        let n = self.ranges.ncolumn;
        row.sliding.dslip.copy_from_slice(&operator[..n]);
        row.sliding.operator.copy_from_slice(&operator[..n]);
        if order == RowOrder::Tangent {
            self.turn_carrier(self.arm(position), row);
        }
        Ok(())
    }

    /// e₀, N_a, and the place of the anchor.
    fn stretch(
        &self,
        anchor: &Anchored,
        operator: &mut Columns,
    ) -> Result<(Vec3, Vec3), SurfaceError> {
        let Place {
            surface, at, point, ..
        } = self.place;
        let mut jet = SurfaceJet::default();
        surface.jet(at, &anchor.anchor, &mut jet)?;
        self.operator(self.ranges.anchor, &jet, operator);
        Ok((
            point.position(at) - jet.position - anchor.offset,
            jet.position,
        ))
    }
}

/// The inverse of a symmetric matrix `(11, 22, 12)` of the first `n` directions.
fn inverse(m: &[f64; 3], n: usize) -> [f64; 3] {
    match n {
        0 => [0.0; 3],
        1 => [m[0].recip(), 0.0, 0.0],
        _ => {
            let det = m[0] * m[1] - m[2] * m[2];
            [m[1] / det, m[0] / det, -m[2] / det]
        }
    }
}
