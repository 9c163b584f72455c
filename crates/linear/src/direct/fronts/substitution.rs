//! Substitution with the factors, from the leaves to the roots and back.

use super::elimination::Panel;
use super::forest::Node;
use super::number::Number;

/// What some nodes work with in a solution.
pub(super) struct Work<T> {
    /// Their unknowns, and the updates of the rows below them, node by node.
    pub(super) front: Vec<T>,
    pub(super) own: Vec<T>,
}

/// What all nodes share in a solution.
pub(super) struct Factors<'a, T> {
    pub(super) order: &'a [u32],
    pub(super) nodes: &'a [Node],
    pub(super) panels: &'a [Panel<T>],
}

impl<T: Number> Factors<'_, T> {
    /// Solves with the lower factor of a node, and leaves to its parent what remains of the rows below. Children are in the
    /// same work, or in that of their branch.
    #[inline(always)]
    pub(super) fn reduce(&self, s: usize, right: &[f64], work: &mut Work<T>, branches: &[Work<T>]) {
        let (node, panel) = (&self.nodes[s], &self.panels[s]);
        let (w, m) = (node.width(), node.size());
        let (before, rest) = work.front.split_at_mut(node.front);
        let front = &mut rest[..m];
        let unknowns = &self.order[node.columns.clone()];
        for (y, &old) in front.iter_mut().zip(unknowns) {
            *y = T::narrow(right[old as usize]);
        }
        front[w..].fill(T::default());
        for &child in &node.children {
            let child = &self.nodes[child as usize];
            let home = if child.branch == node.branch {
                &*before
            } else {
                &branches[child.branch].front
            };
            let left = &home[child.front + child.width()..];
            for (&place, left) in child.place.iter().zip(left) {
                front[place as usize] += *left;
            }
        }
        let (known, below) = front.split_at_mut(w);
        let own = &mut work.own;
        own.clear();
        own.extend(panel.pivot.iter().map(|&k| known[k as usize]));
        for k in 0..w {
            let column = &panel.value[k * m + k + 1..k * m + w];
            let known = own[k];
            for (x, l) in own[k + 1..].iter_mut().zip(column) {
                *x -= *l * known;
            }
        }
        known.copy_from_slice(own);
        subtract_product(below, &panel.value[w..], m, known);
    }

    /// Solves with the upper factor of a node, whose parent is in the same work, or in that of the nodes above.
    #[inline(always)]
    pub(super) fn expand(&self, s: usize, work: &mut Work<T>, above: Option<&Work<T>>) {
        let (node, panel) = (&self.nodes[s], &self.panels[s]);
        let (w, m) = (node.width(), node.size());
        let (fronts, after) = work.front.split_at_mut(node.front + m);
        let (own, below) = fronts[node.front..].split_at_mut(w);
        if let Some(parent) = node.parent {
            let parent = &self.nodes[parent as usize];
            let known = match above {
                Some(above) if parent.branch != node.branch => &above.front[parent.front..],
                _ => &after[parent.front - node.front - m..],
            };
            for (y, &place) in below.iter_mut().zip(&node.place) {
                *y = known[place as usize];
            }
        }
        subtract_product(own, &panel.value[w * m..], w, below);
        for k in (0..w).rev() {
            let column = &panel.value[k * m..k * m + k + 1];
            let known = own[k] / column[k];
            own[k] = known;
            for (x, u) in own[..k].iter_mut().zip(column) {
                *x -= *u * known;
            }
        }
    }
}

/// `y −= A x` with A by columns, which begin `stride` apart.
#[inline(always)]
pub(super) fn subtract_product<T: Number>(y: &mut [T], a: &[T], stride: usize, x: &[T]) {
    let n = y.len();
    if n == 0 {
        return;
    }
    let (fours, others) = x.as_chunks::<4>();
    for (k, x) in fours.iter().enumerate() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| &a[(4 * k + i) * stride..][..n]);
        for i in 0..n {
            // in the order of the columns
            y[i] = y[i] - a[i] * x[0] - b[i] * x[1] - c[i] * x[2] - d[i] * x[3];
        }
    }
    for (k, x) in (4 * fours.len()..).zip(others) {
        for (y, a) in y.iter_mut().zip(&a[k * stride..][..n]) {
            *y -= *a * *x;
        }
    }
}
