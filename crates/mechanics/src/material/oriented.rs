use super::frame::Frame;
use super::{ConstantsError, Linearity, Material, MaterialError, Order, Response, Strain};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// A law whose axes are not the global ones.
///
/// The history of the law inside is in its own axes.
pub struct Oriented {
    inner: Box<dyn Material>,
    frame: Frame,
}

/// The smallest sine between the two vectors.
const SINE: f64 = 1e-6;

impl Oriented {
    /// The first axis is along `x`, the second in the plane of `x` and `y` on the side of `y`; any lengths.
    ///
    /// # Errors
    /// A vector is zero, or they are parallel.
    pub fn new(inner: Box<dyn Material>, x: Vec3, y: Vec3) -> Result<Self, ConstantsError> {
        let unfit = ConstantsError::Unfit {
            what: "the vectors x and y of an orientation must be finite, not zero and not parallel",
        };
        let (Some(x), Some(y)) = (x.normalized(), y.normalized()) else {
            return Err(unfit);
        };
        let across = y - x * x.dot(y);
        match across.normalized() {
            Some(second) if across.norm() > SINE => Ok(Self {
                inner,
                frame: Frame {
                    axes: Mat3::from_rows([x, second, x.cross(second)]),
                },
            }),
            _ => Err(unfit),
        }
    }
}

impl Material for Oriented {
    fn nhistory(&self) -> usize {
        self.inner.nhistory()
    }

    fn start(&self, history: &mut [f64]) {
        self.inner.start(history);
    }

    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let inside = Strain {
            value: self.frame.enter(strain.value),
            ..*strain
        };
        self.inner.respond(&inside, old, new, order, out)?;
        self.frame.turn_back(order, out);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.inner.modulus()
    }

    fn is_symmetric(&self) -> bool {
        self.inner.is_symmetric()
    }

    fn mechanical_strain(&self, strain: &Strain) -> Sym3 {
        let inside = Strain {
            value: self.frame.enter(strain.value),
            ..*strain
        };
        self.frame.leave(self.inner.mechanical_strain(&inside))
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        self.inner.plastic_strain(history)
    }

    fn linearity(&self) -> Linearity {
        self.inner.linearity().within()
    }
}
