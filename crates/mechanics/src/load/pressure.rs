use super::{Domain, Effect, FollowingPressure, Load, LoadError, LoadProperties, Site, spread};
use signorini_vocabulary::{ANY, Description, Entry, key};
use std::sync::Arc;

/// The entry of [`Pressure`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[key(
        "pressure",
        ANY,
        "pressure on a surface, positive inwards",
    )]),
    make: |values| {
        Ok(Arc::new(Pressure {
            pressure: values.number("pressure")?,
            follows: true,
        }))
    },
};

/// Pressure, positive in compression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressure {
    /// Force per area.
    pub pressure: f64,
    /// Whether it follows area and normal of the deformed faces.
    pub follows: bool,
}

impl Load for Pressure {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(
            Domain::Faces,
            if self.follows {
                "following pressure"
            } else {
                "pressure"
            },
        )
    }

    fn following(&self, follows: bool) -> Option<Arc<dyn Load>> {
        Some(Arc::new(Self { follows, ..*self }))
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        if self.follows && self.pressure != 0.0 {
            let what = (site.region, self.pressure);
            let (layout, reference) = (site.layout, site.reference.clone());
            let term = FollowingPressure::new(site.name, what, site.schedule, layout, reference);
            return Ok(Effect::Term(Box::new(term)));
        }
        let forces = spread::over_faces(&site.region, site.reference, |n| n * -self.pressure);
        Ok(Effect::forces(forces))
    }
}
