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
        /// Number of threads.
        threads: u64,
        /// Number of nodes.
        nodes: u64,
        /// Number of elements.
        elements: u64,
        /// Number of unknowns.
        unknowns: u64,
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
    Cutback {
        /// The step.
        step: String,
        /// The increment.
        inc: u64,
        /// The attempt that failed.
        att: u64,
        /// Total time at its start.
        time: f64,
        /// The size that is tried next.
        size: f64,
        /// Why.
        why: String,
    },
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
    /// What the audit of all accepted states found.
    #[serde(default)]
    pub audit: AuditSummary,
    /// Wall time of each phase, in seconds.
    #[serde(deserialize_with = "nan::of_map")]
    pub time: BTreeMap<String, f64>,
    /// Largest memory in use, in bytes.
    pub memory_peak_bytes: u64,
    /// Number of unknowns.
    pub unknowns: u64,
    /// The program's version.
    pub version: String,
    /// The files that were read.
    pub inputs: Vec<Input>,
    /// Warnings and errors, in order.
    pub diagnostics: Vec<DiagnosticSummary>,
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
    /// The worst of each check, by contact, then check: `apart`, `through`, `direction`, `stress`.
    pub contacts: BTreeMap<String, BTreeMap<String, AuditEntry>>,
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
mod tests {
    use super::*;
    use crate::fs::RealFs;

    fn summary() -> Summary {
        Summary {
            status: "solved".into(),
            steps: vec![StepSummary {
                name: "press \"1\"".into(),
                increments: 6,
                iterations: 31,
                cutbacks: 0,
                linear_iterations: 97,
                fallbacks: 1,
            }],
            contacts: [(
                "ball-block".into(),
                ContactSummary {
                    force: [0.0, 0.1, 17.5],
                    gap_min: -1e-300,
                    ..Default::default()
                },
            )]
            .into(),
            expectations: vec![Expectation {
                what: "ball-block.force_z".into(),
                value: 25.0,
                got: 24.9,
                ok: false,
            }],
            time: [("solve".into(), 3.4)].into(),
            memory_peak_bytes: 1 << 33,
            unknowns: 1731,
            version: "0.1.0".into(),
            inputs: vec![Input {
                path: "a b/ü.toml".into(),
                sha256: "00ff".into(),
            }],
            diagnostics: vec![DiagnosticSummary {
                code: "S0402".into(),
                message: "two\nlines".into(),
            }],
            ..Default::default()
        }
    }

    #[test]
    fn an_increment_is_the_line_that_is_documented() {
        let state = ContactState {
            force: [0.0, 0.0, 17.5],
            area: 3.2,
            pressure_max: 33.9,
            closed: 37,
        };
        let contact = [("ball-block".to_string(), state)].into();
        let event = Event::Increment {
            step: "press".into(),
            inc: 4,
            time: 0.7,
            iters: 4,
            contact,
        };
        let expected = r#"{"v":1,"ev":"increment","step":"press","inc":4,"time":0.7,"iters":4,"contact":{"ball-block":{"force":[0.0,0.0,17.5],"area":3.2,"pressure_max":33.9,"closed":37}}}"#;
        assert_eq!(event.line(), format!("{expected}\n"));
    }

    #[test]
    fn every_event_is_one_line_with_version_and_kind() {
        let text = || "a\n\"b\"".to_string();
        let events = [
            (
                Event::Start {
                    case: text(),
                    title: text(),
                    version: text(),
                    threads: 2,
                    nodes: 8,
                    elements: 1,
                    unknowns: 24,
                },
                "start",
            ),
            (
                Event::Diagnostic {
                    severity: text(),
                    code: text(),
                    message: text(),
                    file: None,
                    line: Some(3),
                    column: None,
                },
                "diagnostic",
            ),
            (
                Event::Iteration {
                    step: text(),
                    inc: 1,
                    att: 1,
                    iter: 1,
                    residual: f64::NAN,
                    correction: 0.0,
                    closed: 0,
                    flips: 0,
                    linear: 0,
                },
                "iteration",
            ),
            (
                Event::Increment {
                    step: text(),
                    inc: 1,
                    time: 0.0,
                    iters: 1,
                    contact: BTreeMap::new(),
                },
                "increment",
            ),
            (
                Event::Cutback {
                    step: text(),
                    inc: 1,
                    att: 1,
                    time: 0.0,
                    size: 0.1,
                    why: text(),
                },
                "cutback",
            ),
            (
                Event::Followed {
                    step: text(),
                    inc: 1,
                    att: 2,
                    time: 0.0,
                    parts: 4,
                },
                "followed",
            ),
            (
                Event::Stabilized {
                    step: text(),
                    inc: 1,
                    att: 2,
                    time: 0.0,
                    stages: 9,
                    work: 0.5,
                    work_external: 2.0,
                },
                "stabilized",
            ),
            (
                Event::Held {
                    step: text(),
                    at: vec![text()],
                },
                "held",
            ),
            (
                Event::Solver {
                    step: text(),
                    inc: 1,
                    note: text(),
                },
                "solver",
            ),
            (
                Event::Frame {
                    frame: 0,
                    time: 0.0,
                    files: vec![text()],
                },
                "frame",
            ),
            (
                Event::Checkpoint {
                    step: text(),
                    inc: 1,
                    time: 0.0,
                    file: text(),
                },
                "checkpoint",
            ),
            (
                Event::Expect {
                    what: text(),
                    value: 1.0,
                    got: f64::INFINITY,
                    ok: false,
                },
                "expect",
            ),
            (
                Event::End {
                    status: text(),
                    exit_code: 5,
                    seconds: 0.1,
                },
                "end",
            ),
        ];
        for (event, kind) in events {
            let line = event.line();
            assert_eq!(line.matches('\n').count(), 1);
            assert!(
                line.starts_with(&format!("{{\"v\":1,\"ev\":\"{kind}\"")),
                "{line}"
            );
            let value: serde_json::Value = serde_json::from_str(&line).unwrap();
            assert!(kind != "iteration" || value["residual"].is_null());
            assert!(kind != "expect" || value["got"].is_null());
            assert!(kind != "diagnostic" || (value["line"] == 3 && value.get("file").is_none()));
        }
    }

    #[test]
    fn a_summary_has_the_documented_keys_and_reads_back() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("summary.json");
        let summary = summary();
        summary.write(&RealFs, &path).unwrap();
        assert_eq!(Summary::read(&RealFs, &path).unwrap(), summary);
        let value: serde_json::Value = serde_json::from_str(&summary.text()).unwrap();
        let keys = |v: &serde_json::Value| {
            v.as_object()
                .unwrap()
                .keys()
                .cloned()
                .collect::<Vec<_>>()
                .join(" ")
        };
        assert_eq!(
            keys(&value),
            "audit contacts diagnostics exit_code expectations inputs memory_peak_bytes status steps time unknowns version work_external work_stabilization"
        );
        assert_eq!(
            keys(&value["steps"][0]),
            "cutbacks fallbacks increments iterations linear_iterations name"
        );
        assert_eq!(
            keys(&value["contacts"]["ball-block"]),
            "area_open area_slip area_stick force gap_min imbalance_force imbalance_moment moment pressure_max"
        );
        assert_eq!(keys(&value["expectations"][0]), "got ok value what");
        assert_eq!(keys(&value["inputs"][0]), "path sha256");
        assert_eq!(keys(&value["diagnostics"][0]), "code message");
    }

    #[test]
    fn numbers_that_are_not_finite_become_null_and_read_back_as_nan() {
        let mut summary = summary();
        summary.expectations[0].got = f64::INFINITY;
        summary.time.insert("read".into(), f64::NAN);
        summary.contacts.get_mut("ball-block").unwrap().force[1] = f64::NAN;
        let text = summary.text();
        assert_eq!(text.matches("null").count(), 3, "{text}");
        let back: Summary = serde_json::from_str(&text).unwrap();
        assert!(back.expectations[0].got.is_nan() && back.time["read"].is_nan());
        assert!(
            back.contacts["ball-block"].force[1].is_nan()
                && back.contacts["ball-block"].force[2] == 17.5
        );
    }

    #[test]
    fn an_event_file_is_cut_back_to_the_lines_kept() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("events.jsonl");
        let frame = |frame| Event::Frame {
            frame,
            time: 0.0,
            files: vec![],
        };
        let mut log = EventLog::create(&RealFs, &path).unwrap();
        for i in 0..5 {
            log.append(&frame(i)).unwrap();
        }
        log.sync().unwrap();
        drop(log);
        let mut log = EventLog::resume(&RealFs, &path, 2).unwrap();
        log.append(&frame(7)).unwrap();
        assert_eq!(log.nrow(), 3);
        let text = String::from_utf8(RealFs.read(&path).unwrap()).unwrap();
        assert_eq!(text, [0, 1, 7].map(|i| frame(i).line()).concat());
    }
}
