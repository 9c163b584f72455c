//! The integrals of secondary facets, and derivatives that are kept for as long as rows may need them.

use super::facets::nodes_of;
use super::sight::{Seen, SmoothParts};
use crate::contact::discretization::{BentSides, SurfacePair};
use crate::contact::mortar::{
    Basis, Covered, Derivatives, Facet, Measure, MortarError, OfFacet, Weights, rises,
};
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{Anchor, ContactSurface, Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The most numbers to keep, 32 MB: the derivatives of 3000 four-node quadrilaterals that meet nine others each.
const NUMBERS: usize = 1 << 22;

/// The fewest facets to keep for each thread: two lines of a surface of 30 by 30 facets.
const LEAST: usize = 64;

/// How far integrals of a facet are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Values.
    Values,
    /// And derivatives.
    Derivatives,
    /// And those of the mean normal of the covering facets.
    Turning,
}

impl Wanted {
    /// Derivatives of a facet.
    pub fn derivatives(turning: bool) -> Self {
        match turning {
            true => Self::Turning,
            false => Self::Derivatives,
        }
    }
}

/// The integrals of one facet, with the memory they take.
#[derive(Default)]
pub(super) struct Integrator {
    pub covered: Covered,
    /// The primary facets that it is integrated against.
    pub near: Vec<u32>,
    pub own: Vec<Vec3>,
    others: Vec<Vec3>,
    /// The nodes of these, one facet after the other.
    nodes: Vec<NodeId>,
    seen: Vec<Seen>,
    /// Scratch: some of `near`.
    some: Vec<u32>,
}

impl Integrator {
    pub fn new(measure: Measure, basis: Basis) -> Self {
        let mut new = Self::default();
        new.covered.measured(measure, basis);
        new
    }

    pub fn place(&mut self, facets: &Facets, facet: u32, x: &[Vec3]) {
        self.own.clear();
        positions(facets.nodes(facet), x, &mut self.own);
    }

    /// The primary facets that are near a secondary one, in the order of their numbers: within the reach between the two, or,
    /// where there are none, within that of the pair, so that a body that goes a long way to its contact is seen coming.
    pub fn find(
        &mut self,
        facets: &Facets,
        facet: u32,
        pair: &SurfacePair,
        at: &Placement,
        search: &Search,
    ) {
        let own = facets.aabb(at, facet);
        // the tree may be as old as the search allows
        search
            .bvh()
            .overlaps(&own.inflated(search.range()), &mut self.near);
        let nodes = facets.nodes(facet);
        let is_within =
            |other: u32, reach: f64| pair.primary.aabb(at, other).overlaps(&own.inflated(reach));
        self.near.retain(|&other| {
            let touches = |f: u32| nodes_of(pair, f).iter().any(|n| nodes.contains(n));
            is_within(other, pair.reach) && !(pair.same && touches(other))
        });
        if pair.sizes.primary.is_empty() {
            return;
        }
        let is_close = |other: &u32| is_within(*other, pair.reach_between(facet, *other, at));
        self.some.clear();
        self.some.extend(self.near.iter().copied().filter(is_close));
        if !self.some.is_empty() {
            std::mem::swap(&mut self.near, &mut self.some);
        }
    }

    /// Integrates a secondary facet against those found of one smooth part of the primary side, and leaves these in `near`;
    /// returns the part. `before` is the part it saw before.
    pub fn see(
        &mut self,
        facets: &Facets,
        facet: u32,
        (pair, parts): (&SurfacePair, &SmoothParts),
        at: &Placement,
        (before, derivatives): (u32, Wanted),
    ) -> Result<u32, SurfaceError> {
        self.integrate(facets, facet, pair, at, derivatives)?;
        let covered = &self.covered;
        self.seen.clear();
        // the facets met are in the order of those found
        let (mut passed, mut first, mut met) = (0, 0, 0);
        for (of, &number) in covered.pairs().iter().zip(covered.met()) {
            let Some(&other) = self.near.get(number) else {
                continue;
            };
            let between = self.near.get(passed..number).unwrap_or_default();
            first += between
                .iter()
                .map(|&f| nodes_of(pair, f).len())
                .sum::<usize>();
            passed = number;
            let primary = self.others.get(first..).unwrap_or_default();
            met += 1;
            let gap = of.mean_way(&self.own, primary).dot(covered.normal());
            // what is further behind is the other face of the own body
            if gap < 0.0 && -gap > pair.deepest_between(facet, other, at) {
                continue;
            }
            self.seen.push(Seen {
                facet: other,
                cosine: of.cosine(),
                area: of.area(),
                gap,
            });
        }
        let whole = covered.full().iter().sum();
        let size = facets.size(at, facet);
        let part = parts.choose(&mut self.seen, (whole, size), before, &mut self.some);
        if self.seen.len() < met {
            self.near.clear();
            self.near.extend(self.seen.iter().map(|s| s.facet));
            self.integrate(facets, facet, pair, at, derivatives)?;
        }
        Ok(part)
    }

    /// Integrates a secondary facet against those found.
    pub fn integrate(
        &mut self,
        facets: &Facets,
        facet: u32,
        pair: &SurfacePair,
        at: &Placement,
        derivatives: Wanted,
    ) -> Result<(), SurfaceError> {
        let missing = || SurfaceError::NoSuchFacet { facet };
        let element = facets.element(facet).ok_or_else(missing)?;
        self.place(facets, facet, at.x);
        self.nodes.clear();
        for &other in &self.near {
            self.nodes.extend_from_slice(nodes_of(pair, other));
        }
        self.others.clear();
        positions(&self.nodes, at.x, &mut self.others);
        let primaries = placed(pair, &self.near, &self.others).map(|(_, facet)| facet);
        let primaries: Vec<Facet> = primaries.collect();
        let own = Facet {
            element,
            x: &self.own,
        };
        let covered = &mut self.covered;
        let mut done =
            covered.evaluate(&own, &primaries, &self.nodes, derivatives != Wanted::Values);
        if derivatives == Wanted::Turning {
            done = done.and_then(|()| covered.differentiate_opposite(&primaries));
        }
        done.map_err(|error| SurfaceError::Degenerate {
            facet: match error {
                MortarError::Folded { number } => self.near.get(number).copied().unwrap_or(facet),
                _ => facet,
            },
        })
    }

    /// `∫ψ_j (δ^s + δ^m)` of a secondary facet that was integrated against those found.
    pub fn rises(
        &self,
        facets: &Facets,
        facet: u32,
        pair: &SurfacePair,
        measure: Measure,
        bent: &BentSides,
    ) -> Result<[f64; MAX_FACET_NODES], SurfaceError> {
        let missing = || SurfaceError::NoSuchFacet { facet };
        let element = facets.element(facet).ok_or_else(missing)?;
        let (numbers, primaries): (Vec<u32>, Vec<Facet>) =
            placed(pair, &self.near, &self.others).unzip();
        let own = Facet {
            element,
            x: &self.own,
        };
        let rise = |of: Option<usize>, local| match of {
            None => bent.of_secondary(facet, local),
            Some(number) => numbers
                .get(number)
                .map_or(0.0, |&facet| bent.of_primary(Anchor { facet, local })),
        };
        let found = rises(&self.covered, measure, &own, &primaries, &rise);
        found.map_err(|_| SurfaceError::Degenerate { facet })
    }

    pub fn store(&self, to: &mut OfFacet) {
        let covered = &self.covered;
        to.met.clear();
        to.met.extend(covered.met().iter().map(|&k| self.near[k]));
        to.nodes.clear();
        to.nodes
            .extend(covered.nodes().iter().map(|&k| self.nodes[k]));
        to.normal = covered.normal();
        to.facing = covered.facing();
        to.opposite = covered.opposite();
        to.m.clear();
        for (j, (d, full)) in covered.d().iter().zip(covered.full()).enumerate() {
            (to.d[j], to.full[j]) = (*d, *full);
            to.m.extend_from_slice(covered.m(j));
        }
        to.mass.clear();
        to.mass.extend_from_slice(covered.mass());
    }
}

/// Derivatives of the integrals of facets: found when a row first needs them, and kept for all others that do.
pub(super) struct Kept {
    slots: Vec<Mutex<Slot>>,
    /// The rank of each facet on the way through all rows, which says where its derivatives are kept: facets that a few
    /// rows in turn need have places of their own however few there are.
    ranks: Vec<usize>,
    /// The last configuration where rows asked for any.
    last: AtomicU64,
}

/// The derivatives of a facet.
#[derive(Default)]
struct Slot {
    facet: u32,
    /// The configuration that they are of; none is zero.
    stamp: u64,
    /// The last configuration where a row asked for them.
    asked: u64,
    derivatives: Derivatives,
}

impl Slot {
    /// Takes the derivatives that were integrated for a facet.
    fn take(&mut self, (facet, stamp): (u32, u64), integrator: &mut Integrator) {
        integrator.covered.leave_derivatives(&mut self.derivatives);
        (self.facet, self.stamp) = (facet, stamp);
    }
}

impl Kept {
    /// Room for facets that rows need in this order.
    pub fn new(nfacet: usize, facets: impl Iterator<Item = u32>) -> Self {
        let mut ranks = vec![usize::MAX; nfacet];
        let mut next = 0;
        for facet in facets {
            if let Some(rank) = ranks.get_mut(facet as usize).filter(|r| **r == usize::MAX) {
                *rank = next;
                next += 1;
            }
        }
        let slots = ranks.iter().map(|_| Mutex::default()).collect();
        Self {
            slots,
            ranks,
            last: AtomicU64::new(0),
        }
    }

    /// The last configuration where rows asked for derivatives.
    pub fn last(&self) -> u64 {
        self.last.load(Ordering::Relaxed)
    }

    /// Whether a row asked for those of a facet at a configuration, as rows probably will at the next one.
    pub fn asked(&self, facet: u32, stamp: u64) -> bool {
        let slot = self.slot(facet, usize::MAX).map(lock);
        stamp > 0 && slot.is_some_and(|slot| (slot.asked, slot.facet) == (stamp, facet))
    }

    /// Keeps the derivatives that were integrated for a facet.
    pub fn keep(&self, facet: u32, stamp: u64, integrator: &mut Integrator) {
        if let Some(mut slot) = self.slot(facet, usize::MAX).map(lock) {
            slot.take((facet, stamp), integrator);
        }
    }

    /// Where those of a facet are kept if there is room for so many.
    fn slot(&self, facet: u32, room: usize) -> Option<&Mutex<Slot>> {
        let rank = self.ranks.get(facet as usize)?;
        self.slots.get(rank % room.max(1))
    }

    /// How many facets are kept where they are like these; forgets the others.
    pub fn make_room(&self, facets: &[OfFacet]) -> usize {
        let met = facets.iter().filter(|of| !of.met.is_empty());
        let (nmet, all) = met.fold((0, 0), |(n, all), of| (n + 1, all + of.nslope()));
        let enough = LEAST * rayon::current_num_threads();
        let room = (NUMBERS / (all / nmet.max(1)).max(1)).max(enough);
        for slot in self.slots.iter().skip(room) {
            *lock(slot) = Slot::default();
        }
        room.min(self.slots.len())
    }

    /// Lets `take` have the derivatives of a facet at the configuration that these weights are of, integrated where they
    /// are not kept.
    pub fn with<T>(
        &self,
        (facet, weights): (u32, &Weights),
        integrator: &mut Integrator,
        integrate: impl FnOnce(&mut Integrator) -> Result<(), SurfaceError>,
        take: impl FnOnce(&Derivatives) -> T,
    ) -> Result<T, SurfaceError> {
        let Some(slot) = self.slot(facet, weights.room) else {
            integrate(integrator)?;
            return Ok(take(integrator.covered.derivatives()));
        };
        self.last.store(weights.stamp, Ordering::Relaxed);
        let mut slot = lock(slot);
        if (slot.stamp, slot.facet) != (weights.stamp, facet) {
            // not known before it is done
            slot.stamp = 0;
            integrate(integrator)?;
            slot.take((facet, weights.stamp), integrator);
        }
        slot.asked = weights.stamp;
        Ok(take(&slot.derivatives))
    }
}

/// What a thread left behind that panicked is not known to be of any facet.
fn lock(slot: &Mutex<Slot>) -> MutexGuard<'_, Slot> {
    slot.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Primary facets with their numbers; `x` has the positions of the nodes of one after the other.
fn placed<'a>(
    pair: &'a SurfacePair,
    facets: &'a [u32],
    x: &'a [Vec3],
) -> impl Iterator<Item = (u32, Facet<'a>)> {
    let mut rest = x;
    facets.iter().filter_map(move |&number| {
        let element = pair.primary.domain(number)?;
        let (x, behind) = rest.split_at_checked(nodes_of(pair, number).len())?;
        rest = behind;
        Some((number, Facet { element, x }))
    })
}

fn positions(nodes: &[NodeId], x: &[Vec3], out: &mut Vec<Vec3>) {
    let place = |n: &NodeId| x.get(*n as usize).copied().unwrap_or_default();
    out.extend(nodes.iter().map(place));
}

#[cfg(test)]
mod tests {
    use super::{Integrator, Kept};
    use crate::contact::mortar::{Derivatives, Facet, OfFacet, Weights};
    use signorini_geometry::element::by_name;
    use signorini_geometry::surface::SurfaceError;
    use signorini_geometry::tensor::Vec3;

    /// Integrates a square whose size identifies the facet and the configuration, as the slopes of its normal do.
    fn integrate(integrator: &mut Integrator, size: f64) -> Result<(), SurfaceError> {
        let element = by_name("quad4").ok_or(SurfaceError::NoSuchFacet { facet: 0 })?;
        let x: Vec<Vec3> = element.nodes().iter().map(|&x| x * size).collect();
        let own = Facet { element, x: &x };
        let done = integrator.covered.evaluate(&own, &[], &[], true);
        done.map_err(|_| SurfaceError::Degenerate { facet: 0 })
    }

    struct Count {
        kept: Kept,
        integrator: Integrator,
        weights: Weights,
        done: usize,
    }

    impl Count {
        /// Asks for a facet; says how many had to be integrated until now.
        fn ask(&mut self, facet: u32) -> usize {
            let size = f64::from(facet + 1) * self.weights.stamp as f64;
            let done = &mut self.done;
            let integrate = |integrator: &mut Integrator| {
                *done += 1;
                integrate(integrator, size)
            };
            let of_facet = (facet, &self.weights);
            let largest = |d: &Derivatives| d.dnormal(0).iter().fold(0.0, |m, d| d.abs().max(m));
            let found = self
                .kept
                .with(of_facet, &mut self.integrator, integrate, largest);
            let found = found.unwrap() * size;
            assert!((found - 0.25).abs() < 1e-12, "{facet}: {found}");
            self.done
        }
    }

    #[test]
    fn derivatives_are_integrated_once_for_each_configuration_where_there_is_room() {
        let mut count = Count {
            kept: Kept::new(3, [2, 0, 2, 1].into_iter()),
            integrator: Integrator::default(),
            weights: Weights::default(),
            done: 0,
        };
        (count.weights.stamp, count.weights.room) = (1, 3);
        assert_eq!([0, 1, 2, 0, 1, 2].map(|f| count.ask(f)), [1, 2, 3, 3, 3, 3]);
        count.weights.stamp = 2;
        assert_eq!([0, 1, 1].map(|f| count.ask(f)), [4, 5, 5]);
        assert_eq!(
            [0, 1, 2].map(|f| count.kept.asked(f, 2)),
            [true, true, false]
        );
        // what was kept before anyone asked
        integrate(&mut count.integrator, 9.0).unwrap();
        count.kept.keep(2, 3, &mut count.integrator);
        count.weights.stamp = 3;
        assert_eq!([2, 0].map(|f| count.ask(f)), [5, 6]);
        // facets with one place for all of them take turns
        (count.weights.stamp, count.weights.room) = (4, 1);
        assert_eq!([0, 1, 1, 0].map(|f| count.ask(f)), [7, 8, 8, 9]);
    }

    #[test]
    fn there_is_less_room_for_facets_that_meet_many_but_enough_for_the_rows_at_hand() {
        let kept = Kept::new(100_000, 0..100_000);
        let meets = |nprimary: usize| OfFacet {
            met: vec![0],
            nodes: vec![0; nprimary],
            m: vec![0.0; 4 * nprimary],
            ..OfFacet::default()
        };
        let room = |nprimary| kept.make_room(&[meets(nprimary), OfFacet::default()]);
        assert_eq!(room(9), super::NUMBERS / (4 * 9 * 39));
        assert_eq!(room(1000), super::LEAST * rayon::current_num_threads());
    }
}
