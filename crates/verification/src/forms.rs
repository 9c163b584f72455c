//! Closed forms. Compression is positive pressure; `E* = 1/((1 − ν₁²)/E₁ + (1 − ν₂²)/E₂)`.

use std::f64::consts::PI;

/// The contact modulus of two bodies, each with modulus and Poisson's ratio; of a rigid one the modulus is infinite.
pub(crate) fn contact_modulus(bodies: [[f64; 2]; 2]) -> f64 {
    1.0 / bodies
        .map(|[e, nu]| (1.0 - nu * nu) / e)
        .iter()
        .sum::<f64>()
}

/// Hertz's contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hertz {
    /// The load: per length of a line, or in all.
    pub(crate) load: f64,
    /// The largest pressure.
    pub(crate) p0: f64,
}

/// Hertz along a line: the load per length, and the pressure, that belong to a half-width (Johnson, 4.43 to 4.45).
pub(crate) fn hertz_line(a: f64, radius: f64, modulus: f64) -> Hertz {
    let load = PI * modulus * a * a / (4.0 * radius);
    Hertz {
        load,
        p0: 2.0 * load / (PI * a),
    }
}

/// Hertz at a point: the load, and the pressure, that belong to a radius of contact (Johnson, 4.22 to 4.24).
pub(crate) fn hertz_point(a: f64, radius: f64, modulus: f64) -> Hertz {
    let load = 4.0 * modulus * a.powi(3) / (3.0 * radius);
    Hertz {
        load,
        p0: 3.0 * load / (2.0 * PI * a * a),
    }
}

/// Stress along and across the surface below the middle of Hertz's line contact, at a depth (Johnson, 4.46).
pub(crate) fn hertz_line_axis(a: f64, p0: f64, depth: f64) -> [f64; 2] {
    let root = (a * a + depth * depth).sqrt();
    [
        -p0 / a * ((a * a + 2.0 * depth * depth) / root - 2.0 * depth),
        -p0 * a / root,
    ]
}

/// The work of friction per length of Cattaneo's and Mindlin's cylinders: `∫ μ p s dx` over the slip zones, with the slip
/// `s(x) = 2 μ p0/(E* a) ∫_c^x √(ξ² − c²) dξ` (Johnson, section 7.2).
pub(crate) fn cattaneo_work(a: f64, c: f64, p0: f64, mu: f64, modulus: f64) -> f64 {
    let slip = |x: f64| {
        let root = (x * x - c * c).max(0.0).sqrt();
        mu * p0 / (modulus * a) * (x * root - c * c * ((x + root) / c).ln())
    };
    let shear = |x: f64| mu * p0 * (1.0 - (x / a).powi(2)).max(0.0).sqrt();
    2.0 * integral(|x| shear(x) * slip(x), c, a)
}

/// Simpson's rule on 2000 spaces.
pub(crate) fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const N: usize = 2000;
    let h = (to - from) / N as f64;
    let weight = |i: usize| match i {
        0 | N => 1.0,
        _ if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let sum: f64 = (0..=N).map(|i| weight(i) * f(from + h * i as f64)).sum();
    sum * h / 3.0
}

/// Where a function that changes its sign between two points vanishes, by bisection.
pub(crate) fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let rises = f(high) > f(low);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == rises {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// A tube or a spherical shell from `a` to `b` under pressure inside and outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    pub(crate) a: f64,
    pub(crate) b: f64,
    pub(crate) inside: f64,
    pub(crate) outside: f64,
    pub(crate) e: f64,
    pub(crate) nu: f64,
}

impl Wall {
    /// Radial displacement and hoop stress in plane strain (Lamé; Timoshenko and Goodier, section 28).
    pub(crate) fn tube_in_plane_strain(&self, r: f64) -> [f64; 2] {
        let (mean, part) = self.tube(r);
        let Self { e, nu, .. } = *self;
        let u = (1.0 + nu) / e * ((1.0 - 2.0 * nu) * mean + part) * r;
        [u, mean + part]
    }

    /// The same in plane stress.
    pub(crate) fn tube_in_plane_stress(&self, r: f64) -> [f64; 2] {
        let (mean, part) = self.tube(r);
        let Self { e, nu, .. } = *self;
        [((1.0 - nu) * mean + (1.0 + nu) * part) * r / e, mean + part]
    }

    /// The mean of radial and hoop stress, and half of their difference.
    fn tube(&self, r: f64) -> (f64, f64) {
        let [aa, bb] = [self.a, self.b].map(|x| x * x);
        let mean = (self.inside * aa - self.outside * bb) / (bb - aa);
        let part = (self.inside - self.outside) * aa * bb / (bb - aa) / (r * r);
        (mean, part)
    }

    /// Radial displacement and hoop stress of a spherical shell (Timoshenko and Goodier, section 136).
    pub(crate) fn sphere(&self, r: f64) -> [f64; 2] {
        let [aaa, bbb] = [self.a, self.b].map(|x| x.powi(3));
        let mean = (self.inside * aaa - self.outside * bbb) / (bbb - aaa);
        let part = (self.inside - self.outside) * aaa * bbb / (2.0 * (bbb - aaa)) / r.powi(3);
        let (radial, hoop) = (mean - 2.0 * part, mean + part);
        [
            r / self.e * ((1.0 - self.nu) * hoop - self.nu * radial),
            hoop,
        ]
    }
}

/// The pressure between a body and one around it whose sides overlap, from the radial displacements of the outer and of the
/// inner one at their common radius under a pressure of one between them.
pub(crate) fn fit_pressure(overlap: f64, outer: f64, inner: f64) -> f64 {
    overlap / (outer - inner)
}

/// A law in principal stretches: Kirchhoff stresses.
pub(crate) type Kirchhoff<'a> = &'a dyn Fn([f64; 3]) -> [f64; 3];

/// Uniaxial stress at a stretch: the nominal stress and the lateral stretch.
pub(crate) fn uniaxial(law: Kirchhoff<'_>, stretch: f64) -> [f64; 2] {
    let lateral = root(|t| law([stretch, t, t])[1], 0.05, 20.0);
    [law([stretch, lateral, lateral])[0] / stretch, lateral]
}

/// `W = μ/2 (I₁ − 3) − μ ln J + λ/2 (ln J)²`.
pub(crate) fn neo_hookean(mu: f64, lambda: f64, l: [f64; 3]) -> [f64; 3] {
    let volume = l.iter().product::<f64>().ln();
    l.map(|l| mu * (l * l - 1.0) + lambda * volume)
}

/// `W = Σ 2μ/α² (l̄₁^α + l̄₂^α + l̄₃^α − 3) + K/2 (J − 1)²`, terms as `[μ, α]`.
pub(crate) fn ogden(terms: &[[f64; 2]], bulk: f64, l: [f64; 3]) -> [f64; 3] {
    let j: f64 = l.iter().product();
    let mut stress = [bulk * j * (j - 1.0); 3];
    for [mu, alpha] in terms {
        let x = l.map(|l| (l / j.cbrt()).powf(*alpha));
        let mean = x.iter().sum::<f64>() / 3.0;
        for (s, x) in stress.iter_mut().zip(x) {
            *s += 2.0 * mu / alpha * (x - mean);
        }
    }
    stress
}

/// A cantilever bent by a force across its end, without shear and stretch: deflection and shortening over the length, for
/// `P L²/(E I)`; integrated by Runge and Kutta, the slope at the end by bisection (Bisshopp and Drucker 1945).
pub(crate) fn elastica(load: f64) -> [f64; 2] {
    const N: usize = 2000;
    let h = 1.0 / N as f64;
    // angle and its change along the length, from the clamped end; then the two coordinates
    let march = |curvature: f64| {
        let slope =
            |[angle, bend, _, _]: [f64; 4]| [bend, -load * angle.cos(), angle.cos(), angle.sin()];
        let step =
            |y: [f64; 4], d: [f64; 4], part: f64| [0, 1, 2, 3].map(|i| y[i] + part * h * d[i]);
        (0..N).fold([0.0, curvature, 0.0, 0.0], |y, _| {
            let a = slope(y);
            let b = slope(step(y, a, 0.5));
            let c = slope(step(y, b, 0.5));
            let d = slope(step(y, c, 1.0));
            [0, 1, 2, 3].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
        })
    };
    let curvature = root(|curvature| march(curvature)[1], 0.0, load);
    let [_, _, x, y] = march(curvature);
    [y, 1.0 - x]
}

/// The pin in a hole of the same material (Persson 1964; Ciavarella and Decuzzi 2001): clearance times plane modulus over
/// load, `E₁* ΔR/Q`, and largest pressure times radius over load, for `b = tan(ε/2)` of the half-angle of contact `ε`.
pub(crate) fn persson(b: f64) -> [f64; 2] {
    // t = b sin φ takes the root out of the logarithm
    let logarithm = |t: f64| {
        let (long, short) = ((b * b + 1.0).sqrt(), (b * b - t * t).max(0.0).sqrt());
        ((long + short) / (long - short)).ln()
    };
    let i = integral(
        |phi| {
            let t = b * phi.sin();
            logarithm(t) / (1.0 + t * t) * b * phi.cos()
        },
        -0.5 * PI,
        0.5 * PI,
    );
    [
        2.0 / PI * (1.0 - b * b) / (b * b) - i / (PI * PI * b * b * (1.0 + b * b)),
        persson_pressure(b, 0.0),
    ]
}

/// The pressure at `y = tan(φ/2)`, times radius over load.
pub(crate) fn persson_pressure(b: f64, y: f64) -> f64 {
    let (long, short) = ((b * b + 1.0).sqrt(), (b * b - y * y).max(0.0).sqrt());
    2.0 / (PI * long) * short / (1.0 + y * y)
        + ((long + short) / (long - short)).ln() / (2.0 * PI * b * b * (1.0 + b * b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(value: f64, reference: f64, part: f64) {
        assert!(
            (value - reference).abs() <= part * reference.abs(),
            "{value} for {reference}"
        );
    }

    /// Equal cylinders of radius 8, and a rigid ball; numbers of an independent implementation.
    #[test]
    fn hertz_and_cattaneo_agree_with_another_implementation() {
        let modulus = contact_modulus([[200.0, 0.3]; 2]);
        let line = hertz_line(0.680_778_37, 4.0, modulus);
        near(line.load, 10.0, 1e-7);
        near(line.p0, 9.351_351_29, 1e-7);
        let work = cattaneo_work(0.680_778_37, 0.564_655, 9.351_351_29, 0.3, modulus);
        near(work, 1.575_23e-4, 1e-4);
        let rigid = contact_modulus([[1.0, 0.3], [f64::INFINITY, 0.0]]);
        let point = hertz_point(0.088_044_6, 1.0, rigid);
        near(point.load, 0.001, 3e-5);
        near(point.p0, 0.061_594_2, 1e-5);
    }

    #[test]
    fn fits_agree_with_another_implementation() {
        let wall = |a: f64, b: f64, inside: f64, outside: f64| Wall {
            a,
            b,
            inside,
            outside,
            e: 1000.0,
            nu: 0.3,
        };
        let (outer, inner) = (wall(1.0, 1.5, 1.0, 0.0), wall(0.5, 1.0, 0.0, 1.0));
        let strain = [outer, inner].map(|w| w.tube_in_plane_strain(1.0)[0]);
        near(fit_pressure(0.01, strain[0], strain[1]), 2.575_549_45, 1e-8);
        let stress = [outer, inner].map(|w| w.tube_in_plane_stress(1.0)[0]);
        near(fit_pressure(0.01, stress[0], stress[1]), 2.343_75, 1e-9);
        let spheres = [outer, inner].map(|w| w.sphere(1.0)[0]);
        near(
            fit_pressure(0.01, spheres[0], spheres[1]),
            6.089_743_59,
            1e-8,
        );
    }

    #[test]
    fn large_strains_are_small_ones_where_they_are_small() {
        let (mu, lambda) = (1.0, 1.5);
        let young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
        let [stress, lateral] = uniaxial(&|l| neo_hookean(mu, lambda, l), 1.0 + 1e-6);
        near(stress, young * 1e-6, 1e-5);
        near(lateral - 1.0, -0.3e-6, 1e-4);
        let terms = [[0.6, 1.3], [0.4, -2.0]];
        let bulk = 5.0 / 3.0;
        let [stress, _] = uniaxial(&|l| ogden(&terms, bulk, l), 1.0 + 1e-6);
        near(stress, 9.0 * bulk / (3.0 * bulk + 1.0) * 1e-6, 1e-5);
    }

    /// Mattiasson, Int. J. Numer. Meth. Engng 17 (1981) 145–153.
    #[test]
    fn the_elastica_is_that_of_the_tables() {
        for (load, w, u) in [(1.0, 0.30172, 0.05643), (10.0, 0.81061, 0.55500)] {
            let [deflection, shortening] = elastica(load);
            assert!((deflection - w).abs() < 1e-5 && (shortening - u).abs() < 1e-5);
        }
    }

    #[test]
    fn the_pressure_of_the_pin_carries_its_load_and_is_that_of_hertz_where_contact_is_short() {
        for b in [0.05_f64, 0.3, 0.8] {
            let end = 2.0 * b.atan();
            let carried = integral(
                |turn| {
                    let angle = end * turn.sin();
                    persson_pressure(b, (0.5 * angle).tan()) * angle.cos() * end * turn.cos()
                },
                -0.5 * PI,
                0.5 * PI,
            );
            near(carried, 1.0, 1e-6);
        }
        let [clearance, p0] = persson(0.01);
        near(clearance, 2.0 / (PI * 1e-4), 1e-3);
        near(p0, 1.0 / (PI * 0.01), 1e-3);
    }
}
