//! The executor against what the emulator recorded.

mod faults;
mod flat;
mod stops;
mod translated;
mod vectors;
