//! Contact surfaces.
