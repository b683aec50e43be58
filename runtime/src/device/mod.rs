//! The devices of the board.

pub(crate) mod attached;
pub(crate) mod changes;
pub(crate) mod encoder;
pub(crate) mod fpga;
pub(crate) mod kanalog;
pub(crate) mod konnect;
pub(crate) mod kstep;
pub(crate) mod outside;
pub(crate) mod pins;
pub(crate) mod snapamp;
pub(crate) mod stepgen;
pub(crate) mod timer;
pub(crate) mod uart;
