//! Axes of the materials of bodies.

use super::names::Names;
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::{Mat3, Vec3, turn_about};
use signorini_io::case::{AxesSystem, Body, BodyAxes, Case, MaterialSystem};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use signorini_mechanics::material::{Material, Oriented};
use signorini_mechanics::model::{BodyKind, BodyPart};
use signorini_mechanics::solid::{Cylindrical, MaterialAxes};
use std::collections::{HashMap, HashSet};

/// The law of a body, which takes the axes of points where the body has some.
pub(super) fn oriented(inner: Box<dyn Material>, body: &Body) -> Box<dyn Material> {
    match body.orientation {
        Some(_) => Box::new(Oriented::at_points(inner)),
        None => inner,
    }
}

/// The axes of the material in these cells of a body; nothing where it has none, or such as have been reported.
pub(super) fn axes(
    case: &Case,
    body: &Body,
    names: &Names<'_>,
    cells: &[CellId],
    found: &mut Diagnostics,
) -> Option<MaterialAxes> {
    let named = match body.orientation.as_ref()? {
        BodyAxes::Here(one) => {
            let axes = triad(one.x, one.y, &one.place, found)?;
            return Some(MaterialAxes::Uniform(axes));
        }
        BodyAxes::Named(name) => {
            let mut all = case.orientations.iter();
            all.find(|one| one.name.value == name.value)?
        }
    };
    let turn = named
        .turn
        .map_or(Mat3::IDENTITY, |(axis, angle)| turn_about(axis, angle));
    match &named.system {
        MaterialSystem::Rectangular { x, y } => {
            let axes = triad(*x, *y, &named.place, found)?;
            Some(MaterialAxes::Uniform(turn * axes))
        }
        MaterialSystem::Cylindrical { origin, axis } => {
            let around = Cylindrical::new(Vec3::from(*origin), Vec3::from(*axis));
            let Some(around) = around else {
                let message = "the axis of an orientation must be finite and not zero";
                let fault = Diagnostic::error(&codes::OUT_OF_RANGE, message);
                found.push(fault.at(&named.place, ""));
                return None;
            };
            Some(MaterialAxes::Cylindrical(around.turned(turn)))
        }
        MaterialSystem::Elements { x, y, rows } => {
            let default = turn * triad(*x, *y, &named.place, found)?;
            let of_element: HashMap<u64, _> = rows.iter().map(|row| (row.element, row)).collect();
            let mut all = Vec::with_capacity(cells.len());
            for &cell in cells {
                let row = names.element(cell).and_then(|label| of_element.get(&label));
                all.push(match row {
                    Some(row) => turn * triad(row.x, row.y, &row.place, found)?,
                    None => default,
                });
            }
            Some(MaterialAxes::OfCells(all))
        }
    }
}

/// Three axes, row by row: the first along `x`, the second in the plane of both.
fn triad(x: [f64; 3], y: [f64; 3], place: &Place, found: &mut Diagnostics) -> Option<Mat3> {
    let axes = AxesSystem::Rectangular { x, xy: y }.at(Vec3::ZERO);
    if axes.is_none() {
        let message =
            "the vectors x and y of an orientation must be finite, not zero and not parallel";
        found.push(Diagnostic::error(&codes::OUT_OF_RANGE, message).at(place, ""));
    }
    axes.map(Mat3::from_rows)
}

/// Elements that an orientation names, and that are in no body that deforms.
pub(super) fn axes_of_no_body(
    case: &Case,
    names: &Names<'_>,
    bodies: &[BodyPart],
    found: &mut Diagnostics,
) {
    let rows = case.orientations.iter().flat_map(|one| match &one.system {
        MaterialSystem::Elements { rows, .. } => &rows[..],
        _ => &[],
    });
    let mut rows = rows.peekable();
    if rows.peek().is_none() {
        return;
    }
    let solids = bodies
        .iter()
        .filter(|b| matches!(b.kind, BodyKind::Solid { .. }));
    let cells = solids.flat_map(|body| &body.cells);
    let known: HashSet<u64> = cells.filter_map(|&cell| names.element(cell)).collect();
    if let Some(row) = rows.find(|row| !known.contains(&row.element)) {
        let message = format!("element {} is in no solid body", row.element);
        let fault = Diagnostic::error(&codes::NOT_IN_MESH, message);
        found.push(fault.at(&row.place, "it is given axes here"));
    }
}
