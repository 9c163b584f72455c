//! The tangent of coupled contact against differences, every method and law, with friction, in the plane and in space.

use super::*;
use signorini_mechanics::system::{
    Dof, Increment, NO_DOF, Order, Phase, Sink, State, System, Work,
};

/// A sink without sparsity.
struct Dense {
    force: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Sink for Dense {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        let n = self.force.len();
        for (i, &p) in dofs.iter().enumerate().filter(|d| *d.1 != NO_DOF) {
            self.force[p as usize] += force[i];
            if stiffness.is_empty() {
                continue;
            }
            for (j, &q) in dofs.iter().enumerate().filter(|d| *d.1 != NO_DOF) {
                self.stiffness[p as usize * n + q as usize] += stiffness[i * dofs.len() + j];
            }
        }
    }

    fn couple(&mut self, rows: &[Dof], columns: &[Dof], stiffness: &[f64]) {
        signorini_mechanics::system::couple_as_square(self, rows, columns, stiffness);
    }

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

/// Numbers in [-1, 1] that look random and are the same in every run.
fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898 + 4.1414).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

fn assemble(system: &mut System, state: &State, order: Order) -> Dense {
    let n = state.u.len();
    let mut dense = Dense {
        force: vec![0.0; n],
        stiffness: vec![0.0; if order == Order::Tangent { n * n } else { 0 }],
    };
    for term in system.adaptive() {
        term.prepare(state, order).unwrap();
    }
    let mut work = Work::default();
    for term in system.terms.iter().filter(|term| term.name() == "touch") {
        for chunk in 0..term.nchunk() {
            term.evaluate(chunk, state, order, &mut work, &mut dense)
                .unwrap();
        }
    }
    dense
}

/// Two blocks pressed together that slide and conduct, at a state of large and uneven changes.
fn blocks(ndim: usize, geometry: &str, keys: &str) -> String {
    let mut boxes = Boxes::new(ndim);
    boxes.add("base", [0.0; 3], [2.0, 1.0, 1.0], [2, 1, 1]);
    boxes.add("block", [0.3, 1.0, 0.1], [1.3, 2.0, 0.8], [1, 1, 1]);
    boxes.case(&format!(
        "[constants]\nstefan_boltzmann = 1e-7\nabsolute_zero = -200.0\n\
         [material.m]\nmodel = \"neo-hookean\"\nE = 1e3\nnu = 0.3\nexpansion = {{ alpha = 1e-3 }}\nconductivity = 3.0\nspecific_heat = 2.0\ndensity = 0.5\n\
         [[body]]\ngroup = \"base\"\nmaterial = \"m\"\n[[body]]\ngroup = \"block\"\nmaterial = \"m\"\n\
         [[contact]]\nname = \"touch\"\nsecondary = \"block_bottom\"\nprimary = \"base_top\"\n{keys}\n\
         [[step]]\nname = \"rub\"\nkind = \"coupled\"\nthermal = \"transient\"\ngeometry = \"{geometry}\"\nincrements = 1\n\
         fix = [{{ on = \"base_bottom\", u = \"all\" }}]\nmove = [{{ on = \"block_top\", ux = 0.1, uy = -0.05{} }}]\n",
        if ndim == 3 { ", uz = 0.0" } else { "" }
    ))
}

/// The largest difference of each block of the tangent over its largest entry: displacements and multipliers, temperatures.
fn errors(text: &str) -> [[f64; 2]; 2] {
    let mut model = common::model("tangent", text, &[]);
    let system = &mut model.system;
    let layout = system.layout;
    let step = model.steps[0].context(0, 0.0);
    let start = system.initial_state();
    let increment = Increment {
        number: 1,
        from: 0.0,
        to: 1.0,
    };
    for phase in [Phase::of_step(step), Phase::of_increment(step, increment)] {
        for term in &mut system.terms {
            term.begin(&phase, &start).unwrap();
        }
    }
    let n = layout.ndof();
    let is_heat = |dof: usize| {
        let name = layout.name(dof as Dof).unwrap();
        layout.field(name.field).unwrap().name == "temperature"
    };
    let is_multiplier = |dof: usize| dof >= layout.multiplier(0) as usize;
    // pressed by a few per cent, and to one side
    let places = system.reference.clone();
    let rubs = text.contains("friction = 0.3");
    let mut du = vec![0.0; n];
    for (dof, to) in du.iter_mut().enumerate() {
        let name = layout.name(dof as Dof).unwrap();
        *to = match (is_heat(dof), is_multiplier(dof)) {
            (true, _) => 40.0 + 30.0 * noise(dof),
            (_, true) if rubs => [3.0, -30.0, 2.0][name.entity as usize % layout.ndim()],
            (_, true) => 30.0 + 5.0 * noise(dof),
            _ => {
                let x = places[name.entity as usize];
                let upper = x.y > 1.5 || name.entity as usize >= places.len() / 2;
                let way = [0.08, -0.04, 0.02][name.component];
                0.004 * noise(dof) + if upper { way } else { 0.0 }
            }
        };
    }
    let mut base = start.clone();
    system.advance(&mut base, &start, &du, 1.0);
    base.time = 1.0;
    let at = assemble(system, &base, Order::Tangent);
    let block = |i: usize| usize::from(is_heat(i));
    let mut scales = [[0.0_f64; 2]; 2];
    for (k, entry) in at.stiffness.iter().enumerate() {
        let to = &mut scales[block(k / n)][block(k % n)];
        *to = to.max(entry.abs());
    }
    let mut errors = [[0.0_f64; 2]; 2];
    for j in 0..n {
        let h = match (is_heat(j), is_multiplier(j)) {
            (true, _) => 1e-2,
            (_, true) => 1e-3,
            _ => 2e-6,
        };
        let forces = [h, -h, 2.0 * h, -2.0 * h].map(|d| {
            let mut shift = vec![0.0; n];
            shift[j] = d;
            let mut state = base.clone();
            system.advance(&mut state, &base, &shift, 1.0);
            state.time = 1.0;
            assemble(system, &state, Order::Residual).force
        });
        for i in 0..n {
            let [a, b, c, d] = forces.each_ref().map(|f| f[i]);
            let slope = (8.0 * (a - b) - (c - d)) / (12.0 * h);
            let error = (slope - at.stiffness[i * n + j]).abs();
            let (row, column) = (block(i), block(j));
            if scales[row][column] > 0.0 {
                let to = &mut errors[row][column];
                if error > 1e-6 * scales[row][column] && row == 1 {
                    println!(
                        "{i} {j} ({:?} {:?}) {slope} {}",
                        layout.name(i as Dof),
                        layout.name(j as Dof),
                        at.stiffness[i * n + j]
                    );
                }
                *to = to.max(error / scales[row][column]);
            } else {
                assert!(error < 1e-9, "{i} {j}: {error:e} where nothing is expected");
            }
        }
    }
    errors
}

#[test]
fn coupled_tangents_match_differences_for_every_method_law_and_friction() {
    let ways = "conductance = { constant = 2.0, over_pressure = [[0.0, 1.0], [1e4, 500.0]], gas = { k = 0.2, jump = 0.1 }, \
                radiation = [0.8, 0.6] }";
    for ndim in [2, 3] {
        for geometry in ["linear", "nonlinear"] {
            for method in ["node-to-segment", "gauss-point", "mortar"] {
                for law in ["penalty = 2e3", "augmented = \"newton\"", "lagrange = {}"] {
                    if method == "gauss-point" && law != "penalty = 2e3" {
                        continue;
                    }
                    for friction in ["", "friction = 0.3"] {
                        let keys = format!(
                            "method = \"{method}\"\nenforcement = {{ {law} }}\n{friction}\n{ways}\n\
                             friction_heat = {{ fraction = 0.8, to_secondary = 0.3 }}\n"
                        );
                        let what = format!("{ndim} {geometry} {method} {law} {friction}");
                        let found = errors(&blocks(ndim, geometry, &keys));
                        println!("{what}: {found:?}");
                        // of heat alone, and against temperatures
                        let [_, [heat, own]] = found;
                        assert!(own < 1e-7, "{what}: {own:e}");
                        assert!(heat < 2e-6, "{what}: {heat:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn tangents_on_a_rigid_surface_match_differences_with_a_temperature_and_without() {
    for ndim in [2, 3] {
        for method in ["node-to-segment", "gauss-point"] {
            for temperature in ["", "temperature = 50.0"] {
                let mut boxes = Boxes::new(ndim);
                boxes.add("block", [0.3, 1.0, 0.1], [1.3, 2.0, 0.8], [1, 1, 1]);
                let text = boxes.case(&format!(
                    "[material.m]\nmodel = \"neo-hookean\"\nE = 1e3\nnu = 0.3\nexpansion = {{ alpha = 1e-3 }}\nconductivity = 3.0\nspecific_heat = 2.0\ndensity = 0.5\n\
                     [[body]]\ngroup = \"block\"\nmaterial = \"m\"\n\
                     [[surface]]\nname = \"floor\"\nshape = {{ plane = {{ point = {}, normal = \"y\" }} }}\n\
                     [[contact]]\nname = \"touch\"\nsecondary = \"block_bottom\"\nprimary = \"floor\"\nmethod = \"{method}\"\n\
                     enforcement = {{ penalty = 2e3 }}\nfriction = 0.3\n{temperature}\n\
                     conductance = {{ constant = 2.0, over_pressure = [[0.0, 1.0], [1e4, 500.0]] }}\n\
                     [[step]]\nname = \"rub\"\nkind = \"coupled\"\nthermal = \"transient\"\ngeometry = \"nonlinear\"\nincrements = 1\n\
                     move = [{{ on = \"block_top\", ux = 0.1, uy = -0.05{} }}]\n",
                    if ndim == 3 { "[0, 1.02, 0]" } else { "[0, 1.02]" },
                    if ndim == 3 { ", uz = 0.0" } else { "" }
                ));
                let what = format!("{ndim} {method} {temperature}");
                let [_, [heat, own]] = errors(&text);
                assert!(own < 1e-7, "{what}: {own:e}");
                assert!(heat < 2e-6, "{what}: {heat:e}");
            }
        }
    }
}
