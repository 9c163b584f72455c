//! The shapes that a case may choose by name.

use super::analytical::Shape;
use super::error::AnalyticalError;
use super::{cone, cylinder, plane, polynomial, sphere, torus};
use signorini_vocabulary::{Description, Entry};

/// The shapes that a case may choose by name.
pub static TABLE: [Entry<Box<dyn Shape>, AnalyticalError>; 7] = [
    plane::ENTRY,
    sphere::CIRCLE,
    sphere::ENTRY,
    cylinder::ENTRY,
    cone::ENTRY,
    torus::ENTRY,
    polynomial::ENTRY,
];

/// The names and keys of all shapes of [`TABLE`].
#[must_use]
pub fn descriptions() -> Vec<Description> {
    TABLE.iter().map(|entry| entry.description).collect()
}
