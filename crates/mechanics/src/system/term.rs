use super::strip::fill_up;
use super::{Adaptive, Capabilities, Dof, Frame, Phase, State, Stored, Symmetry};
use signorini_geometry::mesh::NodeId;
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
    /// Contact rows, couplings, springs; fields besides the displacement.
    Interface,
}

/// How long a stiffness is the same, whatever the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lifetime {
    /// It depends on the state.
    State,
    /// Until the increment ends.
    Increment,
    /// Until the step ends.
    Step,
}

/// Where the forces of a term come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// From within bodies, and what lies between them.
    Internal,
    /// From outside: supports, guides, and what slows a motion down.
    Support,
    /// From outside: a load, which does work, as supports do.
    Load,
}

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
    /// Whether it solves for multipliers of inequalities, so that solutions are saddle points.
    pub has_saddle: bool,
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
            has_saddle: false,
        }
    }

    /// The same of a term with another role.
    #[must_use]
    pub const fn with_role(self, role: Role) -> Self {
        Self { role, ..self }
    }
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
    fn uncertain(&mut self, dofs: &[Dof], error: f64);
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
