//! The server with a client of the protocol's library, over a stand-in for the command: a script that says what it was given.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod fences;
mod protocol;
mod support;
mod tools;
