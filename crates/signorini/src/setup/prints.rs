//! Printed tables: the requests, in nodes and cells.

use super::names::Names;
use super::quoted;
use crate::run::element_named;
use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{self, Case, Name, PrintOf, Space, Totals};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Spanned, closest, codes, listed};
use signorini_mechanics::system::{Idealisation, Wanted};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Tables of one set.
#[derive(Clone, Debug, PartialEq)]
pub struct Printed {
    /// Its name.
    pub set: String,
    /// What is printed of what.
    pub what: PrintedOf,
    /// The axes along which vectors at nodes are printed, in the order of the nodes; empty where all are global.
    pub axes: Vec<Option<[Vec3; 3]>>,
    /// Whether tensors at integration points are printed along the axes of the material.
    pub local: bool,
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
    /// Of contacts.
    Contacts(Vec<PrintedContact>, Vec<ContactQuantity>),
    /// Of faces: the resultant of stresses on all of them.
    Faces(Vec<PrintedFace>),
}

/// A face on which stresses are summed up.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintedFace {
    /// The face.
    pub face: Face,
    /// What the plane stands for there.
    pub space: Idealisation,
    /// What its thickness is multiplied by at every node of the mesh; none: 1.
    pub profile: Option<Arc<[f64]>>,
}

/// A contact that is printed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PrintedContact {
    /// Its name.
    pub name: String,
    /// Name of its secondary side.
    pub secondary: String,
    /// Name of its primary side.
    pub primary: String,
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
    /// Heat that bodies and contacts take from it, which loads and held temperatures give.
    HeatReaction,
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
    /// Squared angular velocity of the centrifugal load that acts on each element.
    SpinSquared,
    /// Flux of heat at the points, through present areas.
    HeatFlux,
}

/// A quantity of contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactQuantity {
    /// Gap and slip of closed nodes.
    Gap,
    /// Pressure and tangential traction at closed nodes.
    Traction,
    /// Energy at closed nodes.
    Energy,
    /// How many are closed.
    Count,
    /// The whole force on the secondary side.
    Force,
    /// What pressures do of it.
    NormalForce,
    /// What friction does of it.
    ShearForce,
}

const OF_NODES: [(&str, NodeQuantity); 4] = [
    ("displacement", NodeQuantity::Displacement),
    ("reaction", NodeQuantity::Reaction),
    ("temperature", NodeQuantity::Temperature),
    ("heat-reaction", NodeQuantity::HeatReaction),
];

const OF_ELEMENTS: [(&str, ElementQuantity); 9] = [
    ("stress", ElementQuantity::Stress),
    ("strain", ElementQuantity::Strain),
    ("mechanical-strain", ElementQuantity::MechanicalStrain),
    ("plastic-strain", ElementQuantity::PlasticStrain),
    ("energy-density", ElementQuantity::EnergyDensity),
    ("energy", ElementQuantity::Energy),
    ("volume", ElementQuantity::Volume),
    ("spin-squared", ElementQuantity::SpinSquared),
    ("heat-flux", ElementQuantity::HeatFlux),
];

const OF_CONTACTS: [(&str, ContactQuantity); 7] = [
    ("gap", ContactQuantity::Gap),
    ("traction", ContactQuantity::Traction),
    ("energy", ContactQuantity::Energy),
    ("count", ContactQuantity::Count),
    ("force", ContactQuantity::Force),
    ("normal-force", ContactQuantity::NormalForce),
    ("shear-force", ContactQuantity::ShearForce),
];

/// The tables of every step; a step without a word goes on with those before it.
pub(super) fn prints(case: &Case, names: &Names<'_>, found: &mut Diagnostics) -> Vec<Vec<Printed>> {
    let mut all = case.steps.iter().flat_map(|step| &step.prints).flatten();
    let local = match all.any(|one| one.local) {
        true => axes(case, names, found),
        false => BTreeMap::new(),
    };
    let mut now = Vec::new();
    let of_step = |step: &case::Step| {
        if let Some(prints) = &step.prints {
            let tables = prints
                .iter()
                .filter_map(|one| printed(one, case, names, &local, found));
            now = tables.collect();
        }
        now.clone()
    };
    case.steps.iter().map(of_step).collect()
}

/// What the tables of all steps, and forces in `.frd` files, want to be sampled. Forces of bodies of revolution are
/// printed without what hoop stresses do, which is known at the points around the nodes: of the cells that come second.
pub(super) fn wanted(
    prints: &[Vec<Printed>],
    mesh: &Mesh,
    case: &Case,
    names: &Names<'_>,
) -> (Wanted, Vec<CellId>) {
    let space = *case.model.space;
    let mut wanted = Wanted {
        forces: case
            .output
            .format
            .iter()
            .any(|format| format.value == "frd"),
        ..Wanted::default()
    };
    let (mut revolved, mut around) = (BTreeSet::new(), Vec::new());
    for one in prints.iter().flatten() {
        match &one.what {
            PrintedOf::Elements(cells, _) => wanted.cells.extend(cells),
            PrintedOf::Nodes(nodes, quantities) => {
                wanted.forces |= quantities.contains(&NodeQuantity::HeatReaction);
                if quantities.contains(&NodeQuantity::Reaction) {
                    wanted.forces = true;
                    if space == Space::Axisymmetric {
                        revolved.extend(nodes.iter().copied());
                    }
                }
            }
            PrintedOf::Contacts(..) | PrintedOf::Faces(_) => {}
        }
    }
    let expected = case.expectations.iter();
    let expected: BTreeSet<u64> = expected
        .filter_map(|one| element_named(&one.what.value))
        .map(|(label, _)| label)
        .collect();
    if !expected.is_empty() {
        let is_meant = |cell: &CellId| {
            let label = mesh.cell_label(*cell);
            label.is_some_and(|label| expected.contains(&label))
        };
        let all = (1..=mesh.dim()).flat_map(|dim| mesh.cells(dim));
        wanted.cells.extend(all.filter(is_meant));
    }
    if !revolved.is_empty() {
        let is_near = |cell: &CellId| mesh.cell(*cell).iter().any(|node| revolved.contains(node));
        let revolves = |cell: &CellId| names.plane(*cell) == Idealisation::Axisymmetric;
        let near = mesh.cells(mesh.dim()).filter(is_near);
        around.extend(near.filter(revolves));
        wanted.cells.extend_from_slice(&around);
    }
    wanted.cells.sort_unstable();
    wanted.cells.dedup();
    (wanted, around)
}

fn printed(
    one: &case::Print,
    case: &Case,
    names: &Names<'_>,
    local: &BTreeMap<NodeId, [Vec3; 3]>,
    found: &mut Diagnostics,
) -> Option<Printed> {
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
            let quantities = quantities(&one.quantities, &OF_CONTACTS, found);
            PrintedOf::Contacts(contacts(on, case, found)?, quantities)
        }
        PrintOf::Faces => {
            let faces = names.section(on?, found)?;
            let of_face = |face: &Face| PrintedFace {
                face: *face,
                space: names.plane(face.cell),
                profile: names
                    .own_plane(face.cell)
                    .and_then(|own| own.profile.clone()),
            };
            PrintedOf::Faces(faces.iter().map(of_face).collect())
        }
    };
    let axes = match &what {
        PrintedOf::Nodes(nodes, _) if one.local => {
            nodes.iter().map(|node| local.get(node).copied()).collect()
        }
        _ => Vec::new(),
    };
    Some(Printed {
        set: on.map_or_else(String::new, |on| on.value.clone()),
        what,
        axes,
        local: one.local,
        totals: one.totals,
        every: one.every.max(1),
    })
}

/// The local axes of all nodes that have some.
fn axes(case: &Case, names: &Names<'_>, found: &mut Diagnostics) -> BTreeMap<NodeId, [Vec3; 3]> {
    let mut of_node = BTreeMap::new();
    for one in &case.axes {
        for node in names.nodes(&one.set, found).unwrap_or_default() {
            let Some(axes) = names.place(node).and_then(|x| one.system.at(x)) else {
                let message = "these axes have no directions";
                let remark = "vectors that are parallel, or points that coincide";
                found.push(Diagnostic::error(&codes::OUT_OF_RANGE, message).at(&one.place, remark));
                break;
            };
            of_node.insert(node, axes);
        }
    }
    of_node
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

/// The contact of this name; every one where none is named.
fn contacts(
    on: Option<&Name>,
    case: &Case,
    found: &mut Diagnostics,
) -> Option<Vec<PrintedContact>> {
    let is_meant = |contact: &&case::Contact| on.is_none_or(|on| on.value == contact.name.value);
    let contact = |contact: &case::Contact| PrintedContact {
        name: contact.name.value.clone(),
        secondary: contact.secondary.value.clone(),
        primary: contact.primary.value.clone(),
    };
    let meant: Vec<_> = case.contacts.iter().filter(is_meant).map(contact).collect();
    if let (true, Some(on)) = (meant.is_empty(), on) {
        let names = || case.contacts.iter().map(|one| one.name.as_str());
        let mut message = Diagnostic::error(
            &codes::UNDEFINED,
            format!("there is no contact called {}", quoted(on)),
        )
        .at(&on.place, "not defined");
        if let Some(near) = closest(on, names()) {
            message = message.help(format!("did you mean \"{near}\"?"));
        }
        found.push(message);
        return None;
    }
    Some(meant)
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
