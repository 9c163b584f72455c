//! What points have at the start, and how temperatures vary.

use super::*;
use crate::material::Expanding;
use crate::system::NodalField;

/// The same body with something at the start of its points, or with temperatures.
fn with(
    mesh: &Mesh,
    wish: &Wish,
    initial: &[AtStart],
    heat: Option<(&[f64], bool)>,
) -> Result<Body, SolidError> {
    let plain = body(mesh, elastic("linear-elastic", 0.3), wish)?;
    let cells: Vec<_> = mesh.cells(wish.space.ndim()).collect();
    let law = Expanding::new(elastic("linear-elastic", 0.3), 1e-3, 0.0);
    let field = |row: &[f64]| NodalField {
        ends: vec![row.to_vec(), row.to_vec()],
    };
    let mut solid = Solid::new(SolidParts {
        name: "body",
        mesh,
        reference: plain.reference.clone(),
        cells: &cells,
        layout: plain.layout,
        space: wish.space,
        profile: None,
        material: Box::new(law),
        integration: wish.integration,
        locking: wish.locking,
        temperature: heat.map(|(row, _)| Arc::new(field(row))),
        linear_temperatures: heat.is_some_and(|(_, linear)| linear),
        at_nodes: Default::default(),
        initial,
        axes: None,
        directors: &crate::system::Directors::default(),
    })?;
    solid.set_kinematics(wish.kinematics);
    Ok(Body { solid, ..plain })
}

/// The same stress and strain at all points of the only cell.
fn everywhere(mesh: &Mesh, npoint: usize, stress: Sym3, strain: Sym3) -> Vec<AtStart> {
    let cell = mesh.cells(mesh.dim()).next().unwrap();
    let at = |point| AtStart {
        cell,
        point,
        stress,
        strain,
    };
    (0..npoint).map(at).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

const TENSOR: Sym3 = Sym3::new(0.02, -0.01, 0.015, 0.004, -0.006, 0.003);

#[test]
fn a_strain_at_the_start_leaves_no_stress_where_nodes_follow_it() {
    for name in ["hex8", "hex20", "tet10"] {
        let element = element::by_name(name).unwrap();
        let mesh = one(element, Idealisation::Space);
        let wish = Wish::plain(Idealisation::Space, Kinematics::Small);
        let npoint = element.full_rule().npoint();
        let initial = everywhere(&mesh, npoint, Sym3::ZERO, TENSOR);
        let body = with(&mesh, &wish, &initial, None).unwrap();
        let mut work = Work::default();
        let held = body.assemble(&vec![0.0; body.layout.ndof()], Order::Residual, &mut work);
        let u = body.field(|x| TENSOR.to_mat3() * x);
        let free = body.assemble(&u, Order::Residual, &mut work);
        assert!(largest(&held.force) > 1.0, "{name}");
        assert!(largest(&free.force) < 1e-12, "{name}");
    }
}

#[test]
fn a_stress_at_the_start_adds_to_that_of_the_strain() {
    let mesh = one(element::by_name("hex20").unwrap(), Idealisation::Space);
    let stress = TENSOR * 1e3;
    for integration in [Integration::Full, Integration::Reduced] {
        let wish = Wish {
            integration,
            ..Wish::plain(Idealisation::Space, Kinematics::Small)
        };
        let npoint = match integration {
            Integration::Full | Integration::Raised => 27,
            Integration::Reduced | Integration::Through(_) => 8,
        };
        let initial = everywhere(&mesh, npoint, stress, Sym3::ZERO);
        let [plain, body] = [&[][..], &initial].map(|at| with(&mesh, &wish, at, None).unwrap());
        let u: Vec<f64> = (0..body.layout.ndof()).map(|k| 0.02 * noise(k)).collect();
        let [a, b] = [&plain, &body].map(|body| {
            let mut samples = Samples::default();
            let cells: Vec<_> = mesh.cells(3).collect();
            body.solid
                .sample(&body.state(&u), &cells, &mut samples)
                .unwrap();
            samples.of(cells[0]).unwrap().1.to_vec()
        });
        assert_eq!(a.len(), npoint);
        for (a, b) in a.iter().zip(&b) {
            let left = (b.stress - a.stress - stress).to_pairs();
            assert!(largest(&left) < 1e-10);
        }
    }
}

#[test]
fn forces_of_what_is_there_at_the_start_are_the_slope_of_the_energy() {
    for (element, space) in
        elements().filter(|(_, s)| !matches!(s, Idealisation::PlaneStress { .. }))
    {
        let mesh = one(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let wish = Wish::plain(space, kinematics);
            let initial = everywhere(&mesh, 1, TENSOR * 1e3, TENSOR);
            let body = with(&mesh, &wish, &initial, None).unwrap();
            let mut work = Work::default();
            let u: Vec<f64> = (0..body.layout.ndof()).map(|k| 0.02 * noise(k)).collect();
            let force = body.assemble(&u, Order::Residual, &mut work).force;
            for k in [0, u.len() / 2, u.len() - 1] {
                let mut energy = |step: f64| {
                    let mut u = u.clone();
                    u[k] += step;
                    body.energy(&u, &mut work)
                };
                let h = 1e-3;
                let slope = (8.0 * (energy(h) - energy(-h)) - energy(2.0 * h) + energy(-2.0 * h))
                    / (12.0 * h);
                let error = (slope - force[k]).abs();
                assert!(
                    error < 1e-7 * largest(&force),
                    "{} {space:?} {kinematics:?}",
                    element.name()
                );
            }
        }
    }
}

#[test]
fn a_point_that_an_element_does_not_have_is_an_error() {
    let mesh = one(element::by_name("hex8").unwrap(), Idealisation::Space);
    let wish = Wish::plain(Idealisation::Space, Kinematics::Small);
    let initial = everywhere(&mesh, 9, TENSOR, TENSOR);
    let error = with(&mesh, &wish, &initial, None).err().unwrap();
    assert!(
        matches!(
            error,
            SolidError::NoPoint {
                npoint: 8,
                point: 9,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn linear_temperatures_are_those_of_the_reduced_points_continued() {
    for name in ["quad8", "hex20"] {
        let element = element::by_name(name).unwrap();
        let space = match element.dim() {
            3 => Idealisation::Space,
            _ => Idealisation::PlaneStrain { thickness: 1.0 },
        };
        let mesh = one(element, space);
        let wish = Wish::plain(space, Kinematics::Small);
        let odd: Vec<f64> = (0..element.nnode()).map(|k| 10.0 * noise(k)).collect();
        let body = with(&mesh, &wish, &[], Some((&odd, true))).unwrap();
        let u = vec![0.0; body.layout.ndof()];
        let mut samples = Samples::default();
        let cells: Vec<_> = mesh.cells(element.dim()).collect();
        body.solid
            .sample(&body.state(&u), &cells, &mut samples)
            .unwrap();
        let (rule, values) = samples.of(cells[0]).unwrap();
        // a held body has the stress −3 K α T, K = 500/(3 · 0.4), in all three directions
        let heat: Vec<f64> = values
            .iter()
            .map(|at| -at.stress.xx() * 0.4 / (500.0 * 1e-3))
            .collect();
        // the rule has ends and middle on each axis: linear in between
        let ends: Vec<(Vec3, f64)> = (rule.points.iter().zip(&heat))
            .filter(|(xi, _)| (0..element.dim()).all(|a| xi[a] != 0.0))
            .map(|(xi, t)| (*xi, *t))
            .collect();
        assert_eq!(ends.len(), 1 << element.dim());
        let linear = |at: &Vec3| -> f64 {
            let share = |end: &Vec3| -> f64 {
                (0..element.dim())
                    .map(|a| 0.5 * (1.0 + at[a] / end[a]))
                    .product()
            };
            ends.iter().map(|(end, t)| share(end) * t).sum()
        };
        for (xi, t) in rule.points.iter().zip(&heat) {
            assert!((linear(xi) - t).abs() < 1e-11, "{name}");
        }
        let mut shape = vec![0.0; element.nnode()];
        for q in element.reduced_rule().points {
            element.shape(q, &mut shape);
            let wanted: f64 = shape.iter().zip(&odd).map(|(n, t)| n * t).sum();
            assert!((linear(q) - wanted).abs() < 1e-11, "{name}");
        }
    }
}
