//! The penalty that `autopenalty` of OOFEM 2026-08 makes for a facet of the slave surface, `pn = pt = E A/V`: with its area,
//! and the volume and Young's modulus of the element behind it.

use super::Translation;
use super::model::material_name;
use signorini_geometry::mesh::{CellId, FaceIndex, Mesh};
use signorini_geometry::tensor::Vec3;
use std::collections::HashMap;

/// How much penalties of one contact may differ: what rounding makes of equal elements.
const SAME: f64 = 1e-9;

/// Facets, by their numbers, that have the same penalty.
pub(super) struct Alike {
    pub penalty: f64,
    pub facets: Vec<u64>,
}

impl Translation {
    /// The facets of a set by their penalties, the softest first.
    ///
    /// # Errors
    /// Why a facet has none.
    pub(super) fn automatic_penalties(&self, set: &str) -> Result<Vec<Alike>, String> {
        let mesh = &self.meshed.mesh;
        let index = FaceIndex::new(mesh, mesh.cells(mesh.dim()));
        let moduli = self.moduli();
        let facets = mesh.sets.get(set).map_or(&[][..], |set| &set.cells);
        let mut penalties = Vec::with_capacity(facets.len());
        for &facet in facets {
            let label = mesh.cell_label(facet).unwrap_or(0);
            let behind = mesh
                .element(facet)
                .and_then(|e| index.find(e, mesh.cell(facet)));
            let (face, _) =
                behind.ok_or_else(|| format!("no element is behind contact element {label}"))?;
            let modulus = moduli
                .get(&face.cell)
                .ok_or("it takes the modulus E of IsoLE")?;
            let ratio = measure(mesh, facet) / measure(mesh, face.cell);
            let penalty = modulus * ratio;
            if !(penalty.is_finite() && penalty > 0.0) {
                return Err(format!(
                    "the element behind contact element {label} is folded"
                ));
            }
            penalties.push((penalty, label));
        }
        penalties.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut alike: Vec<Alike> = Vec::new();
        for (penalty, label) in penalties {
            match alike.last_mut() {
                Some(last) if penalty <= last.penalty * (1.0 + SAME) => last.facets.push(label),
                _ => alike.push(Alike {
                    penalty,
                    facets: vec![label],
                }),
            }
        }
        Ok(alike)
    }

    /// Young's moduli of the cells whose materials have one.
    fn moduli(&self) -> HashMap<CellId, f64> {
        let mut moduli = HashMap::new();
        for group in &self.meshed.groups {
            let name = material_name(group.material);
            let mut materials = self.case.materials.iter();
            let material = materials.find(|material| material.name.value == name);
            let mut constants = material
                .into_iter()
                .flat_map(|material| &material.constants);
            let modulus = constants.find(|one| one.name == "E");
            let modulus = modulus.and_then(|one| one.values.first().copied());
            let cells = self.meshed.mesh.sets.get(&group.name);
            if let (Some(modulus), Some(set)) = (modulus, cells) {
                moduli.extend(set.cells.iter().map(|&cell| (cell, modulus)));
            }
        }
        moduli
    }
}

/// Length, area or volume of a cell; in the plane per thickness.
fn measure(mesh: &Mesh, cell: CellId) -> f64 {
    let Some(element) = mesh.element(cell) else {
        return 0.0;
    };
    let at = |node: &u32| mesh.points.get(*node as usize).copied().unwrap_or_default();
    let x: Vec<Vec3> = mesh.cell(cell).iter().map(at).collect();
    let mut slopes = vec![Vec3::ZERO; element.nnode()];
    let rule = element.surface_rule();
    let points = rule.points.iter().zip(rule.weights);
    points
        .map(|(xi, weight)| {
            element.dshape(xi, &mut slopes);
            let along = |a: usize| -> Vec3 { x.iter().zip(&slopes).map(|(x, d)| *x * d[a]).sum() };
            let here = match element.dim() {
                3 => along(0).cross(along(1)).dot(along(2)),
                2 => along(0).cross(along(1)).norm(),
                _ => along(0).norm(),
            };
            weight * here
        })
        .sum()
}
