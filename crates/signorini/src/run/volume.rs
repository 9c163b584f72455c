//! `frames/volume_NNNN.vtu`: the solids at one time.
//!
//! Points are where the nodes are at the start; `displacement`, the first vector, is what viewers warp by.
//!
//! A tensor at a node is the mean over the cells around it, of whatever body: at a node that two materials share, look
//! at the cells. Bodies in contact have nodes of their own. A tensor in a cell is the mean over its volume. Equivalent
//! and principal stresses are those of the mean tensor, at nodes and in cells alike, and not means themselves.

use super::cells::Cells;
use super::fields::Fields;
use rayon::prelude::*;
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_io::writers::vtu::{
    self, Fact, FactValue, Field, Grid, Options, SymTensor, Values, VtuError,
};
use signorini_mechanics::solve::NaturalMode;
use signorini_mechanics::system::{Frame, NodalValues};

/// Tensors handled by one task.
const TENSORS_PER_TASK: usize = 1024;

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
        self.encode_with(frame, &[], &[])
    }

    /// The bytes of a frame with more fields at nodes and in cells, these in the order of the mesh.
    ///
    /// # Errors
    /// Arrays of another mesh.
    pub fn encode_with(
        &self,
        frame: &Frame,
        more_at_nodes: &[Field<'_>],
        more_in_cells: &[Field<'_>],
    ) -> Result<Vec<u8>, VtuError> {
        let displacement = vectors(&frame.displacement);
        let reaction = vectors(&frame.reaction_force);
        let force = vectors(&frame.contact_force);
        let at_node = Derived::new(self.fields, &frame.stress, &frame.strain);
        let in_cell = Derived::new(
            self.fields,
            &self.of_cells(&frame.cell_stress),
            &self.of_cells(&frame.cell_strain),
        );
        let plastic = self.of_cells(&frame.cell_plastic_strain);
        let active = self.of_cells(&frame.active).into_iter().map(i8::from);
        let active: Vec<i8> = active.collect();

        let mut at_nodes = vec![
            Field::new("displacement", Values::Vector(&displacement)),
            Field::new("reaction_force", Values::Vector(&reaction)),
        ];
        let rates = [&frame.velocity, &frame.acceleration].map(|rates| vectors(rates));
        for (name, rates) in ["velocity", "acceleration"].into_iter().zip(&rates) {
            if !rates.is_empty() {
                at_nodes.push(Field::new(name, Values::Vector(rates)));
            }
        }
        let mut in_cells = Vec::new();
        at_node.append(self.fields, &mut at_nodes);
        in_cell.append(self.fields, &mut in_cells);
        if self.fields.plastic_strain && !frame.plastic_strain.is_empty() {
            let values = Values::Scalar(&frame.plastic_strain);
            at_nodes.push(Field::new("plastic_strain", values));
            in_cells.push(Field::new("plastic_strain", Values::Scalar(&plastic)));
        }
        if !frame.active.is_empty() {
            in_cells.push(Field::new("active", Values::Int8(&active)));
        }
        let others: Vec<Vec<[f64; 3]>> = frame.fields.iter().map(as_vectors).collect();
        for (field, vectors) in frame.fields.iter().zip(&others) {
            let values = match field.ncomponent {
                1 => Values::Scalar(&field.values),
                _ => Values::Vector(vectors),
            };
            at_nodes.push(Field::new(field.name, values));
        }
        // where temperatures are solved for, those are the ones
        let is_solved = frame.fields.iter().any(|field| field.name == "temperature");
        if self.fields.temperature && !frame.temperature.is_empty() && !is_solved {
            let values = Values::Scalar(&frame.temperature);
            at_nodes.push(Field::new("temperature", values));
        }
        if self.fields.contact {
            let pressure = Values::Scalar(&frame.contact_pressure);
            at_nodes.push(Field::new("contact_pressure", pressure));
            at_nodes.push(Field::new("contact_force", Values::Vector(&force)));
            if !frame.worn_depth.is_empty() {
                let depth = Values::Scalar(&frame.worn_depth);
                at_nodes.push(Field::new("worn_depth", depth));
            }
        }
        at_nodes.extend_from_slice(more_at_nodes);
        in_cells.extend_from_slice(more_in_cells);
        at_nodes.push(Field::new("node_id", Values::Int64(&self.node_ids)));
        in_cells.push(Field::new("element_id", Values::Int64(&self.element_ids)));
        self.write(&at_nodes, &in_cells, frame)
    }

    /// Values of the cells in the order of the file; zero where a block has none.
    fn of_cells<T: Copy + Default>(&self, values: &[Vec<T>]) -> Vec<T> {
        let of_cell = |cell: &CellId| {
            let block = values.get(cell.block as usize);
            let value = block.and_then(|b| b.get(cell.index as usize));
            value.copied().unwrap_or_default()
        };
        self.source.iter().map(of_cell).collect()
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

    /// The bytes of a natural mode of a step, with its number among those of the step: both from 0.
    ///
    /// # Errors
    /// Arrays of another mesh.
    pub fn encode_mode(
        &self,
        mode: &NaturalMode,
        step: usize,
        number: usize,
    ) -> Result<Vec<u8>, VtuError> {
        let at_nodes = [
            Field::new("displacement", Values::Vector(&mode.shape)),
            Field::new("node_id", Values::Int64(&self.node_ids)),
        ];
        let in_cells = [Field::new("element_id", Values::Int64(&self.element_ids))];
        let whole = [step, number].map(|number| [number as i64 + 1]);
        let real = [mode.frequency(), mode.omega(), mode.eigenvalue].map(|value| [value]);
        let whole = ["step", "mode"].into_iter().zip(&whole);
        let real = ["frequency", "omega", "eigenvalue"].into_iter().zip(&real);
        let whole = whole.map(|(name, value)| Fact {
            name,
            value: FactValue::Whole(value),
        });
        let real = real.map(|(name, value)| Fact {
            name,
            value: FactValue::Real(value),
        });
        let facts: Vec<Fact<'_>> = whole.chain(real).collect();
        self.write_with(&at_nodes, &in_cells, &facts)
    }

    fn write(
        &self,
        point_data: &[Field<'_>],
        cell_data: &[Field<'_>],
        frame: &Frame,
    ) -> Result<Vec<u8>, VtuError> {
        let (time, place) = ([frame.time], place(frame));
        self.write_with(point_data, cell_data, &facts(&time, &place))
    }

    fn write_with(
        &self,
        point_data: &[Field<'_>],
        cell_data: &[Field<'_>],
        facts: &[Fact<'_>],
    ) -> Result<Vec<u8>, VtuError> {
        let grid = Grid {
            points: &self.points,
            types: &self.cells.types,
            offsets: &self.cells.offsets,
            connectivity: &self.cells.connectivity,
            point_data,
            cell_data,
            facts,
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

/// The values of a field of several components, of which a file has three; nothing of a scalar.
fn as_vectors(field: &NodalValues) -> Vec<[f64; 3]> {
    let n = field.ncomponent;
    if n < 2 {
        return Vec::new();
    }
    let vector = |values: &[f64]| [0, 1, 2].map(|k| values.get(k).copied().unwrap_or_default());
    field.values.chunks_exact(n).map(vector).collect()
}

/// Vectors as writers take them.
pub fn vectors(values: &[Vec3]) -> Vec<[f64; 3]> {
    values.iter().map(|v| v.to_array()).collect()
}

/// The tensors of all nodes or cells, with what follows from them; empty where not asked for.
struct Derived {
    stress: Vec<SymTensor>,
    strain: Vec<SymTensor>,
    principal: Vec<[f64; 3]>,
    von_mises: Vec<f64>,
}

impl Derived {
    fn new(fields: Fields, stress: &[Sym3], strain: &[Sym3]) -> Self {
        Self {
            stress: picked(fields.stress, stress, tensor),
            strain: picked(fields.strain, strain, tensor),
            principal: picked(fields.principal_stress, stress, Sym3::eigenvalues),
            von_mises: picked(fields.von_mises, stress, Sym3::von_mises),
        }
    }

    fn append<'a>(&'a self, fields: Fields, to: &mut Vec<Field<'a>>) {
        if fields.stress {
            to.push(symmetric("stress", &self.stress));
        }
        if fields.strain {
            to.push(symmetric("strain", &self.strain));
        }
        if fields.principal_stress {
            to.push(Field {
                component_names: &["max", "mid", "min"],
                ..Field::new("principal_stress", Values::Vector(&self.principal))
            });
        }
        if fields.von_mises {
            to.push(Field::new("von_mises", Values::Scalar(&self.von_mises)));
        }
    }
}

fn picked<T: Send>(wanted: bool, from: &[Sym3], of: fn(Sym3) -> T) -> Vec<T> {
    let from = if wanted { from } else { &[] };
    let tensors = from.par_iter().with_min_len(TENSORS_PER_TASK);
    tensors.map(|&tensor| of(tensor)).collect()
}

fn symmetric<'a>(name: &'a str, values: &'a [SymTensor]) -> Field<'a> {
    Field {
        component_names: &vtu::TENSOR_COMPONENTS,
        ..Field::new(name, Values::Tensor(values))
    }
}

fn tensor(s: Sym3) -> SymTensor {
    SymTensor {
        xx: s.xx(),
        yy: s.yy(),
        zz: s.zz(),
        xy: s.xy(),
        yz: s.yz(),
        xz: s.xz(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element::by_name;
    use signorini_mechanics::system::NodalValues;

    #[test]
    fn fields_of_nodes_are_point_data_under_their_names() {
        let mut mesh = Mesh::default();
        for (k, at) in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
            mesh.points.push(Vec3::new(at[0], at[1], 0.0));
            mesh.node_labels.push(k as u64 + 1);
        }
        mesh.push_cell(by_name("tri3").unwrap(), &[0, 1, 2], 1);
        let field = |name, ncomponent, values: &[f64]| NodalValues {
            name,
            ncomponent,
            values: values.to_vec(),
            reaction: Vec::new(),
        };
        let mut frame = Frame::new(3, &[1]);
        frame.temperature = vec![9.0; 3];
        frame.fields = vec![
            field("temperature", 1, &[20.0, 30.0, 40.0]),
            field("flow", 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
        ];
        let fields = Fields {
            temperature: true,
            ..Fields::default()
        };
        let bytes = Volume::new(&mesh, fields).encode(&frame).unwrap();
        let file = vtu::read(&bytes).unwrap();
        let values = |name| file.point_field(name).unwrap().numbers.to_f64();
        assert_eq!(values("temperature"), [20.0, 30.0, 40.0]);
        let flow = [1.0, 2.0, 0.0, 3.0, 4.0, 0.0, 5.0, 6.0, 0.0];
        assert_eq!(values("flow"), flow);
    }
}
