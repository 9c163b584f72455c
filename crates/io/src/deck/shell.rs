//! Shells: sections, what acts on their elements and nodes, and what of them is refused.
//!
//! A shell is an element of a shell's type in a *SHELL SECTION. Others of such a type, next to solids, are faces of these.
//! Side S1 is the negative side (SNEG), S2 the positive one (SPOS), which the normal leads to; S3, S4, … are the edges. A load P
//! pushes along the normal: it is a pressure on S1.

use super::Compat;
use super::model::Section;
use super::translation::{Target, Translation};
use crate::case::{Body, Shell, Thickness};
use crate::diagnostic::{Diagnostic, Place, Spanned, codes};
use crate::readers::inp::{Deck, Field, Kind, Statement, compared, number, without_volume};
use signorini_geometry::mesh::{Face, NodeId, Set};
use std::collections::{BTreeSet, HashSet};

/// Integration points through the thickness, of materials that yield.
const OF_YIELDING: usize = 5;

impl Translation<'_> {
    /// Whether an element is a shell.
    pub fn is_shell(&self, label: u64) -> bool {
        let cell = self.cell(label);
        cell.is_some_and(|cell| self.deck.directory.is_shell(cell))
    }

    /// Whether some of these nodes belong to shells.
    pub fn has_shell_nodes(&self, targets: &[Target]) -> bool {
        let mut labels = targets.iter().flat_map(|target| self.labels(target));
        !self.shell_nodes.is_empty() && labels.any(|label| self.shell_nodes.contains(&label))
    }

    /// These nodes, those of shells apart where rotations are meant, too; sets that have both kinds, node by node.
    pub fn shells_apart(&self, targets: Vec<Target>, turns: bool) -> [Vec<Target>; 2] {
        if !turns || !self.has_shell_nodes(&targets) {
            return [Vec::new(), targets];
        }
        let [mut shells, mut others] = [Vec::new(), Vec::new()];
        for target in targets {
            let labels = self.labels(&target);
            let of_shells = |label: &u64| self.shell_nodes.contains(label);
            match labels.iter().filter(|label| of_shells(label)).count() {
                0 => others.push(target),
                count if count == labels.len() => shells.push(target),
                _ => {
                    let (one, other): (Vec<u64>, Vec<u64>) =
                        labels.iter().partition(|l| of_shells(l));
                    shells.extend(one.into_iter().map(Target::One));
                    others.extend(other.into_iter().map(Target::One));
                }
            }
        }
        [shells, others]
    }

    /// Refuses rotations about local axes at nodes of shells.
    pub fn no_local_rotations(&mut self, labels: &[u64], turns: bool, place: &Place) {
        let of_shell = |label: &&u64| self.shell_nodes.contains(label);
        if let Some(label) = labels.iter().find(of_shell).filter(|_| turns) {
            let text = format!(
                "rotations of node {label}, of a shell, along local axes are not supported"
            );
            let remark = "leave the node out of *TRANSFORM";
            self.error(&codes::NOT_BUILT, text, place, remark);
        }
    }

    /// Refuses motions that turn nodes of shells.
    pub fn no_turning(&mut self, place: &Place) {
        let text = "rotations of shells can be held, not yet moved";
        let remark = "zero is; or turn the node of a rigid body or coupling that holds them";
        self.error(&codes::NOT_BUILT, text, place, remark);
    }

    /// The bodies of *SHELL SECTION.
    pub fn shells(&mut self) {
        let last = self.last_sections("SHELLSECTION");
        for (number, card) in self.cards("SHELLSECTION").enumerate() {
            let (elset, material) = (self.need(card, "ELSET"), card.get("MATERIAL"));
            // these are refused where parameters are judged
            if ["COMPOSITE", "LAYUP"]
                .iter()
                .any(|name| card.peek(name).is_some())
            {
                continue;
            }
            let material = material.map(str::to_owned).or_else(|| {
                self.need(card, "MATERIAL");
                None
            });
            let (Some(elset), Some(material)) = (elset, material) else {
                continue;
            };
            let Some(material) = self.material_of(card, &material) else {
                continue;
            };
            let Some(shell) = self.shell_of(card, &material) else {
                continue;
            };
            let sets = self.sets_of(card, elset);
            if sets.is_empty() {
                self.set(card, elset, &card.place, Kind::Elements);
            }
            if !self.makes_shells(card, &sets) {
                continue;
            }
            for set in sets {
                let mut own = self.elements(&Target::Set(set.clone()));
                let nall = own.len();
                own.retain(|label| last.get(label).is_none_or(|last| *last == number));
                if own.is_empty() {
                    continue;
                }
                let section = Section::bare(card, &material);
                let group = match own.len() == nall {
                    true => Spanned::new(set, card.place.clone()),
                    false => {
                        let text = format!(
                            "{} elements of `{elset}` have a later *SHELL SECTION, which holds",
                            nall - own.len()
                        );
                        self.note(text, &card.place);
                        self.elements_named(own, &card.place)
                    }
                };
                self.case.bodies.push(Body {
                    shell: Some(shell.clone()),
                    ..section.made_of(group)
                });
            }
        }
        self.remarks_on_shells();
    }

    /// What a *SHELL SECTION says of thickness, offset and points.
    fn shell_of(&mut self, card: &Statement, material: &str) -> Option<Shell> {
        let row = card.rows().next().unwrap_or_default();
        let place = row
            .first()
            .map_or(card.place.clone(), |field| field.place());
        let given = self.real(row.first());
        let thickness = match card.has("NODALTHICKNESS") {
            true => Thickness::Field,
            false if given > 0.0 => Thickness::Uniform(given),
            false => {
                let text = match row.first() {
                    Some(_) => format!("the thickness of *SHELL SECTION is {given}"),
                    None => "*SHELL SECTION has no thickness".to_owned(),
                };
                let remark = "positive, in the line below";
                self.error(&codes::OUT_OF_RANGE, text, &place, remark);
                return None;
            }
        };
        let yields =
            |one: &crate::case::Material| one.name.value == material && one.plasticity.is_some();
        let points = match self.count(row.get(1), 0) {
            0 if self.compat != Compat::Ccx && self.case.materials.iter().any(yields) => {
                OF_YIELDING
            }
            0 => Shell::POINTS,
            count => usize::try_from(count).unwrap_or(9).clamp(Shell::POINTS, 9),
        };
        Some(Shell {
            thickness: Spanned::new(thickness, place),
            offset: self.offset_of(card)?,
            normals: Spanned::new(Shell::NORMALS, card.place.clone()),
            points,
            place: card.place.clone(),
        })
    }

    /// OFFSET, in thicknesses, positive towards the positive side.
    fn offset_of(&mut self, card: &Statement) -> Option<f64> {
        let Some(text) = card.get("OFFSET") else {
            return Some(0.0);
        };
        match compared(text).as_str() {
            "SPOS" => return Some(0.5),
            "SNEG" => return Some(-0.5),
            _ => {}
        }
        let found = number(text);
        if found.is_none() {
            let text = format!("OFFSET={text} of *SHELL SECTION is no number");
            let remark = "a number of thicknesses, SPOS or SNEG";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        found
    }

    /// Whether all elements that a *SHELL SECTION names are shells that are built; if not, that is reported.
    fn makes_shells(&mut self, card: &Statement, sets: &[String]) -> bool {
        let mesh = &self.deck.mesh;
        let cells = sets.iter().filter_map(|set| mesh.sets.get(set));
        let strange = cells.flat_map(|set| &set.cells).find_map(|&cell| {
            let kind = self.type_of(cell);
            let label = mesh.cell_label(cell).unwrap_or(0);
            Some((label, kind, unfit(kind)?))
        });
        let Some((label, kind, why)) = strange else {
            return true;
        };
        let text = format!("*SHELL SECTION names element {label} of type {kind}: {why}");
        let one = Diagnostic::error(&codes::NOT_BUILT, text).at(&card.place, "");
        let help = "shells are S3, S4, S6 and S8, with or without R";
        self.found.push(one.help(help));
        false
    }

    /// One note on what becomes of shells, and what of a deck with them is refused as a whole.
    fn remarks_on_shells(&mut self) {
        if !self.case.bodies.iter().any(|body| body.shell.is_some()) {
            return;
        }
        let kinds = self.deck.directory.shells().iter();
        let kinds: BTreeSet<&str> = kinds.map(|cell| self.type_of(*cell)).collect();
        let kinds: Vec<&str> = kinds.into_iter().collect();
        let text = format!(
            "shells ({}) become solid-shells here, in full and reduced integration alike",
            kinds.join(", ")
        );
        let of_first = self.cards("SHELLSECTION").next();
        let place = of_first.map_or_else(Place::nowhere, |card| card.place.clone());
        self.note(text, &place);
        if self.solves_for_heat {
            let text = "heat in shells is not built";
            let help = "mesh the part with solids";
            let one = Diagnostic::error(&codes::NOT_BUILT, text).at(&place, "");
            self.found.push(one.help(help));
        }
        let averaged = |card: &&Statement| {
            let of_results = ["FILE", "PRINT", "OUTPUT"];
            of_results.iter().any(|end| card.keyword.ends_with(end))
                && card.peek("OUTPUT").map(compared).as_deref() == Some("2D")
        };
        let statements = &self.deck.statements;
        if let Some(card) = statements.iter().find(averaged) {
            let text = "OUTPUT=2D is left out: shells are written with their thickness, and not averaged over it";
            self.note(text, &card.place);
        }
    }

    /// A gradient of temperature behind the temperature in a line, of nodes of shells.
    pub fn gradient(&mut self, row: &[Field<'_>], targets: &[Target]) -> Option<f64> {
        let field = row.get(2)?;
        if !targets.is_empty() && !self.has_shell_nodes(targets) {
            let text = "a gradient of temperature at nodes that belong to no shell";
            let remark = "of solids write the temperature of each node";
            self.error(&codes::WRONG_KIND, text, &field.place(), remark);
            return None;
        }
        Some(self.real(Some(field))).filter(|gradient| *gradient != 0.0)
    }

    /// Whether all elements of a set are shells; refuses a rigid body that is made of shells and others.
    pub fn is_rigid_shell(&mut self, card: &Statement, group: &str) -> bool {
        let labels = self.elements(&Target::Set(group.to_owned()));
        let count = labels.iter().filter(|label| self.is_shell(**label)).count();
        if count > 0 && count < labels.len() {
            let text = "*RIGID BODY of shells and other elements together is not supported";
            let remark = "a rigid body for each, with one REF NODE";
            self.error(&codes::NOT_BUILT, text, &card.place, remark);
        }
        count > 0
    }
}

/// Why no shell is made of elements of this type; nothing where one is.
fn unfit(kind: &str) -> Option<&'static str> {
    if without_volume(kind) != Some("shell") {
        return Some("it is no shell");
    }
    if kind.starts_with("DS") || kind.ends_with('T') {
        return Some("shells that conduct heat are not built");
    }
    kind.starts_with("S9")
        .then_some("shells of nine nodes are not built")
}

/// The numbers of the nodes of shells.
pub(super) fn nodes_of_shells(deck: &Deck) -> HashSet<u64> {
    let nodes = deck.directory.shells().iter();
    let nodes = nodes.flat_map(|cell| deck.mesh.cell(*cell));
    let label = |node: &u32| deck.mesh.node_labels.get(*node as usize).copied();
    nodes.filter_map(label).collect()
}

/// The nodes of a set of the mesh, of faces of shells among them.
pub(super) fn nodes_of(deck: &Deck, set: &Set) -> Vec<NodeId> {
    let (mesh, directory) = (&deck.mesh, &deck.directory);
    let (shells, others): (Vec<Face>, Vec<Face>) =
        (set.faces.iter()).partition(|face| directory.is_shell(face.cell));
    if shells.is_empty() {
        return mesh.nodes_of(set);
    }
    let mut nodes = mesh.nodes_of(&Set {
        faces: others,
        ..set.clone()
    });
    for face in shells {
        match face.side.checked_sub(2) {
            None => nodes.extend(mesh.cell(face.cell)),
            Some(side) => {
                let edge = mesh.face(Face { side, ..face });
                nodes.extend(edge.into_iter().flat_map(|(_, nodes)| nodes));
            }
        }
    }
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
