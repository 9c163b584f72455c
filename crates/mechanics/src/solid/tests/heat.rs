//! Heat in bodies, and what it does to stresses: against differences, balances, closed forms.

use super::*;
use crate::material::Conductor;
use crate::system::{Conducting, Heat, Increment, Physics};

/// The time of an increment.
const DT: f64 = 0.3;

/// A body that swells and conducts.
struct Hot {
    solid: Solid,
    heat: HeatInBody,
    layout: Layout,
    reference: Arc<[Vec3]>,
    begun: State,
}

/// A conductor with directions and tables that stores heat.
fn conductor() -> Conductor {
    let k = |size: f64| Sym3::new(size, 2.0 * size, 0.7 * size, 0.1, 0.0, 0.05);
    let tables = Conductor::new(vec![(0.0, k(2.0)), (60.0, k(5.0))]);
    let stores = tables.and_then(|one| one.storing(3.0, vec![[-50.0, 1.0], [90.0, 2.5]]));
    stores.unwrap()
}

fn expanding(inner: Box<dyn Material>) -> Box<dyn Material> {
    let alpha = vec![[-40.0, 1e-3], [80.0, 2e-3]];
    Box::new(Expanding::by_temperature(inner, alpha, 15.0, Some(5.0)))
}

/// Laws that depend on temperature.
fn laws() -> Vec<(&'static str, Box<dyn Material>)> {
    let mut softening = Constants::default();
    softening.set("T", vec![-50.0, 90.0]);
    softening.set("E", vec![700.0, 300.0]);
    softening.set("nu", vec![0.25, 0.35]);
    let softening = || Box::new(ByTemperature::new(&softening).unwrap()) as Box<dyn Material>;
    vec![
        ("linear", expanding(elastic("linear-elastic", 0.3))),
        ("rubber", expanding(elastic("neo-hookean", 0.3))),
        ("softening", softening()),
        ("softening and expanding", expanding(softening())),
        ("plastic", expanding(derivatives::plastic())),
    ]
}

impl Hot {
    fn new(
        mesh: &Mesh,
        material: Box<dyn Material>,
        conductor: Conductor,
        storage: Storage,
        wish: &Wish,
    ) -> Option<Self> {
        let ndim = wish.space.ndim();
        let layout = Layout::new(ndim, mesh.nnode(), 0);
        let layout = layout.with_field(Layout::TEMPERATURE).unwrap();
        let cells: Vec<_> = mesh.cells(ndim).collect();
        let ends = vec![vec![0.0; mesh.nnode()]];
        let given = Some(Arc::new(NodalField { ends }));
        let Body {
            mut solid,
            reference,
            ..
        } = body_in(layout, mesh, material, wish, given, &Directors::default()).ok()?;
        let mut heat = HeatInBody::new(HeatParts {
            name: "body",
            mesh,
            reference: reference.clone(),
            cells: &cells,
            layout,
            space: wish.space,
            profile: None,
            conductor,
            axes: Mat3::rotation(Vec3::unit(2) * 0.4),
            reduced: wish.integration == Integration::Reduced,
            storage,
        })
        .ok()?;
        let step = StepContext {
            nonlinear: wish.kinematics == Kinematics::Finite,
            physics: Physics::coupled(Heat::Transient),
            ..StepContext::default()
        };
        let increment = Increment {
            number: 1,
            from: 0.0,
            to: DT,
        };
        let mut begun = state(&layout, &reference, &vec![0.0; layout.ndof()]);
        for node in 0..mesh.nnode() as u32 {
            begun.u[layout.temperature(node) as usize] = 10.0 + 8.0 * noise(node as usize);
        }
        for phase in [Phase::of_step(step), Phase::of_increment(step, increment)] {
            solid.begin(&phase, &begun).unwrap();
            heat.begin(&phase, &begun).unwrap();
        }
        Some(Self {
            solid,
            heat,
            layout,
            reference,
            begun,
        })
    }

    /// Displacements of this size, and temperatures of about twenty degrees.
    fn unknowns(&self, size: f64) -> Vec<f64> {
        let nmotion = self.layout.nmotion();
        let value = |k: usize| match k < nmotion {
            true => size * noise(100 + k),
            false => 20.0 + 15.0 * noise(k),
        };
        (0..self.layout.ndof()).map(value).collect()
    }

    fn assemble(&self, u: &[f64], order: Order) -> Dense {
        let n = self.layout.ndof();
        let mut dense = Dense {
            force: vec![0.0; n],
            stiffness: vec![0.0; if order == Order::Tangent { n * n } else { 0 }],
        };
        let (state, mut work) = (state(&self.layout, &self.reference, u), Work::default());
        let terms: [&dyn Term; 2] = [&self.solid, &self.heat];
        for term in terms {
            for chunk in 0..term.nchunk() {
                let outcome = term.evaluate(chunk, &state, order, &mut work, &mut dense);
                outcome.unwrap();
            }
        }
        dense
    }

    /// Each block of the stiffness against differences; the one against displacements of heat in a body with directions leaves
    /// out how these turn.
    fn check(&self, what: &str, turns: bool) {
        let (n, nmotion) = (self.layout.ndof(), self.layout.nmotion());
        let u = self.unknowns(if n > 24 { 0.02 } else { 0.05 });
        let at = self.assemble(&u, Order::Tangent);
        let block = |i: usize, j: usize| [i < nmotion, j < nmotion];
        let scale = |of: [bool; 2]| {
            let entries = at.stiffness.iter().enumerate();
            let own = entries.filter(|(k, _)| block(k / n, k % n) == of);
            own.fold(0.0, |most: f64, (_, k)| most.max(k.abs()))
        };
        let scales = [false, true].map(|row| [false, true].map(|column| scale([row, column])));
        for j in 0..n {
            let h = if j < nmotion { 2e-5 } else { 1e-2 };
            let mut shifted = u.clone();
            let columns = [h, -h, 2.0 * h, -2.0 * h].map(|d| {
                shifted[j] = u[j] + d;
                self.assemble(&shifted, Order::Residual).force
            });
            for i in 0..n {
                let [a, b, c, d] = columns.each_ref().map(|f| f[i]);
                let k = (8.0 * (a - b) - (c - d)) / (12.0 * h);
                let [row, column] = block(i, j).map(usize::from);
                let error = (k - at.stiffness[i * n + j]).abs();
                let left_out = turns && row == 0 && column == 1;
                let most = if left_out { 0.5 } else { 1e-7 };
                assert!(
                    error <= most * scales[row][column],
                    "{what}: {i} {j} off by {error:e} of {:e}",
                    scales[row][column]
                );
            }
        }
    }
}

#[test]
fn heat_and_swelling_match_differences_for_every_element_remedy_and_law() {
    let mut checked = 0;
    for (element, space) in elements() {
        let mesh = one(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            for locking in LOCKINGS {
                let wish = Wish {
                    locking,
                    ..Wish::plain(space, kinematics)
                };
                if locking == Locking::Auto || !derivatives::allowed(element.name(), &wish) {
                    continue;
                }
                // the larger elements differ from the others in nothing but their size
                let few = if element.nnode() > 10 { 4 } else { 0 };
                for (law, material) in laws().into_iter().skip(few) {
                    let storage = match checked % 2 {
                        0 => Storage::Consistent,
                        _ => Storage::Lumped,
                    };
                    let hot = Hot::new(&mesh, material, conductor(), storage, &wish).unwrap();
                    let finite = kinematics == Kinematics::Finite;
                    let name = element.name();
                    let what = format!("{name} {space:?} {kinematics:?} {locking} {law}");
                    hot.check(&what, finite);
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 150, "{checked}");
}

#[test]
fn conduction_that_is_the_same_in_all_directions_matches_differences_at_finite_strain() {
    for (element, space) in elements() {
        let mesh = one(element, space);
        let wish = Wish::plain(space, Kinematics::Finite);
        let conductor = Conductor::isotropic(4.0).storing(3.0, vec![[0.0, 2.0]]);
        let rubber = expanding(elastic("neo-hookean", 0.3));
        let hot = Hot::new(
            &mesh,
            rubber,
            conductor.unwrap(),
            Storage::Consistent,
            &wish,
        );
        hot.unwrap().check(element.name(), false);
    }
}

#[test]
fn what_flows_between_nodes_sums_to_what_is_stored() {
    for (element, space) in elements() {
        let mesh = one(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            for storage in [Storage::Consistent, Storage::Lumped] {
                let wish = Wish::plain(space, kinematics);
                let material = elastic("linear-elastic", 0.3);
                let mut hot = Hot::new(&mesh, material, conductor(), storage, &wish).unwrap();
                let u = hot.unknowns(0.03);
                let nmotion = hot.layout.nmotion();
                let heat = hot.assemble(&u, Order::Residual).force[nmotion..].to_vec();
                let scale: f64 = heat.iter().map(|r| r.abs()).sum();
                let end = state(&hot.layout, &hot.reference, &u);
                hot.heat.accept(&end).unwrap();
                let off = heat.iter().sum::<f64>() - hot.heat.flows().sum.stored;
                assert!(off.abs() < 1e-12 * scale, "{}: {off:e}", element.name());
            }
        }
    }
}

#[test]
fn a_body_that_turns_conducts_as_before() {
    for (element, space) in elements() {
        if space == Idealisation::Axisymmetric {
            continue;
        }
        let mesh = one(element, space);
        let wish = Wish::plain(space, Kinematics::Finite);
        let material = elastic("linear-elastic", 0.3);
        let hot = Hot::new(&mesh, material, conductor(), Storage::Consistent, &wish).unwrap();
        let turn = match space {
            Idealisation::Space => Mat3::rotation(Vec3::new(0.4, -0.5, 1.1)),
            _ => Mat3::rotation(Vec3::unit(2) * 1.1),
        };
        let heat_at = |turn: Mat3| {
            let mut u = hot.unknowns(0.0);
            for (node, x) in (0..).zip(mesh.points.iter()) {
                let moved = turn * *x - *x;
                for axis in 0..hot.layout.ndim() {
                    u[hot.layout.node(node, axis) as usize] = moved[axis];
                }
            }
            hot.assemble(&u, Order::Residual).force[hot.layout.nmotion()..].to_vec()
        };
        let (still, turned) = (heat_at(Mat3::IDENTITY), heat_at(turn));
        let scale = still.iter().fold(0.0, |most: f64, q| most.max(q.abs()));
        for (a, b) in still.iter().zip(&turned) {
            assert!((a - b).abs() < 1e-13 * scale, "{}", element.name());
        }
    }
}

#[test]
fn an_even_gradient_has_the_flux_of_the_law_at_all_nodes() {
    for (element, space) in elements() {
        if space == Idealisation::Axisymmetric {
            continue;
        }
        let mesh = one(element, space);
        let wish = Wish::plain(space, Kinematics::Small);
        let k = Sym3::new(2.0, 1.0, 0.7, 0.3, 0.1, -0.2);
        let conductor = Conductor::new(vec![(0.0, k)]).unwrap();
        let conductor = conductor.storing(1.0, vec![[0.0, 1.0]]).unwrap();
        let material = elastic("linear-elastic", 0.3);
        let hot = Hot::new(&mesh, material, conductor, Storage::Consistent, &wish).unwrap();
        let steep = match space {
            Idealisation::Space => Vec3::new(3.0, -2.0, 1.5),
            _ => Vec3::new(3.0, -2.0, 0.0),
        };
        let mut end = hot.begun.clone();
        for (node, x) in (0..).zip(mesh.points.iter()) {
            end.u[hot.layout.temperature(node) as usize] = 7.0 + steep.dot(*x);
        }
        let mut frame = Frame::new(mesh.nnode(), &[1]);
        hot.heat.report(&end, &mut frame).unwrap();
        let axes = Mat3::rotation(Vec3::unit(2) * 0.4);
        let expected = k.congruence(axes).to_mat3() * steep * -1.0;
        for flux in &frame.heat_flux {
            assert!(
                (*flux - expected).norm() < 1e-12,
                "{} {flux:?}",
                element.name()
            );
        }
        assert_eq!(
            frame.temperature[0],
            end.u[hot.layout.temperature(0) as usize]
        );
    }
}
