//! A mesh, as the library has it.

use crate::diagnostics::{exception, list};
use crate::view::{components, view};
use crate::vtu::rows;
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use signorini::{Diagnostic, Diagnostics};
use signorini_geometry::element::{TABLE, by_name};
use signorini_geometry::mesh::{self, CellId, Face, Set};
use signorini_geometry::tensor::Vec3;
use signorini_io::diagnostic::{Severity, codes};
use signorini_io::readers::read_mesh;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Nodes, cells and named sets; it never changes.
#[pyclass(frozen, module = "signorini._native")]
pub struct Mesh {
    pub inner: Arc<mesh::Mesh>,
}

/// A name of an element, its cells and their numbers.
type BlockArrays<'py> = (
    String,
    PyReadonlyArray2<'py, i64>,
    Option<PyReadonlyArray1<'py, u64>>,
);

/// The nodes, cells and faces of a set.
type SetArrays<'py> = (
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray2<'py, i64>,
    PyReadonlyArray2<'py, i64>,
);

fn wrong(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}

#[pymethods]
impl Mesh {
    /// From points (n, 3), the numbers of the nodes (from 1 where there are none), blocks `(element, cells, numbers)` with
    /// nodes counted from 0, and sets by name: `(nodes, cells [block, index], faces [block, index, side])`.
    ///
    /// Errors: `ValueError` for an element that is not known, a node or a cell that is not there.
    #[new]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        node_labels: Option<PyReadonlyArray1<'_, u64>>,
        blocks: Vec<BlockArrays<'_>>,
        sets: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let points = points.as_array();
        if points.ncols() != 3 {
            return Err(wrong(format!(
                "points have 3 coordinates, not {}",
                points.ncols()
            )));
        }
        let mut new = mesh::Mesh {
            points: points
                .rows()
                .into_iter()
                .map(|x| Vec3::new(x[0], x[1], x[2]))
                .collect(),
            ..mesh::Mesh::default()
        };
        new.node_labels = match node_labels {
            Some(labels) => labels.as_array().to_vec(),
            None => (1..=new.points.len() as u64).collect(),
        };
        if new.node_labels.len() != new.points.len() {
            return Err(wrong("there are as many numbers of nodes as points"));
        }
        let mut next = 1;
        for (name, cells, labels) in blocks {
            next = push_block(&mut new, &name, &cells, labels, next)?;
        }
        for (name, value) in sets {
            let name: String = name.extract()?;
            let set = set_of(&new, &name, &value.extract()?)?;
            new.sets.insert(name, set);
        }
        Ok(Self {
            inner: Arc::new(new),
        })
    }

    /// Reads a file of any format that is known: the mesh, and what is unusual in it.
    ///
    /// Errors: `OSError` for a file that cannot be read, `InputError` for a damaged one.
    #[staticmethod]
    fn read<'py>(py: Python<'py>, path: &str) -> PyResult<(Self, Bound<'py, PyList>)> {
        let bytes = std::fs::read(path).map_err(|error| {
            // of the class that fits the number, such as `FileNotFoundError`, with the name of the file
            PyOSError::new_err((error.raw_os_error(), error.to_string(), path.to_owned()))
        })?;
        let read = py.detach(|| read_mesh(path, &bytes));
        let (mesh, notes) = read.map_err(|error| {
            exception(
                py,
                &Diagnostic::error(&codes::BAD_MESH, error.to_string()).into(),
            )
        })?;
        let mut found = Diagnostics::new();
        for note in notes {
            found.push(Diagnostic::new(Severity::Note, &codes::MESH_NOTE, note));
        }
        let mesh = Self {
            inner: Arc::new(mesh),
        };
        Ok((mesh, list(py, &found)?))
    }

    /// Positions of the nodes, (n, 3).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        view(py, &self.inner, Some(3), |mesh| components(&mesh.points))
    }

    /// The numbers of the nodes in the input, (n,).
    #[getter]
    fn node_labels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        view(py, &self.inner, None, |mesh| &mesh.node_labels)
    }

    /// The cells, block by block: name of the element, nodes counted from 0 (m, k), numbers in the input (m,).
    #[getter]
    fn blocks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let mut blocks = Vec::new();
        for (at, block) in self.inner.blocks.iter().enumerate() {
            let columns = Some(block.element.nnode());
            let nodes = view(py, &self.inner, columns, |mesh| {
                mesh.blocks.get(at).map_or(&[][..], |block| &block.nodes)
            })?;
            let labels = view(py, &self.inner, None, |mesh| {
                mesh.blocks.get(at).map_or(&[][..], |block| &block.labels)
            })?;
            blocks.push((block.element.name(), nodes, labels));
        }
        PyList::new(py, blocks)
    }

    /// The named sets: nodes (a,), cells (b, 2) [block, index], faces (c, 3) [block, index, side].
    #[getter]
    fn sets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sets = PyDict::new(py);
        for (name, set) in &self.inner.sets {
            let nodes = set.nodes.iter().map(|&node| i64::from(node)).collect();
            let cells = set
                .cells
                .iter()
                .flat_map(|&cell| numbers_of(cell))
                .collect();
            let arrays = (
                rows(py, nodes, 1)?,
                rows(py, cells, 2)?,
                faces_of(py, &set.faces)?,
            );
            sets.set_item(name, arrays)?;
        }
        Ok(sets)
    }

    /// The outer faces of the solids (f, 3) [block, index, side], the means of their corners (f, 3), and their unit normals
    /// (f, 3), which point outwards.
    fn boundary<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let mesh = &self.inner;
        let (faces, centers, normals) = py.detach(|| {
            let faces = mesh::boundary(mesh, mesh.cells(mesh.dim()));
            let shapes = faces.iter().map(|&face| center_and_normal(mesh, face));
            let (centers, normals): (Vec<Vec3>, Vec<Vec3>) = shapes.unzip();
            (faces, centers, normals)
        });
        let flat = |vectors: &[Vec3]| rows(py, components(vectors).to_vec(), 3);
        Ok((faces_of(py, &faces)?, flat(&centers)?, flat(&normals)?))
    }

    /// The nodes of faces (f, 3), each as an array, in the order that makes its normal point outwards.
    fn face_nodes<'py>(
        &self,
        py: Python<'py>,
        faces: PyReadonlyArray2<'py, i64>,
    ) -> PyResult<Bound<'py, PyList>> {
        let mut all = Vec::new();
        for face in read_faces(&self.inner, "faces", &faces)? {
            let (_, nodes) = self
                .inner
                .face(face)
                .ok_or_else(|| wrong("there is no such face"))?;
            all.push(PyArray1::from_iter(py, nodes.into_iter().map(i64::from)));
        }
        PyList::new(py, all)
    }

    /// The mesh as the beginning of a case: `[mesh]` in place, and its sets in `[sets]`.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| inline(&self.inner))
            .map_err(PyValueError::new_err)
    }

    fn __repr__(&self) -> String {
        format!(
            "<Mesh of {} nodes and {} cells>",
            self.inner.nnode(),
            self.inner.ncell()
        )
    }
}

fn push_block(
    mesh: &mut mesh::Mesh,
    name: &str,
    cells: &PyReadonlyArray2<'_, i64>,
    labels: Option<PyReadonlyArray1<'_, u64>>,
    first: u64,
) -> PyResult<u64> {
    let element = by_name(name).ok_or_else(|| {
        let known = TABLE.map(|element| element.name()).join(", ");
        wrong(format!("no element is called {name:?}; there are {known}"))
    })?;
    let cells = cells.as_array();
    if cells.ncols() != element.nnode() {
        let (found, wanted) = (cells.ncols(), element.nnode());
        return Err(wrong(format!(
            "cells of {name} have {wanted} nodes, not {found}"
        )));
    }
    let labels = match labels {
        Some(labels) => labels.as_array().to_vec(),
        None => (first..first + cells.nrows() as u64).collect(),
    };
    if labels.len() != cells.nrows() {
        return Err(wrong(format!(
            "there are as many numbers as cells of {name}"
        )));
    }
    let nnode = mesh.points.len();
    let mut nodes = Vec::with_capacity(element.nnode());
    for (cell, &label) in cells.rows().into_iter().zip(&labels) {
        nodes.clear();
        for &node in cell {
            let found = u32::try_from(node)
                .ok()
                .filter(|&node| (node as usize) < nnode);
            let node = found.ok_or_else(|| {
                wrong(format!(
                    "cell {label} of {name} has node {node}; there are nodes 0 to {}",
                    nnode.max(1) - 1
                ))
            })?;
            nodes.push(node);
        }
        mesh.push_cell(element, &nodes, label);
    }
    Ok(labels
        .iter()
        .max()
        .map_or(first, |last| first.max(last + 1)))
}

fn set_of(mesh: &mesh::Mesh, name: &str, (nodes, cells, faces): &SetArrays<'_>) -> PyResult<Set> {
    let mut set = Set::default();
    for &node in nodes.as_array() {
        let found = u32::try_from(node)
            .ok()
            .filter(|&node| (node as usize) < mesh.points.len());
        set.nodes
            .push(found.ok_or_else(|| wrong(format!("set {name:?}: there is no node {node}")))?);
    }
    for row in cells.as_array().rows() {
        let [block, index] = [0, 1].map(|k| row.get(k).copied().unwrap_or(-1));
        let cell = cell_of(mesh, block, index);
        set.cells.push(cell.ok_or_else(|| {
            wrong(format!(
                "set {name:?}: there is no cell {index} in block {block}"
            ))
        })?);
    }
    set.faces = read_faces(mesh, name, faces)?;
    Ok(set)
}

fn cell_of(mesh: &mesh::Mesh, block: i64, index: i64) -> Option<CellId> {
    let cell = CellId {
        block: u32::try_from(block).ok()?,
        index: u32::try_from(index).ok()?,
    };
    mesh.cell_label(cell).map(|_| cell)
}

fn read_faces(
    mesh: &mesh::Mesh,
    name: &str,
    faces: &PyReadonlyArray2<'_, i64>,
) -> PyResult<Vec<Face>> {
    let mut read = Vec::new();
    for row in faces.as_array().rows() {
        let [block, index, side] = [0, 1, 2].map(|k| row.get(k).copied().unwrap_or(-1));
        let face = cell_of(mesh, block, index).and_then(|cell| {
            let side = u8::try_from(side).ok()?;
            let nside = mesh.element(cell)?.sides().len();
            (usize::from(side) < nside).then_some(Face { cell, side })
        });
        read.push(face.ok_or_else(|| {
            wrong(format!(
                "{name:?}: there is no side {side} of cell {index} in block {block}"
            ))
        })?);
    }
    Ok(read)
}

fn numbers_of(cell: CellId) -> [i64; 2] {
    [i64::from(cell.block), i64::from(cell.index)]
}

fn faces_of<'py>(py: Python<'py>, faces: &[Face]) -> PyResult<Bound<'py, PyAny>> {
    let row = |face: &Face| {
        let [block, index] = numbers_of(face.cell);
        [block, index, i64::from(face.side)]
    };
    rows(py, faces.iter().flat_map(row).collect(), 3)
}

/// The mean of the corners of a face, and its unit normal by Newell's formula: half the sum of the cross products of
/// successive corners.
fn center_and_normal(mesh: &mesh::Mesh, face: Face) -> (Vec3, Vec3) {
    let Some((element, nodes)) = mesh.face(face) else {
        return Default::default();
    };
    let corners = nodes.iter().take(element.ncorner());
    let corners: Vec<Vec3> = corners
        .filter_map(|&node| mesh.points.get(node as usize).copied())
        .collect();
    let sum = corners.iter().fold(Vec3::ZERO, |sum, &x| sum + x);
    let center = sum / corners.len().max(1) as f64;
    let normal = match corners.as_slice() {
        &[from, to] => {
            let along = to - from;
            Vec3::new(along.y, -along.x, 0.0)
        }
        _ => {
            let next = corners.iter().cycle().skip(1);
            let pairs = corners.iter().zip(next);
            pairs.fold(Vec3::ZERO, |sum, (&a, &b)| {
                sum + (a - center).cross(b - center)
            })
        }
    };
    (center, normal.normalized().unwrap_or_default())
}

/// Sets of cells by the cells in them, of sets with cells of a lower dimension than the solids: those are groups of
/// elements, as a list of elements names solids only. None where a cell is in two of them.
fn groups(mesh: &mesh::Mesh) -> Option<BTreeMap<CellId, &str>> {
    let dim = mesh.dim();
    let is_lower = |cell: &CellId| {
        mesh.element(*cell)
            .is_some_and(|element| element.dim() < dim)
    };
    let mut groups = BTreeMap::new();
    for (name, set) in &mesh.sets {
        if set.cells.iter().any(is_lower) {
            for &cell in &set.cells {
                if groups.insert(cell, name.as_str()).is_some() {
                    return None;
                }
            }
        }
    }
    Some(groups)
}

/// `[mesh]` and `[sets]`.
fn inline(mesh: &mesh::Mesh) -> Result<String, String> {
    let groups = groups(mesh)
        .ok_or("a cell of a surface is in two sets: make sets of faces, with `Mesh.surfaces`")?;
    let mut lines = vec!["[mesh]".to_owned(), "nodes = [".to_owned()];
    let nodes = mesh.node_labels.iter().zip(&mesh.points);
    lines.extend(nodes.map(|(label, x)| format!("  [{label}, {:?}, {:?}, {:?}],", x.x, x.y, x.z)));
    lines.push("]\nelements = [".to_owned());
    for (number, block) in (0..).zip(&mesh.blocks) {
        let name = block.element.name();
        for (index, label) in (0..).zip(&block.labels) {
            let cell = CellId {
                block: number,
                index,
            };
            let nodes = mesh.cell(cell).iter();
            let nodes = nodes.filter_map(|&node| mesh.node_labels.get(node as usize));
            let nodes = nodes.map(u64::to_string).collect::<Vec<_>>().join(", ");
            let group = groups
                .get(&cell)
                .map(|group| format!("group = {}, ", quoted(group)));
            let group = group.unwrap_or_default();
            lines.push(format!(
                "  {{ id = {label}, type = \"{name}\", {group}nodes = [{nodes}] }},"
            ));
        }
    }
    lines.push("]\n\n[sets]".to_owned());
    let grouped: BTreeSet<&str> = groups.values().copied().collect();
    for (name, set) in &mesh.sets {
        inline_set(&mut lines, mesh, name, set, grouped.contains(name.as_str()));
    }
    lines.push(String::new());
    Ok(lines.join("\n"))
}

fn quoted(text: &str) -> String {
    toml_edit::Value::from(text).to_string()
}

/// The lines of a set, whose cells are a group of elements already or not.
fn inline_set(lines: &mut Vec<String>, mesh: &mesh::Mesh, name: &str, set: &Set, grouped: bool) {
    let nodes = set
        .nodes
        .iter()
        .filter_map(|&node| mesh.node_labels.get(node as usize));
    let nodes: Vec<String> = nodes.map(u64::to_string).collect();
    let cells = set.cells.iter().filter(|_| !grouped);
    let cells = cells.filter_map(|&cell| mesh.cell_label(cell));
    let cells: Vec<String> = cells.map(|label| label.to_string()).collect();
    let faces = set.faces.iter().filter_map(|face| {
        let label = mesh.cell_label(face.cell)?;
        Some(format!("[{label}, \"S{}\"]", u32::from(face.side) + 1))
    });
    let faces: Vec<String> = faces.collect();
    let parts: Vec<(&str, Vec<String>)> = [("nodes", nodes), ("elements", cells), ("faces", faces)]
        .into_iter()
        .filter(|(_, content)| !content.is_empty())
        .collect();
    if let ([(key, content)], false) = (parts.as_slice(), grouped) {
        lines.push(format!(
            "{} = {{ {key} = [{}] }}",
            quoted(name),
            content.join(", ")
        ));
        return;
    }
    // a set of several kinds is the union of one of each
    let mut names = Vec::new();
    for (key, content) in &parts {
        let part = quoted(&format!("{name} {key}"));
        lines.push(format!("{part} = {{ {key} = [{}] }}", content.join(", ")));
        names.push(part);
    }
    if grouped && !names.is_empty() {
        names.push(quoted(name));
    }
    if !names.is_empty() {
        lines.push(format!(
            "{} = {{ union = [{}] }}",
            quoted(name),
            names.join(", ")
        ));
    }
}
