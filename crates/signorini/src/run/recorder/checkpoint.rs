//! Checkpoints: the solution, and how far the files had got.

use super::Recorder;
use crate::run::births;
use crate::run::error::OutputError;
use crate::run::limits::Stop;
use crate::run::news::Detail;
use crate::run::solution;
use crate::setup::Model;
use signorini_io::checkpoint::{Archive, Checkpoint, Stamp};
use signorini_io::writers::frd::Mark;
use signorini_io::writers::json::{Event, StepSummary};
use signorini_mechanics::solve::Stepper;
use std::path::Path;
use std::time::Instant;

impl Recorder<'_> {
    /// Whether a checkpoint is due.
    pub fn is_due(&self) -> bool {
        let (increments, at) = self.saved_at;
        let since = self.counts.increments - increments;
        let by_count = self
            .setting
            .checkpoint_increments
            .is_some_and(|n| since >= n);
        let by_clock = self.setting.checkpoint_wall.is_some_and(|t| {
            let own = at.elapsed() >= t;
            // ranks that have parted save nothing more
            self.setting.ranks.any(own).unwrap_or(false)
        });
        by_count || by_clock
    }

    /// Whether a limit of time ends the run before anything that this process has done was saved: a run that is resumed
    /// under such a limit again and again would never get on.
    pub fn would_stand_still(&self) -> bool {
        let saved = self.saved_at.0;
        self.stop == Some(Stop::Time) && saved == self.began_at && self.counts.increments > saved
    }

    /// Reports the checkpoint from which the run goes on: the files were cut to where they were when it was written, before
    /// it was reported.
    pub fn goes_on_from(&mut self, from: &Checkpoint) {
        self.report_checkpoint(from.stamp, in_folder(&from.path));
    }

    fn report_checkpoint(&mut self, stamp: Stamp, file: String) {
        let step = usize::try_from(stamp.step).ok();
        let event = Event::Checkpoint {
            step: self.step_name(step.unwrap_or(0)),
            inc: stamp.increment,
            time: stamp.time,
            file,
        };
        self.tell(&event, Detail::None);
    }

    /// Writes a checkpoint and returns what the solution needs to go on from it; none where the disk failed.
    pub fn save(
        &mut self,
        stepper: &Stepper,
        model: &Model,
    ) -> Option<signorini_mechanics::system::Archive> {
        let mut solution = signorini_mechanics::system::Archive::default();
        stepper.save(&model.system, &mut solution);
        // counted first: a resumed run reports the checkpoint again
        let clock = Instant::now();
        match self.write_checkpoint(&solution, model, stepper.state().time) {
            Ok((stamp, file)) => {
                self.saved_at = (self.counts.increments, Instant::now());
                self.write_seconds += clock.elapsed().as_secs_f64();
                self.report_checkpoint(stamp, file);
                Some(solution)
            }
            Err(error) => {
                self.error.get_or_insert(error);
                None
            }
        }
    }

    fn write_checkpoint(
        &mut self,
        solution: &signorini_mechanics::system::Archive,
        model: &Model,
        time: f64,
    ) -> Result<(Stamp, String), OutputError> {
        let files = &mut self.files;
        files.history.sync()?;
        files.convergence.sync()?;
        files.sta.sync()?;
        files.events.sync()?;
        if let Some(tables) = &mut files.tables {
            tables.sync()?;
        }
        if let Some(frd) = &mut files.frd {
            frd.sync()?;
        }
        let mut archive = Archive::new();
        solution::put(solution, &mut archive)?;
        births::put(model, &mut archive)?;
        let rows = [
            files.history.nrow(),
            files.convergence.nrow(),
            files.sta.nrow(),
            files.events.nrow(),
        ];
        archive.put_u64("run/rows", &rows)?;
        if let Some(tables) = &files.tables {
            archive.put_u64("run/tables", &[tables.nrow()])?;
        }
        if let Some(frd) = &files.frd {
            let Mark {
                length,
                nframe,
                ndataset,
            } = frd.mark();
            archive.put_u64("run/frd", &[length, nframe, ndataset])?;
        }
        let of_step = |s: &StepSummary| {
            [
                s.increments,
                s.iterations,
                s.cutbacks,
                s.linear_iterations,
                s.fallbacks,
            ]
        };
        let mut counts = vec![self.counts.increments];
        counts.extend(self.counts.steps.iter().flat_map(of_step));
        archive.put_u64("run/counts", &counts)?;
        let step = self.step.map_or(-1.0, |step| step as f64);
        archive.put_f64("run/clock", &[step, self.time, self.step_time])?;
        archive.put_f64("run/frames", &self.counts.frames)?;
        archive.put_f64("run/expectations", &self.expectations.save())?;
        archive.put_f64("run/modes", &self.frequencies.save())?;
        archive.put_f64("run/closure", &self.closure.save())?;
        archive.put_f64("run/idle", &self.idle.save())?;
        self.audit.save(&mut archive)?;
        let step = self.step.unwrap_or(0);
        let stamp = Stamp {
            step: step as u64,
            increment: self.counts.steps.get(step).map_or(0, |s| s.increments),
            time,
        };
        let path = self
            .checkpoints
            .write(self.setting.fs.as_ref(), stamp, &archive)?;
        Ok((stamp, in_folder(&path)))
    }
}

/// The path of a checkpoint, relative to the folder of the results.
fn in_folder(path: &Path) -> String {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
    format!("checkpoint/{}", name.unwrap_or_default())
}
