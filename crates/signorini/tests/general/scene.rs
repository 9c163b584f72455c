//! Blocks of quadrilaterals or bricks, as text of a case.

use std::fmt::Write;

/// A mesh of blocks.
#[derive(Default)]
pub struct Scene {
    ndim: usize,
    nodes: String,
    elements: String,
    nnode: usize,
    nelement: usize,
    groups: Vec<String>,
    /// Sets of faces: name and faces.
    sides: Vec<(String, Vec<String>)>,
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl Scene {
    pub fn new(ndim: usize) -> Self {
        Self {
            ndim,
            ..Self::default()
        }
    }

    /// Adds a block of `n` elements between two corners; its faces are sets `NAME-x`, `NAME+x` and so on. In the plane the
    /// third components mean nothing.
    pub fn block(&mut self, name: &str, n: [usize; 3], low: [f64; 3], high: [f64; 3]) -> &mut Self {
        let sides = self.bent(name, n, |at| {
            std::array::from_fn(|k| low[k] + at[k] * (high[k] - low[k]))
        });
        self.sides.extend(sides);
        self
    }

    /// The same where nodes lie at the image of the unit cube; its sets are for its caller.
    pub fn bent(
        &mut self,
        name: &str,
        n: [usize; 3],
        place: impl Fn([f64; 3]) -> [f64; 3],
    ) -> Vec<(String, Vec<String>)> {
        let flat = self.ndim == 2;
        let n = if flat { [n[0], n[1], 0] } else { n };
        let first = self.nnode + 1;
        let node = |i: usize, j: usize, k: usize| first + (k * (n[1] + 1) + j) * (n[0] + 1) + i;
        for k in 0..=n[2] {
            for j in 0..=n[1] {
                for i in 0..=n[0] {
                    let part = |i: usize, n: usize| i as f64 / n.max(1) as f64;
                    let x = place([part(i, n[0]), part(j, n[1]), part(k, n[2])]);
                    self.nnode += 1;
                    let x: Vec<String> = x.iter().take(self.ndim).map(f64::to_string).collect();
                    writeln!(self.nodes, "[{}, {}],", self.nnode, x.join(", ")).unwrap();
                }
            }
        }
        let mut sides = vec![Vec::new(); 2 * self.ndim];
        for k in 0..n[2].max(1) {
            for j in 0..n[1] {
                for i in 0..n[0] {
                    self.nelement += 1;
                    let id = self.nelement;
                    let ring = |k: usize| {
                        [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(a, b)| node(i + a, j + b, k))
                    };
                    let (kind, nodes) = match flat {
                        true => ("quad4", ring(0).to_vec()),
                        false => ("hex8", [ring(k), ring(k + 1)].concat()),
                    };
                    writeln!(
                        self.elements,
                        "{{ id = {id}, type = \"{kind}\", group = \"{name}\", nodes = {nodes:?} }},"
                    )
                    .unwrap();
                    for (axis, (at, n)) in [i, j, k].into_iter().zip(n).enumerate().take(self.ndim)
                    {
                        for (end, is_there) in [at == 0, at + 1 == n].into_iter().enumerate() {
                            if is_there {
                                let side = format!("[{id}, \"{}{}\"]", ["-", "+"][end], AXES[axis]);
                                sides[2 * axis + end].push(side);
                            }
                        }
                    }
                }
            }
        }
        self.groups.push(name.to_owned());
        let named = sides.into_iter().enumerate().map(|(number, faces)| {
            let sign = ["-", "+"][number % 2];
            (format!("{name}{sign}{}", AXES[number / 2]), faces)
        });
        named.collect()
    }

    /// The case of these blocks of one material with what is added.
    pub fn case(&self, rest: &str) -> String {
        let space = if self.ndim == 2 { "plane-strain" } else { "3d" };
        let mut text = format!(
            "[mesh]\nnodes = [\n{}]\nelements = [\n{}]\n[model]\nspace = \"{space}\"\n[sets]\n",
            self.nodes, self.elements
        );
        for (name, faces) in &self.sides {
            writeln!(text, "\"{name}\" = {{ faces = [{}] }}", faces.join(", ")).unwrap();
        }
        let groups: Vec<String> = self.groups.iter().map(|g| format!("\"{g}\"")).collect();
        write!(
            text,
            "[material.soft]\nmodel = \"neo-hookean\"\nE = 1000.0\nnu = 0.3\n[[body]]\ngroup = [{}]\n\
             material = \"soft\"\n{rest}",
            groups.join(", ")
        )
        .unwrap();
        text
    }
}
