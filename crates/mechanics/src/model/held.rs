use super::{BodyPart, ModelError};
use crate::solve::Step;
use crate::system::{DofName, Elimination, Layout};
use signorini_geometry::mesh::{Mesh, NodeId};
use std::collections::BTreeSet;

/// Which deformable bodies hang together, and what holds them.
pub(super) struct Held {
    /// Representative node of each node's part; nodes of no deformable cell stand alone.
    root: Vec<NodeId>,
    /// One node of each body.
    sample: Vec<Option<NodeId>>,
}

impl Held {
    pub fn new(mesh: &Mesh, bodies: &[BodyPart]) -> Self {
        let mut root: Vec<NodeId> = (0..mesh.nnode() as NodeId).collect();
        fn find(root: &mut [NodeId], mut n: NodeId) -> NodeId {
            while root[n as usize] != n {
                root[n as usize] = root[root[n as usize] as usize];
                n = root[n as usize];
            }
            n
        }
        let mut sample = Vec::new();
        for body in bodies {
            for &cell in &body.cells {
                let nodes = mesh.cell(cell);
                for pair in nodes.windows(2) {
                    let (a, b) = (find(&mut root, pair[0]), find(&mut root, pair[1]));
                    root[a.max(b) as usize] = a.min(b);
                }
            }
            let first = body.cells.first().map(|&c| mesh.cell(c));
            let deformable = body.kind.material().is_some();
            sample.push(
                first
                    .and_then(|n| n.first().copied())
                    .filter(|_| deformable),
            );
        }
        for n in 0..root.len() as NodeId {
            root[n as usize] = find(&mut root, n);
        }
        Self { root, sample }
    }

    /// Bodies held by contact alone; an error for one that nothing holds.
    pub fn judge(
        &self,
        names: &[String],
        layout: &Layout,
        steps: &[Step],
        elimination: &Elimination,
        tied: &BTreeSet<NodeId>,
        touching: &BTreeSet<NodeId>,
    ) -> Result<Vec<String>, ModelError> {
        let root = |node: NodeId| self.root.get(node as usize).copied();
        let mut supported: BTreeSet<NodeId> = BTreeSet::new();
        let first = steps.first().map_or(&[][..], |s| &s.prescriptions);
        for p in first {
            if let Some(DofName::Node(node, _)) = layout.name(p.dof) {
                supported.extend(root(node));
            }
        }
        for body in elimination.bodies() {
            supported.extend(body.nodes.iter().filter_map(|&n| root(n)));
        }
        supported.extend(tied.iter().filter_map(|&n| root(n)));
        let touched: BTreeSet<NodeId> = touching.iter().filter_map(|&n| root(n)).collect();
        let mut by_contact = Vec::new();
        for (name, sample) in names.iter().zip(&self.sample) {
            let Some(part) = sample.and_then(root) else {
                continue;
            };
            if supported.contains(&part) {
                continue;
            }
            if !touched.contains(&part) {
                return Err(ModelError::FreeBody { body: name.clone() });
            }
            by_contact.push(name.clone());
        }
        Ok(by_contact)
    }
}
