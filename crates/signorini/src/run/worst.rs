//! What an audit found where it was worst.

use signorini_mechanics::system::Measured;

/// The results of one check.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Worst {
    /// The worst of all increments.
    pub measured: Measured,
    /// When.
    pub time: f64,
    /// Increments in which it did not pass, and the time of the first.
    pub failed: u64,
    pub first: f64,
}

impl Worst {
    /// In which of so many increments it failed.
    pub fn times(&self, increments: u64) -> String {
        match self.failed {
            1 => format!(
                "in 1 of {increments} increments, at time {}",
                number(self.time)
            ),
            n => format!(
                "in {n} of {increments} increments, first at time {}, worst at {}",
                number(self.first),
                number(self.time)
            ),
        }
    }

    pub fn take(&mut self, measured: &Measured, time: f64) {
        if !measured.passes() {
            if self.failed == 0 {
                self.first = time;
            }
            self.failed += 1;
        }
        let worse = measured.part > self.measured.part || measured.part.is_nan();
        if worse || self.measured.limit == 0.0 {
            self.measured = measured.clone();
            self.time = time;
        }
    }
}

/// Four digits, without zeros at the end.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e5).contains(&size) {
        let digits = if size > 0.0 {
            3 - size.log10().floor() as i32
        } else {
            0
        };
        let text = format!("{value:.*}", digits.max(0) as usize);
        if text.contains('.') {
            return text.trim_end_matches('0').trim_end_matches('.').to_owned();
        }
        return text;
    }
    format!("{value:.3e}")
}
