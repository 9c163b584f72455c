//! What a contact remembers.

use super::bonds::Bonds;
use super::coupled::Coupled;
use super::memory::{Ends, Memory};
use super::{
    Archive, ArchiveError, Contact, Interface, Judged, Lambda, Multiplier, Rows, Shift, State,
    TermError, Verdict,
};
use crate::contact::discretization::{Anchored, NOWHERE, Pair, Pairing, Renewable};
use crate::contact::row::{Row, RowOrder};
use signorini_geometry::surface::{Anchor, Feature, Placement, SurfaceError, SurfaceJet};
use signorini_geometry::tensor::Vec3;

/// What may be left of a change of the limits of friction, over the largest.
const LIMIT_TOLERANCE: f64 = 1e-7;

/// Points that remember a traction have closed where they overlap by more than this part of a facet: what touches by
/// rounding alone has not.
const TOUCH: f64 = 1e-12;

/// Numbers of a pair, of a memory and of a judgement, in a checkpoint.
pub(super) const PAIR: usize = 11;
pub(super) const MEMORY: usize = 16;
pub(super) const JUDGED: usize = 3;

impl Interface {
    /// Areas at this configuration.
    pub(super) fn measure_again(&mut self, at: &Placement) -> Result<(), SurfaceError> {
        if let Some(areas) = &self.parts.areas {
            self.parts.area = areas(self.parts.discretization.as_ref(), at.x)?;
        }
        Ok(())
    }

    /// Finds what straight facets miss where the sides are now, if they slide.
    pub(super) fn bend_again(&mut self, at: &Placement) -> Result<(), SurfaceError> {
        let parts = &mut self.parts;
        if let Some(bend) = parts.bend.as_mut().filter(|bend| bend.slides) {
            let of = parts.discretization.capabilities();
            if let Some(curved) = of.curved {
                bend.rises = curved.rises(&parts.pair, at, &self.now, &bend.sides)?;
            }
        }
        Ok(())
    }

    /// Has so many rows, of which nothing is known.
    fn resize(&mut self, nrow: usize) {
        let nothing = Pairing::nothing(nrow);
        for pairing in [
            &mut self.now,
            &mut self.next,
            &mut self.accepted,
            &mut self.before,
        ] {
            pairing.clone_from(&nothing);
        }
        self.judged = vec![Judged::default(); nrow];
        self.accepted_judged.clone_from(&self.judged);
        self.changes = vec![0; nrow];
        self.near.search.forget();
    }

    /// Rows that are made again for each increment: they go on with what those before them remember, and meet the facets that are
    /// near now. Says whether they are others.
    pub(super) fn renew_rows(&mut self, from: &State) -> Result<bool, TermError> {
        let renewable = self.parts.discretization.capabilities().renewable;
        if self.parts.bond.is_some() || !renewable.is_some_and(Renewable::renews) {
            return Ok(false);
        }
        let at = from.placement();
        self.history.begin();
        let stretched = self.stretched(from)?;
        let parts = &mut self.parts;
        let renewable = parts.discretization.renewable_mut();
        let Some(origins) = renewable.and_then(|rows| rows.renew(&parts.pair, at.x)) else {
            return Ok(false);
        };
        self.resize(origins.len());
        self.wetting.follow(&origins);
        self.search(&at).map_err(|e| self.failed(&e))?;
        self.accepted.clone_from(&self.now);
        // the coupling is known from these rows alone, in a run that was resumed, too
        self.sees_others = true;
        let of = |origin: &Option<u32>| origin.map(|row| row as usize);
        if !self.parts.shifts.is_empty() {
            let shift = |o| of(o).and_then(|row| self.parts.shifts.get(row).copied());
            self.parts.shifts = origins
                .iter()
                .map(|o| shift(o).unwrap_or_default())
                .collect();
        }
        let mut accepted = Vec::with_capacity(origins.len());
        for (row, origin) in origins.iter().enumerate() {
            let before = of(origin).and_then(|k| self.history.accepted.get(k).copied());
            let mut memory = before.unwrap_or_default();
            memory.anchor = match (memory.anchor, &self.now.pairs[row]) {
                (Some(_), Some(found)) => {
                    let slip = of(origin).and_then(|k| stretched.get(k).copied());
                    let discretization = self.parts.discretization.as_ref();
                    let pair = &self.parts.pair;
                    let sticks =
                        discretization.anchor(row, pair, &at, found, slip.unwrap_or_default());
                    Some(sticks.map_err(|e| self.failed(&e))?)
                }
                _ => None,
            };
            accepted.push(memory);
        }
        self.history.accepted = accepted;
        self.history.begin();
        Ok(true)
    }

    /// How far each row is from where it sticks; empty without friction.
    fn stretched(&self, from: &State) -> Result<Vec<Vec3>, TermError> {
        if self.laws().friction.is_none() {
            return Ok(Vec::new());
        }
        let mut rows = Rows::default();
        let mut slips = Vec::with_capacity(self.now.pairs.len());
        for row in 0..self.now.pairs.len() {
            self.fill(row, from, RowOrder::Gradient, &mut rows)?;
            slips.push(rows.rows().first().map_or(Vec3::ZERO, |r| r.sliding.slip));
        }
        Ok(slips)
    }

    /// Multipliers that are frozen become the tractions of the solution found with them.
    pub(super) fn augment(&mut self, trial: &State) -> Result<Verdict, TermError> {
        let mut rows = Rows::default();
        let mut worst = (0.0f64, None);
        let mut lambdas = Vec::with_capacity(self.history.lambdas.len());
        let penalty = self.parts.scale.penalty;
        for row in 0..self.history.lambdas.len() {
            let before = self.lambda(row, trial);
            if !self.acting_row(row, trial, RowOrder::Gradient, &mut rows)? {
                lambdas.push(Lambda::default());
                continue;
            }
            let Some(filled) = rows.rows().first() else {
                lambdas.push(before);
                continue;
            };
            let after = self.multiplier_of(filled, &before);
            let change =
                (after.scalar - before.scalar).abs() + (after.vector - before.vector).norm();
            let gap = change / penalty;
            if gap > self.tolerance(row, &after, trial) && gap > worst.0 {
                worst = (gap, Some(row));
            }
            lambdas.push(after);
        }
        let Some(row) = worst.1 else {
            return Ok(Verdict::Settled);
        };
        self.history.lambdas = lambdas;
        let change = format!("multipliers still change by a gap of {:.3e}", worst.0);
        Ok(self.goes_on(row, &change))
    }

    /// Holds the limits of friction; says whether that is anything new.
    /// What slips then has a potential, and its tangent is symmetric.
    pub(super) fn hold_limits(&mut self) -> bool {
        let laws = self.laws();
        if laws.friction.is_none() || laws.cohesion.is_some() || self.history.limits.is_some() {
            return false;
        }
        self.history.limits = Some(Vec::new());
        true
    }

    /// Limits that are held begin an increment as those of the pressures at its start: where nothing has touched yet, without friction.
    pub(super) fn begin_limits(&mut self, from: &State) -> Result<(), TermError> {
        if self.history.limits.is_some() {
            self.history.limits = Some(self.limits_at(from)?);
        }
        Ok(())
    }

    /// The limits of friction of the pressures in a state.
    fn limits_at(&self, state: &State) -> Result<Vec<f64>, TermError> {
        let mut rows = Rows::default();
        let mut limits = Vec::with_capacity(self.history.accepted.len());
        for row in 0..self.history.accepted.len() {
            let acts = self.acting_row(row, state, RowOrder::Gap, &mut rows)?;
            let filled = rows.rows().first().filter(|_| acts);
            let path = self.history.past(row).path;
            let limit = |r| self.laws().limit(r, &self.lambda(row, state), path);
            limits.push(filled.map_or(0.0, limit));
        }
        Ok(limits)
    }

    /// Limits that are held become those of the pressures found with them.
    pub(super) fn renew_limits(&mut self, trial: &State) -> Result<Verdict, TermError> {
        let Some(limits) = &self.history.limits else {
            return Ok(Verdict::Settled);
        };
        let renewed = self.limits_at(trial)?;
        let largest = renewed.iter().fold(0.0f64, |m, l| m.max(*l));
        let changes = renewed
            .iter()
            .zip(limits)
            .map(|(new, old)| (new - old).abs());
        let (row, change) = changes.enumerate().fold((0, 0.0), |worst, (row, change)| {
            if change > worst.1 {
                (row, change)
            } else {
                worst
            }
        });
        let settled = change <= LIMIT_TOLERANCE * largest;
        self.history.limits = Some(renewed);
        if settled {
            return Ok(Verdict::Settled);
        }
        let part = change / largest;
        let change = format!("limits of friction still change by {part:.1e} of the largest");
        Ok(self.goes_on(row, &change))
    }

    /// What was frozen has changed, most of all at this row.
    fn goes_on(&self, row: usize, change: &str) -> Verdict {
        let nodes = self.parts.discretization.point(row).nodes;
        Verdict::Repeat {
            changes: 1,
            closing: false,
            continuous: false,
            why: format!("contact \"{}\": its {change}", self.parts.name),
            nodes: nodes.first().copied().into_iter().collect(),
        }
    }

    /// The multiplier that makes a traction of its own.
    fn multiplier_of(&self, filled: &Row, before: &Lambda) -> Lambda {
        let traction = self.traction(filled, before);
        if self.parts.has_vectors() {
            Lambda {
                scalar: 0.0,
                vector: traction.tangential - filled.normal * traction.pressure,
            }
        } else {
            Lambda {
                scalar: traction.pressure,
                vector: Vec3::ZERO,
            }
        }
    }

    /// History moves on: points that slipped stick where they came to, points that opened forget.
    pub(super) fn remember(&mut self, state: &State) -> Result<(), TermError> {
        let mut rows = Rows::default();
        let at = state.placement();
        let exact = self.laws().sticks_exactly();
        let mut work = 0.0;
        let mut next = Vec::with_capacity(self.history.accepted.len());
        for (row, memory) in self.history.accepted.iter().enumerate() {
            let mut memory = *memory;
            let lambda = self.lambda(row, state);
            self.remember_gap(row, state, &mut memory.lambda, &mut rows)?;
            let acts = self.acting_row(row, state, RowOrder::Gradient, &mut rows)?;
            if self.parts.law.multiplier() == Multiplier::Frozen {
                let filled = rows.rows().first().filter(|_| acts);
                memory.lambda =
                    filled.map_or(Lambda::default(), |r| self.multiplier_of(r, &lambda));
            }
            if self.parts.bond.is_some() {
                next.push(memory);
                continue;
            }
            let (Some(filled), Some(found)) =
                (rows.rows().first().filter(|_| acts), &self.now.pairs[row])
            else {
                memory.anchor = None;
                memory.path = 0.0;
                next.push(memory);
                continue;
            };
            let traction = self.traction(filled, &lambda);
            let elastic = self.laws().elastic(&traction);
            // the rest of the way from the anchor has slipped
            let slipped = filled.sliding.slip - elastic;
            memory.anchor = None;
            if self.laws().friction.is_some() || self.walks() {
                memory.anchor = self.history.anchors[row];
                // weights of a state hold until the next one only
                let waited = memory.anchor.is_none();
                if waited && filled.gap > -TOUCH * self.parts.scale.length {
                    next.push(memory);
                    continue;
                }
                let by_traction = self.parts.remembers_traction;
                let renewed = exact || found.anchor == NOWHERE || waited || by_traction;
                if traction.state == Contact::Slip || renewed {
                    let discretization = self.parts.discretization.as_ref();
                    // what sticking yields goes on as a vector, or as a way back on the surface
                    let back = if by_traction { Vec3::ZERO } else { elastic };
                    let anchor = discretization.anchor(row, &self.parts.pair, &at, found, back);
                    let mut anchor = anchor.map_err(|e| self.failed(&e))?;
                    anchor.offset -= elastic - back;
                    memory.anchor = Some(anchor);
                }
                if traction.state == Contact::Slip {
                    memory.slip += slipped;
                    memory.path += slipped.norm();
                    work += self.measure(row) * filled.coverage * traction.tangential.dot(slipped);
                }
            }
            next.push(memory);
        }
        self.history.accepted = next;
        self.history.work += work;
        self.history.limits = None;
        Ok(())
    }

    /// At an edge of a surface that may touch itself, a node has the area of those facets alone that face the facet it meets.
    pub(super) fn measure_what_bears(&mut self, at: &Placement) -> Result<(), SurfaceError> {
        let parts = &mut self.parts;
        let Some(own) = parts.pair.own.as_ref() else {
            return Ok(());
        };
        if parts.discretization.capabilities().inside.is_some() || parts.area.is_empty() {
            return Ok(());
        }
        if parts.areas.is_none() {
            if self.whole.is_empty() {
                self.whole.clone_from(&parts.area);
            }
            parts.area.clone_from(&self.whole);
        }
        let surface = parts.pair.primary.as_ref();
        let now = own.at(surface, at);
        let mut jet = SurfaceJet::default();
        for (row, (area, found)) in parts.area.iter_mut().zip(&self.accepted.pairs).enumerate() {
            let Some(found) = found else { continue };
            surface.jet(at, &found.anchor, &mut jet)?;
            let nodes = parts.discretization.point(row).nodes;
            let point = parts.pair.own_point(nodes, None, &now);
            *area *= point.map_or(1.0, |point| point.bearing(jet.normal));
        }
        Ok(())
    }

    pub(super) fn store(&self, out: &mut Archive) {
        let name = |what: &str| format!("contact.{}.{what}", self.stored_name());
        let pairs = self.accepted.pairs.iter().flat_map(pair_to_numbers);
        out.put(name("pairs"), &pairs.collect::<Vec<f64>>());
        let memories = self.history.accepted.iter().flat_map(memory_to_numbers);
        out.put(name("memory"), &memories.collect::<Vec<f64>>());
        let judged = self.accepted_judged.iter().flat_map(judged_to_numbers);
        out.put(name("judged"), &judged.collect::<Vec<f64>>());
        out.put(name("choices"), &self.accepted.weights.choices());
        out.put(name("coupled"), &self.coupled.to_numbers());
        let first = self
            .first_step
            .map_or([-1.0, 0.0, 1.0], |s| [s.number as f64, s.start, s.duration]);
        let started = f64::from(u8::from(self.started));
        out.put(
            name("state"),
            &[
                self.history.work,
                started,
                first[0],
                first[1],
                first[2],
                self.history.damped[0],
            ],
        );
        let drift = self.drift.map(|(ratio, node)| [ratio, f64::from(node)]);
        out.put(name("drift"), drift.as_ref().map_or(&[], |d| &d[..]));
        out.put(name("area"), &self.parts.area);
        if let Some(ends) = self.ends.to_numbers() {
            out.put(name("ends"), &ends);
        }
        if self.parts.cohesion.is_some() {
            out.put(name("torn"), &self.bonds.to_numbers());
        }
        out.put(name("points"), &self.stored_points());
        let shifts = self.parts.shifts.iter();
        let shifts: Vec<f64> = shifts.flat_map(|s| [s.constant, s.fading]).collect();
        out.put(name("shifts"), &shifts);
        self.store_fluid(out);
        self.store_wear(out);
        self.store_heat(out);
    }

    pub(super) fn restore(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let stored = self.stored_name();
        let name = |what: &str| format!("contact.{stored}.{what}");
        let mut points = vec![0.0; from.length(&name("points"))?];
        from.get(&name("points"), &mut points)?;
        let parts = &mut self.parts;
        let fits = match parts.discretization.renewable_mut() {
            Some(rows) => rows.restore(&parts.pair, &points),
            None => points.is_empty(),
        };
        if !fits {
            return Err(ArchiveError::Length {
                name: name("points"),
                found: points.len(),
                expected: self.stored_points().len(),
            });
        }
        let parts = &self.parts;
        let nrow = parts.discretization.nrow();
        self.resize(nrow);
        let mut values = vec![0.0; nrow * PAIR];
        from.get(&name("pairs"), &mut values)?;
        let pairs = values.chunks_exact(PAIR).map(pair_from_numbers);
        self.accepted.pairs = pairs.collect();
        let mut values = vec![0.0; nrow * MEMORY];
        from.get(&name("memory"), &mut values)?;
        let memories = values.chunks_exact(MEMORY).map(memory_from_numbers);
        self.history.accepted = memories.collect();
        let mut values = vec![0.0; nrow * JUDGED];
        from.get(&name("judged"), &mut values)?;
        let judged = values.chunks_exact(JUDGED).map(judged_from_numbers);
        self.accepted_judged = judged.collect();
        self.judged.clone_from(&self.accepted_judged);
        let mut choices = vec![0.0; from.length(&name("choices"))?];
        from.get(&name("choices"), &mut choices)?;
        if !self.accepted.weights.restore_choices(&choices, nrow) {
            return Err(ArchiveError::Length {
                name: name("choices"),
                found: choices.len(),
                expected: 3 * nrow,
            });
        }
        self.now.weights.clone_from(&self.accepted.weights);
        let mut coupled = vec![0.0; from.length(&name("coupled"))?];
        from.get(&name("coupled"), &mut coupled)?;
        let missing = || ArchiveError::Length {
            name: name("coupled"),
            found: coupled.len(),
            expected: nrow,
        };
        self.coupled = Coupled::from_numbers(&coupled, nrow).ok_or_else(missing)?;
        let mut state = [0.0; 6];
        from.get(&name("state"), &mut state)?;
        self.history.work = state[0];
        self.history.damped = [state[5], 0.0];
        self.started = state[1] != 0.0;
        self.first_step = (state[2] >= 0.0).then(|| crate::system::StepContext {
            number: state[2] as usize,
            start: state[3],
            duration: state[4],
            ..self.step
        });
        let mut drift = [0.0; 2];
        self.drift = match from.length(&name("drift"))? {
            0 => None,
            _ => {
                from.get(&name("drift"), &mut drift)?;
                Some((drift[0], drift[1] as u32))
            }
        };
        let mut area = std::mem::take(&mut self.parts.area);
        area.resize(if area.is_empty() { 0 } else { nrow }, 0.0);
        from.get(&name("area"), &mut area)?;
        self.parts.area = area;
        self.ends = Ends::default();
        if let Ok(count) = from.length(&name("ends")) {
            let mut ends = vec![0.0; count];
            from.get(&name("ends"), &mut ends)?;
            self.ends = Ends::from_numbers(&ends);
        }
        if self.parts.cohesion.is_some() {
            let mut torn = vec![0.0; Bonds::length(nrow)];
            from.get(&name("torn"), &mut torn)?;
            self.bonds = Bonds::from_numbers(&torn);
        }
        let mut shifts = vec![0.0; from.length(&name("shifts"))?];
        from.get(&name("shifts"), &mut shifts)?;
        let (shifts, _) = shifts.as_chunks();
        let shift = |&[constant, fading]: &[f64; 2]| Shift { constant, fading };
        self.parts.shifts = shifts.iter().map(shift).collect();
        self.restore_fluid(from)?;
        self.restore_wear(from)?;
        self.restore_heat(from)?;
        self.now.pairs.clone_from(&self.accepted.pairs);
        self.resumed = self.started;
        self.history.begin();
        self.near.search.forget();
        Ok(())
    }

    /// What renewable rows are made of; empty where rows stay.
    fn stored_points(&self) -> Vec<f64> {
        let renewable = self.parts.discretization.capabilities().renewable;
        renewable.map_or_else(Vec::new, Renewable::store)
    }

    pub(super) fn stored_name(&self) -> String {
        let pass = if self.parts.swapped { ".swapped" } else { "" };
        match self.parts.variant {
            0 => format!("{}{pass}", self.parts.name),
            other => format!("{}{pass}.{other}", self.parts.name),
        }
    }
}

fn judged_to_numbers(judged: &Judged) -> [f64; JUDGED] {
    let state = match judged.state {
        Contact::Open => 0.0,
        Contact::Stick => 1.0,
        Contact::Slip => 2.0,
    };
    let (facet, feature) = judged.facet.map_or((-1.0, 0), |(f, k)| (f64::from(f), k));
    [state, facet, f64::from(feature)]
}

fn judged_from_numbers(n: &[f64]) -> Judged {
    let &[state, facet, feature] = n else {
        return Judged::default();
    };
    Judged {
        state: match state as u8 {
            0 => Contact::Open,
            1 => Contact::Stick,
            _ => Contact::Slip,
        },
        facet: (facet >= 0.0).then_some((facet as u32, feature as u8)),
        direction: Vec3::ZERO,
    }
}

fn pair_to_numbers(pair: &Option<Pair>) -> [f64; PAIR] {
    let Some(p) = pair else {
        let mut none = [0.0; PAIR];
        none[0] = -1.0;
        return none;
    };
    let (feature, d) = match p.feature {
        Feature::Face => (0.0, [0.0; 2]),
        Feature::Edge { direction } => (1.0, direction),
        Feature::Vertex => (2.0, [0.0; 2]),
    };
    let (local, held) = (p.anchor.local, p.held.unwrap_or_default());
    let facet = f64::from(p.anchor.facet);
    [
        facet, local.x, local.y, local.z, feature, d[0], d[1], p.gap, held.x, held.y, held.z,
    ]
}

fn pair_from_numbers(n: &[f64]) -> Option<Pair> {
    let &[facet, x, y, z, feature, d0, d1, gap, h0, h1, h2] = n else {
        return None;
    };
    if facet < 0.0 {
        return None;
    }
    let feature = match feature as u8 {
        0 => Feature::Face,
        1 => Feature::Edge {
            direction: [d0, d1],
        },
        _ => Feature::Vertex,
    };
    let held = Vec3::new(h0, h1, h2);
    Some(Pair {
        anchor: Anchor {
            facet: facet as u32,
            local: Vec3::new(x, y, z),
        },
        feature,
        gap,
        held: (held != Vec3::ZERO).then_some(held),
    })
}

fn memory_to_numbers(memory: &Memory) -> [f64; MEMORY] {
    let (facet, local, offset) = memory.anchor.map_or((-1.0, Vec3::ZERO, Vec3::ZERO), |a| {
        (f64::from(a.anchor.facet), a.anchor.local, a.offset)
    });
    let (vector, slip) = (memory.lambda.vector, memory.slip);
    let vectors = [local, offset, vector, slip].map(Vec3::to_array);
    let mut numbers = [0.0; MEMORY];
    numbers[0] = facet;
    numbers[1..13].copy_from_slice(vectors.as_flattened());
    numbers[13] = memory.lambda.scalar;
    numbers[14] = memory.path;
    numbers[15] = memory.gap.unwrap_or(f64::INFINITY);
    numbers
}

fn memory_from_numbers(n: &[f64]) -> Memory {
    let &[facet, a, b, c, o, p, q, u, v, w, x, y, z, scalar, path, gap] = n else {
        return Memory::default();
    };
    let anchor = (facet >= 0.0).then(|| Anchored {
        anchor: Anchor {
            facet: facet as u32,
            local: Vec3::new(a, b, c),
        },
        offset: Vec3::new(o, p, q),
    });
    Memory {
        anchor,
        lambda: Lambda {
            scalar,
            vector: Vec3::new(u, v, w),
        },
        slip: Vec3::new(x, y, z),
        path,
        gap: gap.is_finite().then_some(gap),
    }
}
