//! Views of Rust memory as numpy arrays: nothing is copied, nothing can be written.
#![allow(unsafe_code)]

use numpy::ndarray::{ArrayView, IxDyn};
use numpy::{Element, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use signorini_geometry::tensor::Vec3;
use std::any::Any;
use std::sync::Arc;

/// Keeps the memory of a view alive.
#[pyclass(frozen, module = "signorini._native")]
struct Owner {
    _memory: Arc<dyn Any + Send + Sync>,
}

/// A read-only array of what `part` finds in `owner`, in rows of `columns` numbers; flat where there are none.
///
/// # Errors
/// A number of values that makes no whole rows.
pub fn view<'py, K, T>(
    py: Python<'py>,
    owner: &Arc<K>,
    columns: Option<usize>,
    part: impl for<'a> FnOnce(&'a K) -> &'a [T],
) -> PyResult<Bound<'py, PyAny>>
where
    K: Send + Sync + 'static,
    T: Element,
{
    let values = part(owner);
    let shape = match columns {
        Some(columns) => vec![values.len() / columns.max(1), columns],
        None => vec![values.len()],
    };
    let array = ArrayView::from_shape(IxDyn(&shape), values);
    let array =
        array.map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    let keep = Owner {
        _memory: Arc::clone(owner) as Arc<dyn Any + Send + Sync>,
    };
    let container = Bound::new(py, keep)?.into_any();
    // SAFETY: the values are borrowed from what the Arc holds, for `part` can name no shorter life; the container holds that
    // Arc, and what is in it is never changed or moved. The array is made read-only before anybody sees it.
    let view = unsafe { PyArrayDyn::borrow_from_array(&array, container) };
    Ok(view.readwrite().make_nonwriteable().as_any().clone())
}

/// The components of vectors, one after the other.
pub fn components(vectors: &[Vec3]) -> &[f64] {
    const {
        assert!(
            size_of::<Vec3>() == 3 * size_of::<f64>() && align_of::<Vec3>() == align_of::<f64>()
        )
    };
    // SAFETY: a Vec3 is three f64 in a row, `repr(C)` and of that size and alignment, as asserted above.
    unsafe { std::slice::from_raw_parts(vectors.as_ptr().cast(), 3 * vectors.len()) }
}
