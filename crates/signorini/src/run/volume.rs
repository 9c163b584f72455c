//! `frames/volume_NNNN.vtu`: the solids at one time.
//!
//! Points are where the nodes are at the start; `displacement`, the first vector, is what viewers warp by.

use super::cells::Cells;
use super::fields::Fields;
use super::principal::principal;
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_io::writers::vtu::{
    self, Fact, FactValue, Field, Grid, Options, SymTensor, Values, VtuError,
};
use signorini_mechanics::system::Frame;

/// What is the same in all frames.
#[derive(Debug)]
pub struct Volume {
    points: Vec<[f64; 3]>,
    cells: Cells,
    source: Vec<CellId>,
    node_ids: Vec<i64>,
    element_ids: Vec<i64>,
    fields: Fields,
}

impl Volume {
    /// The cells of the highest dimension of a mesh.
    pub fn new(mesh: &Mesh, fields: Fields) -> Self {
        let mut cells = Cells::default();
        let mut source = Vec::new();
        for cell in mesh.cells(mesh.dim()) {
            let Some(element) = mesh.element(cell) else {
                continue;
            };
            if cells.push(element, mesh.cell(cell), 0) {
                source.push(cell);
            }
        }
        let id = |label: u64| i64::try_from(label).unwrap_or(-1);
        let labels = source.iter().map(|&cell| mesh.cell_label(cell));
        Self {
            points: mesh.points.iter().map(|x| x.to_array()).collect(),
            element_ids: labels.map(|label| label.map_or(-1, id)).collect(),
            node_ids: mesh.node_labels.iter().map(|&label| id(label)).collect(),
            cells,
            source,
            fields,
        }
    }

    /// The bytes of a frame.
    ///
    /// # Errors
    /// Arrays of another mesh.
    pub fn encode(&self, frame: &Frame) -> Result<Vec<u8>, VtuError> {
        let displacement = vectors(&frame.displacement);
        let reaction = vectors(&frame.reaction_force);
        let force = vectors(&frame.contact_force);
        let stress: Vec<SymTensor> = frame.stress.iter().map(tensor).collect();
        let von_mises: Vec<f64> = frame.stress.iter().map(|s| s.von_mises()).collect();
        let principals: Vec<[f64; 3]> = frame.stress.iter().map(principal).collect();
        let of_cell = |cell: &CellId| {
            let block = frame.cell_stress.get(cell.block as usize);
            let stress = block.and_then(|b| b.get(cell.index as usize));
            stress.copied().unwrap_or(Sym3::ZERO)
        };
        let cell_stress: Vec<Sym3> = self.source.iter().map(of_cell).collect();
        let cell_von_mises: Vec<f64> = cell_stress.iter().map(|s| s.von_mises()).collect();
        let cell_stress: Vec<SymTensor> = cell_stress.iter().map(tensor).collect();

        let mut at_nodes = vec![
            Field::new("displacement", Values::Vector(&displacement)),
            Field::new("reaction_force", Values::Vector(&reaction)),
        ];
        let mut in_cells = Vec::new();
        if self.fields.stress {
            at_nodes.push(symmetric("stress", &stress));
            at_nodes.push(Field {
                component_names: &["min", "mid", "max"],
                ..Field::new("principal", Values::Vector(&principals))
            });
            in_cells.push(symmetric("stress", &cell_stress));
        }
        if self.fields.stress || self.fields.von_mises {
            at_nodes.push(Field::new("von_mises", Values::Scalar(&von_mises)));
            in_cells.push(Field::new("von_mises", Values::Scalar(&cell_von_mises)));
        }
        if self.fields.contact {
            let pressure = Values::Scalar(&frame.contact_pressure);
            at_nodes.push(Field::new("contact_pressure", pressure));
            at_nodes.push(Field::new("contact_force", Values::Vector(&force)));
        }
        at_nodes.push(Field::new("node_id", Values::Int64(&self.node_ids)));
        in_cells.push(Field::new("element_id", Values::Int64(&self.element_ids)));
        self.write(&at_nodes, &in_cells, frame)
    }

    /// The bytes of a frame with nothing but displacements: for a state that has no stresses.
    ///
    /// # Errors
    /// Arrays of another mesh.
    pub fn encode_shape(&self, frame: &Frame) -> Result<Vec<u8>, VtuError> {
        let displacement = vectors(&frame.displacement);
        let at_nodes = [
            Field::new("displacement", Values::Vector(&displacement)),
            Field::new("node_id", Values::Int64(&self.node_ids)),
        ];
        let in_cells = [Field::new("element_id", Values::Int64(&self.element_ids))];
        self.write(&at_nodes, &in_cells, frame)
    }

    fn write(
        &self,
        point_data: &[Field<'_>],
        cell_data: &[Field<'_>],
        frame: &Frame,
    ) -> Result<Vec<u8>, VtuError> {
        let (time, place) = ([frame.time], place(frame));
        let grid = Grid {
            points: &self.points,
            types: &self.cells.types,
            offsets: &self.cells.offsets,
            connectivity: &self.cells.connectivity,
            point_data,
            cell_data,
            facts: &facts(&time, &place),
        };
        vtu::encode(&grid, &Options::default())
    }
}

/// Step (from 1) and increment of a frame.
pub fn place(frame: &Frame) -> [[i64; 1]; 2] {
    [[frame.step_number as i64 + 1], [frame.increment as i64]]
}

/// What viewers and scripts want to know about a frame as a whole.
pub fn facts<'a>(time: &'a [f64], place: &'a [[i64; 1]; 2]) -> [Fact<'a>; 3] {
    let [step, increment] = place;
    [
        Fact {
            name: "TimeValue",
            value: FactValue::Real(time),
        },
        Fact {
            name: "step",
            value: FactValue::Whole(step),
        },
        Fact {
            name: "increment",
            value: FactValue::Whole(increment),
        },
    ]
}

/// Vectors as writers take them.
pub fn vectors(values: &[Vec3]) -> Vec<[f64; 3]> {
    values.iter().map(|v| v.to_array()).collect()
}

fn symmetric<'a>(name: &'a str, values: &'a [SymTensor]) -> Field<'a> {
    Field {
        component_names: &vtu::TENSOR_COMPONENTS,
        ..Field::new(name, Values::Tensor(values))
    }
}

fn tensor(s: &Sym3) -> SymTensor {
    SymTensor {
        xx: s.xx(),
        yy: s.yy(),
        zz: s.zz(),
        xy: s.xy(),
        yz: s.yz(),
        xz: s.xz(),
    }
}
