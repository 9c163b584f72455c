//! Elements: what they are called, and what they are here.

/// What an element is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Plane stress.
    PlaneStress,
    /// Plane strain.
    PlaneStrain,
    /// Bodies of revolution.
    Axisymmetric,
    /// Solids in space.
    Solid,
    /// Bars.
    Bar,
    /// Facets of contact surfaces.
    Contact,
}

/// An element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Its name, in lower case.
    pub name: &'static str,
    /// Our element with the same nodes in the same order.
    pub element: &'static str,
    /// What it is for.
    pub family: Family,
    /// Integration points unless `NIP` says otherwise.
    pub points: u64,
}

const fn kind(name: &'static str, element: &'static str, family: Family, points: u64) -> Kind {
    Kind {
        name,
        element,
        family,
        points,
    }
}

/// Every element that is read.
pub const ELEMENTS: [Kind; 25] = [
    kind("trplanestress2d", "tri3", Family::PlaneStress, 1),
    kind("planestress2d", "quad4", Family::PlaneStress, 4),
    kind("qplanestress2d", "quad8", Family::PlaneStress, 4),
    kind("qtrplstr", "tri6", Family::PlaneStress, 4),
    kind("trplanestrain", "tri3", Family::PlaneStrain, 1),
    kind("quad1planestrain", "quad4", Family::PlaneStrain, 4),
    kind("qplanestrain", "quad8", Family::PlaneStrain, 4),
    kind("qtrplanestrain", "tri6", Family::PlaneStrain, 4),
    kind("axisymm3d", "tri3", Family::Axisymmetric, 1),
    kind("l4axisymm", "quad4", Family::Axisymmetric, 4),
    kind("q4axisymm", "quad8", Family::Axisymmetric, 4),
    kind("ltrspace", "tet4", Family::Solid, 1),
    kind("qtrspace", "tet10", Family::Solid, 4),
    kind("lspace", "hex8", Family::Solid, 8),
    kind("qspace", "hex20", Family::Solid, 27),
    kind("lwedge", "wedge6", Family::Solid, 9),
    kind("qwedge", "wedge15", Family::Solid, 9),
    kind("truss1d", "line2", Family::Bar, 1),
    kind("truss2d", "line2", Family::Bar, 1),
    kind("truss3d", "line2", Family::Bar, 1),
    kind(
        "structuralcontactelement_linelin",
        "line2",
        Family::Contact,
        2,
    ),
    kind("structuralcontactelement_trlin", "tri3", Family::Contact, 3),
    kind(
        "structuralcontactelement_quadlin",
        "quad4",
        Family::Contact,
        4,
    ),
    kind(
        "structuralcontactelement_linelingauss",
        "line2",
        Family::Contact,
        2,
    ),
    kind(
        "structuralcontactelement_quadlingauss",
        "quad4",
        Family::Contact,
        4,
    ),
];

impl Kind {
    /// The element of a name, in lower case.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        ELEMENTS.iter().copied().find(|one| one.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element::by_name;

    #[test]
    fn every_element_is_one_of_ours() {
        for one in ELEMENTS {
            let element = by_name(one.element).unwrap();
            let dim = match one.family {
                Family::PlaneStress | Family::PlaneStrain | Family::Axisymmetric => 2,
                Family::Solid => 3,
                Family::Bar => 1,
                Family::Contact => element.dim(),
            };
            assert_eq!(element.dim(), dim, "{}", one.name);
            assert_eq!(Kind::of(one.name), Some(one));
        }
    }
}
