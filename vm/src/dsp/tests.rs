//! The executor against what the emulator recorded.

mod faults;
mod flat;
#[cfg(feature = "native")]
mod translated;
mod vectors;
