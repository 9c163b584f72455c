//! Sets and surfaces as the cards of a deck define them, before any number or name in them is looked up.

use super::lines::Spot;
use std::ops::Range;

/// What a set holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    Nodes,
    Cells,
    Faces,
    /// A surface of nodes.
    Points,
}

impl Family {
    pub const fn word(self) -> &'static str {
        match self {
            Self::Nodes => "node set",
            Self::Cells => "element set",
            Self::Faces => "surface",
            Self::Points => "surface of nodes",
        }
    }
}

/// A side of an element as a surface names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// `S1`, `S2`, …
    Number(u8),
    /// `SPOS`: the positive face of a shell.
    Positive,
    /// `SNEG`: the negative face of a shell.
    Negative,
    /// `E1`, `E2`, …: an edge of a shell.
    Edge(u8),
    /// Nothing: the sides that no other element has.
    Free,
}

impl Side {
    pub fn parse(name: &str) -> Option<Self> {
        match name {
            "" => return Some(Self::Free),
            "SPOS" | "SP" => return Some(Self::Positive),
            "SNEG" | "SN" => return Some(Self::Negative),
            _ => {}
        }
        let number = |text: &str| {
            text.parse()
                .ok()
                .filter(|&n| (1..=u8::MAX - 2).contains(&n))
        };
        match name.strip_prefix('E') {
            Some(edge) => number(edge).map(Self::Edge),
            None => number(name.strip_prefix('S')?).map(Self::Number),
        }
    }
}

/// What a line of a surface means.
#[derive(Clone)]
pub(super) enum Region {
    Label(u64),
    Name(String),
}

/// One card that makes a set or adds to it.
#[derive(Clone)]
pub(super) struct Definition {
    pub name: String,
    pub family: Family,
    pub spot: Spot,
    /// The instance whose numbers and names these are.
    pub instance: Option<String>,
    /// Nodes or elements that the card itself defines, by place.
    pub added: Range<usize>,
    pub labels: Vec<u64>,
    /// First, last, step.
    pub ranges: Vec<[u64; 3]>,
    /// Sets of the same family (of nodes, for a surface of nodes).
    pub names: Vec<String>,
    /// Element sets whose nodes are meant.
    pub elsets: Vec<String>,
    pub sides: Vec<(Region, Side)>,
}

impl Definition {
    pub fn new(name: &str, family: Family, spot: Spot) -> Self {
        Self {
            name: name.to_owned(),
            family,
            spot,
            instance: None,
            added: 0..0,
            labels: Vec::new(),
            ranges: Vec::new(),
            names: Vec::new(),
            elsets: Vec::new(),
            sides: Vec::new(),
        }
    }
}
