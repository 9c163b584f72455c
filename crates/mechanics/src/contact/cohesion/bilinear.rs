use super::{CohesionError, CohesiveLaw, Loaded};

/// How often δ_f has to exceed δ₀, at least.
const BRITTLE: f64 = 1.001;

/// Mode mixes at which a law is checked.
const CHECKED: u32 = 64;

/// Below this a share of a mode counts as this much, where a power of it is taken.
const NO_SHARE: f64 = 1e-12;

/// The toughness between the pure modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mixity {
    /// `G_c = G_I + (G_II − G_I) B^η` (Benzeggagh and Kenane).
    Interpolated(f64),
    /// `1/G_c = [((1 − B)/G_I)^α + (B/G_II)^α]^{1/α}`.
    Power(f64),
}

/// Where damage begins between the pure modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Initiation {
    /// `K_B δ₀² = N²/K_n + (S²/K_s − N²/K_n) B^η`.
    Interpolated(f64),
    /// `(⟨t_n⟩/N)² + (t_s/S)² = 1`.
    Quadratic,
}

/// Linear up to the strength, linear down to nothing.
///
/// ```text
/// K_B = K_n (1 − B) + K_s B,   λ = √(A/K_B),   δ_f = 2 G_c/(K_B δ₀)
/// D = δ_f (λ − δ₀)/(λ (δ_f − δ₀))
/// Φ = G_c (κ − δ₀)/(δ_f − δ₀) = G_c D δ₀/((1 − D) δ_f + D δ₀),   κ = δ_f δ₀/((1 − D) δ_f + D δ₀)
/// ```
///
/// # Source
/// Camanho, Dávila and de Moura, J. Compos. Mater. 37, 2003; Turon, Camanho, Costa and Dávila, Mech. Mater. 38, 2006. With
/// B a share of energies, opening in any fixed direction takes `G_c(B)` whatever K_s/K_n is.
///
/// # Example
/// ```
/// use signorini_mechanics::contact::cohesion::{Bilinear, CohesiveLaw, Initiation, Mixity};
///
/// let law = Bilinear::new([1e6; 2], [57.0, 90.0], [0.28, 0.78], Mixity::Interpolated(2.0), Initiation::Interpolated(2.0))?;
/// assert_eq!(law.load([57e-6, 0.0]).damage, 0.0);
/// assert_eq!(law.load([2.0 * 0.28 / 57.0, 0.0]).damage, 1.0);
/// assert!((law.released([1.0, 0.0], 1.0) - 0.28).abs() < 1e-15);
/// # Ok::<(), signorini_mechanics::contact::cohesion::CohesionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bilinear {
    stiffness: [f64; 2],
    strength: [f64; 2],
    toughness: [f64; 2],
    mixity: Mixity,
    initiation: Initiation,
}

/// What a mode mix makes of the law, each value with its derivative by B.
struct Mixed {
    /// K_B.
    stiffness: [f64; 2],
    /// δ₀.
    first: [f64; 2],
    /// δ_f.
    last: [f64; 2],
    toughness: f64,
}

/// `b^η` with its derivative.
fn power(b: f64, eta: f64) -> [f64; 2] {
    let within = b.max(NO_SHARE);
    [b.powf(eta), eta * within.powf(eta - 1.0)]
}

impl Bilinear {
    /// The law.
    ///
    /// # Errors
    /// A stiffness that stores more than the toughness before the strength is reached, in any mode.
    pub fn new(
        stiffness: [f64; 2],
        strength: [f64; 2],
        toughness: [f64; 2],
        mixity: Mixity,
        initiation: Initiation,
    ) -> Result<Self, CohesionError> {
        let law = Self {
            stiffness,
            strength,
            toughness,
            mixity,
            initiation,
        };
        let shares = (0..=CHECKED).map(|k| f64::from(k) / f64::from(CHECKED));
        let ratio = |b: f64| {
            let Mixed { first, last, .. } = law.mix(b);
            last[0] / first[0]
        };
        let least = shares.map(ratio).fold(f64::INFINITY, f64::min);
        if least >= BRITTLE {
            return Ok(law);
        }
        Err(CohesionError::Brittle {
            stiffness: stiffness[0],
            least: stiffness[0] * BRITTLE / least,
        })
    }

    /// The stiffness of both directions with which δ_f is at least this multiple of δ₀ in both pure modes.
    #[must_use]
    pub fn stiff_enough(strength: [f64; 2], toughness: [f64; 2], times: f64) -> f64 {
        let of = |mode: usize| times * strength[mode] * strength[mode] / (2.0 * toughness[mode]);
        of(0).max(of(1))
    }

    fn mix(&self, b: f64) -> Mixed {
        let ([kn, ks], [n, s], [gi, gii]) = (self.stiffness, self.strength, self.toughness);
        let (k, dk) = (kn + (ks - kn) * b, ks - kn);
        let (first, dfirst) = match self.initiation {
            Initiation::Interpolated(eta) => {
                let ([share, dshare], more) = (power(b, eta), s * s / ks - n * n / kn);
                let square = (n * n / kn + more * share) / k;
                let first = square.sqrt();
                (first, (more * dshare - square * dk) / (2.0 * k * first))
            }
            Initiation::Quadratic => {
                let (a, da) = (
                    kn * (1.0 - b) / (n * n) + ks * b / (s * s),
                    ks / (s * s) - kn / (n * n),
                );
                let first = (k * a).sqrt().recip();
                (first, -0.5 * first.powi(3) * (dk * a + k * da))
            }
        };
        let (g, dg) = match self.mixity {
            Mixity::Interpolated(eta) => {
                let [share, dshare] = power(b, eta);
                (gi + (gii - gi) * share, (gii - gi) * dshare)
            }
            Mixity::Power(alpha) => {
                let ([u, du], [v, dv]) = (power((1.0 - b) / gi, alpha), power(b / gii, alpha));
                let (sum, dsum) = (u + v, dv / gii - du / gi);
                let g = sum.powf(-1.0 / alpha);
                (g, -g * dsum / (alpha * sum))
            }
        };
        let last = 2.0 * g / (k * first);
        Mixed {
            stiffness: [k, dk],
            first: [first, dfirst],
            last: [last, last * (dg / g - dk / k - dfirst / first)],
            toughness: g,
        }
    }

    /// A and B.
    fn energies(&self, [x, y]: [f64; 2]) -> (f64, f64) {
        let [kn, ks] = self.stiffness;
        let a = kn * x * x + ks * y * y;
        (a, if a > 0.0 { ks * y * y / a } else { 0.0 })
    }
}

impl CohesiveLaw for Bilinear {
    fn stiffness(&self) -> [f64; 2] {
        self.stiffness
    }

    fn load(&self, opening: [f64; 2]) -> Loaded {
        let ([x, y], [kn, ks]) = (opening, self.stiffness);
        let (a, b) = self.energies(opening);
        if a <= 0.0 {
            return Loaded::default();
        }
        let Mixed {
            stiffness: [k, dk],
            first: [first, dfirst],
            last: [last, dlast],
            ..
        } = self.mix(b);
        let way = (a / k).sqrt();
        if way <= first {
            return Loaded::default();
        }
        if way >= last {
            return Loaded {
                damage: 1.0,
                slope: [0.0; 2],
            };
        }
        let softens = last - first;
        let by_way = last * first / (way * way * softens);
        let by_first = -last * (last - way) / (way * softens * softens);
        let by_last = -first * (way - first) / (way * softens * softens);
        let of_mix = by_first * dfirst + by_last * dlast - by_way * way * dk / (2.0 * k);
        let db = [-2.0 * kn * x * b / a, 2.0 * ks * y * (1.0 - b) / a];
        let dway = [kn * x / (way * k), ks * y / (way * k)];
        Loaded {
            damage: last * (way - first) / (way * softens),
            slope: [0, 1].map(|c| by_way * dway[c] + of_mix * db[c]),
        }
    }

    fn released(&self, opening: [f64; 2], damage: f64) -> f64 {
        let (_, b) = self.energies(opening);
        let Mixed {
            first: [first, _],
            last: [last, _],
            toughness,
            ..
        } = self.mix(b);
        toughness * damage * first / ((1.0 - damage) * last + damage * first)
    }
}
