//! Ten skins of the kinds that general contact meets.

use signorini_geometry::element::by_name;
use signorini_geometry::mesh::{Mesh, NodeId};
use signorini_geometry::tensor::Vec3;
use std::f64::consts::{PI, TAU};

/// A facet: where its middle is, its normal and its body.
pub struct Side {
    pub at: Vec3,
    pub normal: Vec3,
    pub body: u32,
}

/// Bodies whose facets are labelled.
pub struct Skinned {
    pub name: &'static str,
    pub mesh: Mesh,
    /// Whether two facets may touch.
    pub may_touch: fn(&Side, &Side) -> bool,
    /// Whether any do.
    pub touches: bool,
    /// Whether lines along normals cross facets that cannot touch, too.
    pub tempts: bool,
}

pub fn all() -> Vec<Skinned> {
    vec![
        two_blocks(),
        sheets(),
        lips(),
        spring(),
        folded_sheet(),
        convex_block(),
        bent_strip(),
        bolted_joint(),
        balls(50, 4),
        gears(),
    ]
}

/// Adds a body of `n` cells along each direction whose nodes lie at the image of [0, 1]³; `closed` where its ends along
/// the first direction are one. Cells that `has` leaves out are not there.
pub fn add(
    mesh: &mut Mesh,
    n: [usize; 3],
    closed: bool,
    has: impl Fn([usize; 3]) -> bool,
    at: impl Fn([f64; 3]) -> Vec3,
) {
    let is_flat = n[2] == 0;
    let first = mesh.points.len();
    let nodes = [if closed { n[0] } else { n[0] + 1 }, n[1] + 1, n[2] + 1];
    for k in 0..nodes[2] {
        for j in 0..nodes[1] {
            for i in 0..nodes[0] {
                let part = |i: usize, n: usize| i as f64 / n.max(1) as f64;
                mesh.points
                    .push(at([part(i, n[0]), part(j, n[1]), part(k, n[2])]));
                mesh.node_labels.push(mesh.points.len() as u64);
            }
        }
    }
    let node = |i: usize, j: usize, k: usize| -> NodeId {
        let i = i % nodes[0];
        (first + (k * nodes[1] + j) * nodes[0] + i) as NodeId
    };
    let kind = if is_flat { "quad4" } else { "hex8" };
    let mirrored = {
        let middle = Vec3::from([0.3, 0.3, 0.3]);
        let slope = |axis: usize| {
            let step = Vec3::unit(axis) * 1e-4;
            at((middle + step).to_array()) - at((middle - step).to_array())
        };
        let across = if is_flat { Vec3::unit(2) } else { slope(2) };
        slope(0).cross(slope(1)).dot(across) < 0.0
    };
    for k in 0..n[2].max(1) {
        for j in 0..n[1] {
            for i in 0..n[0] {
                let layer = |k| {
                    [
                        node(i, j, k),
                        node(i + 1, j, k),
                        node(i + 1, j + 1, k),
                        node(i, j + 1, k),
                    ]
                };
                let mut corners = layer(k).to_vec();
                if !is_flat {
                    corners.extend(layer(k + 1));
                }
                if mirrored {
                    corners.chunks_mut(4).for_each(|layer| layer.swap(1, 3));
                }
                if has([i, j, k]) {
                    let label = mesh.ncell() as u64 + 1;
                    mesh.push_cell(by_name(kind).unwrap(), &corners, label);
                }
            }
        }
    }
}

fn everywhere(_: [usize; 3]) -> bool {
    true
}

fn never(_: &Side, _: &Side) -> bool {
    false
}

fn box_between(low: [f64; 3], high: [f64; 3]) -> impl Fn([f64; 3]) -> Vec3 {
    move |p| {
        let at = |axis: usize| low[axis] + p[axis] * (high[axis] - low[axis]);
        Vec3::new(at(0), at(1), at(2))
    }
}

/// Adds a slab of 4 × 4 between two heights.
pub fn slab(mesh: &mut Mesh, n: [usize; 3], [low, high]: [f64; 2]) {
    add(
        mesh,
        n,
        false,
        everywhere,
        box_between([0.0, 0.0, low], [4.0, 4.0, high]),
    );
}

/// Whether one faces up and the other, higher one down, or so that they overlap by less than `deep`.
fn stacked(a: &Side, b: &Side, deep: f64) -> bool {
    let (low, high) = if a.normal.z > 0.0 { (a, b) } else { (b, a) };
    low.normal.z > 0.9 && high.normal.z < -0.9 && high.at.z > low.at.z - deep
}

fn two_blocks() -> Skinned {
    let mut mesh = Mesh::default();
    add(
        &mut mesh,
        [8, 8, 5],
        false,
        everywhere,
        box_between([0.0; 3], [2.0, 2.0, 1.0]),
    );
    let upper = box_between([0.45, 0.55, 0.999], [1.45, 1.55, 2.0]);
    add(&mut mesh, [7, 7, 5], false, everywhere, upper);
    Skinned {
        name: "two blocks",
        mesh,
        may_touch: |a, b| a.body != b.body && stacked(a, b, 0.01),
        touches: true,
        tempts: false,
    }
}

fn sheets() -> Skinned {
    let mut mesh = Mesh::default();
    for k in 0..5 {
        let (low, high) = (0.45 * f64::from(k), 0.45 * f64::from(k) + 0.4);
        let n = 6 + k as usize;
        add(
            &mut mesh,
            [n, n, 1],
            false,
            everywhere,
            box_between([0.0, 0.0, low], [6.0, 6.0, high]),
        );
    }
    Skinned {
        name: "five sheets",
        mesh,
        may_touch: |a, b| a.body.abs_diff(b.body) == 1 && stacked(a, b, 0.0),
        touches: true,
        tempts: true,
    }
}

/// A thin tube with a slit.
fn lips() -> Skinned {
    let mut mesh = Mesh::default();
    add(&mut mesh, [48, 4, 1], false, everywhere, |[s, y, t]| {
        let (angle, radius) = (0.03 + s * (TAU - 0.06), 1.1 - 0.1 * t);
        Vec3::new(radius * angle.cos(), y, radius * angle.sin())
    });
    Skinned {
        name: "thin box, lips",
        mesh,
        may_touch: |a, b| {
            let is_lip = |side: &Side| side.at.x > 0.9 && side.normal.z.abs() > 0.99;
            is_lip(a) && is_lip(b) && a.normal.z * b.normal.z < 0.0
        },
        touches: true,
        tempts: true,
    }
}

/// Five turns of a wire.
fn spring() -> Skinned {
    let mut mesh = Mesh::default();
    add(&mut mesh, [160, 3, 1], false, everywhere, |[s, r, t]| {
        let (angle, radius) = (5.0 * TAU * s, 0.85 + 0.3 * r);
        let z = 0.18 * 5.0 * s + 0.12 * t;
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    });
    Skinned {
        name: "spring",
        mesh,
        may_touch: |a, b| stacked(a, b, 0.0),
        touches: true,
        tempts: true,
    }
}

/// A sheet bent back on itself.
fn folded_sheet() -> Skinned {
    let mut mesh = Mesh::default();
    let (leg, radius) = (2.0, 0.1);
    add(&mut mesh, [44, 6, 1], false, everywhere, |[s, y, t]| {
        let way = s * (2.0 * leg + PI * radius);
        let from = radius + 0.05 - 0.1 * t;
        let (x, z) = if way < leg {
            (way, -from)
        } else if way < leg + PI * radius {
            let angle = (way - leg) / radius - 0.5 * PI;
            (leg + from * angle.cos(), from * angle.sin())
        } else {
            (2.0 * leg + PI * radius - way, from)
        };
        Vec3::new(x, y, z)
    });
    Skinned {
        name: "folded sheet",
        mesh,
        may_touch: |a, b| {
            let is_inside = |side: &Side| {
                let on_leg =
                    side.at.x < 2.0 && side.at.z.abs() < 0.07 && side.normal.z * side.at.z < -0.01;
                let bend = Vec3::new(side.at.x - 2.0, 0.0, side.at.z);
                on_leg || side.at.x > 1.98 && bend.norm() < 0.06 && bend.dot(side.normal) < 0.0
            };
            is_inside(a) && is_inside(b)
        },
        touches: true,
        tempts: true,
    }
}

/// A narrow tube of long cells.
pub fn tube() -> Skinned {
    let mut mesh = Mesh::default();
    add(&mut mesh, [16, 2, 1], true, everywhere, |[s, r, z]| {
        let (angle, radius) = (TAU * s, 0.05 + 0.15 * r);
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    });
    Skinned {
        name: "tube",
        mesh,
        may_touch: |a, b| {
            let is_inside = |side: &Side| side.at.x.hypot(side.at.y) < 0.06;
            is_inside(a) && is_inside(b)
        },
        touches: true,
        tempts: false,
    }
}

fn convex_block() -> Skinned {
    let mut mesh = Mesh::default();
    add(&mut mesh, [14, 14, 14], false, everywhere, |p| {
        let [x, y, z] = p.map(|p| 2.0 * p - 1.0);
        let bulge = |a: f64, b: f64| 1.0 + 0.2 * (1.0 - a * a) * (1.0 - b * b);
        Vec3::new(x * bulge(y, z), y * bulge(x, z), z * bulge(x, y))
    });
    Skinned {
        name: "convex block",
        mesh,
        may_touch: never,
        touches: false,
        tempts: false,
    }
}

fn bent_strip() -> Skinned {
    let mut mesh = Mesh::default();
    add(&mut mesh, [20, 4, 1], false, everywhere, |[s, y, t]| {
        let (angle, radius) = (0.5 * PI * s, 1.05 - 0.05 * t);
        Vec3::new(radius * angle.cos(), 0.5 * y, radius * angle.sin())
    });
    Skinned {
        name: "bent strip",
        mesh,
        may_touch: never,
        touches: false,
        tempts: true,
    }
}

/// Two plates with a hole, and a bolt with head and nut.
fn bolted_joint() -> Skinned {
    let mut mesh = Mesh::default();
    let ring = |radii: [f64; 2], heights: [f64; 2]| {
        move |[s, r, z]: [f64; 3]| {
            let (angle, radius) = (TAU * s, radii[0] + r * (radii[1] - radii[0]));
            let z = heights[0] + z * (heights[1] - heights[0]);
            Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
        }
    };
    for heights in [[-0.2, 0.0], [0.0, 0.2]] {
        add(
            &mut mesh,
            [24, 4, 1],
            true,
            everywhere,
            ring([0.55, 2.0], heights),
        );
    }
    // cells of 0.1: the shank from 0.2 to 0.5, head and nut to 0.9
    let is_bolt = |[_, r, z]: [usize; 3]| r < 3 || !(3..7).contains(&z);
    add(
        &mut mesh,
        [24, 7, 10],
        true,
        is_bolt,
        ring([0.2, 0.9], [-0.5, 0.5]),
    );
    Skinned {
        name: "bolted joint",
        mesh,
        may_touch: |a, b| {
            let radius = |side: &Side| side.at.x.hypot(side.at.y);
            let is_round =
                |side: &Side| side.normal.z.abs() < 0.1 && (0.45..0.6).contains(&radius(side));
            let joint = (is_round(a) && is_round(b)) || stacked(a, b, 1e-9);
            a.body != b.body && joint
        },
        touches: true,
        tempts: true,
    }
}

/// Balls of radius 1 close to one another, each a cube of n³ cells made round.
pub fn balls(count: usize, n: usize) -> Skinned {
    let mut mesh = Mesh::default();
    for number in 0..count {
        let (i, j, k) = (number % 5, number / 5 % 5, number / 25);
        let place =
            |i: usize, shift: usize| 2.01 * i as f64 + 0.01 * ((i * 7 + shift * 3) % 5) as f64;
        let centre = Vec3::new(place(i, j), place(j, k), place(k, i));
        add(&mut mesh, [n, n, n], false, everywhere, |p| {
            let p = p.map(|p| 2.0 * p - 1.0);
            let cube = Vec3::from(p.map(|p| (0.25 * PI * p).tan()));
            let most = p.into_iter().fold(0.0_f64, |most, p| most.max(p.abs()));
            centre + cube.normalized().unwrap_or_default() * most
        });
    }
    Skinned {
        name: "balls",
        mesh,
        may_touch: |a, b| a.body != b.body,
        touches: true,
        tempts: false,
    }
}

/// Two wheels with 18 and 30 teeth, in the plane.
fn gears() -> Skinned {
    let mut mesh = Mesh::default();
    let mut wheel = |teeth: usize, centre: f64, turned: f64| {
        let pitch = teeth as f64 / 18.0;
        add(
            &mut mesh,
            [teeth * 12, 3, 0],
            true,
            everywhere,
            |[s, r, _]| {
                let tooth = (s * teeth as f64 + 1.0 / 24.0).fract();
                // a tooth is two fifths of its pitch at half height
                let rise = ((0.22 - (tooth - 0.5).abs()) / 0.12 + 0.5).clamp(0.0, 1.0);
                let outer = pitch + 0.16 * (rise - 0.5);
                let radius = 0.6 * pitch + r * (outer - 0.6 * pitch);
                let angle = TAU * s + turned;
                // counter-clockwise cells
                Vec3::new(centre + radius * angle.cos(), -radius * angle.sin(), 0.0)
            },
        );
    };
    // a tooth of the first in a space of the second
    wheel(18, 0.0, -TAU * (0.5 - 1.0 / 24.0) / 18.0);
    wheel(
        30,
        1.0 + 30.0 / 18.0 + 0.01,
        PI - TAU * (-1.0 / 24.0) / 30.0,
    );
    Skinned {
        name: "gears",
        mesh,
        may_touch: |a, b| a.body != b.body,
        touches: true,
        tempts: false,
    }
}
