//! Sums of forces and moments, in closed form.

use super::*;
use signorini_geometry::element::quadrature::Rule;
use std::f64::consts::{PI, TAU};

/// Area of the model's plane and its centre, or volume.
fn measure(single: &Single) -> (f64, Vec3) {
    let space = match single.space {
        Idealisation::Space => Idealisation::Space,
        _ => Idealisation::PlaneStrain { thickness: 1.0 },
    };
    let mut sum = (0.0, Vec3::ZERO);
    let mut region = Region::default();
    region.push(single.element, space, single.mesh.cell(single.cell), 1.0);
    for (patch, piece) in region.pieces() {
        for sample in patch.samples() {
            let dv = patch.volume(&piece, &sample, &single.reference);
            sum.0 += dv;
            sum.1 += sample.position(&single.reference) * dv;
        }
    }
    (sum.0, sum.1 / sum.0)
}

#[test]
fn pressure_on_a_closed_curved_surface_has_no_resultant() {
    for (element, space) in cases() {
        // deformed at random: the sides are warped, and those of quadratic elements curved
        let single = Single::new(element, space, 0.15);
        let mut pressure = single.pressure(single.surface(), 3.0);
        pressure
            .begin(&Phase::of_step(step(true)), &single.state(&[]))
            .unwrap();
        let u: Vec<f64> = (0..single.layout.ndof())
            .map(|k| 0.1 * noise(7 + k))
            .collect();
        let [force, moment] = single.resultant(&pressure, &single.state(&u));
        let what = format!("{} {space:?}", element.name());
        if space == Idealisation::Axisymmetric {
            // what remains of a ring is the hoop force: −p · 2π · area of the section, by Gauss's theorem
            let mut moved = Single::new(element, space, 0.15);
            moved.reference = single.state(&u).x.clone().into();
            let hoop = Vec3::unit(0) * (-3.0 * TAU * measure(&moved).0);
            assert_near(force, hoop, 1e-11 * hoop.norm(), &what);
            continue;
        }
        assert_near(force, Vec3::ZERO, 1e-12, &what);
        assert_near(moment, Vec3::ZERO, 1e-11, &what);
    }
}

#[test]
fn masses_are_integrated_by_the_rule_that_they_are_given() {
    let element = element::by_name("hex20").unwrap();
    let single = Single::new(element, Idealisation::Space, 0.2);
    let x = &single.reference;
    let mass = |rule: &'static Rule| {
        let mut region = Region::default();
        region.push_by(
            (element, rule),
            (single.space, None),
            single.mesh.cell(single.cell),
            2.0,
        );
        let forces = spread::over_cells(&region, x, Vec3::unit(0));
        forces.values().map(|f| f.x).sum::<f64>()
    };
    let by_hand = |rule: &'static Rule| {
        let mut slopes = [Vec3::ZERO; 20];
        let at = rule.iter().map(|(xi, weight)| {
            element.dshape(xi, &mut slopes);
            let mut rows = [Vec3::ZERO; 3];
            for (x, slope) in x.iter().zip(&slopes) {
                for (row, slope) in rows.iter_mut().zip(slope.to_array()) {
                    *row += *x * slope;
                }
            }
            2.0 * weight * rows[0].cross(rows[1]).dot(rows[2])
        });
        at.sum::<f64>()
    };
    let rules = [element.surface_rule(), element.reduced_rule()];
    let [full, reduced] = rules.map(mass);
    assert_near(
        Vec3::unit(0) * full,
        Vec3::unit(0) * by_hand(rules[0]),
        1e-12,
        "full",
    );
    assert_near(
        Vec3::unit(0) * reduced,
        Vec3::unit(0) * by_hand(rules[1]),
        1e-12,
        "reduced",
    );
    assert!((full - reduced).abs() > 1e-6);
}

#[test]
fn dead_and_following_pressure_agree_at_the_start() {
    for (element, space) in cases() {
        let single = Single::new(element, space, 0.1);
        let x = &single.reference;
        for side in 0..element.sides().len() {
            let face = single.face(side);
            let dead = single.dead(spread::over_faces(&face, x, |n| n * -2.5));
            let follows = single.pressure(face, 2.5);
            let start = single.state(&[]);
            let [a, b] = [&dead as &dyn Term, &follows]
                .map(|term| response(term, &single.layout, &start).residual);
            let error = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
            assert!(error.fold(0.0, f64::max) < 1e-14, "{}", element.name());
        }
    }
}

#[test]
fn a_total_force_is_spread_without_loss_and_evenly() {
    for (element, space) in cases() {
        let single = Single::new(element, space, 0.1);
        let (faces, x) = (single.surface(), &single.reference);
        let total = Vec3::new(3.0, -2.0, if space.ndim() == 3 { 1.0 } else { 0.0 });
        let area = spread::area(&faces, x);
        let forces = spread::over_faces(&faces, x, |n| total * (n.norm() / area));
        let sum: Vec3 = forces.values().copied().sum();
        assert_near(sum, total, 1e-13, element.name());
    }
    // a unit cube from 1 to 3: 6 sides of 4; the lateral face of a ring: 2πr h
    let cube = Single::new(element::by_name("hex8").unwrap(), Idealisation::Space, 0.0);
    let area = spread::area(&cube.surface(), &cube.reference);
    assert!((area - 24.0).abs() < 1e-13, "{area}");
    let quad = element::by_name("quad8").unwrap();
    let ring = Single::new(quad, Idealisation::Axisymmetric, 0.0);
    let area = spread::area(&ring.face(1), &ring.reference);
    assert!((area - TAU * 3.0 * 2.0).abs() < 1e-13, "{area}");
}

#[test]
fn gravity_is_mass_times_acceleration_at_the_centre_of_mass() {
    let g = Vec3::new(0.0, -9.81, 0.0);
    for (element, space) in cases() {
        let single = Single::new(element, space, 0.1);
        let forces = spread::over_cells(&single.volume(7.8), &single.reference, g);
        let (measure, centre) = measure(&single);
        // Pappus: a ring has the volume 2π r A
        let volume = measure * space.extent(centre);
        let what = format!("{} {space:?}", element.name());
        let sum: Vec3 = forces.values().copied().sum();
        assert_near(sum, g * (7.8 * volume), 1e-12 * sum.norm(), &what);
        if space != Idealisation::Axisymmetric {
            let term = single.dead(forces);
            let [force, moment] = single.resultant(&term, &single.state(&[]));
            // the linear tetrahedron and triangle included: their rules integrate the arm, too
            assert_near(moment, centre.cross(force), 1e-12 * moment.norm(), &what);
        }
    }
}

#[test]
fn a_column_of_water_rests_on_its_pressure() {
    // a column of height 2: pressure ρ g h on its base carries its weight
    let (density, g, height) = (1000.0, 9.81, 2.0);
    for (name, side) in [("hex8", 0), ("hex20", 0), ("quad4", 0), ("quad8", 0)] {
        let element = element::by_name(name).unwrap();
        for space in spaces(element) {
            let single = Single::new(element, space, 0.0);
            let down = Vec3::unit(space.ndim() - 1) * -g;
            let x = &single.reference;
            let weight = spread::over_cells(&single.volume(density), x, down);
            let pressure = density * g * height;
            let support = spread::over_faces(&single.face(side), x, |n| n * -pressure);
            let sum: Vec3 = weight.values().chain(support.values()).copied().sum();
            assert_near(sum, Vec3::ZERO, 1e-11 * pressure, name);
        }
    }
}

#[test]
fn centrifugal_forces_of_a_bar_and_of_a_disc_are_those_of_the_closed_forms() {
    // a bar from x = 1 to x = 3 about the z axis through the origin: ρ ω² A (9 − 1)/2, whatever it is made of
    let spin = Spin {
        speed: 3.0,
        point: Vec3::ZERO,
        axis: Vec3::unit(2),
    };
    let line = element::by_name("line2").unwrap();
    let solids = element::TABLE
        .into_iter()
        .filter(|e| ["quad", "hex"].iter().any(|f| e.name().starts_with(f)));
    for element in solids.chain([line]) {
        let space = match element.dim() {
            2 => Idealisation::PlaneStrain { thickness: 0.5 },
            _ => Idealisation::Space,
        };
        let single = Single::new(element, space, 0.0);
        let section = [0.3, 2.0 * 0.5, 4.0][element.dim() - 1];
        let factor = if element.dim() == 1 { section } else { 1.0 };
        let mut term = single.centrifugal(2.0 * factor, spin);
        for (nonlinear, stretch) in [(false, 1.0), (true, 1.2)] {
            term.begin(&Phase::of_step(step(nonlinear)), &single.state(&[]))
                .unwrap();
            let n = single.layout.ndim();
            let mut u = vec![0.0; single.layout.ndof()];
            for (node, x) in single.reference.iter().enumerate() {
                u[n * node] = 0.2 * x.x;
            }
            let [force, _] = single.resultant(&term, &single.state(&u));
            let exact = 2.0 * section * 9.0 * 4.0 * stretch;
            assert!(
                (force.x - exact).abs() < 1e-12 * exact,
                "{} {force:?}",
                element.name()
            );
            assert!(force.y.abs() < 1e-12 * exact);
        }
    }
    // a disc of height 2 from r = 1 to 3 about its axis: ∫ ρω² r · 2πr dr · h
    let about = Spin {
        axis: Vec3::unit(1),
        ..spin
    };
    for name in ["quad4", "quad8", "quad9"] {
        let element = element::by_name(name).unwrap();
        let single = Single::new(element, Idealisation::Axisymmetric, 0.0);
        let term = single.centrifugal(2.0, about);
        let [force, _] = single.resultant(&term, &single.state(&[]));
        let exact = 2.0 * 9.0 * TAU * (27.0 - 1.0) / 3.0 * 2.0;
        assert!(
            (force.x - exact).abs() < 1e-12 * exact,
            "{name} {force:?} {exact}"
        );
    }
}

#[test]
fn centrifugal_forces_of_a_tetrahedron_have_the_exact_moment() {
    // about an oblique axis through the origin: ∫ ρω² x × P x dV, with the second moments of the tetrahedron
    let spin = Spin {
        speed: 1.0,
        point: Vec3::ZERO,
        axis: Vec3::new(0.48, -0.6, 0.64),
    };
    for name in ["tet4", "tet10"] {
        let single = Single::new(element::by_name(name).unwrap(), Idealisation::Space, 0.0);
        let [_, moment] = single.resultant(&single.centrifugal(1.0, spin), &single.state(&[]));
        // ∫ x xᵀ dV = V/20 (Σ x_i x_iᵀ + s sᵀ) with s = Σ x_i over the corners
        let corners = &single.reference[..4];
        let s: Vec3 = corners.iter().copied().sum();
        let dyads = corners.iter().map(|x| Mat3::outer(*x, *x));
        let second = dyads.fold(Mat3::outer(s, s), |a, b| a + b) * (1.0 / 120.0);
        // x × Px = −(a·x) x × a
        let exact = (second * spin.axis).cross(spin.axis) * -1.0;
        assert_near(moment, exact, 1e-15, name);
    }
}

#[test]
fn a_moment_on_nodes_is_exact_and_has_no_force() {
    let places: Vec<Vec3> = (0..7)
        .map(|k| Vec3::new(noise(k), noise(20 + k), noise(40 + k)))
        .collect();
    let flat: Vec<Vec3> = places.iter().map(|x| Vec3::new(x.x, x.y, 0.5)).collect();
    let line: Vec<Vec3> = places
        .iter()
        .map(|x| Vec3::new(1.0, 2.0, 3.0) * x.x)
        .collect();
    let nodes: Vec<NodeId> = (0..7).chain([3]).collect();
    let oblique = Vec3::new(3.0, -1.0, 2.0);
    let across = Vec3::new(3.0, 0.0, -1.0);
    for (places, moment) in [(&places, oblique), (&flat, oblique), (&line, across)] {
        let forces = spread::moment(&nodes, places, moment).unwrap();
        assert_eq!(forces.len(), 7, "a node named twice counts once");
        let sum: Vec3 = forces.values().copied().sum();
        assert_near(sum, Vec3::ZERO, 1e-13, "force");
        let about = |(n, f): (&NodeId, &Vec3)| places[*n as usize].cross(*f);
        assert_near(forces.iter().map(about).sum(), moment, 1e-13, "moment");
    }
    assert_eq!(spread::moment(&nodes, &line, oblique), None);
    assert_eq!(spread::moment(&[2, 2], &places, oblique), None);
    assert_eq!(spread::moment(&[], &places, oblique), None);
    // two nodes at the distance 2 carry a moment across them by a couple
    let pair = [Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0)];
    let couple = spread::moment(&[0, 1], &pair, Vec3::unit(2) * PI).unwrap();
    assert_near(couple[&1], Vec3::unit(1) * (PI / 2.0), 1e-15, "couple");
}

/// The divergence theorem over all sides of an element, of stresses that are linear in the place, and of moments of
/// those that are constant; area, centre and normal of one side.
#[test]
fn stresses_on_faces_have_the_resultant_of_what_is_inside() {
    let stress = |x: Vec3| Sym3::new(1.0 + x.x, 2.0 - 0.5 * x.y, 0.7, 0.3 + x.y, 0.0, 0.0);
    for (element, space) in cases().filter(|(e, _)| e.nnode() == e.ncorner()) {
        let single = Single::new(element, space, 0.0);
        let (area, centre) = measure(&single);
        let at_nodes: Vec<Sym3> = single.reference.iter().map(|x| stress(*x)).collect();
        let section = Section::new(&single.surface(), &single.reference, &at_nodes);
        let what = format!("{} {space:?}", element.name());
        // ∂σ_xx/∂x + ∂σ_xy/∂y = 2, ∂σ_yy/∂y = −1/2
        let (along_x, along_y) = match space {
            // ∮ σn 2πr ds = 2π ∫ (r div σ + σ·e_r) dA
            Idealisation::Axisymmetric => {
                let at = stress(centre);
                let [x, y] = [at.xx(), at.xy()];
                (
                    TAU * (2.0 * centre.x + x) * area,
                    TAU * (-0.5 * centre.x + y) * area,
                )
            }
            _ => (
                2.0 * area * space.extent(centre),
                -0.5 * area * space.extent(centre),
            ),
        };
        let wanted = Vec3::new(along_x, along_y, 0.0);
        assert!(
            (section.force - wanted).norm() < 1e-12 * TAU * area.max(1.0) * 9.0,
            "{what}: {section:?}"
        );
        assert!(section.normal.norm() < 1.0 + 1e-12);
    }
    // a bent and twisted section: one side of a brick, x = 3
    let brick = element::by_name("hex8").unwrap();
    let single = Single::new(brick, Idealisation::Space, 0.0);
    let mut side = Region::default();
    let quad = element::by_name("quad4").unwrap();
    let at = |y: f64, z: f64| {
        let here = |x: &Vec3| (*x - Vec3::new(3.0, y, z)).norm() < 1e-12;
        single.reference.iter().position(here).unwrap() as NodeId
    };
    side.push(
        quad,
        Idealisation::Space,
        &[at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)],
        1.0,
    );
    // σ_xx = 1 + 3y, σ_xy = −2z: M_z = −3 ∫ y² dA, M_x about the centre = 2 ∫ z² dA
    let at_nodes: Vec<Sym3> = (single.reference.iter())
        .map(|x| Sym3::new(1.0 + 3.0 * x.y, 0.0, 0.0, -2.0 * x.z, 0.0, 0.0))
        .collect();
    let section = Section::new(&side, &single.reference, &at_nodes);
    let square = 4.0 / 3.0;
    let close = |a: Vec3, b: Vec3| assert!((a - b).norm() < 1e-13, "{a:?} {b:?}");
    assert!((section.area - 4.0).abs() < 1e-13);
    close(section.center, Vec3::unit(0) * 3.0);
    close(section.normal, Vec3::unit(0));
    close(section.force, Vec3::unit(0) * 4.0);
    close(section.moment, Vec3::new(2.0 * square, 0.0, -3.0 * square));
}
