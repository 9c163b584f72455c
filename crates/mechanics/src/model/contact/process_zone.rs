//! Whether facets resolve the zone in which a joint breaks.
//!
//! ```text
//! l = min(E' G_c/N², (E' G_c t³/N²)^{1/4})                                       (E1)
//! ```
//!
//! with the modulus E' of plane strain and the thickness t of the softer and the thinner side. Where l spans fewer facets than
//! [`RESOLVED`], a lower strength takes the same energy over a longer zone.
//!
//! Source: Turon, Dávila, Camanho and Costa, Eng. Fract. Mech. 74, 2007 (the lower strength).

use super::joined::cells_behind;
use super::{ContactPart, Context, ModelError, Sides};
use crate::contact::Measure;
use crate::contact::cohesion::Cohesion;
use crate::model::{CohesionPart, CohesionSummary};
use signorini_geometry::mesh::boundary;
use signorini_geometry::proximity::Aabb;
use signorini_geometry::surface::{Anchor, ContactSurface, Facets, Outline, SurfaceJet};

/// Facets that the zone spans where it is resolved.
const RESOLVED: f64 = 7.0;

/// Facets at which the thickness of a side is measured.
const MEASURED: usize = 16;

impl Context<'_> {
    /// How the joint of a contact breaks, and what became of it.
    pub(super) fn breaking(
        &self,
        sides: &Sides,
        part: &ContactPart,
        measure: Measure,
        [penalty, facet]: [f64; 2],
    ) -> Result<(Option<Cohesion>, Option<CohesionSummary>), ModelError> {
        let Some((tie, of)) = part.tie.and_then(|tie| Some((tie, tie.cohesion?))) else {
            return Ok((None, None));
        };
        if measure == Measure::Node || part.two_pass || tie.pulls() {
            return Err(ModelError::Unsuited {
                contact: part.name.clone(),
                what: "joints that break act per area, in one pass, from where the sides are at the start",
                remedy: "enforcement = { penalty = \"auto\", per = \"area\" }, passes = 1, tied = true",
            });
        }
        let cohesion = of.law(penalty).map_err(|source| ModelError::Cohesion {
            contact: part.name.clone(),
            source,
        })?;
        let summary = self.process_zone(sides, &of, &cohesion, facet);
        Ok((Some(cohesion), Some(summary)))
    }

    /// What a joint that breaks became.
    fn process_zone(
        &self,
        sides: &Sides,
        part: &CohesionPart,
        cohesion: &Cohesion,
        facet: f64,
    ) -> CohesionSummary {
        let both = [sides.secondary(), sides.facets.as_ref()];
        let moduli = both.iter().flatten().filter_map(|s| self.in_plane(s));
        let modulus = moduli.reduce(f64::min);
        let arms = both.iter().flatten().filter_map(|s| self.thickness(s));
        let thickness = arms.reduce(f64::min);
        let mut summary = CohesionSummary {
            stiffness: cohesion.law.stiffness(),
            facet,
            thickness,
            zone: None,
            resolved: RESOLVED,
            reduced: None,
        };
        let Some(modulus) = modulus else {
            return summary;
        };
        let mut factor = 1.0_f64;
        for (strength, toughness) in part.strength.into_iter().zip(part.toughness) {
            let energy = modulus * toughness;
            let square = strength * strength;
            let thick = energy / square;
            let slender = thickness.map(|t| (thick * t.powi(3)).sqrt().sqrt());
            let zone = thick.min(slender.unwrap_or(f64::INFINITY));
            summary.zone = Some(summary.zone.map_or(zone, |least: f64| least.min(zone)));
            let wanted = RESOLVED * facet;
            let of_thick = (energy / wanted).sqrt();
            let of_slender = thickness.map(|t| (energy * t.powi(3)).sqrt() / (wanted * wanted));
            let enough = of_thick.min(of_slender.unwrap_or(f64::INFINITY));
            factor = factor.min(enough / strength);
        }
        if factor < 1.0 {
            summary.reduced = Some(part.strength.map(|strength| factor * strength));
        }
        summary
    }

    /// E' of the softest body behind a surface.
    fn in_plane(&self, surface: &Facets) -> Option<f64> {
        let of = |facet| {
            let body = *self.owner.get(&surface.face(facet)?.cell)?;
            let modulus = self.modulus.get(body).copied().flatten()?;
            let shear = self.shear_modulus.get(body).copied().flatten()?;
            Some(4.0 * shear * (modulus - shear) / modulus)
        };
        let all = (0..surface.nfacet() as u32).filter_map(of);
        all.reduce(f64::min)
    }

    /// How thick the bodies behind a surface are at least, across it.
    fn thickness(&self, surface: &Facets) -> Option<f64> {
        let faces = boundary(self.mesh, cells_behind(self.mesh, surface));
        let outline = Outline::new(Facets::new(self.mesh, &faces).ok()?, self.reference);
        let (at, nfacet) = (self.placement(), surface.nfacet());
        let boxes = (0..nfacet as u32).map(|f| surface.aabb(&at, f).centre());
        let all = Aabb::around(boxes);
        let within = (all.max - all.min).norm() + self.sizes(surface).largest;
        let mut jet = SurfaceJet::default();
        let step = nfacet.div_ceil(MEASURED).max(1);
        let mut of = |facet: u32| {
            let local = surface.element(facet)?.centre();
            let anchor = Anchor { facet, local };
            surface.jet(&at, &anchor, &mut jet).ok()?;
            outline.leaves(self.reference, jet.position, -jet.normal, within)
        };
        let all = (0..nfacet as u32).step_by(step).filter_map(&mut of);
        all.reduce(f64::min)
    }
}
