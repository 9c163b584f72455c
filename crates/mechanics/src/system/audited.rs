use signorini_geometry::mesh::NodeId;

/// What an audit of a contact looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Check {
    /// Nodes under pressure whose surroundings are apart from the other side.
    Apart,
    /// Depths to which one side is inside the other.
    Through,
    /// Tractions along other directions than the true normal and friction allow.
    Direction,
    /// Tractions that the stress of the adjoining elements does not carry.
    Stress,
}

impl Check {
    /// All of them, in the order of [`ContactAudit::checks`].
    pub const ALL: [Self; 4] = [Self::Apart, Self::Through, Self::Direction, Self::Stress];

    /// Its name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Apart => "apart",
            Self::Through => "through",
            Self::Direction => "direction",
            Self::Stress => "stress",
        }
    }
}

/// What a check measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    /// How much is wrong, as a part: of the contact force for [`Check::Apart`], [`Check::Direction`] and
    /// [`Check::Stress`], of the size of a facet for [`Check::Through`].
    pub part: f64,
    /// The part up to which it passes.
    pub limit: f64,
    /// The worst value: a distance for the first two checks, shear over normal traction for the third, traction for the
    /// last.
    pub worst: f64,
    /// Its limit.
    pub allowed: f64,
    /// The pressure where it is worst.
    pub pressure: f64,
    /// The worst nodes of the secondary side, a handful at most; the worst first.
    pub nodes: Vec<NodeId>,
}

impl Measured {
    /// Whether it is within its limit.
    #[must_use]
    pub fn passes(&self) -> bool {
        // NaN fails, too
        self.part <= self.limit
    }
}

/// What the audit of an accepted state found at one contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactAudit {
    /// Name of the contact.
    pub name: String,
    /// Nodes of the secondary side under pressure.
    pub nclosed: usize,
    /// Sum of the sizes of the tractions on them, times their areas.
    pub force: f64,
    /// The checks, in the order of [`Check::ALL`].
    pub checks: [Measured; 4],
}

impl ContactAudit {
    /// What a check measured.
    #[must_use]
    pub const fn of(&self, check: Check) -> &Measured {
        let [apart, through, direction, stress] = &self.checks;
        match check {
            Check::Apart => apart,
            Check::Through => through,
            Check::Direction => direction,
            Check::Stress => stress,
        }
    }

    /// The checks that do not pass.
    pub fn failures(&self) -> impl Iterator<Item = (Check, &Measured)> {
        let each = Check::ALL.into_iter().zip(&self.checks);
        each.filter(|(_, measured)| !measured.passes())
    }
}
