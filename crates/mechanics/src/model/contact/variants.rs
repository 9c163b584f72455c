//! Contacts of facets that take part only in some steps.
//!
//! A facet takes part as its element does. For every set of facets that take part in some step a contact has an interface of
//! its own, which stands for the contact in the steps that have this set. What friction and joints remember starts again
//! where the set changes.

use crate::model::{ContactPart, Interference, PrimaryPart, SidePart, StartPart};
use crate::system::Activity;
use signorini_geometry::mesh::{Face, NodeId};

/// A contact with the facets that take part in some steps.
pub(in crate::model) struct Variant {
    pub part: ContactPart,
    /// Of each step, whether it stands for the contact there; empty: in all.
    stands: Vec<bool>,
    /// Of each step, whether both its sides have facets there; empty: in all.
    acts: Vec<bool>,
}

impl Variant {
    /// Whether it stands for the contact in a step, and whether it may act there.
    pub fn in_step(&self, step: usize) -> [bool; 2] {
        [&self.stands, &self.acts].map(|of| of.get(step).copied().unwrap_or(true))
    }
}

/// The sides of a contact as far as they take part in a step; `None` where one has nothing that does.
fn sides(part: &ContactPart, activity: &Activity, step: usize) -> Option<(SidePart, PrimaryPart)> {
    let of_faces = |faces: &[Face]| -> Vec<Face> {
        let active = faces
            .iter()
            .filter(|face| activity.is_active(face.cell, step));
        active.copied().collect()
    };
    let of_nodes = |nodes: &[NodeId]| -> Vec<NodeId> {
        let active = nodes.iter().filter(|node| !activity.is_idle(**node, step));
        active.copied().collect()
    };
    let (secondary, is_bare) = match &part.secondary {
        SidePart::Faces(faces) => {
            let faces = of_faces(faces);
            let none = faces.is_empty();
            (SidePart::Faces(faces), none)
        }
        SidePart::Nodes(nodes) => {
            let nodes = of_nodes(nodes);
            let none = nodes.is_empty();
            (SidePart::Nodes(nodes), none)
        }
    };
    let (primary, is_missing) = match &part.primary {
        PrimaryPart::Faces(faces) => {
            let faces = of_faces(faces);
            let none = faces.is_empty();
            (PrimaryPart::Faces(faces), none)
        }
        PrimaryPart::Nodes(nodes) => {
            let nodes = of_nodes(nodes);
            let none = nodes.is_empty();
            (PrimaryPart::Nodes(nodes), none)
        }
        other => (other.clone(), false),
    };
    (!is_bare && !is_missing).then_some((secondary, primary))
}

/// What becomes of overlaps at the start: those of the undeformed bodies are resolved once.
fn start(part: &ContactPart, step: usize) -> StartPart {
    let interference = match part.start.interference {
        given if step == 0 => given,
        Interference::StrainFree => Interference::StrainFree,
        _ => Interference::AtOnce,
    };
    StartPart {
        interference,
        ..part.start.clone()
    }
}

/// Whether two primary sides are the same.
fn alike(a: &PrimaryPart, b: &PrimaryPart) -> bool {
    match (a, b) {
        (PrimaryPart::Faces(a), PrimaryPart::Faces(b)) => a == b,
        (PrimaryPart::Nodes(a), PrimaryPart::Nodes(b)) => a == b,
        // rigid surfaces, and a side itself, do not change
        _ => true,
    }
}

/// What a contact becomes: itself, where its facets take part in all steps.
pub(super) fn variants(part: &ContactPart, activity: &Activity) -> Vec<Variant> {
    let mut all: Vec<Variant> = Vec::new();
    let nstep = if activity.is_empty() {
        0
    } else {
        activity.nstep()
    };
    for step in 0..nstep {
        let Some((secondary, primary)) = sides(part, activity, step) else {
            continue;
        };
        let known = all.iter_mut().find(|variant| {
            variant.part.secondary == secondary && alike(&variant.part.primary, &primary)
        });
        let variant = match known {
            Some(known) => known,
            None => {
                all.push(Variant {
                    part: ContactPart {
                        secondary,
                        primary,
                        start: start(part, step),
                        ..part.clone()
                    },
                    stands: vec![false; nstep],
                    acts: vec![false; nstep],
                });
                match all.last_mut() {
                    Some(new) => new,
                    None => continue,
                }
            }
        };
        for of in [&mut variant.stands, &mut variant.acts] {
            if let Some(of) = of.get_mut(step) {
                *of = true;
            }
        }
    }
    let never = |step: usize| !all.iter().any(|one| one.stands.get(step) == Some(&true));
    let without: Vec<usize> = (0..nstep).filter(|&step| never(step)).collect();
    match all.first_mut() {
        // somebody has to report that nothing acts
        Some(first) => {
            for step in without {
                if let Some(stands) = first.stands.get_mut(step) {
                    *stands = true;
                }
            }
        }
        None => all.push(Variant {
            part: part.clone(),
            stands: Vec::new(),
            acts: vec![nstep == 0; nstep],
        }),
    }
    all
}
