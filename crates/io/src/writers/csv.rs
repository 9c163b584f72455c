//! `history.csv` and `convergence.csv`: tables with a fixed header, one row per increment or iteration.
//!
//! Numbers are the shortest decimal that reads back as the same `f64`; names are quoted where RFC 4180 asks for it, with
//! `\n` as the end of a row.

use std::fmt::Write;
use std::path::Path;

use super::rows::{Newlines, RowFile, RowsError};
use crate::fs::Fs;

/// The columns of `convergence.csv`, one row per Newton iteration.
///
/// `residual` is the largest force error over the force scale; `worst_node` the node that has it.
pub const CONVERGENCE_COLUMNS: [&str; 10] = [
    "step",
    "increment",
    "attempt",
    "iteration",
    "residual",
    "correction",
    "line_search",
    "closed",
    "flips",
    "worst_node",
];

/// The first columns of `history.csv`; those of contacts, references and chosen quantities follow.
pub const HISTORY_COLUMNS: [&str; 4] = ["time", "step", "increment", "iterations"];

/// The columns of every contact in `history.csv`, after its name and a dot.
///
/// Forces are those of the primary side on the secondary side, moments about the origin; areas by status; the center is
/// that of the pressure; axes that a plane case does not have are 0.
pub const CONTACT_COLUMNS: [&str; 16] = [
    "force_x",
    "force_y",
    "force_z",
    "moment_x",
    "moment_y",
    "moment_z",
    "pressure_max",
    "gap_min",
    "slip_max",
    "area_open",
    "area_stick",
    "area_slip",
    "center_x",
    "center_y",
    "center_z",
    "work_friction",
];

/// The columns of every contact whose joint may break, after its name and a dot: the energy that damage has taken, and that
/// of the viscosity which delays it.
pub const COHESION_COLUMNS: [&str; 2] = ["work_damage", "work_viscous"];

/// The columns of every contact that conducts, after its name and a dot: heat per time from the secondary side to the primary, and
/// that which friction sets free.
pub const CONDUCTION_COLUMNS: [&str; 2] = ["heat", "heat_friction"];

/// The columns of every reference in `history.csv`, after its name and a dot.
///
/// Forces and moments are what contact exerts on the carrier, about the reference; reactions what supports and prescribed
/// motions do.
pub const REFERENCE_COLUMNS: [&str; 18] = [
    "force_x",
    "force_y",
    "force_z",
    "moment_x",
    "moment_y",
    "moment_z",
    "displacement_x",
    "displacement_y",
    "displacement_z",
    "rotation_x",
    "rotation_y",
    "rotation_z",
    "reaction_force_x",
    "reaction_force_y",
    "reaction_force_z",
    "reaction_moment_x",
    "reaction_moment_y",
    "reaction_moment_z",
];

/// The same in models with inertia: velocity and angular velocity (radian per time), where what moves with it has a mass.
pub const MOVING_REFERENCE_COLUMNS: [&str; 6] = [
    "velocity_x",
    "velocity_y",
    "velocity_z",
    "angular_velocity_x",
    "angular_velocity_y",
    "angular_velocity_z",
];

/// The columns of every reference, after its name and a dot.
#[must_use]
pub fn reference_columns(has_inertia: bool) -> Vec<&'static str> {
    let mut all = REFERENCE_COLUMNS.to_vec();
    if has_inertia {
        all.extend(MOVING_REFERENCE_COLUMNS);
    }
    all
}

/// The columns of energies in `history.csv`, of models with inertia.
///
/// What is there: kinetic, in bodies and springs, in contact. What happened since the start: work of supports and loads, spent in
/// friction and damping, and what the method of going through time has taken away.
pub const ENERGY_COLUMNS: [&str; 7] = [
    "energy.kinetic",
    "energy.internal",
    "energy.contact",
    "energy.external",
    "energy.friction",
    "energy.damping",
    "energy.algorithmic",
];

/// The columns of heat in `history.csv`, of models with steps that find temperatures.
///
/// Into bodies by loads, what holds temperatures, rigid surfaces with a temperature, and friction, and what bodies take up: heat per time in
/// the increment, then heat since the start in transient steps, what bodies take up in steps of all kinds; and what is lost or made in the increment, over the largest of the rates.
pub const HEAT_COLUMNS: [&str; 11] = [
    "heat_rate.loads",
    "heat_rate.supports",
    "heat_rate.surfaces",
    "heat_rate.friction",
    "heat_rate.stored",
    "heat.loads",
    "heat.supports",
    "heat.surfaces",
    "heat.friction",
    "heat.stored",
    "heat.imbalance",
];

/// The columns of `frequencies.csv`, one row per natural mode.
///
/// `time` is that of the state about which they are; `frequency` in cycles per time and `omega` in radian per time, both below zero
/// where that state is not stable; `eigenvalue` is ω².
pub const FREQUENCY_COLUMNS: [&str; 14] = [
    "step",
    "time",
    "mode",
    "frequency",
    "omega",
    "eigenvalue",
    "residual",
    "converged",
    "participation_x",
    "participation_y",
    "participation_z",
    "effective_mass_x",
    "effective_mass_y",
    "effective_mass_z",
];

/// What a model has columns of in `history.csv`, by names.
#[derive(Clone, Copy, Debug, Default)]
pub struct HistoryOf<'a> {
    /// Contacts.
    pub contacts: &'a [&'a str],
    /// References and rigid bodies.
    pub references: &'a [&'a str],
    /// Whether anything moves with inertia.
    pub has_inertia: bool,
    /// Contacts whose joints may break.
    pub breaking: &'a [&'a str],
    /// Whether temperatures are found.
    pub has_heat: bool,
    /// Contacts that conduct where temperatures are found.
    pub conducting: &'a [&'a str],
}

/// The header of `history.csv`: [`HISTORY_COLUMNS`], then contacts, references, [`ENERGY_COLUMNS`], contacts that break, [`HEAT_COLUMNS`],
/// contacts that conduct, and chosen `name.quantity` columns, in the order given.
pub fn history_columns(of: &HistoryOf<'_>, chosen: &[&str]) -> Vec<String> {
    let each = |names: &[&str], columns: &[&str]| -> Vec<String> {
        names
            .iter()
            .flat_map(|name| columns.iter().map(move |column| format!("{name}.{column}")))
            .collect()
    };
    let mut all: Vec<String> = HISTORY_COLUMNS.iter().map(ToString::to_string).collect();
    all.extend(each(of.contacts, &CONTACT_COLUMNS));
    all.extend(each(of.references, &reference_columns(of.has_inertia)));
    if of.has_inertia {
        all.extend(ENERGY_COLUMNS.iter().map(ToString::to_string));
    }
    all.extend(each(of.breaking, &COHESION_COLUMNS));
    if of.has_heat {
        all.extend(HEAT_COLUMNS.iter().map(ToString::to_string));
    }
    all.extend(each(of.conducting, &CONDUCTION_COLUMNS));
    all.extend(chosen.iter().map(ToString::to_string));
    all
}

/// One entry of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// A number; infinities and invalid ones are written as `NaN`, `inf` or `-inf`.
    Real(f64),
    /// A count.
    Count(u64),
    /// A whole number.
    Whole(i64),
    /// A name.
    Text(&'a str),
    /// Nothing.
    Empty,
}

impl From<f64> for Cell<'_> {
    fn from(value: f64) -> Self {
        Cell::Real(value)
    }
}

impl From<u64> for Cell<'_> {
    fn from(value: u64) -> Self {
        Cell::Count(value)
    }
}

impl<'a> From<&'a str> for Cell<'a> {
    fn from(value: &'a str) -> Self {
        Cell::Text(value)
    }
}

/// A growing table.
#[derive(Debug)]
pub struct Table {
    rows: RowFile,
    ncolumn: usize,
}

impl Table {
    /// Starts a table again and writes its header.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn create<S: AsRef<str>>(
        fs: &dyn Fs,
        path: &Path,
        columns: &[S],
    ) -> Result<Self, RowsError> {
        Ok(Self {
            rows: RowFile::create(fs, path, &header(columns))?,
            ncolumn: columns.len(),
        })
    }

    /// Goes on with a table after its first `keep` rows (the header not counted); later rows, whole or torn, are cut off.
    ///
    /// # Errors
    /// [`RowsError::OtherHead`] where the columns differ, [`RowsError::MissingRows`] where there are fewer rows, [`RowsError::Fs`].
    pub fn resume<S: AsRef<str>>(
        fs: &dyn Fs,
        path: &Path,
        columns: &[S],
        keep: u64,
    ) -> Result<Self, RowsError> {
        let rows = RowFile::resume(fs, path, &header(columns), keep, Newlines::Quoted)?;
        Ok(Self {
            rows,
            ncolumn: columns.len(),
        })
    }

    /// Appends a row and hands it to the system at once.
    ///
    /// # Errors
    /// [`RowsError::WrongWidth`], [`RowsError::Fs`]; the row is then not in the table.
    pub fn row(&mut self, cells: &[Cell<'_>]) -> Result<(), RowsError> {
        if cells.len() != self.ncolumn {
            let path = self.rows.path().to_path_buf();
            return Err(RowsError::WrongWidth {
                path,
                expected: self.ncolumn,
                got: cells.len(),
            });
        }
        self.rows.append(&line(cells))
    }

    /// Makes all rows durable; to be called before a checkpoint counts them.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn sync(&mut self) -> Result<(), RowsError> {
        self.rows.sync()
    }

    /// The number of rows, the header not counted.
    pub fn nrow(&self) -> u64 {
        self.rows.nrow()
    }
}

/// A whole table: its columns, and its rows.
pub fn text<'a>(columns: &[&str], rows: impl Iterator<Item = Vec<Cell<'a>>>) -> String {
    let head = header(columns);
    rows.fold(head, |text, row| text + &line(&row))
}

fn header<S: AsRef<str>>(columns: &[S]) -> String {
    let cells: Vec<Cell<'_>> = columns
        .iter()
        .map(|name| Cell::Text(name.as_ref()))
        .collect();
    line(&cells)
}

fn line(cells: &[Cell<'_>]) -> String {
    let mut out = String::with_capacity(20 * cells.len());
    for (i, cell) in cells.iter().enumerate() {
        if i > 0 {
            out.push(',');
        }
        // Writing into a string cannot fail.
        let _ = match cell {
            Cell::Real(value) => write!(out, "{value:?}"),
            Cell::Count(value) => write!(out, "{value}"),
            Cell::Whole(value) => write!(out, "{value}"),
            Cell::Text(text) if text.contains([',', '"', '\n', '\r']) => {
                write!(out, "\"{}\"", text.replace('"', "\"\""))
            }
            Cell::Text(text) => write!(out, "{text}"),
            Cell::Empty => Ok(()),
        };
    }
    out.push('\n');
    out
}

#[cfg(test)]
mod tests {
    use std::io::ErrorKind;

    use super::*;
    use crate::fs::{FailingFs, FsError, RealFs};

    fn text(path: &Path) -> String {
        String::from_utf8(RealFs.read(path).unwrap()).unwrap()
    }

    #[test]
    fn the_history_has_the_documented_columns() {
        assert_eq!(
            header(&history_columns(
                &HistoryOf {
                    contacts: &["c"],
                    references: &["r"],
                    ..HistoryOf::default()
                },
                &["pull.force_z"]
            )),
            "time,step,increment,iterations,c.force_x,c.force_y,c.force_z,c.moment_x,c.moment_y,c.moment_z,\
             c.pressure_max,c.gap_min,c.slip_max,c.area_open,c.area_stick,c.area_slip,c.center_x,c.center_y,c.center_z,\
             c.work_friction,r.force_x,r.force_y,r.force_z,r.moment_x,r.moment_y,r.moment_z,r.displacement_x,\
             r.displacement_y,r.displacement_z,r.rotation_x,r.rotation_y,r.rotation_z,r.reaction_force_x,r.reaction_force_y,\
             r.reaction_force_z,r.reaction_moment_x,r.reaction_moment_y,r.reaction_moment_z,pull.force_z\n"
        );
        assert_eq!(
            header(&CONVERGENCE_COLUMNS),
            "step,increment,attempt,iteration,residual,correction,line_search,closed,flips,worst_node\n"
        );
    }

    #[test]
    fn numbers_read_back_as_the_same_bits() {
        let mut state = 1u64;
        let mut values = vec![
            0.0,
            -0.0,
            0.1,
            1.0 / 3.0,
            1e300,
            5e-324,
            f64::MIN_POSITIVE,
            f64::MAX,
            -1e-7,
            1e16,
        ];
        for _ in 0..10_000 {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            values.push(f64::from_bits(state));
        }
        for value in values.into_iter().filter(|v| v.is_finite()) {
            let written = line(&[Cell::Real(value)]);
            assert_eq!(
                written.trim_end().parse::<f64>().unwrap().to_bits(),
                value.to_bits(),
                "{written}"
            );
        }
        assert_eq!(
            line(&[
                f64::NAN.into(),
                f64::INFINITY.into(),
                f64::NEG_INFINITY.into()
            ]),
            "NaN,inf,-inf\n"
        );
    }

    #[test]
    fn names_are_quoted_where_they_must_be() {
        let cells = [
            Cell::Text("press"),
            Cell::Text("a,b"),
            Cell::Text("say \"x\""),
            Cell::Text("two\nlines"),
            Cell::Empty,
        ];
        assert_eq!(
            line(&cells),
            "press,\"a,b\",\"say \"\"x\"\"\",\"two\nlines\",\n"
        );
        assert_eq!(
            line(&[Cell::Count(7), Cell::Whole(-3), Cell::Real(0.7)]),
            "7,-3,0.7\n"
        );
    }

    #[test]
    fn rows_are_on_the_disk_at_once_and_cut_back_on_resume() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("history.csv");
        let columns = ["time", "step", "foot, left.force_x"];
        let mut table = Table::create(&RealFs, &path, &columns).unwrap();
        for i in 1..=4 {
            table
                .row(&[
                    (0.1 * f64::from(i)).into(),
                    "pr\ness".into(),
                    Cell::Count(i as u64),
                ])
                .unwrap();
        }
        assert_eq!(table.nrow(), 4);
        assert!(matches!(
            table.row(&[Cell::Empty]),
            Err(RowsError::WrongWidth {
                expected: 3,
                got: 1,
                ..
            })
        ));
        let head = "time,step,\"foot, left.force_x\"\n";
        assert_eq!(text(&path).lines().count(), 9);
        drop(table);
        // A row torn by a power cut, then resume after two rows: newlines inside quotes are no rows.
        std::fs::write(&path, text(&path) + "0.5,pr").unwrap();
        let mut table = Table::resume(&RealFs, &path, &columns, 2).unwrap();
        assert_eq!(
            text(&path),
            format!("{head}0.1,\"pr\ness\",1\n0.2,\"pr\ness\",2\n")
        );
        table.row(&[9.0.into(), "x".into(), Cell::Empty]).unwrap();
        assert_eq!(table.nrow(), 3);
        assert!(text(&path).ends_with("2\n9.0,x,\n"));
        drop(table);
        let missing = Table::resume(&RealFs, &path, &columns, 4).unwrap_err();
        assert!(
            matches!(
                missing,
                RowsError::MissingRows {
                    have: 3,
                    keep: 4,
                    ..
                }
            ),
            "{missing}"
        );
        assert!(matches!(
            Table::resume(&RealFs, &path, &["time"], 0),
            Err(RowsError::OtherHead { .. })
        ));
        Table::resume(&RealFs, &path, &columns, 0).unwrap();
        assert_eq!(text(&path), head);
    }

    #[test]
    fn a_failed_row_leaves_no_trace_whichever_operation_fails() {
        let write = |fs: &dyn Fs, path: &Path| {
            let mut table = Table::create(fs, path, &["time", "x"])?;
            let mut failures = 0;
            for i in 0..5 {
                failures += u32::from(table.row(&[f64::from(i).into(), "abcdef".into()]).is_err());
            }
            Ok::<_, RowsError>(failures)
        };
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("t.csv");
        let counting = FailingFs::counting(RealFs);
        write(&counting, &path).unwrap();
        let total = counting.count();
        assert_eq!(total, 7, "one write per row");
        for n in 1..=total {
            let result = write(&FailingFs::nth(RealFs, n, ErrorKind::StorageFull), &path);
            let content = text(&path);
            let rows = content.lines().skip(1).count();
            match result {
                Err(error) => {
                    assert!(n <= 2 && matches!(error, RowsError::Fs(FsError::DiskFull { .. })))
                }
                // The last row may stay torn until the file is resumed.
                Ok(failures) => {
                    assert_eq!(failures, 1);
                    let whole = content
                        .split_inclusive('\n')
                        .skip(1)
                        .filter(|row| row.ends_with(",abcdef\n"))
                        .count();
                    assert_eq!(whole, 4);
                    assert!(rows == 4 || n == total);
                    Table::resume(&RealFs, &path, &["time", "x"], 4).unwrap();
                    assert_eq!(text(&path).lines().count(), 5);
                }
            }
        }
    }
}
