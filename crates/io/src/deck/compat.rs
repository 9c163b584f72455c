//! Programs whose laws a deck may be meant for.

/// Whose laws hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compat {
    /// Those of Signorini: contact by the best method there is; a penalty that stands for a hard contact is not taken.
    #[default]
    None,
    /// Those of CalculiX, as the deck states them.
    Ccx,
    /// Those of OOFEM: its elements as it integrates them.
    Oofem,
}
