//! Heat through faces and into bodies.

use super::exchange::{Exchange, Through};
use super::{Domain, Effect, Load, LoadError, LoadProperties, Site, spread};
use crate::system::interpolate;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use signorini_vocabulary::{ANY, Bounds, Description, Entry, FREE, NOT_NEGATIVE, Shape, key};
use std::sync::Arc;

/// The entry of [`HeatFlux`].
pub(super) const FLUX: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[key(
        "heat_flux",
        ANY,
        "heat per time and area into a surface",
    )]),
    make: |values| Ok(Arc::new(HeatFlux(values.number("heat_flux")?))),
};

/// The entry of [`HeatPower`].
pub(super) const POWER: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[key(
        "heat_power",
        ANY,
        "heat per time, spread over what it acts on",
    )]),
    make: |values| Ok(Arc::new(HeatPower(values.number("heat_power")?))),
};

/// The entry of [`HeatSource`].
pub(super) const SOURCE: Entry<Arc<dyn Load>> = Entry {
    description: Description::bare(&[key(
        "heat_source",
        ANY,
        "heat per time and volume, within bodies",
    )]),
    make: |values| Ok(Arc::new(HeatSource(values.number("heat_source")?))),
};

/// The entry of [`Film`].
pub(super) const FILM: Entry<Arc<dyn Load>> = Entry {
    description: Description::new(
        "film",
        "convection: heat per time and area out of a surface, h (T - sink)",
        &[
            key("h", NOT_NEGATIVE, "heat per time, area and temperature").required(),
            key("sink", ANY, "the temperature far from the surface").required(),
        ],
    )
    .hints(&["convection"]),
    make: |values| {
        let h = values.number("h")?;
        let sink = values.number("sink")?;
        let table = vec![[0.0, h]];
        Ok(Arc::new(Film { table, sink }))
    },
};

/// The entry of [`Radiation`].
pub(super) const RADIATION: Entry<Arc<dyn Load>> = Entry {
    description: Description::new(
        "radiation",
        "radiation to surroundings: emissivity sigma ((T - T_0)^4 - (sink - T_0)^4), with the constants of the case",
        &[
            key(
                "emissivity",
                Shape::Number(Bounds {
                    from: Some(0.0),
                    to: Some(1.0),
                    ..FREE
                }),
                "part of the radiation of a black surface",
            )
            .required(),
            key("sink", ANY, "the temperature of the surroundings").required(),
        ],
    ),
    make: |values| {
        Ok(Arc::new(Radiation {
            emissivity: values.number("emissivity")?,
            sink: values.number("sink")?,
        }))
    },
};

/// Heat per time and area into faces, through their present area where bodies deform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatFlux(
    /// The flux.
    pub f64,
);

/// Heat per time, spread evenly over the area of faces at the start, or over nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatPower(
    /// The sum.
    pub f64,
);

/// Heat per time and volume at the start, within cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatSource(
    /// The density.
    pub f64,
);

/// Convection: heat per time and area `h(T) (T − sink)` out of faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Rows of temperature of the surface and `h`, temperatures increasing; linear between rows and constant outside.
    pub table: Vec<[f64; 2]>,
    /// The temperature far from the surface.
    pub sink: f64,
}

/// Radiation of faces to surroundings: heat per time and area `ε σ ((T − T_0)⁴ − (sink − T_0)⁴)` out of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radiation {
    /// ε.
    pub emissivity: f64,
    /// The temperature of the surroundings.
    pub sink: f64,
}

fn on_faces(quantity: &'static str) -> LoadProperties {
    LoadProperties::of_heat(Domain::Faces, quantity)
}

fn exchange(site: Site<'_>, through: Through) -> Result<Effect, LoadError> {
    let (layout, reference) = (site.layout, site.reference.clone());
    let term = Exchange::new(
        site.name,
        (site.region, through),
        site.schedule,
        layout,
        reference,
    );
    Ok(Effect::Term(Box::new(term)))
}

impl Load for HeatFlux {
    fn properties(&self) -> LoadProperties {
        on_faces("heat flux")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        exchange(site, Through::Flux(self.0))
    }
}

impl Load for Film {
    fn properties(&self) -> LoadProperties {
        on_faces("film")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        let through = Through::Film {
            table: self.table.clone(),
            sink: self.sink,
        };
        exchange(site, through)
    }
}

impl Load for Radiation {
    fn properties(&self) -> LoadProperties {
        on_faces("radiation")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        let constants = site.radiation.ok_or(LoadError::NoConstants)?;
        let through = Through::Radiation {
            factor: self.emissivity * constants.stefan_boltzmann,
            sink: self.sink,
            zero: constants.absolute_zero,
        };
        exchange(site, through)
    }
}

impl Load for HeatPower {
    fn properties(&self) -> LoadProperties {
        LoadProperties::of_heat(Domain::FacesOrNodes, "heat power")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        if site.region.is_empty() {
            let each = self.0 / site.nodes.len() as f64;
            let nodes = site.nodes.iter().map(|&node| (node, each));
            return Ok(Effect::Heats(nodes.collect()));
        }
        let area = spread::area(&site.region, site.reference);
        if area <= 0.0 {
            return Err(LoadError::NoArea);
        }
        let flux = self.0 / area;
        let along = |n: Vec3| Vec3::unit(0) * (flux * n.norm());
        let nodes = spread::over_faces(&site.region, site.reference, along);
        Ok(first_components(nodes))
    }
}

impl Load for HeatSource {
    fn properties(&self) -> LoadProperties {
        LoadProperties::of_heat(Domain::Volume, "heat source")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        let density = Vec3::unit(0) * self.0;
        let nodes = spread::over_cells(&site.region, site.reference, density);
        Ok(first_components(nodes))
    }
}

/// Numbers that were spread as vectors along x.
fn first_components(nodes: impl IntoIterator<Item = (NodeId, Vec3)>) -> Effect {
    Effect::Heats(nodes.into_iter().map(|(node, v)| (node, v.x)).collect())
}

impl Through {
    /// Heat per time and area out of a surface of this temperature, and its derivative.
    pub fn at(&self, temperature: f64) -> [f64; 2] {
        match self {
            Self::Flux(flux) => [-flux, 0.0],
            Self::Film { table, sink } => {
                let h = interpolate(table, temperature);
                let apart = temperature - sink;
                [h * apart, h + slope(table, temperature) * apart]
            }
            Self::Radiation { factor, sink, zero } => {
                let [own, other] = [temperature, *sink].map(|t| t - zero);
                let sum = (own * own + other * other) * (own + other);
                [factor * sum * (own - other), 4.0 * factor * own.powi(3)]
            }
        }
    }
}

/// The slope of a table that [`interpolate`] reads.
fn slope(table: &[[f64; 2]], at: f64) -> f64 {
    let next = table.partition_point(|row| row[0] <= at);
    let below = next.checked_sub(1).and_then(|k| table.get(k));
    let ends = below.zip(table.get(next));
    ends.map_or(0.0, |(a, b)| (b[1] - a[1]) / (b[0] - a[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_match_differences() {
        let film = Through::Film {
            table: vec![[0.0, 2.0], [50.0, 5.0]],
            sink: 12.0,
        };
        let radiation = Through::Radiation {
            factor: 5e-8,
            sink: 20.0,
            zero: -273.15,
        };
        for through in [film, radiation, Through::Flux(3.0)] {
            for at in [-40.0, 10.0, 33.0, 300.0] {
                let h = 1e-3;
                let [_, slope] = through.at(at);
                let difference = (through.at(at + h)[0] - through.at(at - h)[0]) / (2.0 * h);
                assert!((slope - difference).abs() < 1e-7 * slope.abs().max(1.0));
            }
        }
    }

    #[test]
    fn nothing_flows_at_the_temperature_of_the_surroundings() {
        let radiation = Through::Radiation {
            factor: 5e-8,
            sink: 20.0,
            zero: -273.15,
        };
        assert_eq!(radiation.at(20.0)[0], 0.0);
    }
}
