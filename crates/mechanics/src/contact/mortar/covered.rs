use super::basis::{Small, inverse};
use super::factor::zeros;
use super::pair::{COORDINATES, add, add_rows};
use super::{Basis, Facet, Frame, Measure, MortarError, Pair, Transformation};
use pulp::Arch;
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// The part of `D⁰` that must be covered for a node to have a multiplier.
pub const MIN_COVERAGE: f64 = 1e-8;

/// D and M of a secondary facet over its covered part, with derivatives. One serves for any number of facets, one after
/// the other, and keeps its memory.
///
/// # Units
/// D, M and `full` are areas; lengths in the plane; areas of surfaces of revolution where so [measured](Measure).
#[derive(Clone, Debug, Default)]
pub struct Covered {
    measure: Measure,
    basis: Basis,
    nnode: usize,
    /// The primary nodes, by their places in the list of positions.
    nodes: Vec<usize>,
    /// The place among these of each node of the facets that count, one facet after the other.
    places: Vec<usize>,
    lumped: bool,
    normal: Vec3,
    /// Pairs that were integrated, of which the first `met.len()` count.
    pairs: Vec<Pair>,
    met: Vec<usize>,
    full: Vec<f64>,
    d: Vec<f64>,
    m: Vec<f64>,
    mass: Vec<f64>,
    /// ∫N_k N^m_l over all pairs.
    mixed: Vec<f64>,
    /// B of (E1): the dual basis is `ψ = B N`.
    dual: Small,
    derivatives: Derivatives,
    /// dG and its product with B, dB.
    dg: Vec<f64>,
    product: Vec<f64>,
    db: Vec<f64>,
}

/// Derivatives of D, M and ν of a secondary facet, by the coordinates x, y, z of its nodes, then of the primary ones.
#[derive(Clone, Debug, Default)]
pub struct Derivatives {
    nprimary: usize,
    ncolumn: usize,
    dnormal: [Vec<f64>; 3],
    /// Of the mean normal of the covering facets, where requested.
    dopposite: [Vec<f64>; 3],
    dd: Vec<f64>,
    dm: Vec<f64>,
}

impl Derivatives {
    /// `∂ν_a/∂v` for the columns of the secondary facet; it does not depend on others.
    #[must_use]
    pub fn dnormal(&self, a: usize) -> &[f64] {
        &self.dnormal[a]
    }

    /// The derivatives of a component of the sum of normals of primary facets, weighted with the areas that they cover, by
    /// all columns; empty where they were not asked for.
    #[must_use]
    pub fn dopposite(&self, a: usize) -> &[f64] {
        &self.dopposite[a]
    }

    /// `∂D_j/∂v`; empty where only values were wanted.
    #[must_use]
    pub fn dd(&self, j: usize) -> &[f64] {
        self.line(&self.dd, j)
    }

    /// `∂M_jl/∂v`; empty where only values were wanted.
    #[must_use]
    pub fn dm(&self, j: usize, l: usize) -> &[f64] {
        self.line(&self.dm, j * self.nprimary + l)
    }

    fn line<'a>(&self, lines: &'a [f64], number: usize) -> &'a [f64] {
        let line = number * self.ncolumn..(number + 1) * self.ncolumn;
        lines.get(line).unwrap_or_default()
    }
}

impl Covered {
    /// One for integrals of this measure; the default is that of [`Measure::Flat`].
    #[must_use]
    pub fn new(measure: Measure) -> Self {
        Self {
            measure,
            ..Self::default()
        }
    }

    /// What its integrals are taken over from now on, and by what basis.
    pub fn measured(&mut self, measure: Measure, basis: Basis) {
        self.measure = measure;
        self.basis = basis;
    }

    /// Integrates over the part that a secondary facet shares with primary facets near it. `nodes` has the number of each node of
    /// these, one facet after the other: what facets share has one place in the sums. Without numbers all nodes differ.
    ///
    /// # Errors
    /// A facet is folded, or not as [`Facet`] says. Primary facets that turn away are passed over.
    pub fn evaluate(
        &mut self,
        secondary: &Facet,
        primaries: &[Facet],
        nodes: &[NodeId],
        derivatives: bool,
    ) -> Result<(), MortarError> {
        let frame = Frame::measured(secondary, self.measure)?;
        let element = secondary.element;
        let missing = MortarError::NoDualBasis {
            element: element.name(),
        };
        let t = Transformation::of(element, self.basis).ok_or(missing)?;
        self.derivatives.dopposite.iter_mut().for_each(Vec::clear);
        self.nnode = secondary.x.len();
        self.normal = frame.normal();
        for (a, dnormal) in self.derivatives.dnormal.iter_mut().enumerate() {
            dnormal.clear();
            dnormal.extend(frame.dnormal(a));
        }
        self.met.clear();
        for (number, primary) in primaries.iter().enumerate() {
            if self.pairs.len() == self.met.len() {
                self.pairs.push(Pair::default());
            }
            let Some(pair) = self.pairs.get_mut(self.met.len()) else {
                continue;
            };
            if pair.integrate(&frame, primary, number, derivatives)? {
                self.met.push(number);
            }
        }
        self.join(primaries, nodes);
        self.measure_whole(&frame, secondary, &t);
        let scatters = super::scatters(element);
        Arch::new().dispatch(
            #[inline(always)]
            || self.combine(&t, scatters, derivatives),
        );
        Ok(())
    }

    /// The number of nodes of the secondary facet.
    #[must_use]
    pub fn nnode(&self) -> usize {
        self.nnode
    }

    /// The number of nodes of all primary facets it meets.
    #[must_use]
    pub fn nprimary(&self) -> usize {
        self.nodes.len()
    }

    /// These nodes, by their places in the list of nodes of all primary facets.
    #[must_use]
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// The number of columns: x, y, z of the nodes of the secondary facet, then of the primary ones.
    #[must_use]
    pub fn ncolumn(&self) -> usize {
        3 * (self.nnode + self.nodes.len())
    }

    /// The primary facets it meets, by their places in the list, in its order.
    #[must_use]
    pub fn met(&self) -> &[usize] {
        &self.met
    }

    /// The integrals over the part shared with each of them.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs[..self.met.len()]
    }

    /// Whether the basis is `ψ = Ñ` because the covered part is an island.
    #[must_use]
    pub fn lumped(&self) -> bool {
        self.lumped
    }

    /// The cosine of the angle by which primary facets fail to face it, in the mean over what they cover.
    #[must_use]
    pub fn facing(&self) -> f64 {
        let parts = self.pairs().iter().map(|pair| (pair.area(), pair.cosine()));
        let [all, facing] = parts.fold([0.0; 2], |[all, facing], (area, cosine)| {
            [all + area, facing + area * cosine]
        });
        if all > 0.0 { facing / all } else { 0.0 }
    }

    /// The sum of the normals of primary facets, weighted with the areas that they cover.
    #[must_use]
    pub fn opposite(&self) -> Vec3 {
        let pairs = self.pairs().iter();
        pairs.map(|pair| pair.opposite() * pair.area()).sum()
    }

    /// ν.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// `∂ν_a/∂v` for the columns of the secondary facet; it does not depend on others.
    #[must_use]
    pub fn dnormal(&self, a: usize) -> &[f64] {
        self.derivatives.dnormal(a)
    }

    /// D⁰_j.
    #[must_use]
    pub fn full(&self) -> &[f64] {
        &self.full
    }

    /// D_j.
    #[must_use]
    pub fn d(&self) -> &[f64] {
        &self.d
    }

    /// M_jl, for all l.
    #[must_use]
    pub fn m(&self, j: usize) -> &[f64] {
        &self.m[j * self.nprimary()..][..self.nprimary()]
    }

    /// `∫ψ_j f` from `∫N_k f`, over the covered part.
    pub(super) fn weighted(&self, j: usize, integrals: &[f64]) -> f64 {
        let row = self.dual.get(j).map_or(&[][..], |row| &row[..self.nnode]);
        row.iter().zip(integrals).map(|(b, f)| b * f).sum()
    }

    /// S of a quadratic triangle, row by row; empty of other facets, and where Ñ is negative beyond a bent edge.
    #[must_use]
    pub fn mass(&self) -> &[f64] {
        &self.mass
    }

    /// `∂D_j/∂v`; empty without derivatives.
    #[must_use]
    pub fn dd(&self, j: usize) -> &[f64] {
        self.derivatives.dd(j)
    }

    /// `∂M_jl/∂v`; empty without derivatives.
    #[must_use]
    pub fn dm(&self, j: usize, l: usize) -> &[f64] {
        self.derivatives.dm(j, l)
    }

    /// All derivatives.
    #[must_use]
    pub fn derivatives(&self) -> &Derivatives {
        &self.derivatives
    }

    /// Finds the derivatives of the [sum of normals](Self::opposite) of the primary facets that it was integrated against:
    /// `dm = Σ (A_f dn_f + n_f dA_f)`.
    ///
    /// # Errors
    /// A primary facet without a normal.
    pub fn differentiate_opposite(&mut self, primaries: &[Facet]) -> Result<(), MortarError> {
        let (own, ncolumn) = (3 * self.nnode, self.ncolumn());
        let dopposite = &mut self.derivatives.dopposite;
        dopposite.iter_mut().for_each(|d| zeros(d, ncolumn));
        let mut places = &self.places[..];
        for (pair, &number) in self.pairs.iter().zip(&self.met) {
            let Some(primary) = primaries.get(number) else {
                continue;
            };
            let of_pair = places.split_off(..primary.x.len()).unwrap_or_default();
            let column = |i: usize| match i.checked_sub(own) {
                None => Some(i),
                Some(i) => of_pair.get(i / 3).map(|place| own + 3 * place + i % 3),
            };
            let (frame, area) = (Frame::of(primary)?, pair.area());
            for (a, to) in dopposite.iter_mut().enumerate() {
                let n = pair.opposite()[a];
                let by_area = (0..self.nnode).flat_map(|j| pair.dn(j).iter().enumerate());
                for (i, d) in by_area {
                    if let Some(to) = column(i).and_then(|c| to.get_mut(c)) {
                        *to += n * d;
                    }
                }
                // the frame of a facet has its normal turned round
                for (i, d) in frame.dnormal(a).enumerate() {
                    if let Some(to) = column(own + i).and_then(|c| to.get_mut(c)) {
                        *to -= area * d;
                    }
                }
            }
        }
        Ok(())
    }

    /// Leaves its derivatives there and has none any longer: what was there lends its memory to the next ones.
    pub fn leave_derivatives(&mut self, to: &mut Derivatives) {
        std::mem::swap(&mut self.derivatives, to);
        self.derivatives.ncolumn = 0;
    }

    /// Finds the primary nodes: those that facets share are one.
    fn join(&mut self, primaries: &[Facet], nodes: &[NodeId]) {
        self.nodes.clear();
        self.places.clear();
        let same = |a: usize, b: usize| nodes.get(a).is_some_and(|n| nodes.get(b) == Some(n));
        let (mut first, mut met) = (0, self.met.iter().peekable());
        for (number, primary) in primaries.iter().enumerate() {
            let of_facet = first..first + primary.x.len();
            first = of_facet.end;
            if met.next_if_eq(&&number).is_none() {
                continue;
            }
            for node in of_facet {
                let known = self.nodes.iter().position(|&k| same(k, node));
                self.places.push(known.unwrap_or(self.nodes.len()));
                if known.is_none() {
                    self.nodes.push(node);
                }
            }
        }
    }

    /// D⁰, with the rule of the whole facet and areas of the plane.
    fn measure_whole(&mut self, frame: &Frame, facet: &Facet, t: &Transformation) {
        let (element, n) = (facet.element, self.nnode);
        let mut whole = [0.0; MAX_FACET_NODES];
        let (mut shape, mut dshape) = ([0.0; MAX_FACET_NODES], [Vec3::ZERO; MAX_FACET_NODES]);
        for (xi, w) in element.surface_rule().iter() {
            element.shape(xi, &mut shape[..n]);
            element.dshape(xi, &mut dshape[..n]);
            let tangent = |a: usize| {
                dshape
                    .iter()
                    .zip(facet.x)
                    .map(|(d, &x)| x * d[a])
                    .sum::<Vec3>()
            };
            let t2 = if element.dim() == 1 {
                Vec3::unit(2)
            } else {
                tangent(1)
            };
            let place = shape.iter().zip(facet.x).map(|(&n, &x)| x * n).sum();
            let factor = frame.factor().at(frame.along(place));
            let area = -w * tangent(0).cross(t2).dot(self.normal) * factor;
            add(&mut whole, area, &shape[..n]);
        }
        self.full.clear();
        let transformed = (0..n).map(|j| (0..n).map(|k| t.get(j, k) * whole[k]).sum::<f64>());
        self.full.extend(transformed);
    }

    /// (E1) to (E3), with `G = ∫N Nᵀ`, `B = A T` and `ψ = B N`:
    /// `B = D W`, `W = S⁻¹ T`, `dB = dD W − B dG Tᵀ W`.
    #[inline(always)]
    fn combine(&mut self, t: &Transformation, scatters: bool, derivatives: bool) {
        let n = self.nnode;
        let pairs = &self.pairs[..self.met.len()];
        let zero: Small = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
        let (mut g, mut s, mut w, mut h, mut b) = (zero, zero, zero, zero, zero);
        let mut whole = [0.0; MAX_FACET_NODES];
        for (k, whole) in whole[..n].iter_mut().enumerate() {
            *whole = pairs.iter().map(|p| p.n(k)).sum();
        }
        zeros(&mut self.d, n);
        for j in 0..n {
            for k in 0..n {
                g[j][k] = pairs.iter().map(|p| p.nn(j, k)).sum();
                self.d[j] += t.get(j, k) * whole[k];
            }
            self.d[j] = self.d[j].max(0.0);
        }
        each(n, &mut s, |j, k| {
            let over = |i: usize| (0..n).map(|m| t.get(k, m) * g[i][m]).sum::<f64>();
            (0..n).map(|i| t.get(j, i) * over(i)).sum()
        });
        self.mass.clear();
        let is_positive = |row: &[f64]| row.iter().all(|s| *s >= 0.0);
        let d_is_positive = self.d.iter().all(|d| *d > 0.0);
        if scatters && d_is_positive && s[..n].iter().all(|row| is_positive(&row[..n])) {
            self.mass.extend(s[..n].iter().flat_map(|row| &row[..n]));
        }
        let found = inverse(&s, n);
        self.lumped = found.is_none() && !pairs.is_empty();
        match found {
            Some(inverse) => {
                let d = &self.d;
                each(n, &mut w, |j, k| {
                    (0..n).map(|i| inverse[j][i] * t.get(i, k)).sum()
                });
                each(n, &mut h, |j, k| {
                    (0..n).map(|i| t.get(i, j) * w[i][k]).sum()
                });
                each(n, &mut b, |j, k| d[j] * w[j][k]);
            }
            None => each(n, &mut b, |j, k| t.get(j, k)),
        }
        for (row, _) in b.iter_mut().zip(&self.d).filter(|(_, d)| **d <= 0.0) {
            row.fill(0.0);
        }
        self.dual = b;
        let np = self.nodes.len();
        zeros(&mut self.mixed, n * np);
        let mut places = &self.places[..];
        for pair in pairs {
            let of_pair = places.split_off(..pair.nnode()[1]).unwrap_or_default();
            for k in 0..n {
                for (l, place) in of_pair.iter().enumerate() {
                    self.mixed[k * np + place] += pair.nm(k, l);
                }
            }
        }
        zeros(&mut self.m, n * np);
        for j in 0..n {
            add_rows(&mut self.m[j * np..][..np], &b[j][..n], &self.mixed);
        }
        self.balance(t);
        (self.derivatives.nprimary, self.derivatives.ncolumn) = (np, self.ncolumn());
        self.derivatives.dd.clear();
        self.derivatives.dm.clear();
        if derivatives {
            self.differentiate(t, &w, &h, &b);
        }
    }

    /// What rounding leaves of `Σ_l M_jl = D_j`, as much of it as the condition of S lets through, goes to the primary
    /// nodes as `Ñ_j` would distribute it.
    fn balance(&mut self, t: &Transformation) {
        let (n, np) = (self.nnode, self.nodes.len());
        let mixed = &self.mixed;
        for (j, &d) in self.d.iter().enumerate().filter(|(_, d)| **d > 0.0) {
            let row = &mut self.m[j * np..][..np];
            let of = |l: usize| (0..n).map(|k| t.get(j, k) * mixed[k * np + l]).sum::<f64>();
            let lumped = (0..np).map(of);
            let rest = (d - row.iter().sum::<f64>()) / d;
            row.iter_mut()
                .zip(lumped)
                .for_each(|(m, part)| *m += rest * part);
        }
    }

    #[inline(always)]
    fn differentiate(&mut self, t: &Transformation, w: &Small, h: &Small, b: &Small) {
        let (n, np, nc) = (self.nnode, self.nodes.len(), self.ncolumn());
        let Derivatives { dd, dm, .. } = &mut self.derivatives;
        zeros(dd, n * nc);
        zeros(dm, n * np * nc);
        zeros(&mut self.dg, n * n * nc);
        zeros(&mut self.product, n * n * nc);
        zeros(&mut self.db, n * n * nc);
        let at = |j: usize, k: usize| (j * n + k) * nc..(j * n + k + 1) * nc;
        let pairs = &self.pairs[..self.met.len()];
        let mut places = &self.places[..];
        for pair in pairs {
            let of_pair = places.split_off(..pair.nnode()[1]).unwrap_or_default();
            let scatter = |to: &mut [f64], from: &[f64]| scatter(n, of_pair, to, from);
            let mut line = [0.0; 2 * COORDINATES];
            let line = &mut line[..pair.ncolumn()];
            for j in 0..n {
                line.fill(0.0);
                for k in 0..n {
                    add(line, t.get(j, k), pair.dn(k));
                    scatter(&mut self.dg[at(j, k)], pair.dnn(j, k));
                }
                scatter(&mut dd[j * nc..][..nc], line);
                for (l, place) in of_pair.iter().enumerate() {
                    line.fill(0.0);
                    for k in 0..n {
                        add(line, b[j][k], pair.dnm(k, l));
                    }
                    scatter(&mut dm[(j * np + place) * nc..][..nc], line);
                }
            }
        }
        for j in (0..n).filter(|&j| self.d[j] <= 0.0) {
            dd[j * nc..][..nc].fill(0.0);
        }
        if self.lumped {
            return;
        }
        let all = |j: usize| j * n * nc..(j + 1) * n * nc;
        for j in 0..n {
            for k in 0..n {
                // dG is symmetric
                let product = &mut self.product[at(j, k)];
                add_rows(product, &b[j][..n], &self.dg[all(k)]);
            }
        }
        for j in 0..n {
            for k in 0..n {
                let db = &mut self.db[at(j, k)];
                add(db, w[j][k], &dd[j * nc..][..nc]);
                let mut factors = [0.0; MAX_FACET_NODES];
                for i in 0..n {
                    factors[i] = -h[i][k];
                }
                add_rows(db, &factors[..n], &self.product[all(j)]);
            }
        }
        for j in 0..n {
            for l in 0..np {
                let mut factors = [0.0; MAX_FACET_NODES];
                for k in 0..n {
                    factors[k] = self.mixed[k * np + l];
                }
                let line = &mut dm[(j * np + l) * nc..][..nc];
                add_rows(line, &factors[..n], &self.db[all(j)]);
            }
        }
    }
}

/// Adds columns of a pair: those of the secondary facet with its `n` nodes, and those of the primary one where its nodes
/// are.
#[inline(always)]
fn scatter(n: usize, places: &[usize], to: &mut [f64], from: &[f64]) {
    let (secondary, primary) = from.split_at(3 * n);
    let (own, others) = to.split_at_mut(3 * n);
    add(own, 1.0, secondary);
    let others = others.as_chunks_mut::<3>().0;
    for (&place, from) in places.iter().zip(primary.as_chunks::<3>().0) {
        for (to, from) in others[place].iter_mut().zip(from) {
            *to += from;
        }
    }
}

/// Sets the entries of a small matrix.
fn each(n: usize, a: &mut Small, value: impl Fn(usize, usize) -> f64) {
    for (j, row) in a[..n].iter_mut().enumerate() {
        for (k, v) in row[..n].iter_mut().enumerate() {
            *v = value(j, k);
        }
    }
}
