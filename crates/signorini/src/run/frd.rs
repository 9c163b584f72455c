//! `NAME.frd`: frames in the one file that CalculiX GraphiX, PrePoMax and FreeCAD read.
//!
//! The same fields go there as into the frames for ParaView, but for those that viewers derive themselves, and only at
//! nodes. There is no undeformed frame, as in files of CalculiX. Forces are internal ones: reactions at supports, and loads
//! where they act.
//!
//! Slip and tangential traction are given in two directions: with `n` the normal of the primary side, taken as the
//! opposite of the mean normal of the secondary facets around a node at their present positions, `t1` is the projection
//! of the x axis on the tangent plane, of the z axis where x is nearly normal, and `t2 = n × t1`. The slip is that of the
//! secondary side, the traction the one it exerts on the primary side, as in files of CalculiX: both have the same sign.
//! Bare nodes have no normal: there the first number is the size and the second zero. Nodes that nothing is within reach
//! of are left out; one in several contacts shows the one with the largest pressure.

use super::contact_surface::shear;
use super::fields::Fields;
use signorini_geometry::element::MAX_FACET_NODES;
use signorini_geometry::tensor::Vec3;
use signorini_io::writers::frd::{Dataset, FrdError, FrdFile, Moment};
use signorini_mechanics::system::{ContactFrame, Frame, Status};
use std::collections::BTreeMap;

/// The cosine from which on an axis counts as normal: one tenth of a degree.
const NORMAL: f64 = 0.999_998_5;

/// Appends a frame.
///
/// # Errors
/// The disk; arrays of another mesh.
pub fn append(file: &mut FrdFile, frame: &Frame, fields: Fields) -> Result<(), FrdError> {
    let mut datasets = vec![Dataset::Displacement(&frame.displacement)];
    if fields.temperature && !frame.temperature.is_empty() {
        datasets.push(Dataset::Temperature(&frame.temperature));
    }
    if fields.stress {
        datasets.push(Dataset::Stress(&frame.stress));
    }
    if fields.strain {
        datasets.push(Dataset::Strain(&frame.strain));
    }
    datasets.push(Dataset::Force(&frame.internal_force));
    if fields.plastic_strain && !frame.plastic_strain.is_empty() {
        datasets.push(Dataset::PlasticStrain(&frame.plastic_strain));
    }
    let rows = contact_rows(if fields.contact { &frame.contacts } else { &[] });
    let nodes: Vec<u32> = rows.keys().copied().collect();
    let values: Vec<[f64; 6]> = rows.into_values().collect();
    if !nodes.is_empty() {
        datasets.push(Dataset::Contact {
            nodes: &nodes,
            values: &values,
        });
    }
    let moment = Moment {
        time: frame.time,
        step: frame.step_number as u64 + 1,
        increment: frame.increment as u64,
    };
    file.frame(&moment, &datasets)
}

/// Gap, slip, pressure and tangential traction at the nodes of all contacts.
fn contact_rows(contacts: &[ContactFrame]) -> BTreeMap<u32, [f64; 6]> {
    let mut rows: BTreeMap<u32, [f64; 6]> = BTreeMap::new();
    for contact in contacts {
        let normals = normals(contact);
        let shear = shear(contact);
        for (k, (&node, status)) in contact.nodes.iter().zip(&contact.status).enumerate() {
            if *status == Status::Absent {
                continue;
            }
            let vector = |of: &[Vec3]| of.get(k).copied().unwrap_or_default();
            let number = |of: &[f64]| of.get(k).copied().unwrap_or_default();
            let slip = vector(&contact.slip) + vector(&contact.elastic_slip);
            let traction = vector(&contact.traction);
            let [slip1, slip2, shear1, shear2] = match tangents(vector(&normals)) {
                Some([t1, t2]) => [
                    slip.dot(t1),
                    slip.dot(t2),
                    -traction.dot(t1),
                    -traction.dot(t2),
                ],
                None => [slip.norm(), 0.0, number(&shear), 0.0],
            };
            let (gap, pressure) = (number(&contact.gap), number(&contact.pressure));
            let row = [gap, slip1, slip2, pressure, shear1, shear2];
            let entry = rows.entry(node).or_insert(row);
            if pressure > entry[3] {
                *entry = row;
            }
        }
    }
    rows
}

/// The normal of the primary side at each node, not of unit length; zero at bare nodes.
fn normals(contact: &ContactFrame) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; contact.nodes.len()];
    let mut derivatives = [Vec3::ZERO; MAX_FACET_NODES];
    for (element, nodes) in &contact.facets {
        let Some(derivatives) = derivatives.get_mut(..element.nnode()) else {
            continue;
        };
        for (xi, &node) in element.nodes().iter().zip(nodes) {
            element.dshape(xi, derivatives);
            let (mut t1, mut t2) = (Vec3::ZERO, Vec3::ZERO);
            for (slope, &other) in derivatives.iter().zip(nodes) {
                let x = contact
                    .points
                    .get(other as usize)
                    .copied()
                    .unwrap_or_default();
                t1 += x * slope.x;
                t2 += x * slope.y;
            }
            if element.dim() == 1 {
                t2 = Vec3::unit(2);
            }
            // that of the secondary side points out of it
            let outward = t1.cross(t2).normalized().unwrap_or_default();
            if let Some(normal) = normals.get_mut(node as usize) {
                *normal -= outward;
            }
        }
    }
    normals
}

/// The two tangential directions to a normal of any length.
fn tangents(normal: Vec3) -> Option<[Vec3; 2]> {
    let n = normal.normalized()?;
    let axis = if n.x.abs() < NORMAL {
        Vec3::unit(0)
    } else {
        Vec3::unit(2)
    };
    let t2 = n.cross(axis).normalized()?;
    Some([t2.cross(n), t2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element;

    /// A square in the plane z = 0 whose outward normal is −z, sliding over the body below it.
    fn square() -> ContactFrame {
        let points = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        let points = points.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
        let n = points.len();
        ContactFrame {
            nodes: vec![4, 5, 6, 7],
            facets: vec![(element::by_name("quad4").unwrap(), vec![0, 1, 2, 3])],
            gap: vec![-1e-3; n],
            pressure: vec![10.0; n],
            status: vec![Status::Slip; n],
            traction: vec![Vec3::new(-3.0, -1.0, 10.0); n],
            slip: vec![Vec3::new(0.2, 0.0, 0.0); n],
            elastic_slip: vec![Vec3::new(0.1, 0.1, 0.0); n],
            displacement: vec![Vec3::ZERO; n],
            points,
            ..ContactFrame::default()
        }
    }

    #[test]
    fn slip_and_shear_have_the_directions_and_signs_of_calculix() {
        // the signs of CalculiX 2.20 for a block on another that moves along +x and +y
        for row in contact_rows(&[square()]).values() {
            let expected = [-1e-3, 0.3, 0.1, 10.0, 3.0, 1.0];
            let error = row
                .iter()
                .zip(expected)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(error < 1e-15, "{row:?}");
        }
    }

    #[test]
    fn directions_are_tangential_orthonormal_and_right_handed() {
        for normal in [
            Vec3::new(0.0, 0.0, 2.0),
            Vec3::new(1.0, 0.0, 0.0),
            Vec3::new(-1.0, 1e-4, 0.0),
            Vec3::new(0.3, -0.4, 0.5),
            Vec3::new(1.0, 0.01, 0.0),
        ] {
            let n = normal.normalized().unwrap();
            let [t1, t2] = tangents(normal).unwrap();
            assert!((t1.cross(t2) - n).norm() < 1e-14);
            assert!((t1.norm() - 1.0).abs() < 1e-14 && t1.dot(n).abs() < 1e-14);
            // the axis lies in the plane of t1 and n
            let axis = if n.x.abs() < NORMAL { 0 } else { 2 };
            assert!(t1[axis] > 0.0 && t2[axis].abs() < 1e-14, "{normal:?}");
        }
        assert!(tangents(Vec3::ZERO).is_none());
    }

    #[test]
    fn bare_nodes_have_sizes_and_absent_ones_no_row() {
        let mut contact = square();
        contact.facets.clear();
        contact.status[2] = Status::Absent;
        let rows = contact_rows(&[contact]);
        assert!(rows.keys().copied().eq([4, 5, 7]));
        let row = rows[&4];
        assert!((row[1] - 0.1_f64.sqrt()).abs() < 1e-15 && row[2] == 0.0);
        assert!((row[4] - 10.0_f64.sqrt()).abs() < 1e-12 && row[5] == 0.0);
    }

    #[test]
    fn of_two_contacts_at_a_node_the_one_that_presses_more_is_shown() {
        let (mut weak, strong) = (square(), square());
        weak.pressure.fill(1.0);
        for contacts in [[weak.clone(), strong.clone()], [strong, weak]] {
            assert!(contact_rows(&contacts).values().all(|row| row[3] == 10.0));
        }
    }
}
