//! A field more than those of mechanics: temperatures with a made-up conduction, alone and with bodies that swell.

use super::*;
use crate::material::NeoHookean;
use crate::solid::{Integration, Locking, Solid, SolidParts};
use crate::system::{Archive, Field, FieldId, Idealisation, NodalValues, Scale, Site};
use signorini_geometry::element::by_name;
use signorini_geometry::mesh::Mesh;
use signorini_linear::{LinearKind, Note};

/// Cells and size of a bar along x.
const CELLS: [usize; 3] = [8, 3, 3];
const SIZE: [f64; 3] = [2.0, 0.5, 0.5];
/// Temperatures at its ends when the step is done.
const ENDS: [f64; 2] = [20.0, 80.0];
const HEAT: Field = Field {
    name: "temperature",
    on: Site::Nodes,
    ncomponent: 1,
    scale: Scale::Own,
};

/// Conduction `q = −k (1 + b T) ∇T` in bricks, and forces of nodes that swelling by `T` exerts.
struct Heat {
    layout: Layout,
    field: FieldId,
    cells: Vec<[NodeId; 8]>,
    /// k
    conductivity: f64,
    /// b
    rise: f64,
    /// Pressure over temperature.
    swelling: f64,
}

impl Heat {
    /// The unknowns of a cell: temperatures, then displacements where these take part.
    fn dofs(&self, cell: &[NodeId; 8]) -> Vec<Dof> {
        let heat = cell
            .iter()
            .map(|&node| self.layout.dof(self.field, node, 0));
        let axes = if self.swelling == 0.0 { 0 } else { 3 };
        let moves = cell
            .iter()
            .flat_map(|&node| (0..axes).map(move |axis| self.layout.node(node, axis)));
        heat.chain(moves).collect()
    }
}

/// Shape functions and their gradients at a point of a brick.
type At = ([f64; 8], [Vec3; 8]);

/// The points of Gauss of a brick, and the weight of each.
fn points() -> (Vec<At>, f64) {
    let edge: [f64; 3] = std::array::from_fn(|k| SIZE[k] / CELLS[k] as f64);
    let corners = [0, 1, 3, 2, 4, 5, 7, 6].map(|k| [k & 1, k >> 1 & 1, k >> 2 & 1]);
    let at = |point: usize| {
        let s: [f64; 3] = std::array::from_fn(|axis| {
            0.5 + (f64::from(point as u32 >> axis & 1) - 0.5) / 3f64.sqrt()
        });
        let of = |axis: usize, end: usize| if end == 1 { s[axis] } else { 1.0 - s[axis] };
        let sign = |end: usize| if end == 1 { 1.0 } else { -1.0 };
        let shape = corners.map(|c| of(0, c[0]) * of(1, c[1]) * of(2, c[2]));
        let gradient = corners.map(|c| {
            Vec3::new(
                sign(c[0]) / edge[0] * of(1, c[1]) * of(2, c[2]),
                sign(c[1]) / edge[1] * of(0, c[0]) * of(2, c[2]),
                sign(c[2]) / edge[2] * of(0, c[0]) * of(1, c[1]),
            )
        });
        (shape, gradient)
    };
    let weight = edge.iter().product::<f64>() / 8.0;
    ((0..8).map(at).collect(), weight)
}

impl Term for Heat {
    fn name(&self) -> &str {
        "heat"
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        self.cells
            .iter()
            .for_each(|cell| out.interface(&self.dofs(cell)));
    }

    fn properties(&self) -> Properties {
        let is_plain = self.rise == 0.0 && self.swelling == 0.0;
        let symmetry = if is_plain {
            Symmetry::Definite
        } else {
            Symmetry::Unsymmetric
        };
        Properties::new(symmetry, Part::Interface)
    }

    fn begin(&mut self, _: &Phase, _: &State) -> Result<(), TermError> {
        Ok(())
    }

    fn nchunk(&self) -> usize {
        1
    }

    fn evaluate(
        &self,
        _: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let (points, weight) = points();
        for cell in &self.cells {
            let dofs = self.dofs(cell);
            let n = dofs.len();
            let (mut force, mut stiffness) = (vec![0.0; n], vec![0.0; n * n]);
            let heat: [f64; 8] = std::array::from_fn(|a| trial.u[dofs[a] as usize]);
            for (shape, gradient) in &points {
                let now: f64 = shape.iter().zip(heat).map(|(n, t)| n * t).sum();
                let slope = gradient.iter().zip(heat);
                let slope = slope.fold(Vec3::ZERO, |sum, (g, t)| sum + *g * t);
                let k = self.conductivity * (1.0 + self.rise * now) * weight;
                let dk = self.conductivity * self.rise * weight;
                let swelling = self.swelling * weight;
                for a in 0..8 {
                    force[a] += k * gradient[a].dot(slope);
                    for b in 0..8 {
                        stiffness[a * n + b] += k * gradient[a].dot(gradient[b])
                            + dk * shape[b] * gradient[a].dot(slope);
                    }
                    let axes = gradient[a].to_array().into_iter().take((n - 8) / 8);
                    for (axis, along) in axes.enumerate() {
                        let row = 8 + 3 * a + axis;
                        force[row] -= swelling * now * along;
                        for b in 0..8 {
                            stiffness[row * n + b] -= swelling * shape[b] * along;
                        }
                    }
                }
            }
            if order == Order::Residual {
                stiffness.clear();
            }
            out.add(&dofs, &force, &stiffness);
        }
        Ok(())
    }

    fn energy(&self, _: usize, _: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        Ok(None)
    }
}

/// A bar that is pulled, and heated at its ends.
struct Bar {
    conductivity: f64,
    rise: f64,
    swelling: f64,
}

impl Bar {
    fn mesh() -> Mesh {
        let mut mesh = Mesh::default();
        let side = CELLS.map(|n| n + 1);
        for k in 0..side.iter().product() {
            let at = [k % side[0], k / side[0] % side[1], k / (side[0] * side[1])];
            let x: [f64; 3] = std::array::from_fn(|i| SIZE[i] * at[i] as f64 / CELLS[i] as f64);
            mesh.points.push(Vec3::from(x));
            mesh.node_labels.push(k as u64 + 1);
        }
        let node = |i: usize, j: usize, k: usize| (i + side[0] * (j + side[1] * k)) as NodeId;
        for k in 0..CELLS.iter().product() {
            let (i, j, l) = (
                k % CELLS[0],
                k / CELLS[0] % CELLS[1],
                k / (CELLS[0] * CELLS[1]),
            );
            let ring = |l| {
                [
                    node(i, j, l),
                    node(i + 1, j, l),
                    node(i + 1, j + 1, l),
                    node(i, j + 1, l),
                ]
            };
            let nodes = [ring(l), ring(l + 1)].concat();
            mesh.push_cell(by_name("hex8").unwrap(), &nodes, k as u64 + 1);
        }
        mesh
    }

    fn layout() -> Layout {
        let layout = Layout::new(3, Self::mesh().nnode(), 0);
        layout.with_field(HEAT).unwrap()
    }

    fn system(&self) -> System {
        let (mesh, layout) = (Self::mesh(), Self::layout());
        let cells: Vec<_> = mesh.cells(3).collect();
        let reference: Arc<[Vec3]> = mesh.points.clone().into();
        let solid = Solid::new(SolidParts {
            name: "bar",
            mesh: &mesh,
            reference: reference.clone(),
            cells: &cells,
            layout,
            space: Idealisation::Space,
            profile: None,
            material: Box::new(NeoHookean::new(2e5, 0.3)),
            integration: Integration::Full,
            locking: Locking::None,
            temperature: None,
            linear_temperatures: false,
            at_nodes: Default::default(),
            initial: &[],
            axes: None,
            directors: &crate::system::Directors::default(),
        });
        let heat = Heat {
            layout,
            field: layout.find("temperature").unwrap(),
            cells: cells
                .iter()
                .map(|&cell| mesh.cell(cell).try_into().unwrap())
                .collect(),
            conductivity: self.conductivity,
            rise: self.rise,
            swelling: self.swelling,
        };
        System {
            layout,
            coordinates: reference.iter().map(|x| x.to_array()).collect(),
            elimination: Arc::new(Elimination::default()),
            terms: vec![Box::new(solid.unwrap()), Box::new(heat)],
            body: vec![0; mesh.nnode()],
            between: Vec::new(),
            ncell: vec![cells.len()],
            heavy: Arc::new([]),
            rates: None,
            at_start: Arc::default(),
            wanted: crate::system::Wanted::default(),
            reference,
        }
    }

    /// The bar is pulled by a thousandth in two increments, while its ends reach their temperatures.
    fn step() -> Step {
        let layout = Self::layout();
        let heat = layout.find("temperature").unwrap();
        let mut prescriptions = Vec::new();
        for (node, x) in (0..).zip(&Self::mesh().points) {
            let mut prescribe = |dof, to| {
                let motion = Motion::Ramp(to);
                prescriptions.push(Prescription { dof, motion });
            };
            let ends = [(0.0, ENDS[0]), (SIZE[0], ENDS[1])];
            for (_, to) in ends.into_iter().filter(|(end, _)| *end == x.x) {
                prescribe(layout.dof(heat, node, 0), to);
                prescribe(layout.node(node, 0), 1e-3 * x.x);
            }
            for axis in (1..3).filter(|&axis| x[axis] == 0.0) {
                prescribe(layout.node(node, axis), 0.0);
            }
        }
        Step {
            name: "heat".into(),
            duration: 1.0,
            increments: Increments::Fixed(2),
            nonlinear: true,
            scheme: None,
            control: None,
            vibration: None,
            physics: crate::system::Physics::default(),
            prescriptions,
        }
    }

    fn settings(linear: LinearKind) -> StepperSettings {
        StepperSettings {
            linear,
            ..settings(1e-9, LineSearch::Auto)
        }
    }

    /// Runs it to the end, or to the first increment.
    fn go(
        system: &mut System,
        stepper: &mut Stepper,
        until: usize,
    ) -> (Vec<IterationRecord>, Option<NodalValues>) {
        let (mut iterations, mut values, mut count) = (Vec::new(), None, 0);
        let outcome = stepper.run(system, &[Self::step()], &mut |event: &Event<'_>| {
            match event {
                Event::Iteration(record) => iterations.push((*record).clone()),
                Event::Increment { frame, .. } => {
                    values = frame.fields.first().cloned();
                    count += 1;
                }
                Event::Solver {
                    note: Note::Direct { why },
                    ..
                } => panic!("{why}"),
                _ => {}
            }
            if count == until {
                Flow::Stop
            } else {
                Flow::Continue
            }
        });
        outcome.unwrap();
        (iterations, values)
    }

    fn run(&self, linear: LinearKind) -> (State, Vec<IterationRecord>, NodalValues) {
        let mut system = self.system();
        let mut stepper = Stepper::new(&system, Self::settings(linear));
        let (iterations, values) = Self::go(&mut system, &mut stepper, 3);
        (stepper.state().clone(), iterations, values.unwrap())
    }

    /// The temperature at `x`: of it, `T + b T²/2` is linear.
    fn expected(&self, x: f64) -> f64 {
        let whole = |t: f64| t + 0.5 * self.rise * t * t;
        let [first, last] = ENDS.map(whole);
        let here = first + (last - first) * x / SIZE[0];
        if self.rise == 0.0 {
            here
        } else {
            ((1.0 + 2.0 * self.rise * here).sqrt() - 1.0) / self.rise
        }
    }
}

const SOLVERS: [LinearKind; 2] = [LinearKind::Direct, LinearKind::Multigrid];

/// Plain conduction, one that depends on temperature, and swelling; units far apart.
fn bars() -> [Bar; 4] {
    let bar = |conductivity, rise, swelling| Bar {
        conductivity,
        rise,
        swelling,
    };
    [
        bar(50.0, 0.0, 0.0),
        bar(50.0, 0.02, 0.0),
        bar(5e-7, 0.02, 1.0),
        bar(5e7, 0.02, 1.0),
    ]
}

#[test]
fn temperatures_are_those_of_the_closed_form_by_both_solvers() {
    for bar in bars() {
        let states = SOLVERS.map(|linear| {
            let (state, iterations, values) = bar.run(linear);
            if linear == LinearKind::Multigrid {
                assert!(iterations.iter().any(|i| i.linear_iterations > 3));
            }
            assert_eq!((values.name, values.ncomponent), ("temperature", 1));
            for (x, t) in Bar::mesh().points.iter().zip(&values.values) {
                let expected = bar.expected(x.x);
                assert!((t - expected).abs() < 1e-6, "{linear:?}: {t} {expected}");
            }
            state
        });
        let [direct, iterative] = states.map(|state| state.u);
        let nmotion = Bar::layout().nmotion();
        let largest = |u: &[f64]| u.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
        let apart: Vec<f64> = direct.iter().zip(&iterative).map(|(a, b)| a - b).collect();
        assert!(largest(&apart[..nmotion]) < 1e-6 * largest(&direct[..nmotion]));
    }
}

#[test]
fn what_flows_in_at_one_end_flows_out_at_the_other() {
    for bar in bars() {
        let (.., values) = bar.run(LinearKind::Direct);
        let at = |end: f64| -> f64 {
            let points = Bar::mesh().points;
            let own = points.iter().zip(&values.reaction);
            own.filter(|(x, _)| x.x == end).map(|(_, r)| r).sum()
        };
        let mean = 1.0 + 0.5 * bar.rise * (ENDS[0] + ENDS[1]);
        let slope = (ENDS[1] - ENDS[0]) / SIZE[0];
        let flow = bar.conductivity * mean * slope * SIZE[1] * SIZE[2];
        for (end, expected) in [(0.0, -flow), (SIZE[0], flow)] {
            assert!((at(end) - expected).abs() < 1e-6 * flow);
        }
        let inside = Bar::mesh()
            .points
            .iter()
            .zip(&values.reaction)
            .all(|(x, r)| {
                let is_end = x.x == 0.0 || x.x == SIZE[0];
                is_end || *r == 0.0
            });
        assert!(inside);
    }
}

#[test]
fn residuals_of_a_field_are_judged_by_a_scale_of_its_own() {
    // without one, those of the weak conductor would be nothing compared with forces, and forces nothing compared with
    // those of the strong one
    let [.., weak, strong] = bars();
    let [weak, strong] = [weak, strong].map(|bar| bar.run(LinearKind::Direct).1);
    let residuals =
        |all: &[IterationRecord]| -> Vec<f64> { all.iter().map(|i| i.residual).collect() };
    let [weak, strong] = [residuals(&weak), residuals(&strong)];
    assert_eq!(weak.len(), strong.len());
    for (a, b) in weak.iter().zip(&strong).filter(|(a, _)| **a > 1e-6) {
        assert!((a - b).abs() < 1e-3 * a, "{weak:?} {strong:?}");
    }
}

#[test]
fn a_resumed_run_repeats_every_bit_of_a_field() {
    for linear in SOLVERS {
        for bar in bars() {
            let settings = Bar::settings(linear);
            let mut system = bar.system();
            let mut stepper = Stepper::new(&system, settings);
            Bar::go(&mut system, &mut stepper, 1);
            let mut archive = Archive::default();
            stepper.save(&system, &mut archive);
            let nnode = Bar::mesh().nnode();
            assert_eq!(archive.length("state.u.temperature"), Ok(nnode));
            assert_eq!(archive.length("progress.scale"), Ok(4));
            let mut going_on = stepper.restarted(&mut system, settings, &archive).unwrap();
            Bar::go(&mut system, &mut going_on, 3);
            let mut other = bar.system();
            let mut resumed = Stepper::resumed(&mut other, settings, &archive).unwrap();
            Bar::go(&mut other, &mut resumed, 3);
            assert_eq!(resumed.state(), going_on.state());
            // nor does a run without the field read it
            archive.arrays.remove("state.u.temperature");
            let error = Stepper::resumed(&mut other, settings, &archive)
                .err()
                .unwrap();
            assert!(error.to_string().contains("state.u.temperature"), "{error}");
        }
    }
}
