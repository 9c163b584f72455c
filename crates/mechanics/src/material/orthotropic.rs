use super::{
    Constants, ConstantsError, Linearity, Material, MaterialError, Order, Response, Strain,
};
use signorini_geometry::tensor::Sym3;

/// Linear elasticity with three planes of symmetry, those of the axes.
///
/// ```text
/// E_11 = S_11/E1 − nu12 S_22/E1 − nu13 S_33/E1,   …,   2 E_12 = S_12/G12,   …
/// ```
///
/// `nu12` is the contraction along 2 under stress along 1, `nu21 = nu12 E2/E1`. At finite strain the same relation holds
/// between `S` and `E` (Saint Venant and Kirchhoff): rotations are exact, strains should stay small.
#[derive(Clone, Debug)]
pub struct Orthotropic {
    /// Stiffness of the normal strains.
    normal: Sym3,
    /// xy, yz, xz.
    shear: [f64; 3],
}

impl Orthotropic {
    /// From `E1 E2 E3 nu12 nu13 nu23 G12 G13 G23`.
    ///
    /// # Errors
    /// One is missing, a modulus is not positive, `nu_ij² ≥ E_i/E_j`, or the three Poisson's ratios together leave the
    /// stiffness not positive definite.
    pub fn new(constants: &Constants) -> Result<Self, ConstantsError> {
        let [e1, e2, e3] = ["E1", "E2", "E3"].map(|name| constants.positive(name));
        let (e1, e2, e3) = (e1?, e2?, e3?);
        let ratio = |name, ei: f64, ej: f64| {
            let value = constants.number(name)?;
            if value * value < ei / ej {
                return Ok(value);
            }
            Err(ConstantsError::Range {
                name,
                value,
                allowed: "smaller than sqrt(Ei/Ej) in size, or the stiffness is not positive definite",
            })
        };
        let nu12 = ratio("nu12", e1, e2)?;
        let nu13 = ratio("nu13", e1, e3)?;
        let nu23 = ratio("nu23", e2, e3)?;
        let compliance = Sym3::new(
            e1.recip(),
            e2.recip(),
            e3.recip(),
            -nu12 / e1,
            -nu23 / e2,
            -nu13 / e1,
        );
        let normal = compliance.inverse().filter(|(_, det)| *det > 0.0);
        let (normal, _) = normal.ok_or(ConstantsError::Unfit {
            what: "the stiffness is not positive definite: nu12² E2/E1 + nu13² E3/E1 + nu23² E3/E2 + 2 nu12 nu13 nu23 E3/E1 \
                   must be less than 1",
        })?;
        let [g12, g23, g13] = ["G12", "G23", "G13"].map(|name| constants.positive(name));
        Ok(Self {
            normal,
            shear: [g12?, g23?, g13?],
        })
    }
}

impl Material for Orthotropic {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let normal = self.normal.to_mat3();
        let [xx, yy, zz, xy, yz, xz] = strain.value.to_pairs();
        let n = normal.rows.map(|r| r.x * xx + r.y * yy + r.z * zz);
        let [g12, g23, g13] = self.shear.map(|g| 2.0 * g);
        out.stress = Sym3::new(n[0], n[1], n[2], g12 * xy, g23 * yz, g13 * xz);
        out.energy = 0.5 * out.stress.double_dot(strain.value);
        if order == Order::Tangent {
            out.tangent = [[0.0; 6]; 6];
            for (i, row) in normal.rows.iter().enumerate() {
                out.tangent[i][..3].copy_from_slice(&[row.x, row.y, row.z]);
                out.tangent[i + 3][i + 3] = self.shear[i];
            }
        }
        Ok(())
    }

    /// That of the stiffest axis.
    fn modulus(&self) -> f64 {
        self.normal.xx().max(self.normal.yy()).max(self.normal.zz())
    }

    fn linearity(&self) -> Linearity {
        Linearity::SmallStrain
    }
}
