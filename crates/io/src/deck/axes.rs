//! Directions of nodes: along the axes of the model, or along local ones.

use crate::case::{Name, Summand};
use crate::diagnostic::Spanned;
use signorini_geometry::tensor::Vec3;

/// The unit vector along an axis.
pub(super) fn unit(axis: usize) -> Vec3 {
    Vec3::from(std::array::from_fn(|i| f64::from(u8::from(i == axis))))
}

/// A vector of a local system in the global one.
pub(super) fn global(axes: &[Vec3; 3], axis: usize, value: f64) -> Vec3 {
    axes.get(axis).map_or(Vec3::ZERO, |e| *e * value)
}

/// What is left of a component of a unit vector is round-off.
const ROUND_OFF: f64 = 1e-14;

/// The displacement of a node along a direction, times a coefficient.
pub(super) fn along(on: Name, direction: Vec3, coefficient: f64, ndim: usize) -> Vec<Summand> {
    let components = direction.to_array().into_iter().take(ndim).enumerate();
    components
        .filter(|(_, part)| part.abs() > ROUND_OFF)
        .map(|(component, part)| Summand {
            on: on.clone(),
            component: Spanned::new(component, on.place.clone()),
            coefficient: coefficient * part,
        })
        .collect()
}
