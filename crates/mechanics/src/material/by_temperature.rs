use super::{
    Constants, ConstantsError, Lame, Linearity, Material, MaterialError, Order, Response, Strain,
};
use signorini_geometry::tensor::Sym3;

/// Isotropic linear elasticity whose constants depend on temperature: the law of Saint Venant and Kirchhoff with Young's
/// modulus and Poisson's ratio of the temperature at the point.
///
/// Both are interpolated linearly between the temperatures of the table, and constant outside.
#[derive(Clone, Debug)]
pub struct ByTemperature {
    /// Rows of temperature, Young's modulus, Poisson's ratio.
    table: Vec<[f64; 3]>,
}

impl ByTemperature {
    /// From the constants `T`, which increase, `E` and `nu`: lists of one length.
    ///
    /// # Errors
    /// One is missing or out of its range, or the lists do not fit each other.
    pub fn new(constants: &Constants) -> Result<Self, ConstantsError> {
        let [t, e, nu] = ["T", "E", "nu"].map(|name| constants.list(name));
        let (t, e, nu) = (t?, e?, nu?);
        if t.len() != e.len() || t.len() != nu.len() {
            return Err(ConstantsError::Unfit {
                what: "T, E and nu must have as many numbers each",
            });
        }
        if !t.windows(2).all(|pair| pair[0] < pair[1]) {
            return Err(ConstantsError::Unfit {
                what: "the temperatures T must increase",
            });
        }
        for (&e, &nu) in e.iter().zip(nu) {
            Constants::elastic(e, nu).isotropic()?;
        }
        let rows = t.iter().zip(e).zip(nu);
        Ok(Self {
            table: rows.map(|((&t, &e), &nu)| [t, e, nu]).collect(),
        })
    }

    fn lame(&self, temperature: f64) -> Lame {
        let [_, e, nu] = interpolate(&self.table, temperature);
        Lame::new(e, nu)
    }
}

impl Material for ByTemperature {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        self.lame(strain.temperature)
            .respond(&strain.value, order, out);
        if order == Order::Tangent {
            let [_, e, nu] = interpolate(&self.table, strain.temperature);
            let [_, de, dnu] = slope(&self.table, strain.temperature);
            let [lambda, mu] = lame_slopes([e, nu], [de, dnu]);
            out.thermal =
                Sym3::IDENTITY * (lambda * strain.value.trace()) + strain.value * (2.0 * mu);
        }
        Ok(())
    }

    /// At the temperature at which it is stiffest.
    fn modulus(&self) -> f64 {
        let lames = self.table.iter().map(|&[_, e, nu]| Lame::new(e, nu));
        lames.map(|l| l.lambda + 2.0 * l.mu).fold(0.0, f64::max)
    }

    /// At one temperature.
    fn linearity(&self) -> Linearity {
        Linearity::SmallStrain
    }
}

/// How (E1) changes with its constants `E`, `ν`.
fn lame_slopes([e, nu]: [f64; 2], [de, dnu]: [f64; 2]) -> [f64; 2] {
    let (one, two) = (1.0 + nu, 1.0 - 2.0 * nu);
    let lambda = de * nu / (one * two) + dnu * e * (1.0 + 2.0 * nu * nu) / (one * two).powi(2);
    let mu = 0.5 * (de - dnu * e / one) / one;
    [lambda, mu]
}

/// The row of a table at a value of its first column: linear between rows, constant outside; zeros of an empty table.
pub(super) fn interpolate<const N: usize>(table: &[[f64; N]], at: f64) -> [f64; N] {
    let next = table.partition_point(|row| row[0] <= at);
    match (
        next.checked_sub(1).and_then(|i| table.get(i)),
        table.get(next),
    ) {
        (Some(low), Some(high)) => {
            let share = (at - low[0]) / (high[0] - low[0]);
            std::array::from_fn(|i| low[i] + share * (high[i] - low[i]))
        }
        (Some(only), None) | (None, Some(only)) => *only,
        (None, None) => [0.0; N],
    }
}

/// How the row of a table changes with its first column: the slope of the segment, zero outside of the table.
pub(super) fn slope<const N: usize>(table: &[[f64; N]], at: f64) -> [f64; N] {
    let next = table.partition_point(|row| row[0] <= at);
    let below = next.checked_sub(1).and_then(|i| table.get(i));
    match below.zip(table.get(next)) {
        Some((low, high)) => std::array::from_fn(|i| (high[i] - low[i]) / (high[0] - low[0])),
        None => [0.0; N],
    }
}
