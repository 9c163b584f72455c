//! The news on a terminal: lines, colours, and a bar that shows how far the run is.
//!
//! ```text
//!  press ━━━━━━━━━━━━━━━━━━━━━━━╸━━  95 %   inc 6 · iter 2 · 0:03 so far · about 0:01 left
//! ```
//!
//! Lines fit the terminal: the table has columns for its width, and sentences are broken between words.

mod bar;

use super::console::{Console, fitted};
use super::signals::{self, Notice};
use bar::Bar;
use signorini::run::narration::{Level, Line, Narrator, Page};
use signorini::run::{Detail, Stop};
use signorini::{Diagnostics, Listener, News};
use signorini_io::writers::json::Event;
use signorini_mechanics::solve::Flow;

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
        let wants_bar = progress && console.draws && level >= Level::Normal;
        Self {
            bar: wants_bar.then(|| Bar::new(console.ascii)),
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
        let text = match self.console.width() {
            Some(width) => fitted(&line.text, width),
            None => line.text.clone(),
        };
        if !self.console.colour {
            return self.console.line(&text);
        }
        let mut out = text.replace('✓', "\x1b[32m✓\x1b[0m");
        out = out.replace('✗', "\x1b[31m✗\x1b[0m");
        out = out.replace("← slow", "\x1b[33m← slow\x1b[0m");
        self.console.line(&out);
    }

    fn show_all(&self, news: &News<'_>, lines: &[&Line]) {
        match news.detail {
            Detail::Finding(one) if !lines.is_empty() => {
                self.console.findings(&Diagnostics::from(one.clone()));
            }
            _ => lines.iter().for_each(|line| self.show(line)),
        }
    }
}

impl Listener for Terminal {
    fn hear(&mut self, news: &News<'_>) -> Flow {
        if may_stop(news.event)
            && let Some(line) = self.notice.line()
        {
            signals::show(&self.console, &line);
        }
        let width = self.console.width();
        self.narrator
            .turn_to(width.map_or_else(Page::default, |width| Page { width }));
        let lines = self.narrator.lines(news);
        let wanted = lines.iter().filter(|line| line.level <= self.level);
        let wanted: Vec<&Line> = wanted.collect();
        match &self.bar {
            Some(bar) if !wanted.is_empty() => bar.behind(|| self.show_all(news, &wanted)),
            _ => self.show_all(news, &wanted),
        }
        if let Some(bar) = &mut self.bar {
            bar.watch(news, width.unwrap_or_default());
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
