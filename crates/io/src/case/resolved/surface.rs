//! Rigid surfaces.

use super::super::parts::*;
use super::write::{Entries, Value, list};

pub(super) fn surface(surface: &Surface, ndim: usize) -> Entries {
    let mut entries = vec![
        ("name", (&surface.name.value).into()),
        ("shape", Value::Table(vec![shape(&surface.shape, ndim)])),
    ];
    let reference = surface.reference.as_ref();
    entries.extend(reference.map(|name| ("reference", (&name.value).into())));
    entries
}

fn shape(shape: &Shape, ndim: usize) -> (&'static str, Value) {
    let side = |facing: &Facing| {
        let word = match facing {
            Facing::Outside => "outside",
            Facing::Inside => "inside",
        };
        ("side", word.into())
    };
    let (key, entries) = match shape {
        Shape::Plane { point, normal } => (
            "plane",
            vec![("point", point.into()), ("normal", normal.into())],
        ),
        Shape::Sphere {
            center,
            radius,
            facing,
        } => (
            if ndim == 2 { "circle" } else { "sphere" },
            vec![
                ("center", center.into()),
                ("radius", (*radius).into()),
                side(facing),
            ],
        ),
        Shape::Cylinder {
            point,
            axis,
            radius,
            facing,
        } => (
            "cylinder",
            vec![
                ("point", point.into()),
                ("axis", axis.into()),
                ("radius", (*radius).into()),
                side(facing),
            ],
        ),
        Shape::Cone {
            apex,
            axis,
            half_angle,
        } => (
            "cone",
            vec![
                ("apex", apex.into()),
                ("axis", axis.into()),
                ("half_angle", (*half_angle).into()),
            ],
        ),
        Shape::Torus {
            center,
            axis,
            radius,
            tube,
            facing,
        } => (
            "torus",
            vec![
                ("center", center.into()),
                ("axis", axis.into()),
                ("radius", (*radius).into()),
                ("tube", (*tube).into()),
                side(facing),
            ],
        ),
        Shape::Polynomial {
            coefficients,
            above,
        } => (
            "polynomial",
            vec![
                ("coefficients", list(coefficients.iter().copied())),
                ("side", if *above { "above" } else { "below" }.into()),
            ],
        ),
        Shape::Stl { path } => return ("stl", (&path.value).into()),
    };
    (key, Value::Table(entries))
}
