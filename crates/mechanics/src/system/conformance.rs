//! What terms promise with each of their abilities, of all kinds of terms that have it.

use super::*;
use crate::connector::Damper;
use crate::contact::friction::{Coulomb, Stick};
use crate::contact::law::{ContactLaw, Lagrange, Penalty, Uzawa};
use crate::contact::tests::Random;
use crate::contact::tests::scene::{Choice, Kind, Method, Scene};
use crate::load::{NodalForces, Schedule};
use crate::material::{Constants, Hardening, HardeningKind, Material, Plasticity, TABLE};
use crate::solid::{Locking, Solid, SolidParts, Truss, TrussParts};
use signorini_geometry::element;
use signorini_geometry::mesh::{CellId, Mesh};
use std::sync::Arc;

/// A term at its start, and a state further on.
struct Specimen {
    name: String,
    term: Box<dyn Term>,
    ndof: usize,
    nmultiplier: usize,
    cells: Vec<CellId>,
    start: State,
    moved: State,
}

/// The begin of an increment of the first step.
fn phase() -> Phase {
    crate::contact::tests::next_increment()
}

impl Specimen {
    fn of_mesh(name: &str, mesh: &Mesh, make: impl FnOnce(Layout) -> Box<dyn Term>) -> Self {
        let layout = Layout::new(3, mesh.points.len(), 0);
        let elimination = Elimination::default();
        let start = State::initial(&layout, &mesh.points, &elimination);
        let mut moved = start.clone();
        let noise = |k: usize| (k as f64 * 12.9898).sin();
        let du: Vec<f64> = (0..layout.ndof()).map(|k| 0.05 * noise(k)).collect();
        moved.advance_from(&start, &du, 1.0, &layout, &mesh.points, &elimination);
        Self {
            name: name.to_string(),
            term: make(layout),
            ndof: layout.ndof(),
            nmultiplier: 0,
            cells: [1, 3].into_iter().flat_map(|dim| mesh.cells(dim)).collect(),
            start,
            moved,
        }
    }

    fn of_contact(name: &str, method: Method, choice: Choice) -> Self {
        let scene = Scene::new(Kind::Elements("quad4"), method, choice, 5);
        let moved = scene.further(&mut Random::new(6));
        Self {
            name: format!("{name}, {method:?}"),
            ndof: scene.layout.ndof(),
            nmultiplier: scene.layout.nmultiplier(),
            cells: Vec::new(),
            start: scene.state,
            moved,
            term: Box::new(scene.interface),
        }
    }

    /// Begins a step and an increment.
    fn begun(mut self) -> Self {
        let phase = phase();
        self.term
            .begin(&Phase::of_step(phase.step), &self.start)
            .unwrap();
        self.term.begin(&phase, &self.start).unwrap();
        self
    }

    /// Looks at the state further on as an iteration does.
    fn look(&mut self) -> Verdict {
        let Some(adaptive) = self.term.adaptive() else {
            return Verdict::Settled;
        };
        adaptive.prepare(&self.moved, Order::Tangent).unwrap();
        let choices = adaptive.choices();
        choices.map_or(Verdict::Settled, |of| of.verdict(&self.moved))
    }

    fn respond(&self, state: &State) -> Taken {
        let mut taken = Taken::new(self.ndof);
        let mut work = Work::default();
        for chunk in 0..self.term.nchunk() {
            self.term
                .evaluate(chunk, state, Order::Tangent, &mut work, &mut taken)
                .unwrap();
        }
        taken
    }
}

/// All that a term adds.
#[derive(PartialEq)]
struct Taken {
    /// The unknowns of each contribution.
    dofs: Vec<Vec<Dof>>,
    force: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Taken {
    fn new(n: usize) -> Self {
        Self {
            dofs: Vec::new(),
            force: vec![0.0; n],
            stiffness: vec![0.0; n * n],
        }
    }
}

impl Taken {
    /// Whether another one adds the same but for rounding: closest points are found from those before.
    fn is_near(&self, other: &Self) -> bool {
        let near = |a: &[f64], b: &[f64]| {
            let most = a.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
            let mut pairs = a.iter().zip(b);
            pairs.all(|(a, b)| (a - b).abs() <= 1e-11 * most)
        };
        self.dofs == other.dofs
            && near(&self.force, &other.force)
            && near(&self.stiffness, &other.stiffness)
    }
}

impl Sink for Taken {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        let n = self.force.len();
        self.dofs.push(dofs.to_vec());
        let is_one = |dof: &Dof| *dof != NO_DOF;
        for (&dof, f) in dofs.iter().zip(force).filter(|(dof, _)| is_one(dof)) {
            self.force[dof as usize] += f;
        }
        for (&row, values) in dofs.iter().zip(stiffness.chunks(dofs.len())) {
            for (&column, k) in dofs.iter().zip(values) {
                if is_one(&row) && is_one(&column) {
                    self.stiffness[row as usize * n + column as usize] += k;
                }
            }
        }
    }

    fn couple(&mut self, rows: &[Dof], columns: &[Dof], stiffness: &[f64]) {
        crate::system::couple_as_square(self, rows, columns, stiffness);
    }

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

fn elastic() -> Box<dyn Material> {
    let law = TABLE.iter().find(|law| law.name == "linear-elastic");
    (law.unwrap().make)(&Constants::elastic(500.0, 0.3)).unwrap()
}

fn plastic() -> Box<dyn Material> {
    let rows = &[[1.0, 0.0], [2.0, 0.1]];
    let hardening = Hardening::new(HardeningKind::Isotropic, rows.to_vec()).unwrap();
    Box::new(Plasticity::new(500.0, 0.3, hardening).unwrap())
}

/// A mesh of one element in its reference configuration.
fn one(name: &str) -> Mesh {
    let element = element::by_name(name).unwrap();
    let mut mesh = Mesh {
        points: element.nodes().to_vec(),
        node_labels: (1..=element.nnode() as u64).collect(),
        ..Mesh::default()
    };
    let nodes: Vec<u32> = (0..element.nnode() as u32).collect();
    mesh.push_cell(element, &nodes, 7);
    mesh
}

fn solid(name: &str, material: fn() -> Box<dyn Material>) -> Specimen {
    let mesh = one("hex8");
    Specimen::of_mesh(name, &mesh, |layout| {
        let cells: Vec<CellId> = mesh.cells(3).collect();
        let solid = Solid::new(SolidParts {
            name: "body",
            mesh: &mesh,
            reference: mesh.points.clone().into(),
            cells: &cells,
            layout,
            space: Idealisation::Space,
            profile: None,
            material: material(),
            integration: Default::default(),
            locking: Locking::None,
            temperature: None,
            linear_temperatures: false,
            at_nodes: Default::default(),
            initial: &[],
            axes: None,
            directors: &crate::system::Directors::default(),
        });
        Box::new(solid.unwrap())
    })
}

fn truss(name: &str, material: fn() -> Box<dyn Material>) -> Specimen {
    let mesh = one("line2");
    Specimen::of_mesh(name, &mesh, |layout| {
        let cells: Vec<CellId> = mesh.cells(1).collect();
        let truss = Truss::new(TrussParts {
            name: "bar",
            mesh: &mesh,
            reference: mesh.points.clone().into(),
            cells: &cells,
            layout,
            space: Idealisation::Space,
            material: material(),
            area: 0.4,
            small: false,
            temperature: None,
        });
        Box::new(truss.unwrap())
    })
}

/// Terms of every kind.
fn specimens() -> Vec<Specimen> {
    let mesh = one("hex8");
    let dofs = || (0..24).map(|dof| (dof, 3.0)).collect::<Vec<(Dof, f64)>>();
    let rubs = |law: Box<dyn ContactLaw>| Choice {
        friction: Some((
            Arc::new(Coulomb {
                mu: 0.3,
                cap: f64::INFINITY,
            }),
            Stick::Stiffness(3.0),
        )),
        ..Choice::of(law)
    };
    let mut all = vec![
        solid("elastic solid", elastic),
        solid("plastic solid", plastic),
        truss("elastic truss", elastic),
        truss("plastic truss", plastic),
        Specimen::of_mesh("damper on request", &mesh, |_| {
            Box::new(Damper::when_asked("slow", dofs()))
        }),
        Specimen::of_mesh("damper until contact", &mesh, |_| {
            let course = Course::new("cube", 1.0, dofs());
            Box::new(Damper::until_held("loose", vec![course]))
        }),
        Specimen::of_mesh("load", &mesh, |_| {
            let forces = [(2, 5.0)];
            Box::new(NodalForces::new("load", &forces, Schedule::ramps(&[1.0])))
        }),
    ];
    for method in [Method::NodeToSegment, Method::SmallSliding, Method::Mortar] {
        all.push(Specimen::of_contact(
            "penalty",
            method,
            rubs(Box::new(Penalty)),
        ));
        all.push(Specimen::of_contact(
            "multipliers",
            method,
            rubs(Box::new(Lagrange)),
        ));
        all.push(Specimen::of_contact("Uzawa", method, rubs(Box::new(Uzawa))));
    }
    let tied = Choice {
        bond: true,
        friction: None,
        ..rubs(Box::new(Lagrange))
    };
    all.push(Specimen::of_contact("joint", Method::Mortar, tied));
    all
}

/// Checks all that have an ability; `count` of them do.
fn for_all<'a>(
    specimens: &'a mut [Specimen],
    count: usize,
    mut check: impl FnMut(&'a mut Specimen) -> bool,
) {
    let found = specimens
        .iter_mut()
        .filter_map(|of| check(of).then_some(()));
    assert_eq!(found.count(), count);
}

fn begun() -> Vec<Specimen> {
    specimens().into_iter().map(Specimen::begun).collect()
}

#[test]
fn a_load_has_no_ability_besides() {
    let all = begun();
    let load = all.into_iter().find(|of| of.name == "load");
    let mut term = load.unwrap().term;
    assert!(term.adaptive().is_none() && term.stored().is_none());
    let of = term.capabilities();
    assert!(of.choices.is_none() && of.stored.is_none() && of.viscous.is_none());
    assert!(of.initial_stiffness.is_none() && of.elementwise.is_none());
    assert!(of.sampled.is_none() && of.audited.is_none());
}

#[test]
fn what_is_stored_is_the_same_after_it_was_loaded() {
    let mut fresh = specimens().into_iter();
    for_all(&mut begun(), 16, |of| {
        let mut other = fresh.next().unwrap();
        of.look();
        let Some(stored) = of.term.stored() else {
            assert!(of.term.capabilities().stored.is_none());
            return false;
        };
        stored.accept(&of.moved).unwrap();
        let mut first = Archive::default();
        stored.save(&mut first);
        let load = other.term.stored().unwrap();
        load.load(&first).unwrap();
        let mut second = Archive::default();
        other.term.capabilities().stored.unwrap().save(&mut second);
        assert!(first == second, "{}", of.name);
        let nothing = Archive::default();
        let refused = other.term.stored().unwrap().load(&nothing).is_err();
        assert_eq!(refused, !first.arrays.is_empty(), "{}", of.name);
        true
    });
}

#[test]
fn nothing_changes_where_a_state_is_looked_at_again() {
    for_all(&mut begun(), 12, |of| {
        of.look();
        let before = of.respond(&of.moved);
        let Some(adaptive) = of.term.adaptive() else {
            return false;
        };
        let more = adaptive.prepare(&of.moved, Order::Tangent).unwrap();
        assert!(!more, "{}: its pattern changed", of.name);
        adaptive.aid(Aid::Usual);
        assert!(!adaptive.aid(Aid::Usual), "{}", of.name);
        let again = of.respond(&of.moved);
        assert!(again.is_near(&before), "{}", of.name);
        true
    });
}

#[test]
fn choices_are_settled_where_a_state_is_judged_again() {
    let mut unsettled = 0;
    for_all(&mut begun(), 10, |of| {
        if of.term.capabilities().choices.is_none() {
            return false;
        }
        unsettled += usize::from(of.look() != Verdict::Settled);
        assert_eq!(of.look(), Verdict::Settled, "{}", of.name);
        true
    });
    assert!(unsettled > 5);
}

#[test]
fn choices_go_back_to_those_at_the_start_of_the_increment() {
    for_all(&mut begun(), 10, |of| {
        let Some(choices) = of.term.capabilities().choices else {
            return false;
        };
        let before = choices.nactive();
        of.look();
        let choices = of.term.adaptive().unwrap().choices().unwrap();
        choices.reject();
        assert_eq!(choices.nactive(), before, "{}", of.name);
        true
    });
}

#[test]
fn choices_allow_a_step_of_no_length() {
    for_all(&mut begun(), 10, |of| {
        of.look();
        let Some(choices) = of.term.capabilities().choices else {
            return false;
        };
        let step = choices.max_step(&of.moved, &vec![0.0; of.ndof]);
        assert_eq!(step, 1.0, "{}", of.name);
        true
    });
}

#[test]
fn viscous_forces_follow_their_strength() {
    for_all(&mut begun(), 2, |of| {
        let own = of.respond(&of.moved);
        let forces_at = |strength: f64, of: &mut Specimen| {
            let obeys = of.term.adaptive()?.viscous()?.damp(strength, &[]);
            of.term.begin(&phase(), &of.start).unwrap();
            Some((obeys, of.respond(&of.moved)))
        };
        let Some((obeys, strong)) = forces_at(2.0, of) else {
            assert!(of.term.capabilities().viscous.is_none());
            return false;
        };
        if obeys {
            let (_, weak) = forces_at(1.0, of).unwrap();
            let pairs = strong.force.iter().zip(&weak.force);
            assert!(pairs.clone().all(|(a, b)| *a == 2.0 * b));
            assert!(pairs.clone().any(|(a, _)| *a != 0.0));
            of.term.stored().unwrap().accept(&of.moved).unwrap();
            assert!(of.term.capabilities().viscous.unwrap().work() > 0.0);
            let (_, none) = forces_at(0.0, of).unwrap();
            assert!(none.force.iter().chain(&none.stiffness).all(|f| *f == 0.0));
        } else {
            // it has a strength of its own
            assert!(strong == own && forces_at(0.0, of).unwrap().1 == own);
        }
        true
    });
}

#[test]
fn the_initial_stiffness_is_that_of_the_undeformed_state_whatever_has_happened() {
    let mut known = 0;
    for_all(&mut begun(), 4, |of| {
        let initial = |of: &Specimen| {
            let initial = of.term.capabilities().initial_stiffness?;
            let mut taken = Taken::new(of.ndof);
            let mut work = Work::default();
            for chunk in 0..of.term.nchunk() {
                initial.add_initial(chunk, &mut work, &mut taken).unwrap();
            }
            Some((initial.id(), taken.stiffness))
        };
        let Some((id, stiffness)) = initial(of) else {
            return false;
        };
        let is_initial = |of: &Specimen, state: &State| {
            let initial = of.term.capabilities().initial_stiffness.unwrap();
            initial.is_initial(state)
        };
        assert!(stiffness.iter().any(|k| *k != 0.0));
        assert!(of.respond(&of.start).stiffness == stiffness, "{}", of.name);
        known += usize::from(is_initial(of, &of.start));
        assert!(!is_initial(of, &of.moved), "{}", of.name);
        let accepted = of.term.stored().unwrap().accept(&of.moved);
        accepted.unwrap();
        assert!(initial(of) == Some((id, stiffness)), "{}", of.name);
        true
    });
    assert_eq!(known, 1);
}

#[test]
fn elements_are_added_in_the_order_in_which_they_are_named() {
    for_all(&mut begun(), 2, |of| {
        let Some(elementwise) = of.term.capabilities().elementwise else {
            return false;
        };
        let mut named: Vec<Vec<Dof>> = Vec::new();
        for chunk in 0..of.term.nchunk() {
            elementwise.elements(chunk, &mut |nodes| {
                named.push(
                    nodes
                        .iter()
                        .flat_map(|n| (0..3).map(move |c| 3 * n + c))
                        .collect(),
                );
            });
        }
        assert_eq!(of.respond(&of.moved).dofs, named, "{}", of.name);
        true
    });
}

#[test]
fn the_cells_that_are_asked_for_are_sampled_and_no_others() {
    for_all(&mut begun(), 4, |of| {
        let Some(sampled) = of.term.capabilities().sampled else {
            return false;
        };
        let mut none = Samples::default();
        sampled.sample(&of.moved, &[], &mut none).unwrap();
        let mut all = Samples::default();
        sampled.sample(&of.moved, &of.cells, &mut all).unwrap();
        for &cell in &of.cells {
            assert!(none.of(cell).is_none());
            let (rule, points) = all.of(cell).unwrap();
            assert_eq!(rule.npoint(), points.len(), "{}", of.name);
            assert!(
                points
                    .iter()
                    .all(|point| point.volume > 0.0 && point.energy > 0.0)
            );
        }
        true
    });
}

#[test]
fn contacts_know_the_nodes_of_their_multipliers_and_no_others() {
    let mut nmultiplier = 0;
    for_all(&mut begun(), 10, |of| {
        let Some(audited) = of.term.capabilities().audited else {
            return false;
        };
        nmultiplier += of.nmultiplier;
        for multiplier in 0..of.nmultiplier {
            let node = audited.node_of(multiplier).unwrap();
            assert!((node as usize) < of.start.x.len(), "{}", of.name);
        }
        assert_eq!(audited.node_of(of.nmultiplier), None, "{}", of.name);
        true
    });
    assert!(nmultiplier > 0);
}
