//! Local axes, equations, rigid bodies, couplings, pre-tension, multi-point constraints, sectors.

use super::axes::{along, unit};
use super::translation::{Target, Translation};
use crate::case::{
    AtNodes, AxesSystem, Body, Constraint, ConstraintKind, Directions, LocalAxes, Name, Position,
    Reference, Summand, Temperatures,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeSet;

/// What a node stands for that moves a rigid body or follows a surface.
#[derive(Clone, Debug)]
pub(super) struct Carrier {
    /// The reference.
    pub name: String,
    /// Whether its displacements are rotations: a node for rotations alone, as CalculiX has it.
    pub turns: bool,
}

impl Translation<'_> {
    pub fn constraints(&mut self) {
        self.transforms();
        self.rigid_bodies();
        self.couplings();
        self.distributing_couplings();
        self.pretensions();
        self.multi_point_constraints();
        self.sectors();
        self.equations();
    }

    fn transforms(&mut self) {
        for card in self.cards("TRANSFORM") {
            let Some(nset) = self.need(card, "NSET") else {
                continue;
            };
            let Some(set) = self.set(card, nset, &card.place, Kind::Nodes) else {
                continue;
            };
            let kind = card.get("TYPE").map(compared).unwrap_or_default();
            let row = card.rows().next().unwrap_or_default();
            let [a, b, c, d, e, f] = self.reals(&row);
            let system = match kind.as_str() {
                "C" => AxesSystem::Cylindrical {
                    from: [a, b, c],
                    to: [d, e, f],
                },
                "" | "R" => AxesSystem::Rectangular {
                    x: [a, b, c],
                    xy: [d, e, f],
                },
                _ => {
                    let text = format!("*TRANSFORM, TYPE={kind} is not supported");
                    self.error(&codes::NOT_BUILT, text, &card.place, "");
                    continue;
                }
            };
            self.case.axes.push(LocalAxes {
                set: set.clone(),
                system,
                place: card.place.clone(),
            });
            for label in self.labels(&Target::Set(set.value)) {
                let axes = system.at(self.point(label).unwrap_or_default());
                let Some(axes) = axes else {
                    let text = format!("*TRANSFORM gives no axes at node {label}");
                    self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
                    break;
                };
                self.axes.insert(label, axes);
            }
        }
    }

    /// What a single node stands for, where it carries a rigid body or a coupling.
    pub fn carrier_of(&self, targets: &[Target]) -> Option<&Carrier> {
        let [target] = targets else { return None };
        match self.labels(target).as_slice() {
            [label] => self.carriers.get(label),
            _ => None,
        }
    }

    /// The reference in a node, made where it is named first.
    fn reference(&mut self, label: u64, place: &Place) -> Name {
        if let Some(known) = self.carriers.get(&label) {
            return Spanned::new(known.name.clone(), place.clone());
        }
        let name = self.fresh(&format!("reference-{label}"));
        self.carriers.insert(
            label,
            Carrier {
                name: name.clone(),
                turns: false,
            },
        );
        let name = Spanned::new(name, place.clone());
        self.case.references.push(Reference {
            name: name.clone(),
            position: Position::Node(label),
            rotations: None,
            place: place.clone(),
        });
        name
    }

    /// The node that a parameter names.
    fn node_of(&mut self, card: &Statement, parameter: &str) -> Option<u64> {
        let text = self.need(card, parameter)?;
        let directory = &self.deck.directory;
        let spaces = directory.spaces(card.scope).iter();
        let mut labels = spaces.filter_map(|&space| directory.label(space, Kind::Nodes, text));
        let label = labels.find(|&label| self.point(label).is_some());
        // a set of one node will do
        let label = label.or_else(|| {
            let spaces = directory.spaces(card.scope).iter();
            let mut sets = spaces.filter_map(|&space| directory.set(space, Kind::Nodes, text));
            match self
                .labels(&Target::Set(sets.next()?.to_owned()))
                .as_slice()
            {
                [one] => Some(*one),
                _ => None,
            }
        });
        if label.is_none() {
            let text = format!("{parameter}={text} is no node");
            self.error(&codes::NOT_IN_MESH, text, &card.place, "");
        }
        label
    }

    fn rigid_bodies(&mut self) {
        for card in self.cards("RIGIDBODY") {
            let Some(reference) = self.reference_of(card) else {
                continue;
            };
            if card.has("ROTNODE")
                && let Some(turning) = self.node_of(card, "ROTNODE")
            {
                let name = reference.value.clone();
                let mut known = self.case.references.iter_mut();
                if let Some(known) = known.find(|one| one.name == reference) {
                    known.rotations = Some(turning);
                }
                self.carriers.insert(turning, Carrier { name, turns: true });
            }
            if let Some(elset) = card.get("ELSET") {
                let Some(group) = self.set(card, elset, &card.place, Kind::Elements) else {
                    continue;
                };
                // shells keep their faces: their nodes move as a whole
                match self.is_rigid_shell(card, &group) {
                    true => self.moves_as_a_whole(group, reference, &card.place),
                    false => self.rigid_body(group, reference, &card.place),
                }
                continue;
            }
            let Some(nset) = self.need(card, "NSET") else {
                continue;
            };
            if let Some(on) = self.set(card, nset, &card.place, Kind::Nodes) {
                self.moves_as_a_whole(on, reference, &card.place);
            }
        }
    }

    /// Nodes that move with a reference, in all directions.
    fn moves_as_a_whole(&mut self, on: Name, reference: Name, place: &Place) {
        let kind = ConstraintKind::Kinematic {
            on,
            reference,
            axes: Directions::ALL,
            local: None,
        };
        self.constrain(kind, place);
    }

    /// The reference of a *RIGID BODY: in its REF NODE, or in the mean of its nodes, which nothing but them then moves.
    fn reference_of(&mut self, card: &Statement) -> Option<Name> {
        if card.has("REFNODE") {
            let node = self.node_of(card, "REFNODE")?;
            return Some(self.reference(node, &card.place));
        }
        let of = card.peek("NSET").or(card.peek("ELSET"));
        let wanted = of.map_or("rigid".to_owned(), |of| format!("rigid-{of}"));
        let name = Spanned::new(self.fresh(&wanted), card.place.clone());
        self.case.references.push(Reference {
            name: name.clone(),
            position: Position::Mean,
            rotations: None,
            place: card.place.clone(),
        });
        Some(name)
    }

    /// Elements that move as a whole have no material but for their mass.
    fn rigid_body(&mut self, group: Name, reference: Name, place: &Place) {
        let mut before = self.case.bodies.iter();
        let before = before.rfind(|body| body.groups == [group.clone()]);
        let material = before.and_then(|body| body.material.clone());
        let is_heavy = |name: &Name| {
            let mut all = self.case.materials.iter();
            all.any(|one| one.name.value == name.value && one.density.is_some())
        };
        let material = material.filter(is_heavy);
        self.case
            .bodies
            .retain(|body| body.groups != [group.clone()]);
        self.case.bodies.push(Body {
            groups: vec![group],
            material,
            integration: Default::default(),
            locking: Default::default(),
            orientation: None,
            space: None,
            thickness: None,
            shell: None,
            temperatures: Temperatures::default(),
            at_nodes: AtNodes::default(),
            area: None,
            small_strain: false,
            mass_matrix: Default::default(),
            lumped_capacity: false,
            rigid: true,
            reference: Some(reference),
            place: place.clone(),
        });
    }

    fn couplings(&mut self) {
        let mut open: Option<(Name, Name)> = None;
        let mut local = None;
        let deck = self.deck;
        for card in &deck.statements {
            match card.keyword.as_str() {
                "COUPLING" => {
                    local = self.axes_of(card);
                    let node = self.node_of(card, "REFNODE");
                    let surface = self.need(card, "SURFACE");
                    let on =
                        surface.and_then(|name| self.set(card, name, &card.place, Kind::Surface));
                    open = node
                        .zip(on)
                        .map(|(node, on)| (self.reference(node, &card.place), on));
                }
                "KINEMATIC" | "DISTRIBUTING" => {
                    let Some((reference, on)) = open.take() else {
                        continue;
                    };
                    let kind = if card.keyword == "DISTRIBUTING" {
                        ConstraintKind::Distributing { on, reference }
                    } else {
                        let axes = self.coupled(card);
                        ConstraintKind::Kinematic {
                            on,
                            reference,
                            axes,
                            local: local.take(),
                        }
                    };
                    self.constrain(kind, &card.place);
                }
                "STEP" => break,
                _ => {}
            }
        }
    }

    /// The axes of an *ORIENTATION that a coupling names.
    fn axes_of(&mut self, card: &Statement) -> Option<AxesSystem> {
        let name = card.get("ORIENTATION")?;
        let is_named = |one: &&Statement| one.peek("NAME").map(compared) == Some(compared(name));
        let Some(of) = self.cards("ORIENTATION").find(is_named) else {
            let text = format!("there is no orientation `{name}`");
            self.error(&codes::UNDEFINED, text, &card.place, "");
            return None;
        };
        let mut rows = of.rows();
        let numbers = rows.next().unwrap_or_default();
        let system = self.system(of, &numbers);
        if rows.next().is_some_and(|row| !row.is_empty()) {
            let text = "*COUPLING with an *ORIENTATION that is turned is not supported";
            let remark = "write the axes as they are after the turn";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        Some(system)
    }

    /// The directions of *KINEMATIC: all, or those of its lines.
    fn coupled(&mut self, card: &Statement) -> Directions {
        let mut axes = Directions::default();
        for row in card.rows().filter(|row| !row.is_empty()) {
            let first = self.count(row.first(), 1);
            let last = self.count(row.get(1), first);
            for (axis, one) in (1..).zip(&mut axes.xyz) {
                *one |= (first..=last).contains(&axis);
            }
        }
        if axes.is_empty() {
            Directions::ALL
        } else {
            axes
        }
    }

    pub fn constrain(&mut self, kind: ConstraintKind, place: &Place) {
        let place = place.clone();
        self.case.constraints.push(Constraint { kind, place });
    }

    /// The displacement of a node that is the weighted mean of others: without rotations, forces on it keep their lines.
    fn distributing_couplings(&mut self) {
        for card in self.cards("DISTRIBUTINGCOUPLING") {
            let Some(elset) = self.need(card, "ELSET") else {
                continue;
            };
            let directory = &self.deck.directory;
            let spaces = directory.spaces(card.scope).iter();
            let mut elements = spaces.flat_map(|&space| directory.special(space, elset));
            let of_coupling = |kind: &str| kind.starts_with("DCOUP");
            let node = elements.find(|one| of_coupling(&one.kind));
            let Some(&node) = node.and_then(|one| one.nodes.first()) else {
                let text = format!("there is no element of type DCOUP3D in `{elset}`");
                self.error(&codes::NOT_IN_MESH, text, &card.place, "");
                continue;
            };
            let mut weights: Vec<(u64, f64)> = Vec::new();
            for row in card.rows().filter(|row| !row.is_empty()) {
                let weight = self.real(row.get(1));
                let targets = self.targets(card, row.first(), Kind::Nodes);
                let labels = targets.iter().flat_map(|target| self.labels(target));
                weights.extend(labels.map(|label| (label, weight)));
            }
            let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
            if total <= 0.0 || !total.is_finite() {
                let text = "*DISTRIBUTING COUPLING has no weights";
                self.error(
                    &codes::OUT_OF_RANGE,
                    text,
                    &card.place,
                    "node or set, weight",
                );
                continue;
            }
            let reference = self.reference(node, &card.place);
            for axis in 0..self.ndim() {
                let summand = |on: Name, coefficient: f64| Summand {
                    component: Spanned::new(axis, on.place.clone()),
                    on,
                    coefficient,
                };
                let mut terms = vec![summand(reference.clone(), -1.0)];
                for &(label, weight) in &weights {
                    let on = self.nodes_named(vec![label], &card.place);
                    terms.push(summand(on, weight / total));
                }
                self.constrain(ConstraintKind::Equation { terms, rhs: 0.0 }, &card.place);
            }
        }
    }

    fn pretensions(&mut self) {
        for card in self.cards("PRE-TENSIONSECTION") {
            if card.has("ELEMENT") {
                let text = "*PRE-TENSION SECTION, ELEMENT is not supported: beams are not built";
                self.error(&codes::NOT_BUILT, text, &card.place, "name a SURFACE");
                continue;
            }
            let (Some(surface), Some(node)) =
                (self.need(card, "SURFACE"), self.node_of(card, "NODE"))
            else {
                continue;
            };
            let Some(on) = self.set(card, surface, &card.place, Kind::Surface) else {
                continue;
            };
            let row = card.rows().next().unwrap_or_default();
            let normal: [f64; 3] = self.reals(&row);
            let kind = ConstraintKind::Pretension {
                on,
                reference: self.reference(node, &card.place),
                normal: Some(normal).filter(|normal| *normal != [0.0; 3]),
            };
            self.constrain(kind, &card.place);
        }
    }

    /// Lines that begin with the name of a type; lines that do not go on with the nodes of the one before.
    fn multi_point_constraints(&mut self) {
        for card in self.cards("MPC") {
            let mut open: Option<(String, Place, Vec<u64>)> = None;
            for row in card.rows().filter(|row| !row.is_empty()) {
                let mut fields = row.as_slice();
                if let [first, rest @ ..] = fields
                    && (open.is_none() || TYPES.contains(&first.key().as_str()))
                {
                    if let Some(done) = open.take() {
                        self.multi_point_constraint(done);
                    }
                    open = Some((first.key(), first.place(), Vec::new()));
                    fields = rest;
                }
                let of_nodes = fields
                    .iter()
                    .filter(|f| !f.text.is_empty() && f.text != "0");
                for field in of_nodes {
                    let targets = self.targets(card, Some(field), Kind::Nodes);
                    let labels = targets.iter().flat_map(|target| self.labels(target));
                    let labels: Vec<u64> = labels.collect();
                    if let Some((_, _, nodes)) = &mut open {
                        nodes.extend(labels);
                    }
                }
            }
            if let Some(done) = open {
                self.multi_point_constraint(done);
            }
        }
    }

    fn multi_point_constraint(&mut self, (kind, place, mut nodes): (String, Place, Vec<u64>)) {
        // the last node of some says how far, or about which axis
        let last = match kind.as_str() {
            "MEANROT" | "DIST" => nodes.pop(),
            _ => None,
        };
        let mut seen = BTreeSet::new();
        nodes.retain(|label| seen.insert(*label));
        if nodes.is_empty() {
            let text = format!("the multi-point constraint {kind} names no nodes");
            self.error(&codes::MISSING, text, &place, "");
            return;
        }
        let pair = nodes.len() == 2;
        let at = last.and_then(|label| self.point(label)).unwrap_or_default();
        let on = self.nodes_named(nodes, &place);
        let kind = match (kind.as_str(), last) {
            ("PLANE", _) => ConstraintKind::Plane { on },
            ("STRAIGHT", _) => ConstraintKind::Line { on },
            ("BEAM", _) if pair => ConstraintKind::Distance { on, most: None },
            ("DIST", Some(_)) if pair => ConstraintKind::Distance {
                on,
                most: Some(at.x),
            },
            ("BEAM" | "DIST", _) => {
                let text = format!("the multi-point constraint {kind} is about two nodes");
                self.error(&codes::WRONG_LENGTH, text, &place, "");
                return;
            }
            ("MEANROT", Some(label)) => ConstraintKind::Twist {
                on,
                reference: self.reference(label, &place),
                axis: at.to_array(),
            },
            _ => {
                let text = format!("there is no multi-point constraint {kind} here");
                self.error(&codes::NOT_BUILT, text, &place, TYPES.join(", "));
                return;
            }
        };
        self.bends |= !matches!(kind, ConstraintKind::Twist { .. });
        self.constrain(kind, &place);
    }

    /// The ties between the sides of sectors, with the axes and numbers of the models they belong to.
    fn sectors(&mut self) {
        let ties: Vec<&Statement> = self
            .cards("TIE")
            .filter(|card| card.has("CYCLICSYMMETRY"))
            .collect();
        for card in self.cards("CYCLICSYMMETRYMODEL") {
            let named = card.get("TIE").map(compared);
            let of_name =
                |tie: &&&Statement| named.is_none() || tie.get("NAME").map(compared) == named;
            let Some(tie) = ties.iter().find(of_name) else {
                let text = "there is no *TIE, CYCLIC SYMMETRY of that name";
                self.error(&codes::UNDEFINED, text, &card.place, "");
                continue;
            };
            let sectors = card.get("N").and_then(|n| n.trim().parse::<f64>().ok());
            let Some(sectors) = sectors.filter(|n| *n >= 1.0 && n.fract() == 0.0) else {
                let text = "*CYCLIC SYMMETRY MODEL needs N, the number of sectors";
                self.error(&codes::MISSING, text, &card.place, "");
                continue;
            };
            let row = card.rows().next().unwrap_or_default();
            let [a, b, c, d, e, f] = self.reals(&row);
            let (from, to) = (Vec3::new(a, b, c), Vec3::new(d, e, f));
            if from == to {
                let text = "*CYCLIC SYMMETRY MODEL needs two points of its axis";
                self.error(&codes::OUT_OF_RANGE, text, &card.place, "");
                continue;
            }
            let row = tie.rows().next().unwrap_or_default();
            let Some(two) = row.first_chunk::<2>() else {
                continue;
            };
            let sides = two.each_ref().map(|side| {
                let place = side.place();
                self.set(tie, side.text, &place, Kind::Surface)
            });
            let [Some(on), Some(with)] = sides else {
                continue;
            };
            if self.has_shell_nodes(&[on.value.clone(), with.value.clone()].map(Target::Set)) {
                let text = "*CYCLIC SYMMETRY MODEL of shells is not supported";
                let remark = "their rotations would not follow from one side to the other";
                self.error(&codes::NOT_BUILT, text, &card.place, remark);
            }
            let kind = ConstraintKind::Cyclic {
                on,
                with,
                sectors: sectors as u64,
                point: from.to_array(),
                axis: (to - from).to_array(),
            };
            self.constrain(kind, &card.place);
        }
    }

    fn equations(&mut self) {
        for card in self.cards("EQUATION") {
            let fields: Vec<Vec<_>> = card.rows().filter(|row| !row.is_empty()).collect();
            let mut rows = fields.into_iter();
            while let Some(head) = rows.next() {
                let wanted = self.count(head.first(), 0) as usize;
                let mut terms = Vec::new();
                while terms.len() < wanted {
                    let Some(row) = rows.next() else {
                        let text = format!("*EQUATION has fewer than {wanted} terms");
                        let place = head.first().map_or(card.place.clone(), |f| f.place());
                        self.error(&codes::WRONG_LENGTH, text, &place, "");
                        break;
                    };
                    if let Some(cut) = row.chunks(3).find(|term| term.len() < 3) {
                        let words = (
                            "node or set, degree of freedom, coefficient",
                            " for each term",
                        );
                        self.values_of(card, cut, (3, 3), words);
                    }
                    terms.extend(row.chunks(3).map(<[_]>::to_vec));
                }
                // nodes with axes of their own make an equation each
                let several = self.several_axes(card, &terms);
                for only in several.map_or(vec![None], |count| (0..count).map(Some).collect()) {
                    let summands: Vec<Summand> = (terms.iter())
                        .flat_map(|term| self.summands(card, term, only))
                        .collect();
                    if !summands.is_empty() {
                        let kind = ConstraintKind::Equation {
                            terms: summands,
                            rhs: 0.0,
                        };
                        self.constrain(kind, &card.place);
                    }
                }
            }
        }
    }

    /// How many nodes the sets of an equation have, where some of them have local axes.
    fn several_axes(&self, card: &Statement, terms: &[Vec<Field<'_>>]) -> Option<usize> {
        if self.axes.is_empty() {
            return None;
        }
        let directory = &self.deck.directory;
        let labels = |term: &Vec<Field<'_>>| -> Vec<u64> {
            let name = term.first().map_or("", |field| field.text);
            let mut spaces = directory.spaces(card.scope).iter();
            let set = spaces.find_map(|&space| directory.set(space, Kind::Nodes, name));
            set.map_or_else(Vec::new, |set| self.labels(&Target::Set(set.to_owned())))
        };
        let sets: Vec<Vec<u64>> = terms.iter().map(labels).collect();
        let turned = |set: &Vec<u64>| set.iter().any(|label| self.axes.contains_key(label));
        let count = sets.iter().map(Vec::len).max().unwrap_or(0);
        (count > 1 && sets.iter().any(turned)).then_some(count)
    }

    /// A term of an equation: one summand, or those of a local axis. Of a set of several nodes that of one, where there are
    /// to be equations of single nodes.
    fn summands(
        &mut self,
        card: &Statement,
        term: &[Field<'_>],
        only: Option<usize>,
    ) -> Vec<Summand> {
        let mut targets = self.targets(card, term.first(), Kind::Nodes);
        if let Some(number) = only {
            let labels: Vec<u64> = targets.iter().flat_map(|t| self.labels(t)).collect();
            let one = match labels.as_slice() {
                [one] => Some(*one),
                all => all.get(number).copied(),
            };
            targets = one.map(Target::One).into_iter().collect();
            if one.is_none() && !labels.is_empty() {
                let text = "the sets of this equation differ in their numbers of nodes";
                self.error(&codes::WRONG_LENGTH, text, &card.place, "");
            }
        }
        let component = self.count(term.get(1), 0) as usize;
        let coefficient = self.real(term.get(2));
        let place = term
            .first()
            .map_or(card.place.clone(), |field| field.place());
        let carrier = self.carrier_of(&targets).cloned();
        let component = match (component, &carrier) {
            (1..=3, Some(carrier)) if carrier.turns => component + 2,
            (1..=3, _) | (4..=6, Some(_)) => component - 1,
            _ => {
                let text = format!("*EQUATION of degree of freedom {component} is not supported");
                let remark = "1 to 3; 4 to 6 of a node that moves a rigid body or a coupling, not of a shell";
                self.error(&codes::NOT_BUILT, text, &place, remark);
                return Vec::new();
            }
        };
        if let Some(carrier) = carrier {
            return vec![Summand {
                on: Spanned::new(carrier.name, place.clone()),
                component: Spanned::new(component, place),
                coefficient,
            }];
        }
        if targets.is_empty() {
            return Vec::new();
        }
        let labels: Vec<u64> = targets
            .iter()
            .flat_map(|target| self.labels(target))
            .collect();
        let on = self.named(&targets, &place);
        let turned = labels
            .iter()
            .find_map(|label| self.axes.get(label))
            .copied();
        let direction = turned.map_or_else(|| unit(component), |axes| axes[component]);
        along(on, direction, coefficient, self.ndim())
    }
}

/// Types of *MPC.
const TYPES: [&str; 5] = ["PLANE", "STRAIGHT", "BEAM", "MEANROT", "DIST"];
