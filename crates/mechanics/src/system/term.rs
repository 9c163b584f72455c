use super::assembly::fill_up;
use super::{ContactAudit, Dof, Frame, Samples, State, Symmetry};
use signorini_geometry::mesh::{CellId, NodeId};
use std::any::Any;
use std::collections::BTreeMap;
use thiserror::Error;

/// How far a response is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// Forces only.
    Residual,
    /// Forces and stiffness.
    Tangent,
}

/// Where the stiffness of a term belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Solids: dofs come in blocks of a node, the pattern never changes.
    Bulk,
    /// Contact rows, couplings, springs.
    Interface,
}

/// How long a stiffness is the same, whatever the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lasts {
    /// It depends on the state.
    State,
    /// Until the increment ends.
    Increment,
    /// Until the step ends.
    Step,
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

/// What can go wrong while a term is evaluated.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TermError {
    /// A solid element has turned inside out.
    #[error("element {element} of body \"{body}\" is turned inside out (volume ratio {ratio:.3e})")]
    Inverted {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        element: u64,
        /// Determinant of the deformation gradient, or of the map from the reference element.
        ratio: f64,
    },
    /// A material has no answer.
    #[error("element {element} of body \"{body}\": {message}")]
    Material {
        /// Name of the body.
        body: String,
        /// Number of the element in the input.
        element: u64,
        /// What the material said.
        message: String,
    },
    /// A value is not a number.
    #[error("{what} is not a finite number")]
    NotFinite {
        /// Where: element or node, material, load.
        what: String,
    },
    /// A step asks for what a term does not have.
    #[error("{message}")]
    Refused {
        /// Who refuses what, and why.
        message: String,
    },
    /// A contact surface has no answer.
    #[error("contact \"{interface}\": {message}")]
    Surface {
        /// Name of the interface.
        interface: String,
        /// What the surface said.
        message: String,
        /// A node of the point that it is about.
        node: Option<NodeId>,
    },
}

/// What an archive lacks.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ArchiveError {
    /// A name that is not there.
    #[error("the checkpoint has no \"{name}\"")]
    Missing {
        /// The name.
        name: String,
    },
    /// Data of another model.
    #[error("\"{name}\" in the checkpoint has {found} values, this model has {expected}")]
    Length {
        /// The name.
        name: String,
        /// Values in the checkpoint.
        found: usize,
        /// Values in the model.
        expected: usize,
    },
}

/// Named arrays: what a term needs to go on bit by bit where it stopped.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Archive {
    /// The arrays.
    pub arrays: BTreeMap<String, Vec<f64>>,
}

impl Archive {
    /// Stores an array.
    pub fn put(&mut self, name: impl Into<String>, values: &[f64]) {
        self.arrays.insert(name.into(), values.to_vec());
    }

    /// The length of a stored array.
    ///
    /// # Errors
    /// No such array.
    pub fn length(&self, name: &str) -> Result<usize, ArchiveError> {
        let found = self.arrays.get(name).map(Vec::len);
        found.ok_or_else(|| ArchiveError::Missing {
            name: name.to_string(),
        })
    }

    /// Copies a stored array into `out`.
    ///
    /// # Errors
    /// No such array, or one of another length.
    pub fn get(&self, name: &str, out: &mut [f64]) -> Result<(), ArchiveError> {
        let values = self.arrays.get(name).ok_or_else(|| ArchiveError::Missing {
            name: name.to_string(),
        })?;
        if values.len() != out.len() {
            return Err(ArchiveError::Length {
                name: name.to_string(),
                found: values.len(),
                expected: out.len(),
            });
        }
        out.copy_from_slice(values);
        Ok(())
    }
}

/// Takes the pattern of a term: which unknowns see each other.
pub trait PatternSink {
    /// The dofs of these nodes see each other, in the bulk.
    fn bulk(&mut self, nodes: &[NodeId]);
    /// These dofs see each other, in the interface.
    fn interface(&mut self, dofs: &[Dof]);
}

/// Takes local forces and stiffnesses.
pub trait Sink {
    /// Adds `force`, and `stiffness` (row-major, `n × n`; empty for [`Order::Residual`]), at these dofs. In the bulk,
    /// the dofs are those of whole nodes, one node after the other. Dofs may repeat and may be [`super::NO_DOF`].
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]);

    /// The same of a stiffness that is symmetric, at the dofs of whole nodes: of the blocks `(I, J)` of nodes, `ndim × ndim`
    /// and row-major, those with `I ≤ J`, first those of the first `J`; empty for [`Order::Residual`].
    fn add_symmetric(&mut self, dofs: &[Dof], force: &[f64], blocks: &[f64], ndim: usize) {
        let mut stiffness = Vec::new();
        fill_up(blocks, dofs.len(), ndim, &mut stiffness);
        self.add(dofs, force, &stiffness);
    }

    /// Says that forces at these dofs are uncertain by `error` through rounding: a stiff law amplifies the rounding of
    /// positions far beyond that of the forces themselves.
    fn uncertain(&mut self, _dofs: &[Dof], _error: f64) {}
}

/// Scratch memory of one thread: each kind of term finds its own there, as it left it.
#[derive(Default)]
pub struct Work {
    slots: Vec<Box<dyn Any + Send>>,
}

impl Work {
    /// The scratch of type `T`, made on first use.
    pub fn of<T: Default + Send + 'static>(&mut self) -> &mut T {
        let found = self.slots.iter().position(|s| s.is::<T>());
        let at = found.unwrap_or_else(|| {
            self.slots.push(Box::new(T::default()));
            self.slots.len() - 1
        });
        // the slot was just found or made with this very type
        match self.slots[at].downcast_mut::<T>() {
            Some(scratch) => scratch,
            None => unreachable!("a slot is found by its type"),
        }
    }
}

/// The step a run is in, as terms see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepContext {
    /// Number of the step, from 0.
    pub number: usize,
    /// Total time at its start.
    pub start: f64,
    /// Its duration.
    pub duration: f64,
    /// Whether displacements may be large.
    pub nonlinear: bool,
}

/// What a term is in before any step begins.
impl Default for StepContext {
    fn default() -> Self {
        Self {
            number: 0,
            start: 0.0,
            duration: 1.0,
            nonlinear: true,
        }
    }
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

/// A part of the model that exerts forces: solids, loads, contact interfaces. All that solving ever sees.
pub trait Term: Send + Sync {
    /// What it is called in messages and files.
    fn name(&self) -> &str;

    /// Which unknowns see each other. Asked again when [`Term::prepare`] says that it changed.
    fn pattern(&self, out: &mut dyn PatternSink);

    /// A node of the point that a multiplier acts at; none where it is another term's, or acts at no point.
    fn node_of(&self, _multiplier: usize) -> Option<NodeId> {
        None
    }

    /// What its stiffness is at least.
    fn symmetry(&self) -> Symmetry;

    /// Where its stiffness belongs.
    fn part(&self) -> Part;

    /// How long its stiffness is the same, to the last bit, from the begin of a step or an increment on.
    fn stiffness_lasts(&self) -> Lasts {
        Lasts::State
    }

    /// A step begins at this accepted state.
    ///
    /// # Errors
    /// What the term finds wrong with it.
    fn begin_step(&mut self, _step: &StepContext, _from: &State) -> Result<(), TermError> {
        Ok(())
    }

    /// These unknowns are prescribed during the step that begins, held or moved: a flag for each.
    fn prescribe(&mut self, _prescribed: &[bool]) {}

    /// An increment begins at this accepted state.
    ///
    /// # Errors
    /// What the term finds wrong with it.
    fn begin_increment(&mut self, _from: &State) -> Result<(), TermError> {
        Ok(())
    }

    /// Once per iterate, before it is evaluated: search, pairing, status. Says whether the pattern changed. `next` is what
    /// will probably be asked for there.
    ///
    /// # Errors
    /// What the term finds wrong with the configuration.
    fn prepare(&mut self, _trial: &State, _next: Order) -> Result<bool, TermError> {
        Ok(false)
    }

    /// The number of chunks, independent of the number of threads; another one from [`Term::begin_increment`] on, at most.
    fn nchunk(&self) -> usize;

    /// The nodes of each element of a chunk of the bulk, one after the other as [`Term::evaluate`] adds these, each with all
    /// unknowns of its nodes; nothing where a term does not say.
    fn elements(&self, _chunk: usize, _take: &mut dyn FnMut(&[NodeId])) {}

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

    /// Adds the stiffness of one chunk as it is at the start of a run, undeformed and without history: what a hierarchy of
    /// levels may be made of, whatever has happened since. Forces that come with it count for nothing. Asked of the bulk alone.
    ///
    /// # Errors
    /// As [`Term::evaluate`].
    fn stiffness_at_start(
        &self,
        _chunk: usize,
        _work: &mut Work,
        _out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        Ok(())
    }

    /// Which stiffness at the start it has in the present step: the same number in all steps where it is the same.
    fn start(&self) -> u64 {
        0
    }

    /// Whether its stiffness at this trial state is that at the start, to the last bit; false where this is not known.
    fn is_at_start(&self, _trial: &State) -> bool {
        false
    }

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

    /// The largest multiple of `du` that the term allows.
    fn max_step(&self, _trial: &State, _du: &[f64]) -> f64 {
        1.0
    }

    /// Whether the discrete choices made by the last [`Term::prepare`] equal those before it.
    fn verdict(&mut self, _trial: &State) -> Verdict {
        Verdict::Settled
    }

    /// The iteration has come to an end: whether what the term keeps frozen meanwhile may stay as it is, or has been
    /// changed so that the iteration goes on.
    ///
    /// # Errors
    /// As [`Term::evaluate`].
    fn converged(&mut self, _trial: &State) -> Result<Verdict, TermError> {
        Ok(Verdict::Settled)
    }

    /// Changes how the term helps the iteration on; returns whether anything changed.
    fn aid(&mut self, _aid: Aid) -> bool {
        false
    }

    /// Sets the size up to which a force is negligible: the residuals of multipliers may be as large as such a force.
    fn set_negligible(&mut self, _force: f64) {}

    /// Viscous forces of this strength act from the next increment on, none at 0, against what moves since its start
    /// beyond `drift`: a number for each unknown, or nothing. Says whether the term has any.
    fn damp(&mut self, _strength: f64, _drift: &[f64]) -> bool {
        false
    }

    /// Work spent in viscous forces up to the accepted state.
    fn work_stabilization(&self) -> f64 {
        0.0
    }

    /// Whether it solves for multipliers of inequalities, so that solutions are saddle points.
    fn has_saddle(&self) -> bool {
        false
    }

    /// How many rows act at the present iterate: closed contacts.
    fn nactive(&self) -> usize {
        0
    }

    /// The increment is done: history moves on.
    ///
    /// # Errors
    /// What the term finds wrong with the state.
    fn accept(&mut self, _state: &State) -> Result<(), TermError> {
        Ok(())
    }

    /// The increment was cut: back to the last accepted history.
    fn reject(&mut self) {}

    /// Stores the accepted history.
    fn save(&self, _out: &mut Archive) {}

    /// Takes the accepted history back.
    ///
    /// # Errors
    /// The archive belongs to another model.
    fn load(&mut self, _from: &Archive) -> Result<(), ArchiveError> {
        Ok(())
    }

    /// Whether its forces come from outside of bodies and what lies between them: loads, and what holds or guides.
    fn is_outside(&self) -> bool {
        false
    }

    /// Whether its forces are loads: those do the work that comes from outside, with supports.
    fn is_load(&self) -> bool {
        false
    }

    /// Adds what the term knows at the integration points of these cells, which are sorted, at an accepted state.
    ///
    /// # Errors
    /// As [`Term::evaluate`].
    fn sample(
        &self,
        _state: &State,
        _cells: &[CellId],
        _out: &mut Samples,
    ) -> Result<(), TermError> {
        Ok(())
    }

    /// Audits an accepted state, whose results so far are in the frame: of contacts.
    fn audit(&self, _state: &State, _frame: &Frame) -> Option<ContactAudit> {
        None
    }

    /// Writes what the term knows at an accepted state into a frame.
    ///
    /// # Errors
    /// As [`Term::evaluate`].
    fn report(&self, _state: &State, _frame: &mut Frame) -> Result<(), TermError> {
        Ok(())
    }
}
