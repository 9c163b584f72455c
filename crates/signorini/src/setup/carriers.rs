//! References and rigid bodies: what moves as a whole, and its names.

use super::ReferenceInfo;
use super::names::{Names, quoted};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{Case, ConstraintKind, Name, Position};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::model::CarrierPart;
use std::collections::{BTreeMap, BTreeSet};

/// The carriers of a model: references first, then the points of rigid bodies that have none, then the frames of joints of shells.
pub(super) struct Carriers {
    parts: Vec<CarrierPart>,
    /// The number of the first one of a joint.
    joints: usize,
    /// References, and every group of a rigid body.
    by_name: BTreeMap<String, RigidId>,
    /// Those that something moves with.
    in_use: BTreeSet<RigidId>,
    /// Those that have a mass.
    heavy: BTreeSet<RigidId>,
}

impl Carriers {
    pub fn new(case: &Case, names: &Names<'_>, found: &mut Diagnostics) -> Self {
        let mut carriers = Self {
            parts: Vec::new(),
            joints: 0,
            by_name: BTreeMap::new(),
            in_use: BTreeSet::new(),
            heavy: BTreeSet::new(),
        };
        for one in &case.references {
            let at = match one.position {
                Position::At(point) => Some(Vec3::from(point)),
                Position::Node(label) => names.point(label),
                Position::Mean => None,
            };
            if let (None, Position::Node(label)) = (at, one.position) {
                let message = format!("the mesh has no node {label}");
                let message = Diagnostic::error(&codes::NOT_IN_MESH, message);
                let remark = format!("of reference \"{}\"", one.name.value);
                found.push(message.at(&one.place, remark));
            }
            let carrier = carriers.push(&one.name, at);
            carriers.by_name.insert(one.name.value.clone(), carrier);
        }
        for body in case.bodies.iter().filter(|body| body.rigid) {
            let reference = body.reference.as_ref().and_then(|name| carriers.get(name));
            let first = body.groups.first().map_or("", |group| group.as_str());
            let carrier = reference.unwrap_or_else(|| carriers.push(first, None));
            carriers.in_use.insert(carrier);
            if body.material.is_some() {
                carriers.heavy.insert(carrier);
            }
            for group in &body.groups {
                carriers.by_name.insert(group.value.clone(), carrier);
            }
        }
        let masses = case.masses.iter();
        let masses: Vec<RigidId> = masses.filter_map(|one| carriers.get(&one.on)).collect();
        carriers.heavy.extend(&masses);
        carriers.in_use.extend(&masses);
        let of_surfaces = case
            .surfaces
            .iter()
            .filter_map(|one| one.reference.as_ref());
        for name in of_surfaces {
            let used = carriers.get(name);
            carriers.in_use.extend(used);
        }
        for constraint in &case.constraints {
            match &constraint.kind {
                ConstraintKind::Equation { terms, .. } => {
                    let used = terms.iter().filter_map(|term| carriers.get(&term.on));
                    let used: Vec<RigidId> = used.collect();
                    carriers.in_use.extend(used);
                }
                ConstraintKind::Kinematic { reference, .. }
                | ConstraintKind::Distributing { reference, .. }
                | ConstraintKind::Twist { reference, .. }
                | ConstraintKind::Pretension { reference, .. } => {
                    let used = carriers.get(reference);
                    carriers.in_use.extend(used);
                }
                ConstraintKind::Plane { .. }
                | ConstraintKind::Line { .. }
                | ConstraintKind::Equal { .. }
                | ConstraintKind::Distance { .. }
                | ConstraintKind::Cyclic { .. } => {}
            }
        }
        carriers.joints = carriers.parts.len();
        carriers.parts.extend(names.shells().joints().carriers());
        carriers
    }

    fn push(&mut self, name: &str, at: Option<Vec3>) -> RigidId {
        self.parts.push(CarrierPart {
            name: name.to_owned(),
            at,
        });
        (self.parts.len() - 1) as RigidId
    }

    /// The carrier of a reference or rigid body.
    pub fn get(&self, name: &str) -> Option<RigidId> {
        self.by_name.get(name).copied()
    }

    /// Whether a body or nodes move with it.
    pub fn moves_something(&self, carrier: RigidId) -> bool {
        self.in_use.contains(&carrier)
    }

    /// Whether it has a mass.
    pub fn has_mass(&self, carrier: RigidId) -> bool {
        self.heavy.contains(&carrier)
    }

    /// Whether some have a mass.
    pub fn has_heavy(&self) -> bool {
        !self.heavy.is_empty()
    }

    /// The one name, of those a carrier has, that histories use.
    pub fn called(&self, name: &str) -> Option<&str> {
        let part = self.parts.get(self.get(name)? as usize)?;
        Some(&part.name)
    }

    /// Where it is, as far as that was given.
    pub fn place(&self, carrier: RigidId) -> Option<Vec3> {
        self.parts.get(carrier as usize).and_then(|part| part.at)
    }

    pub fn parts(&self) -> Vec<CarrierPart> {
        self.parts.clone()
    }

    /// The number of the first one of a joint of shells.
    pub const fn first_of_joints(&self) -> usize {
        self.joints
    }

    pub fn infos(&self) -> Vec<ReferenceInfo> {
        let parts = self.parts.iter().take(self.joints).enumerate();
        let info = |(number, part): (usize, &CarrierPart)| ReferenceInfo {
            name: part.name.clone(),
            rigid: number as RigidId,
        };
        parts.map(info).collect()
    }
}

/// A reference that is loaded or moved, and that nothing follows.
pub(super) fn idle(reference: &Name) -> Diagnostic {
    Diagnostic::error(
        &codes::CONTRADICTION,
        format!("reference {} moves nothing", quoted(reference)),
    )
    .at(&reference.place, "no body and no constraint names it")
    .help("write  reference = \"..\"  in a rigid [[body]] or in a [[constraint]]")
}
