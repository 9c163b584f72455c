use super::Pair;
use super::flat::{Flat, jacobian, residual, solve};
use crate::scalar::Real;
use crate::tensor::Vec3;

/// Steps of Newton's method: from the centre it needs a handful.
const MAX_STEPS: usize = 30;

/// A step so small that the next one is below rounding.
const SMALL: f64 = 1e-9;

/// No step is longer: the reference domain is two wide at most, and a step across it means that the tangents are
/// nearly parallel.
const LONGEST: f64 = 1.0;

/// The parameters (E2) of a place on the plane, with derivatives; `None` where Newton's method finds none.
pub(super) fn parameters<T: Real>(flat: &Flat<T>, p: Pair<T>) -> Option<Pair<T>> {
    let element = flat.element();
    let x = flat.values();
    let at = p.map(|c| c.value());
    let mut xi = element.centre();
    let nnode = element.nnode();
    let step = |xi: &mut Vec3| {
        let r = residual(element, &x[..nnode], xi, at);
        let [a, b] = solve(element, jacobian(element, &x, xi), r);
        let size = a.abs().max(b.abs());
        *xi -= Vec3::new(a, b, 0.0) * (LONGEST / size.max(LONGEST));
        size
    };
    (0..MAX_STEPS).find(|_| step(&mut xi) <= SMALL)?;
    // the last step, in numbers with derivatives: ∂ξ/∂v = −J⁻¹ ∂r/∂v where r = 0
    let t = jacobian(element, &x, &xi);
    let r = residual(element, flat.x(), &xi, p);
    let value = solve(element, t, r.map(|c| c.value()));
    let [a, b] = [solve(element, t, [1.0, 0.0]), solve(element, t, [0.0, 1.0])];
    Some([0, 1].map(|c| T::chain(xi[c] - value[c], &[(-a[c], r[0]), (-b[c], r[1])])))
}
