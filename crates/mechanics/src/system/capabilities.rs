//! What only some terms can do, one trait for each ability.
//!
//! | trait | who has it |
//! |---|---|
//! | [`Adaptive`] | contact, viscous forces: they change for the sake of the iteration |
//! | [`Choices`] | contact: active sets |
//! | [`InitialStiffness`] | solids, trusses: what a hierarchy of levels may be made of |
//! | [`Elementwise`] | solids: assembly without conflicts |
//! | [`Stored`] | whatever has a history |
//! | [`Viscous`] | viscous forces |
//! | [`Wearing`] | material that it takes off |
//! | [`Conducting`] | bodies and contacts that heat goes through |
//! | [`Sampled`] | solids, trusses: values at integration points |
//! | [`SampledHeat`] | bodies: fluxes of heat there |
//! | [`Audited`] | contact |
//! | [`Impulsive`] | contact: explicit steps |
//! | [`Inertial`] | inertia: where there is none |

use super::{
    Archive, ArchiveError, ContactAudit, Course, Frame, Impulsive, NodeId, Order, Samples, Sink,
    SizedFlows, State, TermError, Work,
};
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::Vec3;

/// What a term can do besides what all terms can. Where that changes it, [`Term::adaptive`](super::Term::adaptive) and
/// [`Term::stored`](super::Term::stored) lead there.
#[derive(Clone, Copy, Default)]
pub struct Capabilities<'a> {
    /// Makes discrete choices.
    pub choices: Option<&'a dyn Choices>,
    /// Has an initial stiffness that is worth knowing later.
    pub initial_stiffness: Option<&'a dyn InitialStiffness>,
    /// Knows the elements of its chunks.
    pub elementwise: Option<&'a dyn Elementwise>,
    /// Has a history.
    pub stored: Option<&'a dyn Stored>,
    /// Has viscous forces.
    pub viscous: Option<&'a dyn Viscous>,
    /// Has integration points.
    pub sampled: Option<&'a dyn Sampled>,
    /// Has integration points with a flux of heat.
    pub sampled_heat: Option<&'a dyn SampledHeat>,
    /// Is a contact.
    pub audited: Option<&'a dyn Audited>,
    /// Is a contact that may act in explicit steps.
    pub impulsive: Option<&'a dyn Impulsive>,
    /// Has the mass of all bodies.
    pub inertial: Option<&'a dyn Inertial>,
    /// Is a contact whose sides wear.
    pub wearing: Option<&'a dyn Wearing>,
    /// Stores heat, or sets some free.
    pub conducting: Option<&'a dyn Conducting>,
}

/// A term that heat goes through.
pub trait Conducting {
    /// Heat per time in the last accepted increment: what it takes up, sets free, and gets from outside of bodies.
    fn flows(&self) -> SizedFlows;
}

/// A term that takes material off.
pub trait Wearing {
    /// Adds the depths of all its points at the accepted state.
    fn depths(&self, out: &mut Vec<f64>);
}

/// A term that changes its pattern, or what it keeps frozen, while an iteration goes on.
pub trait Adaptive {
    /// Once per iterate, before it is evaluated: search, pairing, status. Says whether the pattern changed. `next` is what
    /// will probably be asked for there.
    ///
    /// # Errors
    /// What the term finds wrong with the configuration.
    fn prepare(&mut self, trial: &State, next: Order) -> Result<bool, TermError>;

    /// The iteration has come to an end: whether what the term keeps frozen meanwhile may stay as it is, or has been
    /// changed so that the iteration goes on.
    ///
    /// # Errors
    /// As [`Term::evaluate`](super::Term::evaluate).
    fn converged(&mut self, trial: &State) -> Result<Verdict, TermError>;

    /// Changes how the term helps the iteration on; returns whether anything changed.
    fn aid(&mut self, aid: Aid) -> bool;

    /// Sets the size up to which a force is negligible: the residuals of multipliers may be as large as such a force.
    fn set_negligible(&mut self, force: f64);

    /// Its discrete choices, if it makes any.
    fn choices(&mut self) -> Option<&mut dyn Choices>;

    /// Its viscous forces, if it has any.
    fn viscous(&mut self) -> Option<&mut dyn Viscous>;
}

/// A term that makes discrete choices: which of its rows act, and how.
pub trait Choices {
    /// These unknowns are prescribed during the step that begins, held or moved: a flag for each.
    fn prescribe(&mut self, prescribed: &[bool]);

    /// The largest multiple of `du` that the term allows.
    fn max_step(&self, trial: &State, du: &[f64]) -> f64;

    /// Whether the choices made by the last [`Adaptive::prepare`] equal those before it.
    fn verdict(&mut self, trial: &State) -> Verdict;

    /// How many rows act at the present iterate: closed contacts.
    fn nactive(&self) -> usize;

    /// The increment was cut: back to the last accepted choices and history.
    fn reject(&mut self);
}

/// A term of the bulk whose initial stiffness, undeformed and without history, is known for good: what a
/// hierarchy of levels may be made of, whatever has happened since.
pub trait InitialStiffness {
    /// Identifies the initial stiffness of this step. Equal ids mean equal stiffness.
    fn id(&self) -> u64;

    /// Adds that of one chunk. Forces that come with it count for nothing.
    ///
    /// # Errors
    /// As [`Term::evaluate`](super::Term::evaluate).
    fn add_initial(
        &self,
        chunk: usize,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError>;

    /// Whether the stiffness at this trial state is the initial one, to the last bit; false where this is not known.
    fn is_initial(&self, trial: &State) -> bool;
}

/// A term of the bulk that knows beforehand what it adds where.
pub trait Elementwise {
    /// The nodes of each element of a chunk, one after the other as [`Term::evaluate`](super::Term::evaluate) adds these, each
    /// with all unknowns of its nodes; nothing of a chunk that is not known.
    fn elements(&self, chunk: usize, take: &mut dyn FnMut(&[NodeId]));
}

/// A term with a history.
pub trait Stored {
    /// The increment is done: history moves on.
    ///
    /// # Errors
    /// What the term finds wrong with the state.
    fn accept(&mut self, state: &State) -> Result<(), TermError>;

    /// Stores the accepted history.
    fn save(&self, out: &mut Archive);

    /// Takes the accepted history back.
    ///
    /// # Errors
    /// The archive belongs to another model.
    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError>;
}

/// A term with viscous forces.
pub trait Viscous {
    /// Viscous forces of this strength act from the next increment on, none at 0, against what moves since its start
    /// beyond `drift`: a number for each unknown, or nothing. Says whether the term takes orders: false where it has a
    /// strength of its own.
    fn damp(&mut self, strength: f64, drift: &[f64]) -> bool;

    /// Work spent in viscous forces up to the accepted state.
    fn work(&self) -> f64;

    /// The motion in the last increment of bodies that the forces hold until contact does.
    fn courses(&self) -> Box<dyn Iterator<Item = &Course> + '_>;
}

/// A term with integration points.
pub trait Sampled {
    /// Adds what the term knows at the integration points of these cells, which are sorted, at an accepted state.
    ///
    /// # Errors
    /// As [`Term::evaluate`](super::Term::evaluate).
    fn sample(&self, state: &State, cells: &[CellId], out: &mut Samples) -> Result<(), TermError>;
}

/// A term that conducts heat through cells.
pub trait SampledHeat {
    /// Adds the flux of heat through present areas at the integration points of these cells, which are sorted, at an accepted state.
    ///
    /// # Errors
    /// As [`Term::evaluate`](super::Term::evaluate).
    fn sample_heat(
        &self,
        state: &State,
        cells: &[CellId],
        out: &mut Samples<Vec3>,
    ) -> Result<(), TermError>;
}

/// The term that has the mass of all bodies.
pub trait Inertial {
    /// The nodes that have no mass in the present step though their bodies have one.
    fn massless(&self) -> &[NodeId];

    /// The masses at nodes in the present step, each with its damping over mass; a node may come several times. Of masses
    /// between nodes, sums of rows.
    fn at_nodes(&self, take: &mut dyn FnMut(NodeId, f64, f64));
}

/// A contact, as audits and messages see it.
pub trait Audited {
    /// A node of the point that a multiplier acts at; none where it is another term's.
    fn node_of(&self, multiplier: usize) -> Option<NodeId>;

    /// What its rows, facets and multipliers are.
    fn numbering(&self) -> ContactNumbering;

    /// Audits an accepted state, whose results so far are in the frame; nothing where the contact does not act.
    fn audit(&self, state: &State, frame: &Frame) -> Option<ContactAudit>;
}

/// The rows, facets and multipliers of a contact, by what they are of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ContactNumbering {
    /// What the names of its arrays have.
    pub name: String,
    /// Of each row, the nodes of its point, and its number among rows of these.
    pub rows: Vec<(Vec<NodeId>, u32)>,
    /// Of each facet of the primary side, its nodes.
    pub facets: Vec<Vec<NodeId>>,
    /// Its first multiplier.
    pub first_multiplier: usize,
    /// The multipliers of each row.
    pub nmultiplier: usize,
}

/// What a term says after an iteration.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Nothing changed.
    Settled,
    /// An active set moved, or an augmentation is not done.
    Repeat {
        /// How many rows changed.
        changes: usize,
        /// Whether all they did was to close, and the way there leaves no trace: there is no friction.
        closing: bool,
        /// Whether forces are continuous functions of the state across everything that changed, as they are where rows
        /// open, close, stick and slip, and are not where a row goes to another facet.
        continuous: bool,
        /// In the user's words: who, and how.
        why: String,
        /// The nodes concerned, at most a handful.
        nodes: Vec<NodeId>,
    },
    /// Something that was kept frozen has changed, and the state has to be solved for again, however small the residual is.
    Renewed {
        /// In the user's words: who, and how.
        why: String,
    },
}

/// How terms help an iteration on: what they add for its sake has no part in the solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aid {
    /// Active sets have settled with something closed, or all has converged: what holds bodies provisionally is removed, and
    /// the state is looked for without it.
    Remove,
    /// Something moves freely without it: it holds again, until the increment is accepted.
    Restore,
    /// The iteration failed: a slower and safer way to the same solution, until the increment is accepted or
    /// [`Aid::Usual`].
    Safer,
    /// The safer way failed, too: the usual way again.
    Usual,
}
