//! Means over the rows around each node.

use signorini_geometry::tensor::Vec3;

/// The mean of a weighted sum; 0 where nothing was added.
pub(super) fn mean((sum, weight): (f64, f64)) -> f64 {
    if weight > 0.0 { sum / weight } else { 0.0 }
}

/// Sums over the rows around each node, with its shares of their areas as weights.
pub(super) struct Means {
    /// Of rows that meet something, and of all: pressures are means over these, too, so that they add up to the force.
    pub weight: Vec<f64>,
    pub whole: Vec<f64>,
    pub normal: Vec<Vec3>,
    pub gap: Vec<f64>,
    pub pressure: Vec<f64>,
    pub traction: Vec<Vec3>,
    pub multiplier: Vec<f64>,
    pub multiplier_traction: Vec<Vec3>,
    pub slip: Vec<Vec3>,
    pub elastic_slip: Vec<Vec3>,
    pub damage: Vec<f64>,
    pub heat: Vec<[f64; 3]>,
}

/// What a row adds to the means.
pub(super) struct OfRow {
    pub normal: Vec3,
    pub gap: f64,
    pub pressure: f64,
    /// On the side whose means these are.
    pub traction: Vec3,
    /// Both before smoothing.
    pub multiplier: f64,
    pub multiplier_traction: Vec3,
    pub slip: Vec3,
    pub elastic_slip: Vec3,
    /// Of a bond that may break.
    pub damage: f64,
    /// Per area: the flux out of the side whose means these are, the conductance, and the heat of friction.
    pub heat: [f64; 3],
}

impl Means {
    pub fn new(n: usize) -> Self {
        Self {
            weight: vec![0.0; n],
            whole: vec![0.0; n],
            normal: vec![Vec3::ZERO; n],
            gap: vec![0.0; n],
            pressure: vec![0.0; n],
            traction: vec![Vec3::ZERO; n],
            multiplier: vec![0.0; n],
            multiplier_traction: vec![Vec3::ZERO; n],
            slip: vec![Vec3::ZERO; n],
            elastic_slip: vec![Vec3::ZERO; n],
            damage: vec![0.0; n],
            heat: vec![[0.0; 3]; n],
        }
    }

    pub fn add(&mut self, k: usize, weight: f64, row: &OfRow) {
        self.weight[k] += weight;
        self.whole[k] += weight;
        self.normal[k] += row.normal * weight;
        self.gap[k] += weight * row.gap;
        self.pressure[k] += weight * row.pressure;
        self.traction[k] += row.traction * weight;
        self.multiplier[k] += weight * row.multiplier;
        self.multiplier_traction[k] += row.multiplier_traction * weight;
        self.slip[k] += row.slip * weight;
        self.elastic_slip[k] += row.elastic_slip * weight;
        self.damage[k] += weight * row.damage;
        let heat = self.heat[k].iter_mut().zip(row.heat);
        heat.for_each(|(sum, of_row)| *sum += weight * of_row);
    }

    /// A row that meets nothing.
    pub fn add_nothing(&mut self, k: usize, weight: f64) {
        self.whole[k] += weight;
    }

    /// The means themselves, where there are any.
    pub fn of(&self, k: usize) -> Option<OfRow> {
        let weight = self.weight.get(k).copied().filter(|w| *w > 0.0)?;
        let whole = self.whole[k];
        Some(OfRow {
            normal: self.normal[k].normalized().unwrap_or_default(),
            gap: self.gap[k] / weight,
            pressure: self.pressure[k] / whole,
            traction: self.traction[k] / whole,
            multiplier: self.multiplier[k] / whole,
            multiplier_traction: self.multiplier_traction[k] / whole,
            slip: self.slip[k] / weight,
            elastic_slip: self.elastic_slip[k] / weight,
            damage: self.damage[k] / weight,
            heat: self.heat[k].map(|sum| sum / whole),
        })
    }
}
