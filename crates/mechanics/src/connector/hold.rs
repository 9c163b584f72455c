use super::{CHUNK, value};
use crate::system::{
    Dof, Order, Part, PatternSink, Phase, Properties, Role, Sink, State, Symmetry, Term, TermError,
    Work,
};
use signorini_geometry::mesh::NodeId;

/// Constraints of one kind that a connector adds, each with its own multiplier. Whoever has them is a term.
pub(super) trait Constraints: Send + Sync {
    /// What adding one of them needs.
    type Work: Default + Send + 'static;

    /// What they are called in messages.
    fn name(&self) -> &str;

    /// How many there are.
    fn count(&self) -> usize;

    /// Names the unknowns of the k-th.
    fn couple(&self, k: usize, out: &mut dyn PatternSink);

    /// Whether the step is at finite strain.
    fn set_nonlinear(&mut self, nonlinear: bool);

    /// Adds forces and stiffness of the k-th.
    fn add(&self, k: usize, trial: &State, order: Order, work: &mut Self::Work, out: &mut dyn Sink);
}

impl<C: Constraints> Term for C {
    fn name(&self) -> &str {
        Constraints::name(self)
    }

    fn properties(&self) -> Properties {
        Properties::new(Symmetry::Symmetric, Part::Interface).with_role(Role::Support)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        for k in 0..self.count() {
            self.couple(k, out);
        }
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        self.set_nonlinear(phase.step.nonlinear);
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.count().div_ceil(CHUNK)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        for k in (0..self.count()).skip(chunk * CHUNK).take(CHUNK) {
            self.add(k, trial, order, work.of(), out);
        }
        Ok(())
    }

    fn energy(&self, _: usize, _: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        Ok(None)
    }
}

/// Takes out the node for which a measure is largest; the first one of several.
pub(super) fn take_out(nodes: &mut Vec<NodeId>, measure: impl Fn(NodeId) -> f64) -> NodeId {
    let mut best = (0, f64::NEG_INFINITY);
    for (k, &node) in nodes.iter().enumerate() {
        let m = measure(node);
        if m > best.1 {
            best = (k, m);
        }
    }
    nodes.remove(best.0)
}

/// What a constraint needs to write down its tangent.
#[derive(Default)]
pub(super) struct Scratch {
    force: Vec<f64>,
    stiffness: Vec<f64>,
}

/// A constraint `g = 0` between positions, with its multiplier: `L = λ g`.
pub(super) struct Hold<'a> {
    /// The n unknowns it speaks of, those of a node together, then its multiplier.
    pub dofs: &'a [Dof],
    /// g
    pub gap: f64,
    /// ∂g, n numbers
    pub gradient: &'a [f64],
    /// By how much g is uncertain through rounding.
    pub rounding: f64,
}

impl Hold<'_> {
    /// Adds `λ ∂g` and `g` with their derivatives; `hessian(i, j)` is `∂²g`.
    ///
    /// The gap goes in parts, node by node, so that it is judged against what cancels in it.
    pub fn add(
        &self,
        hessian: impl Fn(usize, usize) -> f64,
        trial: &State,
        order: Order,
        work: &mut Scratch,
        out: &mut dyn Sink,
    ) {
        let n = self.gradient.len();
        let own = self.dofs.get(n..).unwrap_or_default();
        let multiplier = own.first().map_or(0.0, |&dof| value(trial, dof));
        let mut rest = self.gap;
        for (part, of) in self.gradient.chunks(3).zip(self.dofs.chunks(3)) {
            let part: f64 = part.iter().zip(of).map(|(g, &d)| g * value(trial, d)).sum();
            out.add(own, &[part], &[]);
            rest -= part;
        }
        out.uncertain(own, self.rounding);
        work.force.clear();
        work.force
            .extend(self.gradient.iter().map(|g| multiplier * g));
        work.force.push(rest);
        work.stiffness.clear();
        if order == Order::Tangent {
            for (i, g) in self.gradient.iter().enumerate() {
                work.stiffness
                    .extend((0..n).map(|j| multiplier * hessian(i, j)));
                work.stiffness.push(*g);
            }
            work.stiffness.extend(self.gradient);
            work.stiffness.push(0.0);
        }
        out.add(self.dofs, &work.force, &work.stiffness);
    }
}
