//! What a contact needs to wear.

use super::{Context, ModelError, Sides};
use crate::contact::WearParts;
use crate::contact::discretization::Renewable;
use crate::model::ContactPart;

impl Context<'_> {
    /// How the sides of a contact wear; nothing where they do not.
    pub(super) fn wear(
        &self,
        sides: &Sides,
        part: &ContactPart,
    ) -> Result<Option<WearParts>, ModelError> {
        let Some(wear) = part.wear else {
            return Ok(None);
        };
        let unsuited = |what, remedy| ModelError::Unsuited {
            contact: part.name.clone(),
            what,
            remedy,
        };
        let of = sides.discretization.capabilities();
        for (wrong, what, remedy) in [
            (
                part.tie.is_some(),
                "sides that are joined do not slide, and do not wear",
                "tied = false",
            ),
            (
                part.two_pass,
                "in two passes each side would wear twice",
                "passes = 1",
            ),
            (
                sides.pair.same,
                "of a surface that touches itself it is not known which side wears",
                "primary = \"another set of faces\"",
            ),
            (
                sides.area.is_empty(),
                "wear needs pressures, and its points have no areas",
                "secondary = \"a set of faces\"",
            ),
            (
                of.renewable.is_some_and(Renewable::renews),
                "points that are others in each increment have no depth of their own",
                "sliding = \"finite\"",
            ),
            (
                part.remembers_traction,
                "points that remember a traction do not know how far they slide",
                "friction_history = \"place\"",
            ),
        ] {
            if wrong {
                return Err(unsuited(what, remedy));
            }
        }
        let areas = match (&sides.facets, wear.coefficients[1] > 0.0) {
            (_, false) => Vec::new(),
            (None, true) => {
                return Err(unsuited(
                    "a primary side without faces of a mesh has nothing to wear",
                    "wear = { coefficient = .., of = \"secondary\" }",
                ));
            }
            (Some(facets), true) => {
                let extents = self.spaces.behind(facets);
                let across = |facet, shape: &[f64], x| extents.at(facet, shape, x);
                let areas = facets.nodal_areas(self.reference, &across);
                areas.map_err(|source| ModelError::Surface {
                    contact: part.name.clone(),
                    source,
                })?
            }
        };
        if areas.iter().any(|(_, area)| *area <= 0.0) {
            return Err(unsuited(
                "nodes at corners of its primary side have no area, and cannot wear: a depth is the mean over that",
                "secondary = \"the side with quadratic triangles or quad8\"",
            ));
        }
        Ok(Some(WearParts {
            coefficients: wear.coefficients,
            areas,
        }))
    }
}
