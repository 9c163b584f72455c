//! Surfaces given by functions of the user.

use super::analytical::{EMPTY, distance, ellipsoid, ring};
use crate::random::Random;
use crate::surface::*;
use crate::tensor::{Mat3, Sym3, Vec3};

#[test]
fn a_function_and_its_derivatives_are_checked_and_its_errors_arrive() {
    let at = Vec3::new(0.9, 0.4, -0.3);
    ellipsoid(Sym3::diagonal(1.0, 2.0, 3.0), 1.0)
        .check(at, 1e-4)
        .unwrap();
    ring(2.0, 0.5, -1.0).check(at, 1e-4).unwrap();
    let wrong = distance(
        |x| Ok(x.norm() - 1.0),
        |x| Ok(x * 0.5),
        |_| Ok(Sym3::IDENTITY),
    );
    let message = wrong.check(at, 1e-4).unwrap_err().to_string();
    assert!(
        message.contains("the gradient at (0.9, 0.4, -0.3)"),
        "{message}"
    );
    let wrong = distance(
        |x| Ok(0.5 * x.norm_squared() - 0.5),
        Ok,
        |_| Ok(Sym3::IDENTITY * -1.0),
    );
    let message = wrong.check(at, 1e-4).unwrap_err().to_string();
    assert!(message.contains("the Hessian"), "{message}");

    let failing = |value: fn(Vec3) -> Result<f64, String>| {
        let shape = distance(value, |_| Ok(Vec3::unit(2)), |_| Ok(Sym3::ZERO));
        let surface = Analytical::new(Mount::fixed(2), Box::new(shape)).unwrap();
        let mut jet = SurfaceJet::default();
        surface
            .project(&EMPTY, 0, at, None, &mut jet)
            .unwrap_err()
            .to_string()
    };
    let said = failing(|_| Err("no table for this point".into()));
    assert_eq!(said, "the user's surface failed: no table for this point");
    assert!(failing(|_| Ok(f64::NAN)).contains("is not finite"));
    assert!(failing(|_| Ok(1.0)).contains("no zero of the function"));
    // in the plane a function of z has no place
    let tilted = distance(
        |x| Ok(x.y + x.z),
        |_| Ok(Vec3::new(0.0, 1.0, 1.0)),
        |_| Ok(Sym3::ZERO),
    );
    let surface = Analytical::new(Mount::fixed(1), Box::new(tilted)).unwrap();
    let mut jet = SurfaceJet::default();
    let left = surface.project(&EMPTY, 0, Vec3::unit(1), None, &mut jet);
    assert!(left.unwrap_err().to_string().contains("leaves the plane"));
}

/// Rounding in a function goes by its lengths, not by the coordinates near its zero.
#[test]
fn feet_near_the_origin_are_found_though_the_function_rounds_more_coarsely() {
    let mut random = Random(30);
    let c = Vec3::new(0.6, 0.0, -0.8);
    let ball = distance(
        move |x| Ok((x - c).norm() - 1.0),
        move |x| Ok((x - c) / (x - c).norm()),
        move |x| {
            let n = (x - c) / (x - c).norm();
            let across = Mat3::IDENTITY - Mat3::outer(n, n);
            Ok(Sym3::symmetric_part(across) * (x - c).norm().recip())
        },
    );
    let exact = Sphere::new(c, 1.0, Side::Outside).unwrap();
    for _ in 0..2000 {
        let point = random.vector() * 10f64.powf(-20.0 * random.unit());
        let foot = ball.closest(point).unwrap().unwrap();
        let expected = exact.closest(point).unwrap().unwrap();
        assert!((foot - expected).norm() < 4e-15, "{point:?}");
    }
    assert!(ball.closest(Vec3::ZERO).unwrap().is_some());
}
