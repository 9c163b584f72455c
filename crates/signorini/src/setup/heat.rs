//! Heat: what bodies conduct and store, and the steps that solve for temperatures.

use super::names::Names;
use super::orientation::axes;
use crate::setup::bodies;
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::{Mat3, Sym3};
use signorini_io::case::{
    self, Body, Case, Conductivity, Constraint, ConstraintKind, Contact, Material, Step,
};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, codes};
use signorini_mechanics::contact::law::Conductance;
use signorini_mechanics::contact::{ContactHeat, FrictionHeat};
use signorini_mechanics::load::RadiationConstants;
use signorini_mechanics::material::{Conductor, ConductorError};
use signorini_mechanics::model::HeatPart;
use signorini_mechanics::solid::{MaterialAxes, Storage};
use signorini_mechanics::system::{Heat, Physics};

/// What is unknown in a step.
pub(super) fn physics(step: &Step) -> Physics {
    let Some(thermal) = step.thermal else {
        return Physics::default();
    };
    let heat = match thermal.transient {
        true => Heat::Transient,
        false => Heat::Steady,
    };
    Physics {
        moves: thermal.coupled,
        heat,
    }
}

/// The first step that solves for temperatures.
pub(super) fn first(case: &Case) -> Option<&Step> {
    case.steps.iter().find(|step| step.thermal.is_some())
}

/// The constants of radiation.
pub(super) fn radiation(case: &Case) -> Option<RadiationConstants> {
    let constants = case.constants?;
    Some(RadiationConstants {
        stefan_boltzmann: constants.stefan_boltzmann,
        absolute_zero: constants.absolute_zero,
    })
}

/// A cut through a body would insulate its sides from each other.
pub(super) fn refuse_cuts(case: &Case, found: &mut Diagnostics) {
    let is_cut = |one: &&Constraint| matches!(one.kind, ConstraintKind::Pretension { .. });
    let cut = case.constraints.iter().find(is_cut);
    if let Some((cut, step)) = cut.zip(first(case)) {
        let message = "heat through a section with pretension is not built";
        found.push(
            Diagnostic::error(&codes::NOT_BUILT, message)
                .at(&cut.place, "this cuts a body")
                .at(&step.place, "this step solves for temperatures"),
        );
    }
}

/// How a body conducts and stores heat; nothing where no step asks.
pub(super) fn of_body(
    (case, names): (&Case, &Names<'_>),
    (body, cells): (&Body, &[CellId]),
    material: &Material,
    found: &mut Diagnostics,
) -> Option<Box<HeatPart>> {
    let step = first(case);
    let name = bodies::name(body);
    let all_heat = case.steps.iter().all(|step| {
        let thermal = step.thermal;
        thermal.is_some_and(|thermal| !thermal.coupled)
    });
    if material.model.value.is_empty() && !all_heat {
        let message = format!("body \"{name}\" has no law, but a step deforms it");
        found.push(
            Diagnostic::error(&codes::MISSING, message)
                .at(&material.place, "`model` is missing here")
                .help("write  model = \"linear-elastic\", E = , nu = ; or make all steps  kind = \"heat\""),
        );
        return None;
    }
    let step = step?;
    let Some(heat) = &material.heat else {
        let message = format!("body \"{name}\" does not conduct heat");
        found.push(
            Diagnostic::error(&codes::MISSING, message)
                .at(&material.place, "`conductivity` is missing here")
                .at(&step.place, "this step solves for temperatures"),
        );
        return None;
    };
    let density = material
        .density
        .as_ref()
        .map_or(0.0, |density| density.value);
    let conductor = conductor(&heat.conductivity).and_then(|mut one| {
        if !heat.specific_heat.is_empty() {
            one = one.storing(density, heat.specific_heat.clone())?;
        }
        let phases = heat.latent_heat.iter();
        phases
            .copied()
            .try_fold(one, |one, [latent, solidus, liquidus]| {
                one.melting(latent, [solidus, liquidus])
            })
    });
    let conductor = match conductor {
        Ok(conductor) => conductor,
        Err(error) => {
            let message = format!("material \"{}\": {error}", material.name.value);
            found.push(Diagnostic::error(&codes::OUT_OF_RANGE, message).at(&heat.place, ""));
            return None;
        }
    };
    let axes = match conductor.is_isotropic() || body.orientation.is_none() {
        true => Mat3::IDENTITY,
        // those that are faulty are reported by the law
        false => match axes(case, body, names, cells, &mut Diagnostics::new())? {
            MaterialAxes::Uniform(axes) => axes.transpose(),
            _ => {
                let message = format!("body \"{name}\" conducts by direction along axes that vary");
                found.push(
                    Diagnostic::error(&codes::NOT_BUILT, message)
                        .at(&body.place, "axes that are the same everywhere are built")
                        .help("cut the body into parts with axes of their own"),
                );
                return None;
            }
        },
    };
    Some(Box::new(HeatPart {
        conductor,
        axes,
        storage: match body.lumped_capacity {
            true => Storage::Lumped,
            false => Storage::Consistent,
        },
    }))
}

/// How heat goes across a contact; nothing where no step asks.
pub(super) fn of_contact(
    case: &Case,
    contact: &Contact,
    found: &mut Diagnostics,
) -> Option<ContactHeat> {
    first(case)?;
    let mut paths = Vec::new();
    for path in &contact.conductance {
        paths.push(match path {
            case::Conductance::Constant(h) => Conductance::Constant(*h),
            case::Conductance::OverPressure(rows) => Conductance::OverPressure(rows.clone()),
            case::Conductance::OverGap(rows) => Conductance::OverGap(rows.clone()),
            case::Conductance::Power {
                h0,
                hardness,
                exponent,
            } => Conductance::Power {
                h0: *h0,
                hardness: *hardness,
                exponent: *exponent,
            },
            case::Conductance::Gas { conductivity, jump } => Conductance::Gas {
                conductivity: *conductivity,
                jump: *jump,
            },
            case::Conductance::Radiation([one, other]) => {
                let Some(constants) = case.constants else {
                    let message = "radiation without the constants of nature";
                    found.push(
                        Diagnostic::error(&codes::MISSING, message)
                            .at(&contact.place, "this contact radiates")
                            .help("write  [constants] stefan_boltzmann = , absolute_zero = "),
                    );
                    continue;
                };
                let both = one.recip() + other.recip() - 1.0;
                Conductance::Radiation {
                    factor: constants.stefan_boltzmann / both,
                    zero: constants.absolute_zero,
                }
            }
        });
    }
    let friction = contact.friction_heat.filter(|_| contact.friction.is_some());
    Some(ContactHeat {
        paths,
        friction: friction.map(|of| FrictionHeat {
            fraction: of.fraction,
            to_secondary: of.to_secondary,
        }),
        primary: contact.temperature,
        share: 1.0,
    })
}

fn conductor(of: &Conductivity) -> Result<Conductor, ConductorError> {
    let rows = match of {
        Conductivity::Isotropic(rows) => {
            let row = |&[at, k]: &[f64; 2]| (at, Sym3::IDENTITY * k);
            rows.iter().map(row).collect()
        }
        Conductivity::Along([a, b, c]) => vec![(0.0, Sym3::diagonal(*a, *b, *c))],
        Conductivity::Full(rows) => {
            let row = |&[at, a, b, c, ab, bc, ac]: &[f64; 7]| (at, Sym3::new(a, b, c, ab, bc, ac));
            rows.iter().map(row).collect()
        }
    };
    Conductor::new(rows)
}
