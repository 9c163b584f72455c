//! Friction laws: the largest tangential traction as a function of pressure and slip.
//!
//! A law is its limit surface; sticking, slipping and the return to the limit are written once for all of them, in the
//! kernel.
//!
//! | law | limit |
//! |---|---|
//! | [`Coulomb`] | `μ p`, at most a cap |
//! | [`Tresca`] | a constant |
//! | [`Falling`] | `μ p` with a coefficient that falls with the length of slip |
//!
//! To add one: a file that implements [`FrictionLaw`] and describes its keys, and one line in [`TABLE`].

mod coulomb;
mod definition;
mod falling;
mod tresca;

pub use coulomb::Coulomb;
pub use definition::{FrictionLaw, Limit, Sliding, Stick};
pub use falling::Falling;
pub use tresca::Tresca;

use signorini_vocabulary::{Description, Entry};
use std::sync::Arc;

/// The friction laws that a case may choose, each by its first key.
pub static TABLE: [Entry<Arc<dyn FrictionLaw>>; 3] =
    [coulomb::ENTRY, tresca::ENTRY, falling::ENTRY];

/// The names and keys of all laws of [`TABLE`].
#[must_use]
pub fn descriptions() -> Vec<Description> {
    TABLE.iter().map(|entry| entry.description).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_differences() {
        let laws: [&dyn FrictionLaw; 4] = [
            &Coulomb {
                mu: 0.3,
                cap: f64::INFINITY,
            },
            &Coulomb { mu: 0.3, cap: 0.5 },
            &Tresca(0.7),
            &Falling {
                stationary: 0.4,
                kinetic: 0.2,
                transition: 0.1,
            },
        ];
        for law in laws {
            for pressure in [0.1, 1.0, 4.0] {
                let limit = |pressure| {
                    law.limit(&Sliding {
                        pressure,
                        path: 0.05,
                    })
                };
                let h = 1e-6;
                let slope = (limit(pressure + h).value - limit(pressure - h).value) / (2.0 * h);
                assert!((limit(pressure).dpressure - slope).abs() < 1e-8);
                assert!(limit(pressure).value >= 0.0);
            }
        }
    }

    #[test]
    fn friction_falls_from_static_to_kinetic() {
        let law = Falling {
            stationary: 0.4,
            kinetic: 0.2,
            transition: 0.1,
        };
        let mu = |path| {
            law.limit(&Sliding {
                pressure: 1.0,
                path,
            })
            .value
        };
        assert_eq!(mu(0.0), 0.4);
        assert!((mu(0.1) - (0.2 + 0.2 * (-1.0f64).exp())).abs() < 1e-15);
        assert!((mu(10.0) - 0.2).abs() < 1e-15);
    }

    #[test]
    fn a_cap_cuts_the_limit_off() {
        let law = Coulomb { mu: 0.5, cap: 1.0 };
        let limit = |pressure| {
            law.limit(&Sliding {
                pressure,
                path: 0.0,
            })
        };
        assert_eq!((limit(1.0).value, limit(1.0).dpressure), (0.5, 0.5));
        assert_eq!((limit(2.0).value, limit(2.0).dpressure), (1.0, 0.0));
        assert_eq!(limit(9.0).value, 1.0);
        assert_eq!(limit(0.0).value, 0.0);
    }
}
