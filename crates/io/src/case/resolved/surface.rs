//! Rigid surfaces.

use super::super::parts::*;
use super::write::{Entries, Value, chosen};

pub(super) fn surface(surface: &Surface) -> Entries {
    let shape = match &surface.shape {
        Shape::Analytical(shape) => chosen(shape),
        Shape::Stl { path } => ("stl", (&path.value).into()),
    };
    let mut entries = vec![
        ("name", (&surface.name.value).into()),
        ("shape", Value::Table(vec![shape])),
    ];
    let reference = surface.reference.as_ref();
    entries.extend(reference.map(|name| ("reference", (&name.value).into())));
    entries
}
