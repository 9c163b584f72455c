//! A brick of hexahedra, for the other examples.
#![allow(
    clippy::expect_used,
    reason = "an example may end where a table lacks hex8"
)]

use signorini::prelude::*;

/// A brick in a mesh.
pub struct Brick {
    /// Its cells.
    pub cells: Vec<CellId>,
    /// Its nodes.
    pub nodes: Vec<NodeId>,
}

impl Brick {
    /// Adds `n` cells along each axis between two corners.
    pub fn new(mesh: &mut Mesh, low: Vec3, high: Vec3, n: [u32; 3]) -> Self {
        let first = mesh.nnode() as NodeId;
        let size = high - low;
        let at = |k: u32, axis: usize| size[axis] * f64::from(k) / f64::from(n[axis]);
        for k in 0..=n[2] {
            for j in 0..=n[1] {
                for i in 0..=n[0] {
                    mesh.points
                        .push(low + Vec3::new(at(i, 0), at(j, 1), at(k, 2)));
                    mesh.node_labels.push(u64::from(mesh.nnode() as u32));
                }
            }
        }
        let node = |i, j, k| first + i + (n[0] + 1) * (j + (n[1] + 1) * k);
        let mut cells = Vec::new();
        let hexahedron = element::by_name("hex8").expect("an element of the table");
        for k in 0..n[2] {
            for j in 0..n[1] {
                for i in 0..n[0] {
                    let level = |k| {
                        [
                            node(i, j, k),
                            node(i + 1, j, k),
                            node(i + 1, j + 1, k),
                            node(i, j + 1, k),
                        ]
                    };
                    let nodes = [level(k), level(k + 1)].concat();
                    let label = mesh.ncell() as u64 + 1;
                    cells.push(mesh.push_cell(hexahedron, &nodes, label));
                }
            }
        }
        Self {
            cells,
            nodes: (first..mesh.nnode() as NodeId).collect(),
        }
    }

    /// Its nodes at this height.
    pub fn at_height(&self, mesh: &Mesh, z: f64) -> Vec<NodeId> {
        let is_there = |n: &&NodeId| (mesh.points[**n as usize].z - z).abs() < 1e-9;
        self.nodes.iter().filter(is_there).copied().collect()
    }

    /// Its outer faces at this height.
    pub fn faces_at(&self, mesh: &Mesh, z: f64) -> Vec<Face> {
        let nodes = self.at_height(mesh, z);
        let faces = boundary(mesh, self.cells.iter().copied());
        let is_there = |face: &Face| {
            let of_face = mesh.face(*face);
            of_face.is_some_and(|(_, all)| all.iter().all(|n| nodes.contains(n)))
        };
        faces.into_iter().filter(is_there).collect()
    }

    /// The body that it makes of a material.
    pub fn body(&self, name: &str, material: impl Material + 'static) -> BodyPart {
        BodyPart {
            name: name.into(),
            cells: self.cells.clone(),
            kind: BodyKind::solid(Box::new(material)),
        }
    }
}

/// A prescribed motion of nodes: `None` holds them, else each component moves in proportion to time.
pub fn moved(nodes: &[NodeId], by: Option<Vec3>) -> Change {
    let motion = |axis| by.map_or(Motion::Hold, |by| Motion::Ramp(by[axis]));
    let motions = (0..3).map(|axis| (axis, motion(axis))).collect();
    Change::Prescribe(Target::Nodes(nodes.to_vec()), motions)
}

/// Solves a model, and returns what `read` takes from the frame of each increment.
pub fn frames<T>(
    mut model: Model,
    mut read: impl FnMut(&Frame) -> T,
) -> Result<Vec<T>, Box<dyn std::error::Error>> {
    let mut stepper = Stepper::new(&model.system, StepperSettings::default());
    let mut values = Vec::new();
    let mut watch = |event: &Event<'_>| {
        if let Event::Increment { frame, .. } = event {
            values.push(read(frame));
        }
        Flow::Continue
    };
    stepper.run(&mut model.system, &model.steps, &mut watch)?;
    Ok(values)
}
