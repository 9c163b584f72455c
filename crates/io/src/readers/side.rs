use signorini_geometry::element::Side;
use signorini_geometry::mesh::{CellId, Mesh};
use signorini_geometry::tensor::Vec3;
use thiserror::Error;

/// Why a side cannot be determined.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SideError {
    /// Neither an axis nor a number.
    #[error("`{name}` names no side; write an axis such as \"+z\" or a number such as \"S2\"")]
    NotASide {
        /// What was written.
        name: String,
    },
    /// A cell that is not in the mesh.
    #[error("the element does not exist")]
    NoCell,
    /// A number beyond the sides of the element.
    #[error("element {element} ({kind}) has no side {name}; its sides are S1 to S{nside}")]
    NoSuchSide {
        /// The element.
        element: u64,
        /// Its type.
        kind: &'static str,
        /// What was written.
        name: String,
        /// How many sides it has.
        nside: usize,
    },
    /// An element that has no sides, such as a line.
    #[error("element {element} ({kind}) has no sides; name a solid, or a face in the plane")]
    NoSides {
        /// The element.
        element: u64,
        /// Its type.
        kind: &'static str,
    },
    /// No side within one degree of the axis.
    #[error(
        "no side of element {element} ({kind}) faces {name} within 1 degree; the nearest, S{nearest}, is {degrees:.1} degrees off: name it by number"
    )]
    NoneFaces {
        /// The element.
        element: u64,
        /// Its type.
        kind: &'static str,
        /// What was written.
        name: String,
        /// The side that comes nearest, from 1.
        nearest: usize,
        /// How far that one is off.
        degrees: f64,
    },
    /// A cell whose sides have no normals.
    #[error("element {element} ({kind}) is degenerate: no side of it has a normal")]
    Degenerate {
        /// The element.
        element: u64,
        /// Its type.
        kind: &'static str,
    },
}

/// The side of a cell that a user means, from 0: `"S2"` is side 1, `"+z"` the one whose normal in the undeformed
/// mesh is within one degree of that axis.
///
/// # Errors
/// A name that is neither, a number that the element does not have, an axis that no side faces.
///
/// # Example
/// ```
/// use signorini_io::readers::{read_mesh, side_by_normal};
///
/// let deck = b"*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=CPE4\n1, 1, 2, 3, 4\n";
/// let (mesh, _) = read_mesh("plate.inp", deck)?;
/// let cell = mesh.cells(2).next().ok_or("no cells")?;
/// // the second side, from 0 the first, faces +x
/// assert_eq!(side_by_normal(&mesh, cell, "+x"), Ok(1));
/// assert_eq!(side_by_normal(&mesh, cell, "S2"), Ok(1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn side_by_normal(mesh: &Mesh, cell: CellId, name: &str) -> Result<u8, SideError> {
    let element = mesh.element(cell).ok_or(SideError::NoCell)?;
    let label = mesh.cell_label(cell).ok_or(SideError::NoCell)?;
    let kind = element.name();
    let wanted = Wanted::parse(name).ok_or_else(|| SideError::NotASide {
        name: name.chars().take(40).collect(),
    })?;
    let nside = element.sides().len();
    if nside == 0 {
        return Err(SideError::NoSides {
            element: label,
            kind,
        });
    }
    let axis = match wanted {
        Wanted::Number(number) if (1..=nside).contains(&number) => return Ok((number - 1) as u8),
        Wanted::Number(_) => {
            return Err(SideError::NoSuchSide {
                element: label,
                kind,
                name: name.chars().take(40).collect(),
                nside,
            });
        }
        Wanted::Axis(axis) => axis,
    };
    let points: Vec<Vec3> = (mesh.cell(cell).iter())
        .filter_map(|&n| mesh.points.get(n as usize).copied())
        .collect();
    let angles = element.sides().iter().enumerate().filter_map(|(i, side)| {
        let normal = normal(side, &points)?;
        // the angle by its tangent: exact near 0, where its cosine is flat
        Some((i, normal.cross(axis).norm().atan2(normal.dot(axis))))
    });
    let nearest = angles.min_by(|a, b| a.1.total_cmp(&b.1));
    let (side, angle) = nearest.ok_or(SideError::Degenerate {
        element: label,
        kind,
    })?;
    let degrees = angle.to_degrees();
    if degrees <= 1.0 {
        return Ok(side as u8);
    }
    Err(SideError::NoneFaces {
        element: label,
        kind,
        name: name.into(),
        nearest: side + 1,
        degrees,
    })
}

enum Wanted {
    Number(usize),
    Axis(Vec3),
}

impl Wanted {
    fn parse(name: &str) -> Option<Self> {
        if let Some(number) = name.strip_prefix(['S', 's']) {
            return number.parse().ok().map(Self::Number);
        }
        let (sign, axis) = match name.split_at_checked(1)? {
            ("+", axis) => (1.0, axis),
            ("-", axis) => (-1.0, axis),
            _ => return None,
        };
        let axis = match axis {
            "x" | "X" => 0,
            "y" | "Y" => 1,
            "z" | "Z" => 2,
            _ => return None,
        };
        Some(Self::Axis(Vec3::unit(axis) * sign))
    }
}

/// The outward normal in the middle of a side, `t1 × t2`, or `(t_y, -t_x)` in the plane.
fn normal(side: &Side, points: &[Vec3]) -> Option<Vec3> {
    let element = side.element;
    let mut dshape = vec![Vec3::ZERO; element.nnode()];
    element.dshape(&element.centre(), &mut dshape);
    let (mut t1, mut t2) = (Vec3::ZERO, Vec3::ZERO);
    for (dn, &node) in dshape.iter().zip(side.nodes) {
        let x = *points.get(node)?;
        t1 += x * dn.x;
        t2 += x * dn.y;
    }
    match element.dim() {
        1 => Vec3::new(t1.y, -t1.x, 0.0).normalized(),
        _ => t1.normalized()?.cross(t2.normalized()?).normalized(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::readers::build;

    fn brick(shear: f64) -> Mesh {
        let nodes: Vec<(u64, [f64; 3])> = (1..=8)
            .zip([
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [1.0, 1.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [1.0, 0.0, 1.0 + shear],
                [1.0, 1.0, 1.0 + shear],
                [0.0, 1.0, 1.0],
            ])
            .collect();
        build(&nodes, &[(41, "hex8", None, &[1, 2, 3, 4, 5, 6, 7, 8])]).unwrap()
    }

    const CELL: CellId = CellId { block: 0, index: 0 };

    #[test]
    fn axes_name_the_sides_of_a_brick_as_abaqus_numbers_them() {
        let mesh = brick(0.0);
        for (name, number) in [
            ("-z", 1),
            ("+z", 2),
            ("-y", 3),
            ("+x", 4),
            ("+y", 5),
            ("-x", 6),
        ] {
            assert_eq!(side_by_normal(&mesh, CELL, name), Ok(number - 1), "{name}");
            let numbered = format!("S{number}");
            assert_eq!(side_by_normal(&mesh, CELL, &numbered), Ok(number - 1));
        }
    }

    #[test]
    fn edges_of_a_plane_element_face_the_axes() {
        let nodes = [
            (1, [0.0, 0.0, 0.0]),
            (2, [2.0, 0.0, 0.0]),
            (3, [2.0, 1.0, 0.0]),
            (4, [0.0, 1.0, 0.0]),
        ];
        let mesh = build(&nodes, &[(1, "quad4", None, &[1, 2, 3, 4])]).unwrap();
        for (name, side) in [("-y", 0), ("+x", 1), ("+y", 2), ("-x", 3)] {
            assert_eq!(side_by_normal(&mesh, CELL, name), Ok(side));
        }
    }

    #[test]
    fn one_degree_is_the_limit() {
        let slope = |degrees: f64| degrees.to_radians().tan();
        assert_eq!(side_by_normal(&brick(slope(0.99)), CELL, "+z"), Ok(1));
        let error = side_by_normal(&brick(slope(1.5)), CELL, "+z").unwrap_err();
        assert_eq!(
            error.to_string(),
            "no side of element 41 (hex8) faces +z within 1 degree; the nearest, S2, is 1.5 degrees off: name it by number"
        );
    }

    #[test]
    fn names_that_mean_nothing_are_refused() {
        let mesh = brick(0.0);
        let error = side_by_normal(&mesh, CELL, "S9").unwrap_err();
        assert_eq!(
            error.to_string(),
            "element 41 (hex8) has no side S9; its sides are S1 to S6"
        );
        for name in ["", "+", "z", "+w", "S", "S-1", "é", "+zz", "S0"] {
            assert!(side_by_normal(&mesh, CELL, name).is_err(), "{name}");
        }
        let nowhere = CellId { block: 0, index: 1 };
        assert_eq!(side_by_normal(&mesh, nowhere, "+z"), Err(SideError::NoCell));
    }
}
