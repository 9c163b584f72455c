//! The results at one time, as arrays.

use crate::view::{components, view};
use crate::vtu::rows;
use numpy::PyArray1;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyList;
use signorini_geometry::mesh::Mesh;
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_mechanics::system::{self, Frame as Values};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A frame with the mesh that it belongs to.
pub struct Kept {
    pub values: Values,
    pub mesh: Arc<Mesh>,
}

/// Arrays that were handed out: the same one each time.
type Cache = Mutex<HashMap<String, Py<PyAny>>>;

/// The results at one accepted state. Arrays are views of its memory, and cannot be written.
#[pyclass(frozen, module = "signorini._native")]
pub struct Frame {
    kept: Arc<Kept>,
    arrays: Cache,
}

impl Frame {
    pub fn new(kept: Arc<Kept>) -> Self {
        Self {
            kept,
            arrays: Cache::default(),
        }
    }
}

/// The array of this name, made where it was not yet.
fn cached<'py>(
    py: Python<'py>,
    cache: &Cache,
    name: &str,
    make: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let known = |name: &str| {
        let cache = cache.lock().unwrap_or_else(PoisonError::into_inner);
        cache.get(name).map(|array| array.bind(py).clone())
    };
    if let Some(array) = known(name) {
        return Ok(array);
    }
    let array = make()?;
    let mut cache = cache.lock().unwrap_or_else(PoisonError::into_inner);
    cache.insert(name.to_owned(), array.clone().unbind());
    Ok(array)
}

const PLAIN: [&str; 4] = [
    "displacement",
    "reaction_force",
    "contact_force",
    "contact_pressure",
];
const DERIVED: [&str; 4] = ["stress", "strain", "von_mises", "principal_stress"];

/// The components of a tensor in VTK's order: xx, yy, zz, xy, yz, xz.
fn six(tensor: &Sym3) -> [f64; 6] {
    [
        tensor.xx(),
        tensor.yy(),
        tensor.zz(),
        tensor.xy(),
        tensor.yz(),
        tensor.xz(),
    ]
}

/// A field that follows from tensors, by name.
fn derived<'py>(
    py: Python<'py>,
    name: &str,
    stress: &[Sym3],
    strain: &[Sym3],
) -> Option<PyResult<Bound<'py, PyAny>>> {
    Some(match name {
        "stress" => rows(py, stress.iter().flat_map(six).collect(), 6),
        "strain" => rows(py, strain.iter().flat_map(six).collect(), 6),
        "von_mises" => rows(py, stress.iter().map(|s| s.von_mises()).collect(), 1),
        "principal_stress" => rows(py, stress.iter().flat_map(|s| s.eigenvalues()).collect(), 3),
        _ => return None,
    })
}

fn no_field(name: &str, names: &[String]) -> PyErr {
    PyKeyError::new_err(format!(
        "no field is called {name:?}; there are {}",
        names.join(", ")
    ))
}

#[pymethods]
impl Frame {
    /// Total time.
    #[getter]
    fn time(&self) -> f64 {
        self.kept.values.time
    }

    /// The name of the step.
    #[getter]
    fn step(&self) -> &str {
        &self.kept.values.step
    }

    /// The number of the increment in its step, from 1; 0 for the undeformed state.
    #[getter]
    fn increment(&self) -> usize {
        self.kept.values.increment
    }

    /// The fields at nodes.
    fn names(&self) -> Vec<String> {
        let values = &self.kept.values;
        let known = PLAIN.iter().chain(&DERIVED).map(|&name| name.to_owned());
        let mut names: Vec<String> = known.collect();
        names.extend(values.fields.iter().map(|field| field.name.to_owned()));
        let more = [
            ("plastic_strain", values.plastic_strain.is_empty()),
            ("temperature", values.temperature.is_empty()),
        ];
        for (name, is_empty) in more {
            if !is_empty && !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        names.push("node_id".to_owned());
        names
    }

    /// A field at the nodes: (n,), (n, 3), or (n, 6) in the order xx, yy, zz, xy, yz, xz.
    ///
    /// Errors: `KeyError` for a field that there is not.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        cached(py, &self.arrays, name, || self.make_field(py, name))
    }

    /// The fields of cells.
    fn cell_names(&self) -> Vec<String> {
        let mut names: Vec<String> = DERIVED.map(str::to_owned).into();
        if !self.kept.values.cell_plastic_strain.is_empty() {
            names.push("plastic_strain".to_owned());
        }
        names.push("element_id".to_owned());
        names
    }

    /// A field of the cells of the highest dimension, block by block: means over their volumes.
    ///
    /// Errors: `KeyError` for a field that there is not.
    fn cell_field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        cached(py, &self.arrays, &format!("cell {name}"), || {
            self.make_cell_field(py, name)
        })
    }

    /// The contacts, in the order of the case.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let contacts = cached(py, &self.arrays, "contacts", || {
            let all = (0..self.kept.values.contacts.len()).map(|at| {
                Bound::new(
                    py,
                    ContactFrame {
                        kept: Arc::clone(&self.kept),
                        at,
                        arrays: Cache::default(),
                    },
                )
            });
            Ok(PyList::new(py, all.collect::<PyResult<Vec<_>>>()?)?.into_any())
        })?;
        Ok(contacts.cast_into()?)
    }
}

impl Frame {
    fn make_field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let (kept, values) = (&self.kept, &self.kept.values);
        let vectors = |of: fn(&Values) -> &Vec<Vec3>| {
            view(py, kept, Some(3), move |kept: &Kept| {
                components(of(&kept.values))
            })
        };
        let scalars = |of: fn(&Values) -> &Vec<f64>| {
            view(py, kept, None, move |kept: &Kept| {
                of(&kept.values).as_slice()
            })
        };
        match name {
            "displacement" => return vectors(|frame| &frame.displacement),
            "reaction_force" => return vectors(|frame| &frame.reaction_force),
            "contact_force" => return vectors(|frame| &frame.contact_force),
            "contact_pressure" => return scalars(|frame| &frame.contact_pressure),
            "plastic_strain" if !values.plastic_strain.is_empty() => {
                return scalars(|frame| &frame.plastic_strain);
            }
            "node_id" => {
                return view(py, kept, None, |kept: &Kept| {
                    kept.mesh.node_labels.as_slice()
                });
            }
            _ => {}
        }
        if let Some(at) = values.fields.iter().position(|field| field.name == name) {
            let columns = values.fields.get(at).map(|field| field.ncomponent);
            let columns = columns.filter(|&columns| columns > 1);
            return view(py, kept, columns, |kept: &Kept| {
                kept.values
                    .fields
                    .get(at)
                    .map_or(&[][..], |field| &field.values)
            });
        }
        if name == "temperature" && !values.temperature.is_empty() {
            return scalars(|frame| &frame.temperature);
        }
        derived(py, name, &values.stress, &values.strain)
            .unwrap_or_else(|| Err(no_field(name, &self.names())))
    }

    fn make_cell_field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let (mesh, values) = (&self.kept.mesh, &self.kept.values);
        if name == "element_id" {
            let labels = mesh
                .cells(mesh.dim())
                .filter_map(|cell| mesh.cell_label(cell));
            return rows(py, labels.collect(), 1);
        }
        if name == "plastic_strain" && !values.cell_plastic_strain.is_empty() {
            return rows(py, of_solids(mesh, &values.cell_plastic_strain), 1);
        }
        let stress = of_solids(mesh, &values.cell_stress);
        let strain = of_solids(mesh, &values.cell_strain);
        derived(py, name, &stress, &strain)
            .unwrap_or_else(|| Err(no_field(name, &self.cell_names())))
    }
}

/// Values of the cells of the highest dimension, block by block; zero where a block has none.
fn of_solids<T: Copy + Default>(mesh: &Mesh, values: &[Vec<T>]) -> Vec<T> {
    let of_cell = |cell: signorini_geometry::mesh::CellId| {
        let block = values.get(cell.block as usize);
        let value = block.and_then(|block| block.get(cell.index as usize));
        value.copied().unwrap_or_default()
    };
    mesh.cells(mesh.dim()).map(of_cell).collect()
}

/// One contact at one accepted state; arrays are over the nodes of its secondary side.
#[pyclass(frozen, module = "signorini._native")]
pub struct ContactFrame {
    kept: Arc<Kept>,
    at: usize,
    arrays: Cache,
}

impl ContactFrame {
    fn values(&self) -> Option<&system::ContactFrame> {
        self.kept.values.contacts.get(self.at)
    }

    fn number(&self, of: fn(&system::ContactFrame) -> f64) -> f64 {
        self.values().map_or(0.0, of)
    }

    fn vector<'py>(
        &self,
        py: Python<'py>,
        of: fn(&system::ContactFrame) -> Vec3,
    ) -> Bound<'py, PyArray1<f64>> {
        let value = self.values().map_or(Vec3::ZERO, of);
        PyArray1::from_slice(py, &value.to_array())
    }

    fn vectors<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        of: fn(&system::ContactFrame) -> &Vec<Vec3>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let at = self.at;
        cached(py, &self.arrays, name, || {
            view(py, &self.kept, Some(3), move |kept: &Kept| {
                kept.values
                    .contacts
                    .get(at)
                    .map_or(&[][..], |contact| components(of(contact)))
            })
        })
    }

    fn scalars<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        of: fn(&system::ContactFrame) -> &Vec<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let at = self.at;
        cached(py, &self.arrays, name, || {
            view(py, &self.kept, None, move |kept: &Kept| {
                kept.values
                    .contacts
                    .get(at)
                    .map_or(&[][..], |contact| of(contact))
            })
        })
    }
}

/// A field of the heat across a contact; empty where no step finds temperatures.
fn warmth(
    contact: &system::ContactFrame,
    of: fn(&system::ContactWarmth) -> &Vec<f64>,
) -> &Vec<f64> {
    static NONE: Vec<f64> = Vec::new();
    contact.warmth.as_ref().map_or(&NONE, of)
}

/// Getters of arrays over the nodes, and of numbers and vectors of the whole contact.
macro_rules! getters {
    (vectors { $($vectors:ident: $of_vectors:expr, $doc1:literal;)* }
     scalars { $($scalars:ident: $of_scalars:expr, $doc2:literal;)* }
     vector { $($vector:ident: $of_vector:expr, $doc3:literal;)* }
     number { $($number:ident: $of_number:expr, $doc4:literal;)* }) => {
        #[pymethods]
        impl ContactFrame {
            $(#[doc = $doc1] #[getter]
            fn $vectors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                self.vectors(py, stringify!($vectors), $of_vectors)
            })*
            $(#[doc = $doc2] #[getter]
            fn $scalars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                self.scalars(py, stringify!($scalars), $of_scalars)
            })*
            $(#[doc = $doc3] #[getter]
            fn $vector<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
                self.vector(py, $of_vector)
            })*
            $(#[doc = $doc4] #[getter]
            fn $number(&self) -> f64 {
                self.number($of_number)
            })*

            /// The name of the contact.
            #[getter]
            fn name(&self) -> &str {
                self.values().map_or("", |contact| &contact.name)
            }

            /// The nodes of the secondary side, counted from 0, (n,).
            #[getter]
            fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                let at = self.at;
                cached(py, &self.arrays, "nodes", || {
                    view(py, &self.kept, None, move |kept: &Kept| {
                        kept.values.contacts.get(at).map_or(&[][..], |contact| &contact.nodes)
                    })
                })
            }

            /// −1 nothing within reach, 0 open, 1 stick, 2 slip, 3 tied, (n,).
            #[getter]
            fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                cached(py, &self.arrays, "status", || {
                    let status = self.values().into_iter().flat_map(|contact| &contact.status);
                    rows(py, status.map(|status| status.number()).collect(), 1)
                })
            }

            /// The facets of the secondary side: names of elements with rows of indices into the nodes here, (m, k); empty
            /// where it is bare nodes.
            #[getter]
            fn facets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
                let mut of_element: Vec<(&'static str, usize, Vec<i64>)> = Vec::new();
                for (element, nodes) in self.values().into_iter().flat_map(|c| &c.facets) {
                    let known = of_element.iter().position(|one| one.0 == element.name());
                    let at = known.unwrap_or_else(|| {
                        of_element.push((element.name(), element.nnode(), Vec::new()));
                        of_element.len() - 1
                    });
                    if let Some(one) = of_element.get_mut(at) {
                        one.2.extend(nodes.iter().map(|&node| i64::from(node)));
                    }
                }
                let arrays = of_element.into_iter();
                let arrays = arrays.map(|(name, nnode, nodes)| Ok((name, rows(py, nodes, nnode)?)));
                PyList::new(py, arrays.collect::<PyResult<Vec<_>>>()?)
            }
        }
    };
}

getters! {
    vectors {
        points: |c| &c.points, "Present positions, (n, 3).";
        displacement: |c| &c.displacement, "Displacements, (n, 3).";
        normal: |c| &c.normal, "Unit normals out of the primary side, (n, 3); zero where nothing is within reach.";
        traction: |c| &c.traction, "Tractions on the secondary side (stress), (n, 3).";
        slip: |c| &c.slip, "Accumulated slip (length), (n, 3).";
        nodal_force: |c| &c.force, "Contact forces (force), (n, 3): their sum is `force`.";
        multiplier_traction: |c| &c.multiplier_traction, "Tractions in the equations, never smoothed (stress), (n, 3).";
    }
    scalars {
        gap: |c| &c.gap, "Gaps (length), (n,): positive open, negative penetration, NaN where nothing is within reach.";
        pressure: |c| &c.pressure, "Pressures (stress), at least 0, (n,); forces where the secondary side has no area.";
        pressure_max: |c| &c.pressure_peak, "The largest pressure of the points around each node (stress), (n,).";
        multiplier: |c| &c.multiplier, "Pressures in the equations, never smoothed (stress), (n,).";
        area: |c| &c.area, "Tributary areas (area), (n,).";
        damage: |c| &c.damage, "Damage of a joint that may break, from 0 to 1, (n,); of others empty.";
        heat_flux: |c| warmth(c, |of| &of.flux), "Heat per time and area to the primary side, without that of friction, (n,); empty where no step finds temperatures.";
        conductance: |c| warmth(c, |of| &of.conductance), "Heat per time, area and temperature, (n,); likewise.";
        friction_heat: |c| warmth(c, |of| &of.friction), "Heat of friction per time and area, (n,); likewise.";
    }
    vector {
        force: |c| c.secondary.force, "What the primary side exerts on the secondary side (force), (3,).";
        moment: |c| c.secondary.moment, "Its moment about the origin (force times length), (3,).";
        force_normal: |c| c.force_normal, "The part of the force that pressures exert (force), (3,).";
        force_shear: |c| c.force_shear, "The part of the force that friction exerts (force), (3,).";
        center: |c| c.center, "The centre of pressure (length), (3,).";
    }
    number {
        peak: |c| c.pressure_max, "The largest pressure (stress).";
        gap_min: |c| c.gap_min, "The smallest gap (length).";
        slip_max: |c| c.slip_max, "The largest accumulated slip (length).";
        area_open: |c| c.area_open, "Open area.";
        area_stick: |c| c.area_stick, "Sticking area.";
        area_slip: |c| c.area_slip, "Slipping area.";
        work_friction: |c| c.work_friction, "Work spent in friction since the start (energy).";
        work_damage: |c| c.work_damage, "Energy that damage has taken since the start.";
        heat: |c| c.warmth.as_ref().map_or(0.0, |of| of.through), "Heat per time to the primary side.";
        heat_friction: |c| c.warmth.as_ref().map_or(0.0, |of| of.rubbed), "Heat per time that friction sets free.";
        work_viscous: |c| c.work_viscous, "Work spent since the start by the viscosity that delays damage.";
    }
}
