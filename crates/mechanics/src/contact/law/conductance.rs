//! What heat flows between two sides, over the difference of their temperatures.

use super::{Scale, TOUCH};

/// A way that heat takes between two sides; several add up.
///
/// | way | h |
/// |---|---|
/// | `Constant` | h where the sides touch |
/// | `OverPressure` | of rows of pressure and h, linear between and constant outside |
/// | `OverGap` | of rows of gap and h, linear between, constant before the first and 0 beyond the last |
/// | `Power` | h₀ (((p + p₀)/H)ⁿ − (p₀/H)ⁿ), for n < 1 with a p₀ far below all pressures: slopes at p = 0 are finite; else p₀ = 0 |
/// | `Gas` | k/(⟨g⟩ + g₀) |
/// | `Radiation` | σ_r (Θ₁² + Θ₂²)(Θ₁ + Θ₂), with σ_r = σ/(1/ε₁ + 1/ε₂ − 1) and absolute temperatures Θ |
///
/// # Source
/// Cooper, Mikić and Yovanovich, Int. J. Heat Mass Transfer 12, 1969: n = 0.95 and h₀ = 1.25 k m/σ with the slope m and the
/// roughness σ of the surfaces.
#[derive(Clone, Debug, PartialEq)]
pub enum Conductance {
    /// h.
    Constant(f64),
    /// Rows of pressure and h.
    OverPressure(Vec<[f64; 2]>),
    /// Rows of gap and h.
    OverGap(Vec<[f64; 2]>),
    /// h₀, H and n.
    Power {
        /// h₀.
        h0: f64,
        /// H, a hardness (pressure).
        hardness: f64,
        /// n.
        exponent: f64,
    },
    /// k, a conductivity, and g₀, a length.
    Gas {
        /// k.
        conductivity: f64,
        /// g₀.
        jump: f64,
    },
    /// σ_r and absolute zero.
    Radiation {
        /// σ_r.
        factor: f64,
        /// Absolute zero on the scale of temperatures.
        zero: f64,
    },
}

/// Where a conductance is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Between {
    /// The pressure, ≥ 0.
    pub pressure: f64,
    /// The gap.
    pub gap: f64,
    /// The mean of both temperatures.
    pub mean: f64,
    /// The temperature of the secondary side less that of the primary.
    pub jump: f64,
}

/// A conductance with its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conducted {
    /// Heat per time, area and temperature.
    pub h: f64,
    /// With respect to the pressure.
    pub dpressure: f64,
    /// With respect to the gap.
    pub dgap: f64,
    /// With respect to the mean temperature.
    pub dmean: f64,
    /// With respect to the jump of temperature.
    pub djump: f64,
}

/// p₀ over the pressure that a penalty has at a gap of the size of facets, where slopes need one.
const ROUNDING: f64 = 1e-8;

impl Conductance {
    /// The gap up to which it conducts; none where it conducts at any.
    #[must_use]
    pub fn reach(&self) -> Option<f64> {
        match self {
            Self::Constant(_) | Self::OverPressure(_) | Self::Power { .. } => Some(0.0),
            Self::OverGap(table) => table.last().map(|row| row[0].max(0.0)),
            Self::Gas { .. } | Self::Radiation { .. } => None,
        }
    }

    /// What it conducts.
    #[must_use]
    pub fn at(&self, at: &Between, scale: &Scale) -> Conducted {
        let touches = at.pressure > 0.0 || at.gap <= TOUCH * scale.length;
        match self {
            Self::Constant(h) => Conducted {
                h: if touches { *h } else { 0.0 },
                ..Conducted::default()
            },
            Self::OverPressure(table) if touches => {
                let [h, dpressure] = looked_up(table, at.pressure);
                Conducted {
                    h,
                    dpressure,
                    ..Conducted::default()
                }
            }
            Self::OverPressure(_) => Conducted::default(),
            Self::OverGap(table) => {
                let is_beyond = table.last().is_none_or(|last| at.gap > last[0]);
                let [h, dgap] = match is_beyond {
                    true => [0.0; 2],
                    false => looked_up(table, at.gap),
                };
                Conducted {
                    h,
                    dgap,
                    ..Conducted::default()
                }
            }
            Self::Power {
                h0,
                hardness,
                exponent,
            } => {
                let least = match *exponent < 1.0 {
                    true => ROUNDING * scale.penalty * scale.length,
                    false => 0.0,
                };
                let [now, none] = [at.pressure + least, least].map(|p| p / hardness);
                Conducted {
                    h: h0 * (now.powf(*exponent) - none.powf(*exponent)),
                    dpressure: h0 * exponent * now.powf(exponent - 1.0) / hardness,
                    ..Conducted::default()
                }
            }
            Self::Gas { conductivity, jump } => {
                let wide = at.gap.max(0.0) + jump;
                let h = conductivity / wide;
                Conducted {
                    h,
                    dgap: if at.gap > 0.0 { -h / wide } else { 0.0 },
                    ..Conducted::default()
                }
            }
            Self::Radiation { factor, zero } => {
                // (Θ₁² + Θ₂²)(Θ₁ + Θ₂) with Θ = m ± ½ j
                let (m, j) = (at.mean - zero, at.jump);
                Conducted {
                    h: factor * m * (4.0 * m * m + j * j),
                    dmean: factor * (12.0 * m * m + j * j),
                    djump: 2.0 * factor * m * j,
                    ..Conducted::default()
                }
            }
        }
    }
}

impl Conducted {
    /// A part of it.
    #[must_use]
    pub fn times(self, part: f64) -> Self {
        Self {
            h: self.h * part,
            dpressure: self.dpressure * part,
            dgap: self.dgap * part,
            dmean: self.dmean * part,
            djump: self.djump * part,
        }
    }
}

impl std::ops::AddAssign for Conducted {
    fn add_assign(&mut self, other: Self) {
        self.h += other.h;
        self.dpressure += other.dpressure;
        self.dgap += other.dgap;
        self.dmean += other.dmean;
        self.djump += other.djump;
    }
}

/// Value and slope of a table that is linear between rows and constant outside.
fn looked_up(table: &[[f64; 2]], at: f64) -> [f64; 2] {
    let next = table.partition_point(|row| row[0] <= at);
    let below = next.checked_sub(1).and_then(|k| table.get(k));
    match (below, table.get(next)) {
        (Some(a), Some(b)) => {
            let slope = (b[1] - a[1]) / (b[0] - a[0]);
            [a[1] + slope * (at - a[0]), slope]
        }
        (Some(only), None) | (None, Some(only)) => [only[1], 0.0],
        (None, None) => [0.0; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: Scale = Scale {
        penalty: 1e4,
        shear: 1e4,
        length: 0.5,
    };

    fn all() -> Vec<Conductance> {
        vec![
            Conductance::Constant(3.0),
            Conductance::OverPressure(vec![[0.0, 1.0], [10.0, 5.0], [30.0, 6.0]]),
            Conductance::OverGap(vec![[-0.1, 9.0], [0.0, 8.0], [0.2, 1.0]]),
            Conductance::Power {
                h0: 7.0,
                hardness: 100.0,
                exponent: 0.95,
            },
            Conductance::Gas {
                conductivity: 0.3,
                jump: 0.02,
            },
            Conductance::Radiation {
                factor: 5e-8,
                zero: -273.0,
            },
        ]
    }

    #[test]
    fn derivatives_match_differences() {
        for one in all() {
            for (pressure, gap) in [(4.0, -0.01), (17.0, -0.05), (0.0, 0.1), (0.0, 0.5)] {
                let at = Between {
                    pressure,
                    gap,
                    mean: 40.0,
                    jump: -13.0,
                };
                let conducted = one.at(&at, &SCALE);
                let check = |slope: f64, h: f64, shift: &dyn Fn(f64) -> Between| {
                    let ends = [h, -h].map(|d| one.at(&shift(d), &SCALE).h);
                    let difference = (ends[0] - ends[1]) / (2.0 * h);
                    assert!((difference - slope).abs() < 1e-6 * conducted.h.abs().max(1.0));
                };
                let h = 1e-5;
                if pressure > 0.0 {
                    check(conducted.dpressure, h, &|d| Between {
                        pressure: pressure + d,
                        ..at
                    });
                }
                check(conducted.dgap, h, &|d| Between { gap: gap + d, ..at });
                check(conducted.dmean, h, &|d| Between {
                    mean: 40.0 + d,
                    ..at
                });
                check(conducted.djump, h, &|d| Between {
                    jump: d - 13.0,
                    ..at
                });
            }
        }
    }

    #[test]
    fn radiation_is_the_difference_of_fourth_powers() {
        let radiation = Conductance::Radiation {
            factor: 5e-8,
            zero: -273.0,
        };
        let at = Between {
            mean: 50.0,
            jump: 60.0,
            ..Between::default()
        };
        let [one, other]: [f64; 2] = [80.0 + 273.0, 20.0 + 273.0];
        let expected = 5e-8 * (one.powi(4) - other.powi(4));
        assert!((radiation.at(&at, &SCALE).h * 60.0 - expected).abs() < 1e-12 * expected);
    }

    #[test]
    fn what_is_beyond_reach_conducts_nothing() {
        for one in all() {
            let Some(reach) = one.reach() else { continue };
            let at = Between {
                gap: reach + 1e-9,
                ..Between::default()
            };
            assert_eq!(one.at(&at, &SCALE).h, 0.0, "{one:?}");
        }
    }
}
