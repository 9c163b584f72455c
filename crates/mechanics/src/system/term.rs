use super::sink::{Lifetime, Order, Part, PatternSink, Role, Sink, TermError};
use super::{Adaptive, Capabilities, Frame, Phase, State, Stored, Symmetry, Work};

/// What a term is, as far as solving needs to know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// What its stiffness is at least.
    pub symmetry: Symmetry,
    /// Where its stiffness belongs.
    pub part: Part,
    /// How long its stiffness is the same, to the last bit, from the begin of a step or an increment on.
    pub lifetime: Lifetime,
    /// Where its forces come from.
    pub role: Role,
    /// Whether its stiffness between the ends of an increment, [`State::between`], is that against the end; else it is that
    /// against the state where it is evaluated.
    pub to_end: bool,
    /// By which time its stiffness damps, times which it is against velocities; it has that part itself but in explicit steps.
    pub retardation: f64,
    /// Whether it solves for multipliers of inequalities, so that solutions are saddle points.
    pub has_saddle: bool,
    /// Whether its tangent takes the stress that the last correction predicted, [`State::correction`].
    pub predicts: bool,
    /// Identifies the elements, or bodies, that take part. Equal numbers mean equal ones, and with them an equal pattern, but for what
    /// contact couples.
    pub elements: u64,
}

impl Properties {
    /// Those of a term within the model whose stiffness depends on the state.
    #[must_use]
    pub const fn new(symmetry: Symmetry, part: Part) -> Self {
        Self {
            symmetry,
            part,
            lifetime: Lifetime::State,
            role: Role::Internal,
            to_end: false,
            retardation: 0.0,
            has_saddle: false,
            predicts: false,
            elements: 0,
        }
    }

    /// The same of a term with another role.
    #[must_use]
    pub const fn with_role(self, role: Role) -> Self {
        Self { role, ..self }
    }
}

/// A part of the model that exerts forces: solids, loads, contact interfaces. All that solving ever sees.
///
/// What only some terms can do are traits of their own: [`Capabilities`].
pub trait Term: Send + Sync {
    /// What it is called in messages and files.
    fn name(&self) -> &str;

    /// What it is, in the present step.
    fn properties(&self) -> Properties;

    /// Which unknowns see each other. Asked again when [`Adaptive::prepare`](super::Adaptive::prepare) says that it changed.
    fn pattern(&self, out: &mut dyn PatternSink);

    /// A step begins at this accepted state, or an increment of it.
    ///
    /// # Errors
    /// What the term finds wrong with it.
    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError>;

    /// The number of chunks, independent of the number of threads; another one from the begin of an increment on, at most.
    fn nchunk(&self) -> usize;

    /// Adds the forces and stiffness of one chunk. Pure: the same trial gives the same bits.
    ///
    /// # Errors
    /// An element turned inside out, a value that is not finite.
    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError>;

    /// The potential energy of one chunk, where the term has one: its forces are the gradient.
    ///
    /// # Errors
    /// As [`Term::evaluate`].
    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError>;

    /// Writes what the term knows at an accepted state into a frame.
    ///
    /// # Errors
    /// As [`Term::evaluate`].
    fn report(&self, _state: &State, _frame: &mut Frame) -> Result<(), TermError> {
        Ok(())
    }

    /// What it can do besides.
    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities::default()
    }

    /// The term as one that changes for the sake of the iteration, if it does.
    fn adaptive(&mut self) -> Option<&mut dyn Adaptive> {
        None
    }

    /// The term as one with a history, if it has one.
    fn stored(&mut self) -> Option<&mut dyn Stored> {
        None
    }
}
