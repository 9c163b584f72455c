//! Bodies: their cells, and what they are made of.

use super::carriers::Carriers;
use super::names::{Cells, Names};
use super::orientation::{axes, axes_of_no_body, oriented};
use super::{OwnPlane, heat, quoted};
use crate::own::Own;
use crate::text::plural;
use signorini_geometry::element::LockingClass;
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::tensor::Sym3;
use signorini_io::case::{self, AtPoint, Body, Case, Name, Temperatures, Thickness};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use signorini_mechanics::material::{
    self, Constants, ConstantsError, Expanding, Hardening, HardeningKind, Material, Plasticity,
    Undeformed,
};
use signorini_mechanics::model::{BodyKind, BodyPart, LockingSummary, MassMatrix, MassPart};
use signorini_mechanics::solid::{AtNodes, AtStart, Integration, Locking};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// The bodies of a case, in its order.
pub(super) fn bodies(
    case: &Case,
    names: &Names<'_>,
    carriers: &Carriers,
    own: &Own,
    found: &mut Diagnostics,
) -> Vec<BodyPart> {
    let one = |body| body_part(case, body, (names, carriers), own, found);
    let bodies: Vec<BodyPart> = case.bodies.iter().filter_map(one).collect();
    at_start(case, names, &bodies, found);
    axes_of_no_body(case, names, &bodies, found);
    unchangeable(case, found);
    if let Some(unused) = unused_thickness(case) {
        found.push(unused);
    }
    bodies
}

/// A warning of elements that are in no body: a forgotten [[body]] leaves no other trace.
pub(super) fn left_out(
    case: &Case,
    names: &Names<'_>,
    mesh: &Mesh,
    bodies: &[BodyPart],
) -> Option<Diagnostic> {
    let ndim = case.model.space.ndim();
    let is_solid = |cell: &&CellId| mesh.element(**cell).is_some_and(|e| e.dim() == ndim);
    let used = || bodies.iter().flat_map(|body| &body.cells).filter(is_solid);
    let solids = mesh.blocks.iter().filter(|b| b.element.dim() == ndim);
    let all: usize = solids.map(|block| block.ncell()).sum();
    // no cell is in two bodies
    let count = all.saturating_sub(used().count());
    if count == 0 {
        return None;
    }
    let used: HashSet<CellId> = used().copied().collect();
    let first = mesh.cells(ndim).find(|cell| !used.contains(cell))?;
    let verb = if count == 1 { "is" } else { "are" };
    let message = format!("{} {verb} in no body: left out", plural(count, "element"));
    let groups: Vec<String> = names
        .groups_of(first)
        .map(|name| format!("\"{name}\""))
        .collect();
    let label = names.element(first).unwrap_or_default();
    let of = match groups.len() {
        0 => String::new(),
        _ => format!(", of {}", groups.join(", ")),
    };
    let found = Diagnostic::warning(&codes::MESH_NOTE, message)
        .note(format!("the first is element {label}{of}"))
        .help("name its group in a [[body]]");
    Some(match case.bodies.last() {
        Some(body) => found.at(&body.place, ""),
        None => found,
    })
}

/// The material of this name.
fn material<'a>(case: &'a Case, name: &case::Name) -> Option<&'a case::Material> {
    let mut all = case.materials.iter();
    all.find(|one| one.name.value == name.value)
}

/// The density of a rigid body.
fn rigid_density(body: &Body, part: &case::Material, found: &mut Diagnostics) -> Option<f64> {
    if part.damping.is_any() {
        let message = "damping of a rigid body is not built";
        let place = body
            .material
            .as_ref()
            .map_or(&body.place, |name| &name.place);
        found.push(
            Diagnostic::error(&codes::NOT_BUILT, message)
                .at(place, "this material has `damping`")
                .help("give it a material of its own without `damping`"),
        );
    }
    if part.density.is_none() {
        let message = "a rigid body with a material that has no `density`";
        let place = body
            .material
            .as_ref()
            .map_or(&body.place, |name| &name.place);
        found.push(
            Diagnostic::error(&codes::MISSING, message)
                .at(
                    place,
                    "its density is all that a rigid body has of its material",
                )
                .help("write  density =  there, or delete `material` here"),
        );
    }
    part.density.as_ref().map(|density| density.value)
}

/// What a body is called: by its groups.
pub(super) fn name(body: &Body) -> String {
    let groups: Vec<&str> = body.groups.iter().map(|group| group.as_str()).collect();
    groups.join("+")
}

fn body_part(
    case: &Case,
    body: &Body,
    (names, carriers): (&Names<'_>, &Carriers),
    own: &Own,
    found: &mut Diagnostics,
) -> Option<BodyPart> {
    let mut cells = Cells::default();
    for group in &body.groups {
        cells.append(names.cells(group, found));
    }
    let name = name(body);
    let named = body.material.as_ref();
    let of_body = named.and_then(|name| material(case, name));
    if body.rigid {
        let first = body.groups.first()?;
        let kind = BodyKind::Rigid {
            carrier: carriers.get(first)?,
            density: of_body.and_then(|part| rigid_density(body, part, found)),
        };
        let cells = cells.all();
        return Some(BodyPart { name, cells, kind });
    }
    let part = of_body?;
    let density = part.density.as_ref().map(|density| density.value);
    let mass = MassPart {
        matrix: match body.mass_matrix {
            case::MassMatrix::Lumped => MassMatrix::Lumped,
            case::MassMatrix::Auto | case::MassMatrix::Consistent => MassMatrix::Consistent,
        },
        damping: part.damping.mass,
        retardation: part.damping.stiffness,
    };
    let material = oriented(law(part, own, found)?, body);
    let later = later(case, body, own, found);
    if cells.solids.is_empty() && !cells.bars.is_empty() {
        let area = bars(body, found)?;
        if let Some((step, _)) = later.first() {
            let message = "bars keep their material";
            let place = case
                .steps
                .get(*step)
                .map_or(&body.place, |step| &step.place);
            let remark = "this step gives them another one";
            found.push(Diagnostic::error(&codes::NOT_BUILT, message).at(place, remark));
        }
        return Some(BodyPart {
            name,
            cells: cells.bars,
            kind: BodyKind::Truss {
                material,
                density,
                mass,
                area,
                small: body.small_strain,
            },
        });
    }
    if let Some(area) = &body.area {
        let first = body.groups.first()?;
        found.push(
            Diagnostic::error(
                &codes::CONTRADICTION,
                format!("{} is made of solids, which have no `area`", quoted(first)),
            )
            .at(&area.place, "only bars, of line elements, have one"),
        );
    }
    let cells = solids(cells, body, found);
    let plane = cells.first().and_then(|&cell| names.own_plane(cell));
    if let Some(plane) = plane {
        thick(case, body, (plane, &cells), names, found)?;
    }
    let heat = heat::of_body((case, names), (body, &cells), part, found);
    let (integration, locking) = treatment(body);
    Some(BodyPart {
        name,
        kind: BodyKind::Solid {
            material,
            later,
            density,
            mass,
            integration,
            locking,
            space: plane.map(|plane| plane.space),
            profile: plane.and_then(|plane| plane.profile.clone()),
            linear_temperatures: body.temperatures == Temperatures::Linear,
            at_nodes: at_nodes(body.at_nodes),
            initial: initial(case, names, &cells),
            heat,
            axes: match body.orientation {
                Some(_) => Some(Box::new(axes(case, body, names, &cells, found)?)),
                None => None,
            },
        },
        cells,
    })
}

const fn at_nodes(word: case::AtNodes) -> AtNodes {
    match word {
        case::AtNodes::Linear => AtNodes::Linear,
        case::AtNodes::Element => AtNodes::Element,
    }
}

/// How its elements are integrated, and what is done against locking.
const fn treatment(body: &Body) -> (Integration, Locking) {
    match &body.shell {
        Some(shell) => (Integration::Through(shell.points), Locking::Shell),
        None => (integration(body.integration), locking(body.locking.value)),
    }
}

/// A warning of thicknesses at nodes that no body takes.
fn unused_thickness(case: &Case) -> Option<Diagnostic> {
    let first = case.thicknesses.first()?;
    let takes = |body: &Body| {
        let of_shell = body.shell.as_ref().map(|shell| &shell.thickness);
        let mut given = body.thickness.iter().chain(of_shell);
        given.any(|of| of.value == Thickness::Field)
    };
    let is_unused = !case.bodies.iter().any(takes);
    is_unused.then(|| {
        Diagnostic::warning(
            &codes::NO_EFFECT,
            "thicknesses at nodes that change nothing",
        )
        .at(&first.place, "no body takes them")
        .help("write  thickness = \"field\"  in a [[body]] or its `shell`")
    })
}

/// Refuses a body that takes its thickness from nodes where one has none.
fn thick(
    case: &Case,
    body: &Body,
    (plane, cells): (&OwnPlane, &[CellId]),
    names: &Names<'_>,
    found: &mut Diagnostics,
) -> Option<()> {
    let nodes = || names.nodes_around(cells.iter().copied());
    let (Some(node), Some(thickness)) = (plane.gap(nodes), &body.thickness) else {
        return Some(());
    };
    let name = quoted(body.groups.first()?);
    let message = match case.thicknesses.is_empty() {
        true => format!("{name} takes its thickness from nodes, and the case gives none"),
        false => format!(
            "{name} takes its thickness from nodes, and node {} has none",
            names.label(node)
        ),
    };
    found.push(
        Diagnostic::error(&codes::MISSING, message)
            .at(&thickness.place, "")
            .help("write  [[thickness]] on = , value =  for all of its nodes"),
    );
    None
}

/// The materials that steps give a body, each with the number of the step.
fn later(
    case: &Case,
    body: &Body,
    own: &Own,
    found: &mut Diagnostics,
) -> Vec<(usize, Box<dyn Material>)> {
    let mut later = Vec::new();
    for (number, step) in case.steps.iter().enumerate() {
        for change in &step.materials {
            if !body
                .groups
                .iter()
                .any(|group| group.value == change.group.value)
            {
                continue;
            }
            if body.groups.len() > 1 {
                let message = format!("{} is a part of a body", quoted(&change.group));
                found.push(
                    Diagnostic::error(&codes::NOT_BUILT, message)
                        .at(
                            &change.group.place,
                            "a body changes its material as a whole",
                        )
                        .help("make a [[body]] of this group alone"),
                );
            }
            let part = material(case, &change.material);
            let material = part.and_then(|part| law(part, own, found));
            let material = material.map(|inner| oriented(inner, body));
            later.extend(material.map(|material| (number, material)));
        }
    }
    later
}

/// A group that a step gives a material and that no deformable body is made of.
fn unchangeable(case: &Case, found: &mut Diagnostics) {
    let deformable = case.bodies.iter().filter(|body| !body.rigid);
    let groups: HashSet<&str> = deformable
        .flat_map(|body| &body.groups)
        .map(|group| group.as_str())
        .collect();
    for change in case.steps.iter().flat_map(|step| &step.materials) {
        if !groups.contains(change.group.as_str()) {
            let message = format!("no deformable body is made of {}", quoted(&change.group));
            let diagnostic = Diagnostic::error(&codes::UNDEFINED, message);
            found.push(diagnostic.at(&change.group.place, "no [[body]] has this group"));
        }
    }
}

const fn integration(word: case::Integration) -> Integration {
    match word {
        case::Integration::Full => Integration::Full,
        case::Integration::Reduced => Integration::Reduced,
        case::Integration::Raised => Integration::Raised,
    }
}

const fn locking(word: case::Locking) -> Locking {
    match word {
        case::Locking::Auto => Locking::Auto,
        case::Locking::None => Locking::None,
        case::Locking::BBar => Locking::BBar,
        case::Locking::FBar => Locking::FBar,
        case::Locking::Incompatible => Locking::Incompatible,
        case::Locking::Shear => Locking::Shear,
    }
}

/// The word of what the program has chosen against locking.
pub(super) const fn locking_word(chosen: Locking) -> case::Locking {
    match chosen {
        // a shell has no other choice
        Locking::Auto | Locking::Shell => case::Locking::Auto,
        Locking::None => case::Locking::None,
        Locking::BBar => case::Locking::BBar,
        Locking::FBar => case::Locking::FBar,
        Locking::Incompatible => case::Locking::Incompatible,
        Locking::Shear => case::Locking::Shear,
    }
}

/// What the integration points of these cells have at the start.
fn initial(case: &Case, names: &Names<'_>, cells: &[CellId]) -> Vec<AtStart> {
    if case.initial_stress.is_empty() && case.initial_strain.is_empty() {
        return Vec::new();
    }
    let label = |&cell: &CellId| Some((names.element(cell)?, cell));
    let by_label: HashMap<u64, CellId> = cells.iter().filter_map(label).collect();
    let here = |at: &AtPoint| {
        let cell = *by_label.get(&at.element)?;
        let [xx, yy, zz, xy, xz, yz] = at.value;
        // points count from 1
        let point = (at.point as usize).saturating_sub(1);
        Some((cell, point, Sym3::new(xx, yy, zz, xy, yz, xz)))
    };
    let with = |(cell, point, stress), strain| AtStart {
        cell,
        point,
        stress,
        strain,
    };
    let stresses = case.initial_stress.iter().filter_map(here);
    let strains = case.initial_strain.iter().filter_map(here);
    let stresses = stresses.map(|at| with(at, Sym3::ZERO));
    let strains = strains.map(|(cell, point, strain)| with((cell, point, Sym3::ZERO), strain));
    stresses.chain(strains).collect()
}

/// Elements that have something at the start, and are in no body that deforms.
fn at_start(case: &Case, names: &Names<'_>, bodies: &[BodyPart], found: &mut Diagnostics) {
    if case.initial_stress.is_empty() && case.initial_strain.is_empty() {
        return;
    }
    let solids = bodies
        .iter()
        .filter(|b| matches!(b.kind, BodyKind::Solid { .. }));
    let cells = solids.flat_map(|body| &body.cells);
    let known: HashSet<u64> = cells.filter_map(|&cell| names.element(cell)).collect();
    let points = case.initial_stress.iter().chain(&case.initial_strain);
    if let Some(at) = points.into_iter().find(|at| !known.contains(&at.element)) {
        found.push(
            Diagnostic::error(
                &codes::NOT_IN_MESH,
                format!("element {} is in no solid body", at.element),
            )
            .at(&at.place, "something is to be here at the start"),
        );
    }
}

/// The solids of a body; lines among them have been named by mistake.
fn solids(cells: Cells, body: &Body, found: &mut Diagnostics) -> Vec<CellId> {
    let mixed = !cells.bars.is_empty() && body.area.is_some();
    if mixed {
        found.push(
            Diagnostic::error(&codes::WRONG_KIND, "a body of both solids and bars")
                .at(&body.place, "here")
                .help("make the line elements a [[body]] of their own"),
        );
    }
    cells.solids
}

/// The cross-section of a body of bars.
fn bars(body: &Body, found: &mut Diagnostics) -> Option<f64> {
    if let Some(orientation) = &body.orientation {
        found.push(
            Diagnostic::error(
                &codes::CONTRADICTION,
                "`orientation` means nothing for bars",
            )
            .at(orientation.place(), "the first axis of a bar lies along it"),
        );
    }
    if body.area.is_none() {
        let first = body.groups.first()?;
        found.push(
            Diagnostic::error(
                &codes::MISSING,
                format!(
                    "{} is made of line elements and has no `area`",
                    quoted(first)
                ),
            )
            .at(&body.place, "`area` is missing here")
            .help("write  area = , the cross-section of its bars; or name a group of solids"),
        );
    }
    let of_planes = [
        ("space", body.space.as_ref().map(|space| &space.place)),
        ("thickness", body.thickness.as_ref().map(|one| &one.place)),
    ];
    for (key, place) in of_planes {
        if let Some(place) = place {
            let message = format!("`{key}` means nothing for bars, which have an `area`");
            let message = Diagnostic::error(&codes::CONTRADICTION, message);
            found.push(message.at(place, "delete it"));
        }
    }
    body.area.as_ref().map(|area| area.value)
}

/// The law of a material, of the case or the program, with plasticity and thermal expansion.
fn law(part: &case::Material, own: &Own, found: &mut Diagnostics) -> Option<Box<dyn Material>> {
    if part.model.value.is_empty() {
        return Some(Box::new(Undeformed));
    }
    let inner: Option<Box<dyn Material>> = match (&part.own, &part.plasticity) {
        (Some(name), _) => {
            let shared = own.materials.get(&name.value);
            shared.map(|one| Box::new(Arc::clone(one)) as _)
        }
        (None, Some(plasticity)) => plastic(part, plasticity, found),
        (None, None) => elastic(part, found),
    };
    let inner = inner?;
    Some(match &part.expansion {
        Some(one) => Box::new(Expanding::by_temperature(
            inner,
            one.alpha.clone(),
            one.reference,
            one.free.value.given(),
        )),
        None => inner,
    })
}

fn elastic(part: &case::Material, found: &mut Diagnostics) -> Option<Box<dyn Material>> {
    let law = material::by_name(&part.model.value)?;
    let mut constants = Constants::default();
    for constant in &part.constants {
        constants.set(constant.name, constant.values.value.clone());
    }
    match (law.make)(&constants) {
        Ok(material) => Some(material),
        Err(error) => {
            found.push(unfit(&error, &part.name, place_of(part, &error)));
            None
        }
    }
}

fn plastic(
    part: &case::Material,
    plasticity: &case::Plasticity,
    found: &mut Diagnostics,
) -> Option<Box<dyn Material>> {
    let modulus = plasticity.modulus.as_ref().map_or(0.0, |m| m.value);
    let kind = match plasticity.hardening.value {
        case::Hardening::Isotropic => HardeningKind::Isotropic,
        case::Hardening::Kinematic => HardeningKind::Kinematic,
        case::Hardening::Combined => HardeningKind::Combined { modulus },
    };
    let (young, poisson) = (part.number("E")?, part.number("nu")?);
    let made = Hardening::new(kind, plasticity.table.value.clone())
        .and_then(|hardening| Plasticity::new(young, poisson, hardening));
    match made {
        Ok(material) => Some(Box::new(material)),
        Err(error) => {
            found.push(
                Diagnostic::error(&codes::OUT_OF_RANGE, error.to_string()).at(
                    &plasticity.table.place,
                    format!("in material {}", quoted(&part.name)),
                ),
            );
            None
        }
    }
}

/// Where the constant stands that an error speaks of.
fn place_of<'a>(part: &'a case::Material, error: &ConstantsError) -> &'a Place {
    let (ConstantsError::Missing { name }
    | ConstantsError::Several { name }
    | ConstantsError::Range { name, .. }) = error
    else {
        return &part.model.place;
    };
    let constant = part.constants.iter().find(|one| one.name == *name);
    constant.map_or(&part.model.place, |one| &one.values.place)
}

fn unfit(error: &ConstantsError, material: &Name, place: &Place) -> Diagnostic {
    Diagnostic::error(&codes::OUT_OF_RANGE, error.to_string())
        .at(place, format!("in material {}", quoted(material)))
}

/// A warning for each deformable body of linear triangles, tetrahedra or wedges.
pub(super) fn stiff_elements(case: &Case, names: &Names<'_>, mesh: &Mesh) -> Diagnostics {
    let mut found = Diagnostics::new();
    for body in case.bodies.iter().filter(|b| !b.rigid) {
        let groups = body.groups.iter();
        let cells = groups.flat_map(|g| names.cells(g, &mut Diagnostics::new()).solids);
        let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
        for element in cells.filter_map(|cell| mesh.element(cell)) {
            if element.locking_class() == LockingClass::ConstantStrain {
                *kinds.entry(element.name()).or_default() += 1;
            }
        }
        if kinds.is_empty() {
            continue;
        }
        let counts: Vec<String> = kinds.iter().map(|(k, n)| format!("{n} {k}")).collect();
        let group = body.groups.first().map_or("", |g| g.value.as_str());
        found.push(
            Diagnostic::warning(
                &codes::STIFF_ELEMENTS,
                format!("body \"{group}\" has {}: too stiff in bending", counts.join(", ")),
            )
            .at(&body.place, "")
            .help("use quad4 or hex8, elements of second order, or several over the thickness; allow = [\"S0404\"] silences"),
        );
    }
    found
}

/// What was chosen for each body, by its name.
pub(super) fn by_body(locking: &[LockingSummary]) -> BTreeMap<&str, Vec<&LockingSummary>> {
    let mut all: BTreeMap<&str, Vec<&LockingSummary>> = BTreeMap::new();
    for one in locking {
        all.entry(&one.body).or_default().push(one);
    }
    all
}
