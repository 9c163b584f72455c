//! Gaps and overlaps at the start, and what is done about them.

use super::{ContactPart, ModelError, Sides, Source};
use crate::contact::discretization::{Anchored, Pairing, REACH};
use crate::contact::{Allowance, Shift};
use crate::model::{Interference, Method, StartSummary, TieOffset, TiePart};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Placement, Pose, SurfaceError, SurfaceJet};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;

impl StartSummary {
    pub(super) fn new(found: &Pairing) -> Self {
        let gaps = found.pairs.iter().flatten().map(|p| p.gap);
        let smallest = gaps.reduce(f64::min);
        Self {
            near: found.pairs.iter().flatten().count(),
            gap: smallest,
        }
    }
}

/// What is added to the gaps.
pub(super) fn shifts(found: &Pairing, part: &ContactPart) -> Vec<Shift> {
    let start = &part.start;
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
    let overlap = found.pairs.iter().flatten().any(|p| p.gap < 0.0);
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
    rows.map(|p| p.map_or(Shift::default(), |p| shift(p.gap)))
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
