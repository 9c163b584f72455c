//! The condensed operator: multipliers eliminated with the equations of their hosts.
//!
//! ```text
//!            others  hosts   λ           P   dofs of hosts that are pivots, one for each multiplier
//!   others  ⎡  K      K      B ⎤         S   B at P: small blocks, triangular as a whole
//!   P       ⎢  K_P    K_PP   S ⎥         E = B S⁻¹
//!   λ       ⎣  C      C      D ⎦
//! ```
//!
//! Unsymmetric: equilibrium at P gives λ = S⁻¹ (r_P − K_P u), every other row loses E times the rows P, and the
//! constraints, which lose D S⁻¹ times them, take the place of the rows P:
//!
//! ```text
//!   (K − E K_P) u = r − E r_P,    (C − D S⁻¹ K_P) u = r_λ − D S⁻¹ r_P                               (E1)
//! ```
//!
//! Symmetric, with C = Bᵀ and D = 0: the constraints give the pivots as well, u_P = d − Eᵀ u with d = S⁻ᵀ r_λ, and
//! with Z the matrix of the motions that satisfy them,
//!
//! ```text
//!   Zᵀ K Z u = Zᵀ (r − K d),   Zᵀ = [1  −E]                                                         (E2)
//! ```
//!
//! is positive definite where K is on these motions. A row P then holds nothing but a diagonal.
//!
//! A multiplier that acts on the host of another, as those of edges do on the corners of a quadratic face, is eliminated
//! before it: S⁻¹ is applied group by group in that order, and multipliers that act on each other's hosts stay unknowns.
//! What is open, a row with nothing but its diagonal, is known beforehand; its host keeps its equation.
//!
//! The bulk stays as it is. What elimination changes goes into the interface, whose pattern here holds for all statuses
//! of the contact: an entry of the bulk that has to vanish meets its own negative there, alone, so that zero is exact.

mod condensed;
mod hosts;

pub use condensed::Condensed;

use crate::problem::{Kept, Problem, Symmetry, Values};
use crate::sparsity::{NONE, Pattern};
use hosts::{Group, Multipliers, Pivots, WIDTH};

/// What stands against a condensation with the present hosts.
#[derive(Debug, PartialEq)]
pub(crate) enum Refusal {
    /// These groups have no pivot in their host.
    Host,
    /// These multipliers cannot be eliminated.
    Stay(Vec<u32>),
    /// An entry has no place in the pattern.
    Pattern,
}

/// The structure of the condensed operator, for one pattern and one choice of hosts.
pub(crate) struct Condensation {
    symmetric: bool,
    pub groups: Vec<Group>,
    /// Per raw dof, the group whose multiplier it is, or `NONE`.
    group_of: Vec<u32>,
    lines: Lines,
    /// The rows that each group changes, its host included.
    supports: Vec<Vec<u32>>,
    /// The interface of the condensed operator, over the raw dofs.
    pub pattern: Pattern,
    /// Its equations.
    pub equation: Vec<u32>,
    pub sign: Vec<i8>,
}

/// The rows of the operator at the hosts, bulk and interface added up.
struct Lines {
    /// The line of each raw dof, or `NONE`.
    number: Vec<u32>,
    start: Vec<usize>,
    column: Vec<u32>,
    bulk_at: Vec<usize>,
    interface_at: Vec<usize>,
}

/// Stands for no place.
const NOWHERE: usize = usize::MAX;

/// The numbers of a condensation.
#[derive(Default)]
pub(crate) struct Numbers {
    /// Closed groups, in the order of elimination.
    order: Vec<u32>,
    /// The pivots of each group.
    pivots: Vec<Pivots>,
    /// The values of the lines.
    line: Vec<f64>,
    /// Columns of E, one for each multiplier of the closed groups in their order.
    start: Vec<usize>,
    row: Vec<u32>,
    value: Vec<f64>,
    /// Per raw dof: the column of E whose pivot it is, or `NONE`.
    pivot: Vec<u32>,
    /// Multiplier and pivot of each column of E.
    pair: Vec<(u32, u32)>,
    /// What the constraint in the place of each pivot was multiplied with.
    scale: Vec<f64>,
    /// The values of the condensed interface.
    pub interface: Vec<f64>,
}

impl Numbers {
    /// The columns of E by rows: where each row begins, and the column and value of each entry.
    fn by_rows(&self, ndof: usize) -> (Vec<usize>, Vec<(u32, f64)>) {
        let mut begin = vec![0usize; ndof + 1];
        self.row.iter().for_each(|&i| begin[i as usize + 1] += 1);
        for i in 0..ndof {
            begin[i + 1] += begin[i];
        }
        let mut next = begin.clone();
        let mut across = vec![(0u32, 0.0); self.row.len()];
        for k in 0..self.pair.len() {
            for (i, e) in self.column(k) {
                across[next[i as usize]] = (k as u32, e);
                next[i as usize] += 1;
            }
        }
        (begin, across)
    }

    fn column(&self, k: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let range = self.start[k]..self.start[k + 1];
        let rows = self.row[range.clone()].iter().copied();
        rows.zip(self.value[range].iter().copied())
    }
}

impl Lines {
    fn new(kept: &Kept, groups: &[Group]) -> Self {
        let mut lines = Self {
            number: vec![NONE; kept.equation.len()],
            start: vec![0],
            column: Vec::new(),
            bulk_at: Vec::new(),
            interface_at: Vec::new(),
        };
        let mut entries: Vec<(u32, usize, usize)> = Vec::new();
        for &dof in groups.iter().flat_map(|g| &g.host) {
            entries.clear();
            let bulk = kept.bulk_row(dof);
            entries.extend(bulk.map(|(column, at)| (column, at, NOWHERE)));
            let range =
                kept.interface.row_start[dof as usize]..kept.interface.row_start[dof as usize + 1];
            entries.extend(range.map(|at| (kept.interface.column[at], NOWHERE, at)));
            entries.retain(|(column, ..)| kept.equation[*column as usize] != NONE);
            entries.sort_unstable_by_key(|&(column, bulk, _)| (column, bulk));
            entries.dedup_by(|second, first| {
                let same = second.0 == first.0;
                if same {
                    first.2 = second.2;
                }
                same
            });
            lines.number[dof as usize] = lines.start.len() as u32 - 1;
            lines.column.extend(entries.iter().map(|e| e.0));
            lines.bulk_at.extend(entries.iter().map(|e| e.1));
            lines.interface_at.extend(entries.iter().map(|e| e.2));
            lines.start.push(lines.column.len());
        }
        lines
    }

    fn gather(&self, values: &Values, out: &mut Vec<f64>) {
        let value = |list: &[f64], at: usize| list.get(at).copied().unwrap_or(0.0);
        let places = self.bulk_at.iter().zip(&self.interface_at);
        out.clear();
        out.extend(places.map(|(&b, &i)| value(values.bulk, b) + value(values.interface, i)));
    }

    fn range(&self, dof: u32) -> std::ops::Range<usize> {
        let line = self.number[dof as usize] as usize;
        self.start[line]..self.start[line + 1]
    }

    fn columns(&self, dof: u32) -> &[u32] {
        &self.column[self.range(dof)]
    }

    /// Columns and values of the row of a dof.
    fn row<'a>(&'a self, dof: u32, line: &'a [f64]) -> impl Iterator<Item = (u32, f64)> + 'a {
        let range = self.range(dof);
        let columns = self.column[range.clone()].iter().copied();
        columns.zip(line[range].iter().copied())
    }
}

impl Condensation {
    /// The structure for these hosts.
    pub fn new(kept: &Kept, multipliers: &Multipliers, groups: Vec<Group>) -> Self {
        let ndof = kept.equation.len();
        let mut group_of = vec![NONE; ndof];
        for (g, group) in groups.iter().enumerate() {
            for &m in &group.multiplier {
                group_of[m as usize] = g as u32;
            }
        }
        let (mut equation, mut sign) = (vec![NONE; ndof], Vec::new());
        for (d, &e) in kept.equation.iter().enumerate() {
            if e != NONE && group_of[d] == NONE {
                equation[d] = sign.len() as u32;
                sign.push(kept.sign[e as usize]);
            }
        }
        let lines = Lines::new(kept, &groups);
        let mut condensation = Self {
            symmetric: kept.symmetry != Symmetry::Unsymmetric,
            groups,
            group_of,
            lines,
            supports: Vec::new(),
            pattern: Pattern::empty(ndof),
            equation,
            sign,
        };
        let columns = |group: &Group| {
            let columns = group.multiplier.iter().map(|&m| multipliers.column(m));
            let rows = columns.flatten().map(|(row, _)| row);
            rows.chain(group.host.iter().copied()).collect()
        };
        condensation.supports = condensation.groups.iter().map(columns).collect();
        condensation.couple(kept);
        condensation
    }

    /// The structure for the hosts that the pattern alone chooses; none where there is nothing to eliminate.
    pub fn by_pattern(kept: &Kept) -> Option<Self> {
        let multipliers = Multipliers::new(kept);
        let ndof = kept.equation.len();
        let groups = multipliers.groups(kept, None, &vec![false; ndof], &vec![NONE; ndof]);
        (!groups.is_empty()).then(|| Self::new(kept, &multipliers, groups))
    }

    /// Makes room for the numbers of an elimination: a multiplier that acts on the host of another changes what that
    /// one acts on, too.
    pub fn grow(&mut self, kept: &Kept, numbers: &Numbers) {
        for (k, &(multiplier, _)) in numbers.pair.iter().enumerate() {
            let g = self.group_of[multiplier as usize] as usize;
            self.supports[g].extend(numbers.column(k).map(|(row, _)| row));
        }
        self.couple(kept);
    }

    /// The condensed problem; its bulk is that of the whole one.
    pub fn problem<'a>(&'a self, kept: &'a Kept) -> Problem<'a> {
        let symmetry = match (self.symmetric, self.sign.iter().all(|&s| s > 0)) {
            (false, _) => Symmetry::Unsymmetric,
            (true, true) => Symmetry::Definite,
            (true, false) => Symmetry::Symmetric,
        };
        Problem {
            ndof: self.equation.len(),
            bulk: &kept.bulk,
            interface: &self.pattern,
            fields: &kept.fields,
            equation: &self.equation,
            nequation: self.sign.len(),
            symmetry,
            sign: &self.sign,
            coordinates: &kept.coordinates,
            between: &kept.between,
        }
    }

    /// Rows that are equations here, each once; the constraint of another group stands in its host.
    fn settle_supports(&mut self) {
        let Self {
            supports,
            group_of,
            groups,
            equation,
            ..
        } = self;
        for (g, rows) in supports.iter_mut().enumerate() {
            let others = rows.iter().map(|&row| group_of[row as usize]);
            let others: Vec<u32> = others.filter(|&o| o != NONE && o as usize != g).collect();
            for other in others {
                rows.extend(&groups[other as usize].host);
            }
            rows.retain(|&row| equation[row as usize] != NONE);
            rows.sort_unstable();
            rows.dedup();
        }
    }

    /// The pattern: the interface without the multipliers, and what elimination adds.
    fn couple(&mut self, kept: &Kept) {
        self.settle_supports();
        let supports = &self.supports;
        let ndof = self.equation.len();
        let mut sets: Vec<&[u32]> = Vec::new();
        let mut joins: Vec<(u32, u32)> = Vec::new();
        let host_of = |dof: u32| self.lines.number[dof as usize];
        let mut group_of_line = Vec::new();
        for (g, group) in self.groups.iter().enumerate() {
            group_of_line.extend(group.host.iter().map(|_| g as u32));
        }
        let mut near: Vec<u32> = Vec::new();
        for (g, group) in self.groups.iter().enumerate() {
            let support = &supports[g];
            near.clear();
            for &host in &group.host {
                let row = sets.len() as u32;
                sets.push(self.lines.columns(host));
                joins.extend(support.iter().map(|&t| (t, row)));
                near.extend(self.lines.columns(host));
            }
            near.sort_unstable();
            near.dedup();
            if self.symmetric {
                let own = sets.len() as u32;
                sets.push(support);
                joins.extend(near.iter().map(|&t| (t, own)));
                joins.extend(support.iter().map(|&t| (t, own)));
                let lines = near.iter().map(|&d| host_of(d)).filter(|&l| l != NONE);
                let mut others: Vec<u32> = lines.map(|l| group_of_line[l as usize]).collect();
                others.dedup();
                for &other in others.iter().filter(|&&o| o as usize != g) {
                    joins.extend(supports[other as usize].iter().map(|&t| (t, own)));
                }
            } else {
                for &m in &group.multiplier {
                    let range = kept.interface.row_start[m as usize]
                        ..kept.interface.row_start[m as usize + 1];
                    let row = sets.len() as u32;
                    sets.push(&kept.interface.column[range]);
                    joins.extend(group.host.iter().map(|&t| (t, row)));
                }
            }
        }
        joins.sort_unstable();
        joins.dedup();
        let mut joins = joins.as_slice();
        let (mut row_start, mut columns) = (vec![0], Vec::new());
        let mut seen = vec![NONE; ndof];
        for row in 0..ndof as u32 {
            let begin = columns.len();
            let (mine, rest) = joins.split_at(joins.partition_point(|join| join.0 <= row));
            joins = rest;
            if self.equation[row as usize] != NONE {
                let own = kept.interface_row(row).map(|(column, _)| column);
                let added = mine
                    .iter()
                    .flat_map(|join| sets[join.1 as usize].iter().copied());
                for column in own.chain(added) {
                    if self.equation[column as usize] != NONE && seen[column as usize] != row {
                        seen[column as usize] = row;
                        columns.push(column);
                    }
                }
                columns[begin..].sort_unstable();
            }
            row_start.push(columns.len());
        }
        self.pattern = Pattern {
            nrow: ndof,
            row_start: row_start.into(),
            column: columns.into(),
        };
    }

    /// Finds pivots and order, and the columns of E.
    pub fn eliminate(
        &self,
        kept: &Kept,
        multipliers: &Multipliers,
        values: &Values,
        numbers: &mut Numbers,
    ) -> Result<(), Refusal> {
        let interface = values.interface;
        numbers.pivots.clear();
        let mut diagonal = Vec::new();
        for group in &self.groups {
            let found = multipliers.pivots(kept, group, interface);
            let pivots = found.ok_or(Refusal::Host)?;
            numbers.pivots.push(pivots);
            let acts = |&(column, at): &(u32, usize)| {
                self.group_of[column as usize] != NONE && interface[at] != 0.0
            };
            let yields = |&&m: &&u32| kept.interface_row(m).any(|entry| acts(&entry));
            if self.symmetric {
                diagonal.extend(pivots.multipliers().iter().filter(yields));
            }
        }
        if !diagonal.is_empty() {
            return Err(Refusal::Stay(diagonal));
        }
        self.sort(multipliers, interface, numbers)?;
        self.lines.gather(values, &mut numbers.line);
        self.spread(multipliers, interface, numbers);
        Ok(())
    }

    /// Sorts the closed groups: each before those on whose pivots it acts. Numbers the columns of E.
    fn sort(
        &self,
        multipliers: &Multipliers,
        interface: &[f64],
        numbers: &mut Numbers,
    ) -> Result<(), Refusal> {
        let Numbers {
            order,
            pivots,
            pivot,
            pair,
            ..
        } = numbers;
        let closed = |g: usize| !pivots[g].rows().is_empty();
        pivot.clear();
        pivot.resize(self.equation.len(), NONE);
        for (g, pivots) in pivots.iter().enumerate() {
            for &p in pivots.rows() {
                pivot[p as usize] = g as u32;
            }
        }
        let after = |g: usize| {
            let columns = pivots[g].multipliers().iter();
            let entries = columns.flat_map(|&m| multipliers.column(m));
            let acts = entries.filter(|&(_, at)| interface[at] != 0.0);
            acts.map(|(row, _)| pivot[row as usize])
                .filter(move |&o| o != NONE && o as usize != g)
        };
        let mut before = vec![0u32; self.groups.len()];
        for g in (0..self.groups.len()).filter(|&g| closed(g)) {
            after(g).for_each(|other| before[other as usize] += 1);
        }
        let waits = |g: &usize| closed(*g) && before[*g] > 0;
        let mut waiting: Vec<usize> = (0..self.groups.len()).filter(waits).collect();
        let free = (0..self.groups.len()).filter(|&g| closed(g) && before[g] == 0);
        order.clear();
        order.extend(free.map(|g| g as u32));
        let mut stay = Vec::new();
        let mut next = 0;
        loop {
            while let Some(&g) = order.get(next) {
                for other in after(g as usize) {
                    let before = &mut before[other as usize];
                    if *before == 1 {
                        order.push(other);
                    }
                    *before = before.saturating_sub(1);
                }
                next += 1;
            }
            // what is left acts on its own pivots in a circle: the group that waits for most stays an unknown
            waiting.retain(|&g| before[g] > 0);
            let Some(&most) = waiting.iter().max_by_key(|&&g| (before[g], usize::MAX - g)) else {
                break;
            };
            stay.extend(pivots[most].multipliers());
            before[most] = 0;
            order.push(most as u32);
        }
        if !stay.is_empty() {
            return Err(Refusal::Stay(stay));
        }
        pivot.fill(NONE);
        pair.clear();
        for &g in order.iter() {
            let pivots = &pivots[g as usize];
            for (&m, &p) in pivots.multipliers().iter().zip(pivots.rows()) {
                pivot[p as usize] = pair.len() as u32;
                pair.push((m, p));
            }
        }
        Ok(())
    }

    /// The columns of E: what the other rows lose per unit of each pivot row.
    fn spread(&self, multipliers: &Multipliers, interface: &[f64], numbers: &mut Numbers) {
        let Numbers {
            order,
            pivots,
            pivot,
            pair,
            start,
            row,
            value,
            ..
        } = numbers;
        let mut rank = vec![NONE; self.groups.len()];
        for (r, &g) in order.iter().enumerate() {
            rank[g as usize] = r as u32;
        }
        let mut sum = vec![0.0; self.equation.len()];
        let mut seen = vec![false; self.equation.len()];
        let mut rows: Vec<u32> = Vec::new();
        let mut due: Vec<u32> = Vec::new();
        start.clear();
        start.push(0);
        row.clear();
        value.clear();
        for &(_, own) in pair.iter() {
            let g = pair[pivot[own as usize] as usize].0;
            due.push(rank[self.group_of[g as usize] as usize]);
            // a unit force on the pivot; each group takes what is on its pivots and hands it on
            sum[own as usize] = -1.0;
            while let Some(first) = due.iter().copied().min() {
                due.retain(|&r| r != first);
                let g = order[first as usize] as usize;
                let pivots = &pivots[g];
                let mut load = [0.0; WIDTH];
                for (load, &p) in load.iter_mut().zip(pivots.rows()) {
                    *load = sum[p as usize];
                }
                for (&m, line) in pivots.multipliers().iter().zip(&pivots.inverse) {
                    let lambda = -line.iter().zip(load).map(|(s, f)| s * f).sum::<f64>();
                    for (i, at) in multipliers.column(m) {
                        let change = interface[at] * lambda;
                        if change == 0.0 {
                            continue;
                        }
                        sum[i as usize] += change;
                        let k = pivot[i as usize];
                        if k != NONE {
                            let other = rank[self.group_of[pair[k as usize].0 as usize] as usize];
                            if other > first && !due.contains(&other) {
                                due.push(other);
                            }
                        } else if !seen[i as usize] {
                            seen[i as usize] = true;
                            rows.push(i);
                        }
                    }
                }
                for &p in pivots.rows() {
                    sum[p as usize] = 0.0;
                }
            }
            rows.sort_unstable();
            for i in rows.drain(..) {
                seen[i as usize] = false;
                let e = std::mem::take(&mut sum[i as usize]);
                if e != 0.0 {
                    row.push(i);
                    value.push(e);
                }
            }
            start.push(row.len());
        }
    }

    /// The values of the condensed interface.
    pub fn fill(&self, kept: &Kept, values: &Values, numbers: &mut Numbers) -> Result<(), Refusal> {
        let ndof = self.equation.len();
        let (begin, across) = numbers.by_rows(ndof);
        let e_row = |dof: u32| &across[begin[dof as usize]..begin[dof as usize + 1]];

        let mut out = std::mem::take(&mut numbers.interface);
        out.clear();
        out.resize(self.pattern.nentry(), 0.0);
        numbers.scale.clear();
        numbers.scale.resize(numbers.pair.len(), 1.0);
        let mut line = Line {
            equation: &self.equation,
            place: vec![NOWHERE; ndof],
            out,
            lost: false,
        };
        let mut bulk = vec![0.0; ndof];
        for row in 0..ndof as u32 {
            let range =
                self.pattern.row_start[row as usize]..self.pattern.row_start[row as usize + 1];
            let columns = &self.pattern.column[range.clone()];
            for (&column, at) in columns.iter().zip(range.clone()) {
                line.place[column as usize] = at;
            }
            let lose = |line: &mut Line, dof: u32| {
                for &(k, e) in e_row(dof) {
                    let pivot = numbers.pair[k as usize].1;
                    for (column, a) in self.lines.row(pivot, &numbers.line) {
                        line.add(column, -e * a);
                    }
                }
            };
            let from_bulk = || {
                kept.bulk_row(row)
                    .map(|(column, at)| (column, values.bulk[at]))
            };
            let from_interface = |dof| {
                kept.interface_row(dof)
                    .map(|(column, at)| (column, values.interface[at]))
            };
            match numbers.pivot[row as usize] {
                _ if columns.is_empty() => {}
                NONE => {
                    from_interface(row).for_each(|(column, a)| line.add(column, a));
                    lose(&mut line, row);
                    let is_pivot = |&column: &u32| numbers.pivot[column as usize] != NONE;
                    if self.symmetric && columns.iter().any(is_pivot) {
                        from_bulk().for_each(|(column, a)| bulk[column as usize] = a);
                        for &column in columns.iter().filter(|c| is_pivot(c)) {
                            let there = bulk[column as usize];
                            let at = line.place[column as usize];
                            let all = there + line.out[at];
                            line.out[at] = -there;
                            for (other, e) in
                                numbers.column(numbers.pivot[column as usize] as usize)
                            {
                                line.add(other, -e * all);
                            }
                        }
                        from_bulk().for_each(|(column, _)| bulk[column as usize] = 0.0);
                    }
                }
                k => {
                    let own = || self.lines.row(row, &numbers.line);
                    let largest = own().fold(0.0, |max: f64, (_, a)| max.max(a.abs()));
                    if self.symmetric {
                        let diagonal = own()
                            .find(|(column, _)| *column == row)
                            .map_or(0.0, |d| d.1);
                        let diagonal = if diagonal == 0.0 {
                            largest
                        } else {
                            diagonal.abs()
                        };
                        line.add(row, diagonal);
                    } else {
                        let multiplier = numbers.pair[k as usize].0;
                        from_interface(multiplier).for_each(|(column, a)| line.add(column, a));
                        lose(&mut line, multiplier);
                        let size = crate::norm::largest(&line.out[range.clone()]);
                        if size > 0.0 && size.is_finite() && largest > 0.0 {
                            let scale = (largest / size).log2().round().exp2();
                            line.out[range.clone()].iter_mut().for_each(|a| *a *= scale);
                            numbers.scale[k as usize] = scale;
                        }
                    }
                    from_bulk().for_each(|(column, a)| line.add(column, -a));
                }
            }
            columns
                .iter()
                .for_each(|&column| line.place[column as usize] = NOWHERE);
        }
        numbers.interface = line.out;
        if line.lost {
            Err(Refusal::Pattern)
        } else {
            Ok(())
        }
    }

    /// The right-hand side of the condensed system. Both are over raw dofs; `x` receives what is known: open
    /// multipliers, and d at the pivots where the system is symmetric.
    pub fn reduce(
        &self,
        kept: &Kept,
        multipliers: &Multipliers,
        values: &Values,
        numbers: &Numbers,
        r: &mut [f64],
        x: &mut [f64],
    ) {
        let interface = values.interface;
        x.fill(0.0);
        for (group, pivots) in self.groups.iter().zip(&numbers.pivots) {
            let closed = pivots.multipliers();
            for &m in group.multiplier.iter().filter(|m| !closed.contains(m)) {
                let diagonal = kept.interface_row(m).find(|(column, _)| *column == m);
                let lambda = diagonal.map_or(0.0, |(_, at)| r[m as usize] / interface[at]);
                x[m as usize] = lambda;
                for (i, at) in multipliers
                    .column(m)
                    .filter(|&(_, at)| interface[at] != 0.0)
                {
                    r[i as usize] -= interface[at] * lambda;
                }
            }
        }
        if self.symmetric {
            for &g in numbers.order.iter().rev() {
                let pivots = &numbers.pivots[g as usize];
                let mut gap = [0.0; WIDTH];
                for (gap, &m) in gap.iter_mut().zip(pivots.multipliers()) {
                    *gap = r[m as usize];
                    for (i, at) in multipliers.column(m) {
                        if numbers.pivot[i as usize] != NONE {
                            *gap -= interface[at] * x[i as usize];
                        }
                    }
                }
                for (a, &p) in pivots.rows().iter().enumerate() {
                    let terms = pivots.inverse.iter().zip(gap);
                    x[p as usize] = terms.map(|(line, gap)| line[a] * gap).sum();
                }
            }
            for &(_, p) in &numbers.pair {
                let d = x[p as usize];
                for (column, a) in self.lines.row(p, &numbers.line) {
                    if d != 0.0 && self.group_of[column as usize] == NONE {
                        r[column as usize] -= a * d;
                    }
                }
            }
        }
        for (k, &(_, p)) in numbers.pair.iter().enumerate() {
            let force = r[p as usize];
            numbers
                .column(k)
                .for_each(|(i, e)| r[i as usize] -= e * force);
        }
        for (&(m, p), scale) in numbers.pair.iter().zip(&numbers.scale) {
            r[p as usize] = if self.symmetric {
                0.0
            } else {
                scale * r[m as usize]
            };
        }
    }

    /// All unknowns from those of the condensed system. `r` is the right-hand side of the whole system, `x` what
    /// [`Condensation::reduce`] left there; both over raw dofs.
    pub fn expand(&self, numbers: &Numbers, y: &[f64], r: &[f64], x: &mut [f64]) {
        for (d, &e) in self
            .equation
            .iter()
            .enumerate()
            .filter(|(_, e)| **e != NONE)
        {
            if !(self.symmetric && numbers.pivot[d] != NONE) {
                x[d] = y[e as usize];
            }
        }
        if self.symmetric {
            for (k, &(_, p)) in numbers.pair.iter().enumerate() {
                let motion: f64 = numbers.column(k).map(|(i, e)| e * x[i as usize]).sum();
                x[p as usize] -= motion;
            }
        }
        for &g in &numbers.order {
            let pivots = &numbers.pivots[g as usize];
            let mut force = [0.0; WIDTH];
            for (force, &p) in force.iter_mut().zip(pivots.rows()) {
                let row = self.lines.row(p, &numbers.line);
                *force = r[p as usize] - row.map(|(column, a)| a * x[column as usize]).sum::<f64>();
            }
            for (&m, line) in pivots.multipliers().iter().zip(&pivots.inverse) {
                x[m as usize] = line.iter().zip(force).map(|(s, f)| s * f).sum();
            }
        }
    }

    /// Whether the numbers are those of these values, as far as bulk goes into them.
    pub fn is_of(&self, values: &Values, numbers: &Numbers) -> bool {
        let mut line = Vec::with_capacity(numbers.line.len());
        self.lines.gather(values, &mut line);
        line == numbers.line
    }

    pub fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// Multipliers that are eliminated as unknowns, or known, with a negative pivot each.
    pub fn neliminated(&self) -> usize {
        self.groups.iter().map(|g| g.multiplier.len()).sum()
    }
}

/// A row of the condensed interface that is added up.
struct Line<'a> {
    equation: &'a [u32],
    place: Vec<usize>,
    out: Vec<f64>,
    /// Something had no place.
    lost: bool,
}

impl Line<'_> {
    fn add(&mut self, column: u32, a: f64) {
        match self.out.get_mut(self.place[column as usize]) {
            Some(out) => *out += a,
            None => self.lost |= a != 0.0 && self.equation[column as usize] != NONE,
        }
    }
}
