//! `[[expect]]`: values that are looked at while the run goes on and judged at its end.

use super::probe::{Probe, quantities};
use crate::setup::Model;
use signorini_io::case::{self, Moment, Tolerance};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, closest, codes};
use signorini_io::writers::json;
use signorini_mechanics::system::Frame;

/// Times are equal up to this part of the larger one.
const SAME_TIME: f64 = 1e-9;

/// Numbers that hold one expectation in a checkpoint.
const NUMBERS: usize = 3;

/// All expectations of a case.
#[derive(Debug, Default)]
pub struct Expectations {
    list: Vec<Watch>,
}

#[derive(Debug)]
struct Watch {
    part: case::Expectation,
    source: Source,
    /// The value at the moment asked for; not a number before that.
    got: f64,
    /// Time and value at the last accepted increment.
    last: [f64; 2],
}

#[derive(Debug)]
enum Source {
    /// A column of the history.
    Column(usize),
    /// A field at nodes.
    Probe(Probe),
    /// A natural frequency: the number of the step, and its own, both from 0.
    Frequency(usize, usize),
}

impl Expectations {
    /// The expectations of a model whose history has these columns.
    ///
    /// # Errors
    /// Expectations that name nothing.
    pub fn new(model: &Model, columns: &[String]) -> Result<Self, Diagnostics> {
        let mut list = Vec::new();
        let mut found = Diagnostics::new();
        for part in &model.case.expectations {
            match find(model, columns, part) {
                Ok(source) => list.push(Watch {
                    part: part.clone(),
                    source,
                    got: f64::NAN,
                    last: [0.0, f64::NAN],
                }),
                Err(one) => found.push(*one),
            }
        }
        if found.has_errors() {
            return Err(found);
        }
        Ok(Self { list })
    }

    /// Looks at the undeformed state: where the way to the first moment begins.
    pub fn begin(&mut self, frame: &Frame, row: &[f64]) {
        for one in &mut self.list {
            one.last = [frame.time, one.source.value(frame, row)];
        }
    }

    /// Looks at an accepted increment, which is this data row (from 1) of the history, with its numbers.
    pub fn look(&mut self, number: u64, frame: &Frame, row: &[f64]) {
        let of_states = self.list.iter_mut();
        for one in of_states.filter(|one| !matches!(one.source, Source::Frequency(..))) {
            let value = one.source.value(frame, row);
            match one.part.at {
                Moment::End => one.got = value,
                Moment::Row(wanted) if wanted == number => one.got = value,
                Moment::Row(_) => {}
                Moment::Time(wanted) => {
                    if let Some(got) = between(one.last, [frame.time, value], wanted) {
                        one.got = got;
                    }
                }
            }
            one.last = [frame.time, value];
        }
    }

    /// Takes the natural frequencies that a step has found.
    pub fn hear(&mut self, step: usize, frequencies: &[f64]) {
        for one in &mut self.list {
            if let Source::Frequency(of, number) = one.source
                && of == step
                && let Some(frequency) = frequencies.get(number)
            {
                one.got = *frequency;
            }
        }
    }

    /// The verdicts.
    pub fn judge(&self) -> Vec<json::Expectation> {
        let judge = |one: &Watch| {
            let value = one.part.value;
            let allowed = match one.part.tolerance {
                Tolerance::Relative(part) => part * value.abs(),
                Tolerance::Absolute(most) => most,
            };
            json::Expectation {
                what: one.part.what.value.clone(),
                value,
                got: one.got,
                ok: (one.got - value).abs() <= allowed,
            }
        };
        self.list.iter().map(judge).collect()
    }

    /// The tolerances in words, in order: `± 3 %`.
    pub fn tolerances(&self) -> Vec<String> {
        let words = |one: &Watch| match one.part.tolerance {
            Tolerance::Relative(part) if part >= 1e-4 => format!("± {} %", 100.0 * part),
            Tolerance::Relative(part) => format!("± {part:e} of it"),
            Tolerance::Absolute(most) => format!("± {most}"),
        };
        self.list.iter().map(words).collect()
    }

    /// What a checkpoint has to remember.
    pub fn save(&self) -> Vec<f64> {
        let numbers = self.list.iter();
        numbers
            .flat_map(|one| [one.got, one.last[0], one.last[1]])
            .collect()
    }

    /// Takes it back; says whether it fits.
    pub fn load(&mut self, numbers: &[f64]) -> bool {
        for (one, numbers) in self.list.iter_mut().zip(numbers.chunks_exact(NUMBERS)) {
            if let [got, time, value] = *numbers {
                one.got = got;
                one.last = [time, value];
            }
        }
        numbers.len() == NUMBERS * self.list.len()
    }
}

impl Source {
    fn value(&self, frame: &Frame, row: &[f64]) -> f64 {
        match self {
            Self::Column(column) => row.get(*column).copied().unwrap_or(f64::NAN),
            Self::Probe(probe) => probe.value(frame),
            Self::Frequency(..) => f64::NAN,
        }
    }
}

/// The value at a time, where the stretch from one row to the next holds it: linear between the two.
fn between([t0, v0]: [f64; 2], [t1, v1]: [f64; 2], wanted: f64) -> Option<f64> {
    let slack = SAME_TIME * t1.abs().max(wanted.abs());
    if (wanted - t1).abs() <= slack {
        return Some(v1);
    }
    (t0 < wanted && wanted < t1).then(|| v0 + (v1 - v0) * (wanted - t0) / (t1 - t0))
}

fn find(
    model: &Model,
    columns: &[String],
    part: &case::Expectation,
) -> Result<Source, Box<Diagnostic>> {
    let what = &part.what;
    // the name of a step is not a number
    let column = columns.iter().position(|c| *c == what.value && c != "step");
    if let Some(column) = column {
        return Ok(Source::Column(column));
    }
    if let Some(source) = frequency(model, &what.value) {
        return Ok(source);
    }
    match Probe::parse(model, &what.value) {
        Some(Ok(probe)) => Ok(Source::Probe(probe)),
        Some(Err(error)) => Err(Box::new(
            Diagnostic::error(&codes::UNDEFINED, format!("[[expect]]: {error}"))
                .at(&what.place, "")
                .note(format!(
                    "quantities at nodes: {}",
                    quantities().collect::<Vec<_>>().join(", ")
                )),
        )),
        None => {
            let names = || columns.iter().map(String::as_str);
            let remark = closest(&what.value, names()).map_or_else(
                || "no such column in history.csv".into(),
                |c| format!("did you mean \"{c}\"?"),
            );
            Err(Box::new(
                Diagnostic::error(
                    &codes::UNDEFINED,
                    format!("[[expect]]: there is no column \"{}\"", what.value),
                )
                .at(&what.place, remark)
                .note(format!("columns: {}", signorini_io::diagnostic::listed(names())))
                .help("name a column of history.csv, or a field at nodes:  \"displacement.z @ node 5\""),
            ))
        }
    }
}

/// `STEP.frequency.NUMBER`: a natural frequency that a step finds.
fn frequency(model: &Model, what: &str) -> Option<Source> {
    let (step, number) = what.split_once(".frequency.")?;
    let number = number.parse::<usize>().ok()?.checked_sub(1)?;
    let mut steps = model.steps.iter();
    let at = steps.position(|one| one.name == step && one.vibration.is_some())?;
    Some(Source::Frequency(at, number))
}

#[cfg(test)]
mod tests {
    use super::between;

    #[test]
    fn a_moment_between_two_rows_is_interpolated() {
        assert_eq!(between([0.0, 1.0], [1.0, 3.0], 0.25), Some(1.5));
        assert_eq!(between([0.0, 1.0], [1.0, 3.0], 1.0 + 1e-12), Some(3.0));
        assert_eq!(between([0.0, 1.0], [1.0, 3.0], 1.5), None);
        assert_eq!(
            between([1.0, 1.0], [2.0, 3.0], 1.0),
            None,
            "told by the row before"
        );
    }
}
