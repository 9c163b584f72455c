//! Where CalculiX prints: its integration points, in its order.

use signorini_geometry::element;
use signorini_geometry::element::quadrature::{LINE_2, LINE_3, Rule, TET_4, TRI_1, TRI_3};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// The points at which values of an element are printed.
///
/// | element | points | |
/// |---|---|---|
/// | hex8, hex20, tet4, tet10, wedge15 | 8, 27 or reduced 8, 1, 4, 9 | products run through ξ fastest, then η, then ζ |
/// | wedge6 | 2 | on the line through the centroids of its triangles |
/// | quad4, quad8 | 4 in 2 layers, 9 in 3 or reduced 4 in 2 | the plane expanded into space, layer by layer |
/// | tri3, tri6 | 1 in 2 layers, 3 in 3 | likewise; of revolution: a wedge of two degrees, from −1° to 1° |
/// | line2, line3 | 2 in 4 layers | a bar expanded into a square one |
///
/// Values at other points than those of the element's own rule are those of the linear field that comes closest.
#[derive(Clone, Debug)]
pub struct Points {
    /// A row over the points of the rule for each place; none where the places are the points.
    weights: Option<Vec<f64>>,
    npoint: usize,
    nplace: usize,
    /// Radians about the axis of each layer.
    angles: Vec<f64>,
}

/// Half the angle of the wedge that stands for a body of revolution, in radians.
const HALF_WEDGE: f64 = std::f64::consts::PI / 180.0;

/// What CalculiX's wedge is of the whole circumference.
pub const WEDGE: f64 = 1.0 / 180.0;

impl Points {
    /// The points of an element with this rule, by its name; `revolved` in bodies of revolution.
    #[must_use]
    pub fn new(element: &str, rule: &Rule, revolved: bool) -> Self {
        let places = places(element);
        let places = places.as_deref().unwrap_or(rule.points);
        let layers = layers(element, rule.npoint());
        // a linear layer stays plane: of a turned tensor it knows half
        let is_linear = element::by_name(element).is_some_and(|e| e.is_linear());
        let turn = match (revolved, is_linear) {
            (false, _) => 0.0,
            (true, true) => 0.5 * HALF_WEDGE,
            (true, false) => HALF_WEDGE,
        };
        Self {
            weights: (places != rule.points).then(|| fitted(rule, places)),
            npoint: rule.npoint(),
            nplace: places.len(),
            angles: layers.iter().map(|zeta| turn * zeta.x).collect(),
        }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nplace * self.angles.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value at a place, from those at the points of the rule.
    pub fn scalar(&self, place: usize, value: impl Fn(usize) -> f64) -> f64 {
        self.sum(place, |point, weight| value(point) * weight)
    }

    /// The vector at a place in the axes of the model, from those at the points of the rule.
    pub fn vector(&self, place: usize, value: impl Fn(usize) -> Vec3) -> Vec3 {
        let vector = self.sum(place, |point, weight| value(point) * weight);
        match self.angles.get(place / self.nplace.max(1)).copied() {
            Some(angle) if angle != 0.0 => turn(angle) * vector,
            _ => vector,
        }
    }

    /// The tensor at a place in the axes of the model, from those at the points of the rule.
    pub fn tensor(&self, place: usize, value: impl Fn(usize) -> Sym3) -> Sym3 {
        let tensor = self.sum(place, |point, weight| value(point) * weight);
        let angle = self.angles.get(place / self.nplace.max(1)).copied();
        match angle {
            Some(angle) if angle != 0.0 => tensor.congruence(turn(angle)),
            _ => tensor,
        }
    }

    fn sum<T>(&self, place: usize, term: impl Fn(usize, f64) -> T) -> T
    where
        T: Default + std::ops::Add<Output = T>,
    {
        let place = place % self.nplace.max(1);
        let row = match &self.weights {
            None => return term(place, 1.0),
            Some(weights) => weights.chunks_exact(self.npoint).nth(place),
        };
        let terms = row.unwrap_or(&[]).iter().enumerate();
        terms.fold(T::default(), |sum, (point, w)| sum + term(point, *w))
    }
}

/// Where CalculiX prints of an element.
struct Printed {
    name: &'static str,
    /// Its places; none where they are the points of the rule.
    places: Option<Places>,
    layers: Layers,
}

#[derive(Clone, Copy)]
enum Places {
    Of(&'static Rule),
    /// Those of the first, once at each point of the second along the axis.
    Lifted(&'static Rule, &'static Rule),
}

#[derive(Clone, Copy)]
enum Layers {
    One,
    Four,
    Two,
    Three,
    /// As many as the rule has points along each direction.
    AsPoints,
}

const fn printed(name: &'static str, places: Option<Places>, layers: Layers) -> Printed {
    Printed {
        name,
        places,
        layers,
    }
}

/// Elements that are not in it are printed at the points of their rule.
static TABLE: [Printed; 9] = [
    printed("line2", Some(Places::Of(&LINE_2)), Layers::Four),
    printed("line3", Some(Places::Of(&LINE_2)), Layers::Four),
    printed("tri3", Some(Places::Of(&TRI_1)), Layers::Two),
    printed("tri6", Some(Places::Of(&TRI_3)), Layers::Three),
    printed("quad4", None, Layers::AsPoints),
    printed("quad8", None, Layers::AsPoints),
    printed("quad9", None, Layers::AsPoints),
    printed("tet10", Some(Places::Of(&TET_4)), Layers::One),
    printed("wedge6", Some(Places::Lifted(&TRI_1, &LINE_2)), Layers::One),
];

impl Printed {
    fn of(element: &str) -> Option<&'static Self> {
        TABLE.iter().find(|row| row.name == element)
    }
}

/// The places of elements whose own points differ, or may.
fn places(element: &str) -> Option<Vec<Vec3>> {
    Some(match Printed::of(element)?.places? {
        Places::Of(rule) => rule.points.to_vec(),
        Places::Lifted(base, axis) => {
            let lifted = |z: &Vec3| {
                let up = Vec3::unit(2) * z.x;
                base.points.iter().map(move |x| *x + up)
            };
            axis.points.iter().flat_map(lifted).collect()
        }
    })
}

/// Where the layers of an expanded element with so many points are, along `x`.
fn layers(element: &str, npoint: usize) -> &'static [Vec3] {
    const FOUR: [Vec3; 4] = [Vec3::ZERO; 4];
    let layers = Printed::of(element).map_or(Layers::One, |row| row.layers);
    match (layers, npoint) {
        (Layers::Three, _) | (Layers::AsPoints, 9) => LINE_3.points,
        (Layers::Two, _) | (Layers::AsPoints, 4) => LINE_2.points,
        (Layers::Four, _) => &FOUR,
        (Layers::One | Layers::AsPoints, _) => &FOUR[..1],
    }
}

/// The linear field that comes closest to values at the points of a rule, in the mean with its weights: a row for each
/// place. With `x̄` the mean and `S = Σ w (x − x̄)(x − x̄)ᵀ`, the weight of point `p` at `t` is
/// `w_p (1/Σw + (t − x̄)·S⁻¹ (x_p − x̄))`; that of the mean where the points do not span the element.
fn fitted(rule: &Rule, places: &[Vec3]) -> Vec<f64> {
    let total: f64 = rule.weights.iter().sum();
    let mean = rule.iter().map(|(x, w)| *x * w).sum::<Vec3>() / total;
    let mut spread = Mat3::ZERO;
    for (x, w) in rule.iter() {
        let d = *x - mean;
        for (row, d_row) in spread.rows.iter_mut().zip(d.to_array()) {
            *row += d * (w * d_row);
        }
    }
    // the directions that the element does not have
    for axis in 0..3 {
        if spread.rows[axis] == Vec3::ZERO {
            spread.rows[axis] = Vec3::unit(axis);
        }
    }
    let slope = spread.inverse().map_or(Mat3::ZERO, |(inverse, _)| inverse);
    let row = |place: &Vec3| {
        let lever = slope * (*place - mean);
        let weight = move |(x, w): (&Vec3, f64)| w * (total.recip() + lever.dot(*x - mean));
        rule.iter().map(weight).collect::<Vec<f64>>()
    };
    places.iter().flat_map(row).collect()
}

/// From a plane through the axis to the axes of the model.
fn turn(angle: f64) -> Mat3 {
    let (sin, cos) = angle.sin_cos();
    Mat3::from_rows([
        Vec3::new(cos, 0.0, -sin),
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(sin, 0.0, cos),
    ])
}
