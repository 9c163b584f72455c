use super::value;
use crate::system::{Dof, Order, Sink, State};

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
