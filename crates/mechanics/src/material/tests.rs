//! Properties of every material in the table.

use super::*;

const ZERO: Sym3 = Sym3::ZERO;
const SAMPLE: Sym3 = Sym3::new(-0.21, 0.13, 0.05, 0.08, -0.11, 0.06);

fn respond(material: &dyn Material, kinematics: Kinematics, value: Sym3) -> Response {
    let mut out = Response::default();
    let strain = Strain::new(kinematics, value);
    material
        .respond(&strain, &[], &mut [], Order::Tangent, &mut out)
        .unwrap();
    out
}

#[test]
fn stress_is_the_gradient_of_energy_and_tangent_that_of_stress() {
    for law in &TABLE {
        let name = law.name;
        let material = (law.make)(&Constants::elastic(500.0, 0.3)).unwrap();
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let at = respond(material.as_ref(), kinematics, SAMPLE);
            let h = 1e-6;
            for q in 0..6 {
                let mut step = [0.0; 6];
                // a doubled shear of h is a tensor component of h/2
                step[q] = if q < 3 { h } else { 0.5 * h };
                let step = Sym3::from_pairs(step);
                let plus = respond(material.as_ref(), kinematics, SAMPLE + step);
                let minus = respond(material.as_ref(), kinematics, SAMPLE - step);
                let slope = (plus.energy - minus.energy) / (2.0 * h);
                assert!(
                    (slope - at.stress.to_pairs()[q]).abs() < 1e-6,
                    "{name} {kinematics:?}"
                );
                for p in 0..6 {
                    let slope =
                        (plus.stress.to_pairs()[p] - minus.stress.to_pairs()[p]) / (2.0 * h);
                    assert!(
                        (slope - at.tangent[p][q]).abs() < 1e-5,
                        "{name} {kinematics:?} {p}{q}"
                    );
                    assert!((at.tangent[p][q] - at.tangent[q][p]).abs() < 1e-10);
                }
            }
        }
    }
}

#[test]
fn all_laws_agree_with_hooke_at_the_origin() {
    let hooke = Lame::new(500.0, 0.3).tangent();
    for law in &TABLE {
        let name = law.name;
        let material = (law.make)(&Constants::elastic(500.0, 0.3)).unwrap();
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let at = respond(material.as_ref(), kinematics, ZERO);
            assert_eq!(at.stress, ZERO, "{name}");
            assert_eq!(at.energy, 0.0);
            for (row, expected) in at.tangent.iter().zip(&hooke) {
                for (a, b) in row.iter().zip(expected) {
                    assert!((a - b).abs() < 1e-12 * 500.0, "{name}");
                }
            }
        }
        assert!((material.modulus() - hooke[0][0]).abs() < 1e-10);
    }
}

#[test]
fn uniaxial_saint_venant_kirchhoff_has_its_nominal_stress() {
    // nu = 0: P = l S = ½ E l (l² − 1)
    let law = SaintVenantKirchhoff::new(500.0, 0.0);
    for l in [0.6, 0.8, 1.3] {
        let e = 0.5 * (l * l - 1.0);
        let out = respond(&law, Kinematics::Finite, Sym3::diagonal(e, 0.0, 0.0));
        assert!((l * out.stress.xx() - 0.5 * 500.0 * l * (l * l - 1.0)).abs() < 1e-11);
    }
}

#[test]
fn neo_hookean_dilation_has_its_closed_form_and_keeps_digits_at_small_strain() {
    let (lambda, mu) = (1000.0, 400.0);
    let nu = lambda / (2.0 * (lambda + mu));
    let law = NeoHookean::new(2.0 * mu * (1.0 + nu), nu);
    for l in [0.7f64, 1.2] {
        let e = 0.5 * (l * l - 1.0);
        let out = respond(&law, Kinematics::Finite, Sym3::diagonal(e, e, e));
        // S = (μ (l² − 1) + 3 λ ln l)/l²
        let expected = (mu * (l * l - 1.0) + 3.0 * lambda * l.ln()) / (l * l);
        assert!((out.stress.xx() - expected).abs() < 1e-10);
    }
    let tiny = 1e-9;
    let out = respond(&law, Kinematics::Finite, Sym3::diagonal(tiny, 0.0, 0.0));
    assert!((out.stress.yy() / (lambda * tiny) - 1.0).abs() < 1e-6);
}

#[test]
fn an_inverted_state_is_an_error() {
    let law = NeoHookean::new(1.0, 0.3);
    let strain = Strain::new(Kinematics::Finite, Sym3::diagonal(-0.6, 0.0, 0.0));
    let outcome = law.respond(
        &strain,
        &[],
        &mut [],
        Order::Stress,
        &mut Response::default(),
    );
    assert!(matches!(outcome, Err(MaterialError::Inverted { .. })));
}

fn finite(value: Sym3) -> Strain {
    Strain::new(Kinematics::Finite, value)
}

/// The answer from the undeformed state.
fn fresh(material: &dyn Material, strain: &Strain) -> Response {
    let mut old = vec![0.0; material.nhistory()];
    material.start(&mut old);
    advance(material, strain, &mut old)
}

/// The answer from a history, which goes on.
fn advance(material: &dyn Material, strain: &Strain, history: &mut Vec<f64>) -> Response {
    let mut new = history.clone();
    let mut out = Response::default();
    material
        .respond(strain, history, &mut new, Order::Tangent, &mut out)
        .unwrap();
    *history = new;
    out
}

#[test]
fn plane_and_uniaxial_stress_of_hooke_have_their_closed_forms() {
    let (e, nu) = (500.0, 0.3);
    let strain = Strain::new(
        Kinematics::Small,
        Sym3::new(1e-3, -2e-3, 7.0, 5e-4, 7.0, 7.0),
    );
    let plane = Reduced::plane_stress(Box::new(SaintVenantKirchhoff::new(e, nu)));
    let out = fresh(&plane, &strain);
    let c = e / (1.0 - nu * nu);
    assert!((out.stress.xx() - c * (1e-3 - nu * 2e-3)).abs() < 1e-13);
    assert!((out.stress.xy() - e / (1.0 + nu) * 5e-4).abs() < 1e-13);
    assert!((out.tangent[0][0] - c).abs() < 1e-10 && (out.tangent[0][1] - nu * c).abs() < 1e-10);
    assert!((out.across - nu / (1.0 - nu) * 1e-3).abs() < 1e-16);
    let bar = Reduced::uniaxial(Box::new(SaintVenantKirchhoff::new(e, nu)));
    let out = fresh(&bar, &strain);
    assert!((out.stress.xx() - e * 1e-3).abs() < 1e-13);
    assert!((out.tangent[0][0] - e).abs() < 1e-10);
    assert!((out.across + nu * 1e-3).abs() < 1e-16);
}

#[test]
fn a_stretch_of_rubber_to_any_length_finds_its_thickness_in_one_step() {
    for nu in [0.0, 0.3, 0.499, 0.49999] {
        for stretch in [0.02f64, 0.2, 0.7, 1.5, 4.0, 20.0] {
            let law = Reduced::uniaxial(Box::new(NeoHookean::new(3.0, nu)));
            let out = fresh(
                &law,
                &finite(Sym3::diagonal(0.5 * (stretch * stretch - 1.0), 0.0, 0.0)),
            );
            // μ (c − 1) + λ ln(stretch c) = 0 in c = C_zz
            let Lame { lambda, mu } = Lame::new(3.0, nu);
            let c = 1.0 + 2.0 * out.across;
            let size = mu * c.max(1.0) + lambda * (stretch * c).ln().abs();
            let left = mu * (c - 1.0) + lambda * (stretch * c).ln();
            // round-off of E, where c is small against 1
            let floor = 1e-14 * (mu + lambda) / c;
            assert!(left.abs() < 1e-10 * size + floor, "{nu} {stretch}: {left}");
        }
    }
}

#[test]
fn saint_venant_kirchhoff_without_thickness_left_is_an_error() {
    let law = Reduced::plane_stress(Box::new(SaintVenantKirchhoff::new(500.0, 0.45)));
    let strain = finite(Sym3::diagonal(1.0, 1.0, 0.0));
    let outcome = law.respond(
        &strain,
        &[0.0; 3],
        &mut [0.0; 3],
        Order::Stress,
        &mut Response::default(),
    );
    assert!(matches!(outcome, Err(MaterialError::NotConverged { .. })));
}
