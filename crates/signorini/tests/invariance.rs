//! What must not matter: units, place, orientation, handedness, numbering, the dimension a plane problem is put in, how
//! a side is named.
//!
//! SOURCE      None needed: every model is compared with itself.
//! GOAL        Metamorphic: a change that means nothing changes nothing, in numbers or in iterations.
//! MESH        Two blocks without common nodes: 9 and 4 hex8, or 6 and 4 quad4, faces of different size.
//! CONDITIONS  Base held, head pressed down and moved aside, neo-Hookean, automatic penalty.
//! EXPECTED    The same displacements, forces and iterations, transformed.
//! TOLERANCE   1e-9 or better of the largest value: increments are iterated to 1e-10 of the mean force.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Run, model, run};
use signorini::setup::Model;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::fmt::Write;

/// Two blocks, written out as a case.
#[derive(Clone)]
struct Blocks {
    ndim: usize,
    nodes: Vec<(u32, Vec3)>,
    elements: Vec<Cell>,
    base: Vec<u32>,
    head: Vec<u32>,
    foot: Vec<u32>,
    top: Vec<u32>,
    /// Displacement of the head at the end of each step.
    motions: Vec<Vec3>,
    material: String,
    /// Young's moduli of the two blocks.
    young: [f64; 2],
    thickness: f64,
    enforcement: String,
    /// More keys of the contact.
    contact: &'static str,
    /// The secondary side as a set.
    secondary: String,
    /// Nodes that do not move along z.
    flat: Vec<u32>,
    geometry: &'static str,
}

#[derive(Clone)]
struct Cell {
    label: u32,
    group: &'static str,
    nodes: Vec<u32>,
}

/// Distance of the blocks at the start: at zero, rounding would decide which nodes begin in contact.
const GAP: f64 = 0.004;

/// Nodes and cells of a box, appended; the labels of the nodes by place, x first.
fn grid(blocks: &mut Blocks, group: &'static str, n: [u32; 3], from: Vec3, size: Vec3) -> Vec<u32> {
    let first = blocks.nodes.len() as u32 + 1;
    let n = if blocks.ndim == 2 { [n[0], n[1], 0] } else { n };
    let [nx, ny, nz] = n;
    for k in 0..(nx + 1) * (ny + 1) * (nz + 1) {
        let (i, j, l) = (
            k % (nx + 1),
            k / (nx + 1) % (ny + 1),
            k / (nx + 1) / (ny + 1),
        );
        let part = |i: u32, n: u32| f64::from(i) / f64::from(n.max(1));
        let x = Vec3::new(
            from.x + size.x * part(i, nx),
            from.y + size.y * part(j, ny),
            from.z + size.z * part(l, nz),
        );
        blocks.nodes.push((first + k, x));
    }
    let (row, layer) = (nx + 1, (nx + 1) * (ny + 1));
    for k in 0..nx * ny * nz.max(1) {
        let a = first + k % nx + k / nx % ny * row + k / nx / ny * layer;
        let quad = [a, a + 1, a + row + 1, a + row];
        let mut nodes = quad.to_vec();
        if blocks.ndim == 3 {
            nodes.extend(quad.map(|n| n + layer));
        }
        let label = blocks.elements.len() as u32 + 1;
        let cell = Cell {
            label,
            group,
            nodes,
        };
        blocks.elements.push(cell);
    }
    (first..=blocks.nodes.len() as u32).collect()
}

impl Blocks {
    /// Two blocks one above the other, with so many cells each, the upper one shifted by `aside`.
    fn new(ndim: usize, lower: ([u32; 3], Vec3), upper: ([u32; 3], Vec3), aside: Vec3) -> Self {
        let mut blocks = Self {
            ndim,
            nodes: Vec::new(),
            elements: Vec::new(),
            base: Vec::new(),
            head: Vec::new(),
            foot: Vec::new(),
            top: Vec::new(),
            motions: Vec::new(),
            material: "neo-hookean".into(),
            young: [1000.0, 2000.0],
            thickness: 1.0,
            enforcement: "\"auto\"".into(),
            contact: "method = \"node-to-segment\"",
            secondary: String::new(),
            flat: Vec::new(),
            geometry: "nonlinear",
        };
        let up = ndim - 1;
        let height = lower.1[up];
        let mut place = aside;
        place[up] += height;
        let of_lower = grid(&mut blocks, "lower", lower.0, Vec3::ZERO, lower.1);
        let of_upper = grid(&mut blocks, "upper", upper.0, place, upper.1);
        let at = |blocks: &Self, labels: &[u32], level: f64| {
            let on = |&&l: &&u32| (blocks.position(l)[up] - level).abs() < 1e-9;
            labels.iter().filter(on).copied().collect::<Vec<_>>()
        };
        blocks.base = at(&blocks, &of_lower, 0.0);
        blocks.top = at(&blocks, &of_lower, height);
        blocks.foot = at(&blocks, &of_upper, place[up]);
        blocks.head = at(&blocks, &of_upper, place[up] + upper.1[up]);
        blocks
    }

    fn position(&self, label: u32) -> Vec3 {
        self.nodes.iter().find(|n| n.0 == label).unwrap().1
    }

    /// The foot as a set of faces.
    fn faces_of_foot(&self) -> String {
        let up = self.ndim - 1;
        let side = if up == 1 { "-y" } else { "-z" };
        let touches =
            |c: &&Cell| c.group == "upper" && c.nodes.iter().any(|n| self.foot.contains(n));
        let cells = self.elements.iter().filter(touches);
        let faces: Vec<String> = cells.map(|c| format!("[{}, {side:?}]", c.label)).collect();
        format!("faces = [{}]", faces.join(", "))
    }

    /// In space: pressed, then moved aside across edges.
    fn space() -> Self {
        let (low, high) = (Vec3::new(3.0, 3.0, 1.5), Vec3::new(1.3, 1.1, 0.8));
        let aside = Vec3::new(0.73, 0.61, GAP);
        let mut blocks = Self::new(3, ([3, 3, 1], low), ([2, 2, 1], high), aside);
        blocks.motions = vec![Vec3::new(0.0, 0.0, -0.06), Vec3::new(0.3, 0.2, -0.06)];
        blocks
    }

    /// In the plane: the same.
    fn plane() -> Self {
        let (low, high) = (Vec3::new(3.0, 1.5, 0.0), Vec3::new(1.3, 0.8, 0.0));
        let aside = Vec3::new(0.73, GAP, 0.0);
        let mut blocks = Self::new(2, ([3, 2, 0], low), ([2, 2, 0], high), aside);
        blocks.motions = vec![Vec3::new(0.0, -0.06, 0.0), Vec3::new(0.3, -0.06, 0.0)];
        blocks
    }

    /// Every position and every motion moved by a linear map and a shift.
    fn mapped(&self, map: Mat3, shift: Vec3) -> Self {
        let mut mapped = self.clone();
        for (_, x) in &mut mapped.nodes {
            *x = map * *x + shift;
        }
        for motion in &mut mapped.motions {
            *motion = map * *motion;
        }
        mapped
    }

    fn text(&self) -> String {
        let mut text = String::from("format = 1\n[mesh]\nnodes = [\n");
        for (label, x) in &self.nodes {
            let x = x.to_array();
            writeln!(text, "[{label}, {}],", listed(&x[..self.ndim])).unwrap();
        }
        text.push_str("]\nelements = [\n");
        for cell in &self.elements {
            let element = if self.ndim == 3 { "hex8" } else { "quad4" };
            let (id, group, nodes) = (cell.label, cell.group, listed(&cell.nodes));
            writeln!(
                text,
                "{{ id = {id}, type = \"{element}\", group = \"{group}\", nodes = [{nodes}] }},"
            )
            .unwrap();
        }
        let foot = match &self.secondary[..] {
            "" => format!("nodes = [{}]", listed(&self.foot)),
            other => other.to_string(),
        };
        write!(
            text,
            "]\n[sets]\nbase = {{ nodes = [{}] }}\nhead = {{ nodes = [{}] }}\ntop = {{ nodes = [{}] }}\nfoot = {{ {foot} }}\n",
            listed(&self.base),
            listed(&self.head),
            listed(&self.top),
        )
        .unwrap();
        if !self.flat.is_empty() {
            writeln!(text, "flat = {{ nodes = [{}] }}", listed(&self.flat)).unwrap();
        }
        if self.ndim == 2 {
            let thickness = self.thickness;
            writeln!(
                text,
                "[model]\nspace = \"plane-strain\"\nthickness = {thickness:?}"
            )
            .unwrap();
        }
        for (group, young) in ["lower", "upper"].iter().zip(self.young) {
            let law = &self.material;
            let nu = if law == "linear-elastic" { 0.0 } else { 0.3 };
            write!(
                text,
                "[material.{group}]\nmodel = \"{law}\"\nE = {young:?}\nnu = {nu:?}\n\
                 [[body]]\ngroup = \"{group}\"\nmaterial = \"{group}\"\n"
            )
            .unwrap();
        }
        write!(
            text,
            "[[contact]]\nname = \"blocks\"\nsecondary = \"foot\"\nprimary = \"top\"\nenforcement = {}\n{}\n",
            self.enforcement, self.contact
        )
        .unwrap();
        for (number, motion) in self.motions.iter().enumerate() {
            let geometry = self.geometry;
            write!(
                text,
                "[[step]]\nname = \"step {number}\"\ngeometry = \"{geometry}\"\nincrements = {{ fixed = 3 }}\n"
            )
            .unwrap();
            if number == 0 {
                text.push_str("[[step.fix]]\non = \"base\"\nu = \"all\"\n");
                if !self.flat.is_empty() {
                    text.push_str("[[step.fix]]\non = \"flat\"\nu = [\"z\"]\n");
                }
            }
            text.push_str("[[step.move]]\non = \"head\"\n");
            let naxis = if self.flat.is_empty() { self.ndim } else { 2 };
            for (axis, value) in ["ux", "uy", "uz"].iter().zip(motion.to_array()).take(naxis) {
                writeln!(text, "{axis} = {value:?}").unwrap();
            }
        }
        text.push_str("[solver]\nnewton = { force_tol = 1e-10 }\n");
        text
    }

    fn model(&self) -> Model {
        model("blocks", &self.text(), &[])
    }

    fn solve(&self) -> Outcome {
        let mut model = self.model();
        let result = run(&mut model);
        assert!(result.error.is_none(), "{:?}", result.error);
        assert!(result.cutbacks.is_empty(), "{:?}", result.cutbacks);
        assert_eq!(result.frames.len(), 3 * self.motions.len());
        for frame in &result.frames {
            assert!(frame.contacts[0].nclosed() > 0);
        }
        Outcome { model, run: result }
    }
}

fn listed<T: std::fmt::Debug>(values: &[T]) -> String {
    let texts: Vec<String> = values.iter().map(|v| format!("{v:?}")).collect();
    texts.join(", ")
}

struct Outcome {
    model: Model,
    run: Run,
}

impl Outcome {
    fn iterations(&self) -> Vec<usize> {
        self.run.increments.iter().map(|i| i.iterations).collect()
    }

    /// Displacements, in the order of these labels.
    fn displacements(&self, increment: usize, labels: &[u32]) -> Vec<Vec3> {
        let u = &self.run.frames[increment].displacement;
        self.nodes(labels).map(|n| u[n]).collect()
    }

    fn reaction(&self, increment: usize, labels: &[u32]) -> Vec3 {
        let f = &self.run.frames[increment].reaction_force;
        self.nodes(labels).map(|n| f[n]).sum()
    }

    fn nodes(&self, labels: &[u32]) -> impl Iterator<Item = usize> {
        let node = |&l: &u32| self.model.node(u64::from(l)).unwrap() as usize;
        labels.iter().map(node)
    }
}

/// The largest distance over the largest vector.
fn distance(got: &[Vec3], expected: &[Vec3]) -> f64 {
    assert_eq!(got.len(), expected.len());
    let largest = |v: &mut dyn Iterator<Item = Vec3>| v.map(Vec3::norm).fold(0.0, f64::max);
    let differences = &mut got.iter().zip(expected).map(|(a, b)| *a - *b);
    largest(differences) / largest(&mut expected.iter().copied())
}

/// Asserts that `other` is `one`, displacements through `map` and forces too, times `force`.
fn assert_same(
    one: (&Blocks, &Outcome),
    other: (&Blocks, &Outcome),
    map: Mat3,
    force: f64,
    tolerance: f64,
) {
    assert_eq!(one.1.iterations(), other.1.iterations());
    let labels = |blocks: &Blocks| blocks.nodes.iter().map(|n| n.0).collect::<Vec<_>>();
    let labels = labels(one.0);
    for k in 0..one.1.run.frames.len() {
        let expected: Vec<Vec3> = one.1.displacements(k, &labels);
        let expected: Vec<Vec3> = expected.into_iter().map(|u| map * u).collect();
        let error = distance(&other.1.displacements(k, &labels), &expected);
        assert!(
            error < tolerance,
            "displacements of increment {k}: {error:e}"
        );
        // forces turn as displacements do, and scale in their own way
        let size = map.determinant().abs().cbrt();
        let turned = |f: Vec3| map * f * (force / size);
        let contact = |o: &Outcome| o.run.frames[k].contacts[0].secondary.force;
        let pairs = [
            (contact(one.1), contact(other.1)),
            (
                one.1.reaction(k, &one.0.base),
                other.1.reaction(k, &one.0.base),
            ),
            (
                one.1.reaction(k, &one.0.head),
                other.1.reaction(k, &one.0.head),
            ),
        ];
        for (one, other) in pairs {
            let error = distance(&[other], &[turned(one)]);
            assert!(error < tolerance, "forces of increment {k}: {error:e}");
        }
    }
}

fn scale(s: f64) -> Mat3 {
    Mat3::from_rows([0, 1, 2].map(|axis| Vec3::unit(axis) * s))
}

#[test]
fn units_change_neither_iterations_nor_results() {
    for blocks in [Blocks::plane(), Blocks::space()] {
        let base = blocks.solve();
        // lengths and stresses over those of m-MN-MPa: mm-N-MPa, um-uN-MPa, m-N-Pa, km and TPa
        for (length, stress) in [
            (1e3, 1.0),
            (1e6, 1.0),
            (1.0, 1e6),
            (1.0, 1e-6),
            (1e-3, 1e-9),
        ] {
            let mut other = blocks.mapped(scale(length), Vec3::ZERO);
            other.young = blocks.young.map(|e| e * stress);
            other.thickness = length;
            let outcome = other.solve();
            let force = stress * length * length;
            assert_same(
                (&blocks, &base),
                (&other, &outcome),
                scale(length),
                force,
                1e-9,
            );
            let penalty = outcome.model.contacts[0].penalty / base.model.contacts[0].penalty;
            assert!((penalty / (stress / length) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn units_change_nothing_with_any_law_and_friction() {
    for (enforcement, contact) in [
        ("\"auto\"", "friction = 0.3"),
        ("\"auto\"", "friction = 0.3\nmethod = \"gauss-point\""),
        ("{ lagrange = {} }", ""),
        ("{ lagrange = {} }", "friction = 0.3"),
        ("{ augmented = \"newton\" }", "friction = 0.3"),
        ("{ augmented = \"uzawa\" }", ""),
        ("\"auto\"", "tied = true"),
    ] {
        let blocks = Blocks {
            enforcement: enforcement.into(),
            contact,
            ..Blocks::plane()
        };
        let base = blocks.solve();
        for (length, stress) in [(1e3, 1.0), (1e6, 1.0), (1.0, 1e6), (1.0, 1e-6)] {
            let mut other = blocks.mapped(scale(length), Vec3::ZERO);
            other.young = blocks.young.map(|e| e * stress);
            other.thickness = length;
            let outcome = other.solve();
            let force = stress * length * length;
            let (one, two) = ((&blocks, &base), (&other, &outcome));
            assert_same(one, two, scale(length), force, 1e-9);
        }
    }
}

/// With facets as the secondary side, mortar contact and friction.
fn with_mortar(mut blocks: Blocks) -> Blocks {
    blocks.secondary = blocks.faces_of_foot();
    blocks.contact = "friction = 0.3\nmethod = \"mortar\"";
    blocks
}

#[test]
fn units_change_nothing_with_mortar_and_friction() {
    for blocks in [Blocks::plane(), Blocks::space()].map(with_mortar) {
        let base = blocks.solve();
        for (length, stress, tolerance) in [
            // powers of two lose nothing but what logarithms do
            (1024.0, 1.0, 1e-12),
            (1.0, 2f64.powi(-20), 1e-12),
            (1e3, 1.0, 1e-9),
            (1e-3, 1e6, 1e-9),
        ] {
            let mut other = blocks.mapped(scale(length), Vec3::ZERO);
            other.young = blocks.young.map(|e| e * stress);
            other.thickness = length;
            let outcome = other.solve();
            let force = stress * length * length;
            let (one, two) = ((&blocks, &base), (&other, &outcome));
            assert_same(one, two, scale(length), force, tolerance);
        }
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit_of_mortar_contact() {
    for blocks in [Blocks::plane(), Blocks::space()].map(with_mortar) {
        let outcomes = [1, 2].map(|n| {
            let threads = rayon::ThreadPoolBuilder::new().num_threads(n);
            threads.build().unwrap().install(|| blocks.solve())
        });
        let [one, two] = outcomes;
        for (one, two) in one.run.frames.iter().zip(&two.run.frames) {
            assert_eq!(one.displacement, two.displacement);
            assert_eq!(one.contact_force, two.contact_force);
            assert_eq!(one.contacts[0].pressure, two.contacts[0].pressure);
        }
        assert_eq!(one.iterations(), two.iterations());
    }
}

#[test]
fn place_and_orientation_do_not_matter() {
    let turns = [
        (
            Blocks::plane(),
            Vec3::new(0.0, 0.0, 0.7),
            Vec3::new(-2.0, 5.0, 0.0),
        ),
        (Blocks::plane(), Vec3::new(0.0, 0.0, -2.3), Vec3::ZERO),
        (
            Blocks::space(),
            Vec3::new(0.4, -1.1, 0.8),
            Vec3::new(3.0, -4.0, 7.0),
        ),
        (Blocks::space(), Vec3::new(2.0, 0.5, -1.0), Vec3::ZERO),
        (Blocks::space(), Vec3::ZERO, Vec3::new(-10.0, 20.0, 5.0)),
    ];
    for (blocks, turn, shift) in turns {
        let map = Mat3::rotation(turn);
        let other = blocks.mapped(map, shift);
        let outcomes = (blocks.solve(), other.solve());
        assert_same(
            (&blocks, &outcomes.0),
            (&other, &outcomes.1),
            map,
            1.0,
            1e-10,
        );
    }
}

#[test]
fn a_mirror_does_not_matter() {
    for blocks in [Blocks::plane(), Blocks::space()] {
        for axis in 0..2 {
            let mut rows = [0, 1, 2].map(Vec3::unit);
            rows[axis] *= -1.0;
            let map = Mat3::from_rows(rows);
            let mut other = blocks.mapped(map, Vec3::ZERO);
            // the mirror image of a cell is inside out until its sides run the other way round
            for cell in &mut other.elements {
                for side in cell.nodes.chunks_mut(4) {
                    side.swap(1, 3);
                }
            }
            let outcomes = (blocks.solve(), other.solve());
            assert_same(
                (&blocks, &outcomes.0),
                (&other, &outcomes.1),
                map,
                1.0,
                1e-11,
            );
        }
    }
}

#[test]
fn order_of_nodes_and_elements_does_not_matter() {
    for blocks in [Blocks::plane(), Blocks::space()] {
        let mut other = blocks.clone();
        let shuffle = |k: usize, n: usize| (k * 7919 + 13) % n;
        let n = other.nodes.len();
        other
            .nodes
            .sort_by_key(|(label, _)| shuffle(*label as usize, n));
        let n = other.elements.len();
        other.elements.sort_by_key(|c| shuffle(c.label as usize, n));
        // every other cell starts at another corner
        for cell in other.elements.iter_mut().step_by(2) {
            for side in cell.nodes.chunks_mut(4) {
                side.rotate_left(1);
            }
        }
        for set in [
            &mut other.foot,
            &mut other.top,
            &mut other.head,
            &mut other.base,
        ] {
            set.reverse();
        }
        let outcomes = (blocks.solve(), other.solve());
        let order = |o: &Outcome| o.nodes(&[1, 2, 3]).collect::<Vec<_>>();
        assert_ne!(order(&outcomes.0), order(&outcomes.1));
        let (one, two) = ((&blocks, &outcomes.0), (&other, &outcomes.1));
        assert_same(one, two, Mat3::IDENTITY, 1.0, 1e-12);
    }
}

#[test]
fn a_plane_problem_is_one_layer_of_a_problem_in_space() {
    for per in ["area", "node"] {
        let mut plane = Blocks::plane();
        plane.thickness = 0.4;
        plane.enforcement = format!("{{ penalty = 3e4, per = \"{per}\" }}");
        let mut layer = plane.clone();
        layer.ndim = 3;
        if per == "node" {
            // two nodes share what one does in the plane
            layer.enforcement = "{ penalty = 1.5e4, per = \"node\" }".into();
        }
        let n = plane.nodes.len() as u32;
        for (label, x) in &plane.nodes {
            let behind = *x + Vec3::unit(2) * plane.thickness;
            layer.nodes.push((label + n, behind));
        }
        for cell in &mut layer.elements {
            let behind: Vec<u32> = cell.nodes.iter().map(|l| l + n).collect();
            cell.nodes.extend(behind);
        }
        for set in [
            &mut layer.foot,
            &mut layer.top,
            &mut layer.head,
            &mut layer.base,
        ] {
            let behind: Vec<u32> = set.iter().map(|l| l + n).collect();
            set.extend(behind);
        }
        layer.flat = layer.nodes.iter().map(|n| n.0).collect();
        let (in_plane, in_space) = (plane.solve(), layer.solve());
        assert_eq!(in_plane.iterations(), in_space.iterations());
        let front: Vec<u32> = (1..=n).collect();
        let back: Vec<u32> = (n + 1..=2 * n).collect();
        for k in 0..6 {
            let expected = in_plane.displacements(k, &front);
            for side in [&front, &back] {
                let error = distance(&in_space.displacements(k, side), &expected);
                assert!(error < 1e-9, "per {per}, increment {k}: {error:e}");
            }
            let force = |o: &Outcome| o.run.frames[k].contacts[0].secondary.force;
            let error = distance(&[force(&in_space)], &[force(&in_plane)]);
            assert!(error < 1e-9, "per {per}, increment {k}: {error:e}");
        }
    }
}

#[test]
fn forces_balance_and_reactions_are_the_contact_force() {
    for blocks in [Blocks::plane(), Blocks::space()] {
        let outcome = blocks.solve();
        for (k, frame) in outcome.run.frames.iter().enumerate() {
            let contact = &frame.contacts[0];
            let (secondary, primary) = (contact.secondary, contact.primary);
            let size = secondary.force.norm();
            assert!(size > 1.0, "{size}");
            assert!((secondary.force + primary.force).norm() <= 1e-12 * size);
            let moment = secondary.moment.norm();
            assert!((secondary.moment + primary.moment).norm() <= 1e-12 * moment);
            let (head, base) = (
                outcome.reaction(k, &blocks.head),
                outcome.reaction(k, &blocks.base),
            );
            assert!((head + secondary.force).norm() <= 1e-8 * size);
            assert!((base + primary.force).norm() <= 1e-8 * size);
        }
    }
}

#[test]
fn a_side_given_as_nodes_or_as_faces_gives_the_same_force() {
    for blocks in [Blocks::plane(), Blocks::space()] {
        for enforcement in [
            "\"auto\"",
            "{ penalty = \"auto\", per = \"node\" }",
            "{ penalty = 2e4, per = \"node\" }",
            "{ penalty = 2e4, per = \"area\" }",
        ] {
            let mut as_nodes = blocks.clone();
            as_nodes.enforcement = enforcement.into();
            let mut as_faces = as_nodes.clone();
            as_faces.secondary = as_faces.faces_of_foot();
            let outcomes = (as_nodes.solve(), as_faces.solve());
            let (one, two) = ((&as_nodes, &outcomes.0), (&as_faces, &outcomes.1));
            assert_same(one, two, Mat3::IDENTITY, 1.0, 1e-12);
            let chosen = |o: &Outcome| (o.model.contacts[0].penalty, o.model.contacts[0].per);
            assert_eq!(chosen(&outcomes.0), chosen(&outcomes.1));
        }
    }
}

/// Two equal blocks without lateral strain carry a uniform pressure p; with E1 of the model the penetration is
/// p h/(10 M) on every mesh, M = E for nu = 0.
#[test]
fn the_automatic_penetration_is_a_tenth_of_the_strain_of_one_facet() {
    for ndim in [2, 3] {
        for n in [1, 2, 4] {
            let size = if ndim == 2 {
                Vec3::new(1.0, 1.0, 0.0)
            } else {
                Vec3::new(1.0, 1.0, 1.0)
            };
            let mesh = ([n, n, n], size);
            let mut blocks = Blocks::new(ndim, mesh, mesh, Vec3::ZERO);
            blocks.material = "linear-elastic".into();
            blocks.geometry = "linear";
            blocks.young = [700.0, 700.0];
            let mut down = Vec3::ZERO;
            down[ndim - 1] = -0.01;
            blocks.motions = vec![down];
            let outcome = blocks.solve();
            let pressure = outcome.reaction(2, &blocks.head).norm();
            let h = 1.0 / f64::from(n);
            let expected = pressure * h / (10.0 * 700.0);
            // two blocks and the layer in between, in series
            let series = 0.01 / (2.0 / 700.0 + h / 7000.0);
            assert!(
                (pressure / series - 1.0).abs() < 1e-8,
                "{pressure} {series}"
            );
            for gap in &outcome.run.frames[2].contacts[0].gap {
                let ratio = -gap / expected;
                assert!((ratio - 1.0).abs() < 1e-8, "{ndim}d, {n}: {ratio}");
            }
        }
    }
}
