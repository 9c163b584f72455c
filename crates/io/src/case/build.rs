//! From a checked document to a [`Case`], and the checks that need more than one table.

use std::collections::{BTreeMap, BTreeSet};

use toml::de::{DeTable, DeValue};

use super::check::id;
use super::fields::{Fields, numbers};
use super::origin::Origins;
use super::parts::*;
use super::scalar::shortened;
use super::vocabulary::CASE;
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Place, Spanned, closest, codes, listed};

/// The version of the case format that this program reads and writes.
pub(super) const FORMAT: u64 = 1;

/// Builds the case of a checked document.
///
/// The case is of use only where neither the check nor this function found errors.
pub(super) fn build(document: &DeTable<'_>, origins: &Origins) -> (Case, Diagnostics) {
    let mut builder = Builder {
        found: Diagnostics::new(),
    };
    let root = Fields::new(document, &CASE, origins);
    let case = builder.case(root);
    builder.names(&case);
    builder.cycles(&case);
    builder.references(&case, root);
    (case, builder.found)
}

struct Builder {
    found: Diagnostics,
}

impl Builder {
    fn error(
        &mut self,
        code: &'static Code,
        message: impl Into<String>,
        place: &Place,
        remark: impl Into<String>,
    ) {
        self.found
            .push(Diagnostic::error(code, message).at(place, remark));
    }

    fn later(&mut self, what: &str, place: &Place, instead: &str) {
        self.found.push(
            Diagnostic::error(&codes::NOT_BUILT, format!("{what} is not supported yet"))
                .at(place, "known, but this version cannot do it")
                .help(format!("until then: {instead}")),
        );
    }

    fn case(&mut self, root: Fields<'_>) -> Case {
        let format = root.count("format");
        if format > FORMAT {
            self.error(
                &codes::NEWER_FORMAT,
                format!("the case is written for format {format}"),
                &root.place("format"),
                format!("this program reads format {FORMAT}"),
            );
        }
        let model = self.model(root.table("model"));
        let plane = *model.space != Space::ThreeD;
        Case {
            format: u32::try_from(format).unwrap_or(u32::MAX),
            title: root.text("title").value,
            units: root.text("units"),
            allow: self.allow(root),
            mesh: self.mesh(root.table("mesh"), plane),
            model,
            sets: root
                .named("sets")
                .into_iter()
                .map(|(name, fields, place)| self.set(name, fields, place))
                .collect(),
            amplitudes: root
                .named("amplitude")
                .into_iter()
                .map(|(name, fields, _)| self.amplitude(name, fields))
                .collect(),
            materials: root
                .named("material")
                .into_iter()
                .map(|(name, fields, _)| material(name, fields))
                .collect(),
            bodies: root
                .tables("body")
                .into_iter()
                .map(|(fields, place)| self.body(fields, place))
                .collect(),
            contacts: root
                .tables("contact")
                .into_iter()
                .map(|(fields, place)| self.contact(fields, place))
                .collect(),
            steps: root
                .tables("step")
                .into_iter()
                .map(|(fields, place)| self.step(fields, place))
                .collect(),
            solver: self.solver(root.table("solver")),
            output: output(root.table("output")),
            checkpoint: self.checkpoint(root.table("checkpoint")),
            expectations: root
                .tables("expect")
                .into_iter()
                .map(|(fields, place)| expectation(fields, place))
                .collect(),
        }
    }

    fn allow(&mut self, root: Fields<'_>) -> Vec<String> {
        let allowed = root.texts("allow");
        for one in &allowed {
            if Code::find(one).is_none() {
                let known = codes::ALL.iter().map(|code| code.id);
                let remark = closest(one, known)
                    .map_or(String::new(), |meant| format!("did you mean \"{meant}\"?"));
                self.error(
                    &codes::NOT_A_CHOICE,
                    format!("there is no warning \"{}\"", shortened(one)),
                    &one.place,
                    remark,
                );
            }
        }
        allowed.into_iter().map(|one| one.value).collect()
    }

    fn model(&mut self, fields: Fields<'_>) -> Model {
        let space = fields.text("space");
        let plane = space.value == "plane-strain";
        if fields.has("thickness") && !plane {
            self.error(
                &codes::CONTRADICTION,
                "`thickness` means nothing in space",
                &fields.place("thickness"),
                "delete it, or choose space = \"plane-strain\"",
            );
        }
        Model {
            space: Spanned::new(
                if plane {
                    Space::PlaneStrain
                } else {
                    Space::ThreeD
                },
                space.place,
            ),
            thickness: fields.number("thickness"),
        }
    }

    fn mesh(&mut self, fields: Fields<'_>, plane: bool) -> MeshSource {
        if let Some(path) = fields.text_if("file") {
            if path.trim().is_empty() {
                self.error(
                    &codes::MISSING,
                    "[mesh] names no file",
                    &path.place,
                    "write the path of a mesh",
                );
            }
            return MeshSource::File { path };
        }
        let elements = fields
            .tables("elements")
            .into_iter()
            .map(|(one, place)| InlineElement {
                id: one.count("id"),
                element_type: one.text("type"),
                group: one.text_if("group"),
                nodes: one.counts("nodes"),
                place,
            });
        MeshSource::Inline {
            nodes: self.nodes(fields, plane),
            elements: elements.collect(),
            place: fields.place("nodes"),
        }
    }

    fn nodes(&mut self, fields: Fields<'_>, plane: bool) -> Vec<(u64, [f64; 3])> {
        let Some(rows) = fields
            .get("nodes")
            .and_then(|value| value.get_ref().as_array())
        else {
            return Vec::new();
        };
        let mut nodes = Vec::with_capacity(rows.len());
        for row in rows.iter() {
            let Some(items) = row.get_ref().as_array() else {
                self.error(
                    &codes::WRONG_TYPE,
                    "a node is a row [id, x, y, z]",
                    &fields.at(row.span()),
                    "not a list",
                );
                continue;
            };
            let node = items.first().and_then(id);
            let point = numbers::<4>(row.get_ref()).map(|[_, x, y, z]| [x, y, z]);
            let point = point.or_else(|| {
                let flat = numbers::<3>(row.get_ref()).filter(|_| plane);
                flat.map(|[_, x, y]| [x, y, 0.0])
            });
            match (node, point) {
                (Some(node), Some(point)) => nodes.push((node, point)),
                _ => self.bad_node(fields, row, items, plane),
            }
        }
        if rows.is_empty() {
            self.error(
                &codes::WRONG_LENGTH,
                "`nodes` needs at least one row",
                &fields.place("nodes"),
                "no rows",
            );
        }
        nodes
    }

    /// Says what is wrong with a row of a node.
    fn bad_node(
        &mut self,
        fields: Fields<'_>,
        row: &toml::Spanned<DeValue<'_>>,
        items: &[toml::Spanned<DeValue<'_>>],
        plane: bool,
    ) {
        let wanted = if plane { "[id, x, y]" } else { "[id, x, y, z]" };
        let right_length = items.len() == 4 || (plane && items.len() == 3);
        if !right_length {
            let message = format!("a node is a row {wanted}, found {} entries", items.len());
            self.error(
                &codes::WRONG_LENGTH,
                message,
                &fields.at(row.span()),
                "a decimal comma splits one number in two",
            );
            return;
        }
        if items.first().and_then(id).is_none() {
            let span = items.first().map_or(row.span(), toml::Spanned::span);
            self.error(
                &codes::WRONG_TYPE,
                "the number of a node is a whole number from 0 on",
                &fields.at(span),
                "not such a number",
            );
        }
        for item in items.iter().skip(1) {
            match super::scalar::number(item.get_ref()) {
                None => self.error(
                    &codes::WRONG_TYPE,
                    "a coordinate is a number",
                    &fields.at(item.span()),
                    "not a number",
                ),
                Some(number) if !super::scalar::is_usable(number) => {
                    self.error(
                        &codes::NOT_FINITE,
                        "a coordinate is a finite number",
                        &fields.at(item.span()),
                        "not finite, or too small",
                    );
                }
                Some(_) => {}
            }
        }
    }

    fn set(&mut self, name: Name, fields: Fields<'_>, place: Place) -> Set {
        let content = if fields.has("faces") {
            SetContent::Faces(self.faces(fields))
        } else if fields.has("union") {
            SetContent::Union(fields.texts("union"))
        } else {
            SetContent::Nodes(fields.counts("nodes"))
        };
        Set {
            name,
            content,
            place,
        }
    }

    fn faces(&mut self, fields: Fields<'_>) -> Vec<(u64, Side)> {
        let rows = fields
            .get("faces")
            .and_then(|value| value.get_ref().as_array());
        let mut faces = Vec::new();
        for row in rows.into_iter().flat_map(|rows| rows.iter()) {
            let Some([element, side]) = row.get_ref().as_array().map(|items| &**items) else {
                continue;
            };
            let (Some(element), Some(word)) = (id(element), side.get_ref().as_str()) else {
                continue;
            };
            match Side::parse(word) {
                Some(side) => faces.push((element, side)),
                None => self.error(
                    &codes::NOT_A_CHOICE,
                    format!("there is no side \"{}\"", shortened(word)),
                    &fields.at(side.span()),
                    "a side is \"S1\", \"S2\", … as in Abaqus, or \"+x\", \"-x\", … \"-z\" by its normal",
                ),
            }
        }
        faces
    }

    fn amplitude(&mut self, name: Name, fields: Fields<'_>) -> Amplitude {
        Amplitude {
            name,
            table: self.time_table(fields),
            time: if fields.text("time").value == "total" {
                TimeBase::Total
            } else {
                TimeBase::Step
            },
        }
    }

    /// The rows of `table`; their times must increase.
    fn time_table(&mut self, fields: Fields<'_>) -> Vec<[f64; 2]> {
        let rows = fields
            .get("table")
            .and_then(|value| value.get_ref().as_array());
        let mut table: Vec<[f64; 2]> = Vec::new();
        for row in rows.into_iter().flat_map(|rows| rows.iter()) {
            let Some([time, value]) = numbers(row.get_ref()) else {
                continue;
            };
            if let Some([before, _]) = table.last()
                && time <= *before
            {
                self.error(
                    &codes::NOT_INCREASING,
                    "the times of `table` do not increase",
                    &fields.at(row.span()),
                    format!("{time} comes after {before}"),
                );
                break;
            }
            table.push([time, value]);
        }
        table
    }

    fn body(&mut self, fields: Fields<'_>, place: Place) -> Body {
        let rigid = fields.flag("rigid");
        let groups = fields.texts("group");
        if !rigid && !fields.has("material") && !fields.has_unknown_key() {
            let name = groups.first().map_or("", |group| group.value.as_str());
            self.found.push(
                Diagnostic::error(
                    &codes::MISSING,
                    format!("body \"{name}\" has no `material`"),
                )
                .at(&place, "`material` is missing here")
                .help("write  material = \"NAME\"  of a [material.NAME], or  rigid = true"),
            );
        }
        Body {
            groups,
            material: fields.text_if("material"),
            rigid,
            place,
        }
    }

    fn contact(&mut self, fields: Fields<'_>, place: Place) -> Contact {
        let friction = fields
            .number_if("friction")
            .unwrap_or_else(|| fields.number("friction").into());
        if *friction > 0.0 {
            self.later(
                &format!("`friction` = {}", friction.value),
                &friction.place,
                "friction = 0.0",
            );
        }
        if fields.count("passes") == 2 {
            self.later("`passes` = 2", &fields.place("passes"), "passes = 1");
        }
        if fields.flag("tied") {
            self.later(
                "`tied` = true",
                &fields.place("tied"),
                "one body, with a mesh that is joined",
            );
        }
        let method = fields.text("method");
        Contact {
            name: fields.text("name"),
            secondary: fields.text("secondary"),
            primary: self.primary(fields),
            method: Spanned::new(
                match method.value.as_str() {
                    "node-to-segment" => Method::NodeToSegment,
                    _ => Method::Auto,
                },
                method.place,
            ),
            enforcement: enforcement(fields),
            friction,
            reach: fields.number_if("reach").map(|reach| reach.value),
            active: fields.flag("active"),
            place,
        }
    }

    fn primary(&mut self, fields: Fields<'_>) -> Name {
        let primary = fields.text("primary");
        if primary.value == "self" {
            self.later(
                "`primary = \"self\"`",
                &primary.place,
                "the surface on the other side",
            );
        } else if !primary.is_empty() && primary.value == fields.text("secondary").value {
            self.error(
                &codes::CONTRADICTION,
                format!(
                    "both sides of contact \"{}\" are \"{}\"",
                    fields.text("name").value,
                    primary.value
                ),
                &primary.place,
                "name the other side",
            );
        }
        primary
    }

    fn step(&mut self, fields: Fields<'_>, place: Place) -> Step {
        let duration = fields
            .number_if("duration")
            .map_or_else(|| fields.number("duration"), |number| number.value);
        Step {
            name: fields.text("name"),
            geometry: match fields.text("geometry").value.as_str() {
                "linear" => Geometry::Linear,
                "nonlinear" => Geometry::Nonlinear,
                _ => Geometry::Auto,
            },
            duration,
            increments: self.increments(fields, duration),
            fixes: fields
                .tables("fix")
                .into_iter()
                .map(|(one, place)| Fix {
                    on: one.text("on"),
                    u: directions(one, "u"),
                    rot: directions(one, "rot"),
                    place,
                })
                .collect(),
            moves: fields
                .tables("move")
                .into_iter()
                .map(|(one, place)| self.motion(one, place))
                .collect(),
            frees: fields
                .tables("free")
                .into_iter()
                .map(|(one, place)| Free {
                    on: one.text("on"),
                    u: directions(one, "u"),
                    rot: directions(one, "rot"),
                    place,
                })
                .collect(),
            loads: fields
                .tables("load")
                .into_iter()
                .map(|(one, place)| load(one, place))
                .collect(),
            place,
        }
    }

    fn increments(&mut self, fields: Fields<'_>, duration: f64) -> Increments {
        let table = fields.table("increments");
        if let Some(fixed) = table.count_if("fixed") {
            return Increments::Fixed(fixed.value);
        }
        let Some(initial) = table.number_if("initial") else {
            return Increments::Count(fields.count("increments"));
        };
        let min = table
            .number_if("min")
            .unwrap_or_else(|| initial.min(1e-5 * duration).into());
        let max = table.number_if("max").unwrap_or_else(|| duration.into());
        let mut order = |small: (&str, &Spanned<f64>), large: (&str, &Spanned<f64>)| {
            if small.1.value > large.1.value {
                self.found.push(
                    Diagnostic::error(
                        &codes::OUT_OF_RANGE,
                        format!(
                            "`{}` = {} is greater than `{}` = {}",
                            small.0, small.1.value, large.0, large.1.value
                        ),
                    )
                    .at(&small.1.place, "")
                    .at(&large.1.place, "")
                    .note("min ≤ initial ≤ max ≤ duration of the step"),
                );
            }
        };
        if *min > *max {
            order(("min", &min), ("max", &max));
        } else {
            order(("min", &min), ("initial", &initial));
            order(("initial", &initial), ("max", &max));
        }
        let whole = Spanned::new(duration, fields.place("duration"));
        if table.has("max") {
            order(("max", &max), ("duration", &whole));
        }
        Increments::Adaptive {
            initial: initial.value,
            min: min.value,
            max: max.value,
            count_max: table.count("count_max"),
        }
    }

    fn motion(&mut self, fields: Fields<'_>, place: Place) -> Move {
        let mut component = |key: &str| {
            let table = fields.table(key);
            if let Some(name) = table.text_if("amplitude") {
                Some(Motion::Amplitude {
                    name,
                    value: table.number("value"),
                })
            } else if table.has("table") {
                Some(Motion::Table(self.time_table(table)))
            } else {
                fields
                    .number_if(key)
                    .map(|number| Motion::Ramp(number.value))
            }
        };
        Move {
            u: ["ux", "uy", "uz"].map(&mut component),
            rot: ["rx", "ry", "rz"].map(&mut component),
            on: fields.text("on"),
            place,
        }
    }

    fn solver(&mut self, fields: Fields<'_>) -> Solver {
        let newton = fields.table("newton");
        if fields.flag_if("stabilize") == Some(true) {
            self.error(
                &codes::NOT_A_CHOICE,
                "`stabilize` takes \"auto\" or false",
                &fields.place("stabilize"),
                "write \"auto\"",
            );
        }
        Solver {
            newton: Newton {
                max_iterations: newton.count("max_iterations"),
                force_tol: newton.number("force_tol"),
                gap_tol: newton.number("gap_tol"),
                line_search: match newton.flag_if("line_search") {
                    Some(true) => LineSearch::On,
                    Some(false) => LineSearch::Off,
                    None => LineSearch::Auto,
                },
            },
            linear: if fields.text("linear").value == "direct" {
                LinearChoice::Direct
            } else {
                LinearChoice::Auto
            },
            stabilize: if fields.has("stabilize") && fields.flag_if("stabilize") == Some(false) {
                Stabilize::Off
            } else {
                Stabilize::Auto
            },
            on_trouble: fields
                .texts("on_trouble")
                .iter()
                .map(|word| {
                    if word.value == "cut" {
                        Remedy::Cut
                    } else {
                        Remedy::Stabilize
                    }
                })
                .collect(),
            threads: fields.count_if("threads").map(|count| count.value),
        }
    }

    fn checkpoint(&mut self, fields: Fields<'_>) -> Checkpoint {
        let keep = fields.count("keep");
        let every = fields.table("every");
        if !fields.has("every") {
            return Checkpoint {
                increments: Some(5),
                wall: Some(600.0),
                keep,
            };
        }
        let wall = every.text_if("wall").and_then(|text| {
            let seconds = seconds(&text);
            if seconds.is_none() {
                self.error(
                    &codes::NOT_A_CHOICE,
                    format!("`wall` knows no time \"{}\"", shortened(&text)),
                    &text.place,
                    "a number and a unit: \"30 s\", \"10 min\" or \"2 h\"",
                );
            }
            seconds
        });
        Checkpoint {
            increments: every.count_if("increments").map(|count| count.value),
            wall,
            keep,
        }
    }

    /// Names that stand for two things.
    fn names(&mut self, case: &Case) {
        let sets = case.sets.iter().map(|set| ("set", &set.name));
        let groups = case
            .bodies
            .iter()
            .flat_map(|body| body.groups.iter().map(|group| ("body", group)));
        self.unique(groups.chain(sets));
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
            for set in &case.sets {
                let is_body = || bodies.contains(set.name.as_str());
                if let Some(group) = groups.get(set.name.as_str()).filter(|_| !is_body()) {
                    self.name_twice(("group of elements", group), ("set", &set.name));
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
    fn cycles(&mut self, case: &Case) {
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
                SetContent::Nodes(_) | SetContent::Faces(_) => Vec::new(),
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
    fn references(&mut self, case: &Case, root: Fields<'_>) {
        // Where a list of definitions has a wrong form, which has been told, nobody knows what it defines.
        let known = |key: &str| !root.has(key) || root.is_of_its_form(key);
        let materials: BTreeSet<&str> =
            case.materials.iter().map(|one| one.name.as_str()).collect();
        for material in case
            .bodies
            .iter()
            .filter_map(|body| body.material.as_ref())
            .filter(|_| known("material"))
        {
            self.reference("material", material, &materials);
        }
        let amplitudes: BTreeSet<&str> = case
            .amplitudes
            .iter()
            .map(|one| one.name.as_str())
            .collect();
        let motions = case
            .steps
            .iter()
            .flat_map(|step| &step.moves)
            .flat_map(|one| one.u.iter().chain(&one.rot));
        for motion in motions.flatten() {
            if let Motion::Amplitude { name, .. } = motion
                && known("amplitude")
            {
                self.reference("amplitude", name, &amplitudes);
            }
        }
        let contacts: BTreeSet<&str> = case.contacts.iter().map(|one| one.name.as_str()).collect();
        let rigid = case
            .bodies
            .iter()
            .filter(|body| body.rigid)
            .flat_map(|body| &body.groups);
        let rigid: BTreeSet<&str> = rigid.map(|group| group.as_str()).collect();
        for history in &case.output.history {
            match &history.source {
                HistorySource::Contact(name) if known("contact") => {
                    self.reference("contact", name, &contacts)
                }
                HistorySource::Reference(name) if known("body") => {
                    self.reference("rigid body", name, &rigid)
                }
                _ => {}
            }
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

fn material(name: Name, fields: Fields<'_>) -> Material {
    Material {
        name,
        model: fields.text("model"),
        young: fields.number_if("E").unwrap_or_default(),
        poisson: fields.number_if("nu").unwrap_or_default(),
        density: fields.number_if("density"),
    }
}

fn enforcement(fields: Fields<'_>) -> Enforcement {
    let table = fields.table("enforcement");
    let is_table = fields
        .get("enforcement")
        .is_some_and(|value| value.get_ref().is_table());
    if !is_table {
        return Enforcement::Auto;
    }
    Enforcement::Penalty {
        penalty: table.number_if("penalty"),
        per: table.text_if("per").map(|word| {
            if word.value == "node" {
                Per::Node
            } else {
                Per::Area
            }
        }),
    }
}

fn directions(fields: Fields<'_>, key: &str) -> Directions {
    let words = fields.texts(key);
    let has = |axis: &str| {
        words
            .iter()
            .any(|word| word.value == axis || word.value == "all")
    };
    Directions {
        xyz: [has("x"), has("y"), has("z")],
    }
}

fn load(fields: Fields<'_>, place: Place) -> Load {
    let kind = match fields.vector("per_node") {
        Some(force) => LoadKind::PerNode(force),
        None => LoadKind::Force(fields.vector("force").unwrap_or_default()),
    };
    Load {
        name: fields.text_if("name"),
        on: fields.text("on"),
        kind,
        place,
    }
}

fn output(fields: Fields<'_>) -> Output {
    let every = match fields.table("every").number_if("time") {
        Some(time) => Every::Time(time.value),
        None => Every::Increments(fields.count("every")),
    };
    let history = fields
        .tables("history")
        .into_iter()
        .map(|(one, place)| History {
            name: one.text("name"),
            quantities: one.texts("quantity"),
            source: if one.has("contact") {
                HistorySource::Contact(one.text("contact"))
            } else if one.has("reference") {
                HistorySource::Reference(one.text("reference"))
            } else if one.has("set") {
                HistorySource::Set(one.text("set"))
            } else {
                HistorySource::Node(one.count_if("node").unwrap_or_default())
            },
            place,
        });
    Output {
        format: fields.texts("format"),
        fields: fields.texts("fields"),
        every,
        history: history.collect(),
    }
}

fn expectation(fields: Fields<'_>, place: Place) -> Expectation {
    let at = match (fields.count_if("at"), fields.number_if("time")) {
        (Some(row), _) => Moment::Row(row.value),
        (None, Some(time)) => Moment::Time(time.value),
        (None, None) => Moment::End,
    };
    let tol = fields.table("tol");
    let tolerance = match tol.number_if("abs") {
        Some(abs) => Tolerance::Absolute(abs.value),
        None => Tolerance::Relative(tol.number("rel")),
    };
    Expectation {
        what: fields.text("what"),
        at,
        value: fields.number("value"),
        tolerance,
        place,
    }
}

impl Side {
    /// Reads `S2` or `+z`; capitals do not matter.
    pub fn parse(word: &str) -> Option<Self> {
        let axis = |word: &str| match word {
            "x" | "X" => Some(Axis::X),
            "y" | "Y" => Some(Axis::Y),
            "z" | "Z" => Some(Axis::Z),
            _ => None,
        };
        if let Some(word) = word.strip_prefix('+') {
            return Some(Self::Axis(axis(word)?, Sense::Plus));
        }
        if let Some(word) = word.strip_prefix('-') {
            return Some(Self::Axis(axis(word)?, Sense::Minus));
        }
        let digits = word.strip_prefix(['S', 's'])?;
        let side: u8 = digits.parse().ok()?;
        (side > 0 && digits.bytes().all(|byte| byte.is_ascii_digit()))
            .then_some(Self::Numbered(side))
    }
}

/// Seconds of a time such as `10 min`, `2h`, `1.5 hours`.
fn seconds(text: &str) -> Option<f64> {
    let text = text.trim();
    let end = text.find(|c: char| c.is_alphabetic()).unwrap_or(text.len());
    let number: f64 = text.get(..end)?.trim().parse().ok()?;
    let unit = match text.get(end..)?.trim() {
        "s" | "sec" | "second" | "seconds" => 1.0,
        "min" | "minute" | "minutes" => 60.0,
        "h" | "hour" | "hours" => 3600.0,
        "d" | "day" | "days" => 86400.0,
        _ => return None,
    };
    let seconds = number * unit;
    (seconds.is_normal() && seconds > 0.0).then_some(seconds)
}
