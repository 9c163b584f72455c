//! Physics in Python: surfaces, laws, limits of friction, materials and courses, behind the traits of the library.
//!
//! A function of the user may raise an exception where the library expects a number. The first one is kept in [`Failures`];
//! what it spoils is not a number, which no increment converges with, and the run stops at its next news. Functions get
//! arrays of points and are called from the threads of the run, one at a time, as the interpreter has it.

use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use signorini::Own;
use signorini_geometry::surface::{Patch, Shape, SignedDistance, SurfaceError};
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_mechanics::contact::friction::{FrictionLaw, Limit, Sliding};
use signorini_mechanics::contact::law::{ContactLaw, Eval, Scale};
use signorini_mechanics::material::{Material, MaterialError, Order, Response, Strain};
use std::collections::HashMap;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The first exception that a function of the user raised.
#[derive(Clone, Default)]
pub struct Failures {
    inner: Arc<(AtomicBool, Mutex<Option<PyErr>>)>,
}

impl Failures {
    fn put(&self, error: PyErr) {
        let mut first = self.inner.1.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(error);
        self.inner.0.store(true, Ordering::Relaxed);
    }

    /// Whether there is one.
    pub fn any(&self) -> bool {
        self.inner.0.load(Ordering::Relaxed)
    }

    /// Takes it.
    pub fn take(&self) -> Option<PyErr> {
        self.inner.0.store(false, Ordering::Relaxed);
        let mut first = self.inner.1.lock().unwrap_or_else(PoisonError::into_inner);
        first.take()
    }
}

/// An object of Python whose methods are called.
#[derive(Clone)]
struct Called {
    object: Arc<Py<PyAny>>,
    failures: Failures,
}

impl fmt::Debug for Called {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of Python")
    }
}

impl Called {
    /// Calls from Rust; an exception is kept, and there is no answer. After the first exception nothing is called.
    fn ask<T>(&self, call: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<T>) -> Option<T> {
        if self.failures.any() {
            return None;
        }
        Python::attach(|py| match call(self.object.bind(py)) {
            Ok(answer) => Some(answer),
            Err(error) => {
                self.failures.put(error);
                None
            }
        })
    }

    /// An attribute that may be absent, or `None`.
    fn optional<T: for<'a, 'py> FromPyObject<'a, 'py>>(&self, name: &str) -> Option<T> {
        Python::attach(|py| self.object.bind(py).getattr(name).ok()?.extract().ok())
    }
}

fn point<'py>(py: Python<'py>, x: Vec3) -> Bound<'py, PyArray2<f64>> {
    let row = PyArray1::from_slice(py, &x.to_array());
    // of three numbers: it can always be a row
    row.reshape([1, 3])
        .unwrap_or_else(|_| PyArray2::zeros(py, [1, 3], false))
}

/// The first number of an array.
fn first(array: &Bound<'_, PyAny>) -> PyResult<f64> {
    let array: PyReadonlyArray1<'_, f64> = array.extract()?;
    let value = array.as_array().first().copied();
    value.ok_or_else(|| PyValueError::new_err("an array without numbers was returned"))
}

/// The rows of two arrays of `n` numbers.
fn pairs(arrays: &Bound<'_, PyAny>, n: usize) -> PyResult<Vec<[f64; 2]>> {
    let [first, second] = [arrays.get_item(0)?, arrays.get_item(1)?];
    let first: PyReadonlyArray1<'_, f64> = first.extract()?;
    let second: PyReadonlyArray1<'_, f64> = second.extract()?;
    let (first, second) = (first.as_array(), second.as_array());
    if [first.len(), second.len()] != [n, n] {
        return Err(PyValueError::new_err(format!(
            "two arrays of {n} numbers are wanted"
        )));
    }
    let both = first.iter().zip(second.iter());
    Ok(both.map(|(&first, &second)| [first, second]).collect())
}

/// The first row of an array.
fn row<const N: usize>(array: &Bound<'_, PyAny>) -> PyResult<[f64; N]> {
    let array: PyReadonlyArray2<'_, f64> = array.extract()?;
    let mut values = array.as_array().iter().copied().collect::<Vec<f64>>();
    values.truncate(N);
    let found = <[f64; N]>::try_from(values);
    found.map_err(|_| PyValueError::new_err(format!("rows of {N} numbers are wanted")))
}

/// The first matrix of an array.
fn matrix<const N: usize>(array: &Bound<'_, PyAny>) -> PyResult<[[f64; N]; N]> {
    let array: PyReadonlyArray3<'_, f64> = array.extract()?;
    let mut matrix = [[0.0; N]; N];
    let values = array.as_array();
    if values.shape() != [1, N, N] {
        return Err(PyValueError::new_err(format!(
            "matrices of {N} by {N} numbers are wanted"
        )));
    }
    for (at, value) in values.iter().enumerate() {
        if let Some(entry) = matrix.get_mut(at / N).and_then(|row| row.get_mut(at % N)) {
            *entry = *value;
        }
    }
    Ok(matrix)
}

fn symmetric(m: [[f64; 3]; 3]) -> Sym3 {
    let mean = |i: usize, j: usize| 0.5 * (m[i][j] + m[j][i]);
    Sym3::new(
        m[0][0],
        m[1][1],
        m[2][2],
        mean(0, 1),
        mean(1, 2),
        mean(0, 2),
    )
}

/// What the library says where Python raised an exception, which is what the user sees.
const RAISED: &str = "its function raised an exception";

/// A function of a point, which a method of an object answers: once for each point, for searches, rows and audits ask about the
/// same ones.
struct AtPoint<T> {
    called: Called,
    method: &'static str,
    read: fn(&Bound<'_, PyAny>) -> PyResult<T>,
    known: Mutex<HashMap<[u64; 3], T>>,
}

/// How many answers are kept.
const KEPT: usize = 1 << 16;

impl<T: Copy> AtPoint<T> {
    fn new(
        called: &Called,
        method: &'static str,
        read: fn(&Bound<'_, PyAny>) -> PyResult<T>,
    ) -> Self {
        Self {
            called: called.clone(),
            method,
            read,
            known: Mutex::default(),
        }
    }

    fn at(&self, x: Vec3) -> Result<T, String> {
        let key = x.to_array().map(f64::to_bits);
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(&answer) = known().get(&key) {
            return Ok(answer);
        }
        let answer = self.called.ask(|object| {
            (self.read)(&object.call_method1(self.method, (point(object.py(), x),))?)
        });
        let answer = answer.ok_or_else(|| RAISED.to_owned())?;
        let mut known = known();
        if known.len() >= KEPT {
            known.clear();
        }
        known.insert(key, answer);
        Ok(answer)
    }
}

/// `signorini.SignedDistance`.
fn signed_distance(called: &Called) -> PyResult<Arc<dyn Shape>> {
    let value = AtPoint::new(called, "value", first);
    let gradient = AtPoint::new(called, "gradient", row::<3>);
    let hessian = AtPoint::new(called, "hessian", matrix::<3>);
    let shape = SignedDistance::new(
        called.optional("size").unwrap_or(1.0),
        Box::new(move |x| value.at(x)),
        Box::new(move |x| gradient.at(x).map(Vec3::from)),
        Box::new(move |x| hessian.at(x).map(symmetric)),
    );
    let shape = shape.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(match called.optional::<([f64; 3], f64)>("ball") {
        Some((center, radius)) => Arc::new(shape.within(Vec3::from(center), radius)),
        None => Arc::new(shape),
    })
}

/// `signorini.Projection`.
struct Projection {
    closest: AtPoint<[f64; 3]>,
    normal: AtPoint<[f64; 3]>,
    normal_gradient: AtPoint<[[f64; 3]; 3]>,
}

impl fmt::Debug for Projection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Projection").finish_non_exhaustive()
    }
}

impl Projection {
    fn new(called: &Called) -> Self {
        Self {
            closest: AtPoint::new(called, "closest", row::<3>),
            normal: AtPoint::new(called, "normal", row::<3>),
            normal_gradient: AtPoint::new(called, "normal_gradient", matrix::<3>),
        }
    }
}

fn failed(message: String) -> SurfaceError {
    SurfaceError::User { message }
}

impl Shape for Projection {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let on = self.closest.at(point).map(Vec3::from).map_err(failed)?;
        Ok(Some(on).filter(|on| on.is_finite()))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let normal = self.normal.at(on).map(Vec3::from).map_err(failed)?;
        let gradient = self.normal_gradient.at(on).map_err(failed)?;
        let no_length = || failed("a normal has no length".to_owned());
        let normal = normal.normalized().ok_or_else(no_length)?;
        Ok(Patch::smooth(normal, symmetric(gradient)))
    }
}

/// `signorini.ContactLaw`.
#[derive(Debug)]
struct Law {
    name: String,
    called: Called,
    has_energy: bool,
}

/// No number: no increment converges with it.
const SPOILT: f64 = f64::NAN;

impl ContactLaw for Law {
    fn name(&self) -> &str {
        &self.name
    }

    fn pressures(&self, gaps: &[f64], _: &[f64], _: &Scale, out: &mut [Eval]) {
        let answer = self.called.ask(|object| {
            let gaps = PyArray1::from_slice(object.py(), gaps);
            pairs(&object.call_method1("pressure", (gaps,))?, out.len())
        });
        let mut answer = answer.into_iter().flatten();
        for at in out {
            let [value, dgap] = answer.next().unwrap_or([SPOILT; 2]);
            *at = Eval {
                value,
                dgap,
                dlambda: 0.0,
            };
        }
    }

    fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
        if !self.has_energy {
            return None;
        }
        self.called.ask(|object| {
            let gap = PyArray1::from_slice(object.py(), &[gap]);
            first(&object.call_method1("energy", (gap,))?)
        })
    }
}

/// `signorini.FrictionLimit`.
#[derive(Debug)]
struct Friction(Called);

impl FrictionLaw for Friction {
    fn limits(&self, at: &[Sliding], out: &mut [Limit]) {
        let answer = self.0.ask(|object| {
            let array =
                |of: fn(&Sliding) -> f64| PyArray1::from_iter(object.py(), at.iter().map(of));
            let (pressure, path) = (array(|at| at.pressure), array(|at| at.path));
            pairs(&object.call_method1("limit", (pressure, path))?, out.len())
        });
        let mut answer = answer.into_iter().flatten();
        for limit in out {
            let [value, dpressure] = answer.next().unwrap_or([SPOILT; 2]);
            *limit = Limit { value, dpressure };
        }
    }
}

/// `signorini.Material`.
struct Solid {
    called: Called,
    modulus: f64,
    nhistory: usize,
    symmetric: bool,
}

impl Material for Solid {
    fn nhistory(&self) -> usize {
        self.nhistory
    }

    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        _: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let answer = self.called.ask(|object| {
            let py = object.py();
            let components = PyArray2::from_vec2(py, &[strain.value.to_pairs().to_vec()])?;
            let answer = if self.nhistory == 0 {
                object.call_method1("respond", (components,))?
            } else {
                let old = PyArray2::from_vec2(py, &[old.to_vec()])?;
                object.call_method1("respond", (components, old))?
            };
            let stress: [f64; 6] = row(&answer.get_item(0)?)?;
            let tangent: [[f64; 6]; 6] = matrix(&answer.get_item(1)?)?;
            if self.nhistory > 0 {
                let found: PyReadonlyArray2<'_, f64> = answer.get_item(2)?.extract()?;
                for (to, from) in new.iter_mut().zip(found.as_array()) {
                    *to = *from;
                }
            }
            Ok((stress, tangent))
        });
        let spoilt = ([SPOILT; 6], [[SPOILT; 6]; 6]);
        let (stress, tangent) = answer.unwrap_or(spoilt);
        let [xx, yy, zz, xy, yz, xz] = stress;
        out.stress = Sym3::new(xx, yy, zz, xy, yz, xz);
        out.tangent = tangent;
        out.energy = 0.5 * out.stress.double_dot(strain.value);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.modulus
    }

    fn is_symmetric(&self) -> bool {
        self.symmetric
    }
}

/// The physics of a case, by kind and name, as `Case` in Python collects them.
pub fn own(objects: &Bound<'_, PyDict>, failures: &Failures) -> PyResult<Own> {
    let mut own = Own::default();
    for (kind, named) in objects {
        let kind: String = kind.extract()?;
        for (name, object) in named.cast::<PyDict>()? {
            let name: String = name.extract()?;
            let called = Called {
                object: Arc::new(object.clone().unbind()),
                failures: failures.clone(),
            };
            match kind.as_str() {
                "surface" => {
                    let shape: Arc<dyn Shape> = match object.hasattr("closest")? {
                        true => Arc::new(Projection::new(&called)),
                        false => signed_distance(&called)?,
                    };
                    own.surfaces.insert(name, shape);
                }
                "law" => {
                    let has_energy = object
                        .getattr("has_energy")
                        .is_ok_and(|has| has.is_truthy().unwrap_or(false));
                    let law = Law {
                        name: name.clone(),
                        called,
                        has_energy,
                    };
                    own.laws.insert(name, Arc::new(law));
                }
                "friction" => {
                    own.frictions.insert(name, Arc::new(Friction(called)));
                }
                "material" => {
                    let solid = Solid {
                        modulus: object.getattr("modulus")?.extract()?,
                        nhistory: object.getattr("history")?.extract()?,
                        symmetric: object.getattr("symmetric")?.extract()?,
                        called,
                    };
                    own.materials.insert(name, Arc::new(solid));
                }
                "course" => {
                    let course = move |time: f64| {
                        let value = called.ask(|object| object.call1((time,))?.extract::<f64>());
                        value.unwrap_or(SPOILT)
                    };
                    own.courses.insert(name, Arc::new(course));
                }
                other => {
                    return Err(PyTypeError::new_err(format!(
                        "there is no physics of the kind {other:?}"
                    )));
                }
            }
        }
    }
    Ok(own)
}
