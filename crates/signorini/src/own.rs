//! Physics that a program brings: surfaces, laws, materials and functions of time.

use signorini_geometry::surface::Shape;
use signorini_mechanics::contact::friction::FrictionLaw;
use signorini_mechanics::contact::law::ContactLaw;
use signorini_mechanics::material::Material;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// Objects of the program that a case names by the key `own`.
///
/// | object | in a case |
/// |---|---|
/// | surface | `shape = { own = "NAME" }` of a `[[surface]]` |
/// | law | `enforcement = { own = "NAME" }` of a `[[contact]]` |
/// | friction | `friction = { own = "NAME" }` of a `[[contact]]` |
/// | material | `model = "own"` and `own = "NAME"` of a `[material]`, next to density and expansion |
/// | course | `own = "NAME"` of an `[amplitude]` |
///
/// They go to [`build_with`](crate::build_with), and to [`RunOptions::own`](crate::RunOptions::own), since a run may build its
/// model again. Like every law they hold no state: a resumed run is the same run only where they answer the same again.
///
/// # Example
/// ```
/// use signorini::prelude::{ContactLaw, Eval, Scale, each};
/// use signorini::{Own, Reading, RunOptions, build_with, load, solve};
/// use std::sync::Arc;
///
/// /// Springs that resist penetration, `p = k <-g>`.
/// #[derive(Debug)]
/// struct Springs(f64);
///
/// impl ContactLaw for Springs {
///     fn name(&self) -> &str {
///         "springs"
///     }
///     fn pressures(&self, gaps: &[f64], lambdas: &[f64], _: &Scale, out: &mut [Eval]) {
///         each(gaps, lambdas, out, |gap, _| {
///             let k = if gap < 0.0 { self.0 } else { 0.0 };
///             Eval { value: -k * gap, dgap: -k, dlambda: 0.0 }
///         });
///     }
///     fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
///         Some(0.5 * self.0 * gap.min(0.0).powi(2))
///     }
/// }
///
/// // a block of stiffness 100 per area in series with springs of 100, pressed by 0.02: half of it is penetration
/// let text = r#"
/// [mesh]
/// nodes = [
///   [1, 0.0, 0.0], [2, 1.0, 0.0], [3, 1.0, 1.0], [4, 0.0, 1.0],
/// ]
/// elements = [{ id = 1, type = "quad4", group = "block", nodes = [1, 2, 3, 4] }]
/// [model]
/// space = "plane-strain"
/// [sets]
/// foot = { plane = "y", at = 0.0, of = "block" }
/// head = { nodes = [3, 4] }
/// [material.soft]
/// model = "linear-elastic"
/// E = 100.0
/// nu = 0.0
/// [[body]]
/// group = "block"
/// material = "soft"
/// [[surface]]
/// name = "floor"
/// shape = { plane = { point = [0, 0], normal = "y" } }
/// [[contact]]
/// name = "rest"
/// secondary = "foot"
/// primary = "floor"
/// enforcement = { own = "bed", per = "area" }
/// [[step]]
/// name = "press"
/// geometry = "linear"
/// move = [{ on = "head", ux = 0.0, uy = -0.02 }]
/// [[expect]]
/// what = "reaction_force.y @ set head"
/// value = -1.0
/// tol = { abs = 1e-6 }
/// "#;
/// let mut own = Own::default();
/// own.laws.insert("bed".to_owned(), Arc::new(Springs(100.0)));
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("block.toml");
/// std::fs::write(&path, text)?;
/// let loaded = load(&path, &Reading::default())?;
/// let model = build_with(loaded.case, loaded.mesh, &own)?;
/// let options = RunOptions { own, ..RunOptions::new(loaded.source) };
/// assert_eq!(solve(model, &options, &mut ()).exit_code, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Default)]
pub struct Own {
    /// Shapes of rigid surfaces, by their names.
    pub surfaces: BTreeMap<String, Arc<dyn Shape>>,
    /// Contact laws, by their names.
    pub laws: BTreeMap<String, Arc<dyn ContactLaw>>,
    /// Friction laws, by their names.
    pub frictions: BTreeMap<String, Arc<dyn FrictionLaw>>,
    /// Materials, by their names.
    pub materials: BTreeMap<String, Arc<dyn Material>>,
    /// Functions of time, by their names: the factor of a load, the value of a motion.
    pub courses: BTreeMap<String, Arc<dyn Fn(f64) -> f64 + Send + Sync>>,
}

impl fmt::Debug for Own {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Own")
            .field("surfaces", &self.surfaces)
            .field("laws", &self.laws)
            .field("frictions", &self.frictions)
            .field("materials", &self.materials.keys())
            .field("courses", &self.courses.keys())
            .finish()
    }
}
