use super::{CHUNK, ConnectorError};
use crate::system::{
    Dof, Layout, Order, Part, PatternSink, Phase, Properties, Sink, State, Symmetry, Term,
    TermError, Work,
};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::{Mat3, Vec3};

/// What springs are made from.
#[derive(Clone, Debug)]
pub struct SpringsParts<'a> {
    /// What they are called in messages.
    pub name: &'a str,
    /// Pairs of ends; the second is `None` where the spring is tied to the ground.
    pub ends: &'a [(NodeId, Option<NodeId>)],
    /// The force of each, by its elongation.
    pub law: &'a SpringLaw,
    /// Fixed direction, of any length; `None`: along the line between the ends.
    pub direction: Option<Vec3>,
    /// Positions of all nodes at the start.
    pub reference: &'a [Vec3],
    /// Which unknown is which.
    pub layout: Layout,
}

/// The force of a spring, by its elongation.
#[derive(Clone, Debug, PartialEq)]
pub enum SpringLaw {
    /// In proportion: force over elongation.
    Linear(f64),
    /// Rows of force and elongation, by increasing elongation and with forces that do not decrease; straight between
    /// them, constant outside.
    Table(Vec<[f64; 2]>),
}

/// Force, slope and energy at an elongation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pull {
    force: f64,
    slope: f64,
    energy: f64,
}

impl SpringLaw {
    /// Whether all of it is finite, and rows are in their order.
    fn is_sound(&self) -> bool {
        match self {
            Self::Linear(stiffness) => stiffness.is_finite(),
            Self::Table(rows) => {
                let rises =
                    |pair: &[[f64; 2]]| matches!(pair, [a, b] if b[0] >= a[0] && b[1] > a[1]);
                let is_finite = |number: &f64| number.is_finite();
                let all_finite = rows.iter().flatten().all(is_finite);
                !rows.is_empty() && all_finite && rows.windows(2).all(rises)
            }
        }
    }

    fn at(&self, elongation: f64) -> Pull {
        match self {
            Self::Linear(stiffness) => Pull {
                force: stiffness * elongation,
                slope: *stiffness,
                energy: 0.5 * stiffness * elongation * elongation,
            },
            Self::Table(rows) => {
                let pull = along(rows, elongation);
                Pull {
                    energy: pull.energy - along(rows, 0.0).energy,
                    ..pull
                }
            }
        }
    }
}

/// What a table says at an elongation; its energy counts from the first row.
fn along(rows: &[[f64; 2]], elongation: f64) -> Pull {
    let Some((&[mut force, mut at], rest)) = rows.split_first() else {
        return Pull::default();
    };
    let mut energy = 0.0;
    if elongation >= at {
        for &[next, to] in rest {
            if elongation < to {
                let slope = (next - force) / (to - at);
                let by = elongation - at;
                return Pull {
                    force: force + slope * by,
                    slope,
                    energy: energy + (force + 0.5 * slope * by) * by,
                };
            }
            energy += 0.5 * (force + next) * (to - at);
            (force, at) = (next, to);
        }
    }
    Pull {
        force,
        slope: 0.0,
        energy: energy + force * (elongation - at),
    }
}

/// Springs of one law (E1).
pub struct Springs {
    name: String,
    layout: Layout,
    law: SpringLaw,
    springs: Vec<Spring>,
    /// Whether directions turn with the ends.
    turns: bool,
    nonlinear: bool,
}

struct Spring {
    ends: (NodeId, Option<NodeId>),
    start: [Vec3; 2],
    /// Unit vector.
    direction: Vec3,
}

/// What a spring does: its pull along a direction, stiffness across it.
struct Response {
    pull: Pull,
    direction: Vec3,
    across: f64,
}

impl Springs {
    /// Springs between nodes.
    ///
    /// # Errors
    /// A direction that is none, an end that is not there, a law that is not finite or not in order.
    pub fn new(parts: SpringsParts<'_>) -> Result<Self, ConnectorError> {
        if !parts.law.is_sound() {
            return Err(ConnectorError::Number {
                what: "the stiffness of a spring",
                positive: false,
            });
        }
        let place = |node: NodeId| parts.reference.get(node as usize).copied();
        let spring = |(k, ends): (usize, &(NodeId, Option<NodeId>))| {
            let none = ConnectorError::NoLength { number: k + 1 };
            let from = place(ends.0).ok_or(none)?;
            let to = match ends.1 {
                Some(node) => place(node).ok_or(none)?,
                None => from,
            };
            let direction = match (parts.direction, ends.1) {
                (Some(direction), _) => direction.normalized().ok_or(none)?,
                (None, Some(_)) => (to - from).normalized().ok_or(none)?,
                (None, None) => return Err(ConnectorError::NoDirection { number: k + 1 }),
            };
            Ok(Spring {
                ends: *ends,
                start: [from, to],
                direction,
            })
        };
        let springs = parts.ends.iter().enumerate().map(spring);
        Ok(Self {
            name: parts.name.to_string(),
            layout: parts.layout,
            law: parts.law.clone(),
            springs: springs.collect::<Result<_, _>>()?,
            turns: parts.direction.is_none(),
            nonlinear: true,
        })
    }

    fn of(&self, chunk: usize) -> impl Iterator<Item = &Spring> {
        self.springs.iter().skip(chunk * CHUNK).take(CHUNK)
    }

    fn dofs(&self, spring: &Spring) -> [Dof; 6] {
        std::array::from_fn(|k| match (k < 3, spring.ends) {
            (true, (node, _)) | (false, (_, Some(node))) => self.layout.node(node, k % 3),
            (false, (_, None)) => crate::system::NO_DOF,
        })
    }

    fn respond(&self, spring: &Spring, trial: &State) -> Result<Response, TermError> {
        let x = |node: NodeId| trial.x.get(node as usize).copied().unwrap_or_default();
        let [from, to] = spring.start;
        let a = x(spring.ends.0);
        let fixed = |moved: Vec3| Response {
            pull: self.law.at(spring.direction.dot(moved)),
            direction: spring.direction,
            across: 0.0,
        };
        let Some(b) = spring.ends.1.map(x) else {
            // the end that moves is the one that pulls
            return Ok(fixed(from - a));
        };
        if !(self.turns && self.nonlinear) {
            return Ok(fixed((b - to) - (a - from)));
        }
        let (line, rest) = (b - a, (to - from).norm());
        let direction = line.normalized().ok_or_else(|| TermError::NotFinite {
            what: format!("the direction of a spring of \"{}\"", self.name),
        })?;
        // l − l_0 without cancellation
        let moved = (b - to) - (a - from);
        let elongation = moved.dot(line + (to - from)) / (line.norm() + rest);
        let pull = self.law.at(elongation);
        Ok(Response {
            pull,
            direction,
            across: pull.force / line.norm(),
        })
    }
}

impl Term for Springs {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        Properties::new(Symmetry::Definite, Part::Interface)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for spring in &self.springs {
            out.interface(&self.dofs(spring));
        }
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        self.nonlinear = phase.step.nonlinear;
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.springs.len().div_ceil(CHUNK)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        for spring in self.of(chunk) {
            let Response {
                pull: Pull { force, slope, .. },
                direction: n,
                across,
            } = self.respond(spring, trial)?;
            let pull = n * force;
            let sign = |k: usize| if k < 3 { -1.0 } else { 1.0 };
            let force: [f64; 6] = std::array::from_fn(|k| sign(k) * pull[k % 3]);
            if order == Order::Residual {
                out.add(&self.dofs(spring), &force, &[]);
                continue;
            }
            let block = Mat3::outer(n, n) * (slope - across) + Mat3::IDENTITY * across;
            let stiffness: [f64; 36] = std::array::from_fn(|k| {
                let (i, j) = (k / 6, k % 6);
                sign(i) * sign(j) * block.rows[i % 3][j % 3]
            });
            out.add(&self.dofs(spring), &force, &stiffness);
        }
        Ok(())
    }

    fn energy(&self, chunk: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        let mut sum = 0.0;
        for spring in self.of(chunk) {
            sum += self.respond(spring, trial)?.pull.energy;
        }
        Ok(Some(sum))
    }
}
