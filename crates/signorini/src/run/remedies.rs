//! What to change where a run failed: keys with their values, as they stand in a case.
//!
//! A key stands between two spaces on either side, and after it where it belongs, so that it can be copied:
//!
//! ```text
//! smaller increments:  increments = { initial = 0.1, min = 1e-6, max = 1.0 }  of step "press"
//! ```

use crate::setup::{ContactInfo, hold};
use signorini_io::case::{Case, Conductance, Increments, Remedy, Step};
use signorini_linear::LinearError;
use signorini_mechanics::solve::Failure;
use signorini_mechanics::system::TermError;

/// The first of smaller increments relative to those that failed.
const SMALLER: f64 = 0.1;
/// The smallest increment that is proposed relative to the first that failed.
const SMALLEST: f64 = 1e-6;
/// Where increments of this part of the planned one fail, smaller ones fail, too.
const NO_SIZE_HELPS: f64 = 1e-3;
/// Iterations that are proposed.
const ITERATIONS: u64 = 50;

/// What to do about a limit load.
pub(super) const MOTION_INSTEAD: &str = "where the load is more than the structure bears: \
    prescribe a motion by [[step.move]] instead of the load";

/// What to do about forces and stiffnesses that are too large for the precision of numbers.
const TOO_LARGE: &str = "write a smaller number: a load, a motion, a stiffness or a penalty is too large to compute with";

/// An increment that failed.
pub(super) struct Trouble<'a> {
    pub case: &'a Case,
    pub contacts: &'a [ContactInfo],
    /// Name of the step.
    pub step: &'a str,
    /// Sizes that were tried, first to last.
    pub tried: &'a [f64],
    pub cause: &'a Failure,
    /// Whether the equations are singular at a multiplier ...
    pub multiplier: bool,
    /// ... and of which contact.
    pub contact: Option<&'a str>,
}

impl Trouble<'_> {
    /// What to change, most promising first.
    pub fn remedies(&self) -> Vec<String> {
        let (mut found, is_cure) = self.of_cause();
        if is_cure && !found.is_empty() {
            return found;
        }
        found.extend(self.all_remedies());
        found.extend(self.motion_instead());
        let smaller = self.smaller();
        match smaller {
            Some(smaller) if self.size_may_help() => found.insert(0, smaller),
            Some(smaller) if found.is_empty() => found.push(smaller),
            _ => {}
        }
        found
    }

    /// What to change because of the cause, and whether nothing else helps.
    fn of_cause(&self) -> (Vec<String>, bool) {
        match self.cause {
            Failure::Linear {
                source: LinearError::Singular { .. },
                ..
            } => {
                let contact = self.contact.and_then(|name| self.contact_called(name));
                let found = if self.multiplier {
                    self.of_contact(contact)
                } else {
                    hold(self.case, self.step)
                };
                (found, true)
            }
            Failure::TooManyIterations {
                unsettled: Some((why, _)),
                ..
            } => (self.of_contact(self.contact_in(why)), false),
            Failure::TooManyIterations { .. } => (vec![self.more_iterations()], false),
            Failure::Term(TermError::Surface { interface, .. }) => {
                (self.of_contact(self.contact_called(interface)), false)
            }
            Failure::Term(TermError::Inverted { ratio, .. }) if !ratio.is_finite() => {
                (vec![TOO_LARGE.to_owned()], true)
            }
            Failure::Term(TermError::Inverted { body, .. } | TermError::Material { body, .. }) => {
                (self.of_material(body).into_iter().collect(), true)
            }
            Failure::Inaccurate { .. } => {
                let more = "allow a larger local error:  dynamics = { error_tol = 1e-2 }";
                (vec![more.to_owned()], false)
            }
            Failure::Impact { .. } => {
                let any = "let contact close in increments of any length:  dynamics = { impact_step = 0 }";
                (vec![any.to_owned()], false)
            }
            Failure::NotFinite { .. } | Failure::Term(TermError::NotFinite { .. }) => {
                (vec![TOO_LARGE.to_owned()], true)
            }
            Failure::TooStiff { .. }
            | Failure::Linear {
                source: LinearError::NotFinite | LinearError::Inaccurate { .. },
                ..
            } => {
                let chosen = self.contacts.iter().filter_map(chosen_penalty);
                (chosen.chain([TOO_LARGE.to_owned()]).collect(), true)
            }
            _ => (Vec::new(), false),
        }
    }

    fn step(&self) -> Option<&Step> {
        let mut steps = self.case.steps.iter();
        steps.find(|step| step.name.value == self.step)
    }

    /// Whether smaller increments than those that failed are worth a try.
    fn size_may_help(&self) -> bool {
        let planned = self.step().map_or(0.0, |step| match step.increments {
            Increments::Fixed(n) | Increments::Count(n) => step.duration / n as f64,
            Increments::Adaptive { initial, .. } => initial,
        });
        let smallest = self.tried.iter().copied().fold(planned, f64::min);
        smallest > NO_SIZE_HELPS * planned
    }

    fn smaller(&self) -> Option<String> {
        let step = self.step()?;
        let keys = match step.increments {
            Increments::Fixed(n) | Increments::Count(n) => {
                let size = step.duration / n as f64;
                let [initial, min] = [SMALLER * size, SMALLEST * size].map(number);
                format!("initial = {initial}, min = {min}, max = {}", number(size))
            }
            Increments::Adaptive {
                initial,
                min,
                max,
                count_max,
            } => {
                let [initial, max] = [initial.min(SMALLER * max), max].map(number);
                let min = number(SMALLER * NO_SIZE_HELPS * min);
                format!("initial = {initial}, min = {min}, max = {max}, count_max = {count_max}")
            }
        };
        Some(format!(
            "smaller increments:  increments = {{ {keys} }}  of step \"{}\"",
            self.step
        ))
    }

    fn more_iterations(&self) -> String {
        let now = self.case.solver.newton.max_iterations;
        format!(
            "more iterations:  newton = {{ max_iterations = {} }}  in [solver]",
            ITERATIONS.max(now.saturating_mul(2))
        )
    }

    /// A motion, where a load may be more than the structure bears.
    fn motion_instead(&self) -> Option<String> {
        let loaded = self.step().is_some_and(|step| !step.loads.is_empty());
        loaded.then(|| MOTION_INSTEAD.to_owned())
    }

    /// What the program tries by itself where the case lets it.
    fn all_remedies(&self) -> Option<String> {
        let allowed = &self.case.solver.on_trouble;
        let all = [Remedy::Cut, Remedy::Stabilize, Remedy::Points];
        let lacks = all.iter().any(|one| !allowed.contains(one));
        lacks.then(|| {
            "other ways of the program:  on_trouble = [\"cut\", \"stabilize\", \"points\"]  in [solver]"
                .to_owned()
        })
    }

    fn contact_called(&self, name: &str) -> Option<&ContactInfo> {
        self.contacts.iter().find(|contact| contact.name == name)
    }

    /// The contact that a verdict speaks of.
    fn contact_in(&self, why: &str) -> Option<&ContactInfo> {
        let mut contacts = self.contacts.iter();
        contacts.find(|contact| why.starts_with(&format!("contact \"{}\"", contact.name)))
    }

    /// Another method and another penalty for a contact.
    fn of_contact(&self, contact: Option<&ContactInfo>) -> Vec<String> {
        let Some(contact) = contact else {
            return Vec::new();
        };
        let other = match contact.method {
            "mortar" => Some("gauss-point"),
            "gauss-point" => Some("mortar"),
            _ => None,
        };
        let name = &contact.name;
        let method = other
            .map(|other| format!("another method:  method = \"{other}\"  of contact \"{name}\""));
        let even = self.even_conductance(name).into_iter();
        even.chain(method).chain(chosen_penalty(contact)).collect()
    }

    /// A conductance without a jump, for a contact whose conductance jumps where it closes: what closes cools, and opens again.
    fn even_conductance(&self, name: &str) -> Option<String> {
        self.step()?.thermal?;
        let mut contacts = self.case.contacts.iter();
        let contact = contacts.find(|one| one.name.value == name)?;
        let jump = contact.conductance.iter().find_map(|path| match path {
            Conductance::Constant(h) => Some(number(*h)),
            _ => None,
        })?;
        Some(format!(
            "a conductance that grows evenly from nothing, up to a pressure p:  \
             conductance = {{ over_pressure = [[0.0, 0.0], [p, {jump}]] }}  of contact \"{name}\""
        ))
    }

    /// A law that does not collapse, for a body of one that does.
    fn of_material(&self, body: &str) -> Option<String> {
        let mut bodies = self.case.bodies.iter();
        let of_name = |name: &str| body.split('+').any(|part| part == name);
        let body = bodies.find(|one| one.groups.iter().any(|group| of_name(&group.value)))?;
        let material = body.material.as_ref()?;
        let mut materials = self.case.materials.iter();
        let own = materials.find(|one| one.name.value == material.value)?;
        let collapses = own.model.value == "saint-venant-kirchhoff";
        collapses.then(|| {
            format!(
                "a law that does not collapse:  model = \"neo-hookean\"  of material \"{}\"",
                material.value
            )
        })
    }
}

/// The penalty that the program chooses, for a contact to which the case gives another.
fn chosen_penalty(contact: &ContactInfo) -> Option<String> {
    contact.is_given.then(|| {
        format!(
            "the penalty that suits the bodies:  enforcement = {{ penalty = \"auto\" }}  of contact \"{}\"",
            contact.name
        )
    })
}

/// Increments that suffice, where a step has come to this part of its duration by `count`.
pub(super) fn more_increments(case: &Case, step: &str, count: usize, part: f64) -> Option<String> {
    let step = case.steps.iter().find(|one| one.name.value == step)?;
    let (initial, min, max) = match step.increments {
        Increments::Fixed(_) => return None,
        Increments::Count(n) => {
            let size = step.duration / n as f64;
            (size, 1e-5 * size, size)
        }
        Increments::Adaptive {
            initial, min, max, ..
        } => (initial, min, max),
    };
    let [initial, min, max] = [initial, min, max].map(number);
    let wanted = 2.0 * count as f64 / part.max(1e-3);
    let wanted = (wanted as u64).max(10_000);
    Some(format!(
        "more increments:  increments = {{ initial = {initial}, min = {min}, max = {max}, count_max = {wanted} }}  \
         of step \"{}\"",
        step.name.value
    ))
}

/// A number as in a case, of three digits.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    format!("{rounded:?}")
}
