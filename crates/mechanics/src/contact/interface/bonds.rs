//! What rows of bonds that may break remember.

use crate::contact::cohesion::{Damage, Torn};
use signorini_geometry::tensor::{Mat3, Vec3};

/// Numbers of a row in a checkpoint.
const NUMBERS: usize = 11;

/// Rows of bonds that may break: the accepted values, and those that the present increment works with. These stay until the
/// next begins, so that the report of an accepted state is of the forces that acted in it.
#[derive(Debug, Default)]
pub(super) struct Bonds {
    pub accepted: Vec<Bond>,
    pub before: Vec<Bond>,
    /// What damage has released, and what viscosity has taken.
    pub spent: [f64; 2],
}

/// What a row remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bond {
    pub torn: Torn,
    /// The whole stretch.
    pub stretch: Vec3,
    /// ν.
    pub normal: Vec3,
}

impl Bond {
    /// The same where its normal has turned.
    pub fn turned(self, normal: Vec3) -> Self {
        let turn = turn_between(self.normal, normal);
        Self {
            torn: Torn {
                sticks: turn * self.torn.sticks,
                ..self.torn
            },
            stretch: turn * self.stretch,
            normal,
        }
    }
}

/// The smallest rotation of a unit vector to another; none where there is no such vector yet.
pub(super) fn turn_between(from: Vec3, to: Vec3) -> Mat3 {
    let (axis, cosine) = (from.cross(to), from.dot(to));
    match axis.normalized() {
        Some(unit) if from != Vec3::ZERO => Mat3::rotation(unit * axis.norm().atan2(cosine)),
        _ => Mat3::IDENTITY,
    }
}

impl Bonds {
    /// How many numbers there are of these rows.
    pub const fn length(nrow: usize) -> usize {
        nrow * NUMBERS + 2
    }

    pub fn to_numbers(&self) -> Vec<f64> {
        let of_row = |bond: &Bond| {
            let Torn { damage, sticks } = bond.torn;
            let vectors = [sticks, bond.stretch, bond.normal].map(Vec3::to_array);
            let damage = [damage.grown, damage.acting];
            damage.into_iter().chain(vectors.into_iter().flatten())
        };
        let spent = self.spent.into_iter();
        spent.chain(self.accepted.iter().flat_map(of_row)).collect()
    }

    /// What [`Self::to_numbers`] gave.
    pub fn from_numbers(numbers: &[f64]) -> Self {
        let (spent, rows) = numbers.split_at_checked(2).unwrap_or_default();
        let of_row = |n: &[f64; NUMBERS]| {
            let &[grown, acting, a, b, c, x, y, z, u, v, w] = n;
            Bond {
                torn: Torn {
                    damage: Damage { grown, acting },
                    sticks: Vec3::new(a, b, c),
                },
                stretch: Vec3::new(x, y, z),
                normal: Vec3::new(u, v, w),
            }
        };
        Self {
            accepted: rows.as_chunks().0.iter().map(of_row).collect(),
            before: Vec::new(),
            spent: spent.try_into().unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_rotation_takes_one_vector_to_the_other() {
        let along = |x, y, z| Vec3::new(x, y, z).normalized().unwrap();
        for (from, to) in [
            (Vec3::unit(2), along(0.1, -0.2, 1.0)),
            (along(1.0, 2.0, -0.5), along(-0.3, 2.0, 0.5)),
            (Vec3::unit(1), Vec3::unit(1)),
        ] {
            let turn = turn_between(from, to);
            assert!((turn * from - to).norm() < 1e-15);
            let axis = from.cross(to);
            assert!((turn * axis - axis).norm() < 1e-15);
        }
        assert_eq!(turn_between(Vec3::ZERO, Vec3::unit(0)), Mat3::IDENTITY);
    }

    #[test]
    fn bonds_are_the_same_after_they_were_numbers() {
        let bond = Bond {
            torn: Torn {
                damage: Damage {
                    grown: 0.4,
                    acting: 0.3,
                },
                sticks: Vec3::new(1.0, 2.0, 3.0),
            },
            stretch: Vec3::new(4.0, 5.0, 6.0),
            normal: Vec3::unit(1),
        };
        let bonds = Bonds {
            accepted: vec![Bond::default(), bond],
            before: Vec::new(),
            spent: [7.0, 8.0],
        };
        let numbers = bonds.to_numbers();
        assert_eq!(numbers.len(), Bonds::length(2));
        let again = Bonds::from_numbers(&numbers);
        assert_eq!((again.accepted, again.spent), (bonds.accepted, bonds.spent));
    }
}
