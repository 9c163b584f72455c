//! What becomes rows (E2).

use super::null_space::null_space;
use super::{Held, Motion, NCOMPONENT, Row, Rows};
use crate::model::{
    ConstraintKind, ConstraintPart, ContactPart, Method, Normals, PrimaryPart, SidePart,
    SpringPart, Unknown,
};
use crate::solve::Prescription;
use crate::system::{DofName, FieldId, Layout};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Carrier, ContactSurface, Placement, Pose, RigidId, SurfaceJet};
use signorini_geometry::tensor::Vec3;
use std::collections::BTreeSet;

impl Held<'_> {
    /// What is prescribed.
    pub fn supports(&mut self, layout: &Layout, prescriptions: &[Prescription]) {
        for p in prescriptions {
            let unknown = match layout.name(p.dof).map(DofName::parts) {
                Some((FieldId::DISPLACEMENT, node, axis)) => Unknown::Node(node, axis),
                Some((FieldId::TRANSLATION, body, axis)) => Unknown::Carrier(body, axis),
                Some((FieldId::ROTATION, body, axis)) => Unknown::Carrier(body, 3 + axis),
                _ => continue,
            };
            self.equation(&[(unknown, 1.0)]);
        }
    }

    /// Springs resist relative motion of their ends, along a direction or the line between them.
    pub fn springs(&mut self, springs: &[SpringPart]) {
        for spring in springs {
            for &(a, b) in &spring.ends {
                let line = b.and_then(|b| (self.point(b) - self.point(a)).normalized());
                let Some(direction) = spring.direction.or(line) else {
                    continue;
                };
                let ends = [(Some(a), 1.0), (b, -1.0)];
                let ends = ends.into_iter().filter_map(|(n, k)| Some((n?, k)));
                let row = ends.flat_map(|(node, sign)| {
                    (0..3).map(move |axis| (Unknown::Node(node, axis), sign * direction[axis]))
                });
                self.equation(&row.collect::<Vec<_>>());
            }
        }
    }

    /// Equations and couplings.
    pub fn constraints(&mut self, constraints: &[ConstraintPart]) {
        for constraint in constraints {
            match &constraint.kind {
                ConstraintKind::Equation { terms, .. } => self.equation(terms),
                ConstraintKind::Equal { nodes, axes } => {
                    let pairs = nodes.iter().skip(1).zip(nodes);
                    for (&a, &b) in pairs {
                        for axis in (0..3).filter(|&axis| axes[axis]) {
                            let ends = [(a, 1.0), (b, -1.0)];
                            self.equation(&ends.map(|(n, k)| (Unknown::Node(n, axis), k)));
                        }
                    }
                }
                ConstraintKind::Kinematic {
                    nodes,
                    carrier,
                    axes,
                } => {
                    for &node in nodes {
                        self.follows(node, *carrier, *axes);
                    }
                }
                ConstraintKind::KinematicAlong { nodes, carrier } => {
                    for &(node, along) in nodes {
                        if let Some(unit) = self.unit(node) {
                            self.ties_along(unit, *carrier, node, along);
                        }
                    }
                }
                ConstraintKind::Directors { halves, carrier } => {
                    for &(half, stretch) in halves {
                        self.turns_with(half, *carrier);
                        // what is stretched resists
                        self.equation(&[(Unknown::Carrier(stretch, 0), 1.0)]);
                    }
                }
                ConstraintKind::Distributing { nodes, carrier } => {
                    self.distributing(nodes, *carrier);
                }
                ConstraintKind::Plane { nodes } => self.stays_plane(nodes),
                ConstraintKind::Line { nodes } => self.stays_straight(nodes),
                // a rope holds nothing that goes nearer
                ConstraintKind::Distance { most: Some(_), .. } => {}
                ConstraintKind::Distance { nodes: [a, b], .. } => {
                    let along = self.point(*b) - self.point(*a);
                    let ends = [(*a, -1.0), (*b, 1.0)];
                    let row = ends.iter().flat_map(|&(node, sign)| {
                        (0..3).map(move |axis| (Unknown::Node(node, axis), sign * along[axis]))
                    });
                    self.equation(&row.collect::<Vec<_>>());
                }
                ConstraintKind::Twist {
                    nodes,
                    axis,
                    carrier,
                } => self.twists(nodes, *axis, *carrier),
            }
        }
    }

    /// The two sides cannot approach along the normals of the primary side; where they rub, or are joined, they cannot
    /// part in any direction. What is joined is held, the rest only by contact.
    pub fn contact(&mut self, contact: &ContactPart, rubs: bool, poses: &[Pose]) {
        let of_secondary: BTreeSet<NodeId> = match &contact.secondary {
            SidePart::Nodes(nodes) => nodes.iter().copied().collect(),
            SidePart::Faces(faces) => {
                let nodes = faces.iter().filter_map(|&f| self.mesh.face(f));
                nodes.flat_map(|(_, nodes)| nodes).collect()
            }
        };
        let joined = contact.tie.is_some();
        let every_way = rubs || joined;
        let mut stops: Vec<(usize, Option<usize>, Vec3, Vec3)> = Vec::new();
        match &contact.primary {
            PrimaryPart::Faces(faces) => {
                let units: BTreeSet<usize> =
                    of_secondary.iter().filter_map(|&n| self.unit(n)).collect();
                for &face in faces {
                    let Some((element, mut nodes)) = self.mesh.face(face) else {
                        continue;
                    };
                    nodes.truncate(element.ncorner());
                    let corners: Vec<Vec3> = nodes.iter().map(|&n| self.point(n)).collect();
                    let Some(normal) = normal(&corners) else {
                        continue;
                    };
                    let primary = nodes.first().and_then(|&n| self.unit(n));
                    for &unit in units.iter().filter(|&&u| Some(u) != primary) {
                        stops.extend(corners.iter().map(|&at| (unit, primary, at, normal)));
                    }
                }
            }
            PrimaryPart::Surface(surface) => {
                let at = Placement {
                    x: &self.mesh.points,
                    poses,
                };
                for &node in &of_secondary {
                    let Some(unit) = self.unit(node) else {
                        continue;
                    };
                    let point = self.point(node);
                    let Some((facet, normal)) = nearest(surface.as_ref(), &at, point) else {
                        continue;
                    };
                    let primary = match surface.carrier(facet) {
                        Carrier::Rigid(body) => self.carrier(body),
                        Carrier::Nodes(_) | Carrier::Fixed => None,
                    };
                    stops.push((unit, primary, point, normal));
                }
            }
            PrimaryPart::Nodes(nodes) => {
                let given = match contact.method {
                    Method::NodeToNode {
                        normals: Normals::Given(normal),
                        ..
                    } => normal,
                    _ => Vec3::ZERO,
                };
                for &node in &of_secondary {
                    let others = nodes.iter().map(|&n| self.unit(n));
                    let others: BTreeSet<Option<usize>> = others.collect();
                    let Some(unit) = self.unit(node) else {
                        continue;
                    };
                    let others = others.into_iter().filter(|o| *o != Some(unit));
                    let at = self.point(node);
                    stops.extend(others.map(|other| (unit, other, at, given)));
                }
            }
            PrimaryPart::Itself => {}
        }
        for (unit, primary, at, normal) in stops {
            let axes = [0, 1, 2].map(Vec3::unit);
            let alone = [normal];
            let directions = if every_way { &axes[..] } else { &alone[..] };
            for &direction in directions {
                let mut row = vec![(unit, self.moves(unit, at, direction))];
                row.extend(primary.map(|p| (p, self.moves(p, at, direction * -1.0))));
                if joined {
                    self.rows.push(row);
                } else {
                    self.by_contact.push(row);
                }
            }
        }
    }

    /// Motions that move no node are no motions: a bar that turns about itself.
    pub(super) fn without_effect(&mut self) {
        let mut gram = vec![[[0.0; NCOMPONENT]; NCOMPONENT]; self.first_carrier];
        for (node, part) in (0..).zip(&self.part_of) {
            let Some(unit) = *part else { continue };
            for axis in 0..3 {
                let row = self.moves(unit, self.point(node), Vec3::unit(axis));
                super::add(&mut gram[unit], &outer(&row));
            }
        }
        // bodies of revolution stay where their axis is, and what moves with a carrier does not turn
        let only = |component| std::array::from_fn(|i| f64::from(u8::from(i == component)));
        for (number, unit) in self.units.iter().enumerate() {
            let held = match (self.revolves(unit), unit.carrier.is_some()) {
                (false, _) => &[][..],
                (true, false) => &[0, 5],
                (true, true) => &[5],
            };
            for &component in held {
                super::add(&mut self.rows.own[number], &outer(&only(component)));
            }
        }
        for (own, gram) in self.rows.own.iter_mut().zip(&gram) {
            for vector in null_space(gram.as_flattened().to_vec(), NCOMPONENT) {
                let row = std::array::from_fn(|i| vector.get(i).copied().unwrap_or(0.0));
                super::add(own, &outer(&row));
            }
        }
    }

    /// Nodes of deformable cells that are nodes of a rigid body too.
    pub(super) fn common_nodes(&mut self) {
        for (id, body) in (0..).zip(self.elimination.bodies()) {
            for &node in &body.nodes {
                if let Some(part) = self.part_of.get(node as usize).copied().flatten() {
                    self.ties(part, id, node, [true; 3]);
                }
            }
        }
    }

    fn follows(&mut self, node: NodeId, carrier: RigidId, axes: [bool; 3]) {
        if let Some(unit) = self.unit(node) {
            self.ties(unit, carrier, node, axes);
        }
    }

    fn ties(&mut self, unit: usize, carrier: RigidId, node: NodeId, axes: [bool; 3]) {
        for axis in (0..3).filter(|&axis| axes[axis]) {
            self.ties_along(unit, carrier, node, Vec3::unit(axis));
        }
    }

    fn ties_along(&mut self, unit: usize, carrier: RigidId, node: NodeId, along: Vec3) {
        let Some(other) = self.carrier(carrier) else {
            return;
        };
        let at = self.point(node);
        let row = vec![
            (unit, self.moves(unit, at, along)),
            (other, self.moves(other, at, along * -1.0)),
        ];
        self.rows.push(row);
    }

    /// Half a director turns with a carrier.
    fn turns_with(&mut self, half: NodeId, carrier: RigidId) {
        let (Some(unit), Some(other)) = (self.unit(half), self.carrier(carrier)) else {
            return;
        };
        for axis in (0..3).map(Vec3::unit) {
            let row = vec![
                (unit, self.moves_node(unit, half, axis)),
                (other, self.moves_node(other, half, axis * -1.0)),
            ];
            self.rows.push(row);
        }
    }

    /// The carrier has the mean displacement of the nodes and their mean rotation: `Σ w (u − u_c) = 0` and
    /// `Σ w r × (u − u_c) = 0`, where `u_c` is what the carrier's motion would give the node.
    fn distributing(&mut self, nodes: &[(NodeId, f64)], carrier: RigidId) {
        let Some(carrier) = self.carrier(carrier) else {
            return;
        };
        let total: f64 = nodes.iter().map(|(_, w)| w).sum();
        let at = |n: NodeId| self.point(n);
        let centre: Vec3 = nodes.iter().map(|&(n, w)| at(n) * (w / total)).sum();
        let arms = nodes.iter().map(|&(n, _)| (at(n) - centre).norm());
        let size = arms.fold(0.0, f64::max);
        let mut rows: [Row; NCOMPONENT] = Default::default();
        for &(node, weight) in nodes {
            let (Some(unit), x) = (self.unit(node), at(node)) else {
                continue;
            };
            let share = weight / total;
            for (component, row) in rows.iter_mut().enumerate() {
                let axis = Vec3::unit(component % 3);
                let along = match component {
                    0..3 => axis * share,
                    // axis · (r × u) = u · (axis × r)
                    _ if size > 0.0 => axis.cross(x - centre) * (share / size),
                    _ => continue,
                };
                gather(row, unit, self.moves(unit, x, along));
                gather(row, carrier, self.moves(carrier, x, along * -1.0));
            }
        }
        rows.into_iter().for_each(|row| self.rows.push(row));
    }

    /// Each node keeps its place, along the normal, in the plane of three of them.
    /// Nodes on a line through two of them do not go across it.
    fn stays_straight(&mut self, nodes: &[NodeId]) {
        let Some(&first) = nodes.first() else { return };
        let origin = self.point(first);
        let farthest = nodes.iter().copied().max_by(|&a, &b| {
            let [a, b] = [a, b].map(|node| (self.point(node) - origin).norm());
            a.total_cmp(&b)
        });
        let Some(last) = farthest else { return };
        let along = self.point(last) - origin;
        let squared = along.norm_squared();
        if squared == 0.0 {
            return;
        }
        for &node in nodes {
            let s = (self.point(node) - origin).dot(along) / squared;
            for axis in 0..3 {
                // displacement along an axis, less its part along the line
                let across = Vec3::unit(axis) - along * (along[axis] / squared);
                let ends = [(node, 1.0), (first, s - 1.0), (last, -s)];
                let row = ends.iter().flat_map(|&(node, factor)| {
                    (0..3).map(move |k| (Unknown::Node(node, k), factor * across[k]))
                });
                self.equation(&row.collect::<Vec<_>>());
            }
        }
    }

    /// The angle of a carrier is that by which nodes turn in the mean.
    fn twists(&mut self, nodes: &[NodeId], axis: Vec3, carrier: RigidId) {
        let count = nodes.len().max(1) as f64;
        let middle = nodes.iter().map(|&n| self.point(n)).sum::<Vec3>() / count;
        let arms = nodes.iter().map(|&node| {
            let arm = axis.cross(self.point(node) - middle);
            (
                node,
                arm * (1.0 / arm.norm_squared().max(f64::MIN_POSITIVE)),
            )
        });
        let arms: Vec<(NodeId, Vec3)> = arms.collect();
        let mean = arms.iter().map(|(_, slope)| *slope).sum::<Vec3>() / count;
        let mut row: Vec<(Unknown, f64)> = Vec::new();
        for (node, slope) in arms {
            row.extend((0..3).map(|k| (Unknown::Node(node, k), (slope - mean)[k])));
        }
        row.push((Unknown::Carrier(carrier, 0), -count));
        self.equation(&row);
    }

    fn stays_plane(&mut self, nodes: &[NodeId]) {
        let Some(&first) = nodes.first() else { return };
        let farthest = |score: &dyn Fn(Vec3) -> f64| {
            let nodes = nodes.iter().copied();
            nodes.max_by(|&a, &b| score(self.point(a)).total_cmp(&score(self.point(b))))
        };
        let origin = self.point(first);
        let Some(second) = farthest(&|x| (x - origin).norm()) else {
            return;
        };
        let along = self.point(second) - origin;
        let third = match self.space.ndim() {
            3 => farthest(&|x| along.cross(x - origin).norm()),
            _ => None,
        };
        let across = third.map_or(Vec3::unit(2), |n| self.point(n) - origin);
        let normal = along.cross(across);
        let squared = normal.norm_squared();
        if squared == 0.0 {
            return;
        }
        let unit = normal * (1.0 / squared.sqrt());
        for &node in nodes {
            let arm = self.point(node) - origin;
            let s = arm.cross(across).dot(normal) / squared;
            let t = third.map_or(0.0, |_| along.cross(arm).dot(normal) / squared);
            let corners = [
                (Some(node), 1.0),
                (Some(first), s + t - 1.0),
                (Some(second), -s),
                (third, -t),
            ];
            let mut row = Row::new();
            for (corner, factor) in corners {
                let Some(corner) = corner else { continue };
                let Some(of) = self.unit(corner) else {
                    continue;
                };
                gather(
                    &mut row,
                    of,
                    self.moves(of, self.point(corner), unit * factor),
                );
            }
            self.rows.push(row);
        }
    }

    /// A linear equation between unknowns; one that speaks of a node without body says nothing.
    fn equation(&mut self, terms: &[(Unknown, f64)]) {
        let mut row = Row::new();
        for &(unknown, coefficient) in terms {
            let found = match unknown {
                Unknown::Node(node, axis) => self.unit(node).map(|unit| {
                    let along = Vec3::unit(axis) * coefficient;
                    (unit, self.moves_node(unit, node, along))
                }),
                Unknown::Carrier(id, component) => self.carrier(id).map(|unit| {
                    let mut motion = [0.0; NCOMPONENT];
                    if let Some(value) = motion.get_mut(component) {
                        let turns = component >= 3;
                        let scale = if turns { self.units[unit].length } else { 1.0 };
                        *value = coefficient / scale;
                    }
                    (unit, motion)
                }),
            };
            match found {
                Some((unit, motion)) => gather(&mut row, unit, motion),
                None => return,
            }
        }
        // an equation says the same at any scale
        let sizes = row.iter().flat_map(|(_, motion)| motion.map(f64::abs));
        let largest = sizes.fold(0.0, f64::max);
        if largest > 0.0 {
            let values = row.iter_mut().flat_map(|(_, motion)| motion);
            values.for_each(|value| *value /= largest);
            self.rows.push(row);
        }
    }

    /// The unit that a node moves with.
    fn unit(&self, node: NodeId) -> Option<usize> {
        let carrier = self.elimination.body_of(node);
        carrier
            .and_then(|id| self.carrier(id))
            .or_else(|| self.part_of.get(node as usize).copied().flatten())
    }

    fn carrier(&self, id: RigidId) -> Option<usize> {
        let unit = self.first_carrier + id as usize;
        (unit < self.units.len()).then_some(unit)
    }

    fn point(&self, node: NodeId) -> Vec3 {
        let point = self.mesh.points.get(node as usize);
        point.copied().unwrap_or_default()
    }

    /// Coefficients of `along · u` of a node; half a director turns with its unit, `d = θ × D`.
    fn moves_node(&self, unit: usize, node: NodeId, along: Vec3) -> Motion {
        let Some(director) = self.elimination.directors().with_half(node) else {
            return self.moves(unit, self.point(node), along);
        };
        let [low, high] = director.ends.map(|end| self.point(end));
        let length = self.units.get(unit).map_or(1.0, |unit| unit.length);
        let turn = ((high - low) * 0.5).cross(along) * (1.0 / length);
        [0.0, 0.0, 0.0, turn.x, turn.y, turn.z]
    }

    /// Coefficients of `along · u(x)` (E1).
    fn moves(&self, unit: usize, x: Vec3, along: Vec3) -> Motion {
        let Some(unit) = self.units.get(unit) else {
            return [0.0; NCOMPONENT];
        };
        // along · (θ × r) = θ · (r × along)
        let turn = (x - unit.centre).cross(along) * (1.0 / unit.length);
        [along.x, along.y, along.z, turn.x, turn.y, turn.z]
    }
}

impl Rows {
    fn push(&mut self, row: Row) {
        match row.as_slice() {
            [] => {}
            [(unit, motion)] => {
                if let Some(own) = self.own.get_mut(*unit) {
                    super::add(own, &outer(motion));
                }
            }
            _ => self.shared.push(row),
        }
    }
}

/// Adds to the coefficients of a unit, which stand once in a row.
fn gather(row: &mut Row, unit: usize, motion: Motion) {
    match row.iter_mut().find(|(u, _)| *u == unit) {
        Some((_, there)) => there.iter_mut().zip(motion).for_each(|(a, b)| *a += b),
        None => row.push((unit, motion)),
    }
}

fn outer(a: &Motion) -> [Motion; NCOMPONENT] {
    a.map(|x| a.map(|y| x * y))
}

/// Normal of a face, from its corners.
fn normal(corners: &[Vec3]) -> Option<Vec3> {
    let normal = match *corners {
        [a, b] => (b - a).cross(Vec3::unit(2)),
        [a, b, c] => (b - a).cross(c - a),
        [a, b, c, d, ..] => (c - a).cross(d - b),
        _ => return None,
    };
    normal.normalized()
}

/// The facet of a surface that is nearest to a point, and its normal there.
fn nearest(surface: &dyn ContactSurface, at: &Placement, point: Vec3) -> Option<(u32, Vec3)> {
    let mut jet = SurfaceJet::default();
    let mut best: Option<(f64, u32, Vec3)> = None;
    for facet in 0..surface.nfacet() as u32 {
        let found = surface.project(at, facet, point, None, &mut jet).ok()?;
        let Some(found) = found else { continue };
        if best.is_none_or(|(distance, ..)| found.distance < distance) {
            best = Some((found.distance, facet, jet.normal));
        }
    }
    best.map(|(_, facet, normal)| (facet, normal))
}
