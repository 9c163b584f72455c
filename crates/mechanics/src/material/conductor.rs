use signorini_geometry::tensor::{Mat3, Sym3};
use thiserror::Error;

/// How a material conducts and stores heat.
///
/// ```text
/// Q = −k(T) ∇T,    ρ e(T) = ρ ∫ c dT + ρ Σ L φ(T)
/// ```
///
/// with the conductivity `k` along the axes of the material, the specific heat `c`, and for each change of phase its latent heat
/// `L` times the part `φ` of it that is done, which grows evenly from 0 at its solidus to 1 at its liquidus. Tables are linear
/// between rows and constant outside.
///
/// # Example
/// ```
/// use signorini_mechanics::material::Conductor;
///
/// let steel = Conductor::isotropic(50.0).storing(7800.0, vec![[20.0, 450.0], [120.0, 500.0]])?;
/// let [heat, slope] = steel.stored([20.0, 120.0]);
/// assert!((heat - 7800.0 * 475.0 * 100.0).abs() < 1e-6);
/// assert_eq!(slope, 7800.0 * 500.0);
/// # Ok::<(), signorini_mechanics::material::ConductorError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Conductor {
    /// Rows of temperature and conductivity, temperatures increasing.
    conductivity: Vec<(f64, Sym3)>,
    is_isotropic: bool,
    /// Rows of temperature, specific heat, and heat per mass from the first row on.
    specific_heat: Vec<[f64; 3]>,
    /// Latent heats per mass with solidus and liquidus.
    latent: Vec<[f64; 3]>,
    density: f64,
}

/// Why numbers make no conductor.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ConductorError {
    /// A table without rows, or whose temperatures do not increase.
    #[error("the temperatures of {what} must increase")]
    Order {
        /// Of what.
        what: &'static str,
    },
    /// A conductivity that lets heat flow from cold to warm.
    #[error("the conductivity at temperature {temperature} must be positive in all directions")]
    Conductivity {
        /// Where.
        temperature: f64,
    },
    /// A number that must be positive.
    #[error("{what} must be positive")]
    Positive {
        /// Which.
        what: &'static str,
    },
    /// A change of phase that ends before it begins.
    #[error("the liquidus {liquidus} must be above the solidus {solidus}")]
    Phase {
        /// Where it begins.
        solidus: f64,
        /// Where it ends.
        liquidus: f64,
    },
}

impl Conductor {
    /// The same conductivity in all directions and at all temperatures, of a material that stores nothing.
    #[must_use]
    pub fn isotropic(conductivity: f64) -> Self {
        Self {
            conductivity: vec![(0.0, Sym3::IDENTITY * conductivity)],
            is_isotropic: true,
            specific_heat: Vec::new(),
            latent: Vec::new(),
            density: 0.0,
        }
    }

    /// From rows of temperature and conductivity along the axes of the material.
    ///
    /// # Errors
    /// No rows, temperatures that do not increase, a conductivity that is not positive in all directions.
    pub fn new(conductivity: Vec<(f64, Sym3)>) -> Result<Self, ConductorError> {
        let what = "the conductivity";
        ordered(conductivity.iter().map(|(at, _)| *at), what)?;
        for &(temperature, k) in &conductivity {
            let least = k.eigenvalues().into_iter().fold(f64::INFINITY, f64::min);
            if least.is_nan() || least <= 0.0 {
                return Err(ConductorError::Conductivity { temperature });
            }
        }
        let is_isotropic = conductivity
            .iter()
            .all(|(_, k)| *k == Sym3::IDENTITY * k.xx());
        Ok(Self {
            conductivity,
            is_isotropic,
            ..Self::isotropic(1.0)
        })
    }

    /// The same storing heat: with a density, and rows of temperature and specific heat.
    ///
    /// # Errors
    /// No rows, temperatures that do not increase, a number that is not positive.
    pub fn storing(
        mut self,
        density: f64,
        specific_heat: Vec<[f64; 2]>,
    ) -> Result<Self, ConductorError> {
        ordered(specific_heat.iter().map(|row| row[0]), "the specific heat")?;
        let heats = specific_heat
            .iter()
            .map(|row| (row[1], "the specific heat"));
        for (value, what) in heats.chain([(density, "the density")]) {
            if value.is_nan() || value <= 0.0 {
                return Err(ConductorError::Positive { what });
            }
        }
        self.density = density;
        self.specific_heat.clear();
        let mut before: Option<[f64; 3]> = None;
        for [at, c] in specific_heat {
            let heat = before.map_or(0.0, |[t, last, heat]| heat + 0.5 * (last + c) * (at - t));
            before = Some([at, c, heat]);
            self.specific_heat.extend(before);
        }
        Ok(self)
    }

    /// The same with a change of phase: its latent heat per mass, and the temperatures between which it happens.
    ///
    /// # Errors
    /// A liquidus that is not above the solidus, a latent heat that is not positive.
    pub fn melting(
        mut self,
        heat: f64,
        [solidus, liquidus]: [f64; 2],
    ) -> Result<Self, ConductorError> {
        if heat.is_nan() || heat <= 0.0 {
            let what = "the latent heat";
            return Err(ConductorError::Positive { what });
        }
        let is_above = liquidus > solidus;
        if !is_above {
            return Err(ConductorError::Phase { solidus, liquidus });
        }
        self.latent.push([heat, solidus, liquidus]);
        Ok(self)
    }

    /// Whether it conducts alike in all directions.
    #[must_use]
    pub const fn is_isotropic(&self) -> bool {
        self.is_isotropic
    }

    /// Whether it conducts alike, and stores as much per temperature, at all temperatures.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.conductivity.len() < 2 && self.specific_heat.len() < 2 && self.latent.is_empty()
    }

    /// Whether it stores heat.
    #[must_use]
    pub const fn stores(&self) -> bool {
        !self.specific_heat.is_empty()
    }

    /// Conductivity at a temperature, and its derivative.
    #[must_use]
    pub fn conductivity(&self, temperature: f64) -> [Sym3; 2] {
        let next = self
            .conductivity
            .partition_point(|(at, _)| *at <= temperature);
        let below = next.checked_sub(1).and_then(|k| self.conductivity.get(k));
        match (below, self.conductivity.get(next)) {
            (Some((from, low)), Some((to, high))) => {
                let slope = (*high - *low) * (to - from).recip();
                [*low + slope * (temperature - from), slope]
            }
            (Some((_, only)), None) | (None, Some((_, only))) => [*only, Sym3::ZERO],
            (None, None) => [Sym3::ZERO; 2],
        }
    }

    /// Heat per volume that it takes from one temperature to another, and the derivative with respect to the latter.
    #[must_use]
    pub fn stored(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let [before, _] = self.enthalpy(from, from);
        let [after, slope] = self.enthalpy(to, from);
        [self.density * (after - before), self.density * slope]
    }

    /// Heat per mass at a temperature, from where the table begins, or from `origin` where it has one row; and its slope.
    fn enthalpy(&self, at: f64, origin: f64) -> [f64; 2] {
        let next = self.specific_heat.partition_point(|row| row[0] <= at);
        let below = next.checked_sub(1).and_then(|k| self.specific_heat.get(k));
        let mut of = match (below, self.specific_heat.get(next)) {
            (Some(&[_, c, _]), None) | (None, Some(&[_, c, _]))
                if self.specific_heat.len() == 1 =>
            {
                [c * (at - origin), c]
            }
            (Some(&[t, c, heat]), Some(&[end, last, _])) => {
                let here = c + (last - c) * (at - t) / (end - t);
                [heat + 0.5 * (c + here) * (at - t), here]
            }
            (Some(&[t, c, heat]), None) | (None, Some(&[t, c, heat])) => [heat + c * (at - t), c],
            (None, None) => [0.0; 2],
        };
        for &[heat, solidus, liquidus] in &self.latent {
            let done = (at - solidus) / (liquidus - solidus);
            of[0] += heat * done.clamp(0.0, 1.0);
            if (0.0..1.0).contains(&done) {
                of[1] += heat / (liquidus - solidus);
            }
        }
        of
    }

    /// The largest conductivity at any temperature.
    #[must_use]
    pub fn largest(&self) -> f64 {
        let all = self.conductivity.iter().flat_map(|(_, k)| k.eigenvalues());
        all.fold(0.0, f64::max)
    }
}

/// Flux against a gradient of temperature within a body that deforms: `D = J F⁻¹ k F⁻ᵀ`, with `k` turned by the rotation of the
/// polar decomposition of `F` where it has directions; THERMAL (1).
pub(crate) fn pulled_back(k: Sym3, turns: bool, f: Mat3, inverse: Mat3, ratio: f64) -> Sym3 {
    let k = if turns {
        k.congruence(polar_rotation(f))
    } else {
        k
    };
    k.congruence(inverse) * ratio
}

/// The rotation of the polar decomposition, by averaging with the inverse transpose (Higham 1986).
fn polar_rotation(f: Mat3) -> Mat3 {
    /// Quadratic convergence: enough from anywhere near a rotation.
    const ITERATIONS: usize = 12;
    let mut r = f;
    for _ in 0..ITERATIONS {
        let Some((inverse, _)) = r.inverse() else {
            return Mat3::IDENTITY;
        };
        r = (r + inverse.transpose()) * 0.5;
    }
    r
}

fn ordered(
    temperatures: impl Iterator<Item = f64>,
    what: &'static str,
) -> Result<(), ConductorError> {
    let mut last = None;
    for at in temperatures {
        let follows = last.is_none_or(|last| at > last);
        if !follows || !at.is_finite() {
            return Err(ConductorError::Order { what });
        }
        last = Some(at);
    }
    match last {
        Some(_) => Ok(()),
        None => Err(ConductorError::Order { what }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::tensor::Vec3;

    fn largest(of: Sym3) -> f64 {
        of.to_pairs()
            .into_iter()
            .fold(0.0, |most: f64, k| most.max(k.abs()))
    }

    fn tabulated() -> Conductor {
        let k = |size: f64| Sym3::new(size, 2.0 * size, 0.5 * size, 0.1, 0.0, 0.2);
        let rows = vec![(0.0, k(1.0)), (10.0, k(3.0)), (40.0, k(2.0))];
        let c = vec![[-5.0, 1.0], [5.0, 2.0], [25.0, 1.5]];
        let conductor = Conductor::new(rows).and_then(|one| one.storing(3.0, c));
        conductor
            .and_then(|one| one.melting(40.0, [12.0, 15.0]))
            .unwrap()
    }

    #[test]
    fn slopes_match_differences_within_rows_and_outside() {
        let (one, h) = (tabulated(), 1e-6);
        for at in [-9.0, -2.0, 3.0, 7.0, 13.0, 20.0, 33.0, 70.0] {
            let [k, dk] = one.conductivity(at);
            let difference =
                (one.conductivity(at + h)[0] - one.conductivity(at - h)[0]) * (0.5 / h);
            assert!(largest(difference - dk) < 1e-8 * largest(k));
            let [_, slope] = one.stored([4.0, at]);
            let difference =
                (one.stored([4.0, at + h])[0] - one.stored([4.0, at - h])[0]) * (0.5 / h);
            assert!((difference - slope).abs() < 1e-7 * slope);
        }
    }

    #[test]
    fn heat_that_goes_in_comes_out_whatever_the_way() {
        let one = tabulated();
        let at = [-9.0, 2.0, 12.5, 60.0, 14.0, -9.0];
        let ways = at.windows(2).map(|ends| one.stored([ends[0], ends[1]])[0]);
        let sum: f64 = ways.sum();
        assert!(sum.abs() < 1e-12 * one.stored([-9.0, 60.0])[0]);
        // the trapezoids of the table, its last row, and the latent heat
        let expected = 3.0 * (15.0 + 35.0 + 1.5 * 35.0 + 40.0);
        assert!((one.stored([-5.0, 60.0])[0] - expected).abs() < 1e-12 * expected);
    }

    #[test]
    fn constant_heat_keeps_its_digits_far_from_zero() {
        let one = Conductor::isotropic(1.0)
            .storing(2.0, vec![[0.0, 3.0]])
            .unwrap();
        let [heat, _] = one.stored([1e9, 1e9 + 0.5]);
        assert_eq!(heat, 3.0);
    }

    #[test]
    fn what_turns_with_the_body_has_the_same_flux_in_it() {
        let k = Sym3::new(3.0, 1.0, 0.5, 0.2, 0.1, -0.3);
        let stretch = Mat3 {
            rows: [
                Vec3::new(1.2, 0.1, 0.0),
                Vec3::new(0.1, 0.9, 0.05),
                Vec3::new(0.0, 0.05, 1.1),
            ],
        };
        let of = |f: Mat3| {
            let (inverse, ratio) = f.inverse().unwrap();
            pulled_back(k, true, f, inverse, ratio)
        };
        let turned = Mat3::rotation(Vec3::new(0.4, -0.7, 0.5)) * stretch;
        assert!(largest(of(stretch) - of(turned)) < 1e-14);
        assert!(largest(of(Mat3::IDENTITY) - k) < 1e-15);
    }

    #[test]
    fn numbers_that_make_no_conductor_are_refused() {
        let k = Sym3::IDENTITY;
        assert!(Conductor::new(Vec::new()).is_err());
        assert!(Conductor::new(vec![(1.0, k), (1.0, k)]).is_err());
        assert!(Conductor::new(vec![(1.0, k * -1.0)]).is_err());
        let one = Conductor::isotropic(1.0);
        assert!(one.clone().storing(0.0, vec![[0.0, 1.0]]).is_err());
        assert!(one.clone().storing(1.0, vec![[0.0, f64::NAN]]).is_err());
        assert!(one.clone().melting(1.0, [3.0, 3.0]).is_err());
        assert!(one.melting(-1.0, [3.0, 4.0]).is_err());
    }
}
