//! The mesh, sets, materials, bodies, springs, constraints.

use super::super::build::COMPONENTS;
use super::super::parts::*;
use super::super::vocabulary::OWN;
use super::steps::axes;
use super::write::{Entries, Value, list, names};

pub(super) fn mesh(mesh: &MeshSource) -> Entries {
    match mesh {
        MeshSource::File { path } => vec![("file", (&path.value).into())],
        MeshSource::Inline {
            nodes, elements, ..
        } => {
            let row = |(id, [x, y, z]): &(u64, [f64; 3])| {
                Value::List(vec![(*id).into(), (*x).into(), (*y).into(), (*z).into()])
            };
            let element = |one: &InlineElement| {
                let mut entries: Entries = vec![
                    ("id", one.id.into()),
                    ("type", (&one.element_type.value).into()),
                ];
                entries.extend(
                    one.group
                        .as_ref()
                        .map(|group| ("group", (&group.value).into())),
                );
                entries.push(("nodes", list(one.nodes.iter().copied())));
                Value::Table(entries)
            };
            vec![
                ("nodes", Value::List(nodes.iter().map(row).collect())),
                (
                    "elements",
                    Value::List(elements.iter().map(element).collect()),
                ),
            ]
        }
    }
}

pub(super) fn model(model: &Model) -> Entries {
    let mut entries = vec![("space", model.space.word().into())];
    if model.space.has_thickness() {
        entries.push(("thickness", model.thickness.into()));
    }
    entries
}

pub(super) fn set_content(content: &SetContent) -> Entries {
    vec![match content {
        SetContent::Nodes(nodes) => ("nodes", list(nodes.iter().copied())),
        SetContent::Elements(elements) => ("elements", list(elements.iter().copied())),
        SetContent::Faces(faces) => {
            let row = |(element, side): &(u64, Side)| {
                Value::List(vec![(*element).into(), Value::Text(side.to_string())])
            };
            ("faces", Value::List(faces.iter().map(row).collect()))
        }
        SetContent::Union(members) => ("union", names(members)),
        SetContent::Region { region, of } => {
            let mut entries = self::region(region);
            entries.extend(of.as_ref().map(|of| ("of", (&of.value).into())));
            return entries;
        }
    }]
}

fn region(region: &Region) -> Entries {
    match region {
        Region::Plane { normal, at, tol } => {
            let mut entries = vec![("plane", normal.into()), ("at", (*at).into())];
            entries.extend(tol.map(|tol| ("tol", tol.into())));
            entries
        }
        Region::Box { low, high } => vec![("box", list([low, high]))],
        Region::Sphere { center, radius } => {
            let row = Value::List(vec![center.into(), (*radius).into()]);
            vec![("sphere", row)]
        }
        Region::Near { point } => vec![("near", point.into())],
    }
}

pub(super) fn local_axes(one: &LocalAxes) -> Entries {
    let mut entries = axes_system(&one.system);
    entries.insert(0, ("set", (&one.set.value).into()));
    entries
}

fn axes_system(system: &AxesSystem) -> Entries {
    match system {
        AxesSystem::Rectangular { x, xy } => vec![("x", x.into()), ("xy", xy.into())],
        AxesSystem::Cylindrical { from, to } => vec![("from", from.into()), ("to", to.into())],
    }
}

pub(super) fn reference(one: &Reference) -> Entries {
    let mut entries: Entries = match &one.position {
        Position::At(point) => vec![("at", point.into())],
        Position::Node(node) => vec![("node", (*node).into())],
        Position::Mean => Vec::new(),
    };
    entries.extend(one.rotations.map(|node| ("rotations", node.into())));
    entries
}

impl std::fmt::Display for Side {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Side::Numbered(side) => write!(out, "S{side}"),
            Side::Axis(axis, sense) => {
                let sign = if *sense == Sense::Plus { '+' } else { '-' };
                let axis = match axis {
                    Axis::X => 'x',
                    Axis::Y => 'y',
                    Axis::Z => 'z',
                };
                write!(out, "{sign}{axis}")
            }
        }
    }
}

pub(super) fn thickness(one: &ThicknessAt) -> Entries {
    vec![("on", (&one.on.value).into()), ("value", one.value.into())]
}

pub(super) fn mass(one: &MassAt, plane: bool) -> Entries {
    let mut entries = vec![("on", (&one.on.value).into()), ("value", one.value.into())];
    let centroid = one.centroid.as_ref();
    entries.extend(centroid.map(|at| ("centroid", (&at.value).into())));
    entries.extend(one.inertia.as_ref().map(|of| {
        let about = if plane {
            of.value[2].into()
        } else {
            Value::List(of.value.into_iter().map(Value::from).collect())
        };
        ("inertia", about)
    }));
    entries
}

fn velocity(one: &VelocityAt, plane: bool) -> Value {
    let omega = match plane {
        true => one.spin[2].into(),
        false => (&one.spin).into(),
    };
    let mut entries = vec![
        ("on", (&one.on.value).into()),
        ("v", (&one.velocity).into()),
    ];
    if one.spin != [0.0; 3] {
        entries.extend([("omega", omega), ("about", (&one.about).into())]);
    }
    Value::Table(entries)
}

pub(super) fn initial(case: &Case) -> Entries {
    let row = |at: &AtPoint| {
        let number = [Value::from(at.element), Value::from(at.point)].into_iter();
        Value::List(number.chain(at.value.map(Value::from)).collect())
    };
    let temperature = case.initial_temperature.as_ref();
    let mut entries = Entries::new();
    entries.extend(temperature.map(|temperature| ("temperature", temperature.value.into())));
    if !case.initial_temperatures.is_empty() {
        let at = |one: &TemperatureAt| {
            let mut entries = vec![
                ("on", (&one.on.value).into()),
                ("temperature", one.temperature.into()),
            ];
            entries.extend(one.gradient.map(|gradient| ("gradient", gradient.into())));
            Value::Table(entries)
        };
        let all = case.initial_temperatures.iter().map(at);
        entries.push(("at", Value::List(all.collect())));
    }
    if !case.initial_velocities.is_empty() {
        let plane = case.model.space.ndim() == 2;
        let all = case.initial_velocities.iter();
        let all = all.map(|one| velocity(one, plane));
        entries.push(("velocity", Value::List(all.collect())));
    }
    for (name, points) in [
        ("stress", &case.initial_stress),
        ("strain", &case.initial_strain),
    ] {
        if !points.is_empty() {
            entries.push((name, Value::List(points.iter().map(row).collect())));
        }
    }
    entries
}

pub(super) fn material(one: &Material) -> Entries {
    let mut entries = Entries::new();
    if !one.model.value.is_empty() {
        entries.push(("model", (&one.model.value).into()));
    }
    entries.extend(one.constants.iter().map(|constant| {
        let values = match constant.values.as_slice() {
            [value] => (*value).into(),
            values => list(values.iter().copied()),
        };
        (constant.name, values)
    }));
    let own = one.own.as_ref();
    entries.extend(own.map(|name| (OWN, (&name.value).into())));
    entries.extend(
        one.density
            .as_ref()
            .map(|density| ("density", density.value.into())),
    );
    if one.damping.is_any() {
        let damping = vec![
            ("mass", one.damping.mass.into()),
            ("stiffness", one.damping.stiffness.into()),
        ];
        entries.push(("damping", Value::Table(damping)));
    }
    entries.extend(one.expansion.as_ref().map(|expansion| {
        let alpha = match expansion.alpha.as_slice() {
            [[_, alpha]] => (*alpha).into(),
            rows => list(rows),
        };
        let mut entries = vec![("alpha", alpha), ("reference", expansion.reference.into())];
        match expansion.free.value {
            Unstrained::AtStart => entries.push(("free", "start".into())),
            Unstrained::At(free) if free != expansion.reference => {
                entries.push(("free", free.into()));
            }
            Unstrained::At(_) => {}
        }
        ("expansion", Value::Table(entries))
    }));
    entries.extend(one.heat.iter().flat_map(conduction));
    let plasticity = one.plasticity.as_ref();
    entries.extend(plasticity.map(|one| ("plasticity", Value::Table(self::plasticity(one)))));
    entries
}

/// A number where one holds at all temperatures, else rows.
fn by_temperature(rows: &[[f64; 2]]) -> Value {
    match rows {
        [[_, only]] => (*only).into(),
        rows => list(rows),
    }
}

fn conduction(one: &Conduction) -> Entries {
    let conductivity = match &one.conductivity {
        Conductivity::Isotropic(rows) => by_temperature(rows),
        Conductivity::Along(along) => Value::Table(vec![("along", along.into())]),
        Conductivity::Full(rows) => Value::Table(vec![("rows", list(rows))]),
    };
    let mut entries = vec![("conductivity", conductivity)];
    if !one.specific_heat.is_empty() {
        entries.push(("specific_heat", by_temperature(&one.specific_heat)));
    }
    if !one.latent_heat.is_empty() {
        entries.push(("latent_heat", list(&one.latent_heat)));
    }
    entries
}

fn plasticity(one: &Plasticity) -> Entries {
    let hardening = match *one.hardening {
        Hardening::Isotropic => "isotropic",
        Hardening::Kinematic => "kinematic",
        Hardening::Combined => "combined",
    };
    let mut entries = vec![
        ("hardening", hardening.into()),
        ("table", list(&one.table.value)),
    ];
    let modulus = one.modulus.as_ref();
    entries.extend(modulus.map(|modulus| ("modulus", modulus.value.into())));
    entries
}

fn plane_of(x: &[f64; 3], y: &[f64; 3]) -> Entries {
    vec![("x", x.into()), ("y", y.into())]
}

pub(super) fn orientation(one: &NamedOrientation) -> Entries {
    let mut entries: Entries = match &one.system {
        MaterialSystem::Rectangular { x, y } => {
            let mut entries = vec![("kind", "rectangular".into())];
            entries.extend(plane_of(x, y));
            entries
        }
        MaterialSystem::Cylindrical { origin, axis } => vec![
            ("kind", "cylindrical".into()),
            ("origin", origin.into()),
            ("axis", axis.into()),
        ],
        MaterialSystem::Elements { x, y, rows } => {
            let row = |one: &ElementAxes| {
                Value::List(vec![one.element.into(), (&one.x).into(), (&one.y).into()])
            };
            let mut entries = vec![("kind", "elements".into())];
            entries.extend(plane_of(x, y));
            entries.push(("rows", Value::List(rows.iter().map(row).collect())));
            entries
        }
    };
    entries.extend(one.turn.map(|(axis, angle)| {
        let axis = Value::from(axis as u64 + 1);
        ("turn", Value::List(vec![axis, angle.into()]))
    }));
    entries
}

pub(super) fn body(body: &Body) -> Entries {
    let mut entries = vec![("group", names(&body.groups))];
    let material = body.material.as_ref();
    entries.extend(material.map(|name| ("material", (&name.value).into())));
    if body.rigid {
        entries.push(("rigid", true.into()));
        let reference = body.reference.as_ref();
        entries.extend(reference.map(|name| ("reference", (&name.value).into())));
        return entries;
    }
    let integration = match body.integration {
        Integration::Full => "full",
        Integration::Reduced => "reduced",
        Integration::Raised => "raised",
    };
    entries.extend([
        ("integration", integration.into()),
        ("locking", body.locking.word().into()),
    ]);
    entries.extend(body.orientation.as_ref().map(|one| {
        let value = match one {
            BodyAxes::Here(one) => Value::Table(plane_of(&one.x, &one.y)),
            BodyAxes::Named(name) => (&name.value).into(),
        };
        ("orientation", value)
    }));
    let space = body.space.as_ref();
    entries.extend(space.map(|space| ("space", space.word().into())));
    let of_body = body.thickness.as_ref();
    entries.extend(of_body.map(|of| ("thickness", extent(of.value))));
    entries.extend(
        body.shell
            .as_ref()
            .map(|one| ("shell", Value::Table(shell(one)))),
    );
    let temperatures = match body.temperatures {
        Temperatures::Full => "full",
        Temperatures::Linear => "linear",
    };
    let at_nodes = match body.at_nodes {
        AtNodes::Linear => "linear",
        AtNodes::Element => "element",
    };
    entries.extend([
        ("temperatures", temperatures.into()),
        ("at_nodes", at_nodes.into()),
    ]);
    entries.extend(body.area.as_ref().map(|area| ("area", area.value.into())));
    let strain = if body.small_strain { "small" } else { "auto" };
    let mass_matrix = match body.mass_matrix {
        MassMatrix::Auto => "auto",
        MassMatrix::Consistent => "consistent",
        MassMatrix::Lumped => "lumped",
    };
    entries.extend([
        ("strain", strain.into()),
        ("mass_matrix", mass_matrix.into()),
    ]);
    entries.extend(body.lumped_capacity.then(|| ("capacity", "lumped".into())));
    entries.push(("rigid", false.into()));
    entries
}

fn extent(thickness: Thickness) -> Value {
    match thickness {
        Thickness::Uniform(length) => length.into(),
        Thickness::Field => "field".into(),
    }
}

fn shell(one: &Shell) -> Entries {
    vec![
        ("thickness", extent(one.thickness.value)),
        ("offset", one.offset.into()),
        ("normals", one.normals.value.into()),
        ("points", (one.points as u64).into()),
    ]
}

pub(super) fn spring(spring: &Spring) -> Entries {
    let mut entries = vec![
        ("name", (&spring.name.value).into()),
        match &spring.ends {
            SpringEnds::Between(one, other) => ("between", names([one, other])),
            SpringEnds::Ground(on) => ("on", (&on.value).into()),
        },
        match &spring.law {
            SpringLaw::Linear(stiffness) => ("stiffness", (*stiffness).into()),
            SpringLaw::Table(rows) => ("table", list(rows)),
        },
    ];
    entries.extend(spring.direction.map(|along| ("direction", along.into())));
    entries
}

pub(super) fn constraint(constraint: &Constraint) -> Entries {
    let of_kind = |kind: &'static str, on: &Name| -> Entries {
        vec![("kind", kind.into()), ("on", (&on.value).into())]
    };
    match &constraint.kind {
        ConstraintKind::Equation { terms, rhs } => {
            let row = |term: &Summand| {
                let component = COMPONENTS.get(term.component.value).copied();
                Value::List(vec![
                    (&term.on.value).into(),
                    component.unwrap_or_default().into(),
                    term.coefficient.into(),
                ])
            };
            let rows = terms.iter().map(row).collect();
            vec![("equation", Value::List(rows)), ("rhs", (*rhs).into())]
        }
        ConstraintKind::Kinematic {
            on,
            reference,
            axes,
            local,
        } => {
            let mut entries = of_kind("kinematic", on);
            entries.push(("reference", (&reference.value).into()));
            entries.push(("dofs", self::axes(*axes)));
            let local = local.as_ref().map(axes_system);
            entries.extend(local.map(|local| ("local", Value::Table(local))));
            entries
        }
        ConstraintKind::Distributing { on, reference } => {
            let mut entries = of_kind("distributing", on);
            entries.push(("reference", (&reference.value).into()));
            entries
        }
        ConstraintKind::Plane { on } => of_kind("plane", on),
        ConstraintKind::Equal { on, axes } => {
            let mut entries = of_kind("equal", on);
            entries.push(("dofs", self::axes(*axes)));
            entries
        }
        ConstraintKind::Line { on } => of_kind("line", on),
        ConstraintKind::Distance { on, most } => {
            let mut entries = of_kind("distance", on);
            entries.extend(most.map(|most| ("most", most.into())));
            entries
        }
        ConstraintKind::Twist {
            on,
            reference,
            axis,
        } => {
            let mut entries = of_kind("twist", on);
            entries.push(("reference", (&reference.value).into()));
            entries.push(("axis", list(*axis)));
            entries
        }
        ConstraintKind::Pretension {
            on,
            reference,
            normal,
        } => {
            let mut entries = of_kind("pretension", on);
            entries.push(("reference", (&reference.value).into()));
            entries.extend(normal.map(|normal| ("normal", list(normal))));
            entries
        }
        ConstraintKind::Cyclic {
            on,
            with,
            sectors,
            point,
            axis,
        } => {
            let mut entries = of_kind("cyclic", on);
            entries.push(("with", (&with.value).into()));
            entries.push(("sectors", (*sectors).into()));
            entries.push(("point", list(*point)));
            entries.push(("axis", list(*axis)));
            entries
        }
    }
}
