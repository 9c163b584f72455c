//! A contact in explicit steps.

use super::{Interface, RowOrder, Rows, State, TermError};
use crate::contact::friction::Stick;
use crate::contact::kernel::Laws;
use crate::contact::law::Multiplier;
use crate::contact::row::Row;
use crate::system::{Acts, Dof, Impulsive, NearRow, Rubbing};

/// How far beyond contact the stiffness of a law is asked for, over the size of the facets.
const CLOSED: f64 = 1e-6;

impl Interface {
    /// Whether its multipliers are solved for.
    pub(super) fn has_unknown_multipliers(&self) -> bool {
        self.parts.bond.is_none() && self.parts.law.multiplier().is_unknown()
    }

    /// Why an explicit step cannot take it; nothing where it can.
    pub(super) fn not_explicit(&self) -> Option<String> {
        let name = &self.parts.name;
        let joined = self.parts.bond.is_some() && self.parts.law.multiplier() != Multiplier::None;
        if joined {
            return Some(format!(
                "contact \"{name}\" is joined by multipliers, which an explicit step has no equations for: join it by a penalty"
            ));
        }
        if self.parts.fluid.is_some() {
            return Some(format!(
                "contact \"{name}\" has a `fluid`, whose front explicit steps do not look for: take an implicit method"
            ));
        }
        if self.parts.gasket.is_some() {
            return Some(format!(
                "contact \"{name}\" is a `gasket`, which explicit steps do not take: take an implicit method"
            ));
        }
        if self.parts.damping.acts() {
            return Some(format!(
                "contact \"{name}\" damps, which explicit steps do not: delete `damping`, or take an implicit method"
            ));
        }
        let lends = self.has_unknown_multipliers() && !self.lents.is_empty();
        lends.then(|| {
            format!(
                "contact \"{name}\" has nodes that are held along its face, whose multipliers act elsewhere: take a penalty, or \
                 method = \"node-to-segment\", in an explicit step"
            )
        })
    }

    /// Why a step with inertia whose equations are solved cannot take it; nothing where it can.
    pub(super) fn not_implicit(&self) -> Option<String> {
        if self.step.conserves() && (self.parts.gasket.is_some() || self.parts.fluid.is_some()) {
            return Some(format!(
                "contact \"{}\" is a `gasket`, or has a `fluid`, which take energy from the sides or give it: take the method \"generalized-alpha\"",
                self.parts.name
            ));
        }
        let yields = self.parts.restitution > 0.0 && !self.parts.is_rigid;
        yields.then(|| {
            format!(
                "contact \"{}\" has a `restitution`, which sides that yield have by themselves: delete it, or let both sides be rigid",
                self.parts.name
            )
        })
    }

    /// The largest stiffness of a row that is closed, per gap and slip.
    fn stiffness(&self, row: &Row) -> f64 {
        let laws = self.laws_of(row.number);
        let closed = row.gap.min(-CLOSED * laws.scale.length);
        let frozen = self.history.lambda(row.number).scalar;
        let at = laws.law.pressure(closed, frozen, laws.scale);
        let normal = at.dgap.abs();
        let along = match laws.stick {
            _ if laws.friction.is_none() => 0.0,
            Stick::Stiffness(stiffness) => stiffness,
            Stick::Slip(length) => self.limit(row.number, at.value) / length,
        };
        normal.max(along)
    }
}

impl Impulsive for Interface {
    fn is_hard(&self) -> bool {
        self.has_unknown_multipliers()
    }

    fn bounces(&self) -> bool {
        self.is_hard() && self.is_active() && self.parts.is_rigid
    }

    fn near_rows(
        &self,
        state: &State,
        reach: f64,
        take: &mut dyn FnMut(&NearRow<'_>),
    ) -> Result<(), TermError> {
        let laws: Laws<'_> = self.laws();
        if !self.is_active() || laws.bond {
            return Ok(());
        }
        let mut rows = Rows::default();
        let mut dofs: Vec<Dof> = Vec::new();
        for number in 0..self.parts.discretization.nrow() {
            if self.now.pairs.get(number).is_none_or(Option::is_none) {
                continue;
            }
            self.fill(number, state, RowOrder::Gap, &mut rows)?;
            if rows.rows().first().is_none_or(|row| row.gap > reach) {
                continue;
            }
            self.fill(number, state, RowOrder::Gradient, &mut rows)?;
            rows.dofs(&self.layout, &mut dofs);
            let Some(row) = rows.rows().first() else {
                continue;
            };
            let acts = match self.has_unknown_multipliers() {
                false => Acts::Stiff(self.stiffness(row)),
                true => Acts::Hard {
                    multiplier: self
                        .layout
                        .multiplier(self.parts.first_multiplier + self.nmultiplier() * number),
                    count: self.nmultiplier(),
                    restitution: self.parts.restitution,
                    friction: laws.friction.map(|_| Rubbing {
                        operator: &row.sliding.operator,
                    }),
                },
            };
            take(&NearRow {
                number,
                dofs: &dofs,
                gap: row.gap,
                weights: &row.weights,
                measure: self.measure(number),
                normal: row.normal,
                acts,
            });
        }
        Ok(())
    }

    fn limit(&self, row: usize, pressure: f64) -> f64 {
        let past = self.history.past(row);
        let friction = self.laws().friction;
        friction.map_or(0.0, |law| law.limit(&past.sliding(pressure)).value)
    }
}
