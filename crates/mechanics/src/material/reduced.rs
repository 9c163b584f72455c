#![allow(clippy::needless_range_loop)] // indices are those of tensors, and several arrays share them

use super::dense;
use super::{Kinematics, Material, MaterialError, Order, Response, Strain};
use signorini_geometry::tensor::Sym3;

/// A law for space with stress-free directions: thin sheets and bars.
///
/// The strains `f` of the free directions are found such that their stresses vanish; with `g` for the given ones,
///
/// ```text
/// S_f(E_g, E_f) = 0,    C_red = C_gg − C_gf C_ff⁻¹ C_fg,    W_red(E_g) = min over E_f of W(E_g, E_f)
/// ```
///
/// The strains of the free directions that come in are ignored, stress and tangent there are zero, `across` is what was
/// found. The potential is minimized by Newton's method, at finite strain in logarithms of the free stretches, in which
/// it is convex more often and constant volume is a straight line: a tangent that is not positive definite is shifted, a
/// step is halved until the energy or its slope falls and `I + 2E` is positive definite. Of a law whose tangent is not
/// symmetric, which has no potential, `S_f = 0` is solved by the same steps, without a shift; a step is halved until `|S_f|` falls.
///
/// History: that of the law inside, then the free strains (tensor components, in the order of [`Sym3::PAIRS`]), from
/// which the next search starts. Wraps every other wrapper: a law inside sees all six strains.
///
/// # Limits
/// The potential must have a minimum: that of the law of Saint Venant and Kirchhoff has none where
/// its linear contraction exceeds the thickness; that is [`MaterialError::NotConverged`].
pub struct Reduced {
    inner: Box<dyn Material>,
    /// Places of the free strains in [`Sym3::PAIRS`], normal ones first.
    free: &'static [usize],
}

/// Places of zz, yz, xz.
const ACROSS: [usize; 3] = [2, 4, 5];
/// Places of all but xx.
const LATERAL: [usize; 5] = [1, 2, 3, 4, 5];
/// The most free strains.
const MOST: usize = 5;
/// Columns that are solved for at most: those of six strains and of the temperature.
const COLUMNS: usize = 7;

/// Volume ratio, squared, from which on the last free strains are no start.
const FAR: f64 = 2.0;
/// Newton steps at a point; damped ones included.
const STEPS: usize = 60;
/// A step this small, relative to the strain's size, is the last: what it leaves is of the order of its square.
const LAST: f64 = 1e-9;
/// The share of the predicted decrease that a step must bring (Armijo).
const DECREASE: f64 = 1e-4;
/// The share of the slope that a step may leave where the energy has no digits left.
const FLATTENING: f64 = 0.9;
/// The shortest step, as a share of Newton's.
const SHORTEST: f64 = 1e-9;
/// The first shift of a tangent that is not positive definite, as a share of the modulus, and its growth.
const SHIFT: (f64, f64) = (0.01, 4.0);

const NOT_CONVERGED: MaterialError = MaterialError::NotConverged {
    what: "state without stress across",
};

type Vector = [f64; MOST];
type Matrix = [[f64; MOST]; MOST];

impl Reduced {
    /// Plane stress: `S_zz = S_yz = S_xz = 0`; xx, yy and xy are given.
    #[must_use]
    pub fn plane_stress(inner: Box<dyn Material>) -> Self {
        Self {
            inner,
            free: &ACROSS,
        }
    }

    /// Uniaxial stress along x: only xx is given.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::tensor::Sym3;
    /// use signorini_mechanics::material::{
    ///     Kinematics, Material, Order, Reduced, Response, SaintVenantKirchhoff, Strain,
    /// };
    ///
    /// // uniaxial stress: σ = E ε
    /// let bar = Reduced::uniaxial(Box::new(SaintVenantKirchhoff::new(210e3, 0.3)));
    /// let strain = Strain::new(Kinematics::Small, Sym3::diagonal(1e-3, 0.0, 0.0));
    /// let mut response = Response::default();
    /// let mut new = vec![0.0; bar.nhistory()];
    /// bar.respond(&strain, &new.clone(), &mut new, Order::Stress, &mut response)?;
    /// assert!((response.stress.xx() - 210.0).abs() < 1e-9);
    /// # Ok::<(), signorini_mechanics::material::MaterialError>(())
    /// ```
    #[must_use]
    pub fn uniaxial(inner: Box<dyn Material>) -> Self {
        Self {
            inner,
            free: &LATERAL,
        }
    }

    /// The strain with its free components replaced.
    fn with<'a>(&self, strain: &Strain<'a>, free: &[f64]) -> Strain<'a> {
        let mut pairs = strain.value.to_pairs();
        for (&p, &value) in self.free.iter().zip(free) {
            pairs[p] = value;
        }
        Strain {
            value: Sym3::from_pairs(pairs),
            ..*strain
        }
    }

    /// The strain to start from: the free components last found; where the given ones left those behind, free
    /// directions without shear that keep the volume.
    fn first<'a>(&self, strain: &Strain<'a>, last: &[f64]) -> Result<Strain<'a>, MaterialError> {
        let first = self.with(strain, last);
        let ratio = (first.value * 2.0 + Sym3::IDENTITY).determinant();
        let near = (FAR.recip()..FAR).contains(&ratio);
        if strain.kinematics == Kinematics::Small || near && is_possible(&first) {
            return Ok(first);
        }
        let straight = self.with(strain, &[0.0; MOST]);
        let ratio = (straight.value * 2.0 + Sym3::IDENTITY).determinant();
        if !is_possible(&straight) {
            return Err(MaterialError::Inverted { ratio });
        }
        let normal = self.free.iter().filter(|p| **p < 3).count();
        let stretched = 0.5 * (ratio.powf(-(normal as f64).recip()) - 1.0);
        let free: Vector = std::array::from_fn(|i| if i < normal { stretched } else { 0.0 });
        Ok(self.with(strain, &free))
    }

    /// The factor of `C_ff` with more on its diagonal.
    fn factor(&self, tangent: &[[f64; 6]; 6], diagonal: &Vector) -> Option<Matrix> {
        let mut a = [[0.0; MOST]; MOST];
        for (i, &p) in self.free.iter().enumerate() {
            for (j, &q) in self.free.iter().enumerate() {
                a[i][j] = tangent[p][q];
            }
            a[i][i] += diagonal[i];
        }
        cholesky(a, self.free.len())
    }

    /// Newton's step towards stress-free directions, shears doubled, in the coordinates of [`Self::moved`].
    fn step(&self, strain: &Strain, at: &Response) -> Result<Vector, MaterialError> {
        let stress = at.stress.to_pairs();
        if !self.inner.is_symmetric() {
            let mut columns = [[0.0; MOST]];
            for (to, &p) in columns[0].iter_mut().zip(self.free) {
                *to = -stress[p];
            }
            self.eliminate(&at.tangent, &mut columns)?;
            return Ok(columns[0]);
        }
        let finite = strain.kinematics == Kinematics::Finite;
        let c = (strain.value * 2.0 + Sym3::IDENTITY).to_pairs();
        let (mut step, mut curvature, mut weight) = ([0.0; MOST], [0.0; MOST], [1.0; MOST]);
        for (i, &p) in self.free.iter().enumerate() {
            step[i] = -stress[p];
            let (j, k) = Sym3::PAIRS[p];
            if finite {
                weight[i] = (c[j] * c[k]).recip();
            }
            if finite && j == k {
                curvature[i] = 2.0 * stress[p] / c[p];
            }
        }
        let mut shift = 0.0;
        for _ in 0..STEPS {
            let diagonal = std::array::from_fn(|i| curvature[i] + shift * weight[i]);
            if let Some(factor) = self.factor(&at.tangent, &diagonal) {
                solve(&factor, self.free.len(), &mut step);
                return Ok(step);
            }
            shift = if shift == 0.0 {
                SHIFT.0 * self.inner.modulus()
            } else {
                SHIFT.1 * shift
            };
        }
        Err(NOT_CONVERGED)
    }

    /// Solves with `C_ff`, of which nothing is asked but an inverse: columns become solutions.
    fn eliminate(
        &self,
        tangent: &[[f64; 6]; 6],
        columns: &mut [Vector],
    ) -> Result<(), MaterialError> {
        let (n, m) = (self.free.len(), columns.len());
        let mut a = [0.0; MOST * MOST];
        let mut right = [0.0; MOST * COLUMNS];
        for (i, &p) in self.free.iter().enumerate() {
            for (j, &q) in self.free.iter().enumerate() {
                a[i * n + j] = tangent[p][q];
            }
            for (k, column) in columns.iter().enumerate() {
                right[i * m + k] = column[i];
            }
        }
        dense::solve(&mut a[..n * n], n, &mut right[..n * m], m).ok_or(NOT_CONVERGED)?;
        for (k, column) in columns.iter_mut().enumerate() {
            (0..n).for_each(|i| column[i] = right[i * m + k]);
        }
        Ok(())
    }

    /// The largest free stress.
    fn unbalanced(&self, at: &Response) -> f64 {
        let stress = at.stress.to_pairs();
        self.free
            .iter()
            .fold(0.0, |most, &p| most.max(stress[p].abs()))
    }

    /// The work of the free stresses on a step.
    fn slope(&self, at: &Response, step: &Vector) -> f64 {
        let stress = at.stress.to_pairs();
        self.free
            .iter()
            .zip(step)
            .map(|(&p, s)| stress[p] * s)
            .sum()
    }

    /// The strain a share of a step further; at finite strain in logarithms of the free normal components of `C`, which
    /// stay positive.
    fn moved<'a>(&self, strain: &Strain<'a>, step: &Vector, share: f64) -> Strain<'a> {
        let mut pairs = strain.value.to_pairs();
        for (&p, s) in self.free.iter().zip(step) {
            let s = share * s;
            let half = 0.5 + pairs[p]; // ½ C
            pairs[p] += match (p < 3, strain.kinematics) {
                (true, Kinematics::Finite) => half * (s / half).exp_m1(),
                (true, Kinematics::Small) => s,
                (false, _) => 0.5 * s,
            };
        }
        Strain {
            value: Sym3::from_pairs(pairs),
            ..*strain
        }
    }

    /// The scale of a last step: the strain, at finite strain at most the free stretches themselves.
    fn size(&self, strain: &Strain) -> f64 {
        let largest = largest(&strain.value.to_pairs());
        match (strain.value * 2.0 + Sym3::IDENTITY).inverse() {
            Some((inverse, _)) if strain.kinematics == Kinematics::Finite => {
                let inverse = inverse.to_pairs();
                let normal = self.free.iter().filter(|p| **p < 3);
                largest.min(normal.map(|p| inverse[*p]).sum::<f64>().recip())
            }
            _ => largest,
        }
    }

    /// The strain without stress in the free directions.
    fn find<'a>(
        &self,
        mut at: Strain<'a>,
        old: &[f64],
        new: &mut [f64],
        out: &mut Response,
    ) -> Result<Strain<'a>, MaterialError> {
        self.inner.respond(&at, old, new, Order::Tangent, out)?;
        for _ in 0..STEPS {
            let step = self.step(&at, out)?;
            if largest(&step) <= LAST * self.size(&at) {
                return Ok(self.moved(&at, &step, 1.0));
            }
            at = self.search(&at, &step, old, new, out)?;
        }
        Err(NOT_CONVERGED)
    }

    /// The longest share of a step, by halves, that brings the potential or its slope down; `out` goes along.
    fn search<'a>(
        &self,
        at: &Strain<'a>,
        step: &Vector,
        old: &[f64],
        new: &mut [f64],
        out: &mut Response,
    ) -> Result<Strain<'a>, MaterialError> {
        let slope = self.slope(out, step);
        let noise = 4.0 * f64::EPSILON * out.energy.abs();
        let mut trial = Response::default();
        let mut share = 1.0;
        while share > SHORTEST {
            let there = self.moved(at, step, share);
            let answers = is_possible(&there)
                && (self.inner)
                    .respond(&there, old, new, Order::Tangent, &mut trial)
                    .is_ok();
            if answers && !self.inner.is_symmetric() {
                let left = (1.0 - DECREASE * share) * self.unbalanced(out);
                if self.unbalanced(&trial) <= left + 4.0 * f64::EPSILON * largest_stress(out) {
                    *out = trial;
                    return Ok(there);
                }
            } else if answers {
                let falls = trial.energy <= out.energy + DECREASE * share * slope + noise;
                if falls || self.slope(&trial, step).abs() <= FLATTENING * slope.abs() {
                    *out = trial;
                    return Ok(there);
                }
            }
            share *= 0.5;
        }
        Err(NOT_CONVERGED)
    }

    /// Takes the stress-free directions out of a response.
    fn condense(&self, out: &mut Response) -> Result<(), MaterialError> {
        let n = self.free.len();
        let full = out.tangent;
        // C_ff⁻¹ C_f·
        let mut columns = [[0.0; MOST]; COLUMNS];
        let mut thermal = out.thermal.to_pairs();
        for (q, column) in columns.iter_mut().enumerate() {
            for (c, &p) in column.iter_mut().zip(self.free) {
                *c = full[p].get(q).copied().unwrap_or(thermal[p]);
            }
        }
        if self.inner.is_symmetric() {
            let factor = self.factor(&full, &[0.0; MOST]).ok_or(NOT_CONVERGED)?;
            columns.iter_mut().for_each(|c| solve(&factor, n, c));
        } else {
            self.eliminate(&full, &mut columns)?;
        }
        let [.., last] = columns;
        for (to, from) in thermal.iter_mut().zip(&full) {
            *to -= last
                .iter()
                .zip(self.free)
                .map(|(c, &p)| from[p] * c)
                .sum::<f64>();
        }
        for (row, from) in out.tangent.iter_mut().zip(&full) {
            for (to, column) in row.iter_mut().zip(&columns) {
                for (c, &p) in column.iter().zip(self.free) {
                    *to -= from[p] * c;
                }
            }
        }
        self.free.iter().for_each(|&p| thermal[p] = 0.0);
        out.thermal = Sym3::from_pairs(thermal);
        for &p in self.free {
            out.tangent[p] = [0.0; 6];
            for row in &mut out.tangent {
                row[p] = 0.0;
            }
        }
        Ok(())
    }
}

impl Material for Reduced {
    fn nhistory(&self) -> usize {
        self.inner.nhistory() + self.free.len()
    }

    fn start(&self, history: &mut [f64]) {
        let (inner, _) = history.split_at_mut(self.inner.nhistory());
        self.inner.start(inner);
    }

    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let (old, last) = old.split_at(self.inner.nhistory());
        let (new, found) = new.split_at_mut(self.inner.nhistory());
        let first = self.first(strain, last)?;
        let at = self.find(first, old, new, out)?;
        self.inner.respond(&at, old, new, order, out)?;
        let mut stress = out.stress.to_pairs();
        let pairs = at.value.to_pairs();
        for (slot, &p) in found.iter_mut().zip(self.free) {
            *slot = pairs[p];
            stress[p] = 0.0;
        }
        out.stress = Sym3::from_pairs(stress);
        out.across = at.value.zz();
        if order == Order::Tangent {
            self.condense(out)?;
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

    fn mechanical_strain(&self, strain: &Strain) -> Sym3 {
        self.inner.mechanical_strain(strain)
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        self.inner
            .plastic_strain(history.get(..self.inner.nhistory())?)
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

fn largest_stress(at: &Response) -> f64 {
    largest(&at.stress.to_pairs())
}

/// Whether a body can have this strain: at finite strain, `C = I + 2E` is positive definite.
fn is_possible(strain: &Strain) -> bool {
    let c = strain.value * 2.0 + Sym3::IDENTITY;
    strain.kinematics == Kinematics::Small
        || (c.xx() > 0.0 && c.xx() * c.yy() - c.xy() * c.xy() > 0.0 && c.determinant() > 0.0)
}

/// The lower factor of the leading `n × n` block, if it is positive definite.
fn cholesky(mut a: Matrix, n: usize) -> Option<Matrix> {
    for j in 0..n {
        for i in j..n {
            let mut sum = a[i][j];
            for k in 0..j {
                sum -= a[i][k] * a[j][k];
            }
            if i > j {
                a[i][j] = sum / a[j][j];
            } else if sum > f64::EPSILON * a[j][j].abs() {
                a[j][j] = sum.sqrt();
            } else {
                return None;
            }
        }
    }
    Some(a)
}

/// Solves with a lower factor in place.
fn solve(factor: &Matrix, n: usize, b: &mut Vector) {
    for i in 0..n {
        for k in 0..i {
            b[i] -= factor[i][k] * b[k];
        }
        b[i] /= factor[i][i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            b[i] -= factor[k][i] * b[k];
        }
        b[i] /= factor[i][i];
    }
}
