//! Springs, and constraints between displacements.

use super::carriers::Carriers;
use super::cuts::Cuts;
use super::names::Names;
use super::quoted;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};
use signorini_io::case::{
    self, AxesSystem, Case, ConstraintKind, Directions, Name, Spring, SpringEnds, Summand,
};
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Place, codes};
use signorini_mechanics::connector::SpringLaw;
use signorini_mechanics::model::{ConstraintKind as Kind, ConstraintPart, SpringPart, Unknown};

/// The springs of a case.
pub(super) fn springs(case: &Case, names: &Names<'_>, found: &mut Diagnostics) -> Vec<SpringPart> {
    let one = |spring: &Spring| {
        Some(SpringPart {
            name: spring.name.value.clone(),
            ends: ends(spring, names, found)?,
            law: law(&spring.law),
            direction: spring
                .direction
                .and_then(|along| Vec3::from(along).normalized()),
        })
    };
    case.springs.iter().filter_map(one).collect()
}

fn law(law: &case::SpringLaw) -> SpringLaw {
    match law {
        case::SpringLaw::Linear(stiffness) => SpringLaw::Linear(*stiffness),
        case::SpringLaw::Table(rows) => SpringLaw::Table(rows.clone()),
    }
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
    cuts: &Cuts,
    found: &mut Diagnostics,
) -> Vec<ConstraintPart> {
    let mut parts = Vec::new();
    let ndim = case.model.space.ndim();
    for (number, constraint) in case.constraints.iter().enumerate() {
        let name = name(number, constraint);
        let place = &constraint.place;
        let (equations, rhs) = match &constraint.kind {
            ConstraintKind::Equation { terms, rhs } => {
                (equations(terms, place, names, carriers, found), *rhs)
            }
            ConstraintKind::Pretension { reference, .. } => {
                let carrier = carriers.get(reference);
                let cut = carrier.map(|carrier| cuts.equations(number, carrier, ndim));
                (cut.unwrap_or_default(), 0.0)
            }
            ConstraintKind::Cyclic { .. } => {
                let sector = Sector::new(&constraint.kind, names, found);
                let turned = sector.and_then(|sector| sector.equations(ndim, names, place, found));
                (turned.unwrap_or_default(), 0.0)
            }
            kind => {
                let kind = of_nodes(kind, ndim, names, carriers, found);
                parts.extend(kind.map(|kind| ConstraintPart { name, kind }));
                continue;
            }
        };
        let part = |terms| ConstraintPart {
            name: name.clone(),
            kind: Kind::Equation { terms, rhs },
        };
        parts.extend(equations.into_iter().map(part));
    }
    parts
}

/// The two sides of a sector: nodes of one move as those of the other do, turned (E1).
///
/// ```text
///   u(R X) = R u(X),     R a rotation about the axis by ± 2π / sectors
/// ```
struct Sector<'a> {
    on: &'a Name,
    follow: Vec<NodeId>,
    with: &'a Name,
    lead: Vec<NodeId>,
    sectors: u64,
    point: Vec3,
    axis: Vec3,
}

/// Part of the size of a side by which a node may miss the one it moves with.
const APART: f64 = 1e-3;

impl<'a> Sector<'a> {
    fn new(kind: &'a ConstraintKind, names: &Names<'_>, found: &mut Diagnostics) -> Option<Self> {
        let ConstraintKind::Cyclic {
            on,
            with,
            sectors,
            point,
            axis,
        } = kind
        else {
            return None;
        };
        Some(Self {
            on,
            follow: names.nodes(on, found)?,
            with,
            lead: names.nodes(with, found)?,
            sectors: *sectors,
            point: Vec3::from(*point),
            axis: Vec3::from(*axis).normalized()?,
        })
    }

    fn turn(&self, sense: f64) -> Mat3 {
        Mat3::rotation(self.axis * (sense * std::f64::consts::TAU / self.sectors as f64))
    }

    /// The nodes with those that they follow, and the distance by which each misses it, as things turn in a sense.
    fn pairs(&self, sense: f64, names: &Names<'_>) -> Vec<(NodeId, NodeId, f64)> {
        let turn = self.turn(sense);
        let place = |node: NodeId| names.place(node).unwrap_or_default() - self.point;
        let mut turned: Vec<(Vec3, NodeId)> = self
            .lead
            .iter()
            .map(|&node| (turn * place(node), node))
            .collect();
        // along the axis first: few nodes are as high as another
        let height = |x: Vec3| x.dot(self.axis);
        turned.sort_by(|a, b| height(a.0).total_cmp(&height(b.0)));
        let nearest = |node: NodeId| {
            let x = place(node);
            let from = turned.partition_point(|(y, _)| height(*y) < height(x));
            let mut best = (f64::INFINITY, None);
            let mut look = |(y, lead): &(Vec3, NodeId)| {
                let far = (height(*y) - height(x)).abs() > best.0;
                let distance = (*y - x).norm();
                if distance < best.0 {
                    best = (distance, Some(*lead));
                }
                !far
            };
            let (below, above) = turned.split_at(from);
            let _ = below.iter().rev().all(&mut look);
            let _ = above.iter().all(&mut look);
            Some((node, best.1?, best.0))
        };
        let nodes = self.follow.iter().copied();
        nodes.filter_map(nearest).collect()
    }

    fn equations(
        &self,
        ndim: usize,
        names: &Names<'_>,
        place: &Place,
        found: &mut Diagnostics,
    ) -> Option<Vec<Vec<(Unknown, f64)>>> {
        let worst = |pairs: &[(NodeId, NodeId, f64)]| pairs.iter().fold(0.0f64, |m, p| m.max(p.2));
        let both = [1.0, -1.0].map(|sense| (sense, self.pairs(sense, names)));
        let [one, other] = both;
        let (sense, pairs) = if worst(&one.1) <= worst(&other.1) {
            one
        } else {
            other
        };
        let points = self.lead.iter().filter_map(|&node| names.place(node));
        let arms = points.map(|x| (x - self.point).norm());
        let allowed = APART * arms.fold(0.0, f64::max);
        if let Some((node, _, distance)) = pairs.iter().find(|pair| pair.2 > allowed) {
            let message = format!(
                "node {} of {} is {distance:.3e} away from all of {}, turned by a sector of {}",
                names.label(*node),
                quoted(self.on),
                quoted(self.with),
                self.sectors
            );
            found.push(
                Diagnostic::error(&codes::BAD_CONSTRAINT, message)
                    .at(place, "its sides do not match")
                    .help("mesh both sides of the sector alike; look at `axis`, `point` and `sectors`"),
            );
            return None;
        }
        let turn = self.turn(sense);
        let row = |(node, lead): (NodeId, NodeId), axis: usize| {
            let led = (0..ndim).map(|k| (Unknown::Node(lead, k), -turn.rows[axis][k]));
            let led = led.filter(|(_, c)| c.abs() > f64::EPSILON);
            std::iter::once((Unknown::Node(node, axis), 1.0))
                .chain(led)
                .collect()
        };
        let rows = pairs
            .iter()
            .flat_map(|&(node, lead, _)| (0..ndim).map(move |axis| row((node, lead), axis)));
        Some(rows.collect())
    }
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
        ConstraintKind::Line { on } => of("line", on),
        ConstraintKind::Distance { on, .. } => of("distance", on),
        ConstraintKind::Twist { on, .. } => of("twist", on),
        ConstraintKind::Pretension { on, .. } => of("pretension", on),
        ConstraintKind::Cyclic { on, .. } => of("cyclic", on),
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
        ConstraintKind::Equation { .. }
        | ConstraintKind::Pretension { .. }
        | ConstraintKind::Cyclic { .. } => return None,
        ConstraintKind::Line { on } => Kind::Line {
            nodes: names.nodes(on, found)?,
        },
        ConstraintKind::Distance { on, most } => Kind::Distance {
            nodes: two(on, names, found)?,
            most: *most,
        },
        ConstraintKind::Twist {
            on,
            reference,
            axis,
        } => Kind::Twist {
            nodes: names.nodes(on, found)?,
            axis: Vec3::from(*axis),
            carrier: carriers.get(reference)?,
        },
        ConstraintKind::Kinematic {
            on,
            reference,
            axes: directions,
            local,
        } => {
            let (nodes, carrier) = (names.nodes(on, found)?, carriers.get(reference)?);
            let axes = axes(*directions, ndim);
            match local.filter(|_| axes.iter().take(ndim).any(|follows| !follows)) {
                Some(system) => Kind::KinematicAlong {
                    nodes: along(&nodes, &system, axes, (on, names), found)?,
                    carrier,
                },
                None => Kind::Kinematic {
                    nodes,
                    carrier,
                    axes,
                },
            }
        }
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

/// The nodes with the local axes along which they follow, one after the other.
fn along(
    nodes: &[NodeId],
    system: &AxesSystem,
    axes: [bool; 3],
    (on, names): (&Name, &Names<'_>),
    found: &mut Diagnostics,
) -> Option<Vec<(NodeId, Vec3)>> {
    let mut all = Vec::with_capacity(nodes.len());
    for &node in nodes {
        let Some(local) = system.at(names.place(node).unwrap_or_default()) else {
            let message = format!(
                "the axes of the coupling of {} have no direction at node {}",
                quoted(on),
                names.label(node)
            );
            let message = Diagnostic::error(&codes::BAD_CONSTRAINT, message);
            let help = "x and xy must not be parallel, from and to not be one point";
            found.push(message.at(&on.place, "").help(help));
            return None;
        };
        let follows = local.into_iter().zip(axes).filter(|(_, follows)| *follows);
        all.extend(follows.map(|(axis, _)| (node, axis)));
    }
    Some(all)
}

/// The nodes of a set of two.
fn two(on: &Name, names: &Names<'_>, found: &mut Diagnostics) -> Option<[NodeId; 2]> {
    let nodes = names.nodes_in_order(on, found)?;
    let count = nodes.len();
    let pair = <[NodeId; 2]>::try_from(nodes);
    if pair.is_err() {
        let message = format!("{} has {count} nodes", quoted(on));
        let message = Diagnostic::error(&codes::WRONG_KIND, message);
        found.push(message.at(&on.place, "a distance is that of two nodes"));
    }
    pair.ok()
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
