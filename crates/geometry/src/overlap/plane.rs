use super::Pair;
use crate::element::{Element, MAX_FACET_NODES};
use crate::scalar::{Real, combine, cross, dot, minus, unit};
use crate::tensor::Vec3;

/// The auxiliary plane of a facet; of a line, the auxiliary line.
#[derive(Clone, Copy, Debug)]
pub struct Plane<T> {
    /// o, the mean of the facet's nodes.
    pub origin: [T; 3],
    /// e_1, e_2; of a line in the plane, e_2 is e_z.
    pub axes: [[T; 3]; 2],
    /// n0, out of the body.
    pub normal: [T; 3],
}

impl<T: Real> Plane<T> {
    /// The plane (E1) of a facet with its nodes at `x`; `None` where the facet has no normal at its centre.
    #[must_use]
    pub fn of(element: Element, x: &[[T; 3]]) -> Option<Self> {
        let mut dn = [Vec3::ZERO; MAX_FACET_NODES];
        element.dshape(&element.centre(), dn.get_mut(..element.nnode())?);
        let t1 = combine(dn.iter().map(|d| d.x), x);
        let t2 = if element.dim() == 1 {
            [0.0, 0.0, 1.0].map(T::from)
        } else {
            combine(dn.iter().map(|d| d.y), x)
        };
        let normal = unit(cross(t1, t2))?;
        let e1 = unit(t1)?;
        let mean = std::iter::repeat_n(1.0 / x.len() as f64, x.len());
        Some(Self {
            origin: combine(mean, x),
            axes: [e1, cross(normal, e1)],
            normal,
        })
    }

    /// The place `e_a·(x − o)` of a point on the plane.
    #[must_use]
    pub fn project(&self, x: [T; 3]) -> Pair<T> {
        let from_origin = minus(x, self.origin);
        self.axes.map(|axis| dot(axis, from_origin))
    }
}
