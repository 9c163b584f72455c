//! Rows of contacts whose multipliers act on nothing that moves: said once, at the end of a run.

use crate::text::plural;
use signorini_geometry::mesh::Mesh;
use signorini_io::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use signorini_mechanics::system::{Frame, IdleRows};

/// Numbers of a contact in a checkpoint.
const STORED: usize = 5;

/// Watches for such rows: keeps the largest number of each kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Idle {
    contacts: Vec<IdleRows>,
}

impl Idle {
    /// Looks at an accepted increment.
    pub fn look(&mut self, frame: &Frame) {
        self.contacts
            .resize(frame.contacts.len(), IdleRows::default());
        for (most, contact) in self.contacts.iter_mut().zip(&frame.contacts) {
            most.whole = most.whole.max(contact.idle.whole);
            for (most, now) in most.friction.iter_mut().zip(contact.idle.friction) {
                *most = (*most).max(now);
            }
            most.node = most.node.or(contact.idle.node);
        }
    }

    /// The state, for a checkpoint.
    pub fn save(&self) -> Vec<f64> {
        let numbers = |rows: &IdleRows| {
            let [x, y, z] = rows.friction.map(|n| n as f64);
            [
                rows.whole as f64,
                x,
                y,
                z,
                rows.node.map_or(-1.0, f64::from),
            ]
        };
        self.contacts.iter().flat_map(numbers).collect()
    }

    /// The state from these numbers.
    pub fn restore(stored: &[f64]) -> Self {
        let (contacts, _) = stored.as_chunks::<STORED>();
        let rows = |&[whole, x, y, z, node]: &[f64; STORED]| IdleRows {
            whole: whole as usize,
            friction: [x, y, z].map(|n| n as usize),
            node: (node >= 0.0).then_some(node as u32),
        };
        Self {
            contacts: contacts.iter().map(rows).collect(),
        }
    }

    /// A note for each contact that has such rows and whose sides somebody chose; `names` are those of frames, each with
    /// that.
    pub fn notes(&self, names: &[(String, bool)], mesh: &Mesh) -> Diagnostics {
        let mut found = Diagnostics::new();
        for (rows, (name, is_chosen)) in self.contacts.iter().zip(names) {
            if *is_chosen && !rows.is_empty() {
                found.push(note(rows, name, mesh));
            }
        }
        found
    }
}

fn note(rows: &IdleRows, name: &str, mesh: &Mesh) -> Diagnostic {
    let text = format!("contact \"{name}\" acts on nothing that moves at some of its nodes");
    let mut one = Diagnostic::new(Severity::Note, &codes::IDLE_ROWS, text);
    if rows.whole > 0 {
        let many = plural(rows.whole, "node");
        one = one.note(format!("{many} without pressure and friction"));
    }
    for (axis, &n) in ["x", "y", "z"].iter().zip(&rows.friction) {
        if n > 0 {
            one = one.note(format!(
                "{} without friction along {axis}",
                plural(n, "node")
            ));
        }
    }
    one = one.help("take the supports off the nodes of the contact");
    let label = rows
        .node
        .and_then(|node| mesh.node_labels.get(node as usize));
    if let Some(label) = label {
        one = one.note(format!(
            "such as node {label}: it is prescribed, and so is the other side there"
        ));
    }
    one
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_mechanics::system::ContactFrame;

    #[test]
    fn the_largest_numbers_are_kept_and_said_with_a_node() {
        let frame = |whole, y| Frame {
            contacts: vec![ContactFrame {
                idle: IdleRows {
                    whole,
                    friction: [0, y, 0],
                    node: Some(1),
                },
                ..ContactFrame::default()
            }],
            ..Frame::default()
        };
        let mut idle = Idle::default();
        idle.look(&frame(2, 5));
        idle.look(&frame(1, 7));
        assert_eq!(Idle::restore(&idle.save()), idle);
        let mesh = Mesh {
            node_labels: vec![10, 20],
            ..Mesh::default()
        };
        let text = format!("{:?}", idle.notes(&[("c".into(), true)], &mesh));
        for said in [
            "2 nodes without pressure",
            "7 nodes without friction along y",
            "node 20",
        ] {
            assert!(text.contains(said), "{text}");
        }
        let nothing = Idle::restore(&[0.0, 0.0, 0.0, 0.0, -1.0]);
        assert!(nothing.notes(&[("c".into(), true)], &mesh).is_empty());
    }
}
