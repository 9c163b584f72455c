//! Natural frequencies: their table, their shapes, and the news of them.

use super::{Recorder, frame_file};
use crate::run::error::OutputError;
use crate::run::limits::Stop;
use crate::run::news::Detail;
use signorini_io::writers::json::Event;
use signorini_mechanics::solve::Vibrations;
use std::time::Instant;

impl Recorder<'_> {
    pub(super) fn vibrations(&mut self, step: usize, time: f64, found: &Vibrations) {
        let name = self.step_name(step);
        let before = self.frequencies.nmode();
        let summary = self.frequencies.add(step, name.clone(), time, found);
        let modes = summary.modes.clone();
        let frequencies: Vec<f64> = modes.iter().map(|mode| mode.frequency).collect();
        self.expectations.hear(step, &frequencies);
        let mut files = Vec::new();
        if self.error.is_none() {
            let clock = Instant::now();
            match self.write_modes(step, before, found) {
                Ok(written) => files = written,
                Err(error) => self.error = Some(error),
            }
            self.write_seconds += clock.elapsed().as_secs_f64();
        }
        let event = Event::Frequencies {
            step: name,
            time,
            counted: found.is_counted,
            modes,
            files,
        };
        self.tell(&event, Detail::Vibrations(found));
        if self.setting.first_steps == Some(step + 1) {
            self.stop.get_or_insert(Stop::Steps);
        }
    }

    /// Writes the table, and the shape of each mode, numbered from `before` on; returns the files of the shapes.
    fn write_modes(
        &mut self,
        step: usize,
        before: usize,
        found: &Vibrations,
    ) -> Result<Vec<String>, OutputError> {
        let (fs, tree) = (self.setting.fs.as_ref(), &self.setting.tree);
        fs.write_atomic(
            &tree.path("frequencies.csv"),
            self.frequencies.table().as_bytes(),
        )?;
        let mut files = Vec::new();
        if !self.setting.has_vtu {
            return Ok(files);
        }
        for (number, mode) in found.modes.iter().enumerate() {
            let file = frame_file("mode", before + number + 1);
            let bytes = self.setting.volume.encode_mode(mode, step, number)?;
            fs.write_atomic(&tree.path(&file), &bytes)?;
            // viewers go from one to the next as in time
            let place = (before + number + 1) as f64;
            self.modes.add(fs, place, &[&file])?;
            files.push(file);
        }
        Ok(files)
    }
}
