//! Gaps and overlaps at the start, and their treatment.

use super::joined::cells_behind;
use super::probe::{Look, Probe};
use super::{ContactPart, ModelError, Sides, Source};
use crate::contact::discretization::{Anchored, Pair, Pairing, REACH};
use crate::contact::{Allowance, Bend, Shift};
use crate::model::label::label;
use crate::model::{Interference, Method, OpenEdges, StartSummary, TieOffset, TiePart, Treatment};
use signorini_geometry::mesh::{Mesh, NodeId, boundary};
use signorini_geometry::surface::{Facets, Outline, Placement, Pose, SurfaceError, SurfaceJet};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;

/// Gaps below this, relative to the largest facet, are nothing.
const NOTHING: f64 = 1e-9;

/// Overlaps below this, relative to the largest facet, are not reported.
const SMALL: f64 = 1e-6;

impl StartSummary {
    /// Gaps and overlaps at the start: by nodes of both sides where they are looked at, by rows elsewhere.
    pub(super) fn new(
        found: &Pairing,
        look: &Look,
        part: &ContactPart,
        (size, open_edges): (f64, Option<OpenEdges>),
    ) -> Self {
        let near = found.pairs.iter().flatten().count();
        let left = look.conforms.map_or(0.0, |bent| bent.bent);
        let nothing = left.max(NOTHING * size);
        let plain = |gap: f64| {
            if gap.abs() <= nothing { 0.0 } else { gap }
        };
        let mut summary = Self {
            near,
            bent: look.conforms,
            treatment: part.treatment(),
            open_edges,
            ..Self::default()
        };
        if let Some(clearance) = part.start.clearance.filter(|_| near > 0) {
            summary.gap = Some(clearance);
            summary.touching = if clearance > 0.0 { 0 } else { near };
            return summary;
        }
        if look.nodes.is_empty() {
            let gaps = found.pairs.iter().flatten().map(|p| plain(p.gap));
            summary.gap = gaps.clone().reduce(f64::min);
            summary.touching = gaps.filter(|gap| *gap <= 0.0).count();
            return summary;
        }
        for probe in look.facing() {
            let gap = plain(look.gap(probe));
            summary.touching += usize::from(!probe.of_primary && gap <= 0.0);
            if summary.gap.is_none_or(|least| gap < least) {
                summary.gap = Some(gap);
                summary.place = Some(probe.place());
            }
            if gap < -look.mesh_error(probe) - SMALL * size {
                summary.overlapping += 1;
            }
        }
        summary
    }
}

impl ContactPart {
    /// What becomes of overlaps at the start.
    fn treatment(&self) -> Treatment {
        match (self.tie, self.start.clearance) {
            (Some(_), _) => Treatment::Joined,
            (None, Some(_)) => Treatment::Given,
            (None, None) => Treatment::Interference(self.start.interference),
        }
    }
}

/// Refuses overlaps at the start that are deeper than half the thickness of either body there: the side on which a
/// point is to come out is unknown. Where the outline of one body is known to be farther away, it is an interference.
pub(super) fn not_too_deep(
    mesh: &Mesh,
    sides: &Sides,
    part: &ContactPart,
    look: &Look,
    (x, size): (&[Vec3], f64),
) -> Result<(), ModelError> {
    let ramped = part.treatment() == Treatment::Interference(Interference::Ramped);
    if !ramped || !part.active {
        return Ok(());
    }
    let surface_error = |source| ModelError::Facets {
        contact: part.name.clone(),
        source,
    };
    let mut overlapping: Vec<(f64, &Probe)> = look.facing().map(|p| (look.gap(p), p)).collect();
    overlapping.retain(|(gap, probe)| *gap < -look.mesh_error(probe) - SMALL * size);
    if overlapping.is_empty() {
        return Ok(());
    }
    overlapping.sort_by(|a, b| a.0.total_cmp(&b.0));
    let outlines = [sides.secondary(), sides.facets.as_ref()].map(|side| {
        let side = side?;
        let faces = boundary(mesh, cells_behind(mesh, side));
        Some(Facets::new(mesh, &faces).map(|facets| Outline::new(facets, x)))
    });
    let [secondary, primary] = outlines.map(Option::transpose);
    let outlines = [
        secondary.map_err(surface_error)?,
        primary.map_err(surface_error)?,
    ];
    // how far it is to the other side of a body, where that is less than twice the overlap
    let thickness = |overlap: f64, probe: &Probe| {
        let own = usize::from(probe.of_primary);
        let rays = [
            (own, look.normal(probe).map(|n| (probe.position, -n))),
            (1 - own, Some((probe.closest, -probe.towards))),
        ];
        let mut thickest = None;
        for (body, ray) in rays {
            let (Some(outline), Some((from, along))) = (&outlines[body], ray) else {
                continue;
            };
            let way = outline.leaves(x, from, along, 2.0 * overlap)?;
            thickest = Some(f64::max(thickest.unwrap_or(0.0), way));
        }
        thickest
    };
    let deep = overlapping
        .iter()
        .filter_map(|&(gap, probe)| Some((-gap, probe, thickness(-gap, probe)?)));
    let deep: Vec<(f64, &Probe, f64)> = deep.collect();
    let Some(&(overlap, probe, thickness)) = deep.first() else {
        return Ok(());
    };
    let nodes = deep.iter().filter_map(|(_, probe, _)| probe.node);
    Err(ModelError::TooDeep {
        contact: part.name.clone(),
        overlap,
        thickness,
        place: probe.position,
        count: deep.len(),
        nodes: nodes.take(NAMED).map(|n| label(mesh, n)).collect(),
    })
}

/// Nodes that an error names.
const NAMED: usize = 8;

/// The shifts of gaps, in addition to those by bending.
pub(super) fn shifts(found: &Pairing, bend: Option<&Bend>, part: &ContactPart) -> Vec<Shift> {
    let start = &part.start;
    let rise = |row: usize| bend.and_then(|b| b.rises.get(row)).copied().unwrap_or(0.0);
    let overlap_of = |gap: f64| (-gap).max(0.0);
    let rows = found.pairs.iter();
    if let Some(tie) = part.tie {
        let pulls = tie.offset == TieOffset::Pull;
        let shift = |gap: f64| Shift {
            constant: 0.0,
            fading: overlap_of(gap),
        };
        let rows = rows.filter(|_| pulls);
        return rows
            .map(|p| p.map_or(Shift::default(), |p| shift(p.gap)))
            .collect();
    }
    let mut gaps = found.pairs.iter().enumerate();
    let overlap = gaps.any(|(row, p)| p.is_some_and(|p| p.gap < rise(row)));
    let leaves = match start.interference {
        Interference::Ramped | Interference::StrainFree => !overlap,
        Interference::AtOnce | Interference::Increment | Interference::Increments => true,
    };
    if start.clearance.is_none() && leaves {
        return Vec::new();
    }
    let shift = |gap: f64| {
        if let Some(clearance) = start.clearance {
            return Shift {
                constant: clearance - gap,
                fading: 0.0,
            };
        }
        let overlap = overlap_of(gap);
        match start.interference {
            Interference::Ramped => Shift {
                constant: 0.0,
                fading: overlap,
            },
            Interference::StrainFree => Shift {
                constant: overlap,
                fading: 0.0,
            },
            Interference::AtOnce | Interference::Increment | Interference::Increments => {
                Shift::default()
            }
        }
    };
    let gap = |(row, pair): (usize, &Option<Pair>)| pair.map(|p| p.gap - rise(row));
    rows.enumerate()
        .map(|pair| gap(pair).map_or(Shift::default(), shift))
        .collect()
}

/// Which increments allow for what overlaps at their start. Gaps that are given have no overlaps.
pub(super) fn allowance(part: &ContactPart) -> Allowance {
    if part.tie.is_some() || part.start.clearance.is_some() {
        return Allowance::Never;
    }
    match part.start.interference {
        Interference::Increment => Allowance::First,
        Interference::Increments => Allowance::Every,
        Interference::Ramped | Interference::StrainFree | Interference::AtOnce => Allowance::Never,
    }
}

/// Where the rows of a bond stick.
pub(super) fn bonds(
    sides: &Sides,
    found: &Pairing,
    tie: TiePart,
    at: &Placement,
) -> Result<Vec<Option<Anchored>>, SurfaceError> {
    let within = tie.within.unwrap_or(sides.pair.reach);
    let mut jet = SurfaceJet::default();
    let mut bonds = Vec::with_capacity(found.pairs.len());
    for (row, pair) in found.pairs.iter().enumerate() {
        let Some(pair) = pair.filter(|p| p.gap.abs() <= within) else {
            bonds.push(None);
            continue;
        };
        let anchor = sides
            .discretization
            .anchor(row, &sides.pair, at, &pair, Vec3::ZERO)?;
        // these anchors know their own way
        let whole = matches!(sides.method, Method::NodeToNode { .. } | Method::Mortar(_));
        let offset = if tie.offset == TieOffset::Pull {
            Vec3::ZERO
        } else if sides.facets.is_some() && !whole {
            sides.pair.primary.jet(at, &anchor.anchor, &mut jet)?;
            sides.discretization.point(row).position(at) - jet.position
        } else {
            anchor.offset
        };
        bonds.push(Some(Anchored { offset, ..anchor }));
    }
    Ok(bonds)
}

/// Positions of the nodes with small gaps and overlaps closed: nodes of secondary sides move along the normal onto
/// the primary side.
pub(in crate::model) fn closed(
    source: &Source<'_>,
    parts: &[ContactPart],
    poses: &[Pose],
) -> Result<Vec<Vec3>, ModelError> {
    let mut x = source.reference.to_vec();
    for (contact, part) in parts.iter().enumerate() {
        let closes = part.tie.is_some_and(|t| t.offset == TieOffset::Close);
        let mut below = part.start.close_below;
        if closes {
            let within = part.tie.and_then(|t| t.within);
            below = below.max(within.unwrap_or(f64::INFINITY));
        }
        let listed = &part.start.close_nodes;
        if below <= 0.0 && listed.is_empty() {
            continue;
        }
        let at_nodes = ContactPart {
            method: crate::model::Method::NodeToSegment,
            two_pass: false,
            ..part.clone()
        };
        let moved = Source {
            reference: &x,
            ..*source
        };
        let mut moves = if below > 0.0 {
            moves(&moved, contact, &at_nodes, poses, below)?
        } else {
            HashMap::new()
        };
        if !listed.is_empty() {
            let mut all = self::moves(&moved, contact, &at_nodes, poses, f64::INFINITY)?;
            all.retain(|node, _| listed.contains(node));
            moves.extend(all);
        }
        for (node, to) in moves {
            if let Some(at) = x.get_mut(node as usize) {
                *at = to;
            }
        }
    }
    Ok(x)
}

fn moves(
    source: &Source<'_>,
    contact: usize,
    part: &ContactPart,
    poses: &[Pose],
    below: f64,
) -> Result<HashMap<NodeId, Vec3>, ModelError> {
    let mut moves = HashMap::new();
    let surface_error = |source| ModelError::Surface {
        contact: part.name.clone(),
        source,
    };
    let at = Placement {
        x: source.reference,
        poses,
    };
    for mut sides in source.sides(contact, part)? {
        let facets = [sides.secondary(), sides.facets.as_ref()];
        let sizes = facets.into_iter().flatten().flat_map(|f| {
            use signorini_geometry::surface::ContactSurface;
            (0..f.nfacet() as u32).map(|facet| f.size(&at, facet))
        });
        let largest = sizes.fold(0.0, f64::max);
        sides.pair.reach = if below.is_finite() {
            below
        } else {
            REACH * largest
        };
        let found = sides.pair_up(&at).map_err(surface_error)?;
        let mut jet = SurfaceJet::default();
        for (&node, pair) in sides.pair.points.iter().zip(&found.pairs) {
            let Some(pair) = pair else { continue };
            sides
                .pair
                .primary
                .jet(&at, &pair.anchor, &mut jet)
                .map_err(surface_error)?;
            moves.insert(node, jet.position);
        }
    }
    Ok(moves)
}
