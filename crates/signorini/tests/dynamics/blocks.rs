//! Two blocks that fly at each other off centre, in the plane or in space, with meshes that do not match; and what momenta they have.

use super::solve_in;
use signorini_geometry::tensor::Vec3;
use signorini_io::writers::vtu;
use std::fmt::Write;

/// The speed of each block along x, one against the other.
const SPEED: f64 = 2.0;

/// Blocks of side 1, and how they meet.
#[derive(Clone)]
pub struct Blocks {
    pub ndim: usize,
    /// Elements along each side of both.
    pub elements: [usize; 2],
    /// Whether the first has the secondary side.
    pub first: bool,
    pub method: &'static str,
    pub enforcement: &'static str,
    pub friction: f64,
    pub dynamics: &'static str,
    pub increments: usize,
    pub material: &'static str,
    /// Besides all that.
    pub more: &'static str,
}

impl Default for Blocks {
    fn default() -> Self {
        Self {
            ndim: 2,
            elements: [2, 3],
            first: true,
            method: "node-to-segment",
            enforcement: "{ penalty = 800.0, per = \"area\" }",
            friction: 0.0,
            dynamics: "method = \"energy-momentum\"",
            increments: 60,
            material: "neo-hookean",
            more: "",
        }
    }
}

impl Blocks {
    /// The places along each axis: in the plane there is one along z.
    fn grid(&self, n: usize) -> impl Iterator<Item = [usize; 3]> + use<> {
        let deep = if self.ndim == 3 { n } else { 1 };
        let along = move |i| (0..n).flat_map(move |j| (0..deep).map(move |k| [i, j, k]));
        (0..n).flat_map(along)
    }

    pub fn text(&self) -> String {
        let (mut nodes, mut elements) = (String::new(), String::new());
        let mut sides = [String::new(), String::new()];
        let (mut first, mut count) = (1, 0);
        for (block, side) in sides.iter_mut().enumerate() {
            let n = self.elements[block];
            let corner = [[-1.05, 0.0, 0.0], [0.05, 0.37, 0.21]][block];
            let deep = if self.ndim == 3 { n + 1 } else { 1 };
            let number = |[i, j, k]: [usize; 3]| first + (i * (n + 1) + j) * deep + k;
            for at in self.grid(n + 1) {
                let x = (0..self.ndim).map(|axis| corner[axis] + at[axis] as f64 / n as f64);
                let x: Vec<String> = x.map(|x| format!("{x:?}")).collect();
                write!(nodes, "[{}, {}], ", number(at), x.join(", ")).unwrap();
            }
            for [i, j, k] in self.grid(n) {
                count += 1;
                let layer = |k| [[i, j, k], [i + 1, j, k], [i + 1, j + 1, k], [i, j + 1, k]];
                let mut of = layer(k).to_vec();
                if self.ndim == 3 {
                    of.extend(layer(k + 1));
                }
                let of: Vec<String> = of.into_iter().map(|at| number(at).to_string()).collect();
                let (kind, name) = (["quad4", "hex8"][self.ndim - 2], ["a", "b"][block]);
                write!(
                    elements,
                    "{{ id = {count}, type = \"{kind}\", group = \"{name}\", nodes = [{}] }}, ",
                    of.join(", ")
                )
                .unwrap();
                let outside = [("x", i), ("y", j), ("z", k)].into_iter().take(self.ndim);
                for (axis, at) in outside {
                    if at == 0 {
                        write!(side, "[{count}, \"-{axis}\"], ").unwrap();
                    }
                    if at + 1 == n {
                        write!(side, "[{count}, \"+{axis}\"], ").unwrap();
                    }
                }
            }
            first += (n + 1).pow(2) * deep;
        }
        let [a, b] = sides;
        let names = if self.first {
            ["sa", "sb"]
        } else {
            ["sb", "sa"]
        };
        format!(
            "[mesh]\nnodes = [{nodes}]\nelements = [{elements}]\n[model]\nspace = \"{}\"\n\
             [material.m]\nmodel = \"{}\"\nE = 100.0\nnu = 0.3\ndensity = 1.0\n\
             [[body]]\ngroup = \"a\"\nmaterial = \"m\"\nmass_matrix = \"lumped\"\n\
             [[body]]\ngroup = \"b\"\nmaterial = \"m\"\nmass_matrix = \"lumped\"\n\
             [sets]\nsa = {{ faces = [{a}] }}\nsb = {{ faces = [{b}] }}\n\
             [[contact]]\nname = \"c\"\nsecondary = \"{}\"\nprimary = \"{}\"\nmethod = \"{}\"\n\
             enforcement = {}\nfriction = {:?}\n\
             [initial]\nvelocity = [{{ on = \"a\", v = [{SPEED:?}, 0, 0] }}, {{ on = \"b\", v = [{:?}, 0, 0] }}]\n\
             [solver]\nnewton = {{ force_tol = 1e-11 }}\n[output]\nevery = {}\n\
             [[step]]\nname = \"go\"\nkind = \"dynamic\"\ngeometry = \"nonlinear\"\nduration = {:?}\n\
             increments = {{ fixed = {} }}\ndynamics = {{ {} }}\n{}\n",
            ["plane-strain", "3d"][self.ndim - 2],
            self.material,
            names[0],
            names[1],
            self.method,
            self.enforcement,
            self.friction,
            -SPEED,
            self.increments,
            0.01 * self.increments as f64,
            self.increments,
            self.dynamics,
            self.more,
        )
    }

    /// Half of each element's mass over its nodes, node by node.
    fn masses(&self) -> Vec<f64> {
        let mut masses = Vec::new();
        for n in self.elements {
            let share = (0.5 / n as f64).powi(self.ndim as i32);
            masses.extend(self.grid(n + 1).map(|at| {
                let inner = at.iter().take(self.ndim).filter(|k| (1..n).contains(*k));
                share * f64::from(1 << inner.count())
            }));
        }
        masses
    }

    /// Momentum, and angular momentum about the origin, at the start and at the end of a run; with its history.
    pub fn run(&self) -> (super::Table, [[Vec3; 2]; 2]) {
        let (finished, table, fs, folder) = solve_in(&self.text());
        assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics.plain());
        let file = folder.join("frames/volume_0001.vtu");
        let grid = vtu::read(&fs.read(&file).unwrap()).unwrap();
        let vectors = |name: &str| -> Vec<Vec3> {
            let numbers = grid.point_field(name).unwrap().numbers.to_f64();
            let rows = numbers.chunks_exact(3);
            rows.map(|v| Vec3::new(v[0], v[1], v[2])).collect()
        };
        let points: Vec<Vec3> = grid.points.iter().map(|x| Vec3::from(*x)).collect();
        let moved = points.iter().zip(vectors("displacement"));
        let moved: Vec<Vec3> = moved.map(|(x, u)| *x + u).collect();
        let masses = self.masses();
        let momenta = |at: &[Vec3], v: &[Vec3]| {
            let all = masses.iter().zip(at).zip(v);
            all.fold([Vec3::ZERO; 2], |[p, l], ((m, x), v)| {
                [p + *v * *m, l + x.cross(*v * *m)]
            })
        };
        let of_first = masses.len() - self.grid(self.elements[1] + 1).count();
        let start: Vec<Vec3> = (0..masses.len())
            .map(|node| Vec3::new(if node < of_first { SPEED } else { -SPEED }, 0.0, 0.0))
            .collect();
        let both = [
            momenta(&points, &start),
            momenta(&moved, &vectors("velocity")),
        ];
        (table, both)
    }
}
