//! Descriptions of what a case may name: tables of keys with their forms, ranges, defaults and meanings.
//!
//! ```text
//!   contact laws, friction laws, materials, surfaces, …      each an Entry: a Table and a function that makes the thing
//!                    │ keys                         │ make
//!                    ▼                              ▼
//!   reader, messages, schema, resolved case      model
//! ```
//!
//! A thing is described once, in the room that implements it. Whoever reads a case receives the descriptions, and hands the
//! [`Values`] of the keys back to the entry's `make`.

mod entry;
mod table;
mod values;

pub use entry::{Chosen, Description, Entry, Models};
pub use table::*;
pub use values::{Fault, Value, Values};
