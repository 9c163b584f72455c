use super::by_temperature::{interpolate, slope};
use super::{Kinematics, Linearity, Material, MaterialError, Order, Response, Strain};
use signorini_geometry::tensor::Sym3;

/// A law with thermal expansion, the same in all directions.
///
/// With the strain `x` that a free body has, small strain: the law inside sees `ε − x I`. Finite strain: `F = θ F_e`,
/// `θ = 1 + x`,
///
/// ```text
/// W = θ³ W_e(E_e),    E_e = (E − ½(θ² − 1) I)/θ²,    S = θ S_e,    C = C_e/θ
/// ```
///
/// with `W_e` per volume of the body free of stress at `T`. `x = α (T − T_0)`, free of stress at `T_0`; where `α` depends
/// on temperature, it is a secant from `T_ref` on, and
///
/// ```text
/// x = α(T) (T − T_ref) − α(T_0) (T_0 − T_ref)
/// ```
///
/// Goes inside [`super::Reduced`] and outside of or inside [`super::Oriented`].
pub struct Expanding {
    inner: Box<dyn Material>,
    /// Rows of temperature and `α`, temperatures increasing.
    alpha: Vec<[f64; 2]>,
    /// `T_ref`
    reference: f64,
    /// `T_0`; none: what the temperature is at the start, at each point.
    free: Option<f64>,
}

impl Expanding {
    /// Wraps a law: `alpha` per degree, free of stress at the temperature `reference`.
    #[must_use]
    pub fn new(inner: Box<dyn Material>, alpha: f64, reference: f64) -> Self {
        Self::by_temperature(inner, vec![[reference, alpha]], reference, Some(reference))
    }

    /// Wraps a law: `alpha` are rows of temperature and secant strain per degree from the temperature `reference` on,
    /// temperatures increasing; linear between, constant outside. Free of stress at the temperature `free`;
    /// without one, at what the temperature of each point is at the start.
    #[must_use]
    pub fn by_temperature(
        inner: Box<dyn Material>,
        alpha: Vec<[f64; 2]>,
        reference: f64,
        free: Option<f64>,
    ) -> Self {
        Self {
            inner,
            alpha,
            reference,
            free,
        }
    }

    /// `α(T) (T − T_ref)`
    fn secant(&self, temperature: f64) -> f64 {
        let [_, alpha] = interpolate(&self.alpha, temperature);
        alpha * (temperature - self.reference)
    }

    /// `dx/dT`.
    fn growth_slope(&self, strain: &Strain) -> f64 {
        let [_, alpha] = interpolate(&self.alpha, strain.temperature);
        let [_, slope] = slope(&self.alpha, strain.temperature);
        alpha + slope * (strain.temperature - self.reference)
    }

    /// `x`.
    fn growth(&self, strain: &Strain) -> f64 {
        let free = self.free.unwrap_or(strain.temperature_at_start);
        self.secant(strain.temperature) - self.secant(free)
    }

    /// `θ`, and 1 at small strain.
    fn stretch(&self, strain: &Strain) -> f64 {
        match strain.kinematics {
            Kinematics::Small => 1.0,
            Kinematics::Finite => 1.0 + self.growth(strain),
        }
    }

    /// `E_e`, or `ε − x I` at small strain.
    fn elastic<'a>(&self, strain: &Strain<'a>) -> Strain<'a> {
        let (x, stretch) = (self.growth(strain), self.stretch(strain));
        let free = match strain.kinematics {
            Kinematics::Small => x,
            Kinematics::Finite => x * (1.0 + 0.5 * x),
        };
        Strain {
            value: (strain.value - Sym3::IDENTITY * free) * (stretch * stretch).recip(),
            ..*strain
        }
    }
}

impl Material for Expanding {
    fn nhistory(&self) -> usize {
        self.inner.nhistory()
    }

    fn start(&self, history: &mut [f64]) {
        self.inner.start(history);
    }

    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let stretch = self.stretch(strain);
        if stretch.is_nan() || stretch <= 0.0 {
            return Err(MaterialError::Shrunk { stretch });
        }
        let elastic = self.elastic(strain);
        out.thermal = Sym3::ZERO;
        self.inner.respond(&elastic, old, new, order, out)?;
        if order == Order::Tangent {
            let grows = self.growth_slope(strain);
            let (own, shrinks) = match strain.kinematics {
                Kinematics::Small => (Sym3::ZERO, Sym3::IDENTITY),
                // dS = x' S_e + θ C_e dE_e, dE_e = −x' (2 E_e + I)/θ
                Kinematics::Finite => (
                    out.stress * grows,
                    (elastic.value * 2.0 + Sym3::IDENTITY) * stretch.recip(),
                ),
            };
            let inner = out.thermal - through(&out.tangent, shrinks) * grows;
            out.thermal = own + inner * stretch;
        }
        out.stress = out.stress * stretch;
        out.energy *= stretch * stretch * stretch;
        if order == Order::Tangent {
            for value in out.tangent.as_flattened_mut() {
                *value /= stretch;
            }
        }
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.inner.modulus()
    }

    fn is_symmetric(&self) -> bool {
        self.inner.is_symmetric()
    }

    fn is_elastic(&self) -> bool {
        self.inner.is_elastic()
    }

    /// At one temperature.
    fn linearity(&self) -> Linearity {
        self.inner.linearity().within()
    }

    fn mechanical_strain(&self, strain: &Strain) -> Sym3 {
        self.inner.mechanical_strain(&self.elastic(strain))
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        self.inner.plastic_strain(history)
    }
}

/// `C : E`.
fn through(tangent: &[[f64; 6]; 6], strain: Sym3) -> Sym3 {
    let mut pairs = strain.to_pairs();
    pairs.iter_mut().skip(3).for_each(|shear| *shear *= 2.0);
    let of_row = |row: &[f64; 6]| row.iter().zip(&pairs).map(|(c, e)| c * e).sum();
    Sym3::from_pairs(tangent.each_ref().map(of_row))
}
