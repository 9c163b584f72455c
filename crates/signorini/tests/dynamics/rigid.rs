//! Rigid bodies with a mass: free, on a pivot, in contact.

use super::common::{model, run};
use super::{Table, refusal, solve, solved, stopped_after};
use std::fmt::Write;

/// A rigid cube that moves with its centre, and what moves it.
pub struct Cube {
    pub mass: f64,
    pub inertia: &'static str,
    /// Besides `mass` and `inertia`.
    pub centroid: &'static str,
    pub velocity: &'static str,
    pub duration: f64,
    pub increments: usize,
    pub step: &'static str,
}

impl Cube {
    pub fn text(&self) -> String {
        let mut nodes = String::new();
        for k in 0..8 {
            let at = |bit: usize| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
            write!(
                nodes,
                "[{}, {:?}, {:?}, {:?}], ",
                k + 1,
                at(0),
                at(1),
                at(2)
            )
            .unwrap();
        }
        format!(
            "[mesh]\nnodes = [{nodes}]\n\
             elements = [{{ id = 1, type = \"hex8\", group = \"cube\", nodes = [1, 2, 4, 3, 5, 6, 8, 7] }}]\n\
             [model]\nspace = \"3d\"\n[reference.pilot]\nat = [0, 0, 0]\n\
             [[body]]\ngroup = \"cube\"\nrigid = true\nreference = \"pilot\"\n\
             [[mass]]\non = \"pilot\"\nvalue = {:?}\ninertia = {}\n{}\n\
             [initial]\nvelocity = [{{ on = \"pilot\", {} }}]\n\
             [[step]]\nname = \"fly\"\nkind = \"dynamic\"\nduration = {:?}\nincrements = {{ fixed = {} }}\n{}\n",
            self.mass,
            self.inertia,
            self.centroid,
            self.velocity,
            self.duration,
            self.increments,
            self.step,
        )
    }
}

pub fn vector(of: &Table, name: &str, row: usize) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| of[&format!("pilot.{name}_{axis}")][row])
}

/// R of a rotation vector.
pub fn rotation([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    let theta = signorini_geometry::tensor::Vec3::new(x, y, z);
    let rows = signorini_geometry::tensor::Mat3::rotation(theta).rows;
    rows.map(|row| row.to_array())
}

pub fn times(m: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
}

pub fn transposed(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

/// Angular velocity along the axes of the body at the end.
pub fn spin(of: &Table) -> [f64; 3] {
    let last = of["time"].len() - 1;
    let turned = rotation(vector(of, "rotation", last));
    times(transposed(turned), vector(of, "angular_velocity", last))
}

/// A free body turns as Jacobi's elliptic functions say, to second order in the increment, and keeps energy and angular momentum to
/// that order (`reference/dynamics/rigid_rotation.json`); its centroid goes straight on.
#[test]
fn a_free_body_turns_as_elliptic_functions_say() {
    let wanted = [
        0.234_294_084_052_856_1,
        -0.972_165_668_877_836_5,
        1.060_643_471_015_299_7,
    ];
    let mut errors = Vec::new();
    for increments in [100, 200, 400] {
        let got = solved(
            &Cube {
                mass: 1.0,
                inertia: "[1, 2, 3]",
                centroid: "",
                velocity: "v = [0.5, 0, 0], omega = [1, 0, 1.2]",
                duration: 10.0,
                increments,
                step: "",
            }
            .text(),
        );
        let last = increments - 1;
        errors.push(distance(spin(&got), wanted));
        assert!((got["pilot.displacement_x"][last] - 5.0).abs() < 1e-9);
        let turned = rotation(vector(&got, "rotation", last));
        let [a, b, c] = spin(&got);
        let momentum = times(turned, [a, 2.0 * b, 3.0 * c]);
        // 3.5e-3 .. 2.2e-4 there, over 9.4e-3 .. 5.9e-4
        let lost = distance(momentum, [1.0, 0.0, 3.6]) / 3.736;
        assert!(lost < 0.4 * errors[errors.len() - 1], "{lost} {errors:?}");
        let energy = got["energy.kinetic"][last];
        assert!((energy / (0.5 * (1.0 + 3.0 * 1.44) + 0.125) - 1.0).abs() < 1e-3);
    }
    // those of the prototype in the reference: 9.4e-3, 2.4e-3, 5.9e-4
    let known = [9.4e-3, 2.4e-3, 5.9e-4];
    for (got, known) in errors.iter().zip(known) {
        assert!((got / known - 1.0).abs() < 0.02, "{errors:?}");
    }
}

/// A body that spins about its middle axis turns over when the elliptic functions say so.
#[test]
fn a_racket_turns_over_in_time() {
    let got = solved(
        &Cube {
            mass: 1.0,
            inertia: "[1, 2, 3]",
            centroid: "",
            velocity: "omega = [0.001, 1, 0]",
            duration: 14.365_712_218_726_065,
            increments: 3000,
            step: "dynamics = { rho_inf = 1.0 }",
        }
        .text(),
    );
    let [_, middle, _] = spin(&got);
    assert!(middle.abs() < 2e-3, "{middle}");
}

/// A heavy top on its tip, by an ordinary differential equation to twelve digits (`reference/dynamics/rigid_rotation.json`).
#[test]
fn a_heavy_top_goes_round_to_second_order() {
    let wanted = [
        0.548_884_143_009_283_9,
        0.406_994_152_356_877_6,
        -0.730_124_617_799_284_4,
    ];
    let error = |increments: usize| {
        let got = solved(
            &Cube {
                mass: 15.0,
                inertia: "[0.234375, 0.46875, 0.234375]",
                centroid: "centroid = [0, 1, 0]",
                velocity: "omega = [0, 150, -4.61538]",
                duration: 0.25,
                increments,
                step: "load = [{ on = \"pilot\", gravity = [0, 0, -9.81] }]\nfix = [{ on = \"pilot\", u = \"all\" }]",
            }
            .text(),
        );
        let turned = rotation(vector(&got, "rotation", increments - 1));
        let gained = got["energy.algorithmic"].iter().map(|e| e.abs());
        assert!(gained.fold(0.0, f64::max) < 1e-3 * 5435.7);
        distance(times(turned, [0.0, 1.0, 0.0]), wanted)
    };
    let [coarse, fine] = [250, 500].map(error);
    assert!(
        fine < 2e-3 && (coarse / fine).log2() > 1.9,
        "{coarse} {fine}"
    );
}

/// A plane rigid body of one element on a pivot.
pub fn pendulum(angle: f64, period: f64, increments: usize) -> String {
    let (m, g, l, inertia) = (2.0, 9.81, 0.7, 0.3);
    let about_pivot: f64 = inertia + m * l * l;
    let duration = period * (about_pivot / (m * g * l)).sqrt();
    format!(
        "[mesh]\nnodes = [[1, 0, 0], [2, 1, 0], [3, 1, 1], [4, 0, 1]]\n\
         elements = [{{ id = 1, type = \"quad4\", group = \"e\", nodes = [1, 2, 3, 4] }}]\n\
         [model]\nspace = \"plane-strain\"\n[reference.pivot]\nat = [0, 0]\n\
         [[body]]\ngroup = \"e\"\nrigid = true\nreference = \"pivot\"\n\
         [[mass]]\non = \"pivot\"\nvalue = {m:?}\ninertia = {inertia:?}\ncentroid = [{:?}, {:?}]\n\
         [[step]]\nname = \"swing\"\nkind = \"dynamic\"\nduration = {duration:?}\nincrements = {{ fixed = {increments} }}\n\
         load = [{{ on = \"all\", gravity = [0, {:?}] }}]\nfix = [{{ on = \"pivot\", u = \"all\" }}]\n",
        l * angle.sin(),
        -l * angle.cos(),
        -g
    )
}

/// A pendulum is back after `4 K(sin²(θ₀/2))` periods of small swings, on the other side after half of that, and `on = "all"` has its
/// weight.
#[test]
fn a_pendulum_is_back_after_its_period() {
    for (angle, period) in [
        (0.1, 6.287_114_549_310_48),
        (std::f64::consts::FRAC_PI_4, 6.534_345_229_832_591),
        (3.0 * std::f64::consts::FRAC_PI_4, 9.600_377_836_534_811),
    ] {
        let got = solved(&pendulum(angle, period, 400));
        let turned = &got["pivot.rotation_z"];
        assert!(turned[399].abs() < 1e-4 * angle, "{angle}: {}", turned[399]);
        let far = turned.iter().copied().fold(0.0, f64::min);
        assert!((far / angle + 2.0).abs() < 1e-4, "{angle}: {far}");
        let height = 0.7 * 2.0 * 9.81 * (1.0 - angle.cos());
        let lost = got["energy.algorithmic"].iter().map(|e| e.abs());
        assert!(lost.fold(0.0, f64::max) < 1e-4 * height);
    }
}

/// A rigid disc of so many triangles on a plane, in a field of gravity that leans.
pub fn disc(n: usize, mu: f64, increments: usize) -> String {
    let step = std::f64::consts::TAU / n as f64;
    let area = 0.5 * n as f64 * step.sin();
    let mut nodes = "[1, 0.0, 1.0], ".to_owned();
    let (mut elements, mut rim) = (String::new(), String::new());
    for k in 0..n {
        let (sine, cosine) = (step * k as f64).sin_cos();
        write!(nodes, "[{}, {sine:?}, {:?}], ", k + 2, 1.0 - cosine).unwrap();
        let next = (k + 1) % n + 2;
        let of = [1, k + 2, next];
        write!(
            elements,
            "{{ id = {}, type = \"tri3\", group = \"disc\", nodes = {of:?} }}, ",
            k + 1
        )
        .unwrap();
        write!(rim, "[{}, \"S2\"], ", k + 1).unwrap();
    }
    let (sine, cosine) = 20f64.to_radians().sin_cos();
    format!(
        "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"plane-strain\"\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 1.0\nnu = 0.3\ndensity = {:?}\n\
         [[body]]\ngroup = \"disc\"\nrigid = true\nmaterial = \"m\"\n[sets]\nrim = {{ faces = [{rim}] }}\n\
         [[surface]]\nname = \"floor\"\nshape = {{ plane = {{ point = [0, 0], normal = [0, 1] }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"rim\"\nprimary = \"floor\"\nmethod = \"node-to-segment\"\n\
         enforcement = {{ penalty = 2e4, per = \"area\" }}\nfriction = {mu:?}\n\
         [output]\nevery = 1000\n[[step]]\nname = \"roll\"\nkind = \"dynamic\"\nduration = 1.0\n\
         increments = {{ fixed = {increments} }}\nload = [{{ on = \"disc\", gravity = [{:?}, {:?}] }}]\n",
        area.recip(),
        9.81 * sine,
        -9.81 * cosine,
    )
}

/// A disc rolls where friction suffices, and slides and turns where it does not (`reference/dynamics/rolling_and_sliding.json`).
/// Penalties on rigid bodies that are met within a part of an increment lose energy, less in shorter increments; while it slides, the
/// normal force is what the disc has of it as it bounces a little.
#[test]
fn a_disc_rolls_or_slides_down_a_slope() {
    let along = 9.81 * 20f64.to_radians().sin();
    for mu in [0.5, 0.05] {
        let got = solved(&disc(360, mu, 800));
        let speed = got["disc.velocity_x"][799];
        let spin = -got["disc.angular_velocity_z"][799];
        let normal: f64 = got["c.force_y"].iter().map(|f| f.abs() / 800.0).sum();
        let wanted = match mu > 0.1 {
            true => [2.0 / 3.0 * along; 2],
            false => [along - mu * normal, 2.0 * mu * normal],
        };
        assert!((normal / (9.81 * 20f64.to_radians().cos()) - 1.0).abs() < 0.02);
        // the penetration, up to 6e-3, shortens the arm of friction
        assert!(
            (speed / wanted[0] - 1.0).abs() < 5e-3,
            "{mu}: {speed} {wanted:?}"
        );
        assert!(
            (spin / wanted[1] - 1.0).abs() < 1e-2,
            "{mu}: {spin} {wanted:?}"
        );
        let least = got["energy.algorithmic"]
            .iter()
            .copied()
            .fold(0.0, f64::min);
        assert!(least > -1e-4 * got["energy.kinetic"][799], "{least}");
    }
}

/// A rigid block on a floor, by penalties at its nodes.
pub fn block(
    penalty: f64,
    velocity: &str,
    duration: f64,
    increments: usize,
    extra: &str,
) -> String {
    format!(
        "[mesh]\nnodes = [[1, 0, 0], [2, 1, 0], [3, 1, 1], [4, 0, 1]]\n\
         elements = [{{ id = 1, type = \"quad4\", group = \"block\", nodes = [1, 2, 3, 4] }}]\n\
         [model]\nspace = \"plane-strain\"\n\
         [[body]]\ngroup = \"block\"\nrigid = true\n\
         [[mass]]\non = \"block\"\nvalue = 2.0\ninertia = 0.333\n\
         [sets]\nsides = {{ faces = [[1, \"-y\"], [1, \"+x\"], [1, \"-x\"], [1, \"+y\"]] }}\n\
         [[surface]]\nname = \"floor\"\nshape = {{ plane = {{ point = [0, 0], normal = [0, 1] }} }}\n\
         [[contact]]\nname = \"c\"\nsecondary = \"sides\"\nprimary = \"floor\"\nmethod = \"node-to-segment\"\n\
         enforcement = {{ penalty = {penalty:?}, per = \"node\" }}\nfriction = 0.3\n\
         [initial]\nvelocity = [{{ on = \"block\", {velocity} }}]\n\
         [[step]]\nname = \"move\"\nkind = \"dynamic\"\nduration = {duration:?}\nincrements = {{ fixed = {increments} }}\n{extra}\n"
    )
}

#[test]
fn a_block_slides_to_rest() {
    let weight = "load = [{ on = \"block\", gravity = [0, -9.81] }]";
    let got = solved(&block(1e6, "v = [2, 0]", 0.8, 400, weight));
    let way = got["block.displacement_x"][399];
    assert!((way / 0.679_578_661_230_037_4 - 1.0).abs() < 1e-5, "{way}");
    assert!(got["block.velocity_x"][399].abs() < 1e-6);
    // ½ m v²
    assert!((got["energy.friction"][399] / 4.0 - 1.0).abs() < 1e-3);
}

/// A block that falls flat on springs: `π √(m/k)`, `v √(m/k)`, `v √(m k)` for short increments; the rebound is less for long ones, and
/// never more.
#[test]
fn a_block_bounces_as_a_mass_on_a_spring() {
    let (m, v, k) = (2.0_f64, 3.0, 5000.0_f64);
    let time = std::f64::consts::PI * (m / k).sqrt();
    let mut before = 1.0;
    for (h, least) in [(0.003, 0.99), (0.03, 0.93), (0.1, 0.80), (0.3, 0.54)] {
        let increments = (1.5 / h) as usize;
        let duration = h * increments as f64 * time;
        let got = solved(&block(0.5 * k, "v = [0, -3]", duration, increments, ""));
        let rebound = got["block.velocity_y"][increments - 1] / v;
        assert!(rebound > least && rebound < before, "{h}: {rebound}");
        before = rebound;
        if h < 0.01 {
            let force = got["c.force_y"].iter().map(|f| f.abs()).fold(0.0, f64::max);
            let depth = got["block.displacement_y"]
                .iter()
                .copied()
                .fold(0.0, f64::min);
            assert!((force / (v * (m * k).sqrt()) - 1.0).abs() < 0.01, "{force}");
            assert!((depth / (v * (m / k).sqrt()) + 1.0).abs() < 0.01, "{depth}");
        }
    }
}

/// A block that falls flat on springs with dampers: it leaves with the velocity of a damped oscillation at the time when its force is
/// zero, and what it has lost is in the dampers, what the springs keep then included.
#[test]
fn a_damped_block_bounces_as_a_damped_oscillator() {
    let (m, v, k) = (2.0_f64, 3.0, 5000.0_f64);
    let w = (k / m).sqrt();
    for xi in [0.05_f64, 0.3] {
        let root = (1.0 - xi * xi).sqrt();
        let (wd, c) = (w * root, 2.0 * xi * (k * m).sqrt());
        let t = (std::f64::consts::PI - (2.0 * xi * root).atan2(1.0 - 2.0 * xi * xi)) / wd;
        let wanted = -v * (-xi * w * t).exp() * ((wd * t).cos() - xi / root * (wd * t).sin());
        let mut errors = Vec::new();
        for increments in [100, 200] {
            // two nodes touch
            let conserving = "dynamics = { method = \"energy-momentum\" }\n[solver]\nnewton = { force_tol = 1e-11 }";
            let duration = 1.5 * std::f64::consts::PI / w;
            let text = block(0.5 * k, "v = [0, -3]", duration, increments, conserving);
            let damping = format!("friction = 0.3\ndamping = {{ normal = {:?} }}\n", 0.5 * c);
            let got = solved(&text.replace("friction = 0.3\n", &damping));
            let last = increments - 1;
            errors.push((got["block.velocity_y"][last] - wanted).abs() / v);
            let lost = 0.5 * m * v * v - got["energy.kinetic"][last];
            assert!((got["energy.damping"][last] / lost - 1.0).abs() < 1e-9);
            assert!(got["energy.algorithmic"][last].abs() < 1e-9);
            assert!(got["c.force_y"].iter().all(|f| *f >= 0.0));
        }
        assert!(
            errors[0] < 2e-4 && errors[1] < 0.4 * errors[0],
            "{xi}: {errors:?}"
        );
    }
}

#[test]
fn a_tumbling_block_goes_on_with_the_same_bits_and_gains_no_energy() {
    let weight = "load = [{ on = \"block\", gravity = [0, -9.81] }]";
    let text = block(1e4, "v = [1, 2], omega = 3", 0.6, 60, weight);
    let got = solved(&text);
    let least = got["energy.algorithmic"]
        .iter()
        .copied()
        .fold(0.0, f64::min);
    assert!(least > -1e-9, "{least}");
    let text = text + "[checkpoint]\nevery = { increments = 1 }\n";
    let whole = stopped_after(&text, &[]);
    for stops in [&[5][..], &[40, 100]] {
        assert_eq!(whole, stopped_after(&text, stops), "{stops:?}");
    }
}

/// What is not resolved of its impacts costs the usual method most of its energy; the method that conserves it keeps it, and the block
/// goes on in a resumed run with the same bits.
#[test]
fn a_tumbling_block_keeps_its_energy() {
    let weight = "load = [{ on = \"block\", gravity = [0, -9.81] }]";
    let exact = "[solver]\nnewton = { force_tol = 1e-11 }\n";
    let by = |dynamics: &str| {
        let step = format!("{weight}\ndynamics = {{ {dynamics} }}\n{exact}");
        block(1e5, "v = [1, 2], omega = 3", 1.5, 300, &step).replace("friction = 0.3\n", "")
    };
    let there = |got: &Table| -> Vec<f64> {
        let rows = 0..got["time"].len();
        let at = |row: usize| {
            got["energy.kinetic"][row] + got["energy.contact"][row] - got["energy.external"][row]
        };
        rows.map(at).collect()
    };
    let lost = there(&solved(&by("rho_inf = 0.8")));
    assert!(lost[299] < 0.1 * lost[0], "{lost:?}");
    let text = by("method = \"energy-momentum\"");
    let (finished, got) = solve(&text);
    assert!(
        finished.summary.audit.passed,
        "{}",
        finished.diagnostics.plain()
    );
    assert!(got["c.force_y"].iter().filter(|f| **f > 0.0).count() > 3);
    let kept = there(&got);
    for energy in &kept {
        assert!(
            (energy / kept[0] - 1.0).abs() < 1e-9,
            "{energy} {}",
            kept[0]
        );
    }
    let text = text + "[checkpoint]\nevery = { increments = 1 }\n";
    let whole = stopped_after(&text, &[]);
    assert_eq!(whole, stopped_after(&text, &[120, 200]));
}

/// A free body keeps energy and angular momentum to rounding, and turns as elliptic functions say to second order.
#[test]
fn a_free_body_keeps_energy_and_momentum() {
    let wanted = [
        0.234_294_084_052_856_1,
        -0.972_165_668_877_836_5,
        1.060_643_471_015_299_7,
    ];
    let mut errors = Vec::new();
    for increments in [100, 200, 400] {
        let text = Cube {
            mass: 1.0,
            inertia: "[1, 2, 3]",
            centroid: "",
            velocity: "v = [0.5, 0, 0], omega = [1, 0, 1.2]",
            duration: 10.0,
            increments,
            step: "dynamics = { method = \"energy-momentum\" }\n[solver]\nnewton = { force_tol = 1e-11 }",
        };
        let got = solved(&text.text());
        let last = increments - 1;
        errors.push(distance(spin(&got), wanted));
        let turned = rotation(vector(&got, "rotation", last));
        let [a, b, c] = spin(&got);
        let momentum = times(turned, [a, 2.0 * b, 3.0 * c]);
        assert!(distance(momentum, [1.0, 0.0, 3.6]) < 1e-9, "{momentum:?}");
        let energies = &got["energy.kinetic"];
        let start = 0.5 * (1.0 + 3.0 * 1.44) + 0.125;
        assert!(energies.iter().all(|e| (e / start - 1.0).abs() < 1e-11));
    }
    // those of the prototype in the reference: 1.1e-2, 2.8e-3, 6.9e-4
    for (got, known) in errors.iter().zip([1.1e-2, 2.8e-3, 6.9e-4]) {
        assert!((got / known - 1.0).abs() < 0.05, "{errors:?}");
    }
}

#[test]
fn what_rigid_bodies_need_for_a_motion_is_said() {
    let text = block(1e4, "v = [1, 2], omega = 3", 0.6, 60, "");
    assert_eq!(refusal(&text), "");
    let mass = "[[mass]]\non = \"block\"\nvalue = 2.0\ninertia = 0.333\n";
    let without = refusal(&text.replace(mass, ""));
    assert!(
        without.contains("without mass has no velocity"),
        "{without}"
    );
    let three = refusal(&text.replace("inertia = 0.333", "inertia = [1, 1, 1]"));
    assert!(three.contains("`inertia` does not go"), "{three}");
    let of_set = refusal(&text.replace("on = \"block\"\nvalue", "on = \"sides\"\nvalue"));
    assert!(of_set.contains("`inertia` of a mass at nodes"), "{of_set}");
    let light = text.replace(mass, "").replace(
        "rigid = true\n",
        "rigid = true\nmaterial = \"m\"\n[material.m]\nmodel = \"linear-elastic\"\nE = 1.0\nnu = 0.3\n",
    );
    let refused = refusal(&light);
    assert!(refused.contains("that has no `density`"), "{refused}");
    let damped = light.replace(
        "nu = 0.3\n",
        "nu = 0.3\ndensity = 1.0\ndamping = { mass = 1.0 }\n",
    );
    let refused = refusal(&damped);
    assert!(refused.contains("damping of a rigid body"), "{refused}");
    let pull = text.replace(mass, "").replace(
        "[initial]\nvelocity = [{ on = \"block\", v = [1, 2], omega = 3 }]\n",
        "",
    );
    let pull = refusal(&(pull + "load = [{ on = \"block\", gravity = [0, -9.81] }]\n"));
    assert!(pull.contains("\"block\" has no mass"), "{pull}");
}

/// Bodies that begin to move take part from then on: in a stepper without a run around it, and after a static step.
#[test]
fn bodies_move_from_the_first_dynamic_step_on() {
    let free = pendulum(0.7, 4.0, 20).replace("fix = [{ on = \"pivot\", u = \"all\" }]", "");
    let waits = free.replacen("[[step]]", "[[step]]\nname = \"wait\"\n[[step]]", 1);
    for text in [free, waits] {
        let done = run(&mut model("falls", &text, &[]));
        assert!(done.error.is_none(), "{:?}", done.error);
        for got in [
            done.frames.last().unwrap().rigid[0].displacement.y,
            *solved(&text)["pivot.displacement_y"].last().unwrap(),
        ] {
            let t = 4.0 * ((0.3 + 2.0 * 0.7 * 0.7) / (2.0 * 9.81 * 0.7_f64)).sqrt();
            let way = -0.5 * 9.81 * t * t;
            assert!((got / way - 1.0).abs() < 1e-9, "{got} for {way}");
        }
    }
}
