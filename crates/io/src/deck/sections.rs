//! Elements that have no section, or one that is not theirs; nodes that leave the plane of their elements.

use super::translation::{Target, Translation, is_truss};
use crate::case::ThicknessAt;
use crate::diagnostic::{Diagnostic, Place, codes};
use crate::readers::inp::{Field, Kind, Statement, without_volume};
use signorini_geometry::mesh::CellId;
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// Coordinates across a plane may differ by this part of its size: roundings of decimals.
const FLAT: f64 = 1e-9;

/// Elements that are not built.
const STRUCTURES: [&str; 2] = ["membrane", "beam"];

/// Whether some cards are sections of elements that are not built.
pub(super) fn are_structures(cards: &[Statement]) -> bool {
    let refused = ["BEAMSECTION", "BEAMGENERALSECTION", "MEMBRANESECTION"];
    cards
        .iter()
        .any(|card| refused.contains(&card.keyword.as_str()))
}

impl Translation<'_> {
    /// Refuses a deck all of whose elements are beams or membranes: whatever else it says is about these.
    pub fn has_only_structures(&mut self) -> bool {
        let used = self.used_types();
        let word = |kind: &str| without_volume(kind).filter(|word| STRUCTURES.contains(word));
        let are_all = used.iter().all(|(kind, _)| word(kind).is_some());
        let Some(&(kind, _)) = used.first().filter(|_| are_all) else {
            return false;
        };
        let count: usize = used.iter().map(|(_, count)| count).sum();
        let kinds: Vec<&str> = used.iter().map(|(kind, _)| *kind).collect();
        let what = word(kind).unwrap_or("structure");
        let elements = match count {
            1 => "its element is no solid".to_owned(),
            _ => format!("all {count} elements are no solids"),
        };
        let text = format!(
            "{elements} ({}): {what}s are not built yet",
            kinds.join(", ")
        );
        let mut one = Diagnostic::error(&codes::NOT_BUILT, text);
        if let Some((_, card)) = self
            .cells
            .first()
            .and_then(|cell| self.deck.directory.card_of(*cell))
        {
            one = one.at(&card.place, "defined here");
        }
        self.found
            .push(one.help("mesh the part with solids, such as C3D10 or C3D20R"));
        true
    }

    /// Refuses elements that no section gives a material, and no rigid body its motion: without them, and the loads on
    /// them, the model would be another one.
    pub fn elements_without_section(&mut self) {
        let mesh = &self.deck.mesh;
        let mut covered: Vec<CellId> = Vec::new();
        let mut inside = false;
        for card in &self.deck.statements {
            inside |= card.keyword == "STEP";
            let keyword = card.keyword.as_str();
            // sections of elements that are not built are refused by their keyword
            let gives = keyword.ends_with("SECTION") && !keyword.starts_with("CHANGE")
                || ["MEMBRANE", "RIGIDBODY", "FLUIDSECTIONS"].contains(&keyword);
            if inside || !gives {
                continue;
            }
            let Some(name) = card.peek("ELSET") else {
                continue;
            };
            let sets = self.sets_of(card, name).into_iter();
            let cells = sets.filter_map(|set| mesh.sets.get(&set).map(|set| &set.cells));
            covered.extend(cells.flatten());
        }
        covered.sort_unstable();
        let mut bare: BTreeMap<u32, (usize, u64, CellId)> = BTreeMap::new();
        for &cell in &self.cells {
            if covered.binary_search(&cell).is_err()
                && let Some((number, _)) = self.deck.directory.card_of(cell)
            {
                let label = mesh.cell_label(cell).unwrap_or(0);
                let (count, ..) = bare.entry(number).or_insert((0, label, cell));
                *count += 1;
            }
        }
        for (count, label, cell) in bare.into_values() {
            let Some((_, card)) = self.deck.directory.card_of(cell) else {
                continue;
            };
            let of = card.elset.as_ref();
            let of_set = of.map_or(String::new(), |name| format!(" of `{name}`"));
            let text = match count {
                1 => format!("element {label}{of_set} has no section"),
                _ => format!("{count} elements{of_set} have no section, such as {label}"),
            };
            let shown = of.map_or("…", String::as_str);
            let kind = match without_volume(self.type_of(cell)) {
                Some("shell") => "SHELL",
                _ => "SOLID",
            };
            let help = format!("write *{kind} SECTION, ELSET={shown}, MATERIAL=…");
            let one = Diagnostic::error(&codes::MISSING, text);
            let one = one.at(&card.place, "no material is given to what is defined here");
            self.found.push(one.help(help));
        }
    }

    /// Whether all elements that a *SOLID SECTION names are solids of the model, or trusses; if not, that is reported.
    pub fn makes_solids(&mut self, card: &Statement, sets: &[String]) -> bool {
        let mesh = &self.deck.mesh;
        let cells = sets.iter().filter_map(|set| mesh.sets.get(set));
        // found once for each type: there are few, and a million elements
        let mut words: BTreeMap<&str, Option<&str>> = BTreeMap::new();
        let mut strange = cells.flat_map(|set| &set.cells).filter_map(|&cell| {
            let kind = self.type_of(cell);
            let dim = mesh.element(cell).map_or(0, |element| element.dim());
            let is_side = dim < mesh.dim() && !is_truss(kind);
            let word = *words.entry(kind).or_insert_with(|| without_volume(kind));
            let word = word.or(is_side.then_some("in the plane"))?;
            Some((mesh.cell_label(cell).unwrap_or(0), kind, word))
        });
        let Some((label, kind, word)) = strange.next() else {
            return true;
        };
        let more = match strange.count() {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        let text = format!(
            "*SOLID SECTION names element {label}, which is no solid: {kind} ({word}){more}"
        );
        let one = Diagnostic::error(&codes::NOT_BUILT, text).at(&card.place, "");
        self.found.push(one.help(match word {
            "in the plane" => {
                "elements of the plane next to solids are faces of these: give them no section"
            }
            "shell" => "shells take *SHELL SECTION; next to solids, faces of these take no section",
            _ => "membranes and beams are not built: use solids, such as C3D8, or leave the section out",
        }));
        false
    }

    /// Thickness at nodes, which counts only where a section asks for it.
    pub fn nodal_thickness(&mut self) {
        let asking = self.nodes_that_ask();
        for card in self.cards("NODALTHICKNESS") {
            let mut elsewhere: BTreeSet<u64> = BTreeSet::new();
            for row in card.rows().filter(|row| !row.is_empty()) {
                let targets = self.targets(card, row.first(), Kind::Nodes);
                let labels = targets.iter().flat_map(|target| self.labels(target));
                let (counted, others): (Vec<u64>, Vec<u64>) =
                    labels.partition(|label| asking.contains(label));
                elsewhere.extend(others);
                let value = self.real(row.get(1));
                if value < 0.0 || value == 0.0 && !counted.is_empty() {
                    let text = format!("the thickness of *NODAL THICKNESS is {value}");
                    let place = row.get(1).map_or(card.place.clone(), Field::place);
                    self.error(&codes::OUT_OF_RANGE, text, &place, "positive");
                } else if !counted.is_empty() {
                    let on = self.named(&targets, &card.place);
                    self.case.thicknesses.push(ThicknessAt {
                        on,
                        value,
                        place: card.place.clone(),
                    });
                }
            }
            if !elsewhere.is_empty() {
                let text = format!(
                    "*NODAL THICKNESS: given for {} whose section does not ask for it",
                    match elsewhere.len() {
                        1 => "1 node".to_owned(),
                        count => format!("{count} nodes"),
                    }
                );
                self.note(text, &card.place);
            }
        }
    }

    /// The nodes of sections of planes and shells that ask for the thickness at nodes.
    fn nodes_that_ask(&mut self) -> HashSet<u64> {
        let mut asking = HashSet::new();
        let sections = match self.ndim() {
            2 => "SOLIDSECTION",
            _ => "SHELLSECTION",
        };
        for card in self.cards(sections) {
            let asks = card.peek("NODALTHICKNESS").is_some();
            let Some(elset) = card.peek("ELSET").filter(|_| asks) else {
                continue;
            };
            for set in self.sets_of(card, elset) {
                for label in self.elements(&Target::Set(set)) {
                    let nodes = self.cell(label).map(|cell| self.deck.mesh.cell(cell));
                    let labels = nodes.unwrap_or_default().iter();
                    let labels = labels
                        .filter_map(|&node| self.deck.mesh.node_labels.get(node as usize).copied());
                    asking.extend(labels);
                }
            }
        }
        asking
    }

    /// Refuses elements of the plane that are not in one plane of constant z, and notes one that is not z = 0.
    pub fn judge_plane(&mut self) {
        let mesh = &self.deck.mesh;
        let of_plane = |cell: &CellId| {
            let kind = self.type_of(*cell);
            ["CPE", "CPS", "CAX"]
                .iter()
                .any(|plane| kind.starts_with(plane))
        };
        let nodes = || {
            let cells = mesh.cells(2).filter(of_plane);
            cells.flat_map(|cell| mesh.cell(cell)).copied()
        };
        let point = |node: u32| mesh.points.get(node as usize).copied();
        let first = nodes().next().and_then(|node| Some((node, point(node)?)));
        let Some((first, x)) = first else {
            return;
        };
        let size = nodes().filter_map(point);
        let size = size.map(|y| (y.x - x.x).abs().max((y.y - x.y).abs()));
        let size = size.fold(0.0, f64::max);
        let leaves = |node: u32| point(node).is_some_and(|y| (y.z - x.z).abs() > FLAT * size);
        let off = nodes().find(|&node| leaves(node));
        let label = |node: u32| mesh.node_labels.get(node as usize).copied().unwrap_or(0);
        if let Some((node, y)) = off.and_then(|node| Some((node, point(node)?))) {
            let text = format!(
                "elements of the plane are not in one: z is {} at node {}, and {} at node {}",
                x.z,
                label(first),
                y.z,
                label(node)
            );
            let one = Diagnostic::error(&codes::BAD_MESH, text);
            self.found
                .push(one.help("write all nodes of plane elements with z = 0, or none"));
        } else if x.z.abs() > FLAT * size {
            let text = format!("all plane elements are at z = {}, which is left out", x.z);
            self.note(text, &Place::nowhere());
        }
    }
}
