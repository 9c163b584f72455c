use super::{Facet, MortarError};
use signorini_geometry::element::{Element, MAX_FACET_NODES};
use signorini_geometry::overlap::{self, Facing, Flat, OverlapError, Plane, Point};
use signorini_geometry::scalar::{Dual, Real};
use signorini_geometry::tensor::Vec3;

/// Coordinates of the secondary facet, of which there are at most this many.
type Coordinates = Dual<{ 3 * MAX_FACET_NODES }>;

/// A primary facet that is folded in the projection is passed over where its normal at the centre deviates by more than
/// 60 degrees from facing: half of it could be bent by as many as the rest, so that it is only seen edge-on.
const FACING: f64 = 0.5;

/// A secondary facet on its auxiliary plane, with derivatives by the coordinates of its nodes.
#[derive(Clone, Debug)]
pub struct Frame {
    element: Element,
    plane: Plane<Coordinates>,
    places: [[Coordinates; 2]; MAX_FACET_NODES],
}

impl Frame {
    /// The frame of a facet.
    ///
    /// # Errors
    /// The facet has no normal, or not one position for each node.
    pub fn of(facet: &Facet) -> Result<Self, MortarError> {
        facet.check()?;
        let mut x = [[Coordinates::from(0.0); 3]; MAX_FACET_NODES];
        for (i, (seeded, x)) in x.iter_mut().zip(facet.x).enumerate() {
            *seeded = [0, 1, 2].map(|c| Coordinates::variable(x[c], 3 * i + c));
        }
        let x = &x[..facet.x.len()];
        let plane = Plane::of(facet.element, x).ok_or(MortarError::Secondary)?;
        let mut places = [[Coordinates::from(0.0); 2]; MAX_FACET_NODES];
        for (place, &x) in places.iter_mut().zip(x) {
            *place = plane.project(x);
        }
        Ok(Self {
            element: facet.element,
            plane,
            places,
        })
    }

    /// ν, out of the primary side.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        -Vec3::from(self.plane.normal.map(|c| c.value))
    }

    /// `∂ν_a/∂v`, by the coordinates of the nodes of the facet.
    pub(super) fn dnormal(&self, a: usize) -> impl Iterator<Item = f64> {
        let slopes = self.plane.normal[a].slope.into_iter().map(|s| -s);
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

    /// Whether the boxes around the places of two facets have nothing in common.
    fn apart(&self, other: &Facet) -> bool {
        let [origin, e1, e2] = [self.plane.origin, self.plane.axes[0], self.plane.axes[1]]
            .map(|v| Vec3::from(v.map(|c| c.value)));
        let outside = |own: &dyn Fn(usize) -> f64, axis: Vec3| {
            let range = |least: f64, most: f64, c: f64| (least.min(c), most.max(c));
            let all = (0..self.element.nnode()).map(own);
            let (a, b) = all.fold((f64::MAX, f64::MIN), |(l, m), c| range(l, m, c));
            let all = other.x.iter().map(|&x| axis.dot(x - origin));
            let (c, d) = all.fold((f64::MAX, f64::MIN), |(l, m), c| range(l, m, c));
            b < c || d < a
        };
        outside(&|i| self.places[i][0].value, e1)
            || (self.element.dim() == 2 && outside(&|i| self.places[i][1].value, e2))
    }

    /// The places of nodes on the plane: of the facet itself where `nodes` is none.
    fn project(&self, nodes: Option<&[Vec3]>) -> [[Coordinates; 2]; MAX_FACET_NODES] {
        let Some(nodes) = nodes else {
            return self.places;
        };
        let mut places = [[Coordinates::from(0.0); 2]; MAX_FACET_NODES];
        for (place, x) in places.iter_mut().zip(nodes) {
            *place = self.plane.project(x.to_array().map(Coordinates::from));
        }
        places
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
/// Areas; lengths in the plane. Derivatives are by the coordinates x, y, z of the nodes, the secondary facet's first.
#[derive(Clone, Debug, Default)]
pub struct Pair {
    nsecondary: usize,
    nprimary: usize,
    /// All integrals, one kind after the other.
    values: Vec<f64>,
    /// The derivatives of each.
    slopes: Vec<f64>,
    /// Derivatives by the places on the plane, and those of the places.
    by_place: Vec<f64>,
    places: Vec<f64>,
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
        let (ns, nm) = (self.nsecondary, self.nprimary);
        let dim = frame.element.dim();
        if frame.apart(primary) {
            return Ok(false);
        }
        let places = [frame.project(None), frame.project(Some(primary.x))];
        let elements = [frame.element, primary.element];
        let found = match (derivatives, dim * (ns + nm)) {
            (false, _) => self.over(elements, &places, |x, _| x),
            (_, ..=6) => self.over(elements, &places, Dual::<6>::variable),
            (_, ..=12) => self.over(elements, &places, Dual::<12>::variable),
            (_, ..=16) => self.over(elements, &places, Dual::<16>::variable),
            (_, ..=24) => self.over(elements, &places, Dual::<24>::variable),
            _ => self.over(elements, &places, Dual::<36>::variable),
        };
        let found = match found {
            Ok(found) => found,
            Err(Fault::Secondary) => return Err(MortarError::Secondary),
            Err(Fault::Primary) if frame.faces(primary) < FACING => false,
            Err(Fault::Primary) => return Err(MortarError::Folded { number }),
        };
        if found && derivatives {
            self.chain(frame, &places, dim);
        }
        Ok(found)
    }

    /// Values, and derivatives by the places on the plane, the variables that `seed` makes.
    fn over<T: Real>(
        &mut self,
        elements: [Element; 2],
        places: &[[[Coordinates; 2]; MAX_FACET_NODES]; 2],
        seed: impl Fn(f64, usize) -> T,
    ) -> Result<bool, Fault> {
        let dim = elements[0].dim();
        let mut flats = [None; 2];
        let mut first = 0;
        for (k, facing) in [Facing::Same, Facing::Opposite].into_iter().enumerate() {
            let mut x = [[T::from(0.0); 2]; MAX_FACET_NODES];
            let n = elements[k].nnode();
            for (x, place) in x[..n].iter_mut().zip(&places[k]) {
                for (x, place) in x[..dim].iter_mut().zip(place) {
                    *x = seed(place.value, first);
                    first += 1;
                }
            }
            flats[k] = Flat::new(elements[k], &x[..n], facing);
        }
        let secondary = flats[0].as_ref().ok_or(Fault::Secondary)?;
        let primary = flats[1].as_ref().ok_or(Fault::Primary)?;
        let mut sums = Sums::new(elements);
        let found = overlap::integrate(secondary, primary, |point| sums.add(point))?;
        self.values.clear();
        self.by_place.clear();
        for sum in sums.all() {
            self.values.push(sum.value());
            self.by_place.extend(sum.slope());
        }
        Ok(found)
    }

    /// From derivatives by places to derivatives by coordinates.
    fn chain(
        &mut self,
        frame: &Frame,
        places: &[[[Coordinates; 2]; MAX_FACET_NODES]; 2],
        dim: usize,
    ) {
        let own = 3 * self.nsecondary;
        let axes = frame.plane.axes.map(|e| e.map(|c| c.value));
        let nodes = places[0][..self.nsecondary]
            .iter()
            .chain(&places[1][..self.nprimary]);
        self.places.clear();
        for place in nodes.flat_map(|place| &place[..dim]) {
            self.places.extend_from_slice(&place.slope[..own]);
        }
        let ncolumn = self.ncolumn();
        let nplace = self.by_place.len() / self.values.len();
        self.slopes.clear();
        self.slopes.resize(self.values.len() * ncolumn, 0.0);
        let each = self.by_place.chunks_exact(nplace);
        for (by_place, slope) in each.zip(self.slopes.chunks_exact_mut(ncolumn)) {
            let (secondary, primary) = slope.split_at_mut(own);
            for (&s, place) in by_place.iter().zip(self.places.chunks_exact(own)) {
                for (slope, p) in secondary.iter_mut().zip(place) {
                    *slope += s * p;
                }
            }
            let of_primary = by_place[dim * self.nsecondary..].chunks_exact(dim);
            for (slope, by_place) in primary.chunks_exact_mut(3).zip(of_primary) {
                for (s, axis) in by_place.iter().zip(&axes) {
                    for (slope, e) in slope.iter_mut().zip(axis) {
                        *slope += s * e;
                    }
                }
            }
        }
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

/// The integrals while points are added.
struct Sums<T> {
    elements: [Element; 2],
    n: [T; MAX_FACET_NODES],
    nn: [[T; MAX_FACET_NODES]; MAX_FACET_NODES],
    nm: [[T; MAX_FACET_NODES]; MAX_FACET_NODES],
}

impl<T: Real> Sums<T> {
    fn new(elements: [Element; 2]) -> Self {
        let row = [T::from(0.0); MAX_FACET_NODES];
        Self {
            elements,
            n: row,
            nn: [row; MAX_FACET_NODES],
            nm: [row; MAX_FACET_NODES],
        }
    }

    fn add(&mut self, point: &Point<T>) {
        let [ns, nm] = self.elements.map(|e| e.nnode());
        let secondary = shape(self.elements[0], point.secondary);
        let primary = shape(self.elements[1], point.primary);
        for j in 0..ns {
            let weighted = point.weight * secondary[j];
            self.n[j] += weighted;
            for (sum, &n) in self.nn[j][..=j].iter_mut().zip(&secondary) {
                *sum += weighted * n;
            }
            for (sum, &n) in self.nm[j][..nm].iter_mut().zip(&primary) {
                *sum += weighted * n;
            }
        }
    }

    /// In the order of [`Pair`]; above the diagonal of `∫N_j N_k` there is nothing.
    fn all(&self) -> impl Iterator<Item = &T> {
        let [ns, nm] = self.elements.map(|e| e.nnode());
        let nn = self.nn[..ns].iter().flat_map(move |row| &row[..ns]);
        let nm = self.nm[..ns].iter().flat_map(move |row| &row[..nm]);
        self.n[..ns].iter().chain(nn).chain(nm)
    }
}

/// Shape functions at parameters with derivatives.
fn shape<T: Real>(element: Element, xi: [T; 2]) -> [T; MAX_FACET_NODES] {
    let (n, dim) = (element.nnode(), element.dim());
    let mut values = [0.0; MAX_FACET_NODES];
    let mut slopes = [Vec3::ZERO; MAX_FACET_NODES];
    let at = Vec3::new(xi[0].value(), xi[1].value(), 0.0);
    element.shape(&at, &mut values[..n]);
    element.dshape(&at, &mut slopes[..n]);
    let mut shape = [T::from(0.0); MAX_FACET_NODES];
    for ((shape, &value), slope) in shape[..n].iter_mut().zip(&values).zip(&slopes) {
        let terms = [(slope.x, xi[0]), (slope.y, xi[1])];
        *shape = T::chain(value, &terms[..dim]);
    }
    shape
}
