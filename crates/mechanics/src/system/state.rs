use super::{Archive, ArchiveError, Between, BodyRates, Layout, Rates};
use signorini_geometry::surface::{Placement, Pose};
use signorini_geometry::tensor::Vec3;

/// The values of all unknowns, and where that puts every node.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Total time.
    pub time: f64,
    /// Raw dofs: displacements of the nodes, translations and rotations of rigid bodies summed up as their increments
    /// came (where rotations are finite only for the record: the poses hold the truth), other fields, multipliers.
    pub u: Vec<f64>,
    /// Whether rotations are small: what follows a carrier moves by its rotation vector times the arm of the start, as all
    /// motions do in a step of small displacements.
    pub is_small: bool,
    /// Poses of the rigid bodies.
    pub poses: Vec<Pose>,
    /// Present positions of the nodes.
    pub x: Vec<Vec3>,
    /// Velocities and accelerations of the nodes, where the state is an accepted one of a motion with inertia.
    pub rates: Option<Rates>,
    /// Where the state is between the ends of an increment of such a motion, what it brings with it.
    pub between: Option<Between>,
    /// The Newton correction that led here, of the raw dofs; empty where none did or no term asks for it. Tangents alone
    /// depend on it.
    pub correction: Vec<f64>,
}

/// The names under which rates are stored.
const RATES: [&str; 2] = ["state.velocity", "state.acceleration"];
const BODY_RATES: &str = "state.bodies";

impl State {
    /// The configuration, as geometry sees it.
    #[must_use]
    pub fn placement(&self) -> Placement<'_> {
        Placement {
            x: &self.x,
            poses: &self.poses,
        }
    }

    /// Stores the state.
    pub fn save(&self, layout: &Layout, out: &mut Archive) {
        out.put("state.time", &[self.time]);
        layout.save("state.u", &self.u, out);
        let numbers = |pose: &Pose| {
            let [a, b, c] = pose.rotation.rows;
            [pose.origin, a, b, c].map(Vec3::to_array)
        };
        let poses: Vec<[f64; 3]> = self.poses.iter().flat_map(numbers).collect();
        out.put("state.poses", poses.as_flattened());
        if let Some(rates) = &self.rates {
            for (name, rates) in RATES.iter().zip([&rates.velocity, &rates.acceleration]) {
                let numbers: Vec<[f64; 3]> = rates.iter().map(|rate| rate.to_array()).collect();
                out.put(*name, numbers.as_flattened());
            }
            let vectors = rates.bodies.iter().flat_map(BodyRates::to_vectors);
            let numbers: Vec<[f64; 3]> = vectors.map(Vec3::to_array).collect();
            out.put(BODY_RATES, numbers.as_flattened());
        }
    }

    /// Takes a stored state back, positions excepted: they follow when the state is advanced.
    ///
    /// # Errors
    /// The archive belongs to another model.
    pub fn load(&mut self, layout: &Layout, from: &Archive) -> Result<(), ArchiveError> {
        from.get("state.time", std::slice::from_mut(&mut self.time))?;
        layout.load("state.u", &mut self.u, from)?;
        let mut numbers = vec![[0.0; 3]; self.poses.len() * 4];
        from.get("state.poses", numbers.as_flattened_mut())?;
        for (pose, n) in self.poses.iter_mut().zip(numbers.chunks_exact(4)) {
            pose.origin = Vec3::from(n[0]);
            for (row, n) in pose.rotation.rows.iter_mut().zip(&n[1..]) {
                *row = Vec3::from(*n);
            }
        }
        self.rates = None;
        self.correction.clear();
        if from.length(RATES[0]).is_ok() {
            let [velocity, acceleration] = RATES.map(|name| {
                let mut numbers = vec![[0.0; 3]; self.x.len()];
                from.get(name, numbers.as_flattened_mut())?;
                Ok(numbers.into_iter().map(Vec3::from).collect())
            });
            let mut numbers = vec![[0.0; 3]; from.length(BODY_RATES).unwrap_or(0) / 3];
            from.get(BODY_RATES, numbers.as_flattened_mut())?;
            let bodies = numbers.as_chunks::<4>().0.iter();
            self.rates = Some(Rates {
                velocity: velocity?,
                acceleration: acceleration?,
                bodies: bodies
                    .map(|of| BodyRates::from_vectors(of.map(Vec3::from)))
                    .collect(),
            });
        }
        Ok(())
    }
}
