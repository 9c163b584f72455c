//! The command as users meet it: what it says, how it ends, and what it leaves behind.
//!
//! Numbers behind the names of tests are those of the list of faults that the program has to stand.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod advice;
mod audit;
mod check;
mod convert;
mod decks;
mod events;
mod files;
mod help;
mod json;
mod linear;
mod mesh;
mod model;
mod numerics;
mod restart;
mod results;
mod status;
mod stopping;
mod support;
mod terminal;
mod text;
mod verify;
mod within;
