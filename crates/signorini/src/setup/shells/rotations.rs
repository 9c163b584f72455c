//! Rotations that supports hold at nodes of shells: directors that do not turn.

use super::solids::Shells;
use signorini_geometry::expansion::Director;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;
use signorini_io::case::Name;
use signorini_mechanics::model::{ConstraintKind, ConstraintPart, Unknown};
use std::collections::BTreeMap;

/// The sine of the angle, 20 degrees, within which the parts of held axes in the plane of a shell count as one axis: normals of
/// elements differ by as much from that of the surface.
const ALIKE: f64 = 0.342;

/// The part of a held axis in the plane of a shell that is rounding.
const NORMAL: f64 = 1e-6;

/// Rotations that supports hold.
#[derive(Default)]
pub(in crate::setup) struct Rotations {
    /// About which axes, of each node, and a support that does.
    held: BTreeMap<NodeId, ([bool; 3], String)>,
}

impl Rotations {
    /// Whether all these rotations of a node are held.
    pub fn holds(&self, node: NodeId, about: [bool; 3]) -> bool {
        let held = self.held.get(&node).map(|one| one.0).unwrap_or_default();
        held.iter().zip(about).all(|(held, about)| *held || !about)
    }

    /// Holds rotations of nodes about some axes, in the whole run.
    pub fn hold(&mut self, nodes: &[NodeId], about: [bool; 3], on: &Name) {
        for &node in nodes {
            let held = self.held.entry(node);
            let (held, _) = held.or_insert_with(|| ([false; 3], on.value.clone()));
            held.iter_mut()
                .zip(about)
                .for_each(|(held, about)| *held |= about);
        }
    }

    /// They as constraints: those of all supports of a node together, for axes in the plane of a shell may be alike.
    pub fn parts(&self, shells: &Shells) -> Vec<ConstraintPart> {
        let held = self.held.iter().flat_map(|(&node, (about, on))| {
            let directors = shells.directors_at(node).iter();
            directors.flat_map(move |director| equations(director, *about, on))
        });
        held.collect()
    }
}

/// What keeps a director from turning about axes: `d·(a × n) = 0` for each axis `a` in the plane of the shell. The part of an axis along
/// the normal turns nothing.
fn equations<'a>(
    director: &'a Director,
    about: [bool; 3],
    on: &'a str,
) -> impl Iterator<Item = ConstraintPart> + 'a {
    still(director.normal, about).into_iter().map(move |along| {
        let terms = (0..3).map(|axis| (Unknown::Node(director.half, axis), along[axis]));
        let kind = ConstraintKind::Equation {
            terms: terms.filter(|(_, factor)| *factor != 0.0).collect(),
            rhs: 0.0,
        };
        ConstraintPart {
            name: format!("held rotations of \"{on}\""),
            kind,
        }
    })
}

/// The directions that half a director does not move along, none, one or two.
fn still(normal: Vec3, about: [bool; 3]) -> Vec<Vec3> {
    let smallest = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()));
    let first = Vec3::unit(smallest.unwrap_or_default()).cross(normal);
    let Some(first) = first.normalized() else {
        return Vec::new();
    };
    let second = normal.cross(first);
    // Σ t tᵀ of the axes in the plane
    let axes = (0..3).filter(|&axis| about[axis]).map(Vec3::unit);
    let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
    for axis in axes {
        let (x, y) = (axis.dot(first), axis.dot(second));
        (a, b, c) = (a + x * x, b + x * y, c + y * y);
    }
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let spread = half.hypot(b);
    let [largest, least] = [mean + spread, (mean - spread).max(0.0)];
    if largest < NORMAL * NORMAL {
        return Vec::new();
    }
    if least > ALIKE * ALIKE * largest {
        return vec![first, second];
    }
    let angle = 0.5 * b.atan2(half);
    let axis = first * angle.cos() + second * angle.sin();
    vec![axis.cross(normal)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_in_the_plane_of_a_shell_hold_its_director_and_those_along_the_normal_nothing() {
        let held = |normal: Vec3, about| still(normal.normalized().unwrap(), about);
        let z = Vec3::unit(2);
        assert!(held(z, [false, false, true]).is_empty());
        // about y: no motion along x
        let one = held(z, [false, true, false]);
        assert!(one.len() == 1 && one[0].x.abs() > 1.0 - 1e-12);
        assert_eq!(held(z, [true, true, false]).len(), 2);
        // a curved edge in the plane of x and z, whose symmetry holds x and z: no motion along y
        for k in 0..90 {
            let angle = f64::from(k).to_radians();
            for off in [0.0, 0.05, -0.1] {
                let one = held(
                    Vec3::new(angle.sin(), off, angle.cos()),
                    [true, false, true],
                );
                assert_eq!(one.len(), 1, "{k} {off}");
                assert!(
                    one[0].y.abs() > 0.99 * one[0].norm(),
                    "{k} {off}: {:?}",
                    one[0]
                );
            }
        }
    }
}
