use super::{
    ContactPart, ContactSummary, Context, Enforcement, ModelError, PrimaryPart, SidePart, label,
};
use crate::contact::discretization::{NodeToSegment, SurfacePair};
use crate::contact::friction::Frictionless;
use crate::contact::law::{Penalty, Scale};
use crate::contact::{InterfaceParts, Measure};
use signorini_geometry::mesh::{Face, NodeId};
use signorini_geometry::surface::{ContactSurface, Facets, Placement};
use std::collections::BTreeSet;

/// Factor of the automatic penalty (E1).
const PENALTY: f64 = 10.0;
/// The automatic reach over the largest facet.
const REACH: f64 = 2.0;

impl Context<'_> {
    pub(super) fn contact(
        &self,
        part: ContactPart,
    ) -> Result<(InterfaceParts, ContactSummary), ModelError> {
        let facets = |faces: &[Face]| {
            Facets::new(self.mesh, faces).map_err(|source| ModelError::Facets {
                contact: part.name.clone(),
                source,
            })
        };
        let surface_error = |source| ModelError::Surface {
            contact: part.name.clone(),
            source,
        };
        let PrimaryPart::Faces(faces) = &part.primary else {
            return Err(ModelError::EmptySide { contact: part.name });
        };
        let primary = facets(faces)?;
        let given = match part.enforcement {
            Enforcement::Penalty(penalty) => penalty,
            _ => None,
        };
        let (points, secondary) = match &part.secondary {
            SidePart::Faces(faces) => {
                let surface = facets(faces)?;
                (surface.all_nodes(), Some(surface))
            }
            SidePart::Nodes(nodes) => {
                let unique: BTreeSet<NodeId> = nodes.iter().copied().collect();
                (unique.into_iter().collect(), None)
            }
        };
        if points.is_empty() {
            return Err(ModelError::EmptySide { contact: part.name });
        }
        let of_primary = primary.all_nodes();
        let shared = points
            .iter()
            .filter(|n| of_primary.binary_search(n).is_ok());
        let shared: Vec<NodeId> = shared.copied().collect();
        if let Some(&node) = shared.first() {
            return Err(ModelError::Glued {
                contact: part.name,
                count: shared.len(),
                node: label(self.mesh, node),
            });
        }
        let area: Vec<f64> = match &secondary {
            Some(surface) => surface
                .lumped_areas(self.reference, &|x| self.space.extent(x))
                .map_err(surface_error)?
                .into_iter()
                .map(|(_, a)| a)
                .collect(),
            None => Vec::new(),
        };

        let sides = [Some(&primary), secondary.as_ref()];
        let sizes = sides.map(|s| s.map(|s| self.sizes(s)));
        let largest = sizes
            .iter()
            .flatten()
            .map(|s| s.largest)
            .fold(0.0, f64::max);
        let length = sizes[0].as_ref().map_or(largest, |s| s.mean);
        let softest = sizes
            .iter()
            .flatten()
            .filter_map(|s| s.stiffness)
            .chain(self.bare(&points, length, secondary.is_none()))
            .fold(f64::INFINITY, f64::min);
        let measure = part.measure.unwrap_or(if area.is_empty() {
            Measure::Node
        } else {
            Measure::Area
        });
        let penalty = match given {
            Some(penalty) => penalty,
            None if softest.is_finite() => {
                let per_area = PENALTY * softest;
                match measure {
                    Measure::Area => per_area,
                    Measure::Node if area.is_empty() => per_area * self.patch(&points, length),
                    Measure::Node => per_area * area.iter().sum::<f64>() / area.len() as f64,
                }
            }
            None => return Err(ModelError::BothRigid { contact: part.name }),
        };
        let reach = part.reach.unwrap_or(REACH * largest);
        let summary = ContactSummary {
            name: part.name.clone(),
            penalty,
            measure,
            reach,
            npoint: points.len(),
            nfacet: primary.nfacet(),
            facet_size: length,
        };
        let parts = InterfaceParts {
            name: part.name,
            discretization: Box::new(NodeToSegment::new(points.len())),
            pair: SurfacePair {
                points,
                secondary,
                primary: Box::new(primary),
                reach,
            },
            law: Box::new(Penalty),
            friction: Box::new(Frictionless),
            measure,
            area,
            scale: Scale {
                penalty,
                complementarity: penalty,
                length,
            },
        };
        Ok((parts, summary))
    }

    /// The area that each of these bare nodes stands for, on the average.
    fn patch(&self, points: &[NodeId], length: f64) -> f64 {
        if self.layout.ndim == 3 {
            return length * length;
        }
        let at = |n: &NodeId| self.reference.get(*n as usize).copied();
        let extents = points.iter().filter_map(at).map(|x| self.space.extent(x));
        length * extents.sum::<f64>() / points.len().max(1) as f64
    }

    /// Sizes of the facets of a surface, and the stiffness M/h behind it.
    fn sizes(&self, surface: &Facets) -> Sizes {
        let at = Placement {
            x: self.reference,
            poses: &[],
        };
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
