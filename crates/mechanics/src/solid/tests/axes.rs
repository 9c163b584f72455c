//! Axes of materials that vary in a body.

use super::*;
use crate::material::Oriented;
use crate::solid::{Cylindrical, MaterialAxes};
use signorini_geometry::tensor::turn_about;

/// A body of an orthotropic law with these axes, or with those that a law brings.
fn with(mesh: &Mesh, wish: &Wish, axes: Option<MaterialAxes>) -> Result<Body, SolidError> {
    let law = TABLE.iter().find(|l| l.name == "orthotropic").unwrap();
    let law = (law.make)(&Constants::sample()).unwrap();
    of_law(mesh, wish, Box::new(Oriented::at_points(law)), axes)
}

fn of_law(
    mesh: &Mesh,
    wish: &Wish,
    material: Box<dyn Material>,
    axes: Option<MaterialAxes>,
) -> Result<Body, SolidError> {
    let plain = body(mesh, elastic("linear-elastic", 0.3), wish)?;
    let cells: Vec<_> = mesh.cells(wish.space.ndim()).collect();
    let mut solid = Solid::new(SolidParts {
        name: "body",
        mesh,
        reference: plain.reference.clone(),
        cells: &cells,
        layout: plain.layout,
        space: wish.space,
        profile: None,
        material,
        integration: wish.integration,
        locking: wish.locking,
        temperature: None,
        linear_temperatures: false,
        at_nodes: Default::default(),
        initial: &[],
        axes,
        directors: &Directors::default(),
    })?;
    solid.set_kinematics(wish.kinematics);
    Ok(Body { solid, ..plain })
}

/// Around a line that no element comes near.
fn around(space: Idealisation) -> MaterialAxes {
    let along = match space {
        Idealisation::Space => Vec3::new(0.2, -0.3, 1.0),
        _ => Vec3::unit(2),
    };
    let line = Cylindrical::new(Vec3::new(-3.0, -2.5, 0.4), along).unwrap();
    MaterialAxes::Cylindrical(line.turned(turn_about(2, 25.0)))
}

fn displacements(body: &Body) -> Vec<f64> {
    (0..body.layout.ndof())
        .map(|k| 0.03 * noise(k + 50))
        .collect()
}

#[test]
fn stiffness_is_that_of_forces_where_axes_vary_from_point_to_point() {
    for (element, space) in elements() {
        let mesh = one(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let wish = Wish::plain(space, kinematics);
            let body = with(&mesh, &wish, Some(around(space))).unwrap();
            let (u, mut work) = (displacements(&body), Work::default());
            let at = body.assemble(&u, Order::Tangent, &mut work);
            let (n, h) = (body.layout.ndof(), 1e-5);
            for j in 0..n {
                let mut moved = |d: f64| {
                    let mut shifted = u.clone();
                    shifted[j] += d;
                    body.assemble(&shifted, Order::Residual, &mut work).force
                };
                let (ahead, behind) = (moved(h), moved(-h));
                for i in 0..n {
                    let k = (ahead[i] - behind[i]) / (2.0 * h);
                    let error = (k - at.stiffness[i * n + j]).abs();
                    assert!(error < 1e-6 * at.scale(), "{} {space:?}", element.name());
                }
            }
        }
    }
}

#[test]
fn axes_that_are_the_same_everywhere_are_those_of_an_oriented_law_however_they_are_given() {
    let (x, y) = (Vec3::new(1.0, 2.0, 0.0), Vec3::new(-1.0, 0.5, 0.0));
    let first = x.normalized().unwrap();
    let third = x.cross(y).normalized().unwrap();
    let axes = Mat3::from_rows([first, third.cross(first), third]);
    for (element, space) in elements() {
        let mesh = one(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let wish = Wish::plain(space, kinematics);
            let law = TABLE.iter().find(|l| l.name == "orthotropic").unwrap();
            let law = (law.make)(&Constants::sample()).unwrap();
            let fixed = Box::new(Oriented::new(law, x, y).unwrap());
            let fixed = of_law(&mesh, &wish, fixed, None).unwrap();
            let mut work = Work::default();
            let u = displacements(&fixed);
            let expected = fixed.assemble(&u, Order::Tangent, &mut work);
            for given in [
                MaterialAxes::Uniform(axes),
                MaterialAxes::OfCells(vec![axes]),
            ] {
                let body = with(&mesh, &wish, Some(given)).unwrap();
                let found = body.assemble(&u, Order::Tangent, &mut work);
                let pairs = found.stiffness.iter().zip(&expected.stiffness);
                let pairs = pairs.chain(found.force.iter().zip(&expected.force));
                for (a, b) in pairs {
                    assert!(
                        (a - b).abs() < 1e-12 * expected.scale(),
                        "{}",
                        element.name()
                    );
                }
            }
            let none = with(&mesh, &wish, None).unwrap();
            let other = none.assemble(&u, Order::Residual, &mut work);
            let pairs = other.force.iter().zip(&expected.force);
            let differs = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(
                differs > 1e-3 * expected.scale() * 0.03,
                "{}",
                element.name()
            );
        }
    }
}

#[test]
fn cells_that_are_evaluated_together_have_each_its_own_axes() {
    let law = || {
        let law = TABLE.iter().find(|l| l.name == "orthotropic").unwrap();
        let law = (law.make)(&Constants::sample()).unwrap();
        Box::new(Oriented::at_points(law)) as Box<dyn Material>
    };
    let turn = |k: usize| Mat3::rotation(Vec3::new(noise(k), noise(k + 1), noise(k + 2)) * 3.0);
    for name in ["hex8", "tet10"] {
        let mesh = batch::cells(element::by_name(name).unwrap(), 11);
        let axes = MaterialAxes::OfCells((0..11).map(|k| turn(7 * k)).collect());
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let wish = Wish::plain(Idealisation::Space, kinematics);
            let together = of_law(&mesh, &wish, law(), Some(axes.clone())).unwrap();
            // a law that is not symmetric is asked one cell after the other
            let alone = batch::Hidden {
                law: law(),
                is_symmetric: false,
            };
            let alone = of_law(&mesh, &wish, Box::new(alone), Some(axes.clone())).unwrap();
            let (u, mut work) = (displacements(&alone), Work::default());
            let expected = alone.assemble(&u, Order::Tangent, &mut work);
            let found = together.assemble(&u, Order::Tangent, &mut work);
            for (a, b) in found.stiffness.iter().zip(&expected.stiffness) {
                assert!((a - b).abs() < 1e-12 * expected.scale(), "{name}");
            }
        }
    }
}

#[test]
fn a_body_turned_about_the_axis_of_its_material_has_the_turned_forces() {
    let space = Idealisation::Space;
    let line = Cylindrical::new(Vec3::new(-3.0, -2.5, 0.0), Vec3::unit(2)).unwrap();
    let turn = Mat3::rotation(Vec3::new(0.0, 0.0, 1.1));
    for name in ["hex8", "tet10"] {
        let mesh = one(element::by_name(name).unwrap(), space);
        let mut turned_mesh = mesh.clone();
        let centre = Vec3::new(-3.0, -2.5, 0.0);
        for x in &mut turned_mesh.points {
            *x = turn * (*x - centre) + centre;
        }
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let wish = Wish::plain(space, kinematics);
            let axes = || Some(MaterialAxes::Cylindrical(line));
            let body = with(&mesh, &wish, axes()).unwrap();
            let other = with(&turned_mesh, &wish, axes()).unwrap();
            let u = displacements(&body);
            let rotate = |u: &[f64]| -> Vec<f64> {
                let nodes = u.chunks_exact(3);
                let turned = nodes.map(|u| turn * Vec3::new(u[0], u[1], u[2]));
                turned.flat_map(Vec3::to_array).collect()
            };
            let mut work = Work::default();
            let force = body.assemble(&u, Order::Residual, &mut work).force;
            let found = other
                .assemble(&rotate(&u), Order::Residual, &mut work)
                .force;
            let size = force.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
            for (a, b) in rotate(&force).iter().zip(&found) {
                assert!((a - b).abs() < 1e-12 * size, "{name}");
            }
        }
    }
}

#[test]
fn samples_know_the_axes_of_their_points_and_a_point_on_the_axis_is_refused() {
    for (element, space) in elements() {
        let mesh = one(element, space);
        let wish = Wish::plain(space, Kinematics::Small);
        let body = with(&mesh, &wish, Some(around(space))).unwrap();
        let cells: Vec<_> = mesh.cells(space.ndim()).collect();
        let sampled = |body: &Body| {
            let mut samples = crate::system::Samples::default();
            let state = body.state(&displacements(body));
            body.solid.sample(&state, &cells, &mut samples).unwrap();
            samples
                .of(cells[0])
                .map(|(rule, s)| (rule, s.to_vec()))
                .unwrap()
        };
        let (rule, samples) = sampled(&body);
        let MaterialAxes::Cylindrical(line) = around(space) else {
            panic!("{space:?}");
        };
        let mut shape = vec![0.0; element.nnode()];
        let mut places = Vec::new();
        for (xi, sample) in rule.points.iter().zip(&samples) {
            element.shape(xi, &mut shape);
            let pairs = shape.iter().zip(&mesh.points);
            let place = pairs.fold(Vec3::ZERO, |sum, (n, x)| sum + *x * *n);
            let expected = line.at(place, 1.0).unwrap();
            let off = sample.axes.unwrap() - expected;
            assert!(off.rows.iter().all(|row| row.max_abs() < 1e-13));
            places.push(place);
        }
        let plain = with(&mesh, &wish, None).unwrap();
        assert!(sampled(&plain).1.iter().all(|s| s.axes.is_none()));
        let through = Cylindrical::new(places[0], Vec3::unit(2)).unwrap();
        let refused = with(&mesh, &wish, Some(MaterialAxes::Cylindrical(through)));
        let Some(SolidError::OnAxis { label, .. }) = refused.err() else {
            panic!("{}", element.name());
        };
        assert_eq!(label, 7);
    }
    assert!(Cylindrical::new(Vec3::ZERO, Vec3::ZERO).is_none());
    assert!(Cylindrical::new(Vec3::new(f64::NAN, 0.0, 0.0), Vec3::unit(0)).is_none());
}
