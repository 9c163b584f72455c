use super::{CHUNK, ConnectorError, ROUNDING, value};
use crate::system::{
    Dof, Idealisation, Layout, NO_DOF, Order, Part, PatternSink, Phase, Properties, Role, Sink,
    State, Symmetry, Term, TermError, Work,
};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;
use signorini_geometry::tensor::{Mat3, Vec3};

/// What a distributing coupling is made from.
#[derive(Clone, Debug)]
pub struct DistributingParts<'a> {
    /// What it is called in messages.
    pub name: &'a str,
    /// Nodes with positive weights.
    pub nodes: &'a [(NodeId, f64)],
    /// What follows them.
    pub carrier: RigidId,
    /// Where that is at the start.
    pub at: Vec3,
    /// Positions of all nodes at the start.
    pub reference: &'a [Vec3],
    /// Which unknown is which.
    pub layout: Layout,
    /// Space, plane or axisymmetry: there the carrier follows along the axis only.
    pub space: Idealisation,
    /// Its first multiplier.
    pub first: usize,
}

/// A carrier that follows the mean motion of nodes (E3).
pub struct Distributing {
    name: String,
    layout: Layout,
    carrier: RigidId,
    arms: Vec<Arm>,
    /// ā
    mean: Vec3,
    /// ℓ
    size: f64,
    /// Multipliers of the three mean displacements, then of the three rotations.
    multipliers: [Dof; 6],
    nonlinear: bool,
}

struct Arm {
    node: NodeId,
    weight: f64,
    /// X_i, b_i
    start: Vec3,
    arm: Vec3,
}

/// Weighted nodes count as lying on a line where their smallest moment of inertia is below this part of the mean.
const NARROW: f64 = 1e-9;

/// Where everything is.
struct Placed {
    rotation: Mat3,
    /// R ā
    mean: Vec3,
    /// M = Σ w (R b) ⊗ y
    moment: Mat3,
    /// c + R ā − (c_0 + ā), the carrier's part of g_t
    middle: Vec3,
    /// The rotation vector at small strain.
    theta: Vec3,
    /// λ_t, λ_r
    multiplier: [Vec3; 2],
}

impl Distributing {
    /// The number of multipliers.
    #[must_use]
    pub const fn nmultiplier(space: Idealisation) -> usize {
        match space {
            Idealisation::Space => 6,
            Idealisation::Axisymmetric => 1,
            _ => 3,
        }
    }

    /// A coupling.
    ///
    /// # Errors
    /// A weight that is not positive; nodes that carry no moment because they lie on a line or in one point.
    pub fn new(parts: DistributingParts<'_>) -> Result<Self, ConnectorError> {
        let total: f64 = parts.nodes.iter().map(|n| n.1).sum();
        let positive = |w: f64| w > 0.0 && w.is_finite();
        if !positive(total) || !parts.nodes.iter().all(|n| positive(n.1)) {
            return Err(ConnectorError::Number {
                what: "a weight",
                positive: true,
            });
        }
        let place = |&(node, weight): &(NodeId, f64)| {
            let start = parts.reference.get(node as usize).copied();
            Arm {
                node,
                weight: weight / total,
                start: start.unwrap_or_default(),
                arm: Vec3::ZERO,
            }
        };
        let mut arms: Vec<Arm> = parts.nodes.iter().map(place).collect();
        let middle: Vec3 = arms.iter().map(|a| a.start * a.weight).sum();
        for arm in &mut arms {
            arm.arm = arm.start - middle;
        }
        let size = arms
            .iter()
            .map(|a| a.weight * a.arm.norm_squared())
            .sum::<f64>();
        let layout = parts.layout;
        let mut next = parts.first;
        let mut number = |used: bool| {
            if !used {
                return NO_DOF;
            }
            next += 1;
            layout.multiplier(next - 1)
        };
        let axial = parts.space == Idealisation::Axisymmetric;
        let multipliers = std::array::from_fn(|k| match (axial, k) {
            (true, _) => number(k == 1),
            (false, 0..3) => number(k < layout.ndim()),
            (false, _) => number(layout.ndim() == 3 || k == 5),
        });
        let coupling = Self {
            name: parts.name.to_string(),
            layout,
            carrier: parts.carrier,
            mean: middle - parts.at,
            arms,
            size: if size > 0.0 { size.sqrt() } else { 1.0 },
            multipliers,
            nonlinear: true,
        };
        if !axial {
            coupling.check(size)?;
        }
        Ok(coupling)
    }

    /// Whether the nodes carry moments about all axes.
    fn check(&self, size: f64) -> Result<(), ConnectorError> {
        let extent = self
            .arms
            .iter()
            .fold(0.0f64, |m, a| m.max(a.start.max_abs()));
        let point = size <= (NARROW * extent).powi(2);
        let inertia = Mat3::IDENTITY * size - self.spread(Mat3::IDENTITY, |a| a.arm);
        let line =
            self.layout.ndim() == 3 && inertia.determinant() <= NARROW * (size * 2.0 / 3.0).powi(3);
        if point || line {
            return Err(ConnectorError::Narrow {
                point,
                what: "they carry no moment",
            });
        }
        Ok(())
    }

    /// Σ w (R b) ⊗ y
    fn spread(&self, rotation: Mat3, y: impl Fn(&Arm) -> Vec3) -> Mat3 {
        let mut sum = Mat3::ZERO;
        for arm in &self.arms {
            sum = sum + Mat3::outer(rotation * arm.arm, y(arm)) * arm.weight;
        }
        sum
    }

    fn read(&self, trial: &State, dof: impl Fn(usize) -> Dof) -> Vec3 {
        Vec3::new(
            value(trial, dof(0)),
            value(trial, dof(1)),
            value(trial, dof(2)),
        )
    }

    fn place(&self, trial: &State) -> Placed {
        let layout = &self.layout;
        let multiplier = [0, 3].map(|first| self.read(trial, |k| self.multipliers[first + k]));
        let x = |a: &Arm| trial.x.get(a.node as usize).copied().unwrap_or(a.start);
        let center = self.read(trial, |k| layout.translation(self.carrier, k));
        let pose = trial.poses.get(self.carrier as usize);
        let rotation = pose.map_or(Mat3::IDENTITY, |p| p.rotation);
        if !self.nonlinear {
            let theta = self.read(trial, |k| layout.rotation(self.carrier, k));
            let moment = self.spread(Mat3::IDENTITY, |a| a.arm);
            return Placed {
                rotation: Mat3::IDENTITY,
                mean: self.mean,
                moment,
                middle: center + theta.cross(self.mean),
                theta,
                multiplier,
            };
        }
        let mean = rotation * self.mean;
        // X̄ − c_0 = ā: positions themselves do not enter
        let middle = center + (mean - self.mean);
        let moment = self.spread(rotation, |a| (x(a) - a.start) - middle + a.arm);
        Placed {
            rotation,
            mean,
            moment,
            middle,
            theta: Vec3::ZERO,
            multiplier,
        }
    }

    fn trace(&self, m: Mat3) -> f64 {
        (0..3).map(|k| m.rows[k][k]).sum()
    }

    /// Translation, rotation, multipliers.
    fn carrier_dofs(&self) -> [Dof; 12] {
        std::array::from_fn(|k| match k {
            0..6 => self.layout.carrier_motion(self.carrier, k),
            _ => self.multipliers[k - 6],
        })
    }

    /// Node, rotation, multipliers.
    fn node_dofs(&self, arm: &Arm) -> [Dof; 12] {
        std::array::from_fn(|k| match k {
            0..3 => self.layout.node(arm.node, k),
            3..6 => self.layout.rotation(self.carrier, k - 3),
            _ => self.multipliers[k - 6],
        })
    }

    /// What the carrier and the multipliers feel.
    fn add_carrier(&self, p: &Placed, order: Order, out: &mut dyn Sink) {
        let (per, [lt, lr]) = (self.size.recip(), p.multiplier);
        let trace = Mat3::IDENTITY * self.trace(p.moment);
        let arm = (p.moment - trace) * per;
        let moment = p.mean.cross(lt) + arm.transpose() * lr;
        let force: [f64; 12] =
            std::array::from_fn(|k| [lt, moment, p.middle, Vec3::ZERO][k / 3][k % 3]);
        if order == Order::Residual {
            out.add(&self.carrier_dofs(), &force, &[]);
            return;
        }
        let mut blocks = Blocks::default();
        blocks.put(2, 0, Mat3::IDENTITY);
        blocks.put(2, 1, Mat3::skew(p.mean) * -1.0);
        blocks.put(3, 1, arm);
        if self.nonlinear {
            let turning = p.moment.transpose() * Mat3::skew(lr) - Mat3::outer(lr, axial(p.moment));
            let lever = Mat3::skew(lt) * Mat3::skew(p.mean);
            blocks.set(1, 1, lever + turning * per);
        }
        out.add(&self.carrier_dofs(), &force, &blocks.values);
    }

    /// What a node and the multipliers feel of each other.
    fn add_node(&self, arm: &Arm, p: &Placed, trial: &State, order: Order, out: &mut dyn Sink) {
        let (share, [lt, lr]) = (arm.weight / self.size, p.multiplier);
        let b = p.rotation * arm.arm;
        let pull = lr.cross(b) * share - lt * arm.weight;
        let x = trial.x.get(arm.node as usize).copied().unwrap_or(arm.start);
        let moved = x - arm.start;
        let twist = if self.nonlinear {
            b.cross(moved - p.middle + arm.arm)
        } else {
            // without the term of the mean, whose sum vanishes
            b.cross(moved - p.theta.cross(b))
        };
        let parts = [pull, Vec3::ZERO, moved * -arm.weight, twist * share];
        let force: [f64; 12] = std::array::from_fn(|k| parts[k / 3][k % 3]);
        let size = (x.max_abs() + arm.arm.max_abs()) * f64::EPSILON;
        out.uncertain(&self.multipliers, ROUNDING * arm.weight * size);
        if order == Order::Residual {
            out.add(&self.node_dofs(arm), &force, &[]);
            return;
        }
        let mut blocks = Blocks::default();
        blocks.put(2, 0, Mat3::IDENTITY * -arm.weight);
        blocks.put(3, 0, Mat3::skew(b) * share);
        if self.nonlinear {
            let turning = Mat3::IDENTITY * lr.dot(b) - Mat3::outer(lr, b);
            blocks.put(1, 0, turning * share);
        }
        out.add(&self.node_dofs(arm), &force, &blocks.values);
    }
}

/// The vector of `2 skw M`: Σ w b × y.
fn axial(m: Mat3) -> Vec3 {
    let r = m.rows;
    Vec3::new(r[1].z - r[2].y, r[2].x - r[0].z, r[0].y - r[1].x)
}

/// A stiffness of 4 by 4 blocks.
struct Blocks {
    values: [f64; 144],
}

impl Default for Blocks {
    fn default() -> Self {
        Self { values: [0.0; 144] }
    }
}

impl Blocks {
    fn set(&mut self, row: usize, column: usize, block: Mat3) {
        for i in 0..3 {
            for j in 0..3 {
                self.values[(3 * row + i) * 12 + 3 * column + j] = block.rows[i][j];
            }
        }
    }

    /// A block and its transpose on the other side.
    fn put(&mut self, row: usize, column: usize, block: Mat3) {
        self.set(row, column, block);
        self.set(column, row, block.transpose());
    }
}

impl Term for Distributing {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        Properties::new(Symmetry::Symmetric, Part::Interface).with_role(Role::Support)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        out.interface(&self.carrier_dofs());
        for arm in &self.arms {
            out.interface(&self.node_dofs(arm));
        }
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        self.nonlinear = phase.step.nonlinear;
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.arms.len().div_ceil(CHUNK)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let placed = self.place(trial);
        if chunk == 0 {
            self.add_carrier(&placed, order, out);
        }
        for arm in self.arms.iter().skip(chunk * CHUNK).take(CHUNK) {
            self.add_node(arm, &placed, trial, order, out);
        }
        Ok(())
    }

    fn energy(&self, _: usize, _: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        Ok(None)
    }
}
