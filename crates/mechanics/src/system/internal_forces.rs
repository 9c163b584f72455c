//! Forces of solids on nodes, and heat that they take from nodes.

use super::{
    Directors, Dof, DofName, Layout, NodeId, Order, Role, Sink, State, Term, TermError, Work,
};
use rayon::prelude::*;
use signorini_geometry::tensor::Vec3;

/// Chunks whose forces are found before their nodes take them: bounds the memory.
const CHUNKS: usize = 256;

/// What all terms within do at the nodes, whatever follows whatever.
pub(super) struct Internal {
    /// Forces.
    pub forces: Vec<Vec3>,
    /// Heat per time that leaves the nodes; empty without temperatures.
    pub heat: Vec<f64>,
}

/// What all terms within do at the nodes, and at the unknowns of directors by their ends.
pub(super) fn internal_forces(
    terms: &[Box<dyn Term>],
    (layout, directors): (&Layout, &Directors),
    state: &State,
) -> Result<Internal, TermError> {
    let mut at_nodes = vec![Vec3::ZERO; layout.nnode()];
    let mut heat = match layout.has_temperatures() {
        true => vec![0.0; layout.nnode()],
        false => Vec::new(),
    };
    let internal = terms
        .iter()
        .filter(|term| term.properties().role == Role::Internal);
    for term in internal {
        let chunks: Vec<usize> = (0..term.nchunk()).collect();
        for wave in chunks.chunks(CHUNKS) {
            // chunks in parallel, nodes in their order
            let evaluate = |work: &mut Work, &chunk: &usize| {
                let mut forces = Forces::default();
                term.evaluate(chunk, state, Order::Residual, work, &mut forces)?;
                Ok(forces)
            };
            let evaluated = wave.par_iter().map_init(Work::default, evaluate);
            let evaluated: Vec<Result<Forces, TermError>> = evaluated.collect();
            for forces in evaluated {
                for (dof, force) in forces?.0 {
                    let name = layout.name(dof);
                    if let Some((node, axis)) = name.and_then(DofName::displacement) {
                        if let Some(to) = at_nodes.get_mut(node as usize) {
                            to[axis] += force;
                        }
                    } else if let Some(name) = name
                        && layout.temperature(name.entity) == dof
                        && let Some(to) = heat.get_mut(name.entity as usize)
                    {
                        *to += force;
                    }
                }
            }
        }
    }
    for director in directors.all() {
        let force = |node: NodeId| at_nodes.get(node as usize).copied().unwrap_or_default();
        let [low, high] = director.ends.map(force);
        for (node, more) in [(director.middle, high + low), (director.half, high - low)] {
            if let Some(to) = at_nodes.get_mut(node as usize) {
                *to += more;
            }
        }
    }
    Ok(Internal {
        forces: at_nodes,
        heat,
    })
}

/// Forces as they come.
#[derive(Default)]
struct Forces(Vec<(Dof, f64)>);

impl Sink for Forces {
    fn add(&mut self, dofs: &[Dof], force: &[f64], _: &[f64]) {
        self.0
            .extend(dofs.iter().copied().zip(force.iter().copied()));
    }

    fn add_symmetric(&mut self, dofs: &[Dof], force: &[f64], _: &[f64], _: usize) {
        self.add(dofs, force, &[]);
    }

    fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}
