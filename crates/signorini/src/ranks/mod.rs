//! The ranks of a run in lock step: every rank runs the whole program, and what is not of the model they learn from one another.
//!
//! ```text
//!            rank 0                     the others
//!   reads    the input                  the input
//!   solves   the model                  the model: the same bits
//!   meets    what its disk answered  ─▶ the same answer, whatever was written or failed
//!            a request to stop      ◀─▶ of any rank
//!            a fault                ◀─▶ of any rank
//!            its state               =  their states
//! ```
//!
//! At a meeting every rank says what it is about, two numbers, and the fault that it has met, if it has. Where they are not
//! about the same, or states differ, the ranks have [`Parted`]: they meet no more, and each comes to its end by itself, rank
//! 0 with what it can still write. The first rank with a fault says what it was; otherwise only rank 0 speaks.
//!
//! One process alone never meets anybody.
//!
//! Limits: what solves on several ranks agrees on its own faults before it returns one, else the others wait for it there.

mod files;
mod lock_step;
mod parted;
#[cfg(test)]
mod tests;

pub use files::disk_of_first;
pub use lock_step::LockStep;
pub use parted::Parted;
