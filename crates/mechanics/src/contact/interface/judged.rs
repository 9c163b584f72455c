//! What a verdict compares from iterate to iterate.

use crate::contact::kernel::Contact;
use crate::system::Verdict;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// How many nodes a verdict names.
pub(super) const NAMED: usize = 4;

/// What a verdict compares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Judged {
    pub state: Contact,
    pub facet: Option<(u32, u8)>,
    /// The direction in which it slips.
    pub direction: Vec3,
}

/// What changed from one iterate to the next.
#[derive(Default)]
pub(super) struct Changes {
    pub closed: usize,
    pub opened: usize,
    pub slipping: usize,
    pub sticking: usize,
    pub moved: usize,
    pub turned: usize,
    /// Whether some row that was closed and still is has gone to another facet, whatever else changed there.
    pub elsewhere: bool,
}

impl Changes {
    /// Counts a change; says whether there is one.
    pub fn compare(&mut self, now: &Judged, before: &Judged) -> bool {
        let stays_closed = now.state != Contact::Open && before.state != Contact::Open;
        self.elsewhere |= stays_closed && now.facet != before.facet;
        match (before.state, now.state) {
            (Contact::Open, Contact::Open) => return false,
            (Contact::Open, _) => self.closed += 1,
            (_, Contact::Open) => self.opened += 1,
            (Contact::Stick, Contact::Slip) => self.slipping += 1,
            (Contact::Slip, Contact::Stick) => self.sticking += 1,
            _ if now.facet != before.facet => self.moved += 1,
            _ => return false,
        }
        true
    }

    pub fn verdict(&self, name: &str, nodes: Vec<NodeId>, forgets: bool) -> Verdict {
        let parts = [
            (self.closed, "closed"),
            (self.opened, "opened"),
            (self.slipping, "stick -> slip"),
            (self.sticking, "slip -> stick"),
            (self.moved, "went to another facet"),
            (self.turned, "slip the other way"),
        ];
        let changes = parts.iter().map(|p| p.0).sum();
        if changes == 0 {
            return Verdict::Settled;
        }
        let said = parts.iter().filter(|p| p.0 > 0);
        let said: Vec<String> = said.map(|(n, what)| format!("{n} {what}")).collect();
        Verdict::Repeat {
            changes,
            closing: forgets && changes == self.closed,
            continuous: !self.elsewhere,
            why: format!("contact \"{name}\": {}", said.join(", ")),
            nodes,
        }
    }
}
