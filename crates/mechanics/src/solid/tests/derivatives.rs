//! One walk over everything that is allowed: forces are the gradient of the energy, stiffness that of forces.

use super::*;

/// A law with a potential over the increment: `½ E:ℂ:E + ½ η |E − E_old|²`, history `E`.
pub(super) struct Viscous;

const VISCOSITY: f64 = 80.0;

impl Material for Viscous {
    fn nhistory(&self) -> usize {
        6
    }

    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: MaterialOrder,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let mut none = [];
        elastic("linear-elastic", 0.3).respond(strain, &[], &mut none, order, out)?;
        let values = strain.value.to_pairs();
        new.copy_from_slice(&values);
        let last: [f64; 6] = std::array::from_fn(|k| old[k]);
        let change = strain.value - Sym3::from_pairs(last);
        out.stress = out.stress + change * VISCOSITY;
        out.energy += 0.5 * VISCOSITY * change.double_dot(change);
        out.across = strain.value.zz();
        for k in 0..6 {
            out.tangent[k][k] += if k < 3 { VISCOSITY } else { 0.5 * VISCOSITY };
        }
        Ok(())
    }

    fn modulus(&self) -> f64 {
        elastic("linear-elastic", 0.3).modulus()
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        history.first().map(|h| h.abs())
    }
}

/// A law whose tangent is not symmetric.
struct Skew;

impl Material for Skew {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: MaterialOrder,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        elastic("linear-elastic", 0.3).respond(strain, &[], &mut [], order, out)?;
        let e = strain.value;
        out.stress = out.stress + Sym3::new(90.0 * e.yy(), 0.0, 0.0, 60.0 * e.zz(), 0.0, 0.0);
        out.tangent[0][1] += 90.0;
        out.tangent[3][2] += 60.0;
        Ok(())
    }

    fn modulus(&self) -> f64 {
        elastic("linear-elastic", 0.3).modulus()
    }

    fn is_symmetric(&self) -> bool {
        false
    }
}

pub(super) type Make = Box<dyn Fn() -> Box<dyn Material>>;

/// Steel that yields at a small strain already.
pub(super) fn plastic() -> Box<dyn Material> {
    let table = vec![[8.0, 0.0], [30.0, 1.0]];
    let hardening = Hardening::new(HardeningKind::Isotropic, table).unwrap();
    Box::new(Plasticity::new(500.0, 0.3, hardening).unwrap())
}

/// Every law of the table, and those that are not in it.
pub(super) fn laws() -> Vec<(&'static str, Make)> {
    let mut laws: Vec<(&'static str, Make)> = Vec::new();
    for law in &TABLE {
        let make = || (law.make)(&Constants::sample()).unwrap();
        laws.push((law.name, Box::new(make)));
    }
    laws.push((
        "nearly incompressible",
        Box::new(|| elastic("neo-hookean", 0.49)),
    ));
    laws.push(("plastic", Box::new(plastic)));
    laws.push(("with history", Box::new(|| Box::new(Viscous))));
    laws.push(("unsymmetric", Box::new(|| Box::new(Skew))));
    laws.push((
        "expanding",
        Box::new(|| Box::new(Expanding::new(elastic("neo-hookean", 0.3), 1e-3, 20.0))),
    ));
    laws
}

/// Fourth-order differences.
fn slope(h: f64, mut at: impl FnMut(f64) -> f64) -> f64 {
    (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
}

pub(super) fn check(body: &Body, potential: bool, what: &str) {
    let n = body.layout.ndof();
    let size = if n > 24 { 0.02 } else { 0.05 };
    let u: Vec<f64> = (0..n).map(|k| size * noise(100 + k)).collect();
    let mut work = Work::default();
    let at = body.assemble(&u, Order::Tangent, &mut work);
    let scale = at.scale();
    let h = 2e-5;
    for j in 0..n {
        let mut shifted = u.clone();
        if potential {
            let force = slope(h, |d| {
                shifted[j] = u[j] + d;
                body.energy(&shifted, &mut work)
            });
            let error = (force - at.force[j]).abs();
            assert!(error < 1e-7 * scale, "{what}: force {j} off by {error:e}");
        }
        let columns = [h, -h, 2.0 * h, -2.0 * h].map(|d| {
            shifted[j] = u[j] + d;
            body.assemble(&shifted, Order::Residual, &mut work).force
        });
        for i in 0..n {
            let [a, b, c, d] = columns.each_ref().map(|f| f[i]);
            let k = (8.0 * (a - b) - (c - d)) / (12.0 * h);
            let error = (k - at.stiffness[i * n + j]).abs();
            assert!(
                error < 1e-7 * scale,
                "{what}: stiffness {i} {j} off by {error:e}"
            );
            if potential {
                let turned = (at.stiffness[i * n + j] - at.stiffness[j * n + i]).abs();
                assert!(
                    turned < 1e-11 * scale,
                    "{what}: {i} {j} unsymmetric by {turned:e}"
                );
            }
        }
    }
}

/// What the room's table allows, written down a second time.
pub(super) fn allowed(element: &str, wish: &Wish) -> bool {
    let finite = wish.kinematics == Kinematics::Finite;
    let sheet = matches!(wish.space, Idealisation::PlaneStress { .. });
    let reduced = wish.integration == Integration::Reduced && ["quad8", "hex20"].contains(&element);
    let bare = ["tri3", "tet4", "wedge6"].contains(&element);
    match wish.locking {
        Locking::Auto | Locking::None => true,
        Locking::BBar => !finite && !sheet && !bare && !reduced,
        Locking::FBar => finite && !sheet && !bare && !reduced,
        Locking::Incompatible => !finite && ["quad4", "hex8"].contains(&element),
        Locking::Shear => !finite && element == "quad4",
        Locking::Shell => element == "hex8",
    }
}

#[test]
fn forces_are_the_gradient_of_energy_and_stiffness_that_of_forces_for_all_that_is_allowed() {
    let laws = laws();
    let (mut checked, mut refused) = (0, 0);
    for (element, space) in elements() {
        let mesh = one(element, space);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            for locking in LOCKINGS {
                for integration in [Integration::Full, Integration::Reduced] {
                    let wish = Wish {
                        space,
                        kinematics,
                        locking,
                        integration,
                    };
                    for (law, make) in &laws {
                        let name = element.name();
                        let what = format!(
                            "{name} {space:?} {kinematics:?} {locking} {integration:?} {law}"
                        );
                        let made = body(&mesh, make(), &wish);
                        assert_eq!(made.is_ok(), allowed(name, &wish), "{what}");
                        let Ok(body) = made else {
                            refused += 1;
                            continue;
                        };
                        let potential = make().is_symmetric();
                        let distinct =
                            integration == Integration::Full || ["quad8", "hex20"].contains(&name);
                        if !distinct || locking == Locking::Auto {
                            continue;
                        }
                        check(&body, potential, &what);
                        checked += 1;
                    }
                }
            }
        }
    }
    println!("{checked} combinations checked, {refused} refused");
    assert!(checked > 800 && refused > 800);
}
