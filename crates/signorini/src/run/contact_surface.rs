//! `frames/contact_NNNN.vtu`: the secondary sides of all contacts at one time.
//!
//! Points are where the nodes are at the start; facets are cells, bare nodes are vertices. `contact_pair` numbers the
//! contacts from 0, in the order of the case.
//!
//! | field | at each node |
//! |---|---|
//! | `contact_pressure` | the mean pressure over the points around the node, smoothed where the case asks for it |
//! | `contact_wet` | of contacts with a fluid, how much of what belongs to the node is wet, from 0 to 1 |
//! | `contact_closure`, `contact_closure_max` | of contacts with a gasket, its closure, and the largest so far |
//! | `contact_pressure_max` | the largest pressure of these points: its maximum is `pressure_max` of terminal, history and summary |
//! | `contact_multiplier` | the pressure in the equations, of the multiplier or of the law, never smoothed |
//! | `contact_multiplier_traction` | the traction in the equations, likewise |
//! | `contact_heat_flux`, `contact_conductance`, `contact_friction_heat` | of contacts that conduct where temperatures are found: heat per time and area from the secondary side to the primary, the conductance, and the heat of friction per time and area |
//! | `contact_damage` | the mean damage of the joint, from 0 to 1; only where one may break |

use super::cells::Cells;
use super::volume::{facts, place, vectors};
use signorini_geometry::mesh::Mesh;
use signorini_geometry::tensor::Vec3;
use signorini_io::writers::vtu::{self, Field, Grid, Options, Values, VtuError};
use signorini_mechanics::system::{ContactFrame, Frame};

/// Tangential tractions below this part of the whole traction are round-off.
const SHEAR_ROUND_OFF: f64 = 1e-6;

/// The bytes of a frame.
///
/// # Errors
/// Arrays of different lengths.
pub fn encode(mesh: &Mesh, frame: &Frame) -> Result<Vec<u8>, VtuError> {
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut cells = Cells::default();
    let mut node_ids: Vec<i64> = Vec::new();
    let mut pairs: Vec<i32> = Vec::new();
    for (number, contact) in (0..).zip(&frame.contacts) {
        let shift = points.len() as u32;
        for &node in &contact.nodes {
            let at = mesh.points.get(node as usize).copied().unwrap_or_default();
            points.push(at.to_array());
            let label = mesh.node_labels.get(node as usize);
            node_ids.push(label.map_or(-1, |&l| i64::try_from(l).unwrap_or(-1)));
        }
        for (element, nodes) in &contact.facets {
            cells.push(*element, nodes, shift);
        }
        if contact.facets.is_empty() {
            (0..contact.nodes.len() as u32).for_each(|k| cells.push_vertex(shift + k));
        }
        pairs.resize(points.len(), number);
    }
    let scalars = |of: fn(&ContactFrame) -> &Vec<f64>| -> Vec<f64> {
        frame
            .contacts
            .iter()
            .flat_map(|c| of(c).iter().copied())
            .collect()
    };
    let all = |of: fn(&ContactFrame) -> &Vec<Vec3>| -> Vec<[f64; 3]> {
        frame.contacts.iter().flat_map(|c| vectors(of(c))).collect()
    };
    let displacement = all(|c| &c.displacement);
    let force = all(|c| &c.force);
    let traction = all(|c| &c.traction);
    let slip = all(|c| &c.slip);
    let gap = scalars(|c| &c.gap);
    let pressure = scalars(|c| &c.pressure);
    let peak = scalars(|c| &c.pressure_peak);
    let multiplier = scalars(|c| &c.multiplier);
    let multiplier_traction = all(|c| &c.multiplier_traction);
    let area = scalars(|c| &c.area);
    let shear: Vec<f64> = frame.contacts.iter().flat_map(shear).collect();
    let status = frame.contacts.iter().flat_map(|c| c.status.iter());
    let status: Vec<i8> = status.map(|s| s.number()).collect();
    let special = special(frame);
    let mut fields = vec![
        Field::new("displacement", Values::Vector(&displacement)),
        Field::new("contact_gap", Values::Scalar(&gap)),
        Field::new("contact_pressure", Values::Scalar(&pressure)),
        Field::new("contact_pressure_max", Values::Scalar(&peak)),
        Field::new("contact_multiplier", Values::Scalar(&multiplier)),
        Field::new(
            "contact_multiplier_traction",
            Values::Vector(&multiplier_traction),
        ),
        Field::new("contact_status", Values::Int8(&status)),
        Field::new("contact_force", Values::Vector(&force)),
        Field::new("contact_traction", Values::Vector(&traction)),
        Field::new("contact_shear", Values::Scalar(&shear)),
        Field::new("contact_slip", Values::Vector(&slip)),
        Field::new("contact_area", Values::Scalar(&area)),
        Field::new("contact_pair", Values::Int32(&pairs)),
        Field::new("node_id", Values::Int64(&node_ids)),
    ];
    let special = special.iter();
    fields.extend(special.map(|(name, values)| Field::new(name, Values::Scalar(values))));
    let (time, place) = ([frame.time], place(frame));
    let grid = Grid {
        points: &points,
        types: &cells.types,
        offsets: &cells.offsets,
        connectivity: &cells.connectivity,
        point_data: &fields,
        cell_data: &[],
        facts: &facts(&time, &place),
    };
    vtu::encode(&grid, &Options::default())
}

/// Fields that only some contacts have: fluids, gaskets, bonds that break, sides that wear, those that conduct. Where others have one, theirs is 0.
fn special(frame: &Frame) -> Vec<(&'static str, Vec<f64>)> {
    type OfContact = fn(&ContactFrame) -> &[f64];
    let all: [(&str, OfContact); 8] = [
        ("contact_wet", |c| &c.wet),
        ("contact_closure", |c| &c.closure),
        ("contact_closure_max", |c| &c.closure_max),
        ("contact_damage", |c| &c.damage),
        ("worn_depth", |c| c.wear.as_ref().map_or(&[], |w| &w.depth)),
        ("contact_heat_flux", |c| {
            c.warmth.as_ref().map_or(&[], |of| &of.flux)
        }),
        ("contact_conductance", |c| {
            c.warmth.as_ref().map_or(&[], |of| &of.conductance)
        }),
        ("contact_friction_heat", |c| {
            c.warmth.as_ref().map_or(&[], |of| &of.friction)
        }),
    ];
    let some = all
        .into_iter()
        .filter(|(_, of)| frame.contacts.iter().any(|c| !of(c).is_empty()));
    some.map(|(name, of)| {
        let values = frame.contacts.iter().flat_map(|c| {
            let known = of(c).iter().copied();
            known.chain(std::iter::repeat(0.0)).take(c.nodes.len())
        });
        (name, values.collect())
    })
    .collect()
}

/// The size of the tangential part of each traction: what the pressure does not explain.
pub fn shear(contact: &ContactFrame) -> Vec<f64> {
    let pairs = contact.traction.iter().zip(&contact.pressure);
    pairs
        .map(|(traction, pressure)| {
            let whole = traction.norm_squared();
            let squared = whole - pressure * pressure;
            if squared > SHEAR_ROUND_OFF * SHEAR_ROUND_OFF * whole.max(f64::MIN_POSITIVE) {
                squared.sqrt()
            } else {
                0.0
            }
        })
        .collect()
}
