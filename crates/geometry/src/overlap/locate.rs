use super::flat::Flat;
use super::polygon::cross2;
use super::{Pair, Parameters};
use crate::element::MAX_FACET_NODES;
use crate::scalar::{Real, minus};
use crate::tensor::Vec3;

/// Steps of Newton's method: from the affine map it needs a handful.
const MAX_STEPS: usize = 30;

/// A step so small that the next one is below rounding.
const SMALL: f64 = 1e-9;

/// No step is longer: the reference domain is two wide at most, and a step across it means that the tangents are
/// nearly parallel.
const LONGEST: f64 = 1.0;

/// A bend that is all rounding: the map is affine.
const AFFINE: f64 = 4.0 * f64::EPSILON;

/// The parameters (E2) of a place on the plane; `None` where Newton's method finds none.
pub(super) fn parameters<T: Real>(flat: &Flat<T>, p: Pair<f64>) -> Option<Parameters> {
    let mut there = Map::new(flat);
    let mut xi = flat.affine(p);
    if flat.bend() > AFFINE {
        let step = |xi: &mut Pair<f64>| {
            there.evaluate(*xi);
            let [a, b] = there.solve(minus(there.place, p));
            let size = a.abs().max(b.abs());
            let cut = LONGEST / size.max(LONGEST);
            *xi = [xi[0] - a * cut, xi[1] - b * cut];
            size
        };
        let mut step = step;
        (0..MAX_STEPS).find(|_| step(&mut xi) <= SMALL)?;
    }
    there.evaluate(xi);
    let n = flat.element().nnode();
    let inverse = [there.solve([1.0, 0.0]), there.solve([0.0, 1.0])];
    let mut gradient = [[0.0; 2]; MAX_FACET_NODES];
    for (g, d) in gradient[..n].iter_mut().zip(&there.slopes) {
        *g = inverse.map(|xi| d.x * xi[0] + d.y * xi[1]);
    }
    Some(Parameters {
        xi,
        shape: there.shape,
        gradient,
    })
}

/// The map of a facet at some parameters.
struct Map<'a, T> {
    flat: &'a Flat<T>,
    shape: [f64; MAX_FACET_NODES],
    slopes: [Vec3; MAX_FACET_NODES],
    place: Pair<f64>,
    tangents: [Pair<f64>; 2],
}

impl<'a, T: Real> Map<'a, T> {
    fn new(flat: &'a Flat<T>) -> Self {
        Self {
            flat,
            shape: [0.0; MAX_FACET_NODES],
            slopes: [Vec3::ZERO; MAX_FACET_NODES],
            place: [0.0; 2],
            tangents: [[0.0; 2]; 2],
        }
    }

    fn evaluate(&mut self, [x, y]: Pair<f64>) {
        let (element, xi) = (self.flat.element(), Vec3::new(x, y, 0.0));
        let n = element.nnode();
        element.shape(&xi, &mut self.shape[..n]);
        element.dshape(&xi, &mut self.slopes[..n]);
        let mut sums = [[0.0; 2]; 3];
        let nodes = self.flat.values().iter().zip(&self.shape).zip(&self.slopes);
        for ((x, &n), d) in nodes.take(n) {
            for (sum, factor) in sums.iter_mut().zip([n, d.x, d.y]) {
                *sum = [sum[0] + factor * x[0], sum[1] + factor * x[1]];
            }
        }
        let [place, t1, t2] = sums;
        (self.place, self.tangents) = (place, [t1, t2]);
    }

    /// The change of parameters that makes a change of place.
    fn solve(&self, place: Pair<f64>) -> Pair<f64> {
        let [t1, t2] = self.tangents;
        if self.flat.dim() == 1 {
            return [place[0] / t1[0], 0.0];
        }
        let over = 1.0 / cross2(t1, t2);
        [cross2(place, t2) * over, cross2(t1, place) * over]
    }
}
