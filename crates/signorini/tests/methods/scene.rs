//! A small block that is pressed on something and slid over it, as the text of a case.

use super::common;
use super::grid::{self, Grid};
use signorini::setup::{Model, build, read_mesh_of, read_surfaces_of};
use signorini_geometry::mesh::{CellId, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::read_case;
use signorini_io::diagnostic::{Diagnostic, Diagnostics};
use signorini_mechanics::system::Frame;
use std::fmt::Write;
use std::path::Path;

/// Modulus of the blocks, and the coefficient of friction.
pub const MODULUS: f64 = 1000.0;
pub const MU: f64 = 0.2;
/// How far the head of the block goes down, and then along.
pub const PRESS: f64 = 0.04;
pub const SLIDE: f64 = 0.2;

/// A way to compare two sides: its name, its keys.
pub type Choice = (&'static str, &'static str);

pub const METHODS: [Choice; 14] = [
    ("auto", "method = \"auto\""),
    ("node-to-node", "method = \"node-to-node\""),
    (
        "node-to-node, given normals",
        "method = \"node-to-node\"\nnormals = [0.0, 1.0]",
    ),
    ("node-to-segment", "method = \"node-to-segment\""),
    (
        "node-to-segment, two passes",
        "method = \"node-to-segment\"\npasses = 2",
    ),
    (
        "node-to-segment, small sliding",
        "method = \"node-to-segment\"\nsliding = \"small\"",
    ),
    ("gauss-point", "method = \"gauss-point\""),
    (
        "gauss-point, Lobatto's points",
        "method = \"gauss-point\"\nrule = { kind = \"lobatto\" }",
    ),
    (
        "gauss-point, one point",
        "method = \"gauss-point\"\nrule = { points = 1 }",
    ),
    (
        "gauss-point, two passes",
        "method = \"gauss-point\"\npasses = 2",
    ),
    (
        "gauss-point, small sliding",
        "method = \"gauss-point\"\nsliding = \"small\"",
    ),
    (
        "gauss-point, facets cut in every increment",
        "method = \"gauss-point\"\nrule = { cut = true }\nsliding = \"increment\"",
    ),
    ("mortar", "method = \"mortar\""),
    (
        "mortar, small sliding",
        "method = \"mortar\"\nsliding = \"small\"",
    ),
];

/// Laws; those that leave no penetration come first.
pub const LAWS: [Choice; 6] = [
    ("lagrange", "{ lagrange = {} }"),
    ("augmented, newton", "{ augmented = \"newton\" }"),
    ("augmented, uzawa", "{ augmented = \"uzawa\" }"),
    ("penalty", "{ penalty = 1e5 }"),
    ("table", "{ penalty = [[-1e-2, 1e3], [0.0, 0.0]] }"),
    ("exponential", "{ exponential = { p0 = 20.0, c0 = 1e-3 } }"),
];
/// How many of the laws leave no penetration.
pub const EXACT: usize = 3;

/// What the block is pressed on: its name, its shape in the plane, its shape in space. All touch the foot from below.
pub const SURFACES: [(&str, &str, &str); 8] = [
    (
        "plane",
        "plane = { point = [0.0, 0.0], normal = \"y\" }",
        "plane = { point = [0.0, 0.0, 0.0], normal = \"y\" }",
    ),
    (
        "circle",
        "circle = { center = [0.5, -10.0], radius = 10.0 }",
        "circle = { center = [0.5, -10.0, -0.5], radius = 10.0 }",
    ),
    (
        "sphere",
        "sphere = { center = [0.5, -10.0], radius = 10.0 }",
        "sphere = { center = [0.5, -10.0, -0.5], radius = 10.0 }",
    ),
    (
        "cylinder",
        "cylinder = { point = [0.5, -10.0], axis = \"z\", radius = 10.0 }",
        "cylinder = { point = [0.5, -10.0, 0.0], axis = \"z\", radius = 10.0 }",
    ),
    (
        "cone",
        "cone = { apex = [0.5, 0.0], axis = [0.0, -1.0], half_angle = 88.0 }",
        "cone = { apex = [0.5, 0.0, 9.5], axis = [0.0, -1.0, -1.0], half_angle = 45.0 }",
    ),
    (
        "torus",
        "torus = { center = [0.5, -15.0], axis = \"z\", radius = 8.0, tube = 7.0 }",
        "torus = { center = [0.5, -15.0, -0.5], axis = \"z\", radius = 8.0, tube = 7.0 }",
    ),
    (
        "polynomial",
        "polynomial = { coefficients = [-0.05, 0.05, -0.0125] }",
        "polynomial = { coefficients = [-0.05, 0.05, -0.0125] }",
    ),
    ("stl", "stl = \"floor.stl\"", "stl = \"floor.stl\""),
];

/// What the block is pressed on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Below {
    /// A block whose mesh does not match.
    Block,
    /// A surface of [`SURFACES`].
    Surface(usize),
    /// Itself: its head may touch its foot.
    Itself,
}

/// A block on something, and how they touch.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    pub element: &'static str,
    pub below: Below,
    pub method: &'static str,
    pub law: &'static str,
    /// Further keys of the contact.
    pub keys: &'static str,
}

/// What a case is refused with.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Refusal {
    pub code: &'static str,
    /// What is wrong, and the advice.
    pub message: String,
    pub advice: String,
}

/// What came of pressing and sliding.
pub struct Outcome {
    /// The method in use.
    pub method: &'static str,
    pub iterations: usize,
    pub cutbacks: usize,
    /// At the end of each step.
    pub pressed: Frame,
    pub slid: Frame,
}

pub fn is_plane(element: &str) -> bool {
    element.starts_with("tri") || element.starts_with("quad")
}

/// Nodes, cells and sets of a grid as rows of a case.
struct Rows {
    nodes: String,
    cells: String,
    sets: String,
    nnode: usize,
    ncell: usize,
}

impl Rows {
    fn add(&mut self, group: &str, grid: &Grid, plane: bool, faces: &str, held: &str) {
        let up = |x: &Vec3| if plane { x.y } else { x.z };
        for x in &grid.mesh.points {
            self.nnode += 1;
            let x = x.to_array();
            let row = &x[..if plane { 2 } else { 3 }];
            let row: Vec<String> = row.iter().map(|x| format!("{x:?}")).collect();
            writeln!(self.nodes, "[{}, {}],", self.nnode, row.join(", ")).unwrap();
        }
        let first = self.nnode - grid.mesh.points.len() + 1;
        for &cell in &grid.cells {
            self.ncell += 1;
            let nodes = grid.mesh.cell(cell).iter();
            let nodes: Vec<usize> = nodes.map(|n| first + *n as usize).collect();
            let element = grid.mesh.element(cell).unwrap().name();
            writeln!(
                self.cells,
                "{{ id = {}, type = \"{element}\", group = \"{group}\", nodes = {nodes:?} }},",
                self.ncell
            )
            .unwrap();
        }
        let first_cell = self.ncell - grid.cells.len() + 1;
        for (name, wanted) in [("foot", 0.0), ("roof", 1.0)] {
            if faces != name {
                continue;
            }
            let sides = grid.faces(|x| (up(&x) - wanted).abs() < 1e-9);
            let place = |c: CellId| grid.cells.iter().position(|&k| k == c).unwrap();
            let rows = sides
                .iter()
                .map(|f| format!("[{}, \"S{}\"]", first_cell + place(f.cell), f.side + 1));
            let rows: Vec<String> = rows.collect();
            writeln!(self.sets, "{name} = {{ faces = [{}] }}", rows.join(", ")).unwrap();
        }
        let wanted = if held == "head" { 1.0 } else { 0.0 };
        let nodes = grid.nodes(|x| (up(&x) - wanted).abs() < 1e-9);
        let nodes: Vec<usize> = nodes.iter().map(|n| first + *n as usize).collect();
        writeln!(self.sets, "{held} = {{ nodes = {nodes:?} }}").unwrap();
    }
}

impl Scene {
    pub fn is_plane(&self) -> bool {
        is_plane(self.element)
    }

    /// Cells along each edge of the block.
    fn ncell(&self) -> usize {
        if self.is_plane() || grid::degree(self.element) < 2.0 {
            2
        } else {
            1
        }
    }

    /// The unit block, its foot at y = 0; in space one layer of cells.
    fn upper(&self) -> Grid {
        let plane = self.is_plane();
        Grid::new(self.element, self.ncell(), 1, |x| {
            if plane { x } else { Vec3::new(x.x, x.z, -x.y) }
        })
    }

    /// A wider block below it with one cell more along its edges, or one like it where nodes meet nodes.
    fn lower(&self) -> Grid {
        let plane = self.is_plane();
        let matching = self.method.contains("node-to-node");
        let (n, wide, off) = if matching {
            (self.ncell(), 1.0, 0.0)
        } else {
            (self.ncell() + 1, 2.0, 0.4)
        };
        Grid::new(self.element, n, 1, |x| {
            if plane {
                Vec3::new(wide * x.x - off, x.y - 1.0, 0.0)
            } else {
                Vec3::new(wide * x.x - off, x.z - 1.0, off - wide * x.y)
            }
        })
    }

    /// The case.
    pub fn text(&self) -> String {
        let plane = self.is_plane();
        let mut rows = Rows {
            nodes: String::new(),
            cells: String::new(),
            sets: String::new(),
            nnode: 0,
            ncell: 0,
        };
        rows.add("upper", &self.upper(), plane, "foot", "head");
        let all = if plane { "[\"x\", \"y\"]" } else { "\"all\"" };
        let still = if plane {
            "ux = 0.0".to_owned()
        } else {
            "ux = 0.0\nuz = 0.0".to_owned()
        };
        let (mut bodies, mut base, mut surface) = ("\"upper\"", String::new(), String::new());
        let primary = match self.below {
            Below::Block => {
                rows.add("lower", &self.lower(), plane, "roof", "base");
                bodies = "\"upper\", \"lower\"";
                base = format!("[[step.fix]]\non = \"base\"\nu = {all}\n");
                "roof"
            }
            Below::Surface(n) => {
                let shape = if plane { SURFACES[n].1 } else { SURFACES[n].2 };
                let at = if plane {
                    "[0.5, -1.0]"
                } else {
                    "[0.5, -1.0, -0.5]"
                };
                surface = format!(
                    "[reference]\npilot = {{ at = {at} }}\n[[surface]]\nname = \"floor\"\nshape = {{ {shape} }}\nreference = \"pilot\"\n"
                );
                "floor"
            }
            Below::Itself => "self",
        };
        let nodes = &rows.nodes;
        let space = if plane { "plane-strain" } else { "3d" };
        let Self { law, keys, .. } = self;
        let method = if plane {
            self.method.to_owned()
        } else {
            self.method.replace("[0.0, 1.0]", "[0.0, 1.0, 0.0]")
        };
        format!(
            r#"format = 1
[mesh]
nodes = [
{nodes}]
elements = [
{cells}]
[sets]
{sets}
[model]
space = "{space}"
[material.m]
model = "neo-hookean"
E = {MODULUS:?}
nu = 0.3
[[body]]
group = [{bodies}]
material = "m"
{surface}
[[contact]]
name = "touch"
secondary = "foot"
primary = "{primary}"
{method}
enforcement = {law}
{keys}
[[step]]
name = "press"
increments = {{ initial = 0.5, max = 0.5 }}
{base}[[step.move]]
on = "head"
{still}
uy = {down:?}
[[step]]
name = "slide"
increments = {{ initial = 0.25, max = 0.25 }}
[[step.move]]
on = "head"
ux = {SLIDE:?}
"#,
            cells = rows.cells,
            sets = rows.sets,
            down = -PRESS,
        )
    }

    /// The model of the case, or why there is none.
    pub fn model(&self) -> Result<Model, Refusal> {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let model = || -> Result<Model, Diagnostics> {
            let (mut case, _) = read_case(
                "case.toml",
                self.text().as_bytes(),
                &[],
                signorini::vocabulary(),
            )?;
            read_surfaces_of(&mut case, folder)?;
            let (mesh, _) = read_mesh_of(&case, folder)?;
            build(case, mesh)
        };
        model().map_err(|found| Refusal::of(found.iter().next().unwrap()))
    }

    /// Presses and slides; what makes no sense is refused.
    pub fn run(&self) -> Result<Outcome, Refusal> {
        let mut model = self.model()?;
        let run = common::run(&mut model);
        let name = format!("{self:?}");
        assert!(run.error.is_none(), "{name}: {:?}", run.error);
        let last_of = |step: &str| {
            let mut frames = run.frames.iter().rev();
            frames.find(|f| f.step == step).unwrap().clone()
        };
        let outcome = Outcome {
            method: model.contacts[0].method,
            iterations: run.increments.iter().map(|i| i.iterations).sum(),
            cutbacks: run.cutbacks.len(),
            pressed: last_of("press"),
            slid: last_of("slide"),
        };
        for frame in [&outcome.pressed, &outcome.slid] {
            self.balances(&model, frame);
        }
        Ok(outcome)
    }

    /// What the head is held with, what the contact transmits, and what the base or the pilot carries are one force.
    fn balances(&self, model: &Model, frame: &Frame) {
        let reaction = |set: &str| {
            let nodes: Vec<NodeId> = model.nodes_of(set).unwrap_or_default();
            let forces = nodes.iter().map(|&n| frame.reaction_force[n as usize]);
            forces.fold(Vec3::ZERO, |sum, f| sum + f)
        };
        let contact = &frame.contacts[0];
        let (up, head) = (contact.secondary.force, reaction("head"));
        let carried = match self.below {
            Below::Surface(_) => frame.rigid[0].contact.force * -1.0,
            _ => reaction("base"),
        };
        let size = up.norm();
        assert!(size > 1.0, "{self:?}: {up:?}");
        for (what, error) in [
            ("head", head + up),
            ("base", carried - up),
            ("sides", contact.primary.force + up),
            ("parts", contact.force_normal + contact.force_shear - up),
        ] {
            let error = error.norm() / size;
            assert!(error < 1e-5, "{self:?}: {what} {error:e}");
        }
    }
}

impl Refusal {
    fn of(one: &Diagnostic) -> Self {
        let remarks = one.labels.iter().map(|label| label.text.clone());
        let advice = remarks.chain(one.help.iter().cloned());
        Self {
            code: one.code.id,
            message: one.message.clone(),
            advice: advice
                .filter(|a| !a.is_empty())
                .collect::<Vec<_>>()
                .join("; "),
        }
    }
}

/// Writes the triangles of the floor: two rows of squares, each of two triangles.
pub fn write_floor() {
    let mut text = String::from("solid floor\n");
    let (xs, zs) = ([-1.0, 0.3, 2.5], [-2.0, -0.4, 1.5]);
    let mut triangle = |corners: [[f64; 2]; 3]| {
        text.push_str("facet normal 0 1 0\nouter loop\n");
        for [x, z] in corners {
            writeln!(text, "vertex {x:?} 0.0 {z:?}").unwrap();
        }
        text.push_str("endloop\nendfacet\n");
    };
    for i in 0..2 {
        for k in 0..2 {
            let [a, b, c, d] = [
                [xs[i], zs[k]],
                [xs[i], zs[k + 1]],
                [xs[i + 1], zs[k + 1]],
                [xs[i + 1], zs[k]],
            ];
            triangle([a, b, c]);
            triangle([a, c, d]);
        }
    }
    text.push_str("endsolid floor\n");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    // tests run at the same time: a whole file is put in place at once
    let own = folder.join(format!("floor-{:?}.stl", std::thread::current().id()));
    std::fs::write(&own, text).unwrap();
    std::fs::rename(own, folder.join("floor.stl")).unwrap();
}
