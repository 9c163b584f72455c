use super::{Facet, Measure, MortarError};
use signorini_geometry::element::{Element, MAX_FACET_NODES};
use signorini_geometry::overlap::{
    self, Cell, Facing, Flat, OverlapError, Parameters, Plane, Point,
};
use signorini_geometry::scalar::{Dual, Real};
use signorini_geometry::tensor::Vec3;
use std::f64::consts::TAU;

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
const COORDINATES: usize = 3 * MAX_FACET_NODES;

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

    /// The cosine of the angle by which a facet fails to face this one at its centre.
    fn faces(&self, other: &Facet) -> f64 {
        let x = other.x.iter().map(|x| x.to_array());
        let mut nodes = [[0.0; 3]; MAX_FACET_NODES];
        nodes.iter_mut().zip(x).for_each(|(node, x)| *node = x);
        let plane = Plane::of(other.element, &nodes[..other.x.len()]);
        plane.map_or(0.0, |plane| Vec3::from(plane.normal).dot(self.normal()))
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

    /// The places of points on the plane.
    fn project(&self, x: &[Vec3]) -> Places {
        let mut places = [[0.0; 2]; MAX_FACET_NODES];
        for (place, &x) in places.iter_mut().zip(x) {
            *place = self.axes.map(|axis| axis.dot(x - self.origin));
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

/// By what areas are multiplied, at a place along the line.
#[derive(Clone, Copy, Debug)]
pub(super) enum Factor {
    /// 1.
    One,
    /// (E5), from places and radii of the ends.
    Circumference([(f64, f64); 2]),
}

impl Factor {
    /// Its degree as a polynomial of the place.
    fn degree(self) -> usize {
        match self {
            Self::One => 0,
            Self::Circumference(_) => 1,
        }
    }

    pub(super) fn at(self, p: f64) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Circumference([(a, ra), (b, rb)]) => {
                TAU * ((b - p) * ra + (p - a) * rb) / (b - a)
            }
        }
    }

    /// Its derivatives by the place, and by places and radii of the ends.
    fn slopes(self, p: f64) -> Option<[f64; 5]> {
        let Self::Circumference([(a, ra), (b, rb)]) = self else {
            return None;
        };
        let (slope, share) = (TAU * (rb - ra) / (b - a), (p - a) / (b - a));
        let of_ends = [-slope * (1.0 - share), -slope * share];
        let of_radii = [TAU * (1.0 - share), TAU * share];
        Some([slope, of_ends[0], of_ends[1], of_radii[0], of_radii[1]])
    }
}

impl Facet<'_> {
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
    /// All integrals, one kind after the other; above the diagonal of `∫N_j N_k` there is nothing.
    values: Vec<f64>,
    /// The derivatives of each.
    slopes: Vec<f64>,
    /// Derivatives by the places on the plane, and by the radii of the ends.
    by_place: Vec<f64>,
    nvariable: usize,
    /// Derivatives by the corners of the cell at hand.
    by_corner: Vec<f64>,
    ncorner: usize,
    /// Of the corners, what moves them: the component, the variable, and the derivative.
    moves: Vec<(usize, usize, f64)>,
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
        self.cosine = frame.faces(primary);
        if self.cosine <= EDGE_ON {
            return Ok(false);
        }
        let elements = [frame.element, primary.element];
        let places = [frame.places, places];
        let factor = frame.factor();
        let found = match (derivatives, self.dim * (self.nsecondary + self.nprimary)) {
            (false, _) => self.over(elements, &places, factor, |x, _| x),
            (_, ..=6) => self.over(elements, &places, factor, Dual::<6>::variable),
            (_, ..=12) => self.over(elements, &places, factor, Dual::<12>::variable),
            (_, ..=16) => self.over(elements, &places, factor, Dual::<16>::variable),
            (_, ..=24) => self.over(elements, &places, factor, Dual::<24>::variable),
            _ => self.over(elements, &places, factor, Dual::<36>::variable),
        };
        let found = match found {
            Ok(found) => found,
            Err(Fault::Secondary) => return Err(MortarError::Secondary),
            Err(Fault::Primary) if frame.faces(primary) < FACING => false,
            Err(Fault::Primary) => return Err(MortarError::Folded { number }),
        };
        if found && derivatives {
            self.chain(frame, primary);
        }
        if found && self.cosine < FACING {
            self.fade(frame, primary, derivatives)?;
        }
        Ok(found)
    }

    /// Values, and derivatives by the places on the plane, the variables that `seed` makes.
    fn over<T: Real>(
        &mut self,
        elements: [Element; 2],
        places: &[Places; 2],
        factor: Factor,
        seed: impl Fn(f64, usize) -> T,
    ) -> Result<bool, Fault> {
        let dim = self.dim;
        let mut flats = [None; 2];
        let mut first = 0;
        for (k, facing) in [Facing::Same, Facing::Opposite].into_iter().enumerate() {
            let mut x = [[T::from(0.0); 2]; MAX_FACET_NODES];
            let n = elements[k].nnode();
            for (x, place) in x[..n].iter_mut().zip(&places[k]) {
                for (x, &place) in x[..dim].iter_mut().zip(place) {
                    *x = seed(place, first);
                    first += 1;
                }
            }
            flats[k] = Flat::new(elements[k], &x[..n], facing);
        }
        let secondary = flats[0].as_ref().ok_or(Fault::Secondary)?;
        let primary = flats[1].as_ref().ok_or(Fault::Primary)?;
        let derivatives = !T::from(0.0).slope().is_empty();
        self.nvariable = if derivatives {
            first + 2 * factor.degree()
        } else {
            0
        };
        let nintegral = self.nsecondary * (1 + self.nsecondary + self.nprimary);
        zeros(&mut self.values, nintegral);
        zeros(&mut self.by_place, nintegral * self.nvariable);
        let mut gross = 0.0;
        overlap::integrate(secondary, primary, |cell: &Cell<T>| {
            self.ncorner = cell.corners().len();
            if derivatives {
                zeros(&mut self.by_corner, nintegral * 2 * self.ncorner);
            }
            cell.points(factor.degree(), |point| {
                let factor = Weighted::new(point, factor);
                gross += factor.weight.abs();
                self.add(point, &factor);
                if derivatives {
                    self.differentiate(point, &factor);
                }
            })?;
            if derivatives {
                self.follow(cell.corners());
            }
            Ok(())
        })?;
        self.sum_up();
        // cells that are taken away may leave nothing but rounding
        Ok(self.values[..self.nsecondary].iter().sum::<f64>() > NOTHING * gross)
    }

    /// Adds what a point contributes to the products.
    fn add(&mut self, point: &Point, weighted: &Weighted) {
        let (ns, nm) = (self.nsecondary, self.nprimary);
        let (own, other) = (&point.secondary.shape[..ns], &point.primary.shape[..nm]);
        let (products, mixed) = self.values[ns..].split_at_mut(ns * ns);
        let rows = products
            .chunks_exact_mut(ns)
            .zip(mixed.chunks_exact_mut(nm));
        for (j, (product, mixed)) in rows.enumerate() {
            let w = weighted.weight * own[j];
            for (sum, n) in product[..=j].iter_mut().zip(own) {
                *sum += w * n;
            }
            for (sum, n) in mixed.iter_mut().zip(other) {
                *sum += w * n;
            }
        }
    }

    /// Adds what it contributes to derivatives of the products `f = N_j N_k` and `N_j N^m_l`: by the places of nodes,
    /// and by the corners it follows, both of (E4) of the overlap.
    fn differentiate(&mut self, point: &Point, weighted: &Weighted) {
        let (ns, nm, dim) = (self.nsecondary, self.nprimary, self.dim);
        let w = weighted.weight;
        // −w ∂N_j/∂p_a N_i, by the places X_ia, of either facet
        let pull = |there: &Parameters, n: usize| {
            let mut pull = [[0.0; 2 * MAX_FACET_NODES]; MAX_FACET_NODES];
            for (pull, g) in pull[..n].iter_mut().zip(&there.gradient) {
                for (pull, shape) in pull.chunks_exact_mut(dim).zip(&there.shape[..n]) {
                    for (pull, g) in pull.iter_mut().zip(g) {
                        *pull = -w * g * shape;
                    }
                }
            }
            pull
        };
        let (own, other) = (&point.secondary, &point.primary);
        let (of_own, of_other) = (pull(own, ns), pull(other, nm));
        let (ds, dm) = (dim * ns, dim * nm);
        for j in 0..ns {
            for k in 0..=j {
                let integral = self.place_nn(j, k);
                let row = &mut self.by_place[integral * self.nvariable..][..self.nvariable];
                let (a, b) = (own.shape[k], own.shape[j]);
                for ((to, p), q) in row[..ds].iter_mut().zip(&of_own[j]).zip(&of_own[k]) {
                    *to += a * p + b * q;
                }
                let [g, h] = [own.gradient[j], own.gradient[k]];
                self.move_with(integral, point, weighted, (b, g), (a, h));
            }
            for (l, of_other) in of_other[..nm].iter().enumerate() {
                let integral = self.place_nm(j, l);
                let row = &mut self.by_place[integral * self.nvariable..][..self.nvariable];
                let (a, b) = (other.shape[l], own.shape[j]);
                let (first, rest) = row.split_at_mut(ds);
                for (to, p) in first.iter_mut().zip(&of_own[j]) {
                    *to += a * p;
                }
                for (to, p) in rest[..dm].iter_mut().zip(of_other) {
                    *to += b * p;
                }
                let [g, h] = [own.gradient[j], other.gradient[l]];
                self.move_with(integral, point, weighted, (b, g), (a, h));
            }
        }
    }

    /// The product of two functions, given by value and gradient, at a point that moves with its corners.
    #[inline]
    fn move_with(
        &mut self,
        integral: usize,
        point: &Point,
        weighted: &Weighted,
        (f, df): (f64, [f64; 2]),
        (g, dg): (f64, [f64; 2]),
    ) {
        let product = f * g;
        let slope = [0, 1].map(|a| weighted.weight * (df[a] * g + f * dg[a]));
        let along = slope[0] + weighted.along * product;
        let row = &mut self.by_corner[integral * 2 * self.ncorner..][..2 * self.ncorner];
        for follow in &point.follows {
            let to = &mut row[2 * follow.corner..][..2];
            to[0] += follow.share * along + weighted.factor * follow.dweight[0] * product;
            to[1] += follow.share * slope[1] + weighted.factor * follow.dweight[1] * product;
        }
        if let Some(by_ends) = weighted.by_ends {
            let row = &mut self.by_place[integral * self.nvariable..][..self.nvariable];
            let radii = self.nvariable - 2;
            for (v, slope) in [0, 1, radii, radii + 1].into_iter().zip(by_ends) {
                row[v] += slope * product;
            }
        }
    }

    /// From derivatives by the corners of a cell to derivatives by places.
    fn follow<T: Real>(&mut self, corners: &[[T; 2]]) {
        self.moves.clear();
        for (component, c) in corners.iter().flatten().enumerate() {
            let slopes = c.slope().iter().enumerate().filter(|(_, s)| **s != 0.0);
            self.moves.extend(slopes.map(|(v, &s)| (component, v, s)));
        }
        let rows = self.by_place.chunks_exact_mut(self.nvariable);
        for (row, by_corner) in rows.zip(self.by_corner.chunks_exact(2 * self.ncorner)) {
            for &(component, v, slope) in &self.moves {
                row[v] += by_corner[component] * slope;
            }
        }
    }

    /// `∫N_j = Σ_l ∫N_j N^m_l`.
    fn sum_up(&mut self) {
        let (ns, nm, nv) = (self.nsecondary, self.nprimary, self.nvariable);
        let first = ns * (1 + ns);
        for j in 0..ns {
            let all = first + j * nm..first + (j + 1) * nm;
            self.values[j] = self.values[all.clone()].iter().sum();
            let (sums, rows) = self.by_place.split_at_mut(ns * nv);
            for l in all {
                let from = &rows[(l - ns) * nv..][..nv];
                for (to, from) in sums[j * nv..][..nv].iter_mut().zip(from) {
                    *to += from;
                }
            }
        }
    }

    /// From derivatives by places `X_ia = e_a·(x_i − o)` to derivatives by coordinates. Integrals do not notice when both
    /// facets move along the plane: what comes from `o` is zero in sum.
    fn chain(&mut self, frame: &Frame, primary: &Facet) {
        let (own, ncolumn, dim) = (3 * self.nsecondary, self.ncolumn(), self.dim);
        let nodes = || frame.x[..self.nsecondary].iter().chain(primary.x);
        zeros(&mut self.slopes, self.values.len() * ncolumn);
        let each = self.by_place.chunks_exact(self.nvariable);
        for (by_place, slope) in each.zip(self.slopes.chunks_exact_mut(ncolumn)) {
            let mut turn = [Vec3::ZERO; 2];
            let of_nodes = by_place.chunks_exact(dim).zip(slope.as_chunks_mut::<3>().0);
            for ((by_place, slope), &x) in of_nodes.zip(nodes()) {
                for ((&s, &axis), turn) in by_place.iter().zip(&frame.axes).zip(&mut turn) {
                    for (slope, along) in slope.iter_mut().zip((axis * s).to_array()) {
                        *slope += along;
                    }
                    *turn += (x - frame.origin) * s;
                }
            }
            for (turn, daxis) in turn[..dim].iter().zip(&frame.daxes) {
                for (c, daxis) in daxis.iter().enumerate() {
                    for (slope, d) in slope[..own].iter_mut().zip(daxis) {
                        *slope += turn[c] * d;
                    }
                }
            }
            let nplace = dim * ncolumn / 3;
            for (end, s) in by_place[nplace..].iter().enumerate() {
                slope[3 * end] += s; // r is the first coordinate
            }
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
        self.nsecondary * (1 + j.max(k)) + j.min(k)
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

/// The weight of a point and its factor.
struct Weighted {
    /// Both.
    weight: f64,
    factor: f64,
    /// The derivative of the factor by the place, times the weight alone.
    along: f64,
    /// Those by the places and radii of the ends, likewise.
    by_ends: Option<[f64; 4]>,
}

impl Weighted {
    fn new(point: &Point, factor: Factor) -> Self {
        let value = factor.at(point.at[0]);
        let slopes = factor
            .slopes(point.at[0])
            .map(|s| s.map(|s| s * point.weight));
        Self {
            weight: value * point.weight,
            factor: value,
            along: slopes.map_or(0.0, |s| s[0]),
            by_ends: slopes.map(|[_, a, b, ra, rb]| [a, b, ra, rb]),
        }
    }
}

pub(super) fn zeros(v: &mut Vec<f64>, n: usize) {
    v.clear();
    v.resize(n, 0.0);
}
