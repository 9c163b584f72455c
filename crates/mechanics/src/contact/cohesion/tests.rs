use super::*;
use std::f64::consts::FRAC_PI_2;

/// Strength and toughness of the reference points.
const STRENGTH: [f64; 2] = [57.0, 90.0];
const TOUGHNESS: [f64; 2] = [0.28, 0.78];

fn bilinear(ratio: f64, mixity: Mixity, initiation: Initiation) -> Bilinear {
    Bilinear::new([1e6, ratio * 1e6], STRENGTH, TOUGHNESS, mixity, initiation).unwrap()
}

fn all() -> Vec<Box<dyn CohesiveLaw>> {
    let mut laws: Vec<Box<dyn CohesiveLaw>> = Vec::new();
    for ratio in [1.0, 0.895, 0.3] {
        for mixity in [
            Mixity::Interpolated(2.0),
            Mixity::Interpolated(1.45),
            Mixity::Power(1.0),
            Mixity::Power(1.6),
        ] {
            for initiation in [Initiation::Interpolated(2.0), Initiation::Quadratic] {
                laws.push(Box::new(bilinear(ratio, mixity, initiation)));
            }
        }
    }
    laws.push(Box::new(Exponential::new(STRENGTH, [0.28; 2]).unwrap()));
    laws.push(Box::new(Exponential::new([57.0; 2], [0.28; 2]).unwrap()));
    laws
}

fn along(degrees: f64, way: f64) -> [f64; 2] {
    let angle = degrees / 90.0 * FRAC_PI_2;
    [way * angle.cos(), way * angle.sin()]
}

/// The traction along each direction.
fn traction(law: &dyn CohesiveLaw, opening: [f64; 2], damage: f64) -> [f64; 2] {
    let k = law.stiffness();
    [0, 1].map(|c| (1.0 - damage) * k[c] * opening[c])
}

/// Work, and the largest traction, of opening from nothing to an end.
fn work(law: &dyn CohesiveLaw, degrees: f64, end: f64, steps: usize) -> (f64, f64) {
    let (mut sum, mut most, mut before) = (0.0, 0.0_f64, [0.0; 2]);
    let step = end / steps as f64;
    for k in 1..=steps {
        let opening = along(degrees, step * k as f64);
        let now = traction(law, opening, law.load(opening).damage);
        let way = along(degrees, step);
        sum += 0.5 * ((before[0] + now[0]) * way[0] + (before[1] + now[1]) * way[1]);
        most = most.max(now[0].hypot(now[1]));
        before = now;
    }
    (sum, most)
}

/// `reference/thermal/cohesive_points.json`, computed independently: angles, B and the work to failure at K_s = K_n.
const POINTS: [(f64, f64, f64); 5] = [
    (0.0, 0.0, 0.28),
    (20.0, 0.11698, 0.286_841_900_324_438_7),
    (45.0, 0.5, 0.405),
    (70.0, 0.88302, 0.669_864_121_883_924_7),
    (90.0, 1.0, 0.78),
];

#[test]
fn opening_in_any_direction_takes_the_toughness_of_its_mode() {
    for ratio in [1.0, 0.895, 0.3] {
        for (degrees, share, reference) in POINTS {
            let law = bilinear(
                ratio,
                Mixity::Interpolated(2.0),
                Initiation::Interpolated(2.0),
            );
            let [x, y] = along(degrees, 1.0);
            let b = ratio * y * y / (x * x + ratio * y * y);
            let toughness = 0.28 + 0.5 * b * b;
            if ratio == 1.0 {
                assert!((b - share).abs() < 1e-5, "{b} {share}");
                assert!((toughness - reference).abs() < 1e-12);
            }
            let (found, _) = work(&law, degrees, 0.03, 20_000);
            assert!(
                (found - toughness).abs() < 1e-5 * toughness,
                "{ratio} {degrees}: {found}"
            );
            let released = law.released([x, y], 1.0);
            assert!((released - toughness).abs() < 1e-12);
        }
    }
}

#[test]
fn power_laws_take_their_toughness() {
    for (alpha, degrees) in [(1.0, 30.0), (1.0, 60.0), (2.0, 45.0), (1.6, 70.0)] {
        let law = bilinear(1.0, Mixity::Power(alpha), Initiation::Quadratic);
        let [x, y] = along(degrees, 1.0);
        let sum = (x * x / 0.28_f64).powf(alpha) + (y * y / 0.78_f64).powf(alpha);
        let toughness = sum.powf(-1.0 / alpha);
        let (found, _) = work(&law, degrees, 0.03, 20_000);
        assert!((found - toughness).abs() < 1e-5 * toughness, "{alpha}");
    }
}

#[test]
fn pure_modes_begin_to_break_at_their_strength() {
    for law in all() {
        for (degrees, strength) in [(0.0, 57.0), (90.0, STRENGTH[1])] {
            let (_, most) = work(law.as_ref(), degrees, 0.02, 100_000);
            let other = (most - 57.0).abs() < 0.01;
            assert!(
                (most - strength).abs() < 0.01 || degrees == 90.0 && other,
                "{law:?} {degrees}: {most}"
            );
        }
    }
}

#[test]
fn quadratic_initiation_lies_on_its_ellipse() {
    for ratio in [1.0, 0.895, 0.3] {
        for degrees in [10.0, 35.0, 80.0] {
            let law = bilinear(ratio, Mixity::Interpolated(2.0), Initiation::Quadratic);
            let on = |way: f64| {
                let t = traction(&law, along(degrees, way), 0.0);
                (t[0] / 57.0).powi(2) + (t[1] / 90.0).powi(2)
            };
            let way = on(1.0).sqrt().recip();
            assert_eq!(law.load(along(degrees, way * (1.0 - 1e-9))).damage, 0.0);
            assert!(law.load(along(degrees, way * (1.0 + 1e-6))).damage > 0.0);
        }
    }
}

#[test]
fn slopes_of_damage_match_differences() {
    for law in all() {
        for degrees in [0.0, 3.0, 30.0, 55.0, 88.0, 90.0] {
            for way in [1e-5, 1.2e-4, 1e-3, 5e-3] {
                let at = along(degrees, way);
                let loaded = law.load(at);
                for c in 0..2 {
                    let h = 1e-7 * way;
                    let moved = |by: f64| {
                        let mut at = at;
                        at[c] += by;
                        law.load(at).damage
                    };
                    if at[c] < h {
                        continue;
                    }
                    let slope = (moved(h) - moved(-h)) / (2.0 * h);
                    assert!(
                        (loaded.slope[c] - slope).abs() < 1e-7 * (1.0 + slope.abs() * way) / way,
                        "{law:?} {degrees} {way} {c}: {} {slope}",
                        loaded.slope[c]
                    );
                }
            }
        }
    }
}

#[test]
fn what_is_released_is_the_work_less_what_is_stored() {
    for law in all() {
        for degrees in [0.0, 40.0, 90.0] {
            for end in [1e-4, 3e-4, 2e-3] {
                let (work, _) = work(law.as_ref(), degrees, end, 40_000);
                let (at, k) = (along(degrees, end), law.stiffness());
                let damage = law.load(at).damage;
                let stored = 0.5 * (1.0 - damage) * (k[0] * at[0] * at[0] + k[1] * at[1] * at[1]);
                let released = law.released(at, damage);
                assert!(
                    (work - stored - released).abs() < 2e-5 * work,
                    "{law:?} {degrees} {end}: {work} {stored} {released}"
                );
            }
        }
    }
}

#[test]
fn damage_never_heals_and_unloading_gives_nothing_away() {
    for law in all() {
        let cohesion = Cohesion {
            law: Arc::from(law),
            viscosity: 0.0,
        };
        let mut damage = Damage::default();
        let mut last = [0.0; 2];
        for k in 0..200 {
            // there and back, ever further, and from mode to mode
            let way = 1e-5 * f64::from(k) * (0.5 + 0.5 * (0.7 * f64::from(k)).sin());
            let opening = along(f64::from(k % 90), way);
            let grown = cohesion.grow(opening, damage, 1.0);
            assert!(grown.damage.grown >= damage.grown && grown.damage.grown <= 1.0);
            let [released, viscous] = cohesion.spent([last, opening], [damage, grown.damage]);
            assert!(released >= 0.0 && viscous == 0.0);
            (damage, last) = (grown.damage, opening);
        }
        assert!(damage.grown > 0.0);
    }
}

#[test]
fn viscosity_delays_damage_and_its_work_adds_up() {
    let law = bilinear(
        1.0,
        Mixity::Interpolated(2.0),
        Initiation::Interpolated(2.0),
    );
    let cohesion = Cohesion {
        law: Arc::new(law),
        viscosity: 0.02,
    };
    let (mut damage, mut last) = (Damage::default(), [0.0; 2]);
    let (mut work, mut spent, mut before) = (0.0, [0.0; 2], [0.0; 2]);
    let steps = 20_000;
    for k in 1..=steps {
        let opening = along(30.0, 0.02 * f64::from(k) / f64::from(steps));
        let grown = cohesion.grow(opening, damage, 1.0 / f64::from(steps));
        assert!(grown.damage.acting <= grown.damage.grown);
        let now = traction(&law, opening, grown.damage.acting);
        for c in 0..2 {
            work += 0.5 * (before[c] + now[c]) * (opening[c] - last[c]);
        }
        let [released, viscous] = cohesion.spent([last, opening], [damage, grown.damage]);
        spent = [spent[0] + released, spent[1] + viscous];
        (damage, last, before) = (grown.damage, opening, now);
    }
    let stored = 0.5 * (before[0] * last[0] + before[1] * last[1]);
    assert!(damage.acting > 0.999 && spent[1] > 0.05 * spent[0]);
    let all = spent[0] + spent[1] + stored;
    assert!((work - all).abs() < 1e-4 * work, "{work} {spent:?}");
}

#[test]
fn the_slope_with_viscosity_matches_differences() {
    let law = bilinear(0.895, Mixity::Interpolated(2.0), Initiation::Quadratic);
    let cohesion = Cohesion {
        law: Arc::new(law),
        viscosity: 0.3,
    };
    let before = Damage {
        grown: 0.2,
        acting: 0.1,
    };
    let at = [4e-4, 7e-4];
    let grown = cohesion.grow(at, before, 0.1);
    for c in 0..2 {
        let moved = |by: f64| {
            let mut at = at;
            at[c] += by;
            cohesion.grow(at, before, 0.1).damage.acting
        };
        let slope = (moved(1e-10) - moved(-1e-10)) / 2e-10;
        assert!((grown.slope[c] - slope).abs() < 1e-6 * slope.abs());
    }
    let held = cohesion.grow([1e-6, 0.0], before, 0.1);
    assert_eq!((held.damage.grown, held.slope), (0.2, [0.0; 2]));
    assert!(held.damage.acting > before.acting);
}

#[test]
fn bonds_that_store_more_than_their_toughness_are_refused() {
    let law =
        |k: f64, mixity| Bilinear::new([k; 2], STRENGTH, TOUGHNESS, mixity, Initiation::Quadratic);
    let least = Bilinear::stiff_enough(STRENGTH, TOUGHNESS, 1.0);
    let mixity = Mixity::Interpolated(2.0);
    assert!(matches!(
        law(0.9 * least, mixity),
        Err(CohesionError::Brittle { .. })
    ));
    for mixity in [mixity, Mixity::Power(1.0), Mixity::Power(3.0)] {
        assert!(law(10.0 * least, mixity).is_ok());
    }
    assert_eq!(
        Exponential::new(STRENGTH, TOUGHNESS),
        Err(CohesionError::Unequal)
    );
}
