//! Explicit steps: impacts, bodies, what is stable.

use super::bar::{Bar, LENGTH, WAVE};
use super::common::{model, run};
use super::impact::{blocks, meet, sliding};
use super::rigid::{Cube, block, distance, pendulum, spin};
use super::{energy, refusal, solve, solved, stopped_after};
use std::f64::consts::PI;

const EXPLICIT: &str = "method = \"explicit\"";

/// Impulses make the force that of the wave, without noise, and take the energy of the nodes that meet; soft springs add none
/// (`DYNAMICS` table of the bar: energy −0.88 … −0.80 %, rms 0.001, peak 1.1).
#[test]
fn a_bar_that_hits_a_wall_has_the_force_of_its_wave() {
    for phase in 0..8 {
        for (penalty, [low, high], rms_most, peak_most) in [
            (None, [-0.95, -0.75], 0.0013, 1.1),
            (Some(0.5), [-0.2, 0.2], 0.03, 1.1),
        ] {
            let mut bar = Bar {
                dynamics: EXPLICIT,
                ..Bar::default()
            };
            if let Some(times) = penalty {
                bar = bar.penalty(times);
            }
            let h = bar.h();
            bar.gap = bar.velocity * h * (2.0 + f64::from(phase) / 8.0);
            bar.increments = (1.0 / h) as usize;
            let got = solved(&bar.text());
            assert!(got["iterations"].iter().all(|n| *n == 1.0));
            let energies = energy(&got);
            let last = 100.0 * (energies.last().unwrap() / 500.0 - 1.0);
            let place = format!("{penalty:?} {phase}");
            assert!((low..high).contains(&last), "{place}: energy {last}");
            let (force, begin) = (WAVE * bar.velocity, bar.gap / bar.velocity);
            let long = 2.0 * LENGTH / WAVE;
            let middle = begin + 0.1 * long..begin + 0.9 * long;
            let rows = got["time"].iter().zip(&got["c.force_x"]);
            let middle = rows.filter(|(t, _)| middle.contains(*t));
            let errors: Vec<f64> = middle.map(|(_, f)| f / force - 1.0).collect();
            let rms = errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64;
            assert!(rms.sqrt() < rms_most, "{place}: force {}", rms.sqrt());
            let peak = got["c.force_x"].iter().copied().fold(0.0, f64::max) / force;
            assert!(peak < peak_most, "{place}: peak {peak}");
        }
    }
}

/// Deformable blocks that meet off centre, by impulses and penalties, with friction and without, sides swapped: momentum stays, and
/// energy does not grow, but for what springs give.
#[test]
fn bodies_that_meet_keep_their_momentum() {
    let penalty = "enforcement = { penalty = 2e3, per = \"area\" }";
    let lagrange = "enforcement = { lagrange = {} }";
    let augmented = "enforcement = { augmented = \"newton\" }";
    for ndim in [2, 3] {
        for nonlinear in [true, false] {
            for (method, law) in [
                ("mortar", penalty),
                ("mortar", lagrange),
                ("node-to-segment", lagrange),
                ("node-to-segment", penalty),
                ("node-to-segment", augmented),
                ("gauss-point", penalty),
            ] {
                for friction in ["", "friction = 0.3"] {
                    let contact = format!("method = \"{method}\"\n{law}\n{friction}");
                    let place = format!("{ndim} {nonlinear} {contact}");
                    let text = blocks(ndim, nonlinear, &contact)
                        + "dynamics = { method = \"explicit\" }\n";
                    let swapped = text.replace(
                        "secondary = \"foot\"\nprimary = \"top\"",
                        "secondary = \"top\"\nprimary = \"foot\"",
                    );
                    // of a side that is larger than the other, areas around its corners count by all methods but that of nodes
                    let both = method == "node-to-segment";
                    for text in [Some(text), both.then_some(swapped)].into_iter().flatten() {
                        // springs give back a little more or less where rows close within an increment, or leave at corners;
                        // impulses do not
                        let least = match (law == penalty, method) {
                            (true, "mortar") => -0.1,
                            (true, _) => -0.05,
                            _ => -2e-3,
                        };
                        meet(&text, ndim, least, &place);
                    }
                }
            }
        }
    }
}

/// A soft block that yields as it hits a floor: its elements become short, and are as stiff as before where they are unloaded.
/// Implicit steps leave it the same energy.
#[test]
fn a_block_that_yields_stays_stable() {
    let contact = "method = \"node-to-segment\"\nenforcement = { lagrange = {} }";
    let yields = |dynamics: &str| {
        let text = sliding(contact, &format!("dynamics = {{ {dynamics} }}"));
        let text = text
            .replace("friction = 0.5\n", "")
            .replace("v = [1.0, 0.0]", "v = [0.0, -10.0]")
            .replace("E = 1e5", "E = 1e4")
            .replace(
                "density = 1.0",
                "density = 1.0\nplasticity = { hardening = \"isotropic\", table = [[50.0, 0.0], [200.0, 1.0]] }",
            )
            .replace("duration = 0.3\nincrements = { fixed = 300 }", "duration = 0.1\nincrements = { fixed = 20 }");
        solved(&text)
    };
    let [explicit, implicit] = [EXPLICIT, "rho_inf = 0.9"].map(yields);
    let at = |of: &super::Table, name: &str| of[name][19];
    for name in ["energy.kinetic", "energy.internal"] {
        let (got, wanted) = (at(&explicit, name), at(&implicit, name));
        assert!((got - wanted).abs() < 5.0, "{name}: {got} {wanted}");
    }
    let least = explicit["energy.algorithmic"]
        .iter()
        .copied()
        .fold(0.0, f64::min);
    assert!(least > -0.05, "{least}");
    // elements that become short ask for shorter increments
    let counts = &explicit["iterations"];
    assert!(counts[19] > 1.3 * counts[0], "{counts:?}");
}

/// A block slides on a floor until friction has stopped it: v²/(2 μ g).
#[test]
fn a_block_that_friction_stops_goes_as_far_as_its_energy_says() {
    let penalty = "enforcement = { penalty = 1e6, per = \"area\" }";
    for contact in [
        "method = \"node-to-segment\"\nenforcement = { lagrange = {} }".to_owned(),
        format!("method = \"node-to-segment\"\n{penalty}"),
        format!("method = \"gauss-point\"\n{penalty}"),
    ] {
        let text = sliding(&contact, "dynamics = { method = \"explicit\" }");
        let got = solved(&text.replace("fixed = 300", "fixed = 30"));
        let last = got["time"].len() - 1;
        let lost = got["energy.friction"][last] + got["energy.algorithmic"][last];
        assert!((lost / 0.5 - 1.0).abs() < 0.02, "{contact}: {lost}");
        assert!(got["energy.friction"][last] > 0.45, "{contact}");
        // penalties let it bounce a little for good
        assert!(got["energy.kinetic"][last] < 5e-3, "{contact}");
        let least = got["energy.algorithmic"]
            .iter()
            .copied()
            .fold(0.0, f64::min);
        // work of friction is that of the shear at the end of a short increment: of first order
        assert!(least > -5e-3, "{contact}: {least}");
    }
}

/// A free rigid body turns as elliptic functions say to second order, and keeps its angular momentum to rounding.
#[test]
fn a_free_body_keeps_its_momentum() {
    let wanted = [
        0.234_294_084_052_856_1,
        -0.972_165_668_877_836_5,
        1.060_643_471_015_299_7,
    ];
    let mut errors = Vec::new();
    for increments in [200, 400] {
        let text = Cube {
            mass: 1.0,
            inertia: "[1, 2, 3]",
            centroid: "",
            velocity: "v = [0.5, 0, 0], omega = [1, 0, 1.2]",
            duration: 10.0,
            increments,
            step: "dynamics = { method = \"explicit\" }",
        }
        .text();
        let got = solved(&text);
        let last = increments - 1;
        assert!((got["pilot.displacement_x"][last] - 5.0).abs() < 1e-12);
        let start = got["energy.kinetic"][0];
        let kept = got["energy.kinetic"]
            .iter()
            .map(|e| (e / start - 1.0).abs());
        assert!(kept.fold(0.0, f64::max) < 2e-3);
        errors.push(distance(spin(&got), wanted));
    }
    assert!(
        errors[1] < 3e-3 && (errors[0] / errors[1]).log2() > 1.9,
        "{errors:?}"
    );
}

/// A pendulum whose pivot is held, about a point off its centre: back after its period.
#[test]
fn a_pendulum_is_back_after_its_period() {
    let angle = 3.0 * std::f64::consts::FRAC_PI_4;
    let mut errors = Vec::new();
    for increments in [400, 800] {
        let text = pendulum(angle, 9.600_377_836_534_811, increments);
        let text = text.replace(
            "load = [{ on = \"all\"",
            "dynamics = { method = \"explicit\" }\nload = [{ on = \"all\"",
        );
        let got = solved(&text);
        errors.push(got["pivot.rotation_z"][increments - 1].abs());
        let height = 0.7 * 2.0 * 9.81 * (1.0 - angle.cos());
        let lost = got["energy.algorithmic"].iter().map(|e| e.abs());
        assert!(lost.fold(0.0, f64::max) < 1e-3 * height);
    }
    assert!(errors[1] < 1e-4 * angle, "{errors:?}");
    assert!(errors[1] < 0.3 * errors[0], "{errors:?}");
}

/// A rigid block falls flat on springs: `π √(m/k)`, and it rises as fast as it fell. By impulses it leaves with its coefficient of restitution.
#[test]
fn a_block_bounces_as_a_mass_on_a_spring() {
    let (m, v, k) = (2.0_f64, 3.0, 5000.0_f64);
    let time = PI * (m / k).sqrt();
    let text = block(
        0.5 * k,
        "v = [0, -3]",
        1.5 * time,
        10,
        "dynamics = { method = \"explicit\", safety = 0.1 }",
    );
    let got = solved(&text);
    assert!((got["block.velocity_y"][9] / v - 1.0).abs() < 5e-3);
    let hard = text.replace(
        "enforcement = { penalty = 2500.0, per = \"node\" }",
        "enforcement = { lagrange = {} }",
    );
    assert!(hard != text);
    for restitution in [0.0, 0.5, 1.0] {
        let text = hard.replace(
            "friction = 0.3\n",
            &format!("friction = 0.3\nrestitution = {restitution:?}\n"),
        );
        let got = solved(&text);
        let rebound = got["block.velocity_y"][9] / v;
        assert!(
            (rebound - restitution).abs() < 1e-9,
            "{restitution}: {rebound}"
        );
        let kept = got["energy.kinetic"][9] / (0.5 * m * v * v);
        assert!((kept - restitution * restitution).abs() < 1e-9);
    }
}

/// A run that is stopped and resumed at any increment, and one on another number of threads, has the same bits.
#[test]
fn a_run_in_mid_flight_goes_on_with_the_same_bits() {
    let checkpoint = "[checkpoint]\nevery = { increments = 1 }\n";
    let weight =
        "load = [{ on = \"block\", gravity = [0, -9.81] }]\ndynamics = { method = \"explicit\" }";
    let contact = "method = \"node-to-segment\"\nenforcement = { lagrange = {} }\nfriction = 0.3";
    let scaled =
        "dynamics = { method = \"explicit\", mass_scaling = { step = 4e-3, limit = 2.0 } }\n";
    let blocks = blocks(3, true, contact).replace("fixed = 60", "fixed = 6") + scaled;
    for text in [block(1e4, "v = [1, 2], omega = 3", 0.6, 20, weight), blocks] {
        let text = text + checkpoint;
        let whole = stopped_after(&text, &[]);
        for stops in [&[4][..], &[6, 9]] {
            assert_eq!(whole, stopped_after(&text, stops), "{stops:?}");
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let alone = pool.unwrap().install(|| stopped_after(&text, &[]));
        assert_eq!(whole, alone);
    }
}

/// Elements of a bar have the highest frequency 2 c/ℓ: the longest stable increment is ℓ/c, and as short ones as that asks for.
#[test]
fn what_is_stable_follows_from_the_elements() {
    for (safety, nonlinear) in [(1.0, false), (0.5, false), (0.5, true)] {
        let mut bar = Bar {
            elements: 10,
            courant: 50.0,
            increments: 1,
            gap: 1e3,
            nonlinear,
            ..Bar::default()
        };
        bar.dynamics = match safety {
            1.0 => "method = \"explicit\", safety = 1.0",
            _ => "method = \"explicit\", safety = 0.5",
        };
        let got = solved(&bar.text());
        let wanted = 50.0 / safety;
        let count = got["iterations"][0];
        // waves across are held, and the bound is that of elements that are not
        assert!(
            (0.99 * wanted..1.1 * wanted).contains(&count),
            "{safety}: {count}"
        );
    }
}

/// A spring of a contact shortens increments, before it closes; a mass that is added makes them longer, up to the limit.
#[test]
fn contacts_and_masses_change_what_is_stable() {
    let bar = Bar {
        elements: 10,
        courant: 20.0,
        increments: 1,
        gap: 0.1,
        dynamics: EXPLICIT,
        ..Bar::default()
    };
    let count = |text: &str| solved(text)["iterations"][0];
    let plain = count(&bar.text());
    let stiff = count(&bar.clone().penalty(10.0).text());
    // ω² ≤ (2 c/ℓ)² (1 + 10 · ½)
    assert!((1.9..2.7).contains(&(stiff / plain)), "{stiff} {plain}");

    let thin = bar.text().replace(", 1.1, ", ", 0.2, ");
    assert!(thin != bar.text());
    let thin = thin.replace("point = [0, 0]", "point = [-1e3, 0]");
    let fine = count(&thin);
    let scaled = thin.replace(
        EXPLICIT,
        "method = \"explicit\", mass_scaling = { step = 0.015, limit = 0.5 }",
    );
    let (finished, got) = solve(&scaled);
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics.plain());
    // its energy counts
    let least = got["energy.algorithmic"][0];
    assert!(least.abs() < 1e-9 * got["energy.kinetic"][0], "{least}");
    assert!(
        got["iterations"][0] < 0.5 * fine,
        "{} {fine}",
        got["iterations"][0]
    );
    let (finished, _) = solve(&scaled.replace("limit = 0.5", "limit = 0.01"));
    assert_ne!(finished.exit_code, 0);
    let said = finished.diagnostics.plain();
    assert!(
        said.contains("of the mass more, where 0.010 is allowed"),
        "{said}"
    );
}

#[test]
fn what_explicit_steps_cannot_have_is_refused() {
    let bar = Bar {
        dynamics: EXPLICIT,
        ..Bar::default()
    };
    for (keys, expected) in [
        (", rho_inf = 0.5", "`rho_inf` means nothing"),
        (
            ", contact_mass = \"redistributed\"",
            "`contact_mass` means nothing",
        ),
        (", error_tol = 1e-3", "`error_tol` means nothing"),
    ] {
        let said = refusal(&bar.text().replace(EXPLICIT, &format!("{EXPLICIT}{keys}")));
        assert!(said.contains(expected), "{said}");
    }
    let said = refusal(&bar.text().replace(EXPLICIT, "safety = 0.5"));
    assert!(
        said.contains("`safety` means nothing with  method = \"generalized-alpha\""),
        "{said}"
    );
    let bounces = "restitution = 0.5\n[initial]";
    let said = refusal(
        &bar.clone()
            .penalty(1.0)
            .text()
            .replace("[initial]", bounces),
    );
    assert!(
        said.contains("`restitution` goes with multipliers"),
        "{said}"
    );
    let implicit = Bar::default().text().replace("[initial]", bounces);
    let error = run(&mut model("yields", &implicit, &[])).error.unwrap();
    assert!(
        error
            .to_string()
            .contains("sides that yield have by themselves"),
        "{error}"
    );
    let damped = bar.clone().penalty(1.0).text();
    let damped = damped.replace("[initial]", "damping = { normal = 1.0 }\n[initial]");
    let error = run(&mut model("damped", &damped, &[])).error.unwrap();
    assert!(
        error.to_string().contains("which explicit steps do not"),
        "{error}"
    );
}
