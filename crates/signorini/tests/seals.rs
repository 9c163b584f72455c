//! Fluids between sides, and gaskets: against closed forms and a rule of nodes.

#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::{Run, model, reference, run};
use std::fmt::Write as _;

/// Blocks of quadrilaterals, as the mesh of a case.
#[derive(Default)]
struct Blocks {
    nodes: String,
    elements: String,
    counts: [usize; 2],
}

impl Blocks {
    /// A block of nx × ny quadrilaterals, of the group of this name.
    fn with(mut self, group: &str, [nx, ny]: [usize; 2], [x, y]: [[f64; 2]; 2]) -> Self {
        let [first, cells] = self.counts;
        let number = |i: usize, j: usize| first + 1 + i + (nx + 1) * j;
        for j in 0..=ny {
            for i in 0..=nx {
                let at = |[a, b]: [f64; 2], k, n| a + (b - a) * k as f64 / n as f64;
                let (x, y) = (at(x, i, nx), at(y, j, ny));
                let _ = writeln!(self.nodes, "[{}, {x:?}, {y:?}],", number(i, j));
            }
        }
        for k in 0..nx * ny {
            let (i, j) = (k % nx, k / nx);
            let nodes = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let nodes = nodes.map(|(i, j)| number(i, j));
            let _ = writeln!(
                self.elements,
                "{{ id = {}, type = 'quad4', group = '{group}', nodes = {nodes:?} }},",
                cells + k + 1
            );
        }
        self.counts = [first + (nx + 1) * (ny + 1), cells + nx * ny];
        self
    }

    fn case(&self, rest: &str) -> String {
        let Self {
            nodes, elements, ..
        } = self;
        format!("[mesh]\nnodes = [\n{nodes}]\nelements = [\n{elements}]\n{rest}")
    }
}

#[track_caller]
fn solved(text: &str) -> Run {
    let run = run(&mut model("case.toml", text, &[]));
    assert!(run.error.is_none(), "{:?}", run.error);
    run
}

/// A flange that hardly bends on elastic springs, under an eccentric force, with a fluid from its left end.
fn flange(n: usize, method: &str, pressure: f64) -> Run {
    let on = Blocks::default().with("flange", [n, 1], [[0.0, 10.0], [0.0, 1.0]]);
    solved(&on.case(&format!(
        "
[model]
space = 'plane-stress'
[sets]
face = {{ plane = 'y', at = 0, of = 'flange' }}
edge = {{ near = [0.0, 0.0] }}
bolt = {{ near = [6.0, 1.0] }}
[material.stiff]
model = 'linear-elastic'
E = 1e10
nu = 0.0
[[body]]
group = 'flange'
material = 'stiff'
locking = 'incompatible'
[[surface]]
name = 'ground'
shape = {{ plane = {{ point = [0, 0], normal = [0, 1] }} }}
[[contact]]
name = 'seal'
secondary = 'face'
primary = 'ground'
method = '{method}'
gasket = {{ loading = [[0, 0], [1, 100]], tension = 1.0 }}
fluid = {{ pressure = 0.0, from = 'edge', critical = 'fluid' }}
[[step]]
name = 'bolt'
geometry = 'linear'
increments = 1
fix = [{{ on = 'bolt', u = ['x'] }}]
load = [{{ on = 'bolt', force = [0, -1000] }}]
[[step]]
name = 'fill'
increments = {{ fixed = 3 }}
contact = [{{ name = 'seal', fluid = {pressure:?} }}]
"
    )))
}

/// How far the fluid has come, and the contact pressures, by the rule of nodes for a flange that does not bend.
fn by_nodes(n: usize, pressure: f64) -> (f64, Vec<f64>) {
    let h = 10.0 / n as f64;
    let x: Vec<f64> = (0..=n).map(|k| k as f64 * h).collect();
    let w: Vec<f64> = (0..=n)
        .map(|k| if k % n == 0 { h / 2.0 } else { h })
        .collect();
    let mut wet = 1;
    loop {
        let sum = |f: &dyn Fn(usize) -> f64| (0..=n).map(|k| w[k] * f(k)).sum::<f64>();
        let (a, b, c) = (sum(&|_| 1.0), sum(&|k| x[k]), sum(&|k| x[k] * x[k]));
        let fluid = |k: usize| if k < wet { pressure } else { 0.0 };
        let (f, m) = (1000.0 - sum(&fluid), 6000.0 - sum(&|k| x[k] * fluid(k)));
        let det = a * c - b * b;
        let (p, slope) = ((f * c - m * b) / det, (m * a - f * b) / det);
        let of: Vec<f64> = x.iter().map(|x| p + slope * x).collect();
        let more = wet + of[wet..].iter().take_while(|p| **p <= pressure).count();
        if more == wet {
            return (x[wet - 1], of);
        }
        wet = more;
    }
}

/// Fronts on so many facets at these pressures against the rule of nodes.
fn fronts(all: &[(usize, f64)]) {
    for &(n, pressure) in all {
        let run = flange(n, "node-to-segment", pressure);
        let contact = &run.frames.last().unwrap().contacts[0];
        let (front, expected) = by_nodes(n, pressure);
        let found = contact.wet.iter().filter(|wet| **wet > 0.5).count();
        let found = (found - 1) as f64 * 10.0 / n as f64;
        assert_eq!(found, front, "{n} {pressure}");
        for (node, pressure) in expected.iter().enumerate() {
            let closure = contact.closure[node];
            assert!((100.0 * closure - pressure).abs() < 0.01, "{node}");
        }
        let fluid = contact.fluid.unwrap();
        let lifts = contact.secondary.force.y + fluid.on_secondary.force.y;
        assert!((lifts - 1000.0).abs() < 1e-3, "{lifts}");
        assert_eq!(fluid.leak, None);
    }
}

#[test]
fn a_front_goes_as_far_as_the_rule_of_nodes_has_it() {
    fronts(&[(40, 50.0), (20, 35.0)]);
    let Some(reference) = reference("thermal/penetrated_flange.json") else {
        return;
    };
    // what is printed there of 40, 160 and 640 cells
    for (n, front) in [(40, 3.0), (160, 3.0625), (640, 3.125)] {
        assert_eq!(by_nodes(n, 50.0).0, front);
    }
    for (pressure, n) in [("50.0", 160), ("60.0", 40)] {
        let exact = reference["cases"][pressure]["a"].as_f64().unwrap();
        let front = by_nodes(n, pressure.parse().unwrap()).0;
        assert!((front - exact).abs() < 20.0 / n as f64, "{front} {exact}");
    }
}

#[test]
#[ignore = "takes its time without optimization"]
fn fronts_of_more_facets_go_as_far_as_the_rule_of_nodes_has_it() {
    fronts(&[(40, 60.0), (160, 50.0)]);
}

#[test]
fn points_inside_facets_let_a_fluid_in_as_far() {
    let run = flange(40, "gauss-point", 50.0);
    let area = run.frames.last().unwrap().contacts[0].fluid.unwrap().area;
    // two facets
    assert!((area - 3.1434710867610267).abs() < 0.5, "{area}");
}

/// A strip on the ground, pressed by 10 from above, with a fluid of pressure 11 at its left end.
fn strip(critical: &str) -> Run {
    let on = Blocks::default().with("strip", [20, 2], [[0.0, 20.0], [0.0, 2.0]]);
    let text = on.case(&format!(
        "
[model]
space = 'plane-strain'
[sets]
face = {{ plane = 'y', at = 0, of = 'strip' }}
top = {{ plane = 'y', at = 2, of = 'strip' }}
edge = {{ near = [0.0, 0.0] }}
[material.soft]
model = 'linear-elastic'
E = 1000
nu = 0.3
[[body]]
group = 'strip'
material = 'soft'
[[surface]]
name = 'ground'
shape = {{ plane = {{ point = [0, 0], normal = [0, 1] }} }}
[[contact]]
name = 'seal'
secondary = 'face'
primary = 'ground'
method = 'node-to-segment'
fluid = {{ pressure = 0, from = 'edge', critical = {critical} }}
[[step]]
name = 'press'
geometry = 'linear'
increments = 1
fix = [{{ on = 'edge', u = ['x'] }}]
load = [{{ on = 'top', pressure = 10 }}]
[[step]]
name = 'fill'
increments = {{ fixed = 1 }}
contact = [{{ name = 'seal', fluid = 11 }}]
"
    ));
    run(&mut model("case.toml", &text, &[]))
}

#[test]
fn a_strip_lets_in_what_is_stronger_than_what_presses_it() {
    let run = strip("0.0");
    assert!(run.error.is_none(), "{:?}", run.error);
    let contact = &run.frames.last().unwrap().contacts[0];
    let wet = contact.wet.iter().filter(|wet| **wet > 0.0).count();
    assert_eq!(wet, 1);
}

#[test]
#[ignore = "takes its time without optimization"]
fn a_strip_with_a_stronger_fluid_everywhere_is_held_by_nothing() {
    let run = strip("'fluid'");
    let error = run.error.expect("it floats").to_string();
    assert!(error.contains("did not converge"), "{error}");
}

/// Rings of plane stress, 20 to 40 in 40 to 60, with an overlap of 0.02 and a fluid between them.
fn rings(method: &str, enforcement: &str, pressure: f64) -> Run {
    let on = Blocks::default()
        .with("inner", [20, 2], [[20.0, 40.0], [0.0, 1.0]])
        .with("outer", [20, 2], [[40.0, 60.0], [0.0, 1.0]]);
    let text = on.case(&format!(
        "
[model]
space = 'axisymmetric'
[sets]
in = {{ plane = 'x', at = 40, of = 'inner' }}
out = {{ plane = 'x', at = 40, of = 'outer' }}
low = {{ plane = 'y', at = 0 }}
seeds = {{ plane = 'y', at = 0, of = 'outer' }}
[material.steel]
model = 'linear-elastic'
E = 210000
nu = 0.3
[material.light]
model = 'linear-elastic'
E = 70000
nu = 0.33
[[body]]
group = 'inner'
material = 'steel'
locking = 'incompatible'
[[body]]
group = 'outer'
material = 'light'
locking = 'incompatible'
[[contact]]
name = 'fit'
secondary = 'in'
primary = 'out'
method = '{method}'
enforcement = {enforcement}
start = {{ clearance = -0.02 }}
fluid = {{ pressure = 0, from = 'seeds', critical = 'fluid' }}
[[step]]
name = 'fit'
geometry = 'linear'
increments = 1
fix = [{{ on = 'low', u = ['y'] }}]
[[step]]
name = 'fill'
increments = {{ fixed = 4 }}
contact = [{{ name = 'fit', fluid = {pressure:?} }}]
"
    ));
    solved(&text)
}

#[test]
fn a_shrink_fit_opens_by_what_lame_says() {
    let fit = 10.338037413849687;
    if let Some(reference) = reference("thermal/shrink_fit_seal.json") {
        assert_eq!(reference["pc"].as_f64(), Some(fit));
    }
    for (method, enforcement) in [
        ("node-to-segment", "{ penalty = 1e7, per = 'area' }"),
        ("node-to-segment", "{ lagrange = {} }"),
        ("gauss-point", "{ penalty = 1e7, per = 'area' }"),
        ("mortar", "{ lagrange = {} }"),
        ("mortar", "{ augmented = 'uzawa' }"),
    ] {
        for (times, opening) in [(2.0, 0.02), (3.0, 0.04)] {
            let run = rings(method, enforcement, times * fit);
            let contact = &run.frames.last().unwrap().contacts[0];
            let name = format!("{method} {enforcement} {times}");
            for (gap, wet) in contact.gap.iter().zip(&contact.wet) {
                assert!((gap - opening).abs() < 2e-3 * opening, "{name}: {gap}");
                assert_eq!(*wet, 1.0, "{name}");
            }
            let first = &run.frames[0].contacts[0];
            for pressure in &first.pressure {
                assert!((pressure - fit).abs() < 6e-3 * fit, "{name}: {pressure}");
            }
            assert!(contact.fluid.unwrap().leak.is_some(), "{name}");
        }
        // what is weaker than the fit stays where it comes from
        let run = rings(method, enforcement, 0.5 * fit);
        let contact = &run.frames.last().unwrap().contacts[0];
        assert!(contact.wet.iter().any(|wet| *wet < 0.5), "{method}");
        assert_eq!(contact.fluid.unwrap().leak, None);
    }
}

#[test]
fn mortar_distributes_a_uniform_pressure_exactly() {
    let on = Blocks::default()
        .with("low", [3, 2], [[0.0, 4.0], [-2.0, 0.0]])
        .with("high", [5, 2], [[0.0, 4.0], [0.05, 2.0]]);
    let text = on.case(
        "
[model]
space = 'plane-strain'
[sets]
under = { plane = 'y', at = 0.05, of = 'high' }
over = { plane = 'y', at = 0, of = 'low' }
ends = { union = ['bottom', 'top'] }
bottom = { plane = 'y', at = -2 }
top = { plane = 'y', at = 2 }
left = { plane = 'x', at = 0 }
right = { plane = 'x', at = 4 }
[material.soft]
model = 'linear-elastic'
E = 1000
nu = 0.3
[[body]]
group = ['low', 'high']
material = 'soft'
[[contact]]
name = 'gap'
secondary = 'under'
primary = 'over'
method = 'mortar'
reach = 1.0
fluid = { pressure = 20, from = 'over' }
[[step]]
name = 'fill'
geometry = 'linear'
increments = 1
fix = [{ on = 'ends', u = ['y'] }, { on = 'left', u = ['x'] }, { on = 'right', u = ['x'] }]
",
    );
    let run = solved(&text);
    let frame = run.frames.last().unwrap();
    for stress in &frame.stress {
        assert!((stress.yy() + 20.0).abs() < 1e-9, "{}", stress.yy());
        assert!(stress.xy().abs() < 1e-9);
    }
    let fluid = frame.contacts[0].fluid.unwrap();
    assert!((fluid.area - 4.0).abs() < 1e-12 && fluid.pressure == 20.0);
    assert!((fluid.on_secondary.force.y - 80.0).abs() < 1e-9);
}

/// A block that is moved onto a gasket and off it, in steps to these closures.
fn pressed(method: &str, closures: &[f64]) -> Run {
    let on = Blocks::default()
        .with("block", [2, 1], [[0.0, 1.0], [0.0, 1.0]])
        .with("ground", [3, 1], [[-0.5, 1.5], [-1.0, 0.0]]);
    let mut rest = format!(
        "
[model]
space = 'plane-strain'
[sets]
face = {{ plane = 'y', at = 0, of = 'block' }}
seat = {{ plane = 'y', at = 0, of = 'ground' }}
[material.steel]
model = 'linear-elastic'
E = 210000
nu = 0.3
[[body]]
group = ['block', 'ground']
material = 'steel'
[[contact]]
name = 'seal'
secondary = 'face'
primary = 'seat'
method = '{method}'
gasket = {{ loading = [[0, 0], [4e-5, 1515], [1.2e-4, 3720], [5.05e-4, 8955]], unloading = [{{ from = 2.86e-4, \
         curve = [[1.144e-4, 0], [2.002e-4, 597.7168831168832], [2.86e-4, 5977.168831168832]] }}] }}
"
    );
    for (k, closure) in closures.iter().enumerate() {
        let _ = write!(
            rest,
            "
[[step]]
name = '{k}'
geometry = 'linear'
increments = {{ fixed = 2 }}
fix = [{{ on = 'ground', u = 'all' }}]
move = [{{ on = 'block', ux = 0.0, uy = {:?} }}]
",
            -closure
        );
    }
    solved(&on.case(&rest))
}

#[test]
fn a_gasket_goes_along_the_curves_of_the_reference() {
    let path = [8e-5, 2.86e-4, 2.002e-4, 2.86e-4, 1.0e-4, 2.002e-4];
    let expected = [
        2617.5,
        5977.168831168832,
        597.7168831168832,
        5977.168831168832,
        0.0,
    ];
    let expected = expected.into_iter().chain([597.7168831168832]);
    for method in ["node-to-segment", "gauss-point", "mortar"] {
        let run = pressed(method, &path);
        for (k, pressure) in expected.clone().enumerate() {
            let contact = &run.frames[2 * k + 1].contacts[0];
            let force = contact.secondary.force.y;
            assert!(
                (force - pressure).abs() < 1e-8 * 5977.0,
                "{method} {k}: {force}"
            );
            let largest = path[..=k].iter().copied().fold(0.0, f64::max);
            for (closure, most) in contact.closure.iter().zip(&contact.closure_max) {
                assert!((closure - path[k]).abs() < 1e-12 && (most - largest).abs() < 1e-12);
            }
        }
    }
}
