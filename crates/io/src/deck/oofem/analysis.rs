//! The analysis: the times of its steps.
//!
//! | record | time of step n | ours ends at |
//! |---|---|---|
//! | `LinearStatic` | n | n |
//! | `StaticStructural` | n `deltat`, or `prescribedtimes` | the same |
//! | `NonLinearStatic` | (n − 1) `deltat` | n `deltat` |

use super::Translation;
use super::time::empty_step;
use crate::case::Geometry;
use crate::diagnostic::{Place, Spanned, codes};
use crate::readers::oofem::{Fault, Record};

/// Steps of a deck at most.
const MOST: u64 = 10_000;

/// Residuals are pressed down to this part of the forces, whatever the deck says: values are checked absolutely.
const FORCE_TOL: f64 = 1e-10;

/// Fields that change no result here, and how many words they have.
const IGNORED: [(&str, usize); 20] = [
    ("renumber", 1),
    ("profileopt", 1),
    ("contextoutputstep", 1),
    ("suppress_output", 0),
    ("lstype", 1),
    ("smtype", 1),
    ("stype", 1),
    ("lsprecond", 1),
    ("lstol", 1),
    ("lsiter", 1),
    ("miniter", 1),
    ("maxiter", 1),
    ("manrmsteps", 1),
    ("stiffmode", 1),
    ("initialguess", 1),
    ("linesearch", 1),
    ("lsearchtol", 1),
    ("calcstiffbeforeres", 1),
    ("rtolv", 1),
    ("rtolf", 1),
];

impl Translation {
    pub fn analysis(&mut self) {
        let mut record = self.parts.analysis.clone();
        record.take_kind();
        self.case.solver.newton.force_tol = FORCE_TOL;
        let ends = match record.kind().as_str() {
            "linearstatic" => self.linear(&mut record),
            "staticstructural" => self.structural(&mut record),
            "nonlinearstatic" => self.nonlinear_static(&mut record),
            other => {
                let text = format!("the analysis `{other}` is not supported");
                let known = "LinearStatic, StaticStructural and NonLinearStatic are";
                self.not_built(text, &record.place(), known);
                return;
            }
        };
        if let Some(ends) = self.take(ends) {
            self.clock.ends = ends.unwrap_or_default();
        }
        for (keyword, words) in IGNORED {
            record.ignore(keyword, words);
        }
        record.ignore("rtold", 1);
        for keyword in ["nmodules", "ninitmodules", "nmsteps"] {
            record.ignore(keyword, 1);
        }
        if self.found.is_empty() {
            self.finish(&record);
        }
    }

    fn linear(&mut self, record: &mut Record) -> Result<Option<Vec<[f64; 2]>>, Fault> {
        let count = record.need_whole("nsteps")?;
        Ok(self.regular(count, 1.0, 0.0, &record.place()))
    }

    fn structural(&mut self, record: &mut Record) -> Result<Option<Vec<[f64; 2]>>, Fault> {
        if let Some((solver, place)) = record.text("solvertype")?
            && !solver.eq_ignore_ascii_case("nrsolver")
        {
            let text = format!("the solver `{solver}` is not supported");
            self.not_built(text, &place, "Newton's method is: \"nrsolver\"");
        }
        let count = record.need_whole("nsteps")?;
        let deltat = record.real("deltat")?.unwrap_or(1.0);
        let Some(times) = record.reals("prescribedtimes")? else {
            return Ok(self.regular(count, deltat, 0.0, &record.place()));
        };
        let mut before = 0.0;
        for &time in &times {
            if time <= before {
                let place = record.place_of_field("prescribedtimes");
                let text = "the prescribed times do not increase from 0";
                self.error(&codes::NOT_INCREASING, text, &place, "");
                return Ok(None);
            }
            before = time;
        }
        Ok(Some(times.into_iter().map(|time| [time, time]).collect()))
    }

    fn nonlinear_static(&mut self, record: &mut Record) -> Result<Option<Vec<[f64; 2]>>, Fault> {
        let mut count = 0u64;
        let mut metasteps = std::mem::take(&mut self.parts.metasteps);
        if metasteps.is_empty() {
            count = record.need_whole("nsteps")?;
            self.control(record)?;
        } else {
            // what a metastep does not say, the analysis does
            let own = self.controlled(record)?;
            for metastep in &mut metasteps {
                count = count.saturating_add(metastep.need_whole("nsteps")?);
                metastep.take_kind();
                if own.is_none() {
                    self.control(metastep)?;
                } else if self.controlled(metastep)? == Some(0) {
                    self.arc_length(metastep);
                }
                for (keyword, words) in IGNORED {
                    metastep.ignore(keyword, words);
                }
                metastep.flag("soldepextforces");
                metastep.ignore("refloadmode", 1);
                self.finish(metastep);
            }
            if own == Some(0) {
                self.arc_length(record);
            }
        }
        record.flag("soldepextforces");
        if let Some(1..) | None = record.whole("refloadmode")? {
            // loads are total values in either case, without metasteps that keep them
        }
        let deltat = record.real("deltat")?.unwrap_or(1.0);
        Ok(self.regular(count, deltat, deltat, &record.place()))
    }

    /// How the load is controlled; none where the record does not say.
    fn controlled(&mut self, record: &mut Record) -> Result<Option<u64>, Fault> {
        let two = record.whole("controllmode")?;
        Ok(two.or(record.whole("controlmode")?))
    }

    fn control(&mut self, record: &mut Record) -> Result<(), Fault> {
        match self.controlled(record)? {
            Some(1) => {}
            Some(0) | None => self.arc_length(record),
            Some(other) => {
                let text = format!("controlmode {other} is not known");
                self.error(&codes::OUT_OF_RANGE, text, &record.place(), "0 or 1");
            }
        }
        Ok(())
    }

    fn arc_length(&mut self, record: &Record) {
        self.not_built(
            "control of the load by arc length is not built",
            &record.place(),
            "it is what `NonLinearStatic` does unless it says  controlmode 1",
        );
    }

    /// Steps of equal length; the deck's time of the first is this much less than ours.
    fn regular(
        &mut self,
        count: u64,
        length: f64,
        earlier: f64,
        place: &Place,
    ) -> Option<Vec<[f64; 2]>> {
        if length <= 0.0 {
            let text = format!("the length of steps is {length}");
            self.error(&codes::OUT_OF_RANGE, text, place, "it must be positive");
            return None;
        }
        if !(1..=MOST).contains(&count) {
            let text = format!("the deck has {count} steps");
            let remark = format!("1 to {MOST} are supported");
            self.error(&codes::OUT_OF_RANGE, text, place, remark);
            return None;
        }
        let end = |n: u64| {
            let ours = n as f64 * length;
            let theirs = if earlier > 0.0 {
                (n - 1) as f64 * length
            } else {
                ours
            };
            [theirs, ours]
        };
        Some((1..=count).map(end).collect())
    }

    /// One step for each of the deck; everything begins in the first.
    pub fn steps(&mut self) {
        let mut begins = 0.0;
        let place = self.parts.analysis.place();
        for (number, &[_, ends]) in self.clock.ends.iter().enumerate() {
            let mut step = if number == 0 {
                std::mem::replace(&mut self.first, empty_step())
            } else {
                empty_step()
            };
            step.name = Spanned::new(format!("step-{}", number + 1), place.clone());
            step.place = place.clone();
            step.duration = ends - begins;
            if number == 0 {
                step.geometry = if self.nonlinear {
                    Geometry::Nonlinear
                } else {
                    Geometry::Linear
                };
            }
            begins = ends;
            self.case.steps.push(step);
        }
    }
}
