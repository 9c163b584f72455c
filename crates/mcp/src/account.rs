//! What the events of a run say: messages, progress, and how it ended.

use crate::reply::counted;
use serde_json::Value;
use std::time::{Duration, Instant};

/// The least time between two reports of progress, except for converged increments after a while.
const PAUSE: Duration = Duration::from_millis(200);

/// What has been heard of a run.
#[derive(Debug, Default)]
pub struct Account {
    /// Messages, at most as many as are wanted.
    pub diagnostics: Vec<Value>,
    /// Messages that came after those.
    pub more: usize,
    /// Checked values.
    pub expectations: Vec<Value>,
    /// The event that started it; none: nothing was solved.
    pub start: Option<Value>,
    /// The last converged increment.
    pub increment: Option<Value>,
    /// Converged increments.
    pub increments: usize,
    /// Iterations of converged increments, which the summary and `status` count, too.
    pub iterations: usize,
    /// Cut-backs.
    pub cutbacks: usize,
    /// The event that ended it.
    pub end: Option<Value>,
    reported: Option<Instant>,
}

impl Account {
    /// Takes in a line of events; returns what to report as progress. Lines that are no events are left out.
    pub fn hear(&mut self, line: &[u8], most: usize) -> Option<String> {
        let event: Value = serde_json::from_slice(line).ok()?;
        match event.get("ev")?.as_str()? {
            "diagnostic" if self.diagnostics.len() < most => self.diagnostics.push(bare(event)),
            "diagnostic" => self.more += 1,
            "expect" => self.expectations.push(bare(event)),
            "start" => self.start = Some(bare(event)),
            "end" => self.end = Some(bare(event)),
            "iteration" => return self.report(|| in_words(&event, "iteration", "iter")),
            "cutback" => {
                self.cutbacks += 1;
                return self.report(|| {
                    let why = event.get("why").and_then(Value::as_str).unwrap_or_default();
                    format!("{}: cut back, {why}", place(&event))
                });
            }
            "increment" => {
                self.increments += 1;
                let iterations = event.get("iters").and_then(Value::as_u64);
                self.iterations += iterations.unwrap_or_default() as usize;
                let text = in_words(&event, "time", "time");
                self.increment = Some(bare(event));
                return self.report(|| format!("{text}, converged"));
            }
            _ => {}
        }
        None
    }

    /// A report, unless there was one just before.
    fn report(&mut self, text: impl FnOnce() -> String) -> Option<String> {
        let now = Instant::now();
        let is_due = self.reported.is_none_or(|last| now - last >= PAUSE);
        is_due.then(|| {
            self.reported = Some(now);
            text()
        })
    }

    /// How it ended, as the run says.
    pub fn status(&self) -> Option<&str> {
        self.end.as_ref()?.get("status")?.as_str()
    }

    /// What was done, in words.
    pub fn work(&self) -> String {
        let mut text = format!(
            "{}, {}, {}",
            counted(self.increments, "increment"),
            counted(self.iterations, "iteration"),
            counted(self.cutbacks, "cut-back")
        );
        if let Some(time) = self.increment.as_ref().and_then(|one| one.get("time")) {
            text.push_str(&format!(", time {time} reached"));
        }
        text
    }
}

/// An event without its version and kind.
fn bare(mut event: Value) -> Value {
    if let Some(members) = event.as_object_mut() {
        members.remove("v");
        members.remove("ev");
    }
    event
}

fn place(event: &Value) -> String {
    let step = event.get("step").and_then(Value::as_str).unwrap_or("?");
    let increment = event.get("inc").and_then(Value::as_u64).unwrap_or_default();
    format!("step {step}, increment {increment}")
}

fn in_words(event: &Value, name: &str, key: &str) -> String {
    let value = event.get(key).cloned().unwrap_or_default();
    format!("{}, {name} {value}", place(event))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_add_up() {
        let mut account = Account::default();
        let lines = [
            r#"{"v":1,"ev":"start","nodes":8}"#,
            r#"{"v":1,"ev":"diagnostic","code":"S1"}"#,
            r#"{"v":1,"ev":"diagnostic","code":"S2"}"#,
            r#"{"v":1,"ev":"iteration","step":"press","inc":1,"iter":1}"#,
            r#"{"v":1,"ev":"increment","step":"press","inc":1,"time":0.5,"iters":1}"#,
            // of an attempt that is given up
            r#"{"v":1,"ev":"iteration","step":"press","inc":2,"iter":1}"#,
            r#"{"v":1,"ev":"cutback","step":"press","inc":2,"why":"x"}"#,
            "not json",
            r#"{"v":1,"ev":"new kind"}"#,
            r#"{"v":1,"ev":"expect","what":"a","ok":true}"#,
            r#"{"v":1,"ev":"end","status":"solved","exit_code":0}"#,
        ];
        let reports: Vec<String> = lines
            .iter()
            .filter_map(|line| account.hear(line.as_bytes(), 1))
            .collect();
        // the others came at once after the first
        assert_eq!(reports, ["step press, increment 1, iteration 1"]);
        assert_eq!((account.diagnostics.len(), account.more), (1, 1));
        assert_eq!(account.expectations[0]["what"], "a");
        assert_eq!(account.status(), Some("solved"));
        assert_eq!(
            account.work(),
            "1 increment, 1 iteration, 1 cut-back, time 0.5 reached"
        );
        assert_eq!(account.start.unwrap(), serde_json::json!({ "nodes": 8 }));
    }
}
