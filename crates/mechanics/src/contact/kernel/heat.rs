//! What heat needs of the forces of a row: pressure and the work of friction, with their derivatives.

use super::super::friction::Stick;
use super::super::row::Row;
use super::{Contact, Lambda, Laws, Past};
use crate::contact::law::Eval;
use signorini_geometry::tensor::Vec3;

/// Derivatives over the columns of a row, those of its multiplier included.
#[derive(Debug, Default)]
pub(in crate::contact) struct Slopes {
    /// Of the pressure.
    pub pressure: Vec<f64>,
    /// Work of friction per area in the increment, 𝒟 Δt; 0 where nothing slips.
    pub dissipated: f64,
    /// Its derivatives; empty where nothing slips.
    pub dissipation: Vec<f64>,
    /// Those of the pressure that limits friction.
    tried: Vec<f64>,
}

impl Laws<'_> {
    /// The pressure of a row, and the work of its friction: (E4) of `interface::thermal`.
    pub fn slopes(
        &self,
        row: &Row,
        lambda: &Lambda,
        past: Past,
        width: usize,
        out: &mut Slopes,
    ) -> f64 {
        let pressure = self.pressure(row.seen(), row.normal, lambda);
        out.pressure.clear();
        self.derive(row, &pressure, lambda, width, &mut out.pressure);
        out.dissipated = 0.0;
        out.dissipation.clear();
        if !self.bond && pressure != Eval::default() {
            self.dissipate(row, lambda, past, width, out);
        }
        pressure.value
    }

    /// The derivatives of a pressure.
    fn derive(&self, row: &Row, at: &Eval, lambda: &Lambda, width: usize, out: &mut Vec<f64>) {
        let n = row.weights.len();
        let turns = |j: usize| match (self.vectors, row.sliding.dnormal.get(j)) {
            (true, Some(turned)) => lambda.vector.dot(*turned),
            _ => 0.0,
        };
        let of_columns = row.gradient.iter().enumerate();
        out.extend(of_columns.map(|(j, g)| at.dgap * g - at.dlambda * turns(j)));
        out.extend((0..width.saturating_sub(n)).map(|c| match self.vectors {
            true => -at.dlambda * row.normal[c],
            false => at.dlambda,
        }));
    }

    fn dissipate(&self, row: &Row, lambda: &Lambda, past: Past, width: usize, out: &mut Slopes) {
        let Some(friction) = self.friction else {
            return;
        };
        let tried = self.tried(row.seen(), self.scalar(row.normal, lambda));
        let limit = self.limit_of(row, &past, friction, tried.value);
        let trial = self.trial(row, lambda);
        let slip = row.sliding.slip;
        let (_, state) = self.returned(trial, &limit, past.state);
        let Some(along) = slip.normalized().filter(|_| state == Contact::Slip) else {
            return;
        };
        if limit.value <= 0.0 {
            return;
        }
        let dslip = |j: usize| row.sliding.dslip.get(j).copied().unwrap_or_default();
        if self.sticks_exactly() {
            let normal = row.normal;
            let pressed = normal.dot(lambda.vector);
            let traction = lambda.vector - normal * pressed;
            let work = traction.dot(slip);
            out.dissipated = work.abs();
            let dtraction = |j: usize| match row.sliding.dnormal.get(j) {
                Some(turned) => *turned * -pressed - normal * lambda.vector.dot(*turned),
                None => {
                    let axis = j - row.weights.len();
                    Vec3::unit(axis) - normal * normal[axis]
                }
            };
            let of = |j| work.signum() * (traction.dot(dslip(j)) + slip.dot(dtraction(j)));
            out.dissipation.extend((0..width).map(of));
            return;
        }
        let elastic = match self.stick {
            Stick::Stiffness(stiffness) if stiffness > 0.0 => {
                [1.0, 2.0].map(|k| k * limit.value / stiffness)
            }
            Stick::Stiffness(_) => [0.0; 2],
            Stick::Slip(length) => [length; 2],
        };
        let far = slip.norm();
        out.dissipated = limit.value * (far - elastic[0]);
        out.tried.clear();
        self.derive(row, &tried, lambda, width, &mut out.tried);
        let of = |(j, dp): (usize, &f64)| {
            limit.dpressure * dp * (far - elastic[1]) + limit.value * along.dot(dslip(j))
        };
        out.dissipation.extend(out.tried.iter().enumerate().map(of));
    }
}
