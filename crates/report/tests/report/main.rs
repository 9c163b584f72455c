//! Pages and pictures of made-up results, whole and in every state of incompleteness.

mod pages;
mod pictures;
mod sizes;
mod synthetic;
