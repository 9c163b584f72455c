use super::{
    Constants, ConstantsError, Lame, Linearity, Material, MaterialError, Order, Response, Strain,
};

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
