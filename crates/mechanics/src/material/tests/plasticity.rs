//! Plasticity against curves, loops and rate equations.

use super::*;
