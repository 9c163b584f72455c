//! Which cells of a body take part, what removed ones still exert, and where added ones are free of strain: what
//! [`activation`](super::activation) works on.

use crate::material::{Kinematics, Material, Order, Response, Strain};
use crate::system::{
    Activity, Archive, ArchiveError, Dof, Layout, NO_DOF, Sink, State, StepContext, TermError,
};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Sym3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// No step: a cell that never was added free of strain.
const NEVER: f64 = -1.0;

/// Elements that a message names.
const NAMED: usize = 5;

/// Which cells of a block take part, and where they are free of strain.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// Of each cell; empty where all do.
    active: Vec<bool>,
    /// u_0 of the nodes of each cell; empty where it is zero everywhere.
    origin: Vec<f64>,
    /// The step at whose beginning each cell was added free of strain, or [`NEVER`]; empty where none was.
    since: Vec<f64>,
}

impl Part {
    /// Whether a cell takes part.
    pub fn is_active(&self, cell: usize) -> bool {
        self.active.get(cell).copied().unwrap_or(true)
    }

    /// Whether all cells are free of strain where they are undeformed.
    pub const fn is_natural(&self) -> bool {
        self.origin.is_empty()
    }

    /// u_0 at the n unknowns of a cell; nothing where it is zero.
    pub fn origin(&self, cell: usize, n: usize) -> &[f64] {
        let of_cell = self.origin.get(cell * n..(cell + 1) * n);
        of_cell.unwrap_or_default()
    }

    /// The step at whose beginning a cell was added free of strain.
    pub fn since(&self, cell: usize) -> Option<usize> {
        let step = self.since.get(cell).copied().filter(|step| *step >= 0.0);
        step.map(|step| step as usize)
    }

    /// Says which of `ncell` cells take part.
    pub fn set_active(&mut self, ncell: usize, is_active: impl Fn(usize) -> bool) {
        self.active.clear();
        self.active.extend((0..ncell).map(is_active));
    }

    /// One of `ncell` cells is free of strain at these displacements from the beginning of a step on.
    pub fn add(&mut self, cell: usize, ncell: usize, step: usize, u: &[f64]) {
        let n = u.len();
        self.origin.resize(ncell * n, 0.0);
        self.since.resize(ncell, NEVER);
        if let Some(to) = self.origin.get_mut(cell * n..(cell + 1) * n) {
            to.copy_from_slice(u);
        }
        if let Some(since) = self.since.get_mut(cell) {
            *since = step as f64;
        }
    }

    /// Stores it under this name.
    pub fn save(&self, name: &str, out: &mut Archive) {
        out.put(format!("{name}.origin"), &self.origin);
        out.put(format!("{name}.since"), &self.since);
    }

    /// Takes it back: of `ncell` cells with `n` unknowns in all.
    pub fn load(
        &mut self,
        name: &str,
        from: &Archive,
        ncell: usize,
        n: usize,
    ) -> Result<(), ArchiveError> {
        for (values, what, most) in [
            (&mut self.origin, "origin", n),
            (&mut self.since, "since", ncell),
        ] {
            let name = format!("{name}.{what}");
            let found = from.length(&name)?;
            values.clear();
            values.resize(if found == 0 { 0 } else { most }, 0.0);
            from.get(&name, values)?;
        }
        Ok(())
    }
}

/// Forces on nodes.
pub(super) type Forces = BTreeMap<NodeId, [f64; 3]>;

/// Adds the forces of a cell at its nodes, of `ndim` components each.
pub(super) fn gather(forces: &mut Forces, nodes: &[NodeId], of_cell: &[f64], ndim: usize) {
    for (&node, force) in nodes.iter().zip(of_cell.chunks_exact(ndim)) {
        let to = forces.entry(node).or_default();
        to.iter_mut().zip(force).for_each(|(to, f)| *to += f);
    }
}

/// The plan of a body, and how far it has been followed.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub activity: Arc<Activity>,
    /// The step whose changes have been made.
    made: Option<usize>,
    /// Forces of cells that are removed, at whole nodes, as they were when the step began.
    fading: Vec<(Dof, f64)>,
}

impl Plan {
    pub const fn new(activity: Arc<Activity>) -> Self {
        Self {
            activity,
            made: None,
            fading: Vec::new(),
        }
    }

    /// The step whose cells take part.
    pub fn step(&self) -> usize {
        self.made.unwrap_or(0)
    }

    /// Identifies the cells that take part.
    pub fn epoch(&self) -> u64 {
        self.activity.epoch(self.step()) as u64
    }

    /// Whether a step begins whose changes have not been made. Notes that they are.
    pub fn begins(&mut self, step: usize) -> bool {
        let begins = self.made != Some(step);
        if begins {
            self.made = Some(step);
            self.fading.clear();
        }
        begins
    }

    /// Chunks of forces that fall to zero.
    pub fn nchunk(&self) -> usize {
        usize::from(!self.fading.is_empty())
    }

    /// Forces fall to zero from now on: those of whole nodes.
    pub fn fade(&mut self, layout: &Layout, forces: &Forces) {
        for (&node, force) in forces {
            let of_node = (0..layout.ndim()).map(|axis| layout.node(node, axis));
            self.fading
                .extend(of_node.zip(*force).filter(|(dof, _)| *dof != NO_DOF));
        }
    }

    /// How much of them is left.
    fn left(step: &StepContext, time: f64) -> f64 {
        (1.0 - (time - step.start) / step.duration).clamp(0.0, 1.0)
    }

    /// Adds the remaining forces, node by node.
    pub fn exert(&self, layout: &Layout, step: &StepContext, time: f64, out: &mut dyn Sink) {
        let left = Self::left(step, time);
        if left == 0.0 {
            return;
        }
        for of_node in self.fading.chunks(layout.ndim().max(1)) {
            let (mut dofs, mut forces) = ([NO_DOF; 3], [0.0; 3]);
            for ((dof, force), from) in dofs.iter_mut().zip(&mut forces).zip(of_node) {
                (*dof, *force) = (from.0, left * from.1);
            }
            let n = of_node.len().min(3);
            out.add(&dofs[..n], &forces[..n], &[]);
        }
    }

    /// Their potential: forces that are given.
    pub fn energy(&self, step: &StepContext, trial: &State) -> f64 {
        let value = |dof: Dof| trial.u.get(dof as usize).copied().unwrap_or_default();
        let all = self.fading.iter().map(|(dof, force)| force * value(*dof));
        Self::left(step, trial.time) * all.sum::<f64>()
    }

    /// Stores how far it has been followed.
    pub fn save(&self, name: &str, out: &mut Archive) {
        out.put(
            format!("{name}.made"),
            &[self.made.map_or(-1.0, |step| step as f64)],
        );
        let pairs = self
            .fading
            .iter()
            .flat_map(|(dof, force)| [f64::from(*dof), *force]);
        out.put(format!("{name}.fading"), &pairs.collect::<Vec<f64>>());
    }

    /// Takes it back.
    pub fn load(&mut self, name: &str, from: &Archive) -> Result<(), ArchiveError> {
        let mut made = [0.0];
        from.get(&format!("{name}.made"), &mut made)?;
        self.made = (made[0] >= 0.0).then_some(made[0] as usize);
        let fading = format!("{name}.fading");
        let mut pairs = vec![0.0; from.length(&fading)?];
        from.get(&fading, &mut pairs)?;
        let pairs = pairs.as_chunks::<2>().0.iter();
        self.fading = pairs.map(|&[dof, force]| (dof as Dof, force)).collect();
        Ok(())
    }
}

/// Strains at which the tangent of a law is looked at.
const STRAINS: [Sym3; 2] = [Sym3::ZERO, Sym3::new(0.06, -0.04, 0.02, 0.03, -0.02, 0.05)];

/// What tangents may differ by through rounding, relative.
const ROUNDING: f64 = 1e-10;

/// Whether a law without history is linear in the strain of Green and Lagrange: it has one tangent.
pub(super) fn is_linear(material: &dyn Material) -> bool {
    let tangent = |value: Sym3| {
        let mut response = Response::default();
        let strain = Strain::new(Kinematics::Finite, value);
        let answer = material.respond(&strain, &[], &mut [], Order::Tangent, &mut response);
        answer.ok().map(|()| response.tangent)
    };
    if material.nhistory() > 0 {
        return false;
    }
    let [Some(first), Some(second)] = STRAINS.map(tangent) else {
        return false;
    };
    let pairs = first.as_flattened().iter().zip(second.as_flattened());
    let most = first
        .as_flattened()
        .iter()
        .fold(0.0_f64, |most, c| most.max(c.abs()));
    pairs
        .into_iter()
        .all(|(a, b)| (a - b).abs() <= ROUNDING * most)
}

/// The message on elements that are turned inside out where they are added.
pub(super) fn inverted(body: &str, labels: &[u64]) -> TermError {
    let named: Vec<String> = labels.iter().take(NAMED).map(u64::to_string).collect();
    let more = match labels.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let (s, are) = if labels.len() == 1 {
        ("", "is")
    } else {
        ("s", "are")
    };
    TermError::Refused {
        message: format!(
            "element{s} {}{more} of body \"{body}\" {are} turned inside out where this step adds them: nodes without an \
             active element stay where they are while others move; move them along by [[step.move]], or add the elements \
             earlier",
            named.join(", ")
        ),
    }
}
