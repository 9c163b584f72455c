//! The rows of a pass: which points are compared with the primary side, by each method, and the areas that they stand for.

use super::areas::{measure, mortar_areas, no_dual, of_points};
use super::source::Source;
use crate::contact::Areas;
use crate::contact::discretization::nodes::Nowhere;
use crate::contact::discretization::projected::Closest;
use crate::contact::discretization::{
    Cutter, Discretization, FacetSizes, Mortar, NodeNormals, NodeToNode, OwnBody, PointToSegment,
    SurfacePair, Wall, areas_inside, mortar,
};
use crate::contact::law::Multiplier;
use crate::model::label::label;
use crate::model::{
    AreaPart, ContactPart, FeaturesPart, Method, ModelError, Normals, PairOrder, PointKind,
    PointRule, PrimaryPart, SidePart,
};
use crate::system::Idealisation;
use signorini_geometry::element::{Element, quadrature};
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId, boundary};
use signorini_geometry::surface::{ContactSurface, Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The enforcement that holds any number of points.
const BY_PENALTY: &str = "enforcement = { penalty = \"auto\" }";

/// Two sides of a contact whose rows are to be made.
pub(super) struct Pass<'a> {
    source: &'a Source<'a>,
    part: &'a ContactPart,
    /// Nodes of the secondary side, sorted.
    pub points: Vec<NodeId>,
    /// Facets of the secondary side, where it has any.
    pub secondary: Option<Facets>,
    /// Facets of the primary side, where it has any.
    pub primary: Option<Facets>,
    /// Whether both sides are one surface.
    same: bool,
    /// Nodes that both sides have, sorted: where two surfaces of one body meet. They cannot part, and are not compared.
    pub shared: Vec<NodeId>,
}

/// Rows and the areas that they stand for.
pub(super) struct Rows {
    pub discretization: Box<dyn Discretization>,
    /// Area of each row at the start; empty where the secondary side has none.
    pub area: Vec<f64>,
    /// Areas at a configuration, where they change.
    pub areas: Option<Areas>,
}

impl<'a> Pass<'a> {
    /// Looks up nodes and facets of both sides.
    pub fn new(source: &'a Source<'a>, part: &'a ContactPart) -> Result<Self, ModelError> {
        let facets = |faces: &[Face]| facets(source.mesh, part, faces);
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
        let same = matches!(part.primary, PrimaryPart::Itself);
        let of_primary = primary.as_ref().filter(|_| !same);
        let of_primary = of_primary.map(Facets::all_nodes).unwrap_or_default();
        let is_shared = |n: &&NodeId| of_primary.binary_search(n).is_ok();
        let pass = Self {
            shared: points.iter().filter(is_shared).copied().collect(),
            source,
            part,
            points,
            secondary,
            primary,
            same,
        };
        if part.area == AreaPart::Opposite && pass.primary.is_none() {
            return Err(pass.unsuited(
                "points stand for facets opposite, and its primary side has none",
                "area = \"reference\"",
            ));
        }
        Ok(pass)
    }

    /// Refuses sides that the multipliers of a law cannot hold, and sides that share facets.
    pub fn admits(&self, multiplier: Multiplier) -> Result<(), ModelError> {
        if self.same && multiplier != Multiplier::None {
            return Err(self.unsuited(
                "a surface that touches itself has multipliers on both sides, which hold each point twice",
                BY_PENALTY,
            ));
        }
        if self.same && self.secondary.is_none() {
            return Err(self.unsuited(
                "a surface that may touch itself is given by faces, not by bare nodes",
                "secondary = \"a set of faces\"",
            ));
        }
        match self.primary.as_ref().filter(|_| !self.shared.is_empty()) {
            Some(primary) => self.not_glued(primary),
            None => Ok(()),
        }
    }

    /// The rows of a method.
    pub fn rows(&self, method: &Method, multiplier: Multiplier) -> Result<Rows, ModelError> {
        let closest = match self.part.features {
            Some(FeaturesPart::Faces) => Closest::Within,
            Some(FeaturesPart::Edges) => Closest::Rims,
            None if multiplier.is_unknown() => Closest::Faces,
            None => Closest::Anywhere,
        };
        let exact = multiplier != Multiplier::None;
        match *method {
            Method::NodeToNode { normals, pairs } => self.node_to_node(normals, pairs),
            Method::GaussPoint(_) if exact => Err(self.unsuited(
                "points inside facets are too many for multipliers",
                BY_PENALTY,
            )),
            Method::GaussPoint(rule) => self.inside_facets(rule, closest),
            Method::Mortar(form) => self.mortar(form),
            Method::NodeToSegment | Method::Auto => self.at_nodes(closest, exact),
        }
    }

    /// The pair of surfaces of this pass, with a reach that is still to be chosen.
    pub fn into_pair(self) -> SurfacePair {
        let at = Placement {
            x: self.source.reference,
            poses: &[],
        };
        let bodies = |facets: &Facets| self.source.bodies.behind(facets);
        let own = self.same.then(|| {
            let of = |facets: &Facets| OwnBody::new(&self.points, facets, &bodies(facets), &at);
            self.secondary.as_ref().map(of)
        });
        let is_joined = self.part.tie.is_some();
        let wall = match (&self.secondary, &self.primary) {
            (Some(a), Some(b)) if !self.same && !is_joined => self.wall([a, b], &at),
            _ => None,
        };
        let primary: Arc<dyn ContactSurface> = match (&self.part.primary, self.primary) {
            (PrimaryPart::Surface(surface), _) => Arc::clone(surface),
            (_, Some(facets)) => Arc::new(facets),
            (_, None) => Arc::new(Nowhere {
                ntan: self.source.space.ndim() - 1,
            }),
        };
        SurfacePair {
            points: self.points,
            secondary: self.secondary,
            primary,
            reach: 0.0,
            sizes: FacetSizes::default(),
            start: Vec::new(),
            own: own.flatten(),
            wall,
            same: self.same,
            lean: None,
        }
    }

    /// The body behind two sides of it; none where no body has facets of both.
    fn wall(&self, [a, b]: [&Facets; 2], at: &Placement) -> Option<Wall> {
        let bodies = |facets: &Facets| self.source.bodies.behind(facets);
        let (of_a, of_b) = (bodies(a), bodies(b));
        let known: BTreeSet<u32> = of_a.iter().copied().collect();
        if !of_b.iter().any(|body| known.contains(body)) {
            return None;
        }
        let mesh = self.source.mesh;
        let is_behind = |cell: &CellId| {
            let body = mesh
                .cell(*cell)
                .first()
                .and_then(|&node| self.source.bodies.of(node));
            body.is_some_and(|body| known.contains(&body))
        };
        let skin = boundary(mesh, mesh.cells(mesh.dim()).filter(is_behind));
        let skin = Facets::new(mesh, &skin).ok()?;
        let of_skin = bodies(&skin);
        Some(Wall::behind([(a, &of_a), (b, &of_b)], (skin, &of_skin), at))
    }

    /// A surface that could not be made or sampled.
    pub fn surface_error(&self, source: SurfaceError) -> ModelError {
        ModelError::Surface {
            contact: self.part.name.clone(),
            source,
        }
    }

    fn unsuited(&self, what: &'static str, remedy: &'static str) -> ModelError {
        ModelError::Unsuited {
            contact: self.part.name.clone(),
            what,
            remedy,
        }
    }

    fn node_to_node(&self, normals: Normals, order: PairOrder) -> Result<Rows, ModelError> {
        let pairs = self.node_pairs(order)?;
        let normals = self.node_normals(normals)?;
        let first: Vec<NodeId> = pairs.iter().map(|pair| pair[0]).collect();
        Ok(Rows {
            area: self.nodal_areas(&first)?,
            areas: self.present_areas(&first),
            discretization: Box::new(NodeToNode::new(pairs, normals)),
        })
    }

    fn inside_facets(&self, rule: PointRule, closest: Closest) -> Result<Rows, ModelError> {
        let Some(facets) = &self.secondary else {
            return Err(self.unsuited(
                "points inside facets need a secondary side made of faces",
                "method = \"node-to-segment\"",
            ));
        };
        let reference = self.source.reference;
        let points = move |element| on_facet(rule, element);
        let cutter = self.primary.clone().filter(|_| rule.cut);
        let cutter = cutter.map(|primary| Cutter {
            primary,
            rule: Box::new(points),
        });
        let mut inside = match cutter {
            Some(cutter) => PointToSegment::pieces(facets, cutter, reference),
            None => PointToSegment::inside(facets, points),
        };
        inside.sliding = self.part.sliding;
        if self.part.features.is_some() {
            inside.closest = closest;
        }
        let is_present = self.part.area == AreaPart::Present;
        // pieces change, and so do areas where they are those of the start, too
        let start = (rule.cut && !is_present).then(|| reference.to_vec());
        let of_points: Areas = {
            let facets = facets.clone();
            let extents = self.source.spaces.behind(&facets);
            Box::new(move |inside, x| {
                let across = |facet, shape: &[f64], x| extents.at(facet, shape, x);
                let points = inside.capabilities().inside.unwrap_or(&[]);
                areas_inside(&facets, points, start.as_deref().unwrap_or(x), &across)
            })
        };
        let area = of_points(&inside, reference).map_err(|source| self.surface_error(source))?;
        Ok(Rows {
            area,
            areas: Some(of_points).filter(|_| is_present || rule.cut),
            discretization: Box::new(inside),
        })
    }

    fn mortar(&self, form: mortar::Form) -> Result<Rows, ModelError> {
        let (Some(facets), Some(opposite)) = (&self.secondary, &self.primary) else {
            return Err(self.unsuited(
                "mortar contact needs two sides made of faces",
                "method = \"node-to-segment\"",
            ));
        };
        if self.part.area != AreaPart::Reference || self.same || self.part.two_pass {
            return Err(self.unsuited(
                "mortar contact has one pass between two surfaces, and areas of what is covered",
                "method = \"gauss-point\"",
            ));
        }
        if !self.shared.is_empty() {
            return Err(self.unsuited(
                "mortar contact needs two sides without common nodes",
                "method = \"gauss-point\"",
            ));
        }
        if let Some((element, label)) = no_dual(facets).map(|f| self.named(facets, f)) {
            return Err(ModelError::NoDualBasis {
                contact: self.part.name.clone(),
                element,
                label,
            });
        }
        let space = self.one_space(facets)?;
        let reference = self.source.reference;
        let mortar = Mortar::new(facets, opposite, form, measure(space), reference)
            .map_err(|source| self.surface_error(source))?;
        Ok(Rows {
            area: mortar_areas(&mortar, reference, space, self.source.spaces),
            areas: None,
            discretization: Box::new(mortar),
        })
    }

    fn at_nodes(&self, closest: Closest, exact: bool) -> Result<Rows, ModelError> {
        let of_auto = exact && matches!(self.part.method, Method::Auto);
        let compared = self.compared();
        let blended = self.secondary.as_ref().filter(|_| of_auto);
        let blended = blended.map(|facets| self.source.blended(self.part, facets, &compared));
        let (mut at_nodes, area) = match blended.transpose()?.flatten() {
            Some(blended) => blended,
            None => (
                PointToSegment::at_nodes(&compared),
                self.nodal_areas(&compared)?,
            ),
        };
        at_nodes.closest = closest;
        at_nodes.sliding = self.part.sliding;
        Ok(Rows {
            area,
            areas: self.present_areas(&compared),
            discretization: Box::new(at_nodes),
        })
    }

    /// Areas of some nodes at the start; none where the secondary side has none.
    fn nodal_areas(&self, points: &[NodeId]) -> Result<Vec<f64>, ModelError> {
        let around = match self.part.area {
            AreaPart::Adjacent => Some(facets(
                self.source.mesh,
                self.part,
                &self.outer_faces_at_points(),
            )?),
            AreaPart::Reference | AreaPart::Present => self.secondary.clone(),
            // which it is, is known when the sides have met
            AreaPart::Opposite => None,
        };
        let Some(facets) = around else {
            return Ok(Vec::new());
        };
        let extents = self.source.spaces.behind(&facets);
        let across = |facet, shape: &[f64], x| extents.at(facet, shape, x);
        let areas = facets.lumped_areas(self.source.reference, &across);
        let areas = areas.map_err(|source| self.surface_error(source))?;
        Ok(of_points(points, &areas))
    }

    /// The areas of some nodes wherever they are, if the contact asks for them.
    fn present_areas(&self, points: &[NodeId]) -> Option<Areas> {
        let facets = self.secondary.clone()?;
        if self.part.area != AreaPart::Present {
            return None;
        }
        let extents = self.source.spaces.behind(&facets);
        let points = points.to_vec();
        Some(Box::new(move |_, x| {
            let across = |facet, shape: &[f64], x| extents.at(facet, shape, x);
            let areas = facets.lumped_areas(x, &across)?;
            Ok(of_points(&points, &areas))
        }))
    }

    /// What the plane stands for behind all facets of a mortar side.
    fn one_space(&self, facets: &Facets) -> Result<Idealisation, ModelError> {
        let first = self.source.spaces.alike(facets);
        first.ok_or_else(|| {
            self.unsuited(
                "bodies of its secondary side differ in thickness or idealisation, which mortar contact does not weigh",
                "method = \"gauss-point\"",
            )
        })
    }

    /// The name of the element that a facet is, and the number of the cell that it is a side of.
    fn named(&self, facets: &Facets, facet: u32) -> (&'static str, u64) {
        let cell = facets.face(facet).map(|face| face.cell);
        let label = cell.and_then(|cell| self.source.mesh.cell_label(cell));
        let name = facets.element(facet).map_or("", |e| e.name());
        (name, label.unwrap_or(0))
    }

    /// The outer faces of solids that meet any of the points.
    fn outer_faces_at_points(&self) -> Vec<Face> {
        let mesh = self.source.mesh;
        let is_point = |n: &NodeId| self.points.binary_search(n).is_ok();
        let meets = |nodes: &[NodeId]| nodes.iter().any(is_point);
        let solids = mesh.cells(mesh.dim());
        let mut outer = boundary(mesh, solids.filter(|cell| meets(mesh.cell(*cell))));
        outer.retain(|face| {
            let of_face = mesh.face(*face);
            of_face.is_some_and(|(_, nodes)| meets(&nodes))
        });
        outer
    }

    /// Refuses sides that have a facet in common, or nothing but nodes of the other side: nothing there could part. Nodes
    /// that they share beyond that are where two surfaces of one body meet.
    fn not_glued(&self, primary: &Facets) -> Result<(), ModelError> {
        let is_shared = |n: &NodeId| self.shared.binary_search(n).is_ok();
        let inside = |facets: &Facets| {
            let numbers = 0..facets.nfacet() as u32;
            let sorted = |facet: u32| {
                let mut nodes = facets.nodes(facet).to_vec();
                nodes.sort_unstable();
                nodes
            };
            let whole = numbers.filter(|&f| facets.nodes(f).iter().all(is_shared));
            whole.map(sorted).collect::<BTreeSet<Vec<NodeId>>>()
        };
        let common = match &self.secondary {
            Some(secondary) => !inside(secondary).is_disjoint(&inside(primary)),
            None => false,
        };
        match self.shared.first() {
            Some(&node) if common || self.shared.len() == self.points.len() => {
                Err(ModelError::Glued {
                    contact: self.part.name.clone(),
                    count: self.shared.len(),
                    node: label(self.source.mesh, node),
                })
            }
            _ => Ok(()),
        }
    }

    /// The nodes that are compared with the primary side.
    fn compared(&self) -> Vec<NodeId> {
        let is_own = |n: &&NodeId| self.shared.binary_search(n).is_err();
        self.points.iter().filter(is_own).copied().collect()
    }

    /// Secondary and primary node of each pair.
    fn node_pairs(&self, order: PairOrder) -> Result<Vec<[NodeId; 2]>, ModelError> {
        let of_primary = match (&self.part.primary, &self.primary) {
            (PrimaryPart::Nodes(nodes), _) => nodes.clone(),
            (PrimaryPart::Faces(_), Some(facets)) => facets.all_nodes(),
            _ => {
                return Err(self.unsuited(
                    "node-to-node contact is between the nodes of two sides",
                    "method = \"node-to-segment\"",
                ));
            }
        };
        let of_secondary = match &self.part.secondary {
            SidePart::Nodes(nodes) => nodes.clone(),
            SidePart::Faces(_) => self.points.clone(),
        };
        if order == PairOrder::Listed {
            if of_primary.len() != of_secondary.len() {
                return Err(ModelError::PairCount {
                    contact: self.part.name.clone(),
                    secondary: of_secondary.len(),
                    primary: of_primary.len(),
                });
            }
            let pairs = of_secondary.into_iter().zip(of_primary);
            return Ok(pairs.map(|(s, p)| [s, p]).collect());
        }
        let reference = self.source.reference;
        let at = |n: NodeId| reference.get(n as usize).copied().unwrap_or_default();
        let nearest = |s: NodeId| {
            let distance = |p: &NodeId| (at(*p) - at(s)).norm_squared();
            let near = of_primary
                .iter()
                .min_by(|p, q| distance(p).total_cmp(&distance(q)));
            near.map(|&p| [s, p])
        };
        Ok(of_secondary.into_iter().filter_map(nearest).collect())
    }

    fn node_normals(&self, normals: Normals) -> Result<NodeNormals, ModelError> {
        let toward = "normals = [0, 1, 0]";
        let none = || {
            self.unsuited(
                "normals of bare nodes cannot be averaged: a vector towards the secondary side is needed",
                toward,
            )
        };
        let facets_of = |side: &Option<Facets>| side.clone().ok_or_else(none);
        match normals {
            Normals::Given(normal) => normal
                .normalized()
                .map(NodeNormals::Given)
                .ok_or_else(|| self.unsuited("the given normal is zero", toward)),
            Normals::Primary => facets_of(&self.primary).map(NodeNormals::Primary),
            Normals::Secondary => facets_of(&self.secondary).map(NodeNormals::Secondary),
        }
    }
}

fn facets(mesh: &Mesh, part: &ContactPart, faces: &[Face]) -> Result<Facets, ModelError> {
    Facets::new(mesh, faces).map_err(|source| ModelError::Facets {
        contact: part.name.clone(),
        source,
    })
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
