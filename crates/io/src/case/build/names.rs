//! Names and references: what stands for two things, for nothing, or for itself.

use std::collections::{BTreeMap, BTreeSet};

use super::super::fields::Fields;
use super::super::parts::*;
use super::super::scalar::shortened;
use super::builder::Builder;
use crate::diagnostic::{Diagnostic, closest, codes, listed};

impl Builder<'_> {
    /// Names that stand for two things.
    pub(super) fn names(&mut self, case: &Case) {
        let sets = case.sets.iter().map(|set| ("set", &set.name));
        // a body made of a set of elements is that set, not another thing of its name
        let elements: BTreeSet<&str> = (case.sets.iter())
            .filter(|set| matches!(set.content, SetContent::Elements(_)))
            .map(|set| set.name.as_str())
            .collect();
        let groups = (case.bodies.iter())
            .flat_map(|body| &body.groups)
            .filter(|group| !elements.contains(group.as_str()))
            .map(|group| ("body", group));
        let references = case.references.iter().map(|one| ("reference", &one.name));
        let surfaces = case.surfaces.iter().map(|one| ("surface", &one.name));
        let all = groups.chain(sets).chain(surfaces.clone());
        self.unique(all.chain(references.clone()));
        self.unique(case.springs.iter().map(|one| ("spring", &one.name)));
        self.unique(
            case.contacts
                .iter()
                .map(|contact| ("contact", &contact.name)),
        );
        self.unique(case.steps.iter().map(|step| ("step", &step.name)));
        self.unique(case.output.history.iter().map(|one| ("history", &one.name)));
        let rigid = case
            .bodies
            .iter()
            .filter(|body| body.rigid)
            .flat_map(|body| &body.groups);
        let columns: Vec<_> = case
            .contacts
            .iter()
            .map(|one| ("contact", &one.name))
            .chain(rigid.map(|group| ("rigid body", group)))
            .chain(references.clone())
            .collect();
        for history in case
            .output
            .history
            .iter()
            .filter(|one| !one.name.is_empty())
        {
            if let Some(first) = columns
                .iter()
                .find(|(_, name)| name.value == history.name.value)
            {
                self.name_twice(*first, ("history", &history.name));
            }
        }
        for step in &case.steps {
            self.unique(
                step.loads
                    .iter()
                    .filter_map(|load| Some(("load", load.name.as_ref()?))),
            );
        }
        // Groups of a mesh in place share the name space, too.
        if let MeshSource::Inline { elements, .. } = &case.mesh {
            let groups: BTreeMap<&str, &Name> = elements
                .iter()
                .filter_map(|one| one.group.as_ref())
                .map(|group| (group.value.as_str(), group))
                .collect();
            let bodies: BTreeSet<&str> = case
                .bodies
                .iter()
                .flat_map(|body| &body.groups)
                .map(|group| group.as_str())
                .collect();
            let sets = case.sets.iter().map(|set| ("set", &set.name));
            for (kind, name) in sets.chain(surfaces).chain(references) {
                let is_body = || bodies.contains(name.as_str());
                if let Some(group) = groups.get(name.as_str()).filter(|_| !is_body()) {
                    self.name_twice(("group of elements", group), (kind, name));
                }
            }
        }
    }

    fn unique<'a>(&mut self, names: impl Iterator<Item = (&'static str, &'a Name)>) {
        let mut seen: BTreeMap<&str, (&str, &Name)> = BTreeMap::new();
        for (kind, name) in names.filter(|(_, name)| !name.is_empty()) {
            match seen.get(name.value.as_str()) {
                Some(first) => self.name_twice(*first, (kind, name)),
                None => {
                    seen.insert(&name.value, (kind, name));
                }
            }
        }
    }

    fn name_twice(&mut self, first: (&str, &Name), second: (&str, &Name)) {
        let name = shortened(second.1);
        let message = if first.0 == second.0 {
            format!("two {} are called \"{name}\"", plural(second.0))
        } else {
            format!("\"{name}\" is both a {} and a {}", first.0, second.0)
        };
        self.found.push(
            Diagnostic::error(&codes::NAME_TWICE, message)
                .at(&second.1.place, "rename this one")
                .at(&first.1.place, "or this one"),
        );
    }

    /// A chain of unions that comes back to its first set.
    pub(super) fn cycles(&mut self, case: &Case) {
        let index: BTreeMap<&str, usize> = case
            .sets
            .iter()
            .enumerate()
            .map(|(at, set)| (set.name.as_str(), at))
            .collect();
        let members: Vec<Vec<(usize, &Name)>> = case
            .sets
            .iter()
            .map(|set| match &set.content {
                SetContent::Union(names) => names
                    .iter()
                    .filter_map(|name| Some((*index.get(name.as_str())?, name)))
                    .collect(),
                SetContent::Region { of, .. } => of
                    .iter()
                    .filter_map(|name| Some((*index.get(name.as_str())?, name)))
                    .collect(),
                SetContent::Nodes(_) | SetContent::Elements(_) | SetContent::Faces(_) => Vec::new(),
            })
            .collect();
        // Sets whose members are all resolved are resolved; what never is leads into a cycle.
        let mut users: Vec<Vec<usize>> = vec![Vec::new(); members.len()];
        let mut open: Vec<usize> = members.iter().map(Vec::len).collect();
        for (user, inner) in members.iter().enumerate() {
            for (member, _) in inner {
                if let Some(users) = users.get_mut(*member) {
                    users.push(user);
                }
            }
        }
        let mut resolved: Vec<usize> = (0..members.len())
            .filter(|at| open.get(*at) == Some(&0))
            .collect();
        while let Some(member) = resolved.pop() {
            for user in users.get(member).into_iter().flatten() {
                if let Some(count) = open.get_mut(*user) {
                    *count -= 1;
                    if *count == 0 {
                        resolved.push(*user);
                    }
                }
            }
        }
        let is_open = |at: usize| open.get(at).is_some_and(|count| *count > 0);
        let Some(mut at) = (0..members.len()).find(|at| is_open(*at)) else {
            return;
        };
        let mut chain: Vec<(usize, &Name)> = Vec::new();
        let mut seen = BTreeSet::new();
        while seen.insert(at) {
            let next = members
                .get(at)
                .and_then(|inner| inner.iter().find(|(member, _)| is_open(*member)));
            let Some((next, name)) = next else {
                return;
            };
            chain.push((at, *name));
            at = *next;
        }
        let cycle: Vec<&Name> = chain
            .iter()
            .skip_while(|(set, _)| *set != at)
            .map(|(_, name)| *name)
            .collect();
        let words = listed(cycle.iter().map(|name| name.as_str()));
        if let Some(first) = cycle.first() {
            self.found.push(
                Diagnostic::error(&codes::CONTRADICTION, "a set contains itself")
                    .at(&first.place, "part of the circle")
                    .note(format!(
                        "each of these contains the next, and the last the first: {words}"
                    )),
            );
        }
    }

    /// References from one part of the case to another.
    pub(super) fn references(&mut self, case: &Case, root: Fields<'_>) {
        // Where a list of definitions has a wrong form, which has been reported, nobody knows what it defines.
        let known = |key: &str| !root.has(key) || root.is_of_its_form(key);
        if known("material") {
            self.materials_named(case);
        }
        if known("orientation") {
            self.orientations_of_bodies(case);
        }
        let amplitudes: BTreeSet<&str> = case
            .amplitudes
            .iter()
            .map(|one| one.name.as_str())
            .collect();
        let moves = case.steps.iter().flat_map(|step| &step.moves);
        let motions = moves.flat_map(|one| one.u.iter().chain(&one.rot)).flatten();
        let temperatures = case.steps.iter().flat_map(|step| &step.temperatures);
        let courses = motions.chain(temperatures.map(|one| &one.value));
        let of_motions = courses.filter_map(|motion| match motion {
            Motion::Amplitude { name, .. } => Some(name),
            Motion::Ramp(_) | Motion::Table(_) => None,
        });
        let loads = case.steps.iter().flat_map(|step| &step.loads);
        let of_loads = loads.filter_map(|load| match &load.course {
            Course::Amplitude(name) => Some(name),
            Course::Ramp | Course::Table(_) => None,
        });
        for name in of_motions.chain(of_loads).filter(|_| known("amplitude")) {
            self.reference("amplitude", name, &amplitudes);
        }
        let points: BTreeSet<&str> = case
            .references
            .iter()
            .map(|one| one.name.as_str())
            .collect();
        let of_bodies = case
            .bodies
            .iter()
            .filter_map(|body| body.reference.as_ref());
        let of_constraints = case.constraints.iter().filter_map(|one| match &one.kind {
            ConstraintKind::Kinematic { reference, .. }
            | ConstraintKind::Distributing { reference, .. }
            | ConstraintKind::Twist { reference, .. }
            | ConstraintKind::Pretension { reference, .. } => Some(reference),
            _ => None,
        });
        let of_surfaces = case
            .surfaces
            .iter()
            .filter_map(|one| one.reference.as_ref());
        for name in of_bodies
            .chain(of_constraints)
            .chain(of_surfaces)
            .filter(|_| known("reference"))
        {
            self.reference("reference", name, &points);
        }
        let contacts: BTreeSet<&str> = case.contacts.iter().map(|one| one.name.as_str()).collect();
        let rigid = case
            .bodies
            .iter()
            .filter(|body| body.rigid)
            .flat_map(|body| &body.groups);
        let mut rigid: BTreeSet<&str> = rigid.map(|group| group.as_str()).collect();
        rigid.extend(&points);
        for history in &case.output.history {
            match &history.source {
                // contacts that are found later have names, too
                HistorySource::Contact(name)
                    if known("contact") && (case.general.is_none() || !name.contains('-')) =>
                {
                    self.reference("contact", name, &contacts)
                }
                HistorySource::Reference(name) if known("body") && known("reference") => {
                    self.reference("reference or rigid body", name, &rigid)
                }
                _ => {}
            }
        }
        let changes = case.steps.iter().flat_map(|step| &step.contacts);
        for change in changes.filter(|_| known("contact")) {
            self.reference("contact", &change.name, &contacts);
        }
        if case.bodies.is_empty() && root.has("body") && known("body") {
            self.found.push(
                Diagnostic::error(&codes::MISSING, "there is no body")
                    .help("write [[body]] with a group and a material"),
            );
        }
        if case.steps.is_empty() && root.has("step") && known("step") {
            self.found.push(
                Diagnostic::error(&codes::MISSING, "there is no step: nothing would happen")
                    .help("write [[step]]"),
            );
        }
    }

    /// Materials that bodies and steps name.
    fn materials_named(&mut self, case: &Case) {
        let materials: BTreeSet<&str> =
            case.materials.iter().map(|one| one.name.as_str()).collect();
        let changes = case.steps.iter().flat_map(|step| &step.materials);
        let bodies = case.bodies.iter();
        for material in bodies
            .filter_map(|body| body.material.as_ref())
            .chain(changes.map(|change| &change.material))
        {
            self.reference("material", material, &materials);
        }
    }

    /// Orientations that bodies name.
    fn orientations_of_bodies(&mut self, case: &Case) {
        let known: BTreeSet<&str> = (case.orientations.iter())
            .map(|one| one.name.as_str())
            .collect();
        for body in &case.bodies {
            if let Some(BodyAxes::Named(name)) = &body.orientation {
                self.reference("orientation", name, &known);
            }
        }
    }

    /// Surfaces where none can be, and those that take no part.
    pub(super) fn surfaces(&mut self, case: &Case) {
        let of_name: BTreeMap<&str, &Surface> = case
            .surfaces
            .iter()
            .map(|one| (one.name.as_str(), one))
            .collect();
        let mut used = BTreeSet::new();
        for contact in &case.contacts {
            if let Some(surface) = of_name.get(contact.secondary.as_str()) {
                used.insert(surface.name.as_str());
                self.error(
                    &codes::CONTRADICTION,
                    format!(
                        "the secondary side of contact \"{}\" is a surface without nodes",
                        contact.name.value
                    ),
                    &contact.secondary.place,
                    "a [[surface]] is always `primary`",
                );
            }
            let Some(surface) = of_name.get(contact.primary.as_str()) else {
                continue;
            };
            used.insert(surface.name.as_str());
            let needs = if *contact.method == Method::NodeToNode {
                "\"node-to-node\" needs nodes on both sides"
            } else if *contact.method == Method::Mortar {
                "\"mortar\" needs faces on both sides"
            } else if contact.two_pass {
                "two passes need points on both sides"
            } else {
                continue;
            };
            self.found.push(
                Diagnostic::error(
                    &codes::CONTRADICTION,
                    format!("surface \"{}\" has no nodes", surface.name.value),
                )
                .at(&contact.primary.place, needs)
                .help("write  method = \"node-to-segment\"  and  passes = 1"),
            );
        }
        let idle = case.surfaces.iter().filter(|_| case.general.is_none());
        for surface in idle.filter(|one| !used.contains(one.name.as_str())) {
            self.found.push(
                Diagnostic::warning(
                    &codes::NO_EFFECT,
                    format!("surface \"{}\" touches nothing", surface.name.value),
                )
                .at(&surface.place, "no contact has it as `primary`"),
            );
        }
    }

    /// Pairs of sides that stand in two contacts, in one order or the other, and act in one step.
    pub(super) fn pairs(&mut self, case: &Case) {
        let mut seen: BTreeMap<[&str; 2], &Contact> = BTreeMap::new();
        for contact in &case.contacts {
            let mut sides = [contact.secondary.as_str(), contact.primary.as_str()];
            sides.sort_unstable();
            if sides.contains(&"") {
                continue;
            }
            let Some(first) = seen.get(&sides) else {
                seen.insert(sides, contact);
                continue;
            };
            let [one, other] = [first, contact].map(|contact| contact.acting(case.steps.iter()));
            if !one.zip(other).any(|(one, other)| one && other) {
                continue;
            }
            let swapped = first.secondary != contact.secondary;
            let how = if swapped { ", with sides swapped" } else { "" };
            let mut one = Diagnostic::warning(
                &codes::PAIR_TWICE,
                format!(
                    "contacts \"{}\" and \"{}\" are of one pair{how}",
                    first.name.value, contact.name.value
                ),
            )
            .at(&contact.place, "where both act, both push")
            .at(&first.place, "the first");
            if swapped {
                one = one.help("one contact with  passes = 2  looks at both sides");
            }
            self.found.push(one);
        }
    }

    /// Changes of contacts that contradict what is changed, or each other.
    pub(super) fn contact_changes(&mut self, case: &Case) {
        let of_name: BTreeMap<&str, &Contact> = case
            .contacts
            .iter()
            .map(|one| (one.name.as_str(), one))
            .collect();
        for step in &case.steps {
            let mut seen: BTreeMap<&str, &ContactChange> = BTreeMap::new();
            for change in step.contacts.iter().filter(|one| !one.name.is_empty()) {
                if let Some(first) = seen.insert(change.name.as_str(), change) {
                    self.found.push(
                        Diagnostic::error(
                            &codes::CONTRADICTION,
                            format!(
                                "step \"{}\" changes contact \"{}\" twice",
                                step.name.value, change.name.value
                            ),
                        )
                        .at(&change.place, "the second")
                        .at(&first.place, "the first")
                        .help("write one of them"),
                    );
                }
                let tied = of_name.get(change.name.as_str());
                if tied.is_some_and(|contact| contact.tied.is_some() && contact.cohesive.is_none())
                    && matches!(change.friction, Some(Some(_)))
                {
                    self.error(
                        &codes::CONTRADICTION,
                        format!("the sides of contact \"{}\" are joined", change.name.value),
                        &change.place,
                        "what is joined does not slide: delete `friction`",
                    );
                }
            }
        }
    }

    fn reference(&mut self, kind: &str, name: &Name, known: &BTreeSet<&str>) {
        if name.is_empty() && name.place.get().is_none() || known.contains(name.as_str()) {
            return;
        }
        let message = format!("there is no {kind} called \"{}\"", shortened(name));
        let one = Diagnostic::error(&codes::UNDEFINED, message);
        // Proposals take the product of the numbers of names, and nobody reads a hundred of them.
        self.found.push(if self.found.len() < 100 {
            let remark = closest(name, known.iter().copied());
            one.at(
                &name.place,
                remark.map_or(String::new(), |meant| format!("did you mean \"{meant}\"?")),
            )
            .note(format!("defined are: {}", listed(known.iter().copied())))
        } else {
            one.at(&name.place, "")
        });
    }
}

fn plural(kind: &str) -> String {
    match kind.strip_suffix('y') {
        Some(stem) => format!("{stem}ies"),
        None => format!("{kind}s"),
    }
}
