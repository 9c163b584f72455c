//! What terms are asked for, the sinks that take it, and the errors that stop it.

use super::Dof;
use signorini_geometry::mesh::NodeId;
use signorini_linear::LinearError;
use std::any::Any;
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
    /// Solids: dofs come in blocks of a node; the pattern is the same as long as the elements are.
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
    /// From inertia. Where a step begins, such a term has no force, and the mass as its stiffness.
    Inertia,
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
    /// Ranks do not hear one another.
    #[error("{0}")]
    Ranks(LinearError),
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

/// Takes the pattern of a term: which unknowns see each other.
pub trait PatternSink {
    /// The dofs of these nodes see each other, in the bulk.
    fn bulk(&mut self, nodes: &[NodeId]);
    /// These dofs see each other, in the interface.
    fn interface(&mut self, dofs: &[Dof]);
    /// Each of the dofs `ones` sees each of `others`, and the other way round, in the interface: what couples two fields.
    fn coupling(&mut self, ones: &[Dof], others: &[Dof]);
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

    /// Adds a stiffness of forces at `rows` against `columns` to the interface, row-major: what couples two fields.
    /// Sinks that keep forces alone leave it out, and others may take it by [`couple_as_square`].
    fn couple(&mut self, rows: &[Dof], columns: &[Dof], stiffness: &[f64]);

    /// Says that forces at these dofs are uncertain by `error` through rounding: a stiff law amplifies the rounding of
    /// positions far beyond that of the forces themselves.
    fn uncertain(&mut self, dofs: &[Dof], error: f64);
}

/// The whole of a stiffness of which [`Sink::add_symmetric`] has blocks, row-major.
pub(super) fn fill_up(blocks: &[f64], n: usize, ndim: usize, full: &mut Vec<f64>) {
    full.clear();
    if blocks.is_empty() {
        return;
    }
    full.resize(n * n, 0.0);
    let pairs = (0..n / ndim.max(1)).flat_map(|j| (0..=j).map(move |i| (i, j)));
    for ((i, j), block) in pairs.zip(blocks.chunks_exact((ndim * ndim).max(1))) {
        for (k, value) in block.iter().enumerate() {
            let (row, column) = (i * ndim + k / ndim, j * ndim + k % ndim);
            full[row * n + column] = *value;
            full[column * n + row] = *value;
        }
    }
}

/// Adds what [`Sink::couple`] takes as a stiffness of all dofs against all, by [`Sink::add`].
pub fn couple_as_square(sink: &mut dyn Sink, rows: &[Dof], columns: &[Dof], stiffness: &[f64]) {
    let mut full = Vec::new();
    square(rows, columns, stiffness, &mut full);
    let dofs = [rows, columns].concat();
    sink.add(&dofs, &vec![0.0; dofs.len()], &full);
}

/// A stiffness of some rows against some columns as one of all against all.
pub(super) fn square(rows: &[Dof], columns: &[Dof], stiffness: &[f64], full: &mut Vec<f64>) {
    let (nrow, n) = (rows.len(), rows.len() + columns.len());
    full.clear();
    full.resize(n * n, 0.0);
    let of_rows = stiffness.chunks_exact(columns.len().max(1));
    for (to, from) in full.chunks_exact_mut(n.max(1)).zip(of_rows) {
        if let Some(to) = to.get_mut(nrow..) {
            to.copy_from_slice(from);
        }
    }
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
