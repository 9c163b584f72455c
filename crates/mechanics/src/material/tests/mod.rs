//! Properties of every material: those of the table, plasticity, and what wraps them.

mod closed;
mod isotropic;
mod plasticity;

use super::*;
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

const KINEMATICS: [Kinematics; 2] = [Kinematics::Small, Kinematics::Finite];
const TABLE_OF_YIELD: [[f64; 2]; 3] = [[8.0, 0.0], [14.0, 0.1], [17.0, 2.0]];

/// Numbers in [-1, 1] that look random and are the same in every run.
fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898 + 4.1414).sin() * 43_758.545_3;
    2.0 * (x - x.floor()) - 1.0
}

/// A strain of this size without structure, from a displacement gradient.
fn random(k: usize, size: f64) -> Sym3 {
    let row = |i| Vec3::new(noise(9 * k + i), noise(9 * k + i + 1), noise(9 * k + i + 2)) * size;
    let h = Mat3::from_rows([row(0), row(3), row(6)]);
    Sym3::symmetric_part(h) + Sym3::gram(h) * 0.5
}

fn rotation(k: usize) -> Mat3 {
    Mat3::rotation(Vec3::new(noise(k), noise(k + 1), noise(k + 2)) * 3.0)
}

fn of_table(name: &str) -> Box<dyn Material> {
    (by_name(name).unwrap().make)(&Constants::sample()).unwrap()
}

fn kinds() -> [HardeningKind; 3] {
    [
        HardeningKind::Isotropic,
        HardeningKind::Kinematic,
        HardeningKind::Combined { modulus: 30.0 },
    ]
}

fn plastic(kind: HardeningKind) -> Box<dyn Material> {
    let hardening = Hardening::new(kind, TABLE_OF_YIELD.to_vec()).unwrap();
    Box::new(Plasticity::new(500.0, 0.3, hardening).unwrap())
}

/// Every law in space.
fn laws() -> Vec<(String, Box<dyn Material>)> {
    let mut all: Vec<(String, Box<dyn Material>)> = Vec::new();
    for law in &TABLE {
        all.push((law.name.to_owned(), of_table(law.name)));
    }
    for kind in kinds() {
        all.push((format!("{kind:?}"), plastic(kind)));
    }
    all
}

fn oriented(inner: Box<dyn Material>) -> Box<dyn Material> {
    let (x, y) = (Vec3::new(1.0, 2.0, -0.5), Vec3::new(-1.0, 0.3, 0.7));
    Box::new(Oriented::new(inner, x, y).unwrap())
}

/// Every law, alone and wrapped.
fn zoo() -> Vec<(String, Box<dyn Material>)> {
    type Wrap = fn(Box<dyn Material>) -> Box<dyn Material>;
    let wraps: [(&str, Wrap); 7] = [
        ("", |m| m),
        ("oriented ", oriented),
        ("expanding oriented ", |m| {
            Box::new(Expanding::new(oriented(m), 2e-3, 10.0))
        }),
        ("plane-stress ", |m| Box::new(Reduced::plane_stress(m))),
        ("uniaxial ", |m| Box::new(Reduced::uniaxial(m))),
        ("plane-stress expanding oriented ", |m| {
            let inner = Box::new(Expanding::new(oriented(m), 2e-3, 10.0));
            Box::new(Reduced::plane_stress(inner))
        }),
        ("uniaxial expanding oriented ", |m| {
            let inner = Box::new(Expanding::new(oriented(m), 2e-3, 10.0));
            Box::new(Reduced::uniaxial(inner))
        }),
    ];
    let mut all = Vec::new();
    for (name, wrap) in wraps {
        all.extend(
            laws()
                .into_iter()
                .map(|(law, m)| (format!("{name}{law}"), wrap(m))),
        );
    }
    all
}

fn finite(value: Sym3) -> Strain<'static> {
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

/// The largest errors of stress against differences of energy, where the law has a potential, and of tangent against
/// differences of stress: fourth order, relative to the largest entries. None where the differences cross a kink: first yield, or a row of the table.
fn gradient_errors(
    material: &dyn Material,
    strain: &Strain,
    old: &[f64],
    is_smooth: bool,
) -> Option<(f64, f64)> {
    let mut new = old.to_vec();
    let mut at = |value| {
        let mut out = Response::default();
        let strain = Strain { value, ..*strain };
        material
            .respond(&strain, old, &mut new, Order::Tangent, &mut out)
            .unwrap();
        let plastic = material.plastic_strain(&new).filter(|_| !is_smooth);
        let flow = plastic.map(|plastic| {
            let rows = TABLE_OF_YIELD.iter().filter(|row| row[1] <= plastic);
            (material.plastic_strain(old) == Some(plastic), rows.count())
        });
        (out, flow)
    };
    let (here, flow) = at(strain.value);
    let stress = here.stress.to_pairs();
    let modulus = material.modulus();
    let stress_scale = stress
        .iter()
        .fold(1e-3 * modulus, |m: f64, s| m.max(s.abs()));
    let tangent_scale = here
        .tangent
        .as_flattened()
        .iter()
        .fold(0.0, |m: f64, s| m.max(s.abs()));
    let mut errors = (0.0f64, 0.0f64);
    for q in 0..6 {
        // a doubled shear of h is a tensor component of h/2
        let mut unit = [0.0; 6];
        unit[q] = if q < 3 { 1.0 } else { 0.5 };
        let unit = Sym3::from_pairs(unit);
        let h = 1e-4;
        let around = [2.0, 1.0, -1.0, -2.0].map(|n| at(strain.value + unit * (n * h)));
        if around.iter().any(|(_, other)| *other != flow) {
            return None;
        }
        let [a, b, c, d] = around.map(|(out, _)| out);
        let slope = |a: f64, b: f64, c: f64, d: f64| (8.0 * (b - c) - (a - d)) / (12.0 * h);
        let energy = slope(a.energy, b.energy, c.energy, d.energy);
        if material.is_symmetric() {
            errors.0 = errors.0.max((energy - stress[q]).abs() / stress_scale);
        }
        let [a, b, c, d] = [a, b, c, d].map(|r| r.stress.to_pairs());
        for p in 0..6 {
            let value = here.tangent[p][q];
            errors.1 = errors
                .1
                .max((slope(a[p], b[p], c[p], d[p]) - value).abs() / tangent_scale);
            let asymmetry = (value - here.tangent[q][p]).abs();
            let is_symmetric = asymmetry < 1e-12 * tangent_scale;
            assert!(is_symmetric || !material.is_symmetric(), "{asymmetry}");
        }
    }
    Some(errors)
}

/// States with all the coincidences of principal strains, in turned axes.
fn coincident(size: f64) -> Vec<Sym3> {
    let mut all = vec![Sym3::ZERO];
    for (k, delta) in [0.0, 1e-12, 1e-8, 1e-6, 1e-4, 1e-2].into_iter().enumerate() {
        for (a, b, c) in [(1.0, 1.0, -0.6), (-0.8, 0.5, 0.5), (0.7, 0.7, 0.7)] {
            let diagonal = Sym3::diagonal(size * a, size * b + delta, size * c - 0.4 * delta);
            all.push(diagonal.congruence(rotation(k)));
            all.push(diagonal);
        }
    }
    all
}

#[test]
fn stress_is_the_gradient_of_energy_and_tangent_that_of_stress() {
    for (name, material) in zoo() {
        // deformation theory has neither a yield surface nor a table
        let is_smooth = name.contains("ramberg-osgood");
        // what the strain of Almansi says of the volume has no answer under large compression
        let reach = if name.ends_with("eulerian") { 0.4 } else { 1.0 };
        for kinematics in KINEMATICS {
            let mut worst = (0.0f64, 0.0f64);
            let (mut checks, mut kinks) = (0, 0);
            let mut check = |value: Sym3, old: &[f64]| {
                let strain = Strain {
                    temperature: 30.0,
                    ..Strain::new(kinematics, value)
                };
                checks += 1;
                let errors = gradient_errors(material.as_ref(), &strain, old, is_smooth);
                let Some((stress, tangent)) = errors else {
                    kinks += 1;
                    return;
                };
                worst = (worst.0.max(stress), worst.1.max(tangent));
                assert!(
                    stress < 1e-7 && tangent < 1e-7,
                    "{name} {kinematics:?} {value:?}: {stress:.1e} {tangent:.1e}"
                );
            };
            let mut start = vec![0.0; material.nhistory()];
            material.start(&mut start);
            // inside the yield surface (free of stress at 30 degrees is a strain of 0.04), and far outside
            check(Sym3::IDENTITY * 0.041 + random(1, 1e-3), &start);
            for k in 0..6 {
                check(random(k, 0.25 * reach), &start);
            }
            for value in coincident(0.2 * reach).into_iter().chain(coincident(0.002)) {
                check(value, &start);
            }
            // from a history: loading on, turning aside, back
            let mut old = start.clone();
            for k in 0..3 {
                let strain = Strain {
                    temperature: 30.0,
                    ..Strain::new(kinematics, random(k, 0.2 * reach))
                };
                advance(material.as_ref(), &strain, &mut old);
                check(strain.value * 1.3, &old);
                check(random(k + 20, 0.25 * reach), &old);
                check(strain.value + random(40 + k, 2e-3), &old);
                check(strain.value * 0.98, &old);
            }
            assert!(
                20 * kinks <= checks,
                "{name} {kinematics:?}: {kinks} of {checks}"
            );
            println!(
                "{name} {kinematics:?}: {:.1e} {:.1e}, {kinks} of {checks} at kinks",
                worst.0, worst.1
            );
        }
    }
}

#[test]
fn laws_of_e_and_nu_agree_with_hooke_at_the_origin() {
    let hooke = Lame::new(500.0, 0.3).tangent();
    let is_of_e_and_nu = |law: &Law| law.constants.iter().map(|key| key.name).eq(["E", "nu"]);
    let isotropic = laws()
        .into_iter()
        .filter(|(name, _)| by_name(name).is_none_or(is_of_e_and_nu));
    for (name, material) in isotropic {
        for kinematics in KINEMATICS {
            let at = fresh(material.as_ref(), &Strain::new(kinematics, Sym3::ZERO));
            assert_eq!(at.stress, Sym3::ZERO, "{name}");
            assert_eq!(at.energy, 0.0);
            for (a, b) in at.tangent.as_flattened().iter().zip(hooke.as_flattened()) {
                assert!((a - b).abs() < 1e-12 * 500.0, "{name}");
            }
        }
        assert!((material.modulus() - hooke[0][0]).abs() < 1e-10);
    }
}

#[test]
fn every_law_keeps_its_digits_at_small_strain_and_its_modulus_is_its_stiffness() {
    for (name, material) in laws() {
        let origin = fresh(material.as_ref(), &finite(Sym3::ZERO));
        let stiffest = (0..3).fold(0.0, |m: f64, i| m.max(origin.tangent[i][i]));
        assert!(
            (material.modulus() / stiffest - 1.0).abs() < 1e-14,
            "{name}"
        );
        let shape = random(7, 1.0);
        let mut pairs = shape.to_pairs();
        pairs[3..].iter_mut().for_each(|shear| *shear *= 2.0);
        let linear = origin
            .tangent
            .map(|row| row.iter().zip(pairs).map(|(c, e)| c * e).sum());
        let linear = Sym3::from_pairs(linear);
        for kinematics in KINEMATICS {
            for size in [1e-7, 1e-10, 1e-14, 1e-30] {
                let out = fresh(material.as_ref(), &Strain::new(kinematics, shape * size));
                let error = out.stress * size.recip() - linear;
                let largest = error
                    .to_pairs()
                    .iter()
                    .fold(0.0, |m: f64, e| m.max(e.abs()));
                // the law itself departs by the strain
                let allowed = (20.0 * size + 4e-15) * material.modulus();
                assert!(
                    largest < allowed,
                    "{name} {kinematics:?} {size} {largest:.1e}"
                );
                let energy = out.energy / (size * size);
                let expected = 0.5 * linear.double_dot(shape);
                assert!(
                    (energy - expected).abs() < (20.0 * size + 1e-14) * material.modulus(),
                    "{name} {kinematics:?} {size} {energy} {expected}"
                );
            }
        }
    }
}

#[test]
fn isotropic_laws_turn_with_the_axes() {
    for (name, material) in laws() {
        if ["orthotropic", "anisotropic"].contains(&name.as_str()) {
            continue;
        }
        for kinematics in KINEMATICS {
            for k in 0..4 {
                let (value, r) = (random(k, 0.25), rotation(k));
                let strain = Strain::new(kinematics, value);
                let turned = Strain::new(kinematics, value.congruence(r));
                let (a, b) = (
                    fresh(material.as_ref(), &strain),
                    fresh(material.as_ref(), &turned),
                );
                assert!((a.energy - b.energy).abs() < 1e-12 * a.energy, "{name}");
                let error = (a.stress.congruence(r) - b.stress).to_pairs();
                assert!(
                    error.iter().all(|e| e.abs() < 1e-11 * 500.0),
                    "{name} {error:?}"
                );
            }
        }
    }
}

#[test]
fn linear_laws_have_one_tangent_and_proportional_stress_at_small_strain() {
    let kinematics = Kinematics::Small;
    let strain = Sym3::new(0.02, -0.01, 0.03, 0.015, -0.02, 0.01);
    for (name, material) in zoo() {
        let at = |strain: Sym3| fresh(material.as_ref(), &Strain::new(kinematics, strain));
        let [origin, one, two] = [Sym3::ZERO, strain, strain * 2.0].map(at);
        let scale = material.modulus();
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12 * scale;
        let tangents = origin.tangent.as_flattened().iter();
        let same = tangents.zip(two.tangent.as_flattened());
        let curved = origin.stress + two.stress - one.stress * 2.0;
        let is_linear = same.clone().all(|(a, b)| close(*a, *b))
            && curved.to_pairs().iter().all(|s| close(*s, 0.0));
        assert!(is_linear || !material.linearity().is_linear(), "{name}");
    }
}

#[test]
fn the_shear_modulus_is_the_least_stress_of_a_small_shear() {
    for (name, material) in zoo() {
        let size = 1e-6;
        let planes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let stiffnesses = planes.map(|[yz, xz, xy]| {
            let strain = Sym3::new(0.0, 0.0, 0.0, yz, xz, xy) * (0.5 * size);
            let pairs = fresh(material.as_ref(), &Strain::new(Kinematics::Small, strain));
            let still = fresh(
                material.as_ref(),
                &Strain::new(Kinematics::Small, Sym3::ZERO),
            );
            let stress = (pairs.stress - still.stress).to_pairs();
            stress[3] * yz + stress[4] * xz + stress[5] * xy
        });
        let least = stiffnesses
            .map(|s| s / size)
            .into_iter()
            .filter(|s| *s > 0.0);
        let least = least.fold(f64::INFINITY, f64::min);
        let Some(modulus) = material.shear_modulus() else {
            // a law of one direction has none
            assert!(least.is_infinite(), "{name}");
            continue;
        };
        assert!(
            (modulus - least).abs() < 1e-5 * least,
            "{name}: {modulus} {least}"
        );
        assert!(modulus < material.modulus(), "{name}");
    }
    let isotropic = of_table("linear-elastic");
    let lame = isotropic.linearity().lame();
    assert_eq!(isotropic.shear_modulus(), lame.map(|l| l.mu));
}
