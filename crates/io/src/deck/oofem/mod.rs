//! Decks of OOFEM as cases: what their records mean in our words.
//!
//! ```text
//! bytes ──readers::oofem──▶ Mesh, records ──▶ Case
//!                                    analysis    times of the steps, tolerances
//!                                    function    functions of time, at the times of the steps
//!                                    model       space, materials, sections, bars, slave nodes
//!                                    condition   supports, motions, loads
//!                                    contact     contacts of either dialect
//!                                    check       the check block: [[expect]]
//! ```
//!
//! A step of the deck is a step here: prescribed values are reached when it ends, in a straight line from the step
//! before. Time begins at 0 with nothing prescribed and the steps have the lengths of those of the deck; where its
//! first step has time 0 (`NonLinearStatic`), ours ends one step length later: see [`times`](self).
//!
//! A field that nobody asks for is an error with its line, unless it is among those that change no result: these are
//! named where they are stepped over. [`Compat::Oofem`](super::Compat) has elements integrated as OOFEM does.
//!
//! Sources: OOFEM Input Data Specification; decks of OOFEM's own and of its authors.
//!
//! To add a record: its translation in the stage where it belongs, and its line in `docs/oofem.md`.

mod analysis;
mod autopenalty;
mod check;
mod condition;
mod contact;
mod expression;
mod function;
mod model;
#[cfg(test)]
mod tests;
mod time;

use super::names::Names;
use super::{Compat, Read};
use crate::case::{Case, MeshSource, Name, Set, SetContent};
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Place, Severity, Spanned, codes};
use crate::fs::Fs;
use crate::readers::oofem::{Fault, Meshed, Parts, Record, read_deck};
use std::collections::{BTreeMap, BTreeSet};
use time::{Clock, Functions, empty_step};

/// Reads a deck. `name` is its path, to which files that it includes are relative.
///
/// # Errors
/// The first fault of its mesh; else all faults of its other records at once, each with its line.
pub fn read(fs: &dyn Fs, name: &str, bytes: &[u8], compat: Compat) -> Result<Read, Diagnostics> {
    let deck = read_deck(fs, name, bytes)
        .map_err(|error| Diagnostic::error(&codes::BAD_MESH, error.to_string()))?;
    let mut translation = Translation::new(deck.meshed, deck.parts, name, compat);
    translation.analysis();
    translation.functions();
    translation.model();
    translation.conditions();
    translation.contacts();
    translation.steps();
    translation.checks();
    translation.judge();
    let Translation {
        case,
        mut found,
        meshed,
        ..
    } = translation;
    if found.has_errors() {
        found.sort_by_place();
        return Err(found);
    }
    Ok(Read {
        case,
        mesh: meshed.mesh,
        found,
    })
}

/// A translation under way.
struct Translation {
    meshed: Meshed,
    parts: Parts,
    compat: Compat,
    case: Case,
    found: Diagnostics,
    clock: Clock,
    /// The degrees of freedom of nodes, of which old records name the first, second, …
    dofs: &'static [u64],
    functions: Functions,
    /// Whether strains are large.
    nonlinear: bool,
    /// Slave nodes by their numbers, with the components in which they follow.
    slaves: BTreeMap<u64, Vec<usize>>,
    /// What acts from the first step on.
    first: crate::case::Step,
    /// Sets of nodes of the case, by the numbers in them.
    sets: BTreeMap<Vec<u64>, String>,
    names: Names,
}

impl Translation {
    fn new(meshed: Meshed, parts: Parts, name: &str, compat: Compat) -> Self {
        let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let mut case = Case::empty();
        case.mesh = MeshSource::File {
            path: file.to_owned().into(),
        };
        let title = parts.description.chars().filter(|c| !c.is_control());
        case.title = title.take(200).collect();
        Self {
            names: Names::new(meshed.mesh.sets.keys().cloned()),
            meshed,
            parts,
            compat,
            case,
            found: Diagnostics::new(),
            clock: Clock::default(),
            dofs: &[],
            functions: Functions::default(),
            nonlinear: false,
            slaves: BTreeMap::new(),
            first: empty_step(),
            sets: BTreeMap::new(),
        }
    }

    fn error(
        &mut self,
        code: &'static Code,
        message: impl Into<String>,
        place: &Place,
        remark: impl Into<String>,
    ) {
        let one = Diagnostic::error(code, message).at(place, remark);
        self.found.push(one);
    }

    fn not_built(&mut self, message: impl Into<String>, place: &Place, why: impl Into<String>) {
        self.error(&codes::NOT_BUILT, message, place, why);
    }

    fn warn(&mut self, message: impl Into<String>, place: &Place, remark: impl Into<String>) {
        let one = Diagnostic::warning(&codes::UNUSUAL, message).at(place, remark);
        self.found.push(one);
    }

    fn note(&mut self, text: impl Into<String>, place: &Place) {
        let note = Diagnostic::new(Severity::Note, &codes::NO_EFFECT, text.into());
        self.found.push(note.at(place, ""));
    }

    /// What was read, unless it is wrong: then that is reported.
    fn take<T>(&mut self, result: Result<T, Fault>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(fault) => {
                self.found.push(fault.into());
                None
            }
        }
    }

    /// Refuses what nobody has asked for in a record.
    fn finish(&mut self, record: &Record) {
        let unread: Vec<_> = record.unread().collect();
        for (word, place) in unread {
            let text = format!(
                "`{word}` of this {} record is not read: it is not known, or not supported",
                record.kind()
            );
            self.error(&codes::UNKNOWN_KEY, text, &place, "");
        }
    }

    /// A name that nothing has yet.
    fn fresh(&mut self, wanted: &str) -> String {
        self.names.fresh(wanted)
    }

    /// A set of these nodes, in this order.
    fn nodes_named(&mut self, labels: Vec<u64>, place: &Place) -> Name {
        if let Some(name) = self.sets.get(&labels) {
            return Spanned::new(name.clone(), place.clone());
        }
        let wanted = match labels[..] {
            [one] => format!("node-{one}"),
            _ => "nodes".to_owned(),
        };
        let name = self.fresh(&wanted);
        self.sets.insert(labels.clone(), name.clone());
        self.case.sets.push(Set {
            name: Spanned::new(name.clone(), place.clone()),
            content: SetContent::Nodes(labels),
            place: place.clone(),
        });
        Spanned::new(name, place.clone())
    }

    /// The numbers of all nodes of a set of the deck: its own, and those of its elements and sides. In the order of
    /// the set where it is one of nodes alone.
    fn labels_of_set(&mut self, number: u64, place: &Place) -> Option<Vec<u64>> {
        let Some(names) = self.meshed.sets.get(&number) else {
            let text = format!("there is no set {number}");
            self.error(&codes::UNDEFINED, text, place, "");
            return None;
        };
        let mesh = &self.meshed.mesh;
        let mut nodes = Vec::new();
        for name in names.all() {
            let Some(set) = mesh.sets.get(name) else {
                continue;
            };
            match set.is_bare() {
                true => nodes.extend(&set.nodes),
                false => nodes.extend(mesh.nodes_of(set)),
            }
        }
        let mut seen = BTreeSet::new();
        nodes.retain(|node| seen.insert(*node));
        let label = |node: u32| mesh.node_labels.get(node as usize).copied();
        let labels: Vec<u64> = nodes.into_iter().filter_map(label).collect();
        if labels.is_empty() {
            let text = format!("set {number} is empty");
            self.error(&codes::WRONG_KIND, text, place, "");
            return None;
        }
        Some(labels)
    }

    fn ndim(&self) -> usize {
        self.case.model.space.ndim()
    }

    /// Refuses the unread rest of records that every stage has looked at.
    fn judge(&mut self) {
        let parts = &mut self.parts;
        parts.domain.ignore_all();
        for record in parts.nodes.iter_mut().chain(&mut parts.elements) {
            record.take_kind();
            for keyword in ["dofidmask", "load", "bc"] {
                // what matters of them has been read
                let _ = record.wholes(keyword);
            }
        }
        let mut records = std::mem::take(&mut self.parts.nodes);
        records.append(&mut self.parts.elements);
        for record in &records {
            self.finish(record);
        }
        let mut sets = std::mem::take(&mut self.parts.sets);
        for record in &mut sets {
            record.take_kind();
            self.finish(record);
        }
        for record in std::mem::take(&mut self.parts.initial) {
            self.not_built(
                format!("the initial condition `{}` is not supported", record.kind()),
                &record.place(),
                "everything starts at rest",
            );
        }
    }
}
