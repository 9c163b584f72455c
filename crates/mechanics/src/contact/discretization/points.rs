//! Points of the secondary side, its nodes or points inside its facets, against segments of the primary side. They
//! differ in nothing but the points.

use super::capabilities::SlidingRange;
use super::cut::{Cutter, FacetPoints};
use super::on_facet::OnFacet;
use super::projected::{Closest, Place, Point, Sight, closest};
use super::{
    Anchored, Averaged, BentSides, Capabilities, Curved, Discretization, Links, OwnNow, Pair,
    Pairing, Renewable, SurfacePair,
};
use crate::contact::row::{RowOrder, Rows, Wanted};
use rayon::prelude::*;
use signorini_geometry::element::{Element, MAX_FACET_NODES};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{
    ContactSurface, Extent, Facets, Feature, Placement, SurfaceError, SurfaceJet, extended_face,
};
use signorini_geometry::tensor::Vec3;

/// The points of all facets, cut at these positions, facet after facet.
fn pieces(cutter: &Cutter, facets: &Facets, x: &[Vec3]) -> Vec<OnFacet> {
    let mut points = Vec::new();
    for (cut, facet) in cutter.points(facets, x).into_iter().zip(0..) {
        let of = |apart| move |point| OnFacet::new(facet, point, apart);
        points.extend(cut.met.into_iter().map(of(false)));
        points.extend(cut.apart.into_iter().map(of(true)));
    }
    points
}

/// Numbers of a point inside a facet, in a checkpoint.
const STORED: usize = 6;

/// The area of each point inside facets at the positions `x`, times the `extent` across its facet.
///
/// # Errors
/// A facet that has no normal.
pub fn areas_inside(
    facets: &Facets,
    points: &[OnFacet],
    x: &[Vec3],
    extent: &Extent<'_>,
) -> Result<Vec<f64>, SurfaceError> {
    let area = |point: &OnFacet| {
        let (shape, area) = facets.sample(x, point.facet, point.xi)?;
        let nodes = facets.nodes(point.facet).iter().zip(shape);
        let at: Vec3 = nodes
            .map(|(&n, w)| x.get(n as usize).copied().unwrap_or_default() * w)
            .sum();
        Ok(point.weight * area * extent(point.facet, &shape, at))
    };
    points.iter().map(area).collect()
}

/// Every point of the secondary side against the closest facet.
#[derive(Default)]
pub struct PointToSegment {
    // nodes of point k: nodes[first[k]..first[k + 1]]
    first: Vec<u32>,
    nodes: Vec<NodeId>,
    weights: Vec<f64>,
    /// Where each point is inside a facet; `None` where points are nodes.
    inside: Option<Vec<OnFacet>>,
    /// Makes the points again in each increment.
    cutter: Option<Cutter>,
    /// On what closest points may lie.
    pub closest: Closest,
    /// How long points keep the tangent plane that they meet.
    pub sliding: SlidingRange,
    /// The shift of the gap of each row; empty where there is none.
    shifts: Vec<f64>,
}

/// How far a point that slips may leave the facet it is on, in parameters of the facet, within one increment.
const FAR: f64 = 10.0;

impl PointToSegment {
    /// Every node is a point.
    #[must_use]
    pub fn at_nodes(nodes: &[NodeId]) -> Self {
        Self {
            first: (0..=nodes.len() as u32).collect(),
            nodes: nodes.to_vec(),
            weights: vec![1.0; nodes.len()],
            ..Self::default()
        }
    }

    /// A further row, whose point is a sum of nodes with these factors; `shift` is added to its gap.
    pub fn push_row(&mut self, point: &[(NodeId, f64)], shift: f64) {
        if self.first.is_empty() {
            self.first.push(0);
        }
        self.nodes.extend(point.iter().map(|of| of.0));
        self.weights.extend(point.iter().map(|of| of.1));
        self.first.push(self.nodes.len() as u32);
        self.shifts.push(shift);
    }

    /// The shift of the gap of a row.
    fn shift(&self, row: usize) -> f64 {
        self.shifts.get(row).copied().unwrap_or_default()
    }

    /// Points inside the facets; `points` gives those of an element.
    #[must_use]
    pub fn inside(facets: &Facets, points: impl Fn(Element) -> FacetPoints) -> Self {
        let mut found = Vec::new();
        for facet in 0..facets.nfacet() as u32 {
            let of_facet = facets.element(facet).map(&points);
            let inside = of_facet.into_iter().flatten();
            found.extend(inside.map(|point| OnFacet::new(facet, point, false)));
        }
        let mut rows = Self::default();
        rows.place(facets, found);
        rows
    }

    /// Points inside facets that are cut, those of each increment where its tangent planes are those at its start.
    #[must_use]
    pub fn pieces(facets: &Facets, cutter: Cutter, x: &[Vec3]) -> Self {
        let mut rows = Self::default();
        rows.place(facets, pieces(&cutter, facets, x));
        rows.cutter = Some(cutter);
        rows
    }

    /// Where each point is inside a facet; `None` where points are nodes.
    #[must_use]
    pub fn on_facets(&self) -> Option<&[OnFacet]> {
        self.inside.as_deref()
    }

    /// Has these points inside facets from now on.
    fn place(&mut self, facets: &Facets, inside: Vec<OnFacet>) {
        self.first.clear();
        self.first.push(0);
        self.nodes.clear();
        self.weights.clear();
        for point in &inside {
            let nodes = facets.nodes(point.facet);
            let mut shape = [0.0; MAX_FACET_NODES];
            if let (Some(element), Some(shape)) =
                (facets.element(point.facet), shape.get_mut(..nodes.len()))
            {
                element.shape(&point.xi, shape);
                self.nodes.extend_from_slice(nodes);
                self.weights.extend_from_slice(shape);
            }
            self.first.push(self.nodes.len() as u32);
        }
        self.inside = Some(inside);
    }
}

impl PointToSegment {
    /// The normal of a tangent plane that a point keeps, where it meets a facet with this one.
    fn kept(&self, row: usize, pair: &SurfacePair, at: &Placement, normal: Vec3) -> Vec3 {
        match (&pair.lean, &pair.secondary) {
            (Some(lean), Some(facets)) if self.sliding == SlidingRange::Small => {
                lean.normal(row, facets, at, normal)
            }
            _ => normal,
        }
    }

    /// Pairs the point of a row with one of the facets near it. `before` is its previous pair, and `own` holds the normals and
    /// thickness of a surface that may touch itself.
    ///
    /// # Errors
    /// A facet that has no normal.
    pub fn meet(
        &self,
        row: usize,
        (pair, own): (&SurfacePair, Option<&OwnNow>),
        at: &Placement,
        near: &[u32],
        before: Option<Pair>,
    ) -> Result<Option<Pair>, SurfaceError> {
        let inside = self.inside.as_ref().and_then(|points| points.get(row));
        if self.sliding == SlidingRange::Increment && inside.is_some_and(|point| point.apart) {
            return Ok(None);
        }
        let surface = pair.primary.as_ref();
        let point = self.point(row).position(at);
        let mut jet = SurfaceJet::default();
        if let Some(kept) = before.filter(|p| p.held.is_some()) {
            surface.jet(at, &kept.anchor, &mut jet)?;
            let normal = kept.held.unwrap_or_default();
            return Ok(Some(Pair {
                gap: (point - jet.position).dot(normal) + self.shift(row),
                ..kept
            }));
        }
        let nodes = self.point(row).nodes;
        let deepest = |facet| pair.deepest_from(nodes, inside, facet, at);
        let sight = Sight {
            hint: before.map(|p| p.anchor),
            on: self.closest,
            reach: &|facet| pair.reach_of_row(self, row, facet, at),
            deepest: pair.wall.is_some().then_some(&deepest),
            own: own.and_then(|now| pair.own_point(self.point(row).nodes, inside, now)),
        };
        let mut found = closest(surface, at, point, near, &sight)?;
        if let Some(found) = found
            .as_mut()
            .filter(|_| self.sliding != SlidingRange::Finite)
        {
            surface.jet(at, &found.anchor, &mut jet)?;
            let away = point - jet.position;
            let normal = match found.feature {
                Feature::Face => self.kept(row, pair, at, jet.normal),
                _ => away
                    .normalized()
                    .map_or(jet.normal, |n| n * found.gap.signum()),
            };
            found.held = Some(normal);
            if found.feature == Feature::Face {
                found.gap = away.dot(normal);
            }
        }
        if let Some(found) = found.as_mut() {
            found.gap += self.shift(row);
        }
        Ok(found)
    }
}

impl Discretization for PointToSegment {
    fn nrow(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    fn point(&self, row: usize) -> Point<'_> {
        let range = match self.first.get(row..) {
            Some([a, b, ..]) => *a as usize..*b as usize,
            _ => 0..0,
        };
        Point {
            nodes: self.nodes.get(range.clone()).unwrap_or(&[]),
            weights: self.weights.get(range).unwrap_or(&[]),
            all: &[],
        }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            is_symmetric: true,
            sliding: self.sliding,
            rests_on_edges: matches!(self.closest, Closest::Anywhere | Closest::Rims),
            inside: self.on_facets(),
            averaged: None,
            curved: Some(self),
            renewable: self.cutter.as_ref().map(|_| self as &dyn Renewable),
        }
    }

    fn averaged_mut(&mut self) -> Option<&mut dyn Averaged> {
        None
    }

    fn renewable_mut(&mut self) -> Option<&mut dyn Renewable> {
        self.cutter.is_some().then_some(self)
    }

    fn pair_up(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        near: &Search,
        last: &Pairing,
        _: RowOrder,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError> {
        out.pairs.resize(self.nrow(), None);
        let own = pair.own.as_ref();
        let own = own.map(|own| own.at(pair.primary.as_ref(), at));
        let choose = |row: usize, found: &mut Option<Pair>| {
            let before = last.pairs.get(row).copied().flatten();
            let near = near.candidates().near(row);
            *found = self.meet(row, (pair, own.as_ref()), at, near, before)?;
            Ok(())
        };
        out.pairs
            .par_iter_mut()
            .enumerate()
            .with_min_len(64)
            .map(|(row, found)| choose(row, found))
            .collect()
    }

    fn row(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        links: &Links<'_>,
        wanted: Wanted,
        out: &mut Rows,
    ) -> Result<(), SurfaceError> {
        let Some(Some(found)) = links.pairing.pairs.get(row) else {
            out.start([]);
            return Ok(());
        };
        let place = Place {
            surface: pair.primary.as_ref(),
            at,
            point: self.point(row),
            found,
            anchor: links.anchors.get(row).and_then(Option::as_ref),
            bond: links.bond,
        };
        place.fill(row, wanted, out)?;
        let end = out.participants().len();
        out.set_secondary(end.saturating_sub(place.point.nodes.len())..end);
        if let Some(filled) = out.rows_mut().first_mut() {
            filled.gap += self.shift(row);
        }
        Ok(())
    }

    /// The closest point of `ρ − slip`, on the continuation of the facet. Where the tangent plane is held, the point has
    /// moved along it since: by what of its distance to `ρ` is not along the normal.
    fn anchor(
        &self,
        row: usize,
        pair: &SurfacePair,
        at: &Placement,
        found: &Pair,
        slip: Vec3,
    ) -> Result<Anchored, SurfaceError> {
        let surface = pair.primary.as_ref();
        let mut jet = SurfaceJet::default();
        surface.jet(at, &found.anchor, &mut jet)?;
        let stays = Anchored {
            anchor: found.anchor,
            offset: Vec3::ZERO,
        };
        let moved = found.held.map_or(Vec3::ZERO, |normal| {
            let away = self.point(row).position(at) - jet.position;
            away - normal * away.dot(normal)
        });
        let yielded = slip - moved;
        if yielded == Vec3::ZERO {
            return Ok(stays);
        }
        let back = jet.position - yielded;
        let facet = found.anchor.facet;
        let anchor = if surface.domain(facet).is_some() {
            extended_face(surface, at, found.anchor, back, FAR, &mut jet)?
        } else {
            surface.project(at, facet, back, Some(found.anchor), &mut jet)?
        };
        Ok(anchor.map_or(stays, |p| Anchored {
            anchor: p.anchor,
            offset: Vec3::ZERO,
        }))
    }
}

impl Curved for PointToSegment {
    fn rises(
        &self,
        _: &SurfacePair,
        _: &Placement,
        pairing: &Pairing,
        bent: &BentSides,
    ) -> Result<Vec<f64>, SurfaceError> {
        let own = |row: usize| {
            let point = self.inside.as_ref()?.get(row)?;
            Some(bent.of_secondary(point.facet, point.xi))
        };
        let rise = |(row, pair): (usize, &Option<Pair>)| {
            pair.map_or(0.0, |found| {
                own(row).unwrap_or(0.0) + bent.of_primary(found.anchor)
            })
        };
        Ok(pairing.pairs.iter().enumerate().map(rise).collect())
    }
}

/// Points that were cut at the facets opposite.
impl Renewable for PointToSegment {
    fn renews(&self) -> bool {
        self.cutter.is_some() && self.sliding == SlidingRange::Increment
    }

    fn renew(&mut self, pair: &SurfacePair, x: &[Vec3]) -> Option<Vec<Option<u32>>> {
        let cutter = self.cutter.as_ref().filter(|_| Renewable::renews(self))?;
        let facets = pair.secondary.as_ref()?;
        let points = pieces(cutter, facets, x);
        let before = self.inside.as_deref().unwrap_or(&[]);
        if points == before {
            return None;
        }
        let closest = |point: &OnFacet| {
            let first = before.partition_point(|p| p.facet < point.facet);
            let of_facet = before[first..]
                .iter()
                .zip(first as u32..)
                .take_while(|(p, _)| p.facet == point.facet);
            let away = |p: &OnFacet| (p.xi - point.xi).norm_squared();
            let closest = of_facet.min_by(|(a, _), (b, _)| away(a).total_cmp(&away(b)));
            closest.map(|(_, row)| row)
        };
        let origins = points.iter().map(closest).collect();
        self.place(facets, points);
        Some(origins)
    }

    fn store(&self) -> Vec<f64> {
        let inside = self.inside.iter().filter(|_| self.cutter.is_some());
        let numbers = |p: &OnFacet| {
            let apart = f64::from(u8::from(p.apart));
            [f64::from(p.facet), p.xi.x, p.xi.y, p.xi.z, p.weight, apart]
        };
        inside.flatten().flat_map(numbers).collect()
    }

    fn restore(&mut self, pair: &SurfacePair, stored: &[f64]) -> bool {
        let Some(facets) = pair.secondary.as_ref().filter(|_| self.cutter.is_some()) else {
            return stored.is_empty();
        };
        let (points, rest) = stored.as_chunks::<STORED>();
        let nfacet = facets.nfacet() as f64;
        if !rest.is_empty() || points.iter().any(|p| !(0.0..nfacet).contains(&p[0])) {
            return false;
        }
        let point = |&[facet, x, y, z, weight, apart]: &[f64; STORED]| {
            OnFacet::new(facet as u32, (Vec3::new(x, y, z), weight), apart != 0.0)
        };
        self.place(facets, points.iter().map(point).collect());
        true
    }
}
