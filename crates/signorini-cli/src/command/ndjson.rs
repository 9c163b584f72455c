//! `--json`: every event as a line of JSON on standard output.

use super::console::Console;
use signorini::{Listener, News};
use signorini_mechanics::solve::Flow;

/// Writes events to standard output.
pub struct Ndjson(pub Console);

impl Listener for Ndjson {
    fn hear(&mut self, news: &News<'_>) -> Flow {
        self.0.raw(&news.event.line());
        Flow::Continue
    }
}
