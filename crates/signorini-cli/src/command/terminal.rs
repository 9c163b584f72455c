//! The news on a terminal: lines, colours, and a bar that shows how far the run is.
//!
//! ```text
//!  press ━━━━━━━━━━━━━━━━━━━━━━━╸━━  95 %   inc 6 · iter 2 · 0:03 so far · about 0:01 left
//! ```

use super::console::Console;
use super::signals::{self, Notice};
use signorini::run::narration::{Level, Line, Narrator};
use signorini::run::{Detail, Stop};
use signorini::text::clock;
use signorini::{Diagnostics, Listener, News};
use signorini_io::writers::json::Event;
use signorini_mechanics::solve::Flow;
use std::time::{Duration, Instant};

/// The bar is drawn again after this time at the earliest.
const REDRAW: Duration = Duration::from_millis(100);
/// Cells of the bar.
const WIDTH: usize = 26;
/// Part of the run from which on the time left means something.
const KNOWN: f64 = 0.05;

/// Shows the news on standard error.
pub struct Terminal {
    console: Console,
    narrator: Narrator,
    level: Level,
    bar: Option<Bar>,
    notice: Notice,
}

impl Terminal {
    /// A terminal that shows lines up to a level; with a bar only where someone can see it.
    pub fn new(level: Level, progress: bool, notice: Notice) -> Self {
        let console = Console::stderr();
        let wants_bar = progress && console.terminal && level >= Level::Normal;
        Self {
            bar: wants_bar.then(Bar::default),
            narrator: Narrator::default(),
            console,
            level,
            notice,
        }
    }

    /// The level that options ask for.
    pub fn level(quiet: bool, verbose: bool) -> Level {
        match (quiet, verbose) {
            (true, _) => Level::Important,
            (_, true) => Level::Verbose,
            _ => Level::Normal,
        }
    }

    fn show(&self, line: &Line) {
        let text = &line.text;
        if !self.console.colour {
            return self.console.line(text);
        }
        let mut out = text.replace('✓', "\x1b[32m✓\x1b[0m");
        out = out.replace('✗', "\x1b[31m✗\x1b[0m");
        out = out.replace("← slow", "\x1b[33m← slow\x1b[0m");
        self.console.line(&out);
    }
}

impl Listener for Terminal {
    fn hear(&mut self, news: &News<'_>) -> Flow {
        if may_stop(news.event)
            && let Some(line) = self.notice.line()
        {
            signals::show(&self.console, &line);
        }
        let lines = self.narrator.lines(news);
        let wanted = lines.iter().filter(|line| line.level <= self.level);
        let wanted: Vec<&Line> = wanted.collect();
        if let Some(bar) = &mut self.bar {
            bar.watch(news);
            if !wanted.is_empty() {
                bar.wipe(&self.console);
            }
        }
        match news.detail {
            Detail::Finding(one) if !wanted.is_empty() => {
                self.console.findings(&Diagnostics::from(one.clone()));
            }
            _ => wanted.iter().for_each(|line| self.show(line)),
        }
        if let Some(bar) = &mut self.bar {
            bar.draw(&self.console);
        }
        Flow::Continue
    }

    fn opens_files(&self) -> bool {
        false
    }
}

/// Whether a run goes on after an event, or was stopped with it.
fn may_stop(event: &Event) -> bool {
    match event {
        Event::End { status, .. } => Stop::STATUSES.contains(&status.as_str()),
        Event::Expect { .. } | Event::Diagnostic { .. } => false,
        _ => true,
    }
}

/// How far a run is.
struct Bar {
    start: Instant,
    /// When the run began here, and at which part of it.
    base: Option<(Instant, f64)>,
    drawn: Option<Instant>,
    shown: bool,
    duration: f64,
    time: f64,
    step: String,
    increment: u64,
    iteration: u64,
    ended: bool,
}

impl Default for Bar {
    fn default() -> Self {
        Self {
            start: Instant::now(),
            base: None,
            drawn: None,
            shown: false,
            duration: 0.0,
            time: 0.0,
            step: String::new(),
            increment: 0,
            iteration: 0,
            ended: false,
        }
    }
}

impl Bar {
    fn watch(&mut self, news: &News<'_>) {
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
            Event::Expect { .. } | Event::End { .. } => self.ended = true,
            _ => {}
        }
    }

    fn part(&self) -> f64 {
        (self.time / self.duration).clamp(0.0, 1.0)
    }

    fn wipe(&mut self, console: &Console) {
        if std::mem::take(&mut self.shown) {
            console.text("\r\x1b[2K");
        }
    }

    fn draw(&mut self, console: &Console) {
        let recent = self.drawn.is_some_and(|at| at.elapsed() < REDRAW);
        if self.ended || self.step.is_empty() || recent {
            return;
        }
        console.text(&format!("\r\x1b[2K{}", self.text()));
        self.drawn = Some(Instant::now());
        self.shown = true;
    }

    fn text(&self) -> String {
        let part = self.part();
        let full = (part * WIDTH as f64) as usize;
        let bar: String = (0..WIDTH)
            .map(|k| match k {
                k if k < full => '━',
                k if k == full => '╸',
                _ => ' ',
            })
            .collect();
        let left = self
            .left()
            .map_or_else(|| "—".to_owned(), |s| format!("about {}", clock(s)));
        format!(
            " {} {bar} {:>3.0} %   inc {} · iter {} · {} so far · {left} left",
            self.step,
            100.0 * part,
            self.increment,
            self.iteration,
            clock(self.start.elapsed().as_secs_f64())
        )
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
