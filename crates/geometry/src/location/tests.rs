use super::*;
use crate::element::by_name;
use crate::random::Random;

fn mesh_of(name: &str, n: usize, map: impl Fn(Vec3) -> Vec3) -> (Mesh, Vec<CellId>) {
    let element = by_name(name).unwrap();
    let mut mesh = Mesh::default();
    let mut cells = Vec::new();
    let mut known = std::collections::HashMap::new();
    let layers = if element.dim() == 3 { n } else { 1 };
    for k in 0..n * n * layers {
        let at = Vec3::new((k % n) as f64, (k / n % n) as f64, (k / (n * n)) as f64);
        let nodes: Vec<NodeId> = element
            .nodes()
            .iter()
            .map(|xi| {
                let half = Vec3::new(0.5, 0.5, if element.dim() == 3 { 0.5 } else { 0.0 });
                let place = (at + *xi * 0.5 + half) / n as f64;
                let key = place.to_array().map(|c| (c * 1e6).round() as i64);
                *known.entry(key).or_insert_with(|| {
                    mesh.points.push(map(place));
                    mesh.node_labels.push(mesh.points.len() as u64);
                    mesh.points.len() as NodeId - 1
                })
            })
            .collect();
        cells.push(mesh.push_cell(element, &nodes, k as u64 + 1));
    }
    (mesh, cells)
}

fn value(mesh: &Mesh, at: &Located, field: impl Fn(Vec3) -> f64) -> f64 {
    at.weights
        .iter()
        .map(|(n, w)| w * field(mesh.points[*n as usize]))
        .sum()
}

fn bent(x: Vec3) -> Vec3 {
    let wave = (3.0 * x.x + 2.0 * x.y).sin();
    Vec3::new(
        x.x + 0.04 * wave * x.y,
        x.y + 0.05 * (2.5 * x.x).sin(),
        x.z * (1.0 + 0.1 * wave),
    )
}

#[test]
fn linear_fields_are_kept_at_random_points_of_distorted_meshes() {
    let linear = |x: Vec3| 1.0 + 2.0 * x.x - 3.0 * x.y + 0.5 * x.z;
    for name in ["quad4", "quad8", "quad9", "hex8", "hex20", "hex27"] {
        let (mesh, cells) = mesh_of(name, 5, bent);
        let locator = Locator::new(&mesh, &cells).unwrap();
        let mut random = Random(7);
        let mut inside = 0;
        for _ in 0..400 {
            let mut x = Vec3::new(random.unit(), random.unit(), random.unit());
            if mesh.dim() == 2 {
                x.z = 0.0;
            }
            let x = bent(x);
            let found = locator.locate(x).unwrap();
            let sum: f64 = found.weights.iter().map(|w| w.1).sum();
            assert!((sum - 1.0).abs() < 1e-12);
            // straight edges cut off what is outside
            if found.distance == 0.0 {
                inside += 1;
                assert!(
                    (value(&mesh, &found, linear) - linear(x)).abs() < 1e-11,
                    "{name} {x:?}"
                );
            } else {
                assert!(found.distance < 0.02, "{name} {}", found.distance);
            }
        }
        assert!(inside > 300, "{name} {inside}");
    }
}

#[test]
fn quadratic_fields_are_kept_by_quadratic_cells_with_straight_sides() {
    let quadratic = |x: Vec3| x.x * x.x - 2.0 * x.x * x.y + 0.3 * x.y * x.y + x.z * x.x;
    for name in ["quad8", "hex20", "hex27"] {
        let (mesh, cells) = mesh_of(name, 3, |x| {
            Vec3::new(2.0 * x.x + 0.3 * x.y, x.y, 1.5 * x.z)
        });
        let locator = Locator::new(&mesh, &cells).unwrap();
        for k in 0..200 {
            let part = |p: f64| (f64::from(k) * p).fract();
            let z = if mesh.dim() == 3 {
                part(0.333) * 1.5
            } else {
                0.0
            };
            let (a, b) = (part(0.618), part(0.414));
            let x = Vec3::new(2.0 * a + 0.3 * b, b, z);
            let found = locator.locate(x).unwrap();
            assert!(found.distance == 0.0, "{name} {x:?}");
            assert!(
                (value(&mesh, &found, quadratic) - quadratic(x)).abs() < 1e-11,
                "{name}"
            );
        }
    }
}

#[test]
fn a_point_outside_has_its_distance_from_the_closest_face() {
    for name in ["quad4", "hex8", "hex20"] {
        let (mesh, cells) = mesh_of(name, 3, |x| x);
        let locator = Locator::new(&mesh, &cells).unwrap();
        let z = if mesh.dim() == 3 { 0.4 } else { 0.0 };
        for away in [1e-6, 0.01, 0.5] {
            let found = locator.locate(Vec3::new(1.0 + away, 0.37, z)).unwrap();
            assert!(
                (found.distance - away).abs() < 1e-9,
                "{name} {away}: {}",
                found.distance
            );
            let y = value(&mesh, &found, |x| x.y);
            assert!((y - 0.37).abs() < 1e-9 && found.size > 0.3, "{name} {y}");
        }
    }
    assert!(Locator::new(&Mesh::default(), &[]).is_none());
}
