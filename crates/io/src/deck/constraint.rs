//! Local axes, equations, rigid bodies, couplings.

use super::translation::{Target, Translation};
use crate::case::{
    Body, Constraint, ConstraintKind, Directions, Name, Position, Reference, Summand, Temperatures,
};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared};
use signorini_geometry::tensor::Vec3;

/// Three unit vectors at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axes(pub [Vec3; 3]);

impl Axes {
    /// The first along `a`, the second in the plane of both; none where they are parallel.
    pub fn new(a: [f64; 3], b: [f64; 3]) -> Option<Self> {
        let first = Vec3::from(a).normalized()?;
        let third = first.cross(Vec3::from(b)).normalized()?;
        Some(Self([first, third.cross(first), third]))
    }

    /// Radial, circumferential and along an axis through two points, at a place off it.
    fn around(a: Vec3, b: Vec3, x: Vec3) -> Option<Self> {
        let along = (b - a).normalized()?;
        let out = x - a;
        let radial = (out - along * out.dot(along)).normalized()?;
        Some(Self([radial, along.cross(radial), along]))
    }
}

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
            for label in self.labels(&Target::Set(set.value)) {
                let axes = match (kind.as_str(), self.point(label)) {
                    ("C", Some(x)) => Axes::around(Vec3::new(a, b, c), Vec3::new(d, e, f), x),
                    ("C", None) => None,
                    ("" | "R", _) => Axes::new([a, b, c], [d, e, f]),
                    _ => {
                        let text = format!("*TRANSFORM, TYPE={kind} is not supported");
                        self.error(&codes::NOT_BUILT, text, &card.place, "");
                        break;
                    }
                };
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
            let Some(node) = self.node_of(card, "REFNODE") else {
                continue;
            };
            let reference = self.reference(node, &card.place);
            if card.has("ROTNODE")
                && let Some(turning) = self.node_of(card, "ROTNODE")
            {
                let name = reference.value.clone();
                self.carriers.insert(turning, Carrier { name, turns: true });
            }
            if let Some(elset) = card.get("ELSET") {
                if let Some(group) = self.set(card, elset, &card.place, Kind::Elements) {
                    self.rigid_body(group, reference, &card.place);
                }
                continue;
            }
            let Some(nset) = self.need(card, "NSET") else {
                continue;
            };
            if let Some(on) = self.set(card, nset, &card.place, Kind::Nodes) {
                let kind = ConstraintKind::Kinematic {
                    on,
                    reference,
                    axes: Directions::ALL,
                };
                self.constrain(kind, &card.place);
            }
        }
    }

    /// Elements that move as a whole have no material.
    fn rigid_body(&mut self, group: Name, reference: Name, place: &Place) {
        self.case
            .bodies
            .retain(|body| body.groups != [group.clone()]);
        self.case.bodies.push(Body {
            groups: vec![group],
            material: None,
            integration: Default::default(),
            locking: Default::default(),
            orientation: None,
            thickness: None,
            temperatures: Temperatures::default(),
            area: None,
            rigid: true,
            reference: Some(reference),
            place: place.clone(),
        });
    }

    fn couplings(&mut self) {
        let mut open: Option<(Name, Name)> = None;
        let deck = self.deck;
        for card in &deck.statements {
            match card.keyword.as_str() {
                "COUPLING" => {
                    if card.has("ORIENTATION") {
                        let text = "*COUPLING, ORIENTATION is not supported";
                        self.error(&codes::NOT_BUILT, text, &card.place, "");
                    }
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
                        }
                    };
                    self.constrain(kind, &card.place);
                }
                "STEP" => break,
                _ => {}
            }
        }
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
                    terms.extend(row.chunks(3).map(<[_]>::to_vec));
                }
                let summands: Vec<Summand> = (terms.iter())
                    .flat_map(|term| self.summands(card, term))
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

    /// A term of an equation: one summand, or those of a local axis.
    fn summands(&mut self, card: &Statement, term: &[Field<'_>]) -> Vec<Summand> {
        let targets = self.targets(card, term.first(), Kind::Nodes);
        let component = self.count(term.get(1), 0) as usize;
        let coefficient = self.real(term.get(2));
        let place = term
            .first()
            .map_or(card.place.clone(), |field| field.place());
        let axis = match component {
            1..=3 => component - 1,
            _ => {
                let text = format!("*EQUATION of degree of freedom {component} is not supported");
                self.error(&codes::NOT_BUILT, text, &place, "");
                return Vec::new();
            }
        };
        if let Some(carrier) = self.carrier_of(&targets) {
            let component = axis + if carrier.turns { 3 } else { 0 };
            return vec![Summand {
                on: Spanned::new(carrier.name.clone(), place.clone()),
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
        let direction = turned.map_or_else(|| unit(axis), |axes| axes.0[axis]);
        if turned.is_some() && labels.len() > 1 {
            let text = "an equation of a set of nodes with local axes is not supported";
            self.error(&codes::NOT_BUILT, text, &place, "name the nodes one by one");
        }
        along(on, direction, coefficient, self.ndim())
    }
}

/// The unit vector along an axis.
pub(super) fn unit(axis: usize) -> Vec3 {
    Vec3::from(std::array::from_fn(|i| f64::from(u8::from(i == axis))))
}

/// What is left of a component of a unit vector is round-off.
const ROUND_OFF: f64 = 1e-14;

/// The displacement of a node along a direction, times a coefficient.
pub(super) fn along(on: Name, direction: Vec3, coefficient: f64, ndim: usize) -> Vec<Summand> {
    let components = direction.to_array().into_iter().take(ndim).enumerate();
    components
        .filter(|(_, part)| part.abs() > ROUND_OFF)
        .map(|(component, part)| Summand {
            on: on.clone(),
            component: Spanned::new(component, on.place.clone()),
            coefficient: coefficient * part,
        })
        .collect()
}
