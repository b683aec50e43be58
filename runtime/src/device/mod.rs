//! The devices of the board.

pub(crate) mod fpga;
pub(crate) mod konnect;
pub(crate) mod pins;
pub(crate) mod snapamp;
pub(crate) mod timer;
pub(crate) mod uart;
