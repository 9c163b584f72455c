//! Friction on faces, edges and vertices against reference values from outside, where they are at hand.

use super::super::discretization::projected::{Place, Point};
use super::super::discretization::{Anchored, Pair};
use super::super::friction::{Coulomb, Stick};
use super::super::kernel::{Derivatives, Lambda, Laws, Past, Target};
use super::super::law::{Penalty, Scale};
use super::super::row::{Participant, RowOrder, Rows, Wanted};
use super::{facets_of, largest};
use serde_json::Value;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{Anchor, Facets, Feature, Placement};
use signorini_geometry::tensor::Vec3;
use std::path::Path;

/// A file of reference values in a folder next to the repository, or further up.
pub(crate) fn reference(name: &str) -> Option<Value> {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let path = folders.find_map(|f| {
        let path = f.join("shared/reference").join(name);
        path.is_file().then_some(path)
    });
    let Some(path) = path else {
        eprintln!("SKIPPED: no {name} in shared/reference next to the repository");
        return None;
    };
    Some(serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap())
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    list.iter().map(|v| v.as_f64().unwrap()).collect()
}

fn vector(value: &Value) -> Vec3 {
    let mut v = Vec3::ZERO;
    for (c, n) in numbers(value).into_iter().enumerate() {
        v[c] = n;
    }
    v
}

/// One case of the file: an entity, a point over it and an anchor on another facet.
struct Case<'a> {
    value: &'a Value,
    x: Vec<Vec3>,
    surface: Facets,
    /// Nodes in the order of the reference: entity, point, facet of the anchor.
    order: Vec<NodeId>,
    point: [NodeId; 1],
    found: Pair,
    anchor: Anchored,
    ndim: usize,
}

impl<'a> Case<'a> {
    fn new(value: &'a Value) -> Self {
        let places = |key: &str| -> Vec<Vec3> {
            let list = value[key].as_array().unwrap();
            list.iter().map(vector).collect()
        };
        let mut x = places("X");
        let ndim = numbers(&value["r"]).len();
        let entity: Vec<NodeId> = (0..x.len() as NodeId).collect();
        let point = [x.len() as NodeId];
        x.push(vector(&value["r"]));
        let of_anchor = places("XA");
        let first = x.len() as NodeId;
        let around: Vec<NodeId> = (first..first + of_anchor.len() as NodeId).collect();
        x.extend(of_anchor);
        let order = [&entity[..], &point, &around].concat();

        // a facet that has the entity; its other nodes are anywhere off it
        let xi = numbers(&value["xi"]);
        let name = value["anchor_kind"].as_str().unwrap();
        let mut other = |scale: f64| {
            let k = x.len() as f64;
            let away = Vec3::new((1.7 * k).sin(), 1.0 + (2.3 * k).cos(), (3.1 * k).sin());
            x.push(
                x[0] + if ndim == 2 {
                    Vec3::new(away.x, away.y, 0.0)
                } else {
                    away
                } * scale,
            );
            x.len() as NodeId - 1
        };
        let along = Feature::Edge {
            direction: [1.0, 0.0],
        };
        let (kind, nodes, local, feature) = match (value["kind"].as_str(), ndim) {
            (None, 2) => {
                let nodes = vec![0, other(1.0)];
                ("line2", nodes, Vec3::new(-1.0, 0.0, 0.0), Feature::Vertex)
            }
            (None, _) => {
                let nodes = vec![0, other(1.0), other(2.0), other(1.5)];
                ("quad4", nodes, Vec3::new(-1.0, -1.0, 0.0), Feature::Vertex)
            }
            (Some("line2"), 3) => {
                let nodes = vec![0, 1, other(1.0), other(1.0)];
                ("quad4", nodes, Vec3::new(xi[0], -1.0, 0.0), along)
            }
            (Some("line3"), 3) => {
                let [c, d, e, f, g] = std::array::from_fn(|_| other(1.0));
                let nodes = vec![0, 1, c, d, 2, e, f, g];
                ("quad8", nodes, Vec3::new(xi[0], -1.0, 0.0), along)
            }
            // seen from behind
            (Some("quad4"), _) => {
                let local = Vec3::new(xi[1], xi[0], 0.0);
                ("quad4", vec![0, 3, 2, 1], local, Feature::Face)
            }
            (kind, _) => panic!("no such entity: {kind:?}"),
        };
        let surface = facets_of(&mut x, &[(kind, nodes), (name, around)]);
        Self {
            value,
            surface,
            order,
            point,
            found: Pair {
                anchor: Anchor { facet: 0, local },
                feature,
                gap: -1.0,
                held: None,
            },
            anchor: Anchored {
                anchor: Anchor {
                    facet: 1,
                    local: vector(&value["xia"]),
                },
                offset: Vec3::ZERO,
            },
            ndim,
            x,
        }
    }

    fn rows(&self) -> Rows {
        let place = Place {
            surface: &self.surface,
            at: &Placement {
                x: &self.x,
                poses: &[],
            },
            point: Point {
                nodes: &self.point,
                weights: &[1.0],
                all: &[],
            },
            found: &self.found,
            anchor: Some(&self.anchor),
            bond: false,
        };
        let wanted = Wanted {
            order: RowOrder::Tangent,
            slip: true,
        };
        let mut rows = Rows::default();
        place.fill(0, wanted, &mut rows).unwrap();
        rows
    }

    /// The relative errors of force and tangent.
    fn errors(&self) -> (f64, f64) {
        let number = |key: &str| self.value[key].as_f64().unwrap();
        let friction = Coulomb {
            mu: number("mu"),
            cap: f64::INFINITY,
        };
        let laws = Laws {
            has_past: false,
            law: &Penalty,
            friction: Some(&friction),
            stick: Stick::Stiffness(number("eT")),
            scale: &Scale {
                penalty: number("p"),
                shear: number("p"),
                length: 1.0,
            },
            bond: false,
            bond_tangential: None,
            cohesion: None,
            duration: 0.0,
            vectors: true,
            shear: number("p"),
            vibrates: false,
            walks: false,
            answer: None,
        };
        let rows = self.rows();
        let n = rows.ncolumn();
        let (mut force, mut stiffness) = (vec![0.0; n], vec![0.0; n * n]);
        let mut target = Target {
            force: &mut force,
            stiffness: &mut stiffness,
        };
        let (row, nothing) = (&rows.rows()[0], Lambda::default());
        assert!(row.gap < 0.0, "it is pressed");
        laws.act(
            row,
            1.0,
            &nothing,
            Past::default(),
            &mut Derivatives::default(),
            &mut target,
        );
        let slips = self.value["status"] == "slip";
        let state = laws.traction(row, &nothing, Past::default()).state;
        assert_eq!(format!("{state:?}"), if slips { "Slip" } else { "Stick" });

        // the column of component c of a node
        let column = |node: NodeId, c: usize| {
            let mut participants = rows.participants().iter();
            let place = participants.position(|p| *p == Participant::Node(node));
            place.map(|p| 3 * p + c)
        };
        let all = self.order.iter();
        let all = all.flat_map(|&node| (0..self.ndim).map(move |c| (node, c)));
        let columns: Vec<Option<usize>> = all.map(|(node, c)| column(node, c)).collect();
        let at = |i: Option<usize>| i.map_or(0.0, |i| force[i]);
        let expected = numbers(&self.value["f"]);
        let lines = self.value["K"].as_array().unwrap();
        assert_eq!(
            (expected.len(), lines.len()),
            (columns.len(), columns.len())
        );
        let error: Vec<f64> = columns
            .iter()
            .zip(&expected)
            .map(|(&i, f)| at(i) - f)
            .collect();
        let (mut tangent, mut most) = (0.0f64, 0.0f64);
        for (&i, line) in columns.iter().zip(lines) {
            for (&j, expected) in columns.iter().zip(numbers(line)) {
                let ours = i.zip(j).map_or(0.0, |(i, j)| stiffness[i * n + j]);
                tangent = tangent.max((ours - expected).abs());
                most = most.max(expected.abs());
            }
        }
        (largest(&error) / largest(&expected), tangent / most)
    }
}

#[test]
fn friction_on_faces_edges_and_vertices_matches_the_reference() {
    let Some(file) = reference("edge_vertex_friction.json") else {
        return;
    };
    let cases = file["cases"].as_object().unwrap();
    assert!(cases.len() >= 10);
    for (name, value) in cases {
        let (force, tangent) = Case::new(value).errors();
        println!("{name}: {force:.1e} {tangent:.1e}");
        assert!(
            force < 1e-10 && tangent < 1e-10,
            "{name}: {force:e} {tangent:e}"
        );
    }
}
