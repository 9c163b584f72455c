//! What acts from outside: dead forces on nodes and rigid bodies.
//!
//! A load goes evenly from its value at the start of a step to its value at the end (E1):
//! `F(t) = F_0 + (F_1 − F_0) (t − t_0)/T`. As an external force it enters the residual with a minus sign, and its
//! potential is `−F·u`. Prescribed motion needs no term: it is data of a step ([`crate::solve::Prescription`]).
//!
//! To add a load: a file with a term, and one line where models are built. Limits: dead loads only.

mod course;
mod nodal_forces;

pub use course::Course;
pub use nodal_forces::NodalForces;
