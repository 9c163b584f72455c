//! The processes that compute one model together.
//!
//! ```text
//!   mpirun -n 4 signorini run case.toml
//!
//!   rank 0   state, contact, decisions │ its rows      the same state and the same decisions everywhere,
//!   rank 1   state, contact, decisions │ its rows      rows of the matrix and their factors shared out
//!   …
//! ```
//!
//! A rank is a process with a number. What all of them have to know the same of goes through [`Ranks`]; there is no
//! message anywhere else but within the library that solves. Every call is collective: all ranks make it, in the same
//! order. One process alone is [`Alone`], where a call costs nothing.
//!
//! With the feature `mpi`, [`world`] is that of `mpirun`; a process that was started by itself is a world of one.
//!
//! Source: Message Passing Interface Forum, MPI: A Message-Passing Interface Standard, Version 3.1, 2015, chapters 5, 8, 12.

mod alone;
mod error;
#[cfg(feature = "mpi")]
mod mpi;
mod threads;

pub use alone::Alone;
pub use error::RanksError;
pub use threads::on_threads;

use std::fmt::Debug;

/// The processes of a run as one of them sees them.
///
/// # Example
/// ```
/// use signorini_ranks::{Alone, Ranks};
///
/// let ranks: &dyn Ranks = &Alone;
/// let part: Vec<f64> = (0..10).map(f64::from).collect();
/// let mut all = vec![0.0; 10];
/// ranks.all_gather(&part, &[10], &mut all)?;
/// assert_eq!(all[9], 9.0);
/// # Ok::<(), signorini_ranks::RanksError>(())
/// ```
pub trait Ranks: Debug + Send + Sync {
    /// The number of this process.
    fn rank(&self) -> usize;

    /// How many processes there are.
    fn size(&self) -> usize;

    /// The parts of all ranks, one after the other.
    ///
    /// # Shapes
    /// `counts`: the numbers in the part of each rank; `own` has that of this one, `all` their sum.
    ///
    /// # Errors
    /// `Shape` where a list does not fit, `Library`.
    fn all_gather(&self, own: &[f64], counts: &[usize], all: &mut [f64]) -> Result<(), RanksError>;

    /// What rank 0 has, for all.
    ///
    /// # Shapes
    /// All ranks have as many bytes.
    ///
    /// # Errors
    /// `Shape` where there are more than 2³¹, `Library`.
    fn broadcast(&self, bytes: &mut [u8]) -> Result<(), RanksError>;

    /// The least of what all ranks have, for each number.
    ///
    /// # Errors
    /// As [`Ranks::broadcast`].
    fn least(&self, numbers: &mut [u64]) -> Result<(), RanksError>;

    /// Ends all processes with this exit code, whatever they do. Alone, it does nothing: the caller ends by itself.
    fn abort(&self, code: u8);
}

/// Whether all ranks have the same number.
///
/// # Errors
/// Those of [`Ranks::least`].
///
/// # Example
/// ```
/// use signorini_ranks::{Alone, agree};
///
/// assert!(agree(&Alone, 17)?);
/// # Ok::<(), signorini_ranks::RanksError>(())
/// ```
pub fn agree(ranks: &dyn Ranks, number: u64) -> Result<bool, RanksError> {
    // the largest number is the one whose complement is the least
    let mut both = [number, !number];
    ranks.least(&mut both)?;
    Ok(both[0] == !both[1])
}

/// The processes that this one was started with: those of `mpirun` with the feature `mpi`, else it alone.
///
/// The first call enters MPI, which is left when the process ends in order.
///
/// # Example
/// ```
/// // a test is started by itself
/// assert_eq!((signorini_ranks::world().rank(), signorini_ranks::world().size()), (0, 1));
/// ```
#[cfg(not(feature = "mpi"))]
pub fn world() -> &'static dyn Ranks {
    &Alone
}

/// The processes that compute together: those of [`world`] once it has been called, before that this one alone.
///
/// # Example
/// ```
/// assert_eq!(signorini_ranks::together().size(), 1);
/// ```
#[cfg(not(feature = "mpi"))]
pub fn together() -> &'static dyn Ranks {
    &Alone
}

#[cfg(feature = "mpi")]
pub use mpi::{together, world};
