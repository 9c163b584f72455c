//! Segment-based mortar contact: gaps and tractions are means over facets, weighted with the dual basis of their nodes.
//!
//! ```text
//!        ψ_j                    row j: the secondary node j
//!        ╱╲                     over the facets around it, against all primary facets that these meet
//!   ●───●──●───●   secondary
//!  ───●─────●────●─── primary
//! ```
//!
//! | symbol | name in code | shape |
//! |---|---|---|
//! | j, k, l | node of the row, nodes of the secondary and of the primary side | |
//! | e | facets around node j | |
//! | c_k = D_jk, c_l = −M_jl | `scalar` | number for each node |
//! | D_j | `d` | area, length in the plane |
//! | A_j | `area`: D_j of the whole facets at the start | area, length in the plane |
//! | n_k = Σ_e ν_e c_k^e | `vector` | vector for each node |
//! | x_j | place of node j, from which others are measured | vector |
//!
//! ```text
//! ν = N/|N|,  N = Σ_e ν_e D_j^e                                              (E1)
//! g = Σ n_k·(x_k − x_j) / D_j,  b_k = n_k/A_j,  B_k = c_k/A_j I               (E2)
//! G = Σ_e (ν_e·dw^e + dν_e·w^e)/D_j − g dD_j/D_j,  w^e = Σ c_k^e (x_k − x_j)   (E3)
//! dw^e = Σ dc_k^e (x_k − x_j) + c_k^e dx_k,  ∂b_k = Σ_e (dν_e c_k^e + ν_e dc_k^e)/A_j
//! e = P (Σ c_k^n (x_k − x_j) − w)/D_j − P o                                  (E4)
//! de = P (Σ c_k^n dx_k − dw − e dD_j)/D_j − (ν·q) dν − ν (q·dν)
//! ```
//!
//! with the weights c^n of the last accepted state, `q` what P is applied to, and `o` what an elastic law of friction
//! keeps. The slip is objective: a pair that turns as a whole has none. What was not covered then has no past, and slides
//! freely until the end of the increment.
//!
//! *The form.* With the normals of facets, `w` at a point is parallel to `ν_e`, so that pressures are without moment, open
//! or closed, and linear and angular momentum are exact without friction. Instead, [`Normals::Nodal`] has
//! `n_k = ν c_k` with the mean `ν` of the unit normals at the node, as most of the literature.
//!
//! *Areas.* `λ_j` acts on the present area `D_j`. Small-strain theory has one area only, that at the start: linear steps
//! report `λ_j s_j` on `D_j/s_j`, with the stretch `s_j = Σ_e D⁰_j/A_j` of the whole facets around the node, whose `D_j` now
//! are `D⁰_j`; held weights have `s_j = 1`. Without it pressures would be off by the strain of the surface, which in the
//! middle of a Hertzian contact is `−(1 + ν)(1 − 2ν) p0/E` of the area. The start is that of the run, in a linear step after
//! one at finite strain, too.
//!
//! *Guests.* Where little of ψ_a is covered, what it would carry scatters. It leaves its function to others, ψ'_b = ψ_b +
//! Σ_a s_ab ψ_a with shares s_ab of each facet that add up to 1: pressures are even there, nothing is dropped, and node a
//! has no row. Who is whose guest is settled at convergence ([`Averaged::settle`](super::Averaged::settle)).
//!
//! *Edges.* A mean over both sides of an edge says little about either: where the lower face of a block is pressed and
//! what it rests on rises away from its flank, one row would press on half of the flank, too. A node of an edge is the node
//! of one side of it, that which is covered and faces best what it meets, and keeps it until another one does so twice as
//! well. The part of its function on facets of other sides goes to the nodes next to it there (`edges`).
//!
//! *Held weights.* For small sliding and for joined sides, c and n are those of the start: all is linear, the tangent
//! symmetric with `A_j = D_j`, and the slip is `e = P(w/D_j − o)` with the way `o` at the start of the increment.
//!
//! *Order of rows.* Along a curve that fills the box of the nodes, so that facets integrated for one row serve the next.
//!
//! Sources: Popp, Gitterle, Gee and Wall, IJNME 83, 2010; Gitterle, Popp, Gee and Wall, IJNME 84, 2010 (friction); Yang,
//! Laursen and Meng, IJNME 62, 2005 (objective slip).

mod clearance;
mod edges;
mod even;
mod facets;
mod held;
mod integrals;
mod place;
mod pointwise;
mod rows;
mod sight;
mod structural;
mod supports;

use super::projected::Closest;
use super::{HeldAxes, NOWHERE, Pair, Pairing, PointToSegment, SlidingRange, SurfacePair};
use crate::contact::mortar::{
    Basis, Facet, Guests, Measure, OfFacet, OfRow, Transformation, Weights,
};
use crate::contact::row::RowOrder;
use edges::{Part, parts};
use facets::{along_a_curve, corner_normal, search};
use integrals::{Integrator, Kept};
use rayon::prelude::*;
use sight::{NO_PART, STAYS, SmoothParts};
use signorini_geometry::element::{Element, MAX_FACET_NODES};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::proximity::Search;
use signorini_geometry::surface::{ContactSurface, Facets, Feature, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use structural::structural;

/// The covered part of a node's function, on the facet where it is largest, below which other nodes take the function over.
const WEAK: f64 = 0.5;

/// Where no neighbour is covered by [`WEAK`], the factor by which one must be better covered to take the function over.
const BETTER: f64 = 4.0;

/// Facets integrated by one task.
const TASK: usize = 16;

/// Which normals a pressure acts along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// Those of the facets, which turn to those of the primary side as these tilt; nodes at tips compare points.
    #[default]
    Turning,
    /// Those of the facets everywhere: exact momentum.
    Facet,
    /// Means at the nodes: for comparison with other programs.
    Nodal,
}

/// How rows are formed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Form {
    /// Whose normals pressures act along.
    pub normals: Normals,
    /// The weights of nodes of quadratic facets.
    pub basis: Basis,
    /// Whether nodes of edges have one row, which joints want: several would hold them more than once.
    pub joined: bool,
}

/// Rows of the nodes of a surface made of facets.
pub struct Mortar {
    nodes: Vec<NodeId>,
    /// The row of each node of each facet.
    rows: Vec<[usize; MAX_FACET_NODES]>,
    /// Facets around the node of each row on its side of edges, and its place in them.
    around: Vec<Part>,
    /// Nodes of those facets, its own first.
    near: Vec<Vec<NodeId>>,
    /// The nodes of rows as points, for rows that compare these.
    points: PointToSegment,
    /// Rows at edges of the secondary side and where it ends.
    structural: Vec<bool>,
    /// The smooth parts of the primary side.
    sight: SmoothParts,
    /// The largest angle by which the facets around the node of each row turn at the start, in radians.
    turning: Vec<f64>,
    /// `T⁻ᵀ` of every kind of facet, and the kind of each.
    kinds: Vec<(Element, Inverse)>,
    kind: Vec<usize>,
    area: Vec<f64>,
    form: Form,
    measure: Measure,
    held: Option<HeldWeights>,
    /// The axes along which nodes of both sides are held in the present step.
    supports: HeldAxes,
    /// Nodes whose rows other contacts have.
    yields: BTreeSet<NodeId>,
    kept: Kept,
}

/// Weights for good.
struct HeldWeights {
    weights: Weights,
    /// Who is whose guest without supports, and the areas of rows then.
    guests: Guests,
    area: Vec<f64>,
    /// Where nodes were.
    x: Vec<Vec3>,
}

type Inverse = [[f64; MAX_FACET_NODES]; MAX_FACET_NODES];

const ONE: [f64; 1] = [1.0];

impl Mortar {
    /// Rows of all nodes of these facets against a primary side, with areas at `x`.
    ///
    /// # Errors
    /// A facet without a normal, or of an element without a dual basis.
    pub fn new(
        facets: &Facets,
        primary: &dyn ContactSurface,
        form: Form,
        measure: Measure,
        x: &[Vec3],
    ) -> Result<Self, SurfaceError> {
        let sorted = along_a_curve(facets.all_nodes(), x);
        let (nodes, around) = parts(facets, &sorted, form.joined, x)?;
        let mut rows = vec![[0; MAX_FACET_NODES]; facets.nfacet()];
        let mut near: Vec<Vec<NodeId>> = nodes.iter().map(|&n| vec![n]).collect();
        for (row, (near, around)) in near.iter_mut().zip(&around).enumerate() {
            for &(facet, place) in around {
                rows[facet as usize][place] = row;
                for other in facets.nodes(facet) {
                    if !near.contains(other) {
                        near.push(*other);
                    }
                }
            }
        }
        let mut kinds: Vec<(Element, Inverse)> = Vec::new();
        let mut kind = Vec::new();
        let mut area = vec![0.0; nodes.len()];
        let mut integrator = Integrator::new(measure, form.basis);
        for facet in 0..facets.nfacet() as u32 {
            let missing = SurfaceError::NoSuchFacet { facet };
            let element = facets.element(facet).ok_or(missing)?;
            let no_basis = SurfaceError::NoDualBasis {
                facet,
                element: element.name(),
            };
            let known = kinds.iter().position(|k| k.0 == element);
            kind.push(known.unwrap_or(kinds.len()));
            if known.is_none() {
                let element_inverse = inverse(element, form.basis).ok_or(no_basis)?;
                kinds.push((element, element_inverse));
            }
            integrator.place(facets, facet, x);
            let own = Facet {
                element,
                x: &integrator.own,
            };
            let covered = &mut integrator.covered;
            covered
                .evaluate(&own, &[], &[], false)
                .map_err(|_| SurfaceError::Degenerate { facet })?;
            for (&row, full) in rows[facet as usize].iter().zip(covered.full()) {
                area[row] += full;
            }
        }
        let mut points = PointToSegment::at_nodes(&nodes);
        points.closest = Closest::Faces;
        let structural = structural(facets, &nodes, &around);
        let sight = SmoothParts::of(primary, x)?;
        let own = SmoothParts::of(facets, x)?;
        let largest = |part: &Part| part.iter().fold(0.0, |m: f64, p| m.max(own.turning(p.0)));
        let turning = around.iter().map(largest).collect();
        let in_turn = around.iter().flatten().map(|&(facet, _)| facet);
        let kept = Kept::new(facets.nfacet(), in_turn);
        Ok(Self {
            nodes,
            rows,
            around,
            near,
            points,
            structural,
            sight,
            turning,
            kinds,
            kind,
            area,
            form,
            measure,
            held: None,
            supports: HeldAxes::default(),
            yields: BTreeSet::new(),
            kept,
        })
    }

    /// With the weights of this configuration for good, along normals between those of both sides: `share` is the part of
    /// the secondary one.
    ///
    /// # Errors
    /// Facets that cannot be compared.
    pub fn held_at(
        mut self,
        pair: &SurfacePair,
        at: &Placement,
        share: f64,
    ) -> Result<Self, SurfaceError> {
        let search = search(pair, at);
        let mut weights = Weights::default();
        let nothing = Weights::default();
        self.points.sliding = SlidingRange::Small;
        self.weigh(pair, at, &search, (&nothing, RowOrder::Gap), &mut weights)?;
        let bent = self.bend(pair, at, share, &mut weights)?;
        self.rest(pair, at, &mut weights, true)?;
        if let Some(facets) = pair.secondary.as_ref().filter(|_| bent) {
            self.along_normals(facets, &mut weights);
        }
        self.cover(&weights);
        self.held = Some(HeldWeights {
            guests: weights.guests.clone(),
            area: self.area.clone(),
            weights,
            x: at.x.to_vec(),
        });
        Ok(self)
    }

    /// Areas of rows are what these weights cover.
    fn cover(&mut self, weights: &Weights) {
        for (row, area) in self.area.iter_mut().enumerate() {
            if let Some(covered) = weights.row(row) {
                *area = covered.d;
            }
        }
    }

    /// A_j of all rows, in the plane without the extent across it.
    #[must_use]
    pub fn areas(&self) -> &[f64] {
        &self.area
    }

    /// The node of each row.
    #[must_use]
    pub fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    /// Lets rows take over functions by the area covered at this configuration; says whether that changes anything.
    fn rest(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        weights: &mut Weights,
        from_rest: bool,
    ) -> Result<bool, SurfaceError> {
        let Some(facets) = &pair.secondary else {
            return Ok(false);
        };
        let guests = self.host((pair, facets), at, weights, from_rest);
        if guests == weights.guests {
            return Ok(false);
        }
        if guests.turning != weights.guests.turning {
            // derivatives of other facets are wanted in full
            weights.stamp = next_stamp();
        }
        weights.guests = guests;
        self.add_up_all(facets, at, weights)?;
        Ok(true)
    }

    fn weights<'a>(&'a self, pairing: &'a Pairing) -> &'a Weights {
        self.held
            .as_ref()
            .map_or(&pairing.weights, |held| &held.weights)
    }

    /// D and M of all facets and rows at a configuration, with derivatives of facets whose will probably be asked for.
    fn weigh(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        search: &Search,
        (before, next): (&Weights, RowOrder),
        out: &mut Weights,
    ) -> Result<(), SurfaceError> {
        out.stamp = next_stamp();
        let Some(facets) = &pair.secondary else {
            return Ok(());
        };
        let stamp = out.stamp;
        let last = self.kept.last();
        let guests = &out.guests;
        out.facets.resize_with(self.kind.len(), OfFacet::default);
        out.facets
            .par_iter_mut()
            .enumerate()
            .with_min_len(TASK)
            .try_for_each_init(
                || Integrator::new(self.measure, self.form.basis),
                |integrator, (facet, to)| {
                    let facet = facet as u32;
                    integrator.find(facets, facet, pair, at, search);
                    let derivatives = next == RowOrder::Tangent && self.kept.asked(facet, last);
                    let saw = before
                        .facets
                        .get(facet as usize)
                        .map_or(NO_PART, |f| f.part);
                    let sides = (pair, &self.sight);
                    let wanted = match derivatives {
                        true => integrals::Wanted::derivatives(guests.turns_on(facet)),
                        false => integrals::Wanted::Values,
                    };
                    to.part = integrator.see(facets, facet, sides, at, (saw, wanted))?;
                    integrator.store(to);
                    if derivatives {
                        self.kept.keep(facet, stamp, integrator);
                    }
                    Ok(())
                },
            )?;
        out.room = self.kept.make_room(&out.facets);
        self.add_up_all(facets, at, out)
    }

    fn add_up_all(
        &self,
        facets: &Facets,
        at: &Placement,
        out: &mut Weights,
    ) -> Result<(), SurfaceError> {
        let Weights {
            rows,
            facets: of,
            guests,
            ..
        } = out;
        rows.resize_with(self.nodes.len(), OfRow::default);
        rows.par_iter_mut()
            .enumerate()
            .with_min_len(TASK)
            .try_for_each(|(row, to)| self.add_up(row, facets, at, (of, guests), to))
    }

    /// Who takes over whose function, by covered areas: on the facet around a node of which most is, which part of it.
    /// A node of which little is covered leaves it to adjacent nodes that are covered well, or much better than itself.
    fn host(
        &self,
        (pair, facets): (&SurfacePair, &Facets),
        at: &Placement,
        weights: &Weights,
        from_rest: bool,
    ) -> Guests {
        let n = self.nodes.len();
        let parts = self.covered_parts(weights);
        let mut found = Guests {
            left: vec![false; n],
            pointwise: vec![false; n],
            taken: vec![Vec::new(); n],
            ..Guests::default()
        };
        let mut aside = self.choose_sides(weights, &mut found);
        self.choose_points(pair, at, weights, &mut found, &mut aside);
        let mut weak: Vec<usize> = (0..n)
            .filter(|&r| parts[r] > 0.0 && parts[r] < WEAK && !found.left[r])
            .collect();
        weak.sort_by(|&a, &b| parts[b].total_cmp(&parts[a]).then(a.cmp(&b)));
        for row in weak {
            let much = WEAK.min(BETTER * parts[row]);
            self.hand_over(row, facets, weights, |r| parts[r] >= much, &mut found);
        }
        self.free_supports(facets, weights, &parts, &mut found);
        for row in aside {
            self.set_aside(row, facets, &mut found);
        }
        self.turn(weights, from_rest, &mut found);
        found
    }

    /// The covered part of the function of each row, on the facet where it is largest.
    fn covered_parts(&self, weights: &Weights) -> Vec<f64> {
        let part = |&(facet, place): &(u32, usize)| {
            let of = weights.facets.get(facet as usize)?;
            (!of.met.is_empty()).then(|| of.d[place] / of.full[place])
        };
        let of_row = |around: &Part| around.iter().filter_map(part).fold(0.0, f64::max);
        self.around.iter().map(of_row).collect()
    }

    /// Gives the function of a row to the rows around it that may have it, evenly on each facet; leaves it where there is none.
    fn hand_over(
        &self,
        row: usize,
        facets: &Facets,
        weights: &Weights,
        takes: impl Fn(usize) -> bool,
        found: &mut Guests,
    ) {
        let is_met = |facet: u32| {
            let of = weights.facets.get(facet as usize);
            of.is_some_and(|of| !of.met.is_empty())
        };
        let hosts_on = |&(facet, _): &(u32, usize)| {
            let on = &self.rows[facet as usize][..facets.nodes(facet).len()];
            let may = |&other: &usize| other != row && !found.left[other] && takes(other);
            on.iter().copied().filter(may).collect::<Vec<usize>>()
        };
        let mut near: Vec<usize> = Vec::new();
        for host in self.around[row].iter().flat_map(hosts_on) {
            if !near.contains(&host) {
                near.push(host);
            }
        }
        if near.is_empty() {
            return;
        }
        let mut taken = Vec::new();
        for at @ &(facet, place) in self.around[row].iter().filter(|(f, _)| is_met(*f)) {
            let adjacent = hosts_on(at);
            let hosts = if adjacent.is_empty() {
                &near
            } else {
                &adjacent
            };
            let share = 1.0 / hosts.len() as f64;
            taken.extend(hosts.iter().map(|&host| (host, (facet, place, share))));
        }
        // what it had taken over itself goes on to the same rows
        for (facet, place, part) in std::mem::take(&mut found.taken[row]) {
            let share = part / near.len() as f64;
            taken.extend(near.iter().map(|&host| (host, (facet, place, share))));
        }
        found.left[row] = true;
        for (host, function) in taken {
            found.taken[host].push(function);
        }
    }

    /// A node of an edge has the row of the side that is covered and faces what it meets best, unless another one has it.
    /// Answers the rows that it has not.
    fn choose_sides(&self, weights: &Weights, found: &mut Guests) -> Vec<usize> {
        let faces = |row: usize| {
            let of = self.around[row].iter().filter_map(|&(facet, place)| {
                let of = weights.facets.get(facet as usize)?;
                Some(of.facing * of.d[place] / of.full[place])
            });
            let factor = match weights.guests.left.get(row) {
                Some(false) => STAYS,
                _ => 1.0,
            };
            factor * of.fold(0.0, f64::max)
        };
        let mut aside = Vec::new();
        let mut first = 0;
        for of_node in self.nodes.chunk_by(|a, b| a == b) {
            let rows = first..first + of_node.len();
            first = rows.end;
            let better = |a: &usize, b: &usize| faces(*a).total_cmp(&faces(*b)).then(b.cmp(a));
            let own = rows.clone().max_by(better);
            for row in rows.filter(|row| Some(*row) != own) {
                found.left[row] = true;
                aside.push(row);
            }
        }
        aside
    }

    /// The function of a row goes to adjacent nodes on the same side of the edge, or across it where there are none.
    fn set_aside(&self, row: usize, facets: &Facets, found: &mut Guests) {
        for &(facet, place) in &self.around[row] {
            let on = &self.rows[facet as usize][..facets.nodes(facet).len()];
            let stays = |r: &usize| !found.left[*r];
            let mut hosts: Vec<usize> = on.iter().copied().filter(stays).collect();
            if hosts.is_empty() {
                hosts = self.of_same_node(row).filter(stays).collect();
            }
            let share = 1.0 / hosts.len() as f64;
            for host in hosts {
                found.taken[host].push((facet, place, share));
            }
        }
    }

    /// The rows of the node of a row: one for each side of the edge it is on.
    fn of_same_node(&self, row: usize) -> Range<usize> {
        let node = self.nodes[row];
        let first = self.nodes[..row].iter().rev().take_while(|n| **n == node);
        let last = self.nodes[row..].iter().take_while(|n| **n == node);
        row - first.count()..row + last.count()
    }

    /// The sums of a row.
    fn add_up(
        &self,
        row: usize,
        facets: &Facets,
        at: &Placement,
        (of, guests): (&[OfFacet], &Guests),
        to: &mut OfRow,
    ) -> Result<(), SurfaceError> {
        (to.d, to.full, to.normal) = (0.0, 0.0, Vec3::ZERO);
        to.nodes.clone_from(&self.near[row]);
        for &(facet, ..) in guests.taken.get(row).into_iter().flatten() {
            for node in facets.nodes(facet) {
                if !to.nodes.contains(node) {
                    to.nodes.push(*node);
                }
            }
        }
        let nsecondary = to.nodes.len();
        to.nsecondary = nsecondary;
        to.scalar.clear();
        to.scalar.resize(nsecondary, 0.0);
        to.vector.clear();
        to.vector.resize(nsecondary, Vec3::ZERO);
        for (facet, place, share) in guests.of(row, &self.around[row]) {
            let covered = &of[facet as usize];
            let nu = covered.turned(guests.turn(row));
            let d = share * covered.d[place];
            to.full += share * covered.full[place];
            if covered.met.is_empty() {
                continue;
            }
            to.d += d;
            to.normal += match self.form.normals {
                Normals::Turning | Normals::Facet => nu * d,
                Normals::Nodal => corner_normal(facets, facet, place, at)?.0 * share,
            };
            let t = &self.inverse(facet)[place];
            for (&node, t) in facets.nodes(facet).iter().zip(t) {
                if let Some(k) = to.nodes[..nsecondary].iter().position(|n| *n == node) {
                    to.scalar[k] += t * d;
                    to.vector[k] += nu * (t * d);
                }
            }
            let nprimary = covered.nodes.len();
            let m = &covered.m[place * nprimary..][..nprimary];
            for (&node, &m) in covered.nodes.iter().zip(m) {
                let known = to.nodes[nsecondary..].iter().position(|n| *n == node);
                let k = known.map_or(to.nodes.len(), |k| nsecondary + k);
                if known.is_none() {
                    to.nodes.push(node);
                    to.scalar.push(0.0);
                    to.vector.push(Vec3::ZERO);
                }
                to.scalar[k] -= share * m;
                to.vector[k] -= nu * (share * m);
            }
        }
        if self.form.normals == Normals::Nodal {
            let normal = to.normal.normalized().unwrap_or_default();
            for (vector, scalar) in to.vector.iter_mut().zip(&to.scalar) {
                *vector = normal * *scalar;
            }
        }
        Ok(())
    }

    /// Pairs of all rows that are covered, and of those that compare points. `near` has the facets near a row, and
    /// `before` its previous pair.
    fn choose(
        &self,
        pair: &SurfacePair,
        at: &Placement,
        near: &dyn Fn(usize, &mut Vec<u32>),
        before: &dyn Fn(usize) -> Option<Pair>,
        out: &mut Pairing,
    ) -> Result<(), SurfaceError> {
        let weights = match &self.held {
            Some(held) => &held.weights,
            None => &out.weights,
        };
        let x = |n: NodeId| at.x.get(n as usize).copied().unwrap_or_default();
        let mut facets = Vec::new();
        out.pairs.resize(self.nodes.len(), None);
        for (row, (found, &node)) in out.pairs.iter_mut().zip(&self.nodes).enumerate() {
            if weights.guests.is_pointwise(row) {
                let before = before(row).filter(|p| p.anchor != NOWHERE);
                near(row, &mut facets);
                let met = self.points.meet(row, (pair, None), at, &facets, before)?;
                *found = met.filter(|met| self.may_touch(row, pair, at, weights, met));
                continue;
            }
            *found = weights.row(row).map(|of| Pair {
                anchor: NOWHERE,
                feature: Feature::Face,
                gap: of.gap(x(node), &x) / of.d,
                held: None,
            });
        }
        Ok(())
    }

    fn inverse(&self, facet: u32) -> &Inverse {
        &self.kinds[self.kind[facet as usize]].1
    }
}

/// A number that no other configuration has.
fn next_stamp() -> u64 {
    static STAMP: AtomicU64 = AtomicU64::new(1);
    STAMP.fetch_add(1, Ordering::Relaxed)
}

/// `T⁻ᵀ` of a kind of facet; `None` where it has no dual basis.
fn inverse(element: Element, basis: Basis) -> Option<Inverse> {
    let t = Transformation::of(element, basis)?;
    let mut inverse = [[0.0; MAX_FACET_NODES]; MAX_FACET_NODES];
    for k in 0..element.nnode().min(MAX_FACET_NODES) {
        let mut column = [0.0; MAX_FACET_NODES];
        column[k] = 1.0;
        t.values(&mut column);
        for (line, value) in inverse.iter_mut().zip(column) {
            line[k] = value;
        }
    }
    Some(inverse)
}
