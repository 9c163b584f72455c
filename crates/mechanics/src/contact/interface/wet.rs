//! What a fluid between the sides is, and where.

use super::front::Passages;
use signorini_geometry::mesh::NodeId;

/// Numbers of a row in a checkpoint.
const WET: usize = 3;

/// A fluid that may come between the sides of a contact.
#[derive(Clone, Debug, PartialEq)]
pub struct Fluid {
    /// The nodes, of either side, where it is from the start; sorted.
    pub seeds: Vec<NodeId>,
    /// Its pressure at the start and at the end of each step; the last stays.
    pub pressures: Vec<[f64; 2]>,
    /// The contact pressure up to which it enters.
    pub critical: Critical,
    /// The part of a step in which its pressure grows on points that it has just reached.
    pub ramp: f64,
    /// Whether points may dry.
    pub recedes: bool,
}

/// The contact pressure up to which a fluid enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Critical {
    /// This one; 0: it follows where contact is lost.
    Pressure(f64),
    /// Its own.
    Fluid,
}

/// Where a fluid is.
#[derive(Clone, Debug, Default)]
pub(super) struct Wetting {
    /// Nothing before rows are known.
    pub passages: Option<Passages>,
    pub accepted: Vec<Wet>,
    pub trial: Vec<Wet>,
}

/// What a row knows of the fluid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Wet {
    /// When it reached the row, and when its pressure is that of the fluid.
    pub since: Option<[f64; 2]>,
    /// Whether it is there from the start.
    pub is_seed: bool,
}

impl Wet {
    /// The part of the pressure that acts at a time.
    pub fn share(&self, time: f64) -> f64 {
        match self.since {
            None => 0.0,
            Some([_, full]) if time >= full => 1.0,
            Some([from, full]) => ((time - from) / (full - from)).max(0.0),
        }
    }

    pub fn to_numbers(self) -> [f64; WET] {
        let [from, full] = self.since.unwrap_or([f64::INFINITY; 2]);
        [from, full, f64::from(u8::from(self.is_seed))]
    }

    pub fn from_numbers(&[from, full, seed]: &[f64; WET]) -> Self {
        Self {
            since: from.is_finite().then_some([from, full]),
            is_seed: seed != 0.0,
        }
    }
}

impl Wetting {
    /// Rows are others, which go on with what those before them knew.
    pub fn follow(&mut self, origins: &[Option<u32>]) {
        let of = |origin: &Option<u32>| {
            let before = origin.and_then(|row| self.accepted.get(row as usize));
            before.copied().unwrap_or_default()
        };
        self.accepted = origins.iter().map(of).collect();
        self.trial.clone_from(&self.accepted);
        self.passages = None;
    }

    /// The increment was cut.
    pub fn reject(&mut self) {
        self.trial.clone_from(&self.accepted);
    }

    pub fn is_wet(&self, row: usize) -> bool {
        self.trial.get(row).is_some_and(|wet| wet.since.is_some())
    }

    /// A row at a side of the rim that is wet, and that has no row where the fluid is from the start.
    pub fn leak(&self) -> Option<u32> {
        let rims = &self.passages.as_ref()?.rims;
        let is_seed = |row: &u32| self.trial.get(*row as usize).is_some_and(|w| w.is_seed);
        let mut dry = rims.iter().filter(|rim| !rim.iter().any(is_seed));
        dry.find_map(|rim| rim.iter().copied().find(|row| self.is_wet(*row as usize)))
    }
}
