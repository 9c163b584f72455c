use super::factor::{Factor, zeros};
use super::products::Products;
use super::{Facet, Measure, MortarError};
use pulp::Arch;
use signorini_geometry::element::{Element, MAX_FACET_NODES};
use signorini_geometry::overlap::{Facing, Flat, OverlapError, Plane};
use signorini_geometry::scalar::Dual;
use signorini_geometry::tensor::Vec3;

/// From 60 degrees on, as a cosine, the weight (E6) of two facets falls, and a primary facet that is folded in the projection
/// is passed over: half of it could be bent by as many as the rest, so that it is only seen edge-on.
const FACING: f64 = 0.5;

/// At 80 degrees two facets do not see one another.
const EDGE_ON: f64 = 0.173_648_177_666_930_33;

/// The weight (E6) of facets with this cosine of the angle by which they fail to face one another, and its derivative.
pub(super) fn facing(cosine: f64) -> (f64, f64) {
    let s = ((cosine - EDGE_ON) / (FACING - EDGE_ON)).clamp(0.0, 1.0);
    (
        s * s * (3.0 - 2.0 * s),
        6.0 * s * (1.0 - s) / (FACING - EDGE_ON),
    )
}

/// What is left of an overlap that is none, relative to its cells.
const NOTHING: f64 = 1e-13;

/// Coordinates of a facet, of which there are at most this many.
pub(super) const COORDINATES: usize = 3 * MAX_FACET_NODES;

/// A vector by the coordinates of a facet: its derivatives, component by component.
type Slopes = [[f64; COORDINATES]; 3];

/// A secondary facet on its auxiliary plane, with derivatives by the coordinates of its nodes.
#[derive(Clone, Debug)]
pub struct Frame {
    element: Element,
    measure: Measure,
    x: [Vec3; MAX_FACET_NODES],
    origin: Vec3,
    axes: [Vec3; 2],
    normal: Vec3,
    daxes: [Slopes; 2],
    dnormal: Slopes,
    places: Places,
    /// The facet on its plane, if it is not folded there.
    flat: Option<Flat>,
}

/// Places of nodes on the plane.
type Places = [[f64; 2]; MAX_FACET_NODES];

impl Frame {
    /// The frame of a facet.
    ///
    /// # Errors
    /// The facet has no normal, or not one position for each node.
    pub fn of(facet: &Facet) -> Result<Self, MortarError> {
        Self::measured(facet, Measure::Flat)
    }

    /// The frame of a facet whose integrals have this measure.
    ///
    /// # Errors
    /// The facet has no normal, or not one position for each node.
    pub fn measured(facet: &Facet, measure: Measure) -> Result<Self, MortarError> {
        facet.check()?;
        let mut frame = Self {
            element: facet.element,
            measure,
            x: [Vec3::ZERO; MAX_FACET_NODES],
            origin: Vec3::ZERO,
            axes: [Vec3::ZERO; 2],
            normal: Vec3::ZERO,
            daxes: [[[0.0; COORDINATES]; 3]; 2],
            dnormal: [[0.0; COORDINATES]; 3],
            places: [[0.0; 2]; MAX_FACET_NODES],
            flat: None,
        };
        frame.x[..facet.x.len()].copy_from_slice(facet.x);
        let found = match 3 * facet.x.len() {
            0..=6 => frame.erect::<6>(facet),
            7..=12 => frame.erect::<12>(facet),
            13..=18 => frame.erect::<18>(facet),
            _ => frame.erect::<COORDINATES>(facet),
        };
        found.ok_or(MortarError::Secondary)?;
        frame.places = frame.project(facet.x);
        frame.flat = Flat::new(facet.element, &frame.places[..facet.x.len()], Facing::Same);
        Ok(frame)
    }

    /// The plane, in numbers with `N` derivatives.
    fn erect<const N: usize>(&mut self, facet: &Facet) -> Option<()> {
        let mut x = [[Dual::<N>::from(0.0); 3]; MAX_FACET_NODES];
        for (i, (seeded, x)) in x.iter_mut().zip(facet.x).enumerate() {
            *seeded = [0, 1, 2].map(|c| Dual::variable(x[c], 3 * i + c));
        }
        let plane = Plane::of(facet.element, &x[..facet.x.len()])?;
        let take = |vector: &[Dual<N>; 3], slopes: &mut Slopes| {
            for (to, from) in slopes.iter_mut().zip(vector) {
                to[..N].copy_from_slice(&from.slope);
            }
            Vec3::from(vector.map(|c| c.value))
        };
        self.origin = Vec3::from(plane.origin.map(|c| c.value));
        for (a, axis) in plane.axes.iter().enumerate() {
            self.axes[a] = take(axis, &mut self.daxes[a]);
        }
        self.normal = take(&plane.normal, &mut self.dnormal);
        Some(())
    }

    /// ν, out of the primary side.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        -self.normal
    }

    /// `∂ν_a/∂v`, by the coordinates of the nodes of the facet.
    pub(super) fn dnormal(&self, a: usize) -> impl Iterator<Item = f64> {
        let slopes = self.dnormal[a].into_iter().map(|s| -s);
        slopes.take(3 * self.element.nnode())
    }

    /// Whether the boxes around places of this facet and of others have nothing in common.
    fn apart(&self, others: &[[f64; 2]]) -> bool {
        let own = &self.places[..self.element.nnode()];
        let range = |of: &[[f64; 2]], a: usize| {
            let all = of.iter().map(|p| p[a]);
            all.fold((f64::MAX, f64::MIN), |(l, m), c| (l.min(c), m.max(c)))
        };
        (0..self.element.dim()).any(|a| {
            let ((a0, a1), (b0, b1)) = (range(own, a), range(others, a));
            a1 < b0 || b1 < a0
        })
    }

    /// The places of points on the plane; the second coordinate is zero on a line.
    fn project(&self, x: &[Vec3]) -> Places {
        let mut places = [[0.0; 2]; MAX_FACET_NODES];
        for (place, &x) in places.iter_mut().zip(x) {
            for (place, axis) in place[..self.element.dim()].iter_mut().zip(&self.axes) {
                *place = axis.dot(x - self.origin);
            }
        }
        places
    }

    /// By what areas are multiplied.
    pub(super) fn factor(&self) -> Factor {
        let [a, b] = [0, 1].map(|k| (self.places[k][0], self.x[k].x));
        match self.measure {
            Measure::Revolved if self.element.dim() == 1 => Factor::Circumference([a, b]),
            _ => Factor::One,
        }
    }

    /// The place of a point along the first axis.
    pub(super) fn along(&self, x: Vec3) -> f64 {
        self.axes[0].dot(x - self.origin)
    }
}

impl Facet<'_> {
    /// Its plane at the centre; `None` where it has no normal.
    pub(super) fn plane(&self) -> Option<Plane<f64>> {
        let mut nodes = [[0.0; 3]; MAX_FACET_NODES];
        for (node, x) in nodes.iter_mut().zip(self.x) {
            *node = x.to_array();
        }
        Plane::of(self.element, nodes.get(..self.x.len())?)
    }

    /// The facet projected onto a plane; `None` where it is folded there, or does not face it in this way.
    pub(super) fn flat_on(&self, plane: &Plane<f64>, facing: Facing) -> Option<Flat> {
        let mut places = [[0.0; 2]; MAX_FACET_NODES];
        for (place, x) in places.iter_mut().zip(self.x) {
            *place = plane.project(x.to_array());
            if self.element.dim() == 1 {
                place[1] = 0.0;
            }
        }
        Flat::new(self.element, places.get(..self.x.len())?, facing)
    }

    /// Its normal at the centre; zero where it has none.
    fn normal(&self) -> Vec3 {
        self.plane()
            .map_or(Vec3::ZERO, |plane| Vec3::from(plane.normal))
    }

    pub(super) fn check(&self) -> Result<(), MortarError> {
        let (n, dim) = (self.element.nnode(), self.element.dim());
        if n == self.x.len() && n <= MAX_FACET_NODES && dim < 3 {
            return Ok(());
        }
        Err(MortarError::Positions {
            element: self.element.name(),
            positions: self.x.len(),
        })
    }
}

/// `∫N_j`, `∫N_j N_k` and `∫N_j N^m_l` over what a secondary facet shares with one primary facet, and their derivatives.
///
/// # Units
/// Areas; lengths in the plane; areas of surfaces of revolution where so [measured](Measure). Derivatives are by the
/// coordinates x, y, z of the nodes, the secondary facet's first.
#[derive(Clone, Debug, Default)]
pub struct Pair {
    nsecondary: usize,
    nprimary: usize,
    dim: usize,
    /// Of the angle by which the two fail to face one another.
    cosine: f64,
    /// Of the primary facet at its centre, out of its body.
    opposite: Vec3,
    /// All integrals, one kind after the other.
    values: Vec<f64>,
    /// The derivatives of each.
    slopes: Vec<f64>,
    products: Products,
    /// Derivatives of all products by one coordinate.
    column: Vec<f64>,
    /// Those by how the axes turn, component by component.
    turn: Vec<f64>,
}

impl Pair {
    /// Integrates; answers whether the two share anything. Without `derivatives` only values are found.
    ///
    /// # Errors
    /// A facet is folded while it faces the other, or not as [`Facet`] says. `number` is that of the primary facet in
    /// messages.
    pub fn integrate(
        &mut self,
        frame: &Frame,
        primary: &Facet,
        number: usize,
        derivatives: bool,
    ) -> Result<bool, MortarError> {
        primary.check()?;
        (self.nsecondary, self.nprimary) = (frame.element.nnode(), primary.x.len());
        self.dim = frame.element.dim();
        let places = frame.project(primary.x);
        if frame.apart(&places[..self.nprimary]) {
            return Ok(false);
        }
        self.opposite = primary.normal();
        self.cosine = self.opposite.dot(frame.normal());
        if self.cosine <= EDGE_ON {
            return Ok(false);
        }
        let found = self.over(frame, primary.element, &places, derivatives);
        let found = match found {
            Ok(found) => found,
            Err(Fault::Secondary) => return Err(MortarError::Secondary),
            Err(Fault::Primary) if self.cosine < FACING => false,
            Err(Fault::Primary) => return Err(MortarError::Folded { number }),
        };
        if found && derivatives {
            Arch::new().dispatch(
                #[inline(always)]
                || self.chain(frame, primary),
            );
        }
        if found && self.cosine < FACING {
            self.fade(frame, primary, derivatives)?;
        }
        Ok(found)
    }

    /// Integrates over what both share on the plane.
    fn over(
        &mut self,
        frame: &Frame,
        primary: Element,
        places: &Places,
        derivatives: bool,
    ) -> Result<bool, Fault> {
        let (ns, nm) = (self.nsecondary, self.nprimary);
        let secondary = frame.flat.as_ref().ok_or(Fault::Secondary)?;
        let primary = Flat::new(primary, &places[..nm], Facing::Opposite);
        let primary = primary.as_ref().ok_or(Fault::Primary)?;
        let products = &mut self.products;
        let gross = products.over(secondary, primary, frame.factor(), derivatives)?;
        self.values.clear();
        let sums = (0..ns).map(|j| (0..nm).map(|l| products.value(1, j, l)).sum::<f64>());
        self.values.extend(sums);
        for (block, n) in [(0, ns), (1, nm)] {
            let all = (0..ns).flat_map(|j| (0..n).map(move |k| (j, k)));
            self.values
                .extend(all.map(|(j, k)| products.value(block, j, k)));
        }
        // cells that are taken away may leave nothing but rounding
        Ok(self.values[..ns].iter().sum::<f64>() > NOTHING * gross)
    }

    /// From derivatives by places `X_ia = e_a·(x_i − o)` to derivatives by coordinates. Integrals do not notice when both
    /// facets move along the plane: what comes from `o` is zero in sum.
    #[inline(always)]
    fn chain(&mut self, frame: &Frame, primary: &Facet) {
        let (ncolumn, dim, n) = (self.ncolumn(), self.dim, self.products.len());
        let nodes = || {
            frame.x[..self.nsecondary]
                .iter()
                .chain(primary.x)
                .enumerate()
        };
        zeros(&mut self.turn, 3 * dim * n);
        for ((a, c), turn) in axes(dim).zip(self.turn.chunks_exact_mut(n)) {
            for (node, &x) in nodes() {
                let arm = (x - frame.origin)[c];
                add(turn, arm, self.products.by_place(node, a));
            }
        }
        zeros(&mut self.slopes, self.values.len() * ncolumn);
        for node in 0..self.nsecondary + self.nprimary {
            for c in 0..3 {
                let column = 3 * node + c;
                zeros(&mut self.column, n);
                for (a, axis) in frame.axes.iter().enumerate().take(dim) {
                    add(&mut self.column, axis[c], self.products.by_place(node, a));
                }
                if node < self.nsecondary {
                    let mut turns = [0.0; 6];
                    for ((a, c), turn) in axes(dim).zip(&mut turns) {
                        *turn = frame.daxes[a][c][column];
                    }
                    add_rows(&mut self.column, &turns[..3 * dim], &self.turn);
                }
                if c == 0 && node < 2 {
                    add(&mut self.column, 1.0, self.products.by_radius(node)); // r is the first coordinate
                }
                self.store(column);
            }
        }
    }

    /// Stores derivatives of all integrals by one coordinate, and `∫N_j = Σ_l ∫N_j N^m_l`.
    fn store(&mut self, column: usize) {
        let (ns, nm, ncolumn) = (self.nsecondary, self.nprimary, self.ncolumn());
        let (sums, rest) = self.slopes.split_at_mut(ns * ncolumn);
        let (own, mixed) = rest.split_at_mut(ns * ns * ncolumn);
        for j in 0..ns {
            let of = |block| &self.column[self.products.place(block, j, 0)..];
            for (row, slope) in own[j * ns * ncolumn..]
                .chunks_exact_mut(ncolumn)
                .zip(&of(0)[..ns])
            {
                row[column] = *slope;
            }
            for (row, slope) in mixed[j * nm * ncolumn..]
                .chunks_exact_mut(ncolumn)
                .zip(&of(1)[..nm])
            {
                row[column] = *slope;
            }
            sums[j * ncolumn + column] = of(1)[..nm].iter().sum();
        }
    }

    /// Multiplies all integrals with the weight (E6).
    fn fade(
        &mut self,
        frame: &Frame,
        primary: &Facet,
        derivatives: bool,
    ) -> Result<(), MortarError> {
        let (weight, slope) = facing(self.cosine);
        if derivatives {
            let other = Frame::of(primary)?;
            let (own, ncolumn) = (3 * self.nsecondary, self.ncolumn());
            let mut change = [0.0; 2 * COORDINATES];
            for a in 0..3 {
                let of_own = frame.dnormal(a).map(|d| d * other.normal[a]);
                let of_other = other.dnormal(a).map(|d| d * frame.normal[a]);
                let (first, rest) = change.split_at_mut(own);
                let each = first
                    .iter_mut()
                    .zip(of_own)
                    .chain(rest.iter_mut().zip(of_other));
                each.for_each(|(to, d)| *to += slope * d);
            }
            let rows = self.slopes.chunks_exact_mut(ncolumn);
            for (row, value) in rows.zip(&self.values) {
                for (to, change) in row.iter_mut().zip(&change) {
                    *to = weight * *to + value * change;
                }
            }
        }
        self.values.iter_mut().for_each(|value| *value *= weight);
        Ok(())
    }

    /// The number of nodes of the secondary and of the primary facet.
    #[must_use]
    pub fn nnode(&self) -> [usize; 2] {
        [self.nsecondary, self.nprimary]
    }

    /// The number of columns: three for each node of either facet.
    #[must_use]
    pub fn ncolumn(&self) -> usize {
        3 * (self.nsecondary + self.nprimary)
    }

    /// The cosine of the angle by which the two fail to face one another.
    #[must_use]
    pub fn cosine(&self) -> f64 {
        self.cosine
    }

    /// The normal of the primary facet at its centre, out of its body; zero where it has none.
    #[must_use]
    pub fn opposite(&self) -> Vec3 {
        self.opposite
    }

    /// The area that both share.
    #[must_use]
    pub fn area(&self) -> f64 {
        (0..self.nsecondary).map(|j| self.n(j)).sum()
    }

    /// The mean of the way from the primary to the secondary facet, whose nodes are at `primary` and `secondary`.
    #[must_use]
    pub fn mean_way(&self, secondary: &[Vec3], primary: &[Vec3]) -> Vec3 {
        let origin = secondary.first().copied().unwrap_or_default();
        let mut way = Vec3::ZERO;
        for (j, &x) in secondary.iter().enumerate().take(self.nsecondary) {
            way += (x - origin) * self.n(j);
            for (l, &x) in primary.iter().enumerate().take(self.nprimary) {
                way -= (x - origin) * self.nm(j, l);
            }
        }
        way / self.area()
    }

    /// `∫N_j`.
    #[must_use]
    pub fn n(&self, j: usize) -> f64 {
        self.values[j]
    }

    /// `∫N_j N_k`.
    #[must_use]
    pub fn nn(&self, j: usize, k: usize) -> f64 {
        self.values[self.place_nn(j, k)]
    }

    /// `∫N_j N^m_l`.
    #[must_use]
    pub fn nm(&self, j: usize, l: usize) -> f64 {
        self.values[self.place_nm(j, l)]
    }

    /// The derivatives of `∫N_j`, one for each column.
    #[must_use]
    pub fn dn(&self, j: usize) -> &[f64] {
        self.slope(j)
    }

    /// The derivatives of `∫N_j N_k`.
    #[must_use]
    pub fn dnn(&self, j: usize, k: usize) -> &[f64] {
        self.slope(self.place_nn(j, k))
    }

    /// The derivatives of `∫N_j N^m_l`.
    #[must_use]
    pub fn dnm(&self, j: usize, l: usize) -> &[f64] {
        self.slope(self.place_nm(j, l))
    }

    fn place_nn(&self, j: usize, k: usize) -> usize {
        self.nsecondary * (1 + j) + k
    }

    fn place_nm(&self, j: usize, l: usize) -> usize {
        self.nsecondary * (1 + self.nsecondary) + j * self.nprimary + l
    }

    fn slope(&self, integral: usize) -> &[f64] {
        let n = self.ncolumn();
        &self.slopes[integral * n..][..n]
    }
}

/// Which facet cannot be integrated over.
enum Fault {
    Secondary,
    Primary,
}

impl From<OverlapError> for Fault {
    fn from(_: OverlapError) -> Self {
        Self::Primary
    }
}

/// The directions of places and components of vectors.
fn axes(dim: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..dim).flat_map(|a| (0..3).map(move |c| (a, c)))
}

/// `to += factor · from`
#[inline(always)]
pub(super) fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += factor * from;
    }
}

/// `to += Σ factor · row` over rows that lie one behind the other: four at a time, so that `to` is passed over less often.
#[inline(always)]
pub(super) fn add_rows(to: &mut [f64], factors: &[f64], rows: &[f64]) {
    let n = to.len();
    let (fours, rest) = factors.as_chunks::<4>();
    let (of_fours, of_rest) = rows.split_at(4 * fours.len() * n);
    for ([p, q, r, s], rows) in fours.iter().zip(of_fours.chunks_exact((4 * n).max(1))) {
        let (a, b) = rows.split_at(2 * n);
        let ((a, b), (c, d)) = (a.split_at(n), b.split_at(n));
        for ((((to, a), b), c), d) in to.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *to += (p * a + q * b) + (r * c + s * d);
        }
    }
    for (factor, row) in rest.iter().zip(of_rest.chunks_exact(n.max(1))) {
        add(to, *factor, row);
    }
}
