//! Which contacts closed in a run, and how near the others came.

use crate::text::short;
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use signorini_mechanics::system::Frame;

/// Numbers of a contact in a checkpoint.
const STORED: usize = 4;

/// How near the sides of a contact came.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Nearest {
    /// Whether they touched in any increment.
    closed: bool,
    /// The smallest gap of all increments (length); infinite where nothing was within reach.
    gap: f64,
    /// The node and the time of that.
    node: Option<NodeId>,
    time: f64,
}

/// Watches whether contacts close.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Closure {
    contacts: Vec<Nearest>,
}

impl Closure {
    /// Looks at an accepted increment.
    pub fn look(&mut self, frame: &Frame) {
        let nothing = Nearest {
            closed: false,
            gap: f64::INFINITY,
            node: None,
            time: frame.time,
        };
        self.contacts.resize(frame.contacts.len(), nothing);
        for (nearest, contact) in self.contacts.iter_mut().zip(&frame.contacts) {
            nearest.closed |= contact.nclosed() > 0;
            for (&node, &gap) in contact.nodes.iter().zip(&contact.gap) {
                if gap < nearest.gap {
                    (nearest.gap, nearest.node, nearest.time) = (gap, Some(node), frame.time);
                }
            }
        }
    }

    /// The state, for a checkpoint.
    pub fn save(&self) -> Vec<f64> {
        let numbers = |n: &Nearest| {
            let node = n.node.map_or(-1.0, f64::from);
            [f64::from(u8::from(n.closed)), n.gap, node, n.time]
        };
        self.contacts.iter().flat_map(numbers).collect()
    }

    /// The state from these numbers.
    pub fn restore(stored: &[f64]) -> Self {
        let (contacts, _) = stored.as_chunks::<STORED>();
        let nearest = |&[closed, gap, node, time]: &[f64; STORED]| Nearest {
            closed: closed != 0.0,
            gap,
            node: (node >= 0.0).then_some(node as NodeId),
            time,
        };
        Self {
            contacts: contacts.iter().map(nearest).collect(),
        }
    }

    /// Notes about contacts that never closed, of those that `acts` says acted; `names` are those of frames.
    pub fn notes(
        &self,
        names: &[(String, bool)],
        mesh: &Mesh,
        position: impl Fn(NodeId) -> Vec3,
    ) -> Diagnostics {
        let open = self.contacts.iter().zip(names);
        let open = open.filter(|(nearest, (_, acts))| *acts && !nearest.closed);
        let note = |(nearest, (name, _)): (&Nearest, &(String, bool))| {
            let text = format!("contact \"{name}\" never closed");
            let one = Diagnostic::new(Severity::Note, &codes::NEVER_CLOSED, text);
            let Some(node) = nearest.node.filter(|_| nearest.gap.is_finite()) else {
                return one.note("nothing of the other side came within reach");
            };
            let label = mesh.node_labels.get(node as usize).copied().unwrap_or(0);
            let at = crate::setup::gaps::position(position(node), mesh.dim());
            one.note(format!(
                "the smallest gap was {} at node {label} ({at}) at time {}",
                short(nearest.gap),
                short(nearest.time)
            ))
        };
        let mut found = Diagnostics::new();
        open.map(note).for_each(|one| found.push(one));
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_mechanics::system::ContactFrame;

    fn frame(time: f64, gaps: &[f64]) -> Frame {
        let contact = ContactFrame {
            name: "c".into(),
            nodes: (0..gaps.len() as u32).collect(),
            gap: gaps.to_vec(),
            ..ContactFrame::default()
        };
        Frame {
            time,
            contacts: vec![contact],
            ..Frame::default()
        }
    }

    #[test]
    fn the_smallest_gap_of_all_increments_is_kept_with_its_place_and_time() {
        let mut closure = Closure::default();
        closure.look(&frame(0.5, &[f64::NAN, 3.0, 2.0]));
        closure.look(&frame(1.0, &[f64::NAN, 2.5, 2.2]));
        let mesh = Mesh {
            points: vec![Vec3::ZERO; 3],
            node_labels: vec![11, 12, 13],
            ..Mesh::default()
        };
        let names = [("c".to_owned(), true)];
        let restored = Closure::restore(&closure.save());
        assert_eq!(restored, closure);
        let notes = restored.notes(&names, &mesh, |_| Vec3::ZERO);
        let text = format!("{notes:?}");
        assert!(text.contains("never closed"), "{text}");
        assert!(text.contains("2.00 at node 13"), "{text}");
        assert!(text.contains("at time 0.500"), "{text}");
        let idle = [("c".to_owned(), false)];
        assert!(closure.notes(&idle, &mesh, |_| Vec3::ZERO).is_empty());
    }

    #[test]
    fn where_nothing_was_within_reach_that_is_what_is_said() {
        let mut closure = Closure::default();
        closure.look(&frame(1.0, &[f64::NAN, f64::INFINITY]));
        let names = [("c".to_owned(), true)];
        let notes = closure.notes(&names, &Mesh::default(), |_| Vec3::ZERO);
        assert!(format!("{notes:?}").contains("within reach"));
    }
}
