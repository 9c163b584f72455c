//! The search for facets that face one another.

use super::Skin;
use super::{AHEAD, ENTERED, FACES};
use rayon::prelude::*;
use signorini_geometry::proximity::{Aabb, Bvh};
use signorini_geometry::surface::{ContactSurface, Placement};
use signorini_geometry::tensor::Vec3;

/// Facets searched together: enough to be worth a task.
const CHUNK: usize = 256;

/// Distances along a line that differ by this part of the size of its facet are alike: it crosses an edge.
const ROUNDING: f64 = 1e-9;

/// A facet that faces another: lines along its normal cross that one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// The facet f.
    pub facet: u32,
    /// The facet q.
    pub other: u32,
    /// The smallest s of the lines from f that cross q.
    pub gap: f64,
    /// −n_f·n_q: 1 where they are parallel.
    pub opposed: f64,
    /// How far both are expected to move relative to one another.
    pub motion: f64,
}

/// Finds the facets of a skin that face one another.
pub struct Finder {
    skin: Skin,
    tree: Bvh,
    boxes: Vec<Aabb>,
    /// Middles of facets and normals there.
    normal: Vec<Vec3>,
    /// How each facet is expected to move.
    motion: Vec<Vec3>,
    /// How far any of them is.
    fastest: f64,
    found: Vec<Facing>,
}

/// Buffers of one thread.
#[derive(Default)]
struct Scratch {
    near: Vec<u32>,
    hits: Vec<(f64, u32)>,
}

impl Finder {
    /// One for a skin.
    #[must_use]
    pub fn new(skin: Skin) -> Self {
        let n = skin.size().len();
        Self {
            skin,
            tree: Bvh::default(),
            boxes: Vec::with_capacity(n),
            normal: Vec::with_capacity(n),
            motion: Vec::with_capacity(n),
            fastest: 0.0,
            found: Vec::new(),
        }
    }

    /// The skin.
    #[must_use]
    pub fn skin(&self) -> &Skin {
        &self.skin
    }

    /// What the last search found.
    #[must_use]
    pub fn found(&self) -> &[Facing] {
        &self.found
    }

    /// All facets with those that they face, sorted, where nodes are at `x` and expected to move by `motion`; not at all where
    /// that is empty.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::element::by_name;
    /// use signorini_geometry::mesh::{CellId, Mesh};
    /// use signorini_geometry::tensor::Vec3;
    /// use signorini_mechanics::facing::{Finder, Skin};
    ///
    /// // two squares, one a tenth above the other
    /// let mut mesh = Mesh::default();
    /// for low in [0.0, 1.1] {
    ///     for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
    ///         mesh.points.push(Vec3::new(x, low + y, 0.0));
    ///         mesh.node_labels.push(mesh.points.len() as u64);
    ///     }
    /// }
    /// let quad4 = by_name("quad4").ok_or("not in the table")?;
    /// mesh.push_cell(quad4, &[0, 1, 2, 3], 1);
    /// mesh.push_cell(quad4, &[4, 5, 6, 7], 2);
    /// let cells: Vec<CellId> = mesh.cells(2).collect();
    /// let mut finder = Finder::new(Skin::new(&mesh, &cells, |_| false)?);
    /// let found = finder.find(&mesh.points, &[]);
    /// assert_eq!(found.len(), 2); // each faces the other
    /// assert!(found.iter().all(|one| (one.gap - 0.1).abs() < 1e-12));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn find(&mut self, x: &[Vec3], motion: &[Vec3]) -> &[Facing] {
        let at = Placement { x, poses: &[] };
        let facets = self.skin.facets();
        let all = 0..facets.nfacet() as u32;
        let mean = |facet: u32| {
            let nodes = facets.nodes(facet);
            let of = |&n: &u32| motion.get(n as usize).copied().unwrap_or_default();
            nodes.iter().map(of).sum::<Vec3>() / nodes.len().max(1) as f64
        };
        self.motion.clear();
        self.motion.extend(all.clone().map(mean));
        self.fastest = self.motion.iter().map(|v| v.norm()).fold(0.0, f64::max);
        self.normal.clear();
        self.normal
            .extend(all.clone().map(|facet| self.skin.middle(x, facet).1));
        // what others may do before a line arrives is in their boxes
        let motion = &self.motion;
        let swept = |facet: u32| {
            let own = motion.get(facet as usize).map_or(0.0, |v| v.norm());
            facets.aabb(&at, facet).inflated(AHEAD * own)
        };
        self.boxes.clear();
        self.boxes.extend(all.map(swept));
        self.tree.refit(&self.boxes);
        if self.tree.degraded() {
            self.tree.rebuild(&self.boxes);
        }
        let nchunk = self.boxes.len().div_ceil(CHUNK);
        let of_chunk = |scratch: &mut Scratch, chunk: usize| {
            let last = self.boxes.len().min((chunk + 1) * CHUNK);
            let mut found = Vec::new();
            for facet in chunk * CHUNK..last {
                self.search(facet as u32, &at, scratch, &mut found);
            }
            found
        };
        let found: Vec<Vec<Facing>> = (0..nchunk)
            .into_par_iter()
            .map_init(Scratch::default, of_chunk)
            .collect();
        self.found.clear();
        self.found.extend(found.into_iter().flatten());
        &self.found
    }

    /// Adds the facets that a facet faces, sorted.
    fn search(
        &self,
        facet: u32,
        at: &Placement<'_>,
        scratch: &mut Scratch,
        found: &mut Vec<Facing>,
    ) {
        if !self.skin.takes_part(facet) {
            return;
        }
        let f = facet as usize;
        let (Some(&size), Some(&thickness)) =
            (self.skin.size().get(f), self.skin.thickness().get(f))
        else {
            return;
        };
        let (Some(&normal), Some(&own)) = (self.normal.get(f), self.motion.get(f)) else {
            return;
        };
        let mut points = [Vec3::ZERO; 4];
        let npoint = self.skin.points(at.x, facet, &mut points);
        let points = points.get(..npoint).unwrap_or_default();
        // boxes are as much larger as they move
        let ahead = size + AHEAD * own.norm();
        let most = ahead + AHEAD * self.fastest;
        let behind = most.min(ENTERED * thickness);
        let ends = |&x: &Vec3| [x - normal * behind, x + normal * ahead];
        let region = Aabb::around(points.iter().flat_map(ends));
        let Scratch { near, hits } = scratch;
        self.tree.overlaps(&region, near);
        near.retain(|&other| {
            let faces = self.normal.get(other as usize);
            faces.is_some_and(|n| n.dot(normal) < 0.0) && !self.skin.touch(facet, other)
        });
        let begin = found.len();
        for &point in points {
            self.cross(at, (point, normal), behind, near, hits);
            let Some((gap, other)) = self.closest(facet, normal, hits) else {
                continue;
            };
            let of_facet = found.get_mut(begin..).unwrap_or_default();
            match of_facet.iter_mut().find(|known| known.other == other) {
                Some(known) => known.gap = known.gap.min(gap),
                None => found.push(Facing {
                    facet,
                    other,
                    gap,
                    opposed: -normal.dot(self.normal_of(other)),
                    motion: self.relative(facet, other),
                }),
            }
        }
        let of_facet = found.get_mut(begin..).unwrap_or_default();
        of_facet.sort_unstable_by_key(|one| one.other);
    }

    /// All facets that a line crosses, with s, from `behind` its point on.
    fn cross(
        &self,
        at: &Placement<'_>,
        (point, normal): (Vec3, Vec3),
        behind: f64,
        near: &[u32],
        hits: &mut Vec<(f64, u32)>,
    ) {
        hits.clear();
        let origin = point - normal * behind;
        let facets = self.skin.facets();
        let crossed = near.iter().filter_map(|&other| {
            let s = facets.crossing(at, other, origin, normal)?;
            Some((s - behind, other))
        });
        hits.extend(crossed);
    }

    /// Of the facets that a line from a facet crosses, that which it faces, with s.
    fn closest(&self, facet: u32, normal: Vec3, hits: &[(f64, u32)]) -> Option<(f64, u32)> {
        let size = self.skin.size().get(facet as usize).copied()?;
        let entered = hits.iter().map(|hit| hit.0).filter(|&s| s > 0.0);
        let entered = entered.fold(f64::INFINITY, f64::min) + ROUNDING * size;
        let faces = hits
            .iter()
            .filter(|&&(s, other)| s <= entered && self.faces(facet, normal, other, s));
        let nearest = faces.clone().map(|hit| hit.0.abs()).reduce(f64::min)? + ROUNDING * size;
        let alike = faces.filter(|hit| hit.0.abs() <= nearest);
        alike.copied().min_by_key(|hit| hit.1)
    }

    /// (E1) to (E3).
    fn faces(&self, facet: u32, normal: Vec3, other: u32, s: f64) -> bool {
        let (f, q) = (facet as usize, other as usize);
        let thickness = |at: usize| self.skin.thickness().get(at).copied().unwrap_or(0.0);
        let size = self.skin.size().get(f).copied().unwrap_or(0.0);
        let reach = size + AHEAD * self.relative(facet, other);
        let of_other = self.normal_of(other);
        let deepest = ENTERED * thickness(f).min(thickness(q));
        let may = self.skin.takes_part(other);
        may && normal.dot(of_other) < -FACES && s >= -deepest.min(reach) && s <= reach
    }

    /// n_q.
    fn normal_of(&self, facet: u32) -> Vec3 {
        self.normal.get(facet as usize).copied().unwrap_or_default()
    }

    /// v.
    fn relative(&self, facet: u32, other: u32) -> f64 {
        let of = |facet: u32| self.motion.get(facet as usize).copied().unwrap_or_default();
        (of(facet) - of(other)).norm()
    }
}
