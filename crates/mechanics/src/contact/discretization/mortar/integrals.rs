//! The integrals of secondary facets, found when they are needed and kept as long as the next row may need them.

use super::nodes_of;
use crate::contact::discretization::SurfacePair;
use crate::contact::mortar::{Basis, Covered, Facet, Measure, MortarError, OfFacet};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{ContactSurface, Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::cell::RefCell;

/// Facets whose integrals one thread keeps: two lines of a surface of 30 by 30 at least, where those of a facet take 60 kB;
/// of quadratic facets they take up to ten times as much.
const fn nkept(nnode: usize) -> usize {
    if nnode > 4 { 24 } else { 64 }
}

/// The integrals of one facet, with the memory they take.
#[derive(Default)]
pub(super) struct Integrator {
    pub covered: Covered,
    /// The primary facets that it is integrated against.
    pub near: Vec<u32>,
    pub own: Vec<Vec3>,
    others: Vec<Vec3>,
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

    /// The primary facets that are near a secondary one, in the order of their numbers.
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
        let region = own.inflated(pair.reach);
        let nodes = facets.nodes(facet);
        self.near.retain(|&other| {
            let touches = |f: u32| nodes_of(pair, f).iter().any(|n| nodes.contains(n));
            pair.primary.aabb(at, other).overlaps(&region) && !(pair.same && touches(other))
        });
    }

    /// Integrates a secondary facet against those found.
    pub fn integrate(
        &mut self,
        facets: &Facets,
        facet: u32,
        pair: &SurfacePair,
        at: &Placement,
        derivatives: bool,
    ) -> Result<(), SurfaceError> {
        let missing = || SurfaceError::NoSuchFacet { facet };
        let element = facets.element(facet).ok_or_else(missing)?;
        self.place(facets, facet, at.x);
        self.others.clear();
        for &other in &self.near {
            positions(nodes_of(pair, other), at.x, &mut self.others);
        }
        let mut rest = &self.others[..];
        let primaries: Vec<Facet> = self
            .near
            .iter()
            .filter_map(|&other| {
                let element = pair.primary.domain(other)?;
                let (x, behind) = rest.split_at_checked(nodes_of(pair, other).len())?;
                rest = behind;
                Some(Facet { element, x })
            })
            .collect();
        let own = Facet {
            element,
            x: &self.own,
        };
        let done = self.covered.evaluate(&own, &primaries, derivatives);
        done.map_err(|error| SurfaceError::Degenerate {
            facet: match error {
                MortarError::Folded { number } => self.near.get(number).copied().unwrap_or(facet),
                _ => facet,
            },
        })
    }

    pub fn store(&self, to: &mut OfFacet) {
        let covered = &self.covered;
        to.met.clear();
        to.met.extend(covered.met().iter().map(|&k| self.near[k]));
        to.normal = covered.normal();
        to.facing = covered.facing();
        to.m.clear();
        for (j, (d, full)) in covered.d().iter().zip(covered.full()).enumerate() {
            (to.d[j], to.full[j]) = (*d, *full);
            to.m.extend_from_slice(covered.m(j));
        }
    }
}

thread_local! {
    /// A thread takes chunks of rows that lie side by side: what the last rows of one needed serves the next.
    static KEPT: RefCell<Kept> = RefCell::default();
}

/// Lets `take` have the integrals of a facet, which has so many nodes, with derivatives: integrated where this thread does
/// not keep them. `stamp` is another number for every configuration and every pair of surfaces.
pub(super) fn with_integrals<T>(
    stamp: u64,
    (facet, nnode): (u32, usize),
    of: (Measure, Basis),
    integrate: impl FnOnce(&mut Integrator) -> Result<(), SurfaceError>,
    take: impl FnOnce(&Covered) -> Result<T, SurfaceError>,
) -> Result<T, SurfaceError> {
    KEPT.with_borrow_mut(|kept| take(kept.of(stamp, (facet, nnode), of, integrate)?))
}

/// Integrals with derivatives that one thread keeps for the next row.
#[derive(Default)]
struct Kept {
    slots: Vec<Slot>,
    clock: u64,
}

#[derive(Default)]
struct Slot {
    stamp: u64,
    facet: u32,
    used: u64,
    integrator: Integrator,
}

impl Kept {
    /// Those of a facet, integrated where they are not kept.
    fn of(
        &mut self,
        stamp: u64,
        (facet, nnode): (u32, usize),
        (measure, basis): (Measure, Basis),
        integrate: impl FnOnce(&mut Integrator) -> Result<(), SurfaceError>,
    ) -> Result<&Covered, SurfaceError> {
        self.clock += 1;
        let known = |s: &Slot| s.stamp == stamp && s.facet == facet;
        let found = self.slots.iter().position(known);
        let place = match found {
            Some(place) => place,
            None if self.slots.len() < nkept(nnode) => {
                self.slots.push(Slot::default());
                self.slots.len() - 1
            }
            None => {
                let oldest = self.slots.iter().enumerate().min_by_key(|(_, s)| s.used);
                oldest.map_or(0, |(place, _)| place)
            }
        };
        let slot = &mut self.slots[place];
        slot.used = self.clock;
        if found.is_none() {
            // not known before it is done
            slot.stamp = 0;
            slot.integrator.covered.measured(measure, basis);
            integrate(&mut slot.integrator)?;
            (slot.stamp, slot.facet) = (stamp, facet);
        }
        Ok(&slot.integrator.covered)
    }
}

fn positions(nodes: &[NodeId], x: &[Vec3], out: &mut Vec<Vec3>) {
    let place = |n: &NodeId| x.get(*n as usize).copied().unwrap_or_default();
    out.extend(nodes.iter().map(place));
}
