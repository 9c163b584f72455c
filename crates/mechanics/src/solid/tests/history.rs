//! What a body remembers.

use super::derivatives::Viscous;
use super::*;

fn remembering(element: &str, space: Idealisation, wish: Wish) -> Body {
    let mesh = one(element::by_name(element).unwrap(), space);
    body(&mesh, Box::new(Viscous), &wish).unwrap()
}

#[test]
fn history_moves_on_when_accepted_and_comes_back_from_an_archive() {
    for (element, locking, kinematics) in [
        ("quad4", Locking::Incompatible, Kinematics::Small),
        ("quad4", Locking::BBar, Kinematics::Small),
        ("quad9", Locking::FBar, Kinematics::Finite),
        ("tri6", Locking::None, Kinematics::Finite),
    ] {
        let space = Idealisation::PlaneStrain { thickness: 1.0 };
        let make = || {
            let wish = Wish {
                locking,
                ..Wish::plain(space, kinematics)
            };
            remembering(element, space, wish)
        };
        let mut body = make();
        let n = body.layout.ndof();
        let u: Vec<f64> = (0..n).map(|k| 0.03 * noise(k)).collect();
        let mut work = Work::default();
        let before = body.assemble(&u, Order::Residual, &mut work).force;
        body.solid.reject();
        assert_eq!(before, body.assemble(&u, Order::Residual, &mut work).force);
        let state = body.state(&u);
        body.solid.accept(&state).unwrap();
        // held where it is, the viscous part has relaxed
        let after = body.assemble(&u, Order::Residual, &mut work).force;
        let moved = before.iter().zip(&after).map(|(a, b)| (a - b).abs());
        assert!(moved.fold(0.0, f64::max) > 0.1);
        let mut archive = Archive::default();
        body.solid.save(&mut archive);
        let mut resumed = make();
        resumed.solid.load(&archive).unwrap();
        let again = resumed.assemble(&u, Order::Residual, &mut work).force;
        assert_eq!(after, again, "{element} {locking}");
        let frame = body.report(&u);
        assert!(
            frame.cell_plastic_strain[0][0] > 0.0
                && frame.plastic_strain.len() == body.layout.nnode
        );
    }
}

#[test]
fn stiffness_at_the_start_is_that_of_a_body_to_which_nothing_has_happened() {
    let space = Idealisation::PlaneStrain { thickness: 1.0 };
    for (element, space, locking, kinematics) in [
        ("quad4", space, Locking::Incompatible, Kinematics::Small),
        ("tri6", space, Locking::FBar, Kinematics::Finite),
        (
            "hex8",
            Idealisation::Space,
            Locking::None,
            Kinematics::Finite,
        ),
        (
            "tet10",
            Idealisation::Space,
            Locking::BBar,
            Kinematics::Small,
        ),
    ] {
        for law in [
            || Box::new(Viscous) as Box<dyn Material>,
            derivatives::plastic,
        ] {
            let mesh = one(element::by_name(element).unwrap(), space);
            let wish = Wish {
                locking,
                ..Wish::plain(space, kinematics)
            };
            let mut body = body(&mesh, law(), &wish).unwrap();
            let n = body.layout.ndof();
            let mut work = Work::default();
            let fresh = body.assemble(&vec![0.0; n], Order::Tangent, &mut work);
            let u: Vec<f64> = (0..n).map(|k| 0.03 * noise(k)).collect();
            let state = body.state(&u);
            body.solid.accept(&state).unwrap();
            let mut found = Dense {
                force: vec![0.0; n],
                stiffness: vec![0.0; n * n],
            };
            let outcome = body.solid.stiffness_at_start(0, &mut work, &mut found);
            outcome.unwrap();
            assert!(found.stiffness == fresh.stiffness, "{element} {locking}");
        }
    }
}

#[test]
fn stiffness_changes_by_no_more_than_is_said_where_that_is_known() {
    let space = Idealisation::Space;
    for element in SPACE {
        let mesh = one(element::by_name(element).unwrap(), space);
        let of = |law: &str, kinematics| {
            body(&mesh, elastic(law, 0.3), &Wish::plain(space, kinematics)).unwrap()
        };
        let linear = of("linear-elastic", Kinematics::Finite);
        let n = linear.layout.ndof();
        let (mut work, size) = (Work::default(), 0.02);
        let from: Vec<f64> = (0..n).map(|k| size * noise(k)).collect();
        let before = linear.assemble(&from, Order::Tangent, &mut work);
        let norm = |k: &[f64]| k.iter().map(|k| k * k).sum::<f64>().sqrt();
        for step in [1e-3, 1e-2] {
            let moved = from.iter().enumerate();
            let u: Vec<f64> = moved.map(|(k, u)| u + step * noise(700 + k)).collect();
            let after = linear.assemble(&u, Order::Tangent, &mut work);
            let pairs = after.stiffness.iter().zip(&before.stiffness);
            let change: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
            let change = norm(&change) / norm(&before.stiffness);
            let said = linear.solid.stiffness_change(&from, &linear.state(&u));
            assert!(
                change <= said && said < 200.0 * change,
                "{element}: {change} {said}"
            );
            let small = of("linear-elastic", Kinematics::Small);
            assert_eq!(small.solid.stiffness_change(&from, &small.state(&u)), 0.0);
            let other = of("neo-hookean", Kinematics::Finite);
            let said = other.solid.stiffness_change(&from, &other.state(&u));
            assert_eq!(said, f64::INFINITY);
        }
    }
}

#[test]
fn stiffness_that_has_hardly_changed_is_kept_where_that_is_let_pass() {
    let mesh = one(element::by_name("hex8").unwrap(), Idealisation::Space);
    let wish = Wish::plain(Idealisation::Space, Kinematics::Finite);
    let Body {
        solid,
        layout,
        reference,
    } = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
    let terms: Vec<Box<dyn Term>> = vec![Box::new(solid)];
    let elimination = Elimination::default();
    let assemble = |assembler: &mut Assembler, size: f64, out: &mut Assembly| {
        let u: Vec<f64> = (0..layout.ndof()).map(|k| size * noise(k)).collect();
        let state = state(&layout, &reference, &u);
        let order = Order::Tangent;
        let done = assembler.assemble(&layout, &elimination, &terms, &state, order, out);
        done.unwrap();
        (out.values().bulk.to_vec(), out.residual.clone())
    };
    let new = || Assembler::new(&layout, &elimination, &terms);
    let exact = |size| assemble(&mut new(), size, &mut Assembly::default());
    let [first, near, far] = [0.02, 0.0201, 0.05].map(exact);
    let (mut assembler, mut out) = (new(), Assembly::default());
    assembler.tolerate(0.01);
    assert!(assemble(&mut assembler, 0.02, &mut out) == first);
    let kept = assemble(&mut assembler, 0.0201, &mut out);
    assert!(kept.0 == first.0 && kept.1 == near.1);
    assert!(assemble(&mut assembler, 0.05, &mut out) == far);
    // nothing passes, and nothing goes on into another increment
    assemble(&mut assembler, 0.02, &mut out);
    assembler.tolerate(0.0);
    assert!(assemble(&mut assembler, 0.0201, &mut out) == near);
    assembler.tolerate(0.01);
    assemble(&mut assembler, 0.02, &mut out);
    assembler.begin_increment(&terms);
    assert!(assemble(&mut assembler, 0.0201, &mut out) == near);
}

#[test]
fn a_law_without_symmetry_says_so_and_temperature_reaches_the_points() {
    struct Warm;
    impl Material for Warm {
        fn respond(
            &self,
            strain: &Strain,
            _: &[f64],
            _: &mut [f64],
            _: MaterialOrder,
            out: &mut Response,
        ) -> Result<(), MaterialError> {
            let t = strain.temperature;
            out.stress = Sym3::diagonal(t, t, t);
            Ok(())
        }
        fn modulus(&self) -> f64 {
            1.0
        }
        fn is_symmetric(&self) -> bool {
            false
        }
    }
    let space = Idealisation::Space;
    let mesh = one(element::by_name("hex8").unwrap(), space);
    let wish = Wish::plain(space, Kinematics::Small);
    let Body {
        layout, reference, ..
    } = body(&mesh, Box::new(Warm), &wish).unwrap();
    // linear in space, and half way through the second step between its ends
    let row = |scale: f64| reference.iter().map(|x| scale * (3.0 + x.x)).collect();
    let field = NodalField {
        ends: vec![row(0.0), row(1.0), row(3.0)],
    };
    let cells: Vec<_> = mesh.cells(3).collect();
    let mut solid = Solid::new(SolidParts {
        name: "body",
        mesh: &mesh,
        reference: reference.clone(),
        cells: &cells,
        layout,
        space,
        material: Box::new(Warm),
        integration: Integration::Full,
        locking: Locking::None,
        temperature: Some(Arc::new(field)),
        linear_temperatures: false,
        at_nodes: Default::default(),
        initial: &[],
    })
    .unwrap();
    assert_eq!(solid.symmetry(), Symmetry::Unsymmetric);
    let mut at = state(&layout, &reference, &[0.0; 24]);
    let step = StepContext {
        number: 1,
        start: 1.0,
        duration: 4.0,
        nonlinear: false,
    };
    solid.begin_step(&step, &at).unwrap();
    at.time = 3.0;
    let mut frame = Frame::new(8, &[1]);
    solid.report(&at, &mut frame).unwrap();
    for (node, x) in reference.iter().enumerate() {
        let exact = 2.0 * (3.0 + x.x);
        assert!((frame.temperature[node] - exact).abs() < 1e-13);
        // the stress is linear in space, and so is its extrapolation but for the distortion of the element
        assert!((frame.stress[node].xx() - exact).abs() < 1e-13);
    }
}

#[test]
fn a_step_of_the_other_size_of_strains_is_refused_where_the_remedy_ends() {
    let space = Idealisation::Space;
    let mesh = one(element::by_name("hex8").unwrap(), space);
    let wish = Wish {
        locking: Locking::Incompatible,
        ..Wish::plain(space, Kinematics::Small)
    };
    let mut body = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
    let at = body.state(&[0.0; 24]);
    let mut step = StepContext {
        nonlinear: false,
        ..StepContext::default()
    };
    body.solid.begin_step(&step, &at).unwrap();
    step.nonlinear = true;
    let refused = body.solid.begin_step(&step, &at);
    let Err(TermError::Refused { message }) = refused else {
        panic!("{refused:?}");
    };
    assert!(
        message.contains("incompatible") && message.contains("hex8"),
        "{message}"
    );
}
