use super::course::Clock;
use super::local::{Local, gather};
use super::{Region, Schedule};
use crate::system::{
    Frame, Layout, Lifetime, Order, Part, PatternSink, Phase, Properties, Role, Sink, SpinFrame,
    State, Symmetry, Term, TermError, Work,
};
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::{Mat3, Vec3};
use std::sync::Arc;

/// An axis about which everything turns, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spin {
    /// Angular velocity.
    pub speed: f64,
    /// A point of the axis.
    pub point: Vec3,
    /// Unit vector along the axis.
    pub axis: Vec3,
}

impl Spin {
    /// P
    fn projector(&self) -> Mat3 {
        Mat3::IDENTITY - Mat3::outer(self.axis, self.axis)
    }
}

/// Centrifugal forces about an axis that stays where it is, (E5): at the present positions, in a step of small
/// displacements at those of the start.
pub struct Centrifugal {
    name: Arc<str>,
    /// What it acts on, sorted.
    acts_on: Arc<[CellId]>,
    /// The densities are its factors.
    cells: Region,
    spin: Spin,
    clock: Clock,
    layout: Layout,
    reference: Arc<[Vec3]>,
    chunks: Vec<(usize, usize, usize)>,
}

/// Scratch of one thread.
#[derive(Default)]
struct Scratch {
    local: Local,
    reference: Vec<Vec3>,
}

impl Centrifugal {
    /// Forces on cells whose densities are the factors of the region, and the factor of the squared speed over time.
    #[must_use]
    pub fn new(
        name: &str,
        (cells, spin): (Region, Spin),
        acts_on: &[CellId],
        schedule: Schedule,
        layout: Layout,
        reference: Arc<[Vec3]>,
    ) -> Self {
        Self {
            name: name.into(),
            acts_on: sorted(acts_on),
            spin,
            clock: Clock::new(schedule),
            layout,
            reference,
            chunks: cells.chunks(),
            cells,
        }
    }

    /// ω²
    fn square(&self, time: f64) -> f64 {
        self.spin.speed * self.spin.speed * self.clock.factor(time)
    }

    /// Hands every cell of a chunk to `take`, with `½ ∫ρω² |P(x − c)|² dV`; none where nothing turns.
    fn each(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        mut take: impl FnMut(&Local, f64),
    ) {
        let square = self.square(trial.time);
        let Some(&(patch, first, last)) = self.chunks.get(chunk).filter(|_| square != 0.0) else {
            return;
        };
        let patch = &self.cells.patches()[patch];
        let moves = self.clock.nonlinear();
        let places = if moves { &trial.x[..] } else { &self.reference };
        let projector = self.spin.projector();
        let Scratch { local, reference } = work.of();
        for (nodes, density) in patch.pieces(first, last) {
            gather(&self.reference, nodes, reference);
            local.begin(&self.layout, nodes, places, order);
            let mut half = 0.0;
            for sample in patch.samples() {
                let weight = square * density * patch.volume(&sample, reference);
                let arm = projector * (sample.position(&local.x) - self.spin.point);
                half += 0.5 * weight * arm.norm_squared();
                local.push(sample.shape, arm * -weight);
                if order == Order::Residual || !moves {
                    continue;
                }
                for (j, shape) in sample.shape.iter().enumerate() {
                    local.stiffen(sample.shape, j, projector * (-weight * shape));
                }
            }
            take(local, half);
        }
    }
}

impl Term for Centrifugal {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        Properties {
            lifetime: Lifetime::Increment,
            ..Properties::new(Symmetry::Definite, Part::Bulk).with_role(Role::Load)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for (_, nodes, _) in self.cells.pieces() {
            out.bulk(nodes);
        }
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        self.clock.begin_step(&phase.step);
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.chunks.len()
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        self.each(chunk, trial, order, work, |local, _| {
            out.add(&local.dofs, &local.force, &local.stiffness);
        });
        Ok(())
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
        let moves = self.clock.nonlinear();
        let mut total = 0.0;
        self.each(chunk, trial, Order::Residual, work, |local, half| {
            total += if moves { -half } else { local.work(&trial.u) };
        });
        Ok(Some(total))
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        frame.spins.push(SpinFrame {
            name: self.name.clone(),
            cells: self.acts_on.clone(),
            square: self.square(state.time),
        });
        Ok(())
    }
}

fn sorted(cells: &[CellId]) -> Arc<[CellId]> {
    let mut cells = cells.to_vec();
    cells.sort_unstable();
    cells.into()
}
