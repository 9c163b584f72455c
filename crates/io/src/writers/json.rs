//! `events.jsonl`, one line per event while a run goes on, and `summary.json`, how it ended.
//!
//! Numbers that are not finite are written as `null`, since JSON has none, and read back as NaN.
//!
//! One more event: a variant of [`Event`]; keys once released keep their meaning.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::rows::{Newlines, RowFile, RowsError};
use crate::fs::{Fs, FsError};

/// The version of the event lines.
pub const EVENT_VERSION: u32 = 1;

/// Something that happened in a run; `step` is a name, `inc` counts from 1 within it, `time` is the total time.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "ev", rename_all = "snake_case")]
pub enum Event {
    /// The run starts.
    Start {
        /// The case file.
        case: String,
        /// Its title.
        title: String,
        /// The program's version.
        version: String,
        /// Number of processes, where there are several.
        #[serde(skip_serializing_if = "Option::is_none")]
        ranks: Option<u64>,
        /// Number of threads, of each process.
        threads: u64,
        /// Number of nodes.
        nodes: u64,
        /// Number of elements.
        elements: u64,
        /// Number of unknowns.
        unknowns: u64,
        /// Duration of all steps.
        duration: f64,
    },
    /// A message to the user.
    Diagnostic {
        /// `error`, `warning` or `note`.
        severity: String,
        /// `S0501`.
        code: String,
        /// What is wrong.
        message: String,
        /// The file it is about.
        #[serde(skip_serializing_if = "Option::is_none")]
        file: Option<String>,
        /// The line, from 1.
        #[serde(skip_serializing_if = "Option::is_none")]
        line: Option<u64>,
        /// The column, from 1.
        #[serde(skip_serializing_if = "Option::is_none")]
        column: Option<u64>,
        /// The remark at that place.
        #[serde(skip_serializing_if = "Option::is_none")]
        label: Option<String>,
        /// Facts with numbers.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        notes: Vec<String>,
        /// What to do.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        help: Vec<String>,
    },
    /// A Newton iteration.
    Iteration {
        /// The step.
        step: String,
        /// The increment.
        inc: u64,
        /// The attempt at it, from 1.
        att: u64,
        /// The iteration, from 1.
        iter: u64,
        /// Largest force error over the force scale.
        residual: f64,
        /// Largest correction over the increment's displacement.
        correction: f64,
        /// Closed contact rows.
        closed: u64,
        /// Rows whose status changed.
        flips: u64,
        /// Iterations of the linear solver in the solve before.
        linear: u64,
    },
    /// A converged increment.
    Increment {
        /// The step.
        step: String,
        /// The increment.
        inc: u64,
        /// Total time at its end.
        time: f64,
        /// Its iterations.
        iters: u64,
        /// What every contact carries.
        contact: BTreeMap<String, ContactState>,
    },
    /// An attempt was given up and the increment made smaller.
    Cutback(GivenUp),
    /// An attempt was given up, and the same size is tried from another start.
    Retry(GivenUp),
    /// The increment was gone through in parts: there was an equilibrium nearby.
    Followed {
        /// The step.
        step: String,
        /// The increment.
        inc: u64,
        /// The attempt that succeeded.
        att: u64,
        /// Total time at its start.
        time: f64,
        /// Parts that it took.
        parts: u64,
    },
    /// There was no equilibrium nearby: viscous forces led to another.
    Stabilized {
        /// The step.
        step: String,
        /// The increment.
        inc: u64,
        /// The attempt that succeeded.
        att: u64,
        /// Total time at its start.
        time: f64,
        /// Stages that it took.
        stages: u64,
        /// Work of the viscous forces in it.
        work: f64,
        /// Work of supports and loads since the start of the run.
        work_external: f64,
    },
    /// An explicit step begins.
    Explicit {
        /// Name of the step.
        step: String,
        /// The longest of its short increments.
        size: f64,
        /// Mass that was added, over that of the model.
        mass_added: f64,
    },
    /// Motions that nothing resists and no load acts on were held.
    Held {
        /// The step.
        step: String,
        /// Where, in words.
        at: Vec<String>,
    },
    /// The linear solver has decided something for itself.
    Solver {
        /// The step.
        step: String,
        /// The increment.
        inc: u64,
        /// What, in words.
        note: String,
    },
    /// Natural frequencies were found.
    Frequencies {
        /// The step.
        step: String,
        /// Total time of the state about which they are.
        time: f64,
        /// Whether none between the first and the last is missing.
        counted: bool,
        /// They, lowest first.
        modes: Vec<ModeSummary>,
        /// Files of their shapes, relative to the output folder.
        files: Vec<String>,
    },
    /// A frame is complete and listed.
    Frame {
        /// Its number.
        frame: u64,
        /// Total time.
        time: f64,
        /// Its files, relative to the output folder.
        files: Vec<String>,
    },
    /// A checkpoint is complete.
    Checkpoint {
        /// The step.
        step: String,
        /// The increment.
        inc: u64,
        /// Total time.
        time: f64,
        /// Its file, relative to the output folder.
        file: String,
    },
    /// An expectation was checked.
    Expect {
        /// What was looked at.
        what: String,
        /// The value expected.
        value: f64,
        /// The value found.
        got: f64,
        /// Whether it is within the tolerance.
        ok: bool,
    },
    /// The run ends.
    End {
        /// As in the summary.
        status: String,
        /// The exit code.
        exit_code: u8,
        /// Wall time in seconds.
        seconds: f64,
    },
}

/// An attempt at an increment that was given up.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GivenUp {
    /// The step.
    pub step: String,
    /// The increment.
    pub inc: u64,
    /// The attempt that failed.
    pub att: u64,
    /// Total time at its start.
    pub time: f64,
    /// The size that is tried next.
    pub size: f64,
    /// Why.
    pub why: String,
}

/// What a contact carries at the end of an increment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactState {
    /// Force of the primary side on the secondary side.
    pub force: [f64; 3],
    /// Closed area.
    pub area: f64,
    /// Largest pressure.
    pub pressure_max: f64,
    /// Closed rows.
    pub closed: u64,
}

impl Event {
    /// The event as one line of JSON, newline included.
    pub fn line(&self) -> String {
        #[derive(Serialize)]
        struct Line<'a> {
            v: u32,
            #[serde(flatten)]
            event: &'a Event,
        }
        // Strings, numbers and maps with string keys cannot fail to serialize.
        let mut text = serde_json::to_string(&Line {
            v: EVENT_VERSION,
            event: self,
        })
        .unwrap_or_default();
        text.push('\n');
        text
    }
}

/// A growing file of event lines.
#[derive(Debug)]
pub struct EventLog {
    rows: RowFile,
}

impl EventLog {
    /// Starts the file again.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn create(fs: &dyn Fs, path: &Path) -> Result<Self, RowsError> {
        Ok(Self {
            rows: RowFile::create(fs, path, "")?,
        })
    }

    /// Goes on after the first `keep` lines; later ones, whole or torn, are cut off.
    ///
    /// # Errors
    /// [`RowsError::MissingRows`], [`RowsError::Fs`].
    pub fn resume(fs: &dyn Fs, path: &Path, keep: u64) -> Result<Self, RowsError> {
        Ok(Self {
            rows: RowFile::resume(fs, path, "", keep, Newlines::Plain)?,
        })
    }

    /// Appends an event and hands it to the system at once.
    ///
    /// # Errors
    /// [`RowsError::Fs`]; the line is then not in the file.
    pub fn append(&mut self, event: &Event) -> Result<(), RowsError> {
        self.rows.append(&event.line())
    }

    /// Makes all lines durable; to be called before a checkpoint counts them.
    ///
    /// # Errors
    /// [`RowsError::Fs`].
    pub fn sync(&mut self) -> Result<(), RowsError> {
        self.rows.sync()
    }

    /// The number of lines.
    pub fn nrow(&self) -> u64 {
        self.rows.nrow()
    }
}

/// `summary.json`: how a run ended.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// `solved`, `not converged`, `interrupted`, …
    pub status: String,
    /// The exit code.
    pub exit_code: u8,
    /// The steps that were begun, in order.
    pub steps: Vec<StepSummary>,
    /// The natural frequencies of the steps that found some.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<FrequencySummary>,
    /// What every contact carries at the end.
    pub contacts: BTreeMap<String, ContactSummary>,
    /// The expectations of the case, in order.
    pub expectations: Vec<Expectation>,
    /// Work spent by viscous forces that hold what only contact stops.
    #[serde(default, deserialize_with = "nan::of_number")]
    pub work_stabilization: f64,
    /// Work of supports and loads.
    #[serde(default, deserialize_with = "nan::of_number")]
    pub work_external: f64,
    /// Where heat came from and went to; none where no step finds temperatures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<HeatSummary>,
    /// What the audit of all accepted states found.
    #[serde(default)]
    pub audit: AuditSummary,
    /// Wall time of each phase, in seconds.
    #[serde(deserialize_with = "nan::of_map")]
    pub time: BTreeMap<String, f64>,
    /// Largest memory in use, in bytes; that of rank 0.
    pub memory_peak_bytes: u64,
    /// The processes, where there were several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ranks: Option<RanksSummary>,
    /// Number of unknowns.
    pub unknowns: u64,
    /// The program's version.
    pub version: String,
    /// The files that were read.
    pub inputs: Vec<Input>,
    /// Warnings and errors, in order.
    pub diagnostics: Vec<DiagnosticSummary>,
}

/// The processes of a [`Summary`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RanksSummary {
    /// How many there were.
    pub count: u64,
    /// The largest memory that any of them had in use, in bytes.
    pub memory_peak_bytes: u64,
}

/// The heat of a [`Summary`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatSummary {
    /// Heat per time in the last increment.
    pub rate: HeatEntry,
    /// Heat since the start, in transient steps.
    pub total: HeatEntry,
    /// What comes in and is not taken up in the last increment, over the largest of these.
    #[serde(deserialize_with = "nan::of_number")]
    pub imbalance: f64,
}

/// Heat into bodies, or heat per time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatEntry {
    /// Through loads.
    #[serde(deserialize_with = "nan::of_number")]
    pub loads: f64,
    /// From what holds temperatures.
    #[serde(deserialize_with = "nan::of_number")]
    pub supports: f64,
    /// From rigid surfaces that have a temperature.
    #[serde(deserialize_with = "nan::of_number")]
    pub surfaces: f64,
    /// Of friction.
    #[serde(deserialize_with = "nan::of_number")]
    pub friction: f64,
    /// What bodies took up.
    #[serde(deserialize_with = "nan::of_number")]
    pub stored: f64,
}

/// One step of a [`Summary`].
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StepSummary {
    /// Its name.
    pub name: String,
    /// Converged increments.
    pub increments: u64,
    /// Newton iterations, those of failed attempts too.
    pub iterations: u64,
    /// Attempts that were given up.
    pub cutbacks: u64,
    /// Iterations of the linear solver.
    #[serde(default)]
    pub linear_iterations: u64,
    /// How often iterations of the linear solver gave way to a direct solution.
    #[serde(default)]
    pub fallbacks: u64,
}

/// The natural frequencies of one step of a [`Summary`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrequencySummary {
    /// Name of the step.
    pub step: String,
    /// Total time of the state about which they are.
    #[serde(deserialize_with = "nan::of_number")]
    pub time: f64,
    /// Whether none between the first and the last is missing.
    pub counted: bool,
    /// The mass that moves along each axis, that at supports included.
    #[serde(deserialize_with = "nan::of_vector")]
    pub mass: [f64; 3],
    /// They, lowest first.
    pub modes: Vec<ModeSummary>,
}

/// A natural mode in a [`FrequencySummary`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModeSummary {
    /// Its number among those of its step, from 1.
    pub mode: u64,
    /// Cycles per time; below zero where the state is not stable.
    #[serde(deserialize_with = "nan::of_number")]
    pub frequency: f64,
    /// ω, radian per time, with the same sign.
    #[serde(deserialize_with = "nan::of_number")]
    pub omega: f64,
    /// ω².
    #[serde(deserialize_with = "nan::of_number")]
    pub eigenvalue: f64,
    /// ‖K φ − ω² M φ‖ over (ω² + |σ|) ‖M φ‖, with the shift σ of the method.
    #[serde(deserialize_with = "nan::of_number")]
    pub residual: f64,
    /// Whether that is as small as it is to be.
    pub converged: bool,
    /// Γ = φ·M e for a motion e by 1 along each axis, with φ·M φ = 1.
    #[serde(deserialize_with = "nan::of_vector")]
    pub participation: [f64; 3],
    /// Γ².
    #[serde(deserialize_with = "nan::of_vector")]
    pub effective_mass: [f64; 3],
}

/// What the audit found in a [`Summary`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AuditSummary {
    /// Whether all is within its limits in all increments.
    pub passed: bool,
    /// Work of loads and supports.
    #[serde(deserialize_with = "nan::of_number")]
    pub work_external: f64,
    /// Work of the viscous forces that led to another equilibrium where there was none nearby, over the sum of the sizes of
    /// the work of loads and supports in each increment.
    #[serde(deserialize_with = "nan::of_number")]
    pub part_viscous: f64,
    /// The energy that the method of going through time has added at most, over the energy that there is.
    #[serde(default, deserialize_with = "nan::of_number")]
    pub part_gained: f64,
    /// Bodies that moved freely and that nothing stopped: their place at the end is one of many.
    #[serde(default)]
    pub unheld: Vec<UnheldEntry>,
    /// The worst of each check, by contact, then check: `apart`, `through`, `direction`, `stress`.
    pub contacts: BTreeMap<String, BTreeMap<String, AuditEntry>>,
    /// What is lost or made of heat, over the largest heat per time; none where no step finds temperatures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<AuditEntry>,
}

/// Bodies that moved freely and that nothing stopped.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UnheldEntry {
    /// Their names, as in `"pin" and "ring"`.
    pub bodies: String,
    /// How far they moved since something held them, or since the start.
    #[serde(deserialize_with = "nan::of_number")]
    pub distance: f64,
    /// The time at which they moved first.
    #[serde(deserialize_with = "nan::of_number")]
    pub time: f64,
}

/// What a check found at a contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AuditEntry {
    /// Whether it is within its limit in all increments.
    pub passed: bool,
    /// The largest part that is wrong: of the contact force; for `through`, of the size of a facet.
    #[serde(deserialize_with = "nan::of_number")]
    pub part: f64,
    /// The part up to which it passes.
    #[serde(deserialize_with = "nan::of_number")]
    pub limit: f64,
    /// The time at which it is worst.
    #[serde(deserialize_with = "nan::of_number")]
    pub time: f64,
    /// Increments in which it does not pass.
    pub increments: u64,
    /// The worst nodes then, where it does not pass.
    pub nodes: Vec<u64>,
}

/// One contact of a [`Summary`], in the quantities of `history.csv`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactSummary {
    /// Force of the primary side on the secondary side.
    #[serde(deserialize_with = "nan::of_vector")]
    pub force: [f64; 3],
    /// Its moment about the origin.
    #[serde(deserialize_with = "nan::of_vector")]
    pub moment: [f64; 3],
    /// Largest pressure.
    #[serde(deserialize_with = "nan::of_number")]
    pub pressure_max: f64,
    /// Smallest gap; negative is penetration.
    #[serde(deserialize_with = "nan::of_number")]
    pub gap_min: f64,
    /// Area that is open.
    #[serde(deserialize_with = "nan::of_number")]
    pub area_open: f64,
    /// Area that sticks.
    #[serde(deserialize_with = "nan::of_number")]
    pub area_stick: f64,
    /// Area that slips.
    #[serde(deserialize_with = "nan::of_number")]
    pub area_slip: f64,
    /// What the forces of both sides do not balance, over the sum of the sizes of nodal forces: the worst of all increments.
    #[serde(default, deserialize_with = "nan::of_number")]
    pub imbalance_force: f64,
    /// Of a contact with a fluid, the area that is wet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_wet: Option<f64>,
    /// Of a contact with a gasket, the largest closure so far.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closure_max: Option<f64>,
    /// Of a contact that conducts, heat per time from the secondary side to the primary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<f64>,
    /// Likewise, heat per time that its friction sets free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat_friction: Option<f64>,
    /// What their moments do not balance, over that sum times the size of a facet: the worst of all increments.
    #[serde(default, deserialize_with = "nan::of_number")]
    pub imbalance_moment: f64,
}

/// One expectation of a [`Summary`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Expectation {
    /// What was looked at.
    pub what: String,
    /// The value expected.
    #[serde(deserialize_with = "nan::of_number")]
    pub value: f64,
    /// The value found; NaN where there is none.
    #[serde(deserialize_with = "nan::of_number")]
    pub got: f64,
    /// Whether it is within the tolerance.
    pub ok: bool,
}

/// One input file of a [`Summary`].
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    /// Its path, as given.
    pub path: String,
    /// Its SHA-256, in hexadecimal.
    pub sha256: String,
}

/// One message of a [`Summary`].
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticSummary {
    /// `S0501`.
    pub code: String,
    /// What is wrong.
    pub message: String,
}

/// Why a summary could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SummaryError {
    /// The disk failed.
    #[error(transparent)]
    Fs(#[from] FsError),
    /// The file is not a summary of this program.
    #[error("this is not a summary: {0}; run the case again")]
    Json(#[from] serde_json::Error),
}

impl Summary {
    /// The summary as indented JSON.
    pub fn text(&self) -> String {
        // Strings, numbers and maps with string keys cannot fail to serialize.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }

    /// Writes the summary, replacing the one of an earlier run at once.
    ///
    /// # Errors
    /// [`FsError`].
    pub fn write(&self, fs: &dyn Fs, path: &Path) -> Result<(), FsError> {
        fs.write_atomic(path, self.text().as_bytes())
    }

    /// Reads a summary back.
    ///
    /// # Errors
    /// [`SummaryError`].
    pub fn read(fs: &dyn Fs, path: &Path) -> Result<Self, SummaryError> {
        Ok(serde_json::from_slice(&fs.read(path)?)?)
    }
}

/// Reads `null` as NaN.
mod nan {
    use std::collections::BTreeMap;

    use serde::{Deserialize, Deserializer};

    fn or_nan(value: Option<f64>) -> f64 {
        value.unwrap_or(f64::NAN)
    }

    pub fn of_number<'de, D: Deserializer<'de>>(input: D) -> Result<f64, D::Error> {
        Ok(or_nan(Option::deserialize(input)?))
    }

    pub fn of_vector<'de, D: Deserializer<'de>>(input: D) -> Result<[f64; 3], D::Error> {
        Ok(<[Option<f64>; 3]>::deserialize(input)?.map(or_nan))
    }

    pub fn of_map<'de, D: Deserializer<'de>>(input: D) -> Result<BTreeMap<String, f64>, D::Error> {
        let map = BTreeMap::<String, Option<f64>>::deserialize(input)?;
        Ok(map
            .into_iter()
            .map(|(key, value)| (key, or_nan(value)))
            .collect())
    }
}

#[cfg(test)]
mod tests;
