use super::hardening::{Hardening, HardeningError};
use super::logarithmic::{Logarithmic, Principal};
use super::{Kinematics, Lame, Material, MaterialError, Order, Response, Strain};
use signorini_geometry::tensor::Sym3;

/// Von Mises plasticity with associated flow, of isotropic, kinematic or combined hardening.
///
/// ```text
/// σ = K tr(ε) I + 2μ dev(ε − ε_p),        q(ξ) = √(3/2 ξ:ξ),  ξ = dev σ − a        elasticity, equivalent stress
/// q(ξ) ≤ r(p),   ε̇_p = ṗ N,  N = 3/2 ξ/q,   ȧ = ⅔ k'(p) ε̇_p                        flow, motion of the centre
/// ```
///
/// with the radius `r` and the centre's growth `k` of [`Hardening`]. An increment is integrated by backward Euler, which
/// is the radial return: with the trial state `q*, N*` of a frozen flow, `N = N*` and
///
/// ```text
/// q* = r(p + Δp) + k(p + Δp) − k(p) + 3μ Δp
/// C = K I⊗I + 2μ (1 − 3μ Δp/q*) I_dev − 4μ² (1/(3μ + r' + k') − Δp/q*) N⊗N
/// ```
///
/// the scalar equation being solved exactly through the rows of the table.
///
/// Finite strain: `F = F_e F_p`, the elastic law in `½ ln C_e`, the flow in the intermediate configuration without plastic
/// spin, integrated by the exponential map (Simo 1992). The law is isotropic, so that `F_p` is known up to a rotation and
/// its symmetric stretch `U = exp H_p` does in its place:
///
/// ```text
/// Ê = U⁻¹ E U⁻¹ + ½ (U⁻² − I),   ε = ½ ln(I + 2Ê),   ε_p = 0                        the return above, which leaves Δε_p
/// S = U⁻¹ Ŝ U⁻¹,   Ŝ = ∂W/∂Ê                                                       and the tangent by the same congruence
/// U_new² = U exp(2Δε_p) U,   tr H_p = 0                                            flow keeps the volume
/// ```
///
/// `U` is that of the old history and stays over the increment. The table is then Kirchhoff stress over logarithmic plastic
/// strain, true stress to the order of the elastic change of volume. The centre keeps its components in the
/// configuration to which `U` leads, which turns with the rotation of the polar decomposition, not with the spin: stress
/// does not oscillate in shear (Nagtegaal, de Jong 1982). Where the centre is not coaxial with the trial strain, elastic
/// strain is what the subtraction of logarithms leaves, off by elastic strain times `Δε_p`.
///
/// The energy is the potential of the increment: the elastic energy plus the plastic work so far, `∫ (q + a:N) dp`;
/// its gradient at fixed old history is the stress (Ortiz, Stainier 1999).
///
/// History, 14 numbers: plastic strain (six, tensor components in the order of [`Sym3::PAIRS`]; at finite strain the
/// logarithmic one, `H_p`), centre (six, as well), equivalent plastic strain, plastic work.
///
/// # Limits
/// Exact for a strain increment of one direction; else of first order in the increment, as backward Euler is. Where the
/// centre moves at finite strain, the potential of a long increment has no minimum in directions free of stress: under
/// tension its logarithmic strain must stay below about ⅔ of the radius over the stress.
///
/// # Sources
/// Simo, Hughes, *Computational Inelasticity* 1998, sections 3.3 and 3.4; Simo, *Comput. Methods Appl. Mech. Engrg.* 99
/// (1992) 61–112; de Souza Neto, Perić, Owen, *Computational Methods for Plasticity* 2008, chapter 14; Nagtegaal, de Jong,
/// in *Plasticity of Metals at Finite Strain* 1982; Ortiz, Stainier, *Comput. Methods Appl. Mech. Engrg.* 171 (1999)
/// 419–444.
#[derive(Clone, Debug)]
pub struct Plasticity {
    lame: Lame,
    hardening: Hardening,
}

const NHISTORY: usize = 14;
/// Place of the equivalent plastic strain.
const PLASTIC: usize = 12;
/// What a stress on the yield surface is beyond it by rounding. There the tangent is the elastic one: a step that turns
/// the load round begins with it, and one that goes on meets flow in the next iterate.
const ROUNDING: f64 = 1e-12;

/// What a point remembers: `strain` is `ε_p`, at finite strain `H_p`.
#[derive(Clone, Copy)]
struct Memory {
    strain: Sym3,
    centre: Sym3,
    plastic: f64,
    work: f64,
}

impl Memory {
    fn read(history: &[f64]) -> Self {
        let number = |at: usize| history.get(at).copied().unwrap_or_default();
        let tensor = |at: usize| Sym3::from_pairs(std::array::from_fn(|i| number(at + i)));
        Self {
            strain: tensor(0),
            centre: tensor(6),
            plastic: number(PLASTIC),
            work: number(PLASTIC + 1),
        }
    }

    fn write(&self, history: &mut [f64]) {
        let tensors = self
            .strain
            .to_pairs()
            .into_iter()
            .chain(self.centre.to_pairs());
        for (to, from) in history
            .iter_mut()
            .zip(tensors.chain([self.plastic, self.work]))
        {
            *to = from;
        }
    }
}

impl Plasticity {
    /// From Young's modulus `e > 0`, Poisson's ratio `−1 < nu < ½` and the hardening.
    ///
    /// # Errors
    /// The table falls as steeply as elastic unloading, `−3μ`: stress would not be a function of strain.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::tensor::Sym3;
    /// use signorini_mechanics::material::{
    ///     Hardening, HardeningKind, Kinematics, Material, Order, Plasticity, Response, Strain,
    /// };
    ///
    /// // perfectly plastic: in pure shear the stress ends at σ_y/√3
    /// let hardening = Hardening::new(HardeningKind::Isotropic, vec![[250.0, 0.0]])?;
    /// let steel = Plasticity::new(210e3, 0.3, hardening)?;
    /// let strain = Strain::new(Kinematics::Small, Sym3::new(0.0, 0.0, 0.0, 0.05, 0.0, 0.0));
    /// let mut old = vec![0.0; steel.nhistory()];
    /// steel.start(&mut old);
    /// let mut new = old.clone();
    /// let mut response = Response::default();
    /// steel.respond(&strain, &old, &mut new, Order::Stress, &mut response)?;
    /// assert!((response.stress.xy() - 250.0 / 3_f64.sqrt()).abs() < 1e-9);
    /// assert!(steel.plastic_strain(&new) > Some(0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(e: f64, nu: f64, hardening: Hardening) -> Result<Self, HardeningError> {
        let lame = Lame::new(e, nu);
        hardening.check_slope(3.0 * lame.mu)?;
        Ok(Self { lame, hardening })
    }

    /// The radial return, in whatever axes strain and memory are.
    fn integrate(&self, strain: Sym3, memory: &mut Memory, order: Order, out: &mut Response) {
        let mu = self.lame.mu;
        let elastic = strain - memory.strain;
        self.lame.respond(&elastic, order, out);
        let relative = deviator(elastic) * (2.0 * mu) - memory.centre;
        let q = relative.von_mises();
        let excess = q - self.hardening.radius(memory.plastic);
        if excess <= ROUNDING * q {
            out.energy += memory.work;
            return;
        }
        let flow = self.hardening.flow(memory.plastic, excess, 3.0 * mu);
        let direction = relative * (1.5 / q);
        memory.work += flow.work + flow.plastic * memory.centre.double_dot(direction);
        memory.strain = memory.strain + direction * flow.plastic;
        memory.centre = memory.centre + direction * (2.0 / 3.0 * flow.centre);
        memory.plastic += flow.plastic;
        self.lame
            .respond(&(strain - memory.strain), Order::Stress, out);
        out.energy += memory.work;
        if order == Order::Tangent {
            let share = flow.plastic / q;
            let deviatoric = 6.0 * mu * mu * share;
            let rank_one = 4.0 * mu * mu * ((3.0 * mu + flow.slope).recip() - share);
            let n = direction.to_pairs();
            for (p, row) in out.tangent.iter_mut().enumerate() {
                for (q, value) in row.iter_mut().enumerate() {
                    *value -= rank_one * n[p] * n[q];
                }
                if p < 3 {
                    for value in &mut row[..3] {
                        *value += deviatoric / 3.0;
                    }
                    row[p] -= deviatoric;
                } else {
                    row[p] -= 0.5 * deviatoric;
                }
            }
        }
    }

    /// The radial return in the logarithmic strain that is left when the old plastic stretch is taken off.
    fn integrate_finite(
        &self,
        strain: &Sym3,
        memory: &mut Memory,
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let plastic = Principal::new(&memory.strain);
        let off = plastic.map(|h| (-h).exp()).to_mat3();
        let trial = strain.congruence(off) + plastic.map(|h| 0.5 * (-2.0 * h).exp_m1());
        let trial = Logarithmic::new(&trial)?;
        let mut local = Memory {
            strain: Sym3::ZERO,
            centre: trial.frame.enter(memory.centre),
            ..*memory
        };
        self.integrate(trial.value(), &mut local, order, out);
        trial.through(off).pull_back(order, out);
        // writing a history again would change bits of one that stays
        if local.plastic > memory.plastic {
            let flow = Principal::new(&trial.frame.leave(local.strain));
            let grown = flow.map(|h| 0.5 * (2.0 * h).exp_m1());
            let on = plastic.map(f64::exp).to_mat3();
            let grown = grown.congruence(on) + plastic.map(|h| 0.5 * (2.0 * h).exp_m1());
            let grown = Logarithmic::new(&grown)?;
            *memory = Memory {
                strain: deviator(grown.frame.leave(grown.value())),
                centre: trial.frame.leave(local.centre),
                ..local
            };
        }
        Ok(())
    }
}

impl Material for Plasticity {
    fn nhistory(&self) -> usize {
        NHISTORY
    }

    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let mut memory = Memory::read(old);
        match strain.kinematics {
            Kinematics::Small => self.integrate(strain.value, &mut memory, order, out),
            Kinematics::Finite => self.integrate_finite(&strain.value, &mut memory, order, out)?,
        }
        memory.write(new);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.lame.lambda + 2.0 * self.lame.mu
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        history.get(PLASTIC).copied()
    }
}

fn deviator(tensor: Sym3) -> Sym3 {
    tensor - Sym3::IDENTITY * (tensor.trace() / 3.0)
}
