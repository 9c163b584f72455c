//! TOML and Python's dictionaries.

use crate::diagnostics::exception;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString};
use signorini::Diagnostics;
use signorini_io::diagnostic::{Diagnostic, Place, SourceFile, codes};
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

/// A text in TOML as a dictionary.
///
/// # Errors
/// `InputError` where the text is no TOML, with its place.
#[pyfunction]
#[pyo3(signature = (text, name = "case.toml"))]
pub fn parse<'py>(py: Python<'py>, text: &str, name: &str) -> PyResult<Bound<'py, PyDict>> {
    let document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        let file = SourceFile::new(name, text);
        let one = Diagnostic::error(&codes::SYNTAX, error.message());
        let place = error.span().map(|span| Place::new(&file, span));
        let one = place.into_iter().fold(one, |one, at| one.at(&at, ""));
        exception(py, &Diagnostics::from(one))
    })?;
    dictionary(py, document.as_table())
}

fn dictionary<'py>(py: Python<'py>, table: &dyn TableLike) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, item) in table.iter() {
        let value = match item {
            Item::None => continue,
            Item::Value(value) => object(py, value)?,
            Item::Table(table) => dictionary(py, table)?.into_any(),
            Item::ArrayOfTables(tables) => {
                let tables = tables.iter().map(|table| dictionary(py, table));
                PyList::new(py, tables.collect::<PyResult<Vec<_>>>()?)?.into_any()
            }
        };
        dict.set_item(key, value)?;
    }
    Ok(dict)
}

fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => text.value().into_pyobject(py)?.into_any(),
        Value::Integer(number) => number.value().into_pyobject(py)?.into_any(),
        Value::Float(number) => number.value().into_pyobject(py)?.into_any(),
        Value::Boolean(flag) => PyBool::new(py, *flag.value()).to_owned().into_any(),
        Value::Datetime(time) => time.value().to_string().into_pyobject(py)?.into_any(),
        Value::Array(values) => {
            let values = values.iter().map(|value| object(py, value));
            PyList::new(py, values.collect::<PyResult<Vec<_>>>()?)?.into_any()
        }
        Value::InlineTable(table) => dictionary(py, table)?.into_any(),
    })
}

/// A dictionary as a text in TOML: numbers to the last bit, keys in their order. Tuples and arrays are lists, and what is
/// `None` is left out.
///
/// # Errors
/// `TypeError` for what TOML has no word for, with the key.
#[pyfunction]
pub fn write(case: &Bound<'_, PyDict>) -> PyResult<String> {
    Ok(DocumentMut::from(table_of(case, "")?).to_string())
}

/// The keys of a dictionary with their values, those that are `None` left out.
fn entries<'py>(
    dict: &Bound<'py, PyDict>,
    path: &str,
) -> PyResult<Vec<(String, String, Bound<'py, PyAny>)>> {
    let mut all = Vec::new();
    for (key, value) in dict {
        if value.is_none() {
            continue;
        }
        let key: String = key.extract()?;
        let path = match path {
            "" => key.clone(),
            path => format!("{path}.{key}"),
        };
        all.push((key, path, value));
    }
    Ok(all)
}

fn table_of(dict: &Bound<'_, PyDict>, path: &str) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, path, value) in entries(dict, path)? {
        table.insert(&key, item_of(&value, &path)?);
    }
    Ok(table)
}

fn item_of(object: &Bound<'_, PyAny>, path: &str) -> PyResult<Item> {
    if let Ok(dict) = object.cast::<PyDict>() {
        return Ok(Item::Table(table_of(dict, path)?));
    }
    if let Ok(list) = object.cast::<PyList>()
        && !list.is_empty()
        && list.iter().all(|one| one.is_instance_of::<PyDict>())
    {
        let mut tables = ArrayOfTables::new();
        for (at, one) in list.iter().enumerate() {
            let dict = one.cast::<PyDict>()?;
            tables.push(table_of(dict, &format!("{path}[{at}]"))?);
        }
        return Ok(Item::ArrayOfTables(tables));
    }
    value_of(object, path).map(Item::Value)
}

fn value_of(object: &Bound<'_, PyAny>, path: &str) -> PyResult<Value> {
    if let Ok(flag) = object.cast::<PyBool>() {
        return Ok(flag.is_true().into());
    }
    if let Ok(dict) = object.cast::<PyDict>() {
        let mut table = InlineTable::new();
        for (key, path, value) in entries(dict, path)? {
            table.insert(&key, value_of(&value, &path)?);
        }
        return Ok(Value::InlineTable(table));
    }
    if let Ok(text) = object.cast::<PyString>() {
        return Ok(text.extract::<String>()?.into());
    }
    if object.is_instance_of::<PyInt>() {
        let number: i64 = object.extract().map_err(|_| {
            PyValueError::new_err(format!("{path}: {object} is beyond what a case can have"))
        })?;
        return Ok(number.into());
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(object.extract::<f64>()?.into());
    }
    // scalars and arrays of numpy
    if object.hasattr("tolist")? {
        return value_of(&object.call_method0("tolist")?, path);
    }
    let Ok(items) = object.try_iter() else {
        let kind = object.get_type().name()?;
        return Err(PyTypeError::new_err(format!(
            "{path}: a case has no value of the type {kind}"
        )));
    };
    let mut array = Array::new();
    for (at, item) in items.enumerate() {
        array.push(value_of(&item?, &format!("{path}[{at}]"))?);
    }
    Ok(Value::Array(array))
}
