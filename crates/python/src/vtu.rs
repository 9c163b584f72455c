//! Reading a file of results without VTK.

use numpy::ndarray::Array2;
use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use signorini_io::vtk::{self, Numbers};

/// The arrays of a `.vtu` file: `points` (n, 3), `types`, `offsets` (one more than cells), `connectivity`, and
/// `point_data`, `cell_data`, `field_data` by name. All are read-only.
///
/// # Errors
/// `OSError` for a file that cannot be read, `ValueError` for one that is damaged.
#[pyfunction]
pub fn read_vtu<'py>(py: Python<'py>, path: &str) -> PyResult<Bound<'py, PyDict>> {
    let bytes = std::fs::read(path)?;
    let file = py.detach(|| vtk::read(&bytes));
    let file = file.map_err(|error| PyValueError::new_err(format!("{path}: {error}")))?;
    let whole = |values: Vec<usize>| values.into_iter().map(|v| v as i64).collect::<Vec<i64>>();
    let dict = PyDict::new(py);
    dict.set_item("points", rows(py, file.points.concat(), 3)?)?;
    dict.set_item("types", rows(py, file.types, 1)?)?;
    dict.set_item("offsets", rows(py, whole(file.offsets), 1)?)?;
    dict.set_item("connectivity", rows(py, whole(file.connectivity), 1)?)?;
    for (name, arrays) in [
        ("point_data", file.point_data),
        ("cell_data", file.cell_data),
        ("field_data", file.facts),
    ] {
        let fields = PyDict::new(py);
        for array in arrays {
            if let Some(values) = numbers(py, array.numbers, array.ncomponent)? {
                fields.set_item(array.name, values)?;
            }
        }
        dict.set_item(name, fields)?;
    }
    Ok(dict)
}

/// Numbers as an array of their type; none of a text.
fn numbers(py: Python<'_>, numbers: Numbers, columns: usize) -> PyResult<Option<Py<PyAny>>> {
    let array = match numbers {
        Numbers::F64(v) => rows(py, v, columns)?,
        Numbers::F32(v) => rows(py, v, columns)?,
        Numbers::I8(v) => rows(py, v, columns)?,
        Numbers::U8(v) => rows(py, v, columns)?,
        Numbers::I16(v) => rows(py, v, columns)?,
        Numbers::U16(v) => rows(py, v, columns)?,
        Numbers::I32(v) => rows(py, v, columns)?,
        Numbers::U32(v) => rows(py, v, columns)?,
        Numbers::I64(v) => rows(py, v, columns)?,
        Numbers::U64(v) => rows(py, v, columns)?,
        Numbers::Text(_) => return Ok(None),
    };
    Ok(Some(array.unbind()))
}

/// A read-only array of these values, in rows where there are several columns.
pub fn rows<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'_, PyAny>> {
    if columns == 1 {
        let array: Bound<'_, PyArray1<T>> = values.into_pyarray(py);
        return Ok(array.readwrite().make_nonwriteable().as_any().clone());
    }
    let shape = (values.len() / columns.max(1), columns);
    let array = Array2::from_shape_vec(shape, values);
    let array = array.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let array: Bound<'_, PyArray2<T>> = array.into_pyarray(py);
    Ok(array.readwrite().make_nonwriteable().as_any().clone())
}
