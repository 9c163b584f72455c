//! Two blocks, one upon the other, in a state that is homogeneous in each: mesh, loads, and how far a solution is off.

use crate::common::Run;
use crate::scene::{Case, Scene, finished};
use signorini::setup::Model;
use signorini_geometry::element::{Element, by_name};
use signorini_geometry::mesh::Block;
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use signorini_mechanics::contact::mortar::{Facet, Frame, Pair};
use signorini_mechanics::system::Status;
use std::collections::BTreeMap;
use std::fmt::Write;

const NU: f64 = 0.3;
/// Rounding is all that is left.
pub const NEWTON: &str = "force_tol = 1e-13, gap_tol = 1e-14, max_iterations = 30";
const GROUPS: [&str; 2] = ["lower", "upper"];

/// How large strains and motions may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strains {
    /// Linear, with the weights of the start.
    Held,
    /// Linear, with the weights of the present positions.
    Linear,
    /// Saint-Venant and Kirchhoff's law.
    Finite,
}

/// Two blocks that share the plane across the last axis at 1; the lower one begins at 0, the upper one ends at 2.
#[derive(Clone)]
pub struct Blocks {
    pub elements: [&'static str; 2],
    /// Ends of the cells of each across, along every axis but the last.
    pub across: [Vec<Vec<f64>>; 2],
    /// The same along the last axis.
    pub heights: [Vec<f64>; 2],
    /// How far corners are moved within the planes across the last axis, relative to the cells.
    pub distortion: f64,
    pub seed: u64,
    pub upper_is_secondary: bool,
    pub strains: Strains,
    pub young: [f64; 2],
    pub nu: f64,
    /// More keys of the contact.
    pub contact: &'static str,
}

/// What is true in each block: `u = H (X − O)`, and the traction upon the interface.
pub struct Exact {
    pub gradient: [Mat3; 2],
    pub origin: [Vec3; 2],
    pub pressure: f64,
}

/// How far off a solution is, relative to the largest value.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    pub displacement: f64,
    pub stress: f64,
    pub pressure: f64,
    /// Of the forces that contact exerts on the nodes of both sides, along the last axis.
    pub force: f64,
}

impl Errors {
    pub fn most(&self) -> f64 {
        self.of_forces().max(self.pressure)
    }

    /// Without pressures of nodes, which are differences of small forces where little is covered.
    pub fn of_forces(&self) -> f64 {
        self.displacement.max(self.stress).max(self.force)
    }

    pub fn or(self, other: Self) -> Self {
        Self {
            displacement: self.displacement.max(other.displacement),
            stress: self.stress.max(other.stress),
            pressure: self.pressure.max(other.pressure),
            force: self.force.max(other.force),
        }
    }
}

/// A number in [−1, 1) that belongs to these (splitmix64).
fn noise(keys: [u64; 4]) -> f64 {
    let mut z = keys.iter().fold(0u64, |z, k| {
        (z ^ k).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23)
    });
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn places(scene: &Scene, nodes: &[usize]) -> Vec<Vec3> {
    let place = |n: &usize| match *scene.at(*n) {
        [x, y, z] => Vec3::new(x, y, z),
        [x, y] => Vec3::new(x, y, 0.0),
        _ => Vec3::ZERO,
    };
    nodes.iter().map(place).collect()
}

/// `∫N` over a flat facet.
fn whole(scene: &Scene, element: Element, nodes: &[usize]) -> Vec<f64> {
    let x = places(scene, nodes);
    let mut sums = vec![0.0; nodes.len()];
    let (mut n, mut dn) = (sums.clone(), vec![Vec3::ZERO; nodes.len()]);
    for (xi, w) in element.surface_rule().iter() {
        element.shape(xi, &mut n);
        element.dshape(xi, &mut dn);
        let tangent = |a: usize| x.iter().zip(&dn).map(|(x, d)| *x * d[a]).sum::<Vec3>();
        let area = match element.dim() {
            1 => tangent(0).norm(),
            _ => tangent(0).cross(tangent(1)).norm(),
        };
        for (sum, n) in sums.iter_mut().zip(&n) {
            *sum += w * area * n;
        }
    }
    sums
}

/// `∫N` over the part of a facet of the interface that a box across the last axis covers.
fn part(scene: &Scene, element: Element, nodes: &[usize], [a, b]: [Vec3; 2]) -> Vec<f64> {
    let x = places(scene, nodes);
    let frame = Frame::of(&Facet { element, x: &x }).unwrap();
    let (kind, mut corners) = match element.dim() {
        1 => ("line2", vec![a, b]),
        _ => {
            let corner = |x: f64, y: f64| Vec3::new(x, y, a.z);
            let (right, behind) = (corner(b.x, a.y), corner(a.x, b.y));
            ("quad4", vec![a, right, b, behind])
        }
    };
    // what covers a facet faces it: a line to the right looks down, a square seen from above looks up
    let upwards = frame.normal()[element.dim()] > 0.0;
    if upwards == (element.dim() == 1) {
        corners.reverse();
    }
    let cover = Facet {
        element: by_name(kind).unwrap(),
        x: &corners,
    };
    let mut pair = Pair::default();
    let found = pair.integrate(&frame, &cover, 0, false).unwrap();
    let share = |j: usize| if found { pair.n(j) } else { 0.0 };
    (0..nodes.len()).map(share).collect()
}

impl Blocks {
    /// Unit blocks with 2 cells across below and 3 above.
    pub fn new(elements: [&'static str; 2], distortion: f64) -> Self {
        let ndim = by_name(elements[0]).unwrap().dim();
        let below = vec![0.0, 0.45, 1.0];
        let above = [vec![0.0, 0.3, 0.7, 1.0], vec![0.0, 0.6, 1.0]];
        Self {
            elements,
            across: [vec![below; ndim - 1], above[..ndim - 1].to_vec()],
            heights: [vec![0.0, 1.0], vec![1.0, 2.0]],
            distortion,
            seed: 1,
            upper_is_secondary: true,
            strains: Strains::Held,
            young: [100.0, 200.0],
            nu: NU,
            contact: "",
        }
    }

    pub fn ndim(&self) -> usize {
        self.across[0].len() + 1
    }

    fn up(&self) -> usize {
        self.ndim() - 1
    }

    /// The ends of a block across, first or last along all axes.
    fn end(&self, block: usize, last: bool) -> Vec3 {
        let mut end = Vec3::ZERO;
        for (axis, ends) in self.across[block].iter().enumerate() {
            end[axis] = if last { ends[ends.len() - 1] } else { ends[0] };
        }
        end
    }

    /// A corner of the grid of a block.
    fn corner(&self, block: usize, at: [usize; 3]) -> Vec3 {
        let up = self.up();
        let mut x = Vec3::ZERO;
        x[up] = self.heights[block][at[up]];
        for (axis, ends) in self.across[block].iter().enumerate() {
            let k = at[axis];
            x[axis] = ends[k];
            if k > 0 && k + 1 < ends.len() {
                let room = (ends[k] - ends[k - 1]).min(ends[k + 1] - ends[k]);
                let [i, j, l] = at.map(|i| i as u64);
                let key = [self.seed, (8 * block + axis) as u64, i + 64 * j, l];
                x[axis] += self.distortion * room * noise(key);
            }
        }
        x
    }

    pub fn scene(&self) -> Scene {
        let mut scene = Scene::default();
        for (block, group) in GROUPS.iter().enumerate() {
            let mut size = [0; 3];
            for (size, ends) in size.iter_mut().zip(&self.across[block]) {
                *size = ends.len() - 1;
            }
            size[self.up()] = self.heights[block].len() - 1;
            let corner = |at| self.corner(block, at);
            scene.straight(group, self.elements[block], size, corner);
        }
        scene
    }

    /// The state of uniaxial stress with this strain of the lower block along the last axis: Green's where strains are
    /// finite. The upper one has the same stress.
    pub fn pressed(&self, strain: f64) -> Exact {
        let (up, plane) = (self.up(), self.ndim() == 2);
        let (across, stiffness) = if plane {
            (-self.nu / (1.0 - self.nu), 1.0 / (1.0 - self.nu * self.nu))
        } else {
            (-self.nu, 1.0)
        };
        let strains = [strain, strain * self.young[0] / self.young[1]];
        let of = |strain: f64| match self.strains {
            Strains::Finite => (1.0 + 2.0 * strain).sqrt() - 1.0,
            _ => strain,
        };
        let gradient = strains.map(|strain| {
            let mut rows = [Vec3::ZERO; 3];
            for (axis, row) in rows[..=up].iter_mut().enumerate() {
                row[axis] = of(if axis == up { strain } else { across * strain });
            }
            Mat3::from_rows(rows)
        });
        let mut origin = [self.end(0, false), self.end(1, false)];
        // where the upper block would have to begin for both to stay together
        let lower = gradient[0].rows[up][up];
        let upper = gradient[1].rows[up][up];
        origin[1][up] = 1.0 - lower / upper;
        let stress = self.young[0] * stiffness * strain;
        let stretch = 1.0 + gradient[0].rows[0][0];
        let pressure = match self.strains {
            Strains::Held | Strains::Linear => -stress,
            // pressures are per area of the present
            Strains::Finite => -stress * (1.0 + lower) / stretch.powi(up as i32),
        };
        Exact {
            gradient,
            origin,
            pressure,
        }
    }

    /// The case of that state: rollers below, at the beginnings, and on top; the uncovered part is loaded.
    pub fn case(&self, scene: &mut Scene, exact: &Exact) -> Case {
        let up = self.up();
        let axes = ["x", "y", "z"];
        for (name, axis, at, of) in [
            ("base", up, 0.0, 0),
            ("lid", up, 2.0, 1),
            ("roof", up, 1.0, 0),
            ("foot", up, 1.0, 1),
        ] {
            let (axis, of) = (axes[axis], GROUPS[of]);
            scene.place(name, &format!("plane = {axis:?}, at = {at:?}, of = {of:?}"));
        }
        let mut held = String::new();
        for (block, group) in GROUPS.iter().enumerate() {
            for (number, axis) in axes.iter().enumerate().take(up) {
                let name = format!("{group}_{number}");
                let at = self.end(block, false)[number];
                scene.place(
                    &name,
                    &format!("plane = {axis:?}, at = {at:?}, of = {group:?}"),
                );
                writeln!(held, "[[step.fix]]\non = {name:?}\nu = [{axis:?}]").unwrap();
            }
        }
        let loads = self.loads(scene, exact);
        let way = exact.gradient[1].rows[up][up] * (2.0 - exact.origin[1][up]);
        let top = axes[up];
        self.begin(scene)
            .also(&self.step("press"))
            .also(&format!(
                "[[step.fix]]\non = \"base\"\nu = [{top:?}]\n{held}"
            ))
            .also(&format!(
                "[[step.move]]\non = \"lid\"\nu{top} = {way:?}\n{loads}"
            ))
            .newton(NEWTON)
    }

    /// The head of a step of one increment.
    pub fn step(&self, name: &str) -> String {
        let geometry = match self.strains {
            Strains::Finite => "nonlinear",
            _ => "linear",
        };
        format!("[[step]]\nname = {name:?}\ngeometry = {geometry:?}\nincrements = 1")
    }

    /// What a case says before its steps.
    pub fn begin(&self, scene: &Scene) -> Case {
        let space = if self.up() == 1 { "plane-strain" } else { "3d" };
        let law = match self.strains {
            Strains::Finite => "saint-venant-kirchhoff",
            _ => "linear-elastic",
        };
        let mut text = format!("[model]\nspace = {space:?}\n");
        for (group, young) in GROUPS.iter().zip(self.young) {
            let nu = self.nu;
            write!(
                text,
                "[material.{group}]\nmodel = {law:?}\nE = {young:?}\nnu = {nu:?}\n\
                 [[body]]\ngroup = {group:?}\nmaterial = {group:?}\nlocking = \"none\"\n"
            )
            .unwrap();
        }
        let sliding = match self.strains {
            Strains::Held => "small",
            _ => "finite",
        };
        let (secondary, primary) = match self.upper_is_secondary {
            true => ("foot", "roof"),
            false => ("roof", "foot"),
        };
        let keys = format!(
            "method = \"mortar\"\nsliding = {sliding:?}\n{}",
            self.contact
        );
        scene.case_of(&text).contact(secondary, primary, &keys)
    }

    /// `∫N` over all of the interface, and over what both blocks share, at the nodes of both sides: positive above.
    fn shares(&self, scene: &Scene) -> BTreeMap<usize, [f64; 2]> {
        let up = self.up();
        let [a, b] = [0, 1].map(|block| [self.end(block, false), self.end(block, true)]);
        let mut shared = [Vec3::ZERO; 2];
        for axis in 0..up {
            shared[0][axis] = a[0][axis].max(b[0][axis]);
            shared[1][axis] = a[1][axis].min(b[1][axis]);
        }
        for corner in &mut shared {
            corner[up] = 1.0;
        }
        let mut shares = BTreeMap::new();
        for (group, sign) in GROUPS.iter().zip([-1.0, 1.0]) {
            for (_, element, nodes) in scene.facets(group, up, 1.0) {
                let whole = whole(scene, element, &nodes);
                let part = part(scene, element, &nodes, shared);
                for ((node, whole), part) in nodes.iter().zip(whole).zip(part) {
                    let share = shares.entry(*node).or_insert([0.0; 2]);
                    share[0] += sign * whole;
                    share[1] += sign * part;
                }
            }
        }
        shares
    }

    /// Forces at nodes for the traction that acts where nothing covers the interface, dead and per area of the start.
    fn loads(&self, scene: &mut Scene, exact: &Exact) -> String {
        let up = self.up();
        let nominal = exact.pressure * self.area_ratio(exact);
        let mut text = String::new();
        for (node, [whole, part]) in self.shares(scene) {
            if (whole - part).abs() > 1e-15 {
                let mut force = Vec3::ZERO;
                force[up] = (whole - part) * nominal;
                let force = &force.to_array()[..=up];
                let name = format!("node_{node}");
                scene.set(&name, &[node]);
                writeln!(text, "[[step.load]]\non = {name:?}\nper_node = {force:?}").unwrap();
            }
        }
        text
    }

    /// Present over first area of the interface, as pressures see it.
    fn area_ratio(&self, exact: &Exact) -> f64 {
        match self.strains {
            Strains::Held | Strains::Linear => 1.0,
            Strains::Finite => (1.0 + exact.gradient[0].rows[0][0]).powi(self.up() as i32),
        }
    }

    /// A homogeneous deformation in so many steps: base and lid are moved, the sides loaded as it demands.
    pub fn deformed(&self, gradient: Mat3, steps: usize) -> Errors {
        let mut scene = self.scene();
        let up = self.up();
        let axes = &["x", "y", "z"][..=up];
        for (name, at, of) in [
            ("base", 0.0, 0),
            ("roof", 1.0, 0),
            ("foot", 1.0, 1),
            ("lid", 2.0, 1),
        ] {
            let (of, axis) = (GROUPS[of], axes[up]);
            scene.place(name, &format!("plane = {axis:?}, at = {at:?}, of = {of:?}"));
        }
        let sides = self.sides(&mut scene);
        let mut case = self.begin(&scene);
        for step in 1..=steps {
            let now = gradient * (step as f64 / steps as f64);
            let u = now * Vec3::unit(up) * 2.0;
            let mut text = self.step(&format!("step {step}"));
            text += "\n[[step.fix]]\non = \"base\"\nu = \"all\"\n[[step.move]]\non = \"lid\"\n";
            for (axis, u) in axes.iter().zip(u.to_array()) {
                writeln!(text, "u{axis} = {u:?}").unwrap();
            }
            let f = Mat3::IDENTITY + now;
            let nominal =
                self.stress(0, now) * f.inverse().unwrap().0.transpose() * f.determinant();
            for (node, area) in &sides {
                let force = nominal * *area;
                let force = &force.to_array()[..=up];
                writeln!(
                    text,
                    "[[step.load]]\nname = \"at {node}\"\non = \"node_{node}\"\nper_node = {force:?}"
                )
                .unwrap();
            }
            case = case.also(&text);
        }
        let mut model = case.newton(NEWTON).model(&[]);
        let run = finished(&mut model);
        let normal = self.stress(0, gradient).rows[up][up];
        let exact = Exact {
            gradient: [gradient; 2],
            origin: [Vec3::ZERO; 2],
            pressure: -normal,
        };
        let contact = &run.frames.last().unwrap().contacts[0];
        assert!(
            contact.status.iter().all(|s| *s == Status::Stick),
            "{:?}",
            contact.status
        );
        self.compare(&model, &run, &exact)
    }

    /// `∫N dA` over the sides, outwards, at nodes, each of which becomes a set.
    fn sides(&self, scene: &mut Scene) -> BTreeMap<usize, Vec3> {
        let mut areas = BTreeMap::new();
        for (block, group) in GROUPS.iter().enumerate() {
            for axis in 0..self.up() {
                for (last, sign) in [(false, -1.0), (true, 1.0)] {
                    let at = self.end(block, last)[axis];
                    for (_, element, nodes) in scene.facets(group, axis, at) {
                        for (node, n) in nodes.iter().zip(whole(scene, element, &nodes)) {
                            *areas.entry(*node).or_insert(Vec3::ZERO) +=
                                Vec3::unit(axis) * (sign * n);
                        }
                    }
                }
            }
        }
        for node in areas.keys() {
            scene.set(&format!("node_{node}"), &[*node]);
        }
        areas
    }

    /// Solves and compares.
    pub fn errors(&self, exact: &Exact) -> Errors {
        let (model, run) = self.solve(exact);
        self.compare(&model, &run, exact)
    }

    pub fn solve(&self, exact: &Exact) -> (Model, Run) {
        let mut scene = self.scene();
        let case = self.case(&mut scene, exact);
        let mut model = case.model(&[]);
        let run = finished(&mut model);
        (model, run)
    }

    /// How far off the last state is.
    pub fn compare(&self, model: &Model, run: &Run, exact: &Exact) -> Errors {
        let frame = run.frames.last().unwrap();
        let up = self.up();
        let mut errors = Errors::default();
        let mut largest = 0.0f64;
        let nominal = exact.pressure;
        for block in model
            .mesh
            .blocks
            .iter()
            .filter(|b| b.element.dim() == up + 1)
        {
            for cell in 0..block.ncell() {
                let nodes = block.cell(cell);
                let height: f64 = nodes
                    .iter()
                    .map(|n| model.mesh.points[*n as usize][up])
                    .sum();
                let body = usize::from(height > nodes.len() as f64);
                let (gradient, origin) = (exact.gradient[body], exact.origin[body]);
                for &node in nodes {
                    let u = gradient * (model.mesh.points[node as usize] - origin);
                    let off = (frame.displacement[node as usize] - u).norm();
                    errors.displacement = errors.displacement.max(off);
                    largest = largest.max(u.norm());
                }
                let right = self.stress(body, gradient);
                for found in gradients(block, cell, &model.mesh.points, &frame.displacement) {
                    let off = self.stress(body, found) - right;
                    let rows = (0..3).map(|i| off.rows[i].max_abs());
                    errors.stress = errors.stress.max(rows.fold(0.0, f64::max) / nominal);
                }
            }
        }
        errors.displacement /= largest;
        let contact = &frame.contacts[0];
        for (pressure, gap) in contact.pressure.iter().zip(&contact.gap) {
            if !gap.is_nan() {
                errors.pressure = errors.pressure.max((pressure / nominal - 1.0).abs());
            }
        }
        let mut most = 0.0f64;
        for (node, [_, part]) in self.shares(&self.scene()) {
            let force = part * nominal * self.area_ratio(exact);
            let node = model.node(node as u64).unwrap() as usize;
            let off = (frame.contact_force[node][up] - force).abs();
            errors.force = errors.force.max(off);
            most = most.max(force.abs());
        }
        errors.force /= most;
        errors
    }

    /// Cauchy's stress.
    pub fn stress(&self, body: usize, gradient: Mat3) -> Mat3 {
        let (young, nu) = (self.young[body], self.nu);
        let lambda = young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let mu = young / (2.0 * (1.0 + nu));
        let hooke = |e: Mat3| {
            let trace = e.rows[0].x + e.rows[1].y + e.rows[2].z;
            Mat3::IDENTITY * (lambda * trace) + e * (2.0 * mu)
        };
        if self.strains != Strains::Finite {
            return hooke(Sym3::symmetric_part(gradient).to_mat3());
        }
        let f = Mat3::IDENTITY + gradient;
        let green = (f.transpose() * f + Mat3::IDENTITY * -1.0) * 0.5;
        f * hooke(green) * f.transpose() * (1.0 / f.determinant())
    }
}

/// `∂u/∂X` at the points of the full rule of a cell.
fn gradients(block: &Block, cell: usize, points: &[Vec3], u: &[Vec3]) -> Vec<Mat3> {
    let mut dn = vec![Vec3::ZERO; block.element.nnode()];
    let rule = block.element.full_rule();
    let at = |xi: &Vec3| {
        block.element.dshape(xi, &mut dn);
        let gradient = |of: &[Vec3]| {
            let nodes = block.cell(cell).iter().zip(&dn);
            let terms = nodes.map(|(n, dn)| Mat3::outer(of[*n as usize], *dn));
            terms.fold(Mat3::ZERO, |sum, term| sum + term)
        };
        let mut map = gradient(points);
        if block.element.dim() == 2 {
            map = map + Mat3::outer(Vec3::unit(2), Vec3::unit(2));
        }
        gradient(u) * map.inverse().unwrap().0
    };
    rule.points.iter().map(at).collect()
}
