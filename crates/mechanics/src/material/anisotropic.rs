use super::{
    Constants, ConstantsError, Linearity, Material, MaterialError, Order, Response, Strain,
};
use signorini_geometry::tensor::Sym3;

/// Linear elasticity without any symmetry but that of its energy.
///
/// ```text
/// S_ij = D_ijkl E_kl
/// ```
///
/// `D` is given by the columns of its upper half, in the order 11, 22, 33, 12, 13, 23 of stresses and strains: `D1111`,
/// `D1122`, `D2222`, `D1133`, `D2233`, `D3333`, `D1112`, …, `D2323`, 21 numbers. At finite strain the same relation
/// holds between `S` and `E`: rotations are exact, strains should stay small.
#[derive(Clone, Debug)]
pub struct Anisotropic {
    /// Over [`Sym3::PAIRS`]; multiplies strains with doubled shears.
    stiffness: [[f64; 6]; 6],
}

/// Places of 11, 22, 33, 12, 13, 23 in [`Sym3::PAIRS`].
const ORDER: [usize; 6] = [0, 1, 2, 3, 5, 4];

impl Anisotropic {
    /// From the constant `D`, a list of 21.
    ///
    /// # Errors
    /// It is missing, has not 21 numbers, or is not positive definite.
    pub fn new(constants: &Constants) -> Result<Self, ConstantsError> {
        let given = constants.list("D")?;
        if given.len() != 21 {
            return Err(ConstantsError::Unfit {
                what: "D must have 21 numbers: the columns of the upper half of the stiffness",
            });
        }
        let mut stiffness = [[0.0; 6]; 6];
        let places = (0..6).flat_map(|column| (0..=column).map(move |row| (row, column)));
        for ((row, column), &value) in places.zip(given) {
            let (i, j) = (ORDER[row], ORDER[column]);
            stiffness[i][j] = value;
            stiffness[j][i] = value;
        }
        if !is_positive(stiffness) {
            return Err(ConstantsError::Unfit {
                what: "D is not positive definite",
            });
        }
        Ok(Self { stiffness })
    }
}

/// Whether a symmetric matrix is positive definite: whether it has pivots, and all are positive.
#[allow(clippy::needless_range_loop)] // two rows of one matrix
fn is_positive(mut a: [[f64; 6]; 6]) -> bool {
    for k in 0..6 {
        let pivot = a[k][k];
        // not for a NaN either
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        for i in k + 1..6 {
            let factor = a[i][k] / pivot;
            for j in k..6 {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    true
}

impl Material for Anisotropic {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let [xx, yy, zz, xy, yz, xz] = strain.value.to_pairs();
        let engineering = [xx, yy, zz, 2.0 * xy, 2.0 * yz, 2.0 * xz];
        let stress = self.stiffness.map(|row| {
            let products = row.iter().zip(&engineering).map(|(d, e)| d * e);
            products.sum()
        });
        out.stress = Sym3::from_pairs(stress);
        out.energy = 0.5 * out.stress.double_dot(strain.value);
        if order == Order::Tangent {
            out.tangent = self.stiffness;
        }
        Ok(())
    }

    /// That of the stiffest axis.
    fn modulus(&self) -> f64 {
        (0..3).map(|i| self.stiffness[i][i]).fold(0.0, f64::max)
    }

    fn linearity(&self) -> Linearity {
        Linearity::SmallStrain
    }
}
