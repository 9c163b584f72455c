//! Bonds that may break: what their rows have suffered.

use super::bonds::{Bond, turn_between};
use super::{Interface, Past, Rows, State, TermError};
use crate::contact::cohesion::Torn;
use crate::contact::kernel::Contact;
use crate::contact::row::{Row, RowOrder};
use crate::contact::tear::opening;
use signorini_geometry::surface::{Anchor, ContactSurface, Placement, SurfaceJet};
use signorini_geometry::tensor::{Mat3, Vec3};

impl Interface {
    /// The past of a row as it was where the increment began.
    pub(super) fn past_of_increment(&self, row: usize) -> Past {
        Past {
            torn: self
                .bonds
                .before
                .get(row)
                .map_or(Torn::default(), |b| b.torn),
            ..self.history.past(row)
        }
    }

    /// Bonds that may break take the normals of the sides where an increment begins.
    pub(super) fn begin_bonds(&mut self, from: &State) -> Result<(), TermError> {
        if self.parts.cohesion.is_none() {
            return Ok(());
        }
        let nrow = self.parts.discretization.nrow();
        self.bonds.accepted.resize(nrow, Bond::default());
        let turns = self.turns_of_held(from)?;
        let mut rows = Rows::default();
        let mut before = Vec::with_capacity(nrow);
        for (row, bond) in self.bonds.accepted.iter().enumerate() {
            self.relate(row, from, RowOrder::Gap, &mut rows)?;
            let turn = turns.get(row).copied().unwrap_or(Mat3::IDENTITY);
            let normal = rows.rows().first().map(|filled| turn * filled.normal);
            before.push(normal.map_or(*bond, |normal| bond.turned(normal)));
        }
        self.bonds.before = before;
        Ok(())
    }

    /// How far the secondary side has turned around the node of each row whose weights, and normal, are those of the start;
    /// empty where normals follow by themselves, or strains are small.
    fn turns_of_held(&self, now: &State) -> Result<Vec<Mat3>, TermError> {
        let (parts, discretization) = (&self.parts, &self.parts.discretization);
        let held = self.step.nonlinear && discretization.capabilities().keeps_weights();
        let Some(facets) = parts.pair.secondary.as_ref().filter(|_| held) else {
            return Ok(Vec::new());
        };
        let nodes = (0..).zip(&now.x);
        let x: Vec<Vec3> = nodes.map(|(n, x)| *x - self.displacement(n, now)).collect();
        let start = Placement { x: &x, poses: &[] };
        let mut normals = [start, now.placement()].map(|at| (at, vec![Vec3::ZERO; x.len()]));
        let mut jet = SurfaceJet::default();
        for (at, sums) in &mut normals {
            for facet in 0..facets.nfacet() as u32 {
                let Some(element) = facets.element(facet) else {
                    continue;
                };
                let local = element.centre();
                let jet_at = facets.jet(at, &Anchor { facet, local }, &mut jet);
                jet_at.map_err(|e| self.failed(&e))?;
                for node in facets.nodes(facet) {
                    if let Some(sum) = sums.get_mut(*node as usize) {
                        *sum += jet.normal;
                    }
                }
            }
        }
        let [(_, start), (_, now)] = normals;
        let turn = |row: usize| {
            let node = *discretization.point(row).nodes.first()? as usize;
            let [from, to] = [start.get(node)?, now.get(node)?].map(|n| n.normalized());
            Some(turn_between(from?, to?))
        };
        let rows = 0..discretization.nrow();
        Ok(rows
            .map(|row| turn(row).unwrap_or(Mat3::IDENTITY))
            .collect())
    }

    /// Gives a filled row of a bond the normal of the increment: its gap is how far it has opened.
    pub(super) fn turn_bond(&self, row: &mut Row) {
        if let Some(bond) = self.bonds.before.get(row.number) {
            row.normal = bond.normal;
        }
        row.gap = row.normal.dot(row.sliding.slip);
        for (weight, b) in row.weights.iter_mut().zip(&row.sliding.operator) {
            *weight = b.dot(row.normal);
        }
        row.gradient.clone_from(&row.weights);
    }

    /// Damage grows to that of an accepted state.
    pub(super) fn tear(&mut self, state: &State) -> Result<(), TermError> {
        let Some(cohesion) = self.parts.cohesion.as_ref().filter(|_| self.is_active()) else {
            return Ok(());
        };
        let mut rows = Rows::default();
        let mut next = self.bonds.before.clone();
        let (mut spent, mut rubbed, mut slips) = ([0.0; 2], 0.0, Vec::new());
        for (row, bond) in next.iter_mut().enumerate() {
            if !self.acting_row(row, state, RowOrder::Gradient, &mut rows)? {
                continue;
            }
            let Some(filled) = rows.rows().first() else {
                continue;
            };
            let (laws, past) = (self.laws_of(row), self.past(row));
            let pull = laws.pull(cohesion, filled, &past);
            let stretch = filled.sliding.slip;
            let [before, damage] = [bond.torn.damage, pull.grown.damage];
            let openings = [bond.stretch, stretch].map(|e| opening(e, filled.normal));
            let measure = self.measure(row) * filled.coverage;
            for (sum, more) in spent
                .iter_mut()
                .zip(cohesion.spent(openings, [before, damage]))
            {
                *sum += measure * more;
            }
            let within = filled.within(stretch);
            let sticks = match pull.state_of_friction {
                Contact::Slip => within - laws.yielded(&pull),
                Contact::Stick => bond.torn.sticks,
                Contact::Open => within,
            };
            if pull.state_of_friction == Contact::Slip {
                let slipped = sticks - bond.torn.sticks;
                rubbed += measure * damage.acting * pull.rubs.dot(slipped);
                slips.push((row, slipped));
            }
            *bond = Bond {
                torn: Torn { damage, sticks },
                stretch,
                normal: filled.normal,
            };
        }
        self.bonds.accepted = next;
        for (sum, more) in self.bonds.spent.iter_mut().zip(spent) {
            *sum += more;
        }
        self.history.work += rubbed;
        for (row, slipped) in slips {
            if let Some(memory) = self.history.accepted.get_mut(row) {
                memory.slip += slipped;
                memory.path += slipped.norm();
            }
        }
        Ok(())
    }

    /// The damage of a filled row.
    pub(super) fn damage(&self, row: &Row) -> Option<f64> {
        let cohesion = self.parts.cohesion.as_ref()?;
        let past = self.past(row.number);
        let pull = self.laws_of(row.number).pull(cohesion, row, &past);
        Some(pull.grown.damage.acting)
    }
}
