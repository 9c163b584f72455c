//! The continuation of facets and edges beyond the rim of a surface.

use super::contact_surface::ContactSurface;
use super::error::SurfaceError;
use super::placement::Placement;
use super::point::{Anchor, Feature, Projection, SurfaceJet};
use super::projection::{ABANDON, Jet, Search};
use crate::tensor::Vec3;

/// The point of a facet's own continuation beyond its boundary that is closest to `point`, at most `reach` parameters
/// outside: where a surface ends, a point just past the rim still rests on it.
///
/// # Errors
/// As [`ContactSurface::jet`].
pub fn extended_face(
    surface: &dyn ContactSurface,
    at: &Placement,
    start: Anchor,
    point: Vec3,
    reach: f64,
    out: &mut SurfaceJet,
) -> Result<Option<Projection>, SurfaceError> {
    let Some(element) = surface.domain(start.facet) else {
        return Ok(None);
    };
    let mut search = search_on(surface, at, start.facet, point);
    let bounds = |xi: &Vec3| element.contains(xi, ABANDON.max(2.0 * reach));
    let Some((xi, _)) = search.face(start.local, bounds, out)? else {
        return Ok(None);
    };
    Ok(element
        .contains(&xi, reach)
        .then(|| search.found(xi, Feature::Face, out)))
}

/// The point of an inner edge's own continuation beyond the rim that is closest to `point`, at most `reach` parameters
/// outside, where `start` is the rim's vertex in which the edge ends. Only where the point lies between the normals of
/// the two facets that meet in the edge, as it does under a valley: otherwise one of the facets' own continuations,
/// [`extended_face`], is closer.
///
/// # Errors
/// As [`ContactSurface::jet`].
pub fn extended_edge(
    surface: &dyn ContactSurface,
    at: &Placement,
    start: Anchor,
    point: Vec3,
    reach: f64,
    out: &mut SurfaceJet,
) -> Result<Option<Projection>, SurfaceError> {
    surface.jet(at, &start, out)?;
    let vertex = out.position;
    let around = surface.neighbours(start.facet).iter().copied();
    for facet in [start.facet].into_iter().chain(around) {
        let Some(element) = surface.domain(facet).filter(|e| e.dim() == 2) else {
            continue;
        };
        let mut search = search_on(surface, at, facet, point);
        let nodes = element.nodes();
        for &[a, b] in element.edges() {
            let (from, along) = (nodes[a], nodes[b] - nodes[a]);
            let Some((s, _)) = search.edge(from, along, 0.5, true, out)? else {
                continue;
            };
            let past = (-s).max(s - 1.0) * along.norm();
            if !(0.0..=reach).contains(&past) {
                continue;
            }
            search.jet(if s < 0.0 { nodes[a] } else { nodes[b] }, out)?;
            if (out.position - vertex).norm() > 1e-9 * out.metric[0].max(out.metric[1]).sqrt() {
                continue;
            }
            search.jet(from + along * s, out)?;
            let direction = [along.x, along.y];
            let found = search.found(from + along * s, Feature::Edge { direction }, out);
            let outward = surface.outward(at, &found)?;
            let other = outward.direction - out.normal;
            if !outward.rim && between(point - out.position, out.normal, other) {
                return Ok(Some(found));
            }
        }
    }
    Ok(None)
}

/// Whether `w = α p + β q` with α and β of one sign, for unit vectors in one plane that are not parallel.
fn between(w: Vec3, p: Vec3, q: Vec3) -> bool {
    let c = p.dot(q);
    let (wp, wq) = (w.dot(p), w.dot(q));
    1.0 - c * c > 1e-12 && (wp - c * wq) * (wq - c * wp) >= 0.0
}

/// The search for the point of a facet that is closest to `point`.
fn search_on<'a>(
    surface: &'a dyn ContactSurface,
    at: &'a Placement<'a>,
    facet: u32,
    point: Vec3,
) -> Search<impl Jet + 'a> {
    Search {
        jet: move |anchor: &Anchor, out: &mut SurfaceJet| surface.jet(at, anchor, out),
        facet,
        point,
        ntan: surface.ntan(),
    }
}
