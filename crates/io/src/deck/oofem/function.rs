//! Functions of time: known at the times of the steps, straight between them.

use super::Translation;
use super::expression;
use crate::case::{Amplitude, Factor, TimeBase};
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::oofem::{Fault, Record};

/// A function of the deck.
enum Function {
    Constant(f64),
    Table(Vec<[f64; 2]>),
    Peak { time: f64, value: f64 },
    Step { origin: f64, value: f64 },
    Expression(String),
}

impl Translation {
    pub fn functions(&mut self) {
        let mut records = std::mem::take(&mut self.parts.functions);
        for record in &mut records {
            record.take_kind();
            let number = record.number();
            let Some(number) = self.take(number) else {
                continue;
            };
            let function = self.function(record);
            let function = self.take(function).flatten();
            let values = function.and_then(|function| self.sampled(&function, record));
            if self.functions.values.insert(number, values).is_some() {
                let text = format!("a second function of time has the number {number}");
                self.error(&codes::NAME_TWICE, text, &record.place(), "");
            }
            self.finish(record);
        }
    }

    fn function(&mut self, record: &mut Record) -> Result<Option<Function>, Fault> {
        Ok(Some(match record.kind().as_str() {
            "constantfunction" => Function::Constant(record.need_real("f(t)")?),
            "piecewiselinfunction" => {
                record.ignore("npoints", 1);
                let times = record.need_reals("t")?;
                let values = record.need_reals("f(t)")?;
                if times.len() != values.len() || times.is_empty() {
                    let text = format!(
                        "the function has {} times and {} values",
                        times.len(),
                        values.len()
                    );
                    self.error(&codes::WRONG_LENGTH, text, &record.place(), "");
                    return Ok(None);
                }
                if times.windows(2).any(|pair| pair[0] >= pair[1]) {
                    let text = "the times of the function do not increase";
                    let place = record.place_of_field("t");
                    self.error(&codes::NOT_INCREASING, text, &place, "");
                    return Ok(None);
                }
                let rows = times.into_iter().zip(values);
                Function::Table(rows.map(|(t, f)| [t, f]).collect())
            }
            "peakfunction" => Function::Peak {
                time: record.need_real("t")?,
                value: record.need_real("f(t)")?,
            },
            "heavisideltf" => Function::Step {
                origin: record.need_real("origin")?,
                value: record.need_real("value")?,
            },
            "usrdefltf" => {
                for derivative in ["dfdt(t)", "d2fdt2(t)"] {
                    record.ignore(derivative, 1);
                }
                let Some((text, _)) = record.text("f(t)")? else {
                    let keyword = "f(t)";
                    let error = crate::readers::oofem::RecordError::Missing { keyword };
                    return Err(record.wrong(error));
                };
                Function::Expression(text)
            }
            other => {
                let text = format!("the function of time `{other}` is not supported");
                let known = "ConstantFunction, PiecewiseLinFunction, PeakFunction, HeavisideLTF and UsrDefLTF are";
                self.not_built(text, &record.place(), known);
                record.ignore_all();
                return Ok(None);
            }
        }))
    }

    /// Its values at the ends of all steps.
    fn sampled(&mut self, function: &Function, record: &Record) -> Option<Vec<f64>> {
        let mut values = Vec::with_capacity(self.clock.ends.len());
        for k in 0..self.clock.ends.len() {
            let [time, _] = self.clock.ends.get(k).copied()?;
            let value = match function {
                Function::Constant(value) => *value,
                Function::Table(rows) => {
                    let first = rows.first().map_or(0.0, |row| row[0]);
                    if time < first {
                        let text =
                            format!("the function begins at {first}, after the step at {time}");
                        let remark = "OOFEM gives its time in place of a value there";
                        self.error(&codes::OUT_OF_RANGE, text, &record.place(), remark);
                        return None;
                    }
                    interpolated(rows, time)
                }
                Function::Peak { time: at, value } => {
                    let same = (time - at).abs() <= 1e-9 * at.abs().max(time.abs());
                    if same { *value } else { 0.0 }
                }
                Function::Step { origin, value } if time > *origin => *value,
                Function::Step { origin, .. } if time < *origin => 0.0,
                Function::Step { .. } => {
                    let text = format!("the function jumps at {time}, which is the time of a step");
                    let remark = "shift its origin to one side";
                    self.error(&codes::CONTRADICTION, text, &record.place(), remark);
                    return None;
                }
                Function::Expression(text) => match expression::value(text, time) {
                    Ok(value) => value,
                    Err(error) => {
                        let place = record.place_of_field("f(t)");
                        let message = format!("the function cannot be evaluated: {error}");
                        self.error(&codes::NOT_A_NUMBER, message, &place, "");
                        return None;
                    }
                },
            };
            values.push(value);
        }
        Some(values)
    }

    /// The values of the function that a record names; nothing where it has been refused.
    pub fn course(&mut self, number: u64, place: &Place) -> Option<Vec<f64>> {
        let Some(values) = self.functions.values.get(&number) else {
            let text = format!("there is no function of time {number}");
            self.error(&codes::UNDEFINED, text, place, "");
            return None;
        };
        values.clone()
    }

    /// The function as an amplitude of the case.
    pub fn amplitude(&mut self, number: u64) -> String {
        if let Some(name) = self.functions.named.get(&number) {
            return name.clone();
        }
        let name = self.fresh(&format!("function-{number}"));
        let values = self.functions.values.get(&number).cloned().flatten();
        let ends = self.clock.ends.iter().map(|end| end[1]);
        let mut table = vec![[0.0, 0.0]];
        table.extend(ends.zip(values.unwrap_or_default()).map(|(t, f)| [t, f]));
        self.case.amplitudes.push(Amplitude {
            name: Spanned::from(name.as_str()),
            factor: Factor::Table(without_flats(table)),
            time: TimeBase::Total,
        });
        self.functions.named.insert(number, name.clone());
        name
    }
}

/// Rows without those in the middle of a stretch of equal values.
fn without_flats(rows: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let value = |k: usize| rows.get(k).map(|row| row[1]);
    let is_inside = |k: usize| k > 0 && value(k - 1) == value(k) && value(k) == value(k + 1);
    let kept = rows.iter().enumerate().filter(|(k, _)| !is_inside(*k));
    kept.map(|(_, row)| *row).collect()
}

/// Linear between rows, the last value behind them.
fn interpolated(rows: &[[f64; 2]], time: f64) -> f64 {
    let after = rows.partition_point(|row| row[0] <= time);
    let before = after.checked_sub(1).and_then(|k| rows.get(k));
    match (before, rows.get(after)) {
        (Some([t0, f0]), Some([t1, f1])) => f0 + (f1 - f0) * (time - t0) / (t1 - t0),
        (Some([_, f]), None) | (None, Some([_, f])) => *f,
        (None, None) => 0.0,
    }
}
