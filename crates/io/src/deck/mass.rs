//! Point masses.
//!
//! | element | card | becomes |
//! |---|---|---|
//! | MASS | *MASS | a mass at its node; that of a reference where the node moves a rigid body or a coupling |
//! | ROTARYI | *ROTARY INERTIA | moments of inertia of a reference, about its node |
//!
//! Every element has the mass given, so that a set of n elements has n times that. The weight of a MASS element is a force on
//! its node: a set that *DLOAD, GRAV names may have some of the elements at a node, and others not.
//!
//! Source: CalculiX CrunchiX User's Manual, sections 6.2 and 7; Abaqus Analysis User's Guide, point masses and rotary inertia.
//! I12, I13 and I23 have the signs of a matrix: `I12 = −∫ ρ x1 x2 dV`.

use super::translation::{Target, Translation};
use crate::case::{ConstraintKind, MassAt, Space};
use crate::diagnostic::{Diagnostic, Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Special, Statement};
use std::collections::{BTreeMap, BTreeSet};

const MASS: &str = "MASS";
const ROTARY: &str = "ROTARYI";

/// What the elements at the node of a reference add up to.
struct Lump {
    node: u64,
    mass: f64,
    inertia: [f64; 6],
    /// Where its mass is given, and its moments of inertia.
    at: Option<Place>,
    about: Option<Place>,
}

impl Lump {
    const fn new(node: u64) -> Self {
        Self {
            node,
            mass: 0.0,
            inertia: [0.0; 6],
            at: None,
            about: None,
        }
    }
}

impl<'d> Translation<'d> {
    /// Masses of all MASS elements, and moments of inertia of all ROTARYI elements.
    pub fn point_masses(&mut self) {
        let mut lumps: BTreeMap<String, Lump> = BTreeMap::new();
        let mut given: BTreeSet<u64> = BTreeSet::new();
        for card in self.cards("MASS") {
            self.masses_of(card, &mut given, &mut lumps);
        }
        for card in self.cards("ROTARYINERTIA") {
            self.rotary_inertia_of(card, &mut given, &mut lumps);
        }
        for (name, lump) in lumps {
            self.lump(name, lump);
        }
        self.without_mass(&given);
    }

    /// The elements of a type that a card names, that no card has named before.
    fn points(
        &mut self,
        card: &Statement,
        kind: &str,
        given: &mut BTreeSet<u64>,
    ) -> Vec<&'d Special> {
        let Some(elset) = self.need(card, "ELSET") else {
            return Vec::new();
        };
        let directory = &self.deck.directory;
        let spaces = directory.spaces(card.scope).iter();
        let all = spaces.flat_map(|&space| directory.special(space, elset));
        let (points, others): (Vec<&Special>, Vec<&Special>) =
            all.partition(|one| one.kind == kind);
        if points.is_empty() {
            let text = format!("element set `{elset}` has no elements of type {kind}");
            self.error(&codes::WRONG_KIND, text, &card.place, "");
            return points;
        }
        let sets = self.sets_of(card, elset).into_iter();
        let cells: usize = sets.map(|set| self.elements(&Target::Set(set)).len()).sum();
        if cells > 0 || !others.is_empty() {
            let text = format!("element set `{elset}` has elements that are not of type {kind}");
            let remark = format!("*{} is about these alone", card.title);
            self.error(&codes::WRONG_KIND, text, &card.place, remark);
        }
        if let Some(twice) = points.iter().find(|one| given.contains(&one.label)) {
            let text = format!("element {} has two *{}", twice.label, card.title);
            let remark = "a second time here; sets that share no elements have one each";
            self.error(&codes::CONTRADICTION, text, &card.place, remark);
        }
        given.extend(points.iter().map(|one| one.label));
        points
    }

    /// The node of an element, if the mesh has it.
    fn node_of_point(&mut self, one: &Special) -> Option<u64> {
        let node = *one.nodes.first()?;
        if self.point(node).is_none() {
            let card = self.deck.directory.card_of_special(one);
            let place = card.map_or_else(Place::nowhere, |card| card.place.clone());
            let text = format!("there is no node {node} in the mesh");
            let remark = format!("element {} of type {} is at it", one.label, one.kind);
            self.error(&codes::NOT_IN_MESH, text, &place, remark);
            return None;
        }
        Some(node)
    }

    /// The name of the reference at a node, where it moves in space as a whole; nothing where it does not.
    fn moved_by(&mut self, node: u64, place: &Place) -> Option<String> {
        let carrier = self.carriers.get(&node)?;
        let name = carrier.name.clone();
        let is_no_point = self.case.constraints.iter().any(|one| match &one.kind {
            ConstraintKind::Pretension { reference, .. }
            | ConstraintKind::Twist { reference, .. } => reference.value == name,
            _ => false,
        });
        if carrier.turns || is_no_point {
            let text = format!("node {node} stands for no point in space, and has no mass");
            let remark = match carrier.turns {
                true => "it turns a rigid body: put the element at its REF NODE",
                false => "it moves a pre-tension section or a mean rotation",
            };
            self.error(&codes::WRONG_KIND, text, place, remark);
        }
        Some(name)
    }

    fn masses_of(
        &mut self,
        card: &Statement,
        given: &mut BTreeSet<u64>,
        lumps: &mut BTreeMap<String, Lump>,
    ) {
        let points = self.points(card, MASS, given);
        let row = card.rows().next().unwrap_or_default();
        let place = row.first().map_or_else(|| card.place.clone(), Field::place);
        let mass = self.real(row.first());
        if mass < 0.0 {
            let text = format!("the mass of *MASS is {mass}");
            self.error(&codes::OUT_OF_RANGE, text, &place, "zero or more");
            return;
        }
        if mass == 0.0 && !row.is_empty() {
            self.note("*MASS of zero has no effect", &place);
        }
        // how many of the elements are at each node
        let mut counts: BTreeMap<u64, u32> = BTreeMap::new();
        for one in points {
            let Some(node) = self.node_of_point(one) else {
                continue;
            };
            self.point_masses.insert(one.label, (node, mass));
            *counts.entry(node).or_default() += 1;
        }
        let mut alike: BTreeMap<u32, Vec<u64>> = BTreeMap::new();
        for (node, count) in counts.into_iter().filter(|_| mass > 0.0) {
            match self.moved_by(node, &card.place) {
                Some(name) => {
                    let lump = lumps.entry(name).or_insert_with(|| Lump::new(node));
                    lump.mass += mass * f64::from(count);
                    lump.at.get_or_insert_with(|| card.place.clone());
                }
                None => alike.entry(count).or_default().push(node),
            }
        }
        for (count, nodes) in alike {
            let on = self.nodes_named(nodes, &card.place);
            self.case.masses.push(MassAt {
                on,
                value: mass * f64::from(count),
                centroid: None,
                inertia: None,
                place: card.place.clone(),
            });
        }
    }

    fn rotary_inertia_of(
        &mut self,
        card: &Statement,
        given: &mut BTreeSet<u64>,
        lumps: &mut BTreeMap<String, Lump>,
    ) {
        let points = self.points(card, ROTARY, given);
        let row = card.rows().next().unwrap_or_default();
        let mut inertia: [f64; 6] = self.reals(&row);
        match *self.case.model.space {
            Space::ThreeD => {}
            Space::Axisymmetric => {
                let text = "*ROTARY INERTIA in an axisymmetric model";
                let remark = "bodies of revolution do not turn: leave it out";
                self.error(&codes::CONTRADICTION, text, &card.place, remark);
                return;
            }
            // about the normal of the plane alone
            _ => inertia = [0.0, 0.0, inertia[2], 0.0, 0.0, 0.0],
        }
        let [xx, yy, zz, xy, xz, yz] = inertia;
        let is_round = xx == yy && yy == zz && [xy, xz, yz] == [0.0; 3];
        if self.deck.directory.is_turned(card.scope) && !is_round {
            let text = "*ROTARY INERTIA in a part with an instance that is turned";
            let remark = "write it in the assembly, about the axes of the model";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        for one in points {
            let Some(node) = self.node_of_point(one) else {
                continue;
            };
            let Some(name) = self.moved_by(node, &card.place) else {
                let text = format!("node {node} has no rotations, and no rotary inertia");
                let remark = format!(
                    "element {} needs the node of a *RIGID BODY or of a *COUPLING",
                    one.label
                );
                self.error(&codes::WRONG_KIND, text, &card.place, remark);
                continue;
            };
            let lump = lumps.entry(name).or_insert_with(|| Lump::new(node));
            let sums = lump.inertia.iter_mut().zip(inertia);
            sums.for_each(|(sum, value)| *sum += value);
            lump.about.get_or_insert_with(|| card.place.clone());
        }
    }

    /// What the elements at the node of a reference give to it.
    fn lump(&mut self, name: String, lump: Lump) {
        let Some(place) = lump.at else {
            if let Some(place) = lump.about {
                let text = format!("ROTARYI at node {}, which has no mass", lump.node);
                let remark = "write a MASS element at this node, too";
                self.error(&codes::MISSING, text, &place, remark);
            }
            return;
        };
        self.case.masses.push(MassAt {
            on: Spanned::new(name, place.clone()),
            value: lump.mass,
            centroid: None,
            inertia: lump.about.map(|about| Spanned::new(lump.inertia, about)),
            place,
        });
    }

    /// Refuses MASS and ROTARYI elements that no card gives a value.
    fn without_mass(&mut self, given: &BTreeSet<u64>) {
        let directory = &self.deck.directory;
        let mut bare: Vec<(&Special, usize)> = Vec::new();
        for one in directory.specials() {
            if ![MASS, ROTARY].contains(&one.kind.as_str()) || given.contains(&one.label) {
                continue;
            }
            let of_card = |(first, _): &&mut (&Special, usize)| first.is_with(one);
            match bare.iter_mut().find(of_card) {
                Some((_, count)) => *count += 1,
                None => bare.push((one, 1)),
            }
        }
        for (one, count) in bare {
            let card = directory.card_of_special(one);
            let title = if one.kind == MASS {
                "MASS"
            } else {
                "ROTARY INERTIA"
            };
            let text = match count {
                1 => format!("element {} of type {} has no *{title}", one.label, one.kind),
                _ => format!(
                    "{count} elements of type {} have no *{title}, such as {}",
                    one.kind, one.label
                ),
            };
            let place = card.map_or_else(Place::nowhere, |card| card.place.clone());
            let elset = card.and_then(|card| card.elset.as_deref()).unwrap_or("…");
            let help = format!("write *{title}, ELSET={elset} and its value in the next line");
            let one = Diagnostic::error(&codes::MISSING, text).at(&place, "defined here");
            self.found.push(one.help(help));
        }
    }

    /// The masses of the MASS elements that a field names: by what names them and their node, those at a node together.
    pub fn weighed(&self, card: &Statement, field: &Field<'_>) -> BTreeMap<(Target, u64), f64> {
        let mut weights = BTreeMap::new();
        if self.point_masses.is_empty() {
            return weights;
        }
        let mut add = |of: Target, label: u64| {
            if let Some(&(node, mass)) = self.point_masses.get(&label) {
                *weights.entry((of, node)).or_insert(0.0) += mass;
            }
        };
        let directory = &self.deck.directory;
        for &space in directory.spaces(card.scope) {
            if let Some(label) = directory.label(space, Kind::Elements, field.text) {
                add(Target::One(label), label);
            } else if let Some(name) = directory.set(space, Kind::Elements, field.text) {
                for one in directory.special(space, field.text) {
                    add(Target::Set(name.to_owned()), one.label);
                }
            }
        }
        weights
    }

    /// The rigid body that a target is, where it has masses of MASS elements, too: its weight would be that of both.
    pub fn rigid_with_masses<'t>(&self, target: &'t Target) -> Option<&'t str> {
        let Target::Set(name) = target else {
            return None;
        };
        let is_it = |group: &crate::case::Name| group.value == *name;
        let mut bodies = self.case.bodies.iter().filter(|body| body.rigid);
        let body = bodies.find(|body| body.groups.iter().any(is_it))?;
        let reference = body.reference.as_ref().map(|one| one.value.as_str());
        let nodes: BTreeSet<u64> = self.labels(target).into_iter().collect();
        let is_on_it = |node: &u64| {
            let carrier = self.carriers.get(node).map(|one| one.name.as_str());
            carrier.is_some() && carrier == reference || nodes.contains(node)
        };
        let mut masses = self.point_masses.values();
        masses.any(|(node, _)| is_on_it(node)).then_some(name)
    }

    /// What a field names besides these masses.
    pub fn besides(
        &mut self,
        card: &Statement,
        field: Option<&Field<'_>>,
        weights: &BTreeMap<(Target, u64), f64>,
    ) -> Vec<Target> {
        let is_number = |(of, _): &(Target, u64)| matches!(of, Target::One(_));
        if weights.keys().any(is_number) {
            return Vec::new();
        }
        let mut targets = self.targets(card, field, Kind::Elements);
        if !weights.is_empty() {
            targets.retain(|target| !self.elements(target).is_empty());
        }
        targets
    }
}
