//! Values at integration points against what the displacements say there, written down afresh.

use super::*;
use crate::system::PointSample;
use signorini_geometry::element::quadrature::Rule;

/// The displacement gradient at a point of a cell, where the point is, and the volume that belongs to it.
fn gradient(
    body: &Body,
    element: Element,
    space: Idealisation,
    u: &[f64],
    (xi, weight): (Vec3, f64),
) -> (Mat3, Vec3, f64) {
    let n = element.nnode();
    let (mut shape, mut slopes) = (vec![0.0; n], vec![Vec3::ZERO; n]);
    element.shape(&xi, &mut shape);
    element.dshape(&xi, &mut slopes);
    let ndim = space.ndim();
    let moved = |node: usize| {
        let of = |axis: usize| {
            if axis < ndim {
                u[node * ndim + axis]
            } else {
                0.0
            }
        };
        Vec3::new(of(0), of(1), of(2))
    };
    let mut jacobian = Mat3::ZERO;
    let (mut at, mut there) = (Vec3::ZERO, Vec3::ZERO);
    for (node, slope) in slopes.iter().enumerate() {
        at += body.reference[node] * shape[node];
        there += moved(node) * shape[node];
        let rows = jacobian.rows.iter_mut().zip(slope.to_array());
        for (row, slope) in rows.take(ndim) {
            *row += body.reference[node] * slope;
        }
    }
    if ndim == 2 {
        jacobian.rows[2] = Vec3::unit(2);
    }
    let (inverse, det) = jacobian.inverse().unwrap();
    let mut h = Mat3::ZERO;
    for (node, slope) in slopes.iter().enumerate() {
        let slope = inverse * *slope;
        for (row, moved) in h.rows.iter_mut().zip(moved(node).to_array()) {
            *row += slope * moved;
        }
    }
    if space == Idealisation::Axisymmetric {
        h.rows[2].z = there.x / at.x;
    }
    (h, at, weight * det * space.extent(at))
}

fn samples(solid: &Solid, at: &State, mesh: &Mesh) -> (&'static Rule, Vec<PointSample>) {
    let mut samples = Samples::default();
    let cells: Vec<_> = mesh.cells(mesh.dim()).collect();
    solid.sample(at, &cells, &mut samples).unwrap();
    let (rule, values) = samples.of(cells[0]).unwrap();
    (rule, values.to_vec())
}

fn close(a: Sym3, b: Sym3, size: f64) -> bool {
    (a - b).to_pairs().iter().all(|d| d.abs() < 1e-12 * size)
}

#[test]
fn samples_are_strain_stress_energy_and_volume_of_the_displacements() {
    let (young, nu) = (500.0, 0.3);
    let (mu, lambda) = (young / 2.6, young * nu / (1.3 * 0.4));
    for (element, space) in elements() {
        let sheet = matches!(space, Idealisation::PlaneStress { .. });
        let mesh = one(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let wish = Wish::plain(space, kinematics);
            let body = body(&mesh, elastic("linear-elastic", nu), &wish).unwrap();
            let u: Vec<f64> = (0..body.layout.ndof())
                .map(|k| 0.05 * noise(k + 3))
                .collect();
            let (rule, values) = samples(&body.solid, &body.state(&u), &mesh);
            assert_eq!(values.len(), rule.npoint());
            let mut energy = 0.0;
            for ((xi, weight), got) in rule.iter().zip(&values) {
                let (h, _, volume) = gradient(&body, element, space, &u, (*xi, weight));
                let mut strain = Sym3::symmetric_part(h);
                let mut f = Mat3::IDENTITY + h;
                if kinematics == Kinematics::Finite {
                    strain = strain + Sym3::gram(h) * 0.5;
                }
                if sheet {
                    let [xx, yy, _, xy, yz, xz] = strain.to_pairs();
                    let across = -nu / (1.0 - nu) * (xx + yy);
                    strain = Sym3::from_pairs([xx, yy, across, xy, yz, xz]);
                    f.rows[2].z = (1.0 + 2.0 * across).sqrt();
                }
                let mut stress = strain * (2.0 * mu) + Sym3::IDENTITY * (lambda * strain.trace());
                let density = 0.5 * stress.double_dot(strain);
                if kinematics == Kinematics::Finite {
                    stress = stress.congruence(f) * f.determinant().recip();
                }
                let name = element.name();
                assert!(close(got.strain, strain, 1.0), "{name} {space:?}");
                assert!(close(got.stress, stress, young), "{name} {space:?}");
                assert_eq!(got.mechanical_strain, got.strain);
                assert_eq!(got.plastic_strain, 0.0);
                assert!((got.volume - volume).abs() < 1e-12 * volume, "{name}");
                assert!((got.energy - density).abs() < 1e-12 * young, "{name}");
                energy += got.energy * got.volume;
            }
            let whole = body.energy(&u, &mut Work::default());
            assert!((energy - whole).abs() < 1e-12 * whole);
        }
    }
}

#[test]
fn only_cells_that_are_wanted_are_sampled() {
    let mesh = locking::grid(element::by_name("quad4").unwrap(), [2, 2, 1], |x| x);
    let plane = Idealisation::PlaneStrain { thickness: 1.0 };
    let wish = Wish::plain(plane, Kinematics::Small);
    let body = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
    let cells: Vec<_> = mesh.cells(2).collect();
    let at = body.state(&vec![0.0; body.layout.ndof()]);
    let mut samples = Samples::default();
    body.solid.sample(&at, &cells[1..3], &mut samples).unwrap();
    let sampled = cells.iter().map(|cell| samples.of(*cell).is_some());
    assert_eq!(sampled.collect::<Vec<_>>(), [false, true, true, false]);
}

#[test]
fn thermal_growth_is_no_mechanical_strain() {
    let space = Idealisation::Space;
    let element = element::by_name("hex20").unwrap();
    let mesh = one(element, space);
    for nonlinear in [false, true] {
        let wish = Wish::plain(space, Kinematics::Small);
        let plain = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
        let heat = |x: &Vec3| 20.0 + 100.0 * x.x;
        let row: Vec<f64> = plain.reference.iter().map(heat).collect();
        let cells: Vec<_> = mesh.cells(3).collect();
        let law = Expanding::new(elastic("linear-elastic", 0.3), 1e-4, 20.0);
        let mut solid = Solid::new(SolidParts {
            name: "body",
            mesh: &mesh,
            reference: plain.reference.clone(),
            cells: &cells,
            layout: plain.layout,
            space,
            profile: None,
            material: Box::new(law),
            integration: Integration::Full,
            locking: Locking::None,
            temperature: Some(Arc::new(NodalField {
                ends: vec![row.clone(), row],
            })),
            linear_temperatures: false,
            at_nodes: Default::default(),
            initial: &[],
            axes: None,
            directors: &crate::system::Directors::default(),
        })
        .unwrap();
        let u: Vec<f64> = (0..plain.layout.ndof()).map(|k| 0.02 * noise(k)).collect();
        let at = plain.state(&u);
        let step = StepContext {
            nonlinear,
            ..StepContext::default()
        };
        solid.begin(&Phase::of_step(step), &at).unwrap();
        let (rule, values) = samples(&solid, &at, &mesh);
        for ((xi, weight), got) in rule.iter().zip(&values) {
            let (_, x, _) = gradient(&plain, element, space, &u, (*xi, weight));
            let grown = 1e-4 * (heat(&x) - 20.0);
            let theta = 1.0 + grown;
            let wanted = match nonlinear {
                false => got.strain - Sym3::IDENTITY * grown,
                true => {
                    let free = Sym3::IDENTITY * (0.5 * (theta * theta - 1.0));
                    (got.strain - free) * (theta * theta).recip()
                }
            };
            assert!(close(got.mechanical_strain, wanted, 1.0));
        }
    }
}

#[test]
fn plastic_points_tell_their_strain_and_the_work_spent() {
    let space = Idealisation::Space;
    let mesh = one(element::by_name("hex8").unwrap(), space);
    let wish = Wish::plain(space, Kinematics::Small);
    let mut body = body(&mesh, derivatives::plastic(), &wish).unwrap();
    // uniaxial stress: σ = 8 + 22 p, elastic strain σ/500, axial strain σ/500 + p
    let p = 0.1;
    let stress = 8.0 + 22.0 * p;
    let (axial, lateral) = (stress / 500.0 + p, -0.3 * stress / 500.0 - 0.5 * p);
    let u = body.field(|x| Vec3::new(lateral * x.x, lateral * x.y, axial * x.z));
    let at = body.state(&u);
    body.solid.accept(&at).unwrap();
    let (_, values) = samples(&body.solid, &at, &mesh);
    let work = 0.5 * stress * stress / 500.0 + 0.5 * (8.0 + stress) * p;
    for got in values {
        assert!((got.plastic_strain - p).abs() < 1e-12);
        assert!((got.energy - work).abs() < 1e-11 * work);
        assert!(close(got.stress, Sym3::diagonal(0.0, 0.0, stress), 100.0));
    }
}
