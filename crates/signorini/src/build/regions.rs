//! Nodes by where they are.

use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use signorini_io::case::Region;

/// How far a node may be off a plane, box or sphere and still count, in parts of the size of the mesh.
const CLOSE: f64 = 1e-6;

/// Those of some nodes that lie in a part of space, boundary included.
pub(super) fn inside(mesh: &Mesh, region: &Region, among: &[NodeId]) -> Vec<NodeId> {
    let points = || {
        let point = |&node: &NodeId| Some((node, *mesh.points.get(node as usize)?));
        among.iter().filter_map(point)
    };
    let close = CLOSE * size(&mesh.points);
    let chosen = |is_in: &dyn Fn(Vec3) -> bool| {
        let nodes = points().filter(|(_, x)| is_in(*x));
        nodes.map(|(node, _)| node).collect()
    };
    match region {
        Region::Plane { normal, at, tol } => {
            let Some(normal) = Vec3::from(*normal).normalized() else {
                return Vec::new();
            };
            let tol = tol.unwrap_or(close);
            chosen(&|x| (normal.dot(x) - at).abs() <= tol)
        }
        Region::Box { low, high } => {
            let (low, high) = (Vec3::from(*low), Vec3::from(*high));
            chosen(&|x| (0..3).all(|c| low[c] - close <= x[c] && x[c] <= high[c] + close))
        }
        Region::Sphere { center, radius } => {
            let center = Vec3::from(*center);
            chosen(&|x| (x - center).norm() <= radius + close)
        }
        Region::Near { point } => {
            let point = Vec3::from(*point);
            let distance = |x: Vec3| (x - point).norm();
            let nearest = points().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
            nearest.map(|(node, _)| node).into_iter().collect()
        }
    }
}

/// The diagonal of the box around all points.
fn size(points: &[Vec3]) -> f64 {
    let extent = |c: usize| {
        let values = points.iter().map(|x| x[c]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        (high - low).max(0.0)
    };
    Vec3::new(extent(0), extent(1), extent(2)).norm()
}
