//! The bar: how far a run is, in one line that is drawn again and again.

use crate::command::console::ascii;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use signorini::News;
use signorini::run::Detail;
use signorini::text::clock;
use signorini_io::writers::json::Event;
use std::time::Instant;

/// The bar is drawn so many times a second at most.
const RATE: u8 = 10;
/// Steps of the bar.
const WHOLE: u64 = 10_000;
/// Cells of the bar at most, and at least.
const CELLS: [usize; 2] = [26, 6];
/// Letters of the name of a step at most.
const NAME: usize = 12;
/// Part of the run from which on the time left means something.
const KNOWN: f64 = 0.05;

/// How far a run is.
pub struct Bar {
    line: ProgressBar,
    ascii: bool,
    width: usize,
    start: Instant,
    /// When the run began here, and at which part of it.
    base: Option<(Instant, f64)>,
    duration: f64,
    time: f64,
    step: String,
    increment: u64,
    iteration: u64,
}

impl Bar {
    /// A bar that is not drawn before there is something to show.
    pub fn new(ascii: bool) -> Self {
        let target = ProgressDrawTarget::stderr_with_hz(RATE);
        Self {
            line: ProgressBar::with_draw_target(Some(WHOLE), target),
            ascii,
            width: 0,
            start: Instant::now(),
            base: None,
            duration: 0.0,
            time: 0.0,
            step: String::new(),
            increment: 0,
            iteration: 0,
        }
    }

    /// Writes lines above the bar.
    pub fn behind(&self, write: impl FnOnce()) {
        if self.width == 0 {
            write();
        } else {
            self.line.suspend(write);
        }
    }

    /// Takes what there is to show from the news, and draws it on a terminal of this width.
    pub fn watch(&mut self, news: &News<'_>, width: usize) {
        if let Detail::Start(facts) = news.detail {
            self.duration = facts.duration;
        }
        match news.event {
            Event::Iteration {
                step, inc, iter, ..
            } => {
                self.step.clone_from(step);
                (self.increment, self.iteration) = (*inc, *iter);
            }
            Event::Increment { time, .. } => {
                self.time = *time;
                self.base.get_or_insert((Instant::now(), self.part()));
            }
            Event::Expect { .. } | Event::End { .. } => return self.line.finish_and_clear(),
            _ => {}
        }
        if !self.step.is_empty() && !self.line.is_finished() {
            self.draw(width);
        }
    }

    fn part(&self) -> f64 {
        let part = (self.time / self.duration).clamp(0.0, 1.0);
        if part.is_nan() { 0.0 } else { part }
    }

    fn draw(&mut self, width: usize) {
        let (cells, message) = self.content(width);
        if width != self.width {
            self.width = width;
            let style = ProgressStyle::with_template(&style(cells));
            let letters = if self.ascii { "=> " } else { "━╸ " };
            if let Ok(style) = style {
                self.line.set_style(style.progress_chars(letters));
            }
        }
        self.line.set_prefix(self.name());
        self.line.set_message(message);
        self.line.set_position((self.part() * WHOLE as f64) as u64);
    }

    fn name(&self) -> String {
        let name = self.shown(self.step.clone());
        name.chars().take(NAME).collect()
    }

    /// Cells of the bar, and the text behind it, for a terminal of this width. The bar stays as it is while the text changes.
    fn content(&self, width: usize) -> (usize, String) {
        let [most, least] = CELLS;
        // ` name bar 100 %  text`, and the last column stays free
        let taken = 1 + NAME + 1 + 1 + 5 + 2 + 1;
        let room = width.saturating_sub(taken);
        let now = format!("inc {} · iter {}", self.increment, self.iteration);
        let so_far = clock(self.start.elapsed().as_secs_f64());
        let left = self.left();
        let about = left.map_or_else(|| "—".to_owned(), |s| format!("about {}", clock(s)));
        let left = left.map_or_else(|| "—".to_owned(), clock);
        // with the most letters that each may have
        let texts = [
            (58, format!("{now} · {so_far} so far · {about} left")),
            (42, format!("{now} · {so_far} · {left} left")),
            (30, format!("{now} · {so_far}")),
            (20, now),
        ];
        let fitting = texts
            .into_iter()
            .find(|(letters, _)| letters + least <= room);
        let (letters, text) = fitting.unwrap_or_default();
        let text: String = text.chars().take(letters).collect();
        (room.saturating_sub(letters).min(most), self.shown(text))
    }

    /// A text in the letters of the terminal.
    fn shown(&self, text: String) -> String {
        match self.ascii {
            true => ascii(&text),
            false => text,
        }
    }

    /// Seconds left, once there is something to estimate them from.
    fn left(&self) -> Option<f64> {
        let (at, from) = self.base?;
        let done = self.part() - from;
        let rate = done / at.elapsed().as_secs_f64();
        let left = (1.0 - self.part()) / rate;
        (done > KNOWN && left.is_finite()).then_some(left)
    }
}

fn style(cells: usize) -> String {
    format!(" {{prefix}} {{bar:{cells}}} {{percent:>3}} %  {{msg}}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_fits_every_terminal() {
        let mut bar = Bar::new(false);
        bar.step = "a long name of a step".into();
        (bar.increment, bar.iteration) = (1234, 123);
        bar.duration = 1.0;
        for width in 30..200 {
            let (cells, text) = bar.content(width);
            let name = bar.name().chars().count();
            let all = 1 + name + 1 + cells + 1 + 5 + 2 + text.chars().count();
            assert!(all < width, "{width}: {all} {text}");
            assert!(ProgressStyle::with_template(&style(cells)).is_ok());
        }
        assert!(bar.content(80).1.ends_with(" left"));
        let (_, text) = bar.content(120);
        assert!(text.ends_with("so far · — left"), "{text}");
    }
}
