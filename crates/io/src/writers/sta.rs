//! The status table in the column layout of Abaqus' `.sta`, which people and scripts follow while a run goes on.
//!
//! ```text
//!  STEP  INC ATT SEVERE EQUIL TOTAL      TOTAL       STEP     INC OF
//!                DISCON ITERS ITERS       TIME       TIME       TIME
//!                ITERS
//!    1     1   1     2     3     5       0.100      0.100     0.1000
//!    1     2  1U     0    16    16       0.100      0.100     0.2000
//! ```
//!
//! One row per attempt at an increment; `U` behind the attempt marks one that did not converge. Severe discontinuity
//! iterations are those in which a contact status changed.

use std::path::Path;

use super::rows::{Newlines, RowFile, RowsError};
use crate::fs::Fs;

/// One attempt at an increment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Attempt {
    /// Number of the step, from 1.
    pub step: u64,
    /// Number of the increment within the step, from 1.
    pub increment: u64,
    /// Number of the attempt, from 1.
    pub attempt: u64,
    /// Whether it converged.
    pub converged: bool,
    /// Iterations in which a contact status changed.
    pub discontinuity_iterations: u64,
    /// The other iterations.
    pub equilibrium_iterations: u64,
    /// Time over all steps: at the end of a converged attempt, else at its start.
    pub total_time: f64,
    /// Time within the step, likewise.
    pub step_time: f64,
    /// Size of the attempted increment.
    pub increment_time: f64,
}

/// A growing status table.
#[derive(Debug)]
pub struct StatusTable {
    rows: RowFile,
}

impl StatusTable {
    /// Starts the table of the job `job` again.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn create(fs: &dyn Fs, path: &Path, job: &str) -> Result<Self, RowsError> {
        Ok(Self {
            rows: RowFile::create(fs, path, &head(job))?,
        })
    }

    /// Goes on after the first `keep` rows; what follows them is cut off.
    ///
    /// # Errors
    /// [`RowsError::OtherHead`], [`RowsError::MissingRows`], [`RowsError::Fs`].
    pub fn resume(fs: &dyn Fs, path: &Path, job: &str, keep: u64) -> Result<Self, RowsError> {
        Ok(Self {
            rows: RowFile::resume(fs, path, &head(job), keep, Newlines::Plain)?,
        })
    }

    /// Appends a row and hands it to the system at once.
    ///
    /// # Errors
    /// [`RowsError::Fs`]; the row is then not in the table.
    pub fn row(&mut self, attempt: &Attempt) -> Result<(), RowsError> {
        self.rows.append(&line(attempt))
    }

    /// Writes Abaqus' last line.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn finish(&mut self, completed: bool) -> Result<(), RowsError> {
        self.rows.append(match completed {
            true => " THE ANALYSIS HAS COMPLETED SUCCESSFULLY\n",
            false => " THE ANALYSIS HAS NOT BEEN COMPLETED\n",
        })
    }

    /// Makes all rows durable; to be called before a checkpoint counts them.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn sync(&mut self) -> Result<(), RowsError> {
        self.rows.sync()
    }

    /// The number of rows.
    pub fn nrow(&self) -> u64 {
        self.rows.nrow()
    }
}

fn head(job: &str) -> String {
    let job = job.replace(['\n', '\r'], " ");
    format!(
        " SUMMARY OF JOB INFORMATION: {job}\n\
         \x20STEP  INC ATT SEVERE EQUIL TOTAL      TOTAL       STEP     INC OF\n\
         \x20              DISCON ITERS ITERS       TIME       TIME       TIME\n\
         \x20              ITERS\n"
    )
}

fn line(row: &Attempt) -> String {
    let attempt = format!("{}{}", row.attempt, if row.converged { "" } else { "U" });
    format!(
        "{:>5} {:>4} {:>3} {:>6} {:>5} {:>5} {:>10} {:>10} {:>10}\n",
        row.step,
        row.increment,
        attempt,
        row.discontinuity_iterations,
        row.equilibrium_iterations,
        row.discontinuity_iterations + row.equilibrium_iterations,
        number(row.total_time),
        number(row.step_time),
        number(row.increment_time),
    )
}

/// Four significant digits, in scientific notation where the plain one would be long or would lose them.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0.000".into(),
        magnitude if (0.1..1e5).contains(&magnitude) => {
            let decimals = (3 - magnitude.log10().floor() as i32).clamp(1, 4);
            format!("{value:.*}", decimals as usize)
        }
        _ => format!("{value:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fs::RealFs;

    fn attempt(increment: u64) -> Attempt {
        Attempt {
            step: 1,
            increment,
            attempt: 1,
            converged: increment != 2,
            discontinuity_iterations: 2,
            equilibrium_iterations: 3,
            total_time: 0.1 * increment as f64,
            step_time: 1.0,
            increment_time: 1e-6,
        }
    }

    #[test]
    fn rows_have_the_nine_columns_of_abaqus() {
        let row = line(&attempt(2));
        let words: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(
            words,
            ["1", "2", "1U", "2", "3", "5", "0.2000", "1.000", "1.000e-6"]
        );
        let many = Attempt {
            step: 12345,
            increment: 12345,
            attempt: 12,
            discontinuity_iterations: 1234567,
            total_time: f64::NAN,
            ..attempt(1)
        };
        assert_eq!(
            line(&many).split_whitespace().count(),
            9,
            "large numbers stay apart"
        );
    }

    #[test]
    fn times_keep_four_digits() {
        let times = [0.0, 0.1, 0.95, 1.0, 12.345, 99_999.4, 123_456.0, 1e-6, -2.5];
        let texts = times.map(number);
        assert_eq!(
            texts,
            [
                "0.000", "0.1000", "0.9500", "1.000", "12.35", "99999.4", "1.235e5", "1.000e-6",
                "-2.500"
            ]
        );
        for (time, text) in times.iter().zip(&texts) {
            assert!(
                (text.parse::<f64>().unwrap() - time).abs() <= 5e-4 * time.abs(),
                "{text} for {time}"
            );
        }
    }

    #[test]
    fn a_resumed_table_goes_on_after_the_rows_kept() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("hertz.sta");
        let mut table = StatusTable::create(&RealFs, &path, "hertz").unwrap();
        for increment in 1..=3 {
            table.row(&attempt(increment)).unwrap();
        }
        table.finish(false).unwrap();
        drop(table);
        let mut table = StatusTable::resume(&RealFs, &path, "hertz", 2).unwrap();
        table.row(&attempt(9)).unwrap();
        table.finish(true).unwrap();
        table.sync().unwrap();
        let text = String::from_utf8(RealFs.read(&path).unwrap()).unwrap();
        let expected = head("hertz") + &line(&attempt(1)) + &line(&attempt(2)) + &line(&attempt(9));
        assert_eq!(
            text,
            expected + " THE ANALYSIS HAS COMPLETED SUCCESSFULLY\n"
        );
        assert!(matches!(
            StatusTable::resume(&RealFs, &path, "other", 0),
            Err(RowsError::OtherHead { .. })
        ));
    }
}
