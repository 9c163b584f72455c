//! Mass matrices of all solids.

use super::{Single, cases};
use crate::load::{Region, mass};
use crate::system::Idealisation;
use signorini_geometry::element::by_name;
use signorini_geometry::tensor::Vec3;

#[test]
fn rigid_motions_have_the_kinetic_energy_of_their_mass_and_inertia() {
    for (element, space) in cases() {
        let single = Single::new(element, space, 0.1);
        let density = 2.5;
        let mut region = Region::default();
        let (rule, cell) = (element.rules().mass, single.mesh.cell(single.cell));
        region.push_by((element, rule), (space, None), cell, density);
        let velocity = |x: Vec3| match space {
            // no other motion of a body of revolution is rigid
            Idealisation::Axisymmetric => Vec3::new(0.0, 3.0, 0.0),
            _ => Vec3::new(0.3, -1.0, 0.0) + Vec3::unit(2).cross(x) * 0.7,
        };
        let mut exact = 0.0;
        let mut x = Vec::new();
        for (patch, piece) in region.pieces() {
            x.extend(piece.nodes.iter().map(|&n| single.reference[n as usize]));
            for sample in patch.samples() {
                let mass = patch.volume(&piece, &sample, &x);
                exact += 0.5 * mass * velocity(sample.position(&x)).norm_squared();
            }
        }
        mass::matrices(&region, &single.reference, |nodes, matrix| {
            let v: Vec<Vec3> = nodes
                .iter()
                .map(|&n| velocity(single.reference[n as usize]))
                .collect();
            let mut energy = 0.0;
            for (row, v_i) in matrix.chunks_exact(nodes.len()).zip(&v) {
                for (m, v_j) in row.iter().zip(&v) {
                    energy += 0.5 * m * v_i.dot(*v_j);
                }
            }
            let name = element.name();
            assert!((energy - exact).abs() < 1e-13 * exact, "{name} {space:?}");
            let mut lumped = Vec::new();
            mass::lump(matrix, &mut lumped);
            let (all, sum): (f64, f64) = (matrix.iter().sum(), lumped.iter().sum());
            assert!(lumped.iter().all(|m| *m > 0.0), "{name}: {lumped:?}");
            assert!((all - sum).abs() < 1e-14 * all, "{name}");
        });
    }
}

/// Hinton, Rock and Zienkiewicz 1976: shares of the corners of undistorted elements.
#[test]
fn lumped_masses_are_those_of_the_paper() {
    let shares = [
        ("tri3", 1.0 / 3.0),
        ("tri6", 1.0 / 19.0),
        ("quad4", 0.25),
        ("quad8", 3.0 / 76.0),
        ("quad9", 1.0 / 36.0),
        ("tet4", 0.25),
        ("tet10", 1.0 / 36.0),
        ("hex8", 0.125),
        ("hex20", 7.0 / 248.0),
        ("hex27", 1.0 / 216.0),
        ("wedge15", 1.0 / 34.0),
    ];
    for (name, share) in shares {
        let element = by_name(name).unwrap();
        let space = match element.dim() {
            2 => Idealisation::PlaneStrain { thickness: 1.0 },
            _ => Idealisation::Space,
        };
        let single = Single::new(element, space, 0.0);
        let mut masses = Vec::new();
        let mut region = Region::default();
        let (rule, cell) = (element.rules().mass, single.mesh.cell(single.cell));
        region.push_by((element, rule), (space, None), cell, 1.0);
        mass::matrices(&region, &single.reference, |_, matrix| {
            mass::lump(matrix, &mut masses);
        });
        let all: f64 = masses.iter().sum();
        for corner in &masses[..element.ncorner()] {
            assert!((corner / all - share).abs() < 1e-13, "{name}: {corner}");
        }
    }
}
