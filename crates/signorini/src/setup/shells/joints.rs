//! Nodes with several directors: where shells of other thickness, offset, orientation or direction meet.
//!
//! Directors that are parallel follow the first one, whose middle is that of the node: with its unknowns `v`, `d` and thickness `t`, and
//! for another one its thickness `t_k`, its sense `s = ±1` and the distance `c_k` of its middle along the normal,
//!
//! ```text
//! d_k = s t_k/t d,   v_k = v + 2 c_k/t d                                                          (E1)
//! ```
//!
//! All others turn with a frame of their node, which has the displacement `w`, and stretch each for itself:
//!
//! ```text
//! d_k = R (1 + a_k) D_k − D_k,   v_k = w + R c_k − c_k                                             (E2)
//! ```

use signorini_geometry::expansion::{Director, Expansion};
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::Vec3;
use signorini_mechanics::model::{CarrierPart, ConstraintKind, ConstraintPart, Unknown};
use std::collections::BTreeMap;

/// The sine of the angle, half a degree, up to which directors count as parallel.
const PARALLEL: f64 = 0.0087;

/// The joints of all shells.
#[derive(Default)]
pub(in crate::setup) struct Joints {
    /// Constraints (E1), and those of (E2) with carriers counted from 0.
    constraints: Vec<ConstraintPart>,
    /// The frames, each followed by the stretches of its directors.
    carriers: Vec<CarrierPart>,
    /// The frame of each node that has one.
    frames: BTreeMap<NodeId, RigidId>,
}

impl Joints {
    /// The joints of an expansion. Nodes that belong to their directors alone go to the middle surface, and from there by half the
    /// thickness vector.
    pub fn new(expansion: &mut Expansion, mesh: &mut Mesh) -> Self {
        let mut joints = Self::default();
        for knot in &expansion.knots {
            let directors = expansion.directors.get_mut(knot.directors.clone());
            let Some([first, others @ ..]) = directors else {
                continue;
            };
            let at = point(mesh, knot.node);
            let name = format!("joint of shells at node {}", label(mesh, knot.node));
            let is_parallel = |one: &Director| one.normal.cross(first.normal).norm() < PARALLEL;
            if others.iter().all(is_parallel) {
                first.middle = knot.node;
                let place = middle(mesh, first);
                for director in others.iter() {
                    let away = (middle(mesh, director) - place).dot(first.normal);
                    joints.follow((first, director), away, &name);
                }
                continue;
            }
            let directors = expansion.directors.get(knot.directors.clone());
            let directors = directors.unwrap_or_default();
            joints.frame(directors, at, name);
            for director in directors {
                let half = at + director.normal * (0.5 * director.thickness);
                let places = [
                    (director.middle, middle(mesh, director)),
                    (director.half, half),
                ];
                for (node, to) in places {
                    if let Some(point) = mesh.points.get_mut(node as usize) {
                        *point = to;
                    }
                }
            }
        }
        joints
    }

    /// (E1).
    fn follow(&mut self, (first, one): (&Director, &Director), away: f64, name: &str) {
        let mut equation = |terms: Vec<(NodeId, f64)>, axis: usize| {
            let terms = terms.into_iter().filter(|(_, factor)| *factor != 0.0);
            let terms = terms.map(|(node, factor)| (Unknown::Node(node, axis), factor));
            self.constraints.push(ConstraintPart {
                name: name.to_owned(),
                kind: ConstraintKind::Equation {
                    terms: terms.collect(),
                    rhs: 0.0,
                },
            });
        };
        let sense = one.normal.dot(first.normal).signum();
        let lever = 2.0 * away / first.thickness;
        let ratio = sense * one.thickness / first.thickness;
        for axis in 0..3 {
            let middle = vec![
                (one.middle, 1.0),
                (first.middle, -1.0),
                (first.half, -lever),
            ];
            equation(middle, axis);
            equation(vec![(one.half, 1.0), (first.half, -ratio)], axis);
        }
    }

    /// (E2).
    fn frame(&mut self, directors: &[Director], at: Vec3, name: String) {
        let Some(node) = directors.first().map(|one| one.node) else {
            return;
        };
        let carrier = self.carriers.len() as RigidId;
        self.frames.insert(node, carrier);
        self.carriers.push(CarrierPart {
            name: name.clone(),
            at: Some(at),
        });
        let mut halves = Vec::with_capacity(directors.len());
        for director in directors {
            halves.push((director.half, self.carriers.len() as RigidId));
            self.carriers.push(CarrierPart {
                name: format!("stretch of the {name}"),
                at: None,
            });
        }
        let middles = directors.iter().map(|one| one.middle);
        let kinematic = ConstraintKind::Kinematic {
            nodes: middles.chain([node]).collect(),
            carrier,
            axes: [true; 3],
        };
        for kind in [kinematic, ConstraintKind::Directors { halves, carrier }] {
            let name = name.clone();
            self.constraints.push(ConstraintPart { name, kind });
        }
    }

    /// The frame of a node, where it has one; `first` is the number of the first carrier of joints.
    pub fn frame_of(&self, node: NodeId, first: usize) -> Option<RigidId> {
        let carrier = self.frames.get(&node)?;
        Some(carrier + first as RigidId)
    }

    /// The carriers.
    pub fn carriers(&self) -> impl Iterator<Item = CarrierPart> + '_ {
        self.carriers.iter().cloned()
    }

    /// The constraints, with carriers from this number on.
    pub fn constraints(&self, first: usize) -> impl Iterator<Item = ConstraintPart> + '_ {
        let first = first as RigidId;
        self.constraints.iter().cloned().map(move |mut one| {
            match &mut one.kind {
                ConstraintKind::Kinematic { carrier, .. } => *carrier += first,
                ConstraintKind::Directors { halves, carrier } => {
                    *carrier += first;
                    halves.iter_mut().for_each(|(_, stretch)| *stretch += first);
                }
                _ => {}
            }
            one
        })
    }
}

fn point(mesh: &Mesh, node: NodeId) -> Vec3 {
    mesh.points.get(node as usize).copied().unwrap_or_default()
}

/// The middle of a director.
fn middle(mesh: &Mesh, one: &Director) -> Vec3 {
    (point(mesh, one.negative) + point(mesh, one.positive)) * 0.5
}

fn label(mesh: &Mesh, node: NodeId) -> u64 {
    mesh.node_labels
        .get(node as usize)
        .copied()
        .unwrap_or_default()
}
