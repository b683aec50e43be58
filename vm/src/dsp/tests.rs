//! The executor against what the emulator recorded.

mod faults;
mod flat;
mod stalls;
mod stops;
mod translated;
mod vectors;
