use super::{Domain, Effect, Load, LoadError, LoadProperties, Pressure, Site};
use signorini_vocabulary::{ANY, Description, Entry, key};
use std::sync::Arc;

/// The entry of [`Line`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[key(
        "line",
        ANY,
        "force per length of edges of shells, within the shell and normal to the edge, positive inwards",
    )]),
    make: |values| {
        Ok(Arc::new(Line {
            force: values.number("line")?,
            follows: true,
        }))
    },
};

/// Force per length of the edges of shells, positive inwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Force per length.
    pub force: f64,
    /// Whether it follows length and normal of the deformed edge.
    pub follows: bool,
}

impl Line {
    /// The same as a pressure on the face of an edge of this thickness.
    #[must_use]
    pub fn over(&self, thickness: f64) -> Pressure {
        Pressure {
            pressure: self.force / thickness,
            follows: self.follows,
        }
    }
}

impl Load for Line {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::Faces, "line load")
    }

    fn following(&self, follows: bool) -> Option<Arc<dyn Load>> {
        Some(Arc::new(Self { follows, ..*self }))
    }

    /// # Errors
    /// Always: faces of solids have no thickness. Shells are loaded by [`Line::over`].
    fn effect(&self, _: Site<'_>) -> Result<Effect, LoadError> {
        Err(LoadError::Misplaced)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_vocabulary::{Chosen, Value};

    #[test]
    fn a_line_load_is_a_pressure_by_the_thickness() {
        let chosen = Chosen::bare("line", Value::Number(3.0));
        let load = Entry::make(&[ENTRY], &chosen).unwrap();
        assert_eq!(load.properties().domain, Domain::Faces);
        assert!(load.following(false).is_some() && load.resultant(1.0).is_none());
        let line = Line {
            force: 3.0,
            follows: false,
        };
        let pressure = Pressure {
            pressure: 6.0,
            follows: false,
        };
        assert_eq!(line.over(0.5), pressure);
    }
}
