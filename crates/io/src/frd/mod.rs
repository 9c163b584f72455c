//! What writers and readers of `.frd` files share: the types of elements and the orders of their nodes.

pub mod cells;
