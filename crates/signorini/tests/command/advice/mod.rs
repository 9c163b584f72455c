//! Every message about ill-posed models and convergence names what it is about, and its remedy works.
//!
//! Each test provokes a message, reads the remedy from it, puts it into the case, and runs that.

mod blocks;
mod convergence;
mod model;
mod trial;
