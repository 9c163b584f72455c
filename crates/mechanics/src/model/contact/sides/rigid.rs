//! Nodes against rigid analytical surfaces.
//!
//! A penalty ε ~ E/h lets a pressure p penetrate p/ε, so that the error in the energy norm falls with h whatever the
//! degree of the elements. Multipliers at the nodes of the secondary side keep the order of the elements: h for linear
//! ones, h^3/2 for quadratic ones at a free end of contact (Hild and Laborde, Appl. Numer. Math. 41, 2002). They need nodes
//! that can follow them.
//!
//! An even pressure on tri6 and quad8 has nodal forces at corners that are zero, or pull, which no multiplier with a sign
//! carries. The shape functions of these facets are therefore transformed as those of mortar contact are
//! ([`Basis::Whole`]):
//!
//! ```text
//! Ñ_m = (1 − 2α) N_m,  Ñ_c = N_c + α Σ N_m,  x̃_m = (x_m − α (x_a + x_b)) / (1 − 2α),  x̃_c = x_c       (E1)
//! g_m = g(x̃_m) + s_m,  s_m = (g(x_m) − α (g(x_a) + g(x_b))) / (1 − 2α) − g(x̃_m) at the start            (E2)
//! ```
//!
//! with m between the corners a and b. A multiplier at x̃_m pushes the middle and pulls a little at the corners, and an
//! even pressure has the positive multipliers `p ∫Ñ`. The row of `m` has its gap (E2): that of the nodes of a plane. On a
//! bent surface x̃_m is off the facet by its sagitta; s_m takes that away, exactly for a constant curvature, because the
//! difference is a quadratic form in tangential distances.
//!
//! Limits: where a surface of varying curvature is slid over, (E2) is off by h²/12 of the change of curvature.

use super::areas::{measure, mortar_areas, no_dual, of_points};
use super::source::Source;
use crate::contact::discretization::mortar::Form;
use crate::contact::discretization::projected::{self, Closest, Sight};
use crate::contact::discretization::{Mortar, Pair, PointToSegment};
use crate::contact::mortar::Basis;
use crate::model::{AreaPart, ContactPart, Enforcement, Method, ModelError, PrimaryPart};
use signorini_geometry::element::DualBasis;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets, Placement, SurfaceError, SurfaceJet};
use signorini_geometry::tensor::Vec3;

/// The part of a normal that must lie along free axes of a node for it to follow a multiplier: sin 30°.
const FREE: f64 = 0.5;

/// A node in the middle of an edge of tri6 or quad8.
struct Mid {
    node: NodeId,
    /// The corners at the ends of the edge.
    corners: [NodeId; 2],
    /// α of (E1).
    alpha: f64,
}

impl Source<'_> {
    /// Whether the nodes of a contact take multipliers without being asked: against an analytical surface, where no method
    /// and no law is given, and where every node can follow.
    pub(super) fn nodes_take_multipliers(
        &self,
        (contact, part): (usize, &ContactPart),
        points: &[NodeId],
    ) -> Result<bool, SurfaceError> {
        let Some(surface) = analytical(part) else {
            return Ok(false);
        };
        let nothing_given = matches!(part.method, Method::Auto)
            && matches!(part.enforcement, Enforcement::Auto)
            && part.tie.is_none()
            && !part.two_pass
            && part.friction.as_ref().is_none_or(|f| f.stick.is_none());
        if !nothing_given {
            return Ok(false);
        }
        let poses = self.elimination.initial_poses();
        let at = Placement {
            x: self.reference,
            poses: &poses,
        };
        let rubs = self.rubs.get(contact) == Some(&true);
        let mut jet = SurfaceJet::default();
        for &node in points {
            if self.elimination.body_of(node).is_some() {
                return Ok(false);
            }
            let axes = self.motions.get(node as usize).copied().unwrap_or_default();
            if rubs && axes.iter().any(|a| a.moves) {
                return Ok(false);
            }
            if axes.iter().all(|a| !a.is_given) {
                continue;
            }
            let found = closest_of_surface(surface, &at, self.at(node))?;
            let Some(found) = found else { continue };
            surface.jet(&at, &found.anchor, &mut jet)?;
            let mut free = jet.normal;
            for (axis, of) in axes.iter().enumerate() {
                if of.is_given {
                    free[axis] = 0.0;
                }
            }
            if free.norm() < FREE {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn at(&self, node: NodeId) -> Vec3 {
        let x = self.reference.get(node as usize);
        x.copied().unwrap_or_default()
    }

    /// Rows of (E1) and (E2) with their areas, for multipliers at the nodes of facets that need them.
    pub(super) fn blended(
        &self,
        part: &ContactPart,
        facets: &Facets,
        points: &[NodeId],
    ) -> Result<Option<(PointToSegment, Vec<f64>)>, ModelError> {
        let closes = part.tie.is_some()
            || part.start.close_below > 0.0
            || !part.start.close_nodes.is_empty();
        let weighs = !closes && no_dual(facets).is_none();
        let Some(surface) = analytical(part).filter(|_| weighs) else {
            return Ok(None);
        };
        let mids = mids(facets);
        let space = self.spaces.alike(facets);
        let (Some(space), AreaPart::Reference, false) = (space, part.area, mids.is_empty()) else {
            return Ok(None);
        };
        let surface_error = |source| ModelError::Surface {
            contact: part.name.clone(),
            source,
        };
        let form = Form {
            basis: Basis::Whole,
            joined: true,
            ..Form::default()
        };
        let mortar = Mortar::new(facets, surface, form, measure(space), self.reference);
        let mortar = mortar.map_err(surface_error)?;
        let areas = mortar_areas(&mortar, self.reference, space, self.spaces);
        let mut areas: Vec<(NodeId, f64)> = mortar.nodes().iter().copied().zip(areas).collect();
        areas.sort_unstable_by_key(|of| of.0);
        let poses = self.elimination.initial_poses();
        let at = Placement {
            x: self.reference,
            poses: &poses,
        };
        let gap = |x: Vec3| -> Result<Option<f64>, SurfaceError> {
            let found = closest_of_surface(surface, &at, x)?;
            Ok(found.map(|pair| pair.gap))
        };
        let mut rows = PointToSegment::default();
        for &node in points {
            let mid = mids.binary_search_by_key(&node, |mid| mid.node).ok();
            let Some(mid) = mid.and_then(|k| mids.get(k)) else {
                rows.push_row(&[(node, 1.0)], 0.0);
                continue;
            };
            let whole = (1.0 - 2.0 * mid.alpha).recip();
            let [a, b] = mid.corners.map(|corner| (corner, -mid.alpha * whole));
            let parts = [a, b, (node, whole)];
            let mut shift = 0.0;
            let mut moved = Vec3::ZERO;
            for (node, part) in parts {
                moved += self.at(node) * part;
                let gap = gap(self.at(node)).map_err(surface_error)?;
                shift += part * gap.unwrap_or_default();
            }
            shift -= gap(moved).map_err(surface_error)?.unwrap_or_default();
            rows.push_row(&parts, shift);
        }
        Ok(Some((rows, of_points(points, &areas))))
    }
}

/// The primary side of a contact, if it is a surface without facets.
fn analytical(part: &ContactPart) -> Option<&dyn ContactSurface> {
    let PrimaryPart::Surface(surface) = &part.primary else {
        return None;
    };
    let one = surface.nfacet() == 1 && surface.domain(0).is_none();
    one.then_some(surface.as_ref())
}

/// The nodes in the middle of edges of facets that do not share an even pressure among their nodes (tri6, quad8), sorted,
/// with the corners at the ends.
fn mids(facets: &Facets) -> Vec<Mid> {
    let mut mids = Vec::new();
    for facet in 0..facets.nfacet() as u32 {
        let Some(element) = facets.element(facet) else {
            continue;
        };
        let Some(DualBasis::Edges { whole, .. }) = element.dual_basis() else {
            continue;
        };
        let nodes = facets.nodes(facet);
        mids.extend(element.mid_nodes().filter_map(|(k, [a, b])| {
            Some(Mid {
                node: *nodes.get(k)?,
                corners: [*nodes.get(a)?, *nodes.get(b)?],
                alpha: whole,
            })
        }));
    }
    mids.sort_by_key(|mid| mid.node);
    mids.dedup_by_key(|mid| mid.node);
    mids
}

/// The closest point of a surface without facets, however far.
fn closest_of_surface(
    surface: &dyn ContactSurface,
    at: &Placement,
    x: Vec3,
) -> Result<Option<Pair>, SurfaceError> {
    let sight = Sight {
        hint: None,
        on: Closest::Anywhere,
        reach: &|_| f64::INFINITY,
        deepest: None,
        own: None,
    };
    projected::closest(surface, at, x, &[0], &sight)
}
