//! The executor against what the emulator recorded.

mod faults;
mod flat;
mod translated;
mod vectors;
