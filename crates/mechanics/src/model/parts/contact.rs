//! Contacts, as plain data.

use crate::contact::cohesion::{
    Bilinear, Cohesion, CohesionError, CohesiveLaw, Exponential, Initiation, Mixity,
};
use crate::contact::discretization::{SlidingRange, mortar};
use crate::contact::friction::{Coulomb, FrictionLaw};
use crate::contact::law::{ContactLaw, Damping, Gasket};
use crate::contact::{ContactHeat, Critical, Measure};
use crate::system::ReportedAs;
use signorini_geometry::mesh::{Face, NodeId};
use signorini_geometry::surface::ContactSurface;
use signorini_geometry::tensor::Vec3;
use std::fmt;
use std::sync::Arc;

/// The side of a contact that carries points.
#[derive(Clone, Debug, PartialEq)]
pub enum SidePart {
    /// Faces of solids.
    Faces(Vec<Face>),
    /// Bare nodes.
    Nodes(Vec<NodeId>),
}

/// The side of a contact that points are projected onto.
#[derive(Clone)]
pub enum PrimaryPart {
    /// Faces of solids.
    Faces(Vec<Face>),
    /// Bare nodes: for node-to-node contact.
    Nodes(Vec<NodeId>),
    /// A rigid analytical or triangulated surface.
    Surface(Arc<dyn ContactSurface>),
    /// The secondary side itself: self-contact.
    Itself,
}

impl fmt::Debug for PrimaryPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Faces(faces) => f.debug_tuple("Faces").field(faces).finish(),
            Self::Nodes(nodes) => f.debug_tuple("Nodes").field(nodes).finish(),
            Self::Surface(surface) => f.debug_tuple("Surface").field(&surface.nfacet()).finish(),
            Self::Itself => f.write_str("Itself"),
        }
    }
}

/// How the two sides are compared.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Method {
    /// What suits the sides.
    #[default]
    Auto,
    /// Nodes of one side against nodes of the other.
    NodeToNode {
        /// Where the normals come from.
        normals: Normals,
        /// Which nodes meet.
        pairs: PairOrder,
    },
    /// Nodes of the secondary side against segments of the primary side.
    NodeToSegment,
    /// Points inside the secondary facets against segments of the primary side.
    GaussPoint(PointRule),
    /// Means over secondary facets against all facets of the primary side that they meet.
    Mortar(mortar::Form),
}

impl Method {
    /// Whether multipliers prevent penetration, unless something else is given.
    #[must_use]
    pub fn takes_multipliers(&self) -> bool {
        matches!(self, Self::Mortar(_))
    }
}

/// Where node-to-node contact takes its normals from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Normals {
    /// The averaged normal of the primary side at its node; it turns with the side.
    #[default]
    Primary,
    /// The opposite of the averaged normal of the secondary side at its node.
    Secondary,
    /// Fixed in space, from the primary to the secondary side; of any length.
    Given(Vec3),
}

/// Which nodes meet in node-to-node contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PairOrder {
    /// Each secondary node the nearest primary one.
    #[default]
    Nearest,
    /// The first the first, the second the second.
    Listed,
}

/// Points of a facet, along each of its directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointRule {
    /// Which points.
    pub kind: PointKind,
    /// How many, along each direction; `None`: one more than the degree of the facet.
    pub points: Option<usize>,
    /// Whether facets are cut where those of the primary side end, at the start.
    pub cut: bool,
}

/// The family of a rule.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointKind {
    /// Inside.
    #[default]
    Gauss,
    /// Ends included.
    Lobatto,
}

/// What the tributary areas of points are taken from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AreaPart {
    /// The facets of the secondary side, at the start.
    #[default]
    Reference,
    /// The facets of the secondary side, in the last accepted state.
    Present,
    /// All outer faces of solids that meet a node, at the start, whether they belong to the side or not.
    Adjacent,
    /// The whole facet of the primary side that each node meets at the start, as large as if it were everywhere as it is
    /// there.
    Opposite,
}

/// How penetration is prevented.
#[derive(Clone, Debug, Default)]
pub enum Enforcement {
    /// What suits the method.
    #[default]
    Auto,
    /// Proportional to the penetration; `None`: from the stiffness behind the surfaces.
    Penalty(Option<f64>),
    /// A curve of gap and pressure, one of [`law::TABLE`](crate::contact::law::TABLE) or any other.
    Law(Arc<dyn ContactLaw>),
    /// A gasket.
    Gasket(Arc<Gasket>),
    /// Multipliers, with a primal-dual active set.
    Lagrange,
    /// Multipliers of an augmented Lagrangian that are updated between solutions.
    Uzawa(Option<f64>),
    /// Multipliers of an augmented Lagrangian that are solved for.
    AugmentedNewton(Option<f64>),
}

/// Friction.
#[derive(Clone, Debug)]
pub struct FrictionPart {
    /// The law of the largest tangential traction, one of [`friction::TABLE`](crate::contact::friction::TABLE) or any
    /// other.
    pub limit: Arc<dyn FrictionLaw>,
    /// What sticking yields; `None`: as much as the normal direction.
    pub stick: Option<StickPart>,
}

/// What sticking yields before it slips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StickPart {
    /// Tangential traction per elastic slip.
    Stiffness(f64),
    /// The elastic slip at which the limit is reached.
    Slip(f64),
}

/// What becomes of distances at the start between sides that are joined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TieOffset {
    /// They stay.
    #[default]
    Keep,
    /// They are closed without strain.
    Close,
    /// The joint pulls the sides together; overlaps are resolved over the first step in which it acts.
    Pull,
}

/// Sides that are joined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TiePart {
    /// What becomes of distances at the start.
    pub offset: TieOffset,
    /// Points further away than this are not joined; `None`: all within reach.
    pub within: Option<f64>,
    /// Traction per way apart within the tangent plane, of joints by a penalty at points; `None`: as along the normal.
    pub penalty_tangential: Option<f64>,
    /// How the joint breaks; `None`: it does not.
    pub cohesion: Option<CohesionPart>,
}

impl TiePart {
    /// Whether it has what a joint that breaks has not: tractions at the start, or a stiffness of its own.
    #[must_use]
    pub fn pulls(&self) -> bool {
        self.offset == TieOffset::Pull || self.penalty_tangential.is_some()
    }
}

/// How a joint breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CohesionPart {
    /// The largest tractions along the normal and across it.
    pub strength: [f64; 2],
    /// The energies per area of opening and of shear.
    pub toughness: [f64; 2],
    /// How it loses its stiffness.
    pub softening: SofteningPart,
    /// The time by which damage is delayed; 0: it is not.
    pub viscosity: f64,
}

/// How a joint loses its stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SofteningPart {
    /// Linearly.
    Bilinear {
        /// The toughness between the pure modes.
        mixity: Mixity,
        /// Where damage begins between them.
        initiation: Initiation,
        /// Tractions per opening and per shear of what is undamaged; `None`: chosen.
        stiffness: Option<[f64; 2]>,
    },
    /// Exponentially, from the first opening on.
    Exponential,
}

impl CohesionPart {
    /// How many times δ₀ the last opening is at least, where the stiffness is chosen.
    const SOFTENS: f64 = 10.0;

    /// The law, with a stiffness that is at least that of contact where it is chosen.
    ///
    /// # Errors
    /// Values that make no law.
    pub fn law(&self, penalty: f64) -> Result<Cohesion, CohesionError> {
        let (strength, toughness) = (self.strength, self.toughness);
        let law: Arc<dyn CohesiveLaw> = match self.softening {
            SofteningPart::Exponential => Arc::new(Exponential::new(strength, toughness)?),
            SofteningPart::Bilinear {
                mixity,
                initiation,
                stiffness,
            } => {
                let enough = Bilinear::stiff_enough(strength, toughness, Self::SOFTENS);
                let stiffness = stiffness.unwrap_or([penalty.max(enough); 2]);
                let law = Bilinear::new(stiffness, strength, toughness, mixity, initiation)?;
                Arc::new(law)
            }
        };
        Ok(Cohesion {
            law,
            viscosity: self.viscosity,
        })
    }
}

/// How sides wear (Archard): a depth in proportion to pressure and way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WearPart {
    /// Depth per pressure and way, of the secondary side and of the primary one.
    pub coefficients: [f64; 2],
}

/// What is done about gaps and overlaps at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct StartPart {
    /// Gaps and overlaps up to this are removed by moving nodes, without strain.
    pub close_below: f64,
    /// Those of these nodes are, whatever their size.
    pub close_nodes: Vec<NodeId>,
    /// Gaps are taken to be this; `None`: as measured.
    pub clearance: Option<f64>,
    /// What becomes of overlaps.
    pub interference: Interference,
    /// Whether gaps of surfaces that conform are measured between the surfaces that straight facets were cut from.
    pub bends: bool,
}

/// What becomes of overlaps at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interference {
    /// They are resolved over the first step in which the contact is active.
    #[default]
    Ramped,
    /// The first increment resolves its part of the step of them, the second the rest. They are measured when the contact
    /// begins to act.
    Increment,
    /// What overlaps at the start of an increment of that step is resolved over the rest of the step, and measured
    /// again at the start of the next.
    Increments,
    /// They are resolved in the first increment.
    AtOnce,
    /// They are taken for contact without pressure.
    StrainFree,
}

impl Default for StartPart {
    fn default() -> Self {
        Self {
            close_below: 0.0,
            close_nodes: Vec::new(),
            clearance: None,
            interference: Interference::default(),
            bends: true,
        }
    }
}

/// A contact.
#[derive(Clone, Debug)]
pub struct ContactPart {
    /// Its name.
    pub name: String,
    /// The side that carries points.
    pub secondary: SidePart,
    /// The side that is projected onto.
    pub primary: PrimaryPart,
    /// How they are compared.
    pub method: Method,
    /// Whether also with the sides swapped.
    pub two_pass: bool,
    /// What tributary areas are taken from.
    pub area: AreaPart,
    /// How penetration is prevented.
    pub enforcement: Enforcement,
    /// What the law's pressure refers to; `None`: area where the secondary side has one.
    pub measure: Option<Measure>,
    /// A fluid that may come between the sides.
    pub fluid: Option<FluidPart>,
    /// What damps the motion of closed points in dynamic steps.
    pub damping: Damping,
    /// The velocity with which points leave an impact, over that with which they came, where impulses act.
    pub restitution: f64,
    /// How heat goes across it, where temperatures are unknowns.
    pub heat: Option<ContactHeat>,
    /// How its sides wear; `None`: not.
    pub wear: Option<WearPart>,
    /// Friction; `None`: none.
    pub friction: Option<FrictionPart>,
    /// Whether sticking points remember a traction, not a place. Then those that close are without friction until the
    /// increment has ended.
    pub remembers_traction: bool,
    /// How far points slide, and so how long they keep the tangent plane that they meet.
    pub sliding: SlidingRange,
    /// On what of the primary side points may rest; `None`: on all of it, and a little beyond its rim.
    pub features: Option<FeaturesPart>,
    /// Whether the sides are joined.
    pub tie: Option<TiePart>,
    /// Gaps and overlaps at the start.
    pub start: StartPart,
    /// Distance up to which a closest point counts; `None`: chosen.
    pub reach: Option<f64>,
    /// Whether pressures of mortar contact on quadratic triangles are smoothed in results; the equations know nothing of it.
    pub smooths: bool,
    /// Whether it acts in the first step.
    pub active: bool,
    /// How histories report it, where that is not by its own name.
    pub reported_as: Option<ReportedAs>,
}

impl FrictionPart {
    /// Coulomb's friction with a coefficient; what sticking yields is chosen.
    ///
    /// # Example
    /// ```
    /// use signorini_mechanics::contact::friction::Sliding;
    /// use signorini_mechanics::model::FrictionPart;
    ///
    /// let friction = FrictionPart::coulomb(0.2);
    /// let limit = friction.limit.limit(&Sliding { pressure: 10.0, path: 0.0 });
    /// assert_eq!(limit.value, 2.0);
    /// ```
    #[must_use]
    pub fn coulomb(mu: f64) -> Self {
        Self {
            limit: Arc::new(Coulomb {
                mu,
                cap: f64::INFINITY,
            }),
            stick: None,
        }
    }
}

impl Enforcement {
    /// The gasket, where it is one.
    #[must_use]
    pub fn gasket(&self) -> Option<Arc<Gasket>> {
        match self {
            Self::Gasket(gasket) => Some(Arc::clone(gasket)),
            _ => None,
        }
    }

    /// Whether it is a curve of gap and pressure that stands for itself, without a penalty.
    #[must_use]
    pub const fn is_curve(&self) -> bool {
        matches!(self, Self::Law(_) | Self::Gasket(_))
    }
}

impl ContactPart {
    /// Whether it joins the sides until the joint breaks.
    #[must_use]
    pub fn breaks(&self) -> bool {
        self.tie.is_some_and(|tie| tie.cohesion.is_some())
    }

    /// A contact with nothing but defaults.
    #[must_use]
    pub fn new(name: impl Into<String>, secondary: SidePart, primary: PrimaryPart) -> Self {
        Self {
            name: name.into(),
            secondary,
            primary,
            method: Method::Auto,
            two_pass: false,
            area: AreaPart::default(),
            enforcement: Enforcement::Auto,
            measure: None,
            fluid: None,
            damping: Damping::default(),
            restitution: 0.0,
            heat: None,
            wear: None,
            friction: None,
            remembers_traction: false,
            sliding: SlidingRange::default(),
            features: None,
            tie: None,
            start: StartPart::default(),
            reach: None,
            smooths: false,
            active: true,
            reported_as: None,
        }
    }
}

/// A change of a contact when a step begins; it stays until the next.
#[derive(Clone, Debug)]
pub struct ContactChange {
    /// The place of the contact in the list.
    pub contact: usize,
    /// Whether it acts from now on; `None`: as before.
    pub active: Option<bool>,
    /// Its friction from now on; `None`: as before.
    pub friction: Option<Option<FrictionPart>>,
    /// The pressure of its fluid at the end of the step; `None`: as before.
    pub fluid: Option<f64>,
    /// How far its sides slide for wear in each step from now on; `None`: as before.
    pub slip: Option<f64>,
}

/// A fluid that may come between the sides of a contact.
#[derive(Clone, Debug, PartialEq)]
pub struct FluidPart {
    /// Its pressure at the end of the first step, and later unless a step changes it.
    pub pressure: f64,
    /// The nodes, of either side, where it is from the start.
    pub seeds: Vec<NodeId>,
    /// The contact pressure up to which it enters.
    pub critical: Critical,
    /// The part of a step in which its pressure grows on points that it has just reached.
    pub ramp: f64,
    /// Whether points may dry.
    pub recedes: bool,
}

/// On what of the primary side points may rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeaturesPart {
    /// Within its faces only.
    Faces,
    /// On faces, and on all edges and vertices, those where it ends, too.
    Edges,
}
