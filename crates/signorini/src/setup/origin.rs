//! What a model was built from, where it may have to be built again.

use crate::own::Own;
use signorini_geometry::mesh::Mesh;
use signorini_io::case::Case;
use std::sync::Arc;

/// The case as it was read, its mesh, and what the program brought for it.
#[derive(Clone)]
pub(crate) struct Origin {
    pub case: Case,
    pub mesh: Arc<Mesh>,
    pub own: Own,
}

impl Origin {
    /// That of a case whose pairs are found; nothing of others, which are built once.
    pub fn new(case: &Case, mesh: &Mesh, own: &Own) -> Option<Self> {
        case.general.is_some().then(|| Self {
            case: case.clone(),
            mesh: Arc::new(mesh.clone()),
            own: own.clone(),
        })
    }
}
