//! Contact pairs with their laws, ties, gaps.
//!
//! | deck | by default | with [`Compat::Ccx`] |
//! |---|---|---|
//! | HARD, LINEAR, none | the best way to hold surfaces apart | a penalty: K, or 50 E of the first material; at nodes rounded by an arctangent, with a tension σ∞, or E/70000, within c0 |
//! | EXPONENTIAL, TABULAR | the same law | the same law |
//! | TIED | sides that are joined | by a penalty: K, or 50 E, along the normal, the slope of sticking across it; distances at the start are pulled together |
//! | \*TIE | sides that are joined | the same, node to segment by multipliers; in the plane, corner nodes alone |
//! | TYPE | the best method | node to segment, points inside facets, mortar |
//! | friction | μ | μ and the slope of sticking, or E/2 |
//! | overlaps | resolved over the first step | likewise, measured again in every increment, or in the first one only |
//! | GAPUNI | no penetration | as LINEAR at nodes: K, or 1e12, and σ∞, or 1e-3 |
//! | a surface of nodes | the outer faces between them | the nodes, with their parts of all outer faces around |
//!
//! Source: the laws of CalculiX are those of its User's Manual, sections on contact.

use super::compat::Compat;
use super::interaction::{Interaction, Law};
use super::translation::Translation;
use crate::case::{
    Area, Basis, Contact, ContactChange, Enforcement, Features, Friction, Interference, Method,
    Name, Normals, Offset, Pairs, Per, Sliding, Start, Step, Stick, Tied,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared, number};
use signorini_geometry::mesh::{NodeId, boundary};
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{Chosen, Value};
use std::collections::{BTreeMap, BTreeSet};

/// A penalty over the first modulus of the deck, where CalculiX finds none.
const PENALTY: f64 = 50.0;
/// The slope of sticking over the first modulus of the deck, likewise.
const STICK: f64 = 0.5;
/// Points of a facet along each direction: so many that their sums are the integrals over what touches, which CalculiX
/// takes over the parts of facets that meet one another.
const POINTS: u64 = 8;
/// The first modulus of the deck over the tension that nodes feel at a distance, likewise.
const TENSION: f64 = 70_000.0;
/// How far they feel it, in sizes of the facets, likewise.
const WITHIN: f64 = 1e-3;
/// The stiffness and the tension of a gap element, likewise.
const GAP: [f64; 2] = [1e12, 1e-3];
/// How far nodes may be from the surface that they are tied to, in sizes of its elements.
const TIE: f64 = 0.025;

/// A line of *CONTACT PAIR.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// The name of its interaction, as names are compared.
    named: String,
    interaction: Interaction,
    method: Method,
    /// The place in the case of the contact that acts for it.
    contact: usize,
}

/// Where a pair is said to be.
#[derive(Clone, Debug)]
pub(super) struct Sides {
    pub secondary: Name,
    pub primary: Name,
}

/// A number, or what stands for it where it is not positive.
fn given(number: f64, otherwise: f64) -> f64 {
    if number > 0.0 { number } else { otherwise }
}

impl Translation<'_> {
    pub fn contacts(&mut self) {
        self.named_twice("SURFACEINTERACTION");
        let interactions = self.interactions();
        for card in self.cards("CONTACTPAIR") {
            self.pairs(card, &interactions);
        }
        self.general(&interactions);
        self.clearances();
        // the sides of a sector are no contact
        let ties = self.cards("TIE").filter(|card| !card.has("CYCLICSYMMETRY"));
        ties.for_each(|card| self.tie(card));
        self.cards("GAP").for_each(|card| self.gaps(card));
    }

    /// Young's modulus of the first material.
    fn first_modulus(&self) -> f64 {
        let first = self.case.materials.first();
        let known = first.and_then(|one| self.materials.get(&compared(&one.name)));
        known
            .and_then(super::material::Properties::modulus)
            .unwrap_or(1.0)
    }

    fn pairs(&mut self, card: &Statement, interactions: &BTreeMap<String, Interaction>) {
        let named = self.need(card, "INTERACTION").map(compared);
        let named = named.unwrap_or_default();
        let Some(interaction) = interactions.get(&named) else {
            if !named.is_empty() {
                let text = format!("there is no surface interaction `{named}`");
                self.error(&codes::UNDEFINED, text, &card.place, "");
            }
            return;
        };
        let kind = card.get("TYPE").map(compared).unwrap_or_default();
        let method = match kind.as_str() {
            "" | "NODETOSURFACE" => Method::NodeToSegment,
            "SURFACETOSURFACE" => Method::GaussPoint,
            "MORTAR" | "LINMORTAR" | "PGLINMORTAR" => Method::Mortar,
            _ => {
                let text = format!("*CONTACT PAIR, TYPE={kind} is not supported");
                self.error(&codes::NOT_BUILT, text, &card.place, "");
                return;
            }
        };
        let mut start = Start::default();
        if let Some(text) = card.get("ADJUST") {
            match number(text) {
                Some(within) => start.close_gaps_below = within,
                None => start.close_gaps_of = self.set(card, text, &card.place, Kind::Nodes),
            }
        }
        for row in card.rows() {
            let Some(sides) = self.sides(card, &row, method == Method::NodeToSegment) else {
                continue;
            };
            let mut contact = self.contact(sides, &card.place);
            if card.has("SMALLSLIDING") {
                contact.sliding = match self.compat {
                    Compat::None | Compat::Oofem => Sliding::Small,
                    Compat::Ccx => Sliding::Increment,
                };
            }
            self.obey(&mut contact, interaction, method);
            if self.compat == Compat::Ccx && method == Method::GaussPoint {
                contact.rule.cut = true;
                contact.features = Features::Faces;
            }
            contact.start = start.clone();
            self.pairs.push(Pair {
                named: named.clone(),
                interaction: interaction.clone(),
                method,
                contact: self.case.contacts.len(),
            });
            self.case.contacts.push(contact);
        }
    }

    /// The secondary and the primary side that a line names; `at_nodes`: of contact at nodes.
    fn sides(&mut self, card: &Statement, row: &[Field<'_>], at_nodes: bool) -> Option<Sides> {
        let [secondary, primary] = row.first_chunk()?;
        let both = [secondary, primary].map(|side| (side.text, side.place()));
        self.sides_of(card, both, at_nodes)
    }

    /// The same, of two names. A name may be that of a surface of faces and of one of nodes: contact at nodes takes the
    /// nodes, as CalculiX does, whichever comes first; all other contact the faces.
    pub fn sides_of(
        &mut self,
        card: &Statement,
        [secondary, primary]: [(&str, Place); 2],
        at_nodes: bool,
    ) -> Option<Sides> {
        let primary = self.set(card, primary.0, &primary.1, Kind::Surface);
        let nodes = self.set_if(card, secondary.0, &secondary.1, Kind::SurfaceOfNodes);
        if self.compat == Compat::Ccx
            && let (Some(secondary), Some(primary)) = (nodes, primary.clone())
            && (at_nodes || self.between(&secondary, &primary).is_some())
        {
            return Some(Sides { secondary, primary });
        }
        let secondary = self.set(card, secondary.0, &secondary.1, Kind::Surface);
        Some(Sides {
            secondary: self.faced(secondary?),
            primary: primary?,
        })
    }

    /// A surface of nodes as the outer faces between them, where every node has one: they know the area that each node
    /// stands for. CalculiX takes nodes as they are.
    pub fn faced(&mut self, surface: Name) -> Name {
        if self.compat == Compat::Ccx {
            return surface;
        }
        let mesh = &self.deck.mesh;
        let nodes = match mesh.sets.get(&surface.value) {
            Some(set) if set.is_bare() => &set.nodes,
            _ => return surface,
        };
        let solids = self.solids();
        let outer = self.outer.get_or_insert_with(|| boundary(mesh, solids));
        let mut sides = Vec::new();
        let mut met = vec![false; nodes.len()];
        for face in outer.iter() {
            let of_face = mesh.face(*face).map(|(_, nodes)| nodes).unwrap_or_default();
            let at: Option<Vec<usize>> = of_face
                .iter()
                .map(|node| nodes.binary_search(node).ok())
                .collect();
            if let (Some(at), Some(label)) = (at, mesh.cell_label(face.cell)) {
                sides.push((label, face.side + 1));
                for place in at {
                    met[place] = true;
                }
            }
        }
        if !met.iter().all(|met| *met) {
            return surface;
        }
        if let Some(known) = self.faced.get(&surface.value) {
            return Spanned::new(known.clone(), surface.place);
        }
        let name = self.sides_named(sides, &surface.place);
        self.faced.insert(surface.value, name.value.clone());
        name
    }

    /// A contact with nothing but defaults.
    fn contact(&mut self, sides: Sides, place: &Place) -> Contact {
        let name = format!("{}-{}", sides.secondary.value, sides.primary.value);
        let name = Spanned::new(self.fresh(&name), place.clone());
        let mut contact = Contact::new(name, sides.secondary, sides.primary, place.clone());
        if self.compat == Compat::Ccx {
            // CalculiX pairs again where the nodes have moved to, with NLGEOM or without
            contact.sliding = Sliding::Finite;
        }
        contact
    }

    /// The law of a contact.
    pub(super) fn obey(&self, contact: &mut Contact, to: &Interaction, method: Method) {
        let exact = self.compat == Compat::Ccx;
        let place = contact.place.clone();
        let by = |stiffness| Enforcement::Penalty(Some(Spanned::new(stiffness, place.clone())));
        let penalty = |[stiffness, tension, within]: [f64; 3]| match method {
            Method::NodeToSegment => Enforcement::Law(Chosen::new(
                "arctangent",
                [
                    ("stiffness", stiffness),
                    ("tension", given(tension, self.first_modulus() / TENSION)),
                    ("within", given(within, WITHIN)),
                ],
            )),
            _ => by(stiffness),
        };
        let hard = PENALTY * self.first_modulus();
        let damps = to.damping != [0.0; 2];
        contact.damping = to.damping(exact);
        contact.enforcement = match &to.law {
            Law::Hard if exact && method != Method::Mortar => penalty([hard, 0.0, 0.0]),
            Law::Linear(numbers) if exact => penalty(*numbers),
            // multipliers do not yield, so that nothing damps
            &Law::Linear([stiffness, ..]) if damps => by(stiffness),
            Law::Hard if damps => Enforcement::Penalty(None),
            Law::Hard | Law::Linear(_) => Enforcement::Auto,
            &Law::Exponential { c0, p0 } => {
                let mut law = Chosen::new("exponential", [("p0", p0), ("c0", c0)]);
                if exact {
                    // of points in faces, CalculiX looks at those that penetrate; of nodes, up to c0
                    let within = match method {
                        Method::NodeToSegment => c0,
                        _ => 0.0,
                    };
                    law.values = law.values.with("within", Value::Number(within));
                }
                Enforcement::Law(law)
            }
            Law::Table(rows) => {
                let falling = rows.iter().rev().map(|[pressure, over]| [-over, *pressure]);
                Enforcement::Table(falling.collect())
            }
            Law::Tied(stiffness) => {
                let by_penalty = exact && method != Method::Mortar;
                contact.tied = Some(Tied {
                    offset: match by_penalty {
                        true => Offset::Pull,
                        false => Offset::Keep,
                    },
                    within: None,
                    penalty_tangential: to.friction.filter(|_| by_penalty).map(|f| self.slope(f)),
                });
                match by_penalty {
                    true => by(given(*stiffness, hard)),
                    false => Enforcement::Auto,
                }
            }
        };
        if exact {
            contact.method = method.into();
            if method == Method::Mortar {
                contact.basis = Basis::Whole;
            }
            if method == Method::GaussPoint {
                contact.rule.points = Some(POINTS);
                contact.area = Area::Current;
                contact.sliding = Sliding::Increment;
            }
            let secondary = self.deck.mesh.sets.get(&contact.secondary.value);
            let by_nodes = secondary.is_some_and(|set| !set.nodes.is_empty());
            if method == Method::NodeToSegment && by_nodes {
                // CalculiX expands planes into space, where these nodes are none of the faces: it takes those opposite, as of
                // nodes that belong to no element
                let in_plane = self.case.model.space.ndim() == 2;
                contact.area =
                    match in_plane || secondary.is_some_and(|set| self.are_bare(&set.nodes)) {
                        true => Area::Opposite,
                        false => Area::Adjacent,
                    };
            }
            if !matches!(contact.enforcement, Enforcement::Auto) {
                contact.per = Some(Per::Area);
            }
        }
        let of_faces = method != Method::NodeToSegment;
        (contact.conductance, contact.friction_heat) = self.heat_of_gap(&to.heat, of_faces);
        if let Some(cohesive) = to.bond.cohesive() {
            contact.tied = Some(Tied::default());
            contact.cohesive = Some(cohesive);
            if contact.enforcement.is_curve() {
                contact.enforcement = Enforcement::Auto;
            }
        }
        // tied sides do not slide
        let slides = contact.tied.is_none() || contact.cohesive.is_some();
        let rubs = to.friction.filter(|_| slides);
        contact.friction = rubs.and_then(|given| self.rubbing(given));
    }

    /// Whether nodes belong to no element.
    fn are_bare(&self, nodes: &[NodeId]) -> bool {
        let mesh = &self.deck.mesh;
        let shells = self.deck.directory.shells().iter().copied();
        let mut cells = mesh.cells(mesh.dim()).chain(shells);
        !cells.any(|cell| mesh.cell(cell).iter().any(|node| nodes.contains(node)))
    }

    /// The slope of sticking.
    fn slope(&self, [_, slope]: [f64; 2]) -> f64 {
        given(slope, STICK * self.first_modulus())
    }

    /// Friction; none where its coefficient is zero.
    fn rubbing(&self, given: [f64; 2]) -> Option<Friction> {
        let [mu, _] = given;
        let stick = match self.compat {
            Compat::None | Compat::Oofem => None,
            Compat::Ccx => Some(Stick::Stiffness(self.slope(given))),
        };
        (mu > 0.0).then_some(Friction {
            stick,
            ..Friction::coulomb(mu)
        })
    }

    fn clearances(&mut self) {
        for card in self.cards("CLEARANCE") {
            let (slave, master) = (self.need(card, "SLAVE"), self.need(card, "MASTER"));
            let (Some(slave), Some(master)) = (slave, master) else {
                continue;
            };
            let both = [slave, master].map(|name| (name, card.place.clone()));
            let sides = self.sides_of(card, both, false);
            let Some(value) = card.get("VALUE").and_then(number) else {
                let text = "*CLEARANCE without a number for VALUE is not supported";
                self.error(&codes::NOT_BUILT, text, &card.place, "");
                continue;
            };
            let Some(Sides { secondary, primary }) = sides else {
                continue;
            };
            let Some(at) = self.pair_of(card, &secondary, &primary) else {
                continue;
            };
            let Some(contact) = self.case.contacts.get_mut(at) else {
                continue;
            };
            if contact.tied.is_some() {
                let text = "*CLEARANCE of a pair that is TIED is not supported";
                let remark = "it would pull the sides apart or together: move the nodes instead";
                self.error(&codes::NOT_BUILT, text, &card.place, remark);
                continue;
            }
            contact.start.clearance = Some(value);
        }
    }

    fn tie(&mut self, card: &Statement) {
        let given = self.parameter(card, "POSITIONTOLERANCE", "POSITION TOLERANCE");
        for row in card.rows() {
            let Some(sides) = self.sides(card, &row, false) else {
                continue;
            };
            let near = TIE * self.size_of(&sides.primary);
            let mut contact = self.contact(sides, &card.place);
            contact.tied = Some(Tied {
                offset: match card.get("ADJUST").map(compared).as_deref() {
                    Some("NO") => Offset::Keep,
                    _ => Offset::Close,
                },
                within: Some(given.unwrap_or(near)),
                penalty_tangential: None,
            });
            if self.compat == Compat::Ccx {
                contact.method = Method::NodeToSegment.into();
                contact.enforcement = Enforcement::Lagrange;
                contact.secondary = self.corners(contact.secondary, card);
            }
            self.case.contacts.push(contact);
        }
    }

    /// The nodes of a side that CalculiX ties in a model of the plane or of revolution: not those in the middle of edges,
    /// whose counterparts in its expanded elements depend on others already.
    fn corners(&mut self, surface: Name, card: &Statement) -> Name {
        let mesh = &self.deck.mesh;
        let set = mesh.sets.get(&surface.value);
        let Some(set) = set.filter(|_| self.ndim() == 2 && mesh.dim() == 2) else {
            return surface;
        };
        let sides = set.faces.iter().filter_map(|face| mesh.face(*face));
        let mut nodes: Vec<NodeId> = sides.flat_map(|(_, nodes)| nodes).collect();
        nodes.extend(&set.nodes);
        let middles: BTreeSet<NodeId> = mesh
            .cells(2)
            .filter_map(|cell| {
                let corners = mesh.element(cell)?.sides().len();
                mesh.cell(cell).get(corners..)
            })
            .flatten()
            .copied()
            .collect();
        let count = nodes.len();
        nodes.retain(|node| !middles.contains(node));
        if nodes.len() == count {
            return surface;
        }
        nodes.sort_unstable();
        nodes.dedup();
        let label = |node: &NodeId| mesh.node_labels.get(*node as usize).copied();
        let labels = nodes.iter().filter_map(label).collect();
        let text = "as in CalculiX, nodes in the middle of edges are not tied in the plane";
        self.note(text, &card.place);
        self.nodes_named(labels, &surface.place)
    }

    /// The mean size of the elements of a surface: the edge of a cube as large as the box around each.
    fn size_of(&self, surface: &Name) -> f64 {
        let mesh = &self.deck.mesh;
        let faces = mesh
            .sets
            .get(&surface.value)
            .map_or(&[][..], |set| &set.faces);
        let size = |cell| -> Option<f64> {
            let points = mesh
                .cell(cell)
                .iter()
                .map(|&node| mesh.points.get(node as usize));
            let points: Option<Vec<&Vec3>> = points.collect();
            let points = points?;
            let extent = |axis: usize| {
                let along = points.iter().map(|x| x.to_array()[axis]);
                let ends = along.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
                ends.1 - ends.0
            };
            if self.deck.directory.is_shell(cell) {
                let mut extents = [0, 1, 2].map(extent);
                extents.sort_by(|a, b| b.total_cmp(a));
                return Some((extents[0] * extents[1]).sqrt());
            }
            let ndim = mesh.dim();
            let product: f64 = (0..ndim).map(extent).product();
            Some(product.powf(1.0 / ndim as f64))
        };
        let sizes: Vec<f64> = faces.iter().filter_map(|face| size(face.cell)).collect();
        sizes.iter().sum::<f64>() / sizes.len().max(1) as f64
    }

    /// Gap elements: contact of two nodes along a given direction.
    fn gaps(&mut self, card: &Statement) {
        let Some(elset) = self.need(card, "ELSET") else {
            return;
        };
        let row = card.rows().next().unwrap_or_default();
        let [clearance, nx, ny, nz, _, stiffness, tension] = self.reals(&row);
        let normal = [nx, ny, nz];
        if Vec3::from(normal).normalized().is_none() {
            let text = "*GAP has no direction";
            self.error(
                &codes::OUT_OF_RANGE,
                text,
                &card.place,
                "clearance, nx, ny, nz",
            );
            return;
        }
        let directory = &self.deck.directory;
        let spaces = directory.spaces(card.scope).iter();
        let gaps: Vec<_> = spaces
            .flat_map(|&space| directory.special(space, elset))
            .filter(|element| element.kind.starts_with("GAP"))
            .collect();
        if gaps.is_empty() {
            let text = format!("element set `{elset}` has no gap elements");
            self.error(&codes::WRONG_KIND, text, &card.place, "");
        }
        for gap in gaps {
            let [first, second] = gap.nodes.as_slice() else {
                continue;
            };
            let sides = Sides {
                secondary: self.nodes_named(vec![*second], &card.place),
                primary: self.nodes_named(vec![*first], &card.place),
            };
            let mut contact = self.contact(sides, &card.place);
            contact.method = Method::NodeToNode.into();
            contact.normals = Normals::Given(normal);
            contact.pairs = Pairs::Order;
            contact.start.clearance = Some(clearance);
            contact.per = Some(Per::Node);
            contact.enforcement = match self.compat {
                Compat::None | Compat::Oofem => Enforcement::Lagrange,
                Compat::Ccx => Enforcement::Law(Chosen::new(
                    "arctangent",
                    [
                        ("stiffness", given(stiffness, GAP[0])),
                        ("tension", given(tension, GAP[1])),
                    ],
                )),
            };
            if self.compat == Compat::None {
                contact.per = None;
            }
            self.case.contacts.push(contact);
        }
    }

    /// What becomes of overlaps, as CalculiX has it: surfaces that may touch from the first step on allow for those that
    /// every increment of it begins with, and those that come to act later for those of their first increment; nodes do
    /// so in the first increment of the first step. All found by decks that overlap by known amounts. Gaps are those of
    /// straight facets.
    pub fn overlaps(&mut self) {
        if self.compat != Compat::None {
            for contact in &mut self.case.contacts {
                contact.start.straight_facets = contact.tied.is_none();
            }
        }
        if self.compat != Compat::Ccx {
            return;
        }
        for pair in &self.pairs {
            let Some(contact) = self.case.contacts.get_mut(pair.contact) else {
                continue;
            };
            if contact.tied.is_some() {
                continue;
            }
            let mut changes = (self.case.steps.first().into_iter()).flat_map(|step| &step.contacts);
            let change = changes.find(|change| change.name == contact.name);
            let acts = change.and_then(|c| c.active).unwrap_or(contact.active);
            contact.start.interference = match (pair.method, acts) {
                (Method::GaussPoint, true) => Interference::Increments,
                (Method::GaussPoint, false) | (Method::NodeToSegment, true) => {
                    Interference::Increment
                }
                (Method::NodeToSegment, false) => Interference::Now,
                _ => continue,
            };
        }
    }

    /// *MODEL CHANGE within a step.
    pub fn model_change(&mut self, card: &Statement, step: &mut Step) {
        let kind = card.get("TYPE").map(compared).unwrap_or_default();
        if kind == "ELEMENT" {
            self.change_elements(card, step);
            return;
        }
        if kind != "CONTACTPAIR" {
            let text = format!("*MODEL CHANGE, TYPE={kind} is not supported");
            let remark = "of elements and of contact pairs it is";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
            return;
        }
        let active = !card.has("REMOVE");
        for row in card.rows() {
            let Some(sides) = self.sides(card, &row, false) else {
                continue;
            };
            let Some(at) = self.pair_of(card, &sides.secondary, &sides.primary) else {
                continue;
            };
            if let Some(change) = self.change(step, at, &card.place) {
                change.active = Some(active);
            }
        }
    }

    /// The place of the contact that acts between two surfaces of a pair.
    fn between(&self, secondary: &Name, primary: &Name) -> Option<usize> {
        let mut places = self.pairs.iter().map(|pair| pair.contact);
        places.find(|&at| {
            let contact = self.case.contacts.get(at);
            contact.is_some_and(|c| c.secondary == *secondary && c.primary == *primary)
        })
    }

    /// The same, for a card that needs one.
    pub fn pair_of(&mut self, card: &Statement, secondary: &Name, primary: &Name) -> Option<usize> {
        let found = self.between(secondary, primary);
        if found.is_none() {
            let text = format!("*{} of surfaces that are no contact pair", card.title);
            self.error(&codes::UNDEFINED, text, &card.place, "");
        }
        found
    }

    /// *CHANGE FRICTION within a step: the friction that follows, for every pair of an interaction.
    pub fn change_friction(&mut self, of: &Statement, to: &Statement, step: &mut Step) {
        let given = self.friction(to);
        let friction = self.rubbing(given);
        for pair in self.pairs_of(of) {
            let Some(pair) = self.pairs.get_mut(pair) else {
                continue;
            };
            pair.interaction.friction = Some(given);
            let at = pair.contact;
            if let Some(change) = self.change(step, at, &of.place) {
                change.friction = Some(friction.clone());
            }
        }
    }

    /// *CHANGE SURFACE BEHAVIOR within a step: another contact, with the law that follows, acts from now on in place of
    /// the one before.
    pub fn change_behavior(&mut self, of: &Statement, to: &Statement, step: &mut Step) {
        let law = self.law(to);
        for at in self.pairs_of(of) {
            let Some(mut pair) = self.pairs.get(at).cloned() else {
                continue;
            };
            let Some(before) = self.case.contacts.get(pair.contact).cloned() else {
                continue;
            };
            // a joint knows where the sides are at the start, not where they have come to
            let joins = matches!(law, Law::Tied(_)) && before.tied.is_none();
            if joins && !self.case.steps.is_empty() {
                let text = "*CHANGE SURFACE BEHAVIOR to TIED in a later step is not supported";
                self.error(&codes::NOT_BUILT, text, &to.place, "");
                return;
            }
            if before.cohesive.is_some() {
                let text =
                    "*CHANGE SURFACE BEHAVIOR of surfaces with *COHESIVE BEHAVIOR is not supported";
                self.error(&codes::NOT_BUILT, text, &to.place, "");
                return;
            }
            pair.interaction.law = law.clone();
            let mut after = Contact {
                name: Spanned::new(self.fresh(&before.name.value), of.place.clone()),
                enforcement: Enforcement::Auto,
                per: None,
                tied: None,
                active: false,
                place: of.place.clone(),
                ..before.clone()
            };
            self.obey(&mut after, &pair.interaction, pair.method);
            let steps = self.case.steps.iter().chain(std::iter::once(&*step));
            let acts = before.acting(steps).last() == Some(true);
            let old = std::mem::replace(&mut pair.contact, self.case.contacts.len());
            self.case.contacts.push(after);
            for (contact, active) in [(old, false), (pair.contact, true)] {
                let change = self.change(step, contact, &of.place).filter(|_| acts);
                if let Some(change) = change {
                    change.active = Some(active);
                }
            }
            if let Some(known) = self.pairs.get_mut(at) {
                *known = pair;
            }
        }
    }

    /// The places of the pairs whose interaction a card names.
    fn pairs_of(&mut self, card: &Statement) -> Vec<usize> {
        let Some(wanted) = self.need(card, "INTERACTION").map(compared) else {
            return Vec::new();
        };
        let pairs = self.pairs.iter().enumerate();
        let of: Vec<usize> = pairs
            .filter(|(_, pair)| pair.named == wanted)
            .map(|(at, _)| at)
            .collect();
        if of.is_empty() {
            let text = format!("no contact pair has the interaction `{wanted}`");
            self.error(&codes::UNDEFINED, text, &card.place, "");
        }
        of
    }

    /// The change of a contact, by its place, in a step.
    pub fn change<'s>(
        &self,
        step: &'s mut Step,
        contact: usize,
        place: &Place,
    ) -> Option<&'s mut ContactChange> {
        let name = &self.case.contacts.get(contact)?.name.value;
        let mut known = step.contacts.iter();
        let at = known.position(|change| change.name.value == *name);
        let at = at.unwrap_or_else(|| {
            step.contacts.push(ContactChange {
                name: Spanned::new(name.clone(), place.clone()),
                active: None,
                friction: None,
                fluid: None,
                slip: None,
                place: place.clone(),
            });
            step.contacts.len() - 1
        });
        step.contacts.get_mut(at)
    }

    /// The contact of two sides, for printed tables.
    pub fn contact_of(&self, sides: &Sides) -> Option<Name> {
        let at = self.between(&sides.secondary, &sides.primary)?;
        let found = self.case.contacts.get(at);
        found.map(|contact| contact.name.clone())
    }
}
