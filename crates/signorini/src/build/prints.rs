//! Printed tables: what is asked for, in nodes and cells.

use super::names::Names;
use super::quoted;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_io::case::{self, Case, Name, PrintOf, Totals};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Spanned, closest, codes, listed};
use signorini_mechanics::system::Wanted;

/// Tables of one set.
#[derive(Clone, Debug, PartialEq)]
pub struct Printed {
    /// Its name.
    pub set: String,
    /// What is printed of what.
    pub what: PrintedOf,
    /// Whether sums follow.
    pub totals: Totals,
    /// After how many increments.
    pub every: u64,
}

/// What is printed of what.
#[derive(Clone, Debug, PartialEq)]
pub enum PrintedOf {
    /// Of nodes, in the order of their set.
    Nodes(Vec<NodeId>, Vec<NodeQuantity>),
    /// Of elements, likewise.
    Elements(Vec<CellId>, Vec<ElementQuantity>),
}

/// A quantity of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeQuantity {
    /// Displacement.
    Displacement,
    /// Force of bodies and contacts, which loads, supports and couplings balance.
    Reaction,
    /// Temperature.
    Temperature,
}

/// A quantity of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementQuantity {
    /// Cauchy stress at the points.
    Stress,
    /// Strain at the points: linear, or of Green and Lagrange.
    Strain,
    /// The part of it that causes stress.
    MechanicalStrain,
    /// Equivalent plastic strain at the points.
    PlasticStrain,
    /// Energy per initial volume at the points.
    EnergyDensity,
    /// Energy of each element.
    Energy,
    /// Initial volume of each element.
    Volume,
}

const OF_NODES: [(&str, NodeQuantity); 3] = [
    ("displacement", NodeQuantity::Displacement),
    ("reaction", NodeQuantity::Reaction),
    ("temperature", NodeQuantity::Temperature),
];

const OF_ELEMENTS: [(&str, ElementQuantity); 7] = [
    ("stress", ElementQuantity::Stress),
    ("strain", ElementQuantity::Strain),
    ("mechanical-strain", ElementQuantity::MechanicalStrain),
    ("plastic-strain", ElementQuantity::PlasticStrain),
    ("energy-density", ElementQuantity::EnergyDensity),
    ("energy", ElementQuantity::Energy),
    ("volume", ElementQuantity::Volume),
];

/// The tables of every step; a step without a word goes on with those before it.
pub(super) fn prints(case: &Case, names: &Names<'_>, found: &mut Diagnostics) -> Vec<Vec<Printed>> {
    let mut now = Vec::new();
    let of_step = |step: &case::Step| {
        if let Some(prints) = &step.prints {
            let tables = prints.iter().filter_map(|one| printed(one, names, found));
            now = tables.collect();
        }
        now.clone()
    };
    case.steps.iter().map(of_step).collect()
}

/// What the tables of all steps want to be sampled.
pub(super) fn wanted(prints: &[Vec<Printed>]) -> Wanted {
    let mut wanted = Wanted::default();
    for one in prints.iter().flatten() {
        match &one.what {
            PrintedOf::Elements(cells, _) => wanted.cells.extend(cells),
            PrintedOf::Nodes(_, quantities) => {
                wanted.forces |= quantities.contains(&NodeQuantity::Reaction);
            }
        }
    }
    wanted.cells.sort_unstable();
    wanted.cells.dedup();
    wanted
}

fn printed(one: &case::Print, names: &Names<'_>, found: &mut Diagnostics) -> Option<Printed> {
    let on = one.on.as_ref();
    let what = match one.of {
        PrintOf::Nodes => {
            let quantities = quantities(&one.quantities, &OF_NODES, found);
            PrintedOf::Nodes(names.nodes_in_order(on?, found)?, quantities)
        }
        PrintOf::Elements => {
            let quantities = quantities(&one.quantities, &OF_ELEMENTS, found);
            PrintedOf::Elements(cells(on?, names, found)?, quantities)
        }
        PrintOf::Contact => {
            found.push(
                Diagnostic::error(
                    &codes::NOT_BUILT,
                    "tables of contacts are not supported yet",
                )
                .at(&one.place, "known, but not in this version")
                .help("write  [[output.history]]  or  fields = [\"contact\"]"),
            );
            return None;
        }
    };
    Some(Printed {
        set: on.map_or_else(String::new, |on| on.value.clone()),
        what,
        totals: one.totals,
        every: one.every.max(1),
    })
}

/// The elements of a set as they are listed, each once.
fn cells(name: &Name, names: &Names<'_>, found: &mut Diagnostics) -> Option<Vec<CellId>> {
    let cells = names.cells_of(name, found)?;
    if cells.is_empty() {
        found.push(
            Diagnostic::error(
                &codes::WRONG_KIND,
                format!("{} has no elements", quoted(name)),
            )
            .at(
                &name.place,
                "values of elements are printed of a group or set of elements",
            ),
        );
        return None;
    }
    Some(cells)
}

/// Words become quantities.
fn quantities<Q: Copy>(
    words: &[Spanned<String>],
    known: &[(&'static str, Q)],
    found: &mut Diagnostics,
) -> Vec<Q> {
    let mut quantities = Vec::with_capacity(words.len());
    for word in words {
        match known.iter().find(|(name, _)| *name == word.value) {
            Some((_, quantity)) => quantities.push(*quantity),
            None => {
                let names = || known.iter().map(|(name, _)| *name);
                let remark = closest(&word.value, names()).map_or_else(
                    || "no such quantity".into(),
                    |name| format!("did you mean \"{name}\"?"),
                );
                let message = format!("\"{}\" cannot be printed there", word.value);
                found.push(
                    Diagnostic::error(&codes::NOT_A_CHOICE, message)
                        .at(&word.place, remark)
                        .note(format!("quantities: {}", listed(names()))),
                );
            }
        }
    }
    quantities
}
