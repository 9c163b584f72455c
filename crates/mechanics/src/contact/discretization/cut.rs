//! Points inside facets that are cut where facets of the other side end, at some positions of the nodes.

use signorini_geometry::element::Element;
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::overlap::{Facing, Flat, Pair, Plane, integrate};
use signorini_geometry::surface::{ContactSurface, Facets};
use signorini_geometry::tensor::Vec3;

/// Points of a facet in its parameters, with their weights.
pub type FacetPoints = Vec<(Vec3, f64)>;

/// Parts of a facet that are nothing beside it.
const NOTHING: f64 = 1e-9;

/// The points of every secondary facet: those of rules on what it shares with facets of the primary side, as they
/// lie at the positions `x`, and of `rule` those that lie on no such part.
///
/// Facets meet along the normal of the secondary one. What is farther from it than both are large is not met. A facet
/// that is folded, or whose outline is dented, has all points of `rule`.
pub fn cut(
    secondary: &Facets,
    primary: &Facets,
    x: &[Vec3],
    rule: impl Fn(Element) -> FacetPoints,
) -> Vec<FacetPoints> {
    let place = |n: &NodeId| x.get(*n as usize).copied().unwrap_or_default();
    let corners = |facets: &Facets, f: u32| facets.nodes(f).iter().map(place).collect::<Vec<_>>();
    let others: Vec<Other> = (0..primary.nfacet() as u32)
        .filter_map(|f| Other::new(primary.element(f)?, corners(primary, f)))
        .collect();
    (0..secondary.nfacet() as u32)
        .map(|f| {
            let Some(element) = secondary.element(f) else {
                return Vec::new();
            };
            let regular = rule(element);
            let own = Other::new(element, corners(secondary, f));
            own.and_then(|own| own.cut(&others, &regular))
                .unwrap_or(regular)
        })
        .collect()
}

/// A facet with the places of its nodes.
struct Other {
    element: Element,
    x: Vec<Vec3>,
    middle: Vec3,
    radius: f64,
}

impl Other {
    fn new(element: Element, x: Vec<Vec3>) -> Option<Self> {
        let middle = x.iter().copied().sum::<Vec3>() / x.len() as f64;
        let radius = x.iter().fold(0.0f64, |r, x| r.max((*x - middle).norm()));
        (x.len() == element.nnode() && x.len() <= MAX_FACET_NODES).then_some(Self {
            element,
            x,
            middle,
            radius,
        })
    }

    fn flat(&self, plane: &Plane<f64>, facing: Facing) -> Option<Flat<f64>> {
        let mut places = [[0.0; 2]; MAX_FACET_NODES];
        for (to, x) in places.iter_mut().zip(&self.x) {
            *to = plane.project(x.to_array());
            if self.element.dim() == 1 {
                to[1] = 0.0;
            }
        }
        Flat::new(self.element, places.get(..self.x.len())?, facing)
    }

    /// The points, or `None` where the regular ones have to do.
    fn cut(&self, others: &[Self], regular: &FacetPoints) -> Option<FacetPoints> {
        let nodes: Vec<[f64; 3]> = self.x.iter().map(|x| x.to_array()).collect();
        let plane = Plane::of(self.element, &nodes)?;
        let own = self.flat(&plane, Facing::Same)?;
        let mut points = FacetPoints::new();
        let mut parts: Vec<Vec<Pair<f64>>> = Vec::new();
        let mut covered = 0.0;
        for other in others {
            if (other.middle - self.middle).norm() > self.radius + other.radius {
                continue;
            }
            let Some(flat) = other.flat(&plane, Facing::Opposite) else {
                continue;
            };
            let mut dented = false;
            let met = integrate(&own, &flat, |cell| {
                parts.push(cell.corners().to_vec());
                cell.points(0, |point| {
                    dented |= point.weight < 0.0;
                    let [a, b] = point.secondary.xi;
                    let xi = Vec3::new(a, b, 0.0);
                    points.push((xi, point.weight / self.jacobian(&plane, xi)));
                    covered += point.weight;
                })
            });
            if met.is_err() || dented {
                return None;
            }
        }
        let whole: f64 = (regular.iter())
            .map(|(xi, weight)| weight * self.jacobian(&plane, *xi))
            .sum();
        if covered < (1.0 - NOTHING) * whole {
            let is_met = |xi: &Vec3| {
                let place = plane.project(self.at(*xi).to_array());
                parts.iter().any(|part| holds(part, place))
            };
            points.extend(regular.iter().filter(|(xi, _)| !is_met(xi)).copied());
        }
        Some(points)
    }

    fn at(&self, xi: Vec3) -> Vec3 {
        let mut shape = [0.0; MAX_FACET_NODES];
        if let Some(shape) = shape.get_mut(..self.x.len()) {
            self.element.shape(&xi, shape);
        }
        self.x.iter().zip(shape).map(|(x, n)| *x * n).sum()
    }

    /// The area of the plane, or the length of the line, for one of the parameters.
    fn jacobian(&self, plane: &Plane<f64>, xi: Vec3) -> f64 {
        let mut slopes = [Vec3::ZERO; MAX_FACET_NODES];
        if let Some(slopes) = slopes.get_mut(..self.x.len()) {
            self.element.dshape(&xi, slopes);
        }
        let along = |pick: fn(&Vec3) -> f64| -> Vec3 {
            self.x.iter().zip(&slopes).map(|(x, d)| *x * pick(d)).sum()
        };
        let first = along(|d| d.x);
        if self.element.dim() == 1 {
            return first.dot(Vec3::from(plane.axes[0])).abs();
        }
        first
            .cross(along(|d| d.y))
            .dot(Vec3::from(plane.normal))
            .abs()
    }
}

/// Whether a convex polygon, or an interval, holds a place.
fn holds(part: &[Pair<f64>], [x, y]: Pair<f64>) -> bool {
    if let [start, end] = part {
        return start[0] <= x && x <= end[0];
    }
    let next = part.iter().cycle().skip(1);
    part.iter()
        .zip(next)
        .all(|(a, b)| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element::by_name;
    use signorini_geometry::element::quadrature::{gauss, on_facet};
    use signorini_geometry::mesh::{Face, Mesh};

    /// The tops of bricks over the grid of `x` and `y`, whose tops are at `z`; bottoms where they face down.
    fn facets(x: &[f64], y: &[f64], z: f64, down: bool, points: &mut Vec<Vec3>) -> Facets {
        let mut mesh = Mesh {
            points: points.clone(),
            node_labels: (1..=points.len() as u64).collect(),
            ..Mesh::default()
        };
        let mut faces = Vec::new();
        let hex8 = by_name("hex8").unwrap();
        for (k, (x, y)) in (x.windows(2))
            .flat_map(|x| y.windows(2).map(move |y| (x, y)))
            .enumerate()
        {
            let first = mesh.points.len() as u32;
            for z in if down { [z, z + 1.0] } else { [z - 1.0, z] } {
                for (i, j) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                    mesh.points.push(Vec3::new(x[i], y[j], z));
                    mesh.node_labels.push(mesh.points.len() as u64);
                }
            }
            let nodes: [u32; 8] = std::array::from_fn(|i| first + i as u32);
            mesh.push_cell(hex8, &nodes, k as u64 + 1);
            let side = (0..6u8).find(|&side| {
                let cell = mesh.cells(3).last().unwrap();
                let of_side = mesh.face(Face { cell, side });
                let of_side = of_side.map(|(_, nodes)| nodes).unwrap_or_default();
                of_side.iter().all(|&n| mesh.points[n as usize].z == z)
            });
            let cell = mesh.cells(3).last().unwrap();
            let side = side.unwrap();
            faces.push(Face { cell, side });
        }
        *points = mesh.points.clone();
        Facets::new(&mesh, &faces).unwrap()
    }

    fn rule(element: Element) -> FacetPoints {
        on_facet(element, &gauss(4))
    }

    /// Secondary facets of a unit square, the area of what has points, and the points of each facet.
    fn areas(x: &[f64], y: &[f64]) -> (f64, Vec<FacetPoints>) {
        let mut points = Vec::new();
        let secondary = facets(&[0.0, 1.0], &[0.0, 0.5, 1.0], 0.0, true, &mut points);
        let primary = facets(x, y, -0.01, false, &mut points);
        let found = cut(&secondary, &primary, &points, rule);
        let sum = |f: usize| -> f64 {
            let of =
                |(xi, w): &(Vec3, f64)| w * secondary.sample(&points, f as u32, *xi).unwrap().1;
            found[f].iter().map(of).sum()
        };
        ((0..found.len()).map(sum).sum(), found)
    }

    #[test]
    fn what_both_sides_share_has_points_of_its_own() {
        // whole, and cut into parts that do not fit the facets
        for (x, y) in [
            (vec![0.0, 1.0], vec![0.0, 1.0]),
            (vec![-0.3, 0.2, 0.7, 1.9], vec![-1.0, 0.37, 1.2]),
        ] {
            let (area, found) = areas(&x, &y);
            assert!((area - 1.0).abs() < 1e-13, "{area}");
            let [first, second] = &found[..] else {
                panic!()
            };
            // of a cubic in the parameters: exact on every part
            for facet in [first, second] {
                let cubic: f64 = facet.iter().map(|(xi, w)| w * xi.x * xi.x).sum();
                assert!((cubic - 4.0 / 3.0).abs() < 1e-12, "{cubic}");
            }
        }
        // an edge of the other side divides points: none of a part lies beyond it
        let (_, found) = areas(&[0.0, 0.25, 1.0], &[0.0, 1.0]);
        assert_eq!(found[0].len(), 24);
    }

    #[test]
    fn what_is_not_met_keeps_the_points_of_the_rule() {
        // a half is met: the points of the rule in the other half stay
        let (area, found) = areas(&[0.0, 0.5], &[0.0, 1.0]);
        assert!((area - 1.0).abs() < 1e-12, "{area}");
        let stay = |points: &FacetPoints| {
            let regular = rule(by_name("quad4").unwrap());
            points.iter().filter(|p| regular.contains(p)).count()
        };
        assert_eq!(stay(&found[0]), 8);
        // nothing is met, nearby or far above
        let (area, found) = areas(&[5.0, 6.0], &[0.0, 1.0]);
        assert!((area - 1.0).abs() < 1e-13);
        assert_eq!((found[0].len(), stay(&found[0])), (16, 16));
    }
}
