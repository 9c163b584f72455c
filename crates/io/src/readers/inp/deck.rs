//! What a deck says, card by card, before any number or name in it is looked up.

use super::card::{Card, Fields, Parameter, at_most, key, not_a_number, real, text, whole};
use super::definition::{Definition, Family, Region, Side};
use super::directory::ElementCard;
use super::kind::{Kind, supported};
use super::lines::{Files, Lines, Spot};
use super::parameters::{judge, not_read};
use super::part::Part;
use super::statement::{Statement, place_of};
use crate::readers::MeshError;
use crate::readers::error::excerpt;
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

type Result<T> = std::result::Result<T, MeshError>;

/// Cards that make nodes or elements out of others, or move them.
const REFUSED: [(&str, &str); 10] = [
    ("NCOPY", GENERATED),
    ("NGEN", GENERATED),
    ("NFILL", GENERATED),
    ("NMAP", GENERATED),
    ("ELGEN", GENERATED),
    ("ELCOPY", GENERATED),
    ("SYMMETRICMODELGENERATION", GENERATED),
    ("IMPORT", GENERATED),
    (
        "SYSTEM",
        "it moves the nodes that follow; write their coordinates in the global system",
    ),
    ("PARAMETER", "write numbers in place of its names"),
];
/// Cards of the mesh, which are read here.
const OF_MESH: [&str; 7] = [
    "NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "PART", "INSTANCE",
];
/// Parameters with which Abaqus/CAE marks sets of its own, and order that no set here has.
const INTERNAL: [&str; 2] = ["INTERNAL", "UNSORTED"];

const GENERATED: &str =
    "it makes nodes or elements out of others; export the deck with all of them written out";

/// Nodes, elements and sets whose numbers and names stand for themselves: a part, an instance, the whole of a flat deck.
#[derive(Default)]
pub(super) struct Scope {
    pub node_labels: Vec<u64>,
    pub points: Vec<Vec3>,
    pub node_spots: Vec<Spot>,
    pub element_labels: Vec<u64>,
    pub element_kinds: Vec<u32>,
    pub element_spots: Vec<Spot>,
    /// The *ELEMENT card of each, where these are kept.
    pub element_cards: Vec<u32>,
    /// Node numbers of all elements, one after the other.
    pub connectivity: Vec<u64>,
    pub definitions: Vec<Definition>,
}

/// A part that is used.
pub(super) struct Instance {
    pub name: String,
    pub spot: Spot,
    /// The part, among the scopes.
    pub part: usize,
    /// What the instance has of its own, among the scopes.
    pub own: usize,
    pub translation: Vec3,
    /// Two points of the axis, the angle in degrees.
    pub rotation: Option<(Vec3, Vec3, f64)>,
}

/// A deck.
pub(super) struct Deck {
    pub kinds: Vec<Kind>,
    /// The first is the deck itself, or its assembly.
    pub scopes: Vec<Scope>,
    pub instances: Vec<Instance>,
    /// Cards of elements; none unless the whole deck is asked for.
    pub element_cards: Vec<ElementCard>,
    /// Cards that are no part of the mesh; none unless they are asked for.
    pub statements: Vec<Statement>,
    pub notes: Vec<String>,
}

/// Reads all cards, and keeps those that are no part of the mesh where `part` says so.
pub(super) fn read(files: &Files<'_>, part: Part) -> Result<Deck> {
    let mut reader = Reader {
        lines: files.lines(),
        deck: Deck {
            kinds: Vec::new(),
            scopes: vec![Scope::default()],
            instances: Vec::new(),
            element_cards: Vec::new(),
            statements: Vec::new(),
            notes: Vec::new(),
        },
        whole: part == Part::Whole,
        part,
        kinds: BTreeMap::new(),
        parts: BTreeMap::new(),
        instances: BTreeSet::new(),
        here: 0,
        open: None,
        step: None,
        unread: BTreeMap::new(),
    };
    reader.cards()?;
    Ok(reader.deck)
}

struct Reader<'f> {
    lines: Lines<'f>,
    deck: Deck,
    kinds: BTreeMap<String, u32>,
    parts: BTreeMap<String, usize>,
    instances: BTreeSet<String>,
    /// Whether the whole deck counts.
    whole: bool,
    /// Which statements are kept.
    part: Part,
    /// The scope that cards fill.
    here: usize,
    /// The part or instance that is open: its keyword and its line.
    open: Option<(&'static str, Spot)>,
    /// The step that is open.
    step: Option<Spot>,
    /// Parameters of cards of the mesh that nobody asks for, by keyword and name.
    unread: BTreeMap<(String, String), Vec<Spot>>,
}

impl Reader<'_> {
    fn cards(&mut self) -> Result<()> {
        let mut before: Option<MeshError> = None;
        let mut ncard = 0;
        while let Some(line) = self.lines.line() {
            if !line.starts_with(b"*") {
                before.get_or_insert_with(|| MeshError::NotACard {
                    place: self.lines.place(),
                    found: excerpt(line),
                });
                continue;
            }
            ncard += 1;
            let card = Card::read(line, &mut self.lines);
            self.card(&card)?;
        }
        match before {
            Some(error) if ncard == 0 => return Err(error),
            Some(MeshError::NotACard { place, found }) => self.deck.notes.push(format!(
                "{place}: `{found}` and what follows stands before the first keyword: ignored"
            )),
            _ => {}
        }
        if self.whole {
            self.note_unread();
        }
        if let Some((keyword, spot)) = self.open {
            return Err(MeshError::Truncated {
                place: self.lines.place_of(spot),
                section: format!("*{keyword}"),
                wanted: "its *END",
            });
        }
        if let Some(spot) = self.step.filter(|_| self.whole) {
            return Err(MeshError::Truncated {
                place: self.lines.place_of(spot),
                section: "*STEP".into(),
                wanted: "its *END STEP",
            });
        }
        if let Some(spot) = self.step {
            let note = format!(
                "{}: *STEP without *END STEP; was the deck cut off?",
                self.lines.place_of(spot)
            );
            self.deck.notes.push(note);
        }
        Ok(())
    }

    /// Refuses what a card of the mesh does not take; other cards are judged by those who read them.
    fn judge(&self, card: &Card) -> Result<()> {
        let faults = card.parameters.iter().filter(|one| !one.name.is_empty());
        let mut faults = faults.filter_map(|one| judge(&card.keyword, &one.name, &one.value));
        match faults.next() {
            None => Ok(()),
            Some(fault) => Err(MeshError::Parameter {
                place: self.lines.place_of(card.spot),
                what: fault.message,
                remark: match fault.remark.as_str() {
                    "" => fault.known,
                    _ => fault.remark,
                },
            }),
        }
    }

    fn card(&mut self, card: &Card) -> Result<()> {
        if OF_MESH.contains(&card.keyword.as_str()) {
            self.judge(card)?;
        }
        let of_mesh = match card.keyword.as_str() {
            "NODE" => Some(self.nodes(card)),
            "ELEMENT" => Some(self.elements(card)),
            "NSET" => Some(self.set(card, Family::Nodes)),
            "ELSET" => Some(self.set(card, Family::Cells)),
            "SURFACE" => Some(self.surface(card)),
            "PART" => Some(self.part(card)),
            "INSTANCE" => Some(self.instance(card)),
            _ => None,
        };
        if let Some(done) = of_mesh {
            self.gather_unread(card);
            return done;
        }
        match card.keyword.as_str() {
            "ENDPART" => self.close(card, "PART")?,
            "ENDINSTANCE" => self.close(card, "INSTANCE")?,
            "INCLUDE" => {
                card.need("INPUT", &self.lines)?;
            }
            "STEP" => {
                if self.step.is_some() && self.whole {
                    return Err(self.nesting(card, "in another step", "end that one by *END STEP"));
                }
                self.step = Some(card.spot);
            }
            "ENDSTEP" => self.step = None,
            keyword => {
                if let Some((_, why)) = REFUSED.iter().find(|(known, _)| *known == keyword) {
                    return Err(self.refused(card, why));
                }
            }
        }
        if self.part.keeps(&card.keyword) {
            let statement = Statement::read(card, self.here, &mut self.lines);
            self.deck.statements.push(statement);
        }
        self.skip();
        Ok(())
    }

    /// Takes down what a card of the mesh says and nobody has asked for.
    fn gather_unread(&mut self, card: &Card) {
        for name in Parameter::unread(&card.parameters).filter(|name| !INTERNAL.contains(name)) {
            let of = (card.keyword.clone(), name.to_owned());
            self.unread.entry(of).or_default().push(card.spot);
        }
    }

    /// One note for each parameter that was not read, with the first of its lines.
    fn note_unread(&mut self) {
        for ((keyword, name), spots) in std::mem::take(&mut self.unread) {
            let Some((first, others)) = spots.split_first() else {
                continue;
            };
            let more = match others.len() {
                0 => String::new(),
                1 => ", and once more below".to_owned(),
                count => format!(", and {count} times more below"),
            };
            let place = self.lines.place_of(*first);
            let note = format!("{place}: {}{more}", not_read(&keyword, &name));
            self.deck.notes.push(note);
        }
    }

    fn skip(&mut self) {
        while self.lines.data().is_some() {}
    }

    fn refused(&self, card: &Card, why: &'static str) -> MeshError {
        MeshError::Refused {
            place: self.lines.place_of(card.spot),
            card: card.title.clone(),
            why,
        }
    }

    fn scope(&mut self) -> &mut Scope {
        scope_of(&mut self.deck, self.here)
    }

    fn nodes(&mut self, card: &Card) -> Result<()> {
        let is_cylindrical = match card.get("SYSTEM").map(key).as_deref() {
            None | Some("" | "R") => false,
            Some("C") => true,
            Some(_) => {
                let why = "only SYSTEM=R and SYSTEM=C are read; write Cartesian coordinates";
                return Err(self.refused(card, why));
            }
        };
        let lines = &mut self.lines;
        let scope = scope_of(&mut self.deck, self.here);
        let first = scope.points.len();
        // the last node, where it has a number alone: coordinates that are not given are zero, but a file may be cut off
        let mut unplaced = None;
        while let Some(line) = lines.data() {
            let mut fields = Fields::of(line);
            let field = fields.next().unwrap_or_default();
            let label = label(lines, card, "a node number", field)?;
            let mut x = [0.0; 3];
            let mut ncoordinate = 0;
            // the fields last: what is looked at there is gone
            for ((x, axis), field) in x.iter_mut().zip(['x', 'y', 'z']).zip(&mut fields) {
                *x = number(lines, card, "a coordinate", field)?;
                ncoordinate += usize::from(!field.is_empty());
                if !x.is_finite() {
                    return Err(MeshError::NotFinite {
                        place: lines.place(),
                        node: label,
                        axis,
                        found: excerpt(field),
                    });
                }
            }
            if fields.next().is_some() {
                let hint =
                    "; decimals have a point, not a comma, and normals of shells are not read";
                let most = (4, "a number and three coordinates", hint);
                at_most(lines, card, line, most)?;
            }
            unplaced = (ncoordinate == 0).then_some((label, lines.spot));
            let [a, b, c] = x;
            let x = if is_cylindrical {
                let (sin, cos) = b.to_radians().sin_cos();
                Vec3::new(a * cos, a * sin, c)
            } else {
                Vec3::new(a, b, c)
            };
            scope.node_labels.push(label);
            scope.points.push(x);
            scope.node_spots.push(lines.spot);
        }
        if let Some((label, spot)) = unplaced.filter(|_| lines.is_at_end()) {
            return Err(MeshError::Truncated {
                place: lines.place_of(spot),
                section: format!("node {label} of *NODE"),
                wanted: "coordinates",
            });
        }
        let end = scope.points.len();
        if end >= u32::MAX as usize {
            return Err(MeshError::Excess {
                place: lines.place(),
                what: "the nodes",
            });
        }
        self.added(card, "NSET", Family::Nodes, first..end);
        Ok(())
    }

    /// The set that a card puts what it defines into.
    fn added(&mut self, card: &Card, parameter: &str, family: Family, added: Range<usize>) {
        if let Some(name) = card.get(parameter).filter(|name| !name.is_empty()) {
            let definition = Definition {
                added,
                ..Definition::new(name, family, card.spot)
            };
            self.scope().definitions.push(definition);
        }
    }

    fn elements(&mut self, card: &Card) -> Result<()> {
        let name = key(card.need("TYPE", &self.lines)?);
        let number = match self.kinds.get(&name) {
            Some(number) => *number,
            None => {
                let kind = Kind::find(&name).ok_or_else(|| MeshError::UnknownElement {
                    place: self.lines.place_of(card.spot),
                    found: excerpt(name.as_bytes()),
                    known: supported(),
                })?;
                let number = self.deck.kinds.len() as u32;
                self.deck.kinds.push(kind);
                self.kinds.insert(name.clone(), number);
                number
            }
        };
        let nnode = (self.deck.kinds.get(number as usize)).map_or(0, |kind| kind.nnode);
        // early CalculiX had nodes for the modes of C3D8I
        let nspare = if name == "C3D8I" { 3 } else { 0 };
        let count_error = |place, element, found| MeshError::NodeCount {
            place,
            element,
            kind: name.clone(),
            found,
            wanted: nnode,
        };
        let lines = &mut self.lines;
        let scope = scope_of(&mut self.deck, self.here);
        let first = scope.element_labels.len();
        // the element whose nodes are not complete yet: its number, its line, the nodes it has
        let mut open: Option<(u64, Spot, usize)> = None;
        while let Some(line) = lines.data() {
            let mut fields = Fields::of(line);
            let (element, spot, mut count) = match open.take() {
                Some(element) => element,
                None => {
                    let field = fields.next().unwrap_or_default();
                    let label = label(lines, card, "an element number", field)?;
                    scope.element_labels.push(label);
                    scope.element_kinds.push(number);
                    scope.element_spots.push(lines.spot);
                    (label, lines.spot, 0)
                }
            };
            if nnode == 0 {
                continue;
            }
            for field in fields.filter(|field| !field.is_empty()) {
                let node = label(lines, card, "a node number", field)?;
                count += 1;
                if count > nnode + nspare {
                    return Err(count_error(lines.place(), element, count));
                }
                if count <= nnode {
                    scope.connectivity.push(node);
                }
            }
            if count < nnode {
                open = Some((element, spot, count));
            }
        }
        if let Some((label, spot, count)) = open {
            return Err(count_error(lines.place_of(spot), label, count));
        }
        let end = scope.element_labels.len();
        if self.whole {
            let number = self.deck.element_cards.len() as u32;
            self.deck.element_cards.push(ElementCard {
                place: place_of(card, &self.lines),
                elset: card
                    .get("ELSET")
                    .filter(|name| !name.is_empty())
                    .map(str::to_owned),
            });
            self.scope().element_cards.resize(end, number);
        }
        self.added(card, "ELSET", Family::Cells, first..end);
        Ok(())
    }

    fn set(&mut self, card: &Card, family: Family) -> Result<()> {
        let (parameter, wanted) = match family {
            Family::Nodes => ("NSET", "a node number"),
            _ => ("ELSET", "an element number"),
        };
        let name = card.need(parameter, &self.lines)?;
        let mut set = Definition::new(name, family, card.spot);
        set.instance = card.get("INSTANCE").map(str::to_owned);
        if family == Family::Nodes {
            set.elsets.extend(card.get("ELSET").map(str::to_owned));
        }
        let generate = card.get("GENERATE").is_some();
        while let Some(line) = self.lines.data() {
            let mut fields = Fields::of(line);
            if generate {
                let hint = "; write one range on a line, or leave out GENERATE";
                let most = (3, "first, last and step with GENERATE", hint);
                at_most(&self.lines, card, line, most)?;
                let mut entry = |default: Option<u64>| match (fields.next(), default) {
                    (None | Some(b""), Some(default)) => Ok(default),
                    (field, _) => {
                        let field = field.unwrap_or_default();
                        whole(field).ok_or_else(|| not_a_number(&self.lines, card, wanted, field))
                    }
                };
                let first = entry(None)?;
                let (last, step) = (entry(Some(first))?, entry(Some(1))?);
                if step == 0 || last < first {
                    return Err(MeshError::OutOfRange {
                        place: self.lines.place(),
                        wanted: "the range of GENERATE",
                        found: format!("{first}, {last}, {step}"),
                        range: "first, last ≥ first, step ≥ 1",
                    });
                }
                set.ranges.push([first, last, step]);
                continue;
            }
            for field in fields.filter(|field| !field.is_empty()) {
                match whole(field) {
                    Some(label) => set.labels.push(label),
                    None => set.names.push(name_of(field)),
                }
            }
        }
        self.scope().definitions.push(set);
        Ok(())
    }

    fn surface(&mut self, card: &Card) -> Result<()> {
        let name = card.need("NAME", &self.lines)?;
        let kind = card.get("TYPE").map(key).unwrap_or_default();
        let family = match kind.as_str() {
            "NODE" => Family::Points,
            _ => Family::Faces,
        };
        let mut surface = Definition::new(name, family, card.spot);
        surface.instance = card.get("INSTANCE").map(str::to_owned);
        let combined = card.get("COMBINE").or(card.get("CROP")).is_some();
        if combined || !["", "ELEMENT", "NODE"].contains(&kind.as_str()) {
            let how = if combined { "of surfaces" } else { &kind };
            let note = format!(
                "{}: surface `{}` is left out: surfaces made {how} are not read",
                self.lines.place_of(card.spot),
                excerpt(name.as_bytes())
            );
            self.deck.notes.push(note);
            self.skip();
            return Ok(());
        }
        while let Some(line) = self.lines.data() {
            let mut fields = Fields::of(line);
            let region = fields.next().unwrap_or_default();
            self.judge_side(card, line, family)?;
            if kind == "NODE" {
                match whole(region) {
                    Some(label) => surface.labels.push(label),
                    None => surface.names.push(name_of(region)),
                }
                continue;
            }
            let named = text(fields.next().unwrap_or_default());
            let side = Side::parse(&key(&named)).ok_or_else(|| MeshError::NotANumber {
                place: self.lines.place(),
                section: "*SURFACE".into(),
                wanted: "a side such as S1",
                found: excerpt(named.as_bytes()),
                hint: "",
            })?;
            let region = match whole(region) {
                Some(label) => Region::Label(label),
                None => Region::Name(name_of(region)),
            };
            surface.sides.push((region, side));
        }
        self.scope().definitions.push(surface);
        Ok(())
    }

    /// Refuses a line of a surface that names more than one thing.
    fn judge_side(&self, card: &Card, line: &[u8], family: Family) -> Result<()> {
        // of a surface of nodes, the second may be an area, which has a decimal point
        let is_area = |field: &[u8]| whole(field).is_none() && real(field).is_some();
        let second = Fields::of(line).nth(1);
        let most = match family {
            Family::Points if !second.is_some_and(is_area) => (1, "one node or node set"),
            Family::Points => (2, "a node or node set, and an area"),
            _ => (2, "an element or element set, and one side"),
        };
        at_most(
            &self.lines,
            card,
            line,
            (most.0, most.1, "; write one on a line"),
        )
    }

    fn nesting(&self, card: &Card, found: &'static str, wanted: &'static str) -> MeshError {
        MeshError::Nesting {
            place: self.lines.place_of(card.spot),
            card: card.title.clone(),
            found,
            wanted,
        }
    }

    /// Opens a scope of its own for what follows.
    fn enter(&mut self, card: &Card, keyword: &'static str) -> Result<usize> {
        if self.open.is_some() {
            let found = "inside another part or instance";
            return Err(self.nesting(card, found, "end that one first"));
        }
        self.open = Some((keyword, card.spot));
        self.deck.scopes.push(Scope::default());
        self.here = self.deck.scopes.len() - 1;
        Ok(self.here)
    }

    fn close(&mut self, card: &Card, keyword: &'static str) -> Result<()> {
        if self.open.take().is_none_or(|(open, _)| open != keyword) {
            return Err(self.nesting(card, "where nothing of that kind is open", "remove it"));
        }
        self.here = 0;
        Ok(())
    }

    fn part(&mut self, card: &Card) -> Result<()> {
        let name = card.need("NAME", &self.lines)?.to_owned();
        let scope = self.enter(card, "PART")?;
        if self.parts.insert(key(&name), scope).is_some() {
            return Err(MeshError::DuplicateName {
                place: self.lines.place_of(card.spot),
                what: "part",
                name,
            });
        }
        self.skip();
        Ok(())
    }

    fn instance(&mut self, card: &Card) -> Result<()> {
        let name = card.need("NAME", &self.lines)?.to_owned();
        let part = card.need("PART", &self.lines)?;
        let known = || {
            let names: Vec<&str> = self.parts.keys().map(String::as_str).take(10).collect();
            match names.is_empty() {
                true => "; the deck has no parts".to_owned(),
                false => format!("; there are {}", names.join(", ")),
            }
        };
        let Some(&part) = self.parts.get(&key(part)) else {
            return Err(MeshError::Undefined {
                place: self.lines.place_of(card.spot),
                what: "part",
                name: excerpt(part.as_bytes()),
                known: known(),
            });
        };
        if !self.instances.insert(key(&name)) {
            return Err(MeshError::DuplicateName {
                place: self.lines.place_of(card.spot),
                what: "instance",
                name,
            });
        }
        let own = self.enter(card, "INSTANCE")?;
        let mut lines = [[0.0; 7]; 2];
        let mut nline = 0;
        while let Some(line) = self.lines.data() {
            let Some(numbers) = lines.get_mut(nline) else {
                let found = "with more than a translation and a rotation";
                return Err(self.nesting(card, found, "write two lines at most"));
            };
            let wanted = "a translation of three components, then two points and an angle";
            let most = if nline == 0 { 3 } else { 7 };
            let hint = "; decimals have a point, not a comma";
            at_most(&self.lines, card, line, (most, wanted, hint))?;
            for (field, x) in Fields::of(line).zip(numbers) {
                *x = number(&self.lines, card, "a number of its position", field)?;
            }
            nline += 1;
        }
        let [[x, y, z, ..], [ax, ay, az, bx, by, bz, angle]] = lines;
        let (a, b) = (Vec3::new(ax, ay, az), Vec3::new(bx, by, bz));
        if nline == 2 && (b - a).normalized().is_none() {
            return Err(self.nesting(card, "with an axis of no length", "give two points of it"));
        }
        self.deck.instances.push(Instance {
            name,
            spot: card.spot,
            part,
            own,
            translation: Vec3::new(x, y, z),
            rotation: (nline == 2).then_some((a, b, angle)),
        });
        Ok(())
    }
}

/// The scope that cards fill; the deck itself is always there.
fn scope_of(deck: &mut Deck, here: usize) -> &mut Scope {
    let here = here.min(deck.scopes.len() - 1);
    &mut deck.scopes[here]
}

/// The number of a node or an element.
#[inline]
fn label(lines: &Lines<'_>, card: &Card, wanted: &'static str, field: &[u8]) -> Result<u64> {
    match whole(field) {
        Some(label) if label > 0 => Ok(label),
        found => Err(no_label(lines, card, wanted, field, found)),
    }
}

#[cold]
fn no_label(
    lines: &Lines<'_>,
    card: &Card,
    wanted: &'static str,
    field: &[u8],
    found: Option<u64>,
) -> MeshError {
    match found {
        None => not_a_number(lines, card, wanted, field),
        Some(label) => MeshError::OutOfRange {
            place: lines.place(),
            wanted,
            found: label.to_string(),
            range: "from 1 on",
        },
    }
}

/// A real number; 0 for an empty field.
#[inline]
fn number(lines: &Lines<'_>, card: &Card, wanted: &'static str, field: &[u8]) -> Result<f64> {
    if field.is_empty() {
        return Ok(0.0);
    }
    real(field).ok_or_else(|| not_a_number(lines, card, wanted, field))
}

/// The name in a field, without its quotes.
fn name_of(field: &[u8]) -> String {
    text(field).trim_matches('"').to_owned()
}
