//! Linear steps are linear: contact keeps the geometry of the start, by default settings.
//!
//! GOAL        a patch test in `geometry = "linear"` is exact whatever its strains; a punch's limit load does not depend on
//!             its depth
//! MESH        two unit blocks, 2 cells across below and 3 above, one and two up, and all of it with cells half as large; all
//!             elements by pairs, either side the secondary one; as they are and turned by 30 degrees
//! CONDITIONS  uniaxial stress across the interface: base and lid have the displacements of the exact solution, the sides are
//!             free; plane strain, bodies of revolution from r = 1 to 2, space; moduli 1:2; strains from 1e-6 to 1e-1. Nothing
//!             else is said, neither of contact nor of solving
//! EXPECTED    u = H X in each block, its stress in all cells, and one pressure
//! TOLERANCE   1e-10 of the largest; turned, what rounding of the coordinates makes of it: 64 ε over the strain

use crate::scene::{Case, Scene, equal, finished};
use signorini_geometry::element::by_name;
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use std::fmt::Write;

const YOUNG: [f64; 2] = [100.0, 200.0];
const NU: f64 = 0.3;
const GROUPS: [&str; 2] = ["lower", "upper"];
const STRAINS: [f64; 3] = [-1e-6, -1e-3, -1e-1];

/// One patch test.
#[derive(Clone, Copy, Debug)]
struct Patch {
    space: &'static str,
    elements: [&'static str; 2],
    upper_is_secondary: bool,
    /// Whether it is turned by 30 degrees.
    turned: bool,
    /// Into how many parts each cell is cut along every axis.
    finer: usize,
}

impl Patch {
    fn up(&self) -> usize {
        by_name(self.elements[0]).unwrap().dim() - 1
    }

    /// Turns as it is turned.
    fn turn(&self) -> Mat3 {
        let angle = if self.turned {
            std::f64::consts::PI / 6.0
        } else {
            0.0
        };
        let about = match self.up() {
            1 => Vec3::unit(2),
            _ => Vec3::new(1.0, 2.0, 0.5).normalized().unwrap(),
        };
        Mat3::rotation(about * angle)
    }

    fn scene(&self, turn: Mat3) -> Scene {
        let mut scene = Scene::default();
        let from = if self.space == "axisymmetric" {
            1.0
        } else {
            0.0
        };
        for (block, (group, element)) in GROUPS.iter().zip(self.elements).enumerate() {
            let across = [[2, 2], [3, 2]][block].map(|n| equal(from, from + 1.0, n * self.finer));
            let height = equal(block as f64, 1.0 + block as f64, (1 + block) * self.finer);
            let mut axes = vec![across[0].clone()];
            if self.up() == 2 {
                axes.push(across[1].clone());
            }
            axes.push(height);
            let mut size = [0; 3];
            for (size, ends) in size.iter_mut().zip(&axes) {
                *size = ends.len() - 1;
            }
            scene.straight(group, element, size, |at| {
                let mut x = Vec3::ZERO;
                for (axis, ends) in axes.iter().enumerate() {
                    x[axis] = ends[at[axis]];
                }
                turn * x
            });
        }
        scene
    }

    /// H of both blocks, not turned, and how far the upper one comes down: `u = H X + w e_up`.
    fn exact(&self, strain: f64) -> ([Mat3; 2], [f64; 2]) {
        let across = match self.space {
            "plane-strain" => -NU / (1.0 - NU),
            _ => -NU,
        };
        let strains = YOUNG.map(|young| strain * YOUNG[0] / young);
        let gradients = strains.map(|strain| {
            let mut rows = [Vec3::ZERO; 3];
            for (axis, row) in rows[..=self.up()].iter_mut().enumerate() {
                row[axis] = if axis == self.up() {
                    strain
                } else {
                    across * strain
                };
            }
            if self.space == "axisymmetric" {
                rows[2].z = across * strain;
            }
            Mat3::from_rows(rows)
        });
        (gradients, [0.0, strains[0] - strains[1]])
    }

    fn case(&self, strain: f64) -> (Case, Scene) {
        let (up, turn) = (self.up(), self.turn());
        let (plain, mut scene) = (self.scene(Mat3::IDENTITY), self.scene(turn));
        let sides = [("roof", 0), ("foot", 1)];
        for (name, block) in sides {
            let faces = plain.facets(GROUPS[block], up, 1.0);
            let names: Vec<(usize, String)> = faces
                .iter()
                .map(|((cell, side), ..)| (*cell, format!("S{side}")))
                .collect();
            let faces: Vec<(usize, &str)> = names.iter().map(|(c, s)| (*c, s.as_str())).collect();
            scene.faces(name, &faces);
        }
        let (gradients, ways) = self.exact(strain);
        let mut moves = String::new();
        for (block, at) in [(0, 0.0), (1, 2.0)] {
            let facets = plain.facets(GROUPS[block], up, at);
            let mut nodes: Vec<usize> = facets.into_iter().flat_map(|f| f.2).collect();
            nodes.sort_unstable();
            nodes.dedup();
            for node in nodes {
                let name = format!("n{node}");
                scene.set(&name, &[node]);
                let x = place(&plain, node);
                let u = turn * (gradients[block] * x + Vec3::unit(up) * ways[block]);
                writeln!(moves, "[[step.move]]\non = {name:?}").unwrap();
                for (axis, u) in ["x", "y", "z"].iter().zip(u.to_array()).take(up + 1) {
                    writeln!(moves, "u{axis} = {u:?}").unwrap();
                }
            }
        }
        let mut text = format!("[model]\nspace = {:?}\n", self.space);
        for (group, young) in GROUPS.iter().zip(YOUNG) {
            write!(
                text,
                "[material.{group}]\nmodel = \"linear-elastic\"\nE = {young:?}\nnu = {NU:?}\n\
                 [[body]]\ngroup = {group:?}\nmaterial = {group:?}\n"
            )
            .unwrap();
        }
        let (secondary, primary) = match self.upper_is_secondary {
            true => ("foot", "roof"),
            false => ("roof", "foot"),
        };
        let case = scene.case_of(&text).contact(secondary, primary, "");
        (case.step("press", 1).also(&moves), plain)
    }

    /// What rounding may leave: turned coordinates are off by some of their last digits, which are gaps.
    fn tolerance(&self, strain: f64) -> f64 {
        let digits = if self.turned { 64.0 } else { 0.0 };
        1e-10f64.max(digits * f64::EPSILON / strain.abs())
    }

    /// The largest error of displacements, stresses and pressures.
    fn error(&self, strain: f64) -> f64 {
        let (case, plain) = self.case(strain);
        let mut model = case.model(&[]);
        let run = finished(&mut model);
        let frame = run.frames.last().unwrap();
        let (up, turn) = (self.up(), self.turn());
        let (gradients, ways) = self.exact(strain);
        let mut size = 0.0f64;
        let mut off = 0.0f64;
        let stress = hooke(0, gradients[0]).rows[up][up];
        let right = turn * hooke(0, gradients[0]) * turn.transpose();
        for (number, block) in model.mesh.blocks.iter().enumerate() {
            for cell in 0..block.ncell() {
                let nodes = block.cell(cell);
                let label = |n: &u32| model.mesh.node_labels[*n as usize] as usize;
                let places: Vec<Vec3> = nodes.iter().map(|n| place(&plain, label(n))).collect();
                let height: f64 = places.iter().map(|x| x[up]).sum();
                let body = usize::from(height > nodes.len() as f64);
                for (node, x) in nodes.iter().zip(&places) {
                    let u = turn * (gradients[body] * *x + Vec3::unit(up) * ways[body]);
                    off = off.max((frame.displacement[*node as usize] - u).norm());
                    size = size.max(u.norm());
                }
                let found = frame.cell_stress[number][cell].to_mat3();
                let away = found + right * -1.0;
                let largest = away.rows.map(Vec3::max_abs).into_iter().fold(0.0, f64::max);
                assert!(
                    largest < self.tolerance(strain) * stress.abs(),
                    "{self:?} {strain:e}: stress {largest:e}"
                );
            }
        }
        let contact = &frame.contacts[0];
        let known = contact.pressure.iter().zip(&contact.gap);
        let pressures = known.filter(|(_, gap)| !gap.is_nan());
        let of_pressure = pressures.map(|(p, _)| (p / -stress - 1.0).abs());
        of_pressure.fold(off / size, f64::max)
    }
}

fn place(scene: &Scene, node: usize) -> Vec3 {
    match *scene.at(node) {
        [x, y, z] => Vec3::new(x, y, z),
        [x, y] => Vec3::new(x, y, 0.0),
        _ => Vec3::ZERO,
    }
}

fn hooke(body: usize, gradient: Mat3) -> Mat3 {
    let lambda = YOUNG[body] * NU / ((1.0 + NU) * (1.0 - 2.0 * NU));
    let mu = YOUNG[body] / (2.0 * (1.0 + NU));
    let strain = Sym3::symmetric_part(gradient).to_mat3();
    let trace = strain.rows[0].x + strain.rows[1].y + strain.rows[2].z;
    Mat3::IDENTITY * (lambda * trace) + strain * (2.0 * mu)
}

/// All strains, both sides as the secondary one.
fn passes(space: &'static str, elements: [&'static str; 2], turned: bool, finer: usize) {
    for upper_is_secondary in [true, false] {
        let patch = Patch {
            space,
            elements,
            upper_is_secondary,
            turned,
            finer,
        };
        for strain in STRAINS {
            let error = patch.error(strain);
            assert!(
                error < patch.tolerance(strain),
                "{patch:?} at {strain:e}: {error:e}"
            );
        }
    }
}

const PLANE: [&str; 4] = ["quad4", "tri3", "quad8", "tri6"];
const SPACE: [&str; 4] = ["hex8", "tet4", "hex20", "tet10"];

#[test]
fn in_the_plane_a_linear_patch_is_exact_at_any_strain() {
    for (k, element) in PLANE.into_iter().enumerate() {
        let other = PLANE[(k + 1) % PLANE.len()];
        passes("plane-strain", [element; 2], false, 1);
        passes("plane-strain", [element, other], true, 1);
        passes("plane-strain", [element, other], true, 2);
    }
}

#[test]
fn of_bodies_of_revolution_a_linear_patch_is_exact_at_any_strain() {
    for (k, element) in PLANE.into_iter().enumerate() {
        let other = PLANE[(k + 2) % PLANE.len()];
        passes("axisymmetric", [element, other], false, 1);
        passes("axisymmetric", [element; 2], false, 2);
    }
}

#[test]
fn in_space_a_linear_patch_is_exact_at_any_strain() {
    for (k, element) in SPACE.into_iter().enumerate() {
        let other = SPACE[(k + 1) % SPACE.len()];
        passes("3d", [element; 2], false, 1);
        passes("3d", [element, other], true, 1);
    }
}

/// Forces on a rigid flat punch, 1 wide, that goes by `depth` into an elastic, perfectly plastic half block of 4 × 2, in
/// `n` increments: E = 1000, yield stress 1.
fn punch(element: &'static str, cells: usize, depth: f64, n: usize) -> Vec<f64> {
    let mut scene = Scene::default();
    let sizes = [[4 * cells, 2 * cells, 0], [cells, 1, 0]];
    let size = 1.0 / cells as f64;
    let corners = [[size, size, 0.0], [size, 0.5, 2.0]];
    for ((group, sizes), [dx, dy, base]) in ["block", "punch"].iter().zip(sizes).zip(corners) {
        let corner = |at: [usize; 3]| Vec3::new(at[0] as f64 * dx, base + at[1] as f64 * dy, 0.0);
        scene.straight(group, element, sizes, corner);
    }
    scene.place("top", "plane = \"y\", at = 2.0, of = \"block\"");
    scene.place("face", "plane = \"y\", at = 2.0, of = \"punch\"");
    scene.place("bottom", "plane = \"y\", at = 0.0, of = \"block\"");
    scene.place("middle", "plane = \"x\", at = 0.0, of = \"block\"");
    let text = "[model]\nspace = \"plane-strain\"\n[material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.3\n\
        plasticity = { hardening = \"isotropic\", table = [[1.0, 0.0]] }\n\
        [[body]]\ngroup = \"punch\"\nrigid = true";
    let case = scene
        .case_of(text)
        .body(&["block"], "")
        .contact("top", "face", "")
        .also(&format!(
            "[[step]]\nname = \"press\"\ngeometry = \"linear\"\nincrements = {{ fixed = {n} }}"
        ))
        .fix("bottom", "xy")
        .fix("middle", "x")
        .displace("punch", &format!("uy = {:?}", -depth));
    let run = case.run();
    (1..=n).map(|k| -run.contact_force(k)[1]).collect()
}

#[test]
fn the_limit_load_of_a_flat_punch_does_not_depend_on_its_depth() {
    for (element, cells) in [("quad4", 4), ("quad4", 6), ("quad8", 3)] {
        let forces = punch(element, cells, 0.1, 10);
        println!("{element}, {cells} under the punch: {forces:?}");
        // all of it flows from some hundredths on
        let late = &forces[4..];
        let last = forces[forces.len() - 1];
        for force in late {
            assert!((force / last - 1.0).abs() < 5e-3, "{element}: {forces:?}");
        }
    }
}
