//! Stiffness that damps: a stress over the rate of strain, with the initial stiffness ℂ₀ of the material.
//!
//! ```text
//! S_v = b ℂ₀:Ė        at x_α, with v_α = (1 − αf) v₁ + αf v₀                                        (E29)
//! v_α = c (u_α − u₀) + v_r        c = γ/(β h), or 1/h in explicit steps                             (E30)
//! D  += f_v·Δd                                                                                      (E31)
//! ```
//!
//! where `v_r` follows from velocities and accelerations at the start of the increment, (E5) of `system::motion`. At small strain it is
//! `b K₀ v`, whatever is done against locking: the element with the stiffness ℂ₀, at velocities in place of displacements. At finite
//! strain see `kernel::viscous`. In explicit steps the velocity is that of the increment that ends, and stiffness is without it.
//! Where a step begins, `v_α = v₀`.

use super::at::At;
use crate::material::{Linearity, Material, MaterialError, Order, Response, Strain};
use crate::system::{Archive, ArchiveError, Layout, Lifetime, NodeId, Phase, Scheme, State};
use signorini_geometry::tensor::{Sym3, Vec3};

/// The law `b ℂ₀:Ė`, which takes rates for strains.
pub(super) struct Viscous<'a> {
    pub material: &'a dyn Material,
    /// b.
    pub retardation: f64,
}

impl Material for Viscous<'_> {
    fn nhistory(&self) -> usize {
        self.material.nhistory()
    }

    fn respond(
        &self,
        rate: &Strain,
        old: &[f64],
        new: &mut [f64],
        _: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let start = Strain {
            value: Sym3::ZERO,
            temperature: rate.temperature_at_start,
            ..*rate
        };
        self.material
            .respond(&start, old, new, Order::Tangent, out)?;
        out.tangent = out.tangent.map(|row| row.map(|c| self.retardation * c));
        let mut doubled = rate.value.to_pairs();
        doubled[3..].iter_mut().for_each(|e| *e *= 2.0);
        let product = |row: [f64; 6]| row.iter().zip(&doubled).map(|(c, e)| c * e).sum();
        out.stress = Sym3::from_pairs(out.tangent.map(product));
        out.energy = 0.0;
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.retardation * self.material.modulus()
    }

    fn is_symmetric(&self) -> bool {
        self.material.is_symmetric()
    }

    fn linearity(&self) -> Linearity {
        Linearity::SmallStrain
    }
}

/// An unknown where the increment began.
#[derive(Clone, Copy, Default)]
pub(super) struct Since {
    u: f64,
    /// v_r of (E30).
    rest: f64,
}

/// How velocities follow from places in an increment.
#[derive(Clone, Copy)]
pub(super) struct Flow {
    /// c of (E30).
    pub slope: f64,
    /// The share of the end of the increment in the place where forces are: 1 − αf.
    pub share: f64,
    is_explicit: bool,
    scheme: Scheme,
    h: f64,
}

impl Flow {
    fn new(phase: &Phase) -> Option<Self> {
        let scheme = phase.step.scheme?;
        let (h, is_explicit) = (phase.dt(), scheme.explicit.is_some());
        let slope = match h > 0.0 {
            true if is_explicit => h.recip(),
            true => scheme.gamma / (scheme.beta * h),
            false => 0.0,
        };
        Some(Self {
            slope,
            share: if h > 0.0 { 1.0 - scheme.alpha_f } else { 1.0 },
            is_explicit,
            scheme,
            h,
        })
    }

    /// v_r of a node with these rates.
    fn rest(&self, velocity: Vec3, acceleration: Vec3) -> Vec3 {
        if self.h == 0.0 {
            return velocity;
        }
        if self.is_explicit {
            return Vec3::ZERO;
        }
        let last = self
            .scheme
            .acceleration(Vec3::ZERO, self.h, velocity, acceleration);
        let last = self.scheme.velocity(self.h, velocity, [acceleration, last]);
        last * (1.0 - self.scheme.alpha_f) + velocity * self.scheme.alpha_f
    }

    /// The velocity of an unknown (E30).
    pub fn velocity(&self, u: f64, since: &Since) -> f64 {
        self.slope * (u - since.u) + since.rest
    }

    /// What an unknown does in the whole increment.
    pub fn way(&self, u: f64, since: &Since) -> f64 {
        (u - since.u) / self.share
    }
}

/// How the stiffness of a body damps.
#[derive(Default)]
pub(super) struct Damping {
    /// b (time).
    pub retardation: f64,
    /// In the present increment; none where nothing damps.
    flow: Option<Flow>,
    /// The length of the increment before this one.
    before: f64,
    /// (E31), since the start of the run.
    pub spent: f64,
}

impl Damping {
    /// An increment begins; returns how velocities follow in it, where stiffness damps.
    pub fn begin(&mut self, phase: &Phase) -> Option<Flow> {
        self.before = self.flow.map_or(0.0, |flow| flow.h);
        self.flow = Flow::new(phase).filter(|_| self.retardation > 0.0);
        self.flow
    }

    /// What forces follow from.
    pub const fn flow(&self) -> Option<Flow> {
        self.flow
    }

    /// The same where the stiffness has a part of it.
    pub fn stiff(&self) -> Option<Flow> {
        self.flow.filter(|flow| !flow.is_explicit)
    }

    /// The one of these where forces are evaluated, or stiffness with them.
    pub fn at(&self, at: At<'_>, with_stiffness: bool) -> Option<Flow> {
        match at {
            At::Start => None,
            At::Trial(_) if with_stiffness => self.stiff(),
            At::Trial(_) => self.flow,
        }
    }

    /// The name under which what was spent is stored.
    fn stored(body: &str) -> String {
        format!("solid.{body}.damping")
    }

    /// Saves what was spent.
    pub fn save(&self, body: &str, out: &mut Archive) {
        if self.retardation > 0.0 {
            out.put(Self::stored(body), &[self.spent]);
        }
    }

    /// Loads what was spent.
    pub fn load(&mut self, body: &str, from: &Archive) -> Result<(), ArchiveError> {
        if self.retardation > 0.0 {
            let mut spent = [self.spent];
            from.get(&Self::stored(body), &mut spent)?;
            [self.spent] = spent;
        }
        Ok(())
    }

    /// How long a stiffness lives with this part in it.
    pub fn lifetime(&self, without: Lifetime) -> Lifetime {
        match self.stiff() {
            Some(flow) if without == Lifetime::Step && flow.h != self.before => Lifetime::Increment,
            _ => without,
        }
    }

    /// The state where forces were, from one at the end of the increment; none where it is that.
    pub fn middle<'a>(
        &self,
        state: &State,
        unknowns: impl Iterator<Item = (usize, &'a Since)>,
    ) -> Option<State> {
        let flow = self.flow.filter(|flow| flow.share != 1.0)?;
        let mut middle = State {
            rates: None,
            between: None,
            ..state.clone()
        };
        for (dof, since) in unknowns {
            if let Some((to, end)) = middle.u.get_mut(dof).zip(state.u.get(dof)) {
                *to = since.u + flow.share * (end - since.u);
            }
        }
        Some(middle)
    }
}

/// The unknowns of nodes where an increment begins.
pub(super) fn since<'a>(
    flow: &'a Flow,
    from: &'a State,
    layout: &'a Layout,
    nodes: &'a [NodeId],
) -> impl Iterator<Item = Since> + 'a {
    let rates = from.rates.as_ref();
    nodes.iter().flat_map(move |&node| {
        let at = |values: &[Vec3]| values.get(node as usize).copied().unwrap_or_default();
        let rates = rates.map(|rates| [at(&rates.velocity), at(&rates.acceleration)]);
        let [velocity, acceleration] = rates.unwrap_or_default();
        let rest = flow.rest(velocity, acceleration).to_array();
        let of_axis = move |(axis, rest)| {
            let dof = layout.node(node, axis) as usize;
            let u = from.u.get(dof).copied().unwrap_or_default();
            Since { u, rest }
        };
        (0..layout.ndim()).zip(rest).map(of_axis)
    })
}
