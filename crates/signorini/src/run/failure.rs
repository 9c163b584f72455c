//! Why a run failed, in the user's words: names of nodes, bodies, contacts; what was tried; what to change.

use super::remedies::{self, Trouble};
use crate::setup::{Model, first_step, hold};
use crate::text::short;
use signorini_geometry::mesh::NodeId;
use signorini_io::case::{Case, Contact};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_linear::LinearError;
use signorini_mechanics::solve::{Failure, RunError};
use signorini_mechanics::system::{
    Dof, DofName, FieldId, Layout, PatternSink, Site, Term, TermError,
};

/// What is on disk when a run fails.
pub struct Saved {
    /// Accepted increments.
    pub increments: u64,
    /// The output folder.
    pub folder: String,
}

/// The message for an undeformed state that cannot be looked at; exit code 4.
pub fn at_start(error: &TermError) -> Diagnostics {
    let help = match error {
        TermError::Material { .. } => {
            "correct the `expansion` of its material, or the temperature at the start"
        }
        _ => "look at the mesh: signorini check CASE -o DIR writes DIR/check.vtu",
    };
    let message = format!("{error}, before anything moves");
    Diagnostic::error(&codes::BAD_ELEMENTS, message)
        .help(help)
        .into()
}

/// The message for a run that failed.
pub fn message(error: &RunError, model: &Model, saved: &Saved) -> Diagnostic {
    if let RunError::NotConverged { cause, .. } = error
        && let Some(one) = no_memory(cause, saved)
    {
        return one;
    }
    match error {
        RunError::NotConverged { cause, .. } if saved.increments == 0 => {
            if let Failure::Linear {
                source: LinearError::Singular { .. },
                dof,
            } = cause.as_ref()
                && !dof.is_some_and(|dof| is_multiplier(dof, model))
            {
                return free_body(*dof, model);
            }
            not_converged(error, model, saved)
        }
        RunError::NotConverged { .. } => not_converged(error, model, saved),
        RunError::TooManyIncrements {
            step,
            count,
            time,
            duration,
        } => {
            let message = format!(
                "step \"{step}\" is not done after {count} increments (time {} of {duration})",
                rounded(*time)
            );
            let one = Diagnostic::error(&codes::NOT_CONVERGED, message);
            let one = at_step(one, step, model).note(converged_so_far(saved));
            let more = remedies::more_increments(&model.case, step, *count, time / duration);
            more.into_iter().fold(one, Diagnostic::help)
        }
        RunError::Modes { step, .. } => {
            let one = Diagnostic::error(&codes::MODES_NOT_FOUND, error.to_string());
            at_step(one, step, model)
                .note("frequencies.csv says which")
                .help("fewer `modes`, or a range of frequencies:  frequency = { lower = …, upper = … }")
        }
        RunError::Term(cause) => Diagnostic::error(&codes::NOT_CONVERGED, cause.to_string())
            .note(saved_so_far(saved))
            .help("smaller increments, or a better mesh there"),
    }
}

/// Bytes that an entry of a factor takes at least.
const ENTRY: f64 = 8.0;

/// A system whose factor found no memory: no matter of convergence.
fn no_memory(cause: &Failure, saved: &Saved) -> Option<Diagnostic> {
    let Failure::Linear {
        source: LinearError::TooLarge { nequation, nentry },
        ..
    } = cause
    else {
        return None;
    };
    let megabytes = (ENTRY * *nentry as f64 / 1e6).ceil();
    let message = format!(
        "out of memory: the direct solver found none for a system of {nequation} equations, whose {nentry} entries alone need \
         at least {megabytes} MB"
    );
    let one = Diagnostic::error(&codes::OUT_OF_MEMORY, message).note(saved_so_far(saved));
    Some(
        one.help("linear = \"multigrid\" needs less; or raise the limit (ulimit -v), or use fewer threads (-j 1) or unknowns"),
    )
}

/// A system that is singular before anything was solved: something is not held.
fn free_body(dof: Option<Dof>, model: &Model) -> Diagnostic {
    let motion = dof.and_then(|dof| motion(dof, model));
    let owner = motion.as_ref().map_or("something", |(owner, _)| owner);
    let by_contact = !model.held_by_contact.is_empty();
    let message = match by_contact {
        true => format!("{owner} moves away: contact, which alone can hold it, does not"),
        false => format!("{owner} can move freely: nothing holds it"),
    };
    let mut one = Diagnostic::error(&codes::FREE_BODY, message);
    if let Some((_, motion)) = motion {
        one = one.note(format!("free motions: at least {motion}"));
    }
    let one = one.note("nothing was solved");
    let friction = by_contact.then(|| held_by_friction(&model.case));
    let help = hold(&model.case, first_step(&model.case));
    let help = friction.into_iter().flatten().chain(help);
    help.fold(one, Diagnostic::help)
}

/// Contacts that are named one by one.
const LISTED: usize = 3;

/// What to change where friction should hold a body.
fn held_by_friction(case: &Case) -> Vec<String> {
    let of_contact = |contact: &Contact| {
        let name = &contact.name.value;
        match contact.friction {
            None => {
                format!("where friction should hold it:  friction = ...  of contact \"{name}\"")
            }
            Some(_) => format!(
                "where friction should hold it: more `friction` of contact \"{name}\", or less load along it"
            ),
        }
    };
    case.contacts.iter().take(LISTED).map(of_contact).collect()
}

/// What moves and how, in words.
fn motion(dof: Dof, model: &Model) -> Option<(String, String)> {
    let axis = |axis: usize| ["x", "y", "z"].get(axis).copied().unwrap_or("?");
    let rigid = |body: u32| {
        let name = model.references.iter().find(|r| r.rigid == body);
        format!("rigid body \"{}\"", name.map_or("?", |r| r.name.as_str()))
    };
    let DofName {
        field,
        entity,
        component,
    } = model.system.layout.name(dof)?;
    Some(match field {
        FieldId::DISPLACEMENT => {
            let place = node_in_words(entity, model);
            let along = axis(component);
            (body_of(entity, model), format!("along {along} at {place}"))
        }
        FieldId::TRANSLATION => {
            let along = axis(component);
            (rigid(entity), format!("translation along {along}"))
        }
        FieldId::ROTATION => {
            let about = axis(component);
            (rigid(entity), format!("rotation about {about}"))
        }
        FieldId::MULTIPLIER => {
            let number = entity as usize;
            let term = term_of(dof, model);
            let owner = term.map_or_else(|| "a constraint".to_owned(), |one| in_words(one, model));
            let audited = term.and_then(|term| term.capabilities().audited);
            let node = audited.and_then(|contact| contact.node_of(number));
            let at = node.map(|node| format!("at {}", node_in_words(node, model)));
            (owner, at.unwrap_or_else(|| format!("multiplier {number}")))
        }
        other => {
            let field = model.system.layout.field(other)?;
            match field.on {
                Site::Nodes => {
                    let place = node_in_words(entity, model);
                    (body_of(entity, model), format!("{} at {place}", field.name))
                }
                _ => (rigid(entity), field.name.to_owned()),
            }
        }
    })
}

fn is_multiplier(dof: Dof, model: &Model) -> bool {
    let name = model.system.layout.name(dof);
    name.is_some_and(|name| name.field == FieldId::MULTIPLIER)
}

/// The contact that a multiplier belongs to.
fn contact_of(dof: Dof, model: &Model) -> Option<String> {
    let name = is_multiplier(dof, model)
        .then(|| term_of(dof, model))??
        .name();
    let known = model.contacts.iter().any(|contact| contact.name == name);
    known.then(|| name.to_owned())
}

/// The term that a multiplier belongs to.
fn term_of(multiplier: Dof, model: &Model) -> Option<&dyn Term> {
    struct Search(Dof, bool);
    impl PatternSink for Search {
        fn bulk(&mut self, _: &[NodeId]) {}
        fn interface(&mut self, dofs: &[Dof]) {
            self.1 |= dofs.contains(&self.0);
        }
        fn coupling(&mut self, ones: &[Dof], others: &[Dof]) {
            self.interface(ones);
            self.interface(others);
        }
    }
    let has = |term: &&dyn Term| {
        let mut search = Search(multiplier, false);
        term.pattern(&mut search);
        search.1
    };
    model.system.terms.iter().map(AsRef::as_ref).find(has)
}

/// `contact "touch"`, or `constraint 1 (plane on "top")`.
fn in_words(term: &dyn Term, model: &Model) -> String {
    let name = term.name();
    if model.contacts.iter().any(|contact| contact.name == name) {
        format!("contact \"{name}\"")
    } else {
        format!("constraint {name}")
    }
}

/// The body that a node belongs to.
fn body_of(node: NodeId, model: &Model) -> String {
    let groups = model.case.bodies.iter().flat_map(|body| &body.groups);
    let has = |name: &str| {
        model
            .nodes_of(name)
            .is_some_and(|nodes| nodes.contains(&node))
    };
    let found = groups.into_iter().find(|group| has(&group.value));
    found.map_or_else(
        || "a body".to_owned(),
        |group| format!("body \"{}\"", group.value),
    )
}

/// `node 1042 (x = 20.0, y = 0.0, z = 10.0)`.
fn node_in_words(node: NodeId, model: &Model) -> String {
    let at = model
        .mesh
        .points
        .get(node as usize)
        .copied()
        .unwrap_or_default();
    let label = model.mesh.node_labels.get(node as usize);
    let label = label.map_or_else(|| "?".to_owned(), u64::to_string);
    let mut text = format!("node {label} (x = {}, y = {}", at.x, at.y);
    if model.system.layout.ndim() == 3 {
        text += &format!(", z = {}", at.z);
    }
    text + ")"
}

/// `node 1042 (…) of body "block"`, or what else has this unknown.
fn dof_in_words(dof: Dof, model: &Model) -> Option<String> {
    match model.system.layout.name(dof)?.displacement() {
        Some((node, _)) => Some(format!(
            "{} of {}",
            node_in_words(node, model),
            body_of(node, model)
        )),
        None => motion(dof, model).map(|(owner, motion)| format!("{owner}, {motion}")),
    }
}

/// The place of a step in the case.
fn at_step(message: Diagnostic, step: &str, model: &Model) -> Diagnostic {
    let found = model.case.steps.iter().find(|one| one.name.value == step);
    match found {
        Some(step) => message.at(&step.place, ""),
        None => message,
    }
}

fn not_converged(error: &RunError, model: &Model, saved: &Saved) -> Diagnostic {
    let RunError::NotConverged {
        step,
        increment,
        time,
        duration,
        tried,
        min,
        cause,
    } = error
    else {
        return Diagnostic::error(&codes::NOT_CONVERGED, error.to_string());
    };
    let message = format!(
        "increment {increment} of step \"{step}\" did not converge (time {} of {duration})",
        rounded(*time)
    );
    let one = Diagnostic::error(&codes::NOT_CONVERGED, message);
    let mut one = at_step(one, step, model).note(sizes(tried, *min));
    for fact in facts(cause, model) {
        one = one.note(fact);
    }
    one = one.note(saved_so_far(saved));
    let multiplier = match cause.as_ref() {
        Failure::Linear { dof, .. } => dof.filter(|&dof| is_multiplier(dof, model)),
        _ => None,
    };
    let contact = multiplier.and_then(|dof| contact_of(dof, model));
    let trouble = Trouble {
        multiplier: multiplier.is_some(),
        contact: contact.as_deref(),
        case: &model.case,
        contacts: &model.contacts,
        step,
        tried,
        cause,
    };
    for help in trouble.remedies() {
        one = one.help(help);
    }
    one.help(format!("signorini explain {}", codes::NOT_CONVERGED.id))
}

fn rounded(time: f64) -> f64 {
    (time * 1e6).round() / 1e6
}

/// Three digits of a number.
fn digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

fn sizes(tried: &[f64], min: Option<f64>) -> String {
    let text = |size: Option<&f64>| size.map_or_else(|| "?".to_owned(), |size| short(*size));
    let mut different = tried.to_vec();
    different.dedup();
    let (first, last) = (text(different.first()), text(different.last()));
    match (different.len(), min) {
        (0 | 1, None) => {
            format!("tried the size {first}; `increments = {{ fixed }}` allows no smaller one")
        }
        (n, None) => format!("tried {n} sizes from {first} down to {last}"),
        (_, Some(min)) if min.is_infinite() => {
            format!("tried the size {first}; `on_trouble` allows no smaller one")
        }
        (0 | 1, Some(min)) => format!(
            "tried the size {first}; the next one is below min = {:e}",
            digits(min)
        ),
        (n, Some(min)) => format!(
            "tried {n} sizes from {first} down to {last}; the limit is min = {:e}",
            digits(min)
        ),
    }
}

/// ` (nodes 3, 4)`; nothing where there are none.
fn nodes_in_words(nodes: &[NodeId], model: &Model) -> String {
    let mut labels: Vec<u64> = Vec::new();
    for &node in nodes {
        let label = model.mesh.node_labels.get(node as usize);
        labels.extend(label.filter(|label| !labels.contains(label)).copied());
    }
    let texts: Vec<String> = labels.iter().map(u64::to_string).collect();
    match texts.as_slice() {
        [] => String::new(),
        [one] => format!(" (node {one})"),
        many => format!(" (nodes {})", many.join(", ")),
    }
}

/// The largest error and its place; that of a multiplier is no force.
fn largest_error(dof: Option<Dof>, force: f64, residual: f64, model: &Model) -> Option<String> {
    let dof = dof?;
    let place = dof_in_words(dof, model)?;
    let layout = &model.system.layout;
    let part = short(100.0 * residual);
    if is_multiplier(dof, model) {
        return Some(format!("largest error in the equations of {place}"));
    }
    if layout.scale(dof) >= Layout::OWN {
        let all = format!("that is {part} % of the mean of its equations");
        return Some(format!("largest error {force:.3e} of {place}, {all}"));
    }
    Some(format!(
        "largest force error {force:.3e} at {place}, that is {part} % of the mean force"
    ))
}

/// ` at node 1042 (…) of body "block"`; nothing where the unknown is not known.
fn at_dof(dof: Option<Dof>, model: &Model) -> String {
    let place = dof.and_then(|dof| dof_in_words(dof, model));
    place.map_or_else(String::new, |place| format!(" at {place}"))
}

/// What kept it from converging.
fn facts(cause: &Failure, model: &Model) -> Vec<String> {
    match cause {
        Failure::TooManyIterations {
            iterations,
            residual,
            worst: at,
            force,
            unsettled,
        } => {
            let mut facts = Vec::new();
            match unsettled {
                Some((why, nodes)) => {
                    let nodes = nodes_in_words(nodes, model);
                    facts.push(format!("what kept it from converging: {why}{nodes}"));
                }
                None => facts.push(format!(
                    "{iterations} iterations did not suffice; contact did not change any more"
                )),
            }
            facts.extend(largest_error(*at, *force, *residual, model));
            facts
        }
        Failure::NotFinite { iterations, dof } => vec![format!(
            "the force{} is not a finite number after {iterations} iterations",
            at_dof(*dof, model)
        )],
        Failure::Inaccurate { error, allowed } => vec![format!(
            "the local error of displacements is {error:.2e}, and {allowed:.2e} is allowed: `error_tol` of the largest displacement \
             so far"
        )],
        Failure::Impact { longest } => vec![format!(
            "contact closes or opens, which is allowed in increments up to {longest:.2e}: `impact_step`"
        )],
        Failure::TooStiff { dof } => vec![format!(
            "the stiffness{} is so large that rounding errors hide the others",
            at_dof(*dof, model)
        )],
        Failure::Linear {
            source: LinearError::Inaccurate { residual, .. },
            dof,
        } => vec![format!(
            "the linear equations are solved only up to {residual:.1e} of the forces; the largest stiffness is{}",
            at_dof(*dof, model)
        )],
        Failure::Linear {
            source: LinearError::NotFinite,
            dof,
        } => vec![format!(
            "the stiffness{} is not a finite number",
            at_dof(*dof, model)
        )],
        Failure::Term(error) => {
            let node = match error {
                TermError::Surface { node, .. } => *node,
                _ => None,
            };
            let place = node.map(|node| format!(", {}", node_in_words(node, model)));
            let place = place.unwrap_or_default();
            vec![format!("what kept it from converging: {error}{place}")]
        }
        Failure::Linear {
            source: LinearError::Singular { .. },
            dof,
        } => {
            let motion = dof.and_then(|dof| motion(dof, model));
            let multiplier = dof.is_some_and(|dof| is_multiplier(dof, model));
            vec![match motion {
                Some((owner, place)) if multiplier => {
                    format!("the equations of {owner} are singular, {place}")
                }
                Some((owner, motion)) => {
                    format!("{owner} has become free: nothing holds it any more, {motion}")
                }
                None => "something has become free: nothing holds it any more".into(),
            }]
        }
        other => vec![format!("what kept it from converging: {other}")],
    }
}

fn saved_so_far(saved: &Saved) -> String {
    match saved.increments {
        0 => "nothing was solved; the last try is frames/failed.vtu".to_owned(),
        n => format!(
            "saved: {n} converged increments, the last try as frames/failed.vtu   resume: signorini resume {}",
            saved.folder
        ),
    }
}

fn converged_so_far(saved: &Saved) -> String {
    format!(
        "saved: {} converged increments   resume: signorini resume {}",
        saved.increments, saved.folder
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::{build, read_mesh_of};
    use signorini_io::case::read_case;
    use std::path::Path;

    const CASE: &str = r#"
[mesh]
nodes = [
  [1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0], [4, 0, 1, 0],
  [5, 0, 0, 1], [6, 1, 0, 1], [7, 1, 1, 1], [8, 0, 1, 1],
]
elements = [{ id = 1, type = "hex8", group = "block", nodes = [1, 2, 3, 4, 5, 6, 7, 8] }]
[sets]
base = { nodes = [1, 2, 3, 4] }
top = { nodes = [5, 6, 7, 8] }
[material.steel]
model = "linear-elastic"
E = 210e3
nu = 0.3
[[body]]
group = "block"
material = "steel"
[[constraint]]
kind = "plane"
on = "top"
[[step]]
name = "rest"
[[step.fix]]
on = "base"
u = "all"
"#;

    fn model() -> Model {
        let (case, _) = read_case("case.toml", CASE.as_bytes(), &[], crate::vocabulary()).unwrap();
        let (mesh, _) = read_mesh_of(&case, Path::new(".")).unwrap();
        build(case, mesh).unwrap_or_else(|all| panic!("{all}"))
    }

    #[test]
    fn equations_that_are_solved_badly_are_named_by_the_largest_stiffness() {
        let model = model();
        let cause = Failure::Linear {
            source: LinearError::Inaccurate {
                residual: 1e-3,
                wanted: 1e-10,
            },
            dof: Some(model.system.layout.node(4, 2)),
        };
        assert_eq!(
            facts(&cause, &model),
            [
                "the linear equations are solved only up to 1.0e-3 of the forces; the largest stiffness is \
                 at node 5 (x = 0, y = 0, z = 1) of body \"block\""
            ]
        );
    }

    #[test]
    fn a_multiplier_is_named_by_its_constraint() {
        let model = model();
        let words = dof_in_words(model.system.layout.multiplier(0), &model);
        assert_eq!(
            words.unwrap(),
            "constraint 1 (plane on \"top\"), multiplier 0"
        );
    }
}
