//! What a file of results has to compare.

use super::Table;
use crate::readers::{LineError, csv, dat, frd};
use crate::vtk::{self, Array, Vtu, VtuReadError};
use std::collections::BTreeMap;

/// Why a file cannot be compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// Not a file of results.
    #[error("{name}: only {known} files and folders of results can be compared")]
    UnknownKind {
        /// The file.
        name: String,
        /// What can be.
        known: String,
    },
    /// A line that cannot be read.
    #[error("{name}, {error}")]
    Line {
        /// The file.
        name: String,
        /// Where and why.
        error: LineError,
    },
    /// A grid that cannot be read.
    #[error("{name}: {error}")]
    Vtu {
        /// The file.
        name: String,
        /// Why.
        error: VtuReadError,
    },
}

/// Turns bytes into tables; `name` appears in messages.
type Reader = fn(&str, &[u8]) -> Result<Vec<Table>, CompareError>;

/// What can be compared, by extension.
pub const KINDS: [(&str, Reader); 4] = [
    ("dat", of_dat),
    ("frd", of_frd),
    ("csv", of_csv),
    ("vtu", of_vtu),
];

/// Columns of a table that identify the row.
const ROW_COLUMNS: [&str; 6] = [
    "increment",
    "attempt",
    "iteration",
    "node",
    "element",
    "point",
];

/// In the names of tables of points inside faces in contact.
const OF_FACES: &str = "(slave element+face";

/// The column that names the step.
const STEP_COLUMN: &str = "step";

/// A column for what a row took, not what came out.
const EFFORT_COLUMN: &str = "iterations";

/// The extension that a file of results has; `.ref` behind it does not count.
fn extension(name: &str) -> String {
    let name = name.to_lowercase();
    let name = name.strip_suffix(".ref").unwrap_or(&name);
    name.rsplit_once('.').map_or("", |(_, e)| e).to_owned()
}

/// The tables of a file of this name.
///
/// # Errors
/// A kind that [`KINDS`] does not list; any fault in the file.
pub fn tables(name: &str, bytes: &[u8]) -> Result<Vec<Table>, CompareError> {
    let own = extension(name);
    match KINDS.iter().find(|(known, _)| *known == own) {
        Some((_, reader)) => reader(name, bytes),
        None => Err(CompareError::UnknownKind {
            name: name.into(),
            known: KINDS.map(|(known, _)| format!(".{known}")).join(", "),
        }),
    }
}

fn of_dat(name: &str, bytes: &[u8]) -> Result<Vec<Table>, CompareError> {
    let blocks = dat::parse(bytes).map_err(|error| CompareError::Line {
        name: name.into(),
        error,
    })?;
    let table = |block: dat::Block| {
        let mut columns: Vec<String> = block.components().iter().map(ToString::to_string).collect();
        if columns.len() != block.nvalue {
            columns = (1..=block.nvalue).map(|k| format!("column {k}")).collect();
        }
        Table {
            name: block.name(),
            time: block.time,
            nid: block.nid,
            columns,
            ids: block.ids,
            values: block.values,
        }
    };
    let tables = blocks.into_iter().map(table);
    Ok(tables.map(over_faces).collect())
}

/// Of tables of the points inside faces, which no identifier distinguishes, one row for each face: the sum of energies, the
/// mean of everything else.
fn over_faces(table: Table) -> Table {
    if !table.name.contains(OF_FACES) {
        return table;
    }
    let adds_up = table.name.contains("energy");
    let width = table.columns.len();
    let mut sums: BTreeMap<&[i64], (f64, Vec<f64>)> = BTreeMap::new();
    for row in 0..table.nrow() {
        let zeros = || (0.0, vec![0.0; width]);
        let (count, sum) = sums.entry(table.ids_of(row)).or_insert_with(zeros);
        *count += 1.0;
        for (column, to) in sum.iter_mut().enumerate() {
            *to += table.value(row, column);
        }
    }
    let ids = sums.keys().flat_map(|ids| ids.iter().copied()).collect();
    let share = |count: f64| if adds_up { 1.0 } else { count };
    let means = sums
        .values()
        .flat_map(|(count, sum)| sum.iter().map(|value| value / share(*count)));
    let values = means.collect();
    Table {
        ids,
        values,
        ..table
    }
}

fn of_frd(name: &str, bytes: &[u8]) -> Result<Vec<Table>, CompareError> {
    let frd = frd::parse(bytes).map_err(|error| CompareError::Line {
        name: name.into(),
        error,
    })?;
    let mut all = vec![nodes(&frd.node_labels, &frd.points)];
    let cells = (0..frd.types.len()).map(|k| {
        let kind = frd.types.get(k).copied().unwrap_or(0);
        let label = frd.element_labels.get(k).copied().unwrap_or(0);
        (kind, id(label), frd.nodes_of(k).iter().map(|&n| id(n)))
    });
    all.extend(elements(cells));
    all.extend(frd.datasets.into_iter().map(|one| Table {
        name: one.name,
        time: Some(one.time),
        nid: 1,
        ids: one.nodes.iter().map(|&n| id(n)).collect(),
        columns: one.components,
        values: one.values,
    }));
    Ok(all)
}

fn id(label: u64) -> i64 {
    i64::try_from(label).unwrap_or(i64::MAX)
}

/// The table of the nodes' coordinates.
fn nodes(labels: &[u64], points: &[[f64; 3]]) -> Table {
    Table {
        name: "nodes".into(),
        nid: 1,
        ids: labels.iter().map(|&n| id(n)).collect(),
        columns: ["x", "y", "z"].map(String::from).to_vec(),
        values: points.as_flattened().to_vec(),
        time: None,
    }
}

/// Tables of elements, one for each type and number of nodes: nothing but identifiers.
fn elements(
    cells: impl Iterator<Item = (u64, i64, impl ExactSizeIterator<Item = i64>)>,
) -> Vec<Table> {
    let mut by_type: BTreeMap<(u64, usize), Vec<i64>> = BTreeMap::new();
    for (kind, label, nodes) in cells {
        let ids = by_type.entry((kind, nodes.len())).or_default();
        ids.push(label);
        ids.extend(nodes);
    }
    let table = |((kind, nnode), ids)| Table {
        name: format!("elements of type {kind}"),
        nid: 1 + nnode,
        ids,
        ..Table::default()
    };
    by_type.into_iter().map(table).collect()
}

fn of_vtu(name: &str, bytes: &[u8]) -> Result<Vec<Table>, CompareError> {
    let grid = vtk::read(bytes).map_err(|error| CompareError::Vtu {
        name: name.into(),
        error,
    })?;
    let node_ids = numbers(grid.point_field("node_id"), grid.points.len());
    let cell_ids = numbers(grid.cell_field("element_id"), grid.types.len());
    let mut all = vec![Table {
        name: "nodes".into(),
        nid: 1,
        ids: node_ids.clone(),
        columns: ["x", "y", "z"].map(String::from).to_vec(),
        values: grid.points.as_flattened().to_vec(),
        time: None,
    }];
    all.extend(elements(cells_of(&grid, &node_ids, &cell_ids)));
    let at_nodes = grid
        .point_data
        .iter()
        .map(|array| (array, "at nodes", &node_ids));
    let in_cells = grid
        .cell_data
        .iter()
        .map(|array| (array, "in cells", &cell_ids));
    for (array, place, ids) in at_nodes.chain(in_cells) {
        if array.name != "node_id" && array.name != "element_id" {
            all.push(Table {
                name: format!("{} {place}", array.name),
                time: None,
                nid: 1,
                ids: ids.clone(),
                columns: column_names(array),
                values: array.numbers.to_f64(),
            });
        }
    }
    if let Some(time) = grid.time() {
        all.push(Table {
            name: "time".into(),
            columns: vec!["time".into()],
            values: vec![time],
            ..Table::default()
        });
    }
    Ok(all)
}

fn cells_of<'a>(
    grid: &'a Vtu,
    node_ids: &'a [i64],
    cell_ids: &'a [i64],
) -> impl Iterator<Item = (u64, i64, impl ExactSizeIterator<Item = i64> + 'a)> + 'a {
    let ends = grid.offsets.windows(2);
    grid.types
        .iter()
        .zip(cell_ids)
        .zip(ends)
        .map(|((&kind, &label), ends)| {
            let nodes = match ends {
                &[start, end] => grid.connectivity.get(start..end).unwrap_or_default(),
                _ => &[],
            };
            let nodes = nodes
                .iter()
                .map(|&n| node_ids.get(n).copied().unwrap_or(-1));
            (u64::from(kind), label, nodes)
        })
}

/// The numbers in an array, without one those from 0 on.
fn numbers(array: Option<&Array>, count: usize) -> Vec<i64> {
    let given = array.and_then(|array| array.numbers.to_i64());
    let given = given.filter(|given| given.len() == count);
    given.unwrap_or_else(|| (0..count as i64).collect())
}

fn column_names(array: &Array) -> Vec<String> {
    if array.component_names.len() == array.ncomponent {
        return array.component_names.clone();
    }
    match array.ncomponent {
        1 => vec![array.name.clone()],
        3 => ["x", "y", "z"].map(String::from).to_vec(),
        n => (1..=n).map(|k| format!("component {k}")).collect(),
    }
}

/// A table for every column of numbers, in every step by itself; rows by increment, or by number where there is none.
fn of_csv(name: &str, bytes: &[u8]) -> Result<Vec<Table>, CompareError> {
    let wrong = |line, what| CompareError::Line {
        name: name.into(),
        error: LineError { line, what },
    };
    let text = std::str::from_utf8(bytes).map_err(|_| wrong(1, "the file is no text in UTF-8"))?;
    let mut records = csv::records(text);
    let head = records.next().ok_or(wrong(1, "the file is empty"))?.cells;
    let columns = Columns::new(&head);
    let mut tables: Vec<Table> = Vec::new();
    let (mut step, mut start) = (None, 0);
    for (number, record) in (1..).zip(records) {
        if record.cells.len() != head.len() {
            return Err(wrong(
                record.line,
                "a row has not as many cells as the head",
            ));
        }
        let cell = |k: usize| record.cells.get(k).map_or("", |cell| cell.trim());
        let own = columns.step.map_or("", cell);
        if step.as_deref() != Some(own) {
            start = tables.len();
            tables.extend(columns.tables(&head, own));
            step = Some(own.to_owned());
        }
        for (table, &k) in tables.iter_mut().skip(start).zip(&columns.values) {
            match columns.keys.as_slice() {
                [] => table.ids.push(number),
                keys => table
                    .ids
                    .extend(keys.iter().map(|&k| cell(k).parse().unwrap_or(-1))),
            }
            table.values.push(cell(k).parse().unwrap_or(f64::NAN));
        }
    }
    Ok(tables)
}

/// What the columns of a table of comma-separated values are.
struct Columns {
    step: Option<usize>,
    /// Those that identify the row.
    keys: Vec<usize>,
    values: Vec<usize>,
}

impl Columns {
    fn new(head: &[String]) -> Self {
        let place = |name: &str| head.iter().position(|column| column == name);
        let step = place(STEP_COLUMN);
        let keys: Vec<usize> = ROW_COLUMNS.iter().filter_map(|key| place(key)).collect();
        let is_value = |k: &usize| {
            let is_effort = head.get(*k).is_some_and(|name| name == EFFORT_COLUMN);
            step != Some(*k) && !keys.contains(k) && !is_effort
        };
        Self {
            values: (0..head.len()).filter(is_value).collect(),
            step,
            keys,
        }
    }

    /// Empty tables for the values in a step.
    fn tables(&self, head: &[String], step: &str) -> impl Iterator<Item = Table> {
        let names = self.values.iter().filter_map(|&k| head.get(k));
        names.map(move |name| Table {
            name: match step {
                "" => name.clone(),
                step => format!("{name} in step {step}"),
            },
            nid: self.keys.len().max(1),
            columns: vec![name.clone()],
            ..Table::default()
        })
    }
}
