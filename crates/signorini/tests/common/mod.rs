//! Runs cases through the library and keeps what happened.

#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use serde_json::Value;
use signorini::setup::{Model, build, read_mesh_of, read_surfaces_of};
use signorini_io::case::read_case;
use signorini_mechanics::solve::{
    Event, Flow, IncrementRecord, IterationRecord, RunError, Stepper,
};
use signorini_mechanics::system::Frame;
use std::path::{Path, PathBuf};

/// Everything a run reported.
#[derive(Default)]
pub struct Run {
    pub frames: Vec<Frame>,
    pub increments: Vec<IncrementRecord>,
    pub iterations: Vec<IterationRecord>,
    pub cutbacks: Vec<String>,
    pub error: Option<RunError>,
}

impl Run {
    /// Force that the primary side exerts on the secondary, per increment.
    pub fn contact_force(&self, increment: usize) -> [f64; 3] {
        self.frames[increment - 1].contacts[0]
            .secondary
            .force
            .to_array()
    }

    /// Energy norms of the residual of an increment, one for each solve of its last attempt.
    pub fn decrements(&self, increment: usize) -> Vec<f64> {
        let attempts = self.increments[increment - 1].attempts;
        self.iterations
            .iter()
            .filter(|i| i.increment == increment && i.attempt == attempts && i.iteration > 1)
            .map(|i| i.decrement)
            .collect()
    }
}

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub fn model(name: &str, text: &str, set: &[(&str, &str)]) -> Model {
    model_in(Path::new("."), name, text, set)
}

/// The model of a case whose mesh file is in this folder.
pub fn model_in(folder: &Path, name: &str, text: &str, set: &[(&str, &str)]) -> Model {
    let set: Vec<(String, String)> = set
        .iter()
        .map(|(k, v)| (k.to_string(), v.to_string()))
        .collect();
    let (mut case, _) = read_case(name, text.as_bytes(), &set, signorini::vocabulary())
        .unwrap_or_else(|e| panic!("{}", e.plain()));
    read_surfaces_of(&mut case, folder).unwrap_or_else(|e| panic!("{}", e.plain()));
    let (mesh, _) = read_mesh_of(&case, folder).unwrap_or_else(|e| panic!("{}", e.plain()));
    build(case, mesh).unwrap_or_else(|e| panic!("{}", e.plain()))
}

/// The folder of an example.
pub fn folder(example: &str) -> PathBuf {
    repository().join("examples").join(example)
}

pub fn text(example: &str) -> String {
    std::fs::read_to_string(folder(example).join("case.toml")).unwrap()
}

pub fn example(name: &str, set: &[(&str, &str)]) -> Model {
    model_in(&folder(name), name, &text(name), set)
}

pub fn run(model: &mut Model) -> Run {
    let mut run = Run::default();
    let mut stepper = Stepper::new(&model.system, model.settings).with_cycles(model.cycles.clone());
    let outcome = stepper.run(&mut model.system, &model.steps, &mut |event: &Event<'_>| {
        match event {
            Event::Iteration(record) => run.iterations.push((*record).clone()),
            Event::Increment { record, frame } => {
                run.increments.push((*record).clone());
                run.frames.push((*frame).clone());
            }
            Event::Cutback { cause, .. } => run.cutbacks.push(cause.failure.to_string()),
            _ => {}
        }
        Flow::Continue
    });
    run.error = outcome.err();
    run
}

pub fn oracle(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A file of reference values in a folder next to the repository, or further up.
pub fn reference(name: &str) -> Option<Value> {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let path = folders.find_map(|f| {
        let path = f.join("shared/reference").join(name);
        path.is_file().then_some(path)
    });
    let Some(path) = path else {
        eprintln!("SKIPPED: no {name} in shared/reference next to the repository");
        return None;
    };
    Some(serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap())
}

/// The numbers of a JSON list.
pub fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect()
}

/// Largest difference over the largest value expected.
pub fn relative(got: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(got.len(), expected.len());
    let size = expected.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let error = got
        .iter()
        .zip(expected)
        .fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    error / size
}
