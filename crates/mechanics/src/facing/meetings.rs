//! Which parts of surfaces meet.
//!
//! The sides of contacts are regions: facets that go on into one another without an edge of 30 degrees. A side that went round
//! an edge would have nodes there that nothing can meet, and normals that are those of neither face. A body that meets itself
//! does so with two of its regions, or with one that faces itself, as in a fold.

use super::Facing;
use super::skin::Skin;
use signorini_geometry::surface::ContactSurface;
use signorini_geometry::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// cos 30°, of the angle between normals from which on an edge ends a region.
const SMOOTH: f64 = 0.866_025_403_784_438_6;

/// The regions of a skin, numbered in the order of their first facets.
#[derive(Clone, Debug, Default)]
pub struct Regions {
    /// The region of each facet.
    of: Vec<u32>,
    /// The facets of each region, sorted.
    facets: Vec<Vec<u32>>,
    /// Whether each facet is next to another one across a convex edge.
    ends: Vec<bool>,
}

/// Two regions whose facets face one another.
#[derive(Clone, Debug, PartialEq)]
pub struct Meeting {
    /// The regions, the lower number first; twice the same where one faces itself.
    pub regions: [u32; 2],
    /// The facets of each that face the other, sorted.
    pub live: [Vec<u32>; 2],
    /// The least and the largest distance of facets that face one another; negative where they overlap.
    pub gap: [f64; 2],
    /// Which of the two regions meets the other by an edge or a corner of its own; both do where edges cross, and none where
    /// facets are parallel to within 30 degrees where they are closest.
    pub sharp: [bool; 2],
}

impl Regions {
    /// Those of a skin whose nodes are at `x`. Facets of different `kind` are in different regions.
    #[must_use]
    pub fn new(skin: &Skin, x: &[Vec3], kind: impl Fn(u32) -> u32) -> Self {
        let n = skin.facets().nfacet();
        let middle: Vec<(Vec3, Vec3)> = (0..n as u32).map(|f| skin.middle(x, f)).collect();
        let middle = |facet: u32| middle.get(facet as usize).copied().unwrap_or_default();
        let normal = |facet: u32| middle(facet).1;
        let ends = (0..n as u32).map(|facet| {
            let (at, own) = middle(facet);
            skin.facets().neighbours(facet).iter().any(|&next| {
                let (there, other) = middle(next);
                own.dot(other) < SMOOTH && (other - own).dot(there - at) > 0.0
            })
        });
        let ends = ends.collect();
        let mut of = vec![u32::MAX; n];
        let mut facets: Vec<Vec<u32>> = Vec::new();
        for first in 0..n as u32 {
            if of.get(first as usize) != Some(&u32::MAX) {
                continue;
            }
            let number = facets.len() as u32;
            let (mut region, mut waiting) = (Vec::new(), vec![first]);
            while let Some(facet) = waiting.pop() {
                match of.get_mut(facet as usize) {
                    Some(to) if *to == u32::MAX => *to = number,
                    _ => continue,
                }
                region.push(facet);
                let near = skin.facets().neighbours(facet).iter().copied();
                waiting.extend(near.filter(|&next| {
                    kind(next) == kind(facet)
                        && normal(facet).dot(normal(next)) > SMOOTH
                        && skin.body().get(next as usize) == skin.body().get(facet as usize)
                }));
            }
            region.sort_unstable();
            facets.push(region);
        }
        Self { of, facets, ends }
    }

    /// The facets of a region, sorted.
    #[must_use]
    pub fn facets(&self, region: u32) -> &[u32] {
        self.facets.get(region as usize).map_or(&[], Vec::as_slice)
    }

    /// The region of a facet.
    #[must_use]
    pub fn of(&self, facet: u32) -> Option<u32> {
        self.of.get(facet as usize).copied()
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.facets.len()
    }

    /// Which regions meet by what faces each other, in the order of their numbers.
    #[must_use]
    pub fn meetings(&self, found: &[Facing]) -> Vec<Meeting> {
        let mut all: BTreeMap<[u32; 2], Opposed> = BTreeMap::new();
        for one in found {
            let (Some(a), Some(b)) = (self.of(one.facet), self.of(one.other)) else {
                continue;
            };
            let (regions, facets) = match a <= b {
                true => ([a, b], [one.facet, one.other]),
                false => ([b, a], [one.other, one.facet]),
            };
            let ends = facets.map(|f| self.ends.get(f as usize) == Some(&true));
            all.entry(regions).or_default().add((facets, ends), one);
        }
        let meeting = |(regions, met): ([u32; 2], Opposed)| Meeting {
            regions,
            live: met.live.map(|side| side.into_iter().collect()),
            gap: met.gap,
            sharp: match regions[0] != regions[1] && met.opposed < SMOOTH {
                true => met.ends,
                false => [false; 2],
            },
        };
        all.into_iter().map(meeting).collect()
    }
}

/// What faces each other of two regions.
struct Opposed {
    live: [BTreeSet<u32>; 2],
    gap: [f64; 2],
    /// Of those that are closest: how parallel they are, and whether each is at an edge.
    opposed: f64,
    ends: [bool; 2],
}

impl Default for Opposed {
    fn default() -> Self {
        Self {
            live: Default::default(),
            gap: [f64::INFINITY, f64::NEG_INFINITY],
            opposed: 0.0,
            ends: [false; 2],
        }
    }
}

impl Opposed {
    fn add(&mut self, (facets, ends): ([u32; 2], [bool; 2]), one: &Facing) {
        for (side, facet) in self.live.iter_mut().zip(facets) {
            side.insert(facet);
        }
        let [least, largest] = self.gap;
        if one.gap < least {
            (self.opposed, self.ends) = (one.opposed, ends);
        } else if one.gap == least {
            self.opposed = self.opposed.max(one.opposed);
            for (end, other) in self.ends.iter_mut().zip(ends) {
                *end |= other;
            }
        }
        self.gap = [least.min(one.gap), largest.max(one.gap)];
    }
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
/// the second.
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
    usize::from(b.bulge >= a.bulge - scale)
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
