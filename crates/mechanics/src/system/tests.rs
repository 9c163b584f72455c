//! Nodes that follow rigid bodies: forces, tangents, threads and turns, measured.

use super::*;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::{Mat3, Vec3};
use signorini_linear::apply;
use signorini_linear::sparsity::BlockPattern;
use signorini_ranks::{Ranks, on_threads};

/// Numbers in [-1, 1] that look random and are the same in every run.
fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898 + 4.1414).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// Springs between nodes, `W = ¼ k (l² − l0²)²`: stiff, nonlinear, and blind to rigid motion.
struct Springs {
    part: Part,
    layout: Layout,
    ends: Vec<[NodeId; 2]>,
    rest: Vec<f64>,
    /// Whether the assembler is given which nodes they have.
    is_told: bool,
    /// Chunks that cannot be evaluated.
    broken: Vec<usize>,
}

/// Springs of one chunk.
const CHUNK: usize = 2;

impl Springs {
    fn new(part: Part, layout: Layout, reference: &[Vec3], ends: Vec<[NodeId; 2]>) -> Self {
        let length = |&[a, b]: &[NodeId; 2]| (reference[b as usize] - reference[a as usize]).norm();
        let rest = ends.iter().map(|e| 0.9 * length(e)).collect();
        Self {
            part,
            layout,
            ends,
            rest,
            is_told: true,
            broken: Vec::new(),
        }
    }

    fn can_evaluate(&self, chunk: usize) -> Result<(), TermError> {
        let what = format!("chunk {chunk}");
        match self.broken.contains(&chunk) {
            true => Err(TermError::NotFinite { what }),
            false => Ok(()),
        }
    }

    fn of(&self, chunk: usize) -> impl Iterator<Item = (&[NodeId; 2], f64)> {
        let springs = self.ends.iter().zip(self.rest.iter().copied());
        springs.skip(chunk * CHUNK).take(CHUNK)
    }

    fn dofs(&self, ends: &[NodeId; 2]) -> Vec<Dof> {
        let axes = 0..self.layout.ndim();
        let of = |&n: &NodeId| axes.clone().map(move |c| self.layout.node(n, c));
        ends.iter().flat_map(of).collect()
    }
}

impl Term for Springs {
    fn name(&self) -> &str {
        "springs"
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for ends in &self.ends {
            match self.part {
                Part::Bulk => out.bulk(ends),
                Part::Interface => out.interface(&self.dofs(ends)),
            }
        }
    }

    fn properties(&self) -> Properties {
        Properties::new(Symmetry::Symmetric, self.part)
    }

    fn begin(&mut self, _: &Phase, _: &State) -> Result<(), TermError> {
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.ends.len().div_ceil(CHUNK)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let n = self.layout.ndim();
        self.can_evaluate(chunk)?;
        for (ends, rest) in self.of(chunk) {
            let d = trial.x[ends[1] as usize] - trial.x[ends[0] as usize];
            let stretch = d.norm_squared() - rest * rest;
            let sign = |i: usize| if i < n { -1.0 } else { 1.0 };
            let force: Vec<f64> = (0..2 * n).map(|i| sign(i) * stretch * d[i % n]).collect();
            let mut stiffness = Vec::new();
            if order == Order::Tangent {
                for i in 0..2 * n {
                    for j in 0..2 * n {
                        let same = if i % n == j % n { stretch } else { 0.0 };
                        stiffness.push(sign(i) * sign(j) * (same + 2.0 * d[i % n] * d[j % n]));
                    }
                }
            }
            out.add(&self.dofs(ends), &force, &stiffness);
        }
        Ok(())
    }

    fn energy(&self, chunk: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        self.can_evaluate(chunk)?;
        let of = |(ends, rest): (&[NodeId; 2], f64)| {
            let d = trial.x[ends[1] as usize] - trial.x[ends[0] as usize];
            let stretch = d.norm_squared() - rest * rest;
            0.25 * stretch * stretch
        };
        Ok(Some(self.of(chunk).map(of).sum()))
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            elementwise: Some(self),
            ..Capabilities::default()
        }
    }
}

impl Elementwise for Springs {
    fn elements(&self, chunk: usize, take: &mut dyn FnMut(&[NodeId])) {
        self.of(chunk)
            .filter(|_| self.is_told)
            .for_each(|(ends, _)| take(ends));
    }
}

/// Two rigid bodies and loose nodes, everything tied to everything by springs.
struct Scene {
    layout: Layout,
    reference: Vec<Vec3>,
    elimination: Elimination,
    terms: Vec<Box<dyn Term>>,
    state: State,
}

impl Scene {
    fn new(ndim: usize, part: Part, nnode: usize) -> Self {
        let layout = Layout::new(ndim, nnode, 2);
        let flat = |x: Vec3| {
            if ndim == 2 {
                Vec3::new(x.x, x.y, 0.0)
            } else {
                x
            }
        };
        let at = |k: usize| flat(Vec3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2)));
        let reference: Vec<Vec3> = (0..nnode).map(at).collect();
        // every fourth node belongs to the first body, the one after it to the second
        let nodes = |first: u32| (first..nnode as u32).step_by(4).collect();
        let body = |k: u32| RigidBody {
            reference: at(1000 + k as usize) * 0.5,
            nodes: nodes(k),
        };
        let elimination = Elimination::new(vec![body(0), body(1)], nnode);
        let n = nnode as NodeId;
        // neighbours, and springs within a body, between bodies, between loose nodes
        let ends: Vec<[NodeId; 2]> = (0..n)
            .flat_map(|a| [1, 2, 4].map(|step| [a, (a + step) % n]))
            .filter(|[a, b]| a != b)
            .collect();
        let springs = Springs::new(part, layout, &reference, ends);
        let mut scene = Self {
            state: State::initial(&layout, &reference, &elimination),
            layout,
            reference,
            elimination,
            terms: vec![Box::new(springs)],
        };
        // far from the start, by turns that do not commute
        for round in 0..2 {
            let du: Vec<f64> = (0..layout.ndof())
                .map(|k| match layout.name(k as Dof).map(DofName::parts) {
                    Some((FieldId::ROTATION, _, _)) => noise(7000 + 97 * round + k),
                    _ => 0.2 * noise(5000 + 89 * round + k),
                })
                .collect();
            scene.state = scene.moved(&du, 1.0);
        }
        scene
    }

    fn moved(&self, du: &[f64], by: f64) -> State {
        let mut state = self.state.clone();
        let (layout, x, e) = (&self.layout, &self.reference, &self.elimination);
        state.advance_from(&self.state, du, by, layout, x, e);
        state
    }

    fn assemble(&self, state: &State, order: Order) -> (Assembler, Assembly) {
        let mut assembler = Assembler::new(&self.layout, &self.elimination, &self.terms);
        let mut out = Assembly::default();
        let (layout, e, terms) = (&self.layout, &self.elimination, &self.terms);
        assembler
            .assemble(layout, e, terms, state, order, &mut out)
            .unwrap();
        (assembler, out)
    }

    fn energy(&self, state: &State) -> f64 {
        let mut assembler = Assembler::new(&self.layout, &self.elimination, &self.terms);
        assembler.energy(&self.terms, state).unwrap().unwrap()
    }

    /// The tangent times a direction.
    fn along(&self, state: &State, direction: &[f64]) -> Vec<f64> {
        let (assembler, out) = self.assemble(state, Order::Tangent);
        let mut along = vec![0.0; direction.len()];
        let (bulk, interface) = (assembler.bulk(), assembler.interface());
        apply(bulk, interface, &out.values(), direction, &mut along);
        along
    }

    fn independent(&self) -> impl Iterator<Item = Dof> {
        let depends = |d: &Dof| self.elimination.depends(*d, &self.layout);
        (0..self.layout.ndof() as Dof).filter(move |d| !depends(d))
    }
}

const PARTS: [Part; 2] = [Part::Bulk, Part::Interface];

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, v| m.max(v.abs()))
}

#[test]
fn forces_and_tangents_on_rigid_bodies_match_differences() {
    for (ndim, is_small) in [(2, false), (2, true), (3, false), (3, true)] {
        for part in PARTS {
            let mut scene = Scene::new(ndim, part, 12);
            let n = scene.layout.ndof();
            scene.state.is_small = is_small;
            scene.state = scene.moved(&vec![0.0; n], 0.0);
            let (_, here) = scene.assemble(&scene.state, Order::Residual);
            let force = largest(here.residual.iter().copied());
            let mut turned = 0;
            let h = 1e-3;
            for dof in scene.independent() {
                let mut e = vec![0.0; n];
                e[dof as usize] = 1.0;
                let column = scene.along(&scene.state, &e);
                let stiffness = largest(column.iter().copied());
                let (mut slope, mut change) = (0.0, vec![0.0; n]);
                for (step, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
                    let there = scene.moved(&e, step * h);
                    slope += weight * scene.energy(&there) / (12.0 * h);
                    let (_, out) = scene.assemble(&there, Order::Residual);
                    for (c, r) in change.iter_mut().zip(&out.residual) {
                        *c += weight * r / (12.0 * h);
                    }
                }
                let first = (slope - here.residual[dof as usize]).abs();
                assert!(first < 1e-7 * force, "{ndim} {dof}: {first:e} of {force}");
                let second = largest(column.iter().zip(&change).map(|(k, c)| k - c));
                assert!(second < 1e-7 * stiffness, "{ndim} {dof}: {second:e}");
                let name = scene.layout.name(dof);
                turned += usize::from(name.and_then(DofName::rotation).is_some());
            }
            assert_eq!(turned, if ndim == 3 { 6 } else { 2 });
        }
    }
}

#[test]
fn dependent_unknowns_have_neither_force_nor_stiffness() {
    for part in PARTS {
        let scene = Scene::new(3, part, 12);
        let (assembler, out) = scene.assemble(&scene.state, Order::Tangent);
        let n = scene.layout.ndof();
        let mut dependent = 0;
        for dof in 0..n as Dof {
            if !scene.elimination.depends(dof, &scene.layout) {
                continue;
            }
            dependent += 1;
            let d = dof as usize;
            assert_eq!((out.residual[d], out.magnitude[d]), (0.0, 0.0));
            let mut e = vec![0.0; n];
            e[d] = 1.0;
            let (bulk, interface, values) = (assembler.bulk(), assembler.interface(), out.values());
            let mut column = vec![0.0; n];
            apply(bulk, interface, &values, &e, &mut column);
            assert!(column.iter().all(|k| *k == 0.0));
            e.iter_mut().enumerate().for_each(|(k, v)| *v = noise(k));
            let mut row = vec![0.0; n];
            apply(bulk, interface, &values, &e, &mut row);
            assert_eq!(row[d], 0.0);
        }
        assert_eq!(dependent, 3 * 6);
        // their own increments are not listened to: the pose alone says where they are
        let mut du = vec![0.0; n];
        du[0] = 3.0;
        assert_eq!(scene.moved(&du, 1.0), scene.state);
    }
}

/// A body whose motion is prescribed stays in the operator: the response of all others to it, and the reaction on it.
#[test]
fn a_prescribed_motion_acts_through_the_operator_and_reactions_come_with_it() {
    for ndim in [2, 3] {
        let scene = Scene::new(ndim, Part::Bulk, 16);
        let n = scene.layout.ndof();
        let mut du = vec![0.0; n];
        for c in 0..3 {
            for (dof, by) in [
                (scene.layout.translation(0, c), 0.3),
                (scene.layout.rotation(0, c), 0.8),
            ] {
                if dof != NO_DOF {
                    du[dof as usize] = by * noise(c + 11);
                }
            }
        }
        let along = scene.along(&scene.state, &du);
        let h = 1e-3;
        let mut change = vec![0.0; n];
        for (step, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
            let there = scene.moved(&du, step * h);
            let (_, out) = scene.assemble(&there, Order::Residual);
            for (c, r) in change.iter_mut().zip(&out.residual) {
                *c += weight * r / (12.0 * h);
            }
        }
        let error = largest(along.iter().zip(&change).map(|(a, c)| a - c));
        assert!(error < 1e-7 * largest(along.iter().copied()), "{error:e}");

        // springs are internal: forces, and moments about the origin, of bodies and loose nodes cancel
        let (_, out) = scene.assemble(&scene.state, Order::Residual);
        let read = |of: &dyn Fn(usize) -> Dof| {
            let mut v = Vec3::ZERO;
            for c in 0..3 {
                if of(c) != NO_DOF {
                    v[c] = out.residual[of(c) as usize];
                }
            }
            v
        };
        let (mut force, mut moment) = (Vec3::ZERO, Vec3::ZERO);
        for node in 0..scene.layout.nnode() as NodeId {
            let f = read(&|c| scene.layout.node(node, c));
            force += f;
            moment += scene.state.x[node as usize].cross(f);
        }
        for body in 0..2 as RigidId {
            let f = read(&|c| scene.layout.translation(body, c));
            force += f;
            moment += read(&|c| scene.layout.rotation(body, c));
            moment += scene.state.poses[body as usize].origin.cross(f);
        }
        let size = largest(out.magnitude.iter().copied());
        assert!(force.max_abs() < 1e-13 * size, "{force:?}");
        if ndim == 2 {
            moment = Vec3::new(0.0, 0.0, moment.z);
        }
        assert!(moment.max_abs() < 1e-13 * size, "{moment:?}");
    }
}

/// The part of the tangent that is not symmetric is half the moment on the body, turned into a matrix: it vanishes
/// where a body that turns freely is in equilibrium, and nowhere else.
#[test]
fn the_tangent_is_symmetric_but_for_the_moments_on_the_bodies() {
    let scene = Scene::new(3, Part::Bulk, 12);
    let (_, out) = scene.assemble(&scene.state, Order::Residual);
    let n = scene.layout.ndof();
    let columns: Vec<Vec<f64>> = (0..n)
        .map(|d| {
            let mut e = vec![0.0; n];
            e[d] = 1.0;
            scene.along(&scene.state, &e)
        })
        .collect();
    let mut expected = vec![vec![0.0; n]; n];
    let mut size = 0.0f64;
    for body in 0..2 {
        let dof = |c| scene.layout.rotation(body, c) as usize;
        let moment = Vec3::new(
            out.residual[dof(0)],
            out.residual[dof(1)],
            out.residual[dof(2)],
        );
        size = size.max(moment.norm());
        let turn = Mat3::skew(moment);
        for i in 0..3 {
            for j in 0..3 {
                // [f]×[a]× − [a]×[f]× = [f × a]×, and the moment is a × f
                expected[dof(i)][dof(j)] = -turn.rows[i][j];
            }
        }
    }
    assert!(size > 0.1);
    for i in 0..n {
        for j in 0..n {
            let odd = columns[j][i] - columns[i][j];
            assert!((odd - expected[i][j]).abs() < 1e-12, "({i}, {j}): {odd}");
        }
    }
}

#[test]
fn one_thread_and_two_threads_give_the_same_bits() {
    for part in PARTS {
        // more chunks than are evaluated at once
        let scene = Scene::new(3, part, 120);
        assert!(scene.terms[0].nchunk() > 150);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build().unwrap().install(|| {
                let (_, out) = scene.assemble(&scene.state, Order::Tangent);
                let v: Vec<f64> = (0..scene.layout.ndof()).map(noise).collect();
                let along = scene.along(&scene.state, &v);
                let values = out.values();
                let (bulk, interface) = (values.bulk.to_vec(), values.interface.to_vec());
                let energy = scene.energy(&scene.state);
                (out.residual, out.magnitude, bulk, interface, along, energy)
            })
        };
        let one = run(1);
        for threads in [2, 3] {
            assert_eq!(run(threads), one);
        }
    }
}

#[test]
fn what_threads_share_out_is_the_same_whoever_adds_it_up() {
    let (nnode, ndim) = (600, 3);
    let layout = Layout::new(ndim, nnode, 0);
    let at = |k: usize| Vec3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2));
    let reference: Vec<Vec3> = (0..nnode).map(at).collect();
    let elimination = Elimination::default();
    let state = State::initial(&layout, &reference, &elimination);
    let neighbours: Vec<[NodeId; 2]> = (1..nnode as NodeId).map(|k| [k - 1, k]).collect();
    let springs = |part, is_told, broken: &[usize]| -> Box<dyn Term> {
        let all = Springs::new(part, layout, &reference, neighbours.clone());
        Box::new(Springs {
            is_told,
            broken: broken.to_vec(),
            ..all
        })
    };
    let run = |threads: usize, told: [bool; 2], broken: &[usize]| {
        let terms = [
            springs(Part::Interface, true, &[]),
            springs(Part::Bulk, told[0], &[]),
            springs(Part::Bulk, told[1], broken),
        ];
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let mut assembler = Assembler::new(&layout, &elimination, &terms);
            let mut out = Assembly::default();
            let mut found = Vec::new();
            for order in [Order::Tangent, Order::Residual, Order::Tangent] {
                let done =
                    assembler.assemble(&layout, &elimination, &terms, &state, order, &mut out);
                found.push((done.map_err(|e| e.to_string()), out.clone()));
            }
            let nshare = assembler.shared.map_or(0, |shared| shared.shares.len());
            (found, nshare)
        })
    };
    for told in [[true, true], [true, false], [false, false]] {
        let (one, _) = run(1, told, &[]);
        for threads in [2, 3] {
            let (several, nshare) = run(threads, told, &[]);
            assert_eq!(nshare, if told[0] { threads } else { 0 });
            for ((_, a), (done, b)) in one.iter().zip(&several) {
                assert_eq!(*done, Ok(()));
                assert_eq!((&a.residual, &a.magnitude), (&b.residual, &b.magnitude));
                let [a, b] = [a, b].map(Assembly::values);
                assert_eq!((a.bulk, a.interface), (b.bulk, b.interface));
            }
        }
    }
    // of several failures the first one is reported
    for threads in [1, 2, 3] {
        let (found, _) = run(threads, [true, true], &[290, 140, 7]);
        for (done, _) in found {
            assert!(done.unwrap_err().contains("chunk 7"), "{threads}");
        }
    }
}

/// What a rank has assembled.
struct Assembled {
    done: Result<(), String>,
    out: Assembly,
    pattern: BlockPattern,
    energy: Result<Option<f64>, String>,
    /// Chunks of known elements that it has evaluated.
    nevaluated: usize,
}

/// Tangent, residual and energy with the rows of the bulk divided among ranks, or with all rows here.
fn assembled(
    (layout, elimination): (&Layout, &Elimination),
    terms: &[Box<dyn Term>],
    state: &State,
    ranks: Option<&'static dyn Ranks>,
) -> Assembled {
    let mut assembler = match ranks {
        Some(ranks) => Assembler::divided(layout, elimination, terms, ranks),
        None => Assembler::new(layout, elimination, terms),
    };
    let mut out = Assembly::default();
    let mut done = Ok(());
    for order in [Order::Residual, Order::Tangent] {
        done = done
            .and_then(|()| assembler.assemble(layout, elimination, terms, state, order, &mut out));
    }
    Assembled {
        done: done.map_err(|e| e.to_string()),
        energy: assembler.energy(terms, state).map_err(|e| e.to_string()),
        pattern: assembler.bulk().clone(),
        nevaluated: assembler.shared.map_or(0, |shared| {
            shared.shares.iter().map(|share| share.chunks.len()).sum()
        }),
        out,
    }
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_ranks() {
    let scenes = PARTS.map(|part| Scene::new(3, part, 120));
    let mut chain = Scene::new(3, Part::Bulk, 400);
    (chain.layout, chain.elimination) = (Layout::new(3, 400, 0), Elimination::default());
    let ends: Vec<[NodeId; 2]> = (1..400).map(|k| [k - 1, k]).collect();
    let springs = |part, is_told| -> Box<dyn Term> {
        let all = Springs::new(part, chain.layout, &chain.reference, ends.clone());
        Box::new(Springs { is_told, ..all })
    };
    chain.terms = vec![
        springs(Part::Interface, true),
        springs(Part::Bulk, true),
        springs(Part::Bulk, false),
    ];
    for scene in scenes.iter().chain([&chain]) {
        let of = (&scene.layout, &scene.elimination);
        let one = assembled(of, &scene.terms, &scene.state, None);
        assert_eq!(one.done, Ok(()));
        let diagonal = |node: u32| {
            let at = one.pattern.position(node, node)?;
            Some([0, 4, 8].map(|k| one.out.values().bulk[9 * at + k]))
        };
        for size in 1..=4 {
            let (all, _) = on_threads(size, |ranks| {
                assembled(of, &scene.terms, &scene.state, Some(ranks))
            });
            let blocks = all.iter().map(|rank| rank.pattern.nblock());
            assert_eq!(blocks.sum::<usize>(), one.pattern.nblock());
            if scene.layout.nnode() == 400 {
                let most = all.iter().map(|rank| rank.nevaluated).max();
                assert!(most.unwrap() <= 200 / size + 10, "{most:?} on {size}");
                let most = all.iter().map(|rank| rank.pattern.nblock()).max();
                assert!(most.unwrap() * 10 * size <= 13 * one.pattern.nblock());
            }
            for rank in all {
                assert_eq!(rank.done, Ok(()));
                assert_eq!(rank.energy, one.energy);
                assert_eq!(rank.out.residual, one.out.residual);
                assert_eq!(rank.out.magnitude, one.out.magnitude);
                assert_eq!(rank.out.uncertainty, one.out.uncertainty);
                let [own, whole] = [&rank.out, &one.out].map(Assembly::values);
                assert_eq!(own.interface, whole.interface);
                for (row, column) in (0..scene.layout.nnode() as u32)
                    .flat_map(|row| rank.pattern.columns(row).iter().map(move |&c| (row, c)))
                {
                    let blocks = [(&rank.pattern, own), (&one.pattern, whole)];
                    let [own, whole] = blocks.map(|(pattern, values)| {
                        let at = pattern.position(row, column).unwrap();
                        &values.bulk[9 * at..9 * at + 9]
                    });
                    assert_eq!(own, whole, "{row}, {column}");
                }
                // what every rank needs of the rows of others
                let of_ranks = rank.out.of_ranks.as_ref().unwrap();
                assert_eq!(of_ranks.largest, one.out.largest_of_bulk());
                for node in 0..scene.layout.nnode() {
                    let own = &of_ranks.diagonal[3 * node..3 * node + 3];
                    assert_eq!(own, diagonal(node as u32).unwrap_or_default());
                }
            }
        }
    }
}

#[test]
fn what_one_rank_cannot_evaluate_fails_on_all() {
    let mut scene = Scene::new(3, Part::Bulk, 400);
    (scene.layout, scene.elimination) = (Layout::new(3, 400, 0), Elimination::default());
    let ends: Vec<[NodeId; 2]> = (1..400).map(|k| [k - 1, k]).collect();
    let springs = Springs::new(Part::Bulk, scene.layout, &scene.reference, ends);
    let broken = vec![190, 101, 17];
    scene.terms = vec![Box::new(Springs { broken, ..springs })];
    let of = (&scene.layout, &scene.elimination);
    for size in 1..=4 {
        let (all, _) = on_threads(size, |ranks| {
            assembled(of, &scene.terms, &scene.state, Some(ranks))
        });
        for rank in all {
            assert!(rank.done.unwrap_err().contains("chunk 17"), "{size}");
            assert!(rank.energy.unwrap_err().contains("chunk 17"), "{size}");
        }
    }
}

#[test]
fn terms_may_have_more_or_fewer_chunks_in_an_increment() {
    let scene = Scene::new(3, Part::Interface, 12);
    let layout = scene.layout;
    let springs = |n: NodeId| -> Vec<Box<dyn Term>> {
        let ends = |first: NodeId| (first..n).map(|k| [k, k + 1]).collect();
        let term = |first| Springs::new(Part::Interface, layout, &scene.reference, ends(first));
        vec![Box::new(term(0)), Box::new(term(1))]
    };
    let many = springs(11);
    let mut assembler = Assembler::new(&layout, &scene.elimination, &many);
    for n in [11, 4, 7, 11] {
        let terms = springs(n);
        let residual = |assembler: &mut Assembler| {
            let mut out = Assembly::default();
            let (e, order) = (&scene.elimination, Order::Residual);
            let done = assembler.assemble(&layout, e, &terms, &scene.state, order, &mut out);
            done.unwrap();
            out.residual
        };
        assembler.begin_increment(&terms);
        let mut fresh = Assembler::new(&layout, &scene.elimination, &terms);
        let wanted = residual(&mut fresh);
        assert!(wanted.iter().any(|r| r.abs() > 0.1));
        assert_eq!(residual(&mut assembler), wanted, "{n}");
    }
}

/// `u = u_c + θ × a`, with the arm of the start, however far it goes.
#[test]
fn nodes_follow_small_rotations_by_their_vector_times_the_arm() {
    for ndim in [2, 3] {
        let mut scene = Scene::new(ndim, Part::Bulk, 12);
        let n = scene.layout.ndof();
        scene.state.is_small = true;
        let start = scene.moved(&vec![0.0; n], 0.0);
        let mut du = vec![0.0; n];
        let mut theta = Vec3::ZERO;
        for c in 0..3 {
            let dof = scene.layout.rotation(0, c);
            if dof != NO_DOF {
                theta[c] = noise(c + 3);
                du[dof as usize] = theta[c];
            }
        }
        let body = scene.elimination.bodies()[0].clone();
        let once = scene.moved(&du, 1.0);
        let thrice = scene.moved(&du, 3.0);
        for &node in &body.nodes {
            let k = node as usize;
            let wanted = theta.cross(scene.reference[k] - body.reference);
            let moved = [&once, &thrice].map(|state| state.x[k] - start.x[k]);
            assert!(
                (moved[0] - wanted).max_abs() < 1e-14,
                "{moved:?} {wanted:?}"
            );
            assert!((moved[1] - wanted * 3.0).max_abs() < 1e-13, "{moved:?}");
        }
    }
}

#[test]
fn three_full_turns_bring_the_nodes_back() {
    for (ndim, axis) in [
        (2, Vec3::unit(2)),
        (3, Vec3::unit(1)),
        (3, Vec3::new(0.48, 0.6, 0.64)),
    ] {
        let mut scene = Scene::new(ndim, Part::Bulk, 12);
        let start = scene.state.clone();
        let steps = 300;
        let mut du = vec![0.0; scene.layout.ndof()];
        for c in 0..3 {
            let dof = scene.layout.rotation(0, c);
            if dof != NO_DOF {
                du[dof as usize] = axis[c] * 3.0 * std::f64::consts::TAU / f64::from(steps);
            }
        }
        let mut farthest = 0.0f64;
        for _ in 0..steps {
            scene.state = scene.moved(&du, 1.0);
            farthest = farthest.max((scene.state.x[0] - start.x[0]).norm());
        }
        assert!(farthest > 0.5, "the body turns");
        for (x, x0) in scene.state.x.iter().zip(&start.x) {
            assert!((*x - *x0).norm() < 1e-10);
        }
        let turned = scene.state.poses[0].rotation;
        let identity = turned * turned.transpose() - Mat3::IDENTITY;
        assert!(largest(identity.rows.iter().map(|r| r.max_abs())) < 1e-12);
        // a body keeps its shape, too
        let of = |state: &State, a: usize, b: usize| (state.x[a] - state.x[b]).norm();
        assert!((of(&scene.state, 0, 8) - of(&start, 0, 8)).abs() < 1e-12);
        assert_eq!(scene.elimination.body_of(8), Some(0));
    }
}
