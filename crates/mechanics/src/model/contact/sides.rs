//! From parts to the two sides of an interface, and the way they are compared.

mod rigid;

use super::joined;
use crate::contact::discretization::projected::{Closest, Sight};
use crate::contact::discretization::{
    Cutter, Discretization, FacetSizes, Lean, Mortar, NodeNormals, NodeToNode, OwnBody, Pair,
    Pairing, PointToSegment, SlidingRange, SurfacePair, areas_inside,
};
use crate::contact::law::{AugmentedNewton, ContactLaw, Lagrange, Multiplier, Penalty, Uzawa};
use crate::contact::{Areas, Measure, closest_points, discretization, mortar};
use crate::model::bodies::Spaces;
use crate::model::steps::Prescribed;
use crate::model::{
    AreaPart, ContactPart, Enforcement, FeaturesPart, Method, ModelError, Normals, PairOrder,
    PointKind, PointRule, PrimaryPart, SidePart, label,
};
use crate::system::{Elimination, Idealisation};
use signorini_geometry::element::{Element, quadrature};
use signorini_geometry::mesh::{Face, Mesh, NodeId, boundary};
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
    pub swapped: bool,
}

/// What sides are made from.
#[derive(Clone, Copy)]
pub(in crate::model) struct Source<'a> {
    pub mesh: &'a Mesh,
    /// Positions at the start.
    pub reference: &'a [Vec3],
    pub space: Idealisation,
    /// What the planes of bodies stand for.
    pub spaces: &'a Spaces<'a>,
    /// What follows rigid bodies.
    pub elimination: &'a Elimination,
    /// Of each node, whether the steps prescribe its motion along all axes.
    pub prescribed: &'a [bool],
    /// Of each node and axis, what the steps prescribe of its motion.
    pub motions: &'a [[Prescribed; 3]],
    /// Of each contact, whether it has friction in any step.
    pub rubs: &'a [bool],
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
        let surface_error = |source| ModelError::Surface {
            contact: part.name.clone(),
            source,
        };
        let facets = |faces: &[Face]| {
            Facets::new(self.mesh, faces).map_err(|source| ModelError::Facets {
                contact: part.name.clone(),
                source,
            })
        };
        let (points, secondary) = match &part.secondary {
            SidePart::Faces(faces) => {
                let surface = facets(faces)?;
                (surface.all_nodes(), Some(surface))
            }
            SidePart::Nodes(nodes) => {
                let unique: BTreeSet<NodeId> = nodes.iter().copied().collect();
                (unique.into_iter().collect(), None)
            }
        };
        if points.is_empty() {
            return Err(ModelError::EmptySide {
                contact: part.name.clone(),
            });
        }
        let primary = match &part.primary {
            PrimaryPart::Faces(faces) => Some(facets(faces)?),
            PrimaryPart::Itself => secondary.clone(),
            PrimaryPart::Nodes(_) | PrimaryPart::Surface(_) => None,
        };
        if part.area == AreaPart::Opposite && primary.is_none() {
            return Err(ModelError::Unsuited {
                contact: part.name.clone(),
                what: "points stand for facets opposite, and its primary side has none",
                remedy: "area = \"reference\"",
            });
        }
        let same = matches!(part.primary, PrimaryPart::Itself);
        let method = self.method(part, secondary.as_ref());
        let at_nodes = self.nodes_take_multipliers((contact, part), &points);
        let at_nodes = at_nodes.map_err(surface_error)?;
        let method = match &part.method {
            Method::Auto if at_nodes => Method::NodeToSegment,
            _ => method,
        };
        let law = law(part, method.takes_multipliers() || at_nodes)?;
        let exact = law.multiplier() != Multiplier::None;
        if same && exact {
            return Err(ModelError::Unsuited {
                contact: part.name.clone(),
                what: "a surface that touches itself has multipliers on both sides, which hold each point twice",
                remedy: "enforcement = { penalty = \"auto\" }",
            });
        }
        if same && secondary.is_none() {
            return Err(ModelError::Unsuited {
                contact: part.name.clone(),
                what: "a surface that may touch itself is given by faces, not by bare nodes",
                remedy: "secondary = \"a set of faces\"",
            });
        }
        if let Some(primary) = primary.as_ref().filter(|_| !same) {
            self.not_glued(part, &points, primary)?;
        }
        let closest = match part.features {
            Some(FeaturesPart::Faces) => Closest::Within,
            Some(FeaturesPart::Edges) => Closest::Rims,
            None if law.multiplier().is_unknown() => Closest::Faces,
            None => Closest::Anywhere,
        };
        let around = match part.area {
            AreaPart::Adjacent => Some(facets(&self.outer_faces_at(&points))?),
            AreaPart::Reference | AreaPart::Present => secondary.clone(),
            // which it is, is known when the sides have met
            AreaPart::Opposite => None,
        };
        let nodal = |points: &[NodeId]| -> Result<Vec<f64>, ModelError> {
            let Some(facets) = &around else {
                return Ok(Vec::new());
            };
            let spaces = self.spaces.behind(facets);
            let areas = facets.lumped_areas(self.reference, &|f, x| extent(&spaces, f, x));
            Ok(of_points(points, &areas.map_err(surface_error)?))
        };
        let present = secondary.clone().filter(|_| part.area == AreaPart::Present);
        let mut areas: Option<Areas> = None;
        let (discretization, area): (Box<dyn Discretization>, Vec<f64>) = match method {
            Method::NodeToNode { normals, pairs } => {
                let pairs = self.node_pairs(part, primary.as_ref(), pairs)?;
                let normals = node_normals(part, normals, &primary, &secondary)?;
                let first: Vec<NodeId> = pairs.iter().map(|pair| pair[0]).collect();
                let area = nodal(&first)?;
                areas = present.map(|facets| self.present_areas(facets, first));
                (Box::new(NodeToNode::new(pairs, normals)), area)
            }
            Method::GaussPoint(rule) => {
                if exact {
                    return Err(ModelError::Unsuited {
                        contact: part.name.clone(),
                        what: "points inside facets are too many for multipliers",
                        remedy: "enforcement = { penalty = \"auto\" }",
                    });
                }
                let Some(facets) = &secondary else {
                    return Err(ModelError::Unsuited {
                        contact: part.name.clone(),
                        what: "points inside facets need a secondary side made of faces",
                        remedy: "method = \"node-to-segment\"",
                    });
                };
                let spaces = self.spaces.behind(facets);
                let points = move |element| on_facet(rule, element);
                let cutter = primary.clone().filter(|_| rule.cut);
                let cutter = cutter.map(|primary| Cutter {
                    primary,
                    rule: Box::new(points),
                });
                let mut inside = match cutter {
                    Some(cutter) => PointToSegment::pieces(facets, cutter, self.reference),
                    None => PointToSegment::inside(facets, points),
                };
                inside.sliding = part.sliding;
                if part.features.is_some() {
                    inside.closest = closest;
                }
                // pieces change, and so do areas where they are those of the start, too
                let start = (rule.cut && present.is_none()).then(|| self.reference.to_vec());
                let of_points: Areas = {
                    let facets = facets.clone();
                    Box::new(move |inside, x| {
                        let across = |facet, x| extent(&spaces, facet, x);
                        let points = inside.capabilities().inside.unwrap_or(&[]);
                        areas_inside(&facets, points, start.as_deref().unwrap_or(x), &across)
                    })
                };
                let area = of_points(&inside, self.reference).map_err(surface_error)?;
                areas = Some(of_points).filter(|_| present.is_some() || rule.cut);
                (Box::new(inside), area)
            }
            Method::Mortar(form) => {
                let (Some(facets), Some(opposite)) = (&secondary, &primary) else {
                    return Err(ModelError::Unsuited {
                        contact: part.name.clone(),
                        what: "mortar contact needs two sides made of faces",
                        remedy: "method = \"node-to-segment\"",
                    });
                };
                if part.area != AreaPart::Reference || same || part.two_pass {
                    return Err(ModelError::Unsuited {
                        contact: part.name.clone(),
                        what: "mortar contact has one pass between two surfaces, and areas of what is covered",
                        remedy: "method = \"gauss-point\"",
                    });
                }
                if let Some((element, label)) = no_dual(facets).map(|f| self.named(facets, f)) {
                    return Err(ModelError::NoDualBasis {
                        contact: part.name.clone(),
                        element,
                        label,
                    });
                }
                let space = self.one_space(part, facets)?;
                let mortar = Mortar::new(facets, opposite, form, measure(space), self.reference)
                    .map_err(surface_error)?;
                let area = mortar_areas(&mortar, self.reference, space);
                (Box::new(mortar), area)
            }
            Method::NodeToSegment | Method::Auto => {
                let of_auto = exact && matches!(part.method, Method::Auto);
                let blended = secondary.as_ref().filter(|_| of_auto);
                let blended = blended.map(|facets| self.blended(part, facets, &points));
                let blended = blended.transpose()?.flatten();
                let (mut at_nodes, area) = match blended {
                    Some(blended) => blended,
                    None => (PointToSegment::at_nodes(&points), nodal(&points)?),
                };
                at_nodes.closest = closest;
                at_nodes.sliding = part.sliding;
                areas = present.map(|facets| self.present_areas(facets, points.clone()));
                (Box::new(at_nodes), area)
            }
        };
        let surface: Arc<dyn ContactSurface> = match (&part.primary, &primary) {
            (PrimaryPart::Surface(surface), _) => surface.clone(),
            (_, Some(facets)) => Arc::new(facets.clone()),
            (_, None) => Arc::new(crate::contact::discretization::nodes::Nowhere {
                ntan: self.space.ndim() - 1,
            }),
        };
        let own = same.then(|| {
            let at = Placement {
                x: self.reference,
                poses: &[],
            };
            let of = |facets: &Facets| {
                OwnBody::new(&points, facets, &joined::bodies(self.mesh, facets), &at)
            };
            secondary.as_ref().map(of)
        });
        Ok(Sides {
            contact,
            method,
            discretization,
            law,
            pair: SurfacePair {
                points,
                secondary,
                primary: surface,
                reach: 0.0,
                sizes: FacetSizes::default(),
                start: Vec::new(),
                own: own.flatten(),
                same,
                lean: None,
            },
            facets: primary,
            area,
            areas,
            sliding: part.sliding,
            swapped,
        })
    }

    /// The areas of some nodes of these facets, wherever they are.
    fn present_areas(&self, facets: Facets, points: Vec<NodeId>) -> Areas {
        let spaces = self.spaces.behind(&facets);
        Box::new(move |_, x| {
            let areas = facets.lumped_areas(x, &|facet, x| extent(&spaces, facet, x))?;
            Ok(of_points(&points, &areas))
        })
    }

    /// What the plane stands for behind all facets of a mortar side.
    fn one_space(&self, part: &ContactPart, facets: &Facets) -> Result<Idealisation, ModelError> {
        let first = self.spaces.alike(facets);
        first.ok_or_else(|| ModelError::Unsuited {
                contact: part.name.clone(),
                what: "bodies of its secondary side differ in thickness or idealisation, which mortar contact does not weigh",
                remedy: "method = \"gauss-point\"",
        })
    }

    /// The name of the element that a facet is, and the number of the cell that it is a side of.
    fn named(&self, facets: &Facets, facet: u32) -> (&'static str, u64) {
        let label = facets
            .face(facet)
            .and_then(|f| self.mesh.cell_label(f.cell));
        let name = facets.element(facet).map_or("", |e| e.name());
        (name, label.unwrap_or(0))
    }

    /// The outer faces of solids that meet any of some sorted nodes.
    fn outer_faces_at(&self, points: &[NodeId]) -> Vec<Face> {
        let meets = |nodes: &[NodeId]| nodes.iter().any(|n| points.binary_search(n).is_ok());
        let solids = self.mesh.cells(self.mesh.dim());
        let mut outer = boundary(
            self.mesh,
            solids.filter(|cell| meets(self.mesh.cell(*cell))),
        );
        outer.retain(|face| {
            let of_face = self.mesh.face(*face);
            of_face.is_some_and(|(_, nodes)| meets(&nodes))
        });
        outer
    }

    /// The method in use.
    ///
    /// Mortar passes on any even pressure and needs no number, but compares two surfaces of deformable solids, with
    /// multipliers at nodes that can follow them. With a penalty, points are cheaper and no worse; nodes alone cannot carry
    /// an even pressure on some facets. Multipliers at points inside facets are more than there are nodes to follow them.
    /// Against a rigid surface without facets, nodes take multipliers where they can follow, see [`rigid`].
    fn method(&self, part: &ContactPart, secondary: Option<&Facets>) -> Method {
        let penalty = matches!(part.enforcement, Enforcement::Penalty(_));
        let open = !penalty && !part.enforcement.is_curve();
        let exact = open && !matches!(part.enforcement, Enforcement::Auto);
        match (&part.method, &part.primary) {
            (Method::Auto, PrimaryPart::Nodes(_)) => Method::NodeToNode {
                normals: Normals::default(),
                pairs: PairOrder::default(),
            },
            (Method::Auto, PrimaryPart::Faces(_)) if open && self.suits_mortar(part, secondary) => {
                Method::Mortar(discretization::mortar::Form {
                    joined: part.tie.is_some(),
                    ..Default::default()
                })
            }
            (Method::Auto, _) if self.shares_unevenly(part) && !exact => {
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
    fn suits_mortar(&self, part: &ContactPart, secondary: Option<&Facets>) -> bool {
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
        plain && secondary.is_some_and(suits)
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

    fn not_glued(
        &self,
        part: &ContactPart,
        points: &[NodeId],
        primary: &Facets,
    ) -> Result<(), ModelError> {
        let of_primary = primary.all_nodes();
        let shared = points
            .iter()
            .filter(|n| of_primary.binary_search(n).is_ok());
        let shared: Vec<NodeId> = shared.copied().collect();
        match shared.first() {
            Some(&node) => Err(ModelError::Glued {
                contact: part.name.clone(),
                count: shared.len(),
                node: label(self.mesh, node),
            }),
            None => Ok(()),
        }
    }

    /// Secondary and primary node of each pair.
    fn node_pairs(
        &self,
        part: &ContactPart,
        primary: Option<&Facets>,
        order: PairOrder,
    ) -> Result<Vec<[NodeId; 2]>, ModelError> {
        let of_primary = match (&part.primary, primary) {
            (PrimaryPart::Nodes(nodes), _) => nodes.clone(),
            (PrimaryPart::Faces(_), Some(facets)) => facets.all_nodes(),
            _ => {
                return Err(ModelError::Unsuited {
                    contact: part.name.clone(),
                    what: "node-to-node contact is between the nodes of two sides",
                    remedy: "method = \"node-to-segment\"",
                });
            }
        };
        let of_secondary = match &part.secondary {
            SidePart::Nodes(nodes) => nodes.clone(),
            SidePart::Faces(faces) => {
                let nodes = faces.iter().filter_map(|&f| self.mesh.face(f));
                let unique: BTreeSet<NodeId> = nodes.flat_map(|(_, nodes)| nodes).collect();
                unique.into_iter().collect()
            }
        };
        if order == PairOrder::Listed {
            if of_primary.len() != of_secondary.len() {
                return Err(ModelError::PairCount {
                    contact: part.name.clone(),
                    secondary: of_secondary.len(),
                    primary: of_primary.len(),
                });
            }
            let pairs = of_secondary.into_iter().zip(of_primary);
            return Ok(pairs.map(|(s, p)| [s, p]).collect());
        }
        let at = |n: NodeId| self.reference.get(n as usize).copied().unwrap_or_default();
        let nearest = |s: NodeId| {
            let distance = |p: &NodeId| (at(*p) - at(s)).norm_squared();
            let near = of_primary
                .iter()
                .min_by(|p, q| distance(p).total_cmp(&distance(q)));
            near.map(|&p| [s, p])
        };
        Ok(of_secondary.into_iter().filter_map(nearest).collect())
    }
}

/// The first facet of an element without a dual basis.
fn no_dual(facets: &Facets) -> Option<u32> {
    let has_none = |f: &u32| facets.element(*f).is_none_or(|e| e.dual_basis().is_none());
    (0..facets.nfacet() as u32).find(has_none)
}

/// Areas of mortar rows, with the thickness of the plane.
fn mortar_areas(mortar: &Mortar, x: &[Vec3], space: Idealisation) -> Vec<f64> {
    let nodes = mortar.nodes().iter();
    let at = nodes.map(|&n| x.get(n as usize).copied().unwrap_or_default());
    let areas = at.zip(mortar.areas());
    let thickness = |x| match measure(space) {
        mortar::Measure::Flat => space.extent(x),
        mortar::Measure::Revolved => 1.0,
    };
    areas.map(|(x, area)| area * thickness(x)).collect()
}

/// What mortar integrals are taken over.
fn measure(space: Idealisation) -> mortar::Measure {
    match space {
        Idealisation::Axisymmetric => mortar::Measure::Revolved,
        _ => mortar::Measure::Flat,
    }
}

/// The closest point of a surface without facets, however far.
fn closest_of_surface(
    surface: &dyn ContactSurface,
    at: &Placement,
    x: Vec3,
) -> Result<Option<Pair>, SurfaceError> {
    let sight = Sight {
        hint: None,
        on: Closest::Anywhere,
        reach: &|_| f64::INFINITY,
        own: None,
    };
    discretization::projected::closest(surface, at, x, &[0], &sight)
}

/// The areas of some nodes, from those of all nodes in their order.
fn of_points(points: &[NodeId], areas: &[(NodeId, f64)]) -> Vec<f64> {
    let of = |node: &NodeId| {
        let found = areas.binary_search_by_key(node, |a| a.0).ok();
        found.and_then(|k| areas.get(k)).map_or(0.0, |a| a.1)
    };
    points.iter().map(of).collect()
}

/// The extent across a facet, from what the planes of all facets stand for.
fn extent(spaces: &[Idealisation], facet: u32, at: Vec3) -> f64 {
    let space = spaces.get(facet as usize);
    space.map_or(1.0, |space| space.extent(at))
}

fn node_normals(
    part: &ContactPart,
    normals: Normals,
    primary: &Option<Facets>,
    secondary: &Option<Facets>,
) -> Result<NodeNormals, ModelError> {
    let none = || ModelError::Unsuited {
        contact: part.name.clone(),
        what: "normals of bare nodes cannot be averaged: a vector towards the secondary side is needed",
        remedy: "normals = [0, 1, 0]",
    };
    let zero = || ModelError::Unsuited {
        contact: part.name.clone(),
        what: "the given normal is zero",
        remedy: "normals = [0, 1, 0]",
    };
    match normals {
        Normals::Given(normal) => normal.normalized().map(NodeNormals::Given).ok_or_else(zero),
        Normals::Primary => primary.clone().map(NodeNormals::Primary).ok_or_else(none),
        Normals::Secondary => secondary
            .clone()
            .map(NodeNormals::Secondary)
            .ok_or_else(none),
    }
}

/// Points of a facet: by default one more along each direction than the degree of the facet.
fn on_facet(rule: PointRule, element: Element) -> Vec<(Vec3, f64)> {
    let n = rule.points.unwrap_or(element.order() + 1);
    let line = match rule.kind {
        PointKind::Gauss => quadrature::gauss(n),
        PointKind::Lobatto => quadrature::lobatto(n),
    };
    quadrature::on_facet(element, &line)
}

fn law(part: &ContactPart, takes_multipliers: bool) -> Result<Arc<dyn ContactLaw>, ModelError> {
    let law: Arc<dyn ContactLaw> = match &part.enforcement {
        Enforcement::Auto if takes_multipliers => Arc::new(Lagrange),
        Enforcement::Auto | Enforcement::Penalty(_) => Arc::new(Penalty),
        Enforcement::Law(law) => Arc::clone(law),
        Enforcement::Lagrange => Arc::new(Lagrange),
        Enforcement::Uzawa(_) => Arc::new(Uzawa),
        Enforcement::AugmentedNewton(_) => Arc::new(AugmentedNewton),
    };
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
        let spaces = spaces.behind(facets);
        let area = |anchor: Anchor| -> Result<f64, SurfaceError> {
            let Anchor { facet, local } = anchor;
            let (shape, per_parameter) = facets.sample(x, facet, local)?;
            let nodes = facets.nodes(facet).iter().zip(shape);
            let at = nodes.map(|(&n, w)| x.get(n as usize).copied().unwrap_or_default() * w);
            let rule = facets.element(facet).map(|element| element.surface_rule());
            let domain: f64 = rule.map_or(0.0, |rule| rule.weights.iter().sum());
            Ok(per_parameter * domain * extent(&spaces, facet, at.sum()))
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
            self.pair.lean = facets.map(|facets| Lean::new(facets, rows, share));
            return Ok(());
        };
        let primary = self.pair.primary.as_ref();
        let Some(&space) = spaces.behind(facets).first() else {
            return Ok(());
        };
        let mortar = Mortar::new(facets, primary, form, measure(space), at.x)?
            .held_at(&self.pair, at, share)?;
        self.area = mortar_areas(&mortar, at.x, space);
        self.discretization = Box::new(mortar);
        Ok(())
    }

    /// Closest points at a configuration, within the reach.
    pub fn pair_up(&self, at: &Placement) -> Result<Pairing, SurfaceError> {
        closest_points(self.discretization.as_ref(), &self.pair, at)
    }
}

#[cfg(test)]
mod tests;
