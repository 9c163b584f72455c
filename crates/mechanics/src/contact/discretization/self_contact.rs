//! The facets that a point may meet on the same surface, or on another of the same body: see the equations of
//! [`OwnBody`](super::OwnBody) and [`Wall`](super::Wall).

use super::own::{ENTERED, OwnNow, OwnPoint};
use super::{OnFacet, SurfacePair};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Carrier, Placement};
use signorini_geometry::tensor::Vec3;

impl SurfacePair {
    /// Whether a facet of a surface that may touch itself is next to the point of a row, and never meets it: it shares a
    /// node with the point, or with the facets that the point is in the middle of.
    #[must_use]
    pub fn is_next_to(&self, nodes: &[NodeId], facet: u32) -> bool {
        let of = |facet: u32| match self.primary.carrier(facet) {
            Carrier::Nodes(nodes) => nodes,
            Carrier::Rigid(_) | Carrier::Fixed => &[],
        };
        let others = of(facet);
        let meets = |nodes: &[NodeId]| nodes.iter().any(|n| others.contains(n));
        let around = || {
            let (own, [node]) = (self.own.as_ref()?, nodes) else {
                return None;
            };
            let place = self.points.binary_search(node).ok()?;
            let middle = own.middle.get(place).copied()?;
            middle.then(|| own.facets_of(Some(place), None))
        };
        meets(nodes) || around().unwrap_or(&[]).iter().any(|&f| meets(of(f)))
    }

    /// The point of a row of a surface that may touch itself, among the normals and thickness that facets have `now`.
    #[must_use]
    pub fn own_point<'a>(
        &'a self,
        nodes: &[NodeId],
        inside: Option<&'a OnFacet>,
        now: &'a OwnNow,
    ) -> Option<OwnPoint<'a>> {
        let own = self.own.as_ref()?;
        let place = nodes
            .first()
            .and_then(|n| self.points.binary_search(n).ok());
        let around = own.facets_of(place, inside);
        let mut point = OwnPoint {
            normal: Vec3::ZERO,
            thickness: f64::INFINITY,
            around,
            body: own,
            of: now,
        };
        for &facet in around {
            point.normal += now.normal(facet);
            point.thickness = point.thickness.min(now.thickness(facet));
        }
        point.normal = point.normal.normalized().unwrap_or_default();
        Some(point)
    }

    /// How deep the point of a row may enter the facet that it meets (E2); infinite where a surface meets another body.
    #[must_use]
    pub fn deepest(
        &self,
        nodes: &[NodeId],
        inside: Option<&OnFacet>,
        facet: u32,
        at: &Placement,
    ) -> f64 {
        let Some(own) = &self.own else {
            return self.deepest_from(nodes, inside, facet, at);
        };
        let place = nodes
            .first()
            .and_then(|n| self.points.binary_search(n).ok());
        let around = own.facets_of(place, inside).iter().copied();
        let thickness = around.chain([facet]).map(|f| {
            let behind = own.behind.get(f as usize).copied().flatten();
            own.of_facet(self.primary.as_ref(), at, f, behind).0
        });
        ENTERED * thickness.fold(f64::INFINITY, f64::min)
    }

    /// How deep a facet of the secondary side and one of the primary side may be inside each other, by half the thickness of the [`Wall`](super::Wall) between them; infinite where they
    /// are of different bodies.
    #[must_use]
    pub fn deepest_between(&self, secondary: u32, primary: u32, at: &Placement) -> f64 {
        let (Some(wall), Some(facets)) = (&self.wall, &self.secondary) else {
            return f64::INFINITY;
        };
        let [own, other] =
            wall.thicknesses([facets, self.primary.as_ref()], [secondary, primary], at);
        ENTERED * own.min(other)
    }

    /// The same of the point of a row: one inside a facet, or a node, for which the thinnest of the facets around it counts.
    #[must_use]
    pub fn deepest_from(
        &self,
        nodes: &[NodeId],
        inside: Option<&OnFacet>,
        primary: u32,
        at: &Placement,
    ) -> f64 {
        let Some(wall) = &self.wall else {
            return f64::INFINITY;
        };
        let [around, _] = &wall.around;
        let facets = match (inside, nodes) {
            (Some(point), _) => std::slice::from_ref(&point.facet),
            (None, [node, ..]) => around.of(*node),
            (None, []) => &[],
        };
        let depths = facets
            .iter()
            .map(|&facet| self.deepest_between(facet, primary, at));
        depths.fold(f64::INFINITY, f64::min)
    }

    /// The same of a node of the primary side.
    #[must_use]
    pub fn deepest_back(&self, node: NodeId, secondary: u32, at: &Placement) -> f64 {
        let Some(wall) = &self.wall else {
            return f64::INFINITY;
        };
        let [_, around] = &wall.around;
        let facets = around.of(node).iter();
        let depths = facets.map(|&facet| self.deepest_between(secondary, facet, at));
        depths.fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::closest_points;
    use crate::contact::discretization::{Discretization, Mortar, PointToSegment, Wall};
    use crate::contact::mortar::Measure;
    use crate::contact::tests::facets;
    use signorini_geometry::element::quadrature;
    use signorini_geometry::surface::ContactSurface;
    use std::sync::Arc;

    /// Facets along each direction of a layer.
    const N: usize = 3;
    const THICKNESS: f64 = 0.2;
    const GAP: f64 = 0.05;

    /// A face of a layer at a height, its facets larger than the layer is thick; in the plane, or in space.
    fn face(x: &mut Vec<Vec3>, height: f64, faces_up: bool, in_space: bool) -> Vec<Vec<NodeId>> {
        let first = x.len() as NodeId;
        let line = (N + 1) as NodeId;
        let side = |k: usize| 0.5 * k as f64;
        let mut nodes: Vec<Vec<NodeId>> = Vec::new();
        if in_space {
            let all = (0..=N).flat_map(|j| (0..=N).map(move |i| (i, j)));
            x.extend(all.map(|(i, j)| Vec3::new(side(i), side(j), height)));
            for j in 0..N as NodeId {
                for i in 0..N as NodeId {
                    let a = first + j * line + i;
                    nodes.push(vec![a, a + 1, a + line + 1, a + line]);
                }
            }
        } else {
            x.extend((0..=N).map(|i| Vec3::new(side(i), height, 0.0)));
            nodes.extend((first..first + N as NodeId).map(|a| vec![a + 1, a]));
        }
        if !faces_up {
            nodes.iter_mut().for_each(|facet| facet.reverse());
        }
        nodes
    }

    /// Two layers of one body, one above the other by a gap: their upper faces against their lower ones. The gaps of the rows on
    /// the lower and on the upper layer.
    fn layers(
        (in_space, gap): (bool, f64),
        swapped: bool,
        has_wall: bool,
        kind: usize,
    ) -> [Vec<Option<f64>>; 2] {
        let mut x = Vec::new();
        let mut sides = [Vec::new(), Vec::new()];
        for low in [0.0, THICKNESS + gap] {
            sides[0].extend(face(&mut x, low + THICKNESS, true, in_space));
            sides[1].extend(face(&mut x, low, false, in_space));
        }
        if swapped {
            sides.reverse();
        }
        let mut outer = (x.clone(), sides.concat());
        let [secondary, primary] = sides.map(|side| facets(&mut x, &side));
        let at = Placement { x: &x, poses: &[] };
        let bodies = [&secondary, &primary].map(|side| vec![0; side.nfacet()]);
        let [of_secondary, of_primary] = &bodies;
        let skin = facets(&mut outer.0, &outer.1);
        let of_skin = vec![0; skin.nfacet()];
        let sides = [(&secondary, &**of_secondary), (&primary, &**of_primary)];
        let wall = Wall::behind(sides, (skin, &of_skin), &at);
        let rows: Box<dyn Discretization> = match kind {
            0 => Box::new(PointToSegment::at_nodes(&secondary.all_nodes())),
            1 => {
                let gauss = quadrature::gauss(2);
                let on_facet = move |e| quadrature::on_facet(e, &gauss);
                Box::new(PointToSegment::inside(&secondary, on_facet))
            }
            _ => {
                let form = Default::default();
                let new = Mortar::new(&secondary, &primary, form, Measure::Flat, &x);
                Box::new(new.unwrap())
            }
        };
        let pair = SurfacePair {
            secondary: Some(secondary.clone()),
            wall: has_wall.then_some(wall),
            ..SurfacePair::new(secondary.all_nodes(), Arc::new(primary), 1.0)
        };
        let found = closest_points(rows.as_ref(), &pair, &at).unwrap();
        let mut of_layers = [Vec::new(), Vec::new()];
        for (row, found) in found.pairs.iter().enumerate() {
            let place = x[rows.point(row).nodes[0] as usize];
            let height = if in_space { place.z } else { place.y };
            let is_upper = match swapped {
                false => height > 1.5 * THICKNESS,
                true => height > 0.5 * THICKNESS,
            };
            of_layers[usize::from(is_upper)].push(found.map(|p| p.gap));
        }
        of_layers
    }

    #[test]
    fn layers_of_one_body_meet_each_other_and_not_their_own_other_face() {
        for kind in 0..3 {
            for (in_space, swapped) in [(false, false), (false, true), (true, false), (true, true)]
            {
                // apart, all but touching, and overlapping
                for gap in [GAP, 1e-9, -0.25 * THICKNESS] {
                    let place = format!("{kind} {in_space} {swapped} {gap}");
                    let gaps = layers((in_space, gap), swapped, true, kind);
                    let [meets, meets_nothing] = match swapped {
                        false => [&gaps[0], &gaps[1]],
                        true => [&gaps[1], &gaps[0]],
                    };
                    assert!(!meets.is_empty() && !meets_nothing.is_empty());
                    for found in meets {
                        let found = found.unwrap_or_else(|| panic!("{place}: nothing is met"));
                        assert!((found - gap).abs() < 1e-12, "{place}: {found}");
                    }
                    let nothing = meets_nothing.iter().all(Option::is_none);
                    assert!(nothing, "{place}: {gaps:?}");
                    let blind = layers((in_space, gap), swapped, false, kind);
                    let all = blind.iter().flatten().flatten();
                    let deepest = all.fold(0.0, |least: f64, gap| least.min(*gap));
                    assert!(deepest < -0.5 * THICKNESS, "{place}: {blind:?}");
                }
            }
        }
    }
}
