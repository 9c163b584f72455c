//! Which bodies meet, and with which parts of their surfaces.
//!
//! The facets of two bodies that face one another, and those next to them, are the sides of a meeting. Edges of the bodies end
//! them: a side does not go round an edge of 30 degrees to facets that face nothing, whose nodes could be met by nothing
//! and whose normals would tilt those at the edge.
//!
//! A body may meet itself. What faces one another then are parts of its surface, connected by shared nodes. Two parts
//! without common nodes are the two sides of a meeting. Where one part faces itself, as in a fold, both sides are
//! that part, and each of its points may be met by every other.

use super::Facing;
use super::skin::Skin;
use signorini_geometry::surface::ContactSurface;
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// cos 30°, of the angle between normals from which on an edge ends a side.
const SMOOTH: f64 = 0.866_025_403_784_438_6;

/// Two bodies, or parts of one, whose facets face one another.
#[derive(Clone, Debug, PartialEq)]
pub struct Meeting {
    /// The bodies, the lower number first; twice the same where a body meets itself.
    pub bodies: [u32; 2],
    /// The facets of each that face the other, sorted.
    pub live: [Vec<u32>; 2],
    /// These and the smooth ring around them, sorted.
    pub sides: [Vec<u32>; 2],
    /// The least and the largest distance of facets that face one another; negative where they overlap.
    pub gap: [f64; 2],
    /// Whether both sides are one part of one body.
    pub is_fold: bool,
}

/// A part of the surface of a body: the body, and the number of the part where the body meets itself.
type Part = (u32, u32);

/// What faces each other of two parts.
struct Opposed {
    live: [BTreeSet<u32>; 2],
    gap: [f64; 2],
}

/// What faces each other, in the order of the bodies and of their facets, where nodes are at `x`.
#[must_use]
pub fn meetings(skin: &Skin, x: &[Vec3], found: &[Facing]) -> Vec<Meeting> {
    let own = parts_that_meet_their_body(skin, found);
    let body = |facet: u32| skin.body().get(facet as usize).copied().unwrap_or(u32::MAX);
    let part = |facet: u32, is_own: bool| -> Part {
        let of_own = own.get(&facet).copied().filter(|_| is_own);
        (body(facet), of_own.unwrap_or(0))
    };
    let mut all: BTreeMap<[Part; 2], Opposed> = BTreeMap::new();
    for one in found {
        let is_own = body(one.facet) == body(one.other);
        let (a, b) = (part(one.facet, is_own), part(one.other, is_own));
        let (parts, facets) = match a <= b {
            true => ([a, b], [one.facet, one.other]),
            false => ([b, a], [one.other, one.facet]),
        };
        let opposed = all.entry(parts).or_insert_with(|| Opposed {
            live: Default::default(),
            gap: [f64::INFINITY, f64::NEG_INFINITY],
        });
        for (side, facet) in opposed.live.iter_mut().zip(facets) {
            side.insert(facet);
        }
        let [least, largest] = opposed.gap;
        opposed.gap = [least.min(one.gap), largest.max(one.gap)];
    }
    let all = all.into_iter();
    all.map(|(parts, opposed)| opposed.meeting(skin, x, parts))
        .collect()
}

impl Opposed {
    fn meeting(self, skin: &Skin, x: &[Vec3], [a, b]: [Part; 2]) -> Meeting {
        let is_fold = a == b;
        let mut live = self.live;
        if is_fold {
            let [first, second] = &live;
            let both: BTreeSet<u32> = first.union(second).copied().collect();
            live = [both.clone(), both];
        }
        let [first, second] = &live;
        let opposite = |other| (!is_fold).then_some(other);
        let sides = [
            with_ring(skin, x, first, opposite(second)),
            with_ring(skin, x, second, opposite(first)),
        ];
        Meeting {
            bodies: [a.0, b.0],
            live: live.map(|side| side.into_iter().collect()),
            sides,
            gap: self.gap,
            is_fold,
        }
    }
}

/// Of the facets that face their own body, the number of the connected part that each is in.
fn parts_that_meet_their_body(skin: &Skin, found: &[Facing]) -> BTreeMap<u32, u32> {
    let body = |facet: u32| skin.body().get(facet as usize);
    let own = found
        .iter()
        .filter(|one| body(one.facet) == body(one.other));
    let live: BTreeSet<u32> = own.flat_map(|one| [one.facet, one.other]).collect();
    let mut part: BTreeMap<u32, u32> = BTreeMap::new();
    let mut count = 0;
    for &first in &live {
        if part.contains_key(&first) {
            continue;
        }
        let mut waiting = vec![first];
        part.insert(first, count);
        while let Some(facet) = waiting.pop() {
            for &next in skin.facets().neighbours(facet) {
                if live.contains(&next) && !part.contains_key(&next) {
                    part.insert(next, count);
                    waiting.push(next);
                }
            }
        }
        count += 1;
    }
    part
}

/// Facets and those next to them that go on without an edge and are not on the other side.
fn with_ring(
    skin: &Skin,
    x: &[Vec3],
    live: &BTreeSet<u32>,
    other: Option<&BTreeSet<u32>>,
) -> Vec<u32> {
    let normal = |facet: u32| skin.middle(x, facet).1;
    let mut side = live.clone();
    for &facet in live {
        let near = skin.facets().neighbours(facet).iter().copied();
        side.extend(near.filter(|&next| {
            let is_opposite = other.is_some_and(|other| other.contains(&next));
            !is_opposite && normal(facet).dot(normal(next)) > SMOOTH
        }));
    }
    side.into_iter().collect()
}

/// What decides which side of a meeting is the secondary one, whose nodes may not enter the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Whether it cannot follow: it is rigid, or its motion is prescribed.
    pub is_led: bool,
    /// The size of its facets, in the mean.
    pub size: f64,
    /// The stiffness of what is behind it.
    pub modulus: f64,
    /// How convex it is: the mean of the turn of normals over the distance of facets next to one another; negative where
    /// it is hollow.
    pub bulge: f64,
}

/// Sizes whose ratio is nearer to one than this are alike.
const ALIKE: f64 = 0.95;

/// The secondary side of two: what is led is primary; then the finer is secondary, then the softer, then the more convex, then
/// the first.
#[must_use]
pub fn secondary(of: [Standing; 2]) -> usize {
    let [a, b] = of;
    if a.is_led != b.is_led {
        return usize::from(a.is_led);
    }
    let differ = |p: f64, q: f64| p.min(q) < ALIKE * p.max(q);
    if differ(a.size, b.size) {
        return usize::from(b.size < a.size);
    }
    if differ(a.modulus, b.modulus) {
        return usize::from(b.modulus < a.modulus);
    }
    let scale = 1e-6 / a.size.max(b.size);
    usize::from(b.bulge > a.bulge + scale)
}

impl Skin {
    /// The standing of some facets, where nodes are at `x`; which of them are led and how stiff they are is known elsewhere.
    #[must_use]
    pub fn standing(&self, x: &[Vec3], side: &[u32], is_led: bool, modulus: f64) -> Standing {
        let sizes = side.iter().filter_map(|&f| self.size().get(f as usize));
        let size = sizes.sum::<f64>() / side.len().max(1) as f64;
        let (mut turn, mut way) = (0.0, 0.0);
        for &facet in side {
            let (at, normal) = self.middle(x, facet);
            for &next in self.facets().neighbours(facet) {
                if side.binary_search(&next).is_ok() {
                    let (there, other) = self.middle(x, next);
                    let to = there - at;
                    turn += (other - normal).dot(to) / to.norm().max(f64::MIN_POSITIVE);
                    way += to.norm();
                }
            }
        }
        Standing {
            is_led,
            size,
            modulus,
            bulge: if way > 0.0 { turn / way } else { 0.0 },
        }
    }
}
