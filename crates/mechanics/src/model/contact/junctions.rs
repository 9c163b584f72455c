//! Places where three bodies meet.
//!
//! With friction a row holds its node to the other side along all directions. Where each of three bodies touches
//! the other two, three such rows hold three nodes at one place to one another, and one follows from the other two: forces
//! that go round from body to body would have any value. There a node that has rows in two of the contacts keeps that of
//! the first; where each body is secondary once, the row in the last contact goes. Its function goes to the nodes next to
//! it, so that even tractions stay exact.
//!
//! Source: Wohlmuth, *SIAM J. Numer. Anal.* 38 (2000) 989–1012 (multipliers at cross points).

use super::Sides;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Bodies, ContactSurface, Facets, Placement};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeSet;

/// The distance of nodes over the size of facets up to which they are at one place.
const AT_ONE_PLACE: f64 = 0.1;

/// A contact whose rows hold nodes along all directions.
struct Holding<'a> {
    /// Its place in the list of sides.
    number: usize,
    points: &'a [NodeId],
    bodies: [BTreeSet<u32>; 2],
    /// The nodes of its primary side.
    others: Vec<NodeId>,
    /// The size of its largest facet.
    size: f64,
}

/// The nodes whose rows in a contact yield to those in another, with the place of that contact among these sides;
/// `holds` says of which of these a row holds along all directions.
pub(in crate::model) fn yields(
    bodies: &Bodies,
    x: &[Vec3],
    sides: &[&Sides],
    holds: &dyn Fn(&Sides) -> bool,
) -> Vec<(usize, BTreeSet<NodeId>)> {
    let holding = sides.iter().enumerate().filter(|(_, one)| {
        let is_mean = one.discretization.capabilities().averaged.is_some();
        is_mean && one.law.multiplier().is_unknown() && holds(one)
    });
    let holding: Vec<(usize, &Sides)> = holding.map(|(number, one)| (number, *one)).collect();
    if holding.len() < 3 {
        return Vec::new();
    }
    let of = |facets: &Facets| bodies.behind(facets).into_iter().collect::<BTreeSet<u32>>();
    let at = Placement { x, poses: &[] };
    let size = |facets: &Facets| {
        let sizes = (0..facets.nfacet() as u32).map(|facet| facets.size(&at, facet));
        sizes.fold(0.0, f64::max)
    };
    let holding: Vec<Holding<'_>> = holding
        .into_iter()
        .filter_map(|(number, one)| {
            let (primary, secondary) = (one.facets.as_ref()?, one.secondary()?);
            Some(Holding {
                number,
                points: &one.pair.points,
                bodies: [of(secondary), of(primary)],
                others: primary.all_nodes(),
                size: size(primary).max(size(secondary)),
            })
        })
        .collect();
    let mut found = Vec::new();
    for (at, second) in holding.iter().enumerate() {
        let mut nodes = BTreeSet::new();
        for first in holding.iter().take(at) {
            let is_in_both = |node: &&NodeId| first.points.binary_search(node).is_ok();
            let common: Vec<NodeId> = second.points.iter().filter(is_in_both).copied().collect();
            if common.is_empty() {
                continue;
            }
            let closes = |third: &&Holding<'_>| third.joins(&first.bodies[1], &second.bodies[1]);
            for third in holding.iter().filter(closes) {
                let near = common.iter().copied();
                nodes.extend(near.filter(|&node| third.reaches(node, x)));
            }
        }
        let earlier = holding.get(..at).unwrap_or_default();
        for (k, first) in earlier.iter().enumerate() {
            let between = earlier.iter().skip(k + 1);
            for other in between.filter(|other| go_round([first, other, second])) {
                let meets = |node: &&NodeId| first.has_at(**node, x) && other.has_at(**node, x);
                nodes.extend(second.points.iter().filter(meets));
            }
        }
        if !nodes.is_empty() {
            found.push((second.number, nodes));
        }
    }
    found
}

/// Whether each of three bodies is secondary to one of the other two: then no node has rows in two of the contacts.
fn go_round([a, b, c]: [&Holding<'_>; 3]) -> bool {
    let follows = |one: &Holding<'_>, other: &Holding<'_>| {
        let ([secondary, _], [_, primary]) = (&one.bodies, &other.bodies);
        !secondary.is_disjoint(primary)
    };
    (follows(a, b) && follows(b, c) && follows(c, a))
        || (follows(a, c) && follows(c, b) && follows(b, a))
}

impl Holding<'_> {
    /// Whether its sides are of these bodies.
    fn joins(&self, one: &BTreeSet<u32>, other: &BTreeSet<u32>) -> bool {
        let [a, b] = &self.bodies;
        let meets = |a: &BTreeSet<u32>, b: &BTreeSet<u32>| !a.is_disjoint(b);
        a != b && (meets(a, one) && meets(b, other) || meets(a, other) && meets(b, one))
    }

    /// Whether a node of its secondary side is at the place of a node.
    fn has_at(&self, node: NodeId, x: &[Vec3]) -> bool {
        self.are_at(node, x, self.points.iter())
    }

    /// Whether a node of either side is at the place of a node.
    fn reaches(&self, node: NodeId, x: &[Vec3]) -> bool {
        self.are_at(node, x, self.points.iter().chain(&self.others))
    }

    /// Whether one of these nodes is at the place of a node, but for a part of the size of a facet.
    fn are_at<'n>(
        &self,
        node: NodeId,
        x: &[Vec3],
        mut of: impl Iterator<Item = &'n NodeId>,
    ) -> bool {
        let place = |node: NodeId| x.get(node as usize).copied().unwrap_or_default();
        let own = place(node);
        of.any(|other| (place(*other) - own).norm() <= AT_ONE_PLACE * self.size)
    }
}
