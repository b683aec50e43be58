//! The simulated mechanics that the board moves.

pub(crate) mod plant;
