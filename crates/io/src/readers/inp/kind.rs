//! The element types of Abaqus and CalculiX and what they are here.

use signorini_geometry::element::{self, Element};

/// What an element type means beyond its shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Role {
    /// A solid in space.
    Solid,
    /// A solid in the plane, without strain across it.
    PlaneStrain,
    /// A solid in the plane, without stress across it.
    PlaneStress,
    /// The section of a solid of revolution.
    Axisymmetric,
    /// A shell.
    Shell,
    /// A membrane.
    Membrane,
    /// A bar.
    Truss,
    /// A beam.
    Beam,
    /// A facet of a rigid body.
    Rigid,
    /// A surface without stiffness.
    Surface,
    /// A mass, a spring, a gap, a connector: no cell of a mesh.
    Special,
}

impl Role {
    /// In words.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Solid => "solid",
            Self::PlaneStrain => "plane strain",
            Self::PlaneStress => "plane stress",
            Self::Axisymmetric => "axisymmetric",
            Self::Shell => "shell",
            Self::Membrane => "membrane",
            Self::Truss => "truss",
            Self::Beam => "beam",
            Self::Rigid => "rigid",
            Self::Surface => "surface",
            Self::Special => "no cell of a mesh",
        }
    }

    const fn dim(self) -> usize {
        match self {
            Self::Solid => 3,
            Self::Truss | Self::Beam => 1,
            Self::Special => 0,
            _ => 2,
        }
    }
}

/// Sizes of a family: the digits behind its letters, the nodes of a cell, the element here ("" for none).
type Sizes = &'static [(&'static str, usize, &'static str)];

const SOLIDS: Sizes = &[
    ("4", 4, "tet4"),
    ("5", 5, ""),
    ("6", 6, "wedge6"),
    ("8", 8, "hex8"),
    ("10", 10, "tet10"),
    ("13", 13, ""),
    ("15", 15, "wedge15"),
    ("20", 20, "hex20"),
    // its order of the nodes in the middle differs, and some may be missing
    ("27", 27, ""),
];
const FACES: Sizes = &[
    ("3", 3, "tri3"),
    ("4", 4, "quad4"),
    ("6", 6, "tri6"),
    ("8", 8, "quad8"),
    ("9", 9, "quad9"),
];
const SHELLS: Sizes = &[
    ("3", 3, "tri3"),
    ("4", 4, "quad4"),
    ("6", 6, "tri6"),
    ("8", 8, "quad8"),
    ("9", 9, "quad9"),
    // with five unknowns per node
    ("45", 4, "quad4"),
    ("85", 8, "quad8"),
    ("95", 9, "quad9"),
];
const LINES: Sizes = &[("2", 2, "line2"), ("3", 3, "line3")];
const BY_ORDER: Sizes = &[("1", 2, "line2"), ("2", 3, "line3")];
const BEAMS: Sizes = &[("1", 2, "line2"), ("2", 3, "line3"), ("3", 2, "line2")];
const ONE: Sizes = &[("", 1, ""), ("1", 1, "")];

/// Every family: the letters of its types, its role, its sizes. Letters for the integration follow (`C3D20R`).
///
/// Source: Abaqus Analysis User's Guide, element index; CalculiX CrunchiX User's Manual, section 6.2. Node orders are
/// those of the elements here, which follow Abaqus.
#[rustfmt::skip]
const FAMILIES: [(&str, Role, Sizes); 43] = [
    ("C3D", Role::Solid, SOLIDS), ("DC3D", Role::Solid, SOLIDS), ("AC3D", Role::Solid, SOLIDS),
    ("SC", Role::Solid, &[("6", 6, ""), ("8", 8, "")]),
    ("COH3D", Role::Solid, &[("6", 6, ""), ("8", 8, "")]),
    ("CPE", Role::PlaneStrain, FACES), ("CPEG", Role::PlaneStrain, FACES), ("CPS", Role::PlaneStress, FACES),
    ("CAX", Role::Axisymmetric, FACES), ("CGAX", Role::Axisymmetric, FACES), ("DCAX", Role::Axisymmetric, FACES),
    ("DC2D", Role::PlaneStrain, FACES), ("AC2D", Role::PlaneStrain, FACES),
    ("COH2D", Role::PlaneStrain, &[("4", 4, "")]), ("COHAX", Role::Axisymmetric, &[("4", 4, "")]),
    ("S", Role::Shell, SHELLS), ("DS", Role::Shell, FACES), ("STRI", Role::Shell, &[("3", 3, "tri3"), ("65", 6, "tri6")]),
    ("M3D", Role::Membrane, FACES), ("SFM3D", Role::Surface, FACES), ("F3D", Role::Surface, FACES),
    ("R3D", Role::Rigid, FACES),
    ("R2D", Role::Truss, LINES), ("RAX", Role::Truss, LINES),
    ("T2D", Role::Truss, LINES), ("T3D", Role::Truss, LINES),
    ("B2", Role::Beam, BEAMS), ("B3", Role::Beam, BEAMS), ("PIPE2", Role::Beam, BEAMS), ("PIPE3", Role::Beam, BEAMS),
    ("SAX", Role::Beam, BY_ORDER), ("MAX", Role::Beam, BY_ORDER), ("SFMAX", Role::Beam, BY_ORDER),
    // of networks, whose ends have nodes of number 0
    ("D", Role::Special, &[("", 0, "")]),
    ("MASS", Role::Special, ONE), ("ROTARYI", Role::Special, ONE), ("HEATCAP", Role::Special, ONE),
    ("DCOUP", Role::Special, &[("2D", 1, ""), ("3D", 1, "")]),
    ("SPRING", Role::Special, &[("1", 1, ""), ("2", 2, ""), ("", 2, "")]),
    ("DASHPOT", Role::Special, &[("1", 1, ""), ("2", 2, ""), ("", 2, "")]),
    ("GAP", Role::Special, &[("", 2, "")]),
    ("CONN", Role::Special, &[("2D2", 2, ""), ("3D2", 2, "")]),
    ("JOINTC", Role::Special, &[("", 2, "")]),
];

/// An element type.
#[derive(Clone, Debug)]
pub(super) struct Kind {
    /// As in the deck, in capitals.
    pub name: String,
    /// What it means.
    pub role: Role,
    /// Nodes of a cell; 0 where only the user who made the type knows.
    pub nnode: usize,
    /// The element here.
    pub element: Option<Element>,
}

impl Kind {
    /// The type of this name, in capitals; nothing for names that nobody knows.
    pub fn find(name: &str) -> Option<Self> {
        let kind = |role, nnode, element| Self {
            name: name.to_owned(),
            role,
            nnode,
            element,
        };
        let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        if name
            .strip_prefix('U')
            .is_some_and(|n| n.len() < 5 && is_number(n))
        {
            return Some(kind(Role::Special, 0, None));
        }
        let fits = |(letters, role, sizes): &(&str, Role, Sizes)| {
            let rest = name.strip_prefix(letters)?;
            let (_, nnode, element) = sizes.iter().rfind(|(digits, ..)| {
                // shells of five unknowns per node have the digits apart: S8R5
                let (size, five) = match *digits {
                    "45" | "85" | "95" => (digits.get(..1).unwrap_or_default(), true),
                    digits => (digits, false),
                };
                let suffix = rest.strip_prefix(size);
                let suffix = match (suffix, five) {
                    (Some(suffix), true) => suffix.strip_suffix('5'),
                    (suffix, _) => suffix,
                };
                suffix.is_some_and(|s| s.len() < 5 && s.bytes().all(|b| b.is_ascii_uppercase()))
            })?;
            Some(kind(*role, *nnode, element::by_name(element)))
        };
        FAMILIES.iter().find_map(fits)
    }

    /// Whether it is a spring.
    pub fn is_spring(&self) -> bool {
        self.name.starts_with("SPRING")
    }

    /// Whether it is a point with a mass, or with moments of inertia.
    pub fn is_mass(&self) -> bool {
        ["MASS", "ROTARYI"].contains(&self.name.as_str())
    }

    /// The dimension of a cell, 0 where the type is no cell.
    pub fn dim(&self) -> usize {
        self.role.dim()
    }
}

/// What elements of a type are that no solid section makes solids of: shells, say; nothing for solids and trusses.
pub(crate) fn without_volume(name: &str) -> Option<&'static str> {
    let kind = Kind::find(name)?;
    let is_solid = match kind.role {
        Role::Solid | Role::PlaneStrain | Role::PlaneStress | Role::Axisymmetric => true,
        Role::Truss => name.starts_with('T'),
        _ => false,
    };
    (!is_solid).then(|| kind.role.word())
}

/// The types that can be read, for messages.
pub(super) fn supported() -> String {
    let sizes = |(letters, _, sizes): &(&str, Role, Sizes)| {
        let known: Vec<&str> = (sizes.iter())
            .filter(|(digits, _, name)| digits.len() < 3 && element::by_name(name).is_some())
            .map(|(digits, ..)| *digits)
            .filter(|digits| !["45", "85", "95", "65"].contains(digits))
            .collect();
        (!known.is_empty()).then(|| format!("{letters}{}", known.join("/")))
    };
    let shown = ["C3D", "CPE", "CPS", "CAX", "S", "M3D", "T3D", "B3"];
    let families = FAMILIES
        .iter()
        .filter(|(letters, ..)| shown.contains(letters));
    families.filter_map(sizes).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_give_role_and_number_of_nodes() {
        for (name, role, nnode) in [
            ("C3D4", Role::Solid, 4),
            ("C3D8", Role::Solid, 8),
            ("C3D8R", Role::Solid, 8),
            ("C3D8I", Role::Solid, 8),
            ("C3D8IH", Role::Solid, 8),
            ("C3D10MH", Role::Solid, 10),
            ("C3D15", Role::Solid, 15),
            ("C3D20RT", Role::Solid, 20),
            ("CPE4RH", Role::PlaneStrain, 4),
            ("CPE6", Role::PlaneStrain, 6),
            ("CPS8R", Role::PlaneStress, 8),
            ("CPS3", Role::PlaneStress, 3),
            ("CAX8R", Role::Axisymmetric, 8),
            ("S3", Role::Shell, 3),
            ("S4R", Role::Shell, 4),
            ("S4R5", Role::Shell, 4),
            ("S8R5", Role::Shell, 8),
            ("STRI65", Role::Shell, 6),
            ("M3D4R", Role::Membrane, 4),
            ("SFM3D4", Role::Surface, 4),
            ("R3D4", Role::Rigid, 4),
            ("T2D2", Role::Truss, 2),
            ("T3D3", Role::Truss, 3),
            ("B31", Role::Beam, 2),
            ("B32R", Role::Beam, 3),
            ("SAX1", Role::Beam, 2),
            ("MASS", Role::Special, 1),
            ("ROTARYI", Role::Special, 1),
            ("SPRINGA", Role::Special, 2),
            ("SPRING1", Role::Special, 1),
            ("GAPUNI", Role::Special, 2),
            ("CONN3D2", Role::Special, 2),
            ("DCOUP3D", Role::Special, 1),
            ("U1", Role::Special, 0),
            ("D", Role::Special, 0),
            ("DC3D8", Role::Solid, 8),
        ] {
            let kind = Kind::find(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((kind.role, kind.nnode), (role, nnode), "{name}");
        }
        for name in [
            "", "C3D", "C3D7", "C3D80", "CPS", "HEX8", "C3D8-R", "S5", "U", "c3d8",
        ] {
            assert!(Kind::find(name).is_none(), "{name}");
        }
    }

    #[test]
    fn every_element_here_has_the_dimension_and_the_nodes_of_its_types() {
        for (letters, role, sizes) in FAMILIES {
            for (digits, nnode, name) in sizes {
                if let Some(element) = element::by_name(name) {
                    let found = (element.dim(), element.nnode());
                    assert_eq!(found, (role.dim(), *nnode), "{letters}{digits}");
                }
            }
        }
    }
}
