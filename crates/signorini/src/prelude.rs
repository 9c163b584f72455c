//! What a program that builds and solves a model needs, with one `use`.
//!
//! ```text
//! Mesh, Parts ──Model::assemble──▶ Model ──Stepper::run──▶ Event with a Frame
//! ```
//!
//! `examples/two_blocks.rs` is such a program; `examples/contact_law.rs`, `examples/rigid_surface.rs` and
//! `examples/own_term.rs` bring a contact law, a surface and a term of their own.

pub use signorini_geometry::element::{self, Element};
pub use signorini_geometry::mesh::{CellId, Face, Mesh, NodeId, boundary};
pub use signorini_geometry::surface::{
    Analytical, Cone, ContactSurface, Cylinder, Mount, Patch, Plane, Polynomial, RigidId, Shape,
    Side, SignedDistance, Sphere, SurfaceError, Torus,
};
pub use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
pub use signorini_linear::LinearKind;
pub use signorini_mechanics::contact::friction::{Coulomb, FrictionLaw, Limit, Sliding};
pub use signorini_mechanics::contact::law::{ContactLaw, Eval, Scale, each};
pub use signorini_mechanics::load::{
    Acting, BodyForce, Force, Gravity, Load, Moment, PerNode, Place, Pressure, Spin, Traction,
    Wrench,
};
pub use signorini_mechanics::material::{Material, NeoHookean, SaintVenantKirchhoff};
pub use signorini_mechanics::model::{
    BodyKind, BodyPart, Change, ConstraintKind, ConstraintPart, ContactPart, Enforcement,
    FrictionPart, LoadPart, Method, Model, ModelError, Parts, PrimaryPart, SidePart, StepPart,
    Target,
};
pub use signorini_mechanics::solve::{
    Event, Flow, Increments, Motion, Observer, Outcome, RunError, Stepper, StepperSettings,
};
pub use signorini_mechanics::system::{
    Archive, ArchiveError, Capabilities, Dof, Frame, Idealisation, Layout, NO_DOF, Order, Part,
    PatternSink, Phase, Properties, Role, Sink, State, Stored, Symmetry, System, Term, TermError,
    Work,
};
