use super::course::Clock;
use super::local::gather;
use super::{Region, Schedule};
use crate::system::{
    Dof, Idealisation, Layout, LocalHeat, Order, Part, PatternSink, Phase, Properties, Role, Sink,
    State, Symmetry, Term, TermError, Work,
};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use std::f64::consts::TAU;
use std::sync::Arc;

/// What flows through a surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Through {
    /// Heat per time and area inwards.
    Flux(f64),
    /// Outwards h(T) (T − sink): rows of temperature and h.
    Film { table: Vec<[f64; 2]>, sink: f64 },
    /// Outwards ε σ ((T − zero)⁴ − (sink − zero)⁴), with the factor ε σ.
    Radiation { factor: f64, sink: f64, zero: f64 },
}

/// Heat through faces, (E9) and (E10): their present areas where bodies deform, else those at the start.
pub(super) struct Exchange {
    name: String,
    faces: Region,
    through: Through,
    clock: Clock,
    layout: Layout,
    reference: Arc<[Vec3]>,
    chunks: Vec<(usize, usize, usize)>,
    /// Whether bodies deform in the present step, and temperatures are unknown.
    deforms: bool,
    is_solved: bool,
}

/// Scratch of one thread.
#[derive(Default)]
struct Scratch {
    x: Vec<Vec3>,
    now: Vec<f64>,
    heat: LocalHeat,
}

impl Exchange {
    /// Of these faces, with its factor over time.
    pub fn new(
        name: impl Into<String>,
        (faces, through): (Region, Through),
        schedule: Schedule,
        layout: Layout,
        reference: Arc<[Vec3]>,
    ) -> Self {
        Self {
            name: name.into(),
            through,
            clock: Clock::new(schedule),
            layout,
            reference,
            chunks: faces.chunks(),
            faces,
            deforms: false,
            is_solved: false,
        }
    }

    fn begin_piece(&self, nodes: &[NodeId], trial: &State, order: Order, s: &mut Scratch) {
        let places = match self.deforms {
            true => &trial.x[..],
            false => &self.reference,
        };
        gather(places, nodes, &mut s.x);
        s.heat.begin(&self.layout, nodes);
        s.heat.clear(order, self.deforms);
        let value = |&dof: &Dof| trial.u.get(dof as usize).copied().unwrap_or_default();
        s.now.clear();
        s.now.extend(s.heat.dofs.iter().map(value));
    }
}

/// How the directed area `t1 × t2` of a point changes in size with the displacement of a node, (E10).
fn stretched(
    space: Idealisation,
    (t1, t2): (Vec3, Vec3),
    normal: Vec3,
    shape: f64,
    dshape: Vec3,
) -> Vec3 {
    let first = t2.cross(normal) * dshape.x;
    match space {
        Idealisation::Space => first + normal.cross(t1) * dshape.y,
        Idealisation::Axisymmetric => {
            let across = normal.dot(t1.cross(Vec3::unit(2))) * TAU * shape;
            first + Vec3::unit(0) * across
        }
        Idealisation::PlaneStrain { .. } | Idealisation::PlaneStress { .. } => first,
    }
}

impl Term for Exchange {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        let is_plain = matches!(&self.through, Through::Flux(_))
            || matches!(&self.through, Through::Film { table, .. } if table.len() == 1);
        let symmetry = match self.deforms || !is_plain {
            true => Symmetry::Unsymmetric,
            false => Symmetry::Definite,
        };
        Properties::new(symmetry, Part::Interface).with_role(Role::Load)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        if self.clock.is_away() || !self.is_solved {
            return;
        }
        let mut heat = LocalHeat::default();
        for (_, piece) in self.faces.pieces() {
            heat.begin(&self.layout, piece.nodes);
            heat.announce(self.deforms, out);
        }
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        self.clock.begin_step(&phase.step);
        let physics = phase.step.physics;
        self.is_solved = physics.has_heat();
        self.deforms = physics.moves && phase.step.nonlinear;
        Ok(())
    }

    fn nchunk(&self) -> usize {
        match self.is_solved {
            true => self.chunks.len(),
            false => 0,
        }
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let factor = self.clock.factor(trial.time);
        let Some(&(patch, first, last)) = self.chunks.get(chunk).filter(|_| factor != 0.0) else {
            return Ok(());
        };
        let Some(patch) = self.faces.patches().get(patch) else {
            return Ok(());
        };
        let s = work.of::<Scratch>();
        for piece in patch.pieces(first, last) {
            self.begin_piece(piece.nodes, trial, order, s);
            let heat = &mut s.heat;
            let n = heat.dofs.len();
            for sample in patch.samples() {
                let tangents = sample.tangents(patch.space(), &s.x);
                let directed = tangents.0.cross(tangents.1);
                let area = directed.norm();
                let weight = factor * sample.weight_in(&piece);
                let shape = sample.shape;
                let temperature: f64 = shape.iter().zip(&s.now).map(|(n, t)| n * t).sum();
                let [flux, slope] = self.through.at(temperature);
                for (to, n) in heat.flow.iter_mut().zip(shape) {
                    *to += weight * area * flux * n;
                }
                let rows = heat.stiffness.chunks_exact_mut(n.max(1)).zip(shape);
                for (row, own) in rows {
                    let own = weight * area * slope * own;
                    row.iter_mut().zip(shape).for_each(|(to, n)| *to += own * n);
                }
                let Some(normal) = directed.normalized().filter(|_| !heat.coupling.is_empty())
                else {
                    continue;
                };
                let ndim = self.layout.ndim();
                for (row, own) in heat.coupling.chunks_exact_mut(n * ndim).zip(shape) {
                    let nodes = row.chunks_exact_mut(ndim).zip(shape).zip(sample.dshape);
                    for ((to, shape), dshape) in nodes {
                        let grows =
                            stretched(patch.space(), tangents, normal, *shape, *dshape).to_array();
                        let grows = grows.into_iter().map(|g| weight * flux * own * g);
                        to.iter_mut().zip(grows).for_each(|(to, g)| *to += g);
                    }
                }
            }
            heat.add_to(out);
        }
        Ok(())
    }

    fn energy(&self, _: usize, _: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        Ok(None)
    }
}
