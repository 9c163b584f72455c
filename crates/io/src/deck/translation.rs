//! What all stages of the translation share: the deck, the case so far, names, messages.

use super::compat::Compat;
use super::keywords::{Keyword, Support};
use super::names::Names;
use super::repeated::Repeated;
use super::{constraint, contact, heat, material, sections, shell, submodel};
use crate::case::{Case, FreeMotions, MeshSource, Name, Set, SetContent, Side};
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Place, Severity, Spanned, codes};
use crate::diagnostic::{closest, listed};
use crate::readers::inp::{
    Deck, Field, Kind, Statement, compared, judge, not_read, number, spelled,
};
use crate::readers::labels::Lookup;
use signorini_geometry::mesh::{CellId, Face};
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, HashSet};

/// What a line of a card is about: a set of the mesh, or a single node or element by its number in the mesh.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Target {
    Set(String),
    One(u64),
}

/// A translation under way.
pub(super) struct Translation<'d> {
    pub deck: &'d Deck,
    pub compat: Compat,
    pub case: Case,
    pub found: Diagnostics,
    /// Local axes of nodes, by their numbers.
    pub axes: BTreeMap<u64, [Vec3; 3]>,
    /// References that nodes stand for, by their numbers.
    pub carriers: BTreeMap<u64, constraint::Carrier>,
    /// Whether a constraint bends with large displacements: then all steps are of large displacements.
    pub bends: bool,
    /// Whether sections are refused whose elements take loads that solids do not: moments, and pressures on their faces.
    pub has_structures: bool,
    /// Whether a step solves for temperatures.
    pub solves_for_heat: bool,
    pub materials: BTreeMap<String, material::Properties>,
    /// Places of amplitudes in the case, by what their names are compared by.
    pub amplitudes: BTreeMap<String, usize>,
    pub pairs: Vec<contact::Pair>,
    pub submodels: Vec<submodel::Submodel>,
    /// The node and the mass of each MASS element.
    pub point_masses: BTreeMap<u64, (u64, f64)>,
    nodes: Lookup,
    /// Places of elements among those of the mesh's dimension.
    elements: Lookup,
    /// Elements that have to be in a body.
    pub cells: Vec<CellId>,
    names: Names,
    /// Sets of nodes of the case, by the numbers in them.
    sets: BTreeMap<Vec<u64>, String>,
    /// The numbers of the nodes of shells.
    pub shell_nodes: HashSet<u64>,
    /// The outer faces of the mesh, once somebody asks.
    pub outer: Option<Vec<Face>>,
    /// Sets of faces that stand for surfaces of nodes.
    pub faced: BTreeMap<String, String>,
}

/// Whether elements of this type are bars that carry normal force only.
pub(super) fn is_truss(kind: &str) -> bool {
    kind.starts_with("T2D") || kind.starts_with("T3D")
}

/// What becomes of a card that no keyword is for. CalculiX passes over it with a warning; one
/// that is written like another is a typing error.
fn unknown_keyword(card: &Statement, compat: Compat) -> Diagnostic {
    let names = super::KEYWORDS.iter().map(|one| one.name);
    if let Some(meant) = closest(&card.title, names) {
        let text = format!("there is no keyword *{}", card.title);
        let remark = format!("did you mean *{meant}?");
        return Diagnostic::error(&codes::UNKNOWN_KEY, text).at(&card.place, remark);
    }
    if compat == Compat::Ccx {
        let text = format!(
            "*{} is not known: it is left out, as CalculiX does",
            card.title
        );
        return Diagnostic::warning(&codes::UNUSUAL, text).at(&card.place, "");
    }
    let text = format!("there is no keyword *{}", card.title);
    let help =
        "if it changes no result, remove it; `signorini keywords` lists those that are known";
    let one = Diagnostic::error(&codes::UNKNOWN_KEY, text).at(&card.place, "");
    one.help(help)
}

impl<'d> Translation<'d> {
    pub fn new(deck: &'d Deck, name: &str, compat: Compat) -> Self {
        let mesh = &deck.mesh;
        let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let mut case = Case::empty();
        if compat == Compat::Ccx {
            // CalculiX' factorization passes zero pivots
            case.solver.free_motions = FreeMotions::Hold;
        }
        case.mesh = MeshSource::File {
            path: file.to_owned().into(),
        };
        let (names, types) = deck.directory.types();
        let is_truss = |cell: &CellId| {
            let number = types
                .get(cell.block as usize)
                .and_then(|t| t.get(cell.index as usize));
            let name = number.and_then(|&number| names.get(number as usize));
            name.is_some_and(|name| is_truss(name))
        };
        let trusses = mesh.cells(1).filter(is_truss);
        let trusses = trusses.filter(|_| mesh.dim() > 1);
        let shells = deck.directory.shells().iter().copied();
        let shells = shells.filter(|_| mesh.dim() > 2);
        let cells: Vec<CellId> = (mesh.cells(mesh.dim()).chain(shells).chain(trusses)).collect();
        let label = |cell: &CellId| mesh.cell_label(*cell).unwrap_or(0);
        let labels: Vec<u64> = cells.iter().map(label).collect();
        Self {
            deck,
            compat,
            case,
            found: Diagnostics::new(),
            axes: BTreeMap::new(),
            carriers: BTreeMap::new(),
            bends: false,
            has_structures: sections::are_structures(&deck.statements),
            solves_for_heat: heat::is_solved_for(&deck.statements),
            materials: BTreeMap::new(),
            amplitudes: BTreeMap::new(),
            pairs: Vec::new(),
            submodels: Vec::new(),
            point_masses: BTreeMap::new(),
            nodes: Lookup::new(&mesh.node_labels),
            elements: Lookup::new(&labels),
            cells,
            names: Names::new(mesh.sets.keys().cloned()),
            sets: BTreeMap::new(),
            shell_nodes: shell::nodes_of_shells(deck),
            outer: None,
            faced: BTreeMap::new(),
        }
    }

    /// The cards of the model section with one of these keywords.
    pub fn cards(&self, keyword: &'static str) -> impl Iterator<Item = &'d Statement> + use<'d> {
        let mut inside = false;
        self.deck.statements.iter().filter(move |card| {
            inside |= card.keyword == "STEP";
            let here = !inside && card.keyword == keyword;
            inside &= card.keyword != "ENDSTEP";
            here
        })
    }

    /// Refuses parameters that cards do not take, and words that parameters do not: once each, with all lines.
    pub fn parameters(&mut self) {
        let mut faults = Repeated::default();
        for card in &self.deck.statements {
            let named = card.parameters().filter(|(name, _)| !name.is_empty());
            for (name, value) in named {
                if let Some(fault) = judge(&card.keyword, name, value) {
                    let one = Diagnostic::error(fault.code, fault.message);
                    let one = one.at(&card.place, fault.remark).note(fault.known);
                    faults.add(one, &card.place);
                }
            }
        }
        faults.report(&mut self.found);
    }

    /// Names cards that are left out and what of others is not read, once each with all places, and refuses those that
    /// are not built or not known.
    pub fn judge(&mut self) {
        let mut all = Repeated::default();
        for card in &self.deck.statements {
            let place = &card.place;
            let note =
                |text| Diagnostic::new(Severity::Note, &codes::NO_EFFECT, text).at(place, "");
            match Keyword::of(&card.keyword) {
                Some(known) if known.support == Support::Read => {
                    if card.is_unread() {
                        let text = format!("*{} is left out: it is not read here", known.name);
                        all.add(note(text), place);
                        continue;
                    }
                    for name in card.unread() {
                        all.add(note(not_read(&card.keyword, name)), place);
                    }
                }
                Some(known) if known.support == Support::Ignored => {
                    if !known.remark.is_empty() {
                        let text = format!("*{} is left out: {}", known.name, known.remark);
                        all.add(note(text), place);
                    }
                }
                Some(known) => {
                    let text = format!("*{} is not supported: {}", known.name, known.remark);
                    all.add(
                        Diagnostic::error(&codes::NOT_BUILT, text).at(place, ""),
                        place,
                    );
                }
                None => {
                    all.add(unknown_keyword(card, self.compat), place);
                }
            }
        }
        all.report(&mut self.found);
    }

    pub fn error(
        &mut self,
        code: &'static Code,
        message: impl Into<String>,
        place: &Place,
        remark: impl Into<String>,
    ) {
        let one = Diagnostic::error(code, message).at(place, remark);
        self.found.push(one);
    }

    pub fn warn(&mut self, message: impl Into<String>, place: &Place, remark: impl Into<String>) {
        let one = Diagnostic::warning(&codes::UNUSUAL, message).at(place, remark);
        self.found.push(one);
    }

    /// Notes that something is left out.
    pub fn note(&mut self, text: impl Into<String>, place: &Place) {
        let note = Diagnostic::new(Severity::Note, &codes::NO_EFFECT, text.into());
        self.found.push(note.at(place, ""));
    }

    /// The value of a parameter that must be there.
    pub fn need<'s>(&mut self, card: &'s Statement, parameter: &str) -> Option<&'s str> {
        let value = card.get(parameter).filter(|value| !value.is_empty());
        if value.is_none() {
            let parameter = spelled(&card.keyword, parameter);
            let text = format!("*{} has no {parameter}", card.title);
            self.error(&codes::MISSING, text, &card.place, "");
        }
        value
    }

    /// The number that a parameter has; none where it is not there, or is no number, which is reported.
    pub fn parameter(&mut self, card: &Statement, parameter: &str, shown: &str) -> Option<f64> {
        let text = card.get(parameter)?;
        let found = number(text);
        if found.is_none() {
            let text = format!("{shown} is no number");
            self.error(&codes::NOT_A_NUMBER, text, &card.place, "");
        }
        if let Some(value) = found {
            self.judge_size(value, text, &card.place);
        }
        found
    }

    /// A number in a field; zero where the field is empty.
    pub fn real(&mut self, field: Option<&Field<'_>>) -> f64 {
        let Some(field) = field.filter(|field| !field.text.is_empty()) else {
            return 0.0;
        };
        let Some(value) = field.real() else {
            self.not_a_number(field, "a number");
            return 0.0;
        };
        self.judge_size(value, field.text, &field.place());
        value
    }

    /// Refuses a number that has lost digits because it is so small.
    fn judge_size(&mut self, value: f64, text: &str, place: &Place) {
        if value != 0.0 && !value.is_normal() {
            let shown: String = text.chars().take(40).collect();
            let text = format!("`{shown}` is no number to compute with");
            self.error(&codes::NOT_FINITE, text, place, "too small: below 2.3e-308");
        }
    }

    /// Refuses numbers below zero.
    pub fn not_negative(&mut self, card: &Statement, row: &[Field<'_>]) {
        for field in row {
            if let Some(value) = field.real().filter(|value| *value < 0.0) {
                let text = format!("{value} in *{} is negative", card.title);
                self.error(&codes::OUT_OF_RANGE, text, &field.place(), "zero or more");
            }
        }
    }

    /// A whole number in a field; `default` where the field is empty.
    pub fn count(&mut self, field: Option<&Field<'_>>, default: u64) -> u64 {
        let Some(field) = field.filter(|field| !field.text.is_empty()) else {
            return default;
        };
        field.whole().unwrap_or_else(|| {
            self.not_a_number(field, "a whole number");
            default
        })
    }

    fn not_a_number(&mut self, field: &Field<'_>, wanted: &str) {
        let shown: String = field.text.chars().take(40).collect();
        let text = format!("`{shown}` stands where {wanted} should");
        self.error(&codes::NOT_A_NUMBER, text, &field.place(), "");
    }

    /// As many numbers as there are fields, `N` at most; zero for those that are not there.
    pub fn reals<const N: usize>(&mut self, fields: &[Field<'_>]) -> [f64; N] {
        std::array::from_fn(|i| self.real(fields.get(i)))
    }

    /// Refuses names that two cards of a keyword give to different things: other programs take the first without a word.
    pub fn named_twice(&mut self, keyword: &'static str) {
        let mut first: BTreeMap<(usize, String), &Statement> = BTreeMap::new();
        for card in self.cards(keyword) {
            let Some(name) = card.peek("NAME").filter(|name| !name.is_empty()) else {
                continue;
            };
            let Some(known) = first.get(&(card.scope, compared(name))) else {
                first.insert((card.scope, compared(name)), card);
                continue;
            };
            let shown: String = name.chars().take(80).collect();
            let called = Keyword::of(keyword).map_or(keyword, |known| known.name);
            let text = format!("*{called} `{shown}` is defined twice");
            let twice = Diagnostic::error(&codes::NAME_TWICE, text)
                .at(&card.place, "a second time here")
                .at(&known.place, "first here")
                .help("remove one of them, or give it another name");
            self.found.push(twice);
        }
    }

    /// What a field names, in all spaces that the card speaks of.
    pub fn targets(
        &mut self,
        card: &Statement,
        field: Option<&Field<'_>>,
        kind: Kind,
    ) -> Vec<Target> {
        let Some(field) = field.filter(|field| !field.text.is_empty()) else {
            let text = format!("a line of *{} names nothing", card.title);
            self.error(&codes::MISSING, text, &card.place, "");
            return Vec::new();
        };
        let directory = &self.deck.directory;
        let mut targets = Vec::new();
        for &space in directory.spaces(card.scope) {
            if let Some(label) = directory.label(space, kind, field.text) {
                let known = match kind {
                    Kind::Nodes => self.nodes.find(label).is_some(),
                    _ => self.elements.find(label).is_some(),
                };
                if known {
                    targets.push(Target::One(label));
                }
            } else if let Some(name) = directory.set(space, kind, field.text) {
                targets.push(Target::Set(name.to_owned()));
            }
        }
        if targets.is_empty() {
            self.unknown(card, field, kind);
        }
        targets
    }

    /// The set that a parameter or field names, where it stands for one thing.
    pub fn set(&mut self, card: &Statement, name: &str, place: &Place, kind: Kind) -> Option<Name> {
        let found = self.set_if(card, name, place, kind);
        if found.is_none() {
            self.undefined(card, name, place, kind);
        }
        found
    }

    /// The same, where there may be none.
    pub fn set_if(&self, card: &Statement, name: &str, place: &Place, kind: Kind) -> Option<Name> {
        let directory = &self.deck.directory;
        let mut spaces = directory.spaces(card.scope).iter();
        let found = spaces.find_map(|&space| directory.set(space, kind, name))?;
        Some(Spanned::new(found.to_owned(), place.clone()))
    }

    fn unknown(&mut self, card: &Statement, field: &Field<'_>, kind: Kind) {
        if field.whole().is_some() {
            let what = if kind == Kind::Nodes {
                "node"
            } else {
                "element"
            };
            let text = format!("there is no {what} {} in the mesh", field.text);
            self.error(&codes::NOT_IN_MESH, text, &field.place(), "");
        } else {
            self.undefined(card, field.text, &field.place(), kind);
        }
    }

    fn undefined(&mut self, card: &Statement, name: &str, place: &Place, kind: Kind) {
        let what = match kind {
            Kind::Nodes => "node set",
            Kind::Elements => "element set",
            Kind::Surface => "surface",
            Kind::SurfaceOfNodes => "surface of nodes",
        };
        let directory = &self.deck.directory;
        let spaces = directory.spaces(card.scope).iter();
        let known: Vec<&str> = spaces
            .flat_map(|&space| directory.known(space, kind))
            .collect();
        let shown: String = name.chars().take(80).collect();
        let meant = closest(&shown, known.iter().copied());
        let remark = meant.map_or(String::new(), |meant| format!("did you mean {meant}?"));
        let mut one =
            Diagnostic::error(&codes::NOT_IN_MESH, format!("there is no {what} `{shown}`"))
                .at(place, remark);
        if !known.is_empty() {
            one = one.note(format!("{what}s: {}", listed(known.into_iter().take(20))));
        }
        self.found.push(one);
    }

    /// The numbers of the nodes of a target, in order.
    pub fn labels(&self, target: &Target) -> Vec<u64> {
        match target {
            Target::One(label) => vec![*label],
            Target::Set(name) => {
                let mesh = &self.deck.mesh;
                let nodes = mesh
                    .sets
                    .get(name)
                    .map(|set| shell::nodes_of(self.deck, set));
                let nodes = nodes.unwrap_or_default().into_iter();
                nodes
                    .filter_map(|node| mesh.node_labels.get(node as usize).copied())
                    .collect()
            }
        }
    }

    /// The numbers of the elements of a target, in order.
    pub fn elements(&self, target: &Target) -> Vec<u64> {
        match target {
            Target::One(label) => vec![*label],
            Target::Set(name) => {
                let mesh = &self.deck.mesh;
                let cells = mesh.sets.get(name).map_or(&[][..], |set| &set.cells);
                cells
                    .iter()
                    .filter_map(|&cell| mesh.cell_label(cell))
                    .collect()
            }
        }
    }

    /// Where a node is.
    pub fn point(&self, label: u64) -> Option<Vec3> {
        let node = self.nodes.find(label)?;
        self.deck.mesh.points.get(node as usize).copied()
    }

    /// The element of this number.
    pub fn cell(&self, label: u64) -> Option<CellId> {
        let at = self.elements.find(label)?;
        self.cells.get(at as usize).copied()
    }

    /// The type of a cell as the deck calls it.
    pub fn type_of(&self, cell: CellId) -> &'d str {
        let (names, types) = self.deck.directory.types();
        let number = types
            .get(cell.block as usize)
            .and_then(|t| t.get(cell.index as usize));
        let name = number.and_then(|&number| names.get(number as usize));
        name.map_or("", String::as_str)
    }

    /// The types of elements in use, each with the number of its elements.
    pub fn used_types(&self) -> Vec<(&'d str, usize)> {
        let (names, types) = self.deck.directory.types();
        let mut counts = vec![0; names.len()];
        for &number in types.iter().flatten() {
            if let Some(count) = counts.get_mut(number as usize) {
                *count += 1;
            }
        }
        let all = names.iter().map(String::as_str).zip(counts);
        all.filter(|(_, count)| *count > 0).collect()
    }

    /// The cells that have faces: of the highest dimension, and solids only next to shells.
    pub fn solids(&self) -> impl Iterator<Item = CellId> + use<'d> {
        let mesh = &self.deck.mesh;
        match self.shell_nodes.is_empty() {
            true => mesh.cells(mesh.dim()),
            false => mesh.cells(3),
        }
    }

    pub fn ndim(&self) -> usize {
        self.case.model.space.value.ndim()
    }

    /// A name that nothing has: `wanted`, or with a number behind.
    pub fn fresh(&mut self, wanted: &str) -> String {
        self.names.fresh(wanted)
    }

    /// The name of all these targets together.
    pub fn named(&mut self, targets: &[Target], place: &Place) -> Name {
        if let [Target::Set(name)] = targets {
            return Spanned::new(name.clone(), place.clone());
        }
        let mut labels: Vec<u64> = targets
            .iter()
            .flat_map(|target| self.labels(target))
            .collect();
        labels.sort_unstable();
        labels.dedup();
        self.nodes_named(labels, place)
    }

    /// The name of a set of these nodes.
    pub fn nodes_named(&mut self, labels: Vec<u64>, place: &Place) -> Name {
        if let Some(name) = self.sets.get(&labels) {
            return Spanned::new(name.clone(), place.clone());
        }
        let name = match labels.as_slice() {
            [one] => self.fresh(&format!("node-{one}")),
            _ => self.fresh("nodes"),
        };
        self.sets.insert(labels.clone(), name.clone());
        self.add_set(name, SetContent::Nodes(labels), place)
    }

    /// The name of a set of sides of elements.
    pub fn sides_named(&mut self, sides: Vec<(u64, u8)>, place: &Place) -> Name {
        let name = self.fresh("sides");
        let sides = sides.into_iter();
        let content = sides.map(|(element, side)| (element, Side::Numbered(side)));
        self.add_set(name, SetContent::Faces(content.collect()), place)
    }

    /// The name of a set of elements.
    pub fn elements_named(&mut self, elements: Vec<u64>, place: &Place) -> Name {
        let name = self.fresh("elements");
        self.add_set(name, SetContent::Elements(elements), place)
    }

    fn add_set(&mut self, name: String, content: SetContent, place: &Place) -> Name {
        let name = Spanned::new(name, place.clone());
        self.case.sets.push(Set {
            name: name.clone(),
            content,
            place: place.clone(),
        });
        name
    }
}
