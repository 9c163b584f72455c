//! Meshes as grids of VTK.

use signorini_geometry::mesh::Mesh;
use signorini_io::vtk::cells::CellType;
use signorini_io::writers::vtu::{Fact, FactValue, Field, Grid, Options, Values, VtuError, encode};

/// A mesh in the arrays that a grid borrows.
pub struct Cells {
    points: Vec<[f64; 3]>,
    types: Vec<u8>,
    offsets: Vec<usize>,
    connectivity: Vec<u32>,
    nodes: Vec<i64>,
    elements: Vec<i64>,
    /// Cells that are in each set, by its name.
    sets: Vec<(String, Vec<i8>)>,
}

/// The mark of what is in no set.
const OUTSIDE: i8 = -1;

impl Cells {
    /// The cells of a mesh that have a dimension for which `wanted` holds.
    pub fn new(mesh: &Mesh, wanted: impl Fn(usize) -> bool) -> Self {
        let mut cells = Self {
            points: mesh.points.iter().map(|x| x.to_array()).collect(),
            types: Vec::new(),
            offsets: vec![0],
            connectivity: Vec::new(),
            nodes: mesh.node_labels.iter().map(|n| *n as i64).collect(),
            elements: Vec::new(),
            sets: Vec::new(),
        };
        let mut places = std::collections::BTreeMap::new();
        for dim in (0..=3).rev().filter(|dim| wanted(*dim)) {
            for cell in mesh.cells(dim) {
                let Some(of) = mesh.element(cell).and_then(CellType::of_element) else {
                    continue;
                };
                let nodes = mesh.cell(cell);
                let picked = of.places().filter_map(|k| nodes.get(k));
                cells.connectivity.extend(picked);
                cells.types.push(of.number);
                cells.offsets.push(cells.connectivity.len());
                places.insert(cell, cells.elements.len());
                let label = mesh.cell_label(cell).unwrap_or(0);
                cells.elements.push(label as i64);
            }
        }
        for (name, set) in &mesh.sets {
            let mut inside = vec![OUTSIDE; cells.elements.len()];
            for place in set.cells.iter().filter_map(|cell| places.get(cell)) {
                if let Some(mark) = inside.get_mut(*place) {
                    *mark = 1;
                }
            }
            if inside.contains(&1) {
                cells.sets.push((name.clone(), inside));
            }
        }
        cells
    }

    /// The bytes of a file with these fields at the nodes, at a time.
    ///
    /// # Errors
    /// Fields of another mesh.
    pub fn encode(&self, fields: &[Field<'_>], time: Option<f64>) -> Result<Vec<u8>, VtuError> {
        let mut at_nodes = fields.to_vec();
        at_nodes.push(Field::new("node_id", Values::Int64(&self.nodes)));
        let mut in_cells = vec![Field::new("element_id", Values::Int64(&self.elements))];
        let sets = self.sets.iter();
        in_cells.extend(sets.map(|(name, marks)| Field::new(name, Values::Int8(marks))));
        let time = time.map(|time| [time]);
        let facts: Vec<Fact<'_>> = time
            .iter()
            .map(|time| Fact {
                name: "TimeValue",
                value: FactValue::Real(time),
            })
            .collect();
        let grid = Grid {
            points: &self.points,
            types: &self.types,
            offsets: &self.offsets,
            connectivity: &self.connectivity,
            point_data: &at_nodes,
            cell_data: &in_cells,
            facts: &facts,
        };
        encode(&grid, &Options::default())
    }
}
