use super::course::Clock;
use super::local::{Local, gather};
use super::{Domain, Effect, Load, LoadError, LoadProperties, Region, Schedule, Site};
use crate::system::{
    Frame, Layout, Lifetime, Order, Part, PatternSink, Phase, Properties, Role, Sink, SpinFrame,
    State, Symmetry, Term, TermError, Work,
};
use signorini_geometry::mesh::CellId;
use signorini_geometry::tensor::{Mat3, Vec3};
use signorini_vocabulary::{ANY, Default as Absent, Description, Entry, Fault, LINE, VECTOR, key};
use std::sync::Arc;

/// The entry of [`Spin`].
pub(super) const ENTRY: Entry<Arc<dyn Load>> = Entry {
    description: Description::new(
        "centrifugal",
        "forces of a frame that rotates",
        &[
            key("speed", ANY, "angular velocity, in radian per time")
                .required()
                .hints(&["omega"]),
            key("point", VECTOR, "a point of the axis; absent: the origin")
                .or(Absent::Numbers(&[0.0; 3])),
            key(
                "axis",
                LINE,
                "\"x\", \"y\", \"z\" or a vector along the axis",
            )
            .required(),
        ],
    ),
    make: |values| {
        let axis = Vec3::from(values.vector("axis")?).normalized();
        let axis = axis.ok_or_else(|| Fault::Unfit {
            what: LoadError::NoAxis.to_string(),
        })?;
        Ok(Arc::new(Spin {
            speed: values.number("speed")?,
            point: values.vector("point")?.into(),
            axis,
        }))
    },
};

/// An axis about which everything turns, and how fast: mass times centrifugal acceleration about an axis that stays where
/// it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spin {
    /// Angular velocity (radian per time); a course multiplies its square.
    pub speed: f64,
    /// A point of the axis.
    pub point: Vec3,
    /// Along the axis; a unit vector in a [`Centrifugal`].
    pub axis: Vec3,
}

impl Spin {
    /// P
    fn projector(&self) -> Mat3 {
        Mat3::IDENTITY - Mat3::outer(self.axis, self.axis)
    }
}

impl Load for Spin {
    fn properties(&self) -> LoadProperties {
        LoadProperties::new(Domain::Mass, "centrifugal")
    }

    fn following(&self, _: bool) -> Option<Arc<dyn Load>> {
        None
    }

    fn effect(&self, site: Site<'_>) -> Result<Effect, LoadError> {
        let axis = self.axis.normalized().ok_or(LoadError::NoAxis)?;
        let revolves = axis.cross(Vec3::unit(1)) == Vec3::ZERO && self.point.x == 0.0;
        if site.revolved && !revolves {
            return Err(LoadError::OtherAxis);
        }
        if self.speed == 0.0 {
            return Ok(Effect::forces([]));
        }
        let what = (site.region, Self { axis, ..*self });
        let reference = site.reference.clone();
        let term = Centrifugal::new(
            site.name,
            what,
            site.cells,
            site.schedule,
            site.layout,
            reference,
        );
        Ok(Effect::Term(Box::new(term)))
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
        for piece in patch.pieces(first, last) {
            gather(&self.reference, piece.nodes, reference);
            local.begin(&self.layout, piece.nodes, places, order);
            let mut half = 0.0;
            for sample in patch.samples() {
                let weight = square * patch.volume(&piece, &sample, reference);
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
        if self.clock.is_away() {
            return;
        }
        for (_, piece) in self.cells.pieces() {
            out.bulk(piece.nodes);
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
