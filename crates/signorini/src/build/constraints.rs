//! Springs, and constraints between displacements.

use super::carriers::Carriers;
use super::names::Names;
use super::quoted;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::{
    self, Case, ConstraintKind, Directions, Name, Spring, SpringEnds, Summand,
};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use signorini_mechanics::model::{ConstraintKind as Kind, ConstraintPart, SpringPart, Unknown};

/// The springs of a case.
pub(super) fn springs(case: &Case, names: &Names<'_>, found: &mut Diagnostics) -> Vec<SpringPart> {
    let one = |spring: &Spring| {
        Some(SpringPart {
            name: spring.name.value.clone(),
            ends: ends(spring, names, found)?,
            stiffness: spring.stiffness,
            direction: spring
                .direction
                .and_then(|along| Vec3::from(along).normalized()),
        })
    };
    case.springs.iter().filter_map(one).collect()
}

type Ends = Vec<(NodeId, Option<NodeId>)>;

fn ends(spring: &Spring, names: &Names<'_>, found: &mut Diagnostics) -> Option<Ends> {
    let (one, other) = match &spring.ends {
        SpringEnds::Ground(on) => {
            let nodes = names.nodes_in_order(on, found)?;
            return Some(nodes.into_iter().map(|node| (node, None)).collect());
        }
        SpringEnds::Between(one, other) => (one, other),
    };
    let sides = [one, other].map(|name| names.nodes_in_order(name, found));
    let [Some(from), Some(to)] = sides else {
        return None;
    };
    if from.len() != to.len() {
        found.push(unpaired(
            &spring.place,
            [(one, from.len()), (other, to.len())],
        ));
        return None;
    }
    let pairs: Vec<(NodeId, NodeId)> = from.into_iter().zip(to).collect();
    if spring.direction.is_none() {
        let mut alone = pairs.iter().filter(|(a, b)| names.distance(*a, *b) == 0.0);
        if let Some((node, _)) = alone.next() {
            let message = format!(
                "spring {} has no length at node {}, and no `direction`",
                quoted(&spring.name),
                names.label(*node)
            );
            found.push(
                Diagnostic::error(&codes::MISSING, message)
                    .at(&spring.place, "its two ends are at the same place")
                    .help("write  direction = \"x\", \"y\", \"z\" or a vector"),
            );
            return None;
        }
    }
    Some(pairs.into_iter().map(|(a, b)| (a, Some(b))).collect())
}

pub(super) fn unpaired(place: &Place, [one, other]: [(&Name, usize); 2]) -> Diagnostic {
    Diagnostic::error(
        &codes::WRONG_KIND,
        format!(
            "{} has {} nodes and {} has {}: they cannot be paired",
            quoted(one.0),
            one.1,
            quoted(other.0),
            other.1
        ),
    )
    .at(place, "here")
    .help("name two sets of as many nodes, in the same order")
}

/// The constraints of a case.
pub(super) fn constraints(
    case: &Case,
    names: &Names<'_>,
    carriers: &Carriers,
    found: &mut Diagnostics,
) -> Vec<ConstraintPart> {
    let mut parts = Vec::new();
    let ndim = case.model.space.ndim();
    for (number, constraint) in case.constraints.iter().enumerate() {
        let name = name(number, constraint);
        match &constraint.kind {
            ConstraintKind::Equation { terms, rhs } => {
                let place = &constraint.place;
                for terms in equations(terms, place, names, carriers, found) {
                    let kind = Kind::Equation { terms, rhs: *rhs };
                    let name = name.clone();
                    parts.push(ConstraintPart { name, kind });
                }
            }
            kind => {
                let kind = of_nodes(kind, ndim, names, carriers, found);
                parts.extend(kind.map(|kind| ConstraintPart { name, kind }));
            }
        }
    }
    parts
}

/// What a constraint is called in messages: it has no name of its own.
pub(super) fn name(number: usize, constraint: &case::Constraint) -> String {
    let number = number + 1;
    let of = |kind: &str, on: &Name| format!("{number} ({kind} on \"{}\")", on.value);
    match &constraint.kind {
        ConstraintKind::Equation { .. } => format!("{number} (equation)"),
        ConstraintKind::Kinematic { on, .. } => of("kinematic", on),
        ConstraintKind::Distributing { on, .. } => of("distributing", on),
        ConstraintKind::Plane { on } => of("plane", on),
        ConstraintKind::Equal { on, .. } => of("equal", on),
    }
}

/// Directions that a model of this dimension has.
pub(super) fn axes(directions: Directions, ndim: usize) -> [bool; 3] {
    let mut axes = directions.xyz;
    axes.iter_mut().skip(ndim).for_each(|axis| *axis = false);
    axes
}

fn of_nodes(
    kind: &ConstraintKind,
    ndim: usize,
    names: &Names<'_>,
    carriers: &Carriers,
    found: &mut Diagnostics,
) -> Option<Kind> {
    Some(match kind {
        ConstraintKind::Equation { .. } => return None,
        ConstraintKind::Kinematic {
            on,
            reference,
            axes: directions,
        } => Kind::Kinematic {
            nodes: names.nodes(on, found)?,
            carrier: carriers.get(reference)?,
            axes: axes(*directions, ndim),
        },
        ConstraintKind::Distributing { on, reference } => Kind::Distributing {
            nodes: names.weighted(on, found)?,
            carrier: carriers.get(reference)?,
        },
        ConstraintKind::Plane { on } => Kind::Plane {
            nodes: names.nodes(on, found)?,
        },
        ConstraintKind::Equal {
            on,
            axes: directions,
        } => Kind::Equal {
            nodes: names.nodes(on, found)?,
            axes: axes(*directions, ndim),
        },
    })
}

/// The unknowns of a summand: one for each node, or that of a carrier.
fn unknowns(
    term: &Summand,
    names: &Names<'_>,
    carriers: &Carriers,
    found: &mut Diagnostics,
) -> Option<Vec<Unknown>> {
    let component = term.component.value;
    if let Some(carrier) = carriers.get(&term.on) {
        return Some(vec![Unknown::Carrier(carrier, component)]);
    }
    let nodes = names.nodes_in_order(&term.on, found)?;
    if component >= 3 {
        found.push(
            Diagnostic::error(
                &codes::WRONG_KIND,
                format!("the nodes of {} have no rotations", quoted(&term.on)),
            )
            .at(&term.component.place, "a rotation")
            .help("only references and rigid bodies turn"),
        );
        return None;
    }
    let unknown = |node| Unknown::Node(node, component);
    Some(nodes.into_iter().map(unknown).collect())
}

/// One equation for each node of the sets in it; single nodes and references are in all of them.
fn equations(
    terms: &[Summand],
    place: &Place,
    names: &Names<'_>,
    carriers: &Carriers,
    found: &mut Diagnostics,
) -> Vec<Vec<(Unknown, f64)>> {
    let columns = terms
        .iter()
        .map(|term| Some((term, unknowns(term, names, carriers, found)?)));
    let Some(columns) = columns.collect::<Option<Vec<_>>>() else {
        return Vec::new();
    };
    let mut several = columns.iter().filter(|(_, unknowns)| unknowns.len() > 1);
    let count = several.next().map_or(1, |(first, unknowns)| {
        if let Some((other, more)) = several.find(|(_, other)| other.len() != unknowns.len()) {
            let sizes = [(&first.on, unknowns.len()), (&other.on, more.len())];
            found.push(unpaired(place, sizes));
        }
        unknowns.len()
    });
    let row = |k: usize| {
        let term = |(term, unknowns): &(&Summand, Vec<Unknown>)| {
            let unknown = unknowns.get(k).or(unknowns.first())?;
            Some((*unknown, term.coefficient))
        };
        columns.iter().filter_map(term).collect()
    };
    (0..count).map(row).collect()
}
