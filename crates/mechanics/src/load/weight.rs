use super::Schedule;
use super::course::Clock;
use crate::system::{
    Dof, Layout, Order, Part, PatternSink, Phase, Properties, RigidMass, Role, Sink, State,
    Symmetry, Term, TermError, Work,
};
use signorini_geometry::tensor::{Mat3, Vec3};

/// The weight of a rigid body: `m g` at its centroid, whose arm turns with the body.
pub struct Weight {
    name: String,
    layout: Layout,
    body: RigidMass,
    force: Vec3,
    clock: Clock,
}

impl Weight {
    /// The weight of a body: this force.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        layout: Layout,
        body: RigidMass,
        force: Vec3,
        schedule: Schedule,
    ) -> Self {
        Self {
            name: name.into(),
            layout,
            force,
            body,
            clock: Clock::new(schedule),
        }
    }

    fn dofs(&self) -> [Dof; 6] {
        self.layout.of_carrier(self.body.carrier)
    }

    fn turns(&self) -> bool {
        self.body.arm != Vec3::ZERO
    }
}

impl Term for Weight {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        // where a body stands still, what else acts on it balances the moment, and the stiffness is not symmetric
        let symmetry = if self.turns() && self.clock.acts() && self.layout.ndim() == 3 {
            Symmetry::Unsymmetric
        } else {
            Symmetry::Definite
        };
        Properties::new(symmetry, Part::Interface).with_role(Role::Load)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        if self.turns() {
            let [_, _, _, a, b, c] = self.dofs();
            out.interface(&[a, b, c]);
        }
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        self.clock.begin_step(&phase.step);
        Ok(())
    }

    fn nchunk(&self) -> usize {
        1
    }

    fn evaluate(
        &self,
        _: usize,
        trial: &State,
        order: Order,
        _: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let factor = self.clock.factor(trial.time);
        if factor == 0.0 {
            return Ok(());
        }
        let [x, y, z, a, b, c] = self.dofs();
        let force = self.force * factor;
        out.add(&[x, y, z], &(force * -1.0).to_array(), &[]);
        if !self.turns() {
            return Ok(());
        }
        let arm = self.body.rotation(trial) * self.body.arm;
        let moment = arm.cross(force) * -1.0;
        let mut stiffness = [[0.0; 3]; 3];
        if order == Order::Tangent && !trial.is_small {
            let slope = Mat3::skew(force) * Mat3::skew(arm) * -1.0;
            stiffness = slope.rows.map(Vec3::to_array);
        }
        let stiffness: &[f64] = match order {
            Order::Tangent => stiffness.as_flattened(),
            Order::Residual => &[],
        };
        out.add(&[a, b, c], &moment.to_array(), stiffness);
        Ok(())
    }

    fn energy(&self, _: usize, trial: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        let value = |dof: Dof| trial.u.get(dof as usize).copied().unwrap_or(0.0);
        let [x, y, z, a, b, c] = self.dofs().map(value);
        let arm = self.body.arm;
        let turned = match trial.is_small {
            true => Vec3::new(a, b, c).cross(arm),
            false => self.body.rotation(trial) * arm - arm,
        };
        let way = Vec3::new(x, y, z) + turned;
        Ok(Some(-self.clock.factor(trial.time) * self.force.dot(way)))
    }
}
