//! `check.vtu`: the undeformed solids with all that a check knows.
//!
//! | array            | where | meaning                                                                       |
//! |------------------|-------|-------------------------------------------------------------------------------|
//! | `quality`        | cells | scaled Jacobian: 1 ideal, 0 flat, negative where turned inside out            |
//! | `edge_ratio`     | cells | shortest over longest edge                                                    |
//! | `body`           | cells | number of the body in the case, from 0; −1 none                               |
//! | `support_x` …    | nodes | 1 where the first step prescribes the displacement                            |
//! | `load`           | nodes | 1 where a load of the first step acts                                         |
//! | `contact_gap`    | nodes | the smallest initial gap of any contact; not a number where none is within reach |
//! | `contact_normal` | nodes | mean normal of the facets of secondary sides, out of the solid                |

use super::Preview;
use crate::run::{Fields, Volume};
use crate::setup::Model;
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::writers::vtu::{Field, Values, VtuError};
use signorini_mechanics::system::{ContactFrame, DofName, FieldId};

/// The bytes of `check.vtu`.
///
/// # Errors
/// Arrays of another mesh.
pub fn picture(model: &Model, preview: &Preview) -> Result<Vec<u8>, VtuError> {
    let mesh = &model.mesh;
    let fields = Fields {
        contact: true,
        ..Fields::default()
    };
    let volume = Volume::new(mesh, fields);
    let cells = || preview.quality.iter().flat_map(|quality| &quality.cells);
    let quality: Vec<f64> = cells().map(|cell| cell.scaled_jacobian).collect();
    let edge_ratio: Vec<f64> = cells().map(|cell| cell.edge_ratio).collect();
    let bodies = bodies(model);
    let (supports, load) = (supports(model), loads(model));
    let contacts = &preview.start.frame.contacts;
    let (gap, normal) = (gaps(mesh, contacts), normals(mesh, contacts));
    let [x, y, z] = &supports;
    let at_nodes = [
        Field::new("contact_gap", Values::Scalar(&gap)),
        Field::new("contact_normal", Values::Vector(&normal)),
        Field::new("support_x", Values::Int8(x)),
        Field::new("support_y", Values::Int8(y)),
        Field::new("support_z", Values::Int8(z)),
        Field::new("load", Values::Int8(&load)),
    ];
    let in_cells = [
        Field::new("quality", Values::Scalar(&quality)),
        Field::new("edge_ratio", Values::Scalar(&edge_ratio)),
        Field::new("body", Values::Int32(&bodies)),
    ];
    volume.encode_with(&preview.start.frame, &at_nodes, &in_cells)
}

/// The body of each cell of the mesh's dimension: the first whose nodes hold all of its nodes.
fn bodies(model: &Model) -> Vec<i32> {
    let mesh = &model.mesh;
    // nodes with the bodies that they are in
    let mut members: Vec<(NodeId, i32)> = Vec::new();
    for (number, body) in (0..).zip(&model.case.bodies) {
        let groups = body.groups.iter();
        let nodes = groups.filter_map(|g| model.nodes_of(&g.value)).flatten();
        members.extend(nodes.map(|node| (node, number)));
    }
    members.sort_unstable();
    members.dedup();
    let of_cell = |cell| {
        let nodes = mesh.cell(cell);
        let holds = |body: i32| {
            let mut nodes = nodes.iter();
            nodes.all(|&node| members.binary_search(&(node, body)).is_ok())
        };
        let Some(&first) = nodes.first() else {
            return -1;
        };
        let from = members.partition_point(|(node, _)| *node < first);
        let of_first = members.iter().skip(from).take_while(|m| m.0 == first);
        of_first
            .map(|m| m.1)
            .find(|&body| holds(body))
            .unwrap_or(-1)
    };
    mesh.cells(mesh.dim()).map(of_cell).collect()
}

/// Where the first step prescribes displacements, by axis; nodes of rigid bodies follow them.
fn supports(model: &Model) -> [Vec<i8>; 3] {
    let mut marks: [Vec<i8>; 3] = std::array::from_fn(|_| vec![0; model.mesh.nnode()]);
    let first = model.steps.iter().take(1).flat_map(|s| &s.prescriptions);
    let rigid = model.system.elimination.bodies();
    for prescription in first {
        let (nodes, axis) = match model
            .system
            .layout
            .name(prescription.dof)
            .map(DofName::parts)
        {
            Some((FieldId::DISPLACEMENT, node, axis)) => (vec![node], axis),
            Some((FieldId::TRANSLATION, body, axis)) => {
                let body = rigid.get(body as usize);
                (body.map_or_else(Vec::new, |b| b.nodes.clone()), axis)
            }
            _ => continue,
        };
        for node in nodes {
            let mark = marks.get_mut(axis).and_then(|m| m.get_mut(node as usize));
            mark.into_iter().for_each(|mark| *mark = 1);
        }
    }
    marks
}

fn loads(model: &Model) -> Vec<i8> {
    let mut marks = vec![0; model.mesh.nnode()];
    let first = model.case.steps.iter().take(1).flat_map(|s| &s.loads);
    for node in first.filter_map(|l| model.nodes_of(&l.on.value)).flatten() {
        if let Some(mark) = marks.get_mut(node as usize) {
            *mark = 1;
        }
    }
    marks
}

fn gaps(mesh: &Mesh, contacts: &[ContactFrame]) -> Vec<f64> {
    let mut gaps = vec![f64::NAN; mesh.nnode()];
    for contact in contacts {
        for (&node, &gap) in contact.nodes.iter().zip(&contact.gap) {
            if let Some(least) = gaps.get_mut(node as usize) {
                *least = least.min(gap);
            }
        }
    }
    gaps
}

fn normals(mesh: &Mesh, contacts: &[ContactFrame]) -> Vec<[f64; 3]> {
    let mut sums = vec![Vec3::ZERO; mesh.nnode()];
    for contact in contacts {
        for (_, facet) in &contact.facets {
            let corner = |k: usize| {
                let at = facet.get(k).and_then(|&p| contact.points.get(p as usize));
                at.copied().unwrap_or_default()
            };
            let normal = match facet.len() {
                2 => (corner(1) - corner(0)).cross(Vec3::unit(2)),
                3 | 6 => (corner(1) - corner(0)).cross(corner(2) - corner(0)),
                _ => (corner(2) - corner(0)).cross(corner(3) - corner(1)),
            };
            for node in facet.iter().filter_map(|&p| contact.nodes.get(p as usize)) {
                if let Some(sum) = sums.get_mut(*node as usize) {
                    *sum += normal;
                }
            }
        }
    }
    let unit = |v: &Vec3| v.normalized().unwrap_or_default().to_array();
    sums.iter().map(unit).collect()
}
