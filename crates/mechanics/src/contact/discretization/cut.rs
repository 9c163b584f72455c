//! Points inside facets that are cut where facets of the other side end, at some positions of the nodes.

use rayon::prelude::*;
use signorini_geometry::element::{Element, MAX_FACET_NODES};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::overlap::{Facing, Flat, Pair, Plane, integrate};
use signorini_geometry::proximity::{Aabb, Bvh};
use signorini_geometry::surface::{ContactSurface, Facets};
use signorini_geometry::tensor::Vec3;

/// Points of a facet in its parameters, with their weights.
pub type FacetPoints = Vec<(Vec3, f64)>;

/// Points of a facet that is cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cut {
    /// Those of what it shares with facets of the other side.
    pub met: FacetPoints,
    /// Those of the rest.
    pub apart: FacetPoints,
}

/// Parts of a facet that are nothing compared with it.
const NOTHING: f64 = 1e-9;

/// Degrees that rules on parts of lines have more than shape functions need: on areas points are many anyway.
const OF_LINES: usize = 12;

/// Cuts facets where those of a primary side end.
pub struct Cutter {
    /// The primary side.
    pub primary: Facets,
    /// The points of a facet that is not cut.
    pub rule: Box<dyn Fn(Element) -> FacetPoints + Send + Sync>,
}

impl Cutter {
    /// The points of every secondary facet: those of rules on what it shares with facets of the primary side, as they
    /// lie at the positions `x`, and of the rule of whole facets those that lie on no such part.
    ///
    /// Facets meet along the normal of the secondary one. What is farther from it than both are large is not met. A
    /// facet that is folded, or whose outline is dented, has all points of the rule.
    #[must_use]
    pub fn points(&self, secondary: &Facets, x: &[Vec3]) -> Vec<Cut> {
        let place = |n: &NodeId| x.get(*n as usize).copied().unwrap_or_default();
        let places = |facets: &Facets, f| facets.nodes(f).iter().map(place).collect::<Vec<_>>();
        let primary = 0..self.primary.nfacet() as u32;
        let others: Vec<Option<Placed>> = primary
            .map(|f| Placed::new(self.primary.element(f)?, places(&self.primary, f)))
            .collect();
        let boxes = others.iter().map(|other| {
            let around = |o: &Placed| Aabb::around([o.middle]).inflated(o.radius);
            other.as_ref().map_or_else(|| Aabb::around([]), around)
        });
        let tree = Bvh::build(&boxes.collect::<Vec<_>>());
        let points = |f: u32| {
            let Some(element) = secondary.element(f) else {
                return Cut::default();
            };
            let regular = (self.rule)(element);
            let own = Placed::new(element, places(secondary, f));
            let cut = own.and_then(|own| {
                let mut near = Vec::new();
                tree.overlaps(&Aabb::around([own.middle]).inflated(own.radius), &mut near);
                near.sort_unstable();
                let near = near
                    .iter()
                    .filter_map(|&f| others.get(f as usize)?.as_ref());
                own.cut(near, &regular)
            });
            cut.unwrap_or_else(|| Cut {
                met: regular,
                apart: FacetPoints::new(),
            })
        };
        let facets = 0..secondary.nfacet() as u32;
        facets.into_par_iter().map(points).collect()
    }
}

/// A facet with the places of its nodes.
struct Placed {
    element: Element,
    x: Vec<Vec3>,
    middle: Vec3,
    radius: f64,
}

impl Placed {
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

    fn flat(&self, plane: &Plane<f64>, facing: Facing) -> Option<Flat> {
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
    fn cut<'a>(
        &self,
        others: impl Iterator<Item = &'a Self>,
        regular: &FacetPoints,
    ) -> Option<Cut> {
        let nodes: Vec<[f64; 3]> = self.x.iter().map(|x| x.to_array()).collect();
        let plane = Plane::of(self.element, &nodes)?;
        let own = self.flat(&plane, Facing::Same)?;
        let mut cut = Cut::default();
        // where contact ends within a part is known as well as its points are close
        let more = if self.element.dim() == 1 { OF_LINES } else { 0 };
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
                parts.push(cell.corners().collect());
                cell.points_around_centre(more, |[a, b], weight| {
                    dented |= weight < 0.0;
                    let xi = Vec3::new(a, b, 0.0);
                    cut.met.push((xi, weight / self.jacobian(&plane, xi)));
                    covered += weight;
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
            let apart = regular.iter().filter(|(xi, _)| !is_met(xi));
            cut.apart.extend(apart.copied());
        }
        Some(cut)
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
    use super::super::{
        Discretization, PointToSegment, Renewable, SlidingRange, SurfacePair, areas_inside,
    };
    use super::*;
    use signorini_geometry::element::by_name;
    use signorini_geometry::element::quadrature::{gauss, on_facet};
    use signorini_geometry::mesh::{Face, Mesh};
    use std::sync::Arc;

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
    fn areas(x: &[f64], y: &[f64]) -> (f64, Vec<Cut>) {
        let mut points = Vec::new();
        let secondary = facets(&[0.0, 1.0], &[0.0, 0.5, 1.0], 0.0, true, &mut points);
        let primary = facets(x, y, -0.01, false, &mut points);
        let cutter = Cutter {
            primary,
            rule: Box::new(rule),
        };
        let found = cutter.points(&secondary, &points);
        let sum = |f: usize| -> f64 {
            let of =
                |(xi, w): &(Vec3, f64)| w * secondary.sample(&points, f as u32, *xi).unwrap().1;
            let Cut { met, apart } = &found[f];
            met.iter().chain(apart).map(of).sum()
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
                assert!(facet.apart.is_empty());
                let cubic: f64 = facet.met.iter().map(|(xi, w)| w * xi.x * xi.x).sum();
                assert!((cubic - 4.0 / 3.0).abs() < 1e-12, "{cubic}");
            }
        }
        // as symmetric as the part
        let (_, found) = areas(&[0.0, 1.0], &[0.0, 1.0]);
        for (xi, _) in &found[0].met {
            let mirrored =
                |(other, _): &&(Vec3, f64)| (other.x + xi.x).hypot(other.y - xi.y) < 1e-12;
            assert_eq!(found[0].met.iter().filter(mirrored).count(), 1);
        }
        // an edge of the other side divides points: none of a part lies beyond it
        let (_, found) = areas(&[0.0, 0.25, 1.0], &[0.0, 1.0]);
        assert_eq!(found[0].met.len(), 48);
    }

    #[test]
    fn what_is_not_met_keeps_the_points_of_the_rule() {
        // a half is met: the points of the rule in the other half stay
        let (area, found) = areas(&[0.0, 0.5], &[0.0, 1.0]);
        assert!((area - 1.0).abs() < 1e-12, "{area}");
        let regular = rule(by_name("quad4").unwrap());
        assert_eq!(found[0].apart.len(), 8);
        assert!(found[0].apart.iter().all(|p| regular.contains(p)));
        // nothing is met, nearby or far above
        let (area, found) = areas(&[5.0, 6.0], &[0.0, 1.0]);
        assert!((area - 1.0).abs() < 1e-13);
        assert_eq!((found[0].met.len(), &found[0].apart), (0, &regular));
    }

    /// A unit square below which an edge of the other side moves, and goes on with the points nearby.
    #[test]
    fn points_are_made_anew_where_the_sides_have_moved() {
        let mut points = Vec::new();
        let secondary = facets(&[0.0, 1.0], &[0.0, 0.5, 1.0], 0.0, true, &mut points);
        let nsecondary = points.len();
        let primary = facets(&[-1.0, 0.25, 2.0], &[-1.0, 2.0], -0.01, false, &mut points);
        let surfaces = || {
            let mut pair = SurfacePair::new(secondary.all_nodes(), Arc::new(primary.clone()), 0.1);
            pair.secondary = Some(secondary.clone());
            let cutter = Cutter {
                primary: primary.clone(),
                rule: Box::new(rule),
            };
            let mut rows = PointToSegment::pieces(&secondary, cutter, &points);
            rows.sliding = SlidingRange::Increment;
            (pair, rows)
        };
        let (pair, mut rows) = surfaces();
        assert!(rows.capabilities().renewable.is_some_and(Renewable::renews));
        assert!(rows.renewable_mut().is_some());
        assert_eq!(rows.renew(&pair, &points), None);
        let before = rows.on_facets().unwrap().to_vec();
        let mut moved = points.clone();
        moved[nsecondary..].iter_mut().for_each(|x| x.x += 0.1);
        let origins = rows.renew(&pair, &moved).unwrap();
        let now = rows.on_facets().unwrap().to_vec();
        let areas = areas_inside(&secondary, &now, &moved, &|_, _, _| 1.0).unwrap();
        assert!((areas.iter().sum::<f64>() - 1.0).abs() < 1e-13);
        for (row, (point, origin)) in now.iter().zip(&origins).enumerate() {
            let origin = before[origin.unwrap() as usize];
            assert_eq!(point.facet, origin.facet);
            // of parts of 1/4 and 0.35 of a facet the points lie within 0.1 of each other
            assert!((point.xi - origin.xi).norm() <= 0.2 + 1e-12, "{row}");
            let place: f64 = rows.point(row).weights.iter().sum();
            assert!((place - 1.0).abs() < 1e-14);
        }
        let (_, mut other) = surfaces();
        let stored = rows.store();
        assert!(!stored.is_empty() && other.restore(&pair, &stored));
        assert_eq!(other.store(), stored);
        assert_eq!(other.on_facets().unwrap(), now);
        assert_eq!(other.renew(&pair, &moved), None);
        assert!(!other.restore(&pair, &[7.0; 6]) && !other.restore(&pair, &[0.0; 5]));
        // where planes are not held to an increment, neither are points
        rows.sliding = SlidingRange::Finite;
        assert_eq!(rows.renew(&pair, &points), None);
    }
}
