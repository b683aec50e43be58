//! What a program reaches beside memory: pins, registers of the FPGA, lines, step generators, option boards, flash.

pub(crate) mod changes;
pub(crate) mod encoder;
pub(crate) mod flash;
pub(crate) mod fpga;
pub(crate) mod kanalog;
pub(crate) mod konnect;
pub(crate) mod kstep;
pub(crate) mod pins;
pub(crate) mod snapamp;
pub(crate) mod stepgen;
pub(crate) mod timer;
pub(crate) mod uart;
