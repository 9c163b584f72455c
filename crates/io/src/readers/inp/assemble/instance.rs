//! Copies of parts: moved, turned, and with what the instance adds.

use crate::readers::inp::deck::{Instance, Scope};
use crate::readers::inp::definition::Family;
use signorini_geometry::tensor::{Mat3, Vec3};

/// A part as an instance has it: moved, then turned.
pub(super) fn copy(part: &Scope, instance: &Instance) -> Scope {
    let shift = instance.translation;
    let turn = instance.rotation.and_then(|(a, b, angle)| {
        let axis = (b - a).normalized()?;
        Some((a, Mat3::rotation(axis * angle.to_radians())))
    });
    let place = |&x: &Vec3| match turn {
        Some((a, rotation)) => a + rotation * (x + shift - a),
        None => x + shift,
    };
    Scope {
        node_labels: part.node_labels.clone(),
        points: part.points.iter().map(place).collect(),
        node_spots: part.node_spots.clone(),
        element_labels: part.element_labels.clone(),
        element_kinds: part.element_kinds.clone(),
        element_spots: part.element_spots.clone(),
        element_cards: part.element_cards.clone(),
        connectivity: part.connectivity.clone(),
        definitions: part.definitions.clone(),
    }
}

/// Adds what an instance has of its own.
pub(super) fn append(scope: &mut Scope, own: Scope) {
    let (nnode, nelement) = (scope.points.len(), scope.element_labels.len());
    scope.node_labels.extend(own.node_labels);
    scope.points.extend(own.points);
    scope.node_spots.extend(own.node_spots);
    scope.element_labels.extend(own.element_labels);
    scope.element_kinds.extend(own.element_kinds);
    scope.element_spots.extend(own.element_spots);
    scope.element_cards.extend(own.element_cards);
    scope.connectivity.extend(own.connectivity);
    scope
        .definitions
        .extend(own.definitions.into_iter().map(|mut definition| {
            let shift = match definition.family {
                Family::Cells => nelement,
                _ => nnode,
            };
            let added = definition.added;
            definition.added = added.start + shift..added.end + shift;
            definition
        }));
}
