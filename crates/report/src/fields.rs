//! Fields over the surface, by name and component.
//!
//! Fields of solids are those of the volume frame. Fields whose names begin with `contact_` are those of the contact
//! frame, at the nodes of the secondary sides, found by their numbers; other nodes have no value (NaN).

use crate::results::Frame;
use crate::skin::Skin;
use signorini_io::vtk::{Array, Vtu};
use std::collections::HashMap;

/// Arrays that number things.
const NUMBERS: [&str; 3] = ["node_id", "element_id", "contact_pair"];

/// The field that says where nodes are.
pub const DISPLACEMENT: &str = "displacement";

/// The status of contact: 0 open, 1 stick, 2 slip.
pub const STATUS: &str = "contact_status";

/// The fields that are shown first, and as long as any are.
pub const MAIN: [&str; 5] = [
    DISPLACEMENT,
    "von_mises",
    "contact_pressure",
    STATUS,
    "contact_gap",
];

/// An array of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name in the frames.
    pub name: String,
    /// Names of its components; one empty name for a scalar.
    pub components: Vec<String>,
    /// Whether it is in the contact frame.
    pub of_contact: bool,
}

impl Field {
    /// Whether it is a vector with a size.
    #[must_use]
    pub fn is_vector(&self) -> bool {
        self.components.len() == 3 && self.components.first().is_some_and(|c| c == "x")
    }

    fn of(array: &Array, of_contact: bool) -> Self {
        let axes = ["x", "y", "z"];
        let name = |k: usize| -> String {
            match (array.component_names.get(k), array.ncomponent) {
                (Some(name), _) if !name.is_empty() => name.clone(),
                (_, 1) => String::new(),
                (_, 3) => axes.get(k).map_or_else(String::new, ToString::to_string),
                _ => (k + 1).to_string(),
            }
        };
        Self {
            name: array.name.clone(),
            components: (0..array.ncomponent).map(name).collect(),
            of_contact,
        }
    }
}

/// All fields of a frame, in the order of the files.
#[must_use]
pub fn fields(frame: &Frame) -> Vec<Field> {
    let is_field = |array: &&Array| {
        !NUMBERS.contains(&array.name.as_str()) && !array.numbers.to_f64().is_empty()
    };
    let is_of_contact = |array: &Array| array.name.starts_with("contact_");
    let contact = frame.contact.iter().flat_map(|grid| &grid.point_data);
    let contact: Vec<Field> = contact
        .filter(|array| is_field(array) && is_of_contact(array))
        .map(|array| Field::of(array, true))
        .collect();
    let volume = frame.volume.point_data.iter().filter(is_field);
    let volume = volume.map(|array| Field::of(array, false));
    let mut all: Vec<Field> = volume
        .filter(|field| contact.iter().all(|other| other.name != field.name))
        .collect();
    all.extend(contact);
    all
}

/// The points of a contact frame that belong to nodes of a surface.
#[derive(Clone, Debug, Default)]
pub struct Sites {
    /// For every node of the surface the point of the contact frame, or nothing.
    points: Vec<Option<u32>>,
}

impl Sites {
    /// Finds the points by the numbers of nodes. Of several contacts at one node the one of larger pressure counts.
    #[must_use]
    pub fn of(skin: &Skin, contact: Option<&Vtu>) -> Self {
        let Some(contact) = contact else {
            return Self {
                points: vec![None; skin.nodes.len()],
            };
        };
        let ids = contact
            .point_field("node_id")
            .and_then(|ids| ids.numbers.to_i64());
        let pressure = contact.point_field("contact_pressure");
        let pressure = pressure.map_or_else(Vec::new, |p| p.numbers.to_f64());
        let pressure = |point: u32| pressure.get(point as usize).copied().unwrap_or(0.0);
        let mut places: HashMap<i64, u32> = HashMap::new();
        for (id, point) in ids.unwrap_or_default().into_iter().zip(0_u32..) {
            let place = places.entry(id).or_insert(point);
            if pressure(point) > pressure(*place) {
                *place = point;
            }
        }
        let find = |label: &i64| places.get(label).copied();
        Self {
            points: skin.labels.iter().map(find).collect(),
        }
    }

    /// The points, by node of the surface.
    #[must_use]
    pub fn points(&self) -> &[Option<u32>] {
        &self.points
    }
}

/// The values of a field at the nodes of the surface, node by node with all components; NaN where there is none, and
/// everywhere where the frame has no such field.
#[must_use]
pub fn values(field: &Field, skin: &Skin, frame: &Frame, sites: &Sites) -> Vec<f64> {
    let ncomponent = field.components.len();
    let grid = match field.of_contact {
        true => frame.contact.as_ref(),
        false => Some(&frame.volume),
    };
    let array = grid.and_then(|grid| grid.point_field(&field.name));
    let array = array.filter(|array| array.ncomponent == ncomponent);
    let numbers = array.map_or_else(Vec::new, |array| array.numbers.to_f64());
    let mut values = Vec::with_capacity(skin.nodes.len() * ncomponent);
    let nodes = skin.nodes.iter().zip(sites.points());
    for (&node, &site) in nodes {
        let entry = match field.of_contact {
            true => site,
            false => Some(node),
        };
        for component in 0..ncomponent {
            let at = entry.map(|entry| entry as usize * ncomponent + component);
            let value = at.and_then(|at| numbers.get(at));
            values.push(value.copied().unwrap_or(f64::NAN));
        }
    }
    values
}

/// The displacements of the nodes of the surface; zero where the frame has none.
#[must_use]
pub fn displacements(skin: &Skin, frame: &Frame) -> Vec<[f64; 3]> {
    let array = frame.volume.point_field(DISPLACEMENT);
    let array = array.filter(|array| array.ncomponent == 3);
    let numbers = array.map_or_else(Vec::new, |array| array.numbers.to_f64());
    let of_node = |&node: &u32| {
        let axis = |k: usize| {
            let value = numbers.get(node as usize * 3 + k).copied();
            value.filter(|value| value.is_finite()).unwrap_or(0.0)
        };
        [axis(0), axis(1), axis(2)]
    };
    skin.nodes.iter().map(of_node).collect()
}

/// A number for every node that a field is drawn by: a component, or the size of a vector.
#[must_use]
pub fn scalar(field: &Field, component: Option<usize>, values: &[f64]) -> Vec<f64> {
    let entries = values.chunks_exact(field.components.len().max(1));
    let of_entry = |entry: &[f64]| match component {
        Some(component) => entry.get(component).copied().unwrap_or(f64::NAN),
        None if field.is_vector() => entry.iter().map(|v| v * v).sum::<f64>().sqrt(),
        None => entry.first().copied().unwrap_or(f64::NAN),
    };
    entries.map(of_entry).collect()
}

/// The range that covers all of these; nothing where there are none.
#[must_use]
pub fn joined(ranges: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    ranges.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// Smallest and largest finite value; nothing where there is none.
#[must_use]
pub fn range(values: &[f64]) -> Option<[f64; 2]> {
    let finite = values.iter().copied().filter(|value| value.is_finite());
    joined(finite.map(|value| [value, value]))
}
