//! Values of fields at nodes: `displacement.z @ node 5`, `reaction_force.x @ set base`; and at integration points:
//! `stress.yy @ element 7 point 3`.

use crate::run::element_named;
use crate::setup::Model;
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_mechanics::system::{ContactFrame, ContactWarmth, Frame, PointSample, Status};

/// A number of a field at a node.
type Read = fn(&Frame, usize) -> Option<f64>;

fn vector(values: &[Vec3], node: usize, axis: usize) -> Option<f64> {
    values
        .get(node)
        .and_then(|v| v.to_array().get(axis).copied())
}

fn tensor(values: &[Sym3], node: usize, of: fn(&Sym3) -> f64) -> Option<f64> {
    values.get(node).map(of)
}

fn principal(frame: &Frame, node: usize, number: usize) -> Option<f64> {
    let values = frame.stress.get(node)?.eigenvalues();
    values.get(number).copied()
}

/// The contact that a node is on the secondary side of, and its place there; of several, the one that is closed.
fn contact(frame: &Frame, node: usize) -> Option<(&ContactFrame, usize)> {
    let of = |one: &ContactFrame| one.nodes.iter().position(|n| *n as usize == node);
    let contacts = frame.contacts.iter();
    let known = contacts.filter_map(|one| Some((one, of(one)?)));
    known.max_by(|(a, i), (b, j)| {
        let of = |one: &ContactFrame, at: usize| one.pressure.get(at).copied().unwrap_or(0.0);
        of(a, *i).total_cmp(&of(b, *j))
    })
}

/// 0 open, 1 closed without friction, 2 sticking or joined, 3 slipping.
fn contact_status(frame: &Frame, node: usize) -> Option<f64> {
    let (contact, at) = contact(frame, node)?;
    let is_smooth = contact.force_shear == Vec3::ZERO;
    Some(match contact.status.get(at)? {
        Status::Absent | Status::Open => 0.0,
        Status::Slip if is_smooth => 1.0,
        Status::Stick | Status::Tied => 2.0,
        Status::Slip => 3.0,
    })
}

/// Heat per time that what holds the temperature of a node brings in; none while temperatures are given.
fn reaction_heat(frame: &Frame, node: usize) -> Option<f64> {
    let mut fields = frame.fields.iter();
    let temperature = fields.find(|field| field.name == "temperature");
    temperature.map_or(Some(0.0), |field| field.reaction.get(node).copied())
}

/// A field of the heat across the contact of a node.
fn warmth(frame: &Frame, node: usize, of: fn(&ContactWarmth) -> &[f64]) -> Option<f64> {
    let (contact, at) = contact(frame, node)?;
    of(contact.warmth.as_ref()?).get(at).copied()
}

/// Every quantity with its name; those of forces and heats are summed over a set, the others averaged.
const QUANTITIES: [(&str, Read); 56] = [
    ("displacement.x", |f, n| vector(&f.displacement, n, 0)),
    ("displacement.y", |f, n| vector(&f.displacement, n, 1)),
    ("displacement.z", |f, n| vector(&f.displacement, n, 2)),
    ("displacement.magnitude", |f, n| {
        f.displacement.get(n).map(|v| v.norm())
    }),
    ("velocity.x", |f, n| vector(&f.velocity, n, 0)),
    ("velocity.y", |f, n| vector(&f.velocity, n, 1)),
    ("velocity.z", |f, n| vector(&f.velocity, n, 2)),
    ("velocity.magnitude", |f, n| {
        f.velocity.get(n).map(|v| v.norm())
    }),
    ("acceleration.x", |f, n| vector(&f.acceleration, n, 0)),
    ("acceleration.y", |f, n| vector(&f.acceleration, n, 1)),
    ("acceleration.z", |f, n| vector(&f.acceleration, n, 2)),
    ("acceleration.magnitude", |f, n| {
        f.acceleration.get(n).map(|v| v.norm())
    }),
    ("reaction_force.x", |f, n| vector(&f.reaction_force, n, 0)),
    ("reaction_force.y", |f, n| vector(&f.reaction_force, n, 1)),
    ("reaction_force.z", |f, n| vector(&f.reaction_force, n, 2)),
    ("reaction_force.magnitude", |f, n| {
        f.reaction_force.get(n).map(|v| v.norm())
    }),
    ("contact_force.x", |f, n| vector(&f.contact_force, n, 0)),
    ("contact_force.y", |f, n| vector(&f.contact_force, n, 1)),
    ("contact_force.z", |f, n| vector(&f.contact_force, n, 2)),
    ("contact_force.magnitude", |f, n| {
        f.contact_force.get(n).map(|v| v.norm())
    }),
    ("contact_pressure", |f, n| {
        f.contact_pressure.get(n).copied()
    }),
    ("contact_gap", |f, n| {
        contact(f, n).and_then(|(one, at)| one.gap.get(at).copied())
    }),
    ("contact_status", contact_status),
    ("contact_wet", |f, n| {
        contact(f, n).map(|(one, at)| one.wet.get(at).copied().unwrap_or_default())
    }),
    ("contact_closure", |f, n| {
        contact(f, n).and_then(|(one, at)| one.closure.get(at).copied())
    }),
    ("contact_closure_max", |f, n| {
        contact(f, n).and_then(|(one, at)| one.closure_max.get(at).copied())
    }),
    ("worn_depth", |f, n| f.worn_depth.get(n).copied()),
    ("stress.xx", |f, n| tensor(&f.stress, n, Sym3::xx)),
    ("stress.yy", |f, n| tensor(&f.stress, n, Sym3::yy)),
    ("stress.zz", |f, n| tensor(&f.stress, n, Sym3::zz)),
    ("stress.xy", |f, n| tensor(&f.stress, n, Sym3::xy)),
    ("stress.yz", |f, n| tensor(&f.stress, n, Sym3::yz)),
    ("stress.xz", |f, n| tensor(&f.stress, n, Sym3::xz)),
    ("strain.xx", |f, n| tensor(&f.strain, n, Sym3::xx)),
    ("strain.yy", |f, n| tensor(&f.strain, n, Sym3::yy)),
    ("strain.zz", |f, n| tensor(&f.strain, n, Sym3::zz)),
    ("strain.xy", |f, n| tensor(&f.strain, n, Sym3::xy)),
    ("strain.yz", |f, n| tensor(&f.strain, n, Sym3::yz)),
    ("strain.xz", |f, n| tensor(&f.strain, n, Sym3::xz)),
    ("von_mises", |f, n| tensor(&f.stress, n, |s| s.von_mises())),
    ("principal_stress.1", |f, n| principal(f, n, 0)),
    ("principal_stress.2", |f, n| principal(f, n, 1)),
    ("principal_stress.3", |f, n| principal(f, n, 2)),
    ("principal.max", |f, n| principal(f, n, 0)),
    ("principal.mid", |f, n| principal(f, n, 1)),
    ("principal.min", |f, n| principal(f, n, 2)),
    // a model without plasticity has none anywhere
    ("plastic_strain", |f, n| {
        let none = f.plastic_strain.is_empty().then_some(0.0);
        f.plastic_strain.get(n).copied().or(none)
    }),
    ("temperature", |f, n| f.temperature.get(n).copied()),
    ("reaction_heat", reaction_heat),
    ("heat_flux.x", |f, n| vector(&f.heat_flux, n, 0)),
    ("heat_flux.y", |f, n| vector(&f.heat_flux, n, 1)),
    ("heat_flux.z", |f, n| vector(&f.heat_flux, n, 2)),
    ("heat_flux.magnitude", |f, n| {
        f.heat_flux.get(n).map(|v| v.norm())
    }),
    ("contact_heat_flux", |f, n| warmth(f, n, |of| &of.flux)),
    ("contact_conductance", |f, n| {
        warmth(f, n, |of| &of.conductance)
    }),
    ("contact_friction_heat", |f, n| {
        warmth(f, n, |of| &of.friction)
    }),
];

/// A number at an integration point.
type ReadPoint = fn(&PointSample) -> f64;

/// Every quantity at integration points with its name.
const POINT_QUANTITIES: [(&str, ReadPoint); 14] = [
    ("stress.xx", |p| p.stress.xx()),
    ("stress.yy", |p| p.stress.yy()),
    ("stress.zz", |p| p.stress.zz()),
    ("stress.xy", |p| p.stress.xy()),
    ("stress.yz", |p| p.stress.yz()),
    ("stress.xz", |p| p.stress.xz()),
    ("strain.xx", |p| p.strain.xx()),
    ("strain.yy", |p| p.strain.yy()),
    ("strain.zz", |p| p.strain.zz()),
    ("strain.xy", |p| p.strain.xy()),
    ("strain.yz", |p| p.strain.yz()),
    ("strain.xz", |p| p.strain.xz()),
    ("von_mises", |p| p.stress.von_mises()),
    ("plastic_strain", |p| p.plastic_strain),
];

/// How the values at several nodes become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Statistic {
    Sum,
    Mean,
    Min,
    Max,
}

/// A quantity at nodes, or at an integration point.
#[derive(Clone, Debug)]
pub struct Probe(Place);

#[derive(Clone, Debug)]
enum Place {
    Nodes {
        read: Read,
        nodes: Vec<NodeId>,
        statistic: Statistic,
    },
    Point {
        read: ReadPoint,
        cell: CellId,
        /// From 0.
        point: usize,
    },
}

/// Why a probe makes no sense.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProbeError {
    /// No such quantity.
    #[error("there is no quantity \"{name}\" at nodes")]
    Quantity {
        /// What was asked for.
        name: String,
    },
    /// No such node.
    #[error("the mesh has no node {label}")]
    Node {
        /// Its number.
        label: u64,
    },
    /// No such quantity at integration points.
    #[error("there is no quantity \"{name}\" at integration points")]
    PointQuantity {
        /// What was asked for.
        name: String,
    },
    /// No such element.
    #[error("the mesh has no element {label} that deforms")]
    Element {
        /// Its number.
        label: u64,
    },
    /// No such set, or an empty one.
    #[error("there are no nodes in a set \"{name}\"")]
    Set {
        /// Its name.
        name: String,
    },
    /// Words behind the `@` that are not understood.
    #[error(
        "\"{words}\" is not understood; write  @ node 5,  @ set base max  or  @ element 7 point 3"
    )]
    Words {
        /// The words.
        words: String,
    },
}

impl Probe {
    /// A quantity at the node of a number.
    ///
    /// # Errors
    /// No such quantity or node.
    pub fn at_node(model: &Model, quantity: &str, label: u64) -> Result<Self, ProbeError> {
        let (read, _) = find(quantity)?;
        let node = model.node(label).ok_or(ProbeError::Node { label })?;
        Ok(Self(Place::Nodes {
            read,
            nodes: vec![node],
            statistic: Statistic::Mean,
        }))
    }

    /// A quantity on a set: the sum of forces and of heat from supports, the mean of others.
    ///
    /// # Errors
    /// No such quantity or set.
    pub fn on_set(model: &Model, quantity: &str, set: &str) -> Result<Self, ProbeError> {
        let (read, statistic) = find(quantity)?;
        let nodes = model.nodes_of(set).filter(|nodes| !nodes.is_empty());
        let nodes = nodes.ok_or_else(|| ProbeError::Set { name: set.into() })?;
        Ok(Self(Place::Nodes {
            read,
            nodes,
            statistic,
        }))
    }

    /// A quantity at an integration point of the element of a number.
    ///
    /// # Errors
    /// No such quantity, element or point.
    pub fn at_point(
        model: &Model,
        quantity: &str,
        (label, point): (u64, u64),
    ) -> Result<Self, ProbeError> {
        let known = POINT_QUANTITIES.iter().find(|(name, _)| *name == quantity);
        let (_, read) = known.ok_or_else(|| ProbeError::PointQuantity {
            name: quantity.into(),
        })?;
        let mut wanted = model.system.wanted.cells.iter();
        let cell = wanted.find(|cell| model.mesh.cell_label(**cell) == Some(label));
        let cell = *cell.ok_or(ProbeError::Element { label })?;
        Ok(Self(Place::Point {
            read: *read,
            cell,
            point: usize::try_from(point).map_or(0, |point| point.saturating_sub(1)),
        }))
    }

    /// Reads `QUANTITY @ node N` or `QUANTITY @ set NAME [max|min|mean|sum]`; none without `@`.
    ///
    /// # Errors
    /// No such quantity, node or set.
    pub fn parse(model: &Model, what: &str) -> Option<Result<Self, ProbeError>> {
        let (quantity, place) = what.split_once('@')?;
        Some(Self::parse_place(model, quantity.trim(), place.trim()))
    }

    fn parse_place(model: &Model, quantity: &str, place: &str) -> Result<Self, ProbeError> {
        let words = || ProbeError::Words {
            words: place.into(),
        };
        if place.starts_with("element") {
            let named = element_named(&format!("@ {place}"));
            return Self::at_point(model, quantity, named.ok_or_else(words)?);
        }
        let (kind, name) = place.split_once(char::is_whitespace).ok_or_else(words)?;
        let name = name.trim();
        match kind {
            "node" => Self::at_node(model, quantity, name.parse().map_err(|_| words())?),
            "set" => {
                // a name may hold spaces, and may end like a statistic
                if let Ok(probe) = Self::on_set(model, quantity, name) {
                    return Ok(probe);
                }
                let split = name.rsplit_once(char::is_whitespace);
                let (name, statistic) = match split {
                    Some((name, "max")) => (name, Some(Statistic::Max)),
                    Some((name, "min")) => (name, Some(Statistic::Min)),
                    Some((name, "mean")) => (name, Some(Statistic::Mean)),
                    Some((name, "sum")) => (name, Some(Statistic::Sum)),
                    _ => (name, None),
                };
                let mut probe = Self::on_set(model, quantity, name.trim())?;
                if let (Place::Nodes { statistic, .. }, Some(wanted)) = (&mut probe.0, statistic) {
                    *statistic = wanted;
                }
                Ok(probe)
            }
            _ => Err(words()),
        }
    }

    /// The value in a frame.
    #[must_use]
    pub fn value(&self, frame: &Frame) -> f64 {
        let (read, nodes, statistic) = match &self.0 {
            Place::Nodes {
                read,
                nodes,
                statistic,
            } => (read, nodes, statistic),
            Place::Point { read, cell, point } => {
                let samples = frame.samples.of(*cell);
                let sample = samples.and_then(|(_, samples)| samples.get(*point));
                return sample.map_or(f64::NAN, read);
            }
        };
        let values = nodes.iter();
        let values = values.map(|&node| read(frame, node as usize).unwrap_or(f64::NAN));
        match statistic {
            Statistic::Sum => values.sum(),
            Statistic::Mean => values.sum::<f64>() / nodes.len() as f64,
            Statistic::Min => values.fold(f64::INFINITY, f64::min),
            Statistic::Max => values.fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

/// The names of all quantities.
pub fn quantities() -> impl Iterator<Item = &'static str> + Clone {
    QUANTITIES.iter().map(|(name, _)| *name)
}

fn find(quantity: &str) -> Result<(Read, Statistic), ProbeError> {
    let found = QUANTITIES.iter().find(|(name, _)| *name == quantity);
    let (name, read) = found.ok_or_else(|| ProbeError::Quantity {
        name: quantity.into(),
    })?;
    let adds_up = name.contains("_force.") || *name == "reaction_heat";
    let statistic = if adds_up {
        Statistic::Sum
    } else {
        Statistic::Mean
    };
    Ok((*read, statistic))
}
