//! From shells of a mesh to solids.

use super::mirrors;
use super::solids::Shells;
use crate::setup::names::Names;
use crate::setup::quoted;
use signorini_geometry::expansion::{
    Expansion, ExpansionError, Joining, Section, ShellCell, expand,
};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{Body, Case, ConstraintKind, DynamicMethod, Shell, Thickness};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use std::collections::BTreeMap;

/// The shells of a body.
struct OfBody<'a> {
    shell: &'a Shell,
    cells: Vec<CellId>,
}

/// Puts solids in the place of shells.
///
/// # Errors
/// What makes no shells, with all messages there are.
pub(in crate::setup) fn expanded(
    case: &Case,
    mesh: Mesh,
    mut found: Diagnostics,
) -> Result<(Mesh, Shells, Diagnostics), Diagnostics> {
    let shells = case.bodies.iter();
    let shells = shells.filter_map(|body| Some((body, body.shell.as_ref()?)));
    let shells: Vec<_> = shells.collect();
    if shells.is_empty() {
        return Ok((mesh, Shells::default(), found));
    }
    not_built(case, &mut found);
    let none = Shells::default();
    // sides of shells are not there yet; what is wrong with sets is reported when they are
    let names = Names::of_surfaces(case, &mesh, &none, &mut Diagnostics::new());
    let thicknesses = names.thicknesses(case, &mut found);
    // 0 where the case gives none
    let known = |&thickness: &f64| {
        if thickness == 0.0 {
            f64::NAN
        } else {
            thickness
        }
    };
    let at_nodes: Vec<f64> = thicknesses.iter().map(known).collect();
    let of_bodies = shells.into_iter().filter_map(|(body, shell)| {
        let cells = surfaces(body, &names, &mesh, &mut found)?;
        lacks_thickness(body, shell, (&names, &cells, &at_nodes), &mut found)?;
        Some(OfBody { shell, cells })
    });
    let of_bodies: Vec<OfBody<'_>> = of_bodies.collect();
    if found.has_errors() {
        return Err(found);
    }
    let Some(expansion) = solids((case, &names), &of_bodies, &mesh, &at_nodes, &mut found) else {
        return Err(found);
    };
    let cells = of_bodies.iter().flat_map(|of| of.cells.iter().copied());
    let cells: Vec<CellId> = cells.collect();
    let (mesh, shells) = Shells::new(expansion, &cells, &mesh);
    Ok((mesh, shells, found))
}

/// Refuses what shells do not do yet.
fn not_built(case: &Case, found: &mut Diagnostics) {
    let mut refuse = |text: &str, place: &Place, remark: &str| {
        found.push(Diagnostic::error(&codes::NOT_BUILT, text).at(place, remark));
    };
    for step in &case.steps {
        let method = step.dynamics.as_ref().map(|dynamics| dynamics.method);
        if let Some(DynamicMethod::Explicit { .. }) = method {
            let text = "shells have no masses at nodes for explicit steps yet";
            refuse(text, &step.place, "use an implicit method");
        }
        if step.thermal.is_some() {
            let text = "heat in shells is not built yet";
            refuse(
                text,
                &step.place,
                "prescribe temperatures by [[step.temperature]] in static steps",
            );
        }
    }
    for body in case.bodies.iter().filter(|body| body.shell.is_some()) {
        let named = body.material.as_ref();
        let material = case
            .materials
            .iter()
            .find(|one| named.is_some_and(|name| one.name.value == name.value));
        if material.is_some_and(|one| one.damping.stiffness > 0.0) {
            refuse(
                "stiffness damping of shells is not built yet",
                &body.place,
                "its material has some",
            );
        }
    }
    for one in &case.constraints {
        if let ConstraintKind::Pretension { on, .. } = &one.kind {
            refuse(
                "pretension does not cut models with shells yet",
                &on.place,
                "",
            );
        }
    }
}

/// The cells of a body of shells.
fn surfaces(
    body: &Body,
    names: &Names<'_>,
    mesh: &Mesh,
    found: &mut Diagnostics,
) -> Option<Vec<CellId>> {
    let mut cells = Vec::new();
    for group in &body.groups {
        let of_group = names.cells_of(group, found)?;
        let is_surface = |cell: &CellId| mesh.element(*cell).is_some_and(|e| e.dim() == 2);
        let before = cells.len();
        cells.extend(of_group.iter().copied().filter(is_surface));
        if cells.len() == before {
            let text = format!("{} has no triangles and no quadrilaterals", quoted(group));
            let one = Diagnostic::error(&codes::WRONG_KIND, text);
            found.push(one.at(&group.place, "a shell is made of elements of a surface"));
            return None;
        }
    }
    Some(cells)
}

/// Refuses a shell that takes its thickness from nodes where one has none.
fn lacks_thickness(
    body: &Body,
    shell: &Shell,
    (names, cells, at_nodes): (&Names<'_>, &[CellId], &[f64]),
    found: &mut Diagnostics,
) -> Option<()> {
    if shell.thickness.value != Thickness::Field {
        return Some(());
    }
    let has_none = |node: &NodeId| at_nodes.get(*node as usize).is_none_or(|t| t.is_nan());
    let around = names.nodes_around(cells.iter().copied());
    let Some(node) = around.into_iter().find(has_none) else {
        return Some(());
    };
    let text = format!(
        "{} takes its thickness from nodes, and node {} has none",
        quoted(body.groups.first()?),
        names.label(node)
    );
    let one = Diagnostic::error(&codes::MISSING, text).at(&shell.thickness.place, "");
    found.push(one.help("write  [[thickness]] on = , value =  for all of its nodes"));
    None
}

/// The solids of all shells.
fn solids(
    (case, names): (&Case, &Names<'_>),
    of_bodies: &[OfBody<'_>],
    mesh: &Mesh,
    at_nodes: &[f64],
    found: &mut Diagnostics,
) -> Option<Expansion> {
    let section = |of: &OfBody<'_>| match of.shell.thickness.value {
        Thickness::Uniform(thickness) => Section {
            thickness,
            at_nodes: None,
            offset: of.shell.offset,
        },
        Thickness::Field => Section {
            thickness: 0.0,
            at_nodes: Some(at_nodes),
            offset: of.shell.offset,
        },
    };
    let sections: Vec<Section<'_>> = of_bodies.iter().map(section).collect();
    let cells = of_bodies.iter().enumerate().flat_map(|(section, of)| {
        let cells = of.cells.iter();
        cells.map(move |&cell| ShellCell { cell, section })
    });
    let cells: Vec<ShellCell> = cells.collect();
    let angles = of_bodies
        .iter()
        .map(|of| of.shell.normals.value.to_radians());
    let angle = angles.fold(f64::INFINITY, f64::min);
    let expanded = |given: &BTreeMap<(CellId, NodeId), Vec3>| {
        let joining = Joining { angle, given };
        expand(mesh, &cells, &sections, &joining)
    };
    let expansion = expanded(&BTreeMap::new()).and_then(|expansion| {
        let mirrored = mirrors::normals(case, names, mesh, &cells, &expansion);
        match mirrored.is_empty() {
            true => Ok(expansion),
            false => expanded(&mirrored),
        }
    });
    match expansion {
        Ok(expansion) => Some(expansion),
        Err(error) => {
            found.push(refused(&error, of_bodies));
            None
        }
    }
}

fn refused(error: &ExpansionError, of_bodies: &[OfBody<'_>]) -> Diagnostic {
    let one = Diagnostic::error(&codes::BAD_ELEMENTS, error.to_string());
    match of_bodies.first() {
        Some(of) => one.at(&of.shell.place, "in the shells of this case"),
        None => one,
    }
}
