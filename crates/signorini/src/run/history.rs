//! The rows of `history.csv`: the report of every accepted increment.

use super::heat;
use super::probe::{Probe, ProbeError, quantities};
use crate::setup::Model;
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::HistorySource;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Spanned, closest, codes, listed};
use signorini_io::writers::csv::{
    COHESION_COLUMNS, CONDUCTION_COLUMNS, CONTACT_COLUMNS, ENERGY_COLUMNS, HEAT_COLUMNS,
    HISTORY_COLUMNS, HistoryOf, REFERENCE_COLUMNS, history_columns, reference_columns,
};
use signorini_mechanics::system::{
    ContactFrame, Energies, Frame, HeatBalance, Resultant, RigidFrame, Wear,
};

/// The columns of a run and where their values come from.
#[derive(Debug)]
pub struct History {
    columns: Vec<String>,
    contacts: Vec<String>,
    references: Vec<RigidId>,
    has_inertia: bool,
    breaking: Vec<String>,
    has_heat: bool,
    conducting: Vec<String>,
    chosen: Vec<Chosen>,
}

/// A column that the case asks for.
#[derive(Debug)]
enum Chosen {
    /// The same as another one.
    Copy(usize),
    /// A field at nodes.
    Probe(Probe),
    /// Cycles that are behind.
    Cycles,
    /// What is worn off a contact.
    Worn(String, OfWear),
}

/// A number of what is worn off.
type OfWear = fn(&Wear) -> f64;

/// The columns of every contact that wears, after its name and a dot: volumes of the secondary and the primary side, and the largest
/// depth of either.
const WEAR_COLUMNS: [(&str, OfWear); 3] = [
    ("worn_volume", |wear| wear.volume[0]),
    ("worn_volume_primary", |wear| wear.volume[1]),
    ("worn_depth", |wear| wear.deepest),
];

impl History {
    /// The columns of a model.
    ///
    /// # Errors
    /// Entries of `[[output.history]]` that name nothing.
    pub fn new(model: &Model) -> Result<Self, Diagnostics> {
        let contacts = contacts(model);
        let contacts: Vec<&str> = contacts.iter().map(String::as_str).collect();
        let references: Vec<&str> = model.references.iter().map(|r| r.name.as_str()).collect();
        let has_inertia = has_inertia(model);
        let breaking = breaking(model);
        let torn: Vec<&str> = breaking.iter().map(String::as_str).collect();
        let conducting = conducting(model);
        let warm: Vec<&str> = conducting.iter().map(String::as_str).collect();
        let of = HistoryOf {
            contacts: &contacts,
            references: &references,
            has_inertia,
            breaking: &torn,
            has_heat: has_heat(model),
            conducting: &warm,
        };
        let standard = history_columns(&of, &[]);
        let mut found = Diagnostics::new();
        let mut names = Vec::new();
        let mut chosen = Vec::new();
        if !model.cycles.is_empty() {
            names.push("cycles".to_owned());
            chosen.push(Chosen::Cycles);
        }
        let wearing = model.case.contacts.iter().filter(|c| c.wear.is_some());
        for contact in wearing {
            for (column, value) in WEAR_COLUMNS {
                names.push(format!("{}.{column}", contact.name.value));
                chosen.push(Chosen::Worn(contact.name.value.clone(), value));
            }
        }
        for entry in &model.case.output.history {
            for quantity in &entry.quantities {
                match choose(model, &standard, &entry.source, quantity) {
                    Ok(one) => {
                        names.push(format!("{}.{}", entry.name.value, quantity.value));
                        chosen.push(one);
                    }
                    Err(one) => found.push(*one),
                }
            }
        }
        if found.has_errors() {
            return Err(found);
        }
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Ok(Self {
            columns: history_columns(&of, &names),
            has_inertia,
            has_heat: of.has_heat,
            breaking,
            conducting,
            contacts: contacts.iter().map(ToString::to_string).collect(),
            references: model.references.iter().map(|r| r.rigid).collect(),
            chosen,
        })
    }

    /// The names of all columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The numbers of a row; the name of the step, in the second column, is not one.
    pub fn row(&self, frame: &Frame, iterations: usize) -> Vec<f64> {
        let mut row = vec![
            frame.time,
            f64::NAN,
            frame.increment as f64,
            iterations as f64,
        ];
        row.extend(self.values(frame));
        row
    }

    fn values(&self, frame: &Frame) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.columns.len());
        for name in &self.contacts {
            let of_name = frame.contacts.iter().filter(|c| c.reported_name() == name);
            values.extend(of_name.map(of_contact).reduce(together).unwrap_or_default());
        }
        for &body in &self.references {
            let rigid = frame.rigid.get(body as usize).copied();
            let rigid = rigid.unwrap_or_default();
            values.extend(of_reference(&rigid));
            if self.has_inertia {
                let moving = [rigid.velocity, rigid.angular_velocity];
                values.extend(moving.map(Vec3::to_array).as_flattened());
            }
        }
        if self.has_inertia {
            values.extend(of_energies(&frame.energies.unwrap_or_default()));
        }
        for name in &self.breaking {
            let mut of_name = frame.contacts.iter().filter(|c| c.name == *name);
            let works = of_name.next().map(|c| [c.work_damage, c.work_viscous]);
            values.extend(works.unwrap_or_default());
        }
        if self.has_heat {
            values.extend(of_heat(&heat::reported(frame)));
        }
        for name in &self.conducting {
            let of_name = frame.contacts.iter().find(|c| c.name == *name);
            let warmth = of_name.and_then(|c| c.warmth.as_ref());
            values.extend(warmth.map_or([0.0; 2], |of| [of.through, of.rubbed]));
        }
        for one in &self.chosen {
            let value = match one {
                Chosen::Copy(column) => values.get(*column).copied().unwrap_or(f64::NAN),
                Chosen::Probe(probe) => probe.value(frame),
                Chosen::Cycles => frame.cycles,
                Chosen::Worn(name, of) => {
                    let contact = frame.contacts.iter().find(|c| c.name == *name);
                    contact.and_then(|c| c.wear.as_ref()).map_or(0.0, of)
                }
            };
            values.push(value);
        }
        values
    }
}

/// Whether anything moves with inertia.
fn has_inertia(model: &Model) -> bool {
    model.steps.iter().any(|step| step.scheme.is_some())
}

/// Whether temperatures are found.
pub(super) fn has_heat(model: &Model) -> bool {
    model.steps.iter().any(|step| step.physics.has_heat())
}

/// The contacts that conduct, or whose friction heats their sides, where temperatures are found.
fn conducting(model: &Model) -> Vec<String> {
    let all = model.case.contacts.iter().filter(|contact| {
        let rubs = contact.friction.is_some() && contact.friction_heat.is_some();
        has_heat(model) && (rubs || !contact.conductance.is_empty())
    });
    all.map(|contact| contact.name.value.clone()).collect()
}

/// The contacts whose joints may break.
fn breaking(model: &Model) -> Vec<String> {
    let all = model.contacts.iter().filter(|c| c.cohesion.is_some());
    all.map(|c| c.name.clone()).collect()
}

/// The contacts that have columns: those of the model, and where pairs are found those that the case asks for, which may
/// begin later. Pairs of one name have one set of columns.
fn contacts(model: &Model) -> Vec<String> {
    let of_model = model.contacts.iter().map(|c| c.reported_name.clone());
    let Some(general) = &model.general else {
        return of_model.collect();
    };
    let asked = model.case.output.history.iter();
    let asked = asked.filter_map(|entry| match &entry.source {
        HistorySource::Contact(name) => Some(name.value.clone()),
        _ => None,
    });
    let expected = model.case.expectations.iter();
    let expected = expected.filter_map(|one| Some(one.what.value.rsplit_once('.')?.0.to_owned()));
    let later = asked
        .chain(expected)
        .filter(|name| general.may_be_called(name));
    let mut all: Vec<String> = Vec::new();
    for name in of_model.chain(later) {
        if !all.contains(&name) {
            all.push(name);
        }
    }
    all
}

/// What two contacts of one name are together.
fn together(
    a: [f64; CONTACT_COLUMNS.len()],
    b: [f64; CONTACT_COLUMNS.len()],
) -> [f64; CONTACT_COLUMNS.len()] {
    let [
        fx,
        fy,
        fz,
        mx,
        my,
        mz,
        pressure,
        gap,
        slip,
        open,
        stick,
        slide,
        x,
        y,
        z,
        work,
    ] = a;
    let [
        gx,
        gy,
        gz,
        nx,
        ny,
        nz,
        other,
        nearest,
        far,
        apart,
        hold,
        move_,
        u,
        v,
        w,
        spent,
    ] = b;
    let weight = |f: [f64; 3]| f.iter().map(|f| f * f).sum::<f64>().sqrt();
    let (of_a, of_b) = (weight([fx, fy, fz]), weight([gx, gy, gz]));
    let part = if of_a + of_b > 0.0 {
        of_b / (of_a + of_b)
    } else {
        0.0
    };
    let mean = |a: f64, b: f64| a + part * (b - a);
    [
        fx + gx,
        fy + gy,
        fz + gz,
        mx + nx,
        my + ny,
        mz + nz,
        pressure.max(other),
        gap.min(nearest),
        slip.max(far),
        open + apart,
        stick + hold,
        slide + move_,
        mean(x, u),
        mean(y, v),
        mean(z, w),
        work + spent,
    ]
}

fn of_contact(c: &ContactFrame) -> [f64; CONTACT_COLUMNS.len()] {
    let Resultant {
        force: f,
        moment: m,
    } = c.reported();
    let p = c.center;
    [
        f.x,
        f.y,
        f.z,
        m.x,
        m.y,
        m.z,
        c.pressure_max,
        c.gap_min,
        c.slip_max,
        c.area_open,
        c.area_stick,
        c.area_slip,
        p.x,
        p.y,
        p.z,
        c.work_friction,
    ]
}

fn of_energies(e: &Energies) -> [f64; ENERGY_COLUMNS.len()] {
    [
        e.kinetic,
        e.internal,
        e.contact,
        e.external,
        e.friction,
        e.damping,
        e.algorithmic(),
    ]
}

fn of_heat(heat: &HeatBalance) -> [f64; HEAT_COLUMNS.len()] {
    let mut values = [0.0; HEAT_COLUMNS.len()];
    let flows = [heat.rate, heat.total].map(|flows| flows.to_array());
    let all = flows.as_flattened().iter().copied();
    let all = all.chain([heat.imbalance()]);
    values
        .iter_mut()
        .zip(all)
        .for_each(|(to, value)| *to = value);
    values
}

fn of_reference(r: &RigidFrame) -> [f64; REFERENCE_COLUMNS.len()] {
    let vectors = [
        r.contact.force,
        r.contact.moment,
        r.displacement,
        r.rotation,
        r.reaction_force,
        r.reaction_moment,
    ];
    let mut values = [0.0; REFERENCE_COLUMNS.len()];
    for (to, of) in values.chunks_exact_mut(3).zip(vectors) {
        to.copy_from_slice(&of.to_array());
    }
    values
}

fn choose(
    model: &Model,
    standard: &[String],
    source: &HistorySource,
    quantity: &Spanned<String>,
) -> Result<Chosen, Box<Diagnostic>> {
    let copy = |owner: &Spanned<String>, known: &[String], columns: &[&'static str]| {
        if !known.contains(&owner.value) {
            return Err(undefined(owner, known));
        }
        let column = format!("{}.{}", owner.value, quantity.value);
        let at = standard.iter().position(|c| *c == column);
        let at = at.and_then(|at| at.checked_sub(HISTORY_COLUMNS.len()));
        at.map(Chosen::Copy)
            .ok_or_else(|| no_quantity(quantity, columns.iter().copied()))
    };
    let names = |of: Vec<&String>| of.into_iter().cloned().collect::<Vec<_>>();
    let probe = |probe: Result<Probe, ProbeError>, owner: &dyn Fn(Diagnostic) -> Diagnostic| {
        probe.map(Chosen::Probe).map_err(|error| match error {
            ProbeError::Quantity { .. } => no_quantity(quantity, quantities()),
            other => Box::new(owner(Diagnostic::error(
                &codes::NOT_IN_MESH,
                other.to_string(),
            ))),
        })
    };
    match source {
        HistorySource::Contact(name) => {
            let known = contacts(model);
            let mut columns = CONTACT_COLUMNS.to_vec();
            if breaking(model).contains(&name.value) {
                columns.extend(COHESION_COLUMNS);
            }
            if conducting(model).contains(&name.value) {
                columns.extend(CONDUCTION_COLUMNS);
            }
            copy(name, &known, &columns)
        }
        HistorySource::Reference(name) => {
            let known = names(model.references.iter().map(|r| &r.name).collect());
            copy(name, &known, &reference_columns(has_inertia(model)))
        }
        HistorySource::Node(label) => probe(
            Probe::at_node(model, &quantity.value, label.value),
            &|one| one.at(&label.place, "no such node"),
        ),
        HistorySource::Set(name) => {
            probe(Probe::on_set(model, &quantity.value, &name.value), &|one| {
                one.at(&name.place, "no nodes in it")
            })
        }
    }
}

fn undefined(name: &Spanned<String>, known: &[String]) -> Box<Diagnostic> {
    let names = || known.iter().map(String::as_str);
    let remark = closest(&name.value, names()).map_or_else(
        || "not defined".into(),
        |n| format!("did you mean \"{n}\"?"),
    );
    Box::new(
        Diagnostic::error(
            &codes::UNDEFINED,
            format!(
                "a history is asked of \"{}\", which is not there",
                name.value
            ),
        )
        .at(&name.place, remark)
        .note(format!("there are: {}", listed(names()))),
    )
}

fn no_quantity<'a>(
    quantity: &Spanned<String>,
    known: impl Iterator<Item = &'a str> + Clone,
) -> Box<Diagnostic> {
    let remark = closest(&quantity.value, known.clone()).map_or_else(
        || "no such quantity".into(),
        |q| format!("did you mean \"{q}\"?"),
    );
    Box::new(
        Diagnostic::error(
            &codes::NOT_A_CHOICE,
            format!("\"{}\" is not a quantity there", quantity.value),
        )
        .at(&quantity.place, remark)
        .note(format!(
            "quantities: {}",
            known.collect::<Vec<_>>().join(", ")
        )),
    )
}
