//! Loads.
//!
//! Within a step, loads on one node or face add up; a step that names it again replaces what earlier steps left there.
//! Nodes and faces that bear the same are one load of the case; where some of them change, the load ends and others
//! begin: a load that fades and one that grows are together the straight line from the old to the new.

use super::axes::{global, unit};
use super::translation::{Target, Translation};
use crate::case::{Course, Load, Name, Step};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement};
use signorini_vocabulary::{Chosen, Value, Values};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};

/// How something acts on faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Acts {
    Pressure,
    Flux,
    Film,
    Radiation,
    Line,
}

impl Acts {
    /// How the loads of a card act, and whether on surfaces that it names; none of other cards.
    fn of(keyword: &str) -> Option<(Self, bool)> {
        Some(match keyword {
            "DLOAD" => (Self::Pressure, false),
            "DSLOAD" => (Self::Pressure, true),
            "DFLUX" => (Self::Flux, false),
            "DSFLUX" => (Self::Flux, true),
            "FILM" => (Self::Film, false),
            "SFILM" => (Self::Film, true),
            "RADIATE" => (Self::Radiation, false),
            "SRADIATE" => (Self::Radiation, true),
            _ => return None,
        })
    }

    /// The letter of its labels.
    const fn letter(self) -> char {
        match self {
            Self::Pressure | Self::Line => 'P',
            Self::Flux => 'S',
            Self::Film => 'F',
            Self::Radiation => 'R',
        }
    }

    /// What acts, by the values behind the label.
    fn kind(self, [first, second]: [f64; 2]) -> Chosen {
        match self {
            Self::Pressure => Chosen::bare("pressure", Value::Number(first)),
            Self::Line => Chosen::bare("line", Value::Number(first)),
            Self::Flux => Chosen::bare("heat_flux", Value::Number(first)),
            Self::Film => Chosen::new("film", [("h", second), ("sink", first)]),
            Self::Radiation => Chosen::new("radiation", [("emissivity", second), ("sink", first)]),
        }
    }
}

/// Where something acts.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Where {
    /// Along a degree of freedom of a node, or about an axis from 3 on.
    Node(u64, usize),
    /// Heat at a node.
    Heated(u64),
    /// On a reference: a force, or a moment.
    Reference(String, bool, usize),
    /// On a side of an element.
    Side(Acts, u64, u8),
    /// On a surface.
    Surface(Acts, String),
    /// A source of heat in an element set.
    Source(Target),
    /// On all mass of an element set, by a line that no other one is like.
    Mass(Target, String),
    /// On a mass at a node, of such a set and line.
    Weight(u64, Target, String),
    /// On a mass of a reference, likewise.
    WeightOf(String, Target, String),
}

/// What acts there.
#[derive(Clone, Debug, PartialEq)]
struct What {
    kind: Chosen,
    amplitude: Option<Name>,
    place: Place,
}

/// A load of the case.
#[derive(Clone, Debug)]
struct Group {
    name: Name,
    on: Name,
    members: BTreeSet<Where>,
    what: What,
}

/// What acts at the present step, and the loads it has been made into.
#[derive(Default)]
pub(super) struct Loads {
    acting: BTreeMap<Where, What>,
    /// What the present step has named already.
    named: BTreeSet<Where>,
    groups: Vec<Group>,
}

impl Loads {
    /// Adds to what the step has put there; takes the place of what earlier steps have.
    fn put(&mut self, at: Where, what: What) {
        let first = self.named.insert(at.clone());
        match self.acting.get_mut(&at) {
            Some(acting) if !first && acting.amplitude == what.amplitude => {
                acting.kind = sum(&acting.kind, &what.kind);
            }
            _ => {
                self.acting.insert(at, what);
            }
        }
    }

    /// Takes back all that cards of a keyword have put there in earlier steps.
    fn clear(&mut self, keyword: &str) {
        let named = &self.named;
        self.acting
            .retain(|at, _| !at.is_of(keyword) || named.contains(at));
    }
}

impl Where {
    /// Whether cards of a keyword act there.
    fn is_of(&self, keyword: &str) -> bool {
        match self {
            Self::Node(..) | Self::Reference(..) => keyword == "CLOAD",
            Self::Heated(_) => keyword == "CFLUX",
            Self::Side(Acts::Line, ..) => keyword == "DLOAD",
            Self::Side(acts, ..) => Acts::of(keyword) == Some((*acts, false)),
            Self::Surface(acts, _) => Acts::of(keyword) == Some((*acts, true)),
            Self::Source(_) => keyword == "DFLUX",
            Self::Mass(..) | Self::Weight(..) | Self::WeightOf(..) => keyword == "DLOAD",
        }
    }
}

/// Two loads of one kind together.
fn sum(a: &Chosen, b: &Chosen) -> Chosen {
    let together = match (a.bare_value(), b.bare_value()) {
        (Some(Value::Numbers(a)), Some(Value::Numbers(b))) => {
            Value::Numbers(a.iter().zip(b).map(|(a, b)| a + b).collect())
        }
        (Some(Value::Number(a)), Some(Value::Number(b))) => Value::Number(a + b),
        _ => return b.clone(),
    };
    if a.name == b.name {
        Chosen::bare(b.name, together)
    } else {
        b.clone()
    }
}

/// The same kind of load, of nothing.
fn nothing(of: &Chosen) -> Chosen {
    let values = of.values.iter().map(|(key, value)| {
        let value = match value {
            Value::Number(_) if key == of.name || SIZES.contains(&key) => Value::Number(0.0),
            Value::Numbers(numbers) if key == of.name => Value::Numbers(vec![0.0; numbers.len()]),
            other => other.clone(),
        };
        (key, value)
    });
    Chosen {
        name: of.name,
        values: values.fold(Values::new(), |values, (key, value)| {
            values.with(key, value)
        }),
    }
}

/// The key of a centrifugal load that is its size.
const SPEED: &str = "speed";
/// The keys of loads that are their sizes, where these are not called as the load is.
const SIZES: [&str; 3] = [SPEED, "h", "emissivity"];

/// A load that is a vector.
pub(super) fn vector(name: &'static str, vector: impl Into<[f64; 3]>) -> Chosen {
    Chosen::bare(name, Value::Numbers(vector.into().to_vec()))
}

impl Translation<'_> {
    /// What a card adds to the loads.
    pub fn load(&mut self, card: &Statement, renews: bool, loads: &mut Loads) {
        let amplitude = self.amplitude_of_load(card);
        if renews {
            loads.clear(&card.keyword);
        }
        for row in card.rows() {
            let place = row.first().map_or(card.place.clone(), Field::place);
            let what = |kind| What {
                kind,
                amplitude: amplitude.clone(),
                place: place.clone(),
            };
            match card.keyword.as_str() {
                "CLOAD" => {
                    for (at, kind) in self.concentrated(card, &row) {
                        loads.put(at, what(kind));
                    }
                }
                "CFLUX" => {
                    let power = self.real(row.get(2));
                    let kind = Chosen::bare("heat_power", Value::Number(power));
                    for label in self.heated(card, &row) {
                        loads.put(Where::Heated(label), what(kind.clone()));
                    }
                }
                "DLOAD" => {
                    for (at, kind) in self.distributed(card, &row) {
                        loads.put(at, what(kind));
                    }
                }
                _ => {
                    for (at, kind) in self.on_faces(card, &row) {
                        loads.put(at, what(kind));
                    }
                }
            }
        }
    }

    /// The amplitude of a card. Films and radiation have one of their own; what AMPLITUDE means there is the temperature around.
    fn amplitude_of_load(&mut self, card: &Statement) -> Option<Name> {
        let (name, delay) = match card.keyword.as_str() {
            "FILM" | "SFILM" => ("FILMAMPLITUDE", "FILMTIMEDELAY"),
            "RADIATE" | "SRADIATE" => ("RADIATIONAMPLITUDE", "RADIATIONTIMEDELAY"),
            _ => return self.amplitude(card),
        };
        if card.has("AMPLITUDE") {
            let text = format!("AMPLITUDE of *{} is not supported", card.title);
            let remark = "the temperature around has no course: a step for each";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        self.amplitude_by(card, name, delay)
    }

    /// A line of a card whose loads act on faces: of a surface, or a side of elements.
    fn on_faces(&mut self, card: &Statement, row: &[Field<'_>]) -> Vec<(Where, Chosen)> {
        let Some((acts, of_surface)) = Acts::of(&card.keyword) else {
            return Vec::new();
        };
        let place = row.first().map_or(card.place.clone(), Field::place);
        let label = row.get(1).map(Field::key).unwrap_or_default();
        let kind = acts.kind(self.reals(row.get(2..).unwrap_or_default()));
        let side = label.strip_prefix(acts.letter());
        if of_surface {
            let Some(first) = row.first() else {
                return Vec::new();
            };
            let Some(on) = self.set(card, first.text, &place, Kind::Surface) else {
                return Vec::new();
            };
            if label.is_empty() || side == Some("") {
                return vec![(Where::Surface(acts, on.value), kind)];
            }
            match acts {
                Acts::Pressure => {
                    let text = "*DSLOAD has only pressures P here";
                    self.error(&codes::NOT_BUILT, text, &place, "");
                }
                _ => self.no_such_heat(card, &label, &place),
            }
            return Vec::new();
        }
        let targets = self.targets(card, row.first(), Kind::Elements);
        if acts == Acts::Flux && label == "BF" {
            let density = self.real(row.get(2));
            let source = Chosen::bare("heat_source", Value::Number(density));
            let sources = targets.into_iter().map(Where::Source);
            return sources.map(|at| (at, source.clone())).collect();
        }
        let side = side.and_then(|side| side.parse::<u8>().ok());
        let Some(side) = side.filter(|side| *side > 0) else {
            self.no_such_heat(card, &label, &place);
            return Vec::new();
        };
        let elements = targets.iter().flat_map(|target| self.elements(target));
        let at = |element| (Where::Side(acts, element, side), kind.clone());
        elements.map(at).collect()
    }

    /// A line of *CLOAD.
    fn concentrated(&mut self, card: &Statement, row: &[Field<'_>]) -> Vec<(Where, Chosen)> {
        let targets = self.targets(card, row.first(), Kind::Nodes);
        let place = row.first().map_or(card.place.clone(), Field::place);
        let dof = self.count(row.get(1), 0) as usize;
        let value = self.real(row.get(2));
        if !(1..=6).contains(&dof) {
            let text = format!("there is no force along degree of freedom {dof}");
            self.error(&codes::OUT_OF_RANGE, text, &place, "1 to 6");
            return Vec::new();
        }
        let axis = (dof - 1) % 3;
        let mut all = Vec::new();
        for label in targets.iter().flat_map(|target| self.labels(target)) {
            if let Some(carrier) = self.carriers.get(&label) {
                let vector = (unit(axis) * value).to_array();
                let turns = carrier.turns || dof > 3;
                let kind = if turns {
                    self::vector("moment", vector)
                } else {
                    self::vector("force", vector)
                };
                all.push((Where::Reference(carrier.name.clone(), turns, axis), kind));
            } else if dof > 3 && self.shell_nodes.contains(&label) {
                let direction = match self.axes.get(&label) {
                    Some(axes) => global(axes, axis, value),
                    None => unit(axis) * value,
                };
                let kind = vector("moment", direction.to_array());
                all.push((Where::Node(label, dof - 1), kind));
            } else if dof > 3 && self.has_structures {
                // their sections are refused
                break;
            } else if dof > 3 {
                let text = format!("node {label} bears no moment");
                self.error(
                    &codes::WRONG_KIND,
                    text,
                    &place,
                    "name the node of a rigid body or a shell",
                );
                break;
            } else {
                let direction = match self.axes.get(&label) {
                    Some(axes) => global(axes, axis, value),
                    None => unit(axis) * value,
                };
                let kind = vector("per_node", direction.to_array());
                all.push((Where::Node(label, axis), kind));
            }
        }
        all
    }

    /// A line of *DLOAD.
    fn distributed(&mut self, card: &Statement, row: &[Field<'_>]) -> Vec<(Where, Chosen)> {
        let place = row.first().map_or(card.place.clone(), Field::place);
        let label = row.get(1).map(Field::key).unwrap_or_default();
        let weights = row.first().map(|field| self.weighed(card, field));
        let weights = weights.unwrap_or_default();
        let targets = self.besides(card, row.first(), &weights);
        if label != "GRAV" && !weights.is_empty() {
            let text = format!("*DLOAD: {label} does not act on MASS elements");
            let remark = "GRAV does; of others write the forces, by *CLOAD";
            self.error(&codes::NOT_BUILT, text, &place, remark);
            return Vec::new();
        }
        let [value, x, y, z, a, b, c] = self.reals(row.get(2..).unwrap_or_default());
        let mass = |target: &Target| Where::Mass(target.clone(), format!("{label} {x} {y} {z}"));
        let on_mass = |kind: Chosen| -> Vec<(Where, Chosen)> {
            targets
                .iter()
                .map(|target| (mass(target), kind.clone()))
                .collect()
        };
        match label.as_str() {
            "GRAV" => {
                let direction = signorini_geometry::tensor::Vec3::new(x, y, z).normalized();
                let Some(direction) = direction else {
                    let text = "GRAV has no direction";
                    self.error(&codes::OUT_OF_RANGE, text, &place, "GRAV, g, nx, ny, nz");
                    return Vec::new();
                };
                if let Some(rigid) = targets
                    .iter()
                    .find_map(|target| self.rigid_with_masses(target))
                {
                    let text =
                        format!("GRAV on rigid body `{rigid}`, which has MASS elements, too");
                    let remark = "by *RIGID BODY, NSET= elements keep a weight of their own";
                    self.error(&codes::NOT_BUILT, text, &place, remark);
                }
                let gravity = direction * value;
                let mut all = on_mass(vector("gravity", gravity.to_array()));
                let line = format!("{label} {x} {y} {z}");
                for ((of, node), mass) in weights {
                    let force = (gravity * mass).to_array();
                    all.push(match self.carriers.get(&node) {
                        Some(carrier) => (
                            Where::WeightOf(carrier.name.clone(), of, line.clone()),
                            vector("force", force),
                        ),
                        None => (
                            Where::Weight(node, of, line.clone()),
                            vector("per_node", force),
                        ),
                    });
                }
                all
            }
            "CENTRIF" => {
                if value < 0.0 {
                    let text = "CENTRIF has the square of the speed, which is not negative";
                    self.error(&codes::OUT_OF_RANGE, text, &place, "");
                    return Vec::new();
                }
                let values = Values::new()
                    .with(SPEED, Value::Number(value.sqrt()))
                    .with("point", Value::Numbers(vec![x, y, z]))
                    .with("axis", Value::Numbers(vec![a, b, c]));
                let name = "centrifugal";
                on_mass(Chosen { name, values })
            }
            _ => self.on_sides(&targets, (&label, value), &place),
        }
    }

    /// A load of *DLOAD on sides of elements: a pressure, or a force along the edge of a shell. P of a shell pushes along its
    /// normal.
    fn on_sides(
        &mut self,
        targets: &[Target],
        (label, value): (&str, f64),
        place: &Place,
    ) -> Vec<(Where, Chosen)> {
        let number = |text: &str| text.parse::<u8>().ok().filter(|side| *side > 0);
        let (pressure, edge) = (label.strip_prefix('P'), label.strip_prefix("EDNOR"));
        let side = pressure.and_then(number);
        let edge = edge.and_then(number).filter(|edge| *edge <= 4);
        let mut all = Vec::new();
        let mut strange = None;
        for element in targets.iter().flat_map(|target| self.elements(target)) {
            let at = match (self.is_shell(element), side, edge) {
                (true, Some(_), _) => Some((Acts::Pressure, 1)),
                (true, None, _) if pressure == Some("") => Some((Acts::Pressure, 1)),
                (true, _, Some(edge)) => Some((Acts::Line, edge + 2)),
                (false, Some(side), _) => Some((Acts::Pressure, side)),
                _ => None,
            };
            let Some((acts, side)) = at else {
                strange = Some(element);
                break;
            };
            all.push((Where::Side(acts, element, side), acts.kind([value, 0.0])));
        }
        let is_known = side.is_some() || edge.is_some() || pressure == Some("");
        if strange.is_none() && is_known || self.has_structures {
            return all;
        }
        let text = match strange.filter(|_| is_known && !self.shell_nodes.is_empty()) {
            Some(element) => {
                format!("*DLOAD: {label} does not act on element {element}, which is no shell")
            }
            None => format!("*DLOAD has no load `{label}` here"),
        };
        let remark = match label.ends_with("NU") || label.ends_with("NP") {
            true => "pressures of users' routines are not built",
            false if self.shell_nodes.is_empty() => "P1 to P6, GRAV and CENTRIF are read",
            false => "P, EDNOR1 to EDNOR4 of shells, P1 to P6 of solids, GRAV and CENTRIF are read",
        };
        self.error(&codes::NOT_BUILT, text, place, remark);
        Vec::new()
    }

    /// Writes what has changed since the step before into a step.
    pub fn write_loads(&mut self, loads: &mut Loads, sudden: bool, step: &mut Step) {
        loads.named.clear();
        let mut left: BTreeMap<Where, What> = loads.acting.clone();
        let mut ended = Vec::new();
        loads.groups.retain(|group| {
            let stays = group
                .members
                .iter()
                .all(|at| left.get(at) == Some(&group.what));
            if stays {
                for at in &group.members {
                    left.remove(at);
                }
            } else {
                ended.push(group.clone());
            }
            stays
        });
        let firsts = ended.iter().zip(0..);
        let firsts = firsts.filter_map(|(group, k)| Some((group.members.first()?.clone(), k)));
        let firsts: BTreeMap<Where, usize> = firsts.collect();
        let mut ended: Vec<Option<Group>> = ended.into_iter().map(Some).collect();
        for (members, what) in together(left) {
            let before = members.first().and_then(|first| firsts.get(first));
            let before = before.and_then(|at| ended.get_mut(*at));
            let before = before.and_then(|group| group.take_if(|g| g.members == members));
            let group = match before {
                Some(group) => Group { what, ..group },
                None => {
                    let name = self.fresh("load");
                    Group {
                        name: Spanned::new(name, what.place.clone()),
                        on: self.members_named(&members, &what.place),
                        members,
                        what,
                    }
                }
            };
            step.loads.push(load_of(&group, sudden, step.duration));
            loads.groups.push(group);
        }
        for mut group in ended.into_iter().flatten() {
            group.what.kind = nothing(&group.what.kind);
            group.what.amplitude = None;
            step.loads.push(load_of(&group, sudden, step.duration));
        }
    }

    fn members_named(&mut self, members: &BTreeSet<Where>, place: &Place) -> Name {
        let named = |name: &str| Spanned::new(name.to_owned(), place.clone());
        match members.first() {
            Some(Where::Reference(name, ..) | Where::Surface(_, name)) => named(name),
            Some(Where::WeightOf(name, ..)) => named(name),
            Some(Where::Mass(Target::Set(name), _) | Where::Source(Target::Set(name))) => {
                named(name)
            }
            Some(Where::Mass(Target::One(element), _) | Where::Source(Target::One(element))) => {
                self.elements_named(vec![*element], place)
            }
            Some(Where::Side(..)) => {
                let sides = members.iter().filter_map(|at| match at {
                    Where::Side(_, element, side) => Some((*element, *side)),
                    _ => None,
                });
                self.sides_named(sides.collect(), place)
            }
            _ => {
                let nodes = members.iter().filter_map(|at| match at {
                    Where::Node(label, _) | Where::Weight(label, ..) => Some(*label),
                    Where::Heated(label) => Some(*label),
                    _ => None,
                });
                self.nodes_named(nodes.collect(), place)
            }
        }
    }
}

/// What acts alike, together, in the order of the first of each.
fn together(all: BTreeMap<Where, What>) -> Vec<(BTreeSet<Where>, What)> {
    let mut groups: Vec<(BTreeSet<Where>, What)> = Vec::new();
    // those that may be alike, by a number that these share
    let mut places: HashMap<u64, Vec<usize>> = HashMap::new();
    for (at, what) in all {
        if !may_go_together(&at) {
            groups.push((BTreeSet::from([at]), what));
            continue;
        }
        let near = places.entry(likeness(&what)).or_default();
        let alike = |&&k: &&usize| {
            groups.get(k).is_some_and(|(members, known)| {
                *known == what && members.first().is_some_and(|one| goes_with(one, &at))
            })
        };
        let known = near.iter().rev().find(alike).copied();
        match known.and_then(|k| groups.get_mut(k)) {
            Some((members, _)) => {
                members.insert(at);
            }
            None => {
                near.push(groups.len());
                groups.push((BTreeSet::from([at]), what));
            }
        }
    }
    groups
}

/// A number that all loads have that are equal, and hardly others.
fn likeness(what: &What) -> u64 {
    let mut hasher = DefaultHasher::new();
    what.kind.name.hash(&mut hasher);
    what.amplitude
        .as_ref()
        .map(|name| &name.value)
        .hash(&mut hasher);
    let numbers = what.kind.values.iter().flat_map(|(_, value)| match value {
        Value::Number(number) => std::slice::from_ref(number),
        Value::Numbers(numbers) => numbers,
        Value::Text(_) => &[],
    });
    for number in numbers {
        // zeros of both signs are equal
        (number + 0.0).to_bits().hash(&mut hasher);
    }
    hasher.finish()
}

/// Whether others may be one load with it.
fn may_go_together(at: &Where) -> bool {
    matches!(
        at,
        Where::Node(..) | Where::Heated(_) | Where::Side(..) | Where::Weight(..)
    )
}

/// Whether two may be one load.
fn goes_with(a: &Where, b: &Where) -> bool {
    match (a, b) {
        (Where::Node(_, a), Where::Node(_, b)) => a == b,
        (Where::Heated(_), Where::Heated(_)) => true,
        (Where::Side(a, ..), Where::Side(b, ..)) => a == b,
        (Where::Weight(_, a, by), Where::Weight(_, b, with)) => a == b && by == with,
        _ => false,
    }
}

fn load_of(group: &Group, sudden: bool, duration: f64) -> Load {
    let What {
        kind,
        amplitude,
        place,
    } = group.what.clone();
    // the power of all nodes together
    let kind = match (group.members.first(), kind.bare_value()) {
        (Some(Where::Heated(_)), Some(Value::Number(each))) => {
            Chosen::bare(kind.name, Value::Number(each * group.members.len() as f64))
        }
        _ => kind,
    };
    Load {
        name: Some(group.name.clone()),
        on: group.on.clone(),
        kind,
        what: place.clone(),
        follows: None,
        coupling: None,
        course: match amplitude {
            Some(name) => Course::Amplitude(name),
            None if sudden => Course::Table(vec![[0.0, 1.0], [duration, 1.0]]),
            None => Course::Ramp,
        },
        place,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn what(kind: Chosen) -> What {
        What {
            kind,
            amplitude: None,
            place: Place::nowhere(),
        }
    }

    #[test]
    fn equal_loads_are_one_and_others_differ_by_a_number() {
        let force = |k: u64| vector("per_node", [(k % 40) as f64, 0.0, -1.0]);
        let all = (0..400).map(|k| (Where::Node(k, 0), what(force(k))));
        let groups = together(all.collect());
        assert_eq!(groups.len(), 40);
        for (k, (members, what)) in (0..).zip(&groups) {
            let expected = (0..10).map(|n| Where::Node(k + 40 * n, 0));
            assert_eq!(*members, expected.collect());
            assert_eq!(what.kind, force(k));
        }
        let numbers: BTreeSet<u64> = groups.iter().map(|(_, what)| likeness(what)).collect();
        assert_eq!(numbers.len(), 40);
        let pressure = |p: f64| Acts::Pressure.kind([p, 0.0]);
        let zero = |z: f64| likeness(&what(pressure(z)));
        assert_eq!(zero(0.0), zero(-0.0));
    }
}
