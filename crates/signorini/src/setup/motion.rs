//! What moves at the start, and masses at nodes and of references.

use super::carriers::Carriers;
use super::names::{Names, quoted};
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_io::case::{Case, MassAt, VelocityAt};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::model::{BodyKind, CarrierMass, CarrierVelocity, Parts};
use std::collections::HashMap;

/// Sets what moves at the start.
pub(super) fn velocities(
    case: &Case,
    (names, carriers): (&Names<'_>, &Carriers),
    mesh: &Mesh,
    parts: &mut Parts<'_>,
    found: &mut Diagnostics,
) {
    let Some(first) = case.initial_velocities.first() else {
        return;
    };
    if case.steps.first().is_some_and(|s| s.dynamics.is_none()) {
        let message = "velocities at the start of a static step mean nothing";
        found.push(
            Diagnostic::error(&codes::CONTRADICTION, message)
                .at(&first.place, "the first step is static")
                .help("delete them, or write  kind = \"dynamic\"  in the first [[step]]"),
        );
    }
    // what each node of a rigid body moves with
    let mut rigid: HashMap<NodeId, u32> = HashMap::new();
    for body in &parts.bodies {
        if let BodyKind::Rigid { carrier, .. } = body.kind {
            let nodes = body.cells.iter().flat_map(|&cell| mesh.cell(cell));
            rigid.extend(nodes.map(|&node| (node, carrier)));
        }
    }
    let mut velocities = vec![Vec3::ZERO; mesh.nnode()];
    for one in &case.initial_velocities {
        let [velocity, spin, about] = [one.velocity, one.spin, one.about].map(Vec3::from);
        let mut moving: Vec<u32> = carriers.get(&one.on).into_iter().collect();
        if moving.is_empty() {
            let nodes = names.nodes(&one.on, found).unwrap_or_default();
            for node in nodes {
                let place = mesh.points.get(node as usize);
                if let (Some(to), Some(place)) = (velocities.get_mut(node as usize), place) {
                    *to = velocity + spin.cross(*place - about);
                }
                moving.extend(rigid.get(&node));
            }
            moving.sort_unstable();
            moving.dedup();
        }
        if moving.iter().any(|&carrier| !carriers.has_mass(carrier)) {
            found.push(without_mass(one));
        }
        let with = |carrier| CarrierVelocity {
            carrier,
            velocity,
            spin,
            about,
        };
        parts
            .carrier_velocities
            .extend(moving.into_iter().map(with));
    }
    parts.velocity = velocities;
}

fn without_mass(one: &VelocityAt) -> Diagnostic {
    let message = "a rigid body without mass has no velocity at the start";
    Diagnostic::error(&codes::MISSING, message)
        .at(&one.on.place, "names one")
        .help("write a [[mass]] on it, or a `material` with a `density` in its [[body]]; or prescribe its motion by [[step.move]]")
}

/// Sets masses at nodes and of references.
pub(super) fn masses(
    case: &Case,
    (names, carriers): (&Names<'_>, &Carriers),
    parts: &mut Parts<'_>,
    found: &mut Diagnostics,
) {
    for one in &case.masses {
        let Some(carrier) = carriers.get(&one.on) else {
            refuse_extent(one, found);
            let nodes = names.nodes(&one.on, found).unwrap_or_default();
            parts
                .masses
                .extend(nodes.into_iter().map(|node| (node, one.value)));
            continue;
        };
        let [xx, yy, zz, xy, xz, yz] = one.inertia.as_ref().map_or([0.0; 6], |of| of.value);
        let inertia = Sym3::new(xx, yy, zz, xy, yz, xz);
        let smallest = inertia.eigenvalues().into_iter().fold(0.0, f64::min);
        if smallest < -1e-12 * inertia.trace().abs()
            && let Some(of) = &one.inertia
        {
            let message = "moments of inertia that no body has";
            found.push(
                Diagnostic::error(&codes::OUT_OF_RANGE, message)
                    .at(&of.place, "their smallest principal value is negative"),
            );
        }
        parts.carrier_masses.push(CarrierMass {
            carrier,
            mass: one.value,
            centroid: one.centroid.as_ref().map(|at| Vec3::from(at.value)),
            inertia,
        });
    }
}

/// Refuses what masses at nodes do not have.
fn refuse_extent(one: &MassAt, found: &mut Diagnostics) {
    let centroid = one.centroid.as_ref().map(|of| ("centroid", &of.place));
    let inertia = one.inertia.as_ref().map(|of| ("inertia", &of.place));
    for (key, place) in centroid.into_iter().chain(inertia) {
        let message = format!("`{key}` of a mass at nodes");
        let remark = format!("{} is no reference and no rigid body", quoted(&one.on));
        found.push(
            Diagnostic::error(&codes::CONTRADICTION, message)
                .at(place, remark)
                .help("delete it; or name a [reference] with a [[constraint]] or rigid [[body]]"),
        );
    }
}
