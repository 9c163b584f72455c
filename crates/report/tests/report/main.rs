//! Pages and pictures of made-up results, whole and in every state of incompleteness.

#![allow(clippy::unwrap_used)]

mod pages;
mod pictures;
mod sizes;
mod synthetic;
