//! Contacts, and their changes in a step.

use super::constraints::unpaired;
use super::heat;
use super::names::Names;
use super::nonlinear::nonlinear;
use super::surfaces::Surfaces;
use super::{own, quoted};
use crate::own::Own;
use crate::text::short;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{
    self, Area, Augmentation, Case, Contact, Enforcement, Friction, Normals, Offset, Pairs, Per,
    Sliding, Stick,
};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, Severity, codes};
use signorini_mechanics::contact::cohesion::{Initiation, Mixity};
use signorini_mechanics::contact::discretization::{SlidingRange, mortar};
use signorini_mechanics::contact::friction;
use signorini_mechanics::contact::law::{self, ContactLaw, Damping};
use signorini_mechanics::contact::mortar::Basis;
use signorini_mechanics::contact::{Critical, Measure};
use signorini_mechanics::model::{
    self, AreaPart, CohesionPart, ContactChange, ContactPart, ContactSummary, FeaturesPart,
    FluidPart, FrictionPart, Method, PrimaryPart, SidePart, SofteningPart, StartPart, StickPart,
    TieOffset, TiePart, WearPart,
};
use signorini_mechanics::system::ReportedAs;
use signorini_vocabulary::Entry;
use std::sync::Arc;

/// The contacts that act in some step. Their places in this list are their numbers.
pub(super) fn acting(case: &Case) -> impl Iterator<Item = &Contact> {
    let begins = |contact: &Contact| {
        let mut changes = case.steps.iter().flat_map(|step| &step.contacts);
        changes.any(|one| one.name == contact.name && one.active == Some(true))
    };
    let contacts = case.contacts.iter();
    contacts.filter(move |contact| contact.active || begins(contact))
}

/// The contacts that act, with their sides.
pub(super) fn contacts(
    case: &Case,
    names: &Names<'_>,
    surfaces: &Surfaces,
    own: &Own,
    found: &mut Diagnostics,
) -> Vec<ContactPart> {
    let contacts = acting(case).filter_map(|one| {
        let part = contact(one, &case.steps, names, surfaces, own, found)?;
        Some(ContactPart {
            smooths: case.output.smooth_pressures,
            heat: heat::of_contact(case, one, found),
            ..part
        })
    });
    contacts.collect()
}

fn contact(
    part: &Contact,
    steps: &[case::Step],
    names: &Names<'_>,
    surfaces: &Surfaces,
    own: &Own,
    found: &mut Diagnostics,
) -> Option<ContactPart> {
    let listed = *part.method == case::Method::NodeToNode && part.pairs == Pairs::Order;
    let (secondary, primary) = if listed {
        in_order(part, names, found)?
    } else {
        let primary = primary(part, names, surfaces, found);
        (names.side(&part.secondary, found)?, primary?)
    };
    if matches!(secondary, SidePart::Nodes(_)) {
        found.append(bare(part));
    }
    Some(ContactPart {
        method: method(part),
        two_pass: part.two_pass,
        area: match part.area {
            Area::Reference => AreaPart::Reference,
            Area::Current => AreaPart::Present,
            Area::Adjacent => AreaPart::Adjacent,
            Area::Opposite => AreaPart::Opposite,
        },
        enforcement: enforcement(part, own, found),
        fluid: fluid(part, names, found),
        measure: match part.per {
            Some(Per::Node) => Some(Measure::Node),
            Some(Per::Area) => Some(Measure::Area),
            None => part.gasket.is_some().then_some(Measure::Area),
        },
        friction: part
            .friction
            .as_ref()
            .and_then(|one| friction(one, (&part.name, &part.place), own, found)),
        damping: Damping {
            normal: part.damping.normal,
            tangential: part.damping.tangential,
            pulls: part.damping.pulls,
        },
        restitution: *part.restitution,
        wear: part.wear.map(|wear| WearPart {
            coefficients: wear.coefficients,
        }),
        sliding: sliding(part, steps),
        remembers_traction: part.remembers_traction,
        features: match part.features {
            case::Features::Auto => None,
            case::Features::Faces => Some(FeaturesPart::Faces),
            case::Features::Edges => Some(FeaturesPart::Edges),
        },
        tie: part.tied.map(|tied| TiePart {
            offset: match tied.offset {
                Offset::Keep => TieOffset::Keep,
                Offset::Close => TieOffset::Close,
                Offset::Pull => TieOffset::Pull,
            },
            within: tied.within,
            penalty_tangential: tied.penalty_tangential,
            cohesion: part.cohesive.as_ref().map(cohesion),
        }),
        start: start(&part.start, names, found),
        reach: part.reach,
        active: part.active,
        reported_as: part.found.as_ref().map(|found| ReportedAs {
            name: found.pair.clone(),
            on_primary: found.is_reversed,
        }),
        ..ContactPart::new(part.name.value.clone(), secondary, primary)
    })
}

fn cohesion(part: &case::Cohesive) -> CohesionPart {
    let (mixity, interpolated) = match part.mixity {
        case::Mixity::Bk(eta) => (Mixity::Interpolated(eta), Initiation::Interpolated(eta)),
        case::Mixity::Power(alpha) => (Mixity::Power(alpha), Initiation::Quadratic),
    };
    CohesionPart {
        strength: part.strength,
        toughness: part.toughness,
        softening: match part.exponential {
            true => SofteningPart::Exponential,
            false => SofteningPart::Bilinear {
                mixity,
                initiation: match part.quadratic {
                    true => Initiation::Quadratic,
                    false => interpolated,
                },
                stiffness: part.stiffness,
            },
        },
        viscosity: part.viscosity,
    }
}

/// How far points slide. Small-strain theory knows one geometry, that of the start: a contact that acts in linear steps
/// alone keeps it. After a step at finite strain, bodies may be far from where they started, and contact follows them.
fn sliding(part: &Contact, steps: &[case::Step]) -> SlidingRange {
    let mut until_last = part
        .acting(steps.iter())
        .zip(nonlinear(steps))
        .collect::<Vec<_>>()
        .into_iter()
        .rev()
        .skip_while(|(acts, _)| !acts)
        .peekable();
    let stays = until_last.peek().is_some() && until_last.all(|(_, nonlinear)| !nonlinear);
    match part.sliding {
        // joined sides do not slide
        Sliding::Auto if stays && part.tied.is_none() => SlidingRange::Small,
        Sliding::Auto | Sliding::Finite => SlidingRange::Finite,
        Sliding::Increment => SlidingRange::Increment,
        Sliding::Small => SlidingRange::Small,
    }
}

fn primary(
    part: &Contact,
    names: &Names<'_>,
    surfaces: &Surfaces,
    found: &mut Diagnostics,
) -> Option<PrimaryPart> {
    if part.is_with_itself() {
        return Some(PrimaryPart::Itself);
    }
    if let Some(surface) = surfaces.get(&part.primary) {
        return surface.map(PrimaryPart::Surface);
    }
    if *part.method != case::Method::NodeToNode {
        let faces = names.faces(&part.primary, "the primary side", found);
        return faces.map(PrimaryPart::Faces);
    }
    names.side(&part.primary, found).map(primary_of)
}

/// Notes on nodes that both sides of a contact have: where two surfaces of one body meet.
pub(super) fn sharing(case: &Case, contacts: &[ContactSummary], names: &Names<'_>) -> Diagnostics {
    let mut found = Diagnostics::new();
    for summary in contacts {
        let Some((&first, others)) = summary.shared.split_first() else {
            continue;
        };
        let more = match others.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let text = format!(
            "contact \"{}\": both sides have node {}{more}, left out of the contact",
            summary.name,
            names.label(first)
        );
        let note = Diagnostic::new(Severity::Note, &codes::NO_EFFECT, text);
        let part = case
            .contacts
            .iter()
            .find(|one| one.name.value == summary.name);
        found.push(match part {
            Some(part) => note.at(&part.secondary.place, "where the two surfaces meet"),
            None => note,
        });
    }
    found
}

fn primary_of(side: SidePart) -> PrimaryPart {
    match side {
        SidePart::Faces(faces) => PrimaryPart::Faces(faces),
        SidePart::Nodes(nodes) => PrimaryPart::Nodes(nodes),
    }
}

/// The sides of nodes that meet in the order of their lists. The side that gives the normals is one of faces where it
/// has some: its nodes are then in the order of their numbers, and those of the other side follow.
fn in_order(
    part: &Contact,
    names: &Names<'_>,
    found: &mut Diagnostics,
) -> Option<(SidePart, PrimaryPart)> {
    let secondary = names.nodes_in_order(&part.secondary, found);
    let primary = names.nodes_in_order(&part.primary, found);
    let (secondary, primary) = (secondary?, primary?);
    if secondary.len() != primary.len() {
        let sides = [
            (&part.secondary, secondary.len()),
            (&part.primary, primary.len()),
        ];
        found.push(unpaired(&part.place, sides));
        return None;
    }
    let faces = match part.normals {
        Normals::Primary => names.covering(&part.primary, &primary),
        Normals::Secondary => names.covering(&part.secondary, &secondary),
        Normals::Given(_) | Normals::Nodal => None,
    };
    let mut pairs: Vec<(NodeId, NodeId)> = secondary.into_iter().zip(primary).collect();
    match (part.normals, &faces) {
        (_, None) => {}
        (Normals::Secondary, _) => pairs.sort_unstable_by_key(|pair| pair.0),
        (_, Some(_)) => pairs.sort_unstable_by_key(|pair| pair.1),
    }
    let (secondary, primary) = pairs.into_iter().unzip();
    Some(match (part.normals, faces) {
        (Normals::Secondary, Some(faces)) => (SidePart::Faces(faces), PrimaryPart::Nodes(primary)),
        (_, Some(faces)) => (SidePart::Nodes(secondary), PrimaryPart::Faces(faces)),
        (_, None) => (SidePart::Nodes(secondary), PrimaryPart::Nodes(primary)),
    })
}

/// What bare nodes as the secondary side cannot do.
fn bare(part: &Contact) -> Diagnostics {
    let needs = [
        (
            part.per == Some(Per::Area) && !matches!(part.area, Area::Adjacent | Area::Opposite),
            "a penalty per area",
            "write  per = \"node\"  in `enforcement`,  area = \"adjacent\", or name a surface",
        ),
        (
            part.area == Area::Current,
            "area \"current\"",
            "write  area = \"adjacent\", or name a surface",
        ),
        (
            *part.method == case::Method::GaussPoint,
            "method \"gauss-point\"",
            "write  method = \"node-to-segment\", or name a surface",
        ),
        (
            *part.method == case::Method::Mortar,
            "method \"mortar\"",
            "write  method = \"node-to-segment\", or name a surface",
        ),
        (
            part.two_pass,
            "`passes` = 2",
            "write  passes = 1, or name a surface",
        ),
        (
            part.is_with_itself(),
            "contact of a surface with itself",
            "name a surface, or the other side as `primary`",
        ),
    ];
    let mut found = Diagnostics::new();
    for (_, what, help) in needs.into_iter().filter(|(wrong, ..)| *wrong) {
        let message = format!(
            "contact {}: {} is bare nodes, {what} needs faces",
            quoted(&part.name),
            quoted(&part.secondary)
        );
        let message = Diagnostic::error(&codes::WRONG_KIND, message);
        found.push(
            message
                .at(&part.secondary.place, "no whole face of a solid")
                .help(help),
        );
    }
    found
}

fn method(part: &Contact) -> Method {
    match *part.method {
        case::Method::Auto => Method::Auto,
        case::Method::NodeToSegment => Method::NodeToSegment,
        case::Method::Mortar => Method::Mortar(mortar::Form {
            normals: match part.normals {
                Normals::Nodal => mortar::Normals::Nodal,
                Normals::Secondary => mortar::Normals::Facet,
                _ => mortar::Normals::Turning,
            },
            basis: match part.basis {
                case::Basis::Part => Basis::Part,
                case::Basis::Whole => Basis::Whole,
            },
            ..mortar::Form::default()
        }),
        case::Method::NodeToNode => Method::NodeToNode {
            normals: match part.normals {
                Normals::Primary | Normals::Nodal => model::Normals::Primary,
                Normals::Secondary => model::Normals::Secondary,
                Normals::Given(vector) => model::Normals::Given(Vec3::from(vector)),
            },
            pairs: match part.pairs {
                Pairs::Nearest => model::PairOrder::Nearest,
                Pairs::Order => model::PairOrder::Listed,
            },
        },
        case::Method::GaussPoint => Method::GaussPoint(model::PointRule {
            kind: match part.rule.kind {
                case::PointKind::Gauss => model::PointKind::Gauss,
                case::PointKind::Lobatto => model::PointKind::Lobatto,
            },
            points: part.rule.points.map(|points| points as usize),
            cut: part.rule.cut,
        }),
    }
}

/// What a case calls the method in use.
pub(super) fn word(method: &Method) -> &'static str {
    match method {
        Method::NodeToNode { .. } => "node-to-node",
        Method::GaussPoint(_) => "gauss-point",
        Method::Mortar(_) => "mortar",
        Method::Auto | Method::NodeToSegment => "node-to-segment",
    }
}

/// What a penalty refers to.
pub(super) const fn per(measure: Measure) -> &'static str {
    match measure {
        Measure::Area => "area",
        Measure::Node => "node",
    }
}

/// How a contact prevents penetration.
pub(super) fn words(summary: &ContactSummary) -> String {
    let scale = short(summary.penalty);
    let per = per(summary.measure);
    match summary.enforcement {
        model::Enforcement::Auto | model::Enforcement::Penalty(_) => {
            format!("penalty {scale} per {per}")
        }
        model::Enforcement::Law(ref law) => format!("pressures of the law \"{}\"", law.name()),
        model::Enforcement::Gasket(_) => "a gasket".to_owned(),
        model::Enforcement::Lagrange => "multipliers".to_owned(),
        model::Enforcement::Uzawa(_) | model::Enforcement::AugmentedNewton(_) => {
            format!("augmented Lagrangian with {scale} per {per}")
        }
    }
}

/// How far its points slide, in words.
pub(super) fn range(summary: &ContactSummary, tied: bool) -> &'static str {
    match (&summary.method, summary.sliding) {
        _ if summary.cohesion.is_some() => "joined until it breaks",
        _ if tied => "joined",
        (Method::NodeToNode { .. }, _) => "pairs that stay",
        (_, SlidingRange::Finite) => "finite sliding",
        (_, SlidingRange::Increment) => "planes of the increment",
        (_, SlidingRange::Small) => "small sliding",
    }
}

/// Writes how far points slide into a contact that leaves it open; pairs of nodes do not.
pub(super) fn choose_sliding(part: &mut Contact, summary: &ContactSummary) {
    if part.sliding == Sliding::Auto && !matches!(summary.method, Method::NodeToNode { .. }) {
        part.sliding = match summary.sliding {
            SlidingRange::Small => Sliding::Small,
            SlidingRange::Increment => Sliding::Increment,
            SlidingRange::Finite => Sliding::Finite,
        };
    }
}

/// Writes the method in use into a contact that leaves it open.
pub(super) fn choose(part: &mut Contact, method: &Method) {
    part.method.value = match method {
        Method::NodeToNode { .. } => case::Method::NodeToNode,
        Method::GaussPoint(_) => case::Method::GaussPoint,
        Method::Mortar(_) => case::Method::Mortar,
        Method::Auto | Method::NodeToSegment => case::Method::NodeToSegment,
    };
}

fn enforcement(part: &Contact, own: &Own, found: &mut Diagnostics) -> model::Enforcement {
    let by_law = |law: Result<Arc<dyn ContactLaw>, String>, found: &mut Diagnostics| match law {
        Ok(law) => model::Enforcement::Law(law),
        Err(fault) => {
            found.push(unfit(&part.name, &part.place, &fault));
            model::Enforcement::Auto
        }
    };
    if let Some(gasket) = &part.gasket {
        let curve = |one: &case::Unloading| (one.from, one.curve.clone());
        let unloading = gasket.unloading.iter().map(curve).collect();
        let law = law::Gasket::new(
            gasket.loading.clone(),
            unloading,
            gasket.onset,
            gasket.tension,
        );
        return match law {
            Ok(law) => model::Enforcement::Gasket(Arc::new(law)),
            Err(fault) => {
                found.push(unfit(&part.name, &part.place, &fault.to_string()));
                model::Enforcement::Auto
            }
        };
    }
    match &part.enforcement {
        Enforcement::Auto => model::Enforcement::Auto,
        Enforcement::Penalty(penalty) => {
            model::Enforcement::Penalty(penalty.as_ref().map(|one| one.value))
        }
        Enforcement::Table(rows) => {
            let law = law::Table::new(rows.clone()).map(|law| Arc::new(law) as _);
            by_law(law.map_err(|fault| fault.to_string()), found)
        }
        Enforcement::Law(chosen) => {
            if let Some(name) = own::name(chosen) {
                let law = own.laws.get(name).map(Arc::clone);
                return law.map_or(model::Enforcement::Auto, model::Enforcement::Law);
            }
            let law = Entry::make(&law::TABLE, chosen);
            by_law(law.map_err(|fault| fault.to_string()), found)
        }
        Enforcement::Lagrange => model::Enforcement::Lagrange,
        Enforcement::Augmented { by, penalty } => {
            let penalty = penalty.as_ref().map(|one| one.value);
            match by {
                Augmentation::Uzawa => model::Enforcement::Uzawa(penalty),
                Augmentation::Newton => model::Enforcement::AugmentedNewton(penalty),
            }
        }
    }
}

/// Friction; none where its values make no law, which is reported.
fn friction(
    part: &Friction,
    (contact, place): (&case::Name, &Place),
    own: &Own,
    found: &mut Diagnostics,
) -> Option<FrictionPart> {
    let limit = match own::name(&part.limit) {
        Some(name) => Arc::clone(own.frictions.get(name)?),
        None => match Entry::make(&friction::TABLE, &part.limit) {
            Ok(limit) => limit,
            Err(fault) => {
                found.push(unfit(contact, place, &fault.to_string()));
                return None;
            }
        },
    };
    Some(FrictionPart {
        limit,
        stick: part.stick.map(|stick| match stick {
            Stick::Stiffness(stiffness) => StickPart::Stiffness(stiffness),
            Stick::Slip(slip) => StickPart::Slip(slip),
        }),
    })
}

fn fluid(part: &Contact, names: &Names<'_>, found: &mut Diagnostics) -> Option<FluidPart> {
    let of = part.fluid.as_ref()?;
    Some(FluidPart {
        pressure: of.pressure,
        seeds: names.nodes(&of.from, found)?,
        critical: of.critical.map_or(Critical::Fluid, Critical::Pressure),
        ramp: of.ramp,
        recedes: of.recedes,
    })
}

/// Values that make no law.
fn unfit(contact: &case::Name, place: &Place, fault: &str) -> Diagnostic {
    let message = format!("contact {}: {fault}", quoted(contact));
    Diagnostic::error(&codes::CONTRADICTION, message)
        .at(place, "this contact")
        .help("correct the values of its law")
}

fn start(part: &case::Start, names: &Names<'_>, found: &mut Diagnostics) -> StartPart {
    let of = part.close_gaps_of.as_ref();
    StartPart {
        close_below: part.close_gaps_below,
        close_nodes: of.and_then(|of| names.nodes(of, found)).unwrap_or_default(),
        clearance: part.clearance,
        interference: match part.interference {
            case::Interference::Step => model::Interference::Ramped,
            case::Interference::Increment => model::Interference::Increment,
            case::Interference::Increments => model::Interference::Increments,
            case::Interference::Now => model::Interference::AtOnce,
            case::Interference::StrainFree => model::Interference::StrainFree,
        },
        bends: !part.straight_facets,
    }
}

/// What steps make of contacts, one step after the other.
pub(super) struct Changes<'a> {
    /// The contacts that act at some time, as they are now.
    contacts: Vec<(&'a Contact, bool, Option<&'a Friction>, Option<f64>)>,
    /// What the program brings.
    own: &'a Own,
}

impl<'a> Changes<'a> {
    pub fn new(case: &'a Case, own: &'a Own) -> Self {
        let now = |contact: &'a Contact| {
            let fluid = contact.fluid.as_ref().map(|fluid| fluid.pressure);
            (contact, contact.active, contact.friction.as_ref(), fluid)
        };
        Self {
            contacts: acting(case).map(now).collect(),
            own,
        }
    }

    /// The changes of the next step.
    pub fn of(&mut self, step: &'a case::Step, found: &mut Diagnostics) -> Vec<ContactChange> {
        let mut changes = Vec::new();
        for change in &step.contacts {
            let mut contacts = self.contacts.iter_mut().enumerate();
            let of_name = contacts.find(|(_, (contact, ..))| contact.name == change.name);
            let Some((number, (contact, active, sliding, fluid))) = of_name else {
                found.push(without_effect(step, change, "it acts in no step"));
                continue;
            };
            if change.fluid.is_some() && contact.fluid.is_none() {
                found.push(without_effect(step, change, "it has no `fluid`"));
                continue;
            }
            let before = (*active, *sliding, *fluid);
            *active = change.active.unwrap_or(*active);
            if let Some(changed) = &change.friction {
                *sliding = changed.as_ref();
            }
            *fluid = change.fluid.or(*fluid);
            let slip = change.slip.filter(|_| contact.wear.is_some());
            if (*active, *sliding, *fluid) == before && slip.is_none() {
                found.push(without_effect(step, change, "all of it was so before"));
                continue;
            }
            changes.push(ContactChange {
                contact: number,
                active: change.active,
                fluid: change.fluid,
                slip,
                friction: change.friction.as_ref().map(|changed| {
                    let changed = changed.as_ref();
                    let contact = (&change.name, &change.place);
                    changed.and_then(|one| friction(one, contact, self.own, found))
                }),
            });
        }
        changes
    }
}

fn without_effect(step: &case::Step, change: &case::ContactChange, remark: &str) -> Diagnostic {
    Diagnostic::new(
        Severity::Note,
        &codes::NO_EFFECT,
        format!(
            "step {} changes nothing of contact {}",
            quoted(&step.name),
            quoted(&change.name)
        ),
    )
    .at(&change.place, remark)
}
