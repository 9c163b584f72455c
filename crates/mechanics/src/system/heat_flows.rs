//! Where the heat of bodies comes from and goes to.

use super::{Assembly, Layout};
use signorini_geometry::mesh::NodeId;
use std::ops::AddAssign;

/// Heat per time into bodies, or heat.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeatFlows {
    /// Through loads: fluxes, powers, sources, films and radiation.
    pub loads: f64,
    /// From what holds temperatures.
    pub supports: f64,
    /// From rigid surfaces that have a temperature, less what they take of the heat of friction.
    pub surfaces: f64,
    /// Set free by friction.
    pub friction: f64,
    /// What bodies take up.
    pub stored: f64,
}

impl HeatFlows {
    /// The number of flows.
    pub const N: usize = 5;

    /// All that comes in, less what bodies take up.
    #[must_use]
    pub fn imbalance(&self) -> f64 {
        self.loads + self.supports + self.surfaces + self.friction - self.stored
    }

    /// The numbers in the order of the fields.
    #[must_use]
    pub const fn to_array(self) -> [f64; Self::N] {
        [
            self.loads,
            self.supports,
            self.surfaces,
            self.friction,
            self.stored,
        ]
    }

    /// Those of these numbers.
    #[must_use]
    pub const fn from_array(values: [f64; Self::N]) -> Self {
        let [loads, supports, surfaces, friction, stored] = values;
        Self {
            loads,
            supports,
            surfaces,
            friction,
            stored,
        }
    }

    /// Each of them this many times.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self::from_array(self.to_array().map(|value| value * factor))
    }
}

impl AddAssign for HeatFlows {
    fn add_assign(&mut self, other: Self) {
        let mut sum = self.to_array();
        let pairs = sum.iter_mut().zip(other.to_array());
        pairs.for_each(|(sum, value)| *sum += value);
        *self = Self::from_array(sum);
    }
}

/// The heat per time of a term: sums, and sums of absolute values over points, rows or cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SizedFlows {
    /// The sums.
    pub sum: HeatFlows,
    /// Those of absolute values.
    pub size: HeatFlows,
}

impl AddAssign for SizedFlows {
    fn add_assign(&mut self, other: Self) {
        self.sum += other.sum;
        self.size += other.size;
    }
}

impl SizedFlows {
    /// Adds one flow.
    pub fn add(&mut self, one: HeatFlows) {
        self.sum += one;
        self.size += HeatFlows::from_array(one.to_array().map(f64::abs));
    }
}

/// The balance of heat at an accepted state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeatBalance {
    /// Heat per time at the end of the increment; of what bodies take up and friction sets free, the mean over it.
    pub rate: HeatFlows,
    /// Heat since the start, in transient steps.
    pub total: HeatFlows,
    /// The largest of the flows, each as the sum of its sizes wherever it comes in or goes out.
    pub turnover: f64,
    /// Rounding errors of the sum of all flows.
    pub uncertainty: f64,
    /// What the iteration has left: the sum of the residuals where temperatures are free, heat per time.
    pub left: f64,
}

impl HeatBalance {
    /// That of an increment in which this much time passed, `None` where nothing stores heat, after this one.
    pub(crate) fn next(self, flows: &SizedFlows, dt: Option<f64>, left: [f64; 2]) -> Self {
        let [left, uncertainty] = left;
        let mut total = self.total;
        if let Some(dt) = dt {
            total += flows.sum.times(dt);
        }
        Self {
            rate: flows.sum,
            total,
            turnover: flows.size.to_array().into_iter().fold(0.0, f64::max),
            uncertainty,
            left,
        }
    }

    /// Nothing flows, as far as is known.
    pub(crate) fn rest(&mut self) {
        *self = Self {
            total: self.total,
            ..Self::default()
        };
    }

    /// What comes in and is not taken up, over the largest flow; 0 where that is rounding.
    #[must_use]
    pub fn imbalance(&self) -> f64 {
        self.part(self.rate.imbalance())
    }

    /// What the equations lose: the same without what the iteration has left.
    #[must_use]
    pub fn lost(&self) -> f64 {
        self.part(self.rate.imbalance() + self.left)
    }

    fn part(&self, of: f64) -> f64 {
        let counts = of.abs() > self.uncertainty && self.turnover > 0.0;
        if counts { of / self.turnover } else { 0.0 }
    }
}

/// What is left of the heat into nodes, from the assembly at the state: the sum of all residuals, and its rounding errors.
pub(crate) fn of_residuals(layout: &Layout, assembly: &Assembly) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for node in 0..layout.nnode() as NodeId {
        let dof = layout.temperature(node) as usize;
        let at = |values: &[f64]| values.get(dof).copied().unwrap_or_default();
        sums[0] += at(&assembly.residual);
        sums[1] += f64::EPSILON * at(&assembly.magnitude) + at(&assembly.uncertainty);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_in_and_is_not_stored_is_the_imbalance_where_it_is_more_than_rounding() {
        let mut flows = SizedFlows::default();
        for loads in [3.0, -1.0] {
            flows.add(HeatFlows {
                loads,
                ..HeatFlows::default()
            });
        }
        flows.add(HeatFlows {
            supports: 1.0,
            stored: 2.5,
            ..HeatFlows::default()
        });
        let balance = HeatBalance::default().next(&flows, None, [-0.3, 0.1]);
        assert_eq!((balance.turnover, balance.imbalance()), (4.0, 0.125));
        assert!((balance.lost() - 0.05).abs() < 1e-15);
        assert_eq!(balance.total, HeatFlows::default());
        let balance = balance.next(&flows, Some(2.0), [-0.4, 0.6]);
        assert_eq!((balance.imbalance(), balance.lost()), (0.0, 0.0));
        assert_eq!(balance.total.to_array(), [4.0, 2.0, 0.0, 0.0, 5.0]);
    }
}
