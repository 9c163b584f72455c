use crate::system::{StepContext, TimeFunction, interpolate};

/// How a load goes over its step, as a factor of its full size.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Course {
    /// Linearly, from what it was before the step.
    #[default]
    Ramp,
    /// Rows of time of the step and factor, linear between, constant outside.
    Table(Vec<[f64; 2]>),
    /// Rows of total time and factor; it goes on through later steps.
    TotalTable(Vec<[f64; 2]>),
    /// A function of time of the step.
    Function(TimeFunction),
    /// A function of total time; it goes on through later steps.
    TotalFunction(TimeFunction),
}

impl Course {
    /// Whether it goes on through later steps.
    #[must_use]
    pub const fn goes_on(&self) -> bool {
        matches!(self, Self::TotalTable(_) | Self::TotalFunction(_))
    }
}

/// The factor of a load through all steps. It is known beforehand: a function of step and time alone, so that a resumed
/// run finds the same bits.
///
/// A load that replaces another is a second one: the first fades to zero while the second grows from zero. For
/// loads of the same kind in the same place the sum is the straight line from the old to the new (E1).
///
/// # Example
/// ```
/// use signorini_mechanics::load::Schedule;
/// use signorini_mechanics::system::StepContext;
///
/// // to full size in the first step, back to half of it in the second
/// let schedule = Schedule::ramps(&[1.0, 0.5]);
/// let first = StepContext::default();
/// let second = StepContext { number: 1, start: 1.0, ..first };
/// assert_eq!((schedule.at(&first, 0.5), schedule.at(&second, 1.5)), (0.5, 0.75));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Schedule {
    /// One for each step.
    stretches: Vec<Stretch>,
    /// The factor at the end of the last.
    end: f64,
    /// Whether what it acts on takes part only in some steps.
    is_partial: bool,
}

/// The factor during one step.
#[derive(Clone, Debug, PartialEq)]
enum Stretch {
    Line([f64; 2]),
    Table(Vec<[f64; 2]>),
    TotalTable(Vec<[f64; 2]>),
    Function(TimeFunction),
    TotalFunction(TimeFunction),
}

impl Stretch {
    fn at(&self, step: &StepContext, time: f64) -> f64 {
        match self {
            Self::Line([from, to]) => {
                let fraction = ((time - step.start) / step.duration).clamp(0.0, 1.0);
                from + (to - from) * fraction
            }
            Self::Table(table) => interpolate(table, time - step.start),
            Self::TotalTable(table) => interpolate(table, time),
            Self::Function(function) => function.at(time - step.start),
            Self::TotalFunction(function) => function.at(time),
        }
    }

    /// The factor at the end of a step.
    fn end(&self, step: &StepContext) -> f64 {
        match self {
            Self::Line([_, to]) => *to,
            Self::Table(table) => interpolate(table, step.duration),
            Self::TotalTable(table) => interpolate(table, step.start + step.duration),
            Self::Function(function) => function.at(step.duration),
            Self::TotalFunction(function) => function.at(step.start + step.duration),
        }
    }

    fn is_zero(&self) -> bool {
        match self {
            Self::Line(ends) => *ends == [0.0; 2],
            Self::Table(table) | Self::TotalTable(table) => table.iter().all(|row| row[1] == 0.0),
            Self::Function(_) | Self::TotalFunction(_) => false,
        }
    }
}

impl Schedule {
    /// Zero during the first `nstep` steps.
    #[must_use]
    pub fn idle(nstep: usize) -> Self {
        Self::ramps(&vec![0.0; nstep])
    }

    /// Linearly from zero, and from step to step, to these values at the ends of the steps.
    #[must_use]
    pub fn ramps(ends: &[f64]) -> Self {
        let mut schedule = Self::default();
        for &to in ends {
            schedule.line(schedule.end, to);
        }
        schedule
    }

    /// In the next step the load takes its course.
    pub fn begin(&mut self, course: &Course, step: &StepContext) {
        let stretch = match course {
            Course::Ramp => Stretch::Line([self.end, 1.0]),
            Course::Table(table) => Stretch::Table(table.clone()),
            Course::TotalTable(table) => Stretch::TotalTable(table.clone()),
            Course::Function(function) => Stretch::Function(function.clone()),
            Course::TotalFunction(function) => Stretch::TotalFunction(function.clone()),
        };
        self.push(stretch, step);
    }

    /// In the next step the load stays as it is; a table or function of total time goes on.
    pub fn stay(&mut self, step: &StepContext) {
        match self.stretches.last() {
            Some(stretch @ (Stretch::TotalTable(_) | Stretch::TotalFunction(_))) => {
                let stretch = stretch.clone();
                self.push(stretch, step);
            }
            _ => self.line(self.end, self.end),
        }
    }

    /// In the next step the load goes linearly to zero.
    pub fn fade(&mut self) {
        self.line(self.end, 0.0);
    }

    /// From the next step on the load is gone.
    pub fn stop(&mut self) {
        self.line(0.0, 0.0);
    }

    /// The factor at a total time within a step; after the last step it stays.
    #[must_use]
    pub fn at(&self, step: &StepContext, time: f64) -> f64 {
        let stretch = self.stretches.get(step.number);
        stretch.map_or(self.end, |s| s.at(step, time))
    }

    /// Whether the load acts at all during a step.
    #[must_use]
    pub fn acts(&self, step: &StepContext) -> bool {
        let stretch = self.stretches.get(step.number);
        stretch.map_or(self.end != 0.0, |s| !s.is_zero())
    }

    /// The same where what it acts on takes part only in some steps: `active` says in which, and `ramps` in which of the
    /// others it fades when it goes. Where it comes again, it grows from zero.
    ///
    /// # Example
    /// ```
    /// use signorini_mechanics::load::Schedule;
    /// use signorini_mechanics::system::StepContext;
    ///
    /// let step = |number: usize| StepContext { number, start: number as f64, ..StepContext::default() };
    /// let steps = [0, 1, 2].map(step);
    /// let weight = Schedule::ramps(&[1.0; 3]).partial(&[true, false, true], &[false, true, false], &steps);
    /// let halfway = steps.map(|step| weight.at(&step, step.start + 0.5));
    /// assert_eq!(halfway, [0.5, 0.5, 0.5]);
    /// let ends = steps.map(|step| weight.at(&step, step.start + 1.0));
    /// assert_eq!(ends, [1.0, 0.0, 1.0]);
    /// ```
    #[must_use]
    pub fn partial(&self, active: &[bool], ramps: &[bool], steps: &[StepContext]) -> Self {
        let is = |of: &[bool], step: usize| of.get(step).copied().unwrap_or(true);
        let mut out = Self {
            is_partial: true,
            ..Self::default()
        };
        for (number, step) in steps.iter().enumerate() {
            let was = number
                .checked_sub(1)
                .is_none_or(|before| is(active, before));
            match (was, is(active, number), self.stretches.get(number)) {
                (true, true, Some(stretch)) => out.push(stretch.clone(), step),
                (true, true, None) => out.line(self.end, self.end),
                (false, true, Some(Stretch::Line([_, to]))) => out.line(0.0, *to),
                (false, true, Some(stretch)) => out.push(stretch.clone(), step),
                (false, true, None) => out.line(0.0, self.end),
                (true, false, _) if number > 0 && is(ramps, number) => out.fade(),
                (_, false, _) => out.stop(),
            }
        }
        out
    }

    fn line(&mut self, from: f64, to: f64) {
        self.stretches.push(Stretch::Line([from, to]));
        self.end = to;
    }

    fn push(&mut self, stretch: Stretch, step: &StepContext) {
        self.end = stretch.end(step);
        self.stretches.push(stretch);
    }
}

/// A schedule at the present step, as terms carry it.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    schedule: Schedule,
    step: StepContext,
}

impl Clock {
    pub fn new(schedule: Schedule) -> Self {
        Self {
            schedule,
            step: StepContext::default(),
        }
    }

    pub const fn begin_step(&mut self, step: &StepContext) {
        self.step = *step;
    }

    /// The number of the step, from 0.
    pub const fn number(&self) -> usize {
        self.step.number
    }

    /// Whether displacements may be large.
    pub const fn nonlinear(&self) -> bool {
        self.step.nonlinear
    }

    pub fn factor(&self, time: f64) -> f64 {
        self.schedule.at(&self.step, time)
    }

    pub fn acts(&self) -> bool {
        self.schedule.acts(&self.step)
    }

    /// Whether what it acts on may take no part in this step: elements that do have the pattern anyway.
    pub fn is_away(&self) -> bool {
        self.schedule.is_partial && !self.acts()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(number: usize, start: f64) -> StepContext {
        StepContext {
            number,
            start,
            duration: 2.0,
            nonlinear: true,
            scheme: None,
            vibrates: false,
            physics: crate::system::Physics::default(),
            cycles: 1.0,
            ..StepContext::default()
        }
    }

    #[test]
    fn a_ramp_keeps_its_last_value_and_fades_from_it() {
        let mut load = Schedule::idle(1);
        load.begin(&Course::Ramp, &step(1, 2.0));
        load.stay(&step(2, 4.0));
        load.fade();
        let at = |number: usize, time: f64| load.at(&step(number, 2.0 * number as f64), time);
        assert_eq!(at(0, 1.0), 0.0);
        assert_eq!([2.0, 2.5, 4.0].map(|t| at(1, t)), [0.0, 0.25, 1.0]);
        assert_eq!([4.0, 5.0, 6.0].map(|t| at(2, t)), [1.0; 3]);
        assert_eq!([6.0, 7.0, 8.0].map(|t| at(3, t)), [1.0, 0.5, 0.0]);
        assert_eq!(at(4, 9.0), 0.0);
        let acts = [0, 1, 2, 3, 4].map(|n| load.acts(&step(n, 0.0)));
        assert_eq!(acts, [false, true, true, true, false]);
    }

    #[test]
    fn a_table_of_the_step_ends_with_it_and_one_of_total_time_goes_on() {
        let rows = vec![[0.0, 0.5], [1.0, 1.0], [3.0, 3.0], [5.0, -1.0]];
        let first = step(0, 0.0);
        let mut load = Schedule::default();
        load.begin(&Course::Table(rows.clone()), &first);
        load.stay(&step(1, 2.0));
        // at the end of its step the table stands at 2, wherever its rows go
        assert_eq!([0.0, 1.0, 2.0].map(|t| load.at(&first, t)), [0.5, 1.0, 2.0]);
        assert_eq!([2.0, 3.0].map(|t| load.at(&step(1, 2.0), t)), [2.0, 2.0]);

        let mut load = Schedule::default();
        load.begin(&Course::TotalTable(rows), &first);
        load.stay(&step(1, 2.0));
        load.fade();
        let second = [2.0, 3.0, 4.0].map(|t| load.at(&step(1, 2.0), t));
        assert_eq!(second, [2.0, 3.0, 1.0]);
        let third = [4.0, 5.0, 6.0].map(|t| load.at(&step(2, 4.0), t));
        assert_eq!(third, [1.0, 0.5, 0.0]);
    }
}
