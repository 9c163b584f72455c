//! From the parts of a contact to its interface.

mod fluid;
mod joined;
mod junctions;
mod open_edges;
mod probe;
mod process_zone;
mod sides;
mod start;
mod variants;
mod wear;

pub(super) use junctions::yields;
pub(super) use sides::{Sides, Source};
pub(super) use start::closed;
pub(super) use variants::Variant;

use super::{
    AreaPart, ContactChange, ContactPart, ContactSummary, Context, Enforcement, FrictionPart,
    ModelError, StartSummary, StepPart, StickPart,
};
use crate::contact::discretization::{REACH, SlidingRange};
use crate::contact::friction::{FrictionLaw, Stick};
use crate::contact::law::{Multiplier, Scale};
use crate::contact::{ContactPhase, InterfaceParts, Measure};
use crate::system::Activity;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets, Placement};
use std::sync::Arc;

/// Factor of the automatic penalty (E1).
const PENALTY: f64 = 10.0;
/// The same of a surface that touches itself, for which there is nothing that does not yield.
const PENALTY_OF_ITSELF: f64 = 30.0;
/// Factor of the automatic parameter of laws that solve for multipliers: it changes the way to the solution only, and
/// what slips turns round for ever where it is large.
const COMPLEMENTARITY: f64 = 1.0;
/// The same of slip, over what the shear modulus says: 0.3 of the modulus of compression at ν = 0.3, for which iterations were
/// counted.
const SHEAR: f64 = 1.05;

/// What contacts of a model share.
pub(super) struct Steps<'a> {
    /// Changes of contacts in each step.
    pub changes: Vec<Vec<ContactChange>>,
    /// Gap over the size of the facets that methods with multipliers may leave.
    pub gap_tol: f64,
    /// What multipliers that friction limits may be off by, over themselves.
    pub traction_tol: f64,
    pub parts: &'a [ContactPart],
    /// Whether all steps are dynamic: multipliers act between sides that do not yield, too.
    pub are_dynamic: bool,
    /// What each contact becomes where some of its facets take part only in some steps; else itself.
    pub variants: Vec<Vec<Variant>>,
}

impl<'a> Steps<'a> {
    /// The contacts of a model with their changes in its steps, and tolerances of gaps and tractions.
    pub fn new(
        parts: &'a [ContactPart],
        steps: &[StepPart],
        activity: &Activity,
        [gap_tol, traction_tol]: [f64; 2],
    ) -> Self {
        let variants = parts.iter().map(|part| variants::variants(part, activity));
        let mut schemes = steps.iter().map(|step| step.scheme);
        Self {
            are_dynamic: schemes.all(|of| of.is_some()),
            variants: variants.collect(),
            changes: steps.iter().map(|s| s.contacts.clone()).collect(),
            gap_tol,
            traction_tol,
            parts,
        }
    }

    /// A variant of a contact.
    pub fn variant(&self, contact: usize, number: usize) -> Option<&Variant> {
        self.variants.get(contact)?.get(number)
    }

    /// What becomes of a contact in each step.
    fn phases(&self, contact: usize, variant: &Variant, penalty: f64) -> Vec<ContactPhase> {
        let part = &variant.part;
        let friction = |f: &Option<FrictionPart>| f.as_ref().map(|f| friction(f, penalty));
        let mut now = ContactPhase {
            active: part.active,
            friction: friction(&part.friction),
            stands: true,
            present: true,
            slip: None,
        };
        let mut phases = Vec::new();
        for changes in &self.changes {
            for change in changes.iter().filter(|c| c.contact == contact) {
                if let Some(active) = change.active {
                    now.active = active;
                }
                if let Some(changed) = &change.friction {
                    now.friction = friction(changed);
                }
                now.slip = change.slip.or(now.slip);
            }
            let [stands, present] = variant.in_step(phases.len());
            phases.push(ContactPhase {
                active: now.active && present,
                stands,
                present,
                ..now.clone()
            });
        }
        phases
    }

    /// Which contacts have friction in any step.
    pub fn rubbing(&self) -> Vec<bool> {
        (0..self.parts.len()).map(|k| self.rubs(k)).collect()
    }

    /// Whether a contact has friction in any step.
    pub fn rubs(&self, contact: usize) -> bool {
        let at_first = self
            .parts
            .get(contact)
            .is_some_and(|p| p.friction.is_some());
        let later = self.changes.iter().flatten();
        let mut later = later.filter(|c| c.contact == contact);
        at_first || later.any(|c| matches!(c.friction, Some(Some(_))))
    }
}

fn friction(part: &FrictionPart, penalty: f64) -> (Arc<dyn FrictionLaw>, Stick) {
    let stick = match part.stick {
        None => Stick::Stiffness(penalty),
        Some(StickPart::Stiffness(stiffness)) => Stick::Stiffness(stiffness),
        Some(StickPart::Slip(length)) => Stick::Slip(length),
    };
    (Arc::clone(&part.limit), stick)
}

/// The enforcement that a contact has in the end.
fn in_use(given: &Enforcement, multiplier: Multiplier, penalty: f64) -> Enforcement {
    match given {
        Enforcement::Auto if multiplier.is_unknown() => Enforcement::Lagrange,
        Enforcement::Auto => Enforcement::Penalty(Some(penalty)),
        given => given.clone(),
    }
}

impl Context<'_> {
    /// Chooses what a contact leaves open, and describes the choice.
    pub(super) fn contact(
        &self,
        mut sides: Sides,
        variant: &Variant,
        steps: &Steps<'_>,
        first_multiplier: usize,
    ) -> Result<(InterfaceParts, ContactSummary), ModelError> {
        let part = &variant.part;
        let surface_error = |source| ModelError::Surface {
            contact: part.name.clone(),
            source,
        };
        let of = [sides.facets.as_ref(), sides.secondary()];
        let sizes = of.map(|s| s.map(|s| self.sizes(s)));
        let share = self.share(of);
        let shear_part = self.shear_part(of.into_iter().flatten());
        let [length, size] = self.extents(&sides.pair.points, &sizes);
        let at = self.placement();
        sides.reach_locally(&at, part);
        let found = sides.look_around(&at, part.reach, REACH * size);
        let found = found.map_err(surface_error)?;
        if part.area == AreaPart::Opposite {
            let known = sides.stand_for_opposite(&found, self.reference, self.spaces);
            known.map_err(surface_error)?;
        }
        let measure = part.measure.unwrap_or(sides.measure());
        let stiffness = sizes.iter().flatten().filter_map(|s| s.stiffness);
        let bare = self.bare(&sides.pair.points, length, sides.secondary().is_none());
        let softest = stiffness.chain(bare).fold(f64::INFINITY, f64::min);
        let penalty = self.penalty(&sides, part, measure, (softest, length, steps.are_dynamic))?;
        if part.sliding == SlidingRange::Small || part.tie.is_some() {
            sides.hold(&at, self.spaces, share).map_err(surface_error)?;
        }
        let look = probe::Look::new(&sides, part, &at).map_err(surface_error)?;
        start::not_too_deep(self.mesh, &sides, part, &look, (self.reference, size))?;
        let bend = look.bend(&sides, &at).map_err(surface_error)?;
        let open_edges = match part.friction.is_some() && part.tie.is_none() {
            true => open_edges::open_edges(self.mesh, &sides.pair, &at),
            false => None,
        };
        let bond = part.tie.map(|tie| start::bonds(&sides, &found, tie, &at));
        let bond = bond.transpose().map_err(surface_error)?;
        let fluid = steps.fluid(&sides, part)?;
        let (breaks, zone) = self.breaking(&sides, part, measure, [penalty, length])?;
        let wear = self.wear(&sides, part)?;
        let summary = ContactSummary {
            name: part.name.clone(),
            enforcement: in_use(&part.enforcement, sides.law.multiplier(), penalty),
            method: sides.method,
            penalty,
            measure,
            sliding: part.sliding,
            reach: sides.pair.reach,
            npoint: sides.pair.points.len(),
            nfacet: sides.pair.primary.nfacet(),
            facet_size: length,
            shared: sides.shared,
            start: StartSummary::new(&found, &look, part, (size, open_edges)),
            cohesion: zone,
        };
        let parts = InterfaceParts {
            name: part.name.clone(),
            shifts: start::shifts(&found, bend.as_ref(), part),
            bend,
            allowance: start::allowance(part),
            fluid,
            damping: part.damping,
            wear,
            is_rigid: !softest.is_finite(),
            restitution: part.restitution,
            heat: (part.heat.clone()).map(|of| of.in_passes(1 + u32::from(part.two_pass))),
            discretization: sides.discretization,
            pair: sides.pair,
            gasket: part.enforcement.gasket(),
            law: sides.law,
            phases: steps.phases(sides.contact, variant, penalty),
            remembers_traction: part.remembers_traction,
            bond,
            bond_tangential: part.tie.and_then(|tie| tie.penalty_tangential),
            cohesion: breaks,
            measure,
            area: sides.area,
            areas: sides.areas,
            scale: Scale {
                penalty,
                shear: SHEAR * shear_part * penalty,
                length,
            },
            first_multiplier,
            gap_tolerance: steps.gap_tol * length,
            traction_tolerance: steps.traction_tol,
            smooths: part.smooths,
            swapped: sides.swapped,
            reported_as: part.reported_as.clone(),
            variant: sides.variant,
        };
        Ok((parts, summary))
    }

    /// The penalty of a contact: the given one, or a factor of the softest of the stiffnesses per area behind its sides.
    fn penalty(
        &self,
        sides: &Sides,
        part: &ContactPart,
        measure: Measure,
        (softest, length, moves): (f64, f64, bool),
    ) -> Result<f64, ModelError> {
        if let Enforcement::Penalty(Some(given))
        | Enforcement::Uzawa(Some(given))
        | Enforcement::AugmentedNewton(Some(given)) = part.enforcement
        {
            return Ok(given);
        }
        if !softest.is_finite() && moves && sides.law.multiplier().is_unknown() {
            // what multipliers are compared with, gap by gap: any number decides alike
            return Ok(1.0);
        }
        if !softest.is_finite() {
            return Err(ModelError::BothRigid {
                contact: part.name.clone(),
            });
        }
        let factor = if sides.law.multiplier().is_unknown() {
            COMPLEMENTARITY
        } else if sides.pair.same {
            PENALTY_OF_ITSELF
        } else {
            PENALTY
        };
        let per_area = factor * softest;
        let area = &sides.area;
        Ok(match measure {
            Measure::Area => per_area,
            Measure::Node if area.is_empty() => per_area * self.patch(&sides.pair.points, length),
            Measure::Node => per_area * area.iter().sum::<f64>() / area.len() as f64,
        })
    }

    /// Where everything is at the start.
    fn placement(&self) -> Placement<'_> {
        Placement {
            x: self.reference,
            poses: &self.poses,
        }
    }

    /// The area that each of these bare nodes stands for, on the average.
    fn patch(&self, points: &[NodeId], length: f64) -> f64 {
        if self.layout.ndim() == 3 {
            return length * length;
        }
        let at = |n: &NodeId| self.reference.get(*n as usize).copied();
        let extent = |n: &NodeId| Some(self.spaces.extent_of_node(*n, at(n)?));
        let extents = points.iter().filter_map(extent);
        length * extents.sum::<f64>() / points.len().max(1) as f64
    }

    /// The mean size of the facets of a contact, and the largest.
    fn extents(&self, points: &[NodeId], sizes: &[Option<Sizes>; 2]) -> [f64; 2] {
        let length = match sizes {
            [Some(s), _] | [None, Some(s)] => s.mean,
            [None, None] => self.size_of_cells(points),
        };
        let largest = sizes.iter().flatten().map(|s| s.largest);
        let largest = largest.fold(0.0, f64::max);
        let size = if largest > 0.0 { largest } else { length };
        [length, size]
    }

    /// The mean size of the cells around bare nodes: the length of their shortest edges.
    fn size_of_cells(&self, points: &[NodeId]) -> f64 {
        let at = |n: &NodeId| self.reference.get(*n as usize).copied().unwrap_or_default();
        let mut sizes = Vec::new();
        for block in 0..self.mesh.blocks.len() as u32 {
            let ncell = self.mesh.blocks[block as usize].ncell() as u32;
            for index in 0..ncell {
                let nodes = self
                    .mesh
                    .cell(signorini_geometry::mesh::CellId { block, index });
                let Some(own) = nodes.iter().find(|n| points.binary_search(n).is_ok()) else {
                    continue;
                };
                let others = nodes.iter().filter(|n| *n != own);
                let nearest = others.map(|n| (at(n) - at(own)).norm());
                sizes.push(nearest.fold(f64::INFINITY, f64::min));
            }
        }
        let finite: Vec<f64> = sizes.into_iter().filter(|s| s.is_finite()).collect();
        finite.iter().sum::<f64>() / finite.len().max(1) as f64
    }

    /// Sizes of the facets of a surface, and the stiffness M/h behind it.
    fn sizes(&self, surface: &Facets) -> Sizes {
        let at = self.placement();
        let mut sizes = Sizes::default();
        let mut stiffness = 0.0;
        let mut deformable = 0;
        let n = surface.nfacet();
        for facet in 0..n as u32 {
            let size = surface.size(&at, facet);
            sizes.largest = sizes.largest.max(size);
            sizes.mean += size / n as f64;
            let face = surface.face(facet);
            let body = face.and_then(|f| self.owner.get(&f.cell));
            if let Some(modulus) = body.and_then(|&b| self.modulus[b]) {
                stiffness += modulus / size;
                deformable += 1;
            }
        }
        if deformable > 0 {
            sizes.stiffness = Some(stiffness / f64::from(deformable));
        }
        sizes
    }

    /// β of (E9) of [`mortar`](crate::contact::mortar): how much of the normals between both sides, the primary one first,
    /// is that of the secondary one. A rigid surface keeps its own.
    fn share(&self, [primary, secondary]: [Option<&Facets>; 2]) -> f64 {
        match [primary, secondary].map(|side| side.and_then(|s| self.modulus_behind(s))) {
            [Some(primary), Some(secondary)] => secondary / (primary + secondary),
            [Some(_), None] => 1.0,
            [None, _] => 0.0,
        }
    }

    /// The mean modulus of deformable bodies behind a surface.
    fn modulus_behind(&self, surface: &Facets) -> Option<f64> {
        let of = |facet| {
            let body = self.owner.get(&surface.face(facet)?.cell);
            body.and_then(|&b| self.modulus[b])
        };
        let all = (0..surface.nfacet() as u32).filter_map(of);
        let (n, sum) = all.fold((0, 0.0), |(n, sum), modulus| (n + 1, sum + modulus));
        (n > 0).then(|| sum / f64::from(n))
    }

    /// The shear modulus over that of compression, of the body behind these surfaces where it is smallest: of any body where
    /// nothing deformable is behind them. What slips is held by no more than that, so c_t is c times it.
    fn shear_part<'s>(&self, surfaces: impl Iterator<Item = &'s Facets>) -> f64 {
        let part = |body: usize| {
            let shear = self.shear_modulus.get(body).copied().flatten();
            let modulus = self.modulus.get(body).copied().flatten();
            shear.zip(modulus).map(|(shear, modulus)| shear / modulus)
        };
        let facets = surfaces.flat_map(|s| (0..s.nfacet() as u32).filter_map(|f| s.face(f)));
        let mut behind: Vec<usize> = facets
            .filter_map(|face| self.owner.get(&face.cell).copied())
            .collect();
        behind.sort_unstable();
        behind.dedup();
        let smallest = behind.into_iter().filter_map(part).reduce(f64::min);
        let any = || (0..self.modulus.len()).filter_map(part).reduce(f64::min);
        smallest.or_else(any).unwrap_or(1.0)
    }

    /// The stiffness behind bare nodes of deformable bodies.
    fn bare(&self, points: &[NodeId], length: f64, wanted: bool) -> Option<f64> {
        if !wanted
            || !points
                .iter()
                .any(|&n| self.elimination.body_of(n).is_none())
        {
            return None;
        }
        let softest = self.modulus.iter().flatten().copied();
        softest.reduce(f64::min).map(|m| m / length)
    }
}

#[derive(Default)]
struct Sizes {
    mean: f64,
    largest: f64,
    stiffness: Option<f64>,
}
