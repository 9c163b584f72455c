//! Contacts, and their changes in a step.

use super::{Name, Step};
use crate::diagnostic::{Place, Spanned};
use signorini_vocabulary::{Chosen, Value};

/// The word for the secondary side itself, as `primary`.
pub const SELF: &str = "self";

/// A pair of surfaces that may touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Its name.
    pub name: Name,
    /// The side that carries the points.
    pub secondary: Name,
    /// The side that is projected onto: a set, a surface, or [`SELF`].
    pub primary: Name,
    /// How the two sides are discretized.
    pub method: Spanned<Method>,
    /// Whether also with the sides swapped.
    pub two_pass: bool,
    /// The points of [`Method::GaussPoint`].
    pub rule: PointRule,
    /// The areas that points stand for.
    pub area: Area,
    /// How penetration is prevented.
    pub enforcement: Enforcement,
    /// Whether that is a law of adhesion, given as such.
    pub adhesion: bool,
    /// Per node (force per length) or per area (stress per length); none: by what the secondary side is.
    pub per: Option<Per>,
    /// Friction; none: frictionless.
    pub friction: Option<Friction>,
    /// Whether sticking points remember a traction, not a place. Then those that close are without friction until the
    /// increment has ended.
    pub remembers_traction: bool,
    /// A gasket, in the place of `enforcement`.
    pub gasket: Option<Gasket>,
    /// A fluid that may come between the sides.
    pub fluid: Option<Fluid>,
    /// What damps closed points in dynamic steps.
    pub damping: Damping,
    /// The velocity with which points leave an impact, over that with which they came, where impulses act.
    pub restitution: Spanned<f64>,
    /// Ways that heat takes across it; empty: none.
    pub conductance: Vec<Conductance>,
    /// What becomes of the work of friction; none: it is lost.
    pub friction_heat: Option<FrictionHeat>,
    /// The temperature of a rigid surface.
    pub temperature: Option<f64>,
    /// How its sides wear; none: not.
    pub wear: Option<Wear>,
    /// How far points slide.
    pub sliding: Sliding,
    /// On what of the primary side points may rest.
    pub features: Features,
    /// Whether the sides are joined.
    pub tied: Option<Tied>,
    /// How the joint of sides that are joined breaks; none: it does not.
    pub cohesive: Option<Cohesive>,
    /// What is done about gaps and overlaps at the start; by default for sides that are joined.
    pub start: Start,
    /// The normals of [`Method::NodeToNode`] and [`Method::Mortar`].
    pub normals: Normals,
    /// The basis of [`Method::Mortar`].
    pub basis: Basis,
    /// The pairs of [`Method::NodeToNode`].
    pub pairs: Pairs,
    /// How far from each other the sides are searched (length); none: found by the program.
    pub reach: Option<f64>,
    /// Whether it acts from the first step on.
    pub active: bool,
    /// How it was found, where nobody names pairs: then it is written nowhere.
    pub found: Option<Found>,
    /// Where it was written.
    pub place: Place,
}

impl Contact {
    /// A contact with nothing but defaults.
    pub fn new(name: Name, secondary: Name, primary: Name, place: Place) -> Self {
        Self {
            name,
            secondary,
            primary,
            method: Method::Auto.into(),
            two_pass: false,
            rule: PointRule::default(),
            area: Area::Reference,
            enforcement: Enforcement::Auto,
            adhesion: false,
            per: None,
            friction: None,
            remembers_traction: false,
            gasket: None,
            fluid: None,
            damping: Damping::default(),
            restitution: 0.0.into(),
            conductance: Vec::new(),
            friction_heat: Some(FrictionHeat::default()),
            temperature: None,
            wear: None,
            sliding: Sliding::Auto,
            features: Features::default(),
            tied: None,
            cohesive: None,
            start: Start::default(),
            normals: Normals::Primary,
            basis: Basis::Part,
            pairs: Pairs::Nearest,
            reach: None,
            active: true,
            found: None,
            place,
        }
    }

    /// Whether it acts, step by step.
    pub fn acting<'c>(
        &'c self,
        steps: impl Iterator<Item = &'c Step>,
    ) -> impl Iterator<Item = bool> {
        let mut acts = self.active;
        steps.map(move |step| {
            let mut changes = step.contacts.iter();
            let change = changes.find(|change| change.name.value == self.name.value);
            acts = change.and_then(|change| change.active).unwrap_or(acts);
            acts
        })
    }

    /// Whether it is a contact of a surface with itself.
    pub fn is_with_itself(&self) -> bool {
        self.primary.value == SELF
    }
}

/// How the two sides of a contact are discretized.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The program chooses.
    #[default]
    Auto,
    /// Nodes of one side against nodes of the other.
    NodeToNode,
    /// Nodes of the secondary side against segments of the primary side.
    NodeToSegment,
    /// Points inside the facets of the secondary side against segments of the primary side.
    GaussPoint,
    /// Means over the facets of the secondary side against all facets that they meet.
    Mortar,
}

/// Points of a facet, along each of its directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PointRule {
    /// Which ones.
    pub kind: PointKind,
    /// How many; none: one more than the degree of the facet.
    pub points: Option<u64>,
    /// Whether facets are cut where those of the other side end.
    pub cut: bool,
}

/// A family of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PointKind {
    /// Inside.
    #[default]
    Gauss,
    /// With the ends.
    Lobatto,
}

/// The areas that points stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Area {
    /// Those at the start.
    #[default]
    Reference,
    /// Those of the deformed surface.
    Current,
    /// Those of all outer faces of solids that meet a node, at the start.
    Adjacent,
    /// That of the facet of the primary side that a point meets first, at the start.
    Opposite,
}

/// How penetration is prevented.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Enforcement {
    /// The program chooses.
    #[default]
    Auto,
    /// A pressure or force proportional to the penetration; none: from the stiffness behind the surface.
    Penalty(Option<Spanned<f64>>),
    /// Linear between rows of gap and pressure: gaps increase, pressures fall to zero.
    Table(Vec<[f64; 2]>),
    /// A curve of gap and pressure, by its name in the vocabulary.
    Law(Chosen),
    /// Multipliers.
    Lagrange,
    /// Multipliers in addition to a penalty.
    Augmented {
        /// How they are found.
        by: Augmentation,
        /// The penalty; none: from the stiffness behind the surface.
        penalty: Option<Spanned<f64>>,
    },
}

impl Enforcement {
    /// Whether it is a curve of gap and pressure that stands for itself, without a penalty.
    #[must_use]
    pub const fn is_curve(&self) -> bool {
        matches!(self, Self::Table(_) | Self::Law(_))
    }
}

/// How the multipliers of an augmented Lagrangian are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Augmentation {
    /// They are updated between solutions.
    Uzawa,
    /// They are solved for.
    Newton,
}

/// What a penalty refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// A node of the secondary side.
    Node,
    /// Its area.
    Area,
}

/// Friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// The friction law, by its name in the vocabulary.
    pub limit: Chosen,
    /// What sticking yields; none: the program chooses.
    pub stick: Option<Stick>,
}

impl Friction {
    /// Coulomb's friction with this coefficient.
    #[must_use]
    pub fn coulomb(mu: f64) -> Self {
        Self {
            limit: Chosen::new(COULOMB, [(MU, mu)]),
            stick: None,
        }
    }

    /// The coefficient of friction that stands alone, in place of a table.
    #[must_use]
    pub fn coefficient(&self) -> Option<f64> {
        let mut values = self.limit.values.iter();
        let (first, rest) = (values.next(), values.next());
        match (first, rest, &self.stick) {
            (Some((MU, Value::Number(mu))), None, None) if self.limit.name == COULOMB => Some(*mu),
            _ => None,
        }
    }
}

/// The law that a bare number as `friction` stands for, and its key.
pub const COULOMB: &str = "coulomb";
/// The key of its coefficient.
pub const MU: &str = "mu";

/// What sticking yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stick {
    /// Shear traction per elastic slip.
    Stiffness(f64),
    /// The elastic slip (length) at which points slip.
    Slip(f64),
}

/// How far points slide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sliding {
    /// Little where all steps up to the last one in which the contact acts have linear geometry, else as far as it goes.
    #[default]
    Auto,
    /// As far as it goes.
    Finite,
    /// Within an increment, in the tangent plane that each meets at its start.
    Increment,
    /// Within the tangent plane that each meets first.
    Small,
}

/// What becomes of distances at the start between sides that are joined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Offset {
    /// They stay.
    #[default]
    Keep,
    /// They are closed without strain.
    Close,
    /// The joint pulls the sides together.
    Pull,
}

/// On what of the primary side points may rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Features {
    /// On faces, edges and vertices, and a little beyond where it ends.
    #[default]
    Auto,
    /// Within faces only.
    Faces,
    /// On faces, edges and vertices, those where it ends, too.
    Edges,
}

/// Sides that are joined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tied {
    /// What becomes of distances at the start.
    pub offset: Offset,
    /// Points further away (length) are not joined; none: all within reach.
    pub within: Option<f64>,
    /// Traction per way apart within the tangent plane, of joints by a penalty; none: as along the normal.
    pub penalty_tangential: Option<f64>,
}

/// How a joint breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cohesive {
    /// The largest tractions along the normal and across it.
    pub strength: [f64; 2],
    /// The energies per area that opening and shear take.
    pub toughness: [f64; 2],
    /// The toughness between them.
    pub mixity: Mixity,
    /// Whether damage begins where squares of tractions over strengths add up to 1, whatever the mixity.
    pub quadratic: bool,
    /// Whether it softens exponentially.
    pub exponential: bool,
    /// Tractions per opening and per shear before damage begins; none: the program chooses.
    pub stiffness: Option<[f64; 2]>,
    /// The time by which damage is delayed.
    pub viscosity: f64,
}

/// The toughness between opening and shear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mixity {
    /// Interpolated with this exponent of the share of shear in the energy (Benzeggagh and Kenane).
    Bk(f64),
    /// The energies over the toughnesses to this power add up to 1.
    Power(f64),
}

impl Default for Mixity {
    fn default() -> Self {
        Self::Bk(2.0)
    }
}

/// What is done about gaps and overlaps at the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Gaps and overlaps up to this (length) are removed by moving nodes.
    pub close_gaps_below: f64,
    /// Those of the nodes of this set are, whatever their size.
    pub close_gaps_of: Option<Name>,
    /// What gaps are taken to be (length); none: as measured.
    pub clearance: Option<f64>,
    /// What becomes of overlaps.
    pub interference: Interference,
    /// Whether gaps are those between straight facets where surfaces conform, too.
    pub straight_facets: bool,
}

/// What becomes of overlaps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interference {
    /// They are resolved over the first step in which the contact acts.
    #[default]
    Step,
    /// The first increment in which the contact acts resolves its part of the step of them, the second the rest.
    Increment,
    /// What overlaps at the start of an increment of that step is resolved over what is left of the step.
    Increments,
    /// They are resolved at once.
    Now,
    /// They stay, without pressure.
    StrainFree,
}

/// Over what weights of mortar contact are not negative on quadratic facets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// Over any part of a facet.
    #[default]
    Part,
    /// Over a whole facet.
    Whole,
}

/// Where node-to-node contact and mortar contact take their normals from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Normals {
    /// From the primary side; of mortar contact, from the facets of the secondary side, turned where these are tilted.
    #[default]
    Primary,
    /// Of mortar contact: means at the nodes of the secondary side.
    Nodal,
    /// From the secondary side; of mortar contact, from its facets everywhere.
    Secondary,
    /// Given, towards the secondary side; not zero, of any length.
    Given([f64; 3]),
}

/// Which nodes meet in node-to-node contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pairs {
    /// The nearest.
    #[default]
    Nearest,
    /// Those of one place in the two lists.
    Order,
}

/// A change of a contact, from a step on.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactChange {
    /// The contact.
    pub name: Name,
    /// Whether it acts; none: as before.
    pub active: Option<bool>,
    /// Its friction, which may be none; nothing: as before.
    pub friction: Option<Option<Friction>>,
    /// The pressure of its fluid at the end of the step; none: as before.
    pub fluid: Option<f64>,
    /// How far its sides slide for wear in each step (length); none: as before.
    pub slip: Option<f64>,
    /// Where it was written.
    pub place: Place,
}

/// A gasket: pressure against closure.
#[derive(Clone, Debug, PartialEq)]
pub struct Gasket {
    /// Rows of closure and pressure of closing further than ever.
    pub loading: Vec<[f64; 2]>,
    /// Curves of opening.
    pub unloading: Vec<Unloading>,
    /// The closure up to which it opens as it closes; none: where the slope of loading has fallen by a tenth of its steepest.
    pub onset: Option<f64>,
    /// How stiff it is in being opened further than to pressure 0, over its first stiffness.
    pub tension: f64,
}

/// How a gasket opens from a closure.
#[derive(Clone, Debug, PartialEq)]
pub struct Unloading {
    /// The closure.
    pub from: f64,
    /// Rows of closure and pressure up to there.
    pub curve: Vec<[f64; 2]>,
}

/// A fluid that may come between the sides of a contact.
#[derive(Clone, Debug, PartialEq)]
pub struct Fluid {
    /// Its pressure at the end of the first step.
    pub pressure: f64,
    /// The nodes, of either side, where it is from the start.
    pub from: Name,
    /// The contact pressure up to which it enters; none: its own.
    pub critical: Option<f64>,
    /// The part of a step in which its pressure grows on points that it has just reached.
    pub ramp: f64,
    /// Whether points may dry.
    pub recedes: bool,
}

/// What a contact that the program found is to results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// The name that it shares with others between the same two bodies.
    pub pair: String,
    /// Whether the primary side is of the body that this name begins with: the one whose force is reported.
    pub is_reversed: bool,
}

/// Contact of everything with everything: pairs of surfaces are found.
#[derive(Clone, Debug, PartialEq)]
pub struct General {
    /// Bodies, groups and sets that may touch; empty: all.
    pub of: Vec<Name>,
    /// Whether bodies may touch themselves.
    pub with_itself: bool,
    /// What touches nothing, and pairs that do not touch each other.
    pub exclude: Vec<Excluded>,
    /// What all pairs have in common; it names no sides.
    pub common: Contact,
    /// What is different where two meet; of several that name a pair the last holds.
    pub pairs: Vec<GeneralPair>,
}

/// What touches nothing; with a second name, two that do not touch each other.
pub type Excluded = (Name, Option<Name>);

/// What is different where two bodies meet.
#[derive(Clone, Debug, PartialEq)]
pub struct GeneralPair {
    /// The two: bodies, groups, sets, materials, or [`ANY`].
    pub between: [Name; 2],
    /// Its friction; outside none: as of all.
    pub friction: Option<Option<Friction>>,
    /// How penetration is prevented; none: as of all.
    pub enforcement: Option<(Enforcement, Option<Per>)>,
    /// How the sides are discretized; none: as of all.
    pub method: Option<Spanned<Method>>,
    /// The one that carries the points.
    pub secondary: Option<Name>,
    /// What is done about gaps and overlaps at the start; none: as of all.
    pub start: Option<Start>,
    /// Where it was written.
    pub place: Place,
}

impl GeneralPair {
    /// Two that meet as all others do.
    #[must_use]
    pub fn new(between: [Name; 2], place: Place) -> Self {
        Self {
            between,
            friction: None,
            enforcement: None,
            method: None,
            secondary: None,
            start: None,
            place,
        }
    }
}

/// The word for everything, in pairs.
pub const ANY: &str = "any";

/// Material that sliding takes off the sides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wear {
    /// Depth per pressure and way, of the secondary side and of the primary one (1/pressure).
    pub coefficients: [f64; 2],
    /// Depth over the size of the facets beyond which a warning says so.
    pub limit: f64,
}

/// What damps closed points in dynamic steps (pressure, or force, over velocity).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// Along the normal.
    pub normal: f64,
    /// Across it.
    pub tangential: f64,
    /// Whether it may pull more than the law presses.
    pub pulls: bool,
}

/// A way that heat takes across a contact.
#[derive(Clone, Debug, PartialEq)]
pub enum Conductance {
    /// The same wherever it touches: heat per time, area and difference of temperatures.
    Constant(f64),
    /// Rows of pressure and that.
    OverPressure(Vec<[f64; 2]>),
    /// Rows of gap and that.
    OverGap(Vec<[f64; 2]>),
    /// A power of the pressure.
    Power {
        /// What it is at the hardness.
        h0: f64,
        /// A pressure.
        hardness: f64,
        /// The exponent.
        exponent: f64,
    },
    /// Through a gas in the gap.
    Gas {
        /// Its conductivity.
        conductivity: f64,
        /// What is added to the gap.
        jump: f64,
    },
    /// By radiation between surfaces of these emissivities.
    Radiation([f64; 2]),
}

/// What becomes of the work of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionHeat {
    /// The part of it that becomes heat.
    pub fraction: f64,
    /// The part of that which the secondary side takes.
    pub to_secondary: f64,
}

impl Default for FrictionHeat {
    fn default() -> Self {
        Self {
            fraction: 1.0,
            to_secondary: 0.5,
        }
    }
}
