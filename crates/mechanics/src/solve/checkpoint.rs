//! What a run stores of itself, to go on from there.

use super::heat;
use super::local_error::Record;
use super::newton::ForceScale;
use super::step::Turns;
use super::stepping::{Progress, Stepper};
use super::work::ExternalWork;
use crate::explicit::Kept;
use crate::system::{Archive, ArchiveError, System};

impl Stepper {
    /// Stores the accepted state, the progress and the histories of all terms.
    pub fn save(&self, system: &System, out: &mut Archive) {
        let p = &self.progress;
        self.state.save(&system.layout, out);
        let dt = p.dt.unwrap_or(-1.0);
        out.put(
            "progress",
            &[
                p.step as f64,
                p.increment as f64,
                p.step_start,
                p.time,
                dt,
                p.easy as f64,
                f64::from(u8::from(p.jumped)),
            ],
        );
        let record = &p.record;
        out.put(
            "progress.record",
            &[
                record.largest,
                record.calm as f64,
                record.closed as f64,
                record.impact as f64,
            ],
        );
        out.put("progress.origin", &p.origin);
        if !p.rate.is_empty() {
            system.layout.save("progress.rate", &p.rate, out);
        }
        out.put("progress.curvature", p.curvature.as_slice());
        out.put("progress.scale", self.newton.scale.values(&system.layout));
        let experience = self.newton.equations.experience();
        out.put("progress.solver", &[f64::from(experience)]);
        p.work.save(out);
        heat::save(p.heat.as_ref(), out);
        if p.turns.stands_for > 0.0 {
            out.put("progress.cycles", &[p.turns.done, p.turns.stands_for]);
            out.put("progress.worn", &p.turns.last);
        }
        if let Some(explicit) = &self.explicit {
            explicit.kept().save(out);
        }
        system.save(out);
    }

    /// Takes a stored run back: what follows is, bit by bit, what would have followed.
    ///
    /// # Errors
    /// The archive belongs to another model.
    pub fn load(&mut self, system: &mut System, from: &Archive) -> Result<(), ArchiveError> {
        let mut progress = [0.0; 7];
        from.get("progress", &mut progress)?;
        let [step, increment, step_start, time, dt, easy, jumped] = progress;
        let mut origin = vec![0.0; from.length("progress.origin")?];
        from.get("progress.origin", &mut origin)?;
        let mut state = system.initial_state();
        state.load(&system.layout, from)?;
        let mut rate = Vec::new();
        if from.length("progress.rate.displacement").is_ok() {
            rate.resize(system.layout.ndof(), 0.0);
            system.layout.load("progress.rate", &mut rate, from)?;
        }
        // an older run does not know of it
        let mut curvature = vec![0.0; from.length("progress.curvature").unwrap_or(0)];
        if !curvature.is_empty() {
            from.get("progress.curvature", &mut curvature)?;
        }
        let mut scale = vec![0.0; system.layout.nscale()];
        from.get("progress.scale", &mut scale)?;
        let mut experience = [0.0];
        if from.length("progress.solver").is_ok() {
            from.get("progress.solver", &mut experience)?;
        }
        self.newton.equations.recall(experience[0] as u8);
        let mut work = ExternalWork::default();
        work.load(system.layout.ndof(), from)?;
        let mut record = [0.0; 4];
        if from.length("progress.record").is_ok() {
            from.get("progress.record", &mut record)?;
        }
        let mut turns = Turns::default();
        if let Ok(count) = from.length("progress.worn") {
            let mut cycles = [0.0; 2];
            from.get("progress.cycles", &mut cycles)?;
            [turns.done, turns.stands_for] = cycles;
            turns.last.resize(count, 0.0);
            from.get("progress.worn", &mut turns.last)?;
        }
        self.kept = Kept::load(from)?;
        let still = vec![0.0; state.u.len()];
        system.advance(&mut self.state, &state, &still, 0.0);
        self.state.time = state.time;
        self.state.rates = state.rates;
        system.load(from)?;
        self.newton.scale = ForceScale::from_values(&scale);
        self.newton.analyzed = false;
        self.newton.coupled_more = true;
        self.progress = Progress {
            step: step as usize,
            increment: increment as usize,
            step_start,
            time,
            dt: (dt > 0.0).then_some(dt),
            easy: easy as usize,
            origin,
            rate,
            curvature: curvature.first().copied(),
            jumped: jumped != 0.0,
            work,
            heat: heat::load(from)?,
            turns,
            record: Record {
                largest: record[0],
                calm: record[1] as usize,
                closed: record[2] as usize,
                impact: record[3] as usize,
                is_easy: false,
            },
        };
        Ok(())
    }
}
