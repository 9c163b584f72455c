//! What an interface is made from.

use super::conducting::ContactHeat;
use super::wet::Fluid;
use crate::contact::cohesion::Cohesion;
use crate::contact::discretization::{Anchored, BentSides, Discretization, SurfacePair};
use crate::contact::friction::{FrictionLaw, Stick};
use crate::contact::law::{ContactLaw, Damping, Gasket, Penalty, Scale};
use crate::system::ReportedAs;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::SurfaceError;
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// What a unit of the law's pressure acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The tributary area of the row.
    Area,
    /// The row itself: the law gives forces.
    Node,
}

/// What a step makes of a contact.
#[derive(Clone)]
pub struct ContactPhase {
    /// Whether it acts.
    pub active: bool,
    /// Its friction; `None`: none.
    pub friction: Option<(Arc<dyn FrictionLaw>, Stick)>,
    /// Whether this interface stands for the contact, and not another one with other facets of it.
    pub stands: bool,
    /// Whether the elements of its facets take part.
    pub present: bool,
    /// How far its sides slide for wear, in the whole step; `None`: as they move.
    pub slip: Option<f64>,
}

/// What is added to the gap of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shift {
    /// Always.
    pub constant: f64,
    /// At the start of the first step in which the contact acts; it fades to nothing over that step.
    pub fading: f64,
}

/// Which increments of the first step in which a contact acts allow for overlaps at their start, which fade to
/// nothing over the rest of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Allowance {
    /// None does: overlaps allowed for are in [`Shift`].
    #[default]
    Never,
    /// The first; the rest at its end is resolved at once.
    First,
    /// Every one.
    Every,
}

/// Gaps that are measured between the surfaces that straight facets were cut from.
///
/// What the facets miss is found for every iterate, so that residuals know where sides have slid to. Tangents do not know how
/// it changes: that is less than half the angle by which facets turn, times what slides.
#[derive(Clone, Debug, Default)]
pub struct Bend {
    /// These surfaces.
    pub sides: BentSides,
    /// By how much the gap of each row exceeds that between these, at the start (length).
    pub rises: Vec<f64>,
    /// Whether that is found again for each iterate: where sides slide.
    pub slides: bool,
}

/// Tributary areas of all rows, from the positions of all nodes.
pub type Areas =
    Box<dyn Fn(&dyn Discretization, &[Vec3]) -> Result<Vec<f64>, SurfaceError> + Send + Sync>;

/// How the sides of an interface wear.
#[derive(Clone, Debug, PartialEq)]
pub struct WearParts {
    /// Depth per pressure and way, of the secondary side and of the primary one.
    pub coefficients: [f64; 2],
    /// Nodes of the primary side with their areas, sorted; empty where it does not wear.
    pub areas: Vec<(NodeId, f64)>,
}

/// What an interface is made of.
pub struct InterfaceParts {
    /// Its name.
    pub name: String,
    /// The two sides.
    pub pair: SurfacePair,
    /// How they are compared.
    pub discretization: Box<dyn Discretization>,
    /// The contact law.
    pub law: Arc<dyn ContactLaw>,
    /// The same, where it is one with a past.
    pub gasket: Option<Arc<Gasket>>,
    /// What becomes of it in each step; the last goes on.
    pub phases: Vec<ContactPhase>,
    /// Whether sticking points remember a traction, not a place. Then those that close are without friction until the
    /// increment has ended.
    pub remembers_traction: bool,
    /// Whether the sides are joined where they are at the start: each row sticks to its anchor, if it has one.
    pub bond: Option<Vec<Option<Anchored>>>,
    /// The stiffness of such a bond within the tangent plane at the start of each increment, if the law is a penalty;
    /// `None`: as along the normal.
    pub bond_tangential: Option<f64>,
    /// How such a bond breaks, in tractions and with a law that is a penalty; `None`: it does not.
    pub cohesion: Option<Cohesion>,
    /// What the law's pressure acts on.
    pub measure: Measure,
    /// Tributary area of each row; empty where the secondary side has none.
    pub area: Vec<f64>,
    /// Tributary areas at the start of each increment, where they change.
    pub areas: Option<Areas>,
    /// The numbers the law scales with.
    pub scale: Scale,
    /// What is added to the gap of each row; empty where nothing is.
    pub shifts: Vec<Shift>,
    /// Which increments allow for what overlaps at their start.
    pub allowance: Allowance,
    /// A fluid that may come between the sides.
    pub fluid: Option<Fluid>,
    /// What damps the motion of closed rows, of laws without a multiplier.
    pub damping: Damping,
    /// How heat goes across it, where temperatures are unknowns.
    pub heat: Option<ContactHeat>,
    /// How its sides wear; `None`: not.
    pub wear: Option<WearParts>,
    /// Whether no side yields.
    pub is_rigid: bool,
    /// The velocity of rows that leave an impact over that with which they came, where impulses act.
    pub restitution: f64,
    /// The surfaces that straight facets were cut from, where gaps are measured between these.
    pub bend: Option<Bend>,
    /// The first multiplier, where the law solves for them: one for each row, and with friction, or joined, one for each
    /// row and direction.
    pub first_multiplier: usize,
    /// The gap up to which a multiplier method may leave a contact open or penetrated, as a length.
    pub gap_tolerance: f64,
    /// What multipliers that friction limits may be off by, over themselves.
    pub traction_tolerance: f64,
    /// Whether pressures of quadratic triangles are smoothed in results.
    pub smooths: bool,
    /// Whether it is the second pass of a contact, whose results belong to the first with the sides swapped.
    pub swapped: bool,
    /// How histories report it, where that is not by its own name.
    pub reported_as: Option<ReportedAs>,
    /// Which of the interfaces of a contact it is, whose facets take part only in some steps.
    pub variant: usize,
}

impl InterfaceParts {
    /// A linear penalty without friction, in force per gap of each row.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        pair: SurfacePair,
        discretization: Box<dyn Discretization>,
        penalty: f64,
    ) -> Self {
        Self {
            name: name.into(),
            pair,
            discretization,
            law: Arc::new(Penalty),
            gasket: None,
            phases: Vec::new(),
            remembers_traction: false,
            bond: None,
            bond_tangential: None,
            cohesion: None,
            measure: Measure::Node,
            area: Vec::new(),
            areas: None,
            scale: Scale {
                penalty,
                shear: penalty,
                length: 1.0,
            },
            shifts: Vec::new(),
            heat: None,
            is_rigid: false,
            allowance: Allowance::default(),
            fluid: None,
            damping: Damping::default(),
            wear: None,
            restitution: 0.0,
            bend: None,
            first_multiplier: 0,
            gap_tolerance: 1e-6,
            traction_tolerance: 1e-7,
            smooths: false,
            swapped: false,
            reported_as: None,
            variant: 0,
        }
    }

    /// Multipliers of one row.
    #[must_use]
    pub fn nmultiplier(&self, ndim: usize) -> usize {
        nmultiplier(self.law.as_ref(), self.has_vectors(), ndim)
    }

    /// Whether multipliers are tractions.
    pub(super) fn has_vectors(&self) -> bool {
        self.bond.is_some() || self.phases.iter().any(|p| p.friction.is_some())
    }
}

/// Multipliers of one row: tractions with friction in any step, and of bonds.
#[must_use]
pub fn nmultiplier(law: &dyn ContactLaw, vectors: bool, ndim: usize) -> usize {
    match (law.multiplier().is_unknown(), vectors) {
        (false, _) => 0,
        (true, false) => 1,
        (true, true) => ndim,
    }
}
