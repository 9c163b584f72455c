//! Contacts of either dialect.
//!
//! | record | here |
//! |---|---|
//! | `n2npenaltycontact`, `n2nlagrangianmultipliercontact` | node-to-node in the order of the sets, one for each direction of the pairs |
//! | `n2spenaltycontact`, `n2slagrangianmultipliercontact` | node-to-segment on faces, a circle or a polynomial; one for each segment |
//! | `structuralpenaltycontactbc` | gauss-point, penalty per area at the start |
//!
//! Points touch within facets only, `features = "faces"`, unless the record says `generalizedfeatures 1`.

use super::Translation;
use super::condition::CONTACTS;
use crate::case::{
    Contact, Enforcement, Features, Friction, Method, Name, Normals, Pairs, Per, PointKind,
    PointRule, Set, SetContent, Shape, Sliding, Space, Stick, Surface,
};
use crate::deck::Compat;
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::oofem::{Family, Fault, Record};
use signorini_geometry::mesh::{CellId, FaceIndex};
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Chosen, Value, Values};
use std::collections::BTreeMap;

/// Penalties that `autopenalty` may make for one surface.
const MOST_PENALTIES: usize = 64;

/// Pairs of nodes this near to each other have no direction.
const COINCIDENT: f64 = 1e-8;

/// Directions that differ by less are one.
const SAME: f64 = 1e-12;

/// What nodes are pressed on.
struct Segment {
    name: String,
    /// Whether it is faces of the mesh.
    is_mesh: bool,
    nside: usize,
}

/// A contact surface of elements.
struct FacetSurface {
    set: String,
    rule: Option<PointRule>,
    /// Whether its normals point into the body.
    inward: bool,
}

/// Penalties and friction of contact between facets.
struct FacetNumbers {
    /// Per area; none where it is made from the elements behind each facet.
    penalty: Option<f64>,
    /// Per area, of sticking.
    tangential: Option<f64>,
    /// The coefficient of friction.
    mu: f64,
    /// Where the penalty stands.
    at: Place,
}

impl FacetNumbers {
    /// The friction next to this normal penalty; sticking is as stiff as the normal direction where that is automatic.
    fn friction(&self, penalty: f64) -> Option<Friction> {
        let along = match self.penalty {
            Some(_) => self.tangential,
            None => Some(penalty),
        };
        (self.mu > 0.0).then(|| Friction {
            stick: along.filter(|pt| *pt > 0.0).map(Stick::Stiffness),
            ..Friction::coulomb(self.mu)
        })
    }
}

impl Translation {
    pub fn contacts(&mut self) {
        let segments = self.segments();
        let surfaces = self.surfaces();
        for mut record in std::mem::take(&mut self.parts.conditions) {
            let kind = record.kind();
            if !CONTACTS.contains(&kind.as_str()) {
                continue;
            }
            record.take_kind();
            let done = match kind.as_str() {
                "structuralpenaltycontactbc" => self.facet_contact(&mut record, &surfaces),
                _ if kind.starts_with("n2n") => self.node_to_node(&mut record),
                _ => self.node_to_segment(&mut record, &segments),
            };
            self.take(done);
            self.finish(&record);
        }
    }

    fn segments(&mut self) -> BTreeMap<u64, Segment> {
        let mut segments = BTreeMap::new();
        for mut record in std::mem::take(&mut self.parts.segments) {
            record.take_kind();
            let segment = self.segment(&mut record);
            if let Some(Some((number, segment))) = self.take(segment)
                && segments.insert(number, segment).is_some()
            {
                let text = format!("a second segment has the number {number}");
                self.error(&codes::NAME_TWICE, text, &record.place(), "");
            }
            self.finish(&record);
        }
        segments
    }

    fn segment(&mut self, record: &mut Record) -> Result<Option<(u64, Segment)>, Fault> {
        let number = record.number()?;
        let place = record.place();
        let mut wrong = None;
        let shape = match record.kind().as_str() {
            "linear2delementedgecontactsegment" | "linear3delementsurfacecontactsegment" => {
                let segment = self.sides(record)?;
                return Ok(segment.map(|segment| (number, segment)));
            }
            "circlecontactsegment" => {
                let center = record.need_reals("centerpoint")?;
                let radius = record.need_real("radius")?;
                let at = |k: usize| center.get(k).copied().unwrap_or(0.0);
                if radius <= 0.0 {
                    wrong = Some("the radius is not positive");
                }
                let name = if self.ndim() == 2 { "circle" } else { "sphere" };
                let values = Values::new()
                    .with("center", Value::Numbers(vec![at(0), at(1), at(2)]))
                    .with("radius", Value::Number(radius))
                    .with("side", Value::Text("outside".to_owned()));
                Chosen { name, values }
            }
            "polynomialcontactsegment" => {
                let coefficients = record.need_reals("coeffs")?;
                if coefficients.is_empty() {
                    wrong = Some("the polynomial has no coefficients");
                } else if self.ndim() != 2 {
                    wrong = Some("polynomials are curves of plane models");
                }
                let values = Values::new()
                    .with("coefficients", Value::Numbers(coefficients))
                    .with("side", Value::Text("above".to_owned()));
                Chosen {
                    name: "polynomial",
                    values,
                }
            }
            other => {
                let text = format!("the contact segment `{other}` is not supported");
                let known =
                    "linear2dElementEdge, linear3dElementSurface, circle and polynomial are";
                self.not_built(text, &place, known);
                record.ignore_all();
                return Ok(None);
            }
        };
        if let Some(wrong) = wrong {
            self.error(&codes::OUT_OF_RANGE, wrong, &place, "");
            return Ok(None);
        }
        let name = self.fresh(&format!("segment-{number}"));
        self.case.surfaces.push(Surface {
            name: Spanned::new(name.clone(), place.clone()),
            shape: Shape::Analytical(shape),
            reference: None,
            triangles: None,
            place,
        });
        let segment = Segment {
            name,
            is_mesh: false,
            nside: 1,
        };
        Ok(Some((number, segment)))
    }

    /// A segment of sides of elements.
    fn sides(&mut self, record: &mut Record) -> Result<Option<Segment>, Fault> {
        let place = record.place();
        let set = record.whole("edgeset")?;
        let set = match set {
            Some(set) => set,
            None => record.need_whole("boundaryset")?,
        };
        if record.whole("normmode")?.is_some_and(|mode| mode != 0) {
            let place = record.place_of_field("normmode");
            self.not_built("`normmode` other than 0 is not supported", &place, "");
        }
        let update = record.whole("pairupdatemode")?;
        let names = self.meshed.sets.get(&set);
        let Some(name) = names.and_then(|names| names.sides.clone()) else {
            let text = format!("set {set} has no sides of elements");
            self.error(&codes::WRONG_KIND, text, &place, "");
            return Ok(None);
        };
        let nside = self
            .meshed
            .mesh
            .sets
            .get(&name)
            .map_or(0, |s| s.faces.len());
        if nside > 1 && update.is_none_or(|mode| mode < 2) {
            let text = "the nearest side of this segment is found anew all the time";
            let remark = "OOFEM keeps it unless the record says  pairupdatemode 2";
            self.warn(text, &place, remark);
        }
        Ok(Some(Segment {
            name,
            is_mesh: true,
            nside,
        }))
    }

    fn surfaces(&mut self) -> BTreeMap<u64, FacetSurface> {
        let mut surfaces = BTreeMap::new();
        for mut record in std::mem::take(&mut self.parts.surfaces) {
            record.take_kind();
            let surface = self.facet_surface(&mut record);
            if let Some(Some((number, surface))) = self.take(surface)
                && surfaces.insert(number, surface).is_some()
            {
                let text = format!("a second contact surface has the number {number}");
                self.error(&codes::NAME_TWICE, text, &record.place(), "");
            }
            self.finish(&record);
        }
        surfaces
    }

    fn facet_surface(&mut self, record: &mut Record) -> Result<Option<(u64, FacetSurface)>, Fault> {
        let number = record.number()?;
        let place = record.place();
        if record.kind() != "structuralfecontactsurface" {
            let text = format!("the contact surface `{}` is not supported", record.kind());
            self.not_built(text, &place, "StructuralFEContactSurface is");
            record.ignore_all();
            return Ok(None);
        }
        let set = record.need_whole("ce_set")?;
        let names = self.meshed.sets.get(&set);
        let Some(name) = names.and_then(|names| names.elements.clone()) else {
            let text = format!("set {set} has no elements");
            self.error(&codes::WRONG_KIND, text, &place, "");
            return Ok(None);
        };
        let mesh = &self.meshed.mesh;
        let cells = mesh
            .sets
            .get(&name)
            .map_or(&[][..], |set| &set.cells)
            .to_vec();
        let mut rules = Vec::new();
        for cell in &cells {
            let label = self.meshed.mesh.cell_label(*cell).unwrap_or(0);
            let at = self.meshed.elements.get(&label).copied();
            let kind = at.and_then(|at| self.meshed.kinds.get(at).copied());
            if kind.is_none_or(|kind| kind.family != Family::Contact) {
                let text = format!("element {label} of set {set} is no contact element");
                self.error(&codes::WRONG_KIND, text, &place, "");
                return Ok(None);
            }
            let records = at.and_then(|at| self.parts.elements.get_mut(at));
            let points = records.map_or(Ok(None), |record| record.whole("nip"))?;
            let kind = kind.map_or("", |kind| kind.name);
            rules.push(point_rule(kind, points));
        }
        let rule = rules.first().copied().flatten();
        if rules.iter().any(|one| *one != rule) || rule.is_none() {
            let text = "the integration points of this surface are not supported";
            let why = "2 and 1 of lines, 4 and 1 of quadrilaterals, 3 of triangles are, of all facets the same";
            self.not_built(text, &place, why);
        }
        let inward = self.points_inward(&cells);
        Ok(Some((
            number,
            FacetSurface {
                set: name,
                rule,
                inward,
            },
        )))
    }

    /// Whether the nodes of any facet run round so that its normal points into the body behind it.
    fn points_inward(&self, facets: &[CellId]) -> bool {
        let mesh = &self.meshed.mesh;
        let index = FaceIndex::new(mesh, mesh.cells(mesh.dim()));
        facets.iter().any(|&facet| {
            let nodes = mesh.cell(facet);
            let behind = mesh.element(facet).and_then(|e| index.find(e, nodes));
            let outward = behind.and_then(|(face, _)| mesh.face(face));
            outward.is_some_and(|(_, outward)| !runs_as(nodes, &outward))
        })
    }

    fn contact(
        &mut self,
        wanted: String,
        [secondary, primary]: [Name; 2],
        place: &Place,
    ) -> Contact {
        let name = Spanned::new(self.fresh(&wanted), place.clone());
        let mut contact = Contact::new(name, secondary, primary, place.clone());
        contact.method = Method::NodeToSegment.into();
        contact.sliding = Sliding::Finite;
        contact
    }

    /// What the contacts of nodes have in common: their number, and how they prevent penetration.
    fn of_nodes(&mut self, record: &mut Record) -> Result<(u64, Enforcement), Fault> {
        let number = record.number()?;
        record.ignore("loadtimefunction", 1);
        record.flag("usetangent");
        if !self.parts.analysis.flag("soldepextforces") {
            let text = "the analysis has no `soldepextforces`: OOFEM leaves out this contact";
            self.warn(text, &record.place(), "here it acts");
        }
        if record.kind().contains("lagrangianmultiplier") {
            return Ok((number, Enforcement::Lagrange));
        }
        let penalty = record.need_real("penalty")?;
        let place = record.place_of_field("penalty");
        if penalty <= 0.0 {
            let text = format!("the penalty is {penalty}");
            self.error(&codes::OUT_OF_RANGE, text, &place, "it must be positive");
        }
        let penalty = Spanned::new(penalty, place);
        Ok((number, Enforcement::Penalty(Some(penalty))))
    }

    /// A vector of a record, of any length but zero.
    fn direction(&mut self, record: &mut Record) -> Result<Option<Vec3>, Fault> {
        let Some(values) = record.reals("normal")? else {
            return Ok(None);
        };
        let at = |k: usize| values.get(k).copied().unwrap_or(0.0);
        let normal = Vec3::new(at(0), at(1), at(2)).normalized();
        if normal.is_none() {
            let place = record.place_of_field("normal");
            self.error(&codes::OUT_OF_RANGE, "the normal has no length", &place, "");
        }
        Ok(normal)
    }

    fn node_to_node(&mut self, record: &mut Record) -> Result<(), Fault> {
        let place = record.place();
        let (number, enforcement) = self.of_nodes(record)?;
        let masters = record.need_whole("masterset")?;
        let slaves = record.need_whole("slaveset")?;
        let given = self.direction(record)?;
        let masters = self.labels_of_set(masters, &place);
        let slaves = self.labels_of_set(slaves, &place);
        let (Some(masters), Some(slaves)) = (masters, slaves) else {
            return Ok(());
        };
        if masters.len() != slaves.len() {
            let text = format!("{} nodes meet {}", slaves.len(), masters.len());
            self.error(&codes::WRONG_LENGTH, text, &place, "they meet in pairs");
            return Ok(());
        }
        let mut directions: Vec<(Vec3, Vec<u64>, Vec<u64>)> = Vec::new();
        for (&master, &slave) in masters.iter().zip(&slaves) {
            let apart = self.position(slave) - self.position(master);
            let normal = match given {
                Some(normal) => normal,
                None if apart.norm() > COINCIDENT => apart * (1.0 / apart.norm()),
                None => {
                    let text = format!("nodes {master} and {slave} lie in one place");
                    let remark = "their contact needs a `normal`";
                    self.error(&codes::MISSING, text, &place, remark);
                    return Ok(());
                }
            };
            let same = |known: &Vec3| (*known - normal).norm() < SAME;
            match directions.iter_mut().find(|(known, ..)| same(known)) {
                Some((_, of_masters, of_slaves)) => {
                    of_masters.push(master);
                    of_slaves.push(slave);
                }
                None => directions.push((normal, vec![master], vec![slave])),
            }
        }
        for (normal, masters, slaves) in directions {
            let sides = [
                self.nodes_named(slaves, &place),
                self.nodes_named(masters, &place),
            ];
            let mut contact = self.contact(format!("contact-{number}"), sides, &place);
            contact.method = Method::NodeToNode.into();
            contact.enforcement = enforcement.clone();
            contact.per = Some(Per::Node);
            contact.normals = Normals::Given(normal.to_array());
            contact.pairs = Pairs::Order;
            self.case.contacts.push(contact);
        }
        Ok(())
    }

    fn position(&self, label: u64) -> Vec3 {
        let mesh = &self.meshed.mesh;
        let node = mesh.node_labels.iter().position(|known| *known == label);
        let point = node.and_then(|node| mesh.points.get(node));
        point.copied().unwrap_or_default()
    }

    fn node_to_segment(
        &mut self,
        record: &mut Record,
        segments: &BTreeMap<u64, Segment>,
    ) -> Result<(), Fault> {
        let place = record.place();
        let (number, enforcement) = self.of_nodes(record)?;
        let nodes = record.need_wholes("nodeset")?;
        let wanted = record.need_wholes("segmentset")?;
        if record.reals("normal")?.is_some() {
            let text = "a given `normal` of contact with segments is not supported";
            let why = "normals are those of the segments";
            self.not_built(text, &record.place_of_field("normal"), why);
        }
        for &node in &nodes {
            if !self.meshed.mesh.node_labels.contains(&node) {
                let text = format!("there is no node {node}");
                let at = record.place_of_field("nodeset");
                self.error(
                    &codes::UNDEFINED,
                    text,
                    &at,
                    "`nodeset` lists nodes, not sets",
                );
                return Ok(());
            }
        }
        if nodes.is_empty() {
            let text = "the contact has no nodes";
            self.error(&codes::MISSING, text, &place, "");
            return Ok(());
        }
        for segment in wanted {
            let Some(segment) = segments.get(&segment) else {
                let text = format!("there is no contact segment {segment}");
                let at = record.place_of_field("segmentset");
                self.error(&codes::UNDEFINED, text, &at, "");
                continue;
            };
            let sides = [
                self.nodes_named(nodes.clone(), &place),
                Spanned::new(segment.name.clone(), place.clone()),
            ];
            let mut contact = self.contact(format!("contact-{number}"), sides, &place);
            contact.enforcement = enforcement.clone();
            contact.per = Some(Per::Node);
            if segment.is_mesh {
                contact.features = Features::Faces;
                // normals and places are those of the start
                if !self.nonlinear && segment.nside > 0 {
                    contact.sliding = Sliding::Small;
                }
            }
            self.case.contacts.push(contact);
        }
        Ok(())
    }

    fn facet_contact(
        &mut self,
        record: &mut Record,
        surfaces: &BTreeMap<u64, FacetSurface>,
    ) -> Result<(), Fault> {
        let place = record.place();
        let number = record.number()?;
        // it acts at all times
        record.ignore("loadtimefunction", 1);
        record.wholes("dofs")?;
        for keyword in [
            "algo",
            "searchpadding",
            "searchtol",
            "tangentmode",
            "fdcheck",
            "fdperturbation",
            "fdoutputprefix",
            "fdtolerance",
            "facethysteresis",
        ] {
            record.ignore(keyword, 1);
        }
        let numbers = self.facet_numbers(record)?;
        self.refuse_facet_options(record)?;
        let features = match record.whole("generalizedfeatures")? {
            Some(1..) => Features::Edges,
            _ => Features::Faces,
        };
        let primary = record.need_whole("mastersurface")?;
        let secondary = record.need_whole("slavesurface")?;
        let mut side = |number: u64| {
            let found = surfaces.get(&number);
            if found.is_none() {
                let text = format!("there is no contact surface {number}");
                self.error(&codes::UNDEFINED, text, &place, "");
            }
            found
        };
        let (Some(primary), Some(secondary)) = (side(primary), side(secondary)) else {
            return Ok(());
        };
        self.check_facets(primary, &place);
        let passes = match numbers.penalty {
            Some(penalty) => vec![(penalty, secondary.set.clone())],
            None => self.automatic_passes(&secondary.set, &numbers.at),
        };
        for (penalty, set) in passes {
            let sides = [
                Spanned::new(set, place.clone()),
                Spanned::new(primary.set.clone(), place.clone()),
            ];
            let mut contact = self.contact(format!("contact-{number}"), sides, &place);
            contact.method = Method::GaussPoint.into();
            contact.rule = secondary.rule.unwrap_or_default();
            contact.features = features;
            let spanned = Spanned::new(penalty, numbers.at.clone());
            contact.enforcement = Enforcement::Penalty(Some(spanned));
            contact.per = Some(Per::Area);
            contact.friction = numbers.friction(penalty);
            contact.remembers_traction = contact.friction.is_some() && self.compat == Compat::Oofem;
            self.case.contacts.push(contact);
        }
        Ok(())
    }

    /// Reads and checks penalties and the coefficient of friction.
    fn facet_numbers(&mut self, record: &mut Record) -> Result<FacetNumbers, Fault> {
        let automatic = record.whole("autopenalty")?.is_some_and(|value| value != 0);
        let penalty = match automatic {
            // what the record says is not taken
            true => record.real("pn")?.and(None),
            false => Some(record.need_real("pn")?),
        };
        let tangential = record.real("pt")?;
        let at = record.place_of_field(if automatic { "autopenalty" } else { "pn" });
        let mu = record.real("friction")?.unwrap_or(0.0);
        if let Some(penalty) = penalty.filter(|penalty| *penalty <= 0.0) {
            let text = format!("the penalty is {penalty}");
            self.error(&codes::OUT_OF_RANGE, text, &at, "it must be positive");
        }
        if mu < 0.0 {
            let at = record.place_of_field("friction");
            self.error(&codes::OUT_OF_RANGE, "the friction is negative", &at, "");
        }
        Ok(FacetNumbers {
            penalty,
            tangential,
            mu,
            at,
        })
    }

    /// Reports options that are not built, and a number of dimensions that is not that of the model.
    fn refuse_facet_options(&mut self, record: &mut Record) -> Result<(), Fault> {
        for (keyword, why) in [
            (
                "frictiontransition",
                "sticking goes over into slipping sharply",
            ),
            ("frictionhardening", "the limit of friction does not harden"),
            (
                "directionalprojection",
                "points are projected to the nearest place",
            ),
        ] {
            if record.real(keyword)?.is_some_and(|value| value != 0.0) {
                let at = record.place_of_field(keyword);
                self.not_built(format!("`{keyword}` is not supported"), &at, why);
            }
        }
        let space = record.whole("nsd")?.unwrap_or(self.ndim() as u64);
        if space != self.ndim() as u64 {
            let text = format!("`nsd` is {space} in a model of {} dimensions", self.ndim());
            let at = record.place_of_field("nsd");
            self.error(&codes::CONTRADICTION, text, &at, "");
        }
        Ok(())
    }

    /// Reports what contact of facets with this primary surface cannot be, or is only with another normal.
    fn check_facets(&mut self, primary: &FacetSurface, place: &Place) {
        if *self.case.model.space == Space::Axisymmetric {
            let text = "contact surfaces of bodies of revolution are not supported in decks";
            let why = "what their penalties refer to was not verified";
            self.not_built(text, place, why);
        }
        if primary.inward {
            let text =
                "the nodes of the master surface run round so that its normals point into the body";
            self.warn(text, place, "here normals point out of it");
        }
    }

    /// Penalties made from the elements behind the facets of a set, each with the set of those that have it: one contact
    /// has one.
    fn automatic_passes(&mut self, set: &str, at: &Place) -> Vec<(f64, String)> {
        let alike = match self.automatic_penalties(set) {
            Ok(alike) if alike.len() <= MOST_PENALTIES => alike,
            Ok(alike) => {
                let text = format!(
                    "`autopenalty` makes {} penalties, more than {MOST_PENALTIES}",
                    alike.len()
                );
                self.not_built(text, at, "write one in `pn`");
                return Vec::new();
            }
            Err(why) => {
                self.not_built("`autopenalty` is not possible here", at, &why);
                return Vec::new();
            }
        };
        if let [one] = &alike[..] {
            return vec![(one.penalty, set.to_owned())];
        }
        let mut passes = Vec::with_capacity(alike.len());
        for one in alike {
            let name = Spanned::new(self.fresh(set), at.clone());
            passes.push((one.penalty, name.value.clone()));
            self.case.sets.push(Set {
                name,
                content: SetContent::Elements(one.facets),
                place: at.clone(),
            });
        }
        passes
    }
}

/// The points of a facet.
fn point_rule(kind: &str, points: Option<u64>) -> Option<PointRule> {
    let rule = |kind, points| {
        Some(PointRule {
            kind,
            points: Some(points),
            cut: false,
        })
    };
    let is_line = kind.contains("line");
    let most = if is_line { 2 } else { 4 };
    if kind.ends_with("trlin") {
        return match points.unwrap_or(3) {
            1 => rule(PointKind::Gauss, 1),
            3 => rule(PointKind::Gauss, 2),
            _ => None,
        };
    }
    match points.unwrap_or(most) {
        1 => rule(PointKind::Gauss, 1),
        n if n == most && kind.ends_with("gauss") => rule(PointKind::Gauss, 2),
        n if n == most => rule(PointKind::Lobatto, 2),
        _ => None,
    }
}

/// Whether nodes run round in the same sense as others do, which are the same corners.
fn runs_as(nodes: &[u32], others: &[u32]) -> bool {
    let Some(first) = nodes.first() else {
        return true;
    };
    let Some(at) = others.iter().position(|node| node == first) else {
        return true;
    };
    if nodes.len() == 2 {
        return at == 0;
    }
    let next = others.get((at + 1) % others.len().max(1));
    next == nodes.get(1)
}
