//! Contact that begins in a run, where nobody names pairs.
//!
//! ```text
//! accepted state ──look──▶ nothing meets:              goes on
//!                 ├──────▶ something comes near:       the model is built again with it, and goes on from this state
//!                 └──────▶ something is inside:        the same, but from the state before: the increment is done again
//! ```
//!
//! After every increment the way of all nodes in it is searched for regions that face one another and are no contact yet.
//! A model that is built again takes the state over in the way a resumed run does, so that a run that is interrupted and
//! resumed finds the same, to the last bit.

use super::cannot_resume;
use super::start::{Start, begin};
use crate::setup::Model;
use crate::setup::general::{Birth, Births, General, Pair};
use signorini_geometry::tensor::Vec3;
use signorini_io::checkpoint::{self, ArchiveError};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use signorini_mechanics::contact::inherit;
use signorini_mechanics::solve::{Event, Flow, Observer, Outcome, RunError, Stepper};
use signorini_mechanics::system::{Archive, ContactNumbering, Frame, System};

/// The name of the pairs in a checkpoint.
const PAIRS: &str = "run/pairs";

/// What has to be known of the past to go on where contact begins; nothing where pairs are named.
pub(crate) struct Watch {
    /// Where all nodes were at the last accepted state.
    places: Vec<Vec3>,
    /// What the solution was there.
    solution: Archive,
}

/// An increment of a run that is watched.
pub(crate) struct Increment {
    /// How the stepper ended.
    pub outcome: Result<Outcome, RunError>,
    /// Whether who hears it wants to stop.
    pub is_stopped: bool,
    /// What has begun, in words.
    pub begun: Option<Diagnostic>,
}

/// Watches the increments of a run for contact that begins, and stops it after each.
struct Watched<'a> {
    general: &'a mut Option<General>,
    reference: &'a [Vec3],
    from: &'a mut Vec<Vec3>,
    heard_by: &'a mut dyn Observer,
    /// What the last increment found.
    births: Births,
    /// Whether who hears it wants it to stop.
    is_stopped: bool,
}

impl Watch {
    /// Begins at the present state of a run.
    pub fn new(model: &Model, stepper: &Stepper) -> Option<Self> {
        let mut solution = Archive::default();
        let general = model.general.as_ref();
        general.map(|_| {
            stepper.save(&model.system, &mut solution);
            Self {
                places: stepper.state().x.clone(),
                solution,
            }
        })
    }

    /// One increment, up to a time where there is one, and contact that begins after it.
    ///
    /// # Errors
    /// A model that cannot be built with that contact.
    pub fn increment(
        &mut self,
        model: &mut Model,
        stepper: &mut Stepper,
        until: Option<f64>,
        heard_by: &mut dyn Observer,
    ) -> Result<Increment, Diagnostics> {
        let Model {
            system,
            steps,
            general,
            mesh,
            ..
        } = model;
        let mut watched = Watched {
            general,
            reference: &mesh.points,
            from: &mut self.places,
            heard_by,
            births: Births::default(),
            is_stopped: false,
        };
        let outcome = match until {
            None => stepper.run(system, steps, &mut watched),
            Some(time) => stepper.run_until(system, steps, time, &mut watched),
        };
        let (births, is_stopped) = (watched.births, watched.is_stopped);
        let begun = match outcome {
            Ok(Outcome::Stopped) => self.go_on(model, stepper, &births)?,
            _ => None,
        };
        Ok(Increment {
            outcome,
            is_stopped,
            begun,
        })
    }

    /// Goes on after an increment: with more contacts where some begin. What begins comes back in words.
    ///
    /// # Errors
    /// A model that cannot be built with them.
    fn go_on(
        &mut self,
        model: &mut Model,
        stepper: &mut Stepper,
        births: &Births,
    ) -> Result<Option<Diagnostic>, Diagnostics> {
        if !births.is_inside {
            self.solution.arrays.clear();
            stepper.save(&model.system, &mut self.solution);
        }
        if births.pairs.is_empty() {
            return Ok(None);
        }
        let before: Vec<String> = model.contacts.iter().map(|one| one.name.clone()).collect();
        let time = stepper.state().time;
        *stepper = grow(model, &births.pairs, &self.solution)?;
        self.places.clone_from(&stepper.state().x);
        self.solution.arrays.clear();
        stepper.save(&model.system, &mut self.solution);
        Ok(Some(begun(model, &before, time, births.is_inside)))
    }
}

impl Observer for Watched<'_> {
    fn notice(&mut self, event: &Event<'_>) -> Flow {
        let Event::Increment { frame, .. } = event else {
            let flow = self.heard_by.notice(event);
            self.is_stopped |= flow == Flow::Stop;
            return flow;
        };
        let places = places(self.reference, frame);
        let general = self.general.as_mut();
        self.births = general.map_or_else(Births::default, |one| one.look(self.from, &places));
        if !self.births.is_inside {
            *self.from = places;
            self.is_stopped |= self.heard_by.notice(event) == Flow::Stop;
        }
        // the state is kept before anything else happens to it
        Flow::Stop
    }
}

fn places(reference: &[Vec3], frame: &Frame) -> Vec<Vec3> {
    let moved = reference.iter().zip(&frame.displacement);
    moved.map(|(x, u)| *x + *u).collect()
}

/// Builds the model again with contact of more regions, and takes the solution over.
fn grow(model: &mut Model, births: &[Birth], from: &Archive) -> Result<Stepper, Diagnostics> {
    let general = model.general.as_ref();
    let pairs = general.map_or_else(Vec::new, |general| general.with(births));
    let mut larger = model.with_pairs(&pairs)?;
    begin(&mut larger)?;
    let mut archive = Archive::default();
    Stepper::new(&larger.system, larger.settings).save(&larger.system, &mut archive);
    let before = numberings(&model.system);
    inherit((&before, from), (&numberings(&larger.system), &mut archive));
    let stepper = Stepper::resumed(&mut larger.system, larger.settings, &archive);
    let stepper = stepper.map_err(cannot_resume)?;
    let stepper = stepper.with_cycles(larger.cycles.clone());
    *model = larger;
    Ok(stepper)
}

fn numberings(system: &System) -> Vec<ContactNumbering> {
    let contacts = system
        .terms
        .iter()
        .filter_map(|term| term.capabilities().audited);
    contacts.map(|contact| contact.numbering()).collect()
}

/// What has begun, in words.
fn begun(model: &Model, names: &[String], time: f64, is_again: bool) -> Diagnostic {
    let contacts = model.contacts.iter();
    let names: Vec<String> = contacts
        .filter(|one| !names.contains(&one.name))
        .map(|one| format!("\"{}\"", one.name))
        .collect();
    let message = match &names[..] {
        [] => format!("more of what is in contact meets from time {time:.4} on"),
        [one] => format!("{one} meets from time {time:.4} on"),
        all => format!("{} meet from time {time:.4} on", all.join(", ")),
    };
    let one = Diagnostic::new(Severity::Note, &codes::CONTACT_FOUND, message);
    match is_again {
        true => one.note("found inside one another: the increment is done again"),
        false => one,
    }
}

/// Adds the pairs that a model has found to a checkpoint.
///
/// # Errors
/// An array that no checkpoint can have.
pub(crate) fn put(model: &Model, into: &mut checkpoint::Archive) -> Result<(), ArchiveError> {
    let Some(general) = &model.general else {
        return Ok(());
    };
    into.put_u64(PAIRS, &Pair::to_numbers(general.pairs()))
}

/// Builds a model again with the contacts that a checkpoint was written with, and looks at its undeformed state; nothing
/// where it has them.
///
/// # Errors
/// A checkpoint of another model.
pub(crate) fn take(
    model: &mut Model,
    from: &checkpoint::Archive,
) -> Result<Option<Start>, Diagnostics> {
    let (Some(general), Ok(stored)) = (&model.general, from.get_u64(PAIRS)) else {
        return Ok(None);
    };
    let pairs = Pair::from_numbers(stored);
    let pairs = pairs.ok_or_else(|| cannot_resume("its pairs of contact cannot be read"))?;
    if general.pairs() == pairs {
        return Ok(None);
    }
    *model = model.with_pairs(&pairs)?;
    begin(model).map(Some)
}
