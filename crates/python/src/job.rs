//! What is to be solved: a case as text, the mesh in memory, physics of the program.

use crate::diagnostics::{exception, list};
use crate::mesh::Mesh;
use crate::own::{self, Failures};
use crate::worker::supervised;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use signorini::{
    Compat, Diagnostics, Loaded as Read, Model, Own, Reading, Source, build_with, open_text,
    preview,
};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// A case with all that belongs to it.
#[pyclass(frozen, module = "signorini._native")]
pub struct Job {
    text: String,
    record: Option<String>,
    name: String,
    /// Where the case would lie: next to what its paths are relative to.
    path: PathBuf,
    mesh: Option<Arc<signorini_geometry::mesh::Mesh>>,
    set: Vec<(String, String)>,
    own: Own,
    /// What functions of the user raised.
    pub failures: Failures,
}

/// A model, and where it comes from.
pub struct Built {
    pub model: Model,
    pub source: Source,
    pub warnings: Diagnostics,
    /// Seconds for reading, and for building.
    pub seconds: [f64; 2],
}

/// What messages call a case: it is no file, and its lines are those of its text in TOML.
const SHOWN: &str = "the case in Python";

/// What a case says of a mesh in memory: the last lines, so that those before keep their numbers.
const IN_MEMORY: &str = "\n[mesh]\nfile = \"the mesh in memory\"\n";

#[pymethods]
impl Job {
    /// `text` is the case in TOML, without its mesh where that is in memory; `record` is the whole case then, the mesh in it,
    /// which a folder of results keeps. `name` is what the case is called, `folder` what paths in it
    /// are relative to; `own` holds physics by kind and name; `set` changes the case as `--set` does.
    #[new]
    #[pyo3(signature = (text, name, folder, mesh = None, record = None, own = None, set = Vec::new()))]
    fn new(
        text: String,
        name: &str,
        folder: PathBuf,
        mesh: Option<PyRef<'_, Mesh>>,
        record: Option<String>,
        own: Option<&Bound<'_, PyDict>>,
        set: Vec<(String, String)>,
    ) -> PyResult<Self> {
        let failures = Failures::default();
        let own = own
            .map(|objects| own::own(objects, &failures))
            .transpose()?;
        Ok(Self {
            text,
            record,
            path: folder.join(format!("{name}.toml")),
            name: name.to_owned(),
            mesh: mesh.map(|mesh| Arc::clone(&mesh.inner)),
            set,
            own: own.unwrap_or_default(),
            failures,
        })
    }
}

impl Job {
    /// The physics that it brings.
    pub fn own(&self) -> Own {
        self.own.clone()
    }

    /// Reads and builds.
    pub fn build(&self) -> Result<Built, Diagnostics> {
        let clock = Instant::now();
        let loaded = self.read()?;
        let read = clock.elapsed().as_secs_f64();
        let name = loaded.source.name.clone();
        let built = build_with(loaded.case, loaded.mesh, &self.own);
        let mut model = match built {
            Ok(model) => model,
            Err(found) => {
                let mut all = loaded.warnings;
                all.append(found);
                return Err(all);
            }
        };
        model.name = name;
        Ok(Built {
            model,
            source: loaded.source,
            warnings: loaded.warnings,
            seconds: [read, clock.elapsed().as_secs_f64() - read],
        })
    }

    fn read(&self) -> Result<Read, Diagnostics> {
        let reading = Reading {
            set: self.set.clone(),
            compat: None,
        };
        let mut text = self.text.clone();
        if self.mesh.is_some() {
            text.push_str(IN_MEMORY);
        }
        let mut opened = open_text(Path::new(SHOWN), text.into_bytes(), &reading)?;
        let source = &mut opened.source;
        source.name.clone_from(&self.name);
        source.folder = self
            .path
            .parent()
            .map_or_else(PathBuf::new, Path::to_path_buf);
        source.path.clone_from(&self.path);
        if let Some(input) = source.inputs.first_mut() {
            input.path = self.path.display().to_string();
        }
        match &self.mesh {
            Some(mesh) => {
                let record = self.record.as_ref().unwrap_or(&self.text);
                opened.over(mesh.as_ref().clone(), record.clone().into_bytes())
            }
            None => opened.with_mesh(),
        }
    }
}

/// A case, or a deck as a case, that was read from a file.
#[pyclass(frozen, get_all, module = "signorini._native")]
pub struct Loaded {
    /// The case in TOML; a deck as a case would say it.
    text: String,
    /// Its mesh.
    mesh: Py<Mesh>,
    /// The file of the mesh, where it has one of its own.
    mesh_file: Option<PathBuf>,
    /// The folder that paths in the case are relative to.
    folder: PathBuf,
    /// What is unusual.
    diagnostics: Py<PyList>,
}

/// Reads a case, `.toml`, or a deck, `.inp` or `.in`, with its mesh. `compat` says whose laws hold in a deck: `"none"`,
/// `"ccx"`, `"oofem"`.
///
/// Errors: `InputError` with all faults at once.
#[pyfunction]
#[pyo3(signature = (path, set = Vec::new(), compat = None))]
pub fn load(
    py: Python<'_>,
    path: PathBuf,
    set: Vec<(String, String)>,
    compat: Option<&str>,
) -> PyResult<Loaded> {
    let compat = compat.map(compat_of).transpose()?;
    let reading = Reading { set, compat };
    let loaded = supervised(py, |_| signorini::load(&path, &reading))?;
    let loaded = loaded.map_err(|found| exception(py, &found))?;
    let mesh = Mesh {
        inner: Arc::new(loaded.mesh),
    };
    Ok(Loaded {
        text: String::from_utf8_lossy(&loaded.source.text).into_owned(),
        mesh: Py::new(py, mesh)?,
        mesh_file: loaded.source.mesh,
        folder: loaded.source.folder,
        diagnostics: list(py, &loaded.warnings)?.unbind(),
    })
}

fn compat_of(word: &str) -> PyResult<Compat> {
    Ok(match word {
        "none" => Compat::None,
        "ccx" => Compat::Ccx,
        "oofem" => Compat::Oofem,
        other => {
            let message = format!("compat is \"none\", \"ccx\" or \"oofem\", not {other:?}");
            return Err(pyo3::exceptions::PyValueError::new_err(message));
        }
    })
}

/// Looks at a case without solving it: the lines that the command `check` prints, and what is unusual.
///
/// Errors: `InputError`, `ModelError` with all faults at once.
#[pyfunction]
pub fn check<'py>(py: Python<'py>, job: &Job) -> PyResult<(Vec<String>, Bound<'py, PyList>)> {
    let looked = supervised(py, |_| {
        let mut built = job.build()?;
        let mut found = std::mem::take(&mut built.warnings);
        found.append(std::mem::take(&mut built.model.warnings));
        signorini::run::check_output(&built.model)?;
        let preview = preview::preview(&mut built.model)?;
        Ok((preview.lines, found))
    })?;
    let (lines, found) = looked.map_err(|found| exception(py, &found))?;
    Ok((lines, list(py, &found)?))
}

/// The JSON schema of a case.
#[pyfunction]
pub fn schema() -> PyResult<String> {
    let schema = signorini_io::case::schema(signorini::vocabulary());
    serde_json::to_string(&schema)
        .map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))
}
