//! Fields of the nodes besides that of the bodies: a hierarchy for each component.
//!
//! A level has one unknown at each node, and aggregates move by constants. What couples components, or fields, is left to
//! the iteration. So is what couples them with the displacements of the bodies where the operator is symmetric; elsewhere a cycle
//! goes through fields first, and bodies take what these leave.

use super::aggregation::MODES;
use super::blocks::Blocks;
use super::hierarchy::Hierarchy;
use super::values::fingerprint;
use crate::problem::{Kept, Values};
use crate::sparsity::NONE;

/// The part of the size of other fields, in the norm of the energy, below which the forces of a field are rounding errors.
const FAINT: f64 = 1e-12;

/// A component of such a field.
pub(super) struct Component {
    /// The raw dof of each row.
    dof: Vec<u32>,
    /// Its equation.
    equation: Vec<u32>,
    hierarchy: Option<Hierarchy<1>>,
    /// The fingerprint of the stiffness that the hierarchy was made of.
    source: Option<u64>,
    /// The mean of the diagonal.
    stiffness: f64,
    b: Vec<[f32; 1]>,
    x: Vec<[f32; 1]>,
}

/// The components of all fields that have a stiffness of their own.
pub(super) fn components(kept: &Kept) -> Vec<Component> {
    let nnode = kept.bulk.nrow() as u32;
    let mut all = Vec::new();
    for field in &kept.fields {
        for k in 0..field.width as u32 {
            let of_nodes = (0..nnode).map(|node| field.first + node * field.width as u32 + k);
            let is_row = |dof: &u32| {
                kept.is_free(*dof as usize) && kept.interface.position(*dof, *dof).is_some()
            };
            let dof: Vec<u32> = of_nodes.filter(is_row).collect();
            let equation = dof.iter().map(|&dof| kept.equation[dof as usize]).collect();
            all.push(Component {
                b: vec![[0.0]; dof.len()],
                x: vec![[0.0]; dof.len()],
                dof,
                equation,
                hierarchy: None,
                source: None,
                stiffness: 0.0,
            });
        }
    }
    all.retain(|component| !component.dof.is_empty());
    all
}

impl Component {
    /// Takes the values of a tangent; false where they are not positive definite.
    pub fn update(&mut self, kept: &Kept, values: &Values) -> bool {
        let matrix = self.matrix(kept, values);
        let source = fingerprint(matrix.value.as_flattened().as_flattened());
        if self.source != Some(source) {
            let mut mode = [0.0; MODES];
            mode[0] = 1.0;
            self.hierarchy = Hierarchy::new(&matrix, &vec![[mode]; self.dof.len()], &[], None);
            self.source = Some(source);
            let diagonal = (0..matrix.nrow()).map(|row| matrix.diagonal(row)[0][0].abs());
            self.stiffness = diagonal.sum::<f64>() / matrix.nrow() as f64;
        }
        self.hierarchy.is_some()
    }

    /// The stiffness over the rows.
    fn matrix(&self, kept: &Kept, values: &Values) -> Blocks<1, 1> {
        let mut row_of = vec![NONE; kept.equation.len()];
        for (row, &dof) in (0..).zip(&self.dof) {
            row_of[dof as usize] = row;
        }
        let mut matrix = Blocks {
            ncolumn: self.dof.len(),
            start: vec![0],
            ..Blocks::default()
        };
        for &dof in &self.dof {
            // rows are in the order of dofs, as columns are
            for (column, at) in kept.interface_row(dof) {
                let column = row_of[column as usize];
                if column != NONE {
                    let value = values.interface.get(at).copied().unwrap_or(0.0);
                    matrix.column.push(column);
                    matrix.value.push([[value]]);
                }
            }
            matrix.start.push(matrix.column.len());
        }
        matrix
    }

    /// One cycle: from residuals at equations to changes.
    pub fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        let Some(hierarchy) = &mut self.hierarchy else {
            return;
        };
        let at = |&e: &u32| r.get(e as usize).copied().unwrap_or(0.0);
        let size = self
            .equation
            .iter()
            .map(at)
            .fold(0.0, |m: f64, r| m.max(r.abs()));
        // single precision has few powers of ten
        let scale = if size > 0.0 { size } else { 1.0 };
        for (b, e) in self.b.iter_mut().zip(&self.equation) {
            *b = [(at(e) / scale) as f32];
        }
        hierarchy.cycle(&self.b, &mut self.x);
        for (&[x], &e) in self.x.iter().zip(&self.equation) {
            if let Some(z) = z.get_mut(e as usize) {
                *z = f64::from(x) * scale;
            }
        }
    }

    /// Takes its part of a vector over.
    pub fn copy(&self, from: &[f64], to: &mut [f64]) {
        for &e in &self.equation {
            if let (Some(to), Some(from)) = (to.get_mut(e as usize), from.get(e as usize)) {
                *to = *from;
            }
        }
    }
}

/// Units of the equations, so that those of all fields are as large; none where there is no field besides the bodies.
#[derive(Default)]
pub(super) struct Units {
    /// The unit of each equation.
    of: Vec<f64>,
    /// The mean of the diagonal of the bodies.
    stiffness: f64,
    scratch: Vec<f64>,
}

impl Units {
    /// Takes the values of a tangent.
    pub fn update(&mut self, kept: &Kept, values: &Values) {
        let nnode = kept.bulk.nrow() as u32;
        let own = (0..nnode).filter_map(|node| kept.bulk.position(node, node));
        let blocks = own.filter_map(|at| values.bulk.get(9 * at..9 * at + 9));
        let (sum, count) = blocks.fold((0.0, 0), |(sum, n), b| {
            (sum + (b[0] + b[4] + b[8]).abs() / 3.0, n + 1)
        });
        self.stiffness = sum / f64::from(count.max(1));
    }

    /// Makes units of the sizes that two lists of residuals have in each field.
    pub fn measure(&mut self, components: &[Component], kept: &Kept, both: [&[f64]; 2]) {
        let [rhs, left] = both;
        self.of.clear();
        if components.is_empty() {
            return;
        }
        let size = |e: usize| rhs[e].abs().max(left[e].abs());
        let mut is_other = vec![false; rhs.len()];
        let of_components = components.iter().map(|component| {
            let equations = component.equation.iter().map(|&e| e as usize);
            equations.fold(0.0, |m: f64, e| {
                is_other[e] = true;
                m.max(size(e))
            })
        });
        let mut sizes: Vec<f64> = of_components.collect();
        let bodies = (0..rhs.len()).filter(|&e| !is_other[e] && kept.sign[e] > 0);
        sizes.push(bodies.map(size).fold(0.0, f64::max));
        let stiffness = components.iter().map(|component| component.stiffness);
        let roots: Vec<f64> = stiffness
            .chain([self.stiffness])
            .map(|k| k.max(f64::MIN_POSITIVE).sqrt())
            .collect();
        let ratios = sizes.iter().zip(&roots).map(|(size, root)| size / root);
        let most = ratios.fold(0.0, f64::max);
        let unit = |k: usize| {
            let unit = sizes[k].max(FAINT * most * roots[k]);
            if unit > 0.0 { unit } else { 1.0 }
        };
        self.of.resize(rhs.len(), unit(components.len()));
        for (k, component) in components.iter().enumerate() {
            let unit = unit(k);
            component
                .equation
                .iter()
                .for_each(|&e| self.of[e as usize] = unit);
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.of.is_empty()
    }

    /// Residuals in these units, or unknowns as they are: `r / unit`.
    pub fn reduce(&self, r: &mut [f64]) {
        r.iter_mut().zip(&self.of).for_each(|(r, unit)| *r /= unit);
    }

    /// Residuals as they are, or unknowns that go with those in units: `r · unit`.
    pub fn restore(&self, r: &mut [f64]) {
        r.iter_mut().zip(&self.of).for_each(|(r, unit)| *r *= unit);
    }

    /// The same as [`Units::reduce`], in a list of its own.
    pub fn divided(&mut self, r: &[f64]) -> Vec<f64> {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.clear();
        scratch.extend(r.iter().zip(&self.of).map(|(r, unit)| r / unit));
        scratch
    }

    /// The same as [`Units::restore`], in a list of its own.
    pub fn multiplied(&mut self, r: &[f64]) -> Vec<f64> {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.clear();
        scratch.extend(r.iter().zip(&self.of).map(|(r, unit)| r * unit));
        scratch
    }

    /// Takes the memory of a list back.
    pub fn keep(&mut self, scratch: Vec<f64>) {
        self.scratch = scratch;
    }

    /// The unit of an equation; 1 where there are none.
    pub fn of(&self, equation: usize) -> f64 {
        self.of.get(equation).copied().unwrap_or(1.0)
    }
}
