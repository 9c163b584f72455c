use super::flat::Flat;
use super::pair::{Pair, Parameters};
use super::polygon::cross2;
use crate::element::{MAX_FACET_NODES, Quad4, ReferenceElement};
use crate::scalar::minus;
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

/// The parameters (E2) of a place on the plane, into `out`; `None` where Newton's method finds none.
pub(super) fn parameters(flat: &Flat, p: Pair<f64>, out: &mut Parameters) -> Option<()> {
    let (n, mut xi) = (flat.x().len(), flat.affine(p));
    let mut slopes = [Vec3::ZERO; MAX_FACET_NODES];
    if flat.bend() > AFFINE {
        let mut step = |xi: &mut Pair<f64>| {
            let there = Map::of(flat, *xi).unwrap_or_else(|| Map::new(flat, *xi, out, &mut slopes));
            let [a, b] = there.solve(minus(there.place, p));
            let size = a.abs().max(b.abs());
            let cut = LONGEST / size.max(LONGEST);
            *xi = [xi[0] - a * cut, xi[1] - b * cut];
            size
        };
        (0..MAX_STEPS).find(|_| step(&mut xi) <= SMALL)?;
    }
    out.xi = xi;
    let there = Map::new(flat, xi, out, &mut slopes);
    let inverse = [there.solve([1.0, 0.0]), there.solve([0.0, 1.0])];
    for (g, d) in out.gradient[..n].iter_mut().zip(&slopes) {
        *g = inverse.map(|xi| d.x * xi[0] + d.y * xi[1]);
    }
    Some(())
}

/// The map of a facet at some parameters.
struct Map {
    dim: usize,
    place: Pair<f64>,
    tangents: [Pair<f64>; 2],
}

impl Map {
    /// The map of a quadrilateral with four nodes; `None` of all others.
    fn of(flat: &Flat, xi: Pair<f64>) -> Option<Self> {
        let (place, tangents) = flat.bilinear(xi)?;
        Some(Self {
            dim: 2,
            place,
            tangents,
        })
    }

    /// The map there. Shape functions go to `out`, and their slopes.
    fn new(
        flat: &Flat,
        [x, y]: Pair<f64>,
        out: &mut Parameters,
        slopes: &mut [Vec3; MAX_FACET_NODES],
    ) -> Self {
        let (n, xi) = (flat.x().len(), Vec3::new(x, y, 0.0));
        if let Some(map) = Self::of(flat, [x, y]) {
            Quad4.shape(&xi, &mut out.shape[..4]);
            Quad4.dshape(&xi, &mut slopes[..4]);
            return map;
        }
        flat.element().shape(&xi, &mut out.shape[..n]);
        flat.element().dshape(&xi, &mut slopes[..n]);
        let mut sums = [[0.0; 2]; 3];
        for ((x, &n), d) in flat.x().iter().zip(&out.shape).zip(slopes) {
            for (sum, factor) in sums.iter_mut().zip([n, d.x, d.y]) {
                *sum = [sum[0] + factor * x[0], sum[1] + factor * x[1]];
            }
        }
        let [place, t1, t2] = sums;
        Self {
            dim: flat.dim(),
            place,
            tangents: [t1, t2],
        }
    }

    /// The change of parameters that makes a change of place.
    fn solve(&self, place: Pair<f64>) -> Pair<f64> {
        let [t1, t2] = self.tangents;
        if self.dim == 1 {
            return [place[0] / t1[0], 0.0];
        }
        let over = 1.0 / cross2(t1, t2);
        [cross2(place, t2) * over, cross2(t1, place) * over]
    }
}
