//! Boxes of quad4 or hex8, as text of a case.

use std::collections::BTreeMap;
use std::fmt::Write;

/// Meshed boxes, with the sets `NAME_left`, `NAME_right` (faces), `NAME_bottom`, `NAME_top` and `NAME_all` (nodes).
pub struct Boxes {
    ndim: usize,
    nodes: Vec<[f64; 3]>,
    elements: String,
    nelement: usize,
    sets: BTreeMap<String, Vec<usize>>,
}

impl Boxes {
    pub fn new(ndim: usize) -> Self {
        Self {
            ndim,
            nodes: Vec::new(),
            elements: String::new(),
            nelement: 0,
            sets: BTreeMap::new(),
        }
    }

    /// Adds a box between two corners with so many cells along each axis.
    pub fn add(&mut self, name: &str, from: [f64; 3], to: [f64; 3], n: [usize; 3]) -> &mut Self {
        let n = if self.ndim == 2 { [n[0], n[1], 0] } else { n };
        let first = self.nodes.len() + 1;
        let node = |i: usize, j: usize, k: usize| first + i + (n[0] + 1) * (j + (n[1] + 1) * k);
        for k in 0..=n[2] {
            for j in 0..=n[1] {
                for i in 0..=n[0] {
                    let at = [i, j, k];
                    let x = std::array::from_fn(|a| match n[a] {
                        0 => 0.0,
                        cells => from[a] + (to[a] - from[a]) * at[a] as f64 / cells as f64,
                    });
                    self.nodes.push(x);
                    let sides = [
                        ("left", i == 0),
                        ("right", i == n[0]),
                        ("bottom", j == 0),
                        ("top", j == n[1]),
                        ("all", true),
                    ];
                    for (side, _) in sides.iter().filter(|(_, is)| *is) {
                        let set = self.sets.entry(format!("{name}_{side}")).or_default();
                        set.push(node(i, j, k));
                    }
                }
            }
        }
        let kind = if self.ndim == 2 { "quad4" } else { "hex8" };
        for k in 0..n[2].max(1) {
            for j in 0..n[1] {
                for i in 0..n[0] {
                    let ring = |k| {
                        [
                            node(i, j, k),
                            node(i + 1, j, k),
                            node(i + 1, j + 1, k),
                            node(i, j + 1, k),
                        ]
                    };
                    let nodes = match self.ndim {
                        2 => ring(0).to_vec(),
                        _ => [ring(k), ring(k + 1)].concat(),
                    };
                    self.nelement += 1;
                    writeln!(
                        self.elements,
                        "{{ id = {}, type = \"{kind}\", group = \"{name}\", nodes = {nodes:?} }},",
                        self.nelement
                    )
                    .unwrap();
                }
            }
        }
        self
    }

    /// Moves the nodes of a box.
    pub fn bend(&mut self, name: &str, to: impl Fn([f64; 3]) -> [f64; 3]) -> &mut Self {
        for node in &self.sets[&format!("{name}_all")] {
            self.nodes[node - 1] = to(self.nodes[node - 1]);
        }
        self
    }

    /// Where a node is.
    pub fn place(&self, node: usize) -> [f64; 3] {
        self.nodes[node - 1]
    }

    /// Adds a set of nodes.
    pub fn set(&mut self, name: &str, nodes: Vec<usize>) -> &mut Self {
        self.sets.insert(name.to_owned(), nodes);
        self
    }

    /// The numbers of the nodes of a set.
    pub fn nodes(&self, set: &str) -> &[usize] {
        &self.sets[set]
    }

    /// The case with the rest of its text.
    pub fn case(&self, rest: &str) -> String {
        let mut text = "[mesh]\nnodes = [\n".to_owned();
        for (k, x) in self.nodes.iter().enumerate() {
            writeln!(text, "[{}, {:?}, {:?}, {:?}],", k + 1, x[0], x[1], x[2]).unwrap();
        }
        writeln!(text, "]\nelements = [\n{}]", self.elements).unwrap();
        let space = match self.ndim {
            2 => "space = \"plane-strain\"\nthickness = 1.0",
            _ => "space = \"3d\"",
        };
        writeln!(text, "[model]\n{space}\n[sets]").unwrap();
        for (name, nodes) in &self.sets {
            writeln!(text, "{name} = {{ nodes = {nodes:?} }}").unwrap();
        }
        text + rest
    }
}
