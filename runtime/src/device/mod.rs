//! The devices of the board.

pub(crate) mod fpga;
pub(crate) mod pins;
pub(crate) mod timer;
