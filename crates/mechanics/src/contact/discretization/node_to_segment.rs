//! Nodes of the secondary side against facets of the primary side.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | r, ρ, w = r − ρ | `point`, `position`, `away` | vectors |
//! | t_a, m_ab, κ_ab = ν·ρ_,ab | `tangent`, `metric`, `kappa` | over the free directions |
//! | N* = ∂w/∂d at fixed ξ | `n_star` | a vector for each column |
//! | B*_a = ∂N*/∂ξ^a | `b_star` | a vector for each column |
//! | T_a = N*ᵀt_a, B_a = B*_aᵀν | `t`, `b` | a number for each column |
//!
//! A closest point is free to move along both tangents of a face, along an edge, or not at all on a vertex; with the
//! sums running over the free directions only, all three are one formula. The projection condition `w·t_a = 0` gives
//!
//! ```text
//! A_ab = m_ab − g κ_ab,   δξ^a = D_a·δd,   D_a = A⁻¹_ab (T_b − g B_b)                          (E1)
//! ∂g/∂d = N*ᵀν                                                                                (E2)
//! ∂²g/∂d² = B_a D_aᵀ + D_a B_aᵀ − κ_ab D_a D_bᵀ + g m^ab B̄_a B̄_bᵀ,   B̄_a = B_a − κ_ab D_b     (E3)
//!         + (1/g) N*ᵀ (I − ννᵀ − m^ab t_a t_bᵀ) N*     on edges and vertices, where ν = w/g      (E4)
//! ```
//!
//! For a rigid carrier with arm `a`, `N* = [−I, [a]×, I]`, `B*_a = [0, [t_a]×, 0]`, and the rotation itself adds
//! `−[ν]×[a]×` to (E3) (E5). The one sign of κ in (E1) fixes both signs in (E3): printed tangents in the literature
//! that combine `m − gκ` with `+κ D D` are wrong on curved facets, and a test of this room shows it.
//!
//! Where the primary surface ends, a point that is just past the rim (by [`RIM`]) still rests on the continuation of
//! the facet, or of the valley that ends there; further out it is free. Facets are compared over their whole
//! neighbourhood: the smallest distance wins, then the face over the edge over the vertex, then the lower number.
//!
//! Limits: `w = 0` on an edge or vertex has no normal and counts as open; a node that lies deeper in the body than
//! half its thickness is pushed out at the wrong side. Sources: Wriggers 2006, section 6.3; Konyukhov and
//! Schweizerhof 2013, chapter 5.

use super::{Discretization, Pair, Pairing, RowOrder, SurfacePair};
use crate::contact::row::{Participant, Rows};
use rayon::prelude::*;
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::proximity::Candidates;
use signorini_geometry::surface::{
    Anchor, Carrier, ContactSurface, Feature, Placement, Projection, SurfaceError, SurfaceJet,
    extended_edge, extended_face, pair,
};
use signorini_geometry::tensor::{Mat3, Vec3};

/// How far past the rim of a surface, in parameters of the facet, a point still rests on it: nodes at the common
/// boundary of two stacked bodies must not lose contact by a lateral strain of some per cent.
pub const RIM: f64 = 0.05;

/// Relative difference below which two distances are equal.
const TIE: f64 = 1e-12;

/// Columns of a facet and a node, at most.
const MAX_COLUMNS: usize = 3 * (MAX_FACET_NODES + 1);

/// Every node of the secondary side against the closest facet.
#[derive(Debug)]
pub struct NodeToSegment {
    npoint: usize,
}

impl NodeToSegment {
    /// For a pair with this many secondary nodes.
    #[must_use]
    pub const fn new(npoint: usize) -> Self {
        Self { npoint }
    }
}

impl Discretization for NodeToSegment {
    fn nrow(&self) -> usize {
        self.npoint
    }

    fn point(&self, row: usize, pair: &SurfacePair, at: &Placement) -> Vec3 {
        let node = pair.points.get(row).copied().unwrap_or_default();
        at.x.get(node as usize).copied().unwrap_or_default()
    }

    fn pair_up(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        near: &Candidates,
        last: &Pairing,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError> {
        out.pairs.resize(self.npoint, None);
        let surface = pair.primary.as_ref();
        let choose = |row: usize, found: &mut Option<Pair>| {
            let hint = last.pairs.get(row).copied().flatten().map(|p| p.anchor);
            let point = self.point(row, pair, at);
            *found = closest(surface, at, point, near.near(row), hint, pair.reach)?;
            Ok(())
        };
        out.pairs
            .par_iter_mut()
            .enumerate()
            .with_min_len(64)
            .map(|(row, found)| choose(row, found))
            .collect()
    }

    fn ngroup(&self, _: &Pairing) -> usize {
        self.npoint
    }

    fn rows(
        &self,
        group: usize,
        pair: &SurfacePair,
        at: &Placement,
        pairing: &Pairing,
        order: RowOrder,
        out: &mut Rows,
    ) -> Result<(), SurfaceError> {
        let (Some(Some(found)), Some(&node)) = (pairing.pairs.get(group), pair.points.get(group))
        else {
            out.start([]);
            return Ok(());
        };
        let surface = pair.primary.as_ref();
        let carrier = surface.carrier(found.anchor.facet);
        let moved = carried_by(carrier);
        out.start(moved.chain([Participant::Node(node)]));
        let mut jet = SurfaceJet::default();
        surface.jet(at, &found.anchor, &mut jet)?;
        let point = self.point(group, pair, at);
        let place = Place {
            jet: &jet,
            carrier,
            found,
            point,
            at,
            ntan: surface.ntan(),
        };
        place.fill(group, order, out);
        Ok(())
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

/// The closest of the near facets.
fn closest(
    surface: &dyn ContactSurface,
    at: &Placement,
    point: Vec3,
    near: &[u32],
    hint: Option<Anchor>,
    reach: f64,
) -> Result<Option<Pair>, SurfaceError> {
    let rank = |f: &Feature| match f {
        Feature::Face => 0,
        Feature::Edge { .. } => 1,
        Feature::Vertex => 2,
    };
    let mut jet = SurfaceJet::default();
    let mut best: Option<(Projection, f64)> = None;
    for &facet in near {
        if let Some((b, tie)) = &best {
            let reach = b.distance + tie;
            if surface.aabb(at, facet).distance_squared(point) > reach * reach {
                continue;
            }
        }
        let Some(found) = surface.project(at, facet, point, hint, &mut jet)? else {
            continue;
        };
        let tie = TIE * (jet.metric[0].max(jet.metric[1])).sqrt();
        let better = best.as_ref().is_none_or(|(b, tie)| {
            let closer = b.distance - found.distance;
            closer > *tie || (closer >= -tie && rank(&found.feature) < rank(&b.feature))
        });
        if better {
            best = Some((found, tie));
        }
    }
    // candidates further away than the reach may be there or not; results must not depend on them
    let Some((mut found, _)) = best.filter(|(b, _)| b.distance <= reach) else {
        return Ok(None);
    };
    let mut outward = surface.outward(at, &found)?;
    if outward.rim
        && found.feature == Feature::Vertex
        && let Some(edge) = extended_edge(surface, at, found.anchor, point, RIM, &mut jet)?
    {
        found = edge;
        outward = surface.outward(at, &found)?;
    }
    if outward.rim {
        let extended = extended_face(surface, at, found.anchor, point, RIM, &mut jet)?;
        return Ok(extended.map(|e| Pair {
            anchor: e.anchor,
            feature: Feature::Face,
            gap: (point - jet.position).dot(jet.normal),
        }));
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
    }))
}

/// A point and its closest point, ready to be linearized.
struct Place<'a> {
    jet: &'a SurfaceJet,
    carrier: Carrier<'a>,
    found: &'a Pair,
    point: Vec3,
    at: &'a Placement<'a>,
    ntan: usize,
}

/// A direction along which the closest point may move.
#[derive(Clone, Copy, Default)]
struct Free {
    tangent: Vec3,
    // direction in the parameters
    local: [f64; 2],
}

impl Place<'_> {
    fn free(&self) -> ([Free; 2], usize) {
        let along = |local: [f64; 2]| Free {
            tangent: self.jet.tangent[0] * local[0] + self.jet.tangent[1] * local[1],
            local,
        };
        match self.found.feature {
            Feature::Face => ([along([1.0, 0.0]), along([0.0, 1.0])], self.ntan),
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

    /// N* and, for each free direction, B*: a vector for each column.
    fn operators(&self, free: &[Free], n_star: &mut [Vec3], b_star: &mut [[Vec3; MAX_COLUMNS]; 2]) {
        let mut column = 0;
        match self.carrier {
            Carrier::Nodes(_) => {
                for i in 0..self.jet.nnode {
                    for c in 0..3 {
                        n_star[column] = Vec3::unit(c) * -self.jet.shape[i];
                        for (b, f) in b_star.iter_mut().zip(free) {
                            let d = self.jet.dshape[i];
                            b[column] = Vec3::unit(c) * -(d[0] * f.local[0] + d[1] * f.local[1]);
                        }
                        column += 1;
                    }
                }
            }
            Carrier::Rigid(_) => {
                for c in 0..3 {
                    n_star[column + c] = -Vec3::unit(c);
                    // column c of [a]×
                    n_star[column + 3 + c] = self.arm().cross(Vec3::unit(c));
                    for (b, f) in b_star.iter_mut().zip(free) {
                        b[column + c] = Vec3::ZERO;
                        b[column + 3 + c] = f.tangent.cross(Vec3::unit(c));
                    }
                }
                column += 6;
            }
            Carrier::Fixed => {}
        }
        for c in 0..3 {
            n_star[column + c] = Vec3::unit(c);
            for b in b_star.iter_mut() {
                b[column + c] = Vec3::ZERO;
            }
        }
    }

    fn arm(&self) -> Vec3 {
        match self.carrier {
            Carrier::Rigid(body) => {
                let pose = self.at.poses.get(body as usize);
                pose.map_or(Vec3::ZERO, |p| self.jet.position - p.origin)
            }
            _ => Vec3::ZERO,
        }
    }

    fn fill(&self, number: usize, order: RowOrder, out: &mut Rows) {
        let n = out.ncolumn();
        let away = self.point - self.jet.position;
        let on_face = self.found.feature == Feature::Face;
        let (gap, normal) = if on_face {
            (away.dot(self.jet.normal), self.jet.normal)
        } else {
            let distance = away.norm();
            let gap = distance.copysign(self.found.gap);
            match away.normalized() {
                Some(direction) => (gap, direction * gap.signum()),
                None => return,
            }
        };
        let row = out.push(number, order == RowOrder::Tangent);
        row.gap = gap;
        row.normal = normal;
        if order == RowOrder::Gap || n > MAX_COLUMNS {
            return;
        }

        let (free, nfree) = self.free();
        let free = &free[..nfree];
        let mut n_star = [Vec3::ZERO; MAX_COLUMNS];
        let mut b_star = [[Vec3::ZERO; MAX_COLUMNS]; 2];
        self.operators(free, &mut n_star, &mut b_star);
        for (j, v) in n_star[..n].iter().enumerate() {
            row.gradient[j] = v.dot(normal); // (E2)
        }
        row.weights.copy_from_slice(&row.gradient);
        if order != RowOrder::Tangent {
            return;
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
        let mut b = [[0.0; MAX_COLUMNS]; 2];
        let mut right = [[0.0; MAX_COLUMNS]; 2];
        for (k, f) in free.iter().enumerate() {
            for j in 0..n {
                b[k][j] = b_star[k][j].dot(normal);
                right[k][j] = n_star[j].dot(f.tangent) - gap * b[k][j];
            }
        }
        let mut d = [[0.0; MAX_COLUMNS]; 2];
        let mut bar = [[0.0; MAX_COLUMNS]; 2];
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
        if !on_face {
            // I − ννᵀ − m^ab t_a t_bᵀ (E4)
            let mut across = Mat3::IDENTITY - Mat3::outer(normal, normal);
            if let [f] = free {
                across = across - Mat3::outer(f.tangent, f.tangent) * m_inverse[0];
            }
            for (i, line) in row.dweights.chunks_exact_mut(n).enumerate() {
                let left = across * n_star[i] / gap;
                for (h, v) in line.iter_mut().zip(&n_star) {
                    *h += left.dot(*v);
                }
            }
        }
        if let Carrier::Rigid(_) = self.carrier {
            let turn = Mat3::skew(normal) * Mat3::skew(self.arm()); // (E5)
            for i in 0..3 {
                for j in 0..3 {
                    row.dweights[(3 + i) * n + 3 + j] -= turn.rows[i][j];
                }
            }
        }
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
