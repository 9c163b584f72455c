use super::frame::Frame;
use super::{ConstantsError, Linearity, Material, MaterialError, Order, Response, Strain};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};

/// A law whose axes are not the global ones: the same everywhere, or those that come with the strain, [`Strain::axes`].
///
/// The history of the law inside is in its own axes.
pub struct Oriented {
    inner: Box<dyn Material>,
    /// None: those that come with the strain.
    frame: Option<Frame>,
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
                frame: Some(Frame {
                    axes: Mat3::from_rows([x, second, x.cross(second)]),
                }),
            }),
            _ => Err(unfit),
        }
    }

    /// The axes are those of the point, which come with the strain; the global ones where none come.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
    /// use signorini_mechanics::material::{
    ///     Constants, Kinematics, Material, Order, Oriented, Response, Strain, by_name,
    /// };
    ///
    /// // nine times as stiff along the first axis, which is y here
    /// let mut constants = Constants::default();
    /// for (name, value) in [
    ///     ("E1", 900.0), ("E2", 100.0), ("E3", 100.0), ("nu12", 0.0), ("nu13", 0.0), ("nu23", 0.0),
    ///     ("G12", 50.0), ("G13", 50.0), ("G23", 50.0),
    /// ] {
    ///     constants.set(name, vec![value]);
    /// }
    /// let wood = by_name("orthotropic").ok_or("not in the table")?;
    /// let wood = Oriented::at_points((wood.make)(&constants)?);
    /// let turned = Mat3::from_rows([Vec3::unit(1), -Vec3::unit(0), Vec3::unit(2)]);
    /// let strain = Strain {
    ///     axes: Some(&turned),
    ///     ..Strain::new(Kinematics::Small, Sym3::diagonal(1e-3, 1e-3, 0.0))
    /// };
    /// let mut response = Response::default();
    /// wood.respond(&strain, &[], &mut [], Order::Stress, &mut response)?;
    /// assert!((response.stress.xx() - 0.1).abs() < 1e-12);
    /// assert!((response.stress.yy() - 0.9).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn at_points(inner: Box<dyn Material>) -> Self {
        Self { inner, frame: None }
    }

    /// The axes at a strain.
    fn frame(&self, strain: &Strain) -> Option<Frame> {
        self.frame.or(strain.axes.map(|&axes| Frame { axes }))
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
        let Some(frame) = self.frame(strain) else {
            return self.inner.respond(strain, old, new, order, out);
        };
        let inside = Strain {
            value: frame.enter(strain.value),
            ..*strain
        };
        self.inner.respond(&inside, old, new, order, out)?;
        frame.turn_back(order, out);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.inner.modulus()
    }

    fn is_symmetric(&self) -> bool {
        self.inner.is_symmetric()
    }

    fn is_elastic(&self) -> bool {
        self.inner.is_elastic()
    }

    fn mechanical_strain(&self, strain: &Strain) -> Sym3 {
        let Some(frame) = self.frame(strain) else {
            return self.inner.mechanical_strain(strain);
        };
        let inside = Strain {
            value: frame.enter(strain.value),
            ..*strain
        };
        frame.leave(self.inner.mechanical_strain(&inside))
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        self.inner.plastic_strain(history)
    }

    fn linearity(&self) -> Linearity {
        self.inner.linearity().within()
    }
}
