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
                && frame.plastic_strain.len() == body.layout.nnode()
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
            let outcome = body.solid.add_initial(0, &mut work, &mut found);
            outcome.unwrap();
            assert!(found.stiffness == fresh.stiffness, "{element} {locking}");
        }
    }
}

#[test]
fn a_body_knows_when_its_stiffness_is_that_at_the_start() {
    let space = Idealisation::Space;
    let mesh = one(element::by_name("hex8").unwrap(), space);
    let wish = Wish::plain(space, Kinematics::Finite);
    let mut body = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
    let mut state = body.state(&vec![0.0; body.layout.ndof()]);
    assert!(body.solid.is_initial(&state));
    state.u[7] = 1e-9;
    assert!(!body.solid.is_initial(&state));
    // what it remembers may count
    let remembering = remembering("hex8", space, wish);
    state.u[7] = 0.0;
    assert!(!remembering.solid.is_initial(&state));
    // another material, or another size of strains, is another start
    let step = |number, nonlinear| StepContext {
        number,
        nonlinear,
        ..StepContext::default()
    };
    let softer = elastic("linear-elastic", 0.2);
    body.solid.change(2, softer).unwrap();
    let steps = [step(0, true), step(1, true), step(1, false), step(2, true)];
    let starts = steps.map(|step| {
        body.solid.begin(&Phase::of_step(step), &state).unwrap();
        body.solid.id()
    });
    assert_eq!(starts[0], starts[1]);
    assert!(starts[1] != starts[2] && starts[2] != starts[3] && starts[1] != starts[3]);
}

#[test]
fn stiffness_at_the_start_is_that_of_the_temperature_at_the_start() {
    let space = Idealisation::Space;
    let mesh = one(element::by_name("hex8").unwrap(), space);
    let wish = Wish::plain(space, Kinematics::Finite);
    let cells: Vec<_> = mesh.cells(3).collect();
    // half as stiff at 100 as at 0, and 100 now
    let solid = |young: [f64; 2]| {
        let Body {
            layout, reference, ..
        } = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
        let mut constants = Constants::elastic(500.0, 0.3);
        constants.set("T", vec![0.0, 100.0]);
        constants.set("E", young.to_vec());
        constants.set("nu", vec![0.3, 0.3]);
        let law = ByTemperature::new(&constants).unwrap();
        let of = |t: f64| vec![t; mesh.nnode()];
        let field = NodalField {
            ends: vec![of(0.0), of(100.0)],
        };
        let parts = SolidParts {
            name: "body",
            mesh: &mesh,
            reference: reference.clone(),
            cells: &cells,
            layout,
            space,
            profile: None,
            material: Box::new(law),
            integration: Integration::Full,
            locking: Locking::None,
            temperature: Some(Arc::new(field)),
            linear_temperatures: false,
            at_nodes: Default::default(),
            initial: &[],
            axes: None,
            directors: &crate::system::Directors::default(),
        };
        Solid::new(parts).unwrap()
    };
    let at_start = |young| {
        let n = 3 * mesh.nnode();
        let mut dense = Dense {
            force: vec![0.0; n],
            stiffness: vec![0.0; n * n],
        };
        let outcome = solid(young).add_initial(0, &mut Work::default(), &mut dense);
        outcome.unwrap();
        dense.stiffness
    };
    assert!(at_start([500.0, 250.0]) == at_start([500.0, 500.0]));
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
        profile: None,
        material: Box::new(Warm),
        integration: Integration::Full,
        locking: Locking::None,
        temperature: Some(Arc::new(field)),
        linear_temperatures: false,
        at_nodes: Default::default(),
        initial: &[],
        axes: None,
        directors: &crate::system::Directors::default(),
    })
    .unwrap();
    assert_eq!(solid.properties().symmetry, Symmetry::Unsymmetric);
    let mut at = state(&layout, &reference, &[0.0; 24]);
    let step = StepContext {
        number: 1,
        start: 1.0,
        duration: 4.0,
        nonlinear: false,
        scheme: None,
        vibrates: false,
        physics: crate::system::Physics::default(),
        cycles: 1.0,
        ..StepContext::default()
    };
    solid.begin(&Phase::of_step(step), &at).unwrap();
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
    body.solid.begin(&Phase::of_step(step), &at).unwrap();
    step.nonlinear = true;
    let refused = body.solid.begin(&Phase::of_step(step), &at);
    let Err(TermError::Refused { message }) = refused else {
        panic!("{refused:?}");
    };
    assert!(
        message.contains("incompatible") && message.contains("hex8"),
        "{message}"
    );
}
