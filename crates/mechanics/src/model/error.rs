use super::Unheld;
use crate::contact::cohesion::CohesionError;
use crate::load::LoadError;
use crate::model::activity_error::ActivityError;
use crate::model::constraint_error::ConstraintError;
use crate::solid::SolidError;
use signorini_geometry::surface::{FacetsError, SurfaceError};
use signorini_geometry::tensor::Vec3;
use thiserror::Error;

/// Why no model can be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModelError {
    /// Nothing can deform.
    #[error("no body has a material, and there are no springs: there is nothing to solve for")]
    NothingDeforms,
    /// An element in two bodies.
    #[error("element {label} belongs to body \"{first}\" and to body \"{second}\"")]
    TwoBodies {
        /// Its number in the input.
        label: u64,
        /// One body.
        first: String,
        /// The other.
        second: String,
    },
    /// A body without cells.
    #[error("body \"{body}\" has no elements")]
    EmptyBody {
        /// Its name.
        body: String,
    },
    /// A body without a mass in a step with inertia.
    #[error("body \"{body}\" has no density, and a step has inertia")]
    NoDensity {
        /// Its name.
        body: String,
    },
    /// A body of which too little is left where contact may act on nodes without mass.
    #[error("body \"{body}\" is less than three elements thick: its mass cannot be redistributed")]
    Thin {
        /// Its name.
        body: String,
    },
    /// An element that is no solid.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// A constraint, spring or reference that makes no sense.
    #[error(transparent)]
    Constraint(#[from] ConstraintError),
    /// Two rigid bodies that share a node.
    #[error("the rigid bodies \"{first}\" and \"{second}\" share node {node}")]
    RigidBodiesShare {
        /// One body.
        first: String,
        /// The other.
        second: String,
        /// The node, as numbered in the input.
        node: u64,
    },
    /// A surface that cannot be made.
    #[error("contact \"{contact}\": {source}")]
    Facets {
        /// Name of the contact.
        contact: String,
        /// Why.
        source: FacetsError,
    },
    /// A surface with a folded facet.
    #[error("contact \"{contact}\": {source}")]
    Surface {
        /// Name of the contact.
        contact: String,
        /// Why.
        source: SurfaceError,
    },
    /// A side without nodes.
    #[error("contact \"{contact}\": the secondary side is empty")]
    EmptySide {
        /// Name of the contact.
        contact: String,
    },
    /// Two sides that share nodes.
    #[error(
        "contact \"{contact}\": the two surfaces are glued at {count} nodes, one of them node {node}"
    )]
    Glued {
        /// Name of the contact.
        contact: String,
        /// How many nodes they share.
        count: usize,
        /// One of them, as numbered in the input.
        node: u64,
    },
    /// Sides that overlap at the start by more than half the thickness of the bodies.
    #[error(
        "contact \"{contact}\": the sides overlap by {overlap:.3} at the start, more than half the thickness of the bodies there ({thickness:.3})"
    )]
    TooDeep {
        /// Name of the contact.
        contact: String,
        /// The largest overlap (length).
        overlap: f64,
        /// The thickness of the thicker body there (length).
        thickness: f64,
        /// Where that is.
        place: Vec3,
        /// At how many nodes.
        count: usize,
        /// Some of them, as numbered in the input, the deepest first.
        nodes: Vec<u64>,
    },
    /// A second pass where the sides cannot be swapped.
    #[error("contact \"{contact}\": for two passes both sides are made of faces")]
    TwoPass {
        /// Name of the contact.
        contact: String,
    },
    /// A joint that could not break.
    #[error("contact \"{contact}\": {source}")]
    Cohesion {
        /// Name of the contact.
        contact: String,
        /// Why.
        source: CohesionError,
    },
    /// Choices that do not go together.
    #[error("contact \"{contact}\": {what}")]
    Unsuited {
        /// Name of the contact.
        contact: String,
        /// Which, and why.
        what: &'static str,
        /// What to write for the contact instead, as in a case.
        remedy: &'static str,
    },
    /// Mortar contact of facets without a dual basis.
    #[error(
        "contact \"{contact}\": the sides of element {label} on its secondary side are of kind {element}, for which mortar contact has no dual basis"
    )]
    NoDualBasis {
        /// Name of the contact.
        contact: String,
        /// The name of the facet's element.
        element: &'static str,
        /// The cell that the facet is a side of, as numbered in the input.
        label: u64,
    },
    /// Pairs by order of two sides with different numbers of nodes.
    #[error(
        "contact \"{contact}\": {secondary} secondary and {primary} primary nodes make no pairs in their order"
    )]
    PairCount {
        /// Name of the contact.
        contact: String,
        /// Nodes of the secondary side.
        secondary: usize,
        /// Nodes of the primary side.
        primary: usize,
    },
    /// Two rigid sides.
    #[error("contact \"{contact}\": both sides are rigid, nothing can yield")]
    BothRigid {
        /// Name of the contact.
        contact: String,
    },
    /// Bodies with motions that nothing can stop; some may move only because others do.
    #[error("{}", free_bodies(.0))]
    FreeBodies(Vec<Unheld>),
    /// Bodies that nothing stops any more once a step has removed elements, or when it adds some.
    #[error("in step \"{step}\" {}", free_bodies(.free))]
    FreeLater {
        /// Name of the step.
        step: String,
        /// The bodies.
        free: Vec<Unheld>,
    },
    /// Elements that cannot be removed or added.
    #[error(transparent)]
    Activity(#[from] ActivityError),
    /// One dof with two motions in one step.
    #[error(
        "step \"{step}\" prescribes the {component} displacement of node {node} twice, differently"
    )]
    Clash {
        /// Name of the step.
        step: String,
        /// The node, as numbered in the input.
        node: u64,
        /// The direction.
        component: char,
    },
    /// One translation or rotation of a reference or rigid body with two motions in one step.
    #[error("step \"{step}\" prescribes the {motion} of \"{carrier}\" twice, differently")]
    CarrierClash {
        /// Name of the step.
        step: String,
        /// Name of the reference or body.
        carrier: String,
        /// The translation or rotation, in words.
        motion: String,
    },
    /// A support or motion of a node of a rigid body.
    #[error("node {node} belongs to the rigid body \"{body}\": support or move the body instead")]
    OnRigidNode {
        /// The node, as numbered in the input.
        node: u64,
        /// Name of the body.
        body: String,
    },
    /// A load that cannot act.
    #[error("load \"{load}\": {source}")]
    Load {
        /// Name of the load.
        load: String,
        /// Why.
        source: LoadError,
    },
}

/// Who can move, and how: of several, who alone.
fn free_bodies(free: &[Unheld]) -> String {
    match free {
        [one] => format!(
            "{one} is free to {}: no support and no contact stops it",
            one.motion
        ),
        all => format!(
            "{} bodies can move freely: no support and no contact stops them",
            all.len()
        ),
    }
}
