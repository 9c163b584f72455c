//! Which primary facets a secondary facet is compared with: near ones, of one smooth part of the primary side.
//!
//! Functions of a dual basis are negative somewhere. A gap with a kink or a jump inside a secondary facet, as where it sees
//! both flanks of a groove, may have a negative weighted mean although it is positive everywhere. A facet therefore sees
//! one smooth part of the primary side at a time: facets that are connected, among those it meets, across edges that turn
//! by hardly more than 30 degrees ([`SMOOTH`]). The part is that of the facet with the largest
//!
//! ```text
//! s = c min(1, A/(A_e SHARE)) / (1 + |g|/h_e)                                               (E1)
//! ```
//!
//! over the cosine `c` by which it faces the secondary facet e of area `A_e` and size `h_e`, the area `A` that it covers and
//! the mean gap `g` there. The part seen before stays until another one is better by the factor [`STAYS`].

use super::edges::SMOOTH;
use signorini_geometry::surface::{
    Anchor, Carrier, ContactSurface, Placement, SurfaceError, SurfaceJet,
};
use signorini_geometry::tensor::Vec3;

/// The factor by which another side of an edge must face the primary side better for a node to change over to it.
pub(super) const STAYS: f64 = 2.0;

/// The covered part of a facet from which on its score (E1) no longer depends on the area.
const SHARE: f64 = 0.02;

/// No part of the primary side.
pub(super) const NO_PART: u32 = u32::MAX;

/// The smooth parts of a surface.
#[derive(Clone, Debug, Default)]
pub(super) struct SmoothParts {
    /// Facets that continue facet f: `continues[first[f]..first[f + 1]]`, sorted.
    first: Vec<usize>,
    continues: Vec<u32>,
    /// The part of each facet.
    part: Vec<u32>,
    /// The largest angle by which each facet turns against those that continue it, in radians.
    turning: Vec<f64>,
}

/// A primary facet that a secondary facet meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Its number.
    pub facet: u32,
    /// The cosine by which it faces the secondary facet.
    pub cosine: f64,
    /// The area that it covers.
    pub area: f64,
    /// The mean gap there.
    pub gap: f64,
}

impl SmoothParts {
    /// Those of a surface where it is at the start.
    ///
    /// # Errors
    /// A facet without a normal.
    pub fn of(surface: &dyn ContactSurface, x: &[Vec3]) -> Result<Self, SurfaceError> {
        let at = Placement { x, poses: &[] };
        let nfacet = surface.nfacet() as u32;
        let mut normals = Vec::new();
        let mut of_facet = vec![0];
        let mut jet = SurfaceJet::default();
        for facet in 0..nfacet {
            for &local in surface.domain(facet).map_or(&[][..], |e| e.nodes()) {
                surface.jet(&at, &Anchor { facet, local }, &mut jet)?;
                normals.push(jet.normal);
            }
            of_facet.push(normals.len());
        }
        let nodes = |facet: u32| match surface.carrier(facet) {
            Carrier::Nodes(nodes) => nodes,
            Carrier::Rigid(_) | Carrier::Fixed => &[],
        };
        let normal = |facet: u32, place: usize| {
            let first = of_facet.get(facet as usize).copied().unwrap_or_default();
            normals.get(first + place).copied().unwrap_or_default()
        };
        let smooth = |a: u32, b: u32| {
            nodes(a).iter().enumerate().any(|(k, node)| {
                let other = nodes(b).iter().position(|n| n == node);
                other.is_some_and(|l| normal(a, k).dot(normal(b, l)) >= SMOOTH)
            })
        };
        let mut parts = Self {
            first: vec![0],
            ..Self::default()
        };
        for facet in 0..nfacet {
            let around = surface.neighbours(facet).iter().copied();
            parts.continues.extend(around.filter(|&f| smooth(facet, f)));
            parts.first.push(parts.continues.len());
        }
        for facet in 0..nfacet {
            let mean = |facet: u32| {
                let all = (0..nodes(facet).len()).map(|k| normal(facet, k));
                all.sum::<Vec3>().normalized().unwrap_or_default()
            };
            let own = mean(facet);
            let angles = parts.continuing(facet).iter().map(|&f| {
                let other = mean(f);
                own.cross(other).norm().atan2(own.dot(other))
            });
            parts.turning.push(angles.fold(0.0, f64::max));
        }
        parts.number(nfacet);
        Ok(parts)
    }

    /// Numbers the parts in the order of their first facets.
    fn number(&mut self, nfacet: u32) {
        self.part = vec![NO_PART; nfacet as usize];
        let mut stack = Vec::new();
        for facet in 0..nfacet {
            if self.part_of(facet) != NO_PART {
                continue;
            }
            stack.push(facet);
            while let Some(next) = stack.pop() {
                match self.part.get_mut(next as usize) {
                    Some(part) if *part == NO_PART => *part = facet,
                    _ => continue,
                }
                stack.extend_from_slice(self.continuing(next));
            }
        }
    }

    /// The largest angle by which a facet turns against those that continue it, in radians.
    pub fn turning(&self, facet: u32) -> f64 {
        self.turning.get(facet as usize).copied().unwrap_or(0.0)
    }

    /// The part of a facet.
    pub fn part_of(&self, facet: u32) -> u32 {
        self.part.get(facet as usize).copied().unwrap_or(NO_PART)
    }

    fn continuing(&self, facet: u32) -> &[u32] {
        let f = facet as usize;
        match (self.first.get(f), self.first.get(f + 1)) {
            (Some(&a), Some(&b)) => self.continues.get(a..b).unwrap_or_default(),
            _ => &[],
        }
    }

    /// Leaves in `seen` the facets of one smooth part, (E1), and returns its number. `whole` is the area of the
    /// secondary facet, `size` its length, and `before` the part that it saw before.
    pub fn choose(
        &self,
        seen: &mut Vec<Seen>,
        (whole, size): (f64, f64),
        before: u32,
        work: &mut Vec<u32>,
    ) -> u32 {
        let score = |s: &Seen| {
            let share = (s.area / (whole * SHARE)).min(1.0);
            let stays = if self.part_of(s.facet) == before {
                STAYS
            } else {
                1.0
            };
            stays * s.cosine * share / (1.0 + s.gap.abs() / size)
        };
        let better =
            |a: &&Seen, b: &&Seen| score(a).total_cmp(&score(b)).then(b.facet.cmp(&a.facet));
        let Some(best) = seen.iter().max_by(better).map(|s| s.facet) else {
            return NO_PART;
        };
        let kept = work;
        kept.clear();
        kept.push(best);
        let mut next = 0;
        while let Some(&facet) = kept.get(next) {
            next += 1;
            for other in seen.iter().map(|s| s.facet) {
                let continues = self.continuing(facet).binary_search(&other).is_ok();
                if continues && !kept.contains(&other) {
                    kept.push(other);
                }
            }
        }
        seen.retain(|s| kept.contains(&s.facet));
        self.part_of(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::facets;
    use signorini_geometry::mesh::NodeId;
    use signorini_geometry::surface::Facets;

    /// A line through these corners.
    fn line(corners: &[[f64; 2]]) -> (Facets, Vec<Vec3>) {
        let mut x: Vec<Vec3> = corners.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect();
        let sides: Vec<Vec<NodeId>> = (1..x.len() as NodeId).map(|k| vec![k - 1, k]).collect();
        let facets = facets(&mut x, &sides);
        (facets, x)
    }

    fn seen(facet: u32, cosine: f64, gap: f64) -> Seen {
        Seen {
            facet,
            cosine,
            area: 0.5,
            gap,
        }
    }

    fn chosen(parts: &SmoothParts, from: &[Seen], before: u32) -> (Vec<u32>, u32) {
        let mut all = from.to_vec();
        let part = parts.choose(&mut all, (1.0, 1.0), before, &mut Vec::new());
        (all.iter().map(|s| s.facet).collect(), part)
    }

    #[test]
    fn a_polygon_of_twelve_sides_is_one_part_and_one_of_eleven_has_eleven() {
        for (corners, nparts) in [(12u32, 1), (11, 11)] {
            let angle = |k: u32| f64::from(k) * std::f64::consts::TAU / f64::from(corners);
            let place = |k: u32| Vec3::new(angle(k).cos(), angle(k).sin(), 0.0);
            let mut x: Vec<Vec3> = (0..corners).map(place).collect();
            let sides: Vec<_> = (0..corners).map(|k| vec![k, (k + 1) % corners]).collect();
            let facets = facets(&mut x, &sides);
            let parts = SmoothParts::of(&facets, &x).unwrap();
            let mut numbers: Vec<u32> = (0..corners).map(|f| parts.part_of(f)).collect();
            numbers.sort_unstable();
            numbers.dedup();
            assert_eq!(numbers.len(), nparts);
            let turning = std::f64::consts::TAU / f64::from(corners);
            let expected = if nparts == 1 { turning } else { 0.0 };
            assert!((parts.turning(3) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn of_two_flanks_one_is_seen_and_stays_until_the_other_is_twice_as_good() {
        let (facets, x) = line(&[[-2.0, 2.0], [-1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]);
        let parts = SmoothParts::of(&facets, &x).unwrap();
        let (left, right) = (parts.part_of(0), parts.part_of(2));
        assert!(parts.part_of(1) == left && parts.part_of(3) == right && left != right);
        let both = |cosine: f64, gap: f64| {
            [
                seen(1, 0.8, 0.0),
                seen(2, cosine, gap),
                seen(3, cosine, gap),
            ]
        };
        assert_eq!(
            chosen(&parts, &both(0.9, 0.0), NO_PART),
            (vec![2, 3], right)
        );
        assert_eq!(chosen(&parts, &both(0.9, 0.0), left), (vec![1], left));
        assert_eq!(chosen(&parts, &both(0.9, 9.0), right), (vec![1], left));
        assert_eq!(chosen(&parts, &[], right), (vec![], NO_PART));
    }

    #[test]
    fn flanks_that_a_fillet_joins_are_apart_where_the_fillet_is_not_met() {
        let fillet = (0..=4).map(|k| {
            let angle = std::f64::consts::FRAC_PI_4 * (0.5 * f64::from(k) - 1.0);
            [angle.sin(), std::f64::consts::SQRT_2 - angle.cos()]
        });
        let mut corners = vec![[-3.0, 3.0]];
        corners.extend(fillet);
        corners.push([3.0, 3.0]);
        let (facets, x) = line(&corners);
        let parts = SmoothParts::of(&facets, &x).unwrap();
        assert_eq!(parts.part_of(0), parts.part_of(5));
        let flanks = [seen(0, 0.7, 0.0), seen(5, 0.6, 0.0)];
        assert_eq!(chosen(&parts, &flanks, NO_PART).0, [0]);
        let all: Vec<Seen> = (0..6).map(|f| seen(f, 0.9, 0.0)).collect();
        assert_eq!(chosen(&parts, &all, NO_PART).0, [0, 1, 2, 3, 4, 5]);
    }
}
