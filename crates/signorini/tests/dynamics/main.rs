//! Motions in time: dynamics with contact.
//!
//! SOURCE      Doyen, Ern and Piperno, SIAM J. Sci. Comput. 33, 2011 (bar that bounces); closed forms of waves in bars; the
//!             recursion of the generalized-α method
//! GOAL        the method is what its equations say, of second order; impacts have the force and the rebound of the exact
//!             solution, and give no energy
//! MESH        bars of quad4, blocks of quad4 and hex8
//! CONDITIONS  free vibration, impact on a wall and of two bodies, by multipliers and penalties
//! EXPECTED    see each test
//! TOLERANCE   see each test
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

mod bar;
mod blocks;
#[path = "../common/mod.rs"]
mod common;
mod conserving;
mod control;
mod damped;
mod explicit;
mod hard;
mod impact;
mod rigid;
mod start;
mod weighted;

use bar::{Bar, LENGTH, WAVE};
use signorini::{Finished, News, Reading, RunOptions, build, open_text, run};
use signorini_io::fs::{Fs, MemoryFs};
use signorini_mechanics::solve::Flow;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The columns of `history.csv` by name.
type Table = HashMap<String, Vec<f64>>;

fn solve(text: &str) -> (Finished, Table) {
    let (finished, table, ..) = solve_in(text);
    (finished, table)
}

/// The same with the files of the run, and the folder that they are in.
fn solve_in(text: &str) -> (Finished, Table, Arc<dyn Fs>, PathBuf) {
    let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default());
    let loaded = opened.and_then(|opened| opened.with_mesh());
    let loaded = loaded.unwrap_or_else(|found| panic!("{}", found.plain()));
    let fs: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let mut options = RunOptions::new(loaded.source);
    options.fs = Arc::clone(&fs);
    let folder = options.folder.clone();
    let mut model =
        build(loaded.case, loaded.mesh).unwrap_or_else(|found| panic!("{}", found.plain()));
    let finished = run(&mut model, &options, &mut ());
    let history = fs.read(&folder.join("history.csv")).unwrap();
    let table = table(&String::from_utf8(history).unwrap());
    (finished, table, fs, folder)
}

fn table(text: &str) -> Table {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let column = |k: usize| {
        let values = rows.iter().map(|row| row[k].parse().unwrap_or(f64::NAN));
        values.collect()
    };
    let named = names.iter().enumerate();
    named
        .map(|(k, name)| ((*name).to_owned(), column(k)))
        .collect()
}

/// What is in the bodies and in contact.
fn energy(of: &Table) -> Vec<f64> {
    let parts = ["energy.kinetic", "energy.internal", "energy.contact"].map(|name| &of[name]);
    (0..parts[0].len())
        .map(|k| parts.iter().map(|part| part[k]).sum())
        .collect()
}

#[track_caller]
fn solved(text: &str) -> Table {
    let (finished, table) = solve(text);
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics.plain());
    table
}

/// Why a case is refused.
fn refusal(text: &str) -> String {
    let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default());
    let built = opened
        .and_then(|opened| opened.with_mesh())
        .and_then(|loaded| build(loaded.case, loaded.mesh).map(drop));
    built.err().map_or_else(String::new, |found| found.plain())
}

/// Damping of the oscillator over mass, over stiffness, and half of each: `a + b ω² = 2 ξ ω`.
fn dampings() -> [[f64; 2]; 3] {
    let (w, xi) = (std::f64::consts::TAU, 0.02);
    let (mass, stiffness) = (2.0 * xi * w, 2.0 * xi / w);
    [[mass, 0.0], [0.0, stiffness], [0.5 * mass, 0.5 * stiffness]]
}

/// One element between a base and nodes that move alike: a mass on a spring, with damping; pulled, and let go. Its frequency is 1.
fn oscillator(dynamics: &str, [mass, stiffness]: [f64; 2], increments: usize, h: f64) -> String {
    let w = std::f64::consts::TAU;
    // k = E, m = ρ/2 of a cube of lumped mass
    format!(
        "[mesh]\nnodes = [[1, 0, 0], [2, 1, 0], [3, 1, 1], [4, 0, 1]]\n\
         elements = [{{ id = 1, type = \"quad4\", group = \"e\", nodes = [1, 2, 3, 4] }}]\n\
         [model]\nspace = \"plane-strain\"\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = {:?}\nnu = 0.0\ndensity = 2.0\ndamping = {{ mass = {mass:?}, stiffness = {stiffness:?} }}\n\
         [[body]]\ngroup = \"e\"\nmaterial = \"m\"\nmass_matrix = \"lumped\"\n\
         [sets]\nbase = {{ nodes = [1, 4] }}\ntip = {{ nodes = [2, 3] }}\n\
         [[output.history]]\nname = \"tip\"\nset = \"tip\"\nquantity = [\"displacement.x\", \"velocity.x\", \"acceleration.x\"]\n\
         [[step]]\nname = \"pull\"\ngeometry = \"linear\"\nincrements = 1\n\
         fix = [{{ on = \"base\", u = \"all\" }}, {{ on = \"tip\", u = [\"y\"] }}]\nmove = [{{ on = \"tip\", ux = 1.0 }}]\n\
         [[step]]\nname = \"let go\"\nkind = \"dynamic\"\nduration = {:?}\nincrements = {{ fixed = {increments} }}\n\
         dynamics = {{ {dynamics} }}\nfree = [{{ on = \"tip\", u = [\"x\"] }}]\n",
        w * w,
        h * increments as f64
    )
}

/// αm, αf, β, γ.
fn parameters(dynamics: &str) -> [f64; 4] {
    let (name, value) = dynamics.split_once(" = ").unwrap();
    let value: f64 = value.parse().unwrap();
    match name {
        "alpha" => [
            0.0,
            -value,
            (1.0 - value) * (1.0 - value) / 4.0,
            0.5 - value,
        ],
        _ => {
            let (m, f) = ((2.0 * value - 1.0) / (value + 1.0), value / (value + 1.0));
            let sum = 1.0 - m + f;
            [m, f, 0.25 * sum * sum, 0.5 - m + f]
        }
    }
}

const SCHEMES: [&str; 7] = [
    "alpha = 0.0",
    "alpha = -0.05",
    "alpha = -0.3",
    "rho_inf = 1.0",
    "rho_inf = 0.8",
    "rho_inf = 0.5",
    "rho_inf = 0.0",
];

#[test]
fn a_mass_on_a_spring_moves_as_the_recursion_says() {
    let (w, xi, h) = (std::f64::consts::TAU, 0.02, 0.05);
    let cases = SCHEMES
        .iter()
        .flat_map(|one| dampings().map(|of| (*one, of)));
    for (dynamics, damping) in cases {
        let [m, f, beta, gamma] = parameters(dynamics);
        let got = solved(&oscillator(dynamics, damping, 20, h));
        let (mut u, mut v) = (1.0, 0.0);
        let mut a = -w * w * u;
        for k in 0..20 {
            // (1-m) a1 + m a0 + 2 xi w v_alpha + w² u_alpha = 0 for a1
            let c = 2.0 * xi * w;
            let (pu, pv) = (
                u + h * v + h * h * (0.5 - beta) * a,
                v + h * (1.0 - gamma) * a,
            );
            let given = m * a + c * ((1.0 - f) * pv + f * v) + w * w * ((1.0 - f) * pu + f * u);
            let slope = (1.0 - m) + c * (1.0 - f) * gamma * h + w * w * (1.0 - f) * beta * h * h;
            let last = -given / slope;
            (u, v, a) = (pu + beta * h * h * last, pv + gamma * h * last, last);
            // the first row is that of the static step
            for (name, wanted) in [("displacement", u), ("velocity", v), ("acceleration", a)] {
                let value = got[&format!("tip.{name}.x")][k + 1];
                let scale = [1.0, w, w * w][["displacement", "velocity", "acceleration"]
                    .iter()
                    .position(|n| *n == name)
                    .unwrap()];
                assert!(
                    (value - wanted).abs() < 1e-11 * scale,
                    "{dynamics} {k} {name}: {value} {wanted}"
                );
            }
        }
    }
}

/// The same against the numbers that come with the issue.
#[test]
fn a_mass_on_a_spring_is_that_of_the_reference() {
    let Some(reference) = common::reference("dynamics/single_dof.json") else {
        return;
    };
    let cases = SCHEMES
        .iter()
        .flat_map(|one| dampings().map(|of| (*one, of)));
    for (dynamics, damping) in cases {
        let name = dynamics.replace("alpha =", "hht").replace(" =", "");
        let got = solved(&oscillator(dynamics, damping, 20, 0.05));
        for (row, key) in [(1, "step1"), (20, "step20")] {
            let wanted = &reference["table"][&name][key];
            for (k, what) in ["displacement", "velocity", "acceleration"]
                .iter()
                .enumerate()
            {
                let wanted = wanted[k].as_f64().unwrap_or_else(|| panic!("{name}"));
                let got = got[&format!("tip.{what}.x")][row];
                let scale = std::f64::consts::TAU.powi(k as i32);
                assert!(
                    (got - wanted).abs() < 1e-11 * scale,
                    "{name} {key} {what}: {got} {wanted}"
                );
            }
        }
    }
}

/// A bar that hits a wall: the force is ρ c v for the time 2 L/c, whatever the phase of an increment in which it closes.
#[test]
fn a_bar_that_hits_a_wall_has_the_force_of_its_wave_and_gains_no_energy() {
    // how a law is chosen, and what the energy may be at the end (%), and how far the force from ρ c v in the middle
    let scene = |courant: f64, dynamics, penalty: Option<f64>| {
        let bar = Bar {
            courant,
            dynamics,
            ..Bar::default()
        };
        penalty.map_or(bar.clone(), |times| bar.penalty(times))
    };
    let usual = "rho_inf = 0.8";
    let apart = "rho_inf = 0.8, contact_mass = \"redistributed\"";
    let conserving = "rho_inf = 1.0, contact_mass = \"redistributed\"";
    let secants = "method = \"energy-momentum\", contact_mass = \"redistributed\"";
    let flickering = "method = \"energy-momentum\"";
    for (courant, dynamics, penalty, [low, high], rms_most) in [
        (0.5, usual, None, [-0.85, -0.6], 0.01),
        (0.5, usual, Some(10.0), [-0.9, -0.6], 0.008),
        (0.5, usual, Some(100.0), [-0.85, -0.6], 0.009),
        (1.5, usual, None, [-1.8, -1.1], 0.08),
        (1.5, usual, Some(10.0), [-1.8, -1.1], 0.015),
        (0.5, apart, None, [-0.2, 0.0], 0.0015),
        (0.5, apart, Some(10.0), [-0.3, 0.0], 0.0015),
        (1.5, apart, None, [-1.1, -0.3], 0.003),
        (0.5, conserving, None, [-0.12, 1e-9], 0.003),
        (0.5, secants, Some(10.0), [-1e-7, 1e-7], 0.002),
        (0.5, secants, Some(100.0), [-1e-7, 1e-7], 0.0024),
        (1.5, secants, Some(10.0), [-1e-7, 1e-7], 0.0024),
        (1.5, secants, Some(100.0), [-1e-7, 1e-7], 0.003),
        (0.5, secants, None, [-0.12, 1e-7], 0.003),
        (1.5, secants, None, [-0.8, 1e-7], 0.003),
        (0.5, flickering, Some(10.0), [-1e-7, 1e-7], 0.6),
        (0.5, flickering, Some(1.0), [-1e-7, 1e-7], 0.024),
        (1.5, flickering, Some(1.0), [-1e-7, 1e-7], 0.014),
    ] {
        for phase in 0..4 {
            let mut bar = scene(courant, dynamics, penalty);
            let h = bar.h();
            bar.gap = bar.velocity * h * (2.0 + f64::from(phase) / 4.0);
            bar.increments = (1.0 / h) as usize;
            let exact = "[solver]\nnewton = { force_tol = 1e-11 }\n";
            let got = solved(&(bar.text() + exact));
            let energies = energy(&got);
            let last = 100.0 * (energies.last().unwrap() / 500.0 - 1.0);
            let place = format!("{courant} {dynamics} {penalty:?} {phase}");
            assert!((low..high).contains(&last), "{place}: energy {last}");
            let largest = energies.iter().copied().fold(0.0, f64::max);
            assert!(largest < 500.0 * 1.004, "{place}: {largest}");
            let (force, begin) = (WAVE * bar.velocity, bar.gap / bar.velocity);
            let long = 2.0 * LENGTH / WAVE;
            let middle = begin + 0.1 * long..begin + 0.9 * long;
            let rows = got["time"].iter().zip(&got["c.force_x"]);
            let middle = rows.filter(|(t, _)| middle.contains(*t));
            let errors: Vec<f64> = middle.map(|(_, f)| f / force - 1.0).collect();
            let squares: f64 = errors.iter().map(|e| e * e).sum();
            let rms = (squares / errors.len() as f64).sqrt();
            assert!(rms < rms_most, "{place}: force {rms}");
            // it flies back as a whole, but for waves that numbers leave
            let after = got["time"].iter().position(|t| *t > begin + 1.1 * long);
            assert!(got["c.force_x"][after.unwrap()..].iter().all(|f| *f == 0.0));
        }
    }
}

#[test]
fn displacements_are_of_second_order_with_contact_open_and_closed() {
    // a bar that stands on the wall, pushed on by a force that begins smoothly; compared with the smallest increment
    for on_wall in [true, false] {
        let at_end = |increments: usize| {
            let bar = Bar {
                elements: 10,
                courant: 0.4 * WAVE / increments as f64,
                gap: if on_wall { 0.0 } else { 1.0 },
                velocity: 0.0,
                increments,
                ..Bar::default()
            };
            let bar = Bar {
                courant: 0.4 * WAVE / (bar.size() * increments as f64),
                step: "load = [{ on = \"head\", force = [-30.0, 0.0], amplitude = \"smooth\" }]\n\
                       [amplitude.smooth]\ntable = [TABLE]"
                    .replace("TABLE", &smooth(0.4)),
                ..bar
            };
            let got = solved(
                &bar.text()
                    .replace("\"low\"\nset = \"foot\"", "\"low\"\nset = \"head\""),
            );
            *got["low.displacement.x"].last().unwrap()
        };
        let exact = at_end(1280);
        let [coarse, fine] = [80, 160].map(|n| (at_end(n) - exact).abs());
        let slope = (coarse / fine).log2();
        assert!(
            slope > 1.9,
            "on the wall: {on_wall}: {slope}, {coarse:e}, {fine:e}"
        );
    }
}

/// Rows of sin² over a time, so fine that increments see no kinks.
fn smooth(duration: f64) -> String {
    let rows = (0..=5120).map(|k| {
        let part = f64::from(k) / 5120.0;
        let value = (std::f64::consts::PI * part).sin().powi(2);
        format!("[{:?}, {value:?}]", duration * part)
    });
    rows.collect::<Vec<_>>().join(", ")
}

/// What contact by ALPHA adds to the energy is said; what the usual method takes is not.
#[test]
fn energy_that_the_method_adds_causes_a_warning() {
    for (dynamics, is_said) in [("alpha = 0.0", true), ("rho_inf = 0.8", false)] {
        let bar = Bar {
            dynamics,
            gap: 0.06,
            increments: 400,
            ..Bar::default()
        };
        let (finished, _) = solve(&bar.text());
        let said = finished.diagnostics.plain();
        assert_eq!(
            said.contains("warning[S0427]"),
            is_said,
            "{dynamics}: {said}"
        );
        assert_eq!(finished.summary.audit.passed, !is_said);
    }
}

/// A bar falls by 5, and is back there after 16/3 of time: the force rises from 300 to 500 in its first contact.
#[test]
fn a_bar_that_is_dropped_bounces_in_its_period() {
    let bar = Bar {
        elements: 30,
        gap: 5.0,
        velocity: 0.0,
        dynamics: "rho_inf = 0.95, contact_mass = \"redistributed\"",
        step: "load = [{ on = \"bar\", gravity = [-10.0, 0.0] }]".into(),
        ..Bar::default()
    };
    let bar = Bar {
        increments: (16.0 / 3.0 / bar.h()).round() as usize,
        ..bar
    };
    let got = solved(&bar.text());
    let last = got["low.displacement.x"].last().unwrap();
    assert!(last.abs() < 0.15, "{last}");
    let lost = got["energy.algorithmic"].last().unwrap() / 500.0;
    assert!((0.0..0.004).contains(&lost), "{lost}");
    let gains = got["energy.algorithmic"].iter().map(|e| -e);
    assert!(gains.fold(0.0, f64::max) < 1e-3 * 500.0);
    let rows = got["time"].iter().zip(&got["c.force_x"]);
    for (t, force) in rows.filter(|(t, _)| (1.1..1.6).contains(*t)) {
        let exact = 300.0 + 300.0 * (t - 1.0);
        assert!((force / exact - 1.0).abs() < 0.04, "{t}: {force} {exact}");
    }
    // momentum: what contact gives is what gravity takes
    let h = bar.h();
    let impulse: f64 = got["c.force_x"].iter().map(|f| f * h).sum();
    assert!((impulse / (1600.0 / 3.0) - 1.0).abs() < 0.01, "{impulse}");
}

/// A run that is stopped and resumed anywhere, and one on another number of threads, has the same bits.
#[test]
fn a_run_in_mid_flight_goes_on_with_the_same_bits() {
    let bar = Bar {
        elements: 12,
        gap: 0.5,
        increments: 24,
        courant: 0.9,
        ..Bar::default()
    };
    let text = bar.text() + "[checkpoint]\nevery = { increments = 1 }\n";
    let whole = stopped_after(&text, &[]);
    for stops in [&[1][..], &[7], &[12, 19], &[30, 31, 50]] {
        assert_eq!(whole, stopped_after(&text, stops), "{stops:?}");
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let alone = pool.unwrap().install(|| stopped_after(&text, &[]));
    assert_eq!(whole, alone);
}

/// `history.csv` of a run that is stopped after so many events, and goes on until it is stopped again.
fn stopped_after(text: &str, stops: &[usize]) -> String {
    let fs: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let mut folder = PathBuf::new();
    for (part, stop) in stops.iter().map(Some).chain([None]).enumerate() {
        let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default()).unwrap();
        let loaded = opened.with_mesh().unwrap();
        let mut options = RunOptions::new(loaded.source);
        (options.fs, options.resume) = (Arc::clone(&fs), part > 0);
        folder = options.folder.clone();
        let mut model = build(loaded.case, loaded.mesh).unwrap();
        let mut count = 0;
        let finished = run(&mut model, &options, &mut |_: &News<'_>| {
            count += 1;
            match stop {
                Some(&stop) if count >= stop => Flow::Stop,
                _ => Flow::Continue,
            }
        });
        let wanted = if stop.is_some() { 130 } else { 0 };
        assert_eq!(
            finished.exit_code,
            wanted,
            "{}",
            finished.diagnostics.plain()
        );
    }
    String::from_utf8(fs.read(&folder.join("history.csv")).unwrap()).unwrap()
}

#[test]
fn what_a_dynamic_step_needs_is_said() {
    let text = Bar::default().text();
    let without = refusal(&text.replace("density = 1.0\n", ""));
    assert!(without.contains("no density"), "{without}");
    let still = text.replace("kind = \"dynamic\"\n", "");
    let refused = refusal(&still);
    assert!(
        refused.contains("`dynamics` belongs to dynamic steps"),
        "{refused}"
    );
    let still = still.replace("dynamics = { rho_inf = 0.8 }\n", "");
    let refused = refusal(&still);
    assert!(
        refused.contains("velocities at the start of a static step"),
        "{refused}"
    );
    let both = refusal(&text.replace("rho_inf = 0.8", "rho_inf = 0.8, alpha = -0.1"));
    assert!(both.contains("alpha"), "{both}");
    let removes = text.replace("fix = [", "deactivate = [{ group = \"bar\" }]\nfix = [");
    let refused = refusal(&removes);
    assert!(refused.contains("neither removed nor added"), "{refused}");
    let rigid = text
        .replace("material = \"m\"\n[sets]", "rigid = true\n[sets]")
        .replace("fix = [{ on = \"bar\", u = [\"y\"] }]", "");
    let refused = refusal(&rigid);
    assert!(
        refused.contains("without mass has no velocity"),
        "{refused}"
    );
    let thin = Bar {
        elements: 2,
        dynamics: "contact_mass = \"redistributed\"",
        ..Bar::default()
    };
    let refused = refusal(&thin.text());
    assert!(
        refused.contains("less than three elements thick"),
        "{refused}"
    );
    let thick = Bar {
        elements: 3,
        ..thin
    };
    assert_eq!(refusal(&thick.text()), "");
    for wrong in [
        "rho_inf = 1.1",
        "rho_inf = -0.1",
        "alpha = 0.1",
        "alpha = -0.5",
    ] {
        assert!(
            !refusal(&text.replace("rho_inf = 0.8", wrong)).is_empty(),
            "{wrong}"
        );
    }
}
