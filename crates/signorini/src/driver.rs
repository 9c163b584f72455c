//! A run that its caller drives: some time, then something else, then some time more.
//!
//! Nothing is written; frames are handed over. For coupling with other programs, for optimisation, and for looking at a
//! run from inside.

use crate::run::births::{self, Watch};
use crate::run::{Saved, bad_checkpoint, begin, cannot_resume, failure_message, solution};
use crate::setup::Model;
use signorini_io::checkpoint::{self, Stamp};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::solve::{Cycle, Event, Flow, Outcome, Stepper};
use signorini_mechanics::system::{Archive, Frame};

/// A model with the state it is in.
///
/// # Example
/// ```
/// use signorini::{Driver, Reading, build, open_text};
///
/// let text = r#"
/// [mesh]
/// nodes = [
///   [1, 0.0, 0.0], [2, 1.0, 0.0], [3, 1.0, 1.0], [4, 0.0, 1.0],
/// ]
/// elements = [{ id = 1, type = "quad4", group = "plate", nodes = [1, 2, 3, 4] }]
/// [model]
/// space = "plane-stress"
/// [sets]
/// base = { nodes = [1, 2] }
/// head = { nodes = [3, 4] }
/// [material.soft]
/// model = "linear-elastic"
/// E = 1000.0
/// nu = 0.0
/// [[body]]
/// group = "plate"
/// material = "soft"
/// [[step]]
/// name = "pull"
/// geometry = "linear"
/// fix = [{ on = "base", u = "all" }]
/// move = [{ on = "head", ux = 0.0, uy = 0.01 }]
/// "#;
/// let loaded = open_text("plate.toml".as_ref(), text.into(), &Reading::default())?.with_mesh()?;
/// let mut driver = Driver::new(build(loaded.case, loaded.mesh)?)?;
/// let frame = driver.advance(0.25, &mut |_| signorini_mechanics::solve::Flow::Continue)?;
/// assert!((frame.displacement[2].y - 0.0025).abs() < 1e-12);
/// let state = driver.save()?;
/// driver.advance(0.75, &mut |_| signorini_mechanics::solve::Flow::Continue)?;
/// assert!(driver.is_done());
/// driver.restore(&state)?;
/// assert!((driver.time() - 0.25).abs() < 1e-12);
/// # Ok::<(), signorini::Diagnostics>(())
/// ```
pub struct Driver {
    model: Model,
    stepper: Stepper,
    frame: Frame,
    /// For contact that begins, where nobody names pairs.
    watch: Option<Watch>,
}

/// States go from one model to another: what does not fit is found array by array.
const ANY_CASE: [u8; 32] = [0; 32];

impl Driver {
    /// A model in its undeformed state.
    ///
    /// # Errors
    /// An undeformed state that cannot be evaluated: exit code 4.
    pub fn new(mut model: Model) -> Result<Self, Diagnostics> {
        let start = begin(&mut model)?;
        let stepper = Stepper::new(&model.system, model.settings).with_cycles(each(&model.cycles));
        Ok(Self {
            watch: Watch::new(&model, &stepper),
            stepper,
            model,
            frame: start.frame,
        })
    }

    /// The model.
    #[must_use]
    pub const fn model(&self) -> &Model {
        &self.model
    }

    /// The results at the present state.
    #[must_use]
    pub const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The total time that was reached.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.stepper.state().time
    }

    /// The end of the last step.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.model.steps.iter().map(|step| step.duration).sum()
    }

    /// Whether all steps are done.
    #[must_use]
    pub fn is_done(&self) -> bool {
        let end = self.end();
        end - self.time() <= 1e-12 * end
    }

    /// Goes forward by a time, in one increment or several, and no further than the last step; `observe` learns what
    /// happens, and may stop it.
    ///
    /// # Errors
    /// A time that is not positive; an increment that does not converge, where the state is the last one that did.
    pub fn advance(
        &mut self,
        by: f64,
        observe: &mut dyn FnMut(&Event<'_>) -> Flow,
    ) -> Result<&Frame, Diagnostics> {
        if !(by > 0.0 && by.is_finite()) {
            let message = format!("a run cannot go forward by {by}");
            let one = Diagnostic::error(&codes::OUT_OF_RANGE, message);
            return Err(one.help("a time above 0").into());
        }
        let until = self.time() + by;
        let mut last: Option<Frame> = None;
        let mut increments = 0;
        let mut observer = |event: &Event<'_>| {
            if let Event::Increment { frame, .. } = event {
                last = Some((*frame).clone());
                increments += 1;
            }
            observe(event)
        };
        let outcome = match &mut self.watch {
            None => {
                let Model { system, steps, .. } = &mut self.model;
                self.stepper.run_until(system, steps, until, &mut observer)
            }
            Some(watch) => loop {
                let (model, stepper) = (&mut self.model, &mut self.stepper);
                let done = watch.increment(model, stepper, Some(until), &mut observer)?;
                let left = until - self.stepper.state().time;
                let is_over = done.is_stopped || left <= 1e-12 * until;
                if is_over || !matches!(done.outcome, Ok(Outcome::Stopped)) {
                    break done.outcome;
                }
            },
        };
        if let Some(frame) = last {
            self.frame = frame;
        }
        match outcome {
            Ok(Outcome::Finished | Outcome::Stopped) => Ok(&self.frame),
            Err(error) => {
                let saved = Saved {
                    increments,
                    folder: String::new(),
                };
                Err(failure_message(&error, &self.model, &saved).into())
            }
        }
    }

    /// The state, to go on from later, in this process or another: a checkpoint without its folder.
    ///
    /// # Errors
    /// An array that no checkpoint can have.
    pub fn save(&self) -> Result<Vec<u8>, Diagnostics> {
        let mut archive = checkpoint::Archive::new();
        solution::put(&self.solution(), &mut archive).map_err(cannot_resume)?;
        births::put(&self.model, &mut archive).map_err(cannot_resume)?;
        let stamp = Stamp {
            step: self.frame.step_number as u64,
            increment: self.frame.increment as u64,
            time: self.time(),
        };
        Ok(checkpoint::to_bytes(&ANY_CASE, stamp, &archive))
    }

    /// Goes back, or forward, to a state of this model.
    ///
    /// # Errors
    /// Bytes that are no state, or one of another model; the state is what it was.
    pub fn restore(&mut self, state: &[u8]) -> Result<(), Diagnostics> {
        let from = checkpoint::from_bytes(state, &ANY_CASE);
        let from = from.map_err(|error| bad_checkpoint(&error))?;
        let before = self.save()?;
        let taken = self.go_to(&from.archive);
        if taken.is_err() {
            // terms may have taken a part of it
            let before = checkpoint::from_bytes(&before, &ANY_CASE);
            let before = before.map_err(|error| bad_checkpoint(&error))?;
            self.go_to(&before.archive)?;
        }
        taken
    }

    fn go_to(&mut self, archive: &checkpoint::Archive) -> Result<(), Diagnostics> {
        births::take(&mut self.model, archive)?;
        self.take(&solution::of(archive))
    }

    /// Goes on with another model of the same unknowns, from the present state: one whose loads, materials or contacts have
    /// other numbers.
    ///
    /// # Errors
    /// A model of other unknowns, or one that cannot be evaluated.
    pub fn replace(&mut self, model: Model) -> Result<(), Diagnostics> {
        let solution = self.solution();
        let mut found = checkpoint::Archive::new();
        births::put(&self.model, &mut found).map_err(cannot_resume)?;
        let mut model = model;
        births::take(&mut model, &found)?;
        let mut other = Self::new(model)?;
        other.take(&solution)?;
        *self = other;
        Ok(())
    }

    fn solution(&self) -> Archive {
        let mut solution = Archive::default();
        self.stepper.save(&self.model.system, &mut solution);
        solution
    }

    fn take(&mut self, archive: &Archive) -> Result<(), Diagnostics> {
        let Model {
            system,
            settings,
            cycles,
            ..
        } = &mut self.model;
        let stepper = Stepper::resumed(system, *settings, archive);
        let stepper = stepper.map_err(cannot_resume)?;
        self.stepper = stepper.with_cycles(each(cycles));
        let frame = self.stepper.report(system);
        self.frame = frame.map_err(cannot_resume)?;
        self.watch = Watch::new(&self.model, &self.stepper);
        let step = self.model.steps.get(self.frame.step_number);
        self.frame.step = step.map_or_else(String::new, |step| step.name.clone());
        Ok(())
    }
}
/// Cycles of which each is solved: who stops between increments sees no one that stands for many.
fn each(cycles: &[Cycle]) -> Vec<Cycle> {
    let solved = |cycle: &Cycle| Cycle {
        jump: None,
        ..*cycle
    };
    cycles.iter().map(solved).collect()
}
