//! Physics that the program brings which runs a case: shapes, laws and materials that the case names by the key `own`.

use super::{Key, Shape, key};
use signorini_vocabulary::Description;

/// The key, and the name of what it chooses, of physics that the program brings.
pub const OWN: &str = "own";

pub(super) const SHAPE: Description = Description::bare(
    &const {
        [key(
            OWN,
            Shape::Text,
            "a shape of the program that runs the case, by its name there",
        )]
    },
);
pub(super) const LAW: Description = Description::bare(
    &const {
        [key(
            OWN,
            Shape::Text,
            "a contact law of the program that runs the case, by its name there",
        )]
    },
);
pub(super) const FRICTION: Description = Description::new(
    OWN,
    "what limits friction, in the program that runs the case",
    &[key(
        OWN,
        Shape::Text,
        "a friction law of the program that runs the case, by its name there",
    )],
);
pub(super) const MATERIAL: Description = Description::new(
    OWN,
    "a material of the program that runs the case",
    &[key(
        OWN,
        Shape::Text,
        "a material of the program that runs the case, by its name there",
    )],
);
pub(super) const AMPLITUDE: Key = key(
    OWN,
    Shape::Text,
    "a function of time of the program that runs the case, by its name there",
);
