//! Elements that steps remove and add.
//!
//! SOURCE      Written for the purpose.
//! GOAL        Removed elements exert nothing, added ones are free of strain or have the strain that they had.
//! MESH        Two bars of length 1, next to each other, of two cells along each; a column of layers.
//! CONDITIONS  A load that both bars share, at equal elongation; the weight of layers, laid one on the other.
//! EXPECTED    Closed forms of bars; another mesh that is undeformed where the elements are added.
//! TOLERANCE   1e-9 of closed forms
#![allow(clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
mod refused;
mod trusses;

use common::{Grid, Part, solid};
use signorini_geometry::element::by_name;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_linear::LinearKind;
use signorini_mechanics::load::{Course, Gravity, Load, PerNode, Place};
use signorini_mechanics::material::{
    Hardening, HardeningKind, Material, NeoHookean, Plasticity, SaintVenantKirchhoff,
};
use signorini_mechanics::model::{
    ActivityError, ActivityPart, BodyKind, BodyPart, Change, ConstraintKind, ConstraintPart,
    ContactPart, LoadPart, Method, Model, ModelError, Parts, PrimaryPart, SidePart, StepPart,
    Target, Unknown,
};
use signorini_mechanics::solve::{
    Event, Flow, Increments, Motion, Outcome, Stepper, StepperSettings,
};
use signorini_mechanics::system::{Archive, CellChange, Frame, Idealisation};

const E: f64 = 1000.0;
const FAMILY: [&str; 9] = [
    "tri3", "quad4", "tri6", "quad8", "tet4", "hex8", "tet10", "wedge15", "hex20",
];
const GONE: CellChange = CellChange::Removed { ramp: true };
const AT_ONCE: CellChange = CellChange::Removed { ramp: false };
const FREE: CellChange = CellChange::Added { strain_free: true };
const KEPT: CellChange = CellChange::Added { strain_free: false };

/// Two bars that support the same plate.
struct Bars {
    mesh: Mesh,
    bars: [Part; 2],
    axis: usize,
    space: Idealisation,
}

/// Two bars of an element along the last axis, the second one 2 aside; `lengths` of both.
fn bars(name: &str, lengths: [f64; 2]) -> Bars {
    let axis = by_name(name).unwrap().dim() - 1;
    let mut mesh = Mesh::default();
    let part = |mesh: &mut Mesh, k: usize| {
        let grid = Grid::of(name, [1, if axis == 1 { 2 } else { 1 }, 2], |x| {
            let mut at = x;
            at[axis] *= lengths[k];
            at.x += 2.0 * k as f64;
            at
        });
        grid.join(mesh, |_| true)
    };
    let bars = [part(&mut mesh, 0), part(&mut mesh, 1)];
    let space = match axis {
        1 => Idealisation::PlaneStress { thickness: 1.0 },
        _ => Idealisation::Space,
    };
    Bars {
        mesh,
        bars,
        axis,
        space,
    }
}

impl Bars {
    fn tops(&self) -> Vec<NodeId> {
        let top = |bar: &Part| bar.nodes(|x| (x[self.axis] - 1.0).abs() < 1e-9);
        self.bars.iter().flat_map(top).collect()
    }

    /// Supports that leave the cross-section free.
    fn supports(&self) -> Vec<Change> {
        let mut changes = Vec::new();
        for bar in &self.bars {
            for axis in 0..=self.axis {
                let nodes = bar.nodes(|x| x[axis].abs() < 1e-9);
                changes.push(Change::Prescribe(
                    Target::Nodes(nodes),
                    vec![(axis, Motion::Hold)],
                ));
            }
        }
        changes
    }

    /// The model of these steps, each with the load at its end and what becomes of the second bar.
    fn model(
        &self,
        material: &dyn Fn() -> Box<dyn Material>,
        nonlinear: bool,
        steps: &[(f64, Option<CellChange>)],
        increments: usize,
    ) -> Model {
        self.try_model(material, nonlinear, steps, increments, None)
            .unwrap()
    }

    /// The same where the nodes inside of the second bar, which have no active element while it is removed, are moved as
    /// evenly as the elongation `even` that the first one has then.
    fn model_with_motion(
        &self,
        material: &dyn Fn() -> Box<dyn Material>,
        nonlinear: bool,
        steps: &[(f64, Option<CellChange>)],
        even: f64,
    ) -> Model {
        self.try_model(material, nonlinear, steps, 2, Some(even))
            .unwrap()
    }

    /// What moves the nodes inside of the second bar, or lets them go.
    fn mesh_motion(&self, change: Option<CellChange>, even: f64) -> Vec<Change> {
        let heights = [0.25, 0.5, 0.75];
        let at = |z: f64| self.bars[1].nodes(|x| (x[self.axis] - z).abs() < 1e-9);
        let groups = heights.map(|z| (at(z), z * even)).into_iter();
        let groups = groups.filter(|(nodes, _)| !nodes.is_empty());
        let of_group = |(nodes, to): (Vec<NodeId>, f64)| match change {
            Some(CellChange::Removed { .. }) => Some(Change::Prescribe(
                Target::Nodes(nodes),
                vec![(self.axis, Motion::Ramp(to))],
            )),
            Some(CellChange::Added { .. }) => {
                Some(Change::Release(Target::Nodes(nodes), vec![self.axis]))
            }
            None => None,
        };
        groups.filter_map(of_group).collect()
    }

    fn try_model(
        &self,
        material: &dyn Fn() -> Box<dyn Material>,
        nonlinear: bool,
        steps: &[(f64, Option<CellChange>)],
        increments: usize,
        even: Option<f64>,
    ) -> Result<Model, ModelError> {
        let tops = self.tops();
        let leader = tops[0];
        let steps = steps.iter().enumerate().map(|(k, &(load, change))| {
            let mut step = StepPart::new(format!("step {k}"), Increments::Fixed(increments));
            step.nonlinear = nonlinear;
            if k == 0 {
                step.changes = self.supports();
            }
            if let Some(even) = even {
                step.changes.extend(self.mesh_motion(change, even));
            }
            let mut force = Vec3::ZERO;
            force[self.axis] = load;
            step.loads = vec![LoadPart {
                name: "load".into(),
                load: PerNode(force).on(Place::Nodes(vec![leader])),
                course: Course::Ramp,
            }];
            let cells = self.bars[1].cells.clone();
            step.activity
                .extend(change.map(|change| ActivityPart { cells, change }));
            step
        });
        let mut axes = [false; 3];
        axes[self.axis] = true;
        let body = |name: &str, bar: &Part| BodyPart {
            name: name.into(),
            cells: bar.cells.clone(),
            kind: BodyKind::solid(material()),
        };
        Model::assemble(Parts {
            bodies: vec![body("first", &self.bars[0]), body("second", &self.bars[1])],
            constraints: vec![ConstraintPart {
                name: "plate".into(),
                kind: ConstraintKind::Equal { nodes: tops, axes },
            }],
            steps: steps.collect(),
            ..Parts::new(&self.mesh, self.space)
        })
    }
}

fn settings(linear: LinearKind) -> StepperSettings {
    let mut settings = StepperSettings {
        linear,
        ..StepperSettings::default()
    };
    settings.newton.force_tol = 1e-10;
    settings
}

/// The frames of all increments.
fn run(model: &mut Model) -> Vec<Frame> {
    run_by(model, LinearKind::Direct)
}

fn run_by(model: &mut Model, linear: LinearKind) -> Vec<Frame> {
    run_with(model, settings(linear))
}

fn run_with(model: &mut Model, settings: StepperSettings) -> Vec<Frame> {
    let mut stepper = Stepper::new(&model.system, settings);
    let mut frames = Vec::new();
    let outcome = stepper.run(&mut model.system, &model.steps, &mut |event: &Event<'_>| {
        if let Event::Increment { frame, .. } = event {
            frames.push((*frame).clone());
        }
        Flow::Continue
    });
    assert_eq!(outcome.unwrap(), Outcome::Finished);
    frames
}

fn hooke(nu: f64) -> impl Fn() -> Box<dyn Material> {
    move || Box::new(SaintVenantKirchhoff::new(E, nu))
}

/// The x at which an increasing function has a value.
fn root(f: impl Fn(f64) -> f64, value: f64) -> f64 {
    let (mut low, mut high) = (-0.5, 2.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < value {
            low = middle
        } else {
            high = middle
        }
    }
    0.5 * (low + high)
}

fn near(a: f64, b: f64, what: &str) {
    assert!((a - b).abs() < 1e-9 * b.abs().max(1.0), "{what}: {a} {b}");
}

/// Elongations at the ends of steps.
fn elongations(bars: &Bars, frames: &[Frame]) -> Vec<f64> {
    let top = bars.tops()[0] as usize;
    frames
        .iter()
        .map(|f| f.displacement[top][bars.axis])
        .collect()
}

fn stress(frame: &Frame, cell: CellId, axis: usize) -> f64 {
    let s = frame.cell_stress[cell.block as usize][cell.index as usize];
    [s.xx(), s.yy(), s.zz()][axis]
}

#[test]
fn bars_that_are_removed_and_added_share_the_load_as_closed_forms_say() {
    for name in FAMILY {
        let bars = bars(name, [1.0, 1.0]);
        for nonlinear in [false, true] {
            // what a bar bears at an elongation, and what one does that was added free of strain at another
            let strain = |u: f64| if nonlinear { u + 0.5 * u * u } else { u };
            let bears = |u: f64, at: f64| {
                let stretch = if nonlinear { 1.0 + u } else { 1.0 };
                E * (strain(u) - strain(at)) * stretch
            };
            for (added, again) in [(KEPT, 0.0), (FREE, f64::NAN)] {
                let steps = [
                    (20.0, None),
                    (20.0, Some(GONE)),
                    (20.0, Some(added)),
                    (50.0, None),
                ];
                let alone = root(|u| bears(u, 0.0), 20.0);
                let mut model = bars.model_with_motion(&hooke(0.3), nonlinear, &steps, alone);
                let frames = run(&mut model);
                let found = elongations(&bars, &frames);
                let at = if again.is_nan() { alone } else { again };
                let both = |load| root(|u| bears(u, 0.0) + bears(u, at), load);
                let shared = root(|u| 2.0 * bears(u, 0.0), 20.0);
                for (step, wanted) in [shared, alone, both(20.0), both(50.0)].iter().enumerate() {
                    let what = format!("{name} {nonlinear} {added:?} step {step}");
                    near(found[2 * step + 1], *wanted, &what);
                }
                let second = bars.bars[1].cells[0];
                let active =
                    |frame: &Frame| frame.active[second.block as usize][second.index as usize];
                let seen: Vec<bool> = frames.iter().map(active).collect();
                assert_eq!(seen, [true, true, false, false, true, true, true, true]);
                assert_eq!(stress(&frames[3], second, bars.axis), 0.0);
            }
        }
    }
}

#[test]
fn what_removed_bars_exert_falls_to_zero_over_the_step_or_is_gone_at_once() {
    for name in ["quad4", "hex8", "tet10"] {
        let bars = bars(name, [1.0, 1.0]);
        for nonlinear in [false, true] {
            let of = |change| {
                let steps = [(20.0, None), (20.0, Some(change))];
                elongations(
                    &bars,
                    &run(&mut bars.model(&hooke(0.0), nonlinear, &steps, 4)),
                )
            };
            let (slowly, at_once) = (of(GONE), of(AT_ONCE));
            near(slowly[7], at_once[7], name);
            if !nonlinear {
                // 10 of the removed bar fall by a quarter each time
                for (k, wanted) in [0.0125, 0.015, 0.0175, 0.02].iter().enumerate() {
                    near(slowly[4 + k], *wanted, name);
                    near(at_once[4 + k], 0.02, name);
                }
            }
        }
    }
}

#[test]
fn elements_may_be_removed_from_the_first_step_on() {
    for name in FAMILY {
        let bars = bars(name, [1.0, 1.0]);
        let steps = [(20.0, Some(GONE)), (20.0, Some(FREE)), (60.0, None)];
        let found = elongations(&bars, &run(&mut bars.model(&hooke(0.3), false, &steps, 1)));
        for (found, wanted) in found.iter().zip([0.02, 0.02, 0.04]) {
            near(*found, wanted, name);
        }
    }
}

#[test]
fn added_elements_of_large_strain_are_those_of_a_mesh_that_is_undeformed_there() {
    for name in FAMILY {
        let steps = [(150.0, Some(GONE)), (150.0, Some(FREE)), (400.0, None)];
        let rubber = || -> Box<dyn Material> { Box::new(NeoHookean::new(E, 0.3)) };
        let bars_of = |lengths| bars(name, lengths);
        let here = bars_of([1.0, 1.0]);
        let alone = elongations(&here, &run(&mut here.model(&rubber, true, &steps, 2)))[1];
        let frames = run(&mut here.model_with_motion(&rubber, true, &steps, alone));
        let found = elongations(&here, &frames);
        // the second bar is as long as the first has become
        let there = bars_of([1.0, 1.0 + found[1]]);
        let equal = |u: f64, by: f64| {
            let mut steps = vec![StepPart::new("pull", Increments::Fixed(2))];
            steps[0].changes = there.supports();
            for (bar, to) in there.bars.iter().zip([u, by]) {
                let nodes = bar.nodes(|x| (x[there.axis] - 1.0).abs() < 1e-9);
                let motions = vec![(there.axis, Motion::Ramp(to))];
                steps[0]
                    .changes
                    .push(Change::Prescribe(Target::Nodes(nodes), motions));
            }
            let body = |name: &str, bar: &Part| BodyPart {
                name: name.into(),
                cells: bar.cells.clone(),
                kind: BodyKind::solid(rubber()),
            };
            let mut model = Model::assemble(Parts {
                bodies: vec![
                    body("first", &there.bars[0]),
                    body("second", &there.bars[1]),
                ],
                steps,
                ..Parts::new(&there.mesh, there.space)
            })
            .unwrap();
            let frames = run(&mut model);
            let last = frames.last().unwrap();
            there
                .tops()
                .iter()
                .map(|&n| last.reaction_force[n as usize][there.axis])
                .sum::<f64>()
        };
        let (u, before) = (found[5], found[1]);
        near(equal(u, u - before), 400.0, name);
    }
}

/// A law that yields at 8, and one that does not.
fn metal() -> Box<dyn Material> {
    let hardening = Hardening::new(HardeningKind::Isotropic, vec![[8.0, 0.0], [108.0, 1.0]]);
    Box::new(Plasticity::new(E, 0.3, hardening.unwrap()).unwrap())
}

#[test]
fn plastic_bars_begin_as_new_or_go_on_as_they_were() {
    // slopes before and after yield
    let (elastic, plastic) = (E, E * 100.0 / (E + 100.0));
    let bears = |strain: f64| {
        let first = 8.0 / elastic;
        if strain < first {
            elastic * strain
        } else {
            8.0 + plastic * (strain - first)
        }
    };
    for name in ["quad4", "hex8", "hex20", "tet10"] {
        let bars = bars(name, [1.0, 1.0]);
        for added in [FREE, KEPT] {
            let steps = [
                (20.0, None),
                (20.0, Some(GONE)),
                (20.0, Some(added)),
                (60.0, None),
            ];
            let frames = run(&mut bars.model(&|| metal(), false, &steps, 4));
            let found = elongations(&bars, &frames);
            let shared = root(|u| 2.0 * bears(u), 20.0);
            near(found[3], shared, name);
            let alone = root(bears, 20.0);
            near(found[7], alone, name);
            if added == FREE {
                near(found[11], alone, name);
                let both = root(|u| bears(u) + bears(u - alone), 60.0);
                near(found[15], both, name);
            } else {
                // the second bar unloads nothing: it goes on hardening from where it was
                let both = root(|u| bears(u) * 2.0, 60.0);
                near(found[15], both, name);
            }
        }
    }
}

#[test]
fn added_elements_have_no_stress_whatever_their_law_and_their_remedy() {
    type Make = fn() -> Box<dyn Material>;
    let laws: [Make; 5] = [
        || Box::new(SaintVenantKirchhoff::new(E, 0.3)),
        || Box::new(SaintVenantKirchhoff::new(E, 0.49)),
        || Box::new(NeoHookean::new(E, 0.3)),
        || Box::new(NeoHookean::new(E, 0.49)),
        metal,
    ];
    for name in FAMILY {
        let bars = bars(name, [1.0, 1.0]);
        for (number, law) in laws.iter().enumerate() {
            for nonlinear in [false, true] {
                let steps = [(12.0, None), (12.0, Some(GONE)), (12.0, Some(FREE))];
                let mut model = bars.model(law, nonlinear, &steps, 2);
                let frames = run_with(&mut model, StepperSettings::default());
                for &cell in &bars.bars[1].cells {
                    let s = frames[5].cell_stress[cell.block as usize][cell.index as usize];
                    let what = format!("{name} law {number} {nonlinear}: {s:?}");
                    assert!(s.to_pairs().iter().all(|c| c.abs() < 1e-4), "{what}");
                }
                let found = elongations(&bars, &frames);
                assert!((found[3] - found[5]).abs() < 1e-6 * found[3], "{name}");
            }
        }
    }
}

#[test]
fn layers_laid_one_on_the_other_sink_as_superposition_says() {
    let (nlayer, weight) = (4, 10.0);
    // of simplices, whose nodes do not share a weight evenly, none is as straight
    for name in ["tri3", "quad4", "quad8", "wedge15", "hex8", "hex20"] {
        let axis = by_name(name).unwrap().dim() - 1;
        let mut count = [1, 1, 1];
        count[axis] = nlayer;
        let grid = Grid::of(name, count, |x| {
            let mut x = x;
            x[axis] *= nlayer as f64;
            x
        });
        let layer_of = |cell: &CellId| {
            let nodes = grid.mesh.cell(*cell);
            let sum: f64 = nodes
                .iter()
                .map(|&n| grid.mesh.points[n as usize][axis])
                .sum();
            (sum / nodes.len() as f64).floor() as usize
        };
        let layer = |k: usize| -> Vec<CellId> {
            grid.cells
                .iter()
                .filter(|c| layer_of(c) == k)
                .copied()
                .collect()
        };
        let mut down = Vec3::ZERO;
        down[axis] = -weight;
        let mut body = solid("layers", &grid.cells, SaintVenantKirchhoff::new(E, 0.0));
        if let BodyKind::Solid { density, .. } = &mut body.kind {
            *density = Some(1.0);
        }
        let bottom = grid.nodes(|x| x[axis].abs() < 1e-9);
        let sides = |a: usize| grid.nodes(|x| x[a].abs() < 1e-9);
        let steps = (0..nlayer).map(|k| {
            let mut step = StepPart::new(format!("layer {k}"), Increments::Fixed(2));
            step.nonlinear = false;
            if k == 0 {
                step.changes.push(Change::Prescribe(
                    Target::Nodes(bottom.clone()),
                    vec![(axis, Motion::Hold)],
                ));
                for a in 0..axis {
                    step.changes.push(Change::Prescribe(
                        Target::Nodes(sides(a)),
                        vec![(a, Motion::Hold)],
                    ));
                }
                step.loads = vec![LoadPart {
                    name: "weight".into(),
                    load: Gravity(down).on(Place::Cells(grid.cells.clone())),
                    course: Course::Ramp,
                }];
                let cells = (1..nlayer).flat_map(layer).collect();
                step.activity = vec![ActivityPart {
                    cells,
                    change: GONE,
                }];
            } else {
                step.activity = vec![ActivityPart {
                    cells: layer(k),
                    change: FREE,
                }];
            }
            step
        });
        let space = match axis {
            1 => Idealisation::PlaneStress { thickness: 1.0 },
            _ => Idealisation::Space,
        };
        let mut model = Model::assemble(Parts {
            bodies: vec![body],
            steps: steps.collect(),
            ..Parts::new(&grid.mesh, space)
        })
        .unwrap();
        let frames = run(&mut model);
        // each layer above adds its weight to all below; its own weight hangs in it, in the mean half of it
        for step in 0..nlayer {
            for k in 0..nlayer {
                let top = grid.nodes(|x| (x[axis] * nlayer as f64 - (k + 1) as f64).abs() < 1e-9);
                let above = step.saturating_sub(k) as f64;
                let own = k as f64 * weight / E + 0.5 * weight / E;
                let sunk = above * (k + 1) as f64 * weight / E + own;
                let wanted = if k <= step { -sunk } else { 0.0 };
                let u: f64 = top
                    .iter()
                    .map(|&n| frames[2 * step + 1].displacement[n as usize][axis])
                    .sum();
                let what = format!("{name} step {step} layer {k}");
                near(u / top.len() as f64, wanted, &what);
            }
        }
    }
}

#[test]
fn a_facet_of_a_removed_element_touches_nothing() {
    for method in [Method::Auto, Method::NodeToSegment] {
        for name in ["quad4", "hex8"] {
            let bars = bars(name, [1.0, 1.0]);
            let mut mesh = bars.mesh.clone();
            let axis = bars.axis;
            let base = Grid::of(name, [4, if axis == 1 { 1 } else { 2 }, 1], |x| {
                let mut at = x;
                at.x = 4.0 * x.x - 0.5;
                if axis == 2 {
                    at.y = 2.0 * x.y - 0.5;
                }
                at[axis] -= 1.0;
                at
            })
            .join(&mut mesh, |_| true);
            let foot = |bar: &Part| -> Vec<_> {
                let faces = bar.faces.iter().filter(|f| {
                    let (_, nodes) = mesh.face(**f).unwrap();
                    nodes
                        .iter()
                        .all(|&n| mesh.points[n as usize][axis].abs() < 1e-9)
                });
                faces.copied().collect()
            };
            let secondary: Vec<_> = bars.bars.iter().flat_map(foot).collect();
            let primary: Vec<_> = foot(&base);
            assert!(secondary.len() >= 2 && !primary.is_empty());
            let mut contact = ContactPart::new(
                "foot",
                SidePart::Faces(secondary),
                PrimaryPart::Faces(primary),
            );
            contact.method = method.clone();
            let hold =
                |nodes: Vec<NodeId>, motions| Change::Prescribe(Target::Nodes(nodes), motions);
            let sideways = || (0..axis).map(|a| (a, Motion::Hold));
            let press: Vec<_> = sideways().chain([(axis, Motion::Ramp(-0.01))]).collect();
            let held: Vec<_> = sideways().chain([(axis, Motion::Hold)]).collect();
            let mut steps: Vec<StepPart> = ["press", "remove", "add", "press on"]
                .iter()
                .map(|name| StepPart::new(*name, Increments::Fixed(2)))
                .collect();
            steps.iter_mut().for_each(|step| step.nonlinear = false);
            let bottom = base.nodes(|x| x[axis].abs() < 1e-9);
            steps[0].changes = vec![hold(bars.tops(), press), hold(bottom, held)];
            let cells = bars.bars[1].cells.clone();
            for (step, change) in [(1, GONE), (2, FREE)] {
                steps[step].activity = vec![ActivityPart {
                    cells: cells.clone(),
                    change,
                }];
            }
            steps[3].changes = vec![hold(
                bars.tops(),
                sideways().chain([(axis, Motion::Ramp(-0.02))]).collect(),
            )];
            let all = [&bars.bars[0], &bars.bars[1], &base];
            let bodies = all
                .iter()
                .zip(["first", "second", "base"])
                .map(|(part, name)| solid(name, &part.cells, SaintVenantKirchhoff::new(E, 0.0)));
            let mut model = Model::assemble(Parts {
                bodies: bodies.collect(),
                contacts: vec![contact],
                steps,
                ..Parts::new(&mesh, bars.space)
            })
            .unwrap();
            let frames = run(&mut model);
            let at = |step: usize| &frames[2 * step + 1];
            let force = |step: usize| at(step).contacts[0].secondary.force[axis];
            assert!(frames.iter().all(|f| f.contacts.len() == 1));
            let of_first: f64 = at(1).contacts[0].force.iter().map(|f| f[axis]).sum();
            assert!(force(0) > 1.0 && (of_first - force(1)).abs() < 1e-9 * of_first);
            // equilibrium: what the foot feels, the heads of active bars feel
            for step in 0..4 {
                let heads: f64 = bars
                    .tops()
                    .iter()
                    .map(|&n| at(step).reaction_force[n as usize][axis])
                    .sum();
                assert!(
                    (heads + force(step)).abs() < 1e-7,
                    "{name} {method:?} step {step}: {heads} {}",
                    force(step)
                );
            }
            // what was removed bears nothing; while it was, the base has risen to its foot
            assert!(
                force(1) < 0.7 * force(0),
                "{name}: {} {}",
                force(1),
                force(0)
            );
            assert!(force(2) > force(1), "{name}: {} {}", force(2), force(1));
            assert!(force(3) > 1.3 * force(0), "{name}: {}", force(3));
        }
    }
}

/// Steps in which everything happens.
const EVENTFUL: [(f64, Option<CellChange>); 5] = [
    (20.0, None),
    (20.0, Some(GONE)),
    (25.0, Some(FREE)),
    (10.0, Some(AT_ONCE)),
    (40.0, Some(KEPT)),
];

#[test]
fn a_run_resumed_at_any_increment_is_the_same_run_bit_by_bit() {
    let laws: [&dyn Fn() -> Box<dyn Material>; 3] = [&|| metal(), &hooke(0.3), &|| {
        Box::new(NeoHookean::new(E, 0.3))
    }];
    for (name, law, nonlinear) in [
        ("hex8", laws[0], false),
        ("hex8", laws[0], true),
        ("quad4", laws[1], true),
        ("tet4", laws[2], true),
    ] {
        let bars = bars(name, [1.0, 1.0]);
        let make = || bars.model(law, nonlinear, &EVENTFUL, 3);
        let mut model = make();
        let mut stepper = Stepper::new(&model.system, settings(LinearKind::Direct));
        let (mut states, mut archives) = (Vec::new(), Vec::new());
        let next = |model: &mut Model, stepper: &mut Stepper| {
            let outcome = stepper.run(
                &mut model.system,
                &model.steps,
                &mut |e: &Event<'_>| match e {
                    Event::Increment { .. } => Flow::Stop,
                    _ => Flow::Continue,
                },
            );
            outcome.unwrap()
        };
        while next(&mut model, &mut stepper) == Outcome::Stopped {
            let mut archive = Archive::default();
            stepper.save(&model.system, &mut archive);
            states.push(stepper.state().clone());
            archives.push(archive);
        }
        assert_eq!(states.len(), 15);
        for (at, archive) in archives.iter().enumerate() {
            let mut model = make();
            let settings = settings(LinearKind::Direct);
            let mut stepper = Stepper::resumed(&mut model.system, settings, archive).unwrap();
            for (number, state) in states.iter().enumerate().skip(at + 1) {
                assert_eq!(next(&mut model, &mut stepper), Outcome::Stopped);
                assert_eq!(
                    stepper.state(),
                    state,
                    "{name} resumed at {at}, increment {number}"
                );
            }
        }
    }
}

#[test]
fn every_solver_finds_the_same_states() {
    let bars = bars("hex8", [1.0, 1.0]);
    for nonlinear in [false, true] {
        let make = || bars.model(&hooke(0.3), nonlinear, &EVENTFUL, 2);
        let direct = elongations(&bars, &run(&mut make()));
        let levels = elongations(&bars, &run_by(&mut make(), LinearKind::Multigrid));
        for (a, b) in direct.iter().zip(&levels) {
            near(*a, *b, "multigrid");
        }
    }
}
