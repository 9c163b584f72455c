//! A block on a wider one, in the plane.

use std::fmt::Write;

/// The case: sets are `low_base`, `low_head`, `low_nodes` … and the same of `high`.
pub struct Blocks {
    /// Distance of the two.
    pub gap: f64,
    /// How far the upper one is from the left end of the lower one, which is 3 long.
    pub along: f64,
    pub material: &'static str,
    pub bodies: &'static str,
    /// Keys of the contact between them; no contact where there is none.
    pub contact: Option<&'static str>,
    /// Other tables before the steps.
    pub more: &'static str,
    /// Keys of the first step.
    pub keys: &'static str,
    /// Its tables, and later steps.
    pub steps: &'static str,
    pub solver: &'static str,
}

pub const BLOCKS: Blocks = Blocks {
    gap: 0.0,
    along: 0.7,
    material: NEO_HOOKEAN,
    bodies: TWO_BODIES,
    contact: Some(""),
    more: "",
    keys: "",
    steps: "",
    solver: "",
};

pub const NEO_HOOKEAN: &str = "model = \"neo-hookean\"\nE = 1000.0\nnu = 0.3";
pub const TWO_BODIES: &str =
    "[[body]]\ngroup = \"low\"\nmaterial = \"m\"\n[[body]]\ngroup = \"high\"\nmaterial = \"m\"";
/// Keeps the head of the upper block from moving sideways.
pub const GUIDED: &str = "[[step.fix]]\non = \"high_top\"\nu = [\"x\"]\n";
/// Moves the head of the upper block onto the lower one.
pub const HEAD_MOVED: &str = "[[step.move]]\non = \"high_top\"\nux = 0\nuy = -0.05\n";

/// The upper block, pressed onto the lower one.
pub fn pressed() -> String {
    Blocks {
        steps: HEAD_MOVED,
        ..BLOCKS
    }
    .text()
}

struct Grid {
    name: &'static str,
    /// The first number of nodes and elements.
    first: usize,
    cells: [usize; 2],
    corner: [f64; 2],
    size: [f64; 2],
}

impl Grid {
    fn node(&self, i: usize, j: usize) -> usize {
        self.first + j * (self.cells[0] + 1) + i
    }

    fn write(&self, nodes: &mut String, elements: &mut String, sets: &mut String) {
        let ([nx, ny], [x, y], [lx, ly]) = (self.cells, self.corner, self.size);
        for j in 0..=ny {
            for i in 0..=nx {
                let at = [x + lx * i as f64 / nx as f64, y + ly * j as f64 / ny as f64];
                writeln!(nodes, "[{}, {:.9}, {:.9}],", self.node(i, j), at[0], at[1]).unwrap();
            }
        }
        for j in 0..ny {
            for i in 0..nx {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                let corners = corners.map(|(i, j)| self.node(i, j));
                writeln!(
                    elements,
                    "{{ id = {}, type = \"quad4\", group = \"{}\", nodes = {corners:?} }},",
                    self.first + j * nx + i,
                    self.name
                )
                .unwrap();
            }
        }
        let row = |j: usize| (0..=nx).map(move |i| self.node(i, j)).collect::<Vec<_>>();
        let faces = |j: usize, side: &str| {
            let of = |i: usize| format!("[{}, \"{side}\"]", self.first + j * nx + i);
            (0..nx).map(of).collect::<Vec<_>>().join(", ")
        };
        let name = self.name;
        writeln!(sets, "{name}_bottom = {{ nodes = {:?} }}", row(0)).unwrap();
        writeln!(sets, "{name}_top = {{ nodes = {:?} }}", row(ny)).unwrap();
        writeln!(sets, "{name}_foot = {{ faces = [{}] }}", faces(0, "S1")).unwrap();
        writeln!(
            sets,
            "{name}_head = {{ faces = [{}] }}",
            faces(ny - 1, "S3")
        )
        .unwrap();
    }
}

impl Blocks {
    pub fn text(&self) -> String {
        let low = Grid {
            name: "low",
            first: 1,
            cells: [6, 2],
            corner: [0.0, -1.0],
            size: [3.0, 1.0],
        };
        let high = Grid {
            name: "high",
            first: 101,
            cells: [4, 2],
            corner: [self.along, self.gap],
            size: [1.5, 1.0],
        };
        let (mut nodes, mut elements, mut sets) = Default::default();
        for grid in [low, high] {
            grid.write(&mut nodes, &mut elements, &mut sets);
        }
        let contact = self.contact.map_or_else(String::new, |keys| {
            format!(
                "[[contact]]\nname = \"touch\"\nsecondary = \"high_foot\"\nprimary = \"low_head\"\n{keys}"
            )
        });
        format!(
            "format = 1\n[mesh]\nnodes = [\n{nodes}]\nelements = [\n{elements}]\n[model]\nspace = \"plane-strain\"\n\
             [sets]\n{sets}[material.m]\n{}\n{}\n{contact}\n{}\n[[step]]\nname = \"press\"\n{}\n\
             [[step.fix]]\non = \"low_bottom\"\nu = \"all\"\n{}\n{}\n",
            self.material, self.bodies, self.more, self.keys, self.steps, self.solver
        )
    }
}
