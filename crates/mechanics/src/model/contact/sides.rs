//! From parts to the two sides of an interface, and the way they are compared.

mod areas;
mod rigid;
mod rows;
mod source;

pub(in crate::model) use source::Source;

use crate::contact::discretization::{
    self, Averaged, Discretization, FacetSizes, Lean, Mortar, Pair, Pairing, SlidingRange,
    SurfacePair,
};
use crate::contact::law::{AugmentedNewton, ContactLaw, Lagrange, Multiplier, Penalty, Uzawa};
use crate::contact::{Areas, Measure, closest_points};
use crate::model::spaces::Spaces;
use crate::model::{
    AreaPart, ContactPart, Enforcement, Method, ModelError, Normals, PairOrder, PointKind,
    PointRule, PrimaryPart, SidePart,
};
use areas::{measure, mortar_areas, no_dual};
use rows::Pass;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Anchor, ContactSurface, Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeSet;
use std::sync::Arc;

/// How often the reach is doubled to find nearby facets at the start.
const DOUBLINGS: usize = 6;

/// One pass of a contact, before anything is chosen for it.
pub(in crate::model) struct Sides {
    /// The place of the contact in the list.
    pub contact: usize,
    /// The method in use.
    pub method: Method,
    pub discretization: Box<dyn Discretization>,
    pub law: Arc<dyn ContactLaw>,
    pub pair: SurfacePair,
    /// Facets of the primary side, where it has any.
    pub facets: Option<Facets>,
    /// Area of each row; empty where the secondary side has none.
    pub area: Vec<f64>,
    pub areas: Option<Areas>,
    pub sliding: SlidingRange,
    /// Nodes that both sides have.
    pub shared: Vec<NodeId>,
    /// Nodes whose rows other contacts have.
    pub yields: BTreeSet<NodeId>,
    pub swapped: bool,
    /// Which of the contact's variants it is a pass of.
    pub variant: usize,
}

impl Source<'_> {
    /// The passes of a contact.
    pub fn sides(&self, contact: usize, part: &ContactPart) -> Result<Vec<Sides>, ModelError> {
        let first = self.pass(contact, part, false)?;
        if !part.two_pass {
            return Ok(vec![first]);
        }
        let (PrimaryPart::Faces(primary), SidePart::Faces(secondary)) =
            (&part.primary, &part.secondary)
        else {
            return Err(ModelError::TwoPass {
                contact: part.name.clone(),
            });
        };
        if first.law.multiplier() != Multiplier::None {
            return Err(ModelError::Unsuited {
                contact: part.name.clone(),
                what: "two passes by multipliers hold each point twice",
                remedy: "enforcement = { penalty = \"auto\" }",
            });
        }
        let swapped = ContactPart {
            secondary: SidePart::Faces(primary.clone()),
            primary: PrimaryPart::Faces(secondary.clone()),
            ..part.clone()
        };
        Ok(vec![first, self.pass(contact, &swapped, true)?])
    }

    fn pass(&self, contact: usize, part: &ContactPart, swapped: bool) -> Result<Sides, ModelError> {
        let pass = Pass::new(self, part)?;
        let at_nodes = self.nodes_take_multipliers((contact, part), &pass.points);
        let at_nodes = at_nodes.map_err(|source| pass.surface_error(source))?;
        let method = match &part.method {
            Method::Auto if at_nodes => Method::NodeToSegment,
            _ => self.method(part, &pass),
        };
        let exact = (method.takes_multipliers() || at_nodes) && !part.breaks();
        let law = law(part, exact)?;
        pass.admits(law.multiplier())?;
        let rows = pass.rows(&method, law.multiplier())?;
        Ok(Sides {
            contact,
            method,
            discretization: rows.discretization,
            law,
            area: rows.area,
            areas: rows.areas,
            sliding: part.sliding,
            swapped,
            variant: 0,
            facets: pass.primary.clone(),
            shared: pass.shared.clone(),
            yields: BTreeSet::new(),
            pair: pass.into_pair(),
        })
    }

    /// The method in use.
    ///
    /// Mortar passes on any even pressure and needs no number, but compares two surfaces of deformable solids, with
    /// multipliers at nodes that can follow them. With a penalty, points are cheaper and no worse; nodes alone cannot carry
    /// an even pressure on some facets. Multipliers at points inside facets are more than there are nodes to follow them.
    /// Against a rigid surface without facets, nodes take multipliers where they can follow, see [`rigid`]. Nodes that both
    /// sides have could follow no multiplier.
    fn method(&self, part: &ContactPart, pass: &Pass<'_>) -> Method {
        let penalty = matches!(part.enforcement, Enforcement::Penalty(_)) || part.breaks();
        let open = !penalty && !part.enforcement.is_curve();
        let exact = open && !matches!(part.enforcement, Enforcement::Auto);
        match (&part.method, &part.primary) {
            (Method::Auto, PrimaryPart::Nodes(_)) => Method::NodeToNode {
                normals: Normals::default(),
                pairs: PairOrder::default(),
            },
            (Method::Auto, PrimaryPart::Faces(_))
                if open && pass.shared.is_empty() && self.suits_mortar(part, pass) =>
            {
                Method::Mortar(discretization::mortar::Form {
                    joined: part.tie.is_some(),
                    ..Default::default()
                })
            }
            (Method::Auto, _) if (self.shares_unevenly(part) || part.breaks()) && !exact => {
                Method::GaussPoint(PointRule {
                    kind: PointKind::Gauss,
                    points: None,
                    cut: false,
                })
            }
            (Method::Auto, _) => Method::NodeToSegment,
            (Method::Mortar(form), _) => Method::Mortar(discretization::mortar::Form {
                joined: form.joined || part.tie.is_some(),
                ..*form
            }),
            (method, _) => method.clone(),
        }
    }

    /// Whether multipliers of mortar contact can be had for what a contact asks for.
    fn suits_mortar(&self, part: &ContactPart, pass: &Pass<'_>) -> bool {
        let plain = !part.two_pass
            && part.area == AreaPart::Reference
            && part.measure != Some(Measure::Node);
        let given = |n: &NodeId| {
            let prescribed = self.prescribed.get(*n as usize);
            prescribed == Some(&true) || self.elimination.body_of(*n).is_some()
        };
        let follows = |facets: &Facets| {
            (0..facets.nfacet() as u32).all(|f| !facets.nodes(f).iter().all(given))
        };
        let suits = |facets: &Facets| {
            follows(facets) && self.spaces.alike(facets).is_some() && no_dual(facets).is_none()
        };
        plain && pass.secondary.as_ref().is_some_and(suits)
    }

    /// Whether the nodal forces of an even pressure on the secondary side are not all positive: nodes alone cannot carry
    /// it.
    fn shares_unevenly(&self, part: &ContactPart) -> bool {
        let SidePart::Faces(faces) = &part.secondary else {
            return false;
        };
        let mut elements = faces.iter().filter_map(|&f| self.mesh.face(f));
        elements.any(|(element, _)| !element.shares_even_pressure())
    }
}

fn law(part: &ContactPart, takes_multipliers: bool) -> Result<Arc<dyn ContactLaw>, ModelError> {
    let law: Arc<dyn ContactLaw> = match &part.enforcement {
        Enforcement::Auto if takes_multipliers => Arc::new(Lagrange),
        Enforcement::Auto | Enforcement::Penalty(_) => Arc::new(Penalty),
        Enforcement::Law(law) => Arc::clone(law),
        Enforcement::Gasket(gasket) => Arc::clone(gasket) as _,
        Enforcement::Lagrange => Arc::new(Lagrange),
        Enforcement::Uzawa(_) => Arc::new(Uzawa),
        Enforcement::AugmentedNewton(_) => Arc::new(AugmentedNewton),
    };
    if part.breaks() && law.multiplier() != Multiplier::None {
        return Err(ModelError::Unsuited {
            contact: part.name.clone(),
            what: "joints that break act by a stiffness, not by multipliers",
            remedy: "enforcement = { penalty = \"auto\" }",
        });
    }
    if part.tie.is_some() && part.enforcement.is_curve() && law.multiplier() == Multiplier::None {
        return Err(ModelError::Unsuited {
            contact: part.name.clone(),
            what: "sides that are joined pull, too: a curve of pressures says nothing about that",
            remedy: "enforcement = { penalty = \"auto\" }",
        });
    }
    Ok(law)
}

impl Sides {
    /// What the pressure of a law refers to, unless that is said: areas, where points have some.
    pub fn measure(&self) -> Measure {
        match self.area.is_empty() {
            true => Measure::Node,
            false => Measure::Area,
        }
    }

    /// How many multipliers its rows have.
    pub fn nmultiplier(&self, part: &ContactPart, rubs: bool, ndim: usize) -> usize {
        let vectors = rubs || part.tie.is_some();
        crate::contact::nmultiplier(self.law.as_ref(), vectors, ndim) * self.discretization.nrow()
    }

    /// Facets of the side that carries points.
    pub fn secondary(&self) -> Option<&Facets> {
        self.pair.secondary.as_ref()
    }

    /// Has the reach follow the sizes of facets. It stays the same everywhere where the primary side has no facets that
    /// nodes carry, and where distant points act, too: a bond, a clearance that is given, a curve of pressures.
    pub fn reach_locally(&mut self, at: &Placement, part: &ContactPart) {
        let acts_far = part.tie.is_some()
            || part.start.clearance.is_some()
            || part.enforcement.is_curve()
            || matches!(self.method, Method::NodeToNode { .. });
        if let Some(primary) = self.facets.as_ref().filter(|_| !acts_far) {
            let SurfacePair {
                points, secondary, ..
            } = &self.pair;
            self.pair.sizes = FacetSizes::new(points, secondary.as_ref(), primary, at);
        }
    }

    /// Chooses the reach, unless it is given, and answers with the closest points at the start. Sides further apart than
    /// the usual reach are looked for further away, so that a body that goes a long way to its contact is seen coming.
    pub fn look_around(
        &mut self,
        at: &Placement,
        given: Option<f64>,
        usual: f64,
    ) -> Result<Pairing, SurfaceError> {
        self.pair.reach = given.unwrap_or(usual);
        let found = self.pair_up(at)?;
        if given.is_some() || found.pairs.iter().any(Option::is_some) {
            return Ok(found);
        }
        let sizes = std::mem::take(&mut self.pair.sizes);
        let mut further = None;
        for _ in 0..DOUBLINGS {
            self.pair.reach *= 2.0;
            let pairs = self.pair_up(at)?;
            if pairs.pairs.iter().any(Option::is_some) {
                further = Some(pairs);
                break;
            }
        }
        self.pair.sizes = sizes;
        if further.is_none() {
            self.pair.reach = usual;
        }
        Ok(further.unwrap_or(found))
    }

    /// Makes each point stand for the facet that it was found to meet, as large as it were if it were everywhere as it is
    /// there; for the mean of those that other points meet, where it meets none.
    pub fn stand_for_opposite(
        &mut self,
        found: &Pairing,
        x: &[Vec3],
        spaces: &Spaces<'_>,
    ) -> Result<(), SurfaceError> {
        let Some(facets) = &self.facets else {
            return Ok(());
        };
        let extents = spaces.behind(facets);
        let area = |anchor: Anchor| -> Result<f64, SurfaceError> {
            let Anchor { facet, local } = anchor;
            let (shape, per_parameter) = facets.sample(x, facet, local)?;
            let nodes = facets.nodes(facet).iter().zip(shape);
            let at = nodes.map(|(&n, w)| x.get(n as usize).copied().unwrap_or_default() * w);
            let rule = facets.element(facet).map(|element| element.surface_rule());
            let domain: f64 = rule.map_or(0.0, |rule| rule.weights.iter().sum());
            Ok(per_parameter * domain * extents.at(facet, &shape, at.sum()))
        };
        let met = found.pairs.iter().flatten();
        let areas = met.map(|pair| area(pair.anchor));
        let areas: Vec<f64> = areas.collect::<Result<_, _>>()?;
        let mean = areas.iter().sum::<f64>() / areas.len().max(1) as f64;
        let mut known = areas.into_iter();
        let of = |pair: &Option<Pair>| pair.as_ref().and_then(|_| known.next()).unwrap_or(mean);
        self.area = found.pairs.iter().map(of).collect();
        Ok(())
    }

    /// Keeps what mortar rows see of both sides at this configuration for good. Normals are between those of both sides,
    /// points' too: this part is that of the secondary one.
    pub fn hold(
        &mut self,
        at: &Placement,
        spaces: &Spaces<'_>,
        share: f64,
    ) -> Result<(), SurfaceError> {
        let (&Method::Mortar(form), Some(facets)) = (&self.method, &self.pair.secondary) else {
            let facets = self.pair.secondary.as_ref();
            let rows = self.discretization.as_ref();
            self.pair.lean = facets.map(|facets| match rows.capabilities().inside {
                Some(points) => Lean::inside(points, share),
                None => {
                    let points = (0..rows.nrow()).map(|row| rows.point(row));
                    Lean::at_nodes(facets, points, share)
                }
            });
            return Ok(());
        };
        let primary = self.pair.primary.as_ref();
        let Some(&space) = spaces.behind(facets).spaces.first() else {
            return Ok(());
        };
        let mut mortar = Mortar::new(facets, primary, form, measure(space), at.x)?;
        mortar.yield_at(self.yields.clone());
        let mortar = mortar.held_at(&self.pair, at, share)?;
        self.area = mortar_areas(&mortar, at.x, space, spaces);
        self.discretization = Box::new(mortar);
        Ok(())
    }

    /// Leaves rows of these nodes to other contacts.
    pub fn yield_at(&mut self, nodes: BTreeSet<NodeId>) {
        if let Some(rows) = self.discretization.averaged_mut() {
            rows.yield_at(nodes.clone());
        }
        self.yields = nodes;
    }

    /// Closest points at a configuration, within the reach.
    pub fn pair_up(&self, at: &Placement) -> Result<Pairing, SurfaceError> {
        closest_points(self.discretization.as_ref(), &self.pair, at)
    }
}

#[cfg(test)]
mod tests;
