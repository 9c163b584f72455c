//! Nodes against nodes.
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | r, x | secondary and primary node | vectors |
//! | n = Σ t1 × t2, ν = n/|n| | `sum`, `normal` | over the facets around a node; or given |
//! | N* = [−I, I] | | on x and r |
//!
//! ```text
//! g = (r − x)·ν,   ∂g/∂d = N*ᵀν + (∂ν/∂d)ᵀ(r − x),   b = N*ᵀν,   ∂b/∂d = N*ᵀ ∂ν/∂d                 (E1)
//! ∂ν/∂d = (I − ννᵀ) ∂n/∂d / |n|,   ∂n/∂x_k = Σ [t1]× N_k,2 − [t2]× N_k,1                          (E2)
//! e = P (r − x − o)                                                                           (E3)
//! ```
//!
//! The averaged normal turns with the side it belongs to. Forces balance exactly; their moments up to the distance of
//! the two nodes along the tangent, times the pressure. Where the normal is averaged, `b` is not `∂g/∂d` and the
//! tangent is unsymmetric. Limits: sliding by more than a part of an element makes the pairs, which are fixed, wrong.
//! Sources: Wriggers 2006, section 8.1.

use super::projected::Point;
use super::{
    Anchored, Averaged, Capabilities, Discretization, Links, Pair, Pairing, Renewable, SurfacePair,
};
use crate::contact::row::{Participant, Row, RowOrder, Rows, Wanted};
use signorini_geometry::element::Element;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::{Aabb, Search};
use signorini_geometry::surface::{
    Anchor, Carrier, ContactSurface, Facets, Feature, Outward, Placement, Projection, SurfaceError,
    SurfaceJet,
};
use signorini_geometry::tensor::Vec3;

/// Where normals come from.
pub enum NodeNormals {
    /// Fixed in space, a unit vector from the primary to the secondary side.
    Given(Vec3),
    /// The average at the primary nodes, over these facets.
    Primary(Facets),
    /// The opposite of the average at the secondary nodes, over these facets.
    Secondary(Facets),
}

/// Pairs of nodes.
pub struct NodeToNode {
    // secondary, primary
    pairs: Vec<[NodeId; 2]>,
    normals: NodeNormals,
    // facets around the node that has the normal, and its place in them
    around: Vec<Vec<(u32, usize)>>,
    // the two nodes first, then all nodes of those facets
    nodes: Vec<Vec<NodeId>>,
}

impl NodeToNode {
    /// Contact between the nodes of each pair, secondary and primary.
    #[must_use]
    pub fn new(pairs: Vec<[NodeId; 2]>, normals: NodeNormals) -> Self {
        let (facets, which) = match &normals {
            NodeNormals::Given(_) => (None, 0),
            NodeNormals::Primary(facets) => (Some(facets), 1),
            NodeNormals::Secondary(facets) => (Some(facets), 0),
        };
        let mut around = Vec::new();
        let mut nodes = Vec::new();
        for pair in &pairs {
            let mut of_pair = pair.to_vec();
            let mut near = Vec::new();
            if let Some(facets) = facets {
                for facet in 0..facets.nfacet() as u32 {
                    let of_facet = facets.nodes(facet);
                    if let Some(place) = of_facet.iter().position(|n| *n == pair[which]) {
                        near.push((facet, place));
                        of_pair.extend(of_facet);
                    }
                }
            }
            of_pair[2..].sort_unstable();
            let (both, rest) = of_pair.split_at(2);
            let mut all = both.to_vec();
            for node in rest {
                if !all.contains(node) {
                    all.push(*node);
                }
            }
            around.push(near);
            nodes.push(all);
        }
        Self {
            pairs,
            normals,
            around,
            nodes,
        }
    }

    /// The normal of a row, and where it is not given the sum n with its sign.
    fn normal(&self, row: usize, at: &Placement) -> Result<(Vec3, f64), SurfaceError> {
        let (facets, sign) = match &self.normals {
            NodeNormals::Given(normal) => return Ok((*normal, 0.0)),
            NodeNormals::Primary(facets) => (facets, 1.0),
            NodeNormals::Secondary(facets) => (facets, -1.0),
        };
        let mut sum = Vec3::ZERO;
        let mut jet = SurfaceJet::default();
        for &(facet, place) in self.around.get(row).into_iter().flatten() {
            self.at_node(facets, facet, place, at, &mut jet)?;
            sum += tangents(&jet, facets).0.cross(tangents(&jet, facets).1);
        }
        let facet = self.around.get(row).and_then(|a| a.first());
        let facet = facet.map_or(0, |a| a.0);
        let normal = sum.normalized().ok_or(SurfaceError::Degenerate { facet })?;
        Ok((normal * sign, sign / sum.norm()))
    }

    fn at_node(
        &self,
        facets: &Facets,
        facet: u32,
        place: usize,
        at: &Placement,
        jet: &mut SurfaceJet,
    ) -> Result<(), SurfaceError> {
        let missing = SurfaceError::NoSuchFacet { facet };
        let element = facets.element(facet).ok_or(missing.clone())?;
        let local = *element.nodes().get(place).ok_or(missing)?;
        facets.jet(at, &Anchor { facet, local }, jet)
    }

    /// (E2)
    fn turned(
        &self,
        row: usize,
        at: &Placement,
        normal: Vec3,
        scale: f64,
        out: &mut [Vec3],
    ) -> Result<(), SurfaceError> {
        let (NodeNormals::Primary(facets) | NodeNormals::Secondary(facets)) = &self.normals else {
            return Ok(());
        };
        let (Some(around), Some(nodes)) = (self.around.get(row), self.nodes.get(row)) else {
            return Ok(());
        };
        let mut jet = SurfaceJet::default();
        for &(facet, place) in around {
            self.at_node(facets, facet, place, at, &mut jet)?;
            let (t1, t2) = tangents(&jet, facets);
            for (k, node) in facets.nodes(facet).iter().enumerate() {
                let Some(column) = nodes.iter().position(|n| n == node) else {
                    continue;
                };
                let d = jet.dshape[k];
                for c in 0..3 {
                    let unit = Vec3::unit(c);
                    let mut change = unit.cross(t2) * d[0];
                    if facets.ntan() == 2 {
                        change += t1.cross(unit) * d[1];
                    }
                    let across = change - normal * normal.dot(change);
                    out[3 * column + c] += across * scale;
                }
            }
        }
        Ok(())
    }
}

/// t1 and t2 of a facet; e_z is the second in the plane.
fn tangents(jet: &SurfaceJet, facets: &Facets) -> (Vec3, Vec3) {
    match facets.ntan() {
        1 => (jet.tangent[0], Vec3::unit(2)),
        _ => (jet.tangent[0], jet.tangent[1]),
    }
}

const ONE: [f64; 1] = [1.0];

/// The surface of nodes that have no facets: nothing is near it.
pub struct Nowhere {
    /// Dimension of a surface here.
    pub ntan: usize,
}

impl ContactSurface for Nowhere {
    fn ntan(&self) -> usize {
        self.ntan
    }

    fn nfacet(&self) -> usize {
        0
    }

    fn carrier(&self, _: u32) -> Carrier<'_> {
        Carrier::Fixed
    }

    fn aabb(&self, _: &Placement, _: u32) -> Aabb {
        Aabb::EMPTY
    }

    fn size(&self, _: &Placement, _: u32) -> f64 {
        0.0
    }

    fn jet(&self, _: &Placement, at: &Anchor, _: &mut SurfaceJet) -> Result<(), SurfaceError> {
        Err(SurfaceError::NoSuchFacet { facet: at.facet })
    }

    fn domain(&self, _: u32) -> Option<Element> {
        None
    }

    fn neighbours(&self, _: u32) -> &[u32] {
        &[]
    }

    fn crossing(&self, _: &Placement, _: u32, _: Vec3, _: Vec3) -> Option<f64> {
        None
    }

    fn outward(&self, _: &Placement, found: &Projection) -> Result<Outward, SurfaceError> {
        Err(SurfaceError::NoSuchFacet {
            facet: found.anchor.facet,
        })
    }

    fn project(
        &self,
        _: &Placement,
        _: u32,
        _: Vec3,
        _: Option<Anchor>,
        _: &mut SurfaceJet,
    ) -> Result<Option<Projection>, SurfaceError> {
        Ok(None)
    }
}

impl Discretization for NodeToNode {
    fn nrow(&self) -> usize {
        self.pairs.len()
    }

    fn point(&self, row: usize) -> Point<'_> {
        Point {
            nodes: self.pairs.get(row).map_or(&[], |p| &p[..1]),
            weights: &ONE,
            all: self.nodes.get(row).map_or(&[], Vec::as_slice),
        }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            is_symmetric: matches!(self.normals, NodeNormals::Given(_)),
            ..Capabilities::default()
        }
    }

    fn averaged_mut(&mut self) -> Option<&mut dyn Averaged> {
        None
    }

    fn renewable_mut(&mut self) -> Option<&mut dyn Renewable> {
        None
    }

    fn pair_up(
        &self,
        _: &SurfacePair,
        at: &Placement,
        _: &Search,
        _: &Pairing,
        _: RowOrder,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError> {
        out.pairs.clear();
        let place = |n: NodeId| at.x.get(n as usize).copied().unwrap_or_default();
        for (row, &[secondary, primary]) in self.pairs.iter().enumerate() {
            let (normal, _) = self.normal(row, at)?;
            out.pairs.push(Some(Pair {
                anchor: Anchor {
                    facet: 0,
                    local: Vec3::ZERO,
                },
                feature: Feature::Vertex,
                gap: (place(secondary) - place(primary)).dot(normal),
                held: None,
            }));
        }
        Ok(())
    }

    fn row(
        &self,
        row: usize,
        _: &SurfacePair,
        at: &Placement,
        links: &Links<'_>,
        wanted: Wanted,
        out: &mut Rows,
    ) -> Result<(), SurfaceError> {
        let (Some(&[secondary, primary]), Some(nodes)) = (self.pairs.get(row), self.nodes.get(row))
        else {
            out.start([]);
            return Ok(());
        };
        out.start(nodes.iter().map(|&n| Participant::Node(n)));
        out.set_secondary(0..1);
        let place = |n: NodeId| at.x.get(n as usize).copied().unwrap_or_default();
        let away = place(secondary) - place(primary);
        let (normal, scale) = self.normal(row, at)?;
        let anchor = links.anchors.get(row).copied().flatten();
        let into = out.push(row, wanted);
        into.gap = away.dot(normal);
        into.normal = normal;
        if wanted.order == RowOrder::Gap {
            return Ok(());
        }
        self.turned(row, at, normal, scale, &mut into.sliding.dnormal)?;
        fill(into, away, anchor, links.bond, wanted);
        Ok(())
    }

    fn anchor(
        &self,
        row: usize,
        _: &SurfacePair,
        at: &Placement,
        _: &Pair,
        slip: Vec3,
    ) -> Result<Anchored, SurfaceError> {
        let place = |n: NodeId| at.x.get(n as usize).copied().unwrap_or_default();
        let away = self.pairs.get(row).map(|&[s, p]| place(s) - place(p));
        Ok(Anchored {
            anchor: Anchor {
                facet: 0,
                local: Vec3::ZERO,
            },
            offset: away.unwrap_or_default() - slip,
        })
    }
}

/// (E1) and (E3). The columns of the two nodes come first.
fn fill(row: &mut Row, away: Vec3, anchor: Option<Anchored>, bond: bool, wanted: Wanted) {
    let normal = row.normal;
    let sliding = &mut row.sliding;
    let dnormal = &sliding.dnormal;
    let n = row.gradient.len();
    let operator = |j: usize| match j {
        0..3 => Vec3::unit(j),
        3..6 => -Vec3::unit(j - 3),
        _ => Vec3::ZERO,
    };
    for (j, &turned) in dnormal.iter().enumerate() {
        row.weights[j] = operator(j).dot(normal);
        row.gradient[j] = row.weights[j] + away.dot(turned);
    }
    if wanted.order == RowOrder::Tangent {
        for (i, line) in row.dweights.chunks_exact_mut(n).take(6).enumerate() {
            for (to, turned) in line.iter_mut().zip(dnormal) {
                *to = operator(i).dot(*turned);
            }
        }
    }
    if !wanted.slip {
        return;
    }
    let e0 = away - anchor.map_or(away, |a| a.offset);
    let deep = normal.dot(e0);
    sliding.slip = if bond { e0 } else { e0 - normal * deep };
    for j in 0..n {
        let (v, turned) = (operator(j), sliding.dnormal[j]);
        sliding.operator[j] = v;
        sliding.dslip[j] = if bond {
            v
        } else {
            v - normal * normal.dot(v) - turned * deep - normal * e0.dot(turned)
        };
    }
}
