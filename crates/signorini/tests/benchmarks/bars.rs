//! Bars that meet walls and each other: exact answers in a few unknowns.
//!
//! SOURCE      Mechanics of bars; for many gaps the conditions of Karush, Kuhn and Tucker, by trying every active set.
//! GOAL        gaps close, forces are those of statics, whatever finds the pressure
//! MESH        a few line2
//! CONDITIONS  small displacements; multipliers, Uzawa's augmented Lagrangian, penalty; against a surface, a side and a node
//! EXPECTED    closed forms at the functions below
//! TOLERANCE   1e-10 for multipliers and Uzawa; for penalties the error is force/penalty, of slope −1
use crate::common::{Run, run};
use crate::scene::{Scene, equal};

/// How pressures are found.
const EXACT: [&str; 3] = [
    "{ lagrange = {} }",
    "{ augmented = \"uzawa\" }",
    "{ augmented = \"newton\" }",
];
/// What the tip of the bar meets: the other side of the contact, and the method.
const STOPS: [&str; 3] = ["wall", "plate", "pin"];

/// Fixed at 0, of length 2 and stiffness EA = 10; what stops its tip after a gap.
fn stopped(stop: &str, gap: f64, enforcement: &str, load: &str, nbar: usize) -> Run {
    let mut scene = Scene::default();
    let ends: Vec<usize> = equal(0.0, 2.0, nbar)
        .into_iter()
        .map(|x| scene.node(&[x, 0.0]))
        .collect();
    for pair in ends.windows(2) {
        scene.cell("line2", "bar", pair.to_vec());
    }
    let x = 2.0 + gap;
    let grid = scene.grid("plate", [&[x, x + 1.0], &[-0.5, 0.5]], |x, y| [x, y]);
    let pin = scene.node(&[x, 0.0]);
    let far = scene.node(&[x + 1.0, 0.0]);
    scene.cell("line2", "pin", vec![pin, far]);
    scene.set("left", &ends[..1]);
    scene.set("bar_nodes", &ends);
    scene.set("tip", &ends[nbar..]);
    scene.set("pin_node", &[pin]);
    scene.set("pin_nodes", &[pin, far]);
    let nodes: Vec<usize> = grid.nodes.concat();
    scene.set("plate_nodes", &nodes);
    scene.faces("plate_face", &grid.faces(crate::scene::Side::Left));
    let (primary, method) = match stop {
        "wall" => ("wall", "method = \"node-to-segment\""),
        "plate" => ("plate_face", "method = \"node-to-segment\""),
        _ => (
            "pin_node",
            "method = \"node-to-node\"\nnormals = [-1.0, 0.0]",
        ),
    };
    scene
        .elastic("plane-strain", 10.0, 0.0)
        .also("expansion = { alpha = 1e-3, reference = 0.0 }")
        .body(&["bar", "pin"], "area = 1.0")
        .body(&["plate"], "")
        .plane("wall", [x, 0.0], [-1.0, 0.0])
        .contact(
            "tip",
            primary,
            &format!("{method}\nenforcement = {enforcement}"),
        )
        .step("load", 1)
        .fix("left", "xy")
        .fix("bar_nodes", "y")
        .fix("plate_nodes", "xy")
        .fix("pin_nodes", "xy")
        .also(load)
        .newton("force_tol = 1e-13, gap_tol = 1e-12, max_iterations = 60")
        .run()
}

fn pull(force: f64) -> String {
    format!("[[step.load]]\non = \"tip\"\nforce = [{force:?}, 0.0]")
}

/// Reaction of the stop, displacement of the tip, iterations.
fn outcome(run: &Run, tip: usize) -> (f64, f64, usize) {
    let frame = run.frames.last().unwrap();
    (
        -frame.contacts[0].secondary.force.x,
        frame.displacement[tip].x,
        run.increments.last().unwrap().iterations,
    )
}

fn close(got: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (got - expected).abs() / expected.abs().max(1.0);
    assert!(error < tolerance, "{what}: {got} for {expected}");
}

#[test]
fn a_bar_closes_its_gap() {
    // u = FL/EA beyond the gap: R = F − EA g/L
    for stop in STOPS {
        for enforcement in EXACT {
            for (force, reaction, tip) in [(3.0, 2.5, 0.1), (0.3, 0.0, 0.06)] {
                let run = stopped(stop, 0.1, enforcement, &pull(force), 1);
                let (r, u, n) = outcome(&run, 1);
                println!("{stop:6} {enforcement:26} F {force}: R {r:.15} u {u:.15} in {n}");
                close(r, reaction, 1e-10, "reaction");
                close(u, tip, 1e-10, "tip");
            }
        }
    }
}

#[test]
fn a_bar_under_its_weight_closes_its_gap() {
    // R = bL/2 − EA g/L and u = (b (L x − x²/2) − R x)/EA, exact at the nodes
    for stop in STOPS {
        for enforcement in EXACT {
            let load = "[[step.load]]\non = \"bar\"\nbody_force = [1.5, 0.0]";
            let run = stopped(stop, 0.1, enforcement, load, 4);
            let (r, u, n) = outcome(&run, 4);
            println!("{stop:6} {enforcement:26} R {r:.15} u {u:.15} in {n}");
            close(r, 1.0, 1e-10, "reaction");
            close(u, 0.1, 1e-10, "tip");
            for (i, x) in equal(0.0, 2.0, 4).into_iter().enumerate() {
                let u = run.frames.last().unwrap().displacement[i].x;
                close(u, (1.5 * (2.0 * x - x * x / 2.0) - x) / 10.0, 1e-10, "bar");
            }
        }
    }
}

#[test]
fn a_bar_that_warms_up_closes_its_gap() {
    // R = EA (alpha dT − g/L)
    for stop in STOPS {
        for enforcement in EXACT {
            let load = "[[step.temperature]]\non = \"all\"\nvalue = 100.0";
            let run = stopped(stop, 0.1, enforcement, load, 2);
            let (r, u, n) = outcome(&run, 2);
            println!("{stop:6} {enforcement:26} R {r:.15} u {u:.15} in {n}");
            close(r, 10.0 * (0.1 - 0.05), 1e-10, "reaction");
            close(u, 0.1, 1e-10, "tip");
        }
    }
}

#[test]
fn the_error_of_a_penalty_is_one_over_it() {
    for stop in STOPS {
        let errors: Vec<f64> = [1e2, 1e4, 1e6]
            .into_iter()
            .map(|penalty: f64| {
                let by = format!("{{ penalty = {penalty:?}, per = \"node\" }}");
                let (r, u, _) = outcome(&stopped(stop, 0.1, &by, &pull(3.0), 1), 1);
                // springs in parallel: u = (F + eps g)/(k + eps), R = eps (u − g)
                close(u, (3.0 + 0.1 * penalty) / (5.0 + penalty), 1e-12, "tip");
                close(r, penalty * (3.0 - 0.5) / (5.0 + penalty), 1e-8, "reaction");
                2.5 - r
            })
            .collect();
        let slopes: Vec<f64> = errors
            .windows(2)
            .map(|e| (e[1] / e[0]).log10() / 2.0)
            .collect();
        println!("{stop}: errors {errors:?}, slopes {slopes:.4?}");
        // 5/(5 + eps) against 5/eps at the first penalty: slope −0.99
        assert!((slopes[0] + 1.0).abs() < 0.02, "{slopes:?}");
        assert!(slopes[1..].iter().all(|s| (s + 1.0).abs() < 1e-3));
    }
}

/// Two bars in line, the outer ends fixed, a gap between them, a force at the end of the first.
#[test]
fn two_bars_share_the_force_once_their_gap_is_closed() {
    // u1 = (F + k2 g)/(k1 + k2), R = k2 (u1 − g)
    let (k1, k2, gap, force) = (10.0 / 2.0, 10.0 / 1.0, 0.1, 3.0);
    let expected: f64 = (force + k2 * gap) / (k1 + k2);
    for enforcement in EXACT {
        let mut scene = Scene::default();
        let labels: Vec<usize> = [0.0, 2.0, 2.1, 3.1]
            .iter()
            .map(|x| scene.node(&[*x, 0.0]))
            .collect();
        scene.cell("line2", "first", labels[..2].to_vec());
        scene.cell("line2", "second", labels[2..].to_vec());
        scene.set("left", &labels[1..2]);
        scene.set("right", &labels[2..3]);
        scene.set("ends", &[labels[0], labels[3]]);
        scene.set("both", &labels);
        let by = format!(
            "method = \"node-to-node\"\nnormals = [-1.0, 0.0]\nenforcement = {enforcement}"
        );
        let run = scene
            .elastic("plane-strain", 10.0, 0.0)
            .body(&["first", "second"], "area = 1.0")
            .contact("left", "right", &by)
            .step("load", 1)
            .fix("both", "y")
            .fix("ends", "xy")
            .load("left", "force = [3.0, 0.0]")
            .newton("force_tol = 1e-13, gap_tol = 1e-12, max_iterations = 60")
            .run();
        let frame = run.frames.last().unwrap();
        let (u1, u2) = (frame.displacement[1].x, frame.displacement[2].x);
        let n = run.increments[0].iterations;
        println!("{enforcement}: u1 {u1:.15} u2 {u2:.15} in {n}");
        close(u1, expected, 1e-10, "first");
        close(u2, expected - gap, 1e-10, "second");
        let r = -frame.contacts[0].secondary.force.x;
        close(r, k2 * (expected - gap), 1e-10, "reaction");
    }
}

/// Chains of bars along x between walls, side by side: a random truss with a stop at every inner node.
struct Chain {
    /// Stiffnesses of the springs from the ground through the nodes and back to the ground.
    stiffness: Vec<f64>,
    force: Vec<f64>,
    gap: Vec<f64>,
}

impl Chain {
    fn random(seed: u64, n: usize) -> Self {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        Self {
            stiffness: (0..=n).map(|_| 1.0 + 9.0 * next()).collect(),
            force: (0..n).map(|_| 4.0 * next() - 1.0).collect(),
            gap: (0..n).map(|_| 0.5 * next()).collect(),
        }
    }

    /// Displacements and forces of the stops: the only active set for which no gap is negative, no force negative.
    fn by_enumeration(&self) -> (Vec<f64>, Vec<f64>) {
        let n = self.force.len();
        let matrix = |i: usize, j: usize| match i.abs_diff(j) {
            0 => self.stiffness[i] + self.stiffness[i + 1],
            1 => -self.stiffness[i.max(j)],
            _ => 0.0,
        };
        for mask in 0u32..1 << n {
            let active = |i: usize| mask >> i & 1 == 1;
            // rows of an active node: u = gap
            let mut a: Vec<Vec<f64>> = (0..n)
                .map(|i| {
                    let row = |j: usize| {
                        if active(i) {
                            f64::from(u8::from(i == j))
                        } else {
                            matrix(i, j)
                        }
                    };
                    (0..n).map(row).collect()
                })
                .collect();
            let mut u: Vec<f64> = (0..n)
                .map(|i| {
                    if active(i) {
                        self.gap[i]
                    } else {
                        self.force[i]
                    }
                })
                .collect();
            eliminate(&mut a, &mut u);
            let pressed: Vec<f64> = (0..n)
                .map(|i| self.force[i] - (0..n).map(|j| matrix(i, j) * u[j]).sum::<f64>())
                .collect();
            let right = |i: usize| {
                if active(i) {
                    pressed[i] >= -1e-12
                } else {
                    u[i] <= self.gap[i] + 1e-12
                }
            };
            if (0..n).all(right) {
                let pressed = (0..n).map(|i| if active(i) { pressed[i] } else { 0.0 });
                return (u.clone(), pressed.collect());
            }
        }
        unreachable!("the matrix is positive definite")
    }

    fn by_program(&self, enforcement: &str) -> Run {
        let n = self.force.len();
        let mut scene = Scene::default();
        let nodes: Vec<usize> = (0..n + 2).map(|i| scene.node(&[i as f64, 0.0])).collect();
        let mut bodies = String::new();
        for (i, pair) in nodes.windows(2).enumerate() {
            scene.cell("line2", &format!("bar{i}"), pair.to_vec());
            bodies += &format!(
                "[[body]]\ngroup = \"bar{i}\"\nmaterial = \"m\"\narea = {:?}\n",
                self.stiffness[i]
            );
        }
        scene.set("ends", &[nodes[0], nodes[n + 1]]);
        scene.set("every", &nodes);
        let mut loads = String::new();
        for i in 0..n {
            let stop = scene.node(&[nodes[i + 1] as f64 - 1.0 + self.gap[i], 0.0]);
            let behind = scene.node(&[nodes[i + 1] as f64 + 1.0, 1.0]);
            scene.cell("line2", "stops", vec![stop, behind]);
            scene.set(&format!("node{i}"), &[nodes[i + 1]]);
            scene.set(&format!("stop{i}"), &[stop]);
            scene.set(&format!("held{i}"), &[stop, behind]);
            bodies += &format!(
                "[[contact]]\nname = \"gap{i}\"\nsecondary = \"node{i}\"\nprimary = \"stop{i}\"\n\
                 method = \"node-to-node\"\nnormals = [-1.0, 0.0]\nenforcement = {enforcement}\n"
            );
            loads += &format!(
                "[[step.fix]]\non = \"held{i}\"\nu = \"all\"\n[[step.load]]\non = \"node{i}\"\nforce = [{:?}, 0.0]\n",
                self.force[i]
            );
        }
        let case = scene
            .elastic("plane-strain", 1.0, 0.0)
            .also(&bodies)
            .body(&["stops"], "area = 1.0")
            .step("load", 1)
            .fix("every", "y")
            .fix("ends", "xy")
            .also(&loads)
            .newton("force_tol = 1e-13, gap_tol = 1e-13, max_iterations = 100");
        run(&mut case.model(&[]))
    }
}

/// Gauss's elimination with pivots: `x = a⁻¹ x`.
fn eliminate(a: &mut [Vec<f64>], x: &mut [f64]) {
    let n = x.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs()));
        let pivot = pivot.unwrap();
        a.swap(k, pivot);
        x.swap(k, pivot);
        for i in 0..n {
            if i != k {
                let factor = a[i][k] / a[k][k];
                let pivot = a[k].clone();
                for (to, from) in a[i].iter_mut().zip(&pivot).skip(k) {
                    *to -= factor * from;
                }
                x[i] -= factor * x[k];
            }
        }
    }
    for k in 0..n {
        x[k] /= a[k][k];
    }
}

#[test]
fn chains_with_random_gaps_find_the_active_set() {
    for enforcement in ["{ lagrange = {} }", "{ augmented = \"newton\" }"] {
        let (mut worst, mut most, mut stops) = (0.0f64, 0, 0);
        for seed in 1..=40 {
            let n = 2 + (seed % 7) as usize;
            let chain = Chain::random(seed, n);
            let (u, pressed) = chain.by_enumeration();
            let run = chain.by_program(enforcement);
            assert!(run.error.is_none(), "{enforcement} {seed}: {:?}", run.error);
            let frame = run.frames.last().unwrap();
            for i in 0..n {
                let got = frame.displacement[i + 1].x;
                let force = -frame.contacts[i].secondary.force.x;
                worst = worst.max((got - u[i]).abs());
                worst = worst.max((force - pressed[i]).abs());
                stops += usize::from(pressed[i] > 0.0);
            }
            most = most.max(run.increments[0].iterations);
        }
        println!(
            "{enforcement}: worst {worst:.2e}, {most} iterations at most, {stops} stops closed"
        );
        assert!(worst < 1e-10, "{enforcement}: {worst:e}");
        assert!(stops > 40);
    }
}
