//! Sections, amplitudes, initial conditions.

use super::Compat;
use super::translation::{Target, Translation, is_truss};
use crate::case::{
    Amplitude, AtNodes, AtPoint, Body, BodyAxes, Factor, Integration, Locking, MaterialChange,
    Model, Name, SetContent, Space, Step, TemperatureAt, Temperatures, Thickness, TimeBase,
    Unstrained,
};
use crate::diagnostic::{Diagnostic, Place, Spanned, codes};
use crate::readers::inp::{Field, Kind, Statement, compared, spelled, without_volume};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Elements whose integration points are numbered as ours are.
const POINTWISE: [&str; 5] = ["C3D4", "C3D8", "C3D8I", "C3D20", "C3D20R"];

/// A section of elements.
pub(super) struct Section<'s> {
    card: &'s Statement,
    material: &'s str,
    orientation: Option<&'s BodyAxes>,
    thickness: Option<&'s Spanned<Thickness>>,
    /// The set of its elements, if all of this set are.
    set: Option<String>,
}

impl<'s> Section<'s> {
    /// One that says nothing but its material.
    pub const fn bare(card: &'s Statement, material: &'s str) -> Self {
        Self {
            card,
            material,
            orientation: None,
            thickness: None,
            set: None,
        }
    }

    /// A body of its material, everything else as it is by default.
    pub fn made_of(&self, group: Name) -> Body {
        let place = &self.card.place;
        Body {
            groups: vec![group],
            material: Some(Spanned::new(self.material.to_owned(), place.clone())),
            integration: Integration::Full,
            locking: Spanned::new(Locking::Auto, place.clone()),
            orientation: None,
            space: None,
            at_nodes: AtNodes::Linear,
            thickness: None,
            shell: None,
            temperatures: Temperatures::Full,
            area: None,
            small_strain: false,
            mass_matrix: Default::default(),
            lumped_capacity: false,
            rigid: false,
            reference: None,
            place: place.clone(),
        }
    }
}

impl Translation<'_> {
    pub fn model(&mut self) {
        self.title();
        self.space();
        self.physical_constants();
        self.materials();
        self.start_temperature();
        self.at_start();
        self.velocities();
        self.amplitudes();
        self.sections();
    }

    fn title(&mut self) {
        let Some(card) = self.cards("HEADING").next() else {
            return;
        };
        let title = card.lines().next().unwrap_or_default();
        self.case.title = title
            .chars()
            .filter(|c| !c.is_control())
            .take(200)
            .collect();
    }

    /// Dimension of the model, by the types of its elements.
    fn space(&mut self) {
        let dim = self.deck.mesh.dim();
        let used = self.used_types();
        let of = |letters: &str| used.iter().any(|(name, _)| name.starts_with(letters));
        if dim == 2 && ["CPE", "CPS", "CAX"].into_iter().any(of) {
            self.judge_plane();
        }
        let is_shell = |kind: &str| without_volume(kind) == Some("shell");
        let of_shells = || used.iter().find(|(kind, _)| is_shell(kind));
        let space = match dim {
            0 | 3 => Space::ThreeD,
            2 if of_shells().is_some() => Space::ThreeD,
            1 if !of("T2D") => Space::ThreeD,
            _ if of("CAX") || of("DCAX") => Space::Axisymmetric,
            _ if of("CPS") || of("DC2D") => Space::PlaneStress,
            _ => Space::PlaneStrain,
        };
        let of_plane = |(kind, _): &&(&str, usize)| {
            let families = ["CPE", "CPS", "CAX", "DC2D", "DCAX"];
            families.iter().any(|family| kind.starts_with(family))
        };
        if let (2, Some((shell, _)), Some((plane, _))) =
            (dim, of_shells(), used.iter().find(of_plane))
        {
            let text = format!(
                "shells ({shell}) and elements of the plane ({plane}) in one deck are not supported"
            );
            let one = Diagnostic::error(&codes::NOT_BUILT, text);
            let help = "mesh the parts of the plane with shells or solids, too";
            self.found.push(one.help(help));
        }
        if space == Space::Axisymmetric && of("CPE") {
            self.error(
                &codes::CONTRADICTION,
                "elements of plane strain and axisymmetry in one deck",
                &Place::nowhere(),
                "a slice that cannot stretch across its plane is no part of a ring",
            );
        }
        self.case.model = Model {
            space: space.into(),
            thickness: 1.0,
        };
    }

    /// Stress and strain at integration points.
    fn at_start(&mut self) {
        for card in self.cards("INITIALCONDITIONS") {
            let kind = card.get("TYPE").map(compared).unwrap_or_default();
            if kind == "TEMPERATURE" || kind == "VELOCITY" {
                continue;
            }
            let is_stress = kind == "STRESS";
            if !is_stress && kind != "PLASTICSTRAIN" || card.has("USER") {
                let user = if card.has("USER") { ", USER" } else { "" };
                let text = format!("*INITIAL CONDITIONS, TYPE={kind}{user} is not supported");
                self.error(&codes::NOT_BUILT, text, &card.place, "");
                continue;
            }
            if !is_stress && self.case.materials.iter().any(|m| m.plasticity.is_some()) {
                let text = "an initial plastic strain does not go with *PLASTIC";
                let remark = "its hardening is not known";
                self.error(&codes::NOT_BUILT, text, &card.place, remark);
            }
            for row in card.rows().filter(|row| !row.is_empty()) {
                let targets = self.targets(card, row.first(), Kind::Elements);
                let point = self.count(row.get(1), 1);
                let value: [f64; 6] = self.reals(row.get(2..).unwrap_or_default());
                let place = row.first().map_or(card.place.clone(), Field::place);
                let elements = targets.iter().flat_map(|target| self.elements(target));
                for element in elements.collect::<Vec<_>>() {
                    let kind = self.cell(element).map(|cell| self.type_of(cell));
                    if !kind.is_some_and(|kind| POINTWISE.contains(&kind)) {
                        let text = "values at the points of this element are not supported";
                        let remark = format!("of {} they are", POINTWISE.join(", "));
                        self.error(&codes::NOT_BUILT, text, &place, remark);
                        break;
                    }
                    let points = if is_stress {
                        &mut self.case.initial_stress
                    } else {
                        &mut self.case.initial_strain
                    };
                    points.push(AtPoint {
                        element,
                        point,
                        value,
                        place: place.clone(),
                    });
                }
            }
        }
    }

    fn start_temperature(&mut self) {
        let mut found: Vec<TemperatureAt> = Vec::new();
        for card in self.cards("INITIALCONDITIONS") {
            let kind = card.get("TYPE").map(compared).unwrap_or_default();
            if kind != "TEMPERATURE" {
                continue;
            }
            for row in card.rows() {
                let targets = self.targets(card, row.first(), Kind::Nodes);
                let temperature = self.real(row.get(1));
                let gradient = self.gradient(&row, &targets);
                if !targets.is_empty() {
                    found.push(TemperatureAt {
                        on: self.named(&targets, &card.place),
                        temperature,
                        gradient,
                        place: card.place.clone(),
                    });
                }
            }
        }
        let Some(first) = found.first().cloned() else {
            return;
        };
        let alike = found.iter().all(|one| one.temperature == first.temperature);
        let even = found.iter().all(|one| one.gradient.is_none());
        // what no line names is at zero once lines differ; CalculiX leaves it without a value
        let (everywhere, free) = match (alike, even) {
            (true, true) => (first.temperature, Unstrained::At(first.temperature)),
            (true, false) => (first.temperature, Unstrained::AtStart),
            (false, _) => (0.0, Unstrained::AtStart),
        };
        self.case.initial_temperature = Some(Spanned::new(everywhere, first.place));
        if !(alike && even) {
            self.case.initial_temperatures = found;
        }
        // thermal strain counts from the start, at which there is none
        for material in &mut self.case.materials {
            if let Some(expansion) = &mut material.expansion {
                expansion.free.value = free;
            }
        }
    }

    /// Amplitudes, which may stand in a step, too.
    fn amplitudes(&mut self) {
        let cards = self.deck.statements.iter();
        for card in cards.filter(|card| card.keyword == "AMPLITUDE") {
            let Some(name) = self.need(card, "NAME") else {
                continue;
            };
            let total = card.get("TIME").map(compared);
            let amplitude = Amplitude {
                name: Spanned::new(name.to_owned(), card.place.clone()),
                factor: Factor::Table(self.table_of_amplitude(card)),
                time: if total.is_some_and(|time| time.starts_with("TOTAL")) {
                    TimeBase::Total
                } else {
                    TimeBase::Step
                },
            };
            if !self.is_defined(&amplitude) {
                let number = self.case.amplitudes.len();
                self.amplitudes.insert(compared(name), number);
                self.case.amplitudes.push(amplitude);
            }
        }
    }

    /// Times and values, those of SHIFTX and SHIFTY added.
    fn table_of_amplitude(&mut self, card: &Statement) -> Vec<[f64; 2]> {
        if card.has("USER") {
            let text = "*AMPLITUDE, USER is not supported";
            let remark = "it is a subroutine, which the deck does not contain: write its values";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
            return Vec::new();
        }
        for (word, known) in [("DEFINITION", "TABULAR"), ("VALUE", "RELATIVE")] {
            let given = card.get(word).map(compared);
            if let Some(given) = given.filter(|given| given != known) {
                let text = format!("*AMPLITUDE, {word}={given} is not supported");
                self.error(&codes::NOT_BUILT, text, &card.place, known);
            }
        }
        let shifts = ["SHIFTX", "SHIFTY"];
        let [later, more] = shifts.map(|name| self.parameter(card, name, name).unwrap_or(0.0));
        let fields: Vec<_> = card.rows().flatten().collect();
        self.pairs_of_amplitude(card, &fields);
        let pairs = fields.chunks(2).map(|pair| self.reals(pair));
        let table: Vec<[f64; 2]> = pairs.map(|[t, a]| [t + later, a + more]).collect();
        let increase = |pair: &[[f64; 2]]| matches!(pair, [a, b] if b[0] > a[0]);
        if !table.windows(2).all(increase) {
            let text = "times of *AMPLITUDE do not increase";
            self.error(&codes::NOT_INCREASING, text, &card.place, "");
        }
        table
    }

    /// Refuses a table of no pairs, or with half a pair at its end.
    fn pairs_of_amplitude(&mut self, card: &Statement, fields: &[Field<'_>]) {
        let words = ("time and value, pair by pair", "");
        match fields.chunks(2).last() {
            Some(last) if last.len() == 2 => {}
            Some(last) => self.values_of(card, last, (2, 2), words),
            None => {
                let text = "*AMPLITUDE has no data line";
                self.error(&codes::MISSING, text, &card.place, words.0);
            }
        }
    }

    /// Whether there is an amplitude of this name, which has to be the same.
    fn is_defined(&mut self, again: &Amplitude) -> bool {
        let known = self.amplitudes.get(&compared(&again.name));
        let Some(first) = known.and_then(|&number| self.case.amplitudes.get(number)) else {
            return false;
        };
        if first.factor != again.factor || first.time != again.time {
            let text = format!("amplitude `{}` is defined twice", again.name.value);
            let twice = Diagnostic::error(&codes::NAME_TWICE, text)
                .at(&again.name.place, "differently here")
                .at(
                    &first.name.place,
                    "first here: CalculiX would take this one",
                )
                .help("remove one of them, or give it another name");
            self.found.push(twice);
        }
        true
    }

    /// The name of an amplitude as the case has it.
    pub fn amplitude(&mut self, card: &Statement) -> Option<Name> {
        self.amplitude_by(card, "AMPLITUDE", "TIMEDELAY")
    }

    /// The amplitude that a parameter of a card names, later by another parameter.
    pub fn amplitude_by(&mut self, card: &Statement, name: &str, delay: &str) -> Option<Name> {
        let wanted = card.get(name)?;
        let known = self.amplitudes.get(&compared(wanted));
        let known = known.and_then(|&number| self.case.amplitudes.get(number));
        match known.map(|one| one.name.value.clone()) {
            Some(name) => {
                let name = self.delayed(card, name, delay);
                Some(Spanned::new(name, card.place.clone()))
            }
            None => {
                let text = format!("there is no amplitude `{wanted}`");
                self.error(&codes::UNDEFINED, text, &card.place, "");
                None
            }
        }
    }

    /// The amplitude that is this one later, where a card has a time of delay.
    fn delayed(&mut self, card: &Statement, name: String, delay: &str) -> String {
        let shown = spelled(&card.keyword, delay);
        let Some(delay) = self.parameter(card, delay, shown) else {
            return name;
        };
        let mut all = self.case.amplitudes.iter();
        let Some(known) = all.find(|one| *one.name == name).cloned() else {
            return name;
        };
        let Factor::Table(rows) = &known.factor else {
            return name;
        };
        let rows = rows.iter().map(|[t, a]| [t + delay, *a]);
        let factor = Factor::Table(rows.collect());
        let mut all = self.case.amplitudes.iter();
        let same = |one: &&Amplitude| one.factor == factor && one.time == known.time;
        if let Some(same) = all.find(same) {
            return same.name.value.clone();
        }
        let name = self.fresh(&format!("{name}-delayed"));
        self.case.amplitudes.push(Amplitude {
            name: Spanned::new(name.clone(), card.place.clone()),
            factor,
            ..known
        });
        name
    }

    fn sections(&mut self) {
        let orientations = self.orientations();
        let mut thickness: Option<f64> = None;
        let last = self.last_sections("SOLIDSECTION");
        for (number, card) in self.cards("SOLIDSECTION").enumerate() {
            let (elset, material) = (self.need(card, "ELSET"), self.need(card, "MATERIAL"));
            let (Some(elset), Some(material)) = (elset, material) else {
                continue;
            };
            let Some(material) = self.material_of(card, material) else {
                continue;
            };
            let orientation = card.get("ORIENTATION").map(compared);
            let orientation = orientation.and_then(|name| match orientations.get(&name) {
                Some(found) => found.clone(),
                None => {
                    let text = format!("there is no orientation `{name}`");
                    self.error(&codes::UNDEFINED, text, &card.place, "");
                    None
                }
            });
            let row = card.rows().next().filter(|row| !row.is_empty());
            let given = row.map(|row| {
                let place = row.first().map_or(card.place.clone(), Field::place);
                Spanned::new(self.real(row.first()), place)
            });
            if let Some(given) = given.as_ref().filter(|given| given.value < 0.0) {
                let text = format!("the thickness of *SOLID SECTION is {}", given.value);
                self.error(&codes::OUT_OF_RANGE, text, &given.place, "positive");
            }
            let sets = self.sets_of(card, elset);
            if sets.is_empty() {
                self.set(card, elset, &card.place, Kind::Elements);
            }
            if !self.makes_solids(card, &sets) {
                continue;
            }
            let trusses = sets.iter().any(|set| self.has_trusses(set));
            let at_nodes = card.get("NODALTHICKNESS").is_some();
            if self.case.model.space.value.has_thickness()
                && !trusses
                && let Some(given) = &given
                && !at_nodes
            {
                self.case.model.thickness = *thickness.get_or_insert(given.value);
            }
            let given = match at_nodes {
                true => Some(Spanned::new(Thickness::Field, card.place.clone())),
                false => {
                    given.map(|given| Spanned::new(Thickness::Uniform(given.value), given.place))
                }
            };
            for set in sets {
                let all = self.elements(&Target::Set(set.clone()));
                let nall = all.len();
                let is_own = |label: &u64| last.get(label).is_none_or(|last| *last == number);
                let mut section = Section {
                    card,
                    material: &material,
                    orientation: orientation.as_ref(),
                    thickness: given.as_ref(),
                    set: Some(set),
                };
                let own: Vec<u64> = all.into_iter().filter(is_own).collect();
                if own.len() < nall {
                    let nelsewhere = nall - own.len();
                    let text = format!(
                        "{nelsewhere} elements of `{elset}` have a later *SOLID SECTION, which holds"
                    );
                    self.note(text, &card.place);
                    section.set = None;
                }
                match trusses {
                    true => self.bars(&section, own),
                    false => self.body(&section, own),
                }
            }
        }
        self.shells();
        for card in self.cards("MEMBRANE") {
            self.membrane(card);
        }
        self.nodal_thickness();
    }

    /// The name of the material of a section; nothing where it is none of a solid, which is reported.
    pub fn material_of(&mut self, card: &Statement, material: &str) -> Option<String> {
        let Some(known) = self.materials.get(&compared(material)) else {
            let text = format!("there is no material `{material}`");
            self.error(&codes::UNDEFINED, text, &card.place, "");
            return None;
        };
        let material = known.name.value.clone();
        if !known.has_law() && known.is_refused() {
            return None;
        }
        let conducts_alone = known.heat.conducts() && self.is_all_heat();
        if !known.has_law() && !conducts_alone {
            let text = format!("material `{material}` has no elastic constants");
            let one = Diagnostic::error(&codes::MISSING, text)
                .at(&card.place, "it is used here")
                .at(&known.name.place, "and defined here")
                .help("write *ELASTIC below *MATERIAL, with E and nu in the next line");
            self.found.push(one);
            return None;
        }
        Some(material)
    }

    /// The number of the last section of each element, if there are several of this keyword.
    pub fn last_sections(&self, keyword: &'static str) -> HashMap<u64, usize> {
        let mut last = HashMap::new();
        let cards: Vec<&Statement> = self.cards(keyword).collect();
        if cards.len() < 2 {
            return last;
        }
        for (number, card) in cards.into_iter().enumerate() {
            for set in card
                .get("ELSET")
                .map_or_else(Vec::new, |name| self.sets_of(card, name))
            {
                let elements = self.elements(&Target::Set(set));
                last.extend(elements.into_iter().map(|label| (label, number)));
            }
        }
        last
    }

    /// The sets of elements that a name stands for where a card is.
    pub fn sets_of(&self, card: &Statement, name: &str) -> Vec<String> {
        let directory = &self.deck.directory;
        (directory.spaces(card.scope).iter())
            .filter_map(|&space| directory.set(space, Kind::Elements, name))
            .map(str::to_owned)
            .collect()
    }

    /// Whether a set of elements has trusses.
    fn has_trusses(&self, set: &str) -> bool {
        let (kinds, _) = self.deck.directory.types();
        if !kinds.iter().any(|kind| is_truss(kind)) {
            return false;
        }
        let elements = self.elements(&Target::Set(set.to_owned()));
        let mut cells = elements.into_iter().filter_map(|label| self.cell(label));
        cells.any(|cell| is_truss(self.type_of(cell)))
    }

    /// The body of a section of trusses.
    fn bars(&mut self, section: &Section<'_>, elements: Vec<u64>) {
        let place = &section.card.place;
        let is_truss = |label: &u64| {
            let cell = self.cell(*label);
            cell.is_some_and(|cell| is_truss(self.type_of(cell)))
        };
        if !elements.iter().all(is_truss) {
            let text = "trusses and solids in one *SOLID SECTION";
            let remark = "a section for each";
            self.error(&codes::NOT_BUILT, text, place, remark);
            return;
        }
        let row = section.card.rows().next().unwrap_or_default();
        let area = self.real(row.first());
        if area <= 0.0 {
            let text = "*SOLID SECTION of trusses has no cross-section";
            let remark = "a positive area, in the line below";
            self.error(&codes::OUT_OF_RANGE, text, place, remark);
            return;
        }
        let group = match &section.set {
            Some(set) => Spanned::new(set.clone(), place.clone()),
            None => self.elements_named(elements, place),
        };
        self.case.bodies.push(Body {
            area: Some(Spanned::new(area, place.clone())),
            ..section.made_of(group)
        });
    }

    /// *CHANGE SOLID SECTION within a step: bodies whose elements are all in the set get another material.
    pub fn change_section(&mut self, card: &Statement, step: &mut Step) {
        let (elset, material) = (self.need(card, "ELSET"), self.need(card, "MATERIAL"));
        let (Some(elset), Some(material)) = (elset, material) else {
            return;
        };
        if card.has("ORIENTATION") {
            let text = "*CHANGE SOLID SECTION, ORIENTATION is not supported";
            self.error(
                &codes::NOT_BUILT,
                text,
                &card.place,
                "a material may change",
            );
        }
        let Some(known) = self.materials.get(&compared(material)) else {
            let text = format!("there is no material `{material}`");
            self.error(&codes::UNDEFINED, text, &card.place, "");
            return;
        };
        let material = Spanned::new(known.name.value.clone(), card.place.clone());
        if self.set(card, elset, &card.place, Kind::Elements).is_none() {
            return;
        }
        let sets = self.sets_of(card, elset);
        let named = sets
            .iter()
            .flat_map(|set| self.elements(&Target::Set(set.clone())));
        let named: HashSet<u64> = named.collect();
        let groups = self.case.bodies.iter().flat_map(|body| &body.groups);
        let mut changed = 0;
        for group in groups {
            let own = self.elements_of(group);
            let inside = own.iter().filter(|label| named.contains(label)).count();
            if inside > 0 && inside == own.len() {
                changed += inside;
                step.materials.push(MaterialChange {
                    group: group.clone(),
                    material: material.clone(),
                    place: card.place.clone(),
                });
            }
        }
        if changed < named.len() {
            let text = "*CHANGE SOLID SECTION of a part of a section is not supported";
            let remark = "give this part a *SOLID SECTION of its own";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
    }

    /// The elements of a group, which is a set of the mesh or of the case.
    fn elements_of(&self, group: &Name) -> Vec<u64> {
        let mut sets = self.case.sets.iter();
        match sets
            .find(|set| set.name.value == group.value)
            .map(|set| &set.content)
        {
            Some(SetContent::Elements(elements)) => elements.clone(),
            _ => self.elements(&Target::Set(group.value.clone())),
        }
    }

    /// A card that CalculiX does not know; of no elements, it does no harm.
    fn membrane(&mut self, card: &Statement) {
        let name = card.get("ELSET").unwrap_or_default();
        if self.sets_of(card, name).is_empty() {
            let text = "*MEMBRANE is left out: it speaks of no elements";
            self.note(text, &card.place);
        } else {
            let text = "*MEMBRANE is not supported: membranes are not built";
            self.error(&codes::NOT_BUILT, text, &card.place, "");
        }
    }

    /// The bodies of a section: one, or one for each way its elements are integrated.
    fn body(&mut self, section: &Section<'_>, elements: Vec<u64>) {
        let place = &section.card.place;
        let mut ways: BTreeMap<(bool, bool, bool, bool, Space), Vec<u64>> = BTreeMap::new();
        for label in elements {
            let Some(cell) = self.cell(label) else {
                continue;
            };
            let kind = self.type_of(cell);
            let digits = kind.trim_start_matches(|c: char| c.is_ascii_uppercase());
            let reduced = kind.ends_with('R') || kind.ends_with("RH") || kind.ends_with("RT");
            let linear = ["C3D8", "CPS4", "CPE4", "CAX4"]
                .iter()
                .any(|l| kind.starts_with(l));
            let modes = linear && digits.contains('I');
            // CalculiX' temperatures in elements of 27 points
            let quadratic = ["C3D20", "CPS8", "CPE8", "CAX8"]
                .iter()
                .any(|l| kind.starts_with(l));
            let even = quadratic && !reduced;
            let space = self.plane(kind);
            ways.entry((reduced, modes, linear, even, space))
                .or_default()
                .push(label);
        }
        let several = ways.len() > 1;
        for ((reduced, modes, linear, even, space), elements) in ways {
            let group = match &section.set {
                Some(set) if !several => Spanned::new(set.clone(), place.clone()),
                _ => self.elements_named(elements, place),
            };
            self.case.bodies.push(Body {
                integration: if reduced && !linear {
                    Integration::Reduced
                } else {
                    Integration::Full
                },
                locking: Spanned::new(locking(reduced, modes, linear), place.clone()),
                orientation: section.orientation.cloned(),
                space: (space != *self.case.model.space)
                    .then(|| Spanned::new(space, place.clone())),
                thickness: self.thickness(space, section),
                temperatures: if even {
                    Temperatures::Linear
                } else {
                    Temperatures::Full
                },
                at_nodes: match self.compat {
                    Compat::None | Compat::Oofem => AtNodes::Linear,
                    Compat::Ccx => AtNodes::Element,
                },
                ..section.made_of(group)
            });
        }
    }

    /// What the plane of an element of this type stands for.
    fn plane(&self, kind: &str) -> Space {
        let of_model = *self.case.model.space;
        match kind.get(..3) {
            Some("CAX") if of_model.ndim() == 2 => Space::Axisymmetric,
            Some("CPS") if of_model.ndim() == 2 => Space::PlaneStress,
            Some("CPE") if of_model.ndim() == 2 => Space::PlaneStrain,
            _ => of_model,
        }
    }

    /// The thickness of a section, where it is not that of the model.
    fn thickness(&self, space: Space, section: &Section<'_>) -> Option<Spanned<Thickness>> {
        let model = &self.case.model;
        if !space.has_thickness() {
            return None;
        }
        let given = section.thickness.cloned();
        if model.space.has_thickness() {
            let of_model = Thickness::Uniform(model.thickness);
            return given.filter(|given| given.value != of_model);
        }
        let one = || Spanned::new(Thickness::Uniform(1.0), section.card.place.clone());
        Some(given.unwrap_or_else(one))
    }
}

/// What is done against locking, as the type of the element says: `C3D8I` has incompatible modes, `C3D8R` is not built
/// with one point and takes what suits it best.
const fn locking(reduced: bool, modes: bool, linear: bool) -> Locking {
    match (modes, reduced && linear) {
        (true, _) => Locking::Incompatible,
        (_, true) => Locking::Auto,
        _ => Locking::None,
    }
}
