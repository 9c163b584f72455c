//! The sides as they are at the start, point by point, whatever the method: gaps, overlaps, and what of them comes from
//! straight facets.
//!
//! | symbol | name in code | unit |
//! |---|---|---|
//! | g | `gap` of a [`Probe`]: between straight facets | length |
//! | δ | `rise`: by how much g exceeds the gap between the surfaces the facets were cut from | length |
//! | s | `sagitta`: the largest rises of the two facets that meet, added up | length |
//!
//! *Conforming sides.* Points vote whose facets bend, `s > 0.01 max s`. With the median m of their bent gaps g − δ,
//!
//! ```text
//! |g − δ − m| ≤ s/10     for nine of ten of them                                           (E1)
//! ```
//!
//! and that they scatter less than half as much about m as gaps between straight facets do, in the mean of squares (E2), say
//! that bending removes what scatters: the sides are one surface at a distance m, meshed twice, and gaps are measured
//! between bent facets from then on. m itself stays, however small: bending closes nothing. Everything else stays as it is
//! meshed, a ball on a plane and a pin in a wider hole too, where gaps grow by more than s from facet to facet.

use super::Sides;
use crate::contact::discretization::{BentSides, PointToSegment, SurfacePair, Wall};
use crate::contact::{Bend, closest_points};
use crate::model::{BentSummary, ContactPart, Method, StartPlace};
use signorini_geometry::element::quadrature;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{
    Anchor, Bent, ContactSurface, Facets, Placement, SurfaceError, SurfaceJet,
};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The largest cosine between the outward normals of two sides that face one another.
pub(super) const OPPOSING: f64 = -0.2;

/// The part of a sagitta that may be left of a gap at a point where bending removes it.
const LEFT: f64 = 0.1;

/// The part of the points where it has to.
const MOST: f64 = 0.9;

/// Facets that bend by less than this part of the one that bends most have no vote.
const BENDS: f64 = 0.01;

/// What bending may leave of what scatters, as a ratio of roots of mean squares.
const SCATTER: f64 = 0.5;

/// Points of a facet along each of its directions.
const POINTS: usize = 2;

/// A point of one side with its closest point of the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    pub position: Vec3,
    /// The node; `None` inside a facet.
    pub node: Option<NodeId>,
    /// The facet of its own side that it is inside of, and where.
    inside: Option<(u32, Vec3)>,
    /// The signed distance between straight facets.
    pub gap: f64,
    /// The closest point of the other side.
    pub anchor: Anchor,
    /// Where that is, and the outward normal of the other side there.
    pub closest: Vec3,
    pub towards: Vec3,
    /// Whether it is a point of the primary side.
    pub of_primary: bool,
}

/// The sides of a contact at the start.
#[derive(Debug, Default)]
pub(super) struct Look {
    /// Nodes of both sides that meet something.
    pub nodes: Vec<Probe>,
    bent: BentSides,
    /// Whether gaps are those between bent facets.
    pub conforms: Option<BentSummary>,
    around: [BTreeMap<NodeId, Around>; 2],
}

/// The surroundings of a node on its own side.
#[derive(Clone, Copy, Debug, Default)]
struct Around {
    /// The sum of the normals of facets.
    normal: Vec3,
    /// The largest sagitta.
    sagitta: f64,
}

impl Look {
    /// Looks at the sides of a contact within its reach.
    ///
    /// # Errors
    /// A facet without a normal.
    pub fn new(sides: &Sides, part: &ContactPart, at: &Placement) -> Result<Self, SurfaceError> {
        let mut look = Self::default();
        if sides.pair.same || matches!(sides.method, Method::NodeToNode { .. }) {
            return Ok(look);
        }
        let points = PointToSegment::at_nodes(&sides.pair.points);
        look.nodes = probes(&points, &forth(sides), false, at)?;
        if let Some(back) = back(sides) {
            let points = PointToSegment::at_nodes(&back.points);
            look.nodes.extend(probes(&points, &back, true, at)?);
        }
        let bend = |facets: &Facets| Bent::new(facets, at.x);
        look.bent = BentSides {
            secondary: sides.secondary().map(bend),
            primary: sides.facets.as_ref().map(bend),
        };
        let of = [&look.bent.secondary, &look.bent.primary];
        look.around = of.map(|side| {
            let side = side.as_ref();
            side.map_or_else(BTreeMap::new, |bent| around(bent, at))
        });
        let plain = part.tie.is_none() && part.start.clearance.is_none() && part.start.bends;
        if plain && look.bends() {
            look.conforms = look.vote(sides, at)?;
        }
        Ok(look)
    }

    fn bends(&self) -> bool {
        let sides = [&self.bent.secondary, &self.bent.primary];
        sides.into_iter().flatten().any(|bent| !bent.is_flat())
    }

    /// What gaps are measured between; `None` where that is the facets themselves.
    ///
    /// # Errors
    /// A facet without a normal.
    pub fn bend(&self, sides: &Sides, at: &Placement) -> Result<Option<Bend>, SurfaceError> {
        use crate::contact::discretization::SlidingRange;
        if self.conforms.is_none() {
            return Ok(None);
        }
        let found = sides.pair_up(at)?;
        let rises = match sides.discretization.capabilities().curved {
            Some(curved) => curved.rises(&sides.pair, at, &found, &self.bent)?,
            None => Vec::new(),
        };
        Ok(Some(Bend {
            sides: self.bent.clone(),
            rises,
            slides: sides.sliding != SlidingRange::Small,
        }))
    }

    /// Whether bending removes what scatters (E1).
    fn vote(&self, sides: &Sides, at: &Placement) -> Result<Option<BentSummary>, SurfaceError> {
        let mut probes: Vec<Probe> = self.nodes.clone();
        probes.retain(|probe| !probe.of_primary);
        if let Some(facets) = sides.secondary() {
            let line = quadrature::gauss(POINTS);
            let rule = |element| quadrature::on_facet(element, &line);
            let points = PointToSegment::inside(facets, rule);
            probes.extend(self::probes(&points, &forth(sides), false, at)?);
        }
        let sagittas: Vec<f64> = probes.iter().map(|p| self.sagitta(p)).collect();
        let largest = sagittas.iter().copied().fold(0.0, f64::max);
        let votes = probes.iter().zip(&sagittas);
        let votes: Vec<(f64, f64, f64)> = votes
            .filter(|(p, s)| **s > BENDS * largest && self.faces(p))
            .map(|(p, s)| (p.gap, p.gap - self.rise(p), *s))
            .collect();
        let mut bent: Vec<f64> = votes.iter().map(|v| v.1).collect();
        bent.sort_by(f64::total_cmp);
        let Some(&middle) = bent.get(bent.len() / 2) else {
            return Ok(None);
        };
        let fits = |v: &&(f64, f64, f64)| (v.1 - middle).abs() <= LEFT * v.2;
        let fitting = votes.iter().filter(fits).count();
        let scatter = |of: &dyn Fn(&(f64, f64, f64)) -> f64| {
            let squares = votes.iter().map(|v| (of(v) - middle).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let removed = scatter(&|v| v.1) < SCATTER * scatter(&|v| v.0);
        if (fitting as f64) < MOST * votes.len() as f64 || !removed {
            return Ok(None);
        }
        let most = |of: &dyn Fn(&(f64, f64, f64)) -> f64| {
            let all = votes.iter().filter(fits).map(of);
            all.fold(0.0, |most, gap| f64::max(most, (gap - middle).abs()))
        };
        Ok(Some(BentSummary {
            straight: most(&|v| v.0),
            bent: most(&|v| v.1),
            distance: middle,
        }))
    }

    /// δ.
    fn rise(&self, probe: &Probe) -> f64 {
        let (own, other) = match probe.of_primary {
            false => (&self.bent.secondary, &self.bent.primary),
            true => (&self.bent.primary, &self.bent.secondary),
        };
        let at = |bent: &Option<Bent>, facet, local| {
            bent.as_ref().map_or(0.0, |bent| bent.rise(facet, local))
        };
        let inside = probe.inside.map_or(0.0, |(f, local)| at(own, f, local));
        inside + at(other, probe.anchor.facet, probe.anchor.local)
    }

    /// s.
    fn sagitta(&self, probe: &Probe) -> f64 {
        let other = match probe.of_primary {
            false => &self.bent.primary,
            true => &self.bent.secondary,
        };
        let of = |bent: &Option<Bent>, facet| bent.as_ref().map_or(0.0, |b| b.sagitta(facet));
        let own = probe
            .inside
            .map_or(0.0, |(f, _)| of(&self.bent.secondary, f));
        own + of(other, probe.anchor.facet)
    }

    /// The outward normal of the own side at a node; `None` where that is bare nodes.
    pub fn normal(&self, probe: &Probe) -> Option<Vec3> {
        self.around(probe)?.normal.normalized()
    }

    fn around(&self, probe: &Probe) -> Option<&Around> {
        let [secondary, primary] = &self.around;
        let side = if probe.of_primary { primary } else { secondary };
        side.get(&probe.node?)
    }

    /// Whether the two sides face one another there.
    fn faces(&self, probe: &Probe) -> bool {
        let normal = self.normal(probe);
        normal.is_none_or(|n| n.dot(probe.towards) < OPPOSING)
    }

    /// The gap at a node: between bent facets where the sides conform.
    pub fn gap(&self, probe: &Probe) -> f64 {
        match self.conforms {
            Some(_) => probe.gap - self.rise(probe),
            None => probe.gap,
        }
    }

    /// By how much a gap may be due to the mesh (length).
    pub fn mesh_error(&self, probe: &Probe) -> f64 {
        match self.conforms {
            Some(summary) => summary.bent,
            None => self.sagitta(probe) + self.around(probe).map_or(0.0, |a| a.sagitta),
        }
    }

    /// The nodes that face the facets they meet.
    pub fn facing(&self) -> impl Iterator<Item = &Probe> {
        self.nodes.iter().filter(|probe| self.faces(probe))
    }
}

impl Probe {
    /// Where it is, in a summary.
    pub fn place(&self) -> StartPlace {
        StartPlace {
            node: self.node,
            position: self.position,
        }
    }
}

/// The secondary side, whose points look at the primary one with the same reach everywhere.
fn forth(sides: &Sides) -> SurfacePair {
    let pair = &sides.pair;
    SurfacePair {
        secondary: pair.secondary.clone(),
        wall: pair.wall.clone(),
        ..SurfacePair::new(pair.points.clone(), pair.primary.clone(), pair.reach)
    }
}

/// The primary side, whose points look back; none where one of the two has no facets.
fn back(sides: &Sides) -> Option<SurfacePair> {
    let (secondary, primary) = (sides.secondary()?, sides.facets.as_ref()?);
    let others = Arc::new(secondary.clone());
    Some(SurfacePair {
        secondary: Some(primary.clone()),
        wall: sides.pair.wall.as_ref().map(Wall::swapped),
        ..SurfacePair::new(primary.all_nodes(), others, sides.pair.reach)
    })
}

/// The points of a side with their closest points of the other.
fn probes(
    points: &PointToSegment,
    pair: &SurfacePair,
    of_primary: bool,
    at: &Placement,
) -> Result<Vec<Probe>, SurfaceError> {
    use crate::contact::discretization::Discretization;
    let found = closest_points(points, pair, at)?;
    let mut jet = SurfaceJet::default();
    let mut probes = Vec::new();
    for (row, found) in found.pairs.iter().enumerate() {
        let Some(found) = found else { continue };
        pair.primary.jet(at, &found.anchor, &mut jet)?;
        let point = points.point(row);
        let inside = points.on_facets().and_then(|inside| inside.get(row));
        probes.push(Probe {
            position: point.position(at),
            node: point.nodes.first().copied().filter(|_| inside.is_none()),
            inside: inside.map(|p| (p.facet, p.xi)),
            gap: found.gap,
            anchor: found.anchor,
            closest: jet.position,
            towards: jet.normal,
            of_primary,
        });
    }
    Ok(probes)
}

/// The surroundings of each node of a side.
fn around(bent: &Bent, at: &Placement) -> BTreeMap<NodeId, Around> {
    let facets = bent.facets();
    let mut found: BTreeMap<NodeId, Around> = BTreeMap::new();
    let mut jet = SurfaceJet::default();
    for facet in 0..facets.nfacet() as u32 {
        let Some(element) = facets.element(facet) else {
            continue;
        };
        let local = element.centre();
        if facets.jet(at, &Anchor { facet, local }, &mut jet).is_ok() {
            let sagitta = bent.sagitta(facet);
            for &node in facets.nodes(facet) {
                let around = found.entry(node).or_default();
                around.normal += jet.normal;
                around.sagitta = around.sagitta.max(sagitta);
            }
        }
    }
    found
}
