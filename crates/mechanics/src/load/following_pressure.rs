use super::course::Clock;
use super::local::Local;
use super::{Region, Schedule};
use crate::system::{
    Idealisation, Layout, Lifetime, Order, Part, PatternSink, Phase, Properties, Role, Sink, State,
    Symmetry, Term, TermError, Work,
};
use signorini_geometry::tensor::{Mat3, Vec3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Pressure that follows area and normal of the deformed faces, (E3) and (E4). In a step of small displacements it acts
/// on the faces as they are at the start.
pub struct FollowingPressure {
    name: String,
    faces: Region,
    pressure: f64,
    clock: Clock,
    layout: Layout,
    reference: Arc<[Vec3]>,
    chunks: Vec<(usize, usize, usize)>,
}

impl FollowingPressure {
    /// A pressure on faces, at full size and positive in compression, and its factor over time.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        (faces, pressure): (Region, f64),
        schedule: Schedule,
        layout: Layout,
        reference: Arc<[Vec3]>,
    ) -> Self {
        Self {
            name: name.into(),
            pressure,
            clock: Clock::new(schedule),
            layout,
            reference,
            chunks: faces.chunks(),
            faces,
        }
    }

    /// Whether it follows in this step, or is dead or absent.
    fn follows(&self) -> bool {
        self.clock.nonlinear() && self.clock.acts()
    }

    /// Hands every face of a chunk to `take`; none where there is no pressure.
    fn each(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        local: &mut Local,
        mut take: impl FnMut(&Local),
    ) {
        let pressure = self.pressure * self.clock.factor(trial.time);
        let Some(&(patch, first, last)) = self.chunks.get(chunk).filter(|_| pressure != 0.0) else {
            return;
        };
        let patch = &self.faces.patches()[patch];
        let follows = self.clock.nonlinear();
        let places = if follows {
            &trial.x[..]
        } else {
            &self.reference
        };
        for piece in patch.pieces(first, last) {
            local.begin(&self.layout, piece.nodes, places, order);
            for sample in patch.samples() {
                let (t1, t2) = sample.tangents(patch.space(), &local.x);
                let weight = pressure * sample.weight_in(&piece);
                local.push(sample.shape, t1.cross(t2) * weight);
                if order == Order::Residual || !follows {
                    continue;
                }
                for (j, (shape, dshape)) in sample.shape.iter().zip(sample.dshape).enumerate() {
                    let turned = turned(patch.space(), t1, t2, *shape, *dshape);
                    local.stiffen(sample.shape, j, turned * weight);
                }
            }
            take(local);
        }
    }
}

impl Term for FollowingPressure {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        let (symmetry, lifetime) = if self.follows() {
            (Symmetry::Unsymmetric, Lifetime::State)
        } else {
            (Symmetry::Definite, Lifetime::Step)
        };
        Properties {
            lifetime,
            ..Properties::new(symmetry, Part::Bulk).with_role(Role::Load)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        if self.clock.is_away() {
            return;
        }
        for (_, piece) in self.faces.pieces() {
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
        self.each(chunk, trial, order, work.of(), |local| {
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
        if self.follows() {
            return Ok(None);
        }
        let mut total = 0.0;
        self.each(chunk, trial, Order::Residual, work.of(), |local| {
            total += local.work(&trial.u);
        });
        Ok(Some(total))
    }
}

/// ∂(t1 × t2)/∂u_J (E4)
fn turned(space: Idealisation, t1: Vec3, t2: Vec3, shape: f64, dshape: Vec3) -> Mat3 {
    let first = Mat3::skew(t2) * -dshape.x;
    match space {
        Idealisation::Space => first + Mat3::skew(t1) * dshape.y,
        Idealisation::Axisymmetric => {
            let across = t1.cross(Vec3::unit(2)) * (TAU * shape);
            first + Mat3::outer(across, Vec3::unit(0))
        }
        Idealisation::PlaneStrain { .. } | Idealisation::PlaneStress { .. } => first,
    }
}
