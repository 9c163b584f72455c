//! Sides that wear.
//!
//! ```text
//! dh = K p ds                          of each side, where it slides under pressure
//! g* = g + h + Σ_l β_l h_l             what the law sees: of the row, and of nodes l of the primary side            (W1)
//! Δh_l = Σ_j w_j β_jl K p_j s_j / A_l  so that Σ_l A_l Δh_l is what the rows j have taken off                       (W3)
//! ```
//!
//! Within an increment the depth grows with the pressure found at its end, as a compliance in series with the law of each row, (W2) of
//! `worn`; rows take what both sides lose. Of the primary side that is spread over its nodes where the increment has ended: β are the
//! weights of the row over their sum, A the areas of nodes at the start, whether they are covered or not. Weights are unchanged:
//! forces act where the nodes are.
//!
//! Depths of the primary side are updated in every iterate, so that residuals account for what has slid where. Tangents leave out how
//! they change: that is their slope along the surface, which has to be small for (W1) to hold.
//!
//! The way s is that of the row from where it was at the start of the increment, without what sticking yields, or a distance that
//! the step imposes, spread evenly over its time.

use super::means::mean;
use super::{
    Archive, ArchiveError, ContactPhase, Interface, Measure, Participant, Rows, State, TermError,
    Worn,
};
use crate::contact::row::{RowOrder, Series};
use crate::system::{ContactFrame, Frame, Wear};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

impl Interface {
    /// The way that the present step imposes.
    fn imposed(&self) -> Option<f64> {
        self.phase().and_then(|phase: &ContactPhase| phase.slip)
    }

    /// Whether rows have to know how far they slide, for wear.
    pub(super) fn walks(&self) -> bool {
        let wears = self.parts.wear.is_some() && self.parts.bond.is_none();
        wears && !self.step.vibrates && self.imposed().is_none()
    }

    /// Why a step with inertia cannot take it; nothing where it can.
    pub(super) fn wears_in_motion(&self) -> Option<String> {
        self.parts.wear.as_ref().map(|_| {
            format!(
                "contact \"{}\" wears, which dynamic steps do not count: delete `wear`, or take a static step",
                self.parts.name
            )
        })
    }

    /// Puts wear into a row whose gap is that without what the increment takes off.
    pub(super) fn wear_row(&self, number: usize, trial: &State, order: RowOrder, rows: &mut Rows) {
        let (Some(wear), false) = (&self.parts.wear, self.step.vibrates) else {
            return;
        };
        let walks = self.walks();
        let laws = self.laws_of(number);
        let past = self.history.past(number);
        let per_pressure = match self.parts.measure {
            Measure::Area => 1.0,
            Measure::Node => self.area(number).recip(),
        };
        let lambda = self.lambda(number, trial);
        let Some(row) = rows.rows_mut().first_mut() else {
            return;
        };
        let way = match self.imposed() {
            Some(way) => way.abs() * self.duration / self.step.duration,
            None if row.sliding.free || order == RowOrder::Gap => 0.0,
            None => row.sliding.slip.norm(),
        };
        if way <= 0.0 {
            return;
        }
        let series = Series {
            coefficient: wear.coefficients.iter().sum::<f64>() * per_pressure * self.step.cycles,
            way,
            eases: walks,
            path: past.path,
            held: past.limit,
        };
        row.worn = Some(series);
        if !walks || order != RowOrder::Tangent {
            return;
        }
        let scalar = laws.scalar(row.normal, &lambda);
        let pressure = match laws.law.multiplier().is_unknown() {
            true => scalar,
            false => laws.law_at(row.seen(), scalar).value,
        };
        if pressure > 0.0 && laws.slid(&series, pressure).0 > 0.0 {
            let along = row.sliding.slip * (series.coefficient * pressure / way);
            for (g, de) in row.gradient.iter_mut().zip(&row.sliding.dslip) {
                *g += along.dot(*de);
            }
        }
    }

    /// Finds how deep the primary side is worn opposite each row.
    pub(super) fn see_opposite(&mut self, at: &State) -> Result<(), TermError> {
        if self.worn.nodes[0].iter().all(|depth| *depth == 0.0) {
            self.worn.opposite.fill(0.0);
            return Ok(());
        }
        let mut rows = Rows::default();
        let mut opposite = std::mem::take(&mut self.worn.opposite);
        for (row, depth) in opposite.iter_mut().enumerate() {
            self.relate(row, at, RowOrder::Gradient, &mut rows)?;
            *depth = 0.0;
            self.each_share(&rows, &mut |node, share| {
                *depth += share * self.worn.nodes[0].get(node).copied().unwrap_or_default();
            });
        }
        self.worn.opposite = opposite;
        Ok(())
    }

    /// The nodes of the primary side that a row acts on, by their places among those with areas, and their shares of it.
    fn each_share(&self, rows: &Rows, take: &mut dyn FnMut(usize, f64)) {
        let (Some(row), Some(wear)) = (rows.rows().first(), &self.parts.wear) else {
            return;
        };
        let secondary = rows.secondary();
        let shares = |take: &mut dyn FnMut(NodeId, f64)| {
            let mut column = 0;
            for (place, participant) in rows.participants().iter().enumerate() {
                if let Some(&[x, y, z]) = row.weights.get(column..column + 3)
                    && let Participant::Node(node) = *participant
                    && !secondary.contains(&place)
                {
                    take(node, -Vec3::new(x, y, z).dot(row.normal));
                }
                column += participant.ncolumn();
            }
        };
        let mut all = 0.0;
        shares(&mut |_, share| all += share);
        if all <= 0.0 {
            return;
        }
        shares(&mut |node, share| {
            if let Ok(place) = wear.areas.binary_search_by_key(&node, |(node, _)| *node) {
                take(place, share / all);
            }
        });
    }

    /// Takes off the sides what an increment has worn.
    pub(super) fn wear_away(&mut self, state: &State) -> Result<(), TermError> {
        let Some(wear) = &self.parts.wear else {
            return Ok(());
        };
        let all = wear.coefficients.iter().sum::<f64>();
        let parts = wear.coefficients.map(|own| own / all);
        let mut rows = Rows::default();
        let mut depths_of_rows = self.worn.rows[0].clone();
        let mut depths_of_nodes = self.worn.nodes[0].clone();
        let mut volume = self.worn.volume;
        for number in 0..self.parts.discretization.nrow() {
            if !self.acting_row(number, state, RowOrder::Gradient, &mut rows)? {
                continue;
            }
            let Some(row) = rows.rows().first() else {
                continue;
            };
            let Some(series) = row.worn else { continue };
            let pressure = self.traction(row, &self.lambda(number, state)).pressure;
            if pressure <= 0.0 {
                continue;
            }
            let (way, _) = self.laws_of(number).slid(&series, pressure);
            let depths = parts.map(|part| part * series.coefficient * way * pressure);
            let volumes = depths.map(|depth| depth * self.area(number) * row.coverage);
            if let Some(depth) = depths_of_rows.get_mut(number) {
                *depth += depths[0];
            }
            let areas = &wear.areas;
            let nodes = &mut depths_of_nodes;
            self.each_share(&rows, &mut |node, share| {
                if let (Some(depth), Some((_, area))) = (nodes.get_mut(node), areas.get(node)) {
                    *depth += share * volumes[1] / area;
                }
            });
            for (volume, more) in volume.iter_mut().zip(volumes) {
                *volume += more;
            }
        }
        (self.worn.rows[1], self.worn.nodes[1]) = (depths_of_rows, depths_of_nodes);
        self.worn.volume = volume;
        Ok(())
    }

    /// How much of both sides the present increment takes off at a row.
    pub(super) fn wears_off(&self, number: usize, state: &State, rows: &mut Rows) -> f64 {
        let acts = self.parts.wear.is_some()
            && (self.acting_row(number, state, RowOrder::Gradient, rows)).unwrap_or(false);
        let row = rows.rows().first().filter(|_| acts);
        row.map_or(0.0, |row| {
            let pressure = self.traction(row, &self.lambda(number, state)).pressure;
            let laws = self.laws_of(number);
            laws.seen_by_law(row.seen(), pressure) - row.gap
        })
    }

    /// Writes what is worn into the report of an accepted state.
    pub(super) fn report_wear(&self, report: &mut ContactFrame, frame: &mut Frame) {
        let Some(wear) = &self.parts.wear else { return };
        let pair = &self.parts.pair;
        let discretization = self.parts.discretization.as_ref();
        let mut sums = vec![(0.0, 0.0); pair.points.len()];
        let mut deepest = (0.0, None);
        for (row, &depth) in self.worn.rows[1].iter().enumerate() {
            let point = discretization.point(row);
            if depth > deepest.0 {
                deepest = (depth, point.nodes.first().copied());
            }
            for (node, shape) in point.nodes.iter().zip(point.weights) {
                if let Ok(k) = pair.points.binary_search(node)
                    && let Some(sum) = sums.get_mut(k)
                {
                    let share = self.area(row) * shape * shape;
                    *sum = (sum.0 + share * depth, sum.1 + share);
                }
            }
        }
        let opposite = wear.areas.iter().zip(&self.worn.nodes[1]);
        let opposite: Vec<(NodeId, f64)> = opposite.map(|((node, _), h)| (*node, *h)).collect();
        for (node, depth) in &opposite {
            if *depth > deepest.0 {
                deepest = (*depth, Some(*node));
            }
        }
        let depth: Vec<f64> = sums.into_iter().map(mean).collect();
        let nnode = frame.contact_pressure.len();
        frame.worn_depth.resize(nnode, 0.0);
        let own = pair.points.iter().copied().zip(depth.iter().copied());
        for (node, depth) in own.chain(opposite.iter().copied()) {
            if let Some(to) = frame.worn_depth.get_mut(node as usize) {
                *to += depth;
            }
        }
        report.wear = Some(Wear {
            depth,
            opposite,
            volume: self.worn.volume,
            deepest: deepest.0,
            node: deepest.1,
        });
    }

    pub(super) fn store_wear(&self, out: &mut Archive) {
        let Some(wear) = &self.parts.wear else { return };
        let name = |what: &str| format!("contact.{}.{what}", self.stored_name());
        out.put(name("worn"), &self.worn.rows[1]);
        let nodes = wear.areas.iter().zip(&self.worn.nodes[1]);
        let nodes = nodes.flat_map(|((node, _), depth)| [f64::from(*node), *depth]);
        out.put(name("worn_opposite"), &nodes.collect::<Vec<_>>());
        out.put(name("worn_volume"), &self.worn.volume);
    }

    pub(super) fn restore_wear(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let Some(wear) = &self.parts.wear else {
            return Ok(());
        };
        let stored = self.stored_name();
        let name = |what: &str| format!("contact.{stored}.{what}");
        let mut worn = Worn::new(Some(wear), self.parts.discretization.nrow());
        from.get(&name("worn"), &mut worn.rows[1])?;
        from.get(&name("worn_volume"), &mut worn.volume)?;
        let mut nodes = vec![0.0; from.length(&name("worn_opposite"))?];
        from.get(&name("worn_opposite"), &mut nodes)?;
        let (pairs, _) = nodes.as_chunks();
        for [node, depth] in pairs {
            let place = wear
                .areas
                .binary_search_by_key(&(*node as NodeId), |of| of.0);
            if let Some(to) = place.ok().and_then(|place| worn.nodes[1].get_mut(place)) {
                *to = *depth;
            }
        }
        worn.begin();
        self.worn = worn;
        Ok(())
    }
}
