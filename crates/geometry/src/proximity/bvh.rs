use super::Aabb;
use crate::tensor::Vec3;

/// A hierarchy of boxes around boxes, which finds those near a point without looking at all of them.
///
/// Boxes are known by their position in the slice the tree is built from. Nodes lie in depth-first order, so that the
/// first child of a node follows it and the second follows the subtree of the first:
///
/// ```text
///            0
///          ┌─┴─┐          index   0  1  2  3  4
///          1   4          skip    5  4  3  4  5      skip == index + 1: a leaf
///        ┌─┴─┐
///        2   3
/// ```
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// The bounded boxes, in the order of the leaves.
    items: Vec<Item>,
    /// All others, tested one by one.
    beside: Vec<Item>,
    cost: f64,
    cost_when_built: f64,
}

/// A subtree: the box around `count` items from `first` on.
#[derive(Clone, Debug)]
struct Node {
    bounds: Aabb,
    first: u32,
    count: u32,
    /// The index of the next node outside this subtree.
    skip: u32,
}

#[derive(Clone, Copy, Debug)]
struct Item {
    bounds: Aabb,
    id: u32,
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

/// Most items in a leaf.
const LEAF: usize = 4;

/// Places along the longest axis at which a split is tried, plus one.
const NBIN: usize = 16;

/// Below this depth items are halved: 2³² of them take 30 levels more.
const HALVED_BELOW: usize = 32;

/// No node is deeper, the root having depth 0.
pub(super) const DEEPEST: usize = HALVED_BELOW + 30;

/// The growth of the cost (E4) at which the tree counts as degraded. Building takes about as long as one query per box;
/// at this growth a query takes up to three times as long where far boxes have changed places, and hardly longer where
/// neighbours have mixed.
const DEGRADED: f64 = 1.2;

/// Covers the rounding of a distance that is the square root of a sum of squares.
const ROUNDING: f64 = 1.0 + 4.0 * f64::EPSILON;

impl Bvh {
    /// The tree over these boxes.
    #[must_use]
    pub fn build(boxes: &[Aabb]) -> Self {
        let mut tree = Self::default();
        tree.rebuild(boxes);
        tree
    }

    /// Builds the tree again over these boxes, in the memory it has.
    pub fn rebuild(&mut self, boxes: &[Aabb]) {
        self.nodes.clear();
        self.items.clear();
        self.beside.clear();
        for (id, &bounds) in (0..u32::MAX).zip(boxes) {
            let list = if bounds.is_bounded() {
                &mut self.items
            } else {
                &mut self.beside
            };
            list.push(Item { bounds, id });
        }
        if !self.items.is_empty() {
            self.grow(0, self.items.len(), 0);
        }
        self.cost = self.cost();
        self.cost_when_built = self.cost;
    }

    /// Moves the boxes and keeps the shape of the tree. Allocates nothing.
    ///
    /// Right for any motion, fast while neighbours stay neighbours: see [`Bvh::degraded`]. Where the number of boxes
    /// has changed the tree is built again.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        if boxes.len() != self.nbox() {
            return self.rebuild(boxes);
        }
        for item in self.items.iter_mut().chain(&mut self.beside) {
            item.bounds = boxes[item.id as usize];
        }
        for i in (0..self.nodes.len()).rev() {
            self.nodes[i].bounds = match self.children(i) {
                Some([left, right]) => self.nodes[left].bounds.union(self.nodes[right].bounds),
                None => around(self.leaf(&self.nodes[i])),
            };
        }
        self.cost = self.cost();
    }

    /// The number of boxes.
    #[must_use]
    pub fn nbox(&self) -> usize {
        self.items.len() + self.beside.len()
    }

    /// Whether the boxes have moved so much since the tree was built that it pays to build it again: its cost (E4) has
    /// grown by a fifth, or a box kept apart from the tree has become bounded.
    #[must_use]
    pub fn degraded(&self) -> bool {
        let good = self.cost <= DEGRADED * self.cost_when_built;
        !good || self.beside.iter().any(|item| item.bounds.is_bounded())
    }

    /// Replaces `out` by the sorted numbers of the boxes within `distance` of `point`.
    ///
    /// A negative distance, or a point that is not finite, finds nothing.
    pub fn query(&self, point: Vec3, distance: f64, out: &mut Vec<u32>) {
        out.clear();
        if point.is_finite() && distance >= 0.0 {
            self.select(|b| b.within(point, distance), out);
        }
    }

    /// Replaces `out` by the sorted numbers of the boxes that share a point with `region`.
    pub fn overlaps(&self, region: &Aabb, out: &mut Vec<u32>) {
        out.clear();
        self.select(|b| b.overlaps(region), out);
    }

    /// Replaces `out` by the sorted numbers of the boxes that the line `origin + s direction`, `0 ≤ s ≤ 1`, has a point in.
    ///
    /// A line that is not finite finds nothing.
    pub fn crossed(&self, origin: Vec3, direction: Vec3, out: &mut Vec<u32>) {
        out.clear();
        if origin.is_finite() && direction.is_finite() {
            self.select(|b| b.is_crossed(origin, direction), out);
        }
    }

    /// Visits the boxes near a point, the nearer of two subtrees first, and leaves out those that cannot matter.
    ///
    /// `visit` examines the content of a box and returns the smallest distance found so far, in any box, `∞` while there
    /// is none. Boxes farther away than that are not visited; boxes exactly as far away are, so that a visitor which
    /// prefers the smaller number among equals gets the same answer from every tree.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::{proximity::{Aabb, Bvh}, tensor::Vec3};
    /// let corners = [0.0, 1.0, 2.0].map(|x| Vec3::new(x, 0.0, 0.0));
    /// let tree = Bvh::build(&corners.map(|c| Aabb::around([c])));
    /// let point = Vec3::new(1.2, 0.5, 0.0);
    /// let mut closest = (f64::INFINITY, 0);
    /// tree.visit_near(point, |id| {
    ///     let distance = (corners[id as usize] - point).norm();
    ///     if (distance, id) < closest {
    ///         closest = (distance, id);
    ///     }
    ///     closest.0
    /// });
    /// assert_eq!(closest.1, 1);
    /// ```
    pub fn visit_near(&self, point: Vec3, mut visit: impl FnMut(u32) -> f64) {
        if !point.is_finite() {
            return;
        }
        let mut found = f64::INFINITY;
        let mut try_item = |item: &Item, found: &mut f64| {
            if !item.bounds.is_empty() && item.bounds.distance_squared(point) <= square(*found) {
                *found = visit(item.id);
            }
        };
        for item in &self.beside {
            try_item(item, &mut found);
        }
        // one sibling waits on every level above the node at hand
        let mut waiting = [(0, 0.0); DEEPEST + 1];
        let mut nwaiting = usize::from(!self.nodes.is_empty());
        while nwaiting > 0 {
            nwaiting -= 1;
            let (mut at, distance_squared) = waiting[nwaiting];
            if distance_squared > square(found) {
                continue;
            }
            while let Some([left, right]) = self.children(at) {
                let distance = |i: usize| self.nodes[i].bounds.distance_squared(point);
                let (a, b) = (distance(left), distance(right));
                let (near, far) = if a <= b {
                    (left, (right, b))
                } else {
                    (right, (left, a))
                };
                waiting[nwaiting] = far;
                nwaiting += 1;
                at = near;
            }
            for item in self.leaf(&self.nodes[at]) {
                try_item(item, &mut found);
            }
        }
    }

    /// As [`Bvh::select`], over two trees of one shape.
    pub(super) fn select_both(
        &self,
        other: &Self,
        reached: impl Fn(&Aabb, &Aabb) -> bool,
        out: &mut Vec<u32>,
    ) {
        let mut collect = |mine: &[Item], others: &[Item]| {
            let both = mine.iter().zip(others);
            let near = both.filter(|(a, b)| reached(&b.bounds, &a.bounds));
            out.extend(near.map(|(item, _)| item.id));
        };
        collect(&self.beside, &other.beside);
        let mut i = 0;
        while let (Some(node), Some(of_other)) = (self.nodes.get(i), other.nodes.get(i)) {
            if !reached(&of_other.bounds, &node.bounds) {
                i = node.skip as usize;
                continue;
            }
            i += 1;
            if node.skip as usize == i {
                collect(self.leaf(node), other.leaf(of_other));
            }
        }
        out.sort_unstable();
    }

    /// Adds the sorted numbers of the boxes that are reached, where a box is only if the box around it is.
    fn select(&self, reached: impl Fn(&Aabb) -> bool, out: &mut Vec<u32>) {
        let mut collect = |items: &[Item]| {
            let near = items.iter().filter(|item| reached(&item.bounds));
            out.extend(near.map(|item| item.id));
        };
        collect(&self.beside);
        let mut i = 0;
        while let Some(node) = self.nodes.get(i) {
            if !reached(&node.bounds) {
                i = node.skip as usize;
                continue;
            }
            i += 1;
            if node.skip as usize == i {
                collect(self.leaf(node));
            }
        }
        out.sort_unstable();
    }

    /// The two children of a node, or `None` for a leaf.
    fn children(&self, i: usize) -> Option<[usize; 2]> {
        let left = i + 1;
        (self.nodes[i].skip as usize > left).then(|| [left, self.nodes[left].skip as usize])
    }

    fn leaf(&self, node: &Node) -> &[Item] {
        &self.items[node.first as usize..][..node.count as usize]
    }

    /// (E4).
    fn cost(&self) -> f64 {
        let weighted = |(i, node): (usize, &Node)| match self.children(i) {
            Some(_) => node.bounds.width(),
            None => node.bounds.width() * f64::from(node.count),
        };
        let sum: f64 = self.nodes.iter().enumerate().map(weighted).sum();
        let root = self.nodes.first().map_or(0.0, |n| n.bounds.width());
        if root == 0.0 { 0.0 } else { sum / root }
    }

    /// Appends the subtree over `count ≥ 1` items from `first` on.
    fn grow(&mut self, first: usize, count: usize, depth: usize) {
        let index = self.nodes.len();
        let items = &mut self.items[first..][..count];
        self.nodes.push(Node {
            bounds: around(items),
            first: first as u32,
            count: count as u32,
            skip: 0,
        });
        if count > LEAF {
            let nleft = split(items, depth);
            self.grow(first, nleft, depth + 1);
            self.grow(first + nleft, count - nleft, depth + 1);
        }
        self.nodes[index].skip = self.nodes.len() as u32;
    }

    /// The depth of the deepest node.
    #[cfg(test)]
    pub(super) fn depth(&self) -> usize {
        let mut open = vec![];
        let mut deepest = 0;
        for (i, node) in self.nodes.iter().enumerate() {
            open.retain(|&skip| skip as usize > i);
            deepest = deepest.max(open.len());
            open.push(node.skip);
        }
        deepest
    }

    /// The growth of the cost (E4) since the tree was built.
    #[cfg(test)]
    pub(super) fn growth(&self) -> f64 {
        self.cost / self.cost_when_built
    }

    /// Where the buffers are and how much they hold.
    #[cfg(test)]
    pub(super) fn memory(&self) -> [(usize, usize); 3] {
        [
            (self.nodes.as_ptr() as usize, self.nodes.capacity()),
            (self.items.as_ptr() as usize, self.items.capacity()),
            (self.beside.as_ptr() as usize, self.beside.capacity()),
        ]
    }
}

fn around(items: &[Item]) -> Aabb {
    items
        .iter()
        .fold(Aabb::EMPTY, |bounds, item| bounds.union(item.bounds))
}

/// The square of a distance, rounded up.
fn square(distance: f64) -> f64 {
    distance * distance * ROUNDING
}

/// Sorts the items into two parts and returns the size of the first; neither is empty.
fn split(items: &mut [Item], depth: usize) -> usize {
    let centres = Aabb::around(items.iter().map(|item| item.bounds.centre()));
    let extent = centres.extent();
    let axis = if extent.x >= extent.y && extent.x >= extent.z {
        0
    } else if extent.y >= extent.z {
        1
    } else {
        2
    };
    let scale = NBIN as f64 / extent[axis];
    let bin_of = |item: &Item| {
        let along = (item.bounds.centre()[axis] - centres.min[axis]) * scale;
        (along as usize).min(NBIN - 1)
    };
    if depth < HALVED_BELOW
        && let Some(cut) = cheapest_cut(items, bin_of)
    {
        return partition(items, |item| bin_of(item) < cut);
    }
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        let (x, y) = (a.bounds.centre()[axis], b.bounds.centre()[axis]);
        x.total_cmp(&y).then(a.id.cmp(&b.id))
    });
    half
}

/// The bin at which the second part begins where the cost of both is smallest, or `None` where all are in one bin.
fn cheapest_cut(items: &[Item], bin_of: impl Fn(&Item) -> usize) -> Option<usize> {
    const NONE: Bin = Bin {
        bounds: Aabb::EMPTY,
        count: 0,
    };
    let join = |a: Bin, b: &Bin| Bin {
        bounds: a.bounds.union(b.bounds),
        count: a.count + b.count,
    };
    let mut bins = [NONE; NBIN];
    for item in items {
        let bin = &mut bins[bin_of(item)];
        bin.bounds = bin.bounds.union(item.bounds);
        bin.count += 1;
    }
    // from[i]: the content of bin i and those beyond
    let mut from = bins;
    for i in (1..NBIN).rev() {
        from[i - 1] = join(from[i], &from[i - 1]);
    }
    let mut best = (f64::INFINITY, None);
    let mut before = NONE;
    for cut in 1..NBIN {
        before = join(before, &bins[cut - 1]);
        let cost = [before, from[cut]].map(|part| part.count as f64 * part.bounds.width());
        let cost = cost[0] + cost[1];
        if before.count > 0 && from[cut].count > 0 && cost < best.0 {
            best = (cost, Some(cut));
        }
    }
    best.1
}

/// Moves the items that go first to the front and returns how many they are.
fn partition(items: &mut [Item], goes_first: impl Fn(&Item) -> bool) -> usize {
    let mut nfirst = 0;
    for i in 0..items.len() {
        if goes_first(&items[i]) {
            items.swap(nfirst, i);
            nfirst += 1;
        }
    }
    nfirst
}
