//! What is around the board: devices on its pins, a stimulus that drives them, an operator, and who records it all.

pub(crate) mod attached;
pub(crate) mod outside;
pub mod stimulus;
pub mod trace;
