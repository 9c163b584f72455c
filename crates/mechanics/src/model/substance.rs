//! The density and section of a body, as loads see them.

use super::{BodyKind, BodyPart, MassPart};
use crate::solid::Integration;
use crate::system::Idealisation;
use signorini_geometry::surface::RigidId;
use std::sync::Arc;

/// What loads want to know of a body.
pub(super) struct Substance {
    pub name: String,
    pub density: Option<f64>,
    pub mass: MassPart,
    pub deforms: bool,
    pub conducts: bool,
    /// What it moves with, where it is rigid.
    pub carrier: Option<RigidId>,
    /// Cross-section of bars.
    pub section: Option<f64>,
    pub integration: Integration,
    pub space: Idealisation,
    /// What the thickness is multiplied by at nodes.
    pub profile: Option<Arc<[f64]>>,
}

impl Substance {
    pub fn new(body: &BodyPart, of_model: Idealisation) -> Self {
        let mut of = Self {
            name: body.name.clone(),
            density: None,
            mass: MassPart::default(),
            deforms: !matches!(body.kind, BodyKind::Rigid { .. }),
            conducts: matches!(&body.kind, BodyKind::Solid { heat: Some(_), .. }),
            carrier: None,
            section: None,
            integration: Integration::Full,
            space: body.kind.space(of_model),
            profile: body.kind.profile().cloned(),
        };
        match body.kind {
            BodyKind::Solid {
                density,
                mass,
                integration,
                ..
            } => {
                (of.density, of.mass) = (density, mass);
                of.integration = integration;
            }
            BodyKind::Truss {
                density,
                mass,
                area,
                ..
            } => {
                (of.density, of.mass) = (density, mass);
                of.section = Some(area);
            }
            BodyKind::Rigid { carrier, density } => {
                (of.carrier, of.density) = (Some(carrier), density);
            }
        }
        of
    }
}
