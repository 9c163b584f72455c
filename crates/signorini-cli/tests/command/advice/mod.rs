//! Every message about ill-posed models and convergence names what it is about, and its remedy works.
//!
//! Each test provokes a message, reads the remedy from it, puts it into the case, and runs that.

mod audits;
mod blocks;
mod choices;
mod constraints;
mod convergence;
mod loads;
mod model;
mod numbers;
mod start;
mod surfaces;
mod trial;
