//! Nodes dragged over valleys: edges and vertices of the primary side beyond which it rises.
//!
//! SOURCE      The distance of a point inside a body from its surface is a smooth function across a valley, whose gradient
//!             points from the closest point, on a facet, an edge or a vertex
//! GOAL        a node that alternates between facets in an iteration does not end on the continuation of one of them
//! MESH        in the plane 4 × 2 quad4 with a vertex, in space 3 × 3 × 1 hex8 with a line or a pit at the crossing of
//!             facets, below; 3 × 2 quad4 or 2 × 2 × 1 hex8 above
//! CONDITIONS  finite strain, neo-Hookean, no friction, nodes with penalty; pressed, then dragged so that nodes come to lie on
//!             both sides of the valley and on it, in several numbers of increments
//! EXPECTED    the gap of each closed node is its distance from the facet closest to it, found by halving the error along
//!             one parameter after the other; its force is the penalty times that, away from the closest point
//! TOLERANCE   1e-8 of the gap; 1e-5 in the direction, which is that of a difference of nearly equal places
use crate::common::{Run, model, run};
use crate::scene::{RUBBER, Scene, equal};
use signorini_geometry::tensor::Vec3;

/// Force per gap of each node.
const PENALTY: f64 = 1e4;

/// Where the surface has its valley.
#[derive(Clone, Copy, Debug)]
enum Valley {
    /// A vertex in the plane.
    Vertex,
    /// A line of edges.
    Line,
    /// A node that lies deeper than all around it.
    Pit,
}

/// A box of cells: corners over the products of three lists of coordinates, of which the second one has one entry in the
/// plane, the third one along the height.
struct Grid {
    size: [usize; 3],
    labels: Vec<usize>,
}

impl Grid {
    fn new(scene: &mut Scene, axes: [&[f64]; 3], place: impl Fn([f64; 3]) -> Vec<f64>) -> Self {
        let size = axes.map(<[f64]>::len);
        let mut labels = Vec::new();
        for z in axes[2] {
            for y in axes[1] {
                for x in axes[0] {
                    labels.push(scene.node(&place([*x, *y, *z])));
                }
            }
        }
        Self { size, labels }
    }

    fn at(&self, [i, j, k]: [usize; 3]) -> usize {
        self.labels[i + self.size[0] * (j + self.size[1] * k)]
    }

    /// The facets of a layer of corners, seen from above.
    fn facets(&self, k: usize) -> Vec<Vec<usize>> {
        let [nx, ny, _] = self.size;
        let mut facets = Vec::new();
        if ny == 1 {
            facets.extend((1..nx).map(|i| vec![self.at([i - 1, 0, k]), self.at([i, 0, k])]));
        }
        for j in 1..ny {
            let around = |i: usize| [[i - 1, j - 1, k], [i, j - 1, k], [i, j, k], [i - 1, j, k]];
            facets.extend((1..nx).map(|i| around(i).map(|c| self.at(c)).to_vec()));
        }
        facets
    }

    /// Fills it with cells; gives the last layer of them.
    fn fill(&self, scene: &mut Scene, group: &str) -> Vec<usize> {
        let mut last = Vec::new();
        for k in 1..self.size[2] {
            let (below, above) = (self.facets(k - 1), self.facets(k));
            let pairs = below.iter().zip(&above);
            let cells = pairs.map(|(low, high)| match low[..] {
                [a, b] => scene.cell("quad4", group, vec![a, b, high[1], high[0]]),
                _ => scene.cell("hex8", group, [&low[..], high].concat()),
            });
            last = cells.collect();
        }
        last
    }
}

/// What happened, and the facets of the primary side by places of their nodes.
struct Dragged {
    run: Run,
    reference: Vec<Vec3>,
    facets: Vec<Vec<usize>>,
}

/// Presses a block into a valley of this depth and drags it this way.
fn dragged(valley: Valley, depth: f64, offset: f64, way: [f64; 2], increments: usize) -> Dragged {
    let mut scene = Scene::default();
    let plane = matches!(valley, Valley::Vertex);
    let tent = |x: f64| (1.0 - (x - 1.0).abs()).max(0.0);
    let dip = |x: f64, y: f64| match valley {
        Valley::Pit => depth * tent(x) * tent(y),
        _ => depth * tent(x),
    };
    let place = |x: f64, y: f64, z: f64| if plane { vec![x, z] } else { vec![x, y, z] };
    let across = [0.0, 0.5, 1.0, 1.6];
    let aside: &[f64] = if plane { &[0.0] } else { &across };
    let below = |[x, y, z]: [f64; 3]| place(x, y, z * (1.0 - dip(x, y)));
    let lower = Grid::new(&mut scene, [&across, aside, &[0.0, 0.5, 1.0]], below);
    let foot = 1.0 - 0.8 * depth;
    let up = equal(0.65 + offset, 1.3 + offset, 2);
    let aside: &[f64] = if plane { &[0.0] } else { &up };
    let upper = Grid::new(&mut scene, [&up, aside, &[foot, 1.4]], |[x, y, z]| {
        place(x, y, z)
    });
    let top = lower.fill(&mut scene, "lower");
    upper.fill(&mut scene, "upper");
    let side = if plane { "S3" } else { "S2" };
    scene.faces("top", &top.iter().map(|c| (*c, side)).collect::<Vec<_>>());
    let (n, layer) = (upper.labels.len(), upper.labels.len() / 2);
    scene.set("foot", &upper.labels[..layer]);
    scene.set("head", &upper.labels[n - layer..]);
    scene.set("base", &lower.labels[..lower.labels.len() / 3]);
    let pressed = -0.02 - 0.25 * depth;
    let (space, still, down, drag) = if plane {
        let drag = format!("ux = {:?}", way[0]);
        ("plane-strain", "ux = 0.0", "uy", drag)
    } else {
        let drag = format!("ux = {:?}\nuy = {:?}", way[0], way[1]);
        ("3d", "ux = 0.0\nuy = 0.0", "uz", drag)
    };
    let text = scene.case(&format!(
        r#"
[model]
space = "{space}"
{RUBBER}
[[body]]
group = ["lower", "upper"]
material = "m"
[[contact]]
name = "c"
secondary = "foot"
primary = "top"
method = "node-to-segment"
enforcement = {{ penalty = {PENALTY:?}, per = "node" }}
start = {{ interference = "now" }}
[[step]]
name = "press"
geometry = "nonlinear"
increments = {{ fixed = 2 }}
[[step.fix]]
on = "base"
u = "all"
[[step.move]]
on = "head"
{still}
{down} = {pressed:?}
[[step]]
name = "drag"
increments = {{ fixed = {increments} }}
[[step.move]]
on = "head"
{drag}
[solver]
newton = {{ force_tol = 1e-10 }}
"#
    ));
    let nodes = lower.labels.len() + upper.labels.len();
    let at = |n: usize| {
        let x = scene.at(n);
        Vec3::new(x[0], x[1], x.get(2).copied().unwrap_or_default())
    };
    let facets = lower.facets(2);
    let places = |f: &Vec<usize>| f.iter().map(|n| n - 1).collect();
    Dragged {
        reference: (1..=nodes).map(at).collect(),
        facets: facets.iter().map(places).collect(),
        run: run(&mut model("valley", &text, &[])),
    }
}

/// The closest place of a line.
fn on_line(ends: [Vec3; 2], point: Vec3) -> (f64, Vec3) {
    let along = ends[1] - ends[0];
    let t = ((point - ends[0]).dot(along) / along.dot(along)).clamp(0.0, 1.0);
    (t, ends[0] + along * t)
}

/// The closest place of a facet. The square of the distance is a parabola in each of its two parameters.
fn on_facet(corners: &[Vec3], point: Vec3) -> Vec3 {
    if let [a, b] = *corners {
        return on_line([a, b], point).1;
    }
    let [a, b, c, d] = *corners else {
        panic!("a facet of lines");
    };
    let mix = |p: Vec3, q: Vec3, t: f64| p * (1.0 - t) + q * t;
    let (mut t, mut place) = (0.5, Vec3::ZERO);
    for _ in 0..400 {
        let (s, _) = on_line([mix(a, d, t), mix(b, c, t)], point);
        (t, place) = on_line([mix(a, b, s), mix(d, c, s)], point);
    }
    place
}

/// Asserts that every closed node is where its closest facet says, and pushed away from there.
fn assert_closest(dragged: &Dragged, name: &str) -> usize {
    let run = &dragged.run;
    assert!(run.error.is_none(), "{name}: {:?}", run.error);
    let (mut worst, mut on_edges) = ([0.0f64; 2], 0);
    for frame in &run.frames {
        let moved = dragged.reference.iter().zip(&frame.displacement);
        let x: Vec<Vec3> = moved.map(|(x, u)| *x + *u).collect();
        let contact = &frame.contacts[0];
        for (k, node) in contact.nodes.iter().enumerate() {
            if !contact.status[k].is_closed() {
                continue;
            }
            let point = x[*node as usize];
            let places = dragged.facets.iter().map(|facet| {
                let corners: Vec<Vec3> = facet.iter().map(|n| x[*n]).collect();
                on_facet(&corners, point)
            });
            let mut places: Vec<Vec3> = places.collect();
            places.sort_by(|a, b| (*a - point).norm().total_cmp(&(*b - point).norm()));
            let away = places[0] - point;
            on_edges += usize::from((places[0] - places[1]).norm() < 1e-9);
            let force = contact.force[k];
            let gap = (contact.gap[k] + away.norm()).abs() / away.norm();
            let turned = (force / force.norm() - away / away.norm()).norm();
            worst = [worst[0].max(gap), worst[1].max(turned)];
        }
    }
    let iterations: usize = run.increments.iter().map(|i| i.iterations).sum();
    println!("{name}: {worst:?}, {on_edges} on edges, {iterations} iterations");
    assert!(worst[0] < 1e-8 && worst[1] < 1e-5, "{name}: {worst:?}");
    on_edges
}

#[test]
fn nodes_dragged_over_a_valley_rest_on_their_closest_points() {
    let mut on_edges = 0;
    for valley in [Valley::Vertex, Valley::Line, Valley::Pit] {
        for depth in [0.04, 0.15] {
            for (offset, way) in [
                (0.0, [0.1, 0.05]),
                (-0.02, [0.09, 0.09]),
                (0.03, [-0.1, 0.02]),
            ] {
                for increments in [3, 10] {
                    let name = format!("{valley:?} {depth} {offset} {way:?} in {increments}");
                    let dragged = dragged(valley, depth, offset, way, increments);
                    on_edges += assert_closest(&dragged, &name);
                }
            }
        }
    }
    // the family is about these
    assert!(on_edges > 20, "{on_edges}");
}
